use super::super::node::{Node, Part, Sort, block, list, needed, optional, run, words};
use super::Writer;

impl Writer {
    pub(super) fn pigment(&mut self, depth: usize) -> Node {
        let mut parts = self.may_map(6);
        parts.push(needed(self.pigment_body(depth)));
        block(Sort::Other, "pigment", parts)
    }

    /// `uv_mapping` with this chance in percent.
    pub(super) fn may_map(&mut self, percent: usize) -> Vec<Part> {
        match self.dice.chance(percent) {
            true => vec![optional(words("uv_mapping"))],
            false => vec![],
        }
    }

    /// The inside of the braces of a pigment.
    pub(super) fn pigment_body(&mut self, depth: usize) -> Node {
        if self.dice.chance(12)
            && let Some(name) = self.known(Sort::Pigment)
        {
            let mut parts = vec![needed(words(name))];
            if self.dice.chance(50) {
                parts.push(optional(self.transform()));
            }
            return run(Sort::Pigment, parts);
        }
        let kind = match depth {
            0 => self.dice.weighted(&[(60, 0), (40, 1)]),
            _ => self
                .dice
                .weighted(&[(30, 0), (35, 1), (12, 2), (12, 3), (5, 4), (3, 5), (3, 6)]),
        };
        let parts = match kind {
            0 => vec![needed(self.color())],
            1 => {
                let mut parts = vec![needed(self.pattern(depth))];
                if self.dice.chance(85) {
                    parts.push(optional(self.color_map()));
                }
                parts.extend(self.pattern_modifiers());
                parts
            }
            2 => {
                let mut parts = vec![needed(self.pattern(depth))];
                let entries = self.entries(|w| w.pigment_body(depth - 1));
                parts.push(optional(block(Sort::Other, "pigment_map", entries)));
                parts.extend(self.pattern_modifiers());
                parts
            }
            3 => {
                let mut parts = self.choice("pigment", |w| w.color(), |w| w.pigment(depth - 1));
                parts.extend(self.pattern_modifiers());
                parts
            }
            4 => {
                let image = self.function_image(true);
                let mut parts = vec![needed(block(Sort::Other, "image_map", image))];
                parts.extend(self.pattern_modifiers());
                parts
            }
            5 => {
                let entries = self.entries(|w| w.pigment_body(depth - 1));
                let mut parts = vec![needed(words("average"))];
                parts.push(needed(block(Sort::Other, "pigment_map", entries)));
                parts.extend(self.pattern_modifiers());
                parts
            }
            _ => {
                let (solid, a, b) = (self.cutter(), self.color(), self.color());
                let object = block(Sort::Other, "object", vec![needed(list![solid, a, ",", b])]);
                let mut parts = vec![needed(object)];
                parts.extend(self.transforms());
                parts
            }
        };
        run(Sort::Pigment, parts)
    }

    /// A pattern of areas (checker, hexagon and so on) with a list of colours or of other things.
    pub(super) fn choice(
        &mut self,
        word: &str,
        color: impl Fn(&mut Self) -> Node,
        thing: impl Fn(&mut Self) -> Node,
    ) -> Vec<Part> {
        let (name, count) = self.dice.pick(&[
            ("checker", 2),
            ("checker", 2),
            ("hexagon", 3),
            ("brick", 2),
            ("square", 4),
            ("triangular", 6),
            ("cubic", 6),
        ]);
        let mut parts = vec![needed(words(name))];
        let things = word != "pigment" || self.dice.chance(30);
        for index in 0..count {
            let comma = if index > 0 { "," } else { "" };
            let node = match things {
                true => thing(self),
                false => color(self),
            };
            parts.push(optional(list![comma, node]));
        }
        if name == "brick" && self.dice.chance(60) {
            let size = Node::from([
                self.dice.number(0.3, 1.5),
                self.dice.number(0.2, 0.8),
                self.dice.number(0.3, 1.5),
            ]);
            parts.push(optional(list!["brick_size", size]));
            let mortar = self.number(0.02, 0.2);
            parts.push(optional(list!["mortar", mortar]));
        }
        parts
    }

    pub(super) fn color_map(&mut self) -> Node {
        let head = self.dice.weighted(&[(70, "color_map"), (10, "colour_map")]);
        if self.dice.chance(8) {
            // The old spelling: two positions and two colours.
            let middle = self.dice.number(0.1, 0.9);
            let mut color = || {
                let color = self.opaque_color();
                list!["color", color]
            };
            let (a, b, c, d) = (color(), color(), color(), color());
            let parts = vec![
                optional(list!["[0,", middle, a, b, "]"]),
                optional(list!["[", middle, ", 1", c, d, "]"]),
            ];
            return block(Sort::Other, head, parts);
        }
        let entries = self.entries(|w| w.color());
        block(Sort::Other, head, entries)
    }

    /// Entries of a map, in rising order.
    pub(super) fn entries(&mut self, mut value: impl FnMut(&mut Self) -> Node) -> Vec<Part> {
        let count = self.dice.weighted(&[(50, 2), (30, 3), (15, 4), (5, 1)]);
        let mut places: Vec<f64> = (0..count).map(|_| self.dice.number(0.0, 1.0)).collect();
        places.sort_by(f64::total_cmp);
        places
            .into_iter()
            .map(|place| optional(list!["[", place, value(self), "]"]))
            .collect()
    }
}
