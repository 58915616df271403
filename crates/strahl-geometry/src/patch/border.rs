//! How often the border of a patch winds around a ray: the decision on rays through shared borders.

use super::net::{Curve, Net, halves};

/// Curves are halved so often at most; then they are shorter than the distance between neighbouring numbers.
const DEPTH: u32 = 64;

/// How often a plane curve crosses the positive first axis upwards, less how often it does so downwards.
///
/// The reversed curve gives exactly the opposite number, and curves that share an end agree about it, because the decisions
/// are comparisons of coordinates that are computed from the curve alone.
fn crossings<const K: usize>(curve: &Curve<2, K>, depth: u32) -> i32 {
    let is_above = |p: &[f64; 2]| p[1] >= 0.0;
    let above = curve.iter().filter(|p| is_above(p)).count();
    let right = curve.iter().filter(|p| p[0] > 0.0).count();
    if above == 0 || above == K || right == 0 {
        return 0;
    }
    let (from, to) = (curve[0], curve[K - 1]);
    let change = i32::from(is_above(&to)) - i32::from(is_above(&from));
    if right == K {
        return change;
    }
    if depth > 0 {
        let [a, b] = halves(curve);
        return crossings(&a, depth - 1) + crossings(&b, depth - 1);
    }
    // The sign of the place at which the chord crosses the axis.
    let place = from[0] * to[1] - to[0] * from[1];
    let rise = to[1] - from[1];
    if (place > 0.0) == (rise > 0.0) && place != 0.0 {
        change
    } else {
        0
    }
}

/// How often the border of a map to the plane, counter-clockwise in its parameters, winds around the origin.
pub(super) fn winding<const K: usize>(view: &Net<2, K>) -> i32 {
    (0..4).map(|side| side_of(view, side)).sum()
}

/// How often side `side` of a map crosses the axis, counter-clockwise in its parameters.
fn side_of<const K: usize>(view: &Net<2, K>, side: u8) -> i32 {
    match side {
        0 => crossings(&view.rows[0], DEPTH),
        1 => crossings(&view.column(K - 1), DEPTH),
        2 => -crossings(&view.rows[K - 1], DEPTH),
        _ => -crossings(&view.column(0), DEPTH),
    }
}

/// The border of a polynomial patch beside smaller ones: the sides that are not those of its net.
#[derive(Debug)]
pub(super) struct Border<const K: usize>(Box<[Side<K>]>);

/// A side of which the neighbours make two curves, in the direction counter-clockwise from `v = 0` on.
#[derive(Debug)]
struct Side<const K: usize> {
    number: u8,
    halves: [Curve<3, K>; 2],
}

/// The two halves of each side, where there are any.
pub(super) type Sides<const K: usize> = [Option<[Curve<4, K>; 2]>; 4];

impl<const K: usize> Default for Border<K> {
    fn default() -> Self {
        Self([].into())
    }
}

impl<const K: usize> Border<K> {
    /// The border with the halves of some sides, whose weights are 1.
    pub(super) fn new(sides: &Sides<K>) -> Self {
        let own = |halves: &[Curve<4, K>; 2]| halves.map(|half| half.map(|[x, y, z, _]| [x, y, z]));
        let numbered = (0_u8..).zip(sides);
        let all = numbered.filter_map(|(number, halves)| {
            let halves = own(halves.as_ref()?);
            Some(Side { number, halves })
        });
        Self(all.collect())
    }

    /// The bytes that it takes beside itself.
    pub(super) fn bytes(&self) -> usize {
        size_of_val(&*self.0)
    }

    /// How often the border of a net, counter-clockwise in its parameters, winds around the ray along which `see` sees its
    /// points.
    ///
    /// This is the number of points that lie over the ray, those at which the image is mirrored counted as -1 (the degree of
    /// a map).
    /// Of two patches with a common border curve, the curve counts in one as much as it is taken off in the other, to the
    /// last bit. So a ray through the border of a closed surface of patches meets exactly one of the two.
    pub(super) fn winding(&self, net: &Net<4, K>, see: impl Fn(&[f64; 4]) -> [f64; 2]) -> i32 {
        let view = net.map(&see);
        let half = |curve: &Curve<3, K>| {
            let seen = curve.map(|[x, y, z]| see(&[x, y, z, 1.0]));
            crossings(&seen, DEPTH)
        };
        let side = |number: u8| match self.0.iter().find(|side| side.number == number) {
            Some(side) => half(&side.halves[0]) + half(&side.halves[1]),
            None => side_of(&view, number),
        };
        (0..4).map(side).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conformance::Random;

    #[test]
    fn a_reversed_curve_crosses_the_other_way() {
        let mut random = Random::new(8);
        for round in 0..20_000 {
            let mut curve: Curve<2, 4> =
                std::array::from_fn(|_| std::array::from_fn(|_| random.between(-1.0, 1.0)));
            if round % 2 == 0 {
                // Exactly through the origin, up to rounding.
                let at = random.unit();
                let point = Net { rows: [curve; 4] }.at(at, 0.0);
                curve = curve.map(|p| [p[0] - point[0], p[1] - point[1]]);
            }
            let reversed = [curve[3], curve[2], curve[1], curve[0]];
            assert_eq!(crossings(&curve, DEPTH), -crossings(&reversed, DEPTH));
        }
    }

    #[test]
    fn the_winding_number_is_that_of_a_fine_polygon() {
        let mut random = Random::new(2);
        let mut seen = [0; 3];
        for _ in 0..2000 {
            let aside: [f64; 2] = std::array::from_fn(|_| random.between(-2.5, 2.5));
            let net = Net::<2, 4> {
                rows: std::array::from_fn(|j| {
                    std::array::from_fn(|i| {
                        [i, j].map(|k| k as f64 - 1.5 + 1.5 * random.between(-1.0, 1.0))
                    })
                }),
            }
            .map(|[x, y]| [x - aside[0], y - aside[1]]);
            let steps = 400;
            let at = |k: usize| {
                let (side, x) = (k / steps % 4, (k % steps) as f64 / steps as f64);
                match side {
                    0 => net.at(x, 0.0),
                    1 => net.at(1.0, x),
                    2 => net.at(1.0 - x, 1.0),
                    _ => net.at(0.0, 1.0 - x),
                }
            };
            let (mut turn, mut near) = (0.0, false);
            for k in 0..4 * steps {
                let (a, b) = (at(k), at(k + 1));
                near |= a[0].hypot(a[1]) < 0.02;
                turn += (a[0] * b[1] - a[1] * b[0]).atan2(a[0] * b[0] + a[1] * b[1]);
            }
            if !near {
                let expected = (turn / std::f64::consts::TAU).round() as i32;
                let solid = net.map(|[x, y]| [*x, *y, 0.0, 1.0]);
                let found = Border::default().winding(&solid, |p| [p[0], p[1]]);
                assert_eq!(found, expected);
                seen[expected.unsigned_abs().min(2) as usize] += 1;
            }
        }
        assert!(seen[0] > 50 && seen[1] > 500, "{seen:?}");
    }
}
