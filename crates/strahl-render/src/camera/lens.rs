use arrayvec::ArrayVec;
use std::sync::Arc;
use strahl_accel::PACKET;
use strahl_math::{DVec3, Ray, det};
use strahl_scene::{Bokeh, Camera, Projection};
use strahl_shade::Color;

/// The fewest rays that are traced when the mean is not exact enough.
const FEW: u32 = 4;

/// A factor of the number of rays, as measured with POV-Ray (docs/src/notes/speed.md).
const RATE: f64 = 0.977;

/// Focal blur: traces rays through a lens.
#[derive(Clone, Debug)]
pub(super) struct LensSampler {
    /// Half the width and height of the lens.
    side: DVec3,
    above: DVec3,
    forward: DVec3,
    eye: DVec3,
    /// Distance from the eye to the plane of focus, or to the sphere of focus for cameras with more than 180 degrees.
    distance: f64,
    flat: bool,
    samples: (u32, u32),
    /// The one-sided quantile of the confidence, in standard deviations, and the square root of the variance allowed.
    quantile: f64,
    tolerance: f64,
    bokeh: Option<Arc<Bokeh>>,
}

impl LensSampler {
    /// `None` if the camera is sharp everywhere.
    pub(super) fn new(camera: &Camera) -> Option<Self> {
        let lens = camera.lens.as_ref()?;
        let forward = camera.direction.normalize_or_zero();
        let distance = (lens.focal_point - camera.eye).dot(forward);
        if !(lens.aperture > 0.0 && lens.max_samples > 0 && distance != 0.0) {
            return None;
        }
        let radius = 0.25 * lens.aperture;
        Some(Self {
            side: camera.right.normalize_or_zero() * radius,
            above: camera.up.normalize_or_zero() * radius,
            forward,
            eye: camera.eye,
            distance,
            flat: matches!(
                camera.projection,
                Projection::Perspective | Projection::Orthographic
            ),
            samples: (lens.min_samples.max(1), lens.max_samples),
            quantile: quantile(lens.confidence),
            tolerance: lens.variance.sqrt(),
            bokeh: lens.bokeh.clone(),
        })
    }

    /// The mean of the rays through the lens. Each ray meets the plane of focus at the same point as the chief ray of a
    /// position up to half a pixel away along each axis: like POV-Ray's, the lens is never sharper than a pixel (measured: the
    /// means over pixels of objects in focus). `center` returns the chief ray, if the camera sees something there; the length of
    /// its direction matters only to cameras with a sphere of focus, where it is 1. `trace` returns the colours of a few rays, at
    /// most [`PACKET`]; where the camera sees nothing there is no ray.
    pub(super) fn color(
        &self,
        (x, y): (f64, f64),
        center: impl Fn(f64, f64) -> Option<Ray>,
        mut trace: impl FnMut(&[Option<Ray>]) -> ArrayVec<Color, PACKET>,
    ) -> Color {
        let shift = scramble((x, y));
        let (mut sum, mut squares, mut count) = (Color::BLACK, Color::BLACK, 0u32);
        loop {
            let wanted = self.wanted(sum, squares, count);
            if wanted == 0 {
                break;
            }
            let mut rays = ArrayVec::<Option<Ray>, PACKET>::new();
            for index in count..count + wanted {
                let [a, b, c, d] = sample(index, shift);
                let point = match &self.bokeh {
                    Some(bokeh) => bokeh.point(a, b),
                    None => disc(a, b),
                };
                let chief = center(x + c - 0.5, y + d - 0.5);
                rays.push(chief.map(|chief| self.through(&chief, point)));
            }
            for color in trace(&rays) {
                sum += color;
                squares += color * color;
            }
            count += wanted;
        }
        sum / f64::from(count.max(1))
    }

    /// The number of rays to trace next, at most [`PACKET`]; 0 if the mean is exact enough or has all its rays.
    fn wanted(&self, sum: Color, squares: Color, count: u32) -> u32 {
        let (fewest, most) = self.samples;
        let more = if count < fewest.min(most) {
            fewest.min(most) - count
        } else {
            // A packet of a few costs little more than one ray.
            let missing = self.enough(sum, squares, count) - f64::from(count);
            if missing <= 0.0 {
                return 0;
            }
            (missing.min(PACKET as f64).ceil() as u32)
                .max(FEW)
                .min(most.saturating_sub(count))
        };
        more.min(PACKET as u32)
    }

    /// The ray through a point of the lens (coordinates from -1 to 1) that belongs to a chief ray.
    #[inline(always)]
    fn through(&self, center: &Ray, (x, y): (f64, f64)) -> Ray {
        let ahead = center.direction.dot(self.forward);
        let before = (center.origin - self.eye).dot(self.forward);
        let t = if self.flat && ahead != 0.0 {
            (self.distance - before) / ahead
        } else {
            self.distance.abs()
        };
        let origin = center.origin + self.side * x + self.above * y;
        let direction = (center.at(t) - origin).normalize_or(self.forward);
        // If the intersection with the plane of focus lies behind the camera, the ray points away from it.
        Ray::new(origin, if t < 0.0 { -direction } else { direction })
    }

    /// The number of rays after which POV-Ray stops if their colours vary as these do. Infinite for a single ray, whose variance is
    /// not known; 0 if there is none.
    ///
    /// As measured: n of at most m rays, of standard deviation s, are enough if n χ² ≥ m (0.977 s)² / `variance`, where χ² is the
    /// quantile of the chi-square distribution, about n - q sqrt(2 n).
    fn enough(&self, sum: Color, squares: Color, count: u32) -> f64 {
        if count < 2 {
            return f64::INFINITY;
        }
        let n = f64::from(count);
        let mean = sum / n;
        let variance = (squares - mean * mean * n) * (1.0 / (n - 1.0));
        let worst = variance.max_component();
        if !(worst > 0.0) {
            return 0.0;
        }
        // The root n of n - h sqrt(n) = ratio.
        let ratio = RATE * (worst * f64::from(self.samples.1)).sqrt() / self.tolerance;
        let h = std::f64::consts::FRAC_1_SQRT_2 * self.quantile;
        let root = 0.5 * (h + (h * h + 4.0 * ratio).sqrt());
        root * root
    }
}

/// The number of standard deviations above the mean of a normal distribution below which this fraction of it lies, for fractions
/// from a half on, below which it is zero (Abramowitz and Stegun, formula 26.2.23).
fn quantile(confidence: f64) -> f64 {
    let tail = 1.0 - confidence.clamp(0.5, 1.0 - 1e-9);
    let t = (-2.0 * det::ln(tail)).sqrt();
    let above = 2.515_517 + t * (0.802_853 + t * 0.010_328);
    let below = 1.0 + t * (1.432_788 + t * (0.189_269 + t * 0.001_308));
    let x = t - above / below;
    if x > 0.0 { x } else { 0.0 }
}

/// Four numbers in `0..1` that differ for every position in the picture (the mixer of SplitMix64).
fn scramble((x, y): (f64, f64)) -> [f64; 4] {
    let mix = |mut z: u64| {
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    };
    let first = mix(x.to_bits().wrapping_add(0x9e37_79b9_7f4a_7c15));
    let bits = mix(first ^ y.to_bits().rotate_left(32));
    let unit = |bits: u64| (bits >> 40) as f64 / (1u64 << 24) as f64;
    let more = mix(bits);
    [unit(bits), unit(bits << 24), unit(more), unit(more << 24)]
}

/// Point `index` of a low-discrepancy sequence in the unit cube of four dimensions (M. Roberts' sequence, 2018), shifted.
fn sample(index: u32, shift: [f64; 4]) -> [f64; 4] {
    // One over the root of x^5 = x + 1, and over its powers.
    const STEPS: [f64; 4] = [
        0.856_674_883_854_502_9,
        0.733_891_856_627_126,
        0.628_706_721_037_808_7,
        0.538_597_257_223_610_1,
    ];
    let n = f64::from(index);
    let mut point = shift;
    for (x, step) in point.iter_mut().zip(STEPS) {
        let y = *x + n * step;
        // Not below 0, where the cast rounds down.
        *x = y - (y as i64) as f64;
    }
    point
}

/// Maps the unit square to the unit disc, uniformly.
fn disc(a: f64, b: f64) -> (f64, f64) {
    let radius = a.sqrt();
    let (sin, cos) = det::sin_cos(std::f64::consts::TAU * b);
    (radius * cos, radius * sin)
}

#[cfg(test)]
mod tests {
    use super::*;
    use strahl_scene::Lens;

    fn blurred(max_samples: u32) -> LensSampler {
        let mut camera = Camera::perspective(DVec3::ZERO, DVec3::Z, DVec3::Y, 1.0);
        camera.lens = Some(Lens::new(2.0, DVec3::Z * 5.0, max_samples));
        LensSampler::new(&camera).expect("a lens")
    }

    /// Traces rays one by one.
    fn each(
        mut trace: impl FnMut(&Ray) -> Color,
    ) -> impl FnMut(&[Option<Ray>]) -> ArrayVec<Color, PACKET> {
        move |rays| {
            let colors = rays.iter();
            colors
                .map(|ray| ray.as_ref().map_or(Color::BLACK, &mut trace))
                .collect()
        }
    }

    #[test]
    fn rays_meet_in_the_plane_of_focus() {
        let lens = blurred(100);
        let center = Ray::new(DVec3::ZERO, DVec3::new(0.3, -0.2, 1.0).normalize());
        let meeting = DVec3::new(1.5, -1.0, 5.0);
        let mut widest: f64 = 0.0;
        let mut count = 0;
        let same = |_, _| Some(center);
        let alternate = each(|ray| {
            assert!((ray.origin - DVec3::ZERO).length() <= 0.5 + 1e-12);
            let t = (5.0 - ray.origin.z) / ray.direction.z;
            assert!((ray.at(t) - meeting).length() < 1e-12);
            widest = widest.max(ray.origin.length());
            count += 1;
            Color::gray(f64::from(count % 2))
        });
        lens.color((0.5, 0.5), same, alternate);
        assert!(widest > 0.45 && count == 100, "{widest} {count}");
    }

    #[test]
    fn what_is_certain_takes_few_rays() {
        let ray = Ray::new(DVec3::ZERO, DVec3::Z);
        let mut count = 0;
        let color = blurred(1000).color(
            (3.5, 2.5),
            |_, _| Some(ray),
            each(|_| {
                count += 1;
                Color::gray(0.25)
            }),
        );
        assert_eq!((color, count), (Color::gray(0.25), 7));
    }

    #[test]
    fn rays_belong_to_all_of_a_pixel() {
        let mut lens = blurred(400);
        // Seven rays that all hit the same side would already end the sampling.
        lens.samples.0 = 400;
        let at = |x: f64, _| Some(Ray::new(DVec3::X * x, DVec3::Z));
        // An edge in focus through the pixel; the object is to its right.
        for edge in [3.2, 3.5, 3.9] {
            let right_of_edge = each(|ray| {
                let x = ray.at((5.0 - ray.origin.z) / ray.direction.z).x;
                Color::gray(f64::from(x > edge))
            });
            let color = lens.color((3.5, 2.5), at, right_of_edge);
            assert!((color.r - (4.0 - edge)).abs() < 0.01, "{edge}: {color:?}");
        }
        let blind = lens.color((3.5, 2.5), |_, _| None, each(|_| Color::WHITE));
        assert_eq!(blind, Color::BLACK);
    }

    #[test]
    fn quantiles_are_those_of_the_tables() {
        for (confidence, expected) in [(0.9, 1.2816), (0.95, 1.6449), (0.99, 2.3263)] {
            assert!((quantile(confidence) - expected).abs() < 5e-4);
        }
        assert!(quantile(1.0).is_finite() && quantile(0.0).abs() < 1e-3);
    }
}
