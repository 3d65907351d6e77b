"use strict";
(() => {
  // src/connection.ts
  var RETRY = 700;
  var PATIENCE = 5e3;
  var TOKEN = new URLSearchParams(location.search).get("token") ?? "";
  var Refused = class extends Error {
  };
  var Gone = class extends Error {
  };
  var Connection = class {
    constructor(onOpen, onGone, onEvent) {
      this.onOpen = onOpen;
      this.onGone = onGone;
      this.onEvent = onEvent;
      this.connect();
    }
    onOpen;
    onGone;
    onEvent;
    socket = null;
    waiting = /* @__PURE__ */ new Map();
    next = 1;
    isStopped = false;
    /** The requests whose answers are awaited, as opposed to thumbnails. */
    urgent = /* @__PURE__ */ new Set();
    onBusy = () => {
    };
    /** The length of the last message from the server. */
    size = 0;
    connect() {
      const socket = new WebSocket(`ws://${location.host}/socket?token=${TOKEN}`);
      socket.onopen = () => {
        this.socket = socket;
        history.replaceState(null, "", `/?token=${TOKEN}`);
        this.onOpen();
      };
      socket.onmessage = (message) => {
        this.size = message.data.length;
        this.take(JSON.parse(message.data));
      };
      socket.onclose = () => {
        this.socket = null;
        for (const { reject } of this.waiting.values()) reject(new Gone("pathwarp has ended"));
        this.waiting.clear();
        this.urgent.clear();
        this.onBusy(false);
        history.replaceState(null, "", "/");
        this.onGone();
        this.look();
      };
    }
    /** Waits for the program, and connects. */
    look() {
      setTimeout(async () => {
        if (this.isStopped) return;
        if (await isProgram()) this.connect();
        else this.look();
      }, RETRY);
    }
    /** Stops connecting. */
    stop() {
      this.isStopped = true;
    }
    take(answer) {
      if (answer.id === void 0) return this.onEvent(answer);
      const waiting = this.waiting.get(answer.id);
      this.waiting.delete(answer.id);
      if (this.urgent.delete(answer.id) && this.urgent.size === 0) this.onBusy(false);
      if (answer.error === void 0) waiting?.resolve(answer);
      else waiting?.reject(new Refused(answer.error));
    }
    /** `true` while an answer is awaited. */
    get isBusy() {
      return this.urgent.size > 0;
    }
    /** Sends a request. */
    ask(request) {
      const { socket } = this;
      if (!socket) return Promise.reject(new Gone("pathwarp has ended"));
      const id = this.next++;
      if (request.do !== "thumbnail") {
        this.urgent.add(id);
        this.onBusy(true);
      }
      return new Promise((resolve, reject) => {
        this.waiting.set(id, { resolve, reject });
        socket.send(JSON.stringify({ ...request, id }));
      });
    }
  };
  async function isProgram() {
    const question = crypto.randomUUID();
    try {
      const answer = await fetch(`/proof?${question}`, { signal: AbortSignal.timeout(PATIENCE) });
      const sum = await crypto.subtle.digest("SHA-256", new TextEncoder().encode(TOKEN + question));
      return await answer.text() === Array.from(new Uint8Array(sum), (byte) => byte.toString(16).padStart(2, "0")).join("");
    } catch {
      return false;
    }
  }

  // src/dom.ts
  var SVG = "http://www.w3.org/2000/svg";
  function fill(element, attributes, children) {
    for (const [name, value] of Object.entries(attributes)) {
      if (value !== void 0 && value !== false) element.setAttribute(name, value === true ? "" : String(value));
    }
    for (const child of children) if (child) element.append(child);
    return element;
  }
  function h(tag, attributes = {}, ...children) {
    return fill(document.createElement(tag), attributes, children);
  }
  function s(tag, attributes = {}, ...children) {
    return fill(document.createElementNS(SVG, tag), attributes, children);
  }
  function button(attributes, click, ...children) {
    const element = h("button", { type: "button", ...attributes }, ...children);
    element.addEventListener("click", click);
    return element;
  }
  function onFile(field, take) {
    field.addEventListener("change", () => {
      const file = field.files?.[0];
      field.value = "";
      if (file) take(file);
    });
  }
  function byId(id) {
    const found = document.getElementById(id);
    if (!found) throw new Error(`the page has no #${id}`);
    return found;
  }
  var ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
  function isTyping(target) {
    return target instanceof HTMLElement && target.matches("input:not([type=range], [type=checkbox], [type=radio]), textarea, select");
  }
  var ICONS = {
    close: "M6 6l12 12M18 6 6 18",
    up: "M12 19V6M6 11.5 12 5.5l6 6",
    down: "M12 5v13M6 12.5l6 6 6-6",
    eye: "M2.5 12S6 5.5 12 5.5 21.5 12 21.5 12 18 18.5 12 18.5 2.5 12 2.5 12M12 9.2a2.8 2.8 0 1 1 0 5.6 2.8 2.8 0 0 1 0-5.6",
    copy: "M9 9h10v10H9zM5 15V5h10",
    pen: "M5 19l1-4L16 5l3 3L9 18z",
    lock: "M6 11h12v8.5H6zM8.5 11V8a3.5 3.5 0 0 1 7 0v3"
  };
  function icon(name) {
    return s("svg", { viewBox: "0 0 24 24", class: "icon", "aria-hidden": "true" }, s("path", { d: ICONS[name] }));
  }

  // src/toast.ts
  var SHORTEST = 5e3;
  var CHARACTER = 60;
  var ABOVE = 10;
  var fading = 0;
  var shown = 0;
  function toast(text, stays = false) {
    const box = byId("toast");
    const [view, tools] = [byId("view").getBoundingClientRect(), byId("tools").getBoundingClientRect()];
    if (tools.height > 0) box.style.setProperty("bottom", `${view.bottom - tools.top + ABOVE}px`);
    else box.style.removeProperty("bottom");
    box.textContent = text;
    box.classList.add("on");
    clearTimeout(fading);
    const own = ++shown;
    if (!stays) fading = window.setTimeout(hush, Math.max(SHORTEST, CHARACTER * text.length));
    return () => {
      if (own === shown) hush();
    };
  }
  function hush() {
    byId("toast").classList.remove("on");
  }

  // src/fields.ts
  var MM = 96 / 25.4;
  var LENGTHS = { px: 1, in: 96, mm: MM, cm: 96 / 2.54, m: 96 / 0.0254, pt: 96 / 72, pc: 16, q: 96 / 101.6 };
  var TOKEN2 = /\s*(?:(\d+[.,]?\d*|[.,]\d+)\s*(%|°|[a-z]+)?|([-+*/()]))\s*/iy;
  var EXACT = 12;
  function evaluate(text, unit) {
    const tokens = [];
    const normal = text.replaceAll("−", "-").replaceAll("×", "*");
    for (TOKEN2.lastIndex = 0; TOKEN2.lastIndex < normal.length; ) {
      const found = TOKEN2.exec(normal);
      if (!found) return null;
      tokens.push(found[3] ?? { value: Number(found[1].replace(",", ".")), unit: (found[2] ?? "").toLowerCase().replace(/^deg$/, "°") });
    }
    try {
      const result = sum(tokens);
      return tokens.length === 0 && Number.isFinite(result.value) ? { value: Number(result.value.toPrecision(EXACT)), unit: result.unit || unit } : null;
    } catch {
      return null;
    }
    function sum(rest) {
      let left = product(rest);
      while (rest[0] === "+" || rest[0] === "-") {
        const sign = rest.shift() === "+" ? 1 : -1;
        const right = product(rest);
        const [a, b] = [left.unit || unit, right.unit || unit];
        left = { value: left.value + sign * right.value * factor(b, a), unit: a };
      }
      return left;
    }
    function product(rest) {
      let left = single(rest);
      while (rest[0] === "*" || rest[0] === "/") {
        const isTimes = rest.shift() === "*";
        const right = single(rest);
        if (right.unit && (left.unit || !isTimes)) throw new Error("a product of units");
        left = { value: isTimes ? left.value * right.value : left.value / right.value, unit: left.unit || right.unit };
      }
      return left;
    }
    function single(rest) {
      const next = rest.shift();
      if (next === "-" || next === "+") {
        const { value, unit: unit2 } = single(rest);
        return { value: next === "-" ? -value : value, unit: unit2 };
      }
      if (next === "(") {
        const inner = sum(rest);
        if (rest.shift() !== ")") throw new Error("no closing bracket");
        return inner;
      }
      if (typeof next !== "object") throw new Error("no number");
      return next;
    }
  }
  function inUnits(text, unit) {
    return evaluate(`0${unit}+(${text})`, unit)?.value ?? null;
  }
  function factor(from, to) {
    if (from === to) return 1;
    const [a, b] = [LENGTHS[from], LENGTHS[to]];
    if (a === void 0 || b === void 0) throw new Error("units of different kinds");
    return a / b;
  }
  var BOUNDLESS = 1e6;
  function describeLimits(unit, from = -Infinity, to = Infinity, isWhole = false) {
    const [least, most] = [Number(from.toPrecision(6)), to < BOUNDLESS ? to : Infinity];
    const [what, end2] = [isWhole ? "A whole number" : "A number", unit && ` ${unit}`];
    if (least > -Infinity && most < Infinity) return `${what} from ${least} to ${most}${end2}`;
    if (least > -Infinity) return `${what} from ${least}${end2} up`;
    return `${what}, such as ${isWhole ? 3 : 30}${end2}`;
  }
  function reason(e) {
    return e instanceof Error ? e.message : String(e);
  }
  function inWords(problem, isBeside = false) {
    const text = problem.replace(/^error: /, "").replace(isBeside ? /^“[^”]*”: / : "", "").replace(/`([^`]*)`/g, "“$1”");
    return /^(\S+|[^:;]*\.\w{1,5}): /.test(text) ? text : text.replace(/^./, (c) => c.toUpperCase());
  }
  var Field = class {
    /** `take` accepts a text and returns its problem; `isWrong` checks typed texts; `nudge` moves the value by steps and returns its text. */
    constructor(input, read, take, isWrong = () => null, nudge) {
      this.input = input;
      this.read = read;
      this.take = take;
      this.isWrong = isWrong;
      this.message.id = `${input.id}-wrong`;
      input.addEventListener("change", () => void this.done());
      input.addEventListener("input", () => {
        if (!this.message.hidden) this.say(this.isWrong(input.value));
      });
      input.addEventListener("keydown", ((e) => {
        if (e.key === "Escape") this.reset();
        else if (e.key === "Enter" && (input.tagName === "INPUT" || "single" in input.dataset)) {
          e.preventDefault();
          input.blur();
          input.focus();
        } else if (nudge && (e.key === "ArrowUp" || e.key === "ArrowDown")) {
          const next = nudge(input.value, (e.key === "ArrowUp" ? 1 : -1) * (e.shiftKey ? 10 : 1));
          e.preventDefault();
          if (next !== null) input.value = this.shown = next;
          this.say(null);
        }
      }));
    }
    input;
    read;
    take;
    isWrong;
    message = h("p", { class: "wrong", role: "alert", hidden: true });
    /** The value for which the text is wrong. */
    wrongFor = null;
    shown = "";
    async done() {
      const text = this.input.value;
      const problem = this.isWrong(text) ?? await this.take(text);
      if (problem !== null) this.input.value = text;
      this.say(problem);
      if (problem === null) this.refresh();
    }
    say(problem) {
      this.wrongFor = problem === null ? null : this.read();
      this.message.textContent = problem;
      this.message.hidden = problem === null;
      for (const [name, value] of [["aria-invalid", "true"], ["aria-describedby", this.message.id]]) {
        if (problem === null) this.input.removeAttribute(name);
        else this.input.setAttribute(name, value);
      }
    }
    /** Shows the valid value again. */
    reset() {
      this.say(null);
      this.input.value = this.shown = this.read();
      this.input.select();
    }
    refresh() {
      const value = this.read();
      if (this.wrongFor === value) return;
      if (this.wrongFor !== null) this.say(null);
      if (document.activeElement === this.input && this.input.value !== this.shown && value === this.shown) return;
      this.input.value = this.shown = value;
    }
  };
  function showWrong() {
    const field = document.querySelector("#settings [aria-invalid=true], #place [aria-invalid=true]");
    if (!field) return false;
    field.focus();
    toast(`${field.labels?.[0]?.textContent?.trim()}: ${byId(`${field.id}-wrong`).textContent}`);
    return true;
  }

  // src/values.ts
  var DRAGGED = /* @__PURE__ */ new Set(["X,Y:X,Y", "I,J:X,Y", "I,J,K:X,Y"]);
  var FIGURES = 7;
  function short(value) {
    return String(Number(value.toPrecision(FIGURES)));
  }
  function percent(value) {
    return `${Number(value.toFixed(4))}%`;
  }
  function point([x, y], [left, top, width, height]) {
    if (width <= 0 || height <= 0) return `${short(x)},${short(y)}`;
    return `${percent(100 * (x - left) / width)},${percent(100 * (y - top) / height)}`;
  }
  function length(value, axis, [, , width, height]) {
    const whole = axis === "x" ? width : axis === "y" ? height : Math.hypot(width, height);
    return whole > 0 ? percent(100 * value / whole) : short(value);
  }
  function pathData(subpaths) {
    return subpaths.map(({ start, segments, closed }) => {
      const body = segments.map((seg) => (seg.length === 2 ? "L" : "C") + pairs(seg));
      return `M${pairs(start)} ${body.join(" ")}${closed ? " Z" : ""}`;
    }).join(" ");
  }
  function pairs(numbers) {
    const out = [];
    for (let i = 0; i + 1 < numbers.length; i += 2) out.push(`${short(numbers[i])},${short(numbers[i + 1])}`);
    return out.join(" ");
  }
  function valuesOf(param, grip, frame, before2) {
    if (grip.point) return [point(grip.point, frame)];
    if (grip.points) return grip.points.map((p) => point(p, frame));
    if (grip.pairs) return grip.pairs.map(([a, b]) => `${point(a, frame)}:${point(b, frame)}`);
    if (grip.circle) return [arc(grip.circle)];
    if (grip.paths) return grip.paths.map((path) => isPolygon(path) ? corners(path[0], frame) : pathData(path));
    return param.repeat || before2.length > 0 ? before2 : [];
  }
  function arc([cx, cy, r, from, to]) {
    return `arc:r=${short(r)},from=${short(from)},to=${short(to)},cx=${short(cx)},cy=${short(cy)}`;
  }
  function isPolygon(path) {
    return path.length === 1 && !path[0].closed && path[0].segments.every((seg) => seg.length === 2);
  }
  function corners({ start, segments }, frame) {
    return [start, ...segments].map((p) => point([p[0], p[1]], frame)).join(" ");
  }
  var LARGEST_SHARE = 1e6;
  var PER_CENT = 1e3;
  var DEGREE = 6e4;
  function adjustUnit(a) {
    return a.most > LARGEST_SHARE ? ["deg", DEGREE] : ["%", PER_CENT];
  }
  function adjustName(all, i) {
    return all.length === 1 ? "Shape" : `Shape ${i + 1}`;
  }
  function readAdjust(all, typed) {
    for (const a of all) a.value = a.default;
    typed.forEach((text, n) => {
      const [name, value] = text.includes("=") ? text.split("=") : [null, text];
      const a = name === null ? all[n] : all.find((a2) => a2.name === name.trim());
      const number = Number.parseFloat(value);
      const unit = value.trim().replace(/^[-+.\de]+/, "");
      if (a && Number.isFinite(number)) a.value = number * (unit === "%" ? PER_CENT : unit === "" ? 1 : DEGREE);
    });
  }
  function writeAdjust(all) {
    return all.filter((a) => a.value !== a.default).map((a) => {
      const [unit, size] = adjustUnit(a);
      const round = a.value > (a.least + a.most) / 2 ? Math.floor : Math.ceil;
      return `${a.name}=${short(round(100 * a.value / size) / 100)}${unit}`;
    });
  }
  function node(name, at, frame) {
    return `${name}:${point(at, frame)}`;
  }

  // src/names.ts
  function words(name) {
    const text = name.replaceAll("-", " ").replace(/([a-z])([0-9])/g, "$1 $2");
    return capital(text);
  }
  function capital(text) {
    return text.charAt(0).toUpperCase() + text.slice(1);
  }
  function called({ name, label }) {
    return label ?? words(name);
  }
  function paramName({ name, label }) {
    return label ?? words(name);
  }
  function isCaption({ deformation }) {
    return deformation === "caption";
  }
  var LONGEST = 30;
  function stepName(step2, deformation) {
    if (step2.name) return step2.name;
    if (!deformation) return words(step2.deformation);
    if (isCaption(step2)) return `“${(step2.args.words ?? []).join(" ").slice(0, LONGEST)}”`;
    const preset = deformation.gallery ? step2.args[deformation.gallery.presets]?.[0] : void 0;
    const variant = deformation.variants.find(({ param }) => step2.args[param]);
    const isKnown = deformation.params.some((p) => p.name === deformation.gallery?.presets && p.words?.includes(preset ?? ""));
    return preset ? isKnown ? words(preset) : preset.split(/[\\/]/).pop() : variant?.label ?? called(deformation);
  }

  // src/dials.ts
  var FIRST_RADIUS = 0.3;
  var NEXT_RADIUS = 1.25;
  function dials(geometry) {
    const out = [];
    let radius = FIRST_RADIUS * Math.max(geometry.frame[2], geometry.frame[3]);
    for (const param of geometry.deformation.params) {
      const grip = geometry.grips[param.name];
      if (!grip) continue;
      grip.adjust?.forEach((_, i) => out.push(track(param, grip.adjust, i, geometry.frame)));
      if (grip.value === void 0 || param.default === void 0) continue;
      if (param.kind === "angle" && !param.name.startsWith("skew")) {
        out.push(angleDial(param, grip, geometry, radius));
        radius *= NEXT_RADIUS;
      } else if (param.kind === "length" && !geometry.grips.about?.point) {
        out.push(lengthArm(param, grip, geometry.frame));
      }
    }
    return out;
  }
  function dial(param, key, label, from, get, set2) {
    return {
      handle: { key, param: param.name, shape: "node", label, group: param.name, get, set: (to) => set2(to) },
      line: () => ({ kind: "arm", points: [from(), get()] })
    };
  }
  function angleDial(param, grip, { grips, frame: [x, y, w, h2] }, radius) {
    const centre = () => grips.about?.point ?? [x + w / 2, y + h2 / 2];
    const get = () => {
      const [cx, cy] = centre();
      const a = grip.value * Math.PI / 180;
      return [cx + radius * Math.cos(a), cy + radius * Math.sin(a)];
    };
    const set2 = (to) => {
      const [cx, cy] = centre();
      const angle = Math.atan2(to[1] - cy, to[0] - cx) * 180 / Math.PI;
      grip.value = clamp(angle + 360 * Math.round((grip.value - angle) / 360), param.least, param.most);
    };
    return dial(param, param.name, words(param.name), centre, get, set2);
  }
  function lengthArm(param, grip, [x, y, w, h2]) {
    const isUp = param.axis === "y";
    const from = isUp ? [x + w / 2, y + h2 / 2] : [x, y + h2];
    const get = () => isUp ? [from[0], from[1] - grip.value] : [from[0] + grip.value, from[1]];
    const set2 = (to) => {
      grip.value = clamp(isUp ? from[1] - to[1] : to[0] - from[0], param.least, param.most);
    };
    return dial(param, param.name, words(param.name), () => from, get, set2);
  }
  function track(param, all, i, [x, y, w, h2]) {
    const a = all[i];
    const share = () => (a.value - a.least) / (a.most - a.least);
    const isUp = i === 0;
    const get = () => isUp ? [x, y + h2 - share() * h2] : [x + share() * w, y + h2];
    const set2 = (to) => {
      const t = isUp ? (y + h2 - to[1]) / Math.max(h2, 1e-9) : (to[0] - x) / Math.max(w, 1e-9);
      a.value = a.least + clamp(t, 0, 1) * (a.most - a.least);
    };
    return dial(param, `${param.name}/${i}`, adjustName(all, i), () => [x, y + h2], get, set2);
  }
  function clamp(value, least = -Infinity, most = Infinity) {
    return Math.min(Math.max(value, least), most);
  }

  // src/space.ts
  var CIRCLE_SEGMENTS = 60;
  function inSpace({ deformation, grips, frame: [x, y, w, h2] }) {
    const out = [];
    const foot = [x + w / 2, y + h2];
    const tall = () => (grips["picture-width"]?.value ?? w) / w * h2;
    const middle2 = () => [foot[0], foot[1] - tall() / 2];
    const size = (name, get, value, from) => {
      const [param, grip] = [deformation.params.find((p) => p.name === name), grips[name]];
      if (param && grip?.value !== void 0) out.push(dial(param, name, words(name), from, () => get(grip.value), (to) => void (grip.value = Math.max(value(to), 1e-3 * h2))));
    };
    size("eye-height", (v) => [foot[0], foot[1] - v], (to) => foot[1] - to[1], () => foot);
    size("picture-width", (v) => [foot[0] + v / 2, foot[1]], (to) => 2 * (to[0] - foot[0]), () => foot);
    for (const param of deformation.params) {
      const grip = grips[param.name];
      if (grip?.surface) out.push(...surface(param, grip.surface, param.name === "mirror" ? () => grips.foot?.point ?? foot : middle2, tall));
    }
    return out;
  }
  function surface(param, shape, middle2, tall) {
    const isLevel = /,\s*level\b/.test(shape.text);
    return shape.sizes.filter(([name]) => /(radius|diameter)$/.test(name)).map((size) => {
      const [name] = size;
      const radii = name.endsWith("diameter") ? 2 : 1;
      const radius = () => size[1] / radii;
      const down = name.startsWith("top") ? -0.5 : name.startsWith("bottom") ? 0.5 : 0;
      const centre = () => [middle2()[0], middle2()[1] + down * tall()];
      const get = () => isLevel ? [centre()[0], centre()[1] + radius()] : [centre()[0] + radius(), centre()[1]];
      const set2 = (to) => {
        size[1] = radii * Math.max(Math.abs(isLevel ? to[1] - centre()[1] : to[0] - centre()[0]), 1e-3 * tall());
        shape.text = shape.text.replace(new RegExp(`(^|[:,])(\\s*${name}\\s*=)[^,]*`), `$1$2${short(size[1])}`);
      };
      const made = dial(param, `${param.name}/${name}`, `${words(param.name)}, ${name.replace("-", " ")}`, centre, get, set2);
      const isRound = shape.text.startsWith("sphere") || param.name === "mirror";
      const direction = (i) => 2 * Math.PI * i / CIRCLE_SEGMENTS;
      const round = () => Array.from({ length: CIRCLE_SEGMENTS + 1 }, (_, i) => [centre()[0] + radius() * Math.cos(direction(i)), centre()[1] + radius() * Math.sin(direction(i))]);
      const across = () => [[2 * centre()[0] - get()[0], 2 * centre()[1] - get()[1]], get()];
      return { ...made, line: () => ({ kind: "arm", points: isRound ? round() : across() }) };
    });
  }

  // src/knots.ts
  var SAMPLES = 32;
  var FINE = 1e-9;
  function piece(sub, k) {
    const before2 = k === 0 ? sub.start : end(sub.segments[k - 1]);
    const seg = sub.segments[k];
    const out = [before2];
    for (let i = 0; i + 1 < seg.length; i += 2) out.push([seg[i], seg[i + 1]]);
    return out;
  }
  function end(seg) {
    return [seg[seg.length - 2], seg[seg.length - 1]];
  }
  function mix([ax, ay], [bx, by], t) {
    return [ax + (bx - ax) * t, ay + (by - ay) * t];
  }
  function scheme(points, t) {
    const rows = [points];
    for (let row = points; row.length > 1; rows.push(row)) row = row.slice(1).map((p, i) => mix(row[i], p, t));
    return rows;
  }
  function withClosingLine(sub) {
    const last = sub.segments[sub.segments.length - 1];
    const isOpen = last && Math.hypot(end(last)[0] - sub.start[0], end(last)[1] - sub.start[1]) > 1e-9;
    if (sub.closed && isOpen) sub.segments.push([...sub.start]);
    return sub;
  }
  function nearest(sub, to) {
    let best = null;
    const tryParameter = (k, points2, t) => {
      const [at] = scheme(points2, t).pop();
      const distance2 = Math.hypot(at[0] - to[0], at[1] - to[1]);
      if (!best || distance2 < best.distance) best = { piece: k, t, at, distance: distance2 };
    };
    sub.segments.forEach((_, k) => {
      const points2 = piece(sub, k);
      for (let i = 1; i < SAMPLES; i++) tryParameter(k, points2, i / SAMPLES);
    });
    const found = best;
    if (!found) return null;
    const points = piece(sub, found.piece);
    for (let step2 = 0.5 / SAMPLES; step2 > FINE; step2 /= 2) {
      const { t } = best;
      for (const near of [t - step2, t + step2]) tryParameter(found.piece, points, Math.min(Math.max(near, FINE), 1 - FINE));
    }
    return best;
  }
  function middle(sub, k) {
    return scheme(piece(sub, k), 0.5).pop()[0];
  }
  function split(sub, { piece: k, t }) {
    const rows = scheme(piece(sub, k), t);
    const first = rows.slice(1).map((row) => row[0]);
    const second = rows.slice(0, -1).map((row) => row[row.length - 1]).reverse();
    sub.segments.splice(k, 1, first.flat(), second.flat());
  }
  function drop(sub, node2) {
    const { segments } = sub;
    if (!sub.closed && node2 === 0) {
      sub.start = end(segments.shift());
      return;
    }
    if (!sub.closed && node2 === segments.length) {
      segments.pop();
      return;
    }
    const [a, b] = node2 === 0 ? [segments.length - 1, 0] : [node2 - 1, node2];
    const [from, to] = [piece(sub, a), piece(sub, b)];
    const [first, last] = [from[0], to[to.length - 1]];
    const isLine = from.length === 2 && to.length === 2;
    const arms = [from.length === 4 ? from[1] : mix(first, last, 1 / 3), to.length === 4 ? to[2] : mix(last, first, 1 / 3)];
    segments[a] = isLine ? [...last] : [...arms.flat(), ...last];
    segments.splice(b, 1);
    if (node2 === 0) sub.start = [...last];
  }
  function raised(points) {
    const n = points.length;
    const inner = points.slice(1).map((p, i) => mix(p, points[i], (i + 1) / n));
    return [points[0], ...inner, points[n - 1]];
  }

  // src/handles.ts
  var FARTHEST_BEND = 1.9;
  var END_MARGIN = 0.15;
  var PAIR = "X,Y:X,Y";
  var FEWEST_CLOSED = 3;
  var CIRCLE_SEGMENTS2 = 90;
  var SKELETONS = /* @__PURE__ */ new Set(["along"]);
  var Handles = class {
    constructor(deformation, step2, grips) {
      this.deformation = deformation;
      this.step = step2;
      this.frame = grips.frame;
      this.grips = structuredClone(grips.params);
      for (const [name, { adjust }] of Object.entries(this.grips)) if (adjust) readAdjust(adjust, step2.args[name] ?? []);
      this.collect();
    }
    deformation;
    step;
    frame;
    handles = [];
    grips;
    /** Handles of numbers. */
    dials = [];
    /** A path of the drawing that a parameter referred to before its line was dragged. */
    freedPath = null;
    /** Indices of the control points of nets that have been moved, by parameter. */
    moved = {};
    collect() {
      this.handles = [];
      for (const { name } of this.deformation.params) {
        const grip = this.grips[name];
        if (!grip) continue;
        if (grip.point && !(name === "eye" && this.step.args["eye-height"])) this.addPoint(name, grip);
        grip.points?.forEach((_, i) => this.addListPoint(name, grip.points, i));
        grip.pairs?.forEach((_, i) => this.addPair(name, grip.pairs, i));
        grip.net?.points.forEach((_, i) => this.addNode(name, grip.net, i));
        if (name === this.deformation.gallery?.bend && grip.value !== void 0) this.addBend(name, grip);
        if (name === "radius" && grip.value !== void 0 && this.grips.center?.point) this.addRadius(name, grip);
        if (grip.circle) this.addCircle(name, grip);
        grip.paths?.forEach((path, i) => path.forEach((sub, j) => this.addSubpath(name, path, this.pointsOf(name) === "any" ? withClosingLine(sub) : sub, `${i}.${j}`)));
      }
      const isAnamorphosis = this.grips.eye || this.grips["eye-height"];
      this.dials = this.handles.every(({ param }) => param === "about") ? dials(this) : isAnamorphosis ? inSpace(this) : [];
      this.handles.push(...this.dials.map(({ handle }) => handle));
    }
    /** The net whose control points are handles. */
    get net() {
      return Object.values(this.grips).find((grip) => grip.net)?.net;
    }
    /** `true` if points are added as pins, at the artwork's points under the pointer. */
    get addsPins() {
      return this.grows && this.deformation.params.some(({ name, notation }) => notation === PAIR && this.grips[name]?.pairs);
    }
    /** Returns the handle of the point that is nearest to `at`. */
    nearest(at) {
      const distance2 = (h2) => Math.hypot(h2.get()[0] - at[0], h2.get()[1] - at[1]);
      return this.handles.filter(({ shape }) => shape === "node").reduce((best, h2) => best && distance2(best) <= distance2(h2) ? best : h2, null);
    }
    /** Returns `true` if points are added to all rows, or removed from all, at once. */
    editsAllRows(param) {
      return this.pointsOf(param) === "rows";
    }
    /** Returns `true` if a point added at `at` adds no others. */
    isFree(at, reach) {
      const hit = this.pathNear(at, reach, (param) => param.points !== void 0);
      return !hit || this.pointsOf(hit.name) === "any";
    }
    /** Returns values for which the net has another row or column through a point on one of its lines. */
    denser(at, reach) {
      const { net } = this;
      const sides = net?.lines.flatMap((line) => line.slice(1).map((b2, i) => [line[i], b2])) ?? [];
      const distanceTo = ([a2, b2]) => distance(at, net.points[a2], net.points[b2]);
      const side = sides.filter((s2) => distanceTo(s2) <= reach).sort((s2, t) => distanceTo(s2) - distanceTo(t))[0];
      if (!net || !side) return null;
      const [a, b] = side.map((i) => net.names[i].split(",").map(Number));
      if (a.length === 3) return { degree: [String(a.reduce((sum, n) => sum + n) + 1)] };
      const axis = a[0] === b[0] ? 1 : 0;
      const numbers = (name2, usual) => {
        const [x, y] = (this.step.args[name2]?.[0] ?? usual).split(/[x×]/i);
        return [Number(x), Number(y ?? x)];
      };
      const cells2 = numbers("cells", this.step.args.spline ? "4x4" : "1x1");
      const name = cells2[axis] > 1 ? "cells" : "degree";
      const counts = name === "cells" ? cells2 : numbers("degree", "3x3");
      counts[axis] = name === "cells" ? 2 * counts[axis] : counts[axis] + 1;
      return { [name]: [counts.join("x")] };
    }
    /** Returns the rule for the number of a path's points. */
    pointsOf(name) {
      return this.deformation.params.find((p) => p.name === name)?.points;
    }
    /** The rows of points, all of equal length. */
    get rows() {
      const all = this.deformation.params.filter((p) => p.points === "rows");
      return all.flatMap(({ name }) => (this.grips[name]?.paths ?? []).flat().map((sub) => [name, sub]));
    }
    addPoint(param, grip) {
      this.handles.push({
        key: param,
        param,
        shape: "node",
        label: words(param),
        group: param,
        get: () => grip.point,
        set: (to) => void (grip.point = to)
      });
    }
    /** Adds the handle for the bend of a preset: half a height up or down from the middle is the full bend. */
    addBend(param, grip) {
      const [x, y, w, h2] = this.frame;
      const middle2 = [x + w / 2, y + h2 / 2];
      this.handles.push({
        key: param,
        param,
        shape: "node",
        label: words(param),
        group: param,
        get: () => [middle2[0], middle2[1] - grip.value * h2 / 2],
        set: (to) => void (grip.value = Math.max(-FARTHEST_BEND, Math.min(FARTHEST_BEND, 2 * (middle2[1] - to[1]) / Math.max(h2, 1e-9))))
      });
    }
    /** Adds the handle for a radius about a centre, on the circle. */
    addRadius(param, grip) {
      const centre = () => this.grips.center.point;
      this.handles.push({
        key: param,
        param,
        shape: "control",
        label: words(param),
        group: param,
        get: () => [centre()[0] + grip.value, centre()[1]],
        set: (to) => void (grip.value = Math.hypot(to[0] - centre()[0], to[1] - centre()[1]))
      });
    }
    /** Adds the handles for a circle or arc: the centre moves it, a handle halfway between its ends changes the radius, its ends rotate. */
    addCircle(param, grip) {
      const c = grip.circle;
      const name = words(param);
      const at = (degrees) => onCircle(c, degrees);
      const handle = (key, shape, label, get, set2) => this.handles.push({ key: `${param}/${key}`, param, shape, label: `${name}, ${label}`, group: param, get, set: set2 });
      handle("centre", "node", "centre", () => [c[0], c[1]], (to) => void ([c[0], c[1]] = to));
      handle("radius", "control", "radius", () => at((c[3] + c[4]) / 2), (to) => void (c[2] = Math.max(Math.hypot(to[0] - c[0], to[1] - c[1]), 1e-6)));
      const isWhole = Math.abs(Math.abs(c[4] - c[3]) - 360) < 1e-6;
      const turn = (from, to) => ((Math.atan2(to[1] - c[1], to[0] - c[0]) * 180 / Math.PI - from) % 360 + 540) % 360 - 180;
      handle("start", "node", "start", () => at(c[3]), (to) => {
        const by = turn(c[3], to);
        c[3] += by;
        if (isWhole) c[4] += by;
      });
      if (!isWhole) handle("end", "node", "end", () => at(c[4]), (to) => void (c[4] += turn(c[4], to)));
    }
    addListPoint(param, points, i) {
      this.handles.push({
        key: `${param}/${i}`,
        param,
        shape: "node",
        label: `${words(param)} ${i + 1}`,
        group: param,
        get: () => points[i],
        set: (to) => void (points[i] = to),
        remove: () => {
          points.splice(i, 1);
          this.collect();
        }
      });
    }
    addPair(param, pairs2, i) {
      const remove = () => {
        pairs2.splice(i, 1);
        this.collect();
      };
      const handle = (end2, shape, label) => ({
        key: `${param}/${i}/${end2}`,
        param,
        shape,
        label: `${words(param)} ${i + 1}, ${label}`,
        group: `${param}/${end2}`,
        get: () => pairs2[i][end2],
        set: (to) => void (pairs2[i][end2] = to),
        remove
      });
      this.handles.push(handle(0, "source", "place in the artwork"), handle(1, "node", "where it goes"));
    }
    addNode(param, net, i) {
      const label = `Control point ${net.names[i]}`;
      this.handles.push({
        key: `${param}/${i}`,
        param,
        shape: "node",
        label,
        group: param,
        get: () => net.points[i],
        set: (to) => {
          net.points[i] = to;
          (this.moved[param] ??= /* @__PURE__ */ new Set()).add(i);
        }
      });
    }
    /** Adds the nodes and control points of a path. A smooth node moves its control points; at a corner, adjacent pieces keep their shape,
     * and straight ones stay straight. The ends of a closed path are one node. */
    addSubpath(param, path, sub, id) {
      const { segments } = sub;
      const last = segments.length - 1;
      const isLoop = last >= 0 && (sub.closed || path.length === 1) && coincide(end(segments[last]), sub.start);
      const nodes = isLoop ? segments.length : segments.length + 1;
      const before2 = (n) => n > 0 ? segments[n - 1] : isLoop ? segments[last] : void 0;
      const after = (n) => segments[n];
      const at = (n) => n === 0 ? sub.start : end(segments[n - 1]);
      const isCorner = (n) => {
        const [a, b] = [before2(n), after(n)];
        if (!a || !b) return !SKELETONS.has(param);
        return a.length !== 6 || b.length !== 6 || !isSmooth(at(n), [a[2], a[3]], [b[0], b[1]]);
      };
      const name = param === this.deformation.name ? called(this.deformation) : words(param);
      for (let n = 0; n < nodes; n++) {
        const label = path.length > 1 ? `${name}, line ${path.indexOf(sub) + 1}, point ${n + 1}` : `${name}, point ${n + 1}`;
        const key = `${param}/${id}/${n}`;
        this.handles.push({
          key,
          param,
          shape: "node",
          label,
          group: `${param}/${id}`,
          remove: this.remover(param, sub, n, nodes),
          get: () => at(n),
          set: (to) => {
            const from = at(n);
            const incoming = before2(n);
            const adjacent = [[incoming, 2, n > 0 ? n - 1 : nodes - 1], [after(n), 0, (n + 1) % nodes]];
            const isCornerHere = isCorner(n);
            const isWhole = adjacent.map(([, , other]) => isCornerHere && isCorner(other));
            adjacent.forEach(([seg, near, other], i) => {
              if (seg?.length !== 6) return;
              const image = similarity(isCornerHere ? at(other) : null, from, to);
              for (const k of isWhole[i] ? [near, 2 - near] : [near]) seg.splice(k, 2, ...image([seg[k], seg[k + 1]]));
            });
            if (n === 0) sub.start = to;
            if (n > 0 || isLoop) incoming.splice(incoming.length - 2, 2, ...to);
          }
        });
        const arm = (side) => {
          const seg = side === "in" ? before2(n) : after(n);
          if (seg?.length !== 6) return;
          const k = side === "in" ? 2 : 0;
          this.handles.push({
            key: `${key}/${side}`,
            param,
            shape: "control",
            label: `${label}, handle ${side === "in" ? 1 : 2}`,
            group: `${param}/${id}`,
            get: () => [seg[k], seg[k + 1]],
            set: (to, smooth) => {
              const other = side === "in" ? after(n) : before2(n);
              const m = side === "in" ? 0 : 2;
              const staysSmooth = smooth && other?.length === 6 && isSmooth(at(n), [seg[k], seg[k + 1]], [other[m], other[m + 1]]);
              seg.splice(k, 2, ...to);
              if (staysSmooth) align(other, m, at(n), to);
            }
          });
        };
        arm("in");
        arm("out");
      }
    }
    /** Returns a function that removes a node of a path, if enough remain. */
    remover(param, sub, n, nodes) {
      if (this.editsAllRows(param) && nodes > 2 && n > 0 && n < nodes - 1) {
        return () => {
          for (const [name, row] of this.rows) {
            drop(row, n);
            if (name !== param) this.write(name);
          }
          this.collect();
        };
      }
      if (this.pointsOf(param) !== "any" || nodes <= (sub.closed ? FEWEST_CLOSED : 2)) return void 0;
      return () => {
        drop(sub, n);
        this.collect();
      };
    }
    /** Returns the nearest point within reach on a path of the parameters that `accepts` chooses. */
    pathNear(at, reach, accepts) {
      let best = null;
      for (const param of this.deformation.params.filter(accepts)) {
        this.grips[param.name]?.paths?.forEach((path, i) => path.forEach((sub, j) => {
          const spot = nearest(sub, at);
          if (spot && spot.distance <= Math.min(reach, best?.spot.distance ?? reach)) best = { name: param.name, id: `${i}.${j}`, sub, spot };
        }));
      }
      return best;
    }
    /** Starts to drag the line near a point: a curve bends with the pointer, a straight line moves. */
    pull(at, reach) {
      const hit = this.pathNear(at, reach, () => true);
      if (!hit) return this.pullRow(at, reach) ?? this.pullCircle(at, reach);
      const { name, id, sub, spot } = hit;
      const handle = (n, side = "") => this.handles.find((h2) => h2.key === `${name}/${id}/${n}${side}`);
      const next = handle(spot.piece + 1) ? spot.piece + 1 : 0;
      const isCurve = sub.segments[spot.piece].length === 6;
      const ends = isCurve ? [handle(spot.piece, "/out"), handle(next, "/in")] : [handle(spot.piece), handle(next)];
      const [first, second] = ends;
      if (!first || !second) return null;
      const t = Math.min(Math.max(spot.t, END_MARGIN), 1 - END_MARGIN);
      const weight = isCurve ? 3 * t * (1 - t) * ((1 - t) ** 2 + t ** 2) : 1;
      const shares = isCurve ? [(1 - t) / weight, t / weight] : [1, 1];
      const from = [[...first.get()], [...second.get()]];
      return {
        param: name,
        handles: [first, second],
        ends: [handle(spot.piece), handle(next)].flatMap((h2) => h2 ? [h2.key] : []),
        targets: (to) => from.map(([x, y], i) => [x + shares[i] * (to[0] - at[0]), y + shares[i] * (to[1] - at[1])])
      };
    }
    pullCircle(at, reach) {
      const radius = this.handles.find((h2) => h2.key === "radius");
      const [grip, centre] = [this.grips.radius, this.grips.center?.point];
      if (!radius || !centre || Math.abs(Math.hypot(at[0] - centre[0], at[1] - centre[1]) - (grip?.value ?? 0)) > reach) return null;
      return { param: "radius", handles: [radius], ends: [], targets: (to) => [to] };
    }
    /** A line of a net moves as a whole. */
    pullRow(at, reach) {
      const [param, grip] = Object.entries(this.grips).find(([, g]) => g.net) ?? [];
      const net = grip?.net;
      if (!net || !param) return null;
      const distanceTo = (line) => Math.min(...line.slice(1).map((b, i) => distance(at, net.points[line[i]], net.points[b])));
      const row = net.lines.filter((line) => line.length > 1).sort((a, b) => distanceTo(a) - distanceTo(b))[0];
      if (!row || distanceTo(row) > reach) return null;
      const handles = row.map((i) => this.handles.find(({ key }) => key === `${param}/${i}`));
      const from = handles.map((h2) => [...h2.get()]);
      return { param, handles, ends: handles.map(({ key }) => key), targets: (to) => from.map(([x, y]) => [x + to[0] - at[0], y + to[1] - at[1]]) };
    }
    /** Adds a point to the path near `at`. */
    divide(at, reach) {
      const hit = this.pathNear(at, reach, (param) => param.points !== void 0);
      if (!hit) return false;
      const { name, sub, spot } = hit;
      if (this.pointsOf(name) === "any") {
        split(sub, spot);
        this.collect();
        this.write(name);
        return true;
      }
      for (const [row, points] of this.rows) {
        const [start, ...rest] = raised([points.start, ...points.segments.map(end)]);
        [points.start, points.segments] = [start, rest.map((p) => [...p])];
        this.write(row);
      }
      this.collect();
      return true;
    }
    /** Returns the lines to draw under the handles. */
    lines() {
      const out = this.dials.map(({ line }) => line());
      for (const grip of Object.values(this.grips)) {
        for (const pair of grip.pairs ?? []) out.push({ kind: "arm", points: [...pair] });
        if (grip.value !== void 0 && grip === this.grips[this.deformation.gallery?.bend ?? ""]) {
          const [x, y, w, h2] = this.frame;
          out.push({ kind: "arm", points: [[x + w / 2, y + h2 / 2], [x + w / 2, y + h2 / 2 - grip.value * h2 / 2]] });
        }
        if (grip === this.grips.radius && grip.value !== void 0 && this.grips.center?.point) {
          out.push(circle(this.grips.center.point, grip.value));
        }
        if (grip.net) {
          const { points } = grip.net;
          for (const line of grip.net.lines) out.push({ kind: "net", points: line.map((i) => points[i]) });
        }
        if (grip.circle) {
          const [cx, cy, , from, to] = grip.circle;
          const points = Array.from({ length: CIRCLE_SEGMENTS2 + 1 }, (_, i) => onCircle(grip.circle, from + (to - from) * i / CIRCLE_SEGMENTS2));
          out.push({ kind: "path", points }, { kind: "arm", points: [[cx, cy], points[0]] });
        }
        for (const path of grip.paths ?? []) path.forEach((sub) => this.subpathLines(sub, out));
      }
      return out;
    }
    subpathLines(sub, out) {
      let at = sub.start;
      const pieces = [at];
      for (const seg of sub.segments) {
        const to = end(seg);
        if (seg.length === 6) {
          const [first, second] = [[seg[0], seg[1]], [seg[2], seg[3]]];
          out.push({ kind: "arm", points: [at, first] }, { kind: "arm", points: [second, to] });
          pieces.push(first, second, to);
        } else {
          pieces.push(at, to, to);
        }
        at = to;
      }
      const isQuadrangle = sub.segments.length === 3 && sub.segments.every((seg) => seg.length === 2);
      out.unshift({ kind: "path", points: pieces, cubic: true, closed: sub.closed || isQuadrangle });
    }
    /** Writes the values of a parameter into the step. */
    write(name) {
      const param = this.deformation.params.find((p) => p.name === name);
      const grip = this.grips[name];
      if (!param || !grip) return;
      if (grip.net) this.writeNet(name, grip.net);
      else if (grip.surface) this.step.args[name] = [grip.surface.text];
      else if (grip.adjust) this.step.args[name] = writeAdjust(grip.adjust);
      else if (grip.value !== void 0 && param.kind === "angle") this.step.args[name] = [String(Number(grip.value.toFixed(1)))];
      else if (grip.value !== void 0) this.step.args[name] = [param.kind === "length" ? length(grip.value, param.axis, this.frame) : `${Number((100 * grip.value).toFixed(1))}%`];
      else {
        const before2 = this.step.args[name] ?? [];
        this.step.args[name] = valuesOf(param, grip, this.frame, before2);
        this.freedPath ??= before2.find((value) => value.startsWith("#")) ?? null;
      }
    }
    /** Writes a value for each moved control point of a net; it replaces earlier values and shifts. */
    writeNet(name, net) {
      for (const i of this.moved[name] ?? []) {
        const prefix = `${net.names[i]}:`;
        const without = (key) => (this.step.args[key] ?? []).flatMap((v) => v.split(/\s+/)).filter((v) => v && !v.startsWith(prefix));
        if (this.step.args.move) this.step.args.move = without("move");
        this.step.args[name] = [...without(name), node(net.names[i], net.points[i], this.frame)];
      }
    }
    /** Returns the midpoint of the piece that follows a node. */
    after(handle) {
      const [param, id = "", n] = handle.key.split("/");
      const [i, j] = id.split(".").map(Number);
      const sub = this.grips[param]?.paths?.[i]?.[j];
      if (!sub || this.pointsOf(handle.param) === void 0) return null;
      return middle(sub, Math.min(Number(n), sub.segments.length - 1));
    }
    /** Adds a point where the step takes any number of them, to paths within `reach`; a pin moves `from` to it. */
    add(at, from, reach) {
      if (this.divide(at, reach)) return true;
      if (!this.grows) return false;
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
    get grows() {
      if (Object.values(this.grips).some((grip) => grip.net)) return false;
      return this.deformation.params.some(({ name, repeat }) => repeat && (this.grips[name]?.pairs || this.grips[name]?.points));
    }
    /** `true` if there are paths to which points can be added. */
    get divides() {
      return this.deformation.params.some(({ name, points }) => points && this.grips[name]?.paths);
    }
    /** Returns the handle at the mirror image about the frame's middle, if one is there. */
    partner(handle) {
      const [x, , w, h2] = this.frame;
      const [px, py] = handle.get();
      const mirrored = [2 * x + w - px, py];
      const tolerance = 1e-3 * Math.hypot(w, h2);
      const others = this.handles.filter((o) => o !== handle && o.shape === handle.shape && o.param === handle.param);
      return others.find((o) => Math.hypot(o.get()[0] - mirrored[0], o.get()[1] - mirrored[1]) < tolerance) ?? null;
    }
  };
  function onCircle([cx, cy, r], degrees) {
    return [cx + r * Math.cos(degrees * Math.PI / 180), cy + r * Math.sin(degrees * Math.PI / 180)];
  }
  function circle([x, y], r) {
    const k = 0.5522848 * r;
    const points = [
      [x + r, y],
      [x + r, y + k],
      [x + k, y + r],
      [x, y + r],
      [x - k, y + r],
      [x - r, y + k],
      [x - r, y],
      [x - r, y - k],
      [x - k, y - r],
      [x, y - r],
      [x + k, y - r],
      [x + r, y - k],
      [x + r, y]
    ];
    return { kind: "path", points, cubic: true, closed: true };
  }
  function distance(p, a, b) {
    const [dx, dy] = [b[0] - a[0], b[1] - a[1]];
    const t = Math.min(Math.max(((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / (dx * dx + dy * dy || 1), 0), 1);
    return Math.hypot(a[0] + t * dx - p[0], a[1] + t * dy - p[1]);
  }
  function similarity(about, from, to) {
    if (!about || coincide(about, from)) return ([x, y]) => [x + to[0] - from[0], y + to[1] - from[1]];
    const [ax, ay, bx, by] = [from[0] - about[0], from[1] - about[1], to[0] - about[0], to[1] - about[1]];
    const square = ax * ax + ay * ay;
    const [re, im] = [(ax * bx + ay * by) / square, (ax * by - ay * bx) / square];
    return ([x, y]) => [about[0] + re * (x - about[0]) - im * (y - about[1]), about[1] + im * (x - about[0]) + re * (y - about[1])];
  }
  function coincide(a, b) {
    return Math.hypot(a[0] - b[0], a[1] - b[1]) < 1e-9 * (1 + Math.hypot(...a));
  }
  var OPPOSITE_COSINE = -0.9995;
  function isSmooth(node2, a, b) {
    const [ax, ay, bx, by] = [a[0] - node2[0], a[1] - node2[1], b[0] - node2[0], b[1] - node2[1]];
    return ax * bx + ay * by < OPPOSITE_COSINE * Math.hypot(ax, ay) * Math.hypot(bx, by);
  }
  function align(segment, k, node2, to) {
    const [dx, dy] = [node2[0] - to[0], node2[1] - to[1]];
    const length2 = Math.hypot(dx, dy);
    const radius = Math.hypot(segment[k] - node2[0], segment[k + 1] - node2[1]);
    if (length2 > 0 && radius > 0) segment.splice(k, 2, node2[0] + radius * dx / length2, node2[1] + radius * dy / length2);
  }

  // src/app.ts
  var DRAFT_TOLERANCE = 0.35;
  var DRAFT_EVENT = "pathwarp-drafted";
  var KEY_PAUSE = 500;
  var VISIBLE_MM = 0.05;
  var NET_PARAMS = /* @__PURE__ */ new Set(["degree", "cells", "spline"]);
  var App = class {
    catalogue = [];
    state = null;
    steps = [];
    /** The step whose handles and settings are shown. */
    selected = 0;
    /** `true` while the steps are a proposal that has not been used. */
    isProposal = false;
    /** `true` once the edited step has been changed since its shape was chosen. */
    isWorkedOn = false;
    /** `true` if the next chosen shape is appended as a step. */
    appends = false;
    /** Selectors of the parts that no step bends. */
    locks = [];
    /** The geometry of each step's parameters, from which handles are made. */
    grips = [];
    /** The indices of steps for parts that the drawing lacks. */
    gone = [];
    handles = null;
    /** A path of the drawing that was a guide until its line was dragged. */
    freedPath = null;
    summary = null;
    warnings = [];
    problem = null;
    isConnected = false;
    /** `true` once the steps have been handed to the program that waited for them. */
    isDone = false;
    /** `true` while a handle is dragged; the handles then stay as they are. */
    isDragging = false;
    /** Cancels the drag or the drawing of a line in progress. */
    cancelGesture = null;
    screen = { show: () => {
    }, pixel: 1, reveal: () => {
    } };
    listeners = [];
    /** `true` while a draft is being made, and if another one is to follow. */
    isDrafting = false;
    isDraftWanted = false;
    /** The time of the event that the next draft shows, in ms. */
    draftedEventTime = 0;
    /** The queue of changes to the steps. */
    turns = Promise.resolve();
    /** The last commit; the server answers commits in order. */
    lastCommit = Promise.resolve();
    /** The number of commits that the server has refused. */
    refusals = 0;
    /** The timer that commits the steps after keys have moved a handle; 0 if none runs. */
    commitTimer = 0;
    connection;
    constructor() {
      this.connection = new Connection(
        () => void this.begin(),
        () => {
          this.isConnected = false;
          this.stopCommitTimer();
          this.tell("link");
        },
        (news) => void this.takeNews(news)
      );
    }
    /** `true` if changes are stored. */
    get isLive() {
      return this.isConnected && !this.isDone;
    }
    /** Calls a listener after these changes. */
    listen(changes, listener) {
      this.listeners.push({ changes, listener });
    }
    tell(change) {
      for (const { changes, listener } of this.listeners) if (changes.includes(change)) listener();
    }
    get step() {
      return this.steps[this.selected];
    }
    deformation(name) {
      return this.catalogue.find((d) => d.name === name);
    }
    /** Returns `true` for an edit, which changes the drawing before it is bent. */
    isFirst(step2) {
      return this.deformation(step2?.deformation)?.first ?? false;
    }
    /** The steps up to the edited one. */
    get visible() {
      return this.steps.slice(0, this.selected + 1);
    }
    async begin() {
      const answer = await this.connection.ask({ do: "hello" });
      this.catalogue = answer.catalogue ?? [];
      this.isConnected = true;
      this.tell("link");
      await this.load(answer.state);
    }
    /** Ends the page after the steps have been handed over. */
    finish() {
      this.isDone = true;
      this.connection.stop();
      this.tell("link");
    }
    /** Adopts a state of the server, with a proposal if nothing has been done yet. */
    async load(state) {
      this.state = state;
      this.steps = structuredClone(state.steps);
      this.selected = Math.max(0, Math.min(this.steps.length - 1, Math.max(this.selected, this.steps.length - 1)));
      this.locks = this.steps[0]?.exclude ?? [];
      this.isProposal = false;
      this.isWorkedOn = this.steps.length > 0;
      this.appends = false;
      this.tell("state");
      const first = this.catalogue[0];
      if (this.steps.length === 0 && first) {
        const step2 = await this.opening(first.name, []);
        if (step2) {
          this.steps = [step2];
          this.selected = 0;
          this.isProposal = true;
        }
      }
      this.tell("steps");
      if (await this.refresh()) return;
      const { problem } = this;
      this.dropHandles();
      if (this.isProposal) this.steps = [];
      await this.attempt(async () => this.take(await this.connection.ask({ do: "bend", steps: [], draft: null })));
      this.tell("steps");
      if (this.isProposal) this.isProposal = false;
      else this.fail(problem);
    }
    /** Replaces the drawing after all pending changes; later changes, such as an undo, wait for it. */
    enter(answer) {
      return this.inTurn(async () => {
        const state = (await answer())?.state;
        if (state) await this.load(state);
      });
    }
    /** Requests the first values of a deformation that follows these steps. */
    async opening(deformation, steps, variant = null, select = []) {
      return this.attempt(async () => {
        const { step: step2 } = await this.connection.ask({ do: "opening", deformation, variant, steps, select });
        return step2 ? { ...step2, exclude: this.locks } : null;
      });
    }
    /** The selectors of the edited step's parts; empty for the whole drawing. */
    get selectors() {
      return this.step?.select ?? [];
    }
    /** Applies the edited step only to these parts, with its paths mapped onto their box. */
    scope(select) {
      return this.inTurn(async () => {
        const { step: step2, selected } = this;
        if (!step2 || this.isFirst(step2) || select.length === 0 && this.selectors.length === 0) return;
        const answer = await this.request({ do: "scope", steps: this.visible, select });
        if (!answer?.step) return;
        this.steps = this.steps.map((s2, i) => i === selected ? answer.step : s2);
        this.tell("steps");
        this.dropHandles();
        await this.commit();
      });
    }
    /** Excludes these parts from all steps. */
    lock(locks) {
      this.locks = locks;
      return this.arrange(this.steps.map((step2) => ({ ...step2, exclude: locks })), this.selected);
    }
    /** Shows the exact picture of the present steps. Returns `false` if there is none. */
    async refresh() {
      const shown3 = await this.attempt(async () => {
        this.take(await this.connection.ask({ do: "bend", steps: this.visible, draft: null }));
        return true;
      });
      return shown3 ?? !this.isConnected;
    }
    /** Shows a draft of the present steps. While one is being made, only the newest request is kept. */
    async draft(eventTime) {
      this.draftedEventTime = eventTime;
      this.isDraftWanted = true;
      if (this.isDrafting) return;
      this.isDrafting = true;
      do {
        this.isDraftWanted = false;
        const start = this.draftedEventTime;
        await this.attempt(async () => {
          const asked = performance.now();
          const answer = await this.connection.ask({ do: "bend", steps: this.visible, draft: DRAFT_TOLERANCE * this.screen.pixel });
          const answered = performance.now();
          this.take(answer);
          const detail = { start, asked, answered, shown: performance.now(), size: this.connection.size };
          window.dispatchEvent(new CustomEvent(DRAFT_EVENT, { detail }));
        });
      } while (this.isDraftWanted);
      this.isDrafting = false;
    }
    /** Stores the present steps, with a state to undo. */
    commit() {
      this.lastCommit = this.sendCommit();
      return this.lastCommit;
    }
    async sendCommit() {
      this.isDraftWanted = false;
      this.stopCommitTimer();
      const done = await this.attempt(async () => {
        const answer = await this.connection.ask({ do: "commit", steps: this.steps, shown: this.selected + 1 });
        this.isProposal = false;
        this.isWorkedOn = true;
        this.take(answer);
        return true;
      });
      if (done || !this.state || !this.isConnected) return;
      this.refusals += 1;
      const { problem } = this;
      await this.load(this.state);
      this.fail(problem);
    }
    /** Commits if no other key follows for a while. */
    commitSoon() {
      this.isDragging = true;
      clearTimeout(this.commitTimer);
      this.commitTimer = window.setTimeout(() => void this.flush(), KEY_PAUSE);
    }
    /** Commits changes made by keys so far, if any. */
    async flush() {
      if (this.stopCommitTimer()) await this.commit();
    }
    /** Waits until the server has stored all changes. Returns `false` if it refuses some. */
    async settle() {
      const { refusals } = this;
      this.takeTyped();
      await this.turns;
      await this.flush();
      await this.lastCommit;
      return !showWrong() && this.refusals === refusals;
    }
    /** Accepts the value that is being typed, as if its field had lost the focus. */
    takeTyped() {
      const field = document.activeElement;
      if (!isTyping(field)) return;
      field.blur();
      field.focus({ preventScroll: true });
    }
    /** Returns `true` if a timer ran. */
    stopCommitTimer() {
      if (this.commitTimer === 0) return false;
      clearTimeout(this.commitTimer);
      this.commitTimer = 0;
      this.isDragging = false;
      return true;
    }
    /** Cancels a drag: restores the step as it was before. */
    cancel(step2, before2) {
      this.cancelGesture = null;
      this.isDragging = false;
      this.isDraftWanted = false;
      this.steps = this.steps.map((s2) => s2 === step2 ? before2 : s2);
      void this.refresh();
      this.tell("values");
    }
    /** Changes the steps after all pending changes, so that a late answer does not replace a newer choice. */
    inTurn(work) {
      hush();
      const done = this.turns.then(() => this.flush()).then(work);
      this.turns = done.catch(() => void 0);
      return done;
    }
    /** Undoes or redoes; during a drag, undoing only cancels the drag. */
    async turn(direction) {
      if (this.cancelGesture) return direction === "undo" ? this.cancelGesture() : void 0;
      this.takeTyped();
      return this.inTurn(async () => {
        if (!this.state?.[direction]) return;
        await this.attempt(async () => {
          const answer = await this.connection.ask({ do: direction, shown: null });
          this.screen.show(answer);
          await this.load(answer.state);
          this.screen.reveal();
        });
      });
    }
    /** Starts or ends the choice of a shape for another step. */
    append(appends) {
      this.appends = appends;
      this.tell("steps");
    }
    /** Replaces the edited step, or appends one if requested. */
    choose(deformation, args, variant = null) {
      let { appends } = this;
      this.appends = false;
      return this.inTurn(async () => {
        if (this.deformation(deformation)?.first) return this.insertEdit(deformation);
        appends ||= this.isFirst(this.step);
        const at = appends ? this.steps.length : this.selected;
        const step2 = await this.opening(deformation, this.steps.slice(0, at), variant, this.selectors);
        if (!step2) return;
        Object.assign(step2.args, args);
        await this.commitNew(this.steps.toSpliced(at, 1, step2), at);
      });
    }
    /** Stores steps with a new one, and shows all of it, since it may need more room. */
    async commitNew(steps, selected) {
      this.steps = steps;
      this.selected = Math.min(selected, steps.length - 1);
      this.tell("steps");
      this.dropHandles();
      await this.commit();
      this.isWorkedOn = false;
      this.tell("steps");
      this.screen.reveal();
    }
    /** Inserts an edit before all deformations, in the order of the catalogue; there is one of each kind. */
    async insertEdit(deformation) {
      const others = this.isProposal ? [] : this.steps;
      const known = others.findIndex((s2) => s2.deformation === deformation && !isCaption(s2));
      if (known >= 0) return this.showStep(known);
      const step2 = await this.opening(deformation, []);
      if (!step2) return;
      const rank = (s2) => this.catalogue.findIndex((d) => d.name === s2.deformation);
      const at = others.filter((s2) => this.isFirst(s2) && rank(s2) < rank(step2)).length;
      await this.commitNew(others.toSpliced(at, 0, step2), at);
    }
    /** Inserts words after existing ones, before all other steps. Returns their step, which is stored when it is committed. */
    caption(args) {
      return this.inTurn(async () => {
        const step2 = await this.opening("caption", []);
        if (!step2) return null;
        Object.assign(step2.args, args);
        const others = this.isProposal ? [] : this.steps;
        this.isProposal = false;
        this.selected = others.filter(isCaption).length;
        this.steps = others.toSpliced(this.selected, 0, step2);
        this.tell("steps");
        this.dropHandles();
        await this.refresh();
        return step2;
      });
    }
    /** Replaces the list of steps. */
    arrange(steps, selected) {
      return this.inTurn(async () => {
        this.steps = steps;
        this.appends = false;
        this.selected = Math.max(0, Math.min(selected, steps.length - 1));
        this.tell("steps");
        this.dropHandles();
        await this.commit();
        if (this.steps.length === 0 && this.state) await this.load(this.state);
        this.tell("steps");
      });
    }
    select(step2) {
      return this.inTurn(() => this.showStep(step2));
    }
    async showStep(step2) {
      this.selected = step2;
      this.tell("steps");
      await this.refresh();
    }
    /** Sets a parameter of the edited step: `isDone` stores it, otherwise a draft is shown. */
    set(name, values, isDone) {
      const { step: step2 } = this;
      if (!step2) return;
      if (isDone && NET_PARAMS.has(name) && this.handles?.net) return void this.inTurn(() => this.renet({ [name]: values }));
      const { presets } = this.deformation(step2.deformation)?.gallery ?? {};
      if (name === presets) {
        for (const [other, { adjust }] of Object.entries(this.grips[this.selected]?.params ?? {})) if (adjust) delete step2.args[other];
      }
      if (values.length === 0) delete step2.args[name];
      else step2.args[name] = values;
      const instead = this.deformation(step2.deformation)?.params.find((p) => p.name === name)?.instead;
      if (instead && values.length > 0) {
        for (const other of instead.others) delete step2.args[other];
        if (instead.with) step2.args[instead.with[0]] ??= [instead.with[1]];
      }
      void (isDone ? this.commit() : this.draft(performance.now()));
    }
    /** Sets a parameter by a key; keys that follow belong to the same change. */
    setSoon(name, values) {
      if (NET_PARAMS.has(name) && this.handles?.net) return this.set(name, values, true);
      this.set(name, values, false);
      this.commitSoon();
      this.tell("values");
    }
    /** Sets a parameter to a typed value. Returns the problem, if any. */
    async setTyped(name, values) {
      const { refusals } = this;
      this.set(name, values, true);
      await this.turns;
      await this.lastCommit;
      const { problem } = this;
      if (this.refusals === refusals || problem === null) {
        this.screen.reveal();
        return null;
      }
      this.fail(null);
      return inWords(problem, true);
    }
    /** Changes the number of control points of the step's net, which bends as before. */
    async renet(values) {
      const answer = await this.request({ do: "renet", steps: this.visible, values });
      if (!answer?.step) return this.tell("steps");
      const [a, b] = this.state?.toPx ?? [1, 0];
      const mm = (answer.moved ?? 0) * Math.hypot(a, b) * 25.4 / 96;
      if (mm >= VISIBLE_MM) toast(`The shape has moved by up to ${mm.toFixed(mm < 10 ? 2 : 0)} mm: so few points cannot hold it`);
      this.steps = this.steps.map((s2, i) => i === this.selected ? answer.step : s2);
      this.tell("steps");
      this.dropHandles();
      await this.commit();
    }
    grip(name) {
      return this.grips[this.selected]?.params[name];
    }
    /** Returns the least radius around which the artwork fits, if it is longer than its full circle and is not stretched; else `null`. */
    leastRadius(name) {
      const [circle2, frame, step2] = [this.grip(name)?.circle, this.grips[this.selected]?.frame, this.step];
      if (!circle2 || !frame || name !== "along" || ["stretch", "copies", "width"].some((other) => step2?.args[other])) return null;
      const [, , radius, start, end2] = circle2;
      const least = frame[2] / (Math.abs(end2 - start) * (Math.PI / 180));
      return radius < least && Math.abs(Math.abs(end2 - start) - 360) < 1e-6 ? least : null;
    }
    take(answer) {
      this.problem = null;
      if (answer.state) {
        this.state = answer.state;
        this.tell("state");
      }
      this.warnings = answer.warnings ?? [];
      this.summary = answer.summary ?? null;
      if (answer.grips) this.grips = answer.grips;
      if (answer.gone) this.gone = answer.gone;
      this.screen.show(answer);
      if (!this.isDragging) this.takeHandles();
      this.tell("report");
    }
    /** Removes the handles of a step that is being replaced, so that they cannot be dragged meanwhile. */
    dropHandles() {
      this.cancelGesture?.();
      this.handles = null;
      this.grips = [];
      this.tell("handles");
    }
    takeHandles() {
      this.freedPath = this.handles?.freedPath ?? null;
      const deformation = this.deformation(this.step?.deformation);
      const grips = this.grips[this.selected];
      this.handles = this.step && deformation && grips ? new Handles(deformation, this.step, grips) : null;
      this.tell("handles");
    }
    /** Adopts changes of the steps by another page. */
    async takeNews(news) {
      if (news.event !== "changed" || !news.state) return;
      if (this.isDragging) {
        if (news.state.drawing === this.state?.drawing) return;
        this.cancelGesture?.();
        this.stopCommitTimer();
      }
      const { file } = this.state ?? news.state;
      await this.load(news.state);
      if (news.state.file !== file) toast(`${news.state.file} has been opened in another tab. The steps of ${file} are kept with it`);
    }
    /** Does something that the server may refuse, and shows the message then. */
    async attempt(work) {
      try {
        return await work();
      } catch (e) {
        if (!(e instanceof Gone)) this.fail(inWords(reason(e)));
        return null;
      }
    }
    /** Asks the server, and shows its message if it refuses. */
    request(question) {
      return this.attempt(() => this.connection.ask(question));
    }
    fail(problem) {
      this.problem = problem;
      this.tell("report");
    }
    /** Adds a point where the step takes any number of them, and at the mirrored points. Returns the key of its handle. */
    addPoint(at, others, reach) {
      return this.inTurn(async () => {
        const { handles } = this;
        if (!handles) return null;
        const denser = handles.denser(at, reach);
        if (denser) await this.renet(denser);
        else if (!await this.addPoints(handles, at, others, reach)) return null;
        return this.handles?.nearest(at)?.key ?? null;
      });
    }
    /** Returns `false` if no point can be added at `at`. */
    async addPoints(handles, at, others, reach) {
      const points = handles.isFree(at, reach) ? [at, ...others] : [at];
      const sources = handles.addsPins ? await Promise.all(points.map((p) => this.preimage(p))) : points;
      if (this.handles !== handles || !sources[0]) return false;
      const isAdded = points.map((p, i) => sources[i] != null && handles.add(p, sources[i], reach));
      if (!isAdded[0]) return false;
      this.tell("handles");
      await this.commit();
      return true;
    }
    /** Returns the point of the drawing that the visible steps map to `at`, or `at` if there is none. */
    async source(at) {
      for (let k = this.visible.length; k > 0; k--) {
        const steps = this.visible.slice(0, k);
        if (this.isFirst(steps[k - 1]) || steps[k - 1]?.hidden || this.gone.includes(k - 1)) continue;
        at = (await this.request({ do: "preimage", steps, at }))?.at ?? at;
      }
      return at;
    }
    /** Returns the point of the artwork that the step maps to `at`. */
    async preimage(at) {
      const source = (await this.request({ do: "preimage", steps: this.visible, at }))?.at;
      if (source === null) this.fail("No place of the artwork comes to lie there");
      return source ?? null;
    }
  };

  // src/drawing.ts
  var SVG2 = "http://www.w3.org/2000/svg";
  var XLINK = "http://www.w3.org/1999/xlink";
  var ELEMENTS = new Set(
    "svg g path image defs linearGradient radialGradient stop pattern clipPath mask filter feBlend feColorMatrix feComponentTransfer feComposite feConvolveMatrix feDiffuseLighting feDisplacementMap feDistantLight feDropShadow feFlood feFuncA feFuncB feFuncG feFuncR feGaussianBlur feImage feMerge feMergeNode feMorphology feOffset fePointLight feSpecularLighting feSpotLight feTile feTurbulence use".split(" ")
  );
  var LINK = /^(#|data:image\/(png|jpeg|gif|webp|svg\+xml);base64,)/;
  var LOADS = /url\(\s*["']?(?!#)/i;
  function copy(from, lines) {
    if (from.namespaceURI !== SVG2 || !ELEMENTS.has(from.localName)) {
      skip(from, lines);
      return null;
    }
    const to = document.createElementNS(SVG2, from.localName);
    for (const { name, value } of Array.from(from.attributes)) set(to, name, value);
    lines?.push(to);
    for (const child of Array.from(from.children)) {
      const copied = copy(child, lines);
      if (copied) to.append(copied);
    }
    if (from.children.length > 0) lines?.push(null);
    return to;
  }
  function skip(element, lines) {
    lines?.push(null);
    for (const child of Array.from(element.children)) skip(child, lines);
    if (element.children.length > 0) lines?.push(null);
  }
  function set(element, name, value) {
    if (name.startsWith("on") || name.startsWith("xmlns")) return;
    if (name === "href" || name === "xlink:href") {
      if (LINK.test(value)) element.setAttributeNS(name === "href" ? null : XLINK, name, value);
      return;
    }
    if (name === "style") {
      for (const [property, ...rest] of value.split(";").map((part) => part.split(":"))) {
        if (property && !LOADS.test(rest.join(":"))) element.style.setProperty(property.trim(), rest.join(":").trim());
      }
      return;
    }
    if (LOADS.test(value)) return;
    element.setAttribute(name, value);
  }
  function parse(text, lines = null) {
    const root = new DOMParser().parseFromString(text, "image/svg+xml").documentElement;
    return copy(root, lines);
  }
  function parseWithPrefix(text, prefix) {
    const root = text ? parse(text) : null;
    for (const element of Array.from(root?.querySelectorAll("*") ?? [])) {
      for (const { name, value } of Array.from(element.attributes)) {
        if (name === "id") element.setAttribute(name, `${prefix}-${value}`);
        else if (value.includes("url(#")) element.setAttribute(name, value.replaceAll("url(#", `url(#${prefix}-`));
        else if (name.endsWith("href") && value.startsWith("#")) element.setAttribute(name, `#${prefix}-${value.slice(1)}`);
      }
    }
    return root;
  }
  var Drawing = class {
    constructor(layer) {
      this.layer = layer;
    }
    layer;
    /** The element that each line of the server's text opens. */
    lines = [];
    /** Shows a picture. */
    show(picture) {
      if ("changes" in picture) {
        for (const [line, name, value] of picture.changes) {
          const element = this.lines[line];
          if (element) set(element, name, value);
        }
        return;
      }
      this.lines = [];
      const root = parse(picture.whole, this.lines);
      this.layer.replaceChildren(...root ? Array.from(root.children) : []);
    }
    /** The paths of the drawing, for nodes and handles. */
    paths() {
      return Array.from(this.layer.querySelectorAll("path")).filter((p) => !p.closest("defs"));
    }
  };

  // src/opening.ts
  var PASTED = "pasted.svg";
  var Opening = class {
    constructor(app2) {
      this.app = app2;
      const fileInput = byId("open-file");
      byId("open").addEventListener("click", () => fileInput.click());
      onFile(fileInput, (file) => void this.open(file));
      window.addEventListener("dragover", (e) => {
        e.preventDefault();
        if (e.dataTransfer) e.dataTransfer.dropEffect = "copy";
        document.body.classList.add("dropping");
      });
      window.addEventListener("dragleave", (e) => {
        if (!e.relatedTarget) document.body.classList.remove("dropping");
      });
      window.addEventListener("drop", (e) => {
        e.preventDefault();
        document.body.classList.remove("dropping");
        this.take(e.dataTransfer);
      });
      window.addEventListener("paste", (e) => {
        if (!isTyping(e.target)) this.take(e.clipboardData);
      });
    }
    app;
    /** Opens a dropped or pasted file, or the text of a drawing. */
    take(data) {
      const file = data?.files[0];
      const text = data?.getData("text/plain") ?? "";
      if (file) void this.open(file);
      else if (/<svg[\s>]/i.test(text)) void this.open(new File([text], PASTED));
      else if (data) toast("This is not a drawing: drop or paste an SVG or a photograph");
    }
    async open(file) {
      const { app: app2 } = this;
      await app2.settle();
      const { state } = app2;
      if (!state || !app2.isLive) return;
      if (state.program) return void toast(`${state.program} waits for this drawing; another one cannot be opened`);
      const isLost = state.problem !== null && state.steps.length > 0 && !state.saved;
      if (isLost && !confirm(`The steps of ${state.file} are not saved, and nothing keeps them. Open ${file.name} all the same?`)) return;
      await app2.enter(() => app2.attempt(async () => app2.connection.ask({ do: "open", name: file.name, bytes: await base64(file) })));
    }
  };
  async function bring(app2, file) {
    const bytes = await base64(file);
    const answer = await app2.request({ do: "bring", name: file.name, bytes });
    if (!answer?.written) return null;
    if (answer.copied) toast(`${file.name} was copied beside the drawing`);
    return answer.written;
  }
  var PIECE = 32768;
  async function base64(file) {
    const bytes = new Uint8Array(await file.arrayBuffer());
    let binary = "";
    for (let i = 0; i < bytes.length; i += PIECE) binary += String.fromCharCode(...bytes.subarray(i, i + PIECE));
    return btoa(binary);
  }

  // src/background.ts
  var OPACITY = 50;
  var NOTCH = 15;
  var ABOVE2 = 26;
  var SAMPLES2 = 100;
  var TYPED = { x: ["mm", MM], y: ["mm", MM], width: ["mm", MM, 0.01], turn: ["°", 1] };
  var Background = class {
    constructor(app2, stage2) {
      this.app = app2;
      this.stage = stage2;
      stage2.behind.append(this.layer);
      stage2.overlay.append(this.frame);
      stage2.around = () => this.file ? this.corners : [];
      stage2.onLayout.push(() => this.placeFrame());
      this.button.addEventListener("click", () => this.file ? this.show(this.box.hidden !== false) : this.fileInput.click());
      onFile(this.fileInput, async (file) => {
        await this.take(file);
        app2.screen.reveal();
        await this.keep();
      });
      this.opacity.addEventListener("input", () => this.showOpacity());
      this.opacity.addEventListener("change", () => void this.keep());
      byId("background-other").addEventListener("click", () => this.fileInput.click());
      byId("background-remove").addEventListener("click", () => {
        this.clear();
        void this.keep();
      });
      this.outline.addEventListener("click", () => void this.bendInto());
      for (const [name, [unit, size, least]] of Object.entries(TYPED)) {
        const input = byId(`background-${name}`);
        const number = (text) => inUnits(text, unit) ?? NaN;
        const isWrong = (text) => number(text) >= (least ?? -Infinity) ? null : describeLimits(unit, least);
        const field = new Field(input, () => String(Number((this.placement[name] / size).toFixed(2))), (text) => {
          this.move({ [name]: number(text) * size });
          void this.keep();
          return null;
        }, isWrong);
        this.box.querySelector(".messages").append(field.message);
        this.fields.push(field);
      }
      this.ground.addEventListener("pointerdown", (e) => this.drag(e, ([x, y]) => ([px, py]) => ({ x: this.placement.x + px - x, y: this.placement.y + py - y })));
      this.ground.addEventListener("keydown", (e) => this.key(e));
      this.knobs.forEach((knob, i) => knob.addEventListener("pointerdown", (e) => this.drag(e, (from) => i < 4 ? this.scaling(i, from) : this.rotation(from))));
      app2.listen(["link"], () => this.isKept = false);
      app2.listen(["state"], () => {
        if (this.isKept) return;
        this.isKept = true;
        void (this.file ? this.keep() : this.restore());
      });
    }
    app;
    stage;
    image = s("image", { class: "background" });
    /** The paths of the drawing, invisible but clickable. */
    outlines = s("g", { class: "outlines", opacity: 0 });
    layer = s("g", { visibility: "hidden" }, this.image, this.outlines);
    edge = s("path", { class: "line arm" });
    ground = s("path", { class: "ground", tabindex: 0, role: "button", "aria-label": "Background; arrow keys move it" });
    /** The corners, clockwise from the upper left, and the rotation handle. */
    knobs = ["nw", "ne", "se", "sw", "turn"].map((part) => s(
      "g",
      { class: `part ${part}` },
      s("title", {}, part === "turn" ? "Turn the background" : "Scale the background"),
      s("circle", { r: 16, class: "reach" }),
      part === "turn" ? s("circle", { r: 6, class: "body" }) : s("rect", { x: -5, y: -5, width: 10, height: 10, class: "body" })
    ));
    frame = s("g", { class: "lie", visibility: "hidden" }, this.ground, this.edge, ...this.knobs);
    button = byId("background");
    box = byId("background-box");
    fileInput = byId("background-file");
    outline = byId("background-outline");
    file = null;
    isDrawing = false;
    placement = { x: 0, y: 0, width: 1, turn: 0 };
    /** Ratio of height to width. */
    ratio = 1;
    fields = [];
    opacity = byId("background-opacity");
    /** `true` once the server has been asked for the background, or has stored it. */
    isKept = false;
    /** Requests points around the object in a photograph. */
    onOutline = () => {
    };
    /** Stores the background in the server, until the page is loaded again. */
    async keep() {
      const { file, placement, opacity } = this;
      const background2 = file && { name: file.name, type: file.type, bytes: await base64(file), lie: placement, opacity: opacity.value };
      await this.app.request({ do: "keep-background", background: background2 });
    }
    async restore() {
      const kept2 = (await this.app.request({ do: "background" }))?.background;
      if (!kept2) return;
      const content = Uint8Array.from(atob(kept2.bytes), (c) => c.charCodeAt(0));
      if (!await this.take(new File([content], kept2.name, { type: kept2.type }))) return;
      this.opacity.value = kept2.opacity;
      this.showOpacity();
      this.move(kept2.lie);
      this.show(false);
      this.app.screen.reveal();
    }
    showOpacity() {
      this.image.setAttribute("opacity", String(Number(this.opacity.value) / 100));
    }
    /** Shows a file behind the drawing: a drawing at its original size and position, a picture as wide as the page. */
    async take(file) {
      const url = URL.createObjectURL(file);
      const probe = new Image();
      probe.src = url;
      try {
        await probe.decode();
      } catch {
        URL.revokeObjectURL(url);
        this.app.fail(`${file.name} is not a picture or drawing that the browser can show`);
        return false;
      }
      this.clear();
      this.file = file;
      this.isDrawing = /\.svgz?$/i.test(file.name);
      const [x0, y0, x1] = this.stage.pageBox;
      this.ratio = probe.naturalHeight / Math.max(probe.naturalWidth, 1);
      this.outline.hidden = this.app.state?.program !== null;
      this.image.setAttribute("href", url);
      this.showOpacity();
      this.move(this.isDrawing ? { x: 0, y: 0, width: probe.naturalWidth, turn: 0 } : { x: x0, y: y0, width: x1 - x0, turn: 0 });
      this.show(true);
      return true;
    }
    get middle() {
      const { x, y, width } = this.placement;
      return [x + width / 2, y + width * this.ratio / 2];
    }
    /** The corners clockwise from the upper left, in px of the drawing. */
    get corners() {
      const [[cx, cy], { x, y, width, turn }] = [this.middle, this.placement];
      const [cos, sin] = [Math.cos(turn * Math.PI / 180), Math.sin(turn * Math.PI / 180)];
      return [[x, y], [x + width, y], [x + width, y + width * this.ratio], [x, y + width * this.ratio]].map(([px, py]) => [
        cx + cos * (px - cx) - sin * (py - cy),
        cy + sin * (px - cx) + cos * (py - cy)
      ]);
    }
    /** Moves, scales or rotates it. */
    move(change) {
      Object.assign(this.placement, change);
      const { x, y, width, turn } = this.placement;
      for (const [name, value] of Object.entries({ x, y, width, height: width * this.ratio })) this.image.setAttribute(name, String(value));
      this.layer.setAttribute("transform", `rotate(${turn} ${this.middle.join(" ")})`);
      this.outlines.setAttribute("transform", `translate(${x} ${y}) scale(${width / Number(this.outlines.dataset.width ?? 1)})`);
      for (const field of this.fields) field.refresh();
      this.placeFrame();
    }
    /** Updates the frame around it on the screen. */
    placeFrame() {
      const { scale: scale2, shift } = this.stage.camera;
      const corners2 = this.corners.map(([x, y]) => [scale2 * x + shift[0], scale2 * y + shift[1]]);
      const [a, b] = [corners2[0], corners2[1]];
      const [top, length2] = [[(a[0] + b[0]) / 2, (a[1] + b[1]) / 2], Math.hypot(b[0] - a[0], b[1] - a[1]) || 1];
      const turn = [top[0] + ABOVE2 * (b[1] - a[1]) / length2, top[1] - ABOVE2 * (b[0] - a[0]) / length2];
      this.ground.setAttribute("d", `M${corners2.join("L")}Z`);
      this.edge.setAttribute("d", `M${corners2.join("L")}ZM${top}L${turn}`);
      [...corners2, turn].forEach((p, i) => this.knobs[i].setAttribute("transform", `translate(${p})`));
    }
    /** Returns the scalings about the opposite corner by a pointer that pressed at `from`. */
    scaling(corner, from) {
      const [[ox, oy], [cx, cy], { width }] = [this.corners[(corner + 2) % 4], this.middle, this.placement];
      const [ax, ay] = [from[0] - ox, from[1] - oy];
      return (to) => {
        const factor2 = Math.max(((to[0] - ox) * ax + (to[1] - oy) * ay) / (ax * ax + ay * ay || 1), 1e-3);
        return { x: ox + factor2 * (cx - ox) - factor2 * width / 2, y: oy + factor2 * (cy - oy) - factor2 * width * this.ratio / 2, width: factor2 * width };
      };
    }
    rotation(from) {
      const [[cx, cy], { turn }] = [this.middle, this.placement];
      const angle = ([x, y]) => Math.atan2(y - cy, x - cx) * 180 / Math.PI;
      return (to, { shiftKey }) => {
        const now = turn + angle(to) - angle(from);
        return { turn: shiftKey ? NOTCH * Math.round(now / NOTCH) : (now + 540) % 360 - 180 };
      };
    }
    /** Follows a pointer from a point in px of the drawing until it is lifted, or Escape cancels the drag. */
    drag(e, begin) {
      if (e.button !== 0) return;
      e.stopPropagation();
      const before2 = { ...this.placement };
      const at = (event) => {
        const { scale: scale2, shift } = this.stage.camera;
        const [x, y] = this.stage.point(event);
        return [(x - shift[0]) / scale2, (y - shift[1]) / scale2];
      };
      const change = begin(at(e));
      const stop = new AbortController();
      const end2 = () => {
        stop.abort();
        void this.keep();
      };
      window.addEventListener("pointermove", (event) => {
        if (event.pointerId !== e.pointerId) return;
        Object.assign(this.placement, before2);
        this.move(change(at(event), event));
      }, stop);
      for (const lifted of ["pointerup", "pointercancel"]) window.addEventListener(lifted, end2, stop);
      window.addEventListener("keydown", ({ key }) => {
        if (key !== "Escape") return;
        this.move(before2);
        end2();
      }, stop);
    }
    key(e) {
      const direction = ARROWS[e.key];
      if (!direction) return;
      e.preventDefault();
      e.stopPropagation();
      const px = (e.shiftKey ? 10 : 1) / this.stage.camera.scale;
      this.move({ x: this.placement.x + px * direction[0], y: this.placement.y + px * direction[1] });
      void this.keep();
    }
    show(on2) {
      this.box.hidden = !on2;
      this.layer.setAttribute("visibility", this.file ? "visible" : "hidden");
      this.frame.setAttribute("visibility", on2 ? "visible" : "hidden");
      this.button.setAttribute("aria-pressed", String(this.file !== null));
      this.button.setAttribute("aria-expanded", String(on2));
      byId("background-name").textContent = this.file?.name ?? "";
    }
    clear() {
      const href = this.image.getAttribute("href");
      if (href) URL.revokeObjectURL(href);
      this.image.removeAttribute("href");
      this.outlines.replaceChildren();
      this.opacity.value = String(OPACITY);
      this.file = null;
      this.show(false);
    }
    /** Bends the artwork into an outline of the background: a clicked path, or points around the object in a photograph. */
    async bendInto() {
      const { app: app2, file, stage: stage2, outlines } = this;
      const variant = app2.deformation("envelope")?.variants.find(({ param }) => param === "envelope");
      if (!file || !variant) return;
      const choose = (value) => void app2.choose("envelope", { envelope: [value] }, variant.label);
      this.show(false);
      if (!this.isDrawing) return this.onOutline(choose);
      if (outlines.childElementCount === 0) {
        const bytes = await base64(file);
        const answer = await app2.request({ do: "drawn", name: file.name, bytes });
        const root = parseWithPrefix(answer?.svg, "behind");
        if (!root) return;
        outlines.dataset.width = root.getAttribute("width") ?? "1";
        outlines.replaceChildren(...Array.from(root.children));
        this.move({});
      }
      const paths = Array.from(outlines.querySelectorAll("path")).filter((path) => !path.closest("defs"));
      if (paths.length === 0) return app2.fail(`${file.name} has no paths: click points around a shape with “Draw path” among the settings of “${variant.label}”`);
      const [only] = paths;
      if (only && paths.length === 1 && !/Z.*M/i.test(only.getAttribute("d") ?? "")) return choose(ring(only, stage2, this.corners[0]));
      stage2.pick((path, at) => choose(ring(path, stage2, stage2.camera.inPx(at))), `Click a path of ${file.name}`, ".outlines path");
    }
  };
  function ring(path, stage2, [x, y]) {
    const [box, m] = [stage2.svg.getBoundingClientRect(), path.getScreenCTM()];
    const toUser = (px, py) => stage2.camera.toUser([m.a * px + m.c * py + m.e - box.x, m.b * px + m.d * py + m.f - box.y]);
    const rings = (path.getAttribute("d") ?? "").split(/(?=M)/).map((d) => d.replace(/Z\s*$/, "").replace(/(-?[\d.]+)[\s,]+(-?[\d.]+)/g, (_, px, py) => toUser(Number(px), Number(py)).map(short).join(",")));
    const distance2 = (d) => {
      const line = s("path", { d });
      const samples = Array.from({ length: SAMPLES2 }, (_, i) => line.getPointAtLength(line.getTotalLength() * i / SAMPLES2));
      return Math.min(...samples.map((p) => stage2.camera.inPx([p.x, p.y])).map(([px, py]) => Math.hypot(px - x, py - y)));
    };
    const nearest3 = rings.reduce((best, d) => distance2(d) < distance2(best) ? d : best);
    return `${nearest3.trim()} Z`;
  }

  // src/caption.ts
  var BELOW = 14;
  var Caption = class {
    constructor(app2, stage2, sketching2) {
      this.app = app2;
      this.stage = stage2;
      this.sketching = sketching2;
      this.text.addEventListener("input", () => this.typed());
      this.text.addEventListener("blur", () => this.done());
      this.text.addEventListener("keydown", (e) => {
        if (e.key === "Escape") this.text.blur();
      });
      stage2.svg.addEventListener("dblclick", () => {
        if (app2.step && isCaption(app2.step)) this.open(app2.step, (app2.step.args.words ?? []).join("\n"));
      });
    }
    app;
    stage;
    sketching;
    box = byId("caption-box");
    text = byId("caption-text");
    step = null;
    /** The words when typing began; empty for new ones. */
    before = "";
    /** Asks for the position of words with these values. */
    begin(args) {
      this.sketching.begin("point", async (value) => {
        const [x, y] = await this.app.source(value.split(",").map(Number));
        const step2 = await this.app.caption({ ...args, at: [`${short(x)},${short(y)}`] });
        if (step2) this.open(step2, (args.words ?? []).join("\n"), "");
      });
    }
    open(step2, text, before2 = text) {
      [this.step, this.before, this.text.value] = [step2, before2, text];
      this.box.hidden = false;
      this.place();
      this.text.focus();
      this.text.select();
    }
    /** Positions the field below the words. */
    place() {
      const at = this.stage.handle("at")?.get();
      if (this.box.hidden || !at) return;
      const [x, y] = this.stage.camera.toScreen(at);
      const { clientWidth, clientHeight } = this.stage.svg;
      const clamp2 = (v, most) => Math.min(Math.max(v, 0), Math.max(most, 0));
      this.box.style.left = `${clamp2(x, clientWidth - this.box.offsetWidth)}px`;
      this.box.style.top = `${clamp2(y + BELOW, clientHeight - this.box.offsetHeight)}px`;
    }
    typed() {
      this.text.rows = this.text.value.split("\n").length;
      if (!this.step || this.text.value.trim() === "") return;
      this.step.args.words = this.text.value.split("\n");
      this.app.draft(performance.now());
      this.app.tell("values");
    }
    /** Stores the typed words, or removes them if there are none. */
    done() {
      const { app: app2, step: step2, text, before: before2 } = this;
      const at = step2 ? app2.steps.indexOf(step2) : -1;
      this.step = null;
      this.box.hidden = true;
      if (at < 0) return;
      if (text.value.trim() !== "") return text.value === before2 ? void 0 : void app2.commit();
      if (before2 === "" && app2.state) void app2.load(app2.state);
      else void app2.arrange(app2.steps.toSpliced(at, 1), at);
    }
  };

  // src/gallery.ts
  var SEARCH_TERMS = {
    shaper: "bottle label neck",
    envelope: "lines in a shape text in a shape badge",
    bend: "text on path words on a line badge seal",
    arc: "text on a circle badge",
    simplify: "smooth clean up fewer nodes traced",
    offset: "outset outline grow bolder thicker inset shrink thinner"
  };
  var TASKS = [
    ["Arch", "warp/arc warp/arch warp/arc-upper warp/arc-lower wordart/arch-up wordart/arch-down wordart/arch-up-pour wordart/arch-down-pour wordart/can-up wordart/can-down wordart/curve-up wordart/curve-down"],
    ["Wave", "warp/flag warp/wave wave wordart/wave1 wordart/wave2 wordart/double-wave1 wordart/wave4 warp/rise"],
    ["Bulge", "warp/bulge warp/inflate warp/fisheye warp/squeeze bulge lens wordart/inflate wordart/deflate wordart/inflate-top wordart/inflate-bottom wordart/deflate-top wordart/deflate-bottom wordart/deflate-inflate wordart/deflate-inflate-deflate"],
    ["Into a shape", "envelope shaper warp/fish warp/shell-lower warp/shell-upper wordart/triangle wordart/triangle-inverted wordart/chevron wordart/chevron-inverted wordart/stop"],
    ["Around", "polar anamorph wordart/circle wordart/circle-pour wordart/button wordart/button-pour wordart/ring-inside wordart/ring-outside"],
    ["Perspective", "projective bilinear affine similitude wordart/fade-up wordart/fade-down wordart/fade-right wordart/fade-left wordart/slant-up wordart/slant-down wordart/cascade-up wordart/cascade-down"],
    ["Along a path", "bend"]
  ];
  var Gallery = class {
    constructor(app2) {
      this.app = app2;
      app2.listen(["state"], () => this.build());
      app2.listen(["steps"], () => this.mark());
      this.search.addEventListener("input", () => this.filter());
      this.search.addEventListener("keydown", (e) => {
        if (e.key === "Enter" && this.search.value.trim() !== "") this.box.querySelector("section:not([hidden]) :is(.card, .preset):not([hidden])")?.click();
      });
    }
    app;
    box = byId("gallery");
    search = byId("search");
    cards = [];
    queue = [];
    isDrawing = false;
    userPresets = h("section", { hidden: true });
    /** The message that nothing was found. */
    none = h("p", { class: "none", role: "status", hidden: true });
    /** The names of the user's presets. */
    names = [];
    /** The drawing in the pictures. */
    drawing = "";
    /** Queues cards that scroll into view. */
    observer = new IntersectionObserver((entries) => {
      for (const entry of entries) {
        const card = this.cards.find((c) => c.button === entry.target);
        if (!entry.isIntersecting || !card) continue;
        this.observer.unobserve(entry.target);
        this.queue.push(card);
        void this.drawQueued();
      }
    }, { rootMargin: "150px" });
    build() {
      if (this.drawing === "") void this.app.request({ do: "presets" }).then((answer) => answer?.presets && this.showPresets(answer.presets));
      const { drawing = "" } = this.app.state ?? {};
      if (drawing === this.drawing || this.app.catalogue.length === 0) return;
      this.drawing = drawing;
      for (const { image } of this.cards) URL.revokeObjectURL(image.src);
      this.cards = [];
      this.queue = [];
      const all = this.app.catalogue.filter((d) => !d.first);
      const edits = this.app.catalogue.filter((d) => d.first);
      const byHand = all.filter((d) => isDragged(d) && !d.gallery).flatMap((d) => [this.shapeCard(d), ...d.variants.map((v) => this.shapeCard(d, v))]);
      const presets = all.filter((d) => d.gallery).flatMap((d) => this.presetCards(d));
      const effects = all.filter((d) => !isDragged(d) && !d.gallery).map((d) => this.shapeCard(d));
      const rest = /* @__PURE__ */ new Set([...byHand, ...presets, ...effects]);
      const tasks = TASKS.map(([title, names]) => {
        const cards = names.split(" ").flatMap((name) => [...rest].filter((c) => [c.deformation, ...Object.values(c.args).flat()].join("/") === name));
        cards.forEach((c) => rest.delete(c));
        return this.section(title, cards);
      });
      const others = (title, cards) => this.section(title, cards.filter((c) => rest.has(c)));
      this.box.replaceChildren(
        this.none,
        this.userPresets,
        ...tasks,
        others("By hand", byHand),
        others("More styles", presets),
        others("Effects", effects),
        this.section("Before bending", edits.map((d) => this.shapeCard(d)))
      );
      this.mark();
      this.filter();
    }
    /** Shows the user's presets. */
    showPresets(names) {
      this.names = names;
      const entry = (name) => {
        const use = button({ class: "preset" }, async () => {
          const answer = await this.app.request({ do: "preset", name });
          if (answer?.steps) await this.app.arrange(answer.steps.map((step2) => ({ ...step2, exclude: this.app.locks })), answer.steps.length - 1);
          document.body.classList.remove("shapes-open");
        }, name);
        const forget = button({ class: "small", "aria-label": `Forget ${name}`, title: `Forget ${name}` }, async () => {
          const answer = await this.app.request({ do: "forget-preset", name });
          if (!answer?.presets) return;
          this.showPresets(answer.presets);
          const others = this.userPresets.querySelectorAll(".small");
          (others[Math.min(names.indexOf(name), others.length - 1)] ?? this.search).focus();
        }, icon("close"));
        return h("li", {}, use, forget);
      };
      this.userPresets.replaceChildren(h("h2", {}, "Your presets"), h("ul", { class: "presets" }, ...names.map(entry)));
      this.filter();
    }
    section(title, cards) {
      const items = h("div", { class: "grid", role: "group", "aria-label": title }, ...cards.map((c) => c.button));
      cards.forEach(({ button: button2 }, i) => button2.tabIndex = i === 0 ? 0 : -1);
      items.addEventListener("keydown", (e) => walk(e, items));
      return h("section", {}, h("h2", {}, title), items);
    }
    card(deformation, args, steps, text, variant = null) {
      const image = h("img", { alt: "", draggable: "false" });
      const cardButton = button({ class: "card" }, () => void this.choose(card), h("span", { class: "thumb" }, image), text);
      const terms = [...this.app.deformation(deformation)?.knownAs ?? [], variant && deformation !== "envelope" ? "" : SEARCH_TERMS[Object.values(args)[0]?.[0] ?? deformation] ?? ""];
      const card = { button: cardButton, image, steps, deformation, args, variant, searchText: [cardButton.textContent, ...terms].join(" ") };
      this.cards.push(card);
      this.observer.observe(cardButton);
      return card;
    }
    async choose({ deformation, args, variant }) {
      const { app: app2 } = this;
      const { step: step2 } = app2;
      const isReplaced = app2.isWorkedOn && !app2.appends && step2?.deformation !== deformation && !app2.isFirst(step2) && !app2.deformation(deformation)?.first;
      const name = (step3) => step3 ? stepName(step3, app2.deformation(step3.deformation)) : "";
      const old = name(step2);
      document.body.classList.remove("shapes-open");
      await app2.choose(deformation, args, variant?.label ?? null);
      if (isReplaced) toast(`${name(app2.step)} replaces ${old}. Undo brings it back, “Add step” keeps both`);
    }
    /** Returns the card of a deformation, or of one of its variants. */
    shapeCard(d, variant = null) {
      const card = this.card(d.name, {}, null, h("span", { class: "name" }, variant?.label ?? (this.isTaken(called(d)) ? `${called(d)} (effect)` : called(d))), variant);
      card.button.title = capital(d.title);
      card.searchText += ` ${called(d)} ${d.name} ${d.title}`;
      return card;
    }
    /** Returns `true` if an earlier shape has this name; the later one then needs a description. */
    isTaken(name) {
      return this.cards.some(({ button: button2 }) => button2.textContent === name);
    }
    presetCards(d) {
      const { presets } = d.gallery;
      const names = d.params.find((p) => p.name === presets)?.words ?? [];
      return names.map((name) => {
        const args = { [presets]: [name] };
        return this.card(d.name, args, [{ deformation: d.name, inverse: false, args }], h("span", { class: "name" }, this.isTaken(words(name)) ? `${words(name)} (${d.gallery.title})` : words(name)));
      });
    }
    /** Draws the visible cards one by one, so that neither dragging nor the picture of the drawing is delayed. */
    async drawQueued() {
      if (this.isDrawing) return;
      this.isDrawing = true;
      for (let card = this.queue.shift(); card; card = this.queue.shift()) {
        while (this.app.isDragging || this.app.connection.isBusy) await new Promise((done) => setTimeout(done, 100));
        const request = { do: "thumbnail", steps: card.steps, example: card.steps ? null : card.deformation, variant: card.variant?.label ?? null };
        try {
          const { svg } = await this.app.connection.ask(request);
          card.image.src = URL.createObjectURL(new Blob([svg ?? ""], { type: "image/svg+xml" }));
        } catch {
          card.button.classList.add("bare");
        }
      }
      this.isDrawing = false;
    }
    /** Marks the shape of the edited step. */
    mark() {
      const { step: step2 } = this.app;
      for (const { button: button2, deformation, args, variant } of this.cards) {
        const variants = this.app.deformation(deformation)?.variants ?? [];
        const isVariant = variant ? step2?.args[variant.param] !== void 0 && variants.find((v) => v.param === variant.param) === variant : !variants.some((v) => step2?.args[v.param]);
        const isChosen = step2?.deformation === deformation && isVariant && Object.entries(args).every(([k, v]) => step2.args[k]?.[0] === v[0]);
        button2.setAttribute("aria-pressed", String(isChosen));
      }
    }
    filter() {
      const plain2 = (text) => text.toLowerCase().replace(/[^\p{L}\p{N}]+/gu, " ").trim();
      const typedWords = plain2(this.search.value).split(" ");
      const fits = (text) => typedWords.every((word) => plain2(text).includes(word));
      for (const { button: button2, searchText } of this.cards) button2.hidden = !fits(searchText);
      const presets = Array.from(this.userPresets.querySelectorAll("li"));
      for (const preset of presets) preset.hidden = !fits(preset.textContent ?? "");
      this.userPresets.hidden = presets.every((preset) => preset.hidden);
      this.none.textContent = `No shape is called “${this.search.value.trim()}”`;
      this.none.hidden = !this.userPresets.hidden || this.cards.some(({ button: button2 }) => !button2.hidden);
      for (const section of Array.from(this.box.children)) {
        if (section === this.userPresets || section === this.none) continue;
        const shown3 = Array.from(section.querySelectorAll(".card")).filter((card) => !card.hidden);
        if (shown3.length > 0 && !shown3.some((card) => card.tabIndex === 0)) shown3[0].tabIndex = 0;
        section.hidden = shown3.length === 0;
      }
    }
  };
  function walk(e, items) {
    const all = Array.from(items.children).filter((card) => !card.hidden);
    const at = all.indexOf(document.activeElement);
    const row = all.filter((card) => card.offsetTop === all[0]?.offsetTop).length;
    const by = { ArrowRight: 1, ArrowLeft: -1, ArrowDown: row, ArrowUp: -row }[e.key];
    const to = e.key === "Home" ? 0 : e.key === "End" ? all.length - 1 : by === void 0 ? -1 : at + by;
    if (at < 0 || !all[to]) return;
    e.preventDefault();
    all[at].tabIndex = -1;
    all[to].tabIndex = 0;
    all[to].focus();
  }
  function isDragged(d) {
    return d.params.some((p) => p.kind === "path" && p.name !== "base" || DRAGGED.has(p.notation ?? ""));
  }

  // src/keys.ts
  var KEYS = [
    ["Ctrl Z", "Undo; while something is dragged, put it back"],
    ["Ctrl Shift Z", "Redo"],
    ["Ctrl S", "Save"],
    ["Ctrl Shift S", "Save under a name or in another format"],
    ["B, held", "Show the original"],
    ["E", "Show the result of all steps behind that of an earlier one"],
    ["+  −  0", "Zoom in, zoom out, fit everything"],
    ["Arrow keys", "Move the selected point by a pixel, with Shift by ten"],
    ["Insert, Delete", "Add a point after the selected one, take it away"],
    ["Shift, dragging", "Keep to the horizontal or vertical; on the ground, select points"],
    ["Alt, dragging", "Do not snap"],
    ["Tab", "Go on to the next point, button or group of shapes"],
    ["Escape", "Give up what was begun"],
    ["?", "Show this list"]
  ];
  function showKeys() {
    const dialog = byId("keys-dialog");
    if (dialog.open) return dialog.close();
    byId("keys-list").replaceChildren(...KEYS.flatMap(([keys, what]) => [h("dt", {}, keys), h("dd", {}, what)]));
    dialog.showModal();
  }

  // src/ground.ts
  var GROUNDS = ["white", "black", "checks"];
  var CHOICE_KEY = "pathwarp-ground";
  var PALE = 235;
  var Ground = class {
    shown = "white";
    /** The drawing for which the sheet was last chosen. */
    drawing = "";
    constructor(app2) {
      this.show(this.chosen);
      app2.listen(["report"], () => this.adapt(app2.state?.drawing ?? ""));
      byId("ground").addEventListener("click", () => {
        this.show(GROUNDS[(GROUNDS.indexOf(this.shown) + 1) % GROUNDS.length]);
        localStorage.setItem(CHOICE_KEY, this.shown);
      });
    }
    get chosen() {
      return GROUNDS.find((name) => name === localStorage.getItem(CHOICE_KEY)) ?? "white";
    }
    show(name) {
      this.shown = name;
      for (const other of GROUNDS) document.body.classList.toggle(`on-${other}`, other === name);
      byId("ground-name").textContent = name === "checks" ? "transparent" : name;
    }
    /** Shows an all-white drawing on black if the user has chosen white. */
    adapt(drawing) {
      const art = Array.from(document.querySelectorAll("#stage .art:not([visibility=hidden]) :is(path, image)"));
      if (drawing === this.drawing || art.length === 0) return;
      this.drawing = drawing;
      this.show(this.chosen === "white" && art.every(isPale) ? "black" : this.chosen);
    }
  };
  function isPale(element) {
    const { fill: fill2, stroke } = getComputedStyle(element);
    const colours = [fill2, stroke].filter((paint) => paint !== "none");
    return element.tagName === "path" && colours.every((paint) => paint.startsWith("rgb(") && paint.match(/\d+/g).every((part) => Number(part) >= PALE));
  }

  // src/modes.ts
  var Modes = class {
    snaps = true;
    /** `true` if dragging the background selects the points in a frame. */
    selects = false;
    /** `true` if a click on the drawing selects a part of it. */
    picksParts = false;
    mirrors = false;
    smooths = true;
    /** The points with which a moving handle can be aligned. */
    snapPoints = [];
    /** Shows the lines to which the handle has snapped, in user units. */
    onSnap = () => {
    };
    /** Returns the other points to add with a point: its reflection, if symmetry is on and that is more than `reach` (user units) away. */
    reflections(handles, at, reach) {
      const other = reflection(handles)(at);
      return this.mirrors && Math.hypot(other[0] - at[0], other[1] - at[1]) > reach ? [other] : [];
    }
    /** Returns a function that drags a line, and its reflection if symmetry is on. */
    puller(handles, { handles: pulled, targets }) {
      const partners = pulled.map((handle) => this.mirrors ? handles.partner(handle) : null);
      const mirrored = reflection(handles);
      return (to) => {
        const wanted = targets(to);
        pulled.forEach((handle, i) => {
          const partner = partners[i] ?? null;
          const at = wanted[i];
          const partnerIndex = partner ? pulled.indexOf(partner) : -1;
          const other = partnerIndex < 0 ? at : mirrored(wanted[partnerIndex]);
          const target = [(at[0] + other[0]) / 2, (at[1] + other[1]) / 2];
          handle.set(target, this.smooths);
          if (partnerIndex < 0) partner?.set(mirrored(target), this.smooths);
        });
      };
    }
    /** Returns a function that moves a handle, and its partner if symmetry is on. */
    mover(handles, handle) {
      const partner = this.mirrors ? handles.partner(handle) : null;
      const mirrored = reflection(handles);
      this.snapPoints = handles.handles.filter((o) => o !== handle && o !== partner && o.shape !== "control").map((o) => [...o.get()]);
      const start = [...handle.get()];
      return (to, e) => {
        const [dx, dy] = [to[0] - start[0], to[1] - start[1]];
        const target = e?.shiftKey ? Math.abs(dx) > Math.abs(dy) ? [to[0], start[1]] : [start[0], to[1]] : to;
        handle.set(target, this.smooths);
        partner?.set(mirrored(target), this.smooths);
      };
    }
    /** Returns the point within `reach` (user units) of `to` that is aligned with the frame or another handle; Alt disables that. */
    snapped(to, handle, handles, reach, e) {
      if (!this.snaps || e.altKey || handle.shape === "control") {
        this.onSnap(null, null);
        return to;
      }
      const [x, y, w, h2] = handles.frame;
      const xs = [x, x + w / 2, x + w, ...this.snapPoints.map((p) => p[0])];
      const ys = [y, y + h2 / 2, y + h2, ...this.snapPoints.map((p) => p[1])];
      const [nx, ny] = [nearest2(to[0], xs, reach), nearest2(to[1], ys, reach)];
      this.onSnap(nx, ny);
      return [nx ?? to[0], ny ?? to[1]];
    }
    clear() {
      this.onSnap(null, null);
    }
  };
  function reflection({ frame: [left, , width] }) {
    return ([x, y]) => [2 * left + width - x, y];
  }
  function nearest2(value, among, reach) {
    let best = null;
    for (const candidate of among) {
      const distance2 = Math.abs(candidate - value);
      if (distance2 <= reach && (best === null || distance2 < Math.abs(best - value))) best = candidate;
    }
    return best;
  }
  function snapLines(toScreen) {
    const layer = byId("stage");
    const vertical = s("line", { class: "snap", y1: -1e4, y2: 1e4, visibility: "hidden" });
    const horizontal = s("line", { class: "snap", x1: -1e4, x2: 1e4, visibility: "hidden" });
    layer.append(vertical, horizontal);
    return (x, y) => {
      vertical.setAttribute("visibility", x === null ? "hidden" : "visible");
      horizontal.setAttribute("visibility", y === null ? "hidden" : "visible");
      const [sx, sy] = toScreen([x ?? 0, y ?? 0]);
      for (const end2 of ["x1", "x2"]) vertical.setAttribute(end2, String(sx));
      for (const end2 of ["y1", "y2"]) horizontal.setAttribute(end2, String(sy));
    };
  }

  // src/parts.ts
  var ELEMENTS2 = { g: "group", a: "link", svg: "drawing", use: "copy", image: "picture", rect: "rectangle" };
  var Parts = class {
    constructor(app2, stage2, modes2) {
      this.app = app2;
      this.stage = stage2;
      this.modes = modes2;
      app2.listen(["state"], () => void this.load());
      app2.listen(["steps"], () => this.show());
      byId("parts-all").addEventListener("click", () => void app2.scope([]));
      stage2.onPart = (name, adds) => this.clicked(name, adds);
    }
    app;
    stage;
    modes;
    list = byId("parts");
    details = byId("parts-list");
    scope = byId("parts-scope");
    all = [];
    rows = [];
    /** The names of parts hidden on the page; the file contains them regardless. */
    hidden = /* @__PURE__ */ new Set();
    /** The drawing and its captions, as JSON, whose parts are listed. */
    listed = "";
    file = "";
    async load() {
      const { drawing = "", file = "", steps = [] } = this.app.state ?? {};
      const listed = JSON.stringify([drawing, ...steps.filter(isCaption)]);
      if (listed === this.listed) return;
      this.listed = listed;
      if (file !== this.file) this.hidden.clear();
      this.file = file;
      this.all = (await this.app.request({ do: "parts" }))?.parts ?? [];
      this.stage.parts = new Set(this.all.map(({ name }) => name));
      this.rows = this.all.map((part) => this.row(part));
      this.list.replaceChildren(...this.rows);
      this.hideOnCanvas();
      this.show();
    }
    row(part) {
      const title = part.label ?? part.name.replace(/^([a-z]+)(.*) at \d+:\d+$/i, (_, tag, letter) => capital((ELEMENTS2[tag] ?? tag) + letter));
      const choose = button({ class: "part-name", title: part.name }, (e) => this.toggle(part, e.shiftKey || e.ctrlKey || e.metaKey), title);
      choose.addEventListener("pointerenter", () => this.stage.outlineParts([part, ...this.contentsOf(part)].map(({ name }) => name)));
      choose.addEventListener("pointerleave", () => this.show());
      const iconButton = (kind, label, click) => button({ class: `small ${kind}`, "aria-label": `${label} ${title}`, title: `${label} ${title}` }, click, icon(kind));
      const row = h(
        "li",
        {},
        choose,
        iconButton("eye", "Hide here:", () => this.hide(part)),
        iconButton("lock", "Lock:", () => void this.lock(part))
      );
      row.style.setProperty("--depth", String(Math.min(part.depth, 8)));
      return row;
    }
    /** Returns the contents of a group, which follow it in the list. */
    contentsOf(part) {
      const after = this.all.slice(this.all.indexOf(part) + 1);
      const end2 = after.findIndex(({ depth }) => depth <= part.depth);
      return end2 < 0 ? after : after.slice(0, end2);
    }
    clicked(name, adds) {
      const part = this.all.find((p) => p.name === name);
      if (part) this.toggle(part, adds);
      else if (!adds) void this.app.scope([]);
    }
    /** Returns `true` if a part is locked or hidden, or belongs to a group that is. */
    isOut(part) {
      const isOut = ({ name, selector }) => this.hidden.has(name) || this.app.locks.includes(selector);
      return this.all.some((p) => isOut(p) && (p === part || this.contentsOf(p).includes(part)));
    }
    /** Selects a part alone, or adds it to the selection, or removes it. */
    toggle(part, adds) {
      const { selectors: chosen } = this.app;
      const { selector } = part;
      const others = chosen.filter((s2) => s2 !== selector);
      const isChosen = others.length < chosen.length;
      if (!isChosen && this.isOut(part)) return;
      if (!adds) void this.app.scope(isChosen && others.length === 0 ? [] : [selector]);
      else void this.app.scope(isChosen ? others : [...others, selector]);
    }
    hide(part) {
      if (!this.hidden.delete(part.name)) this.hidden.add(part.name);
      this.show();
      this.hideOnCanvas();
    }
    /** Locks or unlocks a part. No step bends locked parts. */
    lock({ selector }) {
      const { locks } = this.app;
      return this.app.lock(locks.includes(selector) ? locks.filter((s2) => s2 !== selector) : [...locks, selector]);
    }
    show() {
      const { selectors: chosen, locks } = this.app;
      const hides = this.all.length < 2 || this.app.isFirst(this.app.step);
      byId("parts-box").hidden = hides;
      if (hides && this.modes.picksParts) byId("pick-parts").click();
      this.all.forEach((part, i) => {
        const pressed = [chosen.includes(part.selector), this.hidden.has(part.name), locks.includes(part.selector)];
        pressed.forEach((on2, k) => this.rows[i]?.children[k]?.setAttribute("aria-pressed", String(on2)));
      });
      const count = chosen.length;
      this.scope.textContent = count === 0 ? "This step bends everything." : `This step bends ${count === 1 ? "one part" : `${count} parts`}.`;
      byId("parts-all").hidden = count === 0;
      if (count > 0 || locks.length > 0) this.details.open = true;
      const selected = this.all.filter(({ selector }) => chosen.includes(selector));
      this.stage.outlineParts(this.modes.picksParts || this.details.open ? selected.flatMap((p) => [p, ...this.contentsOf(p)]).map(({ name }) => name) : []);
    }
    /** Hides the hidden parts on the canvas. */
    hideOnCanvas() {
      const hidden = new Set(this.all.filter(({ name }) => this.hidden.has(name)).flatMap((p) => [p, ...this.contentsOf(p)]).map(({ name }) => name));
      this.stage.hideParts(hidden);
    }
  };

  // src/place.ts
  var DECIMALS = 3;
  var Place = class {
    box = byId("place");
    inputs = [byId("place-x"), byId("place-y")];
    fields;
    remove = byId("remove-point");
    handle = null;
    constructor(app2, stage2) {
      stage2.onFocus = (handle) => this.show(handle);
      stage2.onKeys = (handle) => this.say(handle);
      this.fields = this.inputs.map((input, i) => {
        const coordinate = (typed) => {
          const q = evaluate(typed, "");
          const [x, y, w, h2] = app2.handles?.frame ?? [0, 0, 1, 1];
          if (!q || q.unit === "") return q?.value ?? null;
          if (q.unit === "%") return i === 0 ? x + w * q.value / 100 : y + h2 * q.value / 100;
          const [a, b] = app2.state?.toPx ?? [1, 0];
          const px = inUnits(typed, "px");
          return px === null ? null : px / Math.hypot(a, b);
        };
        const move = (value) => {
          const at = this.handle.get();
          stage2.moveTo(this.handle, i === 0 ? [value, at[1]] : [at[0], value]);
        };
        const read = () => this.handle ? shown2(this.handle)[i] : "";
        const isWrong = (typed) => coordinate(typed) === null ? `${describeLimits("")} or 50 %` : null;
        const take = (typed) => {
          if (this.handle && typed !== read()) move(coordinate(typed));
          return null;
        };
        const nudge = (typed, by) => {
          const value = coordinate(typed);
          if (value === null || !this.handle) return null;
          move(value + by);
          return read();
        };
        const field = new Field(input, read, take, isWrong, nudge);
        input.parentElement.after(field.message);
        return field;
      });
      this.remove.addEventListener("click", () => {
        if (this.handle) stage2.remove(this.handle);
      });
      app2.listen(["handles"], () => this.show(stage2.focusedHandle));
    }
    show(handle) {
      this.handle = handle;
      this.box.classList.toggle("off", handle === null);
      if (!handle) return;
      byId("place-name").textContent = handle.label;
      this.remove.hidden = !handle.remove;
      for (const field of this.fields) field.refresh();
    }
    /** Tells screen readers the position to which keys have moved a handle. */
    say(handle) {
      byId("spoken").textContent = `${handle.label}: ${shown2(handle).join(", ")}`;
    }
  };
  function shown2(handle) {
    return handle.get().map((v) => short(Number(v.toFixed(DECIMALS))));
  }

  // src/camera.ts
  var ZOOM_RANGE = [0.01, 64];
  var FIT_RANGE = [1e-4, 1e5];
  var Camera = class {
    /** The scale in screen = scale · px + shift. */
    scale = 1;
    shift = [0, 0];
    /** The map from user units to px of the drawing. */
    toPx = [1, 0, 0, 1, 0, 0];
    /** Converts a point from user units to px of the drawing. */
    inPx([x, y]) {
      const [a, b, c, d, e, f] = this.toPx;
      return [a * x + c * y + e, b * x + d * y + f];
    }
    toScreen(p) {
      const [x, y] = this.inPx(p);
      return [this.scale * x + this.shift[0], this.scale * y + this.shift[1]];
    }
    toUser([x, y]) {
      const [a, b, c, d, e, f] = this.toPx;
      const [px, py] = [(x - this.shift[0]) / this.scale - e, (y - this.shift[1]) / this.scale - f];
      const det = a * d - b * c;
      return [(d * px - c * py) / det, (a * py - b * px) / det];
    }
    /** The length of a px of the screen, in user units. */
    get pixel() {
      const [a, b, c, d] = this.toPx;
      return 1 / (this.scale * Math.sqrt(Math.abs(a * d - b * c)));
    }
    /** The transform of the drawing, whose unit is px. */
    get transform() {
      return `matrix(${this.scale} 0 0 ${this.scale} ${this.shift[0]} ${this.shift[1]})`;
    }
    /** Magnifies by a factor around a point of the screen. */
    zoom(factor2, [x, y]) {
      const scale2 = Math.min(Math.max(this.scale * factor2, Math.min(ZOOM_RANGE[0], this.scale)), Math.max(ZOOM_RANGE[1], this.scale));
      const by = scale2 / this.scale;
      this.shift = [x - by * (x - this.shift[0]), y - by * (y - this.shift[1])];
      this.scale = scale2;
    }
    /** Centres a box of the drawing, two corners in px, in a view of this size. */
    fit([x0, y0, x1, y1], [width, height]) {
      const scale2 = Math.min(width / Math.max(x1 - x0, 1e-9), height / Math.max(y1 - y0, 1e-9));
      this.scale = Math.min(Math.max(scale2, FIT_RANGE[0]), FIT_RANGE[1]);
      this.shift = [(width - this.scale * (x0 + x1)) / 2, (height - this.scale * (y0 + y1)) / 2];
    }
  };

  // src/heat.ts
  function cells({ columns, points, factors }, toPx) {
    const byColour = /* @__PURE__ */ new Map();
    factors.forEach((factor2, k) => {
      const [i, j] = [k % columns, Math.floor(k / columns)];
      const at = (di, dj) => points[(j + dj) * (columns + 1) + i + di];
      const corners2 = [at(0, 0), at(1, 0), at(1, 1), at(0, 1)];
      if (factor2 === null || corners2.some((c) => !c)) return;
      const d = corners2.map((c) => toPx(c).map((v) => v.toFixed(2)).join(",")).join("L");
      const colour = shade(factor2);
      byColour.set(colour, [...byColour.get(colour) ?? [], `M${d}Z`]);
    });
    return Array.from(byColour, ([colour, d]) => {
      const [fill2, opacity] = colour.split("/");
      return s("path", { d: d.join(""), fill: fill2, "fill-opacity": opacity });
    });
  }
  var FULL_OPACITY = 0.8;
  var STEPS = 16;
  function shade(factor2) {
    if (factor2 < 0) return "#e11d2e/0.85";
    const amount = Math.max(-1, Math.min(1, Math.log2(Math.max(factor2, 1e-6))));
    const step2 = Math.round(amount * STEPS) / STEPS;
    return `${step2 < 0 ? "#2563eb" : "#ea7706"}/${(FULL_OPACITY * Math.abs(step2)).toFixed(3)}`;
  }

  // src/selection.ts
  var BOX_MARGIN = 16;
  var ABOVE3 = 26;
  var EDGE = 6;
  var Selection = class {
    keys = /* @__PURE__ */ new Set();
    layer = s("g", { class: "selection", visibility: "hidden" });
    frame = s("path", { class: "line arm" });
    parts = /* @__PURE__ */ new Map();
    /** Two corners, in px of the screen. */
    box = [[0, 0], [0, 0]];
    constructor() {
      this.layer.append(this.frame);
      for (const part of ["nw", "ne", "se", "sw", "turn"]) {
        const body = part === "turn" ? s("circle", { r: 6, class: "body" }) : s("rect", { x: -5, y: -5, width: 10, height: 10, class: "body" });
        const label = part === "turn" ? "Turn the selected points" : "Scale the selected points";
        const knob = s("g", { class: `part ${part}`, "data-part": part }, s("title", {}, label), s("circle", { r: 16, class: "reach" }), body);
        this.parts.set(part, knob);
        this.layer.append(knob);
      }
    }
    /** `true` if more than one point is selected. */
    get isMany() {
      return this.keys.size > 1;
    }
    /** Selects only these points. */
    take(keys) {
      this.keys = new Set(keys);
      byId("spoken").textContent = keys.length > 1 ? `${keys.length} points are selected` : "";
    }
    /** Adds a point to the selection, or removes it. */
    toggle(key) {
      if (!this.keys.delete(key)) this.keys.add(key);
      this.take(Array.from(this.keys));
    }
    /** Returns the selected handles. */
    selectedOf(handles) {
      return handles.handles.filter(({ key }) => this.keys.has(key));
    }
    /** Fits the box around the selected points. */
    place(handles, toScreen) {
      const points = handles ? this.selectedOf(handles).map((h2) => toScreen(h2.get())) : [];
      this.layer.setAttribute("visibility", points.length > 1 ? "visible" : "hidden");
      if (points.length < 2) return;
      const [xs, ys] = [points.map((p) => p[0]), points.map((p) => p[1])];
      const [x0, y0, x1, y1] = [Math.min(...xs) - BOX_MARGIN, Math.min(...ys) - BOX_MARGIN, Math.max(...xs) + BOX_MARGIN, Math.max(...ys) + BOX_MARGIN];
      this.box = [[x0, y0], [x1, y1]];
      const middle2 = (x0 + x1) / 2;
      this.frame.setAttribute("d", `M${x0},${y0}H${x1}V${y1}H${x0}ZM${middle2},${y0}V${y0 - ABOVE3}`);
      const positions = { nw: [x0, y0], ne: [x1, y0], se: [x1, y1], sw: [x0, y1], turn: [middle2, y0 - ABOVE3] };
      for (const [part, knob] of this.parts) knob.setAttribute("transform", `translate(${positions[part].join(" ")})`);
    }
    /** Returns `true` for a point in the box or on its edge. */
    holds([x, y]) {
      const [[x0, y0], [x1, y1]] = this.box;
      return this.isMany && x > x0 - EDGE && x < x1 + EDGE && y > y0 - EDGE && y < y1 + EDGE;
    }
    /** Returns the map of the points when a part of the box is dragged: a rotation about its centre, or a scaling about a corner. */
    transform(part, from) {
      const [[x0, y0], [x1, y1]] = this.box;
      const about = part === "turn" ? [(x0 + x1) / 2, (y0 + y1) / 2] : [part.endsWith("w") ? x1 : x0, part.startsWith("n") ? y1 : y0];
      const [ax, ay] = [from[0] - about[0], from[1] - about[1]];
      const square = ax * ax + ay * ay || 1;
      return (to) => {
        const [bx, by] = [to[0] - about[0], to[1] - about[1]];
        const [dot, cross] = [(ax * bx + ay * by) / square, (ax * by - ay * bx) / square];
        const size = Math.hypot(dot, cross) || 1;
        const [re, im] = part === "turn" ? [dot / size, cross / size] : [dot, 0];
        return ([x, y]) => [about[0] + re * (x - about[0]) - im * (y - about[1]), about[1] + im * (x - about[0]) + re * (y - about[1])];
      };
    }
  };
  function groupMover(handles, chosen, modes2) {
    const keys = new Set(chosen.map(({ key }) => key));
    const arms = handles.handles.filter(({ key }) => !keys.has(key) && /\/(in|out)$/.test(key) && keys.has(key.replace(/\/(in|out)$/, "")));
    const all = [...chosen.filter((h2) => h2.shape !== "control"), ...chosen.filter((h2) => h2.shape === "control"), ...arms];
    const starts = all.map((h2) => [...h2.get()]);
    const partners = all.map((h2) => modes2.mirrors ? handles.partner(h2) : null).map((p) => p && !all.includes(p) ? p : null);
    const mirrored = reflection(handles);
    return (image) => {
      const [ends, smooth] = [starts.map(image), false];
      all.forEach((h2, i) => h2.set(ends[i], smooth));
      partners.forEach((p, i) => p?.set(mirrored(ends[i]), smooth));
      return new Set(all.map(({ param }) => param));
    };
  }

  // src/nodes.ts
  var MOST = 4e6;
  function nodesOf(paths) {
    const [nodes, arms] = [[], []];
    let length2 = 0;
    for (const path of paths) {
      const d = path.getAttribute("d") ?? "";
      length2 += d.length;
      if (length2 > MOST) break;
      const toDrawing = drawingMap(path);
      const text = (p) => toDrawing(p).map((v) => v.toFixed(2)).join(",");
      for (const { from, to, control } of anchors(d)) {
        nodes.push(`M${text(to)}h0`);
        const [first, last] = [control[0], control[control.length - 1]];
        if (first && last) arms.push(`M${text(from)}L${text(first)}M${text(to)}L${text(last)}`);
      }
    }
    return { nodes: nodes.join(""), arms: arms.join("") };
  }
  function drawingMap(path) {
    let matrix = new DOMMatrix();
    for (let e = path; e && !e.classList.contains("art"); e = e.parentElement) {
      const m = e.transform?.baseVal.consolidate()?.matrix;
      if (m) matrix = new DOMMatrix([m.a, m.b, m.c, m.d, m.e, m.f]).multiply(matrix);
    }
    return ([x, y]) => [matrix.a * x + matrix.c * y + matrix.e, matrix.b * x + matrix.d * y + matrix.f];
  }
  var COMMANDS = { M: 2, L: 2, H: 1, V: 1, C: 6, S: 4, Q: 4, T: 2, A: 7, Z: 0 };
  var WORD = /[a-zA-Z]|[-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?/g;
  function anchors(d) {
    const out = [];
    let mirrored = null;
    const words2 = d.match(WORD) ?? [];
    let command = "";
    let [at, start] = [[0, 0], [0, 0]];
    for (let i = 0; i < words2.length; ) {
      if (/[a-zA-Z]/.test(words2[i])) command = words2[i++];
      const kind = command.toUpperCase();
      const count = COMMANDS[kind];
      if (count === void 0 || i + count > words2.length) break;
      const from = at;
      if (kind === "Z") {
        [at, mirrored] = [start, null];
        continue;
      }
      const [x0, y0] = command === kind ? [0, 0] : at;
      const last = Number(words2[i + count - 1]);
      if (kind === "H") at = [x0 + last, at[1]];
      else if (kind === "V") at = [at[0], y0 + last];
      else at = [x0 + Number(words2[i + count - 2]), y0 + last];
      const control = [];
      if (kind !== "A") {
        for (let k = i; k + 3 < i + count; k += 2) control.push([x0 + Number(words2[k]), y0 + Number(words2[k + 1])]);
      }
      if (kind === "S" || kind === "T") {
        const [mx, my] = mirrored ?? from;
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

  // src/stage.ts
  var MARGIN = 56;
  var NARROW_MARGIN = 20;
  var TOOLS_GAP = 28;
  var REACH = 18;
  var PICK_REACH = 8;
  var GREETED_KEY = "pathwarp-greeted";
  var END_TOLERANCE = 1;
  var END_TIME_LIMIT = 60;
  var Stage = class {
    constructor(app2, modes2) {
      this.app = app2;
      this.modes = modes2;
      this.svg.append(
        s("defs", {}, this.checks),
        ...this.shadows,
        this.sheet,
        this.behind,
        this.aheadArt,
        this.beforeArt,
        this.art,
        this.heat,
        this.arms,
        this.nodes,
        this.shield,
        this.highlight,
        this.partOutlines,
        this.overlay,
        this.guides,
        this.foldMarks,
        this.selection.layer,
        this.knobs,
        this.value,
        this.marquee
      );
      const stage2 = this;
      app2.screen = {
        show: (answer) => this.showAnswer(answer),
        reveal: () => this.reveal(),
        get pixel() {
          return stage2.camera.pixel;
        }
      };
      app2.listen(["state"], () => this.takeState());
      app2.listen(["handles"], () => this.rebuild());
      app2.listen(["report"], () => this.showsStretch && void this.drawStretch());
      app2.listen(["report", "steps"], () => void this.drawFinalResult());
      this.svg.addEventListener("dblclick", (e) => this.doubleClick(e));
      this.svg.addEventListener("keydown", (e) => this.key(e));
      this.svg.addEventListener("keyup", (e) => {
        if (e.key === "Tab" && this.focusedHandle) this.panTo(this.focusedHandle);
      });
      this.svg.addEventListener("pointermove", (e) => {
        if (this.onPick) this.outlinePath(this.pathAt(e, this.pickSelector));
        else if (this.modes.picksParts) this.outlinePath(this.pathAt(e, ".art *"));
      });
      new ResizeObserver(() => this.isFitted || this.awaitsPicture ? this.fit() : this.layout()).observe(this.svg);
    }
    app;
    modes;
    camera = new Camera();
    svg = byId("stage");
    /** The shadow consists of lines, because a filter would be redrawn with every picture. */
    shadows = [s("rect", { class: "shadow wide" }), s("rect", { class: "shadow" })];
    sheet = s("rect", { class: "sheet" });
    /** The pattern of a transparent sheet: squares whose size does not depend on the magnification. */
    checks = s("pattern", { id: "checks", width: 16, height: 16, patternUnits: "userSpaceOnUse" }, s("rect", { class: "checks-light", width: 16, height: 16 }), s("path", { class: "checks-dark", d: "M0 0h8v8H0zM8 8h8v8H8z" }));
    /** The layer behind the drawing. */
    behind = s("g", {});
    art = s("g", { class: "art" });
    beforeArt = s("g", { class: "art", visibility: "hidden" });
    /** The result of all steps, behind the picture of fewer steps. */
    aheadArt = s("g", { class: "ahead" });
    heat = s("g", { class: "heat" });
    /** Nodes of the picture's paths, and the lines to their control points. */
    nodes = s("path", { class: "nodes" });
    arms = s("path", { class: "arms" });
    /** Receives pointer events, so that the browser need not search the shapes of a large drawing. */
    shield = s("rect", { class: "shield", width: "100%", height: "100%" });
    selection = new Selection();
    /** The frame that selects points. */
    marquee = s("rect", { class: "marquee", visibility: "hidden" });
    /** Outline of the path under the pointer. */
    highlight = s("path", { class: "lit" });
    /** Outlines of the parts that are selected, or pointed at in the list. */
    partOutlines = s("g", { class: "chosen-parts" });
    outlinedParts = [];
    hiddenParts = /* @__PURE__ */ new Set();
    /** The layer for lines that are being drawn. */
    overlay = s("g", {});
    guides = s("g", { class: "guides" });
    foldMarks = s("g", { class: "marks" });
    knobs = s("g", { class: "knobs" });
    /** The value of the dragged handle. */
    value = s("text", { class: "value-of-drag" });
    drawing = new Drawing(this.art);
    /** The knobs of handles, by their keys. */
    knobOf = /* @__PURE__ */ new Map();
    lines = [];
    /** Wide, invisible lines over draggable ones, by index. */
    hitLines = [];
    focusedKey = null;
    /** `true` while the view shows the whole page, unmoved by the user. */
    isFitted = false;
    /** `true` until the first picture of a drawing arrives; drafts, whose answers have no summary, do not count. */
    awaitsPicture = true;
    drawingName = "";
    /** `true` from the first picture of a drawing until its handles arrive. */
    awaitsHandles = false;
    /** The page of the last picture when saved; null for the drawing's page. */
    savedPage = null;
    /** `true` while the page shows the drawing without steps. */
    isBefore = false;
    showsNodes = false;
    showsStretch = false;
    showsFinalResult = false;
    /** The deformation whose handles are highlighted. */
    greeted = "";
    /** The time that the last faint result took, in ms. */
    endTime = 0;
    /** If set, receives the next clicked path that `pickSelector` matches, and the clicked point; other reactions are disabled. */
    onPick = null;
    pickSelector = "";
    /** Removes the message that asks for a path. */
    hideRequest = () => {
    };
    /** Returns further points that Fit shows, in px of the drawing. */
    around = () => [];
    /** The names of the drawing's parts. */
    parts = /* @__PURE__ */ new Set();
    /** Called when a part is clicked; the name is null elsewhere. */
    onPart = () => {
    };
    onFocus = () => {
    };
    /** Called when keys have moved a handle. */
    onKeys = () => {
    };
    onLayout = [];
    /** The part of the canvas that neither panels of a narrow window nor hints and tools cover. */
    get view() {
      const { clientWidth: width, clientHeight: height } = this.svg;
      const panel = document.querySelector("body.shapes-open nav, body.settings-open aside");
      if (!panel || getComputedStyle(panel).position === "static") {
        const [side, hint, tools] = [Math.min(MARGIN, width / 10), byId("note").offsetHeight, byId("tools").offsetHeight];
        return [side, Math.max(MARGIN, hint + TOOLS_GAP), width - side, Math.max(height - Math.max(MARGIN, tools + TOOLS_GAP), height / 2)];
      }
      const { left, width: covered } = panel.getBoundingClientRect();
      if (covered >= width) return [NARROW_MARGIN, NARROW_MARGIN, width - NARROW_MARGIN, Math.max(height - panel.clientHeight, height / 4) - NARROW_MARGIN];
      return [(left > 0 ? 0 : covered) + NARROW_MARGIN, NARROW_MARGIN, (left > 0 ? width - covered : width) - NARROW_MARGIN, height - NARROW_MARGIN];
    }
    /** Shows the whole page and all handles. */
    fit() {
      const [x0, y0, x1, y1] = this.view;
      if (!this.app.state || x1 <= x0 || y1 <= y0) return;
      const handles = (this.app.handles?.handles ?? []).map((h2) => this.camera.inPx(h2.get())).filter((p) => p.every(Number.isFinite));
      const [left, top, right, bottom] = this.pageBox;
      const points = [[left, top], [right, bottom], ...handles, ...this.around()];
      const [xs, ys] = [points.map((p) => p[0]), points.map((p) => p[1])];
      this.camera.fit([Math.min(...xs), Math.min(...ys), Math.max(...xs), Math.max(...ys)], [x1 - x0, y1 - y0]);
      const [x, y] = this.camera.shift;
      this.camera.shift = [x + x0, y + y0];
      this.isFitted = true;
      this.layout();
    }
    /** Moves the view as little as necessary to show a handle. */
    panTo(handle) {
      const [x0, y0, x1, y1] = this.view;
      const [x, y] = this.camera.toScreen(handle.get());
      const by = [Math.max(x0 - x, 0) + Math.min(x1 - x, 0), Math.max(y0 - y, 0) + Math.min(y1 - y, 0)];
      if (by[0] !== 0 || by[1] !== 0) this.shift(by);
    }
    /** Moves the view by px of the screen. */
    shift([dx, dy]) {
      const [x, y] = this.camera.shift;
      this.camera.shift = [x + dx, y + dy];
      this.isFitted = false;
      this.layout();
    }
    /** Shows the whole page and all handles, unless the user has moved the view. */
    reveal() {
      if (this.isFitted) this.fit();
    }
    /** Magnifies about a point of the screen, or about the centre of the view. */
    zoom(factor2, at) {
      const [x0, y0, x1, y1] = this.view;
      this.camera.zoom(factor2, at ?? [(x0 + x1) / 2, (y0 + y1) / 2]);
      this.isFitted = false;
      this.layout();
    }
    takeState() {
      const { state } = this.app;
      if (!state) return;
      if (state.drawing !== this.drawingName) {
        this.beforeArt.replaceChildren();
        this.awaitsPicture = true;
        this.savedPage = null;
      }
      this.drawingName = state.drawing;
      const isNew = this.camera.toPx.some((v, i) => v !== state.toPx[i]);
      this.camera.toPx = state.toPx;
      if (isNew || this.awaitsPicture) {
        this.awaitsPicture = true;
        this.fit();
      }
      this.resizeSheet();
    }
    showAnswer(answer) {
      if (answer.picture) {
        this.drawing.show(answer.picture);
        if ("whole" in answer.picture && this.hiddenParts.size > 0) this.hideParts(this.hiddenParts);
        this.savedPage = answer.page;
        this.resizeSheet();
      }
      if (answer.summary && this.awaitsPicture) {
        this.awaitsPicture = false;
        this.awaitsHandles = this.isFitted;
      }
      if (this.showsNodes) this.drawNodes();
      if (this.outlinedParts.length > 0) this.outlineParts(this.outlinedParts);
      this.foldMarks.replaceChildren(...(answer.summary?.folds ?? []).map(([, at]) => this.foldMark(at)));
    }
    /** The page when saved, in px of the drawing. */
    get pageBox() {
      const { state } = this.app;
      if (!state) return [0, 0, 0, 0];
      const [x, y, w, h2] = this.savedPage ?? state.page;
      const [[ax, ay], [bx, by]] = [this.camera.inPx([x, y]), this.camera.inPx([x + w, y + h2])];
      return [Math.min(ax, bx), Math.min(ay, by), Math.max(ax, bx), Math.max(ay, by)];
    }
    /** Resizes the sheet to the page. */
    resizeSheet() {
      const [x0, y0, x1, y1] = this.pageBox;
      for (const sheet of [...this.shadows, this.sheet]) {
        sheet.setAttribute("x", String(x0));
        sheet.setAttribute("y", String(y0));
        sheet.setAttribute("width", String(x1 - x0));
        sheet.setAttribute("height", String(y1 - y0));
      }
    }
    foldMark(at) {
      const [x, y] = this.camera.toScreen(at);
      const mark = s("g", { class: "fold", transform: `translate(${x} ${y})` }, s("circle", { r: 9 }), s("circle", { r: 2.5 }));
      mark.dataset.at = JSON.stringify(at);
      return mark;
    }
    /** Shows the drawing without steps, or with them. */
    async showBefore(on2) {
      if (on2 === this.isBefore) return;
      this.isBefore = on2;
      if (on2 && this.beforeArt.childElementCount === 0) {
        const answer = await this.app.request({ do: "before" });
        this.beforeArt.replaceChildren(...Array.from(parseWithPrefix(answer?.svg, "before")?.children ?? []));
      }
      this.svg.classList.toggle("before", this.isBefore);
      this.art.setAttribute("visibility", this.isBefore ? "hidden" : "visible");
      this.beforeArt.setAttribute("visibility", this.isBefore ? "visible" : "hidden");
    }
    drawNodes() {
      const { nodes, arms } = this.showsNodes ? nodesOf(this.drawing.paths()) : { nodes: "", arms: "" };
      this.nodes.setAttribute("d", nodes);
      this.arms.setAttribute("d", arms);
    }
    /** Shows or hides the stretch of the visible steps. */
    drawStretch = latest(async () => {
      const answer = this.showsStretch ? await this.app.request({ do: "stretch", steps: this.app.visible }) : null;
      const stretch = this.showsStretch ? answer?.stretch : null;
      this.heat.replaceChildren(...stretch ? cells(stretch, (p) => this.camera.inPx(p)) : []);
    });
    /** Shows or hides the result of all steps behind the picture of fewer steps. */
    drawFinalResult = latest(async () => {
      const { app: app2 } = this;
      const isEarlier = () => this.showsFinalResult && app2.selected < app2.steps.length - 1;
      const draft = app2.isDragging ? END_TOLERANCE * this.camera.pixel : null;
      if (draft !== null && this.endTime > END_TIME_LIMIT) return;
      const start = performance.now();
      const answer = isEarlier() ? await app2.connection.ask({ do: "ahead", steps: app2.steps, draft }).catch(() => null) : null;
      if (answer) this.endTime = performance.now() - start;
      this.aheadArt.replaceChildren(...Array.from(parseWithPrefix(isEarlier() ? answer?.svg : void 0, "ahead")?.children ?? []));
    });
    /** Positions everything on the screen. */
    layout() {
      const { camera } = this;
      const layers = [...this.shadows, this.sheet, this.behind, this.aheadArt, this.art, this.beforeArt, this.nodes, this.arms, this.heat];
      for (const layer of layers) layer.setAttribute("transform", camera.transform);
      this.checks.setAttribute("patternTransform", `scale(${1 / camera.scale})`);
      for (const mark of Array.from(this.foldMarks.children)) {
        const [x, y] = camera.toScreen(JSON.parse(mark.dataset.at));
        mark.setAttribute("transform", `translate(${x} ${y})`);
      }
      this.placeHandles();
      if (this.outlinedParts.length > 0) this.outlineParts(this.outlinedParts);
      for (const follow of this.onLayout) follow();
    }
    /** Positions handles and their lines. */
    placeHandles() {
      const { handles } = this.app;
      if (!handles) return;
      const screenPoint = (p) => this.camera.toScreen(p).map((v) => v.toFixed(2)).join(",");
      handles.lines().forEach((line, i) => {
        const element = this.lines[i];
        if (!element) return;
        const [first, ...rest] = line.points.map(screenPoint);
        const d = `M${first}${line.cubic ? "C" : "L"}${rest.join(" ")}${line.closed ? "Z" : ""}`;
        element.setAttribute("d", d);
        this.hitLines[i]?.setAttribute("d", d);
      });
      for (const handle of handles.handles) {
        const [x, y] = this.camera.toScreen(handle.get());
        this.knobOf.get(handle.key)?.setAttribute("transform", `translate(${x.toFixed(2)} ${y.toFixed(2)})`);
      }
      this.selection.place(this.app.isDragging && this.app.cancelGesture ? null : handles, (p) => this.camera.toScreen(p));
    }
    /** `true` if dragging the background selects points, of which there must be several. */
    get isSelecting() {
      return this.modes.selects && (this.app.handles?.handles.length ?? 0) > 1;
    }
    rebuild() {
      const { handles } = this.app;
      this.svg.classList.toggle("selecting", this.isSelecting);
      this.knobOf.clear();
      const lines = handles?.lines() ?? [];
      this.lines = lines.map((line) => s("path", { class: `line ${line.kind}` }));
      this.hitLines = lines.map((line) => line.kind === "arm" ? null : s("path", { class: "pull" }));
      const knobs = (handles?.handles ?? []).map((handle) => {
        const body = handle.shape === "control" ? s("rect", { x: -4, y: -4, width: 8, height: 8, rx: 1.5, class: "body" }) : s("circle", { r: handle.shape === "source" ? 5 : 6.5, class: "body" });
        const knob = s(
          "g",
          { class: `knob ${handle.shape}`, tabindex: 0, role: "button", "aria-label": handle.label, "data-key": handle.key },
          s("circle", { r: handle.shape === "node" ? REACH : REACH - 5, class: "reach" }),
          body
        );
        knob.addEventListener("focus", () => {
          if (!this.selection.keys.has(handle.key)) this.selection.take([handle.key]);
          this.focus(handle.key);
        });
        this.knobOf.set(handle.key, knob);
        return knob;
      });
      this.guides.replaceChildren(...this.lines, ...this.hitLines.filter((r) => r !== null));
      const hadFocus = document.activeElement?.closest(".knob") !== null && document.activeElement !== null;
      this.greet();
      this.knobs.replaceChildren(...knobs.sort((a, b) => Number(a.classList.contains("node")) - Number(b.classList.contains("node"))));
      this.placeHandles();
      if (this.awaitsHandles && handles) {
        this.awaitsHandles = false;
        queueMicrotask(() => this.reveal());
      }
      if (this.focusedKey) {
        const knob = this.knobOf.get(this.focusedKey);
        if (!knob) this.focus(null);
        else if (hadFocus) knob.focus({ preventScroll: true });
        else this.focus(this.focusedKey);
      }
    }
    /** Highlights handles the first time that a deformation has some here. */
    greet() {
      const [name, known] = [this.app.step?.deformation, new Set((localStorage.getItem(GREETED_KEY) ?? "").split(" "))];
      this.knobs.classList.toggle("greeting", name !== void 0 && (name === this.greeted || !known.has(name)));
      if (!name || !this.app.handles || known.has(name)) return;
      this.greeted = name;
      localStorage.setItem(GREETED_KEY, [...known, name].join(" ").trim());
    }
    /** Makes a handle the one whose position is shown; null also clears the selection. */
    focus(key) {
      this.focusedKey = key;
      if (key === null) this.selection.take([]);
      for (const [k, knob] of this.knobOf) knob.classList.toggle("selected", k === key || this.selection.keys.has(k));
      this.selection.place(this.app.handles, (p) => this.camera.toScreen(p));
      this.onFocus(this.handle(key));
    }
    /** Selects several points. */
    select(keys) {
      this.selection.take(keys);
      const last = keys[keys.length - 1] ?? null;
      this.focus(last);
      if (last) this.knobOf.get(last)?.focus({ preventScroll: true });
    }
    /** Returns the selected points if a handle is one of several. */
    selectedWith(handle) {
      const { handles } = this.app;
      return handles && this.selection.isMany && this.selection.keys.has(handle.key) ? this.selection.selectedOf(handles) : null;
    }
    /** Returns the keys of the points in a frame between two points of the screen: nodes, or else control points. */
    keysInFrame([ax, ay], [bx, by]) {
      const inside = (this.app.handles?.handles ?? []).filter((h2) => {
        const [x, y] = this.camera.toScreen(h2.get());
        return (x - ax) * (x - bx) <= 0 && (y - ay) * (y - by) <= 0;
      });
      const nodes = inside.filter(({ shape }) => shape === "node");
      return (nodes.length > 0 ? nodes : inside).map(({ key }) => key);
    }
    get focusedHandle() {
      return this.handle(this.focusedKey);
    }
    handle(key) {
      return this.app.handles?.handles.find((h2) => h2.key === key) ?? null;
    }
    /** Returns the position of a pointer on the canvas. */
    point(e) {
      const box = this.svg.getBoundingClientRect();
      return [e.clientX - box.left, e.clientY - box.top];
    }
    /** Lets the next click pick a path among those that `selector` matches; `request`, if any, is shown until then. */
    pick(take, request = "", selector = ".art [id]") {
      [this.onPick, this.pickSelector] = [take, selector];
      this.svg.classList.toggle("picking", take !== null || this.modes.picksParts);
      this.svg.classList.toggle("outlining", take !== null && selector !== ".art [id]");
      this.outlinePath(null);
      this.hideRequest();
      this.hideRequest = take && request ? toast(request, true) : () => {
      };
    }
    /** Picks the clicked path; elsewhere, the request stays. */
    pickAt(e) {
      const path = this.pathAt(e, this.pickSelector);
      if (!path) return void toast("No path is there. Click one, or press Escape");
      const take = this.onPick;
      this.pick(null);
      take?.(path, this.camera.toUser(this.point(e)));
    }
    /** Reports the innermost part at the pointer, or the outermost copy around it: one part, named like `use at 12:5` without an id. */
    pickPartAt(e) {
      let name = null;
      for (let element = this.pathAt(e, ".art *"); element && !element.matches(".art"); element = element.parentElement) {
        const part = partOf(element.id);
        if (this.parts.has(part) && (name === null || part.startsWith("use at") || element.localName === "use")) name = part;
      }
      this.outlinePath(null);
      if (name !== null || !this.isHiddenAt(e)) this.onPart(name, e.shiftKey);
    }
    /** Returns `true` if a hidden part is at the pointer. */
    isHiddenAt(e) {
      const { hiddenParts } = this;
      this.hideParts(/* @__PURE__ */ new Set());
      const isThere = this.pathAt(e, ".art *") !== null;
      this.hideParts(hiddenParts);
      return isThere;
    }
    /** Returns the elements of parts in the picture. */
    elementsOf(parts) {
      const all = parts.size > 0 ? Array.from(this.art.querySelectorAll("[id]")) : [];
      return all.filter(({ id }) => parts.has(partOf(id)));
    }
    /** Draws the outlines of parts. */
    outlineParts(names) {
      this.outlinedParts = names;
      const paths = this.elementsOf(new Set(names)).flatMap((e) => e instanceof SVGPathElement ? [e] : Array.from(e.querySelectorAll("path")));
      this.partOutlines.replaceChildren(...paths.map((path) => outlineOf(path, this.svg, s("path", { class: "lit" }))));
    }
    /** Hides parts in the picture. */
    hideParts(names) {
      this.hiddenParts = names;
      for (const e of Array.from(this.art.querySelectorAll(".away"))) e.classList.remove("away");
      for (const e of this.elementsOf(names)) e.classList.add("away");
    }
    /** Returns the path nearest to the pointer among those that a selector matches, tried on circles around it. */
    pathAt(e, selector) {
      for (let r = 0; r <= PICK_REACH; r += 2) {
        for (let k = 0; k < (r === 0 ? 1 : 4 * r); k++) {
          const angle = 2 * Math.PI * k / (4 * r || 1);
          const path = document.elementFromPoint(e.clientX + r * Math.cos(angle), e.clientY + r * Math.sin(angle));
          if (path instanceof SVGGraphicsElement && path.closest(selector)) return path;
        }
      }
      return null;
    }
    /** Draws the outline of a path under the pointer; null removes it. */
    outlinePath(path) {
      if (path) outlineOf(path, this.svg, this.highlight);
      else this.highlight.setAttribute("d", "");
    }
    /** Shows the value of the dragged handle beside it; null hides it. */
    showValue(handle) {
      const { step: step2 } = this.app;
      const param = this.app.deformation(step2?.deformation)?.params.find(({ name }) => name === handle?.param);
      const isNumber = param && ["number", "length", "angle", "count"].includes(param.kind);
      const [x, y] = handle?.get() ?? [0, 0];
      const digits = Math.max(0, Math.ceil(-Math.log10(this.camera.pixel)));
      const position = [x, y].map((v) => v.toFixed(digits)).join(", ");
      this.value.textContent = !handle ? "" : isNumber ? `${paramName(param)} ${step2?.args[param.name]?.[0] ?? ""}${param.kind === "angle" ? "°" : ""}` : position;
      const [sx, sy] = this.camera.toScreen([x, y]);
      this.value.setAttribute("x", String(sx + REACH));
      this.value.setAttribute("y", String(sy - REACH));
    }
    /** Writes the values of a moved handle, and requests a draft. */
    writeHandle(handle, since) {
      this.app.handles.write(handle.param);
      this.placeHandles();
      if (this.app.cancelGesture) this.showValue(handle);
      this.onFocus(handle);
      this.app.tell("values");
      this.app.draft(since);
    }
    doubleClick(e) {
      if (!e.target.closest(".knob")) void this.add(this.camera.toUser(this.point(e)));
    }
    /** Adds a point, with its reflection if symmetry is on, and selects it. */
    async add(at) {
      const { handles } = this.app;
      if (!handles) return;
      const reach = REACH * this.camera.pixel;
      const key = await this.app.addPoint(at, this.modes.reflections(handles, at, reach), reach);
      if (key) this.select([key]);
    }
    /** Arrow keys move a handle by a px of the screen; with Shift, by ten. */
    key(e) {
      const handle = this.handle(e.target.closest(".knob")?.dataset.key ?? null);
      if (!handle || !this.app.handles) return;
      const direction = ARROWS[e.key];
      const several = this.selectedWith(handle);
      if (direction) {
        e.preventDefault();
        const px = e.shiftKey ? 10 : 1;
        const shifted = (p) => {
          const [x, y] = this.camera.toScreen(p);
          return this.camera.toUser([x + px * direction[0], y + px * direction[1]]);
        };
        if (several) {
          this.app.commitSoon();
          this.writeParams(groupMover(this.app.handles, several, this.modes)(shifted), performance.now());
        } else {
          this.moveTo(handle, shifted(handle.get()));
        }
        this.onKeys(handle);
      } else if (e.key === "Insert") {
        e.preventDefault();
        const [x, y] = handle.get();
        const at = this.app.handles.after(handle) ?? [x + 2 * REACH * this.camera.pixel, y];
        void this.add(at);
      } else if ((e.key === "Delete" || e.key === "Backspace") && handle.remove) {
        e.preventDefault();
        if (several) this.removeAll(several);
        else this.remove(handle);
      }
    }
    /** Removes several points, as long as enough remain. */
    removeAll(several) {
      const { handles } = this.app;
      if (!handles) return;
      const points = several.map((handle) => ({ handle, at: [...handle.get()] }));
      for (const { handle, at: [x, y] } of points) {
        const { param, shape } = handle;
        const present = handles.handles.includes(handle) ? handle : handles.handles.find((h2) => h2.param === param && h2.shape === shape && h2.get()[0] === x && h2.get()[1] === y);
        present?.remove?.();
        handles.write(param);
      }
      this.focusedKey = handles.nearest(points[0].at)?.key ?? null;
      this.selection.take(this.focusedKey ? [this.focusedKey] : []);
      this.app.tell("handles");
      void this.app.commit();
    }
    /** Writes the values of parameters whose handles have moved together, and requests a draft. */
    writeParams(params, since) {
      for (const param of params) this.app.handles.write(param);
      this.placeHandles();
      this.onFocus(this.focusedHandle);
      this.app.tell("values");
      this.app.draft(since);
    }
    /** Removes a point, and its reflection if symmetry is on. */
    remove(handle) {
      const { handles } = this.app;
      if (!handle.remove || !handles) return;
      const partner = this.modes.mirrors && !handles.editsAllRows(handle.param) ? handles.partner(handle) : null;
      this.removeAll(partner ? [handle, partner] : [handle]);
    }
    /** Moves a handle by keys or typed numbers. */
    moveTo(handle, to) {
      const { handles } = this.app;
      if (!handles) return;
      this.app.commitSoon();
      this.modes.mover(handles, handle)(to);
      this.writeHandle(handle, performance.now());
    }
  };
  function latest(work) {
    let [isRunning, isRequested] = [false, false];
    return async () => {
      isRequested = true;
      if (isRunning) return;
      isRunning = true;
      while (isRequested) {
        isRequested = false;
        await work();
      }
      isRunning = false;
    };
  }
  function partOf(id) {
    return id.replace(/^art-/, "");
  }
  var LARGEST_OUTLINE = 1e6;
  function outlineOf(path, svg, outline) {
    const [canvas, m] = [svg.getBoundingClientRect(), path.getScreenCTM()];
    const { width, height } = path.getBBox();
    const isTooLarge = m !== null && Math.hypot(width, height) * Math.hypot(m.a, m.b) > LARGEST_OUTLINE;
    outline.setAttribute("d", isTooLarge ? "" : path.getAttribute("d") ?? "");
    if (m) outline.setAttribute("transform", `matrix(${m.a} ${m.b} ${m.c} ${m.d} ${m.e - canvas.x} ${m.f - canvas.y})`);
    return outline;
  }

  // src/pointing.ts
  var MOVES = "onpointerrawupdate" in window ? "pointerrawupdate" : "pointermove";
  var SNAP = 7;
  var CLICK_DISTANCE = 3;
  var NOTCH2 = 50;
  var PINCH_RATE = 0.01;
  var WHEEL_RATE = 2e-3;
  var Pointing = class {
    constructor(app2, stage2, modes2) {
      this.app = app2;
      this.stage = stage2;
      this.modes = modes2;
      stage2.svg.addEventListener("wheel", (e) => this.wheel(e), { passive: false });
      stage2.svg.addEventListener("pointerdown", (e) => this.press(e));
      for (const moves of /* @__PURE__ */ new Set([MOVES, "pointermove"])) {
        window.addEventListener(moves, (e) => {
          const { pointerId } = e;
          if (this.down.has(pointerId)) this.down.set(pointerId, stage2.point(e));
        });
      }
      app2.listen(["link"], () => {
        if (!app2.isLive) this.finish?.();
      });
      for (const end2 of ["pointerup", "pointercancel"]) window.addEventListener(end2, (e) => this.down.delete(e.pointerId));
    }
    app;
    stage;
    modes;
    /** The pointers that are down, with their positions. */
    down = /* @__PURE__ */ new Map();
    /** Ends the action of the first pointer. */
    finish = null;
    /** Called if the view was moved by a drag that began on the artwork. */
    onPan = () => {
    };
    wheel(e) {
      e.preventDefault();
      const { stage: stage2 } = this;
      const isPinch = e.ctrlKey && Math.abs(e.deltaY) < NOTCH2;
      if (e.ctrlKey || e.metaKey || e.deltaX === 0 && Math.abs(e.deltaY) >= NOTCH2) {
        return stage2.zoom(Math.exp(-e.deltaY * (isPinch ? PINCH_RATE : WHEEL_RATE)), stage2.point(e));
      }
      stage2.shift([-e.deltaX, -e.deltaY]);
    }
    press(e) {
      const { stage: stage2 } = this;
      const target = e.target;
      if (stage2.onPick) return stage2.pickAt(e);
      this.down.set(e.pointerId, stage2.point(e));
      if (this.down.size > 2) return;
      if (this.down.size === 2) {
        this.finish?.();
        return this.pinch();
      }
      const bends = e.button === 0 && !stage2.isBefore;
      const knob = target.closest(".knob");
      const part = target.closest(".part")?.dataset.part;
      if (knob && bends) this.drag(e, knob);
      else if (this.modes.picksParts && bends) this.pan(e, () => stage2.pickPartAt(e));
      else if (part && bends) this.transform(e, stage2.selection.transform(part, stage2.point(e)));
      else if (bends && !e.shiftKey && stage2.selection.holds(stage2.point(e))) this.transform(e, translation(stage2.point(e)), () => stage2.select([]));
      else if (bends && (e.shiftKey || stage2.isSelecting)) this.frame(e);
      else if (!(bends && target.matches(".pull") && this.pull(e))) this.pan(e, () => stage2.select([]));
    }
    /** Follows a pointer until it is lifted, Escape is pressed, or a second finger touches. Returns a function that cancels the action. */
    follow(e, { move, end: end2, cancel = end2 }) {
      const stop = new AbortController();
      const finish = (react) => {
        stop.abort();
        this.finish = null;
        react();
      };
      this.finish = () => finish(end2);
      const onThisPointer = (action) => (event) => {
        if (event.pointerId === e.pointerId) action(event);
      };
      window.addEventListener(MOVES, onThisPointer((event) => move(this.stage.point(event), event)), stop);
      for (const lifted of ["pointerup", "pointercancel"]) window.addEventListener(lifted, onThisPointer(() => finish(end2)), stop);
      window.addEventListener("keydown", (event) => {
        if (event.key === "Escape") finish(cancel);
      }, stop);
      return () => finish(cancel);
    }
    /** Follows a pointer that changes the step by `move`; `done` cleans up, and `clicked` reacts to a press without a move. */
    bend(e, move, done, clicked = () => {
    }) {
      const { app: app2 } = this;
      const start = this.stage.point(e);
      hush();
      void app2.flush();
      const step2 = app2.step;
      const before2 = structuredClone(step2);
      let hasMoved = false;
      app2.isDragging = true;
      const stop = () => {
        app2.isDragging = false;
        app2.cancelGesture = null;
        this.stage.showValue(null);
        done();
      };
      app2.cancelGesture = this.follow(e, {
        move: (to, event) => {
          hasMoved ||= Math.hypot(to[0] - start[0], to[1] - start[1]) >= CLICK_DISTANCE;
          if (hasMoved) move(to, event);
        },
        end: () => {
          stop();
          if (hasMoved) void app2.commit();
          else clicked();
        },
        cancel: () => {
          stop();
          if (hasMoved) app2.cancel(step2, before2);
        }
      });
    }
    drag(e, knob) {
      const { stage: stage2, modes: modes2 } = this;
      const { handles } = this.app;
      const handle = stage2.handle(knob.dataset.key ?? null);
      if (!handle || !handles) return;
      e.preventDefault();
      const before2 = new Set(stage2.selection.keys);
      knob.focus({ preventScroll: true });
      if (e.shiftKey) stage2.selection.keys = before2;
      const [x, y] = stage2.point(e);
      const several = stage2.selectedWith(handle);
      const adds = e.shiftKey;
      const clicked = () => {
        if (adds) stage2.selection.toggle(handle.key);
        stage2.select(adds ? Array.from(stage2.selection.keys) : [handle.key]);
      };
      if (several && !adds) return this.transform(e, translation([x, y]), clicked);
      const grabbed = stage2.camera.toScreen(handle.get());
      const mover = modes2.mover(handles, handle);
      knob.classList.add("held");
      this.bend(e, (to, event) => {
        const target = stage2.camera.toUser([grabbed[0] + to[0] - x, grabbed[1] + to[1] - y]);
        mover(modes2.snapped(target, handle, handles, SNAP * stage2.camera.pixel, event), event);
        stage2.writeHandle(handle, event.timeStamp);
      }, () => {
        knob.classList.remove("held");
        modes2.clear();
        stage2.placeHandles();
      }, clicked);
    }
    /** Moves, rotates or scales the selected points with the pointer. */
    transform(e, image, clicked = () => {
    }) {
      const { stage: stage2, modes: modes2 } = this;
      const { handles } = this.app;
      if (!handles) return;
      const { camera } = stage2;
      const mover = groupMover(handles, stage2.selection.selectedOf(handles), modes2);
      e.preventDefault();
      this.bend(e, (to, event) => {
        const map = image(to);
        stage2.writeParams(mover((p) => camera.toUser(map(camera.toScreen(p)))), event.timeStamp);
      }, () => stage2.placeHandles(), clicked);
    }
    /** Draws a frame, and selects the points within. */
    frame(e) {
      const { stage: stage2 } = this;
      const start = stage2.point(e);
      const before2 = e.shiftKey ? Array.from(stage2.selection.keys) : [];
      let last = start;
      const hide2 = () => stage2.marquee.setAttribute("visibility", "hidden");
      e.preventDefault();
      this.follow(e, {
        move: (to) => {
          last = to;
          const sides = { x: Math.min(start[0], to[0]), y: Math.min(start[1], to[1]), width: Math.abs(to[0] - start[0]), height: Math.abs(to[1] - start[1]), visibility: "visible" };
          for (const [name, value] of Object.entries(sides)) stage2.marquee.setAttribute(name, String(value));
        },
        end: () => {
          hide2();
          stage2.select(Array.from(/* @__PURE__ */ new Set([...before2, ...stage2.keysInFrame(start, last)])));
        },
        cancel: hide2
      });
    }
    /** Follows a line that is dragged. Returns `false` if there is none. */
    pull(e) {
      const { stage: stage2, modes: modes2 } = this;
      const { handles } = this.app;
      const pull = handles?.pull(stage2.camera.toUser(stage2.point(e)), REACH * stage2.camera.pixel);
      if (!handles || !pull) return false;
      const [x, y] = stage2.point(e);
      if (pull.ends.length > 1 && pull.ends.every((key) => stage2.selection.keys.has(key))) {
        this.transform(e, translation([x, y]));
        return true;
      }
      const puller = modes2.puller(handles, pull);
      this.bend(e, (to, event) => {
        puller(stage2.camera.toUser(to));
        handles.write(pull.param);
        stage2.placeHandles();
        this.app.tell("values");
        this.app.draft(event.timeStamp);
      }, () => {
      }, () => stage2.select(pull.ends));
      return true;
    }
    /** Moves the view; a press without a move calls `clicked` instead. */
    pan(e, clicked) {
      const { stage: stage2 } = this;
      const first = stage2.point(e);
      let last = first;
      const start = stage2.camera.toUser(first);
      stage2.svg.classList.add("panning");
      this.follow(e, {
        move: (to) => {
          stage2.shift([to[0] - last[0], to[1] - last[1]]);
          last = to;
        },
        end: () => {
          stage2.svg.classList.remove("panning");
          const [x, y, w, h2] = this.app.handles?.frame ?? [0, 0, 0, 0];
          const distance2 = Math.hypot(last[0] - first[0], last[1] - first[1]);
          if (distance2 < CLICK_DISTANCE && this.down.size < 2) clicked();
          const isOnArtwork = start[0] > x && start[0] < x + w && start[1] > y && start[1] < y + h2;
          if (isOnArtwork && distance2 > REACH / 4) this.onPan();
        }
      });
    }
    /** Moves and magnifies the view by two fingers. */
    pinch() {
      const [one, two] = Array.from(this.down.keys());
      const stop = new AbortController();
      const middleAndDistance = () => {
        const [a, b] = [this.down.get(one), this.down.get(two)];
        return [[(a[0] + b[0]) / 2, (a[1] + b[1]) / 2], Math.hypot(a[0] - b[0], a[1] - b[1])];
      };
      let [from, distance2] = middleAndDistance();
      window.addEventListener("pointermove", () => {
        const [to, newDistance] = middleAndDistance();
        if (distance2 > 0) this.stage.zoom(newDistance / distance2, from);
        this.stage.shift([to[0] - from[0], to[1] - from[1]]);
        [from, distance2] = [to, newDistance];
      }, stop);
      for (const lifted of ["pointerup", "pointercancel"]) window.addEventListener(lifted, () => stop.abort(), stop);
    }
  };
  var translation = ([x, y]) => (to) => ([px, py]) => [px + to[0] - x, py + to[1] - y];

  // src/presets.ts
  var Presets = class {
    constructor(app2, gallery) {
      this.app = app2;
      this.gallery = gallery;
      byId("keep-preset").addEventListener("click", () => this.open());
      byId("preset-cancel").addEventListener("click", () => this.dialog.close());
      this.name.addEventListener("input", () => this.say(""));
      this.replace.addEventListener("click", () => void this.keep(this.name.value.trim(), true));
      this.dialog.querySelector("form").addEventListener("submit", (e) => {
        e.preventDefault();
        void this.keep(this.name.value.trim(), false);
      });
    }
    app;
    gallery;
    dialog = byId("preset-dialog");
    name = byId("preset-name");
    message = byId("preset-message");
    replace = byId("preset-replace");
    open() {
      this.name.value = "";
      this.say("");
      this.dialog.showModal();
    }
    say(text, canReplace = false) {
      this.message.textContent = text;
      this.replace.hidden = !canReplace;
    }
    async keep(name, replaces) {
      if (!replaces && this.gallery.names.includes(name)) return this.say(`${name} exists already.`, true);
      try {
        if (!await this.app.settle()) throw new Error(this.app.problem ?? "");
        const { presets } = await this.app.connection.ask({ do: "keep-preset", name });
        this.gallery.showPresets(presets ?? []);
        this.dialog.close();
        toast(`${name} is kept among the shapes`);
      } catch (e) {
        this.say(reason(e));
      }
    }
  };

  // src/report.ts
  var SLOW = 250;
  var Report = class {
    constructor(app2) {
      this.app = app2;
      app2.listen(["report", "state"], () => this.figures());
      app2.listen(["state"], () => this.buttons());
      app2.listen(["handles", "steps"], () => this.hint());
      app2.listen(["link"], () => this.link());
      app2.connection.onBusy = (isBusy) => this.busy(isBusy);
      byId("warnings").addEventListener("click", () => toast(app2.warnings.join(" · ")));
    }
    app;
    /** The drawing whose draft has been reported. */
    announced = null;
    slow = 0;
    busy(isBusy) {
      clearTimeout(this.slow);
      const view = byId("view");
      view.setAttribute("aria-busy", String(isBusy));
      if (isBusy) this.slow = window.setTimeout(() => view.classList.add("busy"), SLOW);
      else view.classList.remove("busy");
    }
    figures() {
      const { app: app2 } = this;
      const { state, summary, warnings } = app2;
      const isBent = !app2.isProposal && summary !== null && summary.segmentsIn > 0;
      show("counts", isBent ? `${summary.segmentsIn} → ${summary.segmentsOut} segments` : "");
      show("error", isBent && summary.error > 0 ? `largest error ${Number(summary.error.toPrecision(2))}` : "");
      const folds = summary?.folds.length ?? 0;
      show("folds", folds === 0 ? "" : folds === 1 ? "Folds over at 1 place" : `Folds over at ${folds} places`);
      show("problem", app2.problem ?? (state?.problem ? `Nothing is kept until you save: ${state.problem}` : ""));
      const remarks = byId("warnings");
      remarks.hidden = warnings.length === 0;
      remarks.textContent = warnings.length === 1 ? "1 remark" : `${warnings.length} remarks`;
      remarks.title = warnings.join("\n");
    }
    buttons() {
      const { state } = this.app;
      if (!state) return;
      const isEmpty = state.steps.length === 0;
      const disabled = { undo: !state.undo, redo: !state.redo, "start-over": isEmpty, "keep-preset": isEmpty };
      for (const [id, value] of Object.entries(disabled)) byId(id).disabled = value;
      const restored = state.restored ? state.file : null;
      if (restored && restored !== this.announced) toast("Your last, unsaved steps are here again");
      this.announced = restored;
    }
    /** Shows a hint about the visible handles. */
    hint() {
      const { app: app2 } = this;
      const { handles } = app2;
      const has = (handles?.handles.length ?? 0) > 0;
      byId("smooth").hidden = !handles?.handles.some(({ key }) => /\/(in|out)$/.test(key));
      byId("mirror").hidden = !has;
      byId("snap").hidden = !has;
      byId("select").hidden = (handles?.handles.length ?? 0) < 2;
      if (app2.freedPath) toast(`The line has left ${app2.freedPath}, which is artwork again. Undo brings it back`);
      app2.freedPath = null;
      if (app2.appends) return show("note", "Choose the shape of the next step, or press Escape");
      if (app2.steps.length === 0) return show("note", "Choose a shape");
      if (app2.step?.hidden) return show("note", "This step is hidden: it bends nothing. The eye in the list brings it back");
      if (app2.leastRadius("along") !== null) return show("note", "The artwork is longer than its circle: pull the circle larger, or see the settings");
      if (!handles) return;
      const pulls = handles.lines().some(({ kind }) => kind === "path") ? "Pull a blue point or line" : "Pull a blue point";
      const adds = handles.net ? "Double-click a line to add another" : handles.grows ? "Double-click adds one, Delete removes it" : "Double-click the line to add a point, Delete removes it";
      const note = isCaption(app2.step ?? { deformation: "" }) ? "Pull the blue point to move the words, double-click to type" : !has ? "Change the settings" : handles.net || handles.grows || handles.divides ? `${pulls}. ${adds}` : `${pulls} to bend the artwork`;
      show("note", app2.isProposal && has ? `${note}, or choose a shape` : note);
    }
    /** Reacts to a moved view: the user may have meant to bend the artwork. */
    panned() {
      if (this.app.isProposal && this.app.handles?.handles.length) show("note", "This moves the view. Pull a blue point or line to bend the artwork");
    }
    link() {
      const { isDone, isLive, state } = this.app;
      const gone = byId("gone");
      gone.hidden = isLive;
      for (const part of Array.from(document.querySelectorAll("header, main, footer"))) part.inert = !isLive;
      if (!isLive) for (const dialog of Array.from(document.querySelectorAll("dialog"))) dialog.close();
      gone.classList.toggle("done", isDone);
      show("gone-title", isDone ? `${state?.program} has the result.` : "pathwarp has ended.");
      show("gone-kept", isDone ? "You can close this page." : state?.program ? `${state.program} has stopped waiting. Choose “Bend by hand” there to begin again.` : `${kept(state)} To go on${state?.saved ? "" : " here"}, run “${state?.again ?? "pathwarp edit"}”.`);
    }
  };
  function kept(state) {
    if (!state || state.steps.length === 0) return "";
    if (state.saved) return "Everything is saved.";
    return state.problem ? `What was not saved is lost (${state.problem}).` : `The steps of ${state.file} are kept.`;
  }
  function show(id, text) {
    const element = byId(id);
    element.hidden = text === "";
    if (element.textContent !== text) element.textContent = text;
  }

  // src/saving.ts
  var FORMATS = [
    ["svg", "SVG", "Can be opened here again"],
    ["svgz", "SVGZ", "The same, packed"],
    ["pdf", "PDF", "For print"],
    ["dxf", "DXF", "For cutters and CAD"],
    ["png", "PNG", "A picture"],
    ["jpg", "JPEG", "A picture, smaller"],
    ["webp", "WebP", "A picture for the web"],
    ["toml", "Recipe", "For other drawings"]
  ];
  var PICTURE_EXTENSIONS = ["png", "jpg", "webp"];
  var USUAL_WIDTH = 2e3;
  var LARGEST_WIDTH = 2e4;
  var CHOICES_KEY = "pathwarp-export";
  var NOTHING = "There is nothing to save yet: pull a blue point or choose a shape first";
  var DOWNLOAD_START = 6e4;
  var Saving = class {
    constructor(app2) {
      this.app = app2;
      const formats = byId("save-formats");
      for (const [extension, title, use] of FORMATS) {
        const input = h("input", { type: "radio", name: "format", value: extension });
        input.addEventListener("change", () => this.choose(extension));
        formats.append(h("label", { class: "format" }, input, h("span", {}, h("b", {}, title), h("small", {}, use))));
      }
      byId("save").addEventListener("click", () => void this.save());
      byId("save-as").addEventListener("click", () => void this.open());
      byId("save-cancel").addEventListener("click", () => this.dialog.close());
      this.dialog.querySelector("form").addEventListener("submit", (e) => {
        e.preventDefault();
        void this.write(false);
      });
      this.replace.addEventListener("click", () => void this.write(true));
      this.download.addEventListener("click", () => void this.downloadFile());
      for (const field of [this.name, this.folder, this.size]) field.addEventListener("input", () => this.say(""));
      this.background.addEventListener("change", () => this.colour.hidden = this.background.value !== "colour");
      this.unit.addEventListener("change", () => this.size.value = this.unit.value === "%" ? "100" : String(USUAL_WIDTH));
      this.recall();
      byId("copy-command").addEventListener("click", () => void this.copyCommand());
      app2.listen(["state"], () => this.show());
    }
    app;
    dialog = byId("save-dialog");
    name = byId("save-name");
    extension = "svg";
    message = byId("save-message");
    replace = byId("save-replace");
    download = byId("save-download");
    folder = byId("save-folder");
    size = byId("save-size");
    unit = byId("save-unit");
    background = byId("save-background");
    colour = byId("save-colour");
    /** The photograph for which the dialog last offered the full size, 100 %; empty for other drawings. */
    photographOffered = "";
    /** The steps downloaded last, as JSON. */
    downloaded = "";
    show() {
      const { state } = this.app;
      if (!state) return;
      byId("file").textContent = state.file;
      const isEmpty = state.steps.length === 0;
      byId("saved").textContent = state.program ? `From ${state.program}` : state.saved ? state.savedTo === state.file ? "Saved" : `Saved as ${state.savedTo}` : isEmpty ? "No changes yet" : this.isDownloaded ? "Downloaded" : "Not saved yet";
      const save = byId("save");
      save.disabled = state.program ? isEmpty && !state.undo : isEmpty || state.saved;
      if (state.program) {
        save.textContent = `Keep in ${state.program}`;
        save.title = `Give the result to ${state.program} (Ctrl S)`;
        for (const id of ["save-as", "open"]) byId(id).hidden = true;
      }
      document.title = `${this.isUnsaved ? "• " : ""}${state.file} — pathwarp`;
    }
    get isDownloaded() {
      return this.downloaded === JSON.stringify(this.app.state?.steps);
    }
    /** `true` if leaving the page would lose changes. */
    get isUnsaved() {
      const { state } = this.app;
      if (!state) return false;
      return state.program ? state.undo && !this.app.isDone : state.steps.length > 0 && !state.saved && !this.isDownloaded;
    }
    /** Hands the steps to the program that waits for them. */
    async handOver() {
      const answer = await this.app.request({ do: "hand-over" });
      if (!answer?.done) return;
      this.app.finish();
      window.close();
    }
    /** Saves to the file saved last or, the first time, to the usual one. */
    async save() {
      if (this.dialog.open) return this.write(false);
      if (!await this.app.settle()) return;
      const { state } = this.app;
      if (state?.program) return byId("save").disabled ? void 0 : this.handOver();
      if (!state) return;
      if (state.steps.length === 0) return this.open();
      const answer = await this.app.request({ do: "save", name: null, replace: false });
      if (answer?.exists || answer?.unwritable) return this.open(answer.unwritable);
      if (answer?.written) this.reportSaved(answer.written, answer.state, answer.warnings ?? []);
    }
    /** Opens the dialog for a name, with the reason if nothing could be written. */
    async open(unwritable = "") {
      if (!await this.app.settle()) return;
      const { state } = this.app;
      if (!state || state.program || this.dialog.open) return;
      if (state.steps.length === 0 && !state.words) return void toast(NOTHING);
      this.name.value = state.target;
      this.choose("svg");
      if (!state.photograph) this.recall();
      else if (this.photographOffered !== state.drawing) [this.unit.value, this.size.value] = ["%", "100"];
      this.photographOffered = state.photograph ? state.drawing : "";
      this.folder.value = state.savedIn ?? state.folder;
      if (unwritable) this.refuse(unwritable);
      this.dialog.showModal();
      this.name.select();
    }
    /** Restores the choices made last. */
    recall() {
      const { unit = "px", size = USUAL_WIDTH, background: background2 = "none" } = JSON.parse(localStorage.getItem(CHOICES_KEY) ?? "{}");
      const isColour = background2.startsWith("#");
      [this.unit.value, this.size.value, this.background.value] = [unit, String(size), isColour ? "colour" : background2];
      if (isColour) this.colour.value = background2;
      this.colour.hidden = !isColour;
    }
    /** Returns the file in the dialog; `null` for a picture without a size. */
    target() {
      const [name, folder] = [this.name.value, this.folder.value];
      if (!PICTURE_EXTENSIONS.includes(this.extension)) return { name, folder };
      const unit = this.unit.value === "%" ? "%" : "px";
      const size = inUnits(this.size.value, unit) ?? NaN;
      if (!(size > 0 && size <= LARGEST_WIDTH) || unit === "px" && !Number.isInteger(size)) {
        this.say(unit === "%" ? "The size is a number of per cent, such as 200" : `The width is a whole number of pixels up to ${LARGEST_WIDTH}`);
        return null;
      }
      const background2 = this.background.value === "colour" ? this.colour.value : this.background.value;
      if (!this.photographOffered) localStorage.setItem(CHOICES_KEY, JSON.stringify({ unit, size, background: background2 }));
      const picture = { ...unit === "%" ? { scale: size / 100 } : { width: size }, background: background2 === "none" ? null : background2 };
      return { name, folder, picture };
    }
    choose(extension) {
      this.extension = extension;
      this.name.value = `${this.name.value.replace(/\.(svgz?|pdf|dxf|png|jpe?g|webp|toml)$/i, "")}.${extension}`;
      for (const input of Array.from(this.dialog.querySelectorAll("input[type=radio]"))) {
        input.checked = input.value === this.extension;
      }
      byId("save-picture").hidden = !PICTURE_EXTENSIONS.includes(extension);
      this.say("");
    }
    /** Shows a message, with the button that replaces a file if it `asks` for that. */
    say(text, asks = false) {
      this.message.textContent = text;
      this.replace.hidden = !asks;
    }
    refuse(unwritable) {
      this.say(`${unwritable}. Download it instead: the browser has a folder of its own.`);
    }
    async write(replace) {
      const target = this.target();
      if (!target) return;
      try {
        const answer = await this.app.connection.ask({ do: "save", ...target, replace });
        if (answer.exists) return this.say(`${answer.exists} exists already.`, true);
        if (answer.unwritable) return this.refuse(answer.unwritable);
        this.dialog.close();
        this.reportSaved(answer.written ?? this.name.value, answer.state, answer.warnings ?? []);
      } catch (e) {
        this.say(inWords(reason(e)));
      }
    }
    /** Downloads the file, since the browser knows a writable folder. */
    async downloadFile() {
      const target = this.target();
      if (!target) return;
      try {
        const { written = this.name.value, bytes = "", warnings = [] } = await this.app.connection.ask({ do: "download", ...target });
        const href = URL.createObjectURL(new Blob([Uint8Array.from(atob(bytes), (c) => c.charCodeAt(0))]));
        h("a", { href, download: written }).click();
        setTimeout(() => URL.revokeObjectURL(href), DOWNLOAD_START);
        this.dialog.close();
        if (/\.svgz?$/i.test(written)) this.downloaded = JSON.stringify(this.app.state?.steps);
        this.app.tell("state");
        toast([`Downloaded ${written}`, ...warnings].join(". "));
      } catch (e) {
        this.say(inWords(reason(e)));
      }
    }
    reportSaved(written, state, warnings) {
      if (state) {
        this.app.state = state;
        this.app.tell("state");
      }
      const name = written.split(/[\\/]/).pop() ?? written;
      toast([`Saved ${name} in ${written.slice(0, -name.length - 1) || (this.app.state?.folder ?? "")}`, ...warnings].join(". "));
    }
    async copyCommand() {
      await this.app.settle();
      const target = this.target();
      if (!target) return;
      try {
        const { text = "", written } = await this.app.connection.ask({ do: "command-line", ...target });
        try {
          await navigator.clipboard.writeText(text);
          toast(`The command line is on the clipboard${written ? `; ${written}, which it reads, is beside the drawing now` : ""}`);
        } catch {
          toast(text);
        }
        this.dialog.close();
      } catch (e) {
        this.say(inWords(reason(e)));
      }
    }
  };

  // src/words.ts
  var BUNDLED = "Noto Sans (bundled)";
  var MAX_SIZE = 2e3;
  var MAX_SPACING = 500;
  var WordsDialog = class {
    constructor(app2) {
      this.app = app2;
      byId("words").addEventListener("click", () => void this.open());
      byId("words-place").addEventListener("click", () => {
        this.dialog.close();
        const { value } = this.text;
        this.onPlace({ ...value.trim() && !this.app.state?.words && { words: value.split("\n") }, ...this.font && { font: [this.font] } });
      });
      byId("words-cancel").addEventListener("click", () => this.dialog.close());
      this.search.addEventListener("input", () => this.list());
      this.fonts.addEventListener("change", () => this.font = this.fonts.value === BUNDLED ? null : this.fonts.value);
      this.dialog.querySelector("form").addEventListener("submit", (e) => {
        e.preventDefault();
        void this.set();
      });
      app2.listen(["state"], () => this.show());
    }
    app;
    dialog = byId("words-dialog");
    text = byId("words-text");
    search = byId("words-search");
    fonts = byId("words-font");
    size = byId("words-size");
    spacing = byId("words-spacing");
    message = byId("words-message");
    families = null;
    font = null;
    /** Called to place words on the drawing, with these values. */
    onPlace = () => {
    };
    show() {
      const { state } = this.app;
      byId("words").textContent = state?.words ? "Edit words…" : "Words…";
      byId("words-set").textContent = state?.words ? "Set words" : "New drawing";
      byId("words-place").classList.toggle("primary", !state?.words);
      byId("words-set").classList.toggle("primary", !!state?.words);
      if (state?.program) byId("words").hidden = true;
    }
    async open() {
      if (!await this.app.settle()) return;
      const answer = this.families ? null : await this.app.request({ do: "families" });
      this.families ??= answer?.families ?? [];
      const { text, font, size, spacing } = this.app.state?.words ?? { text: "", font: null, size: 20, spacing: 0 };
      [this.text.value, this.size.value, this.spacing.value, this.search.value] = [text, String(size), String(spacing), ""];
      this.font = font;
      this.list();
      const isMissing = font !== null && !this.families.includes(font);
      this.message.textContent = isMissing ? `${font} is not installed here. The letters stay as they are until you choose another font` : "";
      this.dialog.showModal();
      this.text.focus();
    }
    /** Lists the families that match the typed text, each in its letters. */
    list() {
      const wanted = this.search.value.trim().toLowerCase();
      const all = [BUNDLED, ...this.families ?? []].filter((name) => name.toLowerCase().includes(wanted));
      this.fonts.replaceChildren(...all.map((name) => {
        const option = h("option", { value: name }, name);
        if (name !== BUNDLED) option.style.setProperty("font-family", `"${name.replaceAll('"', "")}", system-ui`);
        return option;
      }));
      this.fonts.value = this.font ?? BUNDLED;
      this.fonts.selectedOptions[0]?.scrollIntoView({ block: "nearest" });
    }
    async set() {
      const { app: app2 } = this;
      const [size, spacing] = [inUnits(this.size.value, "mm") ?? NaN, inUnits(this.spacing.value, "%") ?? NaN];
      if (this.text.value.trim() === "") return this.say("Type some words first");
      if (!(size > 0 && size <= MAX_SIZE)) return this.say(`The size is a number of mm up to ${MAX_SIZE}, such as 20`);
      if (!(Math.abs(spacing) <= MAX_SPACING)) return this.say("The spacing is a number of per cent, such as 5");
      try {
        const words2 = { text: this.text.value, font: this.font, size, spacing };
        await app2.enter(async () => {
          const answer = await app2.connection.ask({ do: "set-words", words: words2 });
          this.dialog.close();
          if (answer.lacking?.length) toast(`The font lacks ${answer.lacking.join(" ")}. Choose one that has them.`);
          return answer;
        });
      } catch (e) {
        this.say(inWords(reason(e)));
      }
    }
    say(text) {
      this.message.textContent = text;
    }
  };

  // src/settings.ts
  var LENGTH_RANGE = [0, 100];
  var SHIFT_RANGE = [-100, 100];
  var COARSE = 20;
  var NOTES = { mls: " Pins pull everything around them, also across gaps; pick a part to move it alone." };
  var SIDE_BY_SIDE = 3;
  var SKETCHES = {
    line: "Drag from its start to its end on the drawing",
    path: "Click its points on the drawing; a double click, Enter or the first point ends it",
    circle: "Drag from its centre to its edge on the drawing"
  };
  var Settings = class {
    constructor(app2) {
      this.app = app2;
      app2.listen(["steps", "state", "handles"], () => this.build());
      app2.listen(["values"], () => this.refresh());
    }
    app;
    box = byId("settings");
    /** Identifies the controls that have been built: step, deformation, adjust values, circles. */
    builtFor = "";
    /** Functions that show present values in the controls. */
    refreshers = [];
    /** Asks for a path on the canvas; a click returns its id. */
    onPick = () => {
    };
    /** Asks for a line drawn on the canvas. */
    onDraw = () => {
    };
    /** Called when the settings of another step are shown. */
    onStepChange = () => {
    };
    build() {
      const { step: step2 } = this.app;
      const deformation = this.app.deformation(step2?.deformation);
      const params = deformation?.params ?? [];
      const circles = params.filter((p) => this.app.grip(p.name)?.circle).map((p) => p.name);
      const adjusts = params.flatMap((p) => (this.app.grip(p.name)?.adjust ?? []).map((a) => `${a.name} ${a.least} ${a.most}`));
      const signature = [this.app.selected, step2?.deformation, ...adjusts, ...circles].join();
      if (signature === this.builtFor && this.box.childElementCount > 0) return this.refresh();
      this.builtFor = signature;
      this.onStepChange();
      this.refreshers = [];
      if (!step2 || !deformation) return this.box.replaceChildren();
      const main = params.filter((p) => isCaption(step2) && p.kind !== "point" || isMain(p, step2.args[p.name] !== void 0) || this.app.grip(p.name)?.adjust !== void 0);
      const more = params.filter((p) => !main.includes(p));
      const focused = this.box.contains(document.activeElement) ? document.activeElement?.id : void 0;
      this.box.replaceChildren(
        h("p", { class: "about" }, sentence(deformation.title), NOTES[deformation.name] ?? ""),
        ...main.map((p) => this.control(p)),
        more.length > 0 ? h("details", { class: "more" }, h("summary", {}, "More settings"), ...more.map((p) => this.control(p))) : ""
      );
      this.refresh();
      if (focused) document.getElementById(focused)?.focus();
    }
    refresh() {
      for (const refresh of this.refreshers) refresh();
    }
    values(p) {
      return this.app.step?.args[p.name] ?? [];
    }
    current(p) {
      return this.values(p)[0] ?? p.default ?? "";
    }
    control(p) {
      const id = `set-${p.name}`;
      const title = plain(p.help);
      const label = h("label", { for: id, title }, paramName(p));
      const adjust = this.app.grip(p.name)?.adjust;
      if (adjust) return h("div", {}, ...adjust.map((_, i) => this.adjust(p, adjust, i, title)));
      switch (p.kind) {
        case "flag":
          return this.flag(p, id, title);
        case "choice":
          return this.choice(p, id, label, title);
        case "count":
          return h("div", { class: "field", title }, ...this.number(p, id, label, "", 1));
        case "file":
          return h("div", { class: "field", title }, h("div", { class: "row" }, label, this.chooseFile(p)), this.text(p, id));
        case "name":
          return h("div", { class: "field", title }, h("div", { class: "row" }, label, this.chooseFile(p)), this.select(p, id));
        case "number":
        case "length":
        case "angle":
          return this.slider(p, id, label, title);
        case "path": {
          const set2 = (value) => this.app.set(p.name, [value], true);
          const pick = button({ class: "link", title: "Click a path of the drawing; it is then a guide and no artwork" }, () => this.onPick((name) => set2(`#${name}`)), "Pick from drawing");
          const draws = ["line", "path", "circle"].map((kind) => button({ class: "link", title: SKETCHES[kind] }, () => this.onDraw(kind, set2), `Draw ${kind}`));
          const radius = this.app.grip(p.name)?.circle && this.radius(p, id);
          return h("div", { class: "field", title }, h("div", { class: "row" }, label, pick), h("div", { class: "row draws" }, ...draws), ...radius || [], this.text(p, id));
        }
        default: {
          if (p.notation === "FAMILY") return h("div", { class: "field", title }, label, this.family(p, id));
          return h("div", { class: "field", title }, h("div", { class: "row" }, label, p.notation === "COLOUR" && this.colour(p)), this.text(p, id));
        }
      }
    }
    colour(p) {
      const input = h("input", { type: "color", "aria-label": `${paramName(p)}, chosen` });
      input.addEventListener("input", () => this.app.setSoon(p.name, [input.value]));
      this.refreshers.push(() => input.value = /^#[0-9a-f]{6}$/i.test(this.current(p)) ? this.current(p) : "#000000");
      return input;
    }
    /** Returns the choice of installed fonts. */
    family(p, id) {
      const select = h("select", { id }, h("option", { value: "" }, BUNDLED));
      select.addEventListener("change", () => this.app.set(p.name, select.value ? [select.value] : [], true));
      const show2 = () => {
        const value = this.current(p);
        if (!Array.from(select.options).some((o) => o.value === value)) select.append(h("option", { value }, value));
        select.value = value;
      };
      this.refreshers.push(show2);
      void this.app.request({ do: "families" }).then((answer) => {
        select.append(...(answer?.families ?? []).map((name) => h("option", { value: name }, name)));
        show2();
      });
      return select;
    }
    /** Returns a field for the radius of a circle in mm, with a warning if the artwork is longer than the circle. */
    radius(p, id) {
      const { app: app2 } = this;
      const [a, b] = app2.state?.toPx ?? [1, 0];
      const unit = MM / Math.hypot(a, b);
      const circle2 = () => app2.grip(p.name)?.circle;
      const input = h("input", { type: "text", id: `${id}-radius`, class: "value", inputmode: "decimal", autocomplete: "off" });
      const number = (text) => inUnits(text, "mm") ?? NaN;
      const set2 = (mm) => {
        const present = circle2();
        return present ? app2.setTyped(p.name, [arc([present[0], present[1], mm * unit, present[3], present[4]])]) : null;
      };
      const field = new Field(input, () => hundredths((circle2()?.[2] ?? 0) / unit).toString(), (text) => set2(number(text)), (text) => number(text) > 0 ? null : describeLimits("mm", 0));
      const note = h("p", { class: "wrong", role: "status" });
      const grow = button({ class: "link" }, () => void set2(Number(grow.dataset.mm)));
      const warning = h("div", { hidden: true }, note, grow);
      this.refreshers.push(() => {
        field.refresh();
        const least = app2.leastRadius(p.name);
        warning.hidden = least === null;
        if (least === null) return;
        grow.dataset.mm = String(Math.ceil(10.6 * least / unit) / 10);
        note.textContent = "The artwork is longer than this circle, and overlaps itself.";
        grow.textContent = `Let the circle grow to ${grow.dataset.mm} mm`;
      });
      const row = h("div", { class: "row" }, h("label", { for: input.id }, "Radius"), h("span", { class: "measure" }, input, h("span", { class: "unit" }, "mm")));
      return [row, field.message, warning];
    }
    flag(p, id, title) {
      const box = h("input", { type: "checkbox", id, role: "switch" });
      box.addEventListener("change", () => this.app.set(p.name, box.checked ? ["true"] : [], true));
      this.refreshers.push(() => box.checked = this.values(p)[0] === "true");
      return h("label", { class: "field switch", for: id, title }, h("span", {}, paramName(p)), box);
    }
    choice(p, id, label, title) {
      const all = p.words ?? [];
      const pictures = p.name === "glyphs";
      if (all.length > SIDE_BY_SIDE && !pictures) return h("div", { class: "field", title }, label, this.select(p, id));
      const options = all.map((word, i) => {
        const input = h("input", { type: "radio", name: id, value: word, id: `${id}-${i}` });
        input.addEventListener("change", () => this.app.set(p.name, [word], true));
        this.refreshers.push(() => input.checked = this.current(p) === word);
        return h("label", {}, input, h("span", {}, pictures && glyphs(word), words(word)));
      });
      return h("fieldset", { class: "field", title }, h("legend", {}, paramName(p)), h("div", { class: "segments" }, ...options));
    }
    /** Returns a row with a field for a number in the unit of its value, or else the usual one, and the line for its message. Arrow keys
     * change the value by `by`. */
    number(p, id, label, usual, by) {
      const isWhole = p.kind === "count";
      const unitLabel = h("span", { class: "unit" });
      const text = (q) => `${short(q.value)}${q.unit === "°" ? "" : q.unit}`;
      const present = () => {
        const typed = this.current(p);
        const unit2 = usual === "°" && !/[a-z]/i.test(typed) ? "°" : "";
        return typed === "" ? null : evaluate(typed, unit2);
      };
      const unit = () => present()?.unit ?? usual;
      const [least, most] = usual === "%" && p.kind === "number" ? [p.least && 100 * p.least, p.most && 100 * p.most] : [p.least, p.most];
      const isWrong = (typed) => {
        if (typed.trim() === "" && !p.needed) return null;
        const q = evaluate(typed, unit());
        const units = p.kind === "length" ? /^(%|px|mm|cm|m|in|pt|pc|q|)$/ : usual === "%" ? /^%?$/ : usual === "°" ? /^°$/ : /^$/;
        const fits = q && units.test(q.unit) && (!isWhole || Number.isInteger(q.value));
        return fits && q.value >= (least ?? -Infinity) && q.value <= (most ?? Infinity) ? null : describeLimits(unit(), least, most, isWhole);
      };
      const take = (typed) => typed.trim() === "" ? this.app.setTyped(p.name, []) : this.app.setTyped(p.name, [text(evaluate(typed, unit()))]);
      const nudge = (typed, times) => {
        if (isWrong(typed) !== null) return null;
        const derived = this.inUnit(p, usual, this.current(p));
        const q = evaluate(typed, unit()) ?? (derived === null ? null : { value: derived, unit: usual });
        if (!q) return null;
        const value = Math.min(Math.max(Number((q.value + times * by).toFixed(6)), least ?? -Infinity), most ?? Infinity);
        this.app.setSoon(p.name, [text({ value, unit: q.unit })]);
        return short(value);
      };
      const shown3 = () => {
        const q = present();
        return q ? short(q.value) : this.current(p);
      };
      const input = h("input", { type: "text", id, class: "value", inputmode: "decimal", spellcheck: false, autocomplete: "off", placeholder: "auto" });
      const field = new Field(input, shown3, take, isWrong, nudge);
      this.refreshers.push(() => {
        unitLabel.textContent = unit();
        field.refresh();
      });
      return [h("div", { class: "row" }, label, h("span", { class: "measure" }, input, unitLabel)), field.message];
    }
    /** Returns a button to choose a file. Pages do not learn its folder, so it is copied beside the drawing. */
    chooseFile(p) {
      const input = h("input", { type: "file", hidden: true, "aria-label": paramName(p) });
      onFile(input, async (file) => {
        const written = await bring(this.app, file);
        if (written) this.app.set(p.name, [written], true);
      });
      return h("span", {}, input, button({ class: "link", title: "A copy is put beside the drawing" }, () => input.click(), "Choose file…"));
    }
    select(p, id) {
      const select = h("select", { id }, ...(p.words ?? []).map((word) => h("option", { value: word }, words(word))));
      select.addEventListener("change", () => this.app.set(p.name, [select.value], true));
      this.refreshers.push(() => {
        const value = this.current(p);
        if (!(p.words ?? []).includes(value) && select.options[0]?.value !== value) {
          select.prepend(h("option", { value }, value || "—"));
        }
        select.value = value;
      });
      return select;
    }
    text(p, id) {
      const input = h("textarea", { id, rows: 1, spellcheck: false, placeholder: p.default ?? p.notation ?? "", "data-single": !p.repeat });
      const take = (typed) => {
        const text = typed.trim();
        return this.app.setTyped(p.name, text === "" ? [] : p.repeat ? text.split("\n").map((t) => t.trim()).filter(Boolean) : [text]);
      };
      const field = new Field(input, () => this.values(p).join("\n"), take);
      this.refreshers.push(() => {
        input.rows = Math.min(Math.max(this.values(p).length, 1), 4);
        field.refresh();
      });
      return h("div", {}, input, field.message);
    }
    /** Returns the slider of an adjust value. */
    adjust(p, all, i, title) {
      const { least, most, name, default: usual } = all[i];
      const [unit, size] = adjustUnit(all[i]);
      const id = `set-${p.name}-${name}`;
      const range = [Math.ceil(least / size), Math.floor(most / size)];
      const slider = h("input", { type: "range", id: `${id}-slider`, min: range[0], max: range[1], step: step(range), "aria-label": adjustName(all, i) });
      const input = h("input", { type: "text", id, class: "value", inputmode: "decimal", spellcheck: false, autocomplete: "off" });
      const sign = unit === "deg" ? "°" : unit;
      const present = () => {
        const adjusts = structuredClone(all);
        readAdjust(adjusts, this.values(p));
        return adjusts;
      };
      const values = (value) => {
        const adjusts = present();
        adjusts[i].value = Math.min(Math.max(value * size, least), most);
        return writeAdjust(adjusts);
      };
      const current = () => hundredths(present()[i].value / size);
      this.slide(slider, (value) => [p.name, values(value)], () => values(usual / size));
      const isWrong = (typed) => {
        const q = evaluate(typed || short(usual / size), sign);
        return q && q.unit === sign && q.value >= least / size && q.value <= most / size ? null : describeLimits(sign, hundredths(least / size), hundredths(most / size));
      };
      const take = (typed) => this.app.setTyped(p.name, values(evaluate(typed, sign)?.value ?? usual / size));
      const nudge = (typed, times) => {
        const q = isWrong(typed) === null ? evaluate(typed, sign) : null;
        if (!q) return null;
        this.app.setSoon(p.name, values(q.value + times));
        return short(current());
      };
      const field = new Field(input, () => short(current()), take, isWrong, nudge);
      this.refreshers.push(() => {
        field.refresh();
        if (!slider.matches(":active")) slider.value = String(current());
      });
      const label = h("label", { for: id, title }, adjustName(all, i));
      return h("div", { class: "field slider", title }, h("div", { class: "row" }, label, h("span", { class: "measure" }, input, h("span", { class: "unit" }, sign))), field.message, slider);
    }
    /** Connects a slider: a drag is one change, and so is a sequence of keys. `values` gives a parameter's name and values. */
    slide(slider, values, reset) {
      const { app: app2 } = this;
      let [isDragged2, isCancelled] = [false, false];
      slider.addEventListener("input", () => {
        if (!slider.matches(":active") || isCancelled) return;
        if (!isDragged2) {
          const step2 = app2.step;
          const before2 = structuredClone(step2);
          app2.cancelGesture = () => {
            isCancelled = true;
            app2.cancel(step2, before2);
          };
        }
        isDragged2 = true;
        app2.set(...values(Number(slider.value)), false);
        app2.tell("values");
      });
      slider.addEventListener("change", () => {
        app2.cancelGesture = null;
        if (isCancelled) this.refresh();
        else if (isDragged2) app2.set(...values(Number(slider.value)), true);
        else app2.setSoon(...values(Number(slider.value)));
        isDragged2 = isCancelled = false;
      });
      slider.addEventListener("dblclick", () => app2.set(values(0)[0], reset(), true));
    }
    slider(p, id, label, title) {
      const [unit, range] = this.app.isFirst(this.app.step) && p.kind === "length" ? ["%", p.slider] : scale(p);
      const slider = h("input", { type: "range", min: range[0], max: range[1], step: step(range), "aria-label": paramName(p), id: `${id}-slider` });
      this.slide(slider, (value) => [p.name, [`${short(value)}${unit}`]], () => []);
      this.refreshers.push(() => {
        if (slider.matches(":active")) return;
        const value = this.inUnit(p, unit, this.current(p));
        slider.min = String(Math.min(range[0], value ?? range[0]));
        slider.max = String(Math.max(range[1], value ?? range[1]));
        slider.value = String(value ?? range[0]);
        slider.classList.toggle("unset", value === null);
      });
      const [row, message] = this.number(p, id, label, p.kind === "angle" ? "°" : unit, range[1] - range[0] >= COARSE ? 1 : step(range));
      return h("div", { class: "field slider", title }, row, message, slider);
    }
    /** Returns the value of a parameter in the unit of its slider. */
    inUnit(p, unit, typed) {
      const plainNumber = Number(typed.replace(unit, ""));
      if (typed !== "" && Number.isFinite(plainNumber) && (unit === "" || typed.endsWith(unit))) return plainNumber;
      const value = this.app.grip(p.name)?.value;
      if (value === void 0) return null;
      if (p.kind !== "length") return unit === "%" ? 100 * value : value;
      const [, , w, h2] = this.app.grips[this.app.selected]?.frame ?? [0, 0, 1, 1];
      const whole = p.axis === "x" ? w : p.axis === "y" ? h2 : Math.hypot(w, h2);
      return 100 * value / whole;
    }
  };
  function glyphs(word) {
    const [radius, height, half] = [22, 13, 4.5];
    const letters = [-0.85, 0, 0.85].map((turn) => {
      const [sin, cos] = [Math.sin(turn), Math.cos(turn)];
      const along = ["rotate", "skew"].includes(word) ? [cos, sin] : [1, 0];
      const up = ["rotate", "ribbon"].includes(word) ? [sin, -cos] : [0, -1];
      const image = (x, y) => {
        const angle = turn + x / radius;
        return word === "bend" ? [(radius + y) * Math.sin(angle), -(radius + y) * Math.cos(angle)] : [radius * sin + x * along[0] + y * up[0], -radius * cos + x * along[1] + y * up[1]];
      };
      const line = (...points) => `M${points.map(([x, y]) => image(x, y).map((v) => v.toFixed(1)).join(",")).join("L")}`;
      const sides = [[-half, 0], [-half, height / 2], [-half, height], [0, height], [half, height], [half, height / 2], [half, 0]];
      return line(...sides) + line([-half, height / 2], [half, height / 2]);
    });
    return s("svg", { viewBox: "-34 -38 68 36", class: "glyphs", "aria-hidden": "true" }, s("path", { d: `M-20,-10A22,22 0 0 1 20,-10${letters.join("")}` }));
  }
  function isMain(p, isGiven) {
    switch (p.kind) {
      case "number":
      case "angle":
      case "choice":
      case "count":
        return p.default !== void 0 || isGiven;
      case "length":
      case "flag":
      case "file":
        return isGiven || p.kind === "length" && p.default !== void 0;
      case "name":
        return true;
      case "text":
        return p.needed || p.default !== void 0 || isGiven && !DRAGGED.has(p.notation ?? "");
      // Lines with any number of points are drawn from here.
      case "path":
        return p.points === "any" && isGiven;
      default:
        return false;
    }
  }
  function scale(p) {
    const [from, to] = p.slider;
    if (p.kind === "length") return ["%", p.least === void 0 && Number.parseFloat(p.default ?? "1") === 0 ? SHIFT_RANGE : LENGTH_RANGE];
    if (p.kind === "number" && p.default?.endsWith("%")) return ["%", [100 * from, 100 * to]];
    return ["", [from, to]];
  }
  function step([from, to]) {
    return 10 ** Math.floor(Math.log10(Math.max((to - from) / 400, 1e-9)));
  }
  function hundredths(value) {
    return Number(value.toFixed(2));
  }
  function sentence(title) {
    return `${capital(plain(title))}${/[.…]$/.test(title) ? "" : "."}`;
  }
  function plain(text) {
    return text.replace(/--([a-z-]+)/g, (_, name) => `“${words(name)}”`);
  }

  // src/sketch.ts
  var HINTS = {
    line: "Drag from the start of the line to its end",
    path: "Click the points of the path; a double click or Enter ends it, a click on the first point closes it",
    circle: "Drag from the centre of the circle to its edge",
    point: "Click where the words begin",
    round: "Click points around the outline, many where it is round; a click on the first one or Enter ends it"
  };
  var SAME_POINT = 8;
  var CORNER = 50;
  var [CIRCLE_START, CIRCLE_END] = [90, 450];
  var Sketching = class {
    constructor(app2, stage2) {
      this.app = app2;
      this.stage = stage2;
      stage2.overlay.append(this.line);
    }
    app;
    stage;
    line = s("path", { class: "lit" });
    stop = null;
    /** Draws, and calls `take` with path data, with `x,y` for a point, or with `arc:…` for a circle; Escape and undo cancel. */
    begin(kind, take) {
      this.end();
      const { app: app2, stage: stage2 } = this;
      const points = [];
      const stop = new AbortController();
      const listen = { signal: stop.signal, capture: true };
      const cancel = () => this.end();
      const hideHint = toast(HINTS[kind], true);
      this.stop = () => {
        stop.abort();
        hideHint();
        if (app2.cancelGesture === cancel) app2.cancelGesture = null;
      };
      app2.cancelGesture = cancel;
      stage2.svg.classList.add("picking");
      const done = (value) => {
        this.end();
        if (value) take(value);
      };
      const text = (p) => p.map(short).join(",");
      const isNear = (a, b) => Math.hypot(a[0] - b[0], a[1] - b[1]) < SAME_POINT * stage2.camera.pixel;
      const userPoint = (e) => stage2.camera.toUser(stage2.point(e));
      const path = (closed) => {
        if (kind === "round") return points.length < 3 ? null : smoothRing(points, text);
        return points.length < 2 ? null : `M${points.map(text).join(" L")}${closed ? " Z" : ""}`;
      };
      const isClicked = kind === "path" || kind === "round";
      stage2.svg.addEventListener("pointerdown", (e) => {
        if (e.button !== 0) return;
        e.stopPropagation();
        e.preventDefault();
        const at = userPoint(e);
        if (kind === "point") return done(text(at));
        if (isClicked && points.length > 2 && isNear(at, points[0])) return done(path(true));
        if (points.length === 0 || !isNear(at, points[points.length - 1])) points.push(at);
        this.show(kind, points, at);
      }, listen);
      stage2.svg.addEventListener("pointermove", (e) => this.show(kind, points, userPoint(e)), listen);
      window.addEventListener("pointerup", (e) => {
        if (isClicked || points.length === 0) return;
        const [from, to] = [points[0], userPoint(e)];
        if (isNear(from, to)) return void (points.length = 0);
        done(kind === "line" ? `M${text(from)} L${text(to)}` : arc([...from, Math.hypot(to[0] - from[0], to[1] - from[1]), CIRCLE_START, CIRCLE_END]));
      }, listen);
      stage2.svg.addEventListener("dblclick", (e) => {
        e.stopPropagation();
        if (isClicked) done(path(false));
      }, listen);
      window.addEventListener("keydown", (e) => {
        if (e.key !== "Escape" && e.key !== "Enter") return;
        e.stopPropagation();
        e.preventDefault();
        done(e.key === "Enter" && isClicked ? path(false) : null);
      }, listen);
    }
    show(kind, points, to) {
      if (points.length === 0) return;
      const onScreen = [...points, to].map((p) => this.stage.camera.toScreen(p));
      const [[x, y], [px, py]] = [onScreen[0], onScreen.at(-1)];
      const r = Math.hypot(px - x, py - y);
      const circle2 = `M${x - r},${y}a${r},${r} 0 1 1 ${2 * r},0a${r},${r} 0 1 1 ${-2 * r},0`;
      this.line.setAttribute("d", kind === "circle" ? circle2 : `M${onScreen.join("L")}`);
    }
    /** Ends drawing, or picking a path by a click: only one of them is under way at a time. */
    end() {
      this.stop?.();
      this.stop = null;
      this.line.setAttribute("d", "");
      this.stage.pick(null);
    }
  };
  function smoothRing(points, text) {
    const at = (i) => points[(i + points.length) % points.length];
    const minus = ([ax, ay], [bx, by]) => [ax - bx, ay - by];
    const tangent = (i) => {
      const [a, b] = [minus(at(i), at(i - 1)), minus(at(i + 1), at(i))];
      const turn = Math.atan2(a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1]);
      const [x, y] = minus(at(i + 1), at(i - 1));
      const length2 = Math.hypot(x, y) || 1;
      return Math.abs(turn) > CORNER * Math.PI / 180 ? [0, 0] : [x / length2, y / length2];
    };
    const pieces = points.map((p, i) => {
      const [q, s2, t] = [at(i + 1), tangent(i), tangent(i + 1)];
      const third = Math.hypot(...minus(q, p)) / 3;
      return `C${text([p[0] + third * s2[0], p[1] + third * s2[1]])} ${text([q[0] - third * t[0], q[1] - third * t[1]])} ${text(q)}`;
    });
    return `M${text(points[0])} ${pieces.join(" ")} Z`;
  }

  // src/steps.ts
  var CLICK_DISTANCE2 = 5;
  var Steps = class {
    constructor(app2) {
      this.app = app2;
      app2.listen(["steps", "state"], () => this.build());
      app2.listen(["report"], () => app2.gone.join() !== this.gone && this.build());
      this.add.addEventListener("click", () => this.append());
      this.list.addEventListener("dblclick", (e) => {
        const button2 = e.target.closest("button.step");
        if (button2) this.rename(Array.from(this.list.children).indexOf(button2.parentElement));
      });
    }
    app;
    list = byId("steps");
    /** The index to which a row has been moved, whose focus follows. */
    movedTo = null;
    /** The indices of the steps shown as lacking their letters. */
    gone = "";
    /** `true` while a row is dragged, which is not a click on its button. */
    isDragged = false;
    note = byId("steps-note");
    add = byId("add-step");
    /** Starts or ends the choice of a shape for another step. */
    append() {
      this.app.append(!this.app.appends);
      document.body.classList.toggle("shapes-open", this.app.appends);
      if (!this.app.appends) return;
      byId("gallery").scrollTop = 0;
      byId("search").focus();
    }
    build() {
      const { app: app2 } = this;
      const { steps, selected, appends } = app2;
      this.gone = app2.gone.join();
      const focused = this.list.contains(document.activeElement) ? document.activeElement : null;
      const kind = focused?.dataset.kind ?? "";
      const row = Array.from(this.list.children).indexOf(focused?.closest("li"));
      this.list.replaceChildren(...steps.map((step2, i) => this.row(step2, i)));
      const near = focused ? this.list.children[Math.min(this.movedTo ?? row, steps.length - 1)] : null;
      (near?.querySelector(`[data-kind="${kind}"]:enabled`) ?? near?.querySelector(".step"))?.focus();
      this.movedTo = null;
      if (appends) this.list.append(h("li", { class: "wanted" }, `${steps.length + 1}. Choose a shape`));
      this.add.setAttribute("aria-pressed", String(appends));
      this.note.hidden = selected >= steps.length - 1;
      byId("end").hidden = this.note.hidden;
      this.note.textContent = `The picture stops at step ${selected + 1}, so that you see what you drag. “End” (E) shows what all of them make. Saving uses all steps.`;
    }
    row(step2, i) {
      const { app: app2 } = this;
      const { steps, selected } = app2;
      const edits = steps.filter((s2) => app2.isFirst(s2)).length;
      const title = stepName(step2, app2.deformation(step2.deformation));
      const count = step2.select?.length ?? 0;
      const scope = count > 0 && h("small", { class: "muted" }, count === 1 ? " one part" : ` ${count} parts`);
      const gone = app2.gone.includes(i) && h("small", { class: "muted" }, count === 1 ? " (its letter is gone)" : " (its letters are gone)");
      const attributes = { class: "step", "data-kind": "step", title: "Drag it to move it, double-click to rename it", "aria-current": i === selected ? "step" : void 0 };
      const choose = button(attributes, () => this.isDragged || void app2.select(i), `${i + 1}. ${title}`, scope, gone);
      choose.addEventListener("pointerdown", (e) => this.drag(e, i, edits, moveTo));
      const moveTo = (to) => {
        this.movedTo = to;
        void app2.arrange(steps.toSpliced(i, 1).toSpliced(to, 0, step2), to);
      };
      const hide2 = () => void app2.arrange(steps.map((s2, k) => k === i ? { ...s2, hidden: !step2.hidden || void 0 } : s2), selected);
      const iconButton = (name, label, click, disabled = false) => button({ class: "small", "data-kind": name, "aria-label": label, title: label, disabled }, click, icon(name));
      const remove = () => void app2.arrange(steps.filter((_, k) => k !== i), steps.length - 2);
      return h(
        "li",
        { class: `${i === selected ? "chosen" : ""} ${step2.hidden ? "hidden" : ""}` },
        choose,
        !app2.isProposal && iconButton("eye", `${step2.hidden ? "Show" : "Hide"} ${title}`, hide2),
        steps.length > 1 && iconButton("up", `Move ${title} up`, () => moveTo(i - 1), i <= edits),
        steps.length > 1 && iconButton("down", `Move ${title} down`, () => moveTo(i + 1), i < edits || i === steps.length - 1),
        !app2.isProposal && iconButton("close", `Remove ${title}`, remove),
        !app2.isProposal && i === selected && h(
          "span",
          { class: "acts" },
          iconButton("pen", `Rename ${title}`, () => this.rename(i)),
          i >= edits && iconButton("copy", `Duplicate ${title}`, () => void app2.arrange(steps.toSpliced(i + 1, 0, structuredClone(step2)), i + 1))
        )
      );
    }
    /** Replaces a step's name by a field for another one. */
    rename(i) {
      const { app: app2 } = this;
      const [row, step2] = [this.list.children[i], app2.steps[i]];
      if (app2.isProposal || !row || !step2) return;
      const title = stepName(step2, app2.deformation(step2.deformation));
      const input = h("input", { type: "text", class: "step", "aria-label": `Name of ${title}`, maxlength: 60, value: title });
      const done = (name) => {
        const wanted = name.trim() === "" ? void 0 : name.trim();
        if (!input.isConnected) return;
        if (name === title) return this.build();
        void app2.arrange(app2.steps.map((s2) => s2 === step2 ? { ...s2, name: wanted } : s2), app2.selected);
      };
      input.addEventListener("blur", () => done(input.value));
      input.addEventListener("keydown", (e) => {
        if (e.key !== "Enter" && e.key !== "Escape") return;
        e.stopPropagation();
        if (e.key === "Escape") input.value = title;
        input.blur();
      });
      row.firstElementChild?.replaceWith(input);
      input.select();
    }
    /** Follows a pointer that moves a row among the edits, which come first, or among the deformations. */
    drag(e, i, edits, moveTo) {
      if (e.pointerType === "touch" || e.button !== 0 || this.app.isProposal) return;
      const rows = Array.from(this.list.children);
      const isAllowed = (k) => k < edits === i < edits && k < this.app.steps.length;
      this.isDragged = false;
      let to = i;
      const stop = new AbortController();
      window.addEventListener("pointermove", (event) => {
        if (event.pointerId !== e.pointerId) return;
        this.isDragged ||= Math.abs(event.clientY - e.clientY) > CLICK_DISTANCE2;
        if (!this.isDragged) return;
        const under = rows.findIndex((r, k) => isAllowed(k) && event.clientY < r.getBoundingClientRect().bottom);
        to = under >= 0 ? under : rows.findLastIndex((_, k) => isAllowed(k));
        rows.forEach((r, k) => {
          r.classList.toggle("above", k === to && to < i);
          r.classList.toggle("below", k === to && to > i);
        });
      }, stop);
      for (const end2 of ["pointerup", "pointercancel"]) {
        window.addEventListener(end2, () => {
          stop.abort();
          if (to !== i && end2 === "pointerup") moveTo(to);
        }, stop);
      }
    }
  };

  // src/main.ts
  var ZOOM = 1.25;
  var app = new App();
  var modes = new Modes();
  var stage = new Stage(app, modes);
  var report = new Report(app);
  var saving = new Saving(app);
  var settings = new Settings(app);
  new Presets(app, new Gallery(app));
  new Ground(app);
  new Steps(app);
  new Parts(app, stage, modes);
  new Place(app, stage);
  new Opening(app);
  var background = new Background(app, stage);
  new Pointing(app, stage, modes).onPan = () => report.panned();
  modes.onSnap = snapLines((p) => stage.camera.toScreen(p));
  stage.onLayout.push(() => {
    byId("zoom").textContent = `${Math.round(100 * stage.camera.scale)}%`;
  });
  stage.onLayout.push(() => caption.place());
  var sketching = new Sketching(app, stage);
  var caption = new Caption(app, stage, sketching);
  new WordsDialog(app).onPlace = (args) => caption.begin(args);
  settings.onDraw = (kind, take) => {
    closeSheets();
    sketching.begin(kind, take);
  };
  background.onOutline = (take) => sketching.begin("round", take);
  settings.onStepChange = () => sketching.end();
  settings.onPick = (take) => {
    closeSheets();
    sketching.end();
    stage.pick((path) => take(partOf(path.closest("[id]").id)), "Click a path of the drawing");
  };
  function on(id, action) {
    byId(id).addEventListener("click", action);
  }
  on("undo", () => void app.turn("undo"));
  on("redo", () => void app.turn("redo"));
  on("zoom-in", () => stage.zoom(ZOOM));
  on("zoom-out", () => stage.zoom(1 / ZOOM));
  on("fit", () => stage.fit());
  on("keys", showKeys);
  var phone = matchMedia("(max-width: 520px)");
  var arrange = () => byId(phone.matches ? "keep-preset" : "history").after(byId("start-over"));
  phone.addEventListener("change", arrange);
  arrange();
  on("start-over", async () => {
    await app.arrange([], 0);
    byId("undo").focus();
  });
  function toggle(id, get, set2) {
    const button2 = byId(id);
    const show2 = () => button2.setAttribute("aria-pressed", String(get()));
    const turn = () => {
      set2(!get());
      show2();
    };
    button2.addEventListener("click", turn);
    show2();
    return turn;
  }
  toggle("select", () => modes.selects, (v) => {
    modes.selects = v;
    stage.svg.classList.toggle("selecting", stage.isSelecting);
  });
  toggle("pick-parts", () => modes.picksParts, (v) => {
    modes.picksParts = v;
    if (v) byId("parts-list").open = true;
    for (const name of ["picking", "parts"]) stage.svg.classList.toggle(name, v);
  });
  toggle("snap", () => modes.snaps, (v) => modes.snaps = v);
  toggle("mirror", () => modes.mirrors, (v) => modes.mirrors = v);
  toggle("smooth", () => modes.smooths, (v) => modes.smooths = v);
  toggle("nodes", () => stage.showsNodes, (v) => {
    stage.showsNodes = v;
    stage.drawNodes();
  });
  var showFinalResult = toggle("end", () => stage.showsFinalResult, (v) => {
    stage.showsFinalResult = v;
    void stage.drawFinalResult();
  });
  toggle("stretch", () => stage.showsStretch, (v) => {
    stage.showsStretch = v;
    byId("legend").hidden = !v;
    void stage.drawStretch();
  });
  var SHEETS = { "shapes-open": "open-shapes", "settings-open": "open-settings" };
  var { classList } = document.body;
  var closeSheets = () => classList.remove(...Object.keys(SHEETS));
  for (const [sheet, button2] of Object.entries(SHEETS)) {
    on(button2, () => {
      const opens = !classList.contains(sheet);
      closeSheets();
      classList.toggle(sheet, opens);
    });
  }
  byId("stage").addEventListener("pointerdown", (e) => {
    if (!e.target.closest(".knob")) closeSheets();
  });
  var opened = "";
  new MutationObserver(() => {
    const now = Object.keys(SHEETS).find((sheet) => classList.contains(sheet)) ?? "";
    if (now === opened) return;
    opened = now;
    for (const [sheet, button2] of Object.entries(SHEETS)) byId(button2).setAttribute("aria-expanded", String(sheet === now));
    stage.fit();
  }).observe(document.body, { attributeFilter: ["class"] });
  var before = byId("before");
  var hide = () => void stage.showBefore(false);
  before.addEventListener("pointerdown", () => void stage.showBefore(true));
  for (const end2 of ["pointerup", "pointerleave", "pointercancel", "blur", "keyup"]) before.addEventListener(end2, hide);
  before.addEventListener("keydown", (e) => {
    if (e.key === " " || e.key === "Enter") void stage.showBefore(true);
  });
  function escape() {
    app.cancelGesture?.();
    stage.pick(null);
    if (app.appends) app.append(false);
  }
  var KEYS2 = {
    "+": () => stage.zoom(ZOOM),
    "=": () => stage.zoom(ZOOM),
    "-": () => stage.zoom(1 / ZOOM),
    "0": () => stage.fit(),
    b: () => void stage.showBefore(true),
    e: showFinalResult,
    "?": () => showKeys()
  };
  var COMMANDS2 = {
    s: (shift) => void (shift ? saving.open() : saving.save()),
    z: (shift) => void app.turn(shift ? "redo" : "undo"),
    y: () => void app.turn("redo")
  };
  window.addEventListener("keydown", (e) => {
    const key = e.key.toLowerCase();
    if (key === "escape") return escape();
    if (e.altKey || isTyping(e.target) && key !== "s") return;
    const isCommand = e.ctrlKey || e.metaKey;
    const action = isCommand ? COMMANDS2[key] : isTyping(e.target) ? void 0 : KEYS2[key];
    if (!action) return;
    if (isCommand) e.preventDefault();
    if (app.isLive && (!e.repeat || !"be".includes(key))) action(e.shiftKey);
  });
  window.addEventListener("keyup", (e) => {
    if (e.key.toLowerCase() === "b") hide();
  });
  window.addEventListener("blur", hide);
  window.addEventListener("beforeunload", (e) => {
    if (!app.isLive) return;
    void app.settle();
    if (saving.isUnsaved && (app.state?.program || app.state?.problem)) e.preventDefault();
  });
})();
