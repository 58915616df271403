//! CSG trees: one primitive each.

use super::bounds::bounded;
use super::flatten::{FlatGroup, Pass, shape_at, visible};
use super::inherit::Todo;
use super::inside;
use super::operation::{combine, wrong_count};
use crate::appearance::{Appearance, Appearances};
use crate::prim::Prim;
use std::sync::Arc;
use strahl_geometry::{Csg, CsgNode, Primitive};
use strahl_scene::{CsgOp, Diagnostic, Object, ObjectKind};

impl Pass {
    /// A CSG tree becomes one primitive whose leaves know their objects and materials.
    pub(super) fn csg(&mut self, todo: &Todo<'_>, group: &mut FlatGroup) {
        let errors_before = self.errors.len();
        let mut appearances = Vec::new();
        let Some(node) = self.csg_node(todo, &mut appearances) else {
            return;
        };
        if self.errors.len() > errors_before {
            return;
        }
        let flags = appearances
            .iter()
            .fold(0, |f, appearance| f | self.flags(todo, appearance.material));
        let both = Prim::TRANSMITS | Prim::STOPS;
        let flags = match flags & both == both {
            true => flags | Prim::TOGETHER,
            false => flags,
        };
        let appearances = Appearances::of_leaves(appearances, todo.body.unwrap_or(0));
        let visible = visible(todo.visibility);
        let filled = flags & Prim::FILLED != 0;
        let mut inside = filled
            .then(|| inside::of(todo.object, &todo.transform))
            .flatten();
        // The inside belongs to the whole: if it is not known by itself, a filled solid stays one. Otherwise one part has it.
        let parts = if filled && inside.is_none() {
            vec![node]
        } else {
            clipped_parts(node)
        };
        let mut flags = flags;
        for part in parts {
            match Csg::try_new(part) {
                Err(error) => return self.invalid(todo, "CSG object", &error),
                Ok(csg) => {
                    group.add_shape(Arc::new(csg).into(), appearances.clone(), visible, flags)
                }
            }
            if let (Some(inside), Some(used)) = (inside.take(), group.shapes.last_mut()) {
                used.inside = Some(Box::new(inside));
                flags &= !Prim::FILLED;
            }
        }
    }

    /// Translates a tree of objects, bottom-up with a stack of its own.
    fn csg_node(&mut self, root: &Todo<'_>, appearances: &mut Vec<Appearance>) -> Option<CsgNode> {
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
                            appearances.push(self.appearance(&todo, shape.kind()));
                            let tag = appearances.len() as u32 - 1;
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

/// The parts of a union that is clipped, each clipped by the same shapes; a node of another kind is its only part.
///
/// All surfaces of a union are kept, so its parts can be clipped one by one: an accelerator then finds the few that a ray meets.
/// Nested unions and clips are taken apart too, as long as single shapes clip them.
fn clipped_parts(node: CsgNode) -> Vec<CsgNode> {
    let mut parts = Vec::new();
    let mut waiting = vec![(node, Vec::new())];
    while let Some((node, clips)) = waiting.pop() {
        match node {
            CsgNode::Union(operands) if !clips.is_empty() => {
                let operands = operands.into_vec().into_iter().rev();
                waiting.extend(operands.map(|part| (part, copies(&clips))));
            }
            CsgNode::Clip(operands) if operands.iter().skip(1).all(is_leaf) => {
                let mut operands = operands.into_vec().into_iter();
                if let Some(part) = operands.next() {
                    waiting.push((part, operands.chain(clips).collect()));
                }
            }
            node if clips.is_empty() => parts.push(node),
            node => parts.push(CsgNode::clip(node, clips)),
        }
    }
    parts
}

fn is_leaf(node: &CsgNode) -> bool {
    matches!(node, CsgNode::Leaf { .. })
}

fn copies(leaves: &[CsgNode]) -> Vec<CsgNode> {
    let copy = |leaf: &CsgNode| match leaf {
        CsgNode::Leaf {
            shape,
            transform,
            tag,
        } => Some(CsgNode::Leaf {
            shape: shape.clone(),
            transform: transform.clone(),
            tag: *tag,
        }),
        _ => None,
    };
    leaves.iter().filter_map(copy).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use strahl_geometry::{Cuboid, Scratch, Sphere};
    use strahl_math::{DVec3, Interval, Ray};

    fn ball(x: f64, tag: u32) -> CsgNode {
        let center = DVec3::new(x, 0.0, 0.0);
        CsgNode::leaf(Sphere::try_new(center, 0.8).unwrap(), tag)
    }

    fn slab(top: f64, tag: u32) -> CsgNode {
        let far = DVec3::new(3.0, top, 3.0);
        CsgNode::leaf(Cuboid::try_new(-DVec3::splat(3.0), far).unwrap(), tag)
    }

    fn quilt() -> CsgNode {
        let inner = CsgNode::clip(ball(0.5, 2), [slab(0.6, 3)]);
        let pair = CsgNode::union([ball(-0.5, 1), inner]);
        let cut = CsgNode::intersection([ball(1.0, 4), slab(0.4, 5)]);
        CsgNode::clip(CsgNode::union([ball(-1.0, 0), pair, cut]), [slab(0.2, 6)])
    }

    #[test]
    fn a_clipped_union_is_as_many_primitives_as_it_has_parts() {
        assert_eq!(clipped_parts(quilt()).len(), 4);
        assert_eq!(clipped_parts(ball(0.0, 0)).len(), 1);
        let whole = CsgNode::union([ball(0.0, 0), ball(1.0, 1)]);
        assert_eq!(clipped_parts(whole).len(), 1);
        let by_tree = CsgNode::union([slab(0.1, 2), slab(0.2, 3)]);
        let clipped = CsgNode::clip(CsgNode::union([ball(0.0, 0), ball(1.0, 1)]), [by_tree]);
        assert_eq!(clipped_parts(clipped).len(), 1);
    }

    #[test]
    fn the_parts_are_hit_where_the_whole_is() {
        let whole = Csg::try_new(quilt()).unwrap();
        let parts = clipped_parts(quilt()).into_iter();
        let parts: Vec<Csg> = parts.map(|part| Csg::try_new(part).unwrap()).collect();
        let mut scratch = Scratch::default();
        let mut hits = 0;
        for i in 0..4000_u32 {
            let turn = |k: f64| (f64::from(i) * k).fract() * 2.0 - 1.0;
            let origin = DVec3::new(4.0 * turn(0.618_034), 4.0 * turn(0.414_214), -4.0);
            let target = DVec3::new(2.0 * turn(0.732_051), turn(0.236_068), turn(0.316_625));
            let ray = Ray::new(origin, target - origin);
            let mut first = |csg: &Csg| {
                let hit =
                    csg.closest_hit(&ray, Interval::new(0.0, f64::INFINITY), None, &mut scratch)?;
                Some((hit.t, csg.leaf_tag(hit.surface.element as usize)))
            };
            let seen = first(&whole);
            let of_parts = parts.iter().filter_map(&mut first);
            assert_eq!(seen, of_parts.min_by(|a, b| a.0.total_cmp(&b.0)), "{ray:?}");
            hits += u32::from(seen.is_some());
        }
        assert!(hits > 500, "{hits}");
    }
}
