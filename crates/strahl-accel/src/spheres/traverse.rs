use super::{Node, Spheres, Tree, WIDTH};
use crate::cull::rounded;
use crate::list::visit_all;
use crate::moved::{FAR, Moved};
use crate::{Accelerator, Place, Step, TraversalStats, Visitor};
use strahl_math::{DVec3, Interval, Ray};

impl Accelerator for Spheres {
    fn name(&self) -> &'static str {
        "spheres"
    }

    #[inline]
    fn traverse<V: Visitor>(
        &self,
        ray: &Ray,
        range: Interval,
        visitor: &mut V,
        stats: &mut TraversalStats,
    ) {
        let t_max = visit_all(self.unbounded.ids(), range.max, visitor, stats);
        if t_max > f64::NEG_INFINITY
            && let Some(tree) = &self.tree
            && let Some(moved) = Moved::new(ray, range, &tree.bounds)
        {
            let ray = SphereRay::new(&moved, tree);
            let mut walk = Walk {
                tree,
                far: ray.upper(t_max),
                ray,
                moved: &moved,
                t_max,
                visitor,
                stats,
            };
            walk.node(0, 0);
        }
    }

    fn bytes(&self) -> usize {
        let tree = self.tree.as_ref().map_or(0, |t| {
            size_of_val(t.nodes.as_slice()) + size_of_val(t.ids.as_slice())
        });
        tree + self.unbounded.bytes()
    }

    fn nodes(&self) -> usize {
        self.tree.as_ref().map_or(0, |t| t.nodes.len())
    }

    fn references(&self) -> usize {
        self.tree.as_ref().map_or(0, |t| t.ids.len()) + self.unbounded.references()
    }
}

/// A ray in f32, in the tree's units, its direction of length 1 (almost): distances instead of parameters.
///
/// # Why no sphere is lost
/// With `f = c - o`, `b = f·d` and `p = f - b d` the ray meets the sphere if `|p|² <= r²` (Haines), between `b ± √(r² - |p|²)`.
/// Let u = 2⁻²⁴. Rounding the origin and the difference moves f by at most `u(|o| + |f|)`, rounding d to f32, the
/// product, the sum and the difference move b by `6u|f|` and p by `9u|f|` more, the squares are worth another `2u(|f| + r)`;
/// lengths are at most √3 times the largest coordinate, B + |o|. If the radius grows by at least what p and b may have moved,
/// `√(r² - |p|²)` grows by at least what b may have moved, so the near end is never too late and the far end never too
/// early. Together with the 8u√3 (B + |o|) that hits may lie outside of their primitives this is below 48u(B + |o|); 64u are taken.
#[derive(Clone, Copy)]
struct SphereRay {
    origin: [f32; 3],
    direction: [f32; 3],
    /// The increase of radii.
    pad: f32,
    near: f32,
    /// Factor from the moved ray's parameter to distances.
    length: f64,
    moved: Moved,
}

/// The factor 64u of the error bound.
const PAD: f64 = 64.0 / (1u64 << 24) as f64;

impl SphereRay {
    fn new(moved: &Moved, tree: &Tree) -> Self {
        let inverse = 1.0 / tree.unit;
        let length = moved.direction.length();
        let to_f32 = |v: DVec3| v.to_array().map(|x| x as f32);
        let max_abs = tree.bounds.max_abs();
        // The origin is within FAR times B, or was moved to the structure.
        let pad = (PAD * (1.0 + FAR) * max_abs + 4.0 * moved.margin) * inverse;
        let length = length * inverse;
        let (near, error) = rounded(moved.range.min * length);
        Self {
            origin: to_f32(moved.origin * inverse),
            direction: to_f32(moved.direction / (length * tree.unit)),
            pad: pad as f32,
            near: near - error,
            length,
            moved: *moved,
        }
    }

    /// An upper end of the range as a distance, rounded up.
    fn upper(&self, t: f64) -> f32 {
        let (far, error) = rounded(self.moved.upper(t) * self.length);
        far + error
    }

    /// The distances at which the ray enters eight spheres, and the spheres that it may meet before `far`.
    #[inline(always)]
    fn enter(&self, node: &Node, far: f32) -> ([f32; WIDTH], [bool; WIDTH]) {
        let (mut near, mut meets) = ([0.0; WIDTH], [false; WIDTH]);
        let ([ox, oy, oz], [dx, dy, dz]) = (self.origin, self.direction);
        for i in 0..WIDTH {
            let [x, y, z] = [
                node.center[0][i] - ox,
                node.center[1][i] - oy,
                node.center[2][i] - oz,
            ];
            let middle = x * dx + y * dy + z * dz;
            let [px, py, pz] = [x - middle * dx, y - middle * dy, z - middle * dz];
            let radius = node.radius[i] + self.pad;
            let rest = radius * radius - (px * px + py * py + pz * pz);
            let half = if rest > 0.0 { rest } else { 0.0 }.sqrt();
            near[i] = middle - half;
            meets[i] = (rest >= 0.0) & (near[i] <= far) & (middle + half >= self.near);
        }
        (near, meets)
    }
}

struct Walk<'w, V> {
    tree: &'w Tree,
    ray: SphereRay,
    moved: &'w Moved,
    t_max: f64,
    /// `t_max` as a distance.
    far: f32,
    visitor: &'w mut V,
    stats: &'w mut TraversalStats,
}

impl<V: Visitor> Walk<'_, V> {
    /// Traverses a subtree, the nearer spheres first; returns whether to continue. Nodes are at most as deep as the binary
    /// tree.
    fn node(&mut self, number: u32, level: u32) -> bool {
        self.stats.node_visits += 1;
        let node = &self.tree.nodes[number as usize];
        let (near, meets) = self.ray.enter(node, self.far);
        let (mut order, mut count) = ([(0.0f32, 0usize); WIDTH], 0);
        for lane in 0..WIDTH {
            if meets[lane] {
                let mut place = count;
                while place > 0 && order[place - 1].0 > near[lane] {
                    order[place] = order[place - 1];
                    place -= 1;
                }
                order[place] = (near[lane], lane);
                count += 1;
            }
        }
        for (near, lane) in &order[..count] {
            // A sphere that begins exactly at the closest hit is still visited: ids decide ties.
            if *near > self.far {
                break;
            }
            if V::WATCHES {
                self.report(node, *lane, *near, level);
            }
            let (first, count) = (node.first[*lane], node.count[*lane]);
            if count == 0 {
                if !self.node(first, level + 1) {
                    return false;
                }
                continue;
            }
            let ids = &self.tree.ids[first as usize..(first + count) as usize];
            let closest = visit_all(ids, self.t_max, self.visitor, self.stats);
            if closest < self.t_max {
                if closest == f64::NEG_INFINITY {
                    return false;
                }
                self.t_max = closest;
                self.far = self.ray.upper(closest);
            }
        }
        true
    }

    fn report(&mut self, node: &Node, lane: usize, near: f32, level: u32) {
        let unit = self.tree.unit;
        let [x, y, z] = [0, 1, 2].map(|axis| f64::from(node.center[axis][lane]) * unit);
        let (center, radius) = (DVec3::new(x, y, z), f64::from(node.radius[lane]) * unit);
        let original = |distance: f32| self.moved.original(f64::from(distance) / self.ray.length);
        let near = if near > self.ray.near {
            near
        } else {
            self.ray.near
        };
        self.visitor.step(Step {
            place: match node.count[lane] {
                0 => Place::Sphere(center, radius),
                _ => Place::LeafSphere(center, radius),
            },
            level,
            near: original(near),
            far: f64::INFINITY,
            exit: None,
        });
    }
}
