use std::{fmt, str::FromStr};
use strahl_shade::Color;

/// Where rays pass through a pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Sampling {
    /// One ray through the centre: no antialiasing.
    #[default]
    Center,
    /// Rays through the corners of the pixels, shared by neighbours; a pixel is the mean of its four corners. The Standard
    /// Procedural Databases define it so.
    Corners,
    /// n x n rays, one in each cell of a grid, at a random position that depends on pixel, cell and seed only; `n >= 1`.
    Grid(u32),
    /// One ray through the centre, then passes that refine the pixels which differ from a neighbour: pass k adds 2ᵏ x 2ᵏ rays.
    Adaptive {
        /// Difference of square roots of channel values, `0..=1`, beyond which a pixel is refined.
        threshold: f64,
        /// Number of refining passes, at most 4.
        passes: u32,
    },
}

impl Sampling {
    /// Most cells on a side of the grid.
    pub const MAX_GRID: u32 = 64;
    /// Adaptive sampling with the default parameters.
    pub const ADAPTIVE: Self = Self::Adaptive {
        threshold: 0.1,
        passes: 2,
    };

    /// The number of refining passes after the first.
    pub(crate) fn passes(self) -> u32 {
        match self {
            Self::Adaptive { passes, .. } => passes,
            _ => 0,
        }
    }

    /// The position in every pixel in pass `pass`, if each pixel has only one.
    pub(crate) fn common_place(self, pass: u32) -> Option<(f64, f64)> {
        match (self, pass) {
            (Self::Corners, _) => Some((0.0, 0.0)),
            (Self::Center | Self::Grid(0 | 1), _) | (Self::Adaptive { .. }, 0) => Some((0.5, 0.5)),
            _ => None,
        }
    }

    /// The positions in pixel `(x, y)` in pass `pass`, in pixels from its top left corner; `Corners` has its own lattice.
    pub(crate) fn places(
        self,
        pass: u32,
        x: u32,
        y: u32,
        seed: u64,
    ) -> impl ExactSizeIterator<Item = (f64, f64)> {
        let fixed = self.common_place(pass);
        let (cells, first_index) = match self {
            Self::Corners | Self::Center => (1, 0),
            Self::Grid(n) => (n.max(1), 0),
            // Each pass has its own range of random numbers.
            Self::Adaptive { .. } => (1 << pass, 1 << (2 * pass)),
        };
        (0..cells * cells).map(move |index| {
            fixed.unwrap_or_else(|| {
                let (jx, jy) = jitter(seed, x, y, first_index + index);
                let size = f64::from(cells);
                (
                    (f64::from(index % cells) + jx) / size,
                    (f64::from(index / cells) + jy) / size,
                )
            })
        })
    }
}

/// Two numbers in `0..1` from pixel, index and seed: SplitMix64 (Steele, Lea, Flood 2014) over the mixed inputs.
fn jitter(seed: u64, x: u32, y: u32, index: u32) -> (f64, f64) {
    let mix = |mut z: u64| {
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    };
    let step = 0x9e37_79b9_7f4a_7c15_u64;
    let pixel =
        mix(seed.wrapping_add(step) ^ mix((u64::from(y) << 32 | u64::from(x)).wrapping_add(step)));
    let first = mix(pixel.wrapping_add(step.wrapping_mul(u64::from(index) + 1)));
    let unit = |bits: u64| (bits >> 40) as f64 / (1u64 << 24) as f64;
    (unit(first), unit(first << 24))
}

/// The visible difference of two pixels: the largest difference of the square roots of their clamped channels.
pub(crate) fn contrast(a: Color, b: Color) -> f64 {
    let shown = |c: Color| {
        c.map(|v| {
            if v >= 1.0 {
                1.0
            } else if v > 0.0 {
                v.sqrt()
            } else {
                0.0
            }
        })
    };
    (shown(a) - shown(b)).map(f64::abs).max_component()
}

/// The text is not a way of sampling.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "unknown sampling `{0}`; there are: center (or none), corners, NxN (such as 3x3, at most 64x64), adaptive, \
     adaptive:THRESHOLD,PASSES (such as adaptive:0.1,2; 0 to 1, 1 to 4)"
)]
pub struct UnknownSampling(String);

impl FromStr for Sampling {
    type Err = UnknownSampling;

    fn from_str(s: &str) -> Result<Self, Self::Err> {
        let unknown = || UnknownSampling(s.to_owned());
        match s {
            "center" | "none" => return Ok(Self::Center),
            "corners" => return Ok(Self::Corners),
            "adaptive" => return Ok(Self::ADAPTIVE),
            _ => {}
        }
        if let Some(rest) = s.strip_prefix("adaptive:") {
            let (threshold, passes) = rest.split_once(',').unwrap_or((rest, "2"));
            let threshold: f64 = threshold.parse().map_err(|_| unknown())?;
            let passes: u32 = passes.parse().map_err(|_| unknown())?;
            let valid = (0.0..=1.0).contains(&threshold) && (1..=4).contains(&passes);
            return if valid {
                Ok(Self::Adaptive { threshold, passes })
            } else {
                Err(unknown())
            };
        }
        let (a, b) = s.split_once('x').ok_or_else(unknown)?;
        let n: u32 = a.parse().map_err(|_| unknown())?;
        if a == b && (1..=Self::MAX_GRID).contains(&n) {
            Ok(Self::Grid(n))
        } else {
            Err(unknown())
        }
    }
}

impl fmt::Display for Sampling {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Center => f.write_str("center"),
            Self::Corners => f.write_str("corners"),
            Self::Grid(n) => write!(f, "{n}x{n}"),
            Self::Adaptive { threshold, passes } => write!(f, "adaptive:{threshold},{passes}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_go_there_and_back() {
        for text in ["center", "corners", "3x3", "adaptive:0.1,2"] {
            assert_eq!(
                text.parse::<Sampling>().map(|s| s.to_string()),
                Ok(text.to_owned())
            );
        }
        assert_eq!("none".parse(), Ok(Sampling::Center));
        assert_eq!("adaptive".parse(), Ok(Sampling::ADAPTIVE));
        for text in [
            "",
            "3x4",
            "0x0",
            "65x65",
            "x",
            "adaptive:",
            "adaptive:2,1",
            "adaptive:0.1,9",
            "nine",
        ] {
            assert!(text.parse::<Sampling>().is_err(), "{text}");
        }
    }

    #[test]
    fn every_cell_has_its_sample() {
        let places = |x, seed| Sampling::Grid(4).places(0, x, 3, seed).collect::<Vec<_>>();
        let some = places(17, 99);
        for (i, (x, y)) in some.iter().enumerate() {
            assert_eq!(((x * 4.0) as usize, (y * 4.0) as usize), (i % 4, i / 4));
        }
        assert_ne!(some, places(18, 99));
        assert_ne!(some, places(17, 98));
        assert_eq!(Sampling::ADAPTIVE.places(2, 1, 1, 0).len(), 16);
    }
}
