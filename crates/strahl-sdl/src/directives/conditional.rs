use crate::expr::is_true;
use crate::parser::{BlockKind, PResult, Parser};
use crate::token::{Directive, Kind};

impl Parser<'_> {
    /// `( expression )` as a truth value.
    pub(super) fn condition(&mut self) -> PResult<bool> {
        Ok(is_true(self.parenthesised_float()?))
    }

    pub(super) fn parenthesised_float(&mut self) -> PResult<f64> {
        self.expect(Kind::LeftParen)?;
        let place = self.place();
        let value = self.nested(Self::full_expression)?;
        self.expect(Kind::RightParen)?;
        self.as_float(value, place)
    }

    fn holds(&mut self, directive: Directive) -> PResult<bool> {
        match directive {
            Directive::Ifdef => self.is_defined(),
            Directive::Ifndef => Ok(!self.is_defined()?),
            _ => self.condition(),
        }
    }

    /// Runs `#if`, `#ifdef` or `#ifndef`, whose keyword is taken; `opener` is the index of the directive.
    pub(super) fn if_(&mut self, directive: Directive, opener: usize) -> PResult<()> {
        if self.holds(directive)? {
            self.open_block(BlockKind::If, opener);
            return Ok(());
        }
        let mut part = opener;
        loop {
            part = self.next_part(part)?;
            self.jump(part + 1);
            let token = self.current_file().token(part);
            match token.and_then(|t| t.directive()) {
                Some(Directive::Elseif) => {
                    if self.condition()? {
                        break;
                    }
                }
                Some(Directive::Else) => break,
                _ => return Ok(()),
            }
        }
        self.open_block(BlockKind::If, opener);
        Ok(())
    }

    /// A divider reached while running: the branch before it was taken, so the block ends; cases fall through.
    pub(super) fn divider(&mut self, directive: Directive, here: usize) -> PResult<()> {
        let Some(block) = self.block() else {
            return Err(self.stray(directive));
        };
        let in_switch = matches!(block.kind, BlockKind::Switch);
        match directive {
            Directive::Case if in_switch => self.parenthesised_float().map(|_| ()),
            Directive::Range if in_switch => self.range().map(|_| ()),
            Directive::Else if in_switch => Ok(()),
            Directive::Else | Directive::Elseif if matches!(block.kind, BlockKind::If) => {
                let end = self.end_of(here)?;
                self.close_block();
                self.jump(end + 1);
                Ok(())
            }
            _ => Err(self.stray(directive)),
        }
    }

    pub(super) fn stray(&mut self, directive: Directive) -> crate::parser::Failed {
        let (place, word) = (self.place(), directive.text());
        let block = match directive {
            Directive::Case | Directive::Range => "`#switch`",
            Directive::Break => "`#switch`, `#while` or `#for`",
            Directive::End => "block",
            _ => "`#if` or `#switch`",
        };
        self.fail(place, format!("`#{word}` does not belong to a {block}"))
    }

    fn range(&mut self) -> PResult<(f64, f64)> {
        self.expect(Kind::LeftParen)?;
        let low = self.float()?;
        self.comma()?;
        let high = self.float()?;
        self.expect(Kind::RightParen)?;
        Ok((low, high))
    }

    /// Runs `#switch`, whose keyword is taken.
    pub(super) fn switch(&mut self, opener: usize) -> PResult<()> {
        let value = self.parenthesised_float()?;
        let mut part = opener;
        loop {
            part = self.next_part(part)?;
            self.jump(part + 1);
            let token = self.current_file().token(part);
            let taken = match token.and_then(|t| t.directive()) {
                Some(Directive::Case) => crate::expr::equal(self.parenthesised_float()?, value),
                Some(Directive::Range) => {
                    let (low, high) = self.range()?;
                    low <= value && value <= high
                }
                Some(Directive::Else) => true,
                _ => return Ok(()),
            };
            if taken {
                self.open_block(BlockKind::Switch, opener);
                return Ok(());
            }
        }
    }

    /// Runs `#break`: leaves the innermost loop or switch.
    pub(super) fn break_(&mut self) -> PResult<()> {
        while let Some(block) = self.close_block() {
            if !matches!(block.kind, BlockKind::If) {
                let end = self.end_of(block.opener)?;
                self.jump(end + 1);
                return Ok(());
            }
        }
        Err(self.stray(Directive::Break))
    }
}
