//! What light does at a point: colours, materials, lights and the selectable shading models.
//!
//! Materials don't know shapes: everything here works on directions, normals and numbers.

mod color;
mod color_ft;
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
mod reflectance;
mod refraction;
pub mod srgb;
pub mod texture;

pub use color::Color;
pub use color_ft::ColorFt;
pub use fresnel::fresnel_dielectric;
pub use light::{Falloff, Light, LightKind, LightSample};
pub use material::{Finish, Material, MaterialId, MaterialPoint, Sides};
pub use pbr::{Pbr, TextureRef, Textures};
pub use reflectance::{ShadingModel, UnknownShadingModel};
pub use refraction::{Refracted, reflect, refract};
