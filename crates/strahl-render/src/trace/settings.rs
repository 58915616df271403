use crate::scene::RenderScene;
use strahl_scene::WorkingSpace;
use strahl_shade::{Color, ShadingModel};

/// How trees are grown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TraceSettings {
    /// Deepest level of the tree; the primary ray is level 1.
    pub max_depth: u32,
    /// Branches of a smaller weight are not followed; 0 follows all.
    pub adc_bailout: f64,
    /// Shading model of materials that name none.
    pub shading: ShadingModel,
    /// Shading model of all materials, whatever they name.
    pub force_shading: Option<ShadingModel>,
    /// Most rays of one tree, shadow rays not counted: glass that reflects and refracts at every level grows trees of 2ⁿ
    /// rays. Trees that were cut are counted in [`RayCounts::cut_trees`](super::RayCounts::cut_trees).
    pub max_tree_rays: u32,
    /// In which numbers the scene's colours are given.
    pub working_space: WorkingSpace,
    /// Whether a transparency ray that goes straight on counts as a level.
    pub straight_counts: bool,
    /// Whether shadow rays first look at what was last in the way of their light, and what may stop light is searched apart from what
    /// may let it through. The picture is the same; the published costs of accelerators are without.
    pub shadow_cache: bool,
    /// Whether pixels that see nothing are found out many at once. The picture is the same; the costs of accelerators and pixels are
    /// told without.
    pub beams: bool,
    /// Whether the rays of neighbouring pixels are followed together, sixteen at once, where the acceleration structure knows how. The
    /// picture is the same; the costs of accelerators and pixels are told without.
    pub packets: bool,
}

impl TraceSettings {
    /// Default of `max_tree_rays`.
    pub const MAX_TREE_RAYS: u32 = 1 << 18;

    /// What a scene asks for.
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
        }
    }

    /// What is seen, in linear light; pictures of something other than light stay as they are.
    pub(super) fn decoded(&self, color: Color) -> Color {
        match self.force_shading {
            Some(model) if model.is_diagnostic() => color,
            _ => self.working_space.decode(color),
        }
    }
}
