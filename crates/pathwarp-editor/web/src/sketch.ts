// Lines that are drawn on the canvas: by a drag from end to end, by a drag from centre to edge, or by clicks.

import { s } from "./dom";
import type { Stage } from "./stage";
import { toast } from "./toast";
import type { XY } from "./types";
import { arc, short } from "./values";

export type Sketch = "line" | "path" | "circle";

/** What is to be done, in words. */
const HINTS: Record<Sketch, string> = {
  line: "Drag from the start of the line to its end",
  path: "Click the points of the path; a double click or Enter ends it, a click on the first point closes it",
  circle: "Drag from the centre of the circle to its edge",
};

/** Presses that are nearer are clicks on the same point, in px. */
const NEAR = 8;
/** A circle begins at the bottom and goes over the top, where the middle of words lies then. */
const [FROM, TO] = [90, 450];

export class Sketching {
  private line = s("path", { class: "lit" });
  private stop: (() => void) | null = null;

  constructor(private stage: Stage) {
    stage.overlay.append(this.line);
  }

  /** Draws until the line is done; Escape gives it up. */
  begin(kind: Sketch, take: (value: string) => void): void {
    this.end();
    const { stage } = this;
    const points: XY[] = [];
    const stop = new AbortController();
    const listen = { signal: stop.signal, capture: true };
    this.stop = () => stop.abort();
    stage.svg.classList.add("picking");
    toast(HINTS[kind]);
    const done = (value: string | null) => {
      this.end();
      if (value) take(value);
    };
    const user = (p: XY) => stage.camera.toUser(p).map(short).join(",");
    const far = (a: XY, b: XY) => Math.hypot(a[0] - b[0], a[1] - b[1]);
    const path = (closed: boolean) => (points.length < 2 ? null : `M${points.map(user).join(" L")}${closed ? " Z" : ""}`);
    stage.svg.addEventListener("pointerdown", (e) => {
      if (e.button !== 0) return;
      e.stopPropagation();
      e.preventDefault();
      const at = stage.point(e);
      if (kind === "path" && points.length > 2 && far(at, points[0]!) < NEAR) return done(path(true));
      if (points.length === 0 || far(at, points[points.length - 1]!) >= NEAR) points.push(at);
    }, listen);
    stage.svg.addEventListener("pointermove", (e) => this.show(kind, points, stage.point(e)), listen);
    window.addEventListener("pointerup", (e) => {
      if (kind === "path" || points.length === 0) return;
      const [from, to] = [points[0]!, stage.point(e)];
      // A click alone is no line.
      if (far(from, to) < NEAR) return void (points.length = 0);
      const [[x, y], [px, py]] = [stage.camera.toUser(from), stage.camera.toUser(to)];
      done(kind === "line" ? `M${user(from)} L${user(to)}` : arc([x, y, Math.hypot(px - x, py - y), FROM, TO]));
    }, listen);
    stage.svg.addEventListener("dblclick", (e) => {
      e.stopPropagation();
      if (kind === "path") done(path(false));
    }, listen);
    window.addEventListener("keydown", (e) => {
      if (e.key !== "Escape" && e.key !== "Enter") return;
      e.stopPropagation();
      done(e.key === "Enter" && kind === "path" ? path(false) : null);
    }, listen);
  }

  private show(kind: Sketch, points: XY[], to: XY): void {
    const [from] = points;
    if (!from) return;
    const [x, y] = from;
    const r = Math.hypot(to[0] - x, to[1] - y);
    const circle = `M${x - r},${y}a${r},${r} 0 1 1 ${2 * r},0a${r},${r} 0 1 1 ${-2 * r},0`;
    this.line.setAttribute("d", kind === "circle" ? circle : `M${[...points, to].join("L")}`);
  }

  /** Ends drawing and picking. */
  end(): void {
    this.stop?.();
    this.stop = null;
    this.line.setAttribute("d", "");
    this.stage.pick(null);
  }
}
