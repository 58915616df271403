use crate::{PrimHit, SurfaceId};

/// The kind of a crossing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The ray gets inside.
    Enter,
    /// The ray gets outside.
    Exit,
    /// The ray passes an inner surface, which a CSG union keeps within the solid.
    Inner,
}

/// One crossing of a ray with the surface of a solid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// The hit: parameter and piece of surface.
    pub hit: PrimHit,
    /// Bound on the absolute error of `hit.t`: crossings of different surfaces closer than the sum of their errors are
    /// one and the same (coincident faces).
    pub t_error: f64,
    /// What changes there.
    pub side: Side,
    /// Whether the surface is visible. Clipping changes the inside without adding a surface.
    pub visible: bool,
    /// Whether the points of the surface count as inside of the solid, which decides between faces that coincide.
    pub closed: bool,
}

impl Crossing {
    /// A visible crossing of a closed set.
    pub const fn new(hit: PrimHit, t_error: f64, side: Side) -> Self {
        Self {
            hit,
            t_error,
            side,
            visible: true,
            closed: true,
        }
    }

    /// The piece of surface crossed.
    pub const fn surface(&self) -> SurfaceId {
        self.hit.surface
    }
}

/// The crossings of one ray with one solid, ascending in `t`: the spans of Roth's CSG, kept as their ends.
///
/// S. D. Roth, "Ray casting for modeling solids", Computer Graphics and Image Processing 18 (1982).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Crossings {
    /// Whether the ray is inside just behind the start of the range.
    pub inside_at_start: bool,
    /// The crossings, ascending in `t`.
    pub list: Vec<Crossing>,
    /// Whether the crossings are not compared with others, so that shapes may leave out the errors.
    pub(crate) without_errors: bool,
}

impl Crossings {
    /// Empties the list (outside, nothing crossed, errors wanted), keeping its memory.
    pub fn clear(&mut self) {
        self.without_errors = false;
        self.inside_at_start = false;
        self.list.clear();
    }

    /// Whether the ray is inside just behind parameter `t` (crossings at `t` itself count as passed).
    pub fn inside_after(&self, t: f64) -> bool {
        let passed = self.list.iter().take_while(|c| c.hit.t <= t);
        let mut inside = self.inside_at_start;
        for crossing in passed {
            match crossing.side {
                Side::Enter => inside = true,
                Side::Exit => inside = false,
                Side::Inner => {}
            }
        }
        inside
    }
}
