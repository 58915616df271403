//! Records the profile that the program is compiled with: a build that counts renders scenes of ours.
//!
//! Code that never runs while the profile is recorded is compiled as code that hardly runs, and so is code that runs much less often than that of
//! the slowest run. So no run takes much longer than the others, and the scenes use every object, pattern, light and camera, and are
//! rendered with every level of vector instructions, accelerator, format and way of sampling.

use crate::arguments::Arguments;
use crate::compare_pov::find_scenes;
use crate::profiled;
use crate::{bench_load, lab};
use anyhow::{Context, Result, bail};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Options of the renderings of each scene of the repository.
const SCENES: [&[&str]; 6] = [
    &["--size", "160x120", "--sampling", "center"],
    &["--size", "160x120", "+A0.3"],
    &["--size", "96x72", "+A0.1", "+AM2"],
    &["--size", "64x48", "--sampling", "center", "--simd", "avx2"],
    &["--size", "64x48", "--sampling", "center", "--simd", "sse4"],
    &[
        "--size",
        "64x48",
        "--sampling",
        "center",
        "--simd",
        "scalar",
    ],
];

/// Options of the renderings of files with many triangles, polygons and spheres.
const FILES: [&[&str]; 14] = [
    &["--sampling", "center"],
    &["+A0.3"],
    &["--simd", "avx2"],
    &["--simd", "sse4"],
    &["--simd", "scalar"],
    &["--no-packets"],
    &["--accelerator", "bvh:compact"],
    &["--accelerator", "bvh:build=fast"],
    &["--accelerator", "bvh:build=high"],
    &["--accelerator", "bvh2"],
    &["--accelerator", "spheres"],
    &["--accelerator", "grid"],
    &["--accelerator", "grids"],
    &["--accelerator", "octree"],
];

/// `cargo xtask record`
pub(crate) fn run(args: &[&str]) -> Result<()> {
    let mut output = profiled::profile()?;
    let mut args = Arguments::new(args);
    while let Some(option) = args.option() {
        match option {
            "--out" => output = std::path::absolute(args.value()?)?,
            other => bail!("unknown option {other}"),
        }
    }
    let merger = merger()?;
    let counts = tempfile::tempdir()?;
    let program = profiled::build(
        &profiled::outputs()?.join("recording"),
        &format!("-Cprofile-generate={}", counts.path().display()),
    )?;
    let work = tempfile::tempdir()?;
    let mut recording = Recording {
        program,
        // The processes that end add what they counted to one of four files.
        counts: counts.path().join("counts-%4m.profraw"),
        work: work.path().to_owned(),
        failed: vec![],
    };
    recording.scenes()?;
    recording.files()?;
    recording.questions()?;
    if !recording.failed.is_empty() {
        bail!(
            "these runs failed, no profile was written:\n  {}",
            recording.failed.join("\n  ")
        );
    }
    let temporary = output.with_extension("tmp");
    let status = Command::new(merger)
        .args(["merge", "--sparse", "-o"])
        .arg(&temporary)
        .arg(counts.path())
        .status()
        .context("cannot run llvm-profdata")?;
    if !status.success() {
        bail!(
            "llvm-profdata cannot merge the counts: it must be of the LLVM of `rustc -vV`, or newer"
        );
    }
    std::fs::rename(&temporary, &output)?;
    println!("written: {}", output.display());
    Ok(())
}

/// The program that merges counts: `rustup component add llvm-tools` installs the compiler's own; a package of the same LLVM or a newer one serves as well.
fn merger() -> Result<PathBuf> {
    let output = Command::new("rustc")
        .args(["--print", "target-libdir"])
        .output()
        .context("cannot run rustc")?;
    let library = PathBuf::from(String::from_utf8(output.stdout)?.trim());
    let own = library.with_file_name("bin").join("llvm-profdata");
    let version = String::from_utf8(Command::new("rustc").arg("-vV").output()?.stdout)?;
    let version = version
        .lines()
        .find_map(|line| line.strip_prefix("LLVM version: "))
        .and_then(|version| version.split('.').next())
        .context("rustc does not say the version of its LLVM")?;
    let package = format!("llvm-profdata-{version}");
    [own, PathBuf::from(&package), PathBuf::from("llvm-profdata")]
        .into_iter()
        .find(|program| {
            let mut command = Command::new(program);
            command.arg("--version").stdout(Stdio::null());
            command.status().is_ok_and(|status| status.success())
        })
        .with_context(|| {
            format!("llvm-profdata is missing: `rustup component add llvm-tools`, or install the package llvm-{version}")
        })
}

/// A recording that goes on.
struct Recording {
    program: PathBuf,
    counts: PathBuf,
    /// A folder for pictures and generated files.
    work: PathBuf,
    /// The command lines that failed.
    failed: Vec<String>,
}

impl Recording {
    /// The scenes of the repository.
    fn scenes(&mut self) -> Result<()> {
        let mut scenes = vec![];
        find_scenes(&std::path::absolute("scenes")?, &mut scenes)?;
        scenes.sort();
        for (number, scene) in scenes.iter().enumerate() {
            eprintln!("{}/{} {}", number + 1, scenes.len(), scene.display());
            for options in SCENES {
                self.render(scene, "picture.png", options)?;
            }
        }
        Ok(())
    }

    /// Large files of every format, with every accelerator, in every format of pictures.
    fn files(&mut self) -> Result<()> {
        let mut files = bench_load::small_scenes(&self.work)?;
        let crystal = self.work.join("crystal.nff");
        std::fs::write(&crystal, lab::generate("crystal", Some("12"))?)?;
        files.push(crystal);
        for file in &files {
            eprintln!("{}", file.display());
            for options in FILES {
                self.render(
                    file,
                    "picture.png",
                    &[&["--size", "96x72"], options].concat(),
                )?;
            }
        }
        let scene = PathBuf::from("scenes/showcase/whitted.pov");
        for ending in ["exr", "hdr", "ppm", "jpg", "bmp", "tga"] {
            self.render(&scene, &format!("picture.{ending}"), &["--size", "160x120"])?;
        }
        self.render(&scene, "layers.exr", &["--size", "160x120", "--layers"])?;
        self.render(&scene, "alpha.png", &["--size", "160x120", "+UA", "+FN16"])
    }

    /// Questions about a scene.
    fn questions(&mut self) -> Result<()> {
        let scene = "scenes/showcase/whitted.pov";
        let size = ["--size", "96x72"];
        let picture = self.work.join("picture.png");
        let picture = picture.to_string_lossy().into_owned();
        self.strahl(&[&["explain", scene, "--pixel", "48,36"][..], &size].concat())?;
        self.strahl(&[&["heatmap", scene, "--output", &picture][..], &size].concat())?;
        self.strahl(&[&["compare", "scenes/spheres.nff"][..], &size].concat())?;
        self.strahl(&["info", scene])?;
        self.strahl(&["check", scene])
    }

    fn render(&mut self, scene: &Path, picture: &str, options: &[&str]) -> Result<()> {
        let (scene, picture) = (scene.to_string_lossy(), self.work.join(picture));
        let picture = picture.to_string_lossy();
        let command = [
            "render",
            &scene,
            "--threads",
            "1",
            "--quiet",
            "--output",
            &picture,
        ];
        self.strahl(&[&command[..], options].concat())
    }

    fn strahl(&mut self, args: &[&str]) -> Result<()> {
        let status = Command::new(&self.program)
            .args(args)
            .env("LLVM_PROFILE_FILE", &self.counts)
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .status()?;
        if !status.success() {
            self.failed.push(args.join(" "));
        }
        Ok(())
    }
}
