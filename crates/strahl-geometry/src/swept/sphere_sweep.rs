use super::curve::Piece;
use super::curve::catmull_rom;
use super::round::{Line, Segment};
use super::spans::{WholeLine, snap};
use crate::primitive::hits_of_solid;
use crate::primitives::point_error;
use crate::{
    Crossings, GeometryError, PrimHit, Primitive, Scratch, Side, Solid, SurfaceId, SurfacePoint,
};
use strahl_math::{Aabb, DVec3, DVec4, Interval, Ray};

/// How the spheres of a [`SphereSweep`] are interpolated, centres and radii alike.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SweepSpline {
    /// Linear interpolation: cones with round ends.
    Linear,
    /// A uniform cubic B-spline, which approximates the spheres.
    BSpline,
    /// By cubics through all spheres but the first and the last, with the slope at each that of the line between its neighbours
    /// (Catmull and Rom 1974).
    Cubic,
}

impl SweepSpline {
    /// The least number of spheres.
    pub const fn least(self) -> usize {
        match self {
            Self::Linear => 2,
            Self::BSpline | Self::Cubic => 4,
        }
    }
}

/// The volume that a sphere sweeps while it moves along a curve and changes its radius, like POV-Ray's `sphere_sweep`.
///
/// For a line, the spheres of a stretch of the curve that it meets cover one span of it, as long as it meets all of them: from
/// the least first to the greatest second point. So it takes the stretches on which the line meets the sphere, roots of a
/// polynomial of degree 6, and the extremes of both points, roots of one of degree 10; the spans of all pieces are then united. There is
/// no surface within the body.
///
/// There are no texture coordinates. Facets: one per piece of the curve.
#[derive(Clone, Debug, PartialEq)]
pub struct SphereSweep {
    segments: Box<[Segment]>,
    bounds: Aabb,
}

impl SphereSweep {
    /// A sweep through spheres given by centre and radius. Of a negative radius only the magnitude counts.
    ///
    /// # Errors
    /// A number is not finite, there are fewer spheres than the spline needs, or all radii are 0.
    pub fn try_new(spline: SweepSpline, spheres: &[(DVec3, f64)]) -> Result<Self, GeometryError> {
        let points: Vec<DVec4> = spheres.iter().map(|(c, r)| c.extend(*r)).collect();
        if !points.iter().all(|p| p.is_finite()) {
            let what = "a sphere of the sweep";
            return Err(GeometryError::NotFinite { what });
        }
        if points.len() < spline.least() {
            return Err(GeometryError::WrongCount {
                what: "spheres of the sweep",
                expected: spline.least() as u64,
                found: points.len() as u64,
            });
        }
        let four = |f: fn(DVec4, DVec4, DVec4, DVec4) -> Piece<DVec4>| {
            let runs = points.windows(4);
            let pieces = runs.filter_map(move |run| match *run {
                [a, b, c, d] => Some(Segment::new(f(a, b, c, d))),
                _ => None,
            });
            pieces.collect::<Box<[_]>>()
        };
        let segments = match spline {
            SweepSpline::Linear => points
                .windows(2)
                .filter_map(|pair| match *pair {
                    [a, b] => Some(Segment::new(Piece::Line([a, b]))),
                    _ => None,
                })
                .collect(),
            SweepSpline::BSpline => four(b_spline),
            SweepSpline::Cubic => four(catmull_rom),
        };
        let bounds = segments.iter().map(Segment::bounds);
        let sweep = Self {
            bounds: bounds.fold(Aabb::EMPTY, |all, b| all.union(&b)),
            segments,
        };
        sweep.validate().map(|()| sweep)
    }

    fn segment(&self, hit: &PrimHit) -> Option<&Segment> {
        self.segments.get(hit.surface.facet as usize)
    }
}

impl WholeLine for SphereSweep {
    fn walk(&self, ray: &Ray, from: Option<SurfaceId>, list: &mut Crossings) {
        let (o, d) = (ray.origin, ray.direction);
        if !(o.is_finite() && d.is_finite()) || self.bounds.clip(ray, Interval::LINE).is_none() {
            return;
        }
        let Some(line) = Line::new(ray, self.bounds.center()) else {
            return;
        };
        for (index, segment) in self.segments.iter().enumerate() {
            if segment.is_near(&line) {
                segment.spans(&line, index as u32, &mut list.list);
            }
        }
        if let Some(from) = from {
            let near =
                |hit: &PrimHit| (hit.surface.facet == from.facet).then(|| self.normal(ray, hit));
            let size = self.bounds.size().max_element();
            snap(&mut list.list, ray, size, near);
        }
        // Spans that touch are one: entering comes first.
        let rank = |side: Side| u32::from(side != Side::Enter);
        list.list.sort_unstable_by(|a, b| {
            let order = |c: &crate::Crossing| (rank(c.side), c.hit.surface.facet);
            a.hit
                .t
                .total_cmp(&b.hit.t)
                .then_with(|| order(a).cmp(&order(b)))
        });
        let mut depth = 0;
        list.list.retain(|crossing| {
            if crossing.side == Side::Enter {
                depth += 1;
                depth == 1
            } else {
                depth -= 1;
                depth == 0
            }
        });
    }

    /// From the sphere's centre to the point.
    fn normal(&self, ray: &Ray, hit: &PrimHit) -> DVec3 {
        let center = self
            .segment(hit)
            .map_or(DVec3::ZERO, |s| s.at(hit.uv[0]).truncate());
        let away = ray.at(hit.t) - center;
        let largest = away.abs().max_element();
        if largest > 0.0 && largest.is_finite() {
            (away / largest).normalize()
        } else {
            -ray.direction.normalize_or(DVec3::Y)
        }
    }

    fn reach(&self) -> f64 {
        self.bounds.max_abs()
    }
}

/// A piece of the uniform cubic B-spline of four control points, as a Bézier curve.
fn b_spline(a: DVec4, b: DVec4, c: DVec4, d: DVec4) -> Piece<DVec4> {
    let joint = |p: DVec4, q: DVec4, r: DVec4| (p + q * 4.0 + r) * (1.0 / 6.0);
    let third = |p: DVec4, q: DVec4| (p * 2.0 + q) * (1.0 / 3.0);
    Piece::Cubic([joint(a, b, c), third(b, c), third(c, b), joint(b, c, d)])
}

impl Primitive for SphereSweep {
    fn kind(&self) -> &'static str {
        "sphere_sweep"
    }

    fn validate(&self) -> Result<(), GeometryError> {
        let has_size = self.segments.iter().any(Segment::has_size);
        if has_size && self.bounds.is_bounded() {
            return Ok(());
        }
        Err(GeometryError::Degenerate {
            what: "sphere sweep",
            why: "all its radii are 0",
        })
    }

    fn wants_box(&self) -> bool {
        true
    }

    fn bounds(&self) -> Aabb {
        self.bounds
    }

    fn closest_hit(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        scratch: &mut Scratch,
    ) -> Option<PrimHit> {
        self.first_hit(ray, range, from, scratch)
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
        let normal = self.normal(ray, hit);
        let sphere = self.segment(hit).map_or(DVec4::ZERO, |s| s.at(hit.uv[0]));
        let position = sphere.truncate() + normal * sphere.w.abs();
        let error = point_error(position, self.bounds.max_abs(), 64);
        SurfacePoint::bare(position, error, normal)
    }

    fn as_solid(&self) -> Option<&dyn Solid> {
        Some(self)
    }
}

impl Solid for SphereSweep {
    fn crossings(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        scratch: &mut Scratch,
        out: &mut Crossings,
    ) {
        self.all_crossings(ray, range, from, scratch, out);
    }

    fn contains(&self, point: DVec3) -> bool {
        self.bounds.contains(point) && self.segments.iter().any(|s| s.contains(point))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sweep(spline: SweepSpline, list: &[[f64; 4]]) -> SphereSweep {
        let spheres: Vec<_> = list
            .iter()
            .map(|[x, y, z, r]| (DVec3::new(*x, *y, *z), *r))
            .collect();
        SphereSweep::try_new(spline, &spheres).unwrap()
    }

    const WORM: [[f64; 4]; 6] = [
        [-1.5, 0.0, 0.2, 0.3],
        [-1.0, 0.4, 0.0, 0.25],
        [-0.2, -0.3, 0.5, 0.4],
        [0.5, 0.4, -0.2, 0.2],
        [1.0, 0.0, 0.3, 0.35],
        [1.4, -0.6, 0.1, 0.2],
    ];

    crate::primitive_tests!(chain, || sweep(SweepSpline::Linear, &WORM));
    crate::primitive_tests!(cone_with_round_ends, || sweep(
        SweepSpline::Linear,
        &[[0.0, 0.0, 0.0, 0.8], [1.0, 0.5, 0.0, 0.3]]
    ));
    crate::primitive_tests!(a_sphere_in_a_sphere, || sweep(
        SweepSpline::Linear,
        &[[0.0, 0.0, 0.0, 1.0], [0.2, 0.1, 0.0, 0.3]]
    ));
    crate::primitive_tests!(worm, || sweep(SweepSpline::Cubic, &WORM));
    crate::primitive_tests!(smooth_worm, || sweep(SweepSpline::BSpline, &WORM));

    #[test]
    fn the_surface_is_that_of_povray() {
        // What POV-Ray's `trace` says of the same sweeps along z, at y = 0.
        let cubic = [
            [-2.0, 0.0, 0.0, 0.5],
            [0.0, 0.0, 1.0, 0.3],
            [3.0, 0.0, 2.0, 0.6],
            [5.0, 0.0, -1.0, 0.1],
        ];
        type Case<'a> = (SweepSpline, &'a [[f64; 4]], &'a [(f64, f64)]);
        let lists: [Case; 3] = [
            (
                SweepSpline::Cubic,
                &cubic,
                &[
                    (0.001, 0.700_001_666_671),
                    (0.501, 0.875_740_580_909),
                    (1.501, 1.257_647_873_698),
                    (2.501, 1.474_140_808_521),
                    (3.501, 1.669_850_034_075),
                ],
            ),
            (
                SweepSpline::BSpline,
                &cubic,
                &[
                    (0.001, 0.654_313_726_046),
                    (1.001, 0.866_122_712_855),
                    (2.001, 1.005_504_194_930),
                    (3.001, 0.897_827_114_472),
                ],
            ),
            (
                SweepSpline::Linear,
                &cubic[1..3],
                &[
                    (0.001, 0.700_001_666_671),
                    (0.501, 0.807_703_657_160),
                    (2.501, 1.269_116_771_791),
                    (3.501, 1.669_850_034_075),
                ],
            ),
        ];
        for (spline, list, expected) in lists {
            let sweep = sweep(spline, list);
            for &(x, z) in expected {
                let ray = Ray::new(DVec3::new(x, 0.0, -20.0), DVec3::Z);
                let hit = sweep.closest_hit(&ray, Interval::FORWARD, None, &mut Scratch::default());
                let found = hit.map(|hit| hit.t - 20.0);
                assert!(
                    found.is_some_and(|t| (t - z).abs() < 2e-9),
                    "{spline:?} {x}: {found:?}"
                );
            }
        }
    }

    /// The first point of any sphere, of many along the curve.
    fn first_of_spheres(sweep: &SphereSweep, ray: &Ray) -> Option<f64> {
        let mut first = f64::INFINITY;
        for segment in &sweep.segments {
            for k in 0..=4000 {
                let sphere = segment.at(f64::from(k) / 4000.0);
                let aside = sphere.truncate() - ray.origin;
                let along = aside.dot(ray.direction);
                let square = sphere.w * sphere.w - (aside.length_squared() - along * along);
                if square >= 0.0 && along - square.sqrt() < first {
                    first = along - square.sqrt();
                }
            }
        }
        first.is_finite().then_some(first)
    }

    #[test]
    fn rays_across_a_flat_curve_meet_the_nearest_sphere() {
        let flat = WORM.map(|[x, y, _, r]| [x, y, 0.0, r]);
        let scratch = &mut Scratch::default();
        for spline in [
            SweepSpline::Cubic,
            SweepSpline::BSpline,
            SweepSpline::Linear,
        ] {
            let sweep = sweep(spline, &flat);
            let mut found = 0;
            for k in 0..1600 {
                let (x, y) = (
                    f64::from(k % 40) * 0.07 - 1.4,
                    f64::from(k / 40) * 0.04 - 0.8,
                );
                // Exactly across, nearly, and not.
                let tilt = [0.0, 1e-12, 1e-9, 1e-7, 1e-5, 1e-2][k as usize % 6];
                let direction = DVec3::new(tilt, 0.5 * tilt, 1.0).normalize();
                let ray = Ray::new(DVec3::new(x, y, -3.0), direction);
                let hit = sweep.closest_hit(&ray, Interval::FORWARD, None, scratch);
                let Some(t) = first_of_spheres(&sweep, &ray) else {
                    continue;
                };
                // The best of the samples is a little behind, much where the ray touches.
                let nearest = hit.map_or(f64::INFINITY, |hit| hit.t);
                assert!(nearest < t + 1e-9, "{spline:?} {ray:?}: {nearest} {t}");
                assert!(nearest > t - 2e-3, "{spline:?} {ray:?}: {nearest} {t}");
                found += 1;
            }
            assert!(found > 200, "{found}");
        }
    }

    #[test]
    fn rays_go_through_all_parts_of_a_bent_body() {
        let arch = sweep(
            SweepSpline::Linear,
            &[
                [-1.0, 0.0, 0.0, 0.2],
                [-1.0, 2.0, 0.0, 0.2],
                [1.0, 2.0, 0.0, 0.2],
                [1.0, 0.0, 0.0, 0.2],
            ],
        );
        let ray = Ray::new(DVec3::new(-3.0, 1.0, 0.0), DVec3::X);
        let mut out = Crossings::default();
        arch.crossings(
            &ray,
            Interval::LINE,
            None,
            &mut Scratch::default(),
            &mut out,
        );
        let found: Vec<f64> = out.list.iter().map(|c| c.hit.t).collect();
        let expected = [1.8, 2.2, 3.8, 4.2];
        assert!(
            found.len() == 4
                && found
                    .iter()
                    .zip(expected)
                    .all(|(a, b)| (a - b).abs() < 1e-14),
            "{found:?}"
        );
        let along = Ray::new(DVec3::new(-3.0, 2.0, 0.0), DVec3::X);
        let mut out = Crossings::default();
        arch.crossings(
            &along,
            Interval::LINE,
            None,
            &mut Scratch::default(),
            &mut out,
        );
        assert_eq!(out.list.len(), 2, "one body along the beam");
    }

    #[test]
    fn impossible_sweeps_are_refused() {
        let make = |spline, list: &[(DVec3, f64)]| SphereSweep::try_new(spline, list);
        let ball = (DVec3::ZERO, 1.0);
        assert!(matches!(
            make(SweepSpline::Linear, &[ball]),
            Err(GeometryError::WrongCount {
                expected: 2,
                found: 1,
                ..
            })
        ));
        assert!(matches!(
            make(SweepSpline::Cubic, &[ball; 3]),
            Err(GeometryError::WrongCount {
                expected: 4,
                found: 3,
                ..
            })
        ));
        assert!(matches!(
            make(SweepSpline::Linear, &[(DVec3::ZERO, 0.0), (DVec3::X, 0.0)]),
            Err(GeometryError::Degenerate { .. })
        ));
        assert!(matches!(
            make(SweepSpline::Linear, &[ball, (DVec3::X, f64::NAN)]),
            Err(GeometryError::NotFinite { .. })
        ));
        assert!(make(SweepSpline::BSpline, &[ball; 4]).is_ok());
    }
}
