//! Densities of grids.

use super::field;
use crate::patterns::*;
use std::sync::Arc;

/// 4 by 3 by 5 values.
fn grid() -> Arc<DensityGrid> {
    let codes = (0..60_u32).map(|i| (i * i * 7 + i * 53 + 29) as u8);
    let grid = DensityGrid::try_new([4, 3, 5], DensityCodes::U8(codes.collect()));
    Arc::new(grid.expect("60 values"))
}

#[test]
fn densities_are_those_measured() {
    // Points, and POV-Ray's values with the interpolations 0, 1 and 2.
    let measured = [
        ([0.1, 0.1, 0.1], [0.113725490, 0.400470588, 0.363998592]),
        ([0.9, 0.9, 0.9], [0.513725490, 0.445019608, 0.392048985]),
        ([0.5, 0.5, 0.5], [0.937254902, 0.560784314, 0.555882335]),
        ([0.25, 0.7, 0.85], [0.756862745, 0.631372549, 0.633107841]),
        ([0.99, 0.02, 0.45], [0.639215686, 0.610547451, 0.678297460]),
        ([0.01, 0.97, 0.03], [0.521568627, 0.209646431, 0.155556113]),
        ([0.6, 0.2, 0.95], [0.827450980, 0.585254902, 0.557650089]),
        ([0.3, 0.4, 0.15], [0.835294118, 0.596078431, 0.634948850]),
        ([0.0, 0.0, 0.0], [0.113725490, 0.113725490, 0.113725491]),
        ([1.0, 0.5, 0.5], [0.000000000, 0.000000000, 0.000000000]),
        ([0.5, -0.01, 0.5], [0.000000000, 0.000000000, 0.000000000]),
        ([0.5, 0.5, 1.2], [0.000000000, 0.000000000, 0.000000000]),
        (
            [0.463, 0.373, 0.139],
            [0.835294118, 0.625954600, 0.616495728],
        ),
        (
            [0.867, 0.006, 0.503],
            [0.639215686, 0.567703954, 0.594689727],
        ),
        (
            [0.898, 0.081, 0.554],
            [0.639215686, 0.408589046, 0.386371106],
        ),
        (
            [0.617, 0.041, 0.379],
            [0.372549020, 0.787246055, 0.839621603],
        ),
        (
            [0.703, 0.452, 0.725],
            [0.043137255, 0.324098510, 0.184651405],
        ),
        (
            [0.157, 0.238, 0.111],
            [0.113725490, 0.515954949, 0.554229200],
        ),
        (
            [0.506, 0.924, 0.59],
            [0.764705882, 0.500764210, 0.522768855],
        ),
        (
            [0.774, 0.384, 0.746],
            [0.576470588, 0.358132796, 0.266354084],
        ),
    ];
    for (number, interpolation) in (0..).zip([
        DensityInterpolation::Nearest,
        DensityInterpolation::Trilinear,
        DensityInterpolation::Tricubic,
    ]) {
        assert_eq!(
            DensityInterpolation::from_number(number),
            Some(interpolation)
        );
        let pattern = Pattern::Density(grid(), interpolation);
        let pattern = field(pattern, Modifiers::default());
        for (p, values) in &measured {
            let got = pattern.value(&TexturePoint::in_space(DVec3::from_array(*p)));
            let expected: f64 = values[number as usize];
            // POV-Ray's cubic curves are single precision.
            assert!(
                (got - expected).abs() < 2e-7,
                "{interpolation:?} at {p:?}: {got} is not {expected}"
            );
        }
    }
}

#[test]
fn hostile_points_and_grids_have_densities() {
    let one = DensityGrid::try_new([1, 1, 1], DensityCodes::U16(vec![65535]));
    let grids = [
        grid(),
        Arc::new(one.expect("one value")),
        Arc::new(DensityGrid::try_new([0, 3, 2], DensityCodes::U32(vec![])).expect("no value")),
    ];
    let below_one = 1.0 - f64::EPSILON / 2.0;
    for grid in &grids {
        for interpolation in (0..3).filter_map(DensityInterpolation::from_number) {
            for x in [
                f64::NAN,
                f64::INFINITY,
                -0.0,
                5e-324,
                below_one,
                1.0,
                -1e300,
            ] {
                for p in [DVec3::splat(x), DVec3::new(x, 0.5, 0.5)] {
                    let density = grid.density(p, interpolation);
                    assert!(
                        (0.0..=1.0).contains(&density),
                        "{interpolation:?} {p}: {density}"
                    );
                }
            }
        }
    }
    assert!(DensityGrid::try_new([2, 2, 2], DensityCodes::U8(vec![0; 7])).is_none());
    assert!(DensityGrid::try_new([65535; 3], DensityCodes::U8(vec![0; 7])).is_none());
}
