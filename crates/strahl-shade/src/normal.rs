//! Normals: patterns that perturb the shading normal, so that a smooth surface looks rough.
//!
//! All formulas were compared with rendered planes of POV-Ray 3.7; the normals agree within 2e-5, which is the
//! precision of the 16-bit pictures they were reconstructed from.

use std::sync::Arc;

use strahl_math::DVec3;
use strahl_math::noise::{dnoise, noise};

use crate::SharedList;
use crate::image_map::ImageMap;
use crate::patterns::{
    Batch, Modifiers, Pattern, PatternField, TexturePoint, Warp, nearest_point, water,
};
use crate::pigment::{Blend, BlendMap};

/// A map from pattern values to heights: value, height and slope, by cubic Hermite interpolation.
#[derive(Clone, Debug, PartialEq)]
pub struct SlopeMap(pub BlendMap<[f64; 2]>);

impl SlopeMap {
    /// The height at `value`. The slopes count per interval of the map, not per unit of the value (measured).
    pub fn height(&self, value: f64) -> f64 {
        match self.0.lookup(value) {
            None => value,
            Some(Blend::One([height, _])) => *height,
            Some(Blend::Two([h0, s0], [h1, s1], t)) => {
                let s = 1.0 - t;
                s * s * (h0 * (1.0 + 2.0 * t) + s0 * t) + t * t * (h1 * (1.0 + 2.0 * s) - s1 * s)
            }
        }
    }
}

/// The pieces of a surface that looks cut (`facets`).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Facets {
    /// Their size: 0.1 by default. There are none at 0 and below.
    pub size: f64,
    /// How much each of them is tilted (`coords`): they are the cells of `crackle` in this size then, tilted by this times the part of the
    /// vector noise at the cell's point that lies in the surface. If it is 0, the normal is the direction of the point of `crackle` that is
    /// nearest to the normal divided by the size: a flat surface is one piece.
    pub tilt: f64,
}

impl Default for Facets {
    fn default() -> Self {
        Self {
            size: 0.1,
            tilt: 0.0,
        }
    }
}

impl Facets {
    /// The tilted normal at a point of the pattern's space; `n` is the unit normal there.
    fn tilted(self, p: DVec3, n: DVec3) -> DVec3 {
        let Self { size, tilt } = self;
        if !(size > 0.0) {
            n
        } else if tilt == 0.0 {
            nearest_point(n / size)
        } else {
            let noise = dnoise(nearest_point(p / size));
            n + (noise - n * noise.dot(n)) * tilt
        }
    }
}

/// How a normal is perturbed.
#[derive(Clone, Debug)]
pub enum NormalKind {
    /// By vector noise (`bumps`).
    Bumps,
    /// By vector noise where noise is high (`dents`).
    Dents,
    /// By ten octaves of the absolute value of vector noise (`wrinkles`).
    Wrinkles,
    /// Away from and towards the sources of waves of equal length (`ripples`), of which there are this many.
    Ripples(u32),
    /// The same with different lengths (`waves`).
    Waves(u32),
    /// Outwards on cushions (`quilted`) with these controls.
    Quilted([f64; 2]),
    /// To the same side on each of many pieces (`facets`); the amount does not count.
    Facets(Facets),
    /// Against the gradient of a pattern's value, taken as a height, possibly by way of a slope map.
    Height(Pattern, Option<SlopeMap>),
    /// Against the slope of a picture's grey value, taken as a relief (`bump_map`).
    BumpMap(Arc<ImageMap>),
    /// The weighted mean of two normals, chosen by a pattern's value (`normal_map`).
    Map(Pattern, BlendMap<PovNormal>),
    /// The normal of the block a point lies in. Blocks beyond the list take its last.
    Blocks(Pattern, SharedList<PovNormal>),
    /// The weighted mean of normals (`average`).
    Average(SharedList<(f64, PovNormal)>),
}

/// A normal statement: kind, amount and position of the perturbation.
#[derive(Clone, Debug)]
pub struct PovNormal {
    /// How the normal is perturbed.
    pub kind: NormalKind,
    /// The amount: the number after the pattern's name, or `bump_size`.
    pub amount: f64,
    /// Edge of the tetrahedron on whose corners a height is probed (`accuracy`), 0.02 by default.
    pub accuracy: f64,
    /// Whether a transformation that enlarges the pattern flattens the bumps instead of enlarging them too (`no_bump_scale`).
    pub no_bump_scale: bool,
    /// Whether the pattern lies on the surface's texture coordinates (`uv_mapping`); the normal is tilted in the world's space then.
    pub uv_mapped: bool,
    /// Warps, transformations, turbulence, frequency, phase and wave.
    pub modifiers: Modifiers,
}

impl PovNormal {
    /// A normal with POV-Ray's defaults: amount 0.5, accuracy 0.02.
    pub fn new(kind: NormalKind) -> Self {
        Self {
            kind,
            amount: 0.5,
            accuracy: 0.02,
            no_bump_scale: false,
            uv_mapped: false,
            modifiers: Modifiers::default(),
        }
    }

    /// The tilted normal at a point; `n` is the normal to be tilted, on the side of the viewer, both in the space around
    /// the normal's own transformations. The length of `n` counts with `no_bump_scale` only: a map of the world to that space has changed it. A unit vector, except with `no_bump_scale`: its length then counts where the
    /// normals of a map are mixed, and for the patterns `slope` and `aoi` (measured).
    pub fn tilt(&self, point: &TexturePoint, n: DVec3) -> DVec3 {
        // Into the pattern's space, where the normal is tilted, and back.
        let warps = &self.modifiers.warps;
        let mut inner = n;
        for warp in warps.iter().rev() {
            if let Warp::Transform(transform) = warp {
                inner = transform.linear().transpose() * inner;
            }
        }
        if !self.no_bump_scale {
            inner = inner.normalize_or_zero();
        }
        let mut tilted = self.tilt_inside(point, inner);
        for warp in warps {
            if let Warp::Transform(transform) = warp {
                tilted = transform.normal_to_world(tilted);
            }
        }
        match tilted.try_normalize() {
            None => n,
            Some(_) if self.no_bump_scale => tilted,
            Some(unit) => unit,
        }
    }

    /// The perturbed normal in the pattern's space, not of unit length.
    fn tilt_inside(&self, point: &TexturePoint, n: DVec3) -> DVec3 {
        let transformed = self.modifiers.warped(point.position);
        let moved = || self.modifiers.displaced(transformed);
        match &self.kind {
            NormalKind::Bumps => n + dnoise(moved()) * self.amount,
            NormalKind::Dents => {
                let p = moved();
                let depth = noise(p, self.modifiers.noise);
                n + dnoise(p) * (self.amount * (depth * depth * depth))
            }
            NormalKind::Wrinkles => {
                let p = moved();
                let mut frequency = 1.0;
                let mut sum = DVec3::ZERO;
                for _ in 0..10 {
                    sum += dnoise(p * frequency).abs() / frequency;
                    frequency *= 2.0;
                }
                n + sum * self.amount
            }
            NormalKind::Ripples(sources) => {
                n + water::ripples_tilt(moved(), *sources, &self.modifiers) * self.amount
            }
            NormalKind::Waves(sources) => {
                n + water::waves_tilt(moved(), *sources, &self.modifiers) * self.amount
            }
            NormalKind::Quilted(controls) => {
                n + crate::patterns::quilted_tilt(moved(), *controls) * self.amount
            }
            NormalKind::Facets(facets) => facets.tilted(moved(), n.normalize_or_zero()),
            NormalKind::Height(pattern, slopes) => {
                let field = self.field(pattern);
                // The tetrahedron surrounds the displaced point; its corners are not displaced again.
                let heights = |corners| {
                    let mut heights = [0.0; 4];
                    field.store_moved(&Batch::of_four(corners, point), &mut heights);
                    if let Some(map) = slopes {
                        for height in &mut heights {
                            *height = map.height(*height);
                        }
                    }
                    heights
                };
                let center = field.moved(transformed);
                n - tetrahedral_gradient(center, self.accuracy, heights) * self.amount
            }
            NormalKind::BumpMap(image) => {
                (n + image.tilt(moved(), n) * self.amount).normalize_or_zero()
            }
            NormalKind::Map(pattern, map) => {
                let field = self.field(pattern);
                let place = field.moved(transformed);
                let value = field.value_moved(place, point);
                let inner = point.at(place);
                let unit = self.for_parts(n);
                match map.lookup(value) {
                    None => n,
                    Some(Blend::One(normal)) => normal.tilt(&inner, unit),
                    Some(Blend::Two(low, high, t)) => {
                        low.tilt(&inner, unit) * (1.0 - t) + high.tilt(&inner, unit) * t
                    }
                }
            }
            NormalKind::Blocks(pattern, normals) => {
                let field = self.field(pattern);
                let place = field.moved(transformed);
                let inner = point.at(place);
                let normal = normals.get(pattern.block(place)).or(normals.last());
                normal.map_or(n, |normal| normal.tilt(&inner, self.for_parts(n)))
            }
            NormalKind::Average(members) => {
                let inner = point.at(moved());
                let unit = self.for_parts(n);
                let sum = members
                    .iter()
                    .map(|(weight, normal)| normal.tilt(&inner, unit) * *weight)
                    .fold(DVec3::ZERO, |a, b| a + b);
                let total: f64 = members.iter().map(|(weight, _)| weight).sum();
                if sum == DVec3::ZERO || total == 0.0 {
                    n
                } else {
                    sum / total
                }
            }
        }
    }

    /// The normal that the normals of a map are to tilt: of unit length, unless the bumps keep their size.
    fn for_parts(&self, n: DVec3) -> DVec3 {
        if self.no_bump_scale {
            n
        } else {
            n.normalize_or_zero()
        }
    }

    fn field<'a>(&'a self, pattern: &'a Pattern) -> crate::patterns::FieldRef<'a> {
        crate::patterns::FieldRef {
            pattern,
            modifiers: &self.modifiers,
        }
    }
}

impl From<PatternField> for PovNormal {
    /// Uses the pattern's value as a height.
    fn from(field: PatternField) -> Self {
        Self {
            modifiers: field.modifiers,
            ..Self::new(NormalKind::Height(field.pattern, None))
        }
    }
}

/// `0.1/δ` times the sum over the corners v of a regular tetrahedron of `v f(p + δ v)`: 2/15 of the gradient. `f` is asked for all four
/// at once.
fn tetrahedral_gradient(p: DVec3, delta: f64, f: impl Fn([DVec3; 4]) -> [f64; 4]) -> DVec3 {
    /// Corners at distance 1 from the centre: cosines and sines of the tetrahedral angle.
    const CORNERS: [DVec3; 4] = [
        DVec3::new(0.942_809_041, -0.333_333_333, 0.0),
        DVec3::new(-0.471_404_521, -0.333_333_333, 0.816_496_581),
        DVec3::new(-0.471_404_521, -0.333_333_333, -0.816_496_581),
        DVec3::new(0.0, 1.0, 0.0),
    ];
    let delta = if delta > 0.0 { delta } else { 0.02 };
    let values = f(CORNERS.map(|corner| p + corner * delta));
    let mut sum = DVec3::ZERO;
    for (corner, value) in CORNERS.iter().zip(values) {
        sum += *corner * value;
    }
    sum * (0.1 / delta)
}

#[cfg(test)]
mod tests;
