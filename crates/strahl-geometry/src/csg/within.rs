//! Proofs that a tree lies in a convex region, by branch and bound: a box that is not yet known to be in the region or outside of
//! the tree is halved.

use super::compiled::Csg;
use super::node::{Kind, Node};
use super::sweep::Rule;
use super::tighten::{Cell, Form, Region};
use crate::{Primitive, Solid};
use strahl_math::{Aabb, DVec3};

/// Trees with more leaves are not examined.
const LEAVES: usize = 32;
/// The number of boxes examined.
const BUDGET: u32 = 512;
/// The size of the smallest boxes, relative to the bounds.
const FINE: f64 = 1.0 / 128.0;
/// How far corners may be outside of the region, relative to the bounds: boxes are padded for rounding.
const SLACK: f64 = 1e-9;

impl Csg {
    /// Whether all surfaces of the tree certainly lie in a convex solid, except for rounding errors. False also where a proof would take
    /// too long.
    pub fn lies_within(&self, solid: &Self) -> bool {
        let bounds = self.bounds();
        if !bounds.is_bounded() || self.leaves() > LEAVES || !self.is_shallow() {
            return false;
        }
        let center = bounds.center();
        let contains = |corner: DVec3| solid.contains(corner + (center - corner) * SLACK);
        let corners = |node: &Node| node.half_spaces.as_ref()?.corners();
        let root = self
            .node(0)
            .filter(|root| root.kind == Kind::Operation(Rule::Intersection));
        if let Some(corners) = root.and_then(corners)
            && corners.into_iter().all(contains)
        {
            return true;
        }
        let differences = self.differences(solid, SLACK * bounds.size().length_squared());
        let fine = bounds.size() * FINE;
        let regions: Vec<Option<Region<'_>>> = (0..self.leaves() as u32)
            .map(|leaf| self.leaf(leaf).and_then(Region::of))
            .collect();
        let mut waiting = vec![bounds];
        for _ in 0..BUDGET {
            let Some(part) = waiting.pop() else {
                return true;
            };
            let cell = Cell::of(&part);
            if part.corners().into_iter().all(contains)
                || differences.iter().any(|form| form.excludes(&cell))
                || self.excludes(0, &part, &regions)
            {
                continue;
            }
            let size = part.size();
            if size.cmple(fine).all() {
                return false;
            }
            let axis = size.to_array();
            let axis = (0..3).fold(0, |a, b| if axis[b] > axis[a] { b } else { a });
            let middle = part.center()[axis];
            let (mut low, mut high) = (part, part);
            low.max[axis] = middle;
            high.min[axis] = middle;
            waiting.extend([low, high]);
        }
        false
    }

    /// For a solid with the form F and each operand of an intersection with a form G the form G - F: where it is positive, what is in the
    /// operand is in the solid. For two balls it is a linear function, so large boxes will do.
    fn differences(&self, solid: &Self, slack: f64) -> Vec<Form> {
        let Some(outer) = solid.leaf(0).filter(|_| solid.leaves() == 1) else {
            return vec![];
        };
        let (Some(outer), Some(root)) = (Form::of(outer), self.node(0)) else {
            return vec![];
        };
        if root.kind != Kind::Operation(Rule::Intersection) {
            return vec![];
        }
        let form_of = |operand| match self.node(operand)?.kind {
            Kind::Leaf(leaf) => Form::of(self.leaf(leaf)?),
            Kind::Operation(_) => None,
        };
        let inner = self.operands_of(root).filter_map(form_of);
        inner.map(|inner| inner.minus(&outer, slack)).collect()
    }

    /// Whether nothing of a node is in a box. The depth of the recursion is that of the tree.
    fn excludes(&self, index: u32, part: &Aabb, regions: &[Option<Region<'_>>]) -> bool {
        let Some(node) = self.node(index) else {
            return false;
        };
        if !node.far && node.bounds.intersection(part).is_empty() {
            return true;
        }
        match node.kind {
            Kind::Leaf(leaf) => {
                let region = regions.get(leaf as usize).and_then(Option::as_ref);
                region.is_some_and(|region| region.excludes(&Cell::of(part)))
            }
            Kind::Operation(Rule::Intersection) => self
                .operands_of(node)
                .any(|o| self.excludes(o, part, regions)),
            Kind::Operation(_) => self
                .operands_of(node)
                .all(|o| self.excludes(o, part, regions)),
        }
    }

    fn operands_of(&self, node: &Node) -> impl Iterator<Item = u32> {
        (node.first..node.end).filter_map(|i| self.operand(i))
    }
}

#[cfg(test)]
mod tests {
    use crate::{Csg, CsgNode, Cuboid, Cylinder, Plane, Shape, Sphere, Torus};
    use strahl_math::DVec3;

    fn tree(node: CsgNode) -> Csg {
        Csg::try_new(node).expect("a tree")
    }

    fn intersection(shapes: Vec<Shape>) -> CsgNode {
        let leaves = shapes.into_iter().map(|shape| CsgNode::leaf(shape, 0));
        CsgNode::Intersection(leaves.collect::<Vec<_>>().into())
    }

    fn cube() -> CsgNode {
        let axes = [DVec3::X, DVec3::Y, DVec3::Z];
        let planes = axes.into_iter().flat_map(|n| [n, -n]);
        intersection(planes.map(|n| Plane::new(n, n).into()).collect())
    }

    fn ball(radius: f64) -> Csg {
        tree(CsgNode::leaf(Sphere::new(DVec3::ZERO, radius), 0))
    }

    #[test]
    fn a_ball_contains_the_cube_that_touches_it_with_its_corners() {
        let cube = tree(cube());
        assert!(cube.lies_within(&ball(3.0_f64.sqrt())));
        assert!(!cube.lies_within(&ball(1.7)));
    }

    #[test]
    fn what_is_left_of_a_ring_lies_in_a_box_around_it() {
        let ring = Torus::try_new(DVec3::ZERO, DVec3::Y, 0.8, 0.1).expect("a torus");
        let half = |normal: DVec3| Shape::from(Plane::new(DVec3::ZERO, normal));
        let leaves = [ring.into(), half(DVec3::X), half(DVec3::Z)];
        let leaves = leaves.map(|shape: Shape| CsgNode::leaf(shape, 0));
        let quarter = tree(CsgNode::difference(leaves));
        let within = |low: f64| {
            let low = DVec3::new(low, -0.2, low);
            let around = Cuboid::new(low, DVec3::new(1.0, 0.2, 1.0));
            quarter.lies_within(&tree(CsgNode::leaf(around, 0)))
        };
        assert!(within(-0.02) && !within(0.02));
    }

    #[test]
    fn a_ball_that_is_too_small_by_little_does_not_contain_the_cube() {
        assert!(!tree(cube()).lies_within(&ball(3.0_f64.sqrt() - 1e-6)));
    }

    #[test]
    fn corners_that_are_cut_off_do_not_matter() {
        let cut = CsgNode::Intersection(
            vec![cube(), CsgNode::leaf(Sphere::new(DVec3::ZERO, 1.2), 0)].into(),
        );
        assert!(tree(cut).lies_within(&ball(1.2)));
    }

    #[test]
    fn all_parts_of_a_union_matter_and_only_the_first_of_a_difference() {
        let long = || CsgNode::leaf(Cylinder::new(-DVec3::Y * 4.0, DVec3::Y * 4.0, 0.1), 0);
        let both = |node: fn(Vec<CsgNode>) -> CsgNode| tree(node(vec![cube(), long()]));
        assert!(!both(|parts| CsgNode::Union(parts.into())).lies_within(&ball(2.0)));
        assert!(both(|parts| CsgNode::Difference(parts.into())).lies_within(&ball(2.0)));
    }

    #[test]
    fn nothing_contains_the_endless() {
        let node = CsgNode::leaf(Plane::new(DVec3::ZERO, DVec3::Y), 0);
        assert!(!tree(node).lies_within(&ball(1e9)));
    }
}
