//! Packets find in trees what single rays find there.

use super::packet::tests::{operand, rays};
use super::{Csg, CsgNode, PacketRanges, PacketTree};
use crate::conformance::Random;
use crate::{PrimHit, Primitive, Scratch, Torus};
use strahl_accel::PACKET;
use strahl_math::{DVec3, Interval, Ray, Transform};
use strahl_simd::Simd;

/// A tree of merges, intersections and differences within each other; on a lattice faces coincide.
fn node(random: &mut Random, lattice: bool, depth: u32, tag: &mut u32) -> CsgNode {
    *tag += 1;
    if depth == 0 || random.below(4) == 0 {
        if random.below(8) == 0 {
            let ring = CsgNode::leaf(Torus::new(random.cube() * 0.5, DVec3::Y, 0.8, 0.3), *tag);
            return ring;
        }
        return operand(random, lattice, *tag);
    }
    // Sometimes many operands, for which there is a hierarchy.
    let count = match random.below(8) {
        0 => 12,
        _ => 2 + random.below(3),
    };
    let mut operands: Vec<CsgNode> = (0..count)
        .map(|_| node(random, lattice, depth - 1, tag))
        .collect();
    match random.below(5) {
        0 => CsgNode::intersection(operands),
        1 => CsgNode::difference(operands),
        2 => {
            let first = operands.remove(0);
            CsgNode::clip(first, operands)
        }
        _ => CsgNode::merge(operands),
    }
}

/// What is asked of the rays of one packet.
struct Asked<'a> {
    csg: &'a Csg,
    map: Option<&'a Transform>,
    rays: &'a [Ray],
    range: Interval,
    /// The hits that they start on.
    from: [Option<PrimHit>; PACKET],
}

/// How many answers were compared, known and hits.
#[derive(Default)]
struct Seen {
    asked: u32,
    known: u32,
    hits: u32,
}

impl Asked<'_> {
    /// Compares all answers, for some of the lanes.
    fn check(&self, lanes: u32, seen: &mut Seen) {
        let scratch = &mut Scratch::default();
        let starting = (0..PACKET).filter(|lane| self.from[*lane].is_some());
        let ranges = PacketRanges {
            rays: self.rays,
            min: self.range.min,
            t_max: &[self.range.max; PACKET],
            starting: starting.map(|lane| 1 << lane).sum(),
        };
        for simd in Simd::available() {
            let mut tree = PacketTree::default();
            tree.find_at(simd, self.csg, &ranges, self.map, lanes);
            let wanted = (0..PACKET).filter(|lane| lanes >> lane & 1 == 1);
            for (place, lane) in wanted.enumerate() {
                let (outer, from) = (self.rays[lane], self.from[lane].map(|hit| hit.surface));
                let ray = self.map.map_or(outer, |map| map.ray_to_object(&outer));
                let (csg, range) = (self.csg, self.range);
                let closest = csg.closest_hit(&ray, range, from, scratch);
                seen.asked += 1;
                if let Some(found) = tree.closest(csg, place, &ray, range, from, scratch) {
                    assert_eq!(found, closest, "{csg:?} {ray:?} {range:?} {from:?}");
                    seen.known += 1;
                    seen.hits += u32::from(found.is_some());
                }
                let (mut all, mut found) = (vec![], vec![]);
                csg.all_hits(&ray, range, from, scratch, &mut all);
                if tree.all(csg, place, &ray, range, from, scratch, &mut found) {
                    assert_eq!(found, all, "{csg:?} {ray:?} {range:?} {from:?}");
                }
            }
        }
    }
}

#[test]
fn packets_find_in_trees_what_single_rays_find() {
    let mut random = Random::new(11);
    let (mut seen, mut secondary) = (Seen::default(), Seen::default());
    for round in 0..3000 {
        let lattice = round % 4 == 0;
        let tree = node(&mut random, lattice, 3, &mut 0);
        let csg = Csg::try_new(tree).expect("valid");
        if !csg.goes_in_packets() {
            continue;
        }
        let turn = Transform::rotate(DVec3::new(1.0, 2.0, 0.5), random.unit());
        let map = (round % 3 == 1).then_some(&turn);
        let rays = rays(&mut random, lattice);
        let range = match round % 5 {
            0 => Interval::LINE,
            1 => Interval::new(0.9, 1.1),
            _ => Interval::FORWARD,
        };
        let asked = Asked {
            csg: &csg,
            map,
            rays: &rays,
            range,
            from: [None; PACKET],
        };
        let lanes = match random.below(3) {
            0 => 0xffff,
            _ => random.below(0xffff) as u32 | 0b10,
        };
        asked.check(lanes, &mut seen);
        // From their hits in any direction, with the origin on the surface where there is no map.
        let scratch = &mut Scratch::default();
        let starts: Vec<(Ray, Option<PrimHit>)> = rays
            .iter()
            .map(|ray| {
                let inner = map.map_or(*ray, |map| map.ray_to_object(ray));
                let hit = csg.closest_hit(&inner, Interval::FORWARD, None, scratch);
                let Some(hit) = hit.filter(|_| map.is_none()) else {
                    return (*ray, None);
                };
                let point = csg.surface_at(&inner, &hit).position;
                (Ray::new(point, random.direction()), Some(hit))
            })
            .collect();
        let rays: Vec<Ray> = starts.iter().map(|(ray, _)| *ray).collect();
        let mut from = [None; PACKET];
        for (from, (_, hit)) in from.iter_mut().zip(&starts) {
            *from = *hit;
        }
        let asked = Asked {
            rays: &rays,
            range: Interval::FORWARD,
            from,
            ..asked
        };
        asked.check(lanes, &mut secondary);
    }
    for Seen { asked, known, hits } in [seen, secondary] {
        assert!(
            known * 4 > asked * 3 && hits * 6 > asked,
            "{asked} {known} {hits}"
        );
    }
}
