//! The boxes around objects as POV-Ray has them: `min_extent` and `max_extent` tell them, and they decide how `bounded_by` acts.
//!
//! Measured: the box around a cylinder, a cone or a disc is the one around its upright form, turned with it; a sphere that is turned, moved and
//! scaled evenly stays one. What an operation is transformed by acts on the box around the untransformed operation. The box of what cuts or
//! bounds an object takes the place of the object's own if its volume is smaller. What is not bounded on all sides, such as a union with a
//! light, extends everywhere, but an intersection takes planes across the axes into account.

use super::reuse::Shared;
use strahl_geometry::{Primitive, Shape};
use strahl_math::{Aabb, DMat3, DVec3, Transform};
use strahl_scene::{CsgOp, Object, ObjectKind};

/// POV-Ray's boxes around flat objects are this thick.
const THICKNESS: f64 = 0.002;

/// POV-Ray's boxes around unbounded objects are this wide.
const WIDEST: f64 = 2e10;

/// A box counts as smaller than another if its volume is smaller by this factor: boxes of ours are padded for rounding.
const SMALLER: f64 = 1.0 - 1e-9;

/// Whether a box has a smaller volume than another.
pub(super) fn is_smaller(a: &Aabb, b: &Aabb) -> bool {
    volume(a) < SMALLER * volume(b)
}

fn volume(bounds: &Aabb) -> f64 {
    let size = bounds.size();
    let side = |length: f64| length.clamp(THICKNESS, WIDEST);
    side(size.x) * side(size.y) * side(size.z)
}

/// The box around an object, as `min_extent` and `max_extent` tell it: an inverted object has that of the object itself.
pub(in crate::grammar) fn told_extent(object: &Object, shared: &Shared) -> Aabb {
    let bounds = extent_within(object, CsgOp::Inverse, shared);
    if bounds.is_empty() || bounds.is_bounded() {
        bounds
    } else {
        Aabb::EVERYTHING
    }
}

/// The box around what an object is without operations of this kind on it, in the object's parent's space.
pub(super) fn extent_within(object: &Object, without: CsgOp, shared: &Shared) -> Aabb {
    let (mut inner, mut maps) = (object, vec![]);
    while let ObjectKind::Csg { op, children } = &inner.kind
        && *op == without
        && let Some(first) = children.0.first()
    {
        maps.push(inner.transform.as_deref());
        inner = first;
    }
    let outwards = maps.into_iter().rev();
    outwards.fold(extent(inner, shared), |bounds, map| moved(map, bounds))
}

/// The box around an object in its parent's space.
pub(super) fn extent(object: &Object, shared: &Shared) -> Aabb {
    extent_of(object.transform.as_deref(), &object.kind, shared)
}

/// The same in the object's own space.
pub(super) fn own_extent(kind: &ObjectKind, shared: &Shared) -> Aabb {
    extent_of(None, kind, shared)
}

/// A box after a transformation.
fn moved(map: Option<&Transform>, bounds: Aabb) -> Aabb {
    map.map_or(bounds, |map| map.bounds_to_world(&bounds))
}

/// The box around what is transformed. Walked with a list, since trees may be deeper than the stack.
fn extent_of(map: Option<&Transform>, kind: &ObjectKind, shared: &Shared) -> Aabb {
    enum Step<'a> {
        Visit(Option<Transform>, &'a ObjectKind),
        /// Of the last boxes, so many.
        Build(Option<Transform>, CsgOp, usize, Cut),
    }
    let mut steps = vec![Step::Visit(map.copied(), kind)];
    let mut done: Vec<Aabb> = vec![];
    while let Some(step) = steps.pop() {
        let bounds = match step {
            Step::Visit(map, ObjectKind::Csg { op, children }) => {
                let parts = match op {
                    CsgOp::Difference => children.0.get(..1).unwrap_or_default(),
                    _ => &children.0[..],
                };
                let cut = parts
                    .first()
                    .map_or(Cut::Smaller, |first| Cut::of(&first.kind));
                steps.push(Step::Build(map, *op, parts.len(), cut));
                let cuts = matches!(op, CsgOp::Clip | CsgOp::Bound);
                for (number, part) in parts.iter().enumerate().rev() {
                    let own = part.transform.as_deref().copied();
                    // What cuts keeps its place while the object is transformed, by the inverse.
                    let whole = match (own, map.filter(|_| cuts && number > 0)) {
                        (Some(own), Some(map)) => Some(own.then(&map)),
                        (own, map) => own.or(map),
                    };
                    steps.push(Step::Visit(whole, &part.kind));
                }
                continue;
            }
            Step::Visit(map, ObjectKind::Instance(id)) => moved(map.as_ref(), shared.extent(*id)),
            Step::Visit(map, ObjectKind::Shape(shape)) => around_shape(shape, map.as_ref()),
            Step::Visit(_, ObjectKind::Light(_)) => Aabb::EVERYTHING,
            Step::Build(map, op, count, how) => {
                let mut parts = done.split_off(done.len() - count).into_iter();
                let map = map.as_ref();
                let common = |a: Aabb, b: Aabb| a.intersection(&b);
                match op {
                    CsgOp::Inverse => Aabb::EVERYTHING,
                    CsgOp::Intersection => moved(map, parts.fold(Aabb::EVERYTHING, common)),
                    CsgOp::Clip | CsgOp::Bound => {
                        let own = moved(map, parts.next().unwrap_or(Aabb::EMPTY));
                        let cut = parts.fold(Aabb::EVERYTHING, common);
                        match how {
                            Cut::Nothing => own,
                            Cut::Common => own.intersection(&cut),
                            Cut::Smaller if is_smaller(&cut, &own) => cut,
                            Cut::Smaller => own,
                        }
                    }
                    _ => moved(map, parts.fold(Aabb::EMPTY, |a, b| a.union(&b))),
                }
            }
        };
        done.push(bounds);
    }
    done.pop().unwrap_or(Aabb::EMPTY)
}

/// How the boxes of what cuts an object change the object's own.
#[derive(Clone, Copy)]
enum Cut {
    Nothing,
    /// The smaller one counts.
    Smaller,
    /// What they have in common counts.
    Common,
}

impl Cut {
    fn of(kind: &ObjectKind) -> Self {
        match kind {
            ObjectKind::Shape(Shape::HeightField(_) | Shape::Blob(_)) => Self::Nothing,
            // The boxes of several cuts are one.
            ObjectKind::Shape(Shape::Quadric(_))
            | ObjectKind::Csg {
                op: CsgOp::Clip, ..
            } => Self::Common,
            _ => Self::Smaller,
        }
    }
}

/// The box around a transformed shape.
fn around_shape(shape: &Shape, map: Option<&Transform>) -> Aabb {
    let upright = match shape {
        Shape::Sphere(sphere) => {
            let scale = map.map_or(Some(1.0), |map| even_scale(&map.linear()));
            if let Some(scale) = scale {
                let center = sphere.center();
                let center = map.map_or(center, |map| map.point_to_world(center));
                let reach = DVec3::splat(scale * sphere.radius());
                return Aabb::new(center - reach, center + reach);
            }
            None
        }
        Shape::Cylinder(cylinder) => {
            let (base, apex) = (cylinder.base(), cylinder.apex());
            Some((base, apex - base, cylinder.radius(), (0.0, 1.0)))
        }
        Shape::Cone(cone) => {
            let (a, b) = (cone.base_radius(), cone.apex_radius());
            let (from, to, radius) = match a >= b {
                true => (cone.base(), cone.apex(), a),
                false => (cone.apex(), cone.base(), b),
            };
            Some((from, to - from, radius, (0.0, 1.0)))
        }
        Shape::Disc(disc) => {
            let half = 0.5 * THICKNESS;
            Some((disc.center(), -disc.normal(), disc.radius(), (-half, half)))
        }
        _ => None,
    };
    let Some((start, axis, radius, ends)) = upright else {
        let around = match shape {
            Shape::Blob(blob) => blob.reach(),
            _ => shape.bounds(),
        };
        return moved(map, around);
    };
    let [u, v] = sides(axis.normalize_or(DVec3::Z));
    let mut bounds = Aabb::EMPTY;
    for end in [ends.0, ends.1] {
        for (a, b) in [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)] {
            let corner = start + axis * end + (u * a + v * b) * radius;
            let corner = map.map_or(corner, |map| map.point_to_world(corner));
            bounds = bounds.union(&Aabb::new(corner, corner));
        }
    }
    bounds
}

/// The factor of a map that scales all lengths alike.
fn even_scale(linear: &DMat3) -> Option<f64> {
    const SLACK: f64 = 1e-9;
    let [x, y, z] = [linear.x_axis, linear.y_axis, linear.z_axis];
    let square = x.length_squared();
    let near = |a: f64, b: f64| (a - b).abs() <= SLACK * square;
    let is_even = near(y.length_squared(), square)
        && near(z.length_squared(), square)
        && [x.dot(y), y.dot(z), z.dot(x)].iter().all(|c| near(*c, 0.0));
    is_even.then(|| square.sqrt())
}

/// Where the x and the y axis are, once the z axis is turned to an axis as POV-Ray turns it: around z by the longitude of the axis, around y
/// by its angle to z, and around z by the longitude again (fitted to measured boxes).
fn sides(n: DVec3) -> [DVec3; 2] {
    let Some(across) = n.truncate().try_normalize() else {
        return [DVec3::X, DVec3::Y];
    };
    let (c, s) = (across.x, across.y);
    [
        DVec3::new(c * c * n.z - s * s, c * s * (n.z + 1.0), -n.x),
        DVec3::new(-c * s * (n.z + 1.0), c * c - s * s * n.z, n.y),
    ]
}
