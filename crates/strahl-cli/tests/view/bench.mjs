// A browser with the page, and what the checks need of it. Arguments of the program: the address of the page, and the folder with scene.pov, ball.inc,
// whole.ppm and depth1.ppm; then the address of a viewer with the scenes that are built in.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";

const require = createRequire(join(process.env.STRAHL_PLAYWRIGHT, "any.js"));
const { chromium } = require("playwright-core");
const { source: axe } = require("axe-core");

export const [address, folder, others] = process.argv.slice(2);
export const scene = join(folder, "scene.pov");
export const original = readFileSync(scene, "utf8");
export const ball = readFileSync(join(folder, "ball.inc"), "utf8");
export const [WIDTH, HEIGHT] = [160, 120];

// What was checked, and how many seconds after the beginning.
export const say = (text) => console.log(`ok, ${Math.round(performance.now() / 1000)} s: ${text}`);

// The codes of a PPM file, whose header may have any length.
export function ppm(name) {
  return readFileSync(join(folder, name)).subarray(-3 * WIDTH * HEIGHT);
}

// Two pictures are the same, code by code.
export function same(codes, wanted) {
  assert.equal(codes.length, wanted.length);
  if (codes.equals(wanted)) return;
  assert.fail(`${codes.filter((one, i) => one !== wanted[i]).length} of ${codes.length} codes differ`);
}

// The sRGB code of a linear value.
export function code(c) {
  const inside = Math.min(1, Math.max(0, c));
  return Math.round(255 * (inside <= 0.0031308 ? 12.92 * inside : 1.055 * inside ** (1 / 2.4) - 0.055));
}

// How long anything may take, in milliseconds; a machine that builds something else at the same time is slow.
const PATIENCE = 60000;

export async function eventually(check) {
  const end = Date.now() + PATIENCE;
  for (;;) {
    try {
      await check();
      return;
    } catch (error) {
      if (Date.now() > end) throw error;
      await new Promise((resolve) => setTimeout(resolve, 50));
    }
  }
}

export const browser = await chromium.launch({ executablePath: process.env.STRAHL_BROWSER, args: ["--no-sandbox", "--disable-gpu"] });
export const problems = [];
const requests = [];

// A window; `sent` and `received` have what went over its WebSocket.
export async function open(options = {}) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 720 }, locale: "en-US", colorScheme: "light", ...options });
  context.setDefaultTimeout(PATIENCE);
  // The page's files from this folder instead of those in the program, to try a change without building.
  const assets = process.env.STRAHL_ASSETS;
  if (assets) await context.route(/\.(js|css)$/, (route) => route.fulfill({ path: join(assets, new URL(route.request().url()).pathname) }));
  return watch(await context.newPage());
}

export async function watch(page) {
  page.on("pageerror", (error) => problems.push(String(error)));
  page.on("console", (message) => { if (message.type() === "error") problems.push(message.text()); });
  page.on("request", (request) => requests.push(request.url()));
  page.sent = [];
  page.steps = [];
  page.on("websocket", (socket) => {
    socket.on("framesent", ({ payload }) => page.sent.push(JSON.parse(payload)));
    socket.on("framereceived", ({ payload }) => { if (typeof payload !== "string" && payload.readUInt32LE(0) === 1) page.steps.push(payload.readUInt32LE(24)); });
  });
  return page;
}

// What is left to say at the end: no errors, and nothing asked of another host.
export function quiet() {
  assert.deepEqual(problems, []);
  const hosts = [address, others].map((one) => new URL(one).host);
  assert.deepEqual(requests.filter((url) => /^(https?|wss?):/.test(url) && !hosts.includes(new URL(url).host)), []);
}

// The rules of axe-core that the page keeps.
const RULES = ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa", "best-practice"];

// The page as the checks see it.
export class Viewer {
  constructor(page) {
    this.page = page;
  }

  find(selector, options) { return this.page.locator(selector, options); }

  // The codes of the main picture, or of another canvas.
  async codes(id = "picture") {
    const text = await this.page.evaluate((name) => {
      const canvas = document.getElementById(name);
      const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
      let codes = "";
      for (let i = 0; i < data.length; i += 4) codes += String.fromCharCode(data[i], data[i + 1], data[i + 2]);
      return btoa(codes);
    }, id);
    return Buffer.from(text, "base64");
  }

  async shows(expected, id = "picture") {
    await eventually(async () => same(await this.codes(id), expected));
  }

  // A picture that is none of these.
  async showsOther(...others) {
    await eventually(async () => {
      const now = await this.codes();
      assert.ok(!others.some((other) => now.equals(other)), "the picture is still an old one");
    });
  }

  // The checksum of the finished picture, once it is another one.
  async finished(but) {
    await this.page.waitForFunction((known) => document.body.dataset.finished && document.body.dataset.finished !== known, but);
    return this.page.evaluate(() => document.body.dataset.finished);
  }

  sha() { return this.page.evaluate(() => document.body.dataset.finished); }

  // The middle of a pixel on the screen.
  async at(x, y) {
    const box = await this.find("#picture").boundingBox();
    return [box.x + ((x + 0.5) * box.width) / WIDTH, box.y + ((y + 0.5) * box.height) / HEIGHT];
  }

  async click(x, y) {
    await this.page.mouse.click(...await this.at(x, y));
    await this.page.waitForFunction((place) => document.querySelector(".pixel-head h2")?.textContent.includes(place), `${x}, ${y}`);
  }

  // The code of a pixel on the canvas.
  pixel(x, y) {
    return this.page.evaluate(([a, b]) => [...document.getElementById("picture").getContext("2d").getImageData(a, b, 1, 1).data].slice(0, 3), [x, y]);
  }

  // The sum of the tree that is shown.
  sum() { return this.page.evaluate(() => JSON.parse(document.querySelector("[data-sum]").dataset.sum)); }

  async field(id, value) {
    await this.find(`#${id}`).fill(value);
    await this.find(`#${id}`).press("Enter");
  }

  // Saves what a button downloads.
  async download(selector, name) {
    const [file] = await Promise.all([this.page.waitForEvent("download"), this.find(selector).click()]);
    const path = join(folder, name);
    await file.saveAs(path);
    return path;
  }

  // What axe-core finds wrong in the page for people who use it otherwise than with eyes and a mouse: as it is, and the contrast of its colours in
  // the other theme.
  async accessible(where) {
    if (!await this.page.evaluate(() => "axe" in window)) await this.page.evaluate(`${axe}; 0`);
    const wrong = (runOnly) => this.page.evaluate(async (only) => {
      // What an open menu covers is not meant to be touched.
      const rules = document.querySelector("details.menu[open]") ? { "target-size": { enabled: false } } : {};
      const { violations } = await axe.run(document, { runOnly: only, rules, resultTypes: ["violations"] });
      return violations.map((one) => `${one.id}: ${one.help} ${one.nodes.slice(0, 4).map((node) => node.html.slice(0, 200)).join(" | ")}`);
    }, runOnly);
    assert.deepEqual(await wrong(RULES), [], where);
    const theme = await this.page.evaluate(() => document.documentElement.dataset.theme);
    if (!theme) return;
    const other = theme === "dark" ? "light" : "dark";
    await this.page.evaluate((name) => { document.documentElement.dataset.theme = name; }, other);
    assert.deepEqual(await wrong(["color-contrast"]), [], `${where}, ${other}`);
    await this.page.evaluate((name) => { document.documentElement.dataset.theme = name; }, theme);
  }

  // The state of the page, which its address keeps.
  state() {
    return this.page.evaluate(async () => (await import(new URL("state.js", location.href))).state);
  }

  // Until the address has these words.
  async address(...words) {
    await eventually(async () => {
      const now = decodeURIComponent(this.page.url());
      for (const one of words) assert.match(now, one);
    });
  }

  async oneLine(where) {
    const tops = await this.page.evaluate(() => [...document.querySelectorAll("#bar > *")].filter((one) => !one.classList.contains("gap")).map((one) => one.getBoundingClientRect().top));
    assert.ok(Math.max(...tops) - Math.min(...tops) < 24, `the bar is one line, ${where}`);
  }

  // Nothing is wider than its place.
  async fits(where) {
    const wide = await this.page.evaluate(() => ["html", "#bar", "#inspector", "#inspector .panel-body", "#inspector .formula", "#code", "#status"].flatMap((one) => {
      const boxes = [...document.querySelectorAll(one)].filter((box) => box.scrollWidth > box.clientWidth + 1 && getComputedStyle(box).overflowX !== "hidden");
      return boxes.slice(0, 3).map((box) => `${one}: ${box.textContent.slice(0, 200)}`);
    }));
    assert.deepEqual(wide, [], where);
  }
}
