//! Intersections of half-spaces, such as gems and crystals.
//!
//! Evaluated plane by plane, every plane would be combined with the list so far. But a line is inside of all of them in one
//! span, from the last plane it enters to the first one it leaves, and one pass over the planes finds it. If planes are crossed
//! so close together that crossings could coincide ([`Fusing`]), the pass reports it and the general evaluation decides, so
//! both give the same bits.

use super::fusing::Fusing;
use crate::primitives::plane_t_error;
use crate::{Crossing, Crossings, PrimHit, Side, SurfaceId};
use strahl_math::{Aabb, DVec3, Interval, Ray};

/// The half-space behind a plane: `n · (x - p) <= 0`.
#[derive(Clone, Copy, Debug)]
pub(super) struct HalfSpace {
    pub(super) point: DVec3,
    /// Of unit length.
    pub(super) normal: DVec3,
    /// The leaf it stands for.
    pub(super) leaf: u32,
    /// The leaf's surface element.
    pub(super) element: u32,
    pub(super) visible: bool,
}

/// A crossing with one of the planes; `index` has no meaning while `t` is infinite.
#[derive(Clone, Copy)]
struct End {
    t: f64,
    index: usize,
}

/// The edges of an intersection.
struct Edges {
    /// What their ends are relative to.
    center: DVec3,
    /// How far the ends may be in front of a plane.
    slack: f64,
    /// Two for each edge; infinite along some axis where an edge is endless.
    ends: Vec<DVec3>,
}

/// Relative to the coordinates, far above the error of a corner.
const SLACK: f64 = 1e-9;

/// Half-spaces that are operands of one intersection.
#[derive(Clone, Debug)]
pub(super) struct HalfSpaces(Vec<HalfSpace>);

impl HalfSpaces {
    /// Fewer are not worth a separate pass.
    const FEWEST: usize = 2;
    /// For more half-spaces no box is computed, because the time grows with the cube of their number.
    const BOXED: usize = 200;

    /// The half-spaces as one operand, if they are enough.
    pub(super) fn new(list: Vec<HalfSpace>) -> Option<Self> {
        (list.len() >= Self::FEWEST).then_some(Self(list))
    }

    pub(super) fn len(&self) -> usize {
        self.0.len()
    }

    /// Writes the crossings of a ray with the intersection; false, with nothing written, if the general evaluation is needed.
    /// `from` is the leaf that the ray starts on; `leaving` says whether it starts on a surface of the tree at all.
    pub(super) fn crossings(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<usize>,
        leaving: bool,
        fusing: &Fusing,
        out: &mut Crossings,
    ) -> bool {
        let gap = |a: f64, b: f64| 2.0 * (fusing.margin(a) + fusing.margin(b));
        // Planes fused one after the other could shift an end by one margin each.
        let shift = 2.0 * self.0.len() as f64;
        let none = |t| End { t, index: 0 };
        let (mut enter, mut exit) = (none(f64::NEG_INFINITY), none(f64::INFINITY));
        // The nearest crossings to them.
        let (mut before_enter, mut after_exit) = (f64::NEG_INFINITY, f64::INFINITY);
        for (index, plane) in self.0.iter().enumerate() {
            let speed = ray.direction.dot(plane.normal);
            if from == Some(plane.leaf as usize) {
                // A ray that leaves the solid through this plane does not come back.
                if speed > 0.0 {
                    return true;
                }
                if speed < 0.0 {
                    continue;
                }
                return false;
            }
            let t = (plane.point - ray.origin).dot(plane.normal) / speed;
            if !t.is_finite() || speed == 0.0 || (leaving && t.abs() <= fusing.margin(t)) {
                return false;
            }
            if speed < 0.0 {
                if t > enter.t {
                    before_enter = enter.t;
                    enter = End { t, index };
                } else if t > before_enter {
                    before_enter = t;
                }
            } else if t < exit.t {
                after_exit = exit.t;
                exit = End { t, index };
            } else if t < after_exit {
                after_exit = t;
            }
            if enter.t > exit.t && enter.t - exit.t > shift * gap(enter.t, exit.t) {
                return true;
            }
        }
        // If an end is infinite, so are the differences.
        let apart =
            |a: f64, b: f64| a == f64::NEG_INFINITY || b == f64::INFINITY || b - a > gap(a, b);
        if !(apart(before_enter, enter.t) && apart(enter.t, exit.t) && apart(exit.t, after_exit)) {
            return false;
        }
        let start = range.min;
        out.inside_at_start = enter.t <= start && start < exit.t;
        for (end, side) in [(enter, Side::Enter), (exit, Side::Exit)] {
            if let Some(plane) = self.0.get(end.index)
                && end.t > start
                && end.t <= range.max
                && end.t.is_finite()
            {
                let surface = SurfaceId {
                    element: plane.element,
                    facet: 0,
                };
                let hit = PrimHit {
                    surface,
                    ..PrimHit::simple(end.t, 0)
                };
                let t_error = plane_t_error(ray, end.t, plane.point, plane.normal);
                out.list.push(Crossing {
                    visible: plane.visible,
                    ..Crossing::new(hit, t_error, side)
                });
            }
        }
        true
    }

    /// A box around the intersection, unless it has no corner or would take too much work.
    ///
    /// A set with a corner is bounded by its edges.
    pub(super) fn bounds(&self) -> Option<Aabb> {
        let edges = self.edges()?;
        let (mut bounds, mut has_corner) = (Aabb::EMPTY, false);
        for end in &edges.ends {
            has_corner |= end.is_finite();
            bounds = bounds.union(&Aabb::new(*end, *end));
        }
        if !has_corner || bounds.is_empty() {
            return None;
        }
        let wide = DVec3::splat(edges.slack + SLACK * edges.center.abs().max_element())
            + bounds_abs(&bounds) * SLACK;
        Some(Aabb::new(
            bounds.min + edges.center - wide,
            bounds.max + edges.center + wide,
        ))
    }

    /// The corners of the intersection, within rounding, if it is bounded and not too much work; each may be there several times.
    pub(super) fn corners(&self) -> Option<Vec<DVec3>> {
        let edges = self.edges()?;
        let bounded = edges.ends.len() > 2 && edges.ends.iter().all(|end| end.is_finite());
        let corners = edges.ends.into_iter().map(|end| edges.center + end);
        bounded.then(|| corners.collect())
    }

    /// The edges of the intersection. Every edge lies on the line of two planes, where that is behind all others.
    fn edges(&self) -> Option<Edges> {
        /// Two unit normals that are closer are parallel within rounding, or their line can't be located.
        const PARALLEL: f64 = 1e-12;
        const NEARLY: f64 = 1e-6;
        if self.0.len() > Self::BOXED {
            return None;
        }
        let center = self.0.iter().fold(DVec3::ZERO, |sum, p| sum + p.point) / self.0.len() as f64;
        let offset = |plane: &HalfSpace| (plane.point - center).dot(plane.normal);
        let size = self.0.iter().fold(0.0, |size: f64, plane| {
            let offset = offset(plane).abs();
            if offset > size { offset } else { size }
        });
        let slack = SLACK * size;
        let mut ends = vec![];
        for (index, a) in self.0.iter().enumerate() {
            for b in self.0.iter().skip(index + 1) {
                let along = a.normal.cross(b.normal);
                let sine = along.length();
                if sine < PARALLEL {
                    continue;
                }
                if !(sine >= NEARLY) {
                    return None;
                }
                // The point of the line next to the centre, and the unit direction.
                let foot = (b.normal.cross(along) * offset(a) + along.cross(a.normal) * offset(b))
                    / (sine * sine);
                let along = along / sine;
                let Some(edge) = self.clip(center, foot, along, slack) else {
                    continue;
                };
                for t in [edge.min, edge.max] {
                    let reach = |x: f64, d: f64| {
                        // No step along this axis, however long the edge.
                        if d.abs() < PARALLEL { x } else { x + d * t }
                    };
                    ends.push(DVec3::new(
                        reach(foot.x, along.x),
                        reach(foot.y, along.y),
                        reach(foot.z, along.z),
                    ));
                }
            }
        }
        Some(Edges {
            center,
            slack,
            ends,
        })
    }

    /// The part of a line that is behind all planes, up to `slack`.
    fn clip(&self, center: DVec3, foot: DVec3, along: DVec3, slack: f64) -> Option<Interval> {
        let (mut min, mut max) = (f64::NEG_INFINITY, f64::INFINITY);
        for plane in &self.0 {
            let left = (plane.point - center - foot).dot(plane.normal) + slack;
            let speed = along.dot(plane.normal);
            if speed.abs() < 1e-9 {
                if left < 0.0 {
                    return None;
                }
                continue;
            }
            let t = left / speed;
            if speed > 0.0 {
                if t < max {
                    max = t;
                }
            } else if t > min {
                min = t;
            }
            if min > max {
                return None;
            }
        }
        Some(Interval::new(min, max))
    }
}

/// The largest distance of a box from the origin along each axis, as far as that is finite.
fn bounds_abs(bounds: &Aabb) -> DVec3 {
    let largest = |a: f64, b: f64| {
        let (a, b) = (a.abs(), b.abs());
        let larger = if a > b { a } else { b };
        if larger.is_finite() { larger } else { 0.0 }
    };
    DVec3::new(
        largest(bounds.min.x, bounds.max.x),
        largest(bounds.min.y, bounds.max.y),
        largest(bounds.min.z, bounds.max.z),
    )
}
