//! Random scenes. Intended differences, which docs/src/pov-ray.md lists, are not generated.

mod cameras;
mod csg;
mod expressions;
mod finishes;
mod lights;
mod modifiers;
mod patterns;
mod pigments;
mod solids;
mod surfaces;
mod swept;
mod textures;

use super::dice::Dice;
use super::node::{Node, Part, Sort, block, list, needed, optional, run, words};

/// Writes one scene.
pub(super) struct Writer {
    dice: Dice,
    /// The number behind `#version`; 0 if there is no such line.
    version: f64,
    /// Whether `assumed_gamma` is set.
    gamma: bool,
    declared: Vec<(Sort, String)>,
}

/// The scene of this number in the series of a seed.
pub(super) fn scene(seed: u64, number: u64) -> Node {
    let mut writer = Writer {
        dice: Dice::new(seed, number),
        version: 3.7,
        gamma: false,
        declared: vec![],
    };
    writer.scene()
}

impl Writer {
    fn scene(&mut self) -> Node {
        self.version = self
            .dice
            .weighted(&[(70, 3.7), (12, 3.6), (8, 3.5), (5, 3.1), (5, 0.0)]);
        let mut parts = vec![];
        if self.version > 0.0 {
            parts.push(needed(words(format!("#version {:.1};", self.version))));
        }
        parts.push(needed(self.settings()));
        if self.dice.chance(8) {
            let what = match self.dice.chance(50) {
                true => self.finish(),
                false => self.pigment(1),
            };
            parts.push(optional(list!["#default {", what, "}"]));
        }
        parts.push(needed(self.camera()));
        for _ in 0..self.dice.weighted(&[(70, 1), (25, 2), (5, 3)]) {
            parts.push(optional(self.light()));
        }
        parts.extend(self.surroundings());
        for _ in 0..self.dice.weighted(&[(60, 0), (25, 1), (15, 2)]) {
            parts.extend(self.declaration());
        }
        if self.dice.chance(60) {
            // Not at a whole number, where rounding decides between the cells of many patterns.
            let height = self.dice.number(-1.6, -0.9) + 0.003;
            let mut plane = vec![needed(list![[0.0, 1.0, 0.0], ",", height])];
            plane.extend(self.look(1));
            parts.push(optional(block(Sort::Object, "plane", plane)));
        }
        for _ in 0..self.dice.weighted(&[(55, 1), (35, 2), (10, 3)]) {
            parts.push(optional(self.object(2)));
        }
        run(Sort::Scene, parts)
    }

    fn settings(&mut self) -> Node {
        let mut parts = vec![];
        let gamma = self
            .dice
            .weighted(&[(70, 1.0), (12, 2.2), (8, 1.8), (10, 0.0)]);
        self.gamma = gamma > 0.0;
        if self.gamma {
            parts.push(needed(words(format!("assumed_gamma {gamma}"))));
        }
        if self.dice.chance(15) {
            let level = self.dice.between(1, 9) as f64;
            parts.push(optional(list!["max_trace_level", level]));
        }
        if self.dice.chance(8) {
            let light = self.color();
            parts.push(optional(list!["ambient_light", light]));
        }
        if self.dice.chance(8) {
            let weight = self.dice.number(0.0, 0.3);
            parts.push(optional(list!["adc_bailout", weight]));
        }
        if self.dice.chance(10) {
            let kind = self.dice.between(1, 3) as f64;
            parts.push(optional(list!["noise_generator", kind]));
        }
        if self.dice.chance(5) {
            let count = self.dice.between(1, 10) as f64;
            parts.push(optional(list!["number_of_waves", count]));
        }
        block(Sort::Other, "global_settings", parts)
    }

    /// A `#declare` of an identifier that later parts may use.
    fn declaration(&mut self) -> Vec<Part> {
        let name = format!("D{}", self.declared.len());
        let sort = self.dice.pick(&[
            Sort::Object,
            Sort::Object,
            Sort::Texture,
            Sort::Pigment,
            Sort::Normal,
        ]);
        let value = match sort {
            Sort::Object => self.object(1),
            Sort::Texture => self.texture(2),
            Sort::Pigment => self.pigment(2),
            _ => self.normal(2),
        };
        let word = self.dice.pick(&["#declare", "#declare", "#local"]);
        let end = match (sort, self.dice.chance(70)) {
            (_, true) => ";",
            (_, false) => "",
        };
        let part = optional(list![format!("{word} {name} ="), value, end]);
        self.declared.push((sort, name));
        vec![part]
    }

    /// A declared identifier.
    fn known(&mut self, sort: Sort) -> Option<String> {
        let names: Vec<&String> = self
            .declared
            .iter()
            .filter(|(s, _)| *s == sort)
            .map(|(_, name)| name)
            .collect();
        match names.is_empty() {
            true => None,
            false => Some(names[self.dice.below(names.len())].clone()),
        }
    }

    fn point(&mut self, reach: f64) -> Node {
        Node::from([
            self.dice.number(-reach, reach),
            self.dice.number(-reach, reach),
            self.dice.number(-reach, reach),
        ])
    }

    /// A direction with no component near 0.
    fn direction(&mut self) -> Node {
        let mut component = || {
            let size = self.dice.number(0.2, 1.0);
            if self.dice.chance(50) { size } else { -size }
        };
        let axis = [component(), component(), component()];
        match self.dice.chance(60) {
            true => words(self.dice.pick(&["x", "y", "z"])),
            false => Node::from(axis),
        }
    }

    fn number(&mut self, low: f64, high: f64) -> Node {
        Node::Number(self.dice.number(low, high))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn scenes_depend_on_seed_and_number_only() {
        for number in 0..50 {
            assert_eq!(scene(3, number), scene(3, number));
        }
        let texts: HashSet<String> = (0..50)
            .flat_map(|n| [scene(3, n).text(), scene(4, n).text()])
            .collect();
        assert_eq!(texts.len(), 100);
    }

    #[test]
    fn scenes_have_all_objects() {
        let all: String = (0..3000).map(|n| scene(1, n).text()).collect();
        for word in [
            "blob",
            "box",
            "cone",
            "cubic",
            "cylinder",
            "difference",
            "disc",
            "height_field",
            "intersection",
            "isosurface",
            "lathe",
            "light_group",
            "merge",
            "mesh",
            "mesh2",
            "parametric",
            "bicubic_patch",
            "plane",
            "poly",
            "polygon",
            "prism",
            "quadric",
            "quartic",
            "smooth_triangle",
            "sor",
            "sphere",
            "sphere_sweep",
            "superellipsoid",
            "text",
            "torus",
            "triangle",
            "union",
        ] {
            assert!(all.contains(&format!("{word} {{")), "no {word}");
        }
    }

    #[test]
    fn braces_match() {
        for number in 0..500 {
            let text = scene(2, number).text();
            let count = |c| text.matches(c).count();
            assert_eq!(count('{'), count('}'), "{text}");
            assert_eq!(count('['), count(']'), "{text}");
            assert_eq!(count('('), count(')'), "{text}");
        }
    }
}
