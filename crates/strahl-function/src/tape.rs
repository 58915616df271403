//! The graph as a list of instructions over registers.

use crate::error::FunctionError;
use crate::field::ScalarField;
use crate::function::Function;
use crate::graph::{Expr, Graph, Loop, Node, NodeMap};
use crate::op::{BinaryOp, UnaryOp};
use std::fmt;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// One instruction: registers `a` and `b` give register `out`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Instruction {
    pub(crate) op: Op,
    pub(crate) out: u32,
    pub(crate) a: u32,
    /// The second operand, or the place in the table of selects, fields, calls or loops.
    pub(crate) b: u32,
}

/// What an instruction does. The most frequent operations are decoded in one step.
#[derive(Clone, Copy, Debug)]
#[repr(u8)]
pub(crate) enum Op {
    Neg,
    Abs,
    Square,
    Sqrt,
    Add,
    Sub,
    Mul,
    Div,
    Min,
    Max,
    /// Any other operation on one value.
    Unary(UnaryOp),
    /// Any other operation on two values.
    Binary(BinaryOp),
    Select,
    Field,
    Call,
    Loop,
}

impl From<UnaryOp> for Op {
    fn from(op: UnaryOp) -> Self {
        match op {
            UnaryOp::Neg => Self::Neg,
            UnaryOp::Abs => Self::Abs,
            UnaryOp::Square => Self::Square,
            UnaryOp::Sqrt => Self::Sqrt,
            other => Self::Unary(other),
        }
    }
}

impl From<BinaryOp> for Op {
    fn from(op: BinaryOp) -> Self {
        match op {
            BinaryOp::Add => Self::Add,
            BinaryOp::Sub => Self::Sub,
            BinaryOp::Mul => Self::Mul,
            BinaryOp::Div => Self::Div,
            BinaryOp::Min => Self::Min,
            BinaryOp::Max => Self::Max,
            other => Self::Binary(other),
        }
    }
}

/// So many registers has every tape at least: a power of two that hardly any tape needs more of.
pub(crate) const FRAME: usize = 256;

/// What tells a function's tape from all others; by default it is that of no tape. It has no part in what is shown of a function, so that equal
/// functions look the same.
#[derive(Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct TapeNumber(u64);

impl TapeNumber {
    /// A number that no tape has so far.
    pub(crate) fn next() -> Self {
        static NEXT: AtomicU64 = AtomicU64::new(1);
        Self(NEXT.fetch_add(1, Ordering::Relaxed))
    }
}

impl fmt::Debug for TapeNumber {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("_")
    }
}

/// A function as straight-line code.
///
/// Registers hold, in this order, the inputs, the constants, and intermediate values; inputs and constants are never
/// overwritten, so that a batch writes the constants once.
#[derive(Debug, Default)]
pub(crate) struct Tape {
    /// A number that no other function's tape has, so that a workspace knows whose constants it holds.
    pub(crate) number: TapeNumber,
    pub(crate) code: Vec<Instruction>,
    pub(crate) inputs: usize,
    pub(crate) constants: Vec<f64>,
    /// At least [`FRAME`].
    pub(crate) registers: usize,
    /// Registers of this tape and of the deepest chain of loops and calls within it.
    pub(crate) stack: usize,
    pub(crate) result: u32,
    pub(crate) selects: Vec<[u32; 3]>,
    pub(crate) fields: Vec<FieldCode>,
    pub(crate) calls: Vec<(Function, Vec<u32>)>,
    pub(crate) loops: Vec<LoopCode>,
    /// What a run takes without the rounds of loops.
    pub(crate) straight: u64,
    /// What a run takes with the rounds of those loops whose number is known.
    pub(crate) cost: u64,
    /// Whether there are loops, which take fuel.
    pub(crate) has_loops: bool,
    /// Whether there are loops of which the number of rounds is not known.
    pub(crate) is_open: bool,
}

impl Tape {
    /// Counts what one instruction takes.
    fn count(&mut self, straight: u64, rounds: u64) {
        self.straight = self.straight.saturating_add(straight);
        self.cost = self.cost.saturating_add(straight).saturating_add(rounds);
    }

    /// What it takes to put its arguments and constants in place.
    fn entry(&self) -> u64 {
        (self.inputs + self.constants.len()) as u64
    }

    /// Whether all fields it reads have bounds.
    pub(crate) fn is_bounded(&self) -> bool {
        self.fields.iter().all(|f| f.field.is_bounded())
            && self.calls.iter().all(|(f, _)| f.tape().is_bounded())
            && self.loops.iter().all(|l| l.body.is_bounded())
    }

    /// Whether the rates of change of all fields it reads can be known.
    pub(crate) fn has_rates(&self) -> bool {
        self.fields.iter().all(|f| f.field.has_rates())
            && self.calls.iter().all(|(f, _)| f.tape().has_rates())
            && self.loops.iter().all(|l| l.body.has_rates())
    }
}

/// A call of a field.
#[derive(Debug)]
pub(crate) struct FieldCode {
    pub(crate) field: Arc<dyn ScalarField>,
    /// The registers of the arguments.
    pub(crate) arguments: Vec<u32>,
    /// Whether these registers lie side by side, so that no argument has to be copied.
    pub(crate) is_row: bool,
}

impl FieldCode {
    fn new(field: Arc<dyn ScalarField>, arguments: Vec<u32>) -> Self {
        let is_row = arguments.windows(2).all(|pair| pair[0] + 1 == pair[1]);
        Self {
            field,
            arguments,
            is_row,
        }
    }
}

/// A loop: its body is a tape with the counter as first input and then what it takes from outside.
#[derive(Debug)]
pub(crate) struct LoopCode {
    pub(crate) product: bool,
    pub(crate) from: u32,
    pub(crate) to: u32,
    pub(crate) captures: Vec<u32>,
    /// What a round takes, without those of loops within.
    pub(crate) price: u64,
    pub(crate) body: Tape,
}

/// How many rounds a loop from one number to another has; endlessly many are as many as can be counted.
fn rounds(from: f64, to: f64) -> u64 {
    // The cast saturates; NaN and negative numbers have no rounds.
    if from <= to {
        ((to - from) as u64).saturating_add(1)
    } else {
        0
    }
}

/// What a loop's body needs from outside of it.
type Captures = NodeMap<Vec<Expr>>;

/// Compiles the whole function.
pub(crate) fn compile(graph: &Graph, root: Expr) -> Result<Tape, FunctionError> {
    let mut captures = Captures::default();
    // A loop comes after those within it, so what the inner ones need is known.
    for e in graph.reachable(root) {
        if let Node::Loop(l) = graph.node(e) {
            let outside = frame(graph, l.body, Some(l.variable), &captures).captured;
            captures.insert(e, outside);
        }
    }
    let mut inputs = NodeMap::default();
    for e in graph.reachable(root) {
        if let Node::Parameter(i) = graph.node(e) {
            inputs.insert(e, i);
        }
    }
    assemble(
        graph,
        root,
        None,
        inputs,
        graph.parameters().len(),
        &captures,
    )
}

/// The nodes of one tape.
struct Frame {
    /// Operands first; without the inputs.
    nodes: Vec<Expr>,
    /// What is computed outside of it.
    captured: Vec<Expr>,
}

/// What a tape needs to know: the operands of a node within its frame.
fn operands(graph: &Graph, e: Expr, captures: &Captures) -> Vec<Expr> {
    match graph.node(e) {
        Node::Loop(l) => {
            let mut list = vec![l.from, l.to];
            list.extend(captures.get(&e).into_iter().flatten());
            list
        }
        node => graph.children(node),
    }
}

/// The nodes that belong to the frame of a loop over `variable` (or of the function): those that change with the variable.
fn frame(graph: &Graph, root: Expr, variable: Option<u32>, captures: &Captures) -> Frame {
    let mut result = Frame {
        nodes: Vec::new(),
        captured: Vec::new(),
    };
    let mut seen: NodeMap<()> = NodeMap::default();
    let mut stack = vec![root];
    while let Some(e) = stack.pop() {
        if seen.insert(e, ()).is_some() {
            continue;
        }
        let constant = matches!(graph.node(e), Node::Constant(_));
        if variable.is_some_and(|v| !constant && !graph.depends_on(e, v)) {
            result.captured.push(e);
        } else {
            result.nodes.push(e);
            stack.extend(operands(graph, e, captures));
        }
    }
    result.nodes.sort_unstable_by_key(|e| e.0);
    result.captured.sort_unstable_by_key(|e| e.0);
    result
}

fn assemble(
    graph: &Graph,
    root: Expr,
    variable: Option<u32>,
    mut register: NodeMap<u32>,
    inputs: usize,
    captures: &Captures,
) -> Result<Tape, FunctionError> {
    let nodes: Vec<Expr> = frame(graph, root, variable, captures)
        .nodes
        .into_iter()
        .filter(|e| !register.contains_key(e))
        .collect();
    let mut tape = Tape {
        inputs,
        ..Tape::default()
    };
    for &e in &nodes {
        if let Node::Constant(bits) = graph.node(e) {
            register.insert(e, (inputs + tape.constants.len()) as u32);
            tape.constants.push(f64::from_bits(bits));
        }
    }
    let fixed = inputs + tape.constants.len();
    // The instruction after which a value is not needed any more.
    let mut last_use: NodeMap<usize> = NodeMap::default();
    for (i, &e) in nodes.iter().enumerate() {
        for operand in operands(graph, e, captures) {
            last_use.insert(operand, i);
        }
    }
    last_use.insert(root, nodes.len());

    let mut free: Vec<u32> = Vec::new();
    let mut used = fixed as u32;
    let mut nested = 0;
    for (i, &e) in nodes.iter().enumerate() {
        let node = graph.node(e);
        if matches!(node, Node::Constant(_)) {
            continue;
        }
        let at = |e: Expr| {
            register
                .get(&e)
                .copied()
                .ok_or(FunctionError::ForeignExpression)
        };
        let many = |list: &[Expr]| list.iter().map(|&a| at(a)).collect::<Result<Vec<u32>, _>>();
        let (op, a, b) = match node {
            // Inputs have registers already: what is left is used outside of its loop.
            Node::Constant(_) | Node::Parameter(_) | Node::Variable(_) => {
                return Err(FunctionError::UnboundVariable);
            }
            Node::Unary(op, a) => (op.into(), at(a)?, 0),
            Node::Binary(op, a, b) => (op.into(), at(a)?, at(b)?),
            Node::Select(s, n, z, p) => {
                tape.selects.push([at(n)?, at(z)?, at(p)?]);
                (Op::Select, at(s)?, tape.selects.len() as u32 - 1)
            }
            Node::Field(id, list) => {
                let field = graph.field_at(id).ok_or(FunctionError::ForeignExpression)?;
                let arguments = many(graph.arguments(list))?;
                nested = nested.max(arguments.len());
                tape.count(field.cost().operations, 0);
                tape.fields
                    .push(FieldCode::new(Arc::clone(field), arguments));
                (Op::Field, 0, tape.fields.len() as u32 - 1)
            }
            Node::Call(id, list) => {
                let callee = graph
                    .function_at(id)
                    .ok_or(FunctionError::ForeignExpression)?;
                let inner = callee.tape();
                nested = nested.max(inner.stack);
                tape.count(inner.straight.saturating_add(inner.entry()), 0);
                tape.count(0, inner.cost - inner.straight);
                tape.has_loops |= inner.has_loops;
                tape.is_open |= inner.is_open;
                tape.calls
                    .push((callee.clone(), many(graph.arguments(list))?));
                (Op::Call, 0, tape.calls.len() as u32 - 1)
            }
            Node::Loop(l) => {
                let outside = captures.get(&e).map_or(&[][..], |c| c);
                let body = assemble_body(graph, l, outside, captures)?;
                nested = nested.max(body.stack);
                let known = graph.known(l.from).zip(graph.known(l.to));
                let price = body.straight.saturating_add(1);
                let all = known.map_or(0, |(from, to)| rounds(from, to));
                tape.count(
                    body.entry(),
                    all.saturating_mul(body.cost.saturating_add(1)),
                );
                tape.has_loops = true;
                tape.is_open |= known.is_none() || body.is_open;
                tape.loops.push(LoopCode {
                    price,
                    product: l.product,
                    from: at(l.from)?,
                    to: at(l.to)?,
                    captures: many(outside)?,
                    body,
                });
                (Op::Loop, 0, tape.loops.len() as u32 - 1)
            }
        };
        // Operands are read before the result is written, so their registers can be used again at once.
        let mut operands = operands(graph, e, captures);
        operands.sort_unstable_by_key(|e| e.0);
        operands.dedup();
        for operand in operands {
            let done = last_use.get(&operand) == Some(&i);
            if let Some(&r) = register.get(&operand)
                && done
                && r as usize >= fixed
            {
                free.push(r);
            }
        }
        let out = free.pop().unwrap_or_else(|| {
            used += 1;
            used - 1
        });
        register.insert(e, out);
        tape.count(1, 0);
        tape.code.push(Instruction { op, out, a, b });
    }
    tape.result = register
        .get(&root)
        .copied()
        .ok_or(FunctionError::UnboundVariable)?;
    tape.registers = (used as usize).max(FRAME);
    tape.stack = tape.registers + nested;
    Ok(tape)
}

fn assemble_body(
    graph: &Graph,
    l: Loop,
    outside: &[Expr],
    captures: &Captures,
) -> Result<Tape, FunctionError> {
    let mut inputs: NodeMap<u32> = NodeMap::default();
    for (i, &e) in outside.iter().enumerate() {
        inputs.insert(e, i as u32 + 1);
    }
    if let Some(counter) = graph.find_variable(l.variable) {
        inputs.insert(counter, 0);
    }
    assemble(
        graph,
        l.body,
        Some(l.variable),
        inputs,
        outside.len() + 1,
        captures,
    )
}
