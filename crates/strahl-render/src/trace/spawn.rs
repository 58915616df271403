//! The branches of a hit: the last stage.

use super::point::{Lanes, Point};
use super::{Branch, TreeTracer};
use crate::branch::Offshoot;
use crate::hit::RayClass;
use crate::layers::{self, Mirror, Passage};
use crate::observer::{BranchEnd, RayKind, Share, TraceObserver};
use crate::surface::{Split, Surface};
use strahl_math::Ray;
use strahl_shade::SpectralPart;

impl<'s> TreeTracer<'s> {
    /// Queues the rays that surfaces send, and stores the light that they send by themselves.
    pub(super) fn branch<O: TraceObserver>(
        &mut self,
        points: &[Point<'s>],
        lanes: &Lanes,
        observer: &mut O,
    ) {
        for lane in lanes {
            let point = &points[*lane];
            self.nodes[point.node as usize].local = layers::grained(&point.surface, point.local);
            if O::DETAILED || !point.surface.is_dull {
                let split = self.split(point);
                self.queue_branches(point, &split, observer);
            }
        }
    }

    /// Divides the light at a surface.
    #[inline]
    pub(super) fn split(&mut self, point: &Point<'s>) -> Split {
        let Point {
            branch,
            surface,
            paint,
            ..
        } = point;
        let mut split = surface.split(&branch.ray);
        if let Some(inside) = surface.fading() {
            split.fade = self.intersector.scene.faded(inside, point.length);
        }
        if paint.stacks.len() > 1 && !surface.material.finish.transmission.is_black() {
            layers::passages(paint, surface, &branch.ray, split.fade, &mut self.passages);
            (split.kr, split.kt) = layers::sums_of_passages(paint, &self.passages);
        } else if split.total_reflection && !paint.layers.is_empty() {
            // As in POV-Ray (measured): total reflection ignores colour and finish, and fades like light that passes.
            split.kr = split.fade;
        }
        split
    }

    /// Queues the reflected and transmitted rays of a surface; the reflection ray is traced first.
    fn queue_branches<O: TraceObserver>(
        &mut self,
        point: &Point<'s>,
        split: &Split,
        observer: &mut O,
    ) {
        let Point {
            branch,
            surface,
            paint,
            ..
        } = point;
        let first = self.waiting.len();
        let mut mirrors = std::mem::take(&mut self.mirrors);
        if paint.stacks.len() > 1 && !surface.material.finish.transmission.is_black() {
            let passages = std::mem::take(&mut self.passages);
            for passage in passages.iter().rev() {
                self.queue_passage(point, passage, observer);
            }
            if passages.iter().all(|passage| passage.direction.is_some()) {
                layers::mirrors(paint, surface, split, &mut mirrors);
            } else {
                layers::mirrors_of_passages(paint, surface, &passages, &mut mirrors);
            }
            self.passages = passages;
        } else {
            let only = Passage {
                normal: surface.n_refract,
                direction: split.refracted,
                kt: split.kt,
                fade: split.fade,
                share: 1.0,
                weight: match paint.stacks.first() {
                    None => split.kt.max_component(),
                    Some(stack) => stack.weight,
                },
            };
            self.queue_passage(point, &only, observer);
            layers::mirrors(paint, surface, split, &mut mirrors);
        }
        for mirror in mirrors.iter().rev() {
            let Mirror {
                share,
                direction,
                weight,
            } = *mirror;
            let mirrored = Offshoot {
                coefficient: weight,
                ..Offshoot::new(RayKind::Reflection, share, direction, branch.part)
            };
            self.queue(point, &mirrored, observer);
        }
        self.mirrors = mirrors;
        let siblings = &mut self.waiting[first..];
        if siblings.len() > 2 {
            keep_order(siblings);
        }
    }

    /// Queues the transparency ray of a passage, or the rays of the parts of its spectrum.
    ///
    /// As in POV-Ray (measured) neither fading nor the share of a part of the spectrum counts for the weight.
    #[inline(always)]
    fn queue_passage<O: TraceObserver>(
        &mut self,
        point: &Point<'s>,
        passage: &Passage,
        observer: &mut O,
    ) {
        let Point {
            branch, surface, ..
        } = point;
        let Some(direction) = passage.direction else {
            return;
        };
        let through = Share {
            factor: passage.kt * passage.fade,
            power: 1.0,
        };
        let parts = self.parts_behind(branch, surface);
        if parts == 0 {
            let whole = Offshoot {
                coefficient: passage.weight,
                ..Offshoot::new(RayKind::Refraction, through, direction, branch.part)
            };
            self.queue(point, &whole, observer);
        }
        for part in SpectralPart::all(parts) {
            let bent = surface.bent_part(self.intersector.scene, passage.normal, part);
            let direction = bent.unwrap_or_else(|| surface.mirrored(passage.normal));
            let offshoot = Offshoot {
                divided: true,
                returned: bent.is_none(),
                coefficient: passage.weight,
                ..Offshoot::new(RayKind::Refraction, through, direction, part)
            };
            self.queue(point, &offshoot, observer);
        }
    }

    /// The number of spectral parts into which a branch is split behind a surface; 0 if it is not.
    #[inline]
    fn parts_behind(&self, branch: &Branch, surface: &Surface<'_>) -> u16 {
        if self.intersector.scene.disperses && branch.part.is_white() {
            surface.spectral_parts(self.intersector.scene)
        } else {
            0
        }
    }

    /// Queues a branch, unless a limit is reached.
    #[inline(always)]
    pub(super) fn queue<O: TraceObserver>(
        &mut self,
        point: &Point<'s>,
        offshoot: &Offshoot,
        observer: &mut O,
    ) {
        let Offshoot {
            kind, direction, ..
        } = *offshoot;
        let Point {
            branch,
            surface,
            hit,
            node,
            ..
        } = point;
        let weight = branch.weight * offshoot.coefficient;
        let end = if branch.depth >= self.settings.max_depth {
            Some(BranchEnd::DepthLimit)
        } else if weight < self.settings.adc_bailout {
            Some(BranchEnd::WeightCutoff)
        } else if self.nodes.len() + self.waiting.len() >= self.settings.max_tree_rays as usize {
            Some(BranchEnd::TreeLimit)
        } else {
            None
        };
        if let Some(end) = end {
            self.counts.cut_trees += u64::from(end == BranchEnd::TreeLimit);
            if O::DETAILED {
                observer.ended(*node, kind, weight, end);
            }
            return;
        }
        let media = match kind {
            RayKind::Refraction if !offshoot.returned => {
                surface.media_behind(branch.media, &mut self.media)
            }
            _ => branch.media,
        };
        let straight = kind == RayKind::Refraction && surface.is_straight();
        let (start, origin) = surface.start(hit, direction);
        let class_here = match kind {
            RayKind::Refraction if !offshoot.returned => branch.class,
            _ => RayClass::Secondary,
        };
        let depth_here = branch.depth + u32::from(self.settings.straight_counts || !straight);
        // Field by field, and all of them: the slot has another ray.
        let Branch {
            ray,
            origin: from,
            kind: of_kind,
            class,
            parent,
            depth,
            part,
            divided,
            ordered,
            weight: with_weight,
            share,
            media: within,
        } = self.waiting.add(&Branch::NONE);
        (*ray, *from) = (Ray::new(start, direction), Some(origin));
        (*of_kind, *class, *parent, *depth) = (kind, class_here, *node, depth_here);
        (*part, *divided) = (offshoot.part, offshoot.divided);
        *ordered = kind == RayKind::Gather;
        (*with_weight, *share, *within) = (weight, offshoot.share, media);
    }
}

/// Lets none of the rays of a hit overtake another if three or more are of one kind.
#[cold]
fn keep_order(siblings: &mut [Branch]) {
    let is_mirrored = |branch: &&Branch| branch.kind == RayKind::Reflection;
    let mirrored = siblings.iter().filter(is_mirrored).count();
    if mirrored.max(siblings.len() - mirrored) > 2 {
        for branch in siblings {
            branch.ordered = true;
        }
    }
}
