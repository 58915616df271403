use super::{Block, Cell, Octree, OctreeParameters, Split, child_box};
use crate::Shapes;
use crate::cells::Base;
use crate::shapes::BoxesOnly;
use crate::walk::Room;
use rayon::prelude::*;
use strahl_math::{Aabb, DVec3};

/// Cells with more primitives are divided by several threads.
const PARALLEL: usize = 1024;

/// The cost of a step into a cell, in units of a primitive test.
const STEP_COST: f64 = 1.0;

/// Planes tried along each axis.
const CANDIDATES: usize = 16;

impl Octree {
    /// Divides space.
    pub fn build(shapes: &dyn Shapes, parameters: &OctreeParameters) -> Self {
        let (base, ids) = Base::gather(shapes, parameters.havran);
        let mut octree = Self {
            base,
            root: Cell::default(),
            blocks: Vec::new(),
            ids: Vec::new(),
            traversal: parameters.traversal,
        };
        if let Some(room) = octree.base.room {
            let boxes = BoxesOnly(shapes);
            let builder = Builder {
                shapes: if parameters.havran { &boxes } else { shapes },
                room,
                parameters: *parameters,
            };
            octree.root = octree.add(builder.cell(ids, &room.root, 0));
        }
        octree
    }

    /// Adds a cell and its subtree, depth first. Recursion is as deep as the tree.
    fn add(&mut self, part: Part) -> Cell {
        match part {
            Part::Leaf(ids) => {
                let first = self.ids.len() as u32;
                self.ids.extend(&ids);
                Cell {
                    first,
                    count: ids.len() as u32,
                }
            }
            Part::Divided(split, children) => {
                let number = self.blocks.len();
                self.blocks.push(Block {
                    split,
                    children: [Cell::default(); 8],
                });
                for (place, child) in children.into_iter().enumerate() {
                    let cell = self.add(child);
                    self.blocks[number].children[place] = cell;
                }
                Cell {
                    first: number as u32,
                    count: Cell::DIVIDED,
                }
            }
        }
    }
}

/// A cell while the tree is built.
enum Part {
    Leaf(Vec<u32>),
    Divided(DVec3, Vec<Part>),
}

struct Builder<'s> {
    shapes: &'s dyn Shapes,
    room: Room,
    parameters: OctreeParameters,
}

impl Builder<'_> {
    fn cell(&self, ids: Vec<u32>, cell: &Aabb, level: u32) -> Part {
        let p = &self.parameters;
        let too_small = cell.size().max_element() < 2.0 * self.room.smallest_cell();
        if ids.len() <= p.leaf as usize || level >= p.depth || too_small {
            return Part::Leaf(ids);
        }
        let split = match p.split {
            Split::Centre => cell.center(),
            Split::Cost => self.cheapest_split(&ids, cell),
        };
        let children: Vec<(Aabb, Vec<u32>)> = (0..8)
            .map(|child| {
                let b = child_box(cell, split, child);
                let inside = self.inside(&ids, &b);
                (b, inside)
            })
            .collect();
        if !p.havran && !self.pays(&ids, cell, &children) {
            return Part::Leaf(ids);
        }
        let parallel = ids.len() > PARALLEL;
        drop(ids);
        let divide = |(b, ids): (Aabb, Vec<u32>)| self.cell(ids, &b, level + 1);
        let parts = if parallel {
            children.into_par_iter().map(divide).collect()
        } else {
            children.into_iter().map(divide).collect()
        };
        Part::Divided(split, parts)
    }

    /// The primitives that may reach into a box.
    fn inside(&self, ids: &[u32], b: &Aabb) -> Vec<u32> {
        let padded = b.padded(DVec3::splat(self.room.pad));
        let meets = |id: &u32| {
            let own = self.shapes.bounds(*id);
            let apart = own.max.cmplt(padded.min).any() || own.min.cmpgt(padded.max).any();
            !apart && self.shapes.overlaps(*id, &padded)
        };
        let serial = || ids.iter().copied().filter(|id| meets(id)).collect();
        if ids.len() > PARALLEL {
            ids.par_iter().copied().filter(meets).collect()
        } else {
            serial()
        }
    }

    /// Whether rays are expected to cost less with these children than if all primitives were tested: the probability that a
    /// ray through the cell passes through a child is their ratio of areas.
    fn pays(&self, ids: &[u32], cell: &Aabb, children: &[(Aabb, Vec<u32>)]) -> bool {
        let area = cell.half_area();
        let cost: f64 = children
            .iter()
            .map(|(b, ids)| b.half_area() / area * (STEP_COST + ids.len() as f64))
            .sum();
        cost < LOOKAHEAD * ids.len() as f64
    }

    /// For each axis separately the plane with the smallest sum of area times primitives on both sides. (Whang et al.:
    /// Octree-R, 1995.)
    fn cheapest_split(&self, ids: &[u32], cell: &Aabb) -> DVec3 {
        let mut split = cell.center();
        for axis in 0..3 {
            let (min, size) = (cell.min[axis], cell.size()[axis]);
            if size < 4.0 * self.room.smallest_cell() {
                continue;
            }
            // How many begin before each plane, and how many end behind it.
            let (mut begun, mut ended) = ([0u32; CANDIDATES + 1], [0u32; CANDIDATES + 1]);
            let bin =
                |x: f64| (((x - min) / size * (CANDIDATES + 1) as f64) as usize).min(CANDIDATES);
            for id in ids {
                let b = self.shapes.bounds(*id);
                begun[bin(b.min[axis])] += 1;
                ended[bin(b.max[axis])] += 1;
            }
            let (mut below, mut done) = (0, 0);
            let mut best = (f64::INFINITY, 0);
            let others = [(axis + 1) % 3, (axis + 2) % 3].map(|a| cell.size()[a]);
            let area = |length: f64| others[0] * others[1] + length * (others[0] + others[1]);
            for plane in 1..=CANDIDATES {
                below += begun[plane - 1];
                done += ended[plane - 1];
                let part = plane as f64 / (CANDIDATES + 1) as f64;
                let above = ids.len() as u32 - done;
                let cost = area(size * part) * f64::from(below)
                    + area(size * (1.0 - part)) * f64::from(above);
                // Of equal ones the one nearest to the middle.
                let candidate = (cost, (2 * plane).abs_diff(CANDIDATES + 1));
                if candidate < best {
                    best = candidate;
                    split[axis] = min + size * part;
                }
            }
        }
        split
    }
}

/// A division may pay only further down, so it may cost this much more at first.
const LOOKAHEAD: f64 = 1.25;
