use crate::grammar::Thing;
use crate::keywords::{Word, WordKind};
use crate::parser::{PResult, Parser, Place};
use crate::token::{Kind, Token};
use strahl_math::DVec3;
use strahl_math::noise::Turbulence;
use strahl_scene::{Fog, FogKind, FogTurbulence};
use strahl_shade::{Color, ColorFt};

/// `fog { ... }` as a statement; a scene may have several fogs, which all act.
pub(super) fn fog_statement(p: &mut Parser<'_>) -> PResult<()> {
    let fog = p.fog()?;
    // A fog with distance 0 has no effect.
    if fog.distance > 0.0 {
        p.scene.fogs.push(fog);
    }
    Ok(())
}

/// A fog being read.
struct Draft {
    ground: bool,
    up: DVec3,
    offset: f64,
    altitude: f64,
    distance: f64,
    color: ColorFt,
    turbulence: DVec3,
    turb_depth: f64,
    octaves: Turbulence,
}

impl Draft {
    fn new() -> Self {
        Self {
            ground: false,
            up: DVec3::Y,
            offset: 0.0,
            altitude: 0.0,
            distance: 0.0,
            color: ColorFt::default(),
            turbulence: DVec3::ZERO,
            turb_depth: 0.5,
            octaves: Turbulence::default(),
        }
    }

    fn of(fog: &Fog) -> Self {
        let mut draft = Self {
            distance: fog.distance,
            color: fog.color,
            ..Self::new()
        };
        if let FogKind::Ground {
            up,
            offset,
            altitude,
        } = fog.kind
        {
            draft.ground = true;
            (draft.up, draft.offset, draft.altitude) = (up, offset, altitude);
        }
        if let Some(turbulence) = fog.turbulence {
            draft.turbulence = turbulence.scale;
            draft.turb_depth = turbulence.strength;
            draft.octaves = turbulence.octaves;
        }
        draft
    }
}

impl Parser<'_> {
    /// `{ ... }` after `fog`.
    pub(super) fn fog(&mut self) -> PResult<Fog> {
        let place = self.place();
        let mut draft = Draft::new();
        self.braces(|p| {
            let named = p.accept_thing(|thing| match thing {
                Thing::Fog(fog) => Some(fog),
                _ => None,
            })?;
            if let Some(fog) = named {
                draft = Draft::of(&fog);
            }
            p.items("`fog`", |p, token| p.fog_item(&mut draft, token))
        })?;
        Ok(self.finish_fog(&draft, place))
    }

    fn fog_item(&mut self, draft: &mut Draft, token: Token) -> PResult<()> {
        if let Some(t) = self.transformation(token)? {
            draft.up = t.vector_to_world(draft.up);
            return Ok(());
        }
        let word = match token.word() {
            Some(word) if word.kind() != WordKind::Color => word,
            // Up to version 2.2 the distance has no word.
            None if token.kind == Kind::Number => {
                draft.distance = self.float()?;
                return Ok(());
            }
            _ => {
                let [r, g, b, filter, transmit] = self.color()?;
                draft.color = ColorFt {
                    rgb: Color::new(r, g, b),
                    filter,
                    transmit,
                };
                return Ok(());
            }
        };
        let place = self.place_of(token);
        match word {
            Word::FogType => {
                self.take(token)?;
                draft.ground = match self.float()? {
                    1.0 => false,
                    2.0 => true,
                    other => {
                        let message =
                            format!("fog_type must be 1 (uniform) or 2 (ground fog), not {other}");
                        return Err(self.fail(place, message));
                    }
                };
            }
            Word::Distance => {
                self.take(token)?;
                draft.distance = self.float()?;
            }
            Word::FogOffset => {
                self.take(token)?;
                draft.offset = self.float()?;
            }
            Word::FogAlt => {
                self.take(token)?;
                draft.altitude = self.float()?;
            }
            Word::Up => {
                self.take(token)?;
                draft.up = self.vector3()?;
            }
            Word::Turbulence => {
                self.take(token)?;
                draft.turbulence = self.vector3()?;
            }
            Word::TurbDepth => {
                self.take(token)?;
                draft.turb_depth = self.float()?;
            }
            _ if self.octave_item(&mut draft.octaves, token)? => {}
            _ => return self.skip_item(token, "`fog`"),
        }
        Ok(())
    }

    fn finish_fog(&mut self, draft: &Draft, place: Place) -> Fog {
        let kind = if draft.ground {
            FogKind::Ground {
                up: draft.up.normalize_or(DVec3::Y),
                offset: draft.offset,
                altitude: draft.altitude,
            }
        } else {
            FogKind::Constant
        };
        if !(draft.distance > 0.0) {
            self.warn(
                place,
                "fog without a positive `distance` cannot be seen and is left out",
            );
        }
        let turbulence = (draft.turbulence != DVec3::ZERO).then(|| FogTurbulence {
            scale: draft.turbulence,
            strength: draft.turb_depth,
            octaves: draft.octaves,
            noise: self.default_noise(),
        });
        Fog {
            kind,
            distance: draft.distance,
            color: draft.color,
            turbulence,
            span: self.span_at(place),
        }
    }
}
