use strahl_math::{DVec3, Ray};

/// A coordinate axis: an index that is known to be below 3.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub(crate) enum Axis {
    X,
    Y,
    Z,
}

/// The axes in cyclic order by the last.
static ORDERS: [[Axis; 3]; 3] = [
    [Axis::Y, Axis::Z, Axis::X],
    [Axis::Z, Axis::X, Axis::Y],
    [Axis::X, Axis::Y, Axis::Z],
];

/// The part of a triangle test that all tests of one ray share: the shear that turns the ray into the z axis.
///
/// The axes are permuted cyclically, so that z is the one along which the ray moves fastest, and a corner `v` becomes
/// `(a_x - s_x a_z, a_y - s_y a_z, a_z)` with `a = v - origin`. In this picture the ray is the point `(0, 0)`. The image of
/// a corner depends on the ray and the corner only, so pieces that share a corner agree on where it is.
///
/// S. Woop, C. Benthin, I. Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1), 2013. Unlike there the edge functions
/// are never formed for the decision: their two products are compared (see [`intersect_triangle`]), and everything is f64.
///
/// A ray without a direction, or with NaN or infinite coordinates, hits nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayShear {
    /// The axes in their new order.
    axes: [Axis; 3],
    /// The ray's origin in that order.
    origin: [f64; 3],
    /// `d_x / d_z` and `d_y / d_z`, at most 1 in magnitude.
    shear: [f64; 2],
    /// The largest coordinate of the direction, NaN if the ray is invalid.
    direction_z: f64,
}

impl RayShear {
    /// A shear that hits nothing.
    pub const UNUSED: Self = Self {
        axes: [Axis::X, Axis::Y, Axis::Z],
        origin: [f64::NAN; 3],
        shear: [f64::NAN; 2],
        direction_z: f64::NAN,
    };

    /// The shear of a ray: once per ray and space.
    ///
    /// Always inlined: returned through memory, it would be stored number by number and loaded in larger pieces, and such a
    /// load waits for the stores.
    #[inline(always)]
    pub fn new(ray: &Ray) -> Self {
        let size = ray.direction.abs();
        // No branches: the axis can't be predicted.
        let of_y_and_z = usize::from(!(size.y >= size.z)) + 1;
        let x_is_largest = (size.x >= size.y) & (size.x >= size.z);
        let axes = &ORDERS[if x_is_largest { 0 } else { of_y_and_z }];
        let [x, y, z] = [axes[0] as usize, axes[1] as usize, axes[2] as usize];
        let (origin, d): (&[f64; 3], &[f64; 3]) = (ray.origin.as_ref(), ray.direction.as_ref());
        // An infinite coordinate is the largest one; and NaN makes one of the slopes NaN.
        let usable = (d[z] != 0.0) & (d[z].abs() <= f64::MAX);
        let direction_z = if usable { d[z] } else { f64::NAN };
        Self {
            axes: *axes,
            origin: [origin[x], origin[y], origin[z]],
            shear: [d[x] / direction_z, d[y] / direction_z],
            direction_z,
        }
    }

    /// The axes in their new order: the ray moves fastest along the last.
    #[inline(always)]
    pub(crate) const fn axes(&self) -> [Axis; 3] {
        self.axes
    }

    /// The ray's origin in that order.
    #[inline(always)]
    pub(crate) const fn origin(&self) -> [f64; 3] {
        self.origin
    }

    /// The shear in x and y per unit of z.
    #[inline(always)]
    pub(crate) const fn slope(&self) -> [f64; 2] {
        self.shear
    }

    /// The component of the ray's direction along the last axis.
    #[inline(always)]
    pub(crate) const fn direction_z(&self) -> f64 {
        self.direction_z
    }

    /// The shear of the same ray for corners that are given relative to `anchor`.
    #[inline]
    #[must_use]
    pub fn relative_to(&self, anchor: DVec3) -> Self {
        let mut moved = *self;
        for (o, k) in moved.origin.iter_mut().zip(self.axes) {
            *o -= anchor[k as usize];
        }
        moved
    }

    /// The image of a corner: x and y across the ray, z along it, unscaled.
    #[inline]
    pub fn apply(&self, corner: &DVec3) -> DVec3 {
        let corner: &[f64; 3] = corner.as_ref();
        self.sheared(|k| corner[self.axes[k] as usize])
    }

    /// The image of a corner that is stored in f32; the conversion is exact.
    #[inline]
    pub fn apply_f32(&self, corner: &[f32; 3]) -> DVec3 {
        self.sheared(|k| f64::from(corner[self.axes[k] as usize]))
    }

    /// Coordinates are loaded one by one: a branch on the axis would be mispredicted at every change of ray.
    #[inline]
    fn sheared(&self, corner: impl Fn(usize) -> f64) -> DVec3 {
        let along = |k: usize| corner(k) - self.origin[k];
        let z = along(2);
        DVec3::new(
            along(0) - self.shear[0] * z,
            along(1) - self.shear[1] * z,
            z,
        )
    }

    /// The ray parameter of a point of the image.
    #[inline]
    pub fn parameter(&self, z: f64) -> f64 {
        z / self.direction_z
    }

    /// Whether the front of a triangle with counter-clockwise (`true`) or clockwise image is visible: the side of its
    /// right-handed normal.
    #[inline]
    pub(crate) fn shows_front(&self, counter_clockwise: bool) -> bool {
        // Seen along the z axis the image is mirrored, so fronts are clockwise.
        counter_clockwise != (self.direction_z > 0.0)
    }
}

/// Where a ray meets a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TriangleHit {
    /// Ray parameter.
    pub t: f64,
    /// Barycentric coordinate of the second corner.
    pub u: f64,
    /// Barycentric coordinate of the third corner; that of the first is 1 - u - v.
    pub v: f64,
}

/// The one ray-triangle test: both sides are hit, edges and corners belong to the triangle.
///
/// Watertight: whether the ray passes left or right of an edge is decided by comparing two products, and the neighbouring
/// triangle compares the same two in reverse. Rounding is monotone, so a comparison of rounded products never contradicts that
/// of the exact ones; it can only become a tie, and then both triangles accept. A triangle seen edge-on, without any area in
/// the ray's projection, is missed.
#[inline]
pub fn intersect_triangle(shear: &RayShear, a: DVec3, b: DVec3, c: DVec3) -> Option<TriangleHit> {
    let [a, b, c] = [a, b, c].map(|p| shear.apply(&p));
    intersect_sheared(shear, a, b, c)
}

/// [`intersect_triangle`] on the images of the corners.
#[inline]
pub(crate) fn intersect_sheared(
    shear: &RayShear,
    a: DVec3,
    b: DVec3,
    c: DVec3,
) -> Option<TriangleHit> {
    let (u0, u1) = (b.x * c.y, b.y * c.x);
    let (v0, v1) = (c.x * a.y, c.y * a.x);
    let (w0, w1) = (a.x * b.y, a.y * b.x);
    // No early exit: which comparison fails first can't be predicted, but that one fails can.
    let counter_clockwise = (u0 >= u1) & (v0 >= v1) & (w0 >= w1);
    let clockwise = (u0 <= u1) & (v0 <= v1) & (w0 <= w1);
    if !(counter_clockwise | clockwise) {
        return None;
    }
    let weights = DVec3::new(u0 - u1, v0 - v1, w0 - w1);
    let products = (u0.abs() + u1.abs()) + (v0.abs() + v1.abs()) + (w0.abs() + w1.abs());
    place(shear, [a, b, c], weights, products)
}

/// Below this part of its products an edge function has lost too many digits to place a hit.
pub(crate) const LOST_DIGITS: f64 = 1.0 / 256.0;

/// The hit from the edge functions `weights`, which all have one sign up to rounding.
#[inline]
pub(super) fn place(
    shear: &RayShear,
    [a, b, c]: [DVec3; 3],
    weights: DVec3,
    products: f64,
) -> Option<TriangleHit> {
    let mut weights = weights;
    let mut area = weights.x + weights.y + weights.z;
    if area.abs() < products * LOST_DIGITS {
        weights = careful_weights(a, b, c);
        area = weights.x + weights.y + weights.z;
    }
    let (u, v) = (weights.y / area, weights.z / area);
    // From corner to corner rather than as a weighted sum: exact for triangles across an axis.
    let t = shear.parameter(a.z + (u * (b.z - a.z) + v * (c.z - a.z)));
    // No area, or coordinates beyond the range of f64.
    (t.is_finite() && area != 0.0).then_some(TriangleHit { t, u, v })
}

/// The edge functions of a sliver, exact to the last digit. A point that is inside only because of rounding is moved to the
/// edge.
#[cold]
fn careful_weights(a: DVec3, b: DVec3, c: DVec3) -> DVec3 {
    let weights = DVec3::new(exact_cross(b, c), exact_cross(c, a), exact_cross(a, b));
    let area = weights.x + weights.y + weights.z;
    let keep = |w: f64| if (w < 0.0) == (area < 0.0) { w } else { 0.0 };
    DVec3::new(keep(weights.x), keep(weights.y), keep(weights.z))
}

/// `a.x b.y - a.y b.x` with a relative error of a few roundoffs however much cancels, hence with its exact sign (as long
/// as nothing underflows).
pub(super) fn exact_cross(a: DVec3, b: DVec3) -> f64 {
    let (p, p_rest) = exact_product(a.x, b.y);
    let (q, q_rest) = exact_product(a.y, b.x);
    // If p and q are close enough to cancel, their difference is exact (Sterbenz).
    (p - q) + (p_rest - q_rest)
}

/// A product and its rounding error. (Dekker, "A floating-point technique for extending the available precision",
/// Numerische Mathematik 18, 1971.)
fn exact_product(x: f64, y: f64) -> (f64, f64) {
    let split = |x: f64| {
        let big = x * 134_217_729.0; // 2^27 + 1
        let high = big - (big - x);
        (high, x - high)
    };
    let ((xh, xl), (yh, yl)) = (split(x), split(y));
    let product = x * y;
    let rest = ((xh * yh - product) + xh * yl + xl * yh) + xl * yl;
    (product, rest)
}

#[cfg(test)]
mod tests {
    use super::*;

    const CORNERS: [DVec3; 3] = [
        DVec3::new(0.0, 0.0, 5.0),
        DVec3::new(4.0, 0.0, 5.0),
        DVec3::new(0.0, 2.0, 5.0),
    ];

    fn test(origin: DVec3, direction: DVec3) -> Option<TriangleHit> {
        let [a, b, c] = CORNERS;
        intersect_triangle(&RayShear::new(&Ray::new(origin, direction)), a, b, c)
    }

    #[test]
    fn a_hit_is_placed_exactly() {
        let expected = Some(TriangleHit {
            t: 2.5,
            u: 0.25,
            v: 0.5,
        });
        assert_eq!(test(DVec3::new(1.0, 1.0, 0.0), DVec3::Z * 2.0), expected);
        let behind = test(DVec3::new(1.0, 1.0, 0.0), DVec3::Z * -2.0);
        assert_eq!(behind.map(|hit| hit.t), Some(-2.5));
        assert_eq!(test(DVec3::new(2.1, 1.0, 0.0), DVec3::Z), None);
    }

    #[test]
    fn edges_and_corners_belong_to_the_triangle_edge_on_is_a_miss() {
        for target in [
            CORNERS[0],
            CORNERS[1],
            CORNERS[2],
            DVec3::new(2.0, 1.0, 5.0),
        ] {
            assert!(test(target - DVec3::Z * 5.0, DVec3::Z).is_some());
        }
        assert_eq!(test(DVec3::new(-1.0, 0.5, 5.0), DVec3::X), None);
        assert_eq!(test(DVec3::new(1.0, 1.0, 0.0), DVec3::ZERO), None);
        assert_eq!(
            test(DVec3::new(1.0, 1.0, 0.0), DVec3::new(0.0, f64::NAN, 1.0)),
            None
        );
    }

    #[test]
    fn slivers_are_placed_where_the_ray_is() {
        // A triangle 1e-15 wide that climbs along the ray's projection: weights from rounded products are noise here.
        let (a, b) = (DVec3::new(-1.0, -0.7, 0.0), DVec3::new(1.0, 0.7, 10.0));
        let c = DVec3::new(0.3, 0.21 + 1e-15, 6.5);
        let shear = RayShear::new(&Ray::new(DVec3::new(0.1, 0.07, -3.0), DVec3::Z));
        if let Some(hit) = intersect_triangle(&shear, a, b, c) {
            let p = a + (b - a) * hit.u + (c - a) * hit.v;
            assert!((p - DVec3::new(0.1, 0.07, -3.0 + hit.t)).length() < 1e-14);
        } else {
            panic!("the sliver was missed");
        }
    }

    #[test]
    fn exact_products_lose_nothing() {
        let (x, y) = (1.0 + f64::EPSILON, 1.0 - f64::EPSILON);
        assert_eq!(exact_product(x, y), (1.0, -f64::EPSILON * f64::EPSILON));
        let a = DVec3::new(x, 1.0, 0.0);
        let b = DVec3::new(1.0, y, 0.0);
        assert_eq!(a.x * b.y, a.y * b.x);
        assert_eq!(exact_cross(a, b), -f64::EPSILON * f64::EPSILON);
    }
}
