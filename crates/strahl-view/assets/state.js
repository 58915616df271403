// What is shown. The address of the page keeps it, so that a link shows the same.

import { getLanguage, setLanguage } from "./words.js";

export const COUNTS = ["levels", "tests", "steps", "rays", "time"];
export const CHANNELS = ["color", "normal", "depth", "object", "material", ...COUNTS];
export const CURVES = ["srgb", "reinhard", "filmic"];
const PANELS = ["tree", "space", "walk"];

// What a link leaves out, because it is so without it.
const USUAL = {
  scene: null, size: null, sampling: null, depth: null, cutoff: null, shading: null, accelerator: null, camera: null, lights: null, clock: null,
  exposure: 0, curve: "srgb", channel: "color", pixel: null, compare: null, beside: null, panel: "tree",
};

export const state = { ...USUAL };

// Everything is as it is without a link, but for the scene.
export function forget() {
  Object.assign(state, USUAL, { scene: state.scene });
}

export function keep() {
  const words = new URLSearchParams();
  for (const [key, value] of Object.entries(state)) {
    if (value === USUAL[key]) continue;
    words.set(key, typeof value === "object" ? JSON.stringify(value) : value);
  }
  if (getLanguage() !== "en") words.set("language", getLanguage());
  const hash = words.toString();
  history.replaceState(null, "", location.pathname + location.search + (hash ? `#${hash}` : ""));
}

const isTriple = (value) => Array.isArray(value) && value.length === 3 && value.every(Number.isFinite);
const isObject = (value) => value !== null && typeof value === "object" && !Array.isArray(value);

// What each part of an address must be; anybody may have changed it.
const VALID = {
  size: (value) => Array.isArray(value) && value.length === 2 && value.every(Number.isInteger),
  pixel: (value) => Array.isArray(value) && value.length === 2 && value.every((one) => Number.isInteger(one) && one >= 0),
  camera: (value) => isObject(value) && ["eye", "direction", "right", "up"].every((key) => isTriple(value[key])),
  lights: (value) => isObject(value) && Object.entries(value).every(([key, place]) => /^\d+$/.test(key) && isTriple(place)),
  compare: isObject,
  beside: (value) => value === true,
};

export function recall() {
  const words = new URLSearchParams(location.hash.slice(1));
  const read = (key, parse, valid) => {
    if (!words.has(key)) return;
    try {
      const value = parse(words.get(key));
      if (valid(value)) state[key] = value;
    } catch { /* it is not even JSON */ }
  };
  for (const key of ["scene", "sampling", "shading", "accelerator"]) read(key, String, () => true);
  for (const key of ["depth", "cutoff", "exposure", "clock"]) read(key, Number, Number.isFinite);
  for (const [key, valid] of Object.entries(VALID)) read(key, JSON.parse, valid);
  for (const [key, values] of [["curve", CURVES], ["channel", CHANNELS], ["panel", PANELS]]) read(key, String, (value) => values.includes(value));
  setLanguage(words.get("language") ?? localStorage.getItem("language") ?? (navigator.language.startsWith("de") ? "de" : "en"));
  const theme = localStorage.getItem("theme") ?? (matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light");
  document.documentElement.dataset.theme = theme;
}

// The settings of a picture, as the server takes them.
export function settings() {
  const { size, sampling, depth, cutoff, shading, accelerator, camera, clock, exposure, curve, channel } = state;
  const lights = Object.entries(state.lights ?? {}).map(([light, position]) => ({ light: Number(light), position }));
  return { size, sampling, depth, cutoff, shading, accelerator, camera: camera ? plain(camera) : null, lights, clock, exposure, curve, channel };
}

// The numbers of a camera, without what belongs to the page.
export function plain({ eye, direction, right, up, orthographic }) {
  return { eye, direction, right, up, orthographic: orthographic ?? null };
}
