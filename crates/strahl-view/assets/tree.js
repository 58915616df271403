// The ray tree of a pixel: one node for each ray, with its numbers in place.

import { brightness, css, el, isBlack, isGray, number, swatch, times, triple } from "./numbers.js";
import { dot, equation, factored, infix, math, power, product, sign, sum, symbol, value, vector } from "./formula.js";
import { lightName, word } from "./words.js";

// What each ray of a sample adds to it: a map from the number of the ray.
export function contributions(sample) {
  const byId = new Map(sample.rays.map((ray) => [ray.id, ray]));
  const through = new Map();
  const adds = new Map();
  for (const ray of sample.rays) {
    const parent = ray.parent === null ? null : byId.get(ray.parent);
    let factor = [1, 1, 1];
    if (parent) {
      const bent = ray.total.map((c) => (ray.power === 1 || c <= 0 ? 1 : c ** ray.power / c));
      factor = times(times(times(through.get(parent.id), parent.attenuation), ray.share), bent);
    }
    through.set(ray.id, factor);
    let own = [...ray.total];
    for (const id of ray.children) {
      const child = byId.get(id);
      if (!child) continue;
      const part = child.total.map((c, i) => (child.power === 1 || c <= 0 ? c : c ** child.power) * child.share[i] * ray.attenuation[i]);
      own = own.map((c, i) => c - part[i]);
    }
    // What is left of a difference by rounding is nothing.
    own = own.map((c, i) => (Math.abs(c) < 1e-12 * Math.abs(ray.total[i]) ? 0 : c));
    adds.set(ray.id, times(factor, own));
  }
  return adds;
}

// Shows a pixel and the tree of one of its samples. `actions` may have `onPlace(file, line)`, `onRay(ray or null)` for the ray under the mouse,
// `onSample(index)`.
export function showPixel(pixel, actions = {}, first = 0) {
  const box = el("section", { class: "pixel" });
  // What is cut off is reached with the keyboard, too.
  box.addEventListener("toggle", () => requestAnimationFrame(() => {
    for (const formula of box.querySelectorAll(".formula")) if (formula.scrollWidth > formula.clientWidth) formula.tabIndex = 0;
  }), true);
  const [x, y] = pixel.pixel;
  box.append(
    el("header", { class: "pixel-head" },
      swatch(pixel.color),
      el("div", {},
        el("h2", { text: `${word("pixel")} ${x}, ${y}` }),
        el("p", { class: "dim" }, `${pixel.rgb8.join(" ")} · ${word("linear")} ${triple(pixel.color, 5)}`))),
  );
  const trees = el("div", { class: "trees" });
  const show = (index) => {
    trees.replaceChildren(showSample(pixel.samples[index], actions));
    actions.onSample?.(index);
  };
  if (pixel.samples.length > 1) {
    const list = el("div", { class: "samples", role: "group", "aria-label": word("samples") });
    pixel.samples.forEach((sample, index) => {
      const button = el("button", {
        type: "button", class: "sample", "aria-pressed": String(index === first),
        title: `${word("sample")} ${sample.sample}: ${triple(sample.color)}, ${word("counts")} ${number(sample.share)}`,
        onclick: () => {
          for (const other of list.children) other.setAttribute("aria-pressed", "false");
          button.setAttribute("aria-pressed", "true");
          show(index);
        },
      }, swatch(sample.color), String(sample.sample));
      list.append(button);
    });
    box.append(el("p", { class: "dim", text: `${pixel.samples.length} ${word("samples")} (${pixel.sampling})` }), list);
  }
  box.append(trees);
  if (pixel.samples.length) show(first);
  return box;
}

function showSample(sample, actions) {
  const adds = contributions(sample);
  const most = Math.max(1e-12, ...[...adds.values()].map((c) => brightness(c.map(Math.abs))));
  const byId = new Map(sample.rays.map((ray) => [ray.id, ray]));
  const box = el("div", { class: "tree-box" });
  const primary = sample.rays[0];
  const reasons = whyDark(sample, actions);
  if (reasons) box.append(reasons);
  const root = el("ul", { class: "tree", role: "tree" });
  const grow = (ray, parent) => {
    const node = showRay(ray, adds.get(ray.id), most, byId, actions);
    parent.append(node);
    if (ray.children.length) {
      const list = el("ul", { role: "group" });
      for (const id of ray.children) if (byId.has(id)) grow(byId.get(id), list);
      node.append(list);
    }
  };
  grow(primary, root);
  const total = [...adds.values()].reduce((a, b) => a.map((c, i) => c + b[i]), [0, 0, 0]);
  box.append(root, el("p", { class: "sum dim" }, `${word("sum")} `, el("span", { class: "figures", "data-sum": JSON.stringify(total), text: triple(total, 5) })));
  root.addEventListener("mouseleave", () => actions.onRay?.(null));
  root.querySelector("details").open = true;
  return box;
}

// The place in the scene, which leads there. Inside of a summary, which is a button itself, it is one for the mouse only.
function place(source, actions, inside = false) {
  if (!source) return null;
  const match = /^(.*?):(\d+)(?::\d+)?$/.exec(source);
  if (!match) return el("span", { class: "place", text: source });
  const [, file, line] = match;
  const label = `${file.split(/[\\/]/).pop()}:${line}`;
  // Where there is no room, its beginning is left out, for which its box runs from right to left.
  const text = el("bdi", { dir: "ltr", text: label });
  if (!actions.onPlace) return el("span", { class: "place", title: source }, text);
  return el(inside ? "span" : "button", {
    type: inside ? null : "button", class: "place way", title: source,
    onclick: (event) => { event.preventDefault(); event.stopPropagation(); actions.onPlace(file, Number(line)); },
  }, text);
}

function showRay(ray, adds, most, byId, actions) {
  const bar = el("span", { class: "bar", "aria-hidden": "true" });
  const fill = el("span", {});
  fill.style.width = `${Math.min(100, (100 * brightness(adds.map(Math.abs))) / most).toFixed(1)}%`;
  fill.style.backgroundColor = css(brighten(adds));
  bar.append(fill);
  const what = ray.hit ? ray.hit.object : word("background");
  const summary = el("summary", { class: `ray ${ray.kind}` },
    el("span", { class: "kind", title: word(ray.kind), text: ray.kind === "primary" ? "E" : ray.kind === "reflection" ? "R" : "T" }),
    swatch(ray.total),
    el("span", { class: "what", text: what }),
    place(ray.hit?.source, actions, true),
    bar,
    el("span", { class: "figures adds", title: `${word("adds")} ${triple(adds, 6)}`, text: `(${adds.map((c) => (c === 0 ? "0" : c.toFixed(3))).join(", ")})` }));
  const details = el("details", { "data-ray": ray.id });
  details.append(summary);
  let filled = false;
  details.addEventListener("toggle", () => {
    if (details.open && !filled) {
      filled = true;
      details.append(rayBody(ray, byId, actions));
    }
  });
  const node = el("li", { role: "treeitem", "data-node": ray.id }, details);
  node.addEventListener("mouseover", (event) => { event.stopPropagation(); actions.onRay?.(ray); });
  return node;
}

// A colour of the same hue that can be seen.
function brighten(color) {
  const most = Math.max(...color.map(Math.abs), 1e-12);
  return color.map((c) => 0.15 + (0.7 * Math.abs(c)) / most);
}

function row(name, ...content) {
  return el("div", { class: "row" }, el("dt", { text: name }), el("dd", {}, ...content));
}

function rayBody(ray, byId, actions) {
  const body = el("div", { class: "ray-body" });
  const geometry = el("dl", {});
  geometry.append(
    row(word(ray.kind), `#${ray.id}, ${word("level")} ${ray.depth}, ${word("weight")} ${number(ray.weight)}`),
    row(word("origin"), triple(ray.ray.origin, 6)),
    row(word("direction"), triple(ray.ray.direction, 6)));
  if (ray.medium) geometry.append(row(word("medium"), ray.medium));
  const hit = ray.hit;
  if (hit?.source) geometry.append(row(word("scene"), place(hit.source, actions)));
  if (!hit) {
    body.append(geometry);
    if (ray.background) body.append(el("p", {}, `${word("noHit")} `, swatch(ray.background), triple(ray.background, 5)));
    appendTotal(body, ray, byId, actions);
    return body;
  }
  geometry.append(
    row("t", number(hit.t, 6)),
    row(word("point"), triple(hit.position, 6)),
    row(word("normalIs"), triple(hit.shading_normal, 5)));
  const degrees = (cos) => `${number((Math.acos(Math.min(1, Math.max(-1, cos))) * 180) / Math.PI, 5)}°`;
  const angles = [["θ₁", degrees(hit.cos_theta1)]];
  if (hit.cos_theta2 !== null) angles.push(["θ₂", degrees(hit.cos_theta2)]);
  if (hit.n1 !== hit.n2) angles.push(["n₁", number(hit.n1)], ["n₂", number(hit.n2)]);
  // A name stays with its number when the line is broken.
  geometry.append(row("θ", angles.map(([name, size]) => `${name}\u00a0=\u00a0${size}`).join(", ")));
  geometry.append(row(word("materialIs"), hit.material.replace(/^material /, "")));
  body.append(geometry);
  if (hit.total_reflection) {
    body.append(el("p", { class: "note", text: totalReflection(hit) }));
  }
  body.append(modelLine(hit));
  const formulas = el("div", { class: "formulas" });
  if (hit.ka) formulas.append(line(word("ambient"), hit.ka_Ia, product([symbol("k", "a"), symbol("I", "a")]), factored([vector(hit.ka), vector(hit.Ia)]), vector(hit.ka_Ia)));
  if (!isBlack(hit.emission)) formulas.append(line(word("emission"), hit.emission, math("mtext", word("emission")), vector(hit.emission)));
  for (const light of ray.lights) formulas.append(showLight(light, hit, actions));
  body.append(formulas);
  for (const end of ray.ended) {
    body.append(el("p", { class: "note", text: `${endText(end)} (${word("weight")} ${number(end.weight)})` }));
  }
  appendTotal(body, ray, byId, actions);
  return body;
}

function modelLine(hit) {
  if (hit.layers) {
    const by = hit.terms_of ? `, ${hit.terms_of}` : "";
    const count = hit.layers.length > 1 ? `, ${hit.layers.length} × ${word("layer")}` : "";
    const box = el("div", { class: "model" }, el("strong", { text: word("finish") + by + count }));
    hit.layers.forEach((layer) => {
      const finish = layer.finish;
      const words = ["diffuse", "brilliance", "phong", "phong_size", "specular", "roughness", "metallic"];
      const shown = words.filter((name) => finish[name] && !(name === "brilliance" && finish[name] === 1)
        && !(name === "phong_size" && !finish.phong) && !(name === "roughness" && !finish.specular));
      box.append(el("div", { class: "finish" }, swatch(layer.pigment.rgb), `rgb ${triple(layer.pigment.rgb, 3)}`,
        ...shown.map((name) => el("span", { text: `${name} ${number(finish[name], 4)}` }))));
    });
    return box;
  }
  const box = el("div", { class: "model" }, el("strong", { text: `${word("model")} ${hit.model}` }));
  if (hit.kd) {
    const terms = [product([symbol("k", "d"), dot("n", "l")])];
    const highlight = hit.model === "phong" ? dot("r", "v") : hit.model === "blinn-phong" ? dot("h", "n") : null;
    if (highlight) terms.push(product([symbol("k", "s"), power(highlight, math("mi", "p"))]));
    box.append(" ", equation(symbol("I"), math("mrow", product([symbol("k", "a"), symbol("I", "a")]), sign("+"), sign("∑"), symbol("L"), sign("("), sum(terms), sign(")"),
      sign("+"), product([symbol("k", "r"), symbol("X", "r")]), sign("+"), product([symbol("k", "t"), symbol("X", "t")]))));
    if (hit.fresnel !== null && hit.fresnel !== undefined) box.append(el("span", { class: "dim", text: ` F = ${number(hit.fresnel)}` }));
  }
  return box;
}

// A line of a formula: its sides, each a node of MathML or a list of nodes, between which a long line may be broken.
function line(name, result, ...sides) {
  const parts = sides.flatMap((side, i) => [side].flat().map((part, j) => equation(i && !j ? math("mrow", infix("="), part) : part)));
  return el("div", { class: "formula" }, swatch(result), el("span", { class: "name", text: name }), ...parts);
}

function obstacles(light) {
  const met = new Map();
  for (const shadow of light.shadow_rays) {
    // A ray meets a solid twice, and counts once.
    const mine = new Map(shadow.met.map((one) => [`${one.object}|${one.source}|${one.blocks}`, one]).reverse());
    for (const [key, one] of mine) {
      const known = met.get(key) ?? { ...one, count: 0 };
      known.count += 1;
      met.set(key, known);
    }
  }
  return [...met.values()];
}

// Why a light brings nothing, or less: a list of nodes; null if it is simply visible.
function reason(light, actions, inside = false) {
  const met = obstacles(light);
  const count = light.shadow_rays.length;
  const parts = met.map((one) => [
    `${word(one.blocks ? "blocked" : "weakened")} ${one.object} `, place(one.source, actions, inside),
    ` ${word("at")} t = ${number(one.t, 4)}`, count > 1 ? ` (${one.count} ${word("of")} ${count} ${word("ofRays")})` : "",
  ]);
  if (parts.length) return parts.flatMap((part, i) => (i ? ["; ", ...part] : part));
  if (light.n_dot_l <= 0 && isBlack(light.diffuse)) return [word("behind")];
  if (isBlack(light.L)) return [word("noLight")];
  return null;
}

function showLight(light, hit, actions) {
  const result = light.diffuse.map((c, i) => c + light.highlight[i]);
  const why = reason(light, actions, true);
  const state = isBlack(result) ? "off" : "on";
  const box = el("details", { class: `light ${state}` },
    el("summary", {}, swatch(result), el("span", { class: "name", text: lightText(light) }), place(light.source, actions, true),
      why ? el("span", { class: "reason" }, ...why) : el("span", { class: "reason good", text: word("visible") })));
  const body = el("div", { class: "light-body" }, place(light.source, actions));
  if (light.l) body.append(el("div", { class: "dim", text: `l = ${triple(light.l, 5)}, n·l = ${number(light.n_dot_l)}` }));
  if (light.mean_of_points) body.append(el("div", { class: "dim", text: word("meanOf").replace("%n", light.mean_of_points) }));
  body.append(line("L", light.L, symbol("L"), factored([vector(light.color_here), vector(light.visible)]), vector(light.L)));
  if (hit.layers) {
    light.terms.forEach((term, i) => {
      const layer = hit.layers[i] ?? hit.layers[0];
      const finish = layer.finish;
      if (!isBlack(term.diffuse)) {
        const cosine = finish.brilliance === 1 ? dot("n", "l") : power(dot("n", "l"), math("mi", "brilliance"));
        body.append(line(word("diffuse"), term.diffuse, product([math("mi", "diffuse"), cosine, symbol("C"), symbol("L")]),
          factored([value(term.diffuse_factor), vector(layer.C), vector(light.L)]), vector(term.diffuse)));
      }
      if (!isBlack(term.highlight)) {
        const parts = [];
        if (term.phong) parts.push(product([math("mi", "phong"), power(dot(...term.phong_cosine_is.split("·")), math("mi", "phong_size"))]));
        if (term.specular) parts.push(product([math("mi", "specular"), power(dot(...term.specular_cosine_is.split("·")), math("mrow", math("mn", "1"), sign("/"), math("mi", "roughness")))]));
        body.append(line(word("highlight"), term.highlight, sum(parts), value((term.phong ?? 0) + (term.specular ?? 0)), vector(term.highlight)));
      }
    });
  } else if (hit.kd) {
    if (light.l) body.append(line(word("diffuse"), light.diffuse, product([symbol("k", "d"), symbol("L"), dot("n", "l")]), factored([vector(hit.kd), vector(light.L), value(light.n_dot_l)]), vector(light.diffuse)));
    const term = light.terms[0];
    const [cosine, raised, a, b] = term && "r_dot_v" in term ? [term.r_dot_v, term.r_dot_v_p, "r", "v"] : term && "h_dot_n" in term ? [term.h_dot_n, term.h_dot_n_p, "h", "n"] : [];
    if (hit.ks && cosine !== undefined) {
      body.append(line(word("highlight"), light.highlight, product([symbol("k", "s"), symbol("L"), power(dot(a, b), math("mi", "p"))]),
        cosine > 0 ? factored([vector(hit.ks), vector(light.L), power(value(cosine), value(hit.p))]) : math("mrow", math("mtext", `${a}·${b} = `), value(cosine), sign("<"), math("mn", "0")), vector(light.highlight)));
    }
  }
  box.append(body);
  return box;
}

function appendTotal(body, ray, byId, actions) {
  // Each term is a part of its own, since there may be hundreds, behind a prism for instance.
  const terms = [math("mi", word("local"))];
  const values = [vector(ray.local)];
  const links = [];
  for (const id of ray.children) {
    const child = byId.get(id);
    if (!child) continue;
    const index = child.kind === "reflection" ? "r" : "t";
    const symbols = [math("mrow", infix("+"), product([symbol("k", index), symbol("X", index)]))];
    const [share, found] = factored([vector(child.share), vector(child.total)]);
    const numbers = [math("mrow", infix("+"), share), found];
    for (const part of [...symbols, ...numbers]) {
      part.setAttribute("class", "link");
      links.push([part, id]);
    }
    terms.push(...symbols);
    values.push(...numbers);
  }
  const plain = isGray(ray.attenuation) && ray.attenuation[0] === 1 && isBlack(ray.fog);
  if (ray.hit || ray.children.length) {
    if (!plain) {
      const around = (parts, factor) => {
        parts[0] = math("mrow", sign("("), parts[0]);
        parts.push(math("mrow", parts.pop(), sign(")")), math("mrow", infix("·"), factor));
      };
      around(terms, math("mi", word("kept")));
      around(values, vector(ray.attenuation));
      if (!isBlack(ray.fog)) {
        terms.push(math("mrow", infix("+"), math("mi", word("fog"))));
        values.push(math("mrow", infix("+"), vector(ray.fog)));
      }
    }
    const shown = line(word("total"), ray.total, terms, values, vector(ray.total, 5));
    shown.classList.add("total");
    body.append(shown);
  }
  for (const [element, id] of links) leads(element, byId.get(id), actions);
}

// Lets an element mark the ray that it is about, and lead to it.
function leads(element, ray, actions) {
  const details = () => element.closest(".tree-box")?.querySelector(`[data-node="${ray.id}"] > details`);
  const mark = (on) => {
    details()?.firstChild.classList.toggle("marked", on);
    actions.onRay?.(on ? ray : null);
  };
  element.addEventListener("mouseenter", () => mark(true));
  element.addEventListener("mouseleave", () => mark(false));
  // The node of the term would mark its own ray.
  element.addEventListener("mouseover", (event) => event.stopPropagation());
  element.addEventListener("click", () => {
    const node = details();
    if (!node) return;
    node.open = true;
    node.scrollIntoView({ block: "nearest", behavior: "smooth" });
  });
}

function endText(end) {
  return `${word(end.kind)}: ${word("ended")}, ${word(end.reason)}`;
}

function lightText(light) {
  return `${lightName(light.light)}${light.kind ? `, ${word(light.kind)}` : ""}`;
}

// The most reasons that are listed, and the least weight of what they take away, as a part of the pixel.
const MOST_REASONS = 8;
const LEAST_WEIGHT = 0.1;

// The reasons why a pixel is darker than its lights would make it: those of its primary ray, then those of the rays that count most.
function whyDark(sample, actions) {
  const [primary] = sample.rays;
  const reasons = [];
  const add = (ray, weight, ...content) => {
    if (ray !== primary && weight < LEAST_WEIGHT) return;
    const where = ray === primary ? null : el("button", { type: "button", class: "place way", text: `${word(ray.kind)} #${ray.id}` });
    if (where) leads(where, ray, actions);
    reasons.push({ first: ray === primary, weight, item: el("li", {}, where, where && " ", ...content) });
  };
  for (const ray of sample.rays) {
    for (const light of ray.hit ? ray.lights : []) {
      // Deeper in the tree, what lies behind a surface is left to the nodes themselves.
      const why = ray === primary || isShadowed(light) ? reason(light, actions) : null;
      if (why) add(ray, ray.weight, swatch(light.diffuse), `${lightName(light.light)}: `, ...why);
    }
    for (const end of ray.ended) if (ray === primary || end.reason !== TOTAL) add(ray, end.weight, endText(end));
    if (ray === primary && ray.hit?.total_reflection) add(ray, 1, totalReflection(ray.hit));
  }
  if (!reasons.length) return null;
  reasons.sort((a, b) => b.first - a.first || b.weight - a.weight);
  const box = el("details", { class: "why" }, el("summary", { text: word("why") }), el("ul", {}, ...reasons.slice(0, MOST_REASONS).map((one) => one.item)));
  // A shadow on a bright floor need not be dark.
  box.open = (primary.hit && primary.lights.some(isShadowed)) || brightness(primary.total) < 0.1;
  return box;
}

// The reason of branches behind a surface that reflects everything, as the server says it.
const TOTAL = "total internal reflection";

function isShadowed(light) {
  return light.shadow_rays.some((shadow) => shadow.met.length);
}

function totalReflection(hit) {
  return `${word("totalReflection")} ${number((hit.n1 / hit.n2) * Math.sqrt(Math.max(0, 1 - hit.cos_theta1 ** 2)))}.`;
}
