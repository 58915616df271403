//! Objects made of others.

use crate::errors;
use crate::lights::Light;
use crate::object::{Object, Piece, adopt};
use pyo3::prelude::*;
use std::sync::Arc;
use strahl::prelude::CsgOp;
use strahl::scene::{self, Group, SourceMap};

/// The deepest nesting of objects.
const DEEPEST: u32 = 1000;

/// A part of a combination.
#[derive(FromPyObject)]
pub(crate) enum Part {
    Object(Py<Object>),
    /// With the line of the program that made it.
    Light(Py<Light>, Option<(String, u32)>),
}

impl Part {
    fn depth(&self) -> u32 {
        match self {
            Self::Object(object) => object.get().0.depth,
            Self::Light(..) => 1,
        }
    }

    fn adopted(&self, sources: &mut SourceMap, groups: &mut Vec<Group>) -> scene::Object {
        match self {
            Self::Object(object) => adopt(&object.get().0, sources, groups),
            Self::Light(light, place) => {
                let light = light.get().adopted(place.clone(), sources, groups);
                scene::Object::light(light)
            }
        }
    }
}

/// Combines objects, and lights that belong to them; `operation` is that of POV-Ray's language.
#[pyfunction]
pub(crate) fn combined(
    operation: &str,
    objects: Vec<Part>,
    place: Option<(String, u32)>,
) -> PyResult<Object> {
    let op = match operation {
        "union" => CsgOp::Union,
        "merge" => CsgOp::Merge,
        "intersection" => CsgOp::Intersection,
        "difference" => CsgOp::Difference,
        "inverse" => CsgOp::Inverse,
        "clip" => CsgOp::Clip,
        "bound" => CsgOp::Bound,
        "light group"
        | "light group with global lights"
        | "light group with outer lights"
        | "light group with global lights and outer lights" => CsgOp::LightGroup {
            global_lights: operation.contains("global lights"),
            outer_lights: operation.contains("outer lights"),
        },
        other => return Err(errors::value(format!("there is no operation `{other}`"))),
    };
    let depth = objects.iter().map(Part::depth).max().unwrap_or(0) + 1;
    if depth > DEEPEST {
        return Err(errors::value(format!(
            "objects are nested more than {DEEPEST} deep: combine lists of them by strahl.union and the like"
        )));
    }
    let (mut sources, mut groups) = (SourceMap::default(), vec![]);
    let children = objects
        .iter()
        .map(|part| part.adopted(&mut sources, &mut groups))
        .collect();
    let object = scene::Object::csg(op, children);
    Ok(Object(Arc::new(Piece::of_parts(
        object, groups, sources, depth, place,
    ))))
}
