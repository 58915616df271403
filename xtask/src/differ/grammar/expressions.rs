use super::super::node::{Node, Sort, list, needed, run, words};
use super::Writer;

impl Writer {
    /// A colour of any kind.
    pub(super) fn color(&mut self) -> Node {
        let prefix = self
            .dice
            .weighted(&[(70, ""), (15, "color "), (5, "colour ")]);
        let node = match self.dice.weighted(&[
            (50, 0),
            (12, 1),
            (10, 2),
            (8, 3),
            (6, 4),
            (6, 5),
            (8, 6),
            (4, 7),
        ]) {
            0 => list![format!("{prefix}rgb"), self.rgb()],
            1 => list![format!("{prefix}rgb"), self.dice.number(0.0, 1.0)],
            2 => {
                let [r, g, b] = self.rgb();
                let f = self.dice.number(0.0, 1.0);
                list![format!("{prefix}rgbf"), [r, g, b, f]]
            }
            3 => {
                let [r, g, b] = self.rgb();
                let t = self.dice.number(0.0, 1.0);
                list![format!("{prefix}rgbt"), [r, g, b, t]]
            }
            4 => {
                let [r, g, b] = self.rgb();
                let (f, t) = (self.dice.number(0.0, 0.5), self.dice.number(0.0, 0.5));
                list![format!("{prefix}rgbft"), [r, g, b, f, t]]
            }
            5 => {
                let (word, amount) = (
                    self.dice.pick(&["filter", "transmit"]),
                    self.dice.number(0.0, 1.0),
                );
                list![format!("{prefix}rgb"), self.rgb(), word, amount]
            }
            6 => {
                let parts: Vec<_> = (0..3).map(|_| self.expression(2)).collect();
                let mut nodes = vec![needed(words(format!("{prefix}rgb <")))];
                for (i, part) in parts.into_iter().enumerate() {
                    let comma = if i > 0 { ", abs(sin(" } else { "abs(sin(" };
                    nodes.push(needed(list![comma, part, "))"]));
                }
                nodes.push(needed(words(">")));
                run(Sort::Other, nodes)
            }
            _ if self.version == 3.7 && self.gamma => list![format!("{prefix}srgb"), self.rgb()],
            _ => list![
                "color red",
                self.dice.number(0.0, 1.0),
                "green",
                self.dice.number(0.0, 1.0)
            ],
        };
        run(Sort::Color, vec![needed(node)])
    }

    pub(super) fn opaque_color(&mut self) -> Node {
        let color = list!["rgb", self.rgb()];
        run(Sort::Color, vec![needed(color)])
    }

    fn rgb(&mut self) -> [f64; 3] {
        [
            self.dice.number(0.0, 1.0),
            self.dice.number(0.0, 1.0),
            self.dice.number(0.0, 1.0),
        ]
    }

    /// An expression of floats.
    pub(super) fn expression(&mut self, depth: usize) -> Node {
        if depth == 0 || self.dice.chance(20) {
            return list!["(", self.dice.number(-3.0, 3.0), ")"];
        }
        let depth = depth - 1;
        let a = self.expression(depth);
        match self.dice.below(22) {
            0 => {
                let f = self.dice.pick(&[
                    "sin", "cos", "atan", "abs", "floor", "ceil", "int", "tanh", "degrees",
                    "radians", "asinh",
                ]);
                list![format!("{f}("), a, ")"]
            }
            1 => list!["sqrt(abs(", a, "))"],
            2 => list!["pow(abs(", a, "),", self.dice.number(0.0, 2.0), ")"],
            3 => {
                let b = self.expression(depth);
                let f = self.dice.pick(&["min", "max", "atan2"]);
                list![format!("{f}("), a, ",", b, ")"]
            }
            4 => list!["mod(", a, ",", self.dice.number(0.1, 2.0), ")"],
            5 => list!["div(", a, ",", self.dice.number(0.1, 2.0), ")"],
            6 => {
                let b = self.expression(depth);
                let op = self.dice.pick(&["+", "-", "*"]);
                list!["(", a, op, b, ")"]
            }
            7 => list!["(", a, "/", self.dice.number(0.2, 2.0), ")"],
            8 => {
                let (b, c) = (self.expression(depth), self.expression(depth));
                list!["select(", a, ",", b, ",", c, ")"]
            }
            9 => {
                let b = self.expression(depth);
                let op = self.dice.pick(&["<", ">", "<=", ">=", "=", "!="]);
                list!["(", a, op, b, "? 0.3 : 0.8)"]
            }
            10 => {
                let v = self.vector(depth);
                list!["vlength(", v, ")"]
            }
            11 => {
                let (v, w) = (self.vector(depth), self.vector(depth));
                list!["vdot(", v, ",", w, ")"]
            }
            12 => {
                let v = self.vector(depth);
                let part = self.dice.pick(&["x", "y", "z", "u", "v"]);
                list!["(", v, format!(").{part}")]
            }
            13 => {
                let n = self.dice.between(0, 9);
                list![format!("strlen(str({}.5,{n},2)) +", n), a]
            }
            14 => list!["val(str(", a, ",0,3))"],
            15 => list![self.dice.pick(&["exp", "sinh"]), "(max(-2,min(", a, ",2)))"],
            16 => list!["ln(abs(", a, ")+0.1)"],
            17 => list!["asc(chr(65+int(abs(", a, "))))"],
            18 => {
                let b = self.expression(depth);
                let op = self.dice.pick(&["&", "|"]);
                list!["((", a, ">0)", op, "(", b, ">0))"]
            }
            19 => list!["!(", a, ")"],
            20 => list!["log(abs(", a, ")+0.1)"],
            _ => list!["acos(sin(", a, "))"],
        }
    }

    /// An expression of vectors.
    fn vector(&mut self, depth: usize) -> Node {
        if depth == 0 || self.dice.chance(30) {
            return self.point(2.0);
        }
        let depth = depth - 1;
        let v = self.vector(depth);
        match self.dice.below(8) {
            0 => {
                let w = self.vector(depth);
                list!["vcross(", v, ",", w, ")"]
            }
            1 => list!["vnormalize(", v, "+ 0.01)"],
            2 => list![
                "vrotate(",
                v,
                ", <",
                self.dice.number(-90.0, 90.0),
                ", 20, 0>)"
            ],
            3 => list![
                "vaxis_rotate(",
                v,
                ", <1, 2, 0.5>,",
                self.dice.number(-90.0, 90.0),
                ")"
            ],
            4 => list!["(", v, "*", self.dice.number(-2.0, 2.0), ")"],
            5 => {
                let w = self.vector(depth);
                list!["(", v, "+", w, ")"]
            }
            6 => {
                let a = self.expression(depth);
                list!["<", a, ", 0.3,", self.dice.number(-1.0, 1.0), ">"]
            }
            _ => list!["-", v],
        }
    }
}
