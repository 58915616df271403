//! Values of names and expressions.

use crate::expr::{Array, Dictionary, Spline};
use crate::grammar::Thing;
use crate::parser::Macro;
use std::sync::Arc;
use strahl_function::Function;

mod vector;

pub use vector::Vector;

/// The value of a name or an expression. Numbers and vectors are stored inline, everything larger is shared.
#[derive(Clone, Debug)]
pub enum Value {
    /// A number. Also what `seed` returns: the number of a random stream.
    Float(f64),
    /// Two to five components; a colour is a vector of five: red, green, blue, filter, transmit.
    Vector(Vector),
    /// A text.
    String(Arc<str>),
    /// An array of one or more dimensions.
    Array(Arc<Array>),
    /// Values by name (3.8).
    Dictionary(Arc<Dictionary>),
    /// A curve through points.
    Spline(Arc<Spline>),
    /// A function of numbers.
    Function(Function),
    /// A value that is parsed but not supported, with its description.
    Unsupported(&'static str),
    /// A macro; only names have such values.
    Macro(Arc<Macro>),
    /// A value defined by the grammar: an object, a texture, a transformation, ...
    Thing(Thing),
}

impl Value {
    /// Its kind in words, for messages.
    pub fn describe(&self) -> &'static str {
        match self {
            Self::Float(_) => "a float",
            Self::Vector(v) if v.len() == 5 => "a colour",
            Self::Vector(_) => "a vector",
            Self::String(_) => "a string",
            Self::Array(_) => "an array",
            Self::Dictionary(_) => "a dictionary",
            Self::Spline(_) => "a spline",
            Self::Function(_) => "a function",
            Self::Unsupported(what) => what,
            Self::Macro(_) => "a macro",
            Self::Thing(thing) => thing.describe(),
        }
    }

    /// Whether a `(` after the name calls it.
    pub(crate) fn is_callable(&self) -> bool {
        matches!(
            self,
            Self::Function(_)
                | Self::Spline(_)
                | Self::Thing(Thing::PigmentFunction(_) | Thing::TransformFunction(_))
        )
    }

    /// The value as a number or vector, if it is one.
    #[inline]
    pub fn numeric(&self) -> Option<Vector> {
        match self {
            Self::Float(x) => Some(Vector::float(*x)),
            Self::Vector(v) => Some(*v),
            _ => None,
        }
    }
}

impl From<Vector> for Value {
    fn from(v: Vector) -> Self {
        match v.as_float() {
            Some(x) => Self::Float(x),
            None => Self::Vector(v),
        }
    }
}
