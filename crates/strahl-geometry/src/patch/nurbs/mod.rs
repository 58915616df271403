//! NURBS surfaces, trimmed or whole.

mod brep;
mod closed;
mod data;
mod kept;
mod part;
mod spline;
#[cfg(test)]
mod tests;
mod trim;

use super::bicubic::LARGEST;
use super::elements::{self, ElementTree, Elements, Front};
use super::frame::Frame;
use super::newton::Candidate;
use super::piece::PatchPlace;
use super::search::Keep;
use super::winding::{Pass, Winding};
use crate::primitives::point_error;
use crate::{GeometryError, PrimHit, Primitive, Scratch, Shape, Solid, SurfaceId, SurfacePoint};
use part::Part;
use std::sync::Arc;
use strahl_math::{Aabb, DVec2, DVec3, Interval, Ray, Transform};
use trim::Region;

pub use brep::NurbsBrep;
pub use data::NurbsData;
pub use trim::{NurbsCurve, TrimLoop};

/// A NURBS surface: piecewise rational, of degrees up to 9 (L. Piegl, W. Tiller, The NURBS Book, chapter 4),
///
/// `S(u, v) = sum w_ij P_ij N_i(u) N_j(v) / sum w_ij N_i(u) N_j(v)`
///
/// with control points `P`, positive weights `w` and the B-spline basis functions `N` on two lists of knots. Loops of curves in
/// the plane of the parameters may cut holes and outer borders.
///
/// Rays meet the surface itself, at any scale; nothing is replaced by triangles. Knots are inserted until the surface is made
/// of Bezier patches, which have their borders in common to the last bit, so that a ray through a border meets exactly
/// one of them. So do whole surfaces with a common border: the same control points, weights and knots there, and the same larger
/// degree.
/// The box of a trimmed surface is that of what the loops leave: it has all of it within, and is close.
/// At trimmed borders a point is there or not by the exact side of its rounded parameters; two trimmed surfaces that meet
/// along curves are as close there as their curves are.
///
/// An untrimmed surface that is closed, because its sides are the same curves or collapsed to points, as those of a sphere or a
/// torus, is a solid: a point is inside if the surface winds around it. Others have no inside, but several of them may close a volume ([`NurbsBrep`]); their front is the
/// side to which `dS/du x dS/dv` points. Texture coordinates are `u` and `v`, scaled to run from 0 to 1. Elements are the
/// Bezier patches; the facet of a hit tells its place on the patch to 2⁻¹⁶ of its sides, so that a ray that leaves it finds other hits only. Parts may be collapsed to lines or points: normals there are those of the surface
/// beside them.
#[derive(Debug)]
pub struct Nurbs {
    /// First those of which something is left, then those beside a curve, which are there for solids of several surfaces.
    parts: Vec<Part>,
    /// Over what is left of the parts.
    tree: ElementTree,
    /// A box around the parts as they were before trimming: it tells how large rounding errors are.
    whole: Aabb,
    trimming: Option<Arc<Region>>,
    front: Front,
}

/// The largest weight is at most so many times the least.
const WEIGHTS: f64 = 1e9;
/// Cells that trimming curves are put into, all curves together; with more all patches count as trimmed.
const MOST_CELLS: usize = 1 << 26;
/// Patches so near to a curve, in parts of all parameters, count as trimmed and are kept: a solid of several surfaces asks for what
/// lies just beyond a curve.
const BESIDE: f64 = 1e-4;

impl Nurbs {
    /// The whole surface.
    ///
    /// # Errors
    /// As for [`Nurbs::try_trimmed`].
    pub fn try_new(data: &NurbsData) -> Result<Self, GeometryError> {
        Self::try_trimmed(data, &[])
    }

    /// The part of the surface that the loops leave, if there are any.
    ///
    /// # Errors
    /// Degrees, knots, weights or counts are not as [`NurbsData`] and [`NurbsCurve`] say; a point is not finite or beyond 1e70;
    /// a weight is more than 1e9 times another; all points lie on a line; a loop is not closed; nothing is left; there are
    /// more than 8388608 control points after knots are inserted.
    pub fn try_trimmed(data: &NurbsData, loops: &[TrimLoop]) -> Result<Self, GeometryError> {
        let mut patches = data.patches()?;
        let mut trimming = None;
        if !loops.is_empty() {
            let region = Region::try_new(loops, patches.domain)?;
            trim(&mut patches, &region);
            trimming = Some(Arc::new(region));
        }
        if patches.parts.iter().all(|part| part.kept.is_none()) {
            return Err(GeometryError::Degenerate {
                what: "NURBS surface",
                why: "its trimming curves leave nothing of it",
            });
        }
        let is_closed = loops.is_empty() && closed::is_closed(&patches);
        Ok(Self::of(patches.parts, trimming, false, is_closed))
    }

    fn of(
        mut parts: Vec<Part>,
        trimming: Option<Arc<Region>>,
        is_flipped: bool,
        is_closed: bool,
    ) -> Self {
        parts.sort_by_key(|part| part.kept.is_none());
        let boxes: Vec<_> = parts.iter().map_while(Part::bounds).collect();
        let whole = parts.iter().map(|part| part.patch.bounds());
        let mut surface = Self {
            tree: ElementTree::new(&boxes),
            whole: whole.fold(Aabb::EMPTY, |all, own| all.union(&own)),
            parts,
            trimming,
            front: Front {
                is_flipped,
                is_closed,
                is_inside_out: false,
            },
        };
        let aims = surface.parts.iter().map(|part| part.patch.jet(0.5, 0.5)[0]);
        surface.front.is_inside_out = is_closed && surface.finds_inside_out(aims);
        surface
    }

    /// Calls `ask` with a part and what is there of it.
    fn with_part<T>(&self, id: u32, ask: impl FnOnce(&Part, Keep<'_>) -> T) -> Option<T> {
        let part = self.parts.get(id as usize)?;
        Some(match &self.trimming {
            Some(region) if part.is_trimmed => {
                ask(part, Some(&|u, v| region.contains(part.place([u, v]))))
            }
            _ => ask(part, None),
        })
    }
}

/// Leaves out the patches that the loops cut away, marks those near which curves run, and finds what is left of them.
fn trim(patches: &mut data::Patches, region: &Region) {
    let [across, up] = [0, 1].map(|k| patches.breaks[k].len() - 1);
    let mut work = 0;
    for [low, high] in region.boxes() {
        let cells = |k: usize, count: usize| {
            let breaks = &patches.breaks[k];
            let from = breaks
                .partition_point(|b| *b < low[k] - BESIDE)
                .saturating_sub(1);
            let to = breaks
                .partition_point(|b| *b <= high[k] + BESIDE)
                .min(count);
            from..to
        };
        let (columns, rows) = (cells(0, across), cells(1, up));
        work += columns.len() * rows.len();
        if work > MOST_CELLS {
            for part in &mut patches.parts {
                part.is_trimmed = true;
            }
            return;
        }
        for row in rows {
            for part in &mut patches.parts[row * across..][columns.clone()] {
                part.is_trimmed = true;
            }
        }
    }
    kept::shrink(patches, region);
    patches
        .parts
        .retain(|part| part.is_trimmed || region.contains(part.place([0.5, 0.5])));
}

/// Checks control points.
fn check_points(
    mut points: impl Iterator<Item = DVec3>,
    what: &'static str,
) -> Result<(), GeometryError> {
    let wrong = points
        .by_ref()
        .enumerate()
        .find(|(_, p)| !(p.is_finite() && p.abs().max_element() <= LARGEST));
    let Some((index, point)) = wrong else {
        return Ok(());
    };
    let index = index as u64;
    Err(if point.is_finite() {
        GeometryError::OutOfRangeAt {
            what,
            index,
            expected: "at most 1e70 from the origin",
            found: point.abs().max_element(),
        }
    } else {
        GeometryError::NotFiniteAt { what, index }
    })
}

/// Checks the weights of so many control points.
fn check_weights(
    weights: &[f64],
    count: usize,
    what: &'static str,
    all: &'static str,
) -> Result<(), GeometryError> {
    if weights.is_empty() {
        return Ok(());
    }
    if weights.len() != count {
        return Err(GeometryError::WrongCount {
            what: all,
            expected: count as u64,
            found: weights.len() as u64,
        });
    }
    let least = weights.iter().copied().fold(f64::INFINITY, f64::min);
    for (index, weight) in weights.iter().enumerate() {
        let index = index as u64;
        if !weight.is_finite() {
            return Err(GeometryError::NotFiniteAt { what, index });
        }
        let expected = if *weight <= 0.0 {
            "greater than 0"
        } else if *weight > WEIGHTS * least && least > 0.0 {
            "at most 1e9 times the least one"
        } else {
            continue;
        };
        return Err(GeometryError::OutOfRangeAt {
            what,
            index,
            expected,
            found: *weight,
        });
    }
    Ok(())
}

/// The hit of a candidate on part `id`.
fn hit(id: u32, candidate: &Candidate) -> PrimHit {
    let place = candidate.place();
    PrimHit {
        t: candidate.t,
        surface: SurfaceId {
            element: id,
            facet: PatchPlace::of(place).facet(),
        },
        uv: place,
    }
}

/// Where on part `id` a ray starts, if it leaves that part.
fn start(id: u32, from: Option<SurfaceId>) -> Option<PatchPlace> {
    from.filter(|from| from.element == id)
        .map(|from| PatchPlace::of_facet(from.facet))
}

impl Elements for Nurbs {
    type Line<'a> = Frame;

    fn line(&self, ray: &Ray) -> Option<Frame> {
        Frame::new(ray)
    }

    fn tree(&self) -> &ElementTree {
        &self.tree
    }

    fn nearest(
        &self,
        id: u32,
        frame: &Frame,
        range: Interval,
        from: Option<SurfaceId>,
    ) -> Option<PrimHit> {
        let line = (frame, start(id, from));
        let found = self.with_part(id, |part, keep| part.patch.nearest(line, range, keep));
        found.flatten().map(|candidate| hit(id, &candidate))
    }

    fn any(&self, id: u32, frame: &Frame, range: Interval, from: Option<SurfaceId>) -> bool {
        let line = (frame, start(id, from));
        self.with_part(id, |part, keep| part.patch.any(line, range, keep)) == Some(true)
    }

    fn all(&self, id: u32, frame: &Frame, passes: &mut Vec<Pass>) {
        let found = self.with_part(id, |part, keep| part.patch.all(frame, keep));
        passes.extend(found.into_iter().flatten().map(|candidate| Pass {
            hit: hit(id, &candidate),
            sign: candidate.sign,
        }));
    }
}

impl Winding for Nurbs {
    const ROUNDINGS: u32 = 128;

    fn passes(&self, ray: &Ray) -> Vec<Pass> {
        elements::passes(self, ray)
    }

    fn is_inside_out(&self) -> bool {
        self.front.is_inside_out
    }
}

impl Primitive for Nurbs {
    fn kind(&self) -> &'static str {
        "nurbs"
    }

    /// The constructors have validated everything.
    fn validate(&self) -> Result<(), GeometryError> {
        Ok(())
    }

    fn bounds(&self) -> Aabb {
        self.tree.bounds()
    }

    fn elements(&self) -> u32 {
        self.tree.count()
    }

    fn closest_hit(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        _scratch: &mut Scratch,
    ) -> Option<PrimHit> {
        elements::nearest(self, ray, range, from)
    }

    fn any_hit(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        _scratch: &mut Scratch,
    ) -> bool {
        elements::any(self, ray, range, from)
    }

    fn surface_at(&self, ray: &Ray, hit: &PrimHit) -> SurfacePoint {
        let Some(part) = self.parts.get(hit.surface.element as usize) else {
            return SurfacePoint::bare(ray.at(hit.t), DVec3::ZERO, elements::against(ray));
        };
        let uv = DVec2::from_array(hit.uv);
        let jet = part.patch.jet(uv.x, uv.y);
        let back = part.patch.normal(uv, jet);
        let normal = self.front.normal(back.map(|back| -back), ray);
        let [position, by_u, by_v] = jet;
        let size = DVec2::from_array(part.to) - DVec2::from_array(part.from);
        let error = point_error(position, self.whole.max_abs(), Self::ROUNDINGS);
        elements::textured(
            SurfacePoint::bare(position, error, normal),
            DVec2::from_array(part.place(hit.uv)),
            [by_u / size.x, by_v / size.y],
        )
    }

    fn texture_uv(&self, _hit: &PrimHit, uv: DVec2) -> Option<DVec2> {
        Some(uv)
    }

    fn as_solid(&self) -> Option<&dyn Solid> {
        self.front.is_closed.then_some(self as &dyn Solid)
    }

    fn baked(&self, map: &Transform) -> Option<Shape> {
        let parts = self
            .parts
            .iter()
            .map(|part| Part {
                patch: part.patch.mapped(map),
                ..*part
            })
            .collect();
        let mapped = Self::of(
            parts,
            self.trimming.clone(),
            self.front.is_flipped != map.mirrors(),
            self.front.is_closed,
        );
        let bounds = mapped.whole;
        if !(bounds.max_abs() <= LARGEST && elements::keeps_its_shape(&bounds)) {
            return None;
        }
        let is_flat = mapped.parts.iter().all(|part| part.patch.is_on_a_line());
        (!is_flat).then(|| mapped.into())
    }
}
