use crate::input::Report;
use crate::mesh::{MeshBuilder, MeshPieces, Vertex, VertexKey};
use std::sync::Arc;
use strahl_math::DVec3;
use strahl_scene::{Diagnostic, FileId, Object, Span};
use strahl_shade::{Color, Finish, Material, Sides};

/// A corner of flat triangles, compared by the bits of its coordinates; -0 counts as 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct FlatCorner {
    x: u64,
    y: u64,
    z: u64,
}

impl From<DVec3> for FlatCorner {
    fn from(v: DVec3) -> Self {
        // -0 + 0 is +0.
        let [x, y, z] = v.to_array().map(|x| (x + 0.0).to_bits());
        Self { x, y, z }
    }
}

impl From<FlatCorner> for DVec3 {
    fn from(v: FlatCorner) -> Self {
        Self::from([v.x, v.y, v.z].map(f64::from_bits))
    }
}

impl VertexKey for FlatCorner {
    fn vertex(self) -> Vertex {
        Vertex::at(self.into())
    }
}

/// A corner of smooth triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct SmoothCorner {
    position: FlatCorner,
    normal: FlatCorner,
}

impl SmoothCorner {
    pub(super) fn new(position: DVec3, normal: DVec3) -> Self {
        Self {
            position: position.into(),
            normal: normal.into(),
        }
    }
}

impl VertexKey for SmoothCorner {
    fn vertex(self) -> Vertex {
        Vertex {
            normal: Some(self.normal.into()),
            ..self.position.vertex()
        }
    }
}

/// A fill: its material, for one and for both sides, and the triangles that will become meshes.
#[derive(Debug, Default)]
pub(super) struct Fill {
    /// The number of the `f` statement, from 1 on; 0 before the first one.
    number: usize,
    line: u32,
    base: Material,
    two_sided: Option<Arc<Material>>,
    one_sided: Option<Arc<Material>>,
    flat: MeshPieces<FlatCorner>,
    smooth: MeshPieces<SmoothCorner>,
}

/// The numbers of an `f` statement.
#[derive(Clone, Copy, Debug)]
pub(super) struct FillNumbers {
    pub(super) color: Color,
    pub(super) kd: f64,
    pub(super) ks: f64,
    pub(super) shine: f64,
    pub(super) t: f64,
    pub(super) ior: f64,
}

impl Fill {
    pub(super) fn new(number: usize, line: u32, n: &FillNumbers) -> Self {
        let diffuse = n.color * n.kd;
        let finish = Finish {
            ambient: diffuse,
            diffuse,
            specular: Color::gray(n.ks),
            shininess: n.shine,
            reflection: Color::gray(n.ks),
            transmission: Color::gray(n.t),
            emission: Color::BLACK,
        };
        let eta = if n.ior > 0.0 { n.ior } else { 1.0 };
        let base = Material {
            name: format!("fill {number} (line {line})"),
            eta,
            ..Material::with_finish(finish)
        };
        Self {
            number,
            line,
            base,
            ..Self::default()
        }
    }

    /// Whether it comes from an `f` statement.
    pub(super) fn is_explicit(&self) -> bool {
        self.number > 0
    }

    /// The material of spheres and cones with a positive radius.
    pub(super) fn two_sided(&mut self) -> Arc<Material> {
        Arc::clone(
            self.two_sided
                .get_or_insert_with(|| Arc::new(self.base.clone())),
        )
    }

    /// The material of objects that exist from the front only, transmitting or not.
    pub(super) fn one_sided(&mut self) -> Arc<Material> {
        let make = || {
            Arc::new(Material {
                sides: Sides::Front,
                ..self.base.clone()
            })
        };
        Arc::clone(self.one_sided.get_or_insert_with(make))
    }

    /// The material of polygons.
    pub(super) fn of_polygons(&mut self) -> Arc<Material> {
        if self.base.finish.transmission.is_black() {
            self.one_sided()
        } else {
            self.two_sided()
        }
    }

    /// Adds triangles: flat ones, and those of smooth polygons.
    pub(super) fn add(&mut self, flat: MeshBuilder<FlatCorner>, smooth: MeshBuilder<SmoothCorner>) {
        self.flat.push(flat);
        self.smooth.push(smooth);
    }

    /// Takes the collected triangles as meshes.
    pub(super) fn take_meshes(&mut self, file: FileId, report: &mut Report) -> Vec<Object> {
        let mut objects = vec![];
        let flat = std::mem::take(&mut self.flat).finish();
        let smooth = std::mem::take(&mut self.smooth).finish();
        for (mesh, what) in [(flat, "triangles"), (smooth, "patches")] {
            let Some((line, mesh)) = mesh else { continue };
            let name = if self.is_explicit() {
                format!("{what} of fill {}", self.number)
            } else {
                what.to_owned()
            };
            match mesh {
                Ok(shape) => objects.push(Object {
                    name: Some(name.into()),
                    span: Span::line(file, line),
                    material: Some(self.of_polygons()),
                    ..shape.into()
                }),
                Err(problem) => report.error(|| {
                    Diagnostic::error(format!("{name} (fill of line {}): {problem}", self.line))
                        .at(Span::line(file, line))
                }),
            }
        }
        objects
    }
}
