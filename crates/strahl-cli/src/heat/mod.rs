//! Pictures of what pixels cost.

mod colors;
mod legend;

pub(crate) use colors::color;
pub(crate) use legend::{LEGEND_ROWS, legend};
