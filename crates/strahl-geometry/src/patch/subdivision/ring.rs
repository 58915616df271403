//! A face with all that its part of the limit surface depends on, and its division into smaller ones.

use super::SubdivisionScheme;
use super::rules::{Facet, Fan, Spoke, Tip, duller, face_depth, mean4};
use strahl_math::{Aabb, DVec3};

/// A face: its corners, counter-clockwise, each with what is around it, beginning with this face and the next corner.
#[derive(Clone, Debug)]
pub(super) struct Ring {
    pub(super) scheme: SubdivisionScheme,
    pub(super) level: u32,
    pub(super) corners: Vec<Fan>,
}

impl Ring {
    /// The corner after `i`, and those behind it.
    pub(super) fn corner(&self, i: usize) -> &Fan {
        &self.corners[i % self.corners.len()]
    }

    /// Whether the face is a patch: a regular one, or what remains around an irregular vertex when it is small enough.
    pub(super) fn is_leaf(&self) -> bool {
        self.corners.iter().all(|c| c.depth <= self.level)
    }

    /// The surface about its irregular corner, if there is one whose rules don't change any more.
    pub(super) fn tip(&self) -> Option<Tip> {
        let mut irregular = self.corners.iter().filter(|c| c.depth > 0);
        irregular.find_map(|c| c.tip(self.scheme))
    }

    /// Whether the face beyond edge `i` of a patch is divided further.
    pub(super) fn is_neighbor_divided(&self, i: usize) -> bool {
        let (a, b) = (self.corner(i), self.corner(i + 1));
        let other = a.facets[a.before(0)];
        if other.sides == 0 {
            return false;
        }
        let far = [a.spokes[a.before(0)], b.spokes[b.turn(1, 1)]];
        far.iter().any(|spoke| spoke.depth > self.level)
    }

    /// The bytes that it takes.
    pub(super) fn bytes(&self) -> usize {
        let fan = |fan: &Fan| {
            size_of::<Fan>()
                + size_of_val(fan.spokes.as_slice())
                + size_of_val(fan.facets.as_slice())
        };
        let corners = self.corners.iter();
        corners
            .flat_map(|corner| std::iter::once(corner).chain(corner.origin.as_deref()))
            .map(fan)
            .sum()
    }

    /// A box around the face on all later levels: new vertices are means of old ones with positive weights.
    pub(super) fn hull(&self) -> Aabb {
        Aabb::from_points(self.corners.iter().flat_map(|fan| fan.points(self.scheme)))
    }

    /// The faces of the next level that this one is divided into.
    ///
    /// A face of four corners has its children at its corners, each with its corners in the order of the parent's. Other faces of
    /// Catmull and Clark's scheme have one child for each corner, with this corner first. Triangles have children at the
    /// corners, and the middle one last, whose corners are opposite to the parent's.
    pub(super) fn children(&self) -> Vec<Self> {
        let count = self.corners.len();
        let corners: Vec<Fan> = self
            .corners
            .iter()
            .map(|c| c.refined(self.scheme))
            .collect();
        let edges: Vec<Fan> = (0..count).map(|i| self.edge(&corners, i)).collect();
        let child = |fans: Vec<Fan>| Self {
            scheme: self.scheme,
            level: self.level + 1,
            corners: fans,
        };
        let last = |i: usize| (i + count - 1) % count;
        match self.scheme {
            SubdivisionScheme::CatmullClark => {
                let middle = self.middle(&corners);
                (0..count)
                    .map(|i| {
                        let mut fans = vec![
                            corners[i].clone(),
                            edges[i].clone(),
                            middle.rotated(count - i),
                            edges[last(i)].rotated(1),
                        ];
                        if count == 4 {
                            fans.rotate_right(i);
                        }
                        child(fans)
                    })
                    .collect()
            }
            SubdivisionScheme::Loop => {
                let mut children: Vec<Self> = (0..count)
                    .map(|i| {
                        let mut fans = vec![
                            corners[i].clone(),
                            edges[i].clone(),
                            edges[last(i)].rotated(2),
                        ];
                        fans.rotate_right(i);
                        child(fans)
                    })
                    .collect();
                children.push(child(
                    (0..count)
                        .map(|j| edges[(j + 1) % count].rotated(1))
                        .collect(),
                ));
                children
            }
        }
    }

    /// The new vertex on edge `i`, from child `i`; `corners` are the new vertices at the corners.
    fn edge(&self, corners: &[Fan], i: usize) -> Fan {
        let next = (i + 1) % corners.len();
        let (a, b) = (&corners[i], &corners[next]);
        let (old_a, old_b) = (self.corner(i), self.corner(next));
        let point = a.spokes[0].point;
        let (other, sharpness) = (old_a.before(0), duller(old_a.spokes[0].sharpness));
        let opposite = old_a.facets[other];
        let end = |fan: &Fan| Spoke {
            point: fan.point,
            sharpness,
            depth: fan.depth,
        };
        let smooth = |point: DVec3, depth: u32| Spoke {
            point,
            sharpness: 0.0,
            depth,
        };
        // The new vertices on the edges before and after, of this face and of that beyond.
        let on = |fan: &Fan, j: usize| smooth(fan.spokes[j].point, fan.spokes[j].depth);
        let has_opposite = opposite.sides != 0;
        let (mut spokes, mut facets);
        match self.scheme {
            SubdivisionScheme::CatmullClark => {
                let own = old_a.facets[0];
                let new = |facet: Facet| smooth(facet.center, face_depth(self.scheme, facet.sides));
                let quad = |fan: &Fan, j: usize, center: DVec3| Facet {
                    center: mean4(point, fan.point, fan.spokes[j].point, center),
                    sides: 4,
                };
                spokes = vec![new(own), end(a)];
                facets = vec![quad(a, 1, own.center)];
                if has_opposite {
                    spokes.push(new(opposite));
                    facets.push(quad(a, a.before(0), opposite.center));
                    facets.push(quad(b, b.turn(1, 1), opposite.center));
                } else {
                    facets.push(Facet::GAP);
                }
                spokes.push(end(b));
                facets.push(quad(b, 0, own.center));
            }
            SubdivisionScheme::Loop => {
                let own = old_a.facets[0];
                spokes = vec![on(a, 1), end(a)];
                facets = vec![own];
                if has_opposite {
                    spokes.push(on(a, a.before(0)));
                    spokes.push(on(b, b.turn(1, 1)));
                    facets.extend([opposite; 3]);
                } else {
                    facets.push(Facet::GAP);
                }
                spokes.push(end(b));
                spokes.push(on(b, 0));
                facets.extend([own; 2]);
            }
        }
        debug_assert_eq!(old_b.spokes.len(), b.spokes.len());
        Fan {
            point,
            limit: None,
            origin: None,
            age: 0,
            sharpness: 0.0,
            depth: 0,
            spokes,
            facets,
        }
        .finished(self.scheme)
    }

    /// The new vertex within a face of Catmull and Clark's scheme, from child 0.
    fn middle(&self, corners: &[Fan]) -> Fan {
        let count = corners.len();
        let facet = self.corner(0).facets[0];
        // The edges come before their corners: edge `last(0)` is first.
        let spokes = (0..count).map(|j| {
            let spoke = corners[(j + count - 1) % count].spokes[0];
            Spoke {
                sharpness: 0.0,
                ..spoke
            }
        });
        let facets = (0..count).map(|j| Facet {
            center: mean4(
                facet.center,
                corners[(j + count - 1) % count].spokes[0].point,
                corners[j].point,
                corners[j].spokes[0].point,
            ),
            sides: 4,
        });
        Fan {
            point: facet.center,
            limit: None,
            origin: None,
            age: 0,
            sharpness: 0.0,
            depth: 0,
            spokes: spokes.collect(),
            facets: facets.collect(),
        }
        .finished(self.scheme)
    }
}
