mod fours;

use super::bundle::{NextRays, RayBundle};
use fours::FourRays;
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
        let shift = bundle.shift;
        let numbers = bundle.count..bundle.count + wanted;
        let made = self.fours.as_ref();
        let before = rays.len();
        if !made.is_some_and(|fours| fours.push(numbers.clone(), shift, [x, y], rays)) {
            rays.truncate(before);
            rays.extend(numbers.map(|index| self.ray(index, shift, (x, y), &center)));
        }
    }

    /// The number of rays to trace next, at most [`PACKET`]; 0 if there are enough, or as many as allowed.
    fn wanted(&self, sum: Color, squares: Color, count: u32) -> u32 {
        let (fewest, most) = self.samples;
        let more = if count < fewest.min(most) {
            fewest.min(most) - count
        } else {
            let missing = self.enough(sum, squares, count) - f64::from(count);
            if missing <= 0.0 {
                return 0;
            }
            (missing.min(PACKET as f64).ceil() as u32)
                .max(RAYS_MIN)
                .min(most.saturating_sub(count))
        };
        more.min(PACKET as u32)
    }

    /// The ray with this number.
    #[inline(always)]
    fn ray(
        &self,
        index: u32,
        shift: [f64; 4],
        (x, y): (f64, f64),
        center: impl Fn(f64, f64) -> Option<Ray>,
    ) -> Option<Ray> {
        let [a, b, c, d] = sample(index, shift);
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

/// One over the root of x^5 = x + 1, and over its powers.
const STEPS: [f64; 4] = [
    0.856_674_883_854_502_9,
    0.733_891_856_627_126,
    0.628_706_721_037_808_7,
    0.538_597_257_223_610_1,
];

/// Point `index` of a low-discrepancy sequence in the unit cube of four dimensions (M. Roberts' sequence, 2018), shifted.
fn sample(index: u32, shift: [f64; 4]) -> [f64; 4] {
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
        assert!(widest > 0.45 && count == 100, "{widest} {count}");
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
