//! Colours measured with POV-Ray 3.7.0.10: the point <0.3, 0.2, 0> of a disc facing -z, before a sky of <0.3, 0.6, 0.9>,
//! lit with strength 0.7 from far away in direction <1, 2, -1.5>.

use super::*;
use crate::normal::NormalKind;
use crate::patterns::{Pattern, Warp};
use crate::pov_finish::PovReflection;

fn plain(color: ColorFt, finish: PovFinish) -> PlainTexture {
    PlainTexture {
        pigment: color.into(),
        finish: finish.into(),
        ..PlainTexture::default()
    }
}

fn dull() -> PovFinish {
    PovFinish {
        ambient: Color::BLACK,
        diffuse: 0.0,
        ..PovFinish::default()
    }
}

fn bluish() -> Texture {
    let finish = PovFinish {
        diffuse: 0.6,
        specular: 0.3,
        roughness: 0.2,
        ..dull()
    };
    plain(Color::new(0.2, 0.4, 0.9).into(), finish).into()
}

fn veil() -> Texture {
    let color = ColorFt {
        rgb: Color::new(0.8, 0.5, 0.3),
        filter: 0.2,
        transmit: 0.3,
    };
    let finish = PovFinish {
        diffuse: 0.4,
        emission: Color::gray(0.1),
        reflection: PovReflection::constant(Color::gray(0.25)),
        ..dull()
    };
    plain(color, finish).into()
}

fn glass() -> Texture {
    let color = ColorFt {
        rgb: Color::new(0.8, 0.5, 0.3),
        filter: 0.0,
        transmit: 0.6,
    };
    let finish = PovFinish {
        emission: Color::gray(0.2),
        reflection: PovReflection::constant(Color::gray(0.3)),
        conserve_energy: true,
        ..dull()
    };
    plain(color, finish).into()
}

fn bumpy() -> Texture {
    let finish = PovFinish {
        diffuse: 0.5,
        phong: 0.4,
        phong_size: 3.0,
        ..dull()
    };
    let bumps = PovNormal {
        amount: 0.3,
        ..PovNormal::new(NormalKind::Bumps)
    };
    Texture::from(PlainTexture {
        normal: Some(Box::new(bumps)),
        ..plain(Color::new(1.0, 0.5, 0.25).into(), finish)
    })
}

fn scale(x: f64, y: f64, z: f64) -> Transform {
    Transform::try_scale(DVec3::new(x, y, z)).expect("regular")
}

fn scaled(pattern: Pattern, transform: Transform) -> Box<PatternField> {
    Box::new(PatternField {
        pattern,
        modifiers: Modifiers {
            warps: vec![Warp::Transform(transform)],
            ..Modifiers::default()
        },
    })
}

/// The formula of [`LayerPoint`]'s documentation.
fn shade(texture: &Texture) -> Color {
    let sky = Color::new(0.3, 0.6, 0.9);
    let light = 0.7;
    let to_light = DVec3::new(1.0, 2.0, -1.5).normalize();
    let point = TexturePoint {
        n_geom: DVec3::NEG_Z,
        n_shade: DVec3::NEG_Z,
        direction: DVec3::Z,
        ..TexturePoint::in_space(DVec3::new(0.3, 0.2, 0.0))
    };
    let mut paint = TexturePaint::default();
    texture.layers_at(&point, 1.0, &mut paint);
    let mut sum = paint.transmission * sky;
    for layer in &paint.layers {
        let (finish, color) = (layer.finish, layer.color);
        let diffuse = finish.diffuse_factor(layer.normal.dot(to_light)) * light;
        let body =
            color.rgb * color.opacity() * (finish.ambient + finish.emission + Color::gray(diffuse));
        let highlight = finish.highlight(layer.normal, to_light, -point.direction, color.rgb);
        sum += (body + highlight * light) * layer.above * layer.share;
        sum += finish.reflection.reflected(layer.reflectance, sky) * layer.share;
    }
    sum
}

#[test]
fn shades_as_measured() {
    let gradient = || Pattern::Gradient(DVec3::X);
    let cases = [
        ("plain", bluish(), [0.159106, 0.205905, 0.322896]),
        (
            "layered",
            Texture::Layered(vec![bluish(), veil()].into()),
            [0.250584, 0.296361, 0.379644],
        ),
        (
            "map",
            Texture::Map(
                gradient().into(),
                BlendMap::new(vec![(0.0, bluish()), (1.0, veil())]),
            ),
            [0.205997, 0.280323, 0.402243],
        ),
        ("glass", glass(), [0.280003, 0.472007, 0.672007]),
        (
            "average",
            Texture::Average(vec![(1.0, bluish()), (3.0, glass())].into(), Box::default()),
            [0.249775, 0.405478, 0.584726],
        ),
        (
            "bumps, scaled",
            Texture::Transformed(Box::new(scale(2.0, 3.0, 1.0)), Box::new(bumpy())),
            [0.241108, 0.143999, 0.095445],
        ),
        (
            "checker",
            Texture::Blocks(
                scaled(Pattern::Checker, scale(0.25, 0.25, 0.25)),
                vec![bluish(), bumpy()].into(),
            ),
            [0.21088, 0.120455, 0.075242],
        ),
        (
            "map, scaled",
            Texture::Map(
                scaled(gradient(), scale(2.0, 3.0, 1.0)),
                BlendMap::new(vec![(0.0, bumpy()), (1.0, bluish())]),
            ),
            [0.228809, 0.153292, 0.129564],
        ),
    ];
    for (name, texture, expected) in cases {
        let got = shade(&texture).to_array();
        for (g, e) in got.iter().zip(expected) {
            assert!((g - e).abs() < 3e-5, "{name}: {got:?} is not {expected:?}");
        }
    }
}

#[test]
fn what_is_below_an_opaque_layer_does_not_reflect() {
    let mirror = PovFinish {
        reflection: PovReflection {
            min: Color::WHITE,
            max: Color::WHITE,
            ..PovReflection::default()
        },
        ..dull()
    };
    let below: Texture = plain(Color::WHITE.into(), mirror).into();
    let above = |transmit| -> Texture {
        let color = ColorFt {
            rgb: Color::BLACK,
            filter: 0.0,
            transmit,
        };
        plain(color, dull()).into()
    };
    let seen = |transmit| {
        shade(&Texture::Layered(
            vec![below.clone(), above(transmit)].into(),
        ))
    };
    assert_eq!(seen(0.0), Color::BLACK);
    assert!(seen(0.5).r > 0.0);
}

#[test]
fn shares_sum_to_one() {
    let point = TexturePoint::in_space(DVec3::new(0.3, 0.2, 0.0));
    let mut paint = TexturePaint::default();
    let texture = Texture::Average(
        vec![(1.0, bluish()), (2.0, veil()), (5.0, glass())].into(),
        Box::default(),
    );
    texture.layers_at(&point, 1.5, &mut paint);
    let shares: f64 = paint.layers.iter().map(|layer| layer.share).sum();
    assert!((shares - 1.0).abs() < 1e-15);
    assert!(paint.transmission.max_component() < 1.0);
}

#[test]
fn shadows_are_attenuated_as_measured() {
    let point = TexturePoint::in_space(DVec3::ZERO);
    let layer = |rgb, filter, transmit| -> Texture {
        plain(
            ColorFt {
                rgb,
                filter,
                transmit,
            },
            PovFinish::default(),
        )
        .into()
    };
    let lower = layer(Color::BLACK, 0.0, 0.6);
    let upper = layer(Color::new(0.2, 0.5, 0.9), 0.5, 0.0);
    let got = Texture::Layered(vec![lower, upper].into()).shadow_attenuation(&point);
    for (g, e) in got.to_array().iter().zip([0.06, 0.15, 0.27]) {
        assert!((g - e).abs() < 1e-12, "{got:?}");
    }
    // Reflection does not darken the light in a shadow, even with `conserve_energy`.
    assert_eq!(glass().shadow_attenuation(&point), Color::gray(0.6));
}

/// The short way for textures of one colour, at a point seen at an angle, in a space of its own or not.
#[test]
fn a_solid_layer_is_that_of_any_point() {
    let mirror = PovFinish {
        reflection: PovReflection {
            max: Color::gray(0.8),
            fresnel: true,
            ..PovReflection::constant(Color::gray(0.1))
        },
        conserve_energy: true,
        refraction: 0.7,
        ..PovFinish::default()
    };
    let clear = ColorFt {
        filter: 0.6,
        ..Color::new(0.9, 0.3, 0.2).into()
    };
    let (normal, direction) = (DVec3::new(0.6, 0.8, 0.0), DVec3::new(-0.8, 0.0, 0.6));
    let point = TexturePoint {
        n_geom: normal,
        n_shade: normal,
        direction,
        ..TexturePoint::in_space(DVec3::new(0.3, 0.2, 0.1))
    };
    let turned = Transform::rotate(DVec3::X, 0.5);
    for (texture, same) in [
        (bluish(), true),
        (veil(), true),
        (plain(clear, mirror).into(), false),
    ] {
        assert_eq!(texture.is_same_everywhere(), same);
        for space in [None, Some(&turned)] {
            let (mut long, mut short) = (TexturePaint::default(), TexturePaint::default());
            texture.layers_in(space, &point, 1.5, &mut long);
            assert!(texture.solid_layer(point.surface, normal, direction, 1.5, &mut short));
            assert_eq!(long.layers, short.layers);
            assert_eq!(long.stacks, short.stacks);
            assert_eq!(long.transmission, short.transmission);
        }
    }
    let layered = Texture::Layered(vec![bluish(), veil()].into());
    let mut paint = TexturePaint::default();
    assert!(!layered.solid_layer(point.surface, normal, direction, 1.0, &mut paint));
}
