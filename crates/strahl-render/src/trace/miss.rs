//! Primary rays that hit nothing: the background.

use super::{Branch, SampleResult, TreeTracer};
use crate::coverage::Coverage;
use crate::observer::RayKind;
use crate::sampling::Sample;
use crate::scene::RenderScene;
use strahl_math::{DVec3, Ray};
use strahl_scene::Background;
use strahl_shade::Color;

/// The radiance along primary rays that hit nothing, if it is the same for all.
pub(super) fn uniform_background(scene: &RenderScene) -> Option<Color> {
    if scene.has_air() || scene.absorbs_around_the_eye() {
        return None;
    }
    let color = match &scene.opaque_background {
        Background::Solid(color) => *color,
        Background::Sky(sky) => sky.same_everywhere()?,
        Background::Gradient { .. } => return None,
    };
    Some(color + Color::BLACK)
}

impl TreeTracer<'_> {
    /// With the alpha channel: the background is left out of what primary rays see, as far as it is see-through.
    pub(crate) fn with_alpha(mut self) -> Self {
        let scene = self.intersector.scene;
        let coverage = Coverage::new(scene.background.clone(), scene.background_alpha);
        // What is the same along all rays can be asked along any.
        let (seen, clear) = coverage.beyond(DVec3::Y);
        let without = |_| clear.taken_from(seen + Color::BLACK);
        self.beyond = self.beyond.map(without);
        self.coverage = Some(coverage);
        self
    }

    /// What a primary ray sees that hits nothing.
    pub(crate) fn miss(&mut self, primary: &Ray) -> SampleResult {
        let eye = self.eye_media(primary.origin);
        self.put(0, primary, 0, eye);
        let points = std::mem::take(&mut self.points);
        let Sample { color, clear } = self.miss_along(&points[0].branch);
        self.points = points;
        SampleResult {
            color,
            clear,
            first: None,
            depth: 1,
            rays: 1,
        }
    }

    /// The same for a ray that is in a tree already.
    pub(super) fn miss_along(&mut self, primary: &Branch) -> Sample {
        self.counts.count(RayKind::Primary, false);
        if let Some(sample) = self.beyond {
            return sample;
        }
        let scene = self.intersector.scene;
        let (keeps, adds) = self.in_front(primary, f64::INFINITY);
        // The same sum as of a tree without branches, including the sign of zeros.
        let direction = primary.ray.direction;
        let (seen, clear) = match &self.coverage {
            Some(coverage) => {
                let (seen, clear) = coverage.beyond(direction);
                (seen, Some(clear))
            }
            None => (scene.opaque_background.along(direction), None),
        };
        let mut color = seen + Color::BLACK;
        color *= keeps;
        if self.adds_light_on_the_way() {
            color += adds;
        }
        match clear {
            Some(clear) => clear.attenuated(keeps).taken_from(color),
            None => Sample::from(color),
        }
    }

    /// What primary rays see that hit nothing, if it is the same for all; then `rays` rays are counted as traced.
    #[inline]
    pub(crate) fn uniform_miss(&mut self, rays: usize) -> Option<Sample> {
        if self.beyond.is_some() {
            self.counts.primary += rays as u64;
        }
        self.beyond
    }
}
