//! glTF 2.0, as `.gltf` with other files beside it or as one `.glb`.
//!
//! | glTF | becomes |
//! |---|---|
//! | nodes | transformations of objects; a mesh that several nodes show is a group with instances |
//! | primitives | a mesh each: triangles, strips and fans with normals and `TEXCOORD_0`; points and lines are ignored |
//! | cameras | the first one of the scene |
//! | `KHR_lights_punctual` | lights; the radiance of a white surface facing the light at distance 1 is intensity/π |
//! | materials | [`Pbr`](strahl_shade::Pbr) with all textures, samplers and `KHR_texture_transform` |
//! | `KHR_materials_transmission`, `_volume`, `_ior`, `_specular`, `_emissive_strength`, `_unlit` | η, f0, absorption, ... |
//! | skins, morph targets, animations | the rest pose, with a warning |
//!
//! Choices: A lamp of intensity I (candela, or lux for parallel light) gets the colour I/π, since strahl's diffuse
//! reflection has no 1/π; watts, lumens and exposure are not guessed at. The light's `range` is ignored. A camera's
//! `aspectRatio` gives way to the picture's. Materials that are not `doubleSided` exist from the front only, except
//! for those with a volume, whose inside must be left again. Transmission without volume is a thin sheet.
//!
//! The `gltf` crate reads the JSON and checks it; its own access to buffers panics on some files, so that is done here.

mod accessor;
mod buffers;
mod materials;
mod meshes;
mod nodes;

use crate::input::text::Text;
use crate::input::{Input, Report};
use buffers::Buffers;
use gltf_json::validation::{Error, Validate};
use gltf_json::{Path as JsonPath, Root};
use strahl_scene::{Diagnostic, Scene};

/// The extensions that are understood, or may be ignored without harm even if they are required: those of other variants
/// of materials, and of notes about the file.
const EXTENSIONS: [&str; 11] = [
    "KHR_lights_punctual",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_variants",
    "KHR_materials_volume",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
    "KHR_xmp_json_ld",
];

/// The extensions that store meshes in a form that is not read.
const OF_MESHES: [&str; 3] = [
    "EXT_meshopt_compression",
    "KHR_draco_mesh_compression",
    "KHR_meshopt_compression",
];

/// The extensions that store pictures in a form that is not read.
const OF_PICTURES: [&str; 4] = [
    "EXT_texture_avif",
    "EXT_texture_webp",
    "KHR_texture_basisu",
    "MSFT_texture_dds",
];

/// Reads a scene; errors and warnings go to the report.
pub(super) fn read(input: &Input<'_>, report: &mut Report) -> Scene {
    let mut scene = Scene::default();
    let file = scene.sources.add(input.name);
    let (json, blob) = match chunks(input.bytes) {
        Ok(chunks) => chunks,
        Err(problem) => {
            report.error(|| Diagnostic::error(format!("`{}`: {problem}", input.name)));
            return scene;
        }
    };
    let text = Text::new(json, input.name, file);
    let Some(root) = root(text, report) else {
        return scene;
    };
    if let Err(problem) = fill(&root, blob, input, &mut scene, report) {
        report.error(|| Diagnostic::error(format!("`{}`: {problem}", input.name)));
    }
    scene
}

fn fill(
    root: &Root,
    blob: Option<&[u8]>,
    input: &Input<'_>,
    scene: &mut Scene,
    report: &mut Report,
) -> Result<(), String> {
    let buffers = Buffers::read(root, blob, input.folder)?;
    let mut materials = materials::Materials::new(root, &buffers, input);
    let mut meshes = meshes::Meshes::new(root, &buffers, input);
    if !root.animations.is_empty() {
        report.warning(|| Diagnostic::warning(format!("`{}`: animations are ignored", input.name)));
    }
    nodes::Nodes {
        root,
        name: input.name,
        scene,
        report,
    }
    .place(&mut meshes, &mut materials)
}

/// The JSON and the binary chunk.
fn chunks(bytes: &[u8]) -> Result<(&[u8], Option<&[u8]>), String> {
    let Some(rest) = bytes.strip_prefix(b"glTF") else {
        return Ok((bytes, None));
    };
    let Some((header, mut rest)) = rest.split_first_chunk::<8>() else {
        return Err("the binary glTF file ends within its header".into());
    };
    let version = number(header, 0);
    if version != 2 {
        return Err(format!(
            "version {version} of binary glTF is not supported, only 2"
        ));
    }
    let (mut json, mut binary) = (None, None);
    while let Some((header, body)) = rest.split_first_chunk::<8>() {
        let Some((chunk, after)) = body.split_at_checked(number(header, 0) as usize) else {
            return Err(format!(
                "a chunk should have {} bytes, but only {} are left",
                number(header, 0),
                body.len()
            ));
        };
        match &header[4..] {
            b"JSON" => json = json.or(Some(chunk)),
            b"BIN\0" => binary = binary.or(Some(chunk)),
            // Other chunks must be ignored.
            _ => {}
        }
        rest = after;
    }
    Ok((
        json.ok_or("the binary glTF file has no JSON chunk")?,
        binary,
    ))
}

/// The little-endian number at an offset in a header.
fn number(header: &[u8; 8], at: usize) -> u32 {
    header[at..]
        .first_chunk()
        .map_or(0, |b| u32::from_le_bytes(*b))
}

/// Reads and checks the JSON.
fn root(text: Text<'_>, report: &mut Report) -> Option<Root> {
    let mut root = match Root::from_slice(text.bytes) {
        Ok(root) => root,
        Err(error) => {
            report.error(|| syntax_error(text, &error));
            return None;
        }
    };
    let needed = not_understood(&root.extensions_required);
    if !needed.is_empty() {
        report.error(|| {
            Diagnostic::error(format!(
                "`{}` needs extensions that are not supported: {}",
                text.name,
                listed(&needed)
            ))
            .hint(what_to_do_without(&needed))
        });
        return None;
    }
    let ignored = not_understood(&root.extensions_used);
    if !ignored.is_empty() {
        report.warning(|| {
            Diagnostic::warning(format!(
                "`{}`: extensions that are not supported are ignored: {}",
                text.name,
                listed(&ignored)
            ))
        });
    }
    // The crate's own list of supported extensions is shorter than ours.
    root.extensions_required.clear();
    if !root.asset.version.starts_with("2.") {
        let version: String = root.asset.version.chars().take(20).collect();
        report.error(|| {
            Diagnostic::error(format!(
                "`{}`: version `{version}` of glTF is not supported, only 2",
                text.name
            ))
        });
        return None;
    }
    // The crate's validation reads the accessor of the positions before it checks the index.
    let accessors = root.accessors.len();
    let mut attributes = root
        .meshes
        .iter()
        .flat_map(|m| &m.primitives)
        .flat_map(|p| p.attributes.values());
    if attributes.any(|index| index.value() >= accessors) {
        report.error(|| {
            Diagnostic::error(format!(
                "`{}`: an attribute of a mesh refers to an accessor that does not exist",
                text.name
            ))
        });
        return None;
    }
    root.validate(
        &root,
        JsonPath::new,
        &mut |path: &dyn Fn() -> JsonPath, error: Error| {
            let path = path();
            // Bounds are not needed, and a texture without a picture is left out where it is used.
            let field = path.as_str();
            let harmless = error == Error::Missing
                && (field.ends_with(".min")
                    || field.ends_with(".max")
                    || (field.starts_with("textures[") && field.ends_with(".source")));
            if !harmless {
                report.error(|| {
                    Diagnostic::error(format!("`{}`: {path}: {}", text.name, in_words(error)))
                });
            }
        },
    );
    (!report.has_errors()).then_some(root)
}

/// The extensions that are not understood, each once.
fn not_understood(names: &[String]) -> Vec<&str> {
    let mut unknown: Vec<&str> = names.iter().map(String::as_str).collect();
    unknown.retain(|name| !EXTENSIONS.contains(name));
    unknown.sort_unstable();
    unknown.dedup();
    unknown
}

/// The first ten names for a message.
fn listed(names: &[&str]) -> String {
    const MOST: usize = 10;
    let shown: Vec<_> = names
        .iter()
        .take(MOST)
        .map(|name| format!("`{}`", buffers::shown(name)))
        .collect();
    let more = if names.len() > MOST { ", ..." } else { "" };
    format!("{}{more}", shown.join(", "))
}

/// What to do if these extensions are needed.
fn what_to_do_without(names: &[&str]) -> &'static str {
    let has = |known: &[&str]| names.iter().any(|name| known.contains(name));
    match (has(&OF_MESHES), has(&OF_PICTURES)) {
        (true, true) => {
            "export it without them, with meshes that are not compressed and pictures as PNG or JPEG"
        }
        (true, false) => "export it without compression of meshes",
        (false, true) => "export it with pictures as PNG or JPEG",
        (false, false) => {
            "export it without them, or take their names out of `extensionsRequired`: what they describe is ignored then"
        }
    }
}

fn in_words(error: Error) -> &'static str {
    match error {
        Error::IndexOutOfBounds => "the index is out of range",
        Error::Invalid => "the value is not allowed",
        Error::Missing => "the value is missing",
        Error::Oversize => "the value is too large",
        Error::Unsupported => "this is not supported",
    }
}

fn syntax_error(text: Text<'_>, error: &gltf_json::Error) -> Diagnostic {
    let message = error.to_string();
    let place = format!(" at line {} column {}", error.line(), error.column());
    let what = message.strip_suffix(&place).unwrap_or(&message);
    let problem = Diagnostic::error(format!("the JSON of the glTF file is wrong: {what}"));
    if error.line() == 0 {
        return problem;
    }
    let mut lines = text.bytes.split_inclusive(|b| *b == b'\n');
    let before: usize = lines.by_ref().take(error.line() - 1).map(<[u8]>::len).sum();
    let start = before + error.column().saturating_sub(1);
    text.place(
        problem,
        start,
        1,
        u32::try_from(error.line()).unwrap_or(u32::MAX),
    )
}

#[cfg(test)]
mod tests;
