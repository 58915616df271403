//! Meshes that are wrong, ugly or large.

use super::*;

fn refused(change: impl FnOnce(&mut SubdivisionData)) -> String {
    let mut data = cube();
    change(&mut data);
    Subdivision::try_new(&data)
        .map(|_| ())
        .expect_err("a bad mesh")
        .to_string()
}

#[test]
fn bad_meshes_are_refused_with_the_reason() {
    type Change = Box<dyn FnOnce(&mut SubdivisionData)>;
    let cases: [(&str, Change); 18] = [
        (
            "vertex of the subdivision surface 3 is not finite",
            Box::new(|d| d.points[3].y = f64::NAN),
        ),
        (
            "vertex of the subdivision surface 0 is not finite",
            Box::new(|d| d.points[0].x = f64::INFINITY),
        ),
        ("at most 1e70", Box::new(|d| d.points[1] *= 1e80)),
        (
            "it has no faces",
            Box::new(|d| (d.sizes, d.indices) = (vec![], vec![])),
        ),
        (
            "from 3 to 10000, found 2",
            Box::new(|d| {
                d.sizes.push(2);
                d.indices.extend([0, 1]);
            }),
        ),
        (
            "3 for Loop's scheme, found 4",
            Box::new(|d| d.scheme = Loop),
        ),
        ("24 expected", Box::new(|d| d.indices.extend([0, 1]))),
        (
            "index 8 is out of range: there are 8",
            Box::new(|d| d.indices[5] = 8),
        ),
        ("face 0 has vertex 0 twice", Box::new(|d| d.indices[1] = 0)),
        (
            "3 faces meet at the edge between the vertices 0 and 1",
            Box::new(|d| {
                d.points.push(DVec3::splat(3.0));
                d.sizes.push(3);
                d.indices.extend([0, 1, 8]);
            }),
        ),
        (
            "turn different sides to the front",
            Box::new(|d| d.indices[0..4].reverse()),
        ),
        (
            "the crease between the vertices 0 and 7 (counted from 0) is not an edge",
            Box::new(|d| {
                d.creases.push(([0, 7], 1.0));
            }),
        ),
        (
            "greater, 10 and more for sharp for ever, found -1",
            Box::new(|d| d.creases.push(([0, 1], -1.0))),
        ),
        ("found NaN", Box::new(|d| d.corners.push((2, f64::NAN)))),
        (
            "vertex of a crease or corner of the subdivision surface index 9",
            Box::new(|d| d.corners.push((9, 1.0))),
        ),
        ("24 expected", Box::new(|d| d.uvs = vec![DVec2::ZERO; 3])),
        (
            "texture coordinate of the subdivision surface 2 is not finite",
            Box::new(|d| {
                d.uvs = vec![DVec2::ZERO; 24];
                d.uvs[2].x = f64::NAN;
            }),
        ),
        (
            "lie on a line",
            Box::new(|d| d.points.iter_mut().for_each(|p| *p = DVec3::X * p.x)),
        ),
    ];
    for (expected, change) in cases {
        let message = refused(change);
        assert!(message.contains(expected), "{message:?} for {expected:?}");
    }
}

#[test]
fn vertices_without_faces_are_ignored() {
    let mut data = cube();
    data.points.push(DVec3::splat(1e6));
    let (with, without) = (surface(&data), surface(&cube()));
    assert_eq!(with.bounds(), without.bounds());
}

/// Two cubes that touch in a vertex, an edge of coinciding vertices, faces without area, two faces back to back.
#[test]
fn ugly_meshes_are_met() {
    let mut touching = cube();
    let other = cube();
    touching
        .points
        .extend(other.points.iter().skip(1).map(|p| *p + DVec3::splat(2.0)));
    // Vertex 0 of the second is vertex 7 of the first.
    let renamed = other
        .indices
        .iter()
        .map(|i| if *i == 0 { 7 } else { i + 7 });
    touching.indices.extend(renamed);
    touching.sizes.extend(&other.sizes);
    let mut collapsed = cube();
    collapsed.points[1] = collapsed.points[0];
    let mut flat = cube();
    for point in &mut flat.points {
        point.z = 0.0;
    }
    let pillow = SubdivisionData::new(
        CatmullClark,
        cube().points[..4].to_vec(),
        [[0, 1, 3, 2], [0, 2, 3, 1]],
    );
    let mut random = Random::new(2);
    for (number, data) in [touching, collapsed, flat, pillow].iter().enumerate() {
        let surface = surface(data);
        for round in 0..2000 {
            let to = match round % 3 {
                0 => random.cube(),
                1 => data.points[random.below(data.points.len() as u64) as usize],
                _ => DVec3::new(0.0, 0.0, random.unit()),
            };
            let from = random.cube() * 4.0;
            // Where two layers coincide they are one hit, but two passes.
            let list = surface.passes(&Ray::new(from, to - from));
            let sum: i32 = list.iter().map(|pass| pass.sign).sum();
            assert_eq!(sum, 0, "mesh {number}: {from} {to} {list:?}");
        }
    }
}

/// Faces that touch in a vertex only stay together there, as in OpenSubdiv: it is a corner of them. Their limits came apart.
#[test]
fn faces_that_touch_in_a_vertex_stay_together() {
    let mut random = Random::new(6);
    for scheme in [CatmullClark, Loop] {
        // Two closed meshes that have a vertex in common, and two triangles, like a bow tie.
        let one = tetrahedron(scheme);
        let mut touching = one.clone();
        touching.points.extend(
            one.points
                .iter()
                .skip(1)
                .map(|p| *p * -1.0 + one.points[0] * 2.0),
        );
        let other = one.indices.iter().map(|i| if *i == 0 { 0 } else { i + 3 });
        touching.indices.extend(other);
        touching.sizes.extend(&one.sizes);
        // The point mirror turns its faces.
        for face in touching.indices[12..].chunks_mut(3) {
            face.reverse();
        }
        let points = (0..5).map(|_| random.cube()).collect();
        let bow = SubdivisionData::new(scheme, points, [[0, 1, 2], [0, 3, 4]]);
        for data in [touching, bow] {
            let surface = surface(&data);
            let mut met = vec![];
            for element in 0..surface.elements() {
                let [u, v] = [0.0, 1.0];
                for uv in [[u, u], [v, u], [u, v]] {
                    let ([point, ..], _) = jet(&surface, element, uv);
                    if (point - data.points[0]).length() < 1e-13 {
                        met.push(element);
                        break;
                    }
                }
            }
            let faces = data.indices.iter().filter(|i| **i == 0).count();
            assert_eq!(met.len(), faces, "{scheme:?}: {met:?}");
        }
    }
}

/// A torus of 10^5 faces is there within seconds and 100 MB, and grows by what rays see of it.
#[test]
fn a_hundred_thousand_faces_are_no_trouble() {
    let count = 317_u32;
    let angle = |i: u32| std::f64::consts::TAU * f64::from(i) / f64::from(count);
    let points = (0..count * count).map(|k| {
        let (a, b) = (angle(k % count), angle(k / count));
        let r = 1.0 + 0.4 * b.cos();
        DVec3::new(r * a.cos(), 0.4 * b.sin(), r * a.sin())
    });
    let at = |i: u32, j: u32| (j % count) * count + i % count;
    let faces = (0..count * count).map(|k| {
        let (i, j) = (k % count, k / count);
        [at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)]
    });
    let surface = surface(&SubdivisionData::new(CatmullClark, points.collect(), faces));
    assert_eq!(surface.elements(), 100_489);
    let before = surface.bytes();
    assert!(before < 100_000_000, "{before}");
    let torus = crate::Torus::new(DVec3::ZERO, DVec3::Y, 1.0, 0.4);
    let mut random = Random::new(1);
    for _ in 0..300 {
        let (from, to) = (random.cube() * 4.0, random.cube());
        let ray = Ray::new(from, to - from);
        let (a, b) = (hits(&surface, &ray), hits(&torus, &ray));
        let grazes = b.iter().any(|hit| {
            let n = torus.surface_at(&ray, hit).n_geom;
            n.dot(ray.direction.normalize()).abs() < 0.1
        });
        if !grazes {
            assert_eq!(a.len(), b.len(), "{ray:?}");
            assert!(a.iter().zip(&b).all(|(a, b)| (a.t - b.t).abs() < 1e-3));
        }
    }
    assert!(surface.bytes() < before + 10_000_000);
}
