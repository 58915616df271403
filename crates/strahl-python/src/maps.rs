//! Transformations: of objects, lights and textures.

use crate::convert::{Triple, vector};
use crate::errors;
use pyo3::prelude::*;
use strahl::math::{DMat3, DVec3, SingularTransform, Transform};

/// A transformation.
#[pyclass(frozen, module = "strahl._strahl")]
pub(crate) struct Map(pub(crate) Transform);

#[pymethods]
impl Map {
    #[staticmethod]
    fn translation(offset: Triple) -> Self {
        Self(Transform::translate(vector(offset)))
    }

    /// About an axis other than zero, by radians.
    #[staticmethod]
    fn rotation(axis: Triple, radians: f64) -> Self {
        Self(Transform::rotate(vector(axis), radians))
    }

    #[staticmethod]
    fn scaling(factors: Triple) -> PyResult<Self> {
        let scaling = Transform::try_scale(vector(factors));
        scaling.map(Self).map_err(errors::value)
    }

    /// By the 12 numbers of a matrix, row by row.
    #[staticmethod]
    fn matrix(numbers: [f64; 12]) -> PyResult<Self> {
        of_matrix(&numbers).map(Self).map_err(errors::value)
    }
}

/// The transformation by a matrix of three rows and four columns that multiplies columns.
pub(crate) fn of_matrix(matrix: &[f64; 12]) -> Result<Transform, SingularTransform> {
    let column = |c: usize| DVec3::new(matrix[c], matrix[4 + c], matrix[8 + c]);
    let linear = DMat3::from_cols(column(0), column(1), column(2));
    Transform::try_new(linear, column(3))
}
