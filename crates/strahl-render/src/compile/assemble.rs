use super::flatten::FlatGroup;
use crate::blocks::Lists;
use crate::first_ids::FirstIds;
use crate::prim::{Prim, PrimKind};
use crate::runs::RunList;
use crate::spheres::Spheres;
use crate::uses::{InstanceUse, MeshUse, ShapeUse};
use strahl_geometry::Primitive;
use strahl_math::Aabb;
use strahl_scene::{Diagnostic, Scene};

/// A group with its element numbers and bounds.
#[derive(Clone, Debug)]
pub(super) struct Assembled {
    pub(super) prims: RunList<Prim>,
    pub(super) shapes: Vec<ShapeUse>,
    pub(super) spheres: Spheres,
    pub(super) meshes: Vec<MeshUse>,
    pub(super) instances: Vec<InstanceUse>,
    pub(super) first_ids: Option<FirstIds>,
    pub(super) count: u64,
    /// Bounds of its bounded primitives.
    pub(super) bounds: Aabb,
    /// Bounds of all its primitives; unbounded if one of them is.
    reach: Aabb,
    pub(super) prim_bounds: Vec<Aabb>,
}

impl Assembled {
    /// The lists of its primitives.
    pub(super) const fn lists(&self) -> Lists<'_> {
        Lists {
            prims: &self.prims,
            shapes: self.shapes.as_slice(),
            spheres: &self.spheres,
            meshes: self.meshes.as_slice(),
        }
    }
}

/// Deepest nesting of instances.
const MOST_LEVELS: u32 = 64;

/// Orders the groups so that each comes before those it instances, the world first, drops unused groups, and computes element
/// numbers and bounds. The masks of lights refer to groups by number too; these are renumbered.
pub(super) fn assemble(
    groups: Vec<FlatGroup>,
    world: usize,
    scene: &Scene,
    masks: &mut [Option<InstanceUse>],
) -> Result<Vec<Assembled>, Vec<Diagnostic>> {
    let roots: Vec<usize> = masks.iter().flatten().map(|m| m.group as usize).collect();
    let order = order(&groups, world, scene, &roots)?;
    let mut place = vec![u32::MAX; groups.len()];
    let mut groups: Vec<Option<FlatGroup>> = groups.into_iter().map(Some).collect();
    // A group needs the bounds of those it instances, so it is assembled after them; numbers are given from the last one down.
    let last = order.len().saturating_sub(1);
    let mut done: Vec<Assembled> = Vec::with_capacity(order.len());
    for index in order {
        let Some(mut group) = groups[index].take() else {
            continue;
        };
        for instance in &mut group.instances {
            instance.group = place[instance.group as usize];
        }
        place[index] = (last - done.len()) as u32;
        done.push(number(group, |place| &done[last - place as usize])?);
    }
    done.reverse();
    for mask in masks.iter_mut().flatten() {
        mask.group = place[mask.group as usize];
    }
    Ok(done)
}

/// The groups that these roots need, then those that the world needs, each after those it instances.
fn order(
    groups: &[FlatGroup],
    world: usize,
    scene: &Scene,
    roots: &[usize],
) -> Result<Vec<usize>, Vec<Diagnostic>> {
    #[derive(Clone, Copy, PartialEq)]
    enum State {
        New,
        Open,
        Done,
    }
    let mut states = vec![State::New; groups.len()];
    let mut levels = vec![0u32; groups.len()];
    let mut order = Vec::new();
    // A stack: the world, pushed first, is finished after all others.
    let mut path: Vec<(usize, usize)> = vec![];
    let mut waiting: Vec<usize> = std::iter::once(world)
        .chain(roots.iter().rev().copied())
        .collect();
    loop {
        let Some((group, next)) = path.last_mut() else {
            let Some(root) = waiting.pop() else {
                return Ok(order);
            };
            if states[root] == State::New {
                states[root] = State::Open;
                path.push((root, 0));
            }
            continue;
        };
        let (group, instances) = (*group, &groups[*group].instances);
        if let Some(instance) = instances.get(*next) {
            *next += 1;
            let inner = instance.group as usize;
            match states[inner] {
                State::Done => levels[group] = levels[group].max(levels[inner] + 1),
                State::New => {
                    states[inner] = State::Open;
                    path.push((inner, 0));
                }
                State::Open => {
                    let name = scene
                        .groups
                        .get(inner)
                        .and_then(|g| g.name.as_deref())
                        .unwrap_or("(unnamed)");
                    let message = format!("group {inner} {name} contains an instance of itself");
                    return Err(vec![Diagnostic::error(message)]);
                }
            }
            continue;
        }
        if levels[group] > MOST_LEVELS {
            let message = format!("instances are nested more than {MOST_LEVELS} levels deep");
            return Err(vec![Diagnostic::error(message)]);
        }
        states[group] = State::Done;
        order.push(group);
        path.pop();
        if let Some((parent, _)) = path.last() {
            levels[*parent] = levels[*parent].max(levels[group] + 1);
        }
    }
}

/// Element numbers and bounds of a group whose instances refer to groups that are already assembled.
fn number<'d>(
    group: FlatGroup,
    done: impl Fn(u32) -> &'d Assembled,
) -> Result<Assembled, Vec<Diagnostic>> {
    if group.prims.len() >= u32::MAX as usize {
        return Err(too_many("primitives: more than 2^32"));
    }
    let mut prim_bounds = Vec::with_capacity(group.prims.len());
    let mut numbers = Numbers::default();
    let (mut bounds, mut reach) = (Aabb::EMPTY, Aabb::EMPTY);
    for prim in group.prims.iter() {
        let extent = Extent::of(prim.kind(), &group, &done);
        numbers.push(extent.elements)?;
        bounds = bounds.union(&extent.inner);
        if extent.all.is_bounded() {
            bounds = bounds.union(&extent.all);
        }
        reach = reach.union(&extent.all);
        prim_bounds.push(extent.all);
    }
    Ok(Assembled {
        prims: group.prims.completed(),
        shapes: group.shapes,
        spheres: group.spheres,
        meshes: group.meshes,
        instances: group.instances,
        count: numbers.count,
        first_ids: numbers.first_ids(),
        bounds,
        reach,
        prim_bounds,
    })
}

/// The scene can't be numbered.
fn too_many(what: &str) -> Vec<Diagnostic> {
    vec![Diagnostic::error(format!("the scene has too many {what}"))]
}

/// How many elements a primitive has, and where they are.
struct Extent {
    elements: u64,
    /// Bounds of an instance's bounded primitives; empty for others.
    inner: Aabb,
    /// Bounds of all of it.
    all: Aabb,
}

impl Extent {
    fn of<'d>(prim: PrimKind, group: &FlatGroup, done: impl Fn(u32) -> &'d Assembled) -> Self {
        let (elements, all) = match prim {
            PrimKind::Triangle(mesh, triangle) => {
                let mesh = &group.meshes[mesh as usize].mesh;
                (1, mesh.element_bounds(triangle))
            }
            PrimKind::Sphere(number) => (1, group.spheres.loose(number).bounds()),
            PrimKind::Shape(shape) => {
                let shape = &group.shapes[shape as usize].shape;
                (u64::from(shape.elements()), shape.bounds())
            }
            PrimKind::Placed(shape) => {
                let used = &group.shapes[shape as usize];
                let (elements, bounds) = (used.shape.elements(), used.shape.bounds());
                let map = used.transform.as_ref();
                let bounds = map.map_or(bounds, |map| map.bounds_to_world(&bounds));
                (u64::from(elements), bounds)
            }
            PrimKind::Instance(instance) => {
                let instance = &group.instances[instance as usize];
                return Self::of_instance(instance, done(instance.group));
            }
        };
        Self {
            elements,
            inner: Aabb::EMPTY,
            all,
        }
    }

    fn of_instance(instance: &InstanceUse, group: &Assembled) -> Self {
        let map = &instance.transform;
        Self {
            elements: group.count,
            inner: map.bounds_to_world(&group.bounds),
            // An instance of an empty group has no elements and is never visited.
            all: if group.reach.is_bounded() || group.reach.is_empty() {
                map.bounds_to_world(&group.reach)
            } else {
                Aabb::EVERYTHING
            },
        }
    }
}

/// Numbers the elements of a group's primitives.
#[derive(Default)]
struct Numbers {
    /// The number of primitives so far, and of their elements.
    prims: u64,
    count: u64,
    /// The first number of each primitive, from when one has not exactly one element.
    first: Option<Vec<u64>>,
}

impl Numbers {
    /// The next primitive, with this many elements.
    fn push(&mut self, elements: u64) -> Result<(), Vec<Diagnostic>> {
        if elements != 1 && self.first.is_none() {
            self.first = Some((0..self.prims).collect());
        }
        if let Some(first) = &mut self.first {
            first.push(self.count);
        }
        self.prims += 1;
        self.count = match self.count.checked_add(elements) {
            Some(count) if count < u64::MAX / 2 => count,
            _ => return Err(too_many("instanced elements: more than 2^63")),
        };
        Ok(())
    }

    fn first_ids(self) -> Option<FirstIds> {
        self.first.map(|first| FirstIds::new(first, self.count))
    }
}
