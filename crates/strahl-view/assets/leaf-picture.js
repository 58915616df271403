// A picture that needs no server: every pixel has its object and its line, and some have their ray trees.

import { linesOf } from "./lines.js";
import { el } from "./numbers.js";
import { showPixel } from "./tree.js";
import { setLanguage, word } from "./words.js";

setLanguage(document.documentElement.lang);
const picture = JSON.parse(document.getElementById("data").textContent);
const { width, height, objects, trees } = picture;

// The number of the object plus one of each pixel; 0 is the background.
const seenAt = new Uint32Array(width * height);
let filled = 0;
for (let i = 0; i < picture.runs.length; i += 2) {
  seenAt.fill(picture.runs[i + 1], filled, filled + picture.runs[i]);
  filled += picture.runs[i];
}

const image = el("img", { src: picture.png, width, height, alt: word("picture"), tabindex: "0" });
// Small pictures are shown larger, in whole steps.
if (width < 320) {
  image.style.width = `${width * Math.floor(640 / width)}px`;
  image.style.imageRendering = "pixelated";
}
const over = el("canvas", { width, height });
const said = el("output", {});
const texts = el("div", { class: "texts", tabindex: "0", role: "region", "aria-label": word("texts") },
  ...picture.files.flatMap(({ name, text }) => [el("h2", { title: name, text: name.split(/[\\/]/).pop() }), el("div", { "data-file": name }, ...linesOf(text.text, text.pieces))]));
const known = el("div", { class: "known", tabindex: "0", role: "region", "aria-label": word("tree") });
const main = document.getElementById("leaf");
main.append(el("h1", { text: main.dataset.title }), el("div", { class: "seen" }, el("div", { class: "frame" }, image, over), said, texts), known);
texts.hidden = picture.files.length === 0;

let shown = null;
let under = null;

function lineOf(file, line) {
  const box = [...texts.querySelectorAll("[data-file]")].find((one) => one.dataset.file === file);
  return box?.querySelector(`[data-line="${line}"]`) ?? null;
}

function markLine(file, line, scroll) {
  texts.querySelector(".under")?.classList.remove("under");
  const row = lineOf(file, line);
  row?.classList.add("under");
  if (scroll) row?.scrollIntoView({ block: "center" });
}

function pixelAt(event) {
  const box = image.getBoundingClientRect();
  const x = Math.floor(((event.clientX - box.left) * width) / box.width);
  const y = Math.floor(((event.clientY - box.top) * height) / box.height);
  return x >= 0 && y >= 0 && x < width && y < height ? [x, y] : null;
}

// The pixel with a tree that is nearest, of the same object if there is one.
function nearest([x, y]) {
  const object = seenAt[y * width + x];
  let best = null;
  for (const tree of trees) {
    const [a, b] = tree.pixel;
    const away = (a - x) ** 2 + (b - y) ** 2;
    const alike = seenAt[b * width + a] === object;
    if (!best || alike > best.alike || (alike === best.alike && away < best.away)) best = { tree, alike, away };
  }
  return best?.tree ?? null;
}

function draw() {
  const pen = over.getContext("2d");
  const unit = Math.max(1, width / Math.max(1, image.clientWidth));
  pen.clearRect(0, 0, width, height);
  if (under) {
    for (const { pixel: [a, b] } of trees) {
      pen.fillStyle = "rgb(0 0 0 / 60%)";
      pen.fillRect(a - 1.5 * unit + 0.5, b - 1.5 * unit + 0.5, 3 * unit, 3 * unit);
      pen.fillStyle = "#ffb648";
      pen.fillRect(a - 0.8 * unit + 0.5, b - 0.8 * unit + 0.5, 1.6 * unit, 1.6 * unit);
    }
  }
  if (!shown) return;
  const [a, b] = shown;
  for (const [color, wide] of [["rgb(0 0 0 / 80%)", 3.5], ["#ffb648", 1.5]]) {
    pen.strokeStyle = color;
    pen.lineWidth = wide * unit;
    pen.strokeRect(a - 5 * unit + 0.5, b - 5 * unit + 0.5, 10 * unit, 10 * unit);
  }
}

function tell(at) {
  under = at;
  draw();
  if (!at) {
    said.textContent = `${trees.length} ${word("treesHere")}`;
    return;
  }
  const [x, y] = at;
  const object = seenAt[y * width + x];
  const found = object ? objects[object - 1] : null;
  said.textContent = `${x}, ${y} · ${found ? found.name : word("background")}${found?.line ? ` · ${found.file.split(/[\\/]/).pop()}:${found.line}` : ""}`;
  markLine(found?.file, found?.line, false);
}

function show(tree, at) {
  shown = tree.pixel;
  const same = tree.pixel[0] === at[0] && tree.pixel[1] === at[1];
  const onPlace = (file, line) => markLine(file, line, true);
  const note = same ? "" : el("p", { class: "dim", text: `${word("pixelAt")} ${tree.pixel.join(", ")}, ${word("nearest")}.` });
  known.replaceChildren(note, showPixel(tree, { onPlace }));
  const object = seenAt[tree.pixel[1] * width + tree.pixel[0]];
  const found = object ? objects[object - 1] : null;
  if (found?.line) markLine(found.file, found.line, true);
  draw();
}

image.addEventListener("pointermove", (event) => tell(pixelAt(event)));
image.addEventListener("pointerleave", () => tell(null));
image.addEventListener("click", (event) => {
  const at = pixelAt(event);
  const tree = at && nearest(at);
  if (tree) show(tree, at);
});
// The trees one after the other with the arrow keys.
image.addEventListener("keydown", (event) => {
  const by = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 }[event.key];
  if (!by || !trees.length) return;
  event.preventDefault();
  const index = trees.findIndex((one) => shown && one.pixel[0] === shown[0] && one.pixel[1] === shown[1]);
  const tree = trees[(index + by + trees.length) % trees.length];
  show(tree, tree.pixel);
  tell(tree.pixel);
});
tell(null);
if (trees.length) show(trees[0], trees[0].pixel);
