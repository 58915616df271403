//! Menger's sponge.

#[cfg(test)]
mod tests;

use crate::primitives::plane_t_error;
use crate::{
    Crossing, Crossings, GeometryError, PrimHit, Primitive, Scratch, Side, Solid, SurfaceId,
    SurfacePoint,
};
use std::ops::ControlFlow;
use strahl_math::error::gamma;
use strahl_math::{Aabb, DVec3, Interval, Ray};

/// Menger's sponge of a level: a box cut into 27 equal ones, of which the six in the middle of the faces and the one in the centre are
/// taken away, and so on with each of the 20 others, `level` times. Level 0 is the box.
///
/// Nothing is built: a ray goes through the cells of all levels from front to back, and passes a hole of any size in one step. So the
/// memory is the same for all levels, up to [`Menger::MAX_LEVEL`] with 20²⁰ cells. A plane of the grid is the same number whatever
/// the level of the cell it bounds, so cells that share a face leave no gap. Boxes with sides of different lengths are allowed.
///
/// As a solid it lists every crossing of a ray, whose number grows as about 2.2^level on average (the dimension of the sponge is 2.727);
/// a ray for a picture only looks for the first one.
///
/// Element `2 k` has the faces with normals towards low coordinates along axis `k`, element `2 k + 1` those towards high ones; the facet is
/// the number of the plane, from 0 to `3^level`. There are no texture coordinates.
///
/// K. Menger, "Allgemeine Räume und Cartesische Räume", Proc. Academy of Amsterdam 29 (1926).
#[derive(Clone, Debug, PartialEq)]
pub struct Menger {
    min: DVec3,
    max: DVec3,
    level: u32,
}

impl Menger {
    /// The deepest level: the numbers of its planes fill 32 bits.
    pub const MAX_LEVEL: u32 = 20;

    /// The sponge between two opposite corners.
    ///
    /// # Errors
    /// A corner is not finite, the box is flat, or the level is greater than [`Menger::MAX_LEVEL`].
    pub fn try_new(corner: DVec3, opposite: DVec3, level: u32) -> Result<Self, GeometryError> {
        if !(corner.is_finite() && opposite.is_finite()) {
            return Err(GeometryError::NotFinite {
                what: "corner of the sponge",
            });
        }
        let (min, max) = (corner.min(opposite), corner.max(opposite));
        if !((max - min).cmpgt(DVec3::ZERO).all() && (max - min).is_finite()) {
            return Err(GeometryError::Degenerate {
                what: "sponge",
                why: "its box is flat or too large",
            });
        }
        if level > Self::MAX_LEVEL {
            return Err(GeometryError::OutOfRange {
                what: "level of the sponge",
                expected: "from 0 to 20",
                found: f64::from(level),
            });
        }
        Ok(Self { min, max, level })
    }

    /// The coordinate of plane `k` of the grid of a level, `0..=3^level`: the same for `k` and for `3 k` of the next level, because the
    /// quotients are rounded correctly.
    fn plane(&self, axis: usize, k: u64, level: u32) -> f64 {
        let count = 3_u64.pow(level);
        if k == count {
            return self.max[axis];
        }
        // Both are below 2^53.
        self.min[axis] + (self.max[axis] - self.min[axis]) * (k as f64 / count as f64)
    }

    /// Reports every crossing along a ray, in order, until the visitor stops: the parameter, the surface, and whether the ray gets inside.
    /// Those outside of the range may be left out, or be in front of it and wrong but for the side that the last of them leads to.
    fn walk(
        &self,
        ray: &Ray,
        (range, from): (Interval, Option<SurfaceId>),
        visit: impl FnMut(f64, SurfaceId, bool) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let speed = ray.direction.abs().max_element();
        if !(speed > 0.0 && ray.direction.is_finite() && ray.origin.is_finite()) {
            return ControlFlow::Continue(());
        }
        let mut way = Way {
            sponge: self,
            origin: ray.origin,
            direction: ray.direction,
            inverse: 1.0 / ray.direction,
            from: from.map(|from| ((from.element >> 1) as usize, u64::from(from.facet))),
            range,
            inside: None,
            visit,
        };
        let none = End {
            t: f64::NEG_INFINITY,
            axis: 0,
        };
        let (mut enter, mut exit) = (
            none,
            End {
                t: f64::INFINITY,
                ..none
            },
        );
        for axis in 0..3 {
            let (near, far) = way.ends(axis, [0, 1], 0);
            if near > enter.t {
                enter = End { t: near, axis };
            }
            if far < exit.t {
                exit = End { t: far, axis };
            }
        }
        way.descend([0; 3], 0, enter, exit)?;
        way.close()
    }

    /// Whether a point is in a cell, which is closed.
    fn holds(&self, point: DVec3, cell: [u64; 3], level: u32) -> bool {
        if level == self.level {
            return true;
        }
        // The thirds that a coordinate is in: two if it is on a plane between them.
        let thirds = |axis: usize| {
            let at = |k: u64| self.plane(axis, 3 * cell[axis] + k, level + 1);
            let (low, high, x) = (at(1), at(2), point[axis]);
            [x <= low, low <= x && x <= high, high <= x]
        };
        let all = [thirds(0), thirds(1), thirds(2)];
        children().any(|child| {
            (0..3).all(|axis| all[axis][child[axis] as usize])
                && self.holds(point, [0, 1, 2].map(|k| 3 * cell[k] + child[k]), level + 1)
        })
    }
}

/// Whether a third of a cell along each axis is taken away.
fn is_hole(thirds: [u64; 3]) -> bool {
    thirds.into_iter().filter(|third| *third == 1).count() >= 2
}

/// The cells that stay of 27.
fn children() -> impl Iterator<Item = [u64; 3]> {
    (0..27)
        .map(|n| [n % 3, n / 3 % 3, n / 9])
        .filter(|child| !is_hole(*child))
}

/// Where a ray crosses a plane perpendicular to an axis.
#[derive(Clone, Copy, Debug)]
struct End {
    t: f64,
    axis: usize,
}

/// A ray on its way through the cells.
struct Way<'a, V> {
    sponge: &'a Menger,
    origin: DVec3,
    direction: DVec3,
    inverse: DVec3,
    /// The axis and the number of the plane that the ray starts on.
    from: Option<(usize, u64)>,
    range: Interval,
    /// If the last cell that was met is part of the sponge: where the ray leaves it, and through which face.
    inside: Option<(f64, SurfaceId)>,
    visit: V,
}

impl<V: FnMut(f64, SurfaceId, bool) -> ControlFlow<()>> Way<'_, V> {
    /// The parameter at which a plane is crossed; rays along it are behind it if they are on it.
    fn at(&self, axis: usize, k: u64, level: u32) -> f64 {
        let plane = self.sponge.plane(axis, k, level);
        let d = self.direction[axis];
        if d == 0.0 {
            return if plane <= self.origin[axis] {
                f64::NEG_INFINITY
            } else {
                f64::INFINITY
            };
        }
        if let Some((from_axis, number)) = self.from
            && from_axis == axis
            && number == k * 3_u64.pow(self.sponge.level - level)
        {
            return 0.0;
        }
        (plane - self.origin[axis]) * self.inverse[axis]
    }

    /// Where the ray crosses two planes, in the order in which it does.
    fn ends(&self, axis: usize, [low, high]: [u64; 2], level: u32) -> (f64, f64) {
        let (a, b) = (self.at(axis, low, level), self.at(axis, high, level));
        if self.direction[axis] < 0.0 {
            (b, a)
        } else {
            (a, b)
        }
    }

    /// Visits the cells within a cell that is no hole.
    fn descend(
        &mut self,
        cell: [u64; 3],
        level: u32,
        mut enter: End,
        exit: End,
    ) -> ControlFlow<()> {
        if !(enter.t < exit.t && enter.t <= self.range.max && exit.t >= self.range.min) {
            return ControlFlow::Continue(());
        }
        if level == self.sponge.level {
            return self.meet(cell, enter, exit);
        }
        let ends = [0, 1, 2]
            .map(|axis| self.ends(axis, [3 * cell[axis] + 1, 3 * cell[axis] + 2], level + 1));
        // How many of the two planes between the thirds are behind the ray, along each axis.
        let mut passed =
            ends.map(|(a, b)| u64::from(a <= enter.t) + u64::from(a <= enter.t && b <= enter.t));
        loop {
            let mut until = exit;
            let mut crossed = None;
            for axis in 0..3 {
                let next = match passed[axis] {
                    0 => ends[axis].0,
                    1 => ends[axis].1,
                    _ => continue,
                };
                if next < until.t {
                    (until, crossed) = (End { t: next, axis }, Some(axis));
                }
            }
            let thirds = [0, 1, 2].map(|axis| {
                if self.direction[axis] < 0.0 {
                    2 - passed[axis]
                } else {
                    passed[axis]
                }
            });
            if !is_hole(thirds) {
                let child = [0, 1, 2].map(|k| 3 * cell[k] + thirds[k]);
                self.descend(child, level + 1, enter, until)?;
            }
            let Some(axis) = crossed else {
                return ControlFlow::Continue(());
            };
            if until.t > self.range.max {
                return ControlFlow::Continue(());
            }
            passed[axis] += 1;
            enter = until;
        }
    }

    /// A smallest cell is part of the sponge.
    fn meet(&mut self, cell: [u64; 3], enter: End, exit: End) -> ControlFlow<()> {
        let face = |axis: usize, is_exit: bool| {
            let is_high = u64::from((self.direction[axis] < 0.0) != is_exit);
            // Both numbers fit: there are six elements, and at most 3^20 planes.
            SurfaceId {
                element: 2 * axis as u32 + is_high as u32,
                facet: (cell[axis] + is_high) as u32,
            }
        };
        let (first, last) = (face(enter.axis, false), face(exit.axis, true));
        if self.inside.is_none_or(|(t, _)| t != enter.t) {
            self.close()?;
            (self.visit)(enter.t, first, true)?;
        }
        self.inside = Some((exit.t, last));
        ControlFlow::Continue(())
    }

    /// The cell after the last one is no part of the sponge.
    fn close(&mut self) -> ControlFlow<()> {
        match self.inside.take() {
            Some((t, surface)) => (self.visit)(t, surface, false),
            None => ControlFlow::Continue(()),
        }
    }
}

/// What counts as the start of a range: rays that start on the surface have no part behind it.
fn forward(range: Interval, from: Option<SurfaceId>) -> Interval {
    let is_behind = from.is_some() && range.min < 0.0;
    Interval::new(if is_behind { 0.0 } else { range.min }, range.max)
}

impl Menger {
    /// The normal of a face, and a point on it.
    fn face(&self, surface: SurfaceId) -> (usize, f64, DVec3) {
        let axis = (surface.element >> 1).min(2) as usize;
        let normal = if surface.element & 1 == 0 {
            -DVec3::AXES[axis]
        } else {
            DVec3::AXES[axis]
        };
        let number = u64::from(surface.facet);
        (axis, self.plane(axis, number, self.level), normal)
    }

    fn t_error(&self, ray: &Ray, hit: &PrimHit) -> f64 {
        let (axis, plane, normal) = self.face(hit.surface);
        // The plane itself is rounded, too.
        let reach = DVec3::AXES[axis] * (self.min.abs() + self.max.abs() + plane.abs());
        plane_t_error(ray, hit.t, reach, normal)
    }
}

impl Primitive for Menger {
    fn kind(&self) -> &'static str {
        "menger"
    }

    /// [`Menger::try_new`] has validated everything.
    fn validate(&self) -> Result<(), GeometryError> {
        Ok(())
    }

    fn bounds(&self) -> Aabb {
        Aabb::new(self.min, self.max)
    }

    fn elements(&self) -> u32 {
        6
    }

    fn closest_hit(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        _scratch: &mut Scratch,
    ) -> Option<PrimHit> {
        let range = forward(range, from);
        let mut closest = None;
        // The result only matters while visiting.
        let _ = self.walk(ray, (range, from), |t, surface, _| {
            if range.accepts(t) && t.is_finite() {
                let uv = [0.0; 2];
                closest = Some(PrimHit { t, surface, uv });
            }
            if t > range.min {
                return ControlFlow::Break(());
            }
            ControlFlow::Continue(())
        });
        closest
    }

    fn surface_at(&self, ray: &Ray, hit: &PrimHit) -> SurfacePoint {
        let (axis, plane, normal) = self.face(hit.surface);
        let mut position = ray.at(hit.t);
        position[axis] = plane;
        let reach = ray.origin.abs() + (ray.direction * hit.t).abs();
        let reach = reach + self.min.abs() + self.max.abs();
        // Along the other axes the point is off as far as the parameter is.
        let along = ray.direction.abs() * self.t_error(ray, hit);
        let mut error = reach * gamma(4) + along;
        error[axis] = reach[axis] * gamma(4);
        SurfacePoint::bare(position, error, normal)
    }

    fn as_solid(&self) -> Option<&dyn Solid> {
        Some(self)
    }
}

impl Solid for Menger {
    fn crossings(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        _scratch: &mut Scratch,
        out: &mut Crossings,
    ) {
        let range = forward(range, from);
        // An empty range has a side at its start, too.
        let most = if range.max > range.min {
            range.max
        } else {
            range.min
        };
        let needed = Interval::new(range.min, most);
        let _ = self.walk(ray, (needed, from), |t, surface, enters| {
            if t <= range.min {
                out.inside_at_start = enters;
            } else if t <= range.max && t.is_finite() {
                let uv = [0.0; 2];
                let hit = PrimHit { t, surface, uv };
                let side = if enters { Side::Enter } else { Side::Exit };
                out.list
                    .push(Crossing::new(hit, self.t_error(ray, &hit), side));
            } else {
                return ControlFlow::Break(());
            }
            ControlFlow::Continue(())
        });
    }

    fn contains(&self, point: DVec3) -> bool {
        self.bounds().contains(point) && self.holds(point, [0; 3], 0)
    }
}
