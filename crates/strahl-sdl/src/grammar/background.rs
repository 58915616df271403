use crate::parser::{PResult, Parser};
use strahl_scene::Background;
use strahl_shade::Color;

/// `background { colour }`
pub(super) fn background(p: &mut Parser<'_>) -> PResult<()> {
    let [r, g, b, ..] = p.braces(Parser::color)?;
    p.scene.background = Some(Background::Solid(Color::new(r, g, b)));
    Ok(())
}
