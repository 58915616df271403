//! The oracle of silhouettes: how often a line of sight meets a dense mesh of points of the surface.

use crate::conformance::Random;
use std::f64::consts::TAU;
use strahl_math::{DVec2, DVec3, Ray};

/// A dense mesh of points of a surface, seen along a direction.
pub(super) struct Shadow {
    points: Vec<DVec2>,
    triangles: Vec<[u32; 3]>,
    /// Edges between triangles that show different sides, as seen along the direction.
    rims: Vec<[u32; 2]>,
    /// A cell of a grid has the triangles that may be over it.
    cells: Vec<Vec<u32>>,
    low: DVec2,
    size: DVec2,
}

/// Cells of a grid along each side.
const CELLS: usize = 64;

/// Directions across another one.
fn frame(direction: DVec3) -> [DVec3; 2] {
    let right = direction.any_orthonormal_vector();
    [right, direction.cross(right)]
}

impl Shadow {
    /// The mesh of these points and triangles.
    pub(super) fn new(points: &[DVec3], triangles: Vec<[u32; 3]>, direction: DVec3) -> Self {
        let [right, up] = frame(direction);
        let places = points.iter().map(|p| DVec2::new(p.dot(right), p.dot(up)));
        let points: Vec<DVec2> = places.collect();
        let (low, high) = points
            .iter()
            .fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), p| {
                (low.min(*p), high.max(*p))
            });
        let mut shadow = Self {
            points,
            triangles,
            rims: vec![],
            cells: vec![vec![]; CELLS * CELLS],
            low,
            size: high - low,
        };
        shadow.find_rims();
        for k in 0..shadow.triangles.len() {
            let corners = shadow.corners(k);
            let low = corners.iter().fold(DVec2::INFINITY, |low, p| low.min(*p));
            let high = corners
                .iter()
                .fold(DVec2::NEG_INFINITY, |high, p| high.max(*p));
            let ([i0, j0], [i1, j1]) = (shadow.cell(low), shadow.cell(high));
            for j in j0..=j1 {
                for i in i0..=i1 {
                    shadow.cells[j * CELLS + i].push(k as u32);
                }
            }
        }
        shadow
    }

    fn corners(&self, triangle: usize) -> [DVec2; 3] {
        self.triangles[triangle].map(|v| self.points[v as usize])
    }

    fn cell(&self, place: DVec2) -> [usize; 2] {
        let part = (place - self.low) / self.size * CELLS as f64;
        part.to_array()
            .map(|x| (x.max(0.0) as usize).min(CELLS - 1))
    }

    fn find_rims(&mut self) {
        let mut sides = std::collections::HashMap::new();
        for k in 0..self.triangles.len() {
            let [a, b, c] = self.corners(k);
            let side = (b - a).perp_dot(c - a) > 0.0;
            let t = self.triangles[k];
            for e in 0..3 {
                let (v, w) = (t[e], t[(e + 1) % 3]);
                let key = [v.min(w), v.max(w)];
                if sides.insert(key, side).is_some_and(|other| other != side) {
                    self.rims.push(key);
                }
            }
        }
    }

    /// How many triangles are over a place.
    pub(super) fn layers(&self, place: DVec2) -> usize {
        let outside = place.cmplt(self.low).any() || place.cmpgt(self.low + self.size).any();
        if outside {
            return 0;
        }
        let [i, j] = self.cell(place);
        let over = self.cells[j * CELLS + i].iter().filter(|k| {
            let [a, b, c] = self.corners(**k as usize);
            let left = |a: DVec2, b: DVec2| (b - a).perp_dot(place - a) > 0.0;
            left(a, b) == left(b, c) && left(b, c) == left(c, a)
        });
        over.count()
    }

    /// A place at a rim, moved aside by this distance times something from 1 to 4.
    pub(super) fn beside_a_rim(&self, random: &mut Random, distance: f64) -> DVec2 {
        let rim = self.rims[random.below(self.rims.len() as u64) as usize];
        let [a, b] = rim.map(|v| self.points[v as usize]);
        let off = DVec2::from_angle(random.between(0.0, TAU));
        a.lerp(b, random.unit()) + off * distance * random.between(1.0, 4.0)
    }

    /// How far a place is from the nearest rim.
    pub(super) fn distance(&self, place: DVec2) -> f64 {
        let to_edge = |[v, w]: &[u32; 2]| {
            let (a, b) = (self.points[*v as usize], self.points[*w as usize]);
            let along = b - a;
            let part = (place - a).dot(along) / along.length_squared().max(1e-300);
            (a + along * part.clamp(0.0, 1.0) - place).length()
        };
        self.rims.iter().map(to_edge).fold(f64::INFINITY, f64::min)
    }
}

/// A line of sight at a place.
pub(super) fn sight(direction: DVec3, place: DVec2) -> Ray {
    let [right, up] = frame(direction);
    Ray::new(right * place.x + up * place.y - direction * 8.0, direction)
}
