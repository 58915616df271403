//! Modifiers of any pattern: turbulence, waves, warps and transformations.

use crate::keywords::Word;
use crate::parser::{PResult, Parser};
use crate::token::{Kind, Token};
use strahl_math::noise::{NoiseGenerator, Turbulence};
use strahl_math::{DVec3, Transform};
use strahl_shade::patterns::{BlackHole, Mapping, Modifiers, Pattern, Warp, Wave};

/// Appends a transformation to a pattern's warps.
pub(super) fn transform(warps: &mut Vec<Warp>, transform: &Transform) {
    // Consecutive transformations are combined.
    if let Some(Warp::Transform(last)) = warps.last_mut() {
        *last = last.then(transform);
    } else {
        warps.push(Warp::Transform(*transform));
    }
}

/// The setting that `image_map` implies, which remains when a pattern replaces it: values are not repeated, unless a frequency follows
/// (measured).
pub(super) fn begin_as_it_is(modifiers: &mut Modifiers) {
    modifiers.frequency = 0.0;
}

/// Settings that a pattern's keyword implies: the values of `quilted`, `image_pattern` and block patterns are not repeated, unless a
/// frequency follows; the triangle waves of marble, wood and spirals remain when another pattern replaces them (measured).
pub(super) fn begin(modifiers: &mut Modifiers, pattern: &Pattern) {
    let as_it_is = matches!(pattern, Pattern::Quilted { .. } | Pattern::Image(_));
    if as_it_is || pattern.block_count().is_some() {
        begin_as_it_is(modifiers);
    }
    let wave = pattern.default_wave();
    if wave != Wave::Ramp {
        modifiers.wave = Some(wave);
    }
}

impl Parser<'_> {
    /// Reads a modifier of patterns, if one follows.
    ///
    /// # Errors
    /// If its value is invalid.
    pub(super) fn pattern_modifier(
        &mut self,
        modifiers: &mut Modifiers,
        token: Token,
    ) -> PResult<bool> {
        if let Some(next) = self.transformation(token)? {
            transform(&mut modifiers.warps, &next);
            return Ok(true);
        }
        match token.word() {
            Some(Word::Turbulence) => {
                self.take(token)?;
                modifiers.turbulence = self.vector3()?;
            }
            Some(Word::Frequency) => {
                self.take(token)?;
                modifiers.frequency = self.float()?;
            }
            Some(Word::Phase) => {
                self.take(token)?;
                modifiers.phase = self.float()?;
            }
            Some(Word::RampWave) => {
                self.take(token)?;
                modifiers.wave = Some(Wave::Ramp);
            }
            Some(Word::TriangleWave) => {
                self.take(token)?;
                modifiers.wave = Some(Wave::Triangle);
            }
            Some(Word::SineWave) => {
                self.take(token)?;
                modifiers.wave = Some(Wave::Sine);
            }
            Some(Word::ScallopWave) => {
                self.take(token)?;
                modifiers.wave = Some(Wave::Scallop);
            }
            Some(Word::CubicWave) => {
                self.take(token)?;
                modifiers.wave = Some(Wave::Cubic);
            }
            Some(Word::PolyWave) => {
                self.take(token)?;
                let exponent = if self.starts_number()? {
                    self.float()?
                } else {
                    1.0
                };
                modifiers.wave = Some(Wave::Poly(exponent));
            }
            Some(Word::NoiseGenerator) => {
                self.take(token)?;
                let number = self.whole(1, 3)?;
                modifiers.noise = NoiseGenerator::from_number(number).unwrap_or_default();
            }
            Some(Word::Warp) => {
                self.take(token)?;
                self.count_parts(16)?;
                let warp = self.braces(Self::warp)?;
                modifiers.warps.push(warp);
            }
            _ => return self.octave_item(&mut modifiers.octaves, token),
        }
        Ok(true)
    }

    /// `octaves`, `omega`, `lambda`
    pub(in crate::grammar) fn octave_item(
        &mut self,
        octaves: &mut Turbulence,
        token: Token,
    ) -> PResult<bool> {
        match token.word() {
            Some(Word::Octaves) => {
                self.take(token)?;
                // As in POV-Ray, the maximum is ten; more would not be visible.
                octaves.octaves = self.float()?.clamp(1.0, 10.0) as u32;
            }
            Some(Word::Omega) => {
                self.take(token)?;
                octaves.omega = self.float()?;
            }
            Some(Word::Lambda) => {
                self.take(token)?;
                octaves.lambda = self.float()?;
            }
            _ => return Ok(false),
        }
        Ok(true)
    }

    /// The content of the braces of `warp`.
    fn warp(&mut self) -> PResult<Warp> {
        let token = self.peek()?;
        let mapping = match token.word() {
            Some(Word::Repeat) => {
                self.take(token)?;
                return self.repeat_warp();
            }
            Some(Word::BlackHole) => {
                self.take(token)?;
                return self.black_hole();
            }
            Some(Word::Turbulence) => {
                self.take(token)?;
                return self.turbulence_warp();
            }
            Some(Word::Planar) => {
                self.take(token)?;
                return self.planar_warp();
            }
            Some(Word::Cylindrical) => Mapping::Cylindrical,
            Some(Word::Spherical) => Mapping::Spherical,
            Some(Word::Toroidal) => Mapping::Toroidal(1.0),
            Some(Word::Cubic) => {
                self.take(token)?;
                return Ok(Warp::Cubic);
            }
            _ => {
                let known = "`repeat`, `black_hole`, `turbulence`, `cylindrical`, `spherical`, \
                             `toroidal`, `cubic` or `planar`";
                return Err(self.unexpected(token, known));
            }
        };
        self.take(token)?;
        self.mapping_warp(mapping)
    }

    /// `<width along one axis> [offset <...>] [flip <...>]`
    fn repeat_warp(&mut self) -> PResult<Warp> {
        let place = self.place();
        let direction = self.vector3()?;
        let axes: Vec<usize> = (0..3).filter(|a| direction[*a] != 0.0).collect();
        let &[axis] = axes.as_slice() else {
            return Err(self.fail_hint(
                place,
                "`repeat` needs a width along exactly one axis",
                "write `repeat 2*x`; for two directions write two warps",
            ));
        };
        let (mut offset, mut flip) = (DVec3::ZERO, [false; 3]);
        self.items("`warp`", |p, token| {
            match token.word() {
                Some(Word::Offset) => {
                    p.take(token)?;
                    offset = p.vector3()?;
                }
                Some(Word::Flip) => {
                    p.take(token)?;
                    flip = p.vector3()?.to_array().map(|f| f != 0.0);
                }
                _ => return Err(p.unexpected(token, "`offset`, `flip` or `}`")),
            }
            Ok(())
        })?;
        Ok(Warp::Repeat {
            axis,
            width: direction[axis],
            offset,
            flip,
        })
    }

    /// `<centre>, radius [strength s] [falloff f] [inverse] [repeat <...>] [turbulence <...>]`
    fn black_hole(&mut self) -> PResult<Warp> {
        let center = self.vector3()?;
        self.comma()?;
        let mut hole = BlackHole::new(center, self.float()?);
        let (mut repeats, mut turbulence) = (false, DVec3::ZERO);
        self.items("`black_hole`", |p, token| {
            match token.word() {
                Some(Word::Strength) => {
                    p.take(token)?;
                    hole.strength = p.float()?;
                }
                Some(Word::Falloff) => {
                    p.take(token)?;
                    hole.falloff = p.float()?;
                }
                Some(Word::Inverse) => {
                    p.take(token)?;
                    hole.inverse = p.flag()?;
                }
                Some(Word::Repeat) => {
                    p.take(token)?;
                    hole.repeat = p.vector3()?;
                    repeats = true;
                }
                Some(Word::Turbulence) => {
                    p.take(token)?;
                    turbulence = p.vector3()?;
                }
                _ => return p.skip_item(token, "`black_hole`"),
            }
            Ok(())
        })?;
        // As in POV-Ray (measured) turbulence is for holes that are repeated, if only 0 times.
        if repeats {
            hole.turbulence = turbulence;
        }
        Ok(Warp::BlackHole(hole))
    }

    fn turbulence_warp(&mut self) -> PResult<Warp> {
        let amount = self.vector3()?;
        let mut octaves = Turbulence::default();
        self.items("`turbulence`", |p, token| {
            if p.octave_item(&mut octaves, token)? {
                return Ok(());
            }
            Err(p.unexpected(token, "`octaves`, `omega`, `lambda` or `}`"))
        })?;
        Ok(Warp::Turbulence { amount, octaves })
    }

    /// `[<normal>, distance]`
    fn planar_warp(&mut self) -> PResult<Warp> {
        let (mut orientation, mut distance) = (DVec3::Z, 0.0);
        if self.peek()?.kind != Kind::RightBrace {
            orientation = self.unit_vector()?;
            self.comma()?;
            distance = self.float()?;
        }
        Ok(Warp::Planar {
            orientation,
            distance,
        })
    }

    fn mapping_warp(&mut self, mut mapping: Mapping) -> PResult<Warp> {
        let (mut orientation, mut distance_exponent) = (DVec3::Z, 0.0);
        self.items("`warp`", |p, token| {
            match (token.word(), &mut mapping) {
                (Some(Word::Orientation), _) => {
                    p.take(token)?;
                    orientation = p.unit_vector()?;
                }
                (Some(Word::DistExp), _) => {
                    p.take(token)?;
                    distance_exponent = p.float()?;
                }
                (Some(Word::MajorRadius), Mapping::Toroidal(radius)) => {
                    p.take(token)?;
                    *radius = p.float()?;
                }
                _ => return Err(p.unexpected(token, "`orientation`, `dist_exp` or `}`")),
            }
            Ok(())
        })?;
        Ok(Warp::Mapping {
            mapping,
            orientation,
            distance_exponent,
        })
    }

    /// A vector of length 1 in the given direction.
    fn unit_vector(&mut self) -> PResult<DVec3> {
        let token = self.peek()?;
        let place = self.place_of(token);
        let unit = self.vector3()?.normalize_or_zero();
        if unit == DVec3::ZERO {
            return Err(self.fail(place, "this vector has no direction"));
        }
        Ok(unit)
    }
}
