use crate::primitives::convex::start_of;
use crate::{Crossing, Crossings, PrimHit, Side, SurfaceId};
use std::ops::ControlFlow;
use strahl_math::Interval;

/// The events along a ray, in this order.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Event {
    /// The state just behind the start of the range. Without this event it is outside.
    Start { inside: bool },
    /// The surface is crossed.
    Crossing { t: f64, t_error: f64, enters: bool },
}

/// A query for the crossings of a ray.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Question {
    pub(crate) range: Interval,
    /// Whether the ray starts on the surface.
    pub(crate) on_surface: bool,
    /// Whether the errors of the parameters are wanted.
    pub(crate) errors: bool,
}

/// The first crossing in the range.
pub(super) fn closest(
    range: Interval,
    from: Option<SurfaceId>,
    walk: impl FnOnce(&Question, &mut dyn FnMut(Event) -> ControlFlow<()>),
) -> Option<PrimHit> {
    let question = Question {
        range,
        on_surface: from.is_some(),
        errors: false,
    };
    let mut closest = None;
    walk(&question, &mut |event| match event {
        Event::Crossing { t, .. } if range.accepts(t) && t.is_finite() => {
            closest = Some(PrimHit::simple(t, 0));
            ControlFlow::Break(())
        }
        _ => ControlFlow::Continue(()),
    });
    closest
}

/// Appends all crossings in the range.
pub(super) fn all(
    range: Interval,
    from: Option<SurfaceId>,
    out: &mut Vec<PrimHit>,
    walk: impl FnOnce(&Question, &mut dyn FnMut(Event) -> ControlFlow<()>),
) {
    let question = Question {
        range,
        on_surface: from.is_some(),
        errors: false,
    };
    // The lower end of a range is open, and so is that behind a hit.
    let mut rest = range;
    walk(&question, &mut |event| match event {
        Event::Crossing { t, .. } if rest.accepts(t) && t.is_finite() => {
            rest.min = t;
            out.push(PrimHit::simple(t, 0));
            ControlFlow::Continue(())
        }
        Event::Crossing { t, .. } if t > range.max => ControlFlow::Break(()),
        _ => ControlFlow::Continue(()),
    });
}

/// Lists the crossings as [`crate::Solid::crossings`] wants them.
pub(super) fn list(
    range: Interval,
    from: Option<SurfaceId>,
    out: &mut Crossings,
    walk: impl FnOnce(&Question, &mut dyn FnMut(Event) -> ControlFlow<()>),
) {
    let question = Question {
        range,
        on_surface: from.is_some(),
        errors: !out.without_errors,
    };
    let start = start_of(range, from);
    walk(&question, &mut |event| {
        match event {
            Event::Start { inside } => out.inside_at_start = inside,
            Event::Crossing { t, enters, .. } if t <= start => out.inside_at_start = enters,
            Event::Crossing { t, t_error, enters } if t <= range.max && t.is_finite() => {
                let side = if enters { Side::Enter } else { Side::Exit };
                out.list
                    .push(Crossing::new(PrimHit::simple(t, 0), t_error, side));
            }
            Event::Crossing { .. } => return ControlFlow::Break(()),
        }
        ControlFlow::Continue(())
    });
}
