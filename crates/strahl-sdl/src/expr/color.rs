use crate::keywords::{Word, WordKind};
use crate::parser::{PResult, Parser};
use crate::token::{Kind, Token};
use crate::value::Vector;
use strahl_shade::{Color, srgb};

impl Parser<'_> {
    /// A colour: red, green, blue, filter, transmit.
    ///
    /// `rgb <1, 0, 0>`, `color rgbt 0.5`, `red 1 green 0.5`, the name of a colour, any vector; parts such as
    /// `filter 0.5` may follow and replace a component. `color` alone is black.
    ///
    /// # Errors
    /// If there is no colour.
    pub fn color(&mut self) -> PResult<[f64; 5]> {
        let token = self.peek()?;
        match token.word() {
            Some(w) if w.kind() == WordKind::Color => self.color_expression(),
            _ => {
                let color = self.calculation()?;
                self.color_parts(opaque(color))
            }
        }
    }

    /// The colour that begins with `value`, whose parts may follow: `filter 0.5`, ...
    ///
    /// # Errors
    /// If a part has no number.
    pub(crate) fn color_from(&mut self, value: Vector) -> PResult<[f64; 5]> {
        self.color_parts(opaque(value))
    }

    /// A colour that begins with one of the colour words.
    pub(super) fn color_expression(&mut self) -> PResult<[f64; 5]> {
        let token = self.peek()?;
        match token.word() {
            Some(Word::Color | Word::Colour) => {
                self.take(token)?;
                let next = self.peek()?;
                match ends_color(next) {
                    true => self.color_parts([0.0; 5]),
                    false => self.color(),
                }
            }
            Some(Word::Rgb) => self.rgb(3, false),
            Some(Word::Rgbf) => self.rgb(4, false),
            Some(Word::Rgbt) => self.rgbt(false),
            Some(Word::Rgbft) => self.rgb(5, false),
            Some(Word::Srgb) => self.rgb(3, true),
            Some(Word::Srgbf) => self.rgb(4, true),
            Some(Word::Srgbt) => self.rgbt(true),
            Some(Word::Srgbft) => self.rgb(5, true),
            Some(Word::Red | Word::Green | Word::Blue | Word::Filter | Word::Transmit) => {
                self.color_parts([0.0; 5])
            }
            _ => Err(self.unexpected(token, "a colour")),
        }
    }

    /// `rgb`, `rgbf` and `rgbft`: a float stands for as many components as the keyword has letters; further components of a
    /// vector are filter and transmit (as measured with POV-Ray, in all its versions). The keyword applies to the whole sum after
    /// it.
    fn rgb(&mut self, count: usize, encoded: bool) -> PResult<[f64; 5]> {
        self.next()?;
        let value = self.nested_end(Self::calculation)?;
        let value = match value.len() {
            1 => value.promoted(count).components(),
            _ => value.components(),
        };
        let color = self.in_working_space(value, encoded);
        self.color_parts(color)
    }

    /// `rgbt`: the fourth number is transmit.
    fn rgbt(&mut self, encoded: bool) -> PResult<[f64; 5]> {
        self.next()?;
        let value = self.nested_end(Self::calculation)?;
        let [r, g, b, t, _] = value.promoted(4).components();
        let color = self.in_working_space([r, g, b, 0.0, t], encoded);
        self.color_parts(color)
    }

    /// A colour in the scene's working space; if `encoded`, the components are sRGB codes.
    fn in_working_space(&self, [r, g, b, f, t]: [f64; 5], encoded: bool) -> [f64; 5] {
        if !encoded {
            return [r, g, b, f, t];
        }
        let linear = Color::new(r, g, b).map(srgb::decode);
        let [r, g, b] = self.working_space().encode(linear).to_array();
        [r, g, b, f, t]
    }

    /// `red 1`, `filter 0.5`, ... in any order.
    pub(super) fn color_parts(&mut self, mut color: [f64; 5]) -> PResult<[f64; 5]> {
        loop {
            let token = self.peek_behind()?;
            if token.kind != Kind::Word {
                return Ok(color);
            }
            let index = match token.word() {
                Some(Word::Red) => 0,
                Some(Word::Green) => 1,
                Some(Word::Blue) => 2,
                // Version 1.0 called it `alpha`.
                Some(Word::Filter | Word::Alpha) => 3,
                Some(Word::Transmit) => 4,
                _ => return Ok(color),
            };
            self.take(token)?;
            let value = self.float()?;
            if let Some(slot) = color.get_mut(index) {
                *slot = value;
            }
        }
    }
}

/// Whether a token behind the word `color` belongs to what follows it: a `color` without a colour is black, as in POV-Ray (measured), also in
/// front of another one (`checker color color Red`). Names and strings are mistakes, which the expression reports.
fn ends_color(token: Token) -> bool {
    match token.kind {
        Kind::Word => token.word().is_some_and(|word| match word.kind() {
            WordKind::Color => matches!(word, Word::Color | Word::Colour),
            kind => !matches!(
                kind,
                WordKind::Constant
                    | WordKind::FloatFunction
                    | WordKind::VectorFunction
                    | WordKind::StringFunction
                    | WordKind::Scope
            ),
        }),
        Kind::RightBrace
        | Kind::RightBracket
        | Kind::RightParen
        | Kind::Comma
        | Kind::Semicolon
        | Kind::End => true,
        _ => false,
    }
}

/// A vector as a colour: a float is a grey, up to three numbers are opaque, the fourth is filter.
pub(super) fn opaque(value: Vector) -> [f64; 5] {
    match value.len() {
        1 => value.promoted(5).components(),
        len => value.promoted(len).components(),
    }
}
