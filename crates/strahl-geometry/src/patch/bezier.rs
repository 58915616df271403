//! A Bezier patch of any degree, polynomial or rational: what all free-form surfaces are made of.

use super::border::{Border, Region};
use super::degree;
use super::frame::Frame;
use super::hull;
use super::net::Net;
use super::newton::Candidate;
use super::piece::PatchPlace;
use super::search::{Aim, Keep, Search};
use super::settle;
use super::tree::Tree;
use std::sync::OnceLock;
use strahl_math::error::gamma;
use strahl_math::{Aabb, DVec2, DVec3, Interval};

/// A tangent shorter than this part of the patch counts as vanished.
const VANISHED: f64 = 1.0 / (1u64 << 28) as f64;
/// Where a tangent vanishes, the normal is taken from points so much nearer to the middle.
const ASIDE: [f64; 5] = [
    0.0,
    1.0 / 16_777_216.0,
    1.0 / 65_536.0,
    1.0 / 1024.0,
    1.0 / 16.0,
];

/// A patch of degree `K - 1` in both parameters.
#[derive(Debug)]
pub(super) struct Bezier<const K: usize> {
    /// Control points times their weights, and the weights.
    pub(super) net: Net<4, K>,
    is_rational: bool,
    /// What the border is for its neighbours, if they have smaller patches.
    border: Border<K>,
    /// How far the net may be from what neighbours know of it.
    seam: f64,
    /// Whether it is so thin that only its border tells whether a ray meets it.
    is_thin: bool,
    pub(super) bounds: Aabb,
    /// The pieces, when the first ray comes.
    tree: OnceLock<Box<Tree>>,
}

impl<const K: usize> Bezier<K> {
    pub(super) fn new(net: Net<4, K>) -> Self {
        Self {
            is_rational: net.points().any(|p| p[3] != 1.0),
            bounds: hull::bounds(&net),
            net,
            border: Border::default(),
            seam: 0.0,
            is_thin: false,
            tree: OnceLock::new(),
        }
    }

    /// A polynomial patch, some sides of which belong to the two halves of patches beyond. The curves of these halves follow from
    /// the same points as the side itself, up to rounding.
    ///
    /// A thin patch is hardly larger than the rounding errors of its points: rays meet it as often as its border winds around
    /// them, and no more.
    pub(super) fn with_border(net: Net<4, K>, border: Border<K>, is_thin: bool) -> Self {
        let patch = Self::new(net);
        Self {
            border,
            is_thin,
            seam: gamma(64) * patch.bounds.max_abs(),
            ..patch
        }
    }

    /// The bytes that it takes, so far.
    pub(super) fn bytes(&self) -> usize {
        let pieces = self.tree.get().map_or(0, |tree| tree.bytes());
        size_of::<Self>() + self.border.bytes() + pieces
    }

    fn tree(&self) -> &Tree {
        self.tree
            .get_or_init(|| Box::new(Tree::build(&self.net, self.seam)))
    }

    fn search<'a>(&'a self, frame: &'a Frame, keep: Keep<'a>, aim: Aim) -> Search<'a, K> {
        Search::new(&self.net, self.tree(), frame, keep, aim).with_seam(self.seam)
    }

    /// How often the border winds around a ray.
    pub(super) fn winding(&self, frame: &Frame) -> i32 {
        self.border.winding(&self.net, |p| frame.see(p))
    }

    /// The nearest hit in a range, for a ray that starts at this place, if it leaves the patch.
    pub(super) fn nearest(
        &self,
        (frame, start): (&Frame, Option<PatchPlace>),
        range: Interval,
        keep: Keep<'_>,
    ) -> Option<Candidate> {
        let aim = Aim::Nearest {
            range,
            nearest: None,
            is_doubtful: self.is_thin,
        };
        let mut search = self.search(frame, keep, aim).from(start);
        search.run();
        match search.aim {
            Aim::Nearest {
                nearest,
                is_doubtful: false,
                ..
            } => nearest,
            _ => {
                let hits = self.all(frame, keep).into_iter();
                let hits = hits.filter(|c| range.accepts(c.t));
                hits.min_by(|a, b| a.t.total_cmp(&b.t))
            }
        }
    }

    /// Whether there is a hit in a range, for a ray that starts at this place, if it leaves the patch.
    pub(super) fn any(
        &self,
        (frame, start): (&Frame, Option<PatchPlace>),
        range: Interval,
        keep: Keep<'_>,
    ) -> bool {
        let aim = Aim::Any {
            range,
            found: false,
            is_doubtful: self.is_thin,
        };
        let mut search = self.search(frame, keep, aim).from(start);
        search.run();
        match search.aim {
            Aim::Any { found: true, .. } => true,
            Aim::Any {
                is_doubtful: false, ..
            } => false,
            _ => self.all(frame, keep).iter().any(|c| range.accepts(c.t)),
        }
    }

    /// All hits of the line, in no order.
    pub(super) fn all(&self, frame: &Frame, keep: Keep<'_>) -> Vec<Candidate> {
        let winding = |region: &Region| {
            if *region == Region::WHOLE {
                return self.winding(frame);
            }
            let see = |p: &[f64; 4]| frame.see(p);
            self.border.winding_of_region(&self.net, region, see)
        };
        let lost = |hits: &[Candidate], given_up: &[Candidate], sign| {
            degree::lost(&self.net, frame, hits, given_up, sign)
        };
        let mut found = if self.is_thin {
            settle::add_lost(vec![], self.winding(frame), |hits, sign| {
                lost(hits, &[], sign)
            })
        } else {
            let mut search = self.search(frame, keep, Aim::All(vec![]));
            search.run();
            match search.aim {
                Aim::All(found) => settle::settle(found, winding, lost),
                Aim::Nearest { .. } | Aim::Any { .. } => vec![],
            }
        };
        // Cut only now: what is cut away counts in the sum of the hits, too.
        if let Some(keep) = keep {
            found.retain(|c| {
                let [u, v] = c.place();
                keep(u, v)
            });
        }
        found
    }

    /// The point and the derivatives.
    pub(super) fn jet(&self, u: f64, v: f64) -> [DVec3; 3] {
        let jet = self.net.jet(u, v);
        let [value, by_u, by_v] =
            [jet.value, jet.by_u, jet.by_v].map(|[x, y, z, _]| DVec3::new(x, y, z));
        if !self.is_rational {
            return [value, by_u, by_v];
        }
        let weight = jet.value[3];
        let point = value / weight;
        [
            point,
            (by_u - point * jet.by_u[3]) / weight,
            (by_v - point * jet.by_v[3]) / weight,
        ]
    }

    /// The direction of `dS/dv x dS/du`, where there is one nearby; `jet` is that of the place.
    pub(super) fn normal(&self, uv: DVec2, [_, by_u, by_v]: [DVec3; 3]) -> Option<DVec3> {
        let size = self.bounds.size().max_element();
        for part in ASIDE {
            let (by_u, by_v) = if part == 0.0 {
                (by_u, by_v)
            } else {
                let aside = uv + (DVec2::splat(0.5) - uv) * part;
                let [_, by_u, by_v] = self.jet(aside.x, aside.y);
                (by_u, by_v)
            };
            let (a, b) = (by_u.length(), by_v.length());
            if !(a > VANISHED * size && b > VANISHED * size) {
                continue;
            }
            let normal = (by_v / b).cross(by_u / a);
            if normal.length() > VANISHED {
                return Some(normal.normalize());
            }
        }
        None
    }
}

/// Whether points lie on a line, up to rounding.
pub(super) fn is_on_a_line(points: impl Iterator<Item = DVec3> + Clone) -> bool {
    let Some(first) = points.clone().next() else {
        return true;
    };
    let far = points.clone().fold(DVec3::ZERO, |far, p| {
        let d = p - first;
        if d.length() > far.length() { d } else { far }
    });
    let along = crate::primitives::unit_vector(far);
    let (mut width, mut magnitude) = (0.0_f64, 0.0_f64);
    for p in points {
        width = width.max((p - first).cross(along).length());
        magnitude = magnitude.max(p.abs().max_element());
    }
    !(width > gamma(8) * magnitude)
}
