//! What of a pixel is background: the alpha channel.

use crate::observer::{RayKind, RayReport, TraceObserver};
use strahl_scene::{Background, BackgroundAlpha};
use strahl_shade::Color;

/// Adds up how much of the background a primary ray sees, directly and through things that let light pass. Mirrors show the
/// background as part of themselves.
///
/// As in POV-Ray (measured) what a surface lets pass counts as one number, the luminance of its coefficient.
#[derive(Debug, Default)]
pub(crate) struct Coverage {
    nodes: Vec<Node>,
    /// What rays see that hit nothing.
    background: Background,
    /// What the alpha channel makes of it.
    alpha: BackgroundAlpha,
    /// The light of the pixel without it.
    pub(crate) color: Color,
    /// How much of what lies behind the picture shows: 0 is opaque.
    pub(crate) clear: f64,
}

/// A ray of the tree.
#[derive(Debug)]
struct Node {
    parent: u32,
    kind: RayKind,
    taken: Color,
    attenuation: Color,
    /// The background's light in that of the ray that is left out of the picture.
    background: Color,
    clear: f64,
}

impl Coverage {
    /// For a background and what the alpha channel makes of it.
    pub(crate) fn new(background: Background, alpha: BackgroundAlpha) -> Self {
        Self {
            background,
            alpha,
            ..Self::default()
        }
    }

    /// Begins another tree.
    pub(crate) fn restart(&mut self) {
        self.nodes.clear();
        (self.color, self.clear) = (Color::BLACK, 0.0);
    }
}

/// How bright a coefficient is.
fn luminance(c: Color) -> f64 {
    0.297 * c.r + 0.589 * c.g + 0.114 * c.b
}

impl TraceObserver for Coverage {
    const DETAILED: bool = false;

    fn ray(&mut self, report: RayReport) {
        let nothing = (Color::BLACK, Color::BLACK);
        let (background, clear) = report.background.map_or(nothing, |_| {
            let direction = report.ray.direction;
            self.background.left_out(direction, self.alpha)
        });
        self.nodes.push(Node {
            parent: report.parent,
            kind: report.kind,
            taken: report.share.factor,
            attenuation: report.attenuation,
            background,
            clear: luminance(clear),
        });
    }

    // Children come before their parents.
    fn combined(&mut self, index: u32, _local: Color, total: Color) {
        let Some(node) = self.nodes.get(index as usize) else {
            return;
        };
        let background = node.background * node.attenuation;
        let clear = node.clear * luminance(node.attenuation);
        let (parent, taken) = (node.parent as usize, node.taken);
        match node.kind {
            RayKind::Primary => {
                self.color = total - background;
                self.clear = clear;
            }
            RayKind::Refraction => {
                if let Some(parent) = self.nodes.get_mut(parent) {
                    parent.background += taken * background;
                    parent.clear += luminance(taken) * clear;
                }
            }
            RayKind::Reflection | RayKind::Gather => {}
        }
    }
}
