use super::header::Scalar;
use super::positions::Positions;
use super::source::{Source, list_length};
use crate::input::report::{Fallible, Report};
use crate::mesh::{Triangulator, polygon_normal};
use strahl_math::DVec3;
use strahl_scene::Diagnostic;

/// Turns lists of vertices into triangles.
#[derive(Default)]
pub(super) struct Faces {
    pub(super) triangles: Vec<[u32; 3]>,
    /// The triangles that continue the polygon of the one before; the others are false or missing at the end.
    continued: Vec<bool>,
    /// The list just read.
    list: Vec<i64>,
    corners: Vec<DVec3>,
    cut: Vec<[u32; 3]>,
    triangulator: Triangulator,
}

impl Faces {
    /// Reads the list of a row.
    #[inline]
    pub(super) fn read_list(
        &mut self,
        scalar: Scalar,
        length: Scalar,
        source: &mut impl Source,
    ) -> Fallible<()> {
        let count = list_length(length, source)?;
        self.list.clear();
        // Grows with what is really there, not with what the length promises.
        for _ in 0..count {
            self.list.push(source.integer(scalar)?);
        }
        Ok(())
    }

    /// Adds the list as a polygon; one without area only counts as a warning.
    pub(super) fn add_polygon(
        &mut self,
        positions: &Positions,
        row: u64,
        report: &mut Report,
    ) -> Result<(), String> {
        let skipped = |report: &mut Report, why: &str| {
            report.count("skipped face", || {
                Diagnostic::warning(format!("face {row} (counted from 0) is left out: {why}"))
            });
        };
        if let [a, b, c] = self.list[..] {
            let triangle = [
                check(a, positions)?,
                check(b, positions)?,
                check(c, positions)?,
            ];
            let corners = triangle.map(|i| positions.at(i));
            if polygon_normal(&corners).is_some() {
                self.triangles.push(triangle);
            } else {
                check_finite(&triangle, positions)?;
                skipped(report, "it has no area");
            }
            return Ok(());
        }
        if self.list.len() < 3 {
            skipped(report, "it has less than three corners");
            return Ok(());
        }
        self.corners.clear();
        for &index in &self.list {
            self.corners.push(positions.at(check(index, positions)?));
        }
        self.cut.clear();
        match self.triangulator.triangulate(&self.corners, &mut self.cut) {
            Ok(()) => {
                // All indices have been checked.
                let at = |corner: u32| self.list[corner as usize] as u32;
                self.continued.resize(self.triangles.len() + 1, false);
                self.triangles.extend(self.cut.iter().map(|t| t.map(at)));
                self.continued.resize(self.triangles.len(), true);
            }
            Err(why) => {
                // All indices have been checked.
                let indices: Vec<_> = self.list.iter().map(|i| *i as u32).collect();
                check_finite(&indices, positions)?;
                skipped(report, why);
            }
        }
        Ok(())
    }

    /// Whether each triangle continues the polygon of the one before, if any does.
    pub(super) fn marks(&mut self) -> Option<Vec<bool>> {
        if self.continued.is_empty() {
            return None;
        }
        self.continued.resize(self.triangles.len(), false);
        Some(std::mem::take(&mut self.continued))
    }

    /// Adds the list as strips with -1 between them. Triangles without area are how strips turn, so they are no news.
    pub(super) fn add_strips(&mut self, positions: &Positions) -> Result<(), String> {
        for strip in self.list.split(|i| *i == -1) {
            for (i, corners) in strip.windows(3).enumerate() {
                let [a, b, c] = [
                    check(corners[0], positions)?,
                    check(corners[1], positions)?,
                    check(corners[2], positions)?,
                ];
                let triangle = if i % 2 == 0 { [a, b, c] } else { [b, a, c] };
                if polygon_normal(&triangle.map(|i| positions.at(i))).is_some() {
                    self.triangles.push(triangle);
                } else {
                    check_finite(&triangle, positions)?;
                }
            }
        }
        Ok(())
    }
}

/// Refuses vertices without a finite position: polygons with them have no area.
#[cold]
fn check_finite(indices: &[u32], positions: &Positions) -> Result<(), String> {
    match indices.iter().find(|i| !positions.at(**i).is_finite()) {
        Some(vertex) => Err(format!(
            "the position of vertex {vertex} is not a finite number"
        )),
        None => Ok(()),
    }
}

#[inline]
fn check(index: i64, positions: &Positions) -> Result<u32, String> {
    match u32::try_from(index) {
        Ok(i) if (i as usize) < positions.len() => Ok(i),
        _ => Err(format!(
            "vertex {index} is out of range: there are {}, numbered from 0",
            positions.len()
        )),
    }
}
