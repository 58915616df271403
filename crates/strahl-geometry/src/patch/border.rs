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

/// How often a plane curve crosses the axis between two of its parameters, which are halves of halves of it.
///
/// The numbers of neighbouring stretches add up to that of both together, because they come from the same halves of the curve.
fn crossings_between<const K: usize>(curve: &Curve<2, K>, [from, to]: [f64; 2], depth: u32) -> i32 {
    if to <= 0.0 || from >= 1.0 {
        return 0;
    }
    if from <= 0.0 && to >= 1.0 || depth == 0 {
        return crossings(curve, depth);
    }
    let [a, b] = halves(curve);
    crossings_between(&a, [2.0 * from, 2.0 * to], depth - 1)
        + crossings_between(&b, [2.0 * from - 1.0, 2.0 * to - 1.0], depth - 1)
}

/// The point of a curve at a parameter, as it is in the halves of halves that end there.
fn point<const K: usize>(curve: &Curve<2, K>, mut at: f64) -> [f64; 2] {
    let mut curve = *curve;
    for _ in 0..DEPTH {
        if at <= 0.0 {
            break;
        }
        if at >= 1.0 {
            return curve[K - 1];
        }
        let [a, b] = halves(&curve);
        at *= 2.0;
        (curve, at) = if at < 1.0 { (a, at) } else { (b, at - 1.0) };
    }
    curve[0]
}

fn reversed<const N: usize, const K: usize>(mut curve: Curve<N, K>) -> Curve<N, K> {
    curve.reverse();
    curve
}

/// How often the way between two points crosses the axis that are the same but for rounding, far from the origin.
fn gap(from: [f64; 2], to: [f64; 2]) -> i32 {
    if from[0] > 0.0 && to[0] > 0.0 {
        i32::from(to[1] >= 0.0) - i32::from(from[1] >= 0.0)
    } else {
        0
    }
}

/// The numbers from 0 to 1 in these steps are exact, and so are their differences and what halving leaves of them.
const STEP: f64 = f64::EPSILON / 2.0;

/// A rectangle of parameters, with sides at multiples of [`STEP`] from 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Region {
    from: [f64; 2],
    to: [f64; 2],
}

impl Region {
    pub(super) const WHOLE: Self = Self {
        from: [0.0; 2],
        to: [1.0; 2],
    };

    /// The smallest one that has all parameters so far around a place.
    pub(super) fn around(place: [f64; 2], reach: [f64; 2]) -> Self {
        // Without a reach that is a number it is the whole patch.
        let from = |k: usize| {
            let from = ((place[k] - reach[k]) / STEP).floor() * STEP;
            if from > 0.0 { from.min(1.0) } else { 0.0 }
        };
        let to = |k: usize| {
            let to = ((place[k] + reach[k]) / STEP).ceil() * STEP;
            if to < 1.0 { to.max(0.0) } else { 1.0 }
        };
        Self {
            from: [from(0), from(1)],
            to: [to(0), to(1)],
        }
    }

    pub(super) fn meets(&self, other: &Self) -> bool {
        (0..2).all(|k| self.from[k] <= other.to[k] && other.from[k] <= self.to[k])
    }

    /// The smallest one that has both.
    pub(super) fn with(&self, other: &Self) -> Self {
        Self {
            from: [0, 1].map(|k| self.from[k].min(other.from[k])),
            to: [0, 1].map(|k| self.to[k].max(other.to[k])),
        }
    }

    /// Where a side lies that is not one of the patch.
    fn inner_side(&self, number: u8) -> Option<f64> {
        match number {
            0 => (self.from[1] > 0.0).then_some(self.from[1]),
            1 => (self.to[0] < 1.0).then_some(self.to[0]),
            2 => (self.to[1] < 1.0).then_some(self.to[1]),
            _ => (self.from[0] > 0.0).then_some(self.from[0]),
        }
    }

    /// From where to where a side runs, in parts of that of the patch, counter-clockwise.
    fn stretch(&self, number: u8) -> [f64; 2] {
        match number {
            0 => [self.from[0], self.to[0]],
            1 => [self.from[1], self.to[1]],
            2 => [1.0 - self.to[0], 1.0 - self.from[0]],
            _ => [1.0 - self.to[1], 1.0 - self.from[1]],
        }
    }
}

/// How often a side of a region crosses the axis, counter-clockwise, and where it begins and ends.
struct Run {
    crossings: i32,
    from: [f64; 2],
    to: [f64; 2],
}

impl Run {
    fn of<const K: usize>(curve: &Curve<2, K>, [from, to]: [f64; 2]) -> Self {
        Self {
            crossings: crossings_between(curve, [from, to], DEPTH),
            from: point(curve, from),
            to: point(curve, to),
        }
    }

    fn of_halves<const K: usize>([a, b]: &[Curve<2, K>; 2], [from, to]: [f64; 2]) -> Self {
        let in_a = Self::of(a, [2.0 * from, 2.0 * to]);
        let in_b = Self::of(b, [2.0 * from - 1.0, 2.0 * to - 1.0]);
        Self {
            crossings: in_a.crossings + in_b.crossings,
            from: if from < 0.5 { in_a.from } else { in_b.from },
            to: if to > 0.5 { in_b.to } else { in_a.to },
        }
    }
}

/// Side `number` of a map, counter-clockwise in its parameters; within it, at parameter `at` across the side.
fn curve_of<const K: usize>(view: &Net<2, K>, number: u8, at: Option<f64>) -> Curve<2, K> {
    let curve: Curve<2, K> = match (number, at) {
        (0, None) => view.rows[0],
        (1, None) => view.column(K - 1),
        (2, None) => view.rows[K - 1],
        (_, None) => view.column(0),
        (0 | 2, Some(v)) => std::array::from_fn(|i| point(&view.column(i), v)),
        (_, Some(u)) => std::array::from_fn(|j| point(&view.rows[j], u)),
    };
    if number < 2 { curve } else { reversed(curve) }
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

    /// As [`Border::winding`], of the border of a region of the patch.
    ///
    /// Where this border lies within the patch it must pass the ray further away than rounding errors reach. Then this is the number of points of the region that
    /// lie over the ray, to the last bit as the neighbours count them: what the region has of the border of the patch, it has from the same halves of the same curves.
    pub(super) fn winding_of_region(
        &self,
        net: &Net<4, K>,
        region: &Region,
        see: impl Fn(&[f64; 4]) -> [f64; 2],
    ) -> i32 {
        let view = net.map(&see);
        let run = |number: u8| {
            let (inner, stretch) = (region.inner_side(number), region.stretch(number));
            match self.0.iter().find(|side| side.number == number) {
                Some(side) if inner.is_none() => {
                    let halves = side
                        .halves
                        .map(|half| half.map(|[x, y, z]| see(&[x, y, z, 1.0])));
                    Run::of_halves(&halves, stretch)
                }
                _ => Run::of(&curve_of(&view, number, inner), stretch),
            }
        };
        let runs = [run(0), run(1), run(2), run(3)];
        let mut sum = 0;
        for (k, run) in (0_u8..).zip(&runs) {
            sum += run.crossings;
            let next = (k + 1) % 4;
            // The border of the patch is closed to the last bit.
            if region.inner_side(k).is_some() || region.inner_side(next).is_some() {
                sum += gap(run.to, runs[usize::from(next)].from);
            }
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conformance::Random;

    #[test]
    fn stretches_of_a_curve_add_up_to_it() {
        let mut random = Random::new(9);
        for round in 0..5000 {
            let mut curve: Curve<2, 4> =
                std::array::from_fn(|_| std::array::from_fn(|_| random.between(-1.0, 1.0)));
            if round % 2 == 0 {
                // On a line through the origin: forth and back, up to rounding.
                let slope = random.between(-1.0, 1.0);
                curve = curve.map(|[x, _]| [x, slope * x]);
            }
            let at = (random.unit() / STEP).floor() * STEP;
            let [a, b] = [[0.0, at], [at, 1.0]].map(|s| crossings_between(&curve, s, DEPTH));
            assert_eq!(a + b, crossings(&curve, DEPTH));
            let back = crossings_between(&reversed(curve), [0.0, 1.0 - at], DEPTH);
            assert_eq!(back, -b);
            let end = point(&curve, at);
            assert_eq!(end, point(&reversed(curve), 1.0 - at));
            let exact = Net { rows: [curve; 4] }.at(at, 0.0);
            assert!((0..2).all(|k| (end[k] - exact[k]).abs() < 1e-15));
        }
    }

    /// Nine regions of a map, one of which has a corner of the patch, one a part of each side or none.
    #[test]
    fn regions_add_up_to_the_patch() {
        let mut random = Random::new(10);
        let mut seen = [0; 3];
        for round in 0..3000 {
            let net = Net::<4, 4> {
                rows: std::array::from_fn(|j| {
                    std::array::from_fn(|i| {
                        let [x, y] = [i, j].map(|k| k as f64 - 1.5 + random.between(-4.0, 4.0));
                        [x, y, 0.0, 1.0]
                    })
                }),
            };
            // Neighbours that know the same border in halves.
            let mut sides = [None; 4];
            for (number, side) in (0_u8..).zip(&mut sides) {
                if (round >> number) % 2 == 1 {
                    let curve = match number {
                        0 => net.rows[0],
                        1 => net.column(3),
                        2 => reversed(net.rows[3]),
                        _ => reversed(net.column(0)),
                    };
                    *side = Some(halves(&curve));
                }
            }
            let border = Border::new(&sides);
            let see = |p: &[f64; 4]| [p[0], p[1]];
            let cuts = [(); 2].map(|()| {
                let [a, b] = [(); 2].map(|()| (random.unit() / STEP).floor() * STEP);
                [0.0, a.min(b), a.max(b), 1.0]
            });
            let mut sum = 0;
            for k in 0..9 {
                let (i, j) = (k % 3, k / 3);
                let region = Region {
                    from: [cuts[0][i], cuts[1][j]],
                    to: [cuts[0][i + 1], cuts[1][j + 1]],
                };
                let winding = border.winding_of_region(&net, &region, see);
                seen[(winding.signum() + 1) as usize] += 1;
                sum += winding;
            }
            let whole = border.winding_of_region(&net, &Region::WHOLE, see);
            assert_eq!((whole, sum), (border.winding(&net, see), whole));
        }
        assert!(seen.iter().all(|n| *n > 20), "{seen:?}");
    }

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
