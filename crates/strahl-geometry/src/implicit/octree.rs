//! An octree of the cells that may contain a surface, examined when a ray first meets them.

use std::ops::ControlFlow;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU8, Ordering};
use strahl_math::{Aabb, DVec3, Interval};

/// Marks of a cell: nothing is known yet, it contains no surface, or it may contain one.
const UNKNOWN: u8 = 0;
const EMPTY: u8 = 1;
const FULL: u8 = 2;

/// Directions are taken as having components of at least this part of the largest one, so that nothing is divided by zero.
const SLANT: f64 = 1.0 / (1u64 << 60) as f64;

/// What goes through the tree along a line.
pub(crate) trait Visitor {
    /// The origin and the direction of the line.
    fn line(&self) -> (DVec3, DVec3);
    /// Whether a cell of which nothing is known yet may contain a surface. The answer must depend on the cell alone.
    fn may_have_surface(&mut self, cell: &Aabb) -> bool;
    /// A part of the line within a cell that may contain a surface.
    fn part(&mut self, enter: f64, exit: f64) -> ControlFlow<()>;
}

/// A tree of cells, all of which are halved equally often.
///
/// What a cell holds depends on the cell alone, so it does not matter which ray, of which thread, asks first.
#[derive(Debug)]
pub(crate) struct Octree {
    bounds: Aabb,
    levels: u32,
    mark: Mark,
    root: Node,
}

/// What is known of the eight children of a cell, and their nodes if they are met. The smallest cells have no nodes.
#[derive(Debug, Default)]
struct Node {
    marks: [Mark; 8],
    children: OnceLock<Box<[Node; 8]>>,
}

/// What is known about a cell.
#[derive(Debug, Default)]
struct Mark(AtomicU8);

impl Mark {
    /// Whether there may be a surface: remembered, or asked of the visitor.
    #[inline(always)]
    fn is_full(&self, bounds: impl FnOnce() -> Aabb, visitor: &mut impl Visitor) -> bool {
        // Nothing else is published with the mark, and threads that ask at the same time get the same answer.
        match self.0.load(Ordering::Relaxed) {
            UNKNOWN => {
                let full = visitor.may_have_surface(&bounds());
                self.0
                    .store(if full { FULL } else { EMPTY }, Ordering::Relaxed);
                full
            }
            mark => mark == FULL,
        }
    }
}

/// The child of a cell in which bit `k` of `octant` chooses the upper half along axis `k`.
fn child(cell: &Aabb, middle: DVec3, octant: usize) -> Aabb {
    let pick = |a: DVec3, b: DVec3| choose(octant, a, b);
    Aabb::new(pick(middle, cell.min), pick(cell.max, middle))
}

/// Component `k` of `a` if bit `k` is set, else of `b`.
#[inline(always)]
fn choose(bits: usize, a: DVec3, b: DVec3) -> DVec3 {
    let pick = |bit: usize, a: f64, b: f64| if bits & bit == 0 { b } else { a };
    DVec3::new(pick(1, a.x, b.x), pick(2, a.y, b.y), pick(4, a.z, b.z))
}

impl Octree {
    /// The tree of a box, of which nothing is known yet and whose cells are halved so often.
    pub(crate) fn new(bounds: Aabb, levels: u32) -> Self {
        Self {
            bounds,
            levels,
            mark: Mark::default(),
            root: Node::default(),
        }
    }

    /// Passes the parts of the visitor's line that lie in cells which may have a surface to the visitor, in ascending order:
    /// neighbours share the same parameter, to the bit. Only cells that reach into the range are met.
    pub(crate) fn walk(&self, range: Interval, visitor: &mut impl Visitor) -> ControlFlow<()> {
        let (origin, direction) = visitor.line();
        let least = direction.abs().max_element() * SLANT;
        let inverse = |d: f64| {
            if d.abs() >= least {
                1.0 / d
            } else if d < 0.0 {
                -1.0 / least
            } else {
                1.0 / least
            }
        };
        let line = Line {
            origin,
            inverse: DVec3::new(
                inverse(direction.x),
                inverse(direction.y),
                inverse(direction.z),
            ),
            first: (0..3).fold(0, |bits, k| bits | usize::from(direction[k] < 0.0) << k),
            range,
        };
        let (low, high) = (line.at(self.bounds.min), line.at(self.bounds.max));
        let (near, far) = (choose(line.first, high, low), choose(line.first, low, high));
        let later = |a: f64, b: f64| if a > b { a } else { b };
        let earlier = |a: f64, b: f64| if a < b { a } else { b };
        let enter = later(later(near.x, near.y), near.z);
        let exit = earlier(earlier(far.x, far.y), far.z);
        if !line.needs(enter, exit) || !self.mark.is_full(|| self.bounds, visitor) {
            return ControlFlow::Continue(());
        }
        match self.levels.checked_sub(1) {
            None => visitor.part(enter, exit),
            Some(levels) => {
                line.descend((&self.root, levels), &self.bounds, (enter, exit), visitor)
            }
        }
    }
}

struct Line {
    origin: DVec3,
    inverse: DVec3,
    /// The octant met first.
    first: usize,
    range: Interval,
}

impl Line {
    /// The parameters at which the planes through a corner are met.
    fn at(&self, corner: DVec3) -> DVec3 {
        (corner - self.origin) * self.inverse
    }

    /// Whether there is such a part, and some of it within the range.
    fn needs(&self, enter: f64, exit: f64) -> bool {
        enter < exit && enter <= self.range.max && exit >= self.range.min
    }

    /// Visits the children of a cell that may have a surface, below which there are so many levels and in which the line is from
    /// `enter` to `exit`.
    fn descend(
        &self,
        (node, levels): (&Node, u32),
        bounds: &Aabb,
        (mut enter, exit): (f64, f64),
        visitor: &mut impl Visitor,
    ) -> ControlFlow<()> {
        let middle = bounds.center();
        let DVec3 { x, y, z } = self.at(middle);
        // The halves it is in, along each axis: the line passes from the first to the second one only.
        let mut seconds =
            usize::from(x <= enter) | usize::from(y <= enter) << 1 | usize::from(z <= enter) << 2;
        loop {
            let (mut until, mut crossed) = (exit, 0);
            for (half, axis) in [(x, 1), (y, 2), (z, 4)] {
                if seconds & axis == 0 && half < until {
                    (until, crossed) = (half, axis);
                }
            }
            if self.needs(enter, until) {
                let octant = seconds ^ self.first;
                let bounds = || child(bounds, middle, octant);
                if node.marks[octant].is_full(bounds, visitor) {
                    match levels.checked_sub(1) {
                        None => visitor.part(enter, until)?,
                        Some(levels) => {
                            let children = node.children.get_or_init(Box::default);
                            let child = (&children[octant], levels);
                            self.descend(child, &bounds(), (enter, until), visitor)?;
                        }
                    }
                }
            }
            if crossed == 0 || until > self.range.max {
                return ControlFlow::Continue(());
            }
            seconds |= crossed;
            enter = until;
        }
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
        found: Vec<(f64, f64)>,
    }

    impl<F: FnMut(&Aabb) -> bool> Visitor for Parts<F> {
        fn line(&self) -> (DVec3, DVec3) {
            self.line
        }
        fn may_have_surface(&mut self, cell: &Aabb) -> bool {
            (self.full)(cell)
        }
        fn part(&mut self, enter: f64, exit: f64) -> ControlFlow<()> {
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
        let found = vec![];
        let mut visitor = Parts { line, full, found };
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
}
