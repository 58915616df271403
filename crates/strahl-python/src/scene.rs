//! Scenes: a description that can grow, and what is compiled from it.

use crate::air::{Fog, Rainbow};
use crate::asked::Asked;
use crate::cameras::Camera;
use crate::convert::{Triple, color};
use crate::film::Film;
use crate::hits::Hits;
use crate::lights::Light;
use crate::looks::{Background, Material};
use crate::object::{Object, Renumbering, adopt};
use crate::queries::Rays;
use crate::settings::{DEFAULT_SIZE, OutputNumbers, ViewNumbers};
use crate::textures::Pattern;
use crate::{errors, sessions, work};
use numpy::{PyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Instant;
use strahl::prelude::{
    AcceleratorKind, CompileOptions, CsgOp, Interval, Outcome, Output, Pigment, PlainTexture,
    Quality, Region, RenderScene, Texture, Tile, View,
};
use strahl::scene::{self, Children};
use strahl::tracing::{self, Prepared, RenderError};

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

fn render_error(error: RenderError) -> PyErr {
    errors::value(error)
}

/// The position of a render, as its thread sees it.
#[derive(Debug, Default)]
struct Seen {
    /// Number of the pass, from 0; of how many; parts done; of how many.
    at: (u32, u32, usize, usize),
    /// What there is of the region that is rendered, if it is shown.
    picture: Vec<[f32; 3]>,
}

/// Copies a part of a picture to its place among the pixels of a region, of which there are none before the first part.
fn put(part: &tracing::Film, region: Region, pixels: &mut Vec<[f32; 3]>) {
    pixels.resize(region.pixels() as usize, [0.0; 3]);
    let width = part.region.width as usize;
    let (left, top) = (part.region.x - region.x, part.region.y - region.y);
    for (y, row) in (top as usize..).zip(part.pixels.chunks_exact(width)) {
        let start = y * region.width as usize + left as usize;
        pixels[start..start + width].copy_from_slice(row);
    }
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

    fn asked(&self, py: Python<'_>, threads: Option<usize>) -> PyResult<Asked> {
        Ok(Asked {
            scene: self.compiled(py, threads, None)?,
            session: sessions::session(threads)?,
        })
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
            let light = light.adopted(place, &mut scene.sources, &mut scene.groups);
            scene.lights.push(light);
        });
    }

    fn add_fog(&self, fog: &Fog) {
        self.change(|scene| scene.fogs.push(fog.0));
    }

    fn add_rainbow(&self, rainbow: &Rainbow) {
        self.change(|scene| scene.rainbows.push(rainbow.0.clone()));
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

    /// The level of what pictures show.
    fn quality(&self) -> u8 {
        self.description().settings.quality.level()
    }

    fn set_quality(&self, level: u8) {
        self.change(|scene| scene.settings.quality = Quality::new(level));
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

    /// The pattern of the pigment of the scene's only object.
    fn pattern(&self) -> PyResult<Pattern> {
        let material = self.material()?.0;
        let texture = material.texture.as_ref().map(|shared| &*shared.0);
        match texture {
            Some(Texture::Plain(PlainTexture {
                pigment: Pigment::ColorMap(field, _),
                ..
            })) => Ok(Pattern((**field).clone())),
            _ => Err(errors::value("the text has no pattern")),
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
        let seen = Arc::new(Mutex::new(Seen::default()));
        let inner = Arc::clone(&seen);
        let region = (output.region()).unwrap_or(Region::full(view.width, view.height));
        let is_shown = show.is_some();
        let render = move |stop: &work::Stop| {
            let mut sink = |tile: &Tile<'_>| {
                let mut seen = lock(&inner);
                seen.at = (tile.pass.number, tile.pass.of, tile.done, tile.of);
                if is_shown {
                    put(tile.film, region, &mut seen.picture);
                }
                match stop.is_set() {
                    true => ControlFlow::Break(()),
                    false => ControlFlow::Continue(()),
                }
            };
            session.render(&view, &output.output(stop), &mut sink)
        };
        let tell = |py: Python<'_>| {
            let Some(tick) = &tick else {
                return Ok(());
            };
            let at = lock(&seen).at;
            let wanted: bool = tick.call1(py, at)?.extract(py)?;
            if let (true, Some(show)) = (wanted, &show) {
                let picture = lock(&seen).picture.clone();
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

    /// The nearest hits of so many rays. The arrays have a row for each, or one for all.
    fn intersect(
        &self,
        py: Python<'_>,
        origins: PyReadonlyArray2<'_, f64>,
        directions: PyReadonlyArray2<'_, f64>,
        count: usize,
        range: (f64, f64),
        threads: Option<usize>,
    ) -> PyResult<Hits> {
        let rays = Rays::new(&origins, &directions, count)?;
        let range = Interval::new(range.0, range.1);
        self.asked(py, threads)?.intersect(py, &rays, range)
    }

    /// Whether something opaque is on each of so many rays.
    fn occluded(
        &self,
        py: Python<'_>,
        origins: PyReadonlyArray2<'_, f64>,
        directions: PyReadonlyArray2<'_, f64>,
        count: usize,
        range: (f64, f64),
        threads: Option<usize>,
    ) -> PyResult<Py<PyArray1<bool>>> {
        let rays = Rays::new(&origins, &directions, count)?;
        let range = Interval::new(range.0, range.1);
        self.asked(py, threads)?.occluded(py, &rays, range)
    }

    /// The number of the object around each point, or -1.
    fn inside(
        &self,
        py: Python<'_>,
        points: PyReadonlyArray2<'_, f64>,
        threads: Option<usize>,
    ) -> PyResult<Py<PyArray1<i32>>> {
        self.asked(py, threads)?.inside(py, &points)
    }
}
