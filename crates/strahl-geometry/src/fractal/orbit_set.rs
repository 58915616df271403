//! Sets of points whose orbits stay near the origin, as solids: how rays find their surface, whatever is iterated.

use super::march::March;
use crate::implicit::{Octree, Passage};
use crate::{
    Container, Crossing, Crossings, PrimHit, Scratch, Side, Sphere, SurfaceId, SurfacePoint,
};
use std::ops::ControlFlow;
use std::sync::Arc;
use strahl_math::error::{ROUNDOFF, gamma};
use strahl_math::{Aabb, DVec3, Interval, Ray};

/// The surface of the set.
pub(super) const SURFACE: SurfaceId = SurfaceId {
    element: 0,
    facet: 0,
};

/// The ball around the set, which clips it if orbits are too short; it is invisible.
pub(super) const BALL: SurfaceId = SurfaceId {
    element: 0,
    facet: 1,
};

/// The events along a ray.
pub(super) enum Event {
    /// The ray starts in the ball around the set, inside of the set from there on or not.
    Start { inside: bool },
    /// It crosses the surface, or (unseen) the ball around the set within it.
    Crossing {
        t: f64,
        surface: SurfaceId,
        enters: bool,
    },
}

/// How a point lies to the surface.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Place {
    /// Half of the squared length of the orbit's end over that of the bail-out radius, less a half: negative inside of the set,
    /// infinite if the end is not a number.
    pub(super) value: f64,
    /// There is no surface nearer than this, by an estimate or a proof.
    pub(super) reach: f64,
}

/// How many points of a line are looked at together: two vectors. The steps of an orbit wait for each other, so that two vectors take hardly
/// longer than one.
pub(super) const AHEAD: usize = 8;

/// How several points of a line lie to the surface, as [`Place`]s.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Places {
    pub(super) values: [f64; AHEAD],
    pub(super) reaches: [f64; AHEAD],
}

/// What is the same for all sets: the ball that they are searched in, and what is known of it.
#[derive(Clone, Debug)]
pub(super) struct BallSearch {
    around: Container,
    pub(super) radius: f64,
    /// The least step.
    pub(super) shortest: f64,
    octree: Arc<Octree>,
}

impl BallSearch {
    /// In the ball around the origin, in an octree whose cells are halved `levels` times; features smaller than a fiftieth of the
    /// reciprocal of `precision` may be missed. The set lies within `reach`, which is not above the radius.
    pub(super) fn new(radius: f64, reach: f64, precision: f64, levels: u32) -> Self {
        let precision = if precision > 1.0 { precision } else { 1.0 };
        Self {
            around: Container::Sphere(Sphere::new(DVec3::ZERO, reach)),
            radius,
            shortest: radius / (50.0 * precision),
            octree: Arc::new(Octree::new(
                Aabb::new(DVec3::splat(-reach), DVec3::splat(reach)),
                levels,
            )),
        }
    }

    pub(super) fn bounds(&self) -> Aabb {
        self.around.bounds()
    }
}

/// A set of points whose orbits stay near the origin.
pub(super) trait OrbitSet: Sized {
    /// The ball around the set.
    fn search(&self) -> &BallSearch;
    /// The [`Place::value`] of a point.
    fn value(&self, p: DVec3) -> f64;
    /// How a point lies to the surface.
    fn place(&self, p: DVec3) -> Place;
    /// Stores how points of a line lie to the surface, those at `origin + direction s`, if that takes little more time than one;
    /// else does nothing and returns `false`.
    // In place: a result of this size would be read before its stores have ended.
    fn store_places(&self, _line: (DVec3, DVec3), _s: &[f64; AHEAD], _out: &mut Places) -> bool {
        false
    }
    /// Whether the points up to this distance from a point are all inside of the set or all outside.
    fn is_decided(&self, center: DVec3, radius: f64) -> bool;
    /// The gradient of the value.
    fn gradient(&self, p: DVec3) -> DVec3;
    /// A bound of the rounding error of the value.
    fn noise(&self, p: DVec3) -> f64;
    /// The length of a direction as [`Place::reach`] counts it.
    fn speed(&self, direction: DVec3) -> f64 {
        direction.length()
    }

    /// Reports the events along a ray to the visitor until it stops. Those outside of the range may be left out.
    ///
    /// The line is searched from the ray's origin on, and what is behind the origin by itself, if it is asked for: so what is found ahead
    /// does not depend on the range.
    fn walk(
        &self,
        ray: &Ray,
        (range, from): (Interval, Option<SurfaceId>),
        mut visit: impl FnMut(Event) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let Some(passage) = self.search().around.passage(ray, None) else {
            return ControlFlow::Continue(());
        };
        let (enter, exit) = (passage.start(), passage.exit.hit.t);
        // A little before the origin, for ranges that begin there, unless the ray starts on the surface.
        let origin = match from {
            Some(_) => 0.0,
            None => -self.search().shortest / ray.direction.abs().max_element(),
        };
        let start = if enter < origin { origin } else { enter };
        let is_behind = enter < start && range.min < start && from.is_none();
        let behind = if is_behind && start < exit {
            Some(start)
        } else if is_behind {
            Some(exit)
        } else {
            None
        };
        let mut side = None;
        if let Some(end) = behind {
            let part = (enter, end);
            side = self.search_part(ray, part, (range, None), &passage, None, &mut visit)?;
        }
        self.search_part(
            ray,
            (start, exit),
            (range, from),
            &passage,
            side,
            &mut visit,
        )?;
        ControlFlow::Continue(())
    }

    /// Reports the events in a part of a ray, and the side at its end if it goes on there. `side` is the side at its start if the part
    /// before has been searched.
    fn search_part(
        &self,
        ray: &Ray,
        (start, end): (f64, f64),
        (range, from): (Interval, Option<SurfaceId>),
        passage: &Passage,
        side: Option<bool>,
        visit: &mut impl FnMut(Event) -> ControlFlow<()>,
    ) -> ControlFlow<(), Option<bool>> {
        if !(start < end && end.is_finite() && start.is_finite()) {
            return ControlFlow::Continue(side);
        }
        let (length, origin) = (end - start, ray.at(start));
        // An empty range has a side at its start, too.
        let needed = range.max.max(range.min) - start;
        let line = (origin, ray.direction);
        let mut march = March::new(self, line, (start, length, needed), visit);
        if from.is_some() && march.value.abs() < self.noise(origin) {
            // Where rounding hides the side, the direction of the ray decides.
            let leaves = self.gradient(origin).dot(ray.direction) >= 0.0;
            march.set_side(!leaves);
        }
        let inside = march.inside;
        match side {
            // Where rounding hides the side, it is that of the part before.
            Some(side) if side != inside => march.set_side(side),
            Some(_) => {}
            None if started_within(passage, start) => (march.visit)(Event::Start { inside })?,
            None if inside => (march.visit)(Event::Crossing {
                t: start,
                surface: BALL,
                enters: true,
            })?,
            None => {}
        }
        let cells = &self.search().octree;
        cells.walk(Interval::new(0.0, length), &mut march)?;
        if end < passage.exit.hit.t {
            march.finish()?;
            return ControlFlow::Continue(Some(march.inside));
        }
        march.leave()?;
        ControlFlow::Continue(None)
    }

    fn t_error(&self, ray: &Ray, t: f64) -> f64 {
        let p = ray.at(t);
        let gradient = self.gradient(p);
        let reach = (ray.origin.abs() + (ray.direction * t).abs()) * gamma(4);
        let error = (self.noise(p) + gradient.abs().dot(reach)) / gradient.dot(ray.direction).abs();
        let longest = self.search().shortest / ray.direction.abs().max_element();
        gamma(4) * t.abs() + if error < longest { error } else { longest }
    }

    /// The first hit in a range.
    fn first(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        _scratch: &mut Scratch,
    ) -> Option<PrimHit> {
        let mut closest = None;
        // The result only matters while visiting.
        let _ = self.walk(ray, (range, from), |event| match event {
            Event::Crossing { t, surface, .. } if surface == SURFACE && range.accepts(t) => {
                closest = Some(PrimHit::simple(t, SURFACE.facet));
                ControlFlow::Break(())
            }
            Event::Crossing { t, .. } if t > range.max => ControlFlow::Break(()),
            _ => ControlFlow::Continue(()),
        });
        closest
    }

    /// The surface at a hit, moved onto it.
    fn settled(&self, ray: &Ray, hit: &PrimHit) -> SurfacePoint {
        if hit.surface == BALL {
            return self
                .search()
                .around
                .surface_at(ray, &PrimHit::simple(hit.t, 0));
        }
        let mut p = ray.at(hit.t);
        let mut value = self.value(p);
        let mut gradient = self.gradient(p);
        for _ in 0..2 {
            let step = gradient * (value / gradient.dot(gradient));
            if !(step.length() < self.search().shortest) {
                break;
            }
            let next = self.value(p - step);
            if !(next.abs() < value.abs()) {
                break;
            }
            p -= step;
            value = next;
            gradient = self.gradient(p);
        }
        let off = (self.noise(p) + value.abs()) / gradient.length();
        let off = if off < self.search().shortest {
            off
        } else {
            self.search().shortest
        };
        let normal = gradient
            .try_normalize()
            .or_else(|| (-ray.direction).try_normalize())
            .unwrap_or(DVec3::Y);
        let error = DVec3::splat(off + f64::MIN_POSITIVE) + p.abs() * (4.0 * ROUNDOFF);
        SurfacePoint::bare(p, error, normal)
    }

    /// All crossings, as [`Solid::crossings`](crate::Solid::crossings) lists them.
    fn list(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        _scratch: &mut Scratch,
        out: &mut Crossings,
    ) {
        let start = if from.is_some() && range.min < 0.0 {
            0.0
        } else {
            range.min
        };
        let needed = Interval::new(start, range.max);
        let _ = self.walk(ray, (needed, from), |event| {
            match event {
                Event::Start { inside } => out.inside_at_start = inside,
                Event::Crossing { t, enters, .. } if t <= start => out.inside_at_start = enters,
                Event::Crossing { t, surface, enters } if t <= range.max => {
                    let side = if enters { Side::Enter } else { Side::Exit };
                    let hit = PrimHit::simple(t, surface.facet);
                    let mut crossing = Crossing::new(hit, self.t_error(ray, t), side);
                    crossing.visible = surface == SURFACE;
                    out.list.push(crossing);
                }
                Event::Crossing { .. } => return ControlFlow::Break(()),
            }
            ControlFlow::Continue(())
        });
    }

    /// Whether a point is in the set.
    fn holds(&self, point: DVec3) -> bool {
        self.search().around.contains(point) && self.value(point) <= 0.0
    }
}

/// Whether the ray enters the ball before this.
fn started_within(passage: &Passage, start: f64) -> bool {
    passage.enter.is_none_or(|enter| enter.hit.t < start)
}
