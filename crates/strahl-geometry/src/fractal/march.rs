//! A ray on its way through the cells that may have a surface of a set of orbits.

use super::orbit_set::{BALL, Event, LINE_BATCH, OrbitSet, Places, SURFACE};
use crate::implicit::{Cell, Content, Visitor};
use std::ops::ControlFlow;
use strahl_math::roots::find_crossing_until;
use strahl_math::{Aabb, DVec3, Interval};

/// The longest step, as a part of the radius of the ball around the set: estimates are good for short distances only, and empty cells
/// are passed at once anyway.
const LONGEST: f64 = 1.0 / 16.0;

/// Steps are expected to change by factors in this range, from one to the next.
const TREND: (f64, f64) = (0.25, 2.0);

/// The part of the next step that is expected to reach back; what is left is for expectations that are too high.
const OVERLAP: f64 = 0.25;

/// The march along a ray: the point at `s` is `origin + s direction`.
pub(super) struct March<'a, S, V> {
    set: &'a S,
    origin: DVec3,
    direction: DVec3,
    /// How far `s` goes per unit of distance, as the set measures it.
    pace: f64,
    /// The least and the longest step.
    steps: (f64, f64),
    /// The parameter of the ray at which `s` is zero, and how far the march goes.
    start: f64,
    length: f64,
    /// Where the ray is not needed any more.
    needed: f64,
    /// Of crossings in this range of the ray's parameter an approximate place is enough.
    rough: Interval,
    /// The last place that was looked at, and its value.
    s: f64,
    pub(super) value: f64,
    /// There is no surface before this place, or it is nearer than the least step.
    clear: f64,
    /// Whether it is the latter.
    is_near: bool,
    /// The last step, and the one before.
    last: f64,
    before: f64,
    /// Whether the ray is inside of the set.
    pub(super) inside: bool,
    pub(super) visit: &'a mut V,
}

impl<'a, S: OrbitSet, V: FnMut(Event) -> ControlFlow<()>> March<'a, S, V> {
    /// The march along a line that is in the ball from `start` on, and no farther than `length`.
    pub(super) fn new(
        set: &'a S,
        (origin, direction): (DVec3, DVec3),
        (start, length, needed): (f64, f64, f64),
        rough: Interval,
        visit: &'a mut V,
    ) -> Self {
        let fastest = direction.abs().max_element();
        let longest = LONGEST * set.search().radius / fastest;
        let shortest = set.search().shortest / fastest;
        let mut march = Self {
            set,
            origin,
            direction,
            pace: 1.0 / set.speed(direction),
            steps: (
                shortest,
                if longest > shortest {
                    longest
                } else {
                    shortest
                },
            ),
            start,
            length,
            needed,
            rough,
            s: 0.0,
            value: 0.0,
            clear: 0.0,
            is_near: true,
            last: 0.0,
            before: 0.0,
            inside: false,
            visit,
        };
        let place = set.place(origin);
        let (step, is_near) = march.step(place.reach);
        (march.value, march.clear, march.is_near) = (place.value, step, is_near);
        (march.before, march.last) = (step, step);
        march.inside = place.value < 0.0;
        march
    }

    /// Says on which side the ray is.
    pub(super) fn set_side(&mut self, inside: bool) {
        self.inside = inside;
        self.value = if inside {
            -f64::MIN_POSITIVE
        } else {
            f64::MIN_POSITIVE
        };
    }

    fn at(&self, s: f64) -> DVec3 {
        self.origin + self.direction * s
    }

    /// The step that a reach allows, and whether the surface is nearer than the least one.
    #[inline(always)]
    fn step(&self, reach: f64) -> (f64, bool) {
        let (shortest, longest) = self.steps;
        let reach = reach * self.pace;
        let is_near = !(reach > shortest);
        let step = if is_near {
            shortest
        } else if reach < longest {
            reach
        } else {
            longest
        };
        (step, is_near)
    }

    /// Goes to a place with this value, where this step is allowed, and reports the crossing on the way, if there is one.
    #[inline(always)]
    fn go(&mut self, to: f64, value: f64, (step, is_near): (f64, bool)) -> ControlFlow<()> {
        let before = (self.s, self.value);
        (self.before, self.last) = (self.clear - self.s, step);
        (self.s, self.value, self.clear, self.is_near) = (to, value, to + step, is_near);
        if (value < 0.0) == self.inside {
            return ControlFlow::Continue(());
        }
        self.cross(before)
    }

    /// Reports the crossing between a place with its value and this one.
    #[inline(never)]
    fn cross(&mut self, (s, value): (f64, f64)) -> ControlFlow<()> {
        let (from, to) = (self.start + s, self.start + self.s);
        let t = if self.rough.accepts(from) && self.rough.accepts(to) {
            to
        } else {
            let at = |s| self.set.value(self.at(s));
            // The value is not known better than that: the noise, with the slope along the ray, which is less than the whole one.
            let (rounding, reach) = (self.set.rounding(), self.set.search().radius * self.pace);
            let is_enough = |value, slope| value <= rounding * (0.25 * slope * reach + 1.0);
            self.start + find_crossing_until([s, self.s], [value, self.value], at, is_enough)
        };
        self.inside = !self.inside;
        (self.visit)(Event::Crossing {
            t,
            surface: SURFACE,
            enters: self.inside,
        })
    }

    /// Looks at a place and goes there.
    fn step_to(&mut self, to: f64) -> ControlFlow<()> {
        let place = self.set.place(self.at(to));
        self.go(to, place.value, self.step(place.reach))
    }

    /// Goes to a place, and on from there as far as places that are looked at together show that the line is clear.
    fn advance(&mut self, to: f64) -> ControlFlow<()> {
        let ahead = self.next_places(to);
        let mut places = Places::default();
        if !self
            .set
            .store_places((self.origin, self.direction), &ahead, &mut places)
        {
            return self.step_to(to);
        }
        let (clear, count) = self.clear_until(&ahead, &places);
        let (values, all) = (&places.values[..count], &ahead[..count]);
        if values.iter().all(|value| (*value < 0.0) == self.inside) {
            self.skip(all, values, &clear, &places.reaches);
            return ControlFlow::Continue(());
        }
        for ((&s, &value), &reach) in all.iter().zip(values).zip(&places.reaches) {
            self.go(s, value, self.step(reach))?;
        }
        ControlFlow::Continue(())
    }

    /// How far the line is clear from each place on, and how many of the places the march may go to: the clear parts around neighbours
    /// have to touch.
    #[inline(always)]
    fn clear_until(
        &self,
        ahead: &[f64; LINE_BATCH],
        places: &Places,
    ) -> ([f64; LINE_BATCH], usize) {
        let (mut clear, mut backs) = ([0.0; LINE_BATCH], [0.0; LINE_BATCH]);
        for k in 0..LINE_BATCH {
            let (step, is_near) = self.step(places.reaches[k]);
            clear[k] = ahead[k] + step;
            backs[k] = ahead[k] - if is_near { 0.0 } else { step };
        }
        let mut count = 1;
        while count < LINE_BATCH && backs[count] <= clear[count - 1] && ahead[count] <= self.length
        {
            count += 1;
        }
        (clear, count)
    }

    /// Goes to the last of these places, all of which are on the ray's side of the surface.
    #[inline(always)]
    fn skip(
        &mut self,
        places: &[f64],
        values: &[f64],
        clear: &[f64; LINE_BATCH],
        reaches: &[f64; LINE_BATCH],
    ) {
        let last = places.len() - 1;
        let (step, is_near) = self.step(reaches[last]);
        self.before = match last.checked_sub(1) {
            Some(before) => clear[before] - places[before],
            None => self.clear - self.s,
        };
        (self.s, self.value) = (places[last], values[last]);
        (self.last, self.clear, self.is_near) = (step, clear[last], is_near);
    }

    /// A place and further ones, as far from each other as they will be clear if steps go on to grow or shrink as the last one did.
    #[inline(always)]
    fn next_places(&self, s: f64) -> [f64; LINE_BATCH] {
        let (shortest, longest) = self.steps;
        let trend = between(self.last / self.before, TREND);
        let (t2, t4) = (trend * trend, (trend * trend) * (trend * trend));
        let t3 = t2 * trend;
        // The steps without limits: the last one times the powers of the trend. So each is known without the one before.
        let mut free = [trend, t2, t3, t4, t4 * trend, t4 * t2, t4 * t3, t4 * t4];
        for step in &mut free {
            *step *= self.clear - self.s;
        }
        let mut ways = [0.0; LINE_BATCH - 1];
        for k in 0..LINE_BATCH - 1 {
            let (step, next) = (free[k], free[k + 1]);
            let step = if step < shortest { shortest } else { step };
            let step = if step > longest { longest } else { step };
            let overlap = if next > longest { longest } else { next };
            let overlap = if next > shortest { overlap } else { 0.0 };
            ways[k] = step + OVERLAP * overlap;
        }
        let mut places = [s; LINE_BATCH];
        for k in 1..LINE_BATCH {
            places[k] = places[k - 1] + ways[k - 1];
        }
        places
    }

    /// Looks at the end.
    pub(super) fn finish(&mut self) -> ControlFlow<()> {
        if self.s < self.length {
            self.step_to(self.length)?;
        }
        ControlFlow::Continue(())
    }

    /// Leaves the ball around the set.
    pub(super) fn leave(&mut self) -> ControlFlow<()> {
        if self.inside {
            self.finish()?;
        }
        if self.inside {
            (self.visit)(Event::Crossing {
                t: self.start + self.length,
                surface: BALL,
                enters: false,
            })?;
        }
        ControlFlow::Continue(())
    }
}

impl<S: OrbitSet, V: FnMut(Event) -> ControlFlow<()>> Visitor for March<'_, S, V> {
    fn line(&self) -> (DVec3, DVec3) {
        (self.origin, self.direction)
    }

    fn content(&mut self, cell: &Aabb) -> Content {
        if self
            .set
            .is_decided(cell.center(), 0.5 * cell.size().length())
        {
            Content::Empty { is_inside: None }
        } else {
            Content::Surface
        }
    }

    fn part(&mut self, enter: f64, exit: f64, _: &Cell<'_>) -> ControlFlow<()> {
        let exit = if exit < self.length {
            exit
        } else {
            self.length
        };
        loop {
            if self.s > self.needed {
                return ControlFlow::Break(());
            }
            let mut next = if enter > self.clear {
                enter
            } else {
                self.clear
            };
            if self.is_near && self.s < exit && next > exit {
                next = exit;
            }
            if !(next > self.s && (next < exit || next == exit && self.is_near)) {
                return ControlFlow::Continue(());
            }
            self.advance(next)?;
        }
    }

    /// Near the surface the end of every cell is looked at, else what is clear is left out.
    fn resume(&self) -> f64 {
        if self.is_near { self.s } else { self.clear }
    }
}

/// A number, or the end of the range that it is beyond; NaN stays.
#[inline(always)]
fn between(x: f64, (low, high): (f64, f64)) -> f64 {
    if x < low {
        low
    } else if x > high {
        high
    } else {
        x
    }
}
