//! Terrains: heights over a plane, made of octaves of noise.

mod number;
mod relief;
mod search;
#[cfg(test)]
mod tests;
mod tree;

use crate::primitives::{check_positive, plane_t_error};
use crate::{
    Crossing, Crossings, GeometryError, PrimHit, Primitive, Scratch, Side, Solid, SurfaceId,
    SurfacePoint,
};
use number::{Range, Rectangle, lower, upper};
use relief::Relief;
use search::{Course, Event, Part, Place, least_value};
use std::ops::ControlFlow;
use std::sync::Arc;
use strahl_math::error::{ROUNDOFF, gamma};
use strahl_math::noise::NoiseGenerator;
use strahl_math::{Aabb, DVec2, DVec3, Interval, Ray};
use tree::{Line, Tree};

/// How a terrain adds up its octaves. `n_k` is the noise from -1 to 1 at `(x, 0, z)` times `lacunarity^k`, `a_k` is
/// `lacunarity^(-h k)`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TerrainKind {
    /// Fractional Brownian motion: `offset + sum of a_k n_k`; equally rough everywhere.
    Fbm,
    /// The hetero-terrain: octave after octave `height += a_k (n_k + offset) height`; smooth valleys, rough heights. POV-Ray's
    /// `f_hetero_mf` with `T = 1`.
    Hetero,
    /// The ridged multifractal: `sum of a_k s_k` with `s_k = (offset - |n_k|)²` times `gain s_(k-1)`, cut off at 0 and 1; crests with sharp edges.
    /// POV-Ray's `f_ridged_mf`.
    #[default]
    Ridged,
}

/// How the number of octaves of a terrain grows towards a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TerrainDetail {
    /// The place, usually the camera's.
    pub viewpoint: DVec3,
    /// An octave is there where its wavelength is seen from the viewpoint under this angle or a larger one, in radians. It fades in
    /// while the distance shrinks by the lacunarity.
    pub angle: f64,
}

/// What a terrain is made of.
#[derive(Clone, Debug, PartialEq)]
pub struct TerrainOptions {
    /// How octaves are added up.
    pub kind: TerrainKind,
    /// How fast amplitudes fall with frequency: small ones make rough terrains.
    pub h: f64,
    /// The ratio of the frequencies of successive octaves, from 1.1 to 16.
    pub lacunarity: f64,
    /// The number of octaves, from 1 to 64; of a fraction the last octave is there in part. With `detail` the largest number.
    pub octaves: f64,
    /// The offset of the kind's formula.
    pub offset: f64,
    /// How much a ridge makes the next octave rough; of ridged terrains only.
    pub gain: f64,
    /// Which noise.
    pub generator: NoiseGenerator,
    /// Two corners, x and z; without them the terrain reaches 2²⁰ units from the origin in every direction.
    pub extent: Option<[DVec2; 2]>,
    /// Whether there are fewer octaves far away from a place.
    pub detail: Option<TerrainDetail>,
}

impl Default for TerrainOptions {
    /// An endless ridged terrain of eight octaves.
    fn default() -> Self {
        Self {
            kind: TerrainKind::default(),
            h: 0.9,
            lacunarity: 2.1,
            octaves: 8.0,
            offset: 1.0,
            gain: 2.0,
            generator: NoiseGenerator::default(),
            extent: None,
            detail: None,
        }
    }
}

/// A fractal terrain: the surface `y = height(x, z)` over a rectangle, solid below.
///
/// Nothing is tessellated. A quadtree, whose cells are examined when a ray first meets them, holds the ranges of heights over
/// rectangles; they are proven by affine arithmetic: octaves longer than the rectangle are linear there, nearly, and the
/// others are within a range. Within its small cells a part of a ray shrinks, or is halved, until bounds prove that the ray is clear
/// of the surface there, or that it only rises or only falls relative to it; then there is one crossing or none, and it is found to the last digit. So no peak is missed, however thin. Normals are
/// the exact gradients; on the creases of ridges they are those of one side.
///
/// With [`TerrainDetail`] the number of octaves depends on the distance from a place of the scene, not on the ray: shadows and
/// reflections have the same surface.
///
/// Element 0 is the surface; ridged ones have a facet for each smooth piece between the creases, or rather for each combination of signs of
/// their octaves. Element 1 has the sides of the solid (low x, high x, low z, high z), which are invisible, as those of height
/// fields are; there is no bottom. Texture coordinates are x and z.
///
/// F. K. Musgrave in Ebert et al., Texturing and Modeling, 3rd ed., chapter 16; J. C. Hart's sphere tracing and POV-Ray's
/// isosurfaces show the same functions, with a gradient to be guessed.
#[derive(Clone, Debug)]
pub struct Terrain {
    relief: Relief,
    rectangle: Rectangle,
    /// The range of all heights.
    heights: Range,
    tree: Arc<Tree>,
    pad: f64,
}

/// The element that is the surface.
const SURFACE: u32 = 0;

/// The element that is the sides.
const SIDES: u32 = 1;

/// How far a terrain without an extent reaches.
const ENDLESS: f64 = (1_u64 << 20) as f64;

/// How far cells are widened when they are examined, as a part of the largest coordinate: more than rounding moves a
/// point on a ray out of the cell it is in.
const PAD: f64 = 256.0 * f64::EPSILON;

/// Parts of a ray shorter than this part of the largest coordinate involved are not divided any more.
const SHORTEST: f64 = 64.0 * f64::EPSILON;

/// The error of the parameter of a crossing, as a distance, is at most this: rays along the surface have no better bound.
const GRAZING: f64 = 1e-3;

impl Terrain {
    /// The terrain of these options.
    ///
    /// # Errors
    /// A number is not finite or out of its range, the extent is empty, or heights would overflow.
    pub fn try_new(options: &TerrainOptions) -> Result<Self, GeometryError> {
        let finite = |what, x: f64| {
            if x.is_finite() {
                Ok(())
            } else {
                Err(GeometryError::NotFinite { what })
            }
        };
        finite("h of the terrain", options.h)?;
        finite("offset of the terrain", options.offset)?;
        finite("gain of the terrain", options.gain)?;
        let within = |what, expected, found: f64, low: f64, high: f64| {
            if (low..=high).contains(&found) {
                Ok(())
            } else {
                Err(GeometryError::OutOfRange {
                    what,
                    expected,
                    found,
                })
            }
        };
        within(
            "lacunarity of the terrain",
            "from 1.1 to 16",
            options.lacunarity,
            1.1,
            16.0,
        )?;
        within(
            "octaves of the terrain",
            "from 1 to 64",
            options.octaves,
            1.0,
            64.0,
        )?;
        if let Some(detail) = options.detail {
            if !detail.viewpoint.is_finite() {
                return Err(GeometryError::NotFinite {
                    what: "viewpoint of the terrain",
                });
            }
            check_positive("angle of the terrain's detail", detail.angle)?;
        }
        let [a, b] = options
            .extent
            .unwrap_or([DVec2::splat(-ENDLESS), DVec2::splat(ENDLESS)]);
        if !(a.is_finite() && b.is_finite()) {
            return Err(GeometryError::NotFinite {
                what: "extent of the terrain",
            });
        }
        let (low, high) = (a.min(b), a.max(b));
        if !low.cmplt(high).all() {
            return Err(GeometryError::Degenerate {
                what: "terrain",
                why: "its extent has no area",
            });
        }
        let rectangle = [(low.x, high.x), (low.y, high.y)];
        let relief = Relief::new(options);
        let (near, (low_y, high_y)) = (relief.range(rectangle), relief.bounds(rectangle).0.value);
        let heights = (upper(near.0, low_y), lower(near.1, high_y));
        if !(heights.0.is_finite() && heights.1.is_finite()) {
            return Err(GeometryError::Degenerate {
                what: "terrain",
                why: "its heights are too large; h must not be negative for many octaves",
            });
        }
        let largest = low.abs().max(high.abs()).max_element();
        Ok(Self {
            relief,
            rectangle,
            heights,
            tree: Arc::new(Tree::new(rectangle)),
            pad: PAD * largest.max(heights.0.abs()).max(heights.1.abs()),
        })
    }

    /// The height of the surface above `(x, z)`.
    pub fn height(&self, x: f64, z: f64) -> f64 {
        self.relief.height([x, z])
    }

    /// The sides of the solid: outward normal and a point.
    fn side(&self, facet: u32) -> (DVec3, DVec3) {
        let [(x0, x1), (z0, z1)] = self.rectangle;
        match facet {
            0 => (-DVec3::X, DVec3::X * x0),
            1 => (DVec3::X, DVec3::X * x1),
            2 => (-DVec3::Z, DVec3::Z * z0),
            _ => (DVec3::Z, DVec3::Z * z1),
        }
    }

    /// The part of a ray between the sides, with the facets at its ends; ends may be infinite.
    fn between_sides(&self, ray: &Ray, from: Option<SurfaceId>) -> Option<[(f64, u32); 2]> {
        let mut ends = [(f64::NEG_INFINITY, 0), (f64::INFINITY, 0)];
        for (axis, range, facets) in [
            (0, self.rectangle[0], [0, 1]),
            (2, self.rectangle[1], [2, 3]),
        ] {
            let (o, d) = (ray.origin[axis], ray.direction[axis]);
            if d == 0.0 {
                if o < range.0 || o > range.1 {
                    return None;
                }
                continue;
            }
            let at = |plane: f64, facet: u32| {
                let here = SurfaceId {
                    element: SIDES,
                    facet,
                };
                let starts = from == Some(here);
                (if starts { 0.0 } else { (plane - o) / d }, facet)
            };
            let (mut near, mut far) = (at(range.0, facets[0]), at(range.1, facets[1]));
            if d < 0.0 {
                (near, far) = (far, near);
            }
            if near.0 > ends[0].0 {
                ends[0] = near;
            }
            if far.0 < ends[1].0 {
                ends[1] = far;
            }
        }
        (ends[0].0 < ends[1].0).then_some(ends)
    }

    /// Reports what happens along a ray to the visitor, in order, until it stops. What is outside of the range may be left out.
    fn walk(
        &self,
        ray: &Ray,
        (range, from): (Interval, Option<SurfaceId>),
        visit: &mut impl FnMut(Event) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let speed = ray.direction.abs().max_element();
        if !(speed > 0.0 && ray.direction.is_finite() && ray.origin.is_finite()) {
            return ControlFlow::Continue(());
        }
        let Some([enter, exit]) = self.between_sides(ray, from) else {
            return ControlFlow::Continue(());
        };
        let from_within = from.is_some() && enter.0 < 0.0;
        let begin = if from_within { 0.0 } else { enter.0 };
        if !(begin < exit.0) {
            return ControlFlow::Continue(());
        }
        // What the ray enters by: a side, or it is within from the beginning.
        let entry = |inside: bool| {
            if from_within || !begin.is_finite() {
                Event::Start { inside }
            } else {
                Event::Crossing {
                    t: enter.0,
                    part: Part::Side(enter.1),
                    enters: true,
                }
            }
        };
        let Some((start, end)) = self.between_heights(ray, (begin, exit.0)) else {
            // All the way above or below all heights.
            let at = if begin.is_finite() { begin } else { 0.0 };
            if ray.at(at).y < self.heights.0 {
                visit(entry(true))?;
                return leave(exit, visit);
            }
            return ControlFlow::Continue(());
        };
        let (origin, length) = (ray.at(start), end - start);
        let needed = Interval::new(0.0, length)
            .intersection(Interval::new(range.min - start, range.max - start));
        let is_surface = from.is_some_and(|from| from.element == SURFACE);
        let leaves_surface = is_surface && start == 0.0;
        let skips = needed.min > 0.0 && !leaves_surface;
        let reach = origin.abs().max_element() + speed * length;
        let mut course = Course {
            relief: &self.relief,
            origin,
            direction: ray.direction,
            start,
            pad: self.pad,
            shortest: SHORTEST * reach / speed,
            length,
            last: Place { s: 0.0, value: 0.0 },
            inside: false,
            visit,
        };
        course.last = course.place(if skips { needed.min } else { 0.0 });
        if leaves_surface {
            course.last.value = self.value_leaving(ray, course.last.value);
        }
        course.inside = course.last.is_inside();
        let inside = course.inside;
        if skips {
            (course.visit)(Event::Start { inside })?;
        } else if inside || from_within {
            (course.visit)(entry(inside))?;
        }
        let line = Line::new(origin, ray.direction, (needed.min, needed.max), self.pad);
        self.tree.walk(&line, length, &mut course)?;
        if course.inside {
            return leave(exit, course.visit);
        }
        ControlFlow::Continue(())
    }

    /// The parameter of the first hit in a range.
    fn first(&self, ray: &Ray, range: Interval, from: Option<SurfaceId>) -> Option<f64> {
        let mut closest = None;
        // The result only matters while visiting.
        let _ = self.walk(ray, (range, from), &mut |event| match event {
            Event::Crossing { t, part, .. } if part == Part::Surface && range.accepts(t) => {
                closest = Some(t);
                ControlFlow::Break(())
            }
            Event::Crossing { t, .. } if t > range.max => ControlFlow::Break(()),
            _ => ControlFlow::Continue(()),
        });
        closest
    }

    /// The part of a ray between the lowest and the highest height.
    fn between_heights(&self, ray: &Ray, (begin, end): (f64, f64)) -> Option<(f64, f64)> {
        let (low, high) = (self.heights.0 - self.pad, self.heights.1 + self.pad);
        let (y, dy) = (ray.origin.y, ray.direction.y);
        let (mut start, mut stop) = (begin, end);
        if dy != 0.0 {
            let (a, b) = ((low - y) / dy, (high - y) / dy);
            let (near, far) = if a < b { (a, b) } else { (b, a) };
            start = if near > start { near } else { start };
            stop = if far < stop { far } else { stop };
        } else if y < low || y > high {
            return None;
        }
        (start < stop && start.is_finite() && stop.is_finite()).then_some((start, stop))
    }

    /// The value at the start of a ray that leaves the surface: if rounding hides its sign, the direction of the ray decides.
    fn value_leaving(&self, ray: &Ray, value: f64) -> f64 {
        let p = ray.origin;
        let [a, b] = self.relief.sloped([p.x, p.z]).slopes;
        let d = ray.direction;
        if value.abs() <= self.noise(p, [a, b]) {
            least_value(d.y - (a * d.x + b * d.z) < 0.0)
        } else {
            value
        }
    }

    /// The rounding error of the distance from the surface at a point.
    fn noise(&self, p: DVec3, [a, b]: [f64; 2]) -> f64 {
        let place = p.y.abs() + a.abs() * p.x.abs() + b.abs() * p.z.abs();
        2.0 * self.relief.noise + gamma(4) * place
    }

    /// The error of the parameter of a crossing of the surface.
    fn t_error(&self, ray: &Ray, t: f64) -> f64 {
        let p = ray.at(t);
        let [a, b] = self.relief.sloped([p.x, p.z]).slopes;
        let reach = (ray.origin.abs() + (ray.direction * t).abs()) * gamma(4);
        let noise = self.noise(p, [a, b]) + reach.y + a.abs() * reach.x + b.abs() * reach.z;
        let d = ray.direction;
        let error = noise / (d.y - (a * d.x + b * d.z)).abs();
        // For rays along the surface.
        let longest = GRAZING / d.abs().max_element();
        gamma(4) * t.abs() + if error < longest { error } else { longest }
    }

    /// The error of the parameter of a crossing of a side.
    fn side_error(&self, ray: &Ray, t: f64, facet: u32) -> f64 {
        let (normal, point) = self.side(facet);
        plane_t_error(ray, t, point, normal)
    }

    /// The hit on the surface at a parameter.
    fn surface_hit(&self, ray: &Ray, t: f64) -> PrimHit {
        let p = ray.at(t);
        PrimHit::simple(t, self.relief.piece([p.x, p.z]))
    }
}

/// The ray is below the surface to the end, where it leaves through a side.
fn leave(
    (t, facet): (f64, u32),
    visit: &mut impl FnMut(Event) -> ControlFlow<()>,
) -> ControlFlow<()> {
    if !t.is_finite() {
        return ControlFlow::Continue(());
    }
    visit(Event::Crossing {
        t,
        part: Part::Side(facet),
        enters: false,
    })
}

impl Primitive for Terrain {
    fn kind(&self) -> &'static str {
        "terrain"
    }

    /// [`Terrain::try_new`] has validated everything.
    fn validate(&self) -> Result<(), GeometryError> {
        Ok(())
    }

    fn bounds(&self) -> Aabb {
        let [(x0, x1), (z0, z1)] = self.rectangle;
        let (low, high) = self.heights;
        Aabb::new(DVec3::new(x0, low, z0), DVec3::new(x1, high, z1))
    }

    fn elements(&self) -> u32 {
        2
    }

    fn closest_hit(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        _scratch: &mut Scratch,
    ) -> Option<PrimHit> {
        let t = self.first(ray, range, from)?;
        Some(self.surface_hit(ray, t))
    }

    fn any_hit(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        _scratch: &mut Scratch,
    ) -> bool {
        self.first(ray, range, from).is_some()
    }

    fn surface_at(&self, ray: &Ray, hit: &PrimHit) -> SurfacePoint {
        let on_ray = ray.at(hit.t);
        if hit.surface.element == SIDES {
            let (normal, point) = self.side(hit.surface.facet);
            let position = on_ray - normal * (on_ray - point).dot(normal);
            let reach = ray.origin.abs() + (ray.direction * hit.t).abs() + point.abs();
            return SurfacePoint::bare(position, reach * gamma(8), normal);
        }
        let found = self.relief.sloped([on_ray.x, on_ray.z]);
        let [a, b] = found.slopes;
        let position = DVec3::new(on_ray.x, found.value, on_ray.z);
        let normal = DVec3::new(-a, 1.0, -b).try_normalize().unwrap_or(DVec3::Y);
        let place = DVec3::Y * self.noise(position, found.slopes);
        let error = place + position.abs() * (4.0 * ROUNDOFF) + DVec3::splat(f64::MIN_POSITIVE);
        SurfacePoint {
            uv: DVec2::new(position.x, position.z),
            dpdu: DVec3::new(1.0, a, 0.0),
            dpdv: DVec3::new(0.0, b, 1.0),
            ..SurfacePoint::bare(position, error, normal)
        }
    }

    fn store_bare_surface(&self, ray: &Ray, hit: &PrimHit, out: &mut SurfacePoint) {
        let point = self.surface_at(ray, hit);
        *out = SurfacePoint::bare(point.position, point.position_error, point.n_geom);
    }

    fn as_solid(&self) -> Option<&dyn Solid> {
        Some(self)
    }
}

impl Solid for Terrain {
    fn inside_bounds(&self) -> Aabb {
        let Aabb { min, max } = self.bounds();
        Aabb::new(DVec3::new(min.x, f64::NEG_INFINITY, min.z), max)
    }

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
        // An empty range has a side at its start, too.
        let needed = Interval::new(start, if range.max > start { range.max } else { start });
        let _ = self.walk(ray, (needed, from), &mut |event| {
            match event {
                Event::Start { inside } => out.inside_at_start = inside,
                Event::Crossing { t, enters, .. } if t <= start => out.inside_at_start = enters,
                Event::Crossing { t, part, enters } if t <= range.max => {
                    let (hit, error) = match part {
                        Part::Surface => (self.surface_hit(ray, t), self.t_error(ray, t)),
                        Part::Side(facet) => {
                            let surface = SurfaceId {
                                element: SIDES,
                                facet,
                            };
                            let uv = [0.0; 2];
                            (PrimHit { t, surface, uv }, self.side_error(ray, t, facet))
                        }
                    };
                    let side = if enters { Side::Enter } else { Side::Exit };
                    let mut crossing = Crossing::new(hit, error, side);
                    crossing.visible = part == Part::Surface;
                    out.list.push(crossing);
                }
                Event::Crossing { .. } => return ControlFlow::Break(()),
            }
            ControlFlow::Continue(())
        });
    }

    fn contains(&self, point: DVec3) -> bool {
        let [(x0, x1), (z0, z1)] = self.rectangle;
        (x0..=x1).contains(&point.x)
            && (z0..=z1).contains(&point.z)
            && point.y <= self.relief.height([point.x, point.z])
    }
}
