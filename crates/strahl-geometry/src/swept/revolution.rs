use super::hyperbola::{Line, Meeting, Place};
use super::meridian::{Arc, Meridian};
use super::runs::Rect;
use super::sextic::Terms;
use super::spans::{
    NEAR, WholeLine, crossings_of_walk, first_of_walk, near_the_start, snap, t_error,
};
use crate::primitives::{point_error, start_of, turn};
use crate::{Crossing, Crossings, PrimHit, Scratch, Side, SurfaceId, SurfacePoint};
use arrayvec::ArrayVec;
use std::f64::consts::TAU;
use strahl_math::{Aabb, DVec2, DVec3, Interval, Ray};

/// A meridian rotated about the y axis.
///
/// In the half-plane of radius and height a line is one branch of a hyperbola. With the distance `m` of the line from the axis
/// and `h` along its horizontal part, counted from the place nearest to the axis, a point of the meridian is on it where
/// `h = ±q`, `q = sqrt(r² - m²)`, is where the line has the same height: two functions of the meridian's parameter, one for each half of the
/// line. Their product is a polynomial of degree 6 at most, the one of other ray tracers. Its coefficients tell of nearly all arcs how
/// many roots they have ([`super::sextic`]).
///
/// Where they don't, as for level rays, for which the product has double roots, the two functions are searched one by one. As radius and height
/// are monotone on every arc, both are bounded by their values at the ends of an interval, and their slopes by a few products:
/// bisection finds all roots, with certainty.
///
/// The side of the line on which a joint of two arcs lies is decided by the same numbers for both, so entering and leaving
/// alternate despite rounding; the coefficients only have a say where they are beyond doubt, and then agree.
///
/// Roots are first isolated. Where the bounds of their places on the ray tell what is asked, they are not computed.
///
/// Hits have `uv = [s, side]`: the parameter on the arc, and 1 if the outer side is the right of the curve, else -1.
pub(super) struct Revolution<'a>(pub(super) &'a Meridian);

/// A crossing of which it is known about where it is, and perhaps exactly.
#[derive(Clone, Copy)]
struct Candidate {
    /// Bounds of the ray's parameter.
    t: [f64; 2],
    facet: u32,
    meeting: Meeting,
    visible: bool,
}

impl Candidate {
    fn is_exact(&self) -> bool {
        matches!(self.meeting.place, Place::At { .. })
    }

    /// The hit, if the place is known exactly.
    fn hit(&self, side: f64) -> PrimHit {
        let s = match self.meeting.place {
            Place::At { s, .. } => s,
            Place::Within(part) => part.guess,
        };
        let [t, _] = self.t;
        PrimHit {
            t,
            surface: facet(self.facet as usize),
            uv: [s, side],
        }
    }

    /// The end of the interval that is nearer to the start of the ray.
    fn least_distance(&self) -> f64 {
        let [low, high] = self.t;
        if low > 0.0 {
            low
        } else if high < 0.0 {
            -high
        } else {
            0.0
        }
    }
}

/// More crossings are not sorted out one by one.
type Candidates = ArrayVec<Candidate, MOST>;

const MOST: usize = 16;

fn facet(index: usize) -> SurfaceId {
    SurfaceId {
        element: 0,
        facet: index as u32,
    }
}

impl Revolution<'_> {
    /// `None` if the ray meets nothing because it isn't one.
    fn line(&self, ray: &Ray) -> Option<Line> {
        let (o, d) = (ray.origin, ray.direction);
        (o.is_finite() && d.is_finite() && d != DVec3::ZERO).then(|| Line::new(ray, self.0))
    }

    /// The first arc of the smooth run that an arc belongs to.
    fn run(&self, facet: u32) -> Option<&u32> {
        self.0.smooth.get(facet as usize)
    }

    fn piece(&self, index: usize) -> Option<(&Arc, &Terms)> {
        self.0.arcs.get(index).zip(self.0.terms.get(index))
    }

    /// Visits all crossings with a line, arc by arc.
    #[inline]
    fn meetings(&self, line: &Line, mut visit: impl FnMut(usize, (&Arc, &Terms), Meeting)) {
        self.0.runs.visit(
            |rect| line.meets(rect),
            |index| {
                if let Some(arc) = self.piece(index) {
                    line.crossings(arc, &mut |meeting| visit(index, arc, meeting));
                }
            },
        );
    }

    /// Lists all crossings with a line; `false` if they are too many.
    #[inline]
    fn candidates(&self, line: &Line, list: &mut Candidates) -> bool {
        let mut fits = true;
        self.meetings(line, |index, (arc, _), meeting| {
            let candidate = Candidate {
                t: line.about(arc, &meeting.place),
                facet: index as u32,
                meeting,
                visible: arc.visible,
            };
            fits &= list.try_push(candidate).is_ok();
        });
        fits
    }

    /// Computes where a candidate is.
    fn settle(&self, line: &Line, candidate: &mut Candidate) {
        if let Some((arc, terms)) = self.piece(candidate.facet as usize)
            && !candidate.is_exact()
        {
            let [s, t] = line.exactly(arc, terms, &candidate.meeting.place);
            // The half has served its purpose.
            candidate.meeting.place = Place::At { s, half: 0.0 };
            candidate.t = [t, t];
        }
    }

    /// Root identity, as [`snap`] has it.
    fn snap_candidates(&self, ray: &Ray, line: &Line, from: SurfaceId, list: &mut Candidates) {
        let size = self.bounds().size().max_element();
        if let Some(start) = self.certain_start(line, size, from, list) {
            // Where on the arc it is does not matter.
            start.meeting.place = Place::At { s: 0.0, half: 0.0 };
            start.t = [0.0; 2];
            return;
        }
        // Those that may be nearest first: the others need not be computed.
        let mut order: ArrayVec<usize, MOST> = (0..list.len())
            .filter(|index| self.run(list[*index].facet) == self.run(from.facet))
            .collect();
        order.sort_by(|a, b| {
            let distance = |index: usize| list[index].least_distance();
            distance(*a).total_cmp(&distance(*b))
        });
        let mut nearest: Option<(usize, f64)> = None;
        for index in order {
            let candidate = &mut list[index];
            if nearest.is_some_and(|(_, best)| best < candidate.least_distance()) {
                break;
            }
            self.settle(line, candidate);
            let hit = candidate.hit(candidate.meeting.approach);
            let t = hit.t.abs();
            // Of those at one distance the first one counts.
            let is_nearer =
                nearest.is_none_or(|(other, best)| t < best || t == best && index < other);
            if is_nearer && near_the_start(ray, &hit, size, self.normal(ray, &hit)) {
                nearest = Some((index, t));
            }
        }
        if let Some((index, _)) = nearest
            && let Some(candidate) = list.get_mut(index)
        {
            candidate.t = [0.0; 2];
        }
    }

    /// The crossing that the ray starts on, if it is clear without computing it: all others that may be the start are farther away.
    fn certain_start<'a>(
        &self,
        line: &Line,
        size: f64,
        from: SurfaceId,
        list: &'a mut Candidates,
    ) -> Option<&'a mut Candidate> {
        // Well within what counts as near, to leave room for rounding.
        let near = line.time_of(0.25 * NEAR * size);
        let run = self.run(from.facet);
        let mut may_be_near = list
            .iter_mut()
            .filter(|c| c.least_distance() <= 2.0 * near && self.run(c.facet) == run);
        let (start, None) = (may_be_near.next()?, may_be_near.next()) else {
            return None;
        };
        let (arc, terms) = self.piece(start.facet as usize)?;
        line.certainly_crosses(arc, terms, &start.meeting.place, near)
            .then_some(start)
    }

    /// The first visible crossing in the range and behind the start, for a list in which that has been told apart. Crossings are
    /// computed only where it is not clear without that which of them comes first.
    fn first_of(
        &self,
        line: &Line,
        range: Interval,
        start: f64,
        list: &mut Candidates,
    ) -> Option<PrimHit> {
        let mut inside = false;
        loop {
            let order = |a: &Candidate, b: &Candidate| {
                // Of those that may be at the same place, the ones that are not computed come first.
                let rank = |c: &Candidate| (c.is_exact(), c.facet);
                a.t[0]
                    .total_cmp(&b.t[0])
                    .then_with(|| rank(a).cmp(&rank(b)))
            };
            let (index, _) = list.iter().enumerate().min_by(|a, b| order(a.1, b.1))?;
            let candidate = list.get_mut(index)?;
            let [low, high] = candidate.t;
            if low > range.max {
                return None;
            }
            if !candidate.is_exact() && high > start {
                self.settle(line, candidate);
                continue;
            }
            inside = !inside;
            let candidate = list.swap_remove(index);
            if candidate.visible && range.accepts(high) && start < high && high.is_finite() {
                // Entering goes against the outer side.
                let approach = candidate.meeting.approach;
                return Some(candidate.hit(if inside { -approach } else { approach }));
            }
        }
    }

    pub(super) fn bounds(&self) -> Aabb {
        let Rect { min, max } = self.0.runs.bounds();
        let r = max.x.sqrt();
        Aabb::new(DVec3::new(-r, min.y, -r), DVec3::new(r, max.y, r))
    }

    fn arc(&self, hit: &PrimHit) -> Option<&Arc> {
        self.0.arcs.get(hit.surface.facet as usize)
    }

    /// The direction away from the axis at a hit (x, z).
    fn outward(ray: &Ray, hit: &PrimHit) -> DVec2 {
        let at = ray.at(hit.t);
        let flat = DVec2::new(at.x, at.z);
        let largest = flat.abs().max_element();
        if largest > 0.0 && largest.is_finite() {
            (flat / largest).normalize()
        } else {
            DVec2::X
        }
    }

    /// The surface at a hit, with texture coordinates: `u` once around the axis, `v` as the arc says.
    pub(super) fn surface_at(&self, ray: &Ray, hit: &PrimHit) -> SurfacePoint {
        let mut bare = SurfacePoint::UNKNOWN;
        self.store_bare_surface(ray, hit, &mut bare);
        let Some(arc) = self.arc(hit) else {
            return bare;
        };
        let outward = Self::outward(ray, hit);
        let [s, _] = hit.uv;
        let r = arc.radius(s);
        let [from, to] = arc.v;
        let right = arc.right(s);
        // Along the curve, per unit of `v`.
        let along = DVec2::new(-right.y, right.x);
        let scale = if from == to { 0.0 } else { 1.0 / (to - from) };
        let speed = if arc.is_squared() && r > 0.0 {
            0.5 / r
        } else {
            1.0
        };
        let along = along * (scale * speed);
        SurfacePoint {
            uv: DVec2::new(turn(outward.y, outward.x), from + (to - from) * s),
            dpdu: DVec3::new(-outward.y, 0.0, outward.x) * (TAU * r),
            dpdv: DVec3::new(outward.x * along.x, along.y, outward.y * along.x),
            ..bare
        }
    }

    /// Stores the surface at a hit without texture coordinates.
    pub(super) fn store_bare_surface(&self, ray: &Ray, hit: &PrimHit, out: &mut SurfacePoint) {
        let outward = Self::outward(ray, hit);
        let [s, _] = hit.uv;
        let arc = self.arc(hit);
        let (r, y) = arc.map_or((0.0, 0.0), |arc| (arc.radius(s), arc.y.at(s)));
        let position = DVec3::new(outward.x * r, y, outward.y * r);
        let error = point_error(position, self.bounds().max_abs(), 32);
        *out = SurfacePoint::bare(position, error, self.normal(ray, hit));
    }

    /// Whether a line away from the axis crosses the meridian an odd number of times.
    pub(super) fn contains(&self, point: DVec3) -> bool {
        let square = point.x * point.x + point.z * point.z;
        let mut inside = false;
        self.0.runs.visit(
            |rect| rect.max.x >= square && rect.min.y <= point.y && point.y <= rect.max.y,
            |index| {
                let Some(arc) = self.0.arcs.get(index) else {
                    return;
                };
                if (arc.y.start() >= point.y) != (arc.y.end() >= point.y) {
                    inside ^= arc.at(arc.at_height(point.y)).square > square;
                }
            },
        );
        inside
    }
}

impl WholeLine for Revolution<'_> {
    fn walk(&self, ray: &Ray, from: Option<SurfaceId>, list: &mut Crossings) {
        let Some(line) = self.line(ray) else { return };
        self.meetings(&line, |index, (arc, terms), meeting| {
            let [s, t] = line.exactly(arc, terms, &meeting.place);
            let hit = PrimHit {
                t,
                surface: facet(index),
                uv: [s, meeting.approach],
            };
            let mut crossing = Crossing::new(hit, 0.0, Side::Inner);
            crossing.visible = arc.visible;
            list.list.push(crossing);
        });
        if let Some(from) = from {
            let near = |hit: &PrimHit| {
                (self.run(hit.surface.facet) == self.run(from.facet)).then(|| self.normal(ray, hit))
            };
            let size = self.bounds().size().max_element();
            snap(&mut list.list, ray, size, near);
        }
        list.list.sort_unstable_by(|a, b| {
            let facets = || a.hit.surface.facet.cmp(&b.hit.surface.facet);
            a.hit.t.total_cmp(&b.hit.t).then_with(facets)
        });
        let mut inside = false;
        for crossing in &mut list.list {
            inside = !inside;
            let [_, approach] = crossing.hit.uv;
            // Entering goes against the outer side.
            crossing.hit.uv[1] = if inside { -approach } else { approach };
            crossing.side = if inside { Side::Enter } else { Side::Exit };
        }
        list.list.retain(|crossing| crossing.hit.t.is_finite());
    }

    fn first_hit(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        scratch: &mut Scratch,
    ) -> Option<PrimHit> {
        let line = self.line(ray)?;
        let mut candidates = Candidates::new();
        if !self.candidates(&line, &mut candidates) {
            return first_of_walk(self, ray, range, from, scratch);
        }
        if let Some(from) = from {
            self.snap_candidates(ray, &line, from, &mut candidates);
        }
        self.first_of(&line, range, start_of(range, from), &mut candidates)
    }

    /// What certainly is before or behind the range is not computed.
    fn all_crossings(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        scratch: &mut Scratch,
        out: &mut Crossings,
    ) {
        let Some(line) = self.line(ray) else { return };
        let mut candidates = Candidates::new();
        let fits = self.candidates(&line, &mut candidates);
        if let Some(from) = from
            && fits
        {
            self.snap_candidates(ray, &line, from, &mut candidates);
        }
        let start = start_of(range, from);
        let (mut inside, mut finite) = (false, true);
        candidates.retain(|candidate| {
            let [low, high] = candidate.t;
            // Ranges may be empty: what is not before the start is behind it or not known.
            if high > start && (low <= start || low <= range.max) {
                self.settle(&line, candidate);
            }
            let [low, high] = candidate.t;
            finite &= !candidate.is_exact() || low.is_finite();
            inside ^= high <= start;
            high > start && low <= range.max
        });
        if !(fits && finite) {
            return crossings_of_walk(self, ray, range, from, scratch, out);
        }
        let place = |c: &Candidate| c.t[0];
        candidates.sort_unstable_by(|a, b| {
            let by_t = place(a).total_cmp(&place(b));
            by_t.then_with(|| a.facet.cmp(&b.facet))
        });
        out.inside_at_start = inside;
        for candidate in &candidates {
            inside = !inside;
            let approach = candidate.meeting.approach;
            let hit = candidate.hit(if inside { -approach } else { approach });
            let error = match out.without_errors {
                true => 0.0,
                false => t_error(ray, hit.t, self.normal(ray, &hit), self.reach()),
            };
            let side = if inside { Side::Enter } else { Side::Exit };
            let mut crossing = Crossing::new(hit, error, side);
            crossing.visible = candidate.visible;
            out.list.push(crossing);
        }
    }

    /// A crossing that certainly is in the range need not be computed.
    fn any_hit(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        scratch: &mut Scratch,
    ) -> bool {
        let Some(line) = self.line(ray) else {
            return false;
        };
        let mut candidates = Candidates::new();
        if !self.candidates(&line, &mut candidates) {
            return first_of_walk(self, ray, range, from, scratch).is_some();
        }
        let start = start_of(range, from);
        let start_run = from.and_then(|from| self.run(from.facet));
        let certain = |c: &Candidate| {
            let [low, high] = c.t;
            c.visible && start < low && high <= range.max && high.is_finite()
        };
        // The nearest of the run that the ray starts on is its start.
        let may_be_start = |c: &Candidate| start_run.is_some() && start_run == self.run(c.facet);
        if candidates.iter().any(|c| certain(c) && !may_be_start(c)) {
            return true;
        }
        if let Some(from) = from {
            self.snap_candidates(ray, &line, from, &mut candidates);
        }
        candidates.iter().any(certain)
            || self
                .first_of(&line, range, start, &mut candidates)
                .is_some()
    }

    fn normal(&self, ray: &Ray, hit: &PrimHit) -> DVec3 {
        let Some(arc) = self.arc(hit) else {
            return DVec3::Y; // A hit of another shape.
        };
        let [s, side] = hit.uv;
        let right = arc.right(s) * side;
        let outward = Self::outward(ray, hit) * right.x;
        DVec3::new(outward.x, right.y, outward.y).normalize_or(DVec3::Y)
    }

    fn reach(&self) -> f64 {
        self.bounds().max_abs()
    }
}

#[cfg(test)]
mod tests {
    use super::super::spans::tests::first_hits_are_those_of_the_walk;
    use super::*;
    use crate::{Lathe, Sor, Spline};

    #[test]
    fn the_first_hit_needs_no_others() {
        let points = |list: &[[f64; 2]]| list.iter().map(|p| DVec2::from_array(*p)).collect();
        let vase: Vec<DVec2> = points(&[
            [0.0, 0.1],
            [0.0, 0.0],
            [0.5, 0.0],
            [0.9, 0.5],
            [0.3, 1.1],
            [0.4, 1.3],
            [0.0, 1.2],
            [0.0, 1.0],
        ]);
        for spline in [Spline::Linear, Spline::Quadratic, Spline::Cubic] {
            let lathe = Lathe::try_new(spline, &vase).unwrap();
            first_hits_are_those_of_the_walk(&Revolution(&lathe.meridian));
        }
        let sor: Vec<DVec2> = points(&[
            [0.2, -1.0],
            [0.6, -0.8],
            [0.4, -0.1],
            [0.8, 0.3],
            [0.3, 0.8],
            [0.1, 1.0],
        ]);
        let sor = Sor::try_new(&sor, true).unwrap();
        first_hits_are_those_of_the_walk(&Revolution(&sor.meridian));
    }

    #[test]
    fn many_crossings_are_sorted() {
        // A screw without a pitch: a line along it crosses far more arcs than there are candidates.
        let tooth = |k: u32| DVec2::new(1.0 + 0.1 * f64::from(k % 2), 0.02 * f64::from(k));
        let lathe = Lathe::try_new(Spline::Linear, &(0..100).map(tooth).collect::<Vec<_>>());
        let lathe = lathe.unwrap();
        first_hits_are_those_of_the_walk(&Revolution(&lathe.meridian));
        let along = Ray::new(DVec3::new(1.05, -1.0, 0.0), DVec3::Y);
        let mut list = Crossings::default();
        Revolution(&lathe.meridian).walk(&along, None, &mut list);
        assert!(list.list.len() > 90, "{}", list.list.len());
    }
}
