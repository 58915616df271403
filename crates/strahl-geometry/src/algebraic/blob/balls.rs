//! Balls around the fields of a blob's components, four side by side: which fields a ray or a point may reach.

use super::BlobComponent;
use crate::blocks::{LANES, dot};
use strahl_math::DVec3;
use strahl_simd::{Isa, Simd, dispatch};

/// How much larger the squared radii are, and how large the error of a squared distance may be beside the square of that from the ray's start.
const MARGIN: f64 = 1e-6;
const ERROR: f64 = 1e-12;

/// Four balls.
#[derive(Clone, Debug)]
#[repr(C, align(32))]
struct Four {
    /// Per axis the centers of all lanes.
    center: [[f64; LANES]; 3],
    /// The squared radii; negative in lanes without a ball.
    square: [f64; LANES],
}

/// The balls around the fields of up to 32 components.
#[derive(Clone, Debug)]
pub(super) struct Balls(Box<[Four]>);

impl Balls {
    /// One around the field of each component.
    pub(super) fn around(components: &[BlobComponent]) -> Self {
        let fours = components.chunks(LANES).map(|components| {
            let mut four = Four {
                center: [[0.0; LANES]; 3],
                square: [-1.0; LANES],
            };
            for (lane, component) in components.iter().enumerate() {
                let (center, radius) = component.ball();
                for axis in 0..3 {
                    four.center[axis][lane] = center[axis];
                }
                four.square[lane] = radius * radius * (1.0 + MARGIN);
            }
            four
        });
        Self(fours.collect())
    }

    /// The components, as bits, whose fields the line through a point may reach.
    pub(super) fn met_by(&self, start: DVec3, along: DVec3) -> u32 {
        dispatch!(Simd::best(), isa => self.met_with(isa, start, along))
    }

    #[inline(always)]
    fn met_with<I: Isa>(&self, isa: I, start: DVec3, along: DVec3) -> u32 {
        let along = [isa.splat(along.x), isa.splat(along.y), isa.splat(along.z)];
        let length = dot(isa, along, along);
        let mut met = 0;
        for (number, four) in self.0.iter().enumerate() {
            let way = four.way(isa, start);
            let (square, part) = (dot(isa, way, way), dot(isa, way, along));
            // Both sides are multiplied by the squared length of the direction.
            let distance = isa.sub(isa.mul(square, length), isa.mul(part, part));
            let error = isa.mul(square, isa.splat(ERROR));
            let most = isa.mul(isa.add(isa.load(&four.square), error), length);
            // NaN is kept.
            met |= (!isa.lt(most, distance) & 0b1111) << (number * LANES);
        }
        met
    }

    /// The components, as bits, whose fields may reach a point.
    pub(super) fn holding(&self, point: DVec3) -> u32 {
        dispatch!(Simd::best(), isa => self.holding_with(isa, point))
    }

    #[inline(always)]
    fn holding_with<I: Isa>(&self, isa: I, point: DVec3) -> u32 {
        let mut held = 0;
        for (number, four) in self.0.iter().enumerate() {
            let way = four.way(isa, point);
            let beyond = isa.lt(isa.load(&four.square), dot(isa, way, way));
            held |= (!beyond & 0b1111) << (number * LANES);
        }
        held
    }
}

impl Four {
    /// The way from the centers to a point.
    #[inline(always)]
    fn way<I: Isa>(&self, isa: I, point: DVec3) -> [I::F64x4; 3] {
        let [x, y, z] = &self.center;
        [
            isa.sub(isa.splat(point.x), isa.load(x)),
            isa.sub(isa.splat(point.y), isa.load(y)),
            isa.sub(isa.splat(point.z), isa.load(z)),
        ]
    }
}
