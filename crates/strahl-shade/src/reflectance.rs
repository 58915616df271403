use std::{fmt, str::FromStr};
use strahl_math::{DVec3, det};

/// Shading models, which relate the light that arrives at a point to the light that leaves it: selectable per scene and per
/// material.
///
/// With unit vectors **n** (normal), **l** (towards the light), **v** (towards the viewer) and **h** = (l+v)/|l+v|, and per
/// light of colour L that is visible:
///
/// | model | contribution |
/// |---|---|
/// | Lambert | `L kd (n·l)` |
/// | Phong | `L (kd (n·l) + ks (r·v)^p)`, r the mirror direction of l |
/// | Blinn-Phong | `L (kd (n·l) + ks (h·n)^p)` |
///
/// and the constant term `ka Ia` once. The diagnostic models show a property of the hit instead and send no further
/// rays.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum ShadingModel {
    /// Diffuse reflection only.
    Lambert,
    /// Highlight around the mirror direction (Phong 1975).
    Phong,
    /// Highlight around the halfway vector (Blinn 1977).
    #[default]
    BlinnPhong,
    /// The shading normal as a colour, `n/2 + 1/2`, in world space.
    Normals,
    /// The distance from the eye: black at the eye, towards white far away, `d / (d + scene diagonal)`.
    Depth,
    /// A colour of its own for every object.
    ObjectId,
    /// Texture coordinates: red is the fraction of u, green that of v.
    Uv,
}

impl ShadingModel {
    /// All models with their names on the command line.
    pub const ALL: [(&'static str, Self); 7] = [
        ("lambert", Self::Lambert),
        ("phong", Self::Phong),
        ("blinn-phong", Self::BlinnPhong),
        ("normals", Self::Normals),
        ("depth", Self::Depth),
        ("object-id", Self::ObjectId),
        ("uv", Self::Uv),
    ];

    /// Whether the model shows a property of the hit instead of light.
    pub fn is_diagnostic(self) -> bool {
        matches!(
            self,
            Self::Normals | Self::Depth | Self::ObjectId | Self::Uv
        )
    }

    /// The factor of the highlight, without `ks`: 0 for models without one and behind the surface.
    #[inline]
    pub fn highlight(self, n: DVec3, l: DVec3, v: DVec3, shininess: f64) -> f64 {
        let cosine = match self {
            Self::Phong => crate::reflect(n, l).dot(v),
            Self::BlinnPhong => {
                let h = l + v;
                let length = h.length();
                if length > 0.0 { h.dot(n) / length } else { 0.0 }
            }
            _ => return 0.0,
        };
        if cosine > 0.0 {
            det::pow(cosine, shininess)
        } else {
            0.0
        }
    }
}

impl fmt::Display for ShadingModel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = Self::ALL
            .iter()
            .find(|(_, model)| model == self)
            .map_or("?", |(name, _)| name);
        f.write_str(name)
    }
}

/// There is no shading model with this name.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "unknown shading model `{0}`; there are: lambert, phong, blinn-phong, normals, depth, object-id, uv"
)]
pub struct UnknownShadingModel(String);

impl FromStr for ShadingModel {
    type Err = UnknownShadingModel;

    fn from_str(s: &str) -> Result<Self, Self::Err> {
        Self::ALL
            .iter()
            .find(|(name, _)| *name == s)
            .map(|(_, model)| *model)
            .ok_or_else(|| UnknownShadingModel(s.into()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_leads_to_its_model_and_the_error_lists_all() {
        let error = "gouraud"
            .parse::<ShadingModel>()
            .expect_err("unknown")
            .to_string();
        for (name, model) in ShadingModel::ALL {
            assert_eq!(name.parse(), Ok(model));
            assert_eq!(model.to_string(), name);
            assert!(error.contains(name));
        }
    }

    #[test]
    fn highlights_peak_in_the_mirror_direction() {
        let n = DVec3::Z;
        let l = DVec3::new(0.6, 0.0, 0.8);
        let mirror = DVec3::new(-0.6, 0.0, 0.8);
        for model in [ShadingModel::Phong, ShadingModel::BlinnPhong] {
            assert!((model.highlight(n, l, mirror, 20.0) - 1.0).abs() < 1e-12);
            assert!(model.highlight(n, l, n, 20.0) < 0.5);
        }
        assert_eq!(ShadingModel::Lambert.highlight(n, l, mirror, 20.0), 0.0);
        assert_eq!(ShadingModel::BlinnPhong.highlight(n, l, -l, 20.0), 0.0);
    }
}
