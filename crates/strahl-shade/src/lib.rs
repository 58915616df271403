//! Reflection and transmission of light at a point: colours, materials, lights and the selectable shading models.
//!
//! Materials don't know shapes: everything here works on directions, normals and numbers.
//!
//! There are two ways to describe a surface. [`Material`] is the classical model's (and glTF's): one set of coefficients, or
//! pictures of them. [`texture::Texture`] is POV-Ray's: [`pigment`], [`normal`] and [`pov_finish`] by [`patterns`], in layers,
//! with an [`interior`].

mod color;
mod color_ft;
mod coordinates;
mod cost;
mod fresnel;
pub mod functions;
pub mod image_map;
pub mod image_texture;
pub mod interior;
mod light;
mod material;
pub mod normal;
pub mod patterns;
mod pbr;
pub mod pigment;
pub mod pov_finish;
mod quality;
mod reflectance;
mod refraction;
mod shared_list;
mod spectrum;
pub mod srgb;
pub mod texture;

pub use color::Color;
pub use color_ft::ColorFt;
pub use fresnel::fresnel_dielectric;
pub use light::{AreaGrid, AreaLight, Emission, Falloff, Light, LightKind, LightSample};
pub use material::{Finish, Material, MaterialId, MaterialPoint, Sides};
pub use pbr::{Pbr, TextureRef, Textures};
pub use quality::{Quality, UnknownQuality};
pub use reflectance::{ShadingModel, UnknownShadingModel};
pub use refraction::{Refracted, reflect, refract};
pub use shared_list::SharedList;
pub use spectrum::SpectralPart;
