//! `function { ... }`: parses tokens directly into the graph of a [`strahl_function::Function`].

use super::precedence;
use crate::grammar::Thing;
use crate::keywords::{Word, WordKind};
use crate::parser::{PResult, Parser, Place};
use crate::symbol::Symbol;
use crate::token::{Kind, Token};
use crate::value::Value;
use strahl_function::{BinaryOp, Expr, Function, FunctionError, Graph, UnaryOp, internal};

/// A function while its body is parsed.
struct Body {
    graph: Graph,
    parameters: Vec<(Symbol, String)>,
    /// The variables of the enclosing `sum` and `prod`, innermost last.
    loops: Vec<(Symbol, Expr)>,
}

/// The operation of a function with one argument.
const fn unary(word: Word) -> Option<UnaryOp> {
    Some(match word {
        Word::Abs => UnaryOp::Abs,
        Word::Acos => UnaryOp::Acos,
        Word::Acosh => UnaryOp::Acosh,
        Word::Asin => UnaryOp::Asin,
        Word::Asinh => UnaryOp::Asinh,
        Word::Atan => UnaryOp::Atan,
        Word::Atanh => UnaryOp::Atanh,
        Word::Ceil => UnaryOp::Ceil,
        Word::Cos => UnaryOp::Cos,
        Word::Cosh => UnaryOp::Cosh,
        Word::Exp => UnaryOp::Exp,
        Word::Floor => UnaryOp::Floor,
        Word::Int => UnaryOp::Trunc,
        Word::Ln => UnaryOp::Ln,
        Word::Log => UnaryOp::Log10,
        Word::Sin => UnaryOp::Sin,
        Word::Sinh => UnaryOp::Sinh,
        Word::Sqr => UnaryOp::Square,
        Word::Sqrt => UnaryOp::Sqrt,
        Word::Tan => UnaryOp::Tan,
        Word::Tanh => UnaryOp::Tanh,
        _ => return None,
    })
}

fn not_a_parameter(word: Word, body: &Body) -> String {
    let names: Vec<&str> = body.parameters.iter().map(|(_, t)| t.as_str()).collect();
    format!(
        "`{}` is not a parameter of this function, which has {}",
        word.text(),
        names.join(", ")
    )
}

impl Parser<'_> {
    /// The value after the keyword `function` in a declaration.
    pub(crate) fn function_value(&mut self) -> PResult<Value> {
        if self.peek()?.kind == Kind::LeftBrace {
            // What directives and macros yield decides too (measured).
            match self.peek_into_braces()?.word() {
                Some(Word::Internal) => return self.internal_by_number(),
                Some(Word::Pattern) => return self.pattern_function(),
                Some(Word::Pigment) => return self.pigment_function(),
                Some(Word::Spline) => return self.spline_function(),
                Some(Word::Transform) => return self.transform_function(),
                _ => {}
            }
        }
        self.function().map(Value::Function)
    }

    /// `{ internal(number) }`: the form in which POV-Ray's `functions.inc` names the internal functions.
    fn internal_by_number(&mut self) -> PResult<Value> {
        self.braces(|p| {
            p.next()?;
            p.expect(Kind::LeftParen)?;
            let number = p.full_float()?;
            let place = p.place();
            p.expect(Kind::RightParen)?;
            let name = (number >= 0.0).then(|| crate::include::internal_function(number as u32));
            match name.flatten().and_then(internal::find) {
                Some(known) => Ok(p.internal(known)),
                None => Err(p.fail(place, format!("there is no internal function {number}"))),
            }
        })
    }

    /// An internal function with its coordinates and parameters.
    fn internal(&mut self, known: &internal::Internal) -> Value {
        let coordinates = ["x", "y", "z"].map(str::to_owned);
        let parameters = (0..known.parameters).map(|i| format!("p{i}"));
        let names: Vec<String> = coordinates.into_iter().chain(parameters).collect();
        let mut graph = Graph::new(names.iter().cloned());
        let arguments: Vec<Expr> = names.iter().map(|name| graph.parameter(name)).collect();
        let root = graph.internal(known.name, &arguments, self.default_noise());
        match graph.finish(root) {
            Ok(function) => Value::Function(function),
            Err(_) => Value::Unsupported("an internal function that is not supported yet"),
        }
    }

    /// Whether a name has a value. The names of the internal functions need no declaration.
    pub(super) fn declare_internal(&mut self, symbol: Symbol) -> bool {
        if self.scopes.find(symbol).is_some() {
            return true;
        }
        let Some(known) = internal::find(self.symbols.text(symbol)) else {
            return false;
        };
        let value = self.internal(known);
        let target = self.global_target(symbol);
        self.scopes.store(&target, value)
    }

    /// `(parameters) { expression }` after `function`; the default parameters are x, y, z.
    ///
    /// # Errors
    /// If the expression is wrong or too large.
    pub(crate) fn function(&mut self) -> PResult<Function> {
        self.function_of(&[(Word::X, "x"), (Word::Y, "y"), (Word::Z, "z")])
    }

    /// The same with other default parameters.
    ///
    /// # Errors
    /// If the expression is wrong or too large.
    pub(crate) fn function_of(&mut self, usual: &[(Word, &str)]) -> PResult<Function> {
        let place = self.place();
        let mut parameters = vec![];
        if self.accept(Kind::LeftParen)? {
            while !self.accept(Kind::RightParen)? {
                let token = self.raw();
                let Some(symbol) = token.symbol() else {
                    return Err(self.unexpected(token, "the name of a parameter, or `)`"));
                };
                self.take(token)?;
                parameters.push((symbol, self.symbols.text(symbol).to_owned()));
                self.comma()?;
            }
        } else {
            let usual = usual.iter();
            parameters.extend(usual.map(|(word, text)| (Symbol(*word as u32), (*text).to_owned())));
        }
        let mut body = Body {
            graph: Graph::new(parameters.iter().map(|(_, text)| text.clone())),
            parameters,
            loops: vec![],
        };
        body.graph.allow(self.options.limits.function_cost);
        let root = self.braces(|p| p.formula(&mut body))?;
        self.finish_function(body.graph, root, place)
    }

    /// Compiles the parsed function.
    ///
    /// # Errors
    /// If it is wrong or too large.
    pub(super) fn finish_function(
        &mut self,
        graph: Graph,
        root: Expr,
        place: Place,
    ) -> PResult<Function> {
        self.count_function(place, graph.work())?;
        graph.finish(root).map_err(|error| match error {
            FunctionError::TooCostly { .. } => self.fail_hint(
                place,
                error.to_string(),
                "`--limit function_cost=N` raises the limit",
            ),
            _ => self.fail(place, error.to_string()),
        })
    }

    /// A whole expression, with `?:`.
    fn formula(&mut self, body: &mut Body) -> PResult<Expr> {
        let condition = self.formula_binary(body, 1)?;
        if !self.accept(Kind::Question)? {
            return Ok(condition);
        }
        let yes = self.nested(|p| p.formula(body))?;
        self.expect(Kind::Colon)?;
        let no = self.nested(|p| p.formula(body))?;
        Ok(body.graph.if_else(condition, yes, no))
    }

    fn formula_binary(&mut self, body: &mut Body, weakest: u8) -> PResult<Expr> {
        let mut left = self.formula_operand(body)?;
        loop {
            let token = self.peek()?;
            let binds = match token.kind {
                // In functions, unlike elsewhere, `&` has a higher precedence than `|`.
                Kind::Ampersand => 2,
                kind => precedence(kind),
            };
            if binds < weakest || binds == 0 {
                return Ok(left);
            }
            self.take(token)?;
            let right = self.formula_binary(body, binds + 1)?;
            let graph = &mut body.graph;
            left = match token.kind {
                Kind::Plus => graph.binary(BinaryOp::Add, left, right),
                Kind::Minus => graph.binary(BinaryOp::Sub, left, right),
                Kind::Star => graph.binary(BinaryOp::Mul, left, right),
                Kind::Slash => graph.binary(BinaryOp::Div, left, right),
                Kind::Ampersand => graph.binary(BinaryOp::And, left, right),
                Kind::Bar => graph.binary(BinaryOp::Or, left, right),
                Kind::Less => graph.binary(BinaryOp::Less, left, right),
                Kind::LessEqual => graph.binary(BinaryOp::LessEqual, left, right),
                Kind::Greater => graph.binary(BinaryOp::Less, right, left),
                Kind::GreaterEqual => graph.binary(BinaryOp::LessEqual, right, left),
                Kind::Equal => graph.binary(BinaryOp::Equal, left, right),
                _ => {
                    let equal = graph.binary(BinaryOp::Equal, left, right);
                    graph.unary(UnaryOp::Not, equal)
                }
            };
        }
    }

    fn formula_operand(&mut self, body: &mut Body) -> PResult<Expr> {
        let token = self.peek()?;
        match token.kind {
            Kind::Number => {
                self.take(token)?;
                Ok(body.graph.constant(token.number()))
            }
            Kind::Minus => {
                self.take(token)?;
                let operand = self.nested(|p| p.formula_operand(body))?;
                Ok(body.graph.unary(UnaryOp::Neg, operand))
            }
            Kind::Plus => {
                self.take(token)?;
                self.nested(|p| p.formula_operand(body))
            }
            Kind::Bang => {
                self.take(token)?;
                let operand = self.nested(|p| p.formula_operand(body))?;
                Ok(body.graph.unary(UnaryOp::Not, operand))
            }
            Kind::LeftParen => {
                self.take(token)?;
                let inner = self.nested(|p| p.formula(body))?;
                self.expect(Kind::RightParen)?;
                Ok(inner)
            }
            Kind::Name | Kind::Word => self.formula_name(body, token),
            _ => Err(self.unexpected(token, "a number, a parameter or a function")),
        }
    }

    fn formula_name(&mut self, body: &mut Body, token: Token) -> PResult<Expr> {
        let symbol = token.symbol();
        let variable = body.loops.iter().rev().find(|(s, _)| Some(*s) == symbol);
        if let Some((_, expr)) = variable {
            let expr = *expr;
            self.take(token)?;
            return Ok(expr);
        }
        let parameter = body.parameters.iter().find(|(s, _)| Some(*s) == symbol);
        if let Some((_, text)) = parameter {
            let expr = body.graph.parameter(text);
            self.take(token)?;
            return Ok(expr);
        }
        if let Some(word) = token.word() {
            return self.formula_word(body, token, word);
        }
        if let Some(symbol) = symbol {
            self.declare_internal(symbol);
        }
        let place = self.place_of(token);
        let callee = match symbol.and_then(|s| self.scopes.find(s)) {
            Some(Value::Array(_) | Value::Dictionary(_)) => Some(self.variable(token)?),
            Some(value) if value.is_callable() => {
                let value = value.clone();
                self.take(token)?;
                Some(value)
            }
            _ => None,
        };
        if let Some(callee) = callee {
            return self.formula_value(body, &callee, place);
        }
        // Any other name is a number, which is fixed when the function is declared.
        let number = self.name_in_expression(token)?;
        let place = self.place();
        let number = self.as_float(number, place)?;
        Ok(body.graph.constant(number))
    }

    /// A named value: a function with its arguments, or a number, which is fixed when the function is declared.
    fn formula_value(&mut self, body: &mut Body, value: &Value, place: Place) -> PResult<Expr> {
        match value {
            Value::Function(function) => {
                let arguments = self.nested(|p| p.formula_arguments(body))?;
                self.check_arguments(function.parameters().len(), arguments.len(), place)?;
                let value = body.graph.call(function, &arguments);
                match body.graph.failure().cloned() {
                    Some(error) => Err(self.fail(place, error.to_string())),
                    None => Ok(value),
                }
            }
            Value::Thing(Thing::PigmentFunction(pigment)) => {
                let arguments = self.nested(|p| p.formula_arguments(body))?;
                self.check_arguments(3, arguments.len(), place)?;
                let component = self.pigment_component(pigment)?;
                Ok(body.graph.field(&component, &arguments))
            }
            Value::Spline(_) | Value::Thing(Thing::TransformFunction(_)) => {
                let arguments = self.nested(|p| p.formula_arguments(body))?;
                self.vector_component(&mut body.graph, value, &arguments)
            }
            _ => match value.numeric() {
                Some(number) => {
                    let number = self.components_of(number)?;
                    let number = self.as_float(number, place)?;
                    Ok(body.graph.constant(number))
                }
                None => {
                    let message = format!(
                        "expected a number or a function, found {}",
                        value.describe()
                    );
                    Err(self.fail(place, message))
                }
            },
        }
    }

    /// A coordinate that is not a parameter by this name. In POV-Ray `u` is another name of `x`, and `v` of `y`; a coordinate that is no
    /// parameter is 0 (measured).
    fn coordinate(&mut self, body: &mut Body, token: Token, word: Word) -> Expr {
        let other = match word {
            Word::X => Some(Word::U),
            Word::Y => Some(Word::V),
            Word::U => Some(Word::X),
            Word::V => Some(Word::Y),
            _ => None,
        };
        let other = other.map(|word| Symbol(word as u32));
        let parameter = body.parameters.iter().find(|(s, _)| Some(*s) == other);
        if let Some((_, text)) = parameter {
            return body.graph.parameter(text);
        }
        let place = self.place_of(token);
        let hint = "it counts as 0, as in POV-Ray";
        self.warn_hint(place, not_a_parameter(word, body), hint);
        body.graph.constant(0.0)
    }

    fn formula_word(&mut self, body: &mut Body, token: Token, word: Word) -> PResult<Expr> {
        if let Some(operation) = unary(word) {
            self.take(token)?;
            let place = self.place();
            let arguments = self.nested(|p| p.formula_arguments(body))?;
            return match arguments.as_slice() {
                [argument] => Ok(body.graph.unary(operation, *argument)),
                other => Err(self.wrong_arguments(1, other.len(), place)),
            };
        }
        match word {
            Word::Sum | Word::Prod => {
                self.take(token)?;
                return self.nested(|p| p.formula_loop(body, word));
            }
            Word::X | Word::Y | Word::Z | Word::U | Word::V => {
                self.take(token)?;
                return Ok(self.coordinate(body, token, word));
            }
            Word::T => {
                let place = self.place_of(token);
                return Err(self.fail(place, not_a_parameter(word, body)));
            }
            _ => {}
        }
        match word.kind() {
            WordKind::Constant => {
                let value = self.word_in_expression(token)?;
                let place = self.place();
                let value = self.as_float(value, place)?;
                Ok(body.graph.constant(value))
            }
            WordKind::FloatFunction => {
                self.take(token)?;
                let place = self.place();
                let arguments = self.nested(|p| p.formula_arguments(body))?;
                self.formula_function(body, word, &arguments, place)
            }
            _ => Err(self.unexpected(token, "a number, a parameter or a function")),
        }
    }

    fn formula_function(
        &mut self,
        body: &mut Body,
        word: Word,
        arguments: &[Expr],
        place: Place,
    ) -> PResult<Expr> {
        let graph = &mut body.graph;
        let fold = |graph: &mut Graph, operation| {
            let folded = arguments.iter().copied();
            folded.reduce(|a, b| graph.binary(operation, a, b))
        };
        let value = match (word, arguments) {
            (Word::Min, [_, ..]) => fold(graph, BinaryOp::Min),
            (Word::Max, [_, ..]) => fold(graph, BinaryOp::Max),
            (Word::Mod, [a, b]) => Some(graph.binary(BinaryOp::Mod, *a, *b)),
            (Word::Pow, [a, b]) => Some(graph.binary(BinaryOp::Pow, *a, *b)),
            (Word::Atan2, [a, b]) => Some(graph.binary(BinaryOp::Atan2, *a, *b)),
            (Word::Div, [a, b]) => {
                let quotient = graph.binary(BinaryOp::Div, *a, *b);
                Some(graph.unary(UnaryOp::Trunc, quotient))
            }
            (Word::Degrees | Word::Radians, [a]) => {
                let factor = match word {
                    Word::Degrees => 180.0 / std::f64::consts::PI,
                    _ => std::f64::consts::PI / 180.0,
                };
                let factor = graph.constant(factor);
                Some(graph.binary(BinaryOp::Mul, *a, factor))
            }
            (Word::Select, [a, b, c]) => Some(graph.select_negative(*a, *b, *c)),
            (Word::Select, [a, b, c, d]) => Some(graph.select(*a, *b, *c, *d)),
            _ => None,
        };
        let count = arguments.len();
        match (value, word) {
            (Some(value), _) => Ok(value),
            (None, Word::Mod | Word::Pow | Word::Atan2 | Word::Div) => {
                Err(self.wrong_arguments(2, count, place))
            }
            (None, Word::Degrees | Word::Radians) => Err(self.wrong_arguments(1, count, place)),
            (None, _) => {
                let text = word.text();
                let message = format!("`{text}` with {count} arguments is not known in functions");
                Err(self.fail(place, message))
            }
        }
    }

    /// `(variable, from, to, expression)` after `sum` and `prod`.
    fn formula_loop(&mut self, body: &mut Body, word: Word) -> PResult<Expr> {
        self.expect(Kind::LeftParen)?;
        let token = self.raw();
        let Some(symbol) = token.symbol() else {
            return Err(self.unexpected(token, "the variable of the loop"));
        };
        self.take(token)?;
        self.comma()?;
        let from = self.formula(body)?;
        self.comma()?;
        let to = self.formula(body)?;
        self.comma()?;
        let variable = body.graph.loop_variable();
        body.loops.push((symbol, variable));
        let inner = self.formula(body);
        body.loops.pop();
        let inner = inner?;
        self.expect(Kind::RightParen)?;
        Ok(match word {
            Word::Sum => body.graph.sum(variable, from, to, inner),
            _ => body.graph.prod(variable, from, to, inner),
        })
    }

    fn formula_arguments(&mut self, body: &mut Body) -> PResult<Vec<Expr>> {
        self.expect(Kind::LeftParen)?;
        let mut arguments = vec![];
        while !self.accept(Kind::RightParen)? {
            arguments.push(self.formula(body)?);
            self.comma()?;
        }
        Ok(arguments)
    }

    /// A function call in an expression; the function's name is taken.
    pub(super) fn call_function(&mut self, function: &Function) -> PResult<f64> {
        let place = self.place();
        self.expect(Kind::LeftParen)?;
        let mut arguments = vec![];
        while !self.accept(Kind::RightParen)? {
            arguments.push(self.full_float()?);
            self.comma()?;
        }
        self.check_arguments(function.parameters().len(), arguments.len(), place)?;
        let before = self.workspace.spent();
        let value = function.value(&mut self.workspace, &arguments);
        let loops = self.workspace.spent().wrapping_sub(before);
        self.spend(function.cost().max(loops))?;
        Ok(value)
    }

    pub(super) fn check_arguments(
        &mut self,
        expected: usize,
        found: usize,
        place: Place,
    ) -> PResult<()> {
        if expected == found {
            return Ok(());
        }
        Err(self.wrong_arguments(expected, found, place))
    }

    fn wrong_arguments(
        &mut self,
        expected: usize,
        found: usize,
        place: Place,
    ) -> crate::parser::Failed {
        let plural = if expected == 1 { "" } else { "s" };
        let message = format!("this function takes {expected} argument{plural}, found {found}");
        self.fail(place, message)
    }
}
