//! Runs a program on a scene and measures the processor time of the whole process.

use anyhow::{Context, Result};
use nix::sys::resource::{UsageWho, getrusage};
use nix::sys::time::TimeValLike;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// One of the two programs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Program {
    /// POV-Ray 3.7.
    PovRay,
    /// The release build of strahl.
    Strahl,
}

/// The outcome of a run.
pub(crate) enum Timed {
    /// Processor seconds, user and system.
    Seconds(f64),
    /// No picture was written, for this reason.
    Failed(String),
}

impl Program {
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::PovRay => "POV-Ray",
            Self::Strahl => "strahl",
        }
    }

    pub(crate) fn picture(self) -> &'static str {
        match self {
            Self::PovRay => "povray.png",
            Self::Strahl => "strahl.png",
        }
    }

    /// Options for one ray per pixel.
    pub(crate) fn plain(self) -> &'static [&'static str] {
        match self {
            Self::PovRay => &["-A"],
            Self::Strahl => &["--sampling", "center"],
        }
    }

    /// Options for the usual antialiasing.
    pub(crate) fn antialiased(self) -> &'static [&'static str] {
        match self {
            Self::PovRay => &["+A0.3"],
            Self::Strahl => &["+A0.3"],
        }
    }

    /// Options for the largest number of rays per pixel that POV-Ray allows.
    pub(crate) fn converged(self) -> &'static [&'static str] {
        match self {
            Self::PovRay => &["+A0.0", "+R9"],
            Self::Strahl => &["+A0.0", "+R9"],
        }
    }
}

/// Renders a scene with one thread; stops the program after `most` seconds of wall time.
pub(crate) fn render(
    program: Program,
    scene: &Path,
    picture: &Path,
    (width, height): (u32, u32),
    sampling: &[&str],
    most: f64,
) -> Result<Timed> {
    let scratch = tempfile::tempdir()?;
    let mut command = match program {
        Program::PovRay => {
            let mut command = Command::new("povray");
            command
                .arg(format!("+I{}", scene.display()))
                .arg(format!("+O{}", picture.display()))
                .args([format!("+W{width}"), format!("+H{height}")])
                .args(["+FN", "-D", "-GA", "+WT1"]);
            if let Some(folder) = scene.parent() {
                command.arg(format!("+L{}", folder.display()));
            }
            command
        }
        Program::Strahl => {
            let mut command = Command::new(crate::bench::installed_strahl()?);
            command
                .arg("render")
                .arg(scene)
                .args([
                    "--size",
                    &format!("{width}x{height}"),
                    "--threads",
                    "1",
                    "--quiet",
                ])
                .arg("--allow-write")
                .arg(scratch.path())
                .arg("--output")
                .arg(picture);
            command
        }
    };
    let before = spent()?;
    let mut child = command
        .args(sampling)
        .current_dir(scratch.path())
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .with_context(|| format!("cannot run {}", program.name()))?;
    let start = Instant::now();
    let status = loop {
        if let Some(status) = child.try_wait()? {
            break status;
        }
        if start.elapsed().as_secs_f64() > most {
            child.kill()?;
            child.wait()?;
            return Ok(Timed::Failed(format!("stopped after {most} s")));
        }
        std::thread::sleep(Duration::from_millis(2));
    };
    if !status.success() || !picture.is_file() {
        return Ok(Timed::Failed("no picture".to_owned()));
    }
    Ok(Timed::Seconds(spent()? - before))
}

/// Processor seconds of all child processes that have ended.
fn spent() -> Result<f64> {
    let usage = getrusage(UsageWho::RUSAGE_CHILDREN)?;
    let total = usage.user_time() + usage.system_time();
    Ok(total.num_microseconds() as f64 * 1e-6)
}
