//! Convex solids: a line is inside them on one span, between two ends.

use crate::{Crossing, Crossings, PrimHit, Side, SurfaceId};
use strahl_math::Interval;

/// One end of a span, with its facet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct End {
    /// Ray parameter; infinite if the span has no end on this side.
    pub(crate) t: f64,
    /// The facet crossed there.
    pub(crate) facet: u32,
}

/// The parameters for which a line is inside a convex solid: `enter.t < exit.t`.
///
/// A ray that starts on the solid has the end on that facet at exactly `t = 0` (root identity), and that end is never
/// reported.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Span {
    pub(crate) enter: End,
    pub(crate) exit: End,
}

impl Span {
    /// The span of a whole line.
    pub(crate) const LINE: Self = Self {
        enter: End {
            t: f64::NEG_INFINITY,
            facet: 0,
        },
        exit: End {
            t: f64::INFINITY,
            facet: 0,
        },
    };

    /// The part that lies behind `enter` and before `exit` too; `None` if it is empty or a parameter is NaN.
    ///
    /// An edge belongs to the facet that was there first: equal parameters change nothing.
    #[inline]
    pub(crate) fn cut(mut self, enter: End, exit: End) -> Option<Self> {
        if enter.t > self.enter.t {
            self.enter = enter;
        }
        if exit.t < self.exit.t {
            self.exit = exit;
        }
        // The first comparison is false for NaN, which must not count as "no restriction".
        (enter.t <= exit.t && self.enter.t < self.exit.t).then_some(self)
    }

    /// The first end in the range.
    #[inline]
    pub(crate) fn closest(&self, range: Interval, from: Option<SurfaceId>) -> Option<PrimHit> {
        let start = from.map(|surface| surface.facet);
        let counts = |end: End| {
            range.accepts(end.t) && end.t.is_finite() && !(end.t == 0.0 && start == Some(end.facet))
        };
        if counts(self.enter) {
            return Some(PrimHit::simple(self.enter.t, self.enter.facet));
        }
        counts(self.exit).then(|| PrimHit::simple(self.exit.t, self.exit.facet))
    }

    /// Lists the ends in the range as [`crate::Solid::crossings`] wants them.
    pub(crate) fn list(
        &self,
        range: Interval,
        from: Option<SurfaceId>,
        t_error: impl Fn(End) -> f64,
        out: &mut Crossings,
    ) {
        let start = start_of(range, from);
        out.inside_at_start = self.enter.t <= start && start < self.exit.t;
        for (end, side) in [(self.enter, Side::Enter), (self.exit, Side::Exit)] {
            if end.t > start && end.t <= range.max && end.t.is_finite() {
                out.list.push(Crossing::new(
                    PrimHit::simple(end.t, end.facet),
                    t_error(end),
                    side,
                ));
            }
        }
    }
}

/// Where a line is inside of a solid that it crosses at most twice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Stay {
    /// A part of the line; `None` is no part.
    pub(crate) span: Option<Span>,
    /// Whether the line is outside on that part and inside everywhere else, and not the other way round.
    pub(crate) outside: bool,
}

impl Stay {
    /// Inside on the span only.
    #[inline]
    pub(crate) fn within(span: Option<Span>) -> Self {
        Self {
            span,
            outside: false,
        }
    }

    /// Whether a line crosses the solid nowhere but at its start on this surface, as a line from a plane does.
    #[inline(always)]
    pub(crate) fn is_crossed_once(&self, surface: SurfaceId) -> bool {
        let no_other = |end: End| end.t.is_infinite() || end.t == 0.0 && end.facet == surface.facet;
        self.span
            .is_some_and(|span| no_other(span.enter) && no_other(span.exit))
    }
}

/// The beginning of a list of crossings: for a ray that starts on the surface, its start.
pub(crate) fn start_of(range: Interval, from: Option<SurfaceId>) -> f64 {
    if from.is_some() && range.min < 0.0 {
        0.0
    } else {
        range.min
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SPAN: Span = Span {
        enter: End { t: -1.0, facet: 3 },
        exit: End { t: 2.0, facet: 4 },
    };

    fn listed(range: Interval, from: Option<u32>) -> (bool, Vec<f64>) {
        let mut out = Crossings::default();
        SPAN.list(
            range,
            from.map(|facet| SurfaceId { element: 0, facet }),
            |_| 0.0,
            &mut out,
        );
        (
            out.inside_at_start,
            out.list.iter().map(|c| c.hit.t).collect(),
        )
    }

    #[test]
    fn the_start_of_the_range_decides_what_is_listed() {
        assert_eq!(listed(Interval::LINE, None), (false, vec![-1.0, 2.0]));
        assert_eq!(listed(Interval::FORWARD, None), (true, vec![2.0]));
        assert_eq!(listed(Interval::new(-1.0, 1.0), None), (true, vec![]));
        assert_eq!(listed(Interval::new(2.0, 9.0), None), (false, vec![]));
        assert_eq!(listed(Interval::LINE, Some(0)), (true, vec![2.0]));
    }

    #[test]
    fn not_a_number_cuts_everything_away() {
        let end = |t| End { t, facet: 0 };
        assert_eq!(SPAN.cut(end(f64::NAN), end(1.0)), None);
        assert_eq!(SPAN.cut(end(0.0), end(f64::NAN)), None);
        assert_eq!(SPAN.cut(end(-9.0), end(9.0)), Some(SPAN));
        assert_eq!(SPAN.cut(end(2.0), end(9.0)), None);
    }
}
