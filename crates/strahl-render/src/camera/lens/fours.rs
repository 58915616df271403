//! Four rays through a lens at once: their roots and divisions, one behind the other, take longer than all else.

use super::{LensSampler, NextRays};
use strahl_math::{DVec3, Ray, det};
use strahl_scene::{Camera, Projection};
use strahl_simd::{Isa, Simd, dispatch};

/// The rays of a perspective camera without a `normal`, through a round lens.
#[derive(Clone, Debug)]
pub(super) struct FourRays {
    eye: DVec3,
    /// The vectors that a position in the picture is made of.
    direction: DVec3,
    right: DVec3,
    up: DVec3,
    /// The width and the height of the picture.
    size: [f64; 2],
    /// Those of the lens.
    side: DVec3,
    above: DVec3,
    forward: DVec3,
    distance: f64,
}

/// Three coordinates of four vectors.
type Vectors<I> = [<I as Isa>::F64x4; 3];

impl FourRays {
    pub(super) fn new(camera: &Camera, lens: &LensSampler, size: [f64; 2]) -> Option<Self> {
        let is_usual = matches!(camera.projection, Projection::Perspective)
            && camera.normal.is_none()
            && lens.bokeh.is_none();
        is_usual.then_some(Self {
            eye: camera.eye,
            direction: camera.direction,
            right: camera.right,
            up: camera.up,
            size,
            side: lens.side,
            above: lens.above,
            forward: lens.forward,
            distance: lens.distance,
        })
    }

    /// Appends the rays of samples at a position, with the bits of [`LensSampler::ray`]. Returns `false` if the direction of one
    /// of them has no length or is not finite; what it has appended is of no use then.
    pub(super) fn push(&self, samples: &[[f64; 4]], at: [f64; 2], rays: &mut NextRays) -> bool {
        dispatch!(Simd::best(), isa => self.push_with(isa, samples, at, rays))
    }

    #[inline(always)]
    fn push_with<I: Isa>(
        &self,
        isa: I,
        samples: &[[f64; 4]],
        at: [f64; 2],
        rays: &mut NextRays,
    ) -> bool {
        for four in samples.chunks(4) {
            // The places behind the last sample stay the corner of the cube: those rays are left out.
            let mut coordinates = [[0.0; 4]; 4];
            for (lane, sample) in four.iter().enumerate() {
                for (coordinate, x) in coordinates.iter_mut().zip(sample) {
                    coordinate[lane] = *x;
                }
            }
            let Some((origins, directions)) = self.rays(isa, &coordinates, at) else {
                return false;
            };
            let (origins, directions) = (stored(isa, origins), stored(isa, directions));
            for lane in 0..four.len() {
                let [origin, direction] =
                    [&origins, &directions].map(|v| DVec3::new(v[0][lane], v[1][lane], v[2][lane]));
                rays.push(Some(Ray::new(origin, direction)));
            }
        }
        true
    }

    /// The origins and the directions of the rays of four samples, given coordinate by coordinate: step by step what [`LensSampler::ray`] does.
    #[inline(always)]
    fn rays<I: Isa>(
        &self,
        isa: I,
        [a, b, c, d]: &[[f64; 4]; 4],
        [x, y]: [f64; 2],
    ) -> Option<(Vectors<I>, Vectors<I>)> {
        let n = |number: f64| isa.splat(number);
        let zero = n(0.0);
        let (a, b, c, d) = (isa.load(a), isa.load(b), isa.load(c), isa.load(d));
        let radius = isa.sqrt(a);
        let [sin, cos] = det::sines_and_cosines(isa, isa.mul(n(std::f64::consts::TAU), b));
        let (lens_x, lens_y) = (isa.mul(radius, cos), isa.mul(radius, sin));
        // The chief rays.
        let twice_x = isa.mul(n(2.0), isa.sub(isa.add(n(x), c), n(0.5)));
        let twice_y = isa.mul(n(2.0), isa.sub(isa.add(n(y), d), n(0.5)));
        let u = isa.sub(isa.div(twice_x, n(self.size[0])), n(1.0));
        let v = isa.sub(n(1.0), isa.div(twice_y, n(self.size[1])));
        let (mut chief, mut origin, mut way) = ([zero; 3], [zero; 3], [zero; 3]);
        for (axis, chief) in chief.iter_mut().enumerate() {
            let right = isa.mul(n(self.right[axis]), u);
            let sideways = isa.add(right, isa.mul(n(self.up[axis]), v));
            *chief = isa.add(n(self.direction[axis]), sideways);
        }
        // Where they meet the plane of focus.
        let forward = [n(self.forward.x), n(self.forward.y), n(self.forward.z)];
        let ahead = dot(isa, chief, forward);
        let t = isa.div(n(self.distance), ahead);
        let t = isa.choose_le(isa.abs(ahead), zero, n(self.distance.abs()), t);
        for axis in 0..3 {
            let eye = n(self.eye[axis]);
            let beside = isa.add(eye, isa.mul(n(self.side[axis]), lens_x));
            origin[axis] = isa.add(beside, isa.mul(n(self.above[axis]), lens_y));
            let focus = isa.add(eye, isa.mul(chief[axis], t));
            way[axis] = isa.sub(focus, origin[axis]);
        }
        let inverse = isa.div(n(1.0), isa.sqrt(dot(isa, way, way)));
        if isa.lt(zero, inverse) & isa.le(inverse, n(f64::MAX)) != 0b1111 {
            return None;
        }
        for way in &mut way {
            let unit = isa.mul(*way, inverse);
            *way = isa.choose_le(zero, t, unit, isa.mul(unit, n(-1.0)));
        }
        Some((origin, way))
    }
}

#[inline(always)]
fn dot<I: Isa>(isa: I, a: Vectors<I>, b: Vectors<I>) -> I::F64x4 {
    let xy = isa.add(isa.mul(a[0], b[0]), isa.mul(a[1], b[1]));
    isa.add(xy, isa.mul(a[2], b[2]))
}

#[inline(always)]
fn stored<I: Isa>(isa: I, v: Vectors<I>) -> [[f64; 4]; 3] {
    [isa.store(v[0]), isa.store(v[1]), isa.store(v[2])]
}
