use crate::args::{ExplainArgs, ExplainForm};
use crate::explain::{dot, json, text};
use crate::input::{Input, render_options};
use crate::output::say;
use crate::report::{Failure, Reporter};

/// `strahl explain`: the ray tree of a pixel.
pub(crate) fn explain(args: &ExplainArgs) -> Result<(), Failure> {
    let (scene_file, format) = (Some(args.scene.as_path()), args.scene_format);
    let input = Input::new(scene_file, format, &args.pov, args.picture.size)?;
    let (scene, _) = input.compiled(input.still(), &args.accelerator, &Reporter::new(false))?;
    let options = render_options(&scene, &args.picture);
    let (x, y) = args.pixel;
    if x >= options.width || y >= options.height {
        let (w, h) = (options.width, options.height);
        return Err(Failure::new(format!(
            "there is no pixel {x},{y} in a picture of {w}x{h} pixels; the last one is {},{}",
            w.saturating_sub(1),
            h.saturating_sub(1)
        )));
    }
    let tree = strahl::explain(&scene, &options, x, y).map_err(Failure::new)?;
    let printed = match args.format {
        ExplainForm::Text => text(&scene, &tree, args.pixel),
        ExplainForm::Json => json(&scene, &tree, args.pixel),
        ExplainForm::Dot => dot(&scene, &tree, args.pixel),
    };
    say!("{printed}");
    Ok(())
}
