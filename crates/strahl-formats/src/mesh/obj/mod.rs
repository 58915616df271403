//! Wavefront OBJ with MTL materials.
//!
//! The reader is our own: the `tobj` crate reports neither lines nor columns, and gives up at the first error.
//!
//! Read are `v` (a weight or colour behind it is ignored), `vt`, `vn`, `f` in all its forms (negative numbers count
//! back from the last vertex; polygons are cut into triangles), `o`, `g`, `s`, `usemtl`, `mtllib`, comments and lines
//! continued by a backslash. Points, lines and free-form surfaces are ignored with a warning.
//!
//! * All faces of one name (object and group) and one material are one mesh, which knows the line of each triangle.
//! * Faces with normals are smooth. Without normals, faces in a smoothing group get the mean of the normals around each
//!   vertex within that group, weighted by angle (G. Thürmer and C. Wüthrich, "Computing Vertex Normals from Polygonal
//!   Facets", 1998); other faces are flat.
//! * OBJ counts `v` of texture coordinates from the bottom, strahl (like glTF) from the top: it is turned here.
//! * A library or a material that is missing is a warning; its faces get the default material.
//!
//! What the statements of MTL become is told in the submodule `mtl`.

mod faces;
mod mtl;
mod vertices;

use crate::scene::Input;
use crate::scene::bytes::{path_beside, read_beside};
use crate::scene::report::{Fallible, Report};
use crate::scene::text::{Text, Word, Words, parse_f64};
use crate::scene::textures::TextureFiles;
use faces::{Counts, Faces, PartKey, corner};
use std::collections::{HashMap, HashSet};
use std::sync::Arc;
use strahl_math::{DVec2, DVec3};
use strahl_scene::{Diagnostic, Scene};
use strahl_shade::Material;

/// Most material libraries of one file.
const MOST_LIBRARIES: usize = 256;

/// Reads a scene; what is wrong goes to the report.
pub(crate) fn read(input: &Input<'_>, report: &mut Report) -> Scene {
    let mut scene = Scene::default();
    let text = Text {
        bytes: input.bytes,
        name: input.name,
        file: scene.sources.add(input.name),
    };
    if text.refuse_binary("an OBJ file", report) {
        return scene;
    }
    let mut reader = Reader {
        text,
        words: text.words(0, 1).with_continuation(),
        report,
        scene,
        libraries: HashSet::new(),
        materials: HashMap::new(),
        textures: TextureFiles::new(input.folder),
        input,
        faces: Faces::default(),
        current: PartKey::default(),
        smoothing: 0,
    };
    reader.statements();
    reader.finish()
}

struct Reader<'a, 'r> {
    input: &'a Input<'a>,
    text: Text<'a>,
    words: Words<'a>,
    report: &'r mut Report,
    scene: Scene,
    /// The libraries read so far, by path.
    libraries: HashSet<String>,
    materials: HashMap<Arc<str>, Arc<Material>>,
    textures: TextureFiles<'a>,
    faces: Faces,
    /// Names and material of the faces to come.
    current: PartKey,
    /// The smoothing group, 0 for none.
    smoothing: u32,
}

impl Reader<'_, '_> {
    fn statements(&mut self) {
        while let Some(word) = self.words.next() {
            if let Err(problem) = self.statement(&word) {
                self.report.error(|| *problem);
                if self.report.is_hopeless() {
                    return;
                }
            }
            self.words.skip_line();
        }
    }

    fn statement(&mut self, word: &Word<'_>) -> Fallible<()> {
        match word.bytes {
            b"v" => {
                let position = DVec3::new(self.number("x")?, self.number("y")?, self.number("z")?);
                self.faces.positions.push(position);
            }
            b"vn" => {
                let normal = DVec3::new(self.number("x")?, self.number("y")?, self.number("z")?);
                self.faces.normals.push(normal);
            }
            b"vt" => {
                let u = self.number("u")?;
                let v = if self.words.peek_in_line().is_some() {
                    self.number("v")?
                } else {
                    0.0
                };
                self.faces.uvs.push(DVec2::new(u, 1.0 - v));
            }
            b"f" => return self.face(word),
            b"o" => self.current.object = self.rest(),
            b"g" => self.current.group = self.rest(),
            b"usemtl" => self.current.material = self.rest(),
            b"s" => return self.smoothing_group(),
            b"mtllib" => self.library(word),
            b"l" => self.ignored(word, "lines (`l`) are ignored: they have no surface"),
            b"p" => self.ignored(word, "points (`p`) are ignored: they have no surface"),
            b"curv" | b"curv2" | b"surf" => {
                self.ignored(word, "free-form curves and surfaces are ignored")
            }
            // What belongs to free-form geometry, and hints for displays.
            b"vp" | b"cstype" | b"deg" | b"bmat" | b"step" | b"parm" | b"trim" | b"hole"
            | b"scrv" | b"sp" | b"end" | b"con" | b"mg" | b"bevel" | b"c_interp" | b"d_interp"
            | b"lod" | b"ctech" | b"stech" | b"shadow_obj" | b"trace_obj" | b"maplib"
            | b"usemap" => {}
            _ => self.ignored(word, "an unknown statement is ignored"),
        }
        Ok(())
    }

    fn ignored(&mut self, word: &Word<'_>, what: &'static str) {
        let text = self.text;
        self.report
            .count(what, || text.at(word, Diagnostic::warning(what)));
    }

    fn face(&mut self, start: &Word<'_>) -> Fallible<()> {
        let counts = self.faces.counts();
        let mut corners = std::mem::take(&mut self.faces.corners);
        corners.clear();
        let read = self.corners(&counts, &mut corners);
        let count = corners.len();
        self.faces.corners = corners;
        read?;
        if count < 3 {
            let word = self
                .words
                .expected_in_line("another corner (a face has at least three)");
            return Err(Box::new(word));
        }
        if let Err(why) = self.faces.add(&self.current, self.smoothing, start.line) {
            let text = self.text;
            self.report.count("skipped face", || {
                text.at(
                    start,
                    Diagnostic::warning(format!("the face is left out: {why}")),
                )
            });
        }
        Ok(())
    }

    fn corners(&mut self, counts: &Counts, out: &mut Vec<faces::Corner>) -> Fallible<()> {
        while let Some(word) = self.words.next_in_line() {
            match corner(word.bytes, counts) {
                Ok(corner) => out.push(corner),
                Err(problem) => {
                    return Err(Box::new(self.text.at(&word, Diagnostic::error(problem))));
                }
            }
        }
        Ok(())
    }

    fn smoothing_group(&mut self) -> Fallible<()> {
        let Some(word) = self.words.next_in_line() else {
            return Err(Box::new(
                self.words.expected_in_line("a smoothing group, or `off`"),
            ));
        };
        self.smoothing = match word.bytes {
            b"off" => 0,
            b"on" => 1,
            number => match std::str::from_utf8(number)
                .ok()
                .and_then(|n| n.parse().ok())
            {
                Some(group) => group,
                None => {
                    let problem = format!(
                        "expected the number of a smoothing group, or `off`, found `{}`",
                        word.shown()
                    );
                    return Err(Box::new(self.text.at(&word, Diagnostic::error(problem))));
                }
            },
        };
        Ok(())
    }

    /// Reads material libraries. A name may have blanks, so the whole line is tried before its words.
    fn library(&mut self, start: &Word<'_>) {
        let line = self.rest();
        let whole = path_beside(&line)
            .and_then(|path| read_beside(self.input.folder, &path).map(|bytes| (path, bytes)));
        let found: Vec<_> = match whole {
            Ok(found) => vec![(line.to_string(), Ok(found))],
            Err(_) => line
                .split_whitespace()
                .map(|name| {
                    let read = |path: String| {
                        read_beside(self.input.folder, &path).map(|bytes| (path, bytes))
                    };
                    (name.to_owned(), path_beside(name).and_then(read))
                })
                .collect(),
        };
        for (name, read) in found {
            let text = self.text;
            match read {
                Ok((path, bytes)) => {
                    let is_new = self.libraries.len() < MOST_LIBRARIES
                        && self.libraries.insert(path.clone());
                    if is_new {
                        self.materials_of(&path, &bytes);
                    }
                }
                Err(why) => self.report.count("missing library", || {
                    text.at(
                        start,
                        Diagnostic::warning(format!(
                            "the material library `{name}` is not read: {why}"
                        )),
                    )
                    .hint("faces whose material is missing get the default material")
                }),
            }
        }
    }

    fn materials_of(&mut self, path: &str, bytes: &[u8]) {
        let shown = match self.input.folder {
            Some(folder) => folder.join(path).display().to_string(),
            None => path.to_owned(),
        };
        let text = Text {
            bytes,
            name: &shown,
            file: self.scene.sources.add(&shown),
        };
        for material in mtl::read(text, &mut self.textures, self.report) {
            // The first of a name counts, as in other programs.
            self.materials
                .entry(Arc::from(material.name.as_str()))
                .or_insert_with(|| Arc::new(material));
        }
    }

    fn finish(self) -> Scene {
        let Self {
            text,
            report,
            mut scene,
            faces,
            materials,
            ..
        } = self;
        for (mut object, material) in faces.finish(text, report) {
            if !material.is_empty() {
                object.material = materials.get(&material).cloned();
            }
            if object.material.is_none() && !material.is_empty() {
                report.warning(|| {
                    let name = object.name.as_deref().unwrap_or_default();
                    Diagnostic::warning(format!(
                        "`{name}` gets the default material: there is no material `{material}`"
                    ))
                    .at(object.span)
                });
            }
            scene.objects.0.push(object);
        }
        if scene.objects.0.is_empty() && !report.has_errors() {
            report.error(|| Diagnostic::error(format!("`{}` has no faces", text.name)));
        }
        scene
    }

    /// The rest of the line as a name.
    fn rest(&mut self) -> Arc<str> {
        let rest = self.words.skip_line();
        Arc::from(String::from_utf8_lossy(rest.trim_ascii()))
    }

    fn number(&mut self, what: &str) -> Fallible<f64> {
        let Some(word) = self.words.next_in_line() else {
            return Err(Box::new(
                self.words.expected_in_line(&format!("a number ({what})")),
            ));
        };
        parse_f64(word.bytes).map_err(|e| {
            Box::new(
                self.text
                    .at(&word, e.describe(&word, &format!("a number ({what})"))),
            )
        })
    }
}

#[cfg(test)]
mod tests;
