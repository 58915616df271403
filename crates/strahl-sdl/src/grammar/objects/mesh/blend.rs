use crate::grammar::Texture;
use std::sync::Arc;
use strahl_math::DVec3;
use strahl_shade::texture::{Shares, Texture as Surface};

/// The shares of the textures at the corners of a face: barycentric coordinates, as in POV-Ray (measured).
#[derive(Debug)]
struct ByCorner {
    corners: [DVec3; 3],
    /// The face's normal, divided by its square.
    normal: DVec3,
}

impl Shares for ByCorner {
    fn shares_at(&self, point: DVec3, visit: &mut dyn FnMut(usize, f64)) {
        let [a, b, c] = self.corners.map(|corner| corner - point);
        let opposite = [b.cross(c), c.cross(a), a.cross(b)];
        let shares = opposite.map(|area| area.dot(self.normal).clamp(0.0, 1.0));
        let total: f64 = shares.iter().sum();
        for (number, share) in shares.into_iter().enumerate() {
            if share > 0.0 {
                visit(number, share / total);
            }
        }
    }
}

/// The texture of a face that has one at each corner.
pub(super) fn blended(corners: [DVec3; 3], textures: [&Texture; 3]) -> Texture {
    let [a, b, c] = corners;
    let normal = (b - a).cross(c - a);
    let shares = ByCorner {
        corners,
        normal: normal / normal.length_squared(),
    };
    let members = textures.map(|t| Surface::clone(&t.surface));
    Texture {
        surface: Arc::new(Surface::Shared(Arc::new(shares), members.to_vec().into())),
        ..textures[0].clone()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_are_one_at_corners_and_equal_in_the_middle() {
        let corners = [DVec3::ZERO, DVec3::X * 2.0, DVec3::new(0.0, 3.0, 1.0)];
        let [a, b, c] = corners;
        let normal = (b - a).cross(c - a);
        let shares = ByCorner {
            corners,
            normal: normal / normal.length_squared(),
        };
        let at = |p: DVec3| {
            let mut found = [0.0; 3];
            shares.shares_at(p, &mut |i, share| found[i] = share);
            found
        };
        assert_eq!(at(a), [1.0, 0.0, 0.0]);
        assert_eq!(at(c), [0.0, 0.0, 1.0]);
        let middle = at((a + b + c) / 3.0);
        assert!(
            middle.iter().all(|s| (s - 1.0 / 3.0).abs() < 1e-12),
            "{middle:?}"
        );
        // Rounding may put the point outside of its face.
        let outside = at(b * 1.01);
        assert_eq!(outside, [0.0, 1.0, 0.0]);
    }
}
