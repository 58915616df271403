//! Places on a face, known as well near each corner as near the first.

use super::SubdivisionScheme;

/// Places so near to a far side are told by their distance from it: around an irregular vertex patches are so small that numbers
/// near 1 are too coarse.
const NEAR: f64 = 1.0 / 1024.0;

/// A place on a face, by its distances from all sides, as parts of the face: `u, 1 - u, v, 1 - v` on a quadrilateral; on a
/// triangle the weights of its corners.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Spot(pub(super) [f64; 4]);

impl Spot {
    pub(super) fn on_quad([u, v]: [f64; 2]) -> Self {
        Self([u, 1.0 - u, v, 1.0 - v])
    }

    pub(super) fn on_triangle([u, v]: [f64; 2]) -> Self {
        Self([(1.0 - u) - v, u, v, 0.0])
    }

    /// The place at parameters of a face of a scheme.
    pub(super) fn at(scheme: SubdivisionScheme, uv: [f64; 2]) -> Self {
        match scheme {
            SubdivisionScheme::CatmullClark => Self::on_quad(uv),
            SubdivisionScheme::Loop => Self::on_triangle(uv),
        }
    }

    /// The parameters `u` and `v`.
    pub(super) fn uv(&self, scheme: SubdivisionScheme) -> [f64; 2] {
        let Self([a, b, c, _]) = *self;
        match scheme {
            SubdivisionScheme::CatmullClark => [a, c],
            SubdivisionScheme::Loop => [b, c],
        }
    }

    /// The sides from which it is told, and two numbers that tell it.
    pub(super) fn told(&self, scheme: SubdivisionScheme) -> (u32, [f64; 2]) {
        let Self([a, b, c, d]) = *self;
        match scheme {
            SubdivisionScheme::CatmullClark => {
                let (right, top) = (b < NEAR, d < NEAR);
                let sides = u32::from(right) | u32::from(top) << 1;
                (sides, [if right { b } else { a }, if top { d } else { c }])
            }
            SubdivisionScheme::Loop if b > 1.0 - NEAR => (1, [c, a]),
            SubdivisionScheme::Loop if c > 1.0 - NEAR => (2, [a, b]),
            SubdivisionScheme::Loop => (0, [b, c]),
        }
    }

    /// The place of which [`Self::told`] gives these numbers.
    pub(super) fn of(scheme: SubdivisionScheme, sides: u32, [x, y]: [f64; 2]) -> Self {
        match scheme {
            SubdivisionScheme::CatmullClark => {
                let pair = |x: f64, is_far: bool| {
                    if is_far { [1.0 - x, x] } else { [x, 1.0 - x] }
                };
                let ([a, b], [c, d]) = (pair(x, sides & 1 != 0), pair(y, sides & 2 != 0));
                Self([a, b, c, d])
            }
            SubdivisionScheme::Loop => {
                let rest = (1.0 - x) - y;
                Self(match sides {
                    1 => [y, rest, x, 0.0],
                    2 => [x, y, rest, 0.0],
                    _ => [rest, x, y, 0.0],
                })
            }
        }
    }
}

/// Where a part is in the whole face: a distance of the part is `from + size * distance` in the face.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    from: [f64; 4],
    size: f64,
}

impl Place {
    pub(super) const WHOLE: Self = Self {
        from: [0.0; 4],
        size: 1.0,
    };

    /// The place of child `i` of a face. The middle one of a triangle is turned.
    pub(super) fn of_child(scheme: SubdivisionScheme, i: usize) -> Self {
        match (scheme, i) {
            (SubdivisionScheme::CatmullClark, _) => QUARTERS[i % 4],
            (SubdivisionScheme::Loop, 3) => Self {
                from: [0.5; 4],
                size: -0.5,
            },
            (SubdivisionScheme::Loop, _) => Self {
                from: std::array::from_fn(|k| if k == i { 0.5 } else { 0.0 }),
                size: 0.5,
            },
        }
    }

    /// How long the part is; negative if it is turned.
    pub(super) fn size(&self) -> f64 {
        self.size
    }

    /// A place of the part as one of the whole face.
    pub(super) fn outer(&self, spot: Spot) -> Spot {
        Spot(std::array::from_fn(|k| {
            self.from[k] + self.size * spot.0[k]
        }))
    }

    /// A place of the whole face as one of the part.
    ///
    /// The distances that are short in the face are known best; what they leave is the longest one.
    pub(super) fn inner(&self, scheme: SubdivisionScheme, spot: Spot) -> Spot {
        let part: [f64; 4] = std::array::from_fn(|k| (spot.0[k] - self.from[k]) / self.size);
        let [a, b, c, d] = part;
        let rest = |k: usize, others: f64| {
            if self.is_far(scheme, k) {
                others
            } else {
                part[k]
            }
        };
        Spot(match scheme {
            SubdivisionScheme::CatmullClark => [
                rest(0, 1.0 - b),
                rest(1, 1.0 - a),
                rest(2, 1.0 - d),
                rest(3, 1.0 - c),
            ],
            SubdivisionScheme::Loop => [
                rest(0, (1.0 - b) - c),
                rest(1, (1.0 - c) - a),
                rest(2, (1.0 - a) - b),
                0.0,
            ],
        })
    }

    /// Whether the part is further from side `k` than from the others that distance `k` depends on.
    fn is_far(&self, scheme: SubdivisionScheme, k: usize) -> bool {
        match scheme {
            SubdivisionScheme::CatmullClark => self.from[k] > self.from[k ^ 1],
            SubdivisionScheme::Loop => (0..3).all(|j| j == k || self.from[k] > self.from[j]),
        }
    }

    /// Where a part of this part is.
    pub(super) fn part(&self, part: Self) -> Self {
        Self {
            from: self.outer(Spot(part.from)).0,
            size: self.size * part.size,
        }
    }
}

const QUARTERS: [Place; 4] = [
    half([0.0, 0.5, 0.0, 0.5]),
    half([0.5, 0.0, 0.0, 0.5]),
    half([0.5, 0.0, 0.5, 0.0]),
    half([0.0, 0.5, 0.5, 0.0]),
];

const fn half(from: [f64; 4]) -> Place {
    Place { from, size: 0.5 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conformance::Random;
    use SubdivisionScheme::{CatmullClark, Loop};

    /// 40 levels down at any corner, the two numbers of a place tell it within `2^-50` of the part.
    #[test]
    fn places_near_all_corners_are_told_exactly() {
        let mut random = Random::new(3);
        for scheme in [CatmullClark, Loop] {
            for corner in 0..if scheme == Loop { 3 } else { 4 } {
                let child = Place::of_child(scheme, corner);
                let place = (0..40).fold(Place::WHOLE, |place, _| place.part(child));
                for _ in 0..100 {
                    let u = random.unit();
                    let spot = Spot::at(scheme, [u, random.unit() * (1.0 - u)]);
                    let (sides, told) = place.outer(spot).told(scheme);
                    let again = place.inner(scheme, Spot::of(scheme, sides, told));
                    for k in 0..4 {
                        assert!(
                            (again.0[k] - spot.0[k]).abs() < 2.0_f64.powi(-50),
                            "{spot:?} {again:?}"
                        );
                    }
                }
            }
        }
    }
}
