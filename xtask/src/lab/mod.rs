//! The accelerator laboratory: scenes of growing size, measurements of their cost, and plots of it.

mod generate;
mod growth;
mod plot;

pub(crate) use generate::generate;
pub(crate) use growth::{measure, plot_growth};
