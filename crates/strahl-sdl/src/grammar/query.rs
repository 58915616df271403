//! What scenes ask of their own objects: `inside`, `trace`, `min_extent`, `max_extent`.

use super::Thing;
use crate::keywords::Word;
use crate::parser::{PResult, Parser, Place};
use crate::symbol::Symbol;
use crate::token::Kind;
use crate::value::{Value, Vector};
use std::sync::Arc;
use strahl_geometry::{Primitive, Scratch};
use strahl_math::{Aabb, DVec3, Interval, Ray};
use strahl_scene::{CsgOp, Object, ObjectKind};

/// Objects nested deeper than this answer nothing: the questions recurse.
const DEPTH: u32 = 500;

/// Whether a point is inside of an object; open surfaces have no inside.
fn inside(object: &Object, point: DVec3, depth: u32) -> bool {
    if depth == 0 {
        return false;
    }
    let point = match &object.transform {
        Some(transform) => transform.point_to_object(point),
        None => point,
    };
    let (op, children) = match &object.kind {
        ObjectKind::Shape(shape) => {
            return shape.as_solid().is_some_and(|solid| solid.contains(point));
        }
        ObjectKind::Csg { op, children } => (*op, children.0.as_slice()),
        ObjectKind::Instance(_) => return false,
    };
    let test = |child: &Object| inside(child, point, depth - 1);
    match (op, children) {
        (CsgOp::Union | CsgOp::Merge, all) => all.iter().any(test),
        (CsgOp::Intersection | CsgOp::Clip, all) => all.iter().all(test),
        (CsgOp::Difference, [first, rest @ ..]) => test(first) && !rest.iter().any(test),
        (CsgOp::Difference, []) => false,
        (CsgOp::Inverse, all) => !all.iter().any(test),
    }
}

/// A box around an object.
fn bounds(object: &Object, depth: u32) -> Aabb {
    if depth == 0 {
        return Aabb::EVERYTHING;
    }
    let own = match &object.kind {
        ObjectKind::Shape(shape) => shape.bounds(),
        ObjectKind::Instance(_) => Aabb::EVERYTHING,
        ObjectKind::Csg { op, children } => {
            let boxes = children.0.iter().map(|child| bounds(child, depth - 1));
            match op {
                CsgOp::Union | CsgOp::Merge => boxes.fold(Aabb::EMPTY, |a, b| a.union(&b)),
                CsgOp::Intersection | CsgOp::Clip => {
                    boxes.fold(Aabb::EVERYTHING, |a, b| a.intersection(&b))
                }
                CsgOp::Difference => boxes.take(1).fold(Aabb::EMPTY, |a, b| a.union(&b)),
                CsgOp::Inverse => Aabb::EVERYTHING,
            }
        }
    };
    match &object.transform {
        Some(transform) => transform.bounds_to_world(&own),
        None => own,
    }
}

/// The first hit behind `after`: its parameter and a normal of any length.
fn next_hit(object: &Object, ray: &Ray, after: f64, depth: u32) -> Option<(f64, DVec3)> {
    /// Surfaces passed that are not part of the combined object.
    const PASSED: usize = 10_000;
    if depth == 0 {
        return None;
    }
    let local = match &object.transform {
        Some(transform) => transform.ray_to_object(ray),
        None => *ray,
    };
    let hit = match &object.kind {
        ObjectKind::Instance(_) => None,
        ObjectKind::Shape(shape) => {
            let range = Interval::new(after, f64::INFINITY);
            let hit = shape.closest_hit(&local, range, None, &mut Scratch::default());
            hit.map(|hit| (hit.t, shape.surface_at(&local, &hit).n_geom))
        }
        ObjectKind::Csg { op, children } => {
            let children = children.0.as_slice();
            let mut after = after;
            let mut found = None;
            for _ in 0..PASSED {
                let hits = children.iter().enumerate().filter_map(|(index, child)| {
                    next_hit(child, &local, after, depth - 1).map(|(t, n)| (index, t, n))
                });
                let first = hits.reduce(|a, b| if b.1 < a.1 { b } else { a });
                let Some((hit, t, normal)) = first else {
                    break;
                };
                if is_surface(*op, children, hit, local.at(t), depth) {
                    found = Some((t, normal));
                    break;
                }
                after = t;
            }
            found
        }
    };
    match &object.transform {
        Some(transform) => hit.map(|(t, normal)| (t, transform.normal_to_world(normal))),
        None => hit,
    }
}

/// Whether a point on the surface of child number `hit` is on the surface of the combined object.
fn is_surface(op: CsgOp, children: &[Object], hit: usize, point: DVec3, depth: u32) -> bool {
    let mut others = children.iter().enumerate().filter(|(i, _)| *i != hit);
    let test = |child: &Object| inside(child, point, depth - 1);
    match op {
        CsgOp::Union | CsgOp::Inverse => true,
        CsgOp::Merge => !others.any(|(_, child)| test(child)),
        CsgOp::Intersection => others.all(|(_, child)| test(child)),
        CsgOp::Clip => hit == 0 && others.all(|(_, child)| test(child)),
        CsgOp::Difference => others.all(|(i, child)| test(child) == (i == 0)),
    }
}

impl Parser<'_> {
    /// `inside(Object, point)` behind its parenthesis.
    pub(crate) fn ask_inside(&mut self) -> PResult<bool> {
        let object = self.object_argument()?;
        let point = self.vector3()?;
        Ok(inside(&object, point, DEPTH))
    }

    /// `min_extent(Object)` and `max_extent(Object)` behind the parenthesis; unbounded objects reach to 1e10, as in
    /// POV-Ray.
    pub(crate) fn ask_extent(&mut self, word: Word) -> PResult<DVec3> {
        const FAR: DVec3 = DVec3::splat(1e10);
        let object = self.object_argument()?;
        let b = bounds(&object, DEPTH);
        let corner = if word == Word::MinExtent {
            b.min
        } else {
            b.max
        };
        Ok(corner.clamp(-FAR, FAR))
    }

    /// `trace(Object, origin, direction [, Normal])` behind the parenthesis: the first point of the object on the ray, or the
    /// origin of space; `Normal`, a variable, gets the unit normal there, or zero.
    pub(crate) fn ask_trace(&mut self, place: Place) -> PResult<DVec3> {
        let object = self.object_argument()?;
        let origin = self.vector3()?;
        self.comma()?;
        let direction = self.vector3()?;
        let normal_of = if self.accept(Kind::Comma)? {
            Some(self.raw_name("a variable for the normal")?)
        } else {
            None
        };
        let length = direction.length();
        if !(length > 0.0 && length.is_finite() && origin.is_finite()) {
            return Err(self.fail(place, "`trace` needs a direction that is not zero"));
        }
        let ray = Ray::new(origin, direction);
        let hit = next_hit(&object, &ray, 0.0, DEPTH);
        if let Some(symbol) = normal_of {
            let normal = hit.map_or(DVec3::ZERO, |(_, n)| n.normalize_or_zero());
            self.store_normal(symbol, normal);
        }
        Ok(hit.map_or(DVec3::ZERO, |(t, _)| ray.at(t)))
    }

    fn store_normal(&mut self, symbol: Symbol, normal: DVec3) {
        let found = self.scopes.target(symbol, false);
        let target = found.unwrap_or_else(|| self.global_target(symbol));
        self.scopes
            .store(&target, Value::Vector(Vector::from(normal)));
    }

    /// An object as the first argument of a function, with the comma behind it.
    fn object_argument(&mut self) -> PResult<Arc<Object>> {
        let token = self.peek()?;
        let place = self.place_of(token);
        let object = match self.value()? {
            Value::Thing(Thing::Object(object)) => object,
            other => {
                let found = other.describe();
                return Err(self.fail(place, format!("expected an object, found {found}")));
            }
        };
        self.comma()?;
        Ok(object)
    }
}
