//! A face with all that its part of the limit surface depends on, and its division into smaller ones.

use super::SubdivisionScheme;
use super::rules::{Facet, Fan, Spoke, Tip, duller, face_depth, mean4};
use super::view::View;
use strahl_math::{Aabb, DVec3};

/// A face: its corners, counter-clockwise, each with what is around it, beginning with this face and the next corner.
#[derive(Clone, Debug)]
pub(super) struct Ring {
    pub(super) scheme: SubdivisionScheme,
    pub(super) level: u32,
    pub(super) corners: Vec<View>,
}

impl Ring {
    /// The corner after `i`, and those behind it.
    pub(super) fn corner(&self, i: usize) -> &View {
        &self.corners[i % self.corners.len()]
    }

    /// Whether the face is a patch: a regular one, or what remains around an irregular vertex when it is small enough.
    pub(super) fn is_leaf(&self) -> bool {
        self.corners.iter().all(|c| c.depth() <= self.level)
    }

    /// The surface about its irregular corner, if there is one whose rules don't change any more. With a limit it is only wanted if the
    /// face is narrower there.
    pub(super) fn tip(&self, limit: Option<f64>) -> Option<Tip> {
        let mut irregular = self.corners.iter().filter(|c| c.depth() > 0);
        let settled = irregular.find(|c| c.has_tip())?;
        settled.tip(self.scheme, limit)
    }

    /// Whether the face beyond edge `i` of a patch is divided further.
    pub(super) fn is_neighbor_divided(&self, i: usize) -> bool {
        let (a, b) = (self.corner(i), self.corner(i + 1));
        if a.facet_before().sides == 0 {
            return false;
        }
        let far = [a.spoke_before(), b.spoke(2)];
        far.iter().any(|spoke| spoke.depth > self.level)
    }

    /// The bytes that it takes, but for those that it shares with all faces at a vertex.
    pub(super) fn bytes(&self) -> usize {
        self.corners.iter().map(View::own_bytes).sum()
    }

    /// A box around the face on all later levels: new vertices are means of old ones with positive weights.
    pub(super) fn hull(&self) -> Aabb {
        self.corners.iter().fold(Aabb::EMPTY, |all, corner| {
            all.union(&corner.hull(self.scheme, self.level))
        })
    }

    /// The faces of the next level that this one is divided into.
    ///
    /// A face of four corners has its children at its corners, each with its corners in the order of the parent's. Other faces of
    /// Catmull and Clark's scheme have one child for each corner, with this corner first. Triangles have children at the
    /// corners, and the middle one last, whose corners are opposite to the parent's.
    pub(super) fn children(&self) -> Vec<Self> {
        let count = self.corners.len();
        let corners: Vec<View> = self
            .corners
            .iter()
            .map(|c| c.refined(self.scheme))
            .collect();
        let edges: Vec<View> = (0..count)
            .map(|i| {
                let next = (i + 1) % count;
                edge(
                    self.scheme,
                    [self.corner(i), self.corner(next)],
                    [&corners[i], &corners[next]],
                )
            })
            .collect();
        let child = |fans: Vec<View>| Self {
            scheme: self.scheme,
            level: self.level + 1,
            corners: fans,
        };
        let last = |i: usize| (i + count - 1) % count;
        match self.scheme {
            SubdivisionScheme::CatmullClark => {
                let middle = middle(self.scheme, self.corner(0).facet(0), &corners);
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

    /// The child at a corner of a face that has not four, as in [`Self::children`]: only three of the corners matter, those before and
    /// after it and itself, and the new vertex within the face, as the first child sees it.
    pub(super) fn child_of_many(
        scheme: SubdivisionScheme,
        corners: [View; 3],
        (middle, places): (&View, usize),
    ) -> Self {
        let refined = corners.each_ref().map(|c| c.refined(scheme));
        let edge = |i: usize| {
            edge(
                scheme,
                [&corners[i], &corners[i + 1]],
                [&refined[i], &refined[i + 1]],
            )
        };
        let (before, after) = (edge(0).rotated(1), edge(1));
        let [_, own, _] = refined;
        Self {
            scheme,
            level: 1,
            corners: vec![own, after, middle.rotated(places), before],
        }
    }
}

/// The new vertex on an edge, from the child at its beginning, from the corners at its ends as they were and as they are now.
fn edge(scheme: SubdivisionScheme, [old_a, old_b]: [&View; 2], [a, b]: [&View; 2]) -> View {
    let point = a.spoke(0).point;
    let sharpness = duller(old_a.spoke(0).sharpness);
    let opposite = old_a.facet_before();
    let end = |fan: &View| Spoke {
        point: fan.point(),
        sharpness,
        depth: fan.depth(),
    };
    let smooth = |point: DVec3, depth: u32| Spoke {
        point,
        sharpness: 0.0,
        depth,
    };
    // The new vertices on the edges before and after, of this face and of that beyond.
    let on = |spoke: Spoke| smooth(spoke.point, spoke.depth);
    let has_opposite = opposite.sides != 0;
    let (mut spokes, mut facets);
    match scheme {
        SubdivisionScheme::CatmullClark => {
            let own = old_a.facet(0);
            let new = |facet: Facet| smooth(facet.center, face_depth(scheme, facet.sides));
            let quad = |fan: &View, spoke: Spoke, center: DVec3| Facet {
                center: mean4(point, fan.point(), spoke.point, center),
                sides: 4,
            };
            spokes = vec![new(own), end(a)];
            facets = vec![quad(a, a.spoke(1), own.center)];
            if has_opposite {
                spokes.push(new(opposite));
                facets.push(quad(a, a.spoke_before(), opposite.center));
                facets.push(quad(b, b.spoke(2), opposite.center));
            } else {
                facets.push(Facet::GAP);
            }
            spokes.push(end(b));
            facets.push(quad(b, b.spoke(0), own.center));
        }
        SubdivisionScheme::Loop => {
            let own = old_a.facet(0);
            spokes = vec![on(a.spoke(1)), end(a)];
            facets = vec![own];
            if has_opposite {
                spokes.push(on(a.spoke_before()));
                spokes.push(on(b.spoke(2)));
                facets.extend([opposite; 3]);
            } else {
                facets.push(Facet::GAP);
            }
            spokes.push(end(b));
            spokes.push(on(b.spoke(0)));
            facets.extend([own; 2]);
        }
    }
    debug_assert_eq!(old_b.edges(), b.edges());
    View::new(Fan::new(point, 0.0, spokes, facets).finished(scheme))
}

/// The new vertex within a face of Catmull and Clark's scheme, from child 0; `corners` are the new vertices at its corners.
pub(super) fn middle(scheme: SubdivisionScheme, facet: Facet, corners: &[View]) -> View {
    let count = corners.len();
    // The edges come before their corners: edge `last(0)` is first.
    let spokes = (0..count).map(|j| {
        let spoke = corners[(j + count - 1) % count].spoke(0);
        Spoke {
            sharpness: 0.0,
            ..spoke
        }
    });
    let facets = (0..count).map(|j| Facet {
        center: mean4(
            facet.center,
            corners[(j + count - 1) % count].spoke(0).point,
            corners[j].point(),
            corners[j].spoke(0).point,
        ),
        sides: 4,
    });
    let fan = Fan::new(facet.center, 0.0, spokes.collect(), facets.collect());
    View::new(fan.finished(scheme))
}
