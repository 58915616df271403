use crate::primitives::convex::{End, Span, start_of};
use crate::{
    Crossing, Cuboid, GeometryError, PrimHit, Side, Solid, Sphere, SurfaceId, SurfacePoint,
};
use strahl_math::{Aabb, DVec3, Interval, Ray};

/// The volume within which a function is rendered: POV-Ray's `contained_by`.
#[derive(Clone, Debug, PartialEq)]
pub enum Container {
    /// A sphere.
    Sphere(Sphere),
    /// A box.
    Box(Cuboid),
}

/// The part of a ray within a container.
pub(crate) struct Passage {
    /// The entry; `None` if the ray starts on the container and goes inwards.
    pub(crate) enter: Option<Crossing>,
    /// The exit.
    pub(crate) exit: Crossing,
}

impl Passage {
    /// The parameter at which it begins.
    pub(crate) fn start(&self) -> f64 {
        self.enter.map_or(0.0, |enter| enter.hit.t)
    }
}

impl Default for Container {
    /// The box from -1 to 1 along every axis.
    fn default() -> Self {
        Self::Box(Cuboid::new(DVec3::NEG_ONE, DVec3::ONE))
    }
}

impl Container {
    fn solid(&self) -> &dyn Solid {
        match self {
            Self::Sphere(sphere) => sphere,
            Self::Box(cuboid) => cuboid,
        }
    }

    /// Checks the parameters.
    ///
    /// # Errors
    /// Those of the sphere or the box.
    pub fn validate(&self) -> Result<(), GeometryError> {
        self.solid().validate()?;
        if !self.bounds().is_bounded() {
            return Err(GeometryError::NotFinite { what: "container" });
        }
        Ok(())
    }

    /// A box around it.
    pub fn bounds(&self) -> Aabb {
        self.solid().bounds()
    }

    /// Whether a point is inside or on it.
    pub fn contains(&self, point: DVec3) -> bool {
        self.solid().contains(point)
    }

    /// Whether a box lies completely outside.
    pub(crate) fn excludes(&self, cell: &Aabb) -> bool {
        match self {
            Self::Sphere(sphere) => {
                let nearest = sphere.center().clamp(cell.min, cell.max);
                (nearest - sphere.center()).length() > sphere.radius()
            }
            Self::Box(_) => false,
        }
    }

    /// The part of a ray inside; `from` names the facet of the container on which the ray starts.
    pub(crate) fn passage(&self, ray: &Ray, from: Option<u32>) -> Option<Passage> {
        let from = from.map(|facet| SurfaceId { element: 0, facet });
        let Span { enter, exit } = match self {
            Self::Sphere(sphere) => sphere.span(ray, from),
            Self::Box(cuboid) => cuboid.span(ray, from),
        }?;
        let crossing = |end: End, side| {
            let error = match self {
                Self::Sphere(sphere) => sphere.t_error(ray, end.t),
                Self::Box(cuboid) => cuboid.t_error(ray, end),
            };
            Crossing::new(PrimHit::simple(end.t, end.facet), error, side)
        };
        // As `Solid::crossings` lists them.
        let start = start_of(Interval::LINE, from);
        let starts_inside = enter.t <= start && start < exit.t;
        if !(exit.t > start && exit.t.is_finite()) || !(starts_inside || enter.t.is_finite()) {
            return None;
        }
        Some(Passage {
            enter: (!starts_inside).then(|| crossing(enter, Side::Enter)),
            exit: crossing(exit, Side::Exit),
        })
    }

    /// The surface at a hit on the container.
    pub(crate) fn surface_at(&self, ray: &Ray, hit: &PrimHit) -> SurfacePoint {
        self.solid().surface_at(ray, hit)
    }
}
