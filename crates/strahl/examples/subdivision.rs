//! A subdivision surface met at its limit, against triangles of the size of a pixel: memory and time.
//!
//! ```sh
//! cargo run --release -p strahl --example subdivision -- 1000
//! ```
//!
//! The number is the width and height of the picture. Both surfaces are asked for the nearest hit of one ray through the
//! middle of each pixel, on one thread; then the hits are compared.

use std::error::Error;
use std::time::Instant;
use strahl::accel::{Accelerator, Bvh2, TraversalStats, Visitor};
use strahl::geometry::{
    MeshData, PrimHit, Primitive, RayShear, Scratch, Subdivision, SubdivisionData,
    SubdivisionScheme, TriangleMesh,
};
use strahl::math::{Aabb, DVec2, DVec3, Interval, Ray};

#[expect(clippy::print_stdout, reason = "it is a program")]
fn main() -> Result<(), Box<dyn Error>> {
    let size: u32 = match std::env::args().nth(1) {
        Some(text) => text.parse()?,
        None => 1000,
    };
    let data = cross();
    let clock = Instant::now();
    let surface = Subdivision::try_new(&data)?;
    println!("{} faces, {size} x {size} rays", data.sizes.len());
    println!("limit:     built in {:.3} s", clock.elapsed().as_secs_f64());
    let clock = Instant::now();
    let scratch = &mut Scratch::default();
    let limits: Vec<Option<f64>> = rays(size)
        .map(|ray| {
            let hit = surface.closest_hit(&ray, Interval::FORWARD, None, scratch);
            hit.map(|hit| hit.t)
        })
        .collect();
    let (seconds, bytes) = (clock.elapsed().as_secs_f64(), surface.bytes());
    println!("limit:     rays in {seconds:.3} s, {bytes} bytes after it");

    let clock = Instant::now();
    // Another one, so that it grows by nothing but rays.
    let mesh = triangles(&Subdivision::try_new(&data)?, pixel(size))?;
    let boxes: Vec<Aabb> = (0..mesh.triangle_count())
        .map(|i| mesh.element_bounds(i))
        .collect();
    let tree = Bvh2::build(&boxes);
    drop(boxes);
    let count = mesh.triangle_count();
    println!(
        "triangles: {count} built in {:.3} s",
        clock.elapsed().as_secs_f64()
    );
    let clock = Instant::now();
    let flat: Vec<Option<f64>> = rays(size)
        .map(|ray| nearest(&mesh, &tree, &ray).map(|hit| hit.t))
        .collect();
    let (seconds, mesh_bytes) = (clock.elapsed().as_secs_f64(), mesh.bytes() + tree.bytes());
    println!("triangles: rays in {seconds:.3} s, {mesh_bytes} bytes");
    println!(
        "memory: {:.1} times as much",
        mesh_bytes as f64 / bytes as f64
    );

    let both = limits.iter().zip(&flat);
    let off = both
        .clone()
        .filter_map(|(a, b)| Some(((*a)? - (*b)?).abs()))
        .fold(0.0, f64::max);
    let differ = both.filter(|(a, b)| a.is_some() != b.is_some()).count();
    println!("the largest distance of two hits is {off:.2e}; {differ} rays meet only one of both");
    Ok(())
}

/// The width of a pixel where the surface is.
fn pixel(size: u32) -> f64 {
    6.4 / f64::from(size)
}

fn rays(size: u32) -> impl Iterator<Item = Ray> {
    let direction = DVec3::new(-0.5, -0.4, -0.8).normalize();
    let right = direction.cross(DVec3::Y).normalize();
    let up = right.cross(direction);
    (0..size * size).map(move |k| {
        let at = |i: u32| (f64::from(i) + 0.5 - 0.5 * f64::from(size)) * pixel(size);
        let place = right * at(k % size) + up * at(k / size);
        Ray::new(place - direction * 20.0, direction)
    })
}

/// A cube of side 2 with an arm on each side; the arms' ends are sharp for two levels.
fn cross() -> SubdivisionData {
    let corner = |i: u32| {
        let at = |bit: u32| f64::from(i >> bit & 1) * 2.0 - 1.0;
        DVec3::new(at(0), at(1), at(2))
    };
    let sides = [
        [0, 4, 6, 2],
        [1, 3, 7, 5],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 2, 3, 1],
        [4, 5, 7, 6],
    ];
    let mut points: Vec<DVec3> = (0..8).map(corner).collect();
    let (mut faces, mut creases) = (vec![], vec![]);
    for side in sides {
        let first = points.len() as u32;
        let outwards = side.iter().map(|i| corner(*i)).sum::<DVec3>() * 0.25;
        points.extend(side.map(|i| corner(i) + outwards * 1.6));
        faces.push([first, first + 1, first + 2, first + 3]);
        for k in 0..4_u32 {
            let next = (k + 1) % 4;
            let (a, b) = (side[k as usize], side[next as usize]);
            faces.push([a, b, first + next, first + k]);
            creases.push(([first + k, first + next], 2.0));
        }
    }
    let mut data = SubdivisionData::new(SubdivisionScheme::CatmullClark, points, faces);
    data.creases = creases;
    data
}

/// Triangles whose sides are no longer than this.
fn triangles(surface: &Subdivision, side: f64) -> Result<TriangleMesh, Box<dyn Error>> {
    let (mut points, mut faces) = (vec![], vec![]);
    for element in 0..surface.elements() {
        let point = |u: f64, v: f64| {
            let jet = surface.at(element, DVec2::new(u, v));
            jet.map_or(DVec3::ZERO, |[point, ..]| point)
        };
        // The longest of some lines across the face.
        let longest = (0..=8)
            .flat_map(|k| [(k, 0), (k, 1)])
            .map(|(k, axis)| {
                let at = |i: i32| {
                    let (x, y) = (f64::from(i) / 8.0, f64::from(k) / 8.0);
                    if axis == 0 { point(x, y) } else { point(y, x) }
                };
                (0..8)
                    .map(|i| (at(i) - at(i + 1)).length())
                    .fold(0.0, f64::max)
                    * 8.0
            })
            .fold(0.0, f64::max);
        let parts = (longest / side).ceil().max(1.0) as u32;
        let first = points.len() as u32;
        for j in 0..=parts {
            for i in 0..=parts {
                let at = |i: u32| f64::from(i) / f64::from(parts);
                points.push(point(at(i), at(j)));
            }
        }
        for k in 0..parts * parts {
            let corner = first + k / parts * (parts + 1) + k % parts;
            let (next, above) = (corner + 1, corner + parts + 1);
            faces.extend([[corner, next, above + 1], [corner, above + 1, above]]);
        }
    }
    Ok(TriangleMesh::try_new(MeshData::from_f64(&points, faces))?)
}

fn nearest(mesh: &TriangleMesh, tree: &Bvh2, ray: &Ray) -> Option<PrimHit> {
    struct Nearest<'a> {
        mesh: &'a TriangleMesh,
        shear: RayShear,
        range: Interval,
        best: Option<PrimHit>,
    }
    impl Visitor for Nearest<'_> {
        fn visit(&mut self, id: u32, t_max: f64) -> f64 {
            match self.mesh.hit_element(id, &self.shear, self.range) {
                Some(hit) => {
                    self.range.max = hit.t;
                    self.best = Some(hit);
                    hit.t
                }
                None => t_max,
            }
        }
    }
    let mut nearest = Nearest {
        mesh,
        shear: RayShear::new(ray),
        range: Interval::FORWARD,
        best: None,
    };
    let range = nearest.range;
    tree.traverse(ray, range, &mut nearest, &mut TraversalStats::default());
    nearest.best
}
