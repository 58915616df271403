//! The spaces between a surface and the textures within its texture, as normals pass them.

use crate::patterns::Warp;
use strahl_math::{DVec3, Transform};

/// The transform of a normal into a texture's own space and back.
pub(super) trait NormalSpace {
    /// The normal in the inner space; its length is the one that bumps with `no_bump_scale` are added to (measured).
    fn enter(&self, n: DVec3) -> DVec3;
    /// A normal of the inner space in the outer one.
    fn leave(&self, n: DVec3) -> DVec3;
}

/// No space of its own.
pub(super) struct Identity;

impl NormalSpace for Identity {
    fn enter(&self, n: DVec3) -> DVec3 {
        n
    }
    fn leave(&self, n: DVec3) -> DVec3 {
        n
    }
}

impl NormalSpace for Transform {
    fn enter(&self, n: DVec3) -> DVec3 {
        self.linear().transpose() * n
    }
    fn leave(&self, n: DVec3) -> DVec3 {
        self.normal_to_world(n)
    }
}

/// The transformations among warps; the other warps leave normals alone.
impl NormalSpace for Vec<Warp> {
    fn enter(&self, n: DVec3) -> DVec3 {
        let inner = self.iter().rev().fold(n, |n, warp| match warp {
            Warp::Transform(transform) => transform.enter(n),
            _ => n,
        });
        inner.normalize_or(n)
    }
    fn leave(&self, n: DVec3) -> DVec3 {
        self.iter().fold(n, |n, warp| match warp {
            Warp::Transform(transform) => transform.leave(n),
            _ => n,
        })
    }
}

/// The way of normals from a texture's own space.
#[derive(Clone, Copy)]
pub(super) struct Ways<'s> {
    /// To the space around the whole texture.
    pub(super) out: &'s dyn NormalSpace,
    /// To the space of the innermost map around: the transformations of a plain texture are those of its normal.
    pub(super) to_map: &'s dyn NormalSpace,
}

impl<'s> Ways<'s> {
    /// Those of a texture that is not in a map.
    pub(super) const fn of(space: &'s dyn NormalSpace) -> Self {
        Self {
            out: space,
            to_map: space,
        }
    }
}

/// A space inside of another.
pub(super) struct Chain<'s> {
    pub(super) outer: &'s dyn NormalSpace,
    pub(super) inner: &'s dyn NormalSpace,
}

impl NormalSpace for Chain<'_> {
    fn enter(&self, n: DVec3) -> DVec3 {
        self.inner.enter(self.outer.enter(n))
    }
    fn leave(&self, n: DVec3) -> DVec3 {
        self.outer.leave(self.inner.leave(n))
    }
}
