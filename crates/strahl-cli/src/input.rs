use crate::args::{PictureArgs, SceneArgs};
use crate::report::{Failure, print_diagnostics};
use std::io::Read;
use std::time::Instant;
use strahl::formats::scene::{Loaded, load_bytes, load_path};
use strahl::scene::Scene;
use strahl::tracing::{Prepared, RenderOptions, RenderScene};

/// The size of pictures of scenes that name none.
const DEFAULT_SIZE: (u32, u32) = (800, 600);

/// Seconds spent, phase by phase.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct LoadTimes {
    pub(crate) load: f64,
    pub(crate) compile: f64,
    /// The part of `compile` spent building acceleration structures.
    pub(crate) build: f64,
}

/// Reads a scene and prints what there is to say about it.
pub(crate) fn load(args: &SceneArgs, quiet: bool) -> Result<Scene, Failure> {
    let loaded = read(args)?;
    let failed = print_diagnostics(&loaded.diagnostics, None, quiet);
    match loaded.scene {
        Some(scene) if !failed => Ok(scene),
        _ => Err(Failure::Reported),
    }
}

/// Reads a scene with its diagnostics.
pub(crate) fn read(args: &SceneArgs) -> Result<Loaded, Failure> {
    if args.scene.as_os_str() != "-" {
        return Ok(load_path(&args.scene, args.format));
    }
    let Some(format) = args.format else {
        return Err(Failure::new(
            "a scene from the standard input needs --format NAME (see `strahl formats`)",
        ));
    };
    let mut bytes = Vec::new();
    std::io::stdin()
        .lock()
        .read_to_end(&mut bytes)
        .map_err(|e| Failure::new(format!("cannot read the standard input: {e}")))?;
    Ok(load_bytes(bytes, "<stdin>", format, None))
}

/// Reads and compiles a scene.
pub(crate) fn compiled(
    args: &SceneArgs,
    picture: &PictureArgs,
    quiet: bool,
) -> Result<(RenderScene, LoadTimes), Failure> {
    let start = Instant::now();
    let scene = load(args, quiet)?;
    let loaded = Instant::now();
    let prepared = match Prepared::new(&scene) {
        Ok(prepared) => prepared,
        Err(errors) => {
            print_diagnostics(&errors, Some(&scene.sources), quiet);
            return Err(Failure::Reported);
        }
    };
    print_diagnostics(prepared.warnings(), Some(&scene.sources), quiet);
    drop(scene);
    let build_start = Instant::now();
    let compiled = prepared.build(picture.accelerator);
    let times = LoadTimes {
        load: (loaded - start).as_secs_f64(),
        compile: loaded.elapsed().as_secs_f64(),
        build: build_start.elapsed().as_secs_f64(),
    };
    Ok((compiled, times))
}

/// The options that decide the values of pixels.
pub(crate) fn render_options(scene: &RenderScene, args: &PictureArgs) -> RenderOptions {
    let (width, height) = args.size.or(scene.settings().size).unwrap_or(DEFAULT_SIZE);
    let mut options = RenderOptions::new(scene, width, height);
    options.sampling = args.sampling;
    options.seed = args.seed;
    options.trace.max_tree_rays = args.max_tree_rays;
    options.trace.force_shading = args.shading;
    if let Some(depth) = args.max_depth {
        options.trace.max_depth = depth;
    }
    if let Some(weight) = args.adc_bailout {
        options.trace.adc_bailout = weight;
    }
    options
}
