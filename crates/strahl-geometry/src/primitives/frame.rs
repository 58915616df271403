use std::f64::consts::PI;
use std::sync::Arc;
use strahl_math::error::gamma;
use strahl_math::{DMat3, DVec3, Transform, det};

/// The axes along which a round shape measures its texture coordinates.
///
/// They follow from the shape's own axis until a rotation is baked; only then is a matrix stored. Shapes stay small: a scene
/// may have millions of them, and few are rotated.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct UvFrame(Option<Arc<DMat3>>);

impl UvFrame {
    /// The directions of angle 0 and of a quarter turn, and the axis itself.
    pub(crate) fn axes(&self, axis: DVec3) -> DMat3 {
        match &self.0 {
            Some(axes) => **axes,
            None => basis(axis),
        }
    }

    /// Whether a rotation was baked in.
    pub(crate) fn is_turned(&self) -> bool {
        self.0.is_some()
    }

    /// The frame after an orthogonal map; `axis` is the axis before it.
    pub(crate) fn turned(&self, axis: DVec3, orthogonal: DMat3) -> Self {
        if orthogonal == DMat3::IDENTITY {
            return self.clone();
        }
        Self(Some(Arc::new(orthogonal * self.axes(axis))))
    }
}

/// A right-handed orthonormal basis whose third axis is the unit vector `n`.
///
/// Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017. For `n = y` it is `(x, -z, y)`.
pub(crate) fn basis(n: DVec3) -> DMat3 {
    let sign = if n.z < 0.0 { -1.0 } else { 1.0 };
    let a = -1.0 / (sign + n.z);
    let b = n.x * n.y * a;
    DMat3::from_cols(
        DVec3::new(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x),
        DVec3::new(b, sign + n.y * n.y * a, -n.y),
        n,
    )
}

/// The angle of the point `(x, y)` as a part of a full turn, `0..=1`.
pub(crate) fn turn(y: f64, x: f64) -> f64 {
    let part = det::atan2(y, x) / (2.0 * PI);
    if part < 0.0 { part + 1.0 } else { part }
}

/// The parts of a similarity: its scale factor (positive) and its orthogonal matrix (a rotation, or a rotation with a
/// reflection). `None` if the linear part stretches or shears by more than the rounding error of a few dozen operations, as a
/// chain of rotations may have.
pub(crate) fn similarity(map: &Transform) -> Option<(f64, DMat3)> {
    let m = map.linear();
    let scale = m.x_axis.length();
    let orthogonal = m * (1.0 / scale);
    if m == DMat3::from_diagonal(DVec3::splat(scale)) {
        return Some((scale, DMat3::IDENTITY));
    }
    let defect = orthogonal.transpose() * orthogonal - DMat3::IDENTITY;
    let limit = gamma(64);
    let small = [defect.x_axis, defect.y_axis, defect.z_axis]
        .iter()
        .all(|c| c.abs().max_element() <= limit);
    small.then_some((scale, orthogonal))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bases_are_orthonormal_and_right_handed() {
        for n in [
            DVec3::X,
            DVec3::Y,
            DVec3::Z,
            -DVec3::Z,
            DVec3::new(0.6, 0.0, -0.8),
            DVec3::new(-0.48, 0.64, 0.6),
        ] {
            let m = basis(n);
            assert!((m.x_axis.cross(m.y_axis) - n).length() < 1e-15, "{n}");
            assert!(
                m.x_axis.dot(m.y_axis).abs() < 1e-15 && (m.x_axis.length() - 1.0).abs() < 1e-15
            );
        }
        assert_eq!(
            basis(DVec3::Y),
            DMat3::from_cols(DVec3::X, -DVec3::Z, DVec3::Y)
        );
    }

    #[test]
    fn similarities_are_recognised() {
        let turn = Transform::rotate(DVec3::new(1.0, -2.0, 0.3), 0.9);
        let scale = |x, y, z| Transform::try_scale(DVec3::new(x, y, z)).expect("regular");
        let (s, m) =
            similarity(&turn.then(&scale(-3.0, 3.0, 3.0)).then(&turn)).expect("a similarity");
        assert!((s - 3.0).abs() < 1e-14 && (m.determinant() + 1.0).abs() < 1e-14);
        assert_eq!(
            similarity(&scale(1e-6, 1e-6, 1e-6)),
            Some((1e-6, DMat3::IDENTITY))
        );
        assert_eq!(similarity(&turn.then(&scale(1.0, 1.0, 1.0 + 1e-9))), None);
    }
}
