//! The rays of the benchmark: computed once from hits found by strahl, and the same for both programs.

use super::meshes::{Rng, View};
use std::ops::Range;
use strahl::math::{DVec3, Interval, Ray};
use strahl::scene::Camera;
use strahl::tracing::{Intersector, Origin, PrimaryRays, RayClass, RenderScene};

/// A ray with its range in f32, as Embree takes it; strahl gets the same numbers.
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
    /// The rays as Embree takes them.
    pub(super) segments: Vec<Segment>,
    /// The same rays as strahl takes them.
    pub(super) rays: Vec<Ray>,
    /// The range of all rays.
    pub(super) range: Interval,
    /// The surfaces on which the rays start, for strahl; empty for rays from the eye.
    pub(super) starts: Vec<Origin>,
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
    /// The same from the hits of squares of 4 by 4 pixels.
    ShadowTiles,
    /// Mirrored at the first hit.
    Mirror,
    /// From the first hit, cosine-distributed.
    Diffuse,
}

impl Kind {
    pub(super) const ALL: [Self; 6] = [
        Self::Primary,
        Self::PrimaryTiles,
        Self::Shadow,
        Self::ShadowTiles,
        Self::Mirror,
        Self::Diffuse,
    ];

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Primary => "primary",
            Self::PrimaryTiles => "primary, 4x4",
            Self::Shadow => "shadow",
            Self::ShadowTiles => "shadow, 4x4",
            Self::Mirror => "mirror",
            Self::Diffuse => "diffuse",
        }
    }

    /// Whether the rays look for any hit.
    pub(super) fn any(self) -> bool {
        matches!(self, Self::Shadow | Self::ShadowTiles)
    }

    /// Whether the rays are ordered in squares of 4 by 4 pixels.
    pub(super) fn in_tiles(self) -> bool {
        matches!(self, Self::PrimaryTiles | Self::ShadowTiles)
    }
}

impl Batch {
    /// For rays that start on a surface, Embree gets a minimum distance; strahl gets the surface itself.
    fn new(kind: Kind) -> Self {
        let near = match kind {
            Kind::Primary | Kind::PrimaryTiles => 0.0,
            Kind::Shadow | Kind::ShadowTiles | Kind::Mirror | Kind::Diffuse => f64::from(1e-4f32),
        };
        let far = if kind.any() { 1.0 } else { f64::INFINITY };
        Self {
            kind,
            segments: vec![],
            rays: vec![],
            range: Interval::new(near, far),
            starts: vec![],
        }
    }

    /// Adds a ray, rounded to f32 for both programs.
    fn push(&mut self, ray: &Ray, from: Option<Origin>) {
        let (origin, direction) = (ray.origin.as_vec3(), ray.direction.as_vec3());
        self.segments.push(Segment {
            origin: origin.to_array(),
            near: self.range.min as f32,
            direction: direction.to_array(),
            far: self.range.max as f32,
        });
        self.rays
            .push(Ray::new(origin.as_dvec3(), direction.as_dvec3()));
        self.starts.extend(from);
    }

    /// A part of the rays as strahl takes them.
    pub(super) fn rays(&self, part: Range<usize>) -> impl Iterator<Item = (&Ray, Option<&Origin>)> {
        let rays = part.clone().zip(&self.rays[part]);
        rays.map(|(i, ray)| (ray, self.starts.get(i)))
    }
}

/// All batches for a view.
pub(super) fn make(scene: &RenderScene, view: View, side: u32) -> Vec<Batch> {
    let camera = Camera::perspective(view.eye, view.target, DVec3::Y, 0.8);
    let camera = PrimaryRays::new(&camera, side, side);
    let mut batches = Kind::ALL.map(Batch::new);
    let mut tracer = Intersector::new(scene);
    let mut rng = Rng(5);
    let tile = |i: u32| {
        let (block, inside) = (i / 16, i % 16);
        let blocks = side / 4;
        (
            block % blocks * 4 + inside % 4,
            block / blocks * 4 + inside / 4,
        )
    };
    // The point, the normal on the side of the eye, and the surface on which rays from there start.
    let mut first_hit = |ray: &Ray| {
        let hit = tracer.closest_hit(ray, Interval::FORWARD, None, RayClass::Camera)?;
        let point = scene.surface_at(ray, &hit);
        let normal = if point.n_geom.dot(ray.direction) < 0.0 {
            point.n_geom
        } else {
            -point.n_geom
        };
        let from = Origin {
            id: hit.id,
            facet: hit.facet,
            local: point.position,
        };
        Some((point.position, normal, from))
    };
    for i in 0..side * side {
        let centre = |(x, y): (u32, u32)| camera.ray(f64::from(x) + 0.5, f64::from(y) + 0.5);
        let (Some(in_row), Some(in_tile)) = (centre((i % side, i / side)), centre(tile(i))) else {
            continue;
        };
        batches[0].push(&in_row, None);
        batches[1].push(&in_tile, None);
        if let Some((point, _, from)) = batches[1].rays.last().and_then(&mut first_hit) {
            let to_light = Ray::new(point, view.light - point);
            batches[3].push(&to_light, Some(from));
        }
        let Some(ray) = batches[0].rays.last().copied() else {
            continue;
        };
        let Some((position, normal, from)) = first_hit(&ray) else {
            continue;
        };
        let from = Some(from);
        batches[2].push(&Ray::new(position, view.light - position), from);
        let mirrored = ray.direction - normal * (2.0 * normal.dot(ray.direction));
        batches[4].push(&Ray::new(position, mirrored), from);
        let (u, v) = (rng.unit(), rng.unit());
        let x = normal.any_orthonormal_vector();
        let (sin, cos) = (2.0 * std::f64::consts::PI * u).sin_cos();
        let around = x * cos + normal.cross(x) * sin;
        let diffuse = around * v.sqrt() + normal * (1.0 - v).sqrt();
        batches[5].push(&Ray::new(position, diffuse), from);
    }
    batches.into()
}
