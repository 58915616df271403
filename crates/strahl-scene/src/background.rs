use strahl_math::DVec3;
use strahl_shade::Color;

/// What a ray sees that hits nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
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
}

impl Default for Background {
    fn default() -> Self {
        Self::Solid(Color::BLACK)
    }
}

impl Background {
    /// The colour seen along a direction of any length.
    pub fn along(&self, direction: DVec3) -> Color {
        match *self {
            Self::Solid(color) => color,
            Self::Gradient { up, bottom, top } => {
                let length = direction.length();
                let height = if length > 0.0 {
                    up.dot(direction) / length
                } else {
                    0.0
                };
                bottom.lerp(top, 0.5 + 0.5 * height)
            }
        }
    }
}
