/// The share of unpolarised light that a smooth boundary between two dielectrics reflects, `0..=1`.
///
/// `eta_1`, `cos_1` belong to the side the light comes from, `eta_2`, `cos_2` to the other (Snell's law is assumed to hold).
/// Fresnel's equations, the mean of both polarisations; Born and Wolf, Principles of Optics, section 1.5.
pub fn fresnel_dielectric(eta_1: f64, cos_1: f64, eta_2: f64, cos_2: f64) -> f64 {
    let (p_den, s_den) = (eta_2 * cos_1 + eta_1 * cos_2, eta_1 * cos_1 + eta_2 * cos_2);
    if p_den == 0.0 || s_den == 0.0 {
        return 1.0;
    }
    let p = (eta_2 * cos_1 - eta_1 * cos_2) / p_den;
    let s = (eta_1 * cos_1 - eta_2 * cos_2) / s_den;
    0.5 * (p * p + s * s)
}

#[cfg(test)]
mod tests {
    use super::fresnel_dielectric;

    #[test]
    fn glass_reflects_four_percent_head_on_and_everything_at_grazing() {
        assert!((fresnel_dielectric(1.0, 1.0, 1.5, 1.0) - 0.04).abs() < 1e-15);
        assert!((fresnel_dielectric(1.0, 0.0, 1.5, (5.0f64 / 9.0).sqrt()) - 1.0).abs() < 1e-15);
        assert_eq!(fresnel_dielectric(1.3, 0.4, 1.3, 0.4), 0.0);
    }
}
