use crate::args::RenderArgs;
use crate::input::{compiled, render_options};
use crate::interrupt;
use crate::progress::Watch;
use crate::report::Failure;
use crate::stats::{RenderTimes, Stats};
use std::path::{Path, PathBuf};
use std::time::Instant;
use strahl::formats::image::{ImageFormat, WriteOptions, write_bytes, write_picture};
use strahl::tracing::{RenderError, TileOrder};

/// `strahl render`: from a scene to a picture.
pub(crate) fn render(args: &RenderArgs) -> Result<(), Failure> {
    let start = Instant::now();
    interrupt::listen();
    let output = output_path(args)?;
    // Before the work, not after it: is there such a format, and a folder to write to?
    let format = ImageFormat::from_path(&output).map_err(Failure::new)?;
    if args.layers && !format.info().layers {
        return Err(Failure::new(format!(
            "--layers needs a format with layers (.exr), but the picture is {}",
            output.display()
        )));
    }
    for file in [Some(&output), args.stats.as_ref()].into_iter().flatten() {
        check_folder(file)?;
    }

    let (scene, load_times) = compiled(&args.scene, &args.picture, args.quiet)?;
    let mut options = render_options(&scene, &args.picture);
    options.region = args.region;
    options.threads = args.threads;
    options.tile_order = TileOrder::from(args.tile_order);
    options.info = args.layers;

    let watch = Watch::new(args.quiet);
    let trace_start = Instant::now();
    let outcome = strahl::render(&scene, &options, &watch);
    watch.finish();
    let rendered = outcome.map_err(|error| match error {
        RenderError::Cancelled => Failure::Interrupted,
        other => Failure::new(other),
    })?;
    let trace = trace_start.elapsed().as_secs_f64();

    let write_start = Instant::now();
    let film = &rendered.film;
    let mut metadata = strahl::metadata(film);
    metadata.push(("scene".into(), args.scene.scene.display().to_string()));
    metadata.push(("accelerator".into(), scene.accelerator_name().into()));
    metadata.push(("sampling".into(), options.sampling.to_string()));
    let sha256 = film.sha256();
    let layers = strahl::layers(film);
    let write_options = WriteOptions {
        bit_depth: args.bit_depth,
        ..WriteOptions::default()
    };
    write_picture(
        &output,
        &strahl::picture(film, &layers, metadata),
        &write_options,
    )
    .map_err(Failure::new)?;
    let write = write_start.elapsed().as_secs_f64();

    let total = start.elapsed().as_secs_f64();
    let stats = Stats::new(
        &scene,
        &rendered,
        &sha256,
        load_times,
        RenderTimes {
            trace,
            write,
            total,
        },
    );
    if let Some(path) = &args.stats {
        let mut json = serde_json::to_vec_pretty(&stats).map_err(Failure::new)?;
        json.push(b'\n');
        write_bytes(path, &json).map_err(Failure::new)?;
    }
    let cut = rendered.rays.cut_trees;
    if cut > 0 {
        eprintln!(
            "warning: {cut} branches were not followed because their trees had {} rays already; \
             raise --adc-bailout, lower --max-depth or raise --max-tree-rays",
            options.trace.max_tree_rays
        );
    }
    if !args.quiet {
        let rays = rendered.rays.total();
        eprintln!(
            "{}: {}x{}, {rays} rays in {trace:.2} s ({:.2} Mrays/s), {total:.2} s in all",
            output.display(),
            film.region.width,
            film.region.height,
            rays as f64 / trace.max(1e-9) / 1e6,
        );
    }
    Ok(())
}

/// Where the picture goes.
fn output_path(args: &RenderArgs) -> Result<PathBuf, Failure> {
    if let Some(output) = &args.output {
        return Ok(output.clone());
    }
    let name = args.scene.scene.file_name().filter(|name| *name != "-");
    let Some(name) = name.and_then(|n| n.to_str()) else {
        return Err(Failure::new("where shall the picture go? add -o PICTURE"));
    };
    let stem = name.strip_suffix(".gz").unwrap_or(name);
    let stem = stem.rsplit_once('.').map_or(stem, |(stem, _)| stem);
    Ok(PathBuf::from(format!("{stem}.png")))
}

/// Whether a file's folder exists: cheaper to know before the render than after.
fn check_folder(file: &Path) -> Result<(), Failure> {
    match file.parent() {
        Some(folder) if !folder.as_os_str().is_empty() && !folder.is_dir() => {
            Err(Failure::new(format!(
                "cannot write {}: there is no folder {}",
                file.display(),
                folder.display()
            )))
        }
        _ => Ok(()),
    }
}
