//! The medium that a method of light transport integrates along rays.

use super::TreeTracer;
use super::point::Point;
use crate::branch::Branch;
use crate::observer::RayKind;
use crate::transport::{MediumPath, MediumRay, MediumTerm};
use strahl_math::Ray;
use strahl_shade::{Color, LightSample};

impl<'s> TreeTracer<'s> {
    /// What lies in front of a hit, a medium included: the attenuation, and the light that is added.
    #[cold]
    pub(super) fn medium_along(
        &mut self,
        branch: &Branch,
        length: f64,
        (keeps, adds): (Color, Color),
    ) -> (Color, Color) {
        let kind = match branch.kind {
            RayKind::Primary => MediumRay::Camera,
            _ => MediumRay::Secondary,
        };
        let path = MediumPath {
            ray: branch.ray,
            length,
            kind,
            inside: self.media.top(branch.media),
        };
        let term = self.integrated(&path);
        (keeps * term.transmittance, adds + term.radiance)
    }

    /// What a medium leaves of a light on its way to a hit.
    #[cold]
    pub(super) fn medium_before(&mut self, sample: &LightSample, point: &Point<'s>) -> Color {
        let length = if sample.range.max.is_infinite() {
            f64::INFINITY
        } else {
            sample.shadow_direction.length()
        };
        let path = MediumPath {
            ray: Ray::new(point.surface.resolved.point.position, sample.l),
            length,
            kind: MediumRay::Shadow,
            inside: self.media.top(point.branch.media),
        };
        self.integrated(&path).transmittance
    }

    /// What the medium does along a ray.
    fn integrated(&mut self, path: &MediumPath) -> MediumTerm {
        match self.transport.medium.clone() {
            Some(medium) => medium.along(path, &mut self.probe()),
            None => MediumTerm::NONE,
        }
    }
}
