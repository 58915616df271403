//! Where a ray of a packet is inside of the nodes of a tree: the walk through what [`PacketTree`] knows.

use super::compiled::Csg;
use super::fusing::TooClose;
use super::leaf::Leaf;
use super::node::{Kind, Node};
use super::packet_tree::PacketTree;
use super::query::Query;
use super::sweep::Rule;
use crate::primitives::convex::{End, Span, Stay};
use crate::{Scratch, Side, SurfaceId};
use arrayvec::ArrayVec;

/// The most ends of the spans of a node; with more the search with one ray decides.
const MOST_ENDS: usize = 8;

/// Where a ray is inside of a node: whether it is inside where it begins, and where it enters and leaves further on.
#[derive(Debug, Default)]
pub(super) struct Line {
    inside: bool,
    pub(super) ends: ArrayVec<LineEnd, MOST_ENDS>,
}

/// An end of a span.
#[derive(Clone, Copy, Debug)]
pub(super) struct LineEnd {
    pub(super) t: f64,
    pub(super) leaf: u32,
    pub(super) element: u32,
    pub(super) facet: u32,
}

impl Line {
    /// The state of a line that is the same everywhere.
    #[inline(always)]
    fn constant(&self) -> Option<bool> {
        self.ends.is_empty().then_some(self.inside)
    }

    #[inline(always)]
    fn set(&mut self, inside: bool) {
        self.inside = inside;
        self.ends.clear();
    }
}

/// The search of one ray for the spans of a tree's nodes.
pub(super) struct Search<'a> {
    pub(super) csg: &'a Csg,
    pub(super) tree: &'a PacketTree,
    pub(super) place: usize,
    pub(super) query: &'a Query<'a>,
    pub(super) scratch: &'a mut Scratch,
}

impl Search<'_> {
    /// Where the ray is inside of a node.
    pub(super) fn node(&mut self, index: u32, out: &mut Line) -> Result<(), TooClose> {
        let Some(node) = self.csg.node(index) else {
            return Err(TooClose);
        };
        if !self.tree.may_meet(index, self.place) {
            out.set(node.far);
            return Ok(());
        }
        self.met(node, out)
    }

    /// The same for a node that the ray may meet.
    #[inline(always)]
    fn met(&mut self, node: &Node, out: &mut Line) -> Result<(), TooClose> {
        match node.kind {
            Kind::Leaf(number) => self.leaf(number, out),
            Kind::Operation(rule) => self.operation(node, rule, out),
        }
    }

    fn operation(&mut self, node: &Node, rule: Rule, out: &mut Line) -> Result<(), TooClose> {
        let neutral = rule.neutral();
        out.set(neutral);
        let mut operand = Line::default();
        for place in node.first..node.end {
            let number = self.csg.operand(place).unwrap_or_default();
            let Some(node) = self.csg.node(number) else {
                return Err(TooClose);
            };
            if !self.tree.may_meet(number, self.place) {
                if node.far != neutral {
                    out.set(node.far);
                    return Ok(());
                }
                continue;
            }
            if out.ends.is_empty() {
                self.met(node, out)?;
            } else {
                self.met(node, &mut operand)?;
                match operand.constant() {
                    None => self.query.combine(rule, out, &operand)?,
                    Some(inside) if inside == neutral => {}
                    Some(inside) => out.set(inside),
                }
            }
            if out.constant() == Some(!neutral) {
                return Ok(());
            }
        }
        Ok(())
    }

    #[inline(always)]
    fn leaf(&mut self, number: u32, out: &mut Line) -> Result<(), TooClose> {
        let Some(leaf) = self.csg.leaf(number) else {
            return Err(TooClose);
        };
        let own = self.query.own(number);
        if !leaf.has_stays() {
            return self.listed(leaf, number, own, out);
        }
        let known = match own {
            None => self.tree.stay(number, self.place),
            Some(_) => None,
        };
        let stay = match known {
            Some(stay) => stay,
            None => leaf.stay(self.query.ray, own).ok_or(TooClose)?,
        };
        self.query.stay(leaf, number, own, &stay, out)
    }

    /// The same for a shape that lists its crossings.
    #[inline(never)]
    fn listed(
        &mut self,
        leaf: &Leaf,
        number: u32,
        own: Option<SurfaceId>,
        out: &mut Line,
    ) -> Result<(), TooClose> {
        let query = self.query;
        let mut list = self.scratch.take();
        leaf.bare_crossings(query.ray, query.alive, own, self.scratch, &mut list);
        out.set(list.inside_at_start);
        let mut sure = Ok(());
        for crossing in &list.list {
            let (hit, enters) = (&crossing.hit, crossing.side == Side::Enter);
            if crossing.side == Side::Inner || hit.uv != [0.0; 2] || query.starts_at(hit.t) {
                sure = Err(TooClose);
            } else if hit.t > query.begin {
                let end = LineEnd {
                    t: hit.t,
                    leaf: number,
                    element: hit.surface.element,
                    facet: hit.surface.facet,
                };
                sure = sure.and(out.ends.try_push(end).map_err(|_| TooClose));
            } else {
                out.inside = enters;
            }
        }
        self.scratch.give(list);
        sure
    }
}

impl Query<'_> {
    /// Where the ray is inside of what a leaf contributes, given where it is inside of its shape.
    #[inline(always)]
    fn stay(
        &self,
        leaf: &Leaf,
        number: u32,
        own: Option<SurfaceId>,
        stay: &Stay,
        out: &mut Line,
    ) -> Result<(), TooClose> {
        // Whether the leaf contributes what is outside of the span.
        let outside = leaf.negative != stay.outside;
        out.set(outside);
        let Some(Span { enter, exit }) = stay.span else {
            return Ok(());
        };
        if exit.t < self.alive.min || enter.t > self.alive.max {
            return Ok(());
        }
        for End { t, facet } in [enter, exit] {
            let left = own.is_some_and(|surface| t == 0.0 && surface.facet == facet);
            if left || t.is_infinite() {
                continue;
            }
            if self.starts_at(t) {
                return Err(TooClose);
            }
            if t > self.begin {
                out.ends.push(LineEnd {
                    t,
                    leaf: number,
                    element: leaf.first_element,
                    facet,
                });
            }
        }
        out.inside = (enter.t <= self.begin && self.begin < exit.t) != outside;
        Ok(())
    }

    /// Combines what the ray is inside of with another operand.
    fn combine(&self, rule: Rule, line: &mut Line, other: &Line) -> Result<(), TooClose> {
        // A union; and an intersection is the complement of the union of complements.
        let neutral = rule.neutral();
        let holds = |a: bool, b: bool| ((a != neutral) | (b != neutral)) != neutral;
        let (mut a, mut b) = (line.inside, other.inside);
        let mut state = holds(a, b);
        let inside = state;
        let mut ends = ArrayVec::<LineEnd, MOST_ENDS>::new();
        let (mut left, mut right) = (&line.ends[..], &other.ends[..]);
        let mut before = f64::NEG_INFINITY;
        loop {
            let end = match (left.split_first(), right.split_first()) {
                (None, None) => break,
                (Some((end, rest)), other) if other.is_none_or(|(o, _)| end.t < o.t) => {
                    (a, left) = (!a, rest);
                    end
                }
                (_, Some((end, rest))) => {
                    (b, right) = (!b, rest);
                    end
                }
                // Parameters are numbers.
                _ => return Err(TooClose),
            };
            if before <= self.range.max {
                self.check_apart(before, end.t)?;
            }
            before = end.t;
            if holds(a, b) != state {
                state = !state;
                ends.try_push(*end).map_err(|_| TooClose)?;
            }
        }
        // Only those that there are are copied.
        line.set(inside);
        line.ends.extend(ends);
        Ok(())
    }
}
