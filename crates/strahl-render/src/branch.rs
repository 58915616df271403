//! The rays of a tree: those that wait, those that a hit sends, and those that were traced.

use crate::hit::{Origin, RayClass};
use crate::media::MediaStack;
use crate::observer::{RayKind, Share};
use strahl_math::{DVec3, Ray};
use strahl_shade::{Color, SpectralPart};

/// A ray still to be traced.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Branch {
    pub(crate) ray: Ray,
    pub(crate) origin: Option<Origin>,
    pub(crate) kind: RayKind,
    /// Its visibility class: transmitted rays see the same objects as the ray that sent them.
    pub(crate) class: RayClass,
    /// The node of the ray that sent it; of a primary ray its number in the packet.
    pub(crate) parent: u32,
    pub(crate) depth: u32,
    /// The part of the spectrum it stands for.
    pub(crate) part: SpectralPart,
    /// Whether it stands for a part of the spectrum while its parent stands for all of it.
    pub(crate) divided: bool,
    /// Whether it must not overtake others that wait: light of three and more rays of one kind is added in their order, on which the last bits
    /// of the sum depend.
    pub(crate) ordered: bool,
    pub(crate) weight: f64,
    pub(crate) share: Share,
    pub(crate) media: MediaStack,
}

impl Branch {
    /// A place for a ray.
    pub(crate) const NONE: Self = Self {
        ray: Ray {
            origin: DVec3::ZERO,
            direction: DVec3::ZERO,
        },
        origin: None,
        kind: RayKind::Primary,
        class: RayClass::Camera,
        parent: 0,
        depth: 1,
        part: SpectralPart::WHITE,
        divided: false,
        ordered: false,
        weight: 1.0,
        share: Share::ALL,
        media: MediaStack::VACUUM,
    };

    /// The root of a tree, in the media the eye is in; `number` tells the trees of a packet apart.
    pub(crate) fn primary(ray: &Ray, number: u32, eye: MediaStack) -> Self {
        let mut branch = Self::NONE;
        branch.begin(ray, number, eye);
        branch
    }

    /// Makes it [the root of a tree](Branch::primary).
    // In place: a branch has more than 200 bytes, and would be put together elsewhere and copied.
    #[inline(always)]
    pub(crate) fn begin(&mut self, primary: &Ray, number: u32, eye: MediaStack) {
        let none = Self::NONE;
        let Self {
            ray,
            origin,
            kind,
            class,
            parent,
            depth,
            part,
            divided,
            ordered,
            weight,
            share,
            media,
        } = self;
        (*ray, *parent, *media) = (*primary, number, eye);
        // From the primary ray that was here before it differs in nothing else.
        if *kind == RayKind::Primary {
            return;
        }
        *origin = none.origin;
        (*kind, *class, *depth) = (none.kind, none.class, none.depth);
        (*part, *divided, *ordered) = (none.part, none.divided, none.ordered);
        (*weight, *share) = (none.weight, none.share);
    }
}

/// A branch: a ray sent by a hit.
pub(crate) struct Offshoot {
    pub(crate) kind: RayKind,
    /// How much it contributes to the hit.
    pub(crate) share: Share,
    /// The factor of the weight.
    pub(crate) coefficient: f64,
    pub(crate) direction: DVec3,
    pub(crate) part: SpectralPart,
    /// Whether it stands for a part of the spectrum while the hit's ray stands for all of it.
    pub(crate) divided: bool,
    /// Whether it stays on its side of the surface although it is no reflection ray: a part of the spectrum that is totally
    /// reflected where the rest is refracted.
    pub(crate) returned: bool,
}

impl Offshoot {
    #[inline]
    pub(crate) fn new(kind: RayKind, share: Share, direction: DVec3, part: SpectralPart) -> Self {
        Self {
            kind,
            share,
            coefficient: share.factor.max_component(),
            direction,
            part,
            divided: false,
            returned: false,
        }
    }
}

/// A ray that was traced and waits for its branches.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Node {
    pub(crate) parent: u32,
    pub(crate) kind: RayKind,
    /// The hit's own contribution, or the background.
    pub(crate) local: Color,
    /// How much it contributes to its parent.
    pub(crate) share: Share,
    /// The contributions of its branches.
    pub(crate) reflected: Color,
    pub(crate) transmitted: Color,
    /// The attenuation by the medium in front of the hit.
    pub(crate) attenuation: Color,
    /// The light that fog and rainbows in front of the hit add.
    pub(crate) fog: Color,
}

impl Node {
    /// A place for a node.
    pub(crate) const NONE: Self = Self {
        parent: 0,
        kind: RayKind::Primary,
        local: Color::BLACK,
        share: Share::ALL,
        reflected: Color::BLACK,
        transmitted: Color::BLACK,
        attenuation: Color::BLACK,
        fog: Color::BLACK,
    };
}
