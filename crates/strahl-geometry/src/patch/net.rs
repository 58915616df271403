//! Nets of control coefficients in Bernstein form, of any number of coordinates and the same degree in both parameters.

/// A net: `rows[v][u]`, the `K` coefficients of a row for the first parameter, the rows for the second. Its degree is `K - 1`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Net<const N: usize, const K: usize> {
    pub(super) rows: [Curve<N, K>; K],
}

/// The control coefficients of a curve.
pub(super) type Curve<const N: usize, const K: usize> = [[f64; N]; K];

/// A value with its derivatives by both parameters.
#[derive(Clone, Copy, Debug)]
pub(super) struct Jet<const N: usize> {
    pub(super) value: [f64; N],
    pub(super) by_u: [f64; N],
    pub(super) by_v: [f64; N],
}

/// `array::from_fn`, which is not always inlined; nor is `array::map`. Copying coefficients took half of the time of dividing a net.
#[inline(always)]
fn each<const N: usize>(f: impl Fn(usize) -> f64) -> [f64; N] {
    let mut all = [0.0; N];
    for (k, x) in all.iter_mut().enumerate() {
        *x = f(k);
    }
    all
}

#[inline(always)]
fn mean<const N: usize>(a: &[f64; N], b: &[f64; N]) -> [f64; N] {
    each(|k| 0.5 * (a[k] + b[k]))
}

#[inline(always)]
fn weighted<const N: usize, const K: usize>(c: &Curve<N, K>, w: &[f64; K]) -> [f64; N] {
    each(|k| {
        let mut sum = c[0][k] * w[0];
        for i in 1..K {
            sum += c[i][k] * w[i];
        }
        sum
    })
}

/// The Bernstein polynomials of degree `K - 1` and their derivatives.
#[inline(always)]
pub(super) fn bernstein<const K: usize>(t: f64) -> ([f64; K], [f64; K]) {
    let s = 1.0 - t;
    let (mut value, mut slope) = ([0.0; K], [0.0; K]);
    if K == 4 {
        let (ss, tt, st) = (s * s, t * t, s * t);
        let values = [ss * s, 3.0 * (ss * t), 3.0 * (s * tt), tt * t];
        let slopes = [
            -3.0 * ss,
            3.0 * (ss - 2.0 * st),
            3.0 * (2.0 * st - tt),
            3.0 * tt,
        ];
        // One by one: copying slices would be a call.
        for i in 0..K {
            (value[i], slope[i]) = (values[i], slopes[i]);
        }
        return (value, slope);
    }
    // Each degree from the one below: B(i, n) = s B(i, n - 1) + t B(i - 1, n - 1).
    value[0] = 1.0;
    for n in 1..K {
        if n == K - 1 {
            let degree = n as f64;
            slope[0] = -degree * value[0];
            for i in 1..n {
                slope[i] = degree * (value[i - 1] - value[i]);
            }
            slope[n] = degree * value[n - 1];
        }
        value[n] = t * value[n - 1];
        for i in (1..n).rev() {
            value[i] = s * value[i] + t * value[i - 1];
        }
        value[0] *= s;
    }
    (value, slope)
}

/// Both halves of a curve (de Casteljau 1959). The reversed curve has the reversed halves, to the last bit.
#[inline(always)]
pub(super) fn halves<const N: usize, const K: usize>(c: &Curve<N, K>) -> [Curve<N, K>; 2] {
    let mut row = *c;
    let (mut left, mut right) = (*c, *c);
    for step in 1..K {
        for i in 0..K - step {
            row[i] = mean(&row[i], &row[i + 1]);
        }
        left[step] = row[0];
        right[K - 1 - step] = row[K - 1 - step];
    }
    [left, right]
}

impl<const N: usize, const K: usize> Net<N, K> {
    /// The net whose coefficients are made from those of another.
    #[inline(always)]
    pub(super) fn map<const M: usize>(&self, f: impl Fn(&[f64; N]) -> [f64; M]) -> Net<M, K> {
        Net {
            rows: std::array::from_fn(|j| std::array::from_fn(|i| f(&self.rows[j][i]))),
        }
    }

    /// All coefficients, row after row.
    pub(super) fn points(&self) -> impl Iterator<Item = &[f64; N]> + Clone {
        self.rows.iter().flatten()
    }

    /// The value at two parameters.
    #[inline]
    pub(super) fn at(&self, u: f64, v: f64) -> [f64; N] {
        let ((bu, _), (bv, _)) = (bernstein::<K>(u), bernstein::<K>(v));
        weighted(&std::array::from_fn(|j| weighted(&self.rows[j], &bu)), &bv)
    }

    /// The value and the derivatives at two parameters.
    #[inline]
    pub(super) fn jet(&self, u: f64, v: f64) -> Jet<N> {
        let ((bu, su), (bv, sv)) = (bernstein::<K>(u), bernstein::<K>(v));
        let values: Curve<N, K> = std::array::from_fn(|j| weighted(&self.rows[j], &bu));
        let slopes: Curve<N, K> = std::array::from_fn(|j| weighted(&self.rows[j], &su));
        Jet {
            value: weighted(&values, &bv),
            by_u: weighted(&slopes, &bv),
            by_v: weighted(&values, &sv),
        }
    }

    /// Both halves along the first parameter.
    #[inline]
    pub(super) fn halves_u(&self) -> [Self; 2] {
        let (mut left, mut right) = (*self, *self);
        for j in 0..K {
            [left.rows[j], right.rows[j]] = halves(&self.rows[j]);
        }
        [left, right]
    }

    /// Both halves along the second parameter.
    #[inline]
    pub(super) fn halves_v(&self) -> [Self; 2] {
        let (mut left, mut right) = (*self, *self);
        for i in 0..K {
            let [below, above] = halves(&self.column(i));
            for j in 0..K {
                (left.rows[j][i], right.rows[j][i]) = (below[j], above[j]);
            }
        }
        [left, right]
    }

    /// The coefficients of column `i`, along the second parameter.
    #[inline(always)]
    pub(super) fn column(&self, i: usize) -> Curve<N, K> {
        let mut column = self.rows[0];
        for (own, row) in column.iter_mut().zip(&self.rows) {
            *own = row[i];
        }
        column
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

    /// The `K (K - 1)` coefficients of the derivative by the first parameter.
    #[inline(always)]
    pub(super) fn slopes_u(&self) -> impl Iterator<Item = [f64; N]> + Clone + '_ {
        self.rows.iter().flat_map(|row| {
            (1..K).map(move |i| each(|k| (K - 1) as f64 * (row[i][k] - row[i - 1][k])))
        })
    }

    /// The `K (K - 1)` coefficients of the derivative by the second parameter.
    #[inline(always)]
    pub(super) fn slopes_v(&self) -> impl Iterator<Item = [f64; N]> + Clone + '_ {
        self.rows.windows(2).flat_map(|pair| {
            (0..K).map(move |i| each(|k| (K - 1) as f64 * (pair[1][i][k] - pair[0][i][k])))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conformance::Random;

    fn random_net<const K: usize>(random: &mut Random) -> Net<2, K> {
        Net {
            rows: std::array::from_fn(|_| {
                std::array::from_fn(|_| std::array::from_fn(|_| random.between(-1.0, 1.0)))
            }),
        }
    }

    fn parts_and_derivatives<const K: usize>() {
        let mut random = Random::new(3);
        for _ in 0..200 {
            let net = random_net::<K>(&mut random);
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
                assert!((slope - whole.by_u[k]).abs() < 1e-7);
                let (low, high) = part.extents();
                assert!(low[k] <= piece.value[k] && piece.value[k] <= high[k]);
                let most = part
                    .slopes_v()
                    .map(|s| s[k])
                    .fold(f64::NEG_INFINITY, f64::max);
                assert!(piece.by_v[k] <= most + 1e-14);
            }
        }
    }

    #[test]
    fn parts_and_derivatives_are_those_of_the_net() {
        parts_and_derivatives::<3>();
        parts_and_derivatives::<4>();
        parts_and_derivatives::<6>();
        parts_and_derivatives::<10>();
    }

    #[test]
    fn a_reversed_curve_has_the_reversed_halves_to_the_last_bit() {
        let mut random = Random::new(5);
        for _ in 0..1000 {
            let curve = random_net::<6>(&mut random).rows[0];
            let reversed = |c: &Curve<2, 6>| [c[5], c[4], c[3], c[2], c[1], c[0]];
            let [a, b] = halves(&curve);
            assert_eq!(halves(&reversed(&curve)), [reversed(&b), reversed(&a)]);
        }
    }
}
