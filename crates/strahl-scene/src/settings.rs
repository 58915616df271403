use crate::WorkingSpace;
use strahl_shade::pov_finish::IridSettings;
use strahl_shade::{Quality, ShadingModel};

/// Settings that a scene may choose; the caller may override each.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Picture size in pixels, if the scene names one.
    pub size: Option<(u32, u32)>,
    /// Deepest level of the ray tree, the primary ray being level 1; at least 1.
    pub max_depth: u32,
    /// Rays whose weight (the largest channel of the product of all coefficients on the way) is below this are not traced; 0
    /// traces all.
    pub adc_bailout: f64,
    /// Shading model of materials that don't set one.
    pub shading: ShadingModel,
    /// The colour space of the scene's colours.
    pub working_space: WorkingSpace,
    /// Whether a transparency ray that is not refracted counts as a level of the ray tree. POV-Ray counts reflections and
    /// refractions only.
    pub straight_counts: bool,
    /// Whether a filter reduces the surface's own colour as in scenes from before POV-Ray 3.7: by `filter · max(r, g, b)` instead
    /// of `filter`.
    pub filter_by_color: bool,
    /// The wavelengths and the noise of thin films.
    pub irid: IridSettings,
    /// What pictures leave out to be quick; nothing by default.
    pub quality: Quality,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            size: None,
            max_depth: 10,
            adc_bailout: 1.0 / 255.0,
            shading: ShadingModel::BlinnPhong,
            working_space: WorkingSpace::Linear,
            straight_counts: true,
            filter_by_color: false,
            irid: IridSettings::default(),
            quality: Quality::FULL,
        }
    }
}
