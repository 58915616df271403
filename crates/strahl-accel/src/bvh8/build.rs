//! The choice of a builder, and the default one, which splits top-down by the surface area heuristic.

use super::grow::Subtree;
use super::presplit::presplit;
use super::{Bvh8, Bvh8Parameters, Tree, fast, high};
use crate::boxes::Box32;
use crate::bvh::bins::Bins;
use crate::bvh::refs::{Ref, gather, take_out_far};
use crate::bvh::split::{LeafModel, Set};
use crate::parameters::{Parameters, choice};
use crate::shapes::all_bounds;
use crate::{List, Shapes};
use strahl_math::Aabb;
use strahl_simd::Simd;

/// Thin primitives are split before the build into at most this many additional parts per primitive.
const PRESPLIT: f64 = 0.3;

choice! {
    /// The builder of a [`Bvh8`].
    Build {
        /// Top-down, by the surface area heuristic over bins.
        "default" Default,
        /// Bottom-up, joining neighbours: faster to build, slower to traverse.
        "fast" Fast,
        /// As by default, but space is split where halves of a set would overlap: slower to build, faster to traverse, with
        /// somewhat more memory.
        "high" High,
    }
}

/// Boxes with classes.
struct Classed<'b, F> {
    bounds: &'b [Aabb],
    class: F,
}

impl<F: Fn(u32) -> u8 + Sync> Shapes for Classed<'_, F> {
    fn count(&self) -> usize {
        self.bounds.len()
    }

    fn bounds(&self, id: u32) -> Aabb {
        self.bounds[id as usize]
    }

    fn class(&self, id: u32) -> u8 {
        (self.class)(id)
    }
}

impl Bvh8 {
    /// Builds the hierarchy over boxes `0..n`, n at most [`Bvh8::MAX_PRIMITIVES`]; `class` returns the class of each.
    pub fn build(bounds: &[Aabb], class: impl Fn(u32) -> u8 + Sync) -> Self {
        Self::build_with(bounds, class, &Bvh8Parameters::DEFAULT)
    }

    /// The same with parameters.
    pub fn build_with(
        bounds: &[Aabb],
        class: impl Fn(u32) -> u8 + Sync,
        parameters: &Bvh8Parameters,
    ) -> Self {
        Self::build_from(&Classed { bounds, class }, parameters)
    }

    /// Builds the hierarchy over primitives `0..n`, n at most [`Bvh8::MAX_PRIMITIVES`].
    pub(crate) fn build_from(shapes: &dyn Shapes, parameters: &Bvh8Parameters) -> Self {
        let primitive = |id| (shapes.bounds(id), shapes.class(id) & 3);
        let (mut refs, mut apart) = gather(shapes.count(), primitive);
        take_out_far(&mut refs, &mut apart);
        let bvh = Self {
            tree: (!refs.is_empty()).then(|| match parameters.build {
                Build::Default => Tree::build(presplit(shapes, refs, PRESPLIT)),
                Build::Fast => fast::build(refs),
                Build::High => high::build(shapes, refs),
            }),
            apart: List::of(apart),
            simd: parameters
                .simd
                .and_then(Simd::of)
                .unwrap_or_else(Simd::detect),
        };
        debug_assert_eq!(bvh.validate(&all_bounds(shapes)), Ok(()));
        if parameters.compact {
            return bvh.compacted();
        }
        bvh
    }
}

impl Tree {
    /// Builds the tree top-down.
    pub(super) fn build(mut refs: Vec<Ref>) -> Self {
        let mut spare = refs.clone();
        Self::grow(Set::all(&mut refs, &mut spare))
    }
}

impl Subtree for Set<'_> {
    type Scratch = Bins;

    fn bounds(&self) -> &Box32 {
        &self.extent.bounds
    }

    fn count(&self) -> usize {
        self.refs.len()
    }

    fn split(self, leaf: &LeafModel, bins: &mut Bins) -> Result<[Self; 2], Self> {
        self.split(leaf, bins)
    }

    fn class(&self) -> u8 {
        self.extent.lowest_class()
    }

    fn ids(&self, into: &mut Vec<u32>) {
        into.extend(self.refs.iter().map(Ref::id));
    }
}
