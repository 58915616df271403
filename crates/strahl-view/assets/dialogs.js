// The sheet of keys, and the table of what the picture costs with each accelerator.

import { find, toast } from "./controls.js";
import { el, number } from "./numbers.js";
import { getLanguage, word } from "./words.js";

function closing(box) {
  return el("p", {}, el("button", { type: "button", class: "tool", text: word("close"), onclick: () => box.close() }));
}

export function help() {
  const box = find("help");
  if (box.open) { box.close(); return; }
  box.replaceChildren(el("h2", { text: word("helpTitle") }), el("dl", {}, ...word("helpList").flatMap(([key, text]) => [el("dt", { text: key }), el("dd", { text })])), closing(box));
  box.showModal();
}

export async function showTable(link) {
  const box = find("table");
  const close = closing(box);
  box.replaceChildren(el("h2", { text: word("tableTitle") }), el("p", { class: "dim", text: word("measuring") }), close);
  box.showModal();
  try {
    const { width, height, rows } = await link.ask({ type: "table", slot: "main" });
    const count = (value) => value.toLocaleString(getLanguage());
    const same = rows.every((row) => row.sha256 === rows[0].sha256);
    const head = ["accelerator", "build", "seconds", "rayCount", "stepsPerRay", "testsPerRay"];
    const cells = (row) => [`${number(row.build, 3)} s`, `${number(row.seconds, 3)} s`, count(row.rays), number(row.steps / Math.max(1, row.rays), 4), number(row.tests / Math.max(1, row.rays), 4)];
    box.replaceChildren(el("h2", { text: word("tableTitle") }),
      el("div", { class: "wide", tabindex: "0" }, el("table", { class: "figures" }, el("thead", {}, el("tr", {}, ...head.map((key) => el("th", { scope: "col", text: word(key) })))),
        el("tbody", {}, ...rows.map((row) => el("tr", {}, el("th", { scope: "row", text: row.name }), ...cells(row).map((text) => el("td", { text }))))))),
      el("p", { class: "dim", text: `${width} × ${height} · ${word(same ? "samePictures" : "otherPictures")}` }), close);
  } catch (problem) {
    box.close();
    toast(problem.message);
  }
}
