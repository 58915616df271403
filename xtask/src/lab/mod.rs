//! The accelerator laboratory: scenes that grow, what they cost, and plots of it.

mod generate;
mod growth;
mod plot;

pub(crate) use generate::generate;
pub(crate) use growth::{measure, plot_growth};
