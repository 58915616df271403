//! The crossings of one ray with a surface, found in parts that shrink until they are proven empty or short.

use super::{Event, Isosurface, STRIDE, SURFACE};
use crate::implicit::octree::{Cell, Content, Visitor};
use crate::{Crossing, PrimHit, Side};
use std::ops::ControlFlow;
use strahl_function::{Bounds, Rates, Workspace};
use strahl_math::roots::find_crossing;
use strahl_math::{Aabb, DVec3, Interval};

/// A ray within the container: the point at `s` is `origin + s direction`.
pub(super) struct Search<'a> {
    pub(super) surface: &'a Isosurface,
    pub(super) workspace: &'a mut Workspace,
    /// Whether the scene's gradient takes the place of proofs.
    pub(super) trusts_gradient: bool,
    /// The parameter of the ray at which `s` is zero.
    pub(super) start: f64,
    /// Within this range of the ray it is enough to know that there is a crossing.
    pub(super) rough: Interval,
    pub(super) origin: DVec3,
    pub(super) direction: DVec3,
    /// The largest component of the direction.
    pub(super) speed: f64,
    /// Parts of this length are not divided any more.
    pub(super) shortest: f64,
    /// Whether rates are known on segments only, and have been on all that were asked for.
    pub(super) has_segments: bool,
    /// At least the largest change of the function per unit of `s`, if the scene's gradient is trusted.
    pub(super) slope: f64,
    /// Bounds of the derivative along the ray in the cell that is searched, if they are known. Whatever they exclude the search would exclude
    /// by itself, so it does not matter when they become known.
    pub(super) rate_in_cell: Option<Bounds>,
}

/// A parameter of the ray with the value of the function there, less the threshold.
#[derive(Clone, Copy)]
pub(super) struct Place {
    pub(super) s: f64,
    pub(super) value: f64,
}

impl Place {
    pub(super) fn is_inside(&self) -> bool {
        self.value < 0.0
    }
}

impl Search<'_> {
    fn point(&self, s: f64) -> DVec3 {
        self.origin + self.direction * s
    }

    /// The function at a parameter; NaN counts as outside.
    pub(super) fn place(&mut self, s: f64) -> Place {
        let value = self.surface.value(self.workspace, self.point(s));
        Place { s, value }
    }

    /// Reports the changes of sign between two parameters to the visitor, ascending.
    ///
    /// Every change of sign between the ends is found, and every further pair of changes that is further apart than the
    /// shortest part, unless the scene's gradient is trusted and the function is steeper.
    ///
    /// Bounds of the value and of its derivative in between are `known` if they have been asked for before.
    pub(super) fn run(
        &mut self,
        (from, to): (Place, Place),
        known: Option<(Bounds, Bounds)>,
        visit: &mut impl FnMut(f64) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let changes = from.is_inside() != to.is_inside();
        let is_rough = |s: f64| self.rough.accepts(self.start + s);
        if changes && is_rough(from.s) && is_rough(to.s) {
            return visit(to.s);
        }
        if let Some(rate) = self.rate_in_cell
            && !changes
            && stays_away(from, to, rate)
        {
            return ControlFlow::Continue(());
        }
        let length = to.s - from.s;
        let is_short = length <= self.shortest;
        let has_rates = (self.surface.rates == Rates::OfBoxes || self.has_segments) && !is_short;
        // Most parts without a surface are excluded by bounds of the values alone, which take less time than those of the rate, in which
        // they are contained; but hardly any that the rate in the whole cell does not exclude.
        let is_left_out = changes
            || has_rates
                && (self.rate_in_cell.is_some() || self.has_segments || is_near_zero(from, to));
        if !is_left_out && self.excludes(from, to, is_short) {
            return ControlFlow::Continue(());
        }
        let mut is_monotone = false;
        if has_rates {
            let (values, rate) = known.unwrap_or_else(|| self.rate(from.s, to.s));
            is_monotone = !rate.nan && (rate.min > 0.0 || rate.max < 0.0);
            if !changes && (stays_away(from, to, rate) || side(values).is_some()) {
                return ControlFlow::Continue(());
            }
        }
        if is_short || is_monotone {
            if !changes {
                return ControlFlow::Continue(());
            }
            let (low, high) = (from.value, to.value);
            let root = find_crossing(from.s, to.s, low, high, |s| self.place(s).value);
            return visit(root);
        }
        let middle = self.place(from.s + 0.5 * length);
        if !(from.s < middle.s && middle.s < to.s) {
            return if changes {
                visit(to.s)
            } else {
                ControlFlow::Continue(())
            };
        }
        self.run((from, middle), None, visit)?;
        self.run((middle, to), None, visit)
    }

    /// The box around the part of the ray between two places.
    fn around(&self, from: f64, to: f64) -> Aabb {
        // Rounded products and sums are monotone, so these are the ends of the coordinates too.
        let (a, b) = (self.point(from), self.point(to));
        Aabb::new(a.min(b), a.max(b))
    }

    /// Whether there is no change of sign between two places with values of one sign: certainly, or if the scene's gradient is right and
    /// trusted.
    fn excludes(&mut self, from: Place, to: Place, is_short: bool) -> bool {
        if !self.trusts_gradient {
            let cell = self.around(from.s, to.s);
            return !is_short && side(self.surface.bounds_within(self.workspace, &cell)).is_some();
        }
        // A value that is not a number, which is infinite here, tells nothing about its neighbours.
        from.value.is_finite() == to.value.is_finite()
            && from.value.abs() + to.value.abs() > self.slope * (to.s - from.s)
    }

    /// Bounds of the function, less the threshold, between two places, and of its derivative along the ray.
    pub(super) fn rate(&mut self, from: f64, to: f64) -> (Bounds, Bounds) {
        let ends = (self.point(from), self.point(to));
        let (values, rate) = self
            .surface
            .rate_along(self.workspace, ends, self.direction);
        self.has_segments &= !rate.nan;
        (values, rate)
    }
}

/// Whether a function with values of one sign at two places is so near to zero at one of them that its bounds in between hardly exclude a zero:
/// they are wider than what it changes by.
fn is_near_zero(from: Place, to: Place) -> bool {
    const NEAR: f64 = 0.1;
    let (a, b) = (from.value.abs(), to.value.abs());
    let nearest = if a < b { a } else { b };
    nearest < NEAR * (a - b).abs()
}

/// Whether a function with values of one sign at two places certainly has no zero in between, because it does not change fast enough: a
/// line from each place, as steep as the derivative allows, bounds it.
fn stays_away(from: Place, to: Place, rate: Bounds) -> bool {
    // Far more than the rounding errors of what follows.
    const SLACK: f64 = 1e-6;
    let (a, b) = (from.value.abs(), to.value.abs());
    // The derivative of the absolute value.
    let (fall, rise) = if from.is_inside() {
        (rate.max, -rate.min)
    } else {
        (-rate.min, rate.max)
    };
    if rate.nan {
        return false;
    }
    // A monotone function has its least value at an end.
    if fall <= 0.0 || rise <= 0.0 {
        return true;
    }
    // Both lines have the same height where they meet.
    let lowest = (a * rise + b * fall - fall * rise * (to.s - from.s)) / (fall + rise);
    lowest > SLACK * (a + b)
}

/// Whether values within bounds are all inside (`true`) or all outside, where NaN counts as outside; otherwise `None`.
pub(super) fn side(values: Bounds) -> Option<bool> {
    if values.min > 0.0 || values.is_empty() {
        Some(false)
    } else if values.max < 0.0 && !values.nan {
        Some(true)
    } else {
        None
    }
}

/// The smallest value on one side of the surface.
pub(super) fn least_value(inside: bool) -> f64 {
    if inside {
        -f64::MIN_POSITIVE
    } else {
        f64::MIN_POSITIVE
    }
}

/// A ray on its way through the cells that may have a surface.
pub(super) struct Course<'a, V> {
    pub(super) search: Search<'a>,
    /// The container ends here.
    pub(super) length: f64,
    /// Where the ray enters the container, if what is needed begins there.
    pub(super) enter: Option<Crossing>,
    /// The end of the part searched last, or where the first one begins.
    pub(super) last: f64,
    /// The value there, if it has been evaluated.
    pub(super) value: Option<f64>,
    /// Whether the ray is inside of the surface there, once it has begun.
    pub(super) inside: Option<bool>,
    /// How much of the ray is bounded at once, if that is more than its part in a cell.
    pub(super) stride: f64,
    /// The ray certainly meets no surface until there.
    pub(super) resume: f64,
    pub(super) visit: &'a mut V,
}

impl<V> Course<'_, V> {
    /// As much of the ray as hardly meets the surface, if the function changes as in the part before, whose bounds are given; but no more than
    /// is worthwhile.
    fn next_stride(&self, (values, rate): (Bounds, Bounds)) -> f64 {
        let (least, fall) = match self.inside {
            Some(true) => (-values.max, rate.max),
            _ => (values.min, -rate.min),
        };
        let most = STRIDE * self.search.surface.cell_size() / self.search.speed;
        if fall <= 0.0 || least >= fall * most {
            most
        } else {
            least / fall
        }
    }
}

impl<V: FnMut(Event) -> ControlFlow<()>> Visitor for Course<'_, V> {
    fn line(&self) -> (DVec3, DVec3) {
        (self.search.origin, self.search.direction)
    }

    fn content(&mut self, cell: &Aabb) -> Content {
        self.search.surface.content(self.search.workspace, cell)
    }

    fn resume(&self) -> f64 {
        self.resume
    }

    fn begin(&mut self, is_inside: Option<bool>) -> ControlFlow<()> {
        if self.inside.is_some() {
            return ControlFlow::Continue(());
        }
        let search = &mut self.search;
        // Rounding may move what is far from the origin of the ray out of the cell.
        let is_near = search.surface.reach.contains(search.point(self.last));
        let inside = match is_inside.filter(|_| is_near) {
            Some(is_inside) => is_inside,
            None => {
                let last = self.last;
                let value = *self.value.get_or_insert_with(|| search.place(last).value);
                value < 0.0
            }
        };
        self.inside = Some(inside);
        search.surface.begin(self.enter, inside, self.visit)
    }

    fn part(&mut self, enter: f64, exit: f64, cell: &Cell<'_>) -> ControlFlow<()> {
        let enter = if enter > 0.0 { enter } else { 0.0 };
        let exit = if exit < self.length {
            exit
        } else {
            self.length
        };
        if !(enter < exit) {
            return ControlFlow::Continue(());
        }
        let mut known = None;
        if self.search.has_segments && enter >= self.last {
            let until = (enter + self.stride).clamp(exit, self.length);
            let mut bounds = self.search.rate(enter, until);
            let inside = side(bounds.0);
            if inside.is_some() && inside == self.inside {
                (self.last, self.value) = (exit, None);
                self.resume = until;
                self.stride = self.next_stride(bounds);
                return ControlFlow::Continue(());
            }
            self.stride = 0.0;
            if until > exit {
                bounds = self.search.rate(enter, exit);
            }
            known = Some(bounds);
        }
        let mut first = match self.value {
            Some(value) if enter == self.last => Place { s: enter, value },
            _ => self.search.place(enter),
        };
        let mut inside = match self.inside {
            Some(inside) if enter >= self.last => inside,
            _ => {
                // What is needed begins within this part; all of it is searched, so that crossings have the same bits.
                let inside = first.is_inside();
                (self.visit)(Event::Start { inside })?;
                inside
            }
        };
        if first.is_inside() != inside {
            // There is no crossing between the parts, so this is zero within rounding.
            first.value = least_value(inside);
        }
        let search = &mut self.search;
        let last = search.place(exit);
        (self.last, self.value) = (exit, Some(last.value));
        let start = search.start;
        let has_rates =
            search.surface.rates == Rates::OfBoxes && first.is_inside() == last.is_inside();
        search.rate_in_cell = if has_rates {
            let surface = search.surface;
            surface.rate_in(search.workspace, cell, search.direction)
        } else {
            None
        };
        let Self { search, visit, .. } = self;
        let flow = search.run((first, last), known, &mut |s| {
            inside = !inside;
            let side = if inside { Side::Enter } else { Side::Exit };
            let hit = PrimHit::simple(start + s, SURFACE.facet);
            visit(Event::Crossing(Crossing::new(hit, 0.0, side)))
        });
        self.inside = Some(inside);
        flow
    }
}
