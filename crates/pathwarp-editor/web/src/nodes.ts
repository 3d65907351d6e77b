// The nodes and control points of the drawing, as one path of dots and arms.

/** Most characters of path data that are looked at: beyond, dots would only cover the drawing. */
const MOST = 4_000_000;

type Point = [number, number];

/** Path data that marks every node by a point, in px of the drawing. */
export function nodesOf(paths: SVGPathElement[]): string {
  const out: string[] = [];
  let length = 0;
  for (const path of paths) {
    const d = path.getAttribute("d") ?? "";
    length += d.length;
    if (length > MOST) break;
    const at = place(path);
    for (const [x, y] of anchors(d).map(at)) out.push(`M${x.toFixed(2)},${y.toFixed(2)}h0`);
  }
  return out.join("");
}

/** From a path's coordinates to px of the drawing: the transforms of the groups around it. */
function place(path: SVGPathElement): (p: Point) => Point {
  let matrix = new DOMMatrix();
  for (let e: Element | null = path; e && !e.classList.contains("art"); e = e.parentElement) {
    const own = (e as SVGGraphicsElement).transform?.baseVal.consolidate()?.matrix;
    if (own) matrix = new DOMMatrix([own.a, own.b, own.c, own.d, own.e, own.f]).multiply(matrix);
  }
  return ([x, y]) => [matrix.a * x + matrix.c * y + matrix.e, matrix.b * x + matrix.d * y + matrix.f];
}

/** The nodes of path data as usvg writes it: absolute M, L, Q, C and Z, separated by spaces. */
export function anchors(d: string): Point[] {
  const out: Point[] = [];
  const words = d.split(" ");
  const numbers: Record<string, number> = { M: 2, L: 2, Q: 4, C: 6, Z: 0 };
  for (let i = 0; i < words.length; i++) {
    const count = numbers[words[i]!];
    if (!count) continue;
    out.push([Number(words[i + count - 1]), Number(words[i + count])]);
    i += count;
  }
  return out;
}
