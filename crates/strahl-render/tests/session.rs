//! Sessions: views, sinks, stops and progressive pictures.

use crate::common::{compiled, every_shape, glass_and_mirrors, patches, rendered};
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, OnceLock};
use strahl_geometry::Sphere;
use strahl_math::DVec3;
use strahl_render::{
    CompileOptions, Film, Outcome, Output, Pass, PixelState, Refinement, Region, RenderError,
    RenderScene, Sampling, Session, Sink, Threads, Tile, TileOrder, TraceSettings, View,
};
use strahl_scene::{
    Background, Camera, CameraFace, CameraFront, Fog, FogKind, Lens, MeshCamera, MeshLayout,
    ObjectExt, Projection, Scene, Span,
};
use strahl_shade::{Color, ColorFt, Material, ShadingModel};

const SAMPLINGS: [Sampling; 7] = [
    Sampling::Center,
    Sampling::Corners,
    Sampling::Grid(1),
    Sampling::Grid(2),
    Sampling::Adaptive(Refinement {
        threshold: 0.05,
        ..Refinement::DEFAULT
    }),
    Sampling::Adaptive(Refinement {
        threshold: 0.0,
        depth: 2,
        ..Refinement::DEFAULT
    }),
    Sampling::Recursive(Refinement {
        threshold: 0.05,
        ..Refinement::DEFAULT
    }),
];

const PART: Region = Region {
    x: 13,
    y: 30,
    width: 83,
    height: 41,
};

fn session() -> Session {
    Session::new(Threads::Count(2)).expect("threads")
}

fn compile(session: &Session, description: &Scene) -> Arc<RenderScene> {
    let (scene, _warnings) = session
        .compile(description, &CompileOptions::default())
        .expect("a valid scene");
    scene
}

fn view(session: &Session, description: &Scene) -> View {
    compile(session, description).view(101, 75)
}

/// Ways to ask for a picture that give the same one.
fn outputs() -> Vec<Output> {
    let plain = Output::default();
    let coarse = Output {
        coarse_first: true,
        ..Output::default()
    };
    let part = Output {
        region: Some(PART),
        tile_order: TileOrder::Center,
        ..Output::default()
    };
    let coarse_part = Output {
        region: Some(PART),
        ..coarse.clone()
    };
    vec![plain, coarse, part, coarse_part]
}

/// Counts how often each pass hands over each pixel, and puts the parts together.
#[derive(Default)]
struct Collector {
    passes: Vec<Pass>,
    /// By pass.
    seen: Vec<Vec<u32>>,
    film: Option<Film>,
    /// Parts until it stops.
    patience: Option<usize>,
    changed: usize,
}

impl Collector {
    fn stopping_after(parts: usize) -> Self {
        Self {
            patience: Some(parts),
            ..Self::default()
        }
    }

    fn flow(&self) -> ControlFlow<()> {
        match self.patience {
            Some(0) => ControlFlow::Break(()),
            _ => ControlFlow::Continue(()),
        }
    }
}

impl Sink for Collector {
    fn pass(&mut self, pass: &Pass) -> ControlFlow<()> {
        if self.passes.last() != Some(pass) {
            assert_eq!(pass.number as usize, self.passes.len());
            self.passes.push(*pass);
            self.seen.push(vec![0; 101 * 75]);
        }
        self.flow()
    }

    fn tile(&mut self, tile: &Tile<'_>) -> ControlFlow<()> {
        assert_eq!(Some(&tile.pass), self.passes.last());
        let part = tile.film;
        assert_eq!(part.pixels.len() as u64, part.region.pixels());
        let film = self
            .film
            .get_or_insert_with(|| Film::try_new(101, 75, None, false).expect("small"));
        part.write_to(&mut film.pixels).expect("as large");
        let seen = self.seen.last_mut().expect("a pass has begun");
        let r = part.region;
        for y in r.y..r.y + r.height {
            for x in r.x..r.x + r.width {
                seen[(y * 101 + x) as usize] += 1;
            }
        }
        assert!(0 < tile.done && tile.done <= tile.of);
        self.changed += usize::from(tile.changed);
        if let Some(left) = &mut self.patience {
            *left -= 1;
        }
        self.flow()
    }
}

fn ignore(_: &Tile<'_>) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

#[test]
fn coarse_passes_change_no_bit_and_trace_no_ray_twice() {
    let session = session();
    for description in [glass_and_mirrors(), every_shape()] {
        let view = view(&session, &description);
        // The other eight rays of nine are traced in a packet.
        for sampling in SAMPLINGS.into_iter().chain([Sampling::Grid(3)]) {
            let view = view.clone().with_sampling(sampling);
            for region in [None, Some(PART)] {
                let [plain, coarse] = [false, true].map(|coarse_first| {
                    let output = Output {
                        region,
                        coarse_first,
                        ..Output::default()
                    };
                    session.picture(&view, &output).expect("a picture")
                });
                assert!(plain.film == coarse.film, "{sampling}");
                assert_eq!(plain.rays, coarse.rays, "{sampling}");
            }
        }
    }
}

#[test]
fn coarse_passes_change_no_other_channel() {
    let session = session();
    let mut view = view(&session, &glass_and_mirrors());
    // What lies in the way of a shadow ray is tested first for the next pixel: then tests depend on the order.
    view.trace.shadow_cache = false;
    for sampling in SAMPLINGS {
        let view = view.clone().with_sampling(sampling);
        let [plain, coarse] = [false, true].map(|coarse_first| {
            let output = Output {
                coarse_first,
                info: true,
                alpha: true,
                costs: true,
                ..Output::default()
            };
            session.picture(&view, &output).expect("a picture")
        });
        assert!(plain.film == coarse.film, "{sampling}");
        assert_eq!(plain.costs, coarse.costs, "{sampling}");
        assert!(plain.film.info.is_some() && plain.film.alpha.is_some() && plain.costs.is_some());
    }
}

/// Pictures smaller than a block of the first pass.
#[test]
fn coarse_passes_of_tiny_pictures() {
    let session = session();
    let scene = compile(&session, &glass_and_mirrors());
    for (width, height) in [(1, 1), (7, 3), (8, 9), (33, 1)] {
        for sampling in SAMPLINGS {
            let view = scene.view(width, height).with_sampling(sampling);
            let coarse = Output {
                coarse_first: true,
                ..Output::default()
            };
            let pictures = [Output::default(), coarse]
                .map(|output| session.picture(&view, &output).expect("a picture").film);
            assert!(pictures[0] == pictures[1], "{width} x {height}, {sampling}");
        }
    }
}

#[test]
fn a_picture_has_the_bits_of_a_plain_render() {
    let session = session();
    let description = glass_and_mirrors();
    let view = view(&session, &description);
    for sampling in SAMPLINGS {
        let plain = rendered(&compiled(&description), |o| {
            (o.width, o.height, o.sampling) = (101, 75, sampling);
        });
        let picture = session
            .picture(&view.clone().with_sampling(sampling), &Output::default())
            .expect("a picture");
        assert!(picture.film == plain.film && picture.rays == plain.rays);
        assert_eq!(picture.threads, 2);
    }
}

#[test]
fn a_sink_sees_every_pixel_once_per_pass() {
    let session = session();
    let view = view(&session, &glass_and_mirrors());
    for sampling in SAMPLINGS {
        let view = view.clone().with_sampling(sampling);
        for output in outputs() {
            let mut sink = Collector::default();
            let outcome = session.render(&view, &output, &mut sink).expect("renders");
            let film = outcome.finished().expect("nothing stops it").film;
            let passes = sink.passes.len();
            assert_eq!(passes, sink.passes[0].of as usize);
            assert_eq!(sink.passes[0].step, if output.coarse_first { 8 } else { 1 });
            for seen in &sink.seen {
                let region = film.region;
                for (index, count) in (0u32..).zip(seen) {
                    let (x, y) = (index % 101, index / 101);
                    let inside = region.x <= x
                        && x < region.x + region.width
                        && region.y <= y
                        && y < region.y + region.height;
                    assert_eq!(*count, u32::from(inside), "{sampling} {x} {y}");
                }
            }
            // The last pass hands over the picture.
            let collected = sink.film.expect("parts").part(film.region).expect("inside");
            assert!(collected.pixels == film.pixels, "{sampling}");
            assert!(sink.changed > 0);
        }
    }
}

/// Each pass shows more: the pixels of a coarse picture are those of the final one, repeated.
#[test]
fn coarse_pictures_show_samples_as_blocks() {
    let session = session();
    let view = view(&session, &glass_and_mirrors());
    let output = Output {
        coarse_first: true,
        ..Output::default()
    };
    let last = session.picture(&view, &output).expect("a picture").film;
    let mut checked = 0;
    let mut sink = |tile: &Tile<'_>| {
        let (step, r) = (tile.pass.step, tile.film.region);
        for y in r.y..r.y + r.height {
            for x in r.x..r.x + r.width {
                let from = last.pixel(x / step * step, y / step * step);
                assert_eq!(tile.film.pixel(x, y), from);
                checked += 1;
            }
        }
        ControlFlow::Continue(())
    };
    let outcome = session.render(&view, &output, &mut sink).expect("renders");
    assert!(outcome.finished().is_some());
    assert_eq!(checked, 4 * 101 * 75);
}

#[test]
fn a_stopped_picture_goes_on_to_the_same_bits() {
    let session = session();
    let view = view(&session, &glass_and_mirrors());
    for sampling in SAMPLINGS {
        let view = view.clone().with_sampling(sampling);
        for output in outputs() {
            let whole = session.picture(&view, &output).expect("a picture");
            let mut sink = Collector::stopping_after(1);
            let mut outcome = session.render(&view, &output, &mut sink).expect("renders");
            let mut stops = 0;
            let mut finals = 0;
            let rendered = loop {
                match outcome {
                    Outcome::Finished(rendered) => break rendered,
                    Outcome::Stopped(unfinished) => {
                        stops += 1;
                        // What is final is, and nothing is lost.
                        let states = unfinished.states();
                        let pixels = states.iter().zip(&unfinished.film().pixels);
                        for ((state, pixel), right) in pixels.zip(&whole.film.pixels) {
                            match state {
                                PixelState::Final => assert_eq!(pixel, right, "{sampling}"),
                                PixelState::Missing => assert_eq!(*pixel, [0.0; 3]),
                                PixelState::Provisional => {}
                            }
                        }
                        let count = |s| states.iter().filter(|state| **state == s).count();
                        assert!(count(PixelState::Final) >= finals, "{sampling}");
                        finals = count(PixelState::Final);
                        sink.patience = Some(1 + stops % 3);
                        outcome = session.resume(unfinished, &mut sink).expect("renders");
                    }
                }
            };
            assert!(stops > 1, "{sampling}");
            assert!(rendered.film == whole.film, "{sampling}");
            assert_eq!(rendered.rays, whole.rays, "{sampling}");
            for seen in &sink.seen {
                assert!(seen.iter().all(|n| *n <= 1));
                assert_eq!(
                    seen.iter().map(|n| u64::from(*n)).sum::<u64>(),
                    whole.film.region.pixels()
                );
            }
        }
    }
}

/// Every ray of a coarse pass is known to be final where there is one for each pixel.
#[test]
fn samples_of_coarse_passes_are_final() {
    let session = session();
    let view = view(&session, &glass_and_mirrors());
    let output = Output {
        coarse_first: true,
        ..Output::default()
    };
    let mut outcome = session
        .render(&view, &output, &mut |_: &Tile<'_>| ControlFlow::Break(()))
        .expect("renders");
    let (mut finals, mut stops) = (0, 0);
    while let Outcome::Stopped(unfinished) = outcome {
        let states = unfinished.states();
        finals = states.iter().filter(|s| **s == PixelState::Final).count();
        let traced = unfinished.rays().primary as usize;
        assert_eq!(finals, traced);
        stops += 1;
        let mut next = |_: &Tile<'_>| ControlFlow::Break(());
        outcome = session.resume(unfinished, &mut next).expect("renders");
    }
    assert!(stops > 4 && finals > 2000);
}

/// A stop is noticed within a tile, and costs no bits of a picture that goes on.
#[test]
fn a_stop_is_noticed_within_a_tile() {
    static STOP: OnceLock<Arc<AtomicBool>> = OnceLock::new();
    static PIXELS: AtomicU64 = AtomicU64::new(0);
    /// Read before and after each pixel; sets the stop at the twentieth reading.
    fn clock() -> u64 {
        let number = PIXELS.fetch_add(1, Ordering::Relaxed);
        if number == 20 {
            let stop = STOP.get().expect("it is set before the render");
            stop.store(true, Ordering::Relaxed);
        }
        number
    }
    let stop = STOP.get_or_init(Arc::default);
    let session = Session::new(Threads::Count(1)).expect("a thread");
    let output = Output {
        stop: Some(Arc::clone(stop)),
        costs: true,
        clock: Some(clock),
        ..Output::default()
    };
    for sampling in [Sampling::Center, Sampling::Corners] {
        PIXELS.store(0, Ordering::Relaxed);
        // One tile.
        let view = view(&session, &glass_and_mirrors())
            .with_size(32, 32)
            .with_sampling(sampling);
        let mut none = |_: &Tile<'_>| panic!("nothing is ready");
        let outcome = session.render(&view, &output, &mut none);
        let Ok(Outcome::Stopped(unfinished)) = outcome else {
            panic!("it is stopped");
        };
        assert!(PIXELS.load(Ordering::Relaxed) < 40);
        assert_eq!(unfinished.rays().primary, 0, "half a tile is no tile");
        assert!(matches!(
            session.picture(&view, &output),
            Err(RenderError::Cancelled)
        ));
        stop.store(false, Ordering::Relaxed);
        let mut all = |_: &Tile<'_>| ControlFlow::Continue(());
        let outcome = session.resume(unfinished, &mut all).expect("it goes on");
        let plain = session.picture(&view, &Output::default());
        assert!(outcome.into_film().pixels == plain.expect("a picture").film.pixels);
    }
}

/// A light is moved without building anything, and gives the bits of a scene that was compiled with it there.
#[test]
fn a_moved_light_gives_the_bits_of_a_scene_compiled_with_it() {
    let session = session();
    let mut description = glass_and_mirrors();
    let before = view(&session, &description);
    let to = DVec3::new(-2.0, 5.0, 3.0);
    let moved = before
        .scene()
        .with_light_at(0, to)
        .expect("it has a position");
    let moved = Arc::new(moved).view(before.width, before.height);
    let picture = |view: &View| {
        let picture = session.picture(view, &Output::default());
        picture.expect("a picture").film
    };
    let light = &mut description.lights[0].light;
    *light = light.moved_to(to).expect("it has a position");
    let anew = view(&session, &description);
    assert!(picture(&moved) == picture(&anew));
    assert!(picture(&moved) != picture(&before));
    let count = before.scene().lights().len();
    assert!(before.scene().with_light_at(count, to).is_none());
}

/// A stop at the beginning of a pass traces nothing of it.
#[test]
fn a_pass_may_be_declined() {
    struct Decliner;
    impl Sink for Decliner {
        fn pass(&mut self, pass: &Pass) -> ControlFlow<()> {
            match pass.refines {
                true => ControlFlow::Break(()),
                false => ControlFlow::Continue(()),
            }
        }
        fn tile(&mut self, _: &Tile<'_>) -> ControlFlow<()> {
            ControlFlow::Continue(())
        }
    }
    let session = session();
    let view = view(&session, &glass_and_mirrors()).with_sampling(Sampling::ADAPTIVE);
    let outcome = session
        .render(&view, &Output::default(), &mut Decliner)
        .expect("renders");
    let Outcome::Stopped(unfinished) = outcome else {
        panic!("the second pass was declined");
    };
    let plain = session
        .picture(
            &view.clone().with_sampling(Sampling::Center),
            &Output::default(),
        )
        .expect("a picture");
    assert!(*unfinished.film() == plain.film && unfinished.rays() == plain.rays);
    assert!(unfinished.pass().refines);
    let rest = session.resume(unfinished, &mut ignore).expect("renders");
    let whole = session
        .picture(&view, &Output::default())
        .expect("a picture");
    assert!(rest.into_film() == whole.film);
}

#[test]
#[should_panic(expected = "the sink has failed")]
fn a_sink_that_panics_ends_the_render() {
    let session = session();
    let view = view(&session, &glass_and_mirrors());
    let mut sink = |_: &Tile<'_>| -> ControlFlow<()> { panic!("the sink has failed") };
    let _ = session.render(&view, &Output::default(), &mut sink);
}

/// Cameras of several kinds, one of them in the glass ball, one in the bubble in it.
fn cameras() -> Vec<Camera> {
    let target = DVec3::new(0.5, -0.2, 0.3);
    let mut lens = Camera::perspective(DVec3::new(3.0, 2.0, 5.0), target, DVec3::Y, 0.6);
    lens.lens = Some(Lens::new(0.4, target, 12));
    let mut tall = Camera::perspective(DVec3::new(-4.0, 1.0, 4.0), target, DVec3::Y, 0.9);
    tall.aspect = Some(0.5);
    let faces = (0..101 * 75)
        .map(|n| {
            let at = DVec3::new(
                f64::from(n % 101) * 0.05 - 2.5,
                3.0 - f64::from(n / 101) * 0.05,
                5.0,
            );
            CameraFace {
                corners: [at, at + DVec3::X * 0.03, at + DVec3::Y * 0.03],
                front: CameraFront::Clockwise,
                normals: None,
                uv: None,
            }
        })
        .collect::<Vec<_>>();
    let mut mesh = Camera::perspective(DVec3::Z, DVec3::ZERO, DVec3::Y, 1.0);
    mesh.projection = Projection::Mesh(Arc::new(MeshCamera {
        layout: MeshLayout::Each(1),
        meshes: vec![faces.into()],
        offset: 0.01,
        reversed: false,
        smooth: false,
    }));
    vec![
        Camera::orthographic(DVec3::new(2.0, 3.0, 4.0), target, DVec3::Y, 5.0),
        Camera::perspective(DVec3::new(0.6, 0.1, 0.4), target, DVec3::Y, 1.2),
        Camera::perspective(DVec3::new(0.1, 0.1, 0.0), DVec3::X, DVec3::Y, 1.5),
        lens,
        tall,
        mesh,
    ]
}

#[test]
fn another_camera_is_as_if_compiled_with_it() {
    let session = session();
    let foggy = {
        let mut scene = glass_and_mirrors();
        scene.fogs.push(Fog {
            kind: FogKind::Constant,
            distance: 20.0,
            color: ColorFt::opaque(Color::gray(0.6)),
            turbulence: None,
            span: Span::NONE,
        });
        scene
    };
    for description in [glass_and_mirrors(), every_shape(), patches(), foggy] {
        let scene = compile(&session, &description);
        let view = scene.view(101, 75);
        let mut hashes = vec![];
        for camera in cameras() {
            let moved = view.clone().with_camera(camera.clone());
            // The same scene, so the same accelerators.
            assert!(Arc::ptr_eq(moved.scene(), &scene));
            assert!(std::ptr::eq(
                moved.scene().accelerator(),
                scene.accelerator()
            ));
            let anew = compiled(&description.clone().camera(camera));
            let anew = rendered(&anew, |o| (o.width, o.height) = (101, 75));
            let picture = session
                .picture(&moved, &Output::default())
                .expect("a picture");
            assert!(picture.film == anew.film && picture.rays == anew.rays);
            hashes.push(picture.film.sha256());
        }
        hashes.sort();
        hashes.dedup();
        assert_eq!(
            hashes.len(),
            cameras().len(),
            "each camera sees something else"
        );
    }
}

/// The eye is in coloured glass, and knows it.
#[test]
fn the_eye_may_move_into_a_solid() {
    let session = session();
    let glass = Material {
        absorption: Color::new(2.0, 0.1, 0.1),
        ..Material::glass(1.0)
    };
    let outside = Camera::perspective(DVec3::Z * 9.0, DVec3::ZERO, DVec3::Y, 0.5);
    let inside = Camera::perspective(DVec3::Z, DVec3::ZERO, DVec3::Y, 0.5);
    let description = Scene::new()
        .add(Sphere::new(DVec3::ZERO, 3.0).material(glass))
        .background(Background::Solid(Color::WHITE))
        .camera(outside);
    let scene = compile(&session, &description);
    let moved = scene.view(9, 9).with_camera(inside.clone());
    let film = session
        .picture(&moved, &Output::default())
        .expect("a picture")
        .film;
    let [r, g, b] = film.pixel(4, 4).expect("the middle");
    // Four units of glass between the eye and the white.
    assert!(
        (f64::from(r).ln() + 8.0).abs() < 0.01 && g == b,
        "{r} {g} {b}"
    );
    let anew = compiled(&description.camera(inside));
    let anew = rendered(&anew, |o| (o.width, o.height) = (9, 9));
    assert!(film == anew.film);
}

/// Lights that strahl adds to bare objects don't follow the camera.
#[test]
fn lights_of_a_bare_object_stay_where_they_are() {
    let session = session();
    let bare = Scene::new().add(Sphere::new(DVec3::ZERO, 1.0));
    let scene = compile(&session, &bare);
    let camera = Camera::perspective(DVec3::new(3.0, 1.0, -4.0), DVec3::ZERO, DVec3::Y, 0.7);
    let film = session
        .picture(
            &scene.view(32, 32).with_camera(camera.clone()),
            &Output::default(),
        )
        .expect("a picture")
        .film;
    let mut lit = bare.camera(camera);
    lit.lights = scene.lights().to_vec();
    lit.background = Some(Background::Gradient {
        up: scene.camera().up.normalize(),
        bottom: Color::gray(0.12),
        top: Color::new(0.32, 0.36, 0.42),
    });
    let anew = rendered(&compiled(&lit), |o| (o.width, o.height) = (32, 32));
    assert!(film == anew.film);
}

#[test]
fn settings_of_a_view_are_those_of_a_render() {
    let session = session();
    let description = glass_and_mirrors();
    let view = view(&session, &description);
    let scene = compiled(&description);
    type Change = fn(&mut TraceSettings);
    let changes: [Change; 3] = [
        |t| t.max_depth = 2,
        |t| t.adc_bailout = 0.3,
        |t| t.force_shading = Some(ShadingModel::Lambert),
    ];
    let views = [
        view.clone().with_depth(2),
        view.clone().with_cutoff(0.3),
        view.clone().with_shading(ShadingModel::Lambert),
    ];
    let before = session
        .picture(&view, &Output::default())
        .expect("a picture");
    for (view, change) in views.iter().zip(changes) {
        let picture = session
            .picture(view, &Output::default())
            .expect("a picture");
        let anew = rendered(&scene, |o| {
            (o.width, o.height) = (101, 75);
            change(&mut o.trace);
        });
        assert!(picture.film == anew.film && picture.film != before.film);
    }
}

#[test]
fn two_views_are_rendered_at_once() {
    for threads in [1, 2, 3] {
        let session = Session::new(Threads::Count(threads)).expect("threads");
        assert_eq!(session.threads(), threads);
        let scenes = [glass_and_mirrors(), every_shape()].map(|d| view(&session, &d));
        let views: Vec<View> = scenes
            .iter()
            .map(|view| view.clone().with_sampling(Sampling::Grid(2)))
            .collect();
        let output = Output {
            coarse_first: true,
            ..Output::default()
        };
        let alone: Vec<Film> = views
            .iter()
            .map(|view| session.picture(view, &output).expect("a picture").film)
            .collect();
        std::thread::scope(|scope| {
            for _ in 0..2 {
                for (view, alone) in views.iter().zip(&alone) {
                    let (session, output) = (session.clone(), &output);
                    scope.spawn(move || {
                        let mut sink = Collector::default();
                        let outcome = session.render(view, output, &mut sink).expect("renders");
                        assert!(outcome.into_film() == *alone);
                        assert!(sink.seen.iter().flatten().all(|n| *n == 1));
                    });
                }
            }
        });
    }
}

/// A sink may use the session itself.
#[test]
fn a_sink_may_render() {
    let session = Session::new(Threads::Count(1)).expect("a thread");
    let outer = view(&session, &glass_and_mirrors());
    let inner = view(&session, &every_shape()).with_size(20, 20);
    let mut films = vec![];
    let mut sink = |_: &Tile<'_>| {
        let picture = session
            .picture(&inner, &Output::default())
            .expect("a picture");
        films.push(picture.film);
        ControlFlow::Continue(())
    };
    let outcome = session
        .render(&outer, &Output::default(), &mut sink)
        .expect("renders");
    let plain = session
        .picture(&outer, &Output::default())
        .expect("a picture");
    assert!(outcome.into_film() == plain.film);
    assert!(films.len() == 12 && films.iter().all(|film| *film == films[0]));
}

#[test]
fn impossible_pictures_are_named() {
    let session = session();
    let view = view(&session, &glass_and_mirrors());
    let empty = view.clone().with_size(0, 5);
    let flat = view
        .clone()
        .with_camera(Camera::perspective(DVec3::ZERO, DVec3::X, DVec3::Y, 0.0));
    let error = |view: &View| {
        let outcome = session.render(view, &Output::default(), &mut ignore);
        outcome.expect_err("impossible").to_string()
    };
    assert!(error(&empty).contains("0 x 5"));
    assert!(error(&flat).contains("sees nothing"));
    assert!(matches!(
        session.explain(&view, 101, 0),
        Err(RenderError::Film(_))
    ));
    let problems = session
        .compile(
            &Scene::new().camera(flat.camera.clone()),
            &CompileOptions::default(),
        )
        .expect_err("the camera sees nothing");
    assert!(problems.to_string().contains("sees nothing"));
    let (_, warnings) = session
        .compile(&Scene::new(), &CompileOptions::default())
        .expect("empty, but valid");
    assert!(warnings[0].message.contains("no objects"));
}

/// What a pixel's ray trees add up to is in the picture, also of a view with another camera.
#[test]
fn trees_of_a_view_are_those_of_its_picture() {
    let session = session();
    let view = view(&session, &glass_and_mirrors());
    for (camera, sampling) in cameras().into_iter().zip(SAMPLINGS) {
        let view = view.clone().with_camera(camera).with_sampling(sampling);
        let film = session
            .picture(&view, &Output::default())
            .expect("a picture")
            .film;
        for (x, y) in [(0, 0), (50, 37), (60, 40), (100, 74)] {
            let tree = session.explain(&view, x, y).expect("a pixel");
            assert_eq!(Some(tree.film), film.pixel(x, y), "{sampling}");
        }
    }
}
