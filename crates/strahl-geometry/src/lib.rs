//! Surfaces and solids, and their exact intersections with rays.
//!
//! * [`Primitive`]: anything a ray can hit. [`Solid`]: a primitive with an inside; what CSG combines.
//! * [`Shape`]: the table of all shapes, one enum generated from it.
//! * [`Csg`]: several solids combined into one, by trees of any depth.
//! * [`mod@conformance`]: tests that every primitive must pass.

pub mod algebraic;
pub mod blocks;
mod bounded;
pub mod conformance;
pub mod csg;
pub mod fractal;
pub mod implicit;
pub mod mesh;
pub mod patch;
mod primitive;
pub mod primitives;
mod shape;
mod spans;
pub mod swept;

pub use algebraic::{Blob, BlobComponent, Polynomial, Superellipsoid};
pub use bounded::Bounded;
pub use csg::{Csg, CsgNode, Operands, PacketRanges, PacketTree};
pub use fractal::{
    HypercomplexFunction, Julia, JuliaAlgebra, JuliaOptions, Mandelbulb, Menger,
    QuaternionFunction, Terrain, TerrainDetail, TerrainKind, TerrainOptions,
};
pub use implicit::{
    Container, GridIsosurface, GridOptions, HeightField, Isosurface, IsosurfaceOptions, Parametric,
    ParametricOptions,
};
pub use mesh::{
    Brep, MeshData, PlaneHit, Polygon, RayShear, SmoothTriangle, Triangle, TriangleMesh,
};
pub use patch::{
    BicubicPatch, Nurbs, NurbsCurve, NurbsData, Subdivision, SubdivisionData, SubdivisionScheme,
    TrimLoop,
};
pub use primitive::{GeometryError, PrimHit, Primitive, Scratch, Solid, SurfaceId, SurfacePoint};
pub use primitives::{Cone, Cuboid, Cylinder, Disc, Lemon, Ovus, Plane, Quadric, Sphere, Torus};
pub use shape::Shape;
pub use spans::{Crossing, Crossings, Side};
pub use swept::{
    Glyph, Lathe, Outline, OutlineBuilder, Prism, PrismSweep, Sor, SphereSweep, Spline, SweepSpline,
};
