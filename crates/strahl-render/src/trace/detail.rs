//! The factors of what a hit sends, for ray trees: what the loop multiplies, one by one. None of it runs without an observer.

use super::{Branch, TreeTracer};
use crate::hit::Hit;
use crate::layers;
use crate::observer::{HitReport, LightDetail, LightTerm, Shading, SurfaceTerm};
use crate::shadow::ShadowRay;
use crate::surface::{Split, Surface};
use strahl_math::{DVec3, Ray};
use strahl_shade::{Color, Light, LightSample, ShadingModel, reflect};

impl TreeTracer<'_> {
    /// All there is to tell of a hit.
    #[cold]
    pub(super) fn hit_report(
        &self,
        surface: &Surface<'_>,
        hit: &Hit,
        split: Split,
        model: ShadingModel,
    ) -> HitReport {
        let shading = if self.paint.layers.is_empty() {
            Shading::Model(model)
        } else {
            Shading::Finish {
                layers: layers::report(&self.paint, surface.v, surface.fresnel_eta()),
                model: self.settings.force_shading,
            }
        };
        surface.report(self.tracer.scene, hit, split, shading)
    }

    /// What the term of a light is made of.
    #[cold]
    pub(super) fn light_detail(
        &mut self,
        surface: &Surface<'_>,
        hit: &Hit,
        model: ShadingModel,
        branch: &Branch,
        term: &LightTerm,
    ) -> LightDetail {
        let number = term.light as usize;
        let light = &self.tracer.scene.lights[number].light;
        let mut detail = LightDetail {
            fog: Color::WHITE,
            highlights: light.highlights,
            ..LightDetail::default()
        };
        let Some(sample) = light.illuminate(surface.resolved.point.position) else {
            return detail;
        };
        detail.l = Some(sample.l);
        detail.arriving = sample.color * term.visible;
        if light.area.is_none() && term.shadow_ray.is_some() {
            let (origin, from) = surface.start(hit, sample.shadow_direction);
            let shadow_ray = ShadowRay {
                ray: Ray::new(origin, sample.shadow_direction),
                range: sample.range,
                from,
                light: number,
                media: branch.media,
            };
            let (media, hits) = (&mut self.media, &mut self.shadow_hits);
            let shadow = self.tracer.shadow_report(&shadow_ray, media, hits);
            detail.shadows.push(shadow);
        }
        if let Some(area) = light.area.as_ref().filter(|area| area.illumination) {
            detail.mean_of = Some(area.size_1 * area.size_2);
            return detail;
        }
        if let Some(fog) = self.fog_before(light, &sample, surface, branch) {
            detail.fog = fog;
        }
        if !term.visible.is_black() {
            self.surface_terms(surface, light, model, &sample, &mut detail);
        }
        detail
    }

    fn surface_terms(
        &self,
        surface: &Surface<'_>,
        light: &Light,
        model: ShadingModel,
        sample: &LightSample,
        detail: &mut LightDetail,
    ) {
        let (l, arriving) = (sample.l, detail.arriving);
        if self.paint.layers.is_empty() {
            detail.terms.push(coefficients(surface, model, l, arriving));
        }
        for layer in &self.paint.layers {
            let term = match self.settings.force_shading {
                None => layers::layer_term(&self.paint, layer, surface, l, arriving),
                Some(model) => {
                    layers::layer_term_by(&self.paint, model, layer, surface, l, arriving)
                }
            };
            detail.terms.push(term);
        }
        if !light.highlights {
            for term in &mut detail.terms {
                term.highlight = Color::BLACK;
            }
        }
    }
}

/// What coefficients and a shading model make of a light.
fn coefficients(
    surface: &Surface<'_>,
    model: ShadingModel,
    l: DVec3,
    arriving: Color,
) -> SurfaceTerm {
    let n_dot_l = surface.n_shade.dot(l);
    let (diffuse, highlight) = surface.reflected(model, arriving, l, n_dot_l);
    let finish = &surface.material.finish;
    let strength = model.highlight(surface.n_shade, l, surface.v, finish.shininess);
    let mut term = SurfaceTerm {
        n_dot_l,
        diffuse_factor: n_dot_l.abs(),
        tint: Color::WHITE,
        diffuse,
        highlight,
        ..SurfaceTerm::default()
    };
    if !finish.specular.is_black() {
        match model {
            ShadingModel::Phong => {
                term.r_dot_v = Some(reflect(surface.n_shade, l).dot(surface.v));
                term.phong = strength;
            }
            ShadingModel::BlinnPhong => {
                let h = (l + surface.v).normalize_or_zero();
                term.h_dot_n = Some(h.dot(surface.n_shade));
                term.specular = strength;
            }
            _ => {}
        }
    }
    term
}
