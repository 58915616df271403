use std::collections::HashMap;
use strahl_geometry::MeshData;
use strahl_math::DVec3;

/// Orients triangles consistently with their neighbours, as a solid requires: meshes in scenes may have any winding.
///
/// Neighbours share an edge between equal positions. An edge of one triangle, or of more than two, imposes nothing.
pub(super) fn orient(data: &mut MeshData) {
    let mut places: HashMap<[u32; 3], u32> = HashMap::new();
    let welded: Vec<u32> = data
        .positions
        .iter()
        .enumerate()
        .map(|(index, p)| {
            // Adding 0 turns -0 into 0.
            let bits = p.map(|x| (x + 0.0).to_bits());
            *places.entry(bits).or_insert(index as u32)
        })
        .collect();
    let place = |vertex: u32| welded.get(vertex as usize).copied().unwrap_or(vertex);
    let edges = |face: [u32; 3]| {
        let [a, b, c] = face.map(place);
        [(a, b), (b, c), (c, a)]
    };
    let mut around: HashMap<(u32, u32), Vec<usize>> = HashMap::new();
    for (index, face) in data.indices.iter().enumerate() {
        for (a, b) in edges(*face) {
            around.entry((a.min(b), a.max(b))).or_default().push(index);
        }
    }
    let mut seen = vec![false; data.indices.len()];
    for start in 0..data.indices.len() {
        let mut waiting = vec![start];
        if std::mem::replace(&mut seen[start], true) {
            continue;
        }
        while let Some(index) = waiting.pop() {
            for (a, b) in edges(data.indices[index]) {
                let both = around.get(&(a.min(b), a.max(b)));
                let Some([first, second]) = both.map(Vec::as_slice) else {
                    continue;
                };
                let other = if *first == index { *second } else { *first };
                if std::mem::replace(&mut seen[other], true) {
                    continue;
                }
                // Consistently oriented neighbours have their common edge in opposite directions.
                if edges(data.indices[other]).contains(&(a, b)) {
                    data.indices[other].swap(1, 2);
                }
                waiting.push(other);
            }
        }
    }
}

/// Turns the triangles of a mesh with normals so that their fronts are POV-Ray's (measured): on the side of the normals if they differ, and
/// otherwise on the side to which `(c - a) x (b - a)` points for the corners as they are written.
pub(super) fn turn_to_front(data: &mut MeshData) {
    let MeshData {
        positions,
        indices,
        normals: Some(normals),
        ..
    } = data
    else {
        return;
    };
    let corner = |list: &[[f32; 3]], vertex: u32| {
        let corner = list.get(vertex as usize).copied().unwrap_or_default();
        DVec3::from(corner.map(f64::from))
    };
    for face in indices {
        let n = face.map(|vertex| corner(normals, vertex));
        let [a, b, c] = face.map(|vertex| corner(positions, vertex));
        if n == [n[0]; 3] || (b - a).cross(c - a).dot(n[0] + n[1] + n[2]) < 0.0 {
            face.swap(1, 2);
        }
    }
}
