use crate::args::ViewArgs;
use crate::input::{Input, Moment, threads};
use crate::output::{is_standard, say};
use crate::report::{Failure, Reporter};
use std::process::{Command, Stdio};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use strahl::Loaded;
use strahl::prelude::*;
use strahl_view::{Defaults, Request, ViewOptions, serve};

/// `strahl view`: serves a page that shows a scene.
pub(crate) fn run(args: &ViewArgs) -> Result<(), Failure> {
    let reporter = Reporter::new(false);
    if let Some(scene) = &args.scene
        && !scene.is_file()
    {
        let shown = scene.display();
        return Err(Failure::new(match scene {
            _ if is_standard(scene) => {
                "the viewer reads a scene again when it changes, so it needs a file, not the standard input".to_owned()
            }
            _ if scene.is_dir() => format!("{shown} is a folder, not a scene file"),
            _ => format!("there is no scene file {shown}"),
        }));
    }
    let session = match threads(args.threads, &reporter) {
        0 => Session::new(Threads::All),
        count => Session::new(Threads::Count(count)),
    };
    let picture = &args.picture;
    let defaults = Defaults {
        size: picture.size,
        sampling: picture.sampling.unwrap_or(Sampling::ADAPTIVE),
        seed: picture.seed,
        depth: picture.max_depth,
        cutoff: picture.adc_bailout,
        max_tree_rays: picture.max_tree_rays,
        shading: picture.shading,
        accelerator: args.accelerator.kind(),
        clock: args.pov.clock.unwrap_or(0.0),
    };
    let (format, pov, quality) = (args.format, args.pov.clone(), picture.quality);
    let load = move |request: &Request, stop: &Arc<AtomicBool>| {
        let input = match Input::new(Some(&request.path), format, &pov, request.size) {
            Ok(input) => input
                .at_quality(quality)
                .recording(true)
                .with_texts(request.texts.clone())
                .stopped_by(Arc::clone(stop)),
            Err(failure) => return failed(&failure),
        };
        let still = input.still();
        input.read_staged(Moment {
            clock: request.clock,
            ..still
        })
    };
    let options = ViewOptions {
        port: args.port,
        scene: args.scene.clone(),
        load: Box::new(load),
        defaults,
        session: session.map_err(Failure::new)?,
        edit: args.edit,
        editor: args.editor.clone(),
    };
    let mut printed = Ok(());
    serve(options, &mut |served| {
        printed = announce(&served.address, args.open, &reporter);
        if printed.is_err() {
            served.end();
        }
    })
    .map_err(Failure::new)?;
    printed
}

/// Prints the address, and opens the page if that is asked for.
fn announce(address: &str, open: bool, reporter: &Reporter) -> Result<(), Failure> {
    say!("{address}");
    if open {
        let opener = match () {
            () if cfg!(target_os = "macos") => "open",
            () if cfg!(windows) => "explorer",
            () => "xdg-open",
        };
        let mut command = Command::new(opener);
        command
            .arg(address)
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::null());
        match command.spawn() {
            // Waits for its end, so that no zombie is left.
            Ok(mut child) => drop(std::thread::spawn(move || child.wait())),
            Err(error) => reporter.warn(&format!("cannot open a browser with {opener}: {error}")),
        }
    }
    Ok(())
}

/// A scene that can't be read.
fn failed(failure: &Failure) -> Loaded {
    let message = match failure {
        Failure::Message(message) => message.clone(),
        _ => "the scene cannot be read".to_owned(),
    };
    Loaded {
        scene: None,
        diagnostics: vec![Diagnostic::error(message)],
        inputs: None,
    }
}
