//! CSG trees: one primitive each.

use super::bounds::bounded;
use super::flatten::{FlatGroup, Pass, shape_at, visible};
use super::inherit::Todo;
use super::inside;
use crate::look::{Look, Looks};
use crate::prim::Prim;
use std::sync::Arc;
use strahl_geometry::{Csg, CsgNode, Primitive};
use strahl_scene::{CsgOp, Diagnostic, Object, ObjectKind};

impl Pass {
    /// A CSG tree becomes one primitive whose leaves know their objects and materials.
    pub(super) fn csg(&mut self, todo: &Todo<'_>, group: &mut FlatGroup) {
        let errors_before = self.errors.len();
        let mut looks = Vec::new();
        let Some(node) = self.csg_node(todo, &mut looks) else {
            return;
        };
        if self.errors.len() > errors_before {
            return;
        }
        match Csg::try_new(node) {
            Err(error) => self.invalid(todo, "CSG object", &error),
            Ok(csg) => {
                let flags = looks
                    .iter()
                    .fold(0, |f, look| f | self.flags(todo, look.material));
                let looks = Looks::of_leaves(looks, todo.body.unwrap_or(0));
                let visible = visible(todo.visibility);
                group.add_shape(Arc::new(csg).into(), looks, visible, flags);
                if flags & Prim::FILLED != 0
                    && let Some(used) = group.shapes.last_mut()
                {
                    used.inside = inside::of(todo.object, &todo.transform).map(Box::new);
                }
            }
        }
    }

    /// Translates a tree of objects, bottom-up with a stack of its own.
    fn csg_node(&mut self, root: &Todo<'_>, looks: &mut Vec<Look>) -> Option<CsgNode> {
        enum Step<'a> {
            Visit(Box<Todo<'a>>),
            Combine(CsgOp, usize),
        }
        let mut steps = vec![Step::Visit(Box::new(root.clone()))];
        let mut done: Vec<CsgNode> = Vec::new();
        while let Some(step) = steps.pop() {
            match step {
                Step::Combine(op, count) => {
                    let children = done.split_off(done.len() - count);
                    done.push(combine(op, children));
                }
                Step::Visit(mut todo) => {
                    self.number_body(&mut todo);
                    match &todo.object.kind {
                        ObjectKind::Csg {
                            op: CsgOp::Bound,
                            children,
                        } => {
                            let inner = self.bounded_part(children, &mut todo)?;
                            let inner = Todo::new(inner, Some(&todo));
                            steps.push(Step::Visit(Box::new(inner)));
                        }
                        ObjectKind::Csg { op, children } => {
                            // Lights among the operands shine, but are not operands.
                            let is_light = |c: &Object| matches!(c.kind, ObjectKind::Light(_));
                            let count = children.0.iter().filter(|c| !is_light(c)).count();
                            let children = self.union_parts(*op, children, &mut todo);
                            if let Some(problem) = wrong_count(*op, count) {
                                self.errors.push(Diagnostic::error(problem).at(todo.span));
                                return None;
                            }
                            steps.push(Step::Combine(*op, count));
                            steps.extend(
                                children
                                    .rev()
                                    .map(|c| Step::Visit(Box::new(Todo::new(c, Some(&todo))))),
                            );
                        }
                        ObjectKind::Light(light) => self.light(light, &todo),
                        ObjectKind::Shape(shape) => {
                            if let Err(error) = shape.validate() {
                                self.invalid(&todo, shape.kind(), &error);
                            }
                            looks.push(self.look(&todo, shape.kind()));
                            let tag = looks.len() as u32 - 1;
                            let transform =
                                (!todo.transform.is_identity()).then(|| Box::new(todo.transform));
                            let here = shape_at(shape, &todo.transform);
                            let shape = here.as_ref().unwrap_or(shape);
                            done.push(CsgNode::Leaf {
                                shape: bounded(shape, &todo.bounds, &todo.transform)
                                    .unwrap_or_else(|| shape.clone()),
                                transform,
                                tag,
                            });
                        }
                        ObjectKind::Instance(_) => {
                            let message = "a group cannot be instanced inside of a CSG object other than a union; \
                                       repeat its objects instead";
                            self.errors.push(Diagnostic::error(message).at(todo.span));
                            return None;
                        }
                    }
                }
            }
        }
        done.pop()
    }
}

pub(super) fn wrong_count(op: CsgOp, count: usize) -> Option<String> {
    let (right, expected) = match op {
        CsgOp::Inverse => (count == 1, "exactly one object"),
        CsgOp::Clip => (count >= 2, "an object and at least one to clip it by"),
        CsgOp::Bound => (count >= 2, "an object and at least one to bound it by"),
        CsgOp::Union
        | CsgOp::Merge
        | CsgOp::Intersection
        | CsgOp::Difference
        | CsgOp::LightGroup { .. } => (count >= 1, "at least one object"),
    };
    (!right).then(|| format!("{} takes {expected}, found {count}", op.name()))
}

/// The operation without regard to who sees the result.
pub(super) fn combine(op: CsgOp, children: Vec<CsgNode>) -> CsgNode {
    let count = if op == CsgOp::Bound {
        1
    } else {
        children.len()
    };
    let operands = children.into_iter().take(count).collect();
    match op {
        CsgOp::Union | CsgOp::Bound | CsgOp::LightGroup { .. } => CsgNode::Union(operands),
        CsgOp::Merge => CsgNode::Merge(operands),
        CsgOp::Intersection => CsgNode::Intersection(operands),
        CsgOp::Difference => CsgNode::Difference(operands),
        CsgOp::Inverse => CsgNode::Inverse(operands),
        CsgOp::Clip => CsgNode::Clip(operands),
    }
}
