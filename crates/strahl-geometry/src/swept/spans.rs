//! Crossings of a whole line, for the swept shapes.

use crate::primitives::start_of;
use crate::{Crossing, Crossings, PrimHit, Scratch, Side, SurfaceId};
use strahl_math::error::gamma;
use strahl_math::{DVec3, Interval, Ray};

/// A shape that computes the crossings of a whole line, whatever the range.
pub(super) trait WholeLine {
    /// Fills the list with the crossings of the whole line, in the order along the ray.
    fn walk(&self, ray: &Ray, from: Option<SurfaceId>, list: &mut Crossings);

    /// The unit normal at a hit, on the outer side.
    fn normal(&self, ray: &Ray, hit: &PrimHit) -> DVec3;

    /// A bound of the coordinates of all points of the shape.
    fn reach(&self) -> f64;

    /// The first visible hit in the range.
    fn first_hit(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        scratch: &mut Scratch,
    ) -> Option<PrimHit> {
        first_of_walk(self, ray, range, from, scratch)
    }

    /// Whether there is a visible hit in the range.
    fn any_hit(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        scratch: &mut Scratch,
    ) -> bool {
        self.first_hit(ray, range, from, scratch).is_some()
    }

    /// The crossings in the range with the errors of their parameters, and what is inside at its start.
    fn all_crossings(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        scratch: &mut Scratch,
        out: &mut Crossings,
    ) {
        crossings_of_walk(self, ray, range, from, scratch, out);
    }
}

/// The first visible hit in the range, from all crossings.
pub(super) fn first_of_walk(
    shape: &(impl WholeLine + ?Sized),
    ray: &Ray,
    range: Interval,
    from: Option<SurfaceId>,
    scratch: &mut Scratch,
) -> Option<PrimHit> {
    let mut list = scratch.take();
    shape.walk(ray, from, &mut list);
    let start = start_of(range, from);
    let counts = |t: f64| range.accepts(t) && start < t;
    let mut seen = list.list.iter().filter(|c| c.visible && counts(c.hit.t));
    let hit = seen.next().map(|crossing| crossing.hit);
    scratch.give(list);
    hit
}

/// The crossings in the range, from all of the line.
pub(super) fn crossings_of_walk(
    shape: &(impl WholeLine + ?Sized),
    ray: &Ray,
    range: Interval,
    from: Option<SurfaceId>,
    scratch: &mut Scratch,
    out: &mut Crossings,
) {
    let mut list = scratch.take();
    shape.walk(ray, from, &mut list);
    let start = start_of(range, from);
    for crossing in &list.list {
        let t = crossing.hit.t;
        if t <= start {
            out.inside_at_start = crossing.side == Side::Enter;
        } else if range.accepts(t) {
            let mut crossing = *crossing;
            crossing.t_error = t_error(ray, t, shape.normal(ray, &crossing.hit), shape.reach());
            out.list.push(crossing);
        }
    }
    scratch.give(list);
}

/// A bound of the distance of a ray's start from the surface it lies on, relative to the shape's size: 2⁻¹².
///
/// This does not decide where a surface is. A ray says itself that it starts on a piece of surface; the start is then the
/// nearest crossing with that piece. The limit only keeps a crossing elsewhere from being taken for it if rounding has lost the
/// right one, as may happen beside an edge.
pub(super) const NEAR: f64 = 1.0 / 4096.0;

/// Whether a hit with this normal is so near that it may be the start of the ray.
pub(super) fn near_the_start(ray: &Ray, hit: &PrimHit, size: f64, normal: DVec3) -> bool {
    (normal.dot(ray.direction) * hit.t).abs() <= NEAR * size
}

/// Root identity: of the crossings for which `normal` returns a vector, the nearest to 0 is the start of the ray, and gets `t =
/// 0`.
///
/// The start has been moved off the surface to the side that the ray leaves towards, so of the two crossings of a short chord
/// that of the start is the nearer one, and where rays graze both may be missing.
pub(super) fn snap(
    crossings: &mut [Crossing],
    ray: &Ray,
    size: f64,
    normal: impl Fn(&PrimHit) -> Option<DVec3>,
) {
    let mut nearest: Option<&mut Crossing> = None;
    for crossing in crossings {
        let t = crossing.hit.t.abs();
        if nearest.as_ref().is_some_and(|best| best.hit.t.abs() <= t) {
            continue;
        }
        if let Some(n) = normal(&crossing.hit)
            && near_the_start(ray, &crossing.hit, size, n)
        {
            nearest = Some(crossing);
        }
    }
    if let Some(crossing) = nearest {
        crossing.hit.t = 0.0;
    }
}

/// The error of the parameter at which a ray crosses a surface with this normal, if points near it are exact up to rounding of
/// their coordinates; a surface crossed at a grazing angle has a curvature of about `size`.
pub(super) fn t_error(ray: &Ray, t: f64, normal: DVec3, size: f64) -> f64 {
    let point = gamma(48) * (ray.origin.length() + (ray.direction * t).length() + size);
    let speed = ray.direction.length();
    let straight = point / normal.dot(ray.direction).abs();
    let tangent = (2.0 * size * point).sqrt() / speed;
    let across = if straight < tangent {
        straight
    } else {
        tangent
    };
    gamma(4) * t.abs() + across
}

/// Checks of the shapes that find their first hit without walking along the whole line.
#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::conformance::Random;

    /// The first hit is that of the walk, bit for bit, and any hit says whether there is one: of rays from outside, from inside and from the
    /// surface, in ranges of all kinds.
    pub(in crate::swept) fn first_hits_are_those_of_the_walk(shape: &impl WholeLine) {
        let mut random = Random::new(11);
        let mut scratch = Scratch::default();
        let reach = shape.reach();
        let mut found = 0;
        for round in 0..4000 {
            let mut point = |size: f64| {
                let mut one = || random.between(-size, size);
                DVec3::new(one(), one(), one())
            };
            let origin = point(if round % 3 == 0 { reach } else { 3.0 * reach });
            let mut target = point(reach);
            if round % 7 == 0 {
                target.y = origin.y; // Level rays.
            }
            let mut ray = Ray::new(origin, target - origin);
            let mut from = None;
            for range in [
                Interval::FORWARD,
                Interval::LINE,
                Interval::new(0.5, 1.2),
                Interval::new(-1.0, 0.9),
            ] {
                let expected = first_of_walk(shape, &ray, range, from, &mut scratch);
                let hit = shape.first_hit(&ray, range, from, &mut scratch);
                assert_eq!(hit, expected, "{ray:?} {range:?} {from:?}");
                let [mut all, mut some] = [Crossings::default(), Crossings::default()];
                crossings_of_walk(shape, &ray, range, from, &mut scratch, &mut all);
                shape.all_crossings(&ray, range, from, &mut scratch, &mut some);
                assert_eq!(some.list, all.list, "{ray:?} {range:?} {from:?}");
                assert_eq!(some.inside_at_start, all.inside_at_start);
                let any = shape.any_hit(&ray, range, from, &mut scratch);
                assert_eq!(any, expected.is_some(), "{ray:?} {range:?} {from:?}");
                found += usize::from(hit.is_some());
                if let Some(hit) = hit {
                    // On from the surface.
                    ray = Ray::new(ray.at(hit.t), point(1.0));
                    from = Some(hit.surface);
                }
            }
        }
        assert!(found > 1000, "{found}");
    }
}
