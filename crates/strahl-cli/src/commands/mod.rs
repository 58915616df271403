//! The commands, one file each.

pub(crate) mod check;
pub(crate) mod compare;
pub(crate) mod completions;
pub(crate) mod explain;
pub(crate) mod formats;
pub(crate) mod heatmap;
pub(crate) mod info;
pub(crate) mod man;
pub(crate) mod merge;
pub(crate) mod render;
pub(crate) mod trace_ray;
pub(crate) mod view;
