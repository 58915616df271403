//! `interior { ... }`

use crate::grammar::Thing;
use crate::keywords::Word;
use crate::parser::{PResult, Parser};
use strahl_shade::interior::Interior;

impl Parser<'_> {
    /// `{ ... }` after `interior`. It changes `base`, the object's interior so far, unless it begins with a name.
    pub(crate) fn interior_block(&mut self, base: Option<&Interior>) -> PResult<Interior> {
        self.braces(|p| {
            let named = p.accept_thing(|thing| match thing {
                Thing::Interior(interior) => Some(interior),
                _ => None,
            })?;
            let mut interior = named.as_deref().or(base).copied().unwrap_or_default();
            let mut refracts = interior.ior != Interior::default().ior;
            let mut dispersion = None;
            p.items("`interior`", |p, token| {
                match token.word() {
                    Some(Word::Ior) => {
                        p.take(token)?;
                        interior.ior = p.positive("the index of refraction")?;
                        refracts = true;
                    }
                    Some(Word::FadeDistance) => {
                        p.take(token)?;
                        interior.fade_distance = p.float()?;
                    }
                    Some(Word::FadePower) => {
                        p.take(token)?;
                        interior.fade_power = p.float()?;
                    }
                    Some(Word::FadeColor | Word::FadeColour) => {
                        p.take(token)?;
                        interior.fade_color = p.plain_color()?;
                    }
                    Some(Word::Dispersion) => {
                        p.take(token)?;
                        interior.dispersion = p.positive("dispersion")?;
                        dispersion = Some(p.place_of(token));
                    }
                    Some(Word::Caustics) => {
                        p.take(token)?;
                        interior.caustics = p.float()?;
                    }
                    Some(Word::DispersionSamples) => {
                        /// More samples make no visible difference.
                        const MOST: f64 = 512.0;
                        p.take(token)?;
                        let place = p.place_of(token);
                        let count = p.float()?;
                        if !(2.0..=MOST).contains(&count) {
                            let message = format!("expected 2 to {MOST} samples, found {count}");
                            return Err(p.fail(place, message));
                        }
                        interior.dispersion_samples = count as u16;
                    }
                    Some(Word::Refraction) => {
                        // As measured, with any value and in all versions.
                        p.take(token)?;
                        let place = p.place_of(token);
                        p.float()?;
                        p.warn_hint(
                            place,
                            "`refraction` has no effect in an interior",
                            "`ior` alone refracts; to weaken light in the object, use `fade_distance` and `fade_power`",
                        );
                    }
                    _ => return p.skip_item(token, "`interior`"),
                }
                Ok(())
            })?;
            if let Some(place) = dispersion.filter(|_| !refracts) {
                // As measured.
                interior.dispersion = Interior::default().dispersion;
                p.warn_hint(
                    place,
                    "`dispersion` has no effect in an interior without `ior`",
                    "state the index of refraction, such as `ior 1.5`",
                );
            }
            Ok(interior)
        })
    }

    pub(super) fn positive(&mut self, what: &str) -> PResult<f64> {
        let token = self.peek()?;
        let place = self.place_of(token);
        let x = self.float()?;
        if x > 0.0 {
            return Ok(x);
        }
        Err(self.fail(place, format!("{what} must be positive, not {x}")))
    }
}
