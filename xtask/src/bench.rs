//! Speed against other programs: interleaved runs, medians, ratios.

use crate::arguments::Arguments;
use crate::compare_pov::picture;
use crate::convert;
use crate::spd::KINDS;
use anyhow::{Context, Result, bail};
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

/// The options for rendering SPD scenes.
const SPD: [&str; 4] = ["--max-depth", "5", "--adc-bailout", "0"];

/// Trace times of the SPD scenes at 512x512, no antialiasing, equal depth, against POV-Ray and Tachyon.
pub(crate) fn spd(args: &[&str]) -> Result<()> {
    let (mut folder, mut runs, mut threads) = (PathBuf::from("../shared/data/spd"), 5, 1);
    let mut only: Vec<&str> = vec![];
    let mut args = Arguments::new(args);
    while let Some(option) = args.option() {
        match option {
            "--runs" => runs = args.number()?,
            "--threads" => threads = args.number()?,
            "--only" => only = args.value()?.split(',').collect(),
            other if other.starts_with('-') => bail!("unknown option {other}"),
            other => folder = PathBuf::from(other),
        }
    }
    if runs == 0 || threads == 0 {
        bail!("--runs and --threads must be at least 1");
    }
    let generated = tempfile::tempdir()?;
    let scenes = spd_scenes(&folder, &only, generated.path())?;
    build_strahl()?;
    println!(
        "Trace time in seconds, {threads} thread(s), medians of {runs}; how many times as fast strahl is."
    );
    println!(
        "| scene | strahl | Mrays/s | POV-Ray | faster by | pictures differ by | Tachyon | faster by |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    let (mut povray, mut tachyon) = (vec![], vec![]);
    for scene in &scenes {
        let row = one_scene(scene, runs, threads)?;
        povray.extend(row.povray);
        tachyon.extend(row.tachyon);
    }
    println!(
        "| geometric mean | | | | {} | | | {} |",
        geometric_mean(&povray),
        geometric_mean(&tachyon)
    );
    Ok(())
}

/// The chosen scenes (all, if `only` is empty) by name: those of the folder, and those that it lacks and that can be generated.
fn spd_scenes(folder: &Path, only: &[&str], generated: &Path) -> Result<Vec<PathBuf>> {
    let chosen = |name: &str| only.is_empty() || only.contains(&name);
    let mut scenes = BTreeMap::new();
    let entries = std::fs::read_dir(folder);
    let can_generate = |name: &&str| KINDS.iter().any(|kind| kind.name == *name);
    // Without a folder there is something to do if only generated scenes are wanted.
    if entries.is_ok() || only.is_empty() || !only.iter().all(can_generate) {
        for entry in entries.with_context(|| format!("cannot read {}", folder.display()))? {
            let path = entry?.path();
            if let Some(name) = spd_name(&path).filter(|name| chosen(name)) {
                scenes.insert(name, path);
            }
        }
    }
    for kind in KINDS {
        if chosen(kind.name) && !scenes.contains_key(kind.name) {
            scenes.insert(kind.name.to_owned(), kind.write_usual(generated)?);
        }
    }
    if let Some(missing) = only.iter().find(|name| !scenes.contains_key(**name)) {
        bail!(
            "there is no scene `{missing}`: {} has no {missing}.nff.gz, and it can't be generated",
            folder.display()
        );
    }
    Ok(scenes.into_values().collect())
}

/// The name of a scene, if the file is one.
fn spd_name(path: &Path) -> Option<String> {
    let name = path.file_name()?.to_str()?;
    name.strip_suffix(".nff.gz").map(str::to_owned)
}

/// The geometric mean, formatted for a table.
pub(crate) fn geometric_mean(ratios: &[f64]) -> String {
    let logarithms: f64 = ratios.iter().map(|r| r.ln()).sum();
    match ratios.len() {
        0 => String::new(),
        n => format!("{:.2}", (logarithms / n as f64).exp()),
    }
}

/// How many times as fast strahl is as the other programs on a scene.
struct Faster {
    povray: Option<f64>,
    /// `None` for scenes that Tachyon can't render.
    tachyon: Option<f64>,
}

fn one_scene(scene: &Path, runs: usize, threads: u32) -> Result<Faster> {
    let folder = tempfile::tempdir()?;
    let (pov, dat) = (
        folder.path().join("scene.pov"),
        folder.path().join("scene.dat"),
    );
    convert::to_pov(scene, &pov)?;
    let has_dat = convert::to_dat(scene, &dat).is_ok();
    let (mut ours, mut povray, mut tachyon, mut rays) = (vec![], vec![], vec![], 0.0);
    let pictures = ["out.png", "pov.png"].map(|name| folder.path().join(name));
    for _ in 0..runs {
        let (time, count) = run_strahl(scene, &pictures[0], threads, &SPD)?;
        ours.push(time);
        rays = count;
        povray.push(run_povray(&pov, &pictures[1], threads)?);
        if has_dat {
            tachyon.push(run_tachyon(&dat, folder.path(), threads)?);
        }
    }
    let faster = |theirs: &[f64]| {
        let mut ratios: Vec<f64> = ours.iter().zip(theirs).map(|(a, b)| b / a).collect();
        (!ratios.is_empty()).then(|| median(&mut ratios))
    };
    let faster = Faster {
        povray: faster(&povray),
        tachyon: faster(&tachyon),
    };
    let name = spd_name(scene).unwrap_or_default();
    let difference = difference(&name, [&pictures[0], &pictures[1]], f64::INFINITY)?;
    let ours = median(&mut ours);
    let peer = |times: &mut [f64], faster: Option<f64>| match faster {
        Some(faster) => format!("{:.3} | {faster:.2}", median(times)),
        None => "- | -".to_owned(),
    };
    println!(
        "| {name} | {ours:.3} | {:.2} | {} | {difference:.3} | {} |",
        rays / ours / 1e6,
        peer(&mut povray, faster.povray),
        peer(&mut tachyon, faster.tachyon),
    );
    Ok(faster)
}

/// The median.
pub(crate) fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// The mean difference of two pictures of a scene in 8-bit codes; an error if it is larger than `most`.
pub(crate) fn difference(scene: &str, pictures: [&Path; 2], most: f64) -> Result<f64> {
    let [ours, theirs] = [picture::read(pictures[0])?, picture::read(pictures[1])?];
    let (difference, _) =
        picture::compare(&ours, &theirs).context("the pictures have different sizes")?;
    if difference > most {
        bail!(
            "{scene}: the pictures differ by {difference:.2} in the mean, more than {most}; look at {} and {}",
            pictures[0].display(),
            pictures[1].display()
        );
    }
    Ok(difference)
}

/// Builds the release binary.
pub(crate) fn build_strahl() -> Result<()> {
    let status = Command::new("cargo")
        .args(["build", "--release", "--quiet", "-p", "strahl-cli"])
        .status()?;
    if !status.success() {
        bail!("strahl does not build");
    }
    Ok(())
}

/// The path of the release binary, which lies beside this program.
pub(crate) fn strahl_binary() -> Result<PathBuf> {
    let own = std::env::current_exe()?;
    Ok(own
        .parent()
        .context("the path of this program has no folder")?
        .join("strahl"))
}

/// The program that is measured on scenes.
static INSTALLED: OnceLock<PathBuf> = OnceLock::new();

/// Which program is measured on scenes.
#[derive(Debug, Default)]
pub(crate) enum Measured {
    /// A build with the recorded profile, as `scripts/install` makes it.
    #[default]
    Profiled,
    /// A build without it.
    Plain,
    /// One that is installed.
    Program(PathBuf),
}

impl Measured {
    /// Builds the program if need be; [`installed_strahl`] returns it then. Called at most once.
    pub(crate) fn prepare(&self) -> Result<()> {
        match self {
            Self::Profiled => install(&crate::profiled::build_with_profile()?),
            Self::Plain => {
                build_strahl()?;
                install(&strahl_binary()?)
            }
            Self::Program(program) => {
                let program = program
                    .canonicalize()
                    .with_context(|| format!("cannot find the program {}", program.display()))?;
                use_installed(program)
            }
        }
    }
}

/// Copies a build of the program, as `cargo install` does, and [uses](use_installed) the copy. A program as the linker has written it takes up to 5 % more
/// processor time on small pictures, because the system keeps its file in smaller pieces.
fn install(program: &Path) -> Result<()> {
    let copy = program.with_file_name("strahl-installed");
    // A new file: the old one would keep its pieces.
    if copy.exists() {
        std::fs::remove_file(&copy)?;
    }
    std::fs::copy(program, &copy).context("cannot copy strahl")?;
    use_installed(copy)
}

/// Makes [`installed_strahl`] return an installed program. Called at most once, as is [`install`].
fn use_installed(program: PathBuf) -> Result<()> {
    if INSTALLED.set(program).is_err() {
        bail!("an installed program was chosen before");
    }
    Ok(())
}

/// The path of the program that is measured on scenes.
pub(crate) fn installed_strahl() -> Result<&'static Path> {
    let program = INSTALLED.get().context("no installed program was chosen")?;
    Ok(program)
}

/// Renders a scene at 512x512 with one ray per pixel; returns the trace time in seconds and the number of rays.
pub(crate) fn run_strahl(
    scene: &Path,
    picture: &Path,
    threads: u32,
    options: &[&str],
) -> Result<(f64, f64)> {
    let stats = picture.with_extension("json");
    let status = Command::new(strahl_binary()?)
        .arg("render")
        .arg(scene)
        .args(["--size", "512x512", "--sampling", "center"])
        .args(options)
        .args(["--threads", &threads.to_string(), "--quiet", "--output"])
        .arg(picture)
        .arg("--stats")
        .arg(&stats)
        .status()
        .context("cannot run strahl")?;
    if !status.success() {
        bail!("strahl failed");
    }
    let stats: Value = serde_json::from_slice(&std::fs::read(stats)?)?;
    let time = stats["time_s"]["trace"].as_f64().context("no trace time")?;
    let rays = ["primary", "shadow", "reflection", "refraction"];
    Ok((
        time,
        rays.iter()
            .filter_map(|kind| stats["rays"][kind].as_f64())
            .sum(),
    ))
}

/// Renders a scene with POV-Ray; returns the trace time in seconds.
pub(crate) fn run_povray(scene: &Path, picture: &Path, threads: u32) -> Result<f64> {
    let output = Command::new("povray")
        .arg(format!("+I{}", scene.display()))
        .arg(format!("+O{}", picture.display()))
        .args(["+W512", "+H512", "-A", "-D", &format!("+WT{threads}")])
        .output()
        .context("cannot run povray (Debian package povray)")?;
    // "Trace Time:       0 hours  0 minutes  0 seconds (0.605 seconds)"
    seconds_in(&output.stderr, "Trace Time", '(').context("povray printed no trace time")
}

fn run_tachyon(scene: &Path, folder: &Path, threads: u32) -> Result<f64> {
    let output = Command::new("tachyon")
        .arg(scene)
        .arg("-o")
        .arg(folder.join("tachyon.tga"))
        // Mirroring in x reverses the winding of the triangles, so their normals must be flipped.
        .args(["-shade_phong", "-normalfixup", "flip", "+V"])
        .args(["-numthreads", &threads.to_string()])
        .output()
        .context("cannot run tachyon (Debian package tachyon)")?;
    // "  Ray Tracing Time:     0.0719 seconds"
    seconds_in(&output.stdout, "Ray Tracing Time", ':').context("tachyon printed no trace time")
}

/// The number of seconds after the character `before`, in the line that begins with `words`.
fn seconds_in(log: &[u8], words: &str, before: char) -> Result<f64> {
    let log = String::from_utf8_lossy(log);
    let line = log
        .lines()
        .rfind(|line| line.trim_start().starts_with(words));
    let seconds = line
        .and_then(|line| line.rsplit_once(before))
        .and_then(|(_, s)| s.split_whitespace().next()?.parse().ok());
    seconds.with_context(|| format!("no line begins with `{words}` in:\n{log}"))
}

#[cfg(test)]
mod tests {
    use super::{spd_name, spd_scenes};
    use std::path::Path;

    #[test]
    fn scenes_of_the_folder_come_before_generated_ones() {
        let [folder, generated] = [tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap()];
        for name in ["balls.nff.gz", "tree.nff.gz", "README.md", "plain.nff"] {
            std::fs::write(folder.path().join(name), "").unwrap();
        }
        let scenes = |folder: &Path, only: &[&str]| spd_scenes(folder, only, generated.path());
        let found = scenes(folder.path(), &[]).unwrap();
        let names: Vec<String> = found.iter().filter_map(|path| spd_name(path)).collect();
        assert_eq!(names, ["balls", "lattice", "rings", "tree"]);
        let own: Vec<bool> = found.iter().map(|p| p.starts_with(&folder)).collect();
        assert_eq!(own, [true, false, false, true]);

        let found = scenes(folder.path(), &["tree", "balls"]).unwrap();
        assert_eq!(found.len(), 2);
        let error = scenes(folder.path(), &["balls", "cube"]).unwrap_err();
        assert!(error.to_string().contains("no scene `cube`"), "{error}");

        let missing = folder.path().join("missing");
        assert_eq!(scenes(&missing, &["rings"]).unwrap().len(), 1);
        for only in [&[][..], &["rings", "balls"]] {
            let error = scenes(&missing, only).unwrap_err().to_string();
            assert!(error.contains("cannot read"), "{error}");
        }
    }
}
