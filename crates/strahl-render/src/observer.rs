mod terms;

pub use terms::{LayerReport, LightDetail, Shading, ShadowHit, ShadowReport, SurfaceTerm};

use crate::hit::Hit;
use std::fmt;
use strahl_math::{DVec3, Ray, det};
use strahl_shade::{Color, MaterialId, SpectralPart};

/// The kinds of rays in a tree that see something (shadow rays belong to the node they start from).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum RayKind {
    /// From the eye.
    Primary,
    /// In the mirror direction.
    Reflection,
    /// In the transparency direction.
    Refraction,
    /// In a direction that a [`Gather`](crate::transport::Gather) asked for.
    Gather,
}

impl fmt::Display for RayKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Primary => "primary",
            Self::Reflection => "reflection",
            Self::Refraction => "transparency",
            Self::Gather => "gather",
        })
    }
}

/// Why a branch that the surface would allow was not traced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BranchEnd {
    /// The tree is as deep as allowed.
    DepthLimit,
    /// The branch's weight is below the cutoff.
    WeightCutoff,
    /// Snell's law has no solution: everything is reflected.
    TotalReflection,
    /// The tree has as many rays as allowed.
    TreeLimit,
}

impl fmt::Display for BranchEnd {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::DepthLimit => "depth limit",
            Self::WeightCutoff => "weight below the cutoff",
            Self::TotalReflection => "total internal reflection",
            Self::TreeLimit => "limit of rays per sample",
        })
    }
}

/// How much a ray contributes to the hit that sent it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Share {
    /// kr or kt: the factor.
    pub factor: Color,
    /// The exponent that is applied to the radiance before, channel by channel: 1 except for POV-Ray's reflections with an
    /// `exponent`.
    pub power: f64,
}

impl Share {
    /// All of it.
    pub const ALL: Self = Self {
        factor: Color::WHITE,
        power: 1.0,
    };

    /// `factor · light^power`
    #[inline]
    pub fn of(&self, light: Color) -> Color {
        if self.power == 1.0 {
            return self.factor * light;
        }
        let raised = |x: f64| {
            if x > 0.0 {
                det::pow(x, self.power)
            } else {
                0.0
            }
        };
        self.factor * light.map(raised)
    }
}

/// A ray of the tree and its result.
#[derive(Clone, Debug)]
pub struct RayReport {
    /// Number of the ray in its tree, in the order of tracing; 0 is the primary ray.
    pub node: u32,
    /// The ray that sent it (itself for the primary ray).
    pub parent: u32,
    /// Its kind.
    pub kind: RayKind,
    /// Level in the tree, 1 for the primary ray.
    pub depth: u32,
    /// The throughput: the largest channel of the product of all coefficients on the way to it.
    pub weight: f64,
    /// How much it contributes to the hit that sent it; several reflection rays of one hit each have their own.
    pub share: Share,
    /// The ray.
    pub ray: Ray,
    /// The surface it hit, or `None` for the background.
    pub hit: Option<HitReport>,
    /// The background's colour, if it hit nothing.
    pub background: Option<Color>,
    /// The part of the spectrum it stands for.
    pub part: SpectralPart,
    /// The material of the solid it ran through; `None` is air.
    pub medium: Option<MaterialId>,
    /// The attenuation by the medium it ran through; where light was divided into its spectrum, times the part's share.
    pub attenuation: Color,
    /// The light that fog, rainbows and a medium in front of the hit add.
    pub fog: Color,
}

/// The light that a [`Gather`](crate::transport::Gather) found at a hit. It is neither local, nor reflected, nor transmitted.
#[derive(Clone, Debug, PartialEq)]
pub struct GatherTerm {
    /// The name of the method.
    pub method: String,
    /// The radiance, without that of its rays.
    pub radiance: Color,
    /// How many rays it asked for; those that a limit ends are reported as ended.
    pub rays: u32,
}

/// The surface a ray of the tree hit.
#[derive(Clone, Debug)]
pub struct HitReport {
    /// The hit.
    pub hit: Hit,
    /// Number of the object.
    pub object: u32,
    /// Number of the material.
    pub material: MaterialId,
    /// The line of the scene file that made this triangle, where a mesh stores it.
    pub line: Option<u32>,
    /// The shading model or the finishes.
    pub shading: Shading,
    /// World position.
    pub position: DVec3,
    /// Unit normal of the surface, on the side of the ray.
    pub n_geom: DVec3,
    /// Unit normal for shading, on the side of the ray.
    pub n_shade: DVec3,
    /// Index of refraction on the side of the ray.
    pub eta_1: f64,
    /// Index of refraction behind the surface.
    pub eta_2: f64,
    /// Cosine of the angle of incidence.
    pub cos_1: f64,
    /// Cosine of the angle of refraction, if the surface transmits and does not reflect totally.
    pub cos_2: Option<f64>,
    /// Whether Snell's law has no solution for light that the surface would let through: all of it is reflected.
    pub total_reflection: bool,
    /// Fresnel's F, where it is used. Layers of a texture have their own.
    pub fresnel: Option<f64>,
    /// ka, all layers together.
    pub ka: Color,
    /// Ia: the scene's ambient light.
    pub ambient_light: Color,
    /// ka·Ia.
    pub ambient: Color,
    /// Emitted light.
    pub emission: Color,
    /// kd, all layers together.
    pub diffuse: Color,
    /// ks; black for textures, whose layers have highlights of their own.
    pub specular: Color,
    /// p, for `specular`.
    pub shininess: f64,
    /// kr as it was applied (including Fresnel and total reflection), all layers together.
    pub reflection: Color,
    /// kt as it was applied.
    pub transmission: Color,
}

/// The contribution of one light to one hit.
#[derive(Clone, Copy, Debug)]
pub struct LightTerm {
    /// Index of the light.
    pub light: u32,
    /// n·l.
    pub n_dot_l: f64,
    /// The shadow ray, for an area light the one to its centre; `None` if none was sent because the surface faces away or
    /// is one on which no light source shows, or the light does not shine here or casts no shadows.
    pub shadow_ray: Option<Ray>,
    /// How many shadow rays were traced: 1, or for area lights as many as needed.
    pub shadow_rays: u32,
    /// The visibility of the light: 0 in full shadow, 1 if nothing is in between; the mean over an area light.
    pub visible: Color,
    /// The light's colour at the point.
    pub color: Color,
    /// The diffuse part, times colour and visibility.
    pub diffuse: Color,
    /// The highlights, times colour and visibility.
    pub specular: Color,
}

impl LightTerm {
    /// No light of a light source.
    pub(crate) const fn none(light: usize) -> Self {
        Self {
            light: light as u32,
            n_dot_l: 0.0,
            shadow_ray: None,
            shadow_rays: 0,
            visible: Color::BLACK,
            color: Color::BLACK,
            diffuse: Color::BLACK,
            specular: Color::BLACK,
        }
    }
}

/// Is told what the trace loop does, and so records ray trees. The observer `()` costs nothing.
pub trait TraceObserver {
    /// Whether reports are wanted; otherwise they are not even made.
    const ACTIVE: bool = true;

    /// Whether what happens at hits is wanted: their data in [`RayReport::hit`], lights, shadows and branches that end. The reports on
    /// shadows trace their rays again.
    const DETAILED: bool = true;

    /// A ray was traced (before its lights and branches are).
    fn ray(&mut self, _report: RayReport) {}

    /// The contribution of a light to the hit of a ray was computed.
    fn light(&mut self, _node: u32, _term: LightTerm, _detail: LightDetail) {}

    /// Light was gathered at the hit of a ray.
    fn gathered(&mut self, _node: u32, _term: GatherTerm) {}

    /// A shadow ray to a point of an area light was traced. [`TraceObserver::light`] is called with the mean afterwards.
    fn area_shadow(&mut self, _node: u32, _light: u32, _shadow: ShadowReport) {}

    /// A branch was not traced.
    fn ended(&mut self, _node: u32, _kind: RayKind, _weight: f64, _end: BranchEnd) {}

    /// A ray's radiance is known: `local` is what the hit itself contributes, `total` includes all branches. Children come
    /// before parents.
    fn combined(&mut self, _node: u32, _local: Color, _total: Color) {}
}

impl TraceObserver for () {
    const ACTIVE: bool = false;
    const DETAILED: bool = false;
}
