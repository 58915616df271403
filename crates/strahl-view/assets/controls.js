// The controls that the bar and the panels are made of.

import { el } from "./numbers.js";
import { word } from "./words.js";

export const find = (id) => document.getElementById(id);

export function choose(name, title, values, value, change) {
  const select = el("select", { id: name, "aria-label": title ? null : word(name), onchange: () => change(select.value) }, ...values.map(([key, text]) => el("option", { value: key, text, selected: key === value })));
  return el("label", { class: "control" }, title, select);
}

export function counted(name, title, value, attributes, change) {
  const input = el("input", { type: "number", id: name, ...attributes,
    oninput: () => { input.dataset.edited = "1"; },
    onchange: () => { delete input.dataset.edited; change(input.value === "" ? null : Number(input.value)); } });
  input.value = value ?? "";
  return el("label", { class: "control" }, title, input);
}

export function tool(name, text, title, action, pressed = null) {
  return el("button", { type: "button", class: "tool", id: name, title, "aria-label": /\p{L}/u.test(text) && !title.includes(text) ? `${text}: ${title}` : title, "aria-pressed": pressed === null ? null : String(pressed), text, onclick: action });
}

// A part of the bar that opens on a click, and stays open when the bar is made again.
export function menu(id, title, ...content) {
  const box = el("details", { class: "menu", id },
    el("summary", { class: "tool", text: title }), el("div", { class: "menu-body" }, ...content));
  box.open = find(id)?.open ?? false;
  return box;
}

export function closeMenus(but) {
  for (const one of document.querySelectorAll("details.menu[open]")) if (!but || !one.contains(but)) one.open = false;
}

export function toast(text) {
  const box = find("toast");
  box.textContent = text;
  box.classList.add("shown");
  clearTimeout(toast.timer);
  toast.timer = setTimeout(() => box.classList.remove("shown"), 3500);
}

export function download(blob, name) {
  const anchor = el("a", { href: URL.createObjectURL(blob), download: name });
  anchor.click();
  setTimeout(() => URL.revokeObjectURL(anchor.href), 10000);
}

export async function copy(text) {
  // For where a page may not write to the clipboard, and for tests.
  window.copiedText = text;
  if (navigator.clipboard) await navigator.clipboard.writeText(text).catch(() => {});
}
