//! The rays of the benchmark: made once from the hits of strahl, the same for everyone.

use super::meshes::Rng;
use strahl::math::{DVec3, Interval, Ray};
use strahl::scene::Camera;
use strahl::tracing::{Origin, PrimaryRays, RayClass, RenderScene, Tracer};

/// A ray with its range, in the numbers Embree takes; strahl gets the same numbers.
#[derive(Clone, Copy)]
pub(super) struct Segment {
    pub(super) origin: [f32; 3],
    pub(super) near: f32,
    pub(super) direction: [f32; 3],
    pub(super) far: f32,
}

/// Rays of one kind.
pub(super) struct Batch {
    pub(super) kind: Kind,
    /// What Embree traces.
    pub(super) segments: Vec<Segment>,
    /// What strahl traces: the same rays, with where they start.
    pub(super) rays: Vec<(Ray, Interval, Option<Origin>)>,
}

/// Kinds of rays.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// From the eye, row by row.
    Primary,
    /// From the eye, in squares of 4 by 4 pixels.
    PrimaryTiles,
    /// To a point light; any hit.
    Shadow,
    /// Mirrored at the first hit.
    Mirror,
    /// From the first hit, cosine-distributed.
    Diffuse,
}

impl Kind {
    pub(super) const ALL: [Self; 5] = [
        Self::Primary,
        Self::PrimaryTiles,
        Self::Shadow,
        Self::Mirror,
        Self::Diffuse,
    ];

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Primary => "primary",
            Self::PrimaryTiles => "primary, 4x4",
            Self::Shadow => "shadow",
            Self::Mirror => "mirror",
            Self::Diffuse => "diffuse",
        }
    }

    /// Whether any hit will do.
    pub(super) fn any(self) -> bool {
        self == Self::Shadow
    }
}

impl Batch {
    fn new(kind: Kind) -> Self {
        Self {
            kind,
            segments: vec![],
            rays: vec![],
        }
    }

    /// Adds a ray, rounded to f32 for everyone. Embree skips the first part of rays that start on a surface, strahl knows
    /// where they start.
    fn push(&mut self, ray: &Ray, far: f64, from: Option<Origin>) {
        let (origin, direction) = (ray.origin.as_vec3(), ray.direction.as_vec3());
        let near = if from.is_some() { 1e-4 } else { 0.0 };
        self.segments.push(Segment {
            origin: origin.to_array(),
            near,
            direction: direction.to_array(),
            far: far as f32,
        });
        let ray = Ray::new(origin.as_dvec3(), direction.as_dvec3());
        self.rays
            .push((ray, Interval::new(f64::from(near), far), from));
    }
}

/// All batches for a view.
pub(super) fn make(
    scene: &RenderScene,
    eye: DVec3,
    target: DVec3,
    light: DVec3,
    side: u32,
) -> Vec<Batch> {
    let camera = Camera::perspective(eye, target, DVec3::Y, 0.8);
    let camera = PrimaryRays::new(&camera, side, side);
    let mut batches = Kind::ALL.map(Batch::new);
    let mut tracer = Tracer::new(scene);
    let mut rng = Rng(5);
    let tile = |i: u32| {
        let (block, inside) = (i / 16, i % 16);
        let blocks = side / 4;
        (
            block % blocks * 4 + inside % 4,
            block / blocks * 4 + inside / 4,
        )
    };
    for i in 0..side * side {
        let centre = |(x, y): (u32, u32)| camera.ray(f64::from(x) + 0.5, f64::from(y) + 0.5);
        let (Some(in_row), Some(in_tile)) = (centre((i % side, i / side)), centre(tile(i))) else {
            continue;
        };
        batches[0].push(&in_row, f64::INFINITY, None);
        batches[1].push(&in_tile, f64::INFINITY, None);
        let ray = batches[0].rays[i as usize].0;
        let Some(hit) = tracer.closest_hit(&ray, Interval::FORWARD, None, RayClass::Camera) else {
            continue;
        };
        let point = scene.surface_at(&ray, &hit);
        let normal = if point.n_geom.dot(ray.direction) < 0.0 {
            point.n_geom
        } else {
            -point.n_geom
        };
        let from = Some(Origin {
            id: hit.id,
            facet: hit.facet,
            local: point.position,
        });
        let position = point.position;
        batches[2].push(&Ray::new(position, light - position), 1.0, from);
        let mirrored = ray.direction - normal * (2.0 * normal.dot(ray.direction));
        batches[3].push(&Ray::new(position, mirrored), f64::INFINITY, from);
        let (u, v) = (rng.unit(), rng.unit());
        let x = normal.any_orthonormal_vector();
        let (sin, cos) = (2.0 * std::f64::consts::PI * u).sin_cos();
        let around = x * cos + normal.cross(x) * sin;
        let diffuse = around * v.sqrt() + normal * (1.0 - v).sqrt();
        batches[4].push(&Ray::new(position, diffuse), f64::INFINITY, from);
    }
    batches.into()
}
