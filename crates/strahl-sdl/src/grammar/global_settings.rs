use crate::keywords::Word;
use crate::parser::{PResult, Parser};
use strahl_shade::Color;

/// `global_settings { ... }`
pub(super) fn global_settings(p: &mut Parser<'_>) -> PResult<()> {
    p.braces(|p| {
        p.items("`global_settings`", |p, token| {
            match token.word() {
                Some(Word::AmbientLight) => {
                    p.take(token)?;
                    let [r, g, b, ..] = p.color()?;
                    p.scene.ambient = Some(Color::new(r, g, b));
                }
                Some(Word::MaxTraceLevel) => {
                    p.take(token)?;
                    let level = p.float()?;
                    let place = p.place();
                    if !(1.0..=256.0).contains(&level) {
                        return Err(p.fail(
                            place,
                            format!("max_trace_level must be 1 to 256, not {level}"),
                        ));
                    }
                    p.scene.settings.max_depth = level as u32;
                }
                Some(Word::AdcBailout) => {
                    p.take(token)?;
                    p.scene.settings.adc_bailout = p.float()?;
                }
                // Pictures are computed in linear light and written as sRGB, which is what 1.0 asks for.
                Some(Word::AssumedGamma) => {
                    p.take(token)?;
                    let place = p.place();
                    if !p.accept_word(Word::Srgb)? {
                        let gamma = p.float()?;
                        if gamma != 1.0 {
                            p.warn(
                                place,
                                format!(
                                    "assumed_gamma {gamma} is not supported yet and counts as 1.0"
                                ),
                            );
                        }
                    }
                }
                _ => return p.skip_item(token, "`global_settings`"),
            }
            Ok(())
        })
    })
}
