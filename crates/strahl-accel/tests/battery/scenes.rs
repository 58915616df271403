//! Random scenes, and rays that are hard for them.

use strahl_math::{Aabb, DVec3, Ray};

/// SplitMix64.
pub(crate) struct Rng(pub(crate) u64);

impl Rng {
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// In `-1..1`.
    fn signed(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    pub(crate) fn point(&mut self) -> DVec3 {
        DVec3::new(self.signed(), self.signed(), self.signed())
    }

    pub(crate) fn below(&mut self, n: usize) -> usize {
        (self.bits() % n as u64) as usize
    }
}

/// Boxes of all sizes, some flat, some points, some sharing planes, some equal, a few unbounded, empty or far beyond the others.
pub(crate) fn boxes(rng: &mut Rng, count: usize, offset: DVec3, scale: f64) -> Vec<Aabb> {
    let mut all: Vec<Aabb> = Vec::new();
    for index in 0..count {
        let b = match rng.below(12) {
            0 if index > 0 => all[rng.below(index)],
            1 => Aabb::new(DVec3::new(-1.0, -1.0, 0.25), DVec3::new(1.0, 1.0, 0.25)),
            2 => {
                let p = rng.point();
                Aabb::new(p, p)
            }
            3 => {
                // On a coarse grid: many shared planes, edges and corners.
                let corner = (rng.point() * 4.0).floor() / 4.0;
                Aabb::new(corner, corner + DVec3::splat(0.25))
            }
            _ => {
                let p = rng.point();
                let size = 10f64.powf(-4.0 * rng.signed().abs());
                Aabb::from_points([p, p + rng.point() * size])
            }
        };
        all.push(b);
    }
    for b in &mut all {
        *b = Aabb::new(b.min * scale + offset, b.max * scale + offset);
    }
    if count > 20 {
        all[7] = Aabb::EMPTY;
        all[11] = Aabb::new(
            DVec3::new(f64::NEG_INFINITY, offset.y, offset.z),
            DVec3::new(f64::INFINITY, offset.y, offset.z),
        );
    }
    if count > 20 && rng.below(3) == 0 {
        let far = 1e6 * (scale + offset.abs().max_element());
        all[13] = Aabb::new(DVec3::splat(-far), DVec3::splat(far));
        all[17] = Aabb::new(DVec3::splat(0.1 * far), DVec3::splat(0.2 * far));
    }
    all
}

/// Difficult rays: at corners, edges and faces, along axes, in planes, from inside, far and near, long and short.
pub(crate) fn ray(rng: &mut Rng, boxes: &[Aabb], offset: DVec3, scale: f64) -> Ray {
    let b = loop {
        let b = boxes[rng.below(boxes.len())];
        if b.is_bounded() {
            break b;
        }
    };
    let target = match rng.below(4) {
        0 => b.corners()[rng.below(8)],
        1 => b.corners()[rng.below(8)] * 0.5 + b.corners()[rng.below(8)] * 0.5,
        2 => b.center(),
        _ => offset + rng.point() * scale,
    };
    let distance = [1e-3, 1.0, 3.0, 30.0, 1e3, 1e6, 1e12][rng.below(7)];
    let mut origin = target + rng.point() * (scale * distance);
    if rng.below(8) == 0 {
        origin = b.corners()[rng.below(8)];
    }
    let mut direction = target - origin;
    if rng.below(4) == 0 {
        // Exactly along an axis, through the target.
        let axis = rng.below(3);
        let mut along = DVec3::ZERO;
        along[axis] = direction[axis];
        origin = target - along;
        direction = along;
    }
    if rng.below(6) == 0 {
        direction[rng.below(3)] *= [-0.0, 1e-18, 1e-30][rng.below(3)];
    }
    direction *= [1.0, 0.37, 1e-30, 1e30, 1e-290, 1e280][rng.below(6)];
    Ray::new(origin, direction)
}
