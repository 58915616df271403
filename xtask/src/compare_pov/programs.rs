use anyhow::{Context, Result, bail};
use sha2::{Digest, Sha256};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// The default time limit for a scene.
const TIMEOUT: Duration = Duration::from_secs(120);

/// The outcome of a program on a scene.
#[derive(Clone, Debug)]
pub(crate) struct Outcome {
    /// Whether there is a picture.
    pub(crate) rendered: bool,
    /// Whether the time limit ended the program.
    pub(crate) stopped: bool,
    /// Seconds of wall time, reading included.
    pub(crate) seconds: f64,
    /// The first error, or else the first warning.
    pub(crate) reason: String,
    /// The features that strahl reports as left out.
    pub(crate) lacks: BTreeSet<String>,
}

/// Both programs, with the size of the pictures.
#[derive(Clone)]
pub(crate) struct Programs {
    strahl: PathBuf,
    cache: PathBuf,
    size: (u32, u32),
    /// The time limit for a scene.
    pub(crate) timeout: Duration,
    /// Include files of this folder come before those built into strahl.
    pub(crate) library: Option<PathBuf>,
}

impl Programs {
    /// Looks for POV-Ray. If no binary of strahl is given, builds the release binary and uses that.
    pub(crate) fn new(size: (u32, u32), strahl: Option<&Path>) -> Result<Self> {
        let known = Command::new("povray").arg("--version").output();
        if known.is_err() {
            bail!("POV-Ray is missing: install Debian's package povray");
        }
        let strahl = match strahl {
            Some(binary) => std::path::absolute(binary)?,
            None => {
                crate::bench::build_strahl()?;
                std::path::absolute(crate::bench::strahl_binary()?)?
            }
        };
        let cache = PathBuf::from("target/compare-pov/cache");
        std::fs::create_dir_all(&cache)?;
        Ok(Self {
            strahl,
            cache,
            size,
            timeout: TIMEOUT,
            library: None,
        })
    }

    /// The same programs with another picture size.
    pub(crate) fn sized(&self, size: (u32, u32)) -> Self {
        Self {
            size,
            ..self.clone()
        }
    }

    /// POV-Ray's picture, from the cache if the scene has not changed.
    pub(crate) fn povray(&self, scene: &Path, bytes: &[u8], picture: &Path) -> Result<Outcome> {
        let (w, h) = self.size;
        let mut hash = Sha256::new();
        hash.update(bytes);
        hash.update(scene.as_os_str().as_encoded_bytes());
        let digest = hash.finalize();
        let key: String = digest.iter().take(12).map(|b| format!("{b:02x}")).collect();
        let kept = self.cache.join(format!("{key}-{w}x{h}.png"));
        let note = kept.with_extension("txt");
        if let Some(outcome) = read_note(&note) {
            if outcome.rendered {
                std::fs::copy(&kept, picture)?;
            }
            return Ok(outcome);
        }
        let scratch = tempfile::tempdir()?;
        let output = scratch.path().join("picture.png");
        let mut outcome = self.run_povray(scene, scratch.path(), &output)?;
        outcome.reason = match outcome.rendered {
            true => String::new(),
            false => povray_reason(&outcome.reason),
        };
        if outcome.rendered {
            std::fs::copy(&output, &kept)?;
            std::fs::copy(&output, picture)?;
        }
        let state = if outcome.rendered {
            "rendered"
        } else {
            "failed"
        };
        let text = format!("{state}\n{}\n{}\n", outcome.seconds, outcome.reason);
        std::fs::write(note, text)?;
        Ok(outcome)
    }

    /// Runs POV-Ray in a folder, without antialiasing and with one thread; `reason` is its whole output.
    pub(crate) fn run_povray(&self, scene: &Path, folder: &Path, output: &Path) -> Result<Outcome> {
        self.run_povray_on(scene, folder, output, None)
    }

    /// The same for one pixel, if one is given; the rest of the picture is black then.
    pub(crate) fn run_povray_on(
        &self,
        scene: &Path,
        folder: &Path,
        output: &Path,
        pixel: Option<(u32, u32)>,
    ) -> Result<Outcome> {
        let (w, h) = self.size;
        let mut command = Command::new("povray");
        command
            .arg(format!("+I{}", scene.display()))
            .arg(format!("+O{}", output.display()))
            .arg(format!("+L{}", parent(scene).display()))
            .args([format!("+W{w}"), format!("+H{h}")])
            .args(["-A", "+FN", "-D", "+WT1"]);
        if let Some((x, y)) = pixel {
            // POV-Ray counts from 1.
            let (column, row) = (x + 1, y + 1);
            command.args([format!("+SC{column}"), format!("+EC{column}")]);
            command.args([format!("+SR{row}"), format!("+ER{row}")]);
        }
        run(command, folder, output, self.timeout)
    }

    /// Runs strahl in a folder, without antialiasing and with one thread; `reason` is its whole output.
    pub(crate) fn run_strahl(&self, scene: &Path, folder: &Path, output: &Path) -> Result<Outcome> {
        let (w, h) = self.size;
        let mut command = self.command("render", scene, folder);
        command
            .args(["--size", &format!("{w}x{h}")])
            .args(["--sampling", "center", "--threads", "1", "--output"])
            .arg(output);
        if let Some(library) = &self.library {
            command.arg("-L").arg(library);
        }
        run(command, folder, output, self.timeout)
    }

    /// Strahl's picture.
    pub(crate) fn strahl(&self, scene: &Path, picture: &Path) -> Result<Outcome> {
        let scratch = tempfile::tempdir()?;
        let output = scratch.path().join("picture.png");
        let mut outcome = self.run_strahl(scene, scratch.path(), &output)?;
        outcome.lacks = lacks(&outcome.reason);
        outcome.reason = strahl_reason(&outcome.reason);
        if outcome.rendered {
            std::fs::copy(&output, picture)?;
        } else if outcome.reason.is_empty() {
            outcome.reason = "ended without a message".to_owned();
        }
        Ok(outcome)
    }

    /// Whether strahl reads the scene without an error.
    pub(crate) fn parses(&self, scene: &Path) -> Result<bool> {
        let scratch = tempfile::tempdir()?;
        let mut command = self.command("check", scene, scratch.path());
        command.arg("--syntax");
        let outcome = run(command, scratch.path(), Path::new(""), self.timeout)?;
        Ok(outcome.rendered)
    }

    fn command(&self, name: &str, scene: &Path, scratch: &Path) -> Command {
        let mut command = Command::new(&self.strahl);
        command.arg(name).arg(scene);
        command.arg("--allow-write").arg(scratch);
        command
    }
}

fn parent(scene: &Path) -> PathBuf {
    scene.parent().map_or_else(PathBuf::new, Path::to_path_buf)
}

/// Runs a program in a folder; `reason` of the outcome is its whole output. Without an `output`, success counts as rendered.
fn run(mut command: Command, folder: &Path, output: &Path, timeout: Duration) -> Result<Outcome> {
    let log = folder.join("log");
    let start = Instant::now();
    let mut child = command
        .current_dir(folder)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(std::fs::File::create(&log)?)
        .spawn()
        .with_context(|| format!("cannot run {:?}", command.get_program()))?;
    let status = loop {
        if let Some(status) = child.try_wait()? {
            break Some(status);
        }
        if start.elapsed() > timeout {
            child.kill()?;
            child.wait()?;
            break None;
        }
        std::thread::sleep(Duration::from_millis(5));
    };
    let seconds = start.elapsed().as_secs_f64();
    let said = std::fs::read(&log)?;
    let mut reason = String::from_utf8_lossy(&said).into_owned();
    if status.is_none() {
        reason = format!("error: stopped after {} s\n", timeout.as_secs());
    }
    let success = status.is_some_and(|s| s.success());
    Ok(Outcome {
        rendered: success && (output.as_os_str().is_empty() || output.is_file()),
        stopped: status.is_none(),
        seconds,
        reason,
        lacks: BTreeSet::new(),
    })
}

fn read_note(file: &Path) -> Option<Outcome> {
    let text = std::fs::read_to_string(file).ok()?;
    let mut lines = text.lines();
    Some(Outcome {
        rendered: lines.next()? == "rendered",
        stopped: false,
        seconds: lines.next()?.parse().ok()?,
        reason: lines.next().unwrap_or_default().to_owned(),
        lacks: BTreeSet::new(),
    })
}

/// POV-Ray's first error, in one line.
pub(crate) fn povray_reason(log: &str) -> String {
    let at = log.find("Error:").or_else(|| log.find("error:"));
    let text = at.map_or(log, |at| &log[at..]);
    let words: Vec<&str> = text.split_whitespace().take(24).collect();
    words.join(" ")
}

/// The features that strahl's warnings report as left out.
fn lacks(log: &str) -> BTreeSet<String> {
    let warnings = log.lines().filter_map(|l| l.strip_prefix("warning: "));
    let lacks = warnings.filter(|l| l.contains("not supported"));
    lacks.map(str::to_owned).collect()
}

/// Strahl's first error, or else its first warning, with its place.
pub(crate) fn strahl_reason(log: &str) -> String {
    let find = |kind: &str| {
        let mut lines = log.lines().skip_while(|l| !l.starts_with(kind));
        let message = lines.next()?;
        let place = lines.next().map(str::trim).unwrap_or_default();
        Some(match place.strip_prefix("--> ") {
            Some(place) => format!("{message} ({place})"),
            None => message.to_owned(),
        })
    };
    let found = find("error:")
        .or_else(|| {
            log.lines()
                .find(|l| l.contains("panicked"))
                .map(str::to_owned)
        })
        .or_else(|| find("warning:"));
    found.unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reasons_are_first_errors() {
        let log = "hello\nwarning: a\n --> x:1:2\nerror: b\n --> y:3:4\n  |\n";
        assert_eq!(strahl_reason(log), "error: b (y:3:4)");
        assert_eq!(strahl_reason("warning: a\n --> x:1\n"), "warning: a (x:1)");
        assert_eq!(strahl_reason("fine\n"), "");
        let log = "File 'a' line 1: Parse Error: No\n matching  brace\n";
        assert_eq!(povray_reason(log), "Error: No matching brace");
    }
}
