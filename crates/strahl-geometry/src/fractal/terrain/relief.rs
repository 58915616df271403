//! The heights of a terrain: sums over octaves of noise.

use super::number::{AT_ONCE, Affine, Number, Range, Ranged, Rectangle, Sloped, Viewpoint};
use super::{TerrainDetail, TerrainKind, TerrainOptions};
use strahl_math::det;
use strahl_math::noise::NoiseGenerator;
use strahl_simd::{Isa, Simd, dispatch};

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
    /// The frequency of each octave.
    frequencies: Box<[f64]>,
    /// The amplitude of each octave.
    amplitudes: Box<[f64]>,
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

/// How much of an octave there is.
#[derive(Clone, Copy)]
enum Share<N> {
    Nothing,
    Whole,
    Part(f64),
    Varying(N),
}

impl<N: Number> Count<N> {
    /// The share of octave number `n`.
    #[inline(always)]
    fn share<I: Isa>(self, isa: I, n: usize) -> Share<N> {
        // The octaves are few, so the number is exact.
        let before = n as f64;
        match self {
            Self::Fixed(count) => {
                let share = (count - before).share(isa).smooth(isa);
                if share <= 0.0 {
                    Share::Nothing
                } else if share >= 1.0 {
                    Share::Whole
                } else {
                    Share::Part(share)
                }
            }
            Self::Varying(count) => {
                let share = count.plus(isa, N::constant(-before)).share(isa);
                if share.is_nothing() {
                    Share::Nothing
                } else {
                    Share::Varying(share.smooth(isa))
                }
            }
        }
    }
}

impl<N: Number> Share<N> {
    #[inline(always)]
    fn of<I: Isa>(self, isa: I, term: N) -> N {
        match self {
            Self::Nothing => N::constant(0.0),
            Self::Whole => term,
            Self::Part(share) => term.scaled(isa, share),
            Self::Varying(share) => term.times(isa, share),
        }
    }
}

impl Relief {
    /// The options have been checked.
    pub(super) fn new(options: &TerrainOptions) -> Self {
        let (mut frequency, mut frequencies, mut amplitudes) = (1.0, vec![], vec![]);
        let mut octave = 0.0;
        while octave < options.octaves {
            let amplitude = if octave == 0.0 {
                1.0
            } else {
                det::pow(frequency, -options.h)
            };
            frequencies.push(frequency);
            amplitudes.push(amplitude);
            frequency *= options.lacunarity;
            octave += 1.0;
        }
        let mut relief = Self {
            kind: options.kind,
            offset: options.offset,
            gain: options.gain,
            generator: options.generator,
            octaves: options.octaves,
            frequencies: frequencies.into(),
            amplitudes: amplitudes.into(),
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
        for (n, &amplitude) in self.amplitudes.iter().enumerate() {
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
        let count = dispatch!(Simd::best(), isa => self.count::<Ranged, _>(isa, rectangle));
        self.frequencies[self.octaves_of(count) - 1]
    }

    /// How many octaves there are at most.
    #[inline(always)]
    fn octaves_of<N: Number>(&self, count: Count<N>) -> usize {
        let count = match count {
            Count::Fixed(count) => count,
            Count::Varying(count) => count.most(),
        };
        count.ceil().clamp(1.0, self.amplitudes.len() as f64) as usize
    }

    #[inline(always)]
    fn count<N: Number, I: Isa>(&self, isa: I, place: N::Place) -> Count<N> {
        match &self.detail {
            None => Count::Fixed(self.octaves),
            Some(detail) => {
                let log = N::log_distance(place, &detail.viewpoint);
                Count::Varying(
                    log.scaled(isa, -detail.per_log)
                        .plus(isa, N::constant(detail.full)),
                )
            }
        }
    }

    /// The height at a place.
    fn evaluate<N: Number>(&self, place: N::Place) -> N {
        dispatch!(Simd::best(), isa => self.evaluate_with(isa, place))
    }

    #[inline(always)]
    fn evaluate_with<N: Number, I: Isa>(&self, isa: I, place: N::Place) -> N {
        let count = self.count::<N, I>(isa, place);
        let octaves = self.octaves_of(count);
        let offset = N::constant(self.offset);
        let mut noises = [offset; AT_ONCE];
        let (mut height, mut signal) = (offset, offset);
        for n in 0..octaves {
            let share = if n == 0 {
                Share::Whole
            } else {
                count.share(isa, n)
            };
            if matches!(share, Share::Nothing) {
                break;
            }
            if n % AT_ONCE == 0 {
                let some = &self.frequencies[n..octaves.min(n + AT_ONCE)];
                N::noises(isa, place, some, self.generator, &mut noises);
            }
            let (noise, amplitude) = (noises[n % AT_ONCE], self.amplitudes[n]);
            height = match self.kind {
                TerrainKind::Fbm | TerrainKind::Hetero if n == 0 => noise.plus(isa, offset),
                TerrainKind::Fbm => {
                    let term = share.of(isa, noise.scaled(isa, amplitude));
                    height.plus(isa, term)
                }
                TerrainKind::Hetero => {
                    let increment = noise.plus(isa, offset).scaled(isa, amplitude);
                    height.plus(isa, share.of(isa, increment).times(isa, height))
                }
                TerrainKind::Ridged => {
                    let crest = noise.abs(isa).scaled(isa, -1.0).plus(isa, offset);
                    let ridge = crest.square(isa);
                    if n == 0 {
                        signal = ridge;
                        ridge
                    } else {
                        let weight = signal.scaled(isa, self.gain).share(isa);
                        signal = ridge.times(isa, weight);
                        height.plus(isa, share.of(isa, signal.scaled(isa, amplitude)))
                    }
                }
            };
        }
        height
    }

    /// Which smooth piece of the surface a place is on: ridges have creases where the noise of an octave is zero, so there is a bit for the
    /// sign of each of the first 32 octaves.
    pub(super) fn piece(&self, place: [f64; 2]) -> u32 {
        if self.kind != TerrainKind::Ridged {
            return 0;
        }
        let mut bits = 0;
        let signs = self.frequencies.len().min(32);
        for (n, some) in self.frequencies[..signs].chunks(AT_ONCE).enumerate() {
            let mut noises = [0.0; AT_ONCE];
            dispatch!(Simd::best(), isa => {
                f64::noises(isa, place, some, self.generator, &mut noises);
            });
            for (k, noise) in noises.iter().enumerate().take(some.len()) {
                bits |= u32::from(*noise < 0.0) << (AT_ONCE * n + k);
            }
        }
        bits
    }

    /// The height at `[x, z]`.
    pub(super) fn height(&self, place: [f64; 2]) -> f64 {
        self.evaluate::<f64>(place)
    }

    /// The height and its slopes along x and z; on creases, which ridges have, those on one side.
    pub(super) fn sloped(&self, place: [f64; 2]) -> Sloped {
        self.evaluate::<Sloped>(place)
    }

    /// Ranges of the height and of its slopes over a rectangle, and how it is nearly linear.
    pub(super) fn bounds(&self, rectangle: Rectangle) -> (Ranged, Affine) {
        let (mut found, linear) = self.evaluate::<(Ranged, Affine)>(rectangle);
        found.value = (found.value.0 - self.noise, found.value.1 + self.noise);
        (found, linear)
    }

    /// The range of the height over a rectangle.
    pub(super) fn range(&self, rectangle: Rectangle) -> Range {
        let (low, high) = self.evaluate::<Affine>(rectangle).range();
        (low - self.noise, high + self.noise)
    }
}
