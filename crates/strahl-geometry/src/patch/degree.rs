//! Hits that the search has lost, found from the border of the patch alone: the last resort.
//!
//! How often the border winds around the ray is the sum of the signs of the hits (the degree of a map). So if hits are missing, one of
//! two halves of the patch lacks some, too, and the half's border shows which: halving leads to a hit, however the patch is folded
//! or collapsed there (F. Stenger, "Computing the topological degree of a mapping in R^n", Numerische Mathematik 25, 1975).

use super::border::winding;
use super::frame::Frame;
use super::hull::{OVERLAP, points, project};
use super::net::Net;
use super::newton::Candidate;
use strahl_math::error::gamma;

/// After so many halvings in turn, parameters are neighbouring numbers. Mostly points are so much earlier.
const HALVINGS: usize = 2 * 53;

/// A part of a patch, seen along the ray.
struct Part<const K: usize> {
    view: Net<2, K>,
    from: [f64; 2],
    size: [f64; 2],
}

impl<const K: usize> Part<K> {
    fn halves(&self, axis: usize) -> [Self; 2] {
        let views = match axis {
            0 => self.view.halves_u(),
            _ => self.view.halves_v(),
        };
        let (mut from, mut size) = (self.from, self.size);
        size[axis] *= 0.5;
        views.map(|view| {
            let part = Self { view, from, size };
            from[axis] += size[axis];
            part
        })
    }

    /// The smallest of the parts that have half its sides each time, and contain the place of a candidate, which is larger than its zone.
    fn around(mut self, candidate: &Candidate) -> Self {
        for axis in 0..2 {
            let place = candidate.place()[axis];
            while self.size[axis] > candidate.zone[axis] {
                let [a, b] = self.halves(axis);
                self = if place < b.from[axis] { a } else { b };
            }
        }
        self
    }

    /// The middle of the smallest part that lacks a hit of this sign, not smaller than `smallest` in space, and whether borders told which half it was each
    /// time.
    fn halved(mut self, hits: &[Candidate], sign: i32, smallest: f64) -> ([f64; 2], bool) {
        let mut is_certain = true;
        for step in 0..HALVINGS {
            if self.extent() <= smallest {
                break;
            }
            let [a, b] = self.halves(step % 2);
            let (in_a, in_b) = (a.missing(hits, sign), b.missing(hits, sign));
            self = match (in_a > 0, in_b > 0) {
                (true, false) => a,
                (false, true) => b,
                // What is nearer to the ray.
                (both, _) => {
                    is_certain &= both;
                    if a.distance() <= b.distance() { a } else { b }
                }
            };
        }
        let middle = std::array::from_fn(|k| self.from[k] + 0.5 * self.size[k]);
        (middle, is_certain)
    }

    /// How many more hits of this sign its border asks for than there are.
    fn missing(&self, hits: &[Candidate], sign: i32) -> i32 {
        let is_within = |hit: &&Candidate| {
            let place = hit.place();
            (0..2).all(|k| {
                let end = self.from[k] + self.size[k];
                place[k] >= self.from[k] && (place[k] < end || end == 1.0)
            })
        };
        let found: i32 = hits.iter().filter(is_within).map(|hit| hit.sign).sum();
        sign * (winding(&self.view) - found)
    }

    /// The longer side of the box around the control points.
    fn extent(&self) -> f64 {
        let (low, high) = self.view.extents();
        (high[0] - low[0]).max(high[1] - low[1])
    }

    /// How far the box around the control points is from the ray.
    fn distance(&self) -> f64 {
        let (low, high) = self.view.extents();
        let aside = |k: usize| {
            if low[k] > 0.0 {
                low[k]
            } else {
                (-high[k]).max(0.0)
            }
        };
        aside(0).max(aside(1))
    }
}

/// A hit of this sign that `hits` lack.
///
/// Where the numbers are too coarse to tell which half of the patch lacks it, it is at a place where the search gave up, if there is one
/// (`given_up`): there the search may have lost it, and only there.
pub(super) fn lost<const K: usize>(
    net: &Net<4, K>,
    frame: &Frame,
    hits: &[Candidate],
    given_up: &[Candidate],
    sign: i32,
) -> Candidate {
    let whole = || Part {
        view: frame.view(net),
        from: [0.0; 2],
        size: [1.0; 2],
    };
    let reach = points(net).fold(0.0, |most: f64, p| {
        let way = (p - frame.origin).abs().max_element();
        if way > most { way } else { most }
    });
    let (mut place, is_certain) = whole().halved(hits, sign, gamma(2) * reach);
    if !is_certain && !given_up.iter().any(|c| c.is_about(place)) {
        let parts = given_up.iter().map(|c| whole().around(c));
        let nearest = parts.min_by(|a, b| a.distance().total_cmp(&b.distance()));
        if let Some(nearest) = nearest {
            (place, _) = nearest.halved(hits, sign, gamma(2) * reach);
        }
    }
    let [u, v] = place;
    Candidate {
        t: frame.t(project(net.at(u, v))),
        u,
        v,
        sign,
        zone: [OVERLAP; 2],
        is_doubtful: true,
    }
}
