//! The rays of one position in the picture, where there may be many.

use crate::sampling::Sample;
use arrayvec::ArrayVec;
use strahl_accel::PACKET;
use strahl_math::Ray;
use strahl_shade::Color;

/// The rays of a bundle that come next, at most as many as fill a packet and those beyond; `None` where the camera sees nothing.
pub(crate) type NextRays = ArrayVec<Option<Ray>, { 2 * PACKET }>;

/// The rays of a position in the picture, and what they have seen so far. They are made a few at a time, since their number may
/// depend on what the first ones see.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RayBundle {
    /// The position, in pixels.
    pub(super) at: (f64, f64),
    /// How its points of the lens differ from those of other positions: which bits of their coordinates are flipped.
    pub(super) flips: [u32; 4],
    /// The number of the next ray of a mesh camera.
    pub(super) next: u32,
    /// The number of rays so far, their colours and the squares of these.
    pub(super) count: u32,
    pub(super) sum: Color,
    pub(super) squares: Color,
    /// What shows of the background, and the number of rays that it is known of.
    clear: f64,
    seen: u32,
}

impl RayBundle {
    pub(super) fn new(x: f64, y: f64) -> Self {
        Self {
            at: (x, y),
            flips: scramble((x, y)),
            next: 0,
            count: 0,
            sum: Color::BLACK,
            squares: Color::BLACK,
            clear: 0.0,
            seen: 0,
        }
    }

    /// Adds what one of the rays sees; `exists` is false where the camera sees nothing.
    #[inline]
    pub(crate) fn add(&mut self, sample: &Sample, exists: bool) {
        self.sum += sample.color;
        self.squares += sample.color * sample.color;
        self.count += 1;
        if exists {
            self.clear += sample.clear;
            self.seen += 1;
        }
    }

    /// The mean of the rays; black if there are none.
    pub(crate) fn mean(&self) -> Sample {
        Sample {
            color: self.sum / f64::from(self.count.max(1)),
            clear: self.clear / f64::from(self.seen.max(1)),
        }
    }

    /// Traces the rays one by one: `more` appends the rays that come next, and none at the end.
    pub(super) fn traced(
        mut self,
        mut more: impl FnMut(&mut Self, &mut NextRays),
        mut trace: impl FnMut(&Ray) -> Color,
    ) -> Self {
        let mut rays = NextRays::new();
        loop {
            more(&mut self, &mut rays);
            if rays.is_empty() {
                return self;
            }
            for ray in rays.drain(..) {
                let color = ray.as_ref().map_or(Color::BLACK, &mut trace);
                self.add(&Sample::from(color), ray.is_some());
            }
        }
    }
}

/// Four numbers that differ for every position in the picture (the mixer of SplitMix64).
fn scramble((x, y): (f64, f64)) -> [u32; 4] {
    let mix = |mut z: u64| {
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    };
    let first = mix(x.to_bits().wrapping_add(0x9e37_79b9_7f4a_7c15));
    let bits = mix(first ^ y.to_bits().rotate_left(32));
    let more = mix(bits);
    [bits, bits >> 32, more, more >> 32].map(|bits| bits as u32)
}
