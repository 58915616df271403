use crate::keywords::Word;
use crate::parser::{PResult, Parser};
use crate::token::Kind;

impl Parser<'_> {
    /// Runs `#version 3.7;`, whose keyword is taken; `#version unofficial ...` is skipped.
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
                    "the scene is written for version {version} of the language; strahl supports versions up to 3.8"
                ),
            );
        }
        self.version = version;
        self.state.global.versioned = true;
        self.raw_accept(Kind::Semicolon)?;
        Ok(())
    }

    /// Runs `#max_trace_level` and `#max_intersections`, which were directives up to version 2.2.
    pub(super) fn old_setting(&mut self, name: &str) -> PResult<()> {
        self.warn_hint(
            self.place(),
            format!("`#{name}` is a setting"),
            format!("write `global_settings {{ {name} ... }}`"),
        );
        if name == "max_trace_level" {
            return self.trace_level();
        }
        self.float().map(|_| ())
    }

    /// Runs `#default { ... }`, whose keyword is taken.
    pub(super) fn default_directive(&mut self) -> PResult<()> {
        self.braces(crate::grammar::default_items)
    }
}
