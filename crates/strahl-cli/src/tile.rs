//! `render --tile`: one of several tiles of a picture.

use crate::args::RenderArgs;
use crate::input::Moment;
use crate::interrupt::pressed;
use crate::report::Failure;
use std::collections::BTreeMap;
use std::path::Path;
use strahl::tracing::{
    CostMeasure, Film, RayCounts, Region, RenderError, RenderOptions, RenderScene, estimate,
};
use strahl_farm::{Settings, TileFile, TileInfo, TilePlace, split};

/// The program that renders tiles, with the fingerprint of its sources: those of different programs are not merged.
pub(crate) const VERSION: &str = concat!("strahl ", env!("STRAHL_BUILD"));

/// One ray for so many pixels in both directions looks where the scene is costly. Every tile has to look.
const SPACING: u32 = 16;

/// The pixels of a tile: those that are given, or else those that a look at the scene finds, which is the same on every machine.
pub(crate) fn region(
    scene: &RenderScene,
    options: &RenderOptions,
    place: TilePlace,
) -> Result<Region, Failure> {
    if let Some(region) = place.region {
        return Ok(region);
    }
    if place.count == 1 {
        return Ok(Region::full(options.width, options.height));
    }
    let map =
        estimate(scene, options, SPACING, CostMeasure::Counted, &()).map_err(
            |error| match error {
                RenderError::Cancelled => Failure::Interrupted,
                other => Failure::new(other),
            },
        )?;
    let tiles = split(&map, place.count).map_err(Failure::new)?;
    let tile = tiles.get(place.number as usize - 1).copied();
    tile.ok_or_else(|| Failure::new(format!("there is no tile {place}")))
}

/// Everything besides the scene that decides the values of the pixels.
pub(crate) fn settings(args: &RenderArgs, options: &RenderOptions, moment: Moment) -> Settings {
    let mut all = Settings::new();
    let mut set = |name: &str, value: String| {
        all.insert(name.to_owned(), value);
    };
    let trace = &options.trace;
    set("size", format!("{}x{}", options.width, options.height));
    set("sampling", options.sampling.to_string());
    set("seed", options.seed.to_string());
    set("max-depth", trace.max_depth.to_string());
    set("adc-bailout", trace.adc_bailout.to_string());
    set("max-tree-rays", trace.max_tree_rays.to_string());
    if let Some(model) = trace.force_shading {
        set("shading", format!("{model:?}"));
    }
    if let Some(quality) = args.picture.quality.filter(|q| !q.is_full()) {
        set("quality", quality.to_string());
    }
    set("alpha", options.alpha.to_string());
    set("layers", options.info.to_string());
    if options.info {
        // The number of tests is one of the layers.
        set("accelerator", args.accelerator.kind().to_string());
    }
    set("clock", moment.clock.to_string());
    let frame = moment.frame;
    if frame.animated {
        set("frame", frame.number.to_string());
        set("frames", format!("{}-{}", frame.first, frame.last));
        let (begin, end) = (frame.initial_clock, frame.final_clock);
        set(
            "clocks",
            format!("{begin}-{end}, step {}", frame.clock_delta),
        );
    }
    if let Some(format) = args.format {
        set("format", format.to_string());
    }
    if let Some(version) = args.pov.language_version {
        set("language-version", version.to_string());
    }
    if let Some(file) = &args.pov.include {
        set("include", file.display().to_string());
    }
    if let Some(id) = &args.job.job_id {
        set("job", id.clone());
    }
    for (name, value) in &args.pov.declare {
        set(&format!("declare {name}"), value.to_string());
    }
    all
}

/// The rays of a tile by kind, as the statistics file calls them.
pub(crate) fn rays(counts: &RayCounts) -> BTreeMap<String, u64> {
    let all = [
        ("primary", counts.primary),
        ("primary_hit", counts.primary_hit),
        ("shadow", counts.shadow),
        ("shadow_hit", counts.shadow_hit),
        ("reflection", counts.reflection),
        ("reflection_hit", counts.reflection_hit),
        ("refraction", counts.refraction),
        ("refraction_hit", counts.refraction_hit),
        ("cut_trees", counts.cut_trees),
    ];
    all.map(|(kind, number)| (kind.to_owned(), number)).into()
}

/// Writes a tile.
pub(crate) fn write(film: &Film, info: TileInfo, file: &Path) -> Result<(), Failure> {
    let tile = TileFile {
        film: film.clone(),
        info,
    };
    tile.write(file).map_err(|error| match pressed() {
        true => Failure::Interrupted,
        false => Failure::new(error),
    })
}
