use super::ball::{Ball, Member};
use super::topology::{Branch, agglomerated, by_boxes};
use super::{Grouping, Node, Spheres, SpheresParameters, Tree, WIDTH};
use crate::boxes::Box32;
use crate::cull::CullBounds;
use crate::{List, Shapes};
use strahl_math::error::round_up_f32;
use strahl_math::{Aabb, DVec3};

/// Subtrees of more primitives are handled by several threads.
const PARALLEL: usize = 4096;

/// Subtrees of no more primitives are one leaf: testing them takes no longer than testing their spheres.
const LEAF: usize = 2;

impl Spheres {
    /// Builds the hierarchy.
    pub fn build(shapes: &dyn Shapes, parameters: &SpheresParameters) -> Self {
        let (mut members, mut unbounded) = (Vec::new(), Vec::new());
        for id in 0..shapes.count() as u32 {
            let bounds = shapes.bounds(id);
            if Box32::try_new(&bounds).is_some() {
                members.push(Member {
                    id,
                    bounds,
                    ball: ball_of(shapes, id, &bounds),
                });
            } else if !bounds.is_empty() {
                unbounded.push(id);
            }
        }
        Self {
            tree: (!members.is_empty()).then(|| Tree::build(&members, parameters)),
            unbounded: List::of(unbounded),
        }
    }
}

/// The smaller of the ball around the box and the primitive's own ball.
fn ball_of(shapes: &dyn Shapes, id: u32, bounds: &Aabb) -> Ball {
    let of_box = Ball::around_box(bounds);
    match shapes.sphere(id) {
        Some((center, radius)) if radius < of_box.radius => Ball { center, radius },
        _ => of_box,
    }
}

impl Tree {
    fn build(members: &[Member], parameters: &SpheresParameters) -> Self {
        let bounds = members.iter().fold(Aabb::EMPTY, |b, m| b.union(&m.bounds));
        let branch = match parameters.build {
            Grouping::Boxes => by_boxes(members),
            Grouping::Agglomerative => agglomerated(members),
        };
        let bounds = CullBounds::new(bounds);
        let unit = f64::from_bits(bounds.max_abs().to_bits() & f64::INFINITY.to_bits());
        let mut order = Vec::with_capacity(members.len());
        branch.leaves(&mut order);
        let members: Vec<Member> = order.iter().map(|i| members[*i as usize]).collect();
        let grown = Grown::new(&branch, &members);
        let mut tree = Self {
            nodes: Vec::new(),
            ids: members.iter().map(|m| m.id).collect(),
            bounds,
            unit,
        };
        tree.add(&grown, 0);
        tree
    }

    /// Adds the node of a subtree whose primitives begin at `first`, with all below it; returns its number.
    fn add(&mut self, tree: &Grown, first: usize) -> u32 {
        let number = self.nodes.len();
        self.nodes.push(Node::EMPTY);
        for (lane, (child, offset)) in tree.children().into_iter().enumerate() {
            let first = first + offset;
            let (first, count) = if child.count <= LEAF {
                (first as u32, child.count as u32)
            } else {
                (self.add(child, first), 0)
            };
            let unit = self.unit;
            let node = &mut self.nodes[number];
            node.set(lane, &child.ball, unit);
            (node.first[lane], node.count[lane]) = (first, count);
        }
        number as u32
    }
}

impl Node {
    const EMPTY: Self = Self {
        center: [[0.0; WIDTH]; 3],
        radius: [f32::NAN; WIDTH],
        first: [0; WIDTH],
        count: [0; WIDTH],
    };

    /// Sets a sphere, rounded outwards.
    fn set(&mut self, lane: usize, ball: &Ball, unit: f64) {
        let center = ball.center / unit;
        let mut rounded = DVec3::ZERO;
        for axis in 0..3 {
            let c = center[axis] as f32;
            self.center[axis][lane] = c;
            rounded[axis] = f64::from(c);
        }
        let moved = (rounded - center).length() * (1.0 + 16.0 * f64::EPSILON);
        self.radius[lane] = round_up_f32((ball.radius / unit + moved) * (1.0 + f64::EPSILON));
    }
}

/// A binary tree with the balls of its subtrees.
struct Grown {
    ball: Ball,
    /// Number of primitives.
    count: usize,
    below: Option<Box<[Grown; 2]>>,
}

impl Grown {
    /// Computes the balls from the bottom; `members` are those of the branch, in its order.
    fn new(branch: &Branch, members: &[Member]) -> Self {
        let Branch::Pair(pair) = branch else {
            return Self {
                ball: members[0].ball,
                count: 1,
                below: None,
            };
        };
        let middle = count(&pair[0], members.len());
        let (left, right) = members.split_at(middle);
        let make = || Self::new(&pair[0], left);
        let make_other = || Self::new(&pair[1], right);
        let below = if members.len() > PARALLEL {
            let (a, b) = rayon::join(make, make_other);
            [a, b]
        } else {
            [make(), make_other()]
        };
        let hint = Ball::around_two(&below[0].ball, &below[1].ball);
        Self {
            ball: Ball::around(members, &hint),
            count: members.len(),
            below: Some(Box::new(below)),
        }
    }

    /// Up to eight subtrees that make up this tree, with the positions of their first primitives: the largest ones are opened
    /// first.
    fn children(&self) -> Vec<(&Self, usize)> {
        let mut children = vec![(self, 0)];
        while children.len() < WIDTH {
            let mut largest = None;
            for (index, (child, _)) in children.iter().enumerate() {
                let radius = child.ball.radius;
                if child.count > LEAF && largest.is_none_or(|(_, r)| radius > r) {
                    largest = Some((index, radius));
                }
            }
            let Some((index, _)) = largest else { break };
            let (open, offset) = children[index];
            let Some(below) = &open.below else { break };
            children[index] = (&below[0], offset);
            children.insert(index + 1, (&below[1], offset + below[0].count));
        }
        children
    }
}

/// The number of primitives of a branch, at most `limit`.
fn count(branch: &Branch, limit: usize) -> usize {
    let (mut waiting, mut n) = (vec![branch], 0);
    while let Some(branch) = waiting.pop() {
        match branch {
            Branch::Leaf(_) => n += 1,
            Branch::Pair(pair) => waiting.extend(pair.iter()),
        }
    }
    n.min(limit)
}
