//! Whether a mesh encloses a volume: checks of [`Brep`](super::Brep).

use super::{MeshData, TriangleMesh};
use crate::{GeometryError, Primitive};
use std::collections::HashMap;
use strahl_math::{DVec3, error::gamma};

/// For each vertex the first one at the same place.
fn first_at_place(positions: &[[f32; 3]]) -> Vec<u32> {
    let mut places = HashMap::with_capacity(positions.len());
    let number = |(index, position): (usize, &[f32; 3])| {
        // The sum makes one zero of both.
        let place = position.map(|x| (x + 0.0).to_bits());
        *places.entry(place).or_insert(index as u32)
    };
    positions.iter().enumerate().map(number).collect()
}

/// The same mesh with one vertex at each place. For meshes without lists per vertex.
pub(super) fn welded(mut data: MeshData) -> MeshData {
    let first = first_at_place(&data.positions);
    let mut number = vec![0; first.len()];
    let mut kept = Vec::new();
    for (index, position) in data.positions.iter().enumerate() {
        if first[index] as usize == index {
            number[index] = kept.len() as u32;
            kept.push(*position);
        }
    }
    data.positions = kept;
    for v in data.indices.iter_mut().flatten() {
        *v = number[first[*v as usize] as usize];
    }
    data
}

/// Checks that every edge is used as often in one direction as in the other.
pub(super) fn check_closed(mesh: &TriangleMesh) -> Result<(), GeometryError> {
    let first = first_at_place(mesh.positions());
    let mut edges: Vec<(u32, u32, i8)> = Vec::with_capacity(3 * mesh.indices().len());
    for triangle in mesh.indices() {
        let [a, b, c] = triangle.map(|v| first[v as usize]);
        for (from, to) in [(a, b), (b, c), (c, a)] {
            match from.cmp(&to) {
                std::cmp::Ordering::Less => edges.push((from, to, 1)),
                std::cmp::Ordering::Equal => {}
                std::cmp::Ordering::Greater => edges.push((to, from, -1)),
            }
        }
    }
    edges.sort_unstable();

    let (mut open, mut example) = (0u64, None);
    for uses in edges.chunk_by(|x, y| (x.0, x.1) == (y.0, y.1)) {
        let sum: i64 = uses.iter().map(|edge| i64::from(edge.2)).sum();
        if sum != 0 {
            open += sum.unsigned_abs();
            let (a, b, _) = uses[0];
            example = example.or(Some(if sum > 0 { (a, b) } else { (b, a) }));
        }
    }
    let Some((from, to)) = example else {
        return Ok(());
    };
    let edges = if open == 1 { "edge has" } else { "edges have" };
    Err(GeometryError::NotClosed {
        what: "brep",
        why: format!(
            "{open} {edges} no counterpart in the other direction, the first is that from vertex {from} to vertex {to}"
        ),
    })
}

/// Six times the volume, negative if the mesh is inside out; `None` if it is zero up to rounding.
pub(super) fn sixfold_volume(mesh: &TriangleMesh) -> Option<f64> {
    let center = mesh.bounds().center() - mesh.anchor();
    let (mut sum, mut magnitude) = (0.0, 0.0);
    for i in 0..mesh.triangle_count() {
        let [a, b, c] = mesh.local_corners(i).map(|p: DVec3| p - center);
        let part = a.dot(b.cross(c));
        sum += part;
        magnitude += part.abs();
    }
    let volume = if mesh.fronts_are_clockwise() {
        -sum
    } else {
        sum
    };
    let noise = gamma(mesh.triangle_count().saturating_add(8)) * magnitude;
    (volume.abs() > noise).then_some(volume)
}
