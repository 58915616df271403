use crate::appearance::{Appearance, AppearanceRun};
use crate::prim::{Prim, PrimKind};
use crate::runs::RunList;
use strahl_accel::{BLOCK, NO_PRIMITIVE};
use strahl_geometry::Sphere;
use strahl_geometry::blocks::SphereBlock;
use strahl_math::DVec3;

/// A sphere that is seen from outside and whose texture is not rotated: scenes have millions of them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PlainSphere {
    center: DVec3,
    radius: f64,
}

impl PlainSphere {
    /// The compact form of a sphere, if it has one.
    pub(crate) fn of(sphere: &Sphere) -> Option<Self> {
        let plain = sphere.radius() > 0.0 && !sphere.is_turned();
        plain.then(|| Self {
            center: sphere.center(),
            radius: sphere.radius(),
        })
    }

    #[inline(always)]
    fn sphere(self) -> Sphere {
        Sphere::new(self.center, self.radius)
    }
}

/// The plain spheres of a group, each stored once: in a list, or in the blocks of the accelerator's leaves.
#[derive(Clone, Debug, Default)]
pub(crate) struct Spheres {
    kept: Kept,
    appearances: RunList<AppearanceRun>,
}

#[derive(Clone, Debug)]
enum Kept {
    ByNumber(Vec<PlainSphere>),
    /// For each sphere its position in the blocks.
    InBlocks(Vec<u32>),
}

impl Default for Kept {
    fn default() -> Self {
        Self::ByNumber(Vec::new())
    }
}

impl Spheres {
    /// Appends a sphere and returns its number.
    pub(crate) fn push(&mut self, sphere: PlainSphere, appearance: Appearance) -> u32 {
        let number = self.appearances.len() as u32;
        if let Kept::ByNumber(list) = &mut self.kept {
            list.push(sphere);
            self.appearances.push(appearance);
        }
        number
    }

    /// A sphere; `blocks` are the group's blocks of spheres, to which it may have been moved.
    #[inline(always)]
    pub(crate) fn get(&self, number: u32, blocks: &[SphereBlock]) -> Sphere {
        match &self.kept {
            Kept::ByNumber(list) => list[number as usize].sphere(),
            Kept::InBlocks(places) => {
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
        let kept = match places.contains(&u32::MAX) {
            true => self.kept,
            false => Kept::InBlocks(places),
        };
        Self { kept, appearances }
    }

    /// Bytes they occupy beside the blocks.
    pub(crate) fn bytes(&self) -> usize {
        let kept = match &self.kept {
            Kept::ByNumber(list) => size_of_val(list.as_slice()),
            Kept::InBlocks(places) => size_of_val(places.as_slice()),
        };
        kept + self.appearances.bytes()
    }
}
