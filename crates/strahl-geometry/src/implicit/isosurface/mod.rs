//! Surfaces where a function of space has a given value.

mod decision;
mod search;
#[cfg(test)]
mod tests;
mod trust;

use super::EXACT;
use super::container::Container;
use super::octree::{Cell, Content, Octree, Visitor as _};
use super::slopes::Slopes;
use super::workspace::with_workspace;
use crate::algebraic::{self, Question};
use crate::primitive::{hits_of_solid, one_by_one};
use crate::{
    Crossing, Crossings, GeometryError, PrimHit, Primitive, Scratch, Side, Solid, SurfaceId,
    SurfacePoint,
};
use decision::Decision;
use search::{Course, Search, least_value, side};
use std::ops::ControlFlow;
use std::sync::OnceLock;
use strahl_function::{Bounds, Function, Rates, Workspace};
use strahl_math::error::{ROUNDOFF, gamma};
use strahl_math::{Aabb, DVec3, Interval, Ray};

/// Options of an isosurface; the defaults are POV-Ray's.
#[derive(Clone, Debug, PartialEq)]
pub struct IsosurfaceOptions {
    /// The value of the function on the surface; inside it is smaller.
    pub threshold: f64,
    /// Features thinner than this along a ray may be missed. Crossings themselves are found to the last digit.
    pub accuracy: f64,
    /// The largest change of the function per unit of length. It is needed if the function calls patterns or pigments, for which there are
    /// no bounds; `None` is [`IsosurfaceOptions::MAX_GRADIENT`] then. For sums over octaves of noise it takes the place of proofs, unless
    /// slopes that are measured contradict it. Other functions do without.
    pub max_gradient: Option<f64>,
    /// Whether the container is invisible where it cuts through the inside.
    pub open: bool,
}

impl IsosurfaceOptions {
    /// The gradient of functions without bounds by default.
    pub const MAX_GRADIENT: f64 = 1.1;
}

impl Default for IsosurfaceOptions {
    fn default() -> Self {
        Self {
            threshold: 0.0,
            accuracy: 0.001,
            max_gradient: None,
            open: false,
        }
    }
}

/// The surface where a function has a given value, within a container; inside, the function is smaller.
///
/// Hits are certified by interval arithmetic: a part of a ray is skipped only where the function's bounds prove that its sign
/// does not change, so there are no holes and no gradient has to be guessed, however steep the function is. There are two exceptions:
/// functions that call patterns or pigments have no bounds, so [`IsosurfaceOptions::max_gradient`] is trusted, as in POV-Ray; and if it is
/// stated for a sum over octaves of noise, whose bounds take long, it is trusted unless measured slopes contradict it. An octree, whose cells are examined when a ray first meets them, stores where the surface may be at all; it depends on the
/// function alone, so it does not change the picture. Where the signs of polynomials decide ([`Function::region_below`]), they are solved
/// along the ray instead.
///
/// Facets: 0 is the function's surface, 1 and up are the facets of the container. NaN counts as outside. There are no texture
/// coordinates.
///
/// R. E. Moore, Interval Analysis (1966); D. P. Mitchell, "Robust ray intersection with interval arithmetic", Graphics
/// Interface 1990; M. J. Keeter, "Massively parallel rendering of complex closed-form implicit surfaces", SIGGRAPH 2020.
#[derive(Debug)]
pub struct Isosurface {
    function: Function,
    container: Container,
    options: IsosurfaceOptions,
    is_bounded: bool,
    /// Whether the gradient takes the place of proofs, once a ray has asked.
    trusts_gradient: OnceLock<bool>,
    /// Of which arguments rates of change can be known.
    rates: Rates,
    /// The polynomials that decide instead, once a ray has asked.
    decision: OnceLock<Option<Decision>>,
    octree: Octree,
    /// How far cells are widened when they are examined.
    cell_pad: DVec3,
    /// The octree's bounds, as much wider: points within are in the cells that are found for them.
    reach: Aabb,
}

/// Equal isosurfaces have equal numbers and functions, so every ray finds the same on them.
impl PartialEq for Isosurface {
    fn eq(&self, other: &Self) -> bool {
        self.options == other.options
            && self.container == other.container
            && self.function == other.function
    }
}

/// The facet that is the function's surface.
const SURFACE: SurfaceId = SurfaceId {
    element: 0,
    facet: 0,
};

/// How far cells are widened when they are examined, as a part of the container's largest coordinate: more than rounding moves a
/// point on a ray out of the cell it is in.
const CELL_PAD: f64 = 256.0 * f64::EPSILON;

/// The octree's cells are halved so often.
const LEVELS: u32 = 6;

/// So many cells at most are bounded at once, where the function may be bounded on segments: longer ones go through so many cells of noise that
/// bounds are too wide.
const STRIDE: f64 = 2.0;

/// The shortest and the longest part of a ray that is not divided, as a part of the container's size.
const SHORTEST: (f64, f64) = (1e-6, 1e-3);

impl Isosurface {
    /// The surface of a function of x, y and z.
    ///
    /// # Errors
    /// The container is degenerate, the function has other than three parameters, a number is not finite, or accuracy or
    /// gradient are not positive.
    pub fn try_new(
        function: Function,
        container: Container,
        options: IsosurfaceOptions,
    ) -> Result<Self, GeometryError> {
        container.validate()?;
        let found = function.parameters().len() as u64;
        if found != 3 {
            return Err(GeometryError::WrongCount {
                what: "parameters of the function of an isosurface",
                expected: 3,
                found,
            });
        }
        if !options.threshold.is_finite() {
            return Err(GeometryError::NotFinite {
                what: "threshold of the isosurface",
            });
        }
        crate::primitives::check_positive("accuracy of the isosurface", options.accuracy)?;
        if let Some(gradient) = options.max_gradient {
            crate::primitives::check_positive("max_gradient of the isosurface", gradient)?;
        }
        let is_bounded = function.is_bounded();
        let rates = function.rates();
        let bounds = container.bounds();
        let cell_pad = DVec3::splat(CELL_PAD * bounds.max_abs());
        let mut surface = Self {
            function,
            container,
            options,
            is_bounded,
            trusts_gradient: OnceLock::new(),
            rates,
            decision: OnceLock::new(),
            octree: Octree::new(cube_around(bounds), LEVELS),
            cell_pad,
            reach: bounds.padded(cell_pad),
        };
        if rates == Rates::OfSegments && !surface.has_rates_in_cells() {
            surface.rates = Rates::Unknown;
        }
        Ok(surface)
    }

    /// Whether rates are known on segments as long as those that rays have in the octree's cells. If the function is so fine that they are not,
    /// bounds of the values tell as much in shorter parts, in less time.
    fn has_rates_in_cells(&self) -> bool {
        let bounds = self.container.bounds();
        let reach = DVec3::ONE * (0.5 * STRIDE * self.cell_size());
        // By chance a segment may meet too many cells of noise.
        let places = [0.27, 0.51, 0.83].map(|at| bounds.min + bounds.size() * at);
        with_workspace(|workspace| {
            places.iter().any(|&place| {
                let ends = (place - reach, place + reach);
                let (_, rate) = self.rate_along(workspace, ends, reach);
                !rate.nan
            })
        })
    }

    /// The function.
    pub fn function(&self) -> &Function {
        &self.function
    }

    /// The largest change of the function per unit of length, as far as it is trusted.
    fn gradient_limit(&self) -> f64 {
        let stated = self.options.max_gradient;
        stated.unwrap_or(IsosurfaceOptions::MAX_GRADIENT)
    }

    /// The function less the threshold; infinite where it is not a number.
    fn value(&self, workspace: &mut Workspace, p: DVec3) -> f64 {
        let value = self.function.value(workspace, &p.to_array()) - self.options.threshold;
        if value.is_nan() { f64::INFINITY } else { value }
    }

    /// The function less the threshold, and its gradient.
    fn gradient(&self, workspace: &mut Workspace, p: DVec3) -> (f64, DVec3) {
        let (value, partials) = self.function.gradient(workspace, &p.to_array());
        (value - self.options.threshold, DVec3::from_array(partials))
    }

    /// Bounds of the function less the threshold.
    fn bounds_within(&self, workspace: &mut Workspace, cell: &Aabb) -> Bounds {
        self.less_threshold(self.function.bounds(workspace, &sides(cell)))
    }

    fn less_threshold(&self, values: Bounds) -> Bounds {
        let threshold = self.options.threshold;
        // A difference has the sign of the exact one.
        Bounds {
            min: values.min - threshold,
            max: values.max - threshold,
            nan: values.nan,
        }
    }

    /// Bounds of the function less the threshold, as [`Isosurface::bounds_within`], and of its derivative along a direction.
    fn rate_within(
        &self,
        workspace: &mut Workspace,
        cell: &Aabb,
        direction: DVec3,
    ) -> (Bounds, Bounds) {
        let (sides, way) = (sides(cell), direction.to_array());
        let (values, rate) = self.function.rate(workspace, &sides, &way);
        (self.less_threshold(values), rate)
    }

    /// The same on the segment between two points of a line with that direction.
    fn rate_along(
        &self,
        workspace: &mut Workspace,
        (from, to): (DVec3, DVec3),
        direction: DVec3,
    ) -> (Bounds, Bounds) {
        let ends = [&from.to_array()[..], &to.to_array()];
        let way = direction.to_array();
        let (values, rate) = self.function.rate_along(workspace, ends, &way);
        (self.less_threshold(values), rate)
    }

    /// Bounds of the derivative along a direction in a cell of the octree, if they are known.
    fn rate_in(
        &self,
        workspace: &mut Workspace,
        cell: &Cell<'_>,
        direction: DVec3,
    ) -> Option<Bounds> {
        let slopes = cell.slopes(|cell| {
            let cell = cell.padded(self.cell_pad);
            Slopes::around(DVec3::AXES.map(|axis| self.rate_within(workspace, &cell, axis).1))
        });
        slopes?.along(direction)
    }

    /// What a cell of the octree holds.
    fn content(&self, workspace: &mut Workspace, cell: &Aabb) -> Content {
        let cell = cell.padded(self.cell_pad);
        if self.container.excludes(&cell) {
            return Content::Empty { is_inside: None };
        }
        if !self.trusts_gradient(workspace) {
            return match side(self.bounds_within(workspace, &cell)) {
                None => Content::Surface,
                is_inside => Content::Empty { is_inside },
            };
        }
        let reach = self.gradient_limit() * 0.5 * cell.size().length();
        if self.value(workspace, cell.center()).abs() > reach {
            // What the scene says of the gradient may be wrong.
            Content::Empty { is_inside: None }
        } else {
            Content::Surface
        }
    }

    /// The largest extent of one of the octree's smallest cells.
    fn cell_size(&self) -> f64 {
        self.size() / f64::from(1_u32 << LEVELS)
    }

    /// Parts of a ray that are not longer are not divided, except for rounding.
    fn shortest(&self) -> f64 {
        let (least, most) = SHORTEST;
        let accuracy = self.options.accuracy;
        accuracy.clamp(least * self.size(), most * self.size())
    }

    /// The largest extent of the container.
    fn size(&self) -> f64 {
        self.container.bounds().size().max_element()
    }

    /// The rounding error of the function near a point.
    fn noise(&self, workspace: &mut Workspace, p: DVec3, gradient: DVec3) -> f64 {
        let place = place_noise(p, gradient);
        if self.is_bounded {
            let values = self.bounds_within(workspace, &Aabb::new(p, p));
            let width = values.max - values.min;
            if width.is_finite() && width >= 0.0 {
                return place + width;
            }
        }
        let size = self.options.threshold.abs() + gradient.length() * self.size() + 1.0;
        place + gamma(64) * size
    }

    /// Reports the events along a ray to the visitor, in order, until it stops. Crossings of the function's surface have no
    /// error bound. Those outside of the range may be left out, and of those within the rough range only an approximate place is found.
    fn walk(
        &self,
        ray: &Ray,
        (range, from): (Interval, Option<SurfaceId>),
        rough: Interval,
        workspace: &mut Workspace,
        visit: &mut impl FnMut(Event) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let on_container = from.and_then(|surface| surface.facet.checked_sub(1));
        let Some(passage) = self.container.passage(ray, on_container) else {
            return ControlFlow::Continue(());
        };
        let (mut start, end) = (passage.start(), passage.exit.hit.t);
        if from == Some(SURFACE) && start < 0.0 {
            start = 0.0;
        }
        // A ray that leaves the container, or one that is so far away that its ends can't be told apart.
        if !(start < end && end.is_finite() && start.is_finite()) {
            return ControlFlow::Continue(());
        }
        let needed = Interval::new(0.0, end - start)
            .intersection(Interval::new(range.min - start, range.max - start));
        let skips = needed.min > 0.0 && from != Some(SURFACE);
        let enter = passage.enter.filter(|enter| enter.hit.t == start && !skips);
        if let Some(decision) = self.decision(workspace) {
            let stretch = Interval::new(start, end);
            let question = Question {
                range: Interval::new(
                    if skips { range.min } else { start },
                    if range.max < end { range.max } else { end },
                ),
                on_surface: from == Some(SURFACE),
                errors: false,
            };
            return self.solve(
                decision,
                ray,
                (stretch, enter, passage.exit),
                &question,
                visit,
            );
        }
        let mut course = Course {
            search: self.search(ray, start, rough, workspace),
            length: end - start,
            enter,
            last: if skips { needed.min } else { 0.0 },
            value: None,
            inside: None,
            stride: 0.0,
            resume: f64::NEG_INFINITY,
            visit,
        };
        if from == Some(SURFACE) {
            let search = &mut course.search;
            let value = search.place(0.0).value;
            course.value = Some(self.value_leaving(ray, value, search.workspace));
            course.begin(None)?;
        }
        self.octree.walk(needed, &mut course)?;
        // If the walk has met no cell.
        course.begin(None)?;
        if course.inside == Some(true) {
            visit(Event::Crossing(self.cap(passage.exit, Side::Exit)))?;
        }
        ControlFlow::Continue(())
    }

    /// The polynomials that decide, if there are some.
    fn decision(&self, workspace: &mut Workspace) -> Option<&Decision> {
        let decision = self.decision.get_or_init(|| self.find_decision(workspace));
        decision.as_ref()
    }

    /// As [`Isosurface::walk`], where polynomials decide.
    fn solve(
        &self,
        decision: &Decision,
        ray: &Ray,
        (stretch, enter, exit): (Interval, Option<Crossing>, Crossing),
        question: &Question,
        visit: &mut impl FnMut(Event) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let (mut inside, mut flow) = (false, ControlFlow::Continue(()));
        decision.walk(ray, stretch, question, &mut |event| {
            flow = match event {
                algebraic::Event::Start { inside: is_inside } => {
                    inside = is_inside;
                    self.begin(enter, inside, visit)
                }
                // The container ends before it.
                algebraic::Event::Crossing { t, .. } if t >= stretch.max => {
                    return ControlFlow::Break(());
                }
                algebraic::Event::Crossing { t, enters, .. } => {
                    inside = enters;
                    let side = if enters { Side::Enter } else { Side::Exit };
                    let hit = PrimHit::simple(t, SURFACE.facet);
                    visit(Event::Crossing(Crossing::new(hit, 0.0, side)))
                }
            };
            flow
        });
        flow?;
        if inside {
            visit(Event::Crossing(self.cap(exit, Side::Exit)))?;
        }
        ControlFlow::Continue(())
    }

    /// Reports where a ray begins, in the container or on it.
    fn begin(
        &self,
        enter: Option<Crossing>,
        inside: bool,
        visit: &mut impl FnMut(Event) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        match enter {
            Some(enter) if inside => visit(Event::Crossing(self.cap(enter, Side::Enter))),
            Some(_) => ControlFlow::Continue(()),
            None => visit(Event::Start { inside }),
        }
    }

    // Inline: what is searched with would be copied.
    #[inline(always)]
    fn search<'a>(
        &'a self,
        ray: &Ray,
        start: f64,
        rough: Interval,
        workspace: &'a mut Workspace,
    ) -> Search<'a> {
        // The largest component neither overflows nor vanishes, and is the length but for a factor of at most the root of 3.
        let speed = ray.direction.abs().max_element();
        let trusts_gradient = self.trusts_gradient(workspace);
        Search {
            surface: self,
            workspace,
            trusts_gradient,
            start,
            rough,
            origin: ray.at(start),
            direction: ray.direction,
            speed,
            shortest: self.shortest() / speed,
            has_segments: self.rates == Rates::OfSegments && !trusts_gradient,
            slope: self.gradient_limit() * ray.direction.length(),
            rate_in_cell: None,
        }
    }

    /// The value at the start of a ray that leaves the surface: if rounding hides its sign, the direction of the ray decides.
    fn value_leaving(&self, ray: &Ray, value: f64, workspace: &mut Workspace) -> f64 {
        let p = ray.origin;
        let (_, gradient) = self.gradient(workspace, p);
        let size = value.abs();
        // The noise is at least that of the place, which is known sooner.
        if size <= place_noise(p, gradient) || size <= self.noise(workspace, p, gradient) {
            least_value(gradient.dot(ray.direction) < 0.0)
        } else {
            value
        }
    }

    /// A crossing of the container, within the inside of the surface.
    fn cap(&self, crossing: Crossing, side: Side) -> Crossing {
        let surface = SurfaceId {
            facet: crossing.hit.surface.facet + 1,
            ..crossing.hit.surface
        };
        Crossing {
            hit: PrimHit {
                surface,
                ..crossing.hit
            },
            side,
            visible: !self.options.open,
            ..crossing
        }
    }

    /// The error of the parameter of a crossing of the function's surface.
    fn t_error(&self, ray: &Ray, t: f64, workspace: &mut Workspace) -> f64 {
        let p = ray.at(t);
        let (_, gradient) = self.gradient(workspace, p);
        let reach = (ray.origin.abs() + (ray.direction * t).abs()) * gamma(4);
        let noise = self.noise(workspace, p, gradient) + gradient.abs().dot(reach);
        let error = noise / gradient.dot(ray.direction).abs();
        // For rays along the surface the error is bounded only by the length of the shortest part.
        let longest = SHORTEST.1 * self.size() / ray.direction.abs().max_element();
        gamma(4) * t.abs() + if error < longest { error } else { longest }
    }

    /// The point of the function's surface nearest to a point almost on it, with its error and the normal.
    fn settle(&self, ray: &Ray, point: DVec3, workspace: &mut Workspace) -> SurfacePoint {
        let nearby = SHORTEST.1 * self.size();
        let mut p = point;
        let (mut value, mut gradient) = self.gradient(workspace, p);
        for _ in 0..2 {
            let step = gradient * (value / gradient.dot(gradient));
            // A kink, a jump, or a flat place.
            if !(step.length() < nearby) {
                break;
            }
            // The last step hardly ever gets nearer, and a gradient takes twice the time of a value.
            let next = p - step;
            if !(self.value(workspace, next).abs() < value.abs()) {
                break;
            }
            p = next;
            (value, gradient) = self.gradient(workspace, p);
        }
        let slope = gradient.length();
        let off = (self.noise(workspace, p, gradient) + value.abs()) / slope;
        let off = if off < nearby { off } else { nearby };
        let normal = gradient
            .try_normalize()
            .or_else(|| (-ray.direction).try_normalize())
            .unwrap_or(DVec3::Y);
        let error = DVec3::splat(off + f64::MIN_POSITIVE) + p.abs() * (4.0 * ROUNDOFF);
        SurfacePoint::bare(p, error, normal)
    }
}

/// The cube around a box, so that the octree's cells are cubes: flat ones tell no more of a function that changes along all axes alike, but rays
/// cross more of them. Rays do not enter what is added.
fn cube_around(bounds: Aabb) -> Aabb {
    let size = bounds.size();
    let missing = DVec3::splat(size.max_element()) - size;
    Aabb::new(bounds.min - missing * 0.5, bounds.max + missing * 0.5)
}

/// The part of a function's rounding error near a point that comes from the point's.
fn place_noise(p: DVec3, gradient: DVec3) -> f64 {
    gradient.abs().dot(p.abs()) * gamma(4)
}

/// The coordinates within a cell.
fn sides(cell: &Aabb) -> [Bounds; 3] {
    [0, 1, 2].map(|k| Bounds::new(cell.min[k], cell.max[k]))
}

/// Stores an event that is a visible hit in a range, and stops there or behind the range.
fn first_hit(event: Event, range: Interval, hit: &mut Option<PrimHit>) -> ControlFlow<()> {
    let Event::Crossing(crossing) = event else {
        return ControlFlow::Continue(());
    };
    if crossing.visible && range.accepts(crossing.hit.t) {
        *hit = Some(crossing.hit);
        return ControlFlow::Break(());
    }
    if crossing.hit.t > range.max {
        return ControlFlow::Break(());
    }
    ControlFlow::Continue(())
}

/// The events along a ray.
enum Event {
    /// The ray starts within the container, or what is needed of it does: inside of the surface from there on or not. Of several
    /// starts the last one counts.
    Start {
        inside: bool,
    },
    Crossing(Crossing),
}

impl Primitive for Isosurface {
    fn kind(&self) -> &'static str {
        "isosurface"
    }

    /// [`Isosurface::try_new`] has validated everything.
    fn validate(&self) -> Result<(), GeometryError> {
        Ok(())
    }

    fn wants_box(&self) -> bool {
        true
    }

    fn bounds(&self) -> Aabb {
        self.container.bounds()
    }

    fn closest_hit(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        _scratch: &mut Scratch,
    ) -> Option<PrimHit> {
        let mut closest = None;
        with_workspace(|workspace| {
            // The result only matters while visiting.
            let visit = &mut |event| first_hit(event, range, &mut closest);
            let _ = self.walk(ray, (range, from), EXACT, workspace, visit);
        });
        closest
    }

    fn any_hit(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        _scratch: &mut Scratch,
    ) -> bool {
        let mut any = None;
        with_workspace(|workspace| {
            let visit = &mut |event| first_hit(event, range, &mut any);
            let _ = self.walk(ray, (range, from), range, workspace, visit);
        });
        any.is_some()
    }

    fn all_hits(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        scratch: &mut Scratch,
        out: &mut Vec<PrimHit>,
    ) {
        // The last bits of a search depend on where it begins.
        let is_solved = with_workspace(|workspace| self.decision(workspace).is_some());
        if is_solved {
            hits_of_solid(self, ray, range, from, scratch, out);
        } else {
            one_by_one(self, ray, range, from, scratch, out);
        }
    }

    fn surface_at(&self, ray: &Ray, hit: &PrimHit) -> SurfacePoint {
        match hit.surface.facet.checked_sub(1) {
            Some(facet) => {
                let surface = SurfaceId {
                    facet,
                    ..hit.surface
                };
                let hit = PrimHit { surface, ..*hit };
                let point = self.container.surface_at(ray, &hit);
                SurfacePoint::bare(point.position, point.position_error, point.n_geom)
            }
            None => with_workspace(|workspace| self.settle(ray, ray.at(hit.t), workspace)),
        }
    }

    fn as_solid(&self) -> Option<&dyn Solid> {
        Some(self)
    }
}

impl Solid for Isosurface {
    fn crossings(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        _scratch: &mut Scratch,
        out: &mut Crossings,
    ) {
        let start = if from.is_some() && range.min < 0.0 {
            0.0
        } else {
            range.min
        };
        with_workspace(|workspace| {
            let needed = Interval::new(start, range.max);
            let visit = &mut |event| {
                match event {
                    Event::Start { inside } => out.inside_at_start = inside,
                    Event::Crossing(c) if c.hit.t <= start => {
                        out.inside_at_start = c.side == Side::Enter;
                    }
                    Event::Crossing(c) if c.hit.t <= range.max => out.list.push(c),
                    Event::Crossing(_) => return ControlFlow::Break(()),
                }
                ControlFlow::Continue(())
            };
            let _ = self.walk(ray, (needed, from), EXACT, workspace, visit);
            if out.without_errors {
                return;
            }
            for crossing in &mut out.list {
                if crossing.surface() == SURFACE {
                    crossing.t_error = self.t_error(ray, crossing.hit.t, workspace);
                }
            }
        });
    }

    fn contains(&self, point: DVec3) -> bool {
        self.container.contains(point)
            && with_workspace(|workspace| self.value(workspace, point) <= 0.0)
    }
}
