//! Lights.

use crate::convert::{Triple, color, vector};
use crate::errors;
use crate::maps::Map;
use crate::object::{Object, adopt};
use pyo3::prelude::*;
use strahl::math::Transform;
use strahl::prelude::{AreaLight, DVec3, Falloff};
use strahl::scene::{Children, Group, GroupId, LightMask, SceneLight, SourceMap, Span};
use strahl::shade::LightKind;

/// A light source. It never changes.
#[pyclass(frozen, module = "strahl._strahl")]
#[derive(Clone)]
pub(crate) struct Light {
    light: SceneLight,
    /// What the light has to pass through.
    mask: Option<Object>,
}

impl Light {
    /// The light for a scene or a piece with these sources and groups, as of a line of a program.
    pub(crate) fn adopted(
        &self,
        place: Option<(String, u32)>,
        sources: &mut SourceMap,
        groups: &mut Vec<Group>,
    ) -> SceneLight {
        let mut light = self.light.clone();
        if let Some((file, line)) = place {
            light.span = Span::line(sources.add(&file), line);
        }
        light.mask = self.mask.as_ref().map(|mask| {
            let object = adopt(&mask.0, sources, groups);
            groups.push(Group {
                name: None,
                objects: Children(vec![object]),
            });
            Box::new(LightMask {
                group: GroupId(groups.len() as u32 - 1),
                transform: Transform::IDENTITY,
            })
        });
        light
    }

    fn with(&self, change: impl FnOnce(&mut strahl::prelude::Light)) -> Self {
        let mut changed = self.clone();
        change(&mut changed.light.light);
        changed
    }
}

/// A light in numbers: a dictionary that the Python half makes.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct LightNumbers {
    kind: String,
    position: Triple,
    direction: Triple,
    /// Half angles in radians, or radii.
    inner: f64,
    outer: f64,
    tightness: f64,
    color: Triple,
    inverse_square: bool,
    fade: Option<(f64, f64)>,
    shadows: bool,
    highlights: bool,
    fogged: bool,
    clearance: f64,
    name: Option<String>,
}

/// The extent of an area light: a dictionary that the Python half makes.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Area {
    axis_1: Triple,
    axis_2: Triple,
    size: (u32, u32),
    jitter: bool,
    circular: bool,
    orient: bool,
    adaptive: Option<u32>,
    illumination: bool,
    reach: f64,
}

#[pymethods]
impl Light {
    #[new]
    fn new(numbers: LightNumbers) -> PyResult<Self> {
        let n = numbers;
        let (position, direction) = (vector(n.position), vector(n.direction).normalize_or_zero());
        if n.kind != "point" && direction == DVec3::ZERO {
            return Err(errors::value("the light needs a direction other than zero"));
        }
        let kind = match n.kind.as_str() {
            "point" => LightKind::Point { position },
            "directional" => LightKind::Directional { direction },
            "spot" => LightKind::Spot {
                position,
                direction,
                cos_inner: strahl::math::det::cos(n.inner),
                cos_outer: strahl::math::det::cos(n.outer),
                tightness: n.tightness,
            },
            "parallel" => LightKind::Parallel {
                position,
                direction,
            },
            "beam" => LightKind::Beam {
                position,
                direction,
                inner: n.inner,
                outer: n.outer,
                tightness: n.tightness,
            },
            other => return Err(errors::value(format!("there is no light `{other}`"))),
        };
        let mut light = strahl::prelude::Light::new(kind, color(n.color));
        light.falloff = match (n.inverse_square, n.fade) {
            (true, _) => Falloff::InverseSquare,
            (false, Some((distance, power))) => Falloff::Fade { distance, power },
            (false, None) => Falloff::None,
        };
        light.casts_shadows = n.shadows;
        light.highlights = n.highlights;
        light.fogged = n.fogged;
        light.clearance = n.clearance;
        let light = SceneLight {
            light,
            mask: None,
            name: n.name.map(Into::into),
            span: Span::NONE,
        };
        Ok(Self { light, mask: None })
    }

    /// With an extent instead of a point.
    fn area(&self, area: Area) -> Self {
        self.with(|light| {
            light.area = Some(AreaLight {
                jitter: area.jitter,
                circular: area.circular,
                orient: area.orient,
                adaptive: area.adaptive,
                illumination: area.illumination,
                reach: area.reach,
                ..AreaLight::new(
                    vector(area.axis_1),
                    vector(area.axis_2),
                    area.size.0,
                    area.size.1,
                )
            });
        })
    }

    /// Only as far as it passes through an object.
    fn through(&self, mask: &Object) -> Self {
        Self {
            light: self.light.clone(),
            mask: Some(mask.clone()),
        }
    }

    fn transformed(&self, map: &Map) -> Self {
        Self {
            light: self.light.transformed(&map.0),
            mask: self.mask.as_ref().map(|mask| mask.moved(map)),
        }
    }
}
