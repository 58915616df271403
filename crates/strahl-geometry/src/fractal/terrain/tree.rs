//! A quadtree of the ranges of heights, computed when a ray first meets them.

use super::number::{Range, Rectangle, lower, upper};
use std::ops::ControlFlow;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use strahl_math::DVec3;
use strahl_math::error::{round_down_f32, round_up_f32};

/// At most so many cells are divided and remembered, 96 bytes each; what lies below them is computed anew for every ray.
const REMEMBERED: usize = 1 << 20;

/// Cells are halved at most so often.
const LEVELS: u32 = 40;

/// Directions are taken as having components of at least this part of the largest one, so that nothing is divided by zero.
const SLANT: f64 = 1.0 / (1_u64 << 60) as f64;

/// What is known of the range of heights over a cell: nothing yet, or two f32, rounded outwards.
#[derive(Debug)]
struct Known(AtomicU64);

const NOTHING: u64 = u64::MAX;

impl Default for Known {
    fn default() -> Self {
        Self(AtomicU64::new(NOTHING))
    }
}

impl Known {
    #[inline(always)]
    fn range(&self, compute: impl FnOnce() -> Range) -> Range {
        // Nothing else is published with it, and threads that compute at the same time compute the same.
        let mut bits = self.0.load(Ordering::Relaxed);
        if bits == NOTHING {
            let (low, high) = compute();
            let (low, high) = (round_down_f32(low), round_up_f32(high));
            bits = u64::from(low.to_bits()) << 32 | u64::from(high.to_bits());
            self.0.store(bits, Ordering::Relaxed);
        }
        let half = |bits: u64| f64::from(f32::from_bits(bits as u32));
        (half(bits >> 32), half(bits))
    }
}

#[derive(Debug, Default)]
struct Node {
    known: Known,
    children: OnceLock<Box<[Self; 4]>>,
}

/// The tree of a rectangle.
///
/// What a cell holds depends on the cell alone, so it does not matter which ray, of which thread, asks first.
#[derive(Debug)]
pub(super) struct Tree {
    rectangle: Rectangle,
    root: Node,
    divided: AtomicUsize,
    remembered: usize,
}

/// What goes through the tree along a line.
pub(super) trait Visitor {
    /// The range of heights over a cell of which nothing is known yet. The answer must depend on the cell alone.
    fn range(&mut self, cell: &Rectangle) -> Range;
    /// Whether a cell is small enough to be searched, which depends on the cell alone.
    fn is_small(&self, cell: &Rectangle) -> bool;
    /// A part of the line within a small cell that may contain a surface.
    fn part(&mut self, enter: f64, exit: f64) -> ControlFlow<()>;
}

/// A line on its way through the tree: the point at `s` is `origin + s direction`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line {
    origin: DVec3,
    /// One over the components of the direction; large, but finite, for those that vanish.
    inverse: DVec3,
    /// Which half is met first along x and z: bit set for the upper one.
    first: usize,
    /// The part of the line that is needed.
    needed: Range,
    /// How far points of the line may be off.
    pad: f64,
}

impl Line {
    pub(super) fn new(origin: DVec3, direction: DVec3, needed: Range, pad: f64) -> Self {
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
        Self {
            origin,
            inverse: DVec3::new(
                inverse(direction.x),
                inverse(direction.y),
                inverse(direction.z),
            ),
            first: usize::from(direction.x < 0.0) | usize::from(direction.z < 0.0) << 1,
            needed,
            pad,
        }
    }

    fn x(&self, x: f64) -> f64 {
        (x - self.origin.x) * self.inverse.x
    }

    fn z(&self, z: f64) -> f64 {
        (z - self.origin.z) * self.inverse.z
    }

    /// The part of the line between two heights.
    fn between(&self, (low, high): Range) -> Range {
        let a = (low - self.pad - self.origin.y) * self.inverse.y;
        let b = (high + self.pad - self.origin.y) * self.inverse.y;
        (lower(a, b), upper(a, b))
    }

    fn needs(&self, (enter, exit): Range) -> bool {
        enter < exit && enter <= self.needed.1 && exit >= self.needed.0
    }
}

impl Tree {
    /// Nothing is known yet.
    pub(super) fn new(rectangle: Rectangle) -> Self {
        Self::remembering(rectangle, REMEMBERED)
    }

    /// At most so many cells are divided and remembered.
    pub(super) fn remembering(rectangle: Rectangle, remembered: usize) -> Self {
        Self {
            remembered,
            rectangle,
            root: Node::default(),
            divided: AtomicUsize::new(0),
        }
    }

    /// Passes the parts of a line that lie in small cells and between the heights of their cell to the visitor, in ascending order. The line is
    /// within the rectangle up to this length.
    pub(super) fn walk(
        &self,
        line: &Line,
        length: f64,
        visitor: &mut impl Visitor,
    ) -> ControlFlow<()> {
        self.meet(
            Some(&self.root),
            0,
            &self.rectangle,
            (0.0, length),
            line,
            visitor,
        )
    }

    fn meet(
        &self,
        node: Option<&Node>,
        level: u32,
        cell: &Rectangle,
        whole: Range,
        line: &Line,
        visitor: &mut impl Visitor,
    ) -> ControlFlow<()> {
        if !line.needs(whole) {
            return ControlFlow::Continue(());
        }
        let range = match node {
            Some(node) => node.known.range(|| visitor.range(cell)),
            // As it would be remembered.
            None => Known::default().range(|| visitor.range(cell)),
        };
        let heights = line.between(range);
        let part = (upper(whole.0, heights.0), lower(whole.1, heights.1));
        if !line.needs(part) {
            return ControlFlow::Continue(());
        }
        if level == LEVELS || visitor.is_small(cell) {
            return visitor.part(part.0, part.1);
        }
        let children = node.and_then(|node| self.children(node));
        self.descend(children, level + 1, cell, part, line, visitor)
    }

    /// The children of a node, unless too many are remembered already.
    fn children<'a>(&self, node: &'a Node) -> Option<&'a [Node; 4]> {
        if let Some(children) = node.children.get() {
            return Some(children);
        }
        if self.divided.load(Ordering::Relaxed) >= self.remembered {
            return None;
        }
        self.divided.fetch_add(1, Ordering::Relaxed);
        Some(node.children.get_or_init(Box::default))
    }

    /// Visits the quarters of a cell in which the line is from `enter` to `exit`, in the order in which it meets them.
    fn descend(
        &self,
        children: Option<&[Node; 4]>,
        level: u32,
        cell: &Rectangle,
        (mut enter, exit): Range,
        line: &Line,
        visitor: &mut impl Visitor,
    ) -> ControlFlow<()> {
        let [(x0, x1), (z0, z1)] = *cell;
        let (x, z) = (0.5 * (x0 + x1), 0.5 * (z0 + z1));
        let (half_x, half_z) = (line.x(x), line.z(z));
        // The halves it is in: the line passes from the first to the second one only.
        let mut seconds = usize::from(half_x <= enter) | usize::from(half_z <= enter) << 1;
        loop {
            let (mut until, mut crossed) = (exit, 0);
            for (half, axis) in [(half_x, 1), (half_z, 2)] {
                if seconds & axis == 0 && half < until {
                    (until, crossed) = (half, axis);
                }
            }
            let quarter = seconds ^ line.first;
            let child = [
                if quarter & 1 == 0 { (x0, x) } else { (x, x1) },
                if quarter & 2 == 0 { (z0, z) } else { (z, z1) },
            ];
            let node = children.and_then(|children| children.get(quarter));
            self.meet(node, level, &child, (enter, until), line, visitor)?;
            if crossed == 0 || until > line.needed.1 {
                return ControlFlow::Continue(());
            }
            seconds |= crossed;
            enter = until;
        }
    }
}
