use super::compiled::{Bounds, Csg};
use super::half_spaces::{HalfSpace, HalfSpaces};
use super::leaf::{Leaf, Next, Placement};
use super::node::{Kind, NO_PARENT, Node};
use super::sweep::Rule;
use super::tighten::{Region, tightened};
use super::tree::{CsgNode, Operands};
use crate::{GeometryError, Primitive, Shape};
use std::cmp::Ordering;
use std::sync::Arc;
use strahl_accel::Bvh2;
use strahl_math::{Aabb, Transform};

/// Up to this many operands the boxes are tested one by one.
const LIST_MAX: usize = 8;

/// So many operands at most are looked at to make the box around an intersection smaller.
const MOST_REGIONS: usize = 16;

impl Csg {
    /// Compiles a tree.
    ///
    /// # Errors
    /// An operation without operands, a leaf with invalid parameters, more than 2³² elements.
    pub fn try_new(tree: CsgNode) -> Result<Self, GeometryError> {
        let mut compiler = Compiler::default();
        compiler.read(tree)?;
        Ok(compiler.finish())
    }
}

/// The context of a node: what the nodes above it determine.
#[derive(Clone, Copy)]
struct Context {
    /// The compiled operation it is an operand of; `None` at the root.
    parent: Option<u32>,
    /// Whether its complement is taken.
    negative: bool,
    /// Whether its surface can be seen.
    visible: bool,
    /// Whether inner surfaces of unions are kept.
    keeps_inner: bool,
    /// From its space to the tree's.
    map: Option<Transform>,
}

impl Context {
    fn inverted(self) -> Self {
        Self {
            negative: !self.negative,
            keeps_inner: false,
            ..self
        }
    }

    fn clipping(self) -> Self {
        Self {
            visible: false,
            negative: false,
            keeps_inner: false,
            ..self
        }
    }

    fn mapped(self, inner: &Transform) -> Self {
        let map = self.map.map_or(*inner, |outer| inner.then(&outer));
        Self {
            map: Some(map),
            ..self
        }
    }

    /// The operation itself or, for a complement, its counterpart by De Morgan's laws.
    fn rule(self, rule: Rule) -> Rule {
        match (rule, self.negative) {
            (Rule::Intersection, true) => Rule::Merge,
            (Rule::Intersection, false) | (_, true) => Rule::Intersection,
            (Rule::Union, false) if self.keeps_inner => Rule::Union,
            (_, false) => Rule::Merge,
        }
    }
}

/// A node under construction.
struct Proto {
    kind: Kind,
    parent: u32,
    operands: Vec<u32>,
}

/// The passes from description to compiled tree. None recurses: trees may be deeper than the stack.
#[derive(Default)]
struct Compiler {
    /// Parents come before their operands.
    nodes: Vec<Proto>,
    leaves: Vec<Leaf>,
    /// The different bounds of leaves.
    bounds: Vec<Bounds>,
    elements: u32,
}

impl Compiler {
    /// First pass: numbers the leaves in the order of the description, pushes inversions and maps down to them, merges nested
    /// operations of one kind and drops operations of one operand.
    fn read(&mut self, root: CsgNode) -> Result<(), GeometryError> {
        let context = Context {
            parent: None,
            negative: false,
            visible: true,
            keeps_inner: true,
            map: None,
        };
        let mut waiting = vec![(root, context)];
        while let Some((node, context)) = waiting.pop() {
            let (what, rule, operands) = match node {
                CsgNode::Leaf {
                    shape,
                    transform,
                    tag,
                } => {
                    let context = transform.map_or(context, |map| context.mapped(&map));
                    self.add_leaf(shape, tag, context)?;
                    continue;
                }
                CsgNode::Union(operands) => ("union", Rule::Union, operands),
                CsgNode::Merge(operands) => ("merge", Rule::Merge, operands),
                CsgNode::Intersection(operands) => ("intersection", Rule::Intersection, operands),
                CsgNode::Difference(operands) => {
                    let rest = |c: Context| c.inverted();
                    let rule = context.rule(Rule::Intersection);
                    self.expand("difference", rule, operands, context, rest, &mut waiting)?;
                    continue;
                }
                CsgNode::Clip(operands) => {
                    // As in POV-Ray (measured) the complement is clipped by the same solids.
                    let rest = |c: Context| c.clipping();
                    self.expand(
                        "clipped object",
                        Rule::Intersection,
                        operands,
                        context,
                        rest,
                        &mut waiting,
                    )?;
                    continue;
                }
                CsgNode::Inverse(operands) => {
                    let context = context.inverted();
                    let rule = context.rule(Rule::Merge);
                    self.expand("inverse", rule, operands, context, |c| c, &mut waiting)?;
                    continue;
                }
                CsgNode::Transformed {
                    operands,
                    transform,
                } => {
                    let context = context.mapped(&transform);
                    let rule = context.rule(Rule::Union);
                    self.expand("moved group", rule, operands, context, |c| c, &mut waiting)?;
                    continue;
                }
            };
            self.expand(
                what,
                context.rule(rule),
                operands,
                context,
                |c| c,
                &mut waiting,
            )?;
        }
        Ok(())
    }

    /// Pushes an operation's operands on the list; `rest` changes the context of all but the first.
    fn expand(
        &mut self,
        what: &'static str,
        rule: Rule,
        operands: Operands,
        context: Context,
        rest: impl Fn(Context) -> Context,
        waiting: &mut Vec<(CsgNode, Context)>,
    ) -> Result<(), GeometryError> {
        let operands = operands.into_vec();
        if operands.is_empty() {
            return Err(GeometryError::Degenerate {
                what,
                why: "it has no operands; give at least one",
            });
        }
        let kind = Kind::Operation(rule);
        let continues = context
            .parent
            .and_then(|parent| self.nodes.get(parent as usize))
            .is_some_and(|parent| parent.kind == kind);
        let parent = if continues || operands.len() == 1 {
            context.parent
        } else {
            Some(self.add_node(kind, context.parent)?)
        };
        let context = Context { parent, ..context };
        // The list is worked off from its end.
        let numbered = operands.into_iter().enumerate().rev();
        waiting
            .extend(numbered.map(|(i, node)| (node, if i == 0 { context } else { rest(context) })));
        Ok(())
    }

    fn add_node(&mut self, kind: Kind, parent: Option<u32>) -> Result<u32, GeometryError> {
        let index = count(self.nodes.len(), "number of nodes of the CSG tree")?;
        self.nodes.push(Proto {
            kind,
            parent: parent.unwrap_or(NO_PARENT),
            operands: Vec::new(),
        });
        if let Some(parent) = parent.and_then(|parent| self.nodes.get_mut(parent as usize)) {
            parent.operands.push(index);
        }
        Ok(index)
    }

    fn add_leaf(&mut self, shape: Shape, tag: u32, context: Context) -> Result<(), GeometryError> {
        shape.validate()?;
        let (shape, seen_through) = self.without_bounds(shape, context.map.as_ref());
        let leaf = count(self.leaves.len(), "number of leaves of the CSG tree")?;
        self.add_node(Kind::Leaf(leaf), context.parent)?;
        let baked = context
            .map
            .filter(|_| !is_large(&shape))
            .and_then(|map| shape.baked(&map));
        let map = if baked.is_some() { None } else { context.map };
        let shape = baked.unwrap_or(shape);
        let solid = shape.as_solid();
        // A shape without an inside has no complement: no point is inside of it.
        let negative = context.negative && solid.is_some();
        let bounds = solid.map_or_else(|| shape.bounds(), |solid| solid.inside_bounds());
        let bounds = map.map_or(bounds, |map| map.bounds_to_world(&bounds));
        let first_element = self.elements;
        self.elements = first_element.checked_add(shape.elements()).ok_or({
            GeometryError::OutOfRange {
                what: "number of surface elements of the CSG tree",
                expected: "less than 2^32",
                found: f64::from(first_element) + f64::from(shape.elements()),
            }
        })?;
        self.leaves.push(Leaf {
            shape,
            placement: map.map(|map| Box::new(Placement::new(map))),
            tag,
            first_element,
            negative,
            visible: context.visible,
            seen_through,
            bounds,
            if_inside: Next::Answer(!negative),
            if_outside: Next::Answer(negative),
        });
        Ok(())
    }

    /// A leaf's shape without its bounds, and their number in the tree: so that the shape is searched as fast as without bounds. `map` is from
    /// the shape's space to the tree's.
    fn without_bounds(&mut self, shape: Shape, map: Option<&Transform>) -> (Shape, Option<u32>) {
        let Shape::Bounded(bounded) = &shape else {
            return (shape, None);
        };
        // Otherwise the shape goes on asking by itself.
        let Some(bounds) = bounded.bounds_in(map) else {
            return (shape, None);
        };
        let same = |known: &Bounds| {
            let mut pairs = known.iter().zip(bounds);
            known.len() == bounds.len() && pairs.all(|(a, b)| Arc::ptr_eq(a, b))
        };
        let number = self.bounds.iter().position(same).unwrap_or_else(|| {
            self.bounds.push(bounds.into());
            self.bounds.len() - 1
        });
        (bounded.shape().clone(), Some(number as u32))
    }

    /// The other passes.
    fn finish(mut self) -> Csg {
        self.compile_jumps();
        let boxes = self.boxes();
        let mut nodes = Vec::with_capacity(self.nodes.len());
        let mut operands = Vec::new();
        for (proto, (bounds, far)) in self.nodes.iter().zip(&boxes) {
            let first = operands.len();
            let (mut core, mut half_spaces) = (0, None);
            if let Kind::Operation(rule) = proto.kind {
                let far_of = |operand: &u32| boxes.get(*operand as usize).is_some_and(|b| b.1);
                let is_core = |operand: &u32| far_of(operand) != rule.neutral();
                operands.extend(proto.operands.iter().copied().filter(is_core));
                core = operands.len() - first;
                // An intersection is finished as soon as nothing is left, so start with what is intersected in a few operations, and with
                // the smallest boxes.
                if let Some(core) = operands.get_mut(first..) {
                    let area = |i: &u32| boxes.get(*i as usize).map_or(0.0, |b| b.0.half_area());
                    core.sort_by(|a, b| area(a).partial_cmp(&area(b)).unwrap_or(Ordering::Equal));
                    core.sort_by_key(|i| !self.has_stays(*i));
                    if rule == Rule::Intersection {
                        core.sort_by_key(|i| self.half_space(*i).is_some());
                        half_spaces = self.half_spaces(core).map(Box::new);
                    }
                }
                operands.extend(proto.operands.iter().copied().filter(|o| !is_core(o)));
            }
            let rest = operands.get(first + core..).unwrap_or_default();
            let hierarchy = (rest.len() > LIST_MAX).then(|| {
                let bounds = rest.iter().filter_map(|i| boxes.get(*i as usize));
                Box::new(Bvh2::build(&bounds.map(|b| b.0).collect::<Vec<_>>()))
            });
            nodes.push(Node {
                kind: proto.kind,
                parent: proto.parent,
                quick: match proto.kind {
                    Kind::Leaf(leaf) => self.leaves.get(leaf as usize).is_some_and(Leaf::is_quick),
                    Kind::Operation(_) => false,
                },
                bounds: *bounds,
                far: *far,
                first: first as u32,
                core: (first + core) as u32,
                end: operands.len() as u32,
                half_spaces,
                hierarchy,
            });
        }
        let closed = self.leaves.iter().all(|leaf| leaf.solid().is_some());
        Csg::from_parts(
            nodes,
            operands,
            (self.leaves, self.bounds),
            self.elements,
            closed,
        )
    }

    /// Whether the node is a leaf that is intersected in a few operations.
    fn has_stays(&self, node: u32) -> bool {
        let kind = self.nodes.get(node as usize).map(|node| node.kind);
        let Some(Kind::Leaf(leaf)) = kind else {
            return false;
        };
        let leaf = self.leaves.get(leaf as usize);
        leaf.is_some_and(Leaf::has_stays)
    }

    /// The node as a half-space, if it is one.
    fn half_space(&self, node: u32) -> Option<HalfSpace> {
        let Kind::Leaf(index) = self.nodes.get(node as usize)?.kind else {
            return None;
        };
        let leaf = self.leaves.get(index as usize)?;
        match &leaf.shape {
            Shape::Plane(plane) if leaf.placement.is_none() && !leaf.negative => Some(HalfSpace {
                point: plane.point(),
                normal: plane.normal(),
                leaf: index,
                element: leaf.first_element,
                visible: leaf.visible,
            }),
            _ => None,
        }
    }

    /// What the nodes leave of space, if several of them together may leave less than a box around one of them.
    fn regions(&self, nodes: &[u32]) -> Vec<Region<'_>> {
        let leaf = |node: &u32| match self.nodes.get(*node as usize)?.kind {
            Kind::Leaf(index) => self.leaves.get(index as usize),
            Kind::Operation(_) => None,
        };
        let is_curved = |leaf: &Leaf| !matches!(leaf.shape, Shape::Plane(_));
        if nodes.len() < 2 || !nodes.iter().filter_map(leaf).any(is_curved) {
            return vec![];
        }
        let regions = nodes.iter().filter_map(|node| Region::of(leaf(node)?));
        regions.take(MOST_REGIONS).collect()
    }

    /// The half-spaces among the nodes.
    fn half_spaces(&self, nodes: &[u32]) -> Option<HalfSpaces> {
        let all = nodes.iter().filter_map(|node| self.half_space(*node));
        HalfSpaces::new(all.collect())
    }

    /// For each node a box that contains all its surfaces, and whether the space outside of that box is inside of the node.
    fn boxes(&self) -> Vec<(Aabb, bool)> {
        let mut boxes = vec![(Aabb::EMPTY, false); self.nodes.len()];
        for (index, node) in self.nodes.iter().enumerate().rev() {
            let operands = || node.operands.iter().filter_map(|i| boxes.get(*i as usize));
            let result = match node.kind {
                Kind::Leaf(leaf) => self
                    .leaves
                    .get(leaf as usize)
                    .map_or((Aabb::EMPTY, false), |leaf| (leaf.bounds, leaf.negative)),
                Kind::Operation(rule) => {
                    // If the outside of an operand decides the result (false under intersections, true under unions), nothing
                    // changes outside of its box.
                    let mut decisive = operands()
                        .filter(|(_, far)| *far != rule.neutral())
                        .peekable();
                    let far = rule.neutral() != decisive.peek().is_some();
                    let bounds = if decisive.peek().is_some() && rule != Rule::Union {
                        let gem = match rule {
                            Rule::Intersection => self.half_spaces(&node.operands),
                            _ => None,
                        };
                        let gem = gem.and_then(|planes| planes.bounds());
                        let common = decisive
                            .fold(gem.unwrap_or(Aabb::EVERYTHING), |b, (other, _)| {
                                b.intersection(other)
                            });
                        match rule {
                            Rule::Intersection => tightened(&common, &self.regions(&node.operands)),
                            _ => common,
                        }
                    } else {
                        operands().fold(Aabb::EMPTY, |b, (other, _)| b.union(other))
                    };
                    (bounds, far)
                }
            };
            if let Some(place) = boxes.get_mut(index) {
                *place = result;
            }
        }
        boxes
    }

    /// Short-circuit evaluation of `contains` as jumps from leaf to leaf: within `a or b`, "inside of a" goes on where "inside of b"
    /// would, "outside of a" goes to b.
    fn compile_jumps(&mut self) {
        // The first leaf of each node. Parents come before their operands, so go through the nodes backwards.
        let mut entry = vec![Next::Answer(false); self.nodes.len()];
        for (index, node) in self.nodes.iter().enumerate().rev() {
            let first = match node.kind {
                Kind::Leaf(leaf) => Some(Next::Leaf(leaf)),
                Kind::Operation(_) => node
                    .operands
                    .first()
                    .and_then(|operand| entry.get(*operand as usize))
                    .copied(),
            };
            if let (Some(place), Some(first)) = (entry.get_mut(index), first) {
                *place = first;
            }
        }
        let mut jumps = vec![(Next::Answer(true), Next::Answer(false)); self.nodes.len()];
        for (index, node) in self.nodes.iter().enumerate() {
            let Some(&(inside, outside)) = jumps.get(index) else {
                continue;
            };
            match node.kind {
                Kind::Leaf(leaf) => {
                    if let Some(leaf) = self.leaves.get_mut(leaf as usize) {
                        (leaf.if_inside, leaf.if_outside) = (inside, outside);
                    }
                }
                Kind::Operation(rule) => {
                    let followers = node.operands.iter().skip(1).map(Some).chain([None]);
                    for (operand, follower) in node.operands.iter().zip(followers) {
                        let next = follower.and_then(|f| entry.get(*f as usize)).copied();
                        let jump = match rule {
                            Rule::Intersection => (next.unwrap_or(inside), outside),
                            Rule::Union | Rule::Merge => (inside, next.unwrap_or(outside)),
                        };
                        if let Some(place) = jumps.get_mut(*operand as usize) {
                            *place = jump;
                        }
                    }
                }
            }
        }
    }
}

/// A count as a 32-bit index.
fn count(n: usize, what: &'static str) -> Result<u32, GeometryError> {
    u32::try_from(n).map_err(|_| GeometryError::OutOfRange {
        what,
        expected: "less than 2^32",
        found: n as f64,
    })
}

/// Whether a shape is a mesh that is better kept in its own space than copied: objects may share it, and with it the tree over its triangles.
fn is_large(shape: &Shape) -> bool {
    /// A copy of as many triangles takes less than a tenth of a millisecond.
    const COPIED: u32 = 1000;
    let mesh = match shape {
        Shape::TriangleMesh(mesh) => mesh,
        Shape::Brep(brep) => brep.mesh(),
        _ => return false,
    };
    mesh.triangle_count() > COPIED
}
