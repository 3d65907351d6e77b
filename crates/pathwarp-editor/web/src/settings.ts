// The settings of a step: a control for each parameter, made from the registry's table.

import type { App } from "./app";
import { button, byId, h, onFile, s } from "./dom";
import { describeLimits, evaluate, Field, inUnits, MM, type Quantity } from "./fields";
import { capital, isCaption, paramName, words } from "./names";
import { bring } from "./opening";
import type { Sketch } from "./sketch";
import type { Adjust, Param } from "./types";
import { BUNDLED } from "./words";
import { adjustName, adjustUnit, arc, DRAGGED, readAdjust, short, writeAdjust } from "./values";

/** The range of sliders for lengths, in percent of the artwork; shifts may be negative, too. */
const LENGTH_RANGE: [number, number] = [0, 100];
const SHIFT_RANGE: [number, number] = [-100, 100];
/** Ranges of at least this width let arrow keys change values by 1. */
const COARSE = 20;
/** Hints on unexpected behaviour of some deformations. */
const NOTES: Record<string, string> = { mls: " Pins pull everything around them, also across gaps; pick a part to move it alone." };
/** Most words of a choice that are shown side by side. */
const SIDE_BY_SIDE = 3;

/** Descriptions of how to draw a line. */
const SKETCHES = {
  line: "Drag from its start to its end on the drawing",
  path: "Click its points on the drawing; a double click, Enter or the first point ends it",
  circle: "Drag from its centre to its edge on the drawing",
} satisfies Partial<Record<Sketch, string>>;

export class Settings {
  private box = byId("settings");
  /** Identifies the controls that have been built: step, deformation, adjust values, circles. */
  private builtFor = "";
  /** Functions that show present values in the controls. */
  private refreshers: (() => void)[] = [];

  /** Asks for a path on the canvas; a click returns its id. */
  onPick: (take: (id: string) => void) => void = () => {};
  /** Asks for a line drawn on the canvas. */
  onDraw: (kind: Sketch, take: (value: string) => void) => void = () => {};
  /** Called when the settings of another step are shown. */
  onStepChange: () => void = () => {};

  constructor(private app: App) {
    app.listen(["steps", "state", "handles"], () => this.build());
    app.listen(["values"], () => this.refresh());
  }

  private build(): void {
    const { step } = this.app;
    const deformation = this.app.deformation(step?.deformation);
    const params = deformation?.params ?? [];
    const circles = params.filter((p) => this.app.grip(p.name)?.circle).map((p) => p.name);
    const adjusts = params.flatMap((p) => (this.app.grip(p.name)?.adjust ?? []).map((a) => `${a.name} ${a.least} ${a.most}`));
    const signature = [this.app.selected, step?.deformation, ...adjusts, ...circles].join();
    if (signature === this.builtFor && this.box.childElementCount > 0) return this.refresh();
    this.builtFor = signature;
    this.onStepChange();
    this.refreshers = [];
    if (!step || !deformation) return this.box.replaceChildren();
    const main = params.filter((p) => (isCaption(step) && p.kind !== "point") || isMain(p, step.args[p.name] !== undefined) || this.app.grip(p.name)?.adjust !== undefined);
    const more = params.filter((p) => !main.includes(p));
    const focused = this.box.contains(document.activeElement) ? document.activeElement?.id : undefined;
    this.box.replaceChildren(
      h("p", { class: "about" }, sentence(deformation.title), NOTES[deformation.name] ?? ""),
      ...main.map((p) => this.control(p)),
      more.length > 0 ? h("details", { class: "more" }, h("summary", {}, "More settings"), ...more.map((p) => this.control(p))) : "",
    );
    this.refresh();
    if (focused) document.getElementById(focused)?.focus();
  }

  private refresh(): void {
    for (const refresh of this.refreshers) refresh();
  }

  private values(p: Param): string[] {
    return this.app.step?.args[p.name] ?? [];
  }

  private current(p: Param): string {
    return this.values(p)[0] ?? p.default ?? "";
  }

  private control(p: Param): HTMLElement {
    const id = `set-${p.name}`;
    const title = plain(p.help);
    const label = h("label", { for: id, title }, paramName(p));
    const adjust = this.app.grip(p.name)?.adjust;
    if (adjust) return h("div", {}, ...adjust.map((_, i) => this.adjust(p, adjust, i, title)));
    switch (p.kind) {
      case "flag": return this.flag(p, id, title);
      case "choice": return this.choice(p, id, label, title);
      case "count": return h("div", { class: "field", title }, ...this.number(p, id, label, "", 1));
      case "file": return h("div", { class: "field", title }, h("div", { class: "row" }, label, this.chooseFile(p)), this.text(p, id));
      case "name": return h("div", { class: "field", title }, h("div", { class: "row" }, label, this.chooseFile(p)), this.select(p, id));
      case "number": case "length": case "angle": return this.slider(p, id, label, title);
      case "path": {
        const set = (value: string) => this.app.set(p.name, [value], true);
        const pick = button({ class: "link", title: "Click a path of the drawing; it is then a guide and no artwork" }, () => this.onPick((name) => set(`#${name}`)), "Pick from drawing");
        const draws = (["line", "path", "circle"] as const).map((kind) => button({ class: "link", title: SKETCHES[kind] }, () => this.onDraw(kind, set), `Draw ${kind}`));
        const radius = this.app.grip(p.name)?.circle && this.radius(p, id);
        return h("div", { class: "field", title }, h("div", { class: "row" }, label, pick), h("div", { class: "row draws" }, ...draws), ...(radius || []), this.text(p, id));
      }
      default: {
        if (p.notation === "FAMILY") return h("div", { class: "field", title }, label, this.family(p, id));
        return h("div", { class: "field", title }, h("div", { class: "row" }, label, p.notation === "COLOUR" && this.colour(p)), this.text(p, id));
      }
    }
  }

  private colour(p: Param): HTMLElement {
    const input = h("input", { type: "color", "aria-label": `${paramName(p)}, chosen` });
    input.addEventListener("input", () => this.app.setSoon(p.name, [input.value]));
    this.refreshers.push(() => (input.value = /^#[0-9a-f]{6}$/i.test(this.current(p)) ? this.current(p) : "#000000"));
    return input;
  }

  /** Returns the choice of installed fonts. */
  private family(p: Param, id: string): HTMLElement {
    const select = h("select", { id }, h("option", { value: "" }, BUNDLED));
    select.addEventListener("change", () => this.app.set(p.name, select.value ? [select.value] : [], true));
    const show = () => {
      const value = this.current(p);
      if (!Array.from(select.options).some((o) => o.value === value)) select.append(h("option", { value }, value));
      select.value = value;
    };
    this.refreshers.push(show);
    void this.app.request({ do: "families" }).then((answer) => {
      select.append(...(answer?.families ?? []).map((name) => h("option", { value: name }, name)));
      show();
    });
    return select;
  }

  /** Returns a field for the radius of a circle in mm, with a warning if the artwork is longer than the circle. */
  private radius(p: Param, id: string): HTMLElement[] {
    const { app } = this;
    const [a, b] = app.state?.toPx ?? [1, 0];
    const unit = MM / Math.hypot(a, b);
    const circle = () => app.grip(p.name)?.circle;
    const input = h("input", { type: "text", id: `${id}-radius`, class: "value", inputmode: "decimal", autocomplete: "off" });
    const number = (text: string) => inUnits(text, "mm") ?? NaN;
    const set = (mm: number) => {
      const present = circle();
      return present ? app.setTyped(p.name, [arc([present[0], present[1], mm * unit, present[3], present[4]])]) : null;
    };
    const field = new Field(input, () => hundredths((circle()?.[2] ?? 0) / unit).toString(), (text) => set(number(text)), (text) => (number(text) > 0 ? null : describeLimits("mm", 0)));
    const note = h("p", { class: "wrong", role: "status" });
    const grow = button({ class: "link" }, () => void set(Number(grow.dataset.mm)));
    const warning = h("div", { hidden: true }, note, grow);
    this.refreshers.push(() => {
      field.refresh();
      const least = app.leastRadius(p.name);
      warning.hidden = least === null;
      if (least === null) return;
      // Leave a gap between the end and the beginning.
      grow.dataset.mm = String(Math.ceil((10.6 * least) / unit) / 10);
      note.textContent = "The artwork is longer than this circle, and overlaps itself.";
      grow.textContent = `Let the circle grow to ${grow.dataset.mm} mm`;
    });
    const row = h("div", { class: "row" }, h("label", { for: input.id }, "Radius"), h("span", { class: "measure" }, input, h("span", { class: "unit" }, "mm")));
    return [row, field.message, warning];
  }

  private flag(p: Param, id: string, title: string): HTMLElement {
    const box = h("input", { type: "checkbox", id, role: "switch" });
    box.addEventListener("change", () => this.app.set(p.name, box.checked ? ["true"] : [], true));
    this.refreshers.push(() => (box.checked = this.values(p)[0] === "true"));
    return h("label", { class: "field switch", for: id, title }, h("span", {}, paramName(p)), box);
  }

  private choice(p: Param, id: string, label: HTMLElement, title: string): HTMLElement {
    const all = p.words ?? [];
    const pictures = p.name === "glyphs";
    if (all.length > SIDE_BY_SIDE && !pictures) return h("div", { class: "field", title }, label, this.select(p, id));
    const options = all.map((word, i) => {
      const input = h("input", { type: "radio", name: id, value: word, id: `${id}-${i}` });
      input.addEventListener("change", () => this.app.set(p.name, [word], true));
      this.refreshers.push(() => (input.checked = this.current(p) === word));
      return h("label", {}, input, h("span", {}, pictures && glyphs(word), words(word)));
    });
    return h("fieldset", { class: "field", title }, h("legend", {}, paramName(p)), h("div", { class: "segments" }, ...options));
  }

  /** Returns a row with a field for a number in the unit of its value, or else the usual one, and the line for its message. Arrow keys
   * change the value by `by`. */
  private number(p: Param, id: string, label: HTMLElement, usual: string, by: number): [HTMLElement, HTMLElement] {
    const isWhole = p.kind === "count";
    const unitLabel = h("span", { class: "unit" });
    // The program's values of angles and whole numbers have no unit.
    const text = (q: Quantity) => `${short(q.value)}${q.unit === "°" ? "" : q.unit}`;
    const present = (): Quantity | null => {
      const typed = this.current(p);
      const unit = usual === "°" && !/[a-z]/i.test(typed) ? "°" : "";
      return typed === "" ? null : evaluate(typed, unit);
    };
    const unit = () => present()?.unit ?? usual;
    const [least, most] = usual === "%" && p.kind === "number" ? [p.least && 100 * p.least, p.most && 100 * p.most] : [p.least, p.most];
    const isWrong = (typed: string): string | null => {
      if (typed.trim() === "" && !p.needed) return null;
      const q = evaluate(typed, unit());
      const units = p.kind === "length" ? /^(%|px|mm|cm|m|in|pt|pc|q|)$/ : usual === "%" ? /^%?$/ : usual === "°" ? /^°$/ : /^$/;
      const fits = q && units.test(q.unit) && (!isWhole || Number.isInteger(q.value));
      return fits && q.value >= (least ?? -Infinity) && q.value <= (most ?? Infinity) ? null : describeLimits(unit(), least, most, isWhole);
    };
    const take = (typed: string) => (typed.trim() === "" ? this.app.setTyped(p.name, []) : this.app.setTyped(p.name, [text(evaluate(typed, unit())!)]));
    const nudge = (typed: string, times: number): string | null => {
      if (isWrong(typed) !== null) return null;
      const derived = this.inUnit(p, usual, this.current(p));
      const q = evaluate(typed, unit()) ?? (derived === null ? null : { value: derived, unit: usual });
      if (!q) return null;
      const value = Math.min(Math.max(Number((q.value + times * by).toFixed(6)), least ?? -Infinity), most ?? Infinity);
      this.app.setSoon(p.name, [text({ value, unit: q.unit })]);
      return short(value);
    };
    const shown = () => {
      const q = present();
      return q ? short(q.value) : this.current(p);
    };
    const input = h("input", { type: "text", id, class: "value", inputmode: "decimal", spellcheck: false, autocomplete: "off", placeholder: "auto" });
    const field = new Field(input, shown, take, isWrong, nudge);
    this.refreshers.push(() => {
      unitLabel.textContent = unit();
      field.refresh();
    });
    return [h("div", { class: "row" }, label, h("span", { class: "measure" }, input, unitLabel)), field.message];
  }

  /** Returns a button to choose a file. Pages do not learn its folder, so it is copied beside the drawing. */
  private chooseFile(p: Param): HTMLElement {
    const input = h("input", { type: "file", hidden: true, "aria-label": paramName(p) });
    onFile(input, async (file) => {
      const written = await bring(this.app, file);
      if (written) this.app.set(p.name, [written], true);
    });
    return h("span", {}, input, button({ class: "link", title: "A copy is put beside the drawing" }, () => input.click(), "Choose file…"));
  }

  private select(p: Param, id: string): HTMLSelectElement {
    const select = h("select", { id }, ...(p.words ?? []).map((word) => h("option", { value: word }, words(word))));
    select.addEventListener("change", () => this.app.set(p.name, [select.value], true));
    this.refreshers.push(() => {
      const value = this.current(p);
      // A file is listed before the names.
      if (!(p.words ?? []).includes(value) && select.options[0]?.value !== value) {
        select.prepend(h("option", { value }, value || "—"));
      }
      select.value = value;
    });
    return select;
  }

  private text(p: Param, id: string): HTMLElement {
    const input = h("textarea", { id, rows: 1, spellcheck: false, placeholder: p.default ?? p.notation ?? "", "data-single": !p.repeat });
    const take = (typed: string) => {
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
  private adjust(p: Param, all: Adjust[], i: number, title: string): HTMLElement {
    const { least, most, name, default: usual } = all[i]!;
    const [unit, size] = adjustUnit(all[i]!);
    const id = `set-${p.name}-${name}`;
    const range: [number, number] = [Math.ceil(least / size), Math.floor(most / size)];
    const slider = h("input", { type: "range", id: `${id}-slider`, min: range[0], max: range[1], step: step(range), "aria-label": adjustName(all, i) });
    const input = h("input", { type: "text", id, class: "value", inputmode: "decimal", spellcheck: false, autocomplete: "off" });
    const sign = unit === "deg" ? "°" : unit;
    const present = () => {
      const adjusts = structuredClone(all);
      readAdjust(adjusts, this.values(p));
      return adjusts;
    };
    const values = (value: number) => {
      const adjusts = present();
      adjusts[i]!.value = Math.min(Math.max(value * size, least), most);
      return writeAdjust(adjusts);
    };
    const current = () => hundredths(present()[i]!.value! / size);
    this.slide(slider, (value) => [p.name, values(value)], () => values(usual / size));
    const isWrong = (typed: string) => {
      const q = evaluate(typed || short(usual / size), sign);
      return q && q.unit === sign && q.value >= least / size && q.value <= most / size ? null : describeLimits(sign, hundredths(least / size), hundredths(most / size));
    };
    const take = (typed: string) => this.app.setTyped(p.name, values(evaluate(typed, sign)?.value ?? usual / size));
    const nudge = (typed: string, times: number) => {
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
  private slide(slider: HTMLInputElement, values: (value: number) => [string, string[]], reset: () => string[]): void {
    const { app } = this;
    let [isDragged, isCancelled] = [false, false];
    slider.addEventListener("input", () => {
      if (!slider.matches(":active") || isCancelled) return;
      if (!isDragged) {
        const step = app.step!;
        const before = structuredClone(step);
        app.cancelGesture = () => {
          isCancelled = true;
          app.cancel(step, before);
        };
      }
      isDragged = true;
      app.set(...values(Number(slider.value)), false);
      app.tell("values");
    });
    slider.addEventListener("change", () => {
      app.cancelGesture = null;
      if (isCancelled) this.refresh();
      else if (isDragged) app.set(...values(Number(slider.value)), true);
      else app.setSoon(...values(Number(slider.value)));
      isDragged = isCancelled = false;
    });
    slider.addEventListener("dblclick", () => app.set(values(0)[0], reset(), true));
  }

  private slider(p: Param, id: string, label: HTMLElement, title: string): HTMLElement {
    const [unit, range] = this.app.isFirst(this.app.step) && p.kind === "length" ? ["%", p.slider] as const : scale(p);
    const slider = h("input", { type: "range", min: range[0], max: range[1], step: step(range), "aria-label": paramName(p), id: `${id}-slider` });
    this.slide(slider, (value) => [p.name, [`${short(value)}${unit}`]], () => []);
    this.refreshers.push(() => {
      if (slider.matches(":active")) return;
      const value = this.inUnit(p, unit, this.current(p));
      // A typed value may exceed the range, which the slider then includes.
      slider.min = String(Math.min(range[0], value ?? range[0]));
      slider.max = String(Math.max(range[1], value ?? range[1]));
      slider.value = String(value ?? range[0]);
      slider.classList.toggle("unset", value === null);
    });
    const [row, message] = this.number(p, id, label, p.kind === "angle" ? "°" : unit, range[1] - range[0] >= COARSE ? 1 : step(range));
    return h("div", { class: "field slider", title }, row, message, slider);
  }

  /** Returns the value of a parameter in the unit of its slider. */
  private inUnit(p: Param, unit: string, typed: string): number | null {
    const plainNumber = Number(typed.replace(unit, ""));
    if (typed !== "" && Number.isFinite(plainNumber) && (unit === "" || typed.endsWith(unit))) return plainNumber;
    const value = this.app.grip(p.name)?.value;
    if (value === undefined) return null;
    if (p.kind !== "length") return unit === "%" ? 100 * value : value;
    const [, , w, h] = this.app.grips[this.app.selected]?.frame ?? [0, 0, 1, 1];
    const whole = p.axis === "x" ? w : p.axis === "y" ? h : Math.hypot(w, h);
    return (100 * value) / whole;
  }
}

/** Draws three letters H on an arc, as placed by an option of `glyphs`. */
function glyphs(word: string): SVGSVGElement {
  const [radius, height, half] = [22, 13, 4.5];
  // Angles on the arc from its top, in radians.
  const letters = [-0.85, 0, 0.85].map((turn) => {
    const [sin, cos] = [Math.sin(turn), Math.cos(turn)];
    const along = ["rotate", "skew"].includes(word) ? [cos, sin] : [1, 0];
    const up = ["rotate", "ribbon"].includes(word) ? [sin, -cos] : [0, -1];
    const image = (x: number, y: number) => {
      const angle = turn + x / radius;
      return word === "bend" ? [(radius + y) * Math.sin(angle), -(radius + y) * Math.cos(angle)] : [radius * sin + x * along[0]! + y * up[0]!, -radius * cos + x * along[1]! + y * up[1]!];
    };
    const line = (...points: [number, number][]) => `M${points.map(([x, y]) => image(x, y).map((v) => v.toFixed(1)).join(",")).join("L")}`;
    const sides: [number, number][] = [[-half, 0], [-half, height / 2], [-half, height], [0, height], [half, height], [half, height / 2], [half, 0]];
    return line(...sides) + line([-half, height / 2], [half, height / 2]);
  });
  return s("svg", { viewBox: "-34 -38 68 36", class: "glyphs", "aria-hidden": "true" }, s("path", { d: `M-20,-10A22,22 0 0 1 20,-10${letters.join("")}` }));
}

/** Returns `true` for settings that are shown first, since they have an effect. Paths and points are dragged; the others are below. */
function isMain(p: Param, isGiven: boolean): boolean {
  switch (p.kind) {
    case "number": case "angle": case "choice": case "count": return p.default !== undefined || isGiven;
    case "length": case "flag": case "file": return isGiven || (p.kind === "length" && p.default !== undefined);
    case "name": return true;
    case "text": return p.needed || p.default !== undefined || (isGiven && !DRAGGED.has(p.notation ?? ""));
    // Lines with any number of points are drawn from here.
    case "path": return p.points === "any" && isGiven;
    default: return false;
  }
}

/** Returns the unit and the range of a slider. */
function scale(p: Param): [string, [number, number]] {
  const [from, to] = p.slider;
  if (p.kind === "length") return ["%", p.least === undefined && Number.parseFloat(p.default ?? "1") === 0 ? SHIFT_RANGE : LENGTH_RANGE];
  if (p.kind === "number" && p.default?.endsWith("%")) return ["%", [100 * from, 100 * to]];
  return ["", [from, to]];
}

/** Returns the step of a slider: the largest power of ten of which its range has at least 400. */
function step([from, to]: [number, number]): number {
  return 10 ** Math.floor(Math.log10(Math.max((to - from) / 400, 1e-9)));
}

/** Rounds to two decimals. */
function hundredths(value: number): number {
  return Number(value.toFixed(2));
}

/** Converts a title to a sentence. */
function sentence(title: string): string {
  return `${capital(plain(title))}${/[.…]$/.test(title) ? "" : "."}`;
}

/** Replaces options of the command line by the names of their settings. */
function plain(text: string): string {
  return text.replace(/--([a-z-]+)/g, (_, name: string) => `“${words(name)}”`);
}
