use strahl_math::{DVec3, Transform};
use strahl_shade::patterns::TexturePoint;
use strahl_shade::pigment::Pigment;
use strahl_shade::{Color, ColorFt};

/// A sky painted by pigments: what rays see that hit nothing, infinitely far away.
#[derive(Clone, Debug)]
pub struct SkySphere {
    /// The layers, the lowest first; where one lets light pass, those below it show.
    pub layers: Vec<Pigment>,
    /// From the space of the pigments to the world.
    pub transform: Transform,
    /// Factor of the pigments' colours.
    pub emission: Color,
    /// What shows through the lowest layer.
    pub behind: Color,
}

impl SkySphere {
    /// The colour seen along a direction of any length: that of the pigments at the end of the unit vector.
    pub fn along(&self, direction: DVec3) -> Color {
        let at = self
            .transform
            .point_to_object(direction.normalize_or(DVec3::Y));
        let point = TexturePoint::in_space(at);
        self.layers.iter().fold(self.behind, |below, layer| {
            let color: ColorFt = layer.color_at(&point);
            color.rgb * self.emission * color.opacity() + below * color.attenuation()
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn upper_layers_cover_lower_ones() {
        let sky = SkySphere {
            layers: vec![
                ColorFt::opaque(Color::new(1.0, 0.0, 0.0)).into(),
                ColorFt {
                    rgb: Color::new(0.0, 1.0, 0.0),
                    filter: 0.0,
                    transmit: 0.25,
                }
                .into(),
            ],
            transform: Transform::IDENTITY,
            emission: Color::WHITE,
            behind: Color::WHITE,
        };
        assert_eq!(sky.along(DVec3::Z * 7.0), Color::new(0.25, 0.75, 0.0));
    }
}
