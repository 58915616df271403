use super::*;

const A: [f64; 4] = [1.5, -0.0, 1e300, f64::NAN];
const B: [f64; 4] = [0.1, 3.0, 1e300, 2.0];

/// Every operation on numbers that would show a wrong rounding or order.
fn everything<I: Isa>(isa: I) -> Vec<u64> {
    let (a, b) = (isa.load(&A), isa.load(&B));
    let values = [
        isa.add(a, b),
        isa.sub(a, b),
        isa.mul(a, b),
        isa.div(a, b),
        isa.sqrt(b),
        isa.abs(a),
        isa.floor(isa.load(&[-0.0, 2.5, -2.5, 1e300])),
        isa.min(a, b),
        isa.max(b, a),
        isa.min(isa.splat(0.0), isa.splat(-0.0)),
        isa.choose_le(a, b, b, isa.sub(a, b)),
        isa.splat(0.7),
        isa.load_wide(&[0.1, -2.5, 1e-42, f32::INFINITY]),
    ];
    let mut bits: Vec<u64> = values
        .into_iter()
        .flat_map(|v| isa.store(v))
        .map(|x| if x.is_nan() { 0 } else { x.to_bits() })
        .collect();
    let narrow = isa.narrow(isa.load(&[0.1, -1e300, 1e-42, f64::MIN_POSITIVE]));
    bits.extend(narrow.map(|x| u64::from(x.to_bits())));
    bits.extend([isa.le(a, b), isa.le(b, a), isa.lt(a, b), isa.lt(b, a)].map(u64::from));
    let p = isa.load_f32(&Lanes8([
        1.0,
        -2.0,
        3.0,
        -4.0,
        0.5,
        0.25,
        1e10,
        f32::INFINITY,
    ]));
    let q = isa.splat_f32(0.5);
    // Exact products, so that fused and separate rounding agree.
    let culled = [
        isa.mul_sub(p, q, isa.splat_f32(0.25)),
        isa.mul_add(p, q, isa.splat_f32(0.25)),
    ];
    let bytes = isa.load_bytes(&[0, 1, 2, 127, 128, 254, 255, 17]);
    assert_eq!(
        isa.store_f32(bytes).0,
        [0.0, 1.0, 2.0, 127.0, 128.0, 254.0, 255.0, 17.0]
    );
    let words = std::array::from_fn(|i| (i * 4369) as u16);
    assert_eq!(
        isa.store_f32x16(isa.load_words_x16(&words)).0,
        words.map(f32::from)
    );
    let narrow = isa.narrow_f32(isa.load(&[0.1, -1e300, 1e-42, 3.0]));
    let spread = [
        isa.spread::<0>(narrow),
        isa.spread::<1>(narrow),
        isa.spread::<2>(narrow),
        isa.spread::<3>(narrow),
    ];
    let more = [narrow, spread[0], spread[1], spread[2], spread[3]];
    for v in more.into_iter().chain([isa.div_f32(q, p)]) {
        bits.extend(isa.store_f32(v).0.map(|x| u64::from(x.to_bits())));
    }
    for v in [culled[0], culled[1], isa.min_f32(p, q), isa.max_f32(p, q)] {
        bits.extend(isa.store_f32(v).0.map(|x| u64::from(x.to_bits())));
    }
    for v in [isa.min_bits(p, q), isa.max_bits(p, q)] {
        bits.extend(isa.store_f32(v).0.map(|x| u64::from(x.to_bits())));
    }
    bits.extend([isa.le_f32(p, q), isa.le_f32(q, p)].map(u64::from));
    bits.extend([isa.lt_f32(p, q), isa.lt_f32(q, p)].map(u64::from));
    bits
}

/// Where each operation on sixteen lanes gives what it should; all products are exact.
fn sixteen<I: Isa>(isa: I) -> [u32; 13] {
    let x: [f32; 16] = std::array::from_fn(|i| i as f32 * 0.5 - 3.0);
    let v = isa.load_f32x16(&Lanes16(x));
    let (two, minus) = (isa.splat_f32x16(2.0), isa.splat_f32x16(-2.0));
    let is = |found: I::F32x16, expected: fn(f32) -> f32| {
        let expected = isa.load_f32x16(&Lanes16(x.map(expected)));
        isa.le_f32x16(found, expected) & isa.le_f32x16(expected, found)
    };
    [
        is(isa.mul_add_f32x16(v, two, v), |x| 3.0 * x),
        is(isa.mul_sub_f32x16(v, v, two), |x| x * x - 2.0),
        is(isa.mul_f32x16(v, v), |x| x * x),
        is(isa.sub_f32x16(two, v), |x| 2.0 - x),
        is(isa.div_f32x16(v, two), |x| x / 2.0),
        is(isa.abs_f32x16(v), f32::abs),
        is(isa.min_f32x16(v, two), |x| x.min(2.0)),
        is(isa.max_f32x16(v, two), |x| x.max(2.0)),
        is(isa.min_bits_x16(v, two), |x| x.min(2.0)),
        is(isa.max_bits_x16(v, two), |x| x.max(2.0)),
        // Of two negative numbers the wrong one.
        is(isa.min_bits_x16(v, minus), |x| {
            if x < 0.0 { x.max(-2.0) } else { -2.0 }
        }),
        is(isa.max_bits_x16(v, minus), |x| {
            if x < 0.0 { x.min(-2.0) } else { x }
        }),
        isa.lt_f32x16(v, two),
    ]
}

#[test]
fn sixteen_lanes_are_computed_like_one() {
    let all = 0xffff;
    for simd in Simd::available() {
        let found = dispatch!(simd, isa => sixteen(isa));
        // -3 + 0.5 i < 2 for the first ten.
        assert_eq!(
            found,
            [
                all, all, all, all, all, all, all, all, all, all, all, all, 0x3ff
            ],
            "{}",
            simd.level()
        );
        let nan = dispatch!(simd, isa => {
            let (nan, one) = (isa.splat_f32x16(f32::NAN), isa.splat_f32x16(1.0));
            isa.lt_f32x16(nan, one) | isa.le_f32x16(nan, one) | isa.lt_f32x16(one, nan)
        });
        assert_eq!(nan, 0);
        let x: [f32; 16] = std::array::from_fn(|i| ((i * 5 + 3) % 16) as f32 - 7.5);
        let (stored, ends) = dispatch!(simd, isa => {
            let v = isa.load_f32x16(&Lanes16(x));
            (isa.store_f32x16(v), [isa.smallest_f32x16(v), isa.largest_f32x16(v)])
        });
        assert_eq!((stored.0, ends), (x, [-7.5, 7.5]));
    }
}

#[test]
fn every_level_computes_the_same() {
    let reference = everything(Portable);
    assert_eq!(reference[0], 1.6f64.to_bits());
    for simd in Simd::available() {
        let found = dispatch!(simd, isa => everything(isa));
        assert_eq!(found, reference, "{}", simd.level());
    }
}

#[test]
fn rows_become_columns() {
    let rows: [[f64; 4]; 4] = std::array::from_fn(|i| std::array::from_fn(|k| (10 * i + k) as f64));
    for simd in Simd::available() {
        let columns = dispatch!(simd, isa => {
            isa.transpose(rows.map(|row| isa.load(&row))).map(|column| isa.store(column))
        });
        let loaded = dispatch!(simd, isa => {
            let [a, b, c, d] = &rows;
            isa.load_columns([a, b, c, d]).map(|column| isa.store(column))
        });
        assert_eq!(loaded, columns, "{}", simd.level());
        for (i, column) in columns.into_iter().enumerate() {
            assert_eq!(column, rows.map(|row| row[i]), "{}", simd.level());
        }
    }
}

#[test]
fn levels_have_names() {
    for level in Level::ALL {
        assert_eq!(level.name().parse(), Ok(*level));
    }
    let unknown = "mmx"
        .parse::<Level>()
        .expect_err("no such level")
        .to_string();
    assert_eq!(
        unknown,
        "unknown SIMD level `mmx`; there are: scalar, sse4, avx2, avx512"
    );
    assert!(Simd::of(Level::Portable).is_some());
    assert_eq!(
        Simd::detect().level(),
        Simd::available().last().expect("one").level()
    );
}
