// The page of a pixel that needs no server.

import { el } from "./numbers.js";
import { showPixel } from "./tree.js";
import { setLanguage } from "./words.js";

setLanguage(document.documentElement.lang);
const leaf = document.getElementById("leaf");
const pixelData = JSON.parse(document.getElementById("data").textContent);
if (leaf.dataset.title) leaf.append(el("h1", { text: leaf.dataset.title }));
leaf.append(showPixel(pixelData));
