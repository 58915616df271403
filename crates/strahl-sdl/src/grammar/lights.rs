use crate::keywords::Word;
use crate::parser::{PResult, Parser};
use strahl_scene::SceneLight;
use strahl_shade::{Color, Light};

/// `light_source { ... }` as a statement.
pub(super) fn light_statement(p: &mut Parser<'_>) -> PResult<()> {
    let light = p.light()?;
    p.scene.lights.push(light);
    Ok(())
}

impl Parser<'_> {
    /// `{ position colour ... }` behind `light_source`.
    pub(super) fn light(&mut self) -> PResult<SceneLight> {
        let span = self.span_at(self.place());
        let mut casts_shadows = true;
        let (mut position, mut color) = (strahl_math::DVec3::ZERO, [1.0; 5]);
        self.braces(|p| {
            position = p.vector3()?;
            p.comma()?;
            p.items("`light_source`", |p, token| {
                if let Some(transform) = p.transformation(token)? {
                    position = transform.point_to_world(position);
                } else if token.is(Word::Shadowless) {
                    p.take(token)?;
                    casts_shadows = false;
                } else if token
                    .word()
                    .is_none_or(|w| w.kind() == crate::keywords::WordKind::Color)
                {
                    color = p.color()?;
                } else {
                    return p.skip_item(token, "`light_source`");
                }
                Ok(())
            })
        })?;
        let [r, g, b, ..] = color;
        let light = Light {
            casts_shadows,
            ..Light::point(position, Color::new(r, g, b))
        };
        Ok(SceneLight {
            light,
            name: None,
            span,
        })
    }
}
