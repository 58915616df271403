use super::bounds;
use super::modifiers::surround;
use crate::grammar::Entity;
use crate::grammar::entity::{has_no_surface, is_everything, is_nothing};
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
                    let (op, children) = combine(op, children);
                    let mut object = Object::csg(op, children);
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

/// The operation without children that have no surface. Without children it is nothing, or everything if it is an inverse.
fn combine(op: CsgOp, mut children: Vec<Object>) -> (CsgOp, Vec<Object>) {
    let nothing = || (CsgOp::Union, vec![]);
    let everything = || (CsgOp::Inverse, vec![]);
    let (all, any_everything) = (children.len(), children.iter().any(is_everything));
    match op {
        CsgOp::Intersection if children.iter().any(is_nothing) => return nothing(),
        CsgOp::Difference if children.first().is_some_and(is_nothing) => return nothing(),
        CsgOp::Difference if children.iter().skip(1).any(is_everything) => return nothing(),
        CsgOp::Merge if any_everything => return everything(),
        _ => {}
    }
    children.retain(|child| !has_no_surface(child));
    match op {
        CsgOp::Intersection if children.is_empty() && all > 0 => everything(),
        CsgOp::Difference if any_everything && children.is_empty() => everything(),
        CsgOp::Difference if any_everything => {
            let outside = |child| Object::csg(CsgOp::Inverse, vec![child]);
            (
                CsgOp::Intersection,
                children.into_iter().map(outside).collect(),
            )
        }
        _ => (op, children),
    }
}
