use crate::scene::RenderScene;
use strahl_accel::PACKET;
use strahl_scene::WorkingSpace;
use strahl_shade::ShadingModel;

/// How ray trees are grown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TraceSettings {
    /// Deepest level of the tree; the primary ray is level 1.
    pub max_depth: u32,
    /// Branches of a smaller weight are not traced; 0 traces all.
    pub adc_bailout: f64,
    /// Shading model of materials that don't set one.
    pub shading: ShadingModel,
    /// Shading model of all materials, overriding their own.
    pub force_shading: Option<ShadingModel>,
    /// Most rays of one tree, not counting shadow rays: glass that reflects and refracts at every level grows trees of 2ⁿ rays.
    /// Trees that were cut are counted in [`RayCounts::cut_trees`](super::RayCounts::cut_trees).
    pub max_tree_rays: u32,
    /// The colour space in which the scene's colours are given.
    pub working_space: WorkingSpace,
    /// Whether a transparency ray that is not refracted counts as a level.
    pub straight_counts: bool,
    /// Whether shadow rays test the last occluder of their light first, and search opaque and transmitting primitives in
    /// separate accelerators. The picture is the same; published costs of accelerators are without it.
    pub shadow_cache: bool,
    /// Whether beam culling finds pixels that see only the background. The picture is the same; costs of accelerators and
    /// pixels are shown without it.
    pub beams: bool,
    /// Whether neighbouring rays are traced in packets of sixteen, where the accelerator supports it. The picture is the same;
    /// costs of accelerators and pixels are shown without it.
    pub packets: bool,
    /// How many of them go through the stages together, up to [`PACKET`]. The picture is the same, which tests show.
    #[doc(hidden)]
    pub batch: usize,
}

impl TraceSettings {
    /// Default of `max_tree_rays`.
    pub const MAX_TREE_RAYS: u32 = 1 << 18;

    /// The scene's own settings.
    pub fn of(scene: &RenderScene) -> Self {
        let s = scene.settings();
        Self {
            max_depth: s.max_depth,
            adc_bailout: s.adc_bailout,
            shading: s.shading,
            force_shading: None,
            max_tree_rays: Self::MAX_TREE_RAYS,
            working_space: s.working_space,
            straight_counts: s.straight_counts,
            shadow_cache: true,
            beams: true,
            packets: true,
            batch: PACKET,
        }
    }

    /// The space of the colours of pixels: that of the scene. Diagnostic pictures show numbers, which are not converted.
    pub(crate) fn space(&self) -> WorkingSpace {
        match self.force_shading {
            Some(model) if model.is_diagnostic() => WorkingSpace::Linear,
            _ => self.working_space,
        }
    }
}
