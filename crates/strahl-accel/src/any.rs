use crate::parameters::{self, NoParameters, Parameter, Parameters};
use crate::shapes::all_bounds;
use crate::*;
use std::{fmt, str::FromStr};
use strahl_math::{Aabb, Interval, Ray};
use strahl_simd::Level;

/// Makes the enum of all structures from the table below.
macro_rules! accelerators {
    ($($(#[$doc:meta])* $name:literal $variant:ident($parameters:ty) = $build:expr,)+) => {
        /// Which acceleration structure, with its parameters.
        ///
        /// As text: `NAME` or `NAME:PARAMETER=VALUE,...`, as `grid:density=10`. See [`AcceleratorKind::parameters`].
        #[derive(Clone, Copy, Debug, PartialEq)]
        #[non_exhaustive]
        pub enum AcceleratorKind {
            $($(#[$doc])* $variant($parameters),)+
        }

        impl AcceleratorKind {
            /// All of them, with the default parameters.
            pub const ALL: &[Self] = &[$(Self::$variant(<$parameters>::DEFAULT),)+];

            /// The name on the command line.
            pub const fn name(self) -> &'static str {
                match self { $(Self::$variant(_) => $name,)+ }
            }

            /// Its parameters.
            pub const fn parameters(self) -> &'static [Parameter] {
                match self { $(Self::$variant(_) => <$parameters>::ALL,)+ }
            }

            fn with_parameters(self, text: &str) -> Result<Self, String> {
                match self {
                    $(Self::$variant(_) => parameters::parse($name, text).map(Self::$variant),)+
                }
            }
        }

        impl fmt::Display for AcceleratorKind {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(self.name())?;
                match self { $(Self::$variant(p) => parameters::write(p, f),)+ }
            }
        }

        /// Any acceleration structure, dispatched once per ray.
        #[derive(Clone, Debug)]
        #[non_exhaustive]
        pub enum AnyAccelerator {
            $($(#[$doc])* $variant($variant),)+
        }

        impl AnyAccelerator {
            /// Builds the structure over primitives `0..n`.
            pub fn build_from(kind: AcceleratorKind, shapes: &dyn Shapes) -> Self {
                match kind {
                    $(AcceleratorKind::$variant(p) => {
                        let build: fn(&dyn Shapes, &$parameters) -> $variant = $build;
                        Self::$variant(build(shapes, &p))
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

            #[inline]
            fn traverse_packet<V: PacketVisitor>(
                &self,
                packet: &mut Packet<'_>,
                visitor: &mut V,
                stats: &mut TraversalStats,
            ) -> bool {
                match self { $(Self::$variant(a) => a.traverse_packet(packet, visitor, stats),)+ }
            }

            fn misses(&self, beam: &Beam) -> bool {
                match self { $(Self::$variant(a) => a.misses(beam),)+ }
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

// The table of accelerators: a new one is one line here (its name, its type with its parameters, how it is built).
accelerators! {
    /// No structure: every primitive for every ray.
    "list" List(NoParameters) = |shapes, _| List::build(&all_bounds(shapes)),
    /// The hierarchy of bounding spheres.
    "spheres" Spheres(SpheresParameters) = Spheres::build,
    /// The binary bounding volume hierarchy: the readable reference.
    "bvh2" Bvh2(NoParameters) = |shapes, _| Bvh2::build(&all_bounds(shapes)),
    /// The bounding volume hierarchy of width eight.
    "bvh" Bvh8(Bvh8Parameters) = Bvh8::build_from,
    /// A regular grid.
    "grid" Grid(GridParameters) = Grid::build,
    /// Grids within the crowded cells of grids.
    "grids" Grids(GridParameters) = Grids::build,
    /// The octree.
    "octree" Octree(OctreeParameters) = Octree::build,
}

impl AnyAccelerator {
    /// Builds the structure over boxes `0..n`.
    pub fn build(kind: AcceleratorKind, bounds: &[Aabb]) -> Self {
        Self::build_from(kind, &Boxes(bounds))
    }

    /// Whether it uses as little memory as possible (see [`Bvh8::compacted`]).
    pub fn is_compact(&self) -> bool {
        matches!(self, Self::Bvh8(bvh) if bvh.is_compact())
    }

    /// Moves a large structure to large pages of memory once it is built, so that rays wait less for memory.
    pub fn gather_pages(&self) {
        if let Self::Bvh8(bvh) = self {
            bvh.gather_pages();
        }
    }

    /// The instruction set of the traversal: only [`Bvh8`] has vector kernels.
    pub fn simd(&self) -> Level {
        match self {
            Self::Bvh8(bvh) => bvh.simd(),
            _ => Level::Portable,
        }
    }
}

impl AcceleratorKind {
    /// The same structure, traversed with another instruction set if it has vector kernels.
    #[must_use]
    pub fn with_simd(self, level: Level) -> Self {
        match self {
            Self::Bvh8(parameters) => Self::Bvh8(Bvh8Parameters {
                simd: Some(level),
                ..parameters
            }),
            other => other,
        }
    }
}

impl Default for AcceleratorKind {
    fn default() -> Self {
        Self::Bvh8(Bvh8Parameters::DEFAULT)
    }
}

/// There is no accelerator of that name, or it has no such parameter.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownAccelerator(String);

impl fmt::Display for UnknownAccelerator {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for UnknownAccelerator {}

impl FromStr for AcceleratorKind {
    type Err = UnknownAccelerator;

    fn from_str(s: &str) -> Result<Self, Self::Err> {
        let (name, parameters) = s.split_once(':').unwrap_or((s, ""));
        let kind = Self::ALL.iter().copied().find(|k| k.name() == name);
        let Some(kind) = kind else {
            let names: Vec<&str> = Self::ALL.iter().map(|k| k.name()).collect();
            return Err(UnknownAccelerator(format!(
                "unknown accelerator `{name}`; there are: {}",
                names.join(", ")
            )));
        };
        kind.with_parameters(parameters).map_err(UnknownAccelerator)
    }
}
