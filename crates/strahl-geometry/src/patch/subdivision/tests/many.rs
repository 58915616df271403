//! Vertices with many edges, and faces with many corners.

use super::*;

/// A drum about the y axis, out of round: two faces with this many corners, and quadrilaterals between.
pub(super) fn drum(around: u32) -> SubdivisionData {
    let mut random = Random::new(u64::from(around));
    let points = (0..2 * around).map(|k| {
        let angle = -std::f64::consts::TAU * f64::from(k % around) / f64::from(around);
        let y = if k < around { -1.0 } else { 1.0 };
        DVec3::new(angle.cos(), y, angle.sin()) + random.cube() * (0.4 / f64::from(around))
    });
    let points: Vec<DVec3> = points.collect();
    let mut faces: Vec<Vec<u32>> =
        vec![(0..around).rev().collect(), (around..2 * around).collect()];
    faces.extend((0..around).map(|i| {
        let next = (i + 1) % around;
        vec![i, next, around + next, around + i]
    }));
    SubdivisionData::new(CatmullClark, points, faces)
}

/// A hash of points, derivatives and normals at the corners, borders and middles of some elements.
fn bits(data: &SubdivisionData) -> u64 {
    let surface = surface(data);
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    let mut add = |value: f64| hash = (hash ^ value.to_bits()).wrapping_mul(0x0100_0000_01b3);
    let count = surface.elements();
    for element in (0..count).step_by((count as usize / 5).max(1)) {
        for uv in [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.3, 0.6], [1e-7, 2e-7]] {
            let (jet, normal) = jet(&surface, element, uv);
            for vector in jet.into_iter().chain(normal) {
                vector.to_array().into_iter().for_each(&mut add);
            }
        }
    }
    let bounds = surface.bounds();
    let ends = [bounds.min, bounds.max];
    ends.iter().flat_map(DVec3::to_array).for_each(&mut add);
    hash
}

#[test]
fn surfaces_with_few_and_many_edges_at_a_vertex_keep_their_bits() {
    let mut all = vec![];
    for around in 3..=50 {
        all.push(bits(&ball(CatmullClark, around, 2, u64::from(around))));
        all.push(bits(&ball(Loop, around, 2, u64::from(around))));
        all.push(bits(&drum(around)));
        let mut open = drum(around);
        open.indices.drain(..around as usize);
        open.sizes.remove(0);
        open.creases = (0..around)
            .step_by(3)
            .map(|i| ([i, around + i], f64::from(i)))
            .collect();
        all.push(bits(&open));
    }
    for data in [
        creased(CatmullClark),
        creased(Loop),
        sheet(CatmullClark),
        sheet(Loop),
    ] {
        all.push(bits(&data));
    }
    let hash = all
        .iter()
        .fold(0_u64, |sum, bits| sum.rotate_left(7) ^ bits);
    assert_eq!(hash, 0x4b02_12e6_c58e_e887, "{hash:#x}");
}

/// Surfaces with crowded vertices: smooth ones, one at the border, and one with a crease that ends there.
fn crowded() -> Vec<SubdivisionData> {
    let mut random = Random::new(8);
    let mut all = vec![drum(170)];
    for scheme in [CatmullClark, Loop] {
        let mut uneven = ball(scheme, 170, 2, 4);
        for point in &mut uneven.points {
            *point *= random.between(0.5, 1.5);
        }
        let mut open = uneven.clone();
        // Every third face is at the lower pole, or every fourth.
        let step = open.sizes.len() / 170;
        let faces = open.sizes.len() - 30 * step;
        let corners = open.sizes[..faces].iter().sum::<u32>() as usize;
        open.sizes.truncate(faces);
        open.indices.truncate(corners);
        let mut dart = uneven.clone();
        dart.creases = vec![([0, 1], 10.0), ([0, 50], 2.5)];
        all.extend([uneven, open, dart]);
    }
    all
}

/// Boxes around parts of faces at crowded vertices, which don't ask what is far away, have all of the surface within.
#[test]
fn parts_at_crowded_vertices_are_within_their_boxes() {
    let mut random = Random::new(31);
    for (number, data) in crowded().iter().enumerate() {
        let surface = surface(data);
        for _ in 0..40 {
            let element = random.below(u64::from(surface.elements()));
            let mut ring = surface.cage.ring(element as usize);
            let mut place = Place::WHOLE;
            while !ring.is_leaf() && ring.level < 20 {
                let hull = node::bounds(&ring).union(&ring.hull());
                let loose = hull.padded(hull.size() * 1e-6 + 1e-13);
                for _ in 0..10 {
                    let u = random.unit();
                    let spot = Spot::at(data.scheme, [u, random.unit() * (1.0 - u)]);
                    let spot = place.outer(spot);
                    let node = surface.node(element as u32).expect("an element");
                    let ([point, ..], _) = node.jet(spot);
                    let outside = (loose.min - point).max(point - loose.max).max_element();
                    assert!(outside <= 0.0, "{number}: {element} {place:?} {outside}");
                }
                let corner = (0..ring.corners.len()).max_by_key(|k| ring.corners[*k].depth());
                let corner = corner.expect("a corner");
                place = place.part(Place::of_child(data.scheme, corner));
                ring = ring.children().swap_remove(corner);
            }
        }
    }
}

/// Rays at points of the surface meet it there.
#[test]
fn rays_meet_faces_at_crowded_vertices() {
    let mut random = Random::new(32);
    for (number, data) in crowded().iter().enumerate() {
        let surface = surface(data);
        let mut found = 0;
        for _ in 0..60 {
            let element = random.below(u64::from(surface.elements())) as u32;
            let u = random.unit();
            let uv = [u, random.unit() * (1.0 - u)];
            let ([target, by_u, by_v], _) = jet(&surface, element, uv);
            let direction = random.direction();
            let normal = by_u.cross(by_v).normalize();
            if normal.dot(direction).abs() < 0.2 {
                continue;
            }
            let ray = Ray::new(target - direction * random.between(0.1, 3.0), direction);
            let is_met = hits(&surface, &ray)
                .iter()
                .any(|hit| (ray.at(hit.t) - target).length() < 1e-11);
            assert!(is_met, "{number}: {element} {uv:?}");
            found += 1;
        }
        assert!(found > 30, "{number}: {found}");
    }
}

/// A face with thousands of corners, or a vertex with as many edges, was not there after half a minute: its cost grew with the square or
/// more. Now what is there before rays come grows with the corners alone.
#[test]
fn thousands_of_corners_cost_what_they_are() {
    type Mesh = fn(u32) -> SubdivisionData;
    let meshes: [Mesh; 3] = [
        drum,
        |count| ball(CatmullClark, count, 1, 1),
        |count| ball(Loop, count, 1, 1),
    ];
    for mesh in meshes {
        let [few, many] = [1000, 4000].map(|count| surface(&mesh(count)));
        let (few, all) = (few.bytes(), many.bytes());
        assert!(all < few * 9 / 2, "{few} {all}");
        let mut random = Random::new(3);
        for _ in 0..10 {
            let (from, to) = (random.cube() * 4.0, random.cube() * 0.5);
            let list = many.passes(&Ray::new(from, to - from));
            assert_eq!(list.iter().map(|pass| pass.sign).sum::<i32>(), 0);
        }
    }
    let mut data = drum(10_001);
    let error = Subdivision::try_new(&data).expect_err("a face that is too wide");
    assert!(
        error.to_string().contains("from 3 to 10000, found 10001"),
        "{error}"
    );
    data = ball(CatmullClark, 10_001, 1, 1);
    let error = Subdivision::try_new(&data).expect_err("a vertex that is too crowded");
    assert!(error.to_string().contains("at most 10000"), "{error}");
}
