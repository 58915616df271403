use crate::keywords::Word;
use crate::parser::{PResult, Parser};
use std::sync::Arc;
use strahl_math::Transform;
use strahl_scene::{Background, BackgroundAlpha, SkySphere};
use strahl_shade::Color;

/// `sky_sphere { pigment { ... } ... }` as a statement: the last one counts.
pub(super) fn sky_statement(p: &mut Parser<'_>) -> PResult<()> {
    let mut sky = p.sky_sphere()?;
    match &p.scene.background {
        Some(Background::Solid(color)) => sky.behind = *color,
        Some(Background::Sky(before)) => sky.behind = before.behind,
        // Nothing is behind the sky.
        _ => {
            p.scene.background_alpha = BackgroundAlpha::Clear;
        }
    }
    p.scene.background = Some(Background::Sky(Arc::new(sky)));
    Ok(())
}

impl Parser<'_> {
    /// `{ ... }` or `{ Name ... }` after `sky_sphere`.
    pub(super) fn sky_sphere(&mut self) -> PResult<SkySphere> {
        let mut sky = SkySphere {
            layers: vec![],
            transform: Transform::IDENTITY,
            emission: Color::WHITE,
            behind: Color::BLACK,
            // The last version in the scene counts.
            tints_layers: true,
        };
        self.braces(|p| {
            let named = p.accept_thing(|thing| match thing {
                super::Thing::SkySphere(sky) => Some(sky),
                _ => None,
            })?;
            if let Some(named) = named {
                sky = SkySphere::clone(&named);
            }
            p.items("`sky_sphere`", |p, token| {
                if let Some(t) = p.transformation(token)? {
                    sky.transform = sky.transform.then(&t);
                    return Ok(());
                }
                match token.word() {
                    Some(Word::Pigment) => {
                        p.take(token)?;
                        sky.layers.push(p.free_pigment_block()?);
                    }
                    Some(Word::Emission) => {
                        p.take(token)?;
                        let [r, g, b, ..] = p.color()?;
                        sky.emission = Color::new(r, g, b);
                    }
                    _ => return p.skip_item(token, "`sky_sphere`"),
                }
                Ok(())
            })
        })?;
        Ok(sky)
    }
}
