//! Patterns and pigments as functions of expressions: the shading side of `strahl-function`'s [`ScalarField`].

use std::sync::Arc;

use arrayvec::ArrayVec;
use strahl_function::{Cost, ScalarField};
use strahl_math::DVec3;

use crate::ColorFt;
use crate::patterns::{BATCH, PatternField, TexturePoint};
use crate::pigment::Pigment;

/// The point given by the arguments of an expression; missing arguments are 0.
fn place(arguments: &[f64]) -> TexturePoint {
    let at = |i: usize| arguments.get(i).copied().unwrap_or(0.0);
    TexturePoint::in_space(DVec3::new(at(0), at(1), at(2)))
}

/// Stores values at places that are given axis by axis, at most [`BATCH`] of them at a time.
fn in_batches(
    arguments: &[&[f64]],
    values: &mut [f64],
    store: impl Fn(&[TexturePoint], &mut [f64]),
) {
    let mut points = ArrayVec::<TexturePoint, BATCH>::new();
    let mut done = 0;
    for values in values.chunks_mut(BATCH) {
        points.clear();
        for at in done..done + values.len() {
            let coordinate = |axis: usize| arguments.get(axis).and_then(|column| column.get(at));
            points.push(place(
                &[0, 1, 2].map(|axis| coordinate(axis).copied().unwrap_or(0.0)),
            ));
        }
        store(&points, values);
        done += values.len();
    }
}

/// `function { pattern { ... } }`.
impl ScalarField for PatternField {
    fn value(&self, arguments: &[f64]) -> f64 {
        PatternField::value(self, &place(arguments))
    }

    fn gains_together(&self) -> bool {
        self.pattern.gains_together()
    }

    fn store_values(&self, arguments: &[&[f64]], values: &mut [f64]) {
        in_batches(arguments, values, |points, values| {
            self.store_values_at(points, values);
        });
    }

    fn cost(&self) -> Cost {
        self.whole_cost()
    }
}

/// A component of a pigment's colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Channel {
    /// `.red`
    Red,
    /// `.green`
    Green,
    /// `.blue`
    Blue,
    /// `.filter`
    Filter,
    /// `.transmit`
    Transmit,
    /// `.gray` and `.grey`
    Gray,
    /// `.hf`: red and green as the two bytes of a height, as height fields read them.
    Height,
}

impl Channel {
    /// The component of a colour.
    fn of(self, color: &ColorFt) -> f64 {
        match self {
            Self::Red => color.rgb.r,
            Self::Green => color.rgb.g,
            Self::Blue => color.rgb.b,
            Self::Filter => color.filter,
            Self::Transmit => color.transmit,
            Self::Gray => color.gray(),
            Self::Height => (256.0 * color.rgb.r + color.rgb.g) / 257.0,
        }
    }
}

/// `function { pigment { ... } }` with the component read from it.
#[derive(Clone, Debug)]
pub struct PigmentChannel {
    /// The pigment.
    pub pigment: Arc<Pigment>,
    /// The component.
    pub channel: Channel,
}

impl ScalarField for PigmentChannel {
    fn value(&self, arguments: &[f64]) -> f64 {
        self.channel.of(&self.pigment.color_at(&place(arguments)))
    }

    fn gains_together(&self) -> bool {
        self.pigment.gains_together()
    }

    fn store_values(&self, arguments: &[&[f64]], values: &mut [f64]) {
        in_batches(arguments, values, |points, values| {
            let mut colors = [ColorFt::default(); BATCH];
            let colors = &mut colors[..points.len()];
            self.pigment.store_colors(points, colors);
            for (value, color) in values.iter_mut().zip(colors) {
                *value = self.channel.of(color);
            }
        });
    }

    fn cost(&self) -> Cost {
        self.pigment.cost()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Color;
    use crate::patterns::Pattern;
    use crate::pigment::BlendMap;

    #[test]
    fn a_pattern_and_a_pigment_are_functions() {
        let field = PatternField::from(Pattern::Gradient(DVec3::X));
        assert_eq!(ScalarField::value(&field, &[0.25, 7.0, 8.0]), 0.25);
        let map = BlendMap::new(vec![
            (0.0, ColorFt::default()),
            (1.0, Color::new(1.0, 0.5, 0.0).into()),
        ]);
        let channel = PigmentChannel {
            pigment: Arc::new(Pigment::ColorMap(Box::new(field), map)),
            channel: Channel::Green,
        };
        assert_eq!(channel.value(&[0.5, 0.0, 0.0]), 0.25);
    }

    #[test]
    fn values_together_are_those_of_single_points() {
        let bits = |values: &[f64]| values.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
        let granite = PatternField::from(Pattern::Granite);
        let map = BlendMap::new(vec![
            (0.0, ColorFt::default()),
            (1.0, Color::new(1.0, 0.5, 0.25).into()),
        ]);
        let pigment = Arc::new(Pigment::ColorMap(Box::new(granite.clone()), map));
        let channels = [
            Channel::Red,
            Channel::Green,
            Channel::Blue,
            Channel::Filter,
            Channel::Transmit,
            Channel::Gray,
            Channel::Height,
        ];
        let mut fields: Vec<Box<dyn ScalarField>> = vec![Box::new(granite)];
        fields.extend(channels.map(|channel| {
            let pigment = Arc::clone(&pigment);
            Box::new(PigmentChannel { pigment, channel }) as Box<dyn ScalarField>
        }));
        for count in [0, 1, 5, BATCH, 2 * BATCH + 3] {
            let column = |seed: f64| {
                (0..count)
                    .map(|n| seed + 0.37 * n as f64)
                    .collect::<Vec<_>>()
            };
            let [x, y, z] = [column(-3.1), column(0.4), column(7.7)];
            for field in &fields {
                let mut together = vec![0.0; count];
                field.store_values(&[&x, &y, &z], &mut together);
                let alone: Vec<f64> = (0..count)
                    .map(|n| field.value(&[x[n], y[n], z[n]]))
                    .collect();
                assert_eq!(bits(&together), bits(&alone));
                // Missing coordinates are 0.
                field.store_values(&[&x], &mut together);
                let alone: Vec<f64> = (0..count).map(|n| field.value(&[x[n]])).collect();
                assert_eq!(bits(&together), bits(&alone));
                assert!(field.gains_together());
            }
        }
    }
}
