//! What the lists of one thread take while it traces batches of rays.

use super::{TraceSettings, TreeTracer};
use crate::branch::{Branch, Node};
use crate::coverage::Clear;
use strahl_accel::PACKET;
use strahl_shade::Color;

/// Bytes of the lists that a thread has while it traces: the most that one thread of a picture had. Lists keep their memory for the next
/// tile, so it depends on which tiles a thread got.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BatchMemory {
    /// The points that go through the stages, with the layers of their textures: [`PACKET`] of them, and one for paths outside of trees.
    pub points: usize,
    /// The rays of the trees of a batch: those that wait and those that were traced. At most [`BatchMemory::most_for_rays`].
    pub rays: usize,
    /// What shadow rays meet that lets light through, the grids of area lights, and the media that rays are in: as long as the scene makes
    /// them for sixteen rays and sixteen points, however many rays a tile has.
    pub lists: usize,
}

impl BatchMemory {
    /// All of it.
    pub const fn total(&self) -> usize {
        self.points + self.rays + self.lists
    }

    /// The larger parts of two threads.
    pub(crate) fn largest(self, other: Self) -> Self {
        Self {
            points: self.points.max(other.points),
            rays: self.rays.max(other.rays),
            lists: self.lists.max(other.lists),
        }
    }

    /// The bound of [`BatchMemory::rays`]. The trees of a batch have at most [`TraceSettings::max_tree_rays`] rays together, those that wait
    /// included, beside the primary ones; and a list has room for at most twice what it has held.
    pub const fn most_for_rays(settings: &TraceSettings) -> usize {
        let each =
            size_of::<Branch>() + size_of::<Node>() + size_of::<Color>() + size_of::<Clear>();
        2 * each * (settings.max_tree_rays as usize + PACKET)
    }
}

/// The bytes of a list.
pub(crate) fn bytes<T>(list: &Vec<T>) -> usize {
    list.capacity() * size_of::<T>()
}

impl TreeTracer<'_> {
    /// The bytes of its lists, which never get smaller.
    pub(crate) fn memory(&self) -> BatchMemory {
        let paints = self.points.iter().map(|point| {
            let paint = &point.paint;
            bytes(&paint.layers) + bytes(&paint.stacks)
        });
        let shadows = self.packet_hits.iter().map(bytes).sum::<usize>() + bytes(&self.shadow_hits);
        let branches = bytes(&self.mirrors) + bytes(&self.passages) + bytes(&self.arriving);
        BatchMemory {
            points: bytes(&self.points) + paints.sum::<usize>(),
            rays: self.waiting.bytes()
                + self.nodes.bytes()
                + bytes(&self.gathered)
                + self
                    .coverage
                    .as_ref()
                    .map_or(0, |coverage| coverage.bytes()),
            lists: shadows + branches + self.area_memory.bytes() + self.media.bytes(),
        }
    }
}
