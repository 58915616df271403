//! What the eye is inside of.

use crate::appearance::Appearance;
use crate::media::Medium;
use crate::prim::{Prim, PrimKind};
use crate::scene::{RenderGroup, RenderScene};
use strahl_geometry::{Primitive, Shape, Solid};
use strahl_math::{Aabb, DVec3, Transform};

/// What a ray is in that comes from the eye. It is found out once where all rays come from one point.
#[derive(Debug)]
pub(super) struct Eye {
    /// The place it has been found out for.
    at: Option<DVec3>,
    /// A box around all places so far, and what may be around places in it.
    region: Aabb,
    near: Vec<Filled>,
    /// What the eye is in at this place, the uppermost last.
    media: Vec<Medium>,
}

/// A solid that fills a part of space.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Filled {
    /// A box around its inside, in the world.
    pub(crate) bounds: Aabb,
    group: u32,
    prim: u32,
    /// From the group's space to the world; `None` for the world itself.
    to_world: Option<Transform>,
    /// Where the elements of the innermost instance begin.
    space: u64,
    /// Whether it has an end.
    bounded: bool,
}

impl Default for Eye {
    fn default() -> Self {
        Self {
            at: None,
            region: Aabb::EMPTY,
            near: vec![],
            media: vec![],
        }
    }
}

impl Eye {
    /// What a ray from this place starts in, the uppermost medium last; `None` if it starts in what the last one started in.
    ///
    /// Solids without an end come first, then the others, both in the order of the scene.
    #[inline]
    pub(super) fn moved_to(&mut self, scene: &RenderScene, place: DVec3) -> Option<&[Medium]> {
        if self.at == Some(place) {
            return None;
        }
        self.look_around(scene, place)
    }

    #[cold]
    fn look_around(&mut self, scene: &RenderScene, place: DVec3) -> Option<&[Medium]> {
        self.at = Some(place);
        if !self.region.contains(place) {
            let all = self.region.union(&Aabb::new(place, place));
            // Twice as large each time: rays from everywhere find this out a few times only.
            let size = all.size();
            self.region = all.padded(size * 0.5);
            self.near = scene.filled(&self.region, may_be_filled);
        }
        let before = std::mem::take(&mut self.media);
        for bounded in [false, true] {
            let near = self.near.iter().filter(|f| f.bounded == bounded);
            let around = near.filter_map(|f| f.medium_at(scene, place));
            self.media.extend(around);
        }
        (self.media != before).then_some(&self.media)
    }
}

impl Filled {
    fn medium_at(&self, scene: &RenderScene, place: DVec3) -> Option<Medium> {
        let appearance = self.appearance_at(scene, place)?;
        let material = &scene.materials[appearance.material.0 as usize];
        Some(appearance.medium(material, self.space))
    }

    /// Object and material, if the place is inside.
    pub(crate) fn appearance_at(&self, scene: &RenderScene, place: DVec3) -> Option<Appearance> {
        let group = &scene.groups[self.group as usize];
        let place = match &self.to_world {
            None => place,
            Some(map) => map.point_to_object(place),
        };
        let (appearance, contains) = match group.prims.at(self.prim).kind() {
            PrimKind::Sphere(number) => {
                let sphere = group.spheres.get(number, group.blocks.spheres());
                (group.spheres.appearance(number), sphere.contains(place))
            }
            PrimKind::Shape(index) | PrimKind::Placed(index) => {
                let used = &group.shapes[index as usize];
                let contains = match &used.inside {
                    Some(inside) => inside.limit.contains(place) && holds(&inside.solid, place),
                    None => {
                        let own = used.transform.as_ref();
                        holds(&used.shape, own.map_or(place, |m| m.point_to_object(place)))
                    }
                };
                (*used.appearance.of_inside()?, contains)
            }
            PrimKind::Triangle(..) | PrimKind::Instance(_) => return None,
        };
        contains.then_some(appearance)
    }
}

/// Whether a place is inside of a shape. A disc, which is a half-space for CSG, fills no more than its box by itself, and a height field
/// ends with its lowest point (measured).
fn holds(shape: &Shape, place: DVec3) -> bool {
    let bounds = match shape {
        Shape::Disc(disc) => Some(disc.bounds()),
        Shape::HeightField(field) => Some(field.bounds()),
        _ => None,
    };
    let may_hold = bounds.is_none_or(|bounds| bounds.contains(place));
    may_hold && solid(shape).is_some_and(|solid| solid.contains(place))
}

/// The shape as a solid. A CSG object with triangles among its parts is one too: the eye is in what the other parts enclose.
fn solid(shape: &Shape) -> Option<&dyn Solid> {
    match shape {
        Shape::Csg(csg) => Some(&**csg),
        _ => shape.as_solid(),
    }
}

impl RenderScene {
    /// The solids among the `wanted` primitives whose boxes meet a region, in the order of the scene.
    #[cold]
    pub(crate) fn filled(&self, region: &Aabb, wanted: fn(Prim) -> bool) -> Vec<Filled> {
        let reach = self.reach_of_filled(wanted);
        let mut found = vec![];
        let mut waiting = vec![(0, None::<Transform>, 0)];
        while let Some((number, to_world, space)) = waiting.pop() {
            let group = &self.groups[number as usize];
            let region = match &to_world {
                None => *region,
                Some(map) => map.inverted().bounds_to_world(region),
            };
            let mut inner = vec![];
            for (prim, places) in group.prims.runs() {
                if !wanted(prim) {
                    continue;
                }
                for prim in places {
                    let bounds = group.filled_bounds(prim, &reach);
                    if bounds.intersection(&region).is_empty() {
                        continue;
                    }
                    if let PrimKind::Instance(index) = group.prims.at(prim).kind() {
                        let instance = &group.instances[index as usize];
                        let map = match &to_world {
                            None => instance.transform,
                            Some(outer) => instance.transform.then(outer),
                        };
                        inner.push((instance.group, Some(map), space + group.first_id(prim)));
                    } else {
                        found.push(Filled {
                            bounds: to_world.map_or(bounds, |map| moved(bounds, &map)),
                            group: number,
                            prim,
                            to_world,
                            space,
                            bounded: bounds.is_bounded(),
                        });
                    }
                }
            }
            waiting.extend(inner.into_iter().rev());
        }
        found
    }

    /// By group, a box around its solids that fill a part of space.
    fn reach_of_filled(&self, wanted: fn(Prim) -> bool) -> Vec<Aabb> {
        let mut reach = vec![Aabb::EMPTY; self.groups.len()];
        // Groups refer to those behind them.
        for (number, group) in self.groups.iter().enumerate().rev() {
            let runs = group.prims.runs().filter(|(prim, _)| wanted(*prim));
            let bounds = runs
                .flat_map(|(_, places)| places)
                .map(|prim| group.filled_bounds(prim, &reach));
            reach[number] = bounds.fold(Aabb::EMPTY, |all, b| all.union(&b));
        }
        reach
    }
}

/// Whether it may be a solid that fills a part of space; triangles have no inside.
fn may_be_filled(prim: Prim) -> bool {
    prim.flags & Prim::FILLED != 0 && !matches!(prim.kind(), PrimKind::Triangle(..))
}

/// A box in another space.
fn moved(bounds: Aabb, map: &Transform) -> Aabb {
    if bounds.is_bounded() {
        map.bounds_to_world(&bounds)
    } else if bounds.is_empty() {
        bounds
    } else {
        Aabb::EVERYTHING
    }
}

impl RenderGroup {
    /// A box around the inside of a primitive, given those of the solids in groups.
    fn filled_bounds(&self, prim: u32, reach: &[Aabb]) -> Aabb {
        match self.prims.at(prim).kind() {
            PrimKind::Triangle(..) => Aabb::EMPTY,
            PrimKind::Sphere(number) => self.spheres.get(number, self.blocks.spheres()).bounds(),
            PrimKind::Shape(index) | PrimKind::Placed(index) => {
                let used = &self.shapes[index as usize];
                if let Some(inside) = &used.inside {
                    return inside.limit;
                }
                let bounds = solid(&used.shape).map(|s| s.inside_bounds());
                let bounds = bounds.unwrap_or(Aabb::EMPTY);
                let map = used.transform.as_ref();
                map.map_or(bounds, |map| moved(bounds, map))
            }
            PrimKind::Instance(index) => {
                let instance = &self.instances[index as usize];
                moved(reach[instance.group as usize], &instance.transform)
            }
        }
    }
}
