//! All threads trace the tiles of a pass, and the thread that asked for the picture hands finished parts to a sink.

use super::{PixelTracer, Progress, RenderOptions, TileResult};
use crate::camera::PrimaryRays;
use crate::cost::PixelCost;
use crate::film::{Film, Region};
use crate::scene::RenderScene;
use crate::sink::{Pass, Sink, Tile};
use crate::trace::{BatchMemory, RayCounts};
use arrayvec::ArrayVec;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError, mpsc};
use strahl_accel::TraversalStats;

/// The threads, and what they look at.
pub(crate) struct Crew<'a> {
    pub(crate) scene: &'a RenderScene,
    pub(crate) rays: &'a PrimaryRays,
    /// The threads; `None` if the thread that asked for the picture does all the work. Then a sink gets the parts of a pass at its end.
    pub(crate) pool: Option<&'a rayon::ThreadPool>,
    pub(crate) progress: &'a dyn Progress,
}

impl Crew<'_> {
    /// The number of threads that trace.
    pub(crate) fn threads(&self) -> usize {
        self.pool.map_or(1, rayon::ThreadPool::current_num_threads)
    }
}

/// What the threads write to.
#[derive(Clone, Debug)]
pub(super) struct Canvas {
    pub(super) film: Film,
    pub(super) counts: RayCounts,
    pub(super) traversal: TraversalStats,
    /// The largest lists of a thread.
    pub(super) batches: BatchMemory,
    /// Of the pixels of the film, if requested.
    pub(super) costs: Option<Vec<PixelCost>>,
}

/// A part of the film that is handed over at once.
#[derive(Clone, Copy, Debug)]
pub(super) struct Part {
    pub(super) region: Region,
    /// Number of tiles that it still needs.
    pub(super) waits: u32,
    pub(super) changed: bool,
    delivered: bool,
}

impl Part {
    pub(super) const fn new(region: Region, waits: u32) -> Self {
        Self {
            region,
            waits,
            changed: waits > 0,
            delivered: false,
        }
    }
}

/// The tiles of a pass.
#[derive(Clone, Debug, Default)]
pub(super) struct TileList {
    pub(super) tiles: Vec<Region>,
    pub(super) done: Vec<bool>,
    pub(super) parts: Vec<Part>,
    /// The parts that need each tile: corners belong to the pixels on all sides.
    pub(super) feeds: Vec<ArrayVec<u32, 4>>,
}

impl TileList {
    /// The tiles that are not done, by number.
    fn pending(&self) -> Vec<usize> {
        (0..self.done.len())
            .filter(|index| !self.done[*index])
            .collect()
    }
}

/// How the work at a pass has ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Ended {
    /// All of it is done.
    Complete,
    /// All of it is done, and the sink wants no more.
    CompleteAndStopped,
    /// There was a stop.
    Stopped,
}

/// A message to the thread that waits for tiles.
enum Message {
    /// This part of the film is complete.
    Ready(u32),
    /// A thread has found no more tiles.
    Ended,
}

/// Tells the waiting thread that this one has ended, also if it panics.
struct Farewell<'a>(&'a mpsc::Sender<Message>);

impl Drop for Farewell<'_> {
    fn drop(&mut self) {
        // Without a receiver nobody waits.
        let _ = self.0.send(Message::Ended);
    }
}

/// Ends the work of all threads when it goes out of scope.
struct StopAtEnd<'a>(&'a AtomicBool);

impl Drop for StopAtEnd<'_> {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

/// What has come of the tiles.
struct Results<'a, S> {
    canvas: &'a mut Canvas,
    done: &'a mut [bool],
    parts: &'a mut [Part],
    store: S,
}

impl<S> Results<'_, S> {
    /// Adds a finished tile, and returns the parts of the film that are complete with it.
    fn take<T>(&mut self, index: usize, result: TileResult<T>, feeds: &[u32]) -> ArrayVec<u32, 4>
    where
        S: FnMut(&mut Film, TileResult<T>, &[Region]),
    {
        self.done[index] = true;
        let mut ready = ArrayVec::<u32, 4>::new();
        let mut regions = ArrayVec::<Region, 4>::new();
        for &number in feeds {
            let part = &mut self.parts[number as usize];
            part.waits -= 1;
            if part.waits == 0 {
                ready.push(number);
                regions.push(part.region);
            }
        }
        let canvas = &mut *self.canvas;
        canvas.counts += result.counts;
        canvas.traversal += result.traversal;
        canvas.film.set_infos(&result);
        if let Some(all) = &mut canvas.costs {
            let region = canvas.film.region;
            for ((x, y), cost) in result.places().zip(&result.costs) {
                if region.contains(x, y) {
                    all[region.index(x, y)] += *cost;
                }
            }
        }
        (self.store)(&mut canvas.film, result, &regions);
        ready
    }
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A pass that is to be traced, or traced further.
pub(super) struct Turn<'a, 's> {
    pub(super) crew: &'a Crew<'a>,
    pub(super) options: &'a RenderOptions,
    pub(super) pass: Pass,
    pub(super) canvas: &'a mut Canvas,
    pub(super) list: &'a mut TileList,
    pub(super) sink: Option<&'a mut (dyn Sink + 's)>,
}

impl Turn<'_, '_> {
    /// Traces the tiles that are not done, and hands each to `store`, together with the parts of the film that are complete with it.
    // Tiles end in any order; the result does not depend on it.
    pub(super) fn trace<T>(
        self,
        trace: impl Fn(&mut PixelTracer<'_>, Region) -> TileResult<T> + Sync,
        store: impl FnMut(&mut Film, TileResult<T>, &[Region]) + Send,
    ) -> Ended {
        let Self {
            crew,
            options,
            pass,
            canvas,
            list,
            mut sink,
        } = self;
        let pending = list.pending();
        crew.progress.pass(pass.number, pass.of, pending.len());
        if let Some(sink) = &mut sink {
            // Those that need no rays, and those that were ready when a sink stopped the render.
            let all = begin(&mut **sink, &pass, &mut list.parts, &canvas.film);
            if all.is_break() {
                return Ended::Stopped;
            }
        }
        let TileList {
            tiles,
            done,
            parts,
            feeds,
        } = list;
        let shared = Shared {
            crew,
            options,
            tiles,
            feeds,
            pending,
            next: AtomicUsize::new(0),
            stop: AtomicBool::new(false),
            results: Mutex::new(Results {
                canvas,
                done,
                parts,
                store,
            }),
        };
        let watched = sink.is_some();
        let (sender, receiver) = mpsc::channel();
        let sender = watched.then_some(sender);
        let work = || shared.work(&trace, sender.as_ref());
        let deliver = || sink.is_some_and(|sink| shared.deliver(sink, pass, &receiver).is_break());
        let broke = match crew.pool {
            Some(pool) => pool.in_place_scope(|scope| {
                scope.spawn_broadcast(|_, _| work());
                deliver()
            }),
            None => {
                work();
                deliver()
            }
        };
        let results = lock(&shared.results);
        let traced = results.done.iter().all(|done| *done);
        let delivered = results.parts.iter().all(|part| part.delivered);
        match traced && (!watched || delivered) {
            true if broke => Ended::CompleteAndStopped,
            true => Ended::Complete,
            false => Ended::Stopped,
        }
    }
}

/// What the threads that trace a pass have in common.
struct Shared<'a, S> {
    crew: &'a Crew<'a>,
    options: &'a RenderOptions,
    tiles: &'a [Region],
    feeds: &'a [ArrayVec<u32, 4>],
    /// The tiles that are to be traced.
    pending: Vec<usize>,
    /// Which of these comes next.
    next: AtomicUsize,
    stop: AtomicBool,
    results: Mutex<Results<'a, S>>,
}

impl<S> Shared<'_, S> {
    /// Traces tiles until none is left or there is a stop: what each thread does.
    fn work<T>(
        &self,
        trace: &impl Fn(&mut PixelTracer<'_>, Region) -> TileResult<T>,
        sender: Option<&mpsc::Sender<Message>>,
    ) where
        S: FnMut(&mut Film, TileResult<T>, &[Region]),
    {
        let crew = self.crew;
        let _farewell = sender.map(Farewell);
        let mut tracer = PixelTracer::new(crew.scene, crew.rays, self.options, crew.progress);
        while !self.stop.load(Ordering::Relaxed) && !crew.progress.cancelled() {
            let number = self.next.fetch_add(1, Ordering::Relaxed);
            let Some(&index) = self.pending.get(number) else {
                break;
            };
            let result = trace(&mut tracer, self.tiles[index]);
            if tracer.left_tile() {
                break;
            }
            crew.progress.tile(result.counts.total());
            let ready = lock(&self.results).take(index, result, &self.feeds[index]);
            if let Some(sender) = sender {
                for part in ready {
                    // Without a receiver the sink has failed, and `stop` is set.
                    let _ = sender.send(Message::Ready(part));
                }
            }
            // Other work of the same threads goes first: it is newer.
            rayon::yield_now();
        }
        let batches = tracer.tree.memory();
        let mut results = lock(&self.results);
        results.canvas.batches = results.canvas.batches.largest(batches);
    }

    /// Hands parts of the film to a sink as they get complete, until all threads have ended. `Break` if the sink wants no more.
    fn deliver(
        &self,
        sink: &mut dyn Sink,
        pass: Pass,
        receiver: &mpsc::Receiver<Message>,
    ) -> ControlFlow<()> {
        let _stop = StopAtEnd(&self.stop);
        let mut flow = ControlFlow::Continue(());
        let (mut done, of) = delivered(lock(&self.results).parts);
        let mut running = self.crew.threads();
        while running > 0 {
            match receiver.recv() {
                Ok(Message::Ready(number)) if flow.is_continue() => {
                    let (film, part) = self.take_part(number);
                    done += 1;
                    flow = tile(sink, pass, &film, &part, (done, of));
                    if flow.is_break() {
                        self.stop.store(true, Ordering::Relaxed);
                    }
                }
                Ok(Message::Ready(_)) => {}
                Ok(Message::Ended) => running -= 1,
                Err(_) => break,
            }
        }
        flow
    }

    /// A complete part, which counts as delivered from now on, and its pixels.
    fn take_part(&self, number: u32) -> (Film, Part) {
        let mut results = lock(&self.results);
        let part = &mut results.parts[number as usize];
        part.delivered = true;
        let part = *part;
        (results.canvas.film.cut(part.region), part)
    }
}

/// Hands over the beginning of a pass and all parts that are complete already.
fn begin(sink: &mut dyn Sink, pass: &Pass, parts: &mut [Part], film: &Film) -> ControlFlow<()> {
    sink.pass(pass)?;
    let (mut done, of) = delivered(parts);
    for part in parts.iter_mut().filter(|p| p.waits == 0 && !p.delivered) {
        part.delivered = true;
        done += 1;
        tile(sink, *pass, &film.cut(part.region), part, (done, of))?;
    }
    ControlFlow::Continue(())
}

/// How many parts are delivered, and of how many.
fn delivered(parts: &[Part]) -> (usize, usize) {
    let done = parts.iter().filter(|part| part.delivered).count();
    (done, parts.len())
}

/// Hands over a part of the film.
fn tile(
    sink: &mut dyn Sink,
    pass: Pass,
    film: &Film,
    part: &Part,
    (done, of): (usize, usize),
) -> ControlFlow<()> {
    sink.tile(&Tile {
        pass,
        film,
        changed: part.changed,
        done,
        of,
    })
}
