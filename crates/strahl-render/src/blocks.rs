use crate::prim::{Prim, PrimKind};
use crate::scene::{MeshUse, ShapeUse};
use strahl_accel::NO_PRIMITIVE;
use strahl_geometry::blocks::{Hits, LANES, PacketLines, PacketShears, SphereBlock, TriangleBlock};
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
        match prim.kind() {
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
            let used = used.map(|(lane, id)| (lane, prims[*id as usize].kind()));
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

    /// Whether there are spheres among them.
    pub(crate) fn has_spheres(&self) -> bool {
        !self.spheres.is_empty()
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
}

/// Visibility and flags of the primitives that are tested in blocks, if all have the same.
pub(crate) fn common(prims: &[Prim], shapes: &[ShapeUse], meshes: &[MeshUse]) -> Option<(u8, u8)> {
    let mut all = prims
        .iter()
        .filter(|p| LeafClass::of(p, shapes, meshes) != LeafClass::Single)
        .map(|p| (p.visible, p.flags));
    let first = all.next()?;
    all.all(|p| p == first).then_some(first)
}

fn push<T>(list: &mut Vec<T>, item: T) -> u32 {
    list.push(item);
    list.len() as u32 - 1
}

/// The rays of a packet as blocks see them; `None` where they have too little in common, or no block asks.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PacketCulls<'c> {
    pub(crate) shears: Option<&'c PacketShears>,
    pub(crate) lines: Option<&'c PacketLines>,
}

/// A block of primitives of one class.
pub(crate) trait Block: Sized {
    /// Whether a ray that starts on a primitive may meet that primitive again.
    const CURVED: bool;

    /// The block of this class with a number.
    fn of(blocks: &Blocks, number: usize) -> &Self;

    /// The lanes that the ray meets in the range, as bits, with where; those that it starts on mean nothing.
    fn hits<I: Isa>(
        &self,
        isa: I,
        ray: &Ray,
        shear: &RayShear,
        range: Interval,
        hits: &mut Hits,
    ) -> u32;

    /// The rays of a packet that may meet one of the first `used` primitives, as bits: those that are missing certainly meet none.
    fn may_hit<I: Isa>(&self, isa: I, packet: &PacketCulls<'_>, used: usize) -> u32;

    /// Whether a ray that starts on the primitive of a lane may meet it again ahead.
    fn is_entered(&self, _lane: usize, _ray: &Ray) -> bool {
        Self::CURVED
    }
}

impl Block for TriangleBlock<f32> {
    const CURVED: bool = false;

    #[inline(always)]
    fn of(blocks: &Blocks, number: usize) -> &Self {
        &blocks.mesh[blocks.place(number)]
    }

    #[inline(always)]
    fn hits<I: Isa>(
        &self,
        isa: I,
        _: &Ray,
        shear: &RayShear,
        range: Interval,
        hits: &mut Hits,
    ) -> u32 {
        self.hits(isa, shear, range, hits)
    }

    #[inline(always)]
    fn may_hit<I: Isa>(&self, isa: I, packet: &PacketCulls<'_>, used: usize) -> u32 {
        match packet.shears {
            Some(shears) => self.may_hit(isa, shears, used),
            None => u32::MAX,
        }
    }
}

impl Block for TriangleBlock<f64> {
    const CURVED: bool = false;

    #[inline(always)]
    fn of(blocks: &Blocks, number: usize) -> &Self {
        &blocks.triangles[blocks.place(number)]
    }

    #[inline(always)]
    fn hits<I: Isa>(
        &self,
        isa: I,
        _: &Ray,
        shear: &RayShear,
        range: Interval,
        hits: &mut Hits,
    ) -> u32 {
        self.hits(isa, shear, range, hits)
    }

    #[inline(always)]
    fn may_hit<I: Isa>(&self, isa: I, packet: &PacketCulls<'_>, used: usize) -> u32 {
        match packet.shears {
            Some(shears) => self.may_hit(isa, shears, used),
            None => u32::MAX,
        }
    }
}

impl Block for SphereBlock {
    const CURVED: bool = true;

    #[inline(always)]
    fn of(blocks: &Blocks, number: usize) -> &Self {
        &blocks.spheres[blocks.place(number)]
    }

    #[inline(always)]
    fn hits<I: Isa>(
        &self,
        isa: I,
        ray: &Ray,
        _: &RayShear,
        range: Interval,
        hits: &mut Hits,
    ) -> u32 {
        self.hits(isa, ray, range, hits)
    }

    #[inline(always)]
    fn may_hit<I: Isa>(&self, isa: I, packet: &PacketCulls<'_>, used: usize) -> u32 {
        match packet.lines {
            Some(lines) => self.may_hit(isa, lines, used),
            None => u32::MAX,
        }
    }

    #[inline(always)]
    fn is_entered(&self, lane: usize, ray: &Ray) -> bool {
        self.is_entered(lane, ray)
    }
}
