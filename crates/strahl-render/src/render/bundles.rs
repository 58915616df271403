//! The means of positions in the picture that have bundles of rays: those through a lens, or from the meshes of a camera. Packets have
//! rays of several positions, since one of them often wants only a few at a time.

use super::pixels::PixelTracer;
use crate::camera::{NextRays, RayBundle};
use crate::sampling::Sample;
use arrayvec::ArrayVec;
use strahl_accel::PACKET;

/// A bundle whose rays are being traced.
struct Open {
    /// The number of its position.
    number: usize,
    bundle: RayBundle,
    /// How many of its rays wait.
    waiting: usize,
}

/// The bundles that are being traced, at most as many as rays in a packet: another one is opened only while each has a ray that waits.
#[derive(Default)]
struct Bundles {
    slots: ArrayVec<Open, PACKET>,
    /// The slots of bundles without rays that wait.
    ready: ArrayVec<usize, PACKET>,
    /// The slots of bundles that have ended.
    free: ArrayVec<usize, PACKET>,
    /// The rays that wait, and the slots of their bundles.
    rays: NextRays,
    owners: ArrayVec<usize, { 2 * PACKET }>,
}

impl Bundles {
    /// Opens a bundle and returns its slot.
    fn open(&mut self, number: usize, bundle: RayBundle) -> usize {
        let open = Open {
            number,
            bundle,
            waiting: 0,
        };
        match self.free.pop() {
            Some(slot) => {
                self.slots[slot] = open;
                slot
            }
            None => {
                self.slots.push(open);
                self.slots.len() - 1
            }
        }
    }

    /// Takes what the first of the rays see.
    fn take(&mut self, samples: &[Sample]) {
        let count = samples.len();
        let rays = self.rays.drain(..count).zip(samples);
        for ((ray, sample), owner) in rays.zip(self.owners.drain(..count)) {
            let open = &mut self.slots[owner];
            open.bundle.add(sample, ray.is_some());
            open.waiting -= 1;
            if open.waiting == 0 {
                self.ready.push(owner);
            }
        }
    }
}

impl PixelTracer<'_> {
    /// Tells `put` the means at positions in the picture, with their numbers. Leaves off if the tile is left.
    pub(super) fn means(
        &mut self,
        places: impl Iterator<Item = (f64, f64)>,
        mut put: impl FnMut(usize, Sample),
    ) {
        let mut places = places.enumerate();
        let mut bundles = Bundles::default();
        loop {
            let slot = if let Some(slot) = bundles.ready.pop() {
                slot
            } else if let Some((number, (x, y))) = places.next() {
                if number.is_multiple_of(PACKET) && self.leaves() {
                    return;
                }
                bundles.open(number, self.rays.bundle(x, y))
            } else if bundles.rays.is_empty() {
                return;
            } else {
                bundles.take(self.tree.trace_packet(&bundles.rays));
                continue;
            };
            let before = bundles.rays.len();
            let open = &mut bundles.slots[slot];
            self.rays.more(&mut open.bundle, &mut bundles.rays);
            open.waiting = bundles.rays.len() - before;
            if open.waiting == 0 {
                put(open.number, open.bundle.mean());
                bundles.free.push(slot);
                continue;
            }
            bundles.owners.extend((0..open.waiting).map(|_| slot));
            if bundles.rays.len() >= PACKET {
                bundles.take(self.tree.trace_packet(&bundles.rays[..PACKET]));
            }
        }
    }
}
