//! A checked control mesh, and the rings of its faces.

use super::SubdivisionScheme;
use super::data::{Sides, SubdivisionData, corner_sharpness};
use super::ring::{Ring, middle};
use super::rules::{FEW, Facet, Fan, Spoke, mean};
use super::view::View;
use crate::GeometryError;
use std::collections::HashMap;
use std::sync::Arc;
use strahl_math::{DVec2, DVec3, Transform};

/// A control mesh. Its elements are its faces; in Catmull and Clark's scheme a face that has not four corners has one for
/// each corner.
#[derive(Debug)]
pub(super) struct Cage {
    pub(super) data: SubdivisionData,
    sides: Sides,
    corners: HashMap<u32, f64>,
    /// The mean of the corners of each face.
    centers: Vec<DVec3>,
    /// The [`Fan::depth`] of the vertices.
    depths: Vec<u8>,
    /// The vertices with many edges, once for all of their faces, by the half-edges at them.
    crowded: HashMap<u32, View>,
    /// What the elements of a face with many corners have in common.
    wide: HashMap<usize, Wide>,
    /// The first element of each face, if there are not as many as faces; at the end their number.
    elements: Vec<u32>,
}

/// What the elements of a face have in common.
#[derive(Debug)]
struct Wide {
    /// The new vertex within it, from its first element.
    middle: View,
    /// The texture coordinates there, if there are any.
    uv: DVec2,
}

impl Cage {
    pub(super) fn try_new(data: &SubdivisionData) -> Result<Self, GeometryError> {
        data.check()?;
        let sides = Sides::try_new(data)?;
        let mut cage = Self {
            sides,
            corners: corner_sharpness(data),
            centers: vec![],
            depths: vec![0; data.points.len()],
            crowded: HashMap::new(),
            wide: HashMap::new(),
            elements: vec![],
            data: data.clone(),
        };
        cage.find_centers();
        let is_whole = |size: &u32| *size == 4 || data.scheme == SubdivisionScheme::Loop;
        if !data.sizes.iter().all(is_whole) {
            let mut total = 0;
            for size in &data.sizes {
                cage.elements.push(total);
                total += if is_whole(size) { 1 } else { *size };
            }
            cage.elements.push(total);
        }
        cage.find_vertices()?;
        cage.find_wide_faces();
        Ok(cage)
    }

    /// Finds the depths of all vertices, and those with many edges.
    fn find_vertices(&mut self) -> Result<(), GeometryError> {
        let scheme = self.scheme();
        let fans = self.find_fans()?;
        let mut crowded = vec![];
        for h in fans {
            let around = self.sides.around(h)?;
            let vertex = self.data.indices[h as usize] as usize;
            let depth = self.fan(h, &around).finished(scheme).depth as u8;
            self.depths[vertex] = self.depths[vertex].max(depth);
            if around.len() > FEW {
                crowded.push((h, around));
            }
        }
        // Fans know the depths around them.
        for (h, around) in crowded {
            let fan = Arc::new(self.finished(h, &around));
            let all = (0..)
                .zip(&around)
                .filter_map(|(i, side)| Some((i, (*side)?)));
            for (first, side) in all {
                self.crowded.insert(side, View::of(Arc::clone(&fan), first));
            }
        }
        Ok(())
    }

    /// The first half-edge of all faces around each vertex. Where separate fans of faces touch in a vertex, it becomes a sharp corner of each,
    /// which stays where it is, as in OpenSubdiv: the limits would come apart otherwise.
    fn find_fans(&mut self) -> Result<Vec<u32>, GeometryError> {
        let mut is_seen = vec![false; self.data.indices.len()];
        let mut has_fan = vec![false; self.data.points.len()];
        let mut fans = vec![];
        for h in 0..self.data.indices.len() as u32 {
            if is_seen[h as usize] {
                continue;
            }
            fans.push(h);
            for side in self.sides.around(h)?.iter().flatten() {
                is_seen[*side as usize] = true;
            }
            let vertex = self.data.indices[h as usize];
            if std::mem::replace(&mut has_fan[vertex as usize], true) {
                self.corners.insert(vertex, f64::INFINITY);
            }
        }
        Ok(fans)
    }

    fn find_wide_faces(&mut self) {
        for face in 0..self.data.sizes.len() {
            if self.data.sizes[face] as usize <= FEW {
                continue;
            }
            let scheme = self.scheme();
            let corners = self.corners_of(face);
            let refined: Vec<View> = corners
                .clone()
                .map(|h| self.view(h as u32).refined(scheme))
                .collect();
            let facet = Facet {
                center: self.centers[face],
                sides: self.data.sizes[face],
            };
            let uv = self.data.uvs.get(corners).map_or(DVec2::ZERO, mean_uv);
            let middle = middle(scheme, facet, &refined);
            self.wide.insert(face, Wide { middle, uv });
        }
    }

    fn find_centers(&mut self) {
        let faces = 0..self.data.sizes.len();
        self.centers = faces
            .map(|face| {
                let corners: Vec<DVec3> = self
                    .corners_of(face)
                    .map(|h| self.data.points[self.data.indices[h] as usize])
                    .collect();
                mean(&corners)
            })
            .collect();
    }

    /// The half-edges of a face.
    fn corners_of(&self, face: usize) -> std::ops::Range<usize> {
        self.sides.starts[face] as usize..self.sides.starts[face + 1] as usize
    }

    fn fan(&self, h: u32, around: &[Option<u32>]) -> Fan {
        let vertex = |h: u32| self.data.indices[h as usize];
        let spoke = |vertex: u32, edge: u32| Spoke {
            point: self.data.points[vertex as usize],
            sharpness: self.sides.sharpness(edge),
            depth: u32::from(self.depths[vertex as usize]),
        };
        let (mut spokes, mut facets) = (vec![], vec![]);
        let mut before: Option<u32> = None;
        for side in around {
            match (*side, before) {
                (Some(side), _) => {
                    spokes.push(spoke(vertex(self.sides.next(side)), side));
                    let face = self.sides.face[side as usize] as usize;
                    facets.push(Facet {
                        center: self.centers[face],
                        sides: self.data.sizes[face],
                    });
                }
                (None, Some(before)) => {
                    let edge = self.sides.previous(before);
                    spokes.push(spoke(vertex(edge), edge));
                    facets.push(Facet::GAP);
                }
                (None, None) => {}
            }
            before = *side;
        }
        let own = vertex(h);
        let sharpness = self.corners.get(&own).copied().unwrap_or(0.0);
        Fan::new(self.data.points[own as usize], sharpness, spokes, facets)
    }

    /// The vertex of a half-edge, when the depths of all are known.
    fn finished(&self, h: u32, around: &[Option<u32>]) -> Fan {
        let mut fan = self.fan(h, around).finished(self.data.scheme);
        fan.depth = u32::from(self.depths[self.data.indices[h as usize] as usize]);
        fan
    }

    /// The vertex of a half-edge, seen from its face.
    fn view(&self, h: u32) -> View {
        if let Some(view) = self.crowded.get(&h) {
            return view.clone();
        }
        // The mesh has been checked.
        let around = self.sides.around(h).unwrap_or_else(|_| vec![Some(h)]);
        View::new(self.finished(h, &around))
    }

    fn whole(&self, face: usize) -> Ring {
        Ring {
            scheme: self.data.scheme,
            level: 0,
            corners: self.corners_of(face).map(|h| self.view(h as u32)).collect(),
        }
    }

    pub(super) fn elements(&self) -> usize {
        match self.elements.last() {
            Some(count) => *count as usize,
            None => self.data.sizes.len(),
        }
    }

    /// The face of an element, and which part of it the element is, if it is not all.
    fn face(&self, element: usize) -> (usize, Option<usize>) {
        if self.elements.is_empty() {
            return (element, None);
        }
        let face = self.elements.partition_point(|e| *e as usize <= element) - 1;
        let part = element - self.elements[face] as usize;
        let is_part = self.data.sizes[face] != 4;
        (face, is_part.then_some(part))
    }

    pub(super) fn ring(&self, element: usize) -> Ring {
        let (face, part) = self.face(element);
        match (part, self.wide.get(&face)) {
            (Some(part), Some(wide)) => self.part_of_wide(face, part, wide),
            (Some(part), None) => self.whole(face).children().swap_remove(part),
            (None, _) => self.whole(face),
        }
    }

    /// The part at a corner of a face with many, without the others.
    fn part_of_wide(&self, face: usize, part: usize, wide: &Wide) -> Ring {
        let corners = self.corners_of(face);
        let count = corners.len();
        let view = |i: usize| self.view((corners.start + i % count) as u32);
        Ring::child_of_many(
            self.scheme(),
            [part + count - 1, part, part + 1].map(view),
            (&wide.middle, count - part),
        )
    }

    /// The texture coordinates of the corners of an element, if there are any.
    pub(super) fn uvs(&self, element: usize) -> Option<[DVec2; 4]> {
        if self.data.uvs.is_empty() {
            return None;
        }
        let (face, part) = self.face(element);
        let all = &self.data.uvs[self.corners_of(face)];
        let at = |i: usize| all[i % all.len()];
        let Some(i) = part else {
            return Some([at(0), at(1), at(2), at(3)]);
        };
        let middle = match self.wide.get(&face) {
            Some(wide) => wide.uv,
            None => mean_uv(all),
        };
        let half = |a: DVec2, b: DVec2| (a + b) * 0.5;
        let before = at(i + all.len() - 1);
        Some([at(i), half(at(i), at(i + 1)), middle, half(before, at(i))])
    }

    pub(super) fn is_closed(&self) -> bool {
        self.sides.is_closed()
    }

    pub(super) fn scheme(&self) -> SubdivisionScheme {
        self.data.scheme
    }

    /// The same mesh with moved vertices.
    pub(super) fn mapped(&self, map: &Transform) -> Option<SubdivisionData> {
        let mut data = self.data.clone();
        for point in &mut data.points {
            *point = map.point_to_world(*point);
        }
        data.check().is_ok().then_some(data)
    }

    pub(super) fn bytes(&self) -> usize {
        self.sides.bytes()
            + size_of_val(self.data.points.as_slice())
            + size_of_val(self.centers.as_slice())
            + self.depths.len()
            + 4 * (self.data.indices.len() + self.data.sizes.len() + self.elements.len())
            + size_of_val(self.data.uvs.as_slice())
            + self.shared_bytes()
    }

    /// The bytes of what faces share.
    fn shared_bytes(&self) -> usize {
        let table = self.crowded.len() * size_of::<(u32, View)>()
            + self.wide.len() * size_of::<(usize, Wide)>();
        let middles = self.wide.values().map(|wide| wide.middle.shared_bytes());
        // Each of its edges has a view of a fan.
        let firsts = self.crowded.values().filter(|view| view.is_first());
        table + middles.chain(firsts.map(View::shared_bytes)).sum::<usize>()
    }
}

fn mean_uv(all: &[DVec2]) -> DVec2 {
    all.iter().fold(DVec2::ZERO, |sum, p| sum + *p) / all.len() as f64
}
