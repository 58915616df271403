//! From a hit to its surface, and to the place where the texture of the surface is evaluated.

use crate::appearance::{Appearance, UvMapping};
use crate::hit::Hit;
use crate::prim::PrimKind;
use crate::scene::{RenderGroup, RenderScene};
use strahl_geometry::{PrimHit, Primitive, Shape, SurfaceId, SurfacePoint};
use strahl_math::{DVec2, DVec3, Ray, Transform};
use strahl_shade::patterns::TexturePoint;
use strahl_shade::texture::Texture;
use strahl_shade::{Color, MaterialId};

/// Everything about a hit, in world space.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Resolved {
    pub(crate) point: SurfacePoint,
    /// The same point in the innermost space, if that is not the world's.
    pub(crate) local: Option<LocalPoint>,
    pub(crate) appearance: Appearance,
    /// Where the elements of the innermost instance begin; 0 in the world.
    pub(crate) space: u64,
    /// The element of the world, unless it belongs to an instance.
    element: Option<WorldElement>,
    /// Whether the hit before was on the same element of the world, so that nothing differs but the point.
    pub(crate) is_same_element: bool,
}

/// An element of the world, as [`RenderScene::resolve`] has looked it up: the next hit is mostly on the same one.
#[derive(Clone, Copy, Debug)]
struct WorldElement {
    id: u64,
    kind: PrimKind,
    /// Its number within the primitive.
    number: u32,
    /// Whether texture coordinates are wanted.
    uv: bool,
}

impl Resolved {
    /// Nothing yet.
    pub(crate) const UNKNOWN: Self = Self {
        point: SurfacePoint::UNKNOWN,
        local: None,
        appearance: Appearance {
            object: 0,
            material: MaterialId(0),
            texture_space: Appearance::NO_SPACE,
            body: 0,
            hollow: false,
            uv: UvMapping::Off,
        },
        space: 0,
        element: None,
        is_same_element: false,
    };

    /// Whether the element belongs to no instance.
    #[inline]
    fn is_in_world(&self) -> bool {
        self.element.is_some()
    }
}

/// The properties of a surface point that determine the start of a ray.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LocalPoint {
    pub(crate) position: DVec3,
    pub(crate) error: DVec3,
    /// Unit normal of the geometry.
    pub(crate) normal: DVec3,
}

/// Whether texture coordinates are wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Uv {
    /// Where the material has textures.
    IfTextured,
    /// Everywhere.
    Always,
}

impl RenderScene {
    /// The surface at a hit, in world space: `ray` is the ray that found it, whose origin does not lie on a surface (no
    /// [`crate::Origin`]).
    pub fn surface_at(&self, ray: &Ray, hit: &Hit) -> SurfacePoint {
        let mut resolved = Resolved::UNKNOWN;
        self.resolve(ray, None, hit, Uv::Always, &mut resolved);
        resolved.point
    }

    /// The surface at a hit: `ray` is the world ray that found it, `origin` where it started. `out` is unknown, or has the surface of
    /// another hit in this scene for which the same texture coordinates were wanted.
    // In place: values of this size are copied by calls of memcpy.
    #[inline]
    pub(crate) fn resolve(
        &self,
        ray: &Ray,
        origin: Option<&crate::Origin>,
        hit: &Hit,
        uv: Uv,
        out: &mut Resolved,
    ) {
        out.is_same_element = out.element.is_some_and(|element| element.id == hit.id);
        if !out.is_same_element {
            self.look_up(hit, uv, out);
        }
        match &out.element {
            Some(element) => {
                let world = &self.groups[0];
                let WorldElement {
                    kind, number, uv, ..
                } = *element;
                world.store_surface(kind, ray, hit, number, uv, &mut out.point);
                if uv {
                    out.point.uv = world.texture_uv(kind, hit, number, &out.point);
                }
            }
            None => self.resolve_within(ray, origin, hit, uv, out),
        }
    }

    /// Looks up the element of a hit, and how it is seen; no element if it belongs to an instance.
    #[inline(never)]
    fn look_up(&self, hit: &Hit, uv: Uv, out: &mut Resolved) {
        let world = &self.groups[0];
        let prim = world.prim_of(hit.id);
        let kind = world.prims.at(prim).kind();
        if matches!(kind, PrimKind::Instance(_)) {
            out.element = None;
            return;
        }
        let number = (hit.id - world.first_id(prim)) as u32;
        out.appearance = world.appearance_of(kind, number);
        (out.local, out.space) = (None, 0);
        out.element = Some(WorldElement {
            id: hit.id,
            kind,
            number,
            uv: self.wants_uv(&out.appearance, uv),
        });
    }

    /// Whether texture coordinates are wanted for a material.
    #[inline]
    fn wants_uv(&self, appearance: &Appearance, uv: Uv) -> bool {
        uv == Uv::Always
            || appearance.uv != UvMapping::Off
            || self.uses_uv[appearance.material.0 as usize]
    }

    /// [`RenderScene::resolve`] for a hit within an instance.
    fn resolve_within(
        &self,
        ray: &Ray,
        origin: Option<&crate::Origin>,
        hit: &Hit,
        uv: Uv,
        out: &mut Resolved,
    ) {
        let mut made = None;
        let (at, to_world) = self.locate_with_map(hit.id, &mut made);
        let kind = at.group.prims.at(at.prim).kind();
        out.appearance = at.group.appearance_of(kind, at.element);
        let uv = self.wants_uv(&out.appearance, uv);
        let local_ray = match to_world {
            None => *ray,
            Some(m) => {
                let entered = m.ray_to_object(ray);
                // If the ray starts in this space, it keeps the exact origin.
                match origin {
                    Some(o) if self.same_space(o.id, hit.id) => {
                        Ray::new(o.local, entered.direction)
                    }
                    _ => entered,
                }
            }
        };
        let point = &mut out.point;
        at.group
            .store_surface(kind, &local_ray, hit, at.element, uv, point);
        out.local = to_world.map(|m| {
            let local = LocalPoint {
                position: point.position,
                error: point.position_error,
                normal: point.n_geom,
            };
            surface_to_world(m, point);
            local
        });
        if uv {
            point.uv = at.group.texture_uv(kind, hit, at.element, point);
        }
        out.space = at.space;
    }

    /// Moves a point to where the texture at a hit is evaluated. Returns the map from the space of the texture to the world; `None` if
    /// they are the same. A map that no list has is stored in `made`.
    // References rather than values: points and maps take 200 bytes, and copies of them took 2 % of the time.
    #[inline]
    pub(crate) fn texture_place<'m>(
        &'m self,
        place: &mut TexturePoint,
        hit: &Hit,
        resolved: &Resolved,
        made: &'m mut Option<Transform>,
    ) -> Option<&'m Transform> {
        let space = self.texture_space(hit, resolved, made);
        let appearance = &resolved.appearance;
        if appearance.uv == UvMapping::Off {
            return space;
        }
        let in_object = match space {
            None => place.position,
            Some(space) => space.point_to_object(place.position),
        };
        *place = place.on_surface(in_object);
        space.filter(|_| appearance.uv == UvMapping::Moved)
    }

    #[inline]
    fn texture_space<'m>(
        &'m self,
        hit: &Hit,
        resolved: &Resolved,
        made: &'m mut Option<Transform>,
    ) -> Option<&'m Transform> {
        let number = resolved.appearance.texture_space as usize;
        let to_group = self.texture_spaces.get(number);
        if resolved.is_in_world() {
            return to_group;
        }
        let Some(inner) = to_group else {
            return self.locate_with_map(hit.id, made).1;
        };
        let mut nested = None;
        let outer = self.locate_with_map(hit.id, &mut nested).1?;
        Some(made.insert(inner.then(outer)))
    }

    /// The attenuation of light along a direction by the texture at a hit; `caustics` is that of the interior.
    pub(crate) fn attenuated(
        &self,
        texture: &Texture,
        resolved: &Resolved,
        direction: DVec3,
        hit: &Hit,
        caustics: f64,
    ) -> Color {
        if !(caustics > 0.0)
            && let Some(same) = texture.same_shadow_attenuation()
        {
            return same;
        }
        let point = &resolved.point;
        let direction = direction.normalize();
        let facing = if point.n_geom.dot(direction) <= 0.0 {
            1.0
        } else {
            -1.0
        };
        let mut place = TexturePoint {
            position: point.position,
            is_member: false,
            in_object: None,
            surface: point.position,
            n_geom: point.n_geom * facing,
            n_shade: point.n_shade * facing,
            uv: point.uv,
            direction,
        };
        let mut made = None;
        let space = self.texture_place(&mut place, hit, resolved, &mut made);
        if caustics > 0.0 {
            return texture.gathered_attenuation(space, &place, caustics);
        }
        match space {
            None => texture.shadow_attenuation(&place),
            Some(space) => {
                texture.shadow_attenuation(&place.at(space.point_to_object(place.position)))
            }
        }
    }

    /// Whether two elements lie in the same innermost space (the same chain of instances).
    fn same_space(&self, a: u64, b: u64) -> bool {
        let (mut group, mut a, mut b) = (&self.groups[0], a, b);
        loop {
            let (prim_a, prim_b) = (group.prim_of(a), group.prim_of(b));
            let kinds = (group.prims.at(prim_a).kind(), group.prims.at(prim_b).kind());
            match kinds {
                (PrimKind::Instance(index), PrimKind::Instance(_)) if prim_a == prim_b => {
                    a -= group.first_id(prim_a);
                    b -= group.first_id(prim_b);
                    group = &self.groups[group.instances[index as usize].group as usize];
                }
                (PrimKind::Instance(_), _) | (_, PrimKind::Instance(_)) => return false,
                _ => return true,
            }
        }
    }
}

impl RenderGroup {
    /// Stores the surface at a hit on an element of a primitive of this kind, in this group's space, with texture coordinates if `uv`.
    #[inline]
    pub(crate) fn store_surface(
        &self,
        kind: PrimKind,
        ray: &Ray,
        hit: &Hit,
        element: u32,
        uv: bool,
        out: &mut SurfacePoint,
    ) {
        let hit = prim_hit(hit, element);
        let store = |shape: &Shape, ray: &Ray, out: &mut SurfacePoint| {
            if uv {
                *out = shape.surface_at(ray, &hit);
            } else {
                shape.store_bare_surface(ray, &hit, out);
            }
        };
        match kind {
            PrimKind::Triangle(mesh, triangle) => {
                let mesh = &self.meshes[mesh as usize].mesh;
                *out = mesh.surface_at_element(triangle, hit.uv);
            }
            PrimKind::Sphere(number) => {
                let sphere = self.spheres.get(number, self.blocks.spheres());
                if uv {
                    *out = sphere.surface_at(ray, &hit);
                } else {
                    sphere.store_bare_surface(ray, &hit, out);
                }
            }
            PrimKind::Shape(index) => store(&self.shapes[index as usize].shape, ray, out),
            PrimKind::Placed(index) => {
                let used = &self.shapes[index as usize];
                match &used.transform {
                    None => store(&used.shape, ray, out),
                    Some(m) => {
                        store(&used.shape, &m.ray_to_object(ray), out);
                        surface_to_world(m, out);
                    }
                }
            }
            PrimKind::Instance(_) => unreachable!("locate ends at a primitive that is no instance"),
        }
    }

    /// The texture coordinates at a hit: the surface's own, or x and y of the world where it has none, as in POV-Ray.
    #[cold]
    fn texture_uv(&self, kind: PrimKind, hit: &Hit, element: u32, point: &SurfacePoint) -> DVec2 {
        let hit = prim_hit(hit, element);
        let own = match kind {
            PrimKind::Triangle(mesh, _) => {
                self.meshes[mesh as usize].mesh.texture_uv(&hit, point.uv)
            }
            PrimKind::Sphere(_) => Some(point.uv),
            PrimKind::Shape(index) | PrimKind::Placed(index) => {
                self.shapes[index as usize].shape.texture_uv(&hit, point.uv)
            }
            PrimKind::Instance(_) => unreachable!("locate ends at a primitive that is no instance"),
        };
        own.unwrap_or_else(|| point.position.truncate())
    }
}

/// A hit as the primitive reported it.
fn prim_hit(hit: &Hit, element: u32) -> PrimHit {
    PrimHit {
        t: hit.t,
        surface: SurfaceId {
            element,
            facet: hit.facet,
        },
        uv: hit.uv,
    }
}

/// Transforms a surface point from object space to the space around it.
fn surface_to_world(m: &Transform, p: &mut SurfacePoint) {
    // The transformation rounds too: three products and three sums per coordinate.
    let magnitude = m.error_to_world(p.position.abs()) + m.translation().abs();
    p.position_error =
        m.error_to_world(p.position_error) + magnitude * strahl_math::error::gamma(8);
    p.position = m.point_to_world(p.position);
    let unit = |n| m.normal_to_world(n).normalize_or(n);
    let flat = p.n_shade == p.n_geom;
    p.n_geom = unit(p.n_geom);
    p.n_shade = if flat { p.n_geom } else { unit(p.n_shade) };
    p.dpdu = m.vector_to_world(p.dpdu);
    p.dpdv = m.vector_to_world(p.dpdv);
}
