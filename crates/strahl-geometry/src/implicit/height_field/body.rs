//! The solid below a height field.

use super::Surface;
use crate::primitives::plane_t_error;
use crate::{
    Crossing, Crossings, GeometryError, PrimHit, Primitive, Scratch, Side, Solid, SurfaceId,
    SurfacePoint,
};
use std::cmp::Ordering;
use std::ops::ControlFlow;
use strahl_math::error::gamma;
use strahl_math::{Aabb, DVec3, Interval, Ray};

/// A height field as a solid: everything on the unit square below the surface or the water level.
///
/// A crossing is a candidate at which `contains` changes: between neighbouring candidates one point decides. So entering and
/// leaving alternate even where a ray runs along an edge, which it may seem to hit twice or not at all.
#[derive(Debug)]
pub(super) struct Body(pub(super) Surface);

/// How many times the distance at which candidates count as one the searched part of a ray reaches beyond what is asked for, so that the
/// point which decides beside the last candidate that counts is not too near to it.
const APART: f64 = 64.0;

/// The planes that bound the solid, by their facets on the last element: the outward normal and a point.
fn walls(water: f64) -> [(DVec3, DVec3); 5] {
    [
        (-DVec3::X, DVec3::ZERO),
        (DVec3::X, DVec3::ONE),
        (-DVec3::Z, DVec3::ZERO),
        (DVec3::Z, DVec3::ONE),
        (DVec3::Y, DVec3::Y * water),
    ]
}

impl Body {
    /// The number of the element that is the walls.
    fn walls_element(&self) -> u32 {
        self.0.triangles()
    }

    /// The level of the water, which does not rise above the highest point (measured).
    fn level(&self) -> f64 {
        let [_, high] = self.0.grid.full_range();
        (f64::from(high) / super::SCALE).min(self.0.water)
    }

    /// The plane of a piece of wall.
    fn wall(&self, surface: SurfaceId) -> Option<(DVec3, DVec3)> {
        if surface.element != self.walls_element() {
            return None;
        }
        walls(self.level()).get(surface.facet as usize).copied()
    }

    /// The candidates for crossings of a ray in a range, ascending; all marked as inner, without errors.
    fn candidates(&self, ray: &Ray, range: Interval, from: Option<SurfaceId>, out: &mut Crossings) {
        let skip = from.map(|surface| surface.element);
        self.0.visit_hits(ray, range, skip, |_, hit| {
            out.list.push(Crossing::new(hit, 0.0, Side::Inner));
            ControlFlow::Continue(())
        });
        for (facet, (normal, point)) in walls(self.level()).into_iter().enumerate() {
            let surface = SurfaceId {
                element: self.walls_element(),
                facet: facet as u32,
            };
            let t = (point - ray.origin).dot(normal) / ray.direction.dot(normal);
            if from == Some(surface) || !t.is_finite() || !range.accepts(t) {
                continue;
            }
            let uv = [0.0; 2];
            let hit = PrimHit { t, surface, uv };
            let mut crossing = Crossing::new(hit, 0.0, Side::Inner);
            crossing.visible = false;
            out.list.push(crossing);
        }
        let key = |c: &Crossing| (c.hit.t, c.hit.surface.element, c.hit.surface.facet);
        out.list
            .sort_unstable_by(|a, b| key(a).partial_cmp(&key(b)).unwrap_or(Ordering::Equal));
    }

    fn normal(&self, hit: &PrimHit) -> (DVec3, DVec3) {
        self.wall(hit.surface)
            .unwrap_or_else(|| self.0.plane_at(hit))
    }

    /// The error of the parameter of a hit; for rays along a triangle at most the length of the field.
    fn t_error(&self, ray: &Ray, hit: &PrimHit) -> f64 {
        let (normal, point) = self.normal(hit);
        let error = plane_t_error(ray, hit.t, point, normal);
        let longest = 2.0 / ray.direction.abs().max_element();
        if error < longest { error } else { longest }
    }

    /// Of coincident candidates the one that represents the change: visible if there is one, and facing the ray as the change
    /// demands.
    fn choose(&self, ray: &Ray, cluster: &[Crossing], enters: bool) -> Option<Crossing> {
        let rank = |c: &Crossing| {
            let against = ray.direction.dot(self.normal(&c.hit).0) < 0.0;
            (!c.visible, against != enters)
        };
        let best = match cluster {
            [only] => Some(*only),
            _ => cluster.iter().min_by_key(|c| rank(c)).copied(),
        };
        best.map(|c| Crossing {
            side: if enters { Side::Enter } else { Side::Exit },
            t_error: self.t_error(ray, &c.hit),
            ..c
        })
    }
}

impl Solid for Body {
    fn inside_bounds(&self) -> Aabb {
        let [_, high] = self.0.grid.full_range();
        let min = DVec3::new(0.0, f64::NEG_INFINITY, 0.0);
        Aabb::new(min, DVec3::new(1.0, f64::from(high) / super::SCALE, 1.0))
    }

    fn crossings(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        scratch: &mut Scratch,
        out: &mut Crossings,
    ) {
        let speed = ray.direction.abs().max_element();
        if !(speed > 0.0 && ray.direction.is_finite() && ray.origin.is_finite()) {
            return;
        }
        let start = if from.is_some() && range.min < 0.0 {
            0.0
        } else {
            range.min
        };
        let rounding =
            |t: f64| gamma(32) * ((ray.origin.abs().max_element() + 1.0) / speed + t.abs());
        // An empty range has a side at its start, too.
        let end = if start < range.max { range.max } else { start };
        // Candidates that may coincide with others in the range count, too. An end at infinity stays there.
        let part = Interval::new(start - APART * rounding(start), end + APART * rounding(end));
        let mut found = scratch.take();
        self.candidates(ray, part, from, &mut found);
        let mut list = found.list.as_slice();
        let mut begin = part.min;
        if from.is_some() {
            let behind = list.iter().take_while(|c| c.hit.t <= start).count();
            list = &list[behind..];
            begin = start;
        }
        // Between candidates nothing changes, nor before the first one and behind the last one, so any point there will do.
        let step = 1.0 / speed;
        let between = |a: f64, b: f64| match (a.is_finite(), b.is_finite()) {
            (true, true) => 0.5 * (a + b),
            (true, false) => a + (step + a.abs()),
            (false, true) => b - (step + b.abs()),
            (false, false) => 0.0,
        };
        let next = |list: &[Crossing]| list.first().map_or(part.max, |c| c.hit.t);
        let mut inside = self.contains(ray.at(between(begin, next(list))));
        out.inside_at_start = inside;
        while !list.is_empty() {
            let joined =
                |pair: &[Crossing]| pair[1].hit.t - pair[0].hit.t <= rounding(pair[1].hit.t);
            let count = 1 + list.windows(2).take_while(|pair| joined(pair)).count();
            let (cluster, rest) = list.split_at(count);
            list = rest;
            let last = cluster.last().map_or(0.0, |c| c.hit.t);
            let now = self.contains(ray.at(between(last, next(rest))));
            if std::mem::replace(&mut inside, now) == now {
                continue;
            }
            let Some(crossing) = self.choose(ray, cluster, now) else {
                continue;
            };
            if crossing.hit.t <= start {
                out.inside_at_start = now;
            } else if crossing.hit.t <= range.max {
                out.list.push(crossing);
            }
        }
        scratch.give(found);
    }

    fn contains(&self, point: DVec3) -> bool {
        let unit = 0.0..=1.0;
        if !(unit.contains(&point.x) && unit.contains(&point.z)) {
            return false;
        }
        point.y <= self.level() || point.y <= self.0.grid.height_at(point.x, point.z)
    }
}

/// As a primitive it shows the same surface, except where a ray only touches it.
impl Primitive for Body {
    fn kind(&self) -> &'static str {
        "height_field"
    }

    fn validate(&self) -> Result<(), GeometryError> {
        Ok(())
    }

    fn bounds(&self) -> Aabb {
        self.0.bounds()
    }

    fn elements(&self) -> u32 {
        self.walls_element() + 1
    }

    fn closest_hit(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        scratch: &mut Scratch,
    ) -> Option<PrimHit> {
        let mut list = scratch.take();
        self.crossings(ray, range, from, scratch, &mut list);
        let first = list.list.iter().find(|c| c.visible).map(|c| c.hit);
        scratch.give(list);
        first
    }

    fn surface_at(&self, ray: &Ray, hit: &PrimHit) -> SurfacePoint {
        match self.wall(hit.surface) {
            Some((normal, point)) => {
                let on_ray = ray.at(hit.t);
                let position = on_ray - normal * (on_ray - point).dot(normal);
                let reach = ray.origin.abs() + (ray.direction * hit.t).abs() + DVec3::ONE;
                SurfacePoint::bare(position, reach * gamma(8), normal)
            }
            None => self.0.surface_at(hit),
        }
    }

    fn as_solid(&self) -> Option<&dyn Solid> {
        Some(self)
    }
}
