use super::random::numbers;
use strahl_math::noise::{Turbulence, lattice_hash};
use strahl_math::{DVec3, Transform, det};

/// A step that moves the point before a pattern is evaluated.
#[derive(Clone, Debug, PartialEq)]
pub enum Warp {
    /// A transformation of the pattern: its inverse is applied to the point.
    Transform(Transform),
    /// A slice of the pattern, repeated along one axis.
    Repeat {
        /// Axis of the repetition, 0 to 2.
        axis: usize,
        /// Width of the slice, not zero.
        width: f64,
        /// What the pattern is shifted by from each copy to the next.
        offset: DVec3,
        /// Along which axes every second copy is mirrored.
        flip: [bool; 3],
    },
    /// A place that draws the pattern in or pushes it away.
    BlackHole(BlackHole),
    /// Turbulence in the order of the warps.
    Turbulence {
        /// How far along each axis.
        amount: DVec3,
        /// The octaves.
        octaves: Turbulence,
    },
    /// The x-y plane wrapped around a cylinder, sphere or torus.
    Mapping {
        /// Around what.
        mapping: Mapping,
        /// Unit vector along which the pattern looks outwards, z by default.
        orientation: DVec3,
        /// The pattern is stretched by the distance to this power.
        distance_exponent: f64,
    },
    /// The square from 0 to 1 of the x-y plane folded to a cube around the origin: four columns of `u` by three rows of `v`, as the texture
    /// coordinates of a box are unfolded. z is the distance, the largest coordinate.
    Cubic,
    /// The pattern of one plane, continued along its normal.
    Planar {
        /// Unit normal of the plane, z by default.
        orientation: DVec3,
        /// Distance of the plane from the origin.
        distance: f64,
    },
}

/// What the x-y plane is wrapped around by [`Warp::Mapping`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mapping {
    /// The y axis.
    Cylindrical,
    /// The origin.
    Spherical,
    /// The circle of this radius around the y axis.
    Toroidal(f64),
}

/// A sphere in which a pattern is drawn towards the centre, or pushed away from it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BlackHole {
    /// The centre.
    pub center: DVec3,
    /// Radius beyond which nothing happens.
    pub radius: f64,
    /// Factor of the force.
    pub strength: f64,
    /// Power of the closeness (1 at the centre, 0 at the radius) that is the force.
    pub falloff: f64,
    /// Whether the pattern is pushed away.
    pub inverse: bool,
    /// Edge lengths of the blocks in which the hole is repeated; 0 or less is no repetition along that axis. A hole that isn't wholly in its
    /// block is moved up and the block made longer, until it is (measured).
    pub repeat: DVec3,
    /// How far the holes are moved along each axis, times random numbers of their blocks. Blocks are longer by as much.
    pub turbulence: DVec3,
}

impl BlackHole {
    /// One hole of strength 1 and falloff 2.
    pub fn new(center: DVec3, radius: f64) -> Self {
        Self {
            center,
            radius,
            strength: 1.0,
            falloff: 2.0,
            inverse: false,
            repeat: DVec3::ZERO,
            turbulence: DVec3::ZERO,
        }
    }

    /// Whether the point is so far outside that it certainly stays where it is. Scenes have hundreds of holes, and most points are outside of
    /// nearly all of them: so they need no root. The next number above a rounded square is above the square, so the root of what is greater
    /// is not below the radius.
    #[inline]
    fn leaves(&self, p: DVec3) -> bool {
        let is_repeated = self.repeat.cmpgt(DVec3::ZERO).any() || self.turbulence != DVec3::ZERO;
        !is_repeated && (p - self.center).length_squared() > self.radius * self.radius
    }

    fn apply(&self, p: DVec3) -> DVec3 {
        let mut from_center = p - self.center;
        let mut block = [0; 3];
        for axis in (0..3).filter(|axis| self.repeat[*axis] > 0.0) {
            let center = self.center[axis].max(self.radius);
            let length = self.repeat[axis].max(center + self.radius + self.turbulence[axis]);
            let number = (p[axis] / length).floor();
            from_center[axis] = p[axis] - number * length - center;
            block[axis] = number as i64;
        }
        if self.turbulence != DVec3::ZERO {
            let by_chance = numbers()[lattice_hash(block)..].first_chunk();
            from_center -=
                self.turbulence * by_chance.map_or(DVec3::ZERO, |u| DVec3::from_array(*u));
        }
        let distance = from_center.length();
        if !(distance < self.radius) {
            return p;
        }
        let closeness = (self.radius - distance) / self.radius;
        let force = det::pow(closeness, self.falloff) * self.strength;
        let force = if force > 1.0 { 1.0 } else { force };
        if self.inverse {
            p - from_center * force
        } else {
            p + from_center * force
        }
    }
}

impl Warp {
    /// Where the pattern has to be evaluated for the point `p`.
    #[inline]
    pub fn apply(&self, p: DVec3) -> DVec3 {
        match self {
            Self::BlackHole(hole) if hole.leaves(p) => p,
            _ => self.moved(p),
        }
    }

    fn moved(&self, p: DVec3) -> DVec3 {
        match self {
            Self::Transform(transform) => transform.point_to_object(p),
            Self::Repeat {
                axis,
                width,
                offset,
                flip,
            } => repeat(p, *axis, *width, *offset, *flip),
            Self::BlackHole(hole) => hole.apply(p),
            Self::Turbulence { amount, octaves } => p + *amount * octaves.vector(p),
            Self::Mapping {
                mapping,
                orientation,
                distance_exponent,
            } => orient(mapping.unwrap(p, *distance_exponent), *orientation),
            Self::Cubic => folded(p),
            Self::Planar {
                orientation,
                distance,
            } => orient(DVec3::new(p.x, p.y, *distance), *orientation),
        }
    }
}

fn repeat(p: DVec3, axis: usize, width: f64, offset: DVec3, flip: [bool; 3]) -> DVec3 {
    let axis = axis.min(2);
    if width == 0.0 {
        return p;
    }
    let copy = (p[axis] / width).floor();
    let mut q = p;
    q[axis] -= copy * width;
    let is_odd = copy - 2.0 * (0.5 * copy).floor() == 1.0;
    if is_odd {
        for (a, _) in flip.iter().enumerate().filter(|(_, flip)| **flip) {
            q[a] = if a == axis { width - q[a] } else { -q[a] };
        }
    }
    q + offset * copy
}

/// The place on the unfolded faces of a cube, as POV-Ray folds it (measured). The first of +x, +y, -x, -y and z that is farthest is the face.
fn folded(p: DVec3) -> DVec3 {
    let far = p.abs().max_element();
    let part = if far > 0.0 { p / far } else { DVec3::ZERO };
    let (x, y, z) = (part.x / 8.0, part.y / 6.0, part.z / 8.0);
    let deep = part.z / 6.0;
    let (u, v) = if p.x == far {
        (5.0 / 8.0 - z, 0.5 + y)
    } else if p.y == far {
        (3.0 / 8.0 + x, 5.0 / 6.0 - deep)
    } else if -p.x == far {
        (1.0 / 8.0 + z, 0.5 + y)
    } else if -p.y == far {
        (3.0 / 8.0 + x, 1.0 / 6.0 + deep)
    } else if p.z == far {
        (3.0 / 8.0 + x, 0.5 + y)
    } else {
        (7.0 / 8.0 - x, 0.5 + y)
    };
    DVec3::new(u, v, far)
}

impl Mapping {
    /// Longitude and latitude (or height) and the distance.
    fn unwrap(self, p: DVec3, distance_exponent: f64) -> DVec3 {
        use std::f64::consts::{PI, TAU};
        let turn = det::atan2(p.z, p.x) / TAU;
        let u = if turn < 0.0 { turn + 1.0 } else { turn };
        let around = (p.x * p.x + p.z * p.z).sqrt();
        let (v, distance, scales_v) = match self {
            Self::Cylindrical => (p.y, around, false),
            // The angle as atan2 is accurate at the poles too, unlike an arc sine.
            Self::Spherical => (0.5 + det::atan2(p.y, around) / PI, p.length(), true),
            Self::Toroidal(major) => {
                let h = around - major;
                let v = 0.5 + det::atan2(p.y, h) / TAU;
                (v, (h * h + p.y * p.y).sqrt(), true)
            }
        };
        let stretch = if distance_exponent == 0.0 {
            1.0
        } else {
            det::pow(distance, distance_exponent)
        };
        let v = if scales_v { v * stretch } else { v };
        DVec3::new(u * stretch, v, distance)
    }
}

/// Turns z into `n`, as POV-Ray does: right for the axes, a skewed map for other directions (measured).
fn orient(q: DVec3, n: DVec3) -> DVec3 {
    DVec3::new(
        (n.y + n.z) * q.x + n.x * q.z,
        (n.x + n.z) * q.y - n.y * q.z,
        -n.x * q.x + n.y * q.y + n.z * q.z,
    )
}
