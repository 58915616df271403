use crate::parser::{PResult, Parser};
use std::sync::Arc;
use strahl_scene::{Background, BackgroundAlpha, SkySphere};
use strahl_shade::Color;

/// `background { colour }`; a sky sphere replaces it.
pub(super) fn background(p: &mut Parser<'_>) -> PResult<()> {
    let [r, g, b, filter, transmit] = p.braces(Parser::color)?;
    let color = Color::new(r, g, b);
    // Old backgrounds are see-through, even if the scene ends as a newer one (measured).
    p.scene.background_alpha = match p.before_3_7() {
        true => BackgroundAlpha::Clear,
        false => BackgroundAlpha::Seen { filter, transmit },
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
