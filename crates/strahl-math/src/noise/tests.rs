use super::*;

/// Place, noise 1 to 3, `vturbulence(2, 0.5, 1, place)`, `vturbulence(2, 0.5, 6, place)`, measured with POV-Ray 3.7.0.10.
const MEASURED: [[f64; 12]; 14] = [
    [
        1.220012,
        1.231763,
        0.061302,
        0.19454610898453545,
        0.365905695828829,
        0.7657003583258342,
        -0.30545389101546455,
        -0.3449735921184345,
        0.4837668426686134,
        -0.22355439915420927,
        -0.656701842208304,
        0.4629835056085495,
    ],
    [
        -4.283972,
        -8.921386,
        -2.332622,
        0.514133177903734,
        0.5224572815356394,
        0.26637173552107996,
        0.01413317790373399,
        0.17961887714747024,
        -0.14992065500189738,
        0.0249951038624629,
        -0.09922401037377085,
        -0.03124678065309273,
    ],
    [
        -36.610718,
        -181.889922,
        -180.496916,
        0.6421216467469979,
        0.585153177891401,
        0.23273800783274062,
        0.14212164674699782,
        -0.2909034130009774,
        0.011179557603579,
        0.15082150160244845,
        -0.5307265416680911,
        -0.18675861970323177,
    ],
    [
        9983.522301,
        3047.382232,
        -5309.795967,
        0.394611576193855,
        0.4639089293223333,
        0.5398092197649025,
        -0.105388423806145,
        -0.24383514995152206,
        0.22786889160785467,
        -0.1610235796514379,
        -0.2607232040915123,
        0.5877824315672419,
    ],
    [
        -0.52042,
        3.79349,
        3.181421,
        0.18724964203930294,
        0.3623314790302692,
        0.548320018310053,
        -0.31275035796069706,
        0.22959836725862906,
        -0.1881001258633408,
        -0.45096084581345514,
        0.1277057296272876,
        -0.17318474749078253,
    ],
    [
        1.032693,
        -0.322786,
        -0.020931,
        0.32184302708218326,
        0.42826283202702503,
        0.48250279501721505,
        -0.1781569729178168,
        -0.03402987398894737,
        -0.18522002312570074,
        -0.16383125279178531,
        0.07322023011606557,
        -0.398432508136915,
    ],
    [
        0.176689,
        -0.439197,
        0.055596,
        0.6796950216782075,
        0.6035587142784962,
        0.46068971473662124,
        0.17969502167820753,
        -0.02317637150076024,
        -0.1350443324384588,
        0.2833648375614689,
        -0.1271988402087255,
        -0.24811218923902906,
    ],
    [
        -0.022855,
        0.037965,
        -0.043579,
        0.0,
        0.2647153101782209,
        0.47551444941646137,
        -0.5120256648296617,
        0.3910182016941693,
        -0.4593121547001338,
        -1.036117816911475,
        0.7703073225187236,
        -0.7746114981922863,
    ],
    [
        8.959077,
        18.504425,
        -13.634074,
        0.5162356966607009,
        0.5234872125853989,
        0.18526433013335697,
        0.01623569666070083,
        -0.08166955029371077,
        0.31029784102439123,
        -0.09234343448483635,
        0.08144874962368692,
        0.37017800889415275,
    ],
    [
        23.726894,
        22.331728,
        -28.888967,
        0.2395510567888653,
        0.3879516314395761,
        0.37996206095751495,
        -0.2604489432111347,
        -0.14218410298717934,
        0.1457770037505749,
        -0.4342318046207434,
        -0.11445526186304965,
        0.01054266559597286,
    ],
    [
        14.52469,
        -34.916022,
        0.235478,
        0.16554456514728827,
        0.3516991207911682,
        0.3153068296224326,
        -0.33445543485271173,
        -0.1837436441348807,
        -0.0113358206834326,
        -0.27067720162412096,
        -0.30969188924731195,
        -0.33275489446626305,
    ],
    [
        -5.066636,
        -23.739773,
        -14.004588,
        0.12866980400902484,
        0.3336358044364801,
        0.5715945518697244,
        -0.3713301959909752,
        -0.01390157337400828,
        -0.22520015049182282,
        -0.415818722361159,
        -0.11548230104600088,
        -0.3600213274916999,
    ],
    [
        27.55938,
        -16.519312,
        -31.586527,
        0.2369025508344007,
        0.386654245383477,
        0.6243104076432717,
        -0.2630974491655993,
        0.03495445360804799,
        -0.3402434719338002,
        -0.4520786423720249,
        0.25441047767914293,
        -0.6002506888811279,
    ],
    [
        595535.970955,
        -154367.697719,
        896818.472889,
        0.2599299765486722,
        0.39793436388923054,
        0.20185589348070898,
        -0.24007002345132777,
        -0.12535778822214771,
        -0.4293179993801322,
        -0.2399726361426321,
        -0.2542134558052395,
        -0.6119108398161263,
    ],
];

#[test]
fn equals_the_measured_values() {
    for m in &MEASURED {
        let p = DVec3::new(m[0], m[1], m[2]);
        for (number, expected) in (1..=3).zip(&m[3..6]) {
            let generator = NoiseGenerator::from_number(number).expect("1 to 3");
            let got = noise(p, generator);
            assert!(
                (got - expected).abs() < 1e-15,
                "{p} {number}: {got} {expected}"
            );
        }
        let once = Turbulence {
            octaves: 1,
            ..Turbulence::default()
        };
        let six = Turbulence::default();
        for (got, expected) in [
            (once.vector(p), DVec3::new(m[6], m[7], m[8])),
            (six.vector(p), DVec3::new(m[9], m[10], m[11])),
        ] {
            assert!((got - expected).length() < 1e-14, "{p}: {got} {expected}");
        }
    }
}

#[test]
fn the_hash_is_a_permutation_and_the_gradients_are_units() {
    let mut seen = [false; 4096];
    for i in 0..4096 {
        seen[usize::from(hash(i))] = true;
    }
    assert!(seen.iter().all(|&s| s));
    assert!(GRADIENTS.iter().all(|g| (g.length() - 1.0).abs() < 1e-15));
    assert_eq!(tables::R[0], -1.0);
}

#[test]
fn noise_repeats_and_stays_within_its_range() {
    let p = DVec3::new(0.25, -7.5, 3.125);
    for generator in [
        NoiseGenerator::Original,
        NoiseGenerator::RangeCorrected,
        NoiseGenerator::Perlin,
    ] {
        assert_eq!(
            noise(p, generator),
            noise(p + DVec3::new(4096.0, -8192.0, 4096.0), generator)
        );
        let (mut low, mut high) = (1.0f64, 0.0f64);
        for i in 0..20_000 {
            let n = noise(
                DVec3::new(
                    f64::from(i) * 0.37,
                    f64::from(i) * 0.73,
                    f64::from(i) * 0.11,
                ),
                generator,
            );
            low = low.min(n);
            high = high.max(n);
        }
        assert!(
            low >= 0.0 && high <= 1.0 && low < 0.2 && high > 0.8,
            "{low} {high}"
        );
    }
}

#[test]
fn hostile_places_do_not_panic() {
    for x in [
        f64::NAN,
        f64::INFINITY,
        f64::NEG_INFINITY,
        1e300,
        -1e300,
        f64::MIN_POSITIVE,
    ] {
        for p in [DVec3::splat(x), DVec3::new(0.5, x, -0.5)] {
            for number in 1..=3 {
                let _ = noise(p, NoiseGenerator::from_number(number).expect("1 to 3"));
            }
            let _ = Turbulence::default().vector(p);
        }
    }
    assert!(NoiseGenerator::from_number(4).is_none());
}

/// The vector noise corner by corner, as its formula is written.
fn slow_vector(p: DVec3) -> DVec3 {
    let mut numbers = [0; 3];
    let mut position = DVec3::ZERO;
    for axis in 0..3 {
        let x = p[axis];
        if x.abs() >= kernel::OVERFLOW {
            (numbers[axis], position[axis]) = (1 << 31, x + kernel::OVERFLOW);
        } else {
            (numbers[axis], position[axis]) = (x.floor() as i64, x - x.floor());
        }
    }
    let mut sum = DVec3::ZERO;
    for corner in 0..8 {
        let (mut h, mut share) = (0, 1.0);
        let mut ways = [0.0; 3];
        for axis in 0..3 {
            let upper = (corner >> (2 - axis)) & 1;
            let number = numbers[axis] + i64::from(kernel::CELL_SHIFT) + upper;
            h = usize::from(hash(h ^ (number & 4095) as usize));
            let (t, s) = (position[axis], smooth(position[axis]));
            share *= if upper == 0 { 1.0 - s } else { s };
            ways[axis] = if upper == 0 { t } else { t - 1.0 };
        }
        let h = h & 255;
        let r = |i: usize| DVec3::new(tables::R[h + i], tables::R[h + i + 4], tables::R[h + i + 8]);
        let slope = r(1) * ways[0] + r(2) * ways[1] + r(3) * ways[2];
        sum += (0.5 * r(0) + slope) * share;
    }
    sum
}

#[test]
fn octaves_of_vector_noise_have_the_bits_of_single_points() {
    let bits = |v: DVec3| {
        v.to_array()
            .map(|x| if x.is_nan() { 0 } else { x.to_bits() })
    };
    let special = [
        0.0,
        -0.0,
        -1.0,
        5e-324,
        1e-200,
        4095.5,
        1e9,
        -3e9,
        1e15,
        f64::INFINITY,
        f64::NAN,
    ];
    for i in 0..500 {
        let t = i as f64;
        let mut p = DVec3::new(t * 0.731 - 70.0, t * 0.317 + 3.0, 9.0 - t * 0.613);
        if let Some(x) = special.get(i / 3) {
            p[i % 3] = *x;
        }
        assert_eq!(bits(dnoise(p)), bits(slow_vector(p)), "{p}");
        for octaves in 0..=10 {
            let turbulence = Turbulence {
                octaves,
                omega: 0.6,
                lambda: 2.3,
            };
            let (mut sum, mut frequency, mut strength) = (DVec3::ZERO, 1.0, 1.0);
            for _ in 0..octaves {
                sum += slow_vector(p * frequency) * strength;
                frequency *= turbulence.lambda;
                strength *= turbulence.omega;
            }
            for simd in Simd::available() {
                let found = turbulence.vector_with(simd, p);
                assert_eq!(bits(found), bits(sum), "{p} {octaves} {}", simd.level());
            }
        }
    }
}

#[test]
fn no_value_of_the_noise_is_zero() {
    // So twice a corner's value times half its weight has the same bits, however small the weight.
    assert!(tables::R.iter().all(|r| r.abs() >= 1e-8));
}

#[test]
fn every_simd_level_has_the_same_noise() {
    use super::kernel;
    use strahl_simd::{Simd, dispatch};
    let mut x = 0.0;
    for step in 0..2000 {
        // From tiny to huge coordinates of both signs, integers among them.
        x = (x * 1.37 + 0.111) % 41.0 - 20.0;
        let scale = [1.0, 1e-9, 1e3, 1e8, 1e15, 1e17][step % 6];
        let p = DVec3::new(x * scale, (x * 3.7 * scale).round(), -x * x * scale);
        let reference = |generator| kernel::noise(strahl_simd::Portable, p, generator).to_bits();
        let vector = slow_vector(p);
        for simd in Simd::available() {
            for number in 1..=3 {
                let generator = NoiseGenerator::from_number(number).unwrap();
                let found = dispatch!(simd, isa => kernel::noise(isa, p, generator));
                assert_eq!(
                    found.to_bits(),
                    reference(generator),
                    "{p} {:?}",
                    simd.level()
                );
            }
            let [x, y, z, _] = dispatch!(simd, isa => {
                isa.store(kernel::vector(isa, isa.load(&[p.x, p.y, p.z, 0.0])))
            });
            assert_eq!(DVec3::new(x, y, z), vector, "{p} {:?}", simd.level());
        }
    }
}
#[test]
fn beyond_the_range_of_integers_noise_is_that_of_pov_ray() {
    // Points, and the values of the three generators.
    let measured: [([f64; 3], [f64; 3]); 20] = [
        ([2147483000.5, 0.3, 0.4], [0.46590, 0.49883, 1.00000]),
        ([2147483646.5, 0.3, 0.4], [0.19683, 0.36703, 1.00000]),
        ([2147483647.5, 0.3, 0.4], [0.30178, 0.41843, 1.00000]),
        ([2147483648.5, 0.3, 0.4], [1.00000, 1.00000, 1.00000]),
        ([2147483650.5, 0.3, 0.4], [1.00000, 1.00000, 1.00000]),
        ([3000000000.0, 0.3, 0.4], [1.00000, 1.00000, 1.00000]),
        ([4294967296.3, 0.3, 0.4], [1.00000, 1.00000, 1.00000]),
        ([10000000000.0, 0.3, 0.4], [1.00000, 1.00000, 1.00000]),
        ([1000000000000.0, 0.3, 0.4], [1.00000, 1.00000, 1.00000]),
        ([-2147483640.5, 0.3, 0.4], [0.64683, 0.58746, 0.39178]),
        ([-2147483648.5, 0.3, 0.4], [0.00000, 0.00598, 0.46474]),
        ([-2147483650.5, 0.3, 0.4], [0.00000, 0.00000, 0.19452]),
        ([-3000000000.0, 0.3, 0.4], [1.00000, 1.00000, 1.00000]),
        ([-1000000000000.0, 0.3, 0.4], [1.00000, 1.00000, 1.00000]),
        ([0.3, 3000000000.0, 0.4], [0.00000, 0.00000, 0.00000]),
        ([0.3, 0.4, 3000000000.0], [1.00000, 1.00000, 1.00000]),
        ([0.3, 0.4, -3000000000.0], [1.00000, 1.00000, 1.00000]),
        ([0.3, -3000000000.0, 0.4], [0.00000, 0.00000, 0.00000]),
        (
            [3000000000.0, 3000000000.0, 3000000000.0],
            [1.00000, 1.00000, 0.00000],
        ),
        (
            [-3000000000.0, 3000000000.0, 3000000000.0],
            [0.00000, 0.00000, 1.00000],
        ),
    ];
    for (point, values) in measured {
        let p = DVec3::from_array(point);
        let generators = [
            NoiseGenerator::Original,
            NoiseGenerator::RangeCorrected,
            NoiseGenerator::Perlin,
        ];
        for (generator, value) in generators.into_iter().zip(values) {
            let found = noise(p, generator);
            assert!(
                (found - value).abs() < 2e-5,
                "{generator:?} at {p}: {found}, not {value}"
            );
            let (low, high) = noise_bounds(p, p, generator);
            assert!(
                low <= found && found <= high,
                "{generator:?} at {p}: {found}, not in {low} to {high}"
            );
        }
    }
}

#[test]
fn octaves_together_have_the_bits_of_single_points() {
    let generators = [
        NoiseGenerator::Original,
        NoiseGenerator::RangeCorrected,
        NoiseGenerator::Perlin,
    ];
    let special = [
        0.0,
        -0.0,
        -1.0,
        4095.5,
        1e9,
        -3e9,
        1e300,
        f64::INFINITY,
        f64::NAN,
    ];
    for i in 0..2000 {
        let t = f64::from(i);
        let mut p = DVec3::new(t * 0.731 - 700.0, t * 0.317 + 3.0, 9.0 - t * 0.613);
        if let Some(x) = special.get(i as usize) {
            p[i as usize % 3] = *x;
        }
        for generator in generators {
            let together: [f64; 10] = pattern_octaves(p, 1.5, generator);
            for (k, value) in together.into_iter().enumerate() {
                let n = noise(p * (1.5 * f64::from(1 << k)), generator);
                let alone = match generator {
                    NoiseGenerator::Original => n,
                    _ => (2.0 * n - 0.5).clamp(0.0, 1.0),
                };
                assert_eq!(value.to_bits(), alone.to_bits(), "{p} {k} {generator:?}");
            }
            for octaves in 0..=10 {
                let turbulence = Turbulence {
                    octaves,
                    omega: 0.6,
                    lambda: 2.3,
                };
                let (mut sum, mut frequency, mut strength) = (0.0, 1.0, 1.0);
                for k in 0..octaves {
                    let n = noise(p * frequency, generator);
                    let n = match generator {
                        NoiseGenerator::Original => n,
                        _ => 2.0 * n - 0.5,
                    };
                    sum += if k == 0 { n.clamp(0.0, 1.0) } else { n } * strength;
                    frequency *= turbulence.lambda;
                    strength *= turbulence.omega;
                }
                let together = turbulence.scalar(p, generator);
                assert_eq!(together.to_bits(), sum.to_bits(), "{p} {octaves}");
            }
        }
    }
}

#[test]
fn four_points_have_the_same_bits_on_all_levels() {
    for i in 0..500 {
        let t = f64::from(i);
        let lanes = |a: f64| [0.0, 1.0, 2.0, 3.0].map(|k| (a * t + k) * 1.37 - 99.0 * k);
        let points = [lanes(0.31), lanes(-0.77), lanes(1.13)];
        for generator in [NoiseGenerator::Original, NoiseGenerator::RangeCorrected] {
            let alone = [0, 1, 2, 3].map(|lane| {
                let p = DVec3::from_array(points.map(|x| x[lane]));
                noise(p, generator)
            });
            for simd in Simd::available() {
                let four = dispatch!(simd, isa => {
                    let [x, y, z] = &points;
                    let points = [isa.load(x), isa.load(y), isa.load(z)];
                    isa.store(kernel::noise_of_four(isa, points, generator))
                });
                assert_eq!(four, alone, "{}", simd.level());
            }
        }
    }
}

#[test]
fn any_number_of_points_have_the_same_bits() {
    for count in 0..12 {
        let column = |a: f64| -> Vec<f64> {
            let far = |k: u32| if k == 5 { 1e11 } else { 1.0 };
            (0..count).map(|k| a * f64::from(k + 1) * far(k)).collect()
        };
        let [x, y, z] = [column(0.31), column(-0.77), column(1.13)];
        for generator in [NoiseGenerator::RangeCorrected, NoiseGenerator::Perlin] {
            let mut values = vec![0.0; count as usize];
            store_noise([&x, &y, &z], generator, &mut values);
            for (k, value) in values.into_iter().enumerate() {
                let alone = noise(DVec3::new(x[k], y[k], z[k]), generator);
                assert_eq!(value.to_bits(), alone.to_bits());
            }
        }
    }
}

#[test]
fn neighbours_have_the_noise_of_points() {
    for i in 0..4000 {
        let t = f64::from(i);
        // Within a cell, across its border, in cells far from each other, and beyond the range of integers.
        let size = [6e-6, 0.1, 1.0, 1e7][i as usize % 4] * if i % 97 == 0 { 1e4 } else { 1.0 };
        let lanes = |a: f64| [0.0, 1.0, 2.0, 3.0].map(|k| a * t + (k - 1.5) * size);
        let points = [
            [lanes(0.31), lanes(-0.77), lanes(1.13)],
            [
                lanes(0.31),
                lanes(-0.77),
                lanes(1.13).map(|z| z + 0.5 * size),
            ],
        ];
        for generator in [
            NoiseGenerator::Original,
            NoiseGenerator::RangeCorrected,
            NoiseGenerator::Perlin,
        ] {
            let alone = points.map(|half| {
                [0, 1, 2, 3].map(|lane| {
                    noise(DVec3::from_array(half.map(|x| x[lane])), generator).to_bits()
                })
            });
            for simd in Simd::available() {
                let found = dispatch!(simd, isa => neighbours_with(isa, &points, generator));
                let found = found.map(|half| half.map(f64::to_bits));
                assert_eq!(found, alone, "{} {points:?}", simd.level());
            }
        }
    }
}

#[test]
fn stored_octaves_have_the_noise_and_the_bounds_of_points_and_boxes() {
    let generators = [
        NoiseGenerator::Original,
        NoiseGenerator::RangeCorrected,
        NoiseGenerator::Perlin,
    ];
    let factors = [2.0, 2.17, 0.4, -1.5, 0.0, 1e9, f64::INFINITY, f64::NAN];
    let special = [0.0, -0.0, 4095.5, -3e9, 1e300, f64::INFINITY, f64::NAN];
    for i in 0..1200 {
        let t = f64::from(i);
        let mut p = DVec3::new(t * 0.731 - 70.0, t * 0.317 + 3.0, 9.0 - t * 0.613);
        if let Some(x) = special.get(i as usize / 3) {
            p[i as usize % 3] = *x;
        }
        let (generator, factor) = (generators[i as usize % 3], factors[i as usize / 3 % 8]);
        let count = i as usize % 12;
        let size = [1e-9, 1e-3, 0.05, 0.7][i as usize / 24 % 4];
        let area = [p, p + DVec3::new(size, 0.3 * size, 0.1 * size)];
        for simd in Simd::available() {
            let (mut values, mut next) = ([0.0; 12], p);
            dispatch!(simd, isa => {
                octaves_with(isa, &mut next, factor, generator, &mut values[..count]);
            });
            let (mut ranges, mut left) = ([(0.5, 0.5); 12], area);
            let known = dispatch!(simd, isa => {
                bounds::octaves_within(isa, &mut left, factor, generator, &mut ranges[..count])
            });
            let (mut q, mut area) = (p, area);
            for octave in 0..count {
                let noise = noise(q, generator);
                assert!(
                    values[octave].to_bits() == noise.to_bits()
                        || values[octave].is_nan() && noise.is_nan(),
                    "{p} {factor} {octave} {}",
                    simd.level()
                );
                let bounds = noise_bounds(area[0], area[1], generator);
                let found = if octave < known {
                    ranges[octave]
                } else {
                    (0.0, 1.0)
                };
                assert_eq!(found, bounds, "{p} {factor} {octave} {}", simd.level());
                q *= factor;
                let (a, b) = ((area[0] * factor).to_array(), (area[1] * factor).to_array());
                for axis in 0..3 {
                    let (low, high) = if b[axis] < a[axis] {
                        (b[axis], a[axis])
                    } else {
                        (a[axis], b[axis])
                    };
                    let is_zero = |x: f64| x == 0.0;
                    area[0][axis] = if is_zero(low) { low } else { low.next_down() };
                    area[1][axis] = if is_zero(high) { high } else { high.next_up() };
                }
            }
            let same = |a: f64, b: f64| a.to_bits() == b.to_bits() || a.is_nan() && b.is_nan();
            assert!((0..3).all(|axis| same(next[axis], q[axis])));
        }
    }
}
