//! What it takes to evaluate things, so that what would take hours is an error before it begins.

/// What one evaluation takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cost {
    /// Operations on numbers, each some nanoseconds.
    pub operations: u64,
    /// How deep things that evaluate others are nested; 0 for what evaluates nothing else.
    pub depth: u32,
}

impl Cost {
    /// Of a formula of some dozen operations.
    pub const FORMULA: Self = Self::operations(32);

    /// Of so many operations that evaluate nothing else.
    pub const fn operations(operations: u64) -> Self {
        Self {
            operations,
            depth: 0,
        }
    }

    /// Of both, one after the other.
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

    /// Of something that evaluates this.
    #[must_use]
    pub fn around(self) -> Self {
        Self {
            operations: self.operations.saturating_add(1),
            depth: self.depth.saturating_add(1),
        }
    }
}
