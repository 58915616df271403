use crate::appearance::{Appearance, AppearanceRun};
use crate::prim::{Prim, PrimKind};
use crate::runs::RunList;
use strahl_accel::{BLOCK, NO_PRIMITIVE};
use strahl_geometry::Sphere;
use strahl_geometry::blocks::SphereBlock;
use strahl_math::DVec3;

/// A sphere that is seen from outside and whose texture is not rotated: scenes have millions of them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CompactSphere {
    center: DVec3,
    radius: f64,
}

impl CompactSphere {
    /// The compact form of a sphere, if it has one.
    pub(crate) fn of(sphere: &Sphere) -> Option<Self> {
        let is_compact = sphere.radius() > 0.0 && !sphere.is_turned();
        is_compact.then(|| Self {
            center: sphere.center(),
            radius: sphere.radius(),
        })
    }

    #[inline(always)]
    fn sphere(self) -> Sphere {
        Sphere::new(self.center, self.radius)
    }
}

/// The compact spheres of a group, each stored once: in a list, or in the blocks of the accelerator's leaves.
#[derive(Clone, Debug, Default)]
pub(crate) struct Spheres {
    storage: Storage,
    appearances: RunList<AppearanceRun>,
}

/// Where the spheres are.
#[derive(Clone, Debug)]
enum Storage {
    ByNumber(Vec<CompactSphere>),
    /// For each sphere its position in the blocks.
    InBlocks(Vec<u32>),
}

impl Default for Storage {
    fn default() -> Self {
        Self::ByNumber(Vec::new())
    }
}

impl Spheres {
    /// Appends a sphere and returns its number.
    pub(crate) fn push(&mut self, sphere: CompactSphere, appearance: Appearance) -> u32 {
        let number = self.appearances.len() as u32;
        if let Storage::ByNumber(list) = &mut self.storage {
            list.push(sphere);
            self.appearances.push(appearance);
        }
        number
    }

    /// A sphere; `blocks` are the group's blocks of spheres, to which it may have been moved.
    #[inline(always)]
    pub(crate) fn get(&self, number: u32, blocks: &[SphereBlock]) -> Sphere {
        match &self.storage {
            Storage::ByNumber(list) => list[number as usize].sphere(),
            Storage::InBlocks(places) => {
                let place = places[number as usize] as usize;
                blocks[place / BLOCK].sphere(place % BLOCK)
            }
        }
    }

    /// A sphere that is not yet in a block.
    pub(crate) fn loose(&self, number: u32) -> Sphere {
        self.get(number, &[])
    }

    /// Object and material of a sphere.
    #[inline]
    pub(crate) fn appearance(&self, number: u32) -> Appearance {
        self.appearances.at(number)
    }

    /// The spheres without their coordinates, if the blocks made for these slots contain all of them; `place` gives the index of a block
    /// of slots among the blocks of spheres.
    pub(crate) fn completed(
        self,
        slots: &[u32],
        prims: &RunList<Prim>,
        place: impl Fn(usize) -> usize,
    ) -> Self {
        let mut places = vec![u32::MAX; self.appearances.len()];
        for (slot, id) in slots
            .iter()
            .enumerate()
            .filter(|(_, id)| **id != NO_PRIMITIVE)
        {
            if let PrimKind::Sphere(number) = prims.at(*id).kind() {
                let place = place(slot / BLOCK) * BLOCK + slot % BLOCK;
                places[number as usize] = place as u32;
            }
        }
        let appearances = self.appearances.completed();
        // Spheres whose bounds don't fit f32 are in no block.
        let storage = match places.contains(&u32::MAX) {
            true => self.storage,
            false => Storage::InBlocks(places),
        };
        Self {
            storage,
            appearances,
        }
    }

    /// Bytes they occupy beside the blocks.
    pub(crate) fn bytes(&self) -> usize {
        let own = match &self.storage {
            Storage::ByNumber(list) => size_of_val(list.as_slice()),
            Storage::InBlocks(places) => size_of_val(places.as_slice()),
        };
        own + self.appearances.bytes()
    }
}
