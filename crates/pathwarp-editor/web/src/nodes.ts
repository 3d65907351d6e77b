// The nodes and control points of the drawing, drawn as one path of dots and arms.

/** Most characters of path data that are read: more dots would only cover the drawing. */
const MOST = 4_000_000;

type Point = [number, number];

/** Returns path data in px of the drawing: `nodes` marks every node by a point, `arms` connects it to its control points. */
export function nodesOf(paths: SVGPathElement[]): { nodes: string; arms: string } {
  const [nodes, arms]: [string[], string[]] = [[], []];
  let length = 0;
  for (const path of paths) {
    const d = path.getAttribute("d") ?? "";
    length += d.length;
    if (length > MOST) break;
    const toDrawing = drawingMap(path);
    const text = (p: Point) => toDrawing(p).map((v) => v.toFixed(2)).join(",");
    for (const { from, to, control } of anchors(d)) {
      nodes.push(`M${text(to)}h0`);
      const [first, last] = [control[0], control[control.length - 1]];
      if (first && last) arms.push(`M${text(from)}L${text(first)}M${text(to)}L${text(last)}`);
    }
  }
  return { nodes: nodes.join(""), arms: arms.join("") };
}

/** Returns the map from a path's coordinates to px of the drawing: the transforms of the groups around it. */
function drawingMap(path: SVGPathElement): (p: Point) => Point {
  let matrix = new DOMMatrix();
  for (let e: Element | null = path; e && !e.classList.contains("art"); e = e.parentElement) {
    const m = (e as SVGGraphicsElement).transform?.baseVal.consolidate()?.matrix;
    if (m) matrix = new DOMMatrix([m.a, m.b, m.c, m.d, m.e, m.f]).multiply(matrix);
  }
  return ([x, y]) => [matrix.a * x + matrix.c * y + matrix.e, matrix.b * x + matrix.d * y + matrix.f];
}

/** The number of coordinates of each command; the last ones are the node's. */
const COMMANDS: Record<string, number> = { M: 2, L: 2, H: 1, V: 1, C: 6, S: 4, Q: 4, T: 2, A: 7, Z: 0 };
const WORD = /[a-zA-Z]|[-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?/g;

/** A node, the preceding one, and the control points between them. */
interface Anchor {
  from: Point;
  to: Point;
  control: Point[];
}

/** Returns the nodes of path data in which the flags of arcs are separated from other numbers. */
export function anchors(d: string): Anchor[] {
  const out: Anchor[] = [];
  // The last control point, which smooth commands reflect.
  let mirrored: Point | null = null;
  const words = d.match(WORD) ?? [];
  let command = "";
  let [at, start]: Point[] = [[0, 0], [0, 0]];
  for (let i = 0; i < words.length; ) {
    if (/[a-zA-Z]/.test(words[i]!)) command = words[i++]!;
    const kind = command.toUpperCase();
    const count = COMMANDS[kind];
    if (count === undefined || i + count > words.length) break;
    const from = at!;
    if (kind === "Z") {
      [at, mirrored] = [start!, null];
      continue;
    }
    const [x0, y0]: Point = command === kind ? [0, 0] : at!;
    const last = Number(words[i + count - 1]);
    if (kind === "H") at = [x0 + last, at![1]];
    else if (kind === "V") at = [at![0], y0 + last];
    else at = [x0 + Number(words[i + count - 2]), y0 + last];
    const control: Point[] = [];
    if (kind !== "A") {
      for (let k = i; k + 3 < i + count; k += 2) control.push([x0 + Number(words[k]), y0 + Number(words[k + 1])]);
    }
    if (kind === "S" || kind === "T") {
      const [mx, my]: Point = mirrored ?? from;
      control.unshift([2 * from[0] - mx, 2 * from[1] - my]);
    }
    mirrored = control[control.length - 1] ?? null;
    i += count;
    out.push({ from, to: at, control });
    if (kind === "M") {
      start = at;
      command = command === "m" ? "l" : "L";
    }
  }
  return out;
}
