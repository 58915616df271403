//! The ray tree of a pixel in words, as JSON and as a graph.

mod digits;
mod dot;
mod json;
mod names;
mod page;
mod summary;
mod tally;
mod terms;
mod text;

pub(crate) use digits::Digits;
pub(crate) use dot::dot;
pub(crate) use json::json;
pub(crate) use text::text;

use std::str::FromStr;
use strahl::tracing::{PixelTree, Sampling};

/// A pixel with all that happened in it.
pub(crate) struct Pixel<'p> {
    pub(crate) at: (u32, u32),
    pub(crate) size: (u32, u32),
    pub(crate) sampling: Sampling,
    pub(crate) tree: &'p PixelTree,
}

/// What is to be shown of a pixel.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shown {
    /// The samples whose trees are wanted.
    pub(crate) sample: Option<Chosen>,
    /// Most rays of a tree; all if it is `None`.
    pub(crate) rays: Option<usize>,
    pub(crate) digits: Digits,
}

/// Samples of a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Chosen {
    All,
    /// One, counted from 1.
    One(usize),
}

/// How many rays of a tree are shown at most.
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
