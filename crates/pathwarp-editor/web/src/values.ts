// Values of parameters as text, from geometry.

import type { Adjust, Grip, Param, Subpath, XY } from "./types";

type Frame = [number, number, number, number];

/** Values in these notations are dragged on the canvas. */
export const DRAGGED = new Set(["X,Y:X,Y", "I,J:X,Y", "I,J,K:X,Y"]);

/** Figures of numbers in values: far more than a hand can place. */
const FIGURES = 7;

/** A number in few figures. */
export function short(value: number): string {
  return String(Number(value.toPrecision(FIGURES)));
}

function percent(value: number): string {
  return `${Number(value.toFixed(4))}%`;
}

/** A point as `x,y` in % of the frame, so that a recipe fits other drawings. */
function point([x, y]: XY, [left, top, width, height]: Frame): string {
  if (width <= 0 || height <= 0) return `${short(x)},${short(y)}`;
  return `${percent((100 * (x - left)) / width)},${percent((100 * (y - top)) / height)}`;
}

/** A length in % of the frame's width, height or diagonal. */
export function length(value: number, axis: Param["axis"], [, , width, height]: Frame): string {
  const whole = axis === "x" ? width : axis === "y" ? height : Math.hypot(width, height);
  return whole > 0 ? percent((100 * value) / whole) : short(value);
}

/** Path data of subpaths. */
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

/** The values of a parameter whose handles are at these places. */
export function valuesOf(param: Param, grip: Grip, frame: Frame, before: string[]): string[] {
  if (grip.point) return [point(grip.point, frame)];
  if (grip.points) return grip.points.map((p) => point(p, frame));
  if (grip.pairs) return grip.pairs.map(([a, b]) => `${point(a, frame)}:${point(b, frame)}`);
  if (grip.circle) return [arc(grip.circle)];
  if (grip.paths) return grip.paths.map((path) => (isPolygon(path) ? corners(path[0]!, frame) : pathData(path)));
  return param.repeat || before.length > 0 ? before : [];
}

/** A circle or an arc of one as a value, in units of the drawing. */
export function arc([cx, cy, r, from, to]: [number, number, number, number, number]): string {
  return `arc:r=${short(r)},from=${short(from)},to=${short(to)},cx=${short(cx)},cy=${short(cy)}`;
}

/** Open lines through points can be written as points. */
function isPolygon(path: Subpath[]): boolean {
  return path.length === 1 && !path[0]!.closed && path[0]!.segments.every((seg) => seg.length === 2);
}

function corners({ start, segments }: Subpath, frame: Frame): string {
  return [start, ...segments].map((p) => point([p[0]!, p[1]!], frame)).join(" ");
}

/** The largest adjust value that is a share of the box; others are angles. */
const SHARES = 1e6;
/** One per cent of the box, and one degree, as adjust values. */
const PER_CENT = 1e3;
const DEGREE = 6e4;

/** The unit in which an adjust value is shown, and its size. */
export function adjustUnit(a: Adjust): [string, number] {
  return a.most > SHARES ? ["deg", DEGREE] : ["%", PER_CENT];
}

/** The name of an adjust value for people. */
export function adjustName(all: Adjust[], i: number): string {
  return all.length === 1 ? "Shape" : `Shape ${i + 1}`;
}

/** Reads adjust values as typed, `[NAME=]VALUE`; those not given have their defaults. */
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

/** Adjust values as typed, without those that are the defaults. */
export function writeAdjust(all: Adjust[]): string[] {
  return all.filter((a) => a.value !== a.default).map((a) => {
    const [unit, size] = adjustUnit(a);
    // Rounded towards the inside of the range.
    const round = a.value! > (a.least + a.most) / 2 ? Math.floor : Math.ceil;
    return `${a.name}=${short(round((100 * a.value!) / size) / 100)}${unit}`;
  });
}

/** The value of a control point of a net, `I,J:X,Y`. */
export function node(name: string, at: XY, frame: Frame): string {
  return `${name}:${point(at, frame)}`;
}
