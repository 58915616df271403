use crate::report::Failure;

/// `strahl formats`: the tables of formats.
pub(crate) fn formats() -> Result<(), Failure> {
    println!("Scenes (each may be compressed with gzip):");
    for format in strahl::formats::scene::formats() {
        println!(
            "  {:8} {:16} {}",
            format.name,
            extensions(format.extensions),
            format.description
        );
    }
    println!("Pictures:");
    for format in strahl::formats::image::formats() {
        println!(
            "  {:8} {:16} {}",
            format.name,
            extensions(format.extensions),
            format.description
        );
    }
    Ok(())
}

fn extensions(list: &[&str]) -> String {
    list.iter()
        .map(|e| format!(".{e}"))
        .collect::<Vec<_>>()
        .join(" ")
}
