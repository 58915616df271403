use crate::grammar::Thing;
use crate::keywords::Word;
use crate::parser::{PResult, Parser};
use crate::token::Token;
use strahl_math::DVec3;
use strahl_scene::Rainbow;
use strahl_shade::pigment::BlendMap;

/// The default of `arc_angle` and `falloff_angle`: POV-Ray uses 360 radians (as measured), so the whole ring is visible and
/// hardly fades even if only `falloff_angle` is set.
const WHOLE: f64 = 360.0 * 180.0 / std::f64::consts::PI;

/// `rainbow { ... }` as a statement; a scene may have several.
pub(super) fn rainbow_statement(p: &mut Parser<'_>) -> PResult<()> {
    let rainbow = p.rainbow()?;
    if rainbow.width > 0.0 && !rainbow.colors.entries.is_empty() {
        p.scene.rainbows.push(rainbow);
    }
    Ok(())
}

impl Parser<'_> {
    /// `{ ... }` or `{ Name ... }` after `rainbow`.
    pub(super) fn rainbow(&mut self) -> PResult<Rainbow> {
        let place = self.place();
        let mut rainbow = Rainbow {
            direction: DVec3::ZERO,
            up: DVec3::Y,
            angle: 0.0,
            width: 0.0,
            arc_angle: WHOLE,
            falloff_angle: WHOLE,
            distance: f64::INFINITY,
            colors: BlendMap::new(vec![]),
            jitter: 0.0,
            span: self.span_at(place),
        };
        self.braces(|p| {
            let named = p.accept_thing(|thing| match thing {
                Thing::Rainbow(rainbow) => Some(rainbow),
                _ => None,
            })?;
            if let Some(named) = named {
                rainbow = Rainbow::clone(&named);
                rainbow.span = p.span_at(place);
            }
            p.items("`rainbow`", |p, token| p.rainbow_item(&mut rainbow, token))
        })?;
        rainbow.direction = rainbow.direction.normalize_or_zero();
        let problem = if rainbow.direction == DVec3::ZERO {
            Some("a direction")
        } else if !(rainbow.width > 0.0) {
            Some("a positive `width`")
        } else if rainbow.colors.entries.is_empty() {
            Some("a `color_map`")
        } else {
            None
        };
        if let Some(missing) = problem {
            let message = format!("a rainbow without {missing} cannot be seen and is left out");
            self.warn(place, message);
            rainbow.width = 0.0;
        }
        Ok(rainbow)
    }

    fn rainbow_item(&mut self, rainbow: &mut Rainbow, token: Token) -> PResult<()> {
        let Some(word) = token.word() else {
            return self.skip_item(token, "`rainbow`");
        };
        match word {
            Word::Direction | Word::Up => {
                self.take(token)?;
                let vector = self.vector3()?;
                match word {
                    Word::Direction => rainbow.direction = vector,
                    _ => rainbow.up = vector,
                }
            }
            Word::ColorMap | Word::ColourMap => {
                self.take(token)?;
                rainbow.colors = self.color_map()?;
            }
            Word::Angle
            | Word::Width
            | Word::Distance
            | Word::Jitter
            | Word::ArcAngle
            | Word::FalloffAngle => {
                self.take(token)?;
                let value = self.float()?;
                match word {
                    Word::Angle => rainbow.angle = value,
                    Word::Width => rainbow.width = value,
                    // A distance of 0 or less counts as none.
                    Word::Distance if value > 0.0 => rainbow.distance = value,
                    Word::Distance => {}
                    Word::Jitter => rainbow.jitter = value,
                    Word::ArcAngle => rainbow.arc_angle = value,
                    _ => rainbow.falloff_angle = value,
                }
            }
            _ => return self.skip_item(token, "`rainbow`"),
        }
        Ok(())
    }
}
