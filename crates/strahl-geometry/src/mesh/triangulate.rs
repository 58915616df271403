use super::Polygon;
use super::axes::{largest_axis, other_axes};
use std::collections::{BTreeMap, HashMap};

/// Splits a polygon into triangles that cover it once: indices into [`Polygon::corners`], counter-clockwise as seen from the
/// front.
///
/// Every corner is used, those in the middle of a straight side too, so that triangulated neighbours still share their
/// vertices. Empty for polygons of more than 2³⁰ corners.
pub fn triangulate(polygon: &Polygon) -> Vec<[u32; 3]> {
    let rings: Vec<_> = polygon.rings().map(<[_]>::len).collect();
    if polygon.corners().len() > 1 << 30 {
        return Vec::new();
    }
    let axis = largest_axis(polygon.normal());
    let (i, j) = other_axes(axis);
    let flat: Vec<[f64; 2]> = polygon.corners().iter().map(|p| [p[i], p[j]]).collect();
    let holes: Vec<u32> = rings[..rings.len() - 1]
        .iter()
        .scan(0, |end, len| {
            *end += *len as u32;
            Some(*end)
        })
        .collect();

    let mut indices: Vec<u32> = Vec::new();
    earcut::Earcut::new().earcut_slice(&flat, &holes, &mut indices);
    let mut triangles: Vec<[u32; 3]> = indices
        .chunks_exact(3)
        .map(|t| [t[0], t[1], t[2]])
        .collect();

    // All triangles turn the same way; the picture is seen from the front if the dropped axis points there.
    let area: f64 = triangles
        .iter()
        .map(|t| doubled_area(t.map(|v| flat[v as usize])))
        .sum();
    if (area < 0.0) != (polygon.normal()[axis] < 0.0) {
        triangles.iter_mut().for_each(|t| t.swap(1, 2));
    }
    mend(&mut triangles, &rings, &flat);
    triangles
}

fn doubled_area([a, b, c]: [[f64; 2]; 3]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// The edges of triangles by their ends: the triangle, and the number of the corner it starts at.
type Edges = HashMap<(u32, u32), (usize, usize)>;

/// Ear cutting omits corners on straight sides, and inside it may draw an edge right through a corner. Splits the triangles at
/// such edges.
///
/// The edges of triangles and rings that don't cancel each other form loops without area: a long edge, and on the way back the
/// pieces it should have consisted of.
fn mend(triangles: &mut Vec<[u32; 3]>, ring_lengths: &[usize], flat: &[[f64; 2]]) {
    let place = first_at_place(flat);
    let square = |(a, b): (u32, u32)| {
        let ([ax, ay], [bx, by]) = (flat[a as usize], flat[b as usize]);
        (bx - ax) * (bx - ax) + (by - ay) * (by - ay)
    };
    // A split may reveal another loop, so repeat, but not forever.
    for _ in 0..8 {
        let mut edges = Edges::new();
        for (index, t) in triangles.iter().enumerate() {
            insert_edges(&mut edges, index, t.map(|v| place[v as usize]));
        }
        let open = open_edges(triangles, ring_lengths, &place, &edges);
        let mut progress = false;
        for mut cycle in cycles(&open) {
            let side = |k: usize| (cycle[k], cycle[(k + 1) % cycle.len()]);
            let longest =
                (0..cycle.len()).max_by(|&k, &l| square(side(k)).total_cmp(&square(side(l))));
            let Some(longest) = longest else { continue };
            // The long edge is from the first corner to the second; the others lead back.
            cycle.rotate_left(longest);
            if let Some((index, k)) = edges.remove(&(cycle[0], cycle[1])) {
                let path: Vec<u32> = cycle[2..].iter().rev().copied().collect();
                split(triangles, &mut edges, &place, (index, k), &path);
                progress = true;
            }
        }
        if !progress {
            return;
        }
    }
}

/// For each corner the first one at the same place.
fn first_at_place(flat: &[[f64; 2]]) -> Vec<u32> {
    let mut places = HashMap::with_capacity(flat.len());
    let first = |(index, p): (usize, &[f64; 2])| {
        // The sum turns both zeros into the same one.
        let bits = p.map(|x| (x + 0.0).to_bits());
        *places.entry(bits).or_insert(index as u32)
    };
    flat.iter().enumerate().map(first).collect()
}

fn insert_edges(edges: &mut Edges, index: usize, t: [u32; 3]) {
    for k in 0..3 {
        edges.insert((t[k], t[(k + 1) % 3]), (index, k));
    }
}

/// The edges of the triangles that neither a neighbour nor a ring cancels, and the ring edges without a triangle,
/// reversed.
fn open_edges(
    triangles: &[[u32; 3]],
    ring_lengths: &[usize],
    place: &[u32],
    edges: &Edges,
) -> Vec<(u32, u32)> {
    let mut sum: HashMap<(u32, u32), i32> = HashMap::new();
    let mut add = |a: u32, b: u32, count: i32| {
        if a != b {
            let (key, count) = if a < b {
                ((a, b), count)
            } else {
                ((b, a), -count)
            };
            *sum.entry(key).or_default() += count;
        }
    };
    for t in triangles {
        let t = t.map(|v| place[v as usize]);
        (0..3).for_each(|k| add(t[k], t[(k + 1) % 3], 1));
    }
    let mut start = 0;
    for &length in ring_lengths {
        let ring = &place[start..start + length];
        let sides: Vec<_> = (0..length)
            .map(|k| (ring[k], ring[(k + 1) % length]))
            .collect();
        let along = sides
            .iter()
            .filter(|(a, b)| edges.contains_key(&(*a, *b)))
            .count();
        let against = sides
            .iter()
            .filter(|(a, b)| edges.contains_key(&(*b, *a)))
            .count();
        let sign = if along >= against { -1 } else { 1 };
        sides.iter().for_each(|&(a, b)| add(a, b, sign));
        start += length;
    }
    let mut open: Vec<_> = sum
        .into_iter()
        .filter(|(_, count)| *count != 0)
        .map(|((a, b), count)| if count > 0 { (a, b) } else { (b, a) })
        .collect();
    open.sort_unstable();
    open
}

/// Splits a set of directed edges into simple cycles; dead ends are dropped.
fn cycles(open: &[(u32, u32)]) -> Vec<Vec<u32>> {
    let mut next: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for &(a, b) in open {
        next.entry(a).or_default().push(b);
    }
    let mut cycles = Vec::new();
    for &(start, _) in open {
        let mut path = vec![start];
        let mut last = start;
        while let Some(to) = next.get_mut(&last).and_then(Vec::pop) {
            if let Some(seen) = path.iter().rposition(|&v| v == to) {
                cycles.push(path.split_off(seen));
            }
            path.push(to);
            last = to;
        }
    }
    cycles
}

/// Cuts a triangle from its corner opposite of side `k` to every corner of the path that replaces this side.
fn split(
    triangles: &mut Vec<[u32; 3]>,
    edges: &mut Edges,
    place: &[u32],
    (index, k): (usize, usize),
    path: &[u32],
) {
    let t = triangles[index];
    let (from, to, opposite) = (t[k], t[(k + 1) % 3], t[(k + 2) % 3]);
    let mut last = from;
    for (step, &next) in path.iter().chain([&to]).enumerate() {
        let piece = [last, next, opposite];
        let at = if step == 0 { index } else { triangles.len() };
        if step == 0 {
            triangles[index] = piece;
        } else {
            triangles.push(piece);
        }
        insert_edges(edges, at, piece.map(|v| place[v as usize]));
        last = next;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use strahl_math::{DVec3, Transform};

    fn check(rings: &[&[(f64, f64)]], area: f64) {
        let turn = Transform::rotate(DVec3::new(1.0, -2.0, 0.5), 2.0);
        let space = |ring: &[(f64, f64)]| -> Vec<DVec3> {
            ring.iter()
                .map(|&(x, y)| turn.point_to_world(DVec3::new(x, y, 0.0)))
                .collect()
        };
        let holes: Vec<_> = rings[1..].iter().map(|ring| space(ring)).collect();
        let polygon = Polygon::try_with_holes(&space(rings[0]), &holes).expect("flat");
        let triangles = triangulate(&polygon);
        let corners = polygon.corners();
        let mut sum = 0.0;
        for t in &triangles {
            let [a, b, c] = t.map(|v| corners[v as usize]);
            let signed = 0.5 * (b - a).cross(c - a).dot(polygon.normal());
            assert!(signed > -1e-12, "{t:?} is seen from behind");
            sum += signed;
        }
        assert!((sum - area).abs() < 1e-12, "{sum} instead of {area}");

        // What is left when inner edges cancel is the rings, edge by edge.
        let mut boundary: Vec<_> = triangles
            .iter()
            .flat_map(|t| [0, 1, 2].map(|k| (t[k], t[(k + 1) % 3])))
            .collect();
        let all = boundary.clone();
        boundary.retain(|&(a, b)| !all.contains(&(b, a)));
        boundary
            .iter_mut()
            .for_each(|edge| *edge = (edge.0.min(edge.1), edge.0.max(edge.1)));
        boundary.sort_unstable();
        let mut expected = Vec::new();
        let mut start = 0;
        for ring in polygon.rings() {
            let n = ring.len() as u32;
            expected.extend(
                (0..n)
                    .map(|k| (start + k, start + (k + 1) % n))
                    .map(|(a, b)| (a.min(b), a.max(b))),
            );
            start += n;
        }
        expected.sort_unstable();
        assert_eq!(boundary, expected);
    }

    #[test]
    fn concave_polygons_and_holes_are_covered_once() {
        let l = [
            (0.0, 0.0),
            (4.0, 0.0),
            (4.0, 1.0),
            (1.0, 1.0),
            (1.0, 3.0),
            (0.0, 3.0),
        ];
        check(&[&l], 6.0);
        let clockwise: Vec<_> = l.iter().rev().copied().collect();
        check(&[&clockwise], 6.0);
        let square = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)];
        check(
            &[
                &square,
                &[(1.0, 1.0), (2.0, 1.0), (1.0, 2.0)],
                &[(3.0, 3.0), (2.5, 3.0), (3.0, 2.5)],
            ],
            15.375,
        );
    }

    #[test]
    fn corners_on_straight_sides_are_kept() {
        let square = [
            (0.0, 0.0),
            (1.0, 0.0),
            (2.0, 0.0),
            (4.0, 0.0),
            (4.0, 4.0),
            (2.0, 4.0),
            (0.0, 4.0),
            (0.0, 1.0),
        ];
        check(&[&square], 16.0);
        let clockwise: Vec<_> = square.iter().rev().copied().collect();
        check(&[&clockwise], 16.0);
        check(
            &[&square, &[(1.0, 1.0), (1.0, 1.5), (1.0, 2.0), (2.0, 1.0)]],
            15.5,
        );
    }
}
