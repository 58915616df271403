use super::super::node::{Node, Sort, block, list, needed, optional, words};
use super::Writer;

impl Writer {
    pub(super) fn camera(&mut self) -> Node {
        let place = Node::from([
            self.dice.number(-1.5, 1.5),
            self.dice.number(-0.5, 2.5),
            self.dice.number(-5.5, -4.0),
        ]);
        let kind = self.dice.weighted(&[
            (80, ""),
            (6, "orthographic"),
            (3, "fisheye"),
            (2, "ultra_wide_angle"),
            (2, "panoramic"),
            (2, "spherical"),
            (2, "omnimax"),
            (3, "cylinder"),
        ]);
        let mut parts = vec![];
        match kind {
            "" => {}
            "cylinder" => {
                let number = self.dice.between(1, 4);
                parts.push(optional(words(format!("cylinder {number}"))));
            }
            kind => parts.push(optional(words(kind))),
        }
        parts.push(needed(list!["location", place]));
        if self.dice.chance(8) {
            let (a, b) = (self.number(0.8, 1.6), self.number(0.6, 1.4));
            parts.push(optional(list!["right", a, "* x"]));
            parts.push(optional(list!["up", b, "* y"]));
        } else if self.dice.chance(6) {
            parts.push(optional(words("right -4/3*x")));
        }
        if self.dice.chance(6) {
            let length = self.number(0.7, 1.6);
            parts.push(optional(list!["direction", length, "* z"]));
        }
        if self.dice.chance(6) {
            let sky = self.direction();
            parts.push(optional(list!["sky", sky]));
        }
        let angle = match kind {
            "" | "orthographic" => self.dice.chance(12).then(|| self.number(30.0, 100.0)),
            "ultra_wide_angle" | "panoramic" => Some(self.number(60.0, 150.0)),
            _ => Some(self.number(100.0, 220.0)),
        };
        let angle = angle.map(|a| list!["angle", a]);
        let late = self.dice.chance(20);
        if let (Some(angle), false) = (&angle, late) {
            parts.push(optional(angle.clone()));
        }
        let target = self.point(0.5);
        parts.push(needed(list!["look_at", target]));
        if let (Some(angle), true) = (angle, late) {
            parts.push(optional(angle));
        }
        if self.dice.chance(4) {
            let transform = self.transform();
            parts.push(optional(transform));
        }
        if self.dice.chance(3) {
            let normal = self.normal(1);
            parts.push(optional(normal));
        }
        block(Sort::Other, "camera", parts)
    }
}
