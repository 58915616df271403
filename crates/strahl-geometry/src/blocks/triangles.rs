use super::LANES;
use crate::mesh::{RayShear, TriangleHit, intersect_triangle};
use strahl_math::DVec3;
use strahl_simd::Isa;

/// A type that corners are stored in. Its numbers are converted to f64 exactly.
pub trait Coordinate: Copy + Into<f64> + 'static {
    /// What an empty lane is filled with: no ray hits a triangle of these.
    const NAN: Self;

    /// Loads four of them.
    fn load<I: Isa>(isa: I, lanes: &[Self; LANES]) -> I::F64x4;
}

impl Coordinate for f32 {
    const NAN: Self = Self::NAN;

    #[inline(always)]
    fn load<I: Isa>(isa: I, lanes: &[Self; LANES]) -> I::F64x4 {
        isa.load_wide(lanes)
    }
}

impl Coordinate for f64 {
    const NAN: Self = Self::NAN;

    #[inline(always)]
    fn load<I: Isa>(isa: I, lanes: &[Self; LANES]) -> I::F64x4 {
        isa.load(lanes)
    }
}

/// A [`RayShear`] in vectors.
struct Vectors<I: Isa> {
    axes: [usize; 3],
    origin: [I::F64x4; 3],
    slope: [I::F64x4; 2],
}

impl<I: Isa> Vectors<I> {
    /// The image of a corner across the ray, as `RayShear::apply`.
    #[inline(always)]
    fn image<T: Coordinate>(&self, isa: I, corner: &[[T; LANES]; 3]) -> (I::F64x4, I::F64x4) {
        let x = isa.sub(T::load(isa, &corner[self.axes[0]]), self.origin[0]);
        let y = isa.sub(T::load(isa, &corner[self.axes[1]]), self.origin[1]);
        let z = isa.sub(T::load(isa, &corner[self.axes[2]]), self.origin[2]);
        (
            isa.sub(x, isa.mul(self.slope[0], z)),
            isa.sub(y, isa.mul(self.slope[1], z)),
        )
    }
}

/// Up to four triangles, tested as [`intersect_triangle`] does.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(16))]
pub struct TriangleBlock<T> {
    /// Per corner, per axis, the coordinates of all lanes.
    corners: [[[T; LANES]; 3]; 3],
}

impl<T: Coordinate> TriangleBlock<T> {
    /// No triangles.
    pub const EMPTY: Self = Self {
        corners: [[[T::NAN; LANES]; 3]; 3],
    };

    /// Puts a triangle into a lane.
    pub fn set(&mut self, lane: usize, corners: [[T; 3]; 3]) {
        for (to, from) in self.corners.iter_mut().zip(corners) {
            for (axis, x) in to.iter_mut().zip(from) {
                axis[lane] = x;
            }
        }
    }

    /// The corners of a lane's triangle.
    #[inline]
    fn corners(&self, lane: usize) -> [DVec3; 3] {
        self.corners
            .map(|c| DVec3::from_array(c.map(|axis| axis[lane].into())))
    }

    /// Which triangles the ray's line meets, as bits; some may turn out to be misses at a closer look.
    #[inline(always)]
    pub fn candidates<I: Isa>(&self, isa: I, shear: &RayShear) -> u32 {
        let vectors = Vectors::<I> {
            axes: shear.axes(),
            origin: [
                isa.splat(shear.origin()[0]),
                isa.splat(shear.origin()[1]),
                isa.splat(shear.origin()[2]),
            ],
            slope: [isa.splat(shear.slope()[0]), isa.splat(shear.slope()[1])],
        };
        let [a, b, c] = &self.corners;
        let a = vectors.image(isa, a);
        let b = vectors.image(isa, b);
        let c = vectors.image(isa, c);
        let (u0, u1) = (isa.mul(b.0, c.1), isa.mul(b.1, c.0));
        let (v0, v1) = (isa.mul(c.0, a.1), isa.mul(c.1, a.0));
        let (w0, w1) = (isa.mul(a.0, b.1), isa.mul(a.1, b.0));
        let counter_clockwise = isa.le(u1, u0) & isa.le(v1, v0) & isa.le(w1, w0);
        let clockwise = isa.le(u0, u1) & isa.le(v0, v1) & isa.le(w0, w1);
        counter_clockwise | clockwise
    }

    /// Where the ray meets the triangle of a lane.
    #[inline]
    pub fn hit(&self, lane: usize, shear: &RayShear) -> Option<TriangleHit> {
        let [a, b, c] = self.corners(lane);
        intersect_triangle(shear, a, b, c)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use strahl_math::Ray;
    use strahl_simd::{Simd, dispatch};

    /// Rays at corners, edges and into the plane of random triangles on a coarse lattice, where ties abound.
    #[test]
    fn no_candidate_is_missed_and_few_are_in_vain() {
        let mut state = 1u64;
        let mut below = |n: u64| {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (state >> 33) % n
        };
        let mut point = || DVec3::new(below(5) as f64, below(5) as f64, below(5) as f64);
        let (mut hits, mut vain) = (0, 0);
        for _ in 0..20_000 {
            let triangles: [[DVec3; 3]; LANES] =
                std::array::from_fn(|_| [point(), point(), point()]);
            let mut single = TriangleBlock::<f32>::EMPTY;
            let mut double = TriangleBlock::<f64>::EMPTY;
            for (lane, t) in triangles.iter().enumerate().skip(1) {
                single.set(lane, t.map(|p| p.as_vec3().to_array()));
                double.set(lane, t.map(|p| p.to_array()));
            }
            let (from, to) = (point() * 1.5 - DVec3::ONE, point());
            let shear = RayShear::new(&Ray::new(from, to - from));
            for simd in Simd::available() {
                let found = dispatch!(simd, isa => single.candidates(isa, &shear));
                assert_eq!(
                    found,
                    dispatch!(simd, isa => double.candidates(isa, &shear))
                );
                assert_eq!(found & 1, 0, "the empty lane");
                for (lane, [a, b, c]) in triangles.into_iter().enumerate().skip(1) {
                    let expected = intersect_triangle(&shear, a, b, c);
                    let candidate = found >> lane & 1 == 1;
                    assert!(candidate || expected.is_none());
                    vain += u32::from(candidate && expected.is_none());
                    hits += u32::from(expected.is_some());
                    assert_eq!(single.hit(lane, &shear), expected);
                    assert_eq!(double.hit(lane, &shear), expected);
                }
            }
        }
        assert!(
            hits > 10_000 && vain < hits / 2,
            "{hits} hits, {vain} in vain"
        );
    }
}
