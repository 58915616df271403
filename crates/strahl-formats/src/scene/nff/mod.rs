//! The Neutral File Format of Eric Haines' Standard Procedural Databases, version 3.1.
//!
//! | statement | becomes |
//! |---|---|
//! | `v` `from` `at` `up` `angle` `hither` `resolution` | the camera (`angle` is the full vertical angle), [`Settings::size`](strahl_scene::Settings::size) |
//! | `b r g b` | the background |
//! | `l x y z [r g b]` | a point light |
//! | `f r g b Kd Ks Shine T ior` | the material of what follows |
//! | `s x y z r` | a sphere |
//! | `c` base, radius, apex, radius | a cone or cylinder without caps |
//! | `p n` n corners | a flat polygon |
//! | `pp n` n corners with normals | a smooth polygon |
//!
//! The format leaves shading open; the choices here:
//! * Every light has the strength √n/(2n), n the number of lights, times its colour if it has one. So has the ambient light.
//! * `f`: kd = ka = Kd·rgb; highlight and reflection are white, ks = kr = Ks, the highlight's exponent is Shine; kt = T,
//!   η = ior (1 if it is 0, or missing). The highlight is Phong's.
//! * Opaque polygons exist from the front only (corners counter-clockwise), transmitting ones (T > 0) from both sides;
//!   spheres and cones from both sides, and from the inside only if their radius is negative.
//! * `hither` is checked and ignored: a ray starts at the eye.
//! * Triangles of one fill are one mesh, smooth ones another; a mesh stores corners in f32 and knows the line of each
//!   triangle. Polygons with more corners are objects of their own, in f64.
//!
//! Statements may spread over lines; a statement begins a line.

mod fill;
mod statements;

use super::text::{Text, Word, Words};
use super::{Fallible, Input, Report};
use crate::mesh::Triangulator;
use fill::Fill;
use std::sync::Arc;
use strahl_math::DVec3;
use strahl_scene::{Diagnostic, Object, Scene, Span};
use strahl_shade::{Color, ShadingModel};

/// Reads a scene; what is wrong goes to the report.
pub(super) fn read(input: &Input<'_>, report: &mut Report) -> Scene {
    let mut scene = Scene::default();
    scene.settings.shading = ShadingModel::Phong;
    let text = Text {
        bytes: input.bytes,
        name: input.name,
        file: scene.sources.add(input.name),
    };
    if text.refuse_binary("an NFF scene", report) {
        return scene;
    }
    let mut reader = Reader {
        text,
        words: text.words(0, 1),
        report,
        scene,
        fill: Fill::default(),
        fills: 0,
        has_view: false,
        lights: vec![],
        spheres: 0,
        cones: 0,
        polygons: 0,
        triangulator: Triangulator::default(),
    };
    reader.statements();
    reader.finish()
}

struct Reader<'a, 'r> {
    text: Text<'a>,
    words: Words<'a>,
    report: &'r mut Report,
    scene: Scene,
    /// The current fill with the triangles it has gathered.
    fill: Fill,
    fills: usize,
    has_view: bool,
    lights: Vec<LightLine>,
    // Numbers for names.
    spheres: usize,
    cones: usize,
    polygons: usize,
    triangulator: Triangulator,
}

/// An `l` statement; the strength depends on how many there are.
struct LightLine {
    position: DVec3,
    color: Color,
    span: Span,
}

impl Reader<'_, '_> {
    fn statements(&mut self) {
        while let Some(word) = self.words.next() {
            let line = word.line;
            let done = match word.bytes {
                b"v" => self.view(&word),
                b"b" => self.background(),
                b"l" => self.light(line),
                b"f" => self.fill(line),
                b"s" => self.sphere(&word),
                b"c" => self.cone(&word),
                b"p" => self.polygon(&word, false),
                b"pp" => self.polygon(&word, true),
                _ => Err(Box::new(
                    self.text
                        .at(
                            &word,
                            Diagnostic::error(format!(
                                "expected a statement, found `{}`",
                                word.shown()
                            )),
                        )
                        .hint("the statements of NFF are v, b, l, f, s, c, p and pp"),
                )),
            };
            if let Err(problem) = done {
                self.report.error(|| *problem);
                if self.report.is_hopeless() {
                    return;
                }
                self.recover();
            }
        }
    }

    /// Goes to the next line that begins with a letter, if that is not the rest of a view: there a statement begins.
    fn recover(&mut self) {
        loop {
            self.words.skip_line();
            match self.words.peek() {
                Some(word) if !word.bytes[0].is_ascii_alphabetic() || is_view_word(&word) => {
                    self.words.next();
                }
                _ => return,
            }
        }
    }

    /// What can only be said at the end.
    fn finish(mut self) -> Scene {
        self.flush_fill();
        let name = self.text.name;
        if !self.has_view && !self.report.has_errors() {
            self.report.warning(|| {
                Diagnostic::warning(format!(
                    "`{name}` has no `v` statement: the camera is placed automatically"
                ))
            });
        }
        if self.scene.objects.0.is_empty() && !self.report.has_errors() {
            self.report
                .warning(|| Diagnostic::warning(format!("`{name}` has no objects")));
        }
        let count = self.lights.len() as f64;
        if !self.lights.is_empty() {
            let strength = count.sqrt() / (2.0 * count);
            self.scene.ambient = Some(Color::gray(strength));
            for (i, light) in self.lights.drain(..).enumerate() {
                self.scene.lights.push(strahl_scene::SceneLight {
                    light: strahl_shade::Light::point(light.position, light.color * strength),
                    mask: None,
                    name: Some(Arc::from(format!("light {}", i + 1))),
                    span: light.span,
                });
            }
        }
        self.scene
    }

    fn flush_fill(&mut self) {
        let file = self.text.file;
        for object in self.fill.take_meshes(file, self.report) {
            self.scene.objects.0.push(object);
        }
    }

    fn add(
        &mut self,
        object: impl Into<Object>,
        name: String,
        line: u32,
        material: Arc<strahl_shade::Material>,
    ) {
        self.scene.objects.0.push(Object {
            name: Some(name.into()),
            span: Span::line(self.text.file, line),
            material: Some(material),
            ..object.into()
        });
    }
}

/// Whether a word belongs into a view.
fn is_view_word(word: &Word<'_>) -> bool {
    matches!(
        word.bytes,
        b"from" | b"at" | b"up" | b"angle" | b"hither" | b"resolution"
    )
}

#[cfg(test)]
mod tests;
