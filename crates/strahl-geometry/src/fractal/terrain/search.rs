//! The crossings of one ray with a terrain, found in parts that shrink until they are proven to have one crossing or none.

use super::number::{Range, Rectangle, lower, sum, times, upper};
use super::relief::Relief;
use super::tree::Visitor;
use std::ops::ControlFlow;
use strahl_math::DVec3;
use strahl_math::roots::find_root;

/// A parameter of the ray with how far the ray is above the terrain there.
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

/// What a ray crosses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Part {
    Surface,
    /// A side of the solid, by its number.
    Side(u32),
}

/// What happens along a ray.
pub(super) enum Event {
    /// The ray is inside of the terrain from here on or not. Of several starts the last one counts.
    Start { inside: bool },
    /// The surface or a side is crossed at this parameter of the ray.
    Crossing { t: f64, part: Part, enters: bool },
}

/// A ray on its way through the cells that may have a surface: the point at `s` is `origin + s direction`.
pub(super) struct Course<'a, V> {
    pub(super) relief: &'a Relief,
    pub(super) origin: DVec3,
    pub(super) direction: DVec3,
    /// The parameter of the ray at which `s` is zero.
    pub(super) start: f64,
    /// Cells are widened by this when heights over them are bounded.
    pub(super) pad: f64,
    /// Parts of this length are not divided any more.
    pub(super) shortest: f64,
    /// The searched part of the ray ends here.
    pub(super) length: f64,
    /// The end of the part searched last, or where the first one begins.
    pub(super) last: Place,
    /// Whether the ray is inside of the terrain there.
    pub(super) inside: bool,
    pub(super) visit: &'a mut V,
}

/// What bounds say about a part of a ray.
enum Verdict {
    /// There is no surface.
    Empty,
    /// The ray only rises, or only falls, relative to the terrain.
    Monotone,
    /// At most so fast, in either direction.
    Unknown(f64),
}

/// The smallest value on one side of the surface.
pub(super) fn least_value(inside: bool) -> f64 {
    if inside {
        -f64::MIN_POSITIVE
    } else {
        f64::MIN_POSITIVE
    }
}

impl<V: FnMut(Event) -> ControlFlow<()>> Course<'_, V> {
    fn at(&self, s: f64) -> DVec3 {
        self.origin + self.direction * s
    }

    pub(super) fn place(&self, s: f64) -> Place {
        let p = self.at(s);
        let value = p.y - self.relief.height([p.x, p.z]);
        Place { s, value }
    }

    /// How far the ray is above the terrain, and how fast it rises relative to it.
    fn rising(&self, s: f64) -> (f64, f64) {
        let p = self.at(s);
        let found = self.relief.sloped([p.x, p.z]);
        let [a, b] = found.slopes;
        let d = self.direction;
        (p.y - found.value, d.y - (a * d.x + b * d.z))
    }

    fn judge(&self, from: f64, to: f64) -> Verdict {
        // Rounded products and sums are monotone, so these are the ends of the coordinates too.
        let (a, b) = (self.at(from), self.at(to));
        let range = |a: f64, b: f64| (lower(a, b), upper(a, b));
        let found = self.relief.ranged([range(a.x, b.x), range(a.z, b.z)]);
        let y = range(a.y, b.y);
        if y.0 > found.value.1 || y.1 < found.value.0 {
            return Verdict::Empty;
        }
        let d = self.direction;
        let [x, z] = found.slopes;
        let (fall, rise) = sum(times(x, d.x), times(z, d.z));
        let (least, most) = (d.y - rise, d.y - fall);
        if least > 0.0 || most < 0.0 {
            return Verdict::Monotone;
        }
        Verdict::Unknown(upper(-least, most))
    }

    /// Reports the changes of sign between two places, ascending.
    fn run(&mut self, from: Place, to: Place, verdict: Verdict) -> ControlFlow<()> {
        let changes = from.is_inside() != to.is_inside();
        let length = to.s - from.s;
        let speed = match verdict {
            Verdict::Empty | Verdict::Monotone if !changes => return ControlFlow::Continue(()),
            Verdict::Empty | Verdict::Monotone => return self.cross(from, to),
            Verdict::Unknown(speed) => speed,
        };
        if !(length > self.shortest) {
            return if changes {
                self.cross(from, to)
            } else {
                ControlFlow::Continue(())
            };
        }
        let middle = self.place(from.s + 0.5 * length);
        let reach = 0.5 * length * speed + 2.0 * self.relief.noise;
        if !changes && middle.value.abs() > reach {
            return ControlFlow::Continue(());
        }
        let verdict = self.judge(from.s, middle.s);
        self.run(from, middle, verdict)?;
        let verdict = self.judge(middle.s, to.s);
        self.run(middle, to, verdict)
    }

    /// Reports the crossing between two places on different sides.
    fn cross(&mut self, from: Place, to: Place) -> ControlFlow<()> {
        let share = from.value / (from.value - to.value);
        let guess = from.s + share * (to.s - from.s);
        let rising = from.is_inside();
        let s = find_root(from.s, to.s, rising, guess, |s| self.rising(s));
        self.inside = !self.inside;
        (self.visit)(Event::Crossing {
            t: self.start + s,
            part: Part::Surface,
            enters: self.inside,
        })
    }
}

impl<V: FnMut(Event) -> ControlFlow<()>> Visitor for Course<'_, V> {
    fn range(&mut self, cell: &Rectangle) -> Range {
        let wide = |(a, b): Range| (a - self.pad, b + self.pad);
        self.relief.range([wide(cell[0]), wide(cell[1])])
    }

    fn is_small(&self, cell: &Rectangle) -> bool {
        let [(x0, x1), (z0, z1)] = *cell;
        let size = upper(x1 - x0, z1 - z0);
        size * self.relief.finest(*cell) <= SMALL || size <= 64.0 * self.pad
    }

    fn part(&mut self, enter: f64, exit: f64) -> ControlFlow<()> {
        let enter = if enter > 0.0 { enter } else { 0.0 };
        let exit = lower(exit, self.length);
        if !(enter < exit) {
            return ControlFlow::Continue(());
        }
        let is_first = enter < self.last.s;
        let verdict = self.judge(enter, exit);
        if matches!(verdict, Verdict::Empty) && !is_first {
            return ControlFlow::Continue(());
        }
        let mut first = if enter == self.last.s {
            self.last
        } else {
            self.place(enter)
        };
        if is_first {
            // What is needed begins within this part; all of it is searched, so that crossings have the same bits.
            let inside = first.is_inside();
            self.inside = inside;
            (self.visit)(Event::Start { inside })?;
        }
        if first.is_inside() != self.inside {
            // There is no crossing between the parts, so this is zero within rounding.
            first.value = least_value(self.inside);
        }
        self.last = self.place(exit);
        self.run(first, self.last, verdict)
    }
}

/// Cells of the tree are searched if they are at most so many wavelengths of the last octave large.
const SMALL: f64 = 0.5;
