//! Finds the face by which a ray leaves a cell.

use crate::walk::Walk;
use strahl_math::Aabb;

/// How a ray leaves a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Leaving {
    /// The axis of the exit face.
    pub(super) axis: usize,
    /// Where.
    pub(super) t: f64,
    /// The region of the trial exit plane, if one was used.
    pub(super) region: Option<u8>,
}

/// The plane by which a ray can leave a cell along an axis.
#[inline(always)]
pub(super) fn exit_plane(walk: &Walk, cell: &Aabb, axis: usize) -> f64 {
    if walk.up(axis) {
        cell.max[axis]
    } else {
        cell.min[axis]
    }
}

/// The first of the three faces ahead; of several at the same `t` that of the first axis.
#[inline(always)]
pub(super) fn by_three_faces(walk: &Walk, cell: &Aabb) -> Leaving {
    let t = [0, 1, 2].map(|axis| walk.cross(axis, exit_plane(walk, cell, axis)));
    let axis = usize::from(t[1] < t[0]);
    let axis = if t[2] < t[axis] { 2 } else { axis };
    Leaving {
        axis,
        t: t[axis],
        region: None,
    }
}

/// The axis whose face is tried first, the same for all cells: that of the largest component of the direction; of equal
/// components, the first.
pub(super) fn trial_axis(walk: &Walk) -> usize {
    let speed = walk.moved.direction.abs();
    let axis = usize::from(speed.y > speed.x);
    if speed.z > speed[axis] { 2 } else { axis }
}

/// Tries one face: computes the intersection of the ray with its plane and determines the region of that point.
///
/// ```text
///      7 | 3 | 8        region 0: inside the face, which is the exit
///     ---+---+---       1 to 4: beyond an edge, the exit is the face behind that edge
///      1 | 0 | 2        5 to 8: beyond a corner, the exit is one of two faces: the one the ray
///     ---+---+---               meets first
///      5 | 4 | 6
/// ```
/// The other two axes are u to the right and v upwards, in the order of the axes. Points on an edge belong to region 0: the ray
/// leaves by two faces at once, and either will do.
#[inline(always)]
pub(super) fn by_trial_plane(walk: &Walk, cell: &Aabb, trial: usize) -> Leaving {
    let t = walk.cross(trial, exit_plane(walk, cell, trial));
    let p = walk.moved.at(t);
    let [u, v] = OTHERS[trial];
    let beyond = |axis: usize| side(p[axis], cell.min[axis], cell.max[axis]);
    let region = region(beyond(u), beyond(v));
    let by = |axis: usize| (axis, walk.cross(axis, exit_plane(walk, cell, axis)));
    let (axis, t) = match region {
        0 => (trial, t),
        1 | 2 => by(u),
        3 | 4 => by(v),
        _ => {
            let (a, b) = (by(u), by(v));
            if b.1 < a.1 { b } else { a }
        }
    };
    Leaving {
        axis,
        t,
        region: Some(region),
    }
}

/// The other two axes.
const OTHERS: [[usize; 2]; 3] = [[1, 2], [0, 2], [0, 1]];

/// Before (-1), in (0) or beyond (1) a range.
#[inline(always)]
fn side(x: f64, min: f64, max: f64) -> i8 {
    i8::from(x > max) - i8::from(x < min)
}

/// The number of the region, see [`by_trial_plane`].
#[inline(always)]
fn region(u: i8, v: i8) -> u8 {
    match (u, v) {
        (0, 0) => 0,
        (-1, 0) => 1,
        (1, 0) => 2,
        (0, 1) => 3,
        (0, _) => 4,
        (-1, -1) => 5,
        (1, -1) => 6,
        (-1, _) => 7,
        _ => 8,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::walk::Room;
    use strahl_math::{DVec3, Interval, Ray};

    const CELL: Aabb = Aabb::new(DVec3::ZERO, DVec3::ONE);

    /// A ray from one point through another, in a room around the cell.
    fn walk(from: DVec3, through: DVec3) -> Walk {
        let room = Room::new(Aabb::new(DVec3::splat(-8.0), DVec3::splat(8.0)));
        Walk::new(&Ray::new(from, through - from), Interval::FORWARD, &room).expect("in the room")
    }

    /// Rays from inside the cell through points of the plane of its upper face, along every axis in both directions.
    fn all_ways(u: f64, v: f64) -> Vec<(usize, bool, Leaving, Leaving)> {
        let mut ways = Vec::new();
        for trial in 0..3 {
            for up in [false, true] {
                let [a, b] = OTHERS[trial];
                let (mut from, mut through) = (DVec3::splat(0.5), DVec3::ZERO);
                (from[trial], through[trial]) = if up { (0.25, 1.0) } else { (0.75, 0.0) };
                (through[a], through[b]) = (u, v);
                let w = walk(from, through);
                ways.push((
                    trial,
                    up,
                    by_trial_plane(&w, &CELL, trial),
                    by_three_faces(&w, &CELL),
                ));
            }
        }
        ways
    }

    #[test]
    fn every_region_finds_the_exit_of_the_three_faces() {
        for (u, v, region) in [
            (0.3, 0.6, 0),
            (-0.5, 0.6, 1),
            (1.5, 0.6, 2),
            (0.3, 1.7, 3),
            (0.3, -0.7, 4),
            (-0.5, -0.7, 5),
            (1.5, -0.7, 6),
            (-0.5, 1.7, 7),
            (1.5, 1.7, 8),
        ] {
            for (trial, up, tried, full) in all_ways(u, v) {
                let [a, b] = OTHERS[trial];
                assert_eq!(tried.region, Some(region), "axis {trial} {up}");
                assert_eq!(
                    (tried.axis, tried.t),
                    (full.axis, full.t),
                    "{u} {v} axis {trial} {up}"
                );
                let expected = match region {
                    0 => trial,
                    1 | 2 => a,
                    // v is further outside than u in all the corners above.
                    _ => b,
                };
                assert_eq!(tried.axis, expected);
            }
        }
    }

    #[test]
    fn beyond_a_corner_either_side_may_be_the_exit() {
        for (u, v, which) in [
            (1.9, 1.2, 0),
            (1.2, 1.9, 1),
            (-0.9, -0.2, 0),
            (-0.2, 1.9, 1),
        ] {
            for (trial, _, tried, full) in all_ways(u, v) {
                assert_eq!(tried.axis, OTHERS[trial][which]);
                assert_eq!(tried.t, full.t);
            }
        }
    }

    /// Edges and corners of the face, and the diagonals behind its corners: two or three faces at once.
    #[test]
    fn ties_leave_at_the_same_place_by_one_of_the_faces() {
        for u in [0.0, 0.5, 1.0] {
            for v in [0.0, 0.5, 1.0] {
                for (_, _, tried, full) in all_ways(u, v) {
                    assert_eq!((tried.t, tried.region), (full.t, Some(0)), "{u} {v}");
                }
            }
        }
        for (u, v, region) in [
            (-0.5, -0.5, 5),
            (1.5, -0.5, 6),
            (-0.5, 1.5, 7),
            (1.5, 1.5, 8),
        ] {
            for (trial, _, tried, full) in all_ways(u, v) {
                assert_eq!((tried.t, tried.region), (full.t, Some(region)));
                assert_eq!(tried.axis, OTHERS[trial][0], "the first axis");
            }
        }
    }

    #[test]
    fn a_ray_along_an_axis_leaves_by_its_face() {
        for axis in 0..3 {
            let mut through = DVec3::splat(0.5);
            through[axis] = 1.0;
            let w = walk(DVec3::splat(0.5), through);
            assert_eq!(trial_axis(&w), axis);
            assert_eq!(by_three_faces(&w, &CELL).axis, axis);
            let tried = by_trial_plane(&w, &CELL, axis);
            assert_eq!((tried.axis, tried.region), (axis, Some(0)));
            // The plane of another face is met at infinity only, beyond the edge of the true exit.
            let other = by_trial_plane(&w, &CELL, (axis + 1) % 3);
            assert_eq!((other.axis, other.t), (axis, tried.t));
        }
    }

    /// The trial plane is perpendicular to the largest component of the direction, whatever the shape of the cells.
    #[test]
    fn the_trial_plane_is_that_of_the_largest_component() {
        for (through, axis) in [
            (DVec3::new(3.0, 2.0, 1.0), 0),
            (DVec3::new(-2.0, -3.0, 1.0), 1),
            (DVec3::new(1.0, 2.0, -3.0), 2),
            // Of equal components, the first.
            (DVec3::new(1.0, -1.0, 1.0), 0),
            (DVec3::new(0.5, 1.0, 1.0), 1),
        ] {
            let w = walk(DVec3::ZERO, through);
            assert_eq!(trial_axis(&w), axis);
            // The same in a flat cell, where the ray leaves through another face: beyond an edge or a corner of the trial face.
            let flat = Aabb::new(DVec3::splat(-4.0), DVec3::new(4.0, 0.1, 4.0));
            let (tried, full) = (by_trial_plane(&w, &flat, axis), by_three_faces(&w, &flat));
            assert_eq!((tried.axis, tried.t), (full.axis, full.t), "{through}");
        }
    }
}
