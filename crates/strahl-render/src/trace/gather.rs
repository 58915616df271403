//! The stage of gathered light.

use super::TreeTracer;
use super::point::{Lanes, Point};
use crate::branch::Offshoot;
use crate::observer::{GatherTerm, RayKind, Share, TraceObserver};
use crate::transport::{Gathered, Probe, SurfaceSample, Transport};
use strahl_shade::Color;

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
            intersector: &mut self.intersector,
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
    pub(super) fn sample_of(&mut self, point: &Point<'s>) -> SurfaceSample {
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
            material: surface.resolved.appearance.material,
            diffuse: surface.material.finish.diffuse,
            reflection: split.kr,
            transmission: split.kt * split.fade,
            mirrored: split.reflected.filter(|_| !split.kr.is_black()),
            transmitted: split.refracted,
            depth: branch.depth,
            weight: branch.weight,
        }
    }
}
