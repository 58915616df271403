//! Formulas written as formulas: terms with operators over a graph.

use crate::graph::{Expr, Graph};
use std::cell::RefCell;
use std::ops::{Add, Mul, Neg, Sub};

/// A value of a graph that `+`, `-` and `*` work on.
#[derive(Clone, Copy)]
pub(crate) struct Term<'a, 'g> {
    graph: &'a RefCell<&'g mut Graph>,
    pub(crate) expr: Expr,
}

impl<'a, 'g> Term<'a, 'g> {
    pub(crate) fn new(graph: &'a RefCell<&'g mut Graph>, expr: Expr) -> Self {
        Self { graph, expr }
    }

    /// Calls the builder; never while it is in use, since nothing here keeps the graph.
    fn with(self, build: impl FnOnce(&mut Graph) -> Expr) -> Self {
        let expr = build(&mut self.graph.borrow_mut());
        Self { expr, ..self }
    }

    pub(crate) fn number(self, value: f64) -> Self {
        self.with(|g| g.constant(value))
    }

    pub(crate) fn square(self) -> Self {
        self.with(|g| g.square(self.expr))
    }

    pub(crate) fn powi(self, exponent: u8) -> Self {
        self.with(|g| g.powi(self.expr, exponent))
    }

    pub(crate) fn pow(self, exponent: Self) -> Self {
        self.with(|g| g.pow(self.expr, exponent.expr))
    }

    pub(crate) fn sqrt(self) -> Self {
        self.with(|g| g.sqrt(self.expr))
    }

    pub(crate) fn abs(self) -> Self {
        self.with(|g| g.abs(self.expr))
    }

    pub(crate) fn exp(self) -> Self {
        self.with(|g| g.exp(self.expr))
    }

    pub(crate) fn floor(self) -> Self {
        self.with(|g| g.floor(self.expr))
    }

    pub(crate) fn sin(self) -> Self {
        self.with(|g| g.sin(self.expr))
    }

    pub(crate) fn cos(self) -> Self {
        self.with(|g| g.cos(self.expr))
    }

    pub(crate) fn atan2(self, x: Self) -> Self {
        self.with(|g| g.atan2(self.expr, x.expr))
    }

    pub(crate) fn radians(self) -> Self {
        self.with(|g| g.radians(self.expr))
    }

    pub(crate) fn over(self, divisor: Self) -> Self {
        self.with(|g| g.div(self.expr, divisor.expr))
    }

    /// The nearest whole number.
    pub(crate) fn round(self) -> Self {
        (self + 0.5).floor()
    }

    /// What remains of `self` after the nearest multiple of `period`.
    pub(crate) fn folded(self, period: Self) -> Self {
        self - period * self.over(period).round()
    }

    /// The size of what [`folded`](Self::folded) gives. It is continuous, and its bounds are tight.
    pub(crate) fn triangle(self, period: Self) -> Self {
        self.with(|g| g.triangle(self.expr, period.expr))
    }

    /// Whether this is a constant with that value.
    pub(crate) fn is(self, value: f64) -> bool {
        self.graph.borrow().known(self.expr) == Some(value)
    }

    pub(crate) fn min(self, other: Self) -> Self {
        self.with(|g| g.min(&[self.expr, other.expr]))
    }

    pub(crate) fn max(self, other: Self) -> Self {
        self.with(|g| g.max(&[self.expr, other.expr]))
    }

    /// `then` where `self` is above zero, else `otherwise`.
    pub(crate) fn if_positive(self, then: Self, otherwise: Self) -> Self {
        self.with(|g| g.select(self.expr, otherwise.expr, otherwise.expr, then.expr))
    }

    /// `then` where `self` is zero, else `otherwise`.
    pub(crate) fn if_zero(self, then: Self, otherwise: Self) -> Self {
        self.with(|g| g.select(self.expr, otherwise.expr, then.expr, otherwise.expr))
    }
}

macro_rules! operator {
    ($trait:ident, $method:ident, $build:ident) => {
        impl $trait for Term<'_, '_> {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                self.with(|g| g.$build(self.expr, other.expr))
            }
        }

        impl $trait<f64> for Term<'_, '_> {
            type Output = Self;
            fn $method(self, other: f64) -> Self {
                self.$method(self.number(other))
            }
        }
    };
}

operator!(Add, add, add);
operator!(Sub, sub, sub);
operator!(Mul, mul, mul);

impl Neg for Term<'_, '_> {
    type Output = Self;
    fn neg(self) -> Self {
        self.with(|g| g.neg(self.expr))
    }
}
