// Adds and removes nodes of paths without changing the rest. Pieces are the segments of a path.

import type { Subpath, XY } from "./types";

/** Samples of a piece for the search of its nearest point. */
const SAMPLES = 32;
/** The precision of the parameter found. */
const FINE = 1e-9;

/** A point on a path: its piece, parameter and position, and its distance from a given point. */
export interface Spot {
  piece: number;
  t: number;
  at: XY;
  distance: number;
}

/** Returns the points of a piece, from the end of the preceding one: two for a line, four for a cubic. */
function piece(sub: Subpath, k: number): XY[] {
  const before = k === 0 ? sub.start : end(sub.segments[k - 1]!);
  const seg = sub.segments[k]!;
  const out: XY[] = [before];
  for (let i = 0; i + 1 < seg.length; i += 2) out.push([seg[i]!, seg[i + 1]!]);
  return out;
}

export function end(seg: number[]): XY {
  return [seg[seg.length - 2]!, seg[seg.length - 1]!];
}

/** Returns the point that divides the segment from the first point to the second at t. */
function mix([ax, ay]: XY, [bx, by]: XY, t: number): XY {
  return [ax + (bx - ax) * t, ay + (by - ay) * t];
}

/** Returns the rows of de Casteljau's scheme at a parameter, the first with the given points. */
function scheme(points: XY[], t: number): XY[][] {
  const rows = [points];
  for (let row = points; row.length > 1; rows.push(row)) row = row.slice(1).map((p, i) => mix(row[i]!, p, t));
  return rows;
}

/** Appends the line back to the start, if the path is closed and omits it. */
export function withClosingLine(sub: Subpath): Subpath {
  const last = sub.segments[sub.segments.length - 1];
  const isOpen = last && Math.hypot(end(last)[0] - sub.start[0], end(last)[1] - sub.start[1]) > 1e-9;
  if (sub.closed && isOpen) sub.segments.push([...sub.start]);
  return sub;
}

/** Returns the point of a path that is nearest to `to`. */
export function nearest(sub: Subpath, to: XY): Spot | null {
  let best: Spot | null = null;
  const tryParameter = (k: number, points: XY[], t: number) => {
    const [at] = scheme(points, t).pop()! as [XY];
    const distance = Math.hypot(at[0] - to[0], at[1] - to[1]);
    if (!best || distance < best.distance) best = { piece: k, t, at, distance };
  };
  sub.segments.forEach((_, k) => {
    const points = piece(sub, k);
    for (let i = 1; i < SAMPLES; i++) tryParameter(k, points, i / SAMPLES);
  });
  const found = best as Spot | null;
  if (!found) return null;
  // Between the neighbouring samples, the step is halved.
  const points = piece(sub, found.piece);
  for (let step = 0.5 / SAMPLES; step > FINE; step /= 2) {
    const { t } = best as unknown as Spot;
    for (const near of [t - step, t + step]) tryParameter(found.piece, points, Math.min(Math.max(near, FINE), 1 - FINE));
  }
  return best;
}

/** Returns the midpoint of a piece. */
export function middle(sub: Subpath, k: number): XY {
  return scheme(piece(sub, k), 0.5).pop()![0]!;
}

/** Splits a piece in two. */
export function split(sub: Subpath, { piece: k, t }: Spot): void {
  const rows = scheme(piece(sub, k), t);
  const first = rows.slice(1).map((row) => row[0]!);
  const second = rows.slice(0, -1).map((row) => row[row.length - 1]!).reverse();
  sub.segments.splice(k, 1, first.flat(), second.flat());
}

/** Removes a node; the adjacent pieces are joined, and keep their outer control points. A closed path has two or more, none omitted. */
export function drop(sub: Subpath, node: number): void {
  const { segments } = sub;
  if (!sub.closed && node === 0) {
    sub.start = end(segments.shift()!);
    return;
  }
  if (!sub.closed && node === segments.length) {
    segments.pop();
    return;
  }
  // The start of a closed path is the end of its last piece.
  const [a, b] = node === 0 ? [segments.length - 1, 0] : [node - 1, node];
  const [from, to] = [piece(sub, a), piece(sub, b)];
  const [first, last] = [from[0]!, to[to.length - 1]!];
  const isLine = from.length === 2 && to.length === 2;
  const arms = [from.length === 4 ? from[1]! : mix(first, last, 1 / 3), to.length === 4 ? to[2]! : mix(last, first, 1 / 3)];
  segments[a] = isLine ? [...last] : [...arms.flat(), ...last];
  segments.splice(b, 1);
  if (node === 0) sub.start = [...last];
}

/** Raises the degree of a curve without changing it. */
export function raised(points: XY[]): XY[] {
  const n = points.length;
  const inner = points.slice(1).map((p, i) => mix(p, points[i]!, (i + 1) / n));
  return [points[0]!, ...inner, points[n - 1]!];
}
