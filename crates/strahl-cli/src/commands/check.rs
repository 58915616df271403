use crate::args::SceneArgs;
use crate::input::Input;
use crate::report::{Failure, Reporter};
use strahl::tracing::Prepared;

/// `strahl check`: everything there is to say about a scene, and whether it could be rendered.
pub(crate) fn check(args: &SceneArgs) -> Result<(), Failure> {
    let (input, reporter) = (Input::of(args)?, Reporter::new(false));
    let loaded = input.read(input.still(), false);
    let mut failed = reporter.print(&loaded.diagnostics, None);
    let mut said = loaded.diagnostics.len();
    if let Some(scene) = &loaded.scene {
        let more = match Prepared::new(scene) {
            Ok(prepared) => prepared.warnings().to_vec(),
            Err(errors) => errors,
        };
        failed |= reporter.print(&more, Some(&scene.sources));
        said += more.len();
    }
    if failed || loaded.scene.is_none() {
        return Err(Failure::Reported);
    }
    match said {
        0 => println!("{}: no problems", args.scene.display()),
        n => println!(
            "{}: renders, with {n} warning{}",
            args.scene.display(),
            if n == 1 { "" } else { "s" }
        ),
    }
    Ok(())
}
