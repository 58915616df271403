//! What shadow rays meet, for ray trees.

use super::ShadowRay;
use crate::hit::Hit;
use crate::media::MediaArena;
use crate::observer::{ShadowHit, ShadowReport};
use crate::query::Intersector;
use strahl_shade::Color;

impl Intersector<'_> {
    /// Follows a shadow ray as [`Intersector::shadow`] does, and tells what is in its way: the nearest thing that blocks it, or everything
    /// that weakens the light.
    #[cold]
    pub(crate) fn shadow_report(
        &mut self,
        shadow_ray: &ShadowRay<'_>,
        arena: &mut MediaArena,
        hits: &mut Vec<Hit>,
    ) -> ShadowReport {
        let ShadowRay { ray, from, .. } = shadow_ray;
        let shadow = self.shadow(shadow_ray, arena, hits);
        let mut report = ShadowReport {
            ray: **ray,
            met: Vec::new(),
            rest: Color::WHITE,
            visible: shadow.visible,
            beside_mask: false,
        };
        let mut range = shadow_ray.range;
        if let Some(mask) = self.scene.mask(shadow_ray.light) {
            match self.before_mask(mask, ray, range) {
                Some(masked) => range = masked,
                None => {
                    report.beside_mask = true;
                    return report;
                }
            }
        }
        if !self.scene.lights[shadow_ray.light].light.casts_shadows {
            return report;
        }
        let scene = self.scene;
        let met = |hit: &Hit, object, blocks, filter, absorbed| ShadowHit {
            t: hit.t,
            element: hit.id,
            object,
            line: scene.face_line(hit.id),
            blocks,
            filter,
            absorbed,
        };
        if let Some(hit) = self.closest_opaque(ray, range, Some(from)) {
            let object = scene.object_of(hit.id);
            let blocker = met(&hit, object, true, Color::BLACK, Color::WHITE);
            report.met.push(blocker);
            return report;
        }
        let shadow_ray = ShadowRay {
            range,
            ..*shadow_ray
        };
        self.filtered_by(&shadow_ray, arena, hits, |passed| match passed.surface {
            Some((hit, object)) => {
                let weakens = met(hit, object, false, passed.filter, passed.absorbed);
                report.met.push(weakens);
            }
            None => report.rest = passed.absorbed,
        });
        report
    }
}
