// Drawings as SVG: the tree of a sample's rays, and a pen that writes down what a canvas would show.

import { css, number, triple } from "./numbers.js";
import { word } from "./words.js";

const escaped = (text) => String(text).replace(/[&<>"]/g, (c) => ({ "&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;" })[c]);
const short = (text, most) => (text.length > most ? `${text.slice(0, most - 1)}…` : text);

function file(width, height, content) {
  return `<svg xmlns="http://www.w3.org/2000/svg" width="${width}" height="${height}" viewBox="0 0 ${width} ${height}">\n${content.join("\n")}\n</svg>\n`;
}

// A pen with those methods of a canvas's pen that the drawing in space needs.
export class SvgPen {
  constructor(width, height) {
    this.size = [width, height];
    this.parts = [];
    this.dash = [];
    this.path = "";
  }

  picture(canvas) {
    const [width, height] = this.size;
    this.parts.push(`<image width="${width}" height="${height}" preserveAspectRatio="none" href="${canvas.toDataURL("image/png")}"/>`);
  }

  setLineDash(dash) { this.dash = dash; }
  beginPath() { this.path = ""; }
  moveTo(x, y) { this.path += `M${x.toFixed(2)} ${y.toFixed(2)}`; }
  lineTo(x, y) { this.path += `L${x.toFixed(2)} ${y.toFixed(2)}`; }
  stroke() {
    const dash = this.dash.length ? ` stroke-dasharray="${this.dash.join(" ")}"` : "";
    this.parts.push(`<path d="${this.path}" fill="none" stroke="${escaped(this.strokeStyle)}" stroke-width="${this.lineWidth}" stroke-linecap="round"${dash}/>`);
  }

  fill() { this.parts.push(`<path d="${this.path}Z" fill="${escaped(this.fillStyle)}"/>`); }
  text(text, x, y, paint) { this.parts.push(`<text x="${x.toFixed(2)}" y="${y.toFixed(2)}" font-family="sans-serif" font-size="12" font-weight="600" ${paint}>${escaped(text)}</text>`); }
  strokeText(text, x, y) { this.text(text, x, y, `fill="none" stroke="${escaped(this.strokeStyle)}" stroke-width="${this.lineWidth}"`); }
  fillText(text, x, y) { this.text(text, x, y, `fill="${escaped(this.fillStyle)}"`); }
  toString() { return file(...this.size, this.parts); }
}

// The tree of a sample's rays, from the top down; `colors` has one for each kind of ray.
export function treeSvg(sample, title, colors) {
  const byId = new Map(sample.rays.map((ray) => [ray.id, ray]));
  const [wide, high, gapX, gapY, margin, top] = [176, 62, 14, 40, 16, 40];
  const place = new Map();
  let next = 0;
  let deepest = 0;
  const put = (ray, level) => {
    deepest = Math.max(deepest, level);
    const children = ray.children.map((id) => byId.get(id)).filter(Boolean);
    const columns = children.map((child) => put(child, level + 1));
    const column = columns.length ? (columns[0] + columns.at(-1)) / 2 : next++;
    place.set(ray.id, [margin + column * (wide + gapX), top + level * (high + gapY)]);
    return column;
  };
  put(sample.rays[0], 0);
  const parts = ['<rect width="100%" height="100%" fill="#ffffff"/>', `<text x="${margin}" y="24" font-family="sans-serif" font-size="14" font-weight="600">${escaped(title)}</text>`];
  const drawn = sample.rays.filter((ray) => place.has(ray.id));
  for (const ray of drawn) {
    const parent = place.get(ray.parent);
    if (!parent) continue;
    const [x, y] = place.get(ray.id);
    const color = colors[ray.kind];
    parts.push(`<path d="M${parent[0] + wide / 2} ${parent[1] + high}C${parent[0] + wide / 2} ${y - 10} ${x + wide / 2} ${parent[1] + high + 10} ${x + wide / 2} ${y}" fill="none" stroke="${color}" stroke-width="1.5"/>`);
    parts.push(`<text x="${x + wide / 2 + 5}" y="${y - 6}" font-family="sans-serif" font-size="10" fill="${color}">${ray.kind === "reflection" ? "kr" : "kt"} = ${escaped(ray.share.every((c) => c === ray.share[0]) ? number(ray.share[0], 3) : triple(ray.share, 3))}</text>`);
  }
  for (const ray of drawn) {
    const [x, y] = place.get(ray.id);
    const what = ray.hit ? ray.hit.object : word("background");
    parts.push(`<g font-family="sans-serif" font-size="11"><title>${escaped(`${what}${ray.hit?.source ? `, ${ray.hit.source}` : ""}`)}</title>`,
      `<rect x="${x}" y="${y}" width="${wide}" height="${high}" rx="4" fill="#fbfbfa" stroke="${colors[ray.kind]}"/>`,
      `<rect x="${x + 8}" y="${y + 8}" width="14" height="14" rx="2" fill="${css(ray.total)}" stroke="#888888"/>`,
      `<text x="${x + 28}" y="${y + 19}" font-weight="600">${escaped(`${word(ray.kind)} #${ray.id}`)}</text>`,
      `<text x="${x + 8}" y="${y + 37}">${escaped(short(`${what}${ray.hit ? `, t = ${number(ray.hit.t, 4)}` : ""}`, 30))}</text>`,
      `<text x="${x + 8}" y="${y + 53}" fill="#5d6268">${escaped(triple(ray.total, 4))}</text></g>`);
  }
  const width = 2 * margin + Math.max(next * (wide + gapX) - gapX, 240);
  return file(width, top + (deepest + 1) * (high + gapY) - gapY + margin, parts);
}
