use strahl_math::{DVec3, Transform};
use strahl_shade::patterns::TexturePoint;
use strahl_shade::pigment::Pigment;
use strahl_shade::{Color, ColorFt, Quality};

/// A sky made of pigments: the radiance along rays that hit nothing, infinitely far away.
#[derive(Clone, Debug)]
pub struct SkySphere {
    /// The layers, the lowest first; a layer shows through where those above it are transparent.
    pub layers: Vec<Pigment>,
    /// From the space of the pigments to the world.
    pub transform: Transform,
    /// Factor of the pigments' colours.
    pub emission: Color,
    /// The colour behind the lowest layer.
    pub behind: Color,
    /// Whether filtering layers tint the layers below them, as in scenes of POV-Ray 3.7. In older ones only `behind` is tinted.
    pub tints_layers: bool,
}

impl SkySphere {
    /// The colour seen along a direction of any length: that of the pigments at the end of the unit vector.
    ///
    /// As measured: in version 3.7 a layer multiplies everything below it by `rgb · filter + transmit`. Before, a layer is
    /// multiplied by the product of `filter` of all layers above it plus that of `transmit`, without a tint, while `behind` is
    /// multiplied by the product of all `rgb · filter` plus that of all `transmit`.
    pub fn along(&self, direction: DVec3) -> Color {
        self.seen(direction).0
    }

    /// What all layers let pass along a direction, layers tinting those below.
    pub fn passes(&self, direction: DVec3) -> Color {
        self.seen(direction).1
    }

    /// The colour [seen along](Self::along) a direction of any length, and what the layers [let pass](Self::passes).
    pub fn seen(&self, direction: DVec3) -> (Color, Color) {
        let at = self
            .transform
            .point_to_object(direction.normalize_or(DVec3::Y));
        let point = TexturePoint::in_space(at);
        let (mut seen, mut passes) = (Color::BLACK, Color::WHITE);
        let (mut filter, mut tint, mut clear) = (1.0, Color::WHITE, 1.0);
        for (above, layer) in self.layers.iter().rev().enumerate() {
            let color: ColorFt = layer.color_at(&point);
            let light = color.rgb * self.emission;
            seen += match self.tints_layers {
                true => light * passes * color.opacity(),
                false if above == 0 => light * color.opacity(),
                false => light * (color.opacity() * (filter + clear)),
            };
            passes *= color.rgb * color.filter + Color::gray(color.transmit);
            filter *= color.filter;
            tint *= color.rgb * color.filter;
            clear *= color.transmit;
        }
        let behind = match self.tints_layers {
            true => passes,
            false => tint + Color::gray(clear),
        };
        (seen + self.behind * behind, passes)
    }
}

impl SkySphere {
    /// The sky as pictures of this quality show it, if it is another one.
    pub fn of_quality(&self, quality: Quality) -> Option<Self> {
        let layers: Vec<_> = self.layers.iter().map(|p| p.of_quality(quality)).collect();
        if layers.iter().all(Option::is_none) {
            return None;
        }
        let mut sky = self.clone();
        for (layer, other) in sky.layers.iter_mut().zip(layers) {
            if let Some(other) = other {
                *layer = other;
            }
        }
        Some(sky)
    }

    /// The colour seen along all directions, if no layer has a pattern.
    pub fn same_everywhere(&self) -> Option<Color> {
        let plain = |layer: &Pigment| matches!(layer, Pigment::Solid(..));
        self.layers.iter().all(plain).then(|| self.along(DVec3::Y))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn upper_layers_cover_lower_ones() {
        let mut sky = SkySphere {
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
            tints_layers: true,
        };
        let seen = Color::new(0.25, 0.75, 0.0);
        assert_eq!(sky.along(DVec3::Z * 7.0), seen);
        assert_eq!(sky.same_everywhere(), Some(seen));
        let other = Pigment::UvMapped(Box::default());
        sky.layers.push(other);
        assert_eq!(sky.same_everywhere(), None);
    }

    #[test]
    fn layers_tint_what_is_behind_all_only() {
        let layer = |rgb: [f64; 3], filter, transmit| {
            ColorFt {
                rgb: Color::from(rgb),
                filter,
                transmit,
            }
            .into()
        };
        let sky = SkySphere {
            layers: vec![
                layer([0.5, 0.3, 0.2], 0.4, 0.2),
                layer([0.8, 0.6, 0.4], 0.5, 0.1),
            ],
            transform: Transform::IDENTITY,
            emission: Color::WHITE,
            behind: Color::new(0.2, 0.6, 0.8),
            tints_layers: false,
        };
        // As POV-Ray renders it.
        let seen = sky.along(DVec3::X).to_array();
        for (seen, expected) in seen.into_iter().zip([0.46, 0.3456, 0.2368]) {
            assert!((seen - expected).abs() < 1e-9, "{seen}");
        }
    }

    #[test]
    fn layers_are_as_bright_as_what_all_above_them_filter_and_transmit() {
        let layer = |[red, green, blue, filter, transmit]: [f64; 5]| {
            ColorFt {
                rgb: Color::new(red, green, blue),
                filter,
                transmit,
            }
            .into()
        };
        let upper = [
            layer([0.2, 0.4, 0.6, 0.3, 0.5]),
            layer([1.0, 0.5, 0.5, 0.6, 0.3]),
            layer([0.6, 0.9, 0.5, 0.2, 0.5]),
        ];
        let opaque = layer([0.5, 1.0, 0.2, 0.0, 0.0]);
        // As POV-Ray renders them, in steps of 1/255.
        for (layers, behind, expected) in [
            (upper.to_vec(), [0.9, 0.8, 0.3], [156.0, 168.0, 135.0]),
            (
                [&[opaque], &upper[..]].concat(),
                [0.9, 0.8, 0.3],
                [153.0, 177.0, 134.0],
            ),
        ] {
            let sky = SkySphere {
                layers,
                transform: Transform::IDENTITY,
                emission: Color::WHITE,
                behind: Color::from(behind),
                tints_layers: false,
            };
            for (seen, expected) in sky.along(DVec3::X).to_array().into_iter().zip(expected) {
                let code = 255.0 * (1.055 * seen.powf(1.0 / 2.4) - 0.055);
                assert!((code - expected).abs() < 1.0, "{code} {expected}");
            }
        }
    }

    /// As POV-Ray 3.7 renders it, in steps of 1/255.
    #[test]
    fn filtering_layers_tint_those_below_under_version_3_7() {
        let layer = |rgb: [f64; 3], filter, transmit| {
            ColorFt {
                rgb: Color::from(rgb),
                filter,
                transmit,
            }
            .into()
        };
        let sky = |layers| SkySphere {
            layers,
            transform: Transform::IDENTITY,
            emission: Color::WHITE,
            behind: Color::new(0.9, 0.7, 0.4),
            tints_layers: true,
        };
        let cases = [
            (
                vec![
                    layer([0.9, 0.7, 0.4], 0.0, 0.0),
                    layer([0.2, 0.5, 0.8], 0.6, 0.0),
                ],
                [0.188, 0.412, 0.514],
            ),
            (
                vec![
                    layer([0.9, 0.7, 0.4], 0.5, 0.2),
                    layer([0.2, 0.5, 0.8], 0.3, 0.4),
                ],
                [0.455, 0.478, 0.42],
            ),
        ];
        for (layers, expected) in cases {
            let seen = sky(layers).along(DVec3::X).to_array();
            for (seen, expected) in seen.into_iter().zip(expected) {
                assert!((seen - expected).abs() < 0.005, "{seen} is not {expected}");
            }
        }
    }
}
