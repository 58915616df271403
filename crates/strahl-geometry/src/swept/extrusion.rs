use super::outline::{Cut, Outline, direction, slab};
use super::spans::{WholeLine, first_of_walk, near_the_start};
use crate::primitives::{point_error, start_of};
use crate::{Crossing, Crossings, PrimHit, Scratch, Side, SurfaceId, SurfacePoint};
use std::cmp::Ordering;
use strahl_math::{Aabb, DVec2, DVec3, Interval, Ray};

/// The facet of the cap at the lower height.
pub(super) const LOW_CAP: u32 = 0;
/// The facet of the cap at the upper height.
pub(super) const HIGH_CAP: u32 = 1;
/// The facet of the first piece's wall.
pub(super) const FIRST_WALL: u32 = 2;

/// An outline swept along the z axis from one height to another, for rays in its own space.
///
/// A ray is inside where it is between the two heights and inside of the outline, so its crossings follow from two lists that
/// are each correct by themselves: the heights, and the crossings of the ray's image in the plane with the outline. The state
/// at a cap follows from the walls crossed so far, never from a separate test: walls and caps meet without a crack.
///
/// With `conic` the outline is scaled by the height: it is as drawn at height 1, and a point at 0. The image is then the
/// projection from that point.
///
/// Hits have `uv = [s, side]`: the parameter on the piece, and 1 if the outer side is the right of the curve, else -1.
pub(super) struct Extrusion<'a> {
    pub(super) outline: &'a Outline,
    pub(super) conic: bool,
    pub(super) low: f64,
    pub(super) high: f64,
    /// Whether the caps are visible.
    pub(super) capped: bool,
}

impl Extrusion<'_> {
    pub(super) fn bounds(&self) -> Aabb {
        let [min, max] = self.outline.bounds();
        let scales = if self.conic {
            [self.low, self.high]
        } else {
            [1.0, 1.0]
        };
        let corners = scales.into_iter().zip([self.low, self.high]);
        Aabb::from_points(
            corners.flat_map(|(scale, z)| [min, max].map(|corner| (corner * scale).extend(z))),
        )
    }

    /// The side of the curve that is outside where a ray crosses a wall: 1 for the right, -1 for the left. At this point
    /// `hit.uv[1]` still says whether the curve passes to the left of the ray (1) or to the right (-1).
    pub(super) fn outer_side(&self, ray: &Ray, hit: &PrimHit, enters: bool) -> f64 {
        let [s, rises] = hit.uv;
        if !self.conic {
            // The right side of a curve that gets to the left is in front.
            return if enters { -rises } else { rises };
        }
        // Which side is in front changes at the apex; near it only the normal tells on which side of the apex this is.
        let right = PrimHit {
            uv: [s, 1.0],
            ..*hit
        };
        let in_front = self.wall_normal(&right).dot(ray.direction) >= 0.0;
        if enters == in_front { -1.0 } else { 1.0 }
    }

    /// The ray parameter at which the outline shrinks to a point: at the apex, or infinitely far away.
    fn apex(&self, ray: &Ray) -> f64 {
        if self.conic && ray.direction.z != 0.0 {
            -ray.origin.z / ray.direction.z
        } else {
            f64::NEG_INFINITY
        }
    }

    /// Visits the crossings of the ray's line with the infinite walls. `true` if the line's image is a point inside the outline.
    ///
    /// `uv[1]` of a hit says whether the curve passes to the left of the ray (1) or to the right (-1).
    #[inline(always)]
    fn walls(&self, ray: &Ray, mut visit: impl FnMut(PrimHit)) -> bool {
        let Ray {
            origin: o,
            direction: d,
        } = *ray;
        let cut = if self.conic {
            // The plane through line and apex.
            let normal = o.cross(d);
            Cut {
                normal: normal.truncate(),
                anchor: DVec2::ZERO,
                offset: normal.z,
            }
        } else {
            Cut {
                normal: DVec2::new(-d.y, d.x),
                anchor: o.truncate(),
                offset: 0.0,
            }
        };
        if cut.normal == DVec2::ZERO {
            return if !self.conic {
                self.outline.contains(o.truncate())
            } else {
                d.z != 0.0 && self.outline.contains(d.truncate() / d.z)
            };
        }
        self.outline.crossings(&cut, |crossing| {
            let t = if self.conic {
                // The point on the line whose direction from the apex is that of the curve's.
                let aside = crossing.point.extend(1.0);
                quotient(-aside.cross(o), aside.cross(d))
            } else {
                let way = crossing.point - o.truncate();
                if d.x.abs() >= d.y.abs() {
                    way.x / d.x
                } else {
                    way.y / d.y
                }
            };
            let surface = SurfaceId {
                element: 0,
                facet: FIRST_WALL.saturating_add(crossing.piece),
            };
            let uv = [crossing.s, if crossing.rising { 1.0 } else { -1.0 }];
            visit(PrimHit { t, surface, uv });
        });
        false
    }

    /// Lists the same crossings.
    fn list_walls(&self, ray: &Ray, list: &mut Crossings) -> bool {
        self.walls(ray, |hit| {
            list.list.push(Crossing::new(hit, 0.0, Side::Inner));
        })
    }

    /// Root identity: moves the crossing that the ray starts on to exactly 0.
    fn snap_walls(&self, ray: &Ray, from: Option<SurfaceId>, walls: &mut [Crossing]) {
        let Some(start) = from.and_then(|from| from.facet.checked_sub(FIRST_WALL)) else {
            return;
        };
        let run = self.outline.smooth_run(start);
        let mut nearest: Option<&mut Crossing> = None;
        for wall in walls {
            if self.is_start(ray, &wall.hit, run, nearest.as_ref().map(|best| &best.hit)) {
                nearest = Some(wall);
            }
        }
        if let Some(wall) = nearest {
            wall.hit.t = 0.0;
        }
    }

    /// Whether a crossing may be the start of a ray that lies on a smooth run of walls, and is nearer to it than the best one so far; see
    /// [`snap`](super::spans::snap).
    #[inline]
    fn is_start(&self, ray: &Ray, hit: &PrimHit, run: u32, best: Option<&PrimHit>) -> bool {
        let wall = hit.surface.facet.saturating_sub(FIRST_WALL);
        if best.is_some_and(|best| best.t.abs() <= hit.t.abs())
            || self.outline.smooth_run(wall) != run
        {
            return false;
        }
        let size = self.bounds().size().max_element();
        near_the_start(ray, hit, size, self.wall_normal(hit))
    }

    /// The unit normal of a wall at a hit, on the outer side.
    fn wall_normal(&self, hit: &PrimHit) -> DVec3 {
        let [s, side] = hit.uv;
        let index = hit.surface.facet.saturating_sub(FIRST_WALL);
        let Some(piece) = self.outline.piece(index) else {
            return DVec3::X; // A hit of another shape.
        };
        let along = direction(piece, s);
        let right = DVec2::new(along.y, -along.x) * side;
        let normal = if self.conic {
            right.extend(-right.dot(piece.at(s)))
        } else {
            right.extend(0.0)
        };
        normal.normalize_or(DVec3::X)
    }

    /// Where the line passes the two heights, entering and leaving.
    fn caps(&self, ray: &Ray, from: Option<SurfaceId>) -> Option<[Crossing; 2]> {
        let (o, d) = (ray.origin, ray.direction);
        if !(o.is_finite() && d.is_finite()) || d == DVec3::ZERO {
            return None;
        }
        let heights = slab(o.z, d.z, self.low, self.high)?;
        let (first, last) = if d.z > 0.0 {
            (LOW_CAP, HIGH_CAP)
        } else {
            (HIGH_CAP, LOW_CAP)
        };
        let cap = |t: f64, facet: u32, side: Side| {
            let on_it = from.is_some_and(|from| from.facet == facet);
            let t = if on_it { 0.0 } else { t };
            Crossing::new(PrimHit::simple(t, facet), 0.0, side)
        };
        Some([
            cap(heights.min, first, Side::Enter),
            cap(heights.max, last, Side::Exit),
        ])
    }

    /// Whether the line comes from within the infinite walls: those before the apex have been crossed an odd number of times.
    fn starts_within(&self, ray: &Ray, walls: &[Crossing]) -> bool {
        let apex = self.apex(ray);
        let before = |c: &&Crossing| c.side == Side::Inner && c.hit.t < apex;
        apex > f64::NEG_INFINITY && walls.iter().filter(before).count() % 2 == 1
    }

    /// Fills in what follows from whether the ray gets inside at a crossing.
    fn finish(&self, ray: &Ray, crossing: &mut Crossing, enters: bool) {
        if crossing.side == Side::Inner {
            crossing.hit.uv[1] = self.outer_side(ray, &crossing.hit, enters);
        } else {
            crossing.visible = self.capped;
        }
        crossing.side = if enters { Side::Enter } else { Side::Exit };
    }

    pub(super) fn surface_at(&self, ray: &Ray, hit: &PrimHit) -> SurfacePoint {
        let at = ray.at(hit.t);
        let reach = self.outline.reach().max_element();
        let tallest = self.low.abs().max(self.high.abs());
        let (position, normal) = match hit.surface.facet {
            LOW_CAP => (at.truncate().extend(self.low), DVec3::NEG_Z),
            HIGH_CAP => (at.truncate().extend(self.high), DVec3::Z),
            wall => {
                let piece = self.outline.piece(wall.saturating_sub(FIRST_WALL));
                let on_curve = piece.map_or(DVec2::ZERO, |piece| piece.at(hit.uv[0]));
                let scale = if self.conic { at.z } else { 1.0 };
                ((on_curve * scale).extend(at.z), self.wall_normal(hit))
            }
        };
        let extent = if self.conic {
            reach * tallest + tallest
        } else {
            reach
        };
        // Heights are exact at the caps and do not matter on straight walls.
        SurfacePoint::bare(position, point_error(position, extent, 32), normal)
    }

    pub(super) fn contains(&self, point: DVec3) -> bool {
        if !(self.low <= point.z && point.z <= self.high) {
            return false;
        }
        if !self.conic {
            return self.outline.contains(point.truncate());
        }
        point.z != 0.0 && self.outline.contains(point.truncate() / point.z)
    }
}

impl WholeLine for Extrusion<'_> {
    fn walk(&self, ray: &Ray, from: Option<SurfaceId>, list: &mut Crossings) {
        let Some(caps) = self.caps(ray, from) else {
            return;
        };
        let always = self.list_walls(ray, list);
        if list.list.is_empty() && !always {
            return;
        }
        self.snap_walls(ray, from, &mut list.list);
        list.list.extend(caps);
        list.list.sort_unstable_by(order);

        let mut within = always || self.starts_within(ray, &list.list);
        let mut between = false;
        list.list.retain_mut(|crossing| {
            let inside = within && between;
            match crossing.side {
                Side::Enter => between = true,
                Side::Exit => between = false,
                Side::Inner => within = !within,
            }
            let enters = within && between;
            let counts = enters != inside && crossing.hit.t.is_finite();
            if counts {
                self.finish(ray, crossing, enters);
            }
            counts
        });
    }

    /// In contrast to a walk, crossings are neither kept nor sorted: those up to the place where the ray is between the caps are counted, and of
    /// the others the first one is enough.
    fn first_hit(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        scratch: &mut Scratch,
    ) -> Option<PrimHit> {
        let [low, high] = self.caps(ray, from)?;
        let start = start_of(range, from);
        if !(low.hit.t <= high.hit.t) {
            return first_of_walk(self, ray, range, from, scratch);
        }
        if high.hit.t <= start || low.hit.t > range.max {
            return None;
        }
        // Between the caps from here on.
        let comes_in = low.hit.t.total_cmp(&start).is_gt();
        let begin = if comes_in { low.hit.t } else { start };
        let apex = self.apex(ray);
        let own = from.and_then(|from| from.facet.checked_sub(FIRST_WALL));
        let own = own.map(|piece| self.outline.smooth_run(piece));
        let mut walls = Walls::default();
        let always = self.walls(ray, |hit| {
            walls.within ^= hit.t < apex;
            walls.take(hit, begin);
            if own.is_some_and(|run| self.is_start(ray, &hit, run, walls.start.as_ref())) {
                walls.start = Some(hit);
            }
        });
        if !(always || walls.any) {
            return None;
        }
        if let Some(hit) = walls.start {
            walls.within ^= (hit.t < apex) != (0.0 < apex);
            walls.moved_to_start(hit, begin);
        }
        let within = always || (walls.within != walls.passed);
        let found = |mut crossing: Crossing, enters: bool| {
            self.finish(ray, &mut crossing, enters);
            range.accepts(crossing.hit.t).then_some(crossing.hit)
        };
        if within && comes_in && self.capped && low.hit.t.is_finite() {
            return found(low, true);
        }
        match walls.next() {
            Some(hit) if hit.t.total_cmp(&high.hit.t).is_lt() => {
                found(Crossing::new(hit, 0.0, Side::Inner), !within)
            }
            _ if within && self.capped && high.hit.t.is_finite() => found(high, false),
            _ => None,
        }
    }

    fn normal(&self, _: &Ray, hit: &PrimHit) -> DVec3 {
        match hit.surface.facet {
            LOW_CAP => DVec3::NEG_Z,
            HIGH_CAP => DVec3::Z,
            _ => self.wall_normal(hit),
        }
    }

    fn reach(&self) -> f64 {
        self.bounds().max_abs()
    }
}

/// The crossings of a line with walls, as far as the first hit needs them.
#[derive(Default)]
pub(super) struct Walls {
    any: bool,
    /// Whether an odd number lies before the apex.
    within: bool,
    /// Whether an odd number lies up to the place where the search begins.
    passed: bool,
    /// The first two behind it.
    next: [Option<PrimHit>; 2],
    /// The one that the ray starts on.
    start: Option<PrimHit>,
}

impl Walls {
    #[inline]
    fn take(&mut self, hit: PrimHit, begin: f64) {
        self.any = true;
        if hit.t.total_cmp(&begin).is_le() {
            self.passed = !self.passed;
            return;
        }
        let is_before = |other: &Option<PrimHit>| {
            other
                .as_ref()
                .is_none_or(|other| by_place(&hit, other).is_lt())
        };
        let [first, second] = &mut self.next;
        if is_before(first) {
            *second = first.replace(hit);
        } else if is_before(second) {
            *second = Some(hit);
        }
    }

    /// A crossing that was taken turns out to be the start, which is never behind the beginning.
    fn moved_to_start(&mut self, hit: PrimHit, begin: f64) {
        if hit.t.total_cmp(&begin).is_le() {
            return;
        }
        self.passed = !self.passed;
        let [first, second] = self.next;
        self.next = match first == Some(hit) {
            true => [second, None],
            false => [first, None],
        };
    }

    fn next(&self) -> Option<PrimHit> {
        self.next[0]
    }
}

/// The order of hits along a ray; of walls that meet at an edge, by their numbers.
fn by_place(a: &PrimHit, b: &PrimHit) -> Ordering {
    let by_t = a.t.total_cmp(&b.t);
    by_t.then_with(|| a.surface.facet.cmp(&b.surface.facet))
}

/// The order of crossings along a ray. Where a ray meets an edge it leaves before it enters, so there is no span without length.
fn order(a: &Crossing, b: &Crossing) -> Ordering {
    let rank = |side: Side| match side {
        Side::Exit => 0,
        Side::Inner => 1,
        Side::Enter => 2,
    };
    let later = |c: &Crossing| (rank(c.side), c.hit.surface.facet);
    let by_t = a.hit.t.total_cmp(&b.hit.t);
    by_t.then_with(|| later(a).cmp(&later(b)))
}

/// The factor between two vectors that are parallel up to rounding: `a` divided by `b`.
fn quotient(a: DVec3, b: DVec3) -> f64 {
    let size = b.abs();
    if size.x >= size.y && size.x >= size.z {
        a.x / b.x
    } else if size.y >= size.z {
        a.y / b.y
    } else {
        a.z / b.z
    }
}
