//! Textures of POV-Ray's kind: patterns, pigments, normals and finishes.

mod image;
mod normal;
mod pattern;
mod pigment;
mod texture;

pub(crate) use image::Picture;
pub(crate) use normal::Normal;
pub(crate) use pattern::{Octaves, Pattern};
pub(crate) use pigment::Pigment;
pub(crate) use texture::{InteriorNumbers, Texture};
