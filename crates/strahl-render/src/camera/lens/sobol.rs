//! Sobol's sequence in four dimensions: I. M. Sobol', "On the distribution of points in a cube and the approximate evaluation of integrals"
//! (1967), with the direction numbers of S. Joe and F. Y. Kuo (2008).

/// The number of dimensions.
const D: usize = 4;

/// For each dimension behind the first the coefficients of its primitive polynomial between the highest and the lowest one, as bits, and
/// its first direction numbers, which are as many as the polynomial's degree.
const POLYNOMIALS: [(u32, &[u32]); D - 1] = [(0, &[1]), (1, &[1, 3]), (1, &[1, 3, 1])];

/// What each bit of a point's number flips of its coordinates, the lowest bit first.
const DIRECTIONS: [[u32; D]; 32] = directions();

/// The points that the lowest eight bits of a number stand for.
const POINTS: [[u32; D]; 256] = points();

/// Point `index` of the sequence: its coordinates in units of 2^-32.
#[inline]
pub(super) fn sobol(index: u32) -> [u32; D] {
    let mut point = POINTS[index as usize % POINTS.len()];
    let mut bit = POINTS.len().trailing_zeros();
    while bit < u32::BITS && index >> bit != 0 {
        if index >> bit & 1 != 0 {
            point = sum(point, DIRECTIONS[bit as usize]);
        }
        bit += 1;
    }
    point
}

const fn sum(a: [u32; D], b: [u32; D]) -> [u32; D] {
    [a[0] ^ b[0], a[1] ^ b[1], a[2] ^ b[2], a[3] ^ b[3]]
}

const fn directions() -> [[u32; D]; 32] {
    let mut directions = [[0; D]; 32];
    let mut bit = 0;
    while bit < directions.len() {
        directions[bit][0] = 1 << (31 - bit);
        let mut d = 1;
        while d < D {
            let (coefficients, first) = POLYNOMIALS[d - 1];
            let degree = first.len();
            directions[bit][d] = if bit < degree {
                first[bit] << (31 - bit)
            } else {
                let mut direction = directions[bit - degree][d];
                direction ^= direction >> degree;
                let mut k = 1;
                while k < degree {
                    if coefficients >> (degree - 1 - k) & 1 != 0 {
                        direction ^= directions[bit - k][d];
                    }
                    k += 1;
                }
                direction
            };
            d += 1;
        }
        bit += 1;
    }
    directions
}

const fn points() -> [[u32; D]; 256] {
    let mut points = [[0; D]; 256];
    let mut index = 1;
    while index < points.len() {
        // The point without the lowest bit of its number comes before.
        let rest = index & (index - 1);
        points[index] = sum(points[rest], DIRECTIONS[index.trailing_zeros() as usize]);
        index += 1;
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_points_are_those_of_the_tables() {
        // In eighths: the published sequence, in the order of its numbers rather than of the Gray code.
        let eighths = [
            [0, 0, 0, 0],
            [4, 4, 4, 4],
            [2, 6, 6, 6],
            [6, 2, 2, 2],
            [1, 5, 3, 1],
            [5, 1, 7, 5],
            [3, 3, 5, 7],
            [7, 7, 1, 3],
        ];
        for (index, expected) in (0..).zip(eighths) {
            assert_eq!(sobol(index).map(|x| x >> 29), expected, "point {index}");
        }
    }

    #[test]
    fn each_cell_of_a_grid_has_a_point() {
        // 64 points that follow each other: in each of the 64 parts of an axis, and in each cell of all grids of the first two axes.
        for begin in [0, 64, 192, 256, 1 << 20, u32::MAX - 63] {
            let points: Vec<_> = (0..64).map(|n| sobol(begin + n)).collect();
            for d in 0..D {
                let mut parts: Vec<_> = points.iter().map(|p| p[d] >> 26).collect();
                parts.sort_unstable();
                assert!(parts.iter().copied().eq(0..64), "axis {d} from {begin}");
            }
            for (across, down) in [(1, 5), (2, 4), (3, 3), (4, 2), (5, 1)] {
                let cell = |p: &[u32; D]| (p[0] >> (32 - across)) << down | p[1] >> (32 - down);
                let mut cells: Vec<_> = points.iter().map(cell).collect();
                cells.sort_unstable();
                assert!(cells.iter().copied().eq(0..64), "{across}, {down}");
            }
        }
    }
}
