//! The bounding volume hierarchy of width eight: one vector instruction tests all children of a node.
//!
//! Split by phase as [`crate::Bvh2`]: `build` makes it, `traverse` searches it, `validate` checks everything that the traversal
//! relies on.

mod beam;
mod build;
mod compact;
mod fast;
mod grow;
mod high;
mod node;
mod nodes;
mod packet;
mod presplit;
mod spatial;
mod traverse;
mod validate;
mod view;
mod watch;

use crate::List;
use crate::boxes::Box32;
use crate::cull::CullBounds;
use crate::parameters::{Parameter, Parameters};
use node::Child;
use nodes::Nodes;
use strahl_simd::{Level, Simd, gather_pages};

pub use build::Build;
pub use view::Content;

/// The parameters of [`Bvh8`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bvh8Parameters {
    /// The builder.
    pub build: Build,
    /// The instruction set of the traversal; `None`, and those that this processor does not have, stand for the best it has.
    pub simd: Option<Level>,
    /// Whether to use as little memory as possible, at the cost of time.
    pub compact: bool,
}

impl Parameters for Bvh8Parameters {
    const DEFAULT: Self = Self {
        build: Build::Default,
        simd: None,
        compact: false,
    };
    const ALL: &'static [Parameter] = &[
        Parameter {
            name: "build",
            values: "default|fast|high",
            about: "quality of the build: `fast` builds faster, for slower rays; `high` builds more slowly, for faster rays",
        },
        Parameter {
            name: "compact",
            values: "",
            about: "use a sixth of the memory for triangles of meshes; rays take longer",
        },
        Parameter {
            name: "simd",
            values: "scalar|sse4|avx2|avx512",
            about: "traverse with these instructions instead of the processor's best; the picture is the same",
        },
    ];

    fn set(&mut self, name: &str, value: &str) -> Option<()> {
        match name {
            "build" => self.build = Build::of_name(value)?,
            "compact" => self.compact = true,
            _ => self.simd = Some(value.parse().ok()?),
        }
        Some(())
    }

    fn value(&self, name: &str) -> Option<String> {
        match name {
            "build" => Some(self.build.name().into()),
            "compact" => self.compact.then(String::new),
            _ => self.simd.map(|level| level.to_string()),
        }
    }

    fn check(&self) -> Result<(), String> {
        match self.simd {
            Some(level) if Simd::of(level).is_none() => {
                let all = Simd::available();
                let names: Vec<&str> = all.iter().map(|simd| simd.level().name()).collect();
                let names = names.join(", ");
                Err(format!(
                    "this processor does not have {level}; it has: {names}"
                ))
            }
            _ => Ok(()),
        }
    }
}

/// A bounding volume hierarchy of width eight built by the surface area heuristic.
///
/// Boxes are f32, rounded outwards. Primitives without bounds are kept in a list beside the tree and always visited.
///
/// Leaves are blocks of four slots, so that the owner of the primitives can store them in the same order and test four at once
/// (see [`crate::Visitor::visit_leaf`]). All primitives of a leaf have the same class, a number from 0 to 3. The only class
/// with a meaning here is 0, whose primitives are tested one by one.
///
/// With [`Build::High`] a primitive may be in several leaves, each with a part of it, and be visited several times.
///
/// H. Dammertz, J. Hanika, A. Keller, "Shallow Bounding Volume Hierarchies for Fast SIMD Ray Tracing of Incoherent Rays" (2008); I. Wald,
/// C. Benthin, S. Boulos, "Getting Rid of Packets" (2008).
#[derive(Clone, Debug, PartialEq)]
pub struct Bvh8 {
    tree: Option<Tree>,
    /// The primitives that are not in the tree, because they have no bounds, or reach far beyond all others.
    apart: List,
    simd: Simd,
}

/// The tree of all other primitives, at least one.
#[derive(Clone, Debug, PartialEq)]
struct Tree {
    root: Child,
    nodes: Nodes,
    /// The primitives of the leaves, leaf by leaf; leaves are filled up with [`crate::NO_PRIMITIVE`] to whole blocks.
    slots: Vec<u32>,
    bounds: CullBounds,
}

impl Tree {
    /// Numbers of primitives have so many bits.
    const ID_BITS: u32 = Bvh8::MAX_PRIMITIVES.ilog2();
}

impl Bvh8 {
    /// The most primitives a hierarchy can hold.
    pub const MAX_PRIMITIVES: usize = Child::MAX_BLOCKS;

    /// The instruction set of the traversal.
    pub fn simd(&self) -> Level {
        self.simd.level()
    }

    /// The same, with the proof that this processor has it.
    pub fn proof(&self) -> Simd {
        self.simd
    }

    /// Whether all primitives are in leaves.
    #[inline(always)]
    pub fn has_leaves_only(&self) -> bool {
        self.apart.ids().is_empty()
    }

    /// The same hierarchy in little memory: nodes with less exact boxes.
    #[must_use]
    pub fn compacted(self) -> Self {
        Self {
            tree: self.tree.map(Tree::compacted),
            ..self
        }
    }

    /// Moves a large hierarchy to large pages of memory.
    pub(crate) fn gather_pages(&self) {
        if let Some(tree) = &self.tree {
            match &tree.nodes {
                Nodes::Full(nodes) => gather_pages(nodes),
                Nodes::Compact(nodes) => gather_pages(nodes),
            }
            gather_pages(&tree.slots);
        }
    }

    /// Whether it uses as little memory as possible.
    pub fn is_compact(&self) -> bool {
        let tree = self.tree.as_ref();
        tree.is_some_and(|t| matches!(t.nodes, Nodes::Compact(_)))
    }

    /// The same hierarchy, traversed with another instruction set.
    #[must_use]
    pub fn with_simd(self, simd: Simd) -> Self {
        Self { simd, ..self }
    }
}

impl Tree {
    fn compacted(self) -> Self {
        let nodes = self.nodes.compacted();
        let mut bounds = Box32::around(self.bounds.bounds());
        for (_, inner) in (0..nodes.len()).filter_map(|i| nodes.children(i)).flatten() {
            bounds.grow(&inner);
        }
        Self {
            nodes,
            bounds: CullBounds::new(bounds.to_aabb()),
            ..self
        }
    }
}
