use super::curve::Piece;
use super::meridian::{Meridian, MeridianBuilder};
use crate::{GeometryError, Primitive};
use strahl_math::DVec2;

/// A surface of revolution about the y axis whose radius is a function of the height, like POV-Ray's `sor`.
///
/// Between two points the *square* of the radius is a cubic in the height, with the slope at each point that of the line between its
/// neighbours; the first and the last point only serve for that. Where the square is negative there is no surface.
///
/// The discs at both ends of an *open* one are invisible, but it is still a solid. Texture coordinates: `u` is the angle about
/// the axis, `v` grows along the curve from 0 to 1, each of its pieces taking an equal share, and along a radius of each disc by 1: from -1 at
/// the axis to 0 at the rim of the lower one, and from 1 to 2 on the upper one. Facets: one for every part on which the radius is
/// monotone, from the disc at the lower end to that at the upper end.
#[derive(Clone, Debug, PartialEq)]
pub struct Sor {
    pub(super) meridian: Meridian,
}

impl Sor {
    /// A surface through points (radius, height).
    ///
    /// # Errors
    /// A coordinate is not finite; there are fewer than four points; the heights do not grow from the second point to the last but one, or
    /// the neighbours of a point have the same height; or all radii are 0.
    pub fn try_new(points: &[DVec2], open: bool) -> Result<Self, GeometryError> {
        if !points.iter().all(|p| p.is_finite()) {
            let what = "a point of the surface of revolution";
            return Err(GeometryError::NotFinite { what });
        }
        if !Self::is_rising(points) {
            return Err(GeometryError::Degenerate {
                what: "surface of revolution",
                why: "its heights do not grow from point to point",
            });
        }
        let mut builder = MeridianBuilder::default();
        builder.begin();
        let count = points.len().saturating_sub(3);
        for (i, four) in points.windows(4).enumerate() {
            let &[before, a, b, after] = four else {
                continue;
            };
            if i == 0 {
                let (middle, rim) = disc(a);
                builder.piece(&Piece::Line([middle, rim]), !open, [-1.0, 0.0]);
            }
            let (step, third) = (b.y - a.y, 1.0 / 3.0);
            // The slope of the square is twice the radius times that of the radius.
            let slope = |at: DVec2, p: DVec2, q: DVec2| 2.0 * at.x * (q.x - p.x) / (q.y - p.y);
            let (from, to) = (a.x * a.x, b.x * b.x);
            let square = [
                from,
                from + slope(a, before, b) * step * third,
                to - slope(b, a, after) * step * third,
                to,
            ];
            let (square, heights) = (Piece::Cubic(square), Piece::Line([a.y, b.y]));
            let share = |i: usize| i as f64 / count as f64;
            builder.squared_piece(square, heights, [share(i), share(i + 1)]);
            if i + 1 == count {
                let (middle, rim) = disc(b);
                builder.piece(&Piece::Line([rim, middle]), !open, [1.0, 2.0]);
            }
        }
        let sor = Self {
            meridian: builder.finish(),
        };
        sor.validate().map(|()| sor)
    }

    /// Whether the heights grow from the second point to the last but one, and the neighbours of each point have different heights.
    pub fn is_rising(points: &[DVec2]) -> bool {
        points.windows(4).all(|four| match *four {
            [before, a, b, after] => a.y < b.y && before.y < b.y && a.y < after.y,
            _ => true,
        })
    }
}

/// Middle and rim of the disc that closes the surface at a point.
fn disc(point: DVec2) -> (DVec2, DVec2) {
    (DVec2::new(0.0, point.y), DVec2::new(point.x.abs(), point.y))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Scratch;
    use strahl_math::{DVec3, Interval, Ray};

    fn sor(list: &[[f64; 2]], open: bool) -> Result<Sor, GeometryError> {
        let points: Vec<_> = list.iter().map(|p| DVec2::from_array(*p)).collect();
        Sor::try_new(&points, open)
    }

    const BOTTLE: [[f64; 2]; 7] = [
        [0.0, -0.1],
        [0.6, 0.0],
        [1.0, 0.6],
        [0.3, 1.2],
        [0.3, 1.6],
        [0.5, 1.8],
        [0.7, 2.0],
    ];

    crate::primitive_tests!(bottle, || sor(&BOTTLE, false).unwrap());
    crate::primitive_tests!(open, || sor(&BOTTLE, true).unwrap());
    crate::primitive_tests!(egg, || sor(
        &[
            [-0.9, -0.2],
            [0.0, 0.0],
            [0.8, 0.7],
            [0.0, 1.8],
            [-0.6, 2.5]
        ],
        false
    )
    .unwrap());

    #[test]
    fn radii_are_those_of_the_formula() {
        // The square of the radius between (2, 1) and (1.5, 2), slopes 2 r r' with r' = 1/4 and -1/3 there.
        let body = sor(
            &[[1.0, 0.0], [2.0, 1.0], [1.5, 2.0], [1.0, 4.0], [1.0, 5.0]],
            false,
        )
        .unwrap();
        for i in 1..8 {
            let h = f64::from(i) / 8.0;
            let (a, b, m, n) = (4.0, 2.25, 1.0, -1.0);
            let square = (2.0 * h * h * h - 3.0 * h * h + 1.0) * a
                + (h * h * h - 2.0 * h * h + h) * m
                + (3.0 * h * h - 2.0 * h * h * h) * b
                + (h * h * h - h * h) * n;
            let ray = Ray::new(DVec3::new(-9.0, 1.0 + h, 0.0), DVec3::X);
            let hit = body.closest_hit(&ray, Interval::FORWARD, None, &mut Scratch::default());
            let r = 9.0 - hit.unwrap().t;
            assert!((r * r - square).abs() < 1e-13, "{h}: {r}");
        }
    }

    #[test]
    fn impossible_ones_are_refused() {
        for list in [
            &[[1.0, 0.0], [1.0, 1.0], [1.0, 2.0]][..],
            &[[1.0, 0.0], [1.0, 1.0], [1.0, 1.0], [1.0, 2.0]],
            &[[1.0, 3.0], [1.0, 2.0], [1.0, 1.0], [1.0, 0.0]],
            &[[0.0, 0.0], [0.0, 1.0], [0.0, 2.0], [0.0, 3.0]],
        ] {
            assert!(
                matches!(sor(list, false), Err(GeometryError::Degenerate { .. })),
                "{list:?}"
            );
        }
        assert!(matches!(
            sor(
                &[[f64::INFINITY, 0.0], [1.0, 1.0], [1.0, 2.0], [1.0, 3.0]],
                false
            ),
            Err(GeometryError::NotFinite { .. })
        ));
    }
}
