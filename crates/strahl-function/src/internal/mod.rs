//! The functions of POV-Ray's `functions.inc`, by name.
//!
//! POV-Ray's manual documents their names and parameters; what they compute was found by measuring POV-Ray 3.7 at many
//! points and parameters (`tests/data/internal.txt` has a sample).
//!
//! The pattern functions of that file (`f_agate`, `f_wood`, ...) are patterns: a [`ScalarField`](crate::ScalarField) of
//! the host.

mod algebraic;
mod curves;
mod fractal;
mod octaves;
mod solids;
mod term;
mod tubes;

use crate::error::FunctionError;
use crate::graph::{Expr, Graph};
use std::cell::RefCell;
use strahl_math::noise::NoiseGenerator;
use term::Term;

/// The most parameters after the point.
const PARAMETERS: usize = 10;

/// A function of `functions.inc`.
#[derive(Clone, Copy, Debug)]
pub struct Internal {
    /// The name, `f_...`.
    pub name: &'static str,
    /// How many parameters it takes after the three coordinates (or, for the waves, after value, amplitude and frequency).
    pub parameters: usize,
    formula: Formula,
}

#[derive(Clone, Copy, Debug)]
enum Formula {
    Terms(for<'a, 'g> fn(Arguments<'a, 'g>) -> Term<'a, 'g>),
    Noise(fractal::Kind),
}

/// What a formula is written in: the point and the parameters, zero where there are fewer.
#[derive(Clone, Copy)]
struct Arguments<'a, 'g> {
    x: Term<'a, 'g>,
    y: Term<'a, 'g>,
    z: Term<'a, 'g>,
    p: [Term<'a, 'g>; PARAMETERS],
}

/// All internal functions.
pub fn all() -> impl Iterator<Item = &'static Internal> {
    algebraic::TABLE
        .iter()
        .chain(curves::TABLE)
        .chain(solids::TABLE)
        .chain(tubes::TABLE)
        .chain(fractal::TABLE)
}

/// The internal function of that name.
pub fn find(name: &str) -> Option<&'static Internal> {
    all().find(|f| f.name == name)
}

impl Graph {
    /// A call of the internal function `name` with the coordinates and then its parameters.
    ///
    /// `generator` is the scene's `noise_generator`, which `f_noise3d` and `f_snoise3d` use.
    pub fn internal(&mut self, name: &str, arguments: &[Expr], generator: NoiseGenerator) -> Expr {
        let Some(function) = find(name) else {
            return self.fail(FunctionError::UnknownInternal {
                name: name.to_owned(),
                suggestion: similar(name),
            });
        };
        let expected = 3 + function.parameters;
        let (&[x, y, z, ref parameters @ ..], true) = (arguments, arguments.len() == expected)
        else {
            return self.fail(FunctionError::ArgumentCount {
                function: name.to_owned(),
                expected,
                found: arguments.len(),
            });
        };
        match function.formula {
            Formula::Terms(formula) => {
                let zero = self.constant(0.0);
                let graph = RefCell::new(self);
                let mut p = [zero; PARAMETERS];
                for (to, &from) in p.iter_mut().zip(parameters) {
                    *to = from;
                }
                formula(Arguments {
                    x: Term::new(&graph, x),
                    y: Term::new(&graph, y),
                    z: Term::new(&graph, z),
                    p: p.map(|e| Term::new(&graph, e)),
                })
                .expr
            }
            Formula::Noise(kind) => fractal::build(self, kind, generator, arguments),
        }
    }
}

/// A known name that differs from `name` in few letters.
fn similar(name: &str) -> Option<&'static str> {
    all()
        .map(|f| (distance(name, f.name), f.name))
        .filter(|&(d, n)| d <= 1 + n.len() / 5)
        .min()
        .map(|(_, n)| n)
}

/// The number of letters to insert, delete or change (Levenshtein).
fn distance(a: &str, b: &str) -> usize {
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, x) in a.bytes().enumerate() {
        let mut diagonal = i;
        for (j, y) in b.bytes().enumerate() {
            let above = row.get(j + 1).copied().unwrap_or(diagonal);
            let left = if j == 0 { i + 1 } else { row[j] };
            let best = (diagonal + usize::from(x != y))
                .min(above + 1)
                .min(left + 1);
            diagonal = above;
            if j == 0 {
                row[0] = i + 1;
            }
            row[j + 1] = best;
        }
    }
    row.last().copied().unwrap_or(0)
}
