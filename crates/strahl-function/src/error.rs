use thiserror::Error;

/// Why a function can't be built.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
pub enum FunctionError {
    /// The expression graph is larger than [`limits::NODES`](crate::limits::NODES).
    #[error(
        "the function has more than {limit} operations; split it or replace repeated parts by sum() or prod()"
    )]
    TooLarge {
        /// The most operations there may be.
        limit: usize,
    },
    /// One evaluation takes more operations than [`Graph::allow`](crate::Graph::allow)ed.
    #[error(
        "one evaluation of the function takes {} operations, at most {limit} are allowed; \
         give its sums and products fewer terms, or let its functions call each other less often",
        if *cost == u64::MAX { "endlessly many".to_owned() } else { cost.to_string() }
    )]
    TooCostly {
        /// The cost, as far as it is known beforehand.
        cost: u64,
        /// The most there may be.
        limit: u64,
    },
    /// Calls and loops are nested deeper than [`limits::DEPTH`](crate::limits::DEPTH).
    #[error("calls, sums and products are nested more than {limit} deep")]
    TooDeep {
        /// The deepest nesting there may be.
        limit: usize,
    },
    /// A function has more parameters than [`limits::PARAMETERS`](crate::limits::PARAMETERS).
    #[error("the function has {found} parameters, at most {limit} are allowed")]
    TooManyParameters {
        /// How many there are.
        found: usize,
        /// The most parameters there may be.
        limit: usize,
    },
    /// Two parameters of a function have one name.
    #[error("two parameters are called `{name}`; rename one")]
    DuplicateParameter {
        /// The name.
        name: String,
    },
    /// A name that is no parameter.
    #[error("`{name}` is not a parameter of the function, which has {}", parameters.join(", "))]
    UnknownParameter {
        /// The name.
        name: String,
        /// The parameters there are.
        parameters: Vec<String>,
    },
    /// A call with too many or too few arguments.
    #[error("{function} takes {expected} arguments, found {found}")]
    ArgumentCount {
        /// What is called.
        function: String,
        /// How many arguments it takes.
        expected: usize,
        /// How many were given.
        found: usize,
    },
    /// The variable of a sum or product is used outside of it.
    #[error("the variable of a sum or product is used outside of it")]
    UnboundVariable,
    /// An [`Expr`](crate::Expr) of one [`Graph`](crate::Graph) was given to another.
    #[error("an expression belongs to another graph; build all parts of a function with one graph")]
    ForeignExpression,
    /// There is no internal function of that name.
    #[error("there is no internal function `{name}`{}", suggestion.map(|s| format!("; did you mean `{s}`?")).unwrap_or_default())]
    UnknownInternal {
        /// The name.
        name: String,
        /// An internal function of a similar name.
        suggestion: Option<&'static str>,
    },
}
