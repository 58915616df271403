//! Questions about single rays and points, many at once.

use crate::hit::Hit;
use crate::prim::{Prim, PrimKind};
use crate::scene::RenderScene;
use crate::searcher::Searcher;
use crate::session::Session;
use crate::trace::Filled;
use rayon::prelude::*;
use std::sync::Arc;
use strahl_accel::{Accelerator, AnyAccelerator, TraversalStats, Visitor};
use strahl_math::{Aabb, DVec2, DVec3, Interval, Ray};
use strahl_scene::Span;

/// Rays or points that a thread takes at once.
const BATCH: usize = 1024;

/// What a ray has hit.
#[derive(Clone, Debug, PartialEq)]
pub struct HitInfo {
    /// Ray parameter.
    pub t: f64,
    /// Number of the object, as for [`RenderScene::objects`].
    pub object: u32,
    /// Its name, if the scene gives it one.
    pub name: Option<Arc<str>>,
    /// The field's word for it: `sphere`, `mesh`, ...
    pub kind: &'static str,
    /// Number of the element: a triangle of a mesh, a sphere of many.
    pub element: u64,
    /// Number of the material, as for [`RenderScene::materials`].
    pub material: u32,
    /// The place in the scene that made the object, or the line that made this face, where a mesh stores it.
    pub span: Span,
    /// World position.
    pub position: DVec3,
    /// Unit normal of the surface: outwards on solids, to the front on open surfaces.
    pub normal: DVec3,
    /// Unit normal for shading, which is interpolated on smooth meshes.
    pub shading_normal: DVec3,
    /// Texture coordinates.
    pub uv: DVec2,
}

/// The surface at a hit: the numbers of [`HitInfo`], without names and places.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HitSurface {
    /// Number of the object, as for [`RenderScene::objects`].
    pub object: u32,
    /// Number of the material, as for [`RenderScene::materials`].
    pub material: u32,
    /// World position.
    pub position: DVec3,
    /// Unit normal of the surface: outwards on solids, to the front on open surfaces.
    pub normal: DVec3,
    /// Unit normal for shading, which is interpolated on smooth meshes.
    pub shading_normal: DVec3,
    /// Texture coordinates.
    pub uv: DVec2,
}

impl RenderScene {
    /// The surface at a hit, without names and places. The arguments are those of [`RenderScene::describe`].
    ///
    /// # Panics
    /// If the hit is of another scene.
    pub fn surface(&self, ray: &Ray, hit: &Hit) -> HitSurface {
        let at = self.locate(hit.id);
        let appearance = at.group.appearance(at.prim, at.element);
        let point = self.surface_at(ray, hit);
        HitSurface {
            object: appearance.object,
            material: appearance.material.0,
            position: point.position,
            normal: point.n_geom,
            shading_normal: point.n_shade,
            uv: point.uv,
        }
    }

    /// What a ray has hit. `ray` is the ray, which does not start on a surface, and `hit` what [`Session::closest_hits`] has found for
    /// it in this scene.
    ///
    /// # Panics
    /// If the hit is of another scene.
    pub fn describe(&self, ray: &Ray, hit: &Hit) -> HitInfo {
        let surface = self.surface(ray, hit);
        let info = self.objects.get(surface.object);
        let mut span = info.as_ref().map_or(Span::NONE, |info| info.span);
        if let Some(line) = self.face_line(hit.id) {
            (span.line, span.column) = (line, 0);
        }
        HitInfo {
            t: hit.t,
            object: surface.object,
            kind: info.as_ref().map_or("object", |info| info.kind),
            name: info.and_then(|info| info.name),
            element: hit.id,
            material: surface.material,
            span,
            position: surface.position,
            normal: surface.normal,
            shading_normal: surface.shading_normal,
            uv: surface.uv,
        }
    }
}

impl Session {
    /// Finds the nearest hit of each ray with `range.min < t <= range.max`, as camera rays see the scene. Directions need not have length
    /// 1: `t` counts in their lengths. Neighbours in the list that are alike are searched together, with the same result.
    ///
    /// # Panics
    /// If the lists are not equally long.
    pub fn closest_hits(
        &self,
        scene: &RenderScene,
        rays: &[Ray],
        range: Interval,
        hits: &mut [Option<Hit>],
    ) {
        self.each_batch(scene, rays, hits, |searcher, rays, hits| {
            searcher.closest_hits(rays, range, hits);
        });
    }

    /// The surface at each hit of rays, as [`Session::closest_hits`] has found them in this scene.
    ///
    /// # Panics
    /// If the lists are not equally long, or a hit is of another scene.
    pub fn surfaces(
        &self,
        scene: &RenderScene,
        rays: &[Ray],
        hits: &[Option<Hit>],
        answers: &mut [Option<HitSurface>],
    ) {
        assert_eq!(rays.len(), hits.len(), "one hit for each ray");
        assert_eq!(rays.len(), answers.len(), "one answer for each ray");
        let surface = |((ray, hit), answer): ((&Ray, &Option<Hit>), &mut Option<HitSurface>)| {
            *answer = hit.as_ref().map(|hit| scene.surface(ray, hit));
        };
        if rays.len() <= BATCH {
            rays.iter().zip(hits).zip(answers).for_each(surface);
            return;
        }
        self.pool.install(|| {
            let both = rays.par_iter().zip(hits).zip(answers);
            both.with_min_len(BATCH).for_each(surface);
        });
    }

    /// Finds out for each ray whether an opaque surface is on it with `range.min < t <= range.max`, as shadow rays see the scene: surfaces
    /// that let light through do not count. For a ray from a point towards a light whose direction reaches to the light that is
    /// [`Interval::UNTIL_LIGHT`].
    ///
    /// # Panics
    /// If the lists are not equally long.
    pub fn occluded(
        &self,
        scene: &RenderScene,
        rays: &[Ray],
        range: Interval,
        answers: &mut [bool],
    ) {
        self.each_batch(scene, rays, answers, |searcher, rays, answers| {
            searcher.occluded(rays, range, answers);
        });
    }

    /// Finds for each point the object that it is inside of: the last one in the order of the scene, where there are several; `None` is
    /// outside of all. Solids have an inside, also half-spaces and CSG objects; meshes and other surfaces have none.
    ///
    /// # Panics
    /// If the lists are not equally long.
    pub fn inside(&self, scene: &RenderScene, points: &[DVec3], answers: &mut [Option<u32>]) {
        let region = points
            .iter()
            .filter(|point| point.is_finite())
            .fold(Aabb::EMPTY, |all, p| all.union(&Aabb::new(*p, *p)));
        self.pool.install(|| {
            let solids = Solids::near(scene, &region);
            self.each_batch(scene, points, answers, |_, points, answers| {
                for (point, answer) in points.iter().zip(answers) {
                    *answer = solids.around(scene, *point);
                }
            });
        });
    }

    /// Calls a function whose parallel iterators (those of the crate rayon) then use the threads of the session: for questions whose answers do not
    /// go into one list. [`RenderScene::searcher`] answers them.
    pub fn install<R: Send>(&self, call: impl FnOnce() -> R + Send) -> R {
        self.pool.install(call)
    }

    /// A list whose entries are computed on all threads: the rays of a long list of questions, say, whose memory alone takes a thread longer
    /// than all threads need to answer easy ones.
    pub fn list<T: Send>(&self, count: usize, entry: impl Fn(usize) -> T + Sync) -> Vec<T> {
        if count <= BATCH {
            return (0..count).map(entry).collect();
        }
        let numbers = (0..count).into_par_iter().with_min_len(BATCH);
        self.pool.install(|| numbers.map(&entry).collect())
    }

    /// Calls `ask` for parts of a list of questions and that of the answers: on this thread for few, on all threads for many.
    fn each_batch<Q: Sync, A: Send>(
        &self,
        scene: &RenderScene,
        questions: &[Q],
        answers: &mut [A],
        ask: impl Fn(&mut Searcher<'_>, &[Q], &mut [A]) + Sync,
    ) {
        assert_eq!(
            questions.len(),
            answers.len(),
            "one answer for each question"
        );
        if questions.len() <= BATCH {
            return ask(&mut scene.searcher(), questions, answers);
        }
        self.pool.install(|| {
            let questions = questions.par_chunks(BATCH);
            let both = questions.zip(answers.par_chunks_mut(BATCH));
            both.for_each_init(
                || scene.searcher(),
                |searcher, (questions, answers)| ask(searcher, questions, answers),
            );
        });
    }
}

/// The solids of a scene, with a structure that finds those around a point.
struct Solids {
    all: Vec<Filled>,
    boxes: AnyAccelerator,
}

impl Solids {
    /// The solids that may contain points of a region.
    fn near(scene: &RenderScene, region: &Aabb) -> Self {
        let has_inside = |prim: Prim| !matches!(prim.kind(), PrimKind::Triangle(..));
        let all = match region.is_empty() {
            true => vec![],
            false => scene.filled(region, has_inside),
        };
        let bounds: Vec<Aabb> = all.iter().map(|solid| solid.bounds).collect();
        Self {
            boxes: AnyAccelerator::build(Default::default(), &bounds),
            all,
        }
    }

    /// The object around a point that is the last one in the order of the scene.
    fn around(&self, scene: &RenderScene, point: DVec3) -> Option<u32> {
        if !point.is_finite() {
            return None;
        }
        let mut finder = Finder {
            solids: self,
            scene,
            point,
            last: None,
        };
        // A ray that ends where it starts meets the boxes around its origin.
        let ray = Ray::new(point, DVec3::X);
        let range = Interval::new(0.0, f64::MIN_POSITIVE);
        self.boxes
            .traverse(&ray, range, &mut finder, &mut TraversalStats::default());
        finder.last.map(|(_, object)| object)
    }
}

struct Finder<'a> {
    solids: &'a Solids,
    scene: &'a RenderScene,
    point: DVec3,
    /// Number of the solid, and of its object.
    last: Option<(u32, u32)>,
}

impl Visitor for Finder<'_> {
    fn visit(&mut self, id: u32, t_max: f64) -> f64 {
        if self.last.is_none_or(|(last, _)| id > last)
            && let Some(appearance) =
                self.solids.all[id as usize].appearance_at(self.scene, self.point)
        {
            self.last = Some((id, appearance.object));
        }
        t_max
    }
}
