//! Functions that are polynomials, or whose sign polynomials decide.

use crate::function::Function;
use crate::graph::{Expr, Graph, Node};
use crate::op::{BinaryOp, UnaryOp};
use std::collections::{BTreeMap, HashMap};

/// The highest degree: above it, sums of powers lose too many digits.
const DEGREE: u8 = 12;

/// The most polynomials that decide together.
const POLYNOMIALS: usize = 8;

/// The most operations that are looked at.
const OPERATIONS: usize = 500;

/// The terms of a polynomial in three coordinates: the powers of x, y and z, and a coefficient.
pub type Terms = Vec<([u32; 3], f64)>;

/// A region of space that polynomials describe.
#[derive(Clone, Debug, PartialEq)]
pub enum Region {
    /// Where a polynomial is negative.
    Negative(Terms),
    /// What all of some regions share.
    All(Vec<Region>),
    /// All of some regions together.
    Any(Vec<Region>),
}

impl Function {
    /// Where the function of x, y and z is below a threshold, if polynomials in the coordinates relative to a center decide that: those of a
    /// degree up to 12, and minima, maxima, absolute values, roots and multiples of them.
    ///
    /// The coefficients are rounded, so values differ from the function's by rounding errors. Where a root is taken of a negative number the
    /// function is no number, but the region may contain the place: ask [`Function::bounds`] whether there are such places.
    pub fn region_below(&self, threshold: f64, center: [f64; 3]) -> Option<Region> {
        let (graph, root) = self.formula();
        if graph.parameters().len() != 3 || self.size() > OPERATIONS {
            return None;
        }
        let mut expansion = Expansion {
            graph,
            center,
            known: HashMap::new(),
            left: POLYNOMIALS,
        };
        expansion.region(
            root,
            Side {
                threshold,
                below: true,
            },
        )
    }
}

/// The numbers on one side of a threshold.
#[derive(Clone, Copy)]
struct Side {
    threshold: f64,
    below: bool,
}

impl Side {
    /// The same for numbers that are put through a rising function, or a falling one.
    fn through(self, map: impl Fn(f64) -> f64, rising: bool) -> Self {
        Self {
            threshold: map(self.threshold),
            below: self.below == rising,
        }
    }

    fn contains(self, number: f64) -> bool {
        if self.below {
            number < self.threshold
        } else {
            number > self.threshold
        }
    }
}

/// A polynomial on its way, without terms that are zero.
#[derive(Clone, Debug, Default)]
struct Polynomial(BTreeMap<[u8; 3], f64>);

impl Polynomial {
    fn constant(c: f64) -> Self {
        Self([([0; 3], c)].into())
    }

    /// `c + x`, where `x` is a coordinate.
    fn coordinate(axis: usize, c: f64) -> Self {
        let mut powers = [0; 3];
        powers[axis] = 1;
        Self([([0; 3], c), (powers, 1.0)].into())
    }

    fn as_constant(&self) -> Option<f64> {
        let mut terms = self.0.iter();
        match (terms.next(), terms.next()) {
            (None, _) => Some(0.0),
            (Some(([0, 0, 0], c)), None) => Some(*c),
            _ => None,
        }
    }

    fn degree(&self) -> u8 {
        let degrees = self.0.keys().map(|[x, y, z]| x + y + z);
        degrees.max().unwrap_or(0)
    }

    /// The sum with a multiple.
    fn plus(mut self, factor: f64, other: &Self) -> Self {
        for (powers, c) in &other.0 {
            *self.0.entry(*powers).or_default() += factor * c;
        }
        self.0.retain(|_, c| *c != 0.0);
        self
    }

    fn scaled(&self, factor: f64) -> Self {
        Self::default().plus(factor, self)
    }

    /// The product, unless its degree is too high.
    fn times(&self, other: &Self) -> Option<Self> {
        if self.degree() + other.degree() > DEGREE {
            return None;
        }
        let mut product = Self::default();
        for ([x, y, z], c) in &self.0 {
            for ([i, j, k], d) in &other.0 {
                *product.0.entry([x + i, y + j, z + k]).or_default() += c * d;
            }
        }
        product.0.retain(|_, c| *c != 0.0);
        Some(product)
    }

    fn power(&self, exponent: u8) -> Option<Self> {
        if u32::from(self.degree()) * u32::from(exponent) > u32::from(DEGREE) {
            return None;
        }
        (0..exponent).try_fold(Self::constant(1.0), |product, _| product.times(self))
    }

    fn into_terms(self) -> Terms {
        let terms = self.0.into_iter();
        terms
            .map(|(powers, c)| (powers.map(u32::from), c))
            .collect()
    }
}

/// Expands the nodes of a graph.
struct Expansion<'a> {
    graph: &'a Graph,
    center: [f64; 3],
    known: HashMap<Expr, Option<Polynomial>>,
    /// So many polynomials more may decide.
    left: usize,
}

impl Expansion<'_> {
    /// Where the value of a node is on one side of a threshold.
    fn region(&mut self, node: Expr, side: Side) -> Option<Region> {
        if !side.threshold.is_finite() {
            return None;
        }
        if let Some(polynomial) = self.polynomial(node) {
            self.left = self.left.checked_sub(1)?;
            let mut difference = polynomial.plus(-1.0, &Polynomial::constant(side.threshold));
            if !side.below {
                difference = difference.scaled(-1.0);
            }
            let is_usable =
                difference.as_constant().is_none() && difference.0.values().all(|c| c.is_finite());
            return is_usable.then(|| Region::Negative(difference.into_terms()));
        }
        match self.graph.node(node) {
            Node::Unary(op, a) => self.region_of_unary(op, a, side),
            Node::Binary(op @ (BinaryOp::Min | BinaryOp::Max), a, b) => {
                self.region_of_either((a, b), op == BinaryOp::Min, side)
            }
            Node::Binary(op, a, b) => match (op, self.constant(a), self.constant(b)) {
                (BinaryOp::Add, None, Some(c)) => self.region(a, side.through(|t| t - c, true)),
                (BinaryOp::Add, Some(c), None) => self.region(b, side.through(|t| t - c, true)),
                (BinaryOp::Sub, None, Some(c)) => self.region(a, side.through(|t| t + c, true)),
                (BinaryOp::Sub, Some(c), None) => self.region(b, side.through(|t| c - t, false)),
                (BinaryOp::Mul, None, Some(c)) | (BinaryOp::Mul, Some(c), None) => {
                    let factor = if self.constant(a).is_some() { b } else { a };
                    self.region(factor, side.through(|t| t / c, c > 0.0))
                }
                (BinaryOp::Div, None, Some(c)) => self.region(a, side.through(|t| t * c, c > 0.0)),
                _ => None,
            },
            _ => None,
        }
    }

    fn region_of_unary(&mut self, op: UnaryOp, a: Expr, side: Side) -> Option<Region> {
        let is_positive = side.threshold > 0.0;
        match op {
            UnaryOp::Neg => self.region(a, side.through(|t| -t, false)),
            UnaryOp::Sqrt if is_positive => self.region(a, side.through(|t| t * t, true)),
            UnaryOp::Square if is_positive => self.region_of_size(a, side.through(f64::sqrt, true)),
            UnaryOp::Abs if is_positive => self.region_of_size(a, side),
            _ => None,
        }
    }

    /// Where the absolute value of a node is on one side of a positive threshold.
    fn region_of_size(&mut self, a: Expr, side: Side) -> Option<Region> {
        let parts = vec![
            self.region(a, side)?,
            self.region(a, side.through(|t| -t, false))?,
        ];
        Some(if side.below {
            Region::All(parts)
        } else {
            Region::Any(parts)
        })
    }

    /// Where the smaller or the greater one of two nodes is on one side of a threshold.
    fn region_of_either(
        &mut self,
        (a, b): (Expr, Expr),
        smaller: bool,
        side: Side,
    ) -> Option<Region> {
        let is_any = smaller == side.below;
        for (number, other) in [(a, b), (b, a)] {
            if let Some(number) = self.constant(number) {
                // A limit that never decides, or that always does.
                let decides = side.contains(number) == is_any;
                return if decides {
                    None
                } else {
                    self.region(other, side)
                };
            }
        }
        let parts = vec![self.region(a, side)?, self.region(b, side)?];
        Some(if is_any {
            Region::Any(parts)
        } else {
            Region::All(parts)
        })
    }

    fn constant(&self, node: Expr) -> Option<f64> {
        self.graph.known(node)
    }

    /// A node as a polynomial.
    fn polynomial(&mut self, node: Expr) -> Option<Polynomial> {
        if let Some(known) = self.known.get(&node) {
            return known.clone();
        }
        let found = self.expanded(node);
        self.known.insert(node, found.clone());
        found
    }

    fn expanded(&mut self, node: Expr) -> Option<Polynomial> {
        match self.graph.node(node) {
            Node::Constant(bits) => Some(Polynomial::constant(f64::from_bits(bits))),
            Node::Parameter(number) => {
                let axis = number as usize;
                let middle = *self.center.get(axis)?;
                Some(Polynomial::coordinate(axis, middle))
            }
            Node::Unary(UnaryOp::Neg, a) => Some(self.polynomial(a)?.scaled(-1.0)),
            Node::Unary(UnaryOp::Square, a) => self.power(a, 2),
            Node::Unary(UnaryOp::Power(exponent), a) => self.power(a, exponent),
            Node::Binary(op, a, b) => {
                let (a, b) = (self.polynomial(a)?, self.polynomial(b)?);
                match op {
                    BinaryOp::Add => Some(a.plus(1.0, &b)),
                    BinaryOp::Sub => Some(a.plus(-1.0, &b)),
                    BinaryOp::Mul => a.times(&b),
                    BinaryOp::Div => Some(a.scaled(1.0 / b.as_constant()?)),
                    _ => None,
                }
            }
            _ => None,
        }
    }

    fn power(&mut self, node: Expr, exponent: u8) -> Option<Polynomial> {
        match self.graph.node(node) {
            Node::Unary(UnaryOp::Sqrt, a) if exponent.is_multiple_of(2) => {
                self.polynomial(a)?.power(exponent / 2)
            }
            _ => self.polynomial(node)?.power(exponent),
        }
    }
}
