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
use strahl_shade::functions::{Channel, PigmentChannel};
use strahl_shade::patterns::TexturePoint;
use strahl_shade::pigment::Pigment;

/// A pigment that is called like a function.
#[derive(Clone, Debug)]
pub struct PigmentFunction {
    pigment: Arc<Pigment>,
    /// The cost of the pigment, which may be large.
    cost: Cost,
}

impl Parser<'_> {
    /// `{ pattern { ... } }`
    pub(super) fn pattern_function(&mut self) -> PResult<Value> {
        let place = self.place();
        let field = self.braces(|p| {
            p.next()?;
            p.pattern_block()
        })?;
        let field: Arc<dyn ScalarField> = Arc::new(field);
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
        let channel = match name.word() {
            Some(Word::Red | Word::X | Word::U) => Channel::Red,
            Some(Word::Green | Word::Y | Word::V) => Channel::Green,
            Some(Word::Blue | Word::Z) => Channel::Blue,
            Some(Word::Filter | Word::T) => Channel::Filter,
            Some(Word::Transmit) => Channel::Transmit,
            Some(Word::Gray | Word::Grey) => Channel::Gray,
            // Not a keyword: it has this meaning only here.
            _ if name.symbol().is_some_and(|s| self.symbols.text(s) == "hf") => Channel::Height,
            _ => return Err(self.unexpected(name, "a component of a colour")),
        };
        Ok(Arc::new(PigmentChannel {
            pigment: Arc::clone(&function.pigment),
            channel,
        }))
    }
}
