use super::SourceFile;
use crate::lexer::Lexed;
use crate::symbol::Symbols;
use crate::token::Token;
use std::sync::Arc;
use strahl_scene::FileId;

/// The tokens of a part of a file, with no references into or out of it; most files are one chunk.
#[derive(Debug)]
pub(crate) struct Chunk {
    pub(crate) source: Arc<SourceFile>,
    /// The number of the file.
    pub(crate) file: FileId,
    pub(crate) lexed: Lexed,
}

impl Chunk {
    /// The smallest number of tokens in a chunk, unless the file ends before. With 16 bytes each they fit into the second-level
    /// cache.
    pub(crate) const TOKENS: usize = 8192;

    /// The first chunk of a file, with at least this many tokens.
    pub(crate) fn first(source: Arc<SourceFile>, tokens: usize, symbols: &mut Symbols) -> Self {
        // Measured on exported scenes: three to five bytes per token.
        let capacity = (source.length() / 3 + 16).min(tokens.saturating_add(tokens / 8));
        let space = Lexed {
            tokens: Vec::with_capacity(capacity),
            ..Lexed::default()
        };
        Self {
            file: source.id,
            lexed: source.lex(0, tokens, symbols, space),
            source,
        }
    }

    /// Replaces `this` by the next chunk, reusing its memory if nothing else refers to it; `false` at the end of the file.
    pub(crate) fn advance(this: &mut Arc<Self>, symbols: &mut Symbols) -> bool {
        let Some(begin) = this.lexed.rest else {
            return false;
        };
        let used = Arc::get_mut(this).map(|own| std::mem::take(&mut own.lexed));
        let source = Arc::clone(&this.source);
        let lexed = source.lex(begin, Self::TOKENS, symbols, used.unwrap_or_default());
        match Arc::get_mut(this) {
            Some(own) => own.lexed = lexed,
            None => {
                let file = source.id;
                *this = Arc::new(Self {
                    source,
                    file,
                    lexed,
                });
            }
        }
        true
    }

    /// The token at an index.
    #[inline]
    pub(crate) fn token(&self, index: usize) -> Option<Token> {
        self.lexed.tokens.get(index).copied()
    }

    /// The tokens from an index on.
    #[inline]
    pub(crate) fn tokens_from(&self, index: usize) -> &[Token] {
        self.lexed.tokens.get(index..).unwrap_or(&[])
    }

    /// Index of the last token, [`Kind::End`](crate::Kind::End).
    pub(crate) fn end(&self) -> usize {
        self.lexed.tokens.len().saturating_sub(1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::Source;
    use crate::token::Kind;

    #[test]
    fn chunks_follow_each_other_without_a_gap() {
        let object = "sphere { <1, 2, 3>, 4 pigment { rgb <0, 1, 0> } } // a\n";
        let mut text = object.repeat(2000);
        text.push_str("mesh2 { vertex_vectors { 9999");
        text.push_str(&", <1, 2, 3>".repeat(9999));
        text.push_str("} } #if (1)");
        text.push_str(&object.repeat(2000));
        text.push_str("#end box { 1, \"end\" }");
        let mut symbols = Symbols::new();
        let source = Arc::new(SourceFile::new(FileId(0), Source::new("a.pov", text)));
        let whole = Chunk::first(Arc::clone(&source), usize::MAX, &mut symbols);
        let mut chunk = Arc::new(Chunk::first(source, Chunk::TOKENS, &mut symbols));
        let first = Arc::clone(&chunk);
        let (mut tokens, mut lengths) = (vec![], vec![]);
        loop {
            assert_eq!(chunk.token(chunk.end()).unwrap().kind, Kind::End);
            tokens.extend((0..chunk.end()).filter_map(|i| chunk.token(i)));
            lengths.push(chunk.end());
            if !Chunk::advance(&mut chunk, &mut symbols) {
                break;
            }
        }
        assert_eq!(first.end(), lengths[0]);
        let short = lengths.iter().take(lengths.len() - 1);
        assert!(
            short.into_iter().all(|n| *n < Chunk::TOKENS + 50),
            "{lengths:?}"
        );
        assert!(lengths.len() > 5);
        // Links are indices within the chunk.
        for (a, b) in tokens.iter().zip(&whole.lexed.tokens) {
            assert_eq!((a.kind, a.start), (b.kind, b.start));
        }
        assert_eq!(tokens.len(), whole.end());
    }
}
