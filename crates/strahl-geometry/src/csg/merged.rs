//! Merges of convex solids: a ray is inside of them along one span, or along several that are apart. Only the ends of these spans are visible, so
//! the crossings within are never listed.

use super::boxes::Slabs;
use super::fusing::TooClose;
use super::leaf::Leaf;
use super::packet_tree::PacketTree;
use super::query::Query;
use super::small::Small;
use super::states::MOST;
use crate::primitives::convex::Span;
use crate::{PrimHit, SurfaceId};
use arrayvec::ArrayVec;
use std::ops::ControlFlow;

/// Where the ray is inside of the leaves. A quadric may have two parts.
type Spans = ArrayVec<(Span, u32), { 2 * MOST }>;

impl Small {
    /// Visits the visible surfaces along the ray until the visitor stops; only for merges. `known` is what a packet knows of the leaves, and the
    /// place of the ray in it.
    #[inline(always)]
    pub(super) fn visit_merged(
        &self,
        leaves: &[Leaf],
        query: &Query<'_>,
        known: Option<(&PacketTree, usize)>,
        visit: &mut impl FnMut(PrimHit) -> ControlFlow<()>,
    ) -> Result<(), TooClose> {
        let mut spans = Spans::new();
        let mut slabs = None;
        for (bit, operand) in self.operands.iter().enumerate() {
            // The others only clip, which does not matter if the ray meets no visible surface in the range.
            if bit == self.through_visible && spans.is_empty() {
                return Ok(());
            }
            let (number, leaf) = (operand.leaf, &leaves[operand.leaf as usize]);
            let own = query.own(number);
            let mut stay = None;
            if let (Some((tree, place)), None) = (known, own) {
                stay = tree.stay(number, place);
            } else if !operand.quick {
                let slabs: &Slabs = slabs.get_or_insert_with(|| Slabs::new(query.ray));
                if slabs.clip(&leaf.bounds, query.alive).is_none() {
                    continue;
                }
            }
            let stay = match stay {
                Some(stay) => stay,
                None => leaf.stay(query.ray, own).ok_or(TooClose)?,
            };
            let Some(span) = stay.span else {
                if stay.outside {
                    // There is no surface around the whole ray.
                    return Ok(());
                }
                continue;
            };
            if !stay.outside {
                query.add(span, number, own, &mut spans)?;
                continue;
            }
            let Span { enter, exit } = span;
            let before = Span {
                enter: Span::LINE.enter,
                exit: enter,
            };
            let behind = Span {
                enter: exit,
                exit: Span::LINE.exit,
            };
            for span in [before, behind] {
                query.add(span, number, own, &mut spans)?;
            }
        }
        if spans.is_empty() {
            return Ok(());
        }
        query.follow(leaves, &spans, visit)
    }
}

impl Query<'_> {
    /// Adds a span, if it reaches what is searched. Fails for ends that could coincide with the surface that the ray leaves.
    #[inline(always)]
    fn add(
        &self,
        span: Span,
        leaf: u32,
        own: Option<SurfaceId>,
        spans: &mut Spans,
    ) -> Result<(), TooClose> {
        if self.from.is_some() {
            for end in [span.enter, span.exit] {
                let left = own.is_some_and(|s| end.t == 0.0 && s.facet == end.facet);
                if end.t.is_finite() && self.starts_at(end.t) && !left {
                    return Err(TooClose);
                }
            }
        }
        if span.exit.t > self.begin && span.enter.t <= self.alive.max {
            spans.push((span, leaf));
        }
        Ok(())
    }

    /// Goes along the ray from one end of what the spans cover together to the next.
    #[inline(always)]
    fn follow(
        &self,
        leaves: &[Leaf],
        spans: &Spans,
        visit: &mut impl FnMut(PrimHit) -> ControlFlow<()>,
    ) -> Result<(), TooClose> {
        let mut at = self.begin;
        loop {
            // The ray is outside, or inside of the solids that it has just entered or starts in.
            let mut covered = None;
            for (index, (span, _)) in spans.iter().enumerate() {
                if span.enter.t <= at && at < span.exit.t {
                    covered = Some(index);
                    break;
                }
            }
            let (index, end) = match covered {
                Some(index) => {
                    let index = self.covered_until(spans, index)?;
                    (index, spans[index].0.exit)
                }
                None => {
                    let mut first: Option<(usize, f64)> = None;
                    for (index, (span, _)) in spans.iter().enumerate() {
                        let t = span.enter.t;
                        if t > at && first.is_none_or(|(_, least)| t < least) {
                            first = Some((index, t));
                        }
                    }
                    let Some((index, t)) = first else {
                        return Ok(());
                    };
                    if t > self.range.max {
                        return Ok(());
                    }
                    (index, spans[index].0.enter)
                }
            };
            if end.t == f64::INFINITY {
                return Ok(());
            }
            if !self.is_alone(spans, index, end.t) {
                return Err(TooClose);
            }
            if end.t > self.range.max {
                return Ok(());
            }
            let leaf = &leaves[spans[index].1 as usize];
            if self.shows(leaf, end.t, end.facet, visit).is_break() {
                return Ok(());
            }
            at = end.t;
        }
    }

    /// The span at whose end the ray leaves all of them, if it is inside of this one.
    #[inline(always)]
    fn covered_until(&self, spans: &Spans, index: usize) -> Result<usize, TooClose> {
        let mut last = index;
        let mut moved = spans.len() > 1;
        while moved {
            moved = false;
            for (other, (span, _)) in spans.iter().enumerate() {
                let t = spans[last].0.exit.t;
                if span.enter.t <= t && t < span.exit.t {
                    if self.could_coincide(span.enter.t, t) {
                        return Err(TooClose);
                    }
                    (last, moved) = (other, true);
                }
            }
        }
        Ok(last)
    }

    /// Whether no end but one of this span is at a place.
    #[inline(always)]
    fn is_alone(&self, spans: &Spans, index: usize, t: f64) -> bool {
        spans.iter().enumerate().all(|(other, (span, _))| {
            let (Span { enter, exit }, own) = (span, other == index);
            (own && enter.t == t || !self.could_coincide(enter.t, t))
                && (own && exit.t == t || !self.could_coincide(exit.t, t))
        })
    }

    /// Whether two parameters are so close that crossings there could coincide; there are none at infinity.
    #[inline(always)]
    fn could_coincide(&self, a: f64, b: f64) -> bool {
        !((a - b).abs() > self.fusing.gap(a, b)) && a.is_finite() && b.is_finite()
    }
}
