use crate::algebraic::Pieces;
use crate::csg::Workspace;
use crate::{Crossings, Shape};
use std::sync::Arc;
use strahl_math::{Aabb, DVec2, DVec3, Interval, Ray, Transform};

/// Names one smooth piece of a primitive's surface.
///
/// `element` numbers the parts of a primitive: the triangles of a mesh, the leaves of a CSG tree (a mesh inside a tree takes as
/// many numbers as it has triangles). Simple shapes have the single element 0. `facet` numbers the smooth pieces of an element,
/// as its documentation says: the side and the caps of a cylinder, the six faces of a box.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct SurfaceId {
    /// The part, `0..primitive.elements()`.
    pub element: u32,
    /// The smooth piece of that part.
    pub facet: u32,
}

/// The result of an intersection test: small, `Copy`, just enough to compute the surface later.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrimHit {
    /// Ray parameter, in units of the ray's direction.
    pub t: f64,
    /// The piece of surface that was hit.
    pub surface: SurfaceId,
    /// Two numbers for [`Primitive::surface_at`], whose meaning depends on the primitive; barycentric coordinates of vertices 1
    /// and 2 on triangles.
    pub uv: [f64; 2],
}

impl PrimHit {
    /// A hit on facet `facet` of element 0.
    pub const fn simple(t: f64, facet: u32) -> Self {
        Self {
            t,
            surface: SurfaceId { element: 0, facet },
            uv: [0.0; 2],
        }
    }
}

/// A point on a surface with normals and texture coordinates, in the space of the ray that found it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// The point, moved onto the surface as exactly as f64 allows (not merely `ray.at(t)`).
    pub position: DVec3,
    /// Bound on the absolute error of `position`, coordinate by coordinate.
    pub position_error: DVec3,
    /// Unit normal of the geometry. On solids it points outwards, on open surfaces to the front.
    pub n_geom: DVec3,
    /// Unit normal for shading: `n_geom`, or the interpolated normal of a smooth triangle.
    pub n_shade: DVec3,
    /// Texture coordinates.
    pub uv: DVec2,
    /// Derivative of the position with respect to `uv.x`; zero where there is none.
    pub dpdu: DVec3,
    /// Derivative of the position with respect to `uv.y`; zero where there is none.
    pub dpdv: DVec3,
}

impl SurfacePoint {
    /// A place for a surface that will be stored.
    pub const UNKNOWN: Self = Self {
        position: DVec3::ZERO,
        position_error: DVec3::ZERO,
        n_geom: DVec3::ZERO,
        n_shade: DVec3::ZERO,
        uv: DVec2::ZERO,
        dpdu: DVec3::ZERO,
        dpdv: DVec3::ZERO,
    };

    /// A point without texture coordinates, shaded as the flat surface it lies on.
    #[inline(always)]
    pub(crate) fn bare(position: DVec3, position_error: DVec3, normal: DVec3) -> Self {
        Self {
            position,
            position_error,
            n_geom: normal,
            n_shade: normal,
            uv: DVec2::ZERO,
            dpdu: DVec3::ZERO,
            dpdv: DVec3::ZERO,
        }
    }
}

/// Working memory of intersection tests, one per thread, because primitives are immutable.
#[derive(Debug, Default)]
pub struct Scratch {
    pool: Vec<Crossings>,
    #[expect(
        clippy::vec_box,
        reason = "taken and given back for every ray: a pointer is moved instead of ten lists"
    )]
    csg: Vec<Box<Workspace>>,
    pieces: Vec<Pieces>,
    hits: Vec<PrimHit>,
}

impl Scratch {
    /// Borrows an empty list of crossings; give it back with [`Scratch::give`].
    pub fn take(&mut self) -> Crossings {
        self.pool.pop().unwrap_or_default()
    }

    /// Returns a list, so that its memory is used again.
    pub fn give(&mut self, mut list: Crossings) {
        list.clear();
        self.pool.push(list);
    }

    /// Borrows an empty list of hits; give it back with [`Scratch::give_hits`].
    pub fn take_hits(&mut self) -> Vec<PrimHit> {
        std::mem::take(&mut self.hits)
    }

    /// Returns it, so that its memory is used again.
    pub fn give_hits(&mut self, mut hits: Vec<PrimHit>) {
        hits.clear();
        self.hits = hits;
    }

    /// Borrows the stacks that CSG trees are evaluated with; several when a tree is a leaf of another.
    pub(crate) fn take_csg(&mut self) -> Box<Workspace> {
        self.csg.pop().unwrap_or_default()
    }

    /// Returns them.
    pub(crate) fn give_csg(&mut self, workspace: Box<Workspace>) {
        self.csg.push(workspace);
    }

    /// Borrows the lists for rays through blobs.
    pub(crate) fn take_pieces(&mut self) -> Pieces {
        self.pieces.pop().unwrap_or_default()
    }

    /// Returns them.
    pub(crate) fn give_pieces(&mut self, mut pieces: Pieces) {
        pieces.clear();
        self.pieces.push(pieces);
    }
}

/// A surface that a ray can hit.
///
/// # Contract
/// * A result depends on `(self, ray, range, from)` only: not on earlier calls, neighbours or the thread.
/// * The ray's direction may have any length; `t` is never rescaled.
/// * A hit `t` satisfies [`Interval::accepts`]. Rays with a NaN or a zero direction hit nothing.
/// * Only `+ - * /`, square root, comparisons and [`strahl_math::det`] decide the result, never a fused multiply-add.
/// * **Root identity**: `from` names the piece of this primitive's surface on which the ray starts. On a planar piece it
///   is not hit again; on a curved one the root at `t = 0` is removed exactly (the constant term of the polynomial is
///   taken as zero), so no tolerance is needed and the far side of the same surface is still found.
pub trait Primitive: Send + Sync + std::fmt::Debug {
    /// The name of this kind of primitive, lower case: `sphere`, `torus`.
    fn kind(&self) -> &'static str;

    /// Checks the parameters. Constructors named `new` accept anything; scenes are validated when they are compiled.
    ///
    /// # Errors
    /// The parameter that is wrong, and why. Queries of an invalid primitive may return anything, but don't panic.
    fn validate(&self) -> Result<(), GeometryError>;

    /// A box around the surface; may be unbounded. Conservative: contains every point `ray.at(t)` of a hit up to the
    /// rounding of that expression.
    fn bounds(&self) -> Aabb;

    /// How many elements [`SurfaceId::element`] distinguishes; at least 1.
    fn elements(&self) -> u32 {
        1
    }

    /// The hit with the smallest `t` in `range`; at equal `t` that with the smaller element, then the smaller facet.
    fn closest_hit(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        scratch: &mut Scratch,
    ) -> Option<PrimHit>;

    /// Whether there is a hit in `range`: the same answer as `closest_hit(..).is_some()`, possibly faster.
    fn any_hit(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        scratch: &mut Scratch,
    ) -> bool {
        self.closest_hit(ray, range, from, scratch).is_some()
    }

    /// Whether rays should be tested for the box around the shape before they are for the shape, where they have not met that box yet: because the
    /// shape's own test takes ten times as long, and does not begin with a box.
    fn wants_box(&self) -> bool {
        false
    }

    /// Appends all hits in `range` to `out`: those that [`Primitive::closest_hit`] finds one behind the other.
    fn all_hits(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        scratch: &mut Scratch,
        out: &mut Vec<PrimHit>,
    ) {
        one_by_one(self, ray, range, from, scratch, out);
    }

    /// The surface at a hit that this primitive reported for this ray.
    fn surface_at(&self, ray: &Ray, hit: &PrimHit) -> SurfacePoint;

    /// Stores the same surface without `uv`, `dpdu` and `dpdv`, which have no meaning then: possibly faster.
    // In place: a result of this size would be stored twice, and its copy would wait for the first.
    fn store_bare_surface(&self, ray: &Ray, hit: &PrimHit, out: &mut SurfacePoint) {
        *out = self.surface_at(ray, hit);
    }

    /// What [`Primitive::store_bare_surface`] stores.
    fn bare_surface_at(&self, ray: &Ray, hit: &PrimHit) -> SurfacePoint {
        let mut surface = SurfacePoint::UNKNOWN;
        self.store_bare_surface(ray, hit, &mut surface);
        surface
    }

    /// Where textures with `uv_mapping` are evaluated at a hit; `uv` is what `surface_at` gave. `None` for surfaces that POV-Ray
    /// has no mapping for, even if `uv` is a useful parameter: there x and y of the world are taken.
    fn texture_uv(&self, _hit: &PrimHit, _uv: DVec2) -> Option<DVec2> {
        None
    }

    /// The primitive as a solid, if it encloses a volume.
    fn as_solid(&self) -> Option<&dyn Solid> {
        None
    }

    /// The primitive with a map applied, if the result is again a shape of this crate: same points, same front, same facets,
    /// same texture coordinates, up to rounding. Otherwise `None`; the renderer then transforms rays into the primitive's own
    /// space.
    fn baked(&self, _map: &Transform) -> Option<Shape> {
        None
    }
}

/// [`Primitive::all_hits`] of a solid whose crossings are found together in less time than one by one.
pub(crate) fn hits_of_solid(
    solid: &impl Solid,
    ray: &Ray,
    range: Interval,
    from: Option<SurfaceId>,
    scratch: &mut Scratch,
    out: &mut Vec<PrimHit>,
) {
    let mut list = scratch.take();
    list.without_errors = true;
    solid.crossings(ray, range, from, scratch, &mut list);
    // The lower end of a range is open, and so is that behind a hit.
    let mut rest = range;
    for crossing in list.list.iter().filter(|crossing| crossing.visible) {
        if rest.accepts(crossing.hit.t) {
            rest.min = crossing.hit.t;
            out.push(crossing.hit);
        }
    }
    scratch.give(list);
}

/// All hits, each searched behind the one before.
pub(crate) fn one_by_one<P: Primitive + ?Sized>(
    primitive: &P,
    ray: &Ray,
    mut range: Interval,
    from: Option<SurfaceId>,
    scratch: &mut Scratch,
    out: &mut Vec<PrimHit>,
) {
    while let Some(hit) = primitive.closest_hit(ray, range, from, scratch) {
        out.push(hit);
        // The lower end of a range is open.
        range.min = hit.t;
        if range.is_empty() {
            return;
        }
    }
}

/// A primitive that encloses a volume.
pub trait Solid: Primitive {
    /// A box around the inside. By default that of the surface, [`Primitive::bounds`]; they differ where the inside reaches
    /// further than the visible surface, as below height fields.
    fn inside_bounds(&self) -> Aabb {
        self.bounds()
    }

    /// The side of the surface that all of a box certainly lies on: `true` inside, `false` outside, with no surface in it. `None` if that is not
    /// known, as by default.
    fn side_of(&self, _cell: &Aabb) -> Option<bool> {
        None
    }

    /// Appends all crossings of the surface with `range.min < t <= range.max`, ascending in `t`, and sets
    /// [`Crossings::inside_at_start`] to whether the ray just behind `range.min` is inside.
    ///
    /// `out` is empty on entry. Every change from outside to inside is listed, so entering and leaving alternate. Touching the
    /// surface without getting inside is no crossing. `from` as in [`Primitive`]: the root at the start is not listed, and
    /// `inside_at_start` is the state on the side that the ray leaves towards; a negative `range.min` is taken as 0 then.
    fn crossings(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        scratch: &mut Scratch,
        out: &mut Crossings,
    );

    /// Whether the point is inside or on the boundary.
    fn contains(&self, point: DVec3) -> bool;
}

/// A shared primitive is a primitive: large ones (meshes, trees) are held this way.
impl<P: Primitive + ?Sized> Primitive for Arc<P> {
    fn kind(&self) -> &'static str {
        (**self).kind()
    }

    fn validate(&self) -> Result<(), GeometryError> {
        (**self).validate()
    }

    fn bounds(&self) -> Aabb {
        (**self).bounds()
    }

    fn elements(&self) -> u32 {
        (**self).elements()
    }

    fn closest_hit(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        scratch: &mut Scratch,
    ) -> Option<PrimHit> {
        (**self).closest_hit(ray, range, from, scratch)
    }

    fn any_hit(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        scratch: &mut Scratch,
    ) -> bool {
        (**self).any_hit(ray, range, from, scratch)
    }

    fn wants_box(&self) -> bool {
        (**self).wants_box()
    }

    fn all_hits(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        scratch: &mut Scratch,
        out: &mut Vec<PrimHit>,
    ) {
        (**self).all_hits(ray, range, from, scratch, out);
    }

    fn surface_at(&self, ray: &Ray, hit: &PrimHit) -> SurfacePoint {
        (**self).surface_at(ray, hit)
    }

    fn store_bare_surface(&self, ray: &Ray, hit: &PrimHit, out: &mut SurfacePoint) {
        (**self).store_bare_surface(ray, hit, out);
    }

    fn texture_uv(&self, hit: &PrimHit, uv: DVec2) -> Option<DVec2> {
        (**self).texture_uv(hit, uv)
    }

    fn as_solid(&self) -> Option<&dyn Solid> {
        (**self).as_solid()
    }

    fn baked(&self, map: &Transform) -> Option<Shape> {
        (**self).baked(map)
    }
}

/// Parameters that don't describe a shape.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GeometryError {
    /// A value is NaN or infinite.
    #[error("{what} is not a finite number")]
    NotFinite {
        /// The parameter.
        what: &'static str,
    },
    /// A length, radius or direction that must not vanish is zero, or one that must be positive is negative.
    #[error("{what} must be {expected}, found {found}")]
    OutOfRange {
        /// The parameter.
        what: &'static str,
        /// The expected value, in words.
        expected: &'static str,
        /// The value given.
        found: f64,
    },
    /// The shape has no surface (all corners on a line, base and apex equal, ...).
    #[error("the {what} is degenerate: {why}")]
    Degenerate {
        /// The kind of shape.
        what: &'static str,
        /// The reason, in words.
        why: &'static str,
    },
    /// An index of a mesh points outside of its list.
    #[error("{what} index {index} is out of range: there are {count}")]
    IndexOutOfRange {
        /// The kind of index.
        what: &'static str,
        /// The index given, counted from 0.
        index: u64,
        /// The number of entries.
        count: u64,
    },
    /// An entry of a list has a NaN or an infinity in it.
    #[error("{what} {index} is not finite")]
    NotFiniteAt {
        /// The kind of entry.
        what: &'static str,
        /// Its place in the list, counted from 0.
        index: u64,
    },
    /// An entry of a list is not as it should be.
    #[error("{what} {index} must be {expected}, found {found}")]
    OutOfRangeAt {
        /// The kind of entry.
        what: &'static str,
        /// Its place in the list, counted from 0.
        index: u64,
        /// The expected value, in words.
        expected: &'static str,
        /// The value given.
        found: f64,
    },
    /// Lists that belong together differ in length.
    #[error("{found} {what} given, {expected} expected")]
    WrongCount {
        /// What the list holds.
        what: &'static str,
        /// The length it should have.
        expected: u64,
        /// The length it has.
        found: u64,
    },
    /// The faces of a mesh don't fit together as a surface.
    #[error("{what} is not a surface: {why}")]
    NotASurface {
        /// The object.
        what: &'static str,
        /// The reason, in words.
        why: String,
    },
    /// A mesh or tree that should enclose a volume doesn't.
    #[error("{what} is not closed: {why}")]
    NotClosed {
        /// The object.
        what: &'static str,
        /// The reason, in words.
        why: String,
    },
    /// A part of an object that should enclose a volume leaves it open.
    #[error("{what} is not closed: {why}")]
    NotClosedAt {
        /// The object.
        what: &'static str,
        /// The number of the part, counted from 0.
        index: u64,
        /// The reason, in words.
        why: String,
    },
}
