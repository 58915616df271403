//! An octree of the cells that may contain a surface.

use std::ops::ControlFlow;
use strahl_math::{Aabb, DVec3};

/// Cells are halved at most this often.
const DEPTH: u32 = 7;
/// Most cells examined on one level; the next level is left out if it might have more.
const CELLS: usize = 1 << 18;
/// Most operations of the function spent on a level: some ten seconds. Functions of more than eight thousand operations get
/// fewer cells.
const OPERATIONS: u64 = 1 << 31;

/// A child that certainly contains no surface.
const EMPTY: u32 = 0;
/// A child that may contain one and is not divided.
const LEAF: u32 = 1;
/// Added to the number of a divided child.
const INNER: u32 = 2;

/// Directions are taken as having components of at least this part of the largest one, so that nothing is divided by zero.
const SLANT: f64 = 1.0 / (1u64 << 60) as f64;

/// A tree of cells.
#[derive(Debug)]
pub(super) struct Octree {
    bounds: Aabb,
    root: u32,
    nodes: Vec<[u32; 8]>,
}

/// The child of a cell in which bit `k` of `octant` chooses the upper half along axis `k`.
fn child(cell: &Aabb, octant: usize) -> Aabb {
    let middle = cell.center();
    let upper = |k: usize| octant >> k & 1 == 1;
    let pick = |a: DVec3, b: DVec3| {
        DVec3::from_array(std::array::from_fn(|k| if upper(k) { a[k] } else { b[k] }))
    };
    Aabb::new(pick(middle, cell.min), pick(cell.max, middle))
}

impl Octree {
    /// Builds the tree of a box by testing for each cell whether it may contain a surface; `cost` is the number of operations
    /// of a test.
    pub(super) fn build(
        bounds: Aabb,
        cost: u64,
        mut may_have_surface: impl FnMut(&Aabb) -> bool,
    ) -> Self {
        let cells = (OPERATIONS / cost.max(1)).min(CELLS as u64) as usize;
        let mut tree = Self {
            bounds,
            root: if may_have_surface(&bounds) {
                LEAF
            } else {
                EMPTY
            },
            nodes: Vec::new(),
        };
        // The leaves of the level at hand: node, octant, cell.
        let mut leaves: Vec<(Option<(usize, usize)>, Aabb)> = Vec::new();
        if tree.root == LEAF {
            leaves.push((None, bounds));
        }
        for _ in 0..DEPTH {
            if leaves.len() * 8 > cells {
                break;
            }
            let mut next = Vec::new();
            for (place, cell) in leaves {
                let node = tree.nodes.len();
                let number = INNER + node as u32;
                match place.and_then(|(n, o)| tree.nodes.get_mut(n)?.get_mut(o)) {
                    Some(slot) => *slot = number,
                    None => tree.root = number,
                }
                let mut children = [EMPTY; 8];
                for (octant, slot) in children.iter_mut().enumerate() {
                    let cell = child(&cell, octant);
                    if may_have_surface(&cell) {
                        *slot = LEAF;
                        next.push((Some((node, octant)), cell));
                    }
                }
                tree.nodes.push(children);
            }
            leaves = next;
        }
        tree
    }

    /// Passes the parts of a line that lie in cells with a surface to the visitor, in ascending order: neighbours share the
    /// same parameter, to the bit.
    pub(super) fn walk(
        &self,
        origin: DVec3,
        direction: DVec3,
        visit: &mut impl FnMut(f64, f64) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let least = direction.abs().max_element() * SLANT;
        let inverse = direction.to_array().map(|d| {
            if d.abs() >= least {
                1.0 / d
            } else if d < 0.0 {
                -1.0 / least
            } else {
                1.0 / least
            }
        });
        let line = Line {
            origin,
            inverse: DVec3::from_array(inverse),
            first: (0..3).fold(0, |bits, k| bits | usize::from(direction[k] < 0.0) << k),
        };
        self.descend(&line, self.root, &self.bounds, visit)
    }

    fn descend(
        &self,
        line: &Line,
        number: u32,
        cell: &Aabb,
        visit: &mut impl FnMut(f64, f64) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        if number == EMPTY {
            return ControlFlow::Continue(());
        }
        let Some((enter, exit)) = line.span(cell) else {
            return ControlFlow::Continue(());
        };
        let Some(children) = number
            .checked_sub(INNER)
            .and_then(|n| self.nodes.get(n as usize))
        else {
            return visit(enter, exit);
        };
        // A line passes from lower to upper halves only, along each axis, if halves are named in its own order; so children in
        // the order of these names are met in the order of the line.
        for octant in (0..8).map(|name| name ^ line.first) {
            if children[octant] != EMPTY {
                self.descend(line, children[octant], &child(cell, octant), visit)?;
            }
        }
        ControlFlow::Continue(())
    }
}

struct Line {
    origin: DVec3,
    inverse: DVec3,
    /// The octant met first.
    first: usize,
}

impl Line {
    /// The parameters within a cell.
    #[inline]
    fn span(&self, cell: &Aabb) -> Option<(f64, f64)> {
        let low = (cell.min - self.origin) * self.inverse;
        let high = (cell.max - self.origin) * self.inverse;
        let (mut enter, mut exit) = (f64::NEG_INFINITY, f64::INFINITY);
        for k in 0..3 {
            let (a, b) = if low[k] < high[k] {
                (low[k], high[k])
            } else {
                (high[k], low[k])
            };
            enter = if a > enter { a } else { enter };
            exit = if b < exit { b } else { exit };
        }
        (enter < exit).then_some((enter, exit))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shell() -> Octree {
        Octree::build(Aabb::new(DVec3::NEG_ONE, DVec3::ONE), 1, |cell| {
            let far = cell.min.abs().max(cell.max.abs()).length();
            let near = DVec3::ZERO.clamp(cell.min, cell.max).length();
            near <= 0.7 && far >= 0.7
        })
    }

    #[test]
    fn parts_ascend_and_hold_the_surface() {
        let tree = shell();
        for (origin, direction) in [
            (DVec3::new(-3.0, 0.1, 0.05), DVec3::new(1.0, 0.0, 0.0)),
            (DVec3::new(3.0, 2.0, -2.5), DVec3::new(-1.5, -1.0, 1.2)),
            (DVec3::new(0.3, -4.0, 0.0), DVec3::new(0.0, 3.0, 0.0)),
        ] {
            let mut parts = vec![];
            let _ = tree.walk(origin, direction, &mut |a, b| {
                parts.push((a, b));
                ControlFlow::Continue(())
            });
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
    fn nothing_and_everything() {
        let bounds = Aabb::new(DVec3::NEG_ONE, DVec3::ONE);
        let mut count = 0;
        let _ = Octree::build(bounds, 1, |_| false).walk(DVec3::ZERO, DVec3::X, &mut |_, _| {
            count += 1;
            ControlFlow::Continue(())
        });
        assert_eq!(count, 0);
        let full = Octree::build(bounds, 1, |_| true);
        assert!(full.nodes.len() * 8 <= 2 * CELLS);
    }

    #[test]
    fn dear_functions_are_asked_about_few_cells() {
        let bounds = Aabb::new(DVec3::NEG_ONE, DVec3::ONE);
        for cost in [1 << 20, 1 << 30, u64::MAX] {
            let mut asked = 0_u64;
            let _ = Octree::build(bounds, cost, |_| {
                asked += 1;
                true
            });
            assert!(
                (1..=2 * OPERATIONS / cost.min(OPERATIONS)).contains(&asked),
                "{asked}"
            );
        }
    }
}
