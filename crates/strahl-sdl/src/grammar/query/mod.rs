//! Functions of scenes that query objects: `inside`, `trace`, `min_extent`, `max_extent`.

mod mesh;

use super::Thing;
use super::entity::Declared;
use super::objects::{expanded, told_extent};
use crate::keywords::Word;
use crate::parser::{PResult, Parser, Place};
use crate::symbol::Symbol;
use crate::token::Kind;
use crate::value::{Value, Vector};
use mesh::SearchableMesh;
use std::sync::Arc;
use strahl_function::{Cost, ScalarField};
use strahl_geometry::{Csg, CsgNode, Primitive, Scratch, Shape, Solid};
use strahl_math::{DVec3, Interval, Ray};
use strahl_scene::{CsgOp, Object, ObjectKind};

/// An object prepared for queries.
#[derive(Debug)]
pub(crate) struct Query {
    csg: Csg,
    /// The cost of testing whether a point is inside.
    cost: Cost,
    /// The part of that cost spent in its functions.
    functions: u64,
}

impl Query {
    /// `None` if the object is empty or a shape is invalid.
    pub(super) fn new(object: &Object) -> Option<Self> {
        let csg = Csg::try_new(node(object)?).ok()?;
        let (cost, functions) = cost(object);
        Some(Self {
            csg,
            cost,
            functions,
        })
    }

    /// The cost of testing whether a point is inside.
    pub(super) fn cost(&self) -> Cost {
        self.cost
    }

    pub(super) fn contains(&self, point: DVec3) -> bool {
        self.csg.contains(point)
    }

    /// The first hit of a ray, with the unit normal.
    fn trace(&self, origin: DVec3, direction: DVec3) -> Option<(DVec3, DVec3)> {
        let ray = Ray::new(origin, direction);
        let scratch = &mut Scratch::default();
        let hit = self
            .csg
            .closest_hit(&ray, Interval::FORWARD, None, scratch)?;
        let point = self.csg.surface_at(&ray, &hit);
        Some((point.position, point.n_shade))
    }
}

/// The CSG tree of a whole object; `None` if it is empty. The traversal uses a list, because trees may be deeper than the stack.
fn node(object: &Object) -> Option<CsgNode> {
    enum Step<'a> {
        Visit(&'a Object),
        Build(&'a Object, CsgOp, usize),
    }
    let mut steps = vec![Step::Visit(object)];
    let mut done: Vec<CsgNode> = vec![];
    while let Some(step) = steps.pop() {
        let (object, node) = match step {
            Step::Visit(object) => match &object.kind {
                ObjectKind::Csg { children, .. } if children.0.is_empty() => return None,
                ObjectKind::Csg { op, children } => {
                    let is_light = |c: &&Object| matches!(c.kind, ObjectKind::Light(_));
                    let lights = children.0.iter().filter(is_light).count();
                    steps.push(Step::Build(object, *op, children.0.len() - lights));
                    let parts = children.0.iter().rev().filter(|c| !is_light(c));
                    steps.extend(parts.map(Step::Visit));
                    continue;
                }
                ObjectKind::Shape(Shape::TriangleMesh(mesh)) => {
                    let mesh: Arc<dyn Primitive> = Arc::new(SearchableMesh::new(Arc::clone(mesh)));
                    (object, CsgNode::leaf(mesh, 0))
                }
                ObjectKind::Shape(shape) => (object, CsgNode::leaf(Shape::clone(shape), 0)),
                ObjectKind::Instance(_) | ObjectKind::Light(_) => return None,
            },
            Step::Build(object, op, count) => {
                let mut parts = done.split_off(done.len() - count);
                if op == CsgOp::Bound {
                    parts.truncate(1);
                }
                let operands = parts.into();
                let node = match op {
                    CsgOp::Union | CsgOp::Bound | CsgOp::LightGroup { .. } => {
                        CsgNode::Union(operands)
                    }
                    CsgOp::Merge => CsgNode::Merge(operands),
                    CsgOp::Intersection => CsgNode::Intersection(operands),
                    CsgOp::Difference => CsgNode::Difference(operands),
                    CsgOp::Inverse => CsgNode::Inverse(operands),
                    CsgOp::Clip => CsgNode::Clip(operands),
                };
                (object, node)
            }
        };
        done.push(match object.transform.as_deref() {
            Some(map) => node.transformed(*map),
            None => node,
        });
    }
    done.pop()
}

/// The cost of testing a point against all shapes of an object, and the part of it spent in functions.
fn cost(object: &Object) -> (Cost, u64) {
    let mut cost = Cost::FORMULA;
    let mut functions = 0_u64;
    let mut objects = vec![object];
    while let Some(object) = objects.pop() {
        match &object.kind {
            ObjectKind::Csg { children, .. } => objects.extend(&children.0),
            ObjectKind::Shape(Shape::Isosurface(surface)) => {
                let function = ScalarField::cost(surface.function());
                functions = functions.saturating_add(function.operations);
                cost = cost.and(function);
            }
            _ => cost = cost.and(Cost::FORMULA),
        }
    }
    (cost.around(), functions)
}

impl Parser<'_> {
    /// `inside(Object, point)`, from after its opening parenthesis.
    pub(crate) fn ask_inside(&mut self) -> PResult<bool> {
        let object = self.object_argument()?;
        let point = self.vector3()?;
        let query = self.query(&object)?;
        self.spend_on(query.as_deref(), 1)?;
        Ok(query.is_some_and(|q| q.contains(point)))
    }

    /// `min_extent(Object)` and `max_extent(Object)`, from after the opening parenthesis; unbounded objects extend to 1e10, as in
    /// POV-Ray.
    pub(crate) fn ask_extent(&mut self, word: Word) -> PResult<DVec3> {
        const FAR: DVec3 = DVec3::splat(1e10);
        let object = self.object_argument()?;
        let bounds = object
            .extent
            .get_or_init(|| told_extent(&object.entity.object, &self.state.shared));
        let corner = match word {
            _ if bounds.is_empty() => DVec3::ZERO,
            Word::MinExtent => bounds.min,
            _ => bounds.max,
        };
        // Adding 0 turns -0 into 0.
        Ok(corner.clamp(-FAR, FAR) + DVec3::ZERO)
    }

    /// `trace(Object, origin, direction [, Normal])`, from after the opening parenthesis: the first point of the object on the
    /// ray, or the origin of space; the variable `Normal` gets the unit normal there, or zero.
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
        if !(length.is_finite() && origin.is_finite()) {
            return Err(self.fail(place, "`trace` needs a finite point and a finite direction"));
        }
        // As in POV-Ray, a ray with direction zero hits nothing.
        let query = match length {
            0.0 => None,
            _ => self.query(&object)?,
        };
        /// Intersecting a ray with an implicit surface evaluates its function at about this many points.
        const POINTS: u64 = 64;
        self.spend_on(query.as_deref(), POINTS)?;
        let hit = query.and_then(|q| q.trace(origin, direction));
        if let Some(symbol) = normal_of {
            let normal = hit.map_or(DVec3::ZERO, |(_, n)| n);
            self.store_normal(symbol, normal);
        }
        Ok(hit.map_or(DVec3::ZERO, |(point, _)| point))
    }

    /// Counts the cost of evaluating functions at this many points.
    fn spend_on(&mut self, query: Option<&Query>, points: u64) -> PResult<()> {
        let operations = query.map_or(0, |q| q.functions);
        self.spend(operations.saturating_mul(points))
    }

    fn store_normal(&mut self, symbol: Symbol, normal: DVec3) {
        let found = self.scopes.target(symbol, false);
        let target = found.unwrap_or_else(|| self.global_target(symbol));
        self.scopes
            .store(&target, Value::Vector(Vector::from(normal)));
    }

    /// An object as the first argument of a function, and the comma after it.
    fn object_argument(&mut self) -> PResult<Arc<Declared>> {
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

    /// The prepared object, built once for all queries; `None` if it has no surface.
    ///
    /// # Errors
    /// If it has too many parts.
    pub(super) fn query(&mut self, declared: &Declared) -> PResult<Option<Arc<Query>>> {
        if declared.query.get().is_none() {
            self.count_objects(declared.tally.expanded)?;
        }
        let made = declared.query.get_or_init(|| {
            let object = expanded(&declared.entity.object, &self.state.shared);
            Query::new(&object).map(Arc::new)
        });
        Ok(made.clone())
    }
}
