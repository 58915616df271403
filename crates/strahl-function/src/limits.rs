//! How large a function may be. Every limit gives an error when it is passed, never a panic.

/// The most parameters of a function (POV-Ray's limit).
pub const PARAMETERS: usize = 56;
/// So many arguments, at most, have most fields; more take more time to pass on.
pub(crate) const FEW: usize = 4;
/// The most operations of a function.
pub const NODES: usize = 1 << 20;
/// The deepest nesting of calls and loops.
pub const DEPTH: usize = 128;
/// The most operations that building one function takes, those counted again that were there already.
pub const WORK: u64 = 1 << 23;
/// The most operations of one evaluation, unless [`Graph::allow`](crate::Graph::allow) says otherwise: a few milliseconds.
pub const COST: u64 = 1 << 20;
/// Functions with at most so many operations are copied into their callers.
pub const INLINE: usize = 1024;
/// Loops with at most so many operations over all rounds are written out.
pub const UNROLL: usize = 4096;
