//! Packets find the same hits as their rays alone.

use crate::agreement::effort;
use crate::hits::{Any, Closest, answers, hit_box};
use crate::scenes::{Rng, boxes, ray};
use strahl_accel::{
    Accelerator, Bvh8, Leaf, List, PACKET, Packet, PacketVisitor, TraversalStats, Visitor,
};
use strahl_math::{Aabb, DVec3, Interval, Ray};
use strahl_simd::{Isa, Simd};

/// A visitor for each ray, for closest hits or, if `ANY`, for any.
struct Lanes<const ANY: bool, V>(Vec<V>);

impl<const ANY: bool, V: Visitor> PacketVisitor for Lanes<ANY, V> {
    const ANY: bool = ANY;

    fn visit(&mut self, id: u32, lane: usize, t_max: f64) -> f64 {
        self.0[lane].visit(id, t_max)
    }

    fn visit_leaf<I: Isa>(&mut self, isa: I, leaf: &Leaf<'_>, lane: usize, t_max: f64) -> f64 {
        self.0[lane].visit_leaf(isa, leaf, t_max)
    }
}

/// Rays that start at one point, to one side or to all sides, or have one direction, or have little in common.
fn together(rng: &mut Rng, boxes: &[Aabb], offset: DVec3, scale: f64) -> Vec<Ray> {
    let first = ray(rng, boxes, offset, scale);
    let size = [1e-9, 1e-3, 0.1][rng.below(3)];
    let kind = rng.below(5);
    let count = 1 + rng.below(PACKET);
    let mut rays = vec![first];
    while rays.len() < count {
        let other = ray(rng, boxes, offset, scale);
        let aside = rng.point() * size;
        rays.push(match kind {
            0 => Ray::new(
                first.origin,
                first.direction + aside * first.direction.abs().max_element(),
            ),
            1 => Ray::new(first.origin + aside * scale, first.direction),
            2 => Ray::new(other.origin, first.direction),
            3 => Ray::new(first.origin, offset + rng.point() * scale - first.origin),
            _ => other,
        });
    }
    rays.retain(|r| r.direction != DVec3::ZERO && r.direction.is_finite() && r.origin.is_finite());
    rays
}

#[test]
fn packets_agree_with_the_list() {
    let mut rng = Rng(21);
    let (mut rays, mut hits) = (0, 0);
    for round in 0..40 {
        let scale = [1.0, 1e-6, 1e6, 1e-42, 1e19][round % 5];
        let offset = [DVec3::ZERO, DVec3::new(1e3, -50.0, 7.0)][round / 5 % 2] * scale;
        let boxes = boxes(&mut rng, [2, 30, 300][round % 3], offset, scale);
        if boxes.iter().all(|b| !b.is_bounded()) {
            continue;
        }
        let list = List::build(&boxes);
        let wide = Bvh8::build(&boxes, |id| (id % 5 / 2) as u8);
        let levels: Vec<Bvh8> = Simd::available()
            .into_iter()
            .map(|simd| wide.clone().with_simd(simd))
            .collect();
        for _ in 0..100 * effort() {
            let packet = together(&mut rng, &boxes, offset, scale);
            let min = [0.0, 0.5, f64::NEG_INFINITY][rng.below(3)];
            let ends: Vec<f64> = packet
                .iter()
                .map(|_| [1.0, f64::INFINITY, f64::INFINITY][rng.below(3)])
                .collect();
            let expected: Vec<_> = packet
                .iter()
                .zip(&ends)
                .map(|(ray, end)| answers(&list, hit_box, &boxes, ray, Interval::new(min, *end)))
                .collect();
            rays += packet.len();
            hits += expected.iter().filter(|e| e.1).count();
            for bvh in &levels {
                let closest = |(ray, _): (&Ray, &f64)| Closest {
                    hit: hit_box,
                    boxes: &boxes,
                    ray: *ray,
                    t_min: min,
                    best: None,
                };
                let mut visitor =
                    Lanes::<false, _>(packet.iter().zip(&ends).map(closest).collect());
                walk(bvh, &packet, min, &ends, &mut visitor);
                let found: Vec<_> = visitor.0.iter().map(|c| c.best).collect();
                let best: Vec<_> = expected.iter().map(|e| e.0).collect();
                assert_eq!(found, best, "{} {packet:?} {min} {ends:?}", bvh.simd());
                let any = |(ray, end): (&Ray, &f64)| Any {
                    hit: hit_box,
                    boxes: &boxes,
                    ray: *ray,
                    range: Interval::new(min, *end),
                    found: false,
                };
                let mut visitor = Lanes::<true, _>(packet.iter().zip(&ends).map(any).collect());
                walk(bvh, &packet, min, &ends, &mut visitor);
                let found: Vec<_> = visitor.0.iter().map(|a| a.found).collect();
                let any: Vec<_> = expected.iter().map(|e| e.1).collect();
                assert_eq!(found, any, "{} {packet:?} {min} {ends:?}", bvh.simd());
            }
        }
    }
    assert!(rays > 10_000 * effort() && hits > rays / 4, "{rays} {hits}");
}

fn walk(bvh: &Bvh8, rays: &[Ray], min: f64, ends: &[f64], visitor: &mut impl PacketVisitor) {
    let mut t_max = [f64::NEG_INFINITY; PACKET];
    t_max[..ends.len()].copy_from_slice(ends);
    let mut packet = Packet { rays, min, t_max };
    assert!(bvh.traverse_packet(&mut packet, visitor, &mut TraversalStats::default()));
}

#[test]
fn lanes_that_ended_are_not_followed() {
    let boxes = [Aabb::new(DVec3::NEG_ONE, DVec3::ONE)];
    let bvh = Bvh8::build(&boxes, |_| 1);
    let ray = Ray::new(DVec3::Z * -3.0, DVec3::Z);
    let closest = || Closest {
        hit: hit_box,
        boxes: &boxes,
        ray,
        t_min: 0.0,
        best: None,
    };
    let mut visitor = Lanes::<false, _>(vec![closest(), closest()]);
    walk(
        &bvh,
        &[ray; 2],
        0.0,
        &[f64::NEG_INFINITY, 9.0],
        &mut visitor,
    );
    assert_eq!(visitor.0[0].best, None);
    assert_eq!(visitor.0[1].best, Some((2.0, 0)));
}
