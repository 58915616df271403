use strahl_math::DVec3;

/// The kind of a ray, for the visibility of objects.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RayClass {
    /// Camera rays, also behind transparent objects.
    Camera,
    /// Reflection rays, also behind transparent objects.
    Secondary,
    /// Shadow rays, towards a light.
    Shadow,
}

impl RayClass {
    /// The bit of this class in a visibility mask.
    pub(crate) const fn bit(self) -> u8 {
        match self {
            Self::Camera => 1,
            Self::Secondary => 2,
            Self::Shadow => 4,
        }
    }
}

/// A hit during traversal: small, `Copy`, ids only.
///
/// `id` numbers every element of the scene with instances expanded: the world's primitives in the order of the scene, each
/// taking as many numbers as it has elements, an instance as many as its group. Of two hits at equal `t` the smaller id wins,
/// so the order of traversal does not matter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Ray parameter.
    pub t: f64,
    /// Number of the element hit.
    pub id: u64,
    /// The smooth piece of that element.
    pub facet: u32,
    /// The primitive's own two numbers (barycentric coordinates on triangles).
    pub uv: [f64; 2],
}

impl Hit {
    /// A place for a hit.
    pub(crate) const NONE: Self = Self {
        t: f64::INFINITY,
        id: 0,
        facet: 0,
        uv: [0.0; 2],
    };

    /// The acceptance rule: smaller `t` wins, ties go to the smaller id.
    #[inline]
    pub(crate) fn beats(&self, other: &Self) -> bool {
        self.t < other.t || (self.t == other.t && self.id < other.id)
    }
}

/// The piece of surface a ray starts from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Origin {
    /// Number of the element.
    pub id: u64,
    /// The smooth piece of that element.
    pub facet: u32,
    /// The ray's origin in the innermost space the element lies in: for tiny objects far from the origin it has digits that
    /// world coordinates can't hold.
    pub local: DVec3,
}

impl Origin {
    /// A place to store an origin.
    pub(crate) const NOWHERE: Self = Self {
        id: 0,
        facet: 0,
        local: DVec3::ZERO,
    };
}
