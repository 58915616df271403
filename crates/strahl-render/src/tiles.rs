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

/// Cuts a region into tiles.
pub(crate) fn tiles(region: Region, order: TileOrder) -> Vec<Region> {
    let mut all = Vec::new();
    for y in (0..region.height).step_by(TILE as usize) {
        for x in (0..region.width).step_by(TILE as usize) {
            all.push(Region {
                x: region.x + x,
                y: region.y + y,
                width: TILE.min(region.width - x),
                height: TILE.min(region.height - y),
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

#[cfg(test)]
mod tests {
    use super::*;

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
