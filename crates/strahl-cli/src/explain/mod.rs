//! The ray tree of a pixel as text, as JSON, as a graph and as a page.

mod digits;
mod dot;
mod json;
mod lights;
mod names;
mod page;
mod summary;
mod tally;
mod terms;
mod text;
mod writer;

pub(crate) use digits::Digits;
pub(crate) use dot::dot;
pub(crate) use json::{explanation, json};
pub(crate) use text::text;

use std::str::FromStr;
use strahl::tracing::{PixelTree, Sampling};

/// A pixel and the ray trees of its samples.
pub(crate) struct Pixel<'p> {
    pub(crate) at: (u32, u32),
    pub(crate) size: (u32, u32),
    pub(crate) sampling: Sampling,
    pub(crate) tree: &'p PixelTree,
}

/// The parts of a pixel to show.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shown {
    /// The samples whose trees are shown.
    pub(crate) sample: Option<Chosen>,
    /// The largest number of rays of a tree; `None` shows all.
    pub(crate) rays: Option<usize>,
    pub(crate) digits: Digits,
}

/// Samples of a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Chosen {
    All,
    /// This sample, counted from 1.
    One(usize),
}

/// The largest number of rays shown of a tree; `None` shows all.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct MostRays(pub(crate) Option<usize>);

impl FromStr for MostRays {
    type Err = String;

    fn from_str(s: &str) -> Result<Self, String> {
        match s.parse() {
            _ if s == "all" => Ok(Self(None)),
            Ok(number) if number > 0 => Ok(Self(Some(number))),
            _ => Err("expected a number of rays, at least 1, or `all`".to_owned()),
        }
    }
}

impl FromStr for Chosen {
    type Err = String;

    fn from_str(s: &str) -> Result<Self, String> {
        match s.parse() {
            _ if s == "all" => Ok(Self::All),
            Ok(number) if number > 0 => Ok(Self::One(number)),
            _ => Err("expected the number of a sample, counted from 1, or `all`".to_owned()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_are_chosen_by_number_or_all() {
        assert_eq!("all".parse(), Ok(Chosen::All));
        assert_eq!("3".parse(), Ok(Chosen::One(3)));
        assert_eq!("7".parse(), Ok(MostRays(Some(7))));
        assert_eq!("all".parse(), Ok(MostRays(None)));
        for bad in ["0", "-1", "first", ""] {
            assert!(bad.parse::<Chosen>().is_err(), "{bad}");
            assert!(bad.parse::<MostRays>().is_err(), "{bad}");
        }
    }
}
