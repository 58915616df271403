//! The grouping of primitives: binary trees over them.

use super::ball::{Ball, Member};
use crate::{BuildOptions, Bvh2};
use rayon::prelude::*;
use strahl_math::{Aabb, DVec3};

/// A binary tree whose leaves are single primitives.
#[derive(Clone, Debug)]
pub(super) enum Branch {
    /// Index of a member.
    Leaf(u32),
    /// Two subtrees.
    Pair(Box<[Branch; 2]>),
}

impl Branch {
    /// The members in the order of the tree.
    pub(super) fn leaves(&self, into: &mut Vec<u32>) {
        let mut waiting = vec![self];
        while let Some(branch) = waiting.pop() {
            match branch {
                Self::Leaf(member) => into.push(*member),
                Self::Pair(pair) => waiting.extend([&pair[1], &pair[0]]),
            }
        }
    }
}

/// Deeper trees would need too much stack; the hierarchy of boxes is never that deep.
const MOST_LEVELS: u32 = 64;

/// The grouping of the hierarchy of boxes.
pub(super) fn by_boxes(members: &[Member]) -> Branch {
    let bounds: Vec<Aabb> = members.iter().map(|m| m.bounds).collect();
    let options = BuildOptions {
        max_leaf_size: 1,
        ..BuildOptions::default()
    };
    Bvh2::build_with(&bounds, &options)
        .fold(Branch::Leaf, |a, b| Branch::Pair(Box::new([a, b])))
        .unwrap_or(Branch::Leaf(0))
}

/// A subtree under construction.
struct Cluster {
    ball: Ball,
    levels: u32,
    branch: Branch,
}

/// The search radius of clusters along the space-filling curve.
const RADIUS: usize = 16;

/// Merges neighbours whose common ball is the smallest, from single primitives upwards. (Meister and Bittner: Parallel
/// locally-ordered clustering, 2018; with balls for boxes.)
pub(super) fn agglomerated(members: &[Member]) -> Branch {
    let mut order: Vec<u32> = (0..members.len() as u32).collect();
    let all = members.iter().fold(Aabb::EMPTY, |b, m| b.union(&m.bounds));
    order.par_sort_by_key(|i| (morton(members[*i as usize].ball.center, &all), *i));
    let mut clusters: Vec<Cluster> = order
        .into_iter()
        .map(|i| Cluster {
            ball: members[i as usize].ball,
            levels: 0,
            branch: Branch::Leaf(i),
        })
        .collect();
    while clusters.len() > 1 {
        let nearest: Vec<usize> = (0..clusters.len())
            .into_par_iter()
            .map(|i| nearest(&clusters, i))
            .collect();
        let mut old: Vec<Option<Cluster>> = clusters.into_iter().map(Some).collect();
        clusters = Vec::with_capacity(old.len());
        for i in 0..old.len() {
            let partner = nearest[i];
            // Two clusters that chose each other are joined, at the place of the first.
            let other = (nearest[partner] == i && i < partner).then(|| old[partner].take());
            match (old[i].take(), other.flatten()) {
                (Some(a), Some(b)) => clusters.push(Cluster {
                    ball: Ball::around_two(&a.ball, &b.ball),
                    levels: 1 + a.levels.max(b.levels),
                    branch: Branch::Pair(Box::new([a.branch, b.branch])),
                }),
                (Some(a), None) => clusters.push(a),
                _ => {}
            }
        }
        if clusters.iter().any(|c| c.levels > MOST_LEVELS) {
            return by_boxes(members);
        }
    }
    clusters.pop().map_or(Branch::Leaf(0), |root| root.branch)
}

/// The neighbour with which the common ball is the smallest.
///
/// Of several equal ones the one in the same pair of places, then the nearest, then the first. So the two whose common ball is
/// the smallest of all choose each other, every round joins something, and among equal ones half of the clusters are joined.
fn nearest(clusters: &[Cluster], i: usize) -> usize {
    let range = i.saturating_sub(RADIUS)..(i + RADIUS + 1).min(clusters.len());
    let mut best = (f64::INFINITY, true, usize::MAX, i);
    for j in range.filter(|j| *j != i) {
        // The same number from both sides.
        let (a, b) = (&clusters[i.min(j)].ball, &clusters[i.max(j)].ball);
        let candidate = (Ball::around_two(a, b).radius, i ^ 1 != j, i.abs_diff(j), j);
        if candidate < best {
            best = candidate;
        }
    }
    best.3
}

/// Morton code: the interleaved bits of the coordinates.
fn morton(p: DVec3, all: &Aabb) -> u64 {
    const BITS: u32 = 20;
    let (place, size) = (p - all.min, all.size());
    let mut code = 0;
    for axis in 0..3 {
        // Flat in this direction: 0/0, which becomes 0.
        let cell = (place[axis] / size[axis] * f64::from((1u32 << BITS) - 1)) as u64;
        for bit in 0..BITS {
            code |= (cell >> bit & 1) << (3 * bit + axis as u32);
        }
    }
    code
}
