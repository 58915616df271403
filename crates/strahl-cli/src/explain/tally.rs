//! The contribution of each ray of a tree to its pixel.

use strahl::shade::Color;
use strahl::tracing::{RayKind, RayTree};

/// The contributions of the rays of a tree.
#[derive(Debug)]
pub(crate) struct Tally {
    /// The contribution of the local colour at a ray's hit (or of the background), by the ray's number; `None` below a reflection
    /// with an `exponent`, which does not scale light linearly: that reflection ray stands for the whole subtree.
    pub(crate) adds: Vec<Option<Color>>,
}

/// The number of rays of each kind in a tree.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Counts {
    pub(crate) primary: u32,
    pub(crate) reflection: u32,
    pub(crate) refraction: u32,
    pub(crate) gather: u32,
    pub(crate) shadow: u32,
    pub(crate) levels: u32,
}

impl Tally {
    pub(crate) fn of(tree: &RayTree) -> Self {
        let mut passes: Vec<Option<Color>> = vec![None; tree.nodes.len()];
        let mut adds = vec![None; tree.nodes.len()];
        // Parents come before their children.
        for (index, node) in tree.nodes.iter().enumerate() {
            let report = &node.report;
            let parent = if report.node == report.parent {
                Some(Color::WHITE)
            } else {
                let parent = tree.nodes.get(report.parent as usize);
                let above = passes.get(report.parent as usize).copied().flatten();
                match (above, parent) {
                    (Some(above), Some(parent)) => Some(above * parent.report.attenuation),
                    _ => None,
                }
            };
            let Some(above) = parent else { continue };
            if report.share.power == 1.0 {
                let taken = above * report.share.factor;
                passes[index] = Some(taken);
                adds[index] = Some(taken * (node.local * report.attenuation + report.fog));
            } else {
                adds[index] = Some(above * report.share.of(node.total));
            }
        }
        Self { adds }
    }

    /// The rays that contribute most, with their ancestors, about `most` in number; all if there are no more.
    pub(crate) fn shown(&self, tree: &RayTree, most: usize) -> Vec<bool> {
        let count = tree.nodes.len();
        if count <= most {
            return vec![true; count];
        }
        let weight = |index: &usize| {
            let adds = self.adds[*index].unwrap_or_default();
            adds.map(f64::abs).max_component()
        };
        let mut order: Vec<usize> = (0..count).collect();
        order.sort_by(|a, b| weight(b).total_cmp(&weight(a)).then(a.cmp(b)));
        let (mut shown, mut taken) = (vec![false; count], 0);
        for index in order {
            if taken >= most {
                break;
            }
            let mut at = index;
            while !shown[at] {
                shown[at] = true;
                taken += 1;
                at = tree.nodes[at].report.parent as usize;
            }
        }
        shown
    }
}

impl Counts {
    pub(crate) fn of(tree: &RayTree) -> Self {
        let mut counts = Self::default();
        for node in &tree.nodes {
            match node.report.kind {
                RayKind::Primary => counts.primary += 1,
                RayKind::Reflection => counts.reflection += 1,
                RayKind::Refraction => counts.refraction += 1,
                RayKind::Gather => counts.gather += 1,
            }
            counts.shadow += node
                .lights
                .iter()
                .map(|light| light.term.shadow_rays)
                .sum::<u32>();
            counts.levels = counts.levels.max(node.report.depth);
        }
        counts
    }

    pub(crate) fn plus(self, o: Self) -> Self {
        Self {
            primary: self.primary + o.primary,
            reflection: self.reflection + o.reflection,
            refraction: self.refraction + o.refraction,
            gather: self.gather + o.gather,
            shadow: self.shadow + o.shadow,
            levels: self.levels.max(o.levels),
        }
    }

    /// The number of rays other than shadow rays.
    pub(crate) fn rays(self) -> u32 {
        self.primary + self.reflection + self.refraction + self.gather
    }

    /// In words.
    pub(crate) fn words(self) -> String {
        let rays = self.rays();
        let gather = match self.gather {
            0 => String::new(),
            count => format!(", {count} gather"),
        };
        format!(
            "{rays} {} ({} primary, {} reflection, {} transparency{gather}), {} shadow {}, {} {}",
            plural(rays, "ray", "rays"),
            self.primary,
            self.reflection,
            self.refraction,
            self.shadow,
            plural(self.shadow, "ray", "rays"),
            self.levels,
            plural(self.levels, "level", "levels"),
        )
    }
}

pub(crate) fn plural(count: u32, one: &'static str, many: &'static str) -> &'static str {
    if count == 1 { one } else { many }
}
