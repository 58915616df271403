//! Files of other programs: bytes to scenes.

mod mesh;
pub mod scene;
