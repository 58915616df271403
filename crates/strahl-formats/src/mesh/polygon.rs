use earcut::Earcut;
use strahl_math::{DVec2, DVec3};

/// Most corners of a polygon that is not convex: cutting ears takes up to quadratic time.
const MOST_CORNERS: usize = 1 << 16;

/// Why a polygon without area is left out.
pub(crate) const NO_AREA: &str = "it has no area";

/// The vector area of a closed polygon: along the normal by the right-hand rule, of twice the area's length. (M. Newell's
/// method; relative to the first corner, so that distance from the origin costs no digits.)
///
/// `None` if it is zero or not finite: the polygon has no area.
pub(crate) fn polygon_normal(corners: &[DVec3]) -> Option<DVec3> {
    let (first, rest) = corners.split_first()?;
    let mut sum = DVec3::ZERO;
    for pair in rest.windows(2) {
        sum += (pair[0] - *first).cross(pair[1] - *first);
    }
    (sum.is_finite() && sum != DVec3::ZERO).then_some(sum)
}

/// Cuts polygons into triangles that are turned like the polygon.
pub(crate) struct Triangulator {
    ears: Earcut<f64>,
    flat: Vec<DVec2>,
}

impl Default for Triangulator {
    fn default() -> Self {
        Self {
            ears: Earcut::new(),
            flat: vec![],
        }
    }
}

impl std::fmt::Debug for Triangulator {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Triangulator").finish_non_exhaustive()
    }
}

impl Triangulator {
    /// Appends the triangles of a polygon, as numbers of its corners. A convex polygon becomes a fan around its first
    /// corner; of any other, projected along the largest coordinate of its normal, the ears are cut off.
    ///
    /// # Errors
    /// The reason why there are none, in words.
    pub(crate) fn triangulate(
        &mut self,
        corners: &[DVec3],
        out: &mut Vec<[u32; 3]>,
    ) -> Result<(), &'static str> {
        let normal = polygon_normal(corners).ok_or(NO_AREA)?;
        if corners.len() == 3 {
            out.push([0, 1, 2]);
            return Ok(());
        }
        self.project(corners, normal);
        let count = u32::try_from(corners.len()).map_err(|_| "it has too many corners")?;
        if self.is_convex() {
            out.extend((1..count - 1).map(|i| [0, i, i + 1]));
            return Ok(());
        }
        if corners.len() > MOST_CORNERS {
            return Err("it is not convex and has more than 65536 corners");
        }
        let mut cut: Vec<u32> = vec![];
        self.ears
            .earcut(self.flat.iter().map(|p| p.to_array()), &[], &mut cut);
        let before = out.len();
        for ear in cut.as_chunks::<3>().0 {
            let [a, b, c] = ear.map(|i| self.flat[i as usize]);
            // The ears come out in one direction whatever the polygon's is; the projection made that positive.
            let turned = (b - a).perp_dot(c - a);
            if turned > 0.0 {
                out.push(*ear);
            } else if turned < 0.0 {
                out.push([ear[0], ear[2], ear[1]]);
            }
        }
        if out.len() == before {
            Err(NO_AREA)
        } else {
            Ok(())
        }
    }

    /// The polygon in two dimensions, counter-clockwise, within the unit square around its first corner.
    fn project(&mut self, corners: &[DVec3], normal: DVec3) {
        let size = normal.abs();
        let (x, y, z) = if size.x >= size.y && size.x >= size.z {
            (1, 2, 0)
        } else if size.y >= size.z {
            (2, 0, 1)
        } else {
            (0, 1, 2)
        };
        let (x, y) = if normal[z] > 0.0 { (x, y) } else { (y, x) };
        let first = corners[0];
        let extent = corners.iter().fold(0.0_f64, |m, p| {
            let e = (*p - first).abs().max_element();
            if e > m { e } else { m }
        });
        self.flat.clear();
        self.flat.extend(corners.iter().map(|p| {
            let p = (*p - first) / extent;
            DVec2::new(p[x], p[y])
        }));
    }

    /// Whether every corner turns left and every triangle of the fan does (which rules out stars).
    fn is_convex(&self) -> bool {
        let p = &self.flat;
        let left = |a: DVec2, b: DVec2, c: DVec2| (b - a).perp_dot(c - b) > 0.0;
        let corners = (0..p.len()).all(|i| left(p[i], p[(i + 1) % p.len()], p[(i + 2) % p.len()]));
        corners
            && p.windows(2)
                .skip(1)
                .all(|pair| pair.contains(&p[0]) || left(p[0], pair[0], pair[1]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area_of(corners: &[DVec3], triangles: &[[u32; 3]]) -> DVec3 {
        let at = |i: u32| corners[i as usize];
        triangles
            .iter()
            .map(|&[a, b, c]| (at(b) - at(a)).cross(at(c) - at(a)))
            .sum()
    }

    fn points(list: &[[f64; 3]]) -> Vec<DVec3> {
        list.iter().map(|p| DVec3::from_array(*p)).collect()
    }

    #[test]
    fn all_polygons_keep_area_and_side() {
        let square = points(&[
            [0.0, 0.0, 0.0],
            [2.0, 0.0, 0.0],
            [2.0, 2.0, 0.0],
            [0.0, 2.0, 0.0],
        ]);
        let dart = points(&[
            [0.0, 0.0, 0.0],
            [4.0, 0.0, 0.0],
            [1.0, 1.0, 0.0],
            [0.0, 4.0, 0.0],
        ]);
        let ell = points(&[
            [0.0, 1.0, 0.0],
            [0.0, 3.0, 0.0],
            [0.0, 3.0, 1.0],
            [0.0, 2.0, 1.0],
            [0.0, 2.0, 3.0],
            [0.0, 1.0, 3.0],
        ]);
        for polygon in [&square, &dart, &ell] {
            for turned in [polygon.clone(), polygon.iter().rev().copied().collect()] {
                let mut triangles = vec![];
                assert_eq!(
                    Triangulator::default().triangulate(&turned, &mut triangles),
                    Ok(())
                );
                assert_eq!(triangles.len(), turned.len() - 2);
                let (sum, normal) = (
                    area_of(&turned, &triangles),
                    polygon_normal(&turned).expect("area"),
                );
                assert!((sum - normal).length() < 1e-12, "{sum} {normal}");
                assert!(
                    triangles
                        .iter()
                        .all(|t| area_of(&turned, &[*t]).dot(normal) > 0.0)
                );
            }
        }
    }

    #[test]
    fn a_star_is_not_a_fan() {
        // A pentagram turns left at every corner.
        let star: Vec<DVec3> = (0..5)
            .map(|i| f64::from(i) * 0.8 * std::f64::consts::PI)
            .map(|a| DVec3::new(a.cos(), a.sin(), 0.0))
            .collect();
        let mut t = Triangulator::default();
        t.project(&star, DVec3::Z);
        assert!(!t.is_convex());
    }

    #[test]
    fn polygons_without_area_are_refused() {
        let line = points(&[[0.0; 3], [1.0; 3], [2.0; 3], [3.0; 3]]);
        assert_eq!(polygon_normal(&line), None);
        assert!(
            Triangulator::default()
                .triangulate(&line, &mut vec![])
                .is_err()
        );
        assert_eq!(polygon_normal(&[]), None);
        let huge = points(&[[-1e308, 0.0, 0.0], [1e308, 0.0, 0.0], [0.0, 1e308, 0.0]]);
        assert_eq!(polygon_normal(&huge), None);
    }

    #[test]
    fn far_from_the_origin_the_normal_keeps_its_digits() {
        let far = DVec3::splat(1e9);
        let corners = [
            far,
            far + DVec3::X,
            far + DVec3::X + DVec3::Y,
            far + DVec3::Y,
        ];
        assert_eq!(polygon_normal(&corners), Some(DVec3::Z * 2.0));
    }
}
