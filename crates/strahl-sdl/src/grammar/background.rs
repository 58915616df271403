use crate::parser::{PResult, Parser};
use std::sync::Arc;
use strahl_scene::{Background, SkySphere};
use strahl_shade::Color;

/// `background { colour }`; a sky sphere covers it.
pub(super) fn background(p: &mut Parser<'_>) -> PResult<()> {
    let [r, g, b, ..] = p.braces(Parser::color)?;
    let color = Color::new(r, g, b);
    p.scene.background = Some(match p.scene.background.take() {
        Some(Background::Sky(sky)) => Background::Sky(Arc::new(SkySphere {
            behind: color,
            ..SkySphere::clone(&sky)
        })),
        _ => Background::Solid(color),
    });
    Ok(())
}
