//! Tests of subdivision surfaces, and the meshes they use.

mod borders;
mod creases;
mod hostile;
mod limits;
mod many;
mod oracle;
mod silhouettes;

use super::*;
use crate::conformance::Random;
use crate::{Csg, CsgNode, Sphere};
use SubdivisionScheme::{CatmullClark, Loop};

pub(super) fn surface(data: &SubdivisionData) -> Subdivision {
    Subdivision::try_new(data).expect("a good mesh")
}

pub(super) fn cube() -> SubdivisionData {
    let points = (0..8).map(|k| {
        let at = |bit: u32| f64::from((k >> bit) & 1) * 2.0 - 1.0;
        DVec3::new(at(0), at(1), at(2))
    });
    let faces = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    SubdivisionData::new(CatmullClark, points.collect(), faces)
}

pub(super) fn tetrahedron(scheme: SubdivisionScheme) -> SubdivisionData {
    let points = [
        [1.0, 1.0, 1.0],
        [-1.0, -1.0, 1.0],
        [-1.0, 1.0, -1.0],
        [1.0, -1.0, -1.0],
    ];
    let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
    SubdivisionData::new(scheme, points.map(DVec3::from_array).to_vec(), faces)
}

/// A closed mesh about the y axis, out of round, with this many faces around both poles: triangles at the poles, and rings of
/// quadrilaterals between, or pairs of triangles for Loop's scheme.
pub(super) fn ball(
    scheme: SubdivisionScheme,
    around: u32,
    rings: u32,
    seed: u64,
) -> SubdivisionData {
    let mut random = Random::new(seed);
    let mut points = vec![DVec3::new(0.03, -1.0, 0.02)];
    for j in 1..=rings {
        let latitude = std::f64::consts::PI * (f64::from(j) / f64::from(rings + 1) - 0.5);
        for i in 0..around {
            let longitude = -std::f64::consts::TAU * f64::from(i) / f64::from(around);
            let on_sphere = DVec3::new(
                latitude.cos() * longitude.cos(),
                latitude.sin(),
                latitude.cos() * longitude.sin(),
            );
            points.push(on_sphere + random.cube() * (0.4 / f64::from(around)));
        }
    }
    points.push(DVec3::new(-0.05, 1.1, 0.04));
    let top = points.len() as u32 - 1;
    let at = |j: u32, i: u32| 1 + (j - 1) * around + i % around;
    let mut faces: Vec<Vec<u32>> = vec![];
    for i in 0..around {
        faces.push(vec![0, at(1, i + 1), at(1, i)]);
        faces.push(vec![top, at(rings, i), at(rings, i + 1)]);
        for j in 1..rings {
            let [a, b] = [at(j, i), at(j, i + 1)];
            let [d, c] = [at(j + 1, i), at(j + 1, i + 1)];
            match scheme {
                CatmullClark => faces.push(vec![a, b, c, d]),
                Loop => faces.extend([vec![a, b, c], vec![a, c, d]]),
            }
        }
    }
    SubdivisionData::new(scheme, points, faces)
}

/// An open sheet of quadrilaterals (or triangles) with a corner cut off and a hole.
pub(super) fn sheet(scheme: SubdivisionScheme) -> SubdivisionData {
    let mut random = Random::new(12);
    let count = 6;
    let points = (0..count * count).map(|k| {
        let (i, j) = (k % count, k / count);
        let at = |i: u32| 0.4 * f64::from(i) - 1.0;
        DVec3::new(at(i), at(j), random.between(-0.4, 0.4))
    });
    let points: Vec<_> = points.collect();
    let mut faces: Vec<Vec<u32>> = vec![];
    for k in (0..count * (count - 1)).filter(|k| k % count + 1 < count) {
        if [0, 2 * count + 2].contains(&k) {
            continue;
        }
        let [a, b, d, c] = [k, k + 1, k + count, k + count + 1];
        match scheme {
            CatmullClark if k == 3 * count + 3 => faces.extend([vec![a, b, c], vec![a, c, d]]),
            CatmullClark => faces.push(vec![a, b, c, d]),
            Loop => faces.extend([vec![a, b, c], vec![a, c, d]]),
        }
    }
    SubdivisionData::new(scheme, points, faces)
}

/// A cube with creases of all kinds.
pub(super) fn creased(scheme: SubdivisionScheme) -> SubdivisionData {
    let mut data = cube();
    if scheme == Loop {
        let quads = std::mem::take(&mut data.indices);
        let triangles = quads
            .chunks(4)
            .flat_map(|q| [[q[0], q[1], q[2]], [q[0], q[2], q[3]]]);
        data = SubdivisionData::new(scheme, data.points, triangles);
    }
    data.creases = vec![
        ([0, 1], 0.5),
        ([1, 3], 1.0),
        ([3, 2], 2.3),
        ([2, 0], f64::INFINITY),
        ([4, 5], 1.5),
        ([0, 4], 2.0),
        ([5, 7], 0.0),
    ];
    data.corners = vec![(7, 1.4), (6, 10.0)];
    data
}

/// A cube with a sharp top, which is a flat disc.
pub(super) fn lidded() -> SubdivisionData {
    let mut data = cube();
    data.creases = [[4, 5], [5, 7], [7, 6], [6, 4]]
        .map(|edge| (edge, f64::INFINITY))
        .to_vec();
    data
}

/// A cube that stays one: all edges are sharp for ever.
fn boxed() -> SubdivisionData {
    let mut data = cube();
    let edges = (0..8_u32).flat_map(|a| [1, 2, 4].map(|bit| [a, a ^ bit]));
    data.creases = edges.filter(|[a, b]| a < b).map(|e| (e, 10.0)).collect();
    data
}

/// The point at parameters of an element, its derivatives, and the normal.
pub(super) fn jet(
    surface: &Subdivision,
    element: u32,
    uv: [f64; 2],
) -> ([DVec3; 3], Option<DVec3>) {
    let spot = Spot::at(surface.cage.scheme(), uv);
    surface.node(element).expect("an element").jet(spot)
}

/// All hits of a line, one after the other. Along needles that are thinner than rounding errors there may be a hundred.
pub(super) fn hits(shape: &impl Primitive, ray: &Ray) -> Vec<PrimHit> {
    let scratch = &mut Scratch::default();
    let (mut range, mut list) = (Interval::LINE, vec![]);
    while let Some(hit) = shape.closest_hit(ray, range, None, scratch) {
        assert!(list.len() < 1000, "{ray:?} {list:?}");
        list.push(hit);
        range.min = hit.t;
    }
    list
}

crate::primitive_tests!(rounded_cube, || surface(&cube()));
crate::primitive_tests!(loop_tetrahedron, || surface(&tetrahedron(Loop)));
crate::primitive_tests!(tetrahedron_of_quadrilaterals, || surface(&tetrahedron(
    CatmullClark
)));
crate::primitive_tests!(ball_of_quadrilaterals, || surface(&ball(
    CatmullClark,
    5,
    3,
    1
)));
crate::primitive_tests!(ball_of_triangles, || surface(&ball(Loop, 7, 3, 2)));
crate::primitive_tests!(open_quadrilaterals, || surface(&sheet(CatmullClark)));
crate::primitive_tests!(open_triangles, || surface(&sheet(Loop)));
crate::primitive_tests!(cube_with_creases, || surface(&creased(CatmullClark)));
crate::primitive_tests!(triangles_with_creases, || surface(&creased(Loop)));
crate::primitive_tests!(cube_with_a_lid, || surface(&lidded()));
crate::primitive_tests!(with_texture_coordinates, || {
    let mut data = ball(CatmullClark, 4, 2, 3);
    let mut random = Random::new(5);
    data.uvs = data
        .indices
        .iter()
        .map(|_| DVec2::new(random.unit(), random.unit()))
        .collect();
    surface(&data)
});

#[test]
fn closed_meshes_are_solids_and_their_normals_point_outwards() {
    for data in [cube(), tetrahedron(Loop), creased(CatmullClark)] {
        let mut inside_out = data.clone();
        inside_out.indices.reverse();
        inside_out.sizes.reverse();
        for data in [data, inside_out] {
            let solid = surface(&data);
            let inner = solid.as_solid().expect("closed");
            assert!(inner.contains(DVec3::splat(0.1)) && !inner.contains(DVec3::splat(0.99)));
            let ray = Ray::new(DVec3::new(0.05, 0.07, 5.0), -DVec3::Z);
            let list = hits(&solid, &ray);
            assert_eq!(list.len(), 2, "{list:?}");
            assert!(solid.surface_at(&ray, &list[0]).n_geom.z > 0.0);
            assert!(solid.surface_at(&ray, &list[1]).n_geom.z < 0.0);
        }
    }
    for open in [sheet(CatmullClark), sheet(Loop)] {
        assert!(surface(&open).as_solid().is_none());
    }
}

/// The front of an open mesh is where its faces run counter-clockwise, also behind a mirror.
#[test]
fn the_front_of_an_open_mesh_stays_where_it_is() {
    let sheet = surface(&sheet(CatmullClark));
    let ray = Ray::new(DVec3::new(0.51, 0.52, 5.0), -DVec3::Z);
    let normal = |shape: &dyn Primitive| {
        let hit = shape.closest_hit(&ray, Interval::FORWARD, None, &mut Scratch::default());
        shape.surface_at(&ray, &hit.expect("a hit")).n_geom
    };
    assert!(normal(&sheet).z > 0.0);
    let mirror = Transform::try_scale(DVec3::new(1.0, 1.0, -1.0)).expect("a map");
    let mirrored = sheet.baked(&mirror).expect("a shape");
    assert!(normal(&mirrored).z < 0.0);
}

/// With all edges sharp the limit is the mesh itself.
#[test]
fn a_cube_of_sharp_edges_is_a_cube() {
    let (ours, theirs) = (
        surface(&boxed()),
        crate::Cuboid::new(DVec3::splat(-1.0), DVec3::splat(1.0)),
    );
    let mut random = Random::new(3);
    for _ in 0..5000 {
        let (from, to) = (random.cube() * 4.0, random.cube());
        let ray = Ray::new(from, to - from);
        let (a, b) = (hits(&ours, &ray), hits(&theirs, &ray));
        assert_eq!(a.len(), b.len(), "{ray:?}");
        for (a, b) in a.iter().zip(&b) {
            assert!((a.t - b.t).abs() < 1e-12);
            let [m, n] = [ours.surface_at(&ray, a), theirs.surface_at(&ray, b)];
            assert!(m.n_geom.dot(n.n_geom) > 1.0 - 1e-12, "{m:?} {n:?}");
        }
    }
}

/// A subdivision surface in a tree of solids: a point is in the difference if it is in one and not in the other.
#[test]
fn closed_meshes_are_cut() {
    let (cube, ball) = (surface(&cube()), Sphere::new(DVec3::splat(0.4), 0.6));
    let tree = Csg::try_new(CsgNode::difference([
        CsgNode::leaf(surface(&tests::cube()), 0),
        CsgNode::leaf(ball.clone(), 1),
    ]))
    .expect("solids");
    let tree = tree.as_solid().expect("a solid");
    let (mut random, mut inside) = (Random::new(61), 0);
    for _ in 0..4000 {
        let point = random.cube();
        let expected = cube.contains(point) && !ball.contains(point);
        assert_eq!(tree.contains(point), expected, "{point}");
        inside += usize::from(expected);
    }
    assert!((200..2000).contains(&inside), "{inside}");
}
