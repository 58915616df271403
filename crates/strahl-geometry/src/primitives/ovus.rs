use super::arcs::{Arc, ArcBody};
use super::{check_length, check_positive};
use crate::GeometryError;
use strahl_math::DVec3;

/// An egg: a ball at the bottom, a ball at the top, and between them a part of a spindle torus that touches both.
///
/// The bottom ball is centred at the origin, the top one on the bottom one's highest point, at `y` = the bottom radius. The arc
/// of the part between them has twice the larger radius. From a top radius of twice the bottom radius on, the egg is the top
/// ball alone. Texture coordinates, from 0 to 1: `u` is the longitude, from +x towards +z, `v` the latitude as seen from halfway between bottom and
/// top. Facets: 0 the bottom, 1 the middle, 2 the top. A radius may be 0, but not both.
#[derive(Clone, Debug, PartialEq)]
pub struct Ovus {
    bottom: f64,
    top: f64,
    pub(super) body: ArcBody,
}

impl Ovus {
    /// The egg of two radii.
    pub fn new(bottom: f64, top: f64) -> Self {
        let ball = |radius: f64, height: f64, low: f64, high: f64| Arc {
            inset: 0.0,
            height,
            radius,
            low,
            high,
        };
        let arcs = if top >= 2.0 * bottom {
            vec![ball(top, bottom, f64::NEG_INFINITY, f64::INFINITY)]
        } else {
            let radius = 2.0 * if bottom > top { bottom } else { top };
            // The distances of the arc's centre from those of the balls; the latter are `bottom` apart.
            let (a, b) = (radius - bottom, radius - top);
            let height = ((a - b) * (a + b) + bottom * bottom) / (2.0 * bottom);
            let square = (a - height) * (a + height);
            let inset = if square > 0.0 { square.sqrt() } else { 0.0 };
            let low = -height / a * bottom;
            let high = bottom + (bottom - height) / b * top;
            let middle = Arc {
                inset,
                height,
                radius,
                low,
                high,
            };
            vec![
                ball(bottom, 0.0, f64::NEG_INFINITY, low),
                middle,
                ball(top, bottom, high, f64::INFINITY),
            ]
        };
        Self {
            bottom,
            top,
            body: ArcBody {
                base: DVec3::ZERO,
                axis: DVec3::Y,
                first: DVec3::X,
                arcs,
                is_capped: true,
            },
        }
    }

    /// Like [`Ovus::new`], checked.
    ///
    /// # Errors
    /// A radius is not finite or not positive.
    pub fn try_new(bottom: f64, top: f64) -> Result<Self, GeometryError> {
        let ovus = Self::new(bottom, top);
        ovus.check().map(|()| ovus)
    }

    /// The radius of the bottom.
    pub const fn bottom(&self) -> f64 {
        self.bottom
    }

    /// The radius of the top.
    pub const fn top(&self) -> f64 {
        self.top
    }

    /// See [`crate::Primitive::validate`].
    pub(super) fn check(&self) -> Result<(), GeometryError> {
        check_length("bottom radius of the ovus", self.bottom)?;
        check_length("top radius of the ovus", self.top)?;
        check_positive("sum of the radii of the ovus", self.bottom + self.top)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{PrimHit, Primitive, Scratch, Sphere};
    use strahl_math::{Interval, Ray};

    crate::primitive_tests!(egg, || Ovus::new(1.0, 0.5));
    crate::primitive_tests!(pointed_below, || Ovus::new(0.6, 1.0));
    crate::primitive_tests!(nearly_a_ball, || Ovus::new(0.5, 0.9999));
    crate::primitive_tests!(slender, || Ovus::new(1.0, 0.01));
    crate::primitive_tests!(pointed, || Ovus::new(1.0, 0.0));
    crate::primitive_tests!(ball, || Ovus::new(0.4, 1.0));

    #[test]
    fn the_parts_of_an_egg_touch_without_an_edge() {
        for (bottom, top) in [(1.0, 0.5), (1.0, 1.0), (0.7, 1.2), (3.0, 0.1)] {
            let egg = Ovus::new(bottom, top);
            let [low, middle, high] = egg.body.arcs[..] else {
                panic!("three parts");
            };
            let off = |arc: Arc, h: f64| {
                let square = arc.radius * arc.radius - (h - arc.height) * (h - arc.height);
                square.sqrt() - arc.inset
            };
            for (a, b, h) in [(low, middle, middle.low), (middle, high, middle.high)] {
                let (x, y) = (off(a, h), off(b, h));
                assert!((x - y).abs() < 1e-13, "{bottom} {top}: {x} {y}");
                // The normals: from the centres of the arcs.
                let slope = |arc: Arc| (h - arc.height) / arc.radius;
                assert!((slope(a) - slope(b)).abs() < 1e-13, "{bottom} {top}");
            }
            assert!(low.high < high.low);
        }
        let ball = Ovus::new(0.4, 1.0);
        assert_eq!(ball.body.arcs.len(), 1);
        let sphere = Sphere::new(DVec3::Y * 0.4, 1.0);
        let ray = Ray::new(DVec3::new(0.2, 5.0, 0.1), DVec3::new(0.01, -1.0, 0.05));
        let scratch = &mut Scratch::default();
        let [a, b]: [Option<PrimHit>; 2] = [
            ball.closest_hit(&ray, Interval::FORWARD, None, scratch),
            sphere.closest_hit(&ray, Interval::FORWARD, None, scratch),
        ];
        assert!((a.unwrap().t - b.unwrap().t).abs() < 1e-13);
    }

    /// Measured with POV-Ray 3.7: the longitude from +x towards +z, the latitude from halfway between the ends.
    #[test]
    fn textures_lie_on_eggs_as_in_povray() {
        let (egg, scratch) = (Ovus::new(1.0, 0.5), &mut Scratch::default());
        for (y, v) in [
            (1.425, 0.932),
            (0.975, 0.759),
            (0.225, 0.495),
            (-0.975, 0.056),
        ] {
            let ray = Ray::new(DVec3::new(0.0, y, -5.0), DVec3::Z);
            let hit = egg
                .closest_hit(&ray, Interval::FORWARD, None, scratch)
                .unwrap();
            let uv = egg.surface_at(&ray, &hit).uv;
            assert!(
                (uv.x - 0.75).abs() < 1e-12 && (uv.y - v).abs() < 0.005,
                "{y}: {uv}"
            );
            assert_eq!(egg.texture_uv(&hit, uv), Some(uv));
        }
    }

    #[test]
    fn impossible_eggs_are_refused() {
        assert!(Ovus::try_new(1.0, 0.5).is_ok());
        for (bottom, top) in [(0.0, 0.0), (1.0, -1.0), (-1.0, 1.0), (f64::NAN, 1.0)] {
            assert!(Ovus::try_new(bottom, top).is_err(), "{bottom} {top}");
        }
    }
}
