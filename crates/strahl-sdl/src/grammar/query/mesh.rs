use std::sync::Arc;
use strahl_accel::{Accelerator, Bvh2, TraversalStats, Visitor};
use strahl_geometry::{
    GeometryError, PrimHit, Primitive, RayShear, Scratch, SurfaceId, SurfacePoint, TriangleMesh,
};
use strahl_math::{Aabb, Interval, Ray};

/// A mesh with its own hierarchy, because scenes query the same mesh thousands of times. The results are the same as the mesh's.
#[derive(Debug)]
pub(super) struct SearchableMesh {
    mesh: Arc<TriangleMesh>,
    tree: Bvh2,
}

impl SearchableMesh {
    pub(super) fn new(mesh: Arc<TriangleMesh>) -> Self {
        let triangles = 0..mesh.triangle_count();
        let boxes: Vec<Aabb> = triangles.map(|t| mesh.element_bounds(t)).collect();
        let tree = Bvh2::build(&boxes);
        Self { mesh, tree }
    }
}

/// Keeps the nearest hit; of equally near ones, that of the first triangle.
struct Nearest<'a> {
    mesh: &'a TriangleMesh,
    shear: RayShear,
    range: Interval,
    start: Option<u32>,
    best: Option<PrimHit>,
}

impl Visitor for Nearest<'_> {
    fn visit(&mut self, id: u32, t_max: f64) -> f64 {
        if self.start == Some(id) {
            return t_max;
        }
        let key = |hit: &PrimHit| (hit.t, hit.surface.element);
        match self.mesh.hit_element(id, &self.shear, self.range) {
            Some(hit) if self.best.is_none_or(|best| key(&hit) < key(&best)) => {
                self.best = Some(hit);
                hit.t
            }
            _ => t_max,
        }
    }
}

impl Primitive for SearchableMesh {
    fn kind(&self) -> &'static str {
        self.mesh.kind()
    }

    fn validate(&self) -> Result<(), GeometryError> {
        self.mesh.validate()
    }

    fn bounds(&self) -> Aabb {
        self.mesh.bounds()
    }

    fn elements(&self) -> u32 {
        self.mesh.elements()
    }

    fn closest_hit(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        _scratch: &mut Scratch,
    ) -> Option<PrimHit> {
        let mut nearest = Nearest {
            mesh: &self.mesh,
            shear: RayShear::new(ray),
            range,
            start: from.map(|surface| surface.element),
            best: None,
        };
        let stats = &mut TraversalStats::default();
        self.tree.traverse(ray, range, &mut nearest, stats);
        nearest.best
    }

    fn surface_at(&self, ray: &Ray, hit: &PrimHit) -> SurfacePoint {
        self.mesh.surface_at(ray, hit)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use strahl_geometry::MeshData;
    use strahl_math::DVec3;

    #[test]
    fn the_hierarchy_finds_what_the_list_finds() {
        let wave = |i: u32, j: u32| {
            let (x, z) = (f64::from(i), f64::from(j));
            DVec3::new(x, f64::from(i * j % 7), z)
        };
        let n = 12;
        let grid = (0..n * n).map(|k| wave(k / n, k % n)).collect::<Vec<_>>();
        let faces = (0..n - 1).flat_map(|i| (0..n - 1).map(move |j| i * n + j));
        let faces = faces.flat_map(|k| [[k, k + 1, k + n], [k + 1, k + n + 1, k + n]]);
        let data = MeshData::from_f64(&grid, faces.collect());
        let mesh = Arc::new(TriangleMesh::try_new(data).expect("a mesh"));
        let fast = SearchableMesh::new(Arc::clone(&mesh));
        let scratch = &mut Scratch::default();
        let mut hits = 0;
        for k in 0..400 {
            let at = f64::from(k) * 0.037;
            let ray = Ray::new(
                DVec3::new(at % 11.0, 20.0, (at * 3.1) % 11.0),
                DVec3::new(0.1 * (at % 2.0) - 0.1, -1.0, 0.05),
            );
            let expected = mesh.closest_hit(&ray, Interval::FORWARD, None, scratch);
            let found = fast.closest_hit(&ray, Interval::FORWARD, None, scratch);
            assert_eq!(found, expected);
            hits += u32::from(found.is_some());
        }
        assert!(hits > 300, "{hits}");
    }
}
