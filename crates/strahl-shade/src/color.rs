use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Sub};

/// A linear RGB colour with Rec. 709 primaries; radiance or reflectance, so any non-negative value may occur.
///
/// Colours are computed in f64 and rounded to f32 once, when they enter the film.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Color {
    /// Red.
    pub r: f64,
    /// Green.
    pub g: f64,
    /// Blue.
    pub b: f64,
}

impl Color {
    /// No light.
    pub const BLACK: Self = Self::gray(0.0);
    /// Full reflectance, unit radiance.
    pub const WHITE: Self = Self::gray(1.0);

    /// The colour with these components.
    pub const fn new(r: f64, g: f64, b: f64) -> Self {
        Self { r, g, b }
    }

    /// Equal components.
    pub const fn gray(value: f64) -> Self {
        Self::new(value, value, value)
    }

    /// The largest component.
    #[inline]
    pub fn max_component(self) -> f64 {
        let m = if self.r > self.g { self.r } else { self.g };
        if self.b > m { self.b } else { m }
    }

    /// POV-Ray's grey value, `0.297 r + 0.589 g + 0.114 b`.
    #[inline]
    pub fn gray_value(self) -> f64 {
        0.297 * self.r + 0.589 * self.g + 0.114 * self.b
    }

    /// Whether every component is exactly zero.
    #[inline]
    pub fn is_black(self) -> bool {
        self.r == 0.0 && self.g == 0.0 && self.b == 0.0
    }

    /// Whether every component is finite.
    pub fn is_finite(self) -> bool {
        self.r.is_finite() && self.g.is_finite() && self.b.is_finite()
    }

    /// Applies a function to each component.
    #[must_use]
    pub fn map(self, f: impl Fn(f64) -> f64) -> Self {
        Self::new(f(self.r), f(self.g), f(self.b))
    }

    /// `self * (1 - t) + other * t`.
    #[must_use]
    pub fn lerp(self, other: Self, t: f64) -> Self {
        self * (1.0 - t) + other * t
    }

    /// The components as an array.
    pub const fn to_array(self) -> [f64; 3] {
        [self.r, self.g, self.b]
    }

    /// Rounded to f32, as the film stores it.
    pub fn to_f32(self) -> [f32; 3] {
        [self.r as f32, self.g as f32, self.b as f32]
    }
}

impl From<[f64; 3]> for Color {
    fn from([r, g, b]: [f64; 3]) -> Self {
        Self::new(r, g, b)
    }
}

impl Add for Color {
    type Output = Self;
    #[inline]
    fn add(self, o: Self) -> Self {
        Self::new(self.r + o.r, self.g + o.g, self.b + o.b)
    }
}

impl Sub for Color {
    type Output = Self;
    #[inline]
    fn sub(self, o: Self) -> Self {
        Self::new(self.r - o.r, self.g - o.g, self.b - o.b)
    }
}

impl Mul for Color {
    type Output = Self;
    #[inline]
    fn mul(self, o: Self) -> Self {
        Self::new(self.r * o.r, self.g * o.g, self.b * o.b)
    }
}

impl Mul<f64> for Color {
    type Output = Self;
    #[inline]
    fn mul(self, k: f64) -> Self {
        Self::new(self.r * k, self.g * k, self.b * k)
    }
}

impl Div<f64> for Color {
    type Output = Self;
    #[inline]
    fn div(self, k: f64) -> Self {
        Self::new(self.r / k, self.g / k, self.b / k)
    }
}

impl AddAssign for Color {
    #[inline]
    fn add_assign(&mut self, o: Self) {
        *self = *self + o;
    }
}

impl MulAssign for Color {
    #[inline]
    fn mul_assign(&mut self, o: Self) {
        *self = *self * o;
    }
}
