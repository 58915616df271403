use strahl_math::DVec3;

/// One to five numbers: a float (one), a vector (two to five) or a colour (five).
///
/// Arithmetic is componentwise. A float combined with a vector counts as a vector of equal components; a shorter vector combined
/// with a longer one is padded with zeros.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vector {
    len: u8,
    components: [f64; 5],
}

impl Vector {
    /// A single number.
    #[inline]
    pub const fn float(x: f64) -> Self {
        Self {
            len: 1,
            components: [x, 0.0, 0.0, 0.0, 0.0],
        }
    }

    /// A vector of three components.
    #[inline]
    pub const fn xyz(x: f64, y: f64, z: f64) -> Self {
        Self {
            len: 3,
            components: [x, y, z, 0.0, 0.0],
        }
    }

    /// A colour.
    #[inline]
    pub const fn rgbft(components: [f64; 5]) -> Self {
        Self { len: 5, components }
    }

    /// The first five of these numbers; an empty list is the float 0.
    pub fn new(numbers: &[f64]) -> Self {
        let mut components = [0.0; 5];
        let len = numbers.len().clamp(1, 5);
        for (c, n) in components.iter_mut().zip(numbers) {
            *c = *n;
        }
        Self {
            len: len as u8,
            components,
        }
    }

    /// The first `count` of five numbers; the others must be zero.
    #[inline]
    pub(crate) const fn of(components: [f64; 5], count: usize) -> Self {
        Self {
            len: count as u8,
            components,
        }
    }

    /// The number of components, 1 to 5.
    #[inline]
    #[expect(clippy::len_without_is_empty, reason = "never empty")]
    pub const fn len(&self) -> usize {
        self.len as usize
    }

    /// All five components; unused ones are zero.
    #[inline]
    pub const fn components(&self) -> [f64; 5] {
        self.components
    }

    /// The components in use.
    #[inline]
    pub fn as_slice(&self) -> &[f64] {
        self.components.get(..self.len()).unwrap_or(&[])
    }

    /// The number, if it is a single one.
    #[inline]
    pub const fn as_float(&self) -> Option<f64> {
        if self.len == 1 {
            Some(self.components[0])
        } else {
            None
        }
    }

    /// The same with another first component.
    #[must_use]
    pub(crate) fn with_first(mut self, x: f64) -> Self {
        self.components[0] = x;
        self
    }

    /// The same with `len` components: a float is repeated, a vector truncated or padded with zeros.
    #[inline]
    #[must_use]
    pub fn promoted(&self, len: usize) -> Self {
        let len = len.clamp(1, 5);
        let spread = self.spread();
        let mut components = [0.0; 5];
        // A loop of constant length, which the compiler unrolls.
        for i in 0..5 {
            components[i] = if i < len { spread[i] } else { 0.0 };
        }
        Self {
            len: len as u8,
            components,
        }
    }

    /// The components; those of a float are all equal.
    #[inline]
    const fn spread(&self) -> [f64; 5] {
        match self.len {
            1 => [self.components[0]; 5],
            _ => self.components,
        }
    }

    /// The first three components of the vector, or the float three times.
    #[inline]
    pub fn to_dvec3(&self) -> DVec3 {
        let [x, y, z, ..] = self.promoted(3).components;
        DVec3::new(x, y, z)
    }

    /// Applies a function to each component.
    #[inline]
    #[must_use]
    pub fn map(mut self, f: impl Fn(f64) -> f64) -> Self {
        for c in self.components.iter_mut().take(self.len as usize) {
            *c = f(*c);
        }
        self
    }

    /// Applies a function to the components of both, pair by pair.
    #[inline]
    #[must_use]
    pub fn zip(self, other: Self, f: impl Fn(f64, f64) -> f64) -> Self {
        if self.len == 1 && other.len == 1 {
            return Self::float(f(self.components[0], other.components[0]));
        }
        let len = self.len.max(other.len);
        let (a, b) = (self.spread(), other.spread());
        let mut components = [0.0; 5];
        for i in 0..5 {
            components[i] = if i < len as usize { f(a[i], b[i]) } else { 0.0 };
        }
        Self { len, components }
    }
}

impl From<DVec3> for Vector {
    fn from(v: DVec3) -> Self {
        Self::xyz(v.x, v.y, v.z)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn floats_are_repeated_and_vectors_filled() {
        let v = Vector::new(&[1.0, 2.0]);
        let sum = v.zip(Vector::float(1.0), |a, b| a + b);
        assert_eq!(sum.as_slice(), [2.0, 3.0]);
        let sum = v.zip(Vector::new(&[1.0, 1.0, 1.0, 1.0]), |a, b| a + b);
        assert_eq!(sum.as_slice(), [2.0, 3.0, 1.0, 1.0]);
        assert_eq!(Vector::float(2.0).to_dvec3(), DVec3::splat(2.0));
        assert_eq!(Vector::new(&[1.0; 9]).len(), 5);
    }
}
