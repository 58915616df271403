// Formulas in MathML.

import { isGray, number } from "./numbers.js";

const MATH = "http://www.w3.org/1998/Math/MathML";

export function math(name, ...children) {
  const element = document.createElementNS(MATH, name);
  element.append(...children.flat());
  return element;
}

export function sign(text) {
  return math("mo", text);
}

// A sign between what stands before it and what comes, even if it begins a part of a formula that is broken into parts.
export function infix(text) {
  const between = sign(text);
  for (const side of ["lspace", "rspace"]) between.setAttribute(side, "0.22em");
  return between;
}

// A symbol with an index: `k_d`.
export function symbol(name, index) {
  const base = math("mi", name);
  return index ? math("msub", base, math("mi", index)) : base;
}

export function value(x, digits = 4) {
  const text = number(x, digits);
  return math("mn", text);
}

// A colour; grey ones are one number.
export function vector(color, digits = 4) {
  if (isGray(color)) return value(color[0], digits);
  const parts = color.flatMap((c, i) => (i ? [sign(","), value(c, digits)] : [value(c, digits)]));
  return math("mrow", sign("("), ...parts, sign(")"));
}

// The product of two vectors in parentheses: `(n·l)`.
export function dot(a, b) {
  return math("mrow", sign("("), math("mi", a), sign("·"), math("mi", b), sign(")"));
}

export function power(base, exponent) {
  return math("msup", base, exponent);
}

export function product(factors) {
  return math("mrow", ...factors.flatMap((factor, i) => (i ? [sign("·"), factor] : [factor])));
}

// The same as parts, between which a long product may be broken.
export function factored(factors) {
  return factors.map((factor, i) => (i ? math("mrow", infix("·"), factor) : factor));
}

export function sum(terms) {
  return math("mrow", ...terms.flatMap((term, i) => (i ? [sign("+"), term] : [term])));
}

// `a = b = c` as one formula.
export function equation(...sides) {
  const row = math("math", ...sides.flatMap((side, i) => (i ? [sign("="), side] : [side])));
  row.setAttribute("display", "inline");
  return row;
}
