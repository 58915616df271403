//! The description of a NURBS surface, its checks, and its division into Bezier patches.

use super::part::{Part, Patch, WHOLE};
use super::spline::{Knots, Names, elevated, even};
use super::{check_points, check_weights};
use crate::GeometryError;
use crate::patch::bezier::{Bezier, is_on_a_line};
use crate::patch::hull::project;
use crate::patch::net::Net;
use strahl_math::DVec3;

/// The control net of a NURBS surface with its degrees and knots.
///
/// There are `columns = knots[0].len() - degree[0] - 1` control points in each of the `knots[1].len() - degree[1] - 1` rows; the
/// first parameter runs along the rows, the second from row to row. The surface begins at knot number `degree` and ends at the
/// knot of that number from behind: the first and the last knot of each list have no influence.
#[derive(Clone, Debug, PartialEq)]
pub struct NurbsData {
    /// The degrees along `u` and `v`, from 1 to 9.
    pub degree: [u32; 2],
    /// The knots along `u` and `v`, ascending. Between the ends a knot is repeated at most as often as the degree says.
    pub knots: [Vec<f64>; 2],
    /// The control points, row after row.
    pub points: Vec<DVec3>,
    /// The weights of the control points, greater than 0; none if all are 1.
    pub weights: Vec<f64>,
}

impl NurbsData {
    /// A surface of these degrees that begins and ends at its outer control points, with evenly spaced knots. `points` are rows
    /// of this length.
    pub fn new(degree: [u32; 2], columns: usize, points: Vec<DVec3>) -> Self {
        let rows = points.len() / columns.max(1);
        Self {
            degree,
            knots: [
                even(degree[0] as usize, columns),
                even(degree[1] as usize, rows),
            ],
            points,
            weights: vec![],
        }
    }
}

impl NurbsData {
    /// The part of the surface between two parameters along u and two along v.
    ///
    /// # Errors
    /// The surface is not as its fields say, or a parameter is not one of it.
    pub fn between(&self, ranges: [[f64; 2]; 2]) -> Result<Self, GeometryError> {
        let [u, v] = self.checked()?;
        if [u.domain(), v.domain()] == ranges {
            return Ok(self.clone());
        }
        let points = self.weighted();
        let what = "parameter of the NURBS surface";
        let mut knots = [vec![], vec![]];
        // First the rows, then the columns.
        let mut rows = vec![];
        for row in points.chunks(u.count) {
            let part;
            (knots[0], part) = u.between(ranges[0], row, what)?;
            rows.push(part);
        }
        let mut columns = vec![];
        for i in 0..rows.first().map_or(0, Vec::len) {
            let column: Vec<_> = rows.iter().map(|row| row[i]).collect();
            let part;
            (knots[1], part) = v.between(ranges[1], &column, what)?;
            columns.push(part);
        }
        let count = columns.first().map_or(0, Vec::len);
        let all: Vec<_> = (0..count)
            .flat_map(|j| columns.iter().map(move |column| column[j]))
            .collect();
        Ok(Self {
            degree: self.degree,
            knots,
            points: all.iter().map(|p| project(*p)).collect(),
            weights: if self.is_rational() {
                all.iter().map(|p| p[3]).collect()
            } else {
                vec![]
            },
        })
    }

    fn is_rational(&self) -> bool {
        self.weights.iter().any(|w| *w != self.weights[0])
    }

    /// The control points times their weights, and the weights, of a surface that has been checked.
    fn weighted(&self) -> Vec<[f64; 4]> {
        let is_rational = self.is_rational();
        let weighted = |(i, p): (usize, &DVec3)| {
            if is_rational {
                let w = self.weights[i];
                [p.x * w, p.y * w, p.z * w, w]
            } else {
                [p.x, p.y, p.z, 1.0]
            }
        };
        self.points.iter().enumerate().map(weighted).collect()
    }

    /// The knots, if everything is as it should be.
    fn checked(&self) -> Result<[Knots; 2], GeometryError> {
        let count = |axis: usize| {
            self.knots[axis]
                .len()
                .saturating_sub(self.degree[axis] as usize + 1)
        };
        let (columns, rows) = (count(0), count(1));
        let u = Knots::try_new(self.degree[0], &self.knots[0], columns, &ALONG_U)?;
        let v = Knots::try_new(self.degree[1], &self.knots[1], rows, &ALONG_V)?;
        if columns.checked_mul(rows) != Some(self.points.len()) {
            return Err(GeometryError::WrongCount {
                what: "control points of the NURBS surface",
                expected: columns.saturating_mul(rows) as u64,
                found: self.points.len() as u64,
            });
        }
        check_points(
            self.points.iter().copied(),
            "control point of the NURBS surface",
        )?;
        check_weights(
            &self.weights,
            self.points.len(),
            "weight of the NURBS surface",
            "weights of the NURBS surface",
        )?;
        if is_on_a_line(self.points.iter().copied()) {
            return Err(GeometryError::Degenerate {
                what: "NURBS surface",
                why: "its control points lie on a line",
            });
        }
        Ok([u, v])
    }
}

const ALONG_U: Names = Names {
    degree: "degree of the NURBS surface along u",
    knot: "knot of the NURBS surface along u",
    knots: "knots of the NURBS surface along u",
    points: "columns of control points of the NURBS surface",
};
const ALONG_V: Names = Names {
    degree: "degree of the NURBS surface along v",
    knot: "knot of the NURBS surface along v",
    knots: "knots of the NURBS surface along v",
    points: "rows of control points of the NURBS surface",
};
/// The coefficients of all patches together: 256 MiB.
const MOST_COEFFICIENTS: usize = 1 << 23;

/// The Bezier patches of a surface, each over a rectangle of its parameters, which run from 0 to 1.
pub(super) struct Patches {
    /// Row after row.
    pub(super) parts: Vec<Part>,
    /// The parameters between the patches.
    pub(super) breaks: [Vec<f64>; 2],
    /// The ranges of the parameters before.
    pub(super) domain: [[f64; 2]; 2],
}

impl NurbsData {
    /// Checks the surface and divides it.
    pub(super) fn patches(&self) -> Result<Patches, GeometryError> {
        let [u, v] = self.checked()?;
        let breaks = [u.breaks(), v.breaks()];
        let domain = [u.domain(), v.domain()];
        let parts = match u.degree.max(v.degree) {
            1 | 2 => self.parts::<3>(&u, &v, &breaks),
            3 => self.parts::<4>(&u, &v, &breaks),
            4 | 5 => self.parts::<6>(&u, &v, &breaks),
            6 | 7 => self.parts::<8>(&u, &v, &breaks),
            _ => self.parts::<10>(&u, &v, &breaks),
        }?;
        Ok(Patches {
            parts,
            breaks,
            domain,
        })
    }

    /// The patches with `K` by `K` control points. Neighbours have those of their border in common, to the last bit.
    fn parts<const K: usize>(
        &self,
        u: &Knots,
        v: &Knots,
        breaks: &[Vec<f64>; 2],
    ) -> Result<Vec<Part>, GeometryError> {
        let [across, up] = [breaks[0].len() - 1, breaks[1].len() - 1];
        let most = MOST_COEFFICIENTS / (K * K);
        if across.saturating_mul(up) > most {
            return Err(GeometryError::OutOfRange {
                what: "number of pieces of the NURBS surface",
                expected: "at most 8388608 control points of all pieces together",
                found: across as f64 * up as f64 * (K * K) as f64,
            });
        }
        let is_rational = self.is_rational();
        let rows: Vec<Vec<[f64; 4]>> = self
            .weighted()
            .chunks(u.count)
            .map(|row| u.bezier(row))
            .collect();
        let width = across * u.degree + 1;
        let lines: Vec<Vec<[f64; 4]>> = (0..width)
            .map(|i| {
                let column: Vec<_> = rows.iter().map(|row| row[i]).collect();
                v.bezier(&column)
            })
            .collect();
        drop(rows);
        let mut parts = Vec::with_capacity(across * up);
        for b in 0..up {
            for a in 0..across {
                // Higher degrees keep the border in common, because its new control points are made of its own.
                let columns: Vec<[[f64; 4]; K]> = (a * u.degree..=(a + 1) * u.degree)
                    .map(|i| elevated(lines[i][b * v.degree..=(b + 1) * v.degree].iter().copied()))
                    .collect();
                let rows: [[[f64; 4]; K]; K] =
                    std::array::from_fn(|j| elevated(columns.iter().map(|column| column[j])));
                let mut net = Net { rows };
                if !is_rational {
                    // Rounding must not make it rational.
                    net = net.map(|[x, y, z, _]| [*x, *y, *z, 1.0]);
                }
                let patch: Box<dyn Patch> = Box::new(Bezier::<K>::new(net));
                parts.push(Part {
                    patch,
                    from: [breaks[0][a], breaks[1][b]],
                    to: [breaks[0][a + 1], breaks[1][b + 1]],
                    is_trimmed: false,
                    kept: Some(WHOLE),
                });
            }
        }
        Ok(parts)
    }
}
