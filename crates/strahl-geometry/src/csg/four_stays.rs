//! Where four lines are inside of a leaf.

use super::leaf::Leaf;
use crate::Shape;
use crate::blocks::convex::{FourLines, FourRays, FourSpans};
use crate::primitives::convex::Stay;
use strahl_simd::Isa;

/// What is known of four lines and a leaf's shape.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct FourStays {
    pub(super) spans: FourSpans,
    /// The lanes, as bits, that are outside on their span and inside everywhere else.
    pub(super) outside: u32,
}

impl FourStays {
    /// Makes them lines that miss the shape.
    #[inline(always)]
    pub(super) fn set_missed(&mut self) {
        (self.spans.known, self.spans.met, self.outside) = (0b1111, 0, 0);
    }

    /// The same if all but these lanes miss the shape's box.
    #[inline(always)]
    pub(super) fn of(mut self, lanes: u32) -> Self {
        self.spans.known |= !lanes & 0b1111;
        self.spans.met &= lanes;
        self.outside &= lanes;
        self
    }

    /// Where a line is inside of the shape, if that is known.
    #[inline(always)]
    pub(super) fn stay(&self, lane: usize) -> Option<Stay> {
        let has = |lanes: u32| lanes >> lane & 1 == 1;
        let spans = &self.spans;
        has(spans.known).then(|| Stay {
            span: has(spans.met).then(|| spans.span(lane)),
            outside: has(self.outside),
        })
    }
}

impl Leaf {
    /// Where four lines that don't start on the shape are inside of it, if that is one span.
    #[inline(always)]
    pub(super) fn four_spans<I: Isa>(&self, isa: I, rays: &FourRays<I>) -> FourSpans {
        let FourStays { mut spans, outside } = self.four_stays(isa, rays);
        spans.known &= !outside;
        spans.met &= !outside;
        spans
    }

    /// Where four lines that don't start on the shape are inside of it.
    #[inline(always)]
    pub(super) fn four_stays<I: Isa>(&self, isa: I, rays: &FourRays<I>) -> FourStays {
        let placed;
        let rays = match self.map() {
            None => rays,
            Some(map) => {
                placed = rays.to_object(isa, map);
                &placed
            }
        };
        let spans = match &self.shape {
            Shape::Sphere(solid) => solid.spans(isa, rays),
            Shape::Cuboid(solid) => solid.spans(isa, rays),
            Shape::Cylinder(solid) => solid.frustum().spans(isa, rays),
            Shape::Cone(solid) => solid.frustum().spans(isa, rays),
            Shape::Plane(solid) => solid.spans(isa, rays),
            Shape::Quadric(solid) => {
                let (spans, inside_between) = solid.four_roots(isa, rays);
                let outside = !inside_between & 0b1111;
                return FourStays { spans, outside };
            }
            _ => FourSpans::default(),
        };
        FourStays { spans, outside: 0 }
    }
}
