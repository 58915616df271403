//! Renders the scenes of `scenes/` and writes the gallery pages of the manual.
//!
//! A page shows each scene of a folder: its name, its picture, the comment at its beginning, and its text. So the manual shows
//! only features that exist.

use crate::arguments::Arguments;
use anyhow::{Context, Result, bail};
use std::collections::BTreeSet;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::Command;
use strahl::sdl::{Word, object_words, pattern_words};

/// The largest size of all pictures together, in bytes.
const MOST_BYTES: u64 = 4 << 20;

/// A page of the manual about the scenes of a folder.
struct Page {
    /// The folder below `scenes/`; the page and its pictures lie at the same place below `docs/src/`.
    folder: &'static str,
    title: &'static str,
    /// The text above the scenes.
    intro: &'static str,
    size: &'static str,
    /// If the page lists the text of the scenes: the line after which the listing begins.
    listing: Option<&'static str>,
}

const fn gallery(folder: &'static str, title: &'static str, intro: &'static str) -> Page {
    Page {
        folder,
        title,
        intro,
        size: "168x126",
        listing: Some("#include \"../gallery.inc\"\n"),
    }
}

const PAGES: [Page; 10] = [
    gallery(
        "gallery/objects",
        "Objects",
        "Shapes and combinations of shapes. Most of them are solids, which CSG can combine.",
    ),
    gallery(
        "gallery/patterns",
        "Patterns",
        "A pattern assigns a number to every point of space; a map turns this number into a colour, a texture or a normal.",
    ),
    gallery(
        "gallery/normals",
        "Normals",
        "Patterns that perturb the normal: the surface is shaded as if it were uneven.",
    ),
    gallery(
        "gallery/finish",
        "Finishes and textures",
        "How a surface reflects light, and textures composed of others.",
    ),
    gallery(
        "gallery/interior",
        "Glass",
        "The inside of transparent objects: refraction, absorption, dispersion.",
    ),
    gallery(
        "gallery/lights",
        "Lights",
        "The same objects under different lights.",
    ),
    gallery(
        "gallery/cameras",
        "Cameras",
        "The same objects through different cameras.",
    ),
    gallery(
        "gallery/atmosphere",
        "Sky and fog",
        "The background, and the air between the objects.",
    ),
    Page {
        folder: "lecture",
        title: "Ray tracing in fourteen pictures",
        intro: "The method of ray tracing, with a scene for each of its ideas. Run the commands in the folder of the repository.",
        size: "288x162",
        listing: None,
    },
    Page {
        folder: "showcase",
        title: "Showcase",
        intro: "Scenes of our own that take a minute or less. The pictures here are small; the scenes can be rendered at any size.",
        size: "400x225",
        listing: None,
    },
];

/// One scene and its description.
struct Scene {
    file: PathBuf,
    name: String,
    /// The comment at the beginning of the scene.
    about: String,
    /// The text of the scene after its `#include` line.
    text: String,
}

/// `cargo xtask gallery`
pub(crate) fn run(args: &[&str]) -> Result<()> {
    let mut check = false;
    let mut only = "";
    let mut args = Arguments::new(args);
    while let Some(option) = args.option() {
        match option {
            "--check" => check = true,
            "--only" => only = args.value()?,
            other => bail!("unknown argument {other}"),
        }
    }
    if !check {
        crate::bench::build_strahl()?;
    }
    let mut problems = vec![];
    let mut bytes = 0;
    for page in &PAGES {
        let scenes = page.scenes()?;
        for scene in &scenes {
            let picture = page.picture(scene);
            if !check && scene.file.to_string_lossy().contains(only) {
                println!("{}", scene.file.display());
                render(&scene.file, page.size, &picture)?;
            }
            match std::fs::metadata(&picture) {
                Ok(found) => bytes += found.len(),
                Err(_) => problems.push(format!("{} is missing", picture.display())),
            }
        }
        let file = format!("docs/src/{}.md", page.folder);
        let text = page.text(&scenes);
        if !check {
            std::fs::write(&file, text)?;
        } else if std::fs::read_to_string(&file).unwrap_or_default() != text {
            problems.push(format!("{file} is not up to date"));
        }
        problems.extend(page.missing(&scenes));
    }
    if bytes > MOST_BYTES {
        problems.push(format!(
            "the pictures take {bytes} bytes, more than {MOST_BYTES}"
        ));
    }
    if !problems.is_empty() {
        bail!(
            "{}\nwrite the missing scenes, then run `cargo xtask gallery`",
            problems.join("\n")
        );
    }
    println!("pictures: {} KiB", bytes / 1024);
    Ok(())
}

impl Page {
    /// The scenes of the folder by name.
    fn scenes(&self) -> Result<Vec<Scene>> {
        let folder = Path::new("scenes").join(self.folder);
        let entries = std::fs::read_dir(&folder)
            .with_context(|| format!("cannot read {}", folder.display()))?;
        let mut files = entries
            .map(|entry| Ok(entry?.path()))
            .collect::<Result<Vec<_>>>()?;
        files.retain(|file| file.extension().is_some_and(|ending| ending == "pov"));
        files.sort();
        files
            .into_iter()
            .map(|file| read(file, self.listing))
            .collect()
    }

    fn picture(&self, scene: &Scene) -> PathBuf {
        let folder = Path::new("docs/src").join(self.folder);
        folder.join(format!("{}.png", scene.name))
    }

    /// Supported features without a scene of their name.
    fn missing(&self, scenes: &[Scene]) -> Vec<String> {
        let known: BTreeSet<&str> = scenes.iter().map(|s| s.name.as_str()).collect();
        let words: Vec<Word> = match self.folder {
            // Lights have a page of their own.
            "gallery/objects" => object_words()
                .filter(|word| !matches!(word, Word::LightSource | Word::LightGroup))
                .collect(),
            "gallery/patterns" => pattern_words().collect(),
            _ => vec![],
        };
        let words = words.iter().map(|word| word.text());
        let lacking = words.filter(|word| !known.contains(word));
        lacking
            .map(|word| format!("`{word}` has no scene scenes/{}/{word}.pov", self.folder))
            .collect()
    }

    fn text(&self, scenes: &[Scene]) -> String {
        let Self {
            folder,
            title,
            intro,
            ..
        } = self;
        let pictures = Path::new(folder).file_name().unwrap_or_default();
        let pictures = pictures.to_string_lossy();
        let mut out = format!(
            "<!-- Written by `cargo xtask gallery` from scenes/{folder}: change the scenes, not this page. -->\n# {title}\n\n{intro}\n"
        );
        for scene in scenes {
            let Scene {
                name, about, text, ..
            } = scene;
            let heading = name.replace('_', " ");
            // Writing to a string never fails.
            let _ = write!(
                out,
                "\n## {heading}\n\n![{heading}]({pictures}/{name}.png)\n\n{about}\n"
            );
            let _ = match self.listing {
                Some(_) => write!(out, "\n```pov\n{text}\n```\n"),
                None => write!(out, "\nThe scene: `{}`\n", scene.file.display()),
            };
        }
        out
    }
}

fn read(file: PathBuf, listing: Option<&str>) -> Result<Scene> {
    let text = std::fs::read_to_string(&file)?;
    let comment = text.lines().map_while(|line| line.strip_prefix("//"));
    let about: Vec<&str> = comment
        .map(|line| line.strip_prefix(' ').unwrap_or(line))
        .collect();
    if about.is_empty() {
        bail!(
            "{} must begin with a comment that says what it shows",
            file.display()
        );
    }
    let shown = match listing {
        None => "",
        Some(behind) => {
            let split = text.split_once(behind);
            let (_, shown) = split
                .with_context(|| format!("{} has no line {}", file.display(), behind.trim()))?;
            shown
        }
    };
    let name = file.file_stem().context("a scene has a name")?;
    Ok(Scene {
        name: name.to_string_lossy().into_owned(),
        about: about.join("\n"),
        text: shown.trim().to_owned(),
        file,
    })
}

fn render(scene: &Path, size: &str, picture: &Path) -> Result<()> {
    if let Some(folder) = picture.parent() {
        std::fs::create_dir_all(folder)?;
    }
    let done = Command::new(crate::bench::strahl_binary()?)
        .arg("render")
        .arg(scene)
        .args(["--size", size, "--quiet", "--output"])
        .arg(picture)
        .output()
        .context("cannot run strahl")?;
    let said = String::from_utf8_lossy(&done.stderr);
    if !done.status.success() || said.contains("left out") {
        bail!("{}: {said}", scene.display());
    }
    pack(picture).with_context(|| format!("cannot pack {}", picture.display()))
}

/// Packs an 8-bit PNG as tightly as deflate can. What strahl writes is packed for speed.
fn pack(picture: &Path) -> Result<()> {
    let file = std::io::BufReader::new(std::fs::File::open(picture)?);
    let mut reader = png::Decoder::new(file).read_info()?;
    let size = reader.output_buffer_size();
    let mut codes = vec![0; size.context("the picture is too large")?];
    let frame = reader.next_frame(&mut codes)?;
    let mut packed = vec![];
    let mut encoder = png::Encoder::new(&mut packed, frame.width, frame.height);
    encoder.set_color(frame.color_type);
    encoder.set_depth(frame.bit_depth);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    encoder.set_deflate_compression(png::DeflateCompression::Level(9));
    encoder.set_filter(png::Filter::Adaptive);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&codes[..frame.buffer_size()])?;
    writer.finish()?;
    std::fs::write(picture, packed)?;
    Ok(())
}
