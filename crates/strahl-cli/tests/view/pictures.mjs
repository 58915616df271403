// Pictures: how they come, how they are shown, compared, moved and shared.

import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { HEIGHT, Viewer, WIDTH, eventually, open, original, others, ppm, same, say, scene, watch } from "./bench.mjs";

export async function first(viewer) {
  await viewer.finished();
  same(await viewer.codes(), ppm("whole.ppm"));
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
  // A number that is typed and left by a click on a button counts, and so does the click.
  await viewer.find("#side-depth").fill("");
  await viewer.find("#lights").click();
  await page.waitForSelector("#lights-panel:not([hidden])");
  await viewer.find("#lights").click();
  assert.equal((await viewer.state()).compare.depth, null);
  await viewer.find("#channel").selectOption("steps");
  const scale = async () => Number(/0 … ([\d.]+)/.exec(await viewer.find("#state").innerText())?.[1]);
  const settled = async (accelerator, check) => eventually(async () => {
    assert.match(await viewer.find(".stats").innerText(), accelerator);
    assert.ok(check(await scale()), `${await scale()}`);
  });
  await viewer.find("#side-accelerator").selectOption("octree");
  await eventually(async () => assert.ok(!(await viewer.codes()).equals(await viewer.codes("side"))));
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
  // Where counts are shown, a comparison begins with another accelerator, side by side, and a scale of the colours.
  await settled(/bvh/, (now) => now < together);
  assert.match(await viewer.find("#heat").innerText(), /0\s+[\d.]+ Steps/);
  await page.keyboard.press("x");
  const { compare, beside } = await viewer.state();
  assert.deepEqual([compare, beside], [{ accelerator: "grid" }, true]);
  await eventually(async () => assert.ok(!(await viewer.codes()).equals(await viewer.codes("side"))));
  await page.keyboard.press("x");
  await page.waitForSelector("#side-panel", { state: "hidden" });
  await viewer.find("#channel").selectOption("color");
  await viewer.shows(ppm("whole.ppm"));
  assert.ok(await viewer.find("#heat").isHidden());
  await viewer.find("#compare").click();
  await viewer.find("#side-view").selectOption("");
  await viewer.find("#compare").click();
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
  await viewer.address(/clock=0.5/);
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
  const drag = async (dx, dy, steps) => {
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x + dx, y + dy, { steps });
    await page.mouse.up();
  };
  let before = await viewer.sha();
  await page.keyboard.press("c");
  await drag(80, 20, 10);
  await viewer.finished(before);
  await viewer.address(/camera=/);
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
  // In one step, so that one picture comes.
  await drag(-60, 0, 1);
  await viewer.finished(before);
  await viewer.address(/lights=\{"0":\[/);
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

// A link shows the same in another window: everything that somebody can set.
export async function shared(viewer) {
  const { page } = viewer;
  const whole = ppm("whole.ppm");
  writeFileSync(scene, original.replace("<0, 0, 0>, 1", "<clock, 0, 0>, 1"));
  await page.waitForSelector("#timeline:not([hidden])");
  await viewer.find("#clock-slider").fill("0.25");
  await viewer.find("#sampling").selectOption("2x2");
  await viewer.field("depth", "3");
  await viewer.field("exposure", "0.5");
  await viewer.find("#more > summary").click();
  await viewer.find("#curve").selectOption("filmic");
  await viewer.find("#shading").selectOption("lambert");
  await viewer.find("#accelerator").selectOption("octree");
  await viewer.field("cutoff", "0.01");
  await page.keyboard.press("Escape");
  await page.keyboard.press("g");
  await viewer.field("light-y", "5");
  await page.keyboard.press("Escape");
  await page.keyboard.press("c");
  const [x, y] = await viewer.at(80, 60);
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 20, y + 5);
  await page.mouse.up();
  await page.keyboard.press("c");
  await viewer.click(85, 70);
  await page.mouse.wheel(0, -300);
  await viewer.find("#compare").click();
  await viewer.find("#side-accelerator").selectOption("grid");
  await viewer.find("#side-view").selectOption("");
  const line = await viewer.find("#swipe").boundingBox();
  await page.mouse.move(line.x + line.width / 2, line.y + 40);
  await page.mouse.down();
  await page.mouse.move(line.x - 60, line.y + 40);
  await page.mouse.up();
  await viewer.find("#side-view").selectOption("beside");
  await page.waitForSelector(".sample:nth-child(3)");
  await viewer.find(".sample:nth-child(3)").click();
  await viewer.find("#tab-space").click();
  await page.keyboard.press(".");
  await page.keyboard.press(".");
  const box = await viewer.find(".space-box").boundingBox();
  await page.mouse.move(box.x + 100, box.y + 100);
  await page.mouse.wheel(0, 200);
  await page.mouse.wheel(0, 100);
  await viewer.find("#language").click();
  const set = ["clock", "sampling", "depth", "exposure", "curve", "shading", "accelerator", "cutoff", "lights", "camera", "zoom", "compare", "split", "beside", "pixel", "sample", "panel", "step", "outside", "language"];
  await viewer.address(...set.map((key) => new RegExp(`[#&]${key}=`)));
  const state = await viewer.state();
  // What a page asks the server for, by slot.
  const asked = (one) => Object.fromEntries(["main", "side", "space"].map((slot) => [slot, one.page.sent.findLast((message) => message.type === "picture" && message.slot === slot)]));
  const other = new Viewer(await watch(await page.context().newPage()));
  // The address may be written a moment after the last movement.
  await eventually(async () => assert.deepEqual(JSON.parse(new URLSearchParams(new URL(page.url()).hash.slice(1)).get("outside")), state.outside));
  await other.page.goto(page.url());
  await other.finished();
  await other.page.waitForFunction(() => /Schritt 2 von/.test(document.querySelector(".space-say")?.textContent));
  assert.deepEqual(await other.state(), state);
  await eventually(async () => assert.deepEqual(asked(other), asked(viewer)));
  await eventually(async () => same(await other.codes(), await viewer.codes()));
  await eventually(async () => same(await other.codes("side"), await viewer.codes("side")));
  const places = (one) => one.page.evaluate(() => ["picture", "side", "swipe"].map((id) => { const { x, y, width, height } = document.getElementById(id).getBoundingClientRect(); return [x, y, width, height].map(Math.round); }));
  assert.deepEqual(await places(other), await places(viewer));
  await other.find("#tab-tree").click();
  assert.equal(await other.find(".sample:nth-child(3)").getAttribute("aria-pressed"), "true");
  // A link in the address of a page that is open.
  await viewer.find("#channel").selectOption("steps");
  await viewer.address(/channel=steps/);
  const again = other.page.waitForEvent("load");
  await other.page.goto(page.url());
  await again;
  await other.finished();
  // A picture of counts has one sample a pixel: both pages go to the first one when its tree has come.
  await eventually(async () => {
    const now = await viewer.state();
    assert.equal(now.sample, 0);
    assert.deepEqual(await other.state(), now);
  });
  await other.find("#tab-walk").click();
  await other.page.waitForSelector(".events button");
  await other.find("#walk-accelerator").selectOption("spheres");
  await other.address(/panel=walk/, /walk=spheres/);

  // What somebody has spoilt in an address is passed over.
  const spoilt = "#depth=x&camera={&pixel=[-1]&lights=[1]&compare=3&channel=none&size=[0,0]&zoom=[0,1,2]&split=7&sample=-1&step=x&outside=[]&walk=none";
  writeFileSync(scene, original);
  await page.waitForSelector("#timeline .figures");
  const loaded = other.page.waitForEvent("load");
  await other.page.goto(page.url().split("#")[0] + spoilt);
  await loaded;
  await other.finished();
  await other.shows(whole);
  await other.page.close();
  await page.goto(page.url().split("#")[0]);
  await viewer.finished();
  await viewer.find("#language").click();
  await page.waitForFunction(() => !location.hash);
  await viewer.shows(whole);
  say("the address keeps everything that was set");
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
  await viewer.address(/scene=lecture/);
  // With all that it can have.
  await viewer.page.keyboard.press("g");
  await viewer.field("light-x", "1");
  await viewer.page.waitForSelector("#reset");
  for (const language of ["English", "German"]) {
    await viewer.oneLine(`built-in scenes, ${language}`);
    await viewer.find("#language").click();
  }
  await viewer.page.waitForFunction(() => document.querySelectorAll(".text-line").length > 5 && document.querySelector(".tab").title.includes("01_principle"));
  await viewer.page.context().close();
  say("the scenes that are built in are offered");
}
