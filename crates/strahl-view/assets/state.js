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
  // The part of the picture that is shown: the scale, and the column and row in the middle.
  zoom: null,
  // Where the line between two pictures is.
  split: 0.5,
  // Of the pixel: which of its samples, the step of its rays or of its way, the accelerator of that way, and the camera in space.
  sample: 0, step: -1, walk: null, outside: null,
};

// The least time between two changes of the address in milliseconds; browsers refuse more than about three a second.
const PAUSE = 350;

export const state = { ...USUAL };

// Everything is as it is without a link, but for the scene.
export function forget() {
  Object.assign(state, USUAL, { scene: state.scene });
}

// Whether the address waits for its next change, whether there is something to write, and what has been written.
let resting = false;
let changed = false;
let written = "";

// Writes the state into the address: at once, or a little later if that has just been done.
export function keep() {
  changed = true;
  if (resting) return;
  keepNow();
  resting = true;
  setTimeout(() => {
    resting = false;
    if (changed) keep();
  }, PAUSE);
}

// Writes it without waiting, before the page goes.
export function keepNow() {
  // Somebody may have put another link into the address, for which the page is about to be loaded again.
  if (!changed || location.hash !== written) return;
  changed = false;
  const words = new URLSearchParams();
  for (const [key, value] of Object.entries(state)) {
    if (value === USUAL[key]) continue;
    words.set(key, typeof value === "object" ? JSON.stringify(value) : value);
  }
  if (getLanguage() !== "en") words.set("language", getLanguage());
  const hash = words.toString();
  history.replaceState(null, "", location.pathname + location.search + (hash ? `#${hash}` : ""));
  written = location.hash;
}

const isTriple = (value) => Array.isArray(value) && value.length === 3 && value.every(Number.isFinite);
const isObject = (value) => value !== null && typeof value === "object" && !Array.isArray(value);
const isCamera = (value) => isObject(value) && ["eye", "direction", "right", "up"].every((key) => isTriple(value[key]));

// What each part of an address must be; anybody may have changed it.
const VALID = {
  size: (value) => Array.isArray(value) && value.length === 2 && value.every(Number.isInteger),
  pixel: (value) => Array.isArray(value) && value.length === 2 && value.every((one) => Number.isInteger(one) && one >= 0),
  camera: isCamera,
  outside: isCamera,
  zoom: (value) => isTriple(value) && value[0] > 0,
  split: (value) => Number.isFinite(value) && value >= 0 && value <= 1,
  sample: (value) => Number.isInteger(value) && value >= 0,
  step: (value) => Number.isInteger(value) && value >= -1,
  lights: (value) => isObject(value) && Object.entries(value).every(([key, place]) => /^\d+$/.test(key) && isTriple(place)),
  compare: isObject,
  beside: (value) => value === true,
};

export function recall() {
  written = location.hash;
  const words = new URLSearchParams(location.hash.slice(1));
  const read = (key, parse, valid) => {
    if (!words.has(key)) return;
    try {
      const value = parse(words.get(key));
      if (valid(value)) state[key] = value;
    } catch { /* it is not even JSON */ }
  };
  for (const key of ["scene", "sampling", "shading", "accelerator", "walk"]) read(key, String, () => true);
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
