use crate::{Accelerator, Bvh2, Bvh8, List, TraversalStats, Visitor};
use std::{fmt, str::FromStr};
use strahl_math::{Aabb, Interval, Ray};

/// Makes the enum of all structures from the table below.
macro_rules! accelerators {
    ($($(#[$doc:meta])* $name:literal $variant:ident = $build:expr,)+) => {
        /// Which acceleration structure.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        #[non_exhaustive]
        pub enum AcceleratorKind {
            $($(#[$doc])* $variant,)+
        }

        impl AcceleratorKind {
            /// All of them.
            pub const ALL: &[Self] = &[$(Self::$variant,)+];

            /// The name on the command line.
            pub const fn name(self) -> &'static str {
                match self { $(Self::$variant => $name,)+ }
            }
        }

        /// Any acceleration structure, dispatched once per ray.
        #[derive(Clone, Debug)]
        #[non_exhaustive]
        pub enum AnyAccelerator {
            $($(#[$doc])* $variant($variant),)+
        }

        impl AnyAccelerator {
            /// Builds the structure over boxes `0..n`.
            pub fn build(kind: AcceleratorKind, bounds: &[Aabb]) -> Self {
                Self::build_classed(kind, bounds, &|_| 0)
            }

            /// Builds the structure over boxes `0..n`, with leaves of one class each (see [`Bvh8`]).
            pub fn build_classed(kind: AcceleratorKind, bounds: &[Aabb], class: &dyn Fn(u32) -> u8) -> Self {
                match kind {
                    $(AcceleratorKind::$variant => {
                        let build: fn(&[Aabb], &dyn Fn(u32) -> u8) -> $variant = $build;
                        Self::$variant(build(bounds, class))
                    })+
                }
            }
        }

        impl Accelerator for AnyAccelerator {
            fn name(&self) -> &'static str {
                match self { $(Self::$variant(a) => a.name(),)+ }
            }

            #[inline]
            fn traverse<V: Visitor>(
                &self,
                ray: &Ray,
                range: Interval,
                visitor: &mut V,
                stats: &mut TraversalStats,
            ) {
                match self { $(Self::$variant(a) => a.traverse(ray, range, visitor, stats),)+ }
            }

            fn slots(&self) -> &[u32] {
                match self { $(Self::$variant(a) => a.slots(),)+ }
            }

            fn bytes(&self) -> usize {
                match self { $(Self::$variant(a) => a.bytes(),)+ }
            }

            fn nodes(&self) -> usize {
                match self { $(Self::$variant(a) => a.nodes(),)+ }
            }

            fn references(&self) -> usize {
                match self { $(Self::$variant(a) => a.references(),)+ }
            }
        }
    };
}

// THE table of accelerators: a new one is one line here.
accelerators! {
    /// No structure: every primitive for every ray.
    "list" List = |b, _| List::build(b),
    /// The binary bounding volume hierarchy: the readable reference.
    "bvh2" Bvh2 = |b, _| Bvh2::build(b),
    /// The bounding volume hierarchy of width eight.
    "bvh" Bvh8 = |b, class| Bvh8::build(b, class),
}

#[expect(
    clippy::derivable_impls,
    reason = "the table's macro makes the variants, this one is chosen outside of it"
)]
impl Default for AcceleratorKind {
    fn default() -> Self {
        Self::Bvh8
    }
}

impl fmt::Display for AcceleratorKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// There is no accelerator of that name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownAccelerator(String);

impl fmt::Display for UnknownAccelerator {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names: Vec<&str> = AcceleratorKind::ALL.iter().map(|k| k.name()).collect();
        write!(
            f,
            "unknown accelerator `{}`; there are: {}",
            self.0,
            names.join(", ")
        )
    }
}

impl std::error::Error for UnknownAccelerator {}

impl FromStr for AcceleratorKind {
    type Err = UnknownAccelerator;

    fn from_str(s: &str) -> Result<Self, Self::Err> {
        Self::ALL
            .iter()
            .copied()
            .find(|k| k.name() == s)
            .ok_or_else(|| UnknownAccelerator(s.to_owned()))
    }
}
