//! Scenes from files and texts.

use crate::scene::Scene;
use crate::{errors, work};
use pyo3::prelude::*;
use std::path::{Path, PathBuf};
use strahl::formats::scene::SceneFormat;
use strahl::prelude::DVec3;
use strahl::sdl::{Frame, Stream, Value, Vector, Writing};
use strahl::{Format, LoadOptions, Loaded};

/// A value that is declared before a scene begins.
#[derive(FromPyObject)]
enum Declared {
    Number(f64),
    Text(String),
    Numbers(Vec<f64>),
}

impl Declared {
    fn value(self) -> PyResult<Value> {
        Ok(match self {
            Self::Number(number) => Value::Float(number),
            Self::Text(text) => Value::String(text.into()),
            Self::Numbers(numbers) if (2..=5).contains(&numbers.len()) => {
                Value::Vector(Vector::new(&numbers))
            }
            Self::Numbers(numbers) => {
                return Err(errors::value(format!(
                    "declare: a vector has 2 to 5 numbers, not {}",
                    numbers.len()
                )));
            }
        })
    }
}

/// How to read a scene: a dictionary that the Python half makes.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Reading {
    format: Option<String>,
    declare: Vec<(String, Declared)>,
    clock: Option<f64>,
    size: Option<(u32, u32)>,
    library: Vec<PathBuf>,
    fonts: Vec<PathBuf>,
    version: Option<f64>,
    header: Option<String>,
    limits: Vec<(String, u64)>,
    studio: bool,
    messages: Option<Py<PyAny>>,
}

impl Reading {
    fn format(&self) -> PyResult<Option<Format>> {
        let format = self.format.as_deref();
        format
            .map(|name| name.parse().map_err(errors::value))
            .transpose()
    }

    fn options(self) -> PyResult<LoadOptions> {
        let mut options = LoadOptions {
            format: self.format()?,
            library: self.library,
            fonts: self.fonts,
            installed: strahl::povray_folders(),
            writing: Writing::Memory,
            ..LoadOptions::default()
        };
        let sdl = &mut options.sdl;
        sdl.clock = self.clock.unwrap_or(0.0);
        // As in POV-Ray, the frame numbers of a single picture are zero.
        sdl.frame = Frame {
            animated: self.clock.is_some(),
            number: 0.0,
            first: 0.0,
            last: 0.0,
            initial_clock: 0.0,
            final_clock: 0.0,
            clock_delta: 0.0,
        };
        if let Some((width, height)) = self.size {
            (sdl.image_width, sdl.image_height) = (width, height);
        }
        sdl.version = self.version;
        sdl.header = self.header;
        for (name, limit) in &self.limits {
            if !sdl.limits.set(name, *limit) {
                let names = strahl::sdl::Limits::NAMES.join(", ");
                return Err(errors::value(format!(
                    "there is no limit `{name}`; the limits are {names}"
                )));
            }
        }
        for (name, declared) in self.declare {
            sdl.declare.push((name, declared.value()?));
        }
        if let Some(listener) = self.messages {
            options.on_message = Some(Box::new(move |stream, text| tell(&listener, stream, text)));
        }
        Ok(options)
    }
}

/// Hands a message of a scene to a function of Python's. What that raises is shown, as in callbacks of Python's own.
fn tell(listener: &Py<PyAny>, stream: Stream, text: &str) {
    // Warnings come as diagnostics.
    if stream == Stream::Warning {
        return;
    }
    Python::attach(|py| {
        if let Err(error) = listener.call1(py, (text,)) {
            error.write_unraisable(py, Some(listener.bind(py)));
        }
    });
}

/// The up direction of bare meshes: STL files are made for printers, whose beds are the plane of x and y.
fn up(format: Option<Format>) -> DVec3 {
    match format {
        Some(Format::File(SceneFormat::Stl)) => DVec3::Z,
        _ => DVec3::Y,
    }
}

/// Loads a scene file of any format.
#[pyfunction]
pub(crate) fn load(py: Python<'_>, path: PathBuf, reading: Reading) -> PyResult<Scene> {
    let format = reading
        .format()?
        .or_else(|| Format::of_path(Path::new(&path)));
    read(py, format, reading, move |options| {
        strahl::load_path(&path, options)
    })
}

/// Loads a scene from memory; `name` stands for the file in messages.
#[pyfunction]
pub(crate) fn parse(
    py: Python<'_>,
    bytes: Vec<u8>,
    name: String,
    reading: Reading,
) -> PyResult<Scene> {
    let format = reading.format()?.unwrap_or(Format::Pov);
    read(py, Some(format), reading, move |options| {
        strahl::load_bytes(bytes, &name, format, options)
    })
}

fn read(
    py: Python<'_>,
    format: Option<Format>,
    reading: Reading,
    load: impl FnOnce(LoadOptions) -> Loaded + Send + 'static,
) -> PyResult<Scene> {
    let (studio, size) = (reading.studio && format != Some(Format::Pov), reading.size);
    let options = reading.options()?;
    let loaded = work::run(py, move || load(options))?;
    let (mut scene, warnings) = loaded
        .into_scene()
        .map_err(|problems| errors::scene_error(py, &problems, None))?;
    errors::warn(py, &warnings, Some(&scene.sources))?;
    if studio {
        strahl::studio(&mut scene, up(format));
    }
    Ok(Scene::of(scene, size, format == Some(Format::Pov)))
}
