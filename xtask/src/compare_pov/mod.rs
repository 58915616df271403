//! Renders a folder of .pov scenes with POV-Ray and with strahl, and reports how different the pictures are.
//!
//! Nothing is written beside the scenes: both programs work in scratch folders, pictures and results go to `--out`.

pub(crate) mod picture;
pub(crate) mod programs;
mod report;

use crate::arguments::Arguments;
use crate::parallel::in_parallel;
use anyhow::{Context, Result, bail};
use programs::{Outcome, Programs};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

/// The folder of Debian's package povray-examples.
pub(crate) const EXAMPLES: &str = "/usr/share/doc/povray/examples";

/// Words for features that a classical ray tracer doesn't have: its picture differs.
const MARKS: [&str; 4] = ["radiosity", "photons", "media", "subsurface"];

/// The results of a scene.
struct Row {
    /// Path below the folder.
    scene: String,
    /// Those of [`MARKS`] that the scene uses.
    marks: Vec<&'static str>,
    povray: Outcome,
    strahl: Outcome,
    /// Whether strahl reads the scene without an error.
    parses: bool,
    /// Mean absolute difference of the channels and its root mean square, in 8-bit codes.
    difference: Option<(f64, f64)>,
}

struct Options {
    folder: PathBuf,
    size: (u32, u32),
    limit: usize,
    jobs: usize,
    out: PathBuf,
    only: Option<String>,
}

impl Options {
    fn new(args: &[&str]) -> Result<Self> {
        let mut options = Self {
            folder: PathBuf::from(EXAMPLES),
            size: (160, 120),
            limit: usize::MAX,
            jobs: 2,
            out: PathBuf::from("target/compare-pov/report"),
            only: None,
        };
        let mut args = Arguments::new(args);
        while let Some(option) = args.option() {
            match option {
                "--size" => options.size = size(args.value()?)?,
                "--limit" => options.limit = args.number()?,
                "--jobs" => options.jobs = args.number()?,
                "--out" => options.out = PathBuf::from(args.value()?),
                "--only" => options.only = Some(args.value()?.to_owned()),
                other if other.starts_with('-') => bail!("unknown option {other}"),
                folder => options.folder = PathBuf::from(folder),
            }
        }
        // The programs run in other folders.
        options.folder = std::path::absolute(&options.folder)?;
        Ok(options)
    }
}

/// A size such as `160x120`.
pub(crate) fn size(text: &str) -> Result<(u32, u32)> {
    let (w, h) = text
        .split_once('x')
        .context("--size needs WIDTHxHEIGHT, such as 160x120")?;
    Ok((w.parse()?, h.parse()?))
}

/// `cargo xtask compare-pov`
pub(crate) fn run(args: &[&str]) -> Result<()> {
    let options = Options::new(args)?;
    let folder = &options.folder;
    if !folder.is_dir() {
        bail!(
            "there is no folder {}: install Debian's package povray-examples, or name a folder with .pov scenes",
            folder.display()
        );
    }
    let mut scenes = vec![];
    find_scenes(folder, &mut scenes)?;
    scenes.sort();
    if let Some(part) = &options.only {
        scenes.retain(|s| s.to_string_lossy().contains(part.as_str()));
    }
    scenes.truncate(options.limit);
    if scenes.is_empty() {
        bail!("there are no .pov scenes below {}", folder.display());
    }
    let programs = Programs::new(options.size, None)?;
    let images = options.out.join("images");
    std::fs::create_dir_all(&images)
        .with_context(|| format!("cannot create {}", images.display()))?;

    let rows = compare_all(&options, &scenes, &programs)?;
    report::write_tsv(&rows, &options.out.join("compare-pov.tsv"))?;
    report::write_html(&rows, options.size, &options.out.join("index.html"))?;
    print!("{}", report::totals(&rows));
    println!("report: {}", options.out.join("index.html").display());
    Ok(())
}

/// Compares the pictures of all scenes with several threads; the rows are in the order of the scenes.
fn compare_all(options: &Options, scenes: &[PathBuf], programs: &Programs) -> Result<Vec<Row>> {
    let done = AtomicUsize::new(0);
    in_parallel(scenes, options.jobs, |index, scene| {
        let row = compare(options, scene, index, programs)?;
        let done = done.fetch_add(1, Ordering::Relaxed) + 1;
        eprintln!("{done}/{} {}", scenes.len(), report::line(&row));
        Ok(row)
    })
}

fn compare(options: &Options, scene: &Path, index: usize, programs: &Programs) -> Result<Row> {
    let images = options.out.join("images");
    let file = |who: &str| images.join(format!("{index:04}-{who}.png"));
    let (theirs, ours, apart) = (file("povray"), file("strahl"), file("difference"));
    for file in [&theirs, &ours, &apart] {
        // A picture of an earlier run must not be taken for one of this run.
        let _ = std::fs::remove_file(file);
    }
    let bytes = std::fs::read(scene)?;
    let povray = programs.povray(scene, &bytes, &theirs)?;
    let strahl = programs.strahl(scene, &ours)?;
    let parses = strahl.rendered || programs.parses(scene)?;
    let mut difference = None;
    if povray.rendered && strahl.rendered {
        let (a, b) = (picture::read(&theirs)?, picture::read(&ours)?);
        difference = picture::compare(&a, &b);
        if difference.is_some() {
            picture::write_difference(&a, &b, &apart)?;
        }
    }
    let name = scene.strip_prefix(&options.folder).unwrap_or(scene);
    Ok(Row {
        scene: name.to_string_lossy().into_owned(),
        marks: marks(&String::from_utf8_lossy(&bytes)),
        povray,
        strahl,
        parses,
        difference,
    })
}

/// All .pov files below a folder.
pub(crate) fn find_scenes(folder: &Path, found: &mut Vec<PathBuf>) -> Result<()> {
    let entries =
        std::fs::read_dir(folder).with_context(|| format!("cannot read {}", folder.display()))?;
    for entry in entries {
        let entry = entry?;
        let (path, kind) = (entry.path(), entry.file_type()?);
        if kind.is_dir() {
            find_scenes(&path, found)?;
        } else if path
            .extension()
            .is_some_and(|e| e.eq_ignore_ascii_case("pov"))
        {
            found.push(path);
        }
    }
    Ok(())
}

/// Those of [`MARKS`] that are followed by a brace, outside of comments.
fn marks(text: &str) -> Vec<&'static str> {
    let code: String = text
        .lines()
        .map(|line| line.split("//").next().unwrap_or_default())
        .collect::<Vec<_>>()
        .join("\n");
    let opens = |word: &str| {
        code.match_indices(word).any(|(at, _)| {
            let before = code[..at].chars().next_back();
            let inside = before.is_some_and(|c| c.is_alphanumeric() || c == '_');
            !inside && code[at + word.len()..].trim_start().starts_with('{')
        })
    };
    MARKS.into_iter().filter(|word| opens(word)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_are_words_before_a_brace() {
        let text = "// media { }\ninterior {\n  media\n { } } #declare Radiosity=1; my_photons { }";
        assert_eq!(marks(text), ["media"]);
        assert!(marks("radiosity off photons 1").is_empty());
    }
}
