// Uses the viewer as a person does, in one window after the other; see bench.mjs.

import { join } from "node:path";
import { Viewer, address, browser, folder, open, problems, quiet, say } from "./bench.mjs";
import * as people from "./people.mjs";
import * as pictures from "./pictures.mjs";
import * as pixels from "./pixels.mjs";
import * as texts from "./texts.mjs";

const page = await open();
const viewer = new Viewer(page);
try {
  await page.goto(address);
  await pictures.first(viewer);
  await texts.shown(viewer);
  await pixels.explained(viewer);
  await people.readable(viewer);
  await pictures.shown(viewer);
  await texts.changed(viewer);
  await texts.tried(viewer);
  await pictures.compared(viewer);
  await pictures.played(viewer);
  await pictures.moved(viewer);
  await pictures.shared(viewer);
  const rays = await pixels.inSpace(viewer);
  await pixels.walked(viewer);
  await people.german(viewer);
  await pixels.exported(viewer, rays);
  await people.english(viewer);
  await people.touched();
  await people.reconnected();
  await pictures.builtIn();
  quiet();
  say("no errors, and no request to the outside");
} catch (error) {
  for (const [number, one] of browser.contexts().flatMap((context) => context.pages()).entries()) {
    await one.screenshot({ path: join(process.env.STRAHL_SHOTS ?? folder, `failed-${number}.png`) }).catch(() => {});
  }
  console.error(problems.join("\n"));
  console.error(error);
  process.exitCode = 1;
} finally {
  await browser.close();
}
