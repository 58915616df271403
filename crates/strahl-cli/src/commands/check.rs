use crate::args::CheckArgs;
use crate::input::Input;
use crate::output::say;
use crate::report::{Failure, Reporter};
use serde::Serialize;
use std::path::Path;
use strahl::scene::{Diagnostic, Severity, SourceMap};
use strahl::tracing::Prepared;

/// `strahl check`: prints all diagnostics of scenes, and whether the scenes could be rendered.
pub(crate) fn run(args: &CheckArgs) -> Result<(), Failure> {
    let reporter = Reporter::new(false);
    let mut checked = vec![];
    let mut failed = false;
    for scene in &args.scenes {
        let one = check_one(args, scene, &reporter)?;
        failed |= !one.ok;
        checked.push(one);
    }
    if args.json {
        let json = serde_json::to_string_pretty(&checked).map_err(Failure::new)?;
        say!("{json}");
    }
    match failed {
        true => Err(Failure::Reported),
        false => reporter.settle(),
    }
}

/// The result for a scene; its field names are part of the contract of `--json`.
#[derive(Debug, Serialize)]
struct Checked {
    file: String,
    /// True without errors.
    ok: bool,
    errors: usize,
    warnings: usize,
    diagnostics: Vec<Said>,
}

/// A diagnostic in JSON.
#[derive(Debug, Serialize)]
struct Said {
    severity: &'static str,
    message: String,
    file: Option<String>,
    line: Option<u32>,
    column: Option<u32>,
    length: Option<u32>,
    help: Vec<String>,
    trace: Vec<String>,
}

fn check_one(args: &CheckArgs, scene: &Path, reporter: &Reporter) -> Result<Checked, Failure> {
    let input = Input::new(Some(scene), args.format, &args.pov, None)?;
    let loaded = input.read(input.still(), false);
    let mut said: Vec<Said> = vec![];
    let mut tell = |diagnostics: &[Diagnostic], sources: Option<&SourceMap>| {
        said.extend(diagnostics.iter().map(|d| Said::of(d, sources)));
        match args.json {
            true => reporter.note(diagnostics),
            false => drop(reporter.print(diagnostics, sources)),
        }
    };
    tell(
        &loaded.diagnostics,
        loaded.scene.as_ref().map(|s| &s.sources),
    );
    if let (Some(scene), false) = (&loaded.scene, args.syntax) {
        let more = match Prepared::new(scene) {
            Ok(prepared) => prepared.warnings().to_vec(),
            Err(errors) => errors.0,
        };
        tell(&more, Some(&scene.sources));
    }
    let errors = said.iter().filter(|s| s.severity == "error").count();
    let checked = Checked {
        file: input.name(),
        ok: errors == 0 && loaded.scene.is_some(),
        errors,
        warnings: said.len() - errors,
        diagnostics: said,
    };
    if checked.ok && !args.json {
        match checked.warnings {
            0 => say!("{}: no problems", checked.file),
            n => say!(
                "{}: {}, with {n} warning{}",
                checked.file,
                if args.syntax {
                    "can be read"
                } else {
                    "renders"
                },
                if n == 1 { "" } else { "s" }
            ),
        }
    }
    Ok(checked)
}

impl Said {
    fn of(diagnostic: &Diagnostic, sources: Option<&SourceMap>) -> Self {
        let span = diagnostic.span;
        let known = |n: u32| (n > 0).then_some(n);
        let file = match &diagnostic.source {
            Some(source) => Some(source.file.clone()),
            None => sources
                .and_then(|s| s.locate(span))
                .map(|place| place.file.to_owned()),
        };
        Self {
            severity: match diagnostic.severity {
                Severity::Warning => "warning",
                Severity::Error => "error",
            },
            message: diagnostic.message.clone(),
            file,
            line: known(span.line),
            column: known(span.column),
            length: known(span.length),
            help: diagnostic.hints.clone(),
            trace: diagnostic.trace.clone(),
        }
    }
}
