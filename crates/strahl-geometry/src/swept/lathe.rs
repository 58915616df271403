use super::curve::{Piece, Spline};
use super::meridian::{Meridian, MeridianBuilder};
use crate::{GeometryError, Primitive};
use strahl_math::DVec2;

/// A curve turned about the y axis, like POV-Ray's `lathe`.
///
/// Parts of the curve with a negative radius count as if mirrored. As in POV-Ray, the inside is what the curve surrounds an odd
/// number of times, seen from its smallest radius outwards. A curve that does not return to its first point still makes a
/// solid, closed by horizontal discs at its ends and a vertical wall at its smallest radius, all invisible. (For Bézier curves,
/// the wall is at the smallest radius of their points: measured with POV-Ray 3.7.)
///
/// Texture coordinates: `u` is the angle about the axis, `v` grows along the curve, each of its pieces taking an equal share;
/// both run from 0 to 1. Facets: one for every part of the curve on which radius and height are monotone, in the order of the
/// curve.
#[derive(Clone, Debug, PartialEq)]
pub struct Lathe {
    pub(super) meridian: Meridian,
}

impl Lathe {
    /// A lathe of a curve given by points (radius, height). Splines that need points beside the curve have them first
    /// and last.
    ///
    /// # Errors
    /// A coordinate is not finite, or there are too few points, or the curve is nothing but a point or runs along the axis.
    pub fn try_new(spline: Spline, points: &[DVec2]) -> Result<Self, GeometryError> {
        if !points.iter().all(|p| p.is_finite()) {
            let what = "a point of the lathe";
            return Err(GeometryError::NotFinite { what });
        }
        let pieces = spline.pieces(points);
        let share = 1.0 / pieces.len() as f64;
        let v = |i: usize| [i as f64 * share, (i + 1) as f64 * share];
        let mut all = MeridianBuilder::default();
        for (i, piece) in pieces.iter().enumerate() {
            all.piece(piece, true, v(i));
        }
        let [smallest, _] = all.radii();
        let inner = match spline {
            Spline::Bezier => points.iter().fold(smallest, |r, p| r.min(p.x.abs())),
            _ => smallest,
        };
        let mut builder = MeridianBuilder::default();
        let mut first: Option<DVec2> = None;
        for (i, piece) in pieces.iter().enumerate() {
            let start = *first.get_or_insert_with(|| {
                builder.begin();
                piece.start()
            });
            builder.piece(piece, true, v(i));
            // Only Bézier curves may continue elsewhere.
            let end = piece.end();
            if pieces.get(i + 1).is_none_or(|next| next.start() != end) {
                close(&mut builder, end, start, inner);
                first = None;
            }
        }
        let lathe = Self {
            meridian: builder.finish(),
        };
        lathe.validate().map(|()| lathe)
    }
}

/// Closes a curve by invisible lines: horizontally to the inner radius, along it, and back.
fn close(builder: &mut MeridianBuilder, end: DVec2, start: DVec2, inner: f64) {
    if end == start {
        return;
    }
    let (end, start) = (
        DVec2::new(end.x.abs(), end.y),
        DVec2::new(start.x.abs(), start.y),
    );
    let corners = [
        end,
        DVec2::new(inner, end.y),
        DVec2::new(inner, start.y),
        start,
    ];
    for side in corners.windows(2) {
        if let [a, b] = *side {
            builder.piece(&Piece::Line([a, b]), false, [0.0, 0.0]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Crossings, Scratch, Solid};
    use strahl_math::{DVec3, Interval, Ray};

    fn lathe(spline: Spline, list: &[[f64; 2]]) -> Lathe {
        let points: Vec<_> = list.iter().map(|p| DVec2::from_array(*p)).collect();
        Lathe::try_new(spline, &points).unwrap()
    }

    const VASE: [[f64; 2]; 8] = [
        [0.0, 0.1],
        [0.0, 0.0],
        [0.5, 0.0],
        [0.9, 0.5],
        [0.3, 1.1],
        [0.4, 1.3],
        [0.0, 1.2],
        [0.0, 1.0],
    ];
    const RING: [[f64; 2]; 5] = [[0.5, 0.0], [1.0, 0.1], [1.1, 0.6], [0.6, 0.5], [0.5, 0.0]];

    crate::primitive_tests!(ring, || lathe(Spline::Linear, &RING));
    crate::primitive_tests!(frustum, || lathe(
        Spline::Linear,
        &[[0.0, 0.0], [1.0, 0.0], [0.6, 1.0], [0.0, 1.0]]
    ));
    crate::primitive_tests!(parabolas, || lathe(Spline::Quadratic, &VASE));
    crate::primitive_tests!(vase, || lathe(Spline::Cubic, &VASE));
    crate::primitive_tests!(bezier, || lathe(
        Spline::Bezier,
        &[
            [0.4, 0.0],
            [1.1, 0.3],
            [1.2, 0.7],
            [0.5, 1.0],
            [0.5, 1.0],
            [0.2, 0.7],
            [0.1, 0.4],
            [0.4, 0.0]
        ]
    ));
    crate::primitive_tests!(open_wall, || lathe(
        Spline::Cubic,
        &[[0.2, -0.5], [0.8, 0.0], [1.0, 0.5], [0.5, 1.0], [0.8, 1.5]]
    ));

    fn crossings(lathe: &Lathe, origin: [f64; 3], direction: [f64; 3]) -> Vec<f64> {
        let ray = Ray::new(origin.into(), direction.into());
        let mut out = Crossings::default();
        lathe.crossings(
            &ray,
            Interval::LINE,
            None,
            &mut Scratch::default(),
            &mut out,
        );
        out.list.iter().map(|c| c.hit.t).collect()
    }

    #[test]
    fn level_upright_and_nearly_so_are_no_special_cases() {
        let cone = lathe(
            Spline::Linear,
            &[[0.0, 0.0], [1.0, 0.0], [0.5, 1.0], [0.0, 1.0]],
        );
        for tilt in [0.0, 1e-300, 1e-20, 1e-12, 1e-9, 1e-6] {
            let level = crossings(&cone, [-3.0, 0.5, 0.0], [1.0, tilt, 0.0]);
            assert!(
                level.len() == 2
                    && (level[0] - 2.25).abs() < 1e-5
                    && (level[1] - 3.75).abs() < 1e-5,
                "{tilt}: {level:?}"
            );
            let upright = crossings(&cone, [0.75, 3.0, 0.0], [tilt, -1.0, 0.0]);
            assert!(
                upright.len() == 2
                    && (upright[0] - 2.5).abs() < 1e-5
                    && (upright[1] - 3.0).abs() < 1e-5,
                "{tilt}: {upright:?}"
            );
            let axis = crossings(&cone, [0.0, 3.0, 0.0], [tilt, -1.0, tilt]);
            assert!(
                axis.len() == 2 && (axis[0] - 2.0).abs() < 1e-5,
                "{tilt}: {axis:?}"
            );
        }
    }

    #[test]
    fn a_wall_that_is_a_cylinder_is_hit_like_one() {
        let ring = lathe(
            Spline::Linear,
            &[[0.5, 0.0], [1.0, 0.0], [1.0, 1.0], [0.5, 1.0], [0.5, 0.0]],
        );
        let found = crossings(&ring, [-3.0, 0.25, 0.0], [1.0, 0.0625, 0.0]);
        let expected = [2.0, 2.5, 3.5, 4.0];
        assert!(
            found.len() == 4
                && found
                    .iter()
                    .zip(expected)
                    .all(|(a, b)| (a - b).abs() < 1e-14),
            "{found:?}"
        );
    }

    #[test]
    fn an_open_curve_is_closed_out_of_sight() {
        // As POV-Ray's `inside` says of the same curve.
        let open = lathe(Spline::Linear, &[[1.0, 0.0], [2.0, 1.0], [1.5, 2.0]]);
        for (y, from, to) in [(0.5, 1.0, 1.5), (1.1, 1.0, 1.95), (1.5, 1.0, 1.75)] {
            for i in 0..50 {
                let r = f64::from(i) * 0.05 + 0.013;
                let inside = open.contains(DVec3::new(0.6 * r, y, 0.8 * r));
                assert_eq!(inside, from < r && r < to, "{r} {y}");
            }
        }
        let ray = Ray::new(DVec3::new(1.2, 3.0, 0.0), DVec3::NEG_Y);
        let hit = open.closest_hit(&ray, Interval::FORWARD, None, &mut Scratch::default());
        let at = hit.map(|hit| hit.t);
        assert!(
            at.is_some_and(|t| (t - 2.8).abs() < 1e-14),
            "{at:?}: through the open top"
        );
    }

    #[test]
    fn an_open_bezier_curve_is_closed_at_the_smallest_radius_of_its_points() {
        // As POV-Ray's `inside` says of the same curve, whose own smallest radius is 0.67.
        let open = lathe(
            Spline::Bezier,
            &[[1.0, -1.0], [0.25, -0.6], [1.4, -0.3], [1.0, 0.0]],
        );
        for (r, inside) in [(0.2, false), (0.3, true), (0.5, true), (0.65, true)] {
            for y in [-0.9, -0.5, -0.1] {
                let point = DVec3::new(0.6 * r, y, 0.8 * r);
                assert_eq!(open.contains(point), inside, "{r} {y}");
            }
        }
    }

    #[test]
    fn impossible_lathes_are_refused() {
        let make = |list: &[[f64; 2]]| {
            let points: Vec<_> = list.iter().map(|p| DVec2::from_array(*p)).collect();
            Lathe::try_new(Spline::Linear, &points)
        };
        for list in [
            &[][..],
            &[[1.0, 1.0]],
            &[[1.0, 1.0], [1.0, 1.0]],
            &[[0.0, 1.0], [0.0, 2.0]],
        ] {
            assert!(
                matches!(make(list), Err(GeometryError::Degenerate { .. })),
                "{list:?}"
            );
        }
        assert!(matches!(
            make(&[[1.0, f64::NAN], [1.0, 2.0]]),
            Err(GeometryError::NotFinite { .. })
        ));
    }
}
