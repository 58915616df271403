//! Surfaces where sampled data has a given value.

mod grid;
#[cfg(test)]
mod tests;
mod walk;

use crate::primitives::plane_t_error;
use crate::{
    Crossing, Crossings, GeometryError, PrimHit, Primitive, Scratch, Side, Solid, SurfaceId,
    SurfacePoint,
};
use grid::Grid;
use std::ops::ControlFlow;
use strahl_math::error::{ROUNDOFF, gamma};
use strahl_math::{Aabb, DVec3, Interval, Ray};
use walk::{Event, Walk};

/// What a [`GridIsosurface`] shows of its samples.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GridOptions {
    /// The value on the surface.
    pub level: f64,
    /// Whether the inside is where values are smaller than the level, as with signed distances; otherwise where they are larger.
    pub inside_below: bool,
    /// Whether the grid's walls are invisible where they cut through the inside.
    pub open: bool,
    /// Whether normals for shading are interpolated between the samples, from central differences. They hide the edges between cells;
    /// the surface stays the same.
    pub smooth: bool,
}

/// The surface where the trilinear interpolation of samples on a grid has a given value, and the solid that it bounds within the grid.
///
/// Samples lie at whole coordinates: the first at 0, those of a cell one unit apart. Maps place and stretch the grid. Between the
/// eight samples of a cell the function is of degree 3 along every ray, and its roots are found to the last digits: the surface is
/// that of the interpolation itself, without triangles. It has no holes, also where a ray passes edges and corners of cells, because
/// neighbours share all that they compute at a common face. The normal is the gradient's; it jumps between cells, unless it is smooth.
///
/// A pyramid with the smallest and largest samples of blocks tells which blocks may have a surface; rays pass over the others.
///
/// Facets: 0 is the surface, 1 to 6 are the walls of the grid (at low x, high x, low y, ...). There are no texture coordinates.
///
/// The polynomial: S. Parker et al., "Interactive ray tracing for isosurface rendering", IEEE Visualization 1998. Its roots between the
/// extremes: G. Marmitt et al., "Fast and accurate ray-voxel intersection techniques for iso-surface ray tracing", VMV 2004.
#[derive(Debug)]
pub struct GridIsosurface {
    grid: Grid,
    options: GridOptions,
    bounds: Aabb,
}

/// The facet that is the surface.
const SURFACE: SurfaceId = SurfaceId {
    element: 0,
    facet: 0,
};

/// The facet of a wall.
fn facet_of(axis: usize, high: bool) -> u32 {
    1 + 2 * axis as u32 + u32::from(high)
}

/// Corrections of positions and errors of parameters are shorter than this, in cells.
const NEARBY: f64 = 1e-3;

/// Most samples along an axis.
const MOST: u32 = 1 << 30;

impl GridIsosurface {
    /// The surface of `samples` values along x, y and z; `values` has them with z fastest, as NumPy has an array of that shape.
    ///
    /// # Errors
    /// There are fewer than 2 samples along an axis, or more than 2³⁰; their number is not that of the values; a value or the level is
    /// not finite; no value is on the inner side of the level.
    pub fn try_new(
        samples: [u32; 3],
        values: Vec<f32>,
        options: GridOptions,
    ) -> Result<Self, GeometryError> {
        for count in samples {
            if !(2..=MOST).contains(&count) {
                return Err(GeometryError::OutOfRange {
                    what: "number of samples along an axis",
                    expected: "between 2 and 2^30",
                    found: f64::from(count),
                });
            }
        }
        let expected = samples
            .iter()
            .try_fold(1_u64, |n, &count| n.checked_mul(u64::from(count)));
        let (expected, found) = (expected.unwrap_or(u64::MAX), values.len() as u64);
        if expected != found {
            return Err(GeometryError::WrongCount {
                what: "samples",
                expected,
                found,
            });
        }
        if let Some(index) = values.iter().position(|value| !value.is_finite()) {
            return Err(GeometryError::NotFiniteAt {
                what: "sample",
                index: index as u64,
            });
        }
        if !options.level.is_finite() {
            return Err(GeometryError::NotFinite {
                what: "level of the isosurface",
            });
        }
        let grid = Grid::new(samples, values.into(), options.level, options.inside_below);
        let bounds = grid.inside_bounds().ok_or(GeometryError::Degenerate {
            what: "isosurface",
            why: "no sample is on the inner side of the level",
        })?;
        Ok(Self {
            grid,
            options,
            bounds,
        })
    }

    /// Reports the events along a ray to the visitor until it stops.
    fn walk(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        visit: &mut impl FnMut(Event) -> ControlFlow<()>,
    ) {
        if let Some(walk) = Walk::new(&self.grid, ray, range, from, visit) {
            // The result only matters while visiting.
            let _ = walk.run();
        }
    }

    /// Whether a crossing of this facet is seen.
    fn shows(&self, surface: SurfaceId) -> bool {
        surface == SURFACE || !self.options.open
    }

    /// The outward normal and a point of a wall; `None` for the surface.
    fn wall(&self, surface: SurfaceId) -> Option<(DVec3, DVec3)> {
        let number = surface.facet.checked_sub(1)?;
        let axis = *DVec3::AXES.get(number as usize / 2)?;
        Some(match number % 2 {
            0 => (-axis, DVec3::ZERO),
            _ => (axis, self.grid.size()),
        })
    }

    /// The error of the parameter of a crossing.
    fn t_error(&self, ray: &Ray, hit: &PrimHit) -> f64 {
        if let Some((normal, point)) = self.wall(hit.surface) {
            return plane_t_error(ray, hit.t, point, normal);
        }
        let p = ray.at(hit.t);
        let cell = self.grid.cell_at(p);
        let gradient = cell.gradient(cell.local(p));
        let reach = (ray.origin.abs() + (ray.direction * hit.t).abs()) * gamma(4);
        let noise = cell.noise(p, gradient) + gradient.abs().dot(reach);
        let error = noise / gradient.dot(ray.direction).abs();
        // For rays along the surface.
        let longest = NEARBY / ray.direction.abs().max_element();
        gamma(4) * hit.t.abs() + if error < longest { error } else { longest }
    }

    /// The point of the surface nearest to a point almost on it.
    fn settle(&self, ray: &Ray, point: DVec3) -> SurfacePoint {
        let look = |p: DVec3| {
            let cell = self.grid.cell_at(p);
            let local = cell.local(p);
            (cell.value(local), cell.gradient(local), cell)
        };
        let mut p = point.clamp(self.bounds.min, self.bounds.max);
        let (mut value, mut gradient, mut cell) = look(p);
        for _ in 0..2 {
            let step = gradient * (value / gradient.dot(gradient));
            // A flat place, or a point far from the surface because its ray starts far away.
            if !(step.length() < NEARBY) {
                break;
            }
            let moved = (p - step).clamp(self.bounds.min, self.bounds.max);
            let next = look(moved);
            if !(next.0.abs() < value.abs()) {
                break;
            }
            p = moved;
            (value, gradient, cell) = next;
        }
        let off = (cell.noise(p, gradient) + value.abs()) / gradient.length();
        let off = if off < NEARBY { off } else { NEARBY };
        let n_geom = gradient
            .try_normalize()
            .or_else(|| (-ray.direction).try_normalize())
            .unwrap_or(DVec3::Y);
        let error = DVec3::splat(off + f64::MIN_POSITIVE) + p.abs() * (4.0 * ROUNDOFF);
        let mut surface = SurfacePoint::bare(p, error, n_geom);
        if self.options.smooth {
            let n = self.grid.smooth_gradient(p).normalize_or(n_geom);
            let above = n.dot(n_geom);
            surface.n_shade = match above >= 0.0 {
                true => n,
                false => (n - n_geom * above).normalize_or(n_geom),
            };
        }
        surface
    }
}

impl Primitive for GridIsosurface {
    fn kind(&self) -> &'static str {
        "grid_isosurface"
    }

    /// [`GridIsosurface::try_new`] has validated everything.
    fn validate(&self) -> Result<(), GeometryError> {
        Ok(())
    }

    fn bounds(&self) -> Aabb {
        self.bounds
    }

    fn closest_hit(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        _: &mut Scratch,
    ) -> Option<PrimHit> {
        let mut closest = None;
        self.walk(ray, range, from, &mut |event| {
            let Event::Crossing(Crossing { hit, .. }) = event else {
                return ControlFlow::Continue(());
            };
            if self.shows(hit.surface) && range.accepts(hit.t) {
                // The wall that a ray starts on is at 0.
                let is_start = hit.t == 0.0 && from == Some(hit.surface);
                if !is_start {
                    closest = Some(hit);
                    return ControlFlow::Break(());
                }
            }
            match hit.t > range.max {
                true => ControlFlow::Break(()),
                false => ControlFlow::Continue(()),
            }
        });
        closest
    }

    fn surface_at(&self, ray: &Ray, hit: &PrimHit) -> SurfacePoint {
        let Some((normal, point)) = self.wall(hit.surface) else {
            return self.settle(ray, ray.at(hit.t));
        };
        let on_ray = ray.at(hit.t);
        let position = on_ray - normal * (on_ray - point).dot(normal);
        let reach = ray.origin.abs() + (ray.direction * hit.t).abs() + self.grid.size();
        SurfacePoint::bare(position, reach * gamma(8), normal)
    }

    fn as_solid(&self) -> Option<&dyn Solid> {
        Some(self)
    }
}

impl Solid for GridIsosurface {
    fn crossings(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        _: &mut Scratch,
        out: &mut Crossings,
    ) {
        let start = if from.is_some() && range.min < 0.0 {
            0.0
        } else {
            range.min
        };
        self.walk(ray, Interval::new(start, range.max), from, &mut |event| {
            match event {
                Event::Start { inside } => out.inside_at_start = inside,
                Event::Crossing(c) if c.hit.t <= start => {
                    out.inside_at_start = c.side == Side::Enter;
                }
                Event::Crossing(c) if c.hit.t <= range.max => out.list.push(Crossing {
                    t_error: self.t_error(ray, &c.hit),
                    visible: self.shows(c.hit.surface),
                    ..c
                }),
                Event::Crossing(_) => return ControlFlow::Break(()),
            }
            ControlFlow::Continue(())
        });
    }

    fn contains(&self, point: DVec3) -> bool {
        let size = self.grid.size();
        let is_in = point.cmpge(DVec3::ZERO).all() && point.cmple(size).all();
        let cell = self.grid.cell_at(point);
        is_in && cell.value(cell.local(point)) <= 0.0
    }
}
