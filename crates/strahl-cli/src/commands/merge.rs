use crate::args::MergeArgs;
use crate::output::{self, is_standard};
use crate::report::{Failure, Reporter};
use crate::target::{Target, check_distinct, check_folder};
use crate::work;
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::Path;
use std::time::Instant;
use strahl::formats::image::WriteOptions;
use strahl_farm::Merged;

/// The statistics of a merged picture: the keys of `render`'s that have a meaning here.
#[derive(Debug, Serialize)]
struct MergeStats<'a> {
    rays: &'a BTreeMap<String, u64>,
    tiles: u32,
    image: Image<'a>,
}

#[derive(Debug, Serialize)]
struct Image<'a> {
    width: u32,
    height: u32,
    sha256: &'a str,
}

/// `strahl merge`: puts the tiles of a picture together.
pub(crate) fn run(args: &MergeArgs) -> Result<(), Failure> {
    let start = Instant::now();
    let reporter = Reporter::new(args.quiet);
    let target = Target::named(&args.output, args.picture_format)?;
    let stats = args.stats.as_deref();
    if stats.is_some_and(is_standard) && target.file().is_none() {
        return Err(Failure::new(
            "picture and statistics can't both go to the standard output: name a file for one of them",
        ));
    }
    let stats = stats.filter(|file| !is_standard(file));
    if let Some(file) = stats {
        check_folder(file)?;
    }
    check_distinct(&target.file().into_iter().chain(stats).collect::<Vec<_>>())?;
    let real = |path: &Path| path.canonicalize().ok();
    target.check_grayscale(args.grayscale)?;
    for file in target.file().into_iter().chain(stats) {
        let own = real(file);
        if own.is_some() && args.tiles.iter().any(|tile| real(tile) == own) {
            return Err(Failure::new(format!(
                "{} is one of the tiles, which must not be overwritten",
                file.display()
            )));
        }
    }
    work::doing("reading tiles");
    let merged = strahl_farm::merge(&args.tiles).map_err(Failure::new)?;
    work::doing(format!("writing {}", target.shown()));
    let options = WriteOptions {
        bit_depth: args.bit_depth,
        grayscale: args.grayscale,
        jpeg_quality: args.jpeg_quality,
        ..WriteOptions::default()
    };
    write(&merged, &target, &options, &reporter)?;
    statistics(&merged, args)?;
    let film = &merged.film;
    let s = if merged.tiles == 1 { "" } else { "s" };
    reporter.say(&format!(
        "{}: {}x{} of {} tile{s}, {:.2} s",
        target.shown(),
        film.width,
        film.height,
        merged.tiles,
        start.elapsed().as_secs_f64()
    ));
    reporter.settle()
}

/// Writes a merged picture with the metadata of a picture that was rendered at once.
fn write(
    merged: &Merged,
    target: &Target,
    options: &WriteOptions,
    reporter: &Reporter,
) -> Result<(), Failure> {
    let film = &merged.film;
    let mut layers = strahl::layers(film);
    if !layers.is_empty() && !target.format().info().layers {
        reporter.say("note: the tiles have layers, which only .exr pictures can keep");
        layers.clear();
    }
    let mut metadata = strahl::metadata();
    metadata.extend(merged.notes.iter().cloned());
    target.write(&strahl::picture(film, &layers, metadata), options)
}

fn statistics(merged: &Merged, args: &MergeArgs) -> Result<(), Failure> {
    let Some(path) = &args.stats else {
        return Ok(());
    };
    let sha256 = merged.film.sha256();
    let stats = MergeStats {
        rays: &merged.rays,
        tiles: merged.tiles,
        image: Image {
            width: merged.film.width,
            height: merged.film.height,
            sha256: &sha256,
        },
    };
    output::json(path, &stats)
}
