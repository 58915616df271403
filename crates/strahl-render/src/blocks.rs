use crate::scene::{MeshUse, Prim, PrimKind, ShapeUse};
use strahl_accel::NO_PRIMITIVE;
use strahl_geometry::blocks::{Coordinate, LANES, SphereBlock, TriangleBlock};
use strahl_geometry::{RayShear, Shape};
use strahl_math::{Interval, Ray};
use strahl_simd::Isa;

/// How the primitives of a leaf are tested; the numbers are the accelerator's classes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub(crate) enum LeafClass {
    /// One by one.
    Single = 0,
    /// Triangles of meshes, whose corners are f32.
    Mesh = 1,
    /// Triangles with f64 corners.
    Triangles = 2,
    /// Spheres.
    Spheres = 3,
}

impl LeafClass {
    /// The class of a primitive.
    pub(crate) fn of(prim: &Prim, shapes: &[ShapeUse], meshes: &[MeshUse]) -> Self {
        match prim.kind {
            PrimKind::Triangle(mesh, _)
                if meshes[mesh as usize].mesh.anchor() == strahl_math::DVec3::ZERO =>
            {
                Self::Mesh
            }
            PrimKind::Shape(index) => match shapes[index as usize].shape {
                Shape::Triangle(_) => Self::Triangles,
                Shape::Sphere(_) => Self::Spheres,
                _ => Self::Single,
            },
            _ => Self::Single,
        }
    }

    /// The class with a number.
    #[inline(always)]
    pub(crate) const fn from_number(number: u8) -> Self {
        match number {
            1 => Self::Mesh,
            2 => Self::Triangles,
            3 => Self::Spheres,
            _ => Self::Single,
        }
    }
}

/// The primitives of a group once more, in the order of the leaves and side by side, for those classes that are tested four
/// at a time.
#[derive(Debug, Default)]
pub(crate) struct Blocks {
    /// Per block of slots the index in the list of its class; empty if that is the block's own number.
    places: Vec<u32>,
    mesh: Vec<TriangleBlock<f32>>,
    triangles: Vec<TriangleBlock<f64>>,
    spheres: Vec<SphereBlock>,
}

impl Blocks {
    /// The blocks for the slots of an accelerator.
    pub(crate) fn new(
        slots: &[u32],
        prims: &[Prim],
        shapes: &[ShapeUse],
        meshes: &[MeshUse],
    ) -> Self {
        let mut all = Self::default();
        for block in slots.chunks(LANES) {
            let class = prims
                .get(block[0] as usize)
                .map_or(LeafClass::Single, |p| LeafClass::of(p, shapes, meshes));
            let used = block
                .iter()
                .enumerate()
                .filter(|(_, id)| **id != NO_PRIMITIVE);
            let used = used.map(|(lane, id)| (lane, prims[*id as usize].kind));
            let shape = |kind| match kind {
                PrimKind::Shape(index) => Some(&shapes[index as usize].shape),
                _ => None,
            };
            let place = match class {
                LeafClass::Single => 0,
                LeafClass::Mesh => {
                    let mut four = TriangleBlock::EMPTY;
                    for (lane, kind) in used {
                        if let PrimKind::Triangle(mesh, triangle) = kind
                            && let Some(corners) =
                                meshes[mesh as usize].mesh.stored_corners(triangle)
                        {
                            four.set(lane, corners);
                        }
                    }
                    push(&mut all.mesh, four)
                }
                LeafClass::Triangles => {
                    let mut four = TriangleBlock::EMPTY;
                    for (lane, kind) in used {
                        if let Some(Shape::Triangle(t)) = shape(kind) {
                            four.set(lane, t.corners().map(|p| p.to_array()));
                        }
                    }
                    push(&mut all.triangles, four)
                }
                LeafClass::Spheres => {
                    let mut four = SphereBlock::EMPTY;
                    for (lane, kind) in used {
                        if let Some(Shape::Sphere(s)) = shape(kind) {
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

    /// Whether there are triangles among them.
    pub(crate) fn sheared(&self) -> bool {
        !self.mesh.is_empty() || !self.triangles.is_empty()
    }

    /// Bytes they occupy.
    pub(crate) fn bytes(&self) -> usize {
        size_of_val(self.places.as_slice())
            + size_of_val(self.mesh.as_slice())
            + size_of_val(self.triangles.as_slice())
            + size_of_val(self.spheres.as_slice())
    }

    #[inline(always)]
    fn place(&self, block: usize) -> usize {
        if self.places.is_empty() {
            block
        } else {
            self.places[block] as usize
        }
    }

    /// The block of triangles of meshes with a number.
    #[inline(always)]
    pub(crate) fn mesh(&self, block: usize) -> &TriangleBlock<f32> {
        &self.mesh[self.place(block)]
    }

    /// The block of f64 triangles with a number.
    #[inline(always)]
    pub(crate) fn triangles(&self, block: usize) -> &TriangleBlock<f64> {
        &self.triangles[self.place(block)]
    }

    /// The block of spheres with a number.
    #[inline(always)]
    pub(crate) fn spheres(&self, block: usize) -> &SphereBlock {
        &self.spheres[self.place(block)]
    }
}

fn push<T>(list: &mut Vec<T>, item: T) -> u32 {
    list.push(item);
    list.len() as u32 - 1
}

/// What a block finds out about one of its lanes.
pub(crate) trait LaneTests {
    /// The lanes that may be hit, as bits.
    fn candidates<I: Isa>(&self, isa: I, ray: &Ray, shear: &RayShear) -> u32;

    /// The hit on a lane: its parameter and two numbers.
    fn hit(
        &self,
        lane: usize,
        ray: &Ray,
        shear: &RayShear,
        range: Interval,
    ) -> Option<(f64, [f64; 2])>;
}

impl<T: Coordinate> LaneTests for TriangleBlock<T> {
    #[inline(always)]
    fn candidates<I: Isa>(&self, isa: I, _: &Ray, shear: &RayShear) -> u32 {
        self.candidates(isa, shear)
    }

    #[inline(always)]
    fn hit(
        &self,
        lane: usize,
        _: &Ray,
        shear: &RayShear,
        range: Interval,
    ) -> Option<(f64, [f64; 2])> {
        let hit = self.hit(lane, shear)?;
        range.accepts(hit.t).then_some((hit.t, [hit.u, hit.v]))
    }
}

impl LaneTests for SphereBlock {
    #[inline(always)]
    fn candidates<I: Isa>(&self, isa: I, ray: &Ray, _: &RayShear) -> u32 {
        self.candidates(isa, ray)
    }

    #[inline(always)]
    fn hit(
        &self,
        lane: usize,
        ray: &Ray,
        _: &RayShear,
        range: Interval,
    ) -> Option<(f64, [f64; 2])> {
        self.hit(lane, ray, range).map(|t| (t, [0.0; 2]))
    }
}
