// The camera: maps user units of the drawing to px of the drawing, and these to px of the screen.

import type { XY } from "./types";

type Affine = [number, number, number, number, number, number];

/** The smallest and largest magnification that users can choose, and those for fitting a drawing. */
const ZOOM_RANGE: XY = [0.01, 64];
const FIT_RANGE: XY = [1e-4, 1e5];

export class Camera {
  /** The scale in screen = scale · px + shift. */
  scale = 1;
  shift: XY = [0, 0];
  /** The map from user units to px of the drawing. */
  toPx: Affine = [1, 0, 0, 1, 0, 0];

  /** Converts a point from user units to px of the drawing. */
  inPx([x, y]: XY): XY {
    const [a, b, c, d, e, f] = this.toPx;
    return [a * x + c * y + e, b * x + d * y + f];
  }

  toScreen(p: XY): XY {
    const [x, y] = this.inPx(p);
    return [this.scale * x + this.shift[0], this.scale * y + this.shift[1]];
  }

  toUser([x, y]: XY): XY {
    const [a, b, c, d, e, f] = this.toPx;
    const [px, py] = [(x - this.shift[0]) / this.scale - e, (y - this.shift[1]) / this.scale - f];
    const det = a * d - b * c;
    return [(d * px - c * py) / det, (a * py - b * px) / det];
  }

  /** The length of a px of the screen, in user units. */
  get pixel(): number {
    const [a, b, c, d] = this.toPx;
    return 1 / (this.scale * Math.sqrt(Math.abs(a * d - b * c)));
  }

  /** The transform of the drawing, whose unit is px. */
  get transform(): string {
    return `matrix(${this.scale} 0 0 ${this.scale} ${this.shift[0]} ${this.shift[1]})`;
  }

  /** Magnifies by a factor around a point of the screen. */
  zoom(factor: number, [x, y]: XY): void {
    const scale = Math.min(Math.max(this.scale * factor, Math.min(ZOOM_RANGE[0], this.scale)), Math.max(ZOOM_RANGE[1], this.scale));
    const by = scale / this.scale;
    this.shift = [x - by * (x - this.shift[0]), y - by * (y - this.shift[1])];
    this.scale = scale;
  }

  /** Centres a box of the drawing, two corners in px, in a view of this size. */
  fit([x0, y0, x1, y1]: [number, number, number, number], [width, height]: XY): void {
    const scale = Math.min(width / Math.max(x1 - x0, 1e-9), height / Math.max(y1 - y0, 1e-9));
    this.scale = Math.min(Math.max(scale, FIT_RANGE[0]), FIT_RANGE[1]);
    this.shift = [(width - this.scale * (x0 + x1)) / 2, (height - this.scale * (y0 + y1)) / 2];
  }
}
