use std::cell::RefCell;

use strahl_math::noise::{NoiseGenerator, lattice_hash, noise};
use strahl_math::{DVec3, det};
use strahl_simd::{Isa, Simd, dispatch};

use super::blocks;
use super::random::{numbers, uniform};

/// The cell of the unit lattice around `p`.
fn cell(p: DVec3) -> [i64; 3] {
    p.floor().to_array().map(|f| f as i64)
}

/// A random number per unit cube.
pub(super) fn cells(p: DVec3) -> f64 {
    uniform(lattice_hash(cell(p + blocks::BORDER)))
}

/// How crackle measures distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CrackleMetric {
    /// `|x| + |y| + |z|`.
    Manhattan,
    /// `sqrt(x² + y² + z²)`.
    Euclidean,
    /// `(|x|ᵐ + |y|ᵐ + |z|ᵐ)^(1/m)`.
    Power(f64),
}

impl CrackleMetric {
    /// The metric with POV-Ray's number `m`.
    pub fn from_number(m: f64) -> Self {
        if m == 1.0 {
            Self::Manhattan
        } else if m == 2.0 {
            Self::Euclidean
        } else {
            Self::Power(m)
        }
    }

    /// The sum over coordinates and offset that [`CrackleMetric::distance_of`] converts to a distance. As in POV-Ray (measured) the points
    /// with the smallest sums count as the nearest, also for negative powers, where they are the farthest; and the offset keeps its sign, so
    /// that its power is below zero or not a number where it is negative and the power is odd or broken.
    #[inline]
    fn measure(self, v: DVec3, offset: f64) -> f64 {
        self.part(v.x) + self.part(v.y) + self.part(v.z) + self.rest(offset)
    }

    /// The contribution of the offset.
    #[inline]
    fn rest(self, offset: f64) -> f64 {
        match self {
            Self::Manhattan => offset,
            Self::Euclidean => offset * offset,
            Self::Power(_) if offset == 0.0 => 0.0,
            Self::Power(m) => det::pow(offset, m),
        }
    }

    #[inline(always)]
    fn distance_of(self, measure: f64) -> f64 {
        match self {
            Self::Manhattan => measure,
            Self::Euclidean => measure.sqrt(),
            Self::Power(m) => det::pow(measure, 1.0 / m),
        }
    }

    /// The contribution of one coordinate to the measure.
    #[inline]
    fn part(self, x: f64) -> f64 {
        match self {
            Self::Manhattan => x.abs(),
            Self::Euclidean => x * x,
            Self::Power(m) => det::pow(x.abs(), m),
        }
    }

    /// The contributions of four coordinates.
    #[inline(always)]
    fn parts(self, x: [f64; 4]) -> [f64; 4] {
        match self {
            Self::Power(m) => {
                let x = x.map(f64::abs);
                dispatch!(Simd::best(), isa => det::powers(isa, &x, m))
            }
            _ => x.map(|x| self.part(x)),
        }
    }

    /// Whether larger coordinates never give a smaller measure.
    fn is_monotone(self) -> bool {
        match self {
            Self::Manhattan | Self::Euclidean => true,
            Self::Power(m) => m > 0.0,
        }
    }
}

/// Cellular texture (Worley, "A Cellular Texture Basis Function", SIGGRAPH 1996): each unit cube holds one random point, and
/// the value is a combination of the distances to the nearest three.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crackle {
    /// Factors of the distances to the nearest, second and third nearest point; `<-1, 1, 0>` by default.
    pub form: DVec3,
    /// The metric; Euclidean by default.
    pub metric: CrackleMetric,
    /// Distance along a fourth dimension; 0 by default.
    pub offset: f64,
    /// One value for all that is nearest to the same point.
    pub solid: bool,
}

impl Default for Crackle {
    fn default() -> Self {
        Self {
            form: DVec3::new(-1.0, 1.0, 0.0),
            metric: CrackleMetric::Euclidean,
            offset: 0.0,
            solid: false,
        }
    }
}

/// The random point that is nearest to `p`.
pub(crate) fn nearest_point(p: DVec3) -> DVec3 {
    let crackle = Crackle {
        solid: true,
        ..Crackle::default()
    };
    crackle.search(CrackleMetric::Euclidean, p).center
}

/// The 5³ cubes around a cube, except those that are two cubes away in more than one direction. First the inner 3³, then the others; both
/// by their distances from a point in the lower half of the cube along each axis.
const NEIGHBOURS: [[i64; 3]; 81] = {
    /// 16 times the squared distances from 1/4 to the cubes from -2 to 2.
    const SQUARES: [u32; 5] = [25, 1, 0, 9, 49];
    let mut all = [[0; 3]; 81];
    let (mut count, mut outer, mut square) = (0, 0, 0);
    while outer < 2 {
        let mut n = 0;
        while n < 125 {
            let d = [n / 25, n / 5 % 5, n % 5];
            let two_away = (d[0] % 4 == 0) as u32 + (d[1] % 4 == 0) as u32 + (d[2] % 4 == 0) as u32;
            if two_away == outer && SQUARES[d[0]] + SQUARES[d[1]] + SQUARES[d[2]] == square {
                all[count] = [d[0] as i64 - 2, d[1] as i64 - 2, d[2] as i64 - 2];
                count += 1;
            }
            n += 1;
        }
        square += 1;
        if square > 49 + 9 + 9 {
            (outer, square) = (outer + 1, 0);
        }
    }
    all
};

/// The number of the inner ones.
const INNER: usize = 27;

impl Crackle {
    /// The value at `p`, cut off at 0 and 1.
    // Not inline: its loops are many for the other patterns' function.
    #[inline(never)]
    pub(super) fn value(&self, p: DVec3, generator: NoiseGenerator) -> f64 {
        // Each metric has its own loop.
        match self.metric {
            CrackleMetric::Manhattan => self.value_by(CrackleMetric::Manhattan, p, generator),
            CrackleMetric::Euclidean => self.value_by(CrackleMetric::Euclidean, p, generator),
            metric => self.value_by(metric, p, generator),
        }
    }

    #[inline(always)]
    fn value_by(&self, metric: CrackleMetric, p: DVec3, generator: NoiseGenerator) -> f64 {
        let nearest = self.search(metric, p);
        if self.solid {
            return noise(nearest.center, generator);
        }
        let used = nearest.measures.into_iter().zip(self.form.to_array());
        let value = used
            .take(self.counting())
            .map(|(measure, factor)| match measure < f64::INFINITY {
                true => metric.distance_of(measure) * factor,
                // No point was nearer: the measures are no numbers.
                false => f64::NAN,
            })
            .fold(0.0, |sum, part| sum + part);
        // As in POV-Ray (measured) a distance that is no number gives 0.
        if value > 0.0 { value.min(1.0) } else { 0.0 }
    }

    /// How many of the nearest points matter.
    fn counting(&self) -> usize {
        match self.form {
            _ if self.solid => 1,
            form if form.z != 0.0 => 3,
            form if form.y != 0.0 => 2,
            _ => 1,
        }
    }

    /// The measures of the nearest points, as many as matter, and the nearest point.
    ///
    /// They are searched in the [`NEIGHBOURS`] of the cube of `p`. Cubes farther away than the nearest points found so far are skipped;
    /// usually these are all cubes two cubes away. Distances without powers are cheap: the points of the inner cubes are taken four
    /// at a time, whatever their cubes' distances are.
    #[inline(always)]
    fn search(&self, metric: CrackleMetric, p: DVec3) -> Nearest {
        let home = cell(p);
        let fraction = p - p.floor();
        // The contributions of the gaps between p and the cubes along each axis.
        let none = metric.part(0.0);
        let gaps = |f: f64| {
            let [a, b, c, d] = metric.parts([f + 1.0, f, 1.0 - f, 2.0 - f]);
            [a, b, none, c, d]
        };
        let gaps = [gaps(fraction.x), gaps(fraction.y), gaps(fraction.z)];
        let rest = metric.rest(self.offset);
        let last = self.counting() - 1;
        let is_monotone = metric.is_monotone();
        // The least measure of a point of a cube; rounding errors must not make a cube appear farther away than it is.
        let least = |gap: f64| match is_monotone {
            true => gap * (1.0 - 1e-12) + rest,
            false => f64::NEG_INFINITY,
        };
        // The neighbours are sorted for a point in the lower half along each axis, otherwise they are mirrored.
        let signs = fraction.to_array().map(|f| if f > 0.5 { -1 } else { 1 });
        let random = numbers();
        // The point in a neighbour, unless all of its points are farther away than those found.
        let point = |d: &[i64; 3], nearest: &Nearest| {
            let [i, j, k] = [d[0] * signs[0], d[1] * signs[1], d[2] * signs[2]];
            let gap =
                gaps[0][(i + 2) as usize] + gaps[1][(j + 2) as usize] + gaps[2][(k + 2) as usize];
            if least(gap) > nearest.measures[last] {
                return None;
            }
            let cell = [
                home[0].wrapping_add(i),
                home[1].wrapping_add(j),
                home[2].wrapping_add(k),
            ];
            let h = lattice_hash(cell);
            let corner = DVec3::new(cell[0] as f64, cell[1] as f64, cell[2] as f64);
            Some(corner + DVec3::new(random[h], random[h + 1], random[h + 2]))
        };
        let mut nearest = match metric {
            CrackleMetric::Power(m) => {
                let mut nearest = Nearest::none(p);
                let (mut places, mut count) = ([p; 4], 0);
                for d in &NEIGHBOURS[..INNER] {
                    if let Some(place) = point(d, &nearest) {
                        places[count] = place;
                        count += 1;
                    }
                    if count == 4 {
                        insert_by_power(&mut nearest, p, &places, m, rest);
                        count = 0;
                    }
                }
                insert_by_power(&mut nearest, p, &places[..count], m, rest);
                nearest
            }
            _ => self.nearest_inside(metric, p, home),
        };
        let outer = |g: &[f64; 5]| smaller(g[0], g[4]);
        let outer = smaller(smaller(outer(&gaps[0]), outer(&gaps[1])), outer(&gaps[2]));
        if least(outer) > nearest.measures[last] {
            return nearest;
        }
        for d in &NEIGHBOURS[INNER..] {
            if let Some(place) = point(d, &nearest) {
                nearest.insert(metric.measure(p - place, self.offset), place);
            }
        }
        nearest
    }

    /// The nearest points of the 3³ cubes around a cube, by a metric without powers.
    #[inline(always)]
    fn nearest_inside(&self, metric: CrackleMetric, p: DVec3, home: [i64; 3]) -> Nearest {
        let rest = metric.rest(self.offset);
        Points::around(home, |points| {
            let (measures, all) = match (metric, self.solid) {
                (CrackleMetric::Manhattan, false) => {
                    let measures =
                        dispatch!(Simd::best(), isa => smallest::<_, true>(isa, points, p, rest).0);
                    return Nearest {
                        measures,
                        center: p,
                    };
                }
                (_, false) => {
                    let measures = dispatch!(Simd::best(), isa => smallest::<_, false>(isa, points, p, rest).0);
                    return Nearest {
                        measures,
                        center: p,
                    };
                }
                (CrackleMetric::Manhattan, true) => {
                    dispatch!(Simd::best(), isa => smallest::<_, true>(isa, points, p, rest))
                }
                (_, true) => {
                    dispatch!(Simd::best(), isa => smallest::<_, false>(isa, points, p, rest))
                }
            };
            let found = all
                .iter()
                .flatten()
                .zip(0..)
                .find(|(measure, _)| **measure == measures[0]);
            let center = found.map_or(p, |(_, n)| points.place(n));
            Nearest { measures, center }
        })
    }
}

/// Puts up to four points among the nearest to `p` by the metric with powers `m`, all at once: their measures are what takes the time. `rest` is
/// the contribution of the offset.
#[inline(never)]
fn insert_by_power(nearest: &mut Nearest, p: DVec3, places: &[DVec3], m: f64, rest: f64) {
    // Lanes without a point have numbers that are raised as fast as others.
    let mut gaps = [[1.0; 4]; 3];
    for (lane, place) in places.iter().enumerate() {
        let gap = (p - *place).abs();
        (gaps[0][lane], gaps[1][lane], gaps[2][lane]) = (gap.x, gap.y, gap.z);
    }
    let [x, y, z] = dispatch!(Simd::best(), isa => powers_of(isa, &gaps, m));
    for (lane, place) in places.iter().enumerate() {
        nearest.insert(x[lane] + y[lane] + z[lane] + rest, *place);
    }
}

/// All coordinates to the power of `m`.
#[inline(always)]
fn powers_of<I: Isa>(isa: I, gaps: &[[f64; 4]; 3], m: f64) -> [[f64; 4]; 3] {
    let [x, y, z] = gaps;
    [
        det::powers(isa, x, m),
        det::powers(isa, y, m),
        det::powers(isa, z, m),
    ]
}

/// The three smallest measures from `p` to the points, and all measures, by the Manhattan metric or the Euclidean one; `rest` is
/// the contribution of the offset.
#[inline(always)]
fn smallest<I: Isa, const MANHATTAN: bool>(
    isa: I,
    points: &Points,
    p: DVec3,
    rest: f64,
) -> ([f64; 3], [[f64; 4]; CHUNKS]) {
    let p = [isa.splat(p.x), isa.splat(p.y), isa.splat(p.z)];
    let rest = isa.splat(rest);
    let far = isa.splat(f64::INFINITY);
    let (mut first, mut second, mut third) = (far, far, far);
    let mut measures = [[0.0; 4]; CHUNKS];
    for (chunk, measures) in measures.iter_mut().enumerate() {
        let mut parts = [far; 3];
        for axis in 0..3 {
            let d = isa.sub(p[axis], isa.load(&points.places[axis][chunk]));
            parts[axis] = if MANHATTAN { isa.abs(d) } else { isa.mul(d, d) };
        }
        let measure = isa.add(isa.add(isa.add(parts[0], parts[1]), parts[2]), rest);
        *measures = isa.store(measure);
        let larger = isa.max(measure, first);
        first = isa.min(measure, first);
        let largest = isa.max(larger, second);
        second = isa.min(larger, second);
        third = isa.min(largest, third);
    }
    // Of each lane there are three, in ascending order.
    let (first, second, third) = (isa.store(first), isa.store(second), isa.store(third));
    let [a, b, c, d] = [
        [first[0], second[0], third[0]],
        [first[1], second[1], third[1]],
        [first[2], second[2], third[2]],
        [first[3], second[3], third[3]],
    ];
    (merged(merged(a, b), merged(c, d)), measures)
}

/// The three smallest of twice three numbers in ascending order, without branches, which nobody could predict.
#[inline(always)]
fn merged(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    let crossed = smaller(larger(a[0], b[1]), larger(a[1], b[0]));
    [
        smaller(a[0], b[0]),
        smaller(larger(a[0], b[0]), smaller(a[1], b[1])),
        smaller(crossed, smaller(a[2], b[2])),
    ]
}

#[inline(always)]
fn smaller(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

#[inline(always)]
fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// The measures of the three nearest points found so far in ascending order, and the nearest point.
#[derive(Clone, Copy, Debug)]
struct Nearest {
    measures: [f64; 3],
    center: DVec3,
}

impl Nearest {
    fn none(p: DVec3) -> Self {
        Self {
            measures: [f64::INFINITY; 3],
            center: p,
        }
    }

    #[inline(always)]
    fn insert(&mut self, measure: f64, place: DVec3) {
        let [first, second, third] = self.measures;
        if measure < first {
            self.measures = [measure, first, second];
            self.center = place;
        } else if measure < second {
            self.measures = [first, measure, second];
        } else if measure < third {
            self.measures[2] = measure;
        }
    }
}

/// The inner cubes in fours.
const CHUNKS: usize = INNER.div_ceil(4);

/// The points in the 3³ cubes around a cube, four at a time; those left over are infinitely far away.
struct Points {
    home: [i64; 3],
    places: [[[f64; 4]; CHUNKS]; 3],
}

impl Points {
    const NONE: Self = Self {
        home: [i64::MIN; 3],
        places: [[[f64::INFINITY; 4]; CHUNKS]; 3],
    };

    /// Calls `use_points` with the points around the cube `home`. Each thread remembers those of a few cubes: neighbouring pixels and
    /// the points around which a normal is tilted are mostly in the same one.
    #[inline(always)]
    fn around<R>(home: [i64; 3], use_points: impl FnOnce(&Self) -> R) -> R {
        const SLOTS: usize = 8;
        thread_local! {
            static LAST: RefCell<[Points; SLOTS]> = const { RefCell::new([Points::NONE; SLOTS]) };
        }
        let [i, j, k] = home;
        let mixed = i
            .wrapping_add(j.wrapping_mul(3))
            .wrapping_add(k.wrapping_mul(5));
        let slot = mixed.rem_euclid(SLOTS as i64);
        LAST.with_borrow_mut(|slots| {
            let points = &mut slots[slot as usize];
            if points.home != home {
                points.fill(home);
            }
            use_points(points)
        })
    }

    #[inline(never)]
    fn fill(&mut self, home: [i64; 3]) {
        self.home = home;
        let random = numbers();
        for n in 0..INNER {
            let steps = [n / 9, n / 3 % 3, n % 3];
            let cell: [i64; 3] =
                std::array::from_fn(|axis| home[axis].wrapping_add(steps[axis] as i64 - 1));
            let h = lattice_hash(cell);
            for axis in 0..3 {
                self.places[axis][n / 4][n % 4] = cell[axis] as f64 + random[h + axis];
            }
        }
    }

    fn place(&self, n: usize) -> DVec3 {
        let along = |axis: usize| self.places[axis][n / 4][n % 4];
        DVec3::new(along(0), along(1), along(2))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn merging_finds_the_smallest() {
        let triples: Vec<[f64; 3]> = (0..125)
            .map(|n| {
                [n / 25, n / 5 % 5, n % 5]
                    .map(|k| if k == 4 { f64::INFINITY } else { f64::from(k) })
            })
            .filter(|t| t.is_sorted())
            .collect();
        for a in &triples {
            for b in &triples {
                let mut all = [*a, *b].concat();
                all.sort_by(f64::total_cmp);
                assert_eq!(merged(*a, *b)[..], all[..3], "{a:?} {b:?}");
            }
        }
    }

    /// The value from all cubes, without skipping.
    fn slowly(crackle: &Crackle, p: DVec3) -> f64 {
        let mut all: Vec<f64> = NEIGHBOURS
            .iter()
            .map(|d| {
                let home = cell(p);
                let cell: [i64; 3] = std::array::from_fn(|axis| home[axis] + d[axis]);
                let h = lattice_hash(cell);
                let place = DVec3::from_array(cell.map(|c| c as f64))
                    + DVec3::new(uniform(h), uniform(h + 1), uniform(h + 2));
                crackle.metric.measure(p - place, crackle.offset)
            })
            .collect();
        all.sort_by(f64::total_cmp);
        let [a, b, c] = [0, 1, 2].map(|n| crackle.metric.distance_of(all[n]));
        let form = crackle.form;
        let used = |f: f64, d: f64| if f == 0.0 { 0.0 } else { d * f };
        let value = used(form.x, a) + used(form.y, b) + used(form.z, c);
        if value.is_nan() {
            0.0
        } else {
            value.clamp(0.0, 1.0)
        }
    }

    #[test]
    fn cubes_passed_over_don_t_matter() {
        for metric in [1.0, 2.0, 0.5, 1.5, 3.0, 20.0, -1.0] {
            for form in [
                DVec3::new(-1.0, 1.0, 0.0),
                DVec3::X,
                DVec3::new(0.3, -0.2, 0.4),
            ] {
                for offset in [0.25, 0.0, -0.25] {
                    let crackle = Crackle {
                        form,
                        metric: CrackleMetric::from_number(metric),
                        offset,
                        solid: false,
                    };
                    for i in 0..200 {
                        let t = f64::from(i);
                        let p = DVec3::new(t * 0.731 - 40.0, t * 0.317 + 3.0, 9.0 - t * 0.613);
                        let value = crackle.value(p, NoiseGenerator::RangeCorrected);
                        let expected = slowly(&crackle, p);
                        assert_eq!(value, expected, "{metric} {offset} {form} {p}");
                    }
                }
            }
        }
    }

    #[test]
    fn all_instruction_sets_find_the_same_points() {
        for i in 0..100 {
            let t = f64::from(i);
            let p = DVec3::new(t * 0.731 - 40.0, t * 0.317 + 3.0, 9.0 - t * 0.613);
            Points::around(cell(p), |points| {
                let found = |simd| {
                    let squares =
                        dispatch!(simd, isa => smallest::<_, false>(isa, points, p, 0.25));
                    let sums = dispatch!(simd, isa => smallest::<_, true>(isa, points, p, -0.5));
                    (squares, sums)
                };
                for simd in Simd::available() {
                    assert_eq!(found(simd), found(Simd::best()), "{p}, {}", simd.level());
                }
            });
        }
    }

    #[test]
    fn neighbours_are_81_different_cubes() {
        let all: std::collections::BTreeSet<_> = NEIGHBOURS.into_iter().collect();
        assert_eq!(all.len(), 81);
        assert_eq!(NEIGHBOURS[0], [0, 0, 0]);
        let is_inner = |d: &[i64; 3]| d.iter().all(|d| d.abs() < 2);
        assert_eq!(NEIGHBOURS.iter().position(|d| !is_inner(d)), Some(INNER));
        assert!(!NEIGHBOURS[INNER..].iter().any(is_inner));
    }
}
