//! Sets of the states of a tree's leaves.

use std::ops::{BitAnd, BitOr, BitXor, Not};

/// The most leaves.
pub(super) const MOST: usize = 6;

/// The states with bit `i` set.
const SET: [u64; MOST] = [
    0xaaaa_aaaa_aaaa_aaaa,
    0xcccc_cccc_cccc_cccc,
    0xf0f0_f0f0_f0f0_f0f0,
    0xff00_ff00_ff00_ff00,
    0xffff_0000_ffff_0000,
    0xffff_ffff_0000_0000,
];

/// A set of states. A state is a number of [`MOST`] bits, one for each leaf: whether the ray is inside of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct States(u64);

impl States {
    pub(super) const NONE: Self = Self(0);
    pub(super) const ALL: Self = Self(u64::MAX);

    /// Whether the two have a state in common.
    #[inline]
    pub(super) fn meets(self, other: Self) -> bool {
        self.0 & other.0 != 0
    }

    /// Whether a state, below `1 << MOST`, is one of them.
    #[inline]
    pub(super) fn contains(self, state: u8) -> bool {
        self.0 >> (state & 63) & 1 != 0
    }

    /// The states in which a bit has this value.
    #[inline]
    pub(super) fn with(bit: usize, set: bool) -> Self {
        Self(if set { SET[bit] } else { !SET[bit] })
    }

    /// These states with a bit changed.
    pub(super) fn flipped(self, bit: usize) -> Self {
        let (by, set) = (1 << bit, SET[bit]);
        Self((self.0 & set) >> by | (self.0 & !set) << by)
    }
}

impl BitAnd for States {
    type Output = Self;
    fn bitand(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }
}

impl BitOr for States {
    type Output = Self;
    fn bitor(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}

impl BitXor for States {
    type Output = Self;
    fn bitxor(self, other: Self) -> Self {
        Self(self.0 ^ other.0)
    }
}

impl Not for States {
    type Output = Self;
    fn not(self) -> Self {
        Self(!self.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sets_are_those_of_their_states() {
        // Any set: the states whose bits, mixed a little, have an odd sum.
        let is_in = |state: u8| (state.wrapping_mul(37) ^ state >> 3).count_ones() % 2 == 1;
        let states = 0..1 << MOST;
        let set = States(states.clone().map(|s| u64::from(is_in(s)) << s).sum());
        for state in states {
            assert_eq!(set.contains(state), is_in(state));
            assert_eq!((!set).contains(state), !is_in(state));
            for bit in 0..MOST {
                let has = state >> bit & 1 == 1;
                assert_eq!(set.flipped(bit).contains(state), is_in(state ^ 1 << bit));
                assert_eq!(States::with(bit, true).contains(state), has);
                assert_eq!(States::with(bit, false).contains(state), !has);
            }
        }
        assert!(set.meets(States::ALL) && !set.meets(!set) && !set.meets(States::NONE));
    }
}
