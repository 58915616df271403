/// The cost of a pixel: all its samples and passes together.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PixelCost {
    /// Primitives tested.
    pub tests: u64,
    /// Nodes and cells visited.
    pub steps: u64,
    /// Rays traced, shadow rays included.
    pub rays: u64,
    /// Deepest level of its ray trees.
    pub depth: u32,
    /// Time spent, as [`crate::Progress::now`] measures it.
    pub nanoseconds: u64,
}

impl std::ops::AddAssign for PixelCost {
    /// Adds the cost of a further pass.
    fn add_assign(&mut self, o: Self) {
        self.tests += o.tests;
        self.steps += o.steps;
        self.rays += o.rays;
        self.depth = self.depth.max(o.depth);
        self.nanoseconds += o.nanoseconds;
    }
}
