//! The stage of gathered light, and the media along rays: where methods of light transport are asked.

use super::branch::Offshoot;
use super::point::{Lanes, Point};
use super::{Branch, TreeTracer};
use crate::hit::RayClass;
use crate::layers;
use crate::observer::{GatherTerm, RayKind, Share, TraceObserver};
use crate::resolve::Uv;
use crate::transport::{
    Gathered, MediumPath, MediumRay, MediumTerm, PathRay, Probe, SurfaceSample, Transport,
};
use strahl_math::{DVec3, Interval, Ray};
use strahl_shade::{Color, LightSample};

impl<'s> TreeTracer<'s> {
    /// The same with methods of light transport that are asked besides.
    #[must_use]
    pub fn with_transport(mut self, transport: &Transport) -> Self {
        self.transport = transport.clone();
        if transport.medium.is_some() {
            self.beyond = None;
        }
        self
    }

    /// Asks about rays and lights.
    pub(crate) const fn probe(&mut self) -> Probe<'_, 's> {
        Probe {
            tracer: &mut self.tracer,
            media: &mut self.media,
            hits: &mut self.shadow_hits,
        }
    }

    /// Adds the light that a method gathers at surfaces, and queues the rays that it sends.
    #[cold]
    pub(super) fn gather<O: TraceObserver>(
        &mut self,
        points: &[Point<'s>],
        lanes: &Lanes,
        observer: &mut O,
    ) {
        let Some(gather) = self.transport.gather.clone() else {
            return;
        };
        let samples: Vec<SurfaceSample> = lanes
            .iter()
            .map(|lane| self.sample_of(&points[*lane]))
            .collect();
        let mut gathered = vec![Gathered::default(); samples.len()];
        gather.gather(&samples, &mut self.probe(), &mut gathered);
        for (lane, gathered) in lanes.iter().zip(&gathered) {
            let point = &points[*lane];
            let node = point.node as usize;
            if self.gathered.len() <= node {
                self.gathered.resize(node + 1, Color::BLACK);
            }
            self.gathered[node] = gathered.radiance;
            if O::DETAILED {
                observer.gathered(
                    point.node,
                    GatherTerm {
                        method: gather.name().to_owned(),
                        radiance: gathered.radiance,
                        rays: gathered.rays.len() as u32,
                    },
                );
            }
            for ray in gathered.rays.iter().rev() {
                let share = Share {
                    factor: ray.share,
                    power: 1.0,
                };
                let part = point.branch.part;
                let offshoot = Offshoot::new(RayKind::Gather, share, ray.direction, part);
                self.queue(point, &offshoot, observer);
            }
        }
    }

    /// A hit as methods of light transport see it.
    fn sample_of(&mut self, point: &Point<'s>) -> SurfaceSample {
        let split = self.split(point);
        let Point {
            branch,
            hit,
            surface,
            ..
        } = point;
        SurfaceSample {
            ray: branch.ray,
            hit: *hit,
            position: surface.resolved.point.position,
            n_geom: surface.n_geom,
            n_shade: surface.n_shade,
            material: surface.resolved.look.material,
            diffuse: surface.material.finish.diffuse,
            reflection: split.kr,
            transmission: split.kt * split.fade,
            mirrored: split.reflected,
            transmitted: split.refracted,
            depth: branch.depth,
            weight: branch.weight,
        }
    }

    /// Begins a path outside of all trees.
    pub(crate) fn begin_path(&mut self, ray: &Ray) -> PathRay {
        self.met = None;
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
        let hit = self
            .tracer
            .closest_hit(ray, range, origin.as_ref(), class)?;
        let mut point = self
            .met
            .take()
            .unwrap_or_else(|| Box::new(Point::unknown(&self.blank)));
        let (scene, speed) = (self.tracer.scene, ray.direction.length());
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
        surface.find_sides(scene, branch, speed, &hit, &self.media);
        surface.find_start(&hit);
        layers::paint(scene, surface, &hit, paint, &mut self.paints);
        let sample = self.sample_of(&point);
        self.met = Some(point);
        Some(sample)
    }

    /// Goes on with a path from the surface that its last ray has met.
    pub(crate) fn leave_surface(&mut self, direction: DVec3) -> Option<PathRay> {
        let Point {
            branch,
            surface,
            hit,
            ..
        } = &**self.met.as_ref()?;
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
