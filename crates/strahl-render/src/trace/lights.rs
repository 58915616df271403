//! The contribution of lights to a hit: the second step of the loop.

use super::together::KnownLights;
use super::{Branch, TreeTracer};
use crate::activity::Phase;
use crate::hit::Hit;
use crate::layers;
use crate::observer::{LightTerm, RayKind, TraceObserver};
use crate::shadow::{Shadow, ShadowRay};
use crate::surface::Surface;
use strahl_math::{DVec3, Ray};
use strahl_shade::{Color, Light, LightSample, ShadingModel};

impl TreeTracer<'_> {
    /// The contribution of one light; no shadow ray if the surface faces away.
    #[inline(always)]
    #[expect(
        clippy::too_many_arguments,
        reason = "inlined into its only caller; what belongs together is together already"
    )]
    pub(super) fn light<O: TraceObserver>(
        &mut self,
        surface: &Surface<'_>,
        hit: &Hit,
        model: ShadingModel,
        light: usize,
        known: KnownLights,
        branch: &Branch,
        node: u32,
        observer: &mut O,
    ) -> LightTerm {
        let scene_light = &self.tracer.scene.lights[light].light;
        let mut term = LightTerm {
            light: light as u32,
            n_dot_l: 0.0,
            shadow_ray: None,
            shadow_rays: 0,
            visible: Color::BLACK,
            color: Color::BLACK,
            diffuse: Color::BLACK,
            specular: Color::BLACK,
        };
        let (sample, stopped) = match self.samples.known(light, known) {
            Some((sample, stopped)) => (*sample, Some(stopped)),
            None => {
                let point = surface.resolved.point.position;
                let sample = scene_light.illuminate(point);
                match sample.or_else(|| scene_light.aim(point)) {
                    Some(sample) => (sample, None),
                    None => return term,
                }
            }
        };
        term.n_dot_l = surface.n_shade.dot(sample.l);
        term.color = sample.color;
        // Points of an area light with `area_illumination` may be above the horizon where its centre is not.
        if !self.faces(surface, sample.l, term.n_dot_l)
            && scene_light.area.is_none_or(|a| !a.illumination)
        {
            return term;
        }
        if !surface.shows_lights {
            return term;
        }
        term.visible = Color::WHITE;
        let masked = self.tracer.scene.mask(light).is_some();
        if let Some(stopped) = stopped
            && (stopped || !self.tracer.scene.transmits)
        {
            self.count_shadow(
                &mut term,
                if stopped {
                    Shadow::STOPPED
                } else {
                    Shadow::NONE
                },
            );
        } else if (scene_light.casts_shadows || masked) && !sample.range.is_empty() {
            let (origin_point, origin) = surface.start(hit, sample.shadow_direction);
            let ray = Ray::new(origin_point, sample.shadow_direction);
            if O::DETAILED {
                term.shadow_ray = Some(ray);
            }
            self.tracer.slot.shadow(light);
            if let Some(area) = &scene_light.area {
                // Copies: what is passed by reference stays in memory, and only the rare area lights need that.
                let (sample, mut seen) = (sample, term);
                self.area_light(
                    area, &sample, surface, hit, model, light, branch, node, &mut seen, observer,
                );
                term = seen;
                if area.illumination {
                    self.back_to_shading(branch.kind, hit);
                    return term;
                }
            } else {
                let shadow_ray = ShadowRay {
                    ray,
                    range: sample.range,
                    from: origin,
                    light,
                    media: branch.media,
                };
                let (media, hits) = (&mut self.media, &mut self.shadow_hits);
                let shadow = match stopped {
                    None => self.tracer.shadow(&shadow_ray, media, hits),
                    Some(_) => self.tracer.filtered(&shadow_ray, media, hits),
                };
                self.count_shadow(&mut term, shadow);
            }
            self.back_to_shading(branch.kind, hit);
        }
        if let Some(fog) = self.fog_before(scene_light, &sample, surface, branch) {
            term.visible *= fog;
        }
        if !term.visible.is_black() {
            let arriving = sample.color * term.visible;
            (term.diffuse, term.specular) = self.reflected(
                surface,
                scene_light,
                model,
                arriving,
                sample.l,
                term.n_dot_l,
            );
        }
        term
    }

    /// What fog leaves of a light that it weakens on its way to a hit.
    #[inline]
    pub(super) fn fog_before(
        &self,
        light: &Light,
        sample: &LightSample,
        surface: &Surface<'_>,
        branch: &Branch,
    ) -> Option<Color> {
        let scene = self.tracer.scene;
        if !light.fogged || scene.fogs.is_empty() || !self.media.in_air(branch.media) {
            return None;
        }
        let ray = Ray::new(surface.resolved.point.position, sample.l);
        let length = if sample.range.max.is_infinite() {
            f64::INFINITY
        } else {
            sample.shadow_direction.length()
        };
        Some(scene.fog_along(&ray, length).0)
    }

    /// The shadow rays of a hit are traced.
    #[inline(always)]
    fn back_to_shading(&self, kind: RayKind, hit: &Hit) {
        self.tracer.slot.ray(kind);
        self.tracer.slot.enter_for(Phase::Shading, hit.id);
    }

    /// Takes what a shadow ray brought.
    #[inline]
    fn count_shadow(&mut self, term: &mut LightTerm, shadow: Shadow) {
        self.counts.shadow += 1;
        self.counts.shadow_hit += u64::from(shadow.hit);
        term.shadow_rays = 1;
        term.visible = shadow.visible;
    }

    /// Whether light from the unit direction `l` reaches the front of the current surface.
    #[inline]
    pub(crate) fn faces(&self, surface: &Surface<'_>, l: DVec3, n_dot_l: f64) -> bool {
        if surface.lit.both_sides {
            true
        } else if self.paint.layers.is_empty() {
            n_dot_l > 0.0
        } else {
            layers::faces(&self.paint, l)
        }
    }

    /// The light that the current surface reflects if light arrives from the unit direction `l`: the diffuse part and the
    /// highlight.
    #[inline]
    pub(crate) fn reflected(
        &self,
        surface: &Surface<'_>,
        light: &Light,
        model: ShadingModel,
        arriving: Color,
        l: DVec3,
        n_dot_l: f64,
    ) -> (Color, Color) {
        let (diffuse, highlight) = if self.paint.layers.is_empty() {
            surface.reflected(model, arriving, l, n_dot_l)
        } else {
            layers::lit(
                &self.paint,
                surface,
                l,
                arriving,
                self.settings.force_shading,
            )
        };
        let highlight = if light.highlights {
            highlight
        } else {
            Color::BLACK
        };
        (diffuse, highlight)
    }
}
