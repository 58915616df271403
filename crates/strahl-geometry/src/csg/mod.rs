//! Constructive solid geometry: trees of solids, of any depth.
//!
//! A ray sees a solid as a list of spans (Roth, "Ray casting for modeling solids", 1982). A tree asks its leaves for their
//! [`Crossings`](crate::Crossings), and every operation combines the sorted lists of its operands in one sweep; no hit is
//! ever tested against the other operands point by point.
//!
//! * [`CsgNode`] describes a tree, [`Csg`] is the compiled tree: inversions pushed down to the leaves, nested equal operations
//!   flattened, everything in flat lists of `node`s and leaves that are traversed without recursion.
//! * `compile` makes the one from the other, `evaluate` traverses the tree for a ray, `sweep` combines lists, `half_spaces`
//!   intersects all planes of an intersection in one pass. `fusing` says which crossings may coincide.
//! * `first` finds the first surface without lists, if no two crossings are close together: `course` finds the crossings that
//!   matter to a `search`, `timeline` goes through them.
//! * `small` knows trees of a few simple leaves, with a `table` of their `states`; `small_search` answers a `query` about them,
//!   `one_span` about intersections and `merged` about merges among them.
//! * `packet` searches small trees of `convex` solids for four rays side by side, which `four_stays` intersects with the leaves;
//!   `packet_tree` tests boxes and leaves of larger ones and of merges for the rays of a packet, `together` searches them
//!   ray by ray, and `lines` combines their leaves.
//! * `clipped` knows open surfaces that convex solids clip.
//! * `solid` makes a shape of it all: it chooses the search.

mod boxes;
mod clipped;
mod compile;
mod compiled;
mod convex;
mod course;
mod evaluate;
mod first;
mod four_stays;
mod fusing;
mod half_spaces;
mod leaf;
mod lines;
mod merged;
mod node;
mod one_span;
mod packet;
mod packet_tree;
mod query;
mod search;
mod small;
mod small_search;
mod solid;
mod states;
mod sweep;
mod table;
mod tighten;
mod timeline;
mod together;
mod tree;
mod within;

pub use compiled::Csg;
pub use packet_tree::{PacketRanges, PacketTree};
pub use tree::{CsgNode, Operands};

pub(crate) use evaluate::Workspace;

#[cfg(test)]
mod first_tests;
#[cfg(test)]
mod fuzz_tests;
#[cfg(test)]
mod gem_tests;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod together_tests;
