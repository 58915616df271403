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
//! let session = Session::new(Threads::All)?;
//! let (scene, _warnings) = session.compile(&scene, &CompileOptions::default())?;
//! let picture = session.picture(&scene.view(64, 48), &Output::default())?;
//! strahl::save(&path, &picture.film, &WriteOptions::default())?;
//! # Ok(())
//! # }
//! ```
//!
//! # Why is that pixel blue?
//!
//! [`Session::explain`] gives the ray trees of a pixel with all their numbers:
//!
//! ```
//! use strahl::prelude::*;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let scene = Scene::new()
//!     .add(Sphere::new(DVec3::ZERO, 1.0).named("ball"))
//!     .light(Light::point(DVec3::new(3.0, 3.0, 5.0), Color::WHITE))
//!     .camera(Camera::orthographic(DVec3::new(0.0, 0.0, 5.0), DVec3::ZERO, DVec3::Y, 3.0));
//! let session = Session::new(Threads::All)?;
//! let (scene, _warnings) = session.compile(&scene, &CompileOptions::default())?;
//! let pixel = session.explain(&scene.view(9, 9), 4, 4)?;
//! let primary = &pixel.samples[0].rays[0];
//! let hit = primary.hit.as_ref().expect("the ball is in the middle");
//! assert_eq!(hit.t, 4.0);
//! assert_eq!(hit.object, "sphere \"ball\"");
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
mod subdivide;

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
    self as tracing, Explanation, HitInfo, Outcome, Output, Session, Sink, Threads, Tile,
    Unfinished, View, compile, explain, render, render_watched,
};
pub use strahl_scene::{self as scene, Problems};
pub use strahl_sdl as sdl;
pub use strahl_shade as shade;
pub use strahl_simd::memory;
pub use studio::studio;
pub use subdivide::{SubdivideOptions, subdivide};

#[cfg(doctest)]
#[doc = include_str!("../../../docs/src/rust.md")]
struct Guide;

#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
struct Readme;

/// Everything a program that builds and renders scenes is likely to name.
pub mod prelude {
    pub use strahl_accel::AcceleratorKind;
    pub use strahl_formats::image::WriteOptions;
    pub use strahl_geometry::{
        BicubicPatch, Brep, Cone, Cuboid, Cylinder, Disc, Lemon, Mandelbulb, Menger, MeshData,
        Nurbs, NurbsBrep, NurbsCurve, NurbsData, Ovus, Plane, Polygon, Quadric, Shape, Sphere,
        Subdivision, SubdivisionData, SubdivisionScheme, Terrain, TerrainDetail, TerrainKind,
        TerrainOptions, Torus, Triangle, TriangleMesh, TrimLoop,
    };
    pub use strahl_math::{Aabb, DVec2, DVec3, Interval, Ray, Transform};
    pub use strahl_render::{
        CompileOptions, Explanation, Film, Hit, HitInfo, Outcome, Output, Pass, PixelState,
        Progress, Refinement, Region, RenderOptions, RenderScene, Rendered, Sampling, Session,
        Sink, Threads, Tile, TileOrder, Unfinished, View,
    };
    pub use strahl_scene::{
        Background, Camera, CsgOp, Diagnostic, Fog, FogKind, Lens, Object, ObjectExt, Problems,
        Projection, Rainbow, Scene, Settings, SkySphere, Visibility,
    };
    pub use strahl_shade::interior::Interior;
    pub use strahl_shade::normal::PovNormal;
    pub use strahl_shade::patterns::{Pattern, PatternField};
    pub use strahl_shade::pigment::Pigment;
    pub use strahl_shade::pov_finish::PovFinish;
    pub use strahl_shade::texture::{PlainTexture, Texture};
    pub use strahl_shade::{
        AreaLight, Color, ColorFt, Falloff, Light, Material, Quality, ShadingModel, Sides,
    };
}
