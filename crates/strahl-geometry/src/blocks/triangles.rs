use super::{Hits, LANES};
use crate::mesh::{Axis, LOST_DIGITS, RayShear, intersect_triangle};
use strahl_math::{DVec3, Interval};
use strahl_simd::Isa;

/// A type in which corners are stored. Its numbers are converted to f64 exactly.
pub trait Coordinate: Copy + Into<f64> + 'static {
    /// The content of empty lanes: no ray hits a triangle with such corners.
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
    axes: [Axis; 3],
    origin: [I::F64x4; 3],
    slope: [I::F64x4; 2],
}

/// The images of a corner of all lanes.
struct Image<I: Isa> {
    x: I::F64x4,
    y: I::F64x4,
    z: I::F64x4,
}

impl<I: Isa> Vectors<I> {
    #[inline(always)]
    fn new(isa: I, shear: &RayShear) -> Self {
        let ([x, y, z], [slope_x, slope_y]) = (shear.origin(), shear.slope());
        Self {
            axes: shear.axes(),
            origin: [isa.splat(x), isa.splat(y), isa.splat(z)],
            slope: [isa.splat(slope_x), isa.splat(slope_y)],
        }
    }

    /// The image of a corner, as `RayShear::apply`.
    #[inline(always)]
    fn image<T: Coordinate>(&self, isa: I, corner: &[[T; LANES]; 3]) -> Image<I> {
        let [i, j, k] = self.axes;
        let x = isa.sub(T::load(isa, &corner[i as usize]), self.origin[0]);
        let y = isa.sub(T::load(isa, &corner[j as usize]), self.origin[1]);
        let z = isa.sub(T::load(isa, &corner[k as usize]), self.origin[2]);
        Image {
            x: isa.sub(x, isa.mul(self.slope[0], z)),
            y: isa.sub(y, isa.mul(self.slope[1], z)),
            z,
        }
    }
}

/// The two products that an edge function is the difference of, for the edge between two corners.
#[inline(always)]
fn products<I: Isa>(isa: I, p: &Image<I>, q: &Image<I>) -> (I::F64x4, I::F64x4) {
    (isa.mul(p.x, q.y), isa.mul(p.y, q.x))
}

/// Up to four triangles, tested as [`intersect_triangle`] does.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(16))]
pub struct TriangleBlock<T> {
    /// Per corner, per axis, the coordinates of all lanes.
    pub(super) corners: [[[T; LANES]; 3]; 3],
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

    /// The triangles that the ray hits in a range, as bits, and the hits: the same operations as of [`intersect_triangle`].
    #[inline(always)]
    pub fn hits<I: Isa>(&self, isa: I, shear: &RayShear, range: Interval, hits: &mut Hits) -> u32 {
        let vectors = Vectors::new(isa, shear);
        let [a, b, c] = &self.corners;
        let a = vectors.image(isa, a);
        let b = vectors.image(isa, b);
        let c = vectors.image(isa, c);
        let (u0, u1) = products(isa, &b, &c);
        let (v0, v1) = products(isa, &c, &a);
        let (w0, w1) = products(isa, &a, &b);
        // A difference has the sign that a comparison finds, if necessary as a subnormal number; NaN (from infinite products)
        // leads to a hit that is not finite, hence to none.
        let (u, v, w) = (isa.sub(u0, u1), isa.sub(v0, v1), isa.sub(w0, w1));
        let (zero, least) = (isa.splat(0.0), isa.min(isa.min(u, v), w));
        let most = isa.max(isa.max(u, v), w);
        let candidates = isa.le(zero, least) | isa.le(most, zero);
        if candidates == 0 {
            return 0;
        }
        let area = isa.add(isa.add(u, v), w);
        let sizes = (
            isa.add(isa.abs(u0), isa.abs(u1)),
            isa.add(isa.abs(v0), isa.abs(v1)),
            isa.add(isa.abs(w0), isa.abs(w1)),
        );
        let size = isa.add(isa.add(sizes.0, sizes.1), sizes.2);
        let lost = isa.lt(isa.abs(area), isa.mul(size, isa.splat(LOST_DIGITS))) & candidates;
        let (u, v) = (isa.div(v, area), isa.div(w, area));
        let across = isa.add(isa.mul(u, isa.sub(b.z, a.z)), isa.mul(v, isa.sub(c.z, a.z)));
        let t = isa.div(isa.add(a.z, across), isa.splat(shear.direction_z()));
        // Triangles without area, or beyond the range of f64, have no finite t.
        let max = if range.max < f64::MAX {
            range.max
        } else {
            f64::MAX
        };
        let inside = isa.lt(isa.splat(range.min), t) & isa.le(t, isa.splat(max));
        let found = inside & candidates & !lost;
        if found | lost != 0 {
            hits.t = isa.store(t);
            hits.uv = [isa.store(u), isa.store(v)];
        }
        if lost == 0 {
            found
        } else {
            found | self.careful_hits(lost, shear, range, hits)
        }
    }

    /// The same for some lanes, one by one.
    #[cold]
    fn careful_hits(&self, lanes: u32, shear: &RayShear, range: Interval, hits: &mut Hits) -> u32 {
        let mut found = 0;
        for lane in (0..LANES).filter(|lane| lanes >> lane & 1 == 1) {
            let [a, b, c] = self.corners(lane);
            if let Some(hit) = intersect_triangle(shear, a, b, c)
                && range.accepts(hit.t)
            {
                hits.t[lane] = hit.t;
                hits.uv[0][lane] = hit.u;
                hits.uv[1][lane] = hit.v;
                found |= 1 << lane;
            }
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::TriangleHit;
    use strahl_math::Ray;
    use strahl_simd::{Simd, dispatch};

    /// Rays at corners, edges and into the plane of random triangles on a coarse lattice, where ties abound.
    #[test]
    fn hits_are_those_of_the_single_test() {
        let mut state = 1u64;
        let mut below = |n: u64| {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (state >> 33) % n
        };
        let mut point = || DVec3::new(below(5) as f64, below(5) as f64, below(5) as f64);
        let (mut hits, mut misses) = (0, 0);
        for i in 0..20_000 {
            let triangles: [[DVec3; 3]; LANES] =
                std::array::from_fn(|_| [point(), point(), point()]);
            let mut single = TriangleBlock::<f32>::EMPTY;
            let mut double = TriangleBlock::<f64>::EMPTY;
            for (lane, t) in triangles.iter().enumerate().skip(1) {
                single.set(lane, t.map(|p| p.as_vec3().to_array()));
                double.set(lane, t.map(|p| p.to_array()));
            }
            let (from, mut to) = (point() * 1.5 - DVec3::ONE, point());
            if i % 3 == 0 {
                // Slivers: the ray is almost in the plane of many of them.
                to += DVec3::new(1e-12, -1e-13, 1e-11);
            }
            let huge = if i % 50 == 0 { 1e200 } else { 1.0 };
            let shear = RayShear::new(&Ray::new(from * huge, to - from));
            let range = match i % 4 {
                0 => Interval::LINE,
                1 => Interval::FORWARD,
                _ => Interval::new(0.5, 1.0),
            };
            for simd in Simd::available() {
                let [mut found, mut of_double] = [Hits::default(); 2];
                let lanes = dispatch!(simd, isa => single.hits(isa, &shear, range, &mut found));
                let others =
                    dispatch!(simd, isa => double.hits(isa, &shear, range, &mut of_double));
                assert_eq!(lanes, others);
                assert_eq!(lanes & 1, 0, "the empty lane");
                for (lane, [a, b, c]) in triangles.into_iter().enumerate().skip(1) {
                    let expected = intersect_triangle(&shear, a, b, c);
                    let expected = expected.filter(|hit| range.accepts(hit.t));
                    for found in [&found, &of_double] {
                        let hit = TriangleHit {
                            t: found.t[lane],
                            u: found.uv[0][lane],
                            v: found.uv[1][lane],
                        };
                        assert_eq!((lanes >> lane & 1 == 1).then_some(hit), expected);
                    }
                    hits += u32::from(expected.is_some());
                    misses += u32::from(expected.is_none());
                }
            }
        }
        let levels = Simd::available().len() as u32;
        assert!(
            hits > 5_000 * levels && misses > 5_000 * levels,
            "{hits} hits, {misses} misses at {levels} levels"
        );
    }
}
