//! Puts the parts of a picture together.

use super::{Film, FilmError, PixelInfo, Region, try_filled};
use std::fmt;

/// Why parts make no picture. Parts are named by their index in the list.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MergeError {
    /// There are no parts.
    #[error("there are no parts to merge")]
    Nothing,
    /// A part belongs to a picture of another size than the first one.
    #[error(
        "part {part} is of a picture of {found:?} pixels, the first part of one of {expected:?}"
    )]
    OtherSize {
        /// The part.
        part: usize,
        /// Width and height of its picture.
        found: (u32, u32),
        /// Those of the first part's picture.
        expected: (u32, u32),
    },
    /// A part has an alpha channel or layers and the first one has not, or the other way around.
    #[error("part {part} has other channels than the first part")]
    OtherChannels {
        /// The part.
        part: usize,
    },
    /// The lists of a part are not as long as its region is large.
    #[error("part {part} has not one value for each pixel of its region")]
    Malformed {
        /// The part.
        part: usize,
    },
    /// Two parts have pixels in common.
    #[error("parts {first} and {second} both have the pixels {region}")]
    Overlap {
        /// One part.
        first: usize,
        /// The other part.
        second: usize,
        /// Their common pixels.
        region: Region,
    },
    /// No part has these pixels.
    #[error("{pixels} pixels are in no part: {}", list(regions))]
    Missing {
        /// The pixels as rectangles, from the top.
        regions: Vec<Region>,
        /// Their number.
        pixels: u64,
    },
    /// The picture can't be made.
    #[error(transparent)]
    Film(#[from] FilmError),
}

fn list(regions: &[Region]) -> String {
    let all: Vec<String> = regions.iter().map(Region::to_string).collect();
    all.join("; ")
}

impl fmt::Display for Region {
    /// `X,Y,WIDTHxHEIGHT`, as `--region` of the program reads it.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{},{},{}x{}", self.x, self.y, self.width, self.height)
    }
}

impl Region {
    /// The pixels that both regions have.
    pub fn intersection(&self, other: &Self) -> Option<Self> {
        let (x, y) = (self.x.max(other.x), self.y.max(other.y));
        let right = u64::from(self.x) + u64::from(self.width);
        let right = right.min(u64::from(other.x) + u64::from(other.width));
        let bottom = u64::from(self.y) + u64::from(self.height);
        let bottom = bottom.min(u64::from(other.y) + u64::from(other.height));
        let width = right.checked_sub(x.into()).filter(|w| *w > 0)?;
        let height = bottom.checked_sub(y.into()).filter(|h| *h > 0)?;
        // No wider and no higher than either region.
        Some(Self {
            x,
            y,
            width: u32::try_from(width).ok()?,
            height: u32::try_from(height).ok()?,
        })
    }

    /// The part of a picture of this size that none of the regions has, as rectangles from the top.
    pub fn uncovered(width: u32, height: u32, regions: &[Self]) -> Vec<Self> {
        let mut rows: Vec<u32> = vec![0, height];
        for region in regions {
            rows.extend([region.y, region.y.saturating_add(region.height)]);
        }
        rows.retain(|y| *y <= height);
        rows.sort_unstable();
        rows.dedup();
        let mut free: Vec<Self> = vec![];
        for pair in rows.windows(2) {
            let (y, bottom) = (pair[0], pair[1]);
            let mut here: Vec<(u32, u32)> = regions
                .iter()
                .filter(|r| r.y <= y && y < r.y.saturating_add(r.height))
                .map(|r| (r.x, r.x.saturating_add(r.width)))
                .collect();
            here.push((width, width));
            here.sort_unstable();
            let mut x = 0;
            for (left, right) in here {
                if left > x {
                    let gap = Self {
                        x,
                        y,
                        width: left.min(width) - x,
                        height: bottom - y,
                    };
                    // A gap that goes on from the row above is one rectangle.
                    let above = free
                        .iter_mut()
                        .rev()
                        .find(|f| (f.x, f.width) == (gap.x, gap.width) && f.y + f.height == gap.y);
                    match above {
                        Some(above) => above.height += gap.height,
                        None => free.push(gap),
                    }
                }
                x = x.max(right.min(width));
            }
        }
        free
    }
}

impl Film {
    /// The picture whose parts these films are: complete, without overlaps, and with the channels that all of them have. Its bits are those
    /// of a film that was rendered at once.
    ///
    /// # Errors
    /// [`MergeError`] says which parts don't fit, or which pixels are missing.
    pub fn merge(parts: &[Self]) -> Result<Self, MergeError> {
        let first = parts.first().ok_or(MergeError::Nothing)?;
        let size = (first.width, first.height);
        for (part, film) in parts.iter().enumerate() {
            first.check_part(part, film)?;
        }
        let regions: Vec<Region> = parts.iter().map(|film| film.region).collect();
        no_overlap(&regions)?;
        let missing = Region::uncovered(size.0, size.1, &regions);
        if !missing.is_empty() {
            return Err(MergeError::Missing {
                pixels: missing.iter().map(Region::pixels).sum(),
                regions: missing,
            });
        }
        let mut whole = Self::try_new(size.0, size.1, None, first.info.is_some())?;
        if first.alpha.is_some() {
            whole.alpha = Some(try_filled(whole.region, 1.0)?);
        }
        for film in parts {
            whole.take(film);
        }
        Ok(whole)
    }

    /// Checks that a part can be one of the picture of `self`.
    fn check_part(&self, part: usize, film: &Self) -> Result<(), MergeError> {
        let (expected, found) = ((self.width, self.height), (film.width, film.height));
        if found != expected {
            return Err(MergeError::OtherSize {
                part,
                found,
                expected,
            });
        }
        if film.alpha.is_some() != self.alpha.is_some()
            || film.info.is_some() != self.info.is_some()
        {
            return Err(MergeError::OtherChannels { part });
        }
        let whole = Region::full(film.width, film.height);
        let inside = film.region.intersection(&whole) == Some(film.region);
        let pixels = film.region.pixels();
        let complete = |length: usize| length as u64 == pixels;
        let lists = complete(film.pixels.len())
            && film.alpha.as_ref().is_none_or(|list| complete(list.len()))
            && film.info.as_ref().is_none_or(|list| complete(list.len()));
        match inside && lists {
            true => Ok(()),
            false => Err(MergeError::Malformed { part }),
        }
    }

    /// Copies the pixels of a part, which lies in the film and has the same channels.
    fn take(&mut self, part: &Self) {
        fn copy<T: Copy>(to: &mut [T], to_region: Region, from: &[T], from_region: Region) {
            let width = from_region.width as usize;
            for (y, row) in (from_region.y..).zip(from.chunks_exact(width.max(1))) {
                let start = to_region.index(from_region.x, y);
                to[start..start + width].copy_from_slice(row);
            }
        }
        let (whole, region) = (self.region, part.region);
        copy(&mut self.pixels, whole, &part.pixels, region);
        if let (Some(to), Some(from)) = (&mut self.alpha, &part.alpha) {
            copy::<f32>(to, whole, from, region);
        }
        if let (Some(to), Some(from)) = (&mut self.info, &part.info) {
            copy::<PixelInfo>(to, whole, from, region);
        }
    }
}

/// Checks that no two regions have a pixel in common.
fn no_overlap(regions: &[Region]) -> Result<(), MergeError> {
    let mut order: Vec<usize> = (0..regions.len()).collect();
    order.sort_by_key(|&i| (regions[i].y, i));
    for (place, &first) in order.iter().enumerate() {
        let bottom = regions[first].y.saturating_add(regions[first].height);
        // Only regions that begin above this one's bottom can have a pixel of it.
        let near = order[place + 1..].iter();
        for &second in near.take_while(|&&i| regions[i].y < bottom) {
            if let Some(region) = regions[first].intersection(&regions[second]) {
                return Err(MergeError::Overlap {
                    first: first.min(second),
                    second: first.max(second),
                    region,
                });
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn region(x: u32, y: u32, width: u32, height: u32) -> Region {
        Region {
            x,
            y,
            width,
            height,
        }
    }

    /// A part of a picture of 10 x 6 pixels whose values tell their places.
    fn part(of: Region) -> Film {
        let mut film = Film::try_new(10, 6, Some(of), true).unwrap();
        let places = || of.positions().map(|(x, y)| (x as f32, y as f32));
        film.pixels = places().map(|(x, y)| [x, y, -0.0]).collect();
        film.alpha = Some(places().map(|(x, y)| x / 10.0 + y).collect());
        for ((x, y), info) in of.positions().zip(film.info.as_mut().unwrap()) {
            info.object = x + 10 * y;
        }
        film
    }

    const PARTS: [(u32, u32, u32, u32); 4] =
        [(0, 0, 4, 6), (4, 0, 6, 1), (4, 1, 3, 5), (7, 1, 3, 5)];

    fn parts() -> Vec<Film> {
        PARTS.map(|(x, y, w, h)| part(region(x, y, w, h))).into()
    }

    #[test]
    fn parts_in_any_order_make_the_picture() {
        let whole = part(Region::full(10, 6));
        let mut parts = parts();
        assert_eq!(Film::merge(&parts), Ok(whole.clone()));
        parts.reverse();
        assert_eq!(Film::merge(&parts).unwrap().sha256(), whole.sha256());
        assert_eq!(Film::merge(std::slice::from_ref(&whole)), Ok(whole));
        assert_eq!(Film::merge(&[]), Err(MergeError::Nothing));
    }

    #[test]
    fn what_is_missing_is_named() {
        for missing in 0..4 {
            let mut some = parts();
            let gone = some.remove(missing).region;
            let error = Film::merge(&some).unwrap_err();
            let MergeError::Missing { regions, pixels } = error else {
                panic!("{error}");
            };
            assert_eq!((pixels, regions), (gone.pixels(), vec![gone]));
        }
        let error = Film::merge(&[part(region(3, 2, 4, 2))]).unwrap_err();
        let text = error.to_string();
        assert!(
            text.contains("52 pixels") && text.contains("0,0,10x2"),
            "{text}"
        );
    }

    #[test]
    fn what_does_not_fit_is_named() {
        let merge = |change: &dyn Fn(&mut Vec<Film>)| {
            let mut all = parts();
            change(&mut all);
            Film::merge(&all).unwrap_err()
        };
        assert_eq!(
            merge(&|all| all.push(part(region(6, 4, 2, 2)))),
            MergeError::Overlap {
                first: 2,
                second: 4,
                region: region(6, 4, 1, 2)
            }
        );
        let size = merge(&|all| all[2].height = 7);
        assert!(matches!(size, MergeError::OtherSize { part: 2, .. }));
        let channels = merge(&|all| all[1].alpha = None);
        assert_eq!(channels, MergeError::OtherChannels { part: 1 });
        assert_eq!(
            merge(&|all| all[3].info = None),
            MergeError::OtherChannels { part: 3 }
        );
        assert_eq!(
            merge(&|all| {
                all[1].pixels.pop();
            }),
            MergeError::Malformed { part: 1 }
        );
        assert_eq!(
            merge(&|all| all[3].region.x = 8),
            MergeError::Malformed { part: 3 }
        );
    }
}
