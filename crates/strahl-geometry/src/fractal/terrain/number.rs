//! The numbers that a height is computed with: plain ones, ones with slopes, and ranges of both. A formula is written once for all.

use strahl_math::noise::{NoiseGenerator, plane_noise, plane_noise_bounds};

/// Two numbers, the lower one first.
pub(super) type Range = (f64, f64);

/// What formulas of heights do with numbers.
pub(super) trait Number: Copy {
    /// Where a height is computed: a point of the plane, or a rectangle.
    type Place: Copy;

    /// A number that does not depend on the place.
    fn constant(x: f64) -> Self;
    /// Noise from -1 to 1 at the place times a frequency.
    fn noise(place: Self::Place, frequency: f64, generator: NoiseGenerator) -> Self;
    /// The logarithm of the distance from a point of the plane, `0.5 ln(max(dx² + dz² + height², least²))`.
    fn log_distance(place: Self::Place, viewpoint: &Viewpoint) -> Self;
    fn plus(self, other: Self) -> Self;
    fn times(self, other: Self) -> Self;
    fn square(self) -> Self {
        self.times(self)
    }
    fn scaled(self, factor: f64) -> Self;
    fn abs(self) -> Self;
    /// Cut off at 0 and 1.
    fn share(self) -> Self;
    /// `3 x² - 2 x³`, of a number from 0 to 1.
    fn smooth(self) -> Self;
    /// Whether it is certainly not greater than zero.
    fn is_nothing(self) -> bool;
}

/// Where the eye is, for heights that have more detail near it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Viewpoint {
    pub(super) x: f64,
    pub(super) z: f64,
    /// The square of how far it is above the ground, or of the distance within which detail does not grow, whichever is larger.
    pub(super) least2: f64,
    /// Whether the height above the ground counts: it is added to the square of the horizontal distance.
    pub(super) height2: f64,
}

impl Viewpoint {
    /// Of the squares of the distances along x and z.
    fn log(&self, dx2: f64, dz2: f64) -> f64 {
        let r2 = (dx2 + dz2) + self.height2;
        0.5 * strahl_math::det::ln(if r2 > self.least2 { r2 } else { self.least2 })
    }
}

impl Number for f64 {
    type Place = [f64; 2];

    fn constant(x: f64) -> Self {
        x
    }

    #[inline(always)]
    fn noise([x, z]: [f64; 2], frequency: f64, generator: NoiseGenerator) -> Self {
        2.0 * plane_noise(x * frequency, z * frequency, generator).value - 1.0
    }

    fn log_distance([x, z]: [f64; 2], viewpoint: &Viewpoint) -> Self {
        let (dx, dz) = (x - viewpoint.x, z - viewpoint.z);
        viewpoint.log(dx * dx, dz * dz)
    }

    fn plus(self, other: Self) -> Self {
        self + other
    }

    fn times(self, other: Self) -> Self {
        self * other
    }

    fn scaled(self, factor: f64) -> Self {
        self * factor
    }

    fn abs(self) -> Self {
        self.abs()
    }

    fn share(self) -> Self {
        if self > 0.0 {
            if self < 1.0 { self } else { 1.0 }
        } else {
            0.0
        }
    }

    fn smooth(self) -> Self {
        self * self * (3.0 - 2.0 * self)
    }

    fn is_nothing(self) -> bool {
        self <= 0.0
    }
}

/// A number with its derivatives by x and z.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sloped {
    pub(super) value: f64,
    pub(super) slopes: [f64; 2],
}

impl Sloped {
    fn with(self, value: f64, factor: f64) -> Self {
        let [a, b] = self.slopes;
        Self {
            value,
            slopes: [a * factor, b * factor],
        }
    }
}

impl Number for Sloped {
    type Place = [f64; 2];

    fn constant(value: f64) -> Self {
        let slopes = [0.0; 2];
        Self { value, slopes }
    }

    #[inline(always)]
    fn noise([x, z]: [f64; 2], frequency: f64, generator: NoiseGenerator) -> Self {
        let found = plane_noise(x * frequency, z * frequency, generator);
        let [a, b] = found.slopes;
        let factor = 2.0 * frequency;
        Self {
            value: 2.0 * found.value - 1.0,
            slopes: [a * factor, b * factor],
        }
    }

    fn log_distance([x, z]: [f64; 2], viewpoint: &Viewpoint) -> Self {
        let (dx, dz) = (x - viewpoint.x, z - viewpoint.z);
        let value = viewpoint.log(dx * dx, dz * dz);
        let r2 = (dx * dx + dz * dz) + viewpoint.height2;
        let inverse = if r2 > viewpoint.least2 { 1.0 / r2 } else { 0.0 };
        let slopes = [dx * inverse, dz * inverse];
        Self { value, slopes }
    }

    fn plus(self, other: Self) -> Self {
        let ([a, b], [c, d]) = (self.slopes, other.slopes);
        Self {
            value: self.value + other.value,
            slopes: [a + c, b + d],
        }
    }

    fn times(self, other: Self) -> Self {
        let ([a, b], [c, d]) = (self.slopes, other.slopes);
        let (p, q) = (self.value, other.value);
        Self {
            value: p * q,
            slopes: [a * q + p * c, b * q + p * d],
        }
    }

    fn scaled(self, factor: f64) -> Self {
        self.with(self.value * factor, factor)
    }

    fn abs(self) -> Self {
        let sign = if self.value < 0.0 { -1.0 } else { 1.0 };
        self.with(self.value.abs(), sign)
    }

    fn share(self) -> Self {
        let value = self.value.share();
        let inside = if value == self.value { 1.0 } else { 0.0 };
        self.with(value, inside)
    }

    fn smooth(self) -> Self {
        let x = self.value;
        self.with(x.smooth(), 6.0 * x * (1.0 - x))
    }

    fn is_nothing(self) -> bool {
        self.value <= 0.0
    }
}

/// The ranges of a number and of its derivatives by x and z over a rectangle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ranged {
    pub(super) value: Range,
    pub(super) slopes: [Range; 2],
}

/// A rectangle: the ranges of x and z.
pub(super) type Rectangle = [Range; 2];

#[inline(always)]
pub(super) fn lower(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

#[inline(always)]
pub(super) fn upper(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

#[inline(always)]
pub(super) fn join(a: Range, b: Range) -> Range {
    (lower(a.0, b.0), upper(a.1, b.1))
}

#[inline(always)]
pub(super) fn sum(a: Range, b: Range) -> Range {
    (a.0 + b.0, a.1 + b.1)
}

#[inline(always)]
pub(super) fn product(a: Range, b: Range) -> Range {
    let (p, q, r, s) = (a.0 * b.0, a.0 * b.1, a.1 * b.0, a.1 * b.1);
    (
        lower(lower(p, q), lower(r, s)),
        upper(upper(p, q), upper(r, s)),
    )
}

#[inline(always)]
pub(super) fn times((a, b): Range, factor: f64) -> Range {
    if factor < 0.0 {
        (b * factor, a * factor)
    } else {
        (a * factor, b * factor)
    }
}

impl Ranged {
    /// With another value, and slopes times a range.
    fn with(self, value: Range, factor: Range) -> Self {
        let [a, b] = self.slopes;
        Self {
            value,
            slopes: [product(a, factor), product(b, factor)],
        }
    }
}

impl Number for Ranged {
    type Place = Rectangle;

    fn constant(x: f64) -> Self {
        Self {
            value: (x, x),
            slopes: [(0.0, 0.0); 2],
        }
    }

    #[inline(always)]
    fn noise([x, z]: Rectangle, frequency: f64, generator: NoiseGenerator) -> Self {
        // Rounded products are monotone, so no point of the rectangle is mapped out of this one.
        let found = plane_noise_bounds(times(x, frequency), times(z, frequency), generator);
        let (low, high) = found.value;
        let [a, b] = found.slopes;
        let factor = 2.0 * frequency;
        Self {
            value: (2.0 * low - 1.0, 2.0 * high - 1.0),
            slopes: [times(a, factor), times(b, factor)],
        }
    }

    fn log_distance([x, z]: Rectangle, viewpoint: &Viewpoint) -> Self {
        let away = |(a, b): Range, v: f64| (a - v, b - v);
        let square = |(a, b): Range| {
            let (p, q) = (a * a, b * b);
            let low = if a <= 0.0 && b >= 0.0 {
                0.0
            } else {
                lower(p, q)
            };
            (low, upper(p, q))
        };
        let (dx, dz) = (away(x, viewpoint.x), away(z, viewpoint.z));
        let (x2, z2) = (square(dx), square(dz));
        let (near, far) = (viewpoint.log(x2.0, z2.0), viewpoint.log(x2.1, z2.1));
        let nearest = (x2.0 + z2.0) + viewpoint.height2;
        let farthest = (x2.1 + z2.1) + viewpoint.height2;
        let slope = |d: Range| {
            if farthest <= viewpoint.least2 {
                return (0.0, 0.0);
            }
            let least = upper(nearest, viewpoint.least2);
            let found = product(d, (1.0 / farthest, 1.0 / least));
            // Within the least distance nothing changes.
            if nearest <= viewpoint.least2 {
                join(found, (0.0, 0.0))
            } else {
                found
            }
        };
        // More than the error of the logarithm, which need not be monotone.
        let pad = 1e-14 * (1.0 + upper(near.abs(), far.abs()));
        Self {
            value: (near - pad, far + pad),
            slopes: [slope(dx), slope(dz)],
        }
    }

    #[inline(always)]
    fn plus(self, other: Self) -> Self {
        Self {
            value: sum(self.value, other.value),
            slopes: [
                sum(self.slopes[0], other.slopes[0]),
                sum(self.slopes[1], other.slopes[1]),
            ],
        }
    }

    #[inline(always)]
    fn times(self, other: Self) -> Self {
        let slope = |k: usize| {
            sum(
                product(self.slopes[k], other.value),
                product(self.value, other.slopes[k]),
            )
        };
        Self {
            value: product(self.value, other.value),
            slopes: [slope(0), slope(1)],
        }
    }

    fn square(self) -> Self {
        let (a, b) = self.value;
        let (p, q) = (a * a, b * b);
        let least = if a < 0.0 && b > 0.0 { 0.0 } else { lower(p, q) };
        self.with((least, upper(p, q)), (2.0 * a, 2.0 * b))
    }

    #[inline(always)]
    fn scaled(self, factor: f64) -> Self {
        Self {
            value: times(self.value, factor),
            slopes: [times(self.slopes[0], factor), times(self.slopes[1], factor)],
        }
    }

    fn abs(self) -> Self {
        let (a, b) = self.value;
        if a >= 0.0 {
            self
        } else if b <= 0.0 {
            self.scaled(-1.0)
        } else {
            self.with((0.0, upper(-a, b)), (-1.0, 1.0))
        }
    }

    fn share(self) -> Self {
        let (a, b) = self.value;
        if a >= 0.0 && b <= 1.0 {
            self
        } else if b <= 0.0 || a >= 1.0 {
            Self::constant(a.share())
        } else {
            self.with((a.share(), b.share()), (0.0, 1.0))
        }
    }

    fn smooth(self) -> Self {
        let (a, b) = self.value;
        let slope = |x: f64| 6.0 * x * (1.0 - x);
        let (p, q) = (slope(a), slope(b));
        let most = if a < 0.5 && b > 0.5 { 1.5 } else { upper(p, q) };
        self.with((a.smooth(), b.smooth()), (lower(p, q), most))
    }

    fn is_nothing(self) -> bool {
        self.value.1 <= 0.0
    }
}
