use crate::grammar::Entity;
use crate::parser::{PResult, Parser};
use crate::token::{Kind, Token};
use strahl_geometry::{Subdivision, SubdivisionData, SubdivisionScheme};
use strahl_math::{DVec2, DVec3};

/// `subdivision { [catmull_clark | loop] points { .. } face { .. } ... [crease { .. }] ... [corner { .. }] ... }`
///
/// An extension. Its words other than `subdivision` itself have their meaning only here, so that scenes may use them as names.
pub(super) fn subdivision(p: &mut Parser<'_>) -> PResult<Entity> {
    p.shape(|p| {
        let mut data = SubdivisionData::default();
        loop {
            let token = p.peek()?;
            let Some(item) = p.subdivision_word(token, &ITEMS) else {
                break;
            };
            p.take(token)?;
            match item {
                "catmull_clark" => data.scheme = SubdivisionScheme::CatmullClark,
                "loop" => data.scheme = SubdivisionScheme::Loop,
                "points" => p.control_points(&mut data.points)?,
                "face" => p.control_face(&mut data)?,
                "crease" => {
                    let (sharpness, vertices) = p.sharp_vertices(&data)?;
                    let edges = vertices.windows(2).map(|pair| [pair[0], pair[1]]);
                    data.creases.extend(edges.map(|edge| (edge, sharpness)));
                }
                _ => {
                    let (sharpness, vertices) = p.sharp_vertices(&data)?;
                    data.corners
                        .extend(vertices.into_iter().map(|v| (v, sharpness)));
                }
            }
            p.comma()?;
        }
        if data.points.is_empty() || data.sizes.is_empty() {
            let token = p.peek()?;
            return Err(p.unexpected(
                token,
                "`points`, `face`, `crease`, `corner`, `catmull_clark` or `loop`",
            ));
        }
        Ok(Subdivision::try_new(&data))
    })
}

/// The items of the object.
const ITEMS: [&str; 6] = [
    "catmull_clark",
    "loop",
    "points",
    "face",
    "crease",
    "corner",
];

impl Parser<'_> {
    /// Which of these words a token is.
    fn subdivision_word(&self, token: Token, words: &[&'static str]) -> Option<&'static str> {
        if token.kind != Kind::Name {
            return None;
        }
        let text = self.symbols.text(token.symbol()?);
        words.iter().find(|word| **word == text).copied()
    }

    fn control_points(&mut self, points: &mut Vec<DVec3>) -> PResult<()> {
        self.braces(|p| {
            while p.peek()?.kind != Kind::RightBrace {
                p.count_parts(1)?;
                points.push(p.vector3()?);
                p.comma()?;
            }
            Ok(())
        })
    }

    /// Numbers of points up to the closing brace or a word.
    fn point_numbers(&mut self, data: &SubdivisionData) -> PResult<Vec<u32>> {
        let mut numbers = vec![];
        loop {
            let token = self.peek()?;
            if token.kind == Kind::RightBrace || self.subdivision_word(token, &["uv"]).is_some() {
                return Ok(numbers);
            }
            self.count_parts(1)?;
            let place = self.place_of(token);
            let number = self.float()?;
            let count = data.points.len();
            if !(number.fract() == 0.0 && (0.0..count as f64).contains(&number)) {
                let message = format!("there is no point {number}: {count} points came before");
                let hint = "points are counted from 0; `points` comes before what refers to them";
                return Err(self.fail_hint(place, message, hint));
            }
            numbers.push(number as u32);
            self.comma()?;
        }
    }

    /// `{ a, b, c, .. [uv { <u, v>, .. }] }`
    fn control_face(&mut self, data: &mut SubdivisionData) -> PResult<()> {
        let place = self.place();
        self.braces(|p| {
            let corners = p.point_numbers(data)?;
            let token = p.peek()?;
            let mut uvs: Vec<DVec2> = vec![];
            if p.subdivision_word(token, &["uv"]).is_some() {
                p.take(token)?;
                p.braces(|p| {
                    while p.peek()?.kind != Kind::RightBrace {
                        p.count_parts(1)?;
                        uvs.push(DVec2::from_array(p.vector2()?));
                        p.comma()?;
                    }
                    Ok(())
                })?;
                if uvs.len() != corners.len() {
                    let message = format!(
                        "this face has {} corners, but {} `uv`",
                        corners.len(),
                        uvs.len()
                    );
                    return Err(p.fail(place, message));
                }
            }
            let is_like_before = data.uvs.is_empty() == uvs.is_empty() || data.sizes.is_empty();
            if !is_like_before {
                let message = "either all faces have `uv` or none";
                return Err(p.fail(place, message));
            }
            data.sizes.push(corners.len() as u32);
            data.indices.extend(corners);
            data.uvs.extend(uvs);
            Ok(())
        })
    }

    /// `{ [sharpness s] a, b, .. }`
    fn sharp_vertices(&mut self, data: &SubdivisionData) -> PResult<(f64, Vec<u32>)> {
        self.braces(|p| {
            let token = p.peek()?;
            let mut sharpness = f64::INFINITY;
            if p.subdivision_word(token, &["sharpness"]).is_some() {
                p.take(token)?;
                let place = p.place();
                sharpness = p.float()?;
                if sharpness.is_nan() || sharpness < 0.0 {
                    let message =
                        format!("a sharpness is 0 (smooth) or greater, found {sharpness}");
                    return Err(p.fail_hint(place, message, "10 and more is sharp for ever"));
                }
                p.comma()?;
            }
            Ok((sharpness, p.point_numbers(data)?))
        })
    }
}
