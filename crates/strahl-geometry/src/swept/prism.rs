use super::curve::Spline;
use super::extrusion::Extrusion;
use super::four_rays::{FourFirstHits, FourHits};
use super::outline::{Outline, OutlineBuilder};
use super::spans::WholeLine;
use crate::blocks::convex::FourRays;
use crate::primitive::hits_of_solid;
use crate::{
    Crossings, GeometryError, PrimHit, Primitive, Scratch, Solid, SurfaceId, SurfacePoint,
};
use strahl_math::{Aabb, DVec2, DVec3, Interval, Ray};
use strahl_simd::Isa;

/// A point as near as this to the first one of a prism's curve or a polygon's ring, along each axis, closes it, as in POV-Ray (measured).
pub const CLOSING_DISTANCE: f64 = 1e-10;

/// How the outline of a [`Prism`] changes with the height.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PrismSweep {
    /// Not at all: the walls are vertical.
    Linear,
    /// It is scaled by the height: original size at height 1, a point at height 0, mirrored below.
    Conic,
}

/// A plane figure in the x-z plane swept along the y axis, like POV-Ray's `prism`.
///
/// The figure consists of one or more closed curves; areas surrounded by an even number of them are outside. Facets: 0 the cap
/// at the smaller height, 1 the cap at the greater one, then the walls of the figure's pieces in their order. There are no
/// texture coordinates.
///
/// The caps of an *open* prism are invisible, but it is still a solid that ends there.
#[derive(Clone, Debug, PartialEq)]
pub struct Prism {
    outline: Outline,
    sweep: PrismSweep,
    low: f64,
    high: f64,
    open: bool,
}

impl Prism {
    /// A prism between two heights, in either order, over the curves that the points (x and z) describe.
    ///
    /// A curve ends where its first point is repeated ([`CLOSING_DISTANCE`] says how exactly), and the next point begins another one. Splines that need points beside
    /// the curve have them before the first and (cubic ones) behind the last point of each curve; of a Bézier curve every fourth
    /// point may be the last. A curve that does not come back is closed by a line ([`Outline::gaps`] tells).
    ///
    /// # Errors
    /// A number is not finite, the heights are equal, there are too few points, or nothing but a point is described.
    pub fn try_new(
        spline: Spline,
        sweep: PrismSweep,
        heights: [f64; 2],
        points: &[DVec2],
        open: bool,
    ) -> Result<Self, GeometryError> {
        let mut builder = OutlineBuilder::default();
        let mut rest = points;
        while !rest.is_empty() {
            let (before, after) = spline.surplus();
            let end = curve_end(spline, rest);
            let length = end.map_or(rest.len(), |end| (end + 1 + after).min(rest.len()));
            let (curve, others) = rest.split_at(length);
            rest = others;
            let mut curve = curve.to_vec();
            if let Some(end) = end {
                curve[end] = curve[before];
            }
            let pieces = spline.pieces(&curve);
            if let Some(first) = pieces.first() {
                builder.move_to(first.start());
                for piece in pieces {
                    builder.piece(piece);
                }
            }
        }
        Self::from_outline(builder.finish()?, sweep, heights, open)
    }

    /// A prism over an outline: its `y` becomes `z`.
    ///
    /// # Errors
    /// A height is not finite, or the heights are equal.
    pub fn from_outline(
        outline: Outline,
        sweep: PrismSweep,
        [a, b]: [f64; 2],
        open: bool,
    ) -> Result<Self, GeometryError> {
        let (low, high) = if a <= b { (a, b) } else { (b, a) };
        let prism = Self {
            outline,
            sweep,
            low,
            high,
            open,
        };
        prism.validate().map(|()| prism)
    }

    /// The figure in the x-z plane.
    pub fn outline(&self) -> &Outline {
        &self.outline
    }

    fn extrusion(&self) -> Extrusion<'_> {
        Extrusion {
            outline: &self.outline,
            conic: self.sweep == PrismSweep::Conic,
            low: self.low,
            high: self.high,
            capped: !self.open,
        }
    }
}

/// See [`Extrusion::first_hits`].
impl FourFirstHits for Prism {
    #[inline(always)]
    fn first_hits<I: Isa>(
        &self,
        isa: I,
        FourRays { origin, direction }: FourRays<I>,
        wanted: u32,
        min: f64,
        max: I::F64x4,
    ) -> FourHits {
        let [[ox, oy, oz], [dx, dy, dz]] = [origin, direction];
        let turned = FourRays {
            origin: [ox, oz, oy],
            direction: [dx, dz, dy],
        };
        self.extrusion().first_hits(isa, turned, wanted, min, max)
    }
}

/// The number of the point in which the first curve comes back to its first point.
fn curve_end(spline: Spline, points: &[DVec2]) -> Option<usize> {
    let (before, _) = spline.surplus();
    let step = if spline == Spline::Bezier { 4 } else { 1 };
    let first = *points.get(before)?;
    // The last point of a Bézier piece is the fourth of four.
    let mut ends = (before + step.max(2) - 1..points.len()).step_by(step);
    ends.find(|&i| (points[i] - first).abs().max_element() <= CLOSING_DISTANCE)
}

/// From the space of prisms, whose axis is y, to that of extrusions, whose axis is z, and back.
fn turned(v: DVec3) -> DVec3 {
    DVec3::new(v.x, v.z, v.y)
}

fn turned_ray(ray: &Ray) -> Ray {
    Ray::new(turned(ray.origin), turned(ray.direction))
}

impl Primitive for Prism {
    fn kind(&self) -> &'static str {
        "prism"
    }

    fn validate(&self) -> Result<(), GeometryError> {
        if !(self.low.is_finite() && self.high.is_finite()) {
            let what = "height of the prism";
            return Err(GeometryError::NotFinite { what });
        }
        if self.low < self.high {
            return Ok(());
        }
        Err(GeometryError::Degenerate {
            what: "prism",
            why: "both heights are the same",
        })
    }

    fn wants_box(&self) -> bool {
        true
    }

    fn bounds(&self) -> Aabb {
        let Aabb { min, max } = self.extrusion().bounds();
        Aabb::new(turned(min), turned(max))
    }

    fn closest_hit(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        scratch: &mut Scratch,
    ) -> Option<PrimHit> {
        self.extrusion()
            .first_hit(&turned_ray(ray), range, from, scratch)
    }

    fn all_hits(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        scratch: &mut Scratch,
        out: &mut Vec<PrimHit>,
    ) {
        hits_of_solid(self, ray, range, from, scratch, out);
    }

    fn surface_at(&self, ray: &Ray, hit: &PrimHit) -> SurfacePoint {
        let found = self.extrusion().surface_at(&turned_ray(ray), hit);
        let normal = turned(found.n_geom);
        SurfacePoint::bare(turned(found.position), turned(found.position_error), normal)
    }

    fn as_solid(&self) -> Option<&dyn Solid> {
        Some(self)
    }
}

impl Solid for Prism {
    fn crossings(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        scratch: &mut Scratch,
        out: &mut Crossings,
    ) {
        self.extrusion()
            .all_crossings(&turned_ray(ray), range, from, scratch, out);
    }

    fn contains(&self, point: DVec3) -> bool {
        self.extrusion().contains(turned(point))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(list: &[[f64; 2]]) -> Vec<DVec2> {
        list.iter().map(|p| DVec2::from_array(*p)).collect()
    }

    fn prism(spline: Spline, sweep: PrismSweep, heights: [f64; 2], list: &[[f64; 2]]) -> Prism {
        Prism::try_new(spline, sweep, heights, &points(list), false).unwrap()
    }

    const FRAME: [[f64; 2]; 10] = [
        [-1.0, -1.0],
        [1.2, -1.0],
        [0.9, 1.0],
        [-1.0, 0.8],
        [-1.0, -1.0],
        [-0.5, -0.5],
        [0.5, -0.5],
        [0.5, 0.5],
        [-0.5, 0.3],
        [-0.5, -0.5],
    ];
    const CLOVER: [[f64; 2]; 8] = [
        [-1.0, 0.5],
        [0.0, -1.0],
        [1.2, 0.1],
        [0.1, 0.3],
        [0.3, 1.1],
        [-1.0, 0.5],
        [0.0, -1.0],
        [1.2, 0.1],
    ];
    const LEAF: [[f64; 2]; 8] = [
        [0.0, -1.0],
        [1.5, -0.9],
        [1.1, 0.8],
        [0.0, 1.0],
        [0.0, 1.0],
        [-0.2, 0.2],
        [-1.5, -0.2],
        [0.0, -1.0],
    ];

    crate::primitive_tests!(frame, || prism(
        Spline::Linear,
        PrismSweep::Linear,
        [-0.4, 0.7],
        &FRAME
    ));
    crate::primitive_tests!(parabolas, || prism(
        Spline::Quadratic,
        PrismSweep::Linear,
        [0.9, 0.0],
        &CLOVER[..7]
    ));
    crate::primitive_tests!(cubics, || prism(
        Spline::Cubic,
        PrismSweep::Linear,
        [0.0, 1.0],
        &CLOVER
    ));
    crate::primitive_tests!(bezier, || prism(
        Spline::Bezier,
        PrismSweep::Linear,
        [0.0, 1.0],
        &LEAF
    ));
    crate::primitive_tests!(conic, || prism(
        Spline::Linear,
        PrismSweep::Conic,
        [0.3, 1.1],
        &FRAME
    ));
    crate::primitive_tests!(conic_cubics, || prism(
        Spline::Cubic,
        PrismSweep::Conic,
        [0.5, 1.0],
        &CLOVER
    ));
    crate::primitive_tests!(double_cone, || prism(
        Spline::Bezier,
        PrismSweep::Conic,
        [-0.8, 1.0],
        &LEAF
    ));
    crate::primitive_tests!(open, || Prism::try_new(
        Spline::Bezier,
        PrismSweep::Linear,
        [0.0, 1.0],
        &points(&LEAF),
        true
    )
    .unwrap());

    #[test]
    fn the_first_hit_needs_no_others() {
        use super::super::spans::tests::first_hits_are_those_of_the_walk;
        let comb: Vec<[f64; 2]> = (0..40)
            .map(|k| [0.1 * f64::from(k) - 2.0, f64::from(k % 2) + 0.5])
            .chain([[2.0, 0.0], [-2.0, 0.0], [-2.0, 0.5]])
            .collect();
        for (spline, sweep, list) in [
            (Spline::Linear, PrismSweep::Linear, &FRAME[..]),
            (Spline::Linear, PrismSweep::Linear, &comb),
            (Spline::Quadratic, PrismSweep::Linear, &CLOVER[..7]),
            (Spline::Cubic, PrismSweep::Conic, &CLOVER),
            (Spline::Bezier, PrismSweep::Linear, &LEAF),
        ] {
            let prism = prism(spline, sweep, [-0.4, 0.7], list);
            first_hits_are_those_of_the_walk(&prism.extrusion());
        }
    }

    fn hits(prism: &Prism, origin: [f64; 3], direction: [f64; 3]) -> Vec<(f64, u32)> {
        let ray = Ray::new(origin.into(), direction.into());
        let mut out = Crossings::default();
        prism.crossings(
            &ray,
            Interval::LINE,
            None,
            &mut Scratch::default(),
            &mut out,
        );
        let hits = out.list.iter();
        hits.map(|c| (c.hit.t, c.hit.surface.facet)).collect()
    }

    #[test]
    fn rays_pass_through_walls_and_caps() {
        let frame = prism(Spline::Linear, PrismSweep::Linear, [0.0, 1.0], &FRAME);
        let across = hits(&frame, [-3.0, 0.5, 0.0], [1.0, 0.0, 0.0]);
        assert_eq!(across.len(), 4, "{across:?}");
        assert_eq!(across[0], (2.0, 5));
        assert_eq!(
            hits(&frame, [0.8, 3.0, 0.0], [0.0, -1.0, 0.0]),
            [(2.0, 1), (3.0, 0)]
        );
        assert_eq!(
            hits(&frame, [0.0, 3.0, 0.0], [0.0, -1.0, 0.0]),
            [],
            "through the hole"
        );
        // In through the hole, out through a cap.
        let oblique = hits(&frame, [0.0, 0.5, 0.0], [1.0, 0.75, 0.0]);
        assert_eq!(oblique.iter().filter(|(t, _)| *t > 0.0).count(), 2);
        assert_eq!(oblique.last().map(|hit| hit.1), Some(1));
    }

    #[test]
    fn a_cone_is_as_drawn_at_height_one() {
        let square = [
            [-1.0, -1.0],
            [1.0, -1.0],
            [1.0, 1.0],
            [-1.0, 1.0],
            [-1.0, -1.0],
        ];
        let cone = prism(Spline::Linear, PrismSweep::Conic, [-0.5, 1.0], &square);
        for (y, x) in [(1.0 - 1e-9, 1.0), (0.5, 0.5), (-0.25, 0.25)] {
            let found = hits(&cone, [-3.0, y, 0.1], [1.0, 0.0, 0.0]);
            assert!(
                found.len() == 2 && (found[0].0 - (3.0 - x)).abs() < 1e-8,
                "{found:?}"
            );
        }
        // Through the apex from one half to the other.
        let through = hits(&cone, [0.0, -3.0, 0.0], [0.0, 1.0, 0.0]);
        assert_eq!(through, [(2.5, 0), (4.0, 1)]);
        let beside = hits(&cone, [0.1, -3.0, 0.1], [0.0, 1.0, 0.0]);
        assert_eq!(beside.len(), 4, "{beside:?}");
    }

    #[test]
    fn curves_end_where_they_begin() {
        let quadratic = points(&[[1.0, -1.0], [0.0, 0.0], [6.0, 0.0], [6.0, 8.0], [0.0, 0.0]]);
        let cubic = [quadratic.clone(), points(&[[-1.0, 1.0]])].concat();
        for (spline, mut list, pieces) in [
            (Spline::Quadratic, quadratic, 6),
            (Spline::Cubic, cubic, 6),
            (Spline::Linear, points(&FRAME[..5]), 8),
            (Spline::Bezier, points(&LEAF), 4),
        ] {
            list.extend(list.clone());
            let prism =
                Prism::try_new(spline, PrismSweep::Linear, [0.0, 1.0], &list, false).unwrap();
            assert_eq!(prism.outline().piece_count(), pieces, "{spline:?}");
            assert_eq!(prism.outline().gaps(), 0, "{spline:?}");
            // Drawn twice, nothing is inside.
            assert!(!prism.contains(DVec3::new(0.4, 0.5, 0.3)), "{spline:?}");
        }
    }

    #[test]
    fn curves_that_do_not_come_back_are_closed() {
        let open = prism(Spline::Linear, PrismSweep::Linear, [0.0, 1.0], &FRAME[..3]);
        assert_eq!(
            (open.outline().gaps(), open.outline().piece_count()),
            (1, 3)
        );
        assert!(open.contains(DVec3::new(0.5, 0.5, 0.0)));
    }

    #[test]
    fn impossible_prisms_are_refused() {
        let make = |heights, list: &[[f64; 2]]| {
            Prism::try_new(
                Spline::Linear,
                PrismSweep::Linear,
                heights,
                &points(list),
                false,
            )
        };
        assert!(matches!(
            make([1.0, 1.0], &FRAME),
            Err(GeometryError::Degenerate { .. })
        ));
        assert!(matches!(
            make([f64::NAN, 1.0], &FRAME),
            Err(GeometryError::NotFinite { .. })
        ));
        assert!(matches!(
            make([0.0, 1.0], &[]),
            Err(GeometryError::Degenerate { .. })
        ));
        assert!(matches!(
            make([0.0, 1.0], &[[1.0, 2.0]]),
            Err(GeometryError::Degenerate { .. })
        ));
    }

    #[test]
    fn many_pieces_make_no_difference() {
        // A gear of 400 lines against its teeth one by one.
        let count = 400;
        let mut list: Vec<DVec2> = (0..count)
            .map(|i| {
                let angle = f64::from(i) * std::f64::consts::TAU / f64::from(count);
                let radius = if i % 4 < 2 { 1.0 } else { 0.8 };
                DVec2::new(radius * angle.cos(), radius * angle.sin())
            })
            .collect();
        list.push(list[0]);
        let gear =
            Prism::try_new(Spline::Linear, PrismSweep::Linear, [0.0, 1.0], &list, false).unwrap();
        let flat = |v: DVec3| DVec2::new(v.x, v.z);
        let mut random = crate::conformance::Random::new(5);
        for _ in 0..500 {
            let origin = DVec3::new(random.between(-2.0, 2.0), 0.5, random.between(-2.0, 2.0));
            let direction = (DVec3::new(random.between(-1.0, 1.0), 0.5, 0.3) - origin).with_y(0.0);
            let ray = Ray::new(origin, direction);
            let mut expected: Vec<f64> = list
                .windows(2)
                .filter_map(|pair| {
                    let (a, b) = (pair[0] - flat(origin), pair[1] - flat(origin));
                    let d = flat(direction);
                    let (p, q) = (d.perp_dot(a), d.perp_dot(b));
                    ((p >= 0.0) != (q >= 0.0))
                        .then(|| (a + (b - a) * (p / (p - q))).dot(d) / d.length_squared())
                })
                .collect();
            expected.sort_by(f64::total_cmp);
            let mut out = Crossings::default();
            gear.crossings(
                &ray,
                Interval::LINE,
                None,
                &mut Scratch::default(),
                &mut out,
            );
            let found: Vec<f64> = out.list.iter().map(|c| c.hit.t).collect();
            assert_eq!(found.len(), expected.len());
            for (a, b) in found.iter().zip(&expected) {
                assert!((a - b).abs() < 1e-12);
            }
        }
    }
}
