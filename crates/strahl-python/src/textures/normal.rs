//! Normals: patterns that make smooth surfaces look rough.

use crate::maps::Map;
use crate::textures::pattern::{Pattern, transform};
use pyo3::prelude::*;
use std::sync::Arc;
use strahl::prelude::PovNormal;
use strahl::shade::SharedList;
use strahl::shade::normal::{Facets, NormalKind, SlopeMap};
use strahl::shade::patterns::Pattern as Kind;
use strahl::shade::pigment::BlendMap;

/// A normal. It never changes.
#[pyclass(frozen, module = "strahl._strahl")]
pub(crate) struct Normal(pub(crate) PovNormal);

impl Normal {
    fn of(kind: NormalKind, pattern: &Pattern) -> Self {
        Self(PovNormal {
            modifiers: pattern.0.modifiers.clone(),
            ..PovNormal::new(kind)
        })
    }
}

fn members(entries: &[(f64, Py<Normal>)]) -> SharedList<(f64, PovNormal)> {
    let entries = entries.iter();
    entries
        .map(|(number, normal)| (*number, normal.get().0.clone()))
        .collect()
}

#[pymethods]
impl Normal {
    /// By the pattern's own method, or by its value as a height. `bumps` takes noise by its own method; `slopes` are heights and slopes at values.
    #[new]
    fn new(
        pattern: &Pattern,
        amount: f64,
        bumps: bool,
        slopes: Option<Vec<(f64, [f64; 2])>>,
        accuracy: f64,
        no_bump_scale: bool,
    ) -> Self {
        let kind = match (&pattern.0.pattern, slopes) {
            (kind, Some(slopes)) => {
                NormalKind::Height(kind.clone(), Some(SlopeMap(BlendMap::new(slopes))))
            }
            (Kind::Bozo, None) if bumps => NormalKind::Bumps,
            (Kind::Dents, None) => NormalKind::Dents,
            (Kind::Wrinkles, None) => NormalKind::Wrinkles,
            (Kind::Ripples { sources }, None) => NormalKind::Ripples(*sources),
            (Kind::Waves { sources }, None) => NormalKind::Waves(*sources),
            (Kind::Quilted { control0, control1 }, None) => {
                NormalKind::Quilted([*control0, *control1])
            }
            (Kind::Image(image), None) => NormalKind::BumpMap(Arc::clone(image)),
            (kind, None) => NormalKind::Height(kind.clone(), None),
        };
        Self(PovNormal {
            amount,
            accuracy,
            no_bump_scale,
            ..Self::of(kind, pattern).0
        })
    }

    #[staticmethod]
    fn map(pattern: &Pattern, entries: Vec<(f64, Py<Self>)>) -> Self {
        let map = BlendMap::new(members(&entries));
        Self::of(NormalKind::Map(pattern.0.pattern.clone(), map), pattern)
    }

    #[staticmethod]
    fn blocks(pattern: &Pattern, members: Vec<Py<Self>>) -> Self {
        let members = members
            .iter()
            .map(|normal| normal.get().0.clone())
            .collect();
        let kind = NormalKind::Blocks(pattern.0.pattern.clone(), members);
        Self::of(kind, pattern)
    }

    #[staticmethod]
    fn average(entries: Vec<(f64, Py<Self>)>) -> Self {
        Self(PovNormal::new(NormalKind::Average(members(&entries))))
    }

    /// Flat pieces of this size; if they are tilted, they are cells of a crackle, also on flat surfaces.
    #[staticmethod]
    fn facets(size: f64, tilt: f64) -> Self {
        Self(PovNormal::new(NormalKind::Facets(Facets { size, tilt })))
    }

    /// By the texture coordinates of surfaces.
    fn uv_mapped(&self) -> Self {
        Self(PovNormal {
            uv_mapped: true,
            ..self.0.clone()
        })
    }

    fn transformed(&self, map: &Map) -> Self {
        let mut normal = self.0.clone();
        if !normal.uv_mapped {
            transform(&mut normal.modifiers, &map.0);
        }
        Self(normal)
    }
}
