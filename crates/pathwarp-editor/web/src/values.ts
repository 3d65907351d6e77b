// Formats geometry as values of parameters.

import type { Adjust, Arc, Frame, Grip, Param, Subpath, XY } from "./types";

/** Notations whose values are dragged on the canvas. */
export const DRAGGED = new Set(["X,Y:X,Y", "I,J:X,Y", "I,J,K:X,Y"]);

/** Significant figures of numbers, far finer than a hand can place points. */
const FIGURES = 7;

/** Formats a number in few figures. */
export function short(value: number): string {
  return String(Number(value.toPrecision(FIGURES)));
}

function percent(value: number): string {
  return `${Number(value.toFixed(4))}%`;
}

/** Formats a point as `x,y` in percent of the frame, so that a recipe fits other drawings. */
function point([x, y]: XY, [left, top, width, height]: Frame): string {
  if (width <= 0 || height <= 0) return `${short(x)},${short(y)}`;
  return `${percent((100 * (x - left)) / width)},${percent((100 * (y - top)) / height)}`;
}

/** Formats a length in percent of the frame's width, height or diagonal. */
export function length(value: number, axis: Param["axis"], [, , width, height]: Frame): string {
  const whole = axis === "x" ? width : axis === "y" ? height : Math.hypot(width, height);
  return whole > 0 ? percent((100 * value) / whole) : short(value);
}

/** Formats subpaths as path data. */
export function pathData(subpaths: Subpath[]): string {
  return subpaths.map(({ start, segments, closed }) => {
    const body = segments.map((seg) => (seg.length === 2 ? "L" : "C") + pairs(seg));
    return `M${pairs(start)} ${body.join(" ")}${closed ? " Z" : ""}`;
  }).join(" ");
}

function pairs(numbers: number[]): string {
  const out: string[] = [];
  for (let i = 0; i + 1 < numbers.length; i += 2) out.push(`${short(numbers[i]!)},${short(numbers[i + 1]!)}`);
  return out.join(" ");
}

/** Returns the values of a parameter for the positions of its handles. */
export function valuesOf(param: Param, grip: Grip, frame: Frame, before: string[]): string[] {
  if (grip.point) return [point(grip.point, frame)];
  if (grip.points) return grip.points.map((p) => point(p, frame));
  if (grip.pairs) return grip.pairs.map(([a, b]) => `${point(a, frame)}:${point(b, frame)}`);
  if (grip.circle) return [arc(grip.circle)];
  if (grip.paths) return grip.paths.map((path) => (isPolygon(path) ? corners(path[0]!, frame) : pathData(path)));
  return param.repeat || before.length > 0 ? before : [];
}

/** Formats a circle or arc as a value, in units of the drawing. */
export function arc([cx, cy, r, from, to]: Arc): string {
  return `arc:r=${short(r)},from=${short(from)},to=${short(to)},cx=${short(cx)},cy=${short(cy)}`;
}

/** Returns `true` for an open polyline, which can be written as points. */
function isPolygon(path: Subpath[]): boolean {
  return path.length === 1 && !path[0]!.closed && path[0]!.segments.every((seg) => seg.length === 2);
}

function corners({ start, segments }: Subpath, frame: Frame): string {
  return [start, ...segments].map((p) => point([p[0]!, p[1]!], frame)).join(" ");
}

/** The largest adjust value of a share of the box; others are angles. */
const LARGEST_SHARE = 1e6;
/** One percent of the box, and one degree, as adjust values. */
const PER_CENT = 1e3;
const DEGREE = 6e4;

/** Returns the unit in which an adjust value is shown, and its size. */
export function adjustUnit(a: Adjust): [string, number] {
  return a.most > LARGEST_SHARE ? ["deg", DEGREE] : ["%", PER_CENT];
}

/** Returns the name of an adjust value for display. */
export function adjustName(all: Adjust[], i: number): string {
  return all.length === 1 ? "Shape" : `Shape ${i + 1}`;
}

/** Parses adjust values, `[NAME=]VALUE`; omitted ones get their defaults. */
export function readAdjust(all: Adjust[], typed: string[]): void {
  for (const a of all) a.value = a.default;
  typed.forEach((text, n) => {
    const [name, value] = text.includes("=") ? (text.split("=") as [string, string]) : [null, text];
    const a = name === null ? all[n] : all.find((a) => a.name === name.trim());
    const number = Number.parseFloat(value);
    const unit = value.trim().replace(/^[-+.\de]+/, "");
    if (a && Number.isFinite(number)) a.value = number * (unit === "%" ? PER_CENT : unit === "" ? 1 : DEGREE);
  });
}

/** Formats adjust values, omitting defaults. */
export function writeAdjust(all: Adjust[]): string[] {
  return all.filter((a) => a.value !== a.default).map((a) => {
    const [unit, size] = adjustUnit(a);
    // Round towards the inside of the range.
    const round = a.value! > (a.least + a.most) / 2 ? Math.floor : Math.ceil;
    return `${a.name}=${short(round((100 * a.value!) / size) / 100)}${unit}`;
  });
}

/** Formats the value of a control point of a net, `I,J:X,Y`. */
export function node(name: string, at: XY, frame: Frame): string {
  return `${name}:${point(at, frame)}`;
}
