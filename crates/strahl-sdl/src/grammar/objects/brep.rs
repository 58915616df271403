use super::reuse::expanded;
use crate::grammar::Entity;
use crate::parser::{PResult, Parser, Place};
use crate::token::Kind;
use std::sync::Arc;
use strahl_geometry::{GeometryError, Nurbs, NurbsBrep, Shape};
use strahl_scene::{CsgOp, Object, ObjectKind, nurbs_faces};

/// `brep { faces ... }`: the solid within NURBS surfaces.
///
/// An extension.
pub(super) fn brep(p: &mut Parser<'_>) -> PResult<Entity> {
    let place = p.place();
    p.simple(|p| {
        let faces = p.faces()?;
        if faces.is_empty() {
            let token = p.peek()?;
            return Err(p.unexpected(token, "`nurbs`, or the name of such a surface"));
        }
        let surfaces: Vec<Arc<Nurbs>> = faces.iter().map(|(face, _)| Arc::clone(face)).collect();
        match NurbsBrep::try_new(&surfaces) {
            Ok(solid) => Ok(Ok(ObjectKind::Shape(solid.into()))),
            Err(error) => {
                let at = match &error {
                    GeometryError::NotClosedAt { index, .. } => faces.get(*index as usize),
                    _ => None,
                };
                p.warn_hint(
                    at.map_or(place, |(_, place)| *place),
                    error.to_string(),
                    "its faces are shown as surfaces; the object has no inside, so CSG and glass do not treat it as a solid",
                );
                let surface = |face| Object::new(ObjectKind::Shape(Shape::Nurbs(face)));
                let all = surfaces.into_iter().map(surface).collect();
                Ok(Ok(Object::csg(CsgOp::Union, all).kind))
            }
        }
    })
}

impl Parser<'_> {
    /// The faces up to the first word that opens no object, each with the place of its object.
    fn faces(&mut self) -> PResult<Vec<(Arc<Nurbs>, Place)>> {
        let mut faces = vec![];
        loop {
            let token = self.peek()?;
            if matches!(token.kind, Kind::Comma | Kind::Semicolon) {
                self.take(token)?;
                continue;
            }
            let place = self.place_of(token);
            let Some(entity) = self.entity()? else {
                return Ok(faces);
            };
            let object = expanded(&entity.object, &self.state.shared);
            if entity.texture.is_some() {
                self.warn_hint(
                    place,
                    "the texture of a face is left out",
                    "a `brep` has one texture: write it behind the faces",
                );
            }
            match nurbs_faces(&object) {
                Ok(own) => faces.extend(own.into_iter().map(|face| (face, place))),
                Err(kind) => {
                    let message = format!("a face of a `brep` is a `nurbs`, found {kind}");
                    let hint = "also the name of one, or a union of them";
                    return Err(self.fail_hint(place, message, hint));
                }
            }
        }
    }
}
