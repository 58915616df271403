// The scene from outside, rendered by strahl, with the rays of a pixel drawn over it; and the way of its ray through the accelerator.

import { cross, dolly, inner, length, minus, pan, plus, scaled, seen, turn, unit } from "./camera.js";
import { el, number } from "./numbers.js";
import { Film } from "./film.js";
import { Gestures } from "./gestures.js";
import { SvgPen } from "./svg.js";
import { drawWay } from "./way.js";
import { word } from "./words.js";

const INK = { primary: "--primary", reflection: "--reflection", transparency: "--transparency", shadow: "--shadow" };

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
    this.sample = 0;
    this.at = -1;
    this.isOpen = false;
    this.accelerator = null;
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

  setScene(settings) {
    this.settings = settings;
    if (this.isOpen) this.render();
  }

  setPixel(pixel, picture) {
    const moved = this.picture?.own_camera && JSON.stringify(this.picture.own_camera) !== JSON.stringify(picture.own_camera);
    this.pixel = pixel;
    this.picture = picture;
    this.sample = 0;
    this.at = -1;
    this.walk = null;
    if (moved || !this.camera) this.camera = null;
    this.build();
    if (this.isOpen) this.opened();
  }

  setSample(index) {
    this.sample = index;
    this.at = -1;
    this.build();
    this.draw();
  }

  // The rays of the sample as lines, in the order of tracing.
  build() {
    const sample = this.pixel?.samples[this.sample];
    this.steps = [];
    if (!sample) return;
    const eye = this.picture.camera;
    const ends = sample.rays.filter((ray) => ray.hit).map((ray) => ray.hit.position);
    const points = [eye.eye, ...ends];
    const low = points.reduce((a, b) => a.map((v, i) => Math.min(v, b[i])));
    const high = points.reduce((a, b) => a.map((v, i) => Math.max(v, b[i])));
    this.radius = Math.max(1e-9, length(minus(high, low)) / 2);
    this.middle = scaled(plus(low, high), 0.5);
    for (const ray of sample.rays) {
      const direction = unit(ray.ray.direction);
      const end = ray.hit ? ray.hit.position : plus(ray.ray.origin, direction, this.radius * 0.7);
      const id = ray.id;
      this.steps.push({ kind: ray.kind, from: ray.ray.origin, to: end, open: !ray.hit, id, ray, text: `${word(ray.kind)} #${id}: ${ray.hit ? `${ray.hit.object}, t = ${number(ray.hit.t, 4)}` : word("background")}` });
      for (const light of ray.lights) {
        // Of an area light one ray stands for all.
        const shadows = light.shadow_rays.length > 8 ? light.shadow_rays.filter((_, i) => i % Math.ceil(light.shadow_rays.length / 8) === 0) : light.shadow_rays;
        for (const shadow of shadows) {
          const blocker = shadow.met.find((one) => one.blocks);
          const far = light.position === null || light.position === undefined;
          const t = blocker ? blocker.t : far ? (this.radius * 0.7) / (length(shadow.direction) || 1) : 1;
          this.steps.push({ kind: "shadow", from: shadow.origin, to: plus(shadow.origin, shadow.direction, t), blocked: Boolean(blocker), open: !blocker && far, id, ray,
            text: `${word("shadow")}: ${light.light}, ${blocker ? `${word("blocked")} ${blocker.object}` : word("visible")}` });
        }
      }
    }
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
      tools.append(select, button(word("table"), () => this.actions.table()));
    }
    return el("div", { class: "panel-body canvas" }, this.box, tools, this.say, kind === "walk" ? this.events : "");
  }

  opened() {
    this.isOpen = true;
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
    // In a box that is higher than wide, from further away.
    const { clientWidth, clientHeight } = this.box;
    const narrow = clientWidth > 0 && clientHeight > 0 ? Math.min(1, clientWidth / clientHeight) : 1;
    const eye = plus(this.middle, from, (this.radius * 3.2) / narrow);
    const direction = scaled(from, -1);
    const right = scaled(unit(cross(direction, up)), hand);
    const top = unit(cross(scaled(right, hand), direction));
    this.camera = { eye, direction, right: scaled(right, 0.42), up: scaled(top, 0.42), orthographic: false };
  }

  // Goes near what the step is about, without turning; without a step, to where everything is seen.
  near() {
    const target = this.target();
    if (!target) {
      this.build();
      this.outside();
      this.go(this.camera);
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
    this.render();
    this.draw();
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

  light(id) {
    this.lit = id;
    this.draw();
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
    const style = getComputedStyle(document.documentElement);
    const ink = (name) => style.getPropertyValue(name).trim();
    const line = (from, to, color, width, dash = []) => {
      const [a, b] = this.clip(from, to);
      if (!a || !b) return;
      pen.setLineDash(dash);
      for (const [paint, wide] of [["rgb(0 0 0 / 55%)", width + 2], [color, width]]) {
        pen.strokeStyle = paint;
        pen.lineWidth = wide;
        pen.beginPath();
        pen.moveTo(...a);
        pen.lineTo(...b);
        pen.stroke();
      }
      pen.setLineDash([]);
    };
    const arrow = (from, to, color, width) => {
      line(from, to, color, width);
      const [a, b] = this.clip(from, to);
      if (!a || !b || Math.hypot(b[0] - a[0], b[1] - a[1]) < 8) return;
      const angle = Math.atan2(b[1] - a[1], b[0] - a[0]);
      pen.fillStyle = color;
      pen.beginPath();
      pen.moveTo(...b);
      for (const side of [2.7, -2.7]) pen.lineTo(b[0] + 9 * Math.cos(angle + side), b[1] + 9 * Math.sin(angle + side));
      pen.fill();
    };
    const label = (point, text, color) => {
      const at = this.project3(point);
      if (!at) return;
      pen.font = "600 12px system-ui, sans-serif";
      pen.lineWidth = 3;
      pen.strokeStyle = "rgb(0 0 0 / 75%)";
      pen.strokeText(text, at[0] + 5, at[1] - 5);
      pen.fillStyle = color;
      pen.fillText(text, at[0] + 5, at[1] - 5);
    };
    this.drawEye(line, label);
    if (this.kind === "space") this.lights.paint(pen, (point) => this.project3(point));
    if (this.kind === "walk") this.drawWalk(pen, line, label);
    else {
      const last = this.at < 0 ? this.steps.length - 1 : this.at;
      this.steps.forEach((step, index) => {
        if (index > last) return;
        const now = index === this.at;
        const color = step.kind === "shadow" ? (step.blocked ? "#ff6b5e" : "#ffe08a") : ink(INK[step.kind]);
        const width = now || step.id === this.lit ? 3 : step.kind === "shadow" ? 1.2 : 2;
        if (step.kind === "shadow") line(step.from, step.to, color, width, [5, 4]);
        else if (step.open) arrow(step.from, step.to, color, width);
        else line(step.from, step.to, color, width);
      });
      const step = this.steps[last];
      const hit = (this.at < 0 ? this.steps[0] : step)?.ray.hit;
      if (hit) this.drawVectors(this.at < 0 ? this.steps[0].ray : step.ray, arrow, label);
      this.say.replaceChildren(el("strong", { text: this.at < 0 ? `${this.steps.length} ${word("rays")}` : `${word("stepOf")} ${this.at + 1} ${word("of")} ${this.steps.length}` }), el("div", { text: this.at < 0 ? "" : step.text }));
      if (this.at >= 0) this.actions.onRay(step.id);
    }
  }

  // The part of a line before the eye, on the canvas.
  clip(from, to) {
    let [a, b] = [this.project3(from), this.project3(to)];
    if (a && b) return [a, b];
    if (!a && !b) return [null, null];
    let [near, far] = a ? [from, to] : [to, from];
    for (let i = 0; i < 24; i += 1) {
      const half = scaled(plus(near, far), 0.5);
      if (this.project3(half)) near = half; else far = half;
    }
    if (a) b = this.project3(near); else a = this.project3(near);
    return [a, b];
  }

  // The eye, the image plane and the pixel.
  drawEye(line, label) {
    const { eye, direction, right, up, orthographic } = this.picture.camera;
    if (orthographic === null || orthographic === undefined) return;
    const aspect = this.picture.aspect ?? this.picture.width / this.picture.height;
    const size = (this.radius * 0.28) / (orthographic ? 1 : length(direction));
    const grow = orthographic ? 1 : size;
    const corner = (x, y) => plus(plus(plus(eye, direction, size), right, x * aspect * grow), up, y * grow);
    const corners = [corner(-1, 1), corner(1, 1), corner(1, -1), corner(-1, -1)];
    corners.forEach((one, i) => {
      line(one, corners[(i + 1) % 4], "#e8e8e8", 1);
      if (!orthographic) line(eye, one, "rgb(232 232 232 / 55%)", 0.8);
    });
    const [x, y] = this.pixel.pixel;
    const at = (dx, dy) => corner((2 * (x + dx)) / this.picture.width - 1, 1 - (2 * (y + dy)) / this.picture.height);
    const spot = [at(-1, -1), at(2, -1), at(2, 2), at(-1, 2)];
    spot.forEach((one, i) => line(one, spot[(i + 1) % 4], "#ffb648", 1.5));
    label(orthographic ? corner(0, 0) : eye, orthographic ? "" : "eye", "#fff");
  }

  drawVectors(ray, arrow, label) {
    const { position, shading_normal: n } = ray.hit;
    const size = this.radius * 0.22;
    const v = scaled(unit(ray.ray.direction), -1);
    const show = (name, vector, color) => {
      const end = plus(position, unit(vector), size);
      arrow(position, end, color, 1.8);
      label(end, name, color);
    };
    show("n", n, "#ffffff");
    show("v", v, "#b7c8ff");
    const light = ray.lights.find((one) => one.l && one.n_dot_l > 0);
    if (light) {
      show("l", light.l, "#ffe08a");
      const half = plus(light.l, v);
      if (length(half) > 1e-9) show("h", half, "#c6f0a8");
      show("r", plus(scaled(n, 2 * inner(n, light.l)), light.l, -1), "#f2a65a");
    }
    if (ray.hit.cos_theta2 !== null && ray.hit.kt.some((c) => c > 0)) {
      const ratio = ray.hit.n1 / ray.hit.n2;
      show("t", plus(scaled(v, -ratio), n, ratio * ray.hit.cos_theta1 - ray.hit.cos_theta2), "#63d0bd");
    }
  }

  drawWalk(pen, line, label) {
    const events = this.walk?.events ?? [];
    if (this.walk) drawWay({ pen, line, label, project: (point) => this.project3(point) }, this.walk, this.at, this.radius * 2);
    for (const button of this.events.querySelectorAll("[aria-current]")) button.removeAttribute("aria-current");
    if (this.at >= 0) {
      const button = this.events.children[this.at];
      button?.setAttribute("aria-current", "true");
      button?.scrollIntoView({ block: "nearest" });
    }
    if (this.walk) this.say.replaceChildren(el("strong", { text: this.walk.accelerator }), el("div", { text: `${this.walk.steps} ${word(this.walk.steps === 1 ? "stepOf" : "stepCount")}, ${this.walk.tests} ${word(this.walk.tests === 1 ? "test" : "testCount")}${this.at >= 0 ? ` · ${word("stepOf")} ${this.at + 1} ${word("of")} ${events.length}` : ""}` }));
  }
}
