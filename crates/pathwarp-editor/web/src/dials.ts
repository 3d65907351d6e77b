// Handles of numbers, for steps without points: dials for angles, arms for lengths, and tracks for the adjust values of text shapes.

import type { Adjust, Deformation, Frame, Grip, Handle, Line, Param, XY } from "./types";
import { adjustName } from "./values";
import { words } from "./names";

/** The radius of the first dial, as a share of the frame's longer side, and the ratio of the next dial's radius. */
const FIRST_RADIUS = 0.3;
const NEXT_RADIUS = 1.25;

/** A handle, and the line along which it moves. */
export interface Dial {
  handle: Handle;
  line: () => Line;
}

/** The step whose parameters get handles. */
export interface StepGeometry {
  deformation: Deformation;
  grips: Record<string, Grip>;
  frame: Frame;
}

/** Returns the dials of a step whose other handles are not enough to change it. */
export function dials(geometry: StepGeometry): Dial[] {
  const out: Dial[] = [];
  let radius = FIRST_RADIUS * Math.max(geometry.frame[2], geometry.frame[3]);
  for (const param of geometry.deformation.params) {
    const grip = geometry.grips[param.name];
    if (!grip) continue;
    grip.adjust?.forEach((_, i) => out.push(track(param, grip.adjust!, i, geometry.frame)));
    if (grip.value === undefined || param.default === undefined) continue;
    // A skew is not a rotation.
    if (param.kind === "angle" && !param.name.startsWith("skew")) {
      out.push(angleDial(param, grip, geometry, radius));
      radius *= NEXT_RADIUS;
    } else if (param.kind === "length" && !geometry.grips.about?.point) {
      out.push(lengthArm(param, grip, geometry.frame));
    }
  }
  return out;
}

/** Returns a handle of a parameter, with the line to it from a point. */
export function dial(param: Param, key: string, label: string, from: () => XY, get: () => XY, set: (to: XY) => void): Dial {
  return {
    handle: { key, param: param.name, shape: "node", label, group: param.name, get, set: (to) => set(to) },
    line: () => ({ kind: "arm", points: [from(), get()] }),
  };
}

/** A dial for an angle about a centre, clockwise from the right. */
function angleDial(param: Param, grip: Grip, { grips, frame: [x, y, w, h] }: StepGeometry, radius: number): Dial {
  const centre = (): XY => grips.about?.point ?? [x + w / 2, y + h / 2];
  const get = (): XY => {
    const [cx, cy] = centre();
    const a = (grip.value! * Math.PI) / 180;
    return [cx + radius * Math.cos(a), cy + radius * Math.sin(a)];
  };
  const set = (to: XY): void => {
    const [cx, cy] = centre();
    const angle = (Math.atan2(to[1] - cy, to[0] - cx) * 180) / Math.PI;
    // Choose the nearest turn, so that a dial can go around more than once.
    grip.value = clamp(angle + 360 * Math.round((grip.value! - angle) / 360), param.least, param.most);
  };
  return dial(param, param.name, words(param.name), centre, get, set);
}

/** An arm for a length, to the right from the left edge or upwards from the middle. */
function lengthArm(param: Param, grip: Grip, [x, y, w, h]: Frame): Dial {
  const isUp = param.axis === "y";
  const from: XY = isUp ? [x + w / 2, y + h / 2] : [x, y + h];
  const get = (): XY => (isUp ? [from[0], from[1] - grip.value!] : [from[0] + grip.value!, from[1]]);
  const set = (to: XY): void => {
    grip.value = clamp(isUp ? from[1] - to[1] : to[0] - from[0], param.least, param.most);
  };
  return dial(param, param.name, words(param.name), () => from, get, set);
}

/** A track for an adjust value: the first goes up the left edge, the second along the lower edge. */
function track(param: Param, all: Adjust[], i: number, [x, y, w, h]: Frame): Dial {
  const a = all[i]!;
  const share = () => (a.value! - a.least) / (a.most - a.least);
  const isUp = i === 0;
  const get = (): XY => (isUp ? [x, y + h - share() * h] : [x + share() * w, y + h]);
  const set = (to: XY): void => {
    const t = isUp ? (y + h - to[1]) / Math.max(h, 1e-9) : (to[0] - x) / Math.max(w, 1e-9);
    a.value = a.least + clamp(t, 0, 1) * (a.most - a.least);
  };
  return dial(param, `${param.name}/${i}`, adjustName(all, i), () => [x, y + h], get, set);
}

function clamp(value: number, least = -Infinity, most = Infinity): number {
  return Math.min(Math.max(value, least), most);
}
