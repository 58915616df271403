//! The current activity of each thread, for profiles.
//!
//! A thread stores in two numbers of its own what it is doing; another thread reads them again and again. Storing costs about as
//! much as an addition, so it is done always; libraries don't read the clock, so whoever samples decides when.

use crate::observer::RayKind;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

/// The ray that a thread works for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum RayPurpose {
    /// From the eye.
    Primary,
    /// Reflected.
    Reflection,
    /// Transmitted.
    Refraction,
    /// Sent by a method of light transport.
    Gather,
    /// To the light of this number.
    Shadow(u32),
}

/// What a thread does for a ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Phase {
    /// It makes camera rays and combines samples into pixels.
    Sampling,
    /// It goes through an accelerator, and tests triangles, polygons and spheres that are stored side by side.
    Traversal,
    /// It intersects the ray with the primitive of the activity's element.
    Intersection,
    /// It finds point, normal and media of a hit.
    Surface,
    /// It evaluates the texture at a hit.
    Texture,
    /// It computes the light of a hit from its lights, and the rays that leave it.
    Shading,
}

impl Phase {
    const ALL: [Self; 6] = [
        Self::Sampling,
        Self::Traversal,
        Self::Intersection,
        Self::Surface,
        Self::Texture,
        Self::Shading,
    ];
}

/// What a thread is doing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Activity {
    /// The ray it works for.
    pub ray: RayPurpose,
    /// What it does for that ray.
    pub phase: Phase,
    /// The number of the element that it intersects or shades, as in [`Hit::id`](crate::Hit::id), if there is one.
    pub element: Option<u64>,
}

/// The purposes in the lowest bits of a stored purpose; the rest is the number of a light.
const PURPOSE_BITS: u32 = 3;
/// No activity: the thread waits, or does something else.
const IDLE: u64 = 0;
const PRIMARY: u64 = 1;
const REFLECTION: u64 = 2;
const REFRACTION: u64 = 3;
const SHADOW: u64 = 4;
const GATHER: u64 = 5;

/// The bits of a stored element, above which the phase is stored.
const ELEMENT_BITS: u32 = 60;
/// No element.
const NO_ELEMENT: u64 = (1 << ELEMENT_BITS) - 1;

/// Where one thread stores its activity.
// The two numbers are stored one after the other, so that rarely a sample has the ray of one activity and the phase of the next.
#[derive(Debug, Default)]
pub(crate) struct Slot {
    purpose: AtomicU64,
    phase: AtomicU64,
}

impl Slot {
    /// The thread works for a ray of a tree from now on.
    #[inline(always)]
    pub(crate) fn ray(&self, kind: RayKind) {
        let purpose = match kind {
            RayKind::Primary => PRIMARY,
            RayKind::Reflection => REFLECTION,
            RayKind::Refraction => REFRACTION,
            RayKind::Gather => GATHER,
        };
        self.purpose.store(purpose, Ordering::Relaxed);
    }

    /// The thread works for a shadow ray from now on.
    #[inline(always)]
    pub(crate) fn shadow(&self, light: usize) {
        let purpose = SHADOW | (light as u64) << PURPOSE_BITS;
        self.purpose.store(purpose, Ordering::Relaxed);
    }

    /// The thread is in this phase from now on, not for a certain element.
    #[inline(always)]
    pub(crate) fn enter(&self, phase: Phase) {
        self.enter_for(phase, NO_ELEMENT);
    }

    /// The thread is in this phase from now on, for an element.
    #[inline(always)]
    pub(crate) fn enter_for(&self, phase: Phase, element: u64) {
        let number = (phase as u64) << ELEMENT_BITS | element & NO_ELEMENT;
        self.phase.store(number, Ordering::Relaxed);
    }

    /// The thread does nothing from now on.
    pub(crate) fn idle(&self) {
        self.purpose.store(IDLE, Ordering::Relaxed);
    }

    fn activity(&self) -> Option<Activity> {
        let purpose = self.purpose.load(Ordering::Relaxed);
        let phase = self.phase.load(Ordering::Relaxed);
        let light = (purpose >> PURPOSE_BITS) as u32;
        let ray = match purpose & ((1 << PURPOSE_BITS) - 1) {
            PRIMARY => RayPurpose::Primary,
            REFLECTION => RayPurpose::Reflection,
            REFRACTION => RayPurpose::Refraction,
            GATHER => RayPurpose::Gather,
            SHADOW => RayPurpose::Shadow(light),
            _ => return None,
        };
        let element = phase & NO_ELEMENT;
        Some(Activity {
            ray,
            phase: *Phase::ALL.get((phase >> ELEMENT_BITS) as usize)?,
            element: (element != NO_ELEMENT).then_some(element),
        })
    }
}

/// The activities of the threads that trace a picture ([`Progress::activities`](crate::Progress::activities)).
#[derive(Debug, Default)]
pub struct Activities {
    slots: Mutex<Vec<Arc<Slot>>>,
}

impl Activities {
    /// No thread is known yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// The place for the activity of one more thread, which it gives back by dropping it.
    pub(crate) fn slot(&self) -> Arc<Slot> {
        let mut slots = self.slots.lock().unwrap_or_else(PoisonError::into_inner);
        // One that nobody else has is free.
        if let Some(free) = slots.iter().find(|slot| Arc::strong_count(slot) == 1) {
            return Arc::clone(free);
        }
        let slot = Arc::<Slot>::default();
        slots.push(Arc::clone(&slot));
        slot
    }

    /// What each thread is doing at this moment. Threads without work are left out.
    pub fn now(&self) -> Vec<Activity> {
        let slots = self.slots.lock().unwrap_or_else(PoisonError::into_inner);
        slots.iter().filter_map(|slot| slot.activity()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stored_activity_is_read_again() {
        let activities = Activities::new();
        let slot = activities.slot();
        assert_eq!(activities.now(), []);
        let read = || activities.now()[0];
        let purposes = [
            (RayKind::Primary, RayPurpose::Primary),
            (RayKind::Reflection, RayPurpose::Reflection),
            (RayKind::Refraction, RayPurpose::Refraction),
            (RayKind::Gather, RayPurpose::Gather),
        ];
        for (kind, ray) in purposes {
            slot.ray(kind);
            for phase in Phase::ALL {
                slot.enter(phase);
                let element = None;
                assert_eq!(
                    read(),
                    Activity {
                        ray,
                        phase,
                        element
                    }
                );
                slot.enter_for(phase, 1 << 40);
                assert_eq!(read().element, Some(1 << 40));
            }
        }
        slot.shadow(0);
        assert_eq!(read().ray, RayPurpose::Shadow(0));
        slot.shadow(70_000);
        assert_eq!(read().ray, RayPurpose::Shadow(70_000));
        slot.idle();
        assert_eq!(activities.now(), []);
    }

    #[test]
    fn places_are_used_again() {
        let activities = Activities::new();
        let (first, second) = (activities.slot(), activities.slot());
        assert!(!Arc::ptr_eq(&first, &second));
        drop(first);
        let third = activities.slot();
        assert!(!Arc::ptr_eq(&third, &second));
        assert_eq!(activities.slots.lock().unwrap().len(), 2);
    }
}
