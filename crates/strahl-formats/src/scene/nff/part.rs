use super::fill::{FillNumbers, FlatCorner, SmoothCorner};
use crate::mesh::MeshBuilder;
use strahl_geometry::Shape;
use strahl_math::DVec3;
use strahl_scene::Span;
use strahl_shade::Color;

/// The content of an `f` statement and the statements after it. The first part of a piece has no `f` statement.
#[derive(Debug, Default)]
pub(super) struct Part {
    /// The numbers of the fill and its line.
    pub(super) fill: Option<(FillNumbers, u32)>,
    /// All objects except those that become meshes.
    pub(super) objects: Vec<Placed>,
    /// The number of polygons of all kinds.
    pub(super) polygons: usize,
    pub(super) flat: MeshBuilder<FlatCorner>,
    pub(super) smooth: MeshBuilder<SmoothCorner>,
    pub(super) lights: Vec<LightLine>,
    pub(super) background: Option<Color>,
}

/// A shape and its line.
#[derive(Debug)]
pub(super) struct Placed {
    pub(super) shape: Shape,
    pub(super) kind: Kind,
    pub(super) line: u32,
}

/// The kind of a shape, which determines its name and material.
#[derive(Clone, Copy, Debug)]
pub(super) enum Kind {
    Sphere {
        inside_only: bool,
    },
    Cone,
    Cylinder,
    Polygon {
        /// The number of the polygon in the part, from 1 on.
        number: usize,
    },
}

/// An `l` statement. Without a colour, the strength of the light depends on the number of lights.
#[derive(Debug)]
pub(super) struct LightLine {
    pub(super) position: DVec3,
    pub(super) color: Option<Color>,
    pub(super) span: Span,
}

impl Part {
    /// Adds a flat triangle. Corners with the same coordinates become one vertex.
    pub(super) fn add_flat(&mut self, corners: [DVec3; 3], line: u32) {
        self.flat.triangle(corners.map(FlatCorner::from), line);
    }

    /// Adds the triangles of a smooth polygon; corners with the same coordinates and normal become one vertex.
    pub(super) fn add_patch(
        &mut self,
        corners: &[DVec3],
        normals: &[DVec3],
        triangles: &[[u32; 3]],
        line: u32,
    ) {
        for triangle in triangles {
            let corner = |i: u32| SmoothCorner::new(corners[i as usize], normals[i as usize]);
            self.smooth.triangle(triangle.map(corner), line);
        }
    }
}
