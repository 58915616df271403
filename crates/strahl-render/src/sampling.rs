//! Where the rays of a pixel go through it.

mod division;
mod pattern;
mod quadrants;
mod refinement;
mod sample;

pub(crate) use division::{Division, shares};
pub(crate) use quadrants::Quadrants;
pub use refinement::Refinement;
pub(crate) use refinement::{Compared, Slopes};
pub(crate) use sample::Sample;

use std::{fmt, str::FromStr};

/// Where the rays of a pixel go through it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Sampling {
    /// One ray through the centre: no antialiasing.
    #[default]
    Center,
    /// Rays through the corners of the pixels, shared by neighbours; a pixel is the mean of its four corners. What the
    /// Standard Procedural Databases ask for.
    Corners,
    /// n x n rays, one in each cell of a grid, at places that depend on pixel, cell and seed only; `n >= 1`.
    Grid(u32),
    /// One ray through the centre of each pixel. Where two neighbours (left and right, above and below) differ by more than the
    /// threshold, both pixels get so many more rays that their error is that of `depth` x `depth` rays: 3, 6 and 12 for depths of 2, 3 and 4,
    /// else `depth` x `depth`. Those towards neighbours that look alike are left out, and the first sample stands for them. POV-Ray's first method.
    Adaptive(Refinement),
    /// Rays through the corners of the pixels. A pixel whose corners differ by more than the threshold is divided into four, and so
    /// on: `depth - 1` times at most. POV-Ray's second method.
    Recursive(Refinement),
}

impl Sampling {
    /// Most cells on a side of the grid.
    pub const MAX_GRID: u32 = 64;
    /// The adaptive sampling one gets by its bare name: POV-Ray's `+A0.3 +R3`.
    pub const ADAPTIVE: Self = Self::Adaptive(Refinement::DEFAULT);

    /// The place in every pixel in pass `pass`, if there is one only.
    pub(crate) fn common_place(self, pass: u32) -> Option<(f64, f64)> {
        match (self, pass) {
            (Self::Corners | Self::Recursive(_), 0) => Some((0.0, 0.0)),
            (Self::Center | Self::Grid(0 | 1) | Self::Adaptive(_), 0) => Some((0.5, 0.5)),
            _ => None,
        }
    }

    /// The places in pixel `(x, y)` of pass `pass`, in pixels from its top left corner. `Corners` and `Recursive` have a lattice
    /// instead.
    pub(crate) fn places(
        self,
        pass: u32,
        x: u32,
        y: u32,
        seed: u64,
    ) -> impl ExactSizeIterator<Item = (f64, f64)> {
        match (self, pass) {
            (Self::Grid(n), _) => pattern::grid(n.max(1), x, y, seed),
            (Self::Adaptive(refinement), 1) => pattern::around_center(refinement.depth, x, y, seed),
            _ => pattern::grid(1, x, y, seed),
        }
    }
}

/// The text names no way of sampling.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "unknown sampling `{0}`; there are: center (or none), corners, NxN (such as 3x3, at most 64x64), adaptive, \
     adaptive:THRESHOLD,DEPTH and recursive:THRESHOLD,DEPTH (such as adaptive:0.3,3; thresholds 0 to 3, depths 1 to 9)"
)]
pub struct UnknownSampling(String);

impl FromStr for Sampling {
    type Err = UnknownSampling;

    fn from_str(s: &str) -> Result<Self, Self::Err> {
        let unknown = || UnknownSampling(s.to_owned());
        let (name, numbers) = s.split_once(':').unwrap_or((s, ""));
        let refinement = || match s.contains(':') {
            true => numbers.parse::<Refinement>().map_err(|_| unknown()),
            false => Ok(Refinement::DEFAULT),
        };
        match name {
            "adaptive" => return refinement().map(Self::Adaptive),
            "recursive" => return refinement().map(Self::Recursive),
            _ => {}
        }
        match s {
            "center" | "none" => return Ok(Self::Center),
            "corners" => return Ok(Self::Corners),
            _ => {}
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
            Self::Adaptive(refinement) => write!(f, "adaptive:{refinement}"),
            Self::Recursive(refinement) => write!(f, "recursive:{refinement}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_go_there_and_back() {
        for text in [
            "center",
            "corners",
            "3x3",
            "adaptive:0.1,2",
            "recursive:0.3,4",
            "adaptive:0,9,1.8",
        ] {
            assert_eq!(
                text.parse::<Sampling>().map(|s| s.to_string()),
                Ok(text.to_owned())
            );
        }
        assert_eq!("none".parse(), Ok(Sampling::Center));
        assert_eq!("adaptive".parse(), Ok(Sampling::ADAPTIVE));
        assert_eq!(
            "recursive:0.3".parse(),
            Ok(Sampling::Recursive(Refinement::DEFAULT))
        );
        for text in [
            "",
            "3x4",
            "0x0",
            "65x65",
            "x",
            "adaptive:",
            "adaptive:4,1",
            "adaptive:-1",
            "adaptive:nan",
            "adaptive:0.1,10",
            "adaptive:0.1,0",
            "adaptive:0.1,2,0",
            "adaptive:0.1,2,2,2",
            "center:1",
            "nine",
        ] {
            assert!(text.parse::<Sampling>().is_err(), "{text}");
        }
    }
}
