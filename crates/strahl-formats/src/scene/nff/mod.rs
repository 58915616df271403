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
//! * A light without a colour is white, with the strength √n/(2n) for n lights: the format leaves it to the program. The colour
//!   of a light is used as it is. The ambient light always has the strength √n/(2n).
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
mod part;
mod statements;

use crate::input::ahead::{Ahead, Statements};
use crate::input::text::Text;
use crate::input::{Fallible, Input, Report};
use fill::Fill;
use part::{Kind, LightLine, Part, Placed};
use rayon::Scope;
use statements::{Parser, Parts, read_ahead};
use std::fmt::Write;
use std::sync::Arc;
use strahl_scene::{Background, Diagnostic, Object, Scene, Span};
use strahl_shade::{Color, ShadingModel};

/// Reads a scene; errors and warnings go to the report.
pub(super) fn read(input: &Input<'_>, report: &mut Report) -> Scene {
    read_with(input, report, Ahead::default())
}

/// [`read`] with parts of another size; the result does not depend on it.
fn read_with<'a>(input: &'a Input<'a>, report: &mut Report, ahead: Ahead<'a, Parts>) -> Scene {
    let mut scene = Scene::default();
    scene.settings.shading = ShadingModel::Phong;
    let text = Text::new(input.bytes, input.name, scene.sources.add(input.name));
    if text.refuse_binary("an NFF scene", report) {
        return scene;
    }
    let mut reader = Reader {
        text,
        parser: Parser::new(text, text.words(0, 1), std::mem::take(report)),
        ahead,
        scene,
        fill: Fill::default(),
        fills: 0,
        has_view: false,
        lights: vec![],
        spheres: 0,
        cones: 0,
        polygons: 0,
        name: String::new(),
    };
    rayon::in_place_scope(|scope| reader.statements(scope));
    reader.finish();
    *report = reader.parser.report;
    reader.scene
}

/// Builds the scene from parsed statements.
struct Reader<'a> {
    text: Text<'a>,
    /// Parses the statements that are not read ahead, and collects all diagnostics.
    parser: Parser<'a>,
    ahead: Ahead<'a, Parts>,
    scene: Scene,
    /// The current fill with the triangles collected so far.
    fill: Fill,
    fills: usize,
    has_view: bool,
    lights: Vec<LightLine>,
    // Counters for the names of objects.
    spheres: usize,
    cones: usize,
    polygons: usize,
    /// The last name.
    name: String,
}

impl<'a> Reader<'a> {
    fn statements<'s>(&mut self, scope: &Scope<'s>)
    where
        'a: 's,
    {
        let text = self.text;
        while self.parser.words.advance() {
            // The text before the first fill is short, and each object there gets a warning.
            let piece = if self.parser.has_fill {
                let read = move |words, end| read_ahead(text, words, end);
                self.ahead.piece(scope, &self.parser.words, read)
            } else {
                None
            };
            if let Some(piece) = piece {
                let (parts, report) = piece.content;
                self.add_read(0);
                parts.into_iter().for_each(|part| self.add(part));
                self.parser.report.append(report);
                self.parser.words = piece.rest;
                continue;
            }
            if let Err(problem) = self.statement() {
                self.parser.report.error(|| *problem);
                if self.parser.report.is_hopeless() {
                    return;
                }
                self.parser.recover();
            }
            self.add_read(1);
        }
        self.add_read(0);
    }

    fn statement(&mut self) -> Fallible<()> {
        let Some(word) = self.parser.words.peek().filter(|word| word.bytes == b"v") else {
            return self.parser.statement();
        };
        self.parser.words.next();
        if std::mem::replace(&mut self.has_view, true) {
            let problem = "there is a second `v` statement".into();
            return Err(self.parser.fault(&word, problem));
        }
        let (camera, size) = self.parser.view(&word)?;
        self.scene.camera = Some(camera);
        self.scene.settings.size = size;
        Ok(())
    }

    /// Adds the parts that the parser has read, except for the last `keep`.
    fn add_read(&mut self, keep: usize) {
        while self.parser.parts.len() > keep {
            let part = self.parser.parts.remove(0);
            self.add(part);
        }
        // Problems of a mesh are reported as soon as the mesh ends.
        if self.parser.parts.iter().any(|part| part.fill.is_some()) {
            self.flush_fill();
        }
    }

    fn add(&mut self, part: Part) {
        if let Some((numbers, line)) = part.fill {
            self.flush_fill();
            self.fills += 1;
            self.fill = Fill::new(self.fills, line, &numbers);
        }
        if let Some(color) = part.background {
            self.scene.background = Some(Background::Solid(color));
        }
        self.lights.extend(part.lights);
        for placed in part.objects {
            self.add_object(placed);
        }
        self.polygons += part.polygons;
        self.fill.add(part.flat, part.smooth);
    }

    fn add_object(&mut self, placed: Placed) {
        let (what, number, material) = match placed.kind {
            Kind::Sphere { inside_only } => {
                self.spheres += 1;
                let material = if inside_only {
                    self.fill.one_sided()
                } else {
                    self.fill.two_sided()
                };
                ("sphere", self.spheres, material)
            }
            Kind::Cone | Kind::Cylinder => {
                self.cones += 1;
                let what = match placed.kind {
                    Kind::Cone => "cone",
                    _ => "cylinder",
                };
                (what, self.cones, self.fill.two_sided())
            }
            Kind::Polygon { number } => {
                ("polygon", self.polygons + number, self.fill.of_polygons())
            }
        };
        self.name.clear();
        // Writing to a string never fails.
        let _ = write!(self.name, "{what} {number}");
        self.scene.objects.0.push(Object {
            name: Some(Arc::from(self.name.as_str())),
            span: Span::line(self.text.file, placed.line),
            material: Some(material),
            ..placed.shape.into()
        });
    }

    /// Reports what is known only at the end.
    fn finish(&mut self) {
        self.flush_fill();
        let (name, report) = (self.text.name, &mut self.parser.report);
        if !self.has_view && !report.has_errors() {
            report.warning(|| {
                Diagnostic::warning(format!(
                    "`{name}` has no `v` statement: the camera is placed automatically"
                ))
            });
        }
        if self.scene.objects.0.is_empty() && !report.has_errors() {
            report.warning(|| Diagnostic::warning(format!("`{name}` has no objects")));
        }
        let count = self.lights.len() as f64;
        if !self.lights.is_empty() {
            let strength = count.sqrt() / (2.0 * count);
            self.scene.ambient = Some(Color::gray(strength));
            for (i, light) in self.lights.drain(..).enumerate() {
                self.scene.lights.push(strahl_scene::SceneLight {
                    light: strahl_shade::Light::point(
                        light.position,
                        light.color.unwrap_or(Color::gray(strength)),
                    ),
                    mask: None,
                    name: Some(Arc::from(format!("light {}", i + 1))),
                    span: light.span,
                });
            }
        }
    }

    fn flush_fill(&mut self) {
        let file = self.text.file;
        for object in self.fill.take_meshes(file, &mut self.parser.report) {
            self.scene.objects.0.push(object);
        }
    }
}

#[cfg(test)]
mod tests;
