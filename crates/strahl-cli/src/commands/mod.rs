mod check;
mod explain;
mod formats;
mod info;
mod render;

pub(crate) use check::check;
pub(crate) use explain::explain;
pub(crate) use formats::formats;
pub(crate) use info::info;
pub(crate) use render::render;
