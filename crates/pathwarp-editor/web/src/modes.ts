// The modes of moving a handle: snapping, symmetry, smooth nodes.

import { byId, s } from "./dom";
import type { Handles, Pull } from "./handles";
import type { Handle, XY } from "./types";

export class Modes {
  snaps = true;
  /** `true` if dragging the background selects the points in a frame. */
  selects = false;
  /** `true` if a click on the drawing selects a part of it. */
  picksParts = false;
  mirrors = false;
  smooths = true;
  /** The points with which a moving handle can be aligned. */
  private snapPoints: XY[] = [];
  /** Shows the lines to which the handle has snapped, in user units. */
  onSnap: (x: number | null, y: number | null) => void = () => {};

  /** Returns the other points to add with a point: its reflection, if symmetry is on and that is more than `reach` (user units) away. */
  reflections(handles: Handles, at: XY, reach: number): XY[] {
    const other = reflection(handles)(at);
    return this.mirrors && Math.hypot(other[0] - at[0], other[1] - at[1]) > reach ? [other] : [];
  }

  /** Returns a function that drags a line, and its reflection if symmetry is on. */
  puller(handles: Handles, { handles: pulled, targets }: Pull): (to: XY) => void {
    const partners = pulled.map((handle) => (this.mirrors ? handles.partner(handle) : null));
    const mirrored = reflection(handles);
    return (to) => {
      const wanted = targets(to);
      pulled.forEach((handle, i) => {
        const partner = partners[i] ?? null;
        const at = wanted[i]!;
        // If the line is its own reflection, each end moves by the mean of its motion and the reflected motion of the other end.
        const partnerIndex = partner ? pulled.indexOf(partner) : -1;
        const other = partnerIndex < 0 ? at : mirrored(wanted[partnerIndex]!);
        const target: XY = [(at[0] + other[0]) / 2, (at[1] + other[1]) / 2];
        handle.set(target, this.smooths);
        if (partnerIndex < 0) partner?.set(mirrored(target), this.smooths);
      });
    };
  }

  /** Returns a function that moves a handle, and its partner if symmetry is on. */
  mover(handles: Handles, handle: Handle): (to: XY, e?: PointerEvent) => void {
    const partner = this.mirrors ? handles.partner(handle) : null;
    const mirrored = reflection(handles);
    // The other handles do not move, so the points to snap to are collected once, before the drag.
    this.snapPoints = handles.handles.filter((o) => o !== handle && o !== partner && o.shape !== "control").map((o) => [...o.get()]);
    const start: XY = [...handle.get()];
    return (to, e) => {
      // Shift restricts the direction, as in drawing programs.
      const [dx, dy] = [to[0] - start[0], to[1] - start[1]];
      const target: XY = e?.shiftKey ? (Math.abs(dx) > Math.abs(dy) ? [to[0], start[1]] : [start[0], to[1]]) : to;
      handle.set(target, this.smooths);
      partner?.set(mirrored(target), this.smooths);
    };
  }

  /** Returns the point within `reach` (user units) of `to` that is aligned with the frame or another handle; Alt disables that. */
  snapped(to: XY, handle: Handle, handles: Handles, reach: number, e: PointerEvent): XY {
    if (!this.snaps || e.altKey || handle.shape === "control") {
      this.onSnap(null, null);
      return to;
    }
    const [x, y, w, h] = handles.frame;
    const xs = [x, x + w / 2, x + w, ...this.snapPoints.map((p) => p[0])];
    const ys = [y, y + h / 2, y + h, ...this.snapPoints.map((p) => p[1])];
    const [nx, ny] = [nearest(to[0], xs, reach), nearest(to[1], ys, reach)];
    this.onSnap(nx, ny);
    return [nx ?? to[0], ny ?? to[1]];
  }

  clear(): void {
    this.onSnap(null, null);
  }
}

/** Returns the reflection about the vertical line through the frame's centre. */
export function reflection({ frame: [left, , width] }: Handles): (p: XY) => XY {
  return ([x, y]) => [2 * left + width - x, y];
}

function nearest(value: number, among: number[], reach: number): number | null {
  let best: number | null = null;
  for (const candidate of among) {
    const distance = Math.abs(candidate - value);
    if (distance <= reach && (best === null || distance < Math.abs(best - value))) best = candidate;
  }
  return best;
}

/** Returns a function that draws the lines to which a handle snaps. */
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
