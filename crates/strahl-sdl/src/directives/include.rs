use crate::parser::{PResult, Parser};
use crate::token::Kind;

impl Parser<'_> {
    /// Runs `#include "file"`, whose keyword is taken.
    pub(super) fn include_directive(&mut self) -> PResult<()> {
        let name = self.file_name()?;
        let place = self.place();
        self.include(&name, place)
    }

    /// A file name: a string literal, in which backslashes are not escapes, or any string expression.
    pub(crate) fn file_name(&mut self) -> PResult<String> {
        let token = self.peek()?;
        if token.kind == Kind::String {
            self.take(token)?;
            return Ok(self.raw_string_of(token));
        }
        self.string().map(|s| s.to_string())
    }
}
