use super::Digits;
use strahl::tracing::RenderScene;

/// Writes the paragraph of each ray.
pub(super) struct Writer<'s> {
    pub(super) scene: &'s RenderScene,
    pub(super) digits: Digits,
}

/// Indentation of the lines of a ray.
pub(super) const RAY: usize = 2;
/// Indentation of the lines of a light or a layer.
pub(super) const INNER: usize = RAY + 2;
