//! The boxes of what trimming leaves.

use super::*;

/// Surfaces and loops of all kinds: rings, holes, islands, loops that cross, reach beyond, run along sides and between patches.
fn subjects() -> Vec<(NurbsData, Vec<TrimLoop>)> {
    let polygon = |points: &[(f64, f64)], is_hole| {
        TrimLoop::polygon(points.iter().map(|p| DVec2::from(*p)).collect(), is_hole)
    };
    let hills = |seed: u64| hills([3, 3], 6, 5, seed);
    let at = DVec2::new;
    vec![
        (hills(1), vec![ring(at(1.5, 1.0), 0.8, false)]),
        (hills(2), vec![ring(at(1.5, 1.0), 0.8, true)]),
        (hills(3), vec![ring(at(1.1, 0.6), 0.05, false)]),
        (
            hills(4),
            vec![
                ring(at(1.5, 1.0), 0.95, false),
                ring(at(1.5, 1.0), 0.9, true),
            ],
        ),
        (
            hills(5),
            vec![
                ring(at(0.6, 1.0), 0.9, false),
                ring(at(1.4, 1.2), 0.7, false),
            ],
        ),
        (hills(6), vec![ring(at(3.0, 2.0), 0.7, false)]),
        (
            hills(7),
            vec![polygon(&[(0.1, 0.1), (2.9, 0.3), (0.2, 1.9)], false)],
        ),
        (
            hills(8),
            vec![polygon(
                &[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)],
                false,
            )],
        ),
        (
            hills(9),
            vec![polygon(
                &[(0.0, 0.0), (3.0, 0.0), (3.0, 0.5), (0.0, 0.5)],
                true,
            )],
        ),
        (
            hills(10),
            vec![
                polygon(&[(-1.0, -1.0), (5.0, -1.0), (5.0, 5.0), (-1.0, 5.0)], false),
                polygon(&[(0.7, -1.0), (5.0, -1.0), (5.0, 5.0), (0.7, 5.0)], true),
            ],
        ),
        (
            sphere(),
            vec![polygon(
                &[(0.5, 0.4), (3.7, 0.9), (3.1, 1.8), (1.0, 1.5)],
                false,
            )],
        ),
        (torus(), vec![ring(at(2.2, 1.7), 0.3, false)]),
        (torus(), vec![ring(at(2.2, 1.7), 1.6, true)]),
    ]
}

#[test]
fn what_trimming_leaves_is_within_its_boxes() {
    for (number, (data, loops)) in subjects().iter().enumerate() {
        let whole = nurbs(data);
        let trimmed = Nurbs::try_trimmed(data, loops).unwrap();
        let region = trimmed.trimming.as_ref().unwrap();
        let bounds = trimmed.bounds();
        let mut seen = 0;
        for k in 0..400 * 400 {
            let place = [k % 400, k / 400].map(|i| (f64::from(i) + 0.5) / 400.0);
            if !region.contains(place) {
                continue;
            }
            let is_at =
                |part: &&Part| (0..2).all(|k| (part.from[k]..part.to[k]).contains(&place[k]));
            let part = whole.parts.iter().find(is_at).unwrap();
            let local = [0, 1].map(|k| (place[k] - part.from[k]) / (part.to[k] - part.from[k]));
            let [point, ..] = part.patch.jet(local[0], local[1]);
            let own = trimmed.parts.iter().find(is_at).and_then(Part::bounds);
            let own = own.unwrap_or_else(|| panic!("{number}: {place:?}"));
            for all in [own, bounds] {
                let outside = (all.min - point).max(point - all.max).max_element();
                assert!(outside <= 0.0, "{number}: {place:?} {outside}");
            }
            seen += 1;
        }
        assert!(seen > 100, "{number}: {seen}");
    }
}

/// On a plane whose points are its parameters the boxes of the loops are known.
#[test]
fn boxes_of_trimmed_surfaces_are_close() {
    let grid = |columns: usize, rows: usize| {
        let points = (0..columns * rows)
            .map(|k| DVec3::new((k % columns) as f64, (k / columns) as f64, 0.0));
        data([1, 1], columns, points.collect())
    };
    let is_near = |surface: &Nurbs, [a, b]: [DVec2; 2], most: f64| {
        let Aabb { min, max } = surface.bounds();
        let off = (min.truncate() - a).abs().max((max.truncate() - b).abs());
        assert!(off.max_element() < most, "{min} {max}");
    };
    let circle = [ring(DVec2::new(1.5, 1.0), 0.8, false)];
    let round = [DVec2::new(0.7, 0.2), DVec2::new(2.3, 1.8)];
    let surface = Nurbs::try_trimmed(&grid(4, 3), &circle).unwrap();
    is_near(&surface, round, 1e-5);
    let turned = Transform::rotate(DVec3::Z, std::f64::consts::FRAC_PI_2);
    let baked = surface.baked(&turned).unwrap().bounds();
    assert!(
        (baked.min - DVec3::new(-1.8, 0.7, 0.0)).length() < 1e-5,
        "{baked:?}"
    );
    // One patch; a hole; two loops of which one cuts the other.
    let one = data(
        [1, 1],
        2,
        [(0, 0), (3, 0), (0, 2), (3, 2)]
            .map(|(x, y)| DVec3::new(f64::from(x), f64::from(y), 0.0))
            .to_vec(),
    );
    let scaled = [ring(DVec2::new(0.5, 0.5), 0.25, false)];
    is_near(
        &Nurbs::try_trimmed(&one, &scaled).unwrap(),
        [DVec2::new(0.75, 0.5), DVec2::new(2.25, 1.5)],
        1e-5,
    );
    let hole = [ring(DVec2::new(0.5, 0.5), 0.25, true)];
    is_near(
        &Nurbs::try_trimmed(&one, &hole).unwrap(),
        [DVec2::ZERO, DVec2::new(3.0, 2.0)],
        1e-5,
    );
    // Patches beyond a slanted line are no elements, though they are within the box of the line.
    let slanted = TrimLoop::polygon(
        [(0.0, 0.0), (20.0, 0.0), (0.0, 20.0)]
            .map(DVec2::from)
            .to_vec(),
        false,
    );
    let surface = Nurbs::try_trimmed(&grid(21, 21), &[slanted]).unwrap();
    assert!(
        (210..=240).contains(&surface.elements()),
        "{}",
        surface.elements()
    );
}

/// What trimming cuts away makes no shadows of boxes: the same hits as before.
#[test]
fn trimmed_surfaces_are_met_where_their_untrimmed_patches_are() {
    for (number, (data, loops)) in subjects().iter().enumerate() {
        let trimmed = Nurbs::try_trimmed(data, loops).unwrap();
        let parts = trimmed.parts.iter().map(Part::copy);
        let parts = parts.map(|part| Part {
            kept: part.kept.map(|_| part::WHOLE),
            ..part
        });
        let loose = Nurbs::of(parts.collect(), trimmed.trimming.clone(), false, false);
        let mut random = Random::new(number as u64);
        let scratch = &mut Scratch::default();
        for _ in 0..2000 {
            let ray = Ray::new(random.cube() * 3.0, random.cube() - random.cube());
            let [a, b] = [&trimmed, &loose]
                .map(|s| s.closest_hit(&ray, Interval::FORWARD, None, &mut *scratch));
            assert_eq!(a, b, "{number}: {ray:?}");
        }
    }
}
