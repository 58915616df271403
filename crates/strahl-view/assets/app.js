// The page: puts the parts together and keeps their state.

import { Code } from "./code.js";
import { Link } from "./link.js";
import { Space } from "./space.js";
import { Stage } from "./stage.js";
import { Timeline } from "./timeline.js";
import { el, number, triple } from "./numbers.js";
import { length, minus } from "./camera.js";
import { treeSvg } from "./svg.js";
import { showPixel } from "./tree.js";
import { getLanguage, setLanguage, word } from "./words.js";

const find = (id) => document.getElementById(id);
const COUNTS = ["levels", "tests", "steps", "rays", "time"];
const CHANNELS = ["color", "normal", "depth", "object", "material", ...COUNTS];

// What a link to this page keeps.
const state = {
  scene: null, size: null, sampling: null, depth: null, cutoff: null, shading: null, accelerator: null, camera: null, clock: null,
  exposure: 0, curve: "srgb", channel: "color", pixel: null, compare: null, beside: null, panel: "tree",
};
// What a link leaves out, because it is so without it.
const USUAL = { exposure: 0, curve: "srgb", channel: "color", panel: "tree" };
const CURVES = ["srgb", "reinhard", "filmic"];
let hello = null;
let own = null;
let scene = null;
let current = null;
let explained = null;
let wantedCamera = null;
let cameraBusy = false;
let hovering = false;
let nextHover = null;

const link = new Link({
  hello(message) { hello = message; start(); },
  scene(message) { showScene(message); },
  picture(message) { begin(message); },
  done(message) { finish(message); },
  scale(message) { if (message.slot === "main" && stage.film.done) { stage.film.done.scale = message.scale; status(null); } },
  error(message) { toast(message.message); },
  binary(head, bytes) { receive(head, bytes); },
  lost() { find("status").replaceChildren(el("span", { class: "mouse", text: word("lost") })); document.body.classList.add("lost"); },
});

const stage = new Stage(find("stage"), {
  pick: (x, y) => pick(x, y),
  hover: (x, y) => hover(x, y),
  leave: () => { nextHover = null; status(null); code.setUnder(null, null); },
  camera: (camera) => moveTo(camera),
  current: () => (wantedCamera ?? current?.camera ? { ...(wantedCamera ?? current.camera), pole: own?.up, distance: reach() } : null),
  middle: () => null,
  pivot: async (x, y) => (await link.ask({ type: "hover", slot: "main", x, y })).seen?.position ?? null,
  values: (region) => link.send({ type: "linear", slot: "main", region }),
});

const code = new Code(find("code"), {
  source: (file) => link.ask({ type: "source", file }),
  pieces: (text) => link.ask({ type: "pieces", text }),
  pick: (file, line) => markLine(file, line),
  changed: (text) => link.send({ type: "text", text }),
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

const space = new Space(link, { onRay: (id) => markRay(id), toast, table: () => showTable(), svg: (text) => text && saveSvg(text, "rays") });

// How far the scene is from the eye, where no point is known.
function reach() {
  if (!scene?.stats || !current) return 5;
  const middle = scene.stats.low.map((v, i) => (v + scene.stats.high[i]) / 2);
  const away = length(minus(middle, current.camera.eye));
  return Number.isFinite(away) && away > 0 ? away : 5;
}

function toast(text) {
  const box = find("toast");
  box.textContent = text;
  box.classList.add("shown");
  clearTimeout(toast.timer);
  toast.timer = setTimeout(() => box.classList.remove("shown"), 3500);
}

// The address keeps the state, so that a link shows the same.
function keep() {
  const words = new URLSearchParams();
  for (const [key, value] of Object.entries(state)) {
    if (value === null || value === USUAL[key]) continue;
    words.set(key, typeof value === "object" ? JSON.stringify(value) : value);
  }
  if (getLanguage() !== "en") words.set("language", getLanguage());
  const hash = words.toString();
  history.replaceState(null, "", location.pathname + location.search + (hash ? `#${hash}` : ""));
}

function recall() {
  const words = new URLSearchParams(location.hash.slice(1));
  const read = (key, parse) => {
    if (!words.has(key)) return;
    try {
      const value = parse(words.get(key));
      if (!(typeof value === "number" && !Number.isFinite(value))) state[key] = value;
    } catch { /* an address that somebody has changed */ }
  };
  for (const key of ["scene", "sampling", "shading", "accelerator", "panel"]) read(key, String);
  for (const key of ["depth", "cutoff", "exposure", "clock"]) read(key, Number);
  for (const key of ["size", "camera", "pixel", "compare", "beside"]) read(key, JSON.parse);
  if (CURVES.includes(words.get("curve"))) state.curve = words.get("curve");
  if (CHANNELS.includes(words.get("channel"))) state.channel = words.get("channel");
  setLanguage(words.get("language") ?? localStorage.getItem("language") ?? (navigator.language.startsWith("de") ? "de" : "en"));
  const theme = localStorage.getItem("theme") ?? (matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light");
  document.documentElement.dataset.theme = theme;
}

function settings() {
  const { size, sampling, depth, cutoff, shading, accelerator, camera, clock, exposure, curve, channel } = state;
  return { size, sampling, depth, cutoff, shading, accelerator, camera: camera ? plain(camera) : null, clock, exposure, curve, channel };
}

// The numbers of a camera, without what belongs to the page.
function plain({ eye, direction, right, up, orthographic }) {
  return { eye, direction, right, up, orthographic: orthographic ?? null };
}

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
  showBar();
}

// Cameras are sent one after the other: the next one when the first rows of the last one are there.
function moveTo(camera) {
  wantedCamera = camera;
  if (cameraBusy) return;
  cameraBusy = true;
  requestAnimationFrame(() => {
    state.camera = plain(wantedCamera);
    show();
    if (!find("reset")) showBar();
  });
  clearTimeout(moveTo.timer);
  moveTo.timer = setTimeout(() => { cameraBusy = false; }, 1500);
}

function start() {
  recall();
  if (hello.scenes && state.scene && hello.scenes.includes(state.scene)) link.send({ type: "open", scene: state.scene });
  code.setOptions(hello);
  space.accelerators = [...hello.accelerators];
  showBar();
  showInspector();
  status(null);
  show();
}

function showScene(message) {
  if (message.slot !== "main") return;
  const first = scene === null;
  scene = message;
  document.title = `${message.name.split(/[\\/]/).pop()} · strahl`;
  if (!message.loading || message.number !== null) {
    showProblems(message.said ?? []);
    code.setFiles(message.files, message.number);
    code.setSaid(message.said);
  }
  if (first || message.stats) showBar();
  status(null);
}

let warningsShown = false;

function showProblems(said) {
  const box = find("problems") ?? stage.box.appendChild(el("div", { id: "problems", role: "alert" }));
  const errors = said.filter((one) => one.severity === "error");
  const shown = [...errors.slice(0, 20), ...(warningsShown ? said.filter((one) => one.severity === "warning") : [])];
  box.hidden = shown.length === 0;
  box.classList.toggle("mild", errors.length === 0);
  box.replaceChildren(...shown.map((one) => {
    const where = one.file ? `${one.file}${one.line ? `:${one.line}` : ""}${one.column ? `:${one.column}` : ""}` : "";
    const text = one.text !== null && one.caret ? el("pre", {}, `${one.text.replace(/[\x00-\x1f]/g, " ")}\n${" ".repeat(Math.max(0, one.caret[0] - 1))}`, el("span", { class: "caret", text: "^".repeat(one.caret[1]) })) : null;
    return el("div", { class: "problem" },
      el("div", { class: `message ${one.severity}`, text: `${word(one.severity)}: ${one.message}` }),
      where && el("button", { type: "button", class: "place", text: where, onclick: () => code.show(one.file, one.line) }),
      text,
      ...one.trace.map((step) => el("div", { class: "dim", text: step })),
      ...one.help.map((help) => el("div", { text: help })));
  }), errors.length && current ? el("p", { class: "dim", text: word("lastGood") }) : "");
}

function begin(message) {
  if (message.slot === "space") { space.begin(message); return; }
  if (message.slot === "side") { stage.side.begin(message); stage.place(); return; }
  const before = current;
  current = message;
  own = message.own_camera;
  const resized = stage.film.begin(message);
  if (resized && (stage.fitted || !before)) stage.fit();
  stage.film.started = performance.now();
  stage.setMarks(null);
  stage.progress.style.opacity = "1";
  stage.progress.style.width = "4%";
  for (const [id, value] of [["depth", message.depth], ["cutoff", Number(message.cutoff.toPrecision(2))]]) if (find(id)) find(id).placeholder = value;
  status(null);
  if (state.pixel && !cameraBusy) explain();
}

function receive(head, bytes) {
  const film = [stage.film, stage.side, space.film].find((one) => one.number === head.picture && one.message);
  if (head.kind === 1 && film) {
    // Two slots may show one picture.
    for (const one of [stage.film, stage.side, space.film]) if (one.number === head.picture) one.part(head, bytes);
    if (film === stage.film) {
      film.area = (film.area ?? 0) + (head.width * head.height) / (head.step * head.step);
      stage.progress.style.width = `${Math.min(96, 4 + (92 * film.area) / (stage.width * stage.height * 1.35))}%`;
      if (cameraBusy && film.shown >= Math.min(4, Math.ceil((stage.width * stage.height) / 65536))) {
        cameraBusy = false;
        if (wantedCamera && JSON.stringify(plain(wantedCamera)) !== JSON.stringify(state.camera)) moveTo(wantedCamera);
      }
    }
    if (film === space.film) space.draw();
  } else if (head.kind === 2 && head.picture === stage.film.number) {
    stage.setLinear([head.x, head.y, head.width, head.height], new Float32Array(bytes));
  } else if (head.kind === 3 && head.picture === stage.film.number) {
    stage.setMarks(bytes, head.width, head.height);
    code.setMarked(markLine.file, head.extra);
  }
}

function finish(message) {
  for (const one of [stage.film, stage.side, space.film]) if (one.number === message.picture) one.finished = true;
  if (message.slot === "space") return;
  if (message.slot === "side") return;
  stage.film.area = 0;
  stage.film.done = message;
  stage.progress.style.width = "100%";
  stage.progress.style.opacity = "0";
  cameraBusy = false;
  timeline.finished();
  document.body.dataset.finished = message.sha256;
  status(null);
  stage.draw();
}

function status(seen) {
  const bar = find("status");
  const left = el("span", { class: "mouse", id: "mouse" });
  if (seen) {
    const { x, y, rgb8, linear, seen: hit } = seen;
    left.append(`${x}, ${y}   ${rgb8.join(" ")}   ${triple(linear, 4)}   `);
    if (hit) left.append(`${hit.object}${hit.line ? ` · ${word("line")} ${hit.line}` : ""} · t ${number(hit.t, 5)}`);
    else left.append(word("background"));
  }
  const right = el("span", { id: "state" });
  const film = stage.film;
  if (!hello) right.textContent = word("waiting");
  else if (scene?.loading) right.textContent = word("loading");
  else if (!current) right.textContent = "";
  else if (film.finished && film.done) {
    const { rays, seconds, scale } = film.done;
    right.textContent = `${current.width} × ${current.height} · ${rays.toLocaleString(getLanguage())} ${word("rays")} · ${number(seconds, 3)} s`;
    if (COUNTS.includes(state.channel)) right.textContent += ` · 0 … ${number(scale, 4)}${state.channel === "time" ? " µs" : ""}`;
  } else right.textContent = `${current.width} × ${current.height} · ${word("rendering")} …`;
  const stats = scene?.stats ? el("span", { text: `${scene.stats.primitives.toLocaleString(getLanguage())} ${word("objects")} · ${scene.stats.lights} ${word("lights")} · ${scene.stats.accelerator}` }) : "";
  const warnings = scene?.said?.filter((one) => one.severity === "warning") ?? [];
  const warned = warnings.length ? el("button", { type: "button", class: "warned", id: "warnings", "aria-pressed": String(warningsShown), title: warnings.map((one) => one.message).join("\n"), text: `⚠ ${warnings.length} ${word(warnings.length === 1 ? "warning" : "warnings")}`,
    onclick: () => { warningsShown = !warningsShown; showProblems(scene.said); status(null); } }) : "";
  bar.replaceChildren(left, el("span", { class: "gap" }), warned, stats, right);
}

// One question at a time; the last place of the mouse counts.
async function hover(x, y) {
  nextHover = [x, y];
  if (hovering) return;
  hovering = true;
  while (nextHover) {
    const [ax, ay] = nextHover;
    try {
      const seen = await link.ask({ type: "hover", slot: "main", x: ax, y: ay });
      if (nextHover) {
        status(seen);
        code.setUnder(seen.seen?.file ?? null, seen.seen?.line ?? null);
      }
    } catch { /* the picture has changed meanwhile */ }
    if (nextHover && nextHover[0] === ax && nextHover[1] === ay) break;
  }
  hovering = false;
}

function pick(x, y) {
  state.pixel = [x, y];
  stage.picked = [x, y];
  stage.draw();
  keep();
  if (find("inspector").hidden) toggle("inspector");
  explain();
}

async function explain() {
  if (!state.pixel || !current) return;
  const [x, y] = state.pixel;
  if (x >= current.width || y >= current.height) return;
  stage.picked = [x, y];
  stage.draw();
  const asked = (explain.count = (explain.count ?? 0) + 1);
  try {
    const pixel = await link.ask({ type: "explain", slot: "main", x, y });
    if (asked !== explain.count) return;
    explained = pixel;
    space.setPixel(pixel, current);
    showInspector();
  } catch (problem) {
    if (asked === explain.count) toast(problem.message);
  }
}

function showInspector() {
  const box = find("inspector");
  const tab = (name, title) => el("button", {
    type: "button", class: "tab", role: "tab", id: `tab-${name}`, "aria-selected": String(state.panel === name), text: title,
    onclick: () => { state.panel = name; keep(); showInspector(); },
  });
  const tabs = el("div", { class: "tabs", role: "tablist" }, tab("tree", word("tree")), tab("space", word("space")), tab("walk", word("accelerator")), el("span", { class: "gap" }));
  let body;
  if (!explained) body = el("div", { class: "panel-body" }, el("p", { class: "dim", text: word("noPixel") }));
  else if (state.panel === "tree") {
    body = el("div", { class: "panel-body" }, showPixel(explained, {
      onPlace: (file, line) => { if (find("code").hidden) toggle("code"); code.show(file, line); },
      onRay: (ray) => space.light(ray.id),
      onSample: (index) => space.setSample(index),
    }), el("p", {}, el("button", { type: "button", class: "tool", id: "export", text: word("export"), onclick: exportPixel }), " ",
      el("button", { type: "button", class: "tool", id: "export-svg", text: word("treeSvg"), onclick: exportTree })));
  } else body = space.panel(state.panel);
  box.replaceChildren(tabs, body);
  if (explained && state.panel !== "tree") space.opened();
  else space.closed();
}

function markRay(id) {
  for (const one of document.querySelectorAll("#inspector .marked")) one.classList.remove("marked");
  document.querySelector(`#inspector [data-node="${id}"] > details > summary`)?.classList.add("marked");
}

async function exportPixel() {
  const [x, y] = state.pixel;
  try {
    const { html } = await link.ask({ type: "export", slot: "main", x, y, language: getLanguage() });
    download(new Blob([html], { type: "text/html" }), `pixel-${x}-${y}.html`);
  } catch (problem) { toast(problem.message); }
}

function exportTree() {
  const ink = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  const colors = { primary: ink("--primary"), reflection: ink("--reflection"), transparency: ink("--transparency") };
  const [x, y] = explained.pixel;
  saveSvg(treeSvg(explained.samples[space.sample] ?? explained.samples[0], `${scene.name.split(/[\\/]/).pop()}, ${word("pixel")} ${x}, ${y}`, colors), "tree");
}

function saveSvg(text, what) {
  download(new Blob([text], { type: "image/svg+xml" }), `${what}-${explained.pixel.join("-")}.svg`);
}

function download(blob, name) {
  const anchor = el("a", { href: URL.createObjectURL(blob), download: name });
  anchor.click();
  setTimeout(() => URL.revokeObjectURL(anchor.href), 10000);
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

function choose(name, title, values, value, change) {
  const select = el("select", { id: name, "aria-label": title ? null : word(name), onchange: () => change(select.value) }, ...values.map(([key, text]) => el("option", { value: key, text, selected: key === value })));
  return el("label", { class: "control" }, title, select);
}

function counted(name, title, value, attributes, change) {
  const input = el("input", { type: "number", id: name, ...attributes, onchange: () => change(input.value === "" ? null : Number(input.value)) });
  input.value = value ?? "";
  return el("label", { class: "control" }, title, input);
}

function tool(name, text, title, action, pressed = null) {
  return el("button", { type: "button", class: "tool", id: name, title, "aria-label": /^\w+$/.test(text) && !title.includes(text) ? `${text}: ${title}` : title, "aria-pressed": pressed === null ? null : String(pressed), text, onclick: action });
}

function samplings() {
  return [["", word("own")], ["center", "1"], ["2x2", "2 × 2"], ["3x3", "3 × 3"], ["5x5", "5 × 5"], ["adaptive", "adaptive"], ["recursive:0.3,3", "recursive"], ["corners", "corners"]];
}

function showBar() {
  document.documentElement.lang = getLanguage();
  const name = scene?.name ?? "";
  const scenes = hello?.scenes
    ? choose("scene", "", hello.scenes.map((one) => [one, one.replace(/\.pov$/, "")]), name, (value) => {
      state.scene = value; state.camera = null; wantedCamera = null; state.pixel = null; explained = null; stage.picked = null; current = null; stage.fitted = true;
      link.send({ type: "open", scene: value }); showInspector(); set({});
    })
    : el("span", { class: "file", title: name, text: name });
  const channels = CHANNELS.map((one) => [one, word(one === "rays" ? "rayCount" : one)]);
  const file = name.split(/[\\/]/).pop().replace(/\.[^.]*$/, "");
  find("bar").replaceChildren(
    el("span", { class: "brand", text: "strahl" }), scenes,
    choose("channel", word("channel"), channels, state.channel, (value) => set({ channel: value })),
    choose("sampling", word("sampling"), samplings(), state.sampling ?? "", (value) => set({ sampling: value || null })),
    counted("depth", word("maxDepth"), state.depth, { min: 1, max: 1000, placeholder: current ? String(current.depth) : "" }, (value) => set({ depth: value })),
    counted("exposure", word("exposure"), state.exposure, { step: 0.5, min: -20, max: 20 }, (value) => set({ exposure: value ?? 0 })),
    menu("more", word("more"),
      choose("curve", word("curve"), CURVES.map((one) => [one, word(one)]), state.curve, (value) => set({ curve: value })),
      choose("shading", word("shading"), [["", word("own")], ...(hello?.shading ?? []).map((one) => [one, one])], state.shading ?? "", (value) => set({ shading: value || null })),
      choose("accelerator", word("accelerator"), [["", word("own")], ...(hello?.accelerators ?? []).map((one) => [one, one])], state.accelerator ?? "", (value) => set({ accelerator: value || null })),
      counted("cutoff", word("cutoff"), state.cutoff, { min: 0, max: 1, step: "any", placeholder: current ? String(Number(current.cutoff.toPrecision(2))) : "" }, (value) => set({ cutoff: value })),
      counted("clock", word("clock"), state.clock, { step: 0.05 }, (value) => set({ clock: value }))),
    el("span", { class: "gap" }),
    tool("camera", word("camera"), `${word("camera")} (C)`, () => { stage.turning = !stage.turning; stage.box.classList.toggle("turning", stage.turning); showBar(); }, stage.turning),
    state.camera ? tool("reset", word("resetCamera"), `${word("resetCamera")} (R)`, resetCamera) : "",
    tool("compare", word("compare"), `${word("compare")} (X)`, toggleCompare, Boolean(state.compare)),
    menu("save-menu", word("save"),
      tool("png", word("savePng"), word("savePng"), () => stage.film.canvas.toBlob((blob) => download(blob, `${file}.png`))),
      tool("exr", word("saveExr"), word("saveExr"), () => saveExr(`${file}.exr`)),
      tool("copy", word("copyCamera"), word("copyCamera"), copyCamera)),
    tool("theme", "◐", `${word("theme")} (T)`, toggleTheme),
    tool("language", getLanguage() === "en" ? "DE" : "EN", `${word("language")} (L)`, toggleLanguage),
    tool("help-button", "?", `${word("help")} (?)`, help));
  timeline.show(scene?.clock || state.clock !== null, state.clock);
  showSide();
}

// A part of the bar that opens on a click, and stays open when the bar is made again.
function menu(id, title, ...content) {
  const box = el("details", { class: "menu", id },
    el("summary", { class: "tool", text: title }), el("div", { class: "menu-body" }, ...content));
  box.open = find(id)?.open ?? false;
  return box;
}

document.addEventListener("pointerdown", (event) => {
  for (const one of document.querySelectorAll("details.menu[open]")) if (!one.contains(event.target)) one.open = false;
});

async function saveExr(name) {
  const answer = await fetch(`picture/${current.picture}.exr`);
  if (answer.ok) download(await answer.blob(), name);
  else toast(await answer.text());
}

function showSide() {
  const box = find("side-panel") ?? stage.box.appendChild(el("div", { id: "side-panel" }));
  box.hidden = !state.compare;
  if (!state.compare) return;
  const change = (values) => { state.compare = { ...state.compare, ...values }; show(); showBar(); };
  box.replaceChildren(
    el("strong", { text: word("settingsOf") }),
    choose("side-view", word("view"), [["", word("swipe")], ["beside", word("beside")]], state.beside ? "beside" : "", (value) => set({ beside: value ? true : null })),
    choose("side-channel", word("channel"), CHANNELS.map((one) => [one, word(one === "rays" ? "rayCount" : one)]), state.compare.channel ?? state.channel, (value) => change({ channel: value })),
    choose("side-accelerator", word("accelerator"), [["", word("own")], ...hello.accelerators.map((one) => [one, one])], state.compare.accelerator ?? "", (value) => change({ accelerator: value || null })),
    choose("side-shading", word("shading"), [["", word("own")], ...hello.shading.map((one) => [one, one])], state.compare.shading ?? "", (value) => change({ shading: value || null })),
    choose("side-sampling", word("sampling"), samplings(), state.compare.sampling ?? "", (value) => change({ sampling: value || null })),
    counted("side-depth", word("maxDepth"), state.compare.depth, { min: 1, max: 1000 }, (value) => change({ depth: value })));
}

function toggleCompare() {
  set({ compare: state.compare ? null : { depth: 1 } });
}

function resetCamera() {
  wantedCamera = null;
  cameraBusy = false;
  set({ camera: null });
}

async function copyCamera() {
  try {
    const { text } = await link.ask({ type: "camera_text", slot: "main" });
    await copy(text);
    toast(`${word("copied")}: ${text.split("\n")[2].trim()}`);
  } catch (problem) { toast(problem.message); }
}

async function copy(text) {
  window.copiedText = text;
  if (navigator.clipboard) await navigator.clipboard.writeText(text).catch(() => {});
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
  showBar();
  code.showTools();
  showInspector();
  showProblems(scene?.said ?? []);
  timeline.clear();
  showBar();
  status(null);
}

function help() {
  const box = find("help");
  if (box.open) { box.close(); return; }
  box.replaceChildren(el("h2", { text: word("helpTitle") }), el("dl", {}, ...word("helpList").flatMap(([key, text]) => [el("dt", { text: key }), el("dd", { text })])),
    el("p", {}, el("button", { type: "button", class: "tool", text: word("close"), onclick: () => box.close() })));
  box.showModal();
}

// What the picture costs with each accelerator.
async function showTable() {
  const box = find("table");
  const close = el("p", {}, el("button", { type: "button", class: "tool", text: word("close"), onclick: () => box.close() }));
  box.replaceChildren(el("h2", { text: word("tableTitle") }), el("p", { class: "dim", text: word("measuring") }), close);
  box.showModal();
  try {
    const { width, height, rows } = await link.ask({ type: "table", slot: "main" });
    const count = (value) => value.toLocaleString(getLanguage());
    const same = rows.every((row) => row.sha256 === rows[0].sha256);
    const head = ["accelerator", "build", "seconds", "rayCount", "stepsPerRay", "testsPerRay"];
    box.replaceChildren(el("h2", { text: word("tableTitle") }),
      el("table", { class: "figures" }, el("thead", {}, el("tr", {}, ...head.map((key) => el("th", { scope: "col", text: word(key) })))),
        el("tbody", {}, ...rows.map((row) => el("tr", {}, el("th", { scope: "row", text: row.name }),
          ...[`${number(row.build, 3)} s`, `${number(row.seconds, 3)} s`, count(row.rays), number(row.steps / Math.max(1, row.rays), 4), number(row.tests / Math.max(1, row.rays), 4)].map((text) => el("td", { text })))))),
      el("p", { class: "dim", text: `${width} × ${height} · ${word(same ? "samePictures" : "otherPictures")}` }), close);
  } catch (problem) {
    box.close();
    toast(problem.message);
  }
}

function toggleChannel(name) {
  set({ channel: state.channel === name ? "color" : name });
}

document.addEventListener("keydown", (event) => {
  if (event.ctrlKey || event.metaKey || event.altKey || /^(INPUT|TEXTAREA|SELECT)$/.test(event.target.tagName)) return;
  // An open dialog has its own keys: Escape closes it.
  if (document.querySelector("dialog[open]") && event.key !== "?") return;
  const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
  if (step && state.pixel && current && !event.target.closest("#code")) {
    event.preventDefault();
    const [x, y] = [state.pixel[0] + step[0], state.pixel[1] + step[1]];
    if (x >= 0 && y >= 0 && x < current.width && y < current.height) pick(x, y);
    return;
  }
  const action = {
    c: () => find("camera").click(), r: resetCamera, f: () => stage.fit(), 1: () => stage.zoomTo(1), "+": () => set({ exposure: state.exposure + 0.5 }), "-": () => set({ exposure: state.exposure - 0.5 }),
    n: () => toggleChannel("normal"), d: () => toggleChannel("depth"), o: () => toggleChannel("object"), m: () => toggleChannel("material"), x: toggleCompare,
    s: () => toggle("code"), i: () => toggle("inspector"), t: toggleTheme, l: toggleLanguage, "?": help, ",": () => space.step(-1), ".": () => space.step(1),
    Escape: () => { for (const one of document.querySelectorAll("details.menu[open]")) one.open = false; stage.setMarks(null); code.setMarked(null, null); },
  }[event.key.length === 1 ? event.key.toLowerCase() : event.key];
  if (event.key === " " && event.target.tagName !== "BUTTON" && event.target.tagName !== "SUMMARY") {
    event.preventDefault();
    space.play();
  } else if (action) {
    event.preventDefault();
    action();
  }
});

for (const [id, side] of [["code", 1], ["inspector", -1]]) {
  const split = find(`split-${id}`);
  split.addEventListener("pointerdown", (event) => { split.setPointerCapture(event.pointerId); split.dataset.drag = "1"; });
  split.addEventListener("pointerup", () => delete split.dataset.drag);
  split.addEventListener("pointermove", (event) => {
    if (!split.dataset.drag) return;
    const box = find(id).getBoundingClientRect();
    const width = side > 0 ? event.clientX - box.left : box.right - event.clientX;
    find(id).style.width = `${Math.max(140, Math.min(innerWidth * 0.6, width))}px`;
  });
}
