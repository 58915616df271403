//! Pictures from arrays.

use crate::errors;
use numpy::{PyReadonlyArray3, PyUntypedArrayMethods};
use pyo3::prelude::*;
use std::sync::Arc;
use strahl::shade::image_map::{ImageMap, Interpolation, MapType};
use strahl::shade::image_texture::{ColorSpace, TexelChannels, TexelData, TextureImage};

/// A picture with its mapping.
#[pyclass(frozen, module = "strahl._strahl")]
pub(crate) struct Picture(pub(crate) Arc<ImageMap>);

/// Samples of rows, columns and channels, as NumPy has them.
#[derive(FromPyObject)]
enum Samples<'py> {
    Byte(PyReadonlyArray3<'py, u8>),
    Short(PyReadonlyArray3<'py, u16>),
    Single(PyReadonlyArray3<'py, f32>),
}

impl Samples<'_> {
    fn shape(&self) -> &[usize] {
        match self {
            Self::Byte(array) => array.shape(),
            Self::Short(array) => array.shape(),
            Self::Single(array) => array.shape(),
        }
    }

    fn data(&self) -> PyResult<TexelData> {
        Ok(match self {
            Self::Byte(array) => TexelData::U8(array.as_slice().map_err(errors::value)?.to_vec()),
            Self::Short(array) => TexelData::U16(array.as_slice().map_err(errors::value)?.to_vec()),
            Self::Single(array) => {
                TexelData::F32(array.as_slice().map_err(errors::value)?.to_vec())
            }
        })
    }
}

/// What a picture has besides its samples: a dictionary that the Python half makes.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
struct Mapping {
    map: String,
    interpolation: String,
    once: bool,
    srgb: bool,
    filter: f64,
    transmit: f64,
    use_alpha: bool,
}

#[pymethods]
impl Picture {
    #[new]
    fn new(samples: Samples<'_>, mapping: Mapping) -> PyResult<Self> {
        let &[height, width, channels] = samples.shape() else {
            return Err(errors::value("a picture has rows, columns and channels"));
        };
        let channels = match channels {
            1 => TexelChannels::Gray,
            2 => TexelChannels::GrayAlpha,
            3 => TexelChannels::Rgb,
            4 => TexelChannels::Rgba,
            other => return Err(errors::value(format!("a picture has no {other} channels"))),
        };
        let side = |length: usize| u32::try_from(length).map_err(errors::value);
        let space = match mapping.srgb {
            true => ColorSpace::Srgb,
            false => ColorSpace::Linear,
        };
        let image = TextureImage::try_new(
            side(width)?,
            side(height)?,
            channels,
            space,
            samples.data()?,
        );
        let map_type = match mapping.map.as_str() {
            "planar" => MapType::Planar,
            "spherical" => MapType::Spherical,
            "cylindrical" => MapType::Cylindrical,
            "toroidal" => MapType::Toroidal,
            other => return Err(errors::value(format!("there is no mapping `{other}`"))),
        };
        let interpolation = match mapping.interpolation.as_str() {
            "nearest" => Interpolation::Nearest,
            "bilinear" => Interpolation::Bilinear,
            "bicubic" => Interpolation::Bicubic,
            "normalized-distance" => Interpolation::NormalizedDistance,
            other => {
                return Err(errors::value(format!(
                    "there is no interpolation `{other}`"
                )));
            }
        };
        Ok(Self(Arc::new(ImageMap {
            map_type,
            interpolation,
            once: mapping.once,
            filter_all: mapping.filter,
            transmit_all: mapping.transmit,
            use_alpha: mapping.use_alpha,
            ..ImageMap::new(Arc::new(image.map_err(errors::value)?))
        })))
    }
}
