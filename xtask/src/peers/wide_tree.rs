//! Trees over the triangles of a mesh whose nodes have up to eight children, whichever program has built them.

/// Children of a node.
const WIDTH: usize = 8;

/// A tree of nodes with up to eight children over the triangles of a mesh.
#[derive(Default)]
pub(super) struct Tree {
    pub(super) root: Child,
    pub(super) nodes: Vec<Node>,
    /// The triangles of the leaves.
    pub(super) ids: Vec<u32>,
}

/// The content of a box.
#[derive(Clone, Copy)]
pub(super) enum Child {
    Node(usize),
    /// A leaf: its first index in the list, and its length.
    Leaf(usize, usize),
}

impl Default for Child {
    fn default() -> Self {
        Self::Leaf(0, 0)
    }
}

/// The children of a node with their boxes: for each axis the lower planes, then the upper planes.
#[derive(Clone)]
pub(super) struct Node {
    pub(super) planes: [[f32; WIDTH]; 6],
    pub(super) children: [Child; WIDTH],
    pub(super) count: usize,
}

impl Default for Node {
    fn default() -> Self {
        Self {
            planes: [[0.0; WIDTH]; 6],
            children: [Child::default(); WIDTH],
            count: 0,
        }
    }
}

impl Node {
    /// Sets the lowest and the highest corner of a child's box. Children are numbered from 0.
    pub(super) fn set_box(&mut self, place: usize, [lo, hi]: [[f32; 3]; 2]) {
        for axis in 0..3 {
            self.planes[2 * axis][place] = lo[axis];
            self.planes[2 * axis + 1][place] = hi[axis];
        }
    }

    /// Sets a child.
    pub(super) fn set_child(&mut self, place: usize, child: Child) {
        self.children[place] = child;
        self.count = self.count.max(place + 1);
    }
}

impl Tree {
    /// Adds the triangles of a leaf.
    pub(super) fn leaf(&mut self, ids: impl Iterator<Item = u32>) -> Child {
        let first = self.ids.len();
        self.ids.extend(ids);
        Child::Leaf(first, self.ids.len() - first)
    }
}
