use super::super::node::{Node, Part, Sort, block, list, needed, optional, words};
use super::Writer;

impl Writer {
    pub(super) fn box_corners(&mut self) -> Vec<Part> {
        let low = [
            self.dice.number(-1.2, -0.3),
            self.dice.number(-1.2, -0.3),
            self.dice.number(-1.2, -0.3),
        ];
        let mut high = [
            self.dice.number(0.3, 1.2),
            self.dice.number(0.3, 1.2),
            self.dice.number(0.3, 1.2),
        ];
        if self.dice.chance(8) {
            let axis = self.dice.below(3);
            high[axis] = low[axis];
        }
        let (low, high) = (Node::from(low), Node::from(high));
        vec![needed(match self.dice.chance(10) {
            true => list![high, ",", low],
            false => list![low, ",", high],
        })]
    }

    pub(super) fn blob(&mut self) -> Vec<Part> {
        let mut parts = vec![needed(list!["threshold", self.dice.number(0.2, 0.7)])];
        for _ in 0..self.dice.between(1, 4) {
            let strength = match self.dice.chance(85) {
                true => self.number(0.6, 1.8),
                false => self.number(-1.0, -0.2),
            };
            let (a, b) = (self.point(0.8), self.point(0.8));
            let radius = self.number(0.6, 1.4);
            let (head, shape) = match self.dice.chance(65) {
                true => ("sphere", list![a, ",", radius, ",", strength]),
                false => ("cylinder", list![a, ",", b, ",", radius, ",", strength]),
            };
            let mut component = vec![needed(shape)];
            if self.dice.chance(15) {
                component.extend(self.transforms());
            }
            if self.dice.chance(15) {
                component.push(optional(self.texture(1)));
            }
            parts.push(optional(block(Sort::Other, head, component)));
        }
        parts
    }

    pub(super) fn quadric(&mut self) -> Vec<Part> {
        let squares = Node::from([
            self.dice.number(-1.0, 3.0),
            self.dice.number(0.5, 3.0),
            self.dice.number(0.5, 3.0),
        ]);
        let (mixed, linear) = (self.point(0.8), self.point(0.6));
        let constant = self.number(-1.2, -0.4);
        vec![needed(list![
            squares, ",", mixed, ",", linear, ",", constant
        ])]
    }

    /// Cubics and quartics, as polynomials with few terms.
    pub(super) fn polynomial(&mut self) -> (&'static str, Vec<Part>) {
        let (head, degree) =
            self.dice
                .pick(&[("cubic", 3), ("quartic", 4), ("poly", 2), ("poly", 5)]);
        let terms = (degree + 1) * (degree + 2) * (degree + 3) / 6;
        let mut numbers = vec![0.0; terms];
        for _ in 0..self.dice.between(2, 5) {
            let at = self.dice.below(terms);
            numbers[at] = self.dice.number(-1.0, 1.0);
        }
        numbers[terms - 1] = self.dice.number(-1.0, -0.2);
        let mut parts = vec![];
        if head == "poly" {
            parts.push(needed(words(format!("{degree},"))));
        }
        parts.push(needed(Node::Vector(numbers)));
        if self.dice.chance(40) {
            parts.push(optional(words("sturm")));
        }
        let clip = self.number(1.0, 1.6);
        parts.push(optional(block(
            Sort::Other,
            "clipped_by",
            vec![needed(list!["sphere { 0,", clip, "}"])],
        )));
        (head, parts)
    }

    pub(super) fn letters(&mut self) -> Vec<Part> {
        let font = self
            .dice
            .pick(&["timrom.ttf", "cyrvetic.ttf", "crystal.ttf"]);
        let text = self.dice.pick(&["A", "Bo", "x8", "?%"]);
        let (thickness, offset) = (self.number(0.1, 1.0), self.number(0.0, 0.4));
        vec![
            needed(list![
                format!("ttf \"{font}\" \"{text}\""),
                thickness,
                ",",
                offset
            ]),
            optional(words("scale 1.5")),
        ]
    }

    pub(super) fn isosurface(&mut self) -> Vec<Part> {
        let (a, b) = (self.dice.number(0.3, 1.5), self.dice.number(0.1, 0.5));
        let f = match self.dice.below(6) {
            0 => list!["x*x + y*y*", a, "+ z*z - 0.8"],
            1 => list!["sqrt(x*x + y*y + z*z) - 0.8 +", b, "* sin(6*x) * sin(5*y)"],
            2 => list!["abs(x) + abs(y)*", a, "+ abs(z) - 1"],
            3 => list!["max(abs(x), abs(y)) - 0.7 + z*z*", b],
            4 => list!["y -", b, "* sin(4*x) * cos(3*z)"],
            _ => list!["x*x*x*x + y*y*y*y + z*z*z*z -", a],
        };
        let mut parts = vec![
            needed(list!["function {", f, "}"]),
            optional(list!["threshold", self.dice.number(-0.1, 0.2)]),
            needed(words("max_gradient 12")),
            // POV-Ray looks for the first surface only without this.
            needed(words("all_intersections")),
            optional(words("accuracy 0.0001")),
        ];
        let size = self.number(0.8, 1.3);
        parts.push(optional(match self.dice.chance(50) {
            true => list!["contained_by { sphere { 0,", size, "} }"],
            false => list!["contained_by { box { <-1, -1, -1>, <1.1, 1,", size, "> } }"],
        }));
        if self.dice.chance(20) {
            parts.push(optional(words("open")));
        }
        parts
    }

    pub(super) fn height_field(&mut self) -> Vec<Part> {
        let (w, h) = (self.dice.between(3, 12), self.dice.between(3, 12));
        let f = self.formula(1);
        let mut parts = vec![needed(list![
            format!("function {w}, {h} {{ abs(sin("),
            f,
            ")) * 0.9 }"
        ])];
        if self.dice.chance(40) {
            parts.push(optional(words("smooth")));
        }
        if self.dice.chance(25) {
            let level = self.number(0.0, 0.5);
            parts.push(optional(list!["water_level", level]));
        }
        parts.push(optional(words("translate -0.5 scale 2.2")));
        parts
    }
}
