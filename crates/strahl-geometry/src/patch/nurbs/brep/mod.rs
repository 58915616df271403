//! Solids bounded by trimmed NURBS surfaces.

mod arc;
mod boxes;
mod closing;
mod face;
mod sequence;
#[cfg(test)]
mod tests;
mod turning;

use super::{Nurbs, hit};
use crate::patch::elements::{self, ElementTree};
use crate::patch::frame::Frame;
use crate::patch::winding::{Pass, Winding};
use crate::primitives::point_error;
use crate::{GeometryError, PrimHit, Primitive, Scratch, Solid, SurfaceId, SurfacePoint};
use face::{Face, Standing};
use sequence::{CERTAIN, Doubt, Settled, settle};
use std::sync::Arc;
use strahl_accel::Visitor;
use strahl_math::{Aabb, DVec2, DVec3, Interval, Ray};

/// A solid within NURBS surfaces, trimmed or whole, which together close a volume: a boundary representation, as programs for
/// computer-aided design write.
///
/// Each border of a face must be that of another face, too, or of the same face elsewhere (the seam of a cylinder), within a
/// ten-thousandth of the diagonal of the whole. Sides that are collapsed to a point are no borders. The faces may be given in any order and turned
/// either way: which side of each is outside is found out with lines that cross it. Faces may touch at their borders only;
/// several shells are one solid if they don't meet, and a shell within another is a cavity.
///
/// Curves that trim neighbours never run exactly along each other in space. A line that meets the shell beside an edge may slip through
/// between two faces, or meet both. Therefore each surface is continued a little beyond its border, and each crossing near a border,
/// on either side of it, counts as doubtful: by how much, its distance from the border in space tells. Of all
/// sequences in which entering and leaving alternate, the line has the one that contradicts the faces least. Between two doubtful crossings
/// that are far apart another line tells whether it is inside there. So every line leaves the solid as often as it enters, whatever the gaps.
///
/// ```
/// # use std::sync::Arc;
/// # use strahl_geometry::{Nurbs, NurbsBrep, NurbsData, Primitive};
/// # use strahl_math::DVec3;
/// let face = |(corner, u, v): (DVec3, DVec3, DVec3)| {
///     let points = vec![corner, corner + u, corner + v, corner + u + v];
///     Nurbs::try_new(&NurbsData::new([1, 1], 2, points)).map(Arc::new)
/// };
/// let (o, x, y, z) = (DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z);
/// let sides = [(o, x, y), (z, x, y), (o, y, z), (x, y, z), (o, z, x), (y, z, x)];
/// let faces = sides.into_iter().map(face).collect::<Result<Vec<_>, _>>()?;
/// let cube = NurbsBrep::try_new(&faces)?;
/// assert!(cube.as_solid().is_some_and(|solid| solid.contains(DVec3::splat(0.5))));
/// let error = NurbsBrep::try_new(&faces[1..]).unwrap_err().to_string();
/// assert!(error.contains("face 1 (counted from 0) has a border at"));
/// # Ok::<(), strahl_geometry::GeometryError>(())
/// ```
///
/// Elements are the Bezier patches of all faces, one face after the other, with one facet each. Texture coordinates are those of each face: `u` and
/// `v`, scaled to run from 0 to 1.
#[derive(Debug)]
pub struct NurbsBrep {
    faces: Vec<Face>,
    /// For each face 1 if `dS/du x dS/dv` points outwards, otherwise -1.
    turns: Vec<i32>,
    /// The face of each element, and its number there.
    owners: Vec<[u32; 2]>,
    /// Over the elements.
    tree: ElementTree,
    /// The width of gaps between faces, at most.
    tolerance: f64,
    /// How far from a border crossings are doubtful at most.
    farthest: f64,
}

/// Crossings are doubtful up to so many tolerances from a border: a line at a low angle is further from it than the gap is wide.
const REACH: f64 = 16.0;
/// If a certain crossing would have to be left out, a line is at so low an angle that others are doubtful up to this part of the shell's diagonal.
const FARTHEST: f64 = 1e-3;
/// A point that is further than so many reaches from where a line meets faces is asked whether it is inside.
const APART: f64 = 4.0;

/// A place where a line meets a face, or its surface just beyond the border.
#[derive(Clone, Copy, Debug)]
struct Meeting {
    hit: PrimHit,
    /// That of the direction along `dS/du x dS/dv`.
    sign: i32,
    face: usize,
    standing: Standing,
}

impl NurbsBrep {
    /// The solid within faces that close a volume.
    ///
    /// # Errors
    /// There are no faces; a border is not that of exactly one other face ([`GeometryError::NotClosedAt`] with the number of the face and, in
    /// words, the place); faces cross.
    pub fn try_new(faces: &[Arc<Nurbs>]) -> Result<Self, GeometryError> {
        if faces.is_empty() {
            return Err(GeometryError::Degenerate {
                what: "brep",
                why: "it has no faces",
            });
        }
        let mut faces: Vec<Face> = faces.iter().map(|face| Face::new(face)).collect();
        let extents = faces.iter().map(Face::extent);
        let extent = extents.fold(Aabb::EMPTY, |all, own| all.union(&own));
        let tolerance = closing::tolerance(&faces, &extent)?;
        let farthest = (FARTHEST * extent.size().length()).max(REACH * tolerance);
        for face in &mut faces {
            face.continue_by(farthest);
        }
        let (mut owners, mut boxes) = (vec![], vec![]);
        for (number, face) in (0..).zip(&faces) {
            for (part, own) in (0..).zip(face.parts()) {
                owners.push([number, part]);
                boxes.push(own.patch.bounds());
            }
        }
        let mut shell = Self {
            turns: vec![1; faces.len()],
            faces,
            owners,
            tree: ElementTree::new(&boxes),
            tolerance,
            farthest,
        };
        shell.turns = turning::turns(&shell)?;
        Ok(shell)
    }

    /// How many faces there are.
    pub const fn face_count(&self) -> usize {
        self.faces.len()
    }

    /// How wide gaps and overlaps between its faces may be: twice the widest that was found, and at least a billionth of the whole.
    pub const fn tolerance(&self) -> f64 {
        self.tolerance
    }

    fn reach(&self) -> f64 {
        REACH * self.tolerance
    }

    fn owner(&self, element: u32) -> Option<(usize, usize)> {
        let [face, part] = *self.owners.get(element as usize)?;
        Some((face as usize, part as usize))
    }

    /// All places where a line meets faces, and those up to `reach` beyond their borders, in their order.
    fn meetings(&self, ray: &Ray, reach: f64) -> Vec<Meeting> {
        let Some(frame) = Frame::new(ray) else {
            return vec![];
        };
        let mut visitor = Meetings {
            shell: self,
            frame,
            reach,
            found: vec![],
        };
        self.tree.walk(ray, Interval::LINE, &mut visitor);
        let mut found = visitor.found;
        // An order that depends on nothing but the meetings.
        found.sort_by(|a, b| {
            let element = |m: &Meeting| m.hit.surface.element;
            let [p, q] = [a.hit.uv, b.hit.uv];
            a.hit
                .t
                .total_cmp(&b.hit.t)
                .then(element(a).cmp(&element(b)))
                .then(p[0].total_cmp(&q[0]))
                .then(p[1].total_cmp(&q[1]))
        });
        found
    }

    /// The sign of a meeting is 1 where the line leaves, if it crosses the shell there.
    fn sign(&self, meeting: &Meeting) -> i32 {
        meeting.sign * self.turns[meeting.face]
    }

    /// Which meetings of a line, up to `reach` beyond borders, are crossings of the shell.
    fn settled(&self, ray: &Ray, reach: f64) -> (Vec<Meeting>, Settled) {
        let meetings = self.meetings(ray, reach);
        let doubts = self.doubts(&meetings);
        let apart = APART * reach / ray.direction.length();
        let mut known = vec![];
        for (place, pair) in meetings.windows(2).enumerate() {
            let [from, to] = [pair[0].hit.t, pair[1].hit.t];
            let is_doubtful = doubts[place..=place + 1].iter().all(|d| d.cost < CERTAIN);
            if is_doubtful && to - from > 2.0 * apart {
                let middle = ray.at(0.5 * (from + to));
                known.extend(self.asks(middle).map(|is_inside| (place, is_inside)));
            }
        }
        let settled = settle(&doubts, &known);
        (meetings, settled)
    }

    fn doubts(&self, meetings: &[Meeting]) -> Vec<Doubt> {
        let doubt = |m: &Meeting| Doubt {
            enters: self.sign(m) < 0,
            is_on: m.standing.is_on,
            cost: m.standing.distance.map_or(CERTAIN, |d| d / self.tolerance),
        };
        meetings.iter().map(doubt).collect()
    }

    /// Whether a point is inside, from the first line through it that is certain in all it meets; `None` if there is none.
    fn asks(&self, point: DVec3) -> Option<bool> {
        let certain = |direction: &DVec3| {
            let meetings = self.meetings(&Ray::new(point, *direction), self.reach());
            let settled = settle(&self.doubts(&meetings), &[]);
            let before = meetings.iter().filter(|m| m.hit.t < 0.0).count();
            let is_certain = settled.cost == 0.0 && meetings.iter().all(Meeting::is_certain);
            is_certain.then_some(before % 2 == 1)
        };
        turning::DIRECTIONS.iter().find_map(certain)
    }
}

impl Meeting {
    /// Whether the line meets the face far from its border.
    fn is_certain(&self) -> bool {
        self.standing.is_on && self.standing.distance.is_none()
    }
}

/// Collects meetings with the elements along a line.
struct Meetings<'a> {
    shell: &'a NurbsBrep,
    frame: Frame,
    reach: f64,
    found: Vec<Meeting>,
}

impl Visitor for Meetings<'_> {
    fn visit(&mut self, id: u32, t_max: f64) -> f64 {
        let Some((face, part)) = self.shell.owner(id) else {
            return t_max;
        };
        let own = &self.shell.faces[face];
        let Some(patch) = own.parts().get(part).map(|part| &part.patch) else {
            return t_max;
        };
        for candidate in patch.all(&self.frame, None) {
            let standing = own.standing(part, candidate.place(), self.reach);
            if standing.is_on || standing.distance.is_some() {
                self.found.push(Meeting {
                    hit: hit(id, &candidate),
                    sign: candidate.sign,
                    face,
                    standing,
                });
            }
        }
        t_max
    }
}

impl Winding for NurbsBrep {
    const ROUNDINGS: u32 = 128;

    /// The passes through the shell, in their order; the sign is 1 where the line leaves.
    fn passes(&self, ray: &Ray) -> Vec<Pass> {
        let (mut meetings, mut settled) = self.settled(ray, self.reach());
        if settled.cost >= CERTAIN {
            let (more, other) = self.settled(ray, self.farthest);
            if other.cost < settled.cost {
                (meetings, settled) = (more, other);
            }
        }
        let pairs = meetings
            .iter()
            .zip(settled.taken)
            .filter(|(_, is_taken)| *is_taken);
        pairs
            .map(|(m, _)| Pass {
                hit: m.hit,
                sign: self.sign(m),
            })
            .collect()
    }

    fn is_inside_out(&self) -> bool {
        false
    }
}

impl Primitive for NurbsBrep {
    fn kind(&self) -> &'static str {
        "brep"
    }

    /// The constructor has validated everything.
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
        _from: Option<SurfaceId>,
        _scratch: &mut Scratch,
    ) -> Option<PrimHit> {
        // What is doubtful on one side of the range may be settled by what is on the other: the line is looked at as a whole.
        let passes = self.passes_in_order(ray);
        passes
            .iter()
            .map(|pass| pass.hit)
            .find(|hit| range.accepts(hit.t))
    }

    fn all_hits(
        &self,
        ray: &Ray,
        mut range: Interval,
        _from: Option<SurfaceId>,
        _scratch: &mut Scratch,
        out: &mut Vec<PrimHit>,
    ) {
        for pass in self.passes_in_order(ray) {
            if !range.is_empty() && range.accepts(pass.hit.t) {
                out.push(pass.hit);
                // The lower end of a range is open.
                range.min = pass.hit.t;
            }
        }
    }

    fn surface_at(&self, ray: &Ray, hit: &PrimHit) -> SurfacePoint {
        let owner = self.owner(hit.surface.element);
        let face =
            owner.and_then(|(face, _)| Some((self.faces.get(face)?, *self.turns.get(face)?)));
        let part = owner
            .zip(face)
            .and_then(|((_, part), (face, _))| face.parts().get(part));
        let (Some((face, turn)), Some(part)) = (face, part) else {
            return SurfacePoint::bare(ray.at(hit.t), DVec3::ZERO, elements::against(ray));
        };
        let uv = DVec2::from_array(hit.uv);
        let back = part.patch.normal(uv, part.patch.jet(uv.x, uv.y));
        let normal = back.map_or(elements::against(ray), |back| back * -f64::from(turn));
        let [position, by_u, by_v] = face.jet_in(part, hit.uv);
        let error = point_error(position, self.bounds().max_abs(), Self::ROUNDINGS);
        elements::textured(
            SurfacePoint::bare(position, error, normal),
            DVec2::from_array(part.place(hit.uv)).clamp(DVec2::ZERO, DVec2::ONE),
            [by_u, by_v],
        )
    }

    fn texture_uv(&self, _hit: &PrimHit, uv: DVec2) -> Option<DVec2> {
        Some(uv)
    }

    fn as_solid(&self) -> Option<&dyn Solid> {
        Some(self)
    }
}
