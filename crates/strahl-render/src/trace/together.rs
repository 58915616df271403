//! Phases: the primary rays of neighbouring pixels are followed together, then their shadow rays, light by light. What comes of each is
//! what it would be alone, to the last bit.

use super::{Branch, TreeTracer};
use crate::hit::RayClass;
use crate::surface::Surface;
use arrayvec::ArrayVec;
use strahl_accel::PACKET;
use strahl_math::{Interval, Ray};
use strahl_shade::Color;

/// What is known of a hit before its tree grows.
pub(super) struct Ahead<'s> {
    pub(super) surface: Surface<'s>,
    pub(super) lights: KnownLights,
}

/// Which shadow rays of a hit have been followed, and what they met: a bit for each light.
#[derive(Clone, Copy, Default)]
pub(super) struct KnownLights {
    followed: u32,
    /// Something opaque is in front of them.
    stopped: u32,
}

impl KnownLights {
    /// Whether a light is stopped, if that is known.
    #[inline]
    pub(super) fn stopped(self, light: usize) -> Option<bool> {
        let bit = 1u32.checked_shl(light as u32)?;
        (self.followed & bit != 0).then_some(self.stopped & bit != 0)
    }
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
                    lights: KnownLights::default(),
                });
            }
        }
        for light in 0..scene.lights.len().min(u32::BITS as usize) {
            self.shadows_together(light, &mut all);
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
    fn shadows_together(&mut self, number: usize, ahead: &mut [Ahead<'s>]) {
        let scene = self.tracer.scene;
        let light = &scene.lights[number].light;
        if !light.casts_shadows || light.area.is_some() || scene.mask(number).is_some() {
            return;
        }
        let mut rays = ArrayVec::<Ray, PACKET>::new();
        let (mut from, mut places) = ([None; PACKET], [0; PACKET]);
        let (mut min, mut t_max) = (0.0, [f64::NEG_INFINITY; PACKET]);
        for (place, Ahead { surface, .. }) in ahead.iter().enumerate() {
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
        }
        if rays.len() < FEW {
            return;
        }
        let stopped = self.tracer.all_occluded(&rays, min, t_max, &from, number);
        for (lane, place) in places[..rays.len()].iter().enumerate() {
            let lights = &mut ahead[*place].lights;
            lights.followed |= 1 << number;
            lights.stopped |= (stopped >> lane & 1) << number;
        }
    }
}
