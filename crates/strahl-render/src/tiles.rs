use crate::film::Region;

/// The order in which the tiles of a picture are rendered; the picture is the same with each.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TileOrder {
    /// From the top left, row by row.
    #[default]
    Rows,
    /// From the bottom right.
    Reverse,
    /// From the centre outwards.
    Center,
}

/// Edge length of a tile in pixels.
pub(crate) const TILE: u32 = 32;

/// Cuts a region into tiles along a lattice of the whole picture, so that a region whose edges are on the lattice has the
/// picture's own tiles: their pixels then take the same tests, which depend on the pixels before them in the tile.
pub(crate) fn tiles(region: Region, order: TileOrder) -> Vec<Region> {
    tiles_of(region, TILE, order)
}

/// The same with tiles of `edge` pixels.
pub(crate) fn tiles_of(region: Region, edge: u32, order: TileOrder) -> Vec<Region> {
    let mut all = Vec::new();
    for (y, height) in spans(region.y, region.height, edge) {
        for (x, width) in spans(region.x, region.width, edge) {
            all.push(Region {
                x,
                y,
                width,
                height,
            });
        }
    }
    match order {
        TileOrder::Rows => {}
        TileOrder::Reverse => all.reverse(),
        TileOrder::Center => {
            let center = |r: &Region| {
                (
                    2 * i64::from(r.x) + i64::from(r.width),
                    2 * i64::from(r.y) + i64::from(r.height),
                )
            };
            let (cx, cy) = center(&region);
            all.sort_by_key(|t| {
                let (x, y) = center(t);
                (x - cx) * (x - cx) + (y - cy) * (y - cy)
            });
        }
    }
    all
}

/// The tiles of a picture that have pixels of a region, as one region.
pub(crate) fn whole_tiles(region: Region, width: u32, height: u32) -> Region {
    let start = |at: u32| at / TILE * TILE;
    let end = |at: u32, size: u32| at.div_ceil(TILE).saturating_mul(TILE).min(size);
    let (x, y) = (start(region.x), start(region.y));
    Region {
        x,
        y,
        width: end(region.x + region.width, width) - x,
        height: end(region.y + region.height, height) - y,
    }
}

/// Cuts an interval at the multiples of `edge`: start and length of each part.
fn spans(start: u32, length: u32, edge: u32) -> impl Iterator<Item = (u32, u32)> {
    let mut from = start;
    let end = start.saturating_add(length);
    std::iter::from_fn(move || {
        let to = (from / edge + 1).saturating_mul(edge).min(end);
        (from < end).then(|| {
            let part = (from, to - from);
            from = to;
            part
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_of_a_picture_has_the_tiles_of_the_picture() {
        let rows = TileOrder::Rows;
        let whole = tiles(Region::full(100, 70), rows);
        let part = Region {
            x: 32,
            y: 32,
            width: 64,
            height: 38,
        };
        // Antialiasing looks at a pixel more on each side, which makes thin tiles around the others.
        let wide = tiles(part.grown(1, 100, 70), rows);
        for tile in tiles(part, rows) {
            assert!(whole.contains(&tile) && wide.contains(&tile), "{tile:?}");
        }
    }

    #[test]
    fn tiles_cover_every_pixel_once_in_every_order() {
        let region = Region {
            x: 5,
            y: 7,
            width: 70,
            height: 33,
        };
        for order in [TileOrder::Rows, TileOrder::Reverse, TileOrder::Center] {
            let mut seen = vec![0; 70 * 33];
            for t in tiles(region, order) {
                for y in t.y..t.y + t.height {
                    for x in t.x..t.x + t.width {
                        seen[((y - 7) * 70 + x - 5) as usize] += 1;
                    }
                }
            }
            assert!(seen.iter().all(|n| *n == 1), "{order:?}");
        }
    }
}
