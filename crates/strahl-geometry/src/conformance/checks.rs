use super::{Random, Subject};
use crate::{PrimHit, Primitive, Scratch, SurfacePoint};
use strahl_math::error::offset_origin;
use strahl_math::{DVec3, Interval, Ray, Transform};

impl Subject {
    /// The parameters pass the primitive's own check, and some ray hits the primitive.
    pub fn is_valid(&self) {
        assert_eq!(self.shape.validate(), Ok(()));
        assert!(self.shape.elements() >= 1);
        let name = self.shape.kind();
        assert!(
            !name.is_empty()
                && name
                    .chars()
                    .all(|c| c.is_ascii_lowercase() || c == '_' || c.is_ascii_digit()),
            "{name}"
        );
        let mut hits = 0;
        self.for_random_hits(1, |_, _, _| hits += 1);
        assert!(
            hits * 50 >= self.rays,
            "only {hits} of {} rays hit",
            self.rays
        );
    }

    /// Shoots rays and calls `look` with their hits.
    fn for_random_hits(&self, seed: u64, mut look: impl FnMut(&Ray, &PrimHit, &SurfacePoint)) {
        let (mut random, mut scratch) = (Random::new(seed), Scratch::default());
        for _ in 0..self.rays {
            let ray = self.ray(&mut random);
            if let Some(hit) = self
                .shape
                .closest_hit(&ray, Interval::FORWARD, None, &mut scratch)
            {
                look(&ray, &hit, &self.shape.surface_at(&ray, &hit));
            }
        }
    }

    /// The reported position is near the point on the ray and on the surface: a second ray, sent straight down on it, hits the
    /// surface there within `position_error`.
    pub fn hits_lie_on_the_surface(&self) {
        let mut scratch = Scratch::default();
        self.for_random_hits(2, |ray, hit, surface| {
            let context = format!("{ray:?}\n{hit:?}\n{surface:?}");
            assert!(
                Interval::FORWARD.accepts(hit.t) && hit.t.is_finite(),
                "{context}"
            );
            assert!(hit.surface.element < self.shape.elements(), "{context}");
            let bare = self.shape.bare_surface_at(ray, hit);
            let all = |p: &SurfacePoint| (p.position, p.position_error, p.n_geom, p.n_shade);
            assert_eq!(all(&bare), all(surface), "{context}");
            assert!(
                surface.position.is_finite() && surface.uv.is_finite(),
                "{context}"
            );
            assert!(surface.position_error.cmpge(DVec3::ZERO).all(), "{context}");
            let off = (ray.at(hit.t) - surface.position).length();
            let error = surface.position_error.length();
            assert!(
                off <= self.tolerance(ray, hit.t) + error,
                "{off} off the ray: {context}"
            );

            let height = 1e-4 * self.thickness;
            let down = Ray::new(surface.position + surface.n_geom * height, -surface.n_geom);
            let allowed = 2.0 * surface.n_geom.abs().dot(surface.position_error)
                + 0.01 * self.tolerance(&down, height);
            if allowed < 0.1 * height {
                let range = Interval::new(height - allowed, height + allowed);
                let again = self.shape.closest_hit(&down, range, None, &mut scratch);
                assert!(
                    again.is_some_and(|again| again.surface.element == hit.surface.element),
                    "nothing at {range:?} of {down:?}: {context}"
                );
            }
        });
    }

    /// Normals are unit vectors and perpendicular to the differences of neighbouring hits, the derivatives `dpdu` and `dpdv` are
    /// these differences.
    pub fn normals_agree_with_neighbouring_hits(&self) {
        let mut scratch = Scratch::default();
        let mut compared = 0;
        self.for_random_hits(3, |ray, hit, surface| {
            let context = format!("{ray:?}\n{hit:?}\n{surface:?}");
            for n in [surface.n_geom, surface.n_shade] {
                assert!((n.length() - 1.0).abs() < 1e-12, "{context}");
            }
            let along = ray.direction.normalize();
            let step = 1e-5 * self.thickness;
            let noise = self.tolerance(ray, hit.t) + surface.position_error.length();
            if along.dot(surface.n_geom).abs() < 0.1 || noise > 1e-4 * step {
                return;
            }
            for sideways in [
                along.any_orthonormal_vector(),
                along.cross(along.any_orthonormal_vector()),
            ] {
                let beside = Ray::new(ray.origin + sideways * step, ray.direction);
                let Some(neighbour) =
                    self.shape
                        .closest_hit(&beside, Interval::FORWARD, None, &mut scratch)
                else {
                    continue;
                };
                let other = self.shape.surface_at(&beside, &neighbour);
                let moved = other.position - surface.position;
                if neighbour.surface != hit.surface
                    || moved.length() > 30.0 * step
                    || other.n_geom.dot(surface.n_geom) < 0.999
                {
                    continue;
                }
                compared += 1;
                let slope = moved.dot(surface.n_geom) / moved.length();
                let curvature = (other.n_geom - surface.n_geom).length();
                assert!(slope.abs() < 1e-3 + curvature, "slope {slope}: {context}");

                let uv = other.uv - surface.uv;
                let zero = surface.dpdu == DVec3::ZERO || surface.dpdv == DVec3::ZERO;
                let predicted = surface.dpdu * uv.x + surface.dpdv * uv.y;
                if !zero && uv.abs().max_element() < 1e-3 {
                    let wrong = (predicted - moved).length() / moved.length();
                    assert!(
                        wrong < 0.05,
                        "derivatives off by {wrong}, moved {moved}, uv {uv}: {context}"
                    );
                }
            }
        });
        assert!(compared > 0, "no smooth piece found");
    }

    /// A ray that starts on the surface, moved off it by its error, does not hit the same spot again: inwards,
    /// outwards, at any angle.
    pub fn rays_leave_the_surface(&self) {
        let (mut scratch, mut random) = (Scratch::default(), Random::new(40));
        self.for_random_hits(4, |_, hit, surface| {
            for side in [1.0, -1.0] {
                let n = surface.n_geom * side;
                let origin = offset_origin(surface.position, surface.position_error, n);
                assert!((origin - surface.position).dot(n) > 0.0);
                let tangent = random.direction().cross(n).normalize_or(n.any_orthonormal_vector());
                // Below this angle the place is not known well enough to tell the sides apart.
                let blur = 1e-11 + 32.0 * surface.position_error.length() / self.thickness;
                for sine in [1.0, random.unit(), 1e-1, 1e-3, 1e-6, 1e-9] {
                    if sine < blur {
                        continue;
                    }
                    let direction = n * sine + tangent * (1.0 - sine * sine).sqrt();
                    let ray = Ray::new(origin, direction * random.magnitude(-2.0, 2.0));
                    let from = Some(hit.surface);
                    let Some(again) = self.shape.closest_hit(&ray, Interval::FORWARD, from, &mut scratch) else { continue };
                    let distance = again.t * ray.direction.length();
                    // As far as the error of the position reaches along the ray, but not to the far side of a curved surface.
                    let reach = 8.0 * surface.position_error.length() / sine;
                    let spot = reach.min(self.thickness * sine / 64.0);
                    assert!(
                        again.surface != hit.surface || distance > spot,
                        "leaving {hit:?} on side {side} with sine {sine}, back after {distance}\n{ray:?}\n{surface:?}"
                    );
                }
            }
        });
    }

    /// Hits are inside the bounds, up to the rounding of `ray.at(t)`.
    pub fn hits_are_inside_the_bounds(&self) {
        let bounds = self.shape.bounds();
        let mut random = Random::new(5);
        let mut scratch = Scratch::default();
        for i in 0..self.rays {
            let ray = if i % 4 == 0 {
                self.axis_parallel_ray(&mut random)
            } else {
                self.ray(&mut random)
            };
            let Some(hit) = self
                .shape
                .closest_hit(&ray, Interval::LINE, None, &mut scratch)
            else {
                continue;
            };
            let surface = self.shape.surface_at(&ray, &hit);
            let at = DVec3::splat(self.tolerance(&ray, hit.t));
            assert!(
                bounds.padded(at).contains(ray.at(hit.t)),
                "{ray:?} {hit:?} outside {bounds:?}"
            );
            let here = surface.position_error;
            assert!(
                bounds.padded(here).contains(surface.position),
                "{surface:?} outside {bounds:?}"
            );
        }
    }

    /// `all_hits` are those of `closest_hit`, one behind the other.
    pub fn all_hits_are_closest_hits_one_behind_the_other(&self) {
        let (mut random, mut scratch) = (Random::new(16), Scratch::default());
        for i in 0..self.rays {
            let ray = if i % 4 == 0 {
                self.axis_parallel_ray(&mut random)
            } else {
                self.ray(&mut random)
            };
            let from = random.between(-self.size, self.size) / ray.direction.length();
            for mut range in [Interval::FORWARD, Interval::new(from, f64::INFINITY)] {
                let mut all = vec![];
                self.shape
                    .all_hits(&ray, range, None, &mut scratch, &mut all);
                for hit in &all {
                    let next = self.shape.closest_hit(&ray, range, None, &mut scratch);
                    assert_eq!(next.as_ref(), Some(hit), "{ray:?} {range:?} {all:?}");
                    range.min = hit.t;
                }
                let next = self.shape.closest_hit(&ray, range, None, &mut scratch);
                assert_eq!(next, None, "{ray:?} {range:?} {all:?}");
            }
        }
    }

    /// `any_hit` agrees with `closest_hit`, whatever the range.
    pub fn any_hit_agrees_with_closest_hit(&self) {
        let (mut random, mut scratch) = (Random::new(6), Scratch::default());
        for i in 0..self.rays {
            let ray = if i % 4 == 0 {
                self.axis_parallel_ray(&mut random)
            } else {
                self.ray(&mut random)
            };
            let reach = 3.0 * self.size / ray.direction.length();
            let (a, b) = (
                random.between(-reach, reach),
                random.between(-reach, 2.0 * reach),
            );
            for range in [
                Interval::FORWARD,
                Interval::LINE,
                Interval::new(a, b),
                Interval::new(a, f64::INFINITY),
            ] {
                let hit = self.shape.closest_hit(&ray, range, None, &mut scratch);
                assert!(
                    hit.is_none_or(|hit| range.accepts(hit.t)),
                    "{ray:?} {range:?} {hit:?}"
                );
                assert_eq!(
                    hit.is_some(),
                    self.shape.any_hit(&ray, range, None, &mut scratch),
                    "{ray:?} {range:?}"
                );
            }
        }
    }

    /// A range that ends at the hit keeps it, bit for bit; one that ends just before loses it; one that begins at it loses it.
    pub fn ranges_cut_exactly(&self) {
        let mut scratch = Scratch::default();
        self.for_random_hits(7, |ray, hit, _| {
            let mut query = |min, max| {
                self.shape
                    .closest_hit(ray, Interval::new(min, max), None, &mut scratch)
            };
            assert_eq!(query(0.0, hit.t), Some(*hit), "{ray:?}");
            assert_eq!(query(0.0, hit.t.next_down()), None, "{ray:?} {hit:?}");
            assert_eq!(
                query(hit.t.next_down(), f64::INFINITY),
                Some(*hit),
                "{ray:?}"
            );
            assert!(
                query(hit.t, f64::INFINITY).is_none_or(|next| next.t > hit.t),
                "{ray:?} {hit:?}"
            );
        });
    }

    /// A direction `k` times as long makes `t` `k` times as small.
    pub fn t_scales_with_the_direction(&self) {
        let mut scratch = Scratch::default();
        self.for_random_hits(8, |ray, hit, surface| {
            for factor in [0.125, 3.7, 1e4] {
                let scaled = Ray::new(ray.origin, ray.direction * factor);
                let other = self
                    .shape
                    .closest_hit(&scaled, Interval::FORWARD, None, &mut scratch);
                self.assert_same_place(
                    ray,
                    hit,
                    surface,
                    other.map(|other| PrimHit {
                        t: other.t * factor,
                        ..other
                    }),
                );
            }
        });
    }

    /// Checks that two computations of one hit agree. Rays that graze the surface are left out, because their `t` may change a
    /// lot, and so are rays that start on it, because their `t` may become 0 or negative.
    fn assert_same_place(
        &self,
        ray: &Ray,
        hit: &PrimHit,
        surface: &SurfacePoint,
        other: Option<PrimHit>,
    ) {
        let sine = ray.direction.normalize().dot(surface.n_geom).abs();
        let allowed = self.tolerance(ray, hit.t) / sine;
        if sine < 1e-3 || hit.t * ray.direction.length() < allowed {
            return;
        }
        let off = other.map(|other| (other.t - hit.t).abs() * ray.direction.length());
        assert!(
            off.is_some_and(|off| off <= allowed),
            "{hit:?} became {other:?}, {off:?} > {allowed}, {ray:?}"
        );
    }

    /// Rotating, scaling and moving shape and ray together leaves `t` unchanged, whether the shape gets a space of its own or
    /// is baked.
    pub fn maps_change_nothing(&self) {
        let (mut random, mut scratch) = (Random::new(9), Scratch::default());
        for round in 0..12 {
            let stretch = match round % 4 {
                0 => DVec3::ONE,
                1 => DVec3::splat(random.magnitude(-1.0, 1.0)),
                2 => DVec3::new(-1.5, 1.5, 1.5),
                _ => DVec3::new(
                    random.between(0.5, 2.0),
                    random.between(0.5, 2.0),
                    random.between(-2.0, -0.5),
                ),
            };
            let Ok(scale) = Transform::try_scale(stretch) else {
                continue;
            };
            let turn = Transform::rotate(random.direction(), random.between(0.0, 6.0));
            let shift = Transform::translate(random.cube() * self.size * 4.0);
            let map = if round < 8 {
                turn.then(&scale).then(&turn).then(&shift)
            } else {
                scale.then(&shift)
            };
            let placed = self.placed(map);
            let baked = self.shape.baked(&map);
            if let Some(baked) = &baked {
                assert_eq!(baked.kind(), self.shape.kind());
            }
            for _ in 0..self.rays / 12 {
                let ray = self.ray(&mut random);
                let Some(hit) = self
                    .shape
                    .closest_hit(&ray, Interval::FORWARD, None, &mut scratch)
                else {
                    continue;
                };
                let surface = self.shape.surface_at(&ray, &hit);
                let outer = Ray::new(
                    map.point_to_world(ray.origin),
                    map.vector_to_world(ray.direction),
                );
                let other = placed
                    .shape
                    .closest_hit(&outer, Interval::FORWARD, None, &mut scratch);
                let wide = Self {
                    region: placed.region.union(&self.region),
                    ..self.clone()
                };
                wide.assert_same_place(&ray, &hit, &surface, other);
                let Some(baked) = &baked else { continue };
                let other = baked.closest_hit(&outer, Interval::FORWARD, None, &mut scratch);
                wide.assert_same_place(&ray, &hit, &surface, other);
                if let Some(other) =
                    other.filter(|_| ray.direction.normalize().dot(surface.n_geom).abs() > 0.1)
                {
                    let expected = placed.shape.surface_at(&outer, &hit);
                    let found = baked.surface_at(&outer, &other);
                    assert_eq!(other.surface, hit.surface);
                    let close = 1e-8 * placed.size;
                    assert!(
                        (found.position - expected.position).length() < close,
                        "{found:?} {expected:?}"
                    );
                    assert!(
                        (found.n_geom - expected.n_geom).length() < 1e-6,
                        "{found:?} {expected:?}"
                    );
                    let seam = (found.uv - expected.uv).abs().max_element();
                    assert!(
                        !(1e-6..=0.999_999).contains(&seam),
                        "baked {found:?}\nplaced {expected:?}"
                    );
                    assert!(
                        (found.dpdu - expected.dpdu).length() <= 1e-6 * expected.dpdu.length(),
                        "{found:?} {expected:?}"
                    );
                    assert!(
                        (found.dpdv - expected.dpdv).length() <= 1e-6 * expected.dpdv.length(),
                        "{found:?} {expected:?}"
                    );
                }
            }
        }
    }

    /// All checks hold from 1e-6 to 1e6 times the size and at distances up to 1e9, with a space of its own and baked.
    pub fn all_scales_and_places(&self) {
        let aside = DVec3::new(0.7, -1.0, 0.4);
        for scale in [1e-6, 1e-3, 1e3, 1e6] {
            for distance in [0.0, 1e3, 1e9] {
                let Ok(grow) = Transform::try_scale(DVec3::splat(scale)) else {
                    continue;
                };
                let map = grow.then(&Transform::translate(aside * distance));
                let placed = self.placed(map);
                placed.check_everything();
                if let Some(baked) = self.shape.baked(&map) {
                    let region = placed.region;
                    Self::with_region(std::sync::Arc::new(baked), region, placed.rays)
                        .check_everything();
                }
            }
        }
    }

    fn check_everything(&self) {
        self.hits_lie_on_the_surface();
        self.hits_are_inside_the_bounds();
        self.any_hit_agrees_with_closest_hit();
        self.all_hits_are_closest_hits_one_behind_the_other();
        self.ranges_cut_exactly();
        self.t_scales_with_the_direction();
        self.rays_leave_the_surface();
        self.crossings_alternate();
    }

    /// NaN, zero and infinite input gives "no hit", extreme input gives no panic.
    pub fn hostile_input_is_harmless(&self) {
        const BAD: [f64; 9] = [
            f64::NAN,
            f64::INFINITY,
            f64::NEG_INFINITY,
            0.0,
            -0.0,
            f64::MIN_POSITIVE,
            5e-324,
            1e300,
            -1e155,
        ];
        let (mut random, mut scratch) = (Random::new(11), Scratch::default());
        let ranges = [
            Interval::FORWARD,
            Interval::LINE,
            Interval::new(1.0, -1.0),
            Interval::new(f64::NAN, f64::NAN),
            Interval::new(f64::INFINITY, f64::NEG_INFINITY),
        ];
        for i in 0..self.rays {
            let mut ray = self.ray(&mut random);
            if i % 7 == 0 {
                ray.direction = DVec3::ZERO;
            }
            for _ in 0..=random.below(3) {
                let (axis, value) = (random.below(3) as usize, BAD[random.below(9) as usize]);
                if random.below(2) == 0 {
                    ray.origin[axis] = value;
                } else {
                    ray.direction[axis] = value;
                }
            }
            let nowhere = ray.origin.is_nan()
                || ray.direction.is_nan()
                || ray.direction == DVec3::ZERO
                || !ray.origin.is_finite();
            for range in ranges {
                let hit = self.shape.closest_hit(&ray, range, None, &mut scratch);
                if let Some(hit) = hit {
                    assert!(
                        !nowhere && range.accepts(hit.t) && hit.t.is_finite(),
                        "{ray:?} {hit:?}"
                    );
                    self.shape.surface_at(&ray, &hit);
                    self.shape.bare_surface_at(&ray, &hit);
                    self.shape
                        .closest_hit(&ray, range, Some(hit.surface), &mut scratch);
                }
                assert_eq!(
                    self.shape.any_hit(&ray, range, None, &mut scratch),
                    hit.is_some()
                );
                if let Some(solid) = self.shape.as_solid() {
                    let mut list = scratch.take();
                    solid.crossings(&ray, range, None, &mut scratch, &mut list);
                    assert!(
                        list.list.iter().all(|c| !nowhere && range.accepts(c.hit.t)),
                        "{ray:?} {list:?}"
                    );
                    scratch.give(list);
                }
            }
            if let Some(solid) = self.shape.as_solid() {
                assert!(
                    !(ray.origin.is_nan() && solid.contains(ray.origin)),
                    "{}",
                    ray.origin
                );
            }
        }
    }
}
