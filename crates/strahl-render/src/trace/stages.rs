//! The stages: rays to hits, hits to points on surfaces, points to colours. Lights and branches have files of their own.
//!
//! ```text
//! repeat until no rays wait
//!   take       up to sixteen rays that wait, those of one octant first
//!   intersect  rays to hits
//!   enter      a node for each ray; rays without a hit see the background
//!   paint      hits to points with a normal, layers and coefficients
//!   light      light by light: which points face it, shadow rays, reflected light
//!   gather     light that a method of light transport finds, if there is one
//!   branch     reflection and transparency rays, which wait
//! ```
//!
//! A stage does with each ray what it would do with that ray alone, so the number of rays that go together changes no bit.

use super::aim::Speeds;
use super::colors::find_colors;
use super::point::{Lanes, Point};
use super::starts::find_starts;
use super::{Branch, FirstHit, Node, TreeTracer};
use crate::activity::Phase;
use crate::hit::{Hit, RayClass};
use crate::layers;
use crate::observer::{BranchEnd, HitReport, RayKind, RayReport, Shading, TraceObserver};
use crate::query::PACKET_MIN;
use crate::surface::Split;
use arrayvec::ArrayVec;
use strahl_accel::PACKET;
use strahl_math::{Interval, Ray};
use strahl_shade::Color;

/// How many of the rays that wait are looked through for some that go together well.
const NEAR_THE_END: usize = 64;

impl<'s> TreeTracer<'s> {
    /// Grows the trees of the first `count` rays, `width` rays at a time. Returns `false` if it left off because there are too many of them:
    /// one of several trees may have as many rays as allowed.
    pub(super) fn grow<O: TraceObserver>(
        &mut self,
        count: usize,
        width: usize,
        observer: &mut O,
    ) -> bool {
        let mut points = std::mem::take(&mut self.points);
        let mut finished = true;
        let mut count = count;
        while finished && count > 0 {
            let mut hits = [None; PACKET];
            self.intersect(&points[..count], &mut hits);
            let mut lanes = self.enter(&mut points[..count], &hits[..count], observer);
            self.paint(&mut points, &mut lanes, observer);
            self.light(&mut points, &lanes, observer);
            if self.transport.gather.is_some() {
                self.gather(&points, &lanes, observer);
            }
            self.branch(&points, &lanes, observer);
            finished = width == 1 || self.nodes.len() + self.waiting.len() < self.limit();
            count = self.take(width, &mut points);
        }
        self.points = points;
        finished
    }

    /// The number of rays from which on trees are grown one by one, because one of them may have as many as allowed.
    fn limit(&self) -> usize {
        const MOST: u32 = 1 << 16;
        self.settings.max_tree_rays.min(MOST) as usize
    }

    /// Takes rays that wait: of the last [`NEAR_THE_END`] first those with the octant of the last one, which meet the same nodes in the same
    /// order, then the last ones.
    fn take(&mut self, width: usize, points: &mut Vec<Point<'s>>) -> usize {
        let mut count = 0;
        let mut keep = |branch: &Branch| {
            if count == points.len() {
                points.push(Point::unknown(&self.blank));
            }
            points[count].branch = *branch;
            count += 1;
            count < width
        };
        let all = self.waiting.len();
        let near = all.saturating_sub(NEAR_THE_END)..all;
        if width > 1
            && all > width
            && let Some(octant) = self.waiting.last().map(octant_of)
            && !self.waiting[near.clone()]
                .iter()
                .any(|branch| branch.ordered)
        {
            for index in near.rev() {
                if octant_of(&self.waiting[index]) == octant {
                    let goes_on = keep(&self.waiting[index]);
                    self.waiting.swap_remove(index);
                    if !goes_on {
                        return count;
                    }
                }
            }
        }
        while let Some(next) = self.waiting.take() {
            if !keep(next) {
                break;
            }
        }
        count
    }

    /// The nearest hits of rays: those of one class together, if they are not too few.
    fn intersect(&mut self, points: &[Point<'s>], hits: &mut [Option<Hit>; PACKET]) {
        for class in [RayClass::Camera, RayClass::Secondary] {
            let of_class = |lane: &usize| points[*lane].branch.class == class;
            let lanes: Lanes = (0..points.len()).filter(of_class).collect();
            if lanes.len() == points.len() && lanes.len() >= PACKET_MIN {
                self.intersect_together(points, &lanes, hits);
                return;
            }
            if lanes.len() >= PACKET_MIN {
                let mut found = [None; PACKET];
                self.intersect_together(points, &lanes, &mut found);
                for (lane, hit) in lanes.iter().zip(found) {
                    hits[*lane] = hit;
                }
                continue;
            }
            for lane in lanes {
                let branch = &points[lane].branch;
                self.intersector.slot.ray(branch.kind);
                let from = branch.origin.as_ref();
                hits[lane] =
                    self.intersector
                        .closest_hit(&branch.ray, Interval::FORWARD, from, class);
            }
        }
    }

    /// The nearest hits of rays of one class, one behind the other.
    #[inline(never)]
    fn intersect_together(
        &mut self,
        points: &[Point<'s>],
        lanes: &Lanes,
        hits: &mut [Option<Hit>; PACKET],
    ) {
        let (mut rays, mut from) = (ArrayVec::<Ray, PACKET>::new(), [None; PACKET]);
        for (from, lane) in from.iter_mut().zip(lanes) {
            *from = points[*lane].branch.origin.as_ref();
            rays.push(points[*lane].branch.ray);
        }
        let first = &points[lanes[0]].branch;
        self.intersector.slot.ray(first.kind);
        self.intersector
            .closest_hits(&rays, Interval::FORWARD, &from, first.class, hits);
    }

    /// Makes the nodes of rays, and finds out about the surfaces that they meet. The others see the background.
    fn enter<O: TraceObserver>(
        &mut self,
        points: &mut [Point<'s>],
        hits: &[Option<Hit>],
        observer: &mut O,
    ) -> Lanes {
        let scene = self.intersector.scene;
        let mut lanes = Lanes::new();
        // Three short loops: while a point waits for a square root or a division, the processor goes on with the next point.
        for (point, hit) in points.iter_mut().zip(hits) {
            if let Some(hit) = hit {
                self.intersector.slot.enter_for(Phase::Surface, hit.id);
                point.surface.find(scene, &point.branch, hit, self.uv);
            }
        }
        let speeds = Speeds::of(points);
        for (lane, (point, hit)) in points.iter_mut().zip(hits).enumerate() {
            let branch = &point.branch;
            self.deepest = self.deepest.max(branch.depth);
            if hit.is_none() && branch.kind == RayKind::Primary && !O::ACTIVE {
                self.roots[branch.parent as usize % PACKET] = self.miss_along(branch);
                continue;
            }
            self.counts.count(branch.kind, hit.is_some());
            let (speed, per_speed) = speeds.get(lane);
            let length = hit.map_or(f64::INFINITY, |h| h.t * speed);
            let (attenuation, fog) = self.in_front(branch, length);
            point.node = self.nodes.len() as u32;
            // Field by field, and all of them: the slot has another node.
            let Node {
                parent,
                kind,
                local,
                share,
                reflected,
                transmitted,
                attenuation: keeps,
                fog: adds,
            } = self.nodes.add(&Node::NONE);
            (*parent, *kind, *share) = (branch.parent, branch.kind, branch.share);
            (*local, *reflected, *transmitted) = (Color::BLACK, Color::BLACK, Color::BLACK);
            (*keeps, *adds) = (attenuation, fog);
            match hit {
                Some(hit) => {
                    if let Some(coverage) = &mut self.coverage {
                        coverage.enter();
                    }
                    self.intersector.slot.enter_for(Phase::Surface, hit.id);
                    point.hit = *hit;
                    point.length = length;
                    point
                        .surface
                        .find_sides(scene, branch, per_speed, hit, &self.media);
                    lanes.push(lane);
                }
                None => {
                    let direction = branch.ray.direction;
                    *local = match &mut self.coverage {
                        Some(coverage) => coverage.enter_miss(direction),
                        None => scene.opaque_background.along(direction),
                    };
                }
            }
            if O::ACTIVE && hit.is_none() {
                let seen = self.nodes[point.node as usize].local;
                observer.ray(self.ray_report(point, None, Some(seen)));
            }
        }
        find_starts(points, &lanes);
        lanes
    }

    /// Evaluates the textures of surfaces. Leaves out the lanes that need no light.
    fn paint<O: TraceObserver>(
        &mut self,
        points: &mut [Point<'s>],
        lanes: &mut Lanes,
        observer: &mut O,
    ) {
        let scene = self.intersector.scene;
        find_colors(scene, points, lanes, &self.paints);
        lanes.retain(|lane| {
            let point = &mut points[*lane];
            self.intersector
                .slot
                .enter_for(Phase::Texture, point.hit.id);
            let Point {
                surface,
                hit,
                paint,
                ..
            } = point;
            layers::paint(scene, surface, hit, paint, &mut self.paints);
            self.intersector
                .slot
                .enter_for(Phase::Shading, point.hit.id);
            let surface = &point.surface;
            point.model = self.model_of(surface);
            let diagnostic = point.model.is_diagnostic();
            if diagnostic || self.keeps_first && point.branch.kind == RayKind::Primary {
                self.first_hit(point);
            }
            if O::ACTIVE {
                self.report_hit(point, observer);
            }
            let finish = &point.surface.material.finish;
            point.local = finish.ambient * scene.ambient + finish.emission;
            !diagnostic
        });
    }

    /// Takes note of what a primary ray met, and of what a diagnostic shading model shows of a hit.
    #[cold]
    fn first_hit(&mut self, point: &Point<'s>) {
        let surface = &point.surface;
        let first = FirstHit {
            distance: point.length,
            position: surface.resolved.point.position,
            normal: surface.n_shade,
            object: surface.resolved.appearance.object,
            material: surface.resolved.appearance.material,
        };
        if point.branch.kind == RayKind::Primary {
            self.first = Some(first);
        }
        if point.model.is_diagnostic() {
            self.nodes[point.node as usize].local =
                surface.diagnose(self.intersector.scene, point.model, &first);
        }
    }

    /// Tells an observer about a hit.
    #[cold]
    fn report_hit<O: TraceObserver>(&mut self, point: &Point<'s>, observer: &mut O) {
        let (surface, model) = (&point.surface, point.model);
        if model.is_diagnostic() {
            let shading = Shading::Model(model);
            let scene = self.intersector.scene;
            let seen = O::DETAILED.then(|| surface.report(scene, &point.hit, Split::NONE, shading));
            observer.ray(self.ray_report(point, seen, None));
            return;
        }
        let split = self.split(point);
        let seen = O::DETAILED.then(|| self.hit_report(point, split));
        let total = seen.as_ref().is_some_and(|seen| seen.total_reflection);
        observer.ray(self.ray_report(point, seen, None));
        if total {
            let end = BranchEnd::TotalReflection;
            observer.ended(point.node, RayKind::Refraction, 0.0, end);
        }
    }

    /// All there is to tell of a ray: of its hit, or of the background that it sees.
    #[cold]
    fn ray_report(
        &self,
        point: &Point<'s>,
        hit: Option<HitReport>,
        background: Option<Color>,
    ) -> RayReport {
        let (branch, node) = (&point.branch, &self.nodes[point.node as usize]);
        RayReport {
            node: point.node,
            parent: branch.parent,
            kind: branch.kind,
            depth: branch.depth,
            weight: branch.weight,
            share: branch.share,
            ray: branch.ray,
            hit,
            background,
            medium: self.media.top(branch.media),
            attenuation: node.attenuation,
            fog: node.fog,
            part: branch.part,
        }
    }
}

/// The octant of a ray's direction: the axes along which it goes down, as bits.
#[inline]
fn octant_of(branch: &Branch) -> u32 {
    let [x, y, z] = branch.ray.direction.to_array().map(|d| u32::from(d < 0.0));
    x | y << 1 | z << 2
}
