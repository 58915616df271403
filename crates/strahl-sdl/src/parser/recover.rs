use super::{Floor, Parser};
use crate::grammar;
use crate::source::Chunk;
use crate::token::{Directive, Kind};

/// The beginning of a statement, needed to continue after an error in it.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Mark {
    frames: usize,
    blocks: usize,
    position: usize,
    file: u32,
    /// The number of braces that the statement has opened in earlier chunks of the file.
    open: usize,
}

impl Parser<'_> {
    /// Records that a statement begins here, or that only directives are read until one begins.
    pub(crate) fn between_statements(&mut self, between: bool) {
        self.between = between;
        self.mark_here();
    }

    /// Records the beginning of a statement, which is abandoned as a whole if it fails.
    pub(super) fn mark_here(&mut self) {
        self.mark = Mark {
            frames: self.frames.len(),
            blocks: self.blocks.len(),
            position: self.position,
            file: self.file.file.0,
            open: 0,
        };
    }

    /// Called before running a directive: between statements it is abandoned alone.
    pub(crate) fn mark_directive(&mut self) {
        if self.between && self.floor.frames == 0 {
            self.mark_here();
        }
    }

    /// Continues with the next chunk of the file; `false` at its end.
    pub(super) fn next_chunk(&mut self) -> bool {
        if self.file.lexed.rest.is_none() {
            return false;
        }
        let end = self.file.end();
        if self.mark.frames == self.frames.len() && self.mark.file == self.file.file.0 {
            self.mark.open = self.open_after(self.mark.open, self.mark.position, end);
            self.mark.position = 0;
        }
        if !Chunk::advance(&mut self.file, &mut self.symbols) {
            return false;
        }
        self.position = 0;
        self.made_progress();
        let problems = self.file.lexed.problems.clone();
        self.report_lexing(self.file.file.0, problems);
        true
    }

    /// The number of open braces after some tokens of the chunk, with `open` before them.
    fn open_after(&self, open: usize, from: usize, to: usize) -> usize {
        let passed = self.file.lexed.tokens.get(from..to).unwrap_or(&[]);
        passed.iter().fold(open, |open, t| match t.kind {
            Kind::LeftBrace => open + 1,
            Kind::RightBrace => open.saturating_sub(1),
            _ => open,
        })
    }

    /// Continues after the statement or directive that failed.
    ///
    /// Leaves the macros and includes entered since its beginning; then skips everything up to the brace that closes the
    /// statement, or the next word or directive that opens one. Blocks in the skipped part are skipped as a whole.
    pub(crate) fn recover(&mut self) {
        let mark = self.mark;
        while self.frames.len() > mark.frames.max(1) {
            self.leave_frame();
        }
        self.nesting = 0;
        self.brace_taken = false;
        self.stopping = false;
        self.value_nesting = None;
        self.floor = Floor::default();
        self.open_braces = 0;
        let same = mark.file == self.file.file.0 && mark.frames == self.frames.len();
        let begin = if same { mark.position } else { self.position };
        if same && begin == self.position && self.raw().kind != Kind::End {
            // At least one token is skipped, or the error would repeat forever.
            self.position += 1;
        }
        // A block whose head failed is skipped as a whole, because its parts make no sense without the head.
        let head = self.current_file().token(begin).and_then(|t| t.directive());
        if same && self.blocks.len() <= mark.blocks && head.is_some_and(Directive::opens) {
            if let Ok(end) = self.end_of(begin) {
                self.position = end + 1;
            }
            return;
        }
        let before = if same { mark.open } else { 0 };
        let mut open = self.open_after(before, begin, self.position);
        // Blocks that the statement has opened end within the skipped part.
        let mut blocks = self.blocks.len().saturating_sub(mark.blocks);
        self.blocks.truncate(mark.blocks);
        loop {
            let token = self.raw();
            match token.kind {
                Kind::End => {
                    if !self.next_chunk() {
                        return;
                    }
                    continue;
                }
                Kind::LeftBrace => open += 1,
                Kind::RightBrace if open <= 1 => {
                    self.position += 1;
                    return;
                }
                Kind::RightBrace => open -= 1,
                Kind::Word if open == 0 && blocks == 0 && grammar::opens_statement(token) => return,
                Kind::Directive => match token.directive() {
                    Some(Directive::End) if blocks > 0 => blocks -= 1,
                    Some(d)
                        if (d.divides() || d == Directive::End)
                            && blocks == 0
                            && (self.block().is_some() || self.at_macro_end()) =>
                    {
                        return;
                    }
                    Some(d) if open == 0 && blocks == 0 && !d.divides() => return,
                    Some(d) if d.opens() => match self.end_of(self.position) {
                        Ok(end) => self.position = end,
                        Err(_) => return,
                    },
                    _ => {}
                },
                _ => {}
            }
            self.position += 1;
            self.steps += 1;
        }
    }
}
