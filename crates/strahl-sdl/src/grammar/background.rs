use crate::parser::{PResult, Parser};
use std::sync::Arc;
use strahl_scene::{Background, SkySphere};
use strahl_shade::Color;

/// `background { colour }`; a sky sphere replaces it.
pub(super) fn background(p: &mut Parser<'_>) -> PResult<()> {
    let [r, g, b, _, transmit] = p.braces(Parser::color)?;
    let color = Color::new(r, g, b);
    // Only for the alpha channel; before version 3.7 every background was transparent there.
    p.scene.background_transmit = match p.version < 3.7 {
        true => 1.0,
        false => transmit.clamp(0.0, 1.0),
    };
    p.scene.background = Some(match p.scene.background.take() {
        Some(Background::Sky(sky)) => Background::Sky(Arc::new(SkySphere {
            behind: color,
            ..SkySphere::clone(&sky)
        })),
        _ => Background::Solid(color),
    });
    Ok(())
}
