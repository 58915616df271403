use crate::grammar::Entity;
use crate::parser::{PResult, Parser, Place};
use crate::token::Kind;
use crate::value::Vector;
use strahl_geometry::{Nurbs, NurbsCurve, NurbsData, TrimLoop};
use strahl_math::{DVec2, DVec3};

/// `nurbs { [degree d] [u_knots { .. }] [v_knots { .. }] row { points } ... [trim { .. }] [hole { .. }] ... }`
///
/// An extension. Its words other than `nurbs` itself have their meaning only here, so that scenes may use them as names.
pub(super) fn nurbs(p: &mut Parser<'_>) -> PResult<Entity> {
    p.shape(|p| {
        let mut items = Items::default();
        loop {
            let token = p.peek()?;
            let Some(item) = p.own_word(token, &ITEMS) else {
                break;
            };
            let place = p.place_of(token);
            p.take(token)?;
            match item {
                "degree" => items.degree = Some(p.degrees()?),
                "u_knots" => items.knots[0] = Some((p.knots()?, place)),
                "v_knots" => items.knots[1] = Some((p.knots()?, place)),
                "row" => p.row(&mut items)?,
                word => {
                    let one = p.trim_loop(word == "hole")?;
                    items.loops.push(one);
                }
            }
            p.comma()?;
        }
        let Items {
            degree,
            knots: [u_knots, v_knots],
            points,
            weights,
            columns,
            loops,
        } = items;
        if points.is_empty() {
            let token = p.peek()?;
            return Err(p.unexpected(
                token,
                "`row`, `degree`, `u_knots`, `v_knots`, `trim` or `hole`",
            ));
        }
        let degree = degree.unwrap_or([3, 3]);
        let mut data = NurbsData::new(degree, columns, points);
        data.weights = weights;
        let rows = data.points.len() / columns;
        for (axis, (knots, place)) in [u_knots, v_knots]
            .into_iter()
            .enumerate()
            .filter_map(|(k, knots)| Some((k, knots?)))
        {
            let count = [columns, rows][axis];
            let needed = count + degree[axis] as usize + 1;
            if knots.len() != needed {
                let what = ["control points in a row", "rows"][axis];
                let message = format!(
                    "{count} {what} of degree {} need {needed} `{}_knots`, found {}",
                    degree[axis],
                    ["u", "v"][axis],
                    knots.len()
                );
                return Err(p.fail_hint(
                    place,
                    message,
                    "as many as points, and the degree, and one",
                ));
            }
            data.knots[axis] = knots;
        }
        Ok(Nurbs::try_trimmed(&data, &loops))
    })
}

/// The items of the object.
const ITEMS: [&str; 6] = ["degree", "u_knots", "v_knots", "row", "trim", "hole"];
/// The items of a trimming curve.
const CURVE: [&str; 2] = ["degree", "knots"];

/// What has been read.
#[derive(Default)]
struct Items {
    degree: Option<[u32; 2]>,
    /// With their places.
    knots: [Option<(Vec<f64>, Place)>; 2],
    points: Vec<DVec3>,
    weights: Vec<f64>,
    /// The length of the first row.
    columns: usize,
    loops: Vec<TrimLoop>,
}

impl Parser<'_> {
    /// One degree, or those along u and v.
    fn degrees(&mut self) -> PResult<[u32; 2]> {
        let place = self.place();
        let value = self.expression()?;
        let both = value.promoted(2);
        let mut degrees = [0; 2];
        for (degree, x) in degrees.iter_mut().zip(both.components()) {
            if value.len() > 2 || x.fract() != 0.0 || !(1.0..=9.0).contains(&x) {
                let message = "a degree is a whole number from 1 to 9, or two of them: `<u, v>`";
                return Err(self.fail(place, message));
            }
            *degree = x as u32;
        }
        Ok(degrees)
    }

    fn knots(&mut self) -> PResult<Vec<f64>> {
        self.braces(|p| {
            let mut knots = vec![];
            while p.peek()?.kind != Kind::RightBrace {
                p.count_parts(1)?;
                knots.push(p.float()?);
                p.comma()?;
            }
            Ok(knots)
        })
    }

    /// Control points up to the closing brace: `least` components, and perhaps a weight.
    fn weighted_points(&mut self, least: usize, mut add: impl FnMut([f64; 3], f64)) -> PResult<()> {
        while self.peek()?.kind != Kind::RightBrace {
            self.count_parts(1)?;
            let place = self.place();
            let mut value: Vector = self.expression()?;
            if value.len() == 1 {
                value = value.promoted(least);
            }
            let components = value.components();
            if !(least..=least + 1).contains(&value.len()) {
                let message = format!(
                    "a control point has {least} components here, or {} with a weight, found {}",
                    least + 1,
                    value.len()
                );
                return Err(self.fail(place, message));
            }
            let mut point = [0.0; 3];
            for (x, y) in point.iter_mut().take(least).zip(components) {
                *x = y;
            }
            let weight = if value.len() > least {
                components[least]
            } else {
                1.0
            };
            add(point, weight);
            self.comma()?;
        }
        Ok(())
    }

    fn row(&mut self, items: &mut Items) -> PResult<()> {
        let place = self.place();
        let before = items.points.len();
        self.braces(|p| {
            p.weighted_points(3, |[x, y, z], weight| {
                items.points.push(DVec3::new(x, y, z));
                items.weights.push(weight);
            })
        })?;
        let count = items.points.len() - before;
        if before == 0 {
            items.columns = count;
        }
        if count != items.columns || count == 0 {
            let message = format!(
                "this row has {count} control points, but the first has {}",
                items.columns
            );
            return Err(self.fail(place, message));
        }
        Ok(())
    }

    /// Corners of a polygon, or curves.
    fn trim_loop(&mut self, is_hole: bool) -> PResult<TrimLoop> {
        self.braces(|p| {
            let mut curves = vec![];
            loop {
                let token = p.peek()?;
                if p.own_word(token, &["curve"]).is_none() {
                    break;
                }
                p.take(token)?;
                curves.push(p.braces(Self::trim_curve)?);
                p.comma()?;
            }
            if !curves.is_empty() {
                return Ok(TrimLoop { curves, is_hole });
            }
            let place = p.place();
            let (mut corners, mut is_plain) = (vec![], true);
            p.weighted_points(2, |[u, v, _], weight| {
                corners.push(DVec2::new(u, v));
                is_plain &= weight == 1.0;
            })?;
            if !is_plain || corners.len() < 3 {
                let message = "a loop has `curve`s, or at least three corners without weights";
                return Err(p.fail(place, message));
            }
            Ok(TrimLoop::polygon(corners, is_hole))
        })
    }

    /// `[degree d] [knots { .. }] points`
    fn trim_curve(&mut self) -> PResult<NurbsCurve> {
        let (mut degree, mut knots) = (1, None);
        loop {
            let token = self.peek()?;
            let Some(item) = self.own_word(token, &CURVE) else {
                break;
            };
            self.take(token)?;
            if item == "degree" {
                let place = self.place();
                let [u, v] = self.degrees()?;
                if u != v {
                    return Err(self.fail(place, "a curve has one degree"));
                }
                degree = u;
            } else {
                knots = Some(self.knots()?);
            }
            self.comma()?;
        }
        let (mut points, mut weights) = (vec![], vec![]);
        self.weighted_points(2, |[u, v, _], weight| {
            points.push(DVec2::new(u, v));
            weights.push(weight);
        })?;
        let mut curve = NurbsCurve::new(degree, points);
        curve.weights = weights;
        if let Some(knots) = knots {
            curve.knots = knots;
        }
        Ok(curve)
    }
}
