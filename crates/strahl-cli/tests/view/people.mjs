// The page for everybody: readable, in two languages, on small screens, by touch and by keyboard.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { Viewer, address, eventually, open, original, ppm, say, scene } from "./bench.mjs";

export async function readable(viewer) {
  const { page } = viewer;
  for (const theme of ["light", "dark"]) {
    assert.equal(await page.evaluate(() => document.documentElement.dataset.theme), theme);
    await viewer.accessible(theme);
    await viewer.click(80, 70);
    // What is closed makes its content when it is opened, with more to open in it.
    for (let level = 0; level < 3; level += 1) {
      await page.evaluate(() => document.querySelectorAll("#inspector details").forEach((one) => { one.open = true; }));
      await page.waitForTimeout(100);
    }
    assert.ok(await viewer.find("#inspector .light-body").count() >= 1);
    await viewer.accessible(`an open tree, ${theme}`);
    await viewer.fits(`an open tree, ${theme}`);
    await viewer.find("#more > summary").click();
    await viewer.find("#compare").click();
    await viewer.accessible(`two pictures, ${theme}`);
    await viewer.find("#compare").click();
    await page.keyboard.press("g");
    await viewer.accessible(`lights, ${theme}`);
    await page.keyboard.press("g");
    await page.keyboard.press("?");
    await page.waitForSelector("#help[open]");
    await viewer.accessible(`the sheet of keys, ${theme}`);
    await page.keyboard.press("Escape");
    await page.waitForSelector("#help:not([open])", { state: "attached" });
    await viewer.find("#theme").click();
  }
  await viewer.oneLine("at 1280 pixels");
  say("axe-core finds nothing, light or dark, and nothing is too wide at 1280 x 720");
}

export async function german(viewer) {
  const { page } = viewer;
  await viewer.find("#language").click();
  assert.equal(await page.evaluate(() => document.documentElement.lang), "de");
  assert.match(await viewer.find("#tab-tree").innerText(), /Strahlen/);
  assert.match(await viewer.find(".ray-body").first().innerText(), /Primärstrahl/);
  assert.match(page.url(), /language=de/);
  assert.equal(await viewer.find("#picture").getAttribute("aria-label"), "Bild");
  await viewer.accessible("German");
  await viewer.fits("German");
  say("the page speaks German");
}

export async function english(viewer) {
  await viewer.find("#language").click();
  assert.equal(await viewer.page.evaluate(() => document.documentElement.lang), "en");
}

// A tablet: fingers, and a screen on edge.
export async function touched() {
  const page = await open({ viewport: { width: 820, height: 1180 }, hasTouch: true, isMobile: true });
  const viewer = new Viewer(page);
  await page.goto(address);
  await viewer.finished();
  await viewer.shows(ppm("whole.ppm"));
  await viewer.fits("a tablet on edge");
  const [x, y] = await viewer.at(80, 70);
  await page.touchscreen.tap(x, y);
  await page.waitForFunction(() => document.querySelector(".pixel-head h2")?.textContent.includes("80, 70"));
  await eventually(async () => assert.match(await viewer.find("#mouse").innerText(), /sphere/));
  await viewer.accessible("a tablet");

  const client = await page.context().newCDPSession(page);
  const touch = (type, places) => client.send("Input.dispatchTouchEvent", { type, touchPoints: places.map(([px, py], id) => ({ x: px, y: py, id })) });
  const glide = async (from, to) => {
    await touch("touchStart", from);
    for (let i = 1; i <= 8; i += 1) await touch("touchMove", from.map(([px, py], n) => [px + ((to[n][0] - px) * i) / 8, py + ((to[n][1] - py) * i) / 8]));
    await touch("touchEnd", []);
  };
  const place = () => viewer.find("#picture").boundingBox();
  const before = await place();
  await glide([[x, y]], [[x + 70, y + 40]]);
  const panned = await place();
  assert.ok(Math.abs(panned.x - before.x - 70) < 12 && Math.abs(panned.y - before.y - 40) < 12, JSON.stringify([before, panned]));
  await glide([[x - 30, y], [x + 30, y]], [[x - 90, y], [x + 90, y]]);
  const zoomed = await place();
  assert.ok(zoomed.width / panned.width > 2.5 && zoomed.width / panned.width < 3.5, JSON.stringify([panned, zoomed]));
  assert.match(await viewer.find(".pixel-head h2").innerText(), /80, 70/, "two fingers are no tap");
  await page.keyboard.press("f");

  await viewer.find("#tab-space").tap();
  await page.waitForSelector(".space-box canvas");
  const cameras = () => page.sent.filter((one) => one.slot === "space" && one.settings).map((one) => one.settings.camera);
  await eventually(async () => assert.ok(cameras().length > 0));
  const box = await viewer.find(".space-box").boundingBox();
  const [mx, my] = [box.x + box.width / 2, box.y + box.height / 2];
  const size = (camera) => Math.hypot(...camera.eye);
  // The page sends cameras for a while after the fingers are gone.
  const settled = async () => {
    let count;
    do {
      count = cameras().length;
      await page.waitForTimeout(600);
    } while (cameras().length !== count);
    return cameras().at(-1);
  };
  let known = await settled();
  await glide([[mx, my]], [[mx + 60, my]]);
  await eventually(async () => assert.notDeepEqual(cameras().at(-1).direction, known.direction));
  known = await settled();
  await glide([[mx - 60, my], [mx + 60, my]], [[mx - 20, my], [mx + 20, my]]);
  await eventually(async () => assert.ok(size(cameras().at(-1)) > size(known)));
  assert.deepEqual((await settled()).direction, known.direction, "two fingers don't turn");

  await page.setViewportSize({ width: 1180, height: 820 });
  await viewer.fits("a tablet");
  await viewer.accessible("a tablet, in space");
  await page.context().close();
  say("fingers move, zoom, pick and turn, and the page fits a tablet");
}

// A connection that is cut comes back, with what was shown and with a text that is being changed.
export async function reconnected() {
  const page = await open();
  const viewer = new Viewer(page);
  const sockets = [];
  await page.routeWebSocket(/\/ws$/, (socket) => { socket.connectToServer(); sockets.push(socket); });
  await page.goto(address);
  await viewer.finished();
  await viewer.field("depth", "1");
  await viewer.shows(ppm("depth1.ppm"));
  const loaded = page.waitForEvent("load");
  await sockets.at(-1).close();
  await page.waitForSelector("body.lost");
  await loaded;
  await viewer.finished();
  await viewer.shows(ppm("depth1.ppm"));
  assert.match(page.url(), /depth=1/);
  await viewer.find("#try").click();
  const sha = await viewer.sha();
  await viewer.find("#writer").fill(original.replace("<0, 0, 0>, 1", "<0, 0, 0>, 0.5"));
  await viewer.finished(sha);
  const small = await viewer.codes();
  const again = page.waitForEvent("load");
  await sockets.at(-1).close();
  await again;
  await viewer.shows(small);
  await page.waitForFunction(() => document.getElementById("writer")?.value.includes("0.5"));
  assert.equal(readFileSync(scene, "utf8"), original);
  await page.context().close();
  say("a lost connection is tried again, and loses nothing");
}
