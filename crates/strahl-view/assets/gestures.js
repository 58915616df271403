// Mouse and fingers on a picture: taps, drags, and two fingers that move and spread.

export class Gestures {
  // `does`: accepts(event) -> whether the gesture is for this box, start(event), drag(event, dx, dy), pinch(factor, x, y, dx, dy), tap(event),
  // hover(event), leave(). Columns and rows are those of the window.
  constructor(box, does) {
    this.does = does;
    this.pointers = new Map();
    this.moved = false;
    box.addEventListener("pointerdown", (event) => {
      if (!does.accepts(event) || event.button > 2) return;
      box.setPointerCapture(event.pointerId);
      this.pointers.set(event.pointerId, at(event));
      // What two fingers do is no tap, and no drag of one of them.
      this.moved = this.pointers.size > 1;
      this.from = at(event);
      if (this.pointers.size === 1) does.start?.(event);
    });
    box.addEventListener("pointermove", (event) => this.move(event));
    box.addEventListener("pointerup", (event) => {
      const alone = this.pointers.size === 1;
      if (this.pointers.delete(event.pointerId) && alone && !this.moved && event.button === 0) does.tap?.(event);
    });
    box.addEventListener("pointercancel", (event) => this.pointers.delete(event.pointerId));
    box.addEventListener("pointerleave", (event) => { if (event.pointerType === "mouse") does.leave?.(); });
    box.addEventListener("contextmenu", (event) => event.preventDefault());
  }

  move(event) {
    const last = this.pointers.get(event.pointerId);
    if (!last) {
      if (this.pointers.size === 0) this.does.hover?.(event);
      return;
    }
    const now = at(event);
    this.pointers.set(event.pointerId, now);
    if (this.pointers.size === 2) {
      const [other] = [...this.pointers].filter(([id]) => id !== event.pointerId).map(([, place]) => place);
      const [before, after] = [last, now].map((one) => ({ x: (one.x + other.x) / 2, y: (one.y + other.y) / 2, apart: Math.hypot(one.x - other.x, one.y - other.y) }));
      const factor = before.apart > 1 && after.apart > 1 ? after.apart / before.apart : 1;
      this.does.pinch?.(factor, after.x, after.y, after.x - before.x, after.y - before.y);
      return;
    }
    // A finger is never quite still.
    const slack = event.pointerType === "mouse" ? 3 : 9;
    if (!this.moved && Math.hypot(now.x - this.from.x, now.y - this.from.y) <= slack) {
      this.pointers.set(event.pointerId, last);
      return;
    }
    this.moved = true;
    if (this.pointers.size === 1) this.does.drag(event, now.x - last.x, now.y - last.y);
  }
}

function at(event) {
  return { x: event.clientX, y: event.clientY };
}
