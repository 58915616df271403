use super::data::{MeshData, check_finite};
use super::shear::{RayShear, intersect_sheared};
use super::triangle::{any_normal, apply_uvs, combine, front_normal, smooth_normal};
use super::walk::LazyTree;
use crate::{GeometryError, PrimHit, Primitive, Scratch, Shape, SurfaceId, SurfacePoint};
use std::sync::Arc;
use strahl_math::error::ROUNDOFF;
use strahl_math::{Aabb, DVec2, DVec3, Interval, Ray, Transform};

/// Triangles that share their vertices: 12 bytes per vertex and 12 per triangle, plus optional data.
///
/// Elements are the triangles, in the order given. Each one behaves as a [`Triangle`](super::Triangle) does: its front
/// is the side from which its vertices run counter-clockwise, rays hit it from both sides, and none slips through between
/// neighbours (those that use the same positions, be it under different indices). Without texture coordinates `uv`
/// are the barycentric ones. Normals are treated as those of a [`SmoothTriangle`](super::SmoothTriangle). Triangles without
/// area are allowed, but never hit.
///
/// Vertices are f32 relative to an f64 anchor; every computation is f64. A renderer puts the triangles into its own accelerator and
/// asks [`TriangleMesh::hit_element`]. [`Primitive::closest_hit`], for meshes that are parts of other objects, builds a tree over the triangles
/// when it is called first.
#[derive(Clone, Debug, PartialEq)]
pub struct TriangleMesh {
    anchor: DVec3,
    positions: Box<[[f32; 3]]>,
    indices: Box<[[u32; 3]]>,
    normals: Option<Box<[[f32; 3]]>>,
    uvs: Option<Box<[[f32; 2]]>>,
    face_materials: Option<Box<[u16]>>,
    face_lines: Option<Box<[u32]>>,
    face_continues: Option<Box<[bool]>>,
    bounds: Aabb,
    /// Whether fronts are clockwise, as after a mirroring transform, which keeps the order of the vertices (and with it the
    /// barycentric coordinates).
    flipped: bool,
    /// Triangles whose last two vertices are exchanged against the order in which they were written; `None` if there are none.
    exchanged: Option<Box<[bool]>>,
    tree: LazyTree,
}

impl TriangleMesh {
    /// Checks the data and takes it over.
    ///
    /// # Errors
    /// There is no triangle, or more than `u32` counts; an index is out of range; a value is not finite; a list
    /// has the wrong length. The first offender is named, counted from 0.
    pub fn try_new(data: MeshData) -> Result<Self, GeometryError> {
        data.check()?;
        let unit = |n: [f32; 3]| {
            DVec3::from(n.map(f64::from))
                .normalize_or_zero()
                .as_vec3()
                .to_array()
        };
        Ok(Self {
            anchor: data.anchor,
            bounds: bounds_of(data.anchor, &data.positions, &data.indices),
            positions: data.positions.into(),
            indices: data.indices.into(),
            normals: data
                .normals
                .map(|list| list.into_iter().map(unit).collect()),
            uvs: data.uvs.map(Into::into),
            face_materials: data.face_materials.map(Into::into),
            face_lines: data.face_lines.map(Into::into),
            face_continues: data.face_continues.map(Into::into),
            flipped: false,
            exchanged: None,
            tree: LazyTree::default(),
        })
    }

    /// The number of triangles.
    pub fn triangle_count(&self) -> u32 {
        self.indices.len() as u32
    }

    /// The origin of [`TriangleMesh::positions`].
    pub const fn anchor(&self) -> DVec3 {
        self.anchor
    }

    /// The vertices, relative to the anchor.
    pub fn positions(&self) -> &[[f32; 3]] {
        &self.positions
    }

    /// The triangles.
    pub fn indices(&self) -> &[[u32; 3]] {
        &self.indices
    }

    /// Whether the vertices run clockwise as seen from the front, as they do after a mirroring transform.
    pub const fn fronts_are_clockwise(&self) -> bool {
        self.flipped
    }

    /// The material slot of a triangle, if the mesh has slots.
    pub fn face_material(&self, triangle: u32) -> Option<u16> {
        self.face_materials
            .as_ref()?
            .get(triangle as usize)
            .copied()
    }

    /// The line of the source that made a triangle, if the mesh knows.
    pub fn face_line(&self, triangle: u32) -> Option<u32> {
        self.face_lines.as_ref()?.get(triangle as usize).copied()
    }

    /// Whether a triangle belongs to the same polygon of its file as the one before: if the mesh knows, or if both are of the
    /// same line.
    pub fn continues_polygon(&self, triangle: u32) -> bool {
        let index = triangle as usize;
        match (&self.face_continues, &self.face_lines) {
            (Some(marks), _) => marks.get(index) == Some(&true),
            (None, Some(lines)) => index > 0 && lines.get(index - 1) == lines.get(index),
            (None, None) => false,
        }
    }

    /// The texture coordinates of a vertex, if the mesh has any.
    pub fn uv(&self, vertex: u32) -> Option<DVec2> {
        let [u, v] = *self.uvs.as_ref()?.get(vertex as usize)?;
        Some(DVec2::new(f64::from(u), f64::from(v)))
    }

    /// The normals given for the corners of a triangle, if the mesh has normals.
    pub fn corner_normals(&self, triangle: u32) -> Option<[DVec3; 3]> {
        let normals = self.normals.as_ref()?;
        Some(
            self.triangle(triangle)
                .map(|v| DVec3::from(normals[v as usize].map(f64::from))),
        )
    }

    /// Bytes of the vertices, the triangles and what belongs to them.
    pub fn bytes(&self) -> usize {
        fn of<T>(list: Option<&[T]>) -> usize {
            list.map_or(0, size_of_val)
        }
        of(Some(&self.positions[..]))
            + of(Some(&self.indices[..]))
            + of(self.normals.as_deref())
            + of(self.uvs.as_deref())
            + of(self.face_materials.as_deref())
            + of(self.face_lines.as_deref())
            + of(self.face_continues.as_deref())
    }

    /// How many triangles have no area (loaders warn of them).
    pub fn degenerate_count(&self) -> u32 {
        (0..self.triangle_count())
            .filter(|&i| {
                let [a, b, c] = self.local_corners(i);
                front_normal(a, b, c).is_none()
            })
            .count() as u32
    }

    /// The corners of a triangle. As everywhere here, the last triangle is used if the number is too large.
    pub fn corners(&self, triangle: u32) -> [DVec3; 3] {
        self.local_corners(triangle).map(|p| self.anchor + p)
    }

    /// The corners of a triangle as they are stored, relative to the anchor; `None` if it has no area and is never hit.
    pub fn stored_corners(&self, triangle: u32) -> Option<[[f32; 3]; 3]> {
        let corners = self.triangle(triangle).map(|v| self.positions[v as usize]);
        span_area(corners.map(widened)).then_some(corners)
    }

    /// The box around a triangle.
    pub fn element_bounds(&self, triangle: u32) -> Aabb {
        Aabb::from_points(self.corners(triangle))
    }

    /// Where the ray meets one triangle.
    #[inline]
    pub fn hit_element(&self, triangle: u32, shear: &RayShear, range: Interval) -> Option<PrimHit> {
        self.hit_local(triangle, &shear.relative_to(self.anchor), range)
    }

    /// [`TriangleMesh::hit_element`] for a shear relative to the anchor.
    #[inline]
    pub(super) fn hit_local(
        &self,
        triangle: u32,
        shear: &RayShear,
        range: Interval,
    ) -> Option<PrimHit> {
        let [a, b, c] = self.sheared_corners(triangle, shear);
        let hit = intersect_sheared(shear, a, b, c)?;
        (range.accepts(hit.t) && self.has_area(triangle)).then_some(PrimHit {
            t: hit.t,
            surface: SurfaceId {
                element: triangle,
                facet: 0,
            },
            uv: [hit.u, hit.v],
        })
    }

    /// The images of the corners under a shear relative to the anchor.
    #[inline]
    pub(super) fn sheared_corners(&self, triangle: u32, shear: &RayShear) -> [DVec3; 3] {
        self.triangle(triangle)
            .map(|v| shear.apply_f32(&self.positions[v as usize]))
    }

    /// Whether a ray of this direction sees the front of a triangle: the side of the normal that
    /// [`TriangleMesh::surface_at_element`] returns; `None` if it is seen so nearly edge-on that rounding might decide
    /// differently.
    #[inline]
    pub fn shows_front(&self, triangle: u32, direction: DVec3) -> Option<bool> {
        /// Far above the rounding of both, as a part of the magnitudes multiplied.
        const CERTAIN: f64 = 1e-12;
        let [a, b, c] = self.local_corners(triangle);
        let (to_b, to_c) = (b - a, c - a);
        let along = to_b.cross(to_c).dot(direction);
        let size = |v: DVec3| v.abs().element_sum();
        let certain = along.abs() > CERTAIN * size(to_b) * size(to_c) * size(direction);
        certain.then_some((along < 0.0) != self.flipped)
    }

    /// The surface of one triangle at barycentric coordinates, as reported in [`PrimHit::uv`].
    pub fn surface_at_element(&self, triangle: u32, uv: [f64; 2]) -> SurfacePoint {
        let [a, b, c] = self.local_corners(triangle);
        let (local, local_error) = combine(a, b, c, uv);
        let position = self.anchor + local;
        let normal = front_normal(a, b, c).unwrap_or_else(|| any_normal(a, b, c));
        let n_geom = if self.flipped { -normal } else { normal };
        let vertices = self.triangle(triangle).map(|v| v as usize);
        let mut point = SurfacePoint {
            position,
            position_error: local_error + position.abs() * ROUNDOFF,
            n_geom,
            n_shade: n_geom,
            uv: DVec2::from_array(uv),
            dpdu: b - a,
            dpdv: c - a,
        };
        if let Some(normals) = &self.normals {
            let corners = vertices.map(|v| DVec3::from(normals[v].map(f64::from)));
            point.n_shade = smooth_normal(corners, uv, n_geom);
        }
        if let Some(uvs) = &self.uvs {
            let corners = vertices.map(|v| DVec2::from(uvs[v].map(f64::from)));
            apply_uvs(&mut point, corners, uv);
        }
        point
    }

    /// A copy with the map applied to every vertex.
    ///
    /// Fronts stay the side to which the map carries them, so the outside of a closed mesh stays outside under mirrors
    /// too. Vertices are rounded to f32 again, in the manner of [`MeshData::from_f64`]; a mere shift moves the anchor
    /// and rounds only that. Normals go with the inverse transpose.
    ///
    /// # Errors
    /// A vertex gets too large for f32.
    pub fn transformed(&self, map: &Transform) -> Result<Self, GeometryError> {
        let mut copy = self.clone();
        if !map.is_translation() {
            copy.tree = LazyTree::default();
        }
        copy.flipped = self.flipped != map.mirrors();
        if map.is_translation() {
            copy.anchor = map.point_to_world(self.anchor);
        } else {
            let vertices: Vec<_> = self
                .positions
                .iter()
                .map(|&p| map.point_to_world(self.anchor + DVec3::from(p.map(f64::from))))
                .collect();
            let data = MeshData::from_f64(&vertices, Vec::new());
            copy.anchor = data.anchor;
            copy.positions = data.positions.into();
            copy.normals = self.normals.as_deref().map(|list| map_normals(list, map));
        }
        check_finite("vertex", &copy.positions)?;
        copy.bounds = bounds_of(copy.anchor, &copy.positions, &copy.indices);
        Ok(copy)
    }

    /// Says of every triangle whether its last two vertices are exchanged against the order in which they were written, which cameras
    /// made of meshes follow.
    #[must_use]
    pub fn with_exchanged(mut self, exchanged: Vec<bool>) -> Self {
        self.exchanged = exchanged.contains(&true).then(|| exchanged.into());
        self
    }

    /// Whether the last two vertices of a triangle are exchanged against the order in which they were written.
    pub fn is_exchanged(&self, triangle: u32) -> bool {
        let list = self.exchanged.as_deref().unwrap_or_default();
        list.get(triangle as usize).copied().unwrap_or(false)
    }

    /// The same surface with fronts and backs exchanged.
    #[must_use]
    pub fn turned_inside_out(mut self) -> Self {
        self.flipped = !self.flipped;
        self
    }

    #[inline]
    pub(super) const fn lazy_tree(&self) -> &LazyTree {
        &self.tree
    }

    #[inline]
    fn triangle(&self, triangle: u32) -> [u32; 3] {
        let found = self.indices.get(triangle as usize);
        // The constructor refuses meshes without triangles.
        *found.or(self.indices.last()).unwrap_or(&[0; 3])
    }

    #[inline]
    pub(super) fn local_corners(&self, triangle: u32) -> [DVec3; 3] {
        self.triangle(triangle)
            .map(|v| widened(self.positions[v as usize]))
    }

    /// Whether a triangle has an area; in the ray's projection rounding may give one to collinear corners.
    #[inline]
    pub(crate) fn has_area(&self, triangle: u32) -> bool {
        span_area(self.local_corners(triangle))
    }
}

/// A vertex in f64.
#[inline]
fn widened(vertex: [f32; 3]) -> DVec3 {
    DVec3::from(vertex.map(f64::from))
}

/// Whether a triangle is a surface.
#[inline]
fn span_area([a, b, c]: [DVec3; 3]) -> bool {
    (b - a).cross(c - a) != DVec3::ZERO || front_normal(a, b, c).is_some()
}

impl Primitive for TriangleMesh {
    fn kind(&self) -> &'static str {
        "mesh"
    }

    /// [`TriangleMesh::try_new`] has validated everything.
    fn validate(&self) -> Result<(), GeometryError> {
        Ok(())
    }

    fn bounds(&self) -> Aabb {
        self.bounds
    }

    fn elements(&self) -> u32 {
        self.triangle_count()
    }

    fn closest_hit(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        _scratch: &mut Scratch,
    ) -> Option<PrimHit> {
        let mut nearest: Option<PrimHit> = None;
        self.walk(ray, range, from, |hit, t_max| {
            let key = |hit: &PrimHit| (hit.t, hit.surface.element);
            if nearest.is_none_or(|best| key(&hit) < key(&best)) {
                nearest = Some(hit);
                hit.t
            } else {
                t_max
            }
        });
        nearest
    }

    fn any_hit(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        _scratch: &mut Scratch,
    ) -> bool {
        let mut found = false;
        self.walk(ray, range, from, |_, _| {
            found = true;
            f64::NEG_INFINITY
        });
        found
    }

    fn all_hits(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        _scratch: &mut Scratch,
        out: &mut Vec<PrimHit>,
    ) {
        let before = out.len();
        self.walk(ray, range, from, |hit, t_max| {
            out.push(hit);
            t_max
        });
        let found = &mut out[before..];
        found.sort_unstable_by(|a, b| {
            let elements = a.surface.element.cmp(&b.surface.element);
            a.t.total_cmp(&b.t).then(elements)
        });
        // Of several at one place the first is met.
        let mut last = f64::NEG_INFINITY;
        let mut kept = before;
        for index in before..out.len() {
            if out[index].t > last {
                last = out[index].t;
                out[kept] = out[index];
                kept += 1;
            }
        }
        out.truncate(kept);
    }

    fn surface_at(&self, _ray: &Ray, hit: &PrimHit) -> SurfacePoint {
        self.surface_at_element(hit.surface.element, hit.uv)
    }

    /// Triangles of a mesh without texture coordinates are mapped by 0, as in POV-Ray.
    fn texture_uv(&self, _hit: &PrimHit, uv: DVec2) -> Option<DVec2> {
        Some(if self.uvs.is_some() { uv } else { DVec2::ZERO })
    }

    /// Any map will do, within the rounding of f32 (see [`TriangleMesh::transformed`]).
    fn baked(&self, map: &Transform) -> Option<Shape> {
        self.transformed(map).ok().map(|mesh| Arc::new(mesh).into())
    }
}

/// The box of the vertices that triangles use.
fn bounds_of(anchor: DVec3, positions: &[[f32; 3]], indices: &[[u32; 3]]) -> Aabb {
    let used = indices.iter().flatten();
    let local = used.filter_map(|&v| positions.get(v as usize));
    let bounds = Aabb::from_points(local.map(|p| DVec3::from(p.map(f64::from))));
    Aabb::new(anchor + bounds.min, anchor + bounds.max)
}

/// Normals carried by the inverse transpose, all divided by one number to stay in the range of f32: as long as their lengths
/// keep their ratios, interpolation and the map may be exchanged.
fn map_normals(normals: &[[f32; 3]], map: &Transform) -> Box<[[f32; 3]]> {
    let mapped = || {
        normals
            .iter()
            .map(|&n| map.normal_to_world(DVec3::from(n.map(f64::from))))
    };
    let largest = mapped().fold(0.0, |m: f64, n| m.max(n.abs().max_element()));
    let scale = if largest > 0.0 { largest } else { 1.0 };
    mapped().map(|n| (n / scale).as_vec3().to_array()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conformance::Random;
    use crate::mesh::samples::{Unbaked, cube, torus};
    use crate::primitive::one_by_one;

    fn closest(mesh: &impl Primitive, ray: &Ray) -> Option<(PrimHit, SurfacePoint)> {
        let hit = mesh.closest_hit(ray, Interval::FORWARD, None, &mut Scratch::default())?;
        Some((hit, mesh.surface_at(ray, &hit)))
    }

    #[test]
    fn which_side_is_shown_is_what_the_normal_says() {
        let mut random = Random::new(5);
        let (mut certain, mut fronts) = (0, 0);
        let ring = || TriangleMesh::try_new(torus(12, 8, 1.0, 0.4)).expect("a torus");
        for mesh in [ring(), ring().turned_inside_out()] {
            for triangle in 0..mesh.triangle_count() {
                let n = mesh.surface_at_element(triangle, [0.3, 0.3]).n_geom;
                let edge = mesh.local_corners(triangle)[1] - mesh.local_corners(triangle)[0];
                assert_eq!(mesh.shows_front(triangle, edge), None, "edge-on");
                for _ in 0..10 {
                    let d = random.direction() * 7.0;
                    if let Some(front) = mesh.shows_front(triangle, d) {
                        assert_eq!(front, n.dot(d) < 0.0);
                        certain += 1;
                        fronts += u32::from(front);
                    }
                }
            }
        }
        assert!(
            fronts > certain / 3 && fronts < certain * 2 / 3,
            "{fronts} of {certain}"
        );
    }

    #[test]
    fn bad_data_is_named() {
        let two = |index| MeshData {
            positions: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
            indices: vec![[0, 1, 2], [0, 1, index]],
            ..MeshData::default()
        };
        let error = |data| {
            TriangleMesh::try_new(data)
                .expect_err("bad data")
                .to_string()
        };
        assert_eq!(error(two(7)), "vertex index 7 is out of range: there are 3");
        let mut nan = two(2);
        nan.positions[1][2] = f32::NAN;
        assert_eq!(error(nan), "vertex 1 is not finite");
        let normals = MeshData {
            normals: Some(vec![[0.0; 3]; 2]),
            ..two(2)
        };
        assert_eq!(error(normals), "2 normals given, 3 expected");
        let uvs = MeshData {
            uvs: Some(vec![[0.0, f32::INFINITY]; 3]),
            ..two(2)
        };
        assert_eq!(error(uvs), "texture coordinate of vertex 0 is not finite");
        let lines = MeshData {
            face_lines: Some(vec![1]),
            ..two(2)
        };
        assert_eq!(error(lines), "1 face lines given, 2 expected");
        assert!(TriangleMesh::try_new(MeshData::default()).is_err());
        let huge = MeshData::from_f64(
            &[DVec3::ZERO, DVec3::X, DVec3::splat(1e200)],
            vec![[0, 1, 2]],
        );
        assert_eq!(error(huge), "vertex 2 is not finite");
    }

    #[test]
    fn a_cube_is_hit_where_it_should_be() {
        let data = MeshData {
            face_materials: Some((0..12).collect()),
            face_lines: Some((0..12).map(|i| 100 + i).collect()),
            ..cube()
        };
        let mesh = TriangleMesh::try_new(data).expect("a mesh");
        let ray = Ray::new(DVec3::new(0.25, 0.5, -4.0), DVec3::Z * 2.0);
        let (hit, point) = closest(&mesh, &ray).expect("a hit");
        assert_eq!((hit.t, point.n_geom), (1.5, -DVec3::Z));
        assert_eq!(point.position, DVec3::new(0.25, 0.5, -1.0));
        let element = hit.surface.element;
        assert_eq!(mesh.face_material(element), Some(element as u16));
        assert_eq!(mesh.face_line(element), Some(100 + element));
        assert_eq!(mesh.face_line(99), None);

        // The starting triangle is left out, its neighbour in the same plane is not in front.
        let inside = Ray::new(point.position, DVec3::Z);
        let next = mesh.closest_hit(
            &inside,
            Interval::FORWARD,
            Some(hit.surface),
            &mut Scratch::default(),
        );
        assert_eq!(next.map(|hit| hit.t), Some(2.0));
        assert_eq!(mesh.bounds(), Aabb::new(DVec3::splat(-1.0), DVec3::ONE));
        assert_eq!((mesh.triangle_count(), mesh.degenerate_count()), (12, 0));
    }

    #[test]
    fn the_tree_finds_what_a_look_at_every_triangle_finds() {
        let far = Transform::translate(DVec3::new(900.0, -20.0, 3.0));
        let ring = TriangleMesh::try_new(torus(24, 16, 1.0, 0.4)).expect("a torus");
        let moved = ring.transformed(&far).expect("a shift");
        let turned = ring
            .transformed(&Transform::rotate(DVec3::X, 1.0))
            .expect("a turn");
        let mut random = Random::new(11);
        let mut met = 0;
        for mesh in [ring, moved, turned] {
            let center = mesh.bounds().center();
            for _ in 0..3000 {
                let ray = Ray::new(center + random.cube() * 2.0, random.direction());
                let range = Interval::new(random.between(-1.0, 0.5), random.between(0.5, 4.0));
                let from = (random.below(2) == 0).then(|| SurfaceId {
                    element: random.below(u64::from(mesh.triangle_count())) as u32,
                    facet: 0,
                });
                let shear = RayShear::new(&ray);
                let nearest = (0..mesh.triangle_count())
                    .filter(|element| from.is_none_or(|from| from.element != *element))
                    .filter_map(|element| mesh.hit_element(element, &shear, range))
                    .min_by(|a, b| a.t.total_cmp(&b.t));
                let mut scratch = Scratch::default();
                let found = mesh.closest_hit(&ray, range, from, &mut scratch);
                assert_eq!(found, nearest, "{ray:?}");
                let (mut all, mut alone) = (vec![], vec![]);
                mesh.all_hits(&ray, range, from, &mut scratch, &mut all);
                one_by_one(&mesh, &ray, range, from, &mut scratch, &mut alone);
                assert_eq!(all, alone, "{ray:?}");
                let any = mesh.any_hit(&ray, range, from, &mut scratch);
                assert_eq!(any, nearest.is_some(), "{ray:?}");
                met += u32::from(any);
            }
        }
        assert!(met > 1000, "{met}");
    }

    #[test]
    fn ties_go_to_the_smaller_element_and_any_hit_agrees() {
        let mesh = TriangleMesh::try_new(cube()).expect("a mesh");
        // Along the diagonal of two faces, which all four triangles share in pairs.
        let ray = Ray::new(DVec3::new(0.0, 0.0, -3.0), DVec3::Z);
        let shear = RayShear::new(&ray);
        let hits: Vec<_> = (0..12)
            .filter_map(|i| mesh.hit_element(i, &shear, Interval::FORWARD))
            .collect();
        assert_eq!(
            hits.iter().map(|hit| hit.t).collect::<Vec<_>>(),
            [2.0, 2.0, 4.0, 4.0]
        );
        let first = closest(&mesh, &ray).expect("a hit").0;
        assert_eq!(first, hits[0]);
        let short = Interval::new(0.0, 2.0f64.next_down());
        assert!(!mesh.any_hit(&ray, short, None, &mut Scratch::default()));
        assert!(mesh.any_hit(&ray, Interval::new(0.0, 2.0), None, &mut Scratch::default()));
    }

    #[test]
    fn triangles_without_area_are_never_hit() {
        let data = MeshData {
            // Two equal corners; three on a line, in such numbers that a sheared image is not on one.
            positions: vec![
                [0.0; 3],
                [1.0, 0.0, 0.0],
                [0.1, 0.2, 0.3],
                [0.2, 0.4, 0.6],
                [0.4, 0.8, 1.2],
            ],
            indices: vec![[0, 1, 1], [2, 3, 4]],
            ..MeshData::default()
        };
        let mesh = TriangleMesh::try_new(data).expect("degenerate triangles are allowed");
        assert_eq!(mesh.degenerate_count(), 2);
        let mut random = Random::new(9);
        for _ in 0..20_000 {
            let [a, _, c] = mesh.corners(1);
            let target = a + (c - a) * random.between(0.0, 1.0);
            let origin = random.cube() * 3.0;
            let ray = Ray::new(origin, target - origin);
            assert_eq!(closest(&mesh, &ray), None);
        }
        let along = Ray::new(DVec3::new(0.5, 0.0, -1.0), DVec3::Z);
        assert_eq!(closest(&mesh, &along), None);
    }

    #[test]
    fn maps_carry_fronts_normals_and_textures_along() {
        let mut data = torus(12, 8, 2.0, 0.7);
        data.uvs = Some(data.positions.iter().map(|p| [p[0] + p[2], p[1]]).collect());
        // Out of the tube, a little aside.
        let tube = |p: &[f32; 3]| {
            let round = p[0].hypot(p[1]);
            [
                p[0] * (1.0 - 2.0 / round),
                p[1] * (1.0 - 2.0 / round),
                p[2] + 0.1,
            ]
        };
        data.normals = Some(data.positions.iter().map(tube).collect());
        let mesh = TriangleMesh::try_new(data).expect("a mesh");
        let turn = Transform::rotate(DVec3::new(1.0, 2.0, 3.0), 0.6);
        for stretch in [DVec3::new(1.0, 0.5, 2.0), DVec3::new(-3.0, 1.0, 1.0)] {
            let map = Transform::try_scale(stretch)
                .expect("regular")
                .then(&turn)
                .then(&Transform::translate(DVec3::new(3.0, 4.0, 5.0)));
            let mapped = mesh.baked(&map).expect("any map will do");
            let mut hits = 0;
            let mut random = Random::new(2);
            for _ in 0..500 {
                let (origin, target) = (random.direction() * 6.0, random.cube() * 2.0);
                let ray = Ray::new(origin, target - origin);
                let Some((hit, inner)) = closest(&mesh, &ray) else {
                    continue;
                };
                let outer = Ray::new(
                    map.point_to_world(origin),
                    map.vector_to_world(ray.direction),
                );
                let Some((other, point)) = closest(&mapped, &outer) else {
                    continue;
                };
                if other.surface != hit.surface
                    || ray.direction.normalize().dot(inner.n_geom).abs() < 0.1
                {
                    continue;
                }
                hits += 1;
                // Vertices were rounded to f32.
                let near = |a: DVec3, b: DVec3| assert!((a - b).length() < 1e-5, "{a} {b}");
                near(point.position, map.point_to_world(inner.position));
                near(point.n_geom, map.normal_to_world(inner.n_geom).normalize());
                near(
                    point.n_shade,
                    map.normal_to_world(inner.n_shade).normalize(),
                );
                near(point.dpdu, map.vector_to_world(inner.dpdu));
                near(point.dpdv, map.vector_to_world(inner.dpdv));
                assert!((point.uv - inner.uv).length() < 1e-5);
            }
            assert!(hits > 100, "{hits}");
        }
    }

    #[test]
    fn anchors_keep_the_detail_of_small_meshes_far_away() {
        let far = DVec3::new(1e9, 2e9, -1e9);
        let corners = [DVec3::ZERO, DVec3::X * 0.3, DVec3::Y * 0.3].map(|p| p + far);
        let mesh =
            TriangleMesh::try_new(MeshData::from_f64(&corners, vec![[0, 1, 2]])).expect("a mesh");
        for (found, given) in mesh.corners(0).iter().zip(corners) {
            assert!(
                (*found - given).abs().max_element() <= 2e9 * f64::EPSILON,
                "{found} {given}"
            );
        }
        // What f32 holds is kept without an anchor.
        let exact = [[1e6f32, 0.0, 0.0], [1e6 + 1.0, 0.0, 0.0], [1e6, 1.0, 0.0]];
        let vertices = exact.map(|p| DVec3::from(p.map(f64::from)));
        let data = MeshData::from_f64(&vertices, vec![[0, 1, 2]]);
        assert_eq!((data.anchor, data.positions), (DVec3::ZERO, exact.to_vec()));
    }

    #[test]
    fn a_shift_is_exact() {
        let mesh = TriangleMesh::try_new(cube()).expect("a mesh");
        let moved = mesh
            .transformed(&Transform::translate(DVec3::splat(0.1)))
            .expect("in range");
        assert_eq!(moved.positions(), mesh.positions());
        assert_eq!(moved.anchor(), DVec3::splat(0.1));
        assert!(
            mesh.transformed(&Transform::try_scale(DVec3::splat(1e39)).expect("regular"))
                .is_err()
        );
    }

    fn tried(data: MeshData) -> Unbaked {
        Unbaked(Arc::new(TriangleMesh::try_new(data).expect("a mesh")))
    }

    crate::primitive_tests!(cube_mesh, || tried(cube()));
    crate::primitive_tests!(torus_mesh, || tried(torus(9, 6, 1.0, 0.4)));
}
