use super::super::node::{Node, Part, Sort, block, list, needed, optional, run, words};
use super::Writer;

impl Writer {
    pub(super) fn texture(&mut self, depth: usize) -> Node {
        let parts = self.texture_parts(depth);
        block(Sort::Texture, "texture", parts)
    }

    fn texture_parts(&mut self, depth: usize) -> Vec<Part> {
        if self.dice.chance(15)
            && let Some(name) = self.known(Sort::Texture)
        {
            let mut parts = vec![needed(words(name))];
            match self.dice.below(4) {
                0 => parts.push(optional(self.finish())),
                1 => parts.push(optional(self.pigment(1))),
                2 => parts.push(optional(self.transform())),
                _ => {}
            }
            return parts;
        }
        let kind = match depth {
            0 => 0,
            _ => self
                .dice
                .weighted(&[(75, 0), (10, 1), (8, 2), (3, 3), (4, 4)]),
        };
        match kind {
            0 => {
                let mut parts = self.may_map(4);
                parts.push(optional(self.pigment(depth)));
                if self.dice.chance(30) {
                    parts.push(optional(self.normal(depth)));
                }
                if self.dice.chance(60) {
                    parts.push(optional(self.finish()));
                }
                if self.dice.chance(25) {
                    parts.push(optional(self.transform()));
                }
                parts
            }
            1 => {
                let mut parts = vec![needed(self.pattern(depth))];
                let entries = self.entries(|w| {
                    let parts = w.texture_parts(depth - 1);
                    run(Sort::Other, parts)
                });
                parts.push(needed(block(Sort::Other, "texture_map", entries)));
                parts.extend(self.pattern_modifiers());
                parts
            }
            2 => {
                let thing = |w: &mut Self| w.texture(depth - 1);
                let mut parts = self.choice("texture", thing, thing);
                parts.extend(self.pattern_modifiers());
                parts
            }
            3 => {
                let entries = self.entries(|w| {
                    let parts = w.texture_parts(depth - 1);
                    run(Sort::Other, parts)
                });
                let mut parts = vec![needed(words("average"))];
                parts.push(needed(block(Sort::Other, "texture_map", entries)));
                parts.extend(self.pattern_modifiers());
                parts
            }
            _ => {
                let (solid, a, b) = (
                    self.cutter(),
                    self.texture(depth - 1),
                    self.texture(depth - 1),
                );
                let object = block(Sort::Other, "object", vec![needed(list![solid, a, ",", b])]);
                let mut parts = vec![needed(object)];
                parts.extend(self.transforms());
                parts
            }
        }
    }

    /// Layered textures.
    pub(super) fn layers(&mut self, depth: usize) -> Node {
        let count = self.dice.between(2, 3);
        let layers = (0..count)
            .map(|_| {
                let parts = vec![optional(self.pigment(depth)), optional(self.finish())];
                optional(block(Sort::Texture, "texture", parts))
            })
            .collect();
        run(Sort::Other, layers)
    }

    pub(super) fn normal(&mut self, depth: usize) -> Node {
        let body = self.normal_body(depth);
        block(Sort::Other, "normal", vec![needed(body)])
    }

    /// A number behind a pattern of a single word. After a list of items it would not be valid.
    fn amount(&mut self, parts: &mut Vec<Part>) {
        let size = self.number(0.05, 1.5);
        if let Some(Part {
            node: Node::Words(text),
            ..
        }) = parts.last()
            && !text.contains(' ')
        {
            parts.push(optional(size));
        }
    }

    fn normal_body(&mut self, depth: usize) -> Node {
        if self.dice.chance(10)
            && let Some(name) = self.known(Sort::Normal)
        {
            let mut parts = vec![needed(words(name))];
            if self.dice.chance(50) {
                parts.push(optional(self.transform()));
            }
            return run(Sort::Normal, parts);
        }
        let mut parts =
            match self
                .dice
                .weighted(&[(55, 0), (15, 1), (10, 2), (8, 3), (6, 4), (6, 5)])
            {
                1 => {
                    let pattern = self.pattern(depth);
                    let mut parts = vec![needed(pattern)];
                    self.amount(&mut parts);
                    let entries = self.entries(|w| {
                        let (height, slope) = (w.dice.number(0.0, 1.0), w.dice.number(-1.0, 1.0));
                        list![[height, slope]]
                    });
                    parts.push(optional(block(Sort::Other, "slope_map", entries)));
                    parts
                }
                2 if depth > 0 => {
                    let mut parts = vec![needed(self.pattern(depth))];
                    let entries = self.entries(|w| w.normal_body(depth - 1));
                    parts.push(needed(block(Sort::Other, "normal_map", entries)));
                    parts
                }
                3 if depth > 0 => {
                    let entries = self.entries(|w| w.normal_body(depth - 1));
                    let mut parts = vec![needed(words("average"))];
                    parts.push(needed(block(Sort::Other, "normal_map", entries)));
                    parts
                }
                4 => {
                    let image = self.function_image(false);
                    let mut parts = vec![needed(block(Sort::Other, "bump_map", image))];
                    let size = self.number(0.5, 3.0);
                    parts.push(optional(list!["bump_size", size]));
                    parts
                }
                5 if depth > 0 => {
                    let thing = |w: &mut Self| {
                        let body = w.normal_body(depth - 1);
                        block(Sort::Other, "normal", vec![needed(body)])
                    };
                    self.choice("normal", thing, thing)
                }
                _ => {
                    let pattern = match self.dice.chance(50) {
                        true => words(self.dice.pick(&[
                            "bumps", "dents", "ripples", "waves", "wrinkles", "quilted", "bumps",
                        ])),
                        false => self.pattern(depth),
                    };
                    let mut parts = vec![needed(pattern)];
                    self.amount(&mut parts);
                    if self.dice.chance(15) {
                        let size = self.number(0.1, 2.0);
                        parts.push(optional(list!["bump_size", size]));
                    }
                    if self.dice.chance(10) {
                        let accuracy = self.number(0.01, 0.1);
                        parts.push(optional(list!["accuracy", accuracy]));
                    }
                    parts
                }
            };
        parts.extend(self.pattern_modifiers());
        if self.dice.chance(6) {
            parts.push(optional(words("no_bump_scale")));
        }
        run(Sort::Normal, parts)
    }
}
