//! Rays aimed exactly at the borders of faces and of the patches around irregular vertices: none may slip through, none may
//! meet two patches.

use super::*;

/// Parameters on a border: of the face, of a patch of some level, or at a vertex.
fn place(scheme: SubdivisionScheme, random: &mut Random) -> [f64; 2] {
    let level = 1_u64 << random.below(9);
    let dyadic = |random: &mut Random| random.below(level + 1) as f64 / level as f64;
    let border = dyadic(random);
    let along = match random.below(4) {
        0 => border,
        1 => dyadic(random),
        2 => random.unit() * border,
        _ => random.unit(),
    };
    let [u, v] = match random.below(3) {
        0 => [border, along],
        1 => [along, border],
        _ => [border * along, border * (1.0 - along)],
    };
    if scheme == Loop && u + v > 1.0 {
        [1.0 - u, 1.0 - v]
    } else {
        [u, v]
    }
}

fn subjects() -> Vec<Subdivision> {
    let mut all = vec![
        creased(CatmullClark),
        creased(Loop),
        lidded(),
        tetrahedron(CatmullClark),
        tetrahedron(Loop),
    ];
    for around in [3, 4, 5, 6, 7, 8, 50] {
        all.extend([CatmullClark, Loop].map(|scheme| ball(scheme, around, 2, 4)));
    }
    all.iter().map(surface).collect()
}

/// Rays from within and through closed surfaces: those that miss the border, those that meet it twice or leave the surface
/// an even number of times, and those of which the line meets it an odd number of times. With the number of the surface, and
/// the parameters of the last one.
fn shoot(rays: usize, seed: u64) -> Vec<(usize, [usize; 3], [f64; 2])> {
    let mut random = Random::new(seed);
    let subjects = subjects();
    let mut all = vec![([0; 3], [0.0; 2]); subjects.len()];
    for _ in 0..rays {
        let number = random.below(subjects.len() as u64) as usize;
        let surface = &subjects[number];
        let element = random.below(u64::from(surface.elements())) as u32;
        let uv = place(surface.cage.scheme(), &mut random);
        let ([target, ..], _) = surface.node(element).expect("one").jet(uv);
        let origin = match random.below(3) {
            0 => DVec3::ZERO,
            _ => random.cube() * 0.05,
        };
        let ray = Ray::new(origin, (target - origin) * random.between(0.1, 10.0));
        let list = hits(surface, &ray);
        let forward = list.iter().filter(|hit| hit.t > 0.0).count();
        let is_near = |hit: &&PrimHit| (ray.at(hit.t) - target).length() < 1e-7;
        let near = list.iter().filter(is_near).count();
        let wrong = [
            near == 0,
            near > 1 && near % 2 == 0 || forward % 2 == 0,
            list.len() % 2 == 1,
        ];
        let (counts, place) = &mut all[number];
        for (count, is_wrong) in counts.iter_mut().zip(wrong) {
            *count += usize::from(is_wrong);
        }
        if wrong.contains(&true) {
            *place = uv;
        }
    }
    let numbered = all.into_iter().enumerate();
    numbered
        .map(|(number, (counts, place))| (number, counts, place))
        .filter(|(_, counts, _)| *counts != [0; 3])
        .collect()
}

#[test]
fn no_ray_slips_through_a_border_or_meets_two_patches() {
    assert_eq!(shoot(100_000, 1), []);
}

/// The long version, for releases: 10^7 rays, some minutes.
#[test]
#[ignore = "takes minutes; run it with --ignored"]
fn no_ray_of_ten_millions_slips_through_a_border() {
    assert_eq!(shoot(10_000_000, 2), []);
}

/// The border of a patch, as the neighbours know it, is closed: each curve begins where the one before it ends, to the last bit.
#[test]
fn rays_in_a_plane_of_symmetry_are_no_exception() {
    let surface = surface(&cube());
    let mut random = Random::new(8);
    for k in 0..2000 {
        let axis = k % 3;
        let [mut from, mut to] = [random.cube() * 3.0, random.cube() * 0.5];
        let coordinate = [0.0, 0.25, 0.5][random.below(3) as usize];
        from[axis] = coordinate;
        to[axis] = coordinate;
        let list = hits(&surface, &Ray::new(from, to - from));
        assert!(list.len().is_multiple_of(2), "{from} {to} {list:?}");
        assert!(list.len() == 2 || to.length() > 0.5, "{from} {to} {list:?}");
    }
}
