//! Directives: the statements that begin with `#`.

mod conditional;
mod declare;
mod define;
mod files;
mod include;
mod loops;
mod messages;
mod settings;

pub(crate) use files::Files;

use crate::keywords::Word;
use crate::parser::{PResult, Parser};
use crate::suggest::{Candidate, closest};
use crate::token::{Directive, Token};

/// How to continue after a directive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Flow {
    /// With the tokens at the position.
    On,
    /// Not at all: the construct that is being read must not leave its block.
    Stop,
}

impl Parser<'_> {
    /// Runs the directive at the position.
    pub(crate) fn run_directive(&mut self, token: Token) -> PResult<Flow> {
        let directive = token.directive().unwrap_or(Directive::Unknown);
        let boundary =
            directive.divides() || matches!(directive, Directive::End | Directive::Break);
        if boundary && self.at_floor() {
            return Ok(Flow::Stop);
        }
        let here = self.position();
        self.mark_directive();
        if directive == Directive::End && self.at_macro_end() && self.block().is_none() {
            self.leave_frame();
            return Ok(Flow::On);
        }
        self.take(token)?;
        self.enclosed(|p| match directive {
            Directive::If | Directive::Ifdef | Directive::Ifndef => p.if_(directive, here),
            Directive::Else | Directive::Elseif | Directive::Case | Directive::Range => {
                p.divider(directive, here)
            }
            Directive::End => p.end(here),
            Directive::Switch => p.switch(here),
            Directive::While => p.while_(here),
            Directive::For => p.for_(here),
            Directive::Break => p.break_(),
            Directive::Declare => p.declare(false),
            Directive::Local => p.declare(true),
            Directive::Undef => p.undef(),
            Directive::Macro => p.define(here),
            Directive::Include => p.include_directive(),
            Directive::Version => p.version(),
            Directive::Default => p.default_directive(),
            Directive::Debug
            | Directive::Warning
            | Directive::Error
            | Directive::Render
            | Directive::Statistics => p.message(directive),
            Directive::Fopen => p.fopen(),
            Directive::Fclose => p.fclose(),
            Directive::Read => p.read(),
            Directive::Write => p.write(),
            Directive::Unknown => p.unknown_directive(token),
        })?;
        Ok(Flow::On)
    }

    /// `declare`, `include`, `default`, `version` and old settings as statements, for which the language allows the `#` to be omitted.
    pub(crate) fn bare_directive(&mut self, token: Token) -> PResult<bool> {
        let word = match token.word() {
            Some(word @ (Word::Declare | Word::Include | Word::Default | Word::Version)) => word,
            Some(word @ (Word::MaxTraceLevel | Word::MaxIntersections)) => {
                self.take(token)?;
                self.enclosed(|p| p.old_setting(word.text()))?;
                return Ok(true);
            }
            _ => return Ok(false),
        };
        let text = word.text();
        self.take(token)?;
        self.warn_hint(
            self.place(),
            format!("`{text}` stands without its `#`"),
            format!("write `#{text}`"),
        );
        self.enclosed(|p| match word {
            Word::Declare => p.declare(false),
            Word::Include => p.include_directive(),
            Word::Version => p.version(),
            _ => p.default_directive(),
        })?;
        Ok(true)
    }

    fn unknown_directive(&mut self, token: Token) -> PResult<()> {
        let place = self.place();
        let symbol = token.link().map_or(u32::MAX, |l| l as u32);
        let name = self.symbols.text(crate::symbol::Symbol(symbol)).to_owned();
        if name.is_empty() {
            self.warn(place, "`#` without a directive after it has no effect");
            return Ok(());
        }
        // Settings that were directives up to version 2.2.
        if matches!(name.as_str(), "max_trace_level" | "max_intersections") {
            return self.old_setting(&name);
        }
        let known = Directive::ALL.iter().filter(|(_, text)| !text.is_empty());
        let close = closest(&name, known.map(|(_, text)| (Candidate::new(text), ())));
        let message = format!("there is no directive `#{name}`");
        Err(match close {
            Some((close, ())) => {
                self.fail_hint(place, message, format!("did you mean `#{close}`?"))
            }
            None => self.fail(place, message),
        })
    }
}
