// Elements, numbers and colours.

export function el(name, attributes = {}, ...children) {
  const element = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (key.startsWith("on")) element.addEventListener(key.slice(2), value);
    else if (key === "class") element.className = value;
    else if (key === "text") element.textContent = value;
    else if (value === true) element.setAttribute(key, "");
    else if (value !== false && value != null) element.setAttribute(key, value);
  }
  element.append(...children.flat().filter((child) => child != null && child !== false));
  return element;
}

export function number(value, digits = 5) {
  if (value === null || value === undefined) return "∞";
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e6 || size < 1e-4) {
    const [mantissa, exponent] = value.toExponential(2).split("e");
    const raised = [...String(Number(exponent))].map((c) => (c === "-" ? "⁻" : "⁰¹²³⁴⁵⁶⁷⁸⁹"[Number(c)])).join("");
    return `${mantissa.replace("-", "−")}·10${raised}`;
  }
  return String(Number(value.toPrecision(digits))).replace("-", "−");
}

export function triple(values, digits = 4) {
  return `(${values.map((v) => number(v, digits)).join(", ")})`;
}

export function isBlack(color) {
  return color.every((c) => c === 0);
}

export function isGray(color) {
  return color[0] === color[1] && color[1] === color[2];
}

export function brightness(color) {
  return 0.2126 * color[0] + 0.7152 * color[1] + 0.0722 * color[2];
}

export function times(a, b) {
  return a.map((v, i) => v * b[i]);
}

function code(linear) {
  const c = Math.min(1, Math.max(0, linear));
  return Math.round(255 * (c <= 0.0031308 ? 12.92 * c : 1.055 * c ** (1 / 2.4) - 0.055));
}

export function css(linear) {
  return `rgb(${linear.map(code).join(" ")})`;
}

export function swatch(linear) {
  const box = el("span", { class: "swatch", "aria-hidden": "true" });
  box.style.backgroundColor = css(linear);
  return box;
}
