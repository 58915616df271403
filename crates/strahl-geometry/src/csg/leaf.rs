use super::fusing::Fusing;
use crate::primitives::convex::{Span, Stay};
use crate::{
    Crossing, Crossings, PrimHit, Primitive, Scratch, Shape, Side, Solid, SurfaceId, SurfacePoint,
};
use strahl_math::error::{ROUNDOFF, gamma};
use strahl_math::{Aabb, DVec2, DVec3, Interval, Ray, Transform};

/// A shape of a compiled tree, with everything that the operations above determine about it.
#[derive(Clone, Debug)]
pub(super) struct Leaf {
    pub(super) shape: Shape,
    pub(super) placement: Option<Box<Placement>>,
    pub(super) tag: u32,
    /// The first of the element numbers this leaf takes.
    pub(super) first_element: u32,
    /// Whether the tree combines the complement of the shape.
    pub(super) negative: bool,
    /// False for shapes that only clip.
    pub(super) visible: bool,
    /// The number of the bounds that rays must meet to see the leaf; `None` if all rays see it.
    pub(super) seen_through: Option<u32>,
    /// The box around the shape's inside, in the tree's space.
    pub(super) bounds: Aabb,
    /// The leaf that decides next whether a point is inside of the tree, if this one contains it ...
    pub(super) if_inside: Next,
    /// ... or if it does not.
    pub(super) if_outside: Next,
}

/// A query to a leaf.
pub(super) struct Query<'a> {
    /// In the tree's space.
    pub(super) ray: &'a Ray,
    pub(super) range: Interval,
    /// The surface the ray starts on, if it is this leaf's.
    pub(super) from: Option<SurfaceId>,
    /// Whether the ray starts on some surface of the tree.
    pub(super) leaving: bool,
    pub(super) fusing: &'a Fusing,
}

/// The next step after an answer when a point is classified: the tree's logic, compiled to jumps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Next {
    /// Ask this leaf.
    Leaf(u32),
    /// The answer for the whole tree.
    Answer(bool),
}

/// The transform of a leaf with a space of its own, both ways.
#[derive(Clone, Debug)]
pub(super) struct Placement {
    map: Transform,
    back: Transform,
}

impl Placement {
    pub(super) fn new(map: Transform) -> Self {
        Self {
            map,
            back: map.inverted(),
        }
    }

    /// The error caused by the rounding of `ray_to_object` in the parameter at which a surface with normal `n` (object space)
    /// is hit: the error of the point on the ray, across the surface, divided by the speed across the surface.
    fn t_error(&self, outer: &Ray, inner: &Ray, t: f64, n: DVec3) -> f64 {
        let reach = (outer.origin - self.map.translation()).abs() + (outer.direction * t).abs();
        // A difference, three products and two sums each for origin and direction, and the entries of the inverse.
        let point = self.back.error_to_world(reach) * gamma(10);
        n.abs().dot(point) / n.dot(inner.direction).abs()
    }
}

impl Leaf {
    pub(super) fn solid(&self) -> Option<&dyn Solid> {
        self.shape.as_solid()
    }

    /// The map from the shape's space to the tree's, if they differ.
    pub(super) fn map(&self) -> Option<&Transform> {
        self.placement.as_ref().map(|placement| &placement.map)
    }

    pub(super) fn point_to_object(&self, point: DVec3) -> DVec3 {
        self.map().map_or(point, |map| map.point_to_object(point))
    }

    /// A box around the image of a box in the shape's space.
    pub(super) fn bounds_to_object(&self, bounds: &Aabb) -> Aabb {
        let back = self.placement.as_ref().map(|placement| &placement.back);
        back.map_or(*bounds, |back| back.bounds_to_world(bounds))
    }

    pub(super) fn ray_to_object(&self, ray: &Ray) -> Ray {
        self.placement
            .as_ref()
            .map_or(*ray, |placement| placement.map.ray_to_object(ray))
    }

    /// Whether the tree's space at `point` belongs to what this leaf contributes: the shape or its complement.
    pub(super) fn contains(&self, point: DVec3) -> bool {
        let inside = || {
            let local = self.point_to_object(point);
            self.solid().is_some_and(|solid| solid.contains(local))
        };
        (self.bounds.contains(point) && inside()) != self.negative
    }

    /// Whether [`Leaf::stay`] knows the shape.
    pub(super) fn has_stays(&self) -> bool {
        self.is_convex() || matches!(self.shape, Shape::Quadric(_))
    }

    /// Whether lines may cross it more often than twice, and their crossings are listed in little time.
    pub(super) fn is_listed(&self) -> bool {
        matches!(
            self.shape,
            Shape::Torus(_)
                | Shape::Polynomial(_)
                | Shape::Superellipsoid(_)
                | Shape::Sor(_)
                | Shape::Lathe(_)
        )
    }

    /// Whether it is a convex solid that is intersected in a few operations.
    pub(super) fn is_convex(&self) -> bool {
        match &self.shape {
            Shape::Sphere(_) | Shape::Cuboid(_) | Shape::Plane(_) => true,
            // An end of a span of an open shape may be invisible.
            Shape::Cylinder(cylinder) => cylinder.is_capped(),
            Shape::Cone(cone) => cone.is_capped(),
            _ => false,
        }
    }

    /// Whether it is intersected as fast as its box.
    pub(super) fn is_quick(&self) -> bool {
        self.is_convex() && self.placement.is_none()
    }

    /// Whether the points of the shape's surface count as inside, which matters only where faces coincide.
    ///
    /// These are POV-Ray's rules where it has any (measured: the surfaces of planes, blobs, superellipsoids and isosurfaces
    /// always count, also those of open cylinders and cones, those of closed ones and of meshes never; for the others rounding decides, and this
    /// is the result for axis-aligned faces).
    fn has_its_surface(&self) -> bool {
        let shape = match &self.shape {
            Shape::Bounded(bounded) => bounded.shape(),
            shape => shape,
        };
        match shape {
            Shape::Cylinder(cylinder) => !cylinder.is_capped(),
            Shape::Cone(cone) => !cone.is_capped(),
            Shape::Prism(_) | Shape::TriangleMesh(_) | Shape::Brep(_) => false,
            _ => self.solid().is_some(),
        }
    }

    /// Where the line is inside of a convex solid or a quadric; the ends are those that [`Leaf::crossings`] lists. `None` for other
    /// shapes, and for rays along a plane.
    // Inline: the span would be copied before its stores have ended.
    #[inline(always)]
    pub(super) fn stay(&self, ray: &Ray, from: Option<SurfaceId>) -> Option<Stay> {
        let placed;
        let ray = match &self.placement {
            None => ray,
            Some(placement) => {
                placed = placement.map.ray_to_object(ray);
                &placed
            }
        };
        let span = match &self.shape {
            Shape::Sphere(sphere) => sphere.span(ray, from),
            Shape::Cuboid(cuboid) => cuboid.span(ray, from),
            Shape::Cylinder(cylinder) => cylinder.span(ray, from),
            Shape::Cone(cone) => cone.span(ray, from),
            Shape::Plane(plane) => Some(plane.span(ray, from)?),
            Shape::Quadric(quadric) => return Some(quadric.stay(ray, from)),
            _ => return None,
        };
        Some(Stay::within(span))
    }

    /// Whether a ray that starts on this surface of the leaf leaves what it contributes, and never comes back to it: as most rays from surfaces do,
    /// to lights and where they are mirrored. An intersection with the leaf is behind them then.
    #[inline(always)]
    pub(super) fn is_left_for_good(&self, stay: &Stay, surface: SurfaceId) -> bool {
        let ends = |span: Span| span.exit.t == 0.0 && span.exit.facet == surface.facet;
        self.negative == stay.outside && stay.span.is_none_or(ends)
    }

    /// Appends the crossings of a ray with this leaf's contribution, with the tree's element numbers.
    pub(super) fn crossings(&self, query: &Query<'_>, scratch: &mut Scratch, out: &mut Crossings) {
        let inner = self.ray_to_object(query.ray);
        self.shape_crossings(&inner, query.range, query.from, scratch, out);
        for crossing in &mut out.list {
            let t = crossing.hit.t;
            if let Some(placement) = &self.placement {
                let n = self.shape.bare_surface_at(&inner, &crossing.hit).n_geom;
                let error = placement.t_error(query.ray, &inner, t, n);
                // Infinite if the ray runs along the surface; crossings further apart than the margin are never fused.
                let margin = query.fusing.margin(t);
                crossing.t_error += if error < margin { error } else { margin };
            }
            if query.leaving && query.from.is_none() && t > 0.0 && t <= query.fusing.reach(crossing)
            {
                // This surface coincides with the one the ray starts on, so it has been crossed.
                crossing.hit.t = 0.0;
            }
        }
        self.contribute(out);
    }

    /// The same without the errors that the transform adds, and without those of shapes that take time for them, if the crossings
    /// are not compared with others.
    pub(super) fn bare_crossings(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        scratch: &mut Scratch,
        out: &mut Crossings,
    ) {
        // Not for shapes that are made of others, which they may compare.
        out.without_errors = self.is_listed() || matches!(self.shape, Shape::Isosurface(_));
        self.shape_crossings(&self.ray_to_object(ray), range, from, scratch, out);
        self.contribute(out);
    }

    /// The crossings of a ray in the shape's space with the shape.
    fn shape_crossings(
        &self,
        inner: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        scratch: &mut Scratch,
        out: &mut Crossings,
    ) {
        match self.solid() {
            Some(solid) => solid.crossings(inner, range, from, scratch, out),
            None => self.list_hits(inner, range, from, scratch, out),
        }
    }

    /// Turns the shape's crossings into those of the leaf: of the complement, numbered, visible or not.
    fn contribute(&self, out: &mut Crossings) {
        if self.negative {
            out.inside_at_start = !out.inside_at_start;
            if self.solid().is_some() {
                // Inner surfaces of the shape are outside of its complement.
                out.list.retain(|crossing| crossing.side != Side::Inner);
            }
        }
        let closed = self.has_its_surface() != self.negative;
        for crossing in &mut out.list {
            let element = crossing.hit.surface.element;
            crossing.hit.surface.element = self.first_element.saturating_add(element);
            crossing.visible &= self.visible;
            crossing.closed = closed;
            if self.negative {
                crossing.side = match crossing.side {
                    Side::Enter => Side::Exit,
                    Side::Exit => Side::Enter,
                    Side::Inner => Side::Inner,
                };
            }
        }
    }

    /// The hits of an open surface, as crossings that don't change the state.
    fn list_hits(
        &self,
        inner: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        scratch: &mut Scratch,
        out: &mut Crossings,
    ) {
        let mut hits = scratch.take_hits();
        self.shape.all_hits(inner, range, from, scratch, &mut hits);
        let crossings = hits.iter().map(|hit| Crossing::new(*hit, 0.0, Side::Inner));
        out.list.extend(crossings);
        scratch.give_hits(hits);
    }

    /// See [`Primitive::texture_uv`].
    pub(super) fn texture_uv(&self, hit: &PrimHit, uv: DVec2) -> Option<DVec2> {
        self.shape.texture_uv(&self.own_hit(hit), uv)
    }

    /// A hit with the number that the element has in the shape.
    fn own_hit(&self, hit: &PrimHit) -> PrimHit {
        PrimHit {
            surface: SurfaceId {
                element: hit.surface.element.saturating_sub(self.first_element),
                ..hit.surface
            },
            ..*hit
        }
    }

    /// Stores the surface at a hit, in the tree's space, with normals that point out of the tree's solid. `bare` leaves out what textures need.
    pub(super) fn store_surface(
        &self,
        ray: &Ray,
        hit: &PrimHit,
        bare: bool,
        out: &mut SurfacePoint,
    ) {
        let local = self.own_hit(hit);
        let ray = self.ray_to_object(ray);
        if bare {
            self.shape.store_bare_surface(&ray, &local, out);
        } else {
            *out = self.shape.surface_at(&ray, &local);
        }
        if let Some(placement) = &self.placement {
            let map = &placement.map;
            let position = map.point_to_world(out.position);
            out.position_error = map.error_to_world(out.position_error)
                + map.error_to_world(out.position.abs()) * gamma(4)
                + position.abs() * (2.0 * ROUNDOFF);
            out.position = position;
            let flat = out.n_shade == out.n_geom;
            out.n_geom = map.normal_to_world(out.n_geom).normalize();
            out.n_shade = if flat {
                out.n_geom
            } else {
                map.normal_to_world(out.n_shade).normalize()
            };
            if !bare {
                out.dpdu = map.vector_to_world(out.dpdu);
                out.dpdv = map.vector_to_world(out.dpdv);
            }
        }
        if self.negative {
            out.n_geom = -out.n_geom;
            out.n_shade = -out.n_shade;
        }
    }
}
