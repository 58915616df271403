use crate::grammar::Entity;
use crate::grammar::entity::is_nothing;
use crate::parser::{PResult, Parser};
use strahl_scene::{CsgOp, Object};

/// `union { objects ... }`
pub(super) fn union(p: &mut Parser<'_>) -> PResult<Entity> {
    p.csg(CsgOp::Union)
}

/// `merge { objects ... }`
pub(super) fn merge(p: &mut Parser<'_>) -> PResult<Entity> {
    p.csg(CsgOp::Merge)
}

/// `intersection { objects ... }`
pub(super) fn intersection(p: &mut Parser<'_>) -> PResult<Entity> {
    p.csg(CsgOp::Intersection)
}

/// `difference { object objects ... }`
pub(super) fn difference(p: &mut Parser<'_>) -> PResult<Entity> {
    p.csg(CsgOp::Difference)
}

impl Parser<'_> {
    fn csg(&mut self, op: CsgOp) -> PResult<Entity> {
        let place = self.place();
        self.braces(|p| {
            let children = p.parts()?;
            if children.is_empty() {
                p.warn(place, format!("the {} has no objects", op.name()));
            }
            let kept = combine(op, children);
            let mut entity = Entity::from(Object::csg(op, kept));
            entity.object.span = p.span_at(place);
            p.modifiers(&mut entity)?;
            Ok(entity)
        })
    }

    /// Objects up to the first word that opens none.
    pub(super) fn parts(&mut self) -> PResult<Vec<Object>> {
        let mut objects = vec![];
        while let Some(object) = self.object()? {
            objects.push(object);
        }
        Ok(objects)
    }
}

/// The children without those that nothing is left of; none if nothing is left of the whole.
fn combine(op: CsgOp, mut children: Vec<Object>) -> Vec<Object> {
    let empty = match op {
        CsgOp::Intersection => children.iter().any(is_nothing),
        CsgOp::Difference => children.first().is_some_and(is_nothing),
        _ => false,
    };
    if empty {
        return vec![];
    }
    children.retain(|child| !is_nothing(child));
    children
}
