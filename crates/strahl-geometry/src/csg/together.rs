//! Trees and the rays of a packet: each ray goes through the tree by itself, with what the packet knows of boxes and leaves.
//!
//! A ray is inside of a node along a few spans (Roth, "Ray casting for modeling solids", 1982); an operation combines those of its operands. As in
//! [`first`](super::first) crossings that could coincide are left to the general evaluation, so both give the same bits.

use super::compiled::Csg;
use super::fusing::TooClose;
use super::lines::{Line, Search};
use super::packet_tree::PacketTree;
use super::query::Query;
use crate::{PrimHit, Scratch, SurfaceId};
use std::ops::ControlFlow;
use strahl_math::{Interval, Ray};

impl PacketTree {
    /// The first hit of the ray at a place on the tree in its range, as [`Primitive::closest_hit`](crate::Primitive::closest_hit) finds it; `None` if only
    /// that function knows. The ray is in the tree's space.
    pub fn closest(
        &self,
        csg: &Csg,
        place: usize,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        scratch: &mut Scratch,
    ) -> Option<Option<PrimHit>> {
        let mut first = None;
        let sure = self.visit(csg, place, ray, range, from, scratch, |hit| {
            first = Some(hit);
            false
        });
        sure.is_ok().then_some(first)
    }

    /// Appends all hits of the ray at a place on the tree, as [`Primitive::all_hits`](crate::Primitive::all_hits) does; false if only that function
    /// knows, after some may have been appended.
    #[expect(
        clippy::too_many_arguments,
        reason = "a query and where its results go"
    )]
    pub fn all(
        &self,
        csg: &Csg,
        place: usize,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        scratch: &mut Scratch,
        out: &mut Vec<PrimHit>,
    ) -> bool {
        let sure = self.visit(csg, place, ray, range, from, scratch, |hit| {
            out.push(hit);
            true
        });
        sure.is_ok()
    }

    /// Goes along a ray from one visible surface to the next, until `take` returns false.
    #[inline(always)]
    #[expect(
        clippy::too_many_arguments,
        reason = "a query and where its results go"
    )]
    fn visit(
        &self,
        csg: &Csg,
        place: usize,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        scratch: &mut Scratch,
        mut take: impl FnMut(PrimHit) -> bool,
    ) -> Result<(), TooClose> {
        let from = from.map(|surface| csg.leaf_surface(surface));
        let Some(query) = Query::new(ray, range, from) else {
            return Ok(());
        };
        if !self.may_meet(0, place) {
            return match csg.node(0) {
                Some(root) if !root.far => Ok(()),
                _ => Err(TooClose),
            };
        }
        if let Some(small) = csg.small_merge() {
            let mut visit = |hit: PrimHit| {
                let goes_on = !csg.is_seen(hit.surface.element, ray, scratch) || take(hit);
                match goes_on {
                    true => ControlFlow::Continue(()),
                    false => ControlFlow::Break(()),
                }
            };
            return small.visit_merged(csg.all_leaves(), &query, Some((self, place)), &mut visit);
        }
        let mut line = Line::default();
        let mut search = Search {
            csg,
            tree: self,
            place,
            query: &query,
            scratch,
        };
        search.node(0, &mut line)?;
        let followers = line.ends.iter().skip(1).map(|next| next.t);
        for (end, next) in line.ends.iter().zip(followers.chain([f64::INFINITY])) {
            if end.t > query.range.max {
                break;
            }
            query.check_apart(end.t, next)?;
            let Some(leaf) = csg.leaf(end.leaf) else {
                return Err(TooClose);
            };
            let seen =
                leaf.visible && end.t > query.range.min && csg.is_seen(end.element, ray, scratch);
            if !seen {
                continue;
            }
            let mut hit = PrimHit::simple(end.t, end.facet);
            hit.surface.element = end.element;
            if !take(hit) {
                break;
            }
        }
        Ok(())
    }
}
