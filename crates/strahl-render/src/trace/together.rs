//! Phases: the primary rays of neighbouring pixels are followed together, then their shadow rays, light by light. What comes of each is
//! what it would be alone, to the last bit.

use super::{Branch, TreeTracer};
use crate::hit::{Hit, Origin, RayClass};
use crate::surface::Surface;
use arrayvec::ArrayVec;
use strahl_accel::PACKET;
use strahl_math::{Interval, Ray};
use strahl_shade::Color;

/// What is known of a hit before its tree grows.
pub(super) struct Ahead<'s> {
    pub(super) surface: Surface<'s>,
    pub(super) shadows: KnownShadows,
}

/// Which shadow rays of a hit have been followed, and what they met.
#[derive(Clone, Copy)]
pub(super) struct KnownShadows {
    /// A bit for each light whose ray was followed.
    followed: u32,
    /// A bit for each that something opaque is in front of.
    stopped: u32,
}

impl KnownShadows {
    /// No shadow rays.
    pub(super) const NONE: Self = Self {
        followed: 0,
        stopped: 0,
    };

    /// Whether a light is stopped, if that is known.
    #[inline]
    pub(super) fn of(self, light: usize) -> Option<bool> {
        let bit = 1u32.checked_shl(light as u32)?;
        (self.followed & bit != 0).then_some(self.stopped & bit != 0)
    }
}

/// Shadow rays to one light.
#[derive(Default)]
struct Bundle<'a> {
    rays: ArrayVec<Ray, PACKET>,
    starts: ArrayVec<Origin, PACKET>,
    hits: ArrayVec<&'a mut KnownShadows, PACKET>,
    t_max: ArrayVec<f64, PACKET>,
}

/// Fewer rays go one by one.
const FEW: usize = 3;

impl<'s> TreeTracer<'s> {
    /// Follows primary rays, at most [`PACKET`], with everything that comes of them: the colours they bring. It pays if they are close
    /// to each other.
    pub(crate) fn trace_together(&mut self, rays: &[Ray]) -> ArrayVec<Color, PACKET> {
        let range = Interval::FORWARD;
        let hits = self
            .tracer
            .closest_hits(rays, range, &[None; PACKET], RayClass::Camera);
        let mut ahead: [Option<Ahead<'s>>; PACKET] = [const { None }; PACKET];
        for ((ahead, hit), ray) in ahead.iter_mut().zip(&hits).zip(rays) {
            *ahead = hit.as_ref().and_then(|hit| self.ahead(ray, hit));
        }
        for light in 0..self.tracer.scene.lights.len().min(u32::BITS as usize) {
            self.shadows_together(light, &hits, &mut ahead);
        }
        let each = rays.iter().zip(hits).zip(&mut ahead);
        each.map(|((ray, hit), ahead)| self.grow(ray, hit, ahead.as_mut(), &mut ()).color)
            .collect()
    }

    /// The surface at a hit, if its shadow rays can be told before it is painted.
    fn ahead(&self, ray: &Ray, hit: &Hit) -> Option<Ahead<'s>> {
        let scene = self.tracer.scene;
        let surface = Surface::at(scene, &Branch::primary(ray), hit, &self.media, self.uv);
        let material = &scene.materials[surface.resolved.look.material.0 as usize];
        let plain = material.texture_seen(surface.entering).is_none()
            && !self.model_of(&surface).is_diagnostic()
            && scene.lights_in(surface.lit.set).is_none();
        plain.then_some(Ahead {
            surface,
            shadows: KnownShadows::NONE,
        })
    }

    /// Follows the shadow rays of several hits to one light.
    fn shadows_together(
        &mut self,
        number: usize,
        hits: &[Option<Hit>; PACKET],
        ahead: &mut [Option<Ahead<'s>>; PACKET],
    ) {
        let scene = self.tracer.scene;
        let light = &scene.lights[number].light;
        if !light.casts_shadows || light.area.is_some() || scene.mask(number).is_some() {
            return;
        }
        let mut bundle = Bundle::default();
        let mut min = 0.0;
        for (ahead, hit) in ahead.iter_mut().zip(hits) {
            let (Some(Ahead { surface, shadows }), Some(hit)) = (ahead, hit) else {
                continue;
            };
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
            bundle.t_max.push(sample.range.max);
            bundle.hits.push(shadows);
        }
        let count = bundle.rays.len();
        if count < FEW {
            return;
        }
        let t_max = std::array::from_fn(|lane| {
            bundle.t_max.get(lane).copied().unwrap_or(f64::NEG_INFINITY)
        });
        let from = std::array::from_fn(|lane| bundle.starts.get(lane));
        let stopped = self
            .tracer
            .all_occluded(&bundle.rays, min, t_max, &from, number);
        for (lane, shadows) in bundle.hits.iter_mut().enumerate() {
            shadows.followed |= 1 << number;
            shadows.stopped |= (stopped >> lane & 1) << number;
        }
    }
}
