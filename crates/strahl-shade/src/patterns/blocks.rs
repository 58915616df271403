//! Patterns that divide space into blocks and give the number of the block.

use strahl_math::DVec3;

/// `i` modulo `n`, for whole numbers held in f64; 0 for anything else.
fn modulo(i: f64, n: f64) -> usize {
    (i - n * (i / n).floor()) as usize
}

/// Places this near in front of the border of a checker's, cell's or brick's block belong to the block behind it, as in POV-Ray (measured), so
/// that surfaces along the borders show one block.
pub(super) const BORDER: f64 = 1e-10;

pub(super) fn checker(p: DVec3) -> usize {
    let f = (p + BORDER).floor();
    modulo(f.x + f.y + f.z, 2.0).min(1)
}

/// Courses along y; in the odd ones the bricks are shifted by half their length in x, in the even ones in z. The
/// mortar fills the upper end of each brick's box.
pub(super) fn brick(p: DVec3, size: DVec3, mortar: f64) -> usize {
    let b = (p + BORDER) / size;
    let limit = DVec3::ONE - DVec3::splat(mortar) / size;
    let fraction = |x: f64| x - x.floor();
    let odd = modulo(b.y.floor(), 2.0) == 1;
    let (shift_x, shift_z) = if odd { (0.5, 0.0) } else { (0.0, 0.5) };
    let is_mortar = fraction(b.y) >= limit.y
        || fraction(b.x + shift_x) >= limit.x
        || fraction(b.z + shift_z) >= limit.z;
    usize::from(!is_mortar)
}

pub(super) fn square(p: DVec3) -> usize {
    match (modulo(p.x.floor(), 2.0), modulo(p.z.floor(), 2.0)) {
        (0, 0) => 0,
        (0, _) => 1,
        (_, 0) => 3,
        _ => 2,
    }
}

/// Which of the six half axes is nearest.
pub(super) fn cubic(p: DVec3) -> usize {
    let a = p.abs();
    let (axis, coordinate) = if a.x >= a.y && a.x >= a.z {
        (0, p.x)
    } else if a.y >= a.z {
        (1, p.y)
    } else {
        (2, p.z)
    };
    if coordinate < 0.0 { axis + 3 } else { axis }
}

/// √3.
const SQRT_3: f64 = 1.732_050_807_568_877_2;

/// Hexagons of side 1 around the points `i <0, √3> + j <3/2, √3/2>` of the x-z plane; the colour is `i + 2j` modulo 3.
pub(super) fn hexagon(p: DVec3) -> usize {
    // Round to the nearest centre in cube coordinates: three coordinates of sum zero, of which the one
    // rounded worst is made to fit.
    let j = p.x / 1.5;
    let i = p.z / SQRT_3 - 0.5 * j;
    let k = -i - j;
    let (mut ri, mut rj, rk) = (i.round(), j.round(), k.round());
    let (ei, ej, ek) = ((ri - i).abs(), (rj - j).abs(), (rk - k).abs());
    // The edges in the plane z = 0 belong to the hexagons of positive z, as in POV-Ray (measured).
    let is_upper = -rj - rk > ri;
    if ei > ej && (ei > ek || ei == ek && is_upper) {
        ri = -rj - rk;
    } else if ej > ek {
        rj = -ri - rk;
    }
    modulo(ri + 2.0 * rj, 3.0).min(2)
}

/// Triangles of side 1 with a side along x; one rhombus of the lattice holds an upper and a lower one.
pub(super) fn triangular(p: DVec3) -> usize {
    let v = p.z / (0.5 * SQRT_3);
    let u = p.x - 0.5 * v;
    let (iu, iv) = (u.floor(), v.floor());
    let first = (u - iu) + (v - iv) < 1.0;
    match (modulo(iv - iu, 3.0), first) {
        (0, true) => 0,
        (0, false) => 3,
        (1, true) => 2,
        (1, false) => 1,
        (_, true) => 4,
        (_, false) => 5,
    }
}
