// Pixels: their trees, in space, through an accelerator, and in files.

import assert from "node:assert/strict";
import { pathToFileURL } from "node:url";
import { Viewer, browser, code, eventually, same, say, watch } from "./bench.mjs";

export async function explained(viewer) {
  const { page } = viewer;
  await viewer.click(80, 70);
  const film = (await viewer.pixel(80, 70)).join(" ");
  assert.ok((await viewer.find(".pixel-head p").innerText()).startsWith(film));
  assert.equal(await viewer.find(".sample").count(), 0);
  assert.equal((await viewer.sum()).map(code).join(" "), film);
  assert.ok(await viewer.find(".tree .reflection").count() >= 1, "the ball reflects");
  assert.ok(await viewer.find(".ray-body math").count() >= 2, "formulas");
  // Pointing at a term marks the ray that it comes from, and draws it over the picture; a click leads to it.
  const over = () => page.evaluate(() => document.getElementById("over").toDataURL());
  const without = await over();
  await viewer.find(".total .link").first().hover();
  await page.waitForSelector(".tree .reflection.marked");
  assert.notEqual(await over(), without);
  await viewer.find(".total .link").first().click();
  await page.waitForSelector(".tree details[open] > .reflection");
  await page.mouse.move(640, 700);
  await eventually(async () => assert.equal(await over(), without));
  // The line of the pixel that was picked stays marked while the mouse is elsewhere.
  await page.waitForSelector('.text-line.under[data-line="7"]');
  await page.keyboard.press("ArrowRight");
  await page.waitForFunction(() => document.querySelector(".pixel-head h2").textContent.includes("81, 70"));
  say("the tree of a pixel adds up to the pixel");

  // In the shadow of the ball.
  await viewer.click(25, 98);
  assert.match(await viewer.find(".why").innerText(), /light 1: blocked by sphere/);
  // In the mirror image of that shadow.
  await viewer.click(46, 92);
  const why = viewer.find(".why");
  assert.match(await why.evaluate((box) => box.textContent), /reflection ray #1 light 1: blocked by sphere/);
  await why.evaluate((box) => { box.open = true; });
  await why.locator("button", { hasText: "#1" }).click();
  await page.waitForSelector('[data-node="1"] > details[open]');
  say("a dark pixel says what blocks its light, in a mirror too");

  let sha = await viewer.sha();
  await viewer.find("#sampling").selectOption("3x3");
  sha = await viewer.finished(sha);
  await viewer.click(50, 60);
  await page.waitForFunction(() => document.querySelectorAll(".sample").length === 9);
  const sums = [];
  for (let i = 0; i < 9; i += 1) {
    await viewer.find(".sample").nth(i).click();
    sums.push(await viewer.sum());
  }
  const mean = [0, 1, 2].map((c) => sums.reduce((all, one) => all + one[c], 0) / 9);
  const shown = (await viewer.find(".pixel-head p").innerText()).split("·")[0].trim();
  assert.equal(mean.map(code).join(" "), shown);
  assert.equal(shown, (await viewer.pixel(50, 60)).join(" "));
  await viewer.find("#sampling").selectOption("");
  await viewer.finished(sha);
  await viewer.click(80, 70);
  say("the trees of nine samples have the pixel as their mean");
}

export async function inSpace(viewer) {
  const { page } = viewer;
  await viewer.click(80, 70);
  await viewer.find("#tab-space").click();
  await page.waitForSelector(".space-box canvas");
  const step = () => viewer.find(".space-say strong").innerText();
  await page.keyboard.press(".");
  await page.keyboard.press(".");
  assert.match(await step(), /step 2 of \d+/);
  await page.keyboard.press(",");
  assert.match(await step(), /step 1 of \d+/);
  await page.keyboard.press(" ");
  await eventually(async () => assert.match(await step(), /step [2-9] of \d+/));
  await page.keyboard.press(" ");
  // Paused: the next step is asked for, and is the next one.
  assert.match(await viewer.find(".space-tools").innerText(), /Play/);
  const stopped = (await viewer.state()).step;
  await page.keyboard.press(",");
  assert.equal((await viewer.state()).step, stopped - 1);
  // Turned with the mouse, and without perspective: other pictures of the same slot.
  const cameras = () => page.sent.filter((one) => one.slot === "space" && one.settings).map((one) => one.settings.camera);
  const before = cameras().length;
  const box = await viewer.find(".space-box").boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width / 2 + 60, box.y + box.height / 2 + 10, { steps: 4 });
  await page.mouse.up();
  await eventually(async () => assert.ok(cameras().length > before));
  assert.equal(cameras().at(-1).orthographic, false);
  await viewer.find(".space-tools button", { hasText: "Orthographic" }).click();
  await eventually(async () => assert.equal(cameras().at(-1).orthographic, true));
  await viewer.find(".space-tools button", { hasText: "Perspective" }).click();
  const svg = await viewer.download('.space-tools button:has-text("SVG")', "rays.svg");
  say("the rays are played and stepped through in space");
  return svg;
}

export async function walked(viewer) {
  const { page } = viewer;
  await viewer.find("#tab-walk").click();
  await page.waitForSelector(".events button");
  await page.keyboard.press(".");
  await page.waitForSelector('.events [aria-current="true"]');
  const said = () => viewer.find(".space-say").innerText();
  for (const name of ["octree:traversal=trial-plane", "grid", "bvh", "spheres"]) {
    await viewer.find("#walk-accelerator").selectOption(name);
    await page.waitForFunction((wanted) => document.querySelector(".space-say strong").textContent.includes(wanted) && document.querySelectorAll(".events button").length > 0, name.split(":")[0]);
    assert.match(await said(), /\d+ steps?, \d+ tests?/);
    if (name.includes(":")) {
      const exits = viewer.find(".events button", { hasText: /exit face .*region \d/ });
      await exits.first().click();
      await page.waitForSelector('.events [aria-current="true"]');
      const eye = () => page.sent.findLast((one) => one.slot === "space" && one.settings).settings.camera.eye;
      const far = eye();
      await viewer.find("#near").click();
      await eventually(async () => assert.notDeepEqual(eye(), far));
      await viewer.accessible("the regions of a trial plane");
    }
  }
  await viewer.find("#show-table").click();
  await page.waitForSelector("#table tbody tr");
  assert.ok(await viewer.find("#table tbody tr").count() >= 5);
  assert.match(await viewer.find("#table").innerText(), /bit for bit/);
  await page.keyboard.press("Escape");
  await viewer.find("#tab-tree").click();
  say("the way through an accelerator is stepped through, and all are measured");
}

// Pages and drawings open from the disk, in a window that knows nothing of the server.
export async function exported(viewer, rays) {
  const { page } = viewer;
  await page.waitForSelector("#export");
  const pixel = await viewer.download("#export", "pixel.html");
  const tree = await viewer.download("#export-svg", "tree.svg");
  await viewer.find("#save-menu > summary").click();
  const picture = await viewer.download("#page", "picture.html");
  await page.keyboard.press("Escape");
  const context = await browser.newContext({ viewport: { width: 1280, height: 720 }, offline: true });
  const other = new Viewer(await watch(await context.newPage()));
  await other.page.goto(pathToFileURL(pixel).href);
  await other.page.waitForSelector(".pixel [data-sum]");
  assert.match(await other.find(".ray-body").first().innerText(), /Primärstrahl/);
  assert.equal((await other.sum()).map(code).join(" "), (await viewer.pixel(80, 70)).join(" "));
  await other.accessible("an exported pixel");

  await other.page.goto(pathToFileURL(picture).href);
  await other.page.waitForSelector(".pixel [data-sum]");
  // The pixels of the picture are those of the viewer.
  await other.page.evaluate(async () => {
    const image = document.querySelector("img");
    await image.decode();
    const canvas = document.createElement("canvas");
    [canvas.width, canvas.height, canvas.id, canvas.hidden] = [image.naturalWidth, image.naturalHeight, "copy", true];
    canvas.getContext("2d").drawImage(image, 0, 0);
    document.body.append(canvas);
  });
  same(await other.codes("copy"), await viewer.codes());
  const box = await other.find("img").boundingBox();
  const at = (x, y) => [box.x + ((x + 0.5) * box.width) / 160, box.y + ((y + 0.5) * box.height) / 120];
  await other.page.mouse.move(...at(80, 70));
  assert.match(await other.find("output").innerText(), /80, 70 · sphere · .*scene.pov:7/);
  assert.equal(await other.find('.text-line.under[data-line="7"]').count(), 1);
  // The pixel that was looked at in the viewer has its tree.
  await other.page.mouse.click(...at(80, 70));
  assert.match(await other.find(".pixel-head h2").innerText(), /80, 70/);
  assert.equal((await other.sum()).map(code).join(" "), (await viewer.pixel(80, 70)).join(" "));
  await other.page.mouse.click(...at(20, 110));
  assert.match(await other.find(".ray .what").first().innerText(), /plane/);
  await other.accessible("an exported picture");
  for (const path of [tree, rays]) {
    await other.page.goto(pathToFileURL(path).href);
    assert.ok(await other.page.evaluate(() => document.documentElement.localName === "svg" && document.querySelectorAll("path").length > 0), path);
  }
  await context.close();
  say("exported pixels, pictures and drawings open from the disk");
}
