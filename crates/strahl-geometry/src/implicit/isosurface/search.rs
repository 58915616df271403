//! The crossings of one ray with a surface, found in parts that shrink until they are proven empty or short.

use super::Isosurface;
use std::ops::ControlFlow;
use strahl_function::{Bounds, Workspace};
use strahl_math::roots::find_crossing;
use strahl_math::{Aabb, DVec3};

/// A ray within the container: the point at `s` is `origin + s direction`.
pub(super) struct Search<'a> {
    pub(super) surface: &'a Isosurface,
    pub(super) workspace: &'a mut Workspace,
    pub(super) origin: DVec3,
    pub(super) direction: DVec3,
    /// Parts of this length are not divided any more.
    pub(super) shortest: f64,
    /// At least half of the largest change of the function per unit of `s`, if it has no bounds and the scene's gradient is
    /// trusted.
    pub(super) slope: f64,
}

/// A parameter of the ray with the value of the function there, less the threshold.
#[derive(Clone, Copy)]
pub(super) struct Place {
    pub(super) s: f64,
    pub(super) value: f64,
}

impl Place {
    pub(super) fn is_inside(&self) -> bool {
        self.value < 0.0
    }
}

impl Search<'_> {
    /// The function at a parameter; NaN counts as outside.
    pub(super) fn place(&mut self, s: f64) -> Place {
        let p = self.origin + self.direction * s;
        Place {
            s,
            value: self.surface.value(self.workspace, p),
        }
    }

    /// Reports the changes of sign between two parameters to the visitor, ascending.
    ///
    /// Every change of sign between the ends is found, and every further pair of changes that is further apart than the
    /// shortest part, unless the function has no bounds and is steeper than the scene says.
    pub(super) fn run(
        &mut self,
        from: Place,
        to: Place,
        visit: &mut impl FnMut(f64) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let changes = from.is_inside() != to.is_inside();
        let length = to.s - from.s;
        if length <= self.shortest {
            if !changes {
                return ControlFlow::Continue(());
            }
            let (low, high) = (from.value, to.value);
            let root = find_crossing(from.s, to.s, low, high, |s| self.place(s).value);
            return visit(root);
        }
        let bounded = self.surface.is_bounded();
        if bounded && !changes && self.excludes(from.s, to.s) {
            return ControlFlow::Continue(());
        }
        let middle = self.place(from.s + 0.5 * length);
        if !bounded && !changes && middle.value.abs() > self.slope * length {
            return ControlFlow::Continue(());
        }
        if !(from.s < middle.s && middle.s < to.s) {
            return if changes {
                visit(to.s)
            } else {
                ControlFlow::Continue(())
            };
        }
        self.run(from, middle, visit)?;
        self.run(middle, to, visit)
    }

    /// Whether there is certainly no change of sign between two places.
    fn excludes(&mut self, from: f64, to: f64) -> bool {
        // Rounded products and sums are monotone, so these are the ends of the coordinates too.
        let a = self.origin + self.direction * from;
        let b = self.origin + self.direction * to;
        let cell = Aabb::new(a.min(b), a.max(b));
        let values = self.surface.bounds_within(self.workspace, &cell);
        excludes_change(values)
    }
}

/// Whether values within bounds are all inside or all outside, where NaN counts as outside.
pub(super) fn excludes_change(values: Bounds) -> bool {
    values.min > 0.0 || values.is_empty() || values.max < 0.0 && !values.nan
}
