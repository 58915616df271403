use crate::GeometryError;
use crate::primitives::frame::{basis, similarity};
use crate::primitives::{check_finite, check_positive, point_error, unit_vector};
use strahl_math::error::gamma;
use strahl_math::{Aabb, DMat3, DVec3, Transform};

/// A source of a blob's field: a ball or a capsule, perhaps stretched.
///
/// At the distance d from its centre (of a capsule: from its axis, or from the nearer end beyond the ends) the field is
/// `strength (1 - d²/radius²)²`, and zero from the radius on.
#[derive(Clone, Debug, PartialEq)]
pub struct BlobComponent {
    strength: f64,
    /// The centre, or the first end of the axis.
    center: DVec3,
    /// From differences from the centre to the unit ball; the axis of a capsule becomes the z axis.
    linear: DMat3,
    /// The factor, if `linear` is a multiple of the identity.
    scale: Option<f64>,
    /// The length of the axis in units of the radius, 0 for balls.
    length: f64,
    radius: f64,
}

/// A ray in a component's own space: `start + s along`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Inner {
    pub(super) start: DVec3,
    pub(super) along: DVec3,
}

/// The part of a ray within a field.
#[derive(Clone, Copy, Debug)]
pub(super) struct Chord {
    pub(super) low: f64,
    pub(super) high: f64,
    /// The field where the ray's line is nearest to the centre or the axis: a bound of it, positive or negative as the component is, but for rounding.
    pub(super) most: f64,
}

/// A part of a component, on which the squared distance is one polynomial of degree 2.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Part {
    /// A ball, or the cap before the first end.
    Ball,
    /// The side of a capsule.
    Side,
    /// The cap behind the second end.
    Tip,
}

impl BlobComponent {
    /// A ball.
    pub fn sphere(center: DVec3, radius: f64, strength: f64) -> Self {
        Self {
            strength,
            center,
            linear: DMat3::from_diagonal(DVec3::splat(1.0 / radius)),
            scale: Some(1.0 / radius),
            length: 0.0,
            radius,
        }
    }

    /// A capsule: a cylinder between two points with a half ball at each end. Without length it is a ball.
    pub fn cylinder(first: DVec3, second: DVec3, radius: f64, strength: f64) -> Self {
        let axis = second - first;
        let z = unit_vector(axis);
        if z == DVec3::ZERO {
            return Self::sphere(first, radius, strength);
        }
        Self {
            strength,
            center: first,
            linear: basis(z).transpose() * (1.0 / radius),
            scale: None,
            length: axis.length() / radius,
            radius,
        }
    }

    /// The component transformed by a map.
    #[must_use]
    pub fn transformed(&self, map: &Transform) -> Self {
        let center = map.point_to_world(self.center);
        // A rotation leaves a ball unchanged.
        if let (Some(scale), Some((factor, _))) = (self.scale, similarity(map)) {
            let scale = scale / factor;
            return Self {
                center,
                linear: DMat3::from_diagonal(DVec3::splat(scale)),
                scale: Some(scale),
                ..self.clone()
            };
        }
        Self {
            center,
            linear: self.linear * map.inverted().linear(),
            scale: None,
            ..self.clone()
        }
    }

    /// The strength of the field at the centre; negative ones repel.
    pub fn strength(&self) -> f64 {
        self.strength
    }

    pub(super) fn validate(&self) -> Result<(), GeometryError> {
        check_positive("radius of the blob component", self.radius)?;
        check_finite("place of the blob component", self.center)?;
        if self.linear.is_finite() && self.strength.is_finite() && self.length.is_finite() {
            return Ok(());
        }
        Err(GeometryError::NotFinite {
            what: "size or strength of the blob component",
        })
    }

    /// The bounds of the region where its field is not zero.
    pub(super) fn bounds(&self) -> Aabb {
        let back = self.linear.inverse();
        // The image of the unit ball reaches as far along each axis as the rows of the map are long.
        let rows = back.transpose();
        let reach = DVec3::new(
            rows.x_axis.length(),
            rows.y_axis.length(),
            rows.z_axis.length(),
        );
        let tip = self.center + back * DVec3::new(0.0, 0.0, self.length);
        let (low, high) = (self.center.min(tip), self.center.max(tip));
        let rounding = point_error(low.abs().max(high.abs()) + reach, reach.max_element(), 16)
            + reach * gamma(64);
        Aabb::new(low - reach, high + reach).padded(rounding)
    }

    /// The center and the radius of a ball around the region where its field is not zero.
    pub(super) fn ball(&self) -> (DVec3, f64) {
        let back = self.linear.inverse();
        let half_axis = back * DVec3::new(0.0, 0.0, 0.5 * self.length);
        // The length of the longest image of a unit vector is the root of the largest eigenvalue, which no sum of a row exceeds.
        let square = back.transpose() * back;
        let [x, y, z] =
            [square.x_axis, square.y_axis, square.z_axis].map(|v| v.abs().element_sum());
        let radius = x.max(y).max(z).sqrt() + half_axis.length();
        (self.center + half_axis, radius)
    }

    /// The box around all points where the field is at least a part of the strength, which must be positive.
    pub(super) fn bounds_of(&self, part: f64) -> Aabb {
        // (1 - d²)² >= part.
        let d = (1.0 - part.sqrt()).max(0.0).sqrt();
        let center = self.center + self.linear.inverse() * DVec3::new(0.0, 0.0, 0.5 * self.length);
        let whole = self.bounds();
        let capsule = whole.size() * 0.5;
        // Of the capsule only the radius becomes smaller, not the axis.
        let axis = (self.linear.inverse() * DVec3::new(0.0, 0.0, 0.5 * self.length)).abs();
        let half = axis + (capsule - axis) * (d * (1.0 + gamma(64)));
        Aabb::new(center - half, center + half).intersection(&whole)
    }

    /// The least and the greatest value of the field in a box.
    pub(super) fn field_in(&self, cell: &Aabb) -> (f64, f64) {
        let middle = self.linear * (cell.center() - self.center);
        let half = cell.size() * 0.5;
        let [x, y, z] = [self.linear.x_axis, self.linear.y_axis, self.linear.z_axis];
        let reach = x.abs() * half.x + y.abs() * half.y + z.abs() * half.z;
        // Along z the distance is that from the axis, which goes from 0 to its length.
        let (low, high) = (middle.z - reach.z, middle.z + reach.z);
        let beyond = |z: f64| (-z).max(z - self.length).max(0.0);
        let nearest = if high < 0.0 || low > self.length {
            beyond(low).min(beyond(high))
        } else {
            0.0
        };
        let across = |least: f64, most: f64| {
            let (x, y) = (middle.x.abs(), middle.y.abs());
            let near = DVec3::new((x - reach.x).max(0.0), (y - reach.y).max(0.0), least);
            let far = DVec3::new(x + reach.x, y + reach.y, most);
            (near.length_squared(), far.length_squared())
        };
        let (near, far) = across(nearest, beyond(low).max(beyond(high)));
        let field = |square: f64| {
            let close = (1.0 - square).max(0.0);
            self.strength * close * close
        };
        let (a, b) = (field(near), field(far));
        (a.min(b), a.max(b))
    }

    /// How much the gradient of the field changes on a way at most, per length: `(1 - d²)²` has second derivatives from -4 to 8.
    pub(super) fn bend(&self) -> f64 {
        let [x, y, z] = [self.linear.x_axis, self.linear.y_axis, self.linear.z_axis];
        let square = x.length_squared() + y.length_squared() + z.length_squared();
        // The length of the longest image of a unit vector; of the identity the sum would be three times as large.
        let longest = self.scale.map_or(square, |scale| scale * scale);
        8.0 * self.strength.abs() * longest
    }

    /// A ray, or a point and a vector, in the component's own space.
    #[inline]
    pub(super) fn inner(&self, start: DVec3, along: DVec3) -> Inner {
        let from_center = start - self.center;
        match self.scale {
            Some(scale) => Inner {
                start: from_center * scale,
                along: along * scale,
            },
            None => Inner {
                start: self.linear * from_center,
                along: self.linear * along,
            },
        }
    }

    /// The intervals of a ray within the field, part by part, with a bound of the field on each.
    #[inline]
    pub(super) fn stretches(&self, inner: &Inner, mut visit: impl FnMut(Part, Chord)) {
        if self.length == 0.0 {
            if let Some(chord) = self.chord(inner.start, inner.along) {
                visit(Part::Ball, chord);
            }
            return;
        }
        let (height, climb) = (inner.start.z, inner.along.z);
        // The ray passes the planes of both ends here, ascending.
        let (first, last) = if climb == 0.0 {
            match height {
                h if h < 0.0 => (f64::INFINITY, f64::INFINITY),
                h if h > self.length => (f64::NEG_INFINITY, f64::NEG_INFINITY),
                _ => (f64::NEG_INFINITY, f64::INFINITY),
            }
        } else {
            let (a, b) = (-height / climb, (self.length - height) / climb);
            if a < b { (a, b) } else { (b, a) }
        };
        let (before, behind) = if climb < 0.0 {
            (Part::Tip, Part::Ball)
        } else {
            (Part::Ball, Part::Tip)
        };
        for (part, from, to) in [
            (before, f64::NEG_INFINITY, first),
            (Part::Side, first, last),
            (behind, last, f64::INFINITY),
        ] {
            let (start, along) = self.metric(part, inner);
            if let Some(mut chord) = self.chord(start, along) {
                chord.low = if chord.low > from { chord.low } else { from };
                chord.high = if chord.high < to { chord.high } else { to };
                if chord.low < chord.high {
                    visit(part, chord);
                }
            }
        }
    }

    /// The part of a line within the unit ball about the origin; for a point (no direction) everything or nothing.
    #[inline]
    fn chord(&self, start: DVec3, along: DVec3) -> Option<Chord> {
        let square = along.length_squared();
        let (middle, close) = if square == 0.0 {
            (0.0, 1.0 - start.length_squared())
        } else {
            let middle = -start.dot(along) / square;
            (middle, 1.0 - (start + along * middle).length_squared())
        };
        // Infinite without a direction; false for NaN, too.
        let half = close / square;
        if !(half > 0.0) {
            return None;
        }
        let half = half.sqrt();
        Some(Chord {
            low: middle - half,
            high: middle + half,
            most: self.strength * close * close,
        })
    }

    /// The vector whose length is the distance on a part: `start + s along`.
    #[inline]
    fn metric(&self, part: Part, inner: &Inner) -> (DVec3, DVec3) {
        let Inner { start, along } = *inner;
        match part {
            Part::Ball => (start, along),
            Part::Side => (
                DVec3::new(start.x, start.y, 0.0),
                DVec3::new(along.x, along.y, 0.0),
            ),
            Part::Tip => (start - DVec3::new(0.0, 0.0, self.length), along),
        }
    }

    /// `1 - d²/radius²` on a part, as a polynomial in s about the start.
    #[inline]
    pub(super) fn closeness(&self, part: Part, inner: &Inner) -> [f64; 3] {
        let (start, along) = self.metric(part, inner);
        [
            1.0 - start.length_squared(),
            -2.0 * start.dot(along),
            -along.length_squared(),
        ]
    }

    /// The part that a point of the component's own space belongs to.
    fn part_at(&self, p: DVec3) -> Part {
        if self.length == 0.0 || p.z < 0.0 {
            Part::Ball
        } else if p.z > self.length {
            Part::Tip
        } else {
            Part::Side
        }
    }

    /// The field at a point and its gradient.
    pub(super) fn field(&self, point: DVec3) -> (f64, DVec3) {
        let inner = self.inner(point, DVec3::ZERO);
        let (p, _) = self.metric(self.part_at(inner.start), &inner);
        let close = 1.0 - p.length_squared();
        if !(close > 0.0) {
            return (0.0, DVec3::ZERO);
        }
        let outward = match self.scale {
            Some(scale) => p * scale,
            None => self.linear.transpose() * p,
        };
        (
            self.strength * close * close,
            outward * (-4.0 * self.strength * close),
        )
    }
}
