// The ways of moving a handle: snapping, symmetry, smooth nodes.

import { byId, s } from "./dom";
import type { Handles, Pull } from "./handles";
import type { Handle, XY } from "./types";

export class Modes {
  snaps = true;
  /** Dragging the ground selects the points in a frame. */
  selects = false;
  /** A click on the drawing chooses a part of it. */
  picksParts = false;
  mirrors = false;
  smooths = true;
  private marks: XY[] = [];
  /** Shows where the handle has snapped to; the points are in user units. */
  onSnap: (x: number | null, y: number | null) => void = () => {};

  /** The reflection that symmetry is about. */
  reflection(handles: Handles): (p: XY) => XY {
    return reflection(handles);
  }

  /** Where else a point is added that is added at a place: its reflection, if symmetry is on. */
  reflections(handles: Handles, at: XY, reach: number): XY[] {
    const other = reflection(handles)(at);
    return this.mirrors && Math.hypot(other[0] - at[0], other[1] - at[1]) > reach ? [other] : [];
  }

  /** A function that pulls a line, and its reflection if symmetry is on. */
  puller(handles: Handles, { handles: own, targets }: Pull): (to: XY) => void {
    const partners = own.map((handle) => (this.mirrors ? handles.partner(handle) : null));
    const mirrored = reflection(handles);
    return (to) => {
      const wanted = targets(to);
      own.forEach((handle, i) => {
        const partner = partners[i] ?? null;
        const at = wanted[i]!;
        // Of a line that is its own reflection, each end takes half of what both are to do.
        const k = partner ? own.indexOf(partner) : -1;
        const other = k < 0 ? at : mirrored(wanted[k]!);
        const target: XY = [(at[0] + other[0]) / 2, (at[1] + other[1]) / 2];
        handle.set(target, this.smooths);
        if (k < 0) partner?.set(mirrored(target), this.smooths);
      });
    };
  }

  /** A function that moves a handle, and its partner if symmetry is on. */
  mover(handles: Handles, handle: Handle): (to: XY, e: PointerEvent | null) => void {
    const partner = this.mirrors ? handles.partner(handle) : null;
    const mirrored = reflection(handles);
    // Others keep still while one is moved, so what it snaps to is looked up once.
    this.marks = handles.handles.filter((o) => o !== handle && o !== partner && o.shape !== "control").map((o) => [...o.get()]);
    const start: XY = [...handle.get()];
    return (to, e) => {
      // Shift keeps the direction, as drawing programs have it.
      const [dx, dy] = [to[0] - start[0], to[1] - start[1]];
      const target: XY = e?.shiftKey ? (Math.abs(dx) > Math.abs(dy) ? [to[0], start[1]] : [start[0], to[1]]) : to;
      handle.set(target, this.smooths);
      partner?.set(mirrored(target), this.smooths);
    };
  }

  /** The place near `to` that lines up with the frame or another handle; Alt turns that off. */
  snapped(to: XY, handle: Handle, handles: Handles, reach: number, e: PointerEvent): XY {
    if (!this.snaps || e.altKey || handle.shape === "control") {
      this.onSnap(null, null);
      return to;
    }
    const [x, y, w, h] = handles.frame;
    const xs = [x, x + w / 2, x + w, ...this.marks.map((p) => p[0])];
    const ys = [y, y + h / 2, y + h, ...this.marks.map((p) => p[1])];
    const [nx, ny] = [nearest(to[0], xs, reach), nearest(to[1], ys, reach)];
    this.onSnap(nx, ny);
    return [nx ?? to[0], ny ?? to[1]];
  }

  clear(): void {
    this.onSnap(null, null);
  }
}

/** The reflection in the vertical through the middle of the frame. */
function reflection({ frame: [left, , width] }: Handles): (p: XY) => XY {
  return ([x, y]) => [2 * left + width - x, y];
}

function nearest(value: number, among: number[], reach: number): number | null {
  let best: number | null = null;
  for (const candidate of among) {
    const off = Math.abs(candidate - value);
    if (off <= reach && (best === null || off < Math.abs(best - value))) best = candidate;
  }
  return best;
}

/** Draws the lines that a handle snaps to. */
export function snapLines(toScreen: (p: XY) => XY): (x: number | null, y: number | null) => void {
  const layer = byId<SVGSVGElement>("stage");
  const vertical = s("line", { class: "snap", y1: -10000, y2: 10000, visibility: "hidden" });
  const horizontal = s("line", { class: "snap", x1: -10000, x2: 10000, visibility: "hidden" });
  layer.append(vertical, horizontal);
  return (x, y) => {
    vertical.setAttribute("visibility", x === null ? "hidden" : "visible");
    horizontal.setAttribute("visibility", y === null ? "hidden" : "visible");
    const [sx, sy] = toScreen([x ?? 0, y ?? 0]);
    for (const end of ["x1", "x2"]) vertical.setAttribute(end, String(sx));
    for (const end of ["y1", "y2"]) horizontal.setAttribute(end, String(sy));
  };
}
