// Lines that are drawn on the canvas: by a drag from end to end, by a drag from centre to edge, or by clicks.

import type { App } from "./app";
import { s } from "./dom";
import type { Stage } from "./stage";
import { toast } from "./toast";
import type { XY } from "./types";
import { arc, short } from "./values";

export type Sketch = "line" | "path" | "circle" | "point";

/** What is to be done, in words. */
const HINTS: Record<Sketch, string> = {
  line: "Drag from the start of the line to its end",
  path: "Click the points of the path; a double click or Enter ends it, a click on the first point closes it",
  circle: "Drag from the centre of the circle to its edge",
  point: "Click where the words begin",
};

/** Presses that are nearer are clicks on the same point, in px. */
const NEAR = 8;
/** A circle begins at the bottom and goes over the top, where the middle of words lies then. */
const [FROM, TO] = [90, 450];

export class Sketching {
  private line = s("path", { class: "lit" });
  private stop: (() => void) | null = null;

  constructor(private app: App, private stage: Stage) {
    stage.overlay.append(this.line);
  }

  /** Draws until the line is done; Escape and Undo give it up. */
  begin(kind: Sketch, take: (value: string) => void): void {
    this.end();
    const { app, stage } = this;
    // In units of the drawing, since the view may move meanwhile.
    const points: XY[] = [];
    const stop = new AbortController();
    const listen = { signal: stop.signal, capture: true };
    const giveUp = () => this.end();
    this.stop = () => {
      stop.abort();
      if (app.hold === giveUp) app.hold = null;
    };
    app.hold = giveUp;
    stage.svg.classList.add("picking");
    toast(HINTS[kind]);
    const done = (value: string | null) => {
      this.end();
      if (value) take(value);
    };
    const text = (p: XY) => p.map(short).join(",");
    const isNear = (a: XY, b: XY) => Math.hypot(a[0] - b[0], a[1] - b[1]) < NEAR * stage.camera.pixel;
    const place = (e: PointerEvent) => stage.camera.toUser(stage.point(e));
    const path = (closed: boolean) => (points.length < 2 ? null : `M${points.map(text).join(" L")}${closed ? " Z" : ""}`);
    stage.svg.addEventListener("pointerdown", (e) => {
      if (e.button !== 0) return;
      e.stopPropagation();
      e.preventDefault();
      const at = place(e);
      if (kind === "point") return done(text(at));
      if (kind === "path" && points.length > 2 && isNear(at, points[0]!)) return done(path(true));
      if (points.length === 0 || !isNear(at, points[points.length - 1]!)) points.push(at);
      this.show(kind, points, at);
    }, listen);
    stage.svg.addEventListener("pointermove", (e) => this.show(kind, points, place(e)), listen);
    window.addEventListener("pointerup", (e) => {
      if (kind === "path" || points.length === 0) return;
      const [from, to] = [points[0]!, place(e)];
      // A click alone is no line.
      if (isNear(from, to)) return void (points.length = 0);
      done(kind === "line" ? `M${text(from)} L${text(to)}` : arc([...from, Math.hypot(to[0] - from[0], to[1] - from[1]), FROM, TO]));
    }, listen);
    stage.svg.addEventListener("dblclick", (e) => {
      e.stopPropagation();
      if (kind === "path") done(path(false));
    }, listen);
    window.addEventListener("keydown", (e) => {
      if (e.key !== "Escape" && e.key !== "Enter") return;
      e.stopPropagation();
      // The button that began it still has the focus, and would begin anew.
      e.preventDefault();
      done(e.key === "Enter" && kind === "path" ? path(false) : null);
    }, listen);
  }

  private show(kind: Sketch, points: XY[], to: XY): void {
    if (points.length === 0) return;
    const places = [...points, to].map((p) => this.stage.camera.toScreen(p));
    const [[x, y], [px, py]] = [places[0]!, places.at(-1)!];
    const r = Math.hypot(px - x, py - y);
    const circle = `M${x - r},${y}a${r},${r} 0 1 1 ${2 * r},0a${r},${r} 0 1 1 ${-2 * r},0`;
    this.line.setAttribute("d", kind === "circle" ? circle : `M${places.join("L")}`);
  }

  /** Ends drawing and picking. */
  end(): void {
    this.stop?.();
    this.stop = null;
    this.line.setAttribute("d", "");
    this.stage.pick(null);
  }
}
