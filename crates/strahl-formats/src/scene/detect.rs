use crate::input::kind::{Advice, Kind, kind};
use crate::input::text::without_mark;
use crate::input::{Fallible, Input, Report};
use std::path::Path;
use std::{fmt, str::FromStr};
use strahl_scene::{Diagnostic, Scene};

/// A format scenes can be read from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum SceneFormat {
    /// Eric Haines' Neutral File Format, the format of the Standard Procedural Databases.
    Nff,
    /// Wavefront OBJ with MTL materials.
    Obj,
    /// Stanford PLY, ASCII or binary.
    Ply,
    /// Stereolithography triangles, ASCII or binary.
    Stl,
    /// glTF 2.0, `.gltf` or `.glb`.
    Gltf,
}

/// One line of the table of scene formats.
#[derive(Clone, Copy, Debug)]
pub struct FormatInfo {
    /// The format.
    pub format: SceneFormat,
    /// Its name on the command line.
    pub name: &'static str,
    /// The endings of its files, without the dot, lower case.
    pub extensions: &'static [&'static str],
    /// Its description.
    pub description: &'static str,
    /// Whether a file that begins like this certainly has this format.
    looks_like: fn(&[u8]) -> bool,
    /// Reads a file.
    pub(super) read: fn(&Input<'_>, &mut Report) -> Scene,
}

// The table of scene formats: a new one is an entry here and a line in the enum.
const FORMATS: &[FormatInfo] = &[
    FormatInfo {
        format: SceneFormat::Nff,
        name: "nff",
        extensions: &["nff"],
        description: "Neutral File Format of the Standard Procedural Databases",
        looks_like: looks_like_nff,
        read: super::nff::read,
    },
    FormatInfo {
        format: SceneFormat::Obj,
        name: "obj",
        extensions: &["obj"],
        description: "Wavefront OBJ with MTL materials",
        looks_like: looks_like_obj,
        read: crate::mesh::obj::read,
    },
    FormatInfo {
        format: SceneFormat::Ply,
        name: "ply",
        extensions: &["ply"],
        description: "Stanford PLY meshes, ASCII and binary",
        looks_like: |start| start.starts_with(b"ply\n") || start.starts_with(b"ply\r"),
        read: crate::mesh::ply::read,
    },
    FormatInfo {
        format: SceneFormat::Stl,
        name: "stl",
        extensions: &["stl"],
        description: "STL triangles, ASCII and binary",
        looks_like: |start| start.starts_with(b"solid ") || start.starts_with(b"solid\n"),
        read: crate::mesh::stl::read,
    },
    FormatInfo {
        format: SceneFormat::Gltf,
        name: "gltf",
        extensions: &["gltf", "glb"],
        description: "glTF 2.0 with its materials, cameras and lights",
        looks_like: |start| {
            start.starts_with(b"glTF") || start.trim_ascii_start().starts_with(b"{")
        },
        read: super::gltf::read,
    },
];

/// The table of scene formats.
pub fn formats() -> &'static [FormatInfo] {
    FORMATS
}

impl SceneFormat {
    /// The format's line in the table.
    pub(super) fn info(self) -> Option<&'static FormatInfo> {
        FORMATS.iter().find(|info| info.format == self)
    }

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        self.info().map_or("?", |info| info.name)
    }

    /// The format that files with this ending have; the case of letters does not matter.
    pub fn of_extension(extension: &str) -> Option<Self> {
        let known = |info: &&FormatInfo| {
            info.extensions
                .iter()
                .any(|e| e.eq_ignore_ascii_case(extension))
        };
        FORMATS.iter().find(known).map(|info| info.format)
    }

    /// The format detected from the (uncompressed) bytes, if possible. Binary STL has no mark of its own and is not recognised.
    pub fn sniff(bytes: &[u8]) -> Option<Self> {
        let bytes = without_mark(bytes);
        FORMATS
            .iter()
            .find(|info| (info.looks_like)(bytes))
            .map(|info| info.format)
    }
}

impl fmt::Display for SceneFormat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// There is no scene format of that name.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("unknown scene format `{found}`; the formats are {}", names())]
pub struct UnknownSceneFormat {
    /// The name that was given.
    found: String,
}

fn names() -> String {
    FORMATS
        .iter()
        .map(|info| info.name)
        .collect::<Vec<_>>()
        .join(", ")
}

impl FromStr for SceneFormat {
    type Err = UnknownSceneFormat;

    fn from_str(s: &str) -> Result<Self, Self::Err> {
        let named = FORMATS
            .iter()
            .find(|info| info.name.eq_ignore_ascii_case(s));
        named
            .map(|info| info.format)
            .or_else(|| Self::of_extension(s))
            .ok_or_else(|| UnknownSceneFormat { found: s.into() })
    }
}

/// The format of a file from its name, or else from its first bytes.
pub(super) fn of_file(path: &Path, bytes: &[u8]) -> Fallible<SceneFormat> {
    let extension = |p: &Path| p.extension().map(|e| e.to_string_lossy().into_owned());
    let mut ending = extension(path);
    if ending
        .as_deref()
        .is_some_and(|e| e.eq_ignore_ascii_case("gz"))
    {
        ending = path.file_stem().and_then(|stem| extension(Path::new(stem)));
    }
    let by_name = ending.as_deref().and_then(SceneFormat::of_extension);
    by_name.or_else(|| SceneFormat::sniff(bytes)).ok_or_else(|| {
        let shown = path.display();
        if let Some(Kind { what, advice }) = kind(bytes) {
            let problem = Diagnostic::error(format!("`{shown}` is {what}, not a scene"));
            return Box::new(hinted(problem, advice));
        }
        let message = match ending {
            Some(ending) => format!("`{shown}`: unknown ending `.{ending}`, and the content does not show its format"),
            None => format!("`{shown}`: the name has no ending, and the content does not show its format"),
        };
        let hint = format!("name the format with `--scene-format`; the formats are {}", names());
        Box::new(Diagnostic::error(message).hint(hint))
    })
}

/// The error of a file that is not of this format at all, but of another kind that its first bytes show.
pub(super) fn mistaken(bytes: &[u8], name: &str, format: SceneFormat) -> Option<Diagnostic> {
    let Kind { what, advice } = kind(bytes)?;
    if matches!(advice, Advice::Scene(own) if own == format.name()) {
        return None;
    }
    let expected = match format {
        SceneFormat::Gltf => "glTF".into(),
        other => other.name().to_ascii_uppercase(),
    };
    let problem = Diagnostic::error(format!("`{name}` is {what}, and was read as {expected}"));
    Some(hinted(problem, advice))
}

fn hinted(problem: Diagnostic, advice: Advice) -> Diagnostic {
    match advice.hint() {
        Some(hint) => problem.hint(hint),
        None => problem,
    }
}

/// The first word of the first line that is neither empty nor a comment, and how many words the line has.
fn first_statement(bytes: &[u8]) -> Option<(&[u8], usize)> {
    let start = &bytes[..bytes.len().min(4096)];
    let mut lines = start
        .split(|b| matches!(b, b'\n' | b'\r'))
        .map(<[u8]>::trim_ascii);
    let line = lines.find(|line| !line.is_empty() && !line.starts_with(b"#"))?;
    let mut words = line
        .split(u8::is_ascii_whitespace)
        .filter(|word| !word.is_empty());
    let first = words.next()?;
    Some((first, 1 + words.count()))
}

fn looks_like_nff(bytes: &[u8]) -> bool {
    // `v` alone begins a view of NFF, `v x y z` a vertex of OBJ.
    first_statement(bytes).is_some_and(|(word, words)| match word {
        b"v" => words == 1,
        b"b" => words == 4,
        _ => false,
    })
}

fn looks_like_obj(bytes: &[u8]) -> bool {
    first_statement(bytes).is_some_and(|(word, words)| match word {
        b"v" => words >= 4,
        b"mtllib" | b"o" | b"g" | b"usemtl" => words >= 2,
        _ => false,
    })
}
