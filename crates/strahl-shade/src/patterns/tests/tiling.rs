//! All tilings.

use super::{POINTS, field};
use crate::patterns::*;

const MEASURED: &str = include_str!("tilings.tsv");

#[test]
fn tilings_have_the_measured_values() {
    let rows = MEASURED.lines().filter(|line| !line.starts_with('#'));
    let mut count = 0;
    for (number, row) in (1..).zip(rows) {
        let mut columns = row.split('\t');
        assert_eq!(columns.next(), Some(format!("tiling {number}").as_str()));
        let tiling = TilingNumber::try_new(number).expect("a supported number");
        let pattern = field(Pattern::Tiling(tiling), Modifiers::default());
        for (p, expected) in POINTS.iter().zip(columns) {
            let expected: f64 = expected.parse().expect("a number");
            let got = pattern.value(&TexturePoint::in_space(DVec3::from_array(*p)));
            // POV-Ray's colours are single precision, and its flat middles lie about 2e-7 higher.
            assert!(
                (got - expected).abs() < 1e-6,
                "tiling {number} at {p:?}: {got} is not {expected}"
            );
            count += 1;
        }
    }
    assert_eq!(count, 24 * POINTS.len());
}

#[test]
fn tilings_far_away_and_at_hostile_points_have_values() {
    for number in 1..=24 {
        let tiling = TilingNumber::try_new(number).expect("a supported number");
        let pattern = field(Pattern::Tiling(tiling), Modifiers::default());
        for x in [f64::NAN, f64::INFINITY, -1e300, 1e18, 1e9, -0.0] {
            let point = TexturePoint::in_space(DVec3::new(x, 0.0, 0.3));
            let value = pattern.value(&point);
            assert!(
                (0.0..=1.0).contains(&value),
                "tiling {number} at {x}: {value}"
            );
        }
    }
    assert_eq!(TilingNumber::try_new(0), None);
    assert_eq!(TilingNumber::try_new(25), None);
}
