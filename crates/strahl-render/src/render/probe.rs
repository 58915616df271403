//! Traces single rays through pixels here and there, for a look at a scene.

use super::pixels::{PixelTracer, Seen};
use super::{Progress, RenderError, RenderOptions};
use crate::camera::PrimaryRays;
use crate::scene::RenderScene;
use rayon::prelude::*;

/// Traces the ray through the centre of the pixel at a column and row.
pub(crate) type PixelProbe<'a> = dyn FnMut(u32, u32) -> Seen + 'a;

/// Calls `look` for each row number below `rows`, on all threads, with a function that traces rays. The counts of a row don't depend on the
/// others; the options' way of sampling plays no part.
pub(crate) fn probe_rows<T: Send>(
    scene: &RenderScene,
    options: &RenderOptions,
    progress: &dyn Progress,
    rows: u32,
    look: impl Fn(&mut PixelProbe<'_>, u32) -> T + Sync,
) -> Result<Vec<T>, RenderError> {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(options.threads)
        .build()
        .map_err(|e| RenderError::Threads(options.threads, e.to_string()))?;
    let rays = PrimaryRays::new(scene.camera(), options.width, options.height);
    let row = |tracer: &mut PixelTracer<'_>, row: u32| {
        if progress.cancelled() {
            return Err(RenderError::Cancelled);
        }
        tracer.tree.intersector.forget_occluders();
        Ok(look(&mut |x, y| tracer.probe(x, y), row))
    };
    pool.install(|| {
        let rows = (0..rows).into_par_iter();
        rows.map_init(|| PixelTracer::new(scene, &rays, options, progress), row)
            .collect()
    })
}
