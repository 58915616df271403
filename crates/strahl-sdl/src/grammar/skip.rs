use crate::parser::{PResult, Parser};
use crate::token::{Kind, Token};

impl Parser<'_> {
    /// Skips `{ ... }`, directives inside carried out.
    pub(crate) fn skip_body(&mut self) -> PResult<()> {
        let token = self.expect(Kind::LeftBrace)?;
        let mut open = 1usize;
        while open > 0 {
            let next = self.peek()?;
            match next.kind {
                Kind::LeftBrace => open += 1,
                Kind::RightBrace => open -= 1,
                Kind::End => return Err(self.unexpected(token, "a `}` for this brace")),
                _ => {}
            }
            self.take(next)?;
        }
        Ok(())
    }

    /// Skips an item that is not supported: its word, then everything up to the next word, closing brace or a body in braces.
    /// The warning says that the picture will lack it.
    pub(crate) fn skip_item(&mut self, item: Token, of: &str) -> PResult<()> {
        let place = self.place_of(item);
        let found = self.describe(item);
        if item.kind != Kind::Word {
            return Err(self.unexpected(item, &format!("an item of {of}, or `}}`")));
        }
        self.warn(
            place,
            format!("{found} in {of} is not supported yet and is left out"),
        );
        self.take(item)?;
        loop {
            let token = self.peek()?;
            match token.kind {
                Kind::LeftBrace => return self.skip_body(),
                Kind::RightBrace | Kind::End => return Ok(()),
                Kind::Word => {
                    let kind = token.word().map(crate::keywords::Word::kind);
                    use crate::keywords::WordKind as W;
                    let value = matches!(
                        kind,
                        Some(
                            W::Constant
                                | W::FloatFunction
                                | W::VectorFunction
                                | W::Color
                                | W::StringFunction
                        )
                    );
                    if !value {
                        return Ok(());
                    }
                    self.take(token)?;
                }
                _ => self.take(token)?,
            }
        }
    }
}
