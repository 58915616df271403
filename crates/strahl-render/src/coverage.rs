//! What of a pixel is background: the alpha channel.

use crate::observer::{RayKind, RayReport, TraceObserver};
use strahl_shade::Color;

/// Adds up how much of the background a primary ray sees, directly and through things that let light pass. Mirrors show the
/// background as part of themselves.
///
/// As in POV-Ray (measured) what a surface lets pass counts as one number, the luminance of its coefficient.
#[derive(Debug, Default)]
pub(crate) struct Coverage {
    nodes: Vec<Node>,
    /// The part of the background's light that the alpha channel takes out of the picture.
    transmit: f64,
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
    /// The background's light in that of the ray.
    background: Color,
    clear: f64,
}

impl Coverage {
    /// For a background of which this part is see-through.
    pub(crate) fn new(transmit: f64) -> Self {
        Self {
            transmit,
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
    fn ray(&mut self, report: RayReport) {
        let seen = report.background;
        self.nodes.push(Node {
            parent: report.parent,
            kind: report.kind,
            taken: report.share.factor,
            attenuation: report.attenuation,
            background: seen.map_or(Color::BLACK, |color| color * self.transmit),
            clear: seen.map_or(0.0, |_| self.transmit),
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
            RayKind::Reflection => {}
        }
    }
}
