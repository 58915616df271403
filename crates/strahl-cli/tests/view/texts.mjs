// The texts of the scene: shown, changed on the disk and in the page, with errors and warnings.

import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { ball, eventually, folder, original, ppm, same, say, scene } from "./bench.mjs";

export async function shown(viewer) {
  const { page } = viewer;
  await page.waitForSelector(".text-line");
  assert.equal(await viewer.find(".k5", { hasText: /^sphere$/ }).count(), 1);
  assert.equal(await viewer.find(".tab", { hasText: "ball.inc" }).count(), 1);
  await viewer.find(".tab", { hasText: "colors.inc" }).click();
  await page.waitForFunction(() => /a part of strahl/.test(document.querySelector(".text-tools").textContent));
  assert.equal(await viewer.find("#try").count(), 0, "what is built in stays as it is");
  assert.match(await viewer.find("#lines").innerText(), /Red/);
  await viewer.find(".tab", { hasText: "scene.pov" }).click();
  await page.waitForSelector("#try");
  say("the text is shown, coloured, with included files as tabs, also those that are built in");

  await viewer.click(80, 70);
  await viewer.find("#inspector .tree button.place").first().click();
  await page.waitForSelector('.text-line.under[data-line="7"]');
  await viewer.find('.text-line[data-line="8"]').click();
  await page.waitForSelector('.text-line.marked[data-line="7"]');
  // The author's editor opens the line.
  await viewer.find("#editor").click();
  await eventually(async () => assert.equal(readFileSync(join(folder, "edited-8"), "utf8"), original));
  await page.keyboard.press("Escape");
  await page.mouse.move(...await viewer.at(20, 110));
  await page.waitForSelector('.text-line.under[data-line="12"]');
  assert.match(await viewer.find("#mouse").innerText(), /plane · line 12/);
  say("places lead to lines, lines mark their pixels, and the mouse marks the line under it; the editor opens it");
}

export async function changed(viewer) {
  const { page } = viewer;
  const whole = ppm("whole.ppm");
  let sha = await viewer.sha();
  writeFileSync(join(folder, "ball.inc"), "#declare Ball = <0.1, 0.3, 1>;\n");
  sha = await viewer.finished(sha);
  const blue = await viewer.codes();
  assert.ok(!blue.equals(whole));
  writeFileSync(scene, original.replace("<0, 0, 0>, 1", "<0, 0, 0>, 0.7"));
  await viewer.finished(sha);
  await viewer.showsOther(blue, whole);
  writeFileSync(scene, original);
  await viewer.shows(blue);
  say("a changed scene and a changed include file are rendered");

  writeFileSync(scene, original.replace("pigment { rgb Ball }", "pigment { rgb Ball "));
  await page.waitForSelector("#problems:not([hidden]) .caret");
  same(await viewer.codes(), blue);
  assert.ok(await viewer.find(".text-line.bad[data-said]").count() >= 1);
  await viewer.accessible("errors");
  writeFileSync(scene, original);
  await page.waitForSelector("#problems", { state: "hidden" });
  assert.equal(await viewer.find(".text-line.bad").count(), 0);
  writeFileSync(join(folder, "ball.inc"), ball);
  await viewer.shows(whole);
  say("an error is shown over the last picture, and disappears");

  writeFileSync(scene, original.replace("light_source", '#warning "too bright"\nlight_source'));
  await page.waitForSelector("#warnings");
  assert.match(await viewer.find("#warnings").innerText(), /1 warning/);
  await page.waitForSelector(".text-line.warned");
  assert.ok(await viewer.find("#problems").isHidden());
  await viewer.find("#warnings").click();
  await page.waitForSelector("#problems:not([hidden])");
  assert.match(await viewer.find("#problems").innerText(), /warning: .*too bright/);
  await viewer.accessible("warnings");
  await viewer.find("#warnings").click();
  assert.ok(await viewer.find("#problems").isHidden());
  writeFileSync(scene, original);
  await page.waitForSelector("#warnings", { state: "detached" });
  say("warnings are counted, listed and marked in the margin");
}

export async function tried(viewer) {
  const { page } = viewer;
  const whole = ppm("whole.ppm");
  await viewer.find("#try").click();
  await viewer.find("#writer").fill(original.replace("<0, 0, 0>, 1", "<0, 0, 0>, 0.5"));
  await viewer.showsOther(whole);
  const small = await viewer.codes();
  assert.equal(readFileSync(scene, "utf8"), original);
  // The text of an include file at the same time.
  await viewer.find(".tab", { hasText: "ball.inc" }).click();
  await page.waitForFunction(() => /Ball/.test(document.getElementById("lines").textContent) && !document.getElementById("writer"));
  await viewer.find("#try").click();
  await viewer.find("#writer").fill("#declare Ball = <0, 1, 0>;\n");
  await viewer.showsOther(whole, small);
  assert.equal(readFileSync(join(folder, "ball.inc"), "utf8"), ball);
  assert.equal(await viewer.find(".tab", { hasText: "●" }).count(), 2);
  await viewer.find(".tab", { hasText: "scene.pov" }).click();
  await page.waitForFunction(() => document.getElementById("writer")?.value.includes("0.5"));
  await viewer.accessible("a text that is being changed");
  await viewer.find("#try").click();
  await viewer.find(".tab", { hasText: "ball.inc" }).click();
  await page.waitForFunction(() => document.getElementById("writer")?.value.includes("<0, 1, 0>"));
  // With --edit the page writes the file.
  await viewer.find("#save").click();
  await page.waitForSelector("#writer", { state: "detached" });
  assert.equal(readFileSync(join(folder, "ball.inc"), "utf8"), "#declare Ball = <0, 1, 0>;\n");
  writeFileSync(join(folder, "ball.inc"), ball);
  await viewer.find(".tab", { hasText: "scene.pov" }).click();
  await viewer.shows(whole);
  say("texts are tried without writing them, those of include files too, and written with --edit");
}
