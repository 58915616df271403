use super::super::node::{Node, Part, Sort, block, list, needed, optional, words};
use super::Writer;

impl Writer {
    /// One transform of any kind.
    pub(super) fn transform(&mut self) -> Node {
        match self.dice.below(9) {
            0 | 1 => list!["rotate", self.point(90.0)],
            2 => list!["rotate", self.dice.number(-90.0, 90.0), "* y"],
            3 => list!["translate", self.point(0.8)],
            4 => list!["scale", self.dice.number(0.5, 1.5)],
            5 => list![
                "scale",
                [
                    self.dice.number(0.4, 1.6),
                    self.dice.number(0.4, 1.6),
                    self.dice.number(0.4, 1.6),
                ]
            ],
            6 => words(self.dice.pick(&[
                "scale <-1, 1, 1>",
                "scale <1, -1, 1>",
                "scale <1, 1.25, -1>",
                "scale -1",
            ])),
            7 => {
                let inner = self.dice.pick(&["", "inverse"]);
                let transform = self.transform();
                block(
                    Sort::Other,
                    "transform",
                    vec![needed(transform), optional(words(inner))],
                )
            }
            _ => {
                let shear = self.dice.number(-0.5, 0.5);
                list![
                    "matrix <1, 0, 0,",
                    shear,
                    ", 1, 0, 0, 0,",
                    self.dice.number(0.6, 1.4),
                    ", 0, 0.1, 0>"
                ]
            }
        }
    }

    /// Transforms of an object: none in most cases.
    pub(super) fn transforms(&mut self) -> Vec<Part> {
        let count = self.dice.weighted(&[(50, 0), (30, 1), (20, 2)]);
        (0..count).map(|_| optional(self.transform())).collect()
    }

    /// The look of an object: texture statements, interior, transforms and flags in any order.
    pub(super) fn look(&mut self, depth: usize) -> Vec<Part> {
        let mut parts = vec![];
        match self
            .dice
            .weighted(&[(8, 0), (35, 1), (40, 2), (7, 3), (10, 4)])
        {
            0 => {}
            1 => {
                parts.push(optional(self.pigment(depth)));
                if self.dice.chance(25) {
                    parts.push(optional(self.normal(depth)));
                }
                if self.dice.chance(40) {
                    parts.push(optional(self.finish()));
                }
                if self.dice.chance(25) {
                    parts.push(optional(self.interior()));
                }
            }
            2 => {
                parts.push(optional(self.texture(depth)));
                if self.dice.chance(15) {
                    parts.push(optional(self.interior()));
                }
            }
            3 => {
                let mut material = vec![optional(self.texture(depth))];
                if self.dice.chance(60) {
                    material.push(optional(self.interior()));
                }
                if self.dice.chance(20) {
                    material.push(optional(self.transform()));
                }
                parts.push(optional(block(Sort::Other, "material", material)));
            }
            _ => {
                parts.push(optional(self.layers(depth)));
            }
        }
        parts
    }

    /// A look, transforms around it, flags.
    pub(super) fn modifiers(&mut self, depth: usize) -> Vec<Part> {
        let mut parts = match self.dice.chance(25) {
            true => self.transforms(),
            false => vec![],
        };
        parts.extend(self.look(depth));
        parts.extend(self.transforms());
        let textured = parts
            .iter()
            .any(|p| matches!(&p.node, Node::Group { head: Some(h), .. } if h == "texture"));
        if textured && self.dice.chance(4) {
            let texture = self.texture(1);
            parts.push(optional(list!["interior_texture", inner(texture)]));
        }
        if self.dice.chance(12) {
            parts.push(optional(words(self.dice.pick(&[
                "no_shadow",
                "hollow",
                "inverse",
                "no_image",
                "no_reflection",
                "double_illuminate",
            ]))));
        }
        if self.dice.chance(5) {
            let cut = self.cutter();
            parts.push(optional(block(
                Sort::Other,
                "clipped_by",
                vec![needed(cut)],
            )));
            if self.dice.chance(40) {
                parts.push(optional(words("bounded_by { clipped_by }")));
            }
        }
        parts
    }

    /// A solid that cuts away some of the space around the origin.
    pub(super) fn cutter(&mut self) -> Node {
        match self.dice.below(3) {
            0 => {
                let (normal, distance) = (self.direction(), self.number(-0.5, 0.6));
                let mut parts = vec![needed(list![normal, ",", distance])];
                if self.dice.chance(20) {
                    parts.push(optional(words("inverse")));
                }
                block(Sort::Object, "plane", parts)
            }
            1 => {
                let (center, radius) = (self.point(0.7), self.number(0.4, 1.1));
                block(
                    Sort::Object,
                    "sphere",
                    vec![needed(list![center, ",", radius])],
                )
            }
            _ => {
                let (a, b) = (self.number(-1.2, -0.1), self.number(0.1, 1.2));
                let mut parts = vec![needed(list![a, ",", b])];
                parts.extend(self.transforms());
                block(Sort::Object, "box", parts)
            }
        }
    }

    /// Parameters of turbulence.
    pub(super) fn octaves(&mut self) -> Vec<Part> {
        let mut parts = vec![];
        if self.dice.chance(40) {
            let count = self.dice.between(1, 8) as f64;
            parts.push(optional(list!["octaves", count]));
        }
        if self.dice.chance(30) {
            let lambda = self.number(1.2, 3.0);
            parts.push(optional(list!["lambda", lambda]));
        }
        if self.dice.chance(30) {
            let omega = self.number(0.1, 0.9);
            parts.push(optional(list!["omega", omega]));
        }
        parts
    }

    /// The modifiers of a pattern: turbulence, waves, warps and transforms.
    pub(super) fn pattern_modifiers(&mut self) -> Vec<Part> {
        let mut parts = vec![];
        if self.dice.chance(18) {
            let amount = match self.dice.chance(60) {
                true => self.number(0.1, 1.0),
                false => self.point(0.8),
            };
            parts.push(optional(list!["turbulence", amount]));
            parts.extend(self.octaves());
        }
        if self.dice.chance(12) {
            let frequency = self.number(-3.0, 4.0);
            parts.push(optional(list!["frequency", frequency]));
        }
        if self.dice.chance(12) {
            let phase = self.number(-1.0, 1.5);
            parts.push(optional(list!["phase", phase]));
        }
        if self.dice.chance(15) {
            parts.push(optional(words(self.dice.pick(&[
                "ramp_wave",
                "sine_wave",
                "triangle_wave",
                "scallop_wave",
                "cubic_wave",
                "poly_wave",
                "poly_wave 0.5",
                "poly_wave 3",
            ]))));
        }
        if self.dice.chance(5) {
            let kind = self.dice.between(1, 3) as f64;
            parts.push(optional(list!["noise_generator", kind]));
        }
        for _ in 0..self.dice.weighted(&[(45, 0), (40, 1), (15, 2)]) {
            let part = match self.dice.chance(18) {
                true => self.warp(),
                false => self.transform(),
            };
            parts.push(optional(part));
        }
        parts
    }

    fn warp(&mut self) -> Node {
        let parts = match self.dice.below(5) {
            0 => {
                let (center, radius) = (self.point(0.6), self.number(0.3, 1.2));
                let mut hole = vec![needed(list!["black_hole", center, ",", radius])];
                if self.dice.chance(50) {
                    let (falloff, strength) = (self.number(0.5, 4.0), self.number(0.2, 3.0));
                    hole.push(optional(list!["falloff", falloff]));
                    hole.push(optional(list!["strength", strength]));
                }
                if self.dice.chance(20) {
                    hole.push(optional(words("inverse")));
                }
                if self.dice.chance(30) {
                    let repeat = self.number(0.8, 2.0);
                    hole.push(optional(list!["repeat", repeat]));
                }
                hole
            }
            1 => {
                let amount = self.number(0.1, 1.0);
                let mut warp = vec![needed(list!["turbulence", amount])];
                warp.extend(self.octaves());
                warp
            }
            2 => {
                let axis = self.dice.pick(&["x", "y", "z"]);
                let width = self.number(0.4, 1.5);
                let mut repeat = vec![needed(list!["repeat", width, format!("* {axis}")])];
                if self.dice.chance(40) {
                    let offset = self.point(0.5);
                    repeat.push(optional(list!["offset", offset]));
                }
                if self.dice.chance(40) {
                    let other = self.dice.pick(&["x", "y", "z", "x + y", "y + z"]);
                    repeat.push(optional(words(format!("flip {other}"))));
                }
                repeat
            }
            3 => {
                let kind = self
                    .dice
                    .pick(&["spherical", "cylindrical", "planar", "toroidal"]);
                let mut map = vec![needed(words(kind))];
                if kind != "planar" && self.dice.chance(50) {
                    let axis = self.dice.pick(&["x", "y", "z"]);
                    map.push(optional(words(format!("orientation {axis}"))));
                }
                if kind != "planar" && self.dice.chance(30) {
                    let amount = self.number(0.1, 1.0);
                    map.push(optional(list!["dist_exp", amount]));
                }
                if kind == "toroidal" && self.dice.chance(50) {
                    let radius = self.number(0.3, 1.0);
                    map.push(optional(list!["major_radius", radius]));
                }
                map
            }
            _ => {
                let amount = self.point(0.8);
                vec![needed(list!["turbulence", amount])]
            }
        };
        block(Sort::Other, "warp", parts)
    }
}

/// The braces and parts of a block without its keyword.
fn inner(node: Node) -> Node {
    match node {
        Node::Group { parts, .. } => block(Sort::Other, "", parts),
        other => other,
    }
}
