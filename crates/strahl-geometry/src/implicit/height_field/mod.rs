//! Height fields: surfaces over a rectangular grid of heights.

mod body;
mod grid;
mod smooth;
#[cfg(test)]
mod tests;
mod traverse;

use crate::mesh::{RayShear, combine, intersect_sheared};
use crate::{GeometryError, PrimHit, Primitive, Scratch, Solid, SurfaceId, SurfacePoint};
use body::Body;
use grid::{Cell, Grid, SCALE};
use smooth::Normals;
use std::cmp::Ordering;
use std::ops::ControlFlow;
use std::sync::Arc;
use strahl_math::{Aabb, DVec2, DVec3, Interval, Ray, Transform};
use traverse::Descent;

/// A height field: heights over a grid of points on the unit square of the xz plane, joined by triangles.
///
/// Heights are 16-bit numbers, `65536` standing for 1, so the surface is within the unit cube. Every cell of the grid is cut along
/// the diagonal from its corner of large x and small z to that of small x and large z. What lies below the *water level* is
/// no surface.
///
/// As a solid a height field contains everything below the surface or the water level within the square, without a lower bound; a
/// water level above the highest point counts as that point. The walls along the square's edges, the surface of the water and
/// everything below it are invisible. This is how POV-Ray 3.7 behaves (measured), except that it raises the vertices below the water
/// to its level before it classifies points, so that the cells on the shore differ.
///
/// Elements are the triangles, two for each cell, rows of cells with ascending z; the last element is the walls. Rays don't
/// slip through between triangles. Texture coordinates are x and z. For shading, smooth height fields interpolate normals as
/// POV-Ray does.
#[derive(Debug)]
pub struct HeightField {
    body: Body,
}

/// The most heights of a field, for which triangles can be numbered in 32 bits.
const MOST_HEIGHTS: u64 = 1 << 30;

/// The surface alone.
#[derive(Debug)]
struct Surface {
    grid: Arc<Grid>,
    /// The water level.
    water: f64,
    normals: Option<Normals>,
}

impl HeightField {
    /// A height field from the rows of a picture: the first row lies at `z = 1`, the last at `z = 0`.
    ///
    /// # Errors
    /// There are fewer than 2 rows or columns, more than 2^30 heights, or the list has the wrong length.
    pub fn try_new(
        width: u32,
        depth: u32,
        mut rows: Vec<u16>,
        water_level: f64,
        smooth: bool,
    ) -> Result<Self, GeometryError> {
        for (what, found) in [
            ("number of heights along x", width),
            ("number of heights along z", depth),
        ] {
            if found < 2 {
                return Err(GeometryError::OutOfRange {
                    what,
                    expected: "2 or greater",
                    found: f64::from(found),
                });
            }
        }
        let expected = u64::from(width) * u64::from(depth);
        if expected > MOST_HEIGHTS {
            return Err(GeometryError::OutOfRange {
                what: "number of heights",
                expected: "2^30 or less",
                found: expected as f64,
            });
        }
        if rows.len() as u64 != expected {
            return Err(GeometryError::WrongCount {
                what: "heights",
                expected,
                found: rows.len() as u64,
            });
        }
        if water_level.is_nan() {
            return Err(GeometryError::NotFinite {
                what: "water level of the height field",
            });
        }
        // Turned upside down: z ascends from row to row from here on.
        let row = width as usize;
        let (upper, lower) = rows.split_at_mut(depth as usize / 2 * row);
        for (a, b) in upper
            .chunks_exact_mut(row)
            .zip(lower.rchunks_exact_mut(row))
        {
            a.swap_with_slice(b);
        }
        let grid = Grid::new(width, depth, rows.into());
        let normals = smooth.then(|| Normals::of(&grid));
        Ok(Self {
            body: Body(Surface {
                grid: Arc::new(grid),
                water: water_level,
                normals,
            }),
        })
    }

    /// The field with the normals that it has in the space that `to_world` leads to; `None` if it is not smooth. As in POV-Ray (measured) normals are
    /// interpolated where the field is, so a scale that differs from axis to axis changes which vertex counts how much. Positions
    /// stay, and the heights are shared.
    #[must_use]
    pub fn shaded_in(&self, to_world: &Transform) -> Option<Self> {
        let surface = &self.body.0;
        Some(Self {
            body: Body(Surface {
                grid: Arc::clone(&surface.grid),
                water: surface.water,
                normals: Some(surface.normals.as_ref()?.seen_from(to_world)),
            }),
        })
    }

    /// Heights along x and along z.
    pub fn size(&self) -> (u32, u32) {
        self.body.0.grid.size()
    }

    /// Whether normals are interpolated for shading.
    pub fn is_smooth(&self) -> bool {
        self.body.0.normals.is_some()
    }

    /// The height below which there is no surface.
    pub fn water_level(&self) -> f64 {
        self.body.0.water
    }
}

/// Which triangles of a cell the line of a ray meets, from the images of the corners: the comparisons of [`intersect_sheared`], with those of the
/// common edge made once.
#[inline(always)]
fn met([a, b, c, d]: &[DVec3; 4]) -> [bool; 2] {
    // Whether the ray passes an edge on one side or on it, and on the other side or on it.
    let sides = |from: &DVec3, to: &DVec3| {
        let (p, q) = (from.x * to.y, from.y * to.x);
        (p >= q, p <= q)
    };
    let (bc, ca, ab) = (sides(b, c), sides(c, a), sides(a, b));
    let (bd, dc) = (sides(b, d), sides(d, c));
    [
        bc.0 & ca.0 & ab.0 | bc.1 & ca.1 & ab.1,
        bc.1 & bd.0 & dc.0 | bc.0 & bd.1 & dc.1,
    ]
}

impl Surface {
    /// The number of triangles.
    fn triangles(&self) -> u32 {
        let (columns, rows) = self.grid.cells();
        2 * columns * rows
    }

    /// Passes the hits of a ray on all triangles that it may meet to the visitor, which may shorten the range.
    fn visit_hits(
        &self,
        ray: &Ray,
        range: Interval,
        skip: Option<u32>,
        mut visit: impl FnMut(&mut Interval, PrimHit) -> ControlFlow<()>,
    ) {
        let Some(mut descent) = Descent::new(&self.grid, self.water, ray, range) else {
            return;
        };
        let shear = RayShear::new(ray);
        let columns = self.grid.cells().0;
        // The result only matters while visiting.
        let _ = descent.run(|range, cell: &Cell| {
            let corners = self.grid.corners(cell);
            let images = corners.map(|p| shear.apply(&p));
            let first = 2 * (cell.j * columns + cell.i);
            let [lower, upper] = met(&images);
            for (is_met, element, [a, b, c]) in
                [(lower, first, [0, 1, 2]), (upper, first + 1, [3, 2, 1])]
            {
                if !is_met {
                    continue;
                }
                let Some(hit) = intersect_sheared(&shear, images[a], images[b], images[c]) else {
                    continue;
                };
                let [a, b, c] = [a, b, c].map(|k| corners[k].y);
                let y = a + (hit.u * (b - a) + hit.v * (c - a));
                if !range.accepts(hit.t) || y < self.water || skip == Some(element) {
                    continue;
                }
                let surface = SurfaceId { element, facet: 0 };
                let uv = [hit.u, hit.v];
                let t = hit.t;
                visit(range, PrimHit { t, surface, uv })?;
            }
            ControlFlow::Continue(())
        });
    }

    fn closest_hit(&self, ray: &Ray, range: Interval, skip: Option<u32>) -> Option<PrimHit> {
        let mut nearest: Option<PrimHit> = None;
        self.visit_hits(ray, range, skip, |range, hit| {
            let better = |best: &PrimHit| {
                hit.t < best.t || hit.t == best.t && hit.surface.element < best.surface.element
            };
            if nearest.as_ref().is_none_or(better) {
                nearest = Some(hit);
                range.max = hit.t;
            }
            ControlFlow::Continue(())
        });
        nearest
    }

    fn any_hit(&self, ray: &Ray, range: Interval, skip: Option<u32>) -> bool {
        let mut found = false;
        self.visit_hits(ray, range, skip, |_, _| {
            found = true;
            ControlFlow::Break(())
        });
        found
    }

    /// All hits, ascending; of several at one place that on the first triangle.
    fn all_hits(&self, ray: &Ray, range: Interval, skip: Option<u32>, out: &mut Vec<PrimHit>) {
        let before = out.len();
        self.visit_hits(ray, range, skip, |_, hit| {
            out.push(hit);
            ControlFlow::Continue(())
        });
        let place = |hit: &PrimHit| (hit.t, hit.surface.element);
        let mut sorted = out.split_off(before);
        sorted.sort_unstable_by(|a, b| place(a).partial_cmp(&place(b)).unwrap_or(Ordering::Equal));
        sorted.dedup_by(|next, first| next.t == first.t);
        out.append(&mut sorted);
    }

    /// Corners of a triangle as vertex numbers: the one at the right angle, then its neighbours along x and z.
    fn triangle(&self, element: u32) -> [(u32, u32); 3] {
        let columns = self.grid.cells().0;
        let cell = element / 2;
        let (i, j) = (cell % columns, cell / columns);
        if element.is_multiple_of(2) {
            [(i, j), (i + 1, j), (i, j + 1)]
        } else {
            [(i + 1, j + 1), (i, j + 1), (i + 1, j)]
        }
    }

    /// The corners of the triangle of a hit, the one at the right angle first, and its slopes along x and z.
    fn triangle_of(&self, hit: &PrimHit) -> ([DVec3; 3], [f64; 2]) {
        let element = hit.surface.element.min(self.triangles() - 1);
        let numbers = self.triangle(element);
        let [a, b, c] = numbers.map(|(i, j)| self.grid.vertex(i, j, self.grid.height(i, j)));
        // a and b differ in x only, a and c in z only.
        let (by_x, by_z) = ((b.y - a.y) / (b.x - a.x), (c.y - a.y) / (c.z - a.z));
        ([a, b, c], [by_x, by_z])
    }

    /// The normal of the triangle of a hit, and a point of its plane.
    fn plane_at(&self, hit: &PrimHit) -> (DVec3, DVec3) {
        let ([a, ..], [by_x, by_z]) = self.triangle_of(hit);
        (DVec3::new(-by_x, 1.0, -by_z).normalize(), a)
    }

    fn surface_at(&self, hit: &PrimHit) -> SurfacePoint {
        let element = hit.surface.element.min(self.triangles() - 1);
        let ([a, b, c], [by_x, by_z]) = self.triangle_of(hit);
        let (position, position_error) = combine(a, b, c, hit.uv);
        let n_geom = DVec3::new(-by_x, 1.0, -by_z).normalize();
        let n_shade = self.normals.as_ref().map_or(n_geom, |normals| {
            normals.interpolated(&self.grid, element / 2, position, n_geom)
        });
        SurfacePoint {
            position,
            position_error,
            n_geom,
            n_shade,
            uv: DVec2::new(position.x, position.z),
            dpdu: DVec3::new(1.0, by_x, 0.0),
            dpdv: DVec3::new(0.0, by_z, 1.0),
        }
    }

    /// The box around the triangles, as far as they are above the water.
    fn bounds(&self) -> Aabb {
        let [low, high] = self.grid.full_range().map(|h| f64::from(h) / SCALE);
        let low = if low < self.water { self.water } else { low };
        if low > high {
            return Aabb::EMPTY;
        }
        Aabb::new(DVec3::new(0.0, low, 0.0), DVec3::new(1.0, high, 1.0))
    }
}

impl Primitive for HeightField {
    fn kind(&self) -> &'static str {
        "height_field"
    }

    /// [`HeightField::try_new`] has validated everything.
    fn validate(&self) -> Result<(), GeometryError> {
        Ok(())
    }

    fn bounds(&self) -> Aabb {
        self.body.0.bounds()
    }

    fn elements(&self) -> u32 {
        self.body.0.triangles() + 1
    }

    fn closest_hit(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        _scratch: &mut Scratch,
    ) -> Option<PrimHit> {
        let skip = from.map(|surface| surface.element);
        self.body.0.closest_hit(ray, range, skip)
    }

    fn any_hit(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        _scratch: &mut Scratch,
    ) -> bool {
        let skip = from.map(|surface| surface.element);
        self.body.0.any_hit(ray, range, skip)
    }

    fn all_hits(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        _scratch: &mut Scratch,
        out: &mut Vec<PrimHit>,
    ) {
        let skip = from.map(|surface| surface.element);
        self.body.0.all_hits(ray, range, skip, out);
    }

    fn surface_at(&self, ray: &Ray, hit: &PrimHit) -> SurfacePoint {
        self.body.surface_at(ray, hit)
    }

    fn as_solid(&self) -> Option<&dyn Solid> {
        Some(&self.body)
    }
}
