use crate::blocks::dot;
use std::ops::ControlFlow;
use strahl_math::det::Exponent;
use strahl_math::error::ROUNDOFF;
use strahl_math::roots::find_root;
use strahl_math::{DVec3, det};
use strahl_simd::Isa;

/// The gauge of a superellipsoid: the factor by which it must grow to reach a point, `N = (g^q + |z|^q)^(1/q)` with
/// `g = (|x|^p + |y|^p)^(1/p)`, which is 1 on the surface and proportional to the distance from the centre along each ray from
/// there.
///
/// Powers are taken of ratios below 1 only, so nothing overflows and large powers, those of sharp edges, lose no digits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Gauge {
    /// The norm of x and y.
    outline: Norm,
    /// The norm of that one and z.
    section: Norm,
}

/// The norm `(a^p + b^p)^(1/p)` of two numbers that are not negative.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Norm {
    p: f64,
    power: Exponent,
    root: Exponent,
    /// Ratios of the smaller number to the larger one up to this have a power that vanishes beside 1.
    negligible: f64,
}

/// A range of numbers that are not negative.
#[derive(Clone, Copy, Debug)]
struct Bounds {
    low: f64,
    high: f64,
}

impl Bounds {
    /// From the smaller of two numbers to the larger.
    fn between(a: f64, b: f64) -> Self {
        if a < b {
            Self { low: a, high: b }
        } else {
            Self { low: b, high: a }
        }
    }
}

/// An interval of a line between two of the planes of symmetry, or a part of it: the magnitudes of the coordinates are linear
/// here.
#[derive(Clone, Copy)]
struct Stretch {
    low: f64,
    high: f64,
    depth: u32,
}

/// How often an interval is halved at most: features on less than 1e-12 of it are missed.
const MAX_DEPTH: u32 = 40;

impl Gauge {
    pub(super) fn new(p: f64, q: f64) -> Self {
        Self {
            outline: Norm::new(p),
            section: Norm::new(q),
        }
    }

    /// Whether the body is convex; the gauge is a norm then.
    pub(super) fn is_convex(&self) -> bool {
        self.outline.p >= 1.0 && self.section.p >= 1.0
    }

    /// A bound on the relative error of the value: roots of small exponents are powers that magnify errors.
    pub(super) fn error(&self) -> f64 {
        6.0 * ROUNDOFF * (2.0 + 1.0 / self.outline.p + 1.0 / self.section.p)
    }

    /// The value and its derivatives.
    // Inline: Newton's last step asks for the value alone.
    #[inline(always)]
    pub(super) fn value_and_gradient(&self, point: DVec3) -> (f64, DVec3) {
        let a = point.abs();
        let (g, by_x, by_y) = self.outline.combine(a.x, a.y);
        let (value, by_g, by_z) = self.section.combine(g, a.z);
        let gradient = DVec3::new(by_g * by_x, by_g * by_y, by_z);
        // At cusps, where a derivative is infinite, only its direction is left.
        let gradient = if gradient.is_finite() {
            gradient
        } else {
            let steep = |x: f64| if x == f64::INFINITY { 1.0 } else { 0.0 };
            DVec3::new(steep(gradient.x), steep(gradient.y), steep(gradient.z))
        };
        (value, gradient * point.signum())
    }

    /// The value, with the bits of [`Gauge::value_and_gradient`], where it takes no powers: on the flat parts of bodies with sharp edges.
    #[inline]
    pub(super) fn value_without_powers(&self, point: DVec3) -> Option<f64> {
        let a = point.abs();
        self.section.dominant(self.outline.dominant(a.x, a.y)?, a.z)
    }

    /// The value at a corner of the box around the body: no point of the box has a greater one.
    pub(super) fn at_a_corner(&self) -> f64 {
        let (g, ..) = self.outline.combine(1.0, 1.0);
        self.section.combine(g, 1.0).0
    }

    /// The value and its derivative along a direction.
    #[inline]
    pub(super) fn along(&self, point: DVec3, direction: DVec3) -> (f64, f64) {
        let (value, gradient) = self.value_and_gradient(point);
        (value, gradient.dot(direction))
    }

    /// [`Gauge::along`] at four points, with the same bits in the lanes that are returned as known: those of points off the planes of symmetry
    /// with finite derivatives.
    #[inline(always)]
    pub(super) fn along_four<I: Isa>(
        &self,
        isa: I,
        [x, y, z]: [I::F64x4; 3],
        direction: [I::F64x4; 3],
    ) -> (I::F64x4, I::F64x4, u32) {
        let (zero, turned) = (isa.splat(0.0), isa.splat(-1.0));
        let (a, b, c) = (isa.abs(x), isa.abs(y), isa.abs(z));
        let (g, by_x, by_y) = combine_four(isa, self.outline.p, a, b);
        let (value, by_g, by_z) = combine_four(isa, self.section.p, g, c);
        let (by_x, by_y) = (isa.mul(by_g, by_x), isa.mul(by_g, by_y));
        let finite = isa.splat(f64::MAX);
        let known = isa.lt(zero, a)
            & isa.lt(zero, b)
            & isa.lt(zero, c)
            & isa.le(by_x, finite)
            & isa.le(by_y, finite)
            & isa.le(by_z, finite);
        let gradient = [
            isa.choose_le(zero, x, by_x, isa.mul(by_x, turned)),
            isa.choose_le(zero, y, by_y, isa.mul(by_y, turned)),
            isa.choose_le(zero, z, by_z, isa.mul(by_z, turned)),
        ];
        (value, dot(isa, gradient, direction), known)
    }

    /// Bounds of the derivative along the line, where the magnitudes of the coordinates are within bounds and change at these
    /// rates.
    fn slope(&self, [x, y, z]: &[Bounds; 3], pace: DVec3) -> Bounds {
        let (by_x, by_y) = self.outline.derivative_bounds(*x, *y);
        let g = Bounds {
            low: self.outline.combine(x.low, y.low).0,
            high: self.outline.combine(x.high, y.high).0,
        };
        let (by_g, by_z) = self.section.derivative_bounds(g, *z);
        let product = |a: Bounds, b: Bounds| Bounds {
            low: a.low * b.low,
            high: a.high * b.high,
        };
        let mut sum = Bounds {
            low: 0.0,
            high: 0.0,
        };
        for (derivative, pace) in [
            (product(by_g, by_x), pace.x),
            (product(by_g, by_y), pace.y),
            (by_z, pace.z),
        ] {
            if pace > 0.0 {
                sum.low += derivative.low * pace;
                sum.high += derivative.high * pace;
            } else if pace < 0.0 {
                sum.low += derivative.high * pace;
                sum.high += derivative.low * pace;
            }
        }
        // Widened by the rounding of the powers; NaN (0 times infinity) gives no bounds.
        let slack = 1e-12 * (sum.low.abs() + sum.high.abs());
        if slack.is_finite() {
            Bounds {
                low: sum.low - slack,
                high: sum.high + slack,
            }
        } else {
            Bounds {
                low: f64::NEG_INFINITY,
                high: f64::INFINITY,
            }
        }
    }
}

/// A line through a gauge that is not convex, followed from crossing to crossing.
#[derive(Clone, Copy, Debug)]
pub(super) struct GaugeLine {
    pub(super) gauge: Gauge,
    pub(super) start: DVec3,
    pub(super) direction: DVec3,
    /// The gauge of the surface: 1, or that of the start of a line that starts on it.
    pub(super) level: f64,
    /// Where to start.
    pub(super) from: f64,
    /// Whether the line is inside just behind its start, later just behind the last crossing.
    pub(super) inside: bool,
}

impl GaugeLine {
    fn at(&self, s: f64) -> DVec3 {
        self.start + self.direction * s
    }

    /// Visits where `start + s direction`, `from < s < length`, crosses the surface.
    pub(super) fn crossings(
        &mut self,
        length: f64,
        visit: &mut impl FnMut(f64, bool) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        // Between the planes of symmetry the magnitudes of the coordinates are linear.
        let mut planes = [length; 4];
        for (axis, plane) in planes.iter_mut().enumerate().take(3) {
            let s = -self.start[axis] / self.direction[axis];
            if self.from < s && s < length {
                *plane = s;
            }
        }
        planes.sort_by(f64::total_cmp);
        let mut low = self.from;
        for high in planes {
            if high > low {
                let depth = 0;
                self.search(Stretch { low, high, depth }, visit)?;
                low = high;
            }
        }
        ControlFlow::Continue(())
    }

    /// Halves an interval until each part is on one side of the level or monotone.
    fn search(
        &mut self,
        stretch: Stretch,
        visit: &mut impl FnMut(f64, bool) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let Stretch { low, high, depth } = stretch;
        let (a, b) = (self.at(low), self.at(high));
        let middle = 0.5 * (low + high);
        // A coordinate whose plane bounds the stretch is zero there but for rounding; its sign is that within.
        let pace = self.direction * self.at(middle).signum();
        let ranges = [0, 1, 2].map(|axis| Bounds::between(a[axis].abs(), b[axis].abs()));
        let gauge = self.gauge;
        let corner = |pick: fn(Bounds) -> f64| {
            let corner = DVec3::from(ranges.map(pick));
            gauge.value_and_gradient(corner).0 / self.level
        };
        let (least, most) = (corner(|r| r.low), corner(|r| r.high));
        let slope = gauge.slope(&ranges, pace);
        let monotone = slope.low > 0.0 || slope.high < 0.0;
        let crossing = if least > 1.0 + gauge.error() || most < 1.0 - gauge.error() {
            // There is no crossing here; one before it that rounding has hidden is reported now.
            (self.inside != (most < 1.0)).then_some(low)
        } else if monotone || depth >= MAX_DEPTH || !(low < middle && middle < high) {
            let ends_inside = gauge.value_and_gradient(b).0 <= self.level;
            (ends_inside != self.inside).then(|| {
                find_root(low, high, self.inside, f64::NAN, |s| {
                    let (value, slope) = gauge.along(self.at(s), self.direction);
                    (value - self.level, slope)
                })
            })
        } else {
            for (low, high) in [(low, middle), (middle, high)] {
                let depth = depth + 1;
                self.search(Stretch { low, high, depth }, visit)?;
            }
            None
        };
        if let Some(s) = crossing {
            self.inside = !self.inside;
            visit(s, self.inside)?;
        }
        ControlFlow::Continue(())
    }
}

impl Norm {
    fn new(p: f64) -> Self {
        // Half of what would still vanish, for rounding.
        let negligible = det::pow(0.5, f64::from(f64::MANTISSA_DIGITS + 1) / p);
        Self {
            p,
            power: Exponent::new(p),
            root: Exponent::new(1.0 / p),
            negligible,
        }
    }

    /// The norm and its derivatives by both numbers.
    #[inline]
    fn combine(&self, a: f64, b: f64) -> (f64, f64, f64) {
        let p = self.p;
        let (large, small) = if a > b { (a, b) } else { (b, a) };
        if large == 0.0 {
            return (a + b, 1.0, 1.0);
        }
        let ratio = small / large;
        let power = raise(ratio, p, self.power);
        let sum = 1.0 + power;
        // All roots of 1 are 1.
        let root = if sum == 1.0 {
            1.0
        } else {
            raise(sum, 1.0 / p, self.root)
        };
        let by_large = root / sum;
        let by_small = by_large * steepness(p, ratio, power);
        let value = large * root;
        if a > b {
            (value, by_large, by_small)
        } else {
            (value, by_small, by_large)
        }
    }

    /// The norm, with the bits of [`Norm::combine`], where one number vanishes beside the other.
    #[inline]
    fn dominant(&self, a: f64, b: f64) -> Option<f64> {
        let (large, small) = if a > b { (a, b) } else { (b, a) };
        (small / large <= self.negligible).then_some(large)
    }

    /// Bounds on the derivatives of the norm over ranges of both numbers.
    fn derivative_bounds(&self, a: Bounds, b: Bounds) -> (Bounds, Bounds) {
        // (a / value)^(p - 1) is monotone in the ratio of a and b.
        let (_, a_first, b_last) = self.combine(a.low, b.high);
        let (_, a_last, b_first) = self.combine(a.high, b.low);
        (
            Bounds::between(a_first, a_last),
            Bounds::between(b_first, b_last),
        )
    }
}

/// [`Norm::combine`] of four pairs, all above zero.
#[inline(always)]
fn combine_four<I: Isa>(
    isa: I,
    p: f64,
    a: I::F64x4,
    b: I::F64x4,
) -> (I::F64x4, I::F64x4, I::F64x4) {
    let (large, small) = (isa.choose_le(a, b, b, a), isa.choose_le(a, b, a, b));
    let ratio = isa.div(small, large);
    let power = raise_four(isa, ratio, p);
    let sum = isa.add(isa.splat(1.0), power);
    let root = raise_four(isa, sum, 1.0 / p);
    let by_large = isa.div(root, sum);
    let by_small = isa.mul(by_large, isa.div(power, ratio));
    (
        isa.mul(large, root),
        isa.choose_le(a, b, by_small, by_large),
        isa.choose_le(a, b, by_large, by_small),
    )
}

/// `ratio^(p - 1)`, given `ratio^p`.
#[inline]
fn steepness(p: f64, ratio: f64, power: f64) -> f64 {
    if ratio > 0.0 {
        power / ratio
    } else if p > 1.0 {
        0.0
    } else if p == 1.0 {
        1.0
    } else {
        f64::INFINITY
    }
}

/// A power of a number that is not negative.
#[inline]
fn raise(base: f64, exponent: f64, known: Exponent) -> f64 {
    if exponent == 0.5 {
        base.sqrt()
    } else {
        known.of(base, exponent)
    }
}

/// Powers of four numbers that are not negative.
#[inline(always)]
fn raise_four<I: Isa>(isa: I, bases: I::F64x4, exponent: f64) -> I::F64x4 {
    if exponent == 0.5 {
        isa.sqrt(bases)
    } else {
        isa.load(&det::powers(isa, &isa.store(bases), exponent))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_gauge_is_the_formula() {
        for (p, q) in [(2.0, 2.0), (10.0, 3.0), (0.7, 1.5), (1.0, 0.5), (60.0, 0.9)] {
            let point = DVec3::new(0.5, -0.3, 0.7);
            let (value, gradient) = Gauge::new(p, q).value_and_gradient(point);
            let a = point.abs();
            let g = det::pow(det::pow(a.x, p) + det::pow(a.y, p), q / p);
            let expected = det::pow(g + det::pow(a.z, q), 1.0 / q);
            assert!((value - expected).abs() < 1e-15 * expected, "{p} {q}");
            // Euler's theorem on homogeneous functions.
            assert!((gradient.dot(point) - value).abs() < 1e-14, "{p} {q}");
            for axis in 0..3 {
                let h = DVec3::AXES[axis] * 1e-6;
                let value = |p_: DVec3| Gauge::new(p, q).value_and_gradient(p_).0;
                let slope = (value(point + h) - value(point - h)) / 2e-6;
                assert!((slope - gradient[axis]).abs() < 1e-7, "{p} {q} {axis}");
            }
        }
    }

    #[test]
    fn values_without_powers_have_the_same_bits() {
        let mut plain = 0;
        for p in [0.3, 1.0, 2.0, 7.3, 40.0, 1e3, 1e9, 1e17] {
            let (norm, gauge) = (Norm::new(p), Gauge::new(p, 2.0 * p));
            for step in 0..4000 {
                // Ratios around the largest that is negligible, and all others.
                let ratio = match step % 2 {
                    0 => norm.negligible * (1.0 + f64::from(step - 2000) * 1e-9),
                    _ => f64::from(step) / 4000.0,
                };
                let point = DVec3::new(ratio * 0.7, -0.7, 0.7 - 2e-4 * f64::from(step));
                if let Some(value) = gauge.value_without_powers(point) {
                    assert_eq!(value, gauge.value_and_gradient(point).0, "{p} {point}");
                    plain += 1;
                }
                assert_eq!(raise(1.0, 1.0 / p, norm.root), 1.0);
            }
        }
        assert!(plain > 2000, "{plain}");
    }

    #[test]
    fn no_point_of_the_box_is_beyond_its_corner() {
        for (p, q) in [(1.0, 1.0), (2.0, 40.0), (1.3, 1.1), (1e9, 60.0)] {
            let gauge = Gauge::new(p, q);
            let corner = gauge.at_a_corner() * (1.0 + gauge.error());
            for step in 0..1000 {
                let t = f64::from(step);
                let point = DVec3::new((t * 0.37).sin(), (t * 0.71).cos(), (t * 0.13).sin());
                let most = point.abs().max_element();
                assert!(gauge.value_and_gradient(point).0 <= most * corner);
            }
            assert!(gauge.value_and_gradient(DVec3::ONE).0 <= corner);
        }
    }

    #[test]
    fn slopes_are_within_their_bounds() {
        for (p, q) in [(0.7, 0.6), (0.5, 4.0), (5.0, 0.8)] {
            let gauge = Gauge::new(p, q);
            let (a, b) = (DVec3::new(0.2, 0.5, 0.3), DVec3::new(0.4, 0.1, 0.6));
            let pace = b - a;
            let ranges = [0, 1, 2].map(|axis| Bounds::between(a[axis], b[axis]));
            let slope = gauge.slope(&ranges, pace);
            for i in 0..=20 {
                let (_, found) = gauge.along(a + pace * (f64::from(i) / 20.0), pace);
                assert!(
                    slope.low <= found && found <= slope.high,
                    "{p} {q} {slope:?}"
                );
            }
        }
    }
}
