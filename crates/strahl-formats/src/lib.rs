//! File formats: reading scenes and textures, writing pictures.

pub mod density;
pub mod font;
pub mod image;
mod input;
mod mesh;
pub mod scene;
