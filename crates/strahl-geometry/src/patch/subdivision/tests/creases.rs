//! Creases: their ends, rays that leave them, meshes full of them.

use super::*;
use strahl_math::error::offset_origin;

/// Ends of creases at vertices of valence 3 to 8, of both schemes, with the poles' numbers: a crease runs up to the lower pole and
/// ends there, another one through the upper one.
pub(super) fn ends() -> Vec<(SubdivisionData, [u32; 2])> {
    let mut all = vec![];
    for around in [3, 4, 5, 6, 7, 8] {
        for scheme in [CatmullClark, Loop] {
            let mut data = ball(scheme, around, 2, u64::from(around));
            let top = data.points.len() as u32 - 1;
            let line = [0, 1, 1 + around, top, top - 2];
            data.creases = line
                .windows(2)
                .map(|pair| ([pair[0], pair[1]], f64::INFINITY))
                .collect();
            all.push((data, [0, top]));
        }
    }
    all
}

/// A ball with edges of all sharpnesses, and some corners, anywhere.
pub(super) fn wrinkled(scheme: SubdivisionScheme, around: u32, seed: u64) -> SubdivisionData {
    let mut data = ball(scheme, around, 3, seed);
    let mut random = Random::new(seed);
    let mut start = 0;
    for size in data.sizes.clone() {
        let corners = &data.indices[start..start + size as usize];
        start += size as usize;
        for k in 0..corners.len() {
            let edge = [corners[k], corners[(k + 1) % corners.len()]];
            let sharpness = match random.below(8) {
                0 => f64::INFINITY,
                1 => random.between(0.0, 9.0),
                2 => random.below(4) as f64,
                _ => continue,
            };
            data.creases.push((edge, sharpness));
        }
    }
    for vertex in 0..data.points.len() as u32 {
        match random.below(12) {
            0 => data.corners.push((vertex, f64::INFINITY)),
            1 => data.corners.push((vertex, random.between(0.0, 4.0))),
            _ => {}
        }
    }
    data
}

/// Parameters of an element at its corner `corner`, so far from it.
fn near_corner(
    scheme: SubdivisionScheme,
    corner: usize,
    distance: f64,
    random: &mut Random,
) -> Spot {
    let u = random.unit();
    let [u, v] = match scheme {
        CatmullClark => [u, random.unit()],
        Loop => [u, random.unit() * (1.0 - u)],
    };
    let [u, v] = [u * distance, v * distance];
    match (scheme, corner) {
        (CatmullClark, _) => {
            let far = u32::from(corner == 1 || corner == 2) | u32::from(corner >= 2) << 1;
            Spot::of(scheme, far, [u, v])
        }
        (Loop, _) => Spot::of(scheme, corner as u32, [u, v]),
    }
}

/// Rays from within at the ends of sharp edges and at all scales around them: each meets something there, and the line leaves the
/// solid as often as it enters.
#[test]
fn rays_at_the_end_of_a_sharp_edge_find_it() {
    let mut random = Random::new(5);
    for (number, (data, poles)) in ends().iter().enumerate() {
        let surface = surface(data);
        for round in 0..300 {
            let element = random.below(u64::from(surface.elements())) as u32;
            let corner = random.below(if data.scheme == Loop { 3 } else { 4 }) as usize;
            let distance = match round % 4 {
                0 => 0.0,
                _ => random.magnitude(-13.0, 0.0),
            };
            let spot = near_corner(data.scheme, corner, distance, &mut random);
            let ([target, ..], _) = surface.node(element).expect("one").jet(spot);
            let ray = Ray::new(random.cube() * 0.1, DVec3::ZERO);
            let ray = Ray::new(ray.origin, target - ray.origin);
            let list = hits(&surface, &ray);
            let is_near = |hit: &&PrimHit| (hit.t - 1.0).abs() < 1e-7;
            let near = list.iter().filter(is_near).count();
            assert!(near > 0, "subject {number} {poles:?}: {ray:?} {list:?}");
            let sum: i32 = surface.passes(&ray).iter().map(|pass| pass.sign).sum();
            assert_eq!(sum, 0, "subject {number} {poles:?}: {ray:?}");
        }
    }
}

/// Rays that leave the surface near creases, at any angle, don't meet it again in the same spot.
#[test]
fn rays_that_leave_a_crease_do_not_meet_it_again() {
    let mut random = Random::new(6);
    let scratch = &mut Scratch::default();
    let mut all: Vec<SubdivisionData> = ends().into_iter().map(|(data, _)| data).collect();
    all.extend([creased(CatmullClark), creased(Loop), lidded()]);
    for (number, data) in all.iter().enumerate() {
        let surface = surface(data);
        for _ in 0..300 {
            let element = random.below(u64::from(surface.elements())) as u32;
            let corner = random.below(if data.scheme == Loop { 3 } else { 4 }) as usize;
            let distance = random.magnitude(-13.0, 0.0);
            let mut spot = near_corner(data.scheme, corner, distance, &mut random);
            if random.below(2) == 0 && data.scheme == CatmullClark {
                // Beside an edge.
                spot.0[0] = random.unit();
                spot.0[1] = 1.0 - spot.0[0];
            }
            let (facet, uv) = spot.told(data.scheme);
            let hit = PrimHit {
                t: 1.0,
                surface: SurfaceId { element, facet },
                uv,
            };
            let at = surface.surface_at(&Ray::new(DVec3::ZERO, DVec3::Y), &hit);
            // At the tip of a cone the surface has no side.
            let corners = data
                .corners
                .iter()
                .filter(|(_, sharpness)| *sharpness >= 10.0);
            let mut tips = corners.map(|(vertex, _)| data.points[*vertex as usize]);
            if tips.any(|tip| (tip - at.position).length() < 1e-5) {
                continue;
            }
            for side in [1.0, -1.0] {
                let n = at.n_geom * side;
                let origin = offset_origin(at.position, at.position_error, n);
                let tangent = random.direction().cross(n).normalize();
                // Around many faces the surface is wavy at all scales.
                let least = if data.points.len() > 14 { 0.02 } else { 1e-3 };
                for sine in [1.0, random.between(least, 1.0), 1e-1, least] {
                    let direction = n * sine + tangent * (1.0 - sine * sine).sqrt();
                    let ray = Ray::new(origin, direction);
                    let again = surface.closest_hit(&ray, Interval::FORWARD, None, scratch);
                    let spot = 8.0 * at.position_error.length() / sine;
                    assert!(
                        again
                            .is_none_or(|again| again.surface.element != element || again.t > spot),
                        "subject {number}: {ray:?} {hit:?} {again:?}"
                    );
                }
            }
        }
    }
}

/// Meshes full of creases of all kinds: every line leaves the solid as often as it enters, whatever it is aimed at.
#[test]
fn lines_through_wrinkled_balls_leave_as_often_as_they_enter() {
    let mut random = Random::new(7);
    for seed in 0..12 {
        let scheme = [CatmullClark, Loop][seed as usize % 2];
        let data = wrinkled(scheme, 3 + seed as u32 / 2, seed);
        let surface = surface(&data);
        for round in 0..150 {
            let element = random.below(u64::from(surface.elements())) as u32;
            let corner = random.below(if scheme == Loop { 3 } else { 4 }) as usize;
            let distance = if round % 4 == 0 {
                0.0
            } else {
                random.magnitude(-13.0, 0.0)
            };
            let spot = near_corner(scheme, corner, distance, &mut random);
            let ([target, ..], _) = surface.node(element).expect("one").jet(spot);
            let from = random.cube() * 3.0;
            let ray = Ray::new(from, target - from);
            let passes = surface.passes_in_order(&ray);
            let sum: i32 = passes.iter().map(|pass| pass.sign).sum();
            assert_eq!(sum, 0, "seed {seed}: {ray:?} {passes:?}");
        }
    }
}

/// The normals at irregular vertices are those of the points around them.
#[test]
fn normals_at_irregular_vertices_are_limits() {
    let mut all = vec![
        cube(),
        tetrahedron(CatmullClark),
        tetrahedron(Loop),
        lidded(),
    ];
    for around in [3, 4, 5, 6, 7, 8, 20] {
        all.extend([CatmullClark, Loop].map(|scheme| ball(scheme, around, 2, 4)));
    }
    all.extend(ends().into_iter().map(|(data, _)| data));
    let mut random = Random::new(8);
    for (number, data) in all.iter().enumerate() {
        let surface = surface(data);
        for element in 0..surface.elements() {
            for corner in 0..if data.scheme == Loop { 3 } else { 4 } {
                let mut normal = |distance: f64| {
                    let spot = near_corner(data.scheme, corner, distance, &mut random);
                    surface
                        .node(element)
                        .expect("one")
                        .jet(spot)
                        .1
                        .expect("a normal")
                };
                let at = normal(0.0);
                assert!((at.length() - 1.0).abs() < 1e-12);
                // They come closer with the distance; around many faces the surface is wavy at all scales.
                let (near, nearer) = ((normal(1e-4) - at).length(), (normal(1e-7) - at).length());
                let limit = if data.points.len() > 40 { 0.15 } else { 0.06 };
                assert!(
                    near < 3.0 * limit && nearer < limit,
                    "subject {number}, element {element}, corner {corner}: {near} {nearer}"
                );
            }
        }
    }
}
