use super::fill::FillNumbers;
use super::part::{Kind, LightLine, Part, Placed};
use crate::input::ahead::{Piece, Statements, read_statements};
use crate::input::text::{Text, Word, Words, parse_f64, parse_integer};
use crate::input::{Fallible, Report};
use crate::mesh::{NO_AREA, Triangulator, polygon_normal};
use std::f64::consts::PI;
use strahl_geometry::{Cone, Cylinder, Polygon, Primitive, Shape, Sphere};
use strahl_math::DVec3;
use strahl_scene::{Camera, Diagnostic, Span};
use strahl_shade::Color;

/// Largest number of pixels along an edge of the picture.
const MOST_PIXELS: i64 = 1 << 20;

/// Parses statements without knowing those before them.
pub(super) struct Parser<'a> {
    text: Text<'a>,
    pub(super) words: Words<'a>,
    pub(super) report: Report,
    /// Whether there has been a fill.
    pub(super) has_fill: bool,
    /// The result so far.
    pub(super) parts: Vec<Part>,
    triangulator: Triangulator,
}

impl<'a> Statements<'a> for Parser<'a> {
    fn words(&mut self) -> &mut Words<'a> {
        &mut self.words
    }

    /// Views are not handled here, because they concern the whole text.
    fn statement(&mut self) -> Fallible<()> {
        let Some(word) = self.words.next() else {
            return Ok(());
        };
        match word.bytes {
            b"b" => self.background(),
            b"l" => self.light(word.line),
            b"f" => self.fill(word.line),
            b"s" => self.sphere(&word),
            b"c" => self.cone(&word),
            b"p" => self.polygon(&word, false),
            b"pp" => self.polygon(&word, true),
            _ => {
                let problem = format!("expected a statement, found `{}`", word.shown());
                Err(Box::new(
                    self.text
                        .at(&word, Diagnostic::error(problem))
                        .hint("the statements of NFF are v, b, l, f, s, c, p and pp"),
                ))
            }
        }
    }
}

impl<'a> Parser<'a> {
    pub(super) fn new(text: Text<'a>, words: Words<'a>, report: Report) -> Self {
        Self {
            text,
            words,
            report,
            has_fill: false,
            parts: vec![],
            triangulator: Triangulator::default(),
        }
    }

    /// Moves to the next word before byte `end` that begins a statement: the next word, or the first of a later line. Returns
    /// whether there is one.
    pub(super) fn seek_statement(&mut self, end: usize) -> bool {
        while self.words.advance() && self.words.position() < end {
            if self.words.peek().is_some_and(|w| begins_statement(&w)) {
                return true;
            }
            self.words.skip_line();
        }
        false
    }

    /// Moves to the next line that begins with a letter and not with a word of a view: a statement begins there.
    pub(super) fn recover(&mut self) {
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

    /// Reads the view, in any order; `hither` may be missing.
    pub(super) fn view(&mut self, start: &Word<'_>) -> Fallible<(Camera, Option<(u32, u32)>)> {
        let (mut from, mut at, mut up, mut angle, mut size) = (None, None, None, None, None);
        while let Some(word) = self.words.peek().filter(is_view_word) {
            self.words.next();
            let repeated = match word.bytes {
                b"from" => from.replace(self.point("the eye")?).is_some(),
                b"at" => at.replace(self.point("the point looked at")?).is_some(),
                b"up" => up.replace(self.point("the up vector")?).is_some(),
                b"angle" => {
                    let number = self.words.peek().unwrap_or(word);
                    let degrees = self.number("the viewing angle in degrees")?;
                    if !(degrees > 0.0 && degrees < 180.0) {
                        let problem = format!(
                            "expected an angle between 0 and 180 degrees, found `{degrees}`"
                        );
                        return Err(self.fault(&number, problem));
                    }
                    angle.replace(degrees / 180.0 * PI).is_some()
                }
                b"resolution" => {
                    let width = self.count("the picture's width in pixels", 1, MOST_PIXELS)?;
                    size.replace((
                        width,
                        self.count("the picture's height in pixels", 1, MOST_PIXELS)?,
                    ))
                    .is_some()
                }
                _ => {
                    self.number("the distance of the hither plane")?;
                    false
                }
            };
            if repeated {
                return Err(self.fault(&word, format!("`{}` is given twice", word.shown())));
            }
        }
        let missing = |what: &str| {
            let hint = "a view has from, at, up, angle, hither and resolution";
            Box::new(
                self.words
                    .expected(&format!("`{what}` in the view"))
                    .hint(hint),
            )
        };
        let from = from.ok_or_else(|| missing("from"))?;
        let at = at.ok_or_else(|| missing("at"))?;
        let up = up.ok_or_else(|| missing("up"))?;
        let angle = angle.ok_or_else(|| missing("angle"))?;
        let mut camera = Camera::perspective(from, at, up, angle);
        camera.span = Span::line(self.text.file, start.line);
        if from == at {
            return Err(self.fault(
                start,
                "the eye (`from`) is at the point looked at (`at`)".into(),
            ));
        }
        if let Some(problem) = camera.problem() {
            return Err(self.fault(start, problem.into()));
        }
        Ok((camera, size))
    }

    fn background(&mut self) -> Fallible<()> {
        let color = self.color("the background")?;
        self.part().background = Some(color);
        Ok(())
    }

    fn light(&mut self, line: u32) -> Fallible<()> {
        let position = self.point("the light's position")?;
        let color = if self.words.peek_in_line().is_some() {
            Some(self.color("the light")?)
        } else {
            None
        };
        let span = Span::line(self.text.file, line);
        self.part().lights.push(LightLine {
            position,
            color,
            span,
        });
        Ok(())
    }

    fn fill(&mut self, line: u32) -> Fallible<()> {
        let color = self.color("the fill")?;
        let kd = self.at_least_0("Kd, the diffuse part")?;
        let ks = self.at_least_0("Ks, the specular part")?;
        let shine = self.at_least_0("Shine, the exponent of the highlight")?;
        let word = self.words.peek();
        let t = self.at_least_0("T, the transmitted part")?;
        if let Some(word) = word.filter(|_| t > 1.0) {
            return Err(self.fault(
                &word,
                format!("T, the transmitted part, must be at most 1, found `{t}`"),
            ));
        }
        let has_ior = self.words.peek_in_line().is_some();
        let ior = if has_ior {
            self.at_least_0("the index of refraction")?
        } else {
            0.0
        };
        self.has_fill = true;
        let numbers = FillNumbers {
            color,
            kd,
            ks,
            shine,
            t,
            ior,
        };
        self.parts.push(Part {
            fill: Some((numbers, line)),
            ..Part::default()
        });
        Ok(())
    }

    fn sphere(&mut self, start: &Word<'_>) -> Fallible<()> {
        self.needs_fill(start);
        let center = self.point("the sphere's centre")?;
        let radius = self.number("the sphere's radius")?;
        let sphere =
            Sphere::try_new(center, radius).map_err(|e| self.fault(start, e.to_string()))?;
        let kind = Kind::Sphere {
            inside_only: radius < 0.0,
        };
        self.add(sphere.into(), kind, start.line);
        Ok(())
    }

    fn cone(&mut self, start: &Word<'_>) -> Fallible<()> {
        self.needs_fill(start);
        let base = self.point("the centre of the cone's base")?;
        let base_radius = self.number("the radius of the base")?;
        let apex = self.point("the centre of the cone's apex")?;
        let apex_radius = self.number("the radius of the apex")?;
        let inside_only =
            base_radius <= 0.0 && apex_radius <= 0.0 && base_radius + apex_radius < 0.0;
        let (r0, r1) = if inside_only {
            (-base_radius, -apex_radius)
        } else {
            (base_radius, apex_radius)
        };
        let (shape, kind): (Shape, _) = if r0 == r1 {
            (Cylinder::open(base, apex, r0).into(), Kind::Cylinder)
        } else {
            (Cone::open(base, r0, apex, r1).into(), Kind::Cone)
        };
        shape
            .validate()
            .map_err(|e| self.fault(start, e.to_string()))?;
        if inside_only {
            self.report.count("inside-only cone", || {
                let problem = Diagnostic::warning("a cone with negative radii is seen from the inside only; here it is seen from both sides");
                self.text.at(start, problem)
            });
        }
        self.add(shape, kind, start.line);
        Ok(())
    }

    fn polygon(&mut self, start: &Word<'_>, smooth: bool) -> Fallible<()> {
        self.needs_fill(start);
        let count = self.count("the number of corners", 3, i64::MAX)?;
        if count == 3 && !smooth {
            let corners = [
                self.point("a corner")?,
                self.point("a corner")?,
                self.point("a corner")?,
            ];
            self.part().polygons += 1;
            if polygon_normal(&corners).is_some() {
                self.part().add_flat(corners, start.line);
            } else {
                self.skipped(start, NO_AREA);
            }
            return Ok(());
        }
        let (mut corners, mut normals) = (vec![], vec![]);
        for _ in 0..count {
            corners.push(self.point("a corner")?);
            if smooth {
                normals.push(self.point("the normal of a corner")?);
            }
        }
        self.part().polygons += 1;
        let Some(normal) = polygon_normal(&corners) else {
            self.skipped(start, NO_AREA);
            return Ok(());
        };
        if smooth {
            self.replace_zero_normals(start, &mut normals, normal);
            let mut triangles = vec![];
            match self.triangulator.triangulate(&corners, &mut triangles) {
                Ok(()) => self
                    .part()
                    .add_patch(&corners, &normals, &triangles, start.line),
                Err(why) => self.skipped(start, why),
            }
        } else {
            self.many_corners(start, &corners);
        }
        Ok(())
    }

    fn many_corners(&mut self, start: &Word<'_>, corners: &[DVec3]) {
        let text = self.text;
        match Polygon::try_new(corners) {
            Ok(polygon) => {
                let kind = Kind::Polygon {
                    number: self.part().polygons,
                };
                self.add(polygon.into(), kind, start.line);
            }
            // Probably the corners are not in one plane; those of triangles always are.
            Err(problem) => {
                let mut triangles = vec![];
                match self.triangulator.triangulate(corners, &mut triangles) {
                    Ok(()) => {
                        self.report.count("cut polygon", || {
                            text.at(
                                start,
                                Diagnostic::warning(format!(
                                    "the polygon is cut into triangles: {problem}"
                                )),
                            )
                        });
                        for triangle in triangles {
                            self.part()
                                .add_flat(triangle.map(|i| corners[i as usize]), start.line);
                        }
                    }
                    Err(why) => self.skipped(start, why),
                }
            }
        }
    }

    fn replace_zero_normals(&mut self, start: &Word<'_>, normals: &mut [DVec3], own: DVec3) {
        for normal in normals {
            match normal.try_normalize() {
                Some(unit) => *normal = unit,
                None => {
                    *normal = own;
                    self.report.count("zero normal", || {
                        let problem = Diagnostic::warning(
                            "a corner's normal has no length; the polygon's own is taken",
                        );
                        self.text.at(start, problem)
                    });
                }
            }
        }
    }

    fn skipped(&mut self, start: &Word<'_>, why: &str) {
        let text = self.text;
        self.report.count("skipped polygon", || {
            text.at(
                start,
                Diagnostic::warning(format!("the polygon is left out: {why}")),
            )
        });
    }

    fn needs_fill(&mut self, start: &Word<'_>) {
        let text = self.text;
        if !self.has_fill {
            self.report.count("no fill", || {
                let problem = Diagnostic::warning(
                    "there is no `f` statement before this object: it gets a grey material",
                );
                text.at(start, problem)
            });
        }
    }

    /// The part for the following objects.
    fn part(&mut self) -> &mut Part {
        if self.parts.is_empty() {
            self.parts.push(Part::default());
        }
        let last = self.parts.len() - 1;
        &mut self.parts[last]
    }

    fn add(&mut self, shape: Shape, kind: Kind, line: u32) {
        self.part().objects.push(Placed { shape, kind, line });
    }

    pub(super) fn fault(&self, word: &Word<'_>, problem: String) -> Box<Diagnostic> {
        Box::new(self.text.at(word, Diagnostic::error(problem)))
    }

    fn number(&mut self, what: &str) -> Fallible<f64> {
        if let Some(number) = self.words.short_number() {
            return Ok(number);
        }
        let before = self.words.clone();
        let Some(word) = self.words.next().filter(|word| !begins_statement(word)) else {
            // The next statement has begun, so the word is put back.
            self.words = before;
            return Err(Box::new(self.words.expected(&format!("a number ({what})"))));
        };
        parse_f64(word.bytes).map_err(|e| {
            Box::new(
                self.text
                    .at(&word, e.describe(&word, &format!("a number ({what})"))),
            )
        })
    }

    fn at_least_0(&mut self, what: &str) -> Fallible<f64> {
        let word = self.words.peek();
        let value = self.number(what)?;
        match word {
            Some(word) if value < 0.0 => Err(self.fault(
                &word,
                format!("{what}, must not be negative, found `{value}`"),
            )),
            _ => Ok(value),
        }
    }

    fn count(&mut self, what: &str, least: i64, most: i64) -> Fallible<u32> {
        let Some(word) = self.words.next() else {
            return Err(Box::new(self.words.expected(what)));
        };
        match parse_integer(word.bytes) {
            Ok(n) if n >= least && n <= most => Ok(u32::try_from(n).unwrap_or(u32::MAX)),
            Ok(n) if n < least => Err(self.fault(
                &word,
                format!("{what} must be at least {least}, found `{n}`"),
            )),
            Ok(n) => Err(self.fault(&word, format!("{what} must be at most {most}, found `{n}`"))),
            Err(_) => Err(self.fault(
                &word,
                format!("expected a whole number ({what}), found `{}`", word.shown()),
            )),
        }
    }

    fn point(&mut self, what: &str) -> Fallible<DVec3> {
        Ok(DVec3::new(
            self.number(what)?,
            self.number(what)?,
            self.number(what)?,
        ))
    }

    fn color(&mut self, what: &str) -> Fallible<Color> {
        let what = format!("the colour of {what}");
        Ok(Color::new(
            self.at_least_0(&what)?,
            self.at_least_0(&what)?,
            self.at_least_0(&what)?,
        ))
    }
}

/// Whether a word certainly begins a statement, so that something is missing before it.
fn begins_statement(word: &Word<'_>) -> bool {
    matches!(
        word.bytes,
        b"v" | b"b" | b"l" | b"f" | b"s" | b"c" | b"p" | b"pp"
    )
}

/// Whether a word belongs to a view.
fn is_view_word(word: &Word<'_>) -> bool {
    matches!(
        word.bytes,
        b"from" | b"at" | b"up" | b"angle" | b"hither" | b"resolution"
    )
}

/// The parts between two places of the text, and the report about them.
pub(super) type Parts = (Vec<Part>, Report);

/// Parses the statements that begin before `end`, up to the first erroneous one or a view.
///
/// It assumes that a fill has begun before.
pub(super) fn read_ahead<'a>(
    text: Text<'a>,
    words: Words<'a>,
    end: usize,
) -> Option<Piece<'a, Parts>> {
    let mut parser = Parser::new(text, words, Report::default());
    parser.has_fill = true;
    if !parser.seek_statement(end) {
        return None;
    }
    let (start, rest) = read_statements(&mut parser, end)?;
    Some(Piece {
        start,
        content: (parser.parts, parser.report),
        rest,
    })
}
