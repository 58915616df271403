use std::ops::{BitOrAssign, Sub};

/// Quadrants of a pixel: top left, top right, bottom left, bottom right. Each lies towards three neighbours, one of them across a corner.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Quadrants(u8);

impl Quadrants {
    /// The number of quadrants of a pixel.
    pub(crate) const COUNT: usize = 4;
    pub(crate) const NONE: Self = Self(0);
    pub(crate) const ALL: Self = Self(0b1111);
    pub(crate) const LEFT: Self = Self(0b0101);
    pub(crate) const RIGHT: Self = Self(0b1010);
    pub(crate) const ABOVE: Self = Self(0b0011);
    pub(crate) const BELOW: Self = Self(0b1100);

    /// Those that lie towards a neighbour that differs from the pixel. `differs` is asked about neighbours by their places from it, -1 to 1 to the
    /// right and downwards.
    pub(crate) fn towards(differs: impl Fn(i32, i32) -> bool) -> Self {
        let quadrant = |right: i32, down: i32| {
            let any = differs(right, 0) || differs(0, down) || differs(right, down);
            u8::from(any) << Self::number(right > 0, down > 0)
        };
        Self(quadrant(-1, -1) | quadrant(1, -1) | quadrant(-1, 1) | quadrant(1, 1))
    }

    /// The number of the quadrant in which a place of the pixel lies; places go from 0 to 1 from its top left corner.
    pub(crate) fn of((x, y): (f64, f64)) -> usize {
        Self::number(x >= 0.5, y >= 0.5)
    }

    const fn number(right: bool, below: bool) -> usize {
        right as usize + 2 * below as usize
    }

    pub(crate) const fn has(self, number: usize) -> bool {
        self.0 >> number & 1 == 1
    }

    pub(crate) fn is_none(self) -> bool {
        self == Self::NONE
    }
}

impl BitOrAssign for Quadrants {
    fn bitor_assign(&mut self, other: Self) {
        self.0 |= other.0;
    }
}

impl Sub for Quadrants {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self(self.0 & !other.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PLACES: [(f64, f64); Quadrants::COUNT] = [(0.1, 0.2), (0.9, 0.2), (0.1, 0.8), (0.9, 0.8)];

    fn contained(quadrants: Quadrants) -> [bool; Quadrants::COUNT] {
        PLACES.map(|place| quadrants.has(Quadrants::of(place)))
    }

    #[test]
    fn quadrants_lie_towards_their_three_neighbours() {
        assert_eq!(contained(Quadrants::NONE), [false; 4]);
        assert_eq!(contained(Quadrants::ALL), [true; 4]);
        let left = Quadrants::ALL - Quadrants::RIGHT;
        assert_eq!(contained(left), [true, false, true, false]);
        let towards = |at: (i32, i32)| Quadrants::towards(|x, y| (x, y) == at);
        assert_eq!(towards((1, 0)), Quadrants::RIGHT);
        assert_eq!(towards((0, 1)), Quadrants::BELOW);
        assert_eq!(towards((-1, 0)), Quadrants::LEFT);
        assert_eq!(towards((0, -1)), Quadrants::ABOVE);
        assert_eq!(contained(towards((-1, 1))), [false, false, true, false]);
        assert!(Quadrants::towards(|_, _| false).is_none());
    }
}
