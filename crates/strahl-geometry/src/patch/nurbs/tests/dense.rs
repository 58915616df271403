//! Surfaces and their trimming against dense samples that the textbook's recursion gives: silhouettes, and loops of curves on curved surfaces.

use super::*;
use crate::patch::shadow::{Shadow, sight};
use std::ops::{Add, Mul};

/// The basis function `i` of a degree at `t` (de Boor 1972, Cox 1972), by its definition.
fn basis(knots: &[f64], degree: usize, i: usize, t: f64) -> f64 {
    if degree == 0 {
        return f64::from(u8::from(knots[i] <= t && t < knots[i + 1]));
    }
    // A part of no width counts as nothing: its basis function is 0.
    let ratio = |a: f64, b: f64| if b > 0.0 { a / b } else { 0.0 };
    let rising = ratio(t - knots[i], knots[i + degree] - knots[i]);
    let end = knots[i + degree + 1];
    let falling = ratio(end - t, end - knots[i + 1]);
    rising * basis(knots, degree - 1, i, t) + falling * basis(knots, degree - 1, i + 1, t)
}

/// The mean of points with these weights.
fn mean<P: Copy + Default + Add<Output = P> + Mul<f64, Output = P>>(
    parts: impl Iterator<Item = (P, f64)>,
) -> P {
    let (sum, weight) = parts.fold((P::default(), 0.0), |(sum, weight), (p, w)| {
        (sum + p * w, weight + w)
    });
    sum * (1.0 / weight)
}

/// All basis functions of a direction at `t`, which is below the last knot.
fn bases(knots: &[f64], degree: u32, t: f64) -> Vec<f64> {
    let degree = degree as usize;
    let count = knots.len() - degree - 1;
    (0..count).map(|i| basis(knots, degree, i, t)).collect()
}

/// The parameters of the surface, `from..to` along both directions.
fn domain(data: &NurbsData) -> [[f64; 2]; 2] {
    std::array::from_fn(|k| {
        let (knots, degree) = (&data.knots[k], data.degree[k] as usize);
        [knots[degree], knots[knots.len() - degree - 1]]
    })
}

/// The point of the surface with these basis functions along both directions.
fn point(data: &NurbsData, along_u: &[f64], along_v: &[f64]) -> DVec3 {
    let columns = along_u.len();
    mean(data.points.iter().enumerate().map(|(k, p)| {
        let weight = data.weights.get(k).copied().unwrap_or(1.0);
        (*p, weight * along_u[k % columns] * along_v[k / columns])
    }))
}

/// The point of a curve.
fn curve_point(curve: &NurbsCurve, t: f64) -> DVec2 {
    let bases = bases(&curve.knots, curve.degree, t);
    mean(curve.points.iter().enumerate().map(|(k, p)| {
        let weight = curve.weights.get(k).copied().unwrap_or(1.0);
        (*p, weight * bases[k])
    }))
}

/// How many samples a closed surface has along each direction.
const SIDE: u32 = 160;

/// A surface that is closed in both directions, seen along a direction.
fn shadow(data: &NurbsData, direction: DVec3) -> Shadow {
    let [along_u, along_v]: [Vec<Vec<f64>>; 2] = std::array::from_fn(|k| {
        let [from, to] = domain(data)[k];
        let at = |i| from + (to - from) * f64::from(i) / f64::from(SIDE);
        (0..SIDE)
            .map(|i| bases(&data.knots[k], data.degree[k], at(i)))
            .collect()
    });
    let rows = along_v.iter();
    let points: Vec<DVec3> = rows
        .flat_map(|v| along_u.iter().map(move |u| point(data, u, v)))
        .collect();
    let mut triangles = vec![];
    for j in 0..SIDE {
        for i in 0..SIDE {
            let at = |i: u32, j: u32| (j % SIDE) * SIDE + i % SIDE;
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    Shadow::new(&points, triangles, direction)
}

/// Tori: a round one, and some out of round, one of them rational.
fn subjects() -> Vec<NurbsData> {
    let mut random = Random::new(51);
    let mut all = vec![torus()];
    for degree in [[2, 2], [2, 3], [3, 4], [5, 3]] {
        let mut data = periodic(degree, &mut random);
        if degree == [3, 4] {
            // Control points that repeat repeat their weights.
            let weight = |p: &DVec3| 1.0 + 0.4 * (5.0 * p.x + 3.0 * p.z).sin();
            data.weights = data.points.iter().map(weight).collect();
        }
        all.push(data);
    }
    all
}

/// Beside its silhouette, inside and outside, a line meets the surface as often as there are layers of the dense mesh, as soon as it is
/// further from the mesh's own silhouette than the mesh is from the surface.
#[test]
fn lines_beside_a_silhouette_meet_as_many_layers_as_a_dense_mesh_has() {
    let mut random = Random::new(52);
    for (number, data) in subjects().iter().enumerate() {
        let surface = nurbs(data);
        let mut seen = [0; 2];
        for _ in 0..3 {
            let direction = random.direction();
            let shadow = shadow(data, direction);
            // More than the sag of the sides of the dense mesh, whose curves have radii of more than 0.1.
            let sag = 2e-3;
            for _ in 0..300 {
                let place = shadow.beside_a_rim(&mut random, sag);
                if shadow.distance(place) < sag {
                    continue;
                }
                let expected = shadow.layers(place);
                let ray = sight(direction, place);
                assert_eq!(
                    hits(&surface, &ray).len(),
                    expected,
                    "subject {number}: {ray:?}, {} from the rim",
                    shadow.distance(place)
                );
                seen[usize::from(expected > 0)] += 1;
            }
        }
        assert!(seen.iter().all(|n| *n > 80), "subject {number}: {seen:?}");
    }
}

/// From a place over the surface outwards, halved down to 1e-6: on one side of the border the surface is met at all distances, on the
/// other it is not, and where it ends it is seen from its edge.
#[test]
fn silhouettes_have_one_border() {
    let mut random = Random::new(53);
    for (number, data) in subjects().iter().enumerate() {
        let surface = nurbs(data);
        for _ in 0..60 {
            let direction = random.direction();
            let part = &surface.parts[random.below(surface.parts.len() as u64) as usize];
            let [start, ..] = part.patch.jet(random.unit(), random.unit());
            let out = direction.cross(random.direction()).normalize();
            let at = |way: f64| Ray::new(start + out * way - direction * 8.0, direction);
            let count = |way: f64| hits(&surface, &at(way)).len();
            let (mut inside, mut outside) = (0.0, 6.0);
            for _ in 0..22 {
                let middle = 0.5 * (inside + outside);
                let found = count(middle);
                assert!(found % 2 == 0, "subject {number}: {:?}", at(middle));
                if found > 0 {
                    inside = middle;
                } else {
                    outside = middle;
                }
            }
            // Around the border nothing else changes, at any scale.
            for k in 3..10 {
                let step = 2.0_f64.powi(-k) * 1e-3;
                let (beyond, within) = (count(outside + step), count(inside - step));
                assert!(
                    beyond == 0 && within > 0 && within % 2 == 0,
                    "subject {number}, {step} from the border: {beyond} {within} {:?}",
                    at(inside)
                );
            }
            let ray = at(inside - 1e-6);
            let n = surface.surface_at(&ray, &hits(&surface, &ray)[0]).n_geom;
            assert!(n.dot(direction).abs() < 2e-2, "subject {number}: {n}");
        }
    }
}

/// A closed curve of this degree around a centre, smooth where it closes, out of round.
fn blot(degree: u32, center: DVec2, radius: f64, random: &mut Random) -> NurbsCurve {
    let corners = 9;
    let loose: Vec<DVec2> = (0..corners)
        .map(|k| {
            let way = DVec2::from_angle(TAU * f64::from(k) / f64::from(corners));
            center + way * radius * random.between(0.7, 1.3)
        })
        .collect();
    let count = loose.len() + degree as usize;
    // Some of the knots are close to each other.
    let (mut knots, mut at) = (vec![], 0.0);
    for k in 0..count + degree as usize + 1 {
        knots.push(at);
        at += if k % 9 == 3 { 0.1 } else { 1.0 };
    }
    NurbsCurve {
        degree,
        knots,
        points: (0..count).map(|k| loose[k % loose.len()]).collect(),
        weights: vec![],
    }
}

/// On a curved surface, cut out by smooth curves of several degrees: a ray at one of its points meets it there if, and only if, the point's
/// parameters are within a polygon of many points of the curves.
#[test]
fn curved_surfaces_are_there_where_dense_polygons_of_their_loops_say() {
    let mut random = Random::new(54);
    let scratch = &mut Scratch::default();
    for degree in [2, 3, 5] {
        let data = hills([3, 2 + degree % 3], 8, 7, u64::from(degree));
        let [[_, wide], [_, high]] = domain(&data);
        let middle = DVec2::new(wide, high) * 0.5;
        let size = middle.min_element();
        let curves = [
            blot(degree, middle, 0.8 * size, &mut random),
            blot(degree, middle + size * 0.1, 0.35 * size, &mut random),
            blot(3, middle - size * 0.5, 0.3 * size, &mut random),
        ];
        // From where a curve closes smoothly to the same place.
        let range = |curve: &NurbsCurve| {
            [
                curve.knots[curve.degree as usize],
                curve.knots[curve.points.len()],
            ]
        };
        let polygons = curves.each_ref().map(|curve| {
            let [from, to] = range(curve);
            let at = |k| from + (to - from) * f64::from(k) / 4000.0;
            (0..4000)
                .map(|k| curve_point(curve, at(k)))
                .collect::<Vec<_>>()
        });
        let loops = curves.each_ref().map(|curve| TrimLoop {
            curves: vec![curve.between(range(curve)).unwrap()],
            is_hole: false,
        });
        let surface = Nurbs::try_trimmed(&data, &loops).unwrap();
        let (mut there, mut missing) = (0, 0);
        for _ in 0..6000 {
            // Often near a loop.
            let polygon = &polygons[random.below(3) as usize];
            let near = polygon[random.below(polygon.len() as u64) as usize];
            let off = 10.0_f64.powf(random.between(-5.0, 0.0));
            let at = near + DVec2::from_angle(random.between(0.0, TAU)) * off;
            if !(at.cmpgt(DVec2::ZERO).all() && at.x < wide && at.y < high) {
                continue;
            }
            // Nearer the polygon is not the curve.
            if polygons.iter().any(|polygon| distance(polygon, at) < 1e-5) {
                continue;
            }
            let expected = polygons
                .iter()
                .filter(|polygon| is_within(polygon, at))
                .count()
                % 2
                == 1;
            let target = point(
                &data,
                &bases(&data.knots[0], data.degree[0], at.x),
                &bases(&data.knots[1], data.degree[1], at.y),
            );
            let direction = (DVec3::NEG_Z + random.cube() * 0.5).normalize();
            let ray = Ray::new(target - direction, direction);
            let range = Interval::new(1.0 - 1e-9, 1.0 + 1e-9);
            let found = surface.any_hit(&ray, range, None, scratch);
            assert_eq!(found, expected, "degree {degree}, parameters {at}: {ray:?}");
            there += usize::from(found);
            missing += usize::from(!found);
        }
        assert!(there > 1000 && missing > 1000, "{there} {missing}");
    }
}

/// The sides of a polygon.
fn sides(polygon: &[DVec2]) -> impl Iterator<Item = (DVec2, DVec2)> + '_ {
    let next = polygon.iter().cycle().skip(1);
    polygon.iter().zip(next).map(|(a, b)| (*a, *b))
}

/// How far a point is from a polygon's sides.
fn distance(polygon: &[DVec2], p: DVec2) -> f64 {
    let to_side = |(a, b): (DVec2, DVec2)| {
        let along = b - a;
        let part = (p - a).dot(along) / along.length_squared().max(1e-300);
        (a + along * part.clamp(0.0, 1.0) - p).length()
    };
    sides(polygon).map(to_side).fold(f64::INFINITY, f64::min)
}

/// Whether a point is within a polygon: a ray to the right crosses an odd number of sides.
fn is_within(polygon: &[DVec2], p: DVec2) -> bool {
    let crossed = sides(polygon).filter(|(a, b)| {
        (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)
    });
    crossed.count() % 2 == 1
}
