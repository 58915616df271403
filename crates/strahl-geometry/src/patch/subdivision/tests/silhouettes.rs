//! Silhouettes against those of dense meshes: how often lines beside them meet the surface, and that their border is one.

use super::*;
use crate::patch::shadow::{Shadow, sight};
use oracle::Mesh;

/// The limit of a mesh divided so many times, seen along a direction.
fn shadow(data: &SubdivisionData, levels: u32, direction: DVec3) -> Shadow {
    let mesh = (0..levels).fold(Mesh::new(data), |mesh, _| mesh.refined());
    let limits = mesh.limits().into_iter().zip(&mesh.points);
    let points: Vec<DVec3> = limits
        .map(|(limit, point)| limit.unwrap_or(*point))
        .collect();
    let triangles = mesh.faces.iter().flat_map(|face| {
        let c = &face.corners;
        (2..c.len()).map(|k| [c[0], c[k - 1], c[k]])
    });
    Shadow::new(&points, triangles.collect(), direction)
}

fn subjects() -> Vec<SubdivisionData> {
    let mut all = vec![
        cube(),
        lidded(),
        tetrahedron(CatmullClark),
        tetrahedron(Loop),
    ];
    for around in [3, 5, 8] {
        all.extend([CatmullClark, Loop].map(|scheme| ball(scheme, around, 2, 4)));
    }
    all
}

/// Beside its silhouette, inside and outside, a line meets the surface as often as there are layers of the dense mesh, as soon as it
/// is further from the mesh's own silhouette than the mesh is from the surface.
#[test]
fn lines_beside_a_silhouette_meet_as_many_layers_as_a_dense_mesh_has() {
    let mut random = Random::new(31);
    let levels = 5;
    for (number, data) in subjects().iter().enumerate() {
        let surface = surface(data);
        let mut seen = [0; 2];
        for _ in 0..3 {
            let direction = random.direction();
            let shadow = shadow(data, levels, direction);
            // More than the sag of the sides of the dense mesh, where they are curved most.
            let sag = 4.0_f64.powi(-(levels as i32)) * 2.0;
            for _ in 0..400 {
                let place = shadow.beside_a_rim(&mut random, sag);
                if shadow.distance(place) < sag {
                    continue;
                }
                let expected = shadow.layers(place);
                let ray = sight(direction, place);
                let found = hits(&surface, &ray);
                assert_eq!(
                    found.len(),
                    expected,
                    "subject {number}: {ray:?}, {} from the rim",
                    shadow.distance(place)
                );
                seen[usize::from(expected > 0)] += 1;
            }
        }
        assert!(seen.iter().all(|n| *n > 100), "subject {number}: {seen:?}");
    }
}

/// From the inside of its silhouette to the outside, halved down to 1e-6: the surface is met until it is met no more, at all distances
/// from the border on both sides, and where it ends it is seen from its edge.
#[test]
fn silhouettes_have_one_border() {
    let mut random = Random::new(32);
    let mut wrong = vec![];
    for (number, data) in subjects().iter().enumerate() {
        let surface = surface(data);
        let direction = random.direction();
        for _ in 0..40 {
            let out = DVec2::from_angle(random.between(0.0, std::f64::consts::TAU));
            let at = |way: f64| sight(direction, out * way);
            let (mut inside, mut outside) = (0.0, 4.0);
            for _ in 0..22 {
                let middle = 0.5 * (inside + outside);
                let count = hits(&surface, &at(middle)).len();
                assert!(count % 2 == 0, "subject {number}: {:?}", at(middle));
                if count > 0 {
                    inside = middle;
                } else {
                    outside = middle;
                }
            }
            // Around the border nothing else changes, at any scale.
            for k in 0..10 {
                let step = 2.0_f64.powi(-k) * 1e-3;
                let count = |way: f64| hits(&surface, &at(way)).len();
                let (beyond, within) = (count(outside + step), count(inside - step));
                if beyond != 0 || within == 0 || within % 2 != 0 {
                    wrong.push((number, step, beyond, within, at(inside)));
                }
            }
            let ray = at(inside - 1e-6);
            let list = hits(&surface, &ray);
            let n = surface.surface_at(&ray, &list[0]).n_geom;
            let edge = n.dot(direction).abs();
            // At a crease the silhouette is the crease.
            let is_crease = !data.creases.is_empty();
            assert!(edge < 2e-2 || is_crease, "subject {number}: {edge}");
        }
    }
    assert!(wrong.is_empty(), "{wrong:?}");
}
