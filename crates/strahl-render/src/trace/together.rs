//! Phases: the primary rays of neighbouring pixels are followed together, then their shadow rays, light by light. What comes of each is
//! what it would be alone, to the last bit.

use super::{Branch, TreeTracer};
use crate::hit::{Hit, Origin, RayClass};
use crate::surface::Surface;
use arrayvec::ArrayVec;
use strahl_accel::PACKET;
use strahl_math::{Interval, Ray};
use strahl_shade::{Color, LightSample};

/// What is known of a hit before its tree grows.
pub(super) struct Ahead<'s> {
    pub(super) surface: Surface<'s>,
    pub(super) lights: KnownLights,
}

/// The first lights of a scene, of which shadow rays are followed together.
const KNOWN: usize = 4;

/// What arrives at a hit of each of the first lights, and whether something opaque is in front of it, if that is known.
pub(super) struct KnownLights([Option<(LightSample, bool)>; KNOWN]);

impl KnownLights {
    const NONE: Self = Self([None; KNOWN]);

    /// What is known of a light.
    #[inline]
    pub(super) fn of(&self, light: usize) -> Option<&(LightSample, bool)> {
        self.0.get(light)?.as_ref()
    }
}

/// Shadow rays to one light.
#[derive(Default)]
struct Bundle<'a> {
    rays: ArrayVec<Ray, PACKET>,
    starts: ArrayVec<Origin, PACKET>,
    samples: ArrayVec<LightSample, PACKET>,
    hits: ArrayVec<&'a mut Option<(LightSample, bool)>, PACKET>,
}

/// Fewer rays go one by one.
const FEW: usize = 3;

impl<'s> TreeTracer<'s> {
    /// Follows primary rays, at most [`PACKET`], with everything that comes of them: the colours they bring. It pays if they are close
    /// to each other.
    pub(crate) fn trace_together(&mut self, rays: &[Ray]) -> ArrayVec<Color, PACKET> {
        let range = Interval::FORWARD;
        let mut hits = [None; PACKET];
        self.tracer
            .closest_hits(rays, range, &[None; PACKET], RayClass::Camera, &mut hits);
        let mut all = ArrayVec::<Ahead<'s>, PACKET>::new();
        let scene = self.tracer.scene;
        for (ray, hit) in rays.iter().zip(&hits) {
            if let Some(hit) = hit {
                all.push(Ahead {
                    surface: Surface::at(scene, &Branch::primary(ray), hit, &self.media, self.uv),
                    lights: KnownLights::NONE,
                });
            }
        }
        for light in 0..scene.lights.len().min(KNOWN) {
            self.shadows_together(light, &hits, &mut all);
        }
        let mut ahead = all.iter_mut();
        let mut colors = ArrayVec::new();
        for (ray, hit) in rays.iter().zip(hits) {
            let ahead = if hit.is_some() { ahead.next() } else { None };
            colors.push(self.grow(ray, hit, ahead, &mut ()).color);
        }
        colors
    }

    /// Whether the shadow rays of a surface can be told before it is painted.
    fn is_plain(&self, surface: &Surface<'s>) -> bool {
        let scene = self.tracer.scene;
        let material = &scene.materials[surface.resolved.look.material.0 as usize];
        material.texture_seen(surface.entering).is_none()
            && !self.model_of(surface).is_diagnostic()
            && scene.lights_in(surface.lit.set).is_none()
    }

    /// Follows the shadow rays of several hits to one light.
    fn shadows_together(
        &mut self,
        number: usize,
        hits: &[Option<Hit>; PACKET],
        ahead: &mut [Ahead<'s>],
    ) {
        let scene = self.tracer.scene;
        let light = &scene.lights[number].light;
        if !light.casts_shadows || light.area.is_some() || scene.mask(number).is_some() {
            return;
        }
        let mut bundle = Bundle::default();
        let (mut min, mut t_max) = (0.0, [f64::NEG_INFINITY; PACKET]);
        for (Ahead { surface, lights }, hit) in ahead.iter_mut().zip(hits.iter().flatten()) {
            if !self.is_plain(surface) {
                continue;
            }
            let Some(sample) = light.illuminate(surface.resolved.point.position) else {
                continue;
            };
            let faces = surface.lit.both_sides || surface.n_shade.dot(sample.l) > 0.0;
            if !faces || sample.range.is_empty() {
                continue;
            }
            if bundle.rays.is_empty() {
                min = sample.range.min;
            } else if sample.range.min != min {
                continue;
            }
            let (point, origin) = surface.start(hit, sample.shadow_direction);
            bundle.rays.push(Ray::new(point, sample.shadow_direction));
            bundle.starts.push(origin);
            bundle.hits.push(&mut lights.0[number]);
            t_max[bundle.rays.len() - 1] = sample.range.max;
            bundle.samples.push(sample);
        }
        if bundle.rays.len() < FEW {
            return;
        }
        let mut from = [None; PACKET];
        for (from, origin) in from.iter_mut().zip(&bundle.starts) {
            *from = Some(origin);
        }
        let stopped = self
            .tracer
            .all_occluded(&bundle.rays, min, t_max, &from, number);
        let each = bundle.hits.into_iter().zip(bundle.samples);
        for (lane, (known, sample)) in each.enumerate() {
            *known = Some((sample, stopped >> lane & 1 == 1));
        }
    }
}
