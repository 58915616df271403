//! Every accelerator gives the answers of the list, to the last bit.
//!
//! The primitives are boxes, hit exactly by f64 slabs: the hardest shapes for conservative culling, because every hit lies on a
//! plane that the culling tests compare with. Spheres inside of the boxes check it with shapes that only touch them.

use proptest::prelude::*;
use strahl_accel::{
    Accelerator, AcceleratorKind, AnyAccelerator, Boxes, BuildOptions, Bvh2, Bvh8, List, Shapes,
    TraversalStats, Visitor,
};
use strahl_math::{Aabb, DVec3, Interval, Ray};
use strahl_simd::Simd;

/// SplitMix64.
struct Rng(u64);

impl Rng {
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// In `-1..1`.
    fn signed(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    fn point(&mut self) -> DVec3 {
        DVec3::new(self.signed(), self.signed(), self.signed())
    }

    fn below(&mut self, n: usize) -> usize {
        (self.bits() % n as u64) as usize
    }
}

/// Every structure, with every choice that changes how it is built or walked.
fn kinds() -> Vec<AcceleratorKind> {
    let variants = [
        "spheres:build=agglomerative",
        "grid:density=1",
        "grid:resolution=3x20x7",
        "grid:havran,density=10",
        "grids:density=1",
        "octree:split=centre,leaf=1",
        "octree:traversal=exit-face",
        "octree:traversal=trial-plane",
        "octree:traversal=neighbours",
        "octree:split=centre,traversal=trial-plane",
        "octree:split=centre,traversal=neighbours",
        "octree:havran,depth=5",
    ];
    let parsed = variants.iter().map(|v| v.parse().expect("an accelerator"));
    AcceleratorKind::ALL.iter().copied().chain(parsed).collect()
}

/// How many times the usual number of rays to try: `STRAHL_BATTERY=20 cargo test --release` makes it more than a million
/// for each structure.
fn effort() -> usize {
    let asked = std::env::var("STRAHL_BATTERY").ok();
    asked.map_or(1, |n| n.parse().expect("STRAHL_BATTERY is a number"))
}

/// Balls inside of boxes, as their builder knows them.
struct Balls<'b>(&'b [Aabb]);

impl Balls<'_> {
    fn ball(&self, id: u32) -> (DVec3, f64) {
        let b = &self.0[id as usize];
        (b.center(), b.size().min_element() * 0.5)
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

/// Where a ray enters a box, or leaves it if it starts inside: exact up to f64 rounding, no tolerance.
fn hit_box(b: &Aabb, ray: &Ray, range: Interval) -> Option<f64> {
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
    // A crossing whose t overflows is none.
    [near, far]
        .into_iter()
        .find(|t| range.accepts(*t) && t.is_finite())
}

/// The first crossing of the ball inside of a box, which touches it where the box is a cube.
fn hit_sphere(b: &Aabb, ray: &Ray, range: Interval) -> Option<f64> {
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

/// How a primitive is hit, known its box.
type Hit = fn(&Aabb, &Ray, Interval) -> Option<f64>;

struct Closest<'a> {
    hit: Hit,
    boxes: &'a [Aabb],
    ray: Ray,
    t_min: f64,
    best: Option<(f64, u32)>,
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

struct Any<'a> {
    hit: Hit,
    boxes: &'a [Aabb],
    ray: Ray,
    range: Interval,
    found: bool,
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

/// The closest hit, and whether there is any.
fn answers(
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

/// Boxes of all sizes, some flat, some points, some sharing planes, some equal, a few unbounded or empty.
fn boxes(rng: &mut Rng, count: usize, offset: DVec3, scale: f64) -> Vec<Aabb> {
    let mut all: Vec<Aabb> = Vec::new();
    for index in 0..count {
        let b = match rng.below(12) {
            0 if index > 0 => all[rng.below(index)],
            1 => Aabb::new(DVec3::new(-1.0, -1.0, 0.25), DVec3::new(1.0, 1.0, 0.25)),
            2 => {
                let p = rng.point();
                Aabb::new(p, p)
            }
            3 => {
                // On a coarse grid: many shared planes, edges and corners.
                let corner = (rng.point() * 4.0).floor() / 4.0;
                Aabb::new(corner, corner + DVec3::splat(0.25))
            }
            _ => {
                let p = rng.point();
                let size = 10f64.powf(-4.0 * rng.signed().abs());
                Aabb::from_points([p, p + rng.point() * size])
            }
        };
        all.push(b);
    }
    for b in &mut all {
        *b = Aabb::new(b.min * scale + offset, b.max * scale + offset);
    }
    if count > 20 {
        all[7] = Aabb::EMPTY;
        all[11] = Aabb::new(
            DVec3::new(f64::NEG_INFINITY, offset.y, offset.z),
            DVec3::new(f64::INFINITY, offset.y, offset.z),
        );
    }
    all
}

/// Rays of every nastiness: at corners, edges and faces, along axes, in planes, from inside, far and near, long and short.
fn ray(rng: &mut Rng, boxes: &[Aabb], offset: DVec3, scale: f64) -> Ray {
    let b = loop {
        let b = boxes[rng.below(boxes.len())];
        if b.is_bounded() {
            break b;
        }
    };
    let target = match rng.below(4) {
        0 => b.corners()[rng.below(8)],
        1 => b.corners()[rng.below(8)] * 0.5 + b.corners()[rng.below(8)] * 0.5,
        2 => b.center(),
        _ => offset + rng.point() * scale,
    };
    let distance = [1e-3, 1.0, 3.0, 1e3, 1e6, 1e12][rng.below(6)];
    let mut origin = target + rng.point() * (scale * distance);
    if rng.below(8) == 0 {
        origin = b.corners()[rng.below(8)];
    }
    let mut direction = target - origin;
    if rng.below(4) == 0 {
        // Exactly along an axis, through the target.
        let axis = rng.below(3);
        let mut along = DVec3::ZERO;
        along[axis] = direction[axis];
        origin = target - along;
        direction = along;
    }
    if rng.below(6) == 0 {
        direction[rng.below(3)] *= [-0.0, 1e-18, 1e-30][rng.below(3)];
    }
    direction *= [1.0, 0.37, 1e-30, 1e30, 1e-290, 1e280][rng.below(6)];
    Ray::new(origin, direction)
}

/// Compares every accelerator with the list for many rays; returns the numbers of rays and of hits.
fn compare(
    rng: &mut Rng,
    hit: Hit,
    count: usize,
    offset: DVec3,
    scale: f64,
    rays: usize,
) -> (usize, usize) {
    let boxes = boxes(rng, count, offset, scale);
    if boxes.iter().all(|b| !b.is_bounded()) {
        return (0, 0);
    }
    let list = List::build(&boxes);
    let balls = Balls(&boxes);
    // Where balls are what is hit, the builders may know.
    let exact = std::ptr::fn_addr_eq(hit, hit_sphere as Hit);
    let shapes: &dyn Shapes = if exact { &balls } else { &Boxes(&boxes) };
    let mut others: Vec<(AcceleratorKind, AnyAccelerator)> = kinds()
        .into_iter()
        .map(|kind| (kind, AnyAccelerator::build_from(kind, shapes)))
        .collect();
    let classes = Bvh8::build(&boxes, |id| (id % 5 / 2) as u8);
    assert_eq!(classes.validate(&boxes), Ok(()));
    for simd in Simd::available() {
        let wide = AnyAccelerator::Bvh8(classes.clone().with_simd(simd));
        others.push((AcceleratorKind::default(), wide));
    }
    let (mut compared, mut hits) = (0, 0);
    for _ in 0..rays * effort() {
        let ray = ray(rng, &boxes, offset, scale);
        if ray.direction == DVec3::ZERO || !ray.direction.is_finite() {
            continue;
        }
        let range = match rng.below(5) {
            0 => Interval::UNTIL_LIGHT,
            1 => Interval::new(0.5, 1.0),
            2 => Interval::LINE,
            _ => Interval::FORWARD,
        };
        let expected = answers(&list, hit, &boxes, &ray, range);
        hits += usize::from(expected.1);
        compared += 1;
        for (kind, other) in &others {
            let got = answers(other, hit, &boxes, &ray, range);
            assert_eq!(
                got, expected,
                "{kind} {count} {offset} {scale} {ray:?} {range:?}"
            );
        }
    }
    (compared, hits)
}

#[test]
fn all_accelerators_agree_with_the_list() {
    let mut rng = Rng(1);
    let (mut rays, mut hits) = (0, 0);
    for round in 0..60 {
        let scale = [1.0, 1e-6, 1e6][round % 3];
        let offset = [
            DVec3::ZERO,
            DVec3::new(1e3, -50.0, 7.0),
            DVec3::new(1e9, -1e9, 1e9),
        ][round / 3 % 3]
            * scale;
        let count = [1, 2, 30, 100, 300][round % 5];
        let (r, h) = compare(&mut rng, hit_box, count, offset, scale, 1000);
        rays += r;
        hits += h;
    }
    assert!(rays > 50_000 * effort() && hits > rays / 4, "{rays} {hits}");
}

#[test]
fn they_agree_on_spheres_inside_the_boxes() {
    let mut rng = Rng(5);
    let (mut rays, mut hits) = (0, 0);
    for round in 0..10 {
        let scale = [1.0, 1e-6, 1e6][round % 3];
        let (r, h) = compare(&mut rng, hit_sphere, 100, DVec3::ZERO, scale, 1000);
        rays += r;
        hits += h;
    }
    assert!(rays > 5_000 && hits > rays / 8, "{rays} {hits}");
}

/// Where f32 underflows, where products of coordinates overflow it, and where it ends.
#[test]
fn they_agree_on_scenes_at_the_ends_of_f32() {
    let mut rng = Rng(6);
    let (mut rays, mut hits) = (0, 0);
    for scale in [
        1e-50, 1e-44, 1e-40, 1e-37, 1e-30, 1e-20, 1e15, 1.5e19, 1e25, 1e37, 3e38, 1e50,
    ] {
        let (r, h) = compare(&mut rng, hit_box, 50, DVec3::ZERO, scale, 1000);
        rays += r;
        hits += h;
    }
    assert!(rays > 8_000 && hits > rays / 8, "{rays} {hits}");
}

/// Every power of two as the length of the direction, subnormal numbers too.
#[test]
fn they_agree_on_directions_of_any_length() {
    let boxes: Vec<Aabb> = (0..20)
        .map(|i| {
            let corner = DVec3::new(f64::from(i % 5), f64::from(i / 5), 0.0);
            Aabb::new(corner, corner + DVec3::splat(0.75))
        })
        .collect();
    let list = List::build(&boxes);
    let others: Vec<(AcceleratorKind, AnyAccelerator)> = kinds()
        .into_iter()
        .map(|kind| (kind, AnyAccelerator::build(kind, &boxes)))
        .collect();
    let mut hits = 0;
    for exponent in -1070..1023 {
        let length = 2f64.powi(exponent.max(-1000)) * 2f64.powi(exponent.min(-1000) + 1000);
        let ray = Ray::new(
            DVec3::new(-1.0, 0.5, 0.5) * 0.01,
            DVec3::new(1.0, 0.5, 0.125) * length,
        );
        for range in [Interval::FORWARD, Interval::new(0.0, 2.0 / length)] {
            let expected = answers(&list, hit_box, &boxes, &ray, range);
            hits += usize::from(expected.1);
            for (kind, accelerator) in &others {
                let got = answers(accelerator, hit_box, &boxes, &ray, range);
                assert_eq!(got, expected, "{kind} 2^{exponent} {range:?}");
            }
        }
    }
    assert!(hits > 4000, "{hits}");
}

#[test]
fn options_change_the_tree_and_not_the_answers() {
    let mut rng = Rng(8);
    let boxes = boxes(&mut rng, 2000, DVec3::ZERO, 1.0);
    let list = List::build(&boxes);
    let rays: Vec<Ray> = (0..500)
        .map(|_| ray(&mut rng, &boxes, DVec3::ZERO, 1.0))
        .collect();
    let mut nodes = Vec::new();
    for (max_leaf_size, primitive_cost) in
        [(0, 1.0), (1, 1.0), (4, 0.1), (1000, 0.01), (8, f64::NAN)]
    {
        let options = BuildOptions {
            max_leaf_size,
            primitive_cost,
        };
        let bvh = Bvh2::build_with(&boxes, &options);
        assert_eq!(bvh.validate(&boxes), Ok(()));
        nodes.push(bvh.nodes());
        for ray in rays.iter().filter(|r| r.direction != DVec3::ZERO) {
            let [expected, got] = [
                answers(&list, hit_box, &boxes, ray, Interval::FORWARD),
                answers(&bvh, hit_box, &boxes, ray, Interval::FORWARD),
            ];
            assert_eq!(got, expected, "{options:?} {ray:?}");
        }
    }
    // Leaves of one primitive: a node for every two subtrees.
    assert_eq!(nodes[..2], [1997, 1997]);
    assert!(nodes[2] < 1997 / 2 && nodes[3] < 50, "{nodes:?}");
}

#[test]
fn hostile_rays_are_harmless() {
    let mut rng = Rng(2);
    let boxes = boxes(&mut rng, 100, DVec3::ZERO, 1.0);
    let values = [
        0.0,
        -0.0,
        1.0,
        f64::NAN,
        f64::INFINITY,
        f64::NEG_INFINITY,
        1e308,
        5e-324,
    ];
    for kind in kinds() {
        let accelerator = AnyAccelerator::build(kind, &boxes);
        for _ in 0..5000 {
            let mut any = || {
                DVec3::new(
                    values[rng.below(8)],
                    values[rng.below(8)],
                    values[rng.below(8)],
                )
            };
            let ray = Ray::new(any(), any());
            // No panic, and no hit that the list does not have.
            let found = answers(&accelerator, hit_box, &boxes, &ray, Interval::FORWARD);
            if let Some((t, _)) = found.0 {
                assert!(t > 0.0);
            }
        }
    }
}

#[test]
fn degenerate_builds_are_valid() {
    let point = Aabb::new(DVec3::ONE, DVec3::ONE);
    let same = vec![point; 100_000];
    let line: Vec<Aabb> = (0..5000)
        .map(|i| {
            let p = DVec3::X * 2f64.powi(i % 250 - 125);
            Aabb::new(p, p)
        })
        .collect();
    for boxes in [
        vec![],
        vec![Aabb::EMPTY; 3],
        vec![Aabb::EVERYTHING; 3],
        vec![point],
        same,
        line,
    ] {
        let bvh = Bvh2::build(&boxes);
        assert_eq!(bvh.validate(&boxes), Ok(()));
        let wide = Bvh8::build(&boxes, |id| (id % 3) as u8);
        assert_eq!(wide.validate(&boxes), Ok(()));
        let expected = boxes.iter().filter(|b| !b.is_empty()).count();
        assert_eq!((bvh.references(), wide.references()), (expected, expected));
    }
}

#[test]
fn the_tree_does_not_depend_on_the_number_of_threads() {
    let boxes = boxes(&mut Rng(3), 30_000, DVec3::ZERO, 1.0);
    let build = |threads| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .expect("threads");
        pool.install(|| {
            let wide = Bvh8::build(&boxes, |id| (id % 3) as u8);
            (Bvh2::build(&boxes), wide)
        })
    };
    let one = build(1);
    assert_eq!(one.0.validate(&boxes), Ok(()));
    assert_eq!(one.1.validate(&boxes), Ok(()));
    assert!(one.0.nodes() > 10_000);
    assert!(one.1.nodes() > 1000);
    for threads in [2, 7] {
        assert_eq!(build(threads), one);
    }
}

#[test]
fn the_hierarchy_saves_work() {
    let mut rng = Rng(4);
    let boxes: Vec<Aabb> = (0..10_000)
        .map(|_| {
            let p = rng.point();
            Aabb::new(p, p + DVec3::splat(0.01))
        })
        .collect();
    let bvh = Bvh2::build(&boxes);
    let mut stats = TraversalStats::default();
    let rays = 1000;
    for _ in 0..rays {
        let ray = Ray::new(rng.point() * 3.0, rng.point());
        let mut closest = Closest {
            hit: hit_box,
            boxes: &boxes,
            ray,
            t_min: 0.0,
            best: None,
        };
        bvh.traverse(&ray, Interval::FORWARD, &mut closest, &mut stats);
    }
    assert!(
        stats.primitive_tests < 20 * rays && stats.node_visits < 60 * rays,
        "{stats:?}"
    );
}

#[test]
fn unknown_names_are_answered_with_all_names() {
    let error = "kdtree"
        .parse::<AcceleratorKind>()
        .expect_err("unknown")
        .to_string();
    for kind in AcceleratorKind::ALL {
        assert!(error.contains(kind.name()));
    }
    for kind in kinds() {
        assert_eq!(kind.to_string().parse(), Ok(kind));
    }
}

#[test]
fn wrong_parameters_are_answered_with_those_there_are() {
    for (text, parts) in [
        (
            "grid:depth=3",
            ["no parameter `depth`", "density=NUMBER", "havran"],
        ),
        (
            "grid:density=0",
            ["expected `density=NUMBER`", "density=0", "grid"],
        ),
        ("grid:resolution=3x4", ["resolution=XxYxZ", "found", "grid"]),
        ("grid:havran=1", ["expected `havran`", "havran=1", "grid"]),
        (
            "octree:split=middle",
            ["split=cost|centre", "split=middle", "octree"],
        ),
        ("octree:depth=21", ["depth=0..20", "depth=21", "octree"]),
        (
            "spheres:build",
            ["build=bvh|agglomerative", "found `build`", "spheres"],
        ),
        ("list:fast", ["`list` has no parameters", "fast", "list"]),
    ] {
        let error = text.parse::<AcceleratorKind>().expect_err(text).to_string();
        for part in parts {
            assert!(error.contains(part), "{text}: {error}");
        }
    }
    let spaced = "octree: depth = 7 , split=centre".parse::<AcceleratorKind>();
    assert_eq!(
        spaced.expect("fine").to_string(),
        "octree:depth=7,split=centre"
    );
}

fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![-2.0..2.0f64, (-8i32..8).prop_map(|i| f64::from(i) / 4.0)]
}

fn point() -> impl Strategy<Value = DVec3> {
    (coordinate(), coordinate(), coordinate()).prop_map(|(x, y, z)| DVec3::new(x, y, z))
}

proptest! {
    /// The same with shrinking, on small scenes.
    #[test]
    fn small_scenes_agree_with_the_list(
        corners in prop::collection::vec((point(), point()), 1..12),
        origin in point(),
        direction in point(),
    ) {
        let boxes: Vec<Aabb> = corners.into_iter().map(|(a, b)| Aabb::from_points([a, b])).collect();
        let ray = Ray::new(origin, direction);
        prop_assume!(direction != DVec3::ZERO);
        let expected = answers(&List::build(&boxes), hit_box, &boxes, &ray, Interval::FORWARD);
        for kind in kinds() {
            let got = answers(&AnyAccelerator::build(kind, &boxes), hit_box, &boxes, &ray, Interval::FORWARD);
            prop_assert_eq!(got, expected, "{}", kind);
        }
    }
}
