//! References to primitives during construction, and the extents of sets of them.

use crate::Shapes;
use crate::boxes::Box32;
use rayon::prelude::*;
use std::sync::atomic::{AtomicBool, Ordering};
use strahl_math::Aabb;

/// Sets larger than this are looked at in parallel, in chunks of this size.
pub(crate) const CHUNK: usize = 16 * 1024;

/// A reference to a primitive during construction: its box, whose fourth lanes hold its number and its class.
#[derive(Clone, Copy)]
pub(crate) struct Ref {
    bounds: Box32,
}

impl Ref {
    pub(crate) fn new(bounds: &Box32, id: u32, class: u8) -> Self {
        let (lo, hi) = (bounds.lo(), bounds.hi());
        Self {
            bounds: Box32::of_corners(lo.with_w(to_lane(id)), hi.with_w(to_lane(u32::from(class)))),
        }
    }

    /// Its parts on both sides of a plane; an empty side has an empty box.
    pub(crate) fn halves(&self, shapes: &dyn Shapes, axis: usize, at: f32) -> [Self; 2] {
        let own = &self.bounds;
        let boxes = if own.is_empty() {
            [Aabb::EMPTY; 2]
        } else {
            shapes.halves(self.id(), &own.to_aabb(), axis, f64::from(at))
        };
        boxes.map(|b| {
            let part = Box32::try_new(&b).map_or(Box32::EMPTY, |b| b.clipped(own));
            Self::new(&part, self.id(), self.class())
        })
    }

    #[inline(always)]
    pub(crate) fn bounds(&self) -> &Box32 {
        &self.bounds
    }

    #[inline(always)]
    pub(crate) fn id(&self) -> u32 {
        from_lane(self.bounds.lo().w)
    }

    /// The largest absolute coordinate.
    fn reach(&self) -> f32 {
        let farthest = self.bounds.lo().abs().max(self.bounds.hi().abs());
        farthest.truncate().max_element()
    }

    /// Leaves hold primitives of one class only.
    #[inline(always)]
    pub(crate) fn class(&self) -> u8 {
        from_lane(self.bounds.hi().w) as u8
    }
}

/// Added to the bits of numbers. Arithmetic on whole vectors includes these lanes, although the results are ignored, and would
/// be many times slower if they were subnormal numbers.
const LANE: u32 = 0x3f80_0000;

/// Stores any number as a lane of a vector.
#[inline(always)]
pub(crate) fn to_lane(number: u32) -> f32 {
    f32::from_bits(number.wrapping_add(LANE))
}

/// The inverse of [`to_lane`].
#[inline(always)]
pub(crate) fn from_lane(lane: f32) -> u32 {
    lane.to_bits().wrapping_sub(LANE)
}

/// The extent of a set: the bounds of its boxes, and the bounds of their (doubled) centres.
#[derive(Clone, Copy)]
pub(crate) struct Extent {
    pub(crate) bounds: Box32,
    pub(crate) centers: Box32,
    /// The classes in it, as bits.
    pub(crate) classes: u8,
}

impl Extent {
    pub(super) const EMPTY: Self = Self {
        bounds: Box32::EMPTY,
        centers: Box32::EMPTY,
        classes: 0,
    };

    pub(crate) fn of(refs: &[Ref]) -> Self {
        let mut extent = Self::EMPTY;
        for r in refs {
            extent.bounds.grow(&r.bounds);
            extent.centers.grow_to(r.bounds.center());
            extent.classes |= 1 << r.class();
        }
        extent
    }

    /// The extent of a large set, computed in parallel: minima and maxima are exact in any grouping, so the result does not
    /// depend on the threads.
    pub(crate) fn of_many(refs: &[Ref]) -> Self {
        if refs.len() <= CHUNK {
            return Self::of(refs);
        }
        let parts = refs.par_chunks(CHUNK).map(Self::of);
        parts.reduce(|| Self::EMPTY, Self::joined)
    }

    /// Its lowest class; a leaf has only one.
    pub(crate) fn lowest_class(&self) -> u8 {
        self.classes.trailing_zeros() as u8
    }

    fn joined(mut self, other: Self) -> Self {
        self.bounds.grow(&other.bounds);
        self.centers.grow(&other.centers);
        self.classes |= other.classes;
        self
    }
}

/// So many primitives, at most, are taken out of the tree because they reach far beyond all others.
const MOST_FAR: usize = 8;

/// What reaches this many times as far as all others is taken out of the tree.
const FAR: f32 = 512.0;

/// The references to the bounded ones of `count` primitives, whose box and class `primitive` returns, and the numbers of those
/// without bounds.
pub(crate) fn gather(
    count: usize,
    primitive: impl Fn(u32) -> (Aabb, u8) + Sync,
) -> (Vec<Ref>, Vec<u32>) {
    let one = |id: u32| {
        let (bounds, class) = primitive(id);
        Some(Ref::new(&Box32::try_new(&bounds)?, id, class))
    };
    let all_bounded = AtomicBool::new(true);
    let any = |id: u32| {
        one(id).unwrap_or_else(|| {
            all_bounded.store(false, Ordering::Relaxed);
            Ref::new(&Box32::EMPTY, id, 0)
        })
    };
    let ids = 0..count as u32;
    let mut refs = Vec::with_capacity(count);
    // Here and elsewhere, few primitives are not worth the threads that the first parallel iterator of a program starts.
    if count <= CHUNK {
        refs.extend(ids.map(any));
    } else {
        let all = ids.into_par_iter().with_min_len(CHUNK).map(any);
        all.collect_into_vec(&mut refs);
    }
    let mut unbounded = Vec::new();
    if !all_bounded.into_inner() {
        refs.retain(|r| {
            let bounded = r.bounds.lo().x < f32::INFINITY;
            if !bounded && !primitive(r.id()).0.is_empty() {
                unbounded.push(r.id());
            }
            bounded
        });
    }
    (refs, unbounded)
}

/// Moves what reaches far beyond all others to the primitives that are tested for every ray, as the sphere of a sky around a house: the culling tests must allow for the rounding
/// errors of the largest coordinate, so in a tree with a sky of a million units no box would be smaller than half of one.
pub(crate) fn take_out_far(refs: &mut Vec<Ref>, apart: &mut Vec<u32>) {
    // The farthest reaches, the largest first.
    let mut reaches = [0.0f32; MOST_FAR + 1];
    for r in refs.iter() {
        let reach = r.reach();
        if reach > reaches[MOST_FAR] {
            let place = reaches.partition_point(|other| *other >= reach);
            reaches[place..].rotate_right(1);
            reaches[place] = reach;
        }
    }
    // Where they fall most.
    let falls = reaches.windows(2).map(|pair| pair[0] / pair[1]);
    let falls = falls
        .enumerate()
        .filter(|(_, fall)| *fall >= FAR && fall.is_finite());
    let Some((last, _)) = falls.max_by(|(_, a), (_, b)| a.total_cmp(b)) else {
        return;
    };
    let least = reaches[last];
    refs.retain(|r| {
        let is_far = r.reach() >= least;
        if is_far {
            apart.push(r.id());
        }
        !is_far
    });
}

/// The bounds of the doubled centres of primitives.
pub(super) fn centers(refs: &[Ref]) -> Box32 {
    let mut span = Box32::EMPTY;
    for r in refs {
        span.grow_to(r.bounds.center());
    }
    span
}

/// The classes of primitives, as bits.
pub(super) fn classes(refs: &[Ref]) -> u8 {
    refs.iter().fold(0, |all, r| all | 1 << r.class())
}

#[cfg(test)]
mod tests {
    use super::*;
    use strahl_math::DVec3;

    /// The numbers of those boxes that are taken out; the boxes reach so far.
    fn apart(reaches: &[f64]) -> Vec<u32> {
        let boxes: Vec<Aabb> = reaches
            .iter()
            .map(|reach| Aabb::new(DVec3::splat(-reach), DVec3::splat(reach * 0.5)))
            .collect();
        let (mut refs, mut apart) = gather(boxes.len(), |id| (boxes[id as usize], 0));
        take_out_far(&mut refs, &mut apart);
        assert_eq!(refs.len() + apart.len(), boxes.len());
        apart
    }

    #[test]
    fn what_reaches_far_beyond_all_others_is_taken_out() {
        assert_eq!(apart(&[1.0, 1e6, 2.0, 1.5]), [1]);
        assert_eq!(apart(&[1.0, 1e6, 2.0, 1e5, 1.5, 1e8]), [1, 3, 5]);
        assert_eq!(apart(&[1.0, f64::INFINITY, 1e6]), [1, 2]);
        // Not far enough, too many, nothing else.
        assert_eq!(apart(&[1.0, 500.0, 3.0]), []);
        let mut many = vec![1e6; MOST_FAR + 1];
        many.extend([1.0; 20]);
        assert_eq!(apart(&many), []);
        many.remove(0);
        assert_eq!(apart(&many).len(), MOST_FAR);
        assert_eq!(apart(&[1e6, 1e6]), []);
        assert_eq!(apart(&[0.0, 1e6]), []);
        assert_eq!(apart(&[]), []);
    }
}
