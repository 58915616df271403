//! Intersections of convex solids and quadrics and the rays of a packet: four rays side by side, as [`one_span`](super::one_span) does it with one.
//!
//! The kernel answers only where it is certain. Where crossings could coincide, or where a ray is past the beginning of a span with holes, the search
//! with one ray decides.

use super::compiled::Csg;
use super::convex::Convex;
use super::fusing::FourFusing;
use super::states::MOST;
use crate::PrimHit;
use crate::blocks::LANES;
use crate::blocks::convex::{FourLines, FourRays, FourSpans};
use crate::primitives::convex::Span;
use arrayvec::ArrayVec;
use strahl_math::Interval;
use strahl_simd::{Isa, select};

impl Csg {
    /// Whether lines find their spans in the tree four at a time.
    pub(crate) fn has_four_spans(&self) -> bool {
        self.convex().is_some()
    }

    /// The first hit in a range, given the span of a ray that does not start on the tree. `ends` has the numbers of the leaves whose surfaces are
    /// at both ends; the second is unknown if `only_enter`. `None` if the search with one ray has to decide.
    #[inline]
    pub(crate) fn closest_end(
        &self,
        span: &Span,
        ends: [u32; 2],
        range: Interval,
        only_enter: bool,
    ) -> Option<Option<PrimHit>> {
        for (end, number) in [span.enter, span.exit].into_iter().zip(ends) {
            let leaf = self.leaf(number)?;
            if leaf.visible && range.accepts(end.t) && end.t.is_finite() {
                let mut hit = PrimHit::simple(end.t, end.facet);
                hit.surface.element = leaf.first_element;
                return Some(Some(hit));
            }
            if only_enter {
                // What comes behind is unknown: it does not matter if it is behind the range, too.
                return (end.t > range.max).then_some(None);
            }
        }
        Some(None)
    }
}

impl FourLines for Csg {
    /// Nothing is known of trees that are no small intersections of convex solids.
    #[inline(always)]
    fn spans<I: Isa>(&self, isa: I, rays: &FourRays<I>) -> FourSpans {
        let Some(convex) = self.convex() else {
            return FourSpans::default();
        };
        let fusing = FourFusing::new(isa, rays);
        if convex.any {
            return self.first_of_union(isa, rays, convex, &fusing);
        }
        let mut ends = Ends::new(isa);
        let mut holes = Holes::new();
        for (n, number) in convex.leaves.iter().enumerate() {
            if n == convex.positive {
                ends.close(isa, &fusing);
            }
            if ends.decided == 0b1111 {
                return ends.spans(isa);
            }
            let Some(leaf) = self.leaf(*number) else {
                return FourSpans::default();
            };
            let spans = leaf.four_spans(isa, rays);
            if n < convex.positive {
                ends.cut(isa, &spans, *number);
            } else if ends.meet_hole(&spans) != 0 {
                holes.push((spans, *number));
            }
        }
        if convex.leaves.len() == convex.positive {
            ends.close(isa, &fusing);
        } else if !holes.is_empty() {
            ends.drill(isa, &fusing, &holes);
        }
        ends.spans(isa)
    }
}

impl Csg {
    /// Where lines enter the first of the solids of a union: nothing is known about what comes behind.
    #[inline(always)]
    fn first_of_union<I: Isa>(
        &self,
        isa: I,
        rays: &FourRays<I>,
        convex: &Convex,
        fusing: &FourFusing<I>,
    ) -> FourSpans {
        let nowhere = isa.splat(f64::INFINITY);
        let mut enter = Nearest::new(isa, f64::INFINITY);
        let (mut first_exit, mut known, mut met) = (nowhere, 0b1111, 0);
        for number in &convex.leaves {
            let Some(leaf) = self.leaf(*number) else {
                return FourSpans::default();
            };
            let spans = leaf.four_spans(isa, rays);
            known &= spans.known;
            if known == 0 {
                return FourSpans::default();
            }
            let crossed = spans.met & known;
            if crossed == 0 {
                continue;
            }
            met |= crossed;
            let t = select(isa, crossed, isa.load(&spans.enter), nowhere);
            enter.note(isa.lt(t, enter.t), *number, &spans.enter_facet);
            enter.next = isa.min(enter.next, isa.choose_le(enter.t, t, t, enter.t));
            enter.t = isa.choose_le(enter.t, t, enter.t, t);
            let t = select(isa, crossed, isa.load(&spans.exit), nowhere);
            first_exit = isa.min(first_exit, t);
        }
        let next = isa.min(enter.next, first_exit);
        // A line that begins inside enters nothing first.
        let clear =
            isa.lt(isa.splat(f64::NEG_INFINITY), enter.t) & fusing.apart(isa, enter.t, next);
        FourSpans {
            known: known & !met,
            only_enter: known & met & clear,
            met,
            enter: isa.store(enter.t),
            exit: [f64::INFINITY; LANES],
            enter_facet: enter.facet,
            exit_facet: [0; LANES],
            enter_leaf: enter.leaf,
            exit_leaf: [0; LANES],
        }
    }
}

/// What complements drill away, and the numbers of their leaves.
type Holes = ArrayVec<(FourSpans, u32), MOST>;

/// The last of some beginnings or the first of some ends, and the next one.
struct Nearest<I: Isa> {
    t: I::F64x4,
    next: I::F64x4,
    leaf: [u32; LANES],
    facet: [u32; LANES],
}

impl<I: Isa> Nearest<I> {
    #[inline(always)]
    fn new(isa: I, nowhere: f64) -> Self {
        Self {
            t: isa.splat(nowhere),
            next: isa.splat(nowhere),
            leaf: [0; LANES],
            facet: [0; LANES],
        }
    }

    #[inline(always)]
    fn note(&mut self, nearer: u32, leaf: u32, facets: &[u32; LANES]) {
        for (lane, facet) in facets.iter().enumerate() {
            if nearer >> lane & 1 == 1 {
                (self.leaf[lane], self.facet[lane]) = (leaf, *facet);
            }
        }
    }
}

/// The ends of four spans, while the operands cut them.
struct Ends<I: Isa> {
    enter: Nearest<I>,
    exit: Nearest<I>,
    /// The lanes that miss an operand.
    missed: u32,
    /// The lanes that miss one, or about which something is unknown.
    decided: u32,
    /// The lanes whose ends are known.
    enter_known: u32,
    exit_known: u32,
}

impl<I: Isa> Ends<I> {
    #[inline(always)]
    fn new(isa: I) -> Self {
        Self {
            enter: Nearest::new(isa, f64::NEG_INFINITY),
            exit: Nearest::new(isa, f64::INFINITY),
            missed: 0,
            decided: 0,
            enter_known: 0b1111,
            exit_known: 0b1111,
        }
    }

    /// Cuts with the spans of an operand.
    #[inline(always)]
    fn cut(&mut self, isa: I, spans: &FourSpans, leaf: u32) {
        self.missed |= spans.known & !spans.met;
        (self.enter_known, self.exit_known) = (
            self.enter_known & spans.known,
            self.exit_known & spans.known,
        );
        self.decided = self.missed | !self.enter_known & 0b1111;
        let (t, enter) = (isa.load(&spans.enter), &mut self.enter);
        enter.note(isa.lt(enter.t, t), leaf, &spans.enter_facet);
        enter.next = isa.max(enter.next, isa.choose_le(enter.t, t, enter.t, t));
        enter.t = isa.choose_le(t, enter.t, enter.t, t);
        let (t, exit) = (isa.load(&spans.exit), &mut self.exit);
        exit.note(isa.lt(t, exit.t), leaf, &spans.exit_facet);
        exit.next = isa.min(exit.next, isa.choose_le(exit.t, t, t, exit.t));
        exit.t = isa.choose_le(exit.t, t, exit.t, t);
    }

    /// Decides about spans that have been cut by all operands but complements.
    #[inline(always)]
    fn close(&mut self, isa: I, fusing: &FourFusing<I>) {
        let (enter, exit) = (self.enter.t, self.exit.t);
        let gap = fusing.gap(isa, enter, exit);
        let known = self.enter_known;
        self.missed |= known & isa.lt(isa.add(gap, gap), isa.sub(enter, exit));
        let clear = known & fusing.apart(isa, enter, exit);
        // A line without an end was not cut.
        let infinite = isa.splat(f64::INFINITY);
        let cut = isa.lt(isa.splat(f64::NEG_INFINITY), enter) | isa.lt(exit, infinite);
        self.enter_known = clear & cut & fusing.apart(isa, self.enter.next, enter);
        self.exit_known = clear & cut & fusing.apart(isa, exit, self.exit.next);
        self.decided = self.missed | !self.enter_known & 0b1111;
    }

    /// Takes note of the lanes in which nothing is known about the solid of a complement, and returns the undecided ones that meet it.
    #[inline(always)]
    fn meet_hole(&mut self, hole: &FourSpans) -> u32 {
        (self.enter_known, self.exit_known) =
            (self.enter_known & hole.known, self.exit_known & hole.known);
        self.decided |= !hole.known & 0b1111;
        hole.met & !self.decided
    }

    /// Drills holes: a span that begins in one begins where the hole ends.
    #[inline(always)]
    fn drill(&mut self, isa: I, fusing: &FourFusing<I>, holes: &Holes) {
        let mut drilled = 0;
        for _ in holes {
            let mut moved = 0;
            for (hole, leaf) in holes {
                let (begin, end) = (isa.load(&hole.enter), isa.load(&hole.exit));
                let enter = self.enter.t;
                let covers = hole.met
                    & !self.decided
                    & fusing.apart(isa, begin, enter)
                    & fusing.apart(isa, enter, end);
                if covers != 0 {
                    self.enter.t = select(isa, covers, end, enter);
                    self.enter.note(covers, *leaf, &hole.exit_facet);
                    moved |= covers;
                }
            }
            drilled |= moved;
            if moved == 0 {
                break;
            }
        }
        let (enter, exit) = (self.enter.t, self.exit.t);
        if drilled != 0 {
            let gap = fusing.gap(isa, enter, exit);
            let behind = isa.lt(isa.add(gap, gap), isa.sub(enter, exit));
            let endless = isa.le(isa.splat(f64::INFINITY), enter);
            self.missed |= drilled & (behind | endless);
            self.enter_known &= !drilled | fusing.apart(isa, enter, exit);
        }
        // Whatever else is drilled away begins behind the beginning, or ends in front of it.
        let last = isa.add(exit, isa.mul(isa.splat(4.0), fusing.margin(isa, exit)));
        for (hole, leaf) in holes {
            let (begin, end) = (isa.load(&hole.enter), isa.load(&hole.exit));
            let mut ended = isa.lt(fusing.gap(isa, end, enter), isa.sub(enter, end));
            for lane in 0..LANES {
                let own = drilled >> lane & 1 == 1 && self.enter.leaf[lane] == *leaf;
                ended |= u32::from(own) << lane;
            }
            let later = isa.lt(fusing.gap(isa, enter, begin), isa.sub(begin, enter));
            self.enter_known &= !hole.met | ended | later;
            self.exit_known &= !hole.met | ended | isa.lt(last, begin);
        }
    }

    #[inline(always)]
    fn spans(&self, isa: I) -> FourSpans {
        let met = !self.missed & 0b1111;
        let (enter, exit) = (self.enter_known & met, self.exit_known & met);
        FourSpans {
            known: self.missed | enter & exit,
            only_enter: enter & !exit,
            met,
            enter: isa.store(self.enter.t),
            exit: isa.store(self.exit.t),
            enter_facet: self.enter.facet,
            exit_facet: self.exit.facet,
            enter_leaf: self.enter.leaf,
            exit_leaf: self.exit.leaf,
        }
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::super::CsgNode;
    use super::*;
    use crate::blocks::{PacketRays, PacketSearch, PacketSpans};
    use crate::conformance::Random;
    use crate::{Cone, Cuboid, Cylinder, Plane, Primitive, Quadric, Scratch, Shape, Sphere};
    use std::sync::Arc;
    use strahl_accel::PACKET;
    use strahl_math::{DVec3, Ray, Transform};
    use strahl_simd::Simd;

    /// A convex solid around a place; on a lattice faces coincide.
    pub(in super::super) fn operand(random: &mut Random, lattice: bool, tag: u32) -> CsgNode {
        let mut number = |least: f64, most: f64| match lattice {
            false => random.between(least, most),
            true => (random.between(least, most) * 2.0).round() / 2.0,
        };
        let center = DVec3::new(number(-0.6, 0.6), number(-0.6, 0.6), number(-0.6, 0.6));
        let size = number(0.5, 1.4);
        let top = center + DVec3::new(0.0, number(0.5, 1.5), 0.0);
        let shape: Shape = match (random.below(7), lattice) {
            (0, _) => Cuboid::new(center - DVec3::splat(size), center + DVec3::splat(size)).into(),
            (1, _) => Cylinder::new(center, top, size).into(),
            (2, _) => Cone::new(center, size, top, 0.5).into(),
            (3, true) => Plane::new(center, DVec3::Y).into(),
            (3, false) => Plane::new(center, random.direction()).into(),
            (4, _) => Quadric::new([1.0, 2.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -size]).into(),
            (5, _) => Quadric::new([1.0, -size, 1.0, 0.2, 0.0, 0.0, 0.0, 0.0, 0.0, -size]).into(),
            _ => Sphere::new(center, size).into(),
        };
        let node = CsgNode::leaf(shape, tag);
        if lattice || random.below(3) > 0 {
            return node;
        }
        let stretch = Transform::try_scale(DVec3::new(1.0, 0.7, 1.2)).expect("regular");
        node.transformed(Transform::rotate(random.direction(), random.unit() * 6.0).then(&stretch))
    }

    /// Rays at trees of such operands, and some that are no lines.
    pub(in super::super) fn rays(random: &mut Random, lattice: bool) -> Vec<Ray> {
        (0..PACKET)
            .map(|k| {
                let origin = random.cube() * 4.0;
                let mut direction = random.cube() * 0.9 - origin;
                match k {
                    3 => direction.x = 0.0,
                    5 if lattice => direction = DVec3::Y,
                    11 => direction = DVec3::ZERO,
                    13 => direction.z = f64::NAN,
                    _ => {}
                }
                Ray::new(origin, direction)
            })
            .collect()
    }

    fn tree(random: &mut Random, lattice: bool) -> Shape {
        let count = 2 + random.below(3) as u32;
        let mut operands: Vec<CsgNode> = (0..count)
            .map(|tag| operand(random, lattice, tag))
            .collect();
        let node = match random.below(6) {
            0 => CsgNode::intersection(operands),
            4 => CsgNode::merge(operands),
            5 => CsgNode::union(operands),
            1 => {
                let first = operands.remove(0);
                CsgNode::clip(first, operands)
            }
            _ => CsgNode::difference(operands),
        };
        Arc::new(Csg::try_new(node).expect("valid")).into()
    }

    #[test]
    fn packets_hit_what_single_rays_hit() {
        let mut random = Random::new(7);
        let levels = Simd::available();
        let (mut asked, mut known, mut met, mut sure) = (0, 0, 0, 0);
        for round in 0..6000 {
            let lattice = round % 4 == 0;
            let shape = tree(&mut random, lattice);
            if !PacketSpans::know(&shape) {
                continue;
            }
            let rays = rays(&mut random, lattice);
            let packet = PacketRays::new(&rays);
            let turn = Transform::rotate(DVec3::new(1.0, 2.0, 0.5), random.unit());
            let map = (round % 3 == 1).then_some(&turn);
            let range = match round % 5 {
                0 => Interval::LINE,
                1 => Interval::new(0.9, 1.1),
                _ => Interval::FORWARD,
            };
            for simd in &levels {
                let mut spans = PacketSpans::default();
                let search = PacketSearch {
                    rays: &packet,
                    map,
                    lanes: 0xffff,
                    min: range.min,
                    t_max: &[range.max; PACKET],
                };
                spans.find_at(*simd, &shape, &search);
                for (lane, ray) in rays.iter().enumerate() {
                    let inner = map.map_or(*ray, |map| map.ray_to_object(ray));
                    let alone = shape.closest_hit(&inner, range, None, &mut Scratch::default());
                    asked += 1;
                    met += u32::from(alone.is_some());
                    if let Some(together) = spans.closest(&shape, lane, range) {
                        assert_eq!(together, alone, "{shape:?} {ray:?} {range:?}");
                        known += 1;
                        sure += u32::from(alone.is_some());
                    }
                }
            }
        }
        assert!(
            known * 3 > asked * 2 && sure * 2 > met,
            "{asked} {known} {met} {sure}"
        );
    }
}
