//! The heights of a terrain: sums over octaves of noise.

use super::number::{Number, Range, Ranged, Rectangle, Sloped, Viewpoint, join, product, sum};
use super::{TerrainDetail, TerrainKind, TerrainOptions};
use strahl_math::det;
use strahl_math::noise::NoiseGenerator;

/// Heights are known up to this part of the largest sum they are made of: about two thousand roundings.
const ROUNDING: f64 = 1.0 / (1_u64 << 42) as f64;

/// A height for every point of the plane.
#[derive(Clone, Debug)]
pub(super) struct Relief {
    kind: TerrainKind,
    offset: f64,
    gain: f64,
    generator: NoiseGenerator,
    /// The number of octaves, in part for the last one.
    octaves: f64,
    /// The frequency and the amplitude of each octave.
    scales: Box<[(f64, f64)]>,
    detail: Option<Detail>,
    /// A bound of the rounding error of a height.
    pub(super) noise: f64,
}

/// How the number of octaves grows towards a viewpoint: `full - per_log ln(distance)`.
#[derive(Clone, Copy, Debug)]
struct Detail {
    viewpoint: Viewpoint,
    full: f64,
    per_log: f64,
}

/// How many octaves there are at a place.
#[derive(Clone, Copy)]
enum Count<N> {
    Fixed(f64),
    Varying(N),
}

impl<N: Number> Count<N> {
    /// A term times the share of octave number `n`; `None` from the first octave on that has none.
    #[inline(always)]
    fn share(self, n: usize, term: impl FnOnce() -> N) -> Option<N> {
        // The octaves are few, so the number is exact.
        let before = n as f64;
        match self {
            Self::Fixed(count) => {
                let share = (count - before).share().smooth();
                if share <= 0.0 {
                    None
                } else if share >= 1.0 {
                    Some(term())
                } else {
                    Some(term().scaled(share))
                }
            }
            Self::Varying(count) => {
                let share = count.plus(N::constant(-before)).share();
                if share.is_nothing() {
                    None
                } else {
                    Some(term().times(share.smooth()))
                }
            }
        }
    }
}

impl Relief {
    /// The options have been checked.
    pub(super) fn new(options: &TerrainOptions) -> Self {
        let (mut frequency, mut scales) = (1.0, vec![]);
        let mut octave = 0.0;
        while octave < options.octaves {
            let amplitude = if octave == 0.0 {
                1.0
            } else {
                det::pow(frequency, -options.h)
            };
            scales.push((frequency, amplitude));
            frequency *= options.lacunarity;
            octave += 1.0;
        }
        let mut relief = Self {
            kind: options.kind,
            offset: options.offset,
            gain: options.gain,
            generator: options.generator,
            octaves: options.octaves,
            scales: scales.into(),
            detail: None,
            noise: 0.0,
        };
        relief.noise = ROUNDING * relief.largest();
        if let Some(detail) = options.detail {
            relief.detail = Some(relief.detail(options, detail));
        }
        relief
    }

    fn detail(&self, options: &TerrainOptions, detail: TerrainDetail) -> Detail {
        let TerrainDetail { viewpoint, angle } = detail;
        let above = viewpoint.y - self.height([viewpoint.x, viewpoint.z]);
        let above = if above > 0.0 { above } else { 0.0 };
        // One octave more wherever the distance shrinks by the lacunarity; the first one has wavelength 1.
        let per_log = 1.0 / det::ln(options.lacunarity);
        let full = 1.0 - per_log * det::ln(angle);
        // Where all octaves are there.
        let least = det::exp((full - options.octaves) / per_log);
        Detail {
            viewpoint: Viewpoint {
                x: viewpoint.x,
                z: viewpoint.z,
                least2: least * least,
                height2: above * above,
            },
            full,
            per_log,
        }
    }

    /// A bound of the magnitude of every sum on the way to a height.
    fn largest(&self) -> f64 {
        let term = 1.0 + self.offset.abs();
        let mut total = 0.0;
        for (n, &(_, amplitude)) in self.scales.iter().enumerate() {
            total += match self.kind {
                TerrainKind::Fbm if n > 0 => amplitude,
                TerrainKind::Fbm => term,
                TerrainKind::Hetero if n > 0 => term * amplitude * total,
                TerrainKind::Hetero => term,
                TerrainKind::Ridged => term * term * amplitude,
            };
        }
        total
    }

    /// How many octaves there are at most in a rectangle, and the frequency of the last one.
    pub(super) fn finest(&self, rectangle: Rectangle) -> f64 {
        let count = match self.count::<Ranged>(rectangle) {
            Count::Fixed(count) => count,
            Count::Varying(count) => count.value.1,
        };
        let whole = count.ceil().clamp(1.0, self.scales.len() as f64) as usize;
        self.scales.get(whole - 1).map_or(1.0, |scale| scale.0)
    }

    #[inline(always)]
    fn count<N: Number>(&self, place: N::Place) -> Count<N> {
        match &self.detail {
            None => Count::Fixed(self.octaves),
            Some(detail) => {
                let log = N::log_distance(place, &detail.viewpoint);
                Count::Varying(log.scaled(-detail.per_log).plus(N::constant(detail.full)))
            }
        }
    }

    /// The height at a place.
    #[inline(always)]
    fn evaluate<N: Number>(&self, place: N::Place) -> N {
        let count = self.count::<N>(place);
        let offset = N::constant(self.offset);
        let noise = |frequency| N::noise(place, frequency, self.generator);
        match self.kind {
            TerrainKind::Fbm => {
                let mut height = noise(1.0).plus(offset);
                for (n, &(frequency, amplitude)) in self.scales.iter().enumerate().skip(1) {
                    let Some(term) = count.share(n, || noise(frequency).scaled(amplitude)) else {
                        break;
                    };
                    height = height.plus(term);
                }
                height
            }
            TerrainKind::Hetero => {
                let mut height = noise(1.0).plus(offset);
                for (n, &(frequency, amplitude)) in self.scales.iter().enumerate().skip(1) {
                    let increment = || noise(frequency).plus(offset).scaled(amplitude);
                    let Some(term) = count.share(n, increment) else {
                        break;
                    };
                    height = height.plus(term.times(height));
                }
                height
            }
            TerrainKind::Ridged => {
                let ridge = |frequency| noise(frequency).abs().scaled(-1.0).plus(offset).square();
                let mut signal = ridge(1.0);
                let mut height = signal;
                for (n, &(frequency, amplitude)) in self.scales.iter().enumerate().skip(1) {
                    let weight = signal.scaled(self.gain).share();
                    let mut raw = signal;
                    let term = count.share(n, || {
                        raw = ridge(frequency).times(weight);
                        raw.scaled(amplitude)
                    });
                    let Some(term) = term else { break };
                    signal = raw;
                    height = height.plus(term);
                }
                height
            }
        }
    }

    /// Which smooth piece of the surface a place is on: ridges have creases where the noise of an octave is zero, so there is a bit for the
    /// sign of each of the first 32 octaves.
    pub(super) fn piece(&self, place: [f64; 2]) -> u32 {
        if self.kind != TerrainKind::Ridged {
            return 0;
        }
        let negative = |frequency| f64::noise(place, frequency, self.generator) < 0.0;
        let bits = self.scales.iter().take(32).enumerate();
        bits.fold(0, |bits, (n, scale)| {
            bits | u32::from(negative(scale.0)) << n
        })
    }

    /// The height at `[x, z]`.
    pub(super) fn height(&self, place: [f64; 2]) -> f64 {
        self.evaluate::<f64>(place)
    }

    /// The height and its slopes along x and z; on creases, which ridges have, those on one side.
    pub(super) fn sloped(&self, place: [f64; 2]) -> Sloped {
        self.evaluate::<Sloped>(place)
    }

    /// Ranges of the height and of its slopes over a rectangle.
    pub(super) fn ranged(&self, rectangle: Rectangle) -> Ranged {
        let mut found = self.evaluate::<Ranged>(rectangle);
        found.value = (found.value.0 - self.noise, found.value.1 + self.noise);
        found
    }

    /// The range of the height over a rectangle, closed in by its slopes.
    pub(super) fn range(&self, rectangle: Rectangle) -> Range {
        let found = self.ranged(rectangle);
        let [(x0, x1), (z0, z1)] = rectangle;
        let middle = self.height([0.5 * (x0 + x1), 0.5 * (z0 + z1)]);
        let half = |(a, b): Range| (0.5 * (a - b), 0.5 * (b - a));
        let rise = sum(
            product(found.slopes[0], half(rectangle[0])),
            product(found.slopes[1], half(rectangle[1])),
        );
        let pad = 2.0 * self.noise + 1e-15 * join(rise, (0.0, 0.0)).1;
        let mean = (middle + rise.0 - pad, middle + rise.1 + pad);
        let (low, high) = found.value;
        (
            if mean.0 > low { mean.0 } else { low },
            if mean.1 < high { mean.1 } else { high },
        )
    }
}
