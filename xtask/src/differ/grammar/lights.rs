use super::super::node::{Node, Part, Sort, block, list, needed, optional, words};
use super::Writer;

impl Writer {
    fn light_place(&mut self) -> Node {
        Node::from([
            self.dice.number(-5.0, 5.0),
            self.dice.number(1.5, 6.0),
            self.dice.number(-7.0, -2.0),
        ])
    }

    pub(super) fn light(&mut self) -> Node {
        let (place, color) = (self.light_place(), self.light_color());
        let mut parts = vec![needed(list![place, ",", color])];
        let kind = self
            .dice
            .weighted(&[(75, ""), (15, "spotlight"), (8, "cylinder")]);
        if !kind.is_empty() {
            parts.push(optional(words(kind)));
            let target = self.point(0.6);
            parts.push(optional(list!["point_at", target]));
            let (radius, falloff) = match kind {
                "spotlight" => (self.number(5.0, 15.0), self.number(15.0, 40.0)),
                _ => (self.number(0.3, 1.0), self.number(1.0, 2.5)),
            };
            parts.push(optional(list!["radius", radius]));
            parts.push(optional(list!["falloff", falloff]));
            if self.dice.chance(50) {
                let tightness = self.number(0.0, 20.0);
                parts.push(optional(list!["tightness", tightness]));
            }
        }
        if self.dice.chance(7) {
            let target = self.point(0.6);
            parts.push(optional(list!["parallel point_at", target]));
        }
        if self.dice.chance(8) {
            parts.push(optional(words("shadowless")));
        }
        if self.dice.chance(12) {
            let distance = self.number(2.0, 9.0);
            parts.push(optional(list!["fade_distance", distance]));
            let power = self.dice.pick(&[1.0, 2.0, 1.5, 3.0]);
            parts.push(optional(list!["fade_power", power]));
        }
        if self.dice.chance(10) {
            let (a, b) = (self.number(0.5, 2.5), self.number(0.5, 2.5));
            let (m, n) = (self.dice.between(2, 5), self.dice.between(2, 5));
            let area = list!["area_light", a, "* x,", b, "* z,", m as f64, ",", n as f64];
            let mut area = vec![needed(area)];
            if self.dice.chance(25) {
                area.push(optional(words(self.dice.pick(&[
                    "circular",
                    "circular orient",
                    "area_illumination on",
                ]))));
            }
            parts.push(optional(super::run(Sort::Other, area)));
        }
        if self.dice.chance(4) {
            let looks = self.object(0);
            parts.push(optional(block(
                Sort::Other,
                "looks_like",
                vec![needed(looks)],
            )));
        }
        if self.dice.chance(4) {
            let transform = self.transform();
            parts.push(optional(transform));
        }
        block(Sort::Object, "light_source", parts)
    }

    fn light_color(&mut self) -> Node {
        match self.dice.below(4) {
            0 => words("rgb 1"),
            1 => list!["rgb", self.dice.number(0.3, 1.5)],
            _ => list![
                "rgb",
                [
                    self.dice.number(0.1, 1.4),
                    self.dice.number(0.1, 1.4),
                    self.dice.number(0.1, 1.4),
                ]
            ],
        }
    }

    /// A light group with its objects.
    pub(super) fn light_group(&mut self, depth: usize) -> Node {
        let mut parts = vec![optional(self.light())];
        for _ in 0..self.dice.between(1, 2) {
            parts.push(optional(self.object(depth.saturating_sub(1))));
        }
        if self.dice.chance(60) {
            let switch = self.dice.pick(&["on", "off"]);
            parts.push(optional(words(format!("global_lights {switch}"))));
        }
        if self.dice.chance(30) {
            parts.push(optional(self.transform()));
        }
        block(Sort::Object, "light_group", parts)
    }

    /// Background, sky, fog and rainbow.
    pub(super) fn surroundings(&mut self) -> Vec<Part> {
        let mut parts = vec![];
        if self.dice.chance(45) {
            let color = self.opaque_color();
            parts.push(optional(block(
                Sort::Other,
                "background",
                vec![needed(color)],
            )));
        }
        if self.dice.chance(15) {
            let mut sky = vec![optional(self.pigment(2))];
            if self.dice.chance(20) {
                sky.push(optional(self.pigment(1)));
            }
            if self.dice.chance(25) {
                sky.push(optional(self.transform()));
            }
            parts.push(optional(block(Sort::Other, "sky_sphere", sky)));
        }
        if self.dice.chance(8) {
            parts.push(optional(self.fog()));
        }
        if self.dice.chance(3) {
            parts.push(optional(self.rainbow()));
        }
        parts
    }

    fn fog(&mut self) -> Node {
        let (distance, color) = (self.number(2.0, 15.0), self.color());
        let mut parts = vec![needed(list!["distance", distance, color])];
        if self.dice.chance(45) {
            let (alt, offset) = (self.number(0.1, 2.0), self.number(-1.0, 1.0));
            parts.push(optional(list![
                "fog_type 2 fog_alt",
                alt,
                "fog_offset",
                offset
            ]));
            if self.dice.chance(25) {
                let up = self.direction();
                parts.push(optional(list!["up", up]));
            }
        }
        if self.dice.chance(35) {
            let (amount, depth) = (self.number(0.1, 1.0), self.number(0.0, 1.0));
            parts.push(optional(list!["turbulence", amount]));
            parts.push(optional(list!["turb_depth", depth]));
            parts.extend(self.octaves());
        }
        block(Sort::Other, "fog", parts)
    }

    fn rainbow(&mut self) -> Node {
        let direction = Node::from([
            self.dice.number(-0.3, 0.3),
            self.dice.number(-0.3, 0.3),
            1.0,
        ]);
        let (angle, width) = (self.number(5.0, 25.0), self.number(2.0, 12.0));
        let distance = self.number(1.0, 10.0);
        let mut parts = vec![needed(list![
            "direction",
            direction,
            "angle",
            angle,
            "width",
            width,
            "distance",
            distance
        ])];
        parts.push(needed(self.color_map()));
        if self.dice.chance(40) {
            let (arc, falloff) = (self.number(40.0, 180.0), self.number(10.0, 40.0));
            parts.push(optional(list!["arc_angle", arc]));
            parts.push(optional(list!["falloff_angle", falloff]));
        }
        if self.dice.chance(30) {
            let up = self.direction();
            parts.push(optional(list!["up", up]));
        }
        block(Sort::Other, "rainbow", parts)
    }
}
