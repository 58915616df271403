use super::bounds;
use super::modifiers::surround;
use crate::grammar::Entity;
use crate::grammar::entity::is_nothing;
use crate::parser::{PResult, Parser};
use crate::token::Kind;
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
            let first = p.named_object(None)?;
            let rest = p.parts()?;
            let mut entity = match first {
                // As in POV-Ray, `union { Name ... }` is `object { Name ... }`.
                Some(named) if rest.is_empty() => named,
                first => {
                    let named = first.map(|entity| entity.object);
                    let children: Vec<Object> = named.into_iter().chain(rest).collect();
                    if children.is_empty() {
                        p.warn(place, format!("the {} has no objects", op.name()));
                    }
                    let narrowed = bounds::narrowed(op, &children, &p.state.shared);
                    let mut object = Object::csg(op, combine(op, children));
                    surround(&mut object, CsgOp::Bound, narrowed.into_iter().collect());
                    Entity::from(object)
                }
            };
            entity.object.span = p.span_at(place);
            p.modifiers(&mut entity)?;
            Ok(entity)
        })
    }

    /// Objects up to the first word that opens none. Extra separators between them are harmless.
    pub(in crate::grammar) fn parts(&mut self) -> PResult<Vec<Object>> {
        let mut objects = vec![];
        loop {
            let token = self.peek()?;
            if matches!(token.kind, Kind::Comma | Kind::Semicolon) {
                self.take(token)?;
            } else if let Some(object) = self.object()? {
                objects.push(object);
            } else {
                return Ok(objects);
            }
        }
    }
}

/// The children without those that have no surface; an empty list if the result has no surface.
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
