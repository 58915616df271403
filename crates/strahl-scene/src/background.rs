use crate::SkySphere;
use std::sync::Arc;
use strahl_math::DVec3;
use strahl_shade::Color;

/// The radiance along rays that hit nothing.
#[derive(Clone, Debug)]
pub enum Background {
    /// One colour everywhere.
    Solid(Color),
    /// A blend by the height of the ray's direction: `bottom` straight down, `top` straight up.
    Gradient {
        /// Unit vector that points up.
        up: DVec3,
        /// The colour below.
        bottom: Color,
        /// The colour above.
        top: Color,
    },
    /// Pigments by direction.
    Sky(Arc<SkySphere>),
}

impl Default for Background {
    fn default() -> Self {
        Self::Solid(Color::BLACK)
    }
}

impl Background {
    /// The colour seen along a direction of any length.
    pub fn along(&self, direction: DVec3) -> Color {
        match self {
            Self::Solid(color) => *color,
            Self::Sky(sky) => sky.along(direction),
            Self::Gradient { up, bottom, top } => {
                let length = direction.length();
                let height = if length > 0.0 {
                    up.dot(direction) / length
                } else {
                    0.0
                };
                bottom.lerp(*top, 0.5 + 0.5 * height)
            }
        }
    }
}

impl PartialEq for Background {
    /// Skies are equal if they are the same object.
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Solid(a), Self::Solid(b)) => a == b,
            (Self::Sky(a), Self::Sky(b)) => Arc::ptr_eq(a, b),
            (
                Self::Gradient { up, bottom, top },
                Self::Gradient {
                    up: other_up,
                    bottom: other_bottom,
                    top: other_top,
                },
            ) => (up, bottom, top) == (other_up, other_bottom, other_top),
            _ => false,
        }
    }
}
