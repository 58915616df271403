use super::*;
use crate::normal::{NormalKind, PovNormal};
use crate::pigment::BlendMap;
use crate::texture::PlainTexture;
use crate::{Color, ColorFt};

fn gray(value: f64) -> ColorFt {
    Color::gray(value).into()
}

fn quick(value: f64, full: f64) -> Pigment {
    Pigment::Quick(gray(value), Box::new(gray(full).into()))
}

fn color(pigment: &Pigment) -> f64 {
    let point = crate::patterns::TexturePoint::in_space(strahl_math::DVec3::ZERO);
    pigment.color_at(&point).rgb.r
}

#[test]
fn levels_are_numbers_up_to_eleven() {
    for (text, level) in [("0", 0), ("4", 4), ("9", 9), ("10", 9), ("11", 9)] {
        assert_eq!(text.parse(), Ok(Quality::new(level)));
    }
    for text in ["12", "-1", "", "x", "4.5"] {
        let error = text.parse::<Quality>().unwrap_err().to_string();
        assert_eq!(
            error,
            format!("expected a quality from 0 to 11, found `{text}`")
        );
    }
    assert!(Quality::default().is_full() && Quality::new(200).is_full());
    assert_eq!(Quality::new(3).to_string(), "3");
}

#[test]
fn quick_colors_are_shown_up_to_level_five() {
    let pattern = Pattern::Pigment(Arc::new(quick(0.25, 0.75)));
    let steps = BlendMap::new(vec![(0.0, gray(0.0)), (1.0, gray(1.0))]);
    let pigments = [
        quick(0.25, 0.75),
        Pigment::UvMapped(Box::new(quick(0.25, 0.75))),
        Pigment::Average(vec![(1.0, quick(0.25, 0.75))].into(), Box::default()),
        Pigment::Blocks(Pattern::Checker.into(), vec![quick(0.25, 0.75)].into()),
        Pigment::PigmentMap(
            Pattern::Bozo.into(),
            BlendMap::new(vec![(0.0, quick(0.25, 0.75))]),
        ),
        Pigment::ColorMap(pattern.into(), steps),
    ];
    for pigment in &pigments {
        assert!((color(pigment) - 0.75).abs() < 1e-12);
        for level in 0..=9 {
            let seen = pigment.of_quality(Quality::new(level)).unwrap();
            let expected = if level < 6 { 0.25 } else { 0.75 };
            assert!((color(&seen) - expected).abs() < 1e-12);
            assert!(seen.of_quality(Quality::new(0)).is_none());
        }
    }
    assert!(Pigment::default().of_quality(Quality::new(0)).is_none());
}

#[test]
fn normals_are_shown_from_level_eight() {
    let bumpy = || {
        Texture::from(PlainTexture {
            normal: Some(Box::new(PovNormal::new(NormalKind::Bumps))),
            ..PlainTexture::default()
        })
    };
    let textures = [
        bumpy(),
        Texture::Layered(vec![Texture::default(), bumpy()].into()),
        Texture::UvMapped(Box::new(bumpy())),
        Texture::Average(vec![(1.0, bumpy())].into(), Box::default()),
        Texture::Blocks(Pattern::Checker.into(), vec![bumpy()].into()),
        Texture::Map(Pattern::Bozo.into(), BlendMap::new(vec![(0.0, bumpy())])),
    ];
    for texture in textures {
        assert!(texture.of_quality(Quality::new(8)).is_none());
        let flat = texture.of_quality(Quality::new(7)).unwrap();
        assert!(flat.of_quality(Quality::new(0)).is_none());
    }
}
