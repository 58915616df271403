use super::super::node::{Node, Part, Sort, block, list, needed, optional, run, words};
use super::Writer;

impl Writer {
    /// A pattern with values from 0 to 1 that takes a map.
    pub(super) fn pattern(&mut self, depth: usize) -> Node {
        match self.dice.below(34) {
            0 => words("agate"),
            1 => list!["agate agate_turb", self.dice.number(0.1, 1.5)],
            2 => words("bozo"),
            3 => words("bumps"),
            4 => words("boxed"),
            5 => words("cells"),
            6 => self.crackle(),
            7 => words("cylindrical"),
            8 => words("dents"),
            9 => words("granite"),
            10 => words("leopard"),
            11 => words("marble"),
            12 => words("onion"),
            13 => words("planar"),
            14 => words("radial"),
            15 => words("ripples"),
            16 => words("spherical"),
            17 => words("spotted"),
            18 => words("waves"),
            19 => words("wood"),
            20 => words("wrinkles"),
            21 => list!["gradient", self.direction()],
            22 => words(
                self.dice
                    .pick(&["spiral1 3", "spiral2 2", "spiral1 1.7", "spiral2 5"]),
            ),
            23 => list![
                "quilted control0",
                self.dice.number(0.0, 1.0),
                "control1",
                self.dice.number(0.0, 1.0)
            ],
            24 => self.fractal(),
            25 => self.slope(),
            26 if depth > 0 => {
                let pigment = self.pigment_body(depth - 1);
                block(Sort::Other, "pigment_pattern", vec![needed(pigment)])
            }
            27 | 28 => self.function_pattern(),
            29 => {
                let image = self.function_image(false);
                block(Sort::Other, "image_pattern", image)
            }
            30 => words("aoi"),
            31 => words("waves"),
            32 => words("gradient y"),
            _ => words("bozo"),
        }
    }

    fn crackle(&mut self) -> Node {
        let mut parts = vec![needed(words("crackle"))];
        if self.dice.chance(30) {
            let form = self.point(1.0);
            parts.push(optional(list!["form", form]));
        }
        if self.dice.chance(20) {
            let metric = self.dice.pick(&[1.0, 2.0, 3.0, 1.5]);
            parts.push(optional(list!["metric", metric]));
        }
        if self.dice.chance(20) {
            let offset = self.number(0.0, 1.0);
            parts.push(optional(list!["offset", offset]));
        }
        if self.dice.chance(15) {
            parts.push(optional(words("solid")));
        }
        run(Sort::Other, parts)
    }

    fn fractal(&mut self) -> Node {
        let kind = self.dice.pick(&[
            "mandel 12",
            "julia <0.353, 0.288>, 12",
            "magnet 1 mandel 9",
            "magnet 2 mandel 9",
            "magnet 1 julia <0.2, 0.4>, 9",
            "magnet 2 julia <-0.3, 0.1>, 9",
        ]);
        let mut parts = vec![needed(words(kind))];
        if self.dice.chance(30) && !kind.starts_with("magnet") {
            let exponent = self.dice.between(2, 5) as f64;
            parts.push(optional(list!["exponent", exponent]));
        }
        if self.dice.chance(30) {
            let (kind, factor) = (self.dice.below(6) as f64, self.number(0.2, 2.0));
            parts.push(optional(list!["interior", kind, ",", factor]));
        }
        if self.dice.chance(30) {
            let (kind, factor) = (self.dice.below(7) as f64, self.number(0.2, 2.0));
            parts.push(optional(list!["exterior", kind, ",", factor]));
        }
        run(Sort::Other, parts)
    }

    fn slope(&mut self) -> Node {
        let direction = self.direction();
        match self.dice.below(4) {
            0 => list!["slope {", direction, ", 0.1, 0.8 }"],
            1 => {
                let up = self.direction();
                list!["slope {", direction, "altitude", up, ", -1, 1 }"]
            }
            _ => list!["slope", direction],
        }
    }

    fn function_pattern(&mut self) -> Node {
        let f = self.formula(2);
        list!["function {", f, "}"]
    }

    /// A formula of x, y and z.
    pub(super) fn formula(&mut self, depth: usize) -> Node {
        if depth == 0 {
            return match self.dice.chance(70) {
                true => words(self.dice.pick(&["x", "y", "z", "(x+y)", "(x*z)"])),
                false => list!["(", self.dice.number(-2.0, 2.0), ")"],
            };
        }
        let depth = depth - 1;
        let (a, b) = (self.formula(depth), self.formula(depth));
        match self.dice.below(14) {
            0 => list!["sin(", a, "*3)"],
            1 => list!["abs(", a, ")"],
            2 => list!["(", a, "+", b, ")"],
            3 => list!["(", a, "*", b, ")"],
            4 => list!["(", a, "-", b, ")"],
            5 => list!["min(", a, ",", b, ")"],
            6 => list!["max(", a, ",", b, ")"],
            7 => list!["sqrt(abs(", a, "))"],
            8 => list!["mod(", a, ",", self.dice.number(0.2, 1.5), ")"],
            9 => list!["floor(", a, "*3)/3"],
            10 => list!["select(", a, ",", b, ", 0.7)"],
            11 => list!["atan2(", a, ",", b, ")"],
            12 => list!["exp(-abs(", a, "))"],
            _ => list!["pow(abs(", a, "), 2)"],
        }
    }

    /// A function image with its modifiers.
    pub(super) fn function_image(&mut self, colors: bool) -> Vec<Part> {
        let (w, h) = (self.dice.between(2, 9), self.dice.between(2, 9));
        let f = match colors {
            true => {
                let body = self.pigment_body(0);
                block(Sort::Other, "pigment", vec![needed(body)])
            }
            false => self.formula(1),
        };
        let head = format!("function {w}, {h} {{");
        let mut parts = vec![needed(list![head, f, "}"])];
        if self.dice.chance(40) {
            let kind = self.dice.pick(&["0", "1", "2", "5"]);
            parts.push(optional(words(format!("map_type {kind}"))));
        }
        if self.dice.chance(40) {
            let kind = self.dice.pick(&["2", "3", "4"]);
            parts.push(optional(words(format!("interpolate {kind}"))));
        }
        if self.dice.chance(25) {
            parts.push(optional(words("once")));
        }
        parts
    }
}
