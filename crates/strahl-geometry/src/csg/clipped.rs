//! An open surface that convex solids clip, as programs write it that cut a mesh off with a box.
//!
//! Nearly every ray meets the surface far from those of the solids, and then it only matters whether the place is within them all. Rays that meet
//! it near one of their surfaces are left to the general search; so both give the same bits.

use super::compiled::Csg;
use super::first::Answer;
use super::leaf::Leaf;
use super::node::{Kind, Node};
use super::query::Query;
use super::sweep::Rule;
use crate::{PrimHit, Primitive, Scratch, SurfaceId};
use strahl_math::{Interval, Ray};

/// The parts of an intersection of one open surface with invisible convex solids.
#[derive(Clone, Debug)]
pub(super) struct Clipped {
    /// The number of the open leaf.
    open: u32,
    /// Those of the solids.
    solids: Box<[u32]>,
}

impl Clipped {
    /// The tree whose root is the first node, if it is such an intersection.
    pub(super) fn of(nodes: &[Node], leaves: &[Leaf]) -> Option<Self> {
        let (root, operands) = nodes.split_first()?;
        let flat = root.kind == Kind::Operation(Rule::Intersection)
            && operands.len() == leaves.len()
            && operands.iter().all(|node| node.parent == 0);
        let mut open = None;
        let mut solids = vec![];
        for (number, leaf) in (0..).zip(leaves) {
            if leaf.is_convex() && !leaf.visible && !leaf.negative {
                solids.push(number);
            } else if leaf.solid().is_none() && leaf.visible && !leaf.negative && open.is_none() {
                open = Some(number);
            } else {
                return None;
            }
        }
        let open = open.filter(|_| flat && !solids.is_empty())?;
        Some(Self {
            open,
            solids: solids.into(),
        })
    }

    /// Searches the first hit of the surface with `range.min < t <= range.max` within the solids.
    pub(super) fn first_visible(
        &self,
        csg: &Csg,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        scratch: &mut Scratch,
    ) -> Answer {
        let from = from.map(|surface| csg.leaf_surface(surface));
        let Some(query) = Query::new(ray, range, from) else {
            return Answer::Certain(None);
        };
        let Some(open) = csg.leaf(self.open) else {
            return Answer::Unclear;
        };
        // Where the ray may be within all solids, and where it certainly is.
        let (mut possible, mut sure) = (query.range, Interval::LINE);
        for solid in &self.solids {
            let Some(stay) = csg.leaf(*solid).and_then(|leaf| leaf.stay(ray, None)) else {
                return Answer::Unclear;
            };
            let Some(span) = stay.span else {
                return Answer::Certain(None);
            };
            let (enter, exit) = (span.enter.t, span.exit.t);
            let gap = |t: f64| query.fusing.gap(t, t);
            if enter > f64::NEG_INFINITY {
                let (near, within) = (enter - gap(enter), enter + gap(enter));
                possible.min = possible.min.max(near);
                sure.min = sure.min.max(within);
            }
            if exit < f64::INFINITY {
                let (near, within) = (exit + gap(exit), exit - gap(exit));
                possible.max = possible.max.min(near);
                sure.max = sure.max.min(within);
            }
        }
        if !(possible.min < possible.max) {
            return Answer::Certain(None);
        }
        let own = query.own(self.open);
        let inner = open.ray_to_object(ray);
        // In a space of its own hits have errors: two could be fused.
        let is_alone = |hit: &PrimHit, scratch: &mut Scratch| {
            let near = Interval::new(hit.t, hit.t + query.fusing.gap(hit.t, hit.t));
            open.placement.is_none() || !open.shape.any_hit(&inner, near, own, scratch)
        };
        match open.shape.closest_hit(&inner, possible, own, scratch) {
            None => Answer::Certain(None),
            Some(hit)
                if sure.min < hit.t
                    && hit.t < sure.max
                    && !query.starts_at(hit.t)
                    && is_alone(&hit, scratch) =>
            {
                let element = open.first_element.saturating_add(hit.surface.element);
                Answer::Certain(Some(PrimHit {
                    surface: SurfaceId {
                        element,
                        ..hit.surface
                    },
                    ..hit
                }))
            }
            Some(_) => Answer::Unclear,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::evaluate::Evaluation;
    use super::*;
    use crate::conformance::Random;
    use crate::mesh::samples::torus;
    use crate::{
        Crossings, CsgNode, Cuboid, Cylinder, Plane, Shape, Sphere, Triangle, TriangleMesh,
    };
    use std::sync::Arc;
    use strahl_math::{DVec3, Transform};

    fn open(random: &mut Random) -> Shape {
        match random.below(2) {
            0 => Arc::new(TriangleMesh::try_new(torus(40, 20, 1.0, 0.4)).expect("a torus")).into(),
            _ => Triangle::new(random.cube(), random.cube(), random.cube()).into(),
        }
    }

    fn solid(random: &mut Random) -> Shape {
        let center = random.cube() * 0.6;
        match random.below(4) {
            0 => Sphere::new(center, 1.0).into(),
            1 => Plane::new(center, random.direction()).into(),
            2 => Cylinder::new(center - DVec3::Y, center + random.cube(), 0.8).into(),
            // Faces that touch the torus, or cut it along its edges.
            _ => Cuboid::new(DVec3::splat(-1.4), DVec3::new(1.4, 0.0, 0.4)).into(),
        }
    }

    #[test]
    fn what_is_certain_is_what_the_general_search_finds() {
        let mut random = Random::new(71);
        let (mut sure, mut hits, mut unclear, mut starts) = (0, 0, 0, 0);
        let mut scratch = Scratch::default();
        for _ in 0..300 {
            let count = 1 + random.below(3);
            let solids: Vec<_> = (0..count)
                .map(|_| CsgNode::leaf(solid(&mut random), 1))
                .collect();
            let mut surface = CsgNode::leaf(open(&mut random), 0);
            if random.below(2) == 0 {
                surface = surface.transformed(Transform::rotate(random.direction(), 1.0));
            }
            let tree = CsgNode::clip(surface, solids);
            let csg = Csg::try_new(tree).expect("a tree");
            let clipped = csg.clipped().expect("an open surface that is clipped");
            for _ in 0..60 {
                let origin = random.cube() * 3.0;
                let target = match random.below(4) {
                    // A vertex of the torus, where it meets a face of the box.
                    0 => DVec3::X * 1.4,
                    _ => random.cube(),
                };
                let mut ray = Ray::new(origin, target - origin);
                let (mut range, mut from) = (Interval::FORWARD, None);
                for _ in 0..3 {
                    let mut list = Crossings::default();
                    Evaluation::run(&csg, &ray, range, from, &mut scratch, &mut list);
                    let expected = list.list.iter().find(|c| c.visible).map(|c| c.hit);
                    match clipped.first_visible(&csg, &ray, range, from, &mut scratch) {
                        Answer::Unclear => unclear += 1,
                        Answer::Certain(found) => {
                            assert_eq!(found, expected, "{ray:?} {range:?} {from:?}\n{csg:?}");
                            sure += 1;
                            hits += u32::from(found.is_some());
                        }
                    }
                    assert_eq!(csg.closest_hit(&ray, range, from, &mut scratch), expected);
                    let Some(hit) = expected else { break };
                    // Behind the hit, then from the surface there, into another direction.
                    if random.below(2) == 0 {
                        range = Interval::new(hit.t, random.between(hit.t, 9.0));
                        continue;
                    }
                    starts += 1;
                    ray = Ray::new(csg.surface_at(&ray, &hit).position, random.direction());
                    (range, from) = (Interval::FORWARD, Some(hit.surface));
                }
            }
        }
        assert!(
            hits > 2000 && starts > 1000 && sure > 40 * unclear,
            "{sure} {hits} {unclear} {starts}"
        );
    }
}
