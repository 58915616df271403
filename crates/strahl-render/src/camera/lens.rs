mod fours;
mod sobol;

use super::bundle::{NextRays, RayBundle};
use arrayvec::ArrayVec;
use fours::FourRays;
use sobol::sobol;
use std::sync::Arc;
use strahl_accel::PACKET;
use strahl_math::{DVec3, Ray, det};
use strahl_scene::{Bokeh, Camera, Projection};
use strahl_shade::Color;

/// The fewest rays that are traced when the mean is not exact enough: a packet of a few costs little more than one ray.
const RAYS_MIN: u32 = 4;

/// The number of rays that POV-Ray traces, divided by `sd * sqrt(most / variance)`, in the limit of many rays. Measured on planes
/// whose colours have the standard deviation `sd`; the numbers are in the test `as_many_rays_as_povray`.
const RAYS_PER_DEVIATION: f64 = 0.977;

/// The share of POV-Ray's rays that leave its error: samples of a sequence are spread better than its own. Measured on 17 pictures with
/// edges, textures and grass.
const SHARE: f64 = 0.75;

/// Focal blur: makes rays through a lens.
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
    /// The quantile of the normal distribution at `confidence`, in standard deviations.
    quantile: f64,
    /// The square root of `variance`.
    tolerance: f64,
    bokeh: Option<Arc<Bokeh>>,
    /// Whether the first [`WIDE`] samples are those of [`hexagon`].
    begins_wide: bool,
    /// How four rays are made at once, for the cameras of nearly all scenes.
    fours: Option<FourRays>,
}

impl LensSampler {
    /// The lens of a camera; `size` is the width and the height of the picture in pixels. `None` if the camera is sharp everywhere.
    pub(super) fn new(camera: &Camera, size: [f64; 2]) -> Option<Self> {
        let lens = camera.lens.as_ref()?;
        let forward = camera.direction.normalize_or_zero();
        let distance = (lens.focal_point - camera.eye).dot(forward);
        if !(lens.aperture > 0.0 && lens.max_samples > 0 && distance != 0.0) {
            return None;
        }
        let radius = 0.25 * lens.aperture;
        let mut lens = Self {
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
            begins_wide: lens.bokeh.is_none() && lens.min_samples.min(lens.max_samples) >= WIDE,
            fours: None,
        };
        lens.fours = FourRays::new(camera, &lens, size);
        Some(lens)
    }

    /// Appends the rays through the lens that come next. Each ray meets the plane of focus at the same point as the chief ray of a
    /// position up to half a pixel away along each axis: like POV-Ray's, the lens is never sharper than a pixel (measured: the
    /// means over pixels of objects in focus). `center` returns the camera's chief ray, if it sees something there; the length of
    /// its direction matters only to cameras with a sphere of focus, where it is 1. Where the camera sees nothing there is no ray.
    pub(super) fn more(
        &self,
        bundle: &RayBundle,
        center: impl Fn(f64, f64) -> Option<Ray>,
        rays: &mut NextRays,
    ) {
        let (x, y) = bundle.at;
        let wanted = self.wanted(bundle.sum, bundle.squares, bundle.count);
        if wanted == 0 {
            return;
        }
        let numbers = bundle.count..bundle.count + wanted;
        let samples: Samples = numbers.map(|n| self.sample(n, bundle.flips)).collect();
        let before = rays.len();
        let fours = self.fours.as_ref();
        if !fours.is_some_and(|fours| fours.push(&samples, [x, y], rays)) {
            rays.truncate(before);
            rays.extend(samples.iter().map(|s| self.ray(*s, (x, y), &center)));
        }
    }

    /// The number of rays to trace next, at most [`PACKET`]; 0 if there are enough, or as many as allowed.
    fn wanted(&self, sum: Color, squares: Color, count: u32) -> u32 {
        let (fewest, most) = self.samples;
        let more = if count < fewest.min(most) {
            fewest.min(most) - count
        } else {
            let povray = self.enough(sum, squares, count).min(f64::from(most));
            let missing = SHARE * povray - f64::from(count);
            if missing <= 0.0 {
                return 0;
            }
            (missing.min(PACKET as f64).ceil() as u32)
                .max(RAYS_MIN)
                .min(most.saturating_sub(count))
        };
        more.min(PACKET as u32)
    }

    /// The sample with this number, at a position that flips these bits.
    fn sample(&self, number: u32, flips: [u32; 4]) -> [f64; 4] {
        if !self.begins_wide {
            return sample(number, flips);
        }
        match number {
            0 => [0.0, 0.0, 0.5, 0.5],
            1..WIDE => hexagon(number, flips[0]),
            // The points that follow, and are well spread with each other, begin with a multiple of eight.
            _ => sample(number + 1, flips),
        }
    }

    /// The ray of a sample.
    #[inline(always)]
    fn ray(
        &self,
        [a, b, c, d]: [f64; 4],
        (x, y): (f64, f64),
        center: impl Fn(f64, f64) -> Option<Ray>,
    ) -> Option<Ray> {
        let point = match &self.bokeh {
            Some(bokeh) => bokeh.point(a, b),
            None => disc(a, b),
        };
        let chief = center(x + c - 0.5, y + d - 0.5);
        chief.map(|chief| self.through(&chief, point))
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

    /// The number of rays after which POV-Ray stops, if further rays vary as the `count` rays with this sum and this sum of squares
    /// do. Infinite for a single ray, whose variance is not known.
    ///
    /// POV-Ray's numbers (measured) are those of a chi-square test: n of at most m rays with standard deviation s are enough if
    /// n χ² ≥ m (0.977 s)² / `variance`, where χ² ≈ n - q sqrt(2 n) is the quantile of the chi-square distribution of n degrees of
    /// freedom, q the quantile of the normal distribution at `confidence`. The root of the left side is about n - q sqrt(n / 2).
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
        let most = f64::from(self.samples.1);
        let right = RAYS_PER_DEVIATION * (worst * most).sqrt() / self.tolerance;
        // Solves n - h sqrt(n) = right for sqrt(n).
        let h = std::f64::consts::FRAC_1_SQRT_2 * self.quantile;
        let root = 0.5 * (h + (h * h + 4.0 * right).sqrt());
        root * root
    }
}

/// The quantile of the normal distribution, in standard deviations: this fraction of the distribution lies below it. 0 for fractions
/// below a half (Abramowitz and Stegun, formula 26.2.23).
fn quantile(confidence: f64) -> f64 {
    let tail = 1.0 - confidence.clamp(0.5, 1.0 - 1e-9);
    let t = (-2.0 * det::ln(tail)).sqrt();
    let above = 2.515_517 + t * (0.802_853 + t * 0.010_328);
    let below = 1.0 + t * (1.432_788 + t * (0.189_269 + t * 0.001_308));
    let x = t - above / below;
    if x > 0.0 { x } else { 0.0 }
}

/// A point in the unit cube of four dimensions: that of the lens, as [`disc`] or a [`Bokeh`] maps it, and that of the pixel.
type Samples = ArrayVec<[f64; 4], PACKET>;

/// Point `index` of Sobol's sequence in the unit cube of four dimensions, with its bits flipped as `flips` says.
fn sample(index: u32, flips: [u32; 4]) -> [f64; 4] {
    let mut coordinates = [0.0; 4];
    for ((x, bits), flip) in coordinates.iter_mut().zip(sobol(index)).zip(flips) {
        *x = unit(bits ^ flip);
    }
    coordinates
}

/// A number in `0..1`, from one in units of 2^-32.
fn unit(bits: u32) -> f64 {
    f64::from(bits) / (1u64 << u32::BITS) as f64
}

/// The number of samples that lie far apart: one in the middle of pixel and lens, and six of a [`hexagon`].
const WIDE: u32 = 7;

/// A corner of a hexagon in the lens and, a quarter of a turn further, of one in the pixel; `turn` turns both, in units of 2^-32.
///
/// A pixel whose first rays all see the same takes no more, so these must find all that it sees a larger part of. An edge crosses a pixel
/// and its lens as a line crosses a disc. Behind a line that no corner lies beyond there is at most a twelfth of the lens, where seven
/// points of a sequence may miss twice as much. The quarter of a turn makes the hexagons equally wide in front of the focus and behind.
fn hexagon(corner: u32, turn: u32) -> [f64; 4] {
    // The squared radius on the lens, of which all samples have 1/2 in the mean, and the radius in the pixel.
    const ON_LENS: f64 = 0.7;
    const IN_PIXEL: f64 = 0.45;
    let angle = unit(turn) + f64::from(corner) * (1.0 / f64::from(WIDE - 1));
    let angle = angle - (angle as i64) as f64;
    let (sin, cos) = det::sin_cos(std::f64::consts::TAU * angle);
    [ON_LENS, angle, 0.5 - IN_PIXEL * sin, 0.5 + IN_PIXEL * cos]
}

/// Maps the unit square to the unit disc, uniformly.
fn disc(a: f64, b: f64) -> (f64, f64) {
    let radius = a.sqrt();
    let (sin, cos) = det::sin_cos(std::f64::consts::TAU * b);
    (radius * cos, radius * sin)
}

#[cfg(test)]
mod tests {
    use super::super::PrimaryRays;
    use super::*;
    use crate::sampling::Sample;
    use strahl_scene::Lens;

    fn blurred(max_samples: u32) -> LensSampler {
        let mut camera = Camera::perspective(DVec3::ZERO, DVec3::Z, DVec3::Y, 1.0);
        camera.lens = Some(Lens::new(2.0, DVec3::Z * 5.0, max_samples));
        let mut lens = LensSampler::new(&camera, [1.0, 1.0]).expect("a lens");
        // The tests have chief rays of their own.
        lens.fours = None;
        lens
    }

    /// The rays of a position, made one by one or four at once.
    fn rays_of(camera: &Camera, at: (f64, f64), together: bool) -> Vec<Option<Ray>> {
        let mut rays = PrimaryRays::new(camera, 64, 48);
        let lens = rays.lens.as_mut().expect("a lens");
        assert!(lens.fours.is_some());
        if !together {
            lens.fours = None;
        }
        let mut all = vec![];
        let mut bundle = rays.bundle(at.0, at.1);
        loop {
            let mut next = NextRays::new();
            rays.more(&mut bundle, &mut next);
            if next.is_empty() {
                return all;
            }
            all.extend_from_slice(&next);
            for ray in &next {
                let color = Color::gray((all.len() % 7) as f64);
                bundle.add(&Sample::from(color), ray.is_some());
            }
        }
    }

    /// The mean of the rays of a position, traced one by one.
    fn color(
        lens: &LensSampler,
        (x, y): (f64, f64),
        center: impl Fn(f64, f64) -> Option<Ray>,
        trace: impl FnMut(&Ray) -> Color,
    ) -> Color {
        let more = |bundle: &mut RayBundle, rays: &mut NextRays| lens.more(bundle, &center, rays);
        let bundle = RayBundle::new(x, y).traced(more, trace);
        bundle.mean().color
    }

    #[test]
    fn four_rays_at_once_have_the_bits_of_single_ones() {
        let eye = DVec3::new(50.0, 10.0, 30.0);
        let mut camera = Camera::perspective(eye, DVec3::new(0.0, 10.0, 0.0), DVec3::Y, 0.6);
        for focal_point in [DVec3::new(5.0, 10.0, 5.0), DVec3::new(90.0, 9.0, 60.0)] {
            for most in [1, 7, 120] {
                camera.lens = Some(Lens::new(10.0, focal_point, most));
                for n in 0..200 {
                    let at = (f64::from(n) * 0.31, f64::from(n) * 0.23 + 0.5);
                    assert_eq!(rays_of(&camera, at, true), rays_of(&camera, at, false));
                }
            }
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
        let alternate = |ray: &Ray| {
            assert!((ray.origin - DVec3::ZERO).length() <= 0.5 + 1e-12);
            let t = (5.0 - ray.origin.z) / ray.direction.z;
            assert!((ray.at(t) - meeting).length() < 1e-12);
            widest = widest.max(ray.origin.length());
            count += 1;
            Color::gray(f64::from(count % 2))
        };
        color(&lens, (0.5, 0.5), same, alternate);
        assert!(widest > 0.45 && count == 75, "{widest} {count}");
    }

    #[test]
    fn what_is_certain_takes_few_rays() {
        let ray = Ray::new(DVec3::ZERO, DVec3::Z);
        let mut count = 0;
        let gray = |_: &Ray| {
            count += 1;
            Color::gray(0.25)
        };
        let mean = color(&blurred(1000), (3.5, 2.5), |_, _| Some(ray), gray);
        assert_eq!((mean, count), (Color::gray(0.25), 7));
    }

    #[test]
    fn the_first_rays_lie_beyond_each_wide_edge() {
        let lens = blurred(100);
        for turn in [0, 1 << 29, 0x1234_5678, u32::MAX] {
            let samples: Vec<_> = (0..WIDE).map(|n| lens.sample(n, [turn; 4])).collect();
            for n in 0..360 {
                let (sin, cos) = f64::from(n).to_radians().sin_cos();
                let on_lens = samples.iter().map(|[a, b, ..]| disc(*a, *b));
                let widest = on_lens.map(|(x, y)| x * cos + y * sin).fold(0.0, f64::max);
                // A twelfth of the unit disc lies beyond 0.724 of its radius.
                assert!(widest > 0.724, "{widest}");
                let in_pixel = samples
                    .iter()
                    .map(|[.., c, d]| (c - 0.5) * cos + (d - 0.5) * sin);
                assert!(in_pixel.fold(0.0, f64::max) > 0.38);
            }
            assert!(samples.iter().flatten().all(|x| (0.0..1.0).contains(x)));
        }
    }

    #[test]
    fn rays_belong_to_all_of_a_pixel() {
        let mut lens = blurred(400);
        // Seven rays that all hit the same side would already end the sampling.
        lens.samples.0 = 400;
        let at = |x: f64, _| Some(Ray::new(DVec3::X * x, DVec3::Z));
        // An edge in focus through the pixel; the object is to its right.
        for edge in [3.2, 3.5, 3.9] {
            let right_of_edge = |ray: &Ray| {
                let x = ray.at((5.0 - ray.origin.z) / ray.direction.z).x;
                Color::gray(f64::from(x > edge))
            };
            let mean = color(&lens, (3.5, 2.5), at, right_of_edge);
            assert!((mean.r - (4.0 - edge)).abs() < 0.01, "{edge}: {mean:?}");
        }
        let blind = color(&lens, (3.5, 2.5), |_, _| None, |_| Color::WHITE);
        assert_eq!(blind, Color::BLACK);
    }

    #[test]
    fn as_many_rays_as_povray() {
        // Standard deviation, variance, confidence, most rays, rays that POV-Ray 3.7 traced for each pixel of a plane with a random
        // colour at each point (`cells`), or with a gradient.
        let measured = [
            (0.288_675, 1.0 / 1250.0, 0.95, 3000, 574.1),
            (0.288_675, 1.0 / 312.0, 0.95, 3000, 293.4),
            (0.288_675, 1.0 / 312.0, 0.50, 3000, 279.6),
            (0.288_675, 1.0 / 312.0, 0.99, 3000, 299.3),
            (0.288_675, 1.0 / 78.0, 0.95, 3000, 151.9),
            (0.288_675, 1.0 / 20.0, 0.95, 3000, 80.8),
            (0.072_169, 1.0 / 78.0, 0.95, 3000, 43.0),
            (0.072_169, 1.0 / 20.0, 0.95, 3000, 24.2),
            (0.1, 1.0 / 20_000.0, 0.95, 3000, 789.0),
            (0.1, 1.0 / 5000.0, 0.95, 3000, 401.5),
            (0.05, 1.0 / 5000.0, 0.95, 3000, 205.0),
            (0.05, 1.0 / 5000.0, 0.95, 400, 76.5),
            (0.05, 1.0 / 10_000.0, 0.9, 400, 104.7),
            (0.1, 1.0 / 128.0, 0.9, 400, 27.6),
        ];
        for (deviation, variance, confidence, most, rays) in measured {
            let mut lens = blurred(most);
            (lens.tolerance, lens.quantile) = (f64::sqrt(variance), quantile(confidence));
            let n = 1000.0;
            let (mean, squares) = (0.5, 0.25 * n + deviation * deviation * (n - 1.0));
            let enough = lens.enough(Color::gray(mean * n), Color::gray(squares), 1000);
            assert!(
                (enough / rays - 1.0).abs() < 0.09,
                "{enough} instead of {rays}"
            );
        }
        // A single ray tells nothing of the variance, and what does not vary needs no more rays.
        let lens = blurred(100);
        assert_eq!(lens.enough(Color::WHITE, Color::WHITE, 1), f64::INFINITY);
        assert_eq!(lens.enough(Color::WHITE * 4.0, Color::WHITE * 4.0, 4), 0.0);
    }

    #[test]
    fn quantiles_are_those_of_the_tables() {
        for (confidence, expected) in [(0.9, 1.2816), (0.95, 1.6449), (0.99, 2.3263)] {
            assert!((quantile(confidence) - expected).abs() < 5e-4);
        }
        assert!(quantile(1.0).is_finite() && quantile(0.0).abs() < 1e-3);
    }
}
