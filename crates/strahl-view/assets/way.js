// The way of a ray through an accelerator: the boxes, cells and spheres that it visits.

import { length, plus, scaled } from "./camera.js";

// The regions of a trial plane, row by row from below: 0 is the face itself, 1 to 4 lie beyond an edge, 5 to 8 beyond a corner.
const REGIONS = [[5, 4, 6], [1, 0, 2], [7, 3, 8]];

// Draws the way up to a step, or all of it (-1). `tools`: pen, line(from, to, color, width, dash), label(point, text, color), project(point) -> place or
// null. A ray that hits nothing is drawn `far`.
export function drawWay(tools, { events, ray, hit }, at, far) {
  const { line } = tools;
  line(ray.origin, plus(ray.origin, ray.direction, hit?.t ?? far / length(ray.direction)), "#ffffff", 1.6);
  const last = at < 0 ? events.length - 1 : Math.min(at, events.length - 1);
  for (let index = 0; index <= last; index += 1) {
    const event = events[index];
    const now = index === last && at >= 0;
    const color = now ? "#ffb648" : /leaf|cell/.test(event.event) ? "#7fd1a3" : "#8fb4f4";
    const width = now ? 2.4 : last > 60 ? 0.5 : 0.9;
    const { place } = event;
    const edges = place?.min ? box(place.min, place.max) : place?.center ? rings(place.center, place.radius) : [];
    for (const [a, b] of edges) line(a, b, color, width);
    if (now && event.exit && place?.min) drawExit(tools, event, ray.direction);
  }
}

// The face by which the ray leaves a cell, and the regions of the plane that was tried first.
function drawExit({ pen, line, label, project }, { place: { min, max }, exit }, direction) {
  const plane = (axis, up, columns, rows) => {
    const [u, v] = [0, 1, 2].filter((one) => one !== axis);
    const point = (a, b) => {
      const out = [];
      out[axis] = up ? max[axis] : min[axis];
      out[u] = min[u] + a * (max[u] - min[u]);
      out[v] = min[v] + b * (max[v] - min[v]);
      return out;
    };
    return [[columns[0], rows[0]], [columns[1], rows[0]], [columns[1], rows[1]], [columns[0], rows[1]]].map(([a, b]) => point(a, b));
  };
  const fill = (corners, color) => {
    const places = corners.map((corner) => project(corner));
    if (!places.every(Boolean)) return;
    pen.fillStyle = color;
    pen.beginPath();
    places.forEach((place, i) => (i ? pen.lineTo(...place) : pen.moveTo(...place)));
    pen.fill();
  };
  const outline = (corners, color, width, dash) => corners.forEach((corner, i) => line(corner, corners[(i + 1) % 4], color, width, dash));
  const labels = [];
  if (exit.region !== null) {
    const size = direction.map(Math.abs);
    // As the octree chooses it: the axis of the largest component, of equal ones the first.
    const axis = size.indexOf(Math.max(...size));
    REGIONS.forEach((row, j) => row.forEach((region, i) => {
      const corners = plane(axis, direction[axis] >= 0, [i - 1, i], [j - 1, j]);
      if (region === exit.region) fill(corners, "rgb(255 182 72 / 30%)");
      outline(corners, "#ffb648", 0.7, [3, 3]);
      labels.push([corners, region]);
    }));
  }
  const face = plane("xyz".indexOf(exit.face[1]), exit.face[0] === "+", [0, 1], [0, 1]);
  fill(face, "rgb(127 209 163 / 40%)");
  outline(face, "#7fd1a3", 2);
  // The numbers of the regions, where there is room for them.
  for (const [corners, region] of labels) {
    const [from, , to] = corners.map((corner) => project(corner));
    if (from && to && Math.hypot(to[0] - from[0], to[1] - from[1]) > 36) label(scaled(plus(corners[0], corners[2]), 0.5), String(region), region === exit.region ? "#ffb648" : "#ffffff");
  }
}

function box(low, high) {
  const corner = (i) => [0, 1, 2].map((axis) => ((i >> axis) & 1 ? high[axis] : low[axis]));
  const edges = [];
  for (let i = 0; i < 8; i += 1) for (const bit of [1, 2, 4]) if (!(i & bit)) edges.push([corner(i), corner(i | bit)]);
  return edges;
}

function rings(center, radius) {
  const edges = [];
  for (let axis = 0; axis < 3; axis += 1) {
    let last = null;
    for (let i = 0; i <= 32; i += 1) {
      const point = [...center];
      point[(axis + 1) % 3] += radius * Math.cos((i * Math.PI) / 16);
      point[(axis + 2) % 3] += radius * Math.sin((i * Math.PI) / 16);
      if (last) edges.push([last, point]);
      last = point;
    }
  }
  return edges;
}
