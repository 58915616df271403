//! The interpreter, once for all domains.

use crate::domain::{Domain, Round};
use crate::op::{BinaryOp, UnaryOp};
use crate::tape::{FRAME, FieldCode, Op, Tape};

/// Writes the constants of a tape to their registers.
pub(crate) fn prepare<T: Domain>(tape: &Tape, stack: &mut [T]) {
    for (register, &value) in stack[tape.inputs..].iter_mut().zip(&tape.constants) {
        *register = T::constant(value);
    }
}

/// Runs a tape whose inputs and constants are in place at the start of `stack`, which has `tape.stack` registers. Its loops
/// take their rounds from `fuel`.
pub(crate) fn run<T: Domain>(tape: &Tape, stack: &mut [T], fuel: &mut T::Fuel) -> T {
    let (registers, rest) = stack.split_at_mut(tape.registers);
    match <&mut [T; FRAME]>::try_from(&mut *registers) {
        Ok(few) => steps(tape, few, |register| register as usize % FRAME, rest, fuel),
        Err(_) => many_steps(tape, registers, rest, fuel),
    }
}

/// The steps of a tape with more registers than a usual one.
#[inline(never)]
fn many_steps<T: Domain>(
    tape: &Tape,
    registers: &mut [T],
    rest: &mut [T],
    fuel: &mut T::Fuel,
) -> T {
    steps(tape, registers, |register| register as usize, rest, fuel)
}

/// The steps of a tape on its registers. `at` gives the place of a register: where the compiler sees that it is one of the slice's, it
/// leaves out its checks.
#[inline(always)]
fn steps<T: Domain>(
    tape: &Tape,
    r: &mut [T],
    at: impl Fn(u32) -> usize,
    rest: &mut [T],
    fuel: &mut T::Fuel,
) -> T {
    for i in &tape.code {
        let (out, a, b, row) = (at(i.out), at(i.a), at(i.b), i.b as usize);
        r[out] = match i.op {
            Op::Neg => T::unary(UnaryOp::Neg, r[a]),
            Op::Abs => T::unary(UnaryOp::Abs, r[a]),
            Op::Square => T::unary(UnaryOp::Square, r[a]),
            Op::Sqrt => T::unary(UnaryOp::Sqrt, r[a]),
            Op::Add => T::binary(BinaryOp::Add, r[a], r[b]),
            Op::Sub => T::binary(BinaryOp::Sub, r[a], r[b]),
            Op::Mul => T::binary(BinaryOp::Mul, r[a], r[b]),
            Op::Div => T::binary(BinaryOp::Div, r[a], r[b]),
            Op::Min => T::binary(BinaryOp::Min, r[a], r[b]),
            Op::Max => T::binary(BinaryOp::Max, r[a], r[b]),
            Op::Unary(op) => unary(op, r[a]),
            Op::Binary(op) => binary(op, r[a], r[b]),
            Op::Select => {
                let [negative, zero, positive] = tape.selects[row].map(&at);
                T::select(r[a], r[negative], r[zero], r[positive])
            }
            Op::Field => field(tape, row, r, rest),
            Op::Call => call(tape, row, r, rest, fuel),
            Op::Loop => repeat(tape, row, r, rest, fuel),
        };
    }
    r[at(tape.result)]
}

// What follows is not part of the interpreter's own code, which is to have few instructions between one operation and the next.

#[inline(never)]
fn unary<T: Domain>(op: UnaryOp, a: T) -> T {
    T::unary(op, a)
}

#[inline(never)]
fn binary<T: Domain>(op: BinaryOp, a: T, b: T) -> T {
    T::binary(op, a, b)
}

#[inline(never)]
fn field<T: Domain>(tape: &Tape, at: usize, registers: &[T], stack: &mut [T]) -> T {
    let FieldCode {
        field,
        arguments,
        is_row,
    } = &tape.fields[at];
    if let (true, Some(&first)) = (*is_row, arguments.first()) {
        let first = first as usize;
        return T::field(field.as_ref(), &registers[first..first + arguments.len()]);
    }
    gather(registers, arguments, stack);
    T::field(field.as_ref(), &stack[..arguments.len()])
}

#[inline(never)]
fn call<T: Domain>(
    tape: &Tape,
    at: usize,
    registers: &[T],
    stack: &mut [T],
    fuel: &mut T::Fuel,
) -> T {
    let (callee, arguments) = &tape.calls[at];
    gather(registers, arguments, stack);
    prepare(callee, stack);
    run(callee, stack, fuel)
}

#[inline]
fn gather<T: Domain>(registers: &[T], from: &[u32], to: &mut [T]) {
    // A point in space, without a loop.
    if let (&[a, b, c], [x, y, z, ..]) = (from, &mut *to) {
        *x = registers[a as usize];
        *y = registers[b as usize];
        *z = registers[c as usize];
        return;
    }
    for (to, &from) in to.iter_mut().zip(from) {
        *to = registers[from as usize];
    }
}

#[inline(never)]
fn repeat<T: Domain>(
    tape: &Tape,
    at: usize,
    registers: &[T],
    stack: &mut [T],
    fuel: &mut T::Fuel,
) -> T {
    let code = &tape.loops[at];
    let (op, neutral) = if code.product {
        (BinaryOp::Mul, 1.0)
    } else {
        (BinaryOp::Add, 0.0)
    };
    let mut counter = registers[code.from as usize];
    let to = registers[code.to as usize];
    let mut total = T::constant(neutral);
    gather(registers, &code.captures, &mut stack[1..]);
    prepare(&code.body, stack);
    loop {
        let mask = match T::round(counter, to, fuel, code.price) {
            Round::Go(mask) => mask,
            Round::Starved(mask) => {
                // Without a counter they take no part in what follows.
                total = T::blend(mask, T::constant(f64::NAN), total);
                counter = T::blend(mask, T::constant(f64::NAN), counter);
                continue;
            }
            Round::Done => return total,
            Round::Unknown => return T::unknown(),
        };
        let before = *fuel;
        T::ration(fuel, mask);
        stack[0] = counter;
        let term = run(&code.body, stack, fuel);
        T::restore(fuel, mask, before);
        total = T::blend(mask, T::binary(op, total, term), total);
        counter = T::binary(BinaryOp::Add, counter, T::constant(1.0));
    }
}
