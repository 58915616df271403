// The keys of the page; words.js lists them for the sheet.

import { closeMenus, find } from "./controls.js";
import { state } from "./state.js";

// `page` has current, stage, code, space, set(values), pick(x, y), toggle(id), and the actions of its buttons.
export function listen(page) {
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (/^(INPUT|TEXTAREA|SELECT)$/.test(event.target.tagName)) {
      if (event.key !== "Escape") return;
      // Back to the keys of the page.
      event.target.blur();
    }
    // An open dialog has its own keys: Escape closes it.
    if (document.querySelector("dialog[open]") && event.key !== "?") return;
    const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
    if (step && page.current && !event.target.closest("#code, #swipe, .events")) {
      event.preventDefault();
      walk(page, step);
      return;
    }
    const channel = { n: "normal", d: "depth", o: "object", m: "material" }[event.key.toLowerCase()];
    const { actions, stage, space, set } = page;
    const action = channel ? () => set({ channel: state.channel === channel ? "color" : channel }) : {
      c: actions.camera, g: actions.lights, r: actions.reset, f: () => stage.fit(), 1: () => stage.zoomTo(1), x: actions.compare,
      "+": () => set({ exposure: state.exposure + 0.5 }), "-": () => set({ exposure: state.exposure - 0.5 }),
      s: () => page.toggle("code"), i: () => page.toggle("inspector"), t: actions.theme, l: actions.language, "?": actions.help,
      ",": () => space.step(-1), ".": () => space.step(1),
      Escape: () => { closeMenus(); actions.unmark(); },
    }[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (event.key === " " && !/^(BUTTON|SUMMARY)$/.test(event.target.tagName)) {
      event.preventDefault();
      space.play();
    } else if (action) {
      event.preventDefault();
      action();
    }
  });
}

// The pixel beside the one that was picked; at first the one in the middle.
function walk({ current, pick }, [dx, dy]) {
  if (!state.pixel) {
    pick(Math.floor(current.width / 2), Math.floor(current.height / 2));
    return;
  }
  const [x, y] = [state.pixel[0] + dx, state.pixel[1] + dy];
  if (x >= 0 && y >= 0 && x < current.width && y < current.height) pick(x, y);
}

// The borders between the three parts of the page can be dragged.
export function splits() {
  for (const [id, side] of [["code", 1], ["inspector", -1]]) {
    const split = find(`split-${id}`);
    const widen = (width) => {
      const now = Math.max(140, Math.min(innerWidth * 0.6, width));
      find(id).style.width = `${now}px`;
      split.setAttribute("aria-valuenow", Math.round((100 * now) / innerWidth));
    };
    split.setAttribute("aria-valuenow", Math.round((100 * find(id).clientWidth) / innerWidth));
    split.addEventListener("keydown", (event) => {
      const by = { ArrowLeft: -20, ArrowRight: 20 }[event.key];
      if (!by) return;
      event.preventDefault();
      event.stopPropagation();
      widen(find(id).clientWidth + side * by);
    });
    split.addEventListener("pointerdown", (event) => { split.setPointerCapture(event.pointerId); split.dataset.drag = "1"; });
    for (const name of ["pointerup", "pointercancel"]) split.addEventListener(name, () => delete split.dataset.drag);
    split.addEventListener("pointermove", (event) => {
      if (!split.dataset.drag) return;
      const box = find(id).getBoundingClientRect();
      widen(side > 0 ? event.clientX - box.left : box.right - event.clientX);
    });
  }
}
