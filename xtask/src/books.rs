//! Tests of what the repository's books say of its files.

use std::fs;
use std::path::{Path, PathBuf};

/// Files that stand for whatever somebody adds.
const PLACEHOLDERS: &[&str] = &[
    "<family>/mod.rs",
    "<family>/x.rs",
    "commands/x.rs",
    "image/x.rs",
    "objects/x.rs",
    "patterns/x.rs",
    "scene/x.rs",
    "strahl-accel/src/x.rs",
];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Adds the files with this ending below a folder.
fn add_files(folder: &Path, ending: &str, files: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            add_files(&path, ending, files);
        } else if path.extension().is_some_and(|e| e == ending) {
            files.push(path);
        }
    }
}

/// The books: what people read to find their way.
fn books() -> Vec<PathBuf> {
    let mut books = ["README.md", "ARCHITECTURE.md", "CONTRIBUTING.md"]
        .map(|name| root().join(name))
        .to_vec();
    add_files(&root().join("docs/src"), "md", &mut books);
    books
}

/// The source files of the workspace.
fn sources() -> Vec<PathBuf> {
    let mut sources = Vec::new();
    for folder in ["crates", "xtask/src", "fuzz/fuzz_targets"] {
        add_files(&root().join(folder), "rs", &mut sources);
    }
    sources
}

/// The names of source files in a text.
fn source_files(text: &str) -> impl Iterator<Item = &str> {
    let is_part = |c: char| c.is_alphanumeric() || "_-./<>".contains(c);
    let words = text.split(move |c| !is_part(c));
    words
        .map(|word| word.trim_end_matches('.'))
        .filter(|word| word.ends_with(".rs"))
}

#[test]
fn source_files_that_books_name_exist() {
    let sources = sources();
    let (mut named, mut missing) = (0, Vec::new());
    for book in books() {
        let text = fs::read_to_string(&book).unwrap();
        for name in source_files(&text) {
            named += 1;
            let exists = sources.iter().any(|path| path.ends_with(name));
            let stands_for = PLACEHOLDERS.iter().any(|p| Path::new(name).ends_with(p));
            if !exists && !stands_for {
                missing.push(format!("{}: {name}", book.display()));
            }
        }
    }
    assert!(named > 50, "only {named} names were found");
    assert!(missing.is_empty(), "these files don't exist: {missing:#?}");
}

/// An example of a recipe: what it is called in the table, the words that name it in code, the folders where it may be named, and its own
/// files there.
struct Example {
    name: &'static str,
    words: &'static [&'static str],
    folders: &'static [&'static str],
    own: &'static [&'static str],
}

const EXAMPLES: &[Example] = &[
    Example {
        name: "Mandelbulb",
        words: &["Mandelbulb", "mandelbulb"],
        folders: &["strahl-geometry", "strahl-scene", "strahl-render", "strahl"],
        own: &["fractal/mandelbulb/"],
    },
    Example {
        name: "Octree",
        words: &["Octree", "octree"],
        folders: &[
            "strahl-accel",
            "strahl-scene",
            "strahl-render",
            "strahl",
            "strahl-cli",
        ],
        own: &["octree/"],
    },
    Example {
        name: "boxed",
        words: &["Boxed", "boxed"],
        folders: &["strahl-shade", "strahl-sdl"],
        own: &["patterns/plain.rs"],
    },
    Example {
        name: "mandelbulb",
        words: &["Mandelbulb", "mandelbulb"],
        folders: &["strahl-sdl"],
        own: &["objects/mandelbulb.rs"],
    },
    Example {
        name: "gltf",
        words: &["Gltf", "gltf"],
        folders: &["strahl-formats", "strahl", "strahl-cli", "strahl-view"],
        own: &["scene/gltf/"],
    },
    Example {
        name: "ppm",
        words: &["Ppm", "ppm"],
        folders: &["strahl-formats", "strahl", "strahl-cli", "strahl-view"],
        own: &["image/ppm.rs"],
    },
    Example {
        name: "Beam",
        words: &["LightKind::Beam"],
        folders: ALL_BUT_PYTHON,
        own: &["shade/src/light.rs"],
    },
    Example {
        name: "ObjectId",
        words: &["ShadingModel::ObjectId"],
        folders: ALL_BUT_PYTHON,
        own: &["shade/src/reflectance.rs"],
    },
    Example {
        name: "BlinnPhong",
        words: &["ShadingModel::BlinnPhong"],
        folders: ALL_BUT_PYTHON,
        own: &["shade/src/reflectance.rs", "scene/src/settings.rs"],
    },
    Example {
        name: "heatmap",
        words: &["Heatmap", "HeatmapArgs", "heatmap"],
        folders: &["strahl-cli"],
        own: &["commands/heatmap.rs"],
    },
];

/// Python has a recipe of its own.
const ALL_BUT_PYTHON: &[&str] = &[
    "strahl",
    "strahl-cli",
    "strahl-formats",
    "strahl-render",
    "strahl-scene",
    "strahl-sdl",
    "strahl-shade",
    "strahl-view",
];

/// The code of a file without its tests, line by line without comments and texts.
fn code(text: &str) -> impl Iterator<Item = String> {
    let text = text
        .split("#[cfg(test)]\nmod tests {")
        .next()
        .unwrap_or(text);
    text.lines().map(|line| {
        let line = line.split("//").next().unwrap_or(line);
        // Every second piece between quotation marks is a text.
        line.split('"').step_by(2).collect::<Vec<_>>().join(" ")
    })
}

/// Whether a line names one of these words, and not only as a part of a longer one.
fn names(line: &str, words: &[&str]) -> bool {
    let continues = |c: char| c.is_alphanumeric() || c == '_';
    words.iter().any(|word| {
        line.match_indices(word).any(|(at, _)| {
            !line[..at].ends_with(continues) && !line[at + word.len()..].starts_with(continues)
        })
    })
}

/// The files that name an example, with the number of lines that do, in order.
fn named(example: &Example) -> Vec<(PathBuf, usize)> {
    let mut found = Vec::new();
    for folder in example.folders {
        let mut files = Vec::new();
        let crates = root().join("crates");
        add_files(&crates.join(folder).join("src"), "rs", &mut files);
        for file in files {
            let path = file.strip_prefix(&crates).unwrap();
            let shown = path.display().to_string().replace('\\', "/");
            let is_test = shown.ends_with("tests.rs") || shown.contains("/tests/");
            if is_test || example.own.iter().any(|own| shown.contains(own)) {
                continue;
            }
            let text = fs::read_to_string(&file).unwrap();
            let count = code(&text)
                .filter(|line| names(line, example.words))
                .count();
            if count > 0 {
                found.push((path.to_owned(), count));
            }
        }
    }
    found
}

/// The files and numbers of a cell of the table: names in backquotes, each with the number after it.
fn listed(cell: &str) -> Vec<(&str, usize)> {
    let parts: Vec<&str> = cell.split('`').collect();
    let pairs = parts.windows(2).skip(1).step_by(2);
    let number = |text: &str| {
        text.split_whitespace()
            .next()?
            .trim_end_matches([',', ';'])
            .parse()
            .ok()
    };
    pairs
        .filter_map(|pair| Some((pair[0], number(pair[1])?)))
        .collect()
}

#[test]
fn recipes_list_the_lines_that_name_something_new() {
    let text = fs::read_to_string(root().join("CONTRIBUTING.md")).unwrap();
    let rows: Vec<Vec<&str>> = text
        .lines()
        .filter(|line| line.starts_with("| a"))
        .map(|line| line.split('|').map(str::trim).collect())
        .collect();
    assert_eq!(rows.len(), EXAMPLES.len(), "each recipe has an example");
    let mut wrong = Vec::new();
    for (row, example) in rows.iter().zip(EXAMPLES) {
        assert_eq!(row[4], format!("`{}`", example.name));
        let (listed, found) = (listed(row[3]), named(example));
        let agrees = |(path, count): &(PathBuf, usize)| {
            let mut lines = listed.iter();
            lines.any(|(name, number)| {
                number == count && path.ends_with(name.trim_start_matches("<family>/"))
            })
        };
        if listed.len() != found.len() || !found.iter().all(agrees) {
            wrong.push(format!(
                "{}: listed are {listed:?}, found {found:?}",
                row[1]
            ));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}
