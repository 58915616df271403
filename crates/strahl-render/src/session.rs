use crate::compile::{CompileOptions, Prepared};
use crate::explanation::Explanation;
use crate::film::Film;
use crate::render::{Crew, PixelState, Progress, RenderError, Rendered, Work};
use crate::scene::RenderScene;
use crate::sink::{Pass, Sink};
use crate::trace::RayCounts;
use crate::tree::{PixelTree, explain_from};
use crate::view::{Output, View};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use strahl_scene::{Diagnostic, Problems, Scene};

/// The number of threads of a session.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Threads {
    /// One per processor.
    #[default]
    All,
    /// This many, at least 1.
    Count(usize),
}

/// Threads that compile scenes, render them and answer questions about them, for as long as it lives.
///
/// It may be used from several threads at once: then the latest request goes first, and the others go on after it. A clone uses the same
/// threads.
#[derive(Clone, Debug)]
pub struct Session {
    pub(crate) pool: Arc<rayon::ThreadPool>,
}

/// What came of a render.
#[derive(Clone, Debug)]
#[must_use]
#[allow(
    clippy::large_enum_variant,
    reason = "there is one of it, which is matched at once"
)]
pub enum Outcome {
    /// The picture is finished.
    Finished(Rendered),
    /// The sink stopped it, or [`Output::stop`] did.
    Stopped(Unfinished),
}

impl Outcome {
    /// The film: finished, or as far as it was when it was stopped.
    pub fn film(&self) -> &Film {
        match self {
            Self::Finished(rendered) => &rendered.film,
            Self::Stopped(unfinished) => unfinished.film(),
        }
    }

    /// The film: finished, or as far as it was when it was stopped.
    pub fn into_film(self) -> Film {
        match self {
            Self::Finished(rendered) => rendered.film,
            Self::Stopped(unfinished) => unfinished.0.work.into_film(),
        }
    }

    /// The finished picture, or `None` if it was stopped.
    pub fn finished(self) -> Option<Rendered> {
        match self {
            Self::Finished(rendered) => Some(rendered),
            Self::Stopped(_) => None,
        }
    }
}

/// A picture that was stopped, with all that is needed to go on: [`Session::resume`].
#[derive(Clone, Debug)]
pub struct Unfinished(Box<Rest>);

#[derive(Clone, Debug)]
struct Rest {
    view: View,
    output: Output,
    work: Work,
}

impl Unfinished {
    /// The film so far; [`Unfinished::states`] says which of its pixels are final.
    pub fn film(&self) -> &Film {
        self.0.work.film()
    }

    /// What there is of each pixel of the film, row by row.
    pub fn states(&self) -> Vec<PixelState> {
        self.0.work.states()
    }

    /// The pass in which it was stopped.
    pub fn pass(&self) -> Pass {
        self.0.work.pass()
    }

    /// Rays traced so far.
    pub fn rays(&self) -> RayCounts {
        self.0.work.rays()
    }

    /// What is rendered.
    pub const fn view(&self) -> &View {
        &self.0.view
    }
}

/// The clock and the stop of an [`Output`].
struct Watch {
    clock: Option<fn() -> u64>,
    stop: Option<Arc<AtomicBool>>,
}

impl Progress for Watch {
    fn now(&self) -> u64 {
        self.clock.map_or(0, |clock| clock())
    }

    fn cancelled(&self) -> bool {
        let stop = self.stop.as_ref();
        stop.is_some_and(|stop| stop.load(Ordering::Relaxed))
    }
}

impl Session {
    /// Starts the threads.
    ///
    /// # Errors
    /// [`RenderError::Threads`] if the system gives none.
    pub fn new(threads: Threads) -> Result<Self, RenderError> {
        let count = match threads {
            Threads::All => 0,
            Threads::Count(count) => count.max(1),
        };
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(count)
            .thread_name(|number| format!("strahl {number}"))
            .build()
            .map_err(|e| RenderError::Threads(count, e.to_string()))?;
        Ok(Self {
            pool: Arc::new(pool),
        })
    }

    /// Number of threads.
    pub fn threads(&self) -> usize {
        self.pool.current_num_threads()
    }

    /// Compiles a description. Returns the scene and the warnings about it.
    ///
    /// # Errors
    /// All errors of the description, each with its place.
    pub fn compile(
        &self,
        description: &Scene,
        options: &CompileOptions,
    ) -> Result<(Arc<RenderScene>, Vec<Diagnostic>), Problems> {
        self.pool.install(|| {
            let prepared = Prepared::new(description)?;
            let warnings = prepared.warnings().to_vec();
            Ok((Arc::new(prepared.build(options.accelerator)), warnings))
        })
    }

    /// Renders a picture of a view, part by part into a sink.
    ///
    /// # Errors
    /// [`RenderError`]: no such picture, no memory, or a camera that makes no rays.
    pub fn render(
        &self,
        view: &View,
        output: &Output,
        sink: &mut dyn Sink,
    ) -> Result<Outcome, RenderError> {
        self.resume(begin(view, output)?, sink)
    }

    /// Goes on with a picture that was stopped. It gets the same bits as one that was not, and the sink sees what was not handed over
    /// before.
    ///
    /// # Errors
    /// [`RenderError`]: there is no memory.
    pub fn resume(
        &self,
        unfinished: Unfinished,
        sink: &mut dyn Sink,
    ) -> Result<Outcome, RenderError> {
        self.go_on(unfinished, Some(sink))
    }

    /// Renders a picture of a view without showing it on the way.
    ///
    /// # Errors
    /// [`RenderError`]: no such picture, no memory, a camera that makes no rays, or [`RenderError::Cancelled`] by [`Output::stop`].
    pub fn picture(&self, view: &View, output: &Output) -> Result<Rendered, RenderError> {
        match self.go_on(begin(view, output)?, None)? {
            Outcome::Finished(rendered) => Ok(rendered),
            Outcome::Stopped(_) => Err(RenderError::Cancelled),
        }
    }

    fn go_on(
        &self,
        mut unfinished: Unfinished,
        sink: Option<&mut dyn Sink>,
    ) -> Result<Outcome, RenderError> {
        let Rest { view, output, work } = &mut *unfinished.0;
        let crew = Crew {
            scene: view.scene(),
            rays: &view.rays()?,
            pool: Some(&self.pool),
            progress: &Watch {
                clock: output.clock,
                stop: output.stop.clone(),
            },
        };
        Ok(match work.go_on(&crew, sink)? {
            true => Outcome::Finished(unfinished.0.work.rendered(self.threads())),
            false => Outcome::Stopped(unfinished),
        })
    }

    /// The ray trees of a pixel with names, places and numbers, as plain data: those of exactly the samples that a picture of the view
    /// takes.
    ///
    /// # Errors
    /// [`RenderError`] if there is no such pixel, or the camera makes no rays.
    pub fn explain(&self, view: &View, x: u32, y: u32) -> Result<Explanation, RenderError> {
        let tree = self.trees(view, x, y)?;
        let (at, size) = ((x, y), (view.width, view.height));
        Ok(Explanation::new(
            view.scene(),
            at,
            size,
            view.sampling,
            &tree,
        ))
    }

    /// The ray trees of a pixel, with the numbers of objects, materials and lights instead of names.
    ///
    /// # Errors
    /// [`RenderError`] if there is no such pixel, or the camera makes no rays.
    pub fn trees(&self, view: &View, x: u32, y: u32) -> Result<PixelTree, RenderError> {
        view.rays()?;
        let options = view.options(&Output::default());
        explain_from(view.scene(), &view.camera, &options, x, y)
    }
}

/// A picture of which nothing is traced yet.
fn begin(view: &View, output: &Output) -> Result<Unfinished, RenderError> {
    view.rays()?;
    Ok(Unfinished(Box::new(Rest {
        work: Work::new(&view.options(output))?,
        view: view.clone(),
        output: output.clone(),
    })))
}
