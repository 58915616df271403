//! What the parts of a picture will cost, from a look at the scene with few rays.

use crate::cost::PixelCost;
use crate::film::Region;
use crate::render::{Progress, RenderError, RenderOptions, render};
use crate::sampling::{Compared, Sampling};
use crate::scene::RenderScene;
use crate::tiles::TILE;
use strahl_shade::Color;

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

/// How the cost of a ray is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CostMeasure {
    /// By counting rays, steps and tests: the same on every machine and for every number of threads. Kinds of objects and textures that take
    /// unlike times for the same counts are not told apart.
    Counted,
    /// By the clock of [`Progress::now`]: nearer to the truth, and different each time.
    Timed,
}

/// Looks at the scene with one ray for every `spacing` x `spacing` pixels and says what the picture's blocks will cost.
///
/// # Errors
/// Those of [`render`].
pub fn estimate(
    scene: &RenderScene,
    options: &RenderOptions,
    spacing: u32,
    measure: CostMeasure,
    progress: &dyn Progress,
) -> Result<CostMap, RenderError> {
    let spacing = spacing.max(1);
    let small = RenderOptions {
        width: options.width.div_ceil(spacing),
        height: options.height.div_ceil(spacing),
        region: None,
        sampling: Sampling::Center,
        info: false,
        alpha: false,
        costs: true,
        ..options.clone()
    };
    let seen = render(scene, &small, progress)?;
    let rough = roughness(&seen.film.pixels, &small, options.sampling);
    let costs = seen.costs.unwrap_or_default();
    let ones: Vec<u64> = match measure {
        CostMeasure::Counted => costs.iter().map(counted).collect(),
        CostMeasure::Timed => timed(&costs),
    };
    let mut map = CostMap::even(options.width, options.height);
    let mut sums = vec![(0_u64, 0_u64); map.costs.len()];
    for (index, (one, rough)) in ones.into_iter().zip(rough).enumerate() {
        let width = small.width as usize;
        // The middle of the place that this ray stands for.
        let at = |i: usize, of: u32| (i as u32 * spacing + spacing / 2).min(of - 1) / TILE;
        let block =
            at(index / width, options.height) * map.columns() + at(index % width, options.width);
        let (sum, count) = &mut sums[block as usize];
        *sum += expected(one, rough, options.sampling, spacing);
        *count += 1;
    }
    let all: (u64, u64) = sums
        .iter()
        .fold((0, 0), |(s, c), (sum, count)| (s + sum, c + count));
    for (cost, (sum, count)) in map.costs.iter_mut().zip(sums) {
        // A block without a ray of its own, at the edge of a small picture, is an average one.
        let (sum, count) = if count == 0 { all } else { (sum, count) };
        *cost = (*cost * sum / count.max(1)).max(1);
    }
    Ok(map)
}

/// How many of its two neighbours to the right and below each place differs from.
fn roughness(pixels: &[[f32; 3]], small: &RenderOptions, sampling: Sampling) -> Vec<u64> {
    let (Sampling::Adaptive(refinement) | Sampling::Recursive(refinement)) = sampling else {
        return vec![0; pixels.len()];
    };
    let shown: Vec<Compared> = pixels
        .iter()
        .map(|[r, g, b]| {
            let color = Color::new((*r).into(), (*g).into(), (*b).into());
            Compared::new(color, &refinement)
        })
        .collect();
    let width = small.width as usize;
    let differs = |a: usize, b: usize| {
        let there = shown.get(b);
        u64::from(there.is_some_and(|there| shown[a].differs(*there, &refinement)))
    };
    (0..shown.len())
        .map(|i| {
            let right = match (i + 1).is_multiple_of(width) {
                true => 0,
                false => differs(i, i + 1),
            };
            right + differs(i, i + width)
        })
        .collect()
}

fn counted(cost: &PixelCost) -> u64 {
    RAY * cost.rays + STEP * cost.steps + TEST * cost.tests
}

/// The times of rays in nanoseconds. A ray during which the thread was interrupted is not believed: it took at most as much time for what it has
/// counted as the slowest but one in two hundred.
fn timed(costs: &[PixelCost]) -> Vec<u64> {
    // Thousandths of the time that the counts stand for.
    let ratio = |cost: &PixelCost| cost.nanoseconds * 1000 / counted(cost).max(1);
    let mut ratios: Vec<u64> = costs.iter().map(ratio).collect();
    ratios.sort_unstable();
    let most = ratios.get(ratios.len() * 199 / 200).copied().unwrap_or(0);
    let capped = |cost: &PixelCost| cost.nanoseconds.min(counted(cost) * most / 1000);
    costs.iter().map(capped).collect()
}

/// The cost of a pixel around a ray: what the ray took, and what antialiasing will add where neighbours differ.
fn expected(one: u64, rough: u64, sampling: Sampling, spacing: u32) -> u64 {
    let more = match sampling {
        Sampling::Adaptive(refinement) => u64::from(refinement.depth * refinement.depth) - 1,
        Sampling::Recursive(refinement) => {
            // Half of the places of the finest division, as for an edge.
            let side = (1_u64 << (refinement.depth - 1)) + 1;
            (side * side - 4) / 2
        }
        _ => 0,
    };
    // An edge between two rays crosses one row of `spacing` pixels at two of them.
    one + one * more * (2 * rough).min(u64::from(spacing)) / u64::from(spacing)
}

#[cfg(test)]
mod tests {
    use super::*;

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
        let times = timed(&costs);
        // As dear as its counts say, up to rounding.
        assert!(times[0] <= 2_000 && times[2] <= 2_000);
        assert!((19_000..=20_000).contains(&times[1]), "{}", times[1]);
    }

    #[test]
    fn edges_cost_what_antialiasing_adds_there() {
        let adaptive = Sampling::ADAPTIVE;
        assert_eq!(expected(100, 0, adaptive, 8), 100);
        // Two pixels of eight get eight rays more.
        assert_eq!(expected(100, 1, adaptive, 8), 100 + 800 * 2 / 8);
        assert_eq!(expected(100, 2, Sampling::Center, 8), 100);
        // No more than all pixels.
        assert_eq!(expected(100, 2, adaptive, 1), 900);
    }

    #[test]
    fn even_maps_count_pixels() {
        let map = CostMap::even(70, 33);
        assert_eq!((map.columns(), map.rows()), (3, 2));
        assert_eq!(map.costs, [1024, 1024, 192, 32, 32, 6]);
    }
}
