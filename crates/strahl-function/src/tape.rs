//! Tapes: functions as lists of instructions over registers.

use crate::field::{Rates, ScalarField};
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
    /// How deep loops and calls are nested in the function.
    pub(crate) depth: u32,
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
    /// The tapes of other functions, and the registers of the arguments.
    pub(crate) calls: Vec<(Arc<Self>, Vec<u32>)>,
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
    pub(crate) fn count(&mut self, straight: u64, rounds: u64) {
        self.straight = self.straight.saturating_add(straight);
        self.cost = self.cost.saturating_add(straight).saturating_add(rounds);
    }

    /// What it takes to put its arguments and constants in place.
    pub(crate) fn entry(&self) -> u64 {
        (self.inputs + self.constants.len()) as u64
    }

    /// Whether all fields it reads have bounds.
    pub(crate) fn is_bounded(&self) -> bool {
        self.fields.iter().all(|f| f.field.is_bounded())
            && self.calls.iter().all(|(callee, _)| callee.is_bounded())
            && self.loops.iter().all(|l| l.body.is_bounded())
    }

    /// Whether a batch takes less time than its points one by one: there are no loops, whose numbers of rounds may differ, and all fields it
    /// reads gain, too.
    pub(crate) fn gains_together(&self) -> bool {
        self.loops.is_empty()
            && self.fields.iter().all(|f| f.field.gains_together())
            && self.calls.iter().all(|(f, _)| f.gains_together())
    }

    /// Of which arguments the rates of change of all fields it reads can be known.
    pub(crate) fn rates(&self) -> Rates {
        let fields = self.fields.iter().map(|f| f.field.rates());
        let calls = self.calls.iter().map(|(callee, _)| callee.rates());
        let loops = self.loops.iter().map(|l| l.body.rates());
        fields
            .chain(calls)
            .chain(loops)
            .min()
            .unwrap_or(Rates::OfBoxes)
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
    pub(crate) fn new(field: Arc<dyn ScalarField>, arguments: Vec<u32>) -> Self {
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
