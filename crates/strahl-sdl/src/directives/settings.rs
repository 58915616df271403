use crate::keywords::Word;
use crate::parser::{PResult, Parser};
use crate::token::Kind;

impl Parser<'_> {
    /// `#version 3.7;` behind the word; `#version unofficial ...` is read past.
    pub(super) fn version(&mut self) -> PResult<()> {
        if self.accept_word(Word::Unofficial)? {
            let token = self.peek()?;
            if token.kind == Kind::Name || token.kind == Kind::Word {
                self.take(token)?;
            }
        }
        let version = self.float()?;
        let place = self.place();
        if version > 3.8 {
            self.warn(
                place,
                format!(
                    "the scene is written for version {version} of the language; 3.8 is known here"
                ),
            );
        }
        self.version = version;
        self.state.global.versioned = true;
        self.raw_accept(Kind::Semicolon)?;
        Ok(())
    }

    /// `#default { ... }` behind the word.
    pub(super) fn default_directive(&mut self) -> PResult<()> {
        self.braces(crate::grammar::default_items)
    }
}
