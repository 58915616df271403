// Uses the viewer as a person does. Arguments: the address of the page, and the folder with scene.pov, ball.inc, whole.ppm and depth1.ppm.

import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";
import { pathToFileURL } from "node:url";

const require = createRequire(join(process.env.STRAHL_PLAYWRIGHT, "any.js"));
const { chromium } = require("playwright-core");
const { source: axe } = require("axe-core");
const [address, folder] = process.argv.slice(2);
const scene = join(folder, "scene.pov");
const original = readFileSync(scene, "utf8");

// The codes of a PPM file, whose header may have any length.
function ppm(name) {
  return [...readFileSync(join(folder, name)).subarray(-3 * 160 * 120)];
}

const browser = await chromium.launch({ executablePath: process.env.STRAHL_BROWSER, args: ["--no-sandbox", "--disable-gpu"] });
const context = await browser.newContext({ viewport: { width: 1280, height: 720 }, locale: "en-US", colorScheme: "light" });
const page = await context.newPage();
const problems = [];
const requests = [];
page.on("pageerror", (error) => problems.push(String(error)));
page.on("console", (message) => { if (message.type() === "error") problems.push(message.text()); });
page.on("request", (request) => requests.push(request.url()));

const finished = async (but) => {
  await page.waitForFunction((known) => document.body.dataset.finished && document.body.dataset.finished !== known, but, { timeout: 60000 });
  return page.evaluate(() => document.body.dataset.finished);
};
const codes = (id = "picture") => page.evaluate((name) => {
  const canvas = document.getElementById(name);
  const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
  return [...data].filter((_, i) => i % 4 < 3);
}, id);
const clickPixel = async (x, y) => {
  const box = await page.locator("#picture").boundingBox();
  await page.mouse.click(box.x + ((x + 0.5) * box.width) / 160, box.y + ((y + 0.5) * box.height) / 120);
};
// What axe-core finds wrong in the page for people who use it otherwise than with eyes and a mouse.
const accessible = async (where) => {
  await page.evaluate(`${axe}; 0`);
  const found = await page.evaluate(() => axe.run(document, { runOnly: ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa"] }));
  const wrong = found.violations.map((one) => `${one.id}: ${one.help} ${one.nodes.slice(0, 4).map((node) => node.html.slice(0, 160)).join(" | ")}`);
  assert.deepEqual(wrong, [], where);
};
const say = (text) => console.log(`ok: ${text}`);

try {
  await page.goto(address);
  let sha = await finished();
  assert.deepEqual(await codes(), ppm("whole.ppm"));
  say("the finished picture has the bytes of strahl render");

  await page.waitForSelector(".text-line");
  assert.equal(await page.locator(".k5", { hasText: /^sphere$/ }).count(), 1);
  assert.equal(await page.locator(".tab", { hasText: "ball.inc" }).count(), 1);
  say("the text is shown, coloured, with the included file as a tab");

  await clickPixel(80, 70);
  await page.waitForSelector(".pixel [data-sum]");
  const film = await page.evaluate(() => [...document.getElementById("picture").getContext("2d").getImageData(80, 70, 1, 1).data].slice(0, 3).join(" "));
  assert.ok((await page.locator(".pixel-head p").innerText()).startsWith(film));
  const shown = await page.evaluate(() => {
    const sums = [...document.querySelectorAll("[data-sum]")].map((one) => JSON.parse(one.dataset.sum));
    return sums[0];
  });
  const code = (c) => Math.round(255 * (c <= 0.0031308 ? 12.92 * c : 1.055 * c ** (1 / 2.4) - 0.055));
  const samples = await page.locator(".sample").count();
  assert.equal(samples, 0);
  assert.equal(shown.map((c) => code(Math.min(1, Math.max(0, c)))).join(" "), film);
  assert.ok(await page.locator(".tree .reflection").count() >= 1, "the ball reflects");
  assert.ok(await page.locator(".ray-body math").count() >= 2, "formulas");
  say("the tree of a pixel adds up to the pixel");

  await page.locator("#sampling").selectOption("3x3");
  const grid = await finished(sha);
  await clickPixel(50, 60);
  await page.waitForFunction(() => document.querySelectorAll(".sample").length === 9);
  const sums = [];
  for (let i = 0; i < 9; i += 1) {
    await page.locator(".sample").nth(i).click();
    sums.push(await page.evaluate(() => JSON.parse(document.querySelector("[data-sum]").dataset.sum)));
  }
  const mean = [0, 1, 2].map((c) => sums.reduce((all, one) => all + Math.min(Infinity, one[c]), 0) / 9);
  const linear = (await page.locator(".pixel-head p").innerText()).split("·")[0].trim();
  assert.equal(mean.map((c) => code(Math.min(1, Math.max(0, c)))).join(" "), linear);
  assert.equal(linear, await page.evaluate(() => [...document.getElementById("picture").getContext("2d").getImageData(50, 60, 1, 1).data].slice(0, 3).join(" ")));
  await page.locator("#sampling").selectOption("");
  sha = await finished(grid);
  await clickPixel(80, 70);
  await page.waitForFunction(() => document.querySelector(".pixel-head h2")?.textContent.includes("80, 70"));
  say("the trees of nine samples have the pixel as their mean");

  for (const theme of ["light", "dark"]) {
    assert.equal(await page.evaluate(() => document.documentElement.dataset.theme), theme);
    await accessible(theme);
    await page.locator("#theme").click();
  }
  const tops = await page.evaluate(() => [...document.querySelectorAll("#bar > *")].filter((one) => !one.classList.contains("gap")).map((one) => one.getBoundingClientRect().top));
  assert.ok(Math.max(...tops) - Math.min(...tops) < 24, "the bar is one line at 1280 pixels");
  say("axe-core finds nothing, light or dark, and the bar is one line");

  await page.locator("#exposure").fill("1");
  await page.locator("#exposure").press("Enter");
  await assertEventually(async () => assert.notDeepEqual(await codes(), ppm("whole.ppm")));
  const brighter = await codes();
  await page.locator("#more > summary").click();
  await page.locator("#curve").selectOption("reinhard");
  await assertEventually(async () => assert.notDeepEqual(await codes(), brighter));
  assert.ok(Math.max(...await codes()) < 255);
  await page.locator("#curve").selectOption("srgb");
  await page.locator("#exposure").fill("0");
  await page.locator("#exposure").press("Enter");
  await assertEventually(async () => assert.deepEqual(await codes(), ppm("whole.ppm")));
  await page.locator("#save-menu > summary").click();
  const [exr] = await Promise.all([page.waitForEvent("download"), page.locator("#exr").click()]);
  await exr.saveAs(join(folder, "saved.exr"));
  assert.deepEqual([...readFileSync(join(folder, "saved.exr")).subarray(0, 4)], [0x76, 0x2f, 0x31, 0x01]);
  await page.keyboard.press("Escape");
  say("exposure and tone curves change what is shown, and the linear values are saved as EXR");

  await page.locator("#inspector .tree button.place").first().click();
  await page.waitForSelector('.text-line.under[data-line="6"]');
  await page.locator('.text-line[data-line="7"]').click();
  await page.waitForSelector('.text-line.marked[data-line="6"]');
  await page.keyboard.press("Escape");
  say("places lead to lines, and lines mark their pixels");

  writeFileSync(join(folder, "ball.inc"), "#declare Ball = <0.1, 0.3, 1>;\n");
  sha = await finished(sha);
  const blue = await codes();
  assert.notDeepEqual(blue, ppm("whole.ppm"));
  say("a changed include file is rendered");

  writeFileSync(scene, original.replace("pigment { rgb Ball }", "pigment { rgb Ball "));
  await page.waitForSelector("#problems:not([hidden]) .caret");
  assert.deepEqual(await codes(), blue);
  assert.ok(await page.locator(".text-line.bad").count() >= 1);
  writeFileSync(scene, original);
  await page.waitForSelector("#problems", { state: "hidden" });
  say("an error is shown over the last picture, and disappears");

  writeFileSync(join(folder, "ball.inc"), "#declare Ball = <1, 0.45, 0.05>;\n");
  await finished(sha);
  await page.waitForFunction((known) => document.body.dataset.finished !== known, sha);

  await page.locator("#try").click();
  await page.locator("#writer").fill(original.replace("<0, 0, 0>, 1", "<0, 0, 0>, 0.5"));
  const tried = await finished(await page.evaluate(() => document.body.dataset.finished));
  assert.equal(readFileSync(scene, "utf8"), original);
  await page.locator("#try").click();
  await finished(tried);
  assert.deepEqual(await codes(), ppm("whole.ppm"));
  say("a text is tried without writing it");

  await page.locator("#compare").click();
  await page.waitForSelector("#side-panel:not([hidden])");
  await page.waitForFunction(() => document.getElementById("side").width === 160);
  await assertEventually(async () => assert.deepEqual(await codes("side"), ppm("depth1.ppm")));
  await page.locator("#side-view").selectOption("beside");
  const halves = await page.evaluate(() => ["picture", "side"].map((id) => document.getElementById(id).getBoundingClientRect().x));
  const stageBox = await page.locator("#stage").boundingBox();
  assert.ok(Math.abs(halves[1] - halves[0] - stageBox.width / 2) < 1);
  await page.locator("#channel").selectOption("tests");
  await page.locator("#side-accelerator").selectOption("list");
  await page.waitForFunction(() => document.body.dataset.finished);
  await page.locator("#channel").selectOption("color");
  await page.locator("#side-view").selectOption("");
  await page.locator("#compare").click();
  await assertEventually(async () => assert.deepEqual(await codes(), ppm("whole.ppm")));
  say("two settings are compared, with a line to drag and side by side");

  assert.ok(await page.locator("#timeline").isHidden());
  const last = await page.evaluate(() => document.body.dataset.finished);
  writeFileSync(scene, original.replace("<0, 0, 0>, 1", "<clock, 0, 0>, 1"));
  await page.waitForSelector("#timeline:not([hidden])");
  await page.locator("#clock-slider").fill("0.5");
  const half = await finished(last);
  assert.match(page.url(), /clock=0.5/);
  await page.locator("#play-clock").click();
  await page.waitForFunction((known) => document.body.dataset.finished !== known && Number(document.getElementById("clock-slider").value) > 0.55, half);
  await page.locator("#play-clock").click();
  writeFileSync(scene, original);
  await page.waitForSelector("#timeline", { state: "attached" });
  await page.locator("#more > summary").click();
  await page.locator("#clock").fill("");
  await page.locator("#clock").press("Enter");
  await page.keyboard.press("Escape");
  await assertEventually(async () => assert.deepEqual(await codes(), ppm("whole.ppm")));
  say("a scene with clock has a timeline");

  await page.locator("#tab-space").click();
  await page.waitForSelector(".space-box canvas");
  await page.keyboard.press(".");
  await page.keyboard.press(".");
  assert.match(await page.locator(".space-say strong").innerText(), /step 2 of \d+/);
  const [rays] = await Promise.all([page.waitForEvent("download"), page.locator(".space-tools button", { hasText: "SVG" }).click()]);
  await rays.saveAs(join(folder, "rays.svg"));
  await page.locator("#tab-walk").click();
  await page.waitForSelector(".events button");
  await page.keyboard.press(".");
  await page.waitForSelector('.events [aria-current="true"]');
  await page.locator("#walk-accelerator").selectOption("octree");
  await page.waitForFunction(() => /octree/.test(document.querySelector(".space-say strong").textContent));
  await page.locator(".space-tools button", { hasText: "Table" }).click();
  await page.waitForSelector("#table tbody tr");
  assert.ok(await page.locator("#table tbody tr").count() >= 5);
  assert.match(await page.locator("#table").innerText(), /bit for bit/);
  await page.keyboard.press("Escape");
  say("the rays are stepped through in space, and through an accelerator");
  await page.locator("#tab-tree").click();

  await page.locator("#language").click();
  assert.equal(await page.evaluate(() => document.documentElement.lang), "de");
  assert.match(await page.locator("#tab-tree").innerText(), /Strahlen/);
  await page.waitForSelector("#export");
  const [download] = await Promise.all([page.waitForEvent("download"), page.locator("#export").click()]);
  const leaf = join(folder, "leaf.html");
  await download.saveAs(leaf);
  const [tree] = await Promise.all([page.waitForEvent("download"), page.locator("#export-svg").click()]);
  await tree.saveAs(join(folder, "tree.svg"));
  say("the page speaks German");

  const other = await context.newPage();
  other.on("pageerror", (error) => problems.push(String(error)));
  await other.goto(pathToFileURL(leaf).href);
  await other.waitForSelector(".pixel [data-sum]");
  assert.match(await other.locator(".ray-body").first().innerText(), /Primärstrahl/);
  for (const name of ["tree.svg", "rays.svg"]) {
    await other.goto(pathToFileURL(join(folder, name)).href);
    assert.ok(await other.evaluate(() => document.documentElement.localName === "svg" && document.querySelectorAll("path").length > 0), name);
  }
  await other.close();
  say("an exported pixel opens from disk");

  await page.locator("#language").click();
  const before = await page.evaluate(() => document.body.dataset.finished);
  await page.keyboard.press("c");
  const box = await page.locator("#picture").boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.down();
  for (let i = 1; i <= 10; i += 1) await page.mouse.move(box.x + box.width / 2 + 8 * i, box.y + box.height / 2 + 2 * i);
  await page.mouse.up();
  await finished(before);
  assert.match(decodeURIComponent(page.url()), /camera=/);
  await page.locator("#save-menu > summary").click();
  await page.locator("#copy").click();
  await page.waitForFunction(() => window.copiedText?.startsWith("camera {"));
  await page.locator("#reset").click();
  await assertEventually(async () => assert.deepEqual(await codes(), ppm("whole.ppm")));
  say("the camera turns, is copied, and comes back");

  await page.keyboard.press("?");
  await page.waitForSelector("#help[open]");
  await page.keyboard.press("Escape");
  await page.waitForSelector("#help:not([open])", { state: "attached" });
  assert.deepEqual(problems, []);
  const host = new URL(address).host;
  assert.deepEqual(requests.filter((url) => /^(https?|wss?):/.test(url) && new URL(url).host !== host), []);
  say("no errors, and no request to the outside");
} catch (error) {
  await page.screenshot({ path: join(process.env.STRAHL_SHOTS ?? folder, "failed.png") }).catch(() => {});
  console.error(problems.join("\n"));
  console.error(error);
  process.exitCode = 1;
} finally {
  await browser.close();
}

async function assertEventually(check) {
  for (let i = 0; ; i += 1) {
    try {
      await check();
      return;
    } catch (error) {
      if (i >= 100) throw error;
      await new Promise((resolve) => setTimeout(resolve, 100));
    }
  }
}
