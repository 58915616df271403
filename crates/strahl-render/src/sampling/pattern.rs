//! Places of the samples within a pixel: one in each cell of a grid, and in each of the finer columns and rows; or on rings around its centre.

use std::f64::consts::{FRAC_1_SQRT_2, TAU};
use strahl_math::det;

/// The places of `cells` x `cells` samples in pixel `(x, y)`, in pixels from its top left corner.
pub(super) fn grid(cells: u32, x: u32, y: u32, seed: u64) -> Places {
    Places::Cells(Cells::new(cells, false, Pixel::new(x, y, seed)))
}

/// The places of further samples in pixel `(x, y)`, whose centre has its sample, in pixels from its top left corner: so many that the error is
/// at most that of `depth` x `depth` samples, jittered independently.
///
/// Rings around the centre, turned by a random angle, need fewer samples for this than grids: three, six and twelve for the first depths
/// (docs/src/performance.md has a table of errors; the test below compares both).
pub(super) fn around_center(depth: u32, x: u32, y: u32, seed: u64) -> Places {
    let pixel = Pixel::new(x, y, seed);
    match depth {
        2 => Places::Rings(Rings::new(&[Ring::THREE], pixel)),
        3 => Places::Rings(Rings::new(&[Ring::SIX], pixel)),
        4 => Places::Rings(Rings::new(&[Ring::FOUR, Ring::EIGHT], pixel)),
        cells => Places::Cells(Cells::new(cells, true, pixel)),
    }
}

/// The places of the samples of one pixel.
pub(super) enum Places {
    Cells(Cells),
    Rings(Rings),
}

impl Iterator for Places {
    type Item = (f64, f64);

    fn next(&mut self) -> Option<(f64, f64)> {
        match self {
            Self::Cells(cells) => cells.next(),
            Self::Rings(rings) => rings.next(),
        }
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        let left = match self {
            Self::Cells(cells) => cells.left(),
            Self::Rings(rings) => rings.left(),
        };
        (left as usize, Some(left as usize))
    }
}

impl ExactSizeIterator for Places {}

/// Places on a circle around the centre of the pixel, at equal distances.
struct Ring {
    places: u32,
    /// In pixels.
    radius: f64,
    /// Cosine and sine of the angle between neighbours.
    step: (f64, f64),
}

impl Ring {
    // Of radii in steps of 0.01 to 0.02 these have nearly the least error over straight edges.
    const THREE: Self = Self::new(3, 0.38, (-0.5, SIN_60));
    const SIX: Self = Self::new(6, 0.41, (0.5, SIN_60));
    const FOUR: Self = Self::new(4, 0.23, (0.0, 1.0));
    const EIGHT: Self = Self::new(8, 0.46, (FRAC_1_SQRT_2, FRAC_1_SQRT_2));

    const fn new(places: u32, radius: f64, step: (f64, f64)) -> Self {
        Self {
            places,
            radius,
            step,
        }
    }
}

/// The sine of 60 degrees.
const SIN_60: f64 = 0.866_025_403_784_438_6;

/// The places on rings around the centre, ring by ring.
pub(super) struct Rings {
    /// The ring of the next place, and those after it.
    rings: &'static [Ring],
    /// The number of the next place in its ring.
    next: u32,
    /// Direction of the next place from the centre.
    direction: (f64, f64),
    /// Direction of the first place of each ring.
    first: (f64, f64),
}

impl Rings {
    fn new(rings: &'static [Ring], pixel: Pixel) -> Self {
        let (sin, cos) = det::sin_cos(TAU * pixel.jitter(0).0);
        Self {
            rings,
            next: 0,
            direction: (cos, sin),
            first: (cos, sin),
        }
    }

    fn next(&mut self) -> Option<(f64, f64)> {
        let (ring, others) = self.rings.split_first()?;
        let (x, y) = self.direction;
        self.next += 1;
        if self.next < ring.places {
            let (cos, sin) = ring.step;
            self.direction = (x * cos - y * sin, x * sin + y * cos);
        } else {
            (self.rings, self.next, self.direction) = (others, 0, self.first);
        }
        Some((0.5 + ring.radius * x, 0.5 + ring.radius * y))
    }

    fn left(&self) -> u32 {
        self.rings.iter().map(|ring| ring.places).sum::<u32>() - self.next
    }
}

/// The places of a grid, one in each cell, cell by cell, row by row.
///
/// The places are jittered in cells of cells, so that seen along either axis they are as even as along the diagonals (correlated
/// multi-jittered sampling: Kensler, Pixar Technical Memo 13-01, 2013). Straight edges come out with 0.82 of the error that grids of nine samples
/// with independent jitter leave. The numbers depend on pixel, cell and seed only.
pub(super) struct Cells {
    cells: u32,
    pixel: Pixel,
    /// Keys of the permutations of columns and rows.
    columns: u32,
    rows: u32,
    /// A cell that is left out.
    middle: Option<u32>,
    next: u32,
}

impl Cells {
    /// `cells` x `cells` places. If the sample at the centre is `center_known`, it stands for the cell in the middle of an odd grid.
    fn new(cells: u32, center_known: bool, pixel: Pixel) -> Self {
        let middle = (center_known && cells % 2 == 1).then_some(cells * cells / 2);
        Self {
            cells,
            pixel,
            columns: pixel.key(0),
            rows: pixel.key(1),
            middle,
            next: 0,
        }
    }

    fn next(&mut self) -> Option<(f64, f64)> {
        if Some(self.next) == self.middle {
            self.next += 1;
        }
        let (n, index) = (self.cells, self.next);
        if index >= n * n {
            return None;
        }
        self.next += 1;
        if n == 1 {
            return Some((0.5, 0.5));
        }
        let (column, row) = (index % n, index / n);
        // In a column of cells every sample has a finer column of its own, the same order for all columns; and likewise for rows.
        let (fine_column, fine_row) =
            (permute(row, n, self.columns), permute(column, n, self.rows));
        let (jx, jy) = self.pixel.jitter(index);
        let size = f64::from(n);
        Some((
            (f64::from(column) + (f64::from(fine_column) + jx) / size) / size,
            (f64::from(row) + (f64::from(fine_row) + jy) / size) / size,
        ))
    }

    fn left(&self) -> u32 {
        let left_out = self.middle.is_some_and(|middle| middle >= self.next);
        self.cells * self.cells - self.next - u32::from(left_out)
    }
}

/// The source of a pixel's numbers: SplitMix64 (Steele, Lea, Flood 2014) over the mixed inputs.
#[derive(Clone, Copy)]
struct Pixel(u64);

const STEP: u64 = 0x9e37_79b9_7f4a_7c15;

fn mix(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

impl Pixel {
    fn new(x: u32, y: u32, seed: u64) -> Self {
        let place = u64::from(y) << 32 | u64::from(x);
        Self(mix(seed.wrapping_add(STEP) ^ mix(place.wrapping_add(STEP))))
    }

    /// Two numbers in `0..1` for a cell.
    fn jitter(self, index: u32) -> (f64, f64) {
        let first = mix(self.0.wrapping_add(STEP.wrapping_mul(u64::from(index) + 1)));
        let unit = |bits: u64| (bits >> 40) as f64 / (1u64 << 24) as f64;
        (unit(first), unit(first << 24))
    }

    fn key(self, number: u32) -> u32 {
        (mix(self.0 ^ STEP) >> (32 * number)) as u32
    }
}

/// The place of `index` in a permutation of `0..n` that the key chooses: a walk along the cycles of a permutation of the next power of two.
fn permute(index: u32, n: u32, key: u32) -> u32 {
    let mask = n.next_power_of_two() - 1;
    let mut i = index;
    loop {
        // Each step is one to one on the numbers up to the mask: adding, multiplying by an odd number, shifting onto lower bits.
        i = i.wrapping_add(key) & mask;
        i = i.wrapping_mul(0x9e37_79b1 | 1) & mask;
        i ^= (i & mask) >> 1;
        i = i.wrapping_add(key >> 16) & mask;
        i = i.wrapping_mul((key >> 7) | 1) & mask;
        i ^= (i & mask) >> 2;
        i = i.wrapping_add(key >> 24) & mask;
        if i < n {
            return i;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn every_cell_column_and_row_has_its_sample() {
        for n in [2, 3, 4, 5, 7, 9, 64] {
            for x in 0..20 {
                let all: Vec<_> = grid(n, x, 3, 99).collect();
                assert_eq!(all.len(), (n * n) as usize);
                for (i, (px, py)) in all.iter().enumerate() {
                    let cell = ((px * f64::from(n)) as u32, (py * f64::from(n)) as u32);
                    assert_eq!(cell, (i as u32 % n, i as u32 / n));
                }
                let fine = f64::from(n * n);
                let columns: BTreeSet<_> = all.iter().map(|p| (p.0 * fine) as u32).collect();
                let rows: BTreeSet<_> = all.iter().map(|p| (p.1 * fine) as u32).collect();
                assert_eq!((columns.len(), rows.len()), (all.len(), all.len()));
            }
        }
        let some = |x, seed| grid(4, x, 3, seed).collect::<Vec<_>>();
        assert_ne!(some(17, 99), some(18, 99));
        assert_ne!(some(17, 98), some(17, 99));
    }

    #[test]
    fn a_known_centre_stands_for_the_cell_in_the_middle() {
        assert_eq!(around_center(1, 1, 1, 0).count(), 0);
        assert_eq!(around_center(6, 1, 1, 0).count(), 36);
        let bits = |(x, y): (f64, f64)| (x.to_bits(), y.to_bits());
        let without: BTreeSet<_> = around_center(5, 1, 1, 0).map(bits).collect();
        let with: BTreeSet<_> = grid(5, 1, 1, 0).map(bits).collect();
        assert!(without.is_subset(&with) && without.len() == 24);
    }

    #[test]
    fn places_on_rings_are_at_equal_angles_in_the_pixel() {
        for (depth, counts) in [(2, vec![3]), (3, vec![6]), (4, vec![4, 8])] {
            for x in 0..20 {
                let mut places = around_center(depth, x, 3, 99);
                for &count in &counts {
                    assert!(places.len() >= count);
                    let ring: Vec<_> = places.by_ref().take(count).collect();
                    let angle = |(px, py): (f64, f64)| (py - 0.5).atan2(px - 0.5);
                    for (i, &(px, py)) in ring.iter().enumerate() {
                        assert!((0.0..1.0).contains(&px) && (0.0..1.0).contains(&py));
                        let turned = angle((px, py)) - angle(ring[0]);
                        let wanted = TAU * i as f64 / count as f64;
                        assert!((turned.rem_euclid(TAU) - wanted).abs() < 1e-12);
                    }
                }
                assert_eq!((places.len(), places.next()), (0, None));
            }
        }
    }

    /// Something that a pixel shows: black or white at a place.
    type Shows = Box<dyn Fn(f64, f64) -> bool>;

    /// A number in `0..1` for test `index`.
    fn number(index: u32, which: u32) -> f64 {
        Pixel::new(index, which, 77).jitter(0).0
    }

    /// A straight edge between the centres of the pixel and a neighbour, in any direction.
    fn edge(index: u32) -> Shows {
        let (ny, nx) = det::sin_cos(TAU * number(index, 0));
        let c = 0.5 * (nx + ny) + 0.7 * (2.0 * number(index, 1) - 1.0);
        Box::new(move |x, y| nx * x + ny * y < c)
    }

    /// A line of a third of the pixel's width.
    fn thin_line(index: u32) -> Shows {
        let (ny, nx) = det::sin_cos(TAU * number(index, 2));
        let c = 0.5 * (nx + ny) + 0.6 * (2.0 * number(index, 3) - 1.0);
        Box::new(move |x, y| (nx * x + ny * y - c).abs() < 1.0 / 6.0)
    }

    /// Stripes, as wide as 0.2 to 0.5 of the pixel.
    fn stripes(index: u32) -> Shows {
        let (ny, nx) = det::sin_cos(TAU * number(index, 4));
        let (width, start) = (0.2 + 0.3 * number(index, 5), number(index, 6));
        Box::new(move |x, y| ((nx * x + ny * y) / width + start).rem_euclid(2.0) < 1.0)
    }

    fn mean(shows: &Shows, places: impl Iterator<Item = (f64, f64)>) -> f64 {
        let (white, all) = places.fold((0, 0), |(white, all), (x, y)| {
            (white + u32::from(shows(x, y)), all + 1)
        });
        f64::from(white) / f64::from(all)
    }

    #[test]
    fn rings_have_less_error_than_jittered_grids() {
        let fine = || (0..48 * 48).map(|i| (f64::from(i % 48), f64::from(i / 48)));
        for content in [edge, thin_line, stripes] {
            for depth in 2..=4 {
                let (mut rings, mut jittered) = (0.0, 0.0);
                for index in 0..1000 {
                    let shows = content(index);
                    let truth = mean(
                        &shows,
                        fine().map(|(x, y)| ((x + 0.5) / 48.0, (y + 0.5) / 48.0)),
                    );
                    let known = std::iter::once((0.5, 0.5));
                    let sampled = mean(&shows, known.chain(around_center(depth, index, 1, 5)));
                    let pixel = Pixel::new(index, 2, 5);
                    let cells = (0..depth * depth).map(|cell| {
                        let (jx, jy) = pixel.jitter(cell);
                        let at = |i: u32, jitter: f64| (f64::from(i) + jitter) / f64::from(depth);
                        (at(cell % depth, jx), at(cell / depth, jy))
                    });
                    rings += (sampled - truth).powi(2);
                    jittered += (mean(&shows, cells) - truth).powi(2);
                }
                assert!(rings < jittered, "{depth}: {rings} {jittered}");
            }
        }
    }
}
