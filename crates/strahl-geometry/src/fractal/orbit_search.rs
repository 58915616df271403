//! How rays find the surface of a set of points whose orbits stay near the origin.

use super::march::March;
use super::orbit_set::{BALL, Event, OrbitSet, SURFACE};
use crate::implicit::{EXACT, Passage};
use crate::{Crossing, Crossings, PrimHit, Side, SurfaceId, SurfacePoint};
use std::ops::ControlFlow;
use strahl_math::error::{ROUNDOFF, gamma};
use strahl_math::{DVec3, Interval, Ray};

/// What is asked of a ray.
#[derive(Clone, Copy)]
struct Asked {
    range: Interval,
    from: Option<SurfaceId>,
    /// Of crossings that certainly are in this range an approximate place is enough.
    rough: Interval,
}

/// Reports the events along a ray to the visitor until it stops. Those outside of the range may be left out.
///
/// The line is searched from the ray's origin on, and what is behind the origin by itself, if it is asked for: so what is found ahead
/// does not depend on the range.
fn walk(
    set: &impl OrbitSet,
    ray: &Ray,
    asked: Asked,
    mut visit: impl FnMut(Event) -> ControlFlow<()>,
) -> ControlFlow<()> {
    let Asked { range, from, .. } = asked;
    let Some(passage) = set.search().around.passage(ray, None) else {
        return ControlFlow::Continue(());
    };
    let (enter, exit) = (passage.start(), passage.exit.hit.t);
    // A little before the origin, for ranges that begin there, unless the ray starts on the surface.
    let origin = match from {
        Some(_) => 0.0,
        None => -set.search().shortest / ray.direction.abs().max_element(),
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
        let asked = Asked {
            from: None,
            ..asked
        };
        side = search_part(set, ray, part, asked, &passage, None, &mut visit)?;
    }
    let part = (start, exit);
    search_part(set, ray, part, asked, &passage, side, &mut visit)?;
    ControlFlow::Continue(())
}

/// Reports the events in a part of a ray, and the side at its end if it goes on there. `side` is the side at its start if the part
/// before has been searched.
fn search_part(
    set: &impl OrbitSet,
    ray: &Ray,
    (start, end): (f64, f64),
    asked: Asked,
    passage: &Passage,
    side: Option<bool>,
    visit: &mut impl FnMut(Event) -> ControlFlow<()>,
) -> ControlFlow<(), Option<bool>> {
    if !(start < end && end.is_finite() && start.is_finite()) {
        return ControlFlow::Continue(side);
    }
    let (length, origin) = (end - start, ray.at(start));
    // An empty range has a side at its start, too.
    let needed = asked.range.max.max(asked.range.min) - start;
    let line = (origin, ray.direction);
    let mut march = March::new(set, line, (start, length, needed), asked.rough, visit);
    if asked.from.is_some() && march.value.abs() < set.noise(origin) {
        // Where rounding hides the side, the direction of the ray decides.
        let leaves = set.gradient(origin).dot(ray.direction) >= 0.0;
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
    let cells = &set.search().octree;
    cells.walk(Interval::new(0.0, length), &mut march)?;
    if end < passage.exit.hit.t {
        march.finish()?;
        return ControlFlow::Continue(Some(march.inside));
    }
    march.leave()?;
    ControlFlow::Continue(None)
}

/// How far the parameter of a crossing may be from its exact value.
fn t_error(set: &impl OrbitSet, ray: &Ray, t: f64) -> f64 {
    let p = ray.at(t);
    let gradient = set.gradient(p);
    let reach = (ray.origin.abs() + (ray.direction * t).abs()) * gamma(4);
    let error = (set.noise(p) + gradient.abs().dot(reach)) / gradient.dot(ray.direction).abs();
    let longest = set.search().shortest / ray.direction.abs().max_element();
    gamma(4) * t.abs() + if error < longest { error } else { longest }
}

/// The first hit in a range.
pub(super) fn closest_hit(
    set: &impl OrbitSet,
    ray: &Ray,
    range: Interval,
    from: Option<SurfaceId>,
) -> Option<PrimHit> {
    let asked = Asked {
        range,
        from,
        rough: EXACT,
    };
    first_hit(set, ray, asked)
}

/// Whether there is a hit in a range. Where it is need not be computed.
pub(super) fn any_hit(
    set: &impl OrbitSet,
    ray: &Ray,
    range: Interval,
    from: Option<SurfaceId>,
) -> bool {
    let asked = Asked {
        range,
        from,
        rough: range,
    };
    first_hit(set, ray, asked).is_some()
}

fn first_hit(set: &impl OrbitSet, ray: &Ray, asked: Asked) -> Option<PrimHit> {
    let range = asked.range;
    let mut closest = None;
    // The result only matters while visiting.
    let _ = walk(set, ray, asked, |event| match event {
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
pub(super) fn surface_at(set: &impl OrbitSet, ray: &Ray, hit: &PrimHit) -> SurfacePoint {
    if hit.surface == BALL {
        return set
            .search()
            .around
            .surface_at(ray, &PrimHit::simple(hit.t, 0));
    }
    let mut p = ray.at(hit.t);
    let mut value = set.value(p);
    let mut gradient = set.gradient(p);
    let noise = set.noise(p);
    for _ in 0..2 {
        if value.abs() <= noise {
            break;
        }
        let step = gradient * (value / gradient.dot(gradient));
        if !(step.length() < set.search().shortest) {
            break;
        }
        let next = set.value(p - step);
        if !(next.abs() < value.abs()) {
            break;
        }
        p -= step;
        value = next;
        gradient = set.gradient(p);
    }
    let off = (noise + value.abs()) / gradient.length();
    let off = if off < set.search().shortest {
        off
    } else {
        set.search().shortest
    };
    let normal = gradient
        .try_normalize()
        .or_else(|| (-ray.direction).try_normalize())
        .unwrap_or(DVec3::Y);
    let error = DVec3::splat(off + f64::MIN_POSITIVE) + p.abs() * (4.0 * ROUNDOFF);
    SurfacePoint::bare(p, error, normal)
}

/// All crossings, as [`Solid::crossings`](crate::Solid::crossings) lists them.
pub(super) fn crossings(
    set: &impl OrbitSet,
    ray: &Ray,
    range: Interval,
    from: Option<SurfaceId>,
    out: &mut Crossings,
) {
    let start = if from.is_some() && range.min < 0.0 {
        0.0
    } else {
        range.min
    };
    let asked = Asked {
        range: Interval::new(start, range.max),
        from,
        rough: EXACT,
    };
    let _ = walk(set, ray, asked, |event| {
        match event {
            Event::Start { inside } => out.inside_at_start = inside,
            Event::Crossing { t, enters, .. } if t <= start => out.inside_at_start = enters,
            Event::Crossing { t, surface, enters } if t <= range.max => {
                let side = if enters { Side::Enter } else { Side::Exit };
                let hit = PrimHit::simple(t, surface.facet);
                let mut crossing = Crossing::new(hit, t_error(set, ray, t), side);
                crossing.visible = surface == SURFACE;
                out.list.push(crossing);
            }
            Event::Crossing { .. } => return ControlFlow::Break(()),
        }
        ControlFlow::Continue(())
    });
}

/// Whether a point is in the set.
pub(super) fn contains(set: &impl OrbitSet, point: DVec3) -> bool {
    set.search().around.contains(point) && set.value(point) <= 0.0
}

/// Whether the ray enters the ball before this.
fn started_within(passage: &Passage, start: f64) -> bool {
    passage.enter.is_none_or(|enter| enter.hit.t < start)
}
