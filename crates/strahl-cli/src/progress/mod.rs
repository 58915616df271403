//! Progress: a bar on a terminal, an occasional line elsewhere, nothing with `--quiet`.

mod estimate;

use crate::{interrupt, terminal, work};
use estimate::{Estimate, words};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, mpsc};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};
use strahl::tracing::{Activities, Progress};

/// The activity while tiles are traced.
const RENDERING: &str = "rendering";

/// The resolution of the bar.
const STEPS: u64 = 1000;

/// No progress is shown for shorter work.
const PATIENCE: Duration = Duration::from_secs(1);

/// Time between two updates, on a terminal and elsewhere.
const TICK: Duration = Duration::from_millis(200);
const PERIOD: Duration = Duration::from_secs(5);

/// Shows the progress of a render, from reading the scene to the last pass.
#[derive(Debug)]
pub(crate) struct Watch {
    state: Arc<Mutex<State>>,
    /// The thread that updates the display, and the channel that ends it.
    ticker: Option<(mpsc::Sender<()>, JoinHandle<()>)>,
    /// Where the threads that trace tell what they are doing, if somebody wants to know.
    pub(crate) activities: Option<Arc<Activities>>,
}

#[derive(Debug)]
struct State {
    bar: ProgressBar,
    /// The number of frames; 1 without an animation.
    frames: usize,
    /// The current frame: index and number.
    frame: (usize, u32),
    /// Seconds of all finished frames.
    finished: f64,
    /// The start of the current frame.
    frame_start: Instant,
    /// The passes of this picture, and the start of the current one.
    estimate: Estimate,
    pass_start: Instant,
    pass: u32,
    passes: u32,
    tiles: usize,
    done: usize,
    rays: u64,
    trace_start: Instant,
}

impl Watch {
    /// Progress for this many pictures, which share a bar.
    pub(crate) fn new(quiet: bool, frames: usize) -> Self {
        let terminal = terminal::is_terminal();
        let target = match quiet || !terminal {
            true => ProgressDrawTarget::hidden(),
            false => ProgressDrawTarget::stderr(),
        };
        let bar = ProgressBar::with_draw_target(Some(STEPS), target);
        let style = ProgressStyle::with_template("{prefix} [{bar:30}] {msg}");
        bar.set_style(
            style
                .unwrap_or_else(|_| ProgressStyle::default_bar())
                .progress_chars("=> "),
        );
        if !quiet && terminal {
            terminal::show_bar(Some(bar.clone()));
        }
        let now = Instant::now();
        let state = Arc::new(Mutex::new(State {
            bar,
            frames: frames.max(1),
            frame: (0, 0),
            finished: 0.0,
            frame_start: now,
            estimate: Estimate::default(),
            pass_start: now,
            pass: 0,
            passes: 1,
            tiles: 1,
            done: 0,
            rays: 0,
            trace_start: now,
        }));
        let ticker = (!quiet).then(|| tick(Arc::clone(&state), terminal));
        Self {
            state,
            ticker,
            activities: None,
        }
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Starts the next frame of an animation.
    pub(crate) fn frame(&self, index: usize, number: u32) {
        let mut state = self.state();
        if index > 0 {
            state.finished += state.frame_start.elapsed().as_secs_f64();
        }
        state.frame = (index, number);
        state.frame_start = Instant::now();
    }

    pub(crate) fn finish(&mut self) {
        if let Some((end, thread)) = self.ticker.take() {
            drop(end);
            // The thread returns nothing.
            let _ = thread.join();
        }
        terminal::show_bar(None);
        self.state().bar.finish_and_clear();
    }
}

impl Drop for Watch {
    fn drop(&mut self) {
        self.finish();
    }
}

/// Starts the thread that updates the display.
fn tick(state: Arc<Mutex<State>>, terminal: bool) -> (mpsc::Sender<()>, JoinHandle<()>) {
    let (end, ended) = mpsc::channel::<()>();
    let start = Instant::now();
    let thread = std::thread::spawn(move || {
        let period = if terminal { TICK } else { PERIOD };
        while ended.recv_timeout(period) == Err(mpsc::RecvTimeoutError::Timeout) {
            if start.elapsed() < PATIENCE {
                continue;
            }
            let (line, bar, shown) = {
                let state = state.lock().unwrap_or_else(PoisonError::into_inner);
                let (part, text) = state.shown();
                (
                    format!("{}: {text}", state.prefix()),
                    state.bar.clone(),
                    (part, state.prefix(), text),
                )
            };
            if terminal {
                let (part, prefix, text) = shown;
                bar.set_prefix(prefix);
                bar.set_message(text);
                bar.set_position((part * STEPS as f64) as u64);
            } else {
                terminal::line(&line);
            }
        }
    });
    (end, thread)
}

impl State {
    /// The current activity in words.
    fn prefix(&self) -> String {
        let (what, _) = work::now();
        match self.frames {
            1 => what,
            _ => format!("frame {}, {what}", self.frame.1),
        }
    }

    /// The fraction of all work that is done, and the text beside it.
    fn shown(&self) -> (f64, String) {
        let now = self.frame_start.elapsed().as_secs_f64();
        let (what, since) = work::now();
        if what != RENDERING {
            let (part, left) = self.of_all(now, f64::INFINITY);
            let left = match left.is_finite() {
                true => format!(", {} left", words(left)),
                false => String::new(),
            };
            return (part, format!("{}{left}", words(since)));
        }
        let part = self.done as f64 / self.tiles.max(1) as f64;
        let elapsed = self.pass_start.elapsed().as_secs_f64();
        let (_, left) = self.estimate.seconds(part, elapsed);
        let (part, left) = self.of_all(now, left);
        let speed = self.rays as f64 / self.trace_start.elapsed().as_secs_f64().max(1e-9);
        let pass = match self.passes {
            1 => String::new(),
            n => format!("pass {} of {n}, ", self.pass + 1),
        };
        (
            part,
            format!(
                "{:.0} %, {pass}{:.2} Mrays/s, {} left",
                100.0 * part,
                speed / 1e6,
                words(left)
            ),
        )
    }

    /// The fraction done and the seconds left of all frames; the current one has taken `spent` seconds and has `left` seconds to
    /// go.
    fn of_all(&self, spent: f64, left: f64) -> (f64, f64) {
        let (index, after) = (
            self.frame.0,
            self.frames - 1 - self.frame.0.min(self.frames - 1),
        );
        let this = match (left.is_finite(), index) {
            (true, _) => spent + left,
            (false, 0) => return (0.0, f64::INFINITY),
            // Assume the average time of the frames so far.
            (false, _) => (self.finished / index as f64).max(spent),
        };
        let mean = (self.finished + this) / (index + 1) as f64;
        let left = this - spent + mean * after as f64;
        let done = self.finished + spent;
        (done / (done + left).max(1e-9), left)
    }
}

impl Progress for Watch {
    fn pass(&self, pass: u32, of: u32, tiles: usize) {
        let mut state = self.state();
        let before = state.pass_start.elapsed().as_secs_f64();
        if pass == 0 {
            state.trace_start = Instant::now();
            state.rays = 0;
            work::doing(RENDERING);
        }
        state.estimate.pass(pass, of, before);
        (state.pass, state.passes) = (pass, of);
        (state.tiles, state.done) = (tiles, 0);
        state.pass_start = Instant::now();
    }

    fn tile(&self, rays: u64) {
        let mut state = self.state();
        state.rays += rays;
        state.done += 1;
    }

    fn activities(&self) -> Option<&Activities> {
        self.activities.as_deref()
    }

    fn cancelled(&self) -> bool {
        interrupt::pressed()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_to_come_take_as_long_as_those_before() {
        let watch = Watch::new(true, 4);
        let mut state = watch.state();
        assert_eq!(state.of_all(1.0, f64::INFINITY).1, f64::INFINITY);
        assert_eq!(state.of_all(1.0, 1.0), (0.125, 7.0));
        (state.frame, state.finished) = ((2, 3), 8.0);
        assert_eq!(state.of_all(1.0, f64::INFINITY).1, 3.0 + 4.0);
        assert_eq!(state.of_all(2.0, 2.0), (10.0 / 16.0, 6.0));
    }
}
