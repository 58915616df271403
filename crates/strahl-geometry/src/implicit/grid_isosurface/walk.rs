//! The crossings of one ray, cell by cell.
//!
//! A cell has the part of the ray between two parameters at which the ray passes planes of the grid. Neighbours take the same parameter,
//! so the parts have neither gaps nor overlaps, and what is found in one depends on nothing but the ray and the cell.

use super::grid::{Cell, Grid};
use super::{SURFACE, facet_of};
use crate::{Crossing, PrimHit, Side, SurfaceId};
use std::ops::ControlFlow;
use strahl_math::roots::{find_crossing, quadratic};
use strahl_math::{DVec3, Interval, Ray};

/// The events along a ray.
pub(super) enum Event {
    /// The ray starts within the grid, or what is needed of it does.
    Start { inside: bool },
    /// A crossing, without an error bound. `wall` is the facet of a wall of the grid.
    Crossing(Crossing),
}

/// One end of the part of a ray that is within the grid.
#[derive(Clone, Copy)]
struct End {
    t: f64,
    facet: u32,
}

/// A ray on its way through the grid.
pub(super) struct Walk<'a, V> {
    grid: &'a Grid,
    ray: &'a Ray,
    cells: [u32; 3],
    enter: End,
    exit: End,
    /// What ends before is passed over.
    begin: f64,
    /// What begins behind is not looked at.
    end: f64,
    /// Whether the ray starts on the surface at 0.
    leaves: bool,
    /// Whether the ray is inside; `None` before the first part.
    inside: Option<bool>,
    visit: &'a mut V,
}

fn crossing(t: f64, facet: u32, enters: bool) -> Event {
    let side = if enters { Side::Enter } else { Side::Exit };
    Event::Crossing(Crossing::new(PrimHit::simple(t, facet), 0.0, side))
}

/// A number with the sign of the function on a side of the surface.
fn least_value(inside: bool) -> f64 {
    if inside {
        -f64::MIN_POSITIVE
    } else {
        f64::MIN_POSITIVE
    }
}

impl<'a, V: FnMut(Event) -> ControlFlow<()>> Walk<'a, V> {
    /// `None` if the ray does not meet the grid.
    pub(super) fn new(
        grid: &'a Grid,
        ray: &'a Ray,
        range: Interval,
        from: Option<SurfaceId>,
        visit: &'a mut V,
    ) -> Option<Self> {
        if !(ray.origin.is_finite() && ray.direction.is_finite() && ray.direction != DVec3::ZERO) {
            return None;
        }
        let leaves = from == Some(SURFACE);
        let outside = End {
            t: f64::NEG_INFINITY,
            facet: 0,
        };
        let mut walk = Self {
            grid,
            ray,
            cells: grid.cells(),
            enter: outside,
            exit: End {
                t: f64::INFINITY,
                facet: 0,
            },
            begin: if leaves { 0.0 } else { range.min },
            // Also in an empty range the state at its start counts.
            end: range.max.max(range.min),
            leaves,
            inside: None,
            visit,
        };
        for axis in 0..3 {
            let end = |high: bool| {
                let facet = facet_of(axis, high);
                let number = if high { walk.cells[axis] } else { 0 };
                // A ray that starts on a wall is exactly there.
                let starts = from.is_some_and(|from| from.facet == facet);
                let t = if starts && ray.direction[axis] != 0.0 {
                    0.0
                } else {
                    walk.plane(axis, number)
                };
                End { t, facet }
            };
            let backward = ray.direction[axis] < 0.0;
            let (enter, exit) = (end(backward), end(!backward));
            if enter.t > walk.enter.t {
                walk.enter = enter;
            }
            if exit.t < walk.exit.t {
                walk.exit = exit;
            }
        }
        let (start, end) = (walk.enter.t, walk.exit.t);
        // A ray that is so far away that its ends can't be told apart misses.
        (start < end && start.is_finite() && end.is_finite()).then_some(walk)
    }

    /// The parameter at which the ray passes a plane; infinite if it never does.
    fn plane(&self, axis: usize, number: u32) -> f64 {
        let (origin, direction) = (self.ray.origin[axis], self.ray.direction[axis]);
        let at = f64::from(number);
        if direction != 0.0 {
            (at - origin) / direction
        } else if origin < at || origin == at && number == self.cells[axis] {
            f64::INFINITY
        } else {
            f64::NEG_INFINITY
        }
    }

    /// Reports the events in order, until the visitor stops.
    pub(super) fn run(mut self) -> ControlFlow<()> {
        let (start, end) = (self.enter.t, self.exit.t);
        self.block(self.grid.top(), [0; 3], start, end)?;
        if self.inside == Some(true) {
            (self.visit)(crossing(end, self.exit.facet, false))?;
        }
        ControlFlow::Continue(())
    }

    /// Walks through the cells of a block, front to back. The recursion is as deep as the pyramid, 31 levels at most.
    fn block(&mut self, level: usize, at: [u32; 3], a: f64, b: f64) -> ControlFlow<()> {
        if b <= self.begin {
            return ControlFlow::Continue(());
        }
        if a > self.end {
            return ControlFlow::Break(());
        }
        if let Some(inside) = self.grid.uniform(level, at) {
            return self.arrive(a, inside);
        }
        let Some(below) = level.checked_sub(1) else {
            return self.cell(&self.grid.cell(at), a, b);
        };
        // The child that the ray is in at `a`, and when it passes the planes between the children.
        let (mut child, mut passes) = ([0; 3], [f64::INFINITY; 3]);
        for axis in 0..3 {
            let middle = (2 * at[axis] + 1) << below;
            let backward = self.ray.direction[axis] < 0.0;
            let t = match middle < self.cells[axis] {
                true => self.plane(axis, middle),
                // There are no cells behind it.
                false if backward => f64::NEG_INFINITY,
                false => f64::INFINITY,
            };
            let passed = t <= a;
            child[axis] = u32::from(backward != passed);
            if !passed {
                passes[axis] = t;
            }
        }
        let mut from = a;
        loop {
            let next = passes.into_iter().fold(f64::INFINITY, f64::min);
            let to = if next < b { next } else { b };
            if from < to {
                let place = std::array::from_fn(|k| 2 * at[k] + child[k]);
                self.block(below, place, from, to)?;
            }
            if !(next < b) {
                return ControlFlow::Continue(());
            }
            for axis in 0..3 {
                if passes[axis] == next {
                    child[axis] ^= 1;
                    passes[axis] = f64::INFINITY;
                }
            }
            from = next;
        }
    }

    /// A part begins at `t`, and the ray is inside there or not.
    fn arrive(&mut self, t: f64, inside: bool) -> ControlFlow<()> {
        match self.inside.replace(inside) {
            None if t == self.enter.t => match inside {
                true => (self.visit)(crossing(t, self.enter.facet, true)),
                false => ControlFlow::Continue(()),
            },
            None => (self.visit)(Event::Start { inside }),
            // Only rounding at the start of a ray that leaves the surface makes parts disagree.
            Some(before) if before != inside => (self.visit)(crossing(t, SURFACE.facet, inside)),
            Some(_) => ControlFlow::Continue(()),
        }
    }

    fn cell(&mut self, cell: &Cell, a: f64, b: f64) -> ControlFlow<()> {
        let planes: [[f64; 2]; 3] =
            std::array::from_fn(|k| [0, 1].map(|side| self.plane(k, cell.at[k] + side)));
        let ray = self.ray;
        let local = |t: f64| {
            let mut place = cell.local(ray.at(t));
            for (k, [low, high]) in planes.into_iter().enumerate() {
                // On a plane exactly, so that the cells on both sides get the same bits.
                if t == low {
                    place[k] = 0.0;
                } else if t == high {
                    place[k] = 1.0;
                }
            }
            place
        };
        if self.leaves && a <= 0.0 {
            return self.first_cell(cell, local(0.0), b);
        }
        let value = |t: f64| cell.value(local(t));
        let mut at_first = value(a);
        match self.inside {
            // As `arrive` says.
            Some(inside) if inside != (at_first < 0.0) => at_first = least_value(inside),
            Some(_) => {}
            None => self.arrive(a, at_first < 0.0)?,
        }
        // Between its extremes the cubic is monotone and has one zero at most.
        let length = b - a;
        let [c1, c2, c3] = cell.along(local(a), ray.direction * length);
        let extremes = quadratic(3.0 * c3, c2, c1, c2 * c2 - 3.0 * c3 * c1);
        let mut last = (a, at_first);
        let mut steps = [b; 3];
        if let Some((s, t)) = extremes {
            steps = [a + s * length, a + t * length, b];
        }
        for t in steps {
            if !(last.0 < t && t <= b) {
                continue;
            }
            let next = (t, value(t));
            if (next.1 < 0.0) != (last.1 < 0.0) {
                let root = find_crossing(last.0, next.0, last.1, next.1, value);
                self.toggle(root)?;
            }
            last = next;
        }
        ControlFlow::Continue(())
    }

    /// The first cell of a ray that starts on the surface: the root at 0 is divided out.
    fn first_cell(&mut self, cell: &Cell, start: DVec3, b: f64) -> ControlFlow<()> {
        let [c1, c2, c3] = cell.along(start, self.ray.direction * b);
        let value = |s: f64| c1 + s * (c2 + s * c3);
        let mut last = (0.0, c1);
        self.arrive(0.0, c1 < 0.0)?;
        for s in [-0.5 * c2 / c3, 1.0] {
            if !(last.0 < s && s <= 1.0) {
                continue;
            }
            let next = (s, value(s));
            if (next.1 < 0.0) != (last.1 < 0.0) {
                let root = find_crossing(last.0, next.0, last.1, next.1, value);
                self.toggle(root * b)?;
            }
            last = next;
        }
        ControlFlow::Continue(())
    }

    fn toggle(&mut self, t: f64) -> ControlFlow<()> {
        let inside = self.inside != Some(true);
        self.inside = Some(inside);
        (self.visit)(crossing(t, SURFACE.facet, inside))
    }
}
