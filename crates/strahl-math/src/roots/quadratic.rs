/// The real roots of `a t² + 2 h t + c`, ascending, from its *reduced* discriminant `h² - a c`.
///
/// The caller passes the discriminant because geometry can often compute it without cancellation. The root of larger
/// magnitude comes from `-(h ± √disc)` without cancellation, the other from the product of the roots `c / a`. When `c` is
/// exactly zero (the ray starts on the surface, root identity) one root is exactly zero. With `a == 0` the equation is
/// linear and both entries are its one root. `None` if there is no real root, or every coefficient is zero.
#[inline]
pub fn quadratic(a: f64, h: f64, c: f64, discriminant: f64) -> Option<(f64, f64)> {
    if !(discriminant >= 0.0) {
        return None;
    }
    let s = discriminant.sqrt();
    let q = if h < 0.0 { -h + s } else { -h - s };
    if a == 0.0 {
        if h == 0.0 {
            return None;
        }
        let t = -c / (2.0 * h);
        return Some((t, t));
    }
    if q == 0.0 {
        // h == 0 and disc == 0: a double root at zero.
        return Some((0.0, 0.0));
    }
    let (t0, t1) = (q / a, c / q);
    Some(if t0 <= t1 { (t0, t1) } else { (t1, t0) })
}

#[cfg(test)]
mod tests {
    use super::quadratic;

    #[test]
    fn both_roots_keep_their_digits() {
        // t² - 2e8 t + 1 = 0: the small root is 5e-9, which the textbook formula loses completely.
        let (small, large) = quadratic(1.0, -1e8, 1.0, 1e16 - 1.0).expect("two roots");
        assert!((small - 5e-9).abs() < 1e-22 && (large - 2e8).abs() < 1e-6);
    }

    #[test]
    fn a_start_on_the_surface_is_an_exact_zero() {
        let (a, b) = quadratic(2.0, -3.0, 0.0, 9.0).expect("two roots");
        assert_eq!((a, b), (0.0, 3.0));
        let (a, b) = quadratic(2.0, 3.0, 0.0, 9.0).expect("two roots");
        assert_eq!((a, b), (-3.0, 0.0));
    }

    #[test]
    fn degenerate_equations() {
        assert_eq!(quadratic(0.0, 0.0, 1.0, 0.0), None);
        assert_eq!(quadratic(0.0, 1.0, -4.0, 1.0), Some((2.0, 2.0)));
        assert_eq!(quadratic(1.0, 0.0, 1.0, -1.0), None);
        assert_eq!(quadratic(1.0, 0.0, 0.0, f64::NAN), None);
    }
}
