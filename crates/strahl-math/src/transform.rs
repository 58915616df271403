use crate::{Aabb, DMat3, DVec3, Ray};

/// An invertible affine map between an object's space and the space around it, with its inverse.
///
/// A point is taken into object space as `L⁻¹ (p - T)`, with the difference formed first: small objects far from the
/// origin keep all their digits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transform {
    linear: DMat3,
    inverse: DMat3,
    translation: DVec3,
}

/// The matrix given has no usable inverse (its determinant is zero, tiny or not finite).
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the transformation has no inverse (a scale factor is zero, or a value is not finite)")]
pub struct SingularTransform;

impl Default for Transform {
    fn default() -> Self {
        Self::IDENTITY
    }
}

impl Transform {
    /// The map that changes nothing.
    pub const IDENTITY: Self = Self {
        linear: DMat3::IDENTITY,
        inverse: DMat3::IDENTITY,
        translation: DVec3::ZERO,
    };

    /// Moves by `offset`.
    pub const fn translate(offset: DVec3) -> Self {
        Self {
            translation: offset,
            ..Self::IDENTITY
        }
    }

    /// Scales by `factors` about the origin.
    ///
    /// # Errors
    /// [`SingularTransform`] if a factor is zero or not finite.
    pub fn try_scale(factors: DVec3) -> Result<Self, SingularTransform> {
        Self::try_new(DMat3::from_diagonal(factors), DVec3::ZERO)
    }

    /// Rotates by `radians` about an `axis` through the origin, counter-clockwise as seen from the axis' tip in a
    /// right-handed system. The axis need not be a unit vector; the zero axis gives the identity.
    pub fn rotate(axis: DVec3, radians: f64) -> Self {
        let length = axis.length();
        if length == 0.0 || !length.is_finite() {
            return Self::IDENTITY;
        }
        let a = axis / length;
        let (s, c) = crate::det::sin_cos(radians);
        let k = 1.0 - c;
        // Rodrigues' formula, column by column.
        let linear = DMat3::from_cols(
            DVec3::new(
                c + a.x * a.x * k,
                a.y * a.x * k + a.z * s,
                a.z * a.x * k - a.y * s,
            ),
            DVec3::new(
                a.x * a.y * k - a.z * s,
                c + a.y * a.y * k,
                a.z * a.y * k + a.x * s,
            ),
            DVec3::new(
                a.x * a.z * k + a.y * s,
                a.y * a.z * k - a.x * s,
                c + a.z * a.z * k,
            ),
        );
        Self {
            linear,
            inverse: linear.transpose(),
            translation: DVec3::ZERO,
        }
    }

    /// The map `p -> linear * p + translation`.
    ///
    /// # Errors
    /// [`SingularTransform`] if `linear` has no finite inverse or a value is not finite.
    pub fn try_new(linear: DMat3, translation: DVec3) -> Result<Self, SingularTransform> {
        let inverse = linear.inverse();
        let usable = linear.is_finite()
            && inverse.is_finite()
            && translation.is_finite()
            && linear.determinant() != 0.0;
        if usable {
            Ok(Self {
                linear,
                inverse,
                translation,
            })
        } else {
            Err(SingularTransform)
        }
    }

    /// This map followed by `next`.
    #[must_use]
    pub fn then(&self, next: &Self) -> Self {
        Self {
            linear: next.linear * self.linear,
            inverse: self.inverse * next.inverse,
            translation: next.linear * self.translation + next.translation,
        }
    }

    /// The inverse map.
    #[must_use]
    pub fn inverted(&self) -> Self {
        Self {
            linear: self.inverse,
            inverse: self.linear,
            translation: -(self.inverse * self.translation),
        }
    }

    /// The linear part.
    pub fn linear(&self) -> DMat3 {
        self.linear
    }

    /// The linear part of the way back, from outer space into object space.
    pub fn inverse_linear(&self) -> DMat3 {
        self.inverse
    }

    /// The translation.
    pub fn translation(&self) -> DVec3 {
        self.translation
    }

    /// Whether this is exactly the identity.
    pub fn is_identity(&self) -> bool {
        *self == Self::IDENTITY
    }

    /// Whether the linear part is exactly the identity matrix.
    pub fn is_translation(&self) -> bool {
        self.linear == DMat3::IDENTITY
    }

    /// Whether the map mirrors (turns left hands into right hands).
    pub fn mirrors(&self) -> bool {
        self.linear.determinant() < 0.0
    }

    /// A point of object space, in outer space.
    #[inline]
    pub fn point_to_world(&self, p: DVec3) -> DVec3 {
        self.linear * p + self.translation
    }

    /// A vector of object space, in outer space.
    #[inline]
    pub fn vector_to_world(&self, v: DVec3) -> DVec3 {
        self.linear * v
    }

    /// A normal of object space, in outer space: the inverse transpose, not normalised.
    #[inline]
    pub fn normal_to_world(&self, n: DVec3) -> DVec3 {
        self.inverse.transpose() * n
    }

    /// A point of outer space, in object space.
    #[inline]
    pub fn point_to_object(&self, p: DVec3) -> DVec3 {
        self.inverse * (p - self.translation)
    }

    /// A vector of outer space, in object space.
    #[inline]
    pub fn vector_to_object(&self, v: DVec3) -> DVec3 {
        self.inverse * v
    }

    /// A ray of outer space, in object space, with the same parameter `t` (the direction is not renormalised).
    #[inline]
    pub fn ray_to_object(&self, ray: &Ray) -> Ray {
        Ray::new(
            self.point_to_object(ray.origin),
            self.vector_to_object(ray.direction),
        )
    }

    /// Whether boxes along the axes become boxes along noticeably other directions: not if every axis goes to an axis, but for a thousandth.
    pub fn turns_boxes(&self) -> bool {
        let columns = [self.linear.x_axis, self.linear.y_axis, self.linear.z_axis];
        columns.into_iter().any(|column| {
            let column = column.abs();
            let rest = column.element_sum() - column.max_element();
            rest > column.max_element() * 1e-3
        })
    }

    /// An upper bound of the image of an error box: `|L| e`, coordinate by coordinate.
    #[inline]
    pub fn error_to_world(&self, e: DVec3) -> DVec3 {
        let m = self.linear;
        m.x_axis.abs() * e.x + m.y_axis.abs() * e.y + m.z_axis.abs() * e.z
    }

    /// A box around the image of a box. Unbounded boxes with a non-axis-parallel map become unbounded on all the axes
    /// they reach.
    pub fn bounds_to_world(&self, b: &Aabb) -> Aabb {
        if b.is_empty() || self.is_identity() {
            return *b;
        }
        let (mut min, mut max) = (self.translation, self.translation);
        // Arvo, "Transforming axis-aligned bounding boxes", Graphics Gems 1990; 0 * inf counts as 0.
        let product = |m: f64, x: f64| if m == 0.0 { 0.0 } else { m * x };
        for column in 0..3 {
            let c = self.linear.col(column);
            for row in 0..3 {
                let (p, q) = (
                    product(c[row], b.min[column]),
                    product(c[row], b.max[column]),
                );
                min[row] += if p < q { p } else { q };
                max[row] += if p < q { q } else { p };
            }
        }
        // Three products and three sums, each rounded: widen by their bound.
        let magnitude =
            self.translation.abs() + self.error_to_world(finite(b.min.abs().max(b.max.abs())));
        let margin = magnitude * crate::error::gamma(8);
        Aabb::new(min - margin, max + margin)
    }
}

fn finite(v: DVec3) -> DVec3 {
    DVec3::select(v.is_finite_mask(), v, DVec3::ZERO)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample() -> Transform {
        Transform::rotate(DVec3::new(1.0, 2.0, -0.5), 0.7)
            .then(&Transform::try_scale(DVec3::new(2.0, 0.5, -3.0)).expect("regular"))
            .then(&Transform::translate(DVec3::new(5.0, -7.0, 11.0)))
    }

    #[test]
    fn there_and_back_again() {
        let m = sample();
        let p = DVec3::new(0.3, -0.2, 0.9);
        assert!((m.point_to_object(m.point_to_world(p)) - p).length() < 1e-14);
        assert!((m.inverted().point_to_world(m.point_to_world(p)) - p).length() < 1e-14);
        assert!(m.mirrors());
    }

    #[test]
    fn t_is_common_to_both_spaces() {
        let m = sample();
        let ray = Ray::new(DVec3::new(1.0, 2.0, 3.0), DVec3::new(-0.4, 0.1, 0.2));
        let inside = m.ray_to_object(&ray);
        assert!((m.point_to_world(inside.at(3.25)) - ray.at(3.25)).length() < 1e-13);
    }

    #[test]
    fn normals_stay_perpendicular() {
        let m = sample();
        let (n, v) = (DVec3::new(0.0, 0.6, 0.8), DVec3::new(1.0, 0.8, -0.6));
        assert!(n.dot(v).abs() < 1e-15);
        assert!(m.normal_to_world(n).dot(m.vector_to_world(v)).abs() < 1e-13);
    }

    #[test]
    fn a_tiny_object_far_away_keeps_its_digits() {
        let far = Transform::try_scale(DVec3::splat(1e-6))
            .expect("regular")
            .then(&Transform::translate(DVec3::splat(1e9)));
        let p = far.point_to_object(DVec3::splat(1e9 + 2f64.powi(-20)));
        assert!((p - DVec3::splat(2f64.powi(-20) * 1e6)).length() < 1e-15);
    }

    #[test]
    fn singular_maps_are_refused() {
        assert_eq!(
            Transform::try_scale(DVec3::new(1.0, 0.0, 1.0)),
            Err(SingularTransform)
        );
        assert_eq!(
            Transform::try_scale(DVec3::new(1.0, f64::NAN, 1.0)),
            Err(SingularTransform)
        );
    }

    #[test]
    fn image_boxes_contain_the_image() {
        let m = sample();
        let b = Aabb::new(DVec3::new(-1.0, -2.0, -3.0), DVec3::new(1.0, 0.5, 4.0));
        let image = m.bounds_to_world(&b);
        assert!(
            b.corners()
                .iter()
                .all(|c| image.contains(m.point_to_world(*c)))
        );
        let slab = Aabb::new(
            DVec3::new(f64::NEG_INFINITY, 0.0, 0.0),
            DVec3::new(f64::INFINITY, 1.0, 1.0),
        );
        let moved = Transform::translate(DVec3::ONE).bounds_to_world(&slab);
        assert!(moved.max.x == f64::INFINITY && moved.max.y >= 2.0 && moved.max.y < 2.001);
    }
}
