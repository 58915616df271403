//! The surfaces that are compared with their triangles.

use anyhow::Result;
use strahl::geometry::{MeshData, Shape};
use strahl::prelude::*;

/// The point of a face at two parameters.
type Points = Box<dyn Fn(u32, [f64; 2]) -> DVec3>;

/// A surface of faces, each over a square of parameters.
pub(super) trait Surface {
    fn name(&self) -> &'static str;
    fn shape(&self) -> Result<Shape>;
    /// The number of faces.
    fn faces(&self) -> u32;
    /// What gives the points of faces.
    fn points(&self) -> Result<Points>;

    /// Triangles whose shorter sides are no longer than a pixel where they are.
    ///
    /// Each face is cut into squares, and each of these has as many rows and columns as its longest line needs. Neighbours need
    /// not have their vertices in common: that would take a more careful program, but hardly less memory.
    fn triangles(&self, pixel: &dyn Fn(DVec3) -> f64) -> Result<MeshData> {
        let mut mesh = MeshData::default();
        let points = self.points()?;
        for square in 0..self.faces() * SQUARES * SQUARES {
            let corner = [square % SQUARES, square / SQUARES % SQUARES].map(f64::from);
            let at = |uv: [f64; 2]| {
                let place = [0, 1].map(|k| (corner[k] + uv[k]) / f64::from(SQUARES));
                points(square / (SQUARES * SQUARES), place)
            };
            let parts = [0, 1].map(|axis| parts(&at, axis, pixel));
            grid(&mut mesh, parts, at);
        }
        mesh.positions.shrink_to_fit();
        mesh.indices.shrink_to_fit();
        Ok(mesh)
    }
}

/// Squares along each side of a face.
const SQUARES: u32 = 8;

/// Into how many parts the lines of a face along a parameter have to be divided.
fn parts(at: &dyn Fn([f64; 2]) -> DVec3, axis: usize, pixel: &dyn Fn(DVec3) -> f64) -> u32 {
    const STEPS: u32 = 8;
    let along = |k: u32| f64::from(k) / f64::from(STEPS);
    let mut most = 1.0_f64;
    for across in 0..=STEPS {
        let at = |k: u32| {
            let mut uv = [along(across); 2];
            uv[axis] = along(k);
            at(uv)
        };
        for k in 0..STEPS {
            let (a, b) = (at(k), at(k + 1));
            most = most.max((b - a).length() * f64::from(STEPS) / pixel(a));
        }
    }
    most.ceil() as u32
}

/// Adds the points of a face and the triangles between them.
fn grid(mesh: &mut MeshData, [across, up]: [u32; 2], at: impl Fn([f64; 2]) -> DVec3) {
    let first = mesh.positions.len() as u32;
    for j in 0..=up {
        for i in 0..=across {
            let uv = [
                f64::from(i) / f64::from(across),
                f64::from(j) / f64::from(up),
            ];
            mesh.positions.push(at(uv).as_vec3().to_array());
        }
    }
    for j in 0..up {
        for i in 0..across {
            let corner = first + j * (across + 1) + i;
            let above = corner + across + 1;
            mesh.indices.push([corner, corner + 1, above + 1]);
            mesh.indices.push([corner, above + 1, above]);
        }
    }
}

/// All surfaces.
pub(super) fn all() -> Vec<Box<dyn Surface>> {
    vec![
        Box::new(Sheet {
            name: "nurbs, 9 by 9 patches",
        }),
        Box::new(Limit {
            name: "subdivision, a cross of 30 faces",
            data: cross(false),
        }),
        Box::new(Limit {
            name: "subdivision, the same with creases",
            data: cross(true),
        }),
    ]
}

/// A NURBS surface of degree 3.
struct Sheet {
    name: &'static str,
}

/// Patches along each side.
const SPANS: usize = 9;
/// Control points along each side.
const POINTS: usize = SPANS + 3;

/// A control point.
fn control(i: usize, j: usize) -> DVec3 {
    let place = |k: usize| 8.0 * (k as f64 / (POINTS - 1) as f64 - 0.5);
    let (x, z) = (place(i), place(j));
    DVec3::new(x, 1.2 * (1.3 * x).sin() * (1.1 * z + 0.4 * x).cos(), z)
}

/// The cubic basis functions at a parameter from 0 to `SPANS`, on the evenly spaced knots of [`NurbsData::new`].
fn basis(t: f64) -> [f64; POINTS] {
    let last = SPANS as f64;
    let knot = |k: usize| (k as f64 - 3.0).clamp(0.0, last);
    let span = t.floor().clamp(0.0, last - 1.0) as usize + 3;
    let mut value = [0.0; POINTS + 3];
    value[span] = 1.0;
    let ratio = |a: f64, b: f64| if b > 0.0 { a / b } else { 0.0 };
    for degree in 1..=3 {
        for k in 0..POINTS + 3 - degree {
            let (from, to) = (knot(k), knot(k + degree + 1));
            let up = ratio(t - from, knot(k + degree) - from);
            let down = ratio(to - t, to - knot(k + 1));
            value[k] = up * value[k] + down * value[k + 1];
        }
    }
    std::array::from_fn(|k| value[k])
}

impl Surface for Sheet {
    fn name(&self) -> &'static str {
        self.name
    }

    fn shape(&self) -> Result<Shape> {
        let points = (0..POINTS * POINTS).map(|k| control(k % POINTS, k / POINTS));
        let data = NurbsData::new([3, 3], POINTS, points.collect());
        Ok(Nurbs::try_new(&data)?.into())
    }

    /// Its patches.
    fn faces(&self) -> u32 {
        (SPANS * SPANS) as u32
    }

    fn points(&self) -> Result<Points> {
        Ok(Box::new(|face, uv| {
            let patch = [face as usize % SPANS, face as usize / SPANS];
            let [across, up] = [0, 1].map(|k| basis(patch[k] as f64 + uv[k]));
            let mut sum = DVec3::ZERO;
            for (j, b) in up.iter().enumerate().filter(|(_, b)| **b != 0.0) {
                for (i, a) in across.iter().enumerate().filter(|(_, a)| **a != 0.0) {
                    sum += control(i, j) * (a * b);
                }
            }
            sum
        }))
    }
}

/// A subdivision surface.
struct Limit {
    name: &'static str,
    data: SubdivisionData,
}

impl Surface for Limit {
    fn name(&self) -> &'static str {
        self.name
    }

    fn shape(&self) -> Result<Shape> {
        Ok(Subdivision::try_new(&self.data)?.into())
    }

    fn faces(&self) -> u32 {
        self.data.sizes.len() as u32
    }

    fn points(&self) -> Result<Points> {
        let surface = Subdivision::try_new(&self.data)?;
        Ok(Box::new(move |face, uv| {
            let jet = surface.at(face, DVec2::from_array(uv));
            jet.map_or(DVec3::ZERO, |[point, ..]| point)
        }))
    }
}

/// A cube of side 2 with an arm on each side, whose ends may be sharp for two levels.
fn cross(has_creases: bool) -> SubdivisionData {
    let corner = |i: u32| {
        let at = |bit: u32| f64::from(i >> bit & 1) * 2.0 - 1.0;
        DVec3::new(at(0), at(1), at(2))
    };
    let sides = [
        [0, 4, 6, 2],
        [1, 3, 7, 5],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 2, 3, 1],
        [4, 5, 7, 6],
    ];
    let mut points: Vec<DVec3> = (0..8).map(corner).collect();
    let (mut faces, mut creases) = (vec![], vec![]);
    for side in sides {
        let first = points.len() as u32;
        let outwards = side.iter().map(|i| corner(*i)).sum::<DVec3>() * 0.25;
        points.extend(side.map(|i| corner(i) + outwards * 1.6));
        faces.push([first, first + 1, first + 2, first + 3]);
        for k in 0..4_u32 {
            let next = (k + 1) % 4;
            let (a, b) = (side[k as usize], side[next as usize]);
            faces.push([a, b, first + next, first + k]);
            creases.push(([first + k, first + next], 2.0));
        }
    }
    let mut data = SubdivisionData::new(SubdivisionScheme::CatmullClark, points, faces);
    if has_creases {
        data.creases = creases;
    }
    data
}

#[cfg(test)]
mod tests {
    use super::*;
    use strahl::geometry::Primitive;

    /// The points that make triangles are those that rays meet.
    #[test]
    fn points_are_on_the_surface() -> Result<()> {
        for surface in all() {
            let (shape, points) = (surface.shape()?, surface.points()?);
            for k in 0..50 {
                let uv = [
                    f64::from(k % 7) / 7.0 + 0.03,
                    f64::from(k % 11) / 11.0 + 0.02,
                ];
                let point = points(k as u32 % surface.faces(), uv);
                let ray = Ray::new(point * 3.0 + DVec3::Y, -point * 2.0 - DVec3::Y);
                let scratch = &mut strahl::geometry::Scratch::default();
                let mut range = Interval::LINE;
                let mut nearest = f64::INFINITY;
                while let Some(hit) = shape.closest_hit(&ray, range, None, scratch) {
                    nearest = nearest.min((hit.t - 1.0).abs());
                    range.min = hit.t;
                }
                assert!(nearest < 1e-12, "{}: {uv:?} {nearest}", surface.name());
            }
        }
        Ok(())
    }
}
