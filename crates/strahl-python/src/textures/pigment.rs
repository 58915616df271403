//! Pigments: colours at points.

use crate::convert::ColorNumbers;
use crate::errors;
use crate::maps::Map;
use crate::textures::pattern::{Pattern, transform};
use pyo3::prelude::*;
use std::sync::Arc;
use strahl::prelude::Pigment as Of;
use strahl::shade::patterns::Pattern as Kind;
use strahl::shade::pigment::BlendMap;
use strahl::shade::{ColorFt, SharedList};

/// A pigment. It never changes.
#[pyclass(frozen, module = "strahl._strahl")]
pub(crate) struct Pigment(pub(crate) Of);

#[pymethods]
impl Pigment {
    #[staticmethod]
    fn solid(color: ColorNumbers) -> Self {
        Self(Of::Solid(color.into(), None))
    }

    /// Colours by the value of a pattern.
    #[staticmethod]
    fn colors(pattern: &Pattern, entries: Vec<(f64, ColorNumbers)>) -> Self {
        let entries = entries.into_iter();
        let entries: Vec<(f64, ColorFt)> = entries.map(|(at, color)| (at, color.into())).collect();
        Self(Of::ColorMap(
            Box::new(pattern.0.clone()),
            BlendMap::new(entries),
        ))
    }

    /// Pigments by the value of a pattern.
    #[staticmethod]
    fn map(pattern: &Pattern, entries: Vec<(f64, Py<Self>)>) -> Self {
        let map = BlendMap::new(members(&entries));
        Self(Of::PigmentMap(Box::new(pattern.0.clone()), map))
    }

    /// Pigments by the block of a pattern.
    #[staticmethod]
    fn blocks(pattern: &Pattern, members: Vec<Py<Self>>) -> Self {
        let members = members.iter().map(|pigment| pigment.get().0.clone());
        Self(Of::Blocks(Box::new(pattern.0.clone()), members.collect()))
    }

    /// The colours of a picture, in the place of its pattern.
    #[staticmethod]
    fn picture(pattern: &Pattern) -> PyResult<Self> {
        let Kind::Image(image) = &pattern.0.pattern else {
            return Err(errors::value(
                "only patterns of images have colours of their own",
            ));
        };
        let modifiers = Box::new(pattern.0.modifiers.clone());
        Ok(Self(Of::Image(Arc::clone(image), modifiers)))
    }

    /// The mean of pigments with weights.
    #[staticmethod]
    fn average(entries: Vec<(f64, Py<Self>)>) -> Self {
        Self(Of::Average(members(&entries), Box::default()))
    }

    /// By the texture coordinates of surfaces.
    fn uv_mapped(&self) -> Self {
        Self(Of::UvMapped(Box::new(self.0.clone())))
    }

    /// Its grey values as a pattern.
    fn pattern(&self) -> Pattern {
        Pattern::of(Kind::Pigment(Arc::new(self.0.clone())))
    }

    /// With a colour for quick pictures.
    fn quick(&self, color: ColorNumbers) -> Self {
        Self(Of::Quick(color.into(), Box::new(self.0.clone())))
    }

    fn transformed(&self, map: &Map) -> Self {
        let mut pigment = self.0.clone();
        transform_pigment(&mut pigment, map);
        Self(pigment)
    }
}

fn transform_pigment(pigment: &mut Of, map: &Map) {
    match pigment {
        // Texture coordinates stay what they are.
        Of::UvMapped(_) | Of::Solid(..) => {}
        Of::Quick(_, inner) => transform_pigment(inner, map),
        Of::ColorMap(field, _) | Of::PigmentMap(field, _) | Of::Blocks(field, _) => {
            transform(&mut field.modifiers, &map.0);
        }
        Of::Image(_, modifiers) | Of::Average(_, modifiers) => transform(modifiers, &map.0),
    }
}

fn members(entries: &[(f64, Py<Pigment>)]) -> SharedList<(f64, Of)> {
    let entries = entries.iter();
    entries
        .map(|(number, pigment)| (*number, pigment.get().0.clone()))
        .collect()
}
