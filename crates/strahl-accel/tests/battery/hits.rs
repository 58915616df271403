//! The primitives of the battery: boxes, or balls inside of them.

use strahl_accel::{Accelerator, Shapes, TraversalStats, Visitor};
use strahl_math::{Aabb, DVec3, Interval, Ray};

/// Balls inside of boxes, of which their builders know.
pub(crate) struct Balls<'b>(pub(crate) &'b [Aabb]);

impl Balls<'_> {
    fn ball(&self, id: u32) -> (DVec3, f64) {
        let b = &self.0[id as usize];
        (b.center(), b.size().min_element() * 0.5)
    }
}

/// Boxes that the builders treat as thin primitives that hardly fill them.
pub(crate) struct Thin<'b>(pub(crate) &'b [Aabb]);

impl Shapes for Thin<'_> {
    fn count(&self) -> usize {
        self.0.len()
    }

    fn bounds(&self, id: u32) -> Aabb {
        self.0[id as usize]
    }

    fn flat_area(&self, _: u32) -> Option<f64> {
        Some(0.0)
    }
}

impl Shapes for Balls<'_> {
    fn count(&self) -> usize {
        self.0.len()
    }

    fn bounds(&self, id: u32) -> Aabb {
        self.0[id as usize]
    }

    fn overlaps(&self, id: u32, cell: &Aabb) -> bool {
        let (center, radius) = self.ball(id);
        let (below, above) = (cell.min - center, center - cell.max);
        let nearest = below.max(above).max(DVec3::ZERO).length();
        let farthest = below.abs().max(above.abs()).length();
        nearest <= radius && radius <= farthest
    }

    fn sphere(&self, id: u32) -> Option<(DVec3, f64)> {
        Some(self.ball(id))
    }
}

/// The t at which a ray enters a box, or leaves it if it starts inside: exact up to f64 rounding, without tolerance.
pub(crate) fn hit_box(b: &Aabb, ray: &Ray, range: Interval) -> Option<f64> {
    let (mut near, mut far) = (f64::NEG_INFINITY, f64::INFINITY);
    for axis in 0..3 {
        let (o, d) = (ray.origin[axis], ray.direction[axis]);
        if d == 0.0 {
            if !(b.min[axis] <= o && o <= b.max[axis]) {
                return None;
            }
            continue;
        }
        let (a, c) = ((b.min[axis] - o) / d, (b.max[axis] - o) / d);
        let (first, last) = if d > 0.0 { (a, c) } else { (c, a) };
        near = if first > near { first } else { near };
        far = if last < far { last } else { far };
    }
    if !(near <= far) {
        return None;
    }
    // A crossing whose t overflows does not count.
    [near, far]
        .into_iter()
        .find(|t| range.accepts(*t) && t.is_finite())
}

/// The first crossing with the ball inside of a box; the ball touches the box if that is a cube.
pub(crate) fn hit_sphere(b: &Aabb, ray: &Ray, range: Interval) -> Option<f64> {
    let radius = b.size().min_element() * 0.5;
    let to_center = b.center() - ray.origin;
    let length = ray.direction.length();
    let along = ray.direction / length;
    let middle = along.dot(to_center);
    let aside = to_center - along * middle;
    let half = (radius * radius - aside.length_squared()).sqrt();
    [(middle - half) / length, (middle + half) / length]
        .into_iter()
        .find(|t| range.accepts(*t))
}

/// The intersection test of a primitive, given its box.
pub(crate) type Hit = fn(&Aabb, &Ray, Interval) -> Option<f64>;

pub(crate) struct Closest<'a> {
    pub(crate) hit: Hit,
    pub(crate) boxes: &'a [Aabb],
    pub(crate) ray: Ray,
    pub(crate) t_min: f64,
    pub(crate) best: Option<(f64, u32)>,
}

impl Visitor for Closest<'_> {
    fn visit(&mut self, id: u32, t_max: f64) -> f64 {
        let range = Interval::new(self.t_min, t_max);
        let Some(t) = (self.hit)(&self.boxes[id as usize], &self.ray, range) else {
            return t_max;
        };
        if self
            .best
            .is_none_or(|(best, of)| t < best || (t == best && id < of))
        {
            self.best = Some((t, id));
        }
        t
    }
}

pub(crate) struct Any<'a> {
    pub(crate) hit: Hit,
    pub(crate) boxes: &'a [Aabb],
    pub(crate) ray: Ray,
    pub(crate) range: Interval,
    pub(crate) found: bool,
}

impl Visitor for Any<'_> {
    fn visit(&mut self, id: u32, t_max: f64) -> f64 {
        if (self.hit)(&self.boxes[id as usize], &self.ray, self.range).is_some() {
            assert!(!self.found, "visited after the end");
            self.found = true;
            return f64::NEG_INFINITY;
        }
        t_max
    }
}

/// The closest hit, and whether there is any hit.
pub(crate) fn answers(
    accelerator: &impl Accelerator,
    hit: Hit,
    boxes: &[Aabb],
    ray: &Ray,
    range: Interval,
) -> (Option<(f64, u32)>, bool) {
    let stats = &mut TraversalStats::default();
    let mut closest = Closest {
        hit,
        boxes,
        ray: *ray,
        t_min: range.min,
        best: None,
    };
    accelerator.traverse(ray, range, &mut closest, stats);
    let mut any = Any {
        hit,
        boxes,
        ray: *ray,
        range,
        found: false,
    };
    accelerator.traverse(ray, range, &mut any, stats);
    (closest.best, any.found)
}
