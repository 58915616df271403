//! Processor time of both programs on real scenes, in turns. Only scenes count of which both make the same picture.

mod antialiasing;
pub(crate) mod measure;
mod report;

use crate::arguments::Arguments;
use crate::bench::Measured;
use crate::compare_pov::{find_scenes, picture, size};
use anyhow::{Result, bail};
use measure::{Program, Timed};
use std::path::{Path, PathBuf};

/// Pictures with a larger mean difference (of the channels, in 8-bit codes) count as different.
const SAME: f64 = 4.0;

/// The measurements of a scene.
pub(crate) struct Row {
    /// Path below the folder.
    pub(crate) scene: String,
    /// Median processor seconds.
    pub(crate) povray: f64,
    pub(crate) strahl: f64,
    /// Root mean square error of both programs' antialiased pictures against their own converged ones, in 8-bit codes.
    pub(crate) errors: Option<(f64, f64)>,
}

/// The options of the command.
pub(crate) struct Options {
    folder: PathBuf,
    out: PathBuf,
    size: (u32, u32),
    runs: usize,
    limit: usize,
    only: Option<String>,
    antialiased: bool,
    /// Whether to render converged pictures as well.
    errors: bool,
    measured: Measured,
    /// Scenes that take POV-Ray more seconds than this are left out.
    most: f64,
}

impl Options {
    fn new(args: &[&str]) -> Result<Self> {
        let mut options = Self {
            folder: PathBuf::from(crate::compare_pov::EXAMPLES),
            out: PathBuf::from("target/bench-scenes"),
            size: (320, 240),
            runs: 3,
            limit: usize::MAX,
            only: None,
            antialiased: false,
            errors: false,
            measured: Measured::default(),
            most: 120.0,
        };
        let mut args = Arguments::new(args);
        while let Some(option) = args.option() {
            match option {
                "--size" => options.size = size(args.value()?)?,
                "--runs" => options.runs = args.number()?,
                "--limit" => options.limit = args.number()?,
                "--most" => options.most = args.number()?,
                "--only" => options.only = Some(args.value()?.to_owned()),
                "--out" => options.out = PathBuf::from(args.value()?),
                "--aa" => options.antialiased = true,
                "--plain" => options.measured = Measured::Plain,
                "--program" => options.measured = Measured::Program(args.value()?.into()),
                "--errors" => (options.antialiased, options.errors) = (true, true),
                other if other.starts_with('-') => bail!("unknown option {other}"),
                folder => options.folder = PathBuf::from(folder),
            }
        }
        if options.runs == 0 {
            bail!("--runs must be at least 1");
        }
        // The programs run in other folders.
        options.folder = std::path::absolute(&options.folder)?;
        options.out = std::path::absolute(&options.out)?;
        Ok(options)
    }
}

/// `cargo xtask bench scenes`
pub(crate) fn run(args: &[&str]) -> Result<()> {
    let options = Options::new(args)?;
    if !options.folder.is_dir() {
        bail!(
            "there is no folder {}: install Debian's package povray-examples, or name a folder with .pov scenes",
            options.folder.display()
        );
    }
    let mut scenes = vec![];
    find_scenes(&options.folder, &mut scenes)?;
    scenes.sort();
    if let Some(part) = &options.only {
        scenes.retain(|s| s.to_string_lossy().contains(part.as_str()));
    }
    scenes.truncate(options.limit);
    std::fs::create_dir_all(&options.out)?;
    options.measured.prepare()?;
    let mut rows = vec![];
    let mut left_out = 0;
    for (number, scene) in scenes.iter().enumerate() {
        let name = scene.strip_prefix(&options.folder).unwrap_or(scene);
        let name = name.to_string_lossy().into_owned();
        match one_scene(scene, name.clone(), &options)? {
            Ok(row) => {
                eprintln!("{}/{} {}", number + 1, scenes.len(), report::line(&row));
                rows.push(row);
            }
            Err(why) => {
                eprintln!("{}/{} {name}: left out: {why}", number + 1, scenes.len());
                left_out += 1;
            }
        }
    }
    print!("{}", report::table(&mut rows, left_out));
    let stem = if options.antialiased {
        "scenes-aa"
    } else {
        "scenes"
    };
    let (table, histogram) = (
        options.out.join(format!("{stem}.tsv")),
        options.out.join(format!("{stem}.svg")),
    );
    std::fs::write(&table, report::tsv(&rows))?;
    std::fs::write(&histogram, report::histogram(&rows))?;
    println!("written: {} and {}", table.display(), histogram.display());
    Ok(())
}

/// Measures a scene, or returns why it is left out.
fn one_scene(scene: &Path, name: String, options: &Options) -> Result<Result<Row, String>> {
    let folder = tempfile::tempdir()?;
    let pictures =
        [Program::PovRay, Program::Strahl].map(|program| folder.path().join(program.picture()));
    let mut times = [vec![], vec![]];
    for round in 0..options.runs {
        for (index, program) in [Program::PovRay, Program::Strahl].into_iter().enumerate() {
            let sampling = if options.antialiased {
                program.antialiased()
            } else {
                program.plain()
            };
            match measure::render(
                program,
                scene,
                &pictures[index],
                options.size,
                sampling,
                options.most,
            )? {
                Timed::Seconds(seconds) => times[index].push(seconds),
                Timed::Failed(why) => return Ok(Err(format!("{}: {why}", program.name()))),
            }
        }
        if round == 0 {
            let (theirs, ours) = (picture::read(&pictures[0])?, picture::read(&pictures[1])?);
            match picture::compare(&theirs, &ours) {
                Some((difference, _)) if difference < SAME => {}
                Some((difference, _)) => {
                    return Ok(Err(format!("the pictures differ by {difference:.1}")));
                }
                None => return Ok(Err("the pictures have other sizes".to_owned())),
            }
        }
    }
    let errors = match options.errors {
        true => antialiasing::errors(scene, &pictures, options)?,
        false => None,
    };
    let [mut povray, mut strahl] = times;
    Ok(Ok(Row {
        scene: name,
        povray: crate::bench::median(&mut povray),
        strahl: crate::bench::median(&mut strahl),
        errors,
    }))
}
