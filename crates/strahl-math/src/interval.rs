/// A range of ray parameters.
///
/// A hit at `t` lies in the range of a query if `min < t && t <= max`: the lower end is open, so that a ray does not
/// meet the point it starts from, the upper end is closed, so that of two hits at equal `t` the accelerator gets to see
/// both and the smaller id wins. A caller that wants `t < max` passes `max.next_down()`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// Lower end (exclusive in hit queries).
    pub min: f64,
    /// Upper end (inclusive in hit queries).
    pub max: f64,
}

impl Interval {
    /// Everything in front of a ray's origin: `(0, +inf]`.
    pub const FORWARD: Self = Self::new(0.0, f64::INFINITY);
    /// The whole line: `(-inf, +inf]`.
    pub const LINE: Self = Self::new(f64::NEG_INFINITY, f64::INFINITY);
    /// The range between a point and a light at `t = 1`: `0 < t < 1`.
    pub const UNTIL_LIGHT: Self = Self::new(0.0, 1.0 - f64::EPSILON / 2.0);

    /// The range from `min` to `max`.
    pub const fn new(min: f64, max: f64) -> Self {
        Self { min, max }
    }

    /// Whether a hit at `t` counts: `min < t && t <= max` (false for NaN).
    #[inline]
    pub fn accepts(&self, t: f64) -> bool {
        self.min < t && t <= self.max
    }

    /// Whether no parameter is in the range.
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.min >= self.max
    }

    /// The part common to both ranges (possibly empty).
    #[inline]
    pub fn intersection(&self, other: Self) -> Self {
        Self::new(
            if self.min > other.min {
                self.min
            } else {
                other.min
            },
            if self.max < other.max {
                self.max
            } else {
                other.max
            },
        )
    }

    /// The same lower end with a new upper end.
    #[inline]
    pub fn with_max(self, max: f64) -> Self {
        Self { max, ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::Interval;

    #[test]
    fn the_lower_end_is_open_and_the_upper_closed() {
        let range = Interval::new(0.0, 2.0);
        assert!(!range.accepts(0.0));
        assert!(range.accepts(f64::MIN_POSITIVE));
        assert!(range.accepts(2.0));
        assert!(!range.accepts(2.0f64.next_up()));
        assert!(!range.accepts(f64::NAN));
    }

    #[test]
    fn the_light_itself_is_not_in_its_shadow_range() {
        assert!(!Interval::UNTIL_LIGHT.accepts(1.0));
        assert!(Interval::UNTIL_LIGHT.accepts(1.0f64.next_down()));
    }
}
