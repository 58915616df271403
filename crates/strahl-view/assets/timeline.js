// The timeline of a scene that uses `clock`: a slider, and playing one picture after the other.

import { el, number } from "./numbers.js";
import { word } from "./words.js";

export class Timeline {
  // `change(clock)` shows the scene at this time.
  constructor(box, change) {
    this.box = box;
    this.change = change;
    this.range = [0, 1];
    this.frames = 25;
    this.playing = false;
    this.clock = 0;
  }

  show(on, clock) {
    this.clock = clock ?? 0;
    this.box.hidden = !on;
    if (!on) { this.playing = false; return; }
    if (!this.slider) this.build();
    if (document.activeElement !== this.slider) this.slider.value = this.clock;
    this.say();
  }

  // Its words are made again, in another language.
  clear() {
    this.slider = null;
  }

  build() {
    const input = (title, value, change) => {
      const field = el("input", { type: "number", step: "any", onchange: () => { if (Number.isFinite(field.valueAsNumber)) change(field.valueAsNumber); this.limit(); } });
      field.value = value;
      return el("label", { class: "control" }, title, field);
    };
    this.button = el("button", { type: "button", class: "tool", id: "play-clock", onclick: () => this.play() });
    this.slider = el("input", { type: "range", id: "clock-slider", "aria-label": word("clock"), step: "any", oninput: () => this.go(Number(this.slider.value)) });
    this.shown = el("output", { class: "figures" });
    this.limit();
    this.slider.value = this.clock;
    this.box.replaceChildren(this.button, input(word("from"), this.range[0], (value) => { this.range[0] = value; }), this.slider,
      input(word("to"), this.range[1], (value) => { this.range[1] = value; }),
      input(word("frames"), this.frames, (value) => { this.frames = Math.max(1, Math.round(value)); }), this.shown);
  }

  limit() {
    if (!this.slider) return;
    [this.slider.min, this.slider.max] = this.range;
  }

  say() {
    this.shown.textContent = `${word("clock")} ${number(this.clock, 4)}`;
    this.button.textContent = this.playing ? `⏸ ${word("pause")}` : `▶ ${word("play")}`;
  }

  go(clock) {
    this.clock = clock;
    this.say();
    this.change(clock);
  }

  play() {
    this.playing = !this.playing;
    this.say();
    if (this.playing) this.next();
  }

  // The next picture comes when this one is finished.
  finished() {
    if (this.playing) setTimeout(() => { if (this.playing) this.next(); }, 40);
  }

  next() {
    const [from, to] = this.range;
    const by = (to - from) / this.frames;
    const clock = this.clock + by;
    const past = by >= 0 ? clock > to + by * 1e-6 : clock < to + by * 1e-6;
    this.go(past ? from : Number(clock.toPrecision(12)));
    if (this.slider) this.slider.value = this.clock;
  }
}
