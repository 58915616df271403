// A canvas that shows a picture part by part, every pixel with the codes that the server sends.

import { el } from "./numbers.js";

export class Film {
  constructor(id) {
    this.canvas = el("canvas", { class: "film", id, role: "img", width: 1, height: 1 });
    this.context = this.canvas.getContext("2d", { alpha: false, willReadFrequently: true });
    this.number = 0;
    this.finished = false;
    this.shown = 0;
  }

  // The picture that is shown from now on. The old one stays until parts of it come.
  begin(message) {
    this.number = message.picture;
    this.message = message;
    this.finished = false;
    this.shown = 0;
    if (this.canvas.width !== message.width || this.canvas.height !== message.height) {
      const old = el("canvas", { width: this.canvas.width, height: this.canvas.height });
      if (this.canvas.width > 1) old.getContext("2d").drawImage(this.canvas, 0, 0);
      this.canvas.width = message.width;
      this.canvas.height = message.height;
      if (old.width > 1) this.context.drawImage(old, 0, 0, message.width, message.height);
      return true;
    }
    return false;
  }

  part({ x, y, width, height, step }, bytes) {
    const codes = new Uint8Array(bytes);
    const image = this.context.createImageData(width, height);
    const pixels = new Uint32Array(image.data.buffer);
    const columns = Math.ceil(width / step);
    for (let row = 0; row < height; row += 1) {
      const blocks = Math.floor(row / step) * columns;
      for (let column = 0; column < width; column += 1) {
        const at = 3 * (blocks + Math.floor(column / step));
        pixels[row * width + column] = 0xff000000 | (codes[at + 2] << 16) | (codes[at + 1] << 8) | codes[at];
      }
    }
    this.context.putImageData(image, x, y);
    this.shown += 1;
  }
}
