//! Patterns: functions from a point to a number, which select colours, normals and whole textures.
//!
//! They are POV-Ray's, and give its values: every pattern here was compared with `function { pattern { ... } }` of
//! POV-Ray 3.7 (the tables of `tests.rs`).
//!
//! A pattern is evaluated in three steps. The point is moved by the warps and transformations, last written first, and then
//! by turbulence; the pattern's formula gives a raw value; [`Modifiers::shape`] repeats it by frequency and phase and
//! bends it by a wave form. Block patterns (checker, brick, ...) give the number of a cell instead.

mod batch;
mod blocks;
mod crackle;
mod density;
mod fractal;
mod modifiers;
mod noisy;
mod plain;
mod random;
mod tiling;
mod warp;
pub(crate) mod water;

use std::sync::Arc;

use strahl_function::{Cost, ScalarField};
use strahl_math::{DVec2, DVec3};

pub use batch::BATCH;
pub(crate) use batch::Batch;
pub(crate) use crackle::nearest_point;
pub use crackle::{Crackle, CrackleMetric};
pub use density::{DensityCodes, DensityGrid, DensityInterpolation};
pub use fractal::{Exterior, Fractal, FractalKind, Interior as FractalInterior};
pub use modifiers::{Modifiers, Wave};
pub(crate) use plain::quilted_tilt;
pub use plain::{Altitude, SlopeReference};
pub use tiling::TilingNumber;
pub use warp::{BlackHole, Mapping, Warp};

use crate::image_map::ImageMap;
use crate::pigment::Pigment;

/// The point at which a texture is evaluated.
///
/// All vectors are in the space of `position`; when a texture, pigment or pattern has a transformation of its own,
/// only the position is carried into its space, as in POV-Ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TexturePoint {
    /// The position on the surface, in the space of the texture.
    pub position: DVec3,
    /// Whether the texture is a member of a patterned one or lies on texture coordinates as a whole: a normal with `uv_mapping` is tilted in
    /// the texture's space then, not in the world's.
    pub is_member: bool,
    /// The position in the object's space, if `position` is on texture coordinates of an object with `uv_mapping`.
    pub in_object: Option<DVec3>,
    /// The same position in world space, unaffected by the transformations of textures, pigments and patterns.
    pub surface: DVec3,
    /// Unit normal of the surface, turned towards the viewer.
    pub n_geom: DVec3,
    /// Unit normal for shading (smooth triangles interpolate it), turned towards the viewer.
    pub n_shade: DVec3,
    /// Surface coordinates, for `uv_mapping`.
    pub uv: DVec2,
    /// Unit direction of the ray that meets the surface, pointing away from the viewer.
    pub direction: DVec3,
}

impl TexturePoint {
    /// A point of space without a surface: the shading normal is zero, the direction `-y`.
    pub fn in_space(position: DVec3) -> Self {
        Self {
            position,
            is_member: false,
            in_object: None,
            surface: position,
            n_geom: DVec3::Y,
            n_shade: DVec3::ZERO,
            uv: DVec2::ZERO,
            direction: DVec3::NEG_Y,
        }
    }

    /// The same with another position.
    #[must_use]
    pub fn at(&self, position: DVec3) -> Self {
        Self { position, ..*self }
    }

    /// The same in another space, to which a map carries positions.
    #[must_use]
    pub(crate) fn moved(&self, map: impl Fn(DVec3) -> DVec3) -> Self {
        self.moved_to(map(self.position), map)
    }

    /// The same if the map is known to carry the position to this one.
    #[must_use]
    pub(crate) fn moved_to(&self, position: DVec3, map: impl Fn(DVec3) -> DVec3) -> Self {
        Self {
            position,
            in_object: self.in_object.map(&map),
            ..*self
        }
    }

    /// The same at `(u, v, 0)`, where all textures of an object with `uv_mapping` are evaluated, in the world's space; `in_object` is
    /// the position in the object's space.
    #[must_use]
    pub fn on_surface(&self, in_object: DVec3) -> Self {
        Self {
            in_object: Some(in_object),
            ..self.at_coordinates()
        }
    }

    /// The same at `(u, v, 0)`.
    #[must_use]
    pub(crate) fn at_coordinates(&self) -> Self {
        self.at(self.uv.extend(0.0))
    }

    /// The same for a member of a texture.
    #[must_use]
    pub(crate) fn of_member(self) -> Self {
        Self {
            is_member: true,
            ..self
        }
    }
}

/// An object with an inside, for the object pattern. Implemented by a crate that knows shapes.
pub trait Inside: std::fmt::Debug + Send + Sync {
    /// Whether the point lies inside.
    fn contains(&self, p: DVec3) -> bool;

    /// The cost of that.
    fn cost(&self) -> Cost {
        Cost::FORMULA
    }
}

/// The table of patterns: name, parameters and formula.
#[derive(Clone, Debug)]
pub enum Pattern {
    /// Bands of marble-like stone with a turbulence of its own, along z.
    Agate {
        /// Strength of the built-in turbulence (`agate_turb`), 1 by default.
        turbulence: f64,
    },
    /// From 1/2 where the ray grazes the surface to 1 where it meets it head on.
    Aoi,
    /// `1 - max(|x|, |y|, |z|)`, not below zero.
    Boxed,
    /// Smooth noise; also bumps and spotted.
    Bozo,
    /// A wall of bricks: block 0 is the mortar, block 1 the bricks.
    Brick {
        /// Size of a brick with its mortar, `<8, 3, 4.5>` by default.
        size: DVec3,
        /// Thickness of the mortar, 1/2 by default.
        mortar: f64,
    },
    /// A random number per unit cube.
    Cells,
    /// Unit cubes in two colours.
    Checker,
    /// Distances to random points, one per unit cube.
    Crackle(Crackle),
    /// Six pyramids around the origin: blocks +x, +y, +z, -x, -y, -z.
    Cubic,
    /// `1 - sqrt(x² + z²)`, not below zero.
    Cylindrical,
    /// Values measured at the points of a grid in the unit cube; 0 outside of it.
    Density(Arc<DensityGrid>, DensityInterpolation),
    /// The cube of noise.
    Dents,
    /// A Mandelbrot, Julia or magnet set in the x-y plane.
    Fractal(Fractal),
    /// Any function of x, y and z.
    Function(Arc<dyn ScalarField>),
    /// The distance along a direction.
    Gradient(DVec3),
    /// Six octaves of noise with creases.
    Granite,
    /// Hexagonal rods along y, of side 1, in three colours.
    Hexagon,
    /// The grey value of a picture.
    Image(Arc<ImageMap>),
    /// `((sin x + sin y + sin z) / 3)²`.
    Leopard,
    /// `x`, stirred by turbulence.
    Marble,
    /// Block 0 outside, block 1 inside of an object.
    Object(Arc<dyn Inside>),
    /// The distance from the origin, modulo 1.
    Onion,
    /// The grey value of a pigment.
    Pigment(Arc<Pigment>),
    /// `1 - |y|`, not below zero.
    Planar,
    /// Cushions on the unit cubes, with POV-Ray's `control0` and `control1`.
    Quilted {
        /// Slope of the profile near the middle of a cushion.
        control0: f64,
        /// Slope of the profile near the seam.
        control1: f64,
    },
    /// The angle around the y axis.
    Radial,
    /// Ripples from ten sources, all of the same wavelength.
    Ripples {
        /// Number of sources (`number_of_waves`), 10 by default.
        sources: u32,
    },
    /// How steep the surface is.
    Slope {
        /// What the normal is compared with.
        reference: SlopeReference,
        /// The slopes that become 0 and 1; equal values mean 0 and 1.
        range: [f64; 2],
        /// A gradient mixed in.
        altitude: Option<Altitude>,
    },
    /// `1 - sqrt(x² + y² + z²)`, not below zero.
    Spherical,
    /// A spiral around the z axis with this number of arms.
    Spiral1(f64),
    /// Two spirals laid over each other.
    Spiral2(f64),
    /// Square rods along y in four colours.
    Square,
    /// Tiles of the x-z plane with bevelled edges.
    Tiling(TilingNumber),
    /// Triangular rods along y, of side 1, in six colours.
    Triangular,
    /// Waves from ten sources, each of its own wavelength.
    Waves {
        /// Number of sources (`number_of_waves`), 10 by default.
        sources: u32,
    },
    /// Rings around the z axis, stirred by turbulence.
    Wood,
    /// Ten octaves of noise.
    Wrinkles,
}

impl Pattern {
    /// The number of blocks of a block pattern; `None` for patterns with continuous values.
    pub fn block_count(&self) -> Option<usize> {
        match self {
            Self::Brick { .. } | Self::Checker | Self::Object(_) => Some(2),
            Self::Hexagon => Some(3),
            Self::Square => Some(4),
            Self::Cubic | Self::Triangular => Some(6),
            _ => None,
        }
    }

    /// The wave form of the pattern by default.
    pub fn default_wave(&self) -> Wave {
        match self {
            Self::Marble | Self::Spiral1(_) | Self::Spiral2(_) | Self::Wood => Wave::Triangle,
            _ => Wave::Ramp,
        }
    }

    /// Whether turbulence displaces the point before the formula; marble and wood use it differently.
    fn is_displaced(&self) -> bool {
        !matches!(self, Self::Marble | Self::Wood)
    }

    /// The number of the block at `p`, which is already warped; 0 for patterns without blocks.
    pub(crate) fn block(&self, p: DVec3) -> usize {
        match self {
            Self::Brick { size, mortar } => blocks::brick(p, *size, *mortar),
            Self::Checker => blocks::checker(p),
            Self::Cubic => blocks::cubic(p),
            Self::Hexagon => blocks::hexagon(p),
            Self::Object(object) => usize::from(object.contains(p)),
            Self::Square => blocks::square(p),
            Self::Triangular => blocks::triangular(p),
            _ => 0,
        }
    }

    /// The raw value at `p`, the moved position of `point`.
    fn raw(&self, p: DVec3, point: &TexturePoint, modifiers: &Modifiers) -> f64 {
        let noise = modifiers.noise;
        match self {
            Self::Agate { turbulence } => noisy::agate(p, *turbulence, modifiers),
            Self::Aoi => plain::aoi(point),
            Self::Boxed => plain::boxed(p),
            Self::Bozo => strahl_math::noise::noise(p, noise),
            Self::Cells => crackle::cells(p),
            Self::Crackle(crackle) => crackle.value(p, noise),
            Self::Cylindrical => plain::cylindrical(p),
            Self::Density(grid, interpolation) => grid.density(p, *interpolation),
            Self::Dents => noisy::dents(p, noise),
            Self::Fractal(fractal) => fractal.value(DVec2::new(p.x, p.y)),
            Self::Function(function) => plain::wrapped(function.value(&p.to_array())),
            Self::Gradient(direction) => plain::gradient(p, *direction),
            Self::Granite => noisy::granite(p, noise),
            Self::Image(image) => image.gray(p),
            Self::Leopard => plain::leopard(p),
            Self::Marble => noisy::marble(p, modifiers),
            Self::Onion => plain::onion(p),
            Self::Pigment(pigment) => pigment.color_at(&point.at(p)).gray(),
            Self::Planar => plain::planar(p),
            Self::Quilted { control0, control1 } => plain::quilted(p, [*control0, *control1]),
            Self::Radial => plain::radial(p),
            Self::Ripples { sources } => water::ripples(p, *sources, modifiers),
            Self::Slope {
                reference,
                range,
                altitude,
            } => plain::slope(p, point, reference, *range, altitude.as_ref()),
            Self::Spherical => plain::spherical(p),
            Self::Spiral1(arms) => plain::spiral1(p, *arms, modifiers),
            Self::Spiral2(arms) => plain::spiral2(p, *arms, modifiers),
            Self::Tiling(number) => number.value(p),
            Self::Waves { sources } => water::waves(p, *sources, modifiers),
            Self::Wood => noisy::wood(p, modifiers),
            Self::Wrinkles => noisy::wrinkles(p, noise),
            Self::Brick { .. }
            | Self::Checker
            | Self::Cubic
            | Self::Hexagon
            | Self::Object(_)
            | Self::Square
            | Self::Triangular => self.block(p) as f64,
        }
    }
}

/// A pattern with its modifiers: what stands in a pigment, normal or texture statement.
#[derive(Clone, Debug)]
pub struct PatternField {
    /// The pattern.
    pub pattern: Pattern,
    /// Its modifiers.
    pub modifiers: Modifiers,
}

impl From<Pattern> for PatternField {
    /// The pattern without modifiers.
    fn from(pattern: Pattern) -> Self {
        Self {
            pattern,
            modifiers: Modifiers::default(),
        }
    }
}

impl From<Pattern> for Box<PatternField> {
    /// The pattern without modifiers.
    fn from(pattern: Pattern) -> Self {
        Self::new(pattern.into())
    }
}

impl PatternField {
    /// The value at a point, in `0..=1.00001`: what lies beyond is repeated into it by [`Modifiers::shape`].
    pub fn value(&self, point: &TexturePoint) -> f64 {
        self.value_and_place(point).0
    }

    /// The value at a point, and the place where it is evaluated: [`PatternField::moved`].
    pub fn value_and_place(&self, point: &TexturePoint) -> (f64, DVec3) {
        let place = self.moved(point.position);
        (self.as_ref().value_moved(place, point), place)
    }

    /// The number of the block at a point, below [`Pattern::block_count`]; 0 for patterns without blocks.
    pub fn block(&self, point: &TexturePoint) -> usize {
        self.block_moved(self.moved(point.position))
    }

    /// The number of the block at a place to which [`PatternField::moved`] has led, below [`Pattern::block_count`]; 0 for patterns
    /// without blocks.
    pub(crate) fn block_moved(&self, place: DVec3) -> usize {
        self.pattern.block(place)
    }

    /// The position after warps, transformations and the turbulence that moves points: there the pattern is evaluated, and
    /// there the members of a map or list are (measured).
    pub fn moved(&self, position: DVec3) -> DVec3 {
        let field = self.as_ref();
        field.moved(self.modifiers.warped(position))
    }

    fn as_ref(&self) -> FieldRef<'_> {
        FieldRef {
            pattern: &self.pattern,
            modifiers: &self.modifiers,
        }
    }
}

/// A pattern and the modifiers that belong to it, borrowed from wherever they are.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FieldRef<'a> {
    pub(crate) pattern: &'a Pattern,
    pub(crate) modifiers: &'a Modifiers,
}

impl FieldRef<'_> {
    /// The value at `p`, to which warps and turbulence have led already; nothing else of the point than its position is another there.
    pub(crate) fn value_moved(&self, p: DVec3, point: &TexturePoint) -> f64 {
        self.value_of_raw(self.pattern.raw(p, point, self.modifiers))
    }

    /// The value where the pattern has a raw value, which frequency, phase and wave have not changed yet.
    fn value_of_raw(&self, raw: f64) -> f64 {
        let wave = self.modifiers.wave;
        let wave = wave.unwrap_or_else(|| self.pattern.default_wave());
        let is_beyond = match self.pattern {
            Pattern::Radial => true,
            Pattern::Fractal(_) => raw > 1.0,
            pattern => pattern.block_count().is_some(),
        };
        if self.modifiers.frequency == 0.0 && is_beyond {
            // The numbers of blocks, and the values of `radial` and fractals above 1, are not repeated (measured).
            return wave.apply(raw);
        }
        self.modifiers.shape(raw, wave)
    }

    /// The point after turbulence, if the pattern lets turbulence move it.
    pub(crate) fn moved(&self, p: DVec3) -> DVec3 {
        if self.pattern.is_displaced() {
            self.modifiers.displaced(p)
        } else {
            p
        }
    }
}

#[cfg(test)]
mod tests;
