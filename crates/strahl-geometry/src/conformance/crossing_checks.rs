use super::{Random, Subject};
use crate::{Crossing, Crossings, PrimHit, Scratch, Side, Solid, SurfaceId};
use strahl_math::error::offset_origin;
use strahl_math::{DVec3, Interval, Ray};

impl Subject {
    /// Crossings ascend and alternate, agree with `contains` between them, with the normals, with `closest_hit`, and do not
    /// depend on the range. Open surfaces are not checked.
    pub fn crossings_alternate(&self) {
        let Some(solid) = self.shape.as_solid() else {
            return;
        };
        let mut random = Random::new(10);
        let mut scratch = Scratch::default();
        for i in 0..self.rays {
            let along_axis = i % 4 == 0;
            let ray = if along_axis {
                self.axis_parallel_ray(&mut random)
            } else {
                self.ray(&mut random)
            };
            let line = list(solid, &ray, Interval::LINE, None, &mut scratch);
            self.check_list(solid, &ray, Interval::LINE, None, &line, &mut scratch);
            self.check_without_errors(solid, &ray, &line, &mut scratch);
            self.check_inside(solid, &ray, &line);

            let reach = 3.0 * self.size / ray.direction.length();
            let (a, b) = (
                random.between(-reach, reach),
                random.between(-reach, 2.0 * reach),
            );
            for range in [
                Interval::FORWARD,
                Interval::new(a, b),
                Interval::new(a, f64::INFINITY),
            ] {
                let part = list(solid, &ray, range, None, &mut scratch);
                let expected: Vec<_> = line
                    .list
                    .iter()
                    .filter(|c| range.accepts(c.hit.t))
                    .copied()
                    .collect();
                assert_eq!(part.list, expected, "{ray:?} {range:?}");
                assert_eq!(
                    part.inside_at_start,
                    line.inside_after(range.min),
                    "{ray:?} {range:?} {line:?}"
                );
                self.check_list(solid, &ray, range, None, &part, &mut scratch);
            }
            if let (false, Some(crossing)) = (along_axis, line.list.first()) {
                self.check_starts_on_the_surface(solid, &ray, crossing, &mut random, &mut scratch);
            }
            self.check_tangent_rays(solid, &ray, &line, &mut random, &mut scratch);
        }
    }

    /// The same crossings are listed if their errors are not wanted, by shapes that then leave them out.
    fn check_without_errors(
        &self,
        solid: &dyn Solid,
        ray: &Ray,
        line: &Crossings,
        scratch: &mut Scratch,
    ) {
        let simple = [
            "torus",
            "polynomial",
            "superellipsoid",
            "sor",
            "lathe",
            "isosurface",
        ];
        if !simple.contains(&self.shape.kind()) {
            return;
        }
        let mut bare = Crossings {
            without_errors: true,
            ..Crossings::default()
        };
        solid.crossings(ray, Interval::LINE, None, scratch, &mut bare);
        for (bare, crossing) in bare.list.iter_mut().zip(&line.list) {
            bare.t_error = crossing.t_error;
        }
        assert_eq!(bare.list, line.list, "{ray:?}");
        assert_eq!(bare.inside_at_start, line.inside_at_start);
    }

    fn check_list(
        &self,
        solid: &dyn Solid,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        list: &Crossings,
        scratch: &mut Scratch,
    ) {
        let context = format!("{ray:?} {range:?} from {from:?}: {list:?}");
        let (mut inside, mut last) = (list.inside_at_start, range.min);
        for crossing in &list.list {
            let t = crossing.hit.t;
            assert!(range.accepts(t) && t.is_finite() && t >= last, "{context}");
            assert!(
                crossing.t_error >= 0.0 && crossing.t_error.is_finite(),
                "{context}"
            );
            match crossing.side {
                Side::Enter => assert!(!inside, "{context}"),
                Side::Exit => assert!(inside, "{context}"),
                Side::Inner => {}
            }
            inside = match crossing.side {
                Side::Enter => true,
                Side::Exit => false,
                Side::Inner => inside,
            };
            last = t;
            let surface = solid.surface_at(ray, &crossing.hit);
            let approach = surface.n_geom.dot(ray.direction.normalize());
            let blur = 1e-6 + 32.0 * surface.position_error.length() / self.thickness;
            if approach.abs() > blur && crossing.side != Side::Inner {
                assert_eq!(
                    approach < 0.0,
                    crossing.side == Side::Enter,
                    "normal {}: {context}",
                    surface.n_geom
                );
            }
        }
        let first = list
            .list
            .iter()
            .find(|c| c.visible)
            .map(|c| (c.hit.t, c.surface()));
        let closest = solid
            .closest_hit(ray, range, from, scratch)
            .map(|hit| (hit.t, hit.surface));
        assert_eq!(first, closest, "{context}");
    }

    /// Halfway between two crossings the point is inside exactly if the list implies it.
    fn check_inside(&self, solid: &dyn Solid, ray: &Ray, list: &Crossings) {
        let far = 2.0 * self.size / ray.direction.length();
        let first = list.list.first().map_or(0.0, |c| c.hit.t - far);
        let last = list.list.last().map_or(0.0, |c| c.hit.t + far);
        let error = |c: Option<&Crossing>| c.map_or(0.0, |c| c.t_error);
        let mut ends = vec![(first, 0.0)];
        ends.extend(list.list.iter().map(|c| (c.hit.t, error(Some(c)))));
        ends.push((last, 0.0));
        for pair in ends.windows(2) {
            let middle = 0.5 * (pair[0].0 + pair[1].0);
            let blur = self.tolerance(ray, middle);
            // The middle of a chord that grazes may be nearer to the surface than rounding can tell.
            let gap = (pair[1].0 - pair[0].0) * ray.direction.length();
            if gap * gap < 100.0 * blur * self.size
                || pair[1].0 - pair[0].0 < 4.0 * (pair[0].1 + pair[1].1)
            {
                continue;
            }
            let point = ray.at(middle);
            let near_surface = self.near_surface(solid, point, 8.0 * blur);
            let inside = solid.contains(point);
            assert!(
                near_surface || inside == list.inside_after(middle),
                "{point} inside: {inside}, {ray:?} {list:?}"
            );
        }
    }

    /// Whether a surface is within `distance` of a point, along an axis.
    fn near_surface(&self, solid: &dyn Solid, point: DVec3, distance: f64) -> bool {
        let here = solid.contains(point);
        DVec3::AXES.iter().any(|axis| {
            [distance, -distance]
                .iter()
                .any(|d| solid.contains(point + *axis * *d) != here)
        })
    }

    /// A ray that starts on the surface knows the side it leaves towards.
    fn check_starts_on_the_surface(
        &self,
        solid: &dyn Solid,
        ray: &Ray,
        crossing: &Crossing,
        random: &mut Random,
        scratch: &mut Scratch,
    ) {
        let surface = solid.surface_at(ray, &crossing.hit);
        let from = Some(crossing.surface());
        let blur = 1e-9 + 32.0 * surface.position_error.length() / self.thickness;
        for side in [1.0, -1.0] {
            let n = surface.n_geom * side;
            let direction = (n + random.direction() * 0.99).normalize();
            if direction.dot(n) < blur {
                continue;
            }
            let leaving = Ray::new(
                offset_origin(surface.position, surface.position_error, n),
                direction,
            );
            let list = list(solid, &leaving, Interval::FORWARD, from, scratch);
            self.check_list(solid, &leaving, Interval::FORWARD, from, &list, scratch);
            // At an edge the other face may be met at once.
            let at_edge = list
                .list
                .first()
                .is_some_and(|c| c.hit.t < 1e-9 * self.size && c.surface() != crossing.surface());
            let inner = crossing.side == Side::Inner;
            assert!(
                at_edge || inner || list.inside_at_start == (side < 0.0),
                "side {side} of {crossing:?} along {leaving:?}: {list:?}"
            );
        }
    }

    /// Rays along the surface: hits are not guaranteed, but the list is consistent.
    fn check_tangent_rays(
        &self,
        solid: &dyn Solid,
        ray: &Ray,
        line: &Crossings,
        random: &mut Random,
        scratch: &mut Scratch,
    ) {
        let Some(hit) = line.list.first().map(|c| c.hit) else {
            return;
        };
        let surface = solid.surface_at(ray, &hit);
        let tangent = surface
            .n_geom
            .cross(random.direction())
            .normalize_or(surface.n_geom.any_orthonormal_vector());
        let starts = [surface.position, surface.position - tangent * self.size];
        for origin in starts {
            let along = Ray::new(origin, tangent);
            for range in [Interval::LINE, Interval::FORWARD] {
                let list = list(solid, &along, range, None, scratch);
                check_order(&list, &along);
                let first: Option<PrimHit> = solid.closest_hit(&along, range, None, scratch);
                let listed = list.list.iter().find(|c| c.visible).map(|c| c.hit.t);
                assert_eq!(
                    first.map(|hit| hit.t),
                    listed,
                    "{along:?} {range:?}: {list:?}"
                );
            }
        }
    }
}

fn list(
    solid: &dyn Solid,
    ray: &Ray,
    range: Interval,
    from: Option<SurfaceId>,
    scratch: &mut Scratch,
) -> Crossings {
    let mut out = Crossings::default();
    solid.crossings(ray, range, from, scratch, &mut out);
    out
}

fn check_order(list: &Crossings, ray: &Ray) {
    let mut inside = list.inside_at_start;
    for crossing in &list.list {
        match crossing.side {
            Side::Enter => assert!(!std::mem::replace(&mut inside, true), "{ray:?} {list:?}"),
            Side::Exit => assert!(std::mem::replace(&mut inside, false), "{ray:?} {list:?}"),
            Side::Inner => {}
        }
    }
    assert!(
        list.list
            .windows(2)
            .all(|pair| pair[0].hit.t <= pair[1].hit.t),
        "{ray:?} {list:?}"
    );
}
