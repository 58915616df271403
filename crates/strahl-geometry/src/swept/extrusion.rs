use super::outline::{Cut, Outline, direction, slab};
use super::spans::{WholeLine, first_of_walk, snap};
use crate::primitives::{point_error, start_of};
use crate::{Crossing, Crossings, PrimHit, Scratch, Side, SurfaceId, SurfacePoint};
use std::cmp::Ordering;
use strahl_math::{Aabb, DVec2, DVec3, Interval, Ray};

/// The facet of the cap at the lower height.
const LOW_CAP: u32 = 0;
/// The facet of the cap at the upper height.
const HIGH_CAP: u32 = 1;
/// The facet of the first piece's wall.
const FIRST_WALL: u32 = 2;

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
    fn outer_side(&self, ray: &Ray, hit: &PrimHit, enters: bool) -> f64 {
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

    /// Lists the crossings of the ray's line with the infinite walls. `true` if the line's image is a point inside the outline.
    fn walls(&self, ray: &Ray, list: &mut Crossings) -> bool {
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
                let way = (crossing.point - o.truncate()).extend(0.0);
                quotient(way, d.truncate().extend(0.0))
            };
            let surface = SurfaceId {
                element: 0,
                facet: FIRST_WALL.saturating_add(crossing.piece),
            };
            let uv = [crossing.s, if crossing.rising { 1.0 } else { -1.0 }];
            let hit = PrimHit { t, surface, uv };
            list.list.push(Crossing::new(hit, 0.0, Side::Inner));
        });
        false
    }

    /// Root identity: moves the crossing that the ray starts on to exactly 0.
    fn snap_walls(&self, ray: &Ray, from: Option<SurfaceId>, walls: &mut [Crossing]) {
        let Some(start) = from.and_then(|from| from.facet.checked_sub(FIRST_WALL)) else {
            return;
        };
        let run = self.outline.smooth_run(start);
        let near = |hit: &PrimHit| {
            let wall = hit.surface.facet.saturating_sub(FIRST_WALL);
            (self.outline.smooth_run(wall) == run).then(|| self.wall_normal(hit))
        };
        let size = self.bounds().size().max_element();
        snap(walls, ray, size, near);
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

    /// The first visible hit behind the start and in the range, from all crossings with walls and caps in any order.
    fn first_behind(
        &self,
        ray: &Ray,
        start: f64,
        range: Interval,
        mut within: bool,
        crossings: &mut Vec<Crossing>,
    ) -> Option<PrimHit> {
        let mut between = false;
        crossings.retain(|crossing| {
            let is_behind = crossing.hit.t.total_cmp(&start).is_gt();
            if !is_behind {
                match crossing.side {
                    Side::Enter => between = true,
                    Side::Exit => between = false,
                    Side::Inner => within = !within,
                }
            }
            is_behind
        });
        let many = crossings.len() > MANY;
        if many {
            crossings.sort_unstable_by(|a, b| order(b, a));
        }
        loop {
            let mut crossing = if many {
                crossings.pop()?
            } else {
                let all = crossings.iter().enumerate();
                let (index, _) = all.min_by(|(_, a), (_, b)| order(a, b))?;
                crossings.swap_remove(index)
            };
            let inside = within && between;
            match crossing.side {
                Side::Enter => between = true,
                Side::Exit => between = false,
                Side::Inner => within = !within,
            }
            let enters = within && between;
            if enters != inside && crossing.hit.t.is_finite() {
                self.finish(ray, &mut crossing, enters);
                if crossing.visible {
                    return range.accepts(crossing.hit.t).then_some(crossing.hit);
                }
            }
        }
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
        let always = self.walls(ray, list);
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

    /// In contrast to a walk, what lies behind the first hit is not sorted, and what lies before the range is only counted.
    fn first_hit(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        scratch: &mut Scratch,
    ) -> Option<PrimHit> {
        let caps = self.caps(ray, from)?;
        let [low, high] = caps.map(|cap| cap.hit.t);
        let start = start_of(range, from);
        if !(low <= high) {
            return first_of_walk(self, ray, range, from, scratch);
        }
        if high <= start || low > range.max {
            return None;
        }
        let mut list = scratch.take();
        let always = self.walls(ray, &mut list);
        let hit = if list.list.is_empty() && !always {
            None
        } else {
            self.snap_walls(ray, from, &mut list.list);
            let within = always || self.starts_within(ray, &list.list);
            list.list.extend(caps);
            self.first_behind(ray, start, range, within, &mut list.list)
        };
        scratch.give(list);
        hit
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

/// So many crossings are sorted, instead of looking for the first one again and again.
const MANY: usize = 16;

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
