//! Whether the gradient that a scene states takes the place of proofs.

use super::Isosurface;
use strahl_function::{Rates, Workspace};
use strahl_math::{Aabb, DVec3};

/// So many slopes are measured.
const PLACES: u32 = 1000;

/// A place is near the surface if the stated gradient does not exclude that it is nearer than this part of the container's size.
const NEAR: f64 = 1.0 / 32.0;

/// Slopes are measured at all places if fewer than this are near the surface.
const FEWEST: usize = 50;

/// A stated gradient is plausible if it differs from the steepest slopes by no more than this factor: scenes often state less than there is
/// somewhere, which POV-Ray reports after rendering, and much more would take longer than proofs.
const FACTOR: f64 = 2.0;

impl Isosurface {
    /// Whether parts of rays and of space are left out because of the stated gradient, as in POV-Ray, without a proof: if the function has no
    /// bounds, or for sums over octaves of noise, whose bounds take long to close in on them, if what is stated is plausible.
    pub(super) fn trusts_gradient(&self, workspace: &mut Workspace) -> bool {
        *self.trusts_gradient.get_or_init(|| {
            let is_sum = || self.function.rates() == Rates::OfSegments;
            let stated = self.options.max_gradient;
            !self.is_bounded
                || stated.is_some_and(|stated| is_sum() && self.is_plausible(stated, workspace))
        })
    }

    /// Whether slopes near the surface, measured at places that depend on nothing but the container, agree with a stated gradient.
    fn is_plausible(&self, stated: f64, workspace: &mut Workspace) -> bool {
        let bounds = self.container.bounds();
        let (mut near, mut all) = (vec![], vec![]);
        for number in 0..PLACES {
            let place = place(&bounds, number);
            let step = direction(number) * self.shortest();
            let value = self.value(workspace, place);
            let slope = (self.value(workspace, place + step) - value).abs() / step.length();
            // Where the function is no number on both sides it tells nothing.
            let slope = if slope.is_nan() { 0.0 } else { slope };
            all.push(slope);
            if value.abs() <= stated * NEAR * self.size() {
                near.push(slope);
            }
        }
        let slopes = if near.len() < FEWEST {
            &mut all
        } else {
            &mut near
        };
        // A few places are steeper than what matters.
        let steep = slopes.len() * 99 / 100;
        let (_, steep, _) = slopes.select_nth_unstable_by(steep, f64::total_cmp);
        *steep <= FACTOR * stated && stated <= FACTOR * *steep
    }
}

/// Places that fill a box evenly: a sequence of low discrepancy (M. Roberts, "The Unreasonable Effectiveness of Quasirandom Sequences", 2018).
pub(super) fn place(bounds: &Aabb, number: u32) -> DVec3 {
    const STEP: DVec3 = DVec3::new(
        0.819_172_513_396_164_5,
        0.671_043_606_703_789_3,
        0.549_700_477_901_970_3,
    );
    let at = DVec3::splat(0.5) + STEP * f64::from(number);
    bounds.min + bounds.size() * (at - at.floor())
}

/// Along the axes and the diagonals in turn.
pub(super) fn direction(number: u32) -> DVec3 {
    match number % 7 {
        axis @ 0..3 => DVec3::AXES[axis as usize],
        3 => DVec3::new(1.0, 1.0, 1.0),
        4 => DVec3::new(-1.0, 1.0, 1.0),
        5 => DVec3::new(1.0, -1.0, 1.0),
        _ => DVec3::new(1.0, 1.0, -1.0),
    }
}
