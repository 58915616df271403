use super::super::node::{Node, Sort, block, list, needed, optional, words};
use super::Writer;

impl Writer {
    pub(super) fn finish(&mut self) -> Node {
        let mut parts = vec![];
        if self.dice.chance(40) {
            let ambient = match self.dice.chance(70) {
                true => list!["ambient", self.dice.number(0.0, 0.8)],
                false => list!["ambient", self.opaque_color()],
            };
            parts.push(optional(ambient));
        }
        if self.dice.chance(8) && self.version == 3.7 {
            let emission = self.opaque_color();
            parts.push(optional(list!["emission", emission]));
        }
        if self.dice.chance(40) {
            let diffuse = self.dice.number(0.0, 1.0);
            parts.push(optional(
                match self.version == 3.7 && self.dice.chance(20) {
                    true => list!["diffuse", diffuse, ",", self.dice.number(0.0, 0.6)],
                    false => list!["diffuse", diffuse],
                },
            ));
        }
        if self.dice.chance(10) {
            let brilliance = self.number(0.3, 4.0);
            parts.push(optional(list!["brilliance", brilliance]));
        }
        let albedo = match self.version == 3.7 && self.dice.chance(15) {
            true => "albedo",
            false => "",
        };
        if self.dice.chance(20) {
            let (amount, size) = (self.number(0.0, 1.0), self.number(3.0, 80.0));
            parts.push(optional(list!["phong", albedo, amount]));
            parts.push(optional(list!["phong_size", size]));
        }
        if self.dice.chance(20) {
            let (amount, roughness) = (self.number(0.0, 1.0), self.number(0.01, 0.3));
            parts.push(optional(list!["specular", albedo, amount]));
            parts.push(optional(list!["roughness", roughness]));
        }
        if self.dice.chance(15) {
            let metallic = match self.dice.chance(50) {
                true => words("metallic"),
                false => list!["metallic", self.dice.number(0.0, 1.0)],
            };
            parts.push(optional(metallic));
        }
        if self.dice.chance(25) {
            parts.push(optional(self.reflection()));
            if self.dice.chance(25) {
                parts.push(optional(words("conserve_energy")));
            }
        }
        block(Sort::Other, "finish", parts)
    }

    fn reflection(&mut self) -> Node {
        match self.dice.below(3) {
            0 => list!["reflection", self.dice.number(0.0, 0.9)],
            1 => {
                let color = self.opaque_color();
                let mut parts = vec![needed(list!["reflection", color])];
                if self.dice.chance(20) {
                    let exponent = self.number(0.5, 2.0);
                    parts.push(optional(list!["reflection_exponent", exponent]));
                }
                super::run(Sort::Other, parts)
            }
            _ => {
                let (a, b) = (self.opaque_color(), self.opaque_color());
                let mut parts = vec![match self.dice.chance(60) {
                    true => needed(list![a, ",", b]),
                    false => needed(a),
                }];
                if self.dice.chance(30) {
                    let falloff = self.number(0.5, 4.0);
                    parts.push(optional(list!["falloff", falloff]));
                }
                if self.dice.chance(20) {
                    let exponent = self.number(0.5, 2.0);
                    parts.push(optional(list!["exponent", exponent]));
                }
                if self.dice.chance(25) {
                    let metallic = self.number(0.0, 1.0);
                    parts.push(optional(list!["metallic", metallic]));
                }
                if self.dice.chance(15) {
                    parts.push(optional(words("fresnel on")));
                }
                block(Sort::Other, "reflection", parts)
            }
        }
    }

    pub(super) fn interior(&mut self) -> Node {
        let mut parts = vec![];
        if self.dice.chance(80) {
            let ior = self.number(1.0, 2.2);
            parts.push(optional(list!["ior", ior]));
        }
        if self.dice.chance(15) {
            let caustics = self.number(0.0, 2.0);
            parts.push(optional(list!["caustics", caustics]));
        }
        if self.dice.chance(30) {
            let (distance, power) = (
                self.number(0.3, 3.0),
                self.dice.pick(&[1.0, 2.0, 1.5, 1000.0]),
            );
            parts.push(optional(list!["fade_distance", distance]));
            parts.push(optional(list!["fade_power", power]));
            if self.dice.chance(50) {
                let color = self.opaque_color();
                parts.push(optional(list!["fade_color", color]));
            }
        }
        block(Sort::Other, "interior", parts)
    }
}
