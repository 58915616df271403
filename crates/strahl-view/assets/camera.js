// Cameras that move. A camera has an eye, and the vectors direction, right and up.

export const plus = (a, b, f = 1) => a.map((v, i) => v + f * b[i]);
export const minus = (a, b) => a.map((v, i) => v - b[i]);
export const scaled = (a, f) => a.map((v) => v * f);
export const inner = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const length = (a) => Math.hypot(...a);
export const unit = (a) => scaled(a, 1 / (length(a) || 1));

// A vector turned around an axis of length 1.
function turned(v, axis, angle) {
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  return plus(plus(scaled(v, c), cross(axis, v), s), axis, inner(axis, v) * (1 - c));
}

function middle(camera, pivot) {
  return pivot ?? plus(camera.eye, unit(camera.direction), camera.distance ?? 5);
}

// Turns around a point: `dx` around the scene's up, `dy` around the camera's right.
export function turn(camera, pivot, dx, dy) {
  const center = middle(camera, pivot);
  const up = unit(camera.pole ?? camera.up);
  // Mirrored systems turn the other way.
  const hand = Math.sign(inner(cross(camera.right, camera.up), scaled(camera.direction, -1))) || 1;
  const side = unit(camera.right);
  const view = unit(camera.direction);
  const slope = Math.asin(Math.max(-1, Math.min(1, inner(view, up))));
  const next = Math.max(-1.53, Math.min(1.53, slope - dy));
  const all = (v) => turned(turned(v, side, (next - slope) * hand), up, dx * hand);
  const out = { ...camera };
  out.eye = plus(center, all(minus(camera.eye, center)));
  for (const name of ["direction", "right", "up"]) out[name] = all(camera[name]);
  return out;
}

// Moves across the view, so that the point under the mouse stays under it.
export function pan(camera, pivot, dx, dy, aspect) {
  const away = camera.orthographic ? 1 : inner(minus(middle(camera, pivot), camera.eye), camera.direction) / inner(camera.direction, camera.direction);
  const by = plus(scaled(camera.right, (-2 * dx * away * aspect) / aspect), camera.up, 2 * dy * away);
  return { ...camera, eye: plus(camera.eye, by) };
}

// Goes nearer to a point, or away from it.
export function dolly(camera, pivot, factor) {
  if (camera.orthographic) return { ...camera, right: scaled(camera.right, factor), up: scaled(camera.up, factor) };
  const center = middle(camera, pivot);
  return { ...camera, eye: plus(center, scaled(minus(camera.eye, center), factor)) };
}

// Where a camera sees a point: `u` and `v` in lengths of `right` and `up` from the middle, and `depth` in lengths of `direction`, 1 for an
// orthographic camera. `ahead` is false for what lies behind the eye.
export function seen({ eye, direction, right, up, orthographic }, point) {
  const from = minus(point, eye);
  // Solves from = a·direction + b·right + c·up.
  const volume = inner(direction, cross(right, up));
  const a = inner(from, cross(right, up)) / volume;
  const b = inner(direction, cross(from, up)) / volume;
  const c = inner(direction, cross(right, from)) / volume;
  const depth = orthographic ? 1 : a;
  return { u: b / depth, v: c / depth, depth, ahead: depth > 1e-6 };
}

// A point moved parallel to the picture, by lengths of `right` and `up` as they are seen.
export function shifted(camera, point, du, dv) {
  const { depth } = seen(camera, point);
  // Behind the eye it moves as far as it would before it.
  const by = Math.max(Math.abs(depth), 1e-3);
  return plus(plus(point, camera.right, du * by), camera.up, dv * by);
}
