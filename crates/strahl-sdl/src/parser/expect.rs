use super::{PResult, Parser};
use crate::keywords::Word;
use crate::symbol::Symbol;
use crate::token::{Kind, Token};

impl Parser<'_> {
    /// Takes the next token if it is of this kind.
    ///
    /// # Errors
    /// If a directive before it fails.
    #[inline]
    pub fn accept(&mut self, kind: Kind) -> PResult<bool> {
        let token = self.peek()?;
        let found = token.kind == kind;
        if found {
            self.take(token)?;
        }
        Ok(found)
    }

    /// Takes the next token, which must be of this kind.
    ///
    /// # Errors
    /// If it is of another kind.
    #[inline]
    pub fn expect(&mut self, kind: Kind) -> PResult<Token> {
        let token = self.peek()?;
        if token.kind != kind {
            return Err(self.unexpected(token, kind.describe()));
        }
        self.take(token)?;
        Ok(token)
    }

    /// Takes the next token if it is this word.
    ///
    /// # Errors
    /// If a directive before it fails.
    #[inline]
    pub fn accept_word(&mut self, word: Word) -> PResult<bool> {
        let token = self.peek()?;
        let found = token.is(word);
        if found {
            self.take(token)?;
        }
        Ok(found)
    }

    /// Takes a comma if there is one: the language allows most of them to be omitted.
    ///
    /// # Errors
    /// If a directive before it fails.
    #[inline]
    pub fn comma(&mut self) -> PResult<()> {
        self.accept(Kind::Comma).map(|_| ())
    }

    /// Reads `{`, then by `f` the content, then `}`.
    ///
    /// # Errors
    /// If a brace is missing, braces are nested too deep, or `f` fails.
    #[inline]
    pub fn braces<T>(&mut self, f: impl FnOnce(&mut Self) -> PResult<T>) -> PResult<T> {
        if !std::mem::take(&mut self.brace_taken) {
            self.expect(Kind::LeftBrace)?;
        }
        self.nested(|p| {
            let result = f(p)?;
            p.expect(Kind::RightBrace)?;
            Ok(result)
        })
    }

    /// The first token after the `{` that follows, without taking it. Directives and macro calls before it are run, for which the brace
    /// must be taken: the next [`Parser::braces`] continues after it.
    ///
    /// # Errors
    /// If there is no brace, or a directive after it fails.
    pub(crate) fn peek_into_braces(&mut self) -> PResult<Token> {
        let open = self.peek()?;
        if open.kind != Kind::LeftBrace {
            return Err(self.unexpected(open, Kind::LeftBrace.describe()));
        }
        let next = self.raw_ahead(1);
        let unfolds = match (next.kind, next.symbol()) {
            (Kind::Name, Some(symbol)) => self.scopes.find_macro(symbol).is_some(),
            (kind, _) => matches!(kind, Kind::Directive | Kind::End),
        };
        if !unfolds {
            return Ok(next);
        }
        self.take(open)?;
        // Directives before it read braces of their own.
        let token = self.peek()?;
        self.brace_taken = true;
        Ok(token)
    }

    /// Reads items with `f` until the closing brace, which is not taken; `f` gets the word or token that opens the item, not yet
    /// taken.
    ///
    /// # Errors
    /// If the text ends before the brace, or `f` fails.
    pub fn items(
        &mut self,
        what: &str,
        f: impl FnMut(&mut Self, Token) -> PResult<()>,
    ) -> PResult<()> {
        self.items_until(Kind::RightBrace, what, f)
    }

    /// [`Parser::items`] with another closing token than `}`.
    ///
    /// # Errors
    /// If the text ends before that token, or `f` fails.
    pub(crate) fn items_until(
        &mut self,
        closing: Kind,
        what: &str,
        mut f: impl FnMut(&mut Self, Token) -> PResult<()>,
    ) -> PResult<()> {
        loop {
            let token = self.peek()?;
            if token.kind == closing {
                return Ok(());
            }
            match token.kind {
                Kind::End => {
                    let closing = closing.describe();
                    return Err(self.unexpected(token, &format!("{closing} at the end of {what}")));
                }
                // Extra separators between items are harmless.
                Kind::Comma | Kind::Semicolon => self.take(token)?,
                _ => {
                    let before = (self.steps, self.position);
                    f(self, token)?;
                    // An item that takes no token would be read forever.
                    if before == (self.steps, self.position) {
                        return Err(self.unexpected(token, &format!("an item of {what}")));
                    }
                }
            }
        }
    }

    /// Takes a name without evaluating it: the name after `#declare` or `#macro`.
    pub(crate) fn raw_name(&mut self, what: &str) -> PResult<Symbol> {
        let token = self.raw();
        let symbol = self.as_name(token, what)?;
        self.take(token)?;
        Ok(symbol)
    }

    /// Takes a name that is only asked for, as by `#ifdef`.
    pub(crate) fn asked_name(&mut self, what: &str) -> PResult<Symbol> {
        let token = self.raw();
        let symbol = self.as_name(token, what)?;
        self.take_unused(token);
        Ok(symbol)
    }

    /// The name that a token is.
    fn as_name(&mut self, token: Token, what: &str) -> PResult<Symbol> {
        match (token.kind, token.symbol()) {
            (Kind::Name, Some(symbol)) => Ok(symbol),
            (Kind::Word, Some(_)) => {
                let word = self.describe(token);
                let place = self.place_of(token);
                let message = format!("{word} is a keyword and cannot be {what}");
                Err(self.fail_hint(
                    place,
                    message,
                    "use another name: names with a capital first letter are never keywords",
                ))
            }
            _ => {
                let found = self.describe(token);
                let place = self.place_of(token);
                Err(self.fail(place, format!("expected {what}, found {found}")))
            }
        }
    }

    /// Takes the next raw token if it is of this kind.
    pub(crate) fn raw_accept(&mut self, kind: Kind) -> PResult<bool> {
        let token = self.raw();
        let found = token.kind == kind;
        if found {
            self.take(token)?;
        }
        Ok(found)
    }
}
