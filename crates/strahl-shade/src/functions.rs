//! Patterns and pigments as functions of expressions: the shading side of `strahl-function`'s [`ScalarField`].

use std::sync::Arc;

use strahl_function::{Cost, ScalarField};
use strahl_math::DVec3;

use crate::patterns::{PatternField, TexturePoint};
use crate::pigment::Pigment;

/// The point given by the arguments of an expression; missing arguments are 0.
fn place(arguments: &[f64]) -> TexturePoint {
    let at = |i: usize| arguments.get(i).copied().unwrap_or(0.0);
    TexturePoint::in_space(DVec3::new(at(0), at(1), at(2)))
}

/// `function { pattern { ... } }`.
impl ScalarField for PatternField {
    fn value(&self, arguments: &[f64]) -> f64 {
        PatternField::value(self, &place(arguments))
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
        let color = self.pigment.color_at(&place(arguments));
        match self.channel {
            Channel::Red => color.rgb.r,
            Channel::Green => color.rgb.g,
            Channel::Blue => color.rgb.b,
            Channel::Filter => color.filter,
            Channel::Transmit => color.transmit,
            Channel::Gray => color.gray(),
        }
    }

    fn cost(&self) -> Cost {
        self.pigment.cost()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::patterns::Pattern;
    use crate::pigment::BlendMap;
    use crate::{Color, ColorFt};

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
}
