// The text of the scene, with line numbers, coloured by strahl's lexer.

import { el } from "./numbers.js";
import { word } from "./words.js";

export class Code {
  // `actions`: source(file) -> promise, pieces(text) -> promise, pick(file, line), changed(text or null), save(file, text), open(file, line)
  constructor(box, actions) {
    this.box = box;
    this.actions = actions;
    this.tabs = el("div", { class: "tabs", role: "tablist" });
    this.tools = el("div", { class: "text-tools" });
    this.lines = el("div", { class: "lines", id: "lines", tabindex: "0" });
    box.append(this.tabs, this.tools, this.lines);
    this.files = [];
    this.said = [];
    this.file = null;
    this.text = null;
    this.writing = false;
    this.lines.addEventListener("click", (event) => {
      const line = event.target.closest?.(".text-line");
      if (line && !this.writing) this.actions.pick(this.file, Number(line.dataset.line));
    });
  }

  setOptions(options) {
    this.options = options;
    this.showTools();
  }

  async setFiles(files, version) {
    const gone = !files.includes(this.file);
    this.files = files;
    if (gone) this.file = files[0] ?? null;
    this.showTabs();
    if (this.version !== version || gone) {
      this.version = version;
      if (!this.writing) await this.load();
    }
  }

  showTabs() {
    this.tabs.replaceChildren(...this.files.map((file) => el("button", {
      type: "button", class: "tab", role: "tab", title: file, "aria-selected": String(file === this.file), text: file.split(/[\\/]/).pop(),
      onclick: () => this.choose(file),
    })));
  }

  async choose(file) {
    if (file === this.file || this.writing) return;
    this.file = file;
    this.showTabs();
    await this.load();
  }

  showTools() {
    const main = this.file === this.files[0];
    const tools = [];
    if (this.text !== null && (main || this.options?.edit)) {
      tools.push(el("button", { type: "button", class: "tool", id: "try", "aria-pressed": String(this.writing), text: this.writing ? word("stopEdit") : word("edit"), onclick: () => this.write(!this.writing) }));
    }
    if (this.writing && this.options?.edit) {
      tools.push(el("button", { type: "button", class: "tool", id: "save", text: word("save"), onclick: () => this.actions.save(this.file, this.area.value) }));
    }
    if (this.writing && !this.options?.edit) tools.push(el("span", { class: "dim", text: word("tryHint") }));
    if (this.options?.editor && this.file) {
      tools.push(el("button", { type: "button", class: "tool", text: word("openEditor"), onclick: () => this.actions.open(this.file, this.under ?? 1) }));
    }
    this.tools.replaceChildren(...tools);
    this.tools.hidden = tools.length === 0;
  }

  async load() {
    const file = this.file;
    if (!file) return;
    try {
      const { text, pieces } = await this.actions.source(file);
      if (file !== this.file) return;
      this.text = text;
      this.render(text, pieces);
    } catch (problem) {
      if (file !== this.file) return;
      this.text = null;
      this.lines.replaceChildren(el("p", { class: "dim panel-body", text: `${word("tooLong")}: ${problem.message}` }));
    }
    this.showTools();
    this.showSaid();
  }

  render(text, pieces) {
    const rows = this.rows(text, pieces);
    if (!this.writing) {
      this.lines.replaceChildren(...rows);
      return;
    }
    this.writer.replaceChildren(...rows, this.area);
  }

  rows(text, pieces) {
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

  line(number) {
    return this.lines.querySelector(`.text-line[data-line="${number}"]`);
  }

  // Marks the line of the object under the mouse.
  setUnder(file, line) {
    if (this.under === line && this.underFile === file) return;
    this.lines.querySelector(".under")?.classList.remove("under");
    this.under = line;
    this.underFile = file;
    if (file === this.file && line) {
      const row = this.line(line);
      row?.classList.add("under");
    }
  }

  setMarked(file, line) {
    this.lines.querySelector(".marked")?.classList.remove("marked");
    if (file === this.file && line) this.line(line)?.classList.add("marked");
  }

  async show(file, line) {
    if (this.files.includes(file)) await this.choose(file);
    if (file !== this.file) return;
    this.setUnder(file, line);
    this.line(line)?.scrollIntoView({ block: "center", behavior: "smooth" });
  }

  setSaid(said) {
    this.said = said ?? [];
    this.showSaid();
  }

  showSaid() {
    for (const row of this.lines.querySelectorAll(".bad, .warned")) {
      row.classList.remove("bad", "warned");
      row.removeAttribute("title");
    }
    for (const one of this.said) {
      if (one.file !== this.file || !one.line) continue;
      const row = this.line(one.line);
      row?.classList.add(one.severity === "error" ? "bad" : "warned");
      row?.setAttribute("title", one.message);
    }
  }

  // Begins or ends changing the text.
  write(on) {
    this.writing = on;
    if (!on) {
      this.area = null;
      this.actions.changed(null);
      this.load();
      return;
    }
    this.area = el("textarea", { spellcheck: "false", autocomplete: "off", "aria-label": word("scene"), id: "writer" });
    this.area.value = this.text;
    this.writer = el("div", { class: "writer" });
    this.writer.append(...this.lines.childNodes, this.area);
    this.lines.replaceChildren(this.writer);
    this.area.addEventListener("input", () => this.typed());
    this.area.addEventListener("keydown", (event) => {
      event.stopPropagation();
      if (event.key === "Tab") {
        event.preventDefault();
        this.area.setRangeText("  ", this.area.selectionStart, this.area.selectionEnd, "end");
        this.typed();
      }
    });
    this.area.focus({ preventScroll: true });
    this.showTools();
  }

  async typed() {
    const text = this.area.value;
    this.text = text;
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.actions.changed(text), 350);
    if (this.coloring) return;
    this.coloring = true;
    try {
      const { pieces } = await this.actions.pieces(text);
      if (this.writing && this.area.value === text) this.render(text, pieces);
      else if (this.writing) this.render(this.area.value, []);
    } finally {
      this.coloring = false;
      if (this.writing && this.area.value !== text) this.typed();
      this.showSaid();
      this.area?.focus({ preventScroll: true });
    }
  }

  saved() {
    this.writing = false;
    this.area = null;
    this.load();
  }
}
