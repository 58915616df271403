//! Where methods of light transport plug into the trace loop that it does not have itself: radiosity, photons, participating media.
//!
//! * a [`Prepass`] computes values once per scene, before a picture ([`Session::prepass`](crate::Session::prepass)),
//! * a [`Gather`] adds light at hits: from such values, or by rays of its own,
//! * a [`MediumIntegrator`] absorbs and adds light along rays.
//!
//! They ask the scene by a [`Probe`]. Lights emit rays by [`Light::emit`](strahl_shade::Light::emit).

mod prepass;
mod probe;

pub use prepass::{Prepass, PrepassError, load_prepass, save_prepass};
pub use probe::{PathRay, Probe, Prober};

use crate::hit::Hit;
use std::fmt;
use std::sync::Arc;
use strahl_math::{DVec3, Ray};
use strahl_shade::{Color, MaterialId};

/// What the trace loop asks besides the scene: nothing by default.
#[derive(Clone, Debug, Default)]
pub struct Transport {
    /// Adds light at hits.
    pub gather: Option<Arc<dyn Gather>>,
    /// Absorbs and adds light along rays.
    pub medium: Option<Arc<dyn MediumIntegrator>>,
}

/// The same methods, not only equal ones.
impl PartialEq for Transport {
    fn eq(&self, other: &Self) -> bool {
        is_same(&self.gather, &other.gather) && is_same(&self.medium, &other.medium)
    }
}

fn is_same<T: ?Sized>(a: &Option<Arc<T>>, b: &Option<Arc<T>>) -> bool {
    match (a, b) {
        (Some(a), Some(b)) => Arc::ptr_eq(a, b),
        (a, b) => a.is_none() && b.is_none(),
    }
}

/// A hit as methods of light transport see it.
#[derive(Clone, Copy, Debug)]
pub struct SurfaceSample {
    /// The ray that met it.
    pub ray: Ray,
    /// Where it met.
    pub hit: Hit,
    /// World position.
    pub position: DVec3,
    /// Unit normal of the surface, on the side of the ray.
    pub n_geom: DVec3,
    /// Unit normal for shading, on the side of the ray.
    pub n_shade: DVec3,
    /// The material.
    pub material: MaterialId,
    /// Light of colour `c` from the unit direction `l` is reflected diffusely as `diffuse · c · (n·l)`: there is no factor 1/π in it.
    pub diffuse: Color,
    /// The coefficient of the mirror direction.
    pub reflection: Color,
    /// The coefficient of the transparency direction.
    pub transmission: Color,
    /// The mirror direction, if `reflection` is not black.
    pub mirrored: Option<DVec3>,
    /// The transparency direction, if light passes.
    pub transmitted: Option<DVec3>,
    /// Level of the ray in its tree, 1 for a primary ray.
    pub depth: u32,
    /// The throughput: the largest channel of the product of all coefficients on the way to the ray, 1 for a primary ray.
    pub weight: f64,
}

/// The light that a [`Gather`] finds at one hit.
#[derive(Clone, Debug, Default)]
pub struct Gathered {
    /// Radiance towards the origin of the ray.
    pub radiance: Color,
    /// Rays to trace as a further generation: each adds its share of the radiance along it.
    pub rays: Vec<GatherRay>,
}

/// A ray that a [`Gather`] sends from a hit.
#[derive(Clone, Copy, Debug)]
pub struct GatherRay {
    /// Its direction, of any length.
    pub direction: DVec3,
    /// What the radiance along it is multiplied by.
    pub share: Color,
}

/// Light at hits that neither comes from a light source on a straight way nor from the directions of reflection and transparency:
/// irradiance by other surfaces, photons, subsurface light.
pub trait Gather: fmt::Debug + Send + Sync {
    /// The name that explanations give it.
    fn name(&self) -> &str;

    /// Finds the light at some hits: `out` has one place for each, which has no light yet.
    ///
    /// What it finds at a hit must not depend on the others, nor on earlier calls: which hits come together depends on the number of
    /// threads, on the order of tiles and on packets, and pictures must not.
    fn gather(&self, points: &[SurfaceSample], probe: &mut Probe<'_, '_>, out: &mut [Gathered]);
}

/// The kinds of rays that go through a medium.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MediumRay {
    /// From the eye.
    Camera,
    /// By reflection, transparency or a [`Gather`].
    Secondary,
    /// To a light: what the medium adds along it is not seen.
    Shadow,
}

/// A ray from its origin to its hit, or to a light.
#[derive(Clone, Copy, Debug)]
pub struct MediumPath {
    /// The ray; its direction has any length.
    pub ray: Ray,
    /// Its length in world units; infinite if it meets nothing.
    pub length: f64,
    /// Its kind.
    pub kind: MediumRay,
    /// The material of the solid that it goes through; `None` is air.
    pub inside: Option<MaterialId>,
}

/// What a medium does along a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MediumTerm {
    /// The share of the light at the end that arrives at the origin, per channel.
    pub transmittance: Color,
    /// The radiance that it adds, as it arrives at the origin.
    pub radiance: Color,
}

impl MediumTerm {
    /// No medium.
    pub const NONE: Self = Self {
        transmittance: Color::WHITE,
        radiance: Color::BLACK,
    };
}

/// A medium that absorbs, scatters or emits light along rays. Fogs, rainbows and the insides of materials keep doing what they do; what
/// they and the medium do along one ray does not depend on each other.
pub trait MediumIntegrator: fmt::Debug + Send + Sync {
    /// Integrates along a ray. The result must depend on the path only.
    fn along(&self, path: &MediumPath, probe: &mut Probe<'_, '_>) -> MediumTerm;
}
