// The text of the scene, with line numbers, coloured by strahl's lexer. Each file is a tab; changed texts are tried in this page.

import { linesOf } from "./lines.js";
import { el } from "./numbers.js";
import { word } from "./words.js";

export class Code {
  // `actions`: source(file) -> promise, pieces(text) -> promise, pick(file, line), changed(file, text or null), save(file, text), open(file, line)
  constructor(box, actions) {
    this.box = box;
    this.actions = actions;
    this.tabs = el("div", { class: "tabs", role: "tablist" });
    this.tools = el("div", { class: "text-tools" });
    this.lines = el("div", { class: "lines", id: "lines", tabindex: "0" });
    box.append(this.tabs, this.tools, this.lines);
    this.files = [];
    this.builtIn = new Set();
    this.said = [];
    this.file = null;
    // The line that was looked at last, which the author's editor opens.
    this.at = 1;
    this.text = null;
    // The texts that are tried, by file.
    this.tried = new Map();
    this.lines.addEventListener("click", (event) => {
      const line = event.target.closest?.(".text-line");
      if (!line || this.writing) return;
      this.at = Number(line.dataset.line);
      this.actions.pick(this.file, this.at);
    });
  }

  // Whether the text that is shown is being changed.
  get writing() {
    return this.tried.has(this.file);
  }

  setOptions(options) {
    this.options = options;
    this.showTools();
  }

  async setFiles(files, version) {
    const names = files.map((one) => one.name);
    const gone = !names.includes(this.file);
    this.files = names;
    this.builtIn = new Set(files.filter((one) => one.built_in).map((one) => one.name));
    if (gone) this.file = names[0] ?? null;
    this.showTabs();
    if (this.version !== version || gone) {
      this.version = version;
      if (!this.area) await this.load();
    }
  }

  // Another scene has other texts.
  forget() {
    this.tried.clear();
    this.area = null;
    this.version = null;
  }

  showTabs() {
    this.tabs.replaceChildren(...this.files.map((file) => el("button", {
      type: "button", class: "tab", role: "tab", title: this.builtIn.has(file) ? `${file}: ${word("builtIn")}` : file, "aria-selected": String(file === this.file),
      text: `${this.tried.has(file) ? "● " : ""}${file.split(/[\\/]/).pop()}`, onclick: () => this.choose(file),
    })));
  }

  async choose(file) {
    if (file === this.file) return;
    this.file = file;
    this.at = 1;
    this.area = null;
    this.showTabs();
    await this.load();
  }

  showTools() {
    const tools = [];
    const button = (text, action, more = {}) => el("button", { type: "button", class: "tool", text, onclick: action, ...more });
    const builtIn = this.builtIn.has(this.file);
    if (this.text !== null && !builtIn) {
      tools.push(button(this.writing ? word("stopEdit") : word("edit"), () => this.write(!this.writing), { id: "try", "aria-pressed": String(this.writing) }));
    }
    if (this.writing && this.options?.edit) tools.push(button(word("save"), () => this.actions.save(this.file, this.area.value), { id: "save" }));
    if (this.writing && !this.options?.edit) tools.push(el("span", { class: "dim", text: word("tryHint") }));
    if (builtIn) tools.push(el("span", { class: "dim", text: word("builtIn") }));
    if (this.options?.editor && this.file && !builtIn) tools.push(button(word("openEditor"), () => this.actions.open(this.file, this.at), { id: "editor" }));
    this.tools.replaceChildren(...tools);
    this.tools.hidden = tools.length === 0;
  }

  async load() {
    const file = this.file;
    if (!file) return;
    try {
      const tried = this.tried.get(file);
      const { text, pieces } = tried === undefined ? await this.actions.source(file) : { text: tried, ...(await this.actions.pieces(tried)) };
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
    const rows = linesOf(text, pieces);
    if (!this.writing) {
      this.lines.replaceChildren(...rows);
      return;
    }
    if (!this.area) this.open(text);
    this.writer.replaceChildren(...rows, this.area);
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
    if (file === this.file && line) this.line(line)?.classList.add("under");
  }

  // The mouse rests on an object: its line comes into view, unless somebody is writing.
  rest() {
    clearTimeout(this.resting);
    this.resting = setTimeout(() => {
      if (this.underFile === this.file && this.under && !this.writing) this.line(this.under)?.scrollIntoView({ block: "nearest" });
    }, 300);
  }

  setMarked(file, line) {
    this.lines.querySelector(".marked")?.classList.remove("marked");
    if (file === this.file && line) this.line(line)?.classList.add("marked");
  }

  async show(file, line) {
    if (this.files.includes(file)) await this.choose(file);
    if (file !== this.file) return;
    this.at = line;
    this.setUnder(null, null);
    this.setUnder(file, line);
    this.line(line)?.scrollIntoView({ block: "center", behavior: "smooth" });
  }

  setSaid(said) {
    this.said = said ?? [];
    this.showSaid();
  }

  // Errors and warnings, in the margin and behind the line.
  showSaid() {
    for (const row of this.lines.querySelectorAll(".bad, .warned")) {
      row.classList.remove("bad", "warned");
      row.removeAttribute("title");
      delete row.dataset.said;
    }
    for (const one of this.said) {
      if (one.file !== this.file || !one.line) continue;
      const row = this.line(one.line);
      if (!row || row.classList.contains("bad")) continue;
      row.classList.remove("warned");
      row.classList.add(one.severity === "error" ? "bad" : "warned");
      row.title = one.message;
      row.dataset.said = one.message;
    }
  }

  // Begins or ends changing the text.
  write(on) {
    const file = this.file;
    clearTimeout(this.timer);
    if (on) {
      const rows = [...this.lines.childNodes];
      this.tried.set(file, this.text);
      this.open(this.text);
      this.writer.append(...rows, this.area);
      this.area.focus({ preventScroll: true });
    } else {
      this.tried.delete(file);
      this.area = null;
      this.actions.changed(file, null);
      this.load();
    }
    this.showTabs();
    this.showTools();
  }

  // A field over the coloured text.
  open(text) {
    this.area = el("textarea", { spellcheck: "false", autocomplete: "off", "aria-label": word("scene"), id: "writer" });
    this.area.value = text;
    this.writer = el("div", { class: "writer" });
    this.lines.replaceChildren(this.writer);
    this.area.addEventListener("input", () => this.typed());
    this.area.addEventListener("keydown", (event) => {
      event.stopPropagation();
      // Escape leaves the field, so that Tab may be a part of the text.
      if (event.key === "Escape") this.tabs.querySelector('[aria-selected="true"]')?.focus();
      if (event.key === "Tab" && !event.shiftKey) {
        event.preventDefault();
        this.area.setRangeText("  ", this.area.selectionStart, this.area.selectionEnd, "end");
        this.typed();
      }
    });
  }

  async typed() {
    const { area, file } = this;
    const text = area.value;
    this.text = text;
    this.tried.set(file, text);
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.actions.changed(file, text), 350);
    if (this.coloring) return;
    this.coloring = true;
    try {
      const { pieces } = await this.actions.pieces(text);
      if (this.area === area) this.render(area.value, area.value === text ? pieces : []);
    } catch { /* the text is too long to be coloured */ } finally {
      this.coloring = false;
      if (this.area === area) {
        if (area.value !== text) this.typed();
        this.showSaid();
        area.focus({ preventScroll: true });
      }
    }
  }

  saved() {
    this.tried.delete(this.file);
    this.area = null;
    this.showTabs();
    this.load();
  }
}
