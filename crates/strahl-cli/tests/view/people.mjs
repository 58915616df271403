// The page for everybody: readable, in two languages, on small screens, by touch and by keyboard.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { Viewer, address, eventually, open, original, ppm, say, scene } from "./bench.mjs";

export async function readable(viewer) {
  const { page } = viewer;
  await viewer.find("#theme").click();
  assert.equal(await page.evaluate(() => document.documentElement.dataset.theme), "dark");
  await viewer.find("#theme").click();
  assert.equal(await page.evaluate(() => document.documentElement.dataset.theme), "light");
  await parts(viewer, "English");
  await viewer.oneLine("at 1280 pixels");
  await page.setViewportSize({ width: 1920, height: 1080 });
  await viewer.fits("at 1920 pixels");
  await page.setViewportSize({ width: 1280, height: 720 });
  say("axe-core finds nothing in any part of the page, light or dark, and nothing is too wide at 1280 x 720");
}

// Every part of the page that can be opened: nothing is too wide, and axe-core finds nothing.
async function parts(viewer, language) {
  const { page } = viewer;
  // In the second language what is longer counts; its colours and roles are those of the first, so one part is enough.
  const check = async (part) => {
    if (language === "English" || part === "an open tree") await viewer.accessible(`${part}, ${language}`);
    await viewer.fits(`${part}, ${language}`);
  };
  await viewer.click(80, 70);
  // What is closed makes its content when it is opened, with more to open in it.
  await page.waitForFunction(() => {
    const closed = [...document.querySelectorAll("#inspector details:not([open])")];
    for (const one of closed) one.open = true;
    return !closed.length && [...document.querySelectorAll("#inspector details")].every((one) => one.children.length > 1);
  });
  assert.ok(await viewer.find("#inspector .light-body").count() >= 1);
  await check("an open tree");
  for (const menu of ["#more", "#save-menu"]) {
    await viewer.find(`${menu} > summary`).click();
    await check(`the menu ${menu}`);
    await page.keyboard.press("Escape");
  }
  await viewer.find("#compare").click();
  await check("two pictures under a line");
  await viewer.find("#side-view").selectOption("beside");
  await check("two pictures side by side");
  await viewer.find("#side-view").selectOption("");
  await viewer.find("#compare").click();
  await page.keyboard.press("c");
  await check("a camera to turn");
  await page.keyboard.press("g");
  await check("lights to drag");
  await page.keyboard.press("g");
  await page.keyboard.press("?");
  await page.waitForSelector("#help[open]");
  await check("the sheet of keys");
  await page.keyboard.press("Escape");
  await page.waitForSelector("#help:not([open])", { state: "attached" });
  await viewer.find("#tab-space").click();
  await page.waitForSelector(".space-say .legend");
  await check("rays in space");
  await page.keyboard.press(".");
  await check("a step in space");
  await viewer.find("#tab-walk").click();
  await page.waitForSelector(".events button");
  await check("an accelerator");
  await viewer.find("#show-table").click();
  await page.waitForSelector("#table tbody tr");
  await check("the table");
  await page.keyboard.press("Escape");
  await page.waitForSelector("#table:not([open])", { state: "attached" });
  await viewer.find("#tab-tree").click();
}

export async function german(viewer) {
  const { page } = viewer;
  await viewer.find("#language").click();
  assert.equal(await page.evaluate(() => document.documentElement.lang), "de");
  assert.match(await viewer.find("#tab-tree").innerText(), /Strahlen/);
  await page.waitForSelector(".ray-body");
  assert.match(await viewer.find(".ray-body").first().innerText(), /Primärstrahl/);
  await viewer.address(/language=de/);
  assert.equal(await viewer.find("#picture").getAttribute("aria-label"), "Bild");
  await parts(viewer, "German");
  await viewer.oneLine("in German");
  say("the page speaks German in all its parts");
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
  // What the fingers did, once it has been sent.
  const sent = async () => {
    const { outside } = await viewer.state();
    await eventually(async () => assert.deepEqual(cameras().at(-1).eye, outside.eye));
    return outside;
  };
  const first = cameras().at(-1);
  await glide([[mx, my]], [[mx + 60, my]]);
  const turned = await sent();
  assert.notDeepEqual(turned.direction, first.direction);
  await glide([[mx - 60, my], [mx + 60, my]], [[mx - 20, my], [mx + 20, my]]);
  const away = await sent();
  assert.ok(size(away) > size(turned), JSON.stringify([turned, away]));
  assert.deepEqual(away.direction, turned.direction, "two fingers don't turn");
  await viewer.accessible("a tablet on edge, in space");
  await viewer.find("#tab-walk").tap();
  await page.waitForSelector(".events button");
  await viewer.accessible("a tablet on edge, an accelerator");
  await viewer.find("#lights").tap();
  await viewer.accessible("a tablet on edge, lights");
  await viewer.find("#lights").tap();
  await viewer.find("#save-menu > summary").tap();
  await viewer.accessible("a tablet on edge, a menu");
  await page.keyboard.press("Escape");
  await viewer.find("#tab-space").tap();

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
  await viewer.address(/depth=1/);
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
