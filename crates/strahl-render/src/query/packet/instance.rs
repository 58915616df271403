//! Packets go into instances: their rays are put into the space of the group together.

use super::super::NONE;
use super::super::kinds::Query;
use super::{Asked, Together};
use crate::prim::PrimKind;
use strahl_accel::{PACKET, lanes_of};

/// Where a group is.
#[derive(Clone, Copy)]
pub(super) struct Place {
    /// The number of its first element.
    pub(super) base: u64,
    /// The number of instances around it.
    pub(super) depth: u32,
}

impl Place {
    pub(super) const WORLD: Self = Self { base: 0, depth: 0 };

    /// From here on rays go into instances one by one: a packet takes some kilobytes of the stack.
    pub(super) const DEEPEST: u32 = 8;
}

impl<Q: Query> Together<'_, '_, '_, Q> {
    /// Searches the group of an instance for several rays.
    #[inline(never)]
    pub(super) fn instance(&mut self, id: u32, index: u32, lanes: u32, t_max: &mut [f64; PACKET]) {
        let instance = &self.group.instances[index as usize];
        let inner = &self.shared.scene.groups[instance.group as usize];
        let place = Place {
            base: self.place.base + self.group.first_id(id),
            depth: self.place.depth + 1,
        };
        // The other lanes have the first ray, which no search looks at.
        let first = lanes.trailing_zeros() as usize % PACKET;
        let spare = instance.transform.ray_to_object(&self.asked.rays[first]);
        let mut rays = [spare; PACKET];
        let (mut from, mut ends) = ([None; PACKET], [f64::NEG_INFINITY; PACKET]);
        for lane in lanes_of(lanes) {
            rays[lane] = instance.transform.ray_to_object(&self.asked.rays[lane]);
            ends[lane] = t_max[lane];
            if let Some(origin) = self.asked.from[lane].filter(|_| self.from_prims[lane] == id) {
                from[lane] = Some(origin);
                // The origin lies in this space, not in one further inside, and is exact here.
                let prim = inner.prims.at(inner.prim_of(origin.id - place.base));
                if !matches!(prim.kind(), PrimKind::Instance(_)) {
                    rays[lane].origin = origin.local;
                }
            }
        }
        let asked = Asked {
            rays: &rays[..self.asked.rays.len().min(PACKET)],
            from: &from,
            first: NONE,
            ..*self.asked
        };
        let ends = self.shared.search(inner, &asked, place, ends, self.queries);
        // The memory has the rays within the group now.
        self.has_coordinates = false;
        for lane in lanes_of(lanes) {
            t_max[lane] = ends[lane];
        }
    }
}
