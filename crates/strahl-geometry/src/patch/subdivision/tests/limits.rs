//! Points and normals against those of dense meshes.

use super::oracle::Mesh;
use super::*;

/// All meshes of the tests, with the valence of their poles.
fn subjects() -> Vec<SubdivisionData> {
    let mut all = vec![
        cube(),
        tetrahedron(CatmullClark),
        tetrahedron(Loop),
        sheet(CatmullClark),
        sheet(Loop),
        creased(CatmullClark),
        creased(Loop),
        lidded(),
    ];
    for around in [3, 4, 5, 6, 7, 8, 50] {
        for scheme in [CatmullClark, Loop] {
            all.push(ball(scheme, around, 2, u64::from(around)));
        }
    }
    all
}

#[test]
fn points_and_normals_are_those_of_a_dense_mesh() {
    for (number, data) in subjects().iter().enumerate() {
        let surface = surface(data);
        let mut mesh = Mesh::new(data);
        let levels = if data.points.len() > 60 { 3 } else { 4 };
        for _ in 0..levels {
            mesh = mesh.refined();
        }
        let (limits, normals) = (mesh.limits(), mesh.normals());
        let mut seen = 0;
        for face in &mesh.faces {
            for (corner, uv) in face.corners.iter().zip(&face.uv) {
                let ([point, by_u, by_v], front) = jet(&surface, face.element, uv.to_array());
                // The mesh is only near the limit at the end of a crease.
                let (expected, limit) = match limits[*corner as usize] {
                    Some(limit) => (limit, 1e-13),
                    None => (mesh.points[*corner as usize], 0.02),
                };
                assert!(
                    (point - expected).length() < limit,
                    "subject {number}, element {}, {uv}: {point} {expected}",
                    face.element
                );
                let Some((normal, valence)) = normals[*corner as usize] else {
                    continue;
                };
                let front = front.expect("a normal");
                // Around many faces the surface is wavy at all scales.
                let limit = if valence > 8 { 0.7 } else { 0.9999 };
                let cosine = front.dot(normal);
                assert!(
                    cosine > limit,
                    "subject {number}, element {}, {uv}: {cosine}",
                    face.element
                );
                // At other vertices the derivatives by the face's parameters vanish or have no bound.
                if valence == if data.scheme == Loop { 6 } else { 4 } {
                    let cosine = by_u.cross(by_v).normalize().dot(normal);
                    assert!(cosine > limit, "subject {number}: {cosine}");
                }
                seen += 1;
            }
        }
        assert!(seen > 300, "subject {number}: {seen}");
    }
}

/// Hits are on the surface that the parameters describe, and rays from far away find what those nearby find.
#[test]
fn hits_are_at_their_parameters() {
    let mut random = Random::new(17);
    for data in subjects() {
        let surface = surface(&data);
        let mut found = 0;
        for _ in 0..300 {
            let element = random.below(u64::from(surface.elements())) as u32;
            let mut uv = [random.unit(), random.unit()];
            if data.scheme == Loop && uv[0] + uv[1] > 1.0 {
                uv = uv.map(|x| 1.0 - x);
            }
            let ([target, by_u, by_v], _) = jet(&surface, element, uv);
            let direction = random.direction();
            let normal = by_u.cross(by_v).normalize();
            if normal.dot(direction).abs() < 0.1 {
                continue;
            }
            let ray = Ray::new(target - direction * random.between(0.1, 3.0), direction);
            let list = hits(&surface, &ray);
            let near = |hit: &&PrimHit| (ray.at(hit.t) - target).length() < 1e-12;
            let hit = list.iter().find(near);
            let hit = hit.unwrap_or_else(|| panic!("{ray:?} {list:?}"));
            let at = surface.surface_at(&ray, hit);
            assert!((at.position - target).length() < 1e-12);
            assert!(at.n_geom.dot(normal).abs() > 1.0 - 1e-6);
            found += 1;
        }
        assert!(found > 200, "{found}");
    }
}

/// The box of what is left at the last level is small, whatever the valence: the bound that the documentation gives.
#[test]
fn what_is_left_around_a_vertex_is_tiny() {
    for around in [3, 4, 5, 6, 7, 8, 50, 400] {
        for scheme in [CatmullClark, Loop] {
            let data = ball(scheme, around, 1, 9);
            let cage = Cage::try_new(&data).expect("a good mesh");
            let mut ring = cage.ring(0);
            if ring.is_leaf() {
                // Regular: nothing is left.
                assert_eq!(around, if scheme == Loop { 6 } else { 4 });
                continue;
            }
            while !ring.is_leaf() {
                let depth = |k: &usize| ring.corners[*k].depth();
                let deepest = (0..ring.corners.len()).max_by_key(depth);
                ring = ring.children().swap_remove(deepest.expect("a corner"));
            }
            let size = ring.hull().size().length();
            let least = 2.0_f64.powi(-28);
            assert!(size < least, "{scheme:?} {around}: {size}");
            assert!(size > 1e-11, "{scheme:?} {around}: {size}");
        }
    }
}

/// A surface of the moved mesh is the moved surface.
#[test]
fn affine_maps_move_the_surface_with_its_mesh() {
    let turned = Transform::rotate(DVec3::new(1.0, 0.3, 0.7), 0.8);
    let map = Transform::try_scale(DVec3::new(1.0, -0.3, 2.0))
        .expect("a map")
        .then(&turned)
        .then(&Transform::try_scale(DVec3::new(0.5, 1.0, 0.8)).expect("a map"))
        .then(&Transform::translate(DVec3::new(3.0, -1.0, 0.5)));
    for data in [creased(CatmullClark), creased(Loop), sheet(Loop)] {
        let mut moved = data.clone();
        for point in &mut moved.points {
            *point = map.point_to_world(*point);
        }
        let (ours, theirs) = (surface(&data), surface(&moved));
        let mut random = Random::new(7);
        for _ in 0..500 {
            let element = random.below(u64::from(ours.elements())) as u32;
            let uv = [random.unit() * 0.5, random.unit() * 0.5];
            let [p, by_u, by_v] = jet(&ours, element, uv).0;
            let [q, by_x, by_y] = jet(&theirs, element, uv).0;
            assert!((map.point_to_world(p) - q).length() < 1e-13);
            assert!((map.vector_to_world(by_u) - by_x).length() < 1e-12);
            assert!((map.vector_to_world(by_v) - by_y).length() < 1e-12);
        }
    }
}
