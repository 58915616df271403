// What is saved or copied: pictures, pages, drawings, and texts for the scene.

import { copy, download, toast } from "./controls.js";
import { state } from "./state.js";
import { treeSvg } from "./svg.js";
import { getLanguage, word } from "./words.js";

// The actions of the buttons that save. `page` has scene, current, explained, looked, stage and space; `link` leads to the server.
export function saving(page, link) {
  const name = () => (page.scene?.name ?? "picture").split(/[\\/]/).pop();
  const stem = () => name().replace(/\.[^.]*$/, "");
  // Asks for something, and says why there is none.
  const ask = async (message, use) => {
    try {
      await use(await link.ask({ slot: "main", ...message }));
    } catch (problem) { toast(problem.message); }
  };
  const html = (message, file) => ask({ ...message, language: getLanguage() }, (answer) => download(new Blob([answer.html], { type: "text/html" }), file));
  const svg = (text, what) => download(new Blob([text], { type: "image/svg+xml" }), `${what}-${page.explained.pixel.join("-")}.svg`);
  const take = (message, part) => ask(message, async ({ text }) => {
    await copy(text);
    toast(`${word("copied")}: ${part(text.split("\n"))}`);
  });
  return {
    svg,
    png: () => page.stage.film.canvas.toBlob((blob) => download(blob, `${stem()}.png`)),
    async exr() {
      try {
        const answer = await fetch(`picture/${page.current.picture}.exr`);
        if (answer.ok) download(await answer.blob(), `${stem()}.exr`);
        else toast(await answer.text());
      } catch { toast(word("lost")); }
    },
    // The picture with its objects, and the trees of the pixels that were looked at and of some more, as a page that needs no server.
    page() {
      toast(word("exporting"));
      return html({ type: "export_picture", pixels: page.looked }, `${stem()}.html`);
    },
    pixel() {
      const [x, y] = state.pixel;
      return html({ type: "export", x, y }, `pixel-${x}-${y}.html`);
    },
    tree() {
      const { explained, space } = page;
      const ink = (kind) => getComputedStyle(document.documentElement).getPropertyValue(`--${kind}`).trim();
      const colors = Object.fromEntries(["primary", "reflection", "transparency"].map((kind) => [kind, ink(kind)]));
      const sample = explained.samples[space.sample] ?? explained.samples[0];
      svg(treeSvg(sample, `${name()}, ${word("pixel")} ${explained.pixel.join(", ")}`, colors), "tree");
    },
    copyCamera: () => take({ type: "camera_text" }, (lines) => lines[2].trim()),
    copyLight: (light) => take({ type: "light_text", light }, (lines) => `${lines.slice(0, 2).join(" ")} …`),
  };
}
