//! Free-form surfaces: `vp`, `cstype`, `deg`, `curv2`, `surf`, `parm`, `trim`, `hole`, `end`.
//!
//! Read are B-splines and Bezier patches, rational or not, with their trimming loops. Other types, special curves (`scrv`), special
//! points (`sp`), curves in space (`curv`) and connections (`con`) are ignored with a warning.

use super::block::{Parser, Place};
use super::faces::{Counts, RawCorner, entry};
use crate::input::report::Fallible;
use crate::input::text::{Text, Word};
use std::collections::HashMap;
use strahl_geometry::{GeometryError, Nurbs, NurbsCurve, NurbsData, TrimLoop};
use strahl_math::{DVec2, DVec3};
use strahl_scene::Diagnostic;

/// The type of curves and surfaces.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
enum Kind {
    /// No `cstype` yet.
    #[default]
    None,
    Bezier,
    BSpline,
    /// By its name.
    Other(String),
}

/// The curve or surface between its own statement and `end`.
#[derive(Debug)]
enum Element {
    /// Its control points are numbers of `vp`.
    Curve2(Vec<u32>),
    Surface {
        ranges: [[f64; 2]; 2],
        /// The numbers of `v`.
        points: Vec<u32>,
        loops: Vec<TrimLoop>,
    },
    /// One that is not read.
    Ignored,
}

/// The state of the statements about free-form geometry.
#[derive(Debug, Default)]
pub(super) struct FreeForm {
    /// Points of trimming curves, the third coordinate being a weight.
    parameters: Vec<DVec3>,
    /// Those that could not be made are missing.
    curves: Vec<Option<NurbsCurve>>,
    kind: Kind,
    is_rational: bool,
    degree: [u32; 2],
    /// Knots along u and v.
    knots: [Vec<f64>; 2],
    open: Option<(Element, Place)>,
}

/// What comes of a statement.
pub(super) enum Outcome {
    Nothing,
    Surface(Box<Nurbs>, Place),
    /// A key and a message.
    Warning(&'static str, String, Place),
    /// The same about a surface that is missing.
    LeftOut(&'static str, String, Place),
}

/// The points and weights of the file so far.
pub(super) struct Points<'a> {
    pub(super) positions: &'a [DVec3],
    /// Only those that are not 1.
    pub(super) weights: &'a HashMap<u32, f64>,
    pub(super) counts: Counts,
}

impl FreeForm {
    /// Reads one statement.
    pub(super) fn statement(
        &mut self,
        text: Text<'_>,
        place: Place,
        points: &Points<'_>,
    ) -> Fallible<Outcome> {
        let mut line = Parser::at(text, &place);
        let Some(word) = line.words.next() else {
            return Ok(Outcome::Nothing);
        };
        let missing = |what: &str| {
            let name = String::from_utf8_lossy(word.bytes);
            let problem = format!("`{name}` belongs between {what} and `end`");
            Err(Box::new(text.at(&word, Diagnostic::error(problem))))
        };
        match word.bytes {
            b"vp" => {
                let u = line.number("u")?;
                let v = line.optional_number(0.0)?;
                let w = line.optional_number(1.0)?;
                self.parameters.push(DVec3::new(u, v, w));
            }
            b"cstype" => self.read_type(&mut line)?,
            b"deg" => {
                let u = line.number("the degree along u")?;
                let v = line.optional_number(u)?;
                // What is no degree is refused with the surface.
                self.degree = [u, v].map(|d| if d.fract() == 0.0 { d as u32 } else { 0 });
            }
            b"curv2" => {
                let mut numbers = vec![];
                while let Some(word) = line.words.next_uncommented() {
                    numbers.push(self.number_of(text, &word, self.parameters.len(), "`vp`")?);
                }
                self.begin(Element::Curve2(numbers), place);
            }
            b"surf" => {
                let mut ranges = [[0.0; 2]; 2];
                for x in ranges.as_flattened_mut() {
                    *x = line.number("an end of the surface's parameters")?;
                }
                let mut numbers = vec![];
                while let Some(word) = line.words.next_uncommented() {
                    let corner = RawCorner::parse(word.bytes)
                        .and_then(|corner| corner.position_of(&word, &points.counts));
                    let number =
                        corner.map_err(|e| Box::new(text.at(&word, Diagnostic::error(e))))?;
                    numbers.push(number);
                }
                let element = Element::Surface {
                    ranges,
                    points: numbers,
                    loops: vec![],
                };
                self.begin(element, place);
            }
            b"curv" => {
                self.begin(Element::Ignored, place);
                let what = "free-form curves in space (`curv`) are ignored: they have no surface";
                return Ok(Outcome::Warning("curv", what.to_owned(), place));
            }
            b"parm" => {
                if self.open.is_none() {
                    return missing("`curv2` or `surf`");
                }
                let axis = match line.words.next_in_line().map(|w| w.bytes) {
                    Some(b"u") => 0,
                    Some(b"v") => 1,
                    _ => {
                        let problem = line.words.expected_in_line("`u` or `v`");
                        return Err(Box::new(problem));
                    }
                };
                let mut knots = vec![];
                while line.words.peek_in_line().is_some() {
                    knots.push(line.number("a knot")?);
                }
                self.knots[axis] = knots;
            }
            b"trim" | b"hole" => {
                let one = self.read_loop(&mut line, text, word.bytes == b"hole")?;
                match &mut self.open {
                    Some((Element::Surface { loops, .. }, _)) => loops.push(one),
                    Some((Element::Ignored, _)) => {}
                    _ => return missing("`surf`"),
                }
            }
            b"scrv" | b"sp" => {
                let what = "special curves and points (`scrv`, `sp`) are ignored: surfaces are not made of triangles that they could guide";
                return Ok(Outcome::Warning("scrv", what.to_owned(), place));
            }
            b"con" => {
                let what = "connections of surfaces (`con`) are ignored: borders are as close as the file has them";
                return Ok(Outcome::Warning("con", what.to_owned(), place));
            }
            b"end" => return Ok(self.end(points)),
            _ => {}
        }
        Ok(Outcome::Nothing)
    }

    fn begin(&mut self, element: Element, place: Place) {
        self.knots = [vec![], vec![]];
        self.open = Some((element, place));
    }

    fn read_type(&mut self, line: &mut Parser<'_>) -> Fallible<()> {
        let mut word = line.words.next_in_line();
        self.is_rational = word.is_some_and(|w| w.bytes == b"rat");
        if self.is_rational {
            word = line.words.next_in_line();
        }
        self.kind = match word.map(|w| w.bytes) {
            Some(b"bezier") => Kind::Bezier,
            Some(b"bspline") => Kind::BSpline,
            Some(other) => Kind::Other(String::from_utf8_lossy(other).into_owned()),
            None => {
                let problem = line
                    .words
                    .expected_in_line("a type of surfaces, as `bspline`");
                return Err(Box::new(problem));
            }
        };
        Ok(())
    }

    /// A number of a list, counted from 1 or back from the end; the result is counted from 0.
    fn number_of(
        &self,
        text: Text<'_>,
        word: &Word<'_>,
        count: usize,
        what: &str,
    ) -> Fallible<u32> {
        let number: Option<i32> = std::str::from_utf8(word.bytes)
            .ok()
            .and_then(|n| n.parse().ok());
        number
            .filter(|n| *n != 0)
            .and_then(|n| entry(n, count))
            .ok_or_else(|| {
                let problem = format!(
                    "expected the number of a {what}, found `{}`: there are {count} so far",
                    word.shown()
                );
                Box::new(text.at(word, Diagnostic::error(problem)))
            })
    }

    /// `u0 u1 curve u0 u1 curve ...`
    fn read_loop(
        &self,
        line: &mut Parser<'_>,
        text: Text<'_>,
        is_hole: bool,
    ) -> Fallible<TrimLoop> {
        let mut curves = vec![];
        while line.words.peek_in_line().is_some() {
            let range = [
                line.number("the begin of a curve")?,
                line.number("the end of a curve")?,
            ];
            let Some(word) = line.words.next_uncommented() else {
                let problem = line.words.expected_in_line("the number of a `curv2`");
                return Err(Box::new(problem));
            };
            let number = self.number_of(text, &word, self.curves.len(), "`curv2`")?;
            let wrong = |problem: String| Box::new(text.at(&word, Diagnostic::error(problem)));
            let curve = self.curves.get(number as usize).and_then(Option::as_ref);
            let curve =
                curve.ok_or_else(|| wrong(format!("the curve `{}` was left out", word.shown())))?;
            curves.push(curve.between(range).map_err(|e| wrong(e.to_string()))?);
        }
        Ok(TrimLoop { curves, is_hole })
    }

    /// Makes the curve or surface that ends here.
    fn end(&mut self, points: &Points<'_>) -> Outcome {
        let Some((element, place)) = self.open.take() else {
            return Outcome::Nothing;
        };
        match element {
            Element::Ignored => Outcome::Nothing,
            Element::Curve2(numbers) => match self.curve(&numbers) {
                Ok(curve) => {
                    self.curves.push(Some(curve));
                    Outcome::Nothing
                }
                Err(why) => {
                    // It keeps its number.
                    self.curves.push(None);
                    let what = format!("the trimming curve is left out: {why}");
                    Outcome::Warning("curv2", what, place)
                }
            },
            Element::Surface {
                ranges,
                points: numbers,
                loops,
            } => match self.surface(ranges, &numbers, &loops, points) {
                Ok(nurbs) => Outcome::Surface(Box::new(nurbs), place),
                Err(why) => {
                    let what = format!("the surface is left out: {why}");
                    Outcome::LeftOut("surf", what, place)
                }
            },
        }
    }

    fn curve(&self, numbers: &[u32]) -> Result<NurbsCurve, String> {
        let all: Vec<DVec3> = numbers
            .iter()
            .filter_map(|n| self.parameters.get(*n as usize).copied())
            .collect();
        Ok(NurbsCurve {
            degree: self.degree[0],
            knots: self.knots_along(0)?,
            points: all.iter().map(|p| DVec2::new(p.x, p.y)).collect(),
            weights: if self.is_rational {
                all.iter().map(|p| p.z).collect()
            } else {
                vec![]
            },
        })
    }

    fn surface(
        &self,
        ranges: [[f64; 2]; 2],
        numbers: &[u32],
        loops: &[TrimLoop],
        points: &Points<'_>,
    ) -> Result<Nurbs, String> {
        let data = NurbsData {
            degree: self.degree,
            knots: [self.knots_along(0)?, self.knots_along(1)?],
            points: numbers
                .iter()
                .filter_map(|n| points.positions.get(*n as usize).copied())
                .collect(),
            weights: if self.is_rational {
                let weight = |n: &u32| points.weights.get(n).copied().unwrap_or(1.0);
                numbers.iter().map(weight).collect()
            } else {
                vec![]
            },
        };
        data.between(ranges)
            .and_then(|data| Nurbs::try_trimmed(&data, loops))
            .map_err(|e: GeometryError| e.to_string())
    }

    /// The knots along an axis, from its `parm`.
    fn knots_along(&self, axis: usize) -> Result<Vec<f64>, String> {
        let (given, degree) = (&self.knots[axis], self.degree[axis] as usize);
        let letter = ["u", "v"][axis];
        if given.is_empty() {
            return Err(format!("`parm {letter}` is missing"));
        }
        match &self.kind {
            Kind::BSpline => Ok(given.clone()),
            // The ends of the pieces.
            Kind::Bezier => {
                let last = given.len() - 1;
                let times = |i: usize| degree.min(16) + usize::from(i == 0 || i == last);
                let all = given.iter().enumerate();
                Ok(all
                    .flat_map(|(i, knot)| std::iter::repeat_n(*knot, times(i)))
                    .collect())
            }
            Kind::None => Err("`cstype` is missing".to_owned()),
            Kind::Other(name) => Err(format!(
                "`cstype {name}` is not supported (`bspline` and `bezier` are, also with `rat`)"
            )),
        }
    }

    /// What is still open at the end of the file.
    pub(super) fn unfinished(&self) -> Option<Place> {
        self.open.as_ref().map(|(_, place)| *place)
    }
}
