//! Builds the tree top-down as by default, but splits thin primitives into more parts, and splits space where the halves of a
//! set would overlap: slower to build, and rays visit fewer nodes and primitives.
//!
//! M. Stich, H. Friedrich, A. Dietrich, "Spatial Splits in Bounding Volume Hierarchies" (2009).

use super::grow::Subtree;
use super::presplit::presplit;
use super::spatial::SpaceCut;
use super::{Bvh8, Tree};
use crate::Shapes;
use crate::boxes::Box32;
use crate::bvh::MAX_DEPTH;
use crate::bvh::bins::{Bins, Plane};
use crate::bvh::refs::{Extent, Ref};
use crate::bvh::split::{LeafModel, blocks, middle};

/// Space is split where the halves of a set overlap by more than this part of its area,
const OVERLAP: f64 = 0.1;
/// and only if that lowers the cost to this part.
const GAIN: f32 = 0.99;
/// Smaller sets are not split in space: that would take most of the time and save next to nothing (945 k triangles: 7 s instead
/// of 1.7, 0.5 % fewer blocks a ray).
const LARGE: usize = 256;
/// Space splits may make one additional reference per this many primitives.
const SPARE: usize = 3;
/// Thin primitives are split before the build into at most this many additional parts per primitive.
const PRESPLIT: f64 = 1.0;

/// The tree over at least one primitive.
pub(super) fn build(shapes: &dyn Shapes, refs: Vec<Ref>) -> Tree {
    let refs = presplit(shapes, refs, PRESPLIT);
    let spare = (refs.len() / SPARE).min(Bvh8::MAX_PRIMITIVES.saturating_sub(refs.len()));
    Tree::grow(Pieces {
        shapes,
        extent: Extent::of_many(&refs),
        refs,
        depth: 0,
        spare,
    })
}

/// A set of parts of primitives.
struct Pieces<'a> {
    shapes: &'a dyn Shapes,
    refs: Vec<Ref>,
    extent: Extent,
    /// The number of splits on the way from the root.
    depth: usize,
    /// How many additional references its subtree may have.
    spare: usize,
}

/// How a set is divided.
enum Plan {
    Leaf,
    Halves,
    Plane(Plane),
    /// A split of space, and the plane to use if one of its sides turns out to be empty.
    Cut(SpaceCut, Option<Plane>),
}

impl Pieces<'_> {
    fn plan(&self, leaf: &LeafModel, bins: &mut Bins) -> Plan {
        let (count, classes) = (self.refs.len(), self.extent.classes);
        if leaf.is_block(count, classes) {
            return Plan::Leaf;
        }
        let fits = count <= leaf.max_size && classes.is_power_of_two();
        let or_leaf = |plan| if fits { Plan::Leaf } else { plan };
        let log = leaf.block_log(classes);
        // The number of levels that halving needs from here on, even with all additional references. Halving takes over while
        // there are still that many.
        let needed = (count + self.spare).ilog2() as usize + 1;
        if self.depth + needed >= MAX_DEPTH - 1 {
            return or_leaf(Plan::Halves);
        }
        bins.fill(&self.refs, &self.extent.bounds, &self.extent.centers);
        let area = bins.area(&self.extent.bounds);
        let plane = bins.cheapest(log);
        let cut = self.cut(plane.as_ref(), bins, log);
        let (cost, plan) = match (plane, cut) {
            (plane, Some(cut)) => (cut.cost, Plan::Cut(cut, plane)),
            (Some(plane), None) => (plane.cost, Plan::Plane(plane)),
            (None, None) => return or_leaf(Plan::Halves),
        };
        if fits && leaf.is_cheaper(blocks(count, log), f64::from(area), f64::from(cost)) {
            return Plan::Leaf;
        }
        plan
    }

    /// A split of space, if it is better than the best plane between primitives.
    fn cut(&self, plane: Option<&Plane>, bins: &Bins, log: u32) -> Option<SpaceCut> {
        if self.spare == 0 || self.refs.len() < LARGE {
            return None;
        }
        if let Some(plane) = plane {
            let [left, right] = bins.bounds(plane);
            let common = left.clipped(&right);
            let overlap = if common.is_empty() {
                0.0
            } else {
                common.half_area()
            };
            if overlap < OVERLAP * self.extent.bounds.half_area() {
                return None;
            }
        }
        let bounds = &self.extent.bounds;
        let cut = SpaceCut::cheapest(self.shapes, &self.refs, bounds, bounds.unit(), log)?;
        plane
            .is_none_or(|plane| cut.cost < GAIN * plane.cost)
            .then_some(cut)
    }
}

impl<'a> Pieces<'a> {
    /// Two sets made of this one.
    fn halves(self, parts: [Vec<Ref>; 2]) -> [Self; 2] {
        let counts = [parts[0].len(), parts[1].len()];
        let more = (counts[0] + counts[1]).saturating_sub(self.refs.len());
        let left = self.spare.saturating_sub(more);
        let first = left * counts[0] / (counts[0] + counts[1]).max(1);
        let mut spares = [first, left - first].into_iter();
        parts.map(|refs| Self {
            shapes: self.shapes,
            extent: Extent::of(&refs),
            refs,
            depth: self.depth + 1,
            spare: spares.next().unwrap_or(0),
        })
    }

    /// The primitives left of a plane, and the others.
    fn parted(self, plane: &Plane) -> [Self; 2] {
        let (left, right) = self.refs.iter().partition(|r| plane.is_left(r));
        self.halves([left, right])
    }

    /// Splits it at its [`middle`].
    fn halved(mut self) -> [Self; 2] {
        let middle = middle(&mut self.refs, &self.extent);
        let parts = [self.refs[..middle].to_vec(), self.refs[middle..].to_vec()];
        self.halves(parts)
    }
}

impl Subtree for Pieces<'_> {
    type Scratch = Bins;

    fn bounds(&self) -> &Box32 {
        &self.extent.bounds
    }

    fn count(&self) -> usize {
        self.refs.len()
    }

    fn split(self, leaf: &LeafModel, bins: &mut Bins) -> Result<[Self; 2], Self> {
        match self.plan(leaf, bins) {
            Plan::Leaf => Err(self),
            Plan::Halves => Ok(self.halved()),
            Plan::Plane(plane) => Ok(self.parted(&plane)),
            Plan::Cut(cut, plane) => {
                let parts = cut.apply(self.shapes, &self.refs, self.spare);
                if parts.iter().all(|part| !part.is_empty()) {
                    return Ok(self.halves(parts));
                }
                Ok(match plane {
                    Some(plane) => self.parted(&plane),
                    None => self.halved(),
                })
            }
        }
    }

    fn class(&self) -> u8 {
        self.extent.lowest_class()
    }

    fn ids(&self, into: &mut Vec<u32>) {
        into.extend(self.refs.iter().map(Ref::id));
    }
}
