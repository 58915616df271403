use super::node::{Child, Node, WIDTH, WideNode};
use crate::boxes::Box32;
use strahl_math::Vec4;
use strahl_simd::Isa;

/// A node in 96 instead of 256 bytes: the planes are bytes on a grid of the node's own.
///
/// Per axis the plane `q` of the grid lies at `origin + q 2ᵉ`, rounded to f32 once: the product has 8 bits, so it is exact, and a fused
/// multiply-add rounds no other way than a product and a sum. Every level of instructions decodes the same planes.
///
/// # Why no box is smaller than it was
/// The origin is the least lower plane of all children, so `q = 0` is not above any of them. `e` is such that the decoded `q = 255` is not
/// below any upper plane. Rounding is monotone, so decoded planes are in the order of their numbers; for each lower
/// plane the number is one whose decoded plane, the same f32 that the traversal computes, is not above it, and for each upper
/// plane one whose decoded plane is not below it. So each decoded box contains the box it was made from, and the traversal can
/// treat its planes as exact, like those of a [`Node`]. The bound B of the culling test is computed from the decoded boxes, so
/// their planes are within it, too.
///
/// C. Benthin, I. Wald, S. Woop, A. Áfra, "Compressed-Leaf Bounding Volume Hierarchies" (2018); H. Ylitie, T. Karras, S. Laine, "Efficient
/// Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs" (2017).
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(32))]
pub(super) struct CompactNode {
    origin: [f32; 3],
    /// Per axis the exponent e of the grid, as f32 has it: with 127 added.
    exponents: [u8; 3],
    /// The places with children, as bits.
    used: u8,
    /// Per axis the numbers of the lower planes, then of the upper planes of all children.
    planes: [[[u8; WIDTH]; 2]; 3],
    children: [Child; WIDTH],
}

const _: () = assert!(size_of::<CompactNode>() == 96);

/// No grid is finer than 2⁻⁹⁶: far above the subnormal numbers.
const LEAST_EXPONENT: u8 = 127 - 96;

const MOST_EXPONENT: u8 = 254;

/// The distance of neighbouring planes of a grid.
#[inline(always)]
const fn step(exponent: u8) -> f32 {
    f32::from_bits((exponent as u32) << 23)
}

/// The planes of an axis.
#[derive(Clone, Copy)]
struct Grid {
    origin: f32,
    exponent: u8,
}

impl Grid {
    /// The finest grid from `lo` that reaches up to `hi`.
    fn new(lo: f32, hi: f32) -> Self {
        let finest = (f64::from(hi) - f64::from(lo)) / 255.0;
        let exponent = (finest as f32).to_bits() >> 23;
        let mut grid = Self {
            origin: lo,
            exponent: exponent.clamp(LEAST_EXPONENT.into(), MOST_EXPONENT.into()) as u8,
        };
        while grid.plane(u8::MAX) < hi && grid.exponent < MOST_EXPONENT {
            grid.exponent += 1;
        }
        grid
    }

    /// The plane as the traversal computes it.
    fn plane(self, number: u8) -> f32 {
        f32::from(number) * step(self.exponent) + self.origin
    }

    /// How many steps a plane is from the origin.
    fn steps(self, plane: f32) -> f64 {
        (f64::from(plane) - f64::from(self.origin)) / f64::from(step(self.exponent))
    }

    /// The highest plane that is not above, or next to it.
    fn below(self, plane: f32) -> u8 {
        let mut number = self.steps(plane).floor() as u8;
        while number > 0 && self.plane(number) > plane {
            number -= 1;
        }
        number
    }

    /// The lowest plane that is not below, or next to it.
    fn above(self, plane: f32) -> u8 {
        let mut number = self.steps(plane).ceil() as u8;
        while number < u8::MAX && self.plane(number) < plane {
            number += 1;
        }
        number
    }
}

impl CompactNode {
    /// A node with the same children in boxes that contain those of `node`.
    pub(super) fn of(node: &Node) -> Self {
        let mut whole = Box32::EMPTY;
        for (_, bounds) in node.children() {
            whole.grow(&bounds);
        }
        let grids: [Grid; 3] = std::array::from_fn(|k| Grid::new(whole.lo()[k], whole.hi()[k]));
        let mut compact = Self {
            origin: grids.map(|g| g.origin),
            exponents: grids.map(|g| g.exponent),
            used: 0,
            planes: [[[0; WIDTH]; 2]; 3],
            children: [Child::default(); WIDTH],
        };
        for (place, (child, bounds)) in node.children().enumerate() {
            for (k, grid) in grids.iter().enumerate() {
                compact.planes[k][0][place] = grid.below(bounds.lo()[k]);
                compact.planes[k][1][place] = grid.above(bounds.hi()[k]);
            }
            compact.children[place] = child;
            compact.used |= 1 << place;
        }
        compact
    }
}

impl WideNode for CompactNode {
    #[inline(always)]
    fn planes<I: Isa>(&self, isa: I, axis: usize, side: usize) -> I::F32x8 {
        let numbers = isa.load_bytes(&self.planes[axis][side]);
        let step = isa.splat_f32(step(self.exponents[axis]));
        isa.mul_add(numbers, step, isa.splat_f32(self.origin[axis]))
    }

    #[inline(always)]
    fn used(&self) -> u32 {
        self.used.into()
    }

    #[inline(always)]
    fn child(&self, place: usize) -> Child {
        self.children[place]
    }

    fn children(&self) -> impl Iterator<Item = (Child, Box32)> {
        let corner = |side: usize, i: usize| {
            let [x, y, z] = std::array::from_fn(|k| {
                let (origin, exponent) = (self.origin[k], self.exponents[k]);
                Grid { origin, exponent }.plane(self.planes[k][side][i])
            });
            Vec4::new(x, y, z, 0.0)
        };
        (0..WIDTH)
            .filter(|i| self.used >> i & 1 == 1)
            .map(move |i| {
                (
                    self.children[i],
                    Box32::of_corners(corner(0, i), corner(1, i)),
                )
            })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use strahl_math::{Aabb, DVec3};
    use strahl_simd::{Simd, dispatch};

    /// Boxes of all sizes and magnitudes of coordinates, including flat ones and points.
    fn nodes() -> Vec<Node> {
        let mut state = 5u64;
        let mut below = |n: u64| {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (state >> 33) % n
        };
        let mut nodes = Vec::new();
        for i in 0..4000 {
            let mut node = Node::EMPTY;
            let place = 10f64.powi((i % 29) - 14);
            let size = place * 10f64.powi((i / 29 % 12) - 9);
            for k in 0..=below(8) as usize {
                let mut number = || below(2001) as f64 / 1000.0 - 1.0;
                let center = DVec3::new(number(), number(), number()) * place;
                let mut half = DVec3::new(number(), number(), number()).abs() * size;
                if i % 5 == 0 {
                    half[k % 3] = 0.0;
                }
                let bounds = Aabb::new(center - half, center + half);
                let bounds = Box32::try_new(&bounds).expect("bounded");
                node.set(k, &bounds, Child::inner(k));
            }
            nodes.push(node);
        }
        nodes
    }

    #[test]
    fn boxes_contain_those_they_were_made_from_by_little() {
        let (mut grown, mut all) = (0.0, 0.0);
        for node in nodes() {
            let compact = CompactNode::of(&node);
            assert_eq!(compact.children().count(), node.children().count());
            let mut whole = Box32::EMPTY;
            for ((child, outer), (same, inner)) in compact.children().zip(node.children()) {
                assert_eq!(child, same);
                assert!(outer.contains(&inner), "{outer:?} {inner:?}");
                whole.grow(&inner);
            }
            // A step is at most 2/255 of the extent, or the spacing of f32 numbers there.
            let far = whole.lo().abs().max(whole.hi().abs());
            let step = whole.size() * (2.0 / 255.0) + far * f32::EPSILON + Vec4::splat(1e-28);
            for ((_, outer), (_, inner)) in compact.children().zip(node.children()) {
                let (lower, higher) = (inner.lo() - outer.lo(), outer.hi() - inner.hi());
                assert!(lower.cmple(step).all() && higher.cmple(step).all());
                grown += f64::from(lower.x + higher.x) / f64::from(step.x);
                all += 1.0;
            }
        }
        assert!(grown / all < 1.0, "{}", grown / all);
    }

    #[test]
    fn all_levels_decode_the_boxes_that_were_proved() {
        for node in nodes() {
            let compact = CompactNode::of(&node);
            for simd in Simd::available() {
                for axis in 0..3 {
                    let [lo, hi] = [0, 1].map(|side| {
                        dispatch!(simd, isa => isa.store_f32(compact.planes(isa, axis, side))).0
                    });
                    for (place, (_, bounds)) in compact.children().enumerate() {
                        assert_eq!(lo[place], bounds.lo()[axis]);
                        assert_eq!(hi[place], bounds.hi()[axis]);
                    }
                }
            }
        }
    }
}
