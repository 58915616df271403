//! Parts of the spectrum, for glass that refracts colours differently.

use crate::Color;

/// How much of red, green and blue light lies in the spectrum before the places 0, 1/25, 2/25, ... 1, from red to violet. Measured with
/// POV-Ray 3.7.0.10: a step seen through the face of a block of glass with 100 dispersion samples.
const BEFORE: [[f64; 3]; 26] = [
    [0.0000, 0.0000, 0.0000],
    [0.0386, 0.0000, 0.0000],
    [0.1066, 0.0000, 0.0000],
    [0.1975, 0.0000, 0.0000],
    [0.3047, 0.0004, 0.0000],
    [0.4216, 0.0183, 0.0000],
    [0.5416, 0.0665, 0.0000],
    [0.6577, 0.1389, 0.0000],
    [0.7633, 0.2301, 0.0000],
    [0.8518, 0.3345, 0.0000],
    [0.9167, 0.4470, 0.0000],
    [0.9504, 0.5621, 0.0000],
    [0.9543, 0.6742, 0.0028],
    [0.9543, 0.7779, 0.0290],
    [0.9543, 0.8678, 0.0798],
    [0.9543, 0.9388, 0.1506],
    [0.9543, 0.9844, 0.2374],
    [0.9543, 1.0000, 0.3354],
    [0.9543, 1.0000, 0.4402],
    [0.9543, 1.0000, 0.5476],
    [0.9543, 1.0000, 0.6530],
    [0.9551, 1.0000, 0.7519],
    [0.9625, 1.0000, 0.8401],
    [0.9742, 1.0000, 0.9130],
    [0.9861, 1.0000, 0.9665],
    [0.9938, 1.0000, 0.9962],
];

/// One of the equal parts that the spectrum is divided into, or all of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SpectralPart {
    number: u16,
    /// 0 for white light.
    count: u16,
}

impl SpectralPart {
    /// All light.
    pub const WHITE: Self = Self {
        number: 0,
        count: 0,
    };

    /// The parts of a division, from red to violet.
    pub fn all(count: u16) -> impl Iterator<Item = Self> {
        (0..count).map(move |number| Self { number, count })
    }

    /// Whether it stands for the whole spectrum.
    #[inline]
    pub const fn is_white(self) -> bool {
        self.count == 0
    }

    /// The position of its middle in the spectrum: 0 is the red end, 1 the violet one; white light counts as the middle.
    pub fn place(self) -> f64 {
        if self.is_white() {
            return 0.5;
        }
        (f64::from(self.number) + 0.5) / f64::from(self.count)
    }

    /// Its share of the light. The shares of all parts sum to white, within one part in 150.
    pub fn share(self) -> Color {
        if self.is_white() {
            return Color::WHITE;
        }
        let end = |number: u16| before(f64::from(number) / f64::from(self.count));
        end(self.number + 1) - end(self.number)
    }
}

/// The light that lies before a place in the spectrum.
fn before(place: f64) -> Color {
    let last = BEFORE.len() - 1;
    let at = place * last as f64;
    let index = if at < last as f64 {
        at as usize
    } else {
        last - 1
    };
    let t = at - index as f64;
    let [low, high] = [BEFORE[index], BEFORE[index + 1]].map(|[r, g, b]| Color::new(r, g, b));
    low * (1.0 - t) + high * t
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Seven samples, POV-Ray's default, as measured there.
    #[test]
    fn shares_are_as_measured() {
        let red = [0.2570, 0.4167, 0.2708, 0.0098, 0.0, 0.0030, 0.0365];
        let parts: Vec<Color> = SpectralPart::all(7).map(SpectralPart::share).collect();
        for (part, red) in parts.iter().zip(red) {
            assert!((part.r - red).abs() < 0.006, "{part:?} is not {red}");
        }
        for count in [2, 3, 7, 100] {
            let sum = SpectralPart::all(count).fold(Color::BLACK, |sum, part| sum + part.share());
            assert!(
                (sum - Color::WHITE).map(f64::abs).max_component() < 0.0067,
                "{sum:?}"
            );
        }
        assert_eq!(SpectralPart::WHITE.share(), Color::WHITE);
    }
}
