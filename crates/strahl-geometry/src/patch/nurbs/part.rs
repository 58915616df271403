//! A Bezier patch as a part of a larger surface, whatever its degree.

use crate::patch::bezier::{Bezier, is_on_a_line};
use crate::patch::frame::Frame;
use crate::patch::hull::{self, points, project};
use crate::patch::net::Curve;
use crate::patch::newton::Candidate;
use crate::patch::piece::PatchPlace;
use crate::patch::search::Keep;
use std::fmt::Debug;
use strahl_math::error::gamma;
use strahl_math::{Aabb, DVec2, DVec3, Interval, Transform};

/// A rectangle of parameters: the ends of u, and of v.
pub(super) type Rectangle = [[f64; 2]; 2];

/// The parameters of a whole patch.
pub(super) const WHOLE: Rectangle = [[0.0, 1.0]; 2];

/// A ray, and where on the patch it starts, if it leaves it.
type Start<'a> = (&'a Frame, Option<PatchPlace>);

/// What a surface asks its patches, whose degrees differ.
pub(super) trait Patch: Debug + Send + Sync {
    fn bounds(&self) -> Aabb;
    /// A box around the part over a rectangle of the parameters.
    fn bounds_within(&self, within: Rectangle) -> Aabb;
    /// As [`Bezier::nearest`].
    fn nearest(&self, line: Start<'_>, range: Interval, keep: Keep<'_>) -> Option<Candidate>;
    /// As [`Bezier::any`].
    fn any(&self, line: Start<'_>, range: Interval, keep: Keep<'_>) -> bool;
    fn jet(&self, u: f64, v: f64) -> [DVec3; 3];
    fn normal(&self, uv: DVec2, jet: [DVec3; 3]) -> Option<DVec3>;
    fn mapped(&self, map: &Transform) -> Box<dyn Patch>;
    fn is_on_a_line(&self) -> bool;
    /// All hits of the line.
    fn all(&self, frame: &Frame, keep: Keep<'_>) -> Vec<Candidate>;
    fn copy(&self) -> Box<dyn Patch>;
    /// The patch over a larger rectangle, beyond both ends of u and of v by these parts of it; `None` if it has no point there.
    fn extended(&self, by: [[f64; 2]; 2]) -> Option<Box<dyn Patch>>;
    /// The bits of the control points of a side, counter-clockwise from `v = 0` on.
    fn border(&self, side: usize) -> Vec<[u64; 4]>;
}

impl<const K: usize> Patch for Bezier<K> {
    fn bounds(&self) -> Aabb {
        self.bounds
    }

    fn bounds_within(&self, within: Rectangle) -> Aabb {
        if within == WHOLE {
            return self.bounds;
        }
        let mut net = self.net;
        net.rows = net.rows.map(|row| between(&row, within[0]));
        for i in 0..K {
            let column = between(&net.column(i), within[1]);
            for (row, p) in net.rows.iter_mut().zip(column) {
                row[i] = p;
            }
        }
        // The rectangle may reach a little beyond the patch, where weights may vanish.
        if net.points().any(|p| !(p[3] > 0.0)) {
            return self.bounds;
        }
        let noise = DVec3::splat(self.bounds.max_abs() * gamma(64));
        hull::bounds(&net).padded(noise).intersection(&self.bounds)
    }

    fn nearest(&self, line: Start<'_>, range: Interval, keep: Keep<'_>) -> Option<Candidate> {
        self.nearest(line, range, keep)
    }

    fn any(&self, line: Start<'_>, range: Interval, keep: Keep<'_>) -> bool {
        self.any(line, range, keep)
    }

    fn jet(&self, u: f64, v: f64) -> [DVec3; 3] {
        self.jet(u, v)
    }

    fn normal(&self, uv: DVec2, jet: [DVec3; 3]) -> Option<DVec3> {
        self.normal(uv, jet)
    }

    fn mapped(&self, map: &Transform) -> Box<dyn Patch> {
        let net = self.net.map(|p| {
            let [weight, point] = [DVec3::splat(p[3]), map.point_to_world(project(*p))];
            let DVec3 { x, y, z } = point * weight;
            [x, y, z, p[3]]
        });
        Box::new(Self::new(net))
    }

    fn all(&self, frame: &Frame, keep: Keep<'_>) -> Vec<Candidate> {
        self.all(frame, keep)
    }

    fn copy(&self) -> Box<dyn Patch> {
        Box::new(Self::new(self.net))
    }

    fn extended(&self, by: [[f64; 2]; 2]) -> Option<Box<dyn Patch>> {
        let mut net = self.net;
        net.rows = net.rows.map(|row| extended(row, by[0]));
        for i in 0..K {
            let column = extended(net.column(i), by[1]);
            for (row, p) in net.rows.iter_mut().zip(column) {
                row[i] = p;
            }
        }
        if net.points().any(|p| !(p[3] > 0.0)) {
            return None;
        }
        if self.net.points().all(|p| p[3] == 1.0) {
            // Rounding must not make it rational.
            net = net.map(|[x, y, z, _]| [*x, *y, *z, 1.0]);
        }
        Some(Box::new(Self::new(net)))
    }

    fn border(&self, side: usize) -> Vec<[u64; 4]> {
        let curve = match side {
            0 => self.net.rows[0],
            1 => self.net.column(K - 1),
            2 => self.net.rows[K - 1],
            _ => self.net.column(0),
        };
        // -0 is 0.
        let bits = curve.map(|p| p.map(|x| (x + 0.0).to_bits()));
        if side < 2 {
            bits.to_vec()
        } else {
            bits.into_iter().rev().collect()
        }
    }

    fn is_on_a_line(&self) -> bool {
        is_on_a_line(points(&self.net))
    }
}

/// A curve that begins and ends these parts of it further out. An end that stays keeps its bits.
fn extended<const K: usize>(curve: Curve<4, K>, [before, after]: [f64; 2]) -> Curve<4, K> {
    let mut longer = curve;
    if before > 0.0 {
        longer.reverse();
        longer = continued(&longer, 1.0 + before);
        longer.reverse();
    }
    if after > 0.0 {
        longer = continued(&longer, 1.0 + after / (1.0 + before));
    }
    longer
}

/// The curve from one parameter to a larger one, which is positive.
fn between<const K: usize>(curve: &Curve<4, K>, [from, to]: [f64; 2]) -> Curve<4, K> {
    let mut part = continued(curve, to);
    part.reverse();
    part = continued(&part, 1.0 - from / to);
    part.reverse();
    part
}

/// The curve from its begin to a parameter before or beyond its end (de Casteljau).
fn continued<const K: usize>(curve: &Curve<4, K>, at: f64) -> Curve<4, K> {
    let (mut row, mut out) = (*curve, *curve);
    for (step, place) in out.iter_mut().enumerate().skip(1) {
        for i in 0..K - step {
            row[i] = std::array::from_fn(|k| row[i][k] + (row[i + 1][k] - row[i][k]) * at);
        }
        *place = row[0];
    }
    out
}

/// A patch over a rectangle of the surface's parameters.
#[derive(Debug)]
pub(super) struct Part {
    pub(super) patch: Box<dyn Patch>,
    pub(super) from: [f64; 2],
    pub(super) to: [f64; 2],
    /// Whether a trimming curve runs through it.
    pub(super) is_trimmed: bool,
    /// The rectangle that trimming leaves at most, in the parameters of the patch; `None` if it leaves nothing.
    pub(super) kept: Option<Rectangle>,
}

impl Part {
    /// A box around what trimming leaves; `None` if it leaves nothing.
    pub(super) fn bounds(&self) -> Option<Aabb> {
        self.kept.map(|kept| self.patch.bounds_within(kept))
    }

    /// The same part, whose pieces are made anew.
    pub(super) fn copy(&self) -> Self {
        Self {
            patch: self.patch.copy(),
            ..*self
        }
    }

    /// The parameters of the surface for those of the patch.
    pub(super) fn place(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let along = |k: usize, x: f64| self.from[k] * (1.0 - x) + self.to[k] * x;
        [along(0, x), along(1, y)]
    }
}
