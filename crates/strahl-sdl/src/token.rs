//! Tokens, the output of the lexer.

use crate::keywords::Word;
use crate::symbol::Symbol;

/// The kind of a token. The order matters: everything below [`Kind::Name`] is passed to the grammar unchanged.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub enum Kind {
    /// An unsigned number.
    Number,
    /// A string in quotation marks.
    String,
    /// A reserved word.
    Word,
    /// `{`
    LeftBrace,
    /// `}`
    RightBrace,
    /// `(`
    LeftParen,
    /// `)`
    RightParen,
    /// `<`
    Less,
    /// `>`
    Greater,
    /// `<=`
    LessEqual,
    /// `>=`
    GreaterEqual,
    /// `=`
    Equal,
    /// `!=`
    NotEqual,
    /// `[`
    LeftBracket,
    /// `]`
    RightBracket,
    /// `,`
    Comma,
    /// `;`
    Semicolon,
    /// `.`
    Dot,
    /// `+`
    Plus,
    /// `-`
    Minus,
    /// `*`
    Star,
    /// `/`
    Slash,
    /// `^`
    Caret,
    /// `!`
    Bang,
    /// `?`
    Question,
    /// `:`
    Colon,
    /// `&`
    Ampersand,
    /// `|`
    Bar,
    /// A character without a meaning in the language.
    Unknown,
    /// A name: a variable, or a macro to be called.
    Name,
    /// `#` with the word after it.
    Directive,
    /// The end of the file (or of the part that a directive may read).
    End,
}

impl Kind {
    /// The token in words, for messages.
    pub(crate) fn describe(self) -> &'static str {
        match self {
            Self::Number => "a number",
            Self::String => "a string",
            Self::Word => "a reserved word",
            Self::LeftBrace => "`{`",
            Self::RightBrace => "`}`",
            Self::LeftParen => "`(`",
            Self::RightParen => "`)`",
            Self::Less => "`<`",
            Self::Greater => "`>`",
            Self::LessEqual => "`<=`",
            Self::GreaterEqual => "`>=`",
            Self::Equal => "`=`",
            Self::NotEqual => "`!=`",
            Self::LeftBracket => "`[`",
            Self::RightBracket => "`]`",
            Self::Comma => "`,`",
            Self::Semicolon => "`;`",
            Self::Dot => "`.`",
            Self::Plus => "`+`",
            Self::Minus => "`-`",
            Self::Star => "`*`",
            Self::Slash => "`/`",
            Self::Caret => "`^`",
            Self::Bang => "`!`",
            Self::Question => "`?`",
            Self::Colon => "`:`",
            Self::Ampersand => "`&`",
            Self::Bar => "`|`",
            Self::Unknown => "an invalid character",
            Self::Name => "a name",
            Self::Directive => "a directive",
            Self::End => "the end of the file",
        }
    }
}

/// One token in 16 bytes. Its length is determined again from the text if a message needs it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Token {
    /// Its kind.
    pub kind: Kind,
    /// Byte offset in the file.
    pub(crate) start: u32,
    /// Number: the bits of its value. Word, name: the symbol. String: its index. Directive: see [`Token::directive`].
    pub(crate) bits: u64,
}

impl Token {
    pub(crate) const END: Self = Self {
        kind: Kind::End,
        start: 0,
        bits: 0,
    };

    /// The value of a number; 0 for other tokens.
    pub fn number(self) -> f64 {
        match self.kind {
            Kind::Number => f64::from_bits(self.bits),
            _ => 0.0,
        }
    }

    /// The reserved word.
    pub fn word(self) -> Option<Word> {
        match self.kind {
            Kind::Word => Word::from_number(self.bits),
            _ => None,
        }
    }

    /// The symbol of a name or word.
    pub fn symbol(self) -> Option<Symbol> {
        matches!(self.kind, Kind::Word | Kind::Name).then_some(Symbol(self.bits as u32))
    }

    /// Whether it is this reserved word.
    pub fn is(self, word: Word) -> bool {
        self.kind == Kind::Word && self.bits == word as u64
    }

    pub(crate) fn new_directive(start: u32, directive: Directive) -> Self {
        Self {
            kind: Kind::Directive,
            start,
            bits: directive as u64 | (u64::from(u32::MAX) << 32),
        }
    }

    /// The directive.
    pub(crate) fn directive(self) -> Option<Directive> {
        let known = Directive::ALL.get((self.bits & 0xff) as usize);
        known
            .copied()
            .filter(|_| self.kind == Kind::Directive)
            .map(|(directive, _)| directive)
    }

    /// For directives that open or divide a block: the index of the directive that continues the block (`#else`, `#case`, ...) or
    /// ends it; `None` if the file ends before.
    pub(crate) fn link(self) -> Option<usize> {
        let link = (self.bits >> 32) as u32;
        (link != u32::MAX).then_some(link as usize)
    }

    pub(crate) fn set_link(&mut self, index: usize) {
        self.bits = (self.bits & 0xffff_ffff) | ((index as u64) << 32);
    }
}

macro_rules! directives {
    ($($name:ident $text:literal)*) => {
        /// The directives.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[repr(u8)]
        pub(crate) enum Directive { $($name),* }

        impl Directive {
            /// All directives with the word after the `#`.
            pub(crate) const ALL: &'static [(Self, &'static str)] = &[$((Self::$name, $text)),*];
        }
    };
}

directives! {
    Break "break"
    Case "case"
    Debug "debug"
    Declare "declare"
    Default "default"
    Else "else"
    Elseif "elseif"
    End "end"
    Error "error"
    Fclose "fclose"
    Fopen "fopen"
    For "for"
    If "if"
    Ifdef "ifdef"
    Ifndef "ifndef"
    Include "include"
    Local "local"
    Macro "macro"
    Range "range"
    Read "read"
    Render "render"
    Statistics "statistics"
    Switch "switch"
    Undef "undef"
    Version "version"
    Warning "warning"
    While "while"
    Write "write"
    Unknown ""
}

impl Directive {
    /// The directive named by the word after a `#`.
    pub(crate) fn from_text(text: &str) -> Self {
        let known = Self::ALL.binary_search_by(|(_, t)| {
            // The nameless last row matches all other words.
            if t.is_empty() {
                std::cmp::Ordering::Greater
            } else {
                (*t).cmp(text)
            }
        });
        known.map_or(Self::Unknown, |index| Self::ALL[index].0)
    }

    /// The word after the `#`.
    pub(crate) fn text(self) -> &'static str {
        Self::ALL[self as usize].1
    }

    /// Whether it opens a block that `#end` closes.
    pub(crate) fn opens(self) -> bool {
        matches!(
            self,
            Self::If
                | Self::Ifdef
                | Self::Ifndef
                | Self::While
                | Self::For
                | Self::Switch
                | Self::Macro
        )
    }

    /// Whether it divides a block.
    pub(crate) fn divides(self) -> bool {
        matches!(self, Self::Else | Self::Elseif | Self::Case | Self::Range)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directives_are_found_by_their_words() {
        for (directive, text) in Directive::ALL {
            assert_eq!(Directive::from_text(text), *directive, "{text}");
            let token = Token::new_directive(7, *directive);
            assert_eq!((token.directive(), token.link()), (Some(*directive), None));
        }
        assert_eq!(Directive::from_text("declared"), Directive::Unknown);
    }

    #[test]
    fn tokens_stay_small() {
        assert_eq!(size_of::<Token>(), 16);
        assert_eq!(size_of::<Result<Token, ()>>(), 16);
    }
}
