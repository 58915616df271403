use crate::prim::{Prim, PrimKind};
use crate::runs::RunList;
use crate::spheres::Spheres;
use crate::uses::{MeshUse, ShapeUse};
use strahl_accel::{Accelerator, AnyAccelerator, NO_PRIMITIVE};
use strahl_geometry::Shape;
use strahl_geometry::blocks::{LANES, PolygonBlock, SphereBlock, TriangleBlock};
use strahl_simd::gather_pages;

/// How the primitives of a leaf are tested; the discriminants are the accelerator's classes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub(crate) enum LeafClass {
    /// One by one.
    Single = 0,
    /// Triangles of meshes, whose corners are f32.
    Mesh = 1,
    /// Triangles with f64 corners, and polygons.
    Flats = 2,
    /// Spheres.
    Spheres = 3,
}

/// The lists that hold the primitives of a group.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lists<'g> {
    pub(crate) prims: &'g RunList<Prim>,
    pub(crate) shapes: &'g [ShapeUse],
    pub(crate) spheres: &'g Spheres,
    pub(crate) meshes: &'g [MeshUse],
}

impl LeafClass {
    /// The class of a primitive.
    pub(crate) fn of(prim: Prim, lists: &Lists<'_>) -> Self {
        match prim.kind() {
            PrimKind::Triangle(mesh, _)
                if lists.meshes[mesh as usize].mesh.anchor() == strahl_math::DVec3::ZERO =>
            {
                Self::Mesh
            }
            PrimKind::Sphere(_) => Self::Spheres,
            PrimKind::Shape(index) => match lists.shapes[index as usize].shape {
                Shape::Triangle(_) | Shape::Polygon(_) => Self::Flats,
                Shape::Sphere(_) => Self::Spheres,
                _ => Self::Single,
            },
            _ => Self::Single,
        }
    }

    /// The class with this number.
    #[inline(always)]
    pub(crate) const fn from_number(number: u8) -> Self {
        match number {
            1 => Self::Mesh,
            2 => Self::Flats,
            3 => Self::Spheres,
            _ => Self::Single,
        }
    }
}

/// Copies of the primitives of a group, side by side in the order of the leaves, for those classes that are tested four at a
/// time.
#[derive(Debug, Default)]
pub(crate) struct Blocks {
    /// For each block of slots its index in the list of its class; empty if the indices equal the numbers of the blocks.
    places: Vec<u32>,
    mesh: Vec<TriangleBlock<f32>>,
    triangles: Vec<TriangleBlock<f64>>,
    /// Flat primitives that are not all triangles; their places have [`Self::POLYGONS`] set.
    polygons: Vec<PolygonBlock>,
    spheres: Vec<SphereBlock>,
    /// Whether triangles of meshes have no blocks, to save memory: their corners are fetched from the meshes.
    fetches: bool,
}

impl Blocks {
    /// Distinguishes places of polygon blocks from those of triangle blocks.
    const POLYGONS: u32 = 1 << 31;

    /// The blocks for the leaves of an accelerator.
    pub(crate) fn new(accelerator: &AnyAccelerator, lists: &Lists<'_>) -> Self {
        let mut all = Self {
            fetches: accelerator.is_compact(),
            ..Self::default()
        };
        for block in accelerator.slots().chunks(LANES) {
            let class = lists
                .prims
                .get(block[0])
                .map_or(LeafClass::Single, |p| LeafClass::of(p, lists));
            let used = block
                .iter()
                .enumerate()
                .filter(|(_, id)| **id != NO_PRIMITIVE);
            let used = used.map(|(lane, id)| (lane, lists.prims.at(*id)));
            let shape = |kind| match kind {
                PrimKind::Shape(index) => Some(&lists.shapes[index as usize].shape),
                _ => None,
            };
            let place = match class {
                LeafClass::Single => 0,
                LeafClass::Mesh if all.fetches => 0,
                LeafClass::Mesh => {
                    let mut four = TriangleBlock::EMPTY;
                    for (lane, prim) in used {
                        if let PrimKind::Triangle(mesh, triangle) = prim.kind()
                            && let Some(corners) =
                                lists.meshes[mesh as usize].mesh.stored_corners(triangle)
                        {
                            four.set(lane, corners);
                        }
                    }
                    push(&mut all.mesh, four)
                }
                LeafClass::Flats => {
                    let (mut triangles, mut polygons) = (TriangleBlock::EMPTY, PolygonBlock::EMPTY);
                    let mut mixed = false;
                    for (lane, prim) in used {
                        match shape(prim.kind()) {
                            Some(Shape::Triangle(t)) => {
                                triangles.set(lane, t.corners().map(|p| p.to_array()));
                                polygons.set_other(lane);
                            }
                            Some(Shape::Polygon(p)) => {
                                mixed = true;
                                polygons.set(lane, p, prim.flags & Prim::ONE_SIDED != 0);
                            }
                            _ => {}
                        }
                    }
                    if mixed {
                        push(&mut all.polygons, polygons) | Self::POLYGONS
                    } else {
                        push(&mut all.triangles, triangles)
                    }
                }
                LeafClass::Spheres => {
                    let mut four = SphereBlock::EMPTY;
                    for (lane, prim) in used {
                        if let PrimKind::Sphere(number) = prim.kind() {
                            four.set(lane, &lists.spheres.loose(number));
                        } else if let Some(Shape::Sphere(s)) = shape(prim.kind()) {
                            four.set(lane, s);
                        }
                    }
                    push(&mut all.spheres, four)
                }
            };
            all.places.push(place);
        }
        if all.places.iter().enumerate().all(|(i, p)| i == *p as usize) {
            all.places = Vec::new();
        }
        all
    }

    /// Whether there are triangles with f64 corners.
    pub(crate) fn has_triangles(&self) -> bool {
        !self.triangles.is_empty()
    }

    /// Whether triangles of meshes have no blocks.
    #[inline(always)]
    pub(crate) fn fetches(&self) -> bool {
        self.fetches
    }

    /// All blocks in the order of the leaves, if they are of one kind that has a specialised search.
    #[inline(always)]
    pub(crate) fn of_one_kind(&self) -> Option<OneKind<'_>> {
        if !self.places.is_empty() {
            None
        } else if !self.mesh.is_empty() {
            Some(OneKind::Triangles(&self.mesh))
        } else if !self.spheres.is_empty() {
            Some(OneKind::Spheres(&self.spheres))
        } else {
            None
        }
    }

    /// Whether there are blocks of spheres.
    pub(crate) fn has_spheres(&self) -> bool {
        !self.spheres.is_empty()
    }

    /// Moves the blocks to large pages where there are many of them.
    pub(crate) fn gather_pages(&self) {
        gather_pages(&self.mesh);
        gather_pages(&self.triangles);
        gather_pages(&self.spheres);
    }

    /// Bytes they occupy.
    pub(crate) fn bytes(&self) -> usize {
        size_of_val(self.places.as_slice())
            + size_of_val(self.mesh.as_slice())
            + size_of_val(self.triangles.as_slice())
            + size_of_val(self.polygons.as_slice())
            + size_of_val(self.spheres.as_slice())
    }

    /// The blocks of spheres.
    #[inline(always)]
    pub(crate) fn spheres(&self) -> &[SphereBlock] {
        &self.spheres
    }

    /// The block of mesh triangles that is this block of slots.
    #[inline(always)]
    pub(crate) fn mesh(&self, block: usize) -> &TriangleBlock<f32> {
        &self.mesh[self.place(block)]
    }

    /// A block of flat primitives.
    #[inline(always)]
    pub(crate) fn flats(&self, block: usize) -> Flats<'_> {
        let place = self.place(block);
        match place & Self::POLYGONS as usize {
            0 => Flats::Triangles(&self.triangles[place]),
            _ => Flats::Polygons(&self.polygons[place ^ Self::POLYGONS as usize]),
        }
    }

    /// The index of a block of slots in the list of its class.
    #[inline(always)]
    pub(crate) fn place(&self, block: usize) -> usize {
        if self.places.is_empty() {
            block
        } else {
            self.places[block] as usize
        }
    }
}

/// All blocks of a group that has only one kind of block.
#[derive(Clone, Copy)]
pub(crate) enum OneKind<'b> {
    /// Of meshes.
    Triangles(&'b [TriangleBlock<f32>]),
    Spheres(&'b [SphereBlock]),
}

/// A block of flat primitives.
#[derive(Clone, Copy)]
pub(crate) enum Flats<'b> {
    Triangles(&'b TriangleBlock<f64>),
    Polygons(&'b PolygonBlock),
}

/// Visibility and flags of the primitives that are tested in blocks, if they are the same for all.
pub(crate) fn uniform_flags(lists: &Lists<'_>) -> Option<(u8, u8)> {
    let found = |p: &Prim| match p.kind() {
        PrimKind::Shape(index) => {
            let shape = &lists.shapes[index as usize].shape;
            matches!(shape, Shape::Triangle(_) | Shape::Sphere(_))
        }
        _ => LeafClass::of(*p, lists) != LeafClass::Single,
    };
    let mut all = lists.prims.runs().filter_map(|(first, places)| {
        // Shapes may differ from each other within a run; of all other primitives the first of a run stands for the whole run.
        let asked = match first.kind() {
            PrimKind::Shape(_) => places,
            _ => places.start..places.start + 1,
        };
        let mut asked = asked.map(|index| lists.prims.at(index));
        let any = asked.any(|p| found(&p));
        any.then_some((first.visible, first.flags))
    });
    let first = all.next()?;
    all.all(|p| p == first).then_some(first)
}

fn push<T>(list: &mut Vec<T>, item: T) -> u32 {
    list.push(item);
    list.len() as u32 - 1
}
