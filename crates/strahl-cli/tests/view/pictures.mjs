// Pictures: how they come, how they are shown, compared, moved and shared.

import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { HEIGHT, Viewer, WIDTH, eventually, open, original, others, ppm, say, scene, watch } from "./bench.mjs";

export async function first(viewer) {
  await viewer.finished();
  assert.deepEqual(await viewer.codes(), ppm("whole.ppm"));
  assert.ok(viewer.page.steps.includes(8) && viewer.page.steps.includes(1), "coarse pixels come first");
  say("the picture comes coarse first, and has the bytes of strahl render when it is finished");
}

export async function shown(viewer) {
  const whole = ppm("whole.ppm");
  await viewer.field("exposure", "1");
  await viewer.showsOther(whole);
  const brighter = await viewer.codes();
  await viewer.find("#more > summary").click();
  await viewer.find("#curve").selectOption("reinhard");
  await viewer.showsOther(brighter, whole);
  assert.ok(Math.max(...await viewer.codes()) < 255);
  await viewer.find("#curve").selectOption("srgb");
  await viewer.field("exposure", "0");
  await viewer.shows(whole);
  const seen = [whole];
  for (const channel of ["normal", "depth", "object", "material", "levels", "tests", "steps", "rays", "time"]) {
    await viewer.find("#channel").selectOption(channel);
    await viewer.showsOther(...seen);
    if (channel !== "object" && channel !== "time") seen.push(await viewer.codes());
  }
  await viewer.find("#channel").selectOption("color");
  await viewer.shows(whole);
  await viewer.find("#save-menu > summary").click();
  const exr = readFileSync(await viewer.download("#exr", "saved.exr"));
  assert.deepEqual([...exr.subarray(0, 4)], [0x76, 0x2f, 0x31, 0x01]);
  const png = readFileSync(await viewer.download("#png", "saved.png"));
  assert.equal(png.subarray(1, 4).toString(), "PNG");
  await viewer.page.keyboard.press("Escape");
  say("exposure, tone curves and channels change what is shown; PNG and EXR are saved");

  const [x, y] = await viewer.at(80, 60);
  await viewer.page.mouse.move(x, y);
  for (let i = 0; i < 12; i += 1) await viewer.page.mouse.wheel(0, -240);
  await eventually(async () => assert.ok(viewer.page.sent.some((one) => one.type === "linear"), "values are asked for"));
  const zoomed = await viewer.find("#picture").boundingBox();
  assert.ok(zoomed.width / WIDTH >= 64);
  await viewer.page.keyboard.press("f");
  const fitted = await viewer.find("#picture").boundingBox();
  assert.ok(fitted.width < 1280);
  say("the picture is zoomed to single pixels with their values");
}

export async function compared(viewer) {
  const { page } = viewer;
  await viewer.find("#compare").click();
  await page.waitForSelector("#side-panel:not([hidden])");
  await page.waitForFunction((width) => document.getElementById("side").width === width, WIDTH);
  await viewer.shows(ppm("depth1.ppm"), "side");
  const clip = () => page.evaluate(() => document.getElementById("side").style.clipPath);
  const before = await clip();
  const line = await viewer.find("#swipe").boundingBox();
  await page.mouse.move(line.x + line.width / 2, line.y + 40);
  await page.mouse.down();
  await page.mouse.move(line.x - 60, line.y + 40);
  await page.mouse.up();
  assert.notEqual(await clip(), before, "the line is dragged");
  await viewer.find("#side-view").selectOption("beside");
  const halves = await page.evaluate(() => ["picture", "side"].map((id) => document.getElementById(id).getBoundingClientRect().x));
  const stage = await viewer.find("#stage").boundingBox();
  assert.ok(Math.abs(halves[1] - halves[0] - stage.width / 2) < 1);
  say("two settings are compared, with a line to drag and side by side");

  // Alone each has its own scale; together they have the larger one, so that equal colours mean equal numbers.
  await viewer.field("side-depth", "");
  await viewer.find("#channel").selectOption("steps");
  const scale = async () => Number(/0 … ([\d.]+)/.exec(await viewer.find("#state").innerText())?.[1]);
  const settled = async (accelerator, check) => eventually(async () => {
    assert.match(await viewer.find(".stats").innerText(), accelerator);
    assert.ok(check(await scale()), `${await scale()}`);
  });
  await viewer.find("#side-accelerator").selectOption("octree");
  await eventually(async () => assert.notDeepEqual(await viewer.codes(), await viewer.codes("side")));
  await settled(/bvh/, (now) => now > 0);
  const together = await scale();
  await viewer.find("#compare").click();
  await settled(/bvh/, (now) => now > 0);
  // Shown alone again, with its own scale.
  await viewer.find("#channel").selectOption("color");
  await viewer.shows(ppm("whole.ppm"));
  await viewer.find("#channel").selectOption("steps");
  await settled(/bvh/, (now) => now < together);
  await viewer.find("#more > summary").click();
  await viewer.find("#accelerator").selectOption("octree");
  await settled(/octree/, (now) => now === together);
  await viewer.find("#accelerator").selectOption("");
  await page.keyboard.press("Escape");
  await viewer.find("#channel").selectOption("color");
  await viewer.shows(ppm("whole.ppm"));
  say("two pictures of counts have one scale");
}

export async function played(viewer) {
  const { page } = viewer;
  assert.ok(await viewer.find("#timeline").isHidden());
  const last = await viewer.sha();
  writeFileSync(scene, original.replace("<0, 0, 0>, 1", "<clock, 0, 0>, 1"));
  await page.waitForSelector("#timeline:not([hidden])");
  await viewer.find("#clock-slider").fill("0.5");
  const half = await viewer.finished(last);
  assert.match(page.url(), /clock=0.5/);
  await viewer.find("#play-clock").click();
  await page.waitForFunction((known) => document.body.dataset.finished !== known && Number(document.getElementById("clock-slider").value) > 0.55, half);
  await viewer.find("#play-clock").click();
  writeFileSync(scene, original);
  await viewer.find("#more > summary").click();
  await viewer.field("clock", "");
  await page.keyboard.press("Escape");
  await viewer.shows(ppm("whole.ppm"));
  await page.waitForSelector("#timeline", { state: "hidden" });
  say("a scene with clock has a timeline");
}

export async function moved(viewer) {
  const { page } = viewer;
  const whole = ppm("whole.ppm");
  const [x, y] = await viewer.at(WIDTH / 2, HEIGHT / 2);
  const drag = async (dx, dy) => {
    await page.mouse.move(x, y);
    await page.mouse.down();
    for (let i = 1; i <= 10; i += 1) await page.mouse.move(x + (dx * i) / 10, y + (dy * i) / 10);
    await page.mouse.up();
  };
  let before = await viewer.sha();
  await page.keyboard.press("c");
  await drag(80, 20);
  await viewer.finished(before);
  await viewer.settled();
  assert.match(decodeURIComponent(page.url()), /camera=/);
  await viewer.find("#save-menu > summary").click();
  await viewer.find("#copy").click();
  await page.waitForFunction(() => window.copiedText?.startsWith("camera {"));
  await page.keyboard.press("Escape");
  await viewer.find("#reset").click();
  await viewer.shows(whole);
  await page.keyboard.press("c");
  say("the camera turns, is copied, and comes back");

  await page.keyboard.press("g");
  await page.waitForSelector("#lights-panel:not([hidden])");
  before = await viewer.sha();
  await drag(-60, 0);
  await viewer.finished(before);
  await viewer.settled();
  assert.match(decodeURIComponent(page.url()), /lights=\{"0":\[/);
  await viewer.find("#copy-light").click();
  await page.waitForFunction(() => window.copiedText?.startsWith("light_source {"));
  const text = await page.evaluate(() => window.copiedText);
  const x0 = Number(await viewer.find("#light-x").inputValue());
  assert.ok(x0 < 4 && text.includes(`<${x0}, `), text);
  // The text in the scene gives the picture with the dragged light.
  const dragged = await viewer.codes();
  await viewer.find("#reset-lights").click();
  await viewer.shows(whole);
  writeFileSync(scene, original.replace("light_source { <4, 6, -5>, 1 }", text));
  await viewer.shows(dragged);
  writeFileSync(scene, original);
  await viewer.shows(whole);
  await viewer.field("light-y", "2");
  await viewer.showsOther(whole, dragged);
  await page.keyboard.press("Escape");
  await viewer.find("#reset").click();
  await viewer.shows(whole);
  await viewer.find("#lights").click();
  await page.waitForSelector("#lights-panel", { state: "hidden" });
  say("a light is dragged, and copied as text");
}

// A link shows the same in another window.
export async function shared(viewer) {
  const { page } = viewer;
  await viewer.field("depth", "1");
  await viewer.shows(ppm("depth1.ppm"));
  await viewer.click(70, 50);
  await viewer.find("#tab-space").click();
  await viewer.find("#compare").click();
  await viewer.find("#side-accelerator").selectOption("octree");
  const other = new Viewer(await watch(await page.context().newPage()));
  await other.page.goto(page.url());
  await other.finished();
  await other.shows(ppm("depth1.ppm"));
  assert.equal(await other.find("#depth").inputValue(), "1");
  assert.equal(await other.find("#side-accelerator").inputValue(), "octree");
  await other.page.waitForSelector(".space-box canvas");
  assert.match(decodeURIComponent(other.page.url()), /pixel=\[70,50\]/);
  // What somebody has spoilt in an address is passed over.
  await other.page.goto("about:blank");
  await other.page.goto(`${page.url().split("#")[0]}#depth=x&camera={&pixel=[-1]&lights=[1]&compare=3&channel=none&size=[0,0]`);
  await other.finished();
  await other.shows(ppm("whole.ppm"));
  await other.page.close();
  await viewer.find("#compare").click();
  await viewer.find("#tab-tree").click();
  await viewer.field("depth", "");
  await viewer.shows(ppm("whole.ppm"));
  say("the address keeps the state");
}

// Without a scene of its own, the viewer offers those that are built in.
export async function builtIn() {
  const viewer = new Viewer(await open());
  await viewer.page.goto(others);
  const sha = await viewer.finished();
  const names = await viewer.find("#scene option").allInnerTexts();
  for (const folder of ["showcase/", "lecture/", "gallery/"]) assert.ok(names.filter((name) => name.startsWith(folder)).length > 5, folder);
  await viewer.find("#scene").selectOption("lecture/01_principle.pov");
  await viewer.finished(sha);
  assert.match(viewer.page.url(), /scene=lecture/);
  await viewer.oneLine("built-in scenes");
  await viewer.page.waitForFunction(() => document.querySelectorAll(".text-line").length > 5 && document.querySelector(".tab").title.includes("01_principle"));
  await viewer.page.context().close();
  say("the scenes that are built in are offered");
}
