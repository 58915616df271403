//! Silhouettes against those of dense meshes: how often lines beside them meet the surface, and that their border is one.

use super::*;
use oracle::Mesh;

/// A dense mesh of points of the limit, seen along a direction.
struct Shadow {
    points: Vec<DVec2>,
    triangles: Vec<[u32; 3]>,
    /// Edges between triangles that show different sides, as seen along the direction.
    rims: Vec<[u32; 2]>,
    /// A cell of a grid has the triangles that may be over it.
    cells: Vec<Vec<u32>>,
    low: DVec2,
    size: DVec2,
}

/// Cells of a grid along each side.
const CELLS: usize = 64;

/// Directions across another one.
fn frame(direction: DVec3) -> [DVec3; 2] {
    let right = direction.any_orthonormal_vector();
    [right, direction.cross(right)]
}

impl Shadow {
    /// The limit of a mesh divided so many times.
    fn new(data: &SubdivisionData, levels: u32, direction: DVec3) -> Self {
        let mesh = (0..levels).fold(Mesh::new(data), |mesh, _| mesh.refined());
        let limits = mesh.limits();
        let [right, up] = frame(direction);
        let places = limits.iter().zip(&mesh.points).map(|(limit, point)| {
            let p = limit.unwrap_or(*point);
            DVec2::new(p.dot(right), p.dot(up))
        });
        let points: Vec<DVec2> = places.collect();
        let mut triangles = vec![];
        for face in &mesh.faces {
            let c = &face.corners;
            triangles.extend((2..c.len()).map(|k| [c[0], c[k - 1], c[k]]));
        }
        let (low, high) = points
            .iter()
            .fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), p| {
                (low.min(*p), high.max(*p))
            });
        let mut shadow = Self {
            points,
            triangles,
            rims: vec![],
            cells: vec![vec![]; CELLS * CELLS],
            low,
            size: high - low,
        };
        shadow.find_rims();
        for k in 0..shadow.triangles.len() {
            let corners = shadow.corners(k);
            let low = corners.iter().fold(DVec2::INFINITY, |low, p| low.min(*p));
            let high = corners
                .iter()
                .fold(DVec2::NEG_INFINITY, |high, p| high.max(*p));
            let ([i0, j0], [i1, j1]) = (shadow.cell(low), shadow.cell(high));
            for j in j0..=j1 {
                for i in i0..=i1 {
                    shadow.cells[j * CELLS + i].push(k as u32);
                }
            }
        }
        shadow
    }

    fn corners(&self, triangle: usize) -> [DVec2; 3] {
        self.triangles[triangle].map(|v| self.points[v as usize])
    }

    fn cell(&self, place: DVec2) -> [usize; 2] {
        let part = (place - self.low) / self.size * CELLS as f64;
        part.to_array()
            .map(|x| (x.max(0.0) as usize).min(CELLS - 1))
    }

    fn find_rims(&mut self) {
        let mut sides = std::collections::HashMap::new();
        for k in 0..self.triangles.len() {
            let [a, b, c] = self.corners(k);
            let side = (b - a).perp_dot(c - a) > 0.0;
            let t = self.triangles[k];
            for e in 0..3 {
                let (v, w) = (t[e], t[(e + 1) % 3]);
                let key = [v.min(w), v.max(w)];
                if sides.insert(key, side).is_some_and(|other| other != side) {
                    self.rims.push(key);
                }
            }
        }
    }

    /// How many triangles are over a place.
    fn layers(&self, place: DVec2) -> usize {
        let outside = place.cmplt(self.low).any() || place.cmpgt(self.low + self.size).any();
        if outside {
            return 0;
        }
        let [i, j] = self.cell(place);
        let over = self.cells[j * CELLS + i].iter().filter(|k| {
            let [a, b, c] = self.corners(**k as usize);
            let left = |a: DVec2, b: DVec2| (b - a).perp_dot(place - a) > 0.0;
            left(a, b) == left(b, c) && left(b, c) == left(c, a)
        });
        over.count()
    }

    /// How far a place is from the nearest rim.
    fn distance(&self, place: DVec2) -> f64 {
        let to_edge = |[v, w]: &[u32; 2]| {
            let (a, b) = (self.points[*v as usize], self.points[*w as usize]);
            let along = b - a;
            let part = (place - a).dot(along) / along.length_squared().max(1e-300);
            (a + along * part.clamp(0.0, 1.0) - place).length()
        };
        self.rims.iter().map(to_edge).fold(f64::INFINITY, f64::min)
    }
}

/// A line of sight at a place.
fn sight(direction: DVec3, place: DVec2) -> Ray {
    let [right, up] = frame(direction);
    Ray::new(right * place.x + up * place.y - direction * 8.0, direction)
}

fn subjects() -> Vec<SubdivisionData> {
    let mut all = vec![
        cube(),
        lidded(),
        tetrahedron(CatmullClark),
        tetrahedron(Loop),
    ];
    for around in [3, 5, 8] {
        all.extend([CatmullClark, Loop].map(|scheme| ball(scheme, around, 2, 4)));
    }
    all
}

/// Beside its silhouette, inside and outside, a line meets the surface as often as there are layers of the dense mesh, as soon as it
/// is further from the mesh's own silhouette than the mesh is from the surface.
#[test]
fn lines_beside_a_silhouette_meet_as_many_layers_as_a_dense_mesh_has() {
    let mut random = Random::new(31);
    let levels = 5;
    for (number, data) in subjects().iter().enumerate() {
        let surface = surface(data);
        let mut seen = [0; 2];
        for _ in 0..3 {
            let direction = random.direction();
            let shadow = Shadow::new(data, levels, direction);
            // More than the sag of the sides of the dense mesh, where they are curved most.
            let sag = 4.0_f64.powi(-(levels as i32)) * 2.0;
            for _ in 0..400 {
                let rim = shadow.rims[random.below(shadow.rims.len() as u64) as usize];
                let [a, b] = rim.map(|v| shadow.points[v as usize]);
                let off = DVec2::from_angle(random.between(0.0, std::f64::consts::TAU));
                let place = a.lerp(b, random.unit()) + off * sag * random.between(1.0, 4.0);
                if shadow.distance(place) < sag {
                    continue;
                }
                let expected = shadow.layers(place);
                let ray = sight(direction, place);
                let found = hits(&surface, &ray);
                assert_eq!(
                    found.len(),
                    expected,
                    "subject {number}: {ray:?}, {} from the rim",
                    shadow.distance(place)
                );
                seen[usize::from(expected > 0)] += 1;
            }
        }
        assert!(seen.iter().all(|n| *n > 100), "subject {number}: {seen:?}");
    }
}

/// From the inside of its silhouette to the outside, halved down to 1e-6: the surface is met until it is met no more, at all distances
/// from the border on both sides, and where it ends it is seen from its edge.
#[test]
fn silhouettes_have_one_border() {
    let mut random = Random::new(32);
    let mut wrong = vec![];
    for (number, data) in subjects().iter().enumerate() {
        let surface = surface(data);
        let direction = random.direction();
        for _ in 0..40 {
            let out = DVec2::from_angle(random.between(0.0, std::f64::consts::TAU));
            let at = |way: f64| sight(direction, out * way);
            let (mut inside, mut outside) = (0.0, 4.0);
            for _ in 0..22 {
                let middle = 0.5 * (inside + outside);
                let count = hits(&surface, &at(middle)).len();
                assert!(count % 2 == 0, "subject {number}: {:?}", at(middle));
                if count > 0 {
                    inside = middle;
                } else {
                    outside = middle;
                }
            }
            // Around the border nothing else changes, at any scale.
            for k in 0..10 {
                let step = 2.0_f64.powi(-k) * 1e-3;
                let count = |way: f64| hits(&surface, &at(way)).len();
                let (beyond, within) = (count(outside + step), count(inside - step));
                if beyond != 0 || within == 0 || within % 2 != 0 {
                    wrong.push((number, step, beyond, within, at(inside)));
                }
            }
            let ray = at(inside - 1e-6);
            let list = hits(&surface, &ray);
            let n = surface.surface_at(&ray, &list[0]).n_geom;
            let edge = n.dot(direction).abs();
            // At a crease the silhouette is the crease.
            let is_crease = !data.creases.is_empty();
            assert!(edge < 2e-2 || is_crease, "subject {number}: {edge}");
        }
    }
    assert!(wrong.is_empty(), "{wrong:?}");
}
