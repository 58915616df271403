//! Sums and products over a counter.

use super::{Expr, Graph, Loop, Node};
use crate::error::FunctionError;
use crate::limits;
use crate::op::BinaryOp;

impl Graph {
    /// A new loop variable, to be used in the body of one [`sum`](Self::sum) or [`prod`](Self::prod).
    pub fn loop_variable(&mut self) -> Expr {
        self.variables = self.variables.saturating_add(1);
        self.push(Node::Variable(self.variables - 1))
    }

    /// The sum of `body` for `variable` = `from`, `from + 1`, ... as long as it is not above `to`; 0 if it is at once.
    pub fn sum(&mut self, variable: Expr, from: Expr, to: Expr, body: Expr) -> Expr {
        self.repeat(false, variable, from, to, body)
    }

    /// The product, like [`sum`](Self::sum); 1 if there is no factor.
    pub fn prod(&mut self, variable: Expr, from: Expr, to: Expr, body: Expr) -> Expr {
        self.repeat(true, variable, from, to, body)
    }

    pub(super) fn repeat(
        &mut self,
        product: bool,
        counter: Expr,
        from: Expr,
        to: Expr,
        body: Expr,
    ) -> Expr {
        let Some(&Node::Variable(variable)) = self.nodes.get(counter.0 as usize) else {
            return self.fail(FunctionError::UnboundVariable);
        };
        if self.depends_on(from, variable) || self.depends_on(to, variable) {
            return self.fail(FunctionError::UnboundVariable);
        }
        if let (Some(from), Some(to)) = (self.known(from), self.known(to)) {
            // Short loops are written out, with the additions a loop would do.
            let rounds = to - from;
            let size = self.reachable(body).len();
            self.work = self.work.saturating_add(size as u64);
            let size = size as f64;
            if !(rounds >= 0.0) || (rounds < 256.0 && rounds * size < limits::UNROLL as f64) {
                return self.unroll(product, counter, from, to, body);
            }
        }
        self.push(Node::Loop(Loop {
            product,
            variable,
            from,
            to,
            body,
        }))
    }

    fn unroll(&mut self, product: bool, counter: Expr, from: f64, to: f64, body: Expr) -> Expr {
        let (op, neutral) = if product {
            (BinaryOp::Mul, 1.0)
        } else {
            (BinaryOp::Add, 0.0)
        };
        let mut total = self.constant(neutral);
        let mut i = from;
        while i <= to {
            let value = self.constant(i);
            let term = self.replace(body, counter, value);
            total = self.binary(op, total, term);
            i += 1.0;
        }
        total
    }
}
