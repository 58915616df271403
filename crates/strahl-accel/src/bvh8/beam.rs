use super::node::{Child, WIDTH, WideNode};
use super::nodes::Nodes;
use super::{Bvh8, Tree};
use crate::beam::{Beam, CullPlane};
use crate::bvh::MAX_DEPTH;
use arrayvec::ArrayVec;
use strahl_simd::{Isa, dispatch};

impl Bvh8 {
    /// Whether a beam certainly meets no leaf.
    pub(super) fn beam_misses(&self, beam: &Beam) -> bool {
        let Some(tree) = &self.tree else {
            return self.apart.ids().is_empty();
        };
        self.apart.ids().is_empty()
            && (beam.misses(tree.bounds.bounds())
                || match &tree.nodes {
                    Nodes::Full(nodes) => {
                        dispatch!(self.simd, isa => !tree.meets(isa, nodes, beam))
                    }
                    Nodes::Compact(nodes) => {
                        dispatch!(self.simd, isa => !tree.meets(isa, nodes, beam))
                    }
                })
    }
}

/// A plane of a beam in vectors.
struct Side<I: Isa> {
    normal: [I::F32x8; 3],
    offset: I::F32x8,
    /// Per axis, whether the corner of a box that is farthest along the normal is on the lower or the upper side.
    sides: [usize; 3],
}

impl<I: Isa> Side<I> {
    #[inline(always)]
    fn new(isa: I, plane: &CullPlane) -> Self {
        let [x, y, z] = plane.normal;
        Self {
            // The sign changes with each difference.
            normal: [isa.splat_f32(x), isa.splat_f32(-y), isa.splat_f32(z)],
            offset: isa.splat_f32(plane.offset),
            sides: [
                usize::from(x > 0.0),
                usize::from(y > 0.0),
                usize::from(z > 0.0),
            ],
        }
    }

    /// The children with a corner on the inner side. (Empty boxes have none.)
    #[inline(always)]
    fn inside(&self, isa: I, node: &impl WideNode) -> u32 {
        let x = node.planes(isa, 0, self.sides[0]);
        let y = node.planes(isa, 1, self.sides[1]);
        let z = node.planes(isa, 2, self.sides[2]);
        let rest = isa.mul_sub(z, self.normal[2], self.offset);
        let rest = isa.mul_sub(y, self.normal[1], rest);
        isa.le_f32(isa.splat_f32(0.0), isa.mul_sub(x, self.normal[0], rest))
    }
}

impl Tree {
    /// Whether a beam may meet a leaf.
    #[inline(always)]
    fn meets<I: Isa, N: WideNode>(&self, isa: I, nodes: &[N], beam: &Beam) -> bool {
        let [a, b, c, d] = beam.planes(self.bounds.max_abs());
        let (a, b) = (Side::new(isa, &a), Side::new(isa, &b));
        let (c, d) = (Side::new(isa, &c), Side::new(isa, &d));
        let mut waiting = ArrayVec::<Child, { MAX_DEPTH * (WIDTH - 1) + 1 }>::new();
        waiting.push(self.root);
        while let Some(child) = waiting.pop() {
            if child.is_leaf() {
                return true;
            }
            let node = &nodes[child.node()];
            let mut met = node.used()
                & a.inside(isa, node)
                & b.inside(isa, node)
                & c.inside(isa, node)
                & d.inside(isa, node);
            while met != 0 {
                waiting.push(node.child(met.trailing_zeros() as usize));
                met &= met - 1;
            }
        }
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Accelerator, TraversalStats, Visitor};
    use strahl_math::{Aabb, DVec3, Interval, Ray};
    use strahl_simd::Simd;

    /// Whether any box was met.
    struct Met(bool);

    impl Visitor for Met {
        fn visit(&mut self, _: u32, t_max: f64) -> f64 {
            self.0 = true;
            t_max
        }
    }

    #[test]
    fn no_ray_of_a_beam_that_misses_meets_a_leaf() {
        let mut state = 3u64;
        let mut signed = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        };
        let mut point = || DVec3::new(signed(), signed(), signed());
        let boxes: Vec<Aabb> = (0..200)
            .map(|_| {
                let (center, size) = (point(), point().abs() * 0.04);
                Aabb::new(center - size, center + size)
            })
            .collect();
        let (mut missed, mut met) = (0, 0);
        for simd in Simd::available() {
            let bvh = Bvh8::build(&boxes, |_| 0).with_simd(simd);
            let compact = bvh.clone().compacted();
            for _ in 0..500 {
                let eye = point() * 3.0;
                let (toward, right) = (point() - eye, point() * 0.1);
                let up = toward.cross(right).normalize() * 0.1;
                let at = |u: f64, v: f64| Ray::new(eye, toward + right * u + up * v);
                let corners = [at(-1.0, -1.0), at(1.0, -1.0), at(1.0, 1.0), at(-1.0, 1.0)];
                let beam = Beam::between(&corners).expect("a beam");
                let rays = (0..100)
                    .map(|i| at(f64::from(i % 10) / 4.5 - 1.0, f64::from(i / 10) / 4.5 - 1.0));
                let any = rays.fold(false, |any, ray| {
                    let mut visitor = Met(false);
                    let stats = &mut TraversalStats::default();
                    bvh.traverse(&ray, Interval::FORWARD, &mut visitor, stats);
                    any | visitor.0
                });
                let misses = bvh.misses(&beam);
                assert!(!(misses && any));
                assert!(misses || !compact.misses(&beam));
                missed += u32::from(misses);
                met += u32::from(any);
            }
        }
        assert!(missed > 100 && met > 100, "{missed} {met}");
        let all = Aabb::EVERYTHING;
        let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]
            .map(|(x, y)| Ray::new(DVec3::ZERO, DVec3::new(x, y, 1.0)));
        let beam = Beam::between(&corners).expect("a beam");
        assert!(!Bvh8::build(&[all], |_| 0).misses(&beam));
        assert!(Bvh8::build(&[], |_| 0).misses(&beam));
    }
}
