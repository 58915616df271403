//! Builds the tree bottom-up: neighbours along a space-filling curve are joined pair by pair, and the resulting binary tree is
//! collapsed to nodes of eight.
//!
//! D. Meister, J. Bittner, "Parallel locally-ordered clustering for bounding volume hierarchy construction" (2018). Segments of
//! the curve are joined separately at first: they fit the cache, and threads need not wait for each other.

use super::Tree;
use super::grow::{LEAF, Subtree};
use crate::boxes::Box32;
use crate::bvh::MAX_DEPTH;
use crate::bvh::refs::{Extent, Ref, from_lane, to_lane};
use crate::bvh::split::{LeafModel, blocks};
use arrayvec::ArrayVec;
use rayon::prelude::*;
use strahl_math::Vec4;

/// The search radius along the curve in the first rounds and in all later ones. With 8 in all rounds rays are some percent
/// faster, but building takes nearly half as long again.
const RADII: [usize; 4] = [1, 1, 1, 4];
/// Primitives in a segment of the curve that is joined separately,
const SEGMENT: usize = 8192;
/// until there is one cluster left for this many primitives.
const SEGMENT_TARGET: usize = 64;
/// A round of joining removes a third of the clusters. If rounds remove hardly any, this builder is the wrong one.
const MOST_ROUNDS: usize = 200;
/// A node of two costs less than one of eight, which replaces several of them.
const NODE_COST: f32 = 0.5;

/// The tree over at least one primitive.
pub(super) fn build(refs: Vec<Ref>) -> Tree {
    match Joined::new(&refs) {
        Some(joined) => Tree::grow(Branch {
            joined: &joined,
            cluster: joined.root,
        }),
        // Too deep for the traversal, or too many rounds: objects of very different sizes in one place.
        None => Tree::build(refs),
    }
}

/// A subtree under construction. The fourth lanes of its box hold its kind (a primitive or a node), the number of primitives
/// below it and their classes.
#[derive(Clone, Copy)]
struct Cluster {
    bounds: Box32,
}

impl Cluster {
    const COUNT_BITS: u32 = 26;
    /// Set for nodes.
    const NODE: u32 = 1 << 30;
    /// Set for nodes that are cheaper as a leaf.
    const LEAF: u32 = 1 << 31;

    fn new(bounds: Box32, link: u32, info: u32) -> Self {
        let (lo, hi) = (bounds.lo(), bounds.hi());
        Self {
            bounds: Box32::of_corners(lo.with_w(to_lane(link)), hi.with_w(to_lane(info))),
        }
    }

    fn of(r: &Ref) -> Self {
        Self::new(*r.bounds(), r.id(), 1 | 1 << r.class() << Self::COUNT_BITS)
    }

    /// The number of the primitive or of the node.
    fn link(&self) -> u32 {
        from_lane(self.bounds.lo().w)
    }

    fn info(&self) -> u32 {
        from_lane(self.bounds.hi().w)
    }

    fn count(&self) -> usize {
        (self.info() & ((1 << Self::COUNT_BITS) - 1)) as usize
    }

    fn classes(&self) -> u8 {
        (self.info() >> Self::COUNT_BITS) as u8 & 15
    }

    fn is_node(&self) -> bool {
        self.info() & Self::NODE != 0
    }

    fn is_leaf(&self) -> bool {
        !self.is_node() || self.info() & Self::LEAF != 0
    }
}

/// The current clusters, in the order of the curve.
#[derive(Default)]
struct Front {
    clusters: Vec<Cluster>,
    below: Vec<Below>,
}

/// Data of a cluster besides its box.
#[derive(Clone, Copy)]
struct Below {
    /// The cost of a ray that meets its box, by the surface area heuristic.
    cost: f32,
    /// Levels of nodes.
    depth: u32,
}

/// The nodes made of a part of the primitives, with numbers from `first` on.
struct Segment {
    first: usize,
    pairs: Vec<[Cluster; 2]>,
}

impl Segment {
    /// Joins clusters until there are no more than `target`; `None` if that makes the tree too deep or takes too long.
    fn join(&mut self, mut front: Front, target: usize, unit: f32) -> Option<Front> {
        let (mut best, mut next) = (Vec::new(), Front::default());
        let mut rounds = 0;
        while front.clusters.len() > target {
            if rounds == MOST_ROUNDS {
                return None;
            }
            let radius = RADII[rounds.min(RADII.len() - 1)];
            rounds += 1;
            find_partners(&front.clusters, radius, unit, &mut best);
            next.clusters.clear();
            next.below.clear();
            for (i, (cluster, below)) in front.clusters.iter().zip(&front.below).enumerate() {
                let other = partner(i, best[i]);
                if partner(other, best[other]) != i {
                    next.clusters.push(*cluster);
                    next.below.push(*below);
                } else if i < other {
                    // Two clusters that chose each other are joined, at the place of the first.
                    let (joined, below) = self.pair(
                        [*cluster, front.clusters[other]],
                        [below, &front.below[other]],
                        unit,
                    )?;
                    next.clusters.push(joined);
                    next.below.push(below);
                }
            }
            std::mem::swap(&mut front, &mut next);
        }
        Some(front)
    }

    fn pair(
        &mut self,
        halves: [Cluster; 2],
        below: [&Below; 2],
        unit: f32,
    ) -> Option<(Cluster, Below)> {
        let [a, b] = &halves;
        let (count, classes) = (a.count() + b.count(), a.classes() | b.classes());
        let area = joined_area(a, b, unit);
        let mut info = count as u32 | u32::from(classes) << Cluster::COUNT_BITS | Cluster::NODE;
        let mut cost = NODE_COST * area + below[0].cost + below[1].cost;
        if count <= LEAF.max_size && classes.is_power_of_two() {
            let leaf = area * blocks(count, LEAF.block_log(classes)) as f32;
            if leaf <= cost {
                cost = leaf;
                info |= Cluster::LEAF;
            }
        }
        let mut bounds = a.bounds;
        bounds.grow(&b.bounds);
        let depth = 1 + below[0].depth.max(below[1].depth);
        let number = self.first + self.pairs.len();
        self.pairs.push(halves);
        let joined = Cluster::new(bounds, number as u32, info);
        ((depth as usize) < MAX_DEPTH - 1).then_some((joined, Below { cost, depth }))
    }
}

/// Half the surface area of the box around two clusters.
#[inline(always)]
fn joined_area(a: &Cluster, b: &Cluster, unit: f32) -> f32 {
    let mut bounds = a.bounds;
    bounds.grow(&b.bounds);
    let [x, y, z, _] = (bounds.size() * Vec4::splat(unit)).to_array();
    x * y + z * (x + y)
}

/// For each cluster the partner with the smallest common box, encoded as a number that is smaller the better the choice: area,
/// then whether the two places form a pair, then distance, then whether the partner comes later. So the best choice of all is
/// mutual, every round joins something, and among equal ones half of the clusters are joined.
fn find_partners(clusters: &[Cluster], radius: usize, unit: f32, best: &mut Vec<u64>) {
    best.clear();
    best.resize(clusters.len(), u64::MAX);
    for (i, a) in clusters.iter().enumerate() {
        let later = &clusters[i + 1..clusters.len().min(i + 1 + radius)];
        for (distance, b) in (1u64..).zip(later) {
            let j = i + distance as usize;
            let area = joined_area(a, b, unit);
            let key = u64::from(area.to_bits()) << 32 | u64::from(i ^ 1 != j) << 31 | distance << 1;
            best[i] = best[i].min(key | 1);
            best[j] = best[j].min(key);
        }
    }
}

/// The partner of a cluster, decoded from the result of [`find_partners`].
fn partner(i: usize, best: u64) -> usize {
    let distance = (best as u32 & 0x7fff_ffff) as usize >> 1;
    if best & 1 == 1 {
        i + distance
    } else {
        i - distance
    }
}

/// The binary tree.
struct Joined {
    root: Cluster,
    /// The nodes of each segment of the curve, then those above them.
    segments: Vec<Segment>,
}

impl Joined {
    /// The tree over primitives; `None` if it would be too deep, or takes too long.
    fn new(refs: &[Ref]) -> Option<Self> {
        let extent = Extent::of_many(refs);
        let unit = extent.bounds.unit();
        let order = along_curve(refs, &extent);
        let parts = order.par_chunks(SEGMENT).enumerate().map(|(i, order)| {
            let mut front = Front::default();
            for r in order.iter().map(|i| &refs[*i as usize]) {
                let cluster = Cluster::of(r);
                let cost = joined_area(&cluster, &cluster, unit);
                front.clusters.push(cluster);
                front.below.push(Below { cost, depth: 0 });
            }
            let mut segment = Segment {
                first: i * SEGMENT,
                pairs: Vec::with_capacity(order.len()),
            };
            let front = segment.join(front, order.len().div_ceil(SEGMENT_TARGET), unit)?;
            Some((segment, front))
        });
        let parts: Option<Vec<(Segment, Front)>> = parts.collect();
        let (mut segments, fronts): (Vec<Segment>, Vec<Front>) = parts?.into_iter().unzip();
        let mut front = Front::default();
        for part in fronts {
            front.clusters.extend(part.clusters);
            front.below.extend(part.below);
        }
        let mut top = Segment {
            first: segments.len() * SEGMENT,
            pairs: Vec::with_capacity(front.clusters.len()),
        };
        let front = top.join(front, 1, unit)?;
        segments.push(top);
        Some(Self {
            root: *front.clusters.first()?,
            segments,
        })
    }

    /// The children of a node.
    fn halves(&self, node: u32) -> &[Cluster; 2] {
        let top = self.segments.len() - 1;
        let segment = &self.segments[(node as usize / SEGMENT).min(top)];
        &segment.pairs[node as usize - segment.first]
    }
}

/// The numbers of primitives in Morton order: by the interleaved bits of their centres' coordinates.
fn along_curve(refs: &[Ref], extent: &Extent) -> Vec<u32> {
    const BITS: u32 = 13;
    const DIGIT: u32 = 10;
    let centers = extent.centers;
    let cells = ((1 << BITS) - 1) as f32;
    // If the scene is flat along an axis this is 0/0, which the cast below turns into 0.
    let scale = Vec4::splat(cells) / centers.size();
    let code = |(i, r): (usize, &Ref)| {
        let [x, y, z, _] = ((r.bounds().center() - centers.lo()) * scale).to_array();
        // Casts saturate.
        let place = |x: f32| spread((x as u32).min((1 << BITS) - 1));
        (place(x) << 2 | place(y) << 1 | place(z)) << Tree::ID_BITS | i as u64
    };
    let mut codes: Vec<u64> = refs.par_iter().enumerate().map(code).collect();
    let mut sorted = vec![0; codes.len()];
    // A radix sort: from the lowest digit to the highest, each pass being stable.
    for digit in 0..(3 * BITS).div_ceil(DIGIT) {
        let bucket = |code: u64| (code >> (Tree::ID_BITS + digit * DIGIT)) as usize % (1 << DIGIT);
        let mut places = [0usize; 1 << DIGIT];
        for code in &codes {
            places[bucket(*code)] += 1;
        }
        let mut next = 0;
        for place in &mut places {
            next += std::mem::replace(place, next);
        }
        for code in &codes {
            let place = &mut places[bucket(*code)];
            sorted[*place] = *code;
            *place += 1;
        }
        std::mem::swap(&mut codes, &mut sorted);
    }
    let ids = codes
        .iter()
        .map(|code| (code % (1 << Tree::ID_BITS)) as u32);
    ids.collect()
}

/// The bits of a number of 13 bits, each in every third place.
fn spread(x: u32) -> u64 {
    let mut x = u64::from(x);
    x = (x | x << 16) & 0x00ff_0000_ff00_00ff;
    x = (x | x << 8) & 0xf00f_00f0_0f00_f00f;
    x = (x | x << 4) & 0x30c3_0c30_c30c_30c3;
    (x | x << 2) & 0x9249_2492_4924_9249
}

/// A subtree of the binary tree.
#[derive(Clone, Copy)]
struct Branch<'a> {
    joined: &'a Joined,
    cluster: Cluster,
}

impl Subtree for Branch<'_> {
    type Scratch = ();

    fn bounds(&self) -> &Box32 {
        &self.cluster.bounds
    }

    fn count(&self) -> usize {
        self.cluster.count()
    }

    fn split(self, _: &LeafModel, (): &mut ()) -> Result<[Self; 2], Self> {
        if self.cluster.is_leaf() {
            return Err(self);
        }
        let halves = self.joined.halves(self.cluster.link());
        Ok(halves.map(|cluster| Self { cluster, ..self }))
    }

    fn class(&self) -> u8 {
        self.cluster.classes().trailing_zeros() as u8
    }

    fn ids(&self, into: &mut Vec<u32>) {
        let mut waiting: ArrayVec<Cluster, { LEAF.max_size }> = ArrayVec::new();
        let mut next = Some(self.cluster);
        while let Some(cluster) = next {
            next = if cluster.is_node() {
                let [a, b] = self.joined.halves(cluster.link());
                waiting.push(*b);
                Some(*a)
            } else {
                into.push(cluster.link());
                waiting.pop()
            };
        }
    }
}
