use crate::parser::{BlockKind, Loop, PResult, Parser};
use crate::token::{Directive, Kind};
use crate::value::Value;

impl Parser<'_> {
    /// Runs `#while`, whose keyword is taken.
    pub(super) fn while_(&mut self, opener: usize) -> PResult<()> {
        if self.condition()? {
            self.open_block(BlockKind::While, opener);
        } else {
            let end = self.end_of(opener)?;
            self.jump(end + 1);
        }
        Ok(())
    }

    /// Runs `#for (Name, first, last [, step])`, whose keyword is taken. The variable stays declared after the loop.
    pub(super) fn for_(&mut self, opener: usize) -> PResult<()> {
        self.expect(Kind::LeftParen)?;
        let symbol = self.raw_name("the variable of the loop")?;
        let variable = self.local_target(symbol);
        self.comma()?;
        let first = self.float()?;
        self.comma()?;
        let last = self.float()?;
        self.comma()?;
        let token = self.peek()?;
        let step = if token.kind == Kind::RightParen {
            1.0
        } else {
            self.float()?
        };
        self.expect(Kind::RightParen)?;
        if step == 0.0 || step.is_nan() {
            let place = self.place();
            return Err(self.fail_hint(
                place,
                format!("the step of a loop must not be {step}"),
                "the loop would not end; write a number that leads from the first value to the last",
            ));
        }
        self.scopes.store(&variable, Value::Float(first));
        let state = Loop {
            variable,
            last,
            step,
            body: self.position(),
        };
        if state.goes_on(first) {
            self.open_block(BlockKind::For(Box::new(state)), opener);
        } else {
            let end = self.end_of(opener)?;
            self.jump(end + 1);
        }
        Ok(())
    }

    /// `#end` at index `here`: ends a branch, or goes back to the head of a loop.
    pub(super) fn end(&mut self, here: usize) -> PResult<()> {
        let Some(block) = self.close_block() else {
            return Err(self.stray(Directive::End));
        };
        match block.kind {
            BlockKind::If | BlockKind::Switch => Ok(()),
            BlockKind::While => {
                self.jump(block.opener + 1);
                if self.condition()? {
                    self.open_block(BlockKind::While, block.opener);
                } else {
                    self.jump(here + 1);
                }
                Ok(())
            }
            BlockKind::For(state) => {
                let Some(Value::Float(value)) = self.scopes.at(&state.variable) else {
                    let place = self.place();
                    return Err(self.fail(place, "the variable of the loop is no longer a float"));
                };
                let next = value + state.step;
                self.scopes.store(&state.variable, Value::Float(next));
                if state.goes_on(next) {
                    self.jump(state.body);
                    self.open_block(BlockKind::For(state), block.opener);
                }
                Ok(())
            }
        }
    }
}

impl Loop {
    /// Whether the body runs for this value. The last value counts as reached within 1e-10, so that rounding of steps like 0.1
    /// does not matter.
    fn goes_on(&self, value: f64) -> bool {
        const TOLERANCE: f64 = 1e-10;
        if self.step > 0.0 {
            value <= self.last + TOLERANCE
        } else {
            value >= self.last - TOLERANCE
        }
    }
}
