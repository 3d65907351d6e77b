// The handles of an anamorphosis: the eye's height, the picture's width, and the sizes of the surface or mirror, in the drawing's plane.

import { dial, type Dial, type Place } from "./dials";
import { words } from "./names";
import type { Grip, Param, XY } from "./types";
import { short } from "./values";

/** Number of segments that draw a circle. */
const ROUND = 60;

/** Returns the handles for parameters of an anamorphosis that are not points. */
export function inSpace({ deformation, grips, frame: [x, y, w, h] }: Place): Dial[] {
  const out: Dial[] = [];
  const foot: XY = [x + w / 2, y + h];
  const wide = () => grips["picture-width"]?.value ?? w;
  const tall = () => (wide() / w) * h;
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
  return shape.sizes.filter(([name]) => /(radius|diameter)$/.test(name)).map((own) => {
    const k = own[0].endsWith("diameter") ? 2 : 1;
    const up = own[0].startsWith("top") ? -0.5 : own[0].startsWith("bottom") ? 0.5 : 0;
    const centre = (): XY => [middle()[0], middle()[1] + up * tall()];
    const get = (): XY => (isLevel ? [centre()[0], centre()[1] + own[1] / k] : [centre()[0] + own[1] / k, centre()[1]]);
    const set = (to: XY): void => {
      own[1] = k * Math.max(Math.abs(isLevel ? to[1] - centre()[1] : to[0] - centre()[0]), 1e-3 * tall());
      shape.text = shape.text.replace(new RegExp(`(^|[:,])(\\s*${own[0]}\\s*=)[^,]*`), `$1$2${short(own[1])}`);
    };
    const made = dial(param, `${param.name}/${own[0]}`, `${words(param.name)}, ${own[0].replace("-", " ")}`, centre, get, set);
    // A sphere and a mirror's foot are drawn as circles, other surfaces by their extent to both sides.
    const isRound = shape.text.startsWith("sphere") || param.name === "mirror";
    const round = (): XY[] => Array.from({ length: ROUND + 1 }, (_, i) => [centre()[0] + (own[1] / k) * Math.cos((2 * Math.PI * i) / ROUND), centre()[1] + (own[1] / k) * Math.sin((2 * Math.PI * i) / ROUND)]);
    const across = (): XY[] => [[2 * centre()[0] - get()[0], 2 * centre()[1] - get()[1]], get()];
    return { ...made, line: () => ({ kind: "arm", points: isRound ? round() : across() }) };
  });
}
