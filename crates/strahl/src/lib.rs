//! **strahl** is a classical recursive ray tracer: exact, explainable, reproducible.
//!
//! This crate has everything that programs need to build, load, render and explain scenes.
//!
//! # A picture in twenty lines
//!
//! ```
//! use strahl::prelude::*;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! # let folder = tempfile::tempdir()?;
//! # let path = folder.path().join("three.png");
//! let glass = Material::glass(1.5).named("glass");
//! let floor = Material::matte(Color::new(0.7, 0.7, 0.6)).with_reflection(Color::gray(0.2));
//! let scene = Scene::new()
//!     .add(Plane::new(DVec3::ZERO, DVec3::Y).material(floor))
//!     .add(Sphere::new(DVec3::new(0.0, 1.0, 0.0), 1.0).material(glass))
//!     .add(Sphere::new(DVec3::new(-2.0, 1.0, -2.0), 1.0).material(Material::mirror(Color::gray(0.9))))
//!     .light(Light::point(DVec3::new(4.0, 8.0, 6.0), Color::WHITE))
//!     .background(Background::Solid(Color::new(0.3, 0.5, 0.8)))
//!     .camera(Camera::perspective(DVec3::new(0.0, 2.0, 7.0), DVec3::Y, DVec3::Y, 0.7));
//! let scene = strahl::compile(&scene, &CompileOptions::default())?;
//! let picture = strahl::render(&scene, &RenderOptions::new(&scene, 64, 48), &())?;
//! strahl::save(&path, &picture.film, &WriteOptions::default())?;
//! # Ok(())
//! # }
//! ```
//!
//! # Why is that pixel blue?
//!
//! [`explain`] records the ray tree of a pixel with all its numbers:
//!
//! ```
//! use strahl::prelude::*;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let scene = Scene::new()
//!     .add(Sphere::new(DVec3::ZERO, 1.0).named("ball"))
//!     .light(Light::point(DVec3::new(3.0, 3.0, 5.0), Color::WHITE))
//!     .camera(Camera::orthographic(DVec3::new(0.0, 0.0, 5.0), DVec3::ZERO, DVec3::Y, 3.0));
//! let scene = strahl::compile(&scene, &CompileOptions::default())?;
//! let pixel = strahl::explain(&scene, &RenderOptions::new(&scene, 9, 9), 4, 4)?;
//! let primary = &pixel.samples[0].tree.nodes[0];
//! let hit = primary.report.hit.as_ref().expect("the ball is in the middle");
//! assert_eq!(hit.hit.t, 4.0);
//! assert_eq!(scene.objects().get(hit.object).expect("its number is right").name.as_deref(), Some("ball"));
//! assert_eq!(primary.total, pixel.color);
//! # Ok(())
//! # }
//! ```
//!
//! # Solids
//!
//! Closed shapes combine to CSG trees of any depth:
//!
//! ```
//! use strahl::prelude::*;
//!
//! let die = Object::csg(CsgOp::Intersection, vec![
//!     Cuboid::new(DVec3::splat(-1.0), DVec3::splat(1.0)).into(),
//!     Sphere::new(DVec3::ZERO, 1.4).into(),
//! ]);
//! let drilled = Object::csg(CsgOp::Difference, vec![
//!     die,
//!     Cylinder::new(DVec3::Y * -2.0, DVec3::Y * 2.0, 0.5).into(),
//! ])
//! .named("drilled die");
//! let scene = strahl::compile(&Scene::new().add(drilled), &CompileOptions::default()).expect("valid");
//! assert_eq!(scene.stats().primitives, 1);
//! ```

mod inputs;
mod load;
mod picture;
mod studio;

pub use inputs::Inputs;
pub use load::{
    Format, Listener, LoadOptions, Loaded, UnknownFormat, load_bytes, load_path, povray_folders,
};
pub use picture::{layers, metadata, picture, save};
pub use strahl_accel as accel;
pub use strahl_formats as formats;
pub use strahl_geometry as geometry;
pub use strahl_math as math;
pub use strahl_render::{
    self as tracing, Outcome, Output, Session, Sink, Threads, Tile, Unfinished, View, compile,
    explain, render,
};
pub use strahl_scene::{self as scene, Problems};
pub use strahl_sdl as sdl;
pub use strahl_shade as shade;
pub use strahl_simd::memory;
pub use studio::studio;

/// Everything a program that builds and renders scenes is likely to name.
pub mod prelude {
    pub use strahl_accel::AcceleratorKind;
    pub use strahl_formats::image::WriteOptions;
    pub use strahl_geometry::{
        BicubicPatch, Brep, Cone, Cuboid, Cylinder, Disc, Lemon, Ovus, Plane, Polygon, Quadric,
        Shape, Sphere, Torus, Triangle, TriangleMesh,
    };
    pub use strahl_math::{DVec2, DVec3, Transform};
    pub use strahl_render::{
        CompileOptions, Film, Outcome, Output, Pass, PixelState, Progress, Region, RenderOptions,
        RenderScene, Sampling, Session, Sink, Threads, Tile, TileOrder, Unfinished, View,
    };
    pub use strahl_scene::{
        Background, Camera, CsgOp, Diagnostic, Object, ObjectExt, Scene, Settings, Visibility,
    };
    pub use strahl_shade::{Color, Falloff, Light, Material, ShadingModel, Sides};
}
