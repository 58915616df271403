use strahl_shade::MaterialId;

/// The media that a ray is inside of: a stack of materials, shared between the branches of a ray tree.
///
/// Stacks are linked lists that share their tails; all of them live in one arena per sample. The current medium is the one
/// entered last. Leaving a material removes its last entry, wherever that is: overlapping and nested glass works without
/// priorities of surfaces, and a closed hull made of many polygons of one material is one medium.
#[derive(Debug, Default)]
pub(crate) struct MediaArena {
    entries: Vec<(MaterialId, MediaStack)>,
}

/// A stack in the arena: the number of its top entry plus one, 0 for empty space.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct MediaStack(u32);

impl MediaStack {
    pub(crate) const VACUUM: Self = Self(0);
}

impl MediaArena {
    /// Forgets all stacks.
    pub(crate) fn clear(&mut self) {
        self.entries.clear();
    }

    /// The material a ray with this stack is inside of.
    pub(crate) fn top(&self, stack: MediaStack) -> Option<MaterialId> {
        self.entry(stack).map(|(material, _)| material)
    }

    /// The material a ray is inside of once it has left `material`.
    pub(crate) fn top_without(
        &self,
        stack: MediaStack,
        material: MaterialId,
    ) -> Option<MaterialId> {
        match self.entry(stack) {
            Some((top, below)) if top == material => self.top(below),
            other => other.map(|(top, _)| top),
        }
    }

    fn entry(&self, stack: MediaStack) -> Option<(MaterialId, MediaStack)> {
        stack
            .0
            .checked_sub(1)
            .map(|index| self.entries[index as usize])
    }

    /// The stack after entering `material`.
    pub(crate) fn entered(&mut self, stack: MediaStack, material: MaterialId) -> MediaStack {
        self.entries.push((material, stack));
        MediaStack(self.entries.len() as u32)
    }

    /// The stack after leaving `material`; unchanged if the ray was not inside of it (the eye may have been).
    pub(crate) fn left(&mut self, stack: MediaStack, material: MaterialId) -> MediaStack {
        let (mut kept, mut rest) = (Vec::new(), stack);
        while let Some((top, below)) = self.entry(rest) {
            if top == material {
                return kept
                    .into_iter()
                    .rev()
                    .fold(below, |s, m| self.entered(s, m));
            }
            kept.push(top);
            rest = below;
        }
        stack
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn leaving_takes_out_the_right_entry() {
        let (water, glass) = (MaterialId(1), MaterialId(2));
        let mut arena = MediaArena::default();
        let in_water = arena.entered(MediaStack::VACUUM, water);
        let in_glass = arena.entered(in_water, glass);
        assert_eq!(arena.top(in_glass), Some(glass));
        let back = arena.left(in_glass, glass);
        assert_eq!(back, in_water);
        // Out of the water first, while still inside the glass that pokes through its surface.
        let poking = arena.left(in_glass, water);
        assert_eq!(arena.top(poking), Some(glass));
        let outside = arena.left(poking, glass);
        assert_eq!(outside, MediaStack::VACUUM);
        assert_eq!(arena.left(outside, glass), MediaStack::VACUUM);
    }
}
