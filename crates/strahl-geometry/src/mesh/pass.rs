use super::shear::{RayShear, TriangleHit, exact_cross, place};
use strahl_math::DVec3;

/// A pass of a ray through a triangle, for counting: at an edge or a corner it passes through as many of the adjoining
/// triangles as it would after an infinitely small shift.
///
/// Ties are decided exactly (by error-free products), and remaining ties as if the ray were shifted by an infinitely small step
/// in x and an infinitely smaller one in y ("simulation of simplicity", Edelsbrunner and Mücke 1990). The passes through a
/// closed surface therefore always add up to zero. The `bool` says whether the front was passed.
#[inline]
pub(crate) fn pass_triangle(
    shear: &RayShear,
    a: DVec3,
    b: DVec3,
    c: DVec3,
) -> Option<(TriangleHit, bool)> {
    let (u0, u1) = (b.x * c.y, b.y * c.x);
    let (v0, v1) = (c.x * a.y, c.y * a.x);
    let (w0, w1) = (a.x * b.y, a.y * b.x);
    // Most rays pass some edge on the left and some on the right for certain.
    let left = (u0 > u1) | (v0 > v1) | (w0 > w1);
    let right = (u0 < u1) | (v0 < v1) | (w0 < w1);
    if left & right {
        return None;
    }
    let turn = edge_side(a, b);
    if turn == 0 || edge_side(b, c) != turn || edge_side(c, a) != turn {
        return None;
    }
    let weights = DVec3::new(u0 - u1, v0 - v1, w0 - w1);
    let products = (u0.abs() + u1.abs()) + (v0.abs() + v1.abs()) + (w0.abs() + w1.abs());
    let hit = place(shear, [a, b, c], weights, products)?;
    Some((hit, shear.shows_front(turn > 0)))
}

/// On which side of the edge the origin is: the sign of the cross product of its ends, 0 only if the ends coincide
/// (or are not numbers). Changes its sign when the ends are exchanged.
#[inline]
fn edge_side(a: DVec3, b: DVec3) -> i8 {
    let (p, q) = (a.x * b.y, a.y * b.x);
    if p > q {
        1
    } else if p < q {
        -1
    } else {
        tied_edge_side(a, b)
    }
}

#[cold]
fn tied_edge_side(a: DVec3, b: DVec3) -> i8 {
    let exact = exact_cross(a, b);
    // The shift (e, e^2) changes the cross product by e (a_y - b_y) + e^2 (b_x - a_x).
    [exact, a.y - b.y, b.x - a.x]
        .into_iter()
        .find(|&x| x != 0.0)
        .map_or(0, |x| if x > 0.0 { 1 } else { -i8::from(x < 0.0) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use strahl_math::Ray;

    const CORNERS: [DVec3; 3] = [
        DVec3::new(0.0, 0.0, 5.0),
        DVec3::new(4.0, 0.0, 5.0),
        DVec3::new(0.0, 2.0, 5.0),
    ];

    #[test]
    fn a_tie_of_rounded_products_is_decided_exactly() {
        let a = DVec3::new(1.0 + f64::EPSILON, 1.0, 0.0);
        let b = DVec3::new(1.0, 1.0 - f64::EPSILON, 0.0);
        assert_eq!(a.x * b.y, a.y * b.x);
        assert_eq!((edge_side(a, b), edge_side(b, a)), (-1, 1));
    }

    #[test]
    fn a_fan_round_the_ray_is_passed_once() {
        // Every ray through the hub, the rim corners or the spokes of a closed fan in the plane.
        let rim: Vec<_> = [(3, 0), (2, 2), (0, 3), (-2, 1), (-3, -3), (1, -2)]
            .map(|(x, y)| DVec3::new(f64::from(x), f64::from(y), 1.0))
            .to_vec();
        for (i, target) in rim
            .iter()
            .map(|r| *r * 0.5)
            .chain([DVec3::ZERO])
            .enumerate()
        {
            let ray = Ray::new(DVec3::new(target.x, target.y, 0.0), DVec3::Z);
            let shear = RayShear::new(&ray);
            let image = |p: DVec3| shear.apply(&p);
            let passes = (0..rim.len())
                .filter(|&k| {
                    let (b, c) = (rim[k], rim[(k + 1) % rim.len()]);
                    pass_triangle(&shear, image(DVec3::Z), image(b), image(c)).is_some()
                })
                .count();
            assert_eq!(passes, 1, "target {i}");
        }
    }

    #[test]
    fn the_front_is_the_side_of_the_normal() {
        let [a, b, c] = CORNERS;
        for (z, front) in [(1.0, false), (-1.0, true)] {
            let ray = Ray::new(DVec3::new(1.0, 0.5, 5.0 - 3.0 * z), DVec3::Z * z);
            let shear = RayShear::new(&ray);
            let pass = pass_triangle(&shear, shear.apply(&a), shear.apply(&b), shear.apply(&c));
            assert_eq!(pass.map(|(hit, front)| (hit.t, front)), Some((3.0, front)));
        }
    }
}
