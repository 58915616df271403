//! Arrays and small values between Python and Rust. The Python half has checked shapes already.

use crate::errors;
use numpy::{PyArray1, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use strahl::prelude::{Color, ColorFt, DVec2, DVec3};

/// A point, direction or colour.
pub(crate) type Triple = (f64, f64, f64);

/// As a vector.
pub(crate) fn vector((x, y, z): Triple) -> DVec3 {
    DVec3::new(x, y, z)
}

/// As a colour.
pub(crate) fn color((r, g, b): Triple) -> Color {
    Color::new(r, g, b)
}

/// Red, green, blue, filter and transmit.
#[derive(Clone, Copy, FromPyObject)]
pub(crate) struct ColorNumbers(f64, f64, f64, f64, f64);

impl From<ColorNumbers> for ColorFt {
    fn from(ColorNumbers(r, g, b, filter, transmit): ColorNumbers) -> Self {
        Self {
            rgb: Color::new(r, g, b),
            filter,
            transmit,
        }
    }
}

/// Rows of three numbers.
pub(crate) fn vectors(array: &PyReadonlyArray2<'_, f64>) -> PyResult<Vec<DVec3>> {
    let (rows, []) = contiguous(array)?.as_chunks::<3>() else {
        return Err(errors::value("the rows must have 3 numbers each"));
    };
    Ok(rows.iter().copied().map(DVec3::from_array).collect())
}

/// Rows of two numbers.
pub(crate) fn vectors_2(array: &PyReadonlyArray2<'_, f64>) -> PyResult<Vec<DVec2>> {
    let (rows, []) = contiguous(array)?.as_chunks::<2>() else {
        return Err(errors::value("the rows must have 2 numbers each"));
    };
    Ok(rows.iter().copied().map(DVec2::from_array).collect())
}

/// All numbers of a two-dimensional array, row by row.
pub(crate) fn contiguous<'a, T: numpy::Element>(
    array: &'a PyReadonlyArray2<'_, T>,
) -> PyResult<&'a [T]> {
    array.as_slice().map_err(errors::value)
}

/// All numbers of an array.
pub(crate) fn list<'a, T: numpy::Element>(array: &'a PyReadonlyArray1<'_, T>) -> PyResult<&'a [T]> {
    array.as_slice().map_err(errors::value)
}

/// An array that takes over a list, and can't be written to.
pub(crate) fn frozen<T: numpy::Element>(py: Python<'_>, list: Vec<T>) -> Py<PyArray1<T>> {
    let array = PyArray1::from_vec(py, list);
    array.readwrite().make_nonwriteable();
    array.unbind()
}

/// A number of an object or material as arrays have it.
pub(crate) fn number(of: u32) -> i32 {
    i32::try_from(of).unwrap_or(i32::MAX)
}
