//! Scenes: a description that can grow, and what is compiled from it.

use crate::convert::{Triple, color, vectors};
use crate::film::Film;
use crate::hits::Hits;
use crate::looks::{Background, Camera, Light, Material};
use crate::object::{Object, Renumbering, adopt};
use crate::queries::Asked;
use crate::{convert, errors, sessions, work};
use numpy::{PyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::sync::{Arc, LazyLock, Mutex, MutexGuard, PoisonError};
use std::time::Instant;
use strahl::prelude::{
    AcceleratorKind, CompileOptions, CsgOp, Interval, Outcome, Output, Region, RenderScene,
    Sampling, Tile, View,
};
use strahl::scene::{self, Children, Span};
use strahl::tracing::{Prepared, RenderError};

/// The size of pictures of scenes that don't name one.
const DEFAULT_SIZE: (u32, u32) = (800, 600);

/// A description, and what was compiled from it last.
#[derive(Clone, Debug, Default)]
struct State {
    description: Arc<scene::Scene>,
    compiled: Option<(AcceleratorKind, Arc<RenderScene>)>,
    /// The size that the scene was read with.
    size: Option<(u32, u32)>,
    /// Whether the camera is the one that POV-Ray's language gives to scenes without any.
    assumed_camera: bool,
}

/// Name, kind and place of an object.
type ObjectNames = (Option<String>, &'static str, Option<String>);

/// A scene.
#[pyclass(frozen, module = "strahl._strahl")]
#[derive(Default)]
pub(crate) struct Scene {
    state: Arc<Mutex<State>>,
    /// Held by the thread that compiles.
    building: Arc<Mutex<()>>,
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// What pixels depend on: a dictionary that the Python half makes.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct ViewNumbers {
    size: Option<(u32, u32)>,
    sampling: String,
    seed: u64,
    depth: Option<u32>,
    adc_bailout: Option<f64>,
    shading: Option<String>,
    camera: Option<Py<Camera>>,
    threads: Option<usize>,
    accelerator: Option<String>,
}

/// What is handed over of a picture: a dictionary that the Python half makes.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct OutputNumbers {
    region: Option<(u32, u32, u32, u32)>,
    layers: bool,
    alpha: bool,
    costs: bool,
    coarse_first: bool,
}

impl ViewNumbers {
    fn accelerator(&self) -> PyResult<Option<AcceleratorKind>> {
        let name = self.accelerator.as_deref();
        name.map(|name| name.parse().map_err(errors::value))
            .transpose()
    }

    fn view(&self, scene: &Arc<RenderScene>, read_with: Option<(u32, u32)>) -> PyResult<View> {
        let own = scene.settings().size;
        let (width, height) = self.size.or(own).or(read_with).unwrap_or(DEFAULT_SIZE);
        let sampling: Sampling = self.sampling.parse().map_err(errors::value)?;
        let mut view = scene.view(width, height).with_sampling(sampling);
        view.seed = self.seed;
        if let Some(depth) = self.depth {
            if depth == 0 {
                return Err(errors::value("depth must be at least 1"));
            }
            view = view.with_depth(depth);
        }
        if let Some(weight) = self.adc_bailout {
            view = view.with_cutoff(weight);
        }
        if let Some(name) = &self.shading {
            view = view.with_shading(name.parse().map_err(errors::value)?);
        }
        if let Some(camera) = &self.camera {
            view = view.with_camera(camera.get().0.clone());
        }
        Ok(view)
    }
}

/// Nanoseconds since the first call, for the costs of pixels.
fn clock() -> u64 {
    static START: LazyLock<Instant> = LazyLock::new(Instant::now);
    START.elapsed().as_nanos() as u64
}

fn render_error(error: RenderError) -> PyErr {
    errors::value(error)
}

/// The position of a render, as its thread sees it.
#[derive(Debug, Default)]
struct Seen {
    /// Number of the pass, from 0; of how many; parts done; of how many.
    at: (u32, u32, usize, usize),
    /// The picture so far, if it is shown.
    picture: Option<Vec<[f32; 3]>>,
}

impl Scene {
    /// A scene that was read; `is_pov` says whether from POV-Ray's language.
    pub(crate) fn of(description: scene::Scene, size: Option<(u32, u32)>, is_pov: bool) -> Self {
        let written = |camera: &strahl::prelude::Camera| camera.span.is_some();
        Self::with(State {
            assumed_camera: is_pov && !description.camera.as_ref().is_some_and(written),
            description: Arc::new(description),
            compiled: None,
            size,
        })
    }

    fn with(state: State) -> Self {
        Self {
            state: Arc::new(Mutex::new(state)),
            building: Arc::default(),
        }
    }

    fn description(&self) -> Arc<scene::Scene> {
        Arc::clone(&lock(&self.state).description)
    }

    /// Changes the description; what was compiled from it is dropped.
    fn change<T>(&self, change: impl FnOnce(&mut scene::Scene) -> T) -> T {
        let mut state = lock(&self.state);
        state.compiled = None;
        change(Arc::make_mut(&mut state.description))
    }

    /// The compiled scene, which is compiled if it is not; by any accelerator, unless one is asked for.
    fn compiled(
        &self,
        py: Python<'_>,
        threads: Option<usize>,
        kind: Option<AcceleratorKind>,
    ) -> PyResult<Arc<RenderScene>> {
        let known = |state: &State| match &state.compiled {
            Some((of, scene)) if kind.is_none_or(|kind| kind == *of) => Some(Arc::clone(scene)),
            _ => None,
        };
        if let Some(scene) = known(&lock(&self.state)) {
            return Ok(scene);
        }
        let session = sessions::session(threads)?;
        let (state, building) = (Arc::clone(&self.state), Arc::clone(&self.building));
        let kind = kind.unwrap_or_default();
        let compile = move || {
            let _building = lock(&building);
            let description = {
                let state = lock(&state);
                match &state.compiled {
                    Some((of, scene)) if *of == kind => {
                        return (
                            Ok((Arc::clone(scene), vec![])),
                            Arc::clone(&state.description),
                        );
                    }
                    _ => Arc::clone(&state.description),
                }
            };
            let options = CompileOptions { accelerator: kind };
            let compiled = session.compile(&description, &options);
            if let Ok((scene, _)) = &compiled {
                let mut state = lock(&state);
                if Arc::ptr_eq(&state.description, &description) {
                    state.compiled = Some((kind, Arc::clone(scene)));
                }
            }
            (compiled, description)
        };
        let (compiled, description) = work::run(py, compile)?;
        let sources = Some(&description.sources);
        match compiled {
            Ok((scene, warnings)) => {
                errors::warn(py, &warnings, sources)?;
                Ok(scene)
            }
            Err(problems) => Err(errors::scene_error(py, &problems, sources)),
        }
    }

    fn asked(
        &self,
        py: Python<'_>,
        origins: &PyReadonlyArray2<'_, f64>,
        directions: &PyReadonlyArray2<'_, f64>,
        threads: Option<usize>,
    ) -> PyResult<Asked> {
        let scene = self.compiled(py, threads, None)?;
        Asked::new(py, scene, sessions::session(threads)?, origins, directions)
    }

    fn view(&self, py: Python<'_>, numbers: &ViewNumbers) -> PyResult<View> {
        let scene = self.compiled(py, numbers.threads, numbers.accelerator()?)?;
        let size = lock(&self.state).size;
        numbers.view(&scene, size)
    }
}

#[pymethods]
impl Scene {
    #[new]
    fn new() -> Self {
        Self::default()
    }

    /// A scene that changes independently of this one.
    fn copy(&self) -> Self {
        let state = lock(&self.state);
        Self::with(state.clone())
    }

    fn add_object(&self, object: &Object) {
        self.change(|scene| {
            let object = adopt(&object.0, &mut scene.sources, &mut scene.groups);
            scene.objects.0.push(object);
        });
    }

    fn add_light(&self, light: &Light, place: Option<(String, u32)>) {
        self.change(|scene| {
            let mut light = light.0.clone();
            if let Some((file, line)) = place {
                light.span = Span::line(scene.sources.add(&file), line);
            }
            scene.lights.push(light);
        });
    }

    /// Adds everything of another scene; its camera, background and ambient light only where this scene has none.
    fn add_scene(&self, other: &Self) {
        let takes_camera = {
            let mut state = lock(&self.state);
            let missing = state.description.camera.is_none() || state.assumed_camera;
            state.assumed_camera &= other.assumes_camera();
            missing
        };
        let other = other.description();
        self.change(|scene| {
            let (sources, groups) = (&mut scene.sources, &mut scene.groups);
            let map = Renumbering::new(&other.sources, sources, &other.groups, groups);
            let mut objects = other.objects.clone();
            map.objects(&mut objects);
            scene.objects.0.append(&mut objects.0);
            for light in &other.lights {
                let mut light = light.clone();
                map.light(&mut light);
                scene.lights.push(light);
            }
            for fog in &other.fogs {
                let mut fog = *fog;
                map.span(&mut fog.span);
                scene.fogs.push(fog);
            }
            for rainbow in &other.rainbows {
                let mut rainbow = rainbow.clone();
                map.span(&mut rainbow.span);
                scene.rainbows.push(rainbow);
            }
            if let (true, Some(camera)) = (takes_camera, &other.camera) {
                let mut camera = camera.clone();
                map.span(&mut camera.span);
                scene.camera = Some(camera);
            }
            if scene.background.is_none() {
                scene.background.clone_from(&other.background);
                scene.background_alpha = other.background_alpha;
            }
            scene.ambient = scene.ambient.or(other.ambient);
        });
    }

    fn set_camera(&self, camera: &Camera) {
        self.change(|scene| scene.camera = Some(camera.0.clone()));
        lock(&self.state).assumed_camera = false;
    }

    /// Whether the camera is the one that POV-Ray's language gives to scenes without any.
    fn assumes_camera(&self) -> bool {
        lock(&self.state).assumed_camera
    }

    fn set_background(&self, background: &Background) {
        self.change(|scene| scene.background = Some(background.0.clone()));
    }

    fn set_ambient(&self, ambient: Triple) {
        self.change(|scene| scene.ambient = Some(color(ambient)));
    }

    /// The scene's camera, if it has one.
    fn camera(&self) -> Option<Camera> {
        self.description().camera.clone().map(Camera)
    }

    /// The scene's background, if it has one.
    fn background(&self) -> Option<Background> {
        self.description().background.clone().map(Background)
    }

    /// All objects of the scene as one.
    fn one_object(&self) -> PyResult<Object> {
        let scene = self.description();
        let objects = scene.objects.0.clone();
        let object = match <[scene::Object; 1]>::try_from(objects) {
            Ok([object]) => object,
            Err(objects) if objects.is_empty() => {
                return Err(errors::value("the text has no objects"));
            }
            Err(objects) => scene::Object::csg(CsgOp::Union, objects),
        };
        Ok(Object(Arc::new(crate::object::Piece {
            object,
            groups: scene.groups.clone(),
            sources: scene.sources.clone(),
            plain: false,
            depth: 2,
        })))
    }

    /// The material of the scene's only object.
    fn material(&self) -> PyResult<Material> {
        let scene = self.description();
        let Children(objects) = &scene.objects;
        match objects.first().and_then(|object| object.material.clone()) {
            Some(material) => Ok(Material(material)),
            None => Err(errors::value("the text has no texture")),
        }
    }

    /// Number of objects and lights of the description.
    fn counts(&self) -> (usize, usize) {
        let scene = self.description();
        (scene.objects.0.len(), scene.lights.len())
    }

    /// Width and height of a picture without a size of its own.
    fn size(&self) -> (u32, u32) {
        let state = lock(&self.state);
        let own = state.description.settings.size;
        own.or(state.size).unwrap_or(DEFAULT_SIZE)
    }

    /// Compiles the scene, and returns its sizes.
    fn stats(
        &self,
        py: Python<'_>,
        threads: Option<usize>,
    ) -> PyResult<BTreeMap<&'static str, u64>> {
        let scene = self.compiled(py, threads, None)?;
        let s = scene.stats();
        let number = |n: usize| n as u64;
        Ok(BTreeMap::from([
            ("objects", number(s.objects)),
            ("primitives", number(s.primitives)),
            ("elements", s.elements),
            ("instances", number(s.instances)),
            ("materials", number(s.materials)),
            ("lights", number(s.lights)),
            ("accelerator_bytes", number(s.accelerator_bytes)),
            ("geometry_bytes", number(s.geometry_bytes)),
        ]))
    }

    /// Smallest and largest coordinates of what is bounded; `None` if nothing is.
    fn bounds(&self, py: Python<'_>) -> PyResult<Option<(Triple, Triple)>> {
        let bounds = self.compiled(py, None, None)?.bounds();
        let known = !bounds.is_empty();
        Ok(known.then(|| (bounds.min.into(), bounds.max.into())))
    }

    /// Name, kind and place of an object of the compiled scene.
    fn object_info(&self, py: Python<'_>, number: u32) -> PyResult<Option<ObjectNames>> {
        let scene = self.compiled(py, None, None)?;
        Ok(scene.objects().get(number).map(|info| {
            let name = info.name.as_deref().map(str::to_owned);
            (name, info.kind, scene.object_place(number, None))
        }))
    }

    /// Renders a picture. `tick` gets the pass, the number of passes, the parts done and their number, and says whether it wants to see
    /// the picture; then `show` gets it.
    #[pyo3(signature = (view, output, tick=None, show=None))]
    fn render(
        &self,
        py: Python<'_>,
        view: ViewNumbers,
        output: OutputNumbers,
        tick: Option<Py<PyAny>>,
        show: Option<Py<PyAny>>,
    ) -> PyResult<Film> {
        let session = sessions::session(view.threads)?;
        let view = self.view(py, &view)?;
        let output = Output {
            region: output.region.map(|(x, y, width, height)| Region {
                x,
                y,
                width,
                height,
            }),
            coarse_first: output.coarse_first,
            info: output.layers,
            alpha: output.alpha,
            costs: output.costs,
            clock: output.costs.then_some(clock as fn() -> u64),
            ..Output::default()
        };
        let seen = Arc::new(Mutex::new(Seen::default()));
        if show.is_some() {
            let pixels = u64::from(view.width) * u64::from(view.height);
            let pixels = usize::try_from(pixels).map_err(errors::value)?;
            lock(&seen).picture = Some(vec![[0.0; 3]; pixels]);
        }
        let inner = Arc::clone(&seen);
        let render = move |stop: &work::Stop| {
            let mut sink = |tile: &Tile<'_>| {
                let mut seen = lock(&inner);
                seen.at = (tile.pass.number, tile.pass.of, tile.done, tile.of);
                if let Some(picture) = &mut seen.picture {
                    // The buffer has the size of the picture.
                    let _ = tile.film.write_to(picture);
                }
                match stop.is_set() {
                    true => ControlFlow::Break(()),
                    false => ControlFlow::Continue(()),
                }
            };
            session.render(&view, &output, &mut sink)
        };
        let tell = |py: Python<'_>| {
            let Some(tick) = &tick else {
                return Ok(());
            };
            let at = lock(&seen).at;
            let wanted: bool = tick.call1(py, at)?.extract(py)?;
            if let (true, Some(show)) = (wanted, &show) {
                let picture = lock(&seen).picture.clone().unwrap_or_default();
                show.call1(py, (PyArray1::from_vec(py, picture.into_flattened()),))?;
            }
            Ok(())
        };
        match work::run_with(py, render, tell)?.map_err(render_error)? {
            Outcome::Finished(rendered) => Ok(Film::new(py, rendered)),
            Outcome::Stopped(_) => Err(errors::internal(py, "nobody has stopped the render")),
        }
    }

    /// The ray trees of a pixel as JSON.
    fn explain(&self, py: Python<'_>, x: u32, y: u32, view: ViewNumbers) -> PyResult<String> {
        let session = sessions::session(view.threads)?;
        let view = self.view(py, &view)?;
        work::run(py, move || {
            session.explain(&view, x, y).map(|pixel| pixel.to_json())
        })?
        .map_err(render_error)
    }

    /// Builds and renders by one accelerator. Returns its cost as numbers, and the checksum of the picture.
    fn measure(
        &self,
        py: Python<'_>,
        view: ViewNumbers,
    ) -> PyResult<(BTreeMap<&'static str, f64>, String)> {
        let session = sessions::session(view.threads)?;
        let kind = view.accelerator()?.unwrap_or_default();
        let (description, size) = {
            let state = lock(&self.state);
            (Arc::clone(&state.description), state.size)
        };
        let prepare = {
            let description = Arc::clone(&description);
            move || {
                let prepared = Prepared::new(&description)?;
                let start = Instant::now();
                let scene = Arc::new(prepared.build(kind));
                Ok((scene, start.elapsed().as_secs_f64()))
            }
        };
        let (scene, build) = work::run(py, prepare)?
            .map_err(|problems| errors::scene_error(py, &problems, Some(&description.sources)))?;
        let mut view = view.view(&scene, size)?;
        // Structures are compared by the cost of single rays.
        view.trace.beams = false;
        view.trace.packets = false;
        let (rendered, trace) = work::run(py, move || {
            let start = Instant::now();
            let rendered = session.picture(&view, &Output::default());
            (rendered, start.elapsed().as_secs_f64())
        })?;
        let rendered = rendered.map_err(render_error)?;
        let (stats, rays) = (scene.stats(), rendered.rays.total() as f64);
        let per_ray = |count: u64| count as f64 / rays.max(1.0);
        let numbers = BTreeMap::from([
            ("build_s", build),
            ("trace_s", trace),
            ("bytes", stats.accelerator_bytes as f64),
            ("nodes", stats.nodes as f64),
            ("references", stats.references as f64),
            ("rays", rays),
            ("hits", rendered.rays.hits() as f64),
            ("steps_per_ray", per_ray(rendered.traversal.node_visits)),
            ("tests_per_ray", per_ray(rendered.traversal.primitive_tests)),
        ]);
        Ok((numbers, rendered.film.sha256()))
    }

    /// The nearest hits of rays.
    fn intersect(
        &self,
        py: Python<'_>,
        origins: PyReadonlyArray2<'_, f64>,
        directions: PyReadonlyArray2<'_, f64>,
        range: (f64, f64),
        threads: Option<usize>,
    ) -> PyResult<Hits> {
        let asked = self.asked(py, &origins, &directions, threads)?;
        let range = Interval::new(range.0, range.1);
        let hits = asked.ask(py, None, move |session, scene, rays, hits| {
            session.closest_hits(scene, rays, range, hits);
        })?;
        Ok(Hits::new(py, asked, hits))
    }

    /// Whether something opaque is on each ray.
    fn occluded(
        &self,
        py: Python<'_>,
        origins: PyReadonlyArray2<'_, f64>,
        directions: PyReadonlyArray2<'_, f64>,
        range: (f64, f64),
        threads: Option<usize>,
    ) -> PyResult<Py<PyArray1<bool>>> {
        let asked = self.asked(py, &origins, &directions, threads)?;
        let range = Interval::new(range.0, range.1);
        let answers = asked.ask(py, false, move |session, scene, rays, answers| {
            session.occluded(scene, rays, range, answers);
        })?;
        Ok(convert::frozen(py, answers))
    }

    /// The number of the object around each point, or -1.
    fn inside(
        &self,
        py: Python<'_>,
        points: PyReadonlyArray2<'_, f64>,
        threads: Option<usize>,
    ) -> PyResult<Py<PyArray1<i32>>> {
        let session = sessions::session(threads)?;
        let scene = self.compiled(py, threads, None)?;
        let points = vectors(&points)?;
        let answers = work::run(py, move || {
            let mut answers = vec![None; points.len()];
            session.inside(&scene, &points, &mut answers);
            let number = |of: u32| i32::try_from(of).unwrap_or(i32::MAX);
            answers
                .into_iter()
                .map(|object| object.map_or(-1, number))
                .collect()
        })?;
        Ok(convert::frozen(py, answers))
    }
}
