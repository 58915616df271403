//! Convex solids and the rays of a packet: four rays side by side.
//!
//! Where a kernel knows the answer, it has made the operations of the solid's own test in the same order, so the results have the same bits.

use super::LANES;
use crate::primitives::convex::{End, Span};
use crate::swept::{FourFirstHits, FourHits};
use crate::{PrimHit, Shape};
use strahl_accel::PACKET;
use strahl_math::{Aabb, DMat3, DVec3, Interval, Ray, Transform};
use strahl_simd::{Isa, Simd, dispatch};

/// Groups of four rays in a packet.
pub(crate) const GROUPS: usize = PACKET / LANES;

/// The rays of a packet, coordinate by coordinate; by default zeros.
#[derive(Clone, Copy, Debug, Default)]
pub struct PacketRays {
    origin: [[[f64; LANES]; 3]; GROUPS],
    direction: [[[f64; LANES]; 3]; GROUPS],
}

impl PacketRays {
    /// At most [`PACKET`] rays; there are zeros in the lanes without one.
    pub fn new(rays: &[Ray]) -> Self {
        let mut all = Self::default();
        all.set(rays);
        all
    }

    /// The same in place.
    pub fn set(&mut self, rays: &[Ray]) {
        if rays.len() < PACKET {
            *self = Self::default();
        }
        for (number, ray) in rays.iter().enumerate().take(PACKET) {
            let (group, lane) = (number / LANES, number % LANES);
            let (o, d) = (ray.origin.to_array(), ray.direction.to_array());
            for axis in 0..3 {
                self.origin[group][axis][lane] = o[axis];
                self.direction[group][axis][lane] = d[axis];
            }
        }
    }

    /// Those of the rays `lanes`, as bits, that may meet a box in the space to which a map leads, at parameters of at least `min` and at most
    /// `t_max`: four at a time, each as [`Aabb::may_be_met`] says.
    pub fn may_meet(
        &self,
        bounds: &Aabb,
        map: Option<&Transform>,
        lanes: u32,
        min: f64,
        t_max: &[f64; PACKET],
    ) -> u32 {
        dispatch!(Simd::best(), isa => self.may_meet_with(isa, bounds, map, lanes, min, t_max))
    }

    #[inline(always)]
    fn may_meet_with<I: Isa>(
        &self,
        isa: I,
        bounds: &Aabb,
        map: Option<&Transform>,
        lanes: u32,
        min: f64,
        t_max: &[f64; PACKET],
    ) -> u32 {
        let mut met = 0;
        let one = isa.splat(1.0);
        let (of_size, of_origin) = (bounds.margin(DVec3::ZERO), Aabb::MARGIN_OF_ORIGIN);
        for (group, t_max) in t_max.as_chunks::<LANES>().0.iter().enumerate() {
            let wanted = lanes >> (group * LANES) & 0b1111;
            if wanted == 0 {
                continue;
            }
            let rays = self.four(isa, group, map);
            let (mut near, mut far) = (isa.splat(min), isa.load(t_max));
            for axis in 0..3 {
                let (o, inverse) = (rays.origin[axis], isa.div(one, rays.direction[axis]));
                let margin = isa.mul(isa.abs(o), isa.splat(of_origin));
                let margin = isa.add(isa.splat(of_size[axis]), margin);
                let low = isa.sub(isa.sub(isa.splat(bounds.min[axis]), margin), o);
                let high = isa.sub(isa.add(isa.splat(bounds.max[axis]), margin), o);
                let (a, b) = (isa.mul(low, inverse), isa.mul(high, inverse));
                near = isa.max(isa.min(a, b), near);
                far = isa.min(isa.max(a, b), far);
            }
            met |= (isa.le(near, far) & wanted) << (group * LANES);
        }
        met
    }

    /// One group, in the space to which a map leads.
    #[inline(always)]
    fn four<I: Isa>(&self, isa: I, group: usize, map: Option<&Transform>) -> FourRays<I> {
        let origin = load(isa, &self.origin[group]);
        let direction = load(isa, &self.direction[group]);
        let rays = FourRays { origin, direction };
        match map {
            None => rays,
            Some(map) => rays.to_object(isa, map),
        }
    }
}

#[inline(always)]
pub(crate) fn load<I: Isa>(isa: I, [x, y, z]: &[[f64; LANES]; 3]) -> [I::F64x4; 3] {
    [isa.load(x), isa.load(y), isa.load(z)]
}

#[inline(always)]
pub(crate) fn sub<I: Isa>(isa: I, a: [I::F64x4; 3], b: [I::F64x4; 3]) -> [I::F64x4; 3] {
    [
        isa.sub(a[0], b[0]),
        isa.sub(a[1], b[1]),
        isa.sub(a[2], b[2]),
    ]
}

/// Vectors times a number each.
#[inline(always)]
pub(crate) fn scaled<I: Isa>(isa: I, v: [I::F64x4; 3], by: I::F64x4) -> [I::F64x4; 3] {
    [isa.mul(v[0], by), isa.mul(v[1], by), isa.mul(v[2], by)]
}

/// A matrix times vectors, with the products added in the order of the scalar code.
#[inline(always)]
pub(crate) fn mapped<I: Isa>(isa: I, m: DMat3, [x, y, z]: [I::F64x4; 3]) -> [I::F64x4; 3] {
    let (a, b, c) = (m.x_axis, m.y_axis, m.z_axis);
    [
        row(isa, [a.x, b.x, c.x], x, y, z),
        row(isa, [a.y, b.y, c.y], x, y, z),
        row(isa, [a.z, b.z, c.z], x, y, z),
    ]
}

#[inline(always)]
fn row<I: Isa>(isa: I, [a, b, c]: [f64; 3], x: I::F64x4, y: I::F64x4, z: I::F64x4) -> I::F64x4 {
    let xy = isa.add(isa.mul(isa.splat(a), x), isa.mul(isa.splat(b), y));
    isa.add(xy, isa.mul(isa.splat(c), z))
}

/// Four rays, coordinate by coordinate.
pub(crate) struct FourRays<I: Isa> {
    pub(crate) origin: [I::F64x4; 3],
    pub(crate) direction: [I::F64x4; 3],
}

impl<I: Isa> FourRays<I> {
    /// Four rays, in the space to which a map leads.
    #[inline(always)]
    pub(crate) fn of(isa: I, rays: [&Ray; LANES], map: Option<&Transform>) -> Self {
        let (mut origin, mut direction) = ([[0.0; LANES]; 3], [[0.0; LANES]; 3]);
        for (lane, ray) in rays.into_iter().enumerate() {
            let (o, d) = (ray.origin.to_array(), ray.direction.to_array());
            for axis in 0..3 {
                origin[axis][lane] = o[axis];
                direction[axis][lane] = d[axis];
            }
        }
        let rays = Self {
            origin: load(isa, &origin),
            direction: load(isa, &direction),
        };
        match map {
            None => rays,
            Some(map) => rays.to_object(isa, map),
        }
    }

    /// One by one.
    #[inline(always)]
    pub(crate) fn rays(&self, isa: I) -> [Ray; LANES] {
        let mut rays = [Ray::new(DVec3::ZERO, DVec3::ZERO); LANES];
        for axis in 0..3 {
            let (o, d) = (
                isa.store(self.origin[axis]),
                isa.store(self.direction[axis]),
            );
            for lane in 0..LANES {
                rays[lane].origin[axis] = o[lane];
                rays[lane].direction[axis] = d[lane];
            }
        }
        rays
    }

    /// In the space to which a map leads, as [`Transform::ray_to_object`].
    #[inline(always)]
    pub(crate) fn to_object(&self, isa: I, map: &Transform) -> Self {
        let DVec3 { x, y, z } = map.translation();
        let shift = [isa.splat(x), isa.splat(y), isa.splat(z)];
        let linear = map.inverse_linear();
        Self {
            origin: mapped(isa, linear, sub(isa, self.origin, shift)),
            direction: mapped(isa, linear, self.direction),
        }
    }
}

/// Where four lines are inside of a convex solid.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct FourSpans {
    /// The lanes whose span is known, as bits; the solid's own test decides about the others.
    pub(crate) known: u32,
    /// Others of which the beginning of the first span is known.
    pub(crate) only_enter: u32,
    /// Those of both that have a span.
    pub(crate) met: u32,
    pub(crate) enter: [f64; LANES],
    pub(crate) exit: [f64; LANES],
    pub(crate) enter_facet: [u32; LANES],
    pub(crate) exit_facet: [u32; LANES],
    /// The numbers of the leaves whose surfaces are at the ends, in a CSG tree.
    pub(crate) enter_leaf: [u32; LANES],
    pub(crate) exit_leaf: [u32; LANES],
}

impl FourSpans {
    /// The span of a lane that has one.
    #[inline(always)]
    pub(crate) fn span(&self, lane: usize) -> Span {
        Span {
            enter: End {
                t: self.enter[lane],
                facet: self.enter_facet[lane],
            },
            exit: End {
                t: self.exit[lane],
                facet: self.exit_facet[lane],
            },
        }
    }
}

/// A convex solid that finds the spans of four lines at once.
pub(crate) trait FourLines {
    /// The spans of lines that don't start on the solid.
    fn spans<I: Isa>(&self, isa: I, rays: &FourRays<I>) -> FourSpans;

    /// The first hit in a range, given the span of a ray that does not start on the solid.
    fn closest_within(&self, span: &Span, range: Interval) -> Option<PrimHit> {
        span.closest(range, None)
    }
}

/// A search for the rays of a packet that don't start on the shape.
#[derive(Clone, Copy, Debug)]
pub struct PacketSearch<'a> {
    /// The rays of the packet.
    pub rays: &'a PacketRays,
    /// The map to the shape's space.
    pub map: Option<&'a Transform>,
    /// The rays that ask, as bits.
    pub lanes: u32,
    /// Where the ranges of all rays begin.
    pub min: f64,
    /// Where that of each ray ends.
    pub t_max: &'a [f64; PACKET],
}

impl PacketSearch<'_> {
    /// The rays of a group that ask.
    #[inline(always)]
    const fn wanted(&self, group: usize) -> u32 {
        self.lanes >> (group * LANES) & 0b1111
    }
}

/// Where the rays of a packet are inside of a convex solid, or where they first meet a swept one.
#[derive(Clone, Copy, Debug, Default)]
pub struct PacketSpans {
    spans: [FourSpans; GROUPS],
    hits: [FourHits; GROUPS],
    /// Where the search for the hits begins.
    min: f64,
}

impl PacketSpans {
    /// Whether there is such a search for a shape: for spheres, boxes, cylinders, cones, quadrics, convex superellipsoids and small intersections of convex solids.
    #[inline]
    pub fn know(shape: &Shape) -> bool {
        match shape {
            Shape::Sphere(_)
            | Shape::Cuboid(_)
            | Shape::Cylinder(_)
            | Shape::Cone(_)
            | Shape::Quadric(_) => true,
            Shape::Superellipsoid(body) => body.is_convex(),
            Shape::Csg(csg) => csg.has_four_spans(),
            _ => false,
        }
    }

    /// Whether there is a search for the first hits with a shape: for those that [`know`](Self::know) names, prisms and letters.
    #[inline]
    pub fn know_first(shape: &Shape) -> bool {
        matches!(shape, Shape::Prism(_) | Shape::Glyph(_)) || Self::know(shape)
    }

    /// Finds the spans, or the first hits in the search's ranges. Of shapes without such a search nothing is known.
    pub fn find(&mut self, shape: &Shape, search: &PacketSearch<'_>) {
        self.find_at(Simd::best(), shape, search);
    }

    #[inline(always)]
    pub(crate) fn find_at(&mut self, simd: Simd, shape: &Shape, search: &PacketSearch<'_>) {
        self.min = search.min;
        match shape {
            Shape::Sphere(solid) => self.find_of(simd, solid, search),
            Shape::Cuboid(solid) => self.find_of(simd, solid, search),
            Shape::Cylinder(solid) => self.find_of(simd, solid.frustum(), search),
            Shape::Cone(solid) => self.find_of(simd, solid.frustum(), search),
            Shape::Quadric(solid) => self.find_of(simd, &**solid, search),
            Shape::Superellipsoid(body) if body.is_convex() => self.find_of(simd, body, search),
            Shape::Csg(tree) => self.find_of(simd, &**tree, search),
            Shape::Prism(solid) => self.find_first(simd, &**solid, search),
            Shape::Glyph(solid) => self.find_first(simd, solid, search),
            _ => self.spans = Default::default(),
        }
    }

    #[inline(always)]
    fn find_of(&mut self, simd: Simd, solid: &impl FourLines, search: &PacketSearch<'_>) {
        dispatch!(simd, isa => {
            for group in 0..GROUPS {
                if search.wanted(group) != 0 {
                    let rays = search.rays.four(isa, group, search.map);
                    self.spans[group] = solid.spans(isa, &rays);
                }
            }
        });
    }

    #[inline(always)]
    fn find_first(&mut self, simd: Simd, solid: &impl FourFirstHits, search: &PacketSearch<'_>) {
        let PacketSearch { min, map, .. } = *search;
        dispatch!(simd, isa => {
            for (group, t_max) in search.t_max.as_chunks::<LANES>().0.iter().enumerate() {
                let wanted = search.wanted(group);
                if wanted != 0 {
                    let (rays, max) = (search.rays.four(isa, group, map), isa.load(t_max));
                    self.hits[group] = solid.first_hits(isa, rays, wanted, min, max);
                }
            }
        });
    }

    /// The first hit of a ray on the shape in a range that begins where the search did and does not reach further, as [`Primitive::closest_hit`](crate::Primitive::closest_hit) finds it; `None` if only that
    /// function knows.
    #[inline]
    pub fn closest(&self, shape: &Shape, lane: usize, range: Interval) -> Option<Option<PrimHit>> {
        let (group, lane) = (lane / LANES % GROUPS, lane % LANES);
        if let Shape::Prism(_) | Shape::Glyph(_) = shape {
            let known = range.min.to_bits() == self.min.to_bits();
            return self.hits[group].closest(lane, range).filter(|_| known);
        }
        let spans = &self.spans[group];
        let only_enter = spans.only_enter >> lane & 1 == 1;
        if spans.known >> lane & 1 == 0 && !only_enter {
            return None;
        }
        if spans.met >> lane & 1 == 0 {
            return Some(None);
        }
        let span = spans.span(lane);
        Some(match shape {
            Shape::Cylinder(solid) => solid.frustum().closest_within(&span, range),
            Shape::Cone(solid) => solid.frustum().closest_within(&span, range),
            Shape::Csg(csg) => {
                let ends = [spans.enter_leaf[lane], spans.exit_leaf[lane]];
                return csg.closest_end(&span, ends, range, only_enter);
            }
            Shape::Superellipsoid(_) => {
                let hit = range.accepts(span.enter.t) && span.enter.t.is_finite();
                // The ray may start inside.
                let unknown = !hit && !(span.enter.t > range.max);
                return (!unknown).then(|| hit.then(|| PrimHit::simple(span.enter.t, 0)));
            }
            _ => span.closest(range, None),
        })
    }

    /// Appends all hits of a ray on the shape in a range, as [`Primitive::all_hits`](crate::Primitive::all_hits) does; false if only that function
    /// knows, after some may have been appended.
    #[inline]
    pub fn all(
        &self,
        shape: &Shape,
        lane: usize,
        mut range: Interval,
        out: &mut Vec<PrimHit>,
    ) -> bool {
        loop {
            match self.closest(shape, lane, range) {
                None => return false,
                Some(None) => return true,
                // The lower end of a range is open.
                Some(Some(hit)) => {
                    range.min = hit.t;
                    out.push(hit);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conformance::Random;
    use crate::{
        Cone, Cuboid, Cylinder, Glyph, OutlineBuilder, Primitive, Prism, PrismSweep, Quadric,
        Scratch, Sphere, Spline, Superellipsoid,
    };
    use std::sync::Arc;
    use strahl_math::DVec2;

    /// Rays at a solid: from everywhere, at its rims, along its axes, and some that are no numbers.
    fn rays(random: &mut Random, center: DVec3) -> Vec<Ray> {
        let mut vector = |size: f64| {
            let mut unit = || 2.0 * random.unit() - 1.0;
            DVec3::new(unit(), unit(), unit()) * size
        };
        (0..PACKET)
            .map(|k| {
                let origin = center + vector(4.0);
                let mut direction = (center + vector(1.2) - origin) * 0.7;
                match k {
                    3 => direction.x = 0.0,
                    7 => direction = DVec3::Y,
                    11 => direction = DVec3::ZERO,
                    13 => direction.z = f64::NAN,
                    _ => {}
                }
                Ray::new(origin, direction)
            })
            .collect()
    }

    /// A quadric of any kind; some of its coefficients are zero.
    fn quadric(random: &mut Random) -> Quadric {
        let mut coefficients = [0.0; 10];
        for coefficient in &mut coefficients {
            *coefficient = match random.below(3) {
                0 => 0.0,
                1 => (4.0 * random.unit()).round() - 2.0,
                _ => 2.0 * random.unit() - 1.0,
            };
        }
        Quadric::new(coefficients)
    }

    #[test]
    fn packets_may_meet_the_boxes_that_single_rays_may_meet() {
        let mut random = Random::new(8);
        let (mut met, mut missed) = (0, 0);
        for round in 0..2000 {
            let center = DVec3::new(random.unit(), random.unit(), random.unit());
            let half = DVec3::new(random.unit(), 0.3 * random.unit(), random.unit());
            let bounds = Aabb::new(center - half, center + half);
            let turned = Transform::rotate(DVec3::new(0.3, 1.0, random.unit()), random.unit());
            let map = (round % 2 == 0).then_some(&turned);
            let all = rays(&mut random, center);
            let t_max = std::array::from_fn(|_| match random.below(3) {
                0 => f64::NEG_INFINITY,
                1 => 2.0 * random.unit(),
                _ => f64::INFINITY,
            });
            let lanes = random.below(1 << PACKET) as u32;
            let coordinates = PacketRays::new(&all);
            let mut expected = 0;
            for (lane, ray) in all.iter().enumerate() {
                let inner = map.map_or(*ray, |map| map.ray_to_object(ray));
                let range = Interval::new(0.1, t_max[lane]);
                expected |= u32::from(bounds.may_be_met(&inner, range)) << lane;
            }
            for simd in Simd::available() {
                let found = dispatch!(simd, isa =>
                    coordinates.may_meet_with(isa, &bounds, map, lanes, 0.1, &t_max));
                assert_eq!(found, expected & lanes, "{round} {simd:?}");
            }
            met += (expected & lanes).count_ones();
            missed += (!expected & lanes).count_ones();
        }
        assert!(met > 1000 && missed > 1000, "{met} {missed}");
    }

    /// Prisms over all kinds of curves, and a letter with a hole.
    fn swept(random: &mut Random, center: DVec3) -> Vec<Shape> {
        let point = |x: f64, y: f64| DVec2::new(x + center.x, y + center.z);
        let closed =
            |list: &[[f64; 2]]| -> Vec<DVec2> { list.iter().map(|&[x, y]| point(x, y)).collect() };
        let mut star: Vec<[f64; 2]> = (0..30)
            .map(|k| {
                let (sin, cos) = (f64::from(k) * 0.21).sin_cos();
                let radius = 0.3 + 0.7 * random.unit();
                [radius * cos, radius * sin]
            })
            .collect();
        star.push(star[0]);
        let clover = [
            [-1.0, 0.5],
            [0.0, -1.0],
            [1.2, 0.1],
            [0.1, 0.3],
            [0.3, 1.1],
            [-1.0, 0.5],
            [0.0, -1.0],
            [1.2, 0.1],
        ];
        let leaf = [
            [0.0, -1.0],
            [1.5, -0.9],
            [1.1, 0.8],
            [0.0, 1.0],
            [0.0, 1.0],
            [-0.2, 0.2],
            [-1.5, -0.2],
            [0.0, -1.0],
        ];
        let heights = [random.unit() - 0.5, 0.5 + random.unit()];
        let mut shapes = vec![];
        for (spline, list) in [
            (Spline::Linear, &star[..]),
            (Spline::Quadratic, &clover[..7]),
            (Spline::Cubic, &clover),
            (Spline::Bezier, &leaf),
        ] {
            for (sweep, open) in [
                (PrismSweep::Linear, false),
                (PrismSweep::Conic, false),
                (PrismSweep::Linear, true),
            ] {
                let prism = Prism::try_new(spline, sweep, heights, &closed(list), open);
                shapes.push(prism.unwrap().into());
            }
        }
        let mut outline = OutlineBuilder::default();
        for size in [1.0, 0.5] {
            outline.move_to(DVec2::new(0.0, -size));
            outline.line_to(DVec2::new(size, -size));
            outline.quadratic_to(DVec2::new(size, size), DVec2::new(0.0, size));
            outline.cubic_to(
                DVec2::new(-size, size),
                DVec2::new(0.0, 0.0),
                DVec2::new(-size, -size),
            );
        }
        let outline = Arc::new(outline.finish().unwrap());
        shapes.push(Glyph::try_new(outline, center, -0.3).unwrap().into());
        shapes
    }

    #[test]
    fn packets_hit_what_single_rays_hit() {
        let mut random = Random::new(5);
        let mut first_hits = (0, 0, 0);
        let (mut known, mut met) = (0, 0);
        for round in 0..4000 {
            let center = DVec3::new(random.unit(), random.unit(), random.unit());
            let top = center + DVec3::new(random.unit() - 0.5, 1.0, random.unit() - 0.5);
            let shapes: [Shape; 11] = [
                Sphere::new(center, 0.6).into(),
                Cuboid::from_corners(center - DVec3::splat(0.5), top).into(),
                Cylinder::new(center - DVec3::Y, top, 0.4).into(),
                Cylinder::open(center - DVec3::Y, top, 0.4).into(),
                Cone::new(center - DVec3::Y, 0.7, top, 0.1).into(),
                Cone::open(center - DVec3::Y, 0.0, top, 0.8).into(),
                quadric(&mut random).into(),
                Superellipsoid::new(0.3, 0.2).into(),
                Superellipsoid::new(1.0, 0.5 + random.unit()).into(),
                Superellipsoid::new(2.0, 1.0).into(),
                Superellipsoid::new(0.01 + random.unit(), 0.01 + random.unit()).into(),
            ];
            let rays = rays(&mut random, center);
            let packet = PacketRays::new(&rays);
            let turn = Transform::rotate(DVec3::new(1.0, 2.0, 0.5), random.unit())
                .then(&Transform::translate(center * 0.2));
            let map = (round % 2 == 1).then_some(&turn);
            let range = match round % 3 {
                0 => Interval::FORWARD,
                1 => Interval::new(0.9, 1.3),
                _ => Interval::LINE,
            };
            let levels = Simd::available();
            let swept = match round % 8 {
                0 | 5 | 7 => swept(&mut random, center),
                _ => vec![],
            };
            for (shape, simd) in shapes
                .iter()
                .chain(&swept)
                .flat_map(|s| levels.iter().map(move |l| (s, l)))
            {
                let mut spans = PacketSpans::default();
                let search = PacketSearch {
                    rays: &packet,
                    map,
                    lanes: 0xffff,
                    min: range.min,
                    t_max: &[range.max; PACKET],
                };
                spans.find_at(*simd, shape, &search);
                for (lane, ray) in rays.iter().enumerate() {
                    let inner = map.map_or(*ray, |map| map.ray_to_object(ray));
                    let alone = shape.closest_hit(&inner, range, None, &mut Scratch::default());
                    let together = spans.closest(shape, lane, range);
                    if matches!(shape, Shape::Prism(_) | Shape::Glyph(_)) {
                        first_hits.0 += 1;
                        first_hits.1 += u32::from(together.is_some());
                        first_hits.2 += u32::from(together.is_some_and(|hit| hit.is_some()));
                    }
                    if let Some(together) = together {
                        assert_eq!(together, alone, "{shape:?} {ray:?} {range:?}");
                        known += 1;
                        met += u32::from(alone.is_some());
                    }
                }
            }
        }
        assert!(known > 220_000 && met > 60_000, "{known} {met}");
        let (asked, known, met) = first_hits;
        // Nothing is known of a third of the ranges, which begin at negative parameters.
        assert!(
            2 * known > asked && 8 * met > asked,
            "{asked} {known} {met}"
        );
    }
}
