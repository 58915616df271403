//! An octree of the cells that may contain a surface, examined when a ray first meets them.

use super::slopes::{Notes, Slopes};
use std::ops::ControlFlow;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU8, AtomicU64, Ordering};
use strahl_math::{Aabb, DVec3, Interval};

/// Directions are taken as having components of at least this part of the largest one, so that nothing is divided by zero.
const SLANT: f64 = 1.0 / (1u64 << 60) as f64;

/// What goes through the tree along a line.
pub(crate) trait Visitor {
    /// The origin and the direction of the line.
    fn line(&self) -> (DVec3, DVec3);
    /// What a cell holds of which nothing is known yet. The answer must depend on the cell alone.
    fn content(&mut self, cell: &Aabb) -> Content;
    /// The line is within a cell for the first time: on which side of the surface, if the cell holds none and that is known.
    fn begin(&mut self, _is_inside: Option<bool>) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
    /// A part of the line within a cell that may contain a surface.
    fn part(&mut self, enter: f64, exit: f64, cell: &Cell<'_>) -> ControlFlow<()>;
    /// Parts of the line that end before this are not needed.
    fn resume(&self) -> f64 {
        f64::NEG_INFINITY
    }
}

/// One of the smallest cells, which may contain a surface.
pub(crate) struct Cell<'a> {
    tree: &'a Octree,
    node: &'a Node,
    place: [u32; 3],
}

impl Cell<'_> {
    /// Bounds of the derivatives of a function within the cell, which `make` finds; `None` as long as they are not worthwhile.
    pub(crate) fn slopes(&self, make: impl FnOnce(&Aabb) -> Slopes) -> Option<&Slopes> {
        let notes = self.node.notes.get_or_init(Box::default);
        let slot = Slot::of(self.place, 0);
        notes.slopes(slot.0 as usize, || make(&self.tree.cell(self.place, 0)))
    }
}

/// What a cell holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Content {
    /// Perhaps a part of a surface.
    Surface,
    /// No surface; whether its places are inside of one is `None` if it is not known.
    Empty {
        /// Inside rather than outside.
        is_inside: Option<bool>,
    },
}

/// A tree of cells, all of which are halved equally often.
///
/// What a cell holds depends on the cell alone, so it does not matter which ray, of which thread, asks first.
#[derive(Debug)]
pub(crate) struct Octree {
    bounds: Aabb,
    /// How many of the smallest cells there are along each axis: a power of two.
    cells: u32,
    root: Node,
    is_root_full: OnceLock<bool>,
}

/// Two levels of the tree at once: 64 cells, of which bits tell what is known. A cell is numbered by two bits for each axis, x in the
/// lowest ones.
///
/// Bits are only ever set, each by threads that know the answer, and nothing else is published with them: so their order does not matter.
#[derive(Debug, Default)]
struct Node {
    /// The cells that contain no surface.
    empty: AtomicU64,
    /// Those of them that are known to be inside of one.
    inside: AtomicU64,
    /// Those of them that are known to be outside.
    outside: AtomicU64,
    /// The cells that may contain one.
    full: AtomicU64,
    /// The blocks of eight cells that may contain one, numbered by one bit for each axis.
    full_blocks: AtomicU8,
    /// The nodes of the cells, once one of them is met. The smallest cells have none.
    children: OnceLock<Box<[Node; 64]>>,
    /// What is noted about the smallest cells that may contain a surface.
    notes: OnceLock<Box<Notes>>,
}

/// Where a cell is in its node.
#[derive(Clone, Copy)]
struct Slot(u32);

impl Slot {
    /// The slot at this depth of the smallest cell with this place: cells there are `2^shift` of the smallest ones wide.
    #[inline(always)]
    fn of(place: [u32; 3], shift: u32) -> Self {
        let [x, y, z] = place;
        Self((x >> shift & 3) | (y >> shift & 3) << 2 | (z >> shift & 3) << 4)
    }

    #[inline(always)]
    fn bit(self) -> u64 {
        1 << self.0
    }

    /// The bits of the cells in the same block of eight.
    #[inline(always)]
    fn block(self) -> u64 {
        const FIRST: u64 = 0x0033_0033;
        FIRST << (self.0 & 0b10_1010)
    }

    /// The bit of the block of eight.
    fn block_bit(self) -> u8 {
        1 << (self.0 >> 1 & 1 | self.0 >> 2 & 2 | self.0 >> 3 & 4)
    }
}

impl Node {
    fn children(&self) -> &[Self; 64] {
        self.children
            .get_or_init(|| Box::new(std::array::from_fn(|_| Self::default())))
    }

    /// Finds out about a cell of which nothing is known: first about its block of eight, then about the cell itself.
    #[cold]
    fn examine(&self, slot: Slot, mut content: impl FnMut(Part) -> Content) {
        if self.full_blocks.load(Ordering::Relaxed) & slot.block_bit() == 0 {
            if let Content::Empty { is_inside } = content(Part::Block) {
                self.add_empty(slot.block(), is_inside);
                return;
            }
            self.full_blocks
                .fetch_or(slot.block_bit(), Ordering::Relaxed);
        }
        if let Content::Empty { is_inside } = content(Part::Cell) {
            self.add_empty(slot.bit(), is_inside);
        } else {
            self.full.fetch_or(slot.bit(), Ordering::Relaxed);
        }
    }

    /// Stores that cells contain no surface.
    fn add_empty(&self, cells: u64, is_inside: Option<bool>) {
        match is_inside {
            Some(true) => _ = self.inside.fetch_or(cells, Ordering::Relaxed),
            Some(false) => _ = self.outside.fetch_or(cells, Ordering::Relaxed),
            None => {}
        }
        self.empty.fetch_or(cells, Ordering::Relaxed);
    }

    /// On which side of the surface an empty cell is, if that is known.
    fn side(&self, slot: Slot) -> Option<bool> {
        let has = |cells: &AtomicU64| cells.load(Ordering::Relaxed) & slot.bit() != 0;
        match (has(&self.inside), has(&self.outside)) {
            (false, false) => None,
            (is_inside, _) => Some(is_inside),
        }
    }
}

/// What is examined of a node.
enum Part {
    Cell,
    Block,
}

/// The largest known cell around a place: whether it may contain a surface, and its width as a power of two of the smallest cells.
struct Found<'a> {
    is_full: bool,
    shift: u32,
    /// Where it is.
    node: &'a Node,
    slot: Slot,
}

/// A node, the depth of its cells and a place within.
#[derive(Clone, Copy)]
struct Around<'a> {
    node: &'a Node,
    place: [u32; 3],
    shift: u32,
}

impl Around<'_> {
    #[inline(always)]
    fn contains(&self, [x, y, z]: [u32; 3]) -> bool {
        let [a, b, c] = self.place;
        // A node has four cells along each axis.
        ((x ^ a) | (y ^ b) | (z ^ c)) >> self.shift < 4
    }
}

impl Found<'_> {
    fn side(&self) -> Option<bool> {
        if self.is_full {
            None
        } else {
            self.node.side(self.slot)
        }
    }
}

impl Octree {
    /// The tree of a box, of which nothing is known yet and whose cells are halved so often: 1 to 16 times.
    pub(crate) fn new(bounds: Aabb, levels: u32) -> Self {
        Self {
            bounds,
            cells: 1 << levels.clamp(1, 16),
            root: Node::default(),
            is_root_full: OnceLock::new(),
        }
    }

    /// The cell around one of the smallest cells that is `2^shift` of them wide.
    fn cell(&self, place: [u32; 3], shift: u32) -> Aabb {
        let (mut cell, size) = (self.bounds, self.bounds.size());
        for axis in 0..3 {
            let low = place[axis] >> shift << shift;
            // In trees of odd depth the blocks of the root are larger than the box.
            let high = (low + (1 << shift)).min(self.cells);
            let at = |k: u32| size[axis] * (f64::from(k) / f64::from(self.cells));
            cell.min[axis] = self.bounds.min[axis] + at(low);
            cell.max[axis] = self.bounds.min[axis] + at(high);
        }
        cell
    }

    /// The node of the whole tree.
    fn root(&self) -> Around<'_> {
        Around {
            node: &self.root,
            place: [0; 3],
            shift: (self.cells.ilog2() - 1) & !1,
        }
    }

    /// The cell around a place, as large as all of it is known to be empty, or one of the smallest. `last` is where it was looked for
    /// the last time.
    #[inline(always)]
    fn find<'a>(
        &'a self,
        place: [u32; 3],
        last: &mut Around<'a>,
        visitor: &mut impl Visitor,
    ) -> Found<'a> {
        if !last.contains(place) {
            *last = self.root();
        }
        let Around {
            mut node,
            mut shift,
            ..
        } = *last;
        loop {
            let slot = Slot::of(place, shift);
            if node.full.load(Ordering::Relaxed) & slot.bit() != 0 {
                if shift == 0 {
                    return Found {
                        is_full: true,
                        shift,
                        node,
                        slot,
                    };
                }
                node = &node.children()[slot.0 as usize];
                shift -= 2;
                *last = Around { node, place, shift };
                continue;
            }
            let empty = node.empty.load(Ordering::Relaxed);
            if empty & slot.bit() != 0 {
                let is_block = empty & slot.block() == slot.block();
                return Found {
                    is_full: false,
                    shift: shift + u32::from(is_block),
                    node,
                    slot,
                };
            }
            node.examine(slot, |part| {
                let larger = u32::from(matches!(part, Part::Block));
                visitor.content(&self.cell(place, shift + larger))
            });
        }
    }

    /// Passes the parts of the visitor's line that lie in cells which may have a surface to the visitor, in ascending order:
    /// neighbours share the same parameter, to the bit. Only cells that reach into the range are met.
    pub(crate) fn walk(&self, range: Interval, visitor: &mut impl Visitor) -> ControlFlow<()> {
        let line = Line::new(self, visitor.line());
        let (enter, exit) = line.within(self.cells);
        if !(enter < exit && enter <= range.max && exit >= range.min) {
            return ControlFlow::Continue(());
        }
        let is_full = || visitor.content(&self.bounds) == Content::Surface;
        if !*self.is_root_full.get_or_init(is_full) {
            return ControlFlow::Continue(());
        }
        let mut t = if enter > range.min { enter } else { range.min };
        // Rounding must not lead back to a plane that has been crossed.
        let mut least = [0; 3];
        let mut has_begun = false;
        let mut last = self.root();
        while t < exit && t <= range.max {
            let place = line.place(t, least, self.cells);
            let found = self.find(line.turned(place), &mut last, visitor);
            if !has_begun {
                visitor.begin(found.side())?;
                has_begun = true;
            }
            let (until, ends) = line.leave(place, found.shift, least);
            let mut next = until;
            if found.is_full {
                let enter = line.enter(place);
                if enter < until && until >= range.min {
                    let cell = Cell {
                        tree: self,
                        node: found.node,
                        place: line.turned(place),
                    };
                    visitor.part(enter, until, &cell)?;
                    let resume = visitor.resume();
                    if resume > next {
                        next = resume;
                    }
                }
            }
            least = ends;
            if least[0].max(least[1]).max(least[2]) >= self.cells {
                break;
            }
            if next > t {
                t = next;
            }
        }
        ControlFlow::Continue(())
    }
}

/// What is added to a number so that its last bits are the nearest whole number, in two's complement.
const WHOLE: f64 = 3.0 * (1_u64 << 51) as f64;

/// A line whose coordinates are counted in the smallest cells and turned around where it would descend, so that it goes through
/// ascending planes along every axis.
struct Line {
    origin: [f64; 3],
    direction: [f64; 3],
    inverse: [f64; 3],
    /// What turns the place of a cell back, axis by axis.
    turn: [u32; 3],
}

impl Line {
    fn new(tree: &Octree, (origin, direction): (DVec3, DVec3)) -> Self {
        let cells = f64::from(tree.cells);
        let scale = cells / tree.bounds.size();
        let origin = (origin - tree.bounds.min) * scale;
        let direction = direction * scale;
        let least = direction.abs().max_element() * SLANT;
        let mut line = Self {
            origin: origin.to_array(),
            direction: [least; 3],
            inverse: [0.0; 3],
            turn: [0; 3],
        };
        for axis in 0..3 {
            let speed = direction[axis];
            if speed < 0.0 {
                line.origin[axis] = cells - line.origin[axis];
                line.turn[axis] = tree.cells - 1;
            }
            if speed.abs() > least {
                line.direction[axis] = speed.abs();
            }
            line.inverse[axis] = 1.0 / line.direction[axis];
        }
        line
    }

    /// The parameter at which a plane is met.
    #[inline(always)]
    fn at(&self, axis: usize, plane: u32) -> f64 {
        (f64::from(plane) - self.origin[axis]) * self.inverse[axis]
    }

    /// Where the line is within a number of cells along each axis.
    fn within(&self, cells: u32) -> (f64, f64) {
        let (exit, _) = self.leave([cells - 1; 3], 0, [0; 3]);
        (self.enter([0; 3]), exit)
    }

    /// The smallest cell around a point of the line, or one of its neighbours if the point is on their border; but none before `least`.
    #[inline(always)]
    fn place(&self, t: f64, least: [u32; 3], cells: u32) -> [u32; 3] {
        let mut place = least;
        for axis in 0..3 {
            let x = self.origin[axis] + self.direction[axis] * t;
            let nearest = (x - 0.5 + WHOLE).to_bits() as i32;
            place[axis] = nearest.max(least[axis] as i32).min(cells as i32 - 1) as u32;
        }
        place
    }

    /// The place of a cell as the tree counts it.
    #[inline(always)]
    fn turned(&self, place: [u32; 3]) -> [u32; 3] {
        let [x, y, z] = self.turn;
        [place[0] ^ x, place[1] ^ y, place[2] ^ z]
    }

    /// The parameter at which one of the smallest cells is entered.
    #[inline(always)]
    fn enter(&self, place: [u32; 3]) -> f64 {
        let later = |a: f64, b: f64| if a > b { a } else { b };
        let (x, y) = (self.at(0, place[0]), self.at(1, place[1]));
        later(later(x, y), self.at(2, place[2]))
    }

    /// The parameter at which a cell is left that is `2^shift` of the smallest ones wide, and the numbers of the planes that have been
    /// crossed then: those that are crossed there, or `least`.
    #[inline(always)]
    fn leave(&self, place: [u32; 3], shift: u32, least: [u32; 3]) -> (f64, [u32; 3]) {
        let mut planes = place;
        let mut at = [0.0; 3];
        for axis in 0..3 {
            planes[axis] = ((place[axis] >> shift) + 1) << shift;
            at[axis] = self.at(axis, planes[axis]);
        }
        let earlier = |a: f64, b: f64| if a < b { a } else { b };
        let first = earlier(earlier(at[0], at[1]), at[2]);
        for axis in 0..3 {
            planes[axis] = if at[axis] <= first {
                planes[axis]
            } else {
                least[axis]
            };
        }
        (first, planes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BOX: Aabb = Aabb::new(DVec3::NEG_ONE, DVec3::ONE);

    fn has_shell(cell: &Aabb) -> bool {
        let far = cell.min.abs().max(cell.max.abs()).length();
        let near = DVec3::ZERO.clamp(cell.min, cell.max).length();
        near <= 0.7 && far >= 0.7
    }

    struct Parts<F> {
        line: (DVec3, DVec3),
        full: F,
        side: Option<bool>,
        found: Vec<(f64, f64)>,
    }

    impl<F: FnMut(&Aabb) -> bool> Visitor for Parts<F> {
        fn line(&self) -> (DVec3, DVec3) {
            self.line
        }
        fn content(&mut self, cell: &Aabb) -> Content {
            if (self.full)(cell) {
                Content::Surface
            } else {
                let is_inside = Some(cell.center().length() < 0.7);
                Content::Empty { is_inside }
            }
        }
        fn begin(&mut self, is_inside: Option<bool>) -> ControlFlow<()> {
            self.side = is_inside;
            ControlFlow::Continue(())
        }
        fn part(&mut self, enter: f64, exit: f64, _: &Cell<'_>) -> ControlFlow<()> {
            self.found.push((enter, exit));
            ControlFlow::Continue(())
        }
    }

    fn parts(
        tree: &Octree,
        line: (DVec3, DVec3),
        range: Interval,
        full: impl FnMut(&Aabb) -> bool,
    ) -> Vec<(f64, f64)> {
        let mut visitor = Parts {
            line,
            full,
            side: None,
            found: vec![],
        };
        let _ = tree.walk(range, &mut visitor);
        visitor.found
    }

    #[test]
    fn parts_ascend_and_hold_the_surface() {
        let tree = Octree::new(BOX, 7);
        for (origin, direction) in [
            (DVec3::new(-3.0, 0.1, 0.05), DVec3::new(1.0, 0.0, 0.0)),
            (DVec3::new(3.0, 2.0, -2.5), DVec3::new(-1.5, -1.0, 1.2)),
            (DVec3::new(0.3, -4.0, 0.0), DVec3::new(0.0, 3.0, 0.0)),
        ] {
            let line = (origin, direction);
            let parts = parts(&tree, line, Interval::LINE, has_shell);
            assert!(!parts.is_empty());
            assert!(
                parts.windows(2).all(|pair| pair[0].1 <= pair[1].0),
                "{parts:?}"
            );
            // Both crossings of the sphere of radius 0.7.
            let (a, b) = (direction.dot(direction), origin.dot(direction));
            let root = (b * b - a * (origin.dot(origin) - 0.49)).sqrt();
            for t in [(-b - root) / a, (-b + root) / a] {
                assert!(parts.iter().any(|p| p.0 <= t && t <= p.1), "{t} {parts:?}");
            }
            let length: f64 = parts.iter().map(|p| p.1 - p.0).sum();
            assert!(length * a.sqrt() < 0.3, "{length}");
        }
    }

    #[test]
    fn the_first_ray_to_ask_does_not_matter() {
        let line = (DVec3::new(3.0, 2.0, -2.5), DVec3::new(-1.5, -1.0, 1.2));
        let other = (DVec3::new(-3.0, 0.1, 0.05), DVec3::X);
        let alone = parts(&Octree::new(BOX, 7), line, Interval::LINE, has_shell);
        let tree = Octree::new(BOX, 7);
        parts(&tree, other, Interval::LINE, has_shell);
        assert_eq!(parts(&tree, line, Interval::LINE, has_shell), alone);
        // Now everything on the line is known.
        let known = parts(&tree, line, Interval::LINE, |_| unreachable!());
        assert_eq!(known, alone);
    }

    #[test]
    fn the_side_of_an_empty_cell_is_known() {
        let tree = Octree::new(BOX, 7);
        for (x, side) in [(-0.9, Some(false)), (-0.7, None), (0.1, Some(true))] {
            let mut visitor = Parts {
                line: (DVec3::new(x, 0.0, 0.0), DVec3::X),
                full: has_shell,
                side: None,
                found: vec![],
            };
            // Twice: the first time the cell is not known yet.
            for _ in 0..2 {
                let _ = tree.walk(Interval::FORWARD, &mut visitor);
                assert_eq!(visitor.side, side, "{x}");
            }
        }
    }

    #[test]
    fn cells_are_asked_about_once_on_the_way_and_within_the_range() {
        let tree = Octree::new(BOX, 7);
        let line = (DVec3::new(-2.0, 0.1, 0.05), DVec3::X);
        let mut asked = 0;
        let first = parts(&tree, line, Interval::new(0.0, 1.5), |_| {
            asked += 1;
            true
        });
        // A quarter of the 128 cells along the line, and their parents.
        assert!(first.len() == 33 && asked < 80, "{} {asked}", first.len());
        assert!(first.iter().all(|part| part.0 <= 1.5));
        let behind = Interval::new(3.5, 9.0);
        assert!(parts(&tree, line, behind, |_| false).is_empty());
        assert_eq!(parts(&tree, line, Interval::new(0.0, 0.9), |_| true), []);
    }

    #[test]
    fn parts_that_are_not_needed_are_left_out() {
        // So that no jump ends on a border.
        const JUMP: f64 = 0.2371;
        /// Needs nothing more for a while behind each part.
        struct Jumper {
            line: (DVec3, DVec3),
            found: Vec<(f64, f64)>,
        }
        impl Visitor for Jumper {
            fn line(&self) -> (DVec3, DVec3) {
                self.line
            }
            fn content(&mut self, _: &Aabb) -> Content {
                Content::Surface
            }
            fn part(&mut self, enter: f64, exit: f64, _: &Cell<'_>) -> ControlFlow<()> {
                self.found.push((enter, exit));
                ControlFlow::Continue(())
            }
            fn resume(&self) -> f64 {
                self.found
                    .last()
                    .map_or(f64::NEG_INFINITY, |part| part.1 + JUMP)
            }
        }
        for way in [
            DVec3::new(1.0, 0.3, -0.2),
            DVec3::new(-0.1, -1.0, 0.7),
            DVec3::Z,
        ] {
            let line = (DVec3::new(0.03, 0.01, 0.02) - way * 2.5, way);
            let all = parts(&Octree::new(BOX, 6), line, Interval::LINE, |_| true);
            let found = vec![];
            let mut jumper = Jumper { line, found };
            let _ = Octree::new(BOX, 6).walk(Interval::LINE, &mut jumper);
            assert!(jumper.found.len() < 10, "{:?}", jumper.found);
            for pair in jumper.found.windows(2) {
                // The same parts as without jumps, and the first one that ends behind the jump.
                let resume = pair[0].1 + JUMP;
                let next = all.iter().find(|part| part.1 > resume);
                assert_eq!(Some(&pair[1]), next);
            }
        }
    }
}
