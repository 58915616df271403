// The rays of a pixel in space: as a list of lines, and drawn with the eye, the image plane and the vectors at a hit.

import { inner, length, minus, plus, scaled, unit } from "./camera.js";
import { number } from "./numbers.js";
import { lightName, word } from "./words.js";

// How many times as far from the eye as the first hit a point is shown from the beginning.
const FAR = 2.5;

// Of an area light, so many shadow rays stand for all.
const MOST_SHADOWS = 8;

// The rays of a sample as lines, in the order of tracing; the points that a view from outside shows, their middle, and half the size of their box.
export function raysOf(sample, { eye }) {
  const ends = sample.rays.filter((ray) => ray.hit).map((ray) => ray.hit.position);
  const lights = sample.rays.flatMap((ray) => ray.lights.map((light) => light.position)).filter(Boolean);
  // What is far behind the first hit, such as a plane's horizon, would make all else small.
  const far = ends.length ? FAR * length(minus(ends[0], eye)) : 0;
  const points = [eye, ...[...ends, ...lights].filter((end) => length(minus(end, eye)) <= far)];
  const low = points.reduce((a, b) => a.map((v, i) => Math.min(v, b[i])));
  const high = points.reduce((a, b) => a.map((v, i) => Math.max(v, b[i])));
  const radius = Math.max(1e-9, length(minus(high, low)) / 2);
  const steps = sample.rays.flatMap((ray) => [wayOf(ray, radius * 0.7), ...ray.lights.flatMap((light) => shadowsOf(ray, light, radius * 0.7))]);
  return { steps, points, radius, middle: scaled(plus(low, high), 0.5) };
}

// A ray from its origin to its hit; one that hits nothing is drawn `open` long.
function wayOf(ray, open) {
  const { id, kind, hit } = ray;
  const { origin, direction } = ray.ray;
  const what = hit ? `${hit.object}, t = ${number(hit.t, 4)}` : word("background");
  return { kind, from: origin, to: hit ? hit.position : plus(origin, unit(direction), open), open: !hit, id, ray, text: `${word(kind)} #${id}: ${what}` };
}

function shadowsOf(ray, light, open) {
  const all = light.shadow_rays;
  const every = Math.ceil(all.length / MOST_SHADOWS);
  return all.filter((_, i) => i % every === 0).map(({ origin, direction, met }) => {
    const blocker = met.find((one) => one.blocks);
    const what = blocker ? `${word("blocked")} ${blocker.object}` : met.length ? `${word("weakened")} ${met[0].object}` : word("visible");
    const endless = light.position === null || light.position === undefined;
    const t = blocker ? blocker.t : endless ? open / (length(direction) || 1) : 1;
    return {
      kind: "shadow", from: origin, to: plus(origin, direction, t), blocked: Boolean(blocker), open: !blocker && endless, id: ray.id, ray,
      text: `${word("shadow")}: ${lightName(light.light)}, ${what}`,
    };
  });
}

// What the drawings are made with: a pen, and lines, arrows and labels at points of the scene, which `project` leads to places, or to null behind the eye.
export function drawing(pen, project) {
  const line = (from, to, color, width, dash = []) => {
    const [a, b] = clip(from, to, project);
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
    const [a, b] = clip(from, to, project);
    if (!a || !b || Math.hypot(b[0] - a[0], b[1] - a[1]) < 8) return;
    const angle = Math.atan2(b[1] - a[1], b[0] - a[0]);
    pen.fillStyle = color;
    pen.beginPath();
    pen.moveTo(...b);
    for (const side of [2.7, -2.7]) pen.lineTo(b[0] + 9 * Math.cos(angle + side), b[1] + 9 * Math.sin(angle + side));
    pen.fill();
  };
  const label = (point, text, color) => {
    const at = project(point);
    if (!at) return;
    pen.font = "600 12px system-ui, sans-serif";
    pen.lineWidth = 3;
    pen.strokeStyle = "rgb(0 0 0 / 75%)";
    pen.strokeText(text, at[0] + 5, at[1] - 5);
    pen.fillStyle = color;
    pen.fillText(text, at[0] + 5, at[1] - 5);
  };
  return { pen, project, line, arrow, label };
}

// The part of a line before the eye.
function clip(from, to, project) {
  const [a, b] = [project(from), project(to)];
  if (a && b) return [a, b];
  if (!a && !b) return [null, null];
  let [near, far] = a ? [from, to] : [to, from];
  for (let i = 0; i < 24; i += 1) {
    const half = scaled(plus(near, far), 0.5);
    if (project(half)) near = half; else far = half;
  }
  return a ? [a, project(near)] : [project(near), b];
}

// The colour of a kind of rays, for lines over pictures, whatever the theme.
export function rayColor(kind) {
  return { primary: "#8fb4f4", reflection: "#f0a53a", transparency: "#63d0bd" }[kind];
}

// The rays up to a step, or all of them (-1).
export function drawRays({ line, arrow }, steps, at) {
  for (const [index, step] of steps.slice(0, at < 0 ? steps.length : at + 1).entries()) {
    const isShadow = step.kind === "shadow";
    const color = isShadow ? (step.blocked ? "#ff6b5e" : "#ffe08a") : rayColor(step.kind);
    const width = index === at ? 3 : isShadow ? 1.2 : 2;
    if (isShadow) line(step.from, step.to, color, width, [5, 4]);
    else if (step.open) arrow(step.from, step.to, color, width);
    else line(step.from, step.to, color, width);
  }
}

// The eye, the image plane and the pixel on it.
export function drawEye({ line, label }, picture, pixel, radius) {
  const { eye, direction, right, up, orthographic } = picture.camera;
  if (orthographic === null || orthographic === undefined) return;
  const aspect = picture.aspect ?? picture.width / picture.height;
  const size = (radius * 0.28) / (orthographic ? 1 : length(direction));
  const grow = orthographic ? 1 : size;
  const corner = (x, y) => plus(plus(plus(eye, direction, size), right, x * aspect * grow), up, y * grow);
  const frame = (corners, color, width) => corners.forEach((one, i) => line(one, corners[(i + 1) % 4], color, width));
  const corners = [corner(-1, 1), corner(1, 1), corner(1, -1), corner(-1, -1)];
  frame(corners, "#e8e8e8", 1);
  if (!orthographic) for (const one of corners) line(eye, one, "rgb(232 232 232 / 55%)", 0.8);
  // A little larger than the pixel, to be seen.
  const [x, y] = pixel;
  const at = (dx, dy) => corner((2 * (x + dx)) / picture.width - 1, 1 - (2 * (y + dy)) / picture.height);
  frame([at(-1, -1), at(2, -1), at(2, 2), at(-1, 2)], "#ffb648", 1.5);
  if (!orthographic) label(eye, word("eye"), "#fff");
}

// The vectors n, v, l, h, r and t at the hit of a ray, all of one size.
export function drawVectors({ arrow, label }, ray, size) {
  const { position, shading_normal: n } = ray.hit;
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
