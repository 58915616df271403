//! The numbers that a height is computed with: plain ones, ones with slopes, and ranges of both. A formula is written once for all.

use strahl_math::noise::{NoiseGenerator, PlaneBounds, plane_noise, plane_noise_bounds};
use strahl_simd::Isa;

/// Two numbers, the lower one first.
pub(super) type Range = (f64, f64);

/// What formulas of heights do with numbers.
pub(super) trait Number: Copy {
    /// Where a height is computed: a point of the plane, or a rectangle.
    type Place: Copy;

    /// A number that does not depend on the place.
    fn constant(x: f64) -> Self;
    /// Noise from -1 to 1 at the place times frequencies, at most so many.
    fn noises<I: Isa>(
        isa: I,
        place: Self::Place,
        frequencies: &[f64],
        generator: NoiseGenerator,
        out: &mut [Self; AT_ONCE],
    );
    /// The logarithm of the distance from a point of the plane, `0.5 ln(max(dx² + dz² + height², least²))`.
    fn log_distance(place: Self::Place, viewpoint: &Viewpoint) -> Self;
    fn plus<I: Isa>(self, isa: I, other: Self) -> Self;
    fn times<I: Isa>(self, isa: I, other: Self) -> Self;
    #[inline(always)]
    fn square<I: Isa>(self, isa: I) -> Self {
        self.times(isa, self)
    }
    fn scaled<I: Isa>(self, isa: I, factor: f64) -> Self;
    fn abs<I: Isa>(self, isa: I) -> Self;
    /// Cut off at 0 and 1.
    fn share<I: Isa>(self, isa: I) -> Self;
    /// `3 x² - 2 x³`, of a number from 0 to 1.
    fn smooth<I: Isa>(self, isa: I) -> Self;
    /// The greatest it may be.
    fn most(self) -> f64;
    /// Whether it is certainly not greater than zero.
    fn is_nothing(self) -> bool {
        self.most() <= 0.0
    }
}

/// A place times four frequencies, which are positive.
#[inline(always)]
fn octaves<I: Isa>(isa: I, [x, z]: [f64; 2], frequencies: &[f64; 4]) -> [[f64; 4]; 2] {
    let frequencies = isa.load(frequencies);
    [
        isa.store(isa.mul(isa.splat(x), frequencies)),
        isa.store(isa.mul(isa.splat(z), frequencies)),
    ]
}

/// From noise between 0 and 1 to noise between -1 and 1.
#[inline(always)]
fn signed<I: Isa>(isa: I, noise: I::F64x4) -> I::F64x4 {
    isa.sub(isa.mul(isa.splat(2.0), noise), isa.splat(1.0))
}

/// So many octaves of noise are computed at once.
pub(super) const AT_ONCE: usize = 8;

/// Any noise.
const UNIT_NOISE: PlaneBounds = PlaneBounds {
    value: (0.0, 1.0),
    slopes: [(0.0, 0.0); 2],
    middle: f64::NAN,
};

/// Four of some numbers; the last one again where there are not so many.
#[inline(always)]
fn four(all: &[f64], first: usize) -> [f64; 4] {
    let mut four = [all[all.len() - 1]; 4];
    for n in 0..4 {
        if first + n < all.len() {
            four[n] = all[first + n];
        }
    }
    four
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

    #[inline(always)]
    fn constant(x: f64) -> Self {
        x
    }

    #[inline(always)]
    fn noises<I: Isa>(
        isa: I,
        place: [f64; 2],
        frequencies: &[f64],
        generator: NoiseGenerator,
        out: &mut [Self; AT_ONCE],
    ) {
        let mut first = 0;
        while first < frequencies.len() {
            let four = four(frequencies, first);
            let [x, z] = octaves(isa, place, &four);
            let found = plane_noise(isa, &x, &z, generator);
            let values = isa.store(signed(isa, found.value));
            out[first..first + 4].copy_from_slice(&values);
            first += 4;
        }
    }

    #[inline(always)]
    fn log_distance([x, z]: [f64; 2], viewpoint: &Viewpoint) -> Self {
        let (dx, dz) = (x - viewpoint.x, z - viewpoint.z);
        viewpoint.log(dx * dx, dz * dz)
    }

    #[inline(always)]
    fn plus<I: Isa>(self, _isa: I, other: Self) -> Self {
        self + other
    }

    #[inline(always)]
    fn times<I: Isa>(self, _isa: I, other: Self) -> Self {
        self * other
    }

    #[inline(always)]
    fn scaled<I: Isa>(self, _isa: I, factor: f64) -> Self {
        self * factor
    }

    #[inline(always)]
    fn abs<I: Isa>(self, _isa: I) -> Self {
        self.abs()
    }

    #[inline(always)]
    fn share<I: Isa>(self, _isa: I) -> Self {
        if self > 0.0 {
            if self < 1.0 { self } else { 1.0 }
        } else {
            0.0
        }
    }

    #[inline(always)]
    fn smooth<I: Isa>(self, _isa: I) -> Self {
        self * self * (3.0 - 2.0 * self)
    }

    #[inline(always)]
    fn most(self) -> f64 {
        self
    }
}

/// A number with its derivatives by x and z.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sloped {
    pub(super) value: f64,
    pub(super) slopes: [f64; 2],
}

impl Sloped {
    #[inline(always)]
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

    #[inline(always)]
    fn constant(value: f64) -> Self {
        let slopes = [0.0; 2];
        Self { value, slopes }
    }

    #[inline(always)]
    fn noises<I: Isa>(
        isa: I,
        place: [f64; 2],
        frequencies: &[f64],
        generator: NoiseGenerator,
        out: &mut [Self; AT_ONCE],
    ) {
        let mut first = 0;
        while first < frequencies.len() {
            let four = four(frequencies, first);
            let [x, z] = octaves(isa, place, &four);
            let found = plane_noise(isa, &x, &z, generator);
            let values = isa.store(signed(isa, found.value));
            let factors = isa.mul(isa.splat(2.0), isa.load(&four));
            let a = isa.store(isa.mul(found.slopes[0], factors));
            let b = isa.store(isa.mul(found.slopes[1], factors));
            for n in 0..4 {
                out[first + n] = Self {
                    value: values[n],
                    slopes: [a[n], b[n]],
                };
            }
            first += 4;
        }
    }

    #[inline(always)]
    fn log_distance([x, z]: [f64; 2], viewpoint: &Viewpoint) -> Self {
        let (dx, dz) = (x - viewpoint.x, z - viewpoint.z);
        let value = viewpoint.log(dx * dx, dz * dz);
        let r2 = (dx * dx + dz * dz) + viewpoint.height2;
        let inverse = if r2 > viewpoint.least2 { 1.0 / r2 } else { 0.0 };
        let slopes = [dx * inverse, dz * inverse];
        Self { value, slopes }
    }

    #[inline(always)]
    fn plus<I: Isa>(self, _isa: I, other: Self) -> Self {
        let ([a, b], [c, d]) = (self.slopes, other.slopes);
        Self {
            value: self.value + other.value,
            slopes: [a + c, b + d],
        }
    }

    #[inline(always)]
    fn times<I: Isa>(self, _isa: I, other: Self) -> Self {
        let ([a, b], [c, d]) = (self.slopes, other.slopes);
        let (p, q) = (self.value, other.value);
        Self {
            value: p * q,
            slopes: [a * q + p * c, b * q + p * d],
        }
    }

    #[inline(always)]
    fn scaled<I: Isa>(self, _isa: I, factor: f64) -> Self {
        self.with(self.value * factor, factor)
    }

    #[inline(always)]
    fn abs<I: Isa>(self, _isa: I) -> Self {
        let sign = if self.value < 0.0 { -1.0 } else { 1.0 };
        self.with(self.value.abs(), sign)
    }

    #[inline(always)]
    fn share<I: Isa>(self, isa: I) -> Self {
        let value = self.value.share(isa);
        let inside = if value == self.value { 1.0 } else { 0.0 };
        self.with(value, inside)
    }

    #[inline(always)]
    fn smooth<I: Isa>(self, isa: I) -> Self {
        let x = self.value;
        self.with(x.smooth(isa), 6.0 * x * (1.0 - x))
    }

    #[inline(always)]
    fn most(self) -> f64 {
        self.value
    }
}

/// The ranges of a number and of its derivatives by x and z over a rectangle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ranged {
    pub(super) value: Range,
    /// The ends of the ranges of both derivatives, one after the other.
    pub(super) slopes: [f64; 4],
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
fn square((a, b): Range) -> Range {
    let (p, q) = (a * a, b * b);
    let least = if a < 0.0 && b > 0.0 { 0.0 } else { lower(p, q) };
    (least, upper(p, q))
}

#[inline(always)]
pub(super) fn times((a, b): Range, factor: f64) -> Range {
    if factor < 0.0 {
        (b * factor, a * factor)
    } else {
        (a * factor, b * factor)
    }
}

/// The products of two ranges and a third one.
#[inline(always)]
fn products<I: Isa>(isa: I, [a, b, c, d]: [f64; 4], factor: Range) -> [f64; 4] {
    let (low, high) = factor;
    if low >= 0.0 {
        // An end of a product is made of the same end, times what moves it farther out.
        let ends = isa.load(&[a, b, c, d]);
        let near = isa.mul(ends, isa.load(&[low, high, low, high]));
        let far = isa.mul(ends, isa.load(&[high, low, high, low]));
        return isa.store(isa.choose_le(isa.splat(0.0), ends, near, far));
    }
    let (p, q) = (product((a, b), factor), product((c, d), factor));
    [p.0, p.1, q.0, q.1]
}

impl Ranged {
    /// Noise from -1 to 1, from bounds of the noise and its slopes.
    #[inline(always)]
    fn noise(bounds: &PlaneBounds, frequency: f64) -> Self {
        let (value, [a, b]) = (bounds.value, bounds.slopes);
        let factor = 2.0 * frequency;
        Self {
            value: (2.0 * value.0 - 1.0, 2.0 * value.1 - 1.0),
            slopes: [a.0 * factor, a.1 * factor, b.0 * factor, b.1 * factor],
        }
    }

    /// With another value, and slopes times a range.
    #[inline(always)]
    fn with<I: Isa>(self, isa: I, value: Range, factor: Range) -> Self {
        Self {
            value,
            slopes: products(isa, self.slopes, factor),
        }
    }
}

impl Number for Ranged {
    type Place = Rectangle;

    #[inline(always)]
    fn constant(x: f64) -> Self {
        Self {
            value: (x, x),
            slopes: [0.0; 4],
        }
    }

    #[inline(always)]
    fn noises<I: Isa>(
        isa: I,
        [x, z]: Rectangle,
        frequencies: &[f64],
        generator: NoiseGenerator,
        out: &mut [Self; AT_ONCE],
    ) {
        let mut found = [UNIT_NOISE; AT_ONCE];
        plane_noise_bounds(isa, x, z, frequencies, generator, &mut found);
        for n in 0..frequencies.len() {
            out[n] = Self::noise(&found[n], frequencies[n]);
        }
    }

    #[inline(always)]
    fn log_distance([x, z]: Rectangle, viewpoint: &Viewpoint) -> Self {
        let away = |(a, b): Range, v: f64| (a - v, b - v);
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
            slopes: {
                let (a, b) = (slope(dx), slope(dz));
                [a.0, a.1, b.0, b.1]
            },
        }
    }

    #[inline(always)]
    fn plus<I: Isa>(self, isa: I, other: Self) -> Self {
        let slopes = isa.add(isa.load(&self.slopes), isa.load(&other.slopes));
        Self {
            value: sum(self.value, other.value),
            slopes: isa.store(slopes),
        }
    }

    #[inline(always)]
    fn times<I: Isa>(self, isa: I, other: Self) -> Self {
        let one = products(isa, self.slopes, other.value);
        let two = products(isa, other.slopes, self.value);
        Self {
            value: product(self.value, other.value),
            slopes: isa.store(isa.add(isa.load(&one), isa.load(&two))),
        }
    }

    #[inline(always)]
    fn square<I: Isa>(self, isa: I) -> Self {
        let (a, b) = self.value;
        self.with(isa, square(self.value), (2.0 * a, 2.0 * b))
    }

    #[inline(always)]
    fn scaled<I: Isa>(self, isa: I, factor: f64) -> Self {
        let [a, b, c, d] = self.slopes;
        let ends = if factor < 0.0 {
            [b, a, d, c]
        } else {
            [a, b, c, d]
        };
        Self {
            value: times(self.value, factor),
            slopes: isa.store(isa.mul(isa.load(&ends), isa.splat(factor))),
        }
    }

    #[inline(always)]
    fn abs<I: Isa>(self, isa: I) -> Self {
        let (a, b) = self.value;
        if a >= 0.0 {
            self
        } else if b <= 0.0 {
            self.scaled(isa, -1.0)
        } else {
            self.with(isa, (0.0, upper(-a, b)), (-1.0, 1.0))
        }
    }

    #[inline(always)]
    fn share<I: Isa>(self, isa: I) -> Self {
        let (a, b) = self.value;
        if a >= 0.0 && b <= 1.0 {
            self
        } else if b <= 0.0 || a >= 1.0 {
            Self::constant(a.share(isa))
        } else {
            self.with(isa, (a.share(isa), b.share(isa)), (0.0, 1.0))
        }
    }

    #[inline(always)]
    fn smooth<I: Isa>(self, isa: I) -> Self {
        let (a, b) = self.value;
        let slope = |x: f64| 6.0 * x * (1.0 - x);
        let (p, q) = (slope(a), slope(b));
        let most = if a < 0.5 && b > 0.5 { 1.5 } else { upper(p, q) };
        self.with(isa, (a.smooth(isa), b.smooth(isa)), (lower(p, q), most))
    }

    #[inline(always)]
    fn most(self) -> f64 {
        self.value.1
    }
}

/// A number over a rectangle, nearly linear: `middle + slopes . (x, z)` with x and z from -1 to 1 over the rectangle, off by at most `off`
/// (affine arithmetic: L. H. de Figueiredo, J. Stolfi, "Affine arithmetic: concepts and applications", Numerical Algorithms 37, 2004).
///
/// Octaves that are longer than the rectangle add their slopes, of either sign, where ranges would add only what they reach over.
#[derive(Clone, Copy, Debug)]
pub(super) struct Affine {
    pub(super) middle: f64,
    pub(super) slopes: [f64; 2],
    pub(super) off: f64,
}

/// More than the roundings of a place, of a point between two, and of the place times a frequency.
const BLUR: f64 = 8.0 * f64::EPSILON;

impl Affine {
    #[inline(always)]
    fn within((low, high): Range) -> Self {
        Self {
            middle: 0.5 * (low + high),
            slopes: [0.0; 2],
            off: 0.5 * (high - low),
        }
    }

    /// Noise from -1 to 1 at a rectangle times a frequency, from bounds of the noise there.
    #[inline(always)]
    fn noise(bounds: &PlaneBounds, rectangle: &Rectangle, frequency: f64) -> Self {
        let (value, slopes) = (bounds.value, bounds.slopes);
        let mut near = Self {
            middle: 2.0 * bounds.middle - 1.0,
            slopes: [0.0; 2],
            off: 0.0,
        };
        for k in 0..2 {
            let ((low, high), (a, b)) = (rectangle[k], slopes[k]);
            let half = 0.5 * (high - low) * frequency;
            let blur = BLUR * upper(low.abs(), high.abs()) * frequency;
            near.slopes[k] = (a + b) * half;
            near.off += (b - a) * half + 2.0 * upper(a.abs(), b.abs()) * blur;
        }
        // A middle that is not known is NaN.
        if near.off < value.1 - value.0 && !near.middle.is_nan() {
            near
        } else {
            Self::within((2.0 * value.0 - 1.0, 2.0 * value.1 - 1.0))
        }
    }

    /// What half a diagonal of the rectangle adds that runs upwards or downwards along x and z.
    pub(super) fn along(self, x: bool, z: bool) -> f64 {
        let [a, b] = self.slopes;
        (if x { a } else { -a }) + if z { b } else { -b }
    }

    /// How far it is from the middle, at most.
    #[inline(always)]
    fn reach(self) -> f64 {
        self.slopes[0].abs() + self.slopes[1].abs() + self.off
    }

    #[inline(always)]
    pub(super) fn range(self) -> Range {
        (self.middle - self.reach(), self.middle + self.reach())
    }

    /// The tighter one of two descriptions.
    #[inline(always)]
    fn or(self, other: Self) -> Self {
        if other.reach() < self.reach() {
            other
        } else {
            self
        }
    }
}

impl Number for Affine {
    type Place = Rectangle;

    #[inline(always)]
    fn constant(x: f64) -> Self {
        Self {
            middle: x,
            slopes: [0.0; 2],
            off: 0.0,
        }
    }

    #[inline(always)]
    fn noises<I: Isa>(
        isa: I,
        place: Rectangle,
        frequencies: &[f64],
        generator: NoiseGenerator,
        out: &mut [Self; AT_ONCE],
    ) {
        let mut all = [(Ranged::constant(0.0), Self::constant(0.0)); AT_ONCE];
        <(Ranged, Self)>::noises(isa, place, frequencies, generator, &mut all);
        for n in 0..frequencies.len() {
            out[n] = all[n].1;
        }
    }

    #[inline(always)]
    fn log_distance(place: Rectangle, viewpoint: &Viewpoint) -> Self {
        Self::within(Ranged::log_distance(place, viewpoint).value)
    }

    #[inline(always)]
    fn plus<I: Isa>(self, _isa: I, other: Self) -> Self {
        let ([a, b], [c, d]) = (self.slopes, other.slopes);
        Self {
            middle: self.middle + other.middle,
            slopes: [a + c, b + d],
            off: self.off + other.off,
        }
    }

    #[inline(always)]
    fn times<I: Isa>(self, _isa: I, other: Self) -> Self {
        let ([a, b], [c, d]) = (self.slopes, other.slopes);
        let (p, q) = (self.middle, other.middle);
        Self {
            middle: p * q,
            slopes: [a * q + p * c, b * q + p * d],
            off: (p.abs() * other.off + q.abs() * self.off) + self.reach() * other.reach(),
        }
    }

    #[inline(always)]
    fn square<I: Isa>(self, _isa: I) -> Self {
        let twice = 2.0 * self.middle;
        let [a, b] = self.slopes;
        // The square of what it is off lies between 0 and this.
        let most = self.reach() * self.reach();
        Self {
            middle: self.middle * self.middle + 0.5 * most,
            slopes: [a * twice, b * twice],
            off: twice.abs() * self.off + 0.5 * most,
        }
    }

    #[inline(always)]
    fn scaled<I: Isa>(self, _isa: I, factor: f64) -> Self {
        let [a, b] = self.slopes;
        Self {
            middle: self.middle * factor,
            slopes: [a * factor, b * factor],
            off: self.off * factor.abs(),
        }
    }

    #[inline(always)]
    fn abs<I: Isa>(self, isa: I) -> Self {
        let (low, high) = self.range();
        if low >= 0.0 {
            return self;
        }
        if high <= 0.0 {
            return self.scaled(isa, -1.0);
        }
        // Below the chord between the ends, by at most as much as at zero.
        let slope = self.middle / self.reach();
        let below = -2.0 * high * low / (high - low);
        let mut chord = self.scaled(isa, slope);
        chord.middle += 0.5 * below;
        chord.off += 0.5 * below;
        chord.or(Self::within((0.0, upper(-low, high))))
    }

    #[inline(always)]
    fn share<I: Isa>(self, isa: I) -> Self {
        let (low, high) = self.range();
        if low >= 0.0 && high <= 1.0 {
            return self;
        }
        // What is cut off below and above.
        let (below, above) = (upper(-low, 0.0), upper(high - 1.0, 0.0));
        let mut cut = self;
        cut.middle += 0.5 * (below - above);
        cut.off += 0.5 * (below + above);
        cut.or(Self::within((low.share(isa), high.share(isa))))
    }

    #[inline(always)]
    fn smooth<I: Isa>(self, isa: I) -> Self {
        let (low, high) = self.range();
        Self::within((low.share(isa).smooth(isa), high.share(isa).smooth(isa)))
    }

    #[inline(always)]
    fn most(self) -> f64 {
        self.middle + self.reach()
    }
}

/// Both at once.
impl Number for (Ranged, Affine) {
    type Place = Rectangle;

    #[inline(always)]
    fn constant(x: f64) -> Self {
        (Ranged::constant(x), Affine::constant(x))
    }

    #[inline(always)]
    fn noises<I: Isa>(
        isa: I,
        [x, z]: Rectangle,
        frequencies: &[f64],
        generator: NoiseGenerator,
        out: &mut [Self; AT_ONCE],
    ) {
        let mut found = [UNIT_NOISE; AT_ONCE];
        plane_noise_bounds(isa, x, z, frequencies, generator, &mut found);
        for n in 0..frequencies.len() {
            let frequency = frequencies[n];
            out[n] = (
                Ranged::noise(&found[n], frequency),
                Affine::noise(&found[n], &[x, z], frequency),
            );
        }
    }

    #[inline(always)]
    fn log_distance(place: Rectangle, viewpoint: &Viewpoint) -> Self {
        let found = Ranged::log_distance(place, viewpoint);
        (found, Affine::within(found.value))
    }

    #[inline(always)]
    fn plus<I: Isa>(self, isa: I, other: Self) -> Self {
        (self.0.plus(isa, other.0), self.1.plus(isa, other.1))
    }

    #[inline(always)]
    fn times<I: Isa>(self, isa: I, other: Self) -> Self {
        (self.0.times(isa, other.0), self.1.times(isa, other.1))
    }

    #[inline(always)]
    fn square<I: Isa>(self, isa: I) -> Self {
        (self.0.square(isa), self.1.square(isa))
    }

    #[inline(always)]
    fn scaled<I: Isa>(self, isa: I, factor: f64) -> Self {
        (self.0.scaled(isa, factor), self.1.scaled(isa, factor))
    }

    #[inline(always)]
    fn abs<I: Isa>(self, isa: I) -> Self {
        (self.0.abs(isa), self.1.abs(isa))
    }

    #[inline(always)]
    fn share<I: Isa>(self, isa: I) -> Self {
        (self.0.share(isa), self.1.share(isa))
    }

    #[inline(always)]
    fn smooth<I: Isa>(self, isa: I) -> Self {
        (self.0.smooth(isa), self.1.smooth(isa))
    }

    #[inline(always)]
    fn most(self) -> f64 {
        self.0.most()
    }
}
