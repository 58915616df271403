use crate::args::CheckArgs;
use crate::input::Input;
use crate::output::say;
use crate::report::{Failure, Reporter};
use strahl::tracing::Prepared;

/// `strahl check`: everything there is to say about a scene, and whether it could be rendered.
pub(crate) fn check(args: &CheckArgs) -> Result<(), Failure> {
    let (input, reporter) = (Input::of(&args.scene)?, Reporter::new(false));
    let loaded = input.read(input.still(), false);
    let mut failed = reporter.print(&loaded.diagnostics, None);
    let mut said = loaded.diagnostics.len();
    if let (Some(scene), false) = (&loaded.scene, args.syntax) {
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
        0 => say!("{}: no problems", input.name()),
        n => say!(
            "{}: {}, with {n} warning{}",
            input.name(),
            if args.syntax {
                "can be read"
            } else {
                "renders"
            },
            if n == 1 { "" } else { "s" }
        ),
    }
    Ok(())
}
