//! The search of a mesh that is a part of another object: a tree over its triangles, and the walk through it.

use super::TriangleMesh;
use super::shear::RayShear;
use crate::{PrimHit, SurfaceId};
use std::sync::{Arc, OnceLock};
use strahl_accel::{Accelerator, Bvh2, TraversalStats, Visitor};
use strahl_math::{Aabb, Interval, Ray};

/// A tree over the triangles of a mesh, relative to its anchor, built when it is first asked for.
#[derive(Clone, Debug, Default)]
pub(super) struct LazyTree(OnceLock<Arc<Bvh2>>);

/// Meshes are equal whether they have been asked for their trees or not.
impl PartialEq for LazyTree {
    fn eq(&self, _other: &Self) -> bool {
        true
    }
}

impl TriangleMesh {
    /// The tree over the triangles, relative to the anchor.
    pub(super) fn tree(&self) -> &Bvh2 {
        self.lazy_tree().0.get_or_init(|| {
            let boxes: Vec<_> = (0..self.triangle_count())
                .map(|i| Aabb::from_points(self.local_corners(i)))
                .collect();
            Arc::new(Bvh2::build(&boxes))
        })
    }

    /// Passes the hits of a ray with the triangles, in any order, to `look`, which returns the `t` up to which further ones matter.
    pub(super) fn walk<F: FnMut(PrimHit, f64) -> f64>(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        look: F,
    ) {
        let local = Ray::new(ray.origin - self.anchor(), ray.direction);
        let mut hits = Hits {
            mesh: self,
            shear: RayShear::new(ray).relative_to(self.anchor()),
            range,
            skipped: from.map(|surface| surface.element),
            look,
        };
        self.tree()
            .traverse(&local, range, &mut hits, &mut TraversalStats::default());
    }
}

/// Tests triangles, and calls `look` with each hit.
struct Hits<'a, F> {
    mesh: &'a TriangleMesh,
    /// Relative to the mesh's anchor.
    shear: RayShear,
    range: Interval,
    skipped: Option<u32>,
    look: F,
}

impl<F: FnMut(PrimHit, f64) -> f64> Visitor for Hits<'_, F> {
    #[inline]
    fn visit(&mut self, id: u32, t_max: f64) -> f64 {
        if self.skipped == Some(id) {
            return t_max;
        }
        match self.mesh.hit_local(id, &self.shear, self.range) {
            Some(hit) => (self.look)(hit, t_max),
            None => t_max,
        }
    }
}
