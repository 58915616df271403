use super::flatten::{Flat, FlatGroup};
use super::materials::MaterialTable;
use crate::appearance::{Appearance, Appearances};
use crate::light_sets::Lit;
use crate::prim::{Prim, PrimKind};
use crate::runs::RunList;
use crate::uses::{InstanceUse, MeshUse};
use std::borrow::Cow;
use std::sync::Arc;
use strahl_geometry::{Primitive, Shape};
use strahl_math::{Aabb, DVec3, Transform};

/// An object is small and far if its extent is below this fraction of its largest coordinate: f32 boxes (24 bits) would then
/// leave it fewer than 7 bits.
const SMALL_AND_FAR: f64 = 1.0 / (1 << 17) as f64;

/// The extent of a space of meshes, as a fraction of its largest coordinate: meshes that are smaller keep their vertices relative to an anchor
/// ([`strahl_geometry::MeshData::from_f64`]).
const FAR_MESHES: f64 = 1.0 / 1024.0;

/// Objects of a group that get a space of their own.
struct Space {
    /// The objects, relative to the anchor.
    group: FlatGroup,
    anchor: DVec3,
    /// Where they were in their group.
    members: Vec<u32>,
}

/// Where textures are evaluated.
struct Textures<'a> {
    spaces: &'a mut Vec<Transform>,
    materials: &'a MaterialTable,
}

impl Textures<'_> {
    /// The appearance of an object that has moved from an anchor to the origin of its space: its texture stays where it was.
    fn moved(&mut self, appearance: Appearance, anchor: DVec3) -> Appearance {
        if self.materials.get(appearance.material).texture.is_none() {
            return appearance;
        }
        let home = Transform::translate(-anchor);
        let before = self.spaces.get(appearance.texture_space as usize);
        let space = before.map_or(home, |space| space.then(&home));
        // Neighbours often have the same one.
        if self.spaces.last() != Some(&space) {
            self.spaces.push(space);
        }
        Appearance {
            texture_space: self.spaces.len() as u32 - 1,
            ..appearance
        }
    }
}

/// Moves clusters of small objects far from the origin into spaces of their own: groups whose origin is near them.
///
/// Positions relative to the space's anchor keep all their digits, the f32 boxes of its accelerator are tight, and rays that
/// start in it keep an origin finer than world coordinates can express. The anchor is a coordinate of the objects themselves,
/// so moving them is exact. Without a space the boxes around the triangles of a scanned mesh in coordinates of a map would be as
/// large as the mesh.
pub(super) fn open_spaces(flat: &mut Flat) {
    let groups = flat.groups.len();
    for index in 0..groups {
        let first = flat.groups.len() as u32;
        let group = &mut flat.groups[index];
        let mut textures = Textures {
            spaces: &mut flat.texture_spaces,
            materials: &flat.materials,
        };
        let mut spaces: Vec<Space> = clusters(group)
            .into_iter()
            .map(|cluster| extract(group, cluster, &mut textures))
            .collect();
        spaces.extend(mesh_spaces(group, &mut textures));
        if spaces.is_empty() {
            continue;
        }
        let mut moved = vec![None; group.prims.len()];
        for (number, space) in spaces.iter().enumerate() {
            for (position, prim) in space.members.iter().enumerate() {
                moved[*prim as usize] = Some((number, position == 0));
            }
        }
        let mut prims = RunList::default();
        for (prim, moved) in group.prims.iter().zip(&moved) {
            match moved {
                None => prims.push(prim),
                // The space takes the place of its first member.
                Some((number, true)) => {
                    let transform = Transform::translate(spaces[*number].anchor);
                    group.instances.push(InstanceUse {
                        group: first + *number as u32,
                        transform,
                        lit: Lit::DEFAULT,
                    });
                    let kind = PrimKind::Instance(group.instances.len() as u32 - 1);
                    prims.push(Prim::new(kind, u8::MAX, Prim::STOPS | Prim::TRANSMITS));
                }
                Some((_, false)) => {}
            }
        }
        group.prims = prims;
        flat.groups
            .extend(spaces.into_iter().map(|space| space.group));
    }
}

/// Spaces for the meshes that are small and far and have an anchor. Meshes that are near each other share one.
fn mesh_spaces(group: &FlatGroup, textures: &mut Textures<'_>) -> Vec<Space> {
    let mut spaces: Vec<Space> = vec![];
    // For each mesh its space and its number there.
    let mut places = vec![None; group.meshes.len()];
    for (mesh_use, place) in group.meshes.iter().zip(&mut places) {
        let (anchor, bounds) = (mesh_use.mesh.anchor(), mesh_use.mesh.bounds());
        let reach = bounds.max_abs() * FAR_MESHES;
        if anchor == DVec3::ZERO || !(bounds.size().max_element() < reach) {
            continue;
        }
        let is_near = |space: &Space| (space.anchor - anchor).abs().max_element() < reach;
        let number = spaces.iter().position(is_near);
        let at = number.map_or(anchor, |number| spaces[number].anchor);
        // A mesh that can't be moved stays.
        let Ok(mesh) = mesh_use.mesh.transformed(&Transform::translate(-at)) else {
            continue;
        };
        let number = number.unwrap_or_else(|| {
            spaces.push(Space {
                group: FlatGroup::default(),
                anchor,
                members: vec![],
            });
            spaces.len() - 1
        });
        let meshes = &mut spaces[number].group.meshes;
        *place = Some((number, meshes.len() as u32));
        meshes.push(MeshUse {
            mesh: Arc::new(mesh),
            appearance: textures.moved(mesh_use.appearance, at),
        });
    }
    if spaces.is_empty() {
        return spaces;
    }
    for (index, prim) in group.prims.iter().enumerate() {
        if let PrimKind::Triangle(mesh, triangle) = prim.kind()
            && let Some((number, mesh)) = places[mesh as usize]
        {
            let space = &mut spaces[number];
            let kind = PrimKind::Triangle(mesh, triangle);
            let moved = Prim::new(kind, prim.visible, prim.flags);
            space.group.prims.push(moved);
            space.members.push(index as u32);
        }
    }
    spaces.retain(|space| !space.members.is_empty());
    spaces
}

/// The shapes that are small and far, in clusters; meshes have [spaces of their own](mesh_spaces).
fn clusters(group: &FlatGroup) -> Vec<Vec<u32>> {
    let mut small: Vec<(u32, Aabb)> = Vec::new();
    for (index, prim) in group.prims.iter().enumerate() {
        let Some(shape) = shape(group, prim) else {
            continue;
        };
        let bounds = shape.bounds();
        let far = bounds.max_abs() * SMALL_AND_FAR;
        if bounds.is_bounded()
            && bounds.size().max_element() < far
            && shape.baked(&Transform::translate(DVec3::ONE)).is_some()
        {
            small.push((index as u32, bounds));
        }
    }
    // Sweep along x, then y, then z: objects closer than the threshold of their coordinates belong together.
    let mut clusters = vec![small];
    for axis in 0..3 {
        clusters = clusters
            .into_iter()
            .flat_map(|c| split_at_gaps(c, axis))
            .collect();
    }
    let members = |c: Vec<(u32, Aabb)>| {
        let mut ids: Vec<u32> = c.into_iter().map(|(id, _)| id).collect();
        ids.sort_unstable();
        ids
    };
    let mut lists: Vec<Vec<u32>> = clusters
        .into_iter()
        .map(members)
        .filter(|ids| !ids.is_empty())
        .collect();
    lists.sort();
    lists
}

/// The shape of a primitive that has no transformation of its own; `None` for instances, placed shapes and triangles of meshes.
fn shape(group: &FlatGroup, prim: Prim) -> Option<Cow<'_, Shape>> {
    match prim.kind() {
        PrimKind::Shape(index) => Some(Cow::Borrowed(&group.shapes[index as usize].shape)),
        PrimKind::Sphere(number) => Some(Cow::Owned(group.spheres.loose(number).into())),
        _ => None,
    }
}

/// Splits a list where the next object along an axis would make the cluster too large for one space.
fn split_at_gaps(mut list: Vec<(u32, Aabb)>, axis: usize) -> Vec<Vec<(u32, Aabb)>> {
    list.sort_by(|a, b| a.1.min[axis].total_cmp(&b.1.min[axis]).then(a.0.cmp(&b.0)));
    let mut parts: Vec<Vec<(u32, Aabb)>> = Vec::new();
    let mut start = 0.0;
    for item in list {
        let limit = item.1.max_abs() * SMALL_AND_FAR;
        match parts.last_mut() {
            Some(part) if item.1.max[axis] - start < limit => part.push(item),
            _ => {
                start = item.1.min[axis];
                parts.push(vec![item]);
            }
        }
    }
    parts
}

/// Moves shapes from a group into a new one around an anchor.
fn extract(group: &FlatGroup, members: Vec<u32>, textures: &mut Textures<'_>) -> Space {
    let mut inner = FlatGroup::default();
    let mut anchor = None;
    for id in &members {
        let prim = group.prims.at(*id);
        let Some(shape) = shape(group, prim) else {
            continue;
        };
        let anchor = *anchor.get_or_insert_with(|| shape.bounds().center());
        let home = Transform::translate(-anchor);
        let shape = shape.baked(&home).unwrap_or_else(|| shape.into_owned());
        let appearance = match prim.kind() {
            PrimKind::Shape(index) => group.shapes[index as usize].appearance.clone(),
            PrimKind::Sphere(number) => Appearances::One(group.spheres.appearance(number)),
            _ => continue,
        };
        let appearance = appearance.map(|appearance| textures.moved(appearance, anchor));
        inner.add_shape(shape, appearance, prim.visible, prim.flags);
        if let PrimKind::Shape(index) = prim.kind()
            && let Some(inside) = &group.shapes[index as usize].inside
            && let Some(used) = inner.shapes.last_mut()
        {
            used.inside = inside.moved(&home).map(Box::new);
        }
    }
    Space {
        group: inner,
        anchor: anchor.unwrap_or_default(),
        members,
    }
}
