//! Pictures of the cost of pixels.

mod colors;
mod legend;

pub(crate) use colors::color;
pub(crate) use legend::{LEGEND_ROWS, legend};
