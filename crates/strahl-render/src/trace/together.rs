//! Packets: the primary rays of neighbouring pixels are traced together, then their shadow rays, light by light. The results
//! are the same to the last bit as those of single rays.

use super::{Branch, TreeTracer};
use crate::activity::Phase;
use crate::hit::RayClass;
use crate::media::MediaStack;
use crate::observer::RayKind;
use crate::surface::Surface;
use arrayvec::ArrayVec;
use strahl_accel::PACKET;
use strahl_math::{Interval, Ray};
use strahl_shade::{Color, LightSample};

/// A hit of a packet, before its tree grows.
#[derive(Debug)]
pub(super) struct Ahead<'s> {
    pub(super) surface: Surface<'s>,
    pub(super) lights: KnownLights,
    /// Whether its shadow rays can be traced before its texture is evaluated.
    plain: bool,
}

impl Ahead<'_> {
    /// A place for a hit.
    fn unknown() -> Self {
        Self {
            surface: Surface::unknown(),
            lights: KnownLights::default(),
            plain: false,
        }
    }
}

/// The shadow rays of a hit that were traced with the packet, and their results: a bit for each light.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct KnownLights {
    followed: u32,
    /// The lights that are blocked by something opaque.
    stopped: u32,
    /// The lane of the hit in [`Samples`].
    lane: u32,
}

/// The light sample of each light at the hits whose shadow rays were traced.
#[derive(Debug, Default)]
pub(super) struct Samples(Vec<[LightSample; PACKET]>);

impl Samples {
    fn put(&mut self, light: usize, lane: usize, sample: LightSample) {
        if self.0.len() <= light {
            self.0.resize(light + 1, [LightSample::NONE; PACKET]);
        }
        self.0[light][lane % PACKET] = sample;
    }

    /// The unobstructed sample of a light, and whether something opaque blocks it, if both are known.
    #[inline]
    pub(super) fn known(&self, light: usize, of: KnownLights) -> Option<(&LightSample, bool)> {
        let bit = 1u32.checked_shl(light as u32)?;
        if of.followed & bit == 0 {
            return None;
        }
        let sample = self.0.get(light)?.get(of.lane as usize)?;
        Some((sample, of.stopped & bit != 0))
    }
}

/// Fewer rays are traced one by one.
const FEW: usize = 3;

impl<'s> TreeTracer<'s> {
    /// Traces the trees of primary rays, at most [`PACKET`], and returns their radiances. It pays if the rays are close to each
    /// other.
    pub(crate) fn trace_together(&mut self, rays: &[Ray]) -> ArrayVec<Color, PACKET> {
        let (Some(first), scene) = (rays.first(), self.tracer.scene) else {
            return ArrayVec::new();
        };
        let eye = self.eye_media(first.origin);
        let as_first = |ray: &Ray| ray.origin == first.origin;
        if scene.fills
            && !rays.iter().all(as_first)
            && !rays
                .iter()
                .all(|ray| self.eye_media(ray.origin) == MediaStack::VACUUM)
        {
            // Each may start in other media.
            return rays
                .iter()
                .map(|ray| self.trace(ray, &mut ()).color)
                .collect();
        }
        let range = Interval::FORWARD;
        self.tracer.slot.ray(RayKind::Primary);
        let mut hits = [None; PACKET];
        self.tracer
            .closest_hits(rays, range, &[None; PACKET], RayClass::Camera, &mut hits);
        if !self.has_plain {
            let colors = rays
                .iter()
                .zip(hits)
                .map(|(ray, hit)| self.grow(ray, hit, None, &mut ()).color);
            return colors.collect();
        }
        let mut all = std::mem::take(&mut self.ahead);
        let mut used = 0;
        for (ray, hit) in rays.iter().zip(&hits) {
            if let Some(hit) = hit {
                self.tracer.slot.enter_for(Phase::Surface, hit.id);
                if used == all.len() {
                    all.push(Ahead::unknown());
                }
                let ahead = &mut all[used];
                let branch = Branch::primary(ray, eye);
                let speed = ray.direction.length();
                ahead
                    .surface
                    .find(scene, &branch, speed, hit, &self.media, self.uv);
                ahead.plain = self.is_plain(&ahead.surface);
                ahead.lights = KnownLights {
                    lane: used as u32,
                    ..KnownLights::default()
                };
                used += 1;
            }
        }
        for light in 0..scene.lights.len().min(u32::BITS as usize) {
            self.shadows_together(light, &mut all[..used]);
        }
        self.tracer.slot.ray(RayKind::Primary);
        let mut ahead = all[..used].iter_mut();
        let mut colors = ArrayVec::new();
        for (ray, hit) in rays.iter().zip(hits) {
            let ahead = if hit.is_some() { ahead.next() } else { None };
            colors.push(self.grow(ray, hit, ahead, &mut ()).color);
        }
        self.ahead = all;
        colors
    }

    /// Whether the shadow rays of a surface can be traced before its texture is evaluated.
    fn is_plain(&self, surface: &Surface<'s>) -> bool {
        let scene = self.tracer.scene;
        let material = &scene.materials[surface.resolved.look.material.0 as usize];
        material.texture_seen(surface.entering).is_none()
            && !self.model_of(surface).is_diagnostic()
            && scene.lights_in(surface.lit.set).is_none()
    }

    /// Traces the shadow rays of several hits to one light.
    fn shadows_together(&mut self, number: usize, ahead: &mut [Ahead<'s>]) {
        let scene = self.tracer.scene;
        let light = &scene.lights[number].light;
        if !light.casts_shadows || light.area.is_some() || scene.mask(number).is_some() {
            return;
        }
        let mut rays = ArrayVec::<Ray, PACKET>::new();
        let (mut from, mut places) = ([None; PACKET], [0; PACKET]);
        let (mut min, mut t_max) = (0.0, [f64::NEG_INFINITY; PACKET]);
        for (place, hit) in ahead.iter().enumerate().filter(|(_, a)| a.plain) {
            let surface = &hit.surface;
            let Some(sample) = light.illuminate(surface.resolved.point.position) else {
                continue;
            };
            let faces = surface.lit.both_sides || surface.n_shade.dot(sample.l) > 0.0;
            if !faces || sample.range.is_empty() {
                continue;
            }
            let lane = rays.len();
            if lane == 0 {
                min = sample.range.min;
            }
            let Some((point, origin)) = surface.start_in_front(sample.shadow_direction) else {
                continue;
            };
            if sample.range.min != min {
                continue;
            }
            rays.push(Ray::new(point, sample.shadow_direction));
            (from[lane], places[lane], t_max[lane]) = (Some(origin), place, sample.range.max);
            self.samples.put(number, place, sample);
        }
        if rays.len() < FEW {
            return;
        }
        self.tracer.slot.shadow(number);
        let stopped = self.tracer.all_occluded(&rays, min, t_max, &from, number);
        for (lane, place) in places[..rays.len()].iter().enumerate() {
            let lights = &mut ahead[*place].lights;
            lights.followed |= 1 << number;
            lights.stopped |= (stopped >> lane & 1) << number;
        }
    }
}
