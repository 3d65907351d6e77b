// The handles of a step, computed from the geometry of its parameters.

import type { Arc, Deformation, Frame, Grip, Handle, Line, Net, Param, Shape, Step, StepGrips, Subpath, XY } from "./types";
import { length, node, readAdjust, valuesOf, writeAdjust } from "./values";
import { dials, type Dial } from "./dials";
import { called, words } from "./names";
import { inSpace } from "./space";
import { drop, end, middle, nearest, raised, split, type Spot, withClosingLine } from "./knots";

/** A point on a path of a parameter; `id` is the indices of the path and of its subpath, as in keys of handles. */
interface PathHit {
  name: string;
  id: string;
  sub: Subpath;
  spot: Spot;
}

/** A line that is being dragged. */
export interface Pull {
  param: string;
  handles: Handle[];
  /** The keys of the points that it connects. */
  ends: string[];
  /** Returns the positions of the handles when the line is dragged to a point. */
  targets: (to: XY) => XY[];
}

/** The largest bend by dragging, as styles of circular arcs allow no more. */
const FARTHEST_BEND = 1.9;

/** Least parameter from the ends of a curve: nearer to them, control points would have to move far to follow a pointer. */
const END_MARGIN = 0.15;
/** The notation of a point and its image. */
const PAIR = "X,Y:X,Y";
/** Fewest points of a closed path into which artwork is bent. */
const FEWEST_CLOSED = 3;
/** Number of segments that draw a circle. */
const CIRCLE_SEGMENTS = 90;
/** Parameters whose lines the artwork follows; their ends keep the directions of their handles. */
const SKELETONS = new Set(["along"]);

/** The handles of a step, which change as they are moved. */
export class Handles {
  readonly frame: Frame;
  handles: Handle[] = [];
  readonly grips: Record<string, Grip>;
  /** Handles of numbers. */
  private dials: Dial[] = [];
  /** A path of the drawing that a parameter referred to before its line was dragged. */
  freedPath: string | null = null;
  /** Indices of the control points of nets that have been moved, by parameter. */
  private moved: Record<string, Set<number>> = {};

  constructor(readonly deformation: Deformation, private step: Step, grips: StepGrips) {
    this.frame = grips.frame;
    this.grips = structuredClone(grips.params);
    for (const [name, { adjust }] of Object.entries(this.grips)) if (adjust) readAdjust(adjust, step.args[name] ?? []);
    this.collect();
  }

  private collect(): void {
    this.handles = [];
    for (const { name } of this.deformation.params) {
      const grip = this.grips[name];
      if (!grip) continue;
      // An eye with a separate height is at the middle.
      if (grip.point && !(name === "eye" && this.step.args["eye-height"])) this.addPoint(name, grip);
      grip.points?.forEach((_, i) => this.addListPoint(name, grip.points!, i));
      grip.pairs?.forEach((_, i) => this.addPair(name, grip.pairs!, i));
      grip.net?.points.forEach((_, i) => this.addNode(name, grip.net!, i));
      if (name === this.deformation.gallery?.bend && grip.value !== undefined) this.addBend(name, grip);
      if (name === "radius" && grip.value !== undefined && this.grips.center?.point) this.addRadius(name, grip);
      if (grip.circle) this.addCircle(name, grip);
      grip.paths?.forEach((path, i) => path.forEach((sub, j) => this.addSubpath(name, path, this.pointsOf(name) === "any" ? withClosingLine(sub) : sub, `${i}.${j}`)));
    }
    // The fixed point of a rotation or scaling has no effect alone, so dials are added.
    const isAnamorphosis = this.grips.eye || this.grips["eye-height"];
    this.dials = this.handles.every(({ param }) => param === "about") ? dials(this) : isAnamorphosis ? inSpace(this) : [];
    this.handles.push(...this.dials.map(({ handle }) => handle));
  }

  /** The net whose control points are handles. */
  get net(): Net | undefined {
    return Object.values(this.grips).find((grip) => grip.net)?.net;
  }

  /** `true` if points are added as pins, at the artwork's points under the pointer. */
  get addsPins(): boolean {
    return this.grows && this.deformation.params.some(({ name, notation }) => notation === PAIR && this.grips[name]?.pairs);
  }

  /** Returns the handle of the point that is nearest to `at`. */
  nearest(at: XY): Handle | null {
    const distance = (h: Handle) => Math.hypot(h.get()[0] - at[0], h.get()[1] - at[1]);
    return this.handles.filter(({ shape }) => shape === "node").reduce<Handle | null>((best, h) => (best && distance(best) <= distance(h) ? best : h), null);
  }

  /** Returns `true` if points are added to all rows, or removed from all, at once. */
  editsAllRows(param: string): boolean {
    return this.pointsOf(param) === "rows";
  }

  /** Returns `true` if a point added at `at` adds no others. */
  isFree(at: XY, reach: number): boolean {
    const hit = this.pathNear(at, reach, (param) => param.points !== undefined);
    return !hit || this.pointsOf(hit.name) === "any";
  }

  /** Returns values for which the net has another row or column through a point on one of its lines. */
  denser(at: XY, reach: number): Record<string, string[]> | null {
    const { net } = this;
    const sides = net?.lines.flatMap((line) => line.slice(1).map((b, i) => [line[i]!, b] as const)) ?? [];
    const distanceTo = ([a, b]: readonly [number, number]) => distance(at, net!.points[a]!, net!.points[b]!);
    const side = sides.filter((s) => distanceTo(s) <= reach).sort((s, t) => distanceTo(s) - distanceTo(t))[0];
    if (!net || !side) return null;
    const [a, b] = side.map((i) => net.names[i]!.split(",").map(Number)) as [number[], number[]];
    // In a triangle, the three indices of a point add up to the degree.
    if (a.length === 3) return { degree: [String(a.reduce((sum, n) => sum + n) + 1)] };
    const axis = a[0] === b[0] ? 1 : 0;
    const numbers = (name: string, usual: string) => {
      const [x, y] = (this.step.args[name]?.[0] ?? usual).split(/[x×]/i);
      return [Number(x), Number(y ?? x)];
    };
    const cells = numbers("cells", this.step.args.spline ? "4x4" : "1x1");
    // Halving uniform cells keeps them uniform; adding one would not.
    const name = cells[axis]! > 1 ? "cells" : "degree";
    const counts = name === "cells" ? cells : numbers("degree", "3x3");
    counts[axis] = name === "cells" ? 2 * counts[axis]! : counts[axis]! + 1;
    return { [name]: [counts.join("x")] };
  }

  /** Returns the rule for the number of a path's points. */
  private pointsOf(name: string): Param["points"] {
    return this.deformation.params.find((p) => p.name === name)?.points;
  }

  /** The rows of points, all of equal length. */
  private get rows(): [string, Subpath][] {
    const all = this.deformation.params.filter((p) => p.points === "rows");
    return all.flatMap(({ name }) => (this.grips[name]?.paths ?? []).flat().map((sub): [string, Subpath] => [name, sub]));
  }

  private addPoint(param: string, grip: Grip): void {
    this.handles.push({
      key: param, param, shape: "node", label: words(param), group: param,
      get: () => grip.point!, set: (to) => void (grip.point = to),
    });
  }

  /** Adds the handle for the bend of a preset: half a height up or down from the middle is the full bend. */
  private addBend(param: string, grip: Grip): void {
    const [x, y, w, h] = this.frame;
    const middle: XY = [x + w / 2, y + h / 2];
    this.handles.push({
      key: param, param, shape: "node", label: words(param), group: param,
      get: () => [middle[0], middle[1] - (grip.value! * h) / 2],
      set: (to) => void (grip.value = Math.max(-FARTHEST_BEND, Math.min(FARTHEST_BEND, (2 * (middle[1] - to[1])) / Math.max(h, 1e-9)))),
    });
  }

  /** Adds the handle for a radius about a centre, on the circle. */
  private addRadius(param: string, grip: Grip): void {
    const centre = () => this.grips.center!.point!;
    this.handles.push({
      key: param, param, shape: "control", label: words(param), group: param,
      get: () => [centre()[0] + grip.value!, centre()[1]],
      set: (to) => void (grip.value = Math.hypot(to[0] - centre()[0], to[1] - centre()[1])),
    });
  }

  /** Adds the handles for a circle or arc: the centre moves it, a handle halfway between its ends changes the radius, its ends rotate. */
  private addCircle(param: string, grip: Grip): void {
    // The centre's x and y, the radius, and the angles of start and end.
    const c = grip.circle!;
    const name = words(param);
    const at = (degrees: number) => onCircle(c, degrees);
    const handle = (key: string, shape: Shape, label: string, get: () => XY, set: (to: XY) => void) =>
      this.handles.push({ key: `${param}/${key}`, param, shape, label: `${name}, ${label}`, group: param, get, set });
    handle("centre", "node", "centre", () => [c[0], c[1]], (to) => void ([c[0], c[1]] = to));
    handle("radius", "control", "radius", () => at((c[3] + c[4]) / 2), (to) => void (c[2] = Math.max(Math.hypot(to[0] - c[0], to[1] - c[1]), 1e-6)));
    const isWhole = Math.abs(Math.abs(c[4] - c[3]) - 360) < 1e-6;
    /** Returns the shortest rotation, in degrees, from an angle to the direction of a point. */
    const turn = (from: number, to: XY) => (((((Math.atan2(to[1] - c[1], to[0] - c[0]) * 180) / Math.PI - from) % 360) + 540) % 360) - 180;
    handle("start", "node", "start", () => at(c[3]), (to) => {
      const by = turn(c[3], to);
      c[3] += by;
      if (isWhole) c[4] += by;
    });
    if (!isWhole) handle("end", "node", "end", () => at(c[4]), (to) => void (c[4] += turn(c[4], to)));
  }

  private addListPoint(param: string, points: XY[], i: number): void {
    this.handles.push({
      key: `${param}/${i}`, param, shape: "node", label: `${words(param)} ${i + 1}`, group: param,
      get: () => points[i]!, set: (to) => void (points[i] = to),
      remove: () => { points.splice(i, 1); this.collect(); },
    });
  }

  private addPair(param: string, pairs: [XY, XY][], i: number): void {
    const remove = () => { pairs.splice(i, 1); this.collect(); };
    const handle = (end: 0 | 1, shape: Shape, label: string): Handle => ({
      key: `${param}/${i}/${end}`, param, shape, label: `${words(param)} ${i + 1}, ${label}`, group: `${param}/${end}`,
      get: () => pairs[i]![end], set: (to) => void (pairs[i]![end] = to), remove,
    });
    this.handles.push(handle(0, "source", "place in the artwork"), handle(1, "node", "where it goes"));
  }

  private addNode(param: string, net: Net, i: number): void {
    const label = `Control point ${net.names[i]}`;
    this.handles.push({
      key: `${param}/${i}`, param, shape: "node", label, group: param,
      get: () => net.points[i]!,
      set: (to) => {
        net.points[i] = to;
        (this.moved[param] ??= new Set()).add(i);
      },
    });
  }

  /** Adds the nodes and control points of a path. A smooth node moves its control points; at a corner, adjacent pieces keep their shape,
   * and straight ones stay straight. The ends of a closed path are one node. */
  private addSubpath(param: string, path: Subpath[], sub: Subpath, id: string): void {
    const { segments } = sub;
    const last = segments.length - 1;
    const isLoop = last >= 0 && (sub.closed || path.length === 1) && coincide(end(segments[last]!), sub.start);
    const nodes = isLoop ? segments.length : segments.length + 1;
    const before = (n: number) => (n > 0 ? segments[n - 1] : isLoop ? segments[last] : undefined);
    const after = (n: number) => segments[n];
    const at = (n: number): XY => (n === 0 ? sub.start : end(segments[n - 1]!));
    const isCorner = (n: number) => {
      const [a, b] = [before(n), after(n)];
      if (!a || !b) return !SKELETONS.has(param);
      return a.length !== 6 || b.length !== 6 || !isSmooth(at(n), [a[2]!, a[3]!], [b[0]!, b[1]!]);
    };
    const name = param === this.deformation.name ? called(this.deformation) : words(param);
    for (let n = 0; n < nodes; n++) {
      const label = path.length > 1 ? `${name}, line ${path.indexOf(sub) + 1}, point ${n + 1}` : `${name}, point ${n + 1}`;
      const key = `${param}/${id}/${n}`;
      this.handles.push({
        key, param, shape: "node", label, group: `${param}/${id}`, remove: this.remover(param, sub, n, nodes),
        get: () => at(n),
        set: (to) => {
          const from = at(n);
          const incoming = before(n);
          // Each adjacent segment, the index of its control point at this node, and its other node.
          const adjacent: [number[] | undefined, 0 | 2, number][] = [[incoming, 2, n > 0 ? n - 1 : nodes - 1], [after(n), 0, (n + 1) % nodes]];
          const isCornerHere = isCorner(n);
          // The control points at the other nodes move along if those are corners, too.
          const isWhole = adjacent.map(([, , other]) => isCornerHere && isCorner(other));
          adjacent.forEach(([seg, near, other], i) => {
            if (seg?.length !== 6) return;
            const image = similarity(isCornerHere ? at(other) : null, from, to);
            for (const k of isWhole[i] ? [near, 2 - near] : [near]) seg.splice(k, 2, ...image([seg[k]!, seg[k + 1]!]));
          });
          if (n === 0) sub.start = to;
          if (n > 0 || isLoop) incoming!.splice(incoming!.length - 2, 2, ...to);
        },
      });
      const arm = (side: "in" | "out") => {
        const seg = side === "in" ? before(n) : after(n);
        if (seg?.length !== 6) return;
        const k = side === "in" ? 2 : 0;
        this.handles.push({
          key: `${key}/${side}`, param, shape: "control", label: `${label}, handle ${side === "in" ? 1 : 2}`, group: `${param}/${id}`,
          get: () => [seg[k]!, seg[k + 1]!],
          set: (to, smooth) => {
            const other = side === "in" ? after(n) : before(n);
            const m = side === "in" ? 0 : 2;
            // A corner stays a corner.
            const staysSmooth = smooth && other?.length === 6 && isSmooth(at(n), [seg[k]!, seg[k + 1]!], [other[m]!, other[m + 1]!]);
            seg.splice(k, 2, ...to);
            if (staysSmooth) align(other, m, at(n), to);
          },
        });
      };
      arm("in");
      arm("out");
    }
  }

  /** Returns a function that removes a node of a path, if enough remain. */
  private remover(param: string, sub: Subpath, n: number, nodes: number): (() => void) | undefined {
    if (this.editsAllRows(param) && nodes > 2 && n > 0 && n < nodes - 1) {
      return () => {
        for (const [name, row] of this.rows) {
          drop(row, n);
          if (name !== param) this.write(name);
        }
        this.collect();
      };
    }
    if (this.pointsOf(param) !== "any" || nodes <= (sub.closed ? FEWEST_CLOSED : 2)) return undefined;
    return () => {
      drop(sub, n);
      this.collect();
    };
  }

  /** Returns the nearest point within reach on a path of the parameters that `accepts` chooses. */
  private pathNear(at: XY, reach: number, accepts: (param: Param) => boolean): PathHit | null {
    let best: PathHit | null = null;
    for (const param of this.deformation.params.filter(accepts)) {
      this.grips[param.name]?.paths?.forEach((path, i) => path.forEach((sub, j) => {
        const spot = nearest(sub, at);
        if (spot && spot.distance <= Math.min(reach, best?.spot.distance ?? reach)) best = { name: param.name, id: `${i}.${j}`, sub, spot };
      }));
    }
    return best;
  }

  /** Starts to drag the line near a point: a curve bends with the pointer, a straight line moves. */
  pull(at: XY, reach: number): Pull | null {
    const hit = this.pathNear(at, reach, () => true);
    if (!hit) return this.pullRow(at, reach) ?? this.pullCircle(at, reach);
    const { name, id, sub, spot } = hit;
    const handle = (n: number, side = "") => this.handles.find((h) => h.key === `${name}/${id}/${n}${side}`);
    const next = handle(spot.piece + 1) ? spot.piece + 1 : 0;
    const isCurve = sub.segments[spot.piece]!.length === 6;
    const ends = isCurve ? [handle(spot.piece, "/out"), handle(next, "/in")] : [handle(spot.piece), handle(next)];
    const [first, second] = ends;
    if (!first || !second) return null;
    // The point at t follows the pointer, and the control points move in the ratio (1 - t) : t.
    const t = Math.min(Math.max(spot.t, END_MARGIN), 1 - END_MARGIN);
    const weight = isCurve ? 3 * t * (1 - t) * ((1 - t) ** 2 + t ** 2) : 1;
    const shares = isCurve ? [(1 - t) / weight, t / weight] : [1, 1];
    const from = [[...first.get()], [...second.get()]] as [XY, XY];
    return {
      param: name,
      handles: [first, second],
      ends: [handle(spot.piece), handle(next)].flatMap((h) => (h ? [h.key] : [])),
      targets: (to) => from.map(([x, y], i) => [x + shares[i]! * (to[0] - at[0]), y + shares[i]! * (to[1] - at[1])]),
    };
  }

  private pullCircle(at: XY, reach: number): Pull | null {
    const radius = this.handles.find((h) => h.key === "radius");
    const [grip, centre] = [this.grips.radius, this.grips.center?.point];
    if (!radius || !centre || Math.abs(Math.hypot(at[0] - centre[0], at[1] - centre[1]) - (grip?.value ?? 0)) > reach) return null;
    return { param: "radius", handles: [radius], ends: [], targets: (to) => [to] };
  }

  /** A line of a net moves as a whole. */
  private pullRow(at: XY, reach: number): Pull | null {
    const [param, grip] = Object.entries(this.grips).find(([, g]) => g.net) ?? [];
    const net = grip?.net;
    if (!net || !param) return null;
    const distanceTo = (line: number[]) => Math.min(...line.slice(1).map((b, i) => distance(at, net.points[line[i]!]!, net.points[b]!)));
    const row = net.lines.filter((line) => line.length > 1).sort((a, b) => distanceTo(a) - distanceTo(b))[0];
    if (!row || distanceTo(row) > reach) return null;
    const handles = row.map((i) => this.handles.find(({ key }) => key === `${param}/${i}`)!);
    const from = handles.map((h): XY => [...h.get()]);
    return { param, handles, ends: handles.map(({ key }) => key), targets: (to) => from.map(([x, y]) => [x + to[0] - at[0], y + to[1] - at[1]]) };
  }

  /** Adds a point to the path near `at`. */
  private divide(at: XY, reach: number): boolean {
    const hit = this.pathNear(at, reach, (param) => param.points !== undefined);
    if (!hit) return false;
    const { name, sub, spot } = hit;
    if (this.pointsOf(name) === "any") {
      split(sub, spot);
      this.collect();
      this.write(name);
      return true;
    }
    for (const [row, points] of this.rows) {
      const [start, ...rest] = raised([points.start, ...points.segments.map(end)]) as [XY, ...XY[]];
      [points.start, points.segments] = [start, rest.map((p) => [...p])];
      this.write(row);
    }
    this.collect();
    return true;
  }

  /** Returns the lines to draw under the handles. */
  lines(): Line[] {
    const out: Line[] = this.dials.map(({ line }) => line());
    for (const grip of Object.values(this.grips)) {
      for (const pair of grip.pairs ?? []) out.push({ kind: "arm", points: [...pair] });
      if (grip.value !== undefined && grip === this.grips[this.deformation.gallery?.bend ?? ""]) {
        const [x, y, w, h] = this.frame;
        out.push({ kind: "arm", points: [[x + w / 2, y + h / 2], [x + w / 2, y + h / 2 - (grip.value * h) / 2]] });
      }
      if (grip === this.grips.radius && grip.value !== undefined && this.grips.center?.point) {
        out.push(circle(this.grips.center.point, grip.value));
      }
      if (grip.net) {
        const { points } = grip.net;
        for (const line of grip.net.lines) out.push({ kind: "net", points: line.map((i) => points[i]!) });
      }
      if (grip.circle) {
        const [cx, cy, , from, to] = grip.circle;
        const points = Array.from({ length: CIRCLE_SEGMENTS + 1 }, (_, i) => onCircle(grip.circle!, from + ((to - from) * i) / CIRCLE_SEGMENTS));
        out.push({ kind: "path", points }, { kind: "arm", points: [[cx, cy], points[0]!] });
      }
      for (const path of grip.paths ?? []) path.forEach((sub) => this.subpathLines(sub, out));
    }
    return out;
  }

  private subpathLines(sub: Subpath, out: Line[]): void {
    let at = sub.start;
    const pieces: XY[] = [at];
    for (const seg of sub.segments) {
      const to = end(seg);
      if (seg.length === 6) {
        const [first, second]: [XY, XY] = [[seg[0]!, seg[1]!], [seg[2]!, seg[3]!]];
        out.push({ kind: "arm", points: [at, first] }, { kind: "arm", points: [second, to] });
        pieces.push(first, second, to);
      } else {
        pieces.push(at, to, to);
      }
      at = to;
    }
    // Four points without curves form a quadrangle.
    const isQuadrangle = sub.segments.length === 3 && sub.segments.every((seg) => seg.length === 2);
    out.unshift({ kind: "path", points: pieces, cubic: true, closed: sub.closed || isQuadrangle });
  }

  /** Writes the values of a parameter into the step. */
  write(name: string): void {
    const param = this.deformation.params.find((p) => p.name === name);
    const grip = this.grips[name];
    if (!param || !grip) return;
    if (grip.net) this.writeNet(name, grip.net);
    else if (grip.surface) this.step.args[name] = [grip.surface.text];
    else if (grip.adjust) this.step.args[name] = writeAdjust(grip.adjust);
    else if (grip.value !== undefined && param.kind === "angle") this.step.args[name] = [String(Number(grip.value.toFixed(1)))];
    else if (grip.value !== undefined) this.step.args[name] = [param.kind === "length" ? length(grip.value, param.axis, this.frame) : `${Number((100 * grip.value).toFixed(1))}%`];
    else {
      const before = this.step.args[name] ?? [];
      this.step.args[name] = valuesOf(param, grip, this.frame, before);
      this.freedPath ??= before.find((value) => value.startsWith("#")) ?? null;
    }
  }

  /** Writes a value for each moved control point of a net; it replaces earlier values and shifts. */
  private writeNet(name: string, net: Net): void {
    for (const i of this.moved[name] ?? []) {
      const prefix = `${net.names[i]}:`;
      const without = (key: string) => (this.step.args[key] ?? []).flatMap((v) => v.split(/\s+/)).filter((v) => v && !v.startsWith(prefix));
      if (this.step.args.move) this.step.args.move = without("move");
      this.step.args[name] = [...without(name), node(net.names[i]!, net.points[i]!, this.frame)];
    }
  }

  /** Returns the midpoint of the piece that follows a node. */
  after(handle: Handle): XY | null {
    const [param, id = "", n] = handle.key.split("/");
    const [i, j] = id.split(".").map(Number);
    const sub = this.grips[param!]?.paths?.[i!]?.[j!];
    if (!sub || this.pointsOf(handle.param) === undefined) return null;
    return middle(sub, Math.min(Number(n), sub.segments.length - 1));
  }

  /** Adds a point where the step takes any number of them, to paths within `reach`; a pin moves `from` to it. */
  add(at: XY, from: XY, reach: number): boolean {
    if (this.divide(at, reach)) return true;
    if (!this.grows) return false;
    // Prefer a pair, which can be moved at once, to a pin.
    const params = [...this.deformation.params].sort((a, b) => Number(b.notation === PAIR) - Number(a.notation === PAIR));
    for (const { name, repeat, notation } of params) {
      const grip = this.grips[name];
      if (!repeat || !grip) continue;
      if (notation === PAIR && grip.pairs) {
        grip.pairs.push([[...from], [...at]]);
        this.collect();
        this.write(name);
        return true;
      }
      if (notation === "X,Y" && grip.points) {
        grip.points.push(at);
        this.collect();
        this.write(name);
        return true;
      }
    }
    return false;
  }

  /** `true` if points can be added. */
  get grows(): boolean {
    // The handles of a net are its control points.
    if (Object.values(this.grips).some((grip) => grip.net)) return false;
    return this.deformation.params.some(({ name, repeat }) => repeat && (this.grips[name]?.pairs || this.grips[name]?.points));
  }

  /** `true` if there are paths to which points can be added. */
  get divides(): boolean {
    return this.deformation.params.some(({ name, points }) => points && this.grips[name]?.paths);
  }

  /** Returns the handle at the mirror image about the frame's middle, if one is there. */
  partner(handle: Handle): Handle | null {
    const [x, , w, h] = this.frame;
    const [px, py] = handle.get();
    const mirrored: XY = [2 * x + w - px, py];
    const tolerance = 1e-3 * Math.hypot(w, h);
    const others = this.handles.filter((o) => o !== handle && o.shape === handle.shape && o.param === handle.param);
    return others.find((o) => Math.hypot(o.get()[0] - mirrored[0], o.get()[1] - mirrored[1]) < tolerance) ?? null;
  }
}

/** Returns the point of a circle in a direction, clockwise from the right. */
function onCircle([cx, cy, r]: Arc, degrees: number): XY {
  return [cx + r * Math.cos((degrees * Math.PI) / 180), cy + r * Math.sin((degrees * Math.PI) / 180)];
}

/** Returns a circle as four cubics, whose handles have the length 4/3 · tan(π/8) · r. */
function circle([x, y]: XY, r: number): Line {
  const k = 0.5522848 * r;
  const points: XY[] = [
    [x + r, y], [x + r, y + k], [x + k, y + r], [x, y + r], [x - k, y + r], [x - r, y + k], [x - r, y],
    [x - r, y - k], [x - k, y - r], [x, y - r], [x + k, y - r], [x + r, y - k], [x + r, y],
  ];
  return { kind: "path", points, cubic: true, closed: true };
}

/** Returns the distance from a point to a line segment. */
function distance(p: XY, a: XY, b: XY): number {
  const [dx, dy] = [b[0] - a[0], b[1] - a[1]];
  const t = Math.min(Math.max(((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / (dx * dx + dy * dy || 1), 0), 1);
  return Math.hypot(a[0] + t * dx - p[0], a[1] + t * dy - p[1]);
}

/** Returns the similarity that fixes `about` and maps one point to another; without `about`, the translation. */
function similarity(about: XY | null, from: XY, to: XY): (p: XY) => XY {
  if (!about || coincide(about, from)) return ([x, y]) => [x + to[0] - from[0], y + to[1] - from[1]];
  const [ax, ay, bx, by] = [from[0] - about[0], from[1] - about[1], to[0] - about[0], to[1] - about[1]];
  const square = ax * ax + ay * ay;
  // The quotient (b - about) / (a - about) of complex numbers.
  const [re, im] = [(ax * bx + ay * by) / square, (ax * by - ay * bx) / square];
  return ([x, y]) => [about[0] + re * (x - about[0]) - im * (y - about[1]), about[1] + im * (x - about[0]) + re * (y - about[1])];
}

function coincide(a: XY, b: XY): boolean {
  return Math.hypot(a[0] - b[0], a[1] - b[1]) < 1e-9 * (1 + Math.hypot(...a));
}

/** The cosine of the angle from which two handles count as opposite: within about two degrees. */
const OPPOSITE_COSINE = -0.9995;

/** Returns `true` if the control points `a` and `b` are on opposite sides of a node. */
function isSmooth(node: XY, a: XY, b: XY): boolean {
  const [ax, ay, bx, by] = [a[0] - node[0], a[1] - node[1], b[0] - node[0], b[1] - node[1]];
  return ax * bx + ay * by < OPPOSITE_COSINE * Math.hypot(ax, ay) * Math.hypot(bx, by);
}

/** Rotates the control point at `k` of a segment about a node, at constant distance, to lie opposite to `to`. */
function align(segment: number[], k: number, node: XY, to: XY): void {
  const [dx, dy] = [node[0] - to[0], node[1] - to[1]];
  const length = Math.hypot(dx, dy);
  const radius = Math.hypot(segment[k]! - node[0], segment[k + 1]! - node[1]);
  if (length > 0 && radius > 0) segment.splice(k, 2, node[0] + (radius * dx) / length, node[1] + (radius * dy) / length);
}
