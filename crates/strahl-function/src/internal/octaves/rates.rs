//! The sums over octaves on segments: bounds of the value and of its derivative, octave by octave by the rules of differentiation.

use super::{Octaves, Sum, TOGETHER, larger};
use crate::bounds::Bounds;
use crate::rounding::{greater, less};
use strahl_math::noise::{Along, Segment, store_octaves_along};

/// Two numbers, the lower one first.
type Range = (f64, f64);

/// Bounds of a quantity on a segment, and of its derivative.
#[derive(Clone, Copy)]
struct Course {
    value: Range,
    rate: Range,
}

fn sum(a: Range, b: Range) -> Range {
    (a.0 + b.0, a.1 + b.1)
}

fn scaled(a: Range, by: f64) -> Range {
    let (p, q) = (a.0 * by, a.1 * by);
    (less(p, q), greater(p, q))
}

fn product(a: Range, b: Range) -> Range {
    let (p, q) = (scaled(a, b.0), scaled(a, b.1));
    (less(p.0, q.0), greater(p.1, q.1))
}

fn hull(a: Range, b: Range) -> Range {
    (less(a.0, b.0), greater(a.1, b.1))
}

impl Course {
    const ZERO: Self = Self {
        value: (0.0, 0.0),
        rate: (0.0, 0.0),
    };

    fn plus(self, other: Self) -> Self {
        Self {
            value: sum(self.value, other.value),
            rate: sum(self.rate, other.rate),
        }
    }

    fn offset(self, by: f64) -> Self {
        Self {
            value: (self.value.0 + by, self.value.1 + by),
            ..self
        }
    }

    fn times(self, by: f64) -> Self {
        Self {
            value: scaled(self.value, by),
            rate: scaled(self.rate, by),
        }
    }

    fn product(self, other: Self) -> Self {
        Self {
            value: product(self.value, other.value),
            rate: sum(
                product(self.rate, other.value),
                product(other.rate, self.value),
            ),
        }
    }

    fn square(self) -> Self {
        let Self { value, rate } = self;
        let sizes = self.abs().value;
        Self {
            value: (sizes.0 * sizes.0, sizes.1 * sizes.1),
            rate: scaled(product(rate, value), 2.0),
        }
    }

    fn abs(self) -> Self {
        if self.value.0 >= 0.0 {
            return self;
        }
        let turned = self.times(-1.0);
        if self.value.1 <= 0.0 {
            return turned;
        }
        Self {
            value: (0.0, greater(self.value.1, turned.value.1)),
            rate: hull(self.rate, turned.rate),
        }
    }

    /// Cut off at 0 and 1, where it does not change.
    fn within_one(self) -> Self {
        let Self { value, rate } = self;
        let cut = |x: f64| less(greater(x, 0.0), 1.0);
        Self {
            value: (cut(value.0), cut(value.1)),
            rate: if value.0 >= 1.0 || value.1 <= 0.0 {
                (0.0, 0.0)
            } else if value.0 > 0.0 && value.1 < 1.0 {
                rate
            } else {
                hull(rate, (0.0, 0.0))
            },
        }
    }

    /// The largest size of the values.
    fn size(self) -> f64 {
        greater(-self.value.0, self.value.1)
    }
}

/// A sum on a segment, and the sizes of its terms.
struct Total {
    course: Course,
    size: f64,
}

impl Total {
    fn new(course: Course) -> Self {
        let size = course.size();
        Self { course, size }
    }

    fn add(&mut self, term: Course) {
        self.course = self.course.plus(term);
        self.size += term.size();
    }
}

/// Segments that are longer than so many cells of the last octave certainly meet several planes of its lattice along an axis.
const LONGEST: f64 = 2.0;

impl Octaves {
    /// Bounds of the values on a segment, and of their derivative by its parameter, which is unknown where the segment meets several planes of an
    /// octave's lattice along an axis. `None` if it is longer than that, and for unusual parameters.
    pub(in super::super) fn along(&self, segment: Segment) -> Option<(Bounds, Bounds)> {
        let near = |x: f64| x.abs() <= 0.5 * self.reach;
        let ends = [segment.middle, segment.reach].map(|v| v.to_array());
        let length = 2.0 * segment.reach.abs().max_element() * self.finest;
        if !self.is_usual || length > LONGEST || !ends.as_flattened().iter().all(|&x| near(x)) {
            return None;
        }
        let mut noises = Noises {
            of: self,
            segment,
            some: [Along::UNKNOWN; TOGETHER],
            next: TOGETHER,
            left: self.count,
            is_known: true,
        };
        let total = match self.sum {
            Sum::Hetero => self.hetero_along(&mut noises),
            Sum::Ridge => self.ridge_along(&mut noises),
            Sum::Ridged => self.ridged_along(&mut noises),
        };
        let Course { value, rate } = total.course;
        // A few roundings for each octave.
        let error = 16.0 * f64::EPSILON * (self.count + 2) as f64;
        let pad = error * total.size;
        let values = Bounds::new(value.0 - pad, value.1 + pad);
        let pad = error * greater(rate.0.abs(), rate.1.abs());
        let is_known = noises.is_known && rate.0.is_finite() && rate.1.is_finite();
        let rates = if is_known {
            Bounds::new(rate.0 - pad, rate.1 + pad)
        } else {
            Bounds::UNKNOWN
        };
        total.size.is_finite().then_some((values, rates))
    }

    fn hetero_along(&self, noises: &mut Noises<'_>) -> Total {
        let mut next = || noises.signed().offset(self.offset);
        let mut total = Total::new(next());
        let (whole, part) = self.split();
        for &weight in whole {
            let mut term = next().times(weight);
            if self.last == 1.0 {
                term = term.product(total.course);
            }
            total.add(term);
        }
        if let Some(weight) = part {
            let term = next().times(self.part * weight).product(total.course);
            total.add(term);
        }
        total
    }

    fn ridged_along(&self, noises: &mut Noises<'_>) -> Total {
        let mut next = || {
            let height = noises.signed().abs().times(-1.0).offset(self.offset);
            height.square()
        };
        let mut signal = next();
        let mut total = Total::new(signal);
        for &power in &self.weights {
            let weight = signal.times(self.last).within_one();
            signal = next().product(weight);
            total.add(signal.times(power));
        }
        total
    }

    fn ridge_along(&self, noises: &mut Noises<'_>) -> Total {
        let mut total = Total::new(Course::ZERO);
        for share in &self.weights {
            let distance = noises.next().offset(-self.last).abs();
            let height = distance
                .times(1.0 / larger(self.last))
                .offset(-self.offset)
                .times(1.0 / larger(self.offset));
            total.add(height.times(*share));
            // What is left of differences is smaller than what they are made of.
            total.size += share.abs() * (1.0 + self.last.abs() + self.offset.abs())
                / (larger(self.last) * larger(self.offset));
        }
        let by = 1.0 / self.total;
        Total {
            course: total.course.times(by),
            size: total.size * by.abs(),
        }
    }
}

/// The noise of octave after octave along a segment.
struct Noises<'a> {
    of: &'a Octaves,
    /// The segment in the octave after the last one of those that are known.
    segment: Segment,
    some: [Along; TOGETHER],
    /// Those of `some` that have not been asked for.
    next: usize,
    /// How many octaves are not known yet.
    left: usize,
    /// Whether the derivatives of all that have been asked for are known.
    is_known: bool,
}

impl Noises<'_> {
    fn next(&mut self) -> Course {
        if self.next == TOGETHER {
            self.go_on();
        }
        let Along { value, mut rate } = self.some[self.next];
        self.next += 1;
        if !(rate.1 < f64::INFINITY) {
            self.is_known = false;
            rate = (0.0, 0.0);
        }
        Course { value, rate }
    }

    #[inline(never)]
    fn go_on(&mut self) {
        let Octaves {
            lacunarity,
            generator,
            ..
        } = *self.of;
        let count = self.left.min(TOGETHER);
        let some = &mut self.some[..count];
        store_octaves_along(&mut self.segment, lacunarity, generator, some);
        self.left -= count;
        self.next = 0;
    }

    /// The same from -1 to 1.
    fn signed(&mut self) -> Course {
        self.next().times(2.0).offset(-1.0)
    }
}
