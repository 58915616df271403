// The bar above the picture, and the panel of the second picture.

import { choose, counted, find, menu, tool } from "./controls.js";
import { el } from "./numbers.js";
import { CHANNELS, CURVES, state } from "./state.js";
import { getLanguage, word } from "./words.js";

function samplings() {
  return [["", word("own")], ["center", "1"], ["2x2", "2 × 2"], ["3x3", "3 × 3"], ["5x5", "5 × 5"], ["adaptive", "adaptive"], ["recursive:0.3,3", "recursive"], ["corners", "corners"]];
}

function channels() {
  return CHANNELS.map((one) => [one, word(one === "rays" ? "rayCount" : one)]);
}

const own = (values) => [["", word("own")], ...(values ?? []).map((one) => [one, one])];

// The bar is made again when nobody is using it: not while a number has the focus, and not between the press and the release of a button.
let waiting = null;
let held = false;

const whenFree = () => setTimeout(() => { if (waiting) showBar(waiting); });
document.addEventListener("pointerdown", (event) => { held = Boolean(event.target.closest?.("#bar button, #bar summary, #side-panel button")); }, true);
for (const name of ["pointerup", "pointercancel"]) document.addEventListener(name, () => { held = false; whenFree(); }, true);
document.addEventListener("focusout", whenFree);

// `page` has hello, scene, current, stage, lights, set(values), and the actions of its buttons.
export function showBar(page) {
  document.documentElement.lang = getLanguage();
  page.timeline.show(page.scene?.clock || state.clock !== null, state.clock);
  const focused = document.activeElement;
  const busy = held || (focused?.type === "number" && focused.closest("#bar, #side-panel"));
  waiting = busy ? page : null;
  if (busy) return;
  const { hello, scene, current, stage, lights, set, actions } = page;
  const name = scene?.name ?? "";
  const scenes = hello?.scenes
    ? choose("scene", "", hello.scenes.map((one) => [one, one.replace(/\.pov$/, "")]), name, actions.open)
    : el("span", { class: "file", title: name, text: name.split(/[\\/]/).pop() });
  const pressed = focused?.closest("#bar, #side-panel") ? focused.id : null;
  find("bar").replaceChildren(
    el("h1", { class: "brand", text: "strahl" }), scenes,
    choose("channel", word("channel"), channels(), state.channel, (value) => set({ channel: value })),
    choose("sampling", word("sampling"), samplings(), state.sampling ?? "", (value) => set({ sampling: value || null })),
    counted("depth", word("maxDepth"), state.depth, { min: 1, max: 1000, placeholder: current ? String(current.depth) : "" }, (value) => set({ depth: value })),
    counted("exposure", word("exposure"), state.exposure, { step: 0.5, min: -20, max: 20 }, (value) => set({ exposure: value ?? 0 })),
    menu("more", word("more"),
      choose("curve", word("curve"), CURVES.map((one) => [one, word(one)]), state.curve, (value) => set({ curve: value })),
      choose("shading", word("shading"), own(hello?.shading), state.shading ?? "", (value) => set({ shading: value || null })),
      choose("accelerator", word("accelerator"), own(hello?.accelerators), state.accelerator ?? "", (value) => set({ accelerator: value || null })),
      counted("cutoff", word("cutoff"), state.cutoff, { min: 0, max: 1, step: "any", placeholder: current ? String(Number(current.cutoff.toPrecision(2))) : "" }, (value) => set({ cutoff: value })),
      counted("clock", word("clock"), state.clock, { step: 0.05 }, (value) => set({ clock: value }))),
    el("span", { class: "gap" }),
    tool("camera", word("camera"), `${word("camera")} (C)`, actions.camera, stage.turning),
    tool("lights", word("lights"), `${word("lights")} (G)`, actions.lights, lights.on),
    state.camera || state.lights ? tool("reset", word("resetCamera"), `${word("resetHint")} (R)`, actions.reset) : "",
    tool("compare", word("compare"), `${word("compare")} (X)`, actions.compare, Boolean(state.compare)),
    menu("save-menu", word("save"),
      tool("png", word("savePng"), word("savePng"), actions.png),
      tool("exr", word("saveExr"), word("saveExr"), actions.exr),
      tool("page", word("savePage"), word("savePageHint"), actions.page),
      tool("copy", word("copyCamera"), word("copyCamera"), actions.copyCamera)),
    tool("theme", "◐", `${word("theme")} (T)`, actions.theme),
    tool("language", getLanguage() === "en" ? "DE" : "EN", `${word("language")} (L)`, actions.language),
    tool("help-button", "?", `${word("help")} (?)`, actions.help));
  showSide(page);
  // Whoever uses the keyboard goes on where they were.
  if (pressed) find(pressed)?.focus({ preventScroll: true });
}

function showSide({ hello, stage, set }) {
  const box = find("side-panel") ?? stage.box.appendChild(el("div", { id: "side-panel", class: "card" }));
  box.hidden = !state.compare;
  if (!state.compare) return;
  const side = state.compare;
  // It may be folded up, to see what is under it.
  const open = box.firstChild?.open ?? true;
  const change = (values) => set({ compare: { ...state.compare, ...values } });
  box.replaceChildren(el("details", { open }, el("summary", { text: word("settingsOf") }), el("div", { class: "card-body" },
    choose("side-view", word("view"), [["", word("swipe")], ["beside", word("beside")]], state.beside ? "beside" : "", (value) => set({ beside: value ? true : null })),
    choose("side-channel", word("channel"), channels(), side.channel ?? state.channel, (value) => change({ channel: value })),
    choose("side-accelerator", word("accelerator"), own(hello.accelerators), side.accelerator ?? "", (value) => change({ accelerator: value || null })),
    choose("side-shading", word("shading"), own(hello.shading), side.shading ?? "", (value) => change({ shading: value || null })),
    choose("side-sampling", word("sampling"), samplings(), side.sampling ?? "", (value) => change({ sampling: value || null })),
    counted("side-depth", word("maxDepth"), side.depth, { min: 1, max: 1000 }, (value) => change({ depth: value })))));
}
