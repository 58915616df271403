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
    all.extend(creases::ends().into_iter().map(|(data, _)| data));
    all.iter().map(surface).collect()
}

/// What goes wrong at one surface: rays that miss the border, those that don't leave the solid once more than they enter it (or
/// of which the nearest hit is not the first pass), and those of which the line does not leave as often as it enters; with the
/// parameters of the last one.
type Wrong = ([usize; 3], [f64; 2]);

/// Rays from within and through closed surfaces, in 16 parts for as many threads; those that go wrong, by the number of the surface.
fn shoot(rays: usize, seed: u64) -> Vec<(usize, Wrong)> {
    let subjects = subjects();
    let parts: Vec<Vec<Wrong>> = std::thread::scope(|scope| {
        let start = |part: u64| {
            let subjects = &subjects;
            scope.spawn(move || shoot_part(subjects, rays / 16, seed * 16 + part))
        };
        let threads: Vec<_> = (0..16).map(start).collect();
        let ends = threads.into_iter().map(|thread| thread.join());
        ends.map(|end| end.expect("no panic")).collect()
    });
    let wrong = (0..subjects.len()).flat_map(|number| {
        let all = parts.iter().map(move |part| (number, part[number]));
        all.filter(|(_, (counts, _))| *counts != [0; 3])
    });
    wrong.collect()
}

fn shoot_part(subjects: &[Subdivision], rays: usize, seed: u64) -> Vec<Wrong> {
    let mut random = Random::new(seed);
    let mut all = vec![([0; 3], [0.0; 2]); subjects.len()];
    for _ in 0..rays {
        let number = random.below(subjects.len() as u64) as usize;
        let surface = &subjects[number];
        let element = random.below(u64::from(surface.elements())) as u32;
        let uv = place(surface.cage.scheme(), &mut random);
        let ([target, ..], _) = jet(surface, element, uv);
        let origin = match random.below(3) {
            0 => DVec3::ZERO,
            _ => random.cube() * 0.05,
        };
        let ray = Ray::new(origin, (target - origin) * random.between(0.1, 10.0));
        let passes = surface.passes_in_order(&ray);
        let sum = |from: f64, to: f64| -> i32 {
            let within = passes.iter().filter(|p| p.hit.t > from && p.hit.t <= to);
            within.map(|pass| pass.sign).sum()
        };
        let first = surface.closest_hit(&ray, Interval::FORWARD, None, &mut Scratch::default());
        let expected = passes.iter().map(|p| p.hit.t).find(|t| *t > 0.0);
        let is_near = |pass: &&Pass| (ray.at(pass.hit.t) - target).length() < 1e-7;
        let near = passes.iter().filter(is_near).count();
        // Corner 6 of the cube has no creases: it is the tip of a cone that becomes ever thinner, and rays there are beside it.
        let is_tip = number < 2 && (target - surface.data().points[6]).length() < 1e-6;
        let wrong = [
            near == 0 && !is_tip,
            sum(0.0, f64::INFINITY).abs() != 1 || first.map(|hit| hit.t) != expected,
            sum(f64::NEG_INFINITY, f64::INFINITY) != 0,
        ];
        let (counts, place) = &mut all[number];
        for (count, is_wrong) in counts.iter_mut().zip(wrong) {
            *count += usize::from(is_wrong);
        }
        if wrong.contains(&true) {
            *place = uv;
        }
    }
    all
}

#[test]
fn no_ray_slips_through_a_border_or_meets_two_patches() {
    assert_eq!(shoot(48_000, 1), []);
}

/// The long version, for releases: 10^7 rays on all processors.
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
