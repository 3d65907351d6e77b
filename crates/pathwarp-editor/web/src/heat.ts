// The stretch of the map as a heat map over the drawing: blue where it shrinks, orange where it grows, red where it folds.

import { s } from "./dom";
import type { Stretch, XY } from "./types";

/** Returns the cells of a grid as shapes; `toPx` maps user units to px of the drawing. */
export function cells({ columns, points, factors }: Stretch, toPx: (p: XY) => XY): SVGPathElement[] {
  const byColour = new Map<string, string[]>();
  factors.forEach((factor, k) => {
    const [i, j] = [k % columns, Math.floor(k / columns)];
    const at = (di: number, dj: number) => points[(j + dj) * (columns + 1) + i + di];
    const corners = [at(0, 0), at(1, 0), at(1, 1), at(0, 1)];
    if (factor === null || corners.some((c) => !c)) return;
    const d = corners.map((c) => toPx(c!).map((v) => v.toFixed(2)).join(",")).join("L");
    const colour = shade(factor);
    byColour.set(colour, [...(byColour.get(colour) ?? []), `M${d}Z`]);
  });
  return Array.from(byColour, ([colour, d]) => {
    const [fill, opacity] = colour.split("/");
    return s("path", { d: d.join(""), fill: fill!, "fill-opacity": opacity! });
  });
}

/** The opacity of a full colour, through which the drawing stays visible. */
const FULL_OPACITY = 0.8;
/** Number of steps to a full colour. */
const STEPS = 16;

/** Returns the colour and opacity of a factor, full at half and double, in few steps, so that cells of equal colour become one shape. */
function shade(factor: number): string {
  if (factor < 0) return "#e11d2e/0.85";
  const amount = Math.max(-1, Math.min(1, Math.log2(Math.max(factor, 1e-6))));
  const step = Math.round(amount * STEPS) / STEPS;
  return `${step < 0 ? "#2563eb" : "#ea7706"}/${(FULL_OPACITY * Math.abs(step)).toFixed(3)}`;
}
