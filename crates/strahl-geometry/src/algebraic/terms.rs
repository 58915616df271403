use strahl_math::DVec3;

/// The terms of a polynomial in x, y and z, set up for Horner's scheme: sparse in x and y, dense in z.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Terms {
    degree: u32,
    /// By falling powers of x, then of y.
    rows: Vec<Row>,
    /// The coefficients of all rows.
    coefficients: Vec<f64>,
}

/// The terms with one power of x and one of y: `x^i y^j (c₀ z^k + c₁ z^(k-1) + ...)`.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Row {
    x: u32,
    y: u32,
    /// Its coefficients, by falling powers of z down to the constant.
    first: u32,
    end: u32,
}

/// The numbers in which a polynomial can be evaluated: plain ones, numbers with gradients, polynomials in one variable.
pub(super) trait Value: Copy {
    /// The values of x, y and z.
    type Variable: Copy;
    /// Zero.
    const ZERO: Self;
    /// Adds another value.
    fn add(&mut self, other: &Self);
    /// Adds a number.
    fn add_constant(&mut self, c: f64);
    /// Multiplies by a variable.
    fn multiply(&mut self, variable: Self::Variable);
    /// Multiplies by a power of a variable.
    #[inline]
    fn raise(&mut self, variable: Self::Variable, power: u32) {
        for _ in 0..power {
            self.multiply(variable);
        }
    }
    /// The polynomial in a variable with these coefficients, by falling powers.
    #[inline]
    fn horner(coefficients: &[f64], variable: Self::Variable) -> Self {
        let mut sum = Self::ZERO;
        for (k, c) in coefficients.iter().enumerate() {
            if k > 0 {
                sum.multiply(variable);
            }
            if *c != 0.0 {
                sum.add_constant(*c);
            }
        }
        sum
    }
}

impl Value for f64 {
    type Variable = f64;
    const ZERO: Self = 0.0;

    fn add(&mut self, other: &Self) {
        *self += other;
    }

    fn add_constant(&mut self, c: f64) {
        *self += c;
    }

    fn multiply(&mut self, variable: f64) {
        *self *= variable;
    }
}

/// A value and its gradient.
#[derive(Clone, Copy, Debug)]
pub(super) struct Dual {
    pub(super) value: f64,
    pub(super) gradient: DVec3,
}

impl Value for Dual {
    /// A coordinate and the unit vector of its axis.
    type Variable = (f64, DVec3);
    const ZERO: Self = Self {
        value: 0.0,
        gradient: DVec3::ZERO,
    };

    fn add(&mut self, other: &Self) {
        self.value += other.value;
        self.gradient += other.gradient;
    }

    fn add_constant(&mut self, c: f64) {
        self.value += c;
    }

    fn multiply(&mut self, (x, axis): (f64, DVec3)) {
        self.gradient = self.gradient * x + axis * self.value;
        self.value *= x;
    }
}

/// A polynomial in one variable with up to `N` coefficients, lowest first.
#[derive(Clone, Copy, Debug)]
pub(super) struct Univariate<const N: usize> {
    pub(super) coefficients: [f64; N],
    /// How many of them are used; 0 for zero.
    used: usize,
}

impl<const N: usize> Univariate<N> {
    /// Whether there are so few coefficients that they are kept in registers, by loops over all numbers of coefficients there may
    /// be, which the compiler unrolls.
    const SHORT: bool = N <= 7;

    /// Multiplies by `a + b s` where so many coefficients are used: one at least.
    #[inline(always)]
    fn multiply_used(&mut self, used: usize, (a, b): (f64, f64)) {
        let c = &mut self.coefficients;
        if used < N {
            c[used] = c[used - 1] * b;
        }
        for k in (1..used).rev() {
            c[k] = c[k] * a + c[k - 1] * b;
        }
        c[0] *= a;
    }
}

impl<const N: usize> Value for Univariate<N> {
    /// `a + b s`, both finite.
    type Variable = (f64, f64);
    const ZERO: Self = Self {
        coefficients: [0.0; N],
        used: 0,
    };

    #[inline]
    fn add(&mut self, other: &Self) {
        let used = if other.used > self.used {
            other.used
        } else {
            self.used
        };
        // To add them all takes less time than to count them, unless it is a number.
        if !Self::SHORT || other.used <= 1 {
            let pairs = self.coefficients.iter_mut().zip(&other.coefficients);
            for (sum, c) in pairs.take(other.used) {
                *sum += c;
            }
        } else {
            for k in 0..N {
                self.coefficients[k] += other.coefficients[k];
            }
        }
        self.used = used;
    }

    #[inline]
    fn add_constant(&mut self, c: f64) {
        if let Some(first) = self.coefficients.first_mut() {
            *first += c;
        }
        if self.used == 0 {
            self.used = 1;
        }
    }

    #[inline]
    fn multiply(&mut self, variable: (f64, f64)) {
        if self.used > 0 {
            self.multiply_used(self.used, variable);
        }
        if self.used > 0 && self.used < N {
            self.used += 1;
        }
    }

    #[inline]
    fn raise(&mut self, variable: (f64, f64), power: u32) {
        if !Self::SHORT {
            for _ in 0..power {
                self.multiply(variable);
            }
            return;
        }
        let mut left = power;
        for used in 1..N {
            if left == 0 {
                return;
            }
            if self.used == used {
                self.multiply_used(used, variable);
                self.used += 1;
                left -= 1;
            }
        }
    }

    #[inline]
    fn horner(coefficients: &[f64], variable: (f64, f64)) -> Self {
        let mut sum = Self::ZERO;
        let mut coefficients = coefficients.iter();
        let Some(first) = coefficients.next() else {
            return sum;
        };
        sum.add_constant(*first);
        for used in 1..N {
            let Some(c) = coefficients.next() else { break };
            sum.multiply_used(used, variable);
            sum.coefficients[0] += c;
            sum.used += 1;
        }
        sum
    }
}

impl Terms {
    /// The polynomial of some terms, each the powers of x, y and z and a coefficient; equal powers are added up.
    pub(super) fn new(terms: impl IntoIterator<Item = ([u32; 3], f64)>) -> Self {
        let mut list: Vec<([u32; 3], f64)> = terms.into_iter().filter(|(_, c)| *c != 0.0).collect();
        list.sort_by(|(a, _), (b, _)| b.cmp(a));
        let mut this = Self {
            degree: 0,
            rows: vec![],
            coefficients: vec![],
        };
        let mut last = None;
        for ([x, y, z], c) in list {
            this.degree = this.degree.max(x + y + z);
            match (&mut last, this.rows.last_mut()) {
                (Some(power), Some(row)) if (row.x, row.y) == (x, y) => {
                    if *power == z {
                        if let Some(same) = this.coefficients.last_mut() {
                            *same += c;
                        }
                        continue;
                    }
                    this.coefficients
                        .extend((z + 1..*power).map(|_| 0.0).chain([c]));
                    *power = z;
                    row.end = this.coefficients.len() as u32;
                }
                _ => {
                    this.close_row(last);
                    let first = this.coefficients.len() as u32;
                    this.coefficients.push(c);
                    this.rows.push(Row {
                        x,
                        y,
                        first,
                        end: first + 1,
                    });
                    last = Some(z);
                }
            }
        }
        this.close_row(last);
        this
    }

    /// Ends the last row, whose lowest power of z so far is this, with the constant.
    fn close_row(&mut self, lowest: Option<u32>) {
        let zeros = lowest.unwrap_or(0);
        self.coefficients.extend((0..zeros).map(|_| 0.0));
        if let Some(row) = self.rows.last_mut() {
            row.end = self.coefficients.len() as u32;
        }
    }

    /// The total degree.
    pub(super) fn degree(&self) -> u32 {
        self.degree
    }

    /// The terms again: the powers of x, y and z and the coefficient.
    pub(super) fn iter(&self) -> impl Iterator<Item = ([u32; 3], f64)> {
        self.rows.iter().flat_map(|row| {
            let list = self.row(row);
            let powers = (0..list.len() as u32).rev();
            powers.zip(list).map(|(z, c)| ([row.x, row.y, z], *c))
        })
    }

    fn row(&self, row: &Row) -> &[f64] {
        self.coefficients
            .get(row.first as usize..row.end as usize)
            .unwrap_or_default()
    }

    /// The value with these put in for x, y and z, by Horner's scheme.
    #[inline]
    pub(super) fn evaluate<V: Value>(&self, x: V::Variable, y: V::Variable, z: V::Variable) -> V {
        let (mut sum, mut same_x) = (V::ZERO, V::ZERO);
        let (mut power_x, mut power_y) = (0, 0);
        for row in &self.rows {
            if row.x != power_x {
                same_x.raise(y, power_y);
                sum.add(&same_x);
                sum.raise(x, power_x.saturating_sub(row.x));
                (same_x, power_x, power_y) = (V::ZERO, row.x, row.y);
            }
            same_x.raise(y, power_y.saturating_sub(row.y));
            power_y = row.y;
            match self.row(row) {
                [c] => same_x.add_constant(*c),
                in_z => same_x.add(&V::horner(in_z, z)),
            }
        }
        same_x.raise(y, power_y);
        sum.add(&same_x);
        sum.raise(x, power_x);
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn example() -> Terms {
        Terms::new([
            ([0, 0, 0], -1.0),
            ([2, 1, 0], 3.0),
            ([2, 0, 3], 2.0),
            ([2, 0, 1], -5.0),
            ([0, 4, 1], 0.5),
            ([0, 0, 2], 4.0),
            ([0, 0, 2], 1.0),
            ([1, 0, 0], 0.0),
        ])
    }

    fn direct(x: f64, y: f64, z: f64) -> f64 {
        -1.0 + 3.0 * x * x * y + 2.0 * x * x * z * z * z - 5.0 * x * x * z
            + 0.5 * y * y * y * y * z
            + 5.0 * z * z
    }

    #[test]
    fn horner_gives_the_value() {
        let terms = example();
        assert_eq!(terms.degree(), 5);
        for (x, y, z) in [(0.0, 0.0, 0.0), (1.0, 2.0, 3.0), (-0.5, 1.5, -2.0)] {
            assert_eq!(terms.evaluate::<f64>(x, y, z), direct(x, y, z));
        }
        assert_eq!(Terms::new([]).evaluate::<f64>(1.0, 2.0, 3.0), 0.0);
        assert_eq!(Terms::new(terms.iter()), terms);
    }

    #[test]
    fn gradients_are_differences() {
        let p = DVec3::new(0.7, -1.2, 0.4);
        let dual: Dual = example().evaluate((p.x, DVec3::X), (p.y, DVec3::Y), (p.z, DVec3::Z));
        assert!((dual.value - direct(p.x, p.y, p.z)).abs() < 1e-14);
        for axis in 0..3 {
            let h = DVec3::AXES[axis] * 1e-6;
            let (a, b) = (p - h, p + h);
            let slope = (direct(b.x, b.y, b.z) - direct(a.x, a.y, a.z)) / 2e-6;
            assert!((dual.gradient[axis] - slope).abs() < 1e-8);
        }
    }

    #[test]
    fn a_restriction_to_a_line_is_the_polynomial_along_it() {
        let (o, d) = (DVec3::new(0.7, -1.2, 0.4), DVec3::new(-0.3, 0.5, 1.0));
        let line: Univariate<6> = example().evaluate((o.x, d.x), (o.y, d.y), (o.z, d.z));
        for s in [-2.0, -0.5, 0.0, 1.0, 3.0] {
            let p = o + d * s;
            let horner = line.coefficients.iter().rev().fold(0.0, |v, c| v * s + c);
            let expected = direct(p.x, p.y, p.z);
            assert!((horner - expected).abs() < 1e-12 * (1.0 + expected.abs()));
        }
    }
}
