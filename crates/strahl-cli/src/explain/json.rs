use super::{Chosen, Pixel, Shown};
use strahl::tracing::{Explanation, RenderScene};

/// The trees of a pixel as JSON.
pub(crate) fn json(scene: &RenderScene, pixel: &Pixel<'_>, shown: &Shown) -> String {
    let mut all = Explanation::new(scene, pixel.at, pixel.size, pixel.sampling, pixel.tree);
    if let Some(Chosen::One(one)) = shown.sample {
        all.samples.retain(|sample| sample.sample == one);
    }
    all.to_json()
}
