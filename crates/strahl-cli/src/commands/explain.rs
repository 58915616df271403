use crate::args::{ExplainArgs, ExplainForm};
use crate::explain::{Chosen, Pixel, Shown, dot, explanation, json, text};
use crate::input::{Input, render_options};
use crate::output::say;
use crate::report::{Failure, Reporter};
use std::path::Path;
use std::sync::Arc;
use strahl::prelude::{Output, RenderOptions, RenderScene, Session, Threads};
use strahl::scene::FileId;
use strahl_view::{PicturePage, Text};

/// `strahl explain`: prints the ray tree of a pixel.
pub(crate) fn run(args: &ExplainArgs) -> Result<(), Failure> {
    let (scene_file, format) = (Some(args.scene.as_path()), args.scene_format);
    let input = Input::new(scene_file, format, &args.pov, args.picture.size)?
        .at_quality(args.picture.quality);
    let (scene, _) = input.compiled(input.still(), &args.accelerator, &Reporter::new(false))?;
    let options = render_options(&scene, &args.picture);
    let Some((x, y)) = args.pixel else {
        say!("{}", whole(args, &input, scene, &options)?);
        return Ok(());
    };
    if x >= options.width || y >= options.height {
        let (w, h) = (options.width, options.height);
        return Err(Failure::new(format!(
            "there is no pixel {x},{y} in a picture of {w}x{h} pixels; the last one is {},{}",
            w.saturating_sub(1),
            h.saturating_sub(1)
        )));
    }
    let tree = strahl::explain(&scene, &options, x, y).map_err(Failure::new)?;
    if let Some(Chosen::One(number)) = args.sample
        && number > tree.samples.len()
    {
        let count = tree.samples.len();
        return Err(Failure::new(format!(
            "there is no sample {number}; pixel {x},{y} has {count} of them with --sampling {}",
            options.sampling
        )));
    }
    let pixel = Pixel {
        at: (x, y),
        size: (options.width, options.height),
        sampling: options.sampling,
        tree: &tree,
    };
    let shown = Shown {
        sample: args.sample,
        rays: args.rays.0,
        digits: args.digits,
    };
    let printed = match args.format {
        ExplainForm::Text => text(&scene, &pixel, &shown),
        ExplainForm::Json => json(&scene, &pixel, &shown),
        ExplainForm::Dot => dot(&scene, &pixel, &shown),
        ExplainForm::Html => {
            let data = explanation(&scene, &pixel, &shown);
            strahl_view::explanation_page(&data, &input.name(), "en")
        }
    };
    say!("{printed}");
    Ok(())
}

/// A page with the whole picture, its objects and the trees of some pixels.
fn whole(
    args: &ExplainArgs,
    input: &Input<'_>,
    scene: RenderScene,
    options: &RenderOptions,
) -> Result<String, Failure> {
    if args.format != ExplainForm::Html {
        return Err(Failure::new(
            "which pixel? Give --pixel X,Y; only --format html shows a whole picture",
        ));
    }
    let session = Session::new(Threads::All).map_err(Failure::new)?;
    let mut view = Arc::new(scene).view(options.width, options.height);
    (view.sampling, view.seed) = (options.sampling, options.seed);
    view.trace = options.trace;
    let picture = session.picture(&view, &Output::default());
    let film = picture.map_err(Failure::new)?.film;
    let sources = view.scene().sources();
    let names = (0..).map_while(|number| sources.name(FileId(number)));
    // Those that are built in, and the standard input, are no files.
    let texts: Vec<(String, Text)> = names
        .filter_map(|name| Some((name.to_owned(), Text::read(Path::new(name)).ok()?)))
        .collect();
    let page = PicturePage {
        title: &input.name(),
        language: "en",
        texts: &texts,
        chosen: &[],
        trees: args.trees,
    };
    page.write(&session, &view, &film.pixels)
        .map_err(Failure::new)
}
