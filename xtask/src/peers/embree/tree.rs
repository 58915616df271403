//! Uses Embree's builder by itself: it calls back for every node and leaf, so that the finished tree can be examined.

use super::{Device, Handle, Quality};
use crate::peers::wide_tree::{Child, Node, Tree};
use anyhow::{Result, bail};
use std::ffi::{c_uint, c_void};
use std::ptr;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// `struct RTCBuildPrimitive`.
#[repr(C, align(32))]
#[derive(Clone, Copy)]
struct Primitive {
    lower: [f32; 3],
    geometry: c_uint,
    upper: [f32; 3],
    id: c_uint,
}

/// `struct RTCBounds`.
#[repr(C, align(16))]
#[derive(Clone, Copy)]
struct Bounds {
    lower: [f32; 3],
    _pad: f32,
    upper: [f32; 3],
    _too: f32,
}

type CreateNode = extern "C" fn(Handle, c_uint, *const Growing<'_>) -> Handle;
type SetChildren = unsafe extern "C" fn(Handle, *const Handle, c_uint, *const Growing<'_>);
type SetBounds = unsafe extern "C" fn(Handle, *const *const Bounds, c_uint, *const Growing<'_>);
type CreateLeaf =
    unsafe extern "C" fn(Handle, *const Primitive, usize, *const Growing<'_>) -> Handle;
type Split = unsafe extern "C" fn(
    *const Primitive,
    c_uint,
    f32,
    *mut Bounds,
    *mut Bounds,
    *const Growing<'_>,
);

/// `struct RTCBuildArguments`.
#[repr(C)]
pub(super) struct Arguments<'g> {
    size: usize,
    quality: c_uint,
    flags: c_uint,
    branching: c_uint,
    depth: c_uint,
    block: c_uint,
    smallest_leaf: c_uint,
    largest_leaf: c_uint,
    node_cost: f32,
    block_cost: f32,
    bvh: Handle,
    primitives: *mut Primitive,
    count: usize,
    capacity: usize,
    create_node: CreateNode,
    set_children: SetChildren,
    set_bounds: SetBounds,
    create_leaf: CreateLeaf,
    split: Split,
    progress: *const c_void,
    growing: *const Growing<'g>,
}

/// The data of the callbacks.
struct Growing<'m> {
    positions: &'m [[f32; 3]],
    indices: &'m [[u32; 3]],
    tree: Mutex<Grown>,
}

/// The tree built so far.
#[derive(Default)]
struct Grown {
    tree: Tree,
    leaves: Vec<Child>,
}

impl Growing<'_> {
    fn tree(&self) -> MutexGuard<'_, Grown> {
        self.tree.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Handles of nodes and leaves are not addresses but numbers from 1 on: even for nodes, odd for leaves.
fn handle(number: usize, leaf: bool) -> Handle {
    ptr::without_provenance_mut((number + 1) << 1 | usize::from(leaf))
}

impl Grown {
    fn number(handle: Handle) -> usize {
        (handle.addr() >> 1) - 1
    }

    fn child(&self, handle: Handle) -> Child {
        let number = Self::number(handle);
        match handle.addr() & 1 {
            0 => Child::Node(number),
            _ => self.leaves[number],
        }
    }
}

extern "C" fn create_node(_: Handle, _: c_uint, growing: *const Growing<'_>) -> Handle {
    // SAFETY: the pointer comes from the arguments of the build and is valid until the build ends.
    let mut grown = unsafe { &*growing }.tree();
    grown.tree.nodes.push(Node::default());
    handle(grown.tree.nodes.len() - 1, false)
}

unsafe extern "C" fn set_children(
    node: Handle,
    children: *const Handle,
    count: c_uint,
    growing: *const Growing<'_>,
) {
    // SAFETY: as above; Embree passes as many children as it says.
    let (growing, children) = unsafe {
        (
            &*growing,
            std::slice::from_raw_parts(children, count as usize),
        )
    };
    let mut grown = growing.tree();
    for (place, child) in children.iter().enumerate() {
        let child = grown.child(*child);
        grown.tree.nodes[Grown::number(node)].set_child(place, child);
    }
}

unsafe extern "C" fn set_bounds(
    node: Handle,
    bounds: *const *const Bounds,
    count: c_uint,
    growing: *const Growing<'_>,
) {
    // SAFETY: as above; Embree passes as many boxes as it says.
    let (growing, bounds) = unsafe {
        (
            &*growing,
            std::slice::from_raw_parts(bounds, count as usize),
        )
    };
    let mut grown = growing.tree();
    for (place, bounds) in bounds.iter().enumerate() {
        // SAFETY: each points to a box.
        let bounds = unsafe { **bounds };
        let corners = [bounds.lower, bounds.upper];
        grown.tree.nodes[Grown::number(node)].set_box(place, corners);
    }
}

unsafe extern "C" fn create_leaf(
    _: Handle,
    primitives: *const Primitive,
    count: usize,
    growing: *const Growing<'_>,
) -> Handle {
    // SAFETY: as above; Embree passes as many primitives as it says.
    let (growing, primitives) =
        unsafe { (&*growing, std::slice::from_raw_parts(primitives, count)) };
    let mut grown = growing.tree();
    let leaf = grown.tree.leaf(primitives.iter().map(|p| p.id));
    grown.leaves.push(leaf);
    handle(grown.leaves.len() - 1, true)
}

/// Splits a triangle like Embree's own splitter: returns the boxes of both sides of a plane, within the box of the part that is
/// split.
unsafe extern "C" fn split(
    primitive: *const Primitive,
    axis: c_uint,
    at: f32,
    left: *mut Bounds,
    right: *mut Bounds,
    growing: *const Growing<'_>,
) {
    // SAFETY: as above; the primitive is one of those given, with a smaller box.
    let (growing, primitive) = unsafe { (&*growing, *primitive) };
    let axis = axis as usize;
    let corners = growing.indices[primitive.id as usize];
    let corners = corners.map(|i| growing.positions[i as usize]);
    let empty = [[f32::INFINITY; 3], [f32::NEG_INFINITY; 3]];
    let mut sides = [empty; 2];
    let mut extend = |side: usize, point: [f32; 3]| {
        for (axis, x) in point.into_iter().enumerate() {
            let [lo, hi] = &mut sides[side];
            lo[axis] = lo[axis].min(x);
            hi[axis] = hi[axis].max(x);
        }
    };
    for (i, p) in corners.into_iter().enumerate() {
        let q = corners[(i + 1) % 3];
        if p[axis] <= at {
            extend(0, p);
        }
        if p[axis] >= at {
            extend(1, p);
        }
        if (p[axis] < at && at < q[axis]) || (q[axis] < at && at < p[axis]) {
            let part = (at - p[axis]) / (q[axis] - p[axis]);
            let crossing = std::array::from_fn(|axis| p[axis] + part * (q[axis] - p[axis]));
            extend(0, crossing);
            extend(1, crossing);
        }
    }
    for (to, [lo, hi]) in [left, right].into_iter().zip(sides) {
        let within = Bounds {
            lower: std::array::from_fn(|axis| lo[axis].max(primitive.lower[axis])),
            _pad: 0.0,
            upper: std::array::from_fn(|axis| hi[axis].min(primitive.upper[axis])),
            _too: 0.0,
        };
        // SAFETY: Embree passes a place for a box on either side.
        unsafe { *to = within };
    }
}

impl Device<'_> {
    /// Builds the tree that Embree builds for triangles (`BVH8Triangle4`): blocks of four, up to seven blocks in a leaf, and a
    /// block costs as much as a node. At high quality, spatial splits make up to a fifth more parts than triangles.
    pub(in crate::peers) fn tree(
        &self,
        positions: &[[f32; 3]],
        indices: &[[u32; 3]],
        quality: Quality,
    ) -> Result<Tree> {
        let primitive = |(id, triangle): (u32, &[u32; 3])| {
            let corners = triangle.map(|i| positions[i as usize]);
            let fold = |pick: fn(f32, f32) -> f32| {
                let [a, b, c] = corners;
                std::array::from_fn(|axis| pick(pick(a[axis], b[axis]), c[axis]))
            };
            Primitive {
                lower: fold(f32::min),
                geometry: 0,
                upper: fold(f32::max),
                id,
            }
        };
        let mut primitives: Vec<Primitive> = (0..).zip(indices).map(primitive).collect();
        let count = primitives.len();
        if let (Quality::High, Some(last)) = (quality, primitives.last().copied()) {
            primitives.resize(count + count / 5, last);
        }
        let growing = Growing {
            positions,
            indices,
            tree: Mutex::default(),
        };
        // SAFETY: the arguments and what they point to have the layout of Embree's headers and live until the call returns.
        let root = unsafe {
            let bvh = (self.embree.new_bvh)(self.handle);
            let arguments = Arguments {
                size: size_of::<Arguments<'_>>(),
                quality: quality as c_uint,
                flags: 0,
                branching: 8,
                depth: 32,
                block: 4,
                smallest_leaf: 4,
                largest_leaf: 28,
                node_cost: 1.0,
                block_cost: 1.0,
                bvh,
                primitives: primitives.as_mut_ptr(),
                count,
                capacity: primitives.len(),
                create_node,
                set_children,
                set_bounds,
                create_leaf,
                split,
                progress: ptr::null(),
                growing: &growing,
            };
            let root = (self.embree.build_bvh)(&arguments);
            (self.embree.release_bvh)(bvh);
            root
        };
        if root.is_null() {
            bail!("Embree built no tree");
        }
        let grown = growing.tree.into_inner();
        let mut grown = grown.unwrap_or_else(PoisonError::into_inner);
        grown.tree.root = grown.child(root);
        Ok(grown.tree)
    }
}
