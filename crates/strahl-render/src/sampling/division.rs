//! Pixels that are divided where their corners differ (T. Whitted, "An Improved Illumination Model for Shaded Display", 1980, section 5).

use super::Sample;
use super::refinement::{Compared, Refinement, Slopes};
use hashbrown::hash_map::Entry;
use hashbrown::{HashMap, HashSet};
use strahl_scene::WorkingSpace;
use strahl_shade::Color;

/// Divides pixels of a part of the picture, all of them level by level, so that neighbours share the samples of their common borders and many rays
/// can be traced together.
pub(crate) struct Division<'a> {
    refinement: &'a Refinement,
    slopes: Slopes,
    space: WorkingSpace,
    /// Side of a pixel in smallest squares.
    size: u32,
    /// The pixels, then the quarters of those that are divided, and so on.
    squares: Vec<Square>,
    /// The number of a sample by its place, in smallest squares from the top left corner of the part.
    numbers: HashMap<(u32, u32), u32>,
    samples: Vec<Sample>,
}

/// A pixel or a part of one.
struct Square {
    /// The place of its top left corner.
    at: (u32, u32),
    /// Its side, in smallest squares.
    size: u32,
    /// The number of its first quarter, if it is divided; 0 if not.
    quarters: usize,
    /// Top left, top right, bottom left, bottom right.
    corners: [Sample; 4],
}

impl<'a> Division<'a> {
    /// The number of pixels to divide at once, so that they have at most some ten thousand squares, or are one.
    pub(crate) fn pixels_at_once(refinement: &Refinement) -> usize {
        let levels = refinement.depth.saturating_sub(1);
        (1 << 16 >> (2 * levels)).max(1)
    }

    /// Without pixels.
    pub(crate) fn new(refinement: &'a Refinement, space: WorkingSpace) -> Self {
        Self {
            refinement,
            slopes: Slopes::new(refinement),
            space,
            size: 1 << refinement.depth.saturating_sub(1),
            squares: Vec::new(),
            numbers: HashMap::new(),
            samples: Vec::new(),
        }
    }

    /// Adds a pixel, given its place in pixels from the top left corner of the part, and the samples at its corners: top left, top right,
    /// bottom left, bottom right.
    pub(crate) fn add(&mut self, (x, y): (u32, u32), corners: [Sample; 4]) {
        self.squares.push(Square {
            at: (x * self.size, y * self.size),
            size: self.size,
            quarters: 0,
            corners,
        });
    }

    /// Divides the pixels and returns the mean of each, in the order in which they were added: that of its corners if they are alike in linear light,
    /// or else that of its four quarters. `take` returns the samples at places, which it is given in pixels from the top left corner of the part; `None` if
    /// it wants to leave off.
    pub(crate) fn means(
        mut self,
        mut take: impl FnMut(&[(f64, f64)]) -> Option<Vec<Sample>>,
    ) -> Option<Vec<Sample>> {
        let (pixels, cell) = (self.squares.len(), 1.0 / f64::from(self.size));
        let mut level = 0..pixels;
        while !level.is_empty() {
            let squares = level.clone();
            let divided: Vec<usize> = squares.filter(|&n| self.is_divided(n)).collect();
            let mut wanted = Vec::new();
            for &square in &divided {
                for (i, j) in self.squares[square].between() {
                    let number = (self.samples.len() + wanted.len()) as u32;
                    if let Entry::Vacant(entry) = self.numbers.entry((i, j)) {
                        entry.insert(number);
                        wanted.push((f64::from(i) * cell, f64::from(j) * cell));
                    }
                }
            }
            if !wanted.is_empty() {
                self.samples.extend(take(&wanted)?);
            }
            level = self.squares.len()..self.squares.len() + 4 * divided.len();
            for square in divided {
                self.divide(square);
            }
        }
        Some(self.summed(pixels))
    }

    /// Whether a square is divided.
    fn is_divided(&self, square: usize) -> bool {
        let Square { size, corners, .. } = &self.squares[square];
        let mut colors = corners.map(|sample| sample.color);
        if *size == 1 || colors[1..].iter().all(|color| *color == colors[0]) {
            return false;
        }
        self.space.decode_all(&mut colors);
        let channels = colors.map(Color::to_array);
        let of_all = |choose: fn(f64, f64) -> f64| {
            let [a, b, c, d] = channels;
            let chosen = |i: usize| choose(choose(a[i], b[i]), choose(c[i], d[i]));
            Color::from([0, 1, 2].map(chosen))
        };
        if self.slopes.surely_alike(of_all(f64::min), of_all(f64::max)) {
            return false;
        }
        let shown = Compared::batch(&colors, self.refinement);
        let pairs = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)];
        let mut pairs = pairs.into_iter();
        pairs.any(|(a, b)| shown[a].differs(shown[b], self.refinement))
    }

    /// Adds the quarters of a square.
    fn divide(&mut self, square: usize) {
        let quarters = self.squares.len();
        let Square {
            at: (i, j),
            size,
            corners: [a, b, c, d],
            ..
        } = self.squares[square];
        let between = self.squares[square].between();
        let [top, left, middle, right, bottom] =
            between.map(|place| self.samples[self.numbers[&place] as usize]);
        let half = size / 2;
        let parts = [
            ((i, j), [a, top, left, middle]),
            ((i + half, j), [top, b, middle, right]),
            ((i, j + half), [left, middle, c, bottom]),
            ((i + half, j + half), [middle, right, bottom, d]),
        ];
        self.squares.extend(parts.map(|(at, corners)| Square {
            at,
            size: half,
            quarters: 0,
            corners,
        }));
        self.squares[square].quarters = quarters;
    }

    /// The means of the first squares.
    fn summed(self, first: usize) -> Vec<Sample> {
        let mut means = vec![Sample::BLACK; self.squares.len()];
        // Quarters come behind their squares.
        for (number, square) in self.squares.iter().enumerate().rev() {
            let [a, b, c, d] = match square.quarters {
                0 => square.corners,
                first => [0, 1, 2, 3].map(|n| means[first + n]),
            };
            means[number] = (a + b + c + d) / 4.0;
        }
        means.truncate(first);
        means
    }
}

/// The share of each place in the mean of a pixel that was divided, by the place; both are given from the pixel's top left corner. `inner` are the places
/// that were looked at besides the corners.
///
/// A place in the middle of a square lies on the border of no larger and of no equal one, so it was looked at only if this square is divided.
pub(crate) fn shares(
    inner: &[(f64, f64)],
    refinement: &Refinement,
) -> impl Fn(f64, f64) -> f64 + use<> {
    let size = 1 << refinement.depth.saturating_sub(1);
    let number = move |x: f64, y: f64| [x, y].map(|v| (v * f64::from(size)) as u32);
    let inner: HashSet<[u32; 2]> = inner.iter().map(|&(x, y)| number(x, y)).collect();
    let mut shares = HashMap::new();
    let mut waiting = vec![([0, 0], size, 1.0)];
    while let Some(([i, j], side, area)) = waiting.pop() {
        let half = side / 2;
        let corners = |side| [[i, j], [i + side, j], [i, j + side], [i + side, j + side]];
        if half > 0 && inner.contains(&[i + half, j + half]) {
            waiting.extend(corners(half).map(|at| (at, half, area / 4.0)));
            continue;
        }
        for corner in corners(side) {
            *shares.entry(corner).or_insert(0.0) += area / 4.0;
        }
    }
    move |x, y| shares.get(&number(x, y)).copied().unwrap_or(0.0)
}

impl Square {
    /// The corners of its quarters that are not its own: top, left, middle, right, bottom.
    fn between(&self) -> [(u32, u32); 5] {
        let ((i, j), size, half) = (self.at, self.size, self.size / 2);
        [
            (i + half, j),
            (i, j + half),
            (i + half, j + half),
            (i + size, j + half),
            (i + half, j + size),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn step_at(edge: f64) -> impl Fn(f64, f64) -> Sample {
        move |x, _| Sample::from(if x < edge { Color::WHITE } else { Color::BLACK })
    }

    /// The mean of pixels in a row that see a function, and the number of samples.
    fn divided(
        depth: u32,
        pixels: u32,
        sample: impl Fn(f64, f64) -> Sample,
    ) -> (Vec<Sample>, usize) {
        let refinement = Refinement {
            depth,
            ..Refinement::DEFAULT
        };
        let mut division = Division::new(&refinement, WorkingSpace::Linear);
        for x in 0..pixels {
            let corners = [(0, 0), (1, 0), (0, 1), (1, 1)];
            let at = |(i, j)| sample(f64::from(x + i), f64::from(j));
            division.add((x, 0), corners.map(at));
        }
        let mut count = 0;
        let means = division.means(|places| {
            count += places.len();
            let right = f64::from(pixels);
            let inside =
                |&(x, y): &(f64, f64)| (0.0..=right).contains(&x) && (0.0..=1.0).contains(&y);
            assert!(places.iter().all(inside));
            Some(places.iter().map(|&(x, y)| sample(x, y)).collect())
        });
        (means.expect("it does not leave off"), count)
    }

    /// POV-Ray's second method takes five rays more in a pixel with an edge for `+R2`, fourteen for `+R3`.
    #[test]
    fn squares_are_divided_where_their_corners_differ() {
        for (depth, rays, share) in [(1, 0, 0.5), (2, 5, 0.75), (3, 14, 0.625)] {
            let white = Sample::from(Color::gray(share));
            assert_eq!(divided(depth, 1, step_at(0.7)), (vec![white], rays));
        }
    }

    #[test]
    fn neighbours_share_the_samples_of_their_border() {
        // Each row of corners is black and white, so both pixels are divided everywhere.
        let rows = |_: f64, y: f64| Sample::from(Color::gray(f64::from(y < 0.5)));
        let (means, rays) = divided(2, 2, rows);
        assert_eq!(rays, 5 + 4);
        assert_eq!(means[0], means[1]);
        assert_eq!(means[0], divided(2, 1, rows).0[0]);
    }

    #[test]
    fn alike_corners_need_no_rays() {
        let gray = Sample::from(Color::gray(0.25));
        assert_eq!(divided(3, 3, |_, _| gray), (vec![gray; 3], 0));
    }

    #[test]
    fn shares_are_the_quarters_of_undivided_squares() {
        for edge in [0.7, 0.1, 0.5, 2.0] {
            let refinement = Refinement {
                depth: 4,
                ..Refinement::DEFAULT
            };
            let mut division = Division::new(&refinement, WorkingSpace::Linear);
            let corners = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)];
            // What is seen depends on both coordinates.
            let seen = |&(x, y): &(f64, f64)| {
                let bright = if x < edge { 1.0 + x } else { 0.0 };
                Color::new(bright, bright * y, f64::from(x + y < 0.9))
            };
            let mut inner = vec![];
            division.add((0, 0), corners.map(|at| Sample::from(seen(&at))));
            let means = division.means(|places| {
                inner.extend_from_slice(places);
                Some(places.iter().map(|at| Sample::from(seen(at))).collect())
            });
            let share = shares(&inner, &refinement);
            let (mut sum, mut all) = (Color::BLACK, 0.0);
            for at in corners.iter().chain(&inner) {
                sum += seen(at) * share(at.0, at.1);
                all += share(at.0, at.1);
            }
            assert_eq!(all, 1.0);
            let off = (sum - means.expect("it does not leave off")[0].color).map(f64::abs);
            assert!(off.max_component() < 1e-15, "{edge}: {sum:?}");
        }
    }

    #[test]
    fn nothing_is_returned_by_a_division_that_is_left() {
        let refinement = Refinement::DEFAULT;
        let mut division = Division::new(&refinement, WorkingSpace::Linear);
        let (dark, bright) = (Sample::BLACK, Sample::from(Color::WHITE));
        division.add((0, 0), [dark, bright, dark, bright]);
        assert_eq!(division.means(|_| None), None);
    }
}
