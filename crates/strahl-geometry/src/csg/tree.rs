use crate::Shape;
use std::fmt;
use std::ops::Deref;
use strahl_math::Transform;

/// A CSG tree as it is described: what [`Csg::try_new`](crate::Csg::try_new) compiles.
///
/// The operations mean what they mean in POV-Ray. Trees may be nested arbitrarily deep.
///
/// Open surfaces (triangles, patches, meshes without an inside) may be leaves: no point is inside of them, nor of their
/// complement. An intersection keeps the part of their surface inside of all other operands, a merge the part outside of all
/// others. So a difference with an open surface subtracted is that surface, where it is inside of the other operands. A tree with
/// an open leaf is not a [`Solid`](crate::Solid).
#[derive(Debug)]
#[non_exhaustive]
pub enum CsgNode {
    /// A shape.
    Leaf {
        /// The shape.
        shape: Shape,
        /// Where it is in the space of its parent; `None` is the identity.
        transform: Option<Box<Transform>>,
        /// The caller's number for it, to find its material and name again: [`Csg::leaf_tag`](crate::Csg::leaf_tag).
        tag: u32,
    },
    /// The points inside of any operand. Surfaces inside of other operands are kept, as [`Side::Inner`](crate::Side::Inner)
    /// crossings: they are visible if the material in front of them is transparent.
    Union(Operands),
    /// The points inside of any operand, without inner surfaces.
    Merge(Operands),
    /// The points inside of all operands.
    Intersection(Operands),
    /// The first operand without the others.
    Difference(Operands),
    /// The points outside of all operands (usually one). Inner surfaces of unions below are dropped: they lie outside, and a
    /// second inversion does not restore them.
    Inverse(Operands),
    /// The part of the first operand that is inside of all others, without a surface where they cut it. The cuts are still
    /// boundaries for the operations above, but invisible. An inverse or difference around it inverts the first operand only, which the
    /// others clip as before: so it is in POV-Ray (measured).
    Clip(Operands),
    /// The union of the operands (usually one), moved together.
    Transformed {
        /// The operands.
        operands: Operands,
        /// The transform.
        transform: Box<Transform>,
    },
}

impl CsgNode {
    /// A leaf in the space of its parent.
    pub fn leaf(shape: impl Into<Shape>, tag: u32) -> Self {
        Self::Leaf {
            shape: shape.into(),
            transform: None,
            tag,
        }
    }

    /// See [`CsgNode::Union`].
    pub fn union(operands: impl IntoIterator<Item = Self>) -> Self {
        Self::Union(operands.into_iter().collect())
    }

    /// See [`CsgNode::Merge`].
    pub fn merge(operands: impl IntoIterator<Item = Self>) -> Self {
        Self::Merge(operands.into_iter().collect())
    }

    /// See [`CsgNode::Intersection`].
    pub fn intersection(operands: impl IntoIterator<Item = Self>) -> Self {
        Self::Intersection(operands.into_iter().collect())
    }

    /// See [`CsgNode::Difference`].
    pub fn difference(operands: impl IntoIterator<Item = Self>) -> Self {
        Self::Difference(operands.into_iter().collect())
    }

    /// `object` cut by the other nodes, without a cap: see [`CsgNode::Clip`].
    pub fn clip(object: Self, by: impl IntoIterator<Item = Self>) -> Self {
        Self::Clip(std::iter::once(object).chain(by).collect())
    }

    /// Everything outside of this.
    #[must_use]
    pub fn inverted(self) -> Self {
        Self::Inverse(std::iter::once(self).collect())
    }

    /// This, moved.
    #[must_use]
    pub fn transformed(self, transform: Transform) -> Self {
        Self::Transformed {
            operands: std::iter::once(self).collect(),
            transform: Box::new(transform),
        }
    }

    /// The operands, if this is not a leaf.
    fn operands_mut(&mut self) -> Option<&mut Operands> {
        match self {
            Self::Leaf { .. } => None,
            Self::Union(operands)
            | Self::Merge(operands)
            | Self::Intersection(operands)
            | Self::Difference(operands)
            | Self::Inverse(operands)
            | Self::Clip(operands)
            | Self::Transformed { operands, .. } => Some(operands),
        }
    }
}

/// The operands of an operation: a list of nodes that may be nested arbitrarily deep, because dropping it takes no stack.
#[derive(Default)]
pub struct Operands(Vec<CsgNode>);

impl Operands {
    /// The nodes.
    pub fn into_vec(mut self) -> Vec<CsgNode> {
        std::mem::take(&mut self.0)
    }
}

impl Drop for Operands {
    fn drop(&mut self) {
        let mut waiting = std::mem::take(&mut self.0);
        while let Some(mut node) = waiting.pop() {
            if let Some(operands) = node.operands_mut() {
                waiting.append(&mut operands.0);
            }
        }
    }
}

impl Deref for Operands {
    type Target = [CsgNode];

    fn deref(&self) -> &[CsgNode] {
        &self.0
    }
}

impl From<Vec<CsgNode>> for Operands {
    fn from(nodes: Vec<CsgNode>) -> Self {
        Self(nodes)
    }
}

impl FromIterator<CsgNode> for Operands {
    fn from_iter<I: IntoIterator<Item = CsgNode>>(nodes: I) -> Self {
        Self(nodes.into_iter().collect())
    }
}

/// Shallow, since trees may be deeper than the stack.
impl fmt::Debug for Operands {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "[{} operands]", self.0.len())
    }
}
