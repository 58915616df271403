use super::*;
use strahl_function::{Graph, Workspace};

fn options(kind: TerrainKind) -> TerrainOptions {
    TerrainOptions {
        kind,
        offset: match kind {
            TerrainKind::Fbm => 0.0,
            TerrainKind::Hetero => 0.7,
            TerrainKind::Ridged => 1.0,
        },
        octaves: 5.0,
        extent: Some([DVec2::splat(-1.0), DVec2::splat(1.0)]),
        ..TerrainOptions::default()
    }
}

fn make(options: &TerrainOptions) -> Terrain {
    Terrain::try_new(options).expect("a terrain")
}

crate::primitive_tests!(fbm, || make(&options(TerrainKind::Fbm)));
crate::primitive_tests!(hetero, || make(&options(TerrainKind::Hetero)));
crate::primitive_tests!(ridged, || make(&options(TerrainKind::Ridged)));
crate::primitive_tests!(near_an_eye, || make(&TerrainOptions {
    octaves: 5.0,
    detail: Some(TerrainDetail {
        viewpoint: DVec3::new(0.3, 1.5, -0.4),
        angle: 0.05,
    }),
    generator: NoiseGenerator::Perlin,
    ..options(TerrainKind::Ridged)
}));

fn random() -> crate::conformance::Random {
    crate::conformance::Random::new(7)
}

#[test]
fn heights_are_those_of_the_internal_functions() {
    for (kind, name) in [
        (TerrainKind::Hetero, "f_hetero_mf"),
        (TerrainKind::Ridged, "f_ridged_mf"),
    ] {
        for (number, generator) in [
            (1.0, NoiseGenerator::Original),
            (2.0, NoiseGenerator::RangeCorrected),
            (3.0, NoiseGenerator::Perlin),
        ] {
            let options = TerrainOptions {
                generator,
                ..options(kind)
            };
            let terrain = make(&options);
            let last = if kind == TerrainKind::Hetero {
                1.0
            } else {
                options.gain
            };
            let parameters = [
                options.h,
                options.lacunarity,
                5.0,
                options.offset,
                last,
                number,
            ];
            let mut graph = Graph::new(["x", "y", "z"]);
            let mut arguments = graph.xyz().to_vec();
            arguments.extend(parameters.map(|p| graph.constant(p)));
            let root = graph.internal(name, &arguments, generator);
            let function = graph.finish(root).expect("a function");
            let mut random = random();
            for _ in 0..2000 {
                let p = random.cube() * 20.0;
                let expected = function.value(&mut Workspace::default(), &[p.x, 0.0, p.z]);
                let off = (terrain.height(p.x, p.z) - expected).abs();
                // POV-Ray rounds the coordinates of the third noise to 2^-29.
                let most = if number == 3.0 { 1e-6 } else { 1e-12 };
                assert!(off < most, "{name} {p} {off}");
            }
        }
    }
}

fn with_detail(octaves: f64) -> TerrainOptions {
    TerrainOptions {
        octaves,
        detail: Some(TerrainDetail {
            viewpoint: DVec3::new(0.2, 1.4, 0.1),
            angle: 0.02,
        }),
        ..options(TerrainKind::Hetero)
    }
}

#[test]
fn bounds_hold_and_slopes_are_differences() {
    let mut random = random();
    let kinds = [TerrainKind::Fbm, TerrainKind::Hetero, TerrainKind::Ridged].map(options);
    for options in kinds.into_iter().chain([with_detail(12.0)]) {
        let relief = Relief::new(&options);
        let mut smooth = 0;
        for size in [0.0, 1e-6, 1e-3, 0.05, 0.7, 5.0] {
            for _ in 0..100 {
                let corner = random.cube() * 3.0;
                let rectangle = [
                    (corner.x, corner.x + size * random.unit()),
                    (corner.z, corner.z + size * random.unit()),
                ];
                let (ranged, linear) = relief.bounds(rectangle);
                let range = relief.range(rectangle);
                for _ in 0..20 {
                    let [x, z] = rectangle.map(|(a, b)| a + (b - a) * random.unit());
                    let found = relief.sloped([x, z]);
                    assert_eq!(found.value, relief.height([x, z]));
                    for (low, high) in [range, ranged.value] {
                        let holds = low <= found.value && found.value <= high;
                        assert!(holds, "{options:?} {low} {high} {found:?}");
                    }
                    let place = |k: usize, x: f64| {
                        let (a, b) = rectangle[k];
                        if b > a {
                            2.0 * (x - a) / (b - a) - 1.0
                        } else {
                            0.0
                        }
                    };
                    let near = linear.middle
                        + (linear.slopes[0] * place(0, x) + linear.slopes[1] * place(1, z));
                    let off = (found.value - near).abs();
                    assert!(
                        off <= linear.off + relief.noise,
                        "{options:?} {off} {linear:?}"
                    );
                    let [a0, a1, b0, b1] = ranged.slopes;
                    for (k, (low, high)) in [(a0, a1), (b0, b1)].into_iter().enumerate() {
                        let slope = found.slopes[k];
                        assert!(
                            low <= slope && slope <= high,
                            "{options:?} {low} {high} {found:?}"
                        );
                    }
                }
                let [x, z] = rectangle.map(|range| range.0);
                let step = 1e-7;
                let here = relief.sloped([x, z]);
                let ahead = relief.height([x + step, z]);
                let behind = relief.height([x - step, z]);
                let off = ((ahead - behind) / (2.0 * step) - here.slopes[0]).abs();
                smooth += usize::from(off < 1e-4 * (1.0 + here.slopes[0].abs()));
            }
        }
        // The others are near creases and where noise is cut off.
        assert!(smooth > 590, "{options:?}: {smooth} of 600");
    }
}

/// Of each of many rays: the hits, and what a walk in small steps finds.
#[test]
fn no_peak_is_missed_that_small_steps_find() {
    let mut random = random();
    let (mut hits, mut scratch) = (0, Scratch::default());
    for options in [
        options(TerrainKind::Ridged),
        options(TerrainKind::Fbm),
        with_detail(9.0),
    ] {
        let terrain = make(&options);
        for _ in 0..150 {
            // Mostly flat ones, which graze many peaks.
            let target = random.cube();
            let level = terrain.height(target.x, target.z) + 0.05 * random.unit();
            let target = DVec3::new(target.x, level, target.z);
            let way = random.direction() * DVec3::new(1.0, 0.2, 1.0);
            let ray = Ray::new(target - way * 3.0, way);
            let hit = terrain.closest_hit(&ray, Interval::FORWARD, None, &mut scratch);
            hits += usize::from(hit.is_some());
            let mut inside = None;
            for k in 0..20_000_u32 {
                let t = 6.0 * f64::from(k) / 20_000.0;
                let p = ray.at(t);
                let now = terrain.contains(p);
                let [(x0, x1), (z0, z1)] = terrain.rectangle;
                let within = x0 < p.x && p.x < x1 && z0 < p.z && p.z < z1;
                if within && inside.is_some_and(|inside| inside != now) {
                    let found = hit.expect("what small steps find").t;
                    assert!(found <= t, "{options:?} {ray:?}: {found} {t}");
                    break;
                }
                inside = within.then_some(now);
            }
        }
    }
    assert!(hits > 200, "{hits}");
}

#[test]
fn what_the_tree_remembers_does_not_matter() {
    let mut random = random();
    let options = with_detail(12.0);
    let (fresh, mut forgetful) = (make(&options), make(&options));
    forgetful.tree = Arc::new(Tree::remembering(forgetful.rectangle, 3));
    let mut scratch = Scratch::default();
    for _ in 0..300 {
        let ray = Ray::new(random.cube() * 3.0, random.direction());
        let [a, b] = [&fresh, &forgetful]
            .map(|t| t.closest_hit(&ray, Interval::FORWARD, None, &mut scratch));
        assert_eq!(a, b);
    }
}

#[test]
fn detail_grows_towards_the_viewpoint_and_ends_at_the_octaves() {
    let (near, far) = ([0.21, 0.1], [300.0, 80.0]);
    let some = Relief::new(&with_detail(12.0));
    assert!(some.finest([(near[0], near[0]), (near[1], near[1])]) > 15.0);
    assert_eq!(some.finest([(far[0], far[0]), (far[1], far[1])]), 1.0);
    // Far away only the first octave is left.
    let one = TerrainOptions {
        octaves: 1.0,
        detail: None,
        ..with_detail(1.0)
    };
    assert_eq!(some.height(far), Relief::new(&one).height(far));
    // At the viewpoint on the ground all are there.
    let ground = TerrainDetail {
        viewpoint: DVec3::new(0.2, -9.0, 0.1),
        angle: 0.02,
    };
    let all = TerrainOptions {
        detail: Some(ground),
        ..with_detail(6.0)
    };
    let plain = TerrainOptions {
        detail: None,
        ..with_detail(6.0)
    };
    assert_eq!(
        Relief::new(&all).height([0.2, 0.1]),
        Relief::new(&plain).height([0.2, 0.1])
    );
}

#[test]
fn an_endless_terrain_is_met_from_far_away_and_far_from_the_origin() {
    let terrain = make(&TerrainOptions {
        extent: None,
        ..TerrainOptions::default()
    });
    let mut scratch = Scratch::default();
    for origin in [
        DVec3::new(3.0, 1e5, 2.0),
        DVec3::new(9e5, 50.0, -9e5),
        DVec3::new(0.3, 9.0, 0.2),
    ] {
        for direction in [
            -DVec3::Y,
            DVec3::new(0.1, -1.0, 0.2),
            DVec3::new(1.0, -0.3, 0.0),
        ] {
            let ray = Ray::new(origin, direction);
            let hit = terrain.closest_hit(&ray, Interval::FORWARD, None, &mut scratch);
            let Some(hit) = hit else {
                assert!(origin.x + origin.y / 0.3 > 1e6, "{ray:?}");
                continue;
            };
            let p = ray.at(hit.t);
            let off = (p.y - terrain.height(p.x, p.z)).abs();
            assert!(off < 1e-8, "{ray:?} {off}");
        }
    }
    // Level rays in the middle of the heights end somewhere.
    let ray = Ray::new(DVec3::new(0.0, 1.0, 0.0), DVec3::X);
    assert!(terrain.any_hit(&ray, Interval::FORWARD, None, &mut scratch));
}

#[test]
fn what_is_no_terrain_is_refused() {
    let good = options(TerrainKind::Ridged);
    let refused = |options: TerrainOptions| Terrain::try_new(&options).is_err();
    assert!(!refused(good.clone()));
    assert!(refused(TerrainOptions {
        lacunarity: 1.0,
        ..good.clone()
    }));
    assert!(refused(TerrainOptions {
        octaves: 0.0,
        ..good.clone()
    }));
    assert!(refused(TerrainOptions {
        octaves: f64::NAN,
        ..good.clone()
    }));
    assert!(refused(TerrainOptions {
        h: f64::INFINITY,
        ..good.clone()
    }));
    assert!(refused(TerrainOptions {
        h: -300.0,
        octaves: 40.0,
        ..good.clone()
    }));
    assert!(refused(TerrainOptions {
        extent: Some([DVec2::ZERO, DVec2::X]),
        ..good.clone()
    }));
    let detail = Some(TerrainDetail {
        viewpoint: DVec3::ZERO,
        angle: 0.0,
    });
    assert!(refused(TerrainOptions { detail, ..good }));
}
