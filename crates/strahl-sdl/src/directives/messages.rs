use crate::parser::{PResult, Parser};
use crate::source::Stream;
use crate::token::Directive;

impl Parser<'_> {
    /// Runs `#debug`, `#render`, `#statistics`, `#warning` or `#error`, whose keyword is taken.
    pub(super) fn message(&mut self, directive: Directive) -> PResult<()> {
        let place = self.place();
        let text = self.string()?;
        match directive {
            Directive::Error => Err(self.fail_fatally(
                place,
                format!("the scene says: {}", text.trim_end()),
                "the scene stops here with `#error`",
            )),
            Directive::Warning => {
                self.warn(place, format!("the scene says: {}", text.trim_end()));
                self.send(place, Stream::Warning, &text)
            }
            Directive::Render => self.send(place, Stream::Render, &text),
            Directive::Statistics => self.send(place, Stream::Statistics, &text),
            _ => self.send(place, Stream::Debug, &text),
        }
    }
}
