//! From the graph to its tape: the order of the instructions, and their registers.

use crate::error::FunctionError;
use crate::graph::{Expr, Graph, Loop, Node, NodeMap};
use crate::tape::{FRAME, FieldCode, Instruction, LoopCode, Op, Tape};
use std::sync::Arc;

/// How many rounds a loop from one number to another has; endlessly many are as many as can be counted.
fn rounds(from: f64, to: f64) -> u64 {
    // The cast saturates; NaN and negative numbers have no rounds.
    if from <= to {
        ((to - from) as u64).saturating_add(1)
    } else {
        0
    }
}

/// What a loop's body needs from outside of it.
type Captures = NodeMap<Vec<Expr>>;

/// Compiles the whole function.
pub(crate) fn compile(graph: &Graph, root: Expr) -> Result<Tape, FunctionError> {
    let mut captures = Captures::default();
    // A loop comes after those within it, so what the inner ones need is known.
    for e in graph.reachable(root) {
        if let Node::Loop(l) = graph.node(e) {
            let outside = frame(graph, l.body, Some(l.variable), &captures).captured;
            captures.insert(e, outside);
        }
    }
    let mut inputs = NodeMap::default();
    for e in graph.reachable(root) {
        if let Node::Parameter(i) = graph.node(e) {
            inputs.insert(e, i);
        }
    }
    assemble(
        graph,
        root,
        None,
        inputs,
        graph.parameters().len(),
        &captures,
    )
}

/// The nodes of one tape.
struct Frame {
    /// Operands first; without the inputs.
    nodes: Vec<Expr>,
    /// What is computed outside of it.
    captured: Vec<Expr>,
}

/// What a tape needs to know: the operands of a node within its frame.
fn operands(graph: &Graph, e: Expr, captures: &Captures) -> Vec<Expr> {
    match graph.node(e) {
        Node::Loop(l) => {
            let mut list = vec![l.from, l.to];
            list.extend(captures.get(&e).into_iter().flatten());
            list
        }
        node => graph.children(node),
    }
}

/// The nodes that belong to the frame of a loop over `variable` (or of the function): those that change with the variable.
fn frame(graph: &Graph, root: Expr, variable: Option<u32>, captures: &Captures) -> Frame {
    let mut result = Frame {
        nodes: Vec::new(),
        captured: Vec::new(),
    };
    let mut seen: NodeMap<()> = NodeMap::default();
    let mut stack = vec![root];
    while let Some(e) = stack.pop() {
        if seen.insert(e, ()).is_some() {
            continue;
        }
        let constant = matches!(graph.node(e), Node::Constant(_));
        if variable.is_some_and(|v| !constant && !graph.depends_on(e, v)) {
            result.captured.push(e);
        } else {
            result.nodes.push(e);
            stack.extend(operands(graph, e, captures));
        }
    }
    result.nodes.sort_unstable_by_key(|e| e.0);
    result.captured.sort_unstable_by_key(|e| e.0);
    result
}

fn assemble(
    graph: &Graph,
    root: Expr,
    variable: Option<u32>,
    mut register: NodeMap<u32>,
    inputs: usize,
    captures: &Captures,
) -> Result<Tape, FunctionError> {
    let nodes: Vec<Expr> = frame(graph, root, variable, captures)
        .nodes
        .into_iter()
        .filter(|e| !register.contains_key(e))
        .collect();
    let mut tape = Tape {
        inputs,
        ..Tape::default()
    };
    for &e in &nodes {
        if let Node::Constant(bits) = graph.node(e) {
            register.insert(e, (inputs + tape.constants.len()) as u32);
            tape.constants.push(f64::from_bits(bits));
        }
    }
    let fixed = inputs + tape.constants.len();
    // The instruction after which a value is not needed any more.
    let mut last_use: NodeMap<usize> = NodeMap::default();
    for (i, &e) in nodes.iter().enumerate() {
        for operand in operands(graph, e, captures) {
            last_use.insert(operand, i);
        }
    }
    last_use.insert(root, nodes.len());

    let mut free: Vec<u32> = Vec::new();
    let mut used = fixed as u32;
    let mut nested = 0;
    for (i, &e) in nodes.iter().enumerate() {
        let node = graph.node(e);
        if matches!(node, Node::Constant(_)) {
            continue;
        }
        let at = |e: Expr| {
            register
                .get(&e)
                .copied()
                .ok_or(FunctionError::ForeignExpression)
        };
        let many = |list: &[Expr]| list.iter().map(|&a| at(a)).collect::<Result<Vec<u32>, _>>();
        let (op, a, b) = match node {
            // Inputs have registers already: what is left is used outside of its loop.
            Node::Constant(_) | Node::Parameter(_) | Node::Variable(_) => {
                return Err(FunctionError::UnboundVariable);
            }
            Node::Unary(op, a) => (op.into(), at(a)?, 0),
            Node::Binary(op, a, b) => (op.into(), at(a)?, at(b)?),
            Node::Select(s, n, z, p) => {
                tape.selects.push([at(n)?, at(z)?, at(p)?]);
                (Op::Select, at(s)?, tape.selects.len() as u32 - 1)
            }
            Node::Field(id, list) => {
                let field = graph.field_at(id).ok_or(FunctionError::ForeignExpression)?;
                let arguments = many(graph.arguments(list))?;
                nested = nested.max(arguments.len());
                tape.count(field.cost().operations, 0);
                tape.fields
                    .push(FieldCode::new(Arc::clone(field), arguments));
                (Op::Field, 0, tape.fields.len() as u32 - 1)
            }
            Node::Call(id, list) => {
                let callee = graph
                    .callee_at(id)
                    .ok_or(FunctionError::ForeignExpression)?;
                nested = nested.max(callee.stack);
                tape.count(callee.straight.saturating_add(callee.entry()), 0);
                tape.count(0, callee.cost - callee.straight);
                tape.has_loops |= callee.has_loops;
                tape.is_open |= callee.is_open;
                tape.calls
                    .push((Arc::clone(callee), many(graph.arguments(list))?));
                (Op::Call, 0, tape.calls.len() as u32 - 1)
            }
            Node::Loop(l) => {
                let outside = captures.get(&e).map_or(&[][..], |c| c);
                let body = assemble_body(graph, l, outside, captures)?;
                nested = nested.max(body.stack);
                let known = graph.known(l.from).zip(graph.known(l.to));
                let price = body.straight.saturating_add(1);
                let all = known.map_or(0, |(from, to)| rounds(from, to));
                tape.count(
                    body.entry(),
                    all.saturating_mul(body.cost.saturating_add(1)),
                );
                tape.has_loops = true;
                tape.is_open |= known.is_none() || body.is_open;
                tape.loops.push(LoopCode {
                    price,
                    product: l.product,
                    from: at(l.from)?,
                    to: at(l.to)?,
                    captures: many(outside)?,
                    body,
                });
                (Op::Loop, 0, tape.loops.len() as u32 - 1)
            }
        };
        // Operands are read before the result is written, so their registers can be used again at once.
        let mut operands = operands(graph, e, captures);
        operands.sort_unstable_by_key(|e| e.0);
        operands.dedup();
        for operand in operands {
            let done = last_use.get(&operand) == Some(&i);
            if let Some(&r) = register.get(&operand)
                && done
                && r as usize >= fixed
            {
                free.push(r);
            }
        }
        let out = free.pop().unwrap_or_else(|| {
            used += 1;
            used - 1
        });
        register.insert(e, out);
        tape.count(1, 0);
        tape.code.push(Instruction { op, out, a, b });
    }
    tape.result = register
        .get(&root)
        .copied()
        .ok_or(FunctionError::UnboundVariable)?;
    tape.registers = (used as usize).max(FRAME);
    tape.stack = tape.registers + nested;
    Ok(tape)
}

fn assemble_body(
    graph: &Graph,
    l: Loop,
    outside: &[Expr],
    captures: &Captures,
) -> Result<Tape, FunctionError> {
    let mut inputs: NodeMap<u32> = NodeMap::default();
    for (i, &e) in outside.iter().enumerate() {
        inputs.insert(e, i as u32 + 1);
    }
    if let Some(counter) = graph.find_variable(l.variable) {
        inputs.insert(counter, 0);
    }
    assemble(
        graph,
        l.body,
        Some(l.variable),
        inputs,
        outside.len() + 1,
        captures,
    )
}
