use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::IsTerminal;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};
use strahl::tracing::Progress;

/// Shows how far the render is: a bar on a terminal, a line now and then elsewhere, nothing if quiet.
#[derive(Debug)]
pub(crate) struct Watch {
    bar: ProgressBar,
    /// Print plain lines.
    lines: bool,
    start: Instant,
    rays: AtomicU64,
    /// When the next plain line is due, in milliseconds from the start.
    due: AtomicU64,
    /// Pictures of the animation; 1 if there is none.
    frames: u64,
    /// Where the animation stands.
    frame: AtomicU64,
    pass: AtomicU64,
    passes: AtomicU64,
    tiles: AtomicU64,
    done: AtomicU64,
}

/// Steps of the bar per frame of an animation.
const STEPS: u64 = 1000;

/// Time between plain lines.
const PERIOD: Duration = Duration::from_secs(5);

impl Watch {
    /// For so many pictures: their progress is shown by one bar.
    pub(crate) fn new(quiet: bool, frames: usize) -> Self {
        let frames = (frames as u64).max(1);
        let terminal = std::io::stderr().is_terminal();
        let target = if quiet || !terminal {
            ProgressDrawTarget::hidden()
        } else {
            ProgressDrawTarget::stderr()
        };
        let bar = ProgressBar::with_draw_target(
            Some(if frames > 1 { frames * STEPS } else { 0 }),
            target,
        );
        let style =
            ProgressStyle::with_template("{prefix} [{bar:40}] {percent:>3} %  {msg}  {eta} left");
        bar.set_style(
            style
                .unwrap_or_else(|_| ProgressStyle::default_bar())
                .progress_chars("=> "),
        );
        Self {
            bar,
            lines: !quiet && !terminal,
            start: Instant::now(),
            rays: AtomicU64::new(0),
            due: AtomicU64::new(PERIOD.as_millis() as u64),
            frames,
            frame: AtomicU64::new(0),
            pass: AtomicU64::new(0),
            passes: AtomicU64::new(1),
            tiles: AtomicU64::new(1),
            done: AtomicU64::new(0),
        }
    }

    /// The next picture of an animation begins.
    pub(crate) fn frame(&self, index: usize, number: u32) {
        if self.frames > 1 {
            self.frame.store(index as u64, Ordering::Relaxed);
            self.bar.set_position(index as u64 * STEPS);
            self.bar.set_prefix(format!("frame {number}"));
        }
    }

    /// Clears the bar while something else is printed.
    pub(crate) fn suspend<T>(&self, f: impl FnOnce() -> T) -> T {
        self.bar.suspend(f)
    }

    /// The bar's position within an animation: frames, within each its passes, within each its tiles.
    fn position(&self) -> u64 {
        let of = |x: &AtomicU64| x.load(Ordering::Relaxed);
        let (tiles, passes) = (of(&self.tiles).max(1), of(&self.passes).max(1));
        let done = of(&self.pass) * tiles + of(&self.done).min(tiles);
        of(&self.frame) * STEPS + STEPS * done / (tiles * passes)
    }

    pub(crate) fn finish(&self) {
        self.bar.finish_and_clear();
    }

    /// Rays per second so far, in words.
    fn speed(&self, rays: u64) -> String {
        let speed = rays as f64 / self.start.elapsed().as_secs_f64().max(1e-9);
        format!("{:.2} Mrays/s", speed / 1e6)
    }
}

impl Progress for Watch {
    fn pass(&self, pass: u32, of: u32, tiles: usize) {
        if self.frames > 1 {
            self.pass.store(u64::from(pass), Ordering::Relaxed);
            self.passes.store(u64::from(of), Ordering::Relaxed);
            self.tiles.store(tiles as u64, Ordering::Relaxed);
            self.done.store(0, Ordering::Relaxed);
            return;
        }
        self.bar.set_length(tiles as u64);
        self.bar.reset();
        self.bar.set_prefix(if of > 1 {
            format!("pass {} of {of}", pass + 1)
        } else {
            "render".to_owned()
        });
    }

    fn tile(&self, rays: u64) {
        let rays = self.rays.fetch_add(rays, Ordering::Relaxed) + rays;
        if self.frames > 1 {
            self.done.fetch_add(1, Ordering::Relaxed);
            self.bar.set_position(self.position());
        } else {
            self.bar.inc(1);
        }
        if self.bar.is_hidden() && !self.lines {
            return;
        }
        self.bar.set_message(self.speed(rays));
        let now = self.start.elapsed().as_millis() as u64;
        let due = self.due.load(Ordering::Relaxed);
        if self.lines && now >= due {
            let next = now + PERIOD.as_millis() as u64;
            // Of several threads that get here at once, one prints.
            if self
                .due
                .compare_exchange(due, next, Ordering::Relaxed, Ordering::Relaxed)
                .is_ok()
            {
                let (done, all) = (self.bar.position(), self.bar.length().unwrap_or(0).max(1));
                let percent = 100 * done / all;
                let left = self.bar.eta().as_secs();
                eprintln!(
                    "{} {percent} %, {}, {left} s left",
                    self.bar.prefix(),
                    self.speed(rays)
                );
            }
        }
    }

    fn cancelled(&self) -> bool {
        crate::interrupt::pressed()
    }
}
