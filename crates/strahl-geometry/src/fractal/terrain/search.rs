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
    Unknown {
        /// Its height above the terrain changes at a rate within these, of which one is negative and one positive.
        rates: Range,
        /// Where the surface may be.
        within: Range,
    },
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
        let (found, linear) = self.relief.bounds([range(a.x, b.x), range(a.z, b.z)]);
        let y = range(a.y, b.y);
        if y.0 > found.value.1 || y.1 < found.value.0 {
            return Verdict::Empty;
        }
        // Along the ray what is linear over the rectangle depends on one parameter from -1 to 1.
        let d = self.direction;
        let half = 0.5 * (b.y - a.y) - linear.along(d.x >= 0.0, d.z >= 0.0);
        let above = 0.5 * (a.y + b.y) - linear.middle;
        let off = linear.off + 4.0 * self.relief.noise;
        let per = 1.0 / half;
        let (p, q) = ((-off - above) * per, (off - above) * per);
        let (near, far) = (lower(p, q) - SPARE, upper(p, q) + SPARE);
        // Comparisons with NaN, where nothing changes along the ray, change nothing.
        if near > 1.0 || far < -1.0 {
            return Verdict::Empty;
        }
        let at = |x: f64| from + 0.5 * (x + 1.0) * (to - from);
        let within = (
            if near > -1.0 { at(near) } else { from },
            if far < 1.0 { at(far) } else { to },
        );
        let [a0, a1, b0, b1] = found.slopes;
        let (fall, rise) = sum(times((a0, a1), d.x), times((b0, b1), d.z));
        let (least, most) = (d.y - rise, d.y - fall);
        if least > 0.0 || most < 0.0 {
            return Verdict::Monotone;
        }
        let rates = (least, most);
        Verdict::Unknown { rates, within }
    }

    /// Reports the changes of sign between two places, ascending, where the rates are within a range.
    fn run(&mut self, from: Place, to: Place, (fall, rise): Range) -> ControlFlow<()> {
        let changes = from.is_inside() != to.is_inside();
        // How far from a place there is no crossing for sure.
        let clear = |place: Place, speed: f64| {
            let way = (place.value.abs() - 2.0 * self.relief.noise) / speed - self.shortest;
            if way > 0.0 { way } else { 0.0 }
        };
        let ahead = clear(from, if from.is_inside() { rise } else { -fall });
        let behind = clear(to, if to.is_inside() { -fall } else { rise });
        let (low, high) = (from.s + ahead, to.s - behind);
        if !(high - low > self.shortest) {
            return if changes {
                self.cross(from, to)
            } else {
                ControlFlow::Continue(())
            };
        }
        match self.judge(low, high) {
            Verdict::Empty | Verdict::Monotone if !changes => ControlFlow::Continue(()),
            Verdict::Empty | Verdict::Monotone => self.cross(from, to),
            Verdict::Unknown { rates, within } => self.split(from, to, rates, within),
        }
    }

    /// The same, where the surface is within a part in which the rates are known.
    fn split(&mut self, from: Place, to: Place, rates: Range, part: Range) -> ControlFlow<()> {
        let (low, high) = (self.beside(part.0, from), self.beside(part.1, to));
        if high.s - low.s < SHRUNK * (to.s - from.s) {
            return self.run(low, high, rates);
        }
        let middle = self.place(0.5 * (low.s + high.s));
        self.run(low, middle, rates)?;
        self.run(middle, high, rates)
    }

    /// A place on the same side of the surface as another one, as is known, whatever rounding says.
    fn beside(&self, s: f64, other: Place) -> Place {
        if s == other.s {
            return other;
        }
        let mut place = self.place(s);
        if place.is_inside() != other.is_inside() {
            place.value = least_value(other.is_inside());
        }
        place
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
        let last = self.last;
        match verdict {
            Verdict::Empty | Verdict::Monotone if first.is_inside() == last.is_inside() => {
                ControlFlow::Continue(())
            }
            Verdict::Empty | Verdict::Monotone => self.cross(first, last),
            Verdict::Unknown { rates, within } => self.split(first, last, rates, within),
        }
    }
}

/// A part of a ray that shrinks to less than this is not halved yet.
const SHRUNK: f64 = 0.7;

/// More than the rounding errors of a place in a part of a ray whose ends are -1 and 1.
const SPARE: f64 = 1.0 / (1_u64 << 30) as f64;

/// Cells of the tree are searched if they are at most so many wavelengths of the last octave large.
const SMALL: f64 = 1.0;
