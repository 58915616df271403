use super::{PResult, Parser, Target};
use crate::token::Directive;

/// A block that is being executed.
#[derive(Debug)]
pub(crate) struct Block {
    pub(crate) kind: BlockKind,
    /// Index of the directive that opened it.
    pub(crate) opener: usize,
}

/// The kind of a block.
#[derive(Debug)]
pub(crate) enum BlockKind {
    /// `#if`, `#ifdef`, `#ifndef`
    If,
    /// `#switch`
    Switch,
    /// `#while`; its condition follows the opener.
    While,
    /// `#for`
    For(Box<Loop>),
}

/// The state of a `#for`.
#[derive(Debug)]
pub(crate) struct Loop {
    pub(crate) variable: Target,
    pub(crate) last: f64,
    pub(crate) step: f64,
    /// Index of the first token of the body.
    pub(crate) body: usize,
}

impl Parser<'_> {
    pub(crate) fn open_block(&mut self, kind: BlockKind, opener: usize) {
        self.blocks.push(Block { kind, opener });
    }

    /// The innermost block of the current frame.
    pub(crate) fn block(&self) -> Option<&Block> {
        let base = self.frames.last().map_or(0, |f| f.blocks);
        self.blocks.get(base..).and_then(<[Block]>::last)
    }

    pub(crate) fn close_block(&mut self) -> Option<Block> {
        self.block()?;
        self.blocks.pop()
    }

    /// Index of the directive that divides or ends the block at `index`.
    pub(crate) fn next_part(&mut self, index: usize) -> PResult<usize> {
        let token = self.file.token(index);
        if let Some(next) = token.and_then(|t| t.link()) {
            return Ok(next);
        }
        let place = token.map_or(self.place, |t| self.place_of(t));
        let word = token
            .and_then(|t| t.directive())
            .map_or("", Directive::text);
        let failed = self.fail_hint(
            place,
            format!("`#{word}` has no `#end`"),
            crate::lexer::UNCLOSED,
        );
        self.position = self.file.end();
        Err(failed)
    }

    /// Index of the `#end` of the block at `index`.
    pub(crate) fn end_of(&mut self, mut index: usize) -> PResult<usize> {
        loop {
            index = self.next_part(index)?;
            let token = self.file.token(index);
            if token.and_then(|t| t.directive()) == Some(Directive::End) {
                return Ok(index);
            }
        }
    }
}
