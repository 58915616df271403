//! Compares the trees of both programs by counting instead of timing: Embree's own builder makes a tree as it does for its
//! triangles, and the same simple traversal visits that tree and ours.

use super::embree::{Device, Quality};
use super::meshes::Mesh;
use super::rays::{Batch, Segment, make};
use super::wide_tree::{Child, Node, Tree};
use super::{Plan, Table, mean};
use anyhow::{Context, Result, bail};
use strahl::accel::{Accelerator, AnyAccelerator, BLOCK, Content};
use strahl::math::DVec3;
use strahl::prelude::*;
use strahl::tracing::Prepared;

/// The cost of a node and of a block of four triangles, in instructions of our kernels (see "Against Embree" in the book).
pub(super) const COST: [f64; 2] = [41.0, 76.0];

impl Tree {
    /// The tree that strahl built for a scene of one mesh.
    fn ours(scene: &RenderScene) -> Result<Self> {
        let AnyAccelerator::Bvh8(bvh) = scene.accelerator() else {
            bail!("only trees of the accelerator bvh can be compared");
        };
        let mut tree = Self::default();
        let (_, root) = bvh.root().context("the scene is empty")?;
        tree.root = tree.child(root);
        for number in 0..bvh.nodes() as u32 {
            let mut node = Node::default();
            for (place, (bounds, content)) in bvh.children(number).enumerate() {
                let corners = [bounds.min, bounds.max].map(|p| p.as_vec3().to_array());
                node.set_box(place, corners);
                node.set_child(place, tree.child(content));
            }
            tree.nodes.push(node);
        }
        Ok(tree)
    }

    fn child(&mut self, content: Content<'_>) -> Child {
        match content {
            Content::Node(number) => Child::Node(number as usize),
            Content::Leaf(ids) => self.leaf(ids.iter().copied()),
        }
    }
}

/// The number of nodes and blocks visited by all rays.
#[derive(Clone, Copy, Default)]
struct Cost {
    nodes: u64,
    blocks: u64,
    hits: u64,
}

/// The state of a traversal.
struct Walk<'t> {
    tree: &'t Tree,
    corners: &'t [[DVec3; 3]],
    cost: Cost,
    /// The stack: children still to be visited, and where the ray enters them.
    waiting: Vec<(f32, Child)>,
}

impl Walk<'_> {
    /// Looks for the closest hit, or for any, in the order in which the ray enters the boxes.
    fn walk(&mut self, ray: &Segment, any: bool) {
        let inverse = ray.direction.map(|d| 1.0 / d);
        let mut far = ray.far;
        self.waiting.clear();
        self.waiting.push((ray.near, self.tree.root));
        let mut met = false;
        while let Some((near, child)) = self.waiting.pop() {
            if near > far {
                continue;
            }
            match child {
                Child::Node(number) => {
                    self.cost.nodes += 1;
                    self.look_at(&self.tree.nodes[number], ray, inverse, far);
                }
                Child::Leaf(first, count) => {
                    for block in self.tree.ids[first..first + count].chunks(BLOCK) {
                        self.cost.blocks += 1;
                        for id in block {
                            if let Some(t) = distance(ray, &self.corners[*id as usize], far) {
                                met = true;
                                far = t;
                            }
                        }
                        if met && any {
                            self.cost.hits += 1;
                            return;
                        }
                    }
                }
            }
        }
        self.cost.hits += u64::from(met);
    }

    /// Pushes the children whose boxes the ray hits, the nearest last.
    #[expect(
        clippy::needless_range_loop,
        reason = "the axis indexes several arrays"
    )]
    fn look_at(&mut self, node: &Node, ray: &Segment, inverse: [f32; 3], far: f32) {
        let first = self.waiting.len();
        for place in 0..node.count {
            let (mut enter, mut leave) = (ray.near, far);
            for axis in 0..3 {
                let t = [0, 1].map(|side| {
                    let plane = node.planes[2 * axis + side][place];
                    (plane - ray.origin[axis]) * inverse[axis]
                });
                // A NaN, which comes from a ray that lies in a plane, leaves the range as it is.
                enter = t[0].min(t[1]).max(enter);
                leave = t[0].max(t[1]).min(leave);
            }
            // Rounding must not lose the boxes of flat objects.
            if enter <= leave * 1.000_001 {
                self.waiting.push((enter, node.children[place]));
            }
        }
        self.waiting[first..].sort_by(|a, b| b.0.total_cmp(&a.0));
    }
}

/// The distance at which a ray hits a triangle, if that is before `far`.
///
/// T. Möller, B. Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection" (1997).
fn distance(ray: &Segment, [a, b, c]: &[DVec3; 3], far: f32) -> Option<f32> {
    let vector = |v: [f32; 3]| DVec3::from(v.map(f64::from));
    let (origin, direction) = (vector(ray.origin), vector(ray.direction));
    let (ab, ac) = (*b - *a, *c - *a);
    let p = direction.cross(ac);
    let determinant = ab.dot(p);
    let from_a = origin - *a;
    let u = from_a.dot(p) / determinant;
    let q = from_a.cross(ab);
    let v = direction.dot(q) / determinant;
    let t = (ac.dot(q) / determinant) as f32;
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > ray.near && t < far).then_some(t)
}

impl Cost {
    /// The cost of all rays of a batch.
    fn of(tree: &Tree, corners: &[[DVec3; 3]], batch: &Batch) -> Self {
        let mut walk = Walk {
            tree,
            corners,
            cost: Self::default(),
            waiting: vec![],
        };
        for ray in &batch.segments {
            walk.walk(ray, batch.kind.any());
        }
        walk.cost
    }

    /// Nodes and blocks of each ray.
    fn per_ray(&self, batch: &Batch) -> String {
        let rays = batch.segments.len() as f64;
        let [nodes, blocks] = [self.nodes, self.blocks].map(|n| n as f64 / rays);
        format!("{nodes:.2} | {blocks:.2}")
    }

    /// The total cost in instructions.
    fn total(&self) -> f64 {
        COST[0] * self.nodes as f64 + COST[1] * self.blocks as f64
    }
}

/// Pairs of trees to compare: name, settings of strahl, and quality of Embree's build.
const TREES: [(&str, &str, Quality); 3] = [
    ("default", "bvh", Quality::Medium),
    ("high", "bvh:build=high", Quality::High),
    ("fast", "bvh:build=fast", Quality::Medium),
];

/// Counts the nodes and blocks that rays visit in the trees of both programs; a row for each builder and kind of ray.
pub(super) fn compare(
    device: &Device<'_>,
    mesh: &Mesh,
    plan: &Plan<'_>,
    table: &mut Table,
) -> Result<()> {
    let vertex = |i: u32| DVec3::from(mesh.positions[i as usize].map(f64::from));
    let corners: Vec<[DVec3; 3]> = mesh.indices.iter().map(|t| t.map(vertex)).collect();
    let prepared = Prepared::new(&mesh.scene()?)?;
    let mut batches = vec![];
    for (builder, accelerator, quality) in TREES {
        let scene = prepared.clone().build(accelerator.parse()?);
        let ours = Tree::ours(&scene)?;
        let theirs = device.tree(&mesh.positions, &mesh.indices, quality)?;
        if batches.is_empty() {
            batches = make(&scene, mesh.view, plan.side);
            batches.retain(|batch| !batch.kind.in_tiles());
        }
        let mut ratios = vec![];
        for batch in &batches {
            let [ours, theirs] = [&ours, &theirs].map(|tree| Cost::of(tree, &corners, batch));
            if ours.hits != theirs.hits {
                bail!(
                    "{}: {} rays hit in our tree, {} in Embree's",
                    mesh.name,
                    ours.hits,
                    theirs.hits
                );
            }
            let ratio = ours.total() / theirs.total();
            ratios.push(ratio);
            let [a, b] = [ours, theirs].map(|cost| cost.per_ray(batch));
            let kind = batch.kind.name();
            table.line(format!(
                "| {} | {builder} | {kind} | {a} | {b} | {ratio:.3} |",
                mesh.name
            ));
        }
        let all = mean(ratios.iter().copied()).unwrap_or(f64::NAN);
        table.line(format!(
            "| {} | {builder} | mean | | | | | {all:.3} |",
            mesh.name
        ));
    }
    Ok(())
}
