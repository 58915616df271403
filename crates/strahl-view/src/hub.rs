//! What all open pages share.

use crate::builtin::Offered;
use crate::pictures::Pictures;
use crate::scenes::Scenes;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::AtomicU64;
use strahl::prelude::*;
use tokio::sync::Semaphore;

/// The settings of pictures for which neither the page nor the scene has a value.
#[derive(Clone, Debug)]
pub struct Defaults {
    /// Width and height in pixels; `None` takes the scene's size, or else 800x600.
    pub size: Option<(u32, u32)>,
    /// Where rays go through the pixels.
    pub sampling: Sampling,
    /// Seed of the sampling.
    pub seed: u64,
    /// The deepest level of ray trees.
    pub depth: Option<u32>,
    /// The smallest weight of branches.
    pub cutoff: Option<f64>,
    /// The largest number of rays in a tree.
    pub max_tree_rays: u32,
    /// The shading model of all objects.
    pub shading: Option<ShadingModel>,
    /// The acceleration structure.
    pub accelerator: AcceleratorKind,
    /// The value of `clock`.
    pub clock: f64,
}

/// What all pages share.
pub(crate) struct Hub {
    pub(crate) scenes: Arc<Scenes>,
    pub(crate) pictures: Arc<Pictures>,
    pub(crate) session: Session,
    pub(crate) offered: Option<Offered>,
    pub(crate) scene: PathBuf,
    pub(crate) defaults: Defaults,
    pub(crate) edit: bool,
    pub(crate) editor: Option<String>,
    pub(crate) pages: AtomicU64,
    /// A place for each page that is open.
    pub(crate) places: Arc<Semaphore>,
}
