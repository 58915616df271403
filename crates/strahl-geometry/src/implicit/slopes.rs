//! Bounds of the derivatives of a function in the cells of an octree, found once enough rays have asked for them.

use std::sync::OnceLock;
use std::sync::atomic::{AtomicU8, Ordering};
use strahl_function::Bounds;
use strahl_math::DVec3;

/// Bounds of a function's derivatives by x, y and z within a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Slopes([[f32; 2]; 3]);

impl Slopes {
    /// The slopes with these bounds, a little wider: by more than [`along`](Self::along) rounds.
    pub(crate) fn around(bounds: [Bounds; 3]) -> Self {
        Self(bounds.map(|slope| {
            if slope.nan {
                return [f32::NEG_INFINITY, f32::INFINITY];
            }
            [(slope.min as f32).next_down(), (slope.max as f32).next_up()]
        }))
    }

    /// Bounds of the derivative along a direction; `None` if there are none.
    pub(crate) fn along(&self, direction: DVec3) -> Option<Bounds> {
        let (mut min, mut max) = (0.0, 0.0);
        for (slope, way) in self.0.iter().zip(direction.to_array()) {
            let (a, b) = (way * f64::from(slope[0]), way * f64::from(slope[1]));
            let (low, high) = if a < b { (a, b) } else { (b, a) };
            min += low;
            max += high;
        }
        // Neither infinite nor what infinities make.
        (max - min < f64::INFINITY).then_some(Bounds::new(min, max))
    }
}

/// The number of rays that search a cell without its slopes. Finding the slopes takes as long as they save a few rays, and in small pictures
/// few rays meet a cell.
const ASKED_IN_VAIN: u8 = 4;

/// The slopes in 64 cells, as far as they are known.
#[derive(Debug)]
pub(super) struct Notes([Note; 64]);

#[derive(Debug, Default)]
struct Note {
    /// The number of rays that have asked before the slopes were known. Threads that ask at once may count as one, which only costs time.
    asked: AtomicU8,
    slopes: OnceLock<Slopes>,
}

impl Default for Notes {
    fn default() -> Self {
        Self(std::array::from_fn(|_| Note::default()))
    }
}

impl Notes {
    /// The slopes in a cell, which `find` finds if enough have asked. They must depend on the cell alone.
    pub(super) fn slopes(&self, cell: usize, find: impl FnOnce() -> Slopes) -> Option<&Slopes> {
        let note = &self.0[cell];
        if let Some(slopes) = note.slopes.get() {
            return Some(slopes);
        }
        let asked = note.asked.load(Ordering::Relaxed);
        if asked < ASKED_IN_VAIN {
            note.asked.store(asked + 1, Ordering::Relaxed);
            return None;
        }
        Some(note.slopes.get_or_init(find))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slopes_along_a_direction_bound_all_sums() {
        let bounds = [(-1.0, 0.5), (2.0, 3.0), (1e-3, 1e-3)].map(|(a, b)| Bounds::new(a, b));
        let way = DVec3::new(2.0, -1.0, 0.1);
        let found = Slopes::around(bounds).along(way).expect("finite slopes");
        let exact = Bounds::new(-5.0 + 1e-4, -1.0 + 1e-4);
        assert!(found.min < exact.min && found.max > exact.max, "{found:?}");
        assert!(found.max - found.min < 4.000_01, "{found:?}");
        for unknown in [Bounds::UNKNOWN, Bounds::ENTIRE, Bounds::new(0.0, 1e300)] {
            let slopes = Slopes::around([bounds[0], unknown, bounds[2]]);
            assert_eq!(slopes.along(way), None);
            assert_eq!(slopes.along(DVec3::X), None);
        }
    }

    #[test]
    fn slopes_are_found_once_and_when_enough_have_asked() {
        let notes = Notes::default();
        let some = Slopes::around([Bounds::new(0.0, 1.0); 3]);
        for _ in 0..ASKED_IN_VAIN {
            assert_eq!(notes.slopes(7, || unreachable!()), None);
        }
        assert_eq!(notes.slopes(7, || some), Some(&some));
        assert_eq!(notes.slopes(7, || unreachable!()), Some(&some));
        assert_eq!(notes.slopes(8, || unreachable!()), None);
    }
}
