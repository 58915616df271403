//! Nets of 4 by 4 control coefficients in Bernstein form, of any number of coordinates.

/// A net: `rows[v][u]`, the four coefficients of a row for the first parameter, the rows for the second.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Net<const N: usize> {
    pub(super) rows: [Curve<N>; 4],
}

/// The four control coefficients of a cubic curve.
pub(super) type Curve<const N: usize> = [[f64; N]; 4];

/// A value with its derivatives by both parameters.
#[derive(Clone, Copy, Debug)]
pub(super) struct Jet<const N: usize> {
    pub(super) value: [f64; N],
    pub(super) by_u: [f64; N],
    pub(super) by_v: [f64; N],
}

#[inline(always)]
fn each<const N: usize>(f: impl Fn(usize) -> f64) -> [f64; N] {
    std::array::from_fn(f)
}

#[inline(always)]
fn mean<const N: usize>(a: &[f64; N], b: &[f64; N]) -> [f64; N] {
    each(|k| 0.5 * (a[k] + b[k]))
}

#[inline(always)]
fn weighted<const N: usize>(c: &Curve<N>, w: &[f64; 4]) -> [f64; N] {
    each(|k| ((c[0][k] * w[0] + c[1][k] * w[1]) + c[2][k] * w[2]) + c[3][k] * w[3])
}

/// The Bernstein polynomials of degree 3 and their derivatives.
#[inline(always)]
fn bernstein(t: f64) -> ([f64; 4], [f64; 4]) {
    let s = 1.0 - t;
    let (ss, tt, st) = (s * s, t * t, s * t);
    let value = [ss * s, 3.0 * (ss * t), 3.0 * (s * tt), tt * t];
    let slope = [
        -3.0 * ss,
        3.0 * (ss - 2.0 * st),
        3.0 * (2.0 * st - tt),
        3.0 * tt,
    ];
    (value, slope)
}

/// Both halves of a curve (de Casteljau 1959). The reversed curve has the reversed halves, to the last bit.
#[inline(always)]
pub(super) fn halves<const N: usize>(c: &Curve<N>) -> [Curve<N>; 2] {
    let (a, b, d) = (mean(&c[0], &c[1]), mean(&c[1], &c[2]), mean(&c[2], &c[3]));
    let (e, f) = (mean(&a, &b), mean(&b, &d));
    let middle = mean(&e, &f);
    [[c[0], a, e, middle], [middle, f, d, c[3]]]
}

impl<const N: usize> Net<N> {
    /// The net whose coefficients are made from those of another.
    #[inline(always)]
    pub(super) fn map<const M: usize>(&self, f: impl Fn(&[f64; N]) -> [f64; M]) -> Net<M> {
        Net {
            rows: std::array::from_fn(|j| std::array::from_fn(|i| f(&self.rows[j][i]))),
        }
    }

    /// All sixteen coefficients.
    pub(super) fn points(&self) -> impl Iterator<Item = &[f64; N]> {
        self.rows.iter().flatten()
    }

    /// The value at two parameters.
    #[inline]
    pub(super) fn at(&self, u: f64, v: f64) -> [f64; N] {
        let ((bu, _), (bv, _)) = (bernstein(u), bernstein(v));
        weighted(&std::array::from_fn(|j| weighted(&self.rows[j], &bu)), &bv)
    }

    /// The value and the derivatives at two parameters.
    #[inline]
    pub(super) fn jet(&self, u: f64, v: f64) -> Jet<N> {
        let ((bu, su), (bv, sv)) = (bernstein(u), bernstein(v));
        let values: Curve<N> = std::array::from_fn(|j| weighted(&self.rows[j], &bu));
        let slopes: Curve<N> = std::array::from_fn(|j| weighted(&self.rows[j], &su));
        Jet {
            value: weighted(&values, &bv),
            by_u: weighted(&slopes, &bv),
            by_v: weighted(&values, &sv),
        }
    }

    /// Both halves along the first parameter.
    #[inline]
    pub(super) fn halves_u(&self) -> [Self; 2] {
        let both: [_; 4] = std::array::from_fn(|j| halves(&self.rows[j]));
        [0, 1].map(|side| Self {
            rows: std::array::from_fn(|j| both[j][side]),
        })
    }

    /// Both halves along the second parameter.
    #[inline]
    pub(super) fn halves_v(&self) -> [Self; 2] {
        let both: [_; 4] = std::array::from_fn(|i| halves(&self.column(i)));
        [0, 1].map(|side| Self {
            rows: std::array::from_fn(|j| std::array::from_fn(|i| both[i][side][j])),
        })
    }

    /// The coefficients of column `i`, along the second parameter.
    #[inline(always)]
    pub(super) fn column(&self, i: usize) -> Curve<N> {
        std::array::from_fn(|j| self.rows[j][i])
    }

    /// The part over the square number `(i, j)` of `2^level` by `2^level`.
    pub(super) fn part(&self, level: u32, i: u32, j: u32) -> Self {
        let mut net = *self;
        for step in (0..level).rev() {
            net = net.halves_u()[(i >> step & 1) as usize];
            net = net.halves_v()[(j >> step & 1) as usize];
        }
        net
    }

    /// The least and the greatest coefficient of each coordinate: bounds of all values between 0 and 1.
    #[inline]
    pub(super) fn extents(&self) -> ([f64; N], [f64; N]) {
        let first = self.rows[0][0];
        self.points().fold((first, first), |(low, high), p| {
            (
                each(|k| if p[k] < low[k] { p[k] } else { low[k] }),
                each(|k| if p[k] > high[k] { p[k] } else { high[k] }),
            )
        })
    }

    /// The coefficients of the derivative by the first parameter.
    #[inline]
    pub(super) fn slopes_u(&self) -> [[f64; N]; 12] {
        std::array::from_fn(|n| {
            let (j, i) = (n / 3, n % 3);
            each(|k| 3.0 * (self.rows[j][i + 1][k] - self.rows[j][i][k]))
        })
    }

    /// The coefficients of the derivative by the second parameter.
    #[inline]
    pub(super) fn slopes_v(&self) -> [[f64; N]; 12] {
        std::array::from_fn(|n| {
            let (j, i) = (n / 4, n % 4);
            each(|k| 3.0 * (self.rows[j + 1][i][k] - self.rows[j][i][k]))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conformance::Random;

    fn random_net(random: &mut Random) -> Net<2> {
        Net {
            rows: std::array::from_fn(|_| {
                std::array::from_fn(|_| std::array::from_fn(|_| random.between(-1.0, 1.0)))
            }),
        }
    }

    #[test]
    fn parts_and_derivatives_are_those_of_the_net() {
        let mut random = Random::new(3);
        for _ in 0..200 {
            let net = random_net(&mut random);
            let (i, j) = (random.below(8) as u32, random.below(8) as u32);
            let (x, y) = (random.unit(), random.unit());
            let part = net.part(3, i, j);
            let (u, v) = ((f64::from(i) + x) / 8.0, (f64::from(j) + y) / 8.0);
            let (whole, piece) = (net.jet(u, v), part.jet(x, y));
            assert_eq!(net.at(u, v), whole.value);
            let step = 1e-6;
            for k in 0..2 {
                assert!((whole.value[k] - piece.value[k]).abs() < 1e-14);
                assert!((whole.by_u[k] / 8.0 - piece.by_u[k]).abs() < 1e-13);
                assert!((whole.by_v[k] / 8.0 - piece.by_v[k]).abs() < 1e-13);
                let slope = (net.at(u + step, v)[k] - net.at(u - step, v)[k]) / (2.0 * step);
                assert!((slope - whole.by_u[k]).abs() < 1e-8);
                let (low, high) = part.extents();
                assert!(low[k] <= piece.value[k] && piece.value[k] <= high[k]);
                let slopes = part.slopes_v().map(|s| s[k]);
                let most = slopes.into_iter().fold(f64::NEG_INFINITY, f64::max);
                assert!(piece.by_v[k] <= most + 1e-14);
            }
        }
    }

    #[test]
    fn a_reversed_curve_has_the_reversed_halves_to_the_last_bit() {
        let mut random = Random::new(5);
        for _ in 0..1000 {
            let curve = random_net(&mut random).rows[0];
            let reversed = |c: &Curve<2>| [c[3], c[2], c[1], c[0]];
            let [a, b] = halves(&curve);
            assert_eq!(halves(&reversed(&curve)), [reversed(&b), reversed(&a)]);
        }
    }
}
