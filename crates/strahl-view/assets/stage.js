// The picture: move, zoom, pick pixels, turn the camera, drag lights.

import { dolly, length, pan, plus, seen, turn } from "./camera.js";
import { el, number } from "./numbers.js";
import { Film } from "./film.js";
import { Gestures } from "./gestures.js";
import { drawing, rayColor } from "./rays.js";
import { word } from "./words.js";

export class Stage {
  // `actions`: pick(x, y), hover(x, y), leave(), camera(camera), current() -> the camera, values(region), pivot(x, y) -> promise of a point or null,
  // shown({ zoom, split }) after a change of them.
  constructor(box, lights, actions) {
    this.box = box;
    this.lights = lights;
    this.actions = actions;
    this.film = new Film("picture");
    this.side = new Film("side");
    this.side.canvas.hidden = true;
    this.over = el("canvas", { id: "over" });
    this.swipe = el("div", { id: "swipe", role: "slider", tabindex: "0", "aria-valuemin": "0", "aria-valuemax": "100", hidden: true });
    this.progress = el("div", { id: "progress" });
    box.append(this.film.canvas, this.side.canvas, this.over, this.swipe, this.progress);
    this.scale = 1;
    this.left = 0;
    this.top = 0;
    this.fitted = true;
    this.split = 0.5;
    this.turning = false;
    this.beside = false;
    this.picked = null;
    this.marks = null;
    this.ray = null;
    this.linear = null;
    new ResizeObserver(() => { if (this.fitted) this.fit(); else this.zoomed(); }).observe(box);
    this.gestures = new Gestures(box, {
      accepts: (event) => this.isPicture(event),
      start: (event) => this.start(event),
      drag: (event, dx, dy) => this.drag(event, dx, dy),
      pinch: (factor, x, y, dx, dy) => this.pinch(factor, x, y, dx, dy),
      tap: (event) => this.tap(event),
      hover: (event) => {
        const at = this.isPicture(event) ? this.pixelAt(event) : null;
        if (at) actions.hover(...at); else actions.leave();
      },
      leave: () => actions.leave(),
    });
    box.addEventListener("wheel", (event) => this.wheel(event), { passive: false });
    this.swipe.addEventListener("pointerdown", (event) => { event.stopPropagation(); this.swipe.setPointerCapture(event.pointerId); this.swiping = true; });
    this.swipe.addEventListener("pointermove", (event) => { if (this.swiping) this.swipeTo(event.clientX); });
    this.swipe.addEventListener("pointerup", () => { this.swiping = false; });
    this.swipe.addEventListener("keydown", (event) => {
      const by = { ArrowLeft: -0.02, ArrowRight: 0.02 }[event.key];
      if (by) { event.preventDefault(); event.stopPropagation(); this.splitAt(this.split + by); }
    });
  }

  get width() { return this.film.canvas.width; }
  get height() { return this.film.canvas.height; }

  fit() {
    this.fitted = true;
    const { clientWidth, clientHeight } = this.box;
    const most = Math.min((clientWidth / (this.beside ? 2 : 1) - 24) / this.width, (clientHeight - 24) / this.height);
    this.scale = most > 1 ? Math.max(1, Math.floor(most * 4) / 4) : most;
    this.left = Math.round((clientWidth / (this.beside ? 2 : 1) - this.width * this.scale) / 2);
    this.top = Math.round((clientHeight - this.height * this.scale) / 2);
    this.zoomed();
  }

  // Shows a part of the picture: the scale, and the column and row in the middle.
  look([scale, x, y]) {
    this.fitted = false;
    this.scale = Math.min(256, Math.max(0.05, scale));
    const [middleX, middleY] = this.middle;
    this.left = middleX - x * this.scale;
    this.top = middleY - y * this.scale;
    this.zoomed();
  }

  // The middle of the place that the first picture has.
  get middle() { return [this.box.clientWidth / (this.beside ? 4 : 2), this.box.clientHeight / 2]; }

  // The part of the picture that is shown, for `look`.
  get part() {
    const [x, y] = this.middle;
    return [this.scale, (x - this.left) / this.scale, (y - this.top) / this.scale];
  }

  // Another part of the picture is shown.
  zoomed() {
    this.actions.shown({ zoom: this.fitted ? null : this.part.map((one) => Number(one.toPrecision(5))) });
    this.place();
  }

  zoomTo(scale, x = this.box.clientWidth / 2, y = this.box.clientHeight / 2) {
    this.fitted = false;
    const clamped = Math.min(256, Math.max(0.05, scale));
    this.left = x - ((x - this.left) * clamped) / this.scale;
    this.top = y - ((y - this.top) * clamped) / this.scale;
    this.scale = clamped;
    this.zoomed();
  }

  place() {
    const half = this.box.clientWidth / 2;
    for (const canvas of [this.film.canvas, this.side.canvas]) {
      const left = this.left + (this.beside && canvas === this.side.canvas ? half : 0);
      canvas.style.transform = `translate(${left}px, ${this.top}px) scale(${this.scale * (this.width / canvas.width)})`;
      canvas.classList.toggle("pixels", this.scale > 1.5);
    }
    const line = this.left + this.split * this.width * this.scale;
    this.swipe.style.left = `${line}px`;
    this.swipe.setAttribute("aria-valuenow", Math.round(100 * this.split));
    this.swipe.setAttribute("aria-label", word("swipe"));
    const cut = this.swipe.hidden ? 0 : this.split * this.side.canvas.width;
    this.side.canvas.style.clipPath = `inset(0 0 0 ${cut}px)`;
    this.film.canvas.style.clipPath = "";
    if (this.beside) {
      // Each picture stays in its half.
      const over = Math.max(0, this.width - (half - this.left) / this.scale);
      this.film.canvas.style.clipPath = `inset(0 ${over}px 0 0)`;
      this.side.canvas.style.clipPath = `inset(0 0 0 ${Math.max(0, ((-this.left / this.scale) * this.side.canvas.width) / this.width)}px)`;
    }
    this.draw();
  }

  swipeTo(clientX) {
    const x = clientX - this.box.getBoundingClientRect().left;
    this.splitAt((x - this.left) / (this.width * this.scale));
  }

  // Moves the line between two pictures, to a part of their width.
  splitAt(part) {
    this.split = Number(Math.min(1, Math.max(0, part)).toFixed(4));
    this.actions.shown({ split: this.split });
    this.place();
  }

  // Shows the second picture: under a line to drag, or beside the first.
  compare(on, beside) {
    this.swipe.hidden = !on || beside;
    this.side.canvas.hidden = !on;
    const { part } = this;
    const changed = this.beside !== (on && beside);
    this.beside = on && beside;
    if (!changed) this.place();
    else if (this.fitted) this.fit();
    else this.look(part);
  }

  // A column of the box, counted from the left edge of the picture that is there.
  column(clientX) {
    const x = clientX - this.box.getBoundingClientRect().left;
    const half = this.box.clientWidth / 2;
    return this.beside && x >= half ? x - half : x;
  }

  pixelAt(event) {
    const box = this.box.getBoundingClientRect();
    const x = Math.floor((this.column(event.clientX) - this.left) / this.scale);
    const y = Math.floor((event.clientY - box.top - this.top) / this.scale);
    return x >= 0 && y >= 0 && x < this.width && y < this.height ? [x, y] : null;
  }

  isPicture(event) {
    return event.target === this.box || event.target.classList.contains("film");
  }

  start(event) {
    this.button = event.button;
    this.pivot = null;
    if (this.lights.on) {
      const near = this.lights.at(...this.local(event), (point) => this.project(point), event.pointerType === "mouse" ? 16 : 28);
      this.holds = near !== null;
      if (near !== null) this.lights.choose(near);
    } else if (this.turns(event)) {
      const at = this.pixelAt(event);
      if (at) this.actions.pivot(...at).then((point) => { this.pivot = point; }, () => {});
    }
  }

  // A place of the window in the box.
  local({ clientX, clientY }) {
    const { left, top } = this.box.getBoundingClientRect();
    return [clientX - left, clientY - top];
  }

  turns(event) {
    return this.turning !== event.altKey;
  }

  drag(event, dx, dy) {
    if (this.lights.on && !event.altKey) {
      const camera = this.camera();
      if (camera) this.lights.drag(camera, ((2 * dx) / (this.width * this.scale)) * this.aspect, (-2 * dy) / (this.height * this.scale));
    } else if (this.turns(event)) {
      const shift = event.shiftKey || this.button === 2 || this.button === 1;
      this.moveCamera((camera) => (shift ? this.panned(camera, dx, dy) : turn(camera, this.pivot, (-dx / this.size) * 3, (-dy / this.size) * 3)));
    } else this.shift(dx, dy);
  }

  // Two fingers: move and spread.
  pinch(factor, x, y, dx, dy) {
    if (this.lights.on) {
      const camera = this.camera();
      if (camera) this.lights.push(camera, factor);
    } else if (this.turning) this.moveCamera((camera) => dolly(this.panned(camera, dx, dy), this.pivot, 1 / factor));
    else {
      this.shift(dx, dy);
      const { top } = this.box.getBoundingClientRect();
      this.zoomTo(this.scale * factor, this.column(x), y - top);
    }
  }

  shift(dx, dy) {
    this.fitted = false;
    this.left += dx;
    this.top += dy;
    this.zoomed();
  }

  tap(event) {
    if (this.lights.on && this.holds) return;
    const at = this.pixelAt(event);
    if (!at) return;
    // A finger doesn't hover.
    if (event.pointerType !== "mouse") this.actions.hover(...at);
    this.actions.pick(...at);
  }

  // The height of the picture on the screen.
  get size() { return this.height * this.scale; }

  panned(camera, dx, dy) {
    return pan(camera, this.pivot, dx / this.size, dy / this.size, this.width / this.height);
  }

  moveCamera(change) {
    const camera = this.actions.current();
    if (camera) this.actions.camera(change(camera));
  }

  // The camera, if it is one whose rays are straight lines to a plane.
  camera() {
    const camera = this.actions.current();
    return camera && typeof camera.orthographic === "boolean" ? camera : null;
  }

  get aspect() { return this.film.message?.aspect ?? this.width / this.height; }

  // Where a point of the scene is in the box; null if it is not to be seen.
  project(point) {
    const camera = this.camera();
    if (!camera) return null;
    const { u, v, ahead } = seen(camera, point);
    return ahead ? [this.left + ((u / this.aspect + 1) / 2) * this.width * this.scale, this.top + ((1 - v) / 2) * this.size] : null;
  }

  wheel(event) {
    if (!this.isPicture(event)) return;
    event.preventDefault();
    const lines = event.deltaMode === 1 ? event.deltaY * 30 : event.deltaY;
    if (this.lights.on && !event.altKey) {
      const camera = this.camera();
      if (camera) this.lights.push(camera, Math.exp(-lines * 0.0012));
    } else if (this.turns(event)) this.moveCamera((camera) => dolly(camera, this.pivot, Math.exp(lines * 0.0012)));
    else {
      const { top } = this.box.getBoundingClientRect();
      this.zoomTo(this.scale * Math.exp(-lines * 0.0018), this.column(event.clientX), event.clientY - top);
    }
  }

  // Marks, the pixel that was picked, and the values of pixels that are large enough.
  draw() {
    const { clientWidth, clientHeight } = this.box;
    const ratio = window.devicePixelRatio || 1;
    if (this.over.width !== Math.round(clientWidth * ratio) || this.over.height !== Math.round(clientHeight * ratio)) {
      this.over.width = Math.round(clientWidth * ratio);
      this.over.height = Math.round(clientHeight * ratio);
    }
    const pen = this.over.getContext("2d");
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.clearRect(0, 0, clientWidth, clientHeight);
    if (this.marks) {
      pen.imageSmoothingEnabled = this.scale < 1;
      pen.drawImage(this.marks, this.left, this.top, this.width * this.scale, this.height * this.scale);
    }
    if (this.scale >= 64) this.drawValues(pen, clientWidth, clientHeight);
    if (this.ray) this.drawRay(pen);
    if (this.lights.on) this.lights.paint(pen, (point) => this.project(point));
    if (this.picked) {
      const [x, y] = this.picked;
      const size = Math.max(this.scale, 9);
      const half = clientWidth / 2;
      for (const from of this.beside ? [0, half] : [0]) {
        const middle = [from + this.left + (x + 0.5) * this.scale, this.top + (y + 0.5) * this.scale];
        if (this.beside && (middle[0] < from || middle[0] > from + half)) continue;
        for (const [color, width] of [["rgb(0 0 0 / 80%)", 3.5], ["#ffb648", 1.5]]) {
          pen.strokeStyle = color;
          pen.lineWidth = width;
          pen.strokeRect(middle[0] - size / 2, middle[1] - size / 2, size, size);
        }
      }
    }
  }

  // What the values of a region are known by.
  keyOf(region) {
    return `${this.film.number}:${this.film.finished}:${region}`;
  }

  drawValues(pen, width, height) {
    const low = [Math.max(0, Math.floor(-this.left / this.scale)), Math.max(0, Math.floor(-this.top / this.scale))];
    const high = [Math.min(this.width, Math.ceil((width - this.left) / this.scale)), Math.min(this.height, Math.ceil((height - this.top) / this.scale))];
    const region = [low[0], low[1], high[0] - low[0], high[1] - low[1]];
    if (region[2] <= 0 || region[3] <= 0) return;
    const key = this.keyOf(region);
    if (this.linear?.key !== key) {
      if (this.asked !== key) {
        this.asked = key;
        this.actions.values(region);
      }
      return;
    }
    pen.font = `${Math.min(13, this.scale / 6.5)}px ui-monospace, Menlo, Consolas, "DejaVu Sans Mono", monospace`;
    pen.textAlign = "center";
    pen.textBaseline = "middle";
    for (let y = 0; y < region[3]; y += 1) {
      for (let x = 0; x < region[2]; x += 1) {
        const at = 3 * (y * region[2] + x);
        const color = [...this.linear.values.slice(at, at + 3)];
        pen.fillStyle = 0.2 * color[0] + 0.7 * color[1] + 0.1 * color[2] > 0.2 ? "#000" : "#fff";
        color.forEach((c, i) => {
          pen.fillText(number(c, 3), this.left + (low[0] + x + 0.5) * this.scale, this.top + (low[1] + y + 0.5) * this.scale + (i - 1) * this.scale * 0.23);
        });
      }
    }
  }

  setLinear(region, values) {
    this.linear = { key: this.keyOf(region), values };
    this.draw();
  }

  // Draws a ray of the pixel over the picture; null draws none.
  showRay(ray) {
    if (this.ray === ray) return;
    this.ray = ray;
    this.draw();
  }

  drawRay(pen) {
    if (!this.camera()) return;
    const { line, label } = drawing(pen, (point) => this.project(point));
    const { kind, hit, ray: { origin, direction } } = this.ray;
    const color = rayColor(kind);
    const end = hit?.position ?? plus(origin, direction, 1e4 / length(direction));
    if (kind !== "primary") line(origin, end, color, 2);
    if (hit) label(end, hit.object, color);
  }

  setMarks(bytes, width, height) {
    if (!bytes) {
      this.marks = null;
      this.draw();
      return;
    }
    const codes = new Uint8Array(bytes);
    const canvas = el("canvas", { width, height });
    const context = canvas.getContext("2d");
    const image = context.createImageData(width, height);
    const pixels = new Uint32Array(image.data.buffer);
    for (let i = 0; i < pixels.length; i += 1) {
      if (!codes[i]) {
        pixels[i] = 0x8c101010;
        continue;
      }
      const x = i % width;
      const edge = x === 0 || x === width - 1 || !codes[i - 1] || !codes[i + 1] || !codes[i - width] || !codes[i + width];
      if (edge) pixels[i] = 0xff48b6ff;
    }
    context.putImageData(image, 0, 0);
    this.marks = canvas;
    this.draw();
  }
}
