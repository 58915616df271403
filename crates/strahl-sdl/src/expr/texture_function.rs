//! Functions made of textures: `function { pattern { ... } }` and `function { pigment { ... } }`.

use crate::grammar::Thing;
use crate::keywords::Word;
use crate::parser::{PResult, Parser};
use crate::token::Kind;
use crate::value::{Value, Vector};
use std::sync::Arc;
use strahl_function::{Graph, ScalarField};
use strahl_math::DVec3;
use strahl_shade::ColorFt;
use strahl_shade::patterns::{PatternField, TexturePoint};
use strahl_shade::pigment::Pigment;

/// A pattern's value as a function of space.
#[derive(Debug)]
struct PatternValue(PatternField);

impl ScalarField for PatternValue {
    fn value(&self, arguments: &[f64]) -> f64 {
        self.0.value(&point(arguments))
    }
}

/// One component of a pigment's colour as a function of space.
#[derive(Debug)]
struct PigmentComponent {
    pigment: Arc<Pigment>,
    component: Component,
}

/// What functions take of a colour.
#[derive(Clone, Copy, Debug)]
enum Component {
    Red,
    Green,
    Blue,
    Filter,
    Transmit,
    Gray,
}

impl ScalarField for PigmentComponent {
    fn value(&self, arguments: &[f64]) -> f64 {
        let color = self.pigment.color_at(&point(arguments));
        match self.component {
            Component::Red => color.rgb.r,
            Component::Green => color.rgb.g,
            Component::Blue => color.rgb.b,
            Component::Filter => color.filter,
            Component::Transmit => color.transmit,
            Component::Gray => color.gray(),
        }
    }
}

fn point(arguments: &[f64]) -> TexturePoint {
    let at = |i: usize| arguments.get(i).copied().unwrap_or(f64::NAN);
    TexturePoint::in_space(DVec3::new(at(0), at(1), at(2)))
}

impl Parser<'_> {
    /// `{ pattern { ... } }`
    pub(super) fn pattern_function(&mut self) -> PResult<Value> {
        let place = self.place();
        let field = self.braces(|p| {
            p.next()?;
            p.pattern_block()
        })?;
        let field: Arc<dyn ScalarField> = Arc::new(PatternValue(field));
        let mut graph = Graph::new(["x", "y", "z"]);
        let arguments = graph.xyz();
        let root = graph.field(&field, &arguments);
        match graph.finish(root) {
            Ok(function) => Ok(Value::Function(function)),
            Err(error) => Err(self.fail(place, error.to_string())),
        }
    }

    /// `{ pigment { ... } }`: its value is a colour.
    pub(super) fn pigment_function(&mut self) -> PResult<Value> {
        let pigment = self.braces(|p| {
            p.next()?;
            p.pigment_block()
        })?;
        Ok(Value::Thing(Thing::PigmentFunction(Arc::new(pigment))))
    }

    /// `(x, y, z)` behind a function made of a pigment, in an expression.
    pub(super) fn call_pigment(&mut self, pigment: &Pigment) -> PResult<Vector> {
        let p = self.point_arguments()?;
        let ColorFt {
            rgb,
            filter,
            transmit,
        } = pigment.color_at(&TexturePoint::in_space(p));
        Ok(Vector::rgbft([rgb.r, rgb.g, rgb.b, filter, transmit]))
    }

    /// `(x, y, z)`
    pub(super) fn point_arguments(&mut self) -> PResult<DVec3> {
        self.expect(Kind::LeftParen)?;
        let x = self.full_float()?;
        self.comma()?;
        let y = self.full_float()?;
        self.comma()?;
        let z = self.full_float()?;
        self.expect(Kind::RightParen)?;
        Ok(DVec3::new(x, y, z))
    }

    /// `.red` behind a call of a function made of a pigment, within a function.
    pub(super) fn pigment_component(
        &mut self,
        pigment: &Arc<Pigment>,
    ) -> PResult<Arc<dyn ScalarField>> {
        let place = self.place();
        if !self.accept(Kind::Dot)? {
            return Err(self.fail_hint(
                place,
                "within a function a colour cannot stand as a whole",
                "take one of its components: `.red`, `.green`, `.blue`, `.filter`, `.transmit`, `.gray`",
            ));
        }
        let name = self.next()?;
        let component = match name.word() {
            Some(Word::Red | Word::X | Word::U) => Component::Red,
            Some(Word::Green | Word::Y | Word::V) => Component::Green,
            Some(Word::Blue | Word::Z) => Component::Blue,
            Some(Word::Filter | Word::T) => Component::Filter,
            Some(Word::Transmit) => Component::Transmit,
            Some(Word::Gray | Word::Grey) => Component::Gray,
            _ => return Err(self.unexpected(name, "a component of a colour")),
        };
        Ok(Arc::new(PigmentComponent {
            pigment: Arc::clone(pigment),
            component,
        }))
    }
}
