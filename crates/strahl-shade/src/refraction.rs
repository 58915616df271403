use strahl_math::DVec3;

/// The mirror direction `2 (n·v) n - v` of `v`, both pointing away from the surface; unit length if `n` and `v` are.
#[inline]
pub fn reflect(n: DVec3, v: DVec3) -> DVec3 {
    n * (2.0 * n.dot(v)) - v
}

/// A refracted direction and the angles that belong to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Refracted {
    /// Unit direction in which the light's path goes on behind the surface.
    pub direction: DVec3,
    /// Cosine of the angle between the normal and the arriving ray, `0..=1`.
    pub cos_1: f64,
    /// Cosine of the angle between the reversed normal and the refracted ray, `0..=1`.
    pub cos_2: f64,
}

/// Snell's law, `sin θ1 : sin θ2 = η2 : η1`: the direction `-(η1/η2) v - (cos θ2 - (η1/η2) cos θ1) n`.
///
/// `n` is the unit normal on the side of `v`, the unit direction towards the viewer; `eta` is `η1/η2`, from the side of `v`
/// to the other. `None` on total internal reflection, where `sin θ2` would exceed 1.
#[inline]
pub fn refract(n: DVec3, v: DVec3, eta: f64) -> Option<Refracted> {
    let cos_1 = n.dot(v);
    // 1 - sin²θ2, with sin²θ1 = (1 - cos θ1)(1 + cos θ1): no cancellation near grazing or normal incidence.
    let cos_2_squared = 1.0 - eta * eta * ((1.0 - cos_1) * (1.0 + cos_1));
    if !(cos_2_squared >= 0.0) {
        return None;
    }
    let cos_2 = cos_2_squared.sqrt();
    Some(Refracted {
        direction: -(v * eta) - n * (cos_2 - eta * cos_1),
        cos_1,
        cos_2,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_directions_are_unit_vectors_in_the_plane_of_incidence() {
        let n = DVec3::Z;
        for degrees in [0.0f64, 10.0, 45.0, 80.0, 89.9] {
            let a = degrees.to_radians();
            let v = DVec3::new(a.sin(), 0.0, a.cos());
            let r = reflect(n, v);
            assert!((r - DVec3::new(-v.x, 0.0, v.z)).length() < 1e-15);
            let t = refract(n, v, 1.0 / 1.5).expect("into the denser medium");
            assert!((t.direction.length() - 1.0).abs() < 1e-15);
            assert!((-t.direction.x - a.sin() / 1.5).abs() < 1e-15 && t.direction.z < 0.0);
        }
    }

    #[test]
    fn total_reflection_starts_at_the_critical_angle() {
        let critical = (1.0f64 / 1.5).asin();
        let v = |a: f64| DVec3::new(a.sin(), 0.0, a.cos());
        assert!(refract(DVec3::Z, v(critical - 1e-9), 1.5).is_some());
        assert!(refract(DVec3::Z, v(critical + 1e-9), 1.5).is_none());
    }
}
