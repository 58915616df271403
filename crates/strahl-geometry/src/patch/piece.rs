//! What is known of a piece of a patch: a frame in which it is nearly a square, and how curved it is.

use super::hull::{OVERLAP, project};
use super::leaf::{Bounds, Leaf};
use super::net::Net;
use strahl_math::error::{gamma, round_up_f32};
use strahl_math::{Aabb, DMat3, DVec3};

/// Of a piece whose weights differ more from the one in its middle it isn't known how nearly linear it is.
const UNEVEN: f64 = 0.25;
/// Pieces whose frame would stretch them more than this are put into a box along the axes.
const MOST_STRETCHED: f64 = 1e6;

/// A square of the parameters: number `(i, j)` of `2^level` by `2^level`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Square {
    pub(super) level: u8,
    pub(super) i: u8,
    pub(super) j: u8,
}

impl Square {
    pub(super) const WHOLE: Self = Self {
        level: 0,
        i: 0,
        j: 0,
    };

    /// Part number `place` of 4 by 4.
    pub(super) fn sixteenth(self, place: usize) -> Self {
        Self {
            level: self.level + 2,
            i: self.i << 2 | place as u8 & 3,
            j: self.j << 2 | place as u8 >> 2,
        }
    }
}

/// A place on a patch, in steps of 2⁻¹⁶ of both parameters: what the facet of a hit tells of it.
#[derive(Clone, Copy, Debug)]
pub(super) struct PatchPlace {
    u: u32,
    v: u32,
}

impl PatchPlace {
    /// The steps of a parameter.
    const STEPS: u32 = 1 << 16;
    /// How far within a square a place has to be, if the square is as wide as all steps: a sixty-fourth of its width.
    const MARGIN: u32 = Self::STEPS / 64;

    /// The place of parameters from 0 to 1.
    pub(super) fn of([u, v]: [f64; 2]) -> Self {
        let steps = |x: f64| ((x * f64::from(Self::STEPS)) as u32).min(Self::STEPS - 1);
        Self {
            u: steps(u),
            v: steps(v),
        }
    }

    pub(super) fn facet(self) -> u32 {
        self.u | self.v << 16
    }

    pub(super) fn of_facet(facet: u32) -> Self {
        Self {
            u: facet & (Self::STEPS - 1),
            v: facet >> 16,
        }
    }

    /// Whether it is well within a square.
    pub(super) fn is_within(self, Square { level, i, j }: Square) -> bool {
        let within = Self::MARGIN..Self::STEPS - Self::MARGIN;
        [(self.u, i), (self.v, j)]
            .into_iter()
            .all(|(place, number)| {
                let place = place << level;
                place >> 16 == u32::from(number) && within.contains(&(place & (Self::STEPS - 1)))
            })
    }
}

/// Bounds of the lengths of the second derivatives of points, by the parameters of the patch.
#[derive(Clone, Copy, Debug)]
pub(super) struct Curving<T = f64> {
    pub(super) uu: T,
    pub(super) uv: T,
    pub(super) vv: T,
}

impl Curving<f32> {
    pub(super) const NONE: Self = Self {
        uu: 0.0,
        uv: 0.0,
        vv: 0.0,
    };
}

impl Curving {
    /// Scaled and rounded up; also a little, so that it holds beyond the ends of the parameters.
    fn times(self, factor: f64) -> Curving<f32> {
        let up = |x: f64| round_up_f32(x * factor * (1.0 + 1.0 / 1024.0));
        Curving {
            uu: up(self.uu),
            uv: up(self.uv),
            vv: up(self.vv),
        }
    }
}

/// A piece in the coordinates of a tree.
pub(super) struct Piece<const K: usize> {
    points: [[DVec3; K]; K],
    /// In parts of that of the middle.
    weights: [[f64; K]; K],
    /// A bound of the rounding errors of points.
    noise: f64,
}

impl<const K: usize> Piece<K> {
    /// A part of a net, its points in the coordinates `(p - anchor) scale`; it may be `seam` away from what neighbours know of it.
    pub(super) fn new(part: &Net<4, K>, (anchor, scale): (DVec3, f64), seam: f64) -> Self {
        let middle = part.at(0.5, 0.5)[3];
        let mut piece = Self {
            points: [[DVec3::ZERO; K]; K],
            weights: [[1.0; K]; K],
            noise: 0.0,
        };
        let mut largest: f64 = 0.0;
        for (j, row) in part.rows.iter().enumerate() {
            for (i, p) in row.iter().enumerate() {
                let point = project(*p);
                largest = largest.max(point.abs().max_element());
                piece.points[j][i] = (point - anchor) * scale;
                piece.weights[j][i] = p[3] / middle;
            }
        }
        piece.noise = (largest * gamma(16 * K as u32) + seam) * scale;
        piece
    }

    /// The matrix that maps the mean derivatives to the unit vectors of the plane, and the normal of both, as long as they are, to the
    /// third one; column by column.
    fn columns(&self) -> [DVec3; 3] {
        let last = K - 1;
        let (mut by_u, mut by_v) = (DVec3::ZERO, DVec3::ZERO);
        for k in 0..K {
            by_u += self.points[k][last] - self.points[k][0];
            by_v += self.points[last][k] - self.points[0][k];
        }
        let (by_u, by_v) = (by_u / K as f64, by_v / K as f64);
        let normal = by_u.cross(by_v);
        let size = normal.length().sqrt();
        let normal = normal / size;
        let inverse = DMat3::from_cols(by_u, by_v, normal).inverse();
        let columns = [inverse.x_axis, inverse.y_axis, inverse.z_axis];
        let size = by_u.length().max(by_v.length());
        if columns.iter().all(|c| c.length() * size < MOST_STRETCHED) {
            return columns;
        }
        // Nearly a line or a point: along the axes, of the size of the piece.
        let all = Aabb::from_points(self.points.as_flattened().iter().copied());
        let size = all.size().max_element();
        let per = if size > self.noise { 1.0 / size } else { 1.0 };
        DVec3::AXES.map(|axis| axis * per)
    }

    /// The piece as a leaf.
    pub(super) fn leaf(&self) -> (Leaf, Bounds) {
        let columns = self.columns();
        // As they are stored, and so the frame is exact.
        let mut leaf = Leaf::new(columns, DVec3::ZERO);
        let (matrix, _) = leaf.map();
        let mut framed = self.points;
        for p in framed.as_flattened_mut() {
            *p = matrix * *p;
        }
        let (low, high) = extent(&framed);
        leaf = Leaf::new(columns, -0.5 * (low + high));
        let (_, offset) = leaf.map();
        for p in framed.as_flattened_mut() {
            *p += offset;
        }
        let bounds = self.bounds(&leaf, framed);
        leaf.set_bounds(&bounds);
        (leaf, bounds)
    }

    /// What is known of the piece in the frame of a leaf, where its points are these.
    fn bounds(&self, leaf: &Leaf, mut framed: [[DVec3; K]; K]) -> Bounds {
        let (matrix, offset) = leaf.map();
        let (low, high) = extent(&framed);
        let sums = matrix.x_axis.abs() + matrix.y_axis.abs() + matrix.z_axis.abs();
        let noise = (sums + offset.abs()) * (self.noise + gamma(16));
        let beyond = (high - low) * (K as f64 * OVERLAP) + noise;
        let reach = low.abs().max(high.abs()) + beyond;
        let side = reach.x.max(reach.y);
        let mut bounds = Bounds {
            side,
            height: reach.z,
            bend: f64::INFINITY,
            tilt: f64::INFINITY,
        };
        let uneven = self.uneven();
        if !(side < 1.0 && uneven.weight < UNEVEN) {
            return bounds;
        }
        // The derivatives of the numerators, which are points times weights in the frame.
        let (mut off_u, mut off_v) = (DVec3::ZERO, DVec3::ZERO);
        let degree = (K - 1) as f64;
        let weights = self.weights.as_flattened();
        for (p, w) in framed.as_flattened_mut().iter_mut().zip(weights) {
            *p *= *w;
        }
        let at = |j: usize, i: usize| framed[j][i];
        for a in 0..K {
            for b in 1..K {
                off_u = off_u.max(((at(a, b) - at(a, b - 1)) * degree - DVec3::X).abs());
                off_v = off_v.max(((at(b, a) - at(b - 1, a)) * degree - DVec3::Y).abs());
            }
        }
        // Those of the points differ from these by what the weights differ from 1 and change, as points are within the unit square.
        let off = off_u + off_v + noise;
        let least = 1.0 - uneven.weight;
        let along = off.x.max(off.y) + uneven.weight + uneven.slope;
        bounds.bend = along / least;
        bounds.tilt = (off.z + reach.z * uneven.slope) / least;
        bounds
    }

    /// How much weights differ from that in the middle, and the sum of how fast they change by both parameters.
    fn uneven(&self) -> Uneven {
        let all = self.weights.as_flattened().iter();
        if all.clone().all(|w| *w == 1.0) {
            return Uneven {
                weight: 0.0,
                slope: 0.0,
            };
        }
        let weight = all.fold(0.0, |most: f64, w| most.max((w - 1.0).abs()));
        let rates = Rates::of(&self.weights, |w| w.abs());
        let slope = rates.u + rates.v;
        Uneven { weight, slope }
    }

    /// How curved the piece is, which is over a square, by the parameters of the patch.
    pub(super) fn curving_of(&self, square: Square) -> Curving<f32> {
        let per_side = f64::from(1_u32 << square.level);
        self.curving().times(per_side * per_side)
    }

    /// How curved the piece is, by its own parameters.
    fn curving(&self) -> Curving {
        let all = self.points.as_flattened().iter().copied();
        let center = Aabb::from_points(all).center();
        let (mut points, mut reach, mut least) = (self.points, 0.0_f64, f64::INFINITY);
        for (p, w) in points
            .as_flattened_mut()
            .iter_mut()
            .zip(self.weights.as_flattened())
        {
            *p -= center;
            reach = reach.max(p.length());
            least = least.min(*w);
            *p *= *w;
        }
        let p = Rates::of(&points, |p| p.length());
        let w = Rates::of(&self.weights, |w| w.abs());
        // Of a quotient, from the derivatives of its numerator and of the weight.
        let (u, v) = ((p.u + reach * w.u) / least, (p.v + reach * w.v) / least);
        let noise = self.noise * (4 * K * K) as f64;
        Curving {
            uu: (p.uu + 2.0 * u * w.u + reach * w.uu + noise) / least,
            uv: (p.uv + u * w.v + v * w.u + reach * w.uv + noise) / least,
            vv: (p.vv + 2.0 * v * w.v + reach * w.vv + noise) / least,
        }
    }
}

/// The largest derivatives, of the first and the second order, that a polynomial may have.
struct Rates {
    u: f64,
    v: f64,
    uu: f64,
    uv: f64,
    vv: f64,
}

impl Rates {
    fn of<T, const K: usize>(c: &[[T; K]; K], size: impl Fn(T) -> f64) -> Self
    where
        T: Copy + std::ops::Sub<Output = T>,
    {
        let (once, twice) = ((K - 1) as f64, ((K - 1) * (K - 2)) as f64);
        let mut most = Self {
            u: 0.0,
            v: 0.0,
            uu: 0.0,
            uv: 0.0,
            vv: 0.0,
        };
        let step_u = |j: usize, i: usize| c[j][i] - c[j][i - 1];
        let step_v = |j: usize, i: usize| c[j][i] - c[j - 1][i];
        for a in 0..K {
            for b in 1..K {
                most.u = most.u.max(once * size(step_u(a, b)));
                most.v = most.v.max(once * size(step_v(b, a)));
                if b > 1 {
                    let (uu, vv) = (
                        step_u(a, b) - step_u(a, b - 1),
                        step_v(b, a) - step_v(b - 1, a),
                    );
                    most.uu = most.uu.max(twice * size(uu));
                    most.vv = most.vv.max(twice * size(vv));
                }
                if a > 0 {
                    let uv = step_u(a, b) - step_u(a - 1, b);
                    most.uv = most.uv.max(once * once * size(uv));
                }
            }
        }
        most
    }
}

/// The least and the greatest coordinates of points.
fn extent<const K: usize>(points: &[[DVec3; K]; K]) -> (DVec3, DVec3) {
    let Aabb { min, max } = Aabb::EMPTY;
    let (mut low, mut high) = (min, max);
    for p in points.as_flattened() {
        (low, high) = (low.min(*p), high.max(*p));
    }
    (low, high)
}

/// See [`Piece::uneven`].
struct Uneven {
    weight: f64,
    slope: f64,
}
