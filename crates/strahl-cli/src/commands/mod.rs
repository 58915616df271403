mod check;
mod compare;
mod explain;
mod formats;
mod heatmap;
mod info;
mod render;
mod trace_ray;

pub(crate) use check::check;
pub(crate) use compare::compare;
pub(crate) use explain::explain;
pub(crate) use formats::formats;
pub(crate) use heatmap::heatmap;
pub(crate) use info::info;
pub(crate) use render::render;
pub(crate) use trace_ray::trace_ray;
