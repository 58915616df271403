use super::fill::{Fill, FillNumbers};
use super::{Fallible, LightLine, Reader, is_view_word};
use crate::mesh::polygon_normal;
use crate::scene::text::{Word, parse_f64, parse_integer};
use std::f64::consts::PI;
use strahl_geometry::{Cone, Cylinder, Polygon, Primitive, Shape, Sphere};
use strahl_math::DVec3;
use strahl_scene::{Background, Camera, Diagnostic, Span};
use strahl_shade::Color;

/// Most pixels along an edge of the picture.
const MOST_PIXELS: i64 = 1 << 20;

impl Reader<'_, '_> {
    /// The view, in any order; `hither` may be missing.
    pub(super) fn view(&mut self, start: &Word<'_>) -> Fallible<()> {
        if std::mem::replace(&mut self.has_view, true) {
            return Err(self.fault(start, "there is a second `v` statement".into()));
        }
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
        self.scene.camera = Some(camera);
        self.scene.settings.size = size;
        Ok(())
    }

    pub(super) fn background(&mut self) -> Fallible<()> {
        let color = self.color("the background")?;
        self.scene.background = Some(Background::Solid(color));
        Ok(())
    }

    pub(super) fn light(&mut self, line: u32) -> Fallible<()> {
        let position = self.point("the light's position")?;
        let color = if self.words.peek_in_line().is_some() {
            self.color("the light")?
        } else {
            Color::WHITE
        };
        let span = Span::line(self.text.file, line);
        self.lights.push(LightLine {
            position,
            color,
            span,
        });
        Ok(())
    }

    pub(super) fn fill(&mut self, line: u32) -> Fallible<()> {
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
        self.flush_fill();
        self.fills += 1;
        self.fill = Fill::new(
            self.fills,
            line,
            &FillNumbers {
                color,
                kd,
                ks,
                shine,
                t,
                ior,
            },
        );
        Ok(())
    }

    pub(super) fn sphere(&mut self, start: &Word<'_>) -> Fallible<()> {
        self.needs_fill(start);
        let center = self.point("the sphere's centre")?;
        let radius = self.number("the sphere's radius")?;
        self.spheres += 1;
        let sphere =
            Sphere::try_new(center, radius).map_err(|e| self.fault(start, e.to_string()))?;
        let material = if radius < 0.0 {
            self.fill.one_sided()
        } else {
            self.fill.two_sided()
        };
        self.add(
            sphere,
            format!("sphere {}", self.spheres),
            start.line,
            material,
        );
        Ok(())
    }

    pub(super) fn cone(&mut self, start: &Word<'_>) -> Fallible<()> {
        self.needs_fill(start);
        let base = self.point("the centre of the cone's base")?;
        let base_radius = self.number("the radius of the base")?;
        let apex = self.point("the centre of the cone's apex")?;
        let apex_radius = self.number("the radius of the apex")?;
        self.cones += 1;
        let inside_only =
            base_radius <= 0.0 && apex_radius <= 0.0 && base_radius + apex_radius < 0.0;
        let (r0, r1) = if inside_only {
            (-base_radius, -apex_radius)
        } else {
            (base_radius, apex_radius)
        };
        let (shape, what): (Shape, _) = if r0 == r1 {
            (Cylinder::open(base, apex, r0).into(), "cylinder")
        } else {
            (Cone::open(base, r0, apex, r1).into(), "cone")
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
        let material = self.fill.two_sided();
        self.add(
            shape,
            format!("{what} {}", self.cones),
            start.line,
            material,
        );
        Ok(())
    }

    pub(super) fn polygon(&mut self, start: &Word<'_>, smooth: bool) -> Fallible<()> {
        self.needs_fill(start);
        let count = self.count("the number of corners", 3, i64::MAX)?;
        let (mut corners, mut normals) = (vec![], vec![]);
        for _ in 0..count {
            corners.push(self.point("a corner")?);
            if smooth {
                normals.push(self.point("the normal of a corner")?);
            }
        }
        self.polygons += 1;
        let Some(normal) = polygon_normal(&corners) else {
            self.skipped(start, "it has no area");
            return Ok(());
        };
        if smooth {
            self.replace_zero_normals(start, &mut normals, normal);
            let mut triangles = vec![];
            match self.triangulator.triangulate(&corners, &mut triangles) {
                Ok(()) => self
                    .fill
                    .add_patch(&corners, &normals, &triangles, start.line),
                Err(why) => self.skipped(start, why),
            }
        } else if let [a, b, c] = corners[..] {
            self.fill.add_flat([a, b, c], start.line);
        } else {
            self.many_corners(start, &corners);
        }
        Ok(())
    }

    fn many_corners(&mut self, start: &Word<'_>, corners: &[DVec3]) {
        let text = self.text;
        match Polygon::try_new(corners) {
            Ok(polygon) => {
                let material = self.fill.of_polygons();
                self.add(
                    polygon,
                    format!("polygon {}", self.polygons),
                    start.line,
                    material,
                );
            }
            // Most likely the corners are not in one plane; triangles always are.
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
                            self.fill
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
        if !self.fill.is_explicit() {
            self.report.count("no fill", || {
                let problem = Diagnostic::warning(
                    "there is no `f` statement before this object: it gets a grey material",
                );
                text.at(start, problem)
            });
        }
    }

    fn fault(&self, word: &Word<'_>, problem: String) -> Box<Diagnostic> {
        Box::new(self.text.at(word, Diagnostic::error(problem)))
    }

    fn number(&mut self, what: &str) -> Fallible<f64> {
        let before = self.words.clone();
        let Some(word) = self.words.next().filter(|word| !begins_statement(word)) else {
            // The statement is not taken, so that reading goes on there.
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

/// Whether a word surely begins a statement, so that something is missing before it.
fn begins_statement(word: &Word<'_>) -> bool {
    matches!(
        word.bytes,
        b"v" | b"b" | b"l" | b"f" | b"s" | b"c" | b"p" | b"pp"
    )
}
