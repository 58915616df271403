use crate::args::SceneArgs;
use crate::input::read;
use crate::report::{Failure, print_diagnostics};
use strahl::tracing::Prepared;

/// `strahl check`: everything there is to say about a scene, and whether it could be rendered.
pub(crate) fn check(args: &SceneArgs) -> Result<(), Failure> {
    let loaded = read(args)?;
    let mut failed = print_diagnostics(&loaded.diagnostics, None, false);
    let mut said = loaded.diagnostics.len();
    if let Some(scene) = &loaded.scene {
        let more = match Prepared::new(scene) {
            Ok(prepared) => prepared.warnings().to_vec(),
            Err(errors) => errors,
        };
        failed |= print_diagnostics(&more, Some(&scene.sources), false);
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
