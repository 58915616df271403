use super::flatten::{Flat, FlatGroup};
use crate::appearance::Appearances;
use crate::light_sets::Lit;
use crate::prim::{Prim, PrimKind};
use crate::runs::RunList;
use crate::uses::InstanceUse;
use std::borrow::Cow;
use strahl_geometry::{Primitive, Shape};
use strahl_math::{Aabb, DVec3, Transform};

/// An object is small and far if its extent is below this fraction of its largest coordinate: f32 boxes (24 bits) would then
/// leave it fewer than 7 bits.
const SMALL_AND_FAR: f64 = 1.0 / (1 << 17) as f64;

/// Moves clusters of small objects far from the origin into spaces of their own: groups whose origin is near them.
///
/// Positions relative to the space's anchor keep all their digits, the f32 boxes of its accelerator are tight, and rays that
/// start in it keep an origin finer than world coordinates can express. The anchor is a coordinate of the objects themselves,
/// so moving them is exact.
pub(super) fn open_spaces(flat: &mut Flat) {
    let groups = flat.groups.len();
    for index in 0..groups {
        let clusters = clusters(&flat.groups[index]);
        if clusters.is_empty() {
            continue;
        }
        let mut moved = vec![None; flat.groups[index].prims.len()];
        let mut inner_groups = Vec::new();
        for cluster in clusters {
            let (inner, anchor) = extract(&mut flat.groups[index], &cluster);
            for (position, prim) in cluster.iter().enumerate() {
                moved[*prim as usize] = Some((inner_groups.len(), position == 0));
            }
            inner_groups.push((inner, anchor));
        }
        let first = flat.groups.len() as u32;
        let group = &mut flat.groups[index];
        let mut prims = RunList::default();
        for (prim, moved) in group.prims.iter().zip(&moved) {
            match moved {
                None => prims.push(prim),
                // The cluster takes the place of its first member.
                Some((cluster, true)) => {
                    let transform = Transform::translate(inner_groups[*cluster].1);
                    group.instances.push(InstanceUse {
                        group: first + *cluster as u32,
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
            .extend(inner_groups.into_iter().map(|(inner, _)| inner));
    }
}

/// The shapes that are small and far, in clusters. Triangles of meshes are relative to an anchor of their mesh already.
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
fn extract(group: &mut FlatGroup, cluster: &[u32]) -> (FlatGroup, DVec3) {
    let mut inner = FlatGroup::default();
    let mut anchor = None;
    for id in cluster {
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
        inner.add_shape(shape, appearance, prim.visible, prim.flags);
        if let PrimKind::Shape(index) = prim.kind()
            && let Some(inside) = &group.shapes[index as usize].inside
            && let Some(used) = inner.shapes.last_mut()
        {
            used.inside = inside.moved(&home).map(Box::new);
        }
    }
    (inner, anchor.unwrap_or_default())
}
