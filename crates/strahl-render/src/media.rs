use crate::trace::bytes;
use strahl_shade::{Material, MaterialId};

/// What is filled with one medium: an object with all its parts that have no medium of their own, or all of a material.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Body {
    /// Which use of an instanced group it is in; 0 is the world.
    space: u64,
    number: u32,
}

impl Body {
    /// An object, in the space of the instances whose elements begin at `space`.
    pub(crate) const fn object(space: u64, number: u32) -> Self {
        Self { space, number }
    }

    /// Whether it is an object.
    pub(crate) const fn is_object(self) -> bool {
        self.space != u64::MAX
    }

    /// Everything of a material.
    pub(crate) const fn material(id: MaterialId) -> Self {
        Self {
            space: u64::MAX,
            number: id.0,
        }
    }
}

/// How rays get in and out of what has a material.
///
/// The two rules differ where surfaces are open, overlap, or belong to solids with several media.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Crossing {
    /// By the side of the surface: materials without a texture of POV-Ray's.
    BySide,
    /// By turns, as in POV-Ray (measured): whichever surface of an object a ray passes, it gets out of it if it is in it, and in if
    /// not. So the ray gets out of what has one sheet only as soon as it meets it again, and a cut into a solid with a medium of its
    /// own is a solid that begins there.
    ByTurns,
}

impl Crossing {
    pub(crate) const fn of(material: &Material) -> Self {
        match material.texture {
            None => Self::BySide,
            Some(_) => Self::ByTurns,
        }
    }
}

/// What a ray may be inside of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Medium {
    pub(crate) body: Body,
    pub(crate) material: MaterialId,
    /// Whether fog is inside too.
    pub(crate) hollow: bool,
}

/// What a ray is inside of: a stack of media, shared between the branches of a ray tree.
///
/// Stacks are lists that grow at the front and share their tails; all of them live in one arena per sample. What counts is the
/// medium entered last. Leaving a body takes out the entry made last for it, wherever it is: overlapping and nested glass
/// works without the surfaces being in order, and closed hulls made of many polygons of one material count as one thing.
#[derive(Debug, Default)]
pub(crate) struct MediaArena {
    entries: Vec<(Medium, MediaStack)>,
    /// How many entries are for what the eye is in, which all trees have in common.
    of_eye: usize,
}

/// A stack in the arena: the number of its top entry plus one, 0 for empty space.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct MediaStack(u32);

impl MediaStack {
    pub(crate) const VACUUM: Self = Self(0);
}

impl MediaArena {
    /// The bytes of the stacks.
    pub(crate) fn bytes(&self) -> usize {
        bytes(&self.entries)
    }

    /// Forgets all stacks but that of the eye.
    #[inline]
    pub(crate) fn clear(&mut self) {
        self.entries.truncate(self.of_eye);
    }

    /// Makes the stack of the eye of these media, the last on top.
    pub(crate) fn begin(&mut self, media: impl IntoIterator<Item = Medium>) {
        self.entries.clear();
        let mut top = MediaStack::VACUUM;
        for medium in media {
            top = self.entered(top, medium);
        }
        self.of_eye = self.entries.len();
    }

    /// The stack of the eye.
    #[inline]
    pub(crate) const fn eye(&self) -> MediaStack {
        MediaStack(self.of_eye as u32)
    }

    /// The material a ray with this stack is inside of.
    pub(crate) fn top(&self, stack: MediaStack) -> Option<MaterialId> {
        self.entry(stack).map(|(medium, _)| medium.material)
    }

    /// The material a ray is inside of once it has left `body`.
    pub(crate) fn top_without(&self, stack: MediaStack, body: Body) -> Option<MaterialId> {
        match self.entry(stack) {
            Some((top, below)) if top.body == body => self.top(below),
            other => other.map(|(top, _)| top.material),
        }
    }

    /// Whether a ray with this stack is inside of `body`.
    pub(crate) fn is_inside(&self, stack: MediaStack, body: Body) -> bool {
        self.all(stack).any(|medium| medium.body == body)
    }

    /// Whether fog and rainbows are where a ray with this stack is.
    pub(crate) fn in_air(&self, stack: MediaStack) -> bool {
        self.all(stack).all(|medium| medium.hollow)
    }

    fn all(&self, stack: MediaStack) -> impl Iterator<Item = Medium> {
        let mut rest = stack;
        std::iter::from_fn(move || {
            let (medium, below) = self.entry(rest)?;
            rest = below;
            Some(medium)
        })
    }

    fn entry(&self, stack: MediaStack) -> Option<(Medium, MediaStack)> {
        stack
            .0
            .checked_sub(1)
            .map(|index| self.entries[index as usize])
    }

    /// The stack after getting into a medium.
    pub(crate) fn entered(&mut self, stack: MediaStack, medium: Medium) -> MediaStack {
        self.entries.push((medium, stack));
        MediaStack(self.entries.len() as u32)
    }

    /// The stack after getting out of `body`; unchanged if the ray was not inside of it.
    pub(crate) fn left(&mut self, stack: MediaStack, body: Body) -> MediaStack {
        let (mut kept, mut rest) = (Vec::new(), stack);
        while let Some((top, below)) = self.entry(rest) {
            if top.body == body {
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

    fn medium(number: u32) -> Medium {
        Medium {
            body: Body::object(0, number),
            material: MaterialId(number),
            hollow: false,
        }
    }

    #[test]
    fn leaving_takes_out_the_right_entry() {
        let (water, glass) = (medium(1), medium(2));
        let mut arena = MediaArena::default();
        let in_water = arena.entered(MediaStack::VACUUM, water);
        let in_glass = arena.entered(in_water, glass);
        assert_eq!(arena.top(in_glass), Some(glass.material));
        let back = arena.left(in_glass, glass.body);
        assert_eq!(back, in_water);
        // Out of the water first, while still inside the glass that pokes through its surface.
        let poking = arena.left(in_glass, water.body);
        assert_eq!(arena.top(poking), Some(glass.material));
        assert!(arena.is_inside(poking, glass.body) && !arena.is_inside(poking, water.body));
        let outside = arena.left(poking, glass.body);
        assert_eq!(outside, MediaStack::VACUUM);
        assert_eq!(arena.left(outside, glass.body), MediaStack::VACUUM);
    }

    #[test]
    fn what_the_eye_is_in_stays_from_tree_to_tree() {
        let mut arena = MediaArena::default();
        arena.begin([
            medium(1),
            Medium {
                hollow: true,
                ..medium(2)
            },
        ]);
        let eye = arena.eye();
        for _ in 0..2 {
            assert_eq!(arena.top(eye), Some(MaterialId(2)));
            assert!(!arena.in_air(eye));
            let out = arena.left(eye, Body::object(0, 1));
            assert!(arena.in_air(out) && out != eye);
            arena.clear();
        }
        arena.begin([]);
        assert_eq!(arena.eye(), MediaStack::VACUUM);
    }
}
