//! The factors of what a hit sends, for ray trees: what the loop multiplies, one by one. None of it runs without an observer.

use super::point::Point;
use super::{Aim, TreeTracer};
use crate::layers;
use crate::observer::{HitReport, LightDetail, LightTerm, Shading, SurfaceTerm};
use crate::surface::{Split, Surface};
use strahl_math::DVec3;
use strahl_shade::{Color, Light, LightSample, ShadingModel, reflect};

impl<'s> TreeTracer<'s> {
    /// All there is to tell of a hit.
    #[cold]
    pub(super) fn hit_report(&self, point: &Point<'s>, split: Split) -> HitReport {
        let (surface, paint) = (&point.surface, &point.paint);
        let shading = if paint.layers.is_empty() {
            Shading::Model(point.model)
        } else {
            Shading::Finish {
                layers: layers::report(paint, surface.v, surface.fresnel_eta()),
                model: self.settings.force_shading,
            }
        };
        surface.report(self.intersector.scene, &point.hit, split, shading)
    }

    /// What the term of a light is made of.
    #[cold]
    pub(super) fn light_detail(&mut self, point: &Point<'s>, term: &LightTerm) -> LightDetail {
        let Point { surface, .. } = point;
        let number = term.light as usize;
        let light = &self.intersector.scene.lights[number].light;
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
            let aim = Aim {
                point,
                direction: sample.shadow_direction,
                range: sample.range,
            };
            let shadow = self.shadow_report(&aim, number);
            detail.shadows.push(shadow);
        }
        if let Some(area) = light.area.as_ref().filter(|area| area.illumination) {
            detail.mean_of = Some(area.size_1 * area.size_2);
            return detail;
        }
        if let Some(air) = self.air_before(light, &sample, point) {
            detail.fog = air;
        }
        if !term.visible.is_black() {
            self.surface_terms(point, light, &sample, &mut detail);
        }
        detail
    }

    fn surface_terms(
        &self,
        point: &Point<'s>,
        light: &Light,
        sample: &LightSample,
        detail: &mut LightDetail,
    ) {
        let Point {
            surface,
            paint,
            model,
            ..
        } = point;
        let (l, arriving) = (sample.l, detail.arriving);
        if paint.layers.is_empty() {
            detail
                .terms
                .push(coefficients(surface, *model, l, arriving));
        }
        for layer in &paint.layers {
            let term = match self.settings.force_shading {
                None => layers::layer_term(layer, surface, l, arriving),
                Some(model) => layers::layer_term_by(model, layer, surface, l, arriving),
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
