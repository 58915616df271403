//! The difference of two pictures of a plate, in 8-bit codes.

/// The side of a block in pixels.
const BLOCK: usize = 6;

/// A plate as it is displayed, in 8-bit codes.
pub(crate) struct Plate {
    pub(crate) width: usize,
    pub(crate) height: usize,
    /// Row by row.
    pub(crate) rgb: Vec<[u8; 3]>,
}

/// The difference of two plates, by four measures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Distance {
    /// Of the mean colours, in the channel with the largest difference.
    pub(crate) mean: f64,
    /// Of the histograms: how far the values must be moved on average to turn one into the other (the earth mover's distance).
    pub(crate) histogram: f64,
    /// Of the means of blocks, averaged over the blocks.
    pub(crate) blocks: f64,
    /// Of the pixels, averaged.
    pub(crate) pixels: f64,
}

impl Plate {
    /// The mean colour.
    pub(crate) fn mean(&self) -> [f64; 3] {
        mean(self.rgb.iter())
    }

    /// The means of all blocks.
    fn blocks(&self) -> Vec<[f64; 3]> {
        let mut blocks = vec![];
        for y in (0..self.height).step_by(BLOCK) {
            for x in (0..self.width).step_by(BLOCK) {
                let rows = (y..self.height.min(y + BLOCK)).map(|y| y * self.width);
                let ends = (x, self.width.min(x + BLOCK));
                blocks.push(mean(rows.flat_map(|row| {
                    self.rgb.get(row + ends.0..row + ends.1).unwrap_or_default()
                })));
            }
        }
        blocks
    }

    /// The values of a channel in ascending order.
    fn ordered(&self, channel: usize) -> Vec<u8> {
        let mut values: Vec<u8> = self.rgb.iter().map(|p| p[channel]).collect();
        values.sort_unstable();
        values
    }
}

fn mean<'a>(pixels: impl Iterator<Item = &'a [u8; 3]>) -> [f64; 3] {
    let (mut sum, mut count) = ([0.0; 3], 0.0);
    for pixel in pixels {
        for (sum, value) in sum.iter_mut().zip(pixel) {
            *sum += f64::from(*value);
        }
        count += 1.0;
    }
    sum.map(|s| s / f64::max(count, 1.0))
}

/// The differences of two plates of the same size.
pub(crate) fn distance(a: &Plate, b: &Plate) -> Distance {
    let apart = |(a, b): (&u8, &u8)| f64::from(a.abs_diff(*b));
    let average = |sum: f64, count: usize| sum / (3 * count).max(1) as f64;
    let sorted = (0..3)
        .map(|c| {
            a.ordered(c)
                .iter()
                .zip(&b.ordered(c))
                .map(apart)
                .sum::<f64>()
        })
        .sum();
    let pixels = a.rgb.iter().zip(&b.rgb);
    let pixels = pixels.map(|(a, b)| a.iter().zip(b).map(apart).sum::<f64>());
    let (left, right) = (a.blocks(), b.blocks());
    let blocks = left.iter().zip(&right);
    let blocks = blocks.map(|(a, b)| a.iter().zip(b).map(|(a, b)| (a - b).abs()).sum::<f64>());
    let means = a.mean().into_iter().zip(b.mean());
    Distance {
        mean: means.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max),
        histogram: average(sorted, a.rgb.len()),
        blocks: average(blocks.sum(), left.len()),
        pixels: average(pixels.sum(), a.rgb.len()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plate(rgb: &[[u8; 3]]) -> Plate {
        Plate {
            width: rgb.len(),
            height: 1,
            rgb: rgb.to_vec(),
        }
    }

    #[test]
    fn moved_pixels_change_neither_mean_nor_histogram() {
        let a = plate(&[[0; 3], [90; 3]]);
        let b = plate(&[[90; 3], [0; 3]]);
        let found = distance(&a, &b);
        assert_eq!((found.mean, found.histogram, found.blocks), (0.0, 0.0, 0.0));
        assert_eq!(found.pixels, 90.0);
    }

    #[test]
    fn the_worst_channel_is_the_difference_of_means() {
        let found = distance(&plate(&[[10, 20, 30]; 7]), &plate(&[[10, 23, 24]; 7]));
        assert_eq!(found.mean, 6.0);
        assert_eq!((found.histogram, found.blocks), (3.0, 3.0));
    }
}
