// The page: puts the parts together, and passes on what the server says.

import { showBar } from "./bar.js";
import { length, minus } from "./camera.js";
import { Code } from "./code.js";
import { closeMenus, find, toast } from "./controls.js";
import { help, showTable } from "./dialogs.js";
import { listen, splits } from "./keys.js";
import { Lights } from "./lights.js";
import { Link } from "./link.js";
import { el, number, triple } from "./numbers.js";
import { showProblems, warningsButton } from "./problems.js";
import { saving } from "./saving.js";
import { Space } from "./space.js";
import { Stage } from "./stage.js";
import { COUNTS, forget, keep, keepNow, plain, recall, settings, state } from "./state.js";
import { Timeline } from "./timeline.js";
import { showPixel } from "./tree.js";
import { getLanguage, setLanguage, word } from "./words.js";

// What the parts of the page know of each other. `looked` has the pixels whose trees were looked at, for a page with the picture.
const page = {
  hello: null, scene: null, current: null, explained: null, looked: [], set, pick, toggle,
  actions: {
    open: openScene, camera: turnCamera, lights: showLights, reset, compare: toggleCompare,
    theme: toggleTheme, language: toggleLanguage, help, unmark,
  },
};
// The camera as the scene has it.
let own = null;

const link = new Link({
  hello(message) { page.hello = message; start(); },
  scene: showScene,
  picture: begin,
  done: finish,
  scale(message) { if (message.slot === "main" && stage.film.done) { stage.film.done.scale = message.scale; status(null); } },
  error: refused,
  binary: receive,
  lost() {
    find("status").replaceChildren(el("span", { class: "mouse", text: word("lost") }));
    document.body.classList.add("lost");
  },
  again() {
    if (code.tried.size) sessionStorage.setItem("tried", JSON.stringify([...code.tried]));
    keepNow();
    location.reload();
  },
});

const lights = new Lights({
  change: (light, position) => move({ lights: { ...(mover.wanted?.lights ?? state.lights), [light]: position } }),
  reset: () => { mover.wanted = null; set({ lights: null }); lights.set(page.scene?.stats?.placed, null); stage.draw(); space.draw(); },
  copy: (light) => page.actions.copyLight(light),
  place: (file, line) => showPlace(file, line),
  draw: () => { stage.draw(); space.draw(); },
});

const stage = new Stage(find("stage"), lights, {
  pick, hover,
  leave: () => { hover.next = null; status(null); code.setUnder(...placeOfPixel()); },
  camera: (camera) => move({ camera: plain(camera) }),
  current: () => {
    const camera = mover.wanted?.camera ?? state.camera ?? page.current?.camera;
    return camera && page.current ? { ...camera, pole: own?.up, distance: reach() } : null;
  },
  pivot: async (x, y) => (await link.ask({ type: "hover", slot: "main", x, y })).seen?.position ?? null,
  values: (region) => link.send({ type: "linear", slot: "main", region }),
  // Before there is a picture, the address is right.
  shown: (values) => { if (page.current) { Object.assign(state, values); keep(); } },
});

const code = new Code(find("code"), {
  source: (file) => link.ask({ type: "source", file }),
  pieces: (text) => link.ask({ type: "pieces", text }),
  pick: markLine,
  changed: (file, text) => link.send({ type: "text", file, text }),
  save: async (file, text) => {
    try {
      await link.ask({ type: "save", file, text });
      code.saved();
      toast(word("saved"));
    } catch (problem) { toast(problem.message); }
  },
  open: (file, line) => link.ask({ type: "edit", file, line }).catch((problem) => toast(problem.message)),
});

const timeline = new Timeline(find("timeline"), (clock) => { state.clock = clock; show(); });

const space = new Space(link, lights, { onRay: markRay, toast, table: () => showTable(link), svg: (text) => text && page.actions.svg(text, "rays") });
Object.assign(page, { stage, code, space, lights, timeline });
Object.assign(page.actions, saving(page, link));
stage.box.append(lights.panel);
listen(page);
splits();
document.addEventListener("pointerdown", (event) => closeMenus(event.target));
// Somebody has put another link into the address of this page.
window.addEventListener("hashchange", () => location.reload());

function start() {
  recall();
  const { hello } = page;
  if (hello.scenes?.includes(state.scene)) link.send({ type: "open", scene: state.scene });
  code.setOptions(hello);
  space.accelerators = [...hello.accelerators];
  if (state.panel !== "tree") space.kind = state.panel;
  stage.split = state.split;
  label();
  showBar(page);
  showInspector();
  status(null);
  show();
}

// What a screen reader calls the parts of the page.
function label() {
  const names = { code: "scene", stage: "picture", inspector: "inspector", picture: "picture", side: "otherPicture", space: "space" };
  for (const [id, key] of Object.entries(names)) (find(id) ?? space.film.canvas).setAttribute("aria-label", word(key));
  for (const [id, key] of [["code", "scene"], ["inspector", "inspector"]]) find(`split-${id}`).setAttribute("aria-label", `${word("width")}: ${word(key)}`);
}

// The server says no. If that is so from the beginning, the address asks for something that doesn't exist, and the page begins without it.
function refused({ message, slot }) {
  toast(message);
  if (slot !== "main" || page.current || refused.once) return;
  refused.once = true;
  forget();
  set({});
}

// The texts that were tried when the connection was lost.
function retry(files) {
  const kept = JSON.parse(sessionStorage.getItem("tried") ?? "[]");
  sessionStorage.removeItem("tried");
  for (const [file, text] of kept) {
    if (!files.some((one) => one.name === file)) continue;
    code.tried.set(file, text);
    link.send({ type: "text", file, text });
  }
}

// How far the scene is from the eye, where no point is known.
function reach() {
  const { scene, current } = page;
  if (!scene?.stats || !current) return 5;
  const middle = scene.stats.low.map((v, i) => (v + scene.stats.high[i]) / 2);
  const away = length(minus(middle, current.camera.eye));
  return Number.isFinite(away) && away > 0 ? away : 5;
}

// Asks for the pictures of the state.
function show() {
  keep();
  link.send({ type: "picture", slot: "main", settings: settings() });
  if (state.compare) link.send({ type: "picture", slot: "side", settings: { ...settings(), ...state.compare } });
  else link.send({ type: "close", slot: "side" });
  stage.compare(Boolean(state.compare), Boolean(state.beside));
  space.setScene(settings());
}

function set(values) {
  Object.assign(state, values);
  show();
  showBar(page);
}

// Movements of the camera and of lights go to the server one after the other: the next one when the first rows of the last one are there.
const mover = { busy: false, wanted: null, timer: 0 };

function move(values) {
  mover.wanted = { ...mover.wanted, ...values };
  stage.draw();
  if (mover.busy) return;
  mover.busy = true;
  requestAnimationFrame(() => {
    Object.assign(state, mover.wanted);
    mover.wanted = null;
    show();
    if (!find("reset")) showBar(page);
  });
  clearTimeout(mover.timer);
  mover.timer = setTimeout(moved, 1500);
}

function moved() {
  mover.busy = false;
  if (mover.wanted) move({});
}

function openScene(name) {
  mover.wanted = null;
  Object.assign(state, { scene: name, camera: null, lights: null, pixel: null, zoom: null, outside: null });
  space.rest();
  Object.assign(page, { explained: null, current: null });
  Object.assign(stage, { picked: null, fitted: true });
  page.looked = [];
  code.forget();
  link.send({ type: "open", scene: name });
  showInspector();
  set({});
}

function reset() {
  mover.wanted = null;
  mover.busy = false;
  lights.set(page.scene?.stats?.placed, null);
  set({ camera: null, lights: null });
}

// The second picture has something else of what is looked at: where counts are shown, those of another accelerator beside them.
function toggleCompare() {
  if (state.compare) set({ compare: null });
  else if (COUNTS.includes(state.channel)) set({ compare: { accelerator: page.scene?.stats?.accelerator === "grid" ? "bvh" : "grid" }, beside: true });
  else set({ compare: { depth: 1 } });
}

function turnCamera() {
  if (lights.on) lights.toggle();
  stage.turning = !stage.turning;
  showTools();
}

function showLights() {
  stage.turning = false;
  lights.toggle();
  showTools();
}

function showTools() {
  stage.box.classList.toggle("turning", stage.turning || lights.on);
  stage.draw();
  space.draw();
  showBar(page);
}

function showScene(message) {
  if (message.slot !== "main") return;
  const first = page.scene === null;
  page.scene = message;
  document.title = `${message.name.split(/[\\/]/).pop()} · strahl`;
  if (!message.loading || message.number !== null) {
    problems();
    if (message.number !== null) retry(message.files);
    code.setFiles(message.files, message.number);
    code.setSaid(message.said);
  }
  if (message.stats) lights.set(message.stats.placed, mover.wanted?.lights ?? state.lights);
  if (first || message.stats) showBar(page);
  status(null);
}

function problems() {
  showProblems(page.scene?.said ?? [], stage.box, { kept: Boolean(page.current), show: showPlace });
}

function showPlace(file, line) {
  if (find("code").hidden) toggle("code");
  code.show(file, line);
}

function begin(message) {
  if (message.slot === "space") { space.begin(message); return; }
  if (message.slot === "side") { stage.side.begin(message); stage.place(); return; }
  const before = page.current;
  page.current = message;
  own = message.own_camera;
  const resized = stage.film.begin(message);
  if (!before && state.zoom) stage.look(state.zoom);
  else if (resized && (stage.fitted || !before)) stage.fit();
  stage.film.area = 0;
  stage.setMarks(null);
  stage.progress.style.opacity = "1";
  stage.progress.style.width = "4%";
  for (const [id, value] of [["depth", message.depth], ["cutoff", Number(message.cutoff.toPrecision(2))]]) if (find(id)) find(id).placeholder = value;
  status(null);
  if (state.pixel && !mover.busy) explain();
}

function receive(head, bytes) {
  const films = [stage.film, stage.side, space.film].filter((one) => one.number === head.picture && one.message);
  if (head.kind === 1) {
    // Two slots may show one picture.
    for (const one of films) one.part(head, bytes);
    if (films.includes(stage.film)) progress(head);
    if (films.includes(space.film)) space.draw();
  } else if (head.kind === 2 && head.picture === stage.film.number) {
    stage.setLinear([head.x, head.y, head.width, head.height], new Float32Array(bytes));
  } else if (head.kind === 3 && head.picture === stage.film.number && markLine.file) {
    stage.setMarks(bytes, head.width, head.height);
    code.setMarked(markLine.file, head.extra);
  }
}

function progress({ width, height, step }) {
  const { film } = stage;
  film.area += (width * height) / (step * step);
  stage.progress.style.width = `${Math.min(96, 4 + (92 * film.area) / (stage.width * stage.height * 1.35))}%`;
  if (mover.busy && film.shown >= Math.min(4, Math.ceil((stage.width * stage.height) / 65536))) moved();
}

function finish(message) {
  for (const one of [stage.film, stage.side, space.film]) if (one.number === message.picture) one.finished = true;
  if (message.slot !== "main") return;
  stage.film.done = message;
  stage.progress.style.width = "100%";
  stage.progress.style.opacity = "0";
  moved();
  // Not while the camera moves.
  if (!mover.busy && state.pixel && explain.of !== message.picture) explain();
  timeline.finished();
  document.body.dataset.finished = message.sha256;
  status(null);
  stage.draw();
}

const counted = (count, one, many) => `${count.toLocaleString(getLanguage())} ${word(count === 1 ? one : many)}`;

// The last line: what is under the mouse, and how the picture is getting on.
function status(seen) {
  const { hello, scene, current } = page;
  const left = el("span", { class: "mouse", id: "mouse" });
  if (seen) {
    const { x, y, rgb8, linear, seen: hit } = seen;
    left.append(`${x}, ${y}   ${rgb8.join(" ")}   ${triple(linear, 4)}   `);
    if (hit) left.append(`${hit.object}${hit.line ? ` · ${word("line")} ${hit.line}` : ""} · t ${number(hit.t, 5)}`);
    else left.append(word("background"));
  }
  const right = el("span", { id: "state" });
  const { film } = stage;
  if (!hello) right.textContent = word("waiting");
  else if (scene?.loading) right.textContent = word("loading");
  else if (!current) right.textContent = "";
  else if (film.finished && film.done) {
    const { rays, seconds, scale } = film.done;
    right.textContent = `${current.width} × ${current.height} · ${rays.toLocaleString(getLanguage())} ${word("rays")} · ${number(seconds, 3)} s`;
    if (COUNTS.includes(state.channel)) right.textContent += ` · 0 … ${number(scale, 4)}${state.channel === "time" ? " µs" : ""}`;
  } else right.textContent = `${current.width} × ${current.height} · ${word("rendering")} …`;
  showHeat(film.finished ? film.done?.scale : null);
  const stats = scene?.stats ? el("span", { class: "stats", text: `${counted(scene.stats.primitives, "oneObject", "objects")} · ${counted(scene.stats.lights, "oneLight", "lightCount")} · ${scene.stats.accelerator}` }) : "";
  find("status").replaceChildren(left, el("span", { class: "gap" }), warningsButton(scene?.said ?? [], () => { problems(); status(null); }), stats, right);
}

// What the colours of counts mean, once their scale is known.
function showHeat(scale) {
  const box = find("heat") ?? stage.box.appendChild(el("div", { id: "heat", hidden: true }));
  const counts = COUNTS.includes(state.channel);
  if (!counts) box.hidden = true;
  if (!counts || scale === null || scale === undefined) return;
  box.hidden = false;
  const unit = state.channel === "time" ? "µs" : word(state.channel === "rays" ? "rayCount" : state.channel);
  box.replaceChildren("0", el("span", { class: "scale", "aria-hidden": "true" }), `${number(scale, 4)} ${unit}`);
}

// One question at a time; the last place of the mouse counts.
async function hover(x, y) {
  hover.next = [x, y];
  if (hover.asking) return;
  hover.asking = true;
  while (hover.next) {
    const [ax, ay] = hover.next;
    try {
      const seen = await link.ask({ type: "hover", slot: "main", x: ax, y: ay });
      if (hover.next) {
        status(seen);
        code.setUnder(seen.seen?.file ?? null, seen.seen?.line ?? null);
        code.rest();
      }
    } catch { /* the picture has changed meanwhile */ }
    if (hover.next && hover.next[0] === ax && hover.next[1] === ay) break;
  }
  hover.asking = false;
}

function pick(x, y) {
  state.pixel = [x, y];
  stage.picked = [x, y];
  page.looked = [...page.looked.filter(([a, b]) => a !== x || b !== y), [x, y]].slice(-100);
  stage.draw();
  space.rest();
  if (find("inspector").hidden) toggle("inspector");
  explain();
}

async function explain() {
  const { current } = page;
  if (!state.pixel || !current) return;
  const [x, y] = state.pixel;
  if (x >= current.width || y >= current.height) return;
  stage.picked = [x, y];
  stage.draw();
  const asked = (explain.count = (explain.count ?? 0) + 1);
  explain.of = current.picture;
  try {
    const pixel = await link.ask({ type: "explain", slot: "main", x, y });
    if (asked !== explain.count) return;
    const moved = page.explained?.pixel.join() !== pixel.pixel.join();
    page.explained = pixel;
    space.setPixel(pixel, current);
    showInspector();
    // The text goes there, unless somebody is writing.
    if (moved && !code.writing) code.show(...placeOfPixel());
  } catch (problem) {
    if (asked === explain.count) toast(problem.message);
  }
}

// File and line of what the picked pixel shows.
function placeOfPixel() {
  const match = /^(.*?):(\d+)(?::\d+)?$/.exec(page.explained?.samples[0]?.rays[0].hit?.source ?? "");
  return match ? [match[1], Number(match[2])] : [null, null];
}

function showInspector() {
  const box = find("inspector");
  const { explained } = page;
  const tab = (name, title) => el("button", {
    type: "button", class: "tab", role: "tab", id: `tab-${name}`, "aria-selected": String(state.panel === name), text: title,
    onclick: () => { state.panel = name; keep(); showInspector(); },
  });
  const tabs = el("div", { class: "tabs", role: "tablist" }, tab("tree", word("tree")), tab("space", word("space")), tab("walk", word("accelerator")));
  let body;
  if (!explained) body = el("div", { class: "panel-body" }, el("p", { class: "dim", text: word("noPixel") }));
  else if (state.panel === "tree") {
    body = el("div", { class: "panel-body" }, showPixel(explained, {
      onPlace: showPlace,
      onRay: (ray) => stage.showRay(ray),
      onSample: (index) => space.setSample(index),
    }, space.sample), el("p", {}, el("button", { type: "button", class: "tool", id: "export", text: word("export"), onclick: page.actions.pixel }), " ",
      el("button", { type: "button", class: "tool", id: "export-svg", text: word("treeSvg"), onclick: page.actions.tree })));
  } else body = space.panel(state.panel);
  box.replaceChildren(tabs, body);
  stage.showRay(null);
  if (explained && state.panel !== "tree") space.opened();
  else space.closed();
}

function markRay(id) {
  for (const one of document.querySelectorAll("#inspector .marked")) one.classList.remove("marked");
  document.querySelector(`#inspector [data-node="${id}"] > details > summary`)?.classList.add("marked");
}

function unmark() {
  markLine.file = null;
  stage.setMarks(null);
  code.setMarked(null, null);
}

async function markLine(file, line) {
  markLine.file = file;
  try {
    await link.ask({ type: "mark", slot: "main", file, line });
  } catch (problem) { toast(problem.message); }
}

function toggle(id) {
  const box = find(id);
  box.hidden = !box.hidden;
  find(`split-${id}`).hidden = box.hidden;
  if (id === "inspector" && !box.hidden) showInspector();
}

function toggleTheme() {
  const theme = document.documentElement.dataset.theme === "dark" ? "light" : "dark";
  document.documentElement.dataset.theme = theme;
  localStorage.setItem("theme", theme);
  space.draw();
}

function toggleLanguage() {
  setLanguage(getLanguage() === "en" ? "de" : "en");
  localStorage.setItem("language", getLanguage());
  keep();
  timeline.clear();
  label();
  showBar(page);
  code.showTabs();
  code.showTools();
  lights.show();
  showInspector();
  problems();
  status(null);
}
