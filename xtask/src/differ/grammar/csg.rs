use super::super::node::{Node, Part, Sort, block, list, needed, optional, words};
use super::Writer;

/// An operand without flags that hide it from some rays: strahl hides whole operations only.
fn without_visibility(operand: Node) -> Node {
    let Node::Group {
        sort,
        head,
        mut parts,
    } = operand
    else {
        return operand;
    };
    parts.retain(|part| {
        !matches!(
            part.node.text().trim(),
            "no_shadow" | "no_image" | "no_reflection"
        )
    });
    Node::Group { sort, head, parts }
}

impl Writer {
    /// An object with its texture and modifiers; `depth` limits the nesting of CSG.
    pub(super) fn object(&mut self, depth: usize) -> Node {
        if self.dice.chance(25)
            && let Some(name) = self.known(Sort::Object)
        {
            // Moved, since two at the same place leave it to rounding which is seen.
            let place = self.point(0.7);
            let mut parts = vec![needed(words(name)), needed(list!["translate", place])];
            if self.dice.chance(60) {
                parts.extend(self.transforms());
            }
            if self.dice.chance(25) {
                parts.extend(self.look(1));
            }
            return block(Sort::Object, "object", parts);
        }
        if depth > 0 && self.dice.chance(28) {
            return self.combined(depth);
        }
        if depth > 0 && self.dice.chance(2) {
            return self.light_group(depth);
        }
        let (head, mut parts) = match self.dice.chance(68) {
            true => self.solid(),
            false => self.patch(),
        };
        parts.extend(self.modifiers(2));
        block(Sort::Object, head, parts)
    }

    fn combined(&mut self, depth: usize) -> Node {
        let head = self
            .dice
            .pick(&["union", "intersection", "difference", "merge"]);
        let mut parts: Vec<Part> = vec![];
        let count = self.dice.weighted(&[(70, 2), (30, 3)]);
        for index in 0..count {
            let object = match (head, index) {
                ("union", _) => self.object(depth - 1),
                ("difference", 1..) if self.dice.chance(60) => self.cutter(),
                _ => self.part(depth - 1),
            };
            parts.push(optional(match head {
                "union" => object,
                _ => without_visibility(object),
            }));
        }
        if self.dice.chance(70) {
            parts.extend(self.modifiers(2));
        }
        if head == "union" && self.dice.chance(10) {
            let switch = self.dice.pick(&["on", "off"]);
            parts.push(optional(words(format!("split_union {switch}"))));
        }
        block(Sort::Object, head, parts)
    }

    /// A solid as a part of a CSG object, with or without a texture of its own.
    fn part(&mut self, depth: usize) -> Node {
        if depth > 0 && self.dice.chance(20) {
            return self.combined(depth);
        }
        let (head, mut parts) = self.solid();
        match self.dice.below(3) {
            0 => parts.extend(self.modifiers(1)),
            1 => {
                parts.extend(self.look(1));
                parts.extend(self.transforms());
            }
            _ => parts.extend(self.transforms()),
        }
        block(Sort::Object, head, parts)
    }

    /// A closed surface: its keyword and its parameters.
    fn solid(&mut self) -> (&'static str, Vec<Part>) {
        match self.dice.below(24) {
            0..=3 => {
                let (center, radius) = (self.point(0.5), self.number(0.6, 1.4));
                ("sphere", vec![needed(list![center, ",", radius])])
            }
            4..=6 => ("box", self.box_corners()),
            7 | 8 => {
                let (a, b, r) = (self.point(0.9), self.point(0.9), self.number(0.2, 0.8));
                let mut parts = vec![needed(list![a, ",", b, ",", r])];
                self.may_open(&mut parts);
                ("cylinder", parts)
            }
            9 | 10 => {
                let (a, b) = (self.point(0.9), self.point(0.9));
                let (r, s) = (self.number(0.3, 1.0), self.number(0.0, 0.6));
                let mut parts = vec![needed(list![a, ",", r, ",", b, ",", s])];
                self.may_open(&mut parts);
                ("cone", parts)
            }
            11 | 12 => {
                let (major, minor) = (self.number(0.5, 1.1), self.number(0.15, 0.6));
                let mut parts = vec![needed(list![major, ",", minor])];
                if self.dice.chance(30) {
                    parts.push(optional(words("sturm")));
                }
                ("torus", parts)
            }
            13 => ("blob", self.blob()),
            14 => {
                let (e, n) = (self.dice.number(0.2, 1.8), self.dice.number(0.2, 1.8));
                ("superellipsoid", vec![needed(list![[e, n]])])
            }
            15 => ("quadric", self.quadric()),
            16 => self.polynomial(),
            17 => ("prism", self.prism()),
            18 => ("lathe", self.lathe()),
            19 => ("sor", self.sor()),
            20 => ("sphere_sweep", self.sphere_sweep()),
            21 => ("text", self.letters()),
            22 => ("isosurface", self.isosurface()),
            _ => ("height_field", self.height_field()),
        }
    }

    fn may_open(&mut self, parts: &mut Vec<Part>) {
        if self.dice.chance(12) {
            parts.push(optional(words("open")));
        }
    }

    /// A surface without an inside.
    fn patch(&mut self) -> (&'static str, Vec<Part>) {
        match self.dice.below(9) {
            0 => {
                let (center, normal) = (self.point(0.5), self.direction());
                let radius = self.number(0.6, 1.5);
                let mut parts = vec![needed(list![center, ",", normal, ",", radius])];
                if self.dice.chance(40) {
                    let hole = self.number(0.1, 0.5);
                    parts.push(optional(list![",", hole]));
                }
                ("disc", parts)
            }
            1 => ("triangle", vec![needed(self.corners())]),
            2 => ("smooth_triangle", vec![needed(self.smooth_corners())]),
            3 => ("polygon", self.polygon()),
            4 => ("mesh", self.mesh()),
            5 => ("mesh2", self.mesh2()),
            6 => ("parametric", self.parametric()),
            7 => ("bicubic_patch", self.bicubic_patch()),
            _ => {
                let (normal, distance) = (self.direction(), self.number(-1.0, 1.0));
                ("plane", vec![needed(list![normal, ",", distance])])
            }
        }
    }
}
