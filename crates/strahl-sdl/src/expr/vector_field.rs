//! Functions made of splines and transformations: their values are vectors, whose components other functions can use.

use super::Spline;
use crate::grammar::Thing;
use crate::keywords::Word;
use crate::parser::{PResult, Parser};
use crate::token::Kind;
use crate::value::{Value, Vector};
use std::sync::Arc;
use strahl_function::{Expr, Graph, ScalarField};
use strahl_math::{DVec3, Transform};

/// A component of a spline as a function of its parameter.
#[derive(Debug)]
struct SplineComponent {
    spline: Arc<Spline>,
    index: usize,
}

impl ScalarField for SplineComponent {
    fn arity(&self) -> usize {
        1
    }

    fn value(&self, arguments: &[f64]) -> f64 {
        let t = arguments.first().copied().unwrap_or(0.0);
        let components = self.spline.at(t).components();
        components.get(self.index).copied().unwrap_or(0.0)
    }
}

/// A component of a transformed point as a function of the point.
#[derive(Debug)]
struct TransformComponent {
    map: Arc<Transform>,
    index: usize,
}

impl ScalarField for TransformComponent {
    fn value(&self, arguments: &[f64]) -> f64 {
        let [x, y, z] = arguments else {
            return 0.0;
        };
        let moved = self.map.point_to_world(DVec3::new(*x, *y, *z)).to_array();
        moved.get(self.index).copied().unwrap_or(0.0)
    }
}

/// The index of the component that a keyword names.
fn component(word: Option<Word>) -> Option<usize> {
    Some(match word? {
        Word::X | Word::U | Word::Red => 0,
        Word::Y | Word::V | Word::Green => 1,
        Word::Z | Word::Blue => 2,
        Word::T | Word::Filter => 3,
        Word::Transmit => 4,
        _ => return None,
    })
}

impl Parser<'_> {
    /// `{ spline { ... } }` after `function`: the spline itself, which can be called directly.
    pub(super) fn spline_function(&mut self) -> PResult<Value> {
        self.braces(|p| {
            p.next()?;
            p.spline()
        })
    }

    /// `{ transform { ... } }` after `function`: its value is the transformed point.
    pub(super) fn transform_function(&mut self) -> PResult<Value> {
        let map = self.braces(|p| {
            p.next()?;
            p.transform_block()
        })?;
        Ok(Value::Thing(Thing::TransformFunction(Arc::new(map))))
    }

    /// `(x, y, z)` after a function made of a transformation, in an expression.
    pub(super) fn call_transform(&mut self, map: &Transform) -> PResult<Vector> {
        let point = self.point_arguments()?;
        Ok(Vector::from(map.point_to_world(point)))
    }

    /// `.x` after a call of a function made of a spline or a transformation, within a function.
    ///
    /// # Errors
    /// If no component is taken.
    pub(super) fn vector_component(
        &mut self,
        graph: &mut Graph,
        callee: &Value,
        arguments: &[Expr],
    ) -> PResult<Expr> {
        let place = self.place();
        if !self.accept(Kind::Dot)? {
            return Err(self.fail_hint(
                place,
                "a function cannot use a whole vector",
                "use one of its components: `.x`, `.y`, `.z`, `.t`",
            ));
        }
        let name = self.next()?;
        let Some(index) = component(name.word()) else {
            return Err(self.unexpected(name, "a component of a vector"));
        };
        let (field, expected): (Arc<dyn ScalarField>, usize) = match callee {
            Value::Spline(spline) => {
                let spline = Arc::clone(spline);
                (Arc::new(SplineComponent { spline, index }), 1)
            }
            Value::Thing(Thing::TransformFunction(map)) => {
                let map = Arc::clone(map);
                (Arc::new(TransformComponent { map, index }), 3)
            }
            other => {
                let message = format!("{} cannot be called", other.describe());
                return Err(self.fail(place, message));
            }
        };
        self.check_arguments(expected, arguments.len(), place)?;
        Ok(graph.field(&field, arguments))
    }
}
