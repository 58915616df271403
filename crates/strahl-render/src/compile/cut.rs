//! Parts of flat primitives, for builders that split long thin ones.

use strahl_math::{Aabb, DVec3};

/// Boxes around the parts of a flat polygon below and above a plane across an axis, where only the part within the box `part`
/// counts. Each surrounds the corners on its side and the points where edges cross the plane, and is not larger than `part`.
///
/// Watertight: every point of the polygon is on one of the sides, points in the plane are on both. The crossings of edges with
/// the plane are computed in f64 and padded by more than the rounding error. A point beside the polygon that counts as a hit
/// because of the rounding of the intersection test is as close to one of the parts as to the whole, and culling allows for
/// that.
pub(super) fn halves(corners: &[DVec3], part: &Aabb, axis: usize, at: f64) -> [Aabb; 2] {
    let (mut lower, mut upper) = (Aabb::EMPTY, Aabb::EMPTY);
    let point = |p: DVec3| Aabb::new(p, p);
    for (i, b) in corners.iter().enumerate() {
        let a = &corners[(i + corners.len() - 1) % corners.len()];
        if b[axis] <= at {
            lower = lower.union(&point(*b));
        }
        if b[axis] >= at {
            upper = upper.union(&point(*b));
        }
        if (a[axis] < at && at < b[axis]) || (b[axis] < at && at < a[axis]) {
            let crossing = *a + (*b - *a) * ((at - a[axis]) / (b[axis] - a[axis]));
            let error = (a.abs() + b.abs()) * (4.0 * f64::EPSILON);
            let (mut min, mut max) = (crossing - error, crossing + error);
            (min[axis], max[axis]) = (at, at);
            lower = lower.union(&Aabb::new(min, max));
            upper = upper.union(&Aabb::new(min, max));
        }
    }
    [lower, upper].map(|b| Aabb::new(b.min.max(part.min), b.max.min(part.max)))
}

/// Half the surface area of boxes around ever smaller parts of a flat polygon: the sum of its projections along the axes.
pub(super) fn flat_area(corners: &[DVec3]) -> f64 {
    let Some(first) = corners.first() else {
        return 0.0;
    };
    let fan = corners.windows(2);
    let twice: DVec3 = fan.map(|c| (c[0] - *first).cross(c[1] - *first)).sum();
    let seen = twice.abs() * 0.5;
    seen.x + seen.y + seen.z
}

#[cfg(test)]
mod tests {
    use super::*;

    /// However often a triangle is split, its boxes contain all its points; and hardly anything else, if it is thin.
    #[test]
    fn the_parts_cover_the_triangle() {
        for (third, most) in [
            (DVec3::new(2.2, 6.8, 3.3), 2.0),
            (DVec3::new(4.0, 1.4, 3.0), 0.2),
        ] {
            let corners = [DVec3::new(0.3, 0.2, 0.1), DVec3::new(7.7, 2.4, 5.9), third];
            let whole = Aabb::from_points(corners);
            let mut parts = vec![whole];
            for round in 0..9 {
                let cut = |part: &Aabb| {
                    let axis = round % 3;
                    halves(&corners, part, axis, part.center()[axis])
                };
                parts = parts
                    .iter()
                    .flat_map(cut)
                    .filter(|p| !p.is_empty())
                    .collect();
            }
            for i in 0..=200 {
                for j in 0..=200 - i {
                    let (u, v) = (f64::from(i) / 200.0, f64::from(j) / 200.0);
                    let p = corners[0] * (1.0 - u - v) + corners[1] * u + corners[2] * v;
                    let slack = DVec3::splat(1e-12);
                    let has = |part: &Aabb| {
                        (part.min - slack).cmple(p).all() && p.cmple(part.max + slack).all()
                    };
                    assert!(parts.iter().any(has), "{p}");
                }
            }
            let half_area = |b: &Aabb| {
                let s = b.size();
                s.x * s.y + s.y * s.z + s.z * s.x
            };
            let all: f64 = parts.iter().map(half_area).sum();
            assert!(all < most * half_area(&whole), "{all}");
            assert!(all > flat_area(&corners), "{all}");
        }
    }

    #[test]
    fn what_lies_in_the_plane_is_on_both_sides() {
        let square = [DVec3::ZERO, DVec3::X, DVec3::X + DVec3::Y, DVec3::Y];
        let whole = Aabb::from_points(square);
        assert_eq!(halves(&square, &whole, 2, 0.0), [whole, whole]);
        let [lower, upper] = halves(&square, &whole, 0, 1.0);
        assert_eq!(lower, whole);
        assert_eq!((upper.min.x, upper.max.x, upper.max.y), (1.0, 1.0, 1.0));
        assert!(halves(&square, &whole, 0, 1.5)[1].is_empty());
        assert_eq!(flat_area(&square), 1.0);
    }
}
