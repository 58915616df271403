//! Patterns: the table of their keywords, and the parameters of single patterns.

use super::inside::ObjectInside;
use crate::grammar::{Declared, Thing, by_word, words_of};
use crate::keywords::Word;
use crate::parser::{PResult, Parser};
use crate::token::{Kind, Token};
use std::sync::Arc;
use strahl_formats::density::decode_density;
use strahl_math::{DVec2, DVec3};
use strahl_shade::patterns::{
    Altitude, Crackle, CrackleMetric, DensityInterpolation, Exterior, Fractal, FractalInterior,
    FractalKind, Pattern, PatternField, SlopeReference, TilingNumber,
};

/// Reads the required parameters after the keyword of a pattern; the keyword is taken.
type PatternParser = fn(&mut Parser<'_>) -> PResult<Pattern>;

/// All patterns by keyword; after an object pattern the closing brace is left, because colours may precede it.
static PATTERNS: [Option<PatternParser>; Word::ALL.len()] = by_word::<PatternParser, _>([
    (Word::Agate, |_| Ok(Pattern::Agate { turbulence: 1.0 })),
    (Word::Aoi, |_| Ok(Pattern::Aoi)),
    (Word::Boxed, |_| Ok(Pattern::Boxed)),
    (Word::Bozo, |_| Ok(Pattern::Bozo)),
    (Word::Brick, |_| {
        Ok(Pattern::Brick {
            size: DVec3::new(8.0, 3.0, 4.5),
            mortar: 0.5,
        })
    }),
    (Word::Bumps, |_| Ok(Pattern::Bozo)),
    (Word::Cells, |_| Ok(Pattern::Cells)),
    (Word::Checker, |_| Ok(Pattern::Checker)),
    (Word::Crackle, |_| Ok(Pattern::Crackle(Crackle::default()))),
    (Word::Cubic, |_| Ok(Pattern::Cubic)),
    (Word::Cylindrical, |_| Ok(Pattern::Cylindrical)),
    (Word::Dents, |_| Ok(Pattern::Dents)),
    (Word::DensityFile, |p| p.density_file()),
    (Word::Function, |p| {
        let function = p.nested(Parser::function)?;
        Ok(Pattern::Function(Arc::new(function)))
    }),
    (Word::Gradient, |p| p.vector3().map(Pattern::Gradient)),
    (Word::Granite, |_| Ok(Pattern::Granite)),
    (Word::Hexagon, |_| Ok(Pattern::Hexagon)),
    (Word::ImagePattern, |p| {
        p.pattern_bitmap().map(Pattern::Image)
    }),
    (Word::Julia, |p| p.julia(FractalKind::Power { exponent: 2 })),
    (Word::Leopard, |_| Ok(Pattern::Leopard)),
    (Word::Magnet, |p| p.magnet()),
    (Word::Mandel, |p| {
        p.mandel(FractalKind::Power { exponent: 2 })
    }),
    (Word::Marble, |_| Ok(Pattern::Marble)),
    (Word::Object, |p| p.object_pattern()),
    (Word::Onion, |_| Ok(Pattern::Onion)),
    (Word::PigmentPattern, |p| {
        let pigment = p.nested(Parser::free_pigment_block)?;
        Ok(Pattern::Pigment(Arc::new(pigment)))
    }),
    (Word::Planar, |_| Ok(Pattern::Planar)),
    (Word::Quilted, |_| {
        Ok(Pattern::Quilted {
            control0: 1.0,
            control1: 1.0,
        })
    }),
    (Word::Radial, |_| Ok(Pattern::Radial)),
    (Word::Ripples, |p| {
        let sources = p.wave_sources();
        Ok(Pattern::Ripples { sources })
    }),
    (Word::Slope, |p| p.slope_pattern()),
    (Word::Spherical, |_| Ok(Pattern::Spherical)),
    // As in POV-Ray (measured) the number of arms is whole.
    (Word::Spiral1, |p| Ok(Pattern::Spiral1(p.float()?.trunc()))),
    (Word::Spiral2, |p| Ok(Pattern::Spiral2(p.float()?.trunc()))),
    (Word::Spotted, |_| Ok(Pattern::Bozo)),
    (Word::Square, |_| Ok(Pattern::Square)),
    (Word::Tiling, |p| p.tiling()),
    (Word::Triangular, |_| Ok(Pattern::Triangular)),
    (Word::Waves, |p| {
        let sources = p.wave_sources();
        Ok(Pattern::Waves { sources })
    }),
    (Word::Wood, |_| Ok(Pattern::Wood)),
    (Word::Wrinkles, |_| Ok(Pattern::Wrinkles)),
]);

/// The keywords of all supported patterns; some name the same pattern.
pub fn pattern_words() -> impl Iterator<Item = Word> {
    words_of(&PATTERNS)
}

/// The largest number of iterations of a fractal: points of the set take all of them.
const MAX_ITERATIONS: f64 = 1e6;

impl Parser<'_> {
    /// Reads a pattern with its required parameters, if one follows.
    ///
    /// # Errors
    /// If a parameter is invalid.
    pub(super) fn pattern(&mut self, token: Token) -> PResult<Option<Pattern>> {
        let parse = token
            .word()
            .and_then(|w| PATTERNS.get(w as usize).copied().flatten());
        match parse {
            Some(parse) => {
                self.take(token)?;
                parse(self).map(Some)
            }
            None => Ok(None),
        }
    }

    /// `{ pattern with modifiers }`, for functions and function images.
    ///
    /// # Errors
    /// If there is no pattern.
    pub(crate) fn pattern_block(&mut self) -> PResult<PatternField> {
        self.braces(|p| {
            let token = p.peek()?;
            let Some(pattern) = p.pattern(token)? else {
                return Err(p.unexpected(token, "a pattern"));
            };
            if let Pattern::Object(_) = pattern {
                p.expect(Kind::RightBrace)?;
            }
            let mut field = PatternField::from(pattern);
            field.modifiers.noise = p.noise_of(&field.pattern);
            p.items("`pattern`", |p, token| {
                if p.pattern_parameter(Some(&mut field.pattern), token)?
                    || p.pattern_modifier(&mut field.modifiers, token)?
                {
                    return Ok(());
                }
                p.skip_item(token, "`pattern`")
            })?;
            Ok(field)
        })
    }

    /// Reads a parameter of a single pattern (`brick_size`, `metric`, ...) into `pattern`, if one follows.
    ///
    /// # Errors
    /// If its value is invalid.
    pub(super) fn pattern_parameter(
        &mut self,
        pattern: Option<&mut Pattern>,
        token: Token,
    ) -> PResult<bool> {
        let Some(word) = token.word() else {
            return Ok(false);
        };
        match (word, pattern) {
            (Word::AgateTurb, Some(Pattern::Agate { turbulence })) => {
                self.take(token)?;
                *turbulence = self.float()?;
            }
            (Word::BrickSize, Some(Pattern::Brick { size, .. })) => {
                self.take(token)?;
                let place = self.place();
                *size = self.vector3()?;
                if size.to_array().contains(&0.0) {
                    return Err(self.fail(place, "a brick needs a size in every direction"));
                }
            }
            (Word::Mortar, Some(Pattern::Brick { mortar, .. })) => {
                self.take(token)?;
                *mortar = self.float()?;
            }
            (Word::Interpolate, Some(Pattern::Density(_, interpolation))) => {
                self.take(token)?;
                let number = self.whole(0, 2)?;
                *interpolation = DensityInterpolation::from_number(number).unwrap_or_default();
            }
            (Word::Form, Some(Pattern::Crackle(crackle))) => {
                self.take(token)?;
                crackle.form = self.vector3()?;
            }
            (Word::Metric, Some(Pattern::Crackle(crackle))) => {
                self.take(token)?;
                crackle.metric = CrackleMetric::from_number(self.float()?);
            }
            (Word::Offset, Some(Pattern::Crackle(crackle))) => {
                self.take(token)?;
                crackle.offset = self.float()?;
            }
            (Word::Solid, Some(Pattern::Crackle(crackle))) => {
                self.take(token)?;
                crackle.solid = self.flag()?;
            }
            (Word::Exponent, Some(Pattern::Fractal(fractal))) => {
                self.take(token)?;
                let exponent = self.whole(2, 33)?;
                if let FractalKind::Power { .. } = fractal.kind {
                    fractal.kind = FractalKind::Power { exponent };
                }
            }
            (Word::Exterior, Some(Pattern::Fractal(fractal))) => {
                self.take(token)?;
                fractal.exterior = self.exterior(fractal.exterior)?;
            }
            (Word::Interior, Some(Pattern::Fractal(fractal))) => {
                self.take(token)?;
                fractal.interior = self.fractal_interior()?;
            }
            (Word::Control0, Some(Pattern::Quilted { control0, .. })) => {
                self.take(token)?;
                *control0 = self.float()?;
            }
            (Word::Control1, Some(Pattern::Quilted { control1, .. })) => {
                self.take(token)?;
                *control1 = self.float()?;
            }
            (
                Word::NumberOfWaves,
                Some(Pattern::Ripples { sources } | Pattern::Waves { sources }),
            ) => {
                self.take(token)?;
                *sources = self.whole(1, 1000)?;
            }
            _ => return Ok(false),
        }
        Ok(true)
    }

    /// The default number of wave sources: that of `number_of_waves`.
    fn wave_sources(&self) -> u32 {
        let global = &self.state.global;
        let waves = global.foreseen.number_of_waves.or(global.number_of_waves);
        waves.unwrap_or(10)
    }

    /// An integer within bounds.
    pub(super) fn whole(&mut self, least: u32, most: u32) -> PResult<u32> {
        let token = self.peek()?;
        let place = self.place_of(token);
        let x = self.float()?;
        if !(f64::from(least)..=f64::from(most)).contains(&x.trunc()) {
            let message = format!("expected a whole number from {least} to {most}, found {x}");
            return Err(self.fail(place, message));
        }
        Ok(x as u32)
    }

    /// `on`, `off`, a number, or nothing for `on`.
    pub(in crate::grammar) fn flag(&mut self) -> PResult<bool> {
        if self.starts_number()? {
            return Ok(self.float()? != 0.0);
        }
        Ok(true)
    }

    /// Whether a number can begin here.
    pub(super) fn starts_number(&mut self) -> PResult<bool> {
        use crate::keywords::WordKind as W;
        let token = self.peek()?;
        Ok(match token.kind {
            Kind::Number | Kind::Minus | Kind::Plus | Kind::LeftParen | Kind::Bang => true,
            Kind::Name => {
                let value = token.symbol().and_then(|s| self.scopes.find(s));
                // An undeclared name may be a misspelt number, which the expression reports best.
                value.is_none_or(|v| v.numeric().is_some() || v.is_callable())
            }
            Kind::Word => {
                let kind = token.word().map(Word::kind);
                matches!(kind, Some(W::Constant | W::FloatFunction))
            }
            _ => false,
        })
    }

    /// `df3 "file"`
    fn density_file(&mut self) -> PResult<Pattern> {
        let token = self.peek()?;
        if !token.is(Word::Df3) {
            return Err(self.unexpected(token, "`df3` and the name of a density file"));
        }
        self.take(token)?;
        let name = self.file_name()?;
        let place = self.place();
        let known = self.state.densities.iter().find(|known| known.0 == name);
        let grid = match known {
            Some((_, grid)) => Arc::clone(grid),
            None => {
                let file = self.read_file(&name, place)?;
                let grid = match decode_density(&file.bytes) {
                    Ok(grid) => Arc::new(grid),
                    Err(error) => return Err(self.fail(place, error.to_string())),
                };
                self.state.densities.push((name, Arc::clone(&grid)));
                grid
            }
        };
        Ok(Pattern::Density(grid, DensityInterpolation::default()))
    }

    /// The number of iterations. In normals, the strength after it is left to the caller.
    fn iterations(&mut self) -> PResult<u32> {
        self.whole(1, MAX_ITERATIONS as u32)
    }

    fn mandel(&mut self, kind: FractalKind) -> PResult<Pattern> {
        let iterations = self.iterations()?;
        Ok(Pattern::Fractal(Fractal {
            kind,
            ..Fractal::mandelbrot(iterations)
        }))
    }

    fn julia(&mut self, kind: FractalKind) -> PResult<Pattern> {
        let [re, im] = self.vector2()?;
        self.comma()?;
        let iterations = self.iterations()?;
        Ok(Pattern::Fractal(Fractal {
            kind,
            julia: Some(DVec2::new(re, im)),
            ..Fractal::mandelbrot(iterations)
        }))
    }

    /// `magnet 1 mandel 20`, `magnet 2 julia <...>, 20`
    fn magnet(&mut self) -> PResult<Pattern> {
        let kind = match self.whole(1, 2)? {
            1 => FractalKind::Magnet1,
            _ => FractalKind::Magnet2,
        };
        let token = self.peek()?;
        match token.word() {
            Some(Word::Mandel) => {
                self.take(token)?;
                self.mandel(kind)
            }
            Some(Word::Julia) => {
                self.take(token)?;
                self.julia(kind)
            }
            _ => Err(self.unexpected(token, "`mandel` or `julia`")),
        }
    }

    /// `tiling N`
    fn tiling(&mut self) -> PResult<Pattern> {
        let place = self.place();
        let number = self.whole(1, 27)?;
        if let Some(tiling) = TilingNumber::try_new(number) {
            return Ok(Pattern::Tiling(tiling));
        }
        self.warn_hint(
            place,
            format!("`tiling {number}` is not supported yet and is left out"),
            "the tilings 1 to 24 are supported",
        );
        // A single colour: the first of the map.
        Ok(Pattern::Gradient(DVec3::ZERO))
    }

    /// `type, factor`; the default factor is 1.
    fn coloring(&mut self) -> PResult<(u32, f64)> {
        let number = self.whole(0, 8)?;
        self.comma()?;
        let factor = if self.starts_number()? {
            self.float()?
        } else {
            1.0
        };
        Ok((number, factor))
    }

    fn exterior(&mut self, before: Exterior) -> PResult<Exterior> {
        let place = self.place();
        let (number, factor) = self.coloring()?;
        Ok(Exterior::from_number(number, factor).unwrap_or_else(|| {
            self.warn_hint(
                place,
                format!("exterior {number} is not supported yet and is left out"),
                "the outside of the fractal will have other colours",
            );
            before
        }))
    }

    fn fractal_interior(&mut self) -> PResult<FractalInterior> {
        let place = self.place();
        let (number, factor) = self.coloring()?;
        FractalInterior::from_number(number, factor).ok_or_else(|| {
            let message = format!("expected a number from 0 to 6, found {number}");
            self.fail(place, message)
        })
    }

    /// `<direction>` or `point_at <point>`, the range of slopes, and an altitude; braces around it are optional.
    fn slope_pattern(&mut self) -> PResult<Pattern> {
        if self.peek()?.kind == Kind::LeftBrace {
            return self.braces(Self::slope_items);
        }
        self.slope_items()
    }

    fn slope_items(&mut self) -> PResult<Pattern> {
        let reference = if self.accept_word(Word::PointAt)? {
            SlopeReference::Point(self.vector3()?)
        } else {
            SlopeReference::Direction(self.vector3()?)
        };
        let range = self.value_range()?;
        let altitude = if self.accept_word(Word::Altitude)? {
            let direction = self.vector3()?;
            let range = self.value_range()?;
            Some(Altitude { direction, range })
        } else {
            None
        };
        Ok(Pattern::Slope {
            reference,
            range,
            altitude,
        })
    }

    /// `, low, high`, or nothing.
    fn value_range(&mut self) -> PResult<[f64; 2]> {
        self.comma()?;
        if !self.starts_number()? {
            return Ok([0.0, 0.0]);
        }
        let low = self.float()?;
        self.comma()?;
        let high = self.float()?;
        self.comma()?;
        Ok([low, high])
    }

    /// `{ object ... }`: the colours or pigments after the object are left to the caller, who knows their kind.
    fn object_pattern(&mut self) -> PResult<Pattern> {
        self.expect(Kind::LeftBrace)?;
        let named = self.accept_thing(|thing| match thing {
            Thing::Object(object) => Some(object),
            _ => None,
        })?;
        let object = match named {
            Some(named) => named,
            None => match self.entity()? {
                Some(entity) => Arc::new(Declared::new(entity, &self.state.shared)),
                None => {
                    let found = self.peek()?;
                    return Err(self.unexpected(found, "an object"));
                }
            },
        };
        let inside = self.query(&object)?;
        Ok(Pattern::Object(Arc::new(ObjectInside(inside))))
    }
}
