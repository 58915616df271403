use super::super::node::{Node, Part, Sort, block, list, needed, optional, words};
use super::Writer;

impl Writer {
    pub(super) fn corners(&mut self) -> Node {
        let (a, b, c) = (self.point(1.4), self.point(1.4), self.point(1.4));
        list![a, ",", b, ",", c]
    }

    /// Corners with normals that point roughly to the eye.
    pub(super) fn smooth_corners(&mut self) -> Node {
        let mut normal = || {
            Node::from([
                self.dice.number(-0.6, 0.6),
                self.dice.number(-0.6, 0.6),
                -1.0,
            ])
        };
        let (l, m, n) = (normal(), normal(), normal());
        let (a, b, c) = (self.point(1.4), self.point(1.4), self.point(1.4));
        list![a, ",", l, ",", b, ",", m, ",", c, ",", n]
    }

    pub(super) fn polygon(&mut self) -> Vec<Part> {
        let count = self.dice.between(3, 6);
        let mut parts = vec![needed(list![(count + 1) as f64])];
        let mut first = None;
        for index in 0..count {
            let angle = index as f64 * std::f64::consts::TAU / count as f64;
            let r = self.dice.number(0.5, 1.4);
            let round = |v: f64| (v * 100.0).round() / 100.0;
            let corner = [round(r * angle.cos()), round(r * angle.sin())];
            first.get_or_insert(corner);
            parts.push(needed(list![",", corner]));
        }
        parts.extend(first.map(|corner| needed(list![",", corner])));
        parts
    }

    pub(super) fn mesh(&mut self) -> Vec<Part> {
        let mut parts = vec![];
        for _ in 0..self.dice.between(1, 4) {
            parts.push(optional(match self.dice.chance(60) {
                true => {
                    let corners = self.corners();
                    block(Sort::Other, "triangle", vec![needed(corners)])
                }
                false => {
                    let corners = self.smooth_corners();
                    block(Sort::Other, "smooth_triangle", vec![needed(corners)])
                }
            }));
        }
        parts
    }

    pub(super) fn mesh2(&mut self) -> Vec<Part> {
        let mut vertices = vec![needed(words("5"))];
        for _ in 0..5 {
            vertices.push(needed(list![",", self.point(1.3)]));
        }
        let mut parts = vec![needed(block(Sort::Other, "vertex_vectors", vertices))];
        if self.dice.chance(40) {
            let mut normals = vec![needed(words("5"))];
            for _ in 0..5 {
                let normal = Node::from([
                    self.dice.number(-0.6, 0.6),
                    self.dice.number(-0.6, 0.6),
                    -1.0,
                ]);
                normals.push(needed(list![",", normal]));
            }
            parts.push(optional(block(Sort::Other, "normal_vectors", normals)));
        }
        let with_uv = self.dice.chance(40);
        if with_uv {
            let mut uv = vec![needed(words("5"))];
            for _ in 0..5 {
                let at = [self.dice.number(0.0, 1.0), self.dice.number(0.0, 1.0)];
                uv.push(needed(list![",", at]));
            }
            parts.push(optional(block(Sort::Other, "uv_vectors", uv)));
        }
        if self.dice.chance(25) {
            let (a, b) = (self.texture(1), self.texture(1));
            let list = vec![needed(list!["2,", a, ",", b])];
            parts.push(needed(block(Sort::Other, "texture_list", list)));
            // Three numbers are the textures of the corners.
            let faces = match self.dice.chance(50) {
                true => "face_indices { 3, <0,1,2>, 0, <1,2,3>, 1, <2,3,4>, 0 }",
                false => "face_indices { 3, <0,1,2>, 0, 1, 0, <1,2,3>, 1, <2,3,4>, 1, 1, 0 }",
            };
            parts.push(needed(words(faces)));
        } else {
            parts.push(needed(words(
                "face_indices { 3, <0,1,2>, <1,2,3>, <2,3,4> }",
            )));
        }
        if with_uv {
            parts.push(optional(words("uv_mapping")));
        }
        parts
    }

    /// Sixteen points about a bent square, as fine as POV-Ray divides them.
    pub(super) fn bicubic_patch(&mut self) -> Vec<Part> {
        let mut parts = vec![needed(words("type 1 u_steps 5 v_steps 5"))];
        for j in 0..4 {
            for i in 0..4 {
                let near = |k: i32| f64::from(k) * 0.8 - 1.2;
                let shake = [0, 1, 2].map(|_| self.dice.number(-0.4, 0.4));
                let point = [near(i) + shake[0], near(j) + shake[1], 2.0 * shake[2]];
                parts.push(needed(list![Node::from(point)]));
            }
        }
        parts
    }

    pub(super) fn parametric(&mut self) -> Vec<Part> {
        let (a, b) = (self.dice.number(0.3, 1.0), self.dice.number(0.0, 0.5));
        let shape = match self.dice.below(3) {
            0 => list![
                "function { sin(u)*cos(v) } function { cos(u)*",
                a,
                "} function { sin(u)*sin(v) } <0, 0>, <3.1416, 6.2832>"
            ],
            1 => list![
                "function { u } function { v } function {",
                b,
                "*sin(u*3)*cos(v*2) } <-1, -1>, <1, 1>"
            ],
            _ => list![
                "function { (0.7 +",
                b,
                "*cos(v))*cos(u) } function {",
                b,
                "*sin(v) } function { (0.7 +",
                b,
                "*cos(v))*sin(u) } <0, 0>, <6.2832, 6.2832>"
            ],
        };
        vec![
            needed(shape),
            needed(words("contained_by { box { -1.5, 1.5 } }")),
            // With less of either, POV-Ray misses parts and is off by more than a colour's width.
            needed(words("max_gradient 20")),
            needed(words("accuracy 0.00001")),
            optional(words("precompute 8 x, y, z")),
        ]
    }
}
