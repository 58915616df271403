use crate::observer::RayKind;
use crate::sampling::Sample;
use strahl_math::DVec3;
use strahl_shade::{Color, MaterialId};

/// Rays traced, by kind, and how many of them hit something.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RayCounts {
    /// Rays from the eye.
    pub primary: u64,
    /// Those that hit an object.
    pub primary_hit: u64,
    /// Rays to lights.
    pub shadow: u64,
    /// Those with a hit before the light, opaque or transparent.
    pub shadow_hit: u64,
    /// Reflection rays.
    pub reflection: u64,
    /// Those that hit an object.
    pub reflection_hit: u64,
    /// Transparency rays.
    pub refraction: u64,
    /// Those that hit an object.
    pub refraction_hit: u64,
    /// Rays by which a [`Gather`](crate::transport::Gather) finds light.
    pub gather: u64,
    /// Those that hit an object.
    pub gather_hit: u64,
    /// Trees that reached the limit of rays.
    pub cut_trees: u64,
}

impl RayCounts {
    /// All rays.
    pub fn total(&self) -> u64 {
        self.primary + self.shadow + self.reflection + self.refraction + self.gather
    }

    /// Those of them that hit something.
    pub fn hits(&self) -> u64 {
        self.primary_hit
            + self.shadow_hit
            + self.reflection_hit
            + self.refraction_hit
            + self.gather_hit
    }

    pub(crate) fn count(&mut self, kind: RayKind, hit: bool) {
        let (rays, hits) = match kind {
            RayKind::Primary => (&mut self.primary, &mut self.primary_hit),
            RayKind::Reflection => (&mut self.reflection, &mut self.reflection_hit),
            RayKind::Refraction => (&mut self.refraction, &mut self.refraction_hit),
            RayKind::Gather => (&mut self.gather, &mut self.gather_hit),
        };
        *rays += 1;
        *hits += u64::from(hit);
    }
}

impl std::ops::AddAssign for RayCounts {
    fn add_assign(&mut self, o: Self) {
        self.primary += o.primary;
        self.primary_hit += o.primary_hit;
        self.shadow += o.shadow;
        self.shadow_hit += o.shadow_hit;
        self.reflection += o.reflection;
        self.reflection_hit += o.reflection_hit;
        self.refraction += o.refraction;
        self.refraction_hit += o.refraction_hit;
        self.gather += o.gather;
        self.gather_hit += o.gather_hit;
        self.cut_trees += o.cut_trees;
    }
}

/// What a primary ray hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FirstHit {
    /// Distance from the ray's origin.
    pub distance: f64,
    /// World position.
    pub position: DVec3,
    /// Unit shading normal on the side of the viewer.
    pub normal: DVec3,
    /// Number of the object.
    pub object: u32,
    /// Number of the material.
    pub material: MaterialId,
}

/// The result of one primary ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SampleResult {
    /// The radiance, a colour of the scene's working space.
    pub color: Color,
    /// How much of the background shows, `0..=1`, and is not part of the colour; 0 where no alpha channel is wanted.
    pub clear: f64,
    /// The first hit.
    pub first: Option<FirstHit>,
    /// Deepest level of the tree reached.
    pub depth: u32,
    /// Rays of the tree, shadow rays included.
    pub rays: u32,
}

impl SampleResult {
    /// The sample where the camera sends no ray.
    pub const NOTHING: Self = Self {
        color: Color::BLACK,
        clear: 0.0,
        first: None,
        depth: 0,
        rays: 0,
    };

    /// What the ray sees.
    pub(crate) const fn sample(&self) -> Sample {
        Sample {
            color: self.color,
            clear: self.clear,
        }
    }
}
