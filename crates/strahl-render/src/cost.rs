/// What a pixel cost, all its samples and passes together.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PixelCost {
    /// Primitives tested.
    pub tests: u64,
    /// Nodes and cells looked at.
    pub steps: u64,
    /// Rays followed, shadow rays included.
    pub rays: u64,
    /// Deepest level of its ray trees.
    pub depth: u32,
    /// Time spent, as [`crate::Progress::now`] measures it.
    pub nanoseconds: u64,
}

impl std::ops::AddAssign for PixelCost {
    /// Adds what a further pass cost.
    fn add_assign(&mut self, o: Self) {
        self.tests += o.tests;
        self.steps += o.steps;
        self.rays += o.rays;
        self.depth = self.depth.max(o.depth);
        self.nanoseconds += o.nanoseconds;
    }
}
