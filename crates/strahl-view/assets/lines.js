// The lines of a text, with numbers, coloured by its pieces: pairs of a length and a kind.

import { el } from "./numbers.js";

export function linesOf(text, pieces) {
  const lines = [];
  let line = el("span", { class: "line-text" });
  const end = () => {
    const count = lines.length + 1;
    if (!line.childNodes.length) line.append("\u200b");
    lines.push(el("div", { class: "text-line", "data-line": count }, el("span", { class: "line-number", text: String(count) }), line));
    line = el("span", { class: "line-text" });
  };
  const piece = (part, kind) => {
    part.split("\n").forEach((one, i) => {
      if (i) end();
      const clean = one.replace(/\r$/, "");
      if (clean) line.append(kind ? el("span", { class: `k${kind}`, text: clean }) : clean);
    });
  };
  let at = 0;
  for (let i = 0; i + 1 < pieces.length; i += 2) {
    piece(text.slice(at, at + pieces[i]), pieces[i + 1]);
    at += pieces[i];
  }
  piece(text.slice(at), 0);
  end();
  return lines;
}
