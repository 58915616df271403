//! Wavefront OBJ with MTL materials.
//!
//! The reader is our own: the `tobj` crate reports neither lines nor columns, and gives up at the first error.
//!
//! Read are `v` (with a weight for rational surfaces; a colour is ignored with a warning), `vt`, `vn`, `f` in all its forms (negative numbers count
//! back from the last vertex; polygons are cut into triangles), `o`, `g`, `s`, `usemtl`, `mtllib`, comments and lines
//! continued by a backslash. Points and lines are ignored with a warning. Free-form surfaces are described in `freeform`.
//!
//! * All faces of one name (object and group) and one material are one mesh, which knows the line of each triangle.
//! * Faces with normals are smooth. Without normals, faces in a smoothing group get the mean of the normals around each
//!   vertex within that group, weighted by angle (G. Thürmer and C. Wüthrich, "Computing Vertex Normals from Polygonal
//!   Facets", 1998); other faces are flat.
//! * OBJ counts `v` of texture coordinates from the bottom, strahl (like glTF) from the top: it is turned here.
//! * A library or a material that is missing is a warning; its faces get the default material.
//!
//! What the statements of MTL become is told in the submodule `mtl`.

mod block;
mod faces;
mod freeform;
mod mtl;
mod vertices;

use crate::input::Input;
use crate::input::ahead::{Ahead, Statements};
use crate::input::bytes::{path_beside, read_beside, unquoted};
use crate::input::report::{Fallible, Report};
use crate::input::text::Text;
use crate::input::textures::TextureFiles;
use crate::mesh::{COLORS_HINT, COLORS_IGNORED};
use block::{Block, Face, Parser, Place, Step, read_ahead};
use faces::{Counts, Faces, PartKey, RawCorner, check_corner};
use freeform::{FreeForm, Outcome, Points};
use rayon::Scope;
use std::collections::{HashMap, HashSet};
use std::sync::Arc;
use strahl_scene::{Diagnostic, Object, Scene, Span};
use strahl_shade::Material;

/// Most material libraries of one file.
const MOST_LIBRARIES: usize = 256;

/// Reads a scene; errors and warnings go to the report.
pub(crate) fn read(input: &Input<'_>, report: &mut Report) -> Scene {
    read_with(input, report, Ahead::default())
}

/// [`read`] with parts of another size, which does not change the result.
fn read_with<'a>(input: &'a Input<'a>, report: &mut Report, ahead: Ahead<'a, Block>) -> Scene {
    let mut scene = Scene::default();
    let text = Text::new(input.bytes, input.name, scene.sources.add(input.name));
    if text.refuse_binary("an OBJ file", report) {
        return scene;
    }
    let mut reader = Reader {
        text,
        report,
        scene,
        libraries: HashSet::new(),
        materials: HashMap::new(),
        textures: TextureFiles::new(input.folder),
        input,
        faces: Faces::default(),
        free_form: FreeForm::default(),
        weights: HashMap::new(),
        color: None,
        left_out: None,
        surfaces: vec![],
        current: PartKey::default(),
        smoothing: 0,
    };
    rayon::in_place_scope(|scope| reader.statements(scope, ahead));
    reader.finish()
}

/// Joins the statements into a scene.
struct Reader<'a, 'r> {
    input: &'a Input<'a>,
    text: Text<'a>,
    report: &'r mut Report,
    scene: Scene,
    /// The libraries read so far, by path.
    libraries: HashSet<String>,
    materials: HashMap<Arc<str>, Arc<Material>>,
    textures: TextureFiles<'a>,
    faces: Faces,
    free_form: FreeForm,
    /// The weights of positions that have one other than 1.
    weights: HashMap<u32, f64>,
    /// The first position that has a colour.
    color: Option<Place>,
    /// The first face or surface that is left out, with the reason.
    left_out: Option<(String, Place)>,
    /// The free-form surfaces, each with the name of its material.
    surfaces: Vec<(Object, Arc<str>)>,
    /// Names and material of the following faces.
    current: PartKey,
    /// The smoothing group, 0 for none.
    smoothing: u32,
}

impl<'a> Reader<'a, '_> {
    fn statements<'s>(&mut self, scope: &Scope<'s>, mut ahead: Ahead<'a, Block>)
    where
        'a: 's,
    {
        let text = self.text;
        let mut parser = Parser {
            text,
            words: text.words(0, 1).with_continuation(),
            block: Block::default(),
        };
        while parser.words.advance() && !self.report.is_hopeless() {
            let read = move |words, end| read_ahead(text, words, end);
            if let Some(piece) = ahead.piece(scope, &parser.words, read) {
                self.add(piece.content);
                parser.words = piece.rest;
                continue;
            }
            parser.block = Block::from(parser.words.position());
            match parser.statement() {
                Ok(()) => self.add(std::mem::take(&mut parser.block)),
                Err(problem) => self.report.error(|| *problem),
            }
        }
    }

    fn add(&mut self, block: Block) {
        let before = self.faces.counts();
        let first = u32::try_from(before.positions).unwrap_or(u32::MAX);
        let weights = block.weights.into_iter();
        self.weights
            .extend(weights.map(|(place, weight)| (first.saturating_add(place), weight)));
        self.faces.positions.extend(block.positions);
        if let Some(place) = block.color {
            self.color.get_or_insert(*place);
        }
        self.faces.uvs.extend(block.uvs);
        self.faces.normals.extend(block.normals);
        let mut corners = block.corners.as_slice();
        let mut counts = before;
        for step in block.steps {
            match step {
                Step::Counts(own) => counts = before + *own,
                Step::Face(face) => {
                    let Some((own, others)) = corners.split_at_checked(face.corners as usize)
                    else {
                        return;
                    };
                    corners = others;
                    if let Err(problem) = self.face(block.start, &face, own, &counts) {
                        self.report.error(|| *problem);
                        if self.report.is_hopeless() {
                            return;
                        }
                    }
                }
                Step::FreeForm(place) => {
                    if let Err(problem) = self.free_form(*place, &counts) {
                        self.report.error(|| *problem);
                    }
                }
                Step::Object(name) => self.current.object = name,
                Step::Group(name) => self.current.group = name,
                Step::Material(name) => self.current.material = name,
                Step::Smoothing(group) => self.smoothing = group,
                Step::Libraries(names, place) => self.library(&names, *place),
                Step::Ignored(what, place) => self.count(what, *place, || what.to_owned()),
            }
        }
    }

    /// A statement about free-form geometry.
    fn free_form(&mut self, place: Place, counts: &Counts) -> Fallible<()> {
        let points = Points {
            positions: &self.faces.positions,
            weights: &self.weights,
            counts: *counts,
        };
        match self.free_form.statement(self.text, place, &points)? {
            Outcome::Nothing => {}
            Outcome::Warning(key, what, place) => self.count(key, place, || what),
            Outcome::LeftOut(key, what, place) => self.leave_out(key, place, || what.clone()),
            Outcome::Surface(nurbs, place) => {
                let object = Object {
                    name: Some(self.current.name(self.text)),
                    span: Span::line(self.text.file, place.line),
                    ..(*nurbs).into()
                };
                let material = Arc::clone(&self.current.material);
                self.surfaces.push((object, material));
            }
        }
        Ok(())
    }

    /// A warning about a face or surface that will be missing.
    fn leave_out(&mut self, key: &'static str, place: Place, what: impl Fn() -> String) {
        if self.left_out.is_none() {
            self.left_out = Some((what(), place));
        }
        self.count(key, place, what);
    }

    fn count(&mut self, key: &'static str, place: Place, what: impl FnOnce() -> String) {
        let text = self.text;
        self.report.count(key, || {
            text.place(
                Diagnostic::warning(what()),
                place.start,
                place.length,
                place.line,
            )
        });
    }

    /// Adds a face of a block that starts at `block`.
    fn face(
        &mut self,
        block: usize,
        face: &Face,
        corners: &[RawCorner],
        counts: &Counts,
    ) -> Fallible<()> {
        let (start, line) = (block + face.start as usize, face.line);
        self.faces.corners.clear();
        for corner in corners {
            match corner.resolve(counts) {
                Some(corner) => self.faces.corners.push(corner),
                None => return Err(self.wrong_corner(start, line, counts)),
            }
        }
        if let Err(why) = self.faces.add(&self.current, self.smoothing, line) {
            if let Some((corner, position)) = self.faces.not_finite() {
                return Err(self.not_finite(start, line, corner, position));
            }
            let place = Place {
                start,
                length: 1,
                line,
            };
            self.leave_out("skipped face", place, || {
                format!("the face is left out: {why}")
            });
        }
        Ok(())
    }

    /// The error of a face whose corners can't be resolved.
    #[cold]
    fn wrong_corner(&self, start: usize, line: u32, counts: &Counts) -> Box<Diagnostic> {
        let mut words = self.text.words(start, line).with_continuation();
        words.next();
        while let Some(word) = words.next_uncommented() {
            if let Err(problem) = check_corner(word.bytes, counts) {
                return Box::new(self.text.at(&word, Diagnostic::error(problem)));
            }
        }
        Box::new(words.expected_in_line("a corner"))
    }

    /// The error of a face one of whose corners has no position.
    #[cold]
    fn not_finite(&self, start: usize, line: u32, corner: usize, position: u32) -> Box<Diagnostic> {
        let mut words = self.text.words(start, line).with_continuation();
        for _ in 0..=corner {
            words.next();
        }
        let number = u64::from(position) + 1;
        let problem = format!("the position of vertex {number} is not a finite number");
        Box::new(match words.next_uncommented() {
            Some(word) => self.text.at(&word, Diagnostic::error(problem)),
            None => Diagnostic::error(problem),
        })
    }

    /// Reads material libraries. A name may have blanks, so the whole line is tried before its words.
    fn library(&mut self, line: &str, place: Place) {
        let read = |name: &str| {
            let path = path_beside(name)?;
            read_beside(self.input.folder, &path).map(|bytes| (path, bytes))
        };
        let name = unquoted(line);
        let whole = read(name);
        let mut found = vec![];
        if whole.is_err() {
            found.extend(names_in(line).into_iter().map(|name| (name, read(name))));
        }
        // Without any of the words the line was probably meant as one name.
        if !found.iter().any(|(_, read)| read.is_ok()) {
            found = vec![(name, whole)];
        }
        for (name, read) in found {
            match read {
                Ok((path, bytes)) => {
                    let is_new = self.libraries.len() < MOST_LIBRARIES
                        && self.libraries.insert(path.clone());
                    if is_new {
                        self.materials_of(&path, &bytes);
                    }
                }
                Err(why) => {
                    let text = self.text;
                    self.report.count("missing library", || {
                        let problem = format!("the material library `{name}` is not read: {why}");
                        text.place(
                            Diagnostic::warning(problem)
                                .hint("faces whose material is missing get the default material"),
                            place.start,
                            place.length,
                            place.line,
                        )
                    });
                }
            }
        }
    }

    fn materials_of(&mut self, path: &str, bytes: &[u8]) {
        let shown = match self.input.folder {
            Some(folder) => folder.shown(path),
            None => path.to_owned(),
        };
        let text = Text::new(bytes, &shown, self.scene.sources.add(&shown));
        for material in mtl::read(text, &mut self.textures, self.report) {
            // The first of several materials with the same name counts, as in other programs.
            self.materials
                .entry(Arc::from(material.name.as_str()))
                .or_insert_with(|| Arc::new(material));
        }
    }

    fn finish(mut self) -> Scene {
        if let Some(place) = self.free_form.unfinished() {
            let what = "the curve or surface is left out: its `end` is missing";
            self.leave_out("end", place, || what.to_owned());
        }
        if let Some(place) = self.color {
            let text = self.text;
            self.report.warning(|| {
                let problem = Diagnostic::warning(COLORS_IGNORED).hint(COLORS_HINT);
                text.place(problem, place.start, place.length, place.line)
            });
        }
        let Self {
            text,
            report,
            mut scene,
            faces,
            materials,
            surfaces,
            left_out,
            ..
        } = self;
        let meshes = faces.finish(text, report);
        for (mut object, material) in meshes.into_iter().chain(surfaces) {
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
            report.error(|| nothing_to_show(text, left_out));
        }
        scene
    }
}

/// The error of a file without faces. Its reason may be a warning, which quiet programs don't show.
fn nothing_to_show(text: Text<'_>, left_out: Option<(String, Place)>) -> Diagnostic {
    let name = text.name;
    match left_out {
        Some((why, place)) => {
            let problem = format!("`{name}` has no faces or surfaces that can be shown: {why}");
            let problem = Diagnostic::error(problem);
            text.place(problem, place.start, place.length, place.line)
        }
        None => Diagnostic::error(format!("`{name}` has no faces")),
    }
}

/// The names in a line: words, or anything in quotation marks.
fn names_in(line: &str) -> Vec<&str> {
    let mut names = vec![];
    let mut rest = line.trim_start();
    while !rest.is_empty() {
        let quoted = rest.strip_prefix('"').and_then(|r| r.split_once('"'));
        let (name, after) = quoted
            .or_else(|| rest.split_once(char::is_whitespace))
            .unwrap_or((rest, ""));
        names.push(name);
        rest = after.trim_start();
    }
    names
}

#[cfg(test)]
mod tests;
