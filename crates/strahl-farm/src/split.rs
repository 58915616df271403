//! Cuts a picture into tiles of about equal cost.

use strahl::tracing::{CostMap, Region};

/// A picture has fewer blocks than tiles are wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "a picture of {width}x{height} pixels can't be cut into {count} tiles: the edges of tiles are on multiples of {} pixels, \
     which makes {most} at most",
    CostMap::BLOCK
)]
pub struct TooManyTiles {
    width: u32,
    height: u32,
    count: u32,
    most: u32,
}

/// Up to so many tiles of a rectangle several cuts are tried to the end; for more the best one is taken, as the tiles behind it can still be
/// made equal.
const FEW: u32 = 16;

/// The number of cuts that are tried for a rectangle of few tiles.
const TRIED: usize = 4;

/// Cuts a picture into `count` tiles of about equal cost, by halving it again and again so that the dearest tile is as cheap as possible. The
/// edges of tiles are on multiples of [`CostMap::BLOCK`] pixels, so that a tile's pixels take the same tests as those of the picture.
///
/// # Errors
/// [`TooManyTiles`]: fewer blocks than tiles, or no tile.
pub fn split(map: &CostMap, count: u32) -> Result<Vec<Region>, TooManyTiles> {
    let most = map.columns().saturating_mul(map.rows());
    if count == 0 || count > most || map.costs.len() != most as usize {
        return Err(TooManyTiles {
            width: map.width,
            height: map.height,
            count,
            most,
        });
    }
    let sums = Sums::of(map);
    let mut tiles = vec![];
    let whole = Blocks {
        left: 0,
        top: 0,
        right: map.columns(),
        bottom: map.rows(),
    };
    // Explicit, so that no number of tiles overflows the stack; the first half is cut first.
    let mut left = vec![(whole, count)];
    while let Some((blocks, count)) = left.pop() {
        if count <= FEW {
            tiles.extend(sums.division(blocks, count).tiles);
            continue;
        }
        match sums.cuts(blocks, count, 1).first() {
            None => tiles.push(blocks),
            Some(cut) => {
                let [first, second] = blocks.cut(*cut);
                left.push((second, count - cut.first));
                left.push((first, cut.first));
            }
        }
    }
    Ok(tiles.iter().map(|blocks| blocks.region(map)).collect())
}

/// The tiles of a rectangle, and the cost of the dearest one.
struct Division {
    tiles: Vec<Blocks>,
    dearest: u128,
}

/// A rectangle of blocks, with the right and bottom ends excluded.
#[derive(Clone, Copy, Debug)]
struct Blocks {
    left: u32,
    top: u32,
    right: u32,
    bottom: u32,
}

/// A cut through a rectangle of blocks.
#[derive(Clone, Copy, Debug)]
struct Cut {
    /// Whether it is a vertical line.
    vertical: bool,
    /// The first column or row behind it.
    at: u32,
    /// The number of tiles of the first part.
    first: u32,
}

impl Blocks {
    fn columns(&self) -> u32 {
        self.right - self.left
    }

    fn rows(&self) -> u32 {
        self.bottom - self.top
    }

    fn number(&self) -> u32 {
        self.columns() * self.rows()
    }

    fn cut(self, cut: Cut) -> [Self; 2] {
        let (mut first, mut second) = (self, self);
        if cut.vertical {
            (first.right, second.left) = (cut.at, cut.at);
        } else {
            (first.bottom, second.top) = (cut.at, cut.at);
        }
        [first, second]
    }

    fn region(&self, map: &CostMap) -> Region {
        let (x, y) = (self.left * CostMap::BLOCK, self.top * CostMap::BLOCK);
        Region {
            x,
            y,
            width: (self.right * CostMap::BLOCK).min(map.width) - x,
            height: (self.bottom * CostMap::BLOCK).min(map.height) - y,
        }
    }
}

/// The costs of all rectangles from the top left corner.
struct Sums {
    columns: u32,
    sums: Vec<u128>,
}

impl Sums {
    fn of(map: &CostMap) -> Self {
        let (columns, rows) = (map.columns(), map.rows());
        let width = columns as usize + 1;
        let mut sums = vec![0; width * (rows as usize + 1)];
        for (row, costs) in map.costs.chunks_exact(columns.max(1) as usize).enumerate() {
            let mut line = 0;
            for (column, cost) in costs.iter().enumerate() {
                line += u128::from(*cost);
                sums[(row + 1) * width + column + 1] = sums[row * width + column + 1] + line;
            }
        }
        Self { columns, sums }
    }

    fn cost(&self, blocks: &Blocks) -> u128 {
        let width = self.columns as usize + 1;
        let at = |x: u32, y: u32| self.sums[y as usize * width + x as usize];
        let Blocks {
            left,
            top,
            right,
            bottom,
        } = *blocks;
        at(right, bottom) + at(left, top) - at(left, bottom) - at(right, top)
    }

    /// The cost of a tile, in thousandths: antialiasing takes a row of pixels of the neighbours along its edges.
    fn cost_of_tile(&self, tile: &Blocks) -> u128 {
        let edge = 2 * (tile.columns() + tile.rows());
        let pixels = u128::from(tile.number()) * u128::from(CostMap::BLOCK);
        self.cost(tile) * 1000 * (pixels + u128::from(edge)) / pixels
    }

    /// The best division of a rectangle into few tiles that was found.
    fn division(&self, blocks: Blocks, count: u32) -> Division {
        let mut best: Option<Division> = None;
        for cut in self.cuts(blocks, count, TRIED) {
            let [first, second] = blocks.cut(cut);
            let mut found = self.division(first, cut.first);
            if best.as_ref().is_some_and(|b| found.dearest >= b.dearest) {
                continue;
            }
            let second = self.division(second, count - cut.first);
            found.dearest = found.dearest.max(second.dearest);
            found.tiles.extend(second.tiles);
            if best.as_ref().is_none_or(|b| found.dearest < b.dearest) {
                best = Some(found);
            }
        }
        best.unwrap_or_else(|| Division {
            tiles: vec![blocks],
            dearest: self.cost_of_tile(&blocks),
        })
    }

    /// The cuts after which the dearest tile will probably be cheapest, the best one first; none for one tile.
    fn cuts(&self, blocks: Blocks, count: u32, most: usize) -> Vec<Cut> {
        let mut all: Vec<(u128, Cut)> = vec![];
        for vertical in [
            blocks.columns() >= blocks.rows(),
            blocks.columns() < blocks.rows(),
        ] {
            let range = match vertical {
                true => blocks.left + 1..blocks.right,
                false => blocks.top + 1..blocks.bottom,
            };
            for at in range {
                let cut = Cut {
                    vertical,
                    at,
                    first: 0,
                };
                all.extend(self.score(blocks, cut, count));
            }
        }
        // Stable: of equal cuts the first one.
        all.sort_by_key(|(score, _)| *score);
        all.into_iter().take(most).map(|(_, cut)| cut).collect()
    }

    /// The cut with the best number of tiles of the first part, and how dear the tiles get; `None` where the parts can't have so many tiles.
    fn score(&self, blocks: Blocks, cut: Cut, count: u32) -> Option<(u128, Cut)> {
        let [a, b] = blocks.cut(cut);
        let (cost_a, cost_b) = (self.cost(&a), self.cost(&b));
        let wanted = (u128::from(count) * cost_a * 2 / (cost_a + cost_b).max(1)).div_ceil(2) as u32;
        // Halves of very unlike sizes leave long, thin tiles.
        let third = (count / 3).max(1);
        let low = third.max(count.saturating_sub(b.number()));
        let high = (count.checked_sub(third)?).min(a.number());
        if low > high {
            return None;
        }
        let first = wanted.clamp(low, high);
        let each = |cost: u128, tiles: u32| cost * 1000 / u128::from(tiles);
        let dearest = each(cost_a, first).max(each(cost_b, count - first));
        // Antialiasing takes a row of pixels of the neighbour along the cut.
        let length = if cut.vertical {
            blocks.rows()
        } else {
            blocks.columns()
        };
        let margin = (cost_a + cost_b) * 1000 * u128::from(length)
            / u128::from(blocks.number())
            / u128::from(CostMap::BLOCK);
        Some((dearest + margin, Cut { first, ..cut }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn map(width: u32, height: u32, cost: impl Fn(u32, u32) -> u64) -> CostMap {
        let mut map = CostMap::even(width, height);
        let columns = map.columns();
        for (i, place) in (0..).zip(&mut map.costs) {
            *place = cost(i % columns, i / columns);
        }
        map
    }

    fn cost(map: &CostMap, region: &Region) -> u64 {
        let (b, mut sum) = (CostMap::BLOCK, 0);
        for y in region.y / b..(region.y + region.height).div_ceil(b) {
            for x in region.x / b..(region.x + region.width).div_ceil(b) {
                sum += map.costs[(y * map.columns() + x) as usize];
            }
        }
        sum
    }

    #[test]
    fn tiles_cover_the_picture_once() {
        for (width, height) in [(1, 1), (33, 31), (640, 480), (1920, 1080), (50, 3000)] {
            let map = map(width, height, |x, y| 1 + u64::from(x * y % 7));
            let most = map.columns() * map.rows();
            for count in [1, 2, 3, 7, 40, most] {
                let Ok(tiles) = split(&map, count) else {
                    assert!(count > most);
                    continue;
                };
                assert_eq!(tiles.len() as u32, count);
                let pixels: u64 = tiles.iter().map(Region::pixels).sum();
                assert_eq!(pixels, u64::from(width) * u64::from(height));
                assert!(Region::uncovered(width, height, &tiles).is_empty());
                for tile in tiles {
                    assert!(tile.x % CostMap::BLOCK == 0 && tile.y % CostMap::BLOCK == 0);
                }
            }
        }
    }

    #[test]
    fn dear_places_get_small_tiles() {
        // A hundred times dearer in a tenth of the picture.
        let map = map(1920, 1080, |x, y| match (20..32).contains(&x) && y > 17 {
            true => 100,
            false => 1,
        });
        for count in [4, 10, 40] {
            let tiles = split(&map, count).unwrap();
            let costs: Vec<u64> = tiles.iter().map(|t| cost(&map, t)).collect();
            let mean = costs.iter().sum::<u64>() as f64 / f64::from(count);
            let most = costs.iter().copied().max().unwrap() as f64;
            assert!(most / mean < 1.3, "{count}: {costs:?}");
        }
    }

    #[test]
    fn impossible_numbers_are_told() {
        let map = CostMap::even(64, 64);
        assert!(split(&map, 0).is_err());
        let error = split(&map, 5).unwrap_err().to_string();
        assert!(
            error.contains("64x64") && error.contains("4 at most"),
            "{error}"
        );
    }
}
