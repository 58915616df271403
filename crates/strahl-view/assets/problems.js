// The errors and warnings of the scene, over the picture.

import { find } from "./controls.js";
import { el } from "./numbers.js";
import { word } from "./words.js";

let warningsShown = false;

// Shows the errors, and the warnings if they are asked for. `kept` says whether an older picture is still there, `show` leads to a place.
export function showProblems(said, box, { kept, show }) {
  const list = find("problems") ?? box.appendChild(el("div", { id: "problems", role: "alert" }));
  const errors = said.filter((one) => one.severity === "error");
  const shown = [...errors.slice(0, 20), ...(warningsShown ? said.filter((one) => one.severity === "warning") : [])];
  list.hidden = shown.length === 0;
  list.classList.toggle("mild", errors.length === 0);
  list.replaceChildren(...shown.map((one) => problem(one, show)), errors.length && kept ? el("p", { class: "dim", text: word("lastGood") }) : "");
}

function problem(one, show) {
  const where = one.file ? `${one.file}${one.line ? `:${one.line}` : ""}${one.column ? `:${one.column}` : ""}` : "";
  const text = one.text !== null && one.caret ? el("pre", { tabindex: "0" }, `${one.text.replace(/[\x00-\x1f]/g, " ")}\n${" ".repeat(Math.max(0, one.caret[0] - 1))}`, el("span", { class: "caret", text: "^".repeat(Math.max(1, one.caret[1])) })) : null;
  return el("div", { class: "problem" },
    el("div", { class: `message ${one.severity}`, text: `${word(one.severity)}: ${one.message}` }),
    where && el("button", { type: "button", class: "place", text: where, onclick: () => show(one.file, one.line) }),
    text,
    ...one.trace.map((step) => el("div", { class: "dim", text: step })),
    ...one.help.map((help) => el("div", { text: help })));
}

// The number of warnings, which shows or hides them; an empty text if there are none.
export function warningsButton(said, changed) {
  const warnings = said.filter((one) => one.severity === "warning");
  if (!warnings.length) return "";
  return el("button", { type: "button", class: "warned", id: "warnings", "aria-pressed": String(warningsShown), title: warnings.map((one) => one.message).join("\n"),
    text: `⚠ ${warnings.length} ${word(warnings.length === 1 ? "warning" : "warnings")}`, onclick: () => { warningsShown = !warningsShown; changed(); } });
}
