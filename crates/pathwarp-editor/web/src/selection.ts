// Several selected points, the box around them, and their movement, rotation and scaling together.

import { byId, s } from "./dom";
import type { Handles } from "./handles";
import { reflection, type Modes } from "./modes";
import type { Handle, XY } from "./types";

/** Distances between the points and the box around them, and between the box and the rotation handle, in px. */
const BOX_MARGIN = 16;
const ABOVE = 26;
/** The distance within which the edge of the box counts as hit, in px. */
const EDGE = 6;

/** The parts by which the box is dragged: its corners, or the rotation handle above it. */
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

  /** `true` if more than one point is selected. */
  get isMany(): boolean {
    return this.keys.size > 1;
  }

  /** Selects only these points. */
  take(keys: string[]): void {
    this.keys = new Set(keys);
    byId("spoken").textContent = keys.length > 1 ? `${keys.length} points are selected` : "";
  }

  /** Adds a point to the selection, or removes it. */
  toggle(key: string): void {
    if (!this.keys.delete(key)) this.keys.add(key);
    this.take(Array.from(this.keys));
  }

  /** Returns the selected handles. */
  selectedOf(handles: Handles): Handle[] {
    return handles.handles.filter(({ key }) => this.keys.has(key));
  }

  /** Fits the box around the selected points. */
  place(handles: Handles | null, toScreen: (p: XY) => XY): void {
    const points = handles ? this.selectedOf(handles).map((h) => toScreen(h.get())) : [];
    this.layer.setAttribute("visibility", points.length > 1 ? "visible" : "hidden");
    if (points.length < 2) return;
    const [xs, ys] = [points.map((p) => p[0]), points.map((p) => p[1])];
    const [x0, y0, x1, y1] = [Math.min(...xs) - BOX_MARGIN, Math.min(...ys) - BOX_MARGIN, Math.max(...xs) + BOX_MARGIN, Math.max(...ys) + BOX_MARGIN];
    this.box = [[x0, y0], [x1, y1]];
    const middle = (x0 + x1) / 2;
    this.frame.setAttribute("d", `M${x0},${y0}H${x1}V${y1}H${x0}ZM${middle},${y0}V${y0 - ABOVE}`);
    const positions: Record<Part, XY> = { nw: [x0, y0], ne: [x1, y0], se: [x1, y1], sw: [x0, y1], turn: [middle, y0 - ABOVE] };
    for (const [part, knob] of this.parts) knob.setAttribute("transform", `translate(${positions[part].join(" ")})`);
  }

  /** Returns `true` for a point in the box or on its edge. */
  holds([x, y]: XY): boolean {
    const [[x0, y0], [x1, y1]] = this.box;
    return this.isMany && x > x0 - EDGE && x < x1 + EDGE && y > y0 - EDGE && y < y1 + EDGE;
  }

  /** Returns the map of the points when a part of the box is dragged: a rotation about its centre, or a scaling about a corner. */
  transform(part: Part, from: XY): (to: XY) => (p: XY) => XY {
    const [[x0, y0], [x1, y1]] = this.box;
    const about: XY = part === "turn" ? [(x0 + x1) / 2, (y0 + y1) / 2] : [part.endsWith("w") ? x1 : x0, part.startsWith("n") ? y1 : y0];
    const [ax, ay] = [from[0] - about[0], from[1] - about[1]];
    const square = ax * ax + ay * ay || 1;
    return (to) => {
      const [bx, by] = [to[0] - about[0], to[1] - about[1]];
      const [dot, cross] = [(ax * bx + ay * by) / square, (ax * by - ay * bx) / square];
      const size = Math.hypot(dot, cross) || 1;
      // The map multiplies by re + i·im. Off the circle, only the pointer's angle counts; off the diagonal, only its share along it.
      const [re, im] = part === "turn" ? [dot / size, cross / size] : [dot, 0];
      return ([x, y]) => [about[0] + re * (x - about[0]) - im * (y - about[1]), about[1] + im * (x - about[0]) + re * (y - about[1])];
    };
  }
}

/** Returns a function that maps handles by an image, along with the handles of their nodes and, if symmetry is on, with unselected
 * partners. It returns the names of the changed parameters. */
export function groupMover(handles: Handles, chosen: Handle[], modes: Modes): (image: (p: XY) => XY) => Set<string> {
  const keys = new Set(chosen.map(({ key }) => key));
  const arms = handles.handles.filter(({ key }) => !keys.has(key) && /\/(in|out)$/.test(key) && keys.has(key.replace(/\/(in|out)$/, "")));
  // Nodes come first, since they move their handles.
  const all = [...chosen.filter((h) => h.shape !== "control"), ...chosen.filter((h) => h.shape === "control"), ...arms];
  const starts = all.map((h): XY => [...h.get()]);
  const partners = all.map((h) => (modes.mirrors ? handles.partner(h) : null)).map((p) => (p && !all.includes(p) ? p : null));
  const mirrored = reflection(handles);
  return (image) => {
    const [ends, smooth] = [starts.map(image), false];
    all.forEach((h, i) => h.set(ends[i]!, smooth));
    partners.forEach((p, i) => p?.set(mirrored(ends[i]!), smooth));
    return new Set(all.map(({ param }) => param));
  };
}
