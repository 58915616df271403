//! Surfaces of elements in a tree: what NURBS and subdivision surfaces have in common.

use super::winding::Pass;
use crate::{PrimHit, SurfaceId, SurfacePoint};
use strahl_accel::{Accelerator, Bvh2, TraversalStats, Visitor};
use strahl_math::{Aabb, DVec2, DVec3, Interval, Ray};

/// The elements of a surface by their boxes.
#[derive(Debug)]
pub(super) struct ElementTree {
    /// Relative to the anchor.
    tree: Bvh2,
    anchor: DVec3,
    bounds: Aabb,
    count: u32,
}

impl ElementTree {
    pub(super) fn new(boxes: &[Aabb]) -> Self {
        let bounds = boxes.iter().fold(Aabb::EMPTY, |all, own| all.union(own));
        let anchor = bounds.min;
        let local: Vec<_> = boxes
            .iter()
            .map(|own| Aabb::new(own.min - anchor, own.max - anchor))
            .collect();
        Self {
            tree: Bvh2::build(&local),
            anchor,
            bounds,
            count: boxes.len() as u32,
        }
    }

    pub(super) fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// The number of elements.
    pub(super) fn count(&self) -> u32 {
        self.count
    }

    /// The bytes that it takes beside itself.
    pub(super) fn bytes(&self) -> usize {
        self.tree.bytes()
    }

    /// Shows the elements along a ray to the visitor.
    pub(super) fn walk<V: Visitor>(&self, ray: &Ray, range: Interval, visitor: &mut V) {
        let local = Ray::new(ray.origin - self.anchor, ray.direction);
        self.tree
            .traverse(&local, range, visitor, &mut TraversalStats::default());
    }
}

/// A surface of elements, each of which can be asked for its own hits.
pub(super) trait Elements {
    /// A ray, prepared for what elements are asked along it.
    type Line<'a>;

    /// `None` if the ray has no direction or no place.
    fn line<'a>(&self, ray: &'a Ray) -> Option<Self::Line<'a>>;

    fn tree(&self) -> &ElementTree;

    /// The nearest hit of an element in a range, for a line that starts there, if it leaves the surface.
    fn nearest(
        &self,
        element: u32,
        line: &Self::Line<'_>,
        range: Interval,
        from: Option<SurfaceId>,
    ) -> Option<PrimHit>;

    /// Whether an element has a hit in a range, for a line that starts there, if it leaves the surface.
    fn any(
        &self,
        element: u32,
        line: &Self::Line<'_>,
        range: Interval,
        from: Option<SurfaceId>,
    ) -> bool;

    /// Adds all passes of the line through an element.
    fn all(&self, element: u32, line: &Self::Line<'_>, passes: &mut Vec<Pass>);
}

/// The nearest hit of a surface.
pub(super) fn nearest<S: Elements>(
    surface: &S,
    ray: &Ray,
    range: Interval,
    from: Option<SurfaceId>,
) -> Option<PrimHit> {
    let mut visitor = Nearest {
        surface,
        line: surface.line(ray)?,
        range,
        from,
        best: None,
    };
    surface.tree().walk(ray, range, &mut visitor);
    visitor.best
}

/// Whether a surface has a hit.
pub(super) fn any<S: Elements>(
    surface: &S,
    ray: &Ray,
    range: Interval,
    from: Option<SurfaceId>,
) -> bool {
    let Some(line) = surface.line(ray) else {
        return false;
    };
    let mut visitor = Any {
        surface,
        line,
        range,
        from,
        found: false,
    };
    surface.tree().walk(ray, range, &mut visitor);
    visitor.found
}

/// All passes of a line through a surface, in no order.
pub(super) fn passes<S: Elements>(surface: &S, ray: &Ray) -> Vec<Pass> {
    let Some(line) = surface.line(ray) else {
        return vec![];
    };
    let mut visitor = All {
        surface,
        line,
        passes: vec![],
    };
    surface.tree().walk(ray, Interval::LINE, &mut visitor);
    visitor.passes
}

struct Nearest<'a, S: Elements> {
    surface: &'a S,
    line: S::Line<'a>,
    range: Interval,
    from: Option<SurfaceId>,
    best: Option<PrimHit>,
}

impl<S: Elements> Visitor for Nearest<'_, S> {
    fn visit(&mut self, id: u32, t_max: f64) -> f64 {
        let range = match self.best {
            Some(best) => self.range.with_max(best.t),
            None => self.range,
        };
        let Some(found) = self.surface.nearest(id, &self.line, range, self.from) else {
            return t_max;
        };
        let key = |hit: &PrimHit| (hit.t, hit.surface.element);
        if self.best.is_none_or(|best| key(&found) < key(&best)) {
            self.best = Some(found);
            return found.t;
        }
        t_max
    }
}

struct Any<'a, S: Elements> {
    surface: &'a S,
    line: S::Line<'a>,
    range: Interval,
    from: Option<SurfaceId>,
    found: bool,
}

impl<S: Elements> Visitor for Any<'_, S> {
    const ANY: bool = true;

    fn visit(&mut self, id: u32, t_max: f64) -> f64 {
        if self.surface.any(id, &self.line, self.range, self.from) {
            self.found = true;
            return f64::NEG_INFINITY;
        }
        t_max
    }
}

struct All<'a, S: Elements> {
    surface: &'a S,
    line: S::Line<'a>,
    passes: Vec<Pass>,
}

impl<S: Elements> Visitor for All<'_, S> {
    fn visit(&mut self, id: u32, t_max: f64) -> f64 {
        self.surface.all(id, &self.line, &mut self.passes);
        t_max
    }
}

/// Which side of `dS/du x dS/dv` is the front.
#[derive(Clone, Copy, Debug)]
pub(super) struct Front {
    /// Whether it is the other side, after a mirroring transform.
    pub(super) is_flipped: bool,
    pub(super) is_closed: bool,
    /// Whether the normals of a closed surface have to be turned outwards.
    pub(super) is_inside_out: bool,
}

impl Front {
    /// The normal from `dS/du x dS/dv` or its direction; where there is none, against the ray.
    pub(super) fn normal(&self, across: Option<DVec3>, ray: &Ray) -> DVec3 {
        let is_turned = if self.is_closed {
            self.is_inside_out
        } else {
            self.is_flipped
        };
        match across {
            Some(across) if is_turned => -across,
            Some(across) => across,
            None => against(ray),
        }
    }
}

/// The direction against a ray: the normal of what has none.
pub(super) fn against(ray: &Ray) -> DVec3 {
    (-ray.direction).try_normalize().unwrap_or(DVec3::Y)
}

/// A point with texture coordinates and the derivatives by them, which are nothing where they have no bound.
pub(super) fn textured(bare: SurfacePoint, uv: DVec2, [dpdu, dpdv]: [DVec3; 2]) -> SurfacePoint {
    let is_usable = dpdu.is_finite() && dpdv.is_finite();
    SurfacePoint {
        uv,
        dpdu: if is_usable { dpdu } else { DVec3::ZERO },
        dpdv: if is_usable { dpdv } else { DVec3::ZERO },
        ..bare
    }
}

/// Texture coordinates that are linear along both parameters between those of the four corners of a square, with the derivatives
/// of the point by them.
pub(super) fn bilinear(
    [a, b, c, d]: [DVec2; 4],
    [u, v]: [f64; 2],
    by: [DVec3; 2],
) -> (DVec2, [DVec3; 2]) {
    let (lower, upper) = (a + (b - a) * u, d + (c - d) * u);
    let along_u = (b - a) * (1.0 - v) + (c - d) * v;
    (
        lower + (upper - lower) * v,
        derivatives([along_u, upper - lower], by),
    )
}

/// The derivatives of a point by texture coordinates, from those of both by the parameters; nothing where they have no bound.
pub(super) fn derivatives([along_u, along_v]: [DVec2; 2], [by_u, by_v]: [DVec3; 2]) -> [DVec3; 2] {
    let determinant = along_u.x * along_v.y - along_u.y * along_v.x;
    let by_x = (by_u * along_v.y - by_v * along_u.y) / determinant;
    let by_y = (by_v * along_u.x - by_u * along_v.x) / determinant;
    if by_x.is_finite() && by_y.is_finite() {
        [by_x, by_y]
    } else {
        [DVec3::ZERO; 2]
    }
}

/// Whether the coordinates in a box are fine enough for what is in it: far away from the origin they would lose its shape.
pub(super) fn keeps_its_shape(bounds: &Aabb) -> bool {
    bounds.size().max_element() >= bounds.max_abs() * f64::from(f32::EPSILON)
}
