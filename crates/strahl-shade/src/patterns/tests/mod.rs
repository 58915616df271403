//! Values measured with POV-Ray 3.7.0.10: `function { pattern { ... } }` (for block patterns a pigment of the
//! colours `rgb 0, rgb 1, ...`) at twelve points.

mod blocks;
mod density;
mod fractals;
mod modifiers;
mod noisy;
mod plain;
mod tiling;
mod warps;

use super::*;

const POINTS: [[f64; 3]; 12] = [
    [0.25, 0.5, 0.75],
    [-0.3, 0.2, -0.1],
    [-2.5775, -2.2214, 2.69],
    [0.7313, -0.786, 0.0683],
    [0.9771, -1.3481, -2.1722],
    [1.7282, 1.0222, 0.0743],
    [1.9004, 0.2945, 2.8855],
    [-1.7729, 0.3224, -0.0983],
    [-0.8804, 0.5496, -1.5882],
    [1.8132, 2.204, -2.2274],
    [-0.1976, -1.3371, -2.5013],
    [2.3757, -0.4203, -2.1139],
];

/// For each pattern as it is written in a scene, its values at [`POINTS`].
const MEASURED: &str = include_str!("measured.tsv");

/// A pattern as it is written in a scene, and as it is constructed here.
type Built = (&'static str, PatternField);

fn field(pattern: Pattern, modifiers: Modifiers) -> PatternField {
    PatternField { pattern, modifiers }
}

fn built() -> Vec<Built> {
    [
        plain::built(),
        noisy::built(),
        blocks::built(),
        fractals::built(),
        modifiers::built(),
        warps::built(),
    ]
    .concat()
}

/// The rows of [`MEASURED`].
fn measured() -> impl Iterator<Item = (&'static str, Vec<f64>)> {
    let rows = MEASURED.lines().filter(|line| !line.starts_with('#'));
    rows.map(|row| {
        let (written, values) = row.split_once('\t').expect("a name and values");
        let values = values.split('\t').map(|x| x.parse().expect("a number"));
        (written, values.collect())
    })
}

#[test]
fn equals_the_measured_values() {
    let patterns = built();
    assert_eq!(patterns.len(), measured().count());
    for ((written, field), (name, values)) in patterns.into_iter().zip(measured()) {
        assert_eq!(written, name);
        assert_eq!(values.len(), POINTS.len(), "{written}");
        for (p, expected) in POINTS.iter().zip(values) {
            let point = TexturePoint::in_space(DVec3::from_array(*p));
            let got = field.value(&point);
            if field.pattern.block_count() > Some(2) {
                assert_eq!(field.block(&point), expected as usize, "{written} at {p:?}");
            } else {
                assert!(
                    (got - expected).abs() < 2e-8,
                    "{written} at {p:?}: {got} is not {expected}"
                );
            }
        }
    }
}

#[test]
fn hostile_points_do_not_panic() {
    for (_, field) in built() {
        for x in [f64::NAN, f64::INFINITY, -1e300, 1e300, 1e18, -0.0] {
            for p in [
                DVec3::splat(x),
                DVec3::new(0.5, x, 0.25),
                DVec3::new(x, 0.0, 0.0),
            ] {
                let point = TexturePoint::in_space(p);
                let _ = field.value(&point);
                let block = field.block(&point);
                assert!(block < field.pattern.block_count().unwrap_or(1));
            }
        }
    }
}
