//! What the parts of a picture will cost, from a survey of the scene with few rays.

use crate::cost::PixelCost;
use crate::film::Region;
use crate::render::{PixelProbe, Progress, RenderError, RenderOptions, Seen, probe_rows};
use crate::sampling::{Compared, Refinement, Sampling};
use crate::scene::RenderScene;
use crate::tiles::TILE;

/// The expected cost of each block of a picture: a number without unit, at least 1.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CostMap {
    /// Width of the picture in pixels.
    pub width: u32,
    /// Height of the picture in pixels.
    pub height: u32,
    /// One number for each block, row by row.
    pub costs: Vec<u64>,
}

impl CostMap {
    /// Edge length of a block in pixels; the blocks at the right and at the bottom may be smaller.
    pub const BLOCK: u32 = TILE;

    /// A picture whose pixels all cost the same.
    pub fn even(width: u32, height: u32) -> Self {
        let mut map = Self {
            width,
            height,
            costs: vec![],
        };
        let blocks = 0..map.columns() * map.rows();
        map.costs = blocks.map(|block| map.region(block).pixels()).collect();
        map
    }

    /// Blocks side by side.
    pub const fn columns(&self) -> u32 {
        self.width.div_ceil(Self::BLOCK)
    }

    /// Blocks one above the other.
    pub const fn rows(&self) -> u32 {
        self.height.div_ceil(Self::BLOCK)
    }

    /// The pixels of a block, by its index.
    fn region(&self, block: u32) -> Region {
        let columns = self.columns().max(1);
        let (x, y) = (block % columns * Self::BLOCK, block / columns * Self::BLOCK);
        Region {
            x,
            y,
            width: Self::BLOCK.min(self.width - x),
            height: Self::BLOCK.min(self.height - y),
        }
    }
}

/// Nanoseconds, roughly, of what is counted; only their ratios matter.
const RAY: u64 = 120;
const STEP: u64 = 10;
const TEST: u64 = 12;

/// Blocks around a block that tell with it how fine a texture is, in each direction.
const FINE: usize = 2;

/// How the cost of a ray is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CostMeasure {
    /// By counting rays, steps and tests: the same on every machine and for every number of threads. Kinds of objects and textures that take
    /// unlike times for the same counts are not told apart.
    Counted,
    /// By the clock of [`Progress::now`]: nearer to the truth, and different each time.
    Timed,
}

/// Looks at the scene with one ray for every `spacing` x `spacing` pixels and says what the picture's blocks will cost. Where two of these rays
/// beside each other differ so much that antialiasing will refine pixels between them, it finds these pixels by halving. Where they do not, one pixel
/// beside the ray tells how often fine textures differ from pixel to pixel.
///
/// # Errors
/// [`RenderError`]: no threads, or cancelled.
pub fn estimate(
    scene: &RenderScene,
    options: &RenderOptions,
    spacing: u32,
    measure: CostMeasure,
    progress: &dyn Progress,
) -> Result<CostMap, RenderError> {
    let survey = Survey {
        scene,
        options,
        progress,
        spacing: spacing.max(1),
    };
    let seen = survey.everywhere()?;
    let (edges, more) = match antialiasing(options.sampling) {
        Some((refinement, more)) if more > 0 => (survey.edges(&seen, refinement)?, more),
        _ => (Edges::default(), 0),
    };
    let measured: Vec<PixelCost> = seen.iter().flatten().map(|seen| seen.cost).collect();
    let scale = Scale::new(measure, &measured);

    let mut map = CostMap::even(options.width, options.height);
    let columns = map.columns();
    let block = |(x, y): (u32, u32)| (y / TILE * columns + x / TILE) as usize;
    let mut blocks = vec![Block::default(); map.costs.len()];
    for (place, cost) in survey.places().zip(&measured) {
        let block = &mut blocks[block(place)];
        block.rays += 1;
        block.sum += scale.of(cost);
    }
    for edge in edges.found {
        let further = more * scale.of(&edge.cost);
        match edge.along_row {
            true => blocks[block(edge.place)].along_rows += further,
            false => blocks[block(edge.place)].along_columns += further,
        }
    }
    for quiet in edges.quiet {
        let block = &mut blocks[block(quiet.place)];
        block.fine.pairs += 1;
        block.fine.differ += u64::from(quiet.differs);
    }
    let around = |index: usize| around(&blocks, columns as usize, index);
    let fine: Vec<u64> = (0..blocks.len())
        .map(|index| more * blocks[index].fine_cost(around(index)))
        .collect();
    for (block, fine) in blocks.iter_mut().zip(fine) {
        block.sum += fine;
    }
    let all: (u64, u64) = blocks.iter().fold((0, 0), |(sum, rays), block| {
        (sum + block.cost(survey.spacing), rays + block.rays)
    });
    for (cost, block) in map.costs.iter_mut().zip(&blocks) {
        // A block without a ray of its own, at the edge of a small picture, is an average one.
        let (sum, rays) = match block.rays {
            0 => all,
            rays => (block.cost(survey.spacing), rays),
        };
        *cost = (*cost * sum / rays.max(1)).max(1);
    }
    Ok(map)
}

/// What the rays in a block have cost.
#[derive(Clone, Copy, Debug, Default)]
struct Block {
    rays: u64,
    sum: u64,
    /// Of the further rays of the refined pixels on rows of rays.
    along_rows: u64,
    /// ... and on columns of rays.
    along_columns: u64,
    fine: Fine,
}

/// Pairs of neighbouring pixels where no edge is expected.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Fine {
    pairs: u64,
    /// Those that differ all the same.
    differ: u64,
}

impl Fine {
    /// The share of pixels that are refined.
    fn refined(self) -> f64 {
        // A pixel is refined if it differs from one of its four neighbours.
        let alike = 1.0 - self.differ as f64 / self.pairs.max(1) as f64;
        1.0 - alike * alike * alike * alike
    }
}

/// The pairs of a block and its neighbours: those of one are too few to tell how fine its texture is.
fn around(blocks: &[Block], columns: usize, index: usize) -> Fine {
    let (x, y) = (index % columns, index / columns);
    let mut all = Fine::default();
    for row in y.saturating_sub(FINE)..=y + FINE {
        for column in x.saturating_sub(FINE)..=(x + FINE).min(columns - 1) {
            let Some(block) = blocks.get(row * columns + column) else {
                continue;
            };
            all.pairs += block.fine.pairs;
            all.differ += block.fine.differ;
        }
    }
    all
}

impl Block {
    /// The cost of as many pixels as there are rays.
    fn cost(&self, spacing: u32) -> u64 {
        // A row of rays crosses an upright edge, a column crosses a level one, and both cross a slanting edge.
        let (a, b) = (self.along_rows, self.along_columns);
        let further = a.max(b) + a.min(b) / 4;
        // Only one of `spacing` rows and columns has rays.
        self.sum + further / u64::from(spacing)
    }

    /// The cost of one more ray for each of these pixels that is refined because of a fine texture, which pairs of pixels around have told.
    fn fine_cost(&self, around: Fine) -> u64 {
        let quiet = self.fine.pairs as f64 / self.rays.max(1) as f64;
        (around.refined() * quiet * self.sum as f64) as u64
    }
}

/// A pixel that antialiasing will refine.
struct Edge {
    place: (u32, u32),
    /// Whether it was found between rays beside each other, rather than one above the other.
    along_row: bool,
    /// What one of its rays costs.
    cost: PixelCost,
}

/// A pixel where no edge is expected.
struct Quiet {
    place: (u32, u32),
    /// Whether it differs from the pixel beside it all the same.
    differs: bool,
}

/// What a search for edges has found.
#[derive(Default)]
struct Edges {
    found: Vec<Edge>,
    quiet: Vec<Quiet>,
}

/// When pixels are refined, and how many rays they get.
fn antialiasing(sampling: Sampling) -> Option<(Refinement, u64)> {
    match sampling {
        Sampling::Adaptive(refinement) => {
            let more = sampling.places(1, 0, 0, 0).len();
            Some((refinement, more as u64))
        }
        Sampling::Recursive(refinement) => {
            // Half of the places of the finest division, as for an edge.
            let side = (1_u64 << (refinement.depth - 1)) + 1;
            Some((refinement, (side * side - 4) / 2))
        }
        _ => None,
    }
}

/// A survey of a scene with few rays.
struct Survey<'a> {
    scene: &'a RenderScene,
    options: &'a RenderOptions,
    progress: &'a dyn Progress,
    spacing: u32,
}

impl Survey<'_> {
    fn columns(&self) -> u32 {
        self.options.width.div_ceil(self.spacing)
    }

    fn rows(&self) -> u32 {
        self.options.height.div_ceil(self.spacing)
    }

    /// The pixel of a column or row of rays: the middle of the pixels that the ray stands for.
    fn pixel(&self, number: u32, of: u32) -> u32 {
        (number * self.spacing + self.spacing / 2).min(of - 1)
    }

    fn x(&self, column: u32) -> u32 {
        self.pixel(column, self.options.width)
    }

    fn y(&self, row: u32) -> u32 {
        self.pixel(row, self.options.height)
    }

    /// The pixels of all rays, row by row.
    fn places(&self) -> impl Iterator<Item = (u32, u32)> {
        let all = (0..self.rows()).flat_map(|row| (0..self.columns()).map(move |c| (c, row)));
        all.map(|(column, row)| (self.x(column), self.y(row)))
    }

    /// What all rays see, in rows.
    fn everywhere(&self) -> Result<Vec<Vec<Seen>>, RenderError> {
        let row = |probe: &mut PixelProbe<'_>, row: u32| {
            let columns = 0..self.columns();
            columns.map(|c| probe(self.x(c), self.y(row))).collect()
        };
        probe_rows(self.scene, self.options, self.progress, self.rows(), row)
    }

    /// The pixels that are refined on the lines between rays beside and above each other.
    fn edges(&self, seen: &[Vec<Seen>], refinement: Refinement) -> Result<Edges, RenderError> {
        let row = |probe: &mut PixelProbe<'_>, row: u32| {
            let (mut edges, y) = (Edges::default(), self.y(row));
            let own = &seen[row as usize];
            for (column, pair) in (0..).zip(own.windows(2)) {
                let ends = [(self.x(column), pair[0]), (self.x(column + 1), pair[1])];
                let found = refined(ends, &refinement, &mut |x| probe(x, y));
                if found.is_empty() && ends[0].0 + 1 < ends[1].0 {
                    let beside = probe(ends[0].0 + 1, y);
                    edges.quiet.push(Quiet {
                        place: (ends[0].0, y),
                        differs: differ(&pair[0], &beside, &refinement),
                    });
                }
                edges.found.extend(found.into_iter().map(|(x, cost)| Edge {
                    place: (x, y),
                    along_row: true,
                    cost,
                }));
            }
            let below = seen.get(row as usize + 1).into_iter().flatten();
            for (column, (a, b)) in (0..).zip(own.iter().zip(below)) {
                let x = self.x(column);
                let ends = [(y, *a), (self.y(row + 1), *b)];
                let found = refined(ends, &refinement, &mut |y| probe(x, y));
                edges.found.extend(found.into_iter().map(|(y, cost)| Edge {
                    place: (x, y),
                    along_row: false,
                    cost,
                }));
            }
            edges
        };
        let rows = probe_rows(self.scene, self.options, self.progress, self.rows(), row)?;
        let mut all = Edges::default();
        for row in rows {
            all.found.extend(row.found);
            all.quiet.extend(row.quiet);
        }
        Ok(all)
    }
}

/// Whether two pixels differ so much that they are refined, if they are neighbours.
fn differ(a: &Seen, b: &Seen, refinement: &Refinement) -> bool {
    let shown = |seen: &Seen| Compared::new(seen.color, refinement);
    shown(a).differs(shown(b), refinement)
}

/// The pixels on a line that differ from a neighbour, found by halving the line where its ends differ, with the costs of their rays.
fn refined(
    ends: [(u32, Seen); 2],
    refinement: &Refinement,
    probe: &mut dyn FnMut(u32) -> Seen,
) -> Vec<(u32, PixelCost)> {
    let mut found: Vec<(u32, PixelCost)> = vec![];
    let mut left = vec![ends];
    while let Some([a, b]) = left.pop() {
        if a.0 >= b.0 || !differ(&a.1, &b.1, refinement) {
            continue;
        }
        if a.0 + 1 == b.0 {
            for (position, seen) in [a, b] {
                if found.last().is_none_or(|(last, _)| *last < position) {
                    found.push((position, seen.cost));
                }
            }
            continue;
        }
        let middle = a.0.midpoint(b.0);
        let middle = (middle, probe(middle));
        left.extend([[middle, b], [a, middle]]);
    }
    found
}

fn counted(cost: &PixelCost) -> u64 {
    RAY * cost.rays + STEP * cost.steps + TEST * cost.tests
}

/// How costs become numbers.
enum Scale {
    Counted,
    /// The longest time that is believed, in thousandths of what the counts stand for.
    Timed(u64),
}

impl Scale {
    /// A ray during which the thread was interrupted is not believed: it took at most as much time for what it has counted as the slowest but
    /// one in two hundred.
    fn new(measure: CostMeasure, costs: &[PixelCost]) -> Self {
        if measure == CostMeasure::Counted {
            return Self::Counted;
        }
        let ratio = |cost: &PixelCost| cost.nanoseconds * 1000 / counted(cost).max(1);
        let mut ratios: Vec<u64> = costs.iter().map(ratio).collect();
        ratios.sort_unstable();
        let most = ratios.get(ratios.len() * 199 / 200).copied();
        Self::Timed(most.unwrap_or(0))
    }

    fn of(&self, cost: &PixelCost) -> u64 {
        match self {
            Self::Counted => counted(cost),
            Self::Timed(most) => cost.nanoseconds.min(counted(cost) * most / 1000),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use strahl_shade::Color;

    #[test]
    fn an_interruption_makes_no_ray_dear() {
        let ray = |nanoseconds| PixelCost {
            rays: 10,
            nanoseconds,
            ..PixelCost::default()
        };
        let mut costs = vec![ray(2_000); 300];
        costs[0] = ray(4_000_000);
        costs[1] = PixelCost {
            rays: 100,
            ..ray(20_000)
        };
        let scale = Scale::new(CostMeasure::Timed, &costs);
        let times: Vec<u64> = costs.iter().map(|cost| scale.of(cost)).collect();
        // As dear as its counts say, up to rounding.
        assert!(times[0] <= 2_000 && times[2] <= 2_000);
        assert!((19_000..=20_000).contains(&times[1]), "{}", times[1]);
    }

    /// The refined pixels of a line with these grey values, and how many of its pixels were looked at.
    fn refined_of(greys: &[f64]) -> (Vec<u32>, usize) {
        let seen = |x: u32| Seen {
            color: Color::gray(greys[x as usize]),
            cost: PixelCost::default(),
        };
        let last = greys.len() as u32 - 1;
        let mut looks = 0;
        let found = refined(
            [(0, seen(0)), (last, seen(last))],
            &Refinement::DEFAULT,
            &mut |x| {
                looks += 1;
                seen(x)
            },
        );
        (found.into_iter().map(|(x, _)| x).collect(), looks)
    }

    #[test]
    fn edges_are_found_by_halving() {
        let edge = [0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0];
        assert_eq!(refined_of(&edge), (vec![4, 5], 3));
        // An edge is found between ends that differ, not all of them.
        let stripes = [0.0, 1.0, 0.0, 1.0, 0.0, 1.0];
        assert_eq!(refined_of(&stripes), (vec![2, 3], 2));
        // A slope is nowhere steep enough.
        let slope: Vec<f64> = (0..9).map(|x| 0.1 + 0.02 * f64::from(x)).collect();
        assert_eq!(refined_of(&slope).0, Vec::<u32>::new());
        assert_eq!(refined_of(&[0.5; 9]), (vec![], 0));
    }

    #[test]
    fn fine_textures_are_told_by_pairs_of_pixels() {
        let speckled = Fine {
            pairs: 100,
            differ: 10,
        };
        // A tenth of the pairs: 1 - 0.9^4 of the pixels.
        assert!((speckled.refined() - 0.3439).abs() < 1e-9);
        assert_eq!(Fine::default().refined(), 0.0);
        let block = Block {
            rays: 16,
            sum: 1600,
            fine: Fine {
                pairs: 8,
                differ: 0,
            },
            ..Block::default()
        };
        // Half of the rays saw no edge beside them.
        assert_eq!(block.fine_cost(speckled), 275);
        let mut blocks = vec![Block::default(); 40];
        blocks[17].fine = speckled;
        let near = |index| around(&blocks, 8, index).differ;
        assert_eq!((near(17), near(35), near(16), near(20)), (10, 10, 10, 0));
        assert_eq!(near(39), 0);
    }

    #[test]
    fn refined_pixels_stand_for_the_rows_between() {
        let block = Block {
            rays: 16,
            sum: 1600,
            along_rows: 80,
            ..Block::default()
        };
        assert_eq!(block.cost(8), 1610);
        let slanting = Block {
            along_columns: 80,
            ..block
        };
        assert_eq!(slanting.cost(8), 1612);
    }

    #[test]
    fn even_maps_count_pixels() {
        let map = CostMap::even(70, 33);
        assert_eq!((map.columns(), map.rows()), (3, 2));
        assert_eq!(map.costs, [1024, 1024, 192, 32, 32, 6]);
    }
}
