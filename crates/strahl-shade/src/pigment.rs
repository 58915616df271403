//! Pigments: the colour, and how much light passes, at every point of space.

use std::sync::Arc;

use strahl_math::DVec3;

use crate::ColorFt;
use crate::image_map::ImageMap;
use crate::patterns::{PatternField, TexturePoint, Warp};

/// Entries at positions in `0..=1`, between which a value is looked up: the common part of all maps.
///
/// Positions must not decrease. Before the first and after the last entry, that entry holds. Of two entries at one position,
/// the first belongs to the values up to there and the second to those beyond.
#[derive(Clone, Debug, PartialEq)]
pub struct BlendMap<T> {
    /// Position and entry.
    pub entries: Vec<(f64, T)>,
}

/// What a value looks up in a [`BlendMap`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Blend<'a, T> {
    /// One entry alone.
    One(&'a T),
    /// Two entries, and the share of the second, between 0 and 1.
    Two(&'a T, &'a T, f64),
}

impl<T> BlendMap<T> {
    /// A map of the given entries.
    pub fn new(entries: Vec<(f64, T)>) -> Self {
        Self { entries }
    }

    /// What belongs to `value`; `None` only if the map is empty.
    pub fn lookup(&self, value: f64) -> Option<Blend<'_, T>> {
        let (first_at, first) = self.entries.first()?;
        if !(value > *first_at) {
            return Some(Blend::One(first));
        }
        // The first entry at or beyond the value; of equal positions that is the first written.
        let above = self.entries.partition_point(|(at, _)| *at < value);
        match (self.entries.get(above), above.checked_sub(1)) {
            (Some((high_at, high)), Some(below)) => {
                let (low_at, low) = &self.entries[below];
                let t = (value - low_at) / (high_at - low_at);
                Some(if t >= 1.0 {
                    Blend::One(high)
                } else {
                    Blend::Two(low, high, t)
                })
            }
            _ => self.entries.last().map(|(_, last)| Blend::One(last)),
        }
    }
}

/// A colour at every point of space.
#[derive(Clone, Debug)]
pub enum Pigment {
    /// The same everywhere.
    Solid(ColorFt),
    /// A value of a pattern, looked up in a map of colours.
    ColorMap(PatternField, BlendMap<ColorFt>),
    /// A value of a pattern, looked up in a map of pigments.
    PigmentMap(PatternField, BlendMap<Pigment>),
    /// A block pattern whose blocks have these pigments. Blocks beyond the list take its last.
    Blocks(PatternField, Vec<Pigment>),
    /// A picture, moved by warps and transformations; clear beside a picture that is laid `once`.
    Image(Arc<ImageMap>, Vec<Warp>),
    /// The weighted mean of pigments, each evaluated at the warped point.
    Average(Vec<(f64, Pigment)>, Vec<Warp>),
    /// The pigment at the surface's own coordinates: (u, v, 0) takes the place of the point.
    UvMapped(Box<Pigment>),
}

impl Default for Pigment {
    /// Opaque black, as POV-Ray's.
    fn default() -> Self {
        Self::Solid(ColorFt::default())
    }
}

impl From<ColorFt> for Pigment {
    fn from(color: ColorFt) -> Self {
        Self::Solid(color)
    }
}

/// The point after warps and transformations, last written first.
pub(crate) fn warped(warps: &[Warp], p: DVec3) -> DVec3 {
    warps.iter().rev().fold(p, |p, warp| warp.apply(p))
}

impl Pigment {
    /// The colour at a point.
    ///
    /// The members of maps are evaluated at the point warped by the map's own warps and transformations, but not displaced
    /// by its turbulence, as in POV-Ray.
    pub fn color_at(&self, point: &TexturePoint) -> ColorFt {
        match self {
            Self::Solid(color) => *color,
            Self::ColorMap(field, map) => match map.lookup(field.value(point)) {
                None => ColorFt::default(),
                Some(Blend::One(color)) => *color,
                Some(Blend::Two(low, high, t)) => low.lerp(*high, t),
            },
            Self::PigmentMap(field, map) => {
                let inner = point.at(field.transformed(point.position));
                match map.lookup(field.value(point)) {
                    None => ColorFt::default(),
                    Some(Blend::One(pigment)) => pigment.color_at(&inner),
                    Some(Blend::Two(low, high, t)) => {
                        low.color_at(&inner).lerp(high.color_at(&inner), t)
                    }
                }
            }
            Self::Blocks(field, pigments) => {
                let inner = point.at(field.transformed(point.position));
                let block = pigments.get(field.block(point)).or(pigments.last());
                block.map_or_else(ColorFt::default, |pigment| pigment.color_at(&inner))
            }
            Self::Image(image, warps) => image
                .color(warped(warps, point.position))
                .unwrap_or(ColorFt::CLEAR),
            Self::Average(members, warps) => {
                let inner = point.at(warped(warps, point.position));
                let (mut sum, mut total) = (ColorFt::default(), 0.0);
                for (weight, pigment) in members {
                    sum = sum + pigment.color_at(&inner) * *weight;
                    total += weight;
                }
                if total == 0.0 {
                    sum
                } else {
                    sum * (1.0 / total)
                }
            }
            Self::UvMapped(pigment) => {
                let uv = DVec3::new(point.uv.x, point.uv.y, 0.0);
                pigment.color_at(&point.at(uv))
            }
        }
    }
}
