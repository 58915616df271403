mod copies;
mod loops;

use crate::error::FunctionError;
use crate::field::ScalarField;
use crate::limits;
use crate::op::{BinaryOp, UnaryOp};
use crate::tape::Tape;
use std::collections::{HashMap, HashSet};
use std::hash::{BuildHasherDefault, Hasher};
use std::sync::Arc;

/// A value within a [`Graph`]: a handle, cheap to copy.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Expr(pub(crate) u32);

/// A list of arguments within a graph.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct List(u32);

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Node {
    /// The bits of a number.
    Constant(u64),
    /// A parameter of the function.
    Parameter(u32),
    /// The counter of a loop.
    Variable(u32),
    Unary(UnaryOp, Expr),
    Binary(BinaryOp, Expr, Expr),
    /// Selector, then the values for negative, zero, and everything else.
    Select(Expr, Expr, Expr, Expr),
    Field(u32, List),
    Call(u32, List),
    Loop(Loop),
}

/// `sum` or `prod` of `body` over `variable`, from, to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Loop {
    pub(crate) product: bool,
    pub(crate) variable: u32,
    pub(crate) from: Expr,
    pub(crate) to: Expr,
    pub(crate) body: Expr,
}

/// Builds a function as a graph of operations.
///
/// Equal subexpressions are stored once and operations on constants are folded; neither changes a bit of any value. The methods
/// never fail: the first error is stored and returned by [`finish`](Self::finish).
///
/// ```
/// use strahl_function::{Graph, Workspace};
///
/// let mut g = Graph::new(["x", "y", "z"]);
/// let [x, y, z] = g.xyz();
/// let r = g.length(&[x, y, z]);
/// let one = g.constant(1.0);
/// let sphere = g.sub(r, one);
/// let f = g.finish(sphere)?;
/// assert_eq!(f.value(&mut Workspace::new(), &[0.0, 3.0, 4.0]), 4.0);
/// # Ok::<(), strahl_function::FunctionError>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Graph {
    nodes: Vec<Node>,
    index: HashMap<Node, Expr>,
    parameters: Vec<String>,
    lists: Vec<Box<[Expr]>>,
    list_index: HashMap<Box<[Expr]>, List>,
    fields: Vec<Arc<dyn ScalarField>>,
    /// The numbers of the fields, by where they are.
    field_index: HashMap<usize, u32>,
    /// The tapes of the functions that are called.
    callees: Vec<Arc<Tape>>,
    callee_index: HashMap<usize, u32>,
    /// The loop variables a node depends on that no loop within it binds, ascending; absent for most.
    free: NodeMap<Box<[u32]>>,
    /// How deep loops and calls are nested in each node.
    depth: Vec<u32>,
    variables: u32,
    /// The number of nodes requested.
    work: u64,
    /// The limit of operations of an evaluation; `None` is the default.
    allowed: Option<u64>,
    failure: Option<FunctionError>,
}

/// Whether an operation is an even power from the second on.
fn is_even(op: UnaryOp) -> bool {
    matches!(op, UnaryOp::Power(n) if n >= 2 && n % 2 == 0)
}

impl Graph {
    /// An empty graph of a function with these parameters.
    pub fn new<S: Into<String>>(parameters: impl IntoIterator<Item = S>) -> Self {
        let mut graph = Self::default();
        for name in parameters {
            let name = name.into();
            if graph.parameters.contains(&name) {
                graph.fail(FunctionError::DuplicateParameter { name: name.clone() });
            }
            graph.parameters.push(name);
        }
        let found = graph.parameters.len();
        if found > limits::PARAMETERS {
            graph.fail(FunctionError::TooManyParameters {
                found,
                limit: limits::PARAMETERS,
            });
        }
        graph
    }

    /// The names of the parameters.
    pub fn parameters(&self) -> &[String] {
        &self.parameters
    }

    /// Makes [`finish`](Self::finish) return `error`, unless there is an earlier one.
    pub fn fail(&mut self, error: FunctionError) -> Expr {
        self.failure.get_or_insert(error);
        self.push(Node::Constant(f64::NAN.to_bits()))
    }

    /// The first error so far.
    pub fn failure(&self) -> Option<&FunctionError> {
        self.failure.as_ref()
    }

    /// Sets how many operations an evaluation may take, instead of [`limits::COST`].
    pub fn allow(&mut self, operations: u64) {
        self.allowed = Some(operations);
    }

    pub(crate) fn allowed(&self) -> u64 {
        self.allowed.unwrap_or(limits::COST)
    }

    /// Whether another graph has the same nodes in the same order, so that all evaluations do the same.
    pub(crate) fn is_same(&self, other: &Self) -> bool {
        let mut fields = self.fields.iter().zip(&other.fields);
        let mut callees = self.callees.iter().zip(&other.callees);
        self.nodes == other.nodes
            && self.lists == other.lists
            && self.parameters == other.parameters
            && self.allowed() == other.allowed()
            && self.callees.len() == other.callees.len()
            && self.fields.len() == other.fields.len()
            && fields.all(|(a, b)| Arc::ptr_eq(a, b))
            && callees.all(|(a, b)| Arc::ptr_eq(a, b))
    }

    /// The number of operations that building took so far, including those for nodes that already existed.
    pub fn work(&self) -> u64 {
        self.work
    }

    /// Frees the memory that is only needed for further building.
    pub(crate) fn seal(&mut self) {
        self.index = HashMap::new();
        self.list_index = HashMap::new();
        self.field_index = HashMap::new();
        self.callee_index = HashMap::new();
        self.free = NodeMap::default();
        self.depth = Vec::new();
        self.nodes.shrink_to_fit();
    }

    /// The first error, or that the expression belongs to another graph.
    pub(crate) fn check(&self, root: Expr) -> Result<(), FunctionError> {
        match &self.failure {
            Some(error) => Err(error.clone()),
            None if root.0 as usize >= self.nodes.len() => Err(FunctionError::ForeignExpression),
            None => Ok(()),
        }
    }

    // Leaves

    /// A number.
    pub fn constant(&mut self, value: f64) -> Expr {
        self.push(Node::Constant(value.to_bits()))
    }

    /// The parameter of that name. `u` and `x` name the same parameter, so do `v` and `y` (as in POV-Ray).
    pub fn parameter(&mut self, name: &str) -> Expr {
        let find = |name: &str| self.parameters.iter().position(|p| p == name);
        let alias = match name {
            "u" => "x",
            "x" => "u",
            "v" => "y",
            "y" => "v",
            other => other,
        };
        match find(name).or_else(|| find(alias)) {
            // At most limits::PARAMETERS, or the graph has failed already.
            Some(i) => self.push(Node::Parameter(i as u32)),
            None => {
                let error = FunctionError::UnknownParameter {
                    name: name.to_owned(),
                    parameters: self.parameters.clone(),
                };
                self.fail(error)
            }
        }
    }

    /// The parameters `x`, `y` and `z`.
    pub fn xyz(&mut self) -> [Expr; 3] {
        [
            self.parameter("x"),
            self.parameter("y"),
            self.parameter("z"),
        ]
    }

    /// The value of an expression, if it is constant.
    pub fn known(&self, e: Expr) -> Option<f64> {
        match self.nodes.get(e.0 as usize)? {
            Node::Constant(bits) => Some(f64::from_bits(*bits)),
            _ => None,
        }
    }

    // Operations

    /// An operation on one value.
    pub fn unary(&mut self, op: UnaryOp, a: Expr) -> Expr {
        if let Some(value) = self.known(a) {
            return self.constant(op.value(value));
        }
        match (op, self.nodes.get(a.0 as usize).copied()) {
            (UnaryOp::Neg, Some(Node::Unary(UnaryOp::Neg, inner))) => inner,
            (UnaryOp::Abs, Some(Node::Unary(UnaryOp::Neg | UnaryOp::Abs, inner))) => {
                self.unary(UnaryOp::Abs, inner)
            }
            (UnaryOp::Square, Some(Node::Unary(UnaryOp::Neg | UnaryOp::Abs, inner))) => {
                self.unary(UnaryOp::Square, inner)
            }
            (UnaryOp::Power(_), Some(Node::Unary(UnaryOp::Neg | UnaryOp::Abs, inner)))
                if is_even(op) =>
            {
                self.unary(op, inner)
            }
            (UnaryOp::Power(0), _) => self.constant(1.0),
            (UnaryOp::Power(1), _) => a,
            (UnaryOp::Power(2), _) => self.unary(UnaryOp::Square, a),
            _ => self.push(Node::Unary(op, a)),
        }
    }

    /// An operation on two values.
    pub fn binary(&mut self, op: BinaryOp, a: Expr, b: Expr) -> Expr {
        let (left, right) = (self.known(a), self.known(b));
        if let (Some(a), Some(b)) = (left, right) {
            return self.constant(op.value(a, b));
        }
        // Only rewrites that keep every bit, signs of zeros and infinities included; but for roots.
        let is =
            |known: Option<f64>, value: f64| known.is_some_and(|k| k.to_bits() == value.to_bits());
        match op {
            BinaryOp::Mul if is(right, 1.0) => return a,
            BinaryOp::Mul if is(left, 1.0) => return b,
            BinaryOp::Mul if is(right, -1.0) => return self.unary(UnaryOp::Neg, a),
            BinaryOp::Mul if is(left, -1.0) => return self.unary(UnaryOp::Neg, b),
            BinaryOp::Mul if a == b => return self.unary(UnaryOp::Square, a),
            BinaryOp::Div if is(right, 1.0) => return a,
            BinaryOp::Div => {
                // The reciprocal of a power of two is exact.
                if let Some(d) = right
                    && d.is_normal()
                    && d.to_bits().trailing_zeros() >= 52
                    && (1.0 / d).is_normal()
                {
                    let factor = self.constant(1.0 / d);
                    return self.binary(BinaryOp::Mul, a, factor);
                }
            }
            BinaryOp::Add if is(right, -0.0) => return a,
            BinaryOp::Add if is(left, -0.0) => return b,
            BinaryOp::Sub if is(right, 0.0) => return a,
            BinaryOp::Min | BinaryOp::Max if a == b => return a,
            BinaryOp::Pow => {
                if let Some(n) = right
                    && (0.0..=64.0).contains(&n)
                    && n == n.trunc()
                {
                    return self.unary(UnaryOp::Power(n as u8), a);
                }
                // The root takes a tenth of the work and is rounded better. The power is 0 instead of -0 for -0, and infinite instead of NaN
                // for minus infinity.
                if is(right, 0.5) {
                    return self.unary(UnaryOp::Sqrt, a);
                }
                if is(right, 0.25) {
                    let root = self.unary(UnaryOp::Sqrt, a);
                    return self.unary(UnaryOp::Sqrt, root);
                }
            }
            _ => {}
        }
        let (a, b) = if op.is_commutative() && b.0 < a.0 {
            (b, a)
        } else {
            (a, b)
        };
        self.push(Node::Binary(op, a, b))
    }

    /// `negative`, `zero` or `positive` by the sign of `selector`; NaN counts as positive, as in POV-Ray.
    pub fn select(&mut self, selector: Expr, negative: Expr, zero: Expr, positive: Expr) -> Expr {
        if negative == zero && zero == positive {
            return negative;
        }
        match self.known(selector) {
            Some(s) if s < 0.0 => negative,
            Some(0.0) => zero,
            Some(_) => positive,
            None => self.push(Node::Select(selector, negative, zero, positive)),
        }
    }

    /// POV-Ray's `select` with three arguments: `negative` if `selector < 0`, else `otherwise`.
    pub fn select_negative(&mut self, selector: Expr, negative: Expr, otherwise: Expr) -> Expr {
        self.select(selector, negative, otherwise, otherwise)
    }

    /// `condition ? then : otherwise`; everything but zero is true.
    pub fn if_else(&mut self, condition: Expr, then: Expr, otherwise: Expr) -> Expr {
        self.select(condition, then, otherwise, then)
    }

    /// The value of a field (a pattern, a spline, ...) at the arguments.
    pub fn field(&mut self, field: &Arc<dyn ScalarField>, arguments: &[Expr]) -> Expr {
        let expected = field.arity();
        if expected != arguments.len() || expected > limits::PARAMETERS {
            let found = arguments.len();
            return self.fail(FunctionError::ArgumentCount {
                function: format!("{field:?}"),
                expected: expected.min(limits::PARAMETERS),
                found,
            });
        }
        let place = Arc::as_ptr(field).cast::<()>() as usize;
        let id = *self.field_index.entry(place).or_insert_with(|| {
            self.fields.push(Arc::clone(field));
            self.fields.len() as u32 - 1
        });
        let list = self.list(arguments);
        self.push(Node::Field(id, list))
    }

    /// A call of another function, given by its tape.
    pub(crate) fn call_tape(&mut self, callee: &Arc<Tape>, arguments: &[Expr]) -> Expr {
        let place = Arc::as_ptr(callee) as usize;
        let id = *self.callee_index.entry(place).or_insert_with(|| {
            self.callees.push(Arc::clone(callee));
            self.callees.len() as u32 - 1
        });
        let list = self.list(arguments);
        self.push(Node::Call(id, list))
    }

    // Structure

    /// Adds a node, or finds an equal one.
    fn push(&mut self, node: Node) -> Expr {
        self.work += 1;
        if self.work > limits::WORK {
            self.failure.get_or_insert(FunctionError::TooLarge {
                limit: limits::NODES,
            });
            return Expr(0);
        }
        if let Some(&e) = self.index.get(&node) {
            return e;
        }
        if self
            .children(node)
            .iter()
            .any(|c| c.0 as usize >= self.nodes.len())
        {
            return self.fail(FunctionError::ForeignExpression);
        }
        if self.nodes.len() >= limits::NODES {
            self.failure.get_or_insert(FunctionError::TooLarge {
                limit: limits::NODES,
            });
            return Expr(0);
        }
        let depth = self.nesting(node);
        if depth as usize > limits::DEPTH {
            return self.fail(FunctionError::TooDeep {
                limit: limits::DEPTH,
            });
        }
        let e = Expr(self.nodes.len() as u32);
        let free = self.free_variables(node);
        if !free.is_empty() {
            self.free.insert(e, free.into_boxed_slice());
        }
        self.depth.push(depth);
        self.nodes.push(node);
        self.index.insert(node, e);
        e
    }

    fn list(&mut self, arguments: &[Expr]) -> List {
        if let Some(&list) = self.list_index.get(arguments) {
            return list;
        }
        let list = List(self.lists.len() as u32);
        self.lists.push(arguments.into());
        self.list_index.insert(arguments.into(), list);
        list
    }

    fn nesting(&self, node: Node) -> u32 {
        let inner = self
            .children(node)
            .iter()
            .filter_map(|c| self.depth.get(c.0 as usize))
            .max()
            .copied()
            .unwrap_or(0);
        match node {
            Node::Loop(_) => inner + 1,
            Node::Call(id, _) => {
                let callee = self.callee_at(id).map_or(0, |callee| callee.depth);
                inner.max(callee + 1)
            }
            Node::Field(id, _) => {
                let field = self.field_at(id).map_or(0, |field| field.cost().depth);
                inner.max(field)
            }
            _ => inner,
        }
    }

    /// How deep loops and calls are nested in an expression.
    pub(crate) fn depth(&self, e: Expr) -> u32 {
        self.depth.get(e.0 as usize).copied().unwrap_or(0)
    }

    fn free_variables(&self, node: Node) -> Vec<u32> {
        let mut free: Vec<u32> = match node {
            Node::Variable(v) => vec![v],
            _ => Vec::new(),
        };
        for child in self.children(node) {
            if let Some(inner) = self.free.get(&child) {
                let bound =
                    |v: u32| matches!(node, Node::Loop(l) if l.body == child && l.variable == v);
                free.extend(inner.iter().copied().filter(|&v| !bound(v)));
            }
        }
        free.sort_unstable();
        free.dedup();
        free
    }

    /// Whether `e` changes with a loop variable.
    pub(crate) fn depends_on(&self, e: Expr, variable: u32) -> bool {
        self.free
            .get(&e)
            .is_some_and(|free| free.binary_search(&variable).is_ok())
    }

    /// The node of a loop variable, if anything uses it.
    pub(crate) fn find_variable(&self, variable: u32) -> Option<Expr> {
        self.index.get(&Node::Variable(variable)).copied()
    }

    pub(crate) fn node(&self, e: Expr) -> Node {
        self.nodes
            .get(e.0 as usize)
            .copied()
            .unwrap_or(Node::Constant(f64::NAN.to_bits()))
    }

    pub(crate) fn arguments(&self, list: List) -> &[Expr] {
        self.lists.get(list.0 as usize).map_or(&[], |l| l)
    }

    pub(crate) fn field_at(&self, id: u32) -> Option<&Arc<dyn ScalarField>> {
        self.fields.get(id as usize)
    }

    pub(crate) fn callee_at(&self, id: u32) -> Option<&Arc<Tape>> {
        self.callees.get(id as usize)
    }

    pub(crate) fn children(&self, node: Node) -> Vec<Expr> {
        match node {
            Node::Constant(_) | Node::Parameter(_) | Node::Variable(_) => Vec::new(),
            Node::Unary(_, a) => vec![a],
            Node::Binary(_, a, b) => vec![a, b],
            Node::Select(s, n, z, p) => vec![s, n, z, p],
            Node::Field(_, list) | Node::Call(_, list) => self.arguments(list).to_vec(),
            Node::Loop(l) => vec![l.from, l.to, l.body],
        }
    }

    /// All nodes an expression needs, operands first. Nodes are only ever made after their operands, so that is by number.
    pub(crate) fn reachable(&self, root: Expr) -> Vec<Expr> {
        // Not an array of marks for all nodes, because the query may be small in a large graph, and frequent.
        let mut seen = NodeSet::default();
        let mut stack = vec![root];
        let mut found = Vec::new();
        while let Some(e) = stack.pop() {
            if !seen.insert(e) {
                continue;
            }
            found.push(e);
            stack.extend(self.children(self.node(e)));
        }
        found.sort_unstable_by_key(|e| e.0);
        found
    }
}

/// The hash of a node's number. Nodes are numbered one after the other, so hardly any hashes are alike.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct NodeHasher(u64);

impl Hasher for NodeHasher {
    fn finish(&self) -> u64 {
        self.0
    }

    fn write(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.write_u32(u32::from(byte));
        }
    }

    fn write_u32(&mut self, number: u32) {
        self.0 = (self.0 ^ u64::from(number)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    }
}

/// What is known of nodes.
pub(crate) type NodeMap<T> = HashMap<Expr, T, BuildHasherDefault<NodeHasher>>;
/// A set of nodes.
type NodeSet = HashSet<Expr, BuildHasherDefault<NodeHasher>>;
