//! From a scene description to pixels.
//!
//! ```text
//! Scene --compile--> RenderScene --render--> Film
//! ```
//!
//! [`compile()`] is a list of passes from value to value; [`render()`] traces the rays. [`trace`] has the only trace loop:
//! pictures and ray trees both come from it, the latter through a [`TraceObserver`]. Nothing here does I/O, reads the clock or
//! prints.
//!
//! A pixel depends on the scene, its position and its samples only, so a film has the same bits for every accelerator,
//! number of threads, order of tiles and split into regions.

mod activity;
mod appearance;
mod area;
mod attenuation;
mod beam;
mod blocks;
mod branch;
mod camera;
mod compile;
mod cost;
mod coverage;
mod estimate;
pub mod explanation;
mod film;
mod first_ids;
mod hit;
mod layers;
mod light_sets;
mod lit;
mod media;
mod names;
mod objects;
mod observer;
mod outcome;
mod prim;
mod profile;
mod queries;
mod query;
mod render;
mod resolve;
mod runs;
mod sampling;
mod scene;
mod searcher;
mod session;
mod shadow;
mod sink;
mod spheres;
mod surface;
mod tiles;
pub mod trace;
pub mod transport;
mod tree;
mod uses;
mod view;
mod walk;

pub use activity::{Activities, Activity, Phase, RayPurpose};
pub use camera::PrimaryRays;
pub use compile::{CompileOptions, Prepared, compile};
pub use cost::PixelCost;
pub use estimate::{CostMap, CostMeasure, estimate};
pub use explanation::Explanation;
pub use film::{Film, FilmError, MergeError, PixelInfo, Region};
pub use hit::{Hit, Origin, RayClass};
pub use names::{light_kind, light_position};
pub use objects::{ObjectInfo, Objects};
pub use observer::{
    BranchEnd, GatherTerm, HitReport, LayerReport, LightDetail, LightTerm, RayKind, RayReport,
    Shading, ShadowHit, ShadowReport, Share, SurfaceTerm, TraceObserver,
};
pub use profile::{Part as ProfilePart, Profile, ProfileReport};
pub use queries::{HitInfo, HitSurface};
pub use query::{Intersector, WalkEvent};
pub use render::{
    PixelState, Progress, RenderError, RenderOptions, Rendered, render, render_watched,
};
pub use sampling::{Refinement, Sampling, UnknownSampling};
pub use scene::{RenderScene, SceneStats};
pub use searcher::Searcher;
pub use session::{Outcome, Session, Threads, Unfinished};
pub use sink::{Pass, Sink, Tile};
pub use strahl_accel::PACKET;
pub use tiles::TileOrder;
pub use trace::{BatchMemory, RayCounts, SampleResult, TraceSettings};
pub use tree::{LightReport, PixelSample, PixelTree, RayNode, RayTree, explain};
pub use view::{Output, View};
pub use walk::{RayWalk, walk};
