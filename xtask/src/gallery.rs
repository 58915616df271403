//! The gallery: renders the scenes of `scenes/gallery` and writes the manual's pages about them.
//!
//! A page shows each scene of a folder: its name, its picture, the comment that it begins with, and its text. So the manual
//! cannot say what the program does not do.

use anyhow::{Context, Result, bail};
use std::collections::BTreeSet;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::Command;
use strahl::sdl::{Word, object_words, pattern_words};

const SCENES: &str = "scenes/gallery";
const PAGES: &str = "docs/src/gallery";
const SIZE: &str = "192x144";

/// Most bytes of all pictures: the book stays light.
const MOST_BYTES: u64 = 3 << 20;

/// The pages: folder, title, and what stands above the scenes.
const FAMILIES: [(&str, &str, &str); 8] = [
    (
        "objects",
        "Objects",
        "Shapes, and what is made of them. Most of them are solid, and can be cut and joined.",
    ),
    (
        "patterns",
        "Patterns",
        "A pattern gives a number to every point of space; a map makes colours, textures or normals of it.",
    ),
    (
        "normals",
        "Normals",
        "Patterns that bend the normal: light falls on the surface as if it were uneven.",
    ),
    (
        "finish",
        "Finishes and textures",
        "What a surface does with light, and textures of several parts.",
    ),
    (
        "interior",
        "Glass",
        "What light meets inside of transparent things.",
    ),
    (
        "lights",
        "Lights",
        "The same things, lit in different ways.",
    ),
    (
        "cameras",
        "Cameras",
        "The same things, seen in different ways.",
    ),
    (
        "atmosphere",
        "Sky and fog",
        "What is behind all things, and between them.",
    ),
];

/// One scene with what its page says.
struct Scene {
    file: PathBuf,
    name: String,
    /// The comment that the scene begins with.
    about: String,
    /// The scene behind its line `#include`.
    text: String,
}

/// `cargo xtask gallery`
pub(crate) fn run(args: &[&str]) -> Result<()> {
    let mut check = false;
    let mut only = "";
    let mut rest = args.iter();
    while let Some(arg) = rest.next() {
        match *arg {
            "--check" => check = true,
            "--only" => {
                only = rest
                    .next()
                    .context("--only needs a part of a file's name")?
            }
            other => bail!("unknown argument {other}"),
        }
    }
    if !check {
        crate::bench::build_strahl()?;
    }
    let mut problems = vec![];
    let mut bytes = 0;
    for (folder, title, intro) in FAMILIES {
        let scenes = scenes(folder)?;
        for scene in &scenes {
            let picture = picture(folder, scene);
            if !check && scene.file.to_string_lossy().contains(only) {
                println!("{}", scene.file.display());
                render(&scene.file, &picture)?;
            }
            match std::fs::metadata(&picture) {
                Ok(found) => bytes += found.len(),
                Err(_) => problems.push(format!("{} is missing", picture.display())),
            }
        }
        let page = Path::new(PAGES).join(format!("{folder}.md"));
        let text = page_text(folder, title, intro, &scenes);
        if !check {
            std::fs::write(&page, text)?;
        } else if std::fs::read_to_string(&page).unwrap_or_default() != text {
            problems.push(format!("{} is not what the scenes say", page.display()));
        }
        problems.extend(missing(folder, &scenes));
    }
    if bytes > MOST_BYTES {
        problems.push(format!(
            "the pictures have {bytes} bytes, more than {MOST_BYTES}"
        ));
    }
    if !problems.is_empty() {
        bail!(
            "{}\nwrite the scenes, then run `cargo xtask gallery`",
            problems.join("\n")
        );
    }
    println!("pictures: {} KiB", bytes / 1024);
    Ok(())
}

/// What is supported, but has no scene of its name.
fn missing(folder: &str, scenes: &[Scene]) -> Vec<String> {
    let known: BTreeSet<&str> = scenes.iter().map(|s| s.name.as_str()).collect();
    let words: Vec<Word> = match folder {
        // Lights have a page of their own.
        "objects" => object_words()
            .filter(|word| *word != Word::LightSource)
            .collect(),
        "patterns" => pattern_words().collect(),
        _ => vec![],
    };
    let words = words.iter().map(|word| word.text());
    let lacking = words.filter(|word| !known.contains(word));
    lacking
        .map(|word| format!("`{word}` has no scene {SCENES}/{folder}/{word}.pov"))
        .collect()
}

/// The scenes of a folder by name.
fn scenes(folder: &str) -> Result<Vec<Scene>> {
    let folder = Path::new(SCENES).join(folder);
    let entries =
        std::fs::read_dir(&folder).with_context(|| format!("cannot read {}", folder.display()))?;
    let mut files = entries
        .map(|entry| Ok(entry?.path()))
        .collect::<Result<Vec<_>>>()?;
    files.retain(|file| file.extension().is_some_and(|ending| ending == "pov"));
    files.sort();
    files.into_iter().map(read).collect()
}

fn read(file: PathBuf) -> Result<Scene> {
    let text = std::fs::read_to_string(&file)?;
    let comment = text.lines().map_while(|line| line.strip_prefix("//"));
    let about: Vec<&str> = comment.map(str::trim).collect();
    if about.is_empty() {
        bail!(
            "{} must begin with a comment that says what it shows",
            file.display()
        );
    }
    let (_, shown) = text
        .split_once("#include \"../gallery.inc\"\n")
        .with_context(|| format!("{} does not include ../gallery.inc", file.display()))?;
    let name = file.file_stem().context("a scene has a name")?;
    Ok(Scene {
        name: name.to_string_lossy().into_owned(),
        about: about.join("\n"),
        text: shown.trim().to_owned(),
        file,
    })
}

fn picture(folder: &str, scene: &Scene) -> PathBuf {
    Path::new(PAGES)
        .join(folder)
        .join(format!("{}.png", scene.name))
}

fn render(scene: &Path, picture: &Path) -> Result<()> {
    if let Some(folder) = picture.parent() {
        std::fs::create_dir_all(folder)?;
    }
    let done = Command::new(crate::bench::strahl_binary()?)
        .arg("render")
        .arg(scene)
        .args(["--size", SIZE, "--quiet", "--output"])
        .arg(picture)
        .output()
        .context("cannot run strahl")?;
    let said = String::from_utf8_lossy(&done.stderr);
    if !done.status.success() || said.contains("warning") {
        bail!("{}: {said}", scene.display());
    }
    Ok(())
}

fn page_text(folder: &str, title: &str, intro: &str, scenes: &[Scene]) -> String {
    let mut out = format!(
        "<!-- Written by `cargo xtask gallery` from {SCENES}/{folder}: change the scenes, not this page. -->\n# {title}\n\n{intro}\n"
    );
    for Scene {
        name, about, text, ..
    } in scenes
    {
        // Writing to a string does not fail.
        let _ = write!(
            out,
            "\n## {name}\n\n![{name}]({folder}/{name}.png)\n\n{about}\n\n```pov\n{text}\n```\n"
        );
    }
    out
}
