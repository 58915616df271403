//! Copies of expressions with replacements.

use super::{Expr, Graph, List, Node};
use crate::error::FunctionError;
use std::collections::HashMap;

impl Graph {
    /// `root` with `counter` replaced by `value`.
    pub(super) fn replace(&mut self, root: Expr, counter: Expr, value: Expr) -> Expr {
        let Node::Variable(variable) = self.node(counter) else {
            return root;
        };
        let mut image: HashMap<Expr, Expr> = HashMap::from([(counter, value)]);
        for e in self.reachable(root) {
            if e != counter && self.depends_on(e, variable) {
                let copy = self.rebuild(self.node(e), |c| image.get(&c).copied().unwrap_or(c));
                image.insert(e, copy);
            }
        }
        image.get(&root).copied().unwrap_or(root)
    }

    /// A node of this graph with other operands, simplified anew.
    fn rebuild(&mut self, node: Node, to: impl Fn(Expr) -> Expr) -> Expr {
        match node {
            Node::Constant(_) | Node::Parameter(_) | Node::Variable(_) => self.push(node),
            Node::Unary(op, a) => self.unary(op, to(a)),
            Node::Binary(op, a, b) => self.binary(op, to(a), to(b)),
            Node::Select(s, n, z, p) => self.select(to(s), to(n), to(z), to(p)),
            Node::Field(id, list) => {
                let arguments: Vec<Expr> = self.arguments(list).iter().map(|&a| to(a)).collect();
                let list = self.list(&arguments);
                self.push(Node::Field(id, list))
            }
            Node::Call(id, list) => {
                let arguments: Vec<Expr> = self.arguments(list).iter().map(|&a| to(a)).collect();
                let list = self.list(&arguments);
                self.push(Node::Call(id, list))
            }
            Node::Loop(l) => {
                let counter = self.push(Node::Variable(l.variable));
                self.repeat(l.product, counter, to(l.from), to(l.to), to(l.body))
            }
        }
    }

    /// Copies an expression of another graph with its parameters replaced.
    pub(crate) fn inline(&mut self, source: &Self, root: Expr, arguments: &[Expr]) -> Expr {
        let base = self.variables;
        self.variables = self.variables.saturating_add(source.variables);
        let mut image: HashMap<Expr, Expr> = HashMap::new();
        for e in source.reachable(root) {
            let to = |c: Expr| image.get(&c).copied().unwrap_or(Expr(u32::MAX));
            let many = |list: List| -> Vec<Expr> {
                source.arguments(list).iter().map(|&a| to(a)).collect()
            };
            let copy = match source.node(e) {
                Node::Parameter(i) => match arguments.get(i as usize) {
                    Some(&a) => a,
                    None => self.fail(FunctionError::ForeignExpression),
                },
                Node::Variable(v) => self.push(Node::Variable(base.saturating_add(v))),
                Node::Field(id, list) => match source.field_at(id) {
                    Some(field) => self.field(field, &many(list)),
                    None => self.fail(FunctionError::ForeignExpression),
                },
                Node::Call(id, list) => match source.callee_at(id) {
                    Some(callee) => self.call_tape(callee, &many(list)),
                    None => self.fail(FunctionError::ForeignExpression),
                },
                Node::Loop(l) => {
                    let counter = self.push(Node::Variable(base.saturating_add(l.variable)));
                    self.repeat(l.product, counter, to(l.from), to(l.to), to(l.body))
                }
                node => self.rebuild(node, to),
            };
            image.insert(e, copy);
        }
        match image.get(&root) {
            Some(&e) => e,
            None => self.fail(FunctionError::ForeignExpression),
        }
    }
}
