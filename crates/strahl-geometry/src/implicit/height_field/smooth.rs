//! Normals at the vertices, for smooth shading.

use super::grid::{Grid, SCALE};
use std::sync::Arc;
use strahl_math::{DVec3, Transform};

/// What components of stored normals are multiplied by.
const FULL: f64 = 32767.0;

/// The normals at the vertices of a field.
#[derive(Debug)]
pub(super) struct Normals {
    vertices: Arc<[[i16; 3]]>,
    /// To the space that they are interpolated in; `None` for the unit cube.
    to_world: Option<Box<Transform>>,
}

impl Normals {
    /// The normal of each vertex as POV-Ray 3.7 has it, found by measuring: the sum of the unit normals of the up to four
    /// triangles that a vertex forms with neighbours along x and along z, taken on a grid whose cells are 1 wide and whose heights
    /// run to 65536, cut off to 16 bits.
    ///
    /// On that grid all but flat triangles stand nearly upright, so flat neighbours outweigh steep ones, and slopes have
    /// few digits where the grid is coarse. Both show in its pictures, so both are kept.
    pub(super) fn of(grid: &Grid) -> Self {
        let (width, depth) = grid.size();
        let vertices = (0..depth).flat_map(|j| (0..width).map(move |i| (i, j)));
        Self {
            vertices: vertices.map(|(i, j)| normal(grid, i, j)).collect(),
            to_world: None,
        }
    }

    /// The same, interpolated in another space.
    pub(super) fn seen_from(&self, to_world: &Transform) -> Self {
        Self {
            vertices: Arc::clone(&self.vertices),
            to_world: (!to_world.is_identity()).then(|| Box::new(*to_world)),
        }
    }

    #[cfg(test)]
    pub(super) fn vertices(&self) -> &[[i16; 3]] {
        &self.vertices
    }

    /// The normal at a point of a cell: bilinear between the four vertices, as in POV-Ray (measured), but never on the other side of the
    /// surface.
    pub(super) fn interpolated(
        &self,
        grid: &Grid,
        cell: u32,
        point: DVec3,
        n_geom: DVec3,
    ) -> DVec3 {
        let (columns, rows) = grid.cells();
        let (i, j) = (cell % columns, cell / columns);
        let at = |i: u32, j: u32| {
            let index = j as usize * grid.size().0 as usize + i as usize;
            let n = self.vertices.get(index);
            let n = n.map_or(n_geom, |&n| in_unit_cube(grid, n));
            // Of unit length where they are interpolated.
            self.to_world
                .as_ref()
                .map_or(n, |map| n / map.normal_to_world(n).length())
        };
        let u = point.x * f64::from(columns) - f64::from(i);
        let v = point.z * f64::from(rows) - f64::from(j);
        let near = at(i, j) * (1.0 - u) + at(i + 1, j) * u;
        let far = at(i, j + 1) * (1.0 - u) + at(i + 1, j + 1) * u;
        let n = (near * (1.0 - v) + far * v).normalize_or(n_geom);
        let above = n.dot(n_geom);
        if above >= 0.0 {
            return n;
        }
        (n - n_geom * above).normalize_or(n_geom)
    }
}

fn normal(grid: &Grid, i: u32, j: u32) -> [i16; 3] {
    let (width, depth) = grid.size();
    let height = |i: u32, j: u32| f64::from(grid.height(i, j));
    let here = height(i, j);
    let right = (i + 1 < width).then(|| height(i + 1, j) - here);
    let left = i.checked_sub(1).map(|i| here - height(i, j));
    let up = (j + 1 < depth).then(|| height(i, j + 1) - here);
    let down = j.checked_sub(1).map(|j| here - height(i, j));
    let mut sum = DVec3::ZERO;
    for (along_x, along_z) in [(right, up), (left, up), (left, down), (right, down)] {
        if let (Some(x), Some(z)) = (along_x, along_z) {
            sum += DVec3::new(-x, 1.0, -z).normalize();
        }
    }
    // Casts of floats cut off.
    (sum.normalize_or_zero() * FULL)
        .to_array()
        .map(|c| c as i16)
}

/// A stored normal in the unit cube, of unit length.
fn in_unit_cube(grid: &Grid, normal: [i16; 3]) -> DVec3 {
    let (columns, rows) = grid.cells();
    let [x, y, z] = normal.map(f64::from);
    DVec3::new(x * f64::from(columns), y * SCALE, z * f64::from(rows)).normalize_or(DVec3::Y)
}
