// Lines drawn on the canvas: by a drag from end to end, by a drag from centre to edge, or by clicks.

import type { App } from "./app";
import { s } from "./dom";
import type { Stage } from "./stage";
import { toast } from "./toast";
import type { XY } from "./types";
import { arc, short } from "./values";

/** The shapes that can be drawn; *round* is a closed line around an object, with corners only at sharp turns. */
export type Sketch = "line" | "path" | "circle" | "round" | "point";

/** Instructions for each shape. */
const HINTS: Record<Sketch, string> = {
  line: "Drag from the start of the line to its end",
  path: "Click the points of the path; a double click or Enter ends it, a click on the first point closes it",
  circle: "Drag from the centre of the circle to its edge",
  point: "Click where the words begin",
  round: "Click points around the outline, many where it is round; a click on the first one or Enter ends it",
};

/** Distance within which clicks count as one point, in px. */
const SAME_POINT = 8;
/** Turn from which a line around an object has a corner, in degrees. */
const CORNER = 50;
/** Angles of a circle's start and end, in degrees clockwise from the right: from the bottom over the top, where words are centred. */
const [CIRCLE_START, CIRCLE_END] = [90, 450];

export class Sketching {
  private line = s("path", { class: "lit" });
  private stop: (() => void) | null = null;

  constructor(private app: App, private stage: Stage) {
    stage.overlay.append(this.line);
  }

  /** Draws, and calls `take` with path data, with `x,y` for a point, or with `arc:…` for a circle; Escape and undo cancel. */
  begin(kind: Sketch, take: (value: string) => void): void {
    this.end();
    const { app, stage } = this;
    // In units of the drawing, since the view may move meanwhile.
    const points: XY[] = [];
    const stop = new AbortController();
    const listen = { signal: stop.signal, capture: true };
    const cancel = () => this.end();
    const hideHint = toast(HINTS[kind], true);
    this.stop = () => {
      stop.abort();
      hideHint();
      if (app.hold === cancel) app.hold = null;
    };
    app.hold = cancel;
    stage.svg.classList.add("picking");
    const done = (value: string | null) => {
      this.end();
      if (value) take(value);
    };
    const text = (p: XY) => p.map(short).join(",");
    const isNear = (a: XY, b: XY) => Math.hypot(a[0] - b[0], a[1] - b[1]) < SAME_POINT * stage.camera.pixel;
    const userPoint = (e: PointerEvent) => stage.camera.toUser(stage.point(e));
    const path = (closed: boolean) => {
      if (kind === "round") return points.length < 3 ? null : smoothRing(points, text);
      return points.length < 2 ? null : `M${points.map(text).join(" L")}${closed ? " Z" : ""}`;
    };
    const isClicked = kind === "path" || kind === "round";
    stage.svg.addEventListener("pointerdown", (e) => {
      if (e.button !== 0) return;
      e.stopPropagation();
      e.preventDefault();
      const at = userPoint(e);
      if (kind === "point") return done(text(at));
      if (isClicked && points.length > 2 && isNear(at, points[0]!)) return done(path(true));
      if (points.length === 0 || !isNear(at, points[points.length - 1]!)) points.push(at);
      this.show(kind, points, at);
    }, listen);
    stage.svg.addEventListener("pointermove", (e) => this.show(kind, points, userPoint(e)), listen);
    window.addEventListener("pointerup", (e) => {
      if (isClicked || points.length === 0) return;
      const [from, to] = [points[0]!, userPoint(e)];
      // A mere click draws nothing.
      if (isNear(from, to)) return void (points.length = 0);
      done(kind === "line" ? `M${text(from)} L${text(to)}` : arc([...from, Math.hypot(to[0] - from[0], to[1] - from[1]), CIRCLE_START, CIRCLE_END]));
    }, listen);
    stage.svg.addEventListener("dblclick", (e) => {
      e.stopPropagation();
      if (isClicked) done(path(false));
    }, listen);
    window.addEventListener("keydown", (e) => {
      if (e.key !== "Escape" && e.key !== "Enter") return;
      e.stopPropagation();
      // The focused button would begin another line.
      e.preventDefault();
      done(e.key === "Enter" && isClicked ? path(false) : null);
    }, listen);
  }

  private show(kind: Sketch, points: XY[], to: XY): void {
    if (points.length === 0) return;
    const onScreen = [...points, to].map((p) => this.stage.camera.toScreen(p));
    const [[x, y], [px, py]] = [onScreen[0]!, onScreen.at(-1)!];
    const r = Math.hypot(px - x, py - y);
    const circle = `M${x - r},${y}a${r},${r} 0 1 1 ${2 * r},0a${r},${r} 0 1 1 ${-2 * r},0`;
    this.line.setAttribute("d", kind === "circle" ? circle : `M${onScreen.join("L")}`);
  }

  /** Ends drawing, or picking a path by a click: only one of them is under way at a time. */
  end(): void {
    this.stop?.();
    this.stop = null;
    this.line.setAttribute("d", "");
    this.stage.pick(null);
  }
}

/** Returns a closed line through points as path data: smooth, with tangents parallel to the line between neighbours, except at corners. */
function smoothRing(points: XY[], text: (p: XY) => string): string {
  const at = (i: number) => points[(i + points.length) % points.length]!;
  const minus = ([ax, ay]: XY, [bx, by]: XY): XY => [ax - bx, ay - by];
  const tangent = (i: number): XY => {
    const [a, b] = [minus(at(i), at(i - 1)), minus(at(i + 1), at(i))];
    const turn = Math.atan2(a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1]);
    const [x, y] = minus(at(i + 1), at(i - 1));
    const length = Math.hypot(x, y) || 1;
    return Math.abs(turn) > (CORNER * Math.PI) / 180 ? [0, 0] : [x / length, y / length];
  };
  const pieces = points.map((p, i) => {
    const [q, s, t] = [at(i + 1), tangent(i), tangent(i + 1)];
    const third = Math.hypot(...minus(q, p)) / 3;
    return `C${text([p[0] + third * s[0], p[1] + third * s[1]])} ${text([q[0] - third * t[0], q[1] - third * t[1]])} ${text(q)}`;
  });
  return `M${text(points[0]!)} ${pieces.join(" ")} Z`;
}
