//! Functions made of textures: `function { pattern { ... } }` and `function { pigment { ... } }`.

use crate::grammar::Thing;
use crate::keywords::Word;
use crate::parser::{PResult, Parser};
use crate::token::Kind;
use crate::value::{Value, Vector};
use std::sync::Arc;
use strahl_function::{Cost, Graph, ScalarField};
use strahl_math::DVec3;
use strahl_shade::ColorFt;
use strahl_shade::patterns::{PatternField, TexturePoint};
use strahl_shade::pigment::Pigment;

/// A pigment that is called like a function.
#[derive(Clone, Debug)]
pub struct PigmentFunction {
    pigment: Arc<Pigment>,
    /// The cost of the pigment, which may be large.
    cost: Cost,
}

/// A pattern's value as a function of space.
#[derive(Debug)]
struct PatternValue(PatternField);

impl ScalarField for PatternValue {
    fn value(&self, arguments: &[f64]) -> f64 {
        self.0.value(&point(arguments))
    }

    fn cost(&self) -> Cost {
        self.0.cost()
    }
}

/// One component of a pigment's colour as a function of space.
#[derive(Debug)]
struct PigmentComponent {
    function: PigmentFunction,
    component: Component,
}

/// The component of a colour that a function uses.
#[derive(Clone, Copy, Debug)]
enum Component {
    Red,
    Green,
    Blue,
    Filter,
    Transmit,
    Gray,
    /// Red and green as the two bytes of a height, as height fields read them.
    Height,
}

impl ScalarField for PigmentComponent {
    fn value(&self, arguments: &[f64]) -> f64 {
        let color = self.function.pigment.color_at(&point(arguments));
        match self.component {
            Component::Red => color.rgb.r,
            Component::Green => color.rgb.g,
            Component::Blue => color.rgb.b,
            Component::Filter => color.filter,
            Component::Transmit => color.transmit,
            Component::Gray => color.gray(),
            Component::Height => (256.0 * color.rgb.r + color.rgb.g) / 257.0,
        }
    }

    fn cost(&self) -> Cost {
        self.function.cost
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
        graph.allow(self.options.limits.function_cost);
        let function = self.finish_function(graph, root, place)?;
        Ok(Value::Function(function))
    }

    /// `{ pigment { ... } }`: its value is a colour.
    pub(super) fn pigment_function(&mut self) -> PResult<Value> {
        let pigment = self.braces(|p| {
            p.next()?;
            p.free_pigment_block()
        })?;
        let function = PigmentFunction {
            cost: pigment.cost(),
            pigment: Arc::new(pigment),
        };
        Ok(Value::Thing(Thing::PigmentFunction(Arc::new(function))))
    }

    /// `(x, y, z)` after a function made of a pigment, in an expression.
    pub(super) fn call_pigment(&mut self, function: &PigmentFunction) -> PResult<Vector> {
        let p = self.point_arguments()?;
        self.spend(function.cost.operations)?;
        let ColorFt {
            rgb,
            filter,
            transmit,
        } = function.pigment.color_at(&TexturePoint::in_space(p));
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

    /// `.red` after a call of a function made of a pigment, within a function.
    pub(super) fn pigment_component(
        &mut self,
        function: &PigmentFunction,
    ) -> PResult<Arc<dyn ScalarField>> {
        let place = self.place();
        if !self.accept(Kind::Dot)? {
            return Err(self.fail_hint(
                place,
                "a function cannot use a whole colour",
                "use one of its components: `.red`, `.green`, `.blue`, `.filter`, `.transmit`, `.gray`, `.hf`",
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
            // Not a keyword: it has this meaning only here.
            _ if name.symbol().is_some_and(|s| self.symbols.text(s) == "hf") => Component::Height,
            _ => return Err(self.unexpected(name, "a component of a colour")),
        };
        Ok(Arc::new(PigmentComponent {
            function: function.clone(),
            component,
        }))
    }
}
