//! Pigments: the colour and the transparency at every point of space.

use std::sync::Arc;

use crate::image_map::ImageMap;
use crate::patterns::{BATCH, Batch, Modifiers, PatternField, TexturePoint};
use crate::{ColorFt, SharedList};
use arrayvec::ArrayVec;
use strahl_math::DVec3;

/// Entries at positions in `0..=1`, between which a value is looked up: the common part of all maps.
///
/// Before the first and after the last entry, that entry holds. Of two entries at one position, the first belongs to the values up
/// to there and the second to those beyond; at the last position of all it is the second.
#[derive(Clone, Debug, PartialEq)]
pub struct BlendMap<T> {
    /// Position and entry.
    pub entries: SharedList<(f64, T)>,
}

/// The result of a lookup in a [`BlendMap`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Blend<'a, T> {
    /// One entry alone.
    One(&'a T),
    /// Two entries, and the share of the second, between 0 and 1.
    Two(&'a T, &'a T, f64),
}

impl<T> BlendMap<T> {
    /// A map of the given entries.
    pub fn new(entries: impl Into<SharedList<(f64, T)>>) -> Self {
        Self {
            entries: entries.into(),
        }
    }

    /// The entries for `value`; `None` only if the map is empty.
    ///
    /// Positions may decrease. As in POV-Ray, a value of at least the last position gets the last entry; any other gets the first
    /// entry whose position is not below it, mixed with the entry before (measured).
    pub fn lookup(&self, value: f64) -> Option<Blend<'_, T>> {
        let (last_at, last) = self.entries.last()?;
        if value >= *last_at {
            return Some(Blend::One(last));
        }
        let above = self.entries.iter().position(|(at, _)| !(value > *at));
        let (high_at, high) = &self.entries[above?];
        let below = above.and_then(|above| above.checked_sub(1));
        let Some((low_at, low)) = below.and_then(|below| self.entries.get(below)) else {
            return Some(Blend::One(high));
        };
        let t = (value - low_at) / (high_at - low_at);
        Some(if t >= 1.0 {
            Blend::One(high)
        } else {
            Blend::Two(low, high, t)
        })
    }
}

impl BlendMap<ColorFt> {
    /// The colour for `value`.
    fn color(&self, value: f64) -> ColorFt {
        match self.lookup(value) {
            None => ColorFt::default(),
            Some(Blend::One(color)) => *color,
            Some(Blend::Two(low, high, t)) => low.lerp(*high, t),
        }
    }
}

/// A colour at every point of space.
#[derive(Clone, Debug)]
pub enum Pigment {
    /// The same everywhere. The modifiers show nothing: a pattern that replaces the colour takes them over.
    Solid(ColorFt, Option<Box<Modifiers>>),
    /// A value of a pattern, looked up in a map of colours.
    ColorMap(Box<PatternField>, BlendMap<ColorFt>),
    /// A value of a pattern, looked up in a map of pigments.
    PigmentMap(Box<PatternField>, BlendMap<Pigment>),
    /// A block pattern whose blocks have these pigments. Blocks beyond the list take its last.
    Blocks(Box<PatternField>, SharedList<Pigment>),
    /// A picture, moved by warps, transformations and turbulence; clear beside a picture that is laid `once`.
    Image(Arc<ImageMap>, Box<Modifiers>),
    /// The weighted mean of pigments, each evaluated at the moved point.
    Average(SharedList<(f64, Pigment)>, Box<Modifiers>),
    /// The pigment at the surface's own coordinates: (u, v, 0) takes the place of the point.
    UvMapped(Box<Pigment>),
    /// A pigment with the colour that quick pictures show in its place (`quick_color`): see [`Pigment::of_quality`].
    Quick(ColorFt, Box<Pigment>),
}

impl Default for Pigment {
    /// Opaque black, as POV-Ray's.
    fn default() -> Self {
        Self::Solid(ColorFt::default(), None)
    }
}

impl From<ColorFt> for Pigment {
    fn from(color: ColorFt) -> Self {
        Self::Solid(color, None)
    }
}

impl Pigment {
    /// Whether it may be transparent somewhere: `false` is certain, `true` is not.
    pub fn may_transmit(&self) -> bool {
        let passes = |c: &ColorFt| c.filter != 0.0 || c.transmit != 0.0;
        match self {
            Self::Solid(color, _) => passes(color),
            Self::ColorMap(_, map) => map.entries.iter().any(|(_, c)| passes(c)),
            Self::PigmentMap(_, map) => map.entries.iter().any(|(_, p)| p.may_transmit()),
            Self::Blocks(_, pigments) => pigments.iter().any(Self::may_transmit),
            Self::Image(image, _) => image.may_transmit(),
            Self::Average(members, _) => members.iter().any(|(_, p)| p.may_transmit()),
            Self::UvMapped(pigment) | Self::Quick(_, pigment) => pigment.may_transmit(),
        }
    }

    /// The colour at a point.
    ///
    /// The members of maps are evaluated at the point that the map's pattern is evaluated at, turbulence included, as in
    /// POV-Ray.
    pub fn color_at(&self, point: &TexturePoint) -> ColorFt {
        match self {
            Self::Solid(color, _) => *color,
            Self::ColorMap(field, map) => map.color(field.value(point)),
            Self::PigmentMap(field, map) => {
                let (value, place) = field.value_and_place(point);
                let color = |pigment: &Self| pigment.color_moved(point, place);
                match map.lookup(value) {
                    None => ColorFt::default(),
                    Some(Blend::One(pigment)) => color(pigment),
                    Some(Blend::Two(low, high, t)) => color(low).lerp(color(high), t),
                }
            }
            Self::Blocks(field, pigments) => {
                let place = field.moved(point.position);
                let block = pigments.get(field.block_moved(place)).or(pigments.last());
                block.map_or_else(ColorFt::default, |pigment| {
                    pigment.color_moved(point, place)
                })
            }
            Self::Image(image, modifiers) => image
                .color(modifiers.moved(point.position))
                .unwrap_or(ColorFt::CLEAR),
            Self::Average(members, modifiers) => {
                let place = modifiers.moved(point.position);
                let (mut sum, mut total) = (ColorFt::default(), 0.0);
                for (weight, pigment) in members {
                    sum = sum + pigment.color_moved(point, place) * *weight;
                    total += weight;
                }
                if total == 0.0 {
                    sum
                } else {
                    sum * (1.0 / total)
                }
            }
            Self::UvMapped(pigment) => pigment.color_at(&point.at_coordinates()),
            Self::Quick(_, pigment) => pigment.color_at(point),
        }
    }

    /// Whether colours at several points take less time together.
    pub fn gains_together(&self) -> bool {
        match self {
            Self::Solid(..) | Self::Image(..) => false,
            Self::ColorMap(field, _) => field.pattern.gains_together(),
            Self::PigmentMap(field, map) => {
                field.pattern.gains_together()
                    || map.entries.iter().any(|(_, p)| p.gains_together())
            }
            Self::Blocks(_, pigments) => pigments.iter().any(Self::gains_together),
            Self::Average(members, _) => members.iter().any(|(_, p)| p.gains_together()),
            Self::UvMapped(pigment) | Self::Quick(_, pigment) => pigment.gains_together(),
        }
    }

    /// Whether its colours depend on the normal of the surface.
    pub fn sees_normals(&self) -> bool {
        match self {
            Self::Solid(..) | Self::Image(..) => false,
            Self::ColorMap(field, _) => field.pattern.sees_normals(),
            Self::PigmentMap(field, map) => {
                field.pattern.sees_normals() || map.entries.iter().any(|(_, p)| p.sees_normals())
            }
            Self::Blocks(field, pigments) => {
                field.pattern.sees_normals() || pigments.iter().any(Self::sees_normals)
            }
            Self::Average(members, _) => members.iter().any(|(_, p)| p.sees_normals()),
            Self::UvMapped(pigment) | Self::Quick(_, pigment) => pigment.sees_normals(),
        }
    }

    /// Stores the colours at several points, with the bits of [`Pigment::color_at`]. The slices have the same length.
    pub fn store_colors(&self, points: &[TexturePoint], colors: &mut [ColorFt]) {
        for (points, colors) in points.chunks(BATCH).zip(colors.chunks_mut(BATCH)) {
            self.store_batch::<BATCH>(&Batch::of(points), colors);
        }
    }

    /// Stores the colours at the places of a batch, as many as there are.
    pub(crate) fn store_batch<const N: usize>(&self, batch: &Batch<'_, N>, colors: &mut [ColorFt]) {
        match self {
            Self::Solid(color, _) => colors.fill(*color),
            Self::ColorMap(field, map) => {
                let mut values = [0.0; N];
                let values = &mut values[..batch.len()];
                field.store_moved(&batch.moved(|p| field.moved(p)), values);
                for (color, value) in colors.iter_mut().zip(values) {
                    *color = map.color(*value);
                }
            }
            Self::PigmentMap(field, map) => {
                let mut values = [0.0; N];
                let values = &mut values[..batch.len()];
                let moved = batch.moved(|p| field.moved(p));
                field.store_moved(&moved, values);
                Self::store_blends(map, values, &moved, colors);
            }
            Self::Blocks(field, pigments) => {
                let moved = batch.moved(|p| field.moved(p));
                let last = pigments.len().saturating_sub(1);
                let blocks = moved.places.iter().map(|p| field.block_moved(*p).min(last));
                let blocks: ArrayVec<usize, N> = blocks.collect();
                colors.fill(ColorFt::default());
                for (number, pigment) in pigments.iter().enumerate() {
                    pigment.store_part(&moved, |lane| blocks[*lane] == number, colors);
                }
            }
            Self::Image(..) => {
                let all = batch.points.iter().zip(&batch.places);
                for (color, (point, place)) in colors.iter_mut().zip(all) {
                    *color = self.color_at(&point.at(*place));
                }
            }
            Self::Average(members, modifiers) => {
                let moved = batch.moved(|p| modifiers.moved(p));
                let mut part = [ColorFt::default(); N];
                let part = &mut part[..batch.len()];
                let mut total = 0.0;
                colors.fill(ColorFt::default());
                for (weight, pigment) in members {
                    pigment.store_batch(&moved, part);
                    for (sum, color) in colors.iter_mut().zip(&*part) {
                        *sum = *sum + *color * *weight;
                    }
                    total += weight;
                }
                if total != 0.0 {
                    for sum in colors {
                        *sum = *sum * (1.0 / total);
                    }
                }
            }
            Self::UvMapped(pigment) => pigment.store_batch(&batch.on_surface(), colors),
            Self::Quick(_, pigment) => pigment.store_batch(batch, colors),
        }
    }

    /// Stores the colours that a map of pigments has for these values, at places that have been moved.
    fn store_blends<const N: usize>(
        map: &BlendMap<Self>,
        values: &[f64],
        moved: &Batch<'_, N>,
        colors: &mut [ColorFt],
    ) {
        let blends = values.iter().map(|value| map.lookup(*value));
        let blends: ArrayVec<Option<Blend<'_, Self>>, N> = blends.collect();
        let mut seconds = [ColorFt::default(); N];
        let seconds = &mut seconds[..moved.len()];
        colors.fill(ColorFt::default());
        for (_, pigment) in &map.entries {
            let is_first = |lane: &usize| match blends[*lane] {
                Some(Blend::One(first) | Blend::Two(first, ..)) => std::ptr::eq(first, pigment),
                None => false,
            };
            pigment.store_part(moved, is_first, colors);
            let is_second = |lane: &usize| matches!(blends[*lane], Some(Blend::Two(_, second, _)) if std::ptr::eq(second, pigment));
            pigment.store_part(moved, is_second, seconds);
        }
        for (lane, blend) in blends.iter().enumerate() {
            if let Some(Blend::Two(_, _, t)) = blend {
                colors[lane] = colors[lane].lerp(seconds[lane], *t);
            }
        }
    }

    /// Stores the colours at those places of a batch that `is_here` selects by their numbers.
    fn store_part<const N: usize>(
        &self,
        batch: &Batch<'_, N>,
        is_here: impl Fn(&usize) -> bool,
        colors: &mut [ColorFt],
    ) {
        let lanes: ArrayVec<usize, N> = (0..batch.len()).filter(is_here).collect();
        match &lanes[..] {
            [] => {}
            [lane] => colors[*lane] = self.color_moved(batch.points[*lane], batch.places[*lane]),
            all if all.len() == batch.len() => self.store_batch(batch, colors),
            some => {
                let mut found = [ColorFt::default(); N];
                self.store_batch(&batch.part(some), &mut found[..some.len()]);
                for (lane, color) in some.iter().zip(found) {
                    colors[*lane] = color;
                }
            }
        }
    }

    /// The colour at the point after it has moved to a place.
    fn color_moved(&self, point: &TexturePoint, place: DVec3) -> ColorFt {
        match self {
            Self::Solid(color, _) => *color,
            _ => self.color_at(&point.at(place)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Color;
    use crate::patterns::Pattern;

    fn gray(value: f64) -> ColorFt {
        Color::gray(value).into()
    }

    #[test]
    fn a_step_belongs_to_the_lower_side() {
        let map = BlendMap::new(vec![(0.3, 0.0), (0.5, 1.0), (0.5, 0.25), (0.7, 0.75)]);
        let at = |value: f64| match map.lookup(value) {
            None => f64::NAN,
            Some(Blend::One(v)) => *v,
            Some(Blend::Two(a, b, t)) => a * (1.0 - t) + b * t,
        };
        for (value, expected) in [
            (0.0, 0.0),
            (0.3, 0.0),
            (0.4, 0.5),
            (0.5, 1.0),
            (0.6, 0.5),
            (0.9, 0.75),
        ] {
            assert!(
                (at(value) - expected).abs() < 1e-12,
                "{value}: {}",
                at(value)
            );
        }
        assert!(at(0.5 + 1e-12) < 0.26);
        assert_eq!(at(f64::NAN), 0.0);
        assert!(BlendMap::<f64>::new(vec![]).lookup(0.5).is_none());
    }

    /// Red of POV-Ray 3.7.0.10 at <0.3, -0.7, 1.1>.
    #[test]
    fn members_are_evaluated_at_the_moved_point_as_measured() {
        let ramp = |pattern: Pattern| {
            Pigment::ColorMap(
                pattern.into(),
                BlendMap::new(vec![(0.0, gray(0.0)), (1.0, gray(1.0))]),
            )
        };
        let turbulent = Modifiers {
            turbulence: DVec3::splat(0.5),
            ..Modifiers::default()
        };
        let point = TexturePoint::in_space(DVec3::new(0.3, -0.7, 1.1));
        let blocks = Pigment::Blocks(
            Box::new(PatternField {
                pattern: Pattern::Checker,
                modifiers: turbulent.clone(),
            }),
            vec![ramp(Pattern::Bozo), ramp(Pattern::Granite)].into(),
        );
        let average = Pigment::Average(
            vec![(1.0, ramp(Pattern::Bozo)), (2.0, ramp(Pattern::Granite))].into(),
            Box::new(turbulent),
        );
        for (pigment, expected) in [(blocks, 0.42866036), (average, 0.43265471)] {
            let got = pigment.color_at(&point).rgb.r;
            assert!((got - expected).abs() < 1e-6, "{got} is not {expected}");
        }
    }
}
