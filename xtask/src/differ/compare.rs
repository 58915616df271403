use crate::compare_pov::picture::Shown;

/// A channel may differ by this much before its pixel counts: rounding, and numerical normals.
const SLACK: u8 = 8;

/// This many pixels may differ: single points on edges, where rounding decides.
const FEW: usize = 6;

/// A larger mean difference always counts, even if shifted edges could explain every pixel.
const MEAN: f64 = 6.0;

/// The difference of two pictures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Distance {
    /// The share of pixels that differ by more than shifted edges explain.
    pub(super) share: f64,
    /// The mean absolute difference of the channels, in 8-bit codes.
    pub(super) mean: f64,
    pixels: usize,
}

impl Distance {
    /// Whether the difference is more than shifted edges and rounding.
    pub(super) fn counts(&self) -> bool {
        self.pixels > FEW || self.mean > MEAN
    }

    /// Whether two differences are of about the same size, so that reducing keeps the finding.
    pub(super) fn is_like(&self, before: &Self) -> bool {
        let near = |now: f64, before: f64| now >= 0.4 * before && now <= 3.0 * before;
        self.counts()
            && (near(self.share, before.share) || near(self.mean, before.mean))
            && self.mean <= 4.0 * before.mean
    }
}

/// Whether a pixel of the two pictures differs by more than rounding.
fn differs_at(a: &Shown, b: &Shown, x: u32, y: u32) -> bool {
    (0..3).any(|c| a.code(x, y, c).abs_diff(b.code(x, y, c)) > SLACK)
}

/// At most `most` of the pixels that differ by more than rounding, spread over the pictures.
pub(super) fn some_that_differ(a: &Shown, b: &Shown, most: usize) -> Vec<(u32, u32)> {
    let (width, height) = a.size();
    let all: Vec<_> = (0..height)
        .flat_map(|y| (0..width).map(move |x| (x, y)))
        .filter(|&(x, y)| differs_at(a, b, x, y))
        .collect();
    let step = all.len().div_ceil(most.max(1)).max(1);
    all.into_iter().step_by(step).collect()
}

/// Whether the two pictures have the same colour at a pixel, but for rounding.
pub(super) fn agree_at(a: &Shown, b: &Shown, (x, y): (u32, u32)) -> bool {
    !differs_at(a, b, x, y)
}

/// `None` for different sizes.
pub(super) fn distance(a: &Shown, b: &Shown) -> Option<Distance> {
    let (mean, _) = crate::compare_pov::picture::compare(a, b)?;
    let (width, height) = a.size();
    let mut pixels = 0;
    for y in 0..height {
        for x in 0..width {
            if differs_at(a, b, x, y) && !(is_between(a, b, x, y) && is_between(b, a, x, y)) {
                pixels += 1;
            }
        }
    }
    Some(Distance {
        share: pixels as f64 / f64::from(width * height),
        mean,
        pixels,
    })
}

/// Whether the pixel of `a` lies within what `b` shows at this place and its eight neighbours.
fn is_between(a: &Shown, b: &Shown, x: u32, y: u32) -> bool {
    let (width, height) = b.size();
    (0..3).all(|c| {
        let around = (y.saturating_sub(1)..(y + 2).min(height))
            .flat_map(|v| (x.saturating_sub(1)..(x + 2).min(width)).map(move |u| (u, v)));
        let (mut low, mut high) = (u8::MAX, 0);
        for (u, v) in around {
            let code = b.code(u, v, c);
            (low, high) = (low.min(code), high.max(code));
        }
        let code = a.code(x, y, c);
        code.saturating_add(SLACK) >= low && code <= high.saturating_add(SLACK)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 16x8 pixels of one channel, repeated.
    fn shown(code: impl Fn(u32, u32) -> u8) -> Shown {
        let rgb = (0..8)
            .flat_map(|y| (0..16).map(move |x| (x, y)))
            .flat_map(|(x, y)| [code(x, y); 3])
            .collect();
        Shown::new(16, 8, rgb)
    }

    #[test]
    fn equal_pictures_and_roundings_do_not_count() {
        let a = shown(|x, y| (x * 7 + y) as u8);
        let b = shown(|x, y| (x * 7 + y + 8) as u8);
        assert_eq!(distance(&a, &a).unwrap().mean, 0.0);
        assert!(!distance(&a, &a).unwrap().counts());
        assert_eq!(distance(&a, &b).unwrap().share, 0.0);
    }

    #[test]
    fn an_edge_one_pixel_off_does_not_count() {
        let edge = |at| shown(move |x, _| if x < at { 100 } else { 140 });
        assert_eq!(distance(&edge(7), &edge(8)).unwrap().share, 0.0);
        assert!(!distance(&edge(7), &edge(8)).unwrap().counts());
        // An edge shifted by two columns.
        assert_eq!(distance(&edge(7), &edge(9)).unwrap().pixels, 16);
    }

    #[test]
    fn another_colour_counts() {
        let (a, b) = (
            shown(|_, _| 100),
            shown(|x, _| if x < 4 { 120 } else { 100 }),
        );
        let far = distance(&a, &b).unwrap();
        assert_eq!(far.pixels, 4 * 8);
        assert!(far.counts() && far.is_like(&far));
        let few = distance(&a, &shown(|x, y| if x < 2 && y < 2 { 120 } else { 100 })).unwrap();
        assert!(!few.counts());
    }

    #[test]
    fn swapped_fine_patterns_count_by_their_mean() {
        let (a, b) = (
            shown(|x, y| if (x + y) % 2 == 0 { 0 } else { 200 }),
            shown(|x, y| if (x + y) % 2 == 1 { 0 } else { 200 }),
        );
        assert_eq!(distance(&a, &b).unwrap().share, 0.0);
        assert!(distance(&a, &b).unwrap().counts());
    }

    #[test]
    fn the_pixels_that_differ_are_spread() {
        let (a, b) = (
            shown(|_, _| 100),
            shown(|x, _| if x < 4 { 120 } else { 100 }),
        );
        let some = some_that_differ(&a, &b, 5);
        assert_eq!(some, [(0, 0), (3, 1), (2, 3), (1, 5), (0, 7)]);
        assert!(!agree_at(&a, &b, some[4]) && agree_at(&a, &b, (4, 0)));
        assert!(some_that_differ(&a, &a, 5).is_empty());
    }

    #[test]
    fn sizes_must_be_equal() {
        let other = Shown::new(1, 1, vec![0; 3]);
        assert!(distance(&other, &shown(|_, _| 0)).is_none());
    }
}
