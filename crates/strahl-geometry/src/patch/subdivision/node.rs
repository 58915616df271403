//! The tree of patches of one face, which grows where rays come.
//!
//! Faces whose corners are regular are patches. Others are divided, and so on: rings of ever smaller patches surround an irregular
//! vertex (M. Niessner, C. Loop, M. Meyer, T. DeRose, "Feature-adaptive GPU rendering of Catmull-Clark subdivision surfaces", ACM
//! Transactions on Graphics 31(1), 2012). Neighbours differ by one level at most, and the larger patch takes the border of
//! the smaller ones as its own.

use super::SubdivisionScheme;
use super::place::{Place, Spot};
use super::ring::Ring;
use super::rules::Tip;
use super::{quad, triangle};
use crate::patch::bezier::Bezier;
use crate::patch::border::{Border, Sides};
use crate::patch::frame::Frame;
use crate::patch::hull;
use crate::patch::net::Net;
use crate::patch::newton::Candidate;
use std::sync::{Mutex, OnceLock, PoisonError};
use strahl_math::error::gamma;
use strahl_math::{Aabb, DVec2, DVec3, Interval, Ray};

/// Around an irregular vertex, faces narrower than this part of their coordinates are thin: those at borders and ends of creases become
/// so long before they are short.
const THIN: f64 = 1.0 / (1_u64 << 32) as f64;

/// A face that is a patch, or three of them.
#[derive(Debug)]
pub(super) struct Leaf {
    patches: Patches,
    /// The normal at the irregular vertex nearby, where the patches are too thin for one of their own.
    normal: Option<Box<DVec3>>,
}

#[derive(Debug)]
enum Patches {
    Quad(Box<Bezier<4>>),
    Triangle(Box<[Bezier<5>; 3]>),
}

/// A face: one that is as it is, or one that is divided.
#[derive(Debug)]
pub(super) enum Node {
    Leaf(Leaf),
    Split(Box<Split>),
}

/// A divided face.
#[derive(Debug)]
pub(super) struct Split {
    scheme: SubdivisionScheme,
    kids: Box<[Kid]>,
}

/// A part of a divided face.
#[derive(Debug)]
struct Kid {
    bounds: Aabb,
    /// Until a ray comes.
    ring: Mutex<Option<Box<Ring>>>,
    /// From then on.
    node: OnceLock<Node>,
}

/// The line of a ray, for all that is asked along it.
pub(in crate::patch) struct Line<'a> {
    pub(super) ray: &'a Ray,
    pub(super) frame: Frame,
    inverse: DVec3,
}

impl<'a> Line<'a> {
    pub(super) fn new(ray: &'a Ray) -> Option<Self> {
        Some(Self {
            ray,
            frame: Frame::new(ray)?,
            inverse: DVec3::ONE / ray.direction,
        })
    }

    /// Where the line enters a box within a range.
    fn enter(&self, bounds: &Aabb, range: Interval) -> Option<f64> {
        let origin = self.ray.origin;
        let magnitude = origin.abs().max_element() + bounds.max_abs();
        let pad = magnitude * gamma(64);
        let (mut near, mut far) = (range.min, range.max);
        for k in 0..3 {
            let low = (bounds.min[k] - pad - origin[k]) * self.inverse[k];
            let high = (bounds.max[k] + pad - origin[k]) * self.inverse[k];
            let (a, b) = if low < high { (low, high) } else { (high, low) };
            // Comparisons with NaN, when the ray runs within a side, change nothing.
            if a > near {
                near = a;
            }
            if b < far {
                far = b;
            }
        }
        (near <= far).then_some(near)
    }
}

/// A patch of a leaf, and a hit of it.
pub(super) struct Found {
    pub(super) candidate: Candidate,
    /// Its place in the leaf.
    pub(super) spot: Spot,
}

impl Leaf {
    /// The patches of a face; `rest` if it is so near to an irregular vertex that they are thin.
    pub(super) fn new(ring: &Ring, rest: Option<Tip>) -> Self {
        let rest = rest.or_else(|| ring.tip(None));
        let is_thin = rest.is_some();
        let count = ring.corners.len();
        let divided: Vec<bool> = (0..count).map(|i| ring.is_neighbor_divided(i)).collect();
        let children = if divided.contains(&true) {
            ring.children()
        } else {
            vec![]
        };
        let patches = match ring.scheme {
            SubdivisionScheme::CatmullClark => {
                let net = quad::net(ring);
                let half = |i: usize| divided[i].then(|| quad::halves(ring, &children, i));
                Patches::Quad(Box::new(patch(net, std::array::from_fn(half), is_thin)))
            }
            SubdivisionScheme::Loop => {
                let mut nets = triangle::nets(ring);
                for i in (0..3).filter(|i| divided[*i]) {
                    // Two of the parts meet in a corner of the faces beyond.
                    let [_, half] = triangle::halves(&children, i, 0);
                    nets[i].rows[0][4] = half[4];
                    nets[(i + 1) % 3].rows[4][0] = half[4];
                }
                Patches::Triangle(Box::new(std::array::from_fn(|i| {
                    let before = (i + 2) % 3;
                    let mut sides = [const { None }; 4];
                    sides[0] = divided[i].then(|| triangle::halves(&children, i, 0));
                    sides[3] = divided[before].then(|| triangle::halves(&children, before, 1));
                    patch(nets[i], sides, is_thin)
                })))
            }
        };
        Self {
            patches,
            normal: rest.and_then(|tip| tip.normal).map(Box::new),
        }
    }

    fn bounds(&self) -> Aabb {
        match &self.patches {
            Patches::Quad(patch) => patch.bounds,
            Patches::Triangle(parts) => parts
                .iter()
                .fold(Aabb::EMPTY, |all, part| all.union(&part.bounds)),
        }
    }

    /// The nearest hit in a range.
    pub(super) fn nearest(&self, line: &Line<'_>, range: Interval) -> Option<Found> {
        match &self.patches {
            Patches::Quad(patch) => patch
                .nearest((&line.frame, None), range, None)
                .map(Found::in_quad),
            Patches::Triangle(parts) => {
                let mut best: Option<Found> = None;
                for (i, part) in parts.iter().enumerate() {
                    if line.enter(&part.bounds, range).is_none() {
                        continue;
                    }
                    let Some(found) = part.nearest((&line.frame, None), range, None) else {
                        continue;
                    };
                    if best.as_ref().is_none_or(|b| found.t < b.candidate.t) {
                        best = Some(Found::in_triangle(found, i));
                    }
                }
                best
            }
        }
    }

    /// Whether there is a hit in a range.
    pub(super) fn any(&self, line: &Line<'_>, range: Interval) -> bool {
        match &self.patches {
            Patches::Quad(patch) => patch.any((&line.frame, None), range, None),
            Patches::Triangle(parts) => parts.iter().any(|part| {
                line.enter(&part.bounds, range).is_some()
                    && part.any((&line.frame, None), range, None)
            }),
        }
    }

    /// All hits of the line.
    pub(super) fn all(&self, line: &Line<'_>) -> Vec<Found> {
        match &self.patches {
            Patches::Quad(patch) => {
                let all = patch.all(&line.frame, None);
                all.into_iter().map(Found::in_quad).collect()
            }
            Patches::Triangle(parts) => (0..3)
                .zip(parts.iter())
                .flat_map(|(i, part)| {
                    let all = part.all(&line.frame, None).into_iter();
                    all.map(move |c| Found::in_triangle(c, i))
                })
                .collect(),
        }
    }

    /// The point, its derivatives, and the direction of `dS/du x dS/dv`, if there is one.
    fn jet(&self, spot: Spot) -> ([DVec3; 3], Option<DVec3>) {
        let (jet, back) = match &self.patches {
            Patches::Quad(patch) => {
                let [u, _, v, _] = spot.0;
                let jet = patch.jet(u, v);
                (jet, patch.normal(DVec2::new(u, v), jet))
            }
            Patches::Triangle(parts) => {
                let (i, place) = into_part(spot);
                let jet = parts[i].jet(place[0], place[1]);
                let back = parts[i].normal(DVec2::from_array(place), jet);
                let [point, by_s, by_t] = jet;
                // The derivatives of u and v by the parameters of the part.
                let [[us, vs], [ut, vt]] = slopes(i, place);
                let per = 1.0 / (us * vt - ut * vs);
                let by_u = (by_s * vt - by_t * vs) * per;
                let by_v = (by_t * us - by_s * ut) * per;
                ([point, by_u, by_v], back)
            }
        };
        let own = self.normal.as_deref().copied();
        (jet, own.or_else(|| back.map(|back| -back)))
    }

    /// The bytes that it takes beside itself.
    fn bytes(&self) -> usize {
        let normal = self.normal.as_ref().map_or(0, |_| size_of::<DVec3>());
        normal
            + match &self.patches {
                Patches::Quad(patch) => patch.bytes(),
                Patches::Triangle(parts) => parts.iter().map(Bezier::bytes).sum(),
            }
    }
}

fn patch<const K: usize>(net: Net<4, K>, sides: Sides<K>, is_thin: bool) -> Bezier<K> {
    Bezier::with_border(net, Border::new(&sides), is_thin)
}

impl Found {
    fn in_quad(candidate: Candidate) -> Self {
        Self {
            candidate,
            spot: Spot::on_quad(candidate.place()),
        }
    }

    fn in_triangle(candidate: Candidate, part: usize) -> Self {
        let spot = out_of_part(part, candidate.place());
        Self { candidate, spot }
    }
}

/// The weights of the three corners, of which the part's own one is the first, at parameters of a part of a triangle.
fn weights([s, t]: [f64; 2]) -> [f64; 3] {
    let both = s * t / 6.0;
    let (after, before) = (0.5 * s - both, 0.5 * t - both);
    [(1.0 - after) - before, after, before]
}

/// The place in a triangle of parameters in its part `i`.
fn out_of_part(i: usize, place: [f64; 2]) -> Spot {
    let [own, after, before] = weights(place);
    let mut all = [own, after, before, 0.0];
    all[..3].rotate_right(i);
    Spot(all)
}

/// The derivatives of the parameters of a triangle by both parameters of its part `i`.
fn slopes(i: usize, [s, t]: [f64; 2]) -> [[f64; 2]; 2] {
    let (s6, t6) = (s / 6.0, t / 6.0);
    let by_s = [-0.5 + t6 * 2.0, 0.5 - t6, -t6];
    let by_t = [-0.5 + s6 * 2.0, -s6, 0.5 - s6];
    [by_s, by_t].map(|by| [by[(4 - i) % 3], by[(5 - i) % 3]])
}

/// The part of a triangle in which parameters are, and their place there.
fn into_part(Spot([w, u, v, _]): Spot) -> (usize, [f64; 2]) {
    let all = [w, u, v];
    let i = if all[0] >= u && all[0] >= v {
        0
    } else if u >= v {
        1
    } else {
        2
    };
    // after = s / 2 - s t / 6, before = t / 2 - s t / 6
    let (after, before) = (all[(i + 1) % 3], all[(i + 2) % 3]);
    let off = 2.0 * (after - before);
    let half = 3.0 + off;
    let square = half * half - 24.0 * after;
    let s = 12.0 * after / (half + square.max(0.0).sqrt());
    let clamp = |x: f64| x.clamp(0.0, 1.0);
    (i, [clamp(s), clamp(s - off)])
}

impl Node {
    pub(super) fn new(ring: Ring) -> Self {
        if ring.is_leaf() {
            return Self::Leaf(Leaf::new(&ring, None));
        }
        let thin = ring.tip(Some(THIN * ring.hull().max_abs()));
        let kids = ring.children().into_iter();
        Self::Split(Box::new(Split {
            scheme: ring.scheme,
            kids: kids.map(|child| Kid::new(child, thin)).collect(),
        }))
    }

    /// Calls `ask` with the patches along a line, the nearer ones first, as long as it leaves a range. It narrows the range.
    pub(super) fn walk(
        &self,
        line: &Line<'_>,
        range: Interval,
        place: Place,
        ask: &mut impl FnMut(&Leaf, Place, Interval) -> Interval,
    ) -> Interval {
        let split = match self {
            Self::Leaf(leaf) => return ask(leaf, place, range),
            Self::Split(split) => split,
        };
        // The four parts in the order in which the line enters their boxes.
        let mut order = [(0.0, 0); 4];
        let mut count = 0;
        for (i, kid) in split.kids.iter().enumerate() {
            let Some(near) = line.enter(&kid.bounds, range) else {
                continue;
            };
            let mut at = count;
            while at > 0 && order[at - 1].0 > near {
                order[at] = order[at - 1];
                at -= 1;
            }
            order[at] = (near, i);
            count += 1;
        }
        let mut left = range;
        for &(near, i) in &order[..count] {
            if near <= left.max {
                let part = place.part(Place::of_child(split.scheme, i));
                left = split.kids[i].grown().walk(line, left, part, ask);
            }
        }
        left
    }

    /// The point at a place of the face, its derivatives by the parameters, and the direction of `dS/du x dS/dv`, if there is
    /// one.
    pub(super) fn jet(&self, spot: Spot) -> ([DVec3; 3], Option<DVec3>) {
        let split = match self {
            Self::Leaf(leaf) => return leaf.jet(spot),
            Self::Split(split) => split,
        };
        let scheme = split.scheme;
        let Spot([a, b, c, _]) = spot;
        let i = match scheme {
            SubdivisionScheme::CatmullClark => match (a >= 0.5, c >= 0.5) {
                (false, false) => 0,
                (true, false) => 1,
                (true, true) => 2,
                (false, true) => 3,
            },
            SubdivisionScheme::Loop => [a, b, c].iter().position(|w| *w > 0.5).unwrap_or(3),
        };
        let place = Place::of_child(scheme, i);
        let ([point, by_u, by_v], normal) = split.kids[i].grown().jet(place.inner(scheme, spot));
        let size = place.size();
        ([point, by_u / size, by_v / size], normal)
    }

    /// The bytes that it takes beside itself.
    pub(super) fn bytes(&self) -> usize {
        match self {
            Self::Leaf(leaf) => leaf.bytes(),
            Self::Split(split) => {
                let own = size_of::<Split>() + size_of_val(&*split.kids);
                own + split.kids.iter().map(Kid::bytes).sum::<usize>()
            }
        }
    }
}

impl Kid {
    /// A part of a face; `thin` as [`Leaf::new`] takes it.
    fn new(ring: Ring, thin: Option<Tip>) -> Self {
        if ring.is_leaf() {
            let leaf = Leaf::new(&ring, thin);
            return Self {
                bounds: leaf.bounds(),
                ring: Mutex::new(None),
                node: OnceLock::from(Node::Leaf(leaf)),
            };
        }
        Self {
            bounds: padded(ring.hull()),
            ring: Mutex::new(Some(Box::new(ring))),
            node: OnceLock::new(),
        }
    }

    /// The node, which is made from the ring if it isn't there yet.
    fn grown(&self) -> &Node {
        self.node.get_or_init(|| {
            let mut place = self.ring.lock().unwrap_or_else(PoisonError::into_inner);
            let ring = place.take().expect("a node is made once");
            Node::new(*ring)
        })
    }

    /// The bytes that it takes beside itself.
    fn bytes(&self) -> usize {
        let node = self.node.get().map_or(0, Node::bytes);
        let place = self.ring.lock().unwrap_or_else(PoisonError::into_inner);
        node + place
            .as_ref()
            .map_or(0, |ring| size_of::<Ring>() + ring.bytes())
    }
}

/// A box around a surface, before anything is known about it.
pub(super) fn bounds(ring: &Ring) -> Aabb {
    let of = |ring: &Ring| {
        if !ring.is_leaf() {
            return padded(ring.hull());
        }
        match ring.scheme {
            SubdivisionScheme::CatmullClark => hull::bounds(&quad::net(ring)),
            SubdivisionScheme::Loop => triangle::nets(ring)
                .iter()
                .fold(Aabb::EMPTY, |all, net| all.union(&hull::hull(net))),
        }
    };
    if ring.is_leaf() {
        return of(ring);
    }
    let children = ring.children();
    children
        .iter()
        .fold(Aabb::EMPTY, |all, child| all.union(&of(child)))
}

/// A box, widened by rounding errors.
fn padded(tight: Aabb) -> Aabb {
    let noise = tight.min.abs().max(tight.max.abs()) * gamma(256);
    tight.padded(noise + tight.size() * (8.0 * hull::OVERLAP))
}
