//! Groups for the declared objects that instances refer to.

use super::{COPIED, FEW_TRIANGLES, MOST_COPIED, Tally, copy};
use crate::grammar::entity::Declared;
use crate::grammar::texture::{is_same_everywhere, placed};
use std::collections::HashMap;
use std::sync::Arc;
use strahl_math::Transform;
use strahl_scene::{Children, CsgOp, Group, GroupId, Object, ObjectKind, Scene};
use strahl_shade::Material;

/// A declared object with the material that its parts inherit from the use.
type Key = (u32, Option<*const Material>);

/// A material and the numbers of a map.
type PlaceKey = (*const Material, Box<[u64]>);

/// Turns indices of declared objects into groups.
pub(super) struct Linker {
    /// The declared objects; each is `None` after its last variant has taken it.
    objects: Vec<Option<Arc<Declared>>>,
    /// Whether parts of each object inherit their material from the use.
    inherits: Vec<bool>,
    /// All keys in the order of the scene, with their materials.
    variants: Vec<(u32, Option<Arc<Material>>)>,
    /// The number of uses of each variant, and its group once it exists.
    uses: Vec<u32>,
    groups: Vec<Option<GroupId>>,
    known: HashMap<Key, usize>,
    /// Materials in the spaces of uses, by those that they come from, which this keeps alive, and the maps to where those are.
    placed: HashMap<PlaceKey, [Arc<Material>; 2]>,
    /// The number of parts of the variants that have such a material of their own.
    placed_parts: u64,
    /// The number of uses of each declared object within operations that need all its parts.
    whole: Vec<u64>,
    /// How often the parts of each declared object are still needed, for variants and for such operations.
    open: Vec<u64>,
    /// The number of parts that have been copied into groups.
    copied: u64,
}

/// A material that an object inherits.
#[derive(Clone)]
struct Inherited {
    material: Arc<Material>,
    /// From the space of the object to that of the one which has the material; `None` is the identity, and whatever does not matter because the
    /// material is the same everywhere.
    map: Option<Box<Transform>>,
    is_same_everywhere: bool,
}

impl Inherited {
    fn new(material: &Arc<Material>) -> Self {
        Self {
            material: Arc::clone(material),
            map: None,
            is_same_everywhere: is_same_everywhere(material),
        }
    }

    /// What an object has by itself or from the one it is a part of.
    fn of(object: &Object, outer: Option<&Self>) -> Option<Self> {
        if let Some(own) = &object.material {
            return Some(Self::new(own));
        }
        let mut inherited = outer?.clone();
        if let Some(own) = object.transform.as_deref()
            && !inherited.is_same_everywhere
        {
            let map = match &inherited.map {
                Some(map) => own.then(map),
                None => *own,
            };
            inherited.map = Some(Box::new(map));
        }
        Some(inherited)
    }
}

/// A place in which instances are replaced.
#[derive(Clone, Copy)]
struct Place {
    /// Whether an operation around it needs all parts.
    whole: bool,
    /// Whether it is in a group.
    in_group: bool,
    /// Whether it is in a copy: then an object that is used once may be met several times.
    copied: bool,
}

// The pointers are only keys. `variants` keeps the materials alive; the pointers are never dereferenced.
impl Linker {
    pub(super) fn new(objects: Vec<Arc<Declared>>) -> Self {
        let open = vec![0; objects.len()];
        Self {
            inherits: objects.iter().map(|d| d.tally.inherits).collect(),
            objects: objects.into_iter().map(Some).collect(),
            variants: vec![],
            uses: vec![],
            groups: vec![],
            known: HashMap::new(),
            placed: HashMap::new(),
            placed_parts: 0,
            whole: open.clone(),
            open,
            copied: 0,
        }
    }

    /// Counts all uses; returns the number of parts needed by operations other than unions, and by uses with a pattern that lies elsewhere on
    /// each. Those may be too many to count: the number is at least the limit then.
    pub(super) fn count_all(&mut self, scene: &Scene, limit: u64) -> u64 {
        for object in &scene.objects.0 {
            self.count_kind(object, Inherited::of(object, None));
        }
        // Variants used by other variants are appended.
        let mut next = 0;
        while next < self.variants.len() && self.placed_parts <= limit {
            let (id, material) = self.variants[next].clone();
            if let Some(declared) = self.objects.get(id as usize).cloned().flatten() {
                self.count_kind(
                    &declared.entity.object,
                    material.as_ref().map(Inherited::new),
                );
            }
            next += 1;
        }
        // A declared object consists of objects declared before it, which have lower indices.
        let mut wanted = self.placed_parts;
        for id in (0..self.whole.len()).rev() {
            let times = self.whole.get(id).copied().unwrap_or(0);
            let declared = self.objects.get(id).cloned().flatten();
            let Some(declared) = declared.filter(|_| times > 0) else {
                continue;
            };
            wanted = wanted.saturating_add(times.saturating_mul(declared.tally.parts));
            let mut waiting = vec![&declared.entity.object];
            while let Some(object) = waiting.pop() {
                match &object.kind {
                    ObjectKind::Csg { children, .. } => waiting.extend(&children.0),
                    ObjectKind::Instance(inner) => self.use_whole(inner.0, times),
                    ObjectKind::Shape(_) | ObjectKind::Light(_) => {}
                }
            }
        }
        for (open, whole) in self.open.iter_mut().zip(&self.whole) {
            *open = open.saturating_add(*whole);
        }
        wanted
    }

    /// Counts uses of a declared object within operations that need all its parts.
    fn use_whole(&mut self, id: u32, times: u64) {
        if let Some(whole) = self.whole.get_mut(id as usize) {
            *whole = whole.saturating_add(times);
        }
    }

    pub(super) fn link(mut self, scene: &mut Scene) {
        let mut objects = std::mem::take(&mut scene.objects.0);
        let mut waiting = vec![];
        for object in &mut objects {
            self.replace(object, None, false, scene, &mut waiting);
        }
        scene.objects.0 = objects;
        while let Some((group, variant)) = waiting.pop() {
            let Some((id, material)) = self.variants.get(variant).cloned() else {
                continue;
            };
            let mut object = Object::new(self.kind(id));
            object.material = material;
            self.replace(&mut object, None, true, scene, &mut waiting);
            if let Some(group) = scene.groups.get_mut(group) {
                object.name = group.name.clone();
                group.objects.0.push(object);
            }
        }
    }

    /// Counts the instances within an object whose parts inherit this material.
    fn count_kind(&mut self, object: &Object, material: Option<Inherited>) {
        let mut waiting = vec![(object, material, false)];
        while let Some((object, material, whole)) = waiting.pop() {
            match &object.kind {
                ObjectKind::Shape(_) | ObjectKind::Light(_) => {}
                ObjectKind::Csg { op, children } => {
                    let whole = whole || !op.is_union();
                    waiting.extend(children.0.iter().rev().map(|child| {
                        let own = Inherited::of(child, material.as_ref());
                        (child, own, whole)
                    }));
                }
                ObjectKind::Instance(id) if whole => self.use_whole(id.0, 1),
                ObjectKind::Instance(id) => {
                    let variant = self.variant(id.0, material.as_ref());
                    if let Some(uses) = self.uses.get_mut(variant) {
                        *uses = uses.saturating_add(1);
                    }
                }
            }
        }
    }

    /// A material in the space of an object that inherits it: always the same one for equal spaces.
    fn placed(&mut self, inherited: &Inherited) -> Arc<Material> {
        let Inherited { material, map, .. } = inherited;
        let Some(map) = map.as_deref().filter(|map| !map.is_identity()) else {
            return Arc::clone(material);
        };
        let numbers = [
            map.linear().to_cols_array().as_slice(),
            &map.translation().to_array(),
        ]
        .concat();
        let key = (
            Arc::as_ptr(material),
            numbers.iter().map(|n| n.to_bits()).collect(),
        );
        let [_, placed] = self.placed.entry(key).or_insert_with(|| {
            let placed = Arc::new(placed(material, &map.inverted()));
            [Arc::clone(material), placed]
        });
        Arc::clone(placed)
    }

    fn variant(&mut self, id: u32, inherited: Option<&Inherited>) -> usize {
        let inherits = self.inherits.get(id as usize) == Some(&true);
        let inherited = inherited.filter(|_| inherits);
        let material = inherited.map(|inherited| self.placed(inherited));
        let key = (id, material.as_ref().map(Arc::as_ptr));
        *self.known.entry(key).or_insert_with(|| {
            if inherited.is_some_and(|inherited| inherited.map.is_some())
                && let Some(Some(declared)) = self.objects.get(id as usize)
            {
                self.placed_parts = self.placed_parts.saturating_add(declared.tally.parts);
            }
            self.variants.push((id, material));
            self.uses.push(0);
            self.groups.push(None);
            if let Some(open) = self.open.get_mut(id as usize) {
                *open += 1;
            }
            self.variants.len() - 1
        })
    }

    /// Whether copies of a declared object that is needed several times would not share the triangles of a mesh.
    fn has_shared_mesh(&self, id: u32) -> bool {
        let declared = self.objects.get(id as usize).and_then(Option::as_ref);
        let open = self.open.get(id as usize).copied().unwrap_or(0);
        declared.is_some_and(|declared| {
            let Tally {
                parts, elements, ..
            } = declared.tally;
            open > 1 && elements > FEW_TRIANGLES + parts
        })
    }

    /// Whether a declared object has so few parts that its uses may be copies.
    fn is_small(&self, id: u32) -> bool {
        let declared = self.objects.get(id as usize).and_then(Option::as_ref);
        declared.is_some_and(|declared| declared.tally.expanded <= COPIED)
    }

    /// Takes note of a copy within a group, unless there are too many parts or the object has a mesh, whose triangles copies would not share.
    fn copies(&mut self, id: u32) -> bool {
        let declared = self.objects.get(id as usize).and_then(Option::as_ref);
        let Some(Tally {
            parts,
            elements,
            expanded,
            ..
        }) = declared.map(|declared| declared.tally)
        else {
            return false;
        };
        let may = expanded <= COPIED
            && elements <= FEW_TRIANGLES + parts
            && self.copied + expanded <= MOST_COPIED;
        self.copied += if may { expanded } else { 0 };
        may
    }

    /// The kind of a declared object; moved out at its last use, copied otherwise. Small objects are always copied, because copies of others may
    /// use them.
    fn kind(&mut self, id: u32) -> ObjectKind {
        let is_small = self.is_small(id);
        let nothing = Object::csg(CsgOp::Union, vec![]).kind;
        let (Some(slot), Some(open)) = (
            self.objects.get_mut(id as usize),
            self.open.get_mut(id as usize),
        ) else {
            return nothing;
        };
        *open = open.saturating_sub(1);
        let taken = if *open == 0 && !is_small {
            slot.take()
        } else {
            slot.clone()
        };
        match taken.map(Arc::try_unwrap) {
            Some(Ok(declared)) => declared.entity.object.kind,
            Some(Err(declared)) => copy(&declared.entity.object, None).kind,
            None => nothing,
        }
    }

    /// Replaces the instances within an object by instances of the scene's groups, or by objects that are used only here or are copied into a
    /// group. New groups are queued to be filled.
    fn replace(
        &mut self,
        object: &mut Object,
        inherited: Option<Inherited>,
        in_group: bool,
        scene: &mut Scene,
        new: &mut Vec<(usize, usize)>,
    ) {
        let place = Place {
            whole: false,
            in_group,
            copied: false,
        };
        let mut waiting = vec![(object, inherited, place)];
        while let Some((object, inherited, mut place)) = waiting.pop() {
            let material = Inherited::of(object, inherited.as_ref());
            while let ObjectKind::Instance(id) = object.kind {
                if place.whole {
                    object.kind = self.kind(id.0);
                    continue;
                }
                if place.in_group && self.copies(id.0) {
                    place.copied = true;
                    object.kind = self.kind(id.0);
                    continue;
                }
                let variant = self.variant(id.0, material.as_ref());
                let is_shared = self.uses.get(variant).is_some_and(|uses| *uses > 1);
                if place.copied || is_shared || self.has_shared_mesh(id.0) {
                    let id = self.group(variant, &object.name, scene, new);
                    object.kind = ObjectKind::Instance(id);
                    break;
                }
                object.kind = self.kind(id.0);
            }
            if let ObjectKind::Csg { op, children } = &mut object.kind {
                place.whole |= !op.is_union();
                let children = children.0.iter_mut().rev();
                waiting.extend(children.map(|child| (child, material.clone(), place)));
            }
        }
    }

    /// The group of a variant, named after its first use.
    fn group(
        &mut self,
        variant: usize,
        name: &Option<Arc<str>>,
        scene: &mut Scene,
        new: &mut Vec<(usize, usize)>,
    ) -> GroupId {
        let Some(slot) = self.groups.get_mut(variant) else {
            return GroupId(0);
        };
        *slot.get_or_insert_with(|| {
            let index = scene.groups.len();
            scene.groups.push(Group {
                name: name.clone(),
                objects: Children::default(),
            });
            new.push((index, variant));
            GroupId(index as u32)
        })
    }
}
