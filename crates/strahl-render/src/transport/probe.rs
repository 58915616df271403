//! Questions about a scene by methods of light transport.

use super::SurfaceSample;
use crate::hit::{Hit, Origin, RayClass};
use crate::media::{MediaArena, MediaStack};
use crate::query::Intersector;
use crate::scene::RenderScene;
use crate::shadow::ShadowRay;
use crate::trace::{TraceSettings, TreeTracer};
use strahl_math::{DVec3, Interval, Ray};
use strahl_shade::{Color, LightSample};

/// Asks about rays and lights, with the working memory of one thread.
#[derive(Debug)]
pub struct Probe<'p, 's> {
    pub(crate) intersector: &'p mut Intersector<'s>,
    pub(crate) media: &'p mut MediaArena,
    pub(crate) hits: &'p mut Vec<Hit>,
}

impl<'s> Probe<'_, 's> {
    /// The scene.
    pub const fn scene(&self) -> &'s RenderScene {
        self.intersector.scene
    }

    /// The nearest hit of a ray with `range.min < t <= range.max`, of objects that reflections show.
    pub fn closest_hit(
        &mut self,
        ray: &Ray,
        range: Interval,
        from: Option<&Origin>,
    ) -> Option<Hit> {
        self.intersector
            .closest_hit(ray, range, from, RayClass::Secondary)
    }

    /// The light that arrives from light source `number` (an index of the scene's lights) at a point in the air, and the share of it that
    /// objects let through; `None` if it does not shine there. Of a light with an extent the centre counts.
    pub fn light(&mut self, number: usize, position: DVec3) -> Option<(LightSample, Color)> {
        let light = &self.intersector.scene.lights.get(number)?.light;
        let sample = light.illuminate(position)?;
        let is_free = !light.casts_shadows && self.intersector.scene.mask(number).is_none();
        if is_free || sample.range.is_empty() {
            return Some((sample, Color::WHITE));
        }
        let shadow_ray = ShadowRay {
            ray: &Ray::new(position, sample.shadow_direction),
            range: sample.range,
            from: &Origin::NOWHERE,
            light: number,
            media: MediaStack::VACUUM,
        };
        let shadow = self.intersector.shadow(&shadow_ray, self.media, self.hits);
        Some((sample, shadow.visible))
    }
}

/// A ray on its way through a scene, with the surface that it leaves and the solids that it is in.
#[derive(Clone, Copy, Debug)]
pub struct PathRay {
    /// The ray.
    pub ray: Ray,
    /// Where it starts, if on a surface.
    pub(crate) origin: Option<Origin>,
    pub(crate) media: MediaStack,
}

/// Follows rays through a scene on one thread, outside of a picture: what a [`Prepass`](super::Prepass) works with.
#[derive(Debug)]
pub struct Prober<'s> {
    tree: TreeTracer<'s>,
}

impl RenderScene {
    /// What follows rays on one thread.
    pub fn prober(&self) -> Prober<'_> {
        Prober {
            tree: TreeTracer::new(self, TraceSettings::of(self)),
        }
    }
}

impl<'s> Prober<'s> {
    /// Asks about rays and lights.
    pub const fn probe(&mut self) -> Probe<'_, 's> {
        self.tree.probe()
    }

    /// Begins a path with a ray that starts on no surface. Rays of the path before are of no use any more.
    pub fn begin(&mut self, ray: &Ray) -> PathRay {
        self.tree.begin_path(ray)
    }

    /// The surface that a ray of the path meets first.
    pub fn surface(&mut self, path: &PathRay) -> Option<SurfaceSample> {
        self.tree.surface_on(path)
    }

    /// Goes on from the last surface in a direction of any length: through it, if that points away from the side that was met.
    /// `None` if no surface has been met.
    pub fn leave(&mut self, direction: DVec3) -> Option<PathRay> {
        self.tree.leave_surface(direction)
    }
}
