// The scene from outside, rendered by strahl, with the rays of a pixel drawn over it; and the way of its ray through the accelerator.

import { cross, dolly, inner, length, minus, pan, plus, scaled, seen, turn, unit } from "./camera.js";
import { el, number } from "./numbers.js";
import { Film } from "./film.js";
import { Gestures } from "./gestures.js";
import { drawEye, drawRays, drawVectors, drawing, raysOf } from "./rays.js";
import { keep, state } from "./state.js";
import { SvgPen } from "./svg.js";
import { drawWay } from "./way.js";
import { word } from "./words.js";

// The view from outside: half the height of what it sees at distance 1, and the part of that in which the rays are.
const HALF = 0.42;
const INNER = 0.7;

export class Space {
  // `actions`: onRay(number), toast(text), table(), svg(text).
  constructor(link, lights, actions) {
    this.link = link;
    this.lights = lights;
    this.actions = actions;
    this.film = new Film("space");
    this.over = el("canvas", {});
    this.box = el("div", { class: "space-box" }, this.film.canvas, this.over);
    this.say = el("div", { class: "space-say" });
    this.events = el("div", { class: "events" });
    this.kind = "space";
    this.isOpen = false;
    new ResizeObserver(() => { if (this.isOpen) this.render(); }).observe(this.box);
    const near = (event) => {
      const { left, top } = this.box.getBoundingClientRect();
      return this.lights.at(event.clientX - left, event.clientY - top, (point) => this.project3(point), event.pointerType === "mouse" ? 14 : 26);
    };
    this.gestures = new Gestures(this.box, {
      accepts: () => this.camera !== undefined && this.camera !== null,
      start: (event) => {
        this.button = event.button;
        const light = this.lights.on && this.kind === "space" ? near(event) : null;
        this.holds = light !== null;
        if (light !== null) this.lights.choose(light);
      },
      drag: (event, dx, dy) => this.moved(event, dx, dy),
      pinch: (factor, x, y, dx, dy) => {
        const size = this.box.clientHeight;
        this.go(dolly(pan(this.camera, this.middle, dx / size, dy / size, 1), this.middle, 1 / factor));
      },
    });
    this.box.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.go(dolly(this.camera, this.middle, Math.exp(event.deltaY * 0.0012)));
    }, { passive: false });
  }

  // The sample, the step and the accelerator are part of the state, which the address keeps.
  get sample() { return state.sample; }
  set sample(index) { this.change({ sample: index }); }
  get at() { return state.step; }
  set at(step) { this.change({ step }); }
  get accelerator() { return this.accelerators?.includes(state.walk) ? state.walk : null; }
  set accelerator(name) { this.change({ walk: name }); }

  change(values) {
    Object.assign(state, values);
    keep();
  }

  // Another pixel is looked at.
  rest() {
    this.change({ sample: 0, step: -1 });
  }

  setScene(settings) {
    this.settings = settings;
    if (this.isOpen) this.render();
  }

  setPixel(pixel, picture) {
    const moved = this.picture?.own_camera && JSON.stringify(this.picture.own_camera) !== JSON.stringify(picture.own_camera);
    this.pixel = pixel;
    this.picture = picture;
    if (this.sample >= pixel.samples.length) this.rest();
    this.walk = null;
    if (moved) {
      this.camera = null;
      this.change({ outside: null });
    }
    this.build();
    if (this.kind === "space") this.limit();
    if (this.isOpen) this.opened();
  }

  // After a change there may be fewer steps.
  limit() {
    if (this.at >= this.count()) this.at = this.count() - 1;
  }

  setSample(index) {
    if (index === this.sample) return;
    this.sample = index;
    this.at = -1;
    this.build();
    this.draw();
  }

  // The rays of the sample that is looked at.
  build() {
    const sample = this.pixel?.samples[this.sample];
    this.steps = [];
    if (sample) Object.assign(this, raysOf(sample, this.picture.camera));
  }

  panel(kind) {
    if (kind !== this.kind) this.at = -1;
    this.kind = kind;
    const orthographic = this.camera?.orthographic;
    const button = (text, action, pressed) => el("button", { type: "button", class: "tool small", text, "aria-pressed": pressed === undefined ? null : String(pressed), onclick: action });
    const tools = el("div", { class: "space-tools" },
      button("|◀", () => { this.at = 0; this.draw(); }), button("◀", () => this.step(-1)),
      button(this.timer ? `⏸ ${word("pause")}` : `▶ ${word("play")}`, () => this.play()), button("▶", () => this.step(1)), button(word("all"), () => { this.at = -1; this.draw(); }),
      button(orthographic ? word("perspective") : word("orthographic"), () => this.project()),
      el("button", { type: "button", class: "tool small", id: "near", text: "◎", title: word("near"), "aria-label": word("near"), onclick: () => this.near() }),
      button("SVG", () => this.actions.svg(this.svg())));
    if (kind === "walk") {
      const kinds = ["", ...(this.accelerators ?? [])];
      const select = el("select", { id: "walk-accelerator", "aria-label": word("accelerator"), onchange: () => { this.accelerator = select.value || null; this.walk = null; this.at = -1; this.render(); } },
        ...kinds.map((one) => el("option", { value: one, text: one || word("own"), selected: (this.accelerator ?? "") === one })));
      const table = button(word("table"), () => this.actions.table());
      table.id = "show-table";
      tools.append(select, table);
    }
    return el("div", { class: "panel-body canvas" }, this.box, tools, this.say, kind === "walk" ? this.events : "");
  }

  opened() {
    this.isOpen = true;
    if (!this.camera && state.outside) this.camera = { ...state.outside, orthographic: Boolean(state.outside.orthographic) };
    if (!this.camera) this.outside();
    this.render();
    this.draw();
  }

  closed() {
    if (this.isOpen) this.link.send({ type: "close", slot: "space" });
    this.isOpen = false;
    this.wanted = null;
    this.stop();
  }

  // A camera beside the eye that sees the rays.
  outside() {
    const own = this.picture.camera;
    const up = unit(this.picture.own_camera.up);
    const view = unit(own.direction);
    const hand = Math.sign(inner(cross(own.right, own.up), scaled(own.direction, -1))) || 1;
    const side = unit(own.right);
    const from = unit(plus(plus(scaled(view, -0.35), side, 0.9), up, 0.55));
    const direction = scaled(from, -1);
    const right = scaled(unit(cross(direction, up)), hand);
    const top = unit(cross(scaled(right, hand), direction));
    // As near as it can be with all points in the inner part of the box.
    const { clientWidth, clientHeight } = this.box;
    const aspect = clientWidth > 0 && clientHeight > 0 ? clientWidth / clientHeight : 1;
    const away = this.points.map((point) => {
      const beside = minus(point, this.middle);
      return inner(beside, from) + Math.max(Math.abs(inner(beside, right)) / aspect, Math.abs(inner(beside, top))) / (HALF * INNER);
    });
    const eye = plus(this.middle, from, Math.max(this.radius * 1.5, ...away));
    this.camera = { eye, direction, right: scaled(right, HALF), up: scaled(top, HALF), orthographic: false };
  }

  // Goes near what the step is about, without turning; without a step, to where everything is seen.
  near() {
    const target = this.target();
    if (!target) {
      this.build();
      this.outside();
      this.go(this.camera);
      this.change({ outside: null });
      return;
    }
    const [center, size] = target;
    const { direction, right, up, orthographic } = this.camera;
    this.middle = center;
    const grow = orthographic ? size / length(up) : 1;
    const away = orthographic ? inner(minus(center, this.camera.eye), unit(direction)) : (size * length(direction)) / length(up);
    this.go({ eye: plus(center, unit(direction), -away), direction, right: scaled(right, grow), up: scaled(up, grow), orthographic });
  }

  // The middle of what the step is about, and how far to see around it.
  target() {
    if (this.at < 0) return null;
    if (this.kind === "space") return [this.steps[this.at].to, this.radius * 0.35];
    const place = this.walk?.events.slice(0, this.at + 1).findLast((event) => event.place)?.place;
    if (place?.min) return [scaled(plus(place.min, place.max), 0.5), length(minus(place.max, place.min)) * 1.3];
    return place?.center ? [place.center, place.radius * 1.5] : null;
  }

  project() {
    const away = inner(minus(this.middle, this.camera.eye), unit(this.camera.direction));
    const factor = this.camera.orthographic ? 1 / away : away;
    this.camera = { ...this.camera, right: scaled(this.camera.right, factor), up: scaled(this.camera.up, factor), orthographic: !this.camera.orthographic };
    this.go(this.camera);
    this.box.closest(".panel-body")?.replaceWith(this.panel(this.kind));
  }

  moved(event, dx, dy) {
    const size = this.box.clientHeight;
    if (this.holds) {
      this.lights.drag(this.camera, (2 * dx) / size, (-2 * dy) / size);
      this.draw();
      return;
    }
    const camera = { ...this.camera, pole: this.picture.own_camera.up };
    const shift = event.shiftKey || this.button === 2 || this.button === 1;
    this.go(shift ? pan(camera, this.middle, dx / size, dy / size, 1) : turn(camera, this.middle, (-dx / size) * 3, (-dy / size) * 3));
  }

  go({ eye, direction, right, up, orthographic }) {
    this.camera = { eye, direction, right, up, orthographic };
    this.change({ outside: this.camera });
    this.draw();
    if (this.frame) return;
    this.frame = requestAnimationFrame(() => { this.frame = 0; this.render(); });
  }

  render() {
    const { clientWidth, clientHeight } = this.box;
    if (!this.isOpen || !this.camera || clientWidth < 2 || clientHeight < 2) return;
    // Whatever the ratio of the scene's camera, this one is made for the box.
    const camera = { ...this.camera, aspect: clientWidth / clientHeight };
    const settings = { ...this.settings, size: [Math.min(2000, clientWidth), Math.min(2000, clientHeight)], sampling: "center", channel: "color", camera, clock: this.settings.clock };
    if (this.kind === "walk" && this.accelerator) settings.accelerator = this.accelerator;
    const wanted = JSON.stringify(settings);
    if (wanted !== this.wanted) {
      this.wanted = wanted;
      this.link.send({ type: "picture", slot: "space", settings });
    }
    if (this.kind === "walk" && !this.walk && wanted === this.begun) this.askWalk();
  }

  begin(message) {
    this.film.begin(message);
    this.begun = this.wanted;
    if (this.kind === "walk") this.askWalk();
  }

  // The way through the accelerator of the picture in this slot, or in the main one.
  async askWalk() {
    const ray = this.pixel?.samples[this.sample]?.rays[0]?.ray;
    if (!ray) return;
    try {
      const walk = await this.link.ask({ type: "walk", slot: "space", ray: [ray.origin, ray.direction] });
      this.walk = walk;
      this.limit();
      this.showEvents();
      this.draw();
    } catch { /* the picture is not there yet */ }
  }

  showEvents() {
    const events = this.walk?.events ?? [];
    const shown = events.slice(0, 2000).map((event, index) => {
      const name = word(event.event);
      let text;
      if (event.event === "test") text = `${name} ${event.kind ?? ""}${event.name ? ` "${event.name}"` : ` #${event.element}`}: ${event.hit !== null ? `${word("hits")} t = ${number(event.hit, 5)}` : word("misses")}`;
      else {
        text = `${"  ".repeat(Math.min(event.level ?? 0, 20))}${name}${event.place?.index ? ` ${event.place.index.join(",")}` : ""}`;
        if (event.near !== undefined) text += ` t ${number(event.near, 4)} … ${number(event.far, 4)}`;
        if (event.exit) text += `, ${word("exit")} ${event.exit.face}${event.exit.region !== null ? `, ${word("region")} ${event.exit.region}` : ""}`;
      }
      return el("button", { type: "button", text, onclick: () => { this.at = index; this.draw(); } });
    });
    this.events.replaceChildren(...shown);
  }

  count() {
    return this.kind === "walk" ? this.walk?.events.length ?? 0 : this.steps?.length ?? 0;
  }

  step(by) {
    const count = this.count();
    if (!count || !this.isOpen) return;
    this.at = Math.max(0, Math.min(count - 1, this.at < 0 ? (by > 0 ? 0 : count - 1) : this.at + by));
    this.draw();
  }

  play() {
    if (!this.isOpen) return;
    if (this.timer) { this.stop(); return; }
    if (this.at < 0 || this.at >= this.count() - 1) this.at = 0;
    this.timer = setInterval(() => {
      if (this.at >= this.count() - 1) this.stop();
      else this.step(1);
    }, this.kind === "walk" ? 350 : 900);
    this.draw();
    this.refresh();
  }

  stop() {
    clearInterval(this.timer);
    this.timer = null;
    if (this.isOpen) this.refresh();
  }

  refresh() {
    this.box.closest(".panel-body")?.replaceWith(this.panel(this.kind));
  }

  // A point of the scene on the canvas; null behind the eye.
  project3(point) {
    const { u, v, ahead } = seen(this.camera, point);
    const { clientWidth: w, clientHeight: h } = this.box;
    return ahead ? [w / 2 + u * (h / 2), h / 2 - v * (h / 2)] : null;
  }

  draw() {
    if (!this.isOpen || !this.camera || !this.steps) return;
    const { clientWidth: w, clientHeight: h } = this.box;
    const ratio = window.devicePixelRatio || 1;
    this.over.width = Math.round(w * ratio);
    this.over.height = Math.round(h * ratio);
    const pen = this.over.getContext("2d");
    pen.scale(ratio, ratio);
    this.paint(pen);
  }

  // What is shown, as a file.
  svg() {
    if (!this.isOpen || !this.camera || !this.steps) return null;
    const pen = new SvgPen(this.box.clientWidth, this.box.clientHeight);
    pen.picture(this.film.canvas);
    this.paint(pen);
    return String(pen);
  }

  paint(pen) {
    const tools = drawing(pen, (point) => this.project3(point));
    drawEye(tools, this.picture, this.pixel.pixel, this.radius);
    if (this.kind === "walk") this.paintWalk(tools);
    else this.paintRays(tools);
  }

  paintRays(tools) {
    this.lights.paint(tools.pen, tools.project);
    drawRays(tools, this.steps, this.at);
    const step = this.steps[Math.max(0, this.at)];
    if (step?.ray.hit) drawVectors(tools, step.ray, this.radius * 0.22);
    const all = this.at < 0;
    this.say.replaceChildren(el("strong", { text: all ? `${this.steps.length} ${word("rays")}` : `${word("stepOf")} ${this.at + 1} ${word("of")} ${this.steps.length}` }),
      all ? this.legend() : el("div", { text: step.text }));
    if (!all) this.actions.onRay(step.id);
  }

  // The kinds of rays that are drawn, with their colours.
  legend() {
    const drawn = new Set(this.steps.map((step) => (step.blocked ? "blockedRay" : step.kind)));
    const kinds = ["primary", "reflection", "transparency", "shadow", "blockedRay"].filter((kind) => drawn.has(kind));
    return el("div", { class: "legend" }, ...kinds.map((kind) => el("span", { class: `ray-kind ${kind}`, text: word(kind) })));
  }

  paintWalk(tools) {
    const events = this.walk?.events ?? [];
    if (this.walk) drawWay(tools, this.walk, this.at, this.radius * 2);
    for (const button of this.events.querySelectorAll("[aria-current]")) button.removeAttribute("aria-current");
    if (this.at >= 0) {
      const button = this.events.children[this.at];
      button?.setAttribute("aria-current", "true");
      button?.scrollIntoView({ block: "nearest" });
    }
    if (this.walk) this.say.replaceChildren(el("strong", { text: this.walk.accelerator }), el("div", { text: `${this.walk.steps} ${word(this.walk.steps === 1 ? "stepOf" : "stepCount")}, ${this.walk.tests} ${word(this.walk.tests === 1 ? "test" : "testCount")}${this.at >= 0 ? ` · ${this.at + 1} / ${events.length}` : ""}` }));
  }
}
