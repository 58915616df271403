//! `strahl render --profile`: what the time went into.

use crate::report::Failure;
use crate::{output, terminal};
use serde::Serialize;
use std::fmt::Write;
use std::path::Path;
use std::sync::mpsc::{self, RecvTimeoutError};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;
use strahl::tracing::{Activities, Profile, ProfilePart, ProfileReport, RenderScene};

/// The time between two samples: a thousand of each thread in a second, which give shares to a few percent.
const INTERVAL: Duration = Duration::from_millis(1);

/// The longest tables are cut after this many rows.
const ROWS: usize = 12;

/// Samples the activities of the threads until it is stopped.
#[derive(Debug)]
pub(crate) struct Sampler {
    activities: Arc<Activities>,
    profile: Arc<Mutex<Profile>>,
    /// The sampling thread, and the channel that ends it.
    thread: Option<(mpsc::Sender<()>, JoinHandle<()>)>,
}

impl Sampler {
    /// Starts to sample.
    pub(crate) fn start() -> Self {
        let (activities, profile) = (
            Arc::<Activities>::default(),
            Arc::<Mutex<Profile>>::default(),
        );
        let (end, ended) = mpsc::channel::<()>();
        let (shared, counts) = (Arc::clone(&activities), Arc::clone(&profile));
        let thread = std::thread::spawn(move || {
            while ended.recv_timeout(INTERVAL) == Err(RecvTimeoutError::Timeout) {
                counts
                    .lock()
                    .unwrap_or_else(PoisonError::into_inner)
                    .sample(&shared);
            }
        });
        Self {
            activities,
            profile,
            thread: Some((end, thread)),
        }
    }

    /// Where the threads store their activities.
    pub(crate) fn activities(&self) -> Arc<Activities> {
        Arc::clone(&self.activities)
    }

    /// Stops and evaluates the samples.
    pub(crate) fn report(mut self, scene: &RenderScene) -> ProfileReport {
        self.stop();
        let profile = self.profile.lock().unwrap_or_else(PoisonError::into_inner);
        profile.report(scene)
    }

    fn stop(&mut self) {
        if let Some((end, thread)) = self.thread.take() {
            drop(end);
            // The thread returns nothing.
            let _ = thread.join();
        }
    }
}

impl Drop for Sampler {
    fn drop(&mut self) {
        self.stop();
    }
}

/// Seconds of the phases of a run, by the clock.
#[derive(Clone, Copy, Debug, Serialize)]
pub(crate) struct Seconds {
    pub(crate) load: f64,
    pub(crate) compile: f64,
    pub(crate) trace: f64,
    pub(crate) write: f64,
}

/// The file of a profile: its keys are a contract, documented in docs/src/profile.md.
#[derive(Debug, Serialize)]
struct Document<'a> {
    scene: &'a str,
    threads: usize,
    time_s: Seconds,
    #[serde(flatten)]
    report: &'a ProfileReport,
}

/// Writes a profile: a table to the terminal, or JSON to a file.
pub(crate) fn write(
    report: &ProfileReport,
    scene: &str,
    (threads, seconds): (usize, Seconds),
    file: Option<&Path>,
) -> Result<(), Failure> {
    let Some(file) = file else {
        terminal::line(&table(report, scene, (threads, seconds)));
        return Ok(());
    };
    let document = Document {
        scene,
        threads,
        time_s: seconds,
        report,
    };
    output::json(file, &document)
}

/// The profile as text.
fn table(report: &ProfileReport, scene: &str, (threads, seconds): (usize, Seconds)) -> String {
    let Seconds {
        load,
        compile,
        trace,
        write,
    } = seconds;
    let plural = if threads == 1 { "" } else { "s" };
    let mut text = format!(
        "profile of {scene}: reading {load:.2} s, building {compile:.2} s, tracing {trace:.2} s \
         ({threads} thread{plural}, {} samples), writing {write:.2} s\n",
        report.samples
    );
    if report.samples == 0 {
        text.push_str("  tracing was too short to be sampled\n");
        return text;
    }
    for (title, parts) in [
        ("phase", &report.phases),
        ("ray", &report.rays),
        ("primitive that was intersected", &report.primitives),
        ("object", &report.objects),
        ("texture", &report.textures),
        ("light", &report.lights),
    ] {
        section(&mut text, title, parts, trace * threads as f64);
    }
    text
}

/// One list of the table; `all` is the time that all samples stand for.
fn section(text: &mut String, title: &str, parts: &[ProfilePart], all: f64) {
    if parts.is_empty() {
        return;
    }
    // Writing to a string does not fail.
    let _ = writeln!(text, "\n  by {title}");
    for part in parts.iter().take(ROWS) {
        let _ = write!(
            text,
            "  {:5.1} % {:9.3} s  {}",
            part.share * 100.0,
            part.share * all,
            part.name
        );
        if let Some(number) = part.objects.filter(|number| *number > 1) {
            let _ = write!(text, ", {number} objects");
        }
        if let Some(place) = &part.place {
            let _ = write!(text, "  {place}");
        }
        text.push('\n');
    }
    if let Some(rest) = parts.get(ROWS..).filter(|rest| !rest.is_empty()) {
        let share: f64 = rest.iter().map(|part| part.share).sum();
        let _ = writeln!(
            text,
            "  {:5.1} % {:9.3} s  {} more",
            share * 100.0,
            share * all,
            rest.len()
        );
    }
}
