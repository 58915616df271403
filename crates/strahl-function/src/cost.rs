//! The cost of evaluating functions, patterns and pigments, so that evaluations which would take hours are rejected beforehand.

/// The cost of one evaluation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cost {
    /// Operations on numbers, each some nanoseconds.
    pub operations: u64,
    /// How deep functions that evaluate others are nested; 0 if nothing else is evaluated.
    pub depth: u32,
}

impl Cost {
    /// The cost of a formula of some dozen operations.
    pub const FORMULA: Self = Self::operations(32);

    /// The cost of operations that evaluate nothing else.
    pub const fn operations(operations: u64) -> Self {
        Self {
            operations,
            depth: 0,
        }
    }

    /// The cost of both, one after the other.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Self {
            operations: self.operations.saturating_add(other.operations),
            depth: if self.depth > other.depth {
                self.depth
            } else {
                other.depth
            },
        }
    }

    /// The cost of a function that evaluates this one.
    #[must_use]
    pub fn around(self) -> Self {
        Self {
            operations: self.operations.saturating_add(1),
            depth: self.depth.saturating_add(1),
        }
    }
}
