// Several points at once: which they are, the box around them, and how they are moved, turned and scaled together.

import { byId, s } from "./dom";
import type { Handles } from "./handles";
import type { Modes } from "./modes";
import type { Handle, XY } from "./types";

/** Space between the points and the box around them, and between the box and the handle that turns, in px. */
const AROUND = 16;
const ABOVE = 26;
/** The distance from which the edge of the box is taken, in px. */
const EDGE = 6;

/** What the box is taken by: its corners, or the handle above it. */
export type Part = "nw" | "ne" | "se" | "sw" | "turn";

export class Selection {
  keys = new Set<string>();
  readonly layer = s("g", { class: "selection", visibility: "hidden" });
  private frame = s("path", { class: "line arm" });
  private parts = new Map<Part, SVGGElement>();
  /** Two corners, in px of the screen. */
  private box: [XY, XY] = [[0, 0], [0, 0]];

  constructor() {
    this.layer.append(this.frame);
    for (const part of ["nw", "ne", "se", "sw", "turn"] as const) {
      const body = part === "turn" ? s("circle", { r: 6, class: "body" }) : s("rect", { x: -5, y: -5, width: 10, height: 10, class: "body" });
      const label = part === "turn" ? "Turn the selected points" : "Scale the selected points";
      const knob = s("g", { class: `part ${part}`, "data-part": part }, s("title", {}, label), s("circle", { r: 16, class: "reach" }), body);
      this.parts.set(part, knob);
      this.layer.append(knob);
    }
  }

  /** More than one point is selected. */
  get isMany(): boolean {
    return this.keys.size > 1;
  }

  /** Selects these alone. */
  take(keys: string[]): void {
    this.keys = new Set(keys);
    byId("spoken").textContent = keys.length > 1 ? `${keys.length} points are selected` : "";
  }

  /** Adds a point, or takes it out. */
  toggle(key: string): void {
    if (!this.keys.delete(key)) this.keys.add(key);
    this.take(Array.from(this.keys));
  }

  /** The selected handles. */
  of(handles: Handles): Handle[] {
    return handles.handles.filter(({ key }) => this.keys.has(key));
  }

  /** Puts the box around the selected points. */
  place(handles: Handles | null, toScreen: (p: XY) => XY): void {
    const points = handles ? this.of(handles).map((h) => toScreen(h.get())) : [];
    this.layer.setAttribute("visibility", points.length > 1 ? "visible" : "hidden");
    if (points.length < 2) return;
    const [xs, ys] = [points.map((p) => p[0]), points.map((p) => p[1])];
    const [x0, y0, x1, y1] = [Math.min(...xs) - AROUND, Math.min(...ys) - AROUND, Math.max(...xs) + AROUND, Math.max(...ys) + AROUND];
    this.box = [[x0, y0], [x1, y1]];
    const middle = (x0 + x1) / 2;
    this.frame.setAttribute("d", `M${x0},${y0}H${x1}V${y1}H${x0}ZM${middle},${y0}V${y0 - ABOVE}`);
    const places: Record<Part, XY> = { nw: [x0, y0], ne: [x1, y0], se: [x1, y1], sw: [x0, y1], turn: [middle, y0 - ABOVE] };
    for (const [part, knob] of this.parts) knob.setAttribute("transform", `translate(${places[part].join(" ")})`);
  }

  /** A place is in the box or on its edge. */
  holds([x, y]: XY): boolean {
    const [[x0, y0], [x1, y1]] = this.box;
    return this.isMany && x > x0 - EDGE && x < x1 + EDGE && y > y0 - EDGE && y < y1 + EDGE;
  }

  /** What a pointer does that has taken the box by a part: a turn about its middle, or a scaling about the corner opposite. */
  transform(part: Part, from: XY): (to: XY) => (p: XY) => XY {
    const [[x0, y0], [x1, y1]] = this.box;
    const about: XY = part === "turn" ? [(x0 + x1) / 2, (y0 + y1) / 2] : [part.endsWith("w") ? x1 : x0, part.startsWith("n") ? y1 : y0];
    const [ax, ay] = [from[0] - about[0], from[1] - about[1]];
    const square = ax * ax + ay * ay || 1;
    return (to) => {
      const [bx, by] = [to[0] - about[0], to[1] - about[1]];
      const [dot, cross] = [(ax * bx + ay * by) / square, (ax * by - ay * bx) / square];
      const size = Math.hypot(dot, cross) || 1;
      // The pointer need not stay on the circle, or on the diagonal.
      const [re, im] = part === "turn" ? [dot / size, cross / size] : [dot, 0];
      return ([x, y]) => [about[0] + re * (x - about[0]) - im * (y - about[1]), about[1] + im * (x - about[0]) + re * (y - about[1])];
    };
  }
}

/** A function that takes handles from where they are now to their images, with the handles of their nodes, and with partners that are not
 * among them if symmetry is on. Returns the parameters that are changed. */
export function together(handles: Handles, chosen: Handle[], modes: Modes): (image: (p: XY) => XY) => Set<string> {
  const keys = new Set(chosen.map(({ key }) => key));
  const arms = handles.handles.filter(({ key }) => !keys.has(key) && /\/(in|out)$/.test(key) && keys.has(key.replace(/\/(in|out)$/, "")));
  // Nodes first: they carry their handles along.
  const all = [...chosen.filter((h) => h.shape !== "control"), ...chosen.filter((h) => h.shape === "control"), ...arms];
  const starts = all.map((h): XY => [...h.get()]);
  const partners = all.map((h) => (modes.mirrors ? handles.partner(h) : null)).map((p) => (p && !all.includes(p) ? p : null));
  const mirrored = modes.reflection(handles);
  return (image) => {
    const ends = starts.map(image);
    all.forEach((h, i) => h.set(ends[i]!, false));
    partners.forEach((p, i) => p?.set(mirrored(ends[i]!), false));
    return new Set(all.map(({ param }) => param));
  };
}
