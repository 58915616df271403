use crate::output::say;
use crate::report::Failure;
use strahl::Format;
use strahl::accel::AcceleratorKind;

/// `strahl formats`: lists formats and accelerators.
pub(crate) fn run() -> Result<(), Failure> {
    say!("Scenes (each may be compressed with gzip):");
    let files = strahl::formats::scene::formats().iter();
    let files = files.map(|f| (f.name, f.extensions, f.description));
    for (name, endings, description) in [Format::POV].into_iter().chain(files) {
        say!("  {name:12} {:16} {description}", extensions(endings));
    }
    say!("Pictures:");
    for format in strahl::formats::image::formats() {
        say!(
            "  {:12} {:16} {}",
            format.name,
            extensions(format.extensions),
            format.description
        );
    }
    say!("Accelerators (NAME or NAME:PARAMETER=VALUE,...; the picture is the same):");
    for kind in AcceleratorKind::ALL {
        say!("  {}", kind.name());
        for parameter in kind.parameters() {
            say!("    {:12} {}", parameter.to_string(), parameter.about);
        }
    }
    Ok(())
}

fn extensions(list: &[&str]) -> String {
    list.iter()
        .map(|e| format!(".{e}"))
        .collect::<Vec<_>>()
        .join(" ")
}
