//! Paths of rays outside of trees, surface by surface.

use super::TreeTracer;
use super::point::Point;
use crate::branch::Branch;
use crate::hit::RayClass;
use crate::layers;
use crate::resolve::Uv;
use crate::transport::{PathRay, SurfaceSample};
use strahl_math::{DVec3, Interval, Ray};

impl<'s> TreeTracer<'s> {
    /// Begins a path outside of all trees.
    pub(crate) fn begin_path(&mut self, ray: &Ray) -> PathRay {
        self.has_met = false;
        PathRay {
            ray: *ray,
            origin: None,
            media: self.eye_media(ray.origin),
        }
    }

    /// The surface that a ray of a path meets first.
    pub(crate) fn surface_on(&mut self, path: &PathRay) -> Option<SurfaceSample> {
        let PathRay { ray, origin, media } = path;
        let (range, class) = (Interval::FORWARD, RayClass::Secondary);
        self.has_met = false;
        let hit = self
            .intersector
            .closest_hit(ray, range, origin.as_ref(), class)?;
        let mut point = self
            .met
            .take()
            .unwrap_or_else(|| Box::new(Point::unknown(&self.blank)));
        let (scene, speed) = (self.intersector.scene, ray.direction.length());
        let per_speed = speed.recip();
        point.branch = Branch {
            origin: *origin,
            ..Branch::primary(ray, 0, *media)
        };
        (point.hit, point.length) = (hit, hit.t * speed);
        let Point {
            branch,
            surface,
            paint,
            ..
        } = &mut *point;
        surface.find(scene, branch, &hit, Uv::IfTextured);
        surface.find_sides(scene, branch, per_speed, &hit, &self.media);
        surface.find_start(&hit);
        layers::paint(scene, surface, &hit, paint, &mut self.paints);
        let sample = self.sample_of(&point);
        (self.met, self.has_met) = (Some(point), true);
        Some(sample)
    }

    /// Goes on with a path from the surface that its last ray has met.
    pub(crate) fn leave_surface(&mut self, direction: DVec3) -> Option<PathRay> {
        let Point {
            branch,
            surface,
            hit,
            ..
        } = &**self.met.as_ref().filter(|_| self.has_met)?;
        let (start, origin) = surface.start(hit, direction);
        let media = if surface.n_geom.dot(direction) < 0.0 {
            surface.media_behind(branch.media, &mut self.media)
        } else {
            branch.media
        };
        Some(PathRay {
            ray: Ray::new(start, direction),
            origin: Some(origin),
            media,
        })
    }
}
