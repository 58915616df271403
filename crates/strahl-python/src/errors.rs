//! Exceptions and warnings, whose classes are in `strahl._errors`.

use pyo3::exceptions::{PyOSError, PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::any::Any;
use strahl::formats::image::ImageError;
use strahl::prelude::{Diagnostic, Problems};
use strahl::scene::{Severity, SourceMap};

/// A wrong argument.
pub(crate) fn value(error: impl std::fmt::Display) -> PyErr {
    PyValueError::new_err(error.to_string())
}

/// A picture that can't be written.
pub(crate) fn image(error: &ImageError) -> PyErr {
    match error {
        ImageError::Write { .. }
        | ImageError::FolderMissing { .. }
        | ImageError::IsFolder { .. }
        | ImageError::NotWritable { .. }
        | ImageError::DiskFull { .. } => PyOSError::new_err(error.to_string()),
        _ => value(error),
    }
}

fn class<'py>(py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
    py.import("strahl._errors")?.getattr(name)
}

/// The exception for something that must not happen.
pub(crate) fn internal(py: Python<'_>, text: &str) -> PyErr {
    let text = format!("this is a bug in strahl, please report it with the scene: {text}");
    match class(py, "InternalError").and_then(|class| class.call1((text.as_str(),))) {
        Ok(error) => PyErr::from_value(error),
        Err(_) => PyRuntimeError::new_err(text),
    }
}

/// The exception for a panic.
pub(crate) fn of_panic(py: Python<'_>, payload: &(dyn Any + Send)) -> PyErr {
    internal(py, text_of(payload))
}

/// The text of a panic.
fn text_of(payload: &(dyn Any + Send)) -> &str {
    match (
        payload.downcast_ref::<&str>(),
        payload.downcast_ref::<String>(),
    ) {
        (Some(text), _) => text,
        (None, Some(text)) => text,
        (None, None) => "a panic without a text",
    }
}

/// The exception with all diagnostics of a scene.
pub(crate) fn scene_error(
    py: Python<'_>,
    problems: &Problems,
    sources: Option<&SourceMap>,
) -> PyErr {
    let make = || {
        let all = problems.0.iter();
        let all: PyResult<Vec<_>> = all.map(|d| diagnostic(py, d, sources)).collect();
        class(py, "SceneError")?.call1((all?,))
    };
    make().map_or_else(|error| error, PyErr::from_value)
}

/// Issues warnings through the module `warnings`, which may turn them into exceptions.
pub(crate) fn warn(
    py: Python<'_>,
    warnings: &[Diagnostic],
    sources: Option<&SourceMap>,
) -> PyResult<()> {
    if warnings.is_empty() {
        return Ok(());
    }
    let issue = class(py, "issue")?;
    for warning in warnings {
        issue.call1((diagnostic(py, warning, sources)?,))?;
    }
    Ok(())
}

fn diagnostic<'py>(
    py: Python<'py>,
    from: &Diagnostic,
    sources: Option<&SourceMap>,
) -> PyResult<Bound<'py, PyAny>> {
    let located = sources.and_then(|sources| sources.locate(from.span));
    let mut text = from.to_string();
    if from.source.is_none()
        && let Some(place) = located
    {
        text.push_str(&format!("\n--> {place}"));
    }
    let file = match &from.source {
        Some(source) => Some(source.file.as_str()),
        None => located.map(|place| place.file),
    };
    let known = |number: u32| (number > 0).then_some(number);
    let fields = PyDict::new(py);
    fields.set_item(
        "severity",
        match from.severity {
            Severity::Warning => "warning",
            Severity::Error => "error",
        },
    )?;
    fields.set_item("message", &from.message)?;
    fields.set_item("file", file)?;
    fields.set_item("line", known(from.span.line))?;
    fields.set_item("column", known(from.span.column))?;
    fields.set_item("hints", &from.hints)?;
    fields.set_item("trace", &from.trace)?;
    fields.set_item("text", text)?;
    class(py, "Diagnostic")?.call((), Some(&fields))
}
