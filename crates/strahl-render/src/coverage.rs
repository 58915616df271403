//! The background in a pixel: the alpha channel.

use crate::branch::Node;
use crate::observer::RayKind;
use crate::sampling::Sample;
use crate::trace::bytes;
use strahl_math::DVec3;
use strahl_scene::{Background, BackgroundAlpha};
use strahl_shade::Color;

/// Adds up how much of the background primary rays see, directly and through things that let light pass. Mirrors show the
/// background as part of themselves.
///
/// As in POV-Ray (measured) what a surface lets pass counts as one number, the luminance of its coefficient.
#[derive(Debug)]
pub(crate) struct Coverage {
    /// What rays see that hit nothing.
    background: Background,
    /// What the alpha channel makes of it.
    alpha: BackgroundAlpha,
    /// By node of the trees, what its ray sees of the background.
    nodes: Vec<Clear>,
}

/// What a ray sees of the background.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Clear {
    /// The part of the ray's light that is left out of the picture.
    light: Color,
    /// How much of what lies behind the picture shows: 0 is opaque.
    share: f64,
}

impl Clear {
    /// The background does not show.
    const OPAQUE: Self = Self {
        light: Color::BLACK,
        share: 0.0,
    };

    /// The same behind a medium.
    pub(crate) fn attenuated(self, attenuation: Color) -> Self {
        Self {
            light: self.light * attenuation,
            share: self.share * luminance(attenuation),
        }
    }

    /// Light along a primary ray without the background.
    pub(crate) fn taken_from(self, color: Color) -> Sample {
        Sample {
            color: color - self.light,
            clear: self.share,
        }
    }
}

/// How bright a coefficient is: 0.297 of red, 0.589 of green and 0.114 of blue. That of a grey is exactly the grey.
fn luminance(c: Color) -> f64 {
    c.g + 0.297 * (c.r - c.g) + 0.114 * (c.b - c.g)
}

impl Coverage {
    /// For a background and what the alpha channel makes of it.
    pub(crate) fn new(background: Background, alpha: BackgroundAlpha) -> Self {
        Self {
            background,
            alpha,
            nodes: Vec::new(),
        }
    }

    /// The bytes of the list of nodes.
    pub(crate) fn bytes(&self) -> usize {
        bytes(&self.nodes)
    }

    /// Begins other trees.
    pub(crate) fn restart(&mut self) {
        self.nodes.clear();
    }

    /// The light along a ray that hits nothing, and what of it is background.
    pub(crate) fn beyond(&self, direction: DVec3) -> (Color, Clear) {
        let [seen, light, clear] = self.background.seen(direction, self.alpha);
        let share = luminance(clear);
        (seen, Clear { light, share })
    }

    /// Takes note of the next node of the trees, whose ray hits something.
    pub(crate) fn enter(&mut self) {
        self.nodes.push(Clear::OPAQUE);
    }

    /// The same for a ray that hits nothing. Returns the light along it.
    pub(crate) fn enter_miss(&mut self, direction: DVec3) -> Color {
        let (seen, clear) = self.beyond(direction);
        self.nodes.push(clear);
        seen
    }

    /// Hands what a node's ray sees of the background to its parent, after all of its children. Returns the light along a primary ray, `total`,
    /// without the background.
    pub(crate) fn combine(&mut self, index: usize, node: &Node, total: Color) -> Sample {
        let clear = self.nodes[index].attenuated(node.attenuation);
        match node.kind {
            RayKind::Primary => return clear.taken_from(total),
            RayKind::Refraction => {
                let taken = node.share.factor;
                let parent = &mut self.nodes[node.parent as usize];
                parent.light += taken * clear.light;
                parent.share += luminance(taken) * clear.share;
            }
            RayKind::Reflection | RayKind::Gather => {}
        }
        Sample::from(total)
    }
}
