//! The scene description: plain data with source spans, and the builder that programs use.
//!
//! Readers of file formats produce a [`Scene`], the renderer compiles it; neither knows the other. Everything in a
//! scene is in world units; angles are in radians; colours are linear Rec. 709.

mod background;
mod builder;
mod camera;
mod diagnostic;
mod faces;
mod fog;
mod lens;
mod object;
mod projection;
mod rainbow;
mod scene;
mod settings;
mod sky;
mod span;
mod working;

pub use background::{Background, BackgroundAlpha};
pub use builder::ObjectExt;
pub use camera::Camera;
pub use diagnostic::{Diagnostic, Problems, Severity, SourceLine};
pub use faces::nurbs_faces;
pub use fog::{Fog, FogKind, FogTurbulence};
pub use lens::{Bokeh, Lens};
pub use object::{Children, CsgOp, Group, GroupId, Object, ObjectKind, Visibility};
pub use projection::{
    CameraFace, CameraFront, CameraMesh, CameraPart, MeshCamera, MeshLayout, Projection,
};
pub use rainbow::Rainbow;
pub use scene::{LightMask, Scene, SceneLight};
pub use settings::Settings;
pub use sky::SkySphere;
pub use span::{FileId, Location, SourceMap, Span};
pub use working::WorkingSpace;
