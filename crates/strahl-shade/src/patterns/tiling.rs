//! The pattern `tiling`: tilings of the x-z plane by regular polygons and other tiles, with bevelled edges.

mod tables;

use strahl_math::DVec3;

/// One of POV-Ray's periodic tilings, 1 to 24.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TilingNumber(u8);

/// A tiling: a lattice of equal cells, and the tiles of one cell.
struct Tiling {
    /// The number of kinds of tiles, N. Kind k has the values from k / N in its middle to (k + 1) / N at its edges.
    kinds: f64,
    /// The two vectors of the lattice, x and z.
    lattice: [[f64; 2]; 2],
    /// The tiles of one cell.
    tiles: &'static [Tile],
}

/// A convex tile.
struct Tile {
    /// Its kind, from 0.
    kind: f64,
    /// Its centre, x and z.
    center: [f64; 2],
    /// A circle of this radius around the centre contains the tile.
    radius: f64,
    /// Its edges: the direction of the outward normal in steps of 15 degrees from x to z, the distance from the centre, and how
    /// steeply the bevel falls from the edge inwards. (One tile of tiling 22 has edges of two slopes.)
    edges: &'static [(u8, f64, f64)],
}

/// The cosines of 0, 15, ... 90 degrees.
const COSINES: [f64; 7] = [
    1.0,
    0.965_925_826_289_068_3,
    0.866_025_403_784_438_6,
    std::f64::consts::FRAC_1_SQRT_2,
    0.5,
    0.258_819_045_102_520_74,
    0.0,
];

/// The cosine of `steps` times 15 degrees.
fn cosine(steps: u8) -> f64 {
    match steps % 24 {
        s @ 0..=6 => COSINES[usize::from(s)],
        s @ 7..=12 => -COSINES[usize::from(12 - s)],
        s @ 13..=18 => -COSINES[usize::from(s - 12)],
        s => COSINES[usize::from(24 - s)],
    }
}

impl Tile {
    /// How high the point at `offset` from the centre lies above the edges: 0 on an edge, 1 or more where the bevel ends, less
    /// than 0 outside.
    fn height(&self, [x, z]: [f64; 2]) -> f64 {
        let height = |&(direction, distance, slope): &(u8, f64, f64)| {
            let along = cosine(direction) * x + cosine(direction + 18) * z;
            (distance - along) * slope
        };
        self.edges.iter().map(height).fold(f64::INFINITY, f64::min)
    }
}

impl TilingNumber {
    /// The tiling of this number, from 1 to 24; 25 to 27, which have no period, are not supported.
    pub fn try_new(number: u32) -> Option<Self> {
        let number = u8::try_from(number).ok()?;
        (1..=24).contains(&number).then_some(Self(number))
    }

    /// The value at a point, `0..=1`.
    pub(super) fn value(self, p: DVec3) -> f64 {
        let tiling = &tables::TILINGS[usize::from(self.0 - 1)];
        let [a, b] = tiling.lattice;
        let area = a[0] * b[1] - a[1] * b[0];
        // The highest tile over the point is the one that contains it; only rounding at edges needs the comparison.
        let (mut kind, mut height) = (0.0, f64::NEG_INFINITY);
        for tile in tiling.tiles {
            let (x, z) = (p.x - tile.center[0], p.z - tile.center[1]);
            let i = ((x * b[1] - z * b[0]) / area).round();
            let j = ((z * a[0] - x * a[1]) / area).round();
            for (di, dj) in NEIGHBORS {
                let (i, j) = (i + di, j + dj);
                let offset = [x - (i * a[0] + j * b[0]), z - (i * a[1] + j * b[1])];
                if offset[0] * offset[0] + offset[1] * offset[1] > tile.radius * tile.radius {
                    continue;
                }
                let here = tile.height(offset);
                if here > height {
                    (kind, height) = (tile.kind, here);
                }
                if height > 0.0 {
                    return (kind + 1.0 - height.min(1.0)) / tiling.kinds;
                }
            }
        }
        (kind + 1.0) / tiling.kinds
    }
}

/// The nearest cell of a skewed lattice may be one beside that of the rounded coordinates.
const NEIGHBORS: [(f64, f64); 9] = [
    (0.0, 0.0),
    (-1.0, 0.0),
    (1.0, 0.0),
    (0.0, -1.0),
    (0.0, 1.0),
    (-1.0, -1.0),
    (-1.0, 1.0),
    (1.0, -1.0),
    (1.0, 1.0),
];

#[cfg(test)]
mod tests {
    use super::*;

    /// The area of a convex polygon from its edges, sorted by direction.
    fn area(tile: &Tile) -> f64 {
        let mut edges = tile.edges.to_vec();
        edges.sort_by_key(|edge| edge.0 % 24);
        let corner = |i: usize| {
            let ((a, da, _), (b, db, _)) = (edges[i], edges[(i + 1) % edges.len()]);
            let (na, nb) = ((cosine(a), cosine(a + 18)), (cosine(b), cosine(b + 18)));
            let det = na.0 * nb.1 - na.1 * nb.0;
            ((da * nb.1 - db * na.1) / det, (na.0 * db - nb.0 * da) / det)
        };
        let count = edges.len();
        let cross = |i: usize| {
            let (p, q) = (corner(i), corner((i + 1) % count));
            p.0 * q.1 - p.1 * q.0
        };
        0.5 * (0..count).map(cross).sum::<f64>()
    }

    #[test]
    fn tiles_fill_the_cell_of_their_lattice() {
        for (number, tiling) in (1..).zip(&tables::TILINGS) {
            let [a, b] = tiling.lattice;
            let cell = (a[0] * b[1] - a[1] * b[0]).abs();
            let tiles: f64 = tiling.tiles.iter().map(area).sum();
            assert!(
                (tiles - cell).abs() < 1e-13 * 100.0,
                "tiling {number}: {tiles} of {cell}"
            );
        }
    }

    #[test]
    fn every_point_lies_in_exactly_one_tile() {
        for (number, tiling) in (1..).zip(&tables::TILINGS) {
            let [a, b] = tiling.lattice;
            for k in 0..500 {
                let (x, z) = (
                    f64::from(k) * 0.618_034 % 7.0,
                    f64::from(k) * 0.414_214 % 5.0,
                );
                let mut tiles = 0;
                for tile in tiling.tiles {
                    for i in -30..=30 {
                        for j in -30..=30 {
                            let (i, j) = (f64::from(i), f64::from(j));
                            let offset = [
                                x - tile.center[0] - i * a[0] - j * b[0],
                                z - tile.center[1] - i * a[1] - j * b[1],
                            ];
                            tiles += u32::from(tile.height(offset) > 1e-9);
                        }
                    }
                }
                assert!(tiles <= 1, "tiling {number} at {x}, {z}: {tiles} tiles");
            }
        }
    }
}
