//! Subdivision of whole meshes, level by level, written without regard to the code under test.

use super::*;
use std::collections::HashMap;

/// A mesh at some level.
pub(super) struct Mesh {
    scheme: SubdivisionScheme,
    pub(super) points: Vec<DVec3>,
    pub(super) faces: Vec<Face>,
    creases: HashMap<(u32, u32), f64>,
    corners: HashMap<u32, f64>,
}

/// A face with its place in an element of the surface.
pub(super) struct Face {
    pub(super) corners: Vec<u32>,
    pub(super) element: u32,
    pub(super) uv: Vec<DVec2>,
}

fn key(a: u32, b: u32) -> (u32, u32) {
    (a.min(b), a.max(b))
}

/// All that is around a vertex or an edge.
struct Around {
    edges: HashMap<(u32, u32), Vec<usize>>,
    neighbors: HashMap<u32, Vec<u32>>,
    faces: HashMap<u32, Vec<usize>>,
}

impl Mesh {
    pub(super) fn new(data: &SubdivisionData) -> Self {
        let mut faces = vec![];
        let (mut start, mut element) = (0, 0);
        for size in &data.sizes {
            let corners = data.indices[start..start + *size as usize].to_vec();
            start += *size as usize;
            let square = [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y];
            let uv = match (data.scheme, size) {
                (Loop, _) => vec![DVec2::ZERO, DVec2::X, DVec2::Y],
                (_, 4) => square.to_vec(),
                // Set when it is divided.
                _ => vec![],
            };
            let count = if uv.is_empty() { *size } else { 1 };
            faces.push(Face {
                corners,
                element,
                uv,
            });
            element += count;
        }
        let forever = |s: f64| if s >= 10.0 { f64::INFINITY } else { s };
        Self {
            scheme: data.scheme,
            points: data.points.clone(),
            faces,
            creases: data
                .creases
                .iter()
                .map(|([a, b], s)| (key(*a, *b), forever(*s)))
                .collect(),
            corners: data
                .corners
                .iter()
                .map(|(v, s)| (*v, forever(*s)))
                .collect(),
        }
    }

    fn around(&self) -> Around {
        let mut around = Around {
            edges: HashMap::new(),
            neighbors: HashMap::new(),
            faces: HashMap::new(),
        };
        for (f, face) in self.faces.iter().enumerate() {
            let count = face.corners.len();
            for k in 0..count {
                let (a, b) = (face.corners[k], face.corners[(k + 1) % count]);
                around.edges.entry(key(a, b)).or_default().push(f);
                around.faces.entry(a).or_default().push(f);
                for (x, y) in [(a, b), (b, a)] {
                    let list = around.neighbors.entry(x).or_default();
                    if !list.contains(&y) {
                        list.push(y);
                    }
                }
            }
        }
        around
    }

    fn sharpness(&self, around: &Around, a: u32, b: u32) -> f64 {
        if around.edges[&key(a, b)].len() == 1 {
            return f64::INFINITY;
        }
        self.creases.get(&key(a, b)).copied().unwrap_or(0.0)
    }

    fn center(&self, f: usize) -> DVec3 {
        let corners = &self.faces[f].corners;
        let all: DVec3 = corners.iter().map(|v| self.points[*v as usize]).sum();
        all / corners.len() as f64
    }

    /// The rule of a vertex, its sharpness lowered by `less`: what its next place is, and its limit.
    fn rule(&self, around: &Around, v: u32, less: f64) -> (u8, DVec3, DVec3) {
        let point = self.points[v as usize];
        let Some(neighbors) = around.neighbors.get(&v) else {
            return (2, point, point);
        };
        let at = |k: &u32| self.points[*k as usize];
        let sharp: Vec<&u32> = neighbors
            .iter()
            .filter(|k| self.sharpness(around, v, **k) - less > 0.0)
            .collect();
        let own = self.corners.get(&v).copied().unwrap_or(0.0) - less;
        if own > 0.0 || sharp.len() > 2 {
            return (2, point, point);
        }
        if let [a, b] = sharp[..] {
            let ends = at(a) + at(b);
            return (1, (6.0 * point + ends) / 8.0, (4.0 * point + ends) / 6.0);
        }
        let n = neighbors.len() as f64;
        let all: DVec3 = neighbors.iter().map(at).sum();
        if self.scheme == Loop {
            let c = 0.375 + 0.25 * (std::f64::consts::TAU / n).cos();
            let beta = (0.625 - c * c) / n;
            let weight = 1.0 / (0.375 / beta + n);
            return (
                0,
                point * (1.0 - n * beta) + all * beta,
                point * (1.0 - n * weight) + all * weight,
            );
        }
        // Catmull and Clark: the mean of face points, of middles of edges, and of the vertex itself.
        let faces: DVec3 = around.faces[&v].iter().map(|f| self.center(*f)).sum();
        let middles = (all + n * point) / (2.0 * n);
        let next = (faces / n + 2.0 * middles + (n - 3.0) * point) / n;
        // Halstead, Kass, DeRose, "Efficient, fair interpolation using Catmull-Clark surfaces", 1993, for quadrilaterals.
        let across: DVec3 = around.faces[&v]
            .iter()
            .flat_map(|f| self.faces[*f].corners.clone())
            .filter(|k| *k != v && !neighbors.contains(k))
            .map(|k| at(&k))
            .sum();
        (
            0,
            next,
            (n * n * point + 4.0 * all + across) / (n * (n + 5.0)),
        )
    }

    /// The limits of all vertices but the ends of creases, which have no simple formula; right when there are only quadrilaterals (or
    /// triangles) and no sharpness that ends.
    pub(super) fn limits(&self) -> Vec<Option<DVec3>> {
        let around = self.around();
        (0..self.points.len() as u32)
            .map(|v| {
                let is_sharp = |k: &&u32| self.sharpness(&around, v, **k) > 0.0;
                let sharp = around.neighbors.get(&v)?.iter().filter(is_sharp).count();
                (sharp != 1).then(|| self.rule(&around, v, 0.0).2)
            })
            .collect()
    }

    /// Limit normals at smooth vertices, with their number of edges.
    pub(super) fn normals(&self) -> Vec<Option<(DVec3, usize)>> {
        let around = self.around();
        (0..self.points.len() as u32)
            .map(|v| {
                let is_sharp = |k: &u32| self.sharpness(&around, v, *k) > 0.0;
                if around.neighbors.get(&v)?.iter().any(is_sharp) || self.corners.contains_key(&v) {
                    return None;
                }
                // Counter-clockwise: the next corner of a face, and the one opposite.
                let mut ring = vec![];
                let mut face = around.faces[&v][0];
                let n = around.faces[&v].len();
                for _ in 0..n {
                    let corners = &self.faces[face].corners;
                    let count = corners.len();
                    let k = corners.iter().position(|c| *c == v).expect("a corner");
                    let turn = |j: usize| corners[(k + j) % count];
                    let at = |j: usize| self.points[turn(j) as usize];
                    ring.push([at(1), at(2)]);
                    let edge = key(v, turn(count - 1));
                    let next = around.edges[&edge].iter().find(|f| **f != face);
                    face = *next.expect("a neighbour");
                }
                let angle = |j: usize| std::f64::consts::TAU * j as f64 / n as f64;
                let tangent = |f: fn(f64) -> f64| -> DVec3 {
                    if self.scheme == Loop {
                        return (0..n).map(|j| f(angle(j)) * ring[j][0]).sum();
                    }
                    let c = angle(1).cos();
                    let half = (std::f64::consts::PI / n as f64).cos();
                    let a = 1.0 + c + half * (2.0 * (9.0 + c)).sqrt();
                    (0..n)
                        .map(|j| {
                            let [edge, face] = ring[j];
                            a * f(angle(j)) * edge + (f(angle(j)) + f(angle(j + 1))) * face
                        })
                        .sum()
                };
                Some((tangent(f64::cos).cross(tangent(f64::sin)).normalize(), n))
            })
            .collect()
    }

    /// The next level.
    pub(super) fn refined(&self) -> Self {
        let around = self.around();
        let mut points: Vec<DVec3> = (0..self.points.len() as u32)
            .map(|v| {
                let (now, place, _) = self.rule(&around, v, 0.0);
                let (next, other, _) = self.rule(&around, v, 1.0);
                if now == next {
                    return place;
                }
                let edges = around.neighbors[&v]
                    .iter()
                    .map(|k| self.sharpness(&around, v, *k));
                let own = self.corners.get(&v).copied().unwrap_or(0.0);
                let ending = edges.chain([own]).filter(|s| *s > 0.0 && *s <= 1.0);
                let ending: Vec<f64> = ending.collect();
                let part = ending.iter().sum::<f64>() / ending.len() as f64;
                place.lerp(other, 1.0 - part)
            })
            .collect();
        let centers: Vec<DVec3> = (0..self.faces.len()).map(|f| self.center(f)).collect();
        let mut creases = HashMap::new();
        let mut edges = HashMap::new();
        for ((a, b), sides) in &around.edges {
            let (p, q) = (self.points[*a as usize], self.points[*b as usize]);
            let sharpness = self.sharpness(&around, *a, *b);
            let mut point = (p + q) / 2.0;
            if let [f, g] = sides[..]
                && sharpness < 1.0
            {
                let smooth = if self.scheme == Loop {
                    let far = |f: usize| {
                        let corners = self.faces[f].corners.iter();
                        let mut far = corners.filter(|k| *k != a && *k != b);
                        self.points[*far.next().expect("a corner") as usize]
                    };
                    0.375 * (p + q) + 0.125 * (far(f) + far(g))
                } else {
                    (p + q + centers[f] + centers[g]) / 4.0
                };
                point = smooth.lerp(point, sharpness);
            }
            let new = points.len() as u32;
            points.push(point);
            edges.insert((*a, *b), new);
            if sharpness > 1.0 && sides.len() == 2 {
                creases.insert(key(*a, new), sharpness - 1.0);
                creases.insert(key(*b, new), sharpness - 1.0);
            }
        }
        let first = points.len() as u32;
        points.extend(&centers);
        let mut faces = vec![];
        for (f, face) in self.faces.iter().enumerate() {
            let count = face.corners.len();
            let edge =
                |k: usize| edges[&key(face.corners[k % count], face.corners[(k + 1) % count])];
            let half = |k: usize| (face.uv[k % count] + face.uv[(k + 1) % count]) / 2.0;
            for k in 0..count {
                let before = k + count - 1;
                if self.scheme == Loop {
                    faces.push(Face {
                        corners: vec![face.corners[k], edge(k), edge(before)],
                        element: face.element,
                        uv: vec![face.uv[k], half(k), half(before)],
                    });
                    continue;
                }
                let is_whole = !face.uv.is_empty();
                faces.push(Face {
                    corners: vec![face.corners[k], edge(k), first + f as u32, edge(before)],
                    element: face.element + if is_whole { 0 } else { k as u32 },
                    uv: if is_whole {
                        let middle = face.uv.iter().sum::<DVec2>() / 4.0;
                        vec![face.uv[k], half(k), middle, half(before)]
                    } else {
                        vec![DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y]
                    },
                });
            }
            if self.scheme == Loop {
                faces.push(Face {
                    corners: vec![edge(0), edge(1), edge(2)],
                    element: face.element,
                    uv: vec![half(0), half(1), half(2)],
                });
            }
        }
        let dull = |s: &f64| (*s > 1.0).then(|| s - 1.0);
        Self {
            scheme: self.scheme,
            points,
            faces,
            creases,
            corners: self
                .corners
                .iter()
                .filter_map(|(v, s)| Some((*v, dull(s)?)))
                .collect(),
        }
    }
}
