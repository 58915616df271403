use crate::input::LoadTimes;
use serde::Serialize;
use strahl::tracing::{BatchMemory, RenderScene, Rendered, TraceSettings};

/// The statistics file: its keys are a contract, documented in docs/src/statistics.md.
#[derive(Debug, Serialize)]
pub(crate) struct Stats<'a> {
    rays: Rays,
    accelerator: Accelerator<'a>,
    batches: Batches,
    time_s: Times,
    threads: usize,
    simd: &'a str,
    image: Image<'a>,
}

#[derive(Debug, Serialize)]
struct Rays {
    primary: u64,
    primary_hit: u64,
    shadow: u64,
    shadow_hit: u64,
    reflection: u64,
    reflection_hit: u64,
    refraction: u64,
    refraction_hit: u64,
    cut_trees: u64,
}

#[derive(Debug, Serialize)]
struct Accelerator<'a> {
    name: &'a str,
    build_s: f64,
    bytes: usize,
    nodes: usize,
    references: usize,
    node_visits: u64,
    primitive_tests: u64,
}

#[derive(Debug, Serialize)]
struct Batches {
    bytes: usize,
    point_bytes: usize,
    ray_bytes: usize,
    most_ray_bytes: usize,
    list_bytes: usize,
}

#[derive(Debug, Serialize)]
struct Times {
    load: f64,
    compile: f64,
    trace: f64,
    write: f64,
    total: f64,
}

#[derive(Debug, Serialize)]
struct Image<'a> {
    width: u32,
    height: u32,
    sha256: &'a str,
}

/// Seconds for the phases after loading.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RenderTimes {
    pub(crate) trace: f64,
    pub(crate) write: f64,
    pub(crate) total: f64,
}

impl<'a> Stats<'a> {
    pub(crate) fn new(
        scene: &'a RenderScene,
        rendered: &Rendered,
        trace: &TraceSettings,
        sha256: &'a str,
        load: LoadTimes,
        render: RenderTimes,
    ) -> Self {
        let (r, s) = (&rendered.rays, scene.stats());
        Self {
            rays: Rays {
                primary: r.primary,
                primary_hit: r.primary_hit,
                shadow: r.shadow,
                shadow_hit: r.shadow_hit,
                reflection: r.reflection,
                reflection_hit: r.reflection_hit,
                refraction: r.refraction,
                refraction_hit: r.refraction_hit,
                cut_trees: r.cut_trees,
            },
            accelerator: Accelerator {
                name: scene.accelerator_name(),
                build_s: load.build,
                bytes: s.accelerator_bytes,
                nodes: s.nodes,
                references: s.references,
                node_visits: rendered.traversal.node_visits,
                primitive_tests: rendered.traversal.primitive_tests,
            },
            batches: Batches {
                bytes: rendered.batches.total(),
                point_bytes: rendered.batches.points,
                ray_bytes: rendered.batches.rays,
                most_ray_bytes: BatchMemory::most_for_rays(trace),
                list_bytes: rendered.batches.lists,
            },
            time_s: Times {
                load: load.load,
                compile: load.compile,
                trace: render.trace,
                write: render.write,
                total: render.total,
            },
            threads: rendered.threads,
            simd: scene.simd().name(),
            image: Image {
                width: rendered.film.region.width,
                height: rendered.film.region.height,
                sha256,
            },
        }
    }
}
