//! Methods of light transport plug into the trace loop: toys that show that it has the places for them.

use crate::common::{compiled, glass_and_mirrors};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::sync::Arc;
use strahl_geometry::{Cuboid, Plane, Sphere};
use strahl_math::{DVec3, Ray, det};
use strahl_render::transport::{
    Gather, GatherRay, Gathered, MediumIntegrator, MediumPath, MediumRay, MediumTerm, Prepass,
    Probe, Prober, SurfaceSample, load_prepass, save_prepass,
};
use strahl_render::{
    CompileOptions, Film, Output, RayKind, Region, RenderScene, Sampling, Session, Threads, View,
};
use strahl_scene::{Background, Camera, Fog, FogKind, ObjectExt, Scene, Span};
use strahl_shade::{AreaLight, Color, ColorFt, Light, Material};

/// Light from everywhere.
#[derive(Debug)]
struct Everywhere(Color);

impl Gather for Everywhere {
    fn name(&self) -> &str {
        "everywhere"
    }

    fn gather(&self, points: &[SurfaceSample], _: &mut Probe<'_, '_>, out: &mut [Gathered]) {
        for (point, out) in points.iter().zip(out) {
            out.radiance = point.diffuse * self.0;
        }
    }
}

/// The light of the whole hemisphere, by rays of one level.
#[derive(Debug)]
struct Hemisphere(u32);

impl Gather for Hemisphere {
    fn name(&self) -> &str {
        "hemisphere"
    }

    fn gather(&self, points: &[SurfaceSample], _: &mut Probe<'_, '_>, out: &mut [Gathered]) {
        for (point, out) in points.iter().zip(out) {
            if point.depth > 1 || point.diffuse.is_black() {
                continue;
            }
            let (x, y) = point.n_shade.any_orthonormal_pair();
            for k in 0..self.0 {
                // As many rays towards each part of the projected hemisphere.
                let r2 = (f64::from(k) + 0.5) / f64::from(self.0);
                let turn = f64::from(k) * 2.399_963_229_728_653;
                let (r, h) = (r2.sqrt(), (1.0 - r2).sqrt());
                let direction = x * (r * turn.cos()) + y * (r * turn.sin()) + point.n_shade * h;
                let share = point.diffuse / f64::from(self.0);
                out.rays.push(GatherRay { direction, share });
            }
        }
    }
}

/// Fog of one density in the air.
#[derive(Debug)]
struct Haze {
    distance: f64,
    color: Color,
}

impl MediumIntegrator for Haze {
    fn along(&self, path: &MediumPath, _: &mut Probe<'_, '_>) -> MediumTerm {
        if path.inside.is_some() {
            return MediumTerm::NONE;
        }
        let passes = det::exp(-(path.length / self.distance));
        MediumTerm {
            transmittance: Color::gray(passes),
            radiance: self.color * (1.0 - passes),
        }
    }
}

/// Light of the first light source that is scattered once towards the eye: places along the ray ask for it.
#[derive(Debug)]
struct SingleScattering;

impl MediumIntegrator for SingleScattering {
    fn along(&self, path: &MediumPath, probe: &mut Probe<'_, '_>) -> MediumTerm {
        let mut term = MediumTerm::NONE;
        if path.kind == MediumRay::Shadow {
            return term;
        }
        let step = path.length.min(20.0) / 16.0;
        let direction = path.ray.direction.normalize();
        for k in 0..16 {
            let place = path.ray.origin + direction * (step * (f64::from(k) + 0.5));
            if let Some((sample, visible)) = probe.light(0, place) {
                term.radiance += sample.color * visible * (0.01 * step);
            }
        }
        term
    }
}

fn session(threads: usize) -> Session {
    Session::new(Threads::Count(threads)).expect("threads")
}

fn view(description: &Scene) -> View {
    let (scene, _) = session(1)
        .compile(description, &CompileOptions::default())
        .expect("a scene");
    scene.view(48, 32)
}

fn film(view: &View, threads: usize) -> Film {
    let session = session(threads);
    let picture = session.picture(view, &Output::default());
    picture.expect("a picture").film
}

/// The picture of a view, which is the same for every way to trace it.
fn sure_film(view: &View) -> Film {
    let all = film(view, 1);
    assert_eq!(all.sha256(), film(view, 2).sha256(), "threads");
    let mut single = view.clone();
    (single.trace.packets, single.trace.beams) = (false, false);
    assert_eq!(all.sha256(), film(&single, 1).sha256(), "packets");
    let region = Region {
        x: 13,
        y: 5,
        width: 9,
        height: 17,
    };
    let output = Output {
        region: Some(region),
        ..Output::default()
    };
    let part = session(1).picture(view, &output).expect("a part").film;
    for y in 5..22 {
        for x in 13..22 {
            assert_eq!(part.pixel(x, y), all.pixel(x, y), "region");
        }
    }
    all
}

/// The sums of all trees of some pixels, in the numbers of explanations: the light that is gathered is a term of its own.
fn sums_are_exact(view: &View) -> (usize, usize) {
    let (mut gathered, mut rays) = (0, 0);
    for (x, y) in [(3, 3), (24, 16), (20, 20), (30, 20), (35, 22), (24, 30)] {
        let pixel = session(1).trees(view, x, y).expect("a pixel");
        assert_eq!(Some(pixel.film), film(view, 1).pixel(x, y));
        for tree in pixel.samples.iter().map(|sample| &sample.tree) {
            for node in &tree.nodes {
                let mut sums = [Color::BLACK; 4];
                // Waiting rays are taken from the last to the first, and sums go backwards.
                for child in node.children.iter().rev() {
                    let child = &tree.nodes[*child as usize];
                    let taken = child.report.share.of(child.total);
                    sums[child.report.kind as usize] += taken;
                    rays += usize::from(child.report.kind == RayKind::Gather);
                }
                let [_, reflected, transmitted, by_rays] = sums;
                let mut total = node.local + reflected + transmitted;
                if let Some(term) = &node.gathered {
                    gathered += 1;
                    let children = node.children.iter().rev();
                    let mut sum = term.radiance;
                    for child in children.map(|child| &tree.nodes[*child as usize]) {
                        if child.report.kind == RayKind::Gather {
                            sum += child.report.share.of(child.total);
                        }
                    }
                    total += sum;
                } else {
                    assert_eq!(by_rays, Color::BLACK);
                    if view.transport.gather.is_some() {
                        total += Color::BLACK;
                    }
                }
                total *= node.report.attenuation;
                if view.transport.medium.is_some() {
                    total += node.report.fog;
                }
                assert_eq!(total, node.total);
            }
        }
    }
    (gathered, rays)
}

#[test]
fn gathered_light_is_a_term_of_its_own() {
    let plain = view(&glass_and_mirrors());
    let lit = plain
        .clone()
        .with_gather(Arc::new(Everywhere(Color::gray(0.25))));
    assert_ne!(sure_film(&plain).sha256(), sure_film(&lit).sha256());
    let (gathered, _) = sums_are_exact(&lit);
    assert!(gathered > 6, "{gathered}");
    let json = session(1).explain(&lit, 24, 30).expect("a pixel").to_json();
    assert!(json.contains("\"method\": \"everywhere\""), "{json}");
    let antialiased = lit.with_sampling(Sampling::Grid(2));
    sure_film(&antialiased);
}

#[test]
fn a_matte_floor_shows_what_is_gathered() {
    let white = Material::matte(Color::gray(0.5));
    let scene = Scene::new()
        .add(Plane::new(DVec3::ZERO, DVec3::Y).material(white))
        .camera(Camera::perspective(
            DVec3::Y * 3.0,
            DVec3::ZERO,
            DVec3::Z,
            0.5,
        ))
        .light(Light::point(DVec3::Y * -5.0, Color::WHITE));
    let view = view(&scene).with_gather(Arc::new(Everywhere(Color::gray(0.5))));
    let dark = film(&view.scene().view(48, 32), 1)
        .pixel(10, 10)
        .expect("exists");
    let lit = film(&view, 1).pixel(10, 10).expect("exists");
    assert!((lit[0] - dark[0] - 0.25).abs() < 1e-6, "{lit:?} {dark:?}");
}

#[test]
fn rays_that_gather_are_a_generation() {
    let white = Material::matte(Color::gray(0.5));
    let mut scene = Scene::new()
        .add(Plane::new(DVec3::ZERO, DVec3::Y).material(white))
        .background(Background::Solid(Color::gray(0.8)))
        .camera(Camera::perspective(
            DVec3::new(0.0, 2.0, 4.0),
            DVec3::new(0.0, 0.5, 0.0),
            DVec3::Y,
            0.9,
        ));
    let gather = Arc::new(Hemisphere(64));
    let open = view(&scene).with_gather(gather.clone());
    let plain = view(&scene);
    let (with, without) = (film(&open, 1), film(&plain, 1));
    let value = |film: &Film, x, y| film.pixel(x, y).expect("exists")[1];
    // Nothing hides the sky: all of it is reflected.
    let gain = value(&with, 24, 30) - value(&without, 24, 30);
    assert!((gain - 0.4).abs() < 1e-6, "{gain}");
    // A ball hides a part of it, from the floor beneath most.
    let black = Material::matte(Color::BLACK);
    scene = scene.add(Sphere::new(DVec3::Y * 0.9, 0.8).material(black));
    let hidden = view(&scene).with_gather(gather);
    let film = sure_film(&hidden);
    let under = (0..32).map(|y| value(&film, 24, y)).fold(1.0, f32::min);
    assert!(under < 0.2 && value(&film, 2, 30) > 0.3, "{under}");
    let (gathered, rays) = sums_are_exact(&hidden);
    assert!(gathered > 0 && rays >= 64, "{gathered} {rays}");
}

#[test]
fn a_medium_along_rays_does_what_fog_does() {
    let (distance, color) = (9.0, Color::new(0.4, 0.5, 0.6));
    let mut scene = glass_and_mirrors();
    for light in &mut scene.lights {
        light.light.fogged = true;
    }
    let hazy = view(&scene).with_medium(Arc::new(Haze { distance, color }));
    let mut foggy = scene.clone();
    foggy.fogs.push(Fog {
        kind: FogKind::Constant,
        distance,
        color: ColorFt {
            rgb: color,
            filter: 0.0,
            transmit: 0.0,
        },
        turbulence: None,
        span: Span::default(),
    });
    let (haze, fog) = (sure_film(&hazy), sure_film(&view(&foggy)));
    assert_ne!(fog.sha256(), film(&view(&scene), 1).sha256());
    for y in 0..32 {
        for x in 0..48 {
            let (a, b) = (haze.pixel(x, y), fog.pixel(x, y));
            let (a, b) = (a.expect("exists"), b.expect("exists"));
            let near = a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-5);
            assert!(near, "{x} {y}: {a:?} {b:?}");
        }
    }
    sums_are_exact(&hazy);
}

/// Lets no light through that comes from light sources.
#[derive(Debug)]
struct Night;

impl MediumIntegrator for Night {
    fn along(&self, path: &MediumPath, _: &mut Probe<'_, '_>) -> MediumTerm {
        let transmittance = match path.kind {
            MediumRay::Shadow => Color::BLACK,
            MediumRay::Camera | MediumRay::Secondary => Color::WHITE,
        };
        MediumTerm {
            transmittance,
            ..MediumTerm::NONE
        }
    }
}

#[test]
fn a_medium_weakens_lights_of_every_kind() {
    let mut scene = glass_and_mirrors();
    for illumination in [false, true] {
        let mut lamp = Light::point(DVec3::new(2.0, 5.0, 5.0), Color::gray(0.5));
        lamp.area = Some(AreaLight {
            illumination,
            ..AreaLight::new(DVec3::X, DVec3::Z, 3, 3)
        });
        scene = scene.light(lamp);
    }
    let lit = view(&scene);
    let night = sure_film(&lit.clone().with_medium(Arc::new(Night)));
    scene.lights.clear();
    assert_eq!(night.sha256(), film(&view(&scene), 1).sha256());
    assert_ne!(night.sha256(), film(&lit, 1).sha256());
}

#[test]
fn a_path_leaves_no_surface_that_it_has_not_met() {
    let scene = compiled(&glass_and_mirrors());
    let mut prober = scene.prober();
    assert!(prober.leave(DVec3::Y).is_none());
    let down = prober.begin(&Ray::new(DVec3::new(0.0, 9.0, 0.0), DVec3::NEG_Y));
    assert!(prober.surface(&down).is_some() && prober.leave(DVec3::Y).is_some());
    let up = prober.begin(&Ray::new(DVec3::new(0.0, 9.0, 0.0), DVec3::Y));
    assert!(prober.leave(DVec3::Y).is_none());
    assert!(prober.surface(&up).is_none() && prober.leave(DVec3::Y).is_none());
}

#[test]
fn a_medium_asks_for_lights() {
    let wall = Cuboid::new(DVec3::new(-1.0, -1.0, -0.2), DVec3::new(1.0, 1.0, 0.0));
    let scene = Scene::new()
        .add(wall.material(Material::matte(Color::BLACK)))
        .light(Light::point(DVec3::new(0.0, 0.0, -8.0), Color::WHITE))
        .camera(Camera::perspective(
            DVec3::new(9.0, 0.0, 3.0),
            DVec3::new(0.0, 0.0, 3.0),
            DVec3::Y,
            0.8,
        ));
    let lit = view(&scene).with_medium(Arc::new(SingleScattering));
    let film = sure_film(&lit);
    let value = |x, y| film.pixel(x, y).expect("exists")[0];
    // In the middle rays go through the shadow of the wall.
    assert!(
        value(24, 16) < 0.8 * value(24, 1),
        "{} {}",
        value(24, 16),
        value(24, 1)
    );
}

/// The power of light that arrives on the surfaces in each cell of a grid.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
struct PhotonGrid {
    cells: Vec<([i32; 3], [f64; 3])>,
    emitted: f64,
}

impl PhotonGrid {
    const SIDE: f64 = 0.25;

    fn cell(place: DVec3) -> [i32; 3] {
        (place / Self::SIDE).floor().to_array().map(|x| x as i32)
    }
}

/// Photons through glass and from mirrors.
struct Photons {
    parts: u32,
    each: u32,
}

impl Photons {
    fn follow(prober: &mut Prober<'_>, ray: &Ray, mut power: Color) -> Option<(DVec3, Color)> {
        let mut path = prober.begin(ray);
        for _ in 0..6 {
            let surface = prober.surface(&path)?;
            let bright = |color: Color| color.max_component();
            let way = match (surface.transmitted, surface.mirrored) {
                (Some(way), _) if bright(surface.transmission) > 0.5 => {
                    power *= surface.transmission;
                    way
                }
                (_, Some(way)) if bright(surface.reflection) > 0.5 => {
                    power *= surface.reflection;
                    way
                }
                _ => return Some((surface.position, power)),
            };
            path = prober.leave(way).expect("a surface has been met");
        }
        None
    }
}

impl Prepass for Photons {
    type Value = PhotonGrid;
    type Part = PhotonGrid;

    fn begin(&self, _: &RenderScene) -> PhotonGrid {
        PhotonGrid::default()
    }

    fn parts(&self, _: &PhotonGrid, generation: u32) -> u32 {
        if generation < 2 { self.parts } else { 0 }
    }

    fn part(&self, prober: &mut Prober<'_>, _: &PhotonGrid, at: (u32, u32)) -> PhotonGrid {
        let scene = prober.probe().scene();
        let ball = (
            scene.bounds().center(),
            0.5 * scene.bounds().size().length(),
        );
        let mut found = BTreeMap::<[i32; 3], [f64; 3]>::new();
        let mut emitted = 0.0;
        for number in 0..self.each {
            // The points of a lattice, each once.
            let index = (at.0 * self.parts + at.1) * self.each + number;
            let count = f64::from(2 * self.parts * self.each);
            let u = f64::from(index) / count;
            let v = (f64::from(index) * 0.618_033_988_749_895).fract();
            for light in scene.lights().iter().map(|light| &light.light) {
                let Some(emission) = light.emit(ball, [u, v]) else {
                    continue;
                };
                let power = emission.power / count;
                emitted += power.g;
                if let Some((place, power)) = Self::follow(prober, &emission.ray, power) {
                    let cell = found.entry(PhotonGrid::cell(place)).or_default();
                    for (sum, x) in cell.iter_mut().zip([power.r, power.g, power.b]) {
                        *sum += x;
                    }
                }
            }
        }
        PhotonGrid {
            cells: found.into_iter().collect(),
            emitted,
        }
    }

    fn merge(&self, value: &mut PhotonGrid, part: PhotonGrid) {
        let mut cells: BTreeMap<_, _> = value.cells.drain(..).collect();
        for (cell, power) in part.cells {
            let sums: &mut [f64; 3] = cells.entry(cell).or_default();
            for (sum, x) in sums.iter_mut().zip(power) {
                *sum += x;
            }
        }
        value.cells = cells.into_iter().collect();
        value.emitted += part.emitted;
    }
}

impl Gather for PhotonGrid {
    fn name(&self) -> &str {
        "photons"
    }

    fn gather(&self, points: &[SurfaceSample], _: &mut Probe<'_, '_>, out: &mut [Gathered]) {
        for (point, out) in points.iter().zip(out) {
            let cell = Self::cell(point.position);
            if let Ok(at) = self.cells.binary_search_by_key(&cell, |entry| entry.0) {
                let [r, g, b] = self.cells[at].1;
                let area = Self::SIDE * Self::SIDE;
                out.radiance = point.diffuse * (Color::new(r, g, b) / area);
            }
        }
    }
}

#[test]
fn values_of_a_prepass_are_the_same_for_any_threads_and_from_a_file() {
    let scene = compiled(&glass_and_mirrors());
    let prepass = Photons {
        parts: 7,
        each: 300,
    };
    let value = session(1).prepass(&scene, &prepass);
    assert!(value.cells.len() > 100, "{}", value.cells.len());
    assert_eq!(session(2).prepass(&scene, &prepass), value);
    let stored: f64 = value.cells.iter().map(|cell| cell.1[1]).sum();
    assert!(stored > 0.2 * value.emitted && stored < value.emitted);

    let text = save_prepass("photons", "glass and mirrors", &value).expect("numbers");
    let read: PhotonGrid = load_prepass("photons", "glass and mirrors", &text).expect("the same");
    assert_eq!(read, value);
    let other = load_prepass::<PhotonGrid>("photons", "another scene", &text);
    let message = other.expect_err("another scene").to_string();
    assert!(message.contains("glass and mirrors"), "{message}");
    assert!(load_prepass::<PhotonGrid>("photons", "", "{").is_err());

    let plain = view(&glass_and_mirrors());
    let lit = plain.clone().with_gather(Arc::new(read));
    assert_ne!(sure_film(&lit).sha256(), film(&plain, 1).sha256());
    sums_are_exact(&lit);
}

#[test]
fn photons_pass_a_glass_ball() {
    // A beam from above on a ball of glass, whose focus is near the floor: the middle of the shadow gets five times the photons of an open floor.
    let floor = Plane::new(DVec3::Y * -1.6, DVec3::Y).material(Material::matte(Color::WHITE));
    let scene = compiled(
        &Scene::new()
            .add(floor)
            .add(Sphere::new(DVec3::ZERO, 1.0).material(Material::glass(1.5)))
            .light(Light::directional(DVec3::NEG_Y, Color::WHITE)),
    );
    let mut prober = scene.prober();
    let mut inside = 0;
    for k in 0..200 {
        let r = 0.9 * (f64::from(k) / 200.0).sqrt();
        let turn = f64::from(k) * PI * 0.77;
        let start = DVec3::new(r * turn.cos(), 5.0, r * turn.sin());
        let ray = Ray::new(start, DVec3::NEG_Y);
        let place = Photons::follow(&mut prober, &ray, Color::WHITE);
        let (place, _) = place.expect("the floor");
        assert!((place.y + 1.6).abs() < 1e-9, "{place}");
        inside += u32::from(place.with_y(0.0).length() < 0.3);
    }
    assert!(inside > 100, "{inside}");
}
