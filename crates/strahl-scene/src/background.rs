use crate::SkySphere;
use std::sync::Arc;
use strahl_math::DVec3;
use strahl_shade::{Color, Quality};

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

/// The alpha channel of rays that hit nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BackgroundAlpha {
    /// The picture is transparent there.
    LeftOut,
    /// The picture is transparent there but for a sky, whose pigments have their own transparency.
    Clear,
    /// The background is in the picture; the filter and transmit of its colour are its transparency. A sky in front of it has the
    /// transparency of its pigments. In a picture without an alpha channel the transmit of the background shows black, as in POV-Ray 3.7 (measured).
    Seen {
        /// The fraction transmitted with the tint of the background's colour.
        filter: f64,
        /// The fraction transmitted unchanged.
        transmit: f64,
    },
}

impl Default for BackgroundAlpha {
    /// An opaque background.
    fn default() -> Self {
        Self::Seen {
            filter: 0.0,
            transmit: 0.0,
        }
    }
}

impl Default for Background {
    fn default() -> Self {
        Self::Solid(Color::BLACK)
    }
}

impl Background {
    /// The background as pictures of this quality show it.
    #[must_use]
    pub fn of_quality(&self, quality: Quality) -> Self {
        match self {
            Self::Sky(sky) => Self::Sky(sky.of_quality(quality).map_or(Arc::clone(sky), Arc::new)),
            other => other.clone(),
        }
    }

    /// The background as pictures without an alpha channel show it.
    #[must_use]
    pub fn opaque(&self, alpha: BackgroundAlpha) -> Self {
        let BackgroundAlpha::Seen { transmit, .. } = alpha else {
            return self.clone();
        };
        let keeps = 1.0 - transmit.clamp(0.0, 1.0);
        match self {
            Self::Solid(color) => Self::Solid(*color * keeps),
            Self::Sky(sky) if keeps < 1.0 => Self::Sky(Arc::new(SkySphere {
                behind: sky.behind * keeps,
                ..SkySphere::clone(sky)
            })),
            other => other.clone(),
        }
    }

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

    /// The colour seen along a direction of any length; the part of it that a picture with an alpha channel leaves out; and the transmittance for the light from
    /// behind the picture, as measured with POV-Ray 3.7.
    pub fn seen(&self, direction: DVec3, alpha: BackgroundAlpha) -> [Color; 3] {
        let (light, behind, passes) = match self {
            Self::Sky(sky) => {
                let (light, passes) = sky.seen(direction);
                (light, sky.behind, passes)
            }
            _ => {
                let light = self.along(direction);
                (light, light, Color::WHITE)
            }
        };
        let (filter, transmit) = match alpha {
            BackgroundAlpha::LeftOut => return [light, light, Color::WHITE],
            BackgroundAlpha::Clear => (0.0, 1.0),
            BackgroundAlpha::Seen { filter, transmit } => (filter, transmit),
        };
        let hidden = behind * passes * (filter + transmit).clamp(0.0, 1.0);
        let clear = (behind * filter + Color::gray(transmit)).map(|c| c.clamp(0.0, 1.0));
        [light, hidden, passes * clear]
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
