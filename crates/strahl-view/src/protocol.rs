//! What pages and the server tell each other: JSON texts, and binary messages for pixels.
//!
//! A binary message begins with eight little-endian `u32`: its kind ([`COLORS`], [`LINEAR`] or [`MARKS`]), the number of the picture,
//! column, row, width and height of the region, the side of the blocks that show one sample, and 0. Then come the samples, row by row:
//! three bytes (sRGB) or three little-endian `f32` (linear) for each block, or one byte for each pixel.

use serde::{Deserialize, Serialize};
use strahl::prelude::*;
use strahl::scene::{Severity, SourceMap};

/// Kinds of binary messages: colours as sRGB codes.
pub(crate) const COLORS: u32 = 1;
/// Linear colours.
pub(crate) const LINEAR: u32 = 2;
/// Marked pixels: 1 or 0.
pub(crate) const MARKS: u32 = 3;

/// The longest message of a page in bytes.
pub(crate) const LONGEST_MESSAGE: usize = 4 << 20;
/// The longest text of a scene that the page shows, in bytes.
pub(crate) const LONGEST_TEXT: usize = 1 << 20;
/// The longest side of a picture.
pub(crate) const LONGEST_SIDE: u32 = 8192;
/// The most pixels of a picture.
pub(crate) const MOST_PIXELS: u64 = 1 << 24;
/// The largest depth of ray trees.
pub(crate) const DEEPEST: u32 = 1000;

/// The most lights that a page is told of, and may move.
pub(crate) const MOST_LIGHTS: usize = 100;

/// The picture on the page that a message is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Slot {
    /// The picture itself.
    Main,
    /// The one it is compared with.
    Side,
    /// The scene from outside, with the rays.
    Space,
}

/// A camera in numbers; the rest of it stays as in the scene.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct CameraData {
    pub(crate) eye: [f64; 3],
    pub(crate) direction: [f64; 3],
    pub(crate) right: [f64; 3],
    pub(crate) up: [f64; 3],
    /// Whether it is orthographic, for cameras that are perspective or orthographic; `None` leaves it as it is.
    #[serde(default)]
    pub(crate) orthographic: Option<bool>,
    /// The ratio of width to height for which it is made; `None` leaves it as it is.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) aspect: Option<f64>,
}

impl CameraData {
    pub(crate) fn of(camera: &Camera) -> Self {
        Self {
            eye: camera.eye.to_array(),
            direction: camera.direction.to_array(),
            right: camera.right.to_array(),
            up: camera.up.to_array(),
            orthographic: match camera.projection {
                Projection::Perspective => Some(false),
                Projection::Orthographic => Some(true),
                _ => None,
            },
            aspect: None,
        }
    }

    /// The scene's camera with these numbers.
    pub(crate) fn apply(&self, camera: &Camera) -> Camera {
        let mut camera = camera.clone();
        camera.eye = self.eye.into();
        camera.direction = self.direction.into();
        camera.right = self.right.into();
        camera.up = self.up.into();
        camera.aspect = self.aspect.or(camera.aspect);
        if let Some(orthographic) = self.orthographic {
            camera.projection = match orthographic {
                true => Projection::Orthographic,
                false => Projection::Perspective,
            };
        }
        camera
    }
}

/// A light at another position.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct MovedLight {
    /// Its number among the scene's lights.
    pub(crate) light: usize,
    pub(crate) position: [f64; 3],
}

/// How a picture is shown. What is absent is as the scene and the command line say.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(crate) struct Settings {
    pub(crate) size: Option<[u32; 2]>,
    pub(crate) sampling: Option<String>,
    pub(crate) depth: Option<u32>,
    pub(crate) cutoff: Option<f64>,
    pub(crate) shading: Option<String>,
    pub(crate) accelerator: Option<String>,
    pub(crate) camera: Option<CameraData>,
    pub(crate) clock: Option<f64>,
    pub(crate) lights: Vec<MovedLight>,
    /// Stops of exposure: 1 doubles the light.
    pub(crate) exposure: f64,
    pub(crate) curve: Curve,
    pub(crate) channel: Channel,
}

/// What becomes of linear values before they are encoded as sRGB.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Curve {
    /// Nothing: the colours are those of a file.
    #[default]
    Srgb,
    /// c / (1 + c), by Reinhard et al. (2002): nothing is overexposed.
    Reinhard,
    /// An S-shaped curve like that of film: Narkowicz's approximation (2015) of the ACES curve.
    Filmic,
}

impl Curve {
    /// The value that is encoded.
    pub(crate) fn apply(self, value: f64) -> f64 {
        match self {
            Self::Srgb => value,
            Self::Reinhard => value / (1.0 + value.max(0.0)),
            Self::Filmic => {
                let x = value.max(0.0);
                (x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14)
            }
        }
    }
}

/// What is shown of the pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Channel {
    #[default]
    Color,
    Normal,
    Depth,
    Object,
    Material,
    Levels,
    Tests,
    Steps,
    Rays,
    Time,
}

/// A message of a page.
#[derive(Clone, Debug, Deserialize)]
#[serde(tag = "type", rename_all = "snake_case", deny_unknown_fields)]
pub(crate) enum Asked {
    /// Another one of the scenes that are built in.
    Open { scene: String },
    /// Read this text instead of a file of the scene (of the scene's own, if there is no name); without a text, read the file again, or
    /// all of them.
    Text {
        file: Option<String>,
        text: Option<String>,
    },
    /// Show a picture.
    Picture {
        slot: Slot,
        #[serde(default)]
        settings: Box<Settings>,
    },
    /// Show it no more.
    Close { slot: Slot },
    /// The ray trees of a pixel.
    Explain { id: u64, slot: Slot, x: u32, y: u32 },
    /// What is seen at a pixel.
    Hover { id: u64, slot: Slot, x: u32, y: u32 },
    /// The pixels of what a line of the scene has made.
    Mark {
        id: u64,
        slot: Slot,
        file: String,
        line: u32,
    },
    /// Linear values of a part of a picture.
    Linear { slot: Slot, region: [u32; 4] },
    /// The text of a file of the scene.
    Source { id: u64, file: String },
    /// The pieces of a text that is being edited.
    Pieces { id: u64, text: String },
    /// The camera of a picture as text of the scene language.
    CameraText { id: u64, slot: Slot },
    /// A light of a picture as text of the scene language.
    LightText { id: u64, slot: Slot, light: usize },
    /// A page with a picture, its objects and the ray trees of some pixels that needs no server.
    ExportPicture {
        id: u64,
        slot: Slot,
        /// Pixels whose trees shall be in it.
        pixels: Vec<[u32; 2]>,
        language: String,
    },
    /// A page with a pixel's ray trees that needs no server.
    Export {
        id: u64,
        slot: Slot,
        x: u32,
        y: u32,
        language: String,
    },
    /// Follow a ray (origin and direction) through the accelerator.
    Walk {
        id: u64,
        slot: Slot,
        ray: [[f64; 3]; 2],
    },
    /// What the picture costs with each accelerator.
    Table { id: u64, slot: Slot },
    /// Write a file of the scene.
    Save { id: u64, file: String, text: String },
    /// Open a line in the author's editor.
    Edit { id: u64, file: String, line: u32 },
}

/// A diagnostic for pages.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Said {
    pub(crate) severity: &'static str,
    pub(crate) message: String,
    pub(crate) file: Option<String>,
    pub(crate) line: Option<u32>,
    pub(crate) column: Option<u32>,
    pub(crate) length: Option<u32>,
    /// The text of the line around the place, and where in it the caret goes.
    pub(crate) text: Option<String>,
    pub(crate) caret: Option<[u32; 2]>,
    pub(crate) help: Vec<String>,
    pub(crate) trace: Vec<String>,
}

impl Said {
    pub(crate) fn of(diagnostic: &Diagnostic, sources: Option<&SourceMap>) -> Self {
        let span = diagnostic.span;
        let known = |n: u32| (n > 0).then_some(n);
        let source = diagnostic.source.as_ref();
        let place = || sources.and_then(|s| s.locate(span));
        Self {
            severity: match diagnostic.severity {
                Severity::Warning => "warning",
                Severity::Error => "error",
            },
            message: diagnostic.message.clone(),
            file: source
                .map(|source| source.file.clone())
                .or_else(|| place().map(|place| place.file.to_owned())),
            line: known(span.line),
            column: known(span.column),
            length: known(span.length),
            text: source.map(|source| source.text.clone()),
            caret: source.map(|source| [source.column, source.length]),
            help: diagnostic.hints.clone(),
            trace: diagnostic.trace.clone(),
        }
    }
}

/// A binary message without its samples.
pub(crate) fn header(kind: u32, picture: u32, region: Region, step: u32) -> Vec<u8> {
    let Region {
        x,
        y,
        width,
        height,
    } = region;
    [kind, picture, x, y, width, height, step, 0]
        .iter()
        .flat_map(|n| n.to_le_bytes())
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_view_from_outside_is_not_squeezed_by_the_aspect_of_the_scenes_camera() {
        let mut camera = Camera::perspective(DVec3::Z, DVec3::ZERO, DVec3::Y, 0.7);
        camera.aspect = Some(4.0 / 3.0);
        let mut data = CameraData::of(&camera);
        assert_eq!(data.apply(&camera).aspect, Some(4.0 / 3.0));
        data.aspect = Some(0.7);
        assert_eq!(data.apply(&camera).aspect, Some(0.7));
    }
}
