// The scene's lights, which can be dragged.

import { shifted } from "./camera.js";
import { counted, find } from "./controls.js";
import { el } from "./numbers.js";
import { lightName, word } from "./words.js";

export class Lights {
  // `actions`: change(number, position), reset(), copy(number), place(file, line), draw().
  constructor(actions) {
    this.actions = actions;
    this.placed = [];
    this.moved = {};
    this.chosen = null;
    this.on = false;
    this.panel = el("div", { id: "lights-panel", class: "card", hidden: true });
  }

  // The lights as the scene has them, and the positions of those that were dragged.
  set(placed, moved) {
    this.placed = placed ?? [];
    this.moved = moved ?? {};
    if (!this.placed[this.chosen]) this.chosen = this.numbers()[0] ?? null;
    this.show();
  }

  // The numbers of those that have a position.
  numbers() {
    return this.placed.flatMap((one, number) => (one ? [number] : []));
  }

  position(number) {
    return this.moved[number] ?? this.placed[number]?.position ?? null;
  }

  toggle() {
    this.on = !this.on;
    this.show();
  }

  choose(number) {
    this.chosen = number;
    this.show();
    this.actions.draw();
  }

  move(position) {
    if (this.chosen === null || !position.every(Number.isFinite)) return;
    // As many digits as somebody would write.
    const clean = position.map((one) => Number(one.toPrecision(6)));
    this.moved = { ...this.moved, [this.chosen]: clean };
    this.actions.change(this.chosen, clean);
    this.fill();
  }

  // The light whose sign is at a place; `project` leads from points to places, or null.
  at(x, y, project, reach) {
    let best = null;
    for (const number of this.numbers()) {
      const place = project(this.position(number));
      if (!place) continue;
      const away = Math.hypot(place[0] - x, place[1] - y);
      if (away <= reach && (!best || away < best.away)) best = { number, away };
    }
    return best?.number ?? null;
  }

  // Moves the chosen light as a drag by this part of the picture's half height says.
  drag(camera, du, dv) {
    const position = this.position(this.chosen);
    if (position) this.move(shifted(camera, position, du, dv));
  }

  // Moves it away from the eye, or nearer.
  push(camera, factor) {
    const position = this.position(this.chosen);
    if (!position) return;
    if (camera.orthographic) {
      const size = Math.hypot(...camera.up);
      const along = Math.hypot(...camera.direction) || 1;
      this.move(position.map((one, i) => one + (camera.direction[i] / along) * size * (factor - 1)));
    } else this.move(position.map((one, i) => camera.eye[i] + (one - camera.eye[i]) * factor));
  }

  show() {
    const numbers = this.numbers();
    this.panel.hidden = !this.on;
    // Nobody's number is taken away while it is being typed.
    const focused = document.activeElement;
    if (!this.on || (focused?.dataset.edited && this.panel.contains(focused))) return;
    if (!numbers.length) {
      this.panel.replaceChildren(el("strong", { text: word("lights") }), el("p", { class: "dim", text: word("noLights") }));
      return;
    }
    const light = this.placed[this.chosen];
    const select = el("select", { id: "light", "aria-label": word("lights"), onchange: () => this.choose(Number(select.value)) },
      ...numbers.map((one) => el("option", { value: one, text: `${lightName(this.placed[one].name)}, ${word(this.placed[one].kind)}`, selected: one === this.chosen })));
    const axis = (name, index) => counted(`light-${name}`, name, null, { step: "any" }, (value) => {
      const position = [...this.position(this.chosen)];
      if (value !== null) position[index] = value;
      this.move(position);
    });
    const button = (id, text, action) => el("button", { type: "button", class: "tool", id, text, onclick: action });
    this.panel.replaceChildren(el("strong", { text: word("lights") }), select,
      el("div", { class: "axes numbers" }, axis("x", 0), axis("y", 1), axis("z", 2)),
      el("div", { class: "axes" },
        button("copy-light", word("copyLight"), () => this.actions.copy(this.chosen)),
        button("reset-lights", word("resetCamera"), () => this.actions.reset()),
        light.file ? el("button", { type: "button", class: "place way", text: `${light.file.split(/[\\/]/).pop()}:${light.line}`, title: light.file, onclick: () => this.actions.place(light.file, light.line) }) : ""),
      el("p", { class: "dim", text: word("dragLight") }));
    this.fill();
  }

  fill() {
    const position = this.position(this.chosen);
    ["x", "y", "z"].forEach((name, index) => {
      const input = find(`light-${name}`);
      if (input && position && document.activeElement !== input) input.value = Number(position[index].toPrecision(6));
    });
  }

  // Draws their signs; `project` leads from points to places, or null.
  paint(pen, project, all = true) {
    for (const number of this.numbers()) {
      if (!all && number !== this.chosen) continue;
      const place = project(this.position(number));
      if (!place) continue;
      const now = this.on && number === this.chosen;
      sun(pen, place, now ? "#ffb648" : "#ffe08a", now ? 8 : 6);
    }
  }
}

// A small sun, made of strokes, which a pen for SVG knows too.
function sun(pen, [x, y], color, size) {
  for (const [paint, width] of [["rgb(0 0 0 / 70%)", 4.5], [color, 2.2]]) {
    pen.strokeStyle = paint;
    pen.lineWidth = width;
    pen.beginPath();
    for (let i = 0; i < 8; i += 1) {
      const [c, s] = [Math.cos((i * Math.PI) / 4), Math.sin((i * Math.PI) / 4)];
      pen.moveTo(x + c * size * 0.85, y + s * size * 0.85);
      pen.lineTo(x + c * size * 1.5, y + s * size * 1.5);
    }
    for (let i = 0; i <= 12; i += 1) {
      const place = [x + Math.cos((i * Math.PI) / 6) * size * 0.5, y + Math.sin((i * Math.PI) / 6) * size * 0.5];
      if (i) pen.lineTo(...place); else pen.moveTo(...place);
    }
    pen.stroke();
  }
}
