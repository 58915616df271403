//! Files of other programs: bytes to scenes and textures, pictures to bytes.

pub mod font;
pub mod image;
mod mesh;
pub mod scene;
