use crate::bounds::Bounds;
use crate::compile::compile;
use crate::cost::Cost;
use crate::domain::{Domain, Dual, LANES, Lanes};
use crate::error::FunctionError;
use crate::field::{Rates, ScalarField, store_one_by_one};
use crate::graph::{Expr, Graph};
use crate::limits;
use crate::rate::Rate;
use crate::run::{prepare, run};
use crate::tape::{Tape, TapeNumber};
use std::cell::Cell;
use std::sync::Arc;

/// A function of named parameters, ready to be evaluated. Cheap to clone.
///
/// Missing arguments count as NaN, surplus ones are ignored; no arguments make it panic.
#[derive(Clone, Debug)]
pub struct Function {
    formula: Arc<Formula>,
    tape: Arc<Tape>,
}

/// What a function has been built as.
#[derive(Debug)]
struct Formula {
    graph: Graph,
    root: Expr,
    size: usize,
}

/// Working memory of evaluations: one for each thread, used for any number of functions.
#[derive(Clone, Debug, Default)]
pub struct Workspace {
    points: Registers<f64>,
    lanes: Registers<Lanes>,
    bounds: Registers<Bounds>,
    duals: Registers<Dual>,
    rates: Registers<Rate>,
    spent: u64,
}

/// Functions are equal if they have the same parameters and take the same steps, with the same fields: then all their values have
/// the same bits. Functions that are written differently are not equal.
impl PartialEq for Function {
    fn eq(&self, other: &Self) -> bool {
        let (a, b) = (&*self.formula, &*other.formula);
        Arc::ptr_eq(&self.tape, &other.tape) || a.root == b.root && a.graph.is_same(&b.graph)
    }
}

impl Eq for Function {}

/// The registers of the functions that are evaluated with a workspace.
#[derive(Clone, Debug)]
struct Registers<T> {
    stack: Vec<T>,
    /// The tape whose constants are in place.
    tape: TapeNumber,
}

impl<T> Default for Registers<T> {
    fn default() -> Self {
        Self {
            stack: Vec::new(),
            tape: TapeNumber::default(),
        }
    }
}

impl<T: Domain> Registers<T> {
    /// Those for a tape, with its constants in place.
    #[inline]
    fn of(&mut self, tape: &Tape) -> &mut [T] {
        if self.tape != tape.number {
            if self.stack.len() < tape.stack {
                self.stack.resize(tape.stack, T::constant(0.0));
            }
            prepare(tape, &mut self.stack);
            self.tape = tape.number;
        }
        &mut self.stack
    }
}

/// Copies the arguments of a tape to its inputs.
#[inline]
fn fill<T: Domain, A: Copy>(
    stack: &mut [T],
    tape: &Tape,
    arguments: &[A],
    convert: impl Fn(A) -> T,
) {
    let inputs = &mut stack[..tape.inputs];
    // A point in space, without a loop and without a call that copies it.
    if let ([x, y, z], &[a, b, c]) = (&mut *inputs, arguments) {
        (*x, *y, *z) = (convert(a), convert(b), convert(c));
        return;
    }
    for (register, &argument) in inputs.iter_mut().zip(arguments) {
        *register = convert(argument);
    }
    if let Some(missing) = inputs.get_mut(arguments.len()..) {
        missing.fill(T::constant(f64::NAN));
    }
}

impl Workspace {
    /// An empty workspace; it grows to what the functions need.
    pub fn new() -> Self {
        Self::default()
    }

    /// The number of operations that the loops of all calls of [`Function::value`] have taken. Only their cost is unknown
    /// beforehand.
    pub fn spent(&self) -> u64 {
        self.spent
    }
}

impl Function {
    fn compile(mut graph: Graph, root: Expr) -> Result<Self, FunctionError> {
        let depth = graph.depth(root);
        let size = graph.reachable(root).len();
        let mut tape = compile(&graph, root)?;
        (tape.number, tape.depth) = (TapeNumber::next(), depth);
        let limit = graph.allowed();
        if tape.cost > limit || tape.cost == u64::MAX {
            let cost = tape.cost;
            return Err(FunctionError::TooCostly { cost, limit });
        }
        graph.seal();
        Ok(Self {
            formula: Arc::new(Formula { graph, root, size }),
            tape: Arc::new(tape),
        })
    }

    /// The names of the parameters, in the order of the arguments.
    pub fn parameters(&self) -> &[String] {
        self.formula.graph.parameters()
    }

    /// How many different values the function computes or reads.
    pub fn size(&self) -> usize {
        self.formula.size
    }

    /// The graph it has been built as, and the node that is its value.
    pub(crate) fn formula(&self) -> (&Graph, Expr) {
        (&self.formula.graph, self.formula.root)
    }

    /// The function's number, if it doesn't depend on its arguments.
    pub fn constant(&self) -> Option<f64> {
        self.formula.graph.known(self.formula.root)
    }

    /// The value at a point.
    pub fn value(&self, workspace: &mut Workspace, arguments: &[f64]) -> f64 {
        let tape = &*self.tape;
        let stack = workspace.points.of(tape);
        fill(stack, tape, arguments, |x| x);
        let mut fuel = self.fuel();
        let result = run(tape, stack, &mut fuel);
        workspace.spent = workspace.spent.wrapping_add(self.fuel() - fuel);
        result
    }

    /// The cost of a call of [`value`](Self::value), without rounds of loops whose number is unknown beforehand.
    pub fn cost(&self) -> u64 {
        self.tape.cost
    }

    /// How many operations building it took.
    pub fn work(&self) -> u64 {
        self.formula.graph.work()
    }

    /// The limit for the loops of an evaluation.
    fn fuel(&self) -> u64 {
        self.formula.graph.allowed()
    }

    /// The values at many points: `arguments` has a column for each parameter, `values` says how many points there are.
    ///
    /// Every value has the bits that [`value`](Self::value) gives for its point. A point that a column is too short for
    /// has NaN there.
    pub fn values(&self, workspace: &mut Workspace, arguments: &[&[f64]], values: &mut [f64]) {
        let tape = &*self.tape;
        let stack = workspace.lanes.of(tape);
        for (chunk, out) in values.chunks_mut(LANES).enumerate() {
            for (input, register) in stack[..tape.inputs].iter_mut().enumerate() {
                let column = arguments.get(input).copied().unwrap_or(&[]);
                let rest = column.get(chunk * LANES..).unwrap_or(&[]);
                match rest.first_chunk::<LANES>() {
                    Some(full) => register.0 = *full,
                    None => {
                        *register = Lanes::constant(f64::NAN);
                        for (lane, &x) in register.0.iter_mut().zip(rest) {
                            *lane = x;
                        }
                    }
                }
            }
            let mut fuel = Lanes::fuel(self.fuel());
            let result = run(tape, stack, &mut fuel);
            out.copy_from_slice(&result.0[..out.len()]);
        }
    }

    /// An interval that contains the value at every point whose arguments are within bounds.
    pub fn bounds(&self, workspace: &mut Workspace, arguments: &[Bounds]) -> Bounds {
        let tape = &*self.tape;
        let stack = workspace.bounds.of(tape);
        fill(stack, tape, arguments, Bounds::with_both_zeros);
        run(tape, stack, &mut self.fuel())
    }

    /// Bounds of the value on a part of a line, where the arguments are within bounds, and of its derivative along the line, on which
    /// each argument changes at a rate of its own.
    ///
    /// A derivative of one sign proves that the value is monotone there. It is [`Bounds::UNKNOWN`] where the value may jump or be no
    /// number, and where fields are called whose rates are unknown.
    pub fn rate(
        &self,
        workspace: &mut Workspace,
        arguments: &[Bounds],
        rates: &[f64],
    ) -> (Bounds, Bounds) {
        self.rate_of(workspace, |i| {
            let argument = arguments.get(i).copied().unwrap_or(Bounds::NAN);
            Rate {
                value: Bounds::argument(argument.min, argument.max).with_nan(argument.nan),
                rate: Bounds::point(rates.get(i).copied().unwrap_or(f64::NAN)),
                middle: f64::NAN,
            }
        })
    }

    /// The same on a segment, from the arguments at one end to those at the other. Some fields have narrower bounds there than in the box
    /// around it.
    pub fn rate_along(
        &self,
        workspace: &mut Workspace,
        [from, to]: [&[f64]; 2],
        rates: &[f64],
    ) -> (Bounds, Bounds) {
        self.rate_of(workspace, |i| {
            let at = |numbers: &[f64]| numbers.get(i).copied().unwrap_or(f64::NAN);
            let (a, b) = (at(from), at(to));
            Rate {
                value: Bounds::argument(if a < b { a } else { b }, if a < b { b } else { a }),
                rate: Bounds::point(at(rates)),
                middle: 0.5 * (a + b),
            }
        })
    }

    #[inline(always)]
    fn rate_of(
        &self,
        workspace: &mut Workspace,
        argument: impl Fn(usize) -> Rate,
    ) -> (Bounds, Bounds) {
        let tape = &*self.tape;
        let stack = workspace.rates.of(tape);
        for (register, i) in stack.iter_mut().zip(0..tape.inputs) {
            *register = argument(i);
        }
        let result = run(tape, stack, &mut self.fuel());
        let rate = if result.value.nan {
            Bounds::UNKNOWN
        } else {
            result.rate
        };
        (result.value, rate)
    }

    /// On what [`rate`](Self::rate) can be known: on what those of all fields that are called can be.
    pub fn rates(&self) -> Rates {
        self.tape.rates()
    }

    /// Whether [`bounds`](Self::bounds) converge to the values as boxes become small: all fields within have bounds.
    pub fn is_bounded(&self) -> bool {
        self.tape.is_bounded()
    }

    /// The value at a point, with the bits of [`value`](Self::value), and its derivatives by the first three parameters.
    ///
    /// At steps and corners (`floor`, `abs`, `min`, ...) the derivative of one side is given.
    pub fn gradient(&self, workspace: &mut Workspace, arguments: &[f64]) -> (f64, [f64; 3]) {
        let tape = &*self.tape;
        let stack = workspace.duals.of(tape);
        for (register, i) in stack.iter_mut().zip(0..tape.inputs) {
            *register = Dual::number(arguments.get(i).copied().unwrap_or(f64::NAN));
            if let Some(partial) = register.partials.get_mut(i) {
                *partial = 1.0;
            }
        }
        let result = run(tape, stack, &mut self.fuel());
        (result.value, result.partials)
    }
}

/// Functions from graphs, and in graphs.
impl Graph {
    /// Compiles the function whose value is `root`.
    pub fn finish(self, root: Expr) -> Result<Function, FunctionError> {
        self.check(root)?;
        Function::compile(self, root)
    }

    /// A call of another function: small ones become part of this graph, large ones are called.
    pub fn call(&mut self, function: &Function, arguments: &[Expr]) -> Expr {
        if self.failure().is_some() {
            // It has failed already; continuing to copy might never end.
            return Expr(0);
        }
        let expected = function.parameters().len();
        if arguments.len() != expected {
            let found = arguments.len();
            return self.fail(FunctionError::ArgumentCount {
                function: "the function".to_owned(),
                expected,
                found,
            });
        }
        let Formula { graph, root, size } = &*function.formula;
        if *size <= limits::INLINE {
            self.inline(graph, *root, arguments)
        } else {
            self.call_tape(&function.tape, arguments)
        }
    }
}

/// Calls something with the workspace of this thread, which is taken and put back, so that a field within a function can do the same.
fn with_workspace<R>(call: impl FnOnce(&mut Workspace) -> R) -> R {
    thread_local! {
        static WORKSPACE: Cell<Option<Box<Workspace>>> = Cell::default();
    }
    WORKSPACE.with(|cell| {
        let mut workspace = cell.take().unwrap_or_default();
        let result = call(&mut workspace);
        cell.set(Some(workspace));
        result
    })
}

impl ScalarField for Function {
    fn arity(&self) -> usize {
        self.parameters().len()
    }

    /// A loop of unknown length counts as a part of its limit: functions that call this one a few times are accepted, those
    /// that call it a thousand times are not.
    fn cost(&self) -> Cost {
        const PART: u64 = 16;
        let open = if self.tape.is_open {
            self.fuel() / PART
        } else {
            0
        };
        Cost {
            operations: self.tape.cost.saturating_add(open),
            depth: self.tape.depth,
        }
        .around()
    }

    fn value(&self, arguments: &[f64]) -> f64 {
        if arguments.is_empty() {
            return self.constant().unwrap_or(f64::NAN);
        }
        with_workspace(|workspace| Function::value(self, workspace, arguments))
    }

    fn gains_together(&self) -> bool {
        self.tape.gains_together()
    }

    /// A batch always takes as long as a full one.
    fn store_values(&self, arguments: &[&[f64]], values: &mut [f64]) {
        if 2 * values.len() < LANES || arguments.is_empty() || !self.gains_together() {
            store_one_by_one(self, arguments, values);
            return;
        }
        with_workspace(|workspace| self.values(workspace, arguments, values));
    }
}
