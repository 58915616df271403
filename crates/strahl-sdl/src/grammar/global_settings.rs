use super::foreseen::Foreseen;
use crate::keywords::Word;
use crate::parser::{PResult, Parser, Place};
use crate::token::Token;
use std::sync::Arc;
use strahl_math::noise::NoiseGenerator;
use strahl_scene::{Background, BackgroundAlpha, WorkingSpace};
use strahl_shade::Color;
use strahl_shade::patterns::Pattern;
use strahl_shade::pov_finish::IridSettings;

/// The default of `max_trace_level`.
const TRACE_LEVEL: u32 = 5;

/// The largest `max_trace_level`.
const DEEPEST: u32 = 256;

/// The version from which on the default noise of patterns is not clamped (`noise_generator 2`); measured with POV-Ray 3.7.
const RANGE_CORRECTED_SINCE: f64 = 3.5;

/// The version of scenes that name none.
pub(crate) const UNVERSIONED: f64 = 3.7;

/// The settings of `global_settings` so far; for the rest, the language's defaults apply, which depend on its version.
#[derive(Debug, Default)]
pub struct GlobalSettings {
    /// Whether the scene has a `#version`; scenes without one are old.
    pub versioned: bool,
    /// The last `#version` in the scene's own file: versions of included files don't change the noise of its patterns.
    pub scene_version: Option<f64>,
    /// `assumed_gamma`
    pub working_space: Option<WorkingSpace>,
    /// `max_trace_level`
    pub trace_level: Option<u32>,
    /// `ambient_light`
    pub ambient: Option<Color>,
    /// What is set for all of the scene, as far as its text tells beforehand.
    pub(crate) foreseen: Foreseen,
    /// `noise_generator`: 1, 2 or 3.
    pub noise_generator: Option<u8>,
    /// The default noises that patterns have used, with the first pattern of each.
    pub noise_taken: Vec<(NoiseGenerator, Place)>,
    /// `number_of_waves`
    pub number_of_waves: Option<u32>,
    /// `irid_wavelength`
    pub irid_wavelength: Option<Color>,
}

/// The default noise with this `noise_generator` and `#version`.
fn noise_at(number: Option<u8>, version: f64) -> NoiseGenerator {
    let of_version = match version < RANGE_CORRECTED_SINCE {
        true => NoiseGenerator::Original,
        false => NoiseGenerator::RangeCorrected,
    };
    number
        .and_then(|number| NoiseGenerator::from_number(number.into()))
        .unwrap_or(of_version)
}

/// `global_settings { ... }`; of several, each item's last value counts, except that of `assumed_gamma`.
pub(super) fn global_settings(p: &mut Parser<'_>) -> PResult<()> {
    p.braces(|p| p.items("`global_settings`", Parser::global_setting))
}

impl Parser<'_> {
    fn global_setting(&mut self, token: Token) -> PResult<()> {
        let Some(word) = token.word() else {
            return self.skip_item(token, "`global_settings`");
        };
        let place = self.place_of(token);
        match word {
            Word::AssumedGamma => {
                self.take(token)?;
                self.assumed_gamma()?;
            }
            Word::AmbientLight => {
                self.take(token)?;
                let [r, g, b, ..] = self.color()?;
                self.state.global.ambient = Some(Color::new(r, g, b));
            }
            Word::IridWavelength => {
                self.take(token)?;
                let [r, g, b, ..] = self.color()?;
                self.state.global.irid_wavelength = Some(Color::new(r, g, b));
            }
            Word::AdcBailout => {
                self.take(token)?;
                let value = self.float()?;
                if !(value >= 0.0) {
                    return Err(
                        self.fail(place, format!("adc_bailout must be 0 or more, not {value}"))
                    );
                }
                // POV-Ray does not trace branches of weight 0. The setting 0 would trace them, which NFF scenes need for the published numbers of rays.
                self.scene.settings.adc_bailout = value.max(f64::MIN_POSITIVE);
            }
            Word::MaxTraceLevel => {
                self.take(token)?;
                self.trace_level()?;
            }
            Word::NoiseGenerator => {
                self.take(token)?;
                let generator = self.whole_setting("noise_generator", 3)?;
                self.state.global.noise_generator = u8::try_from(generator).ok();
            }
            Word::NumberOfWaves => {
                self.take(token)?;
                let waves = self.whole_setting("number_of_waves", 10_000)?;
                self.state.global.number_of_waves = Some(waves);
            }
            // Neither has an effect: there is no table of intersections that could overflow, and units matter only for subsurface
            // light.
            Word::MaxIntersections | Word::MmPerUnit => {
                self.take(token)?;
                self.float()?;
            }
            Word::HfGray16 => {
                self.take(token)?;
                if self.switched()? {
                    self.warn(
                        place,
                        "hf_gray_16 has no effect: the format of the picture is chosen by its name",
                    );
                }
            }
            // Text is always UTF-8, which includes ASCII.
            Word::Charset => {
                self.take(token)?;
                let set = self.next()?;
                if !(set.is(Word::Ascii) || set.is(Word::Utf8) || set.is(Word::Sys)) {
                    return Err(self.unexpected(set, "`ascii`, `utf8` or `sys`"));
                }
            }
            Word::Radiosity | Word::Photons | Word::Subsurface => {
                self.take(token)?;
                let lacks = match word {
                    Word::Radiosity => "the picture lacks light reflected between surfaces",
                    Word::Photons => "the picture lacks light focused by mirrors and lenses",
                    _ => "the picture lacks light scattered below surfaces",
                };
                let message = format!("`{}` is not supported yet and is left out", word.text());
                self.warn_hint(place, message, lacks);
                self.skip_body()?;
            }
            _ => return self.skip_item(token, "`global_settings`"),
        }
        Ok(())
    }

    /// A number or `srgb` after `assumed_gamma`; of several the first counts (measured).
    fn assumed_gamma(&mut self) -> PResult<()> {
        let place = self.place();
        let space = self.transfer_function("assumed_gamma")?;
        if let Some(first) = self.state.global.working_space {
            if space != first {
                self.warn_hint(
                    place,
                    "this `assumed_gamma` has no effect, because the scene has another one before",
                    "as in POV-Ray, the first one counts",
                );
            }
            return Ok(());
        }
        self.state.global.working_space = Some(space);
        Ok(())
    }

    /// A power or `srgb`, the value of `item`.
    pub(super) fn transfer_function(&mut self, item: &str) -> PResult<WorkingSpace> {
        let place = self.place();
        if self.accept_word(Word::Srgb)? {
            return Ok(WorkingSpace::Srgb);
        }
        match self.float()? {
            1.0 => Ok(WorkingSpace::Linear),
            gamma if gamma > 0.0 && gamma.is_finite() => Ok(WorkingSpace::Gamma(gamma)),
            gamma => Err(self.fail(place, format!("{item} must be positive, not {gamma}"))),
        }
    }

    /// An integer from 1 to `most`.
    fn whole_setting(&mut self, name: &str, most: u32) -> PResult<u32> {
        let value = self.float()?;
        if value >= 1.0 && value < f64::from(most) + 1.0 {
            return Ok(value as u32);
        }
        let place = self.place();
        Err(self.fail(place, format!("{name} must be 1 to {most}, not {value}")))
    }

    /// Sets at the end of the scene the settings that depend on the language version.
    pub(super) fn settle(&mut self) {
        let (working_space, old) = (self.working_space(), self.before_3_7());
        if let Some(Background::Sky(sky)) = &mut self.scene.background {
            Arc::make_mut(sky).tints_layers = !old;
        }
        if old {
            self.scene.background_alpha = BackgroundAlpha::LeftOut;
        }
        self.noise_settled();
        let global = &self.state.global;
        self.scene.ambient = Some(global.ambient.unwrap_or(Color::WHITE));
        let irid = IridSettings {
            wavelength: global
                .irid_wavelength
                .unwrap_or(IridSettings::default().wavelength),
            noise: noise_at(self.state.global.noise_generator, self.version),
        };
        let settings = &mut self.scene.settings;
        settings.irid = irid;
        settings.max_depth = global.trace_level.unwrap_or(TRACE_LEVEL);
        settings.straight_counts = false;
        settings.filter_by_color = old;
        settings.working_space = working_space;
    }

    /// The default noise.
    pub(crate) fn default_noise(&self) -> NoiseGenerator {
        let global = &self.state.global;
        let number = global.foreseen.noise_generator.or(global.noise_generator);
        noise_at(number, global.scene_version.unwrap_or(UNVERSIONED))
    }

    /// The default noise of a pattern; it is recorded for [`Self::noise_settled`].
    pub(super) fn noise_of(&mut self, pattern: &Pattern) -> NoiseGenerator {
        let noise = self.default_noise();
        let noisy = matches!(
            pattern,
            Pattern::Agate { .. }
                | Pattern::Bozo
                | Pattern::Dents
                | Pattern::Granite
                | Pattern::Wrinkles
        );
        let taken = &self.state.global.noise_taken;
        if noisy && taken.iter().all(|(other, _)| *other != noise) {
            let place = self.place();
            self.state.global.noise_taken.push((noise, place));
        }
        noise
    }

    /// Warns at the end of the scene if patterns have used another noise than POV-Ray, which decides only there.
    fn noise_settled(&mut self) {
        let last = noise_at(self.state.global.noise_generator, self.version);
        let taken = std::mem::take(&mut self.state.global.noise_taken);
        for (_, place) in taken.into_iter().filter(|(noise, _)| *noise != last) {
            self.warn_hint(
                place,
                "the `noise_generator` or `#version` after this pattern does not change its noise",
                "write `#version` and `global_settings { noise_generator ... }` before the first pattern",
            );
        }
    }

    /// Whether the current version is older than 3.7, as in a scene without a version.
    pub(crate) fn before_3_7(&self) -> bool {
        self.version < 3.7 || !self.state.global.versioned
    }

    /// The working space of colours, according to the settings so far.
    ///
    /// Scenes from before 3.7 without `assumed_gamma` use the numbers of the display. (Of several versions the last one counts.)
    pub(crate) fn working_space(&self) -> WorkingSpace {
        let otherwise = if self.before_3_7() {
            WorkingSpace::Srgb
        } else {
            WorkingSpace::Linear
        };
        self.state.global.working_space.unwrap_or(otherwise)
    }

    /// The number after `max_trace_level`.
    pub(crate) fn trace_level(&mut self) -> PResult<()> {
        let value = self.float()?;
        let place = self.place();
        if !(value >= 1.0) {
            return Err(self.fail(
                place,
                format!("max_trace_level must be 1 to 256, not {value}"),
            ));
        }
        if value >= f64::from(DEEPEST) + 1.0 {
            self.warn(
                place,
                format!("max_trace_level is at most {DEEPEST}, as in POV-Ray"),
            );
        }
        // Saturates.
        self.state.global.trace_level = Some((value as u32).min(DEEPEST));
        Ok(())
    }
}
