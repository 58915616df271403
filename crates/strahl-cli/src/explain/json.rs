use super::{Chosen, Pixel, Shown};
use strahl::tracing::{Explanation, RenderScene};

/// The trees of a pixel as JSON.
pub(crate) fn json(scene: &RenderScene, pixel: &Pixel<'_>, shown: &Shown) -> String {
    explanation(scene, pixel, shown).to_json()
}

/// The trees of a pixel as data.
pub(crate) fn explanation(scene: &RenderScene, pixel: &Pixel<'_>, shown: &Shown) -> Explanation {
    let mut all = Explanation::new(scene, pixel.at, pixel.size, pixel.sampling, pixel.tree);
    if let Some(Chosen::One(one)) = shown.sample {
        all.samples.retain(|sample| sample.sample == one);
    }
    all
}
