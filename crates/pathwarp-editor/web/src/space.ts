// The handles of an anamorphosis: the eye's height, the picture's width, and the sizes of the surface or mirror, in the drawing's plane.

import { dial, type Dial, type StepGeometry } from "./dials";
import { words } from "./names";
import type { Grip, Param, XY } from "./types";
import { short } from "./values";

/** Number of segments that draw a circle. */
const CIRCLE_SEGMENTS = 60;

/** Returns the handles for parameters of an anamorphosis that are not points. */
export function inSpace({ deformation, grips, frame: [x, y, w, h] }: StepGeometry): Dial[] {
  const out: Dial[] = [];
  const foot: XY = [x + w / 2, y + h];
  // The height of the picture, which keeps its proportions.
  const tall = () => ((grips["picture-width"]?.value ?? w) / w) * h;
  const middle = (): XY => [foot[0], foot[1] - tall() / 2];
  const size = (name: string, get: (value: number) => XY, value: (to: XY) => number, from: () => XY) => {
    const [param, grip] = [deformation.params.find((p) => p.name === name), grips[name]];
    if (param && grip?.value !== undefined) out.push(dial(param, name, words(name), from, () => get(grip.value!), (to) => void (grip.value = Math.max(value(to), 1e-3 * h))));
  };
  size("eye-height", (v) => [foot[0], foot[1] - v], (to) => foot[1] - to[1], () => foot);
  size("picture-width", (v) => [foot[0] + v / 2, foot[1]], (to) => 2 * (to[0] - foot[0]), () => foot);
  for (const param of deformation.params) {
    const grip = grips[param.name];
    if (grip?.surface) out.push(...surface(param, grip.surface, param.name === "mirror" ? () => grips.foot?.point ?? foot : middle, tall));
  }
  return out;
}

/** Returns the handles of a surface whose axis passes behind `middle`: one for each radius, to the right or, for a level surface, below. */
function surface(param: Param, shape: NonNullable<Grip["surface"]>, middle: () => XY, tall: () => number): Dial[] {
  const isLevel = /,\s*level\b/.test(shape.text);
  return shape.sizes.filter(([name]) => /(radius|diameter)$/.test(name)).map((size) => {
    const [name] = size;
    const radii = name.endsWith("diameter") ? 2 : 1;
    const radius = () => size[1] / radii;
    const down = name.startsWith("top") ? -0.5 : name.startsWith("bottom") ? 0.5 : 0;
    const centre = (): XY => [middle()[0], middle()[1] + down * tall()];
    const get = (): XY => (isLevel ? [centre()[0], centre()[1] + radius()] : [centre()[0] + radius(), centre()[1]]);
    const set = (to: XY): void => {
      size[1] = radii * Math.max(Math.abs(isLevel ? to[1] - centre()[1] : to[0] - centre()[0]), 1e-3 * tall());
      shape.text = shape.text.replace(new RegExp(`(^|[:,])(\\s*${name}\\s*=)[^,]*`), `$1$2${short(size[1])}`);
    };
    const made = dial(param, `${param.name}/${name}`, `${words(param.name)}, ${name.replace("-", " ")}`, centre, get, set);
    // A sphere and a mirror's foot are drawn as circles, other surfaces by their extent to both sides.
    const isRound = shape.text.startsWith("sphere") || param.name === "mirror";
    const direction = (i: number) => (2 * Math.PI * i) / CIRCLE_SEGMENTS;
    const round = (): XY[] => Array.from({ length: CIRCLE_SEGMENTS + 1 }, (_, i) => [centre()[0] + radius() * Math.cos(direction(i)), centre()[1] + radius() * Math.sin(direction(i))]);
    const across = (): XY[] => [[2 * centre()[0] - get()[0], 2 * centre()[1] - get()[1]], get()];
    return { ...made, line: () => ({ kind: "arm", points: isRound ? round() : across() }) };
  });
}
