//! Densities measured at the points of a grid in the unit cube: POV-Ray's `density_file`.

use std::fmt;

use strahl_math::DVec3;

/// How values between the points of a grid are found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum DensityInterpolation {
    /// The value of the cell that the point lies in.
    #[default]
    Nearest,
    /// Linear between the eight corners around the point.
    Trilinear,
    /// Catmull-Rom curves through the 64 corners around the point; negative values become 0.
    Tricubic,
}

impl DensityInterpolation {
    /// POV-Ray's numbers: 0, 1 and 2.
    pub const fn from_number(number: u32) -> Option<Self> {
        match number {
            0 => Some(Self::Nearest),
            1 => Some(Self::Trilinear),
            2 => Some(Self::Tricubic),
            _ => None,
        }
    }
}

/// The values of a [`DensityGrid`]; the largest code is the density 1. `x` changes fastest, then `y`.
#[derive(Clone, PartialEq, Eq)]
pub enum DensityCodes {
    /// 0 to 255.
    U8(Vec<u8>),
    /// 0 to 65535.
    U16(Vec<u16>),
    /// 0 to 2³² - 1.
    U32(Vec<u32>),
}

impl DensityCodes {
    /// The number of values.
    pub fn len(&self) -> usize {
        match self {
            Self::U8(codes) => codes.len(),
            Self::U16(codes) => codes.len(),
            Self::U32(codes) => codes.len(),
        }
    }

    /// Whether there is no value.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The density with this number, from 0 to 1; 0 if there is none.
    #[inline]
    fn density(&self, index: usize) -> f64 {
        match self {
            Self::U8(codes) => codes.get(index).map_or(0.0, |c| f64::from(*c) / 255.0),
            Self::U16(codes) => codes.get(index).map_or(0.0, |c| f64::from(*c) / 65535.0),
            Self::U32(codes) => codes
                .get(index)
                .map_or(0.0, |c| f64::from(*c) / f64::from(u32::MAX)),
        }
    }
}

impl fmt::Debug for DensityCodes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} codes", self.len())
    }
}

/// Densities from 0 to 1 at the points of a grid that fills the unit cube, from the origin to `<1, 1, 1>`; the density outside of it is 0.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DensityGrid {
    size: [usize; 3],
    codes: DensityCodes,
}

impl DensityGrid {
    /// A grid of `size[0]` by `size[1]` by `size[2]` values; `None` if there are not as many. A grid without values has the density 0.
    pub fn try_new(size: [u16; 3], codes: DensityCodes) -> Option<Self> {
        let size = size.map(usize::from);
        (size.iter().product::<usize>() == codes.len()).then_some(Self { size, codes })
    }

    /// The number of values along x, y and z.
    pub fn size(&self) -> [usize; 3] {
        self.size
    }

    /// The density at a point, from 0 to 1.
    ///
    /// The value number `i` of `n` along an axis lies at `i / n`, so it is the lower end of its cell, and the value behind the last one is
    /// the first one again. The value before the first one, which cubic curves need, is the last one along x and the first one along
    /// y and z. All of this is as in POV-Ray 3.7 (measured).
    pub fn density(&self, p: DVec3, interpolation: DensityInterpolation) -> f64 {
        // Also refuses what is not a number.
        if !p.to_array().iter().all(|x| (0.0..1.0).contains(x)) || self.codes.is_empty() {
            return 0.0;
        }
        let [nx, ny, nz] = self.size;
        let place = |x: f64, n: usize| {
            let scaled = x * n as f64;
            // The product of a number below 1 may be rounded up.
            let index = (scaled as usize).min(n - 1);
            (index, scaled - index as f64)
        };
        let [(i, u), (j, v), (k, w)] = [place(p.x, nx), place(p.y, ny), place(p.z, nz)];
        match interpolation {
            DensityInterpolation::Nearest => self.at([i, j, k]),
            DensityInterpolation::Trilinear => {
                let next = [(i + 1) % nx, (j + 1) % ny, (k + 1) % nz];
                let row = |j, k| mix(self.at([i, j, k]), self.at([next[0], j, k]), u);
                let layer = |k| mix(row(j, k), row(next[1], k), v);
                mix(layer(k), layer(next[2]), w)
            }
            DensityInterpolation::Tricubic => {
                let around = |i: usize, n: usize| [i.max(1) - 1, i, (i + 1) % n, (i + 2) % n];
                let [mut xs, ys, zs] = [around(i, nx), around(j, ny), around(k, nz)];
                if i == 0 {
                    xs[0] = nx - 1;
                }
                let row = |j, k| cubic(xs.map(|i| self.at([i, j, k])), u);
                let layer = |k| cubic(ys.map(|j| row(j, k)), v);
                cubic(zs.map(layer), w).clamp(0.0, 1.0)
            }
        }
    }

    #[inline]
    fn at(&self, [i, j, k]: [usize; 3]) -> f64 {
        let [nx, ny, _] = self.size;
        self.codes.density((k * ny + j) * nx + i)
    }
}

fn mix(a: f64, b: f64, share: f64) -> f64 {
    a + (b - a) * share
}

/// The curve of E. Catmull and R. Rom ("A class of local interpolating splines", 1974) through the two values in the middle, at `t` from 0 to 1.
fn cubic([a, b, c, d]: [f64; 4], t: f64) -> f64 {
    let (first, second) = (c - a, 2.0 * a - 5.0 * b + 4.0 * c - d);
    let third = 3.0 * (b - c) + d - a;
    b + 0.5 * t * (first + t * (second + t * third))
}
