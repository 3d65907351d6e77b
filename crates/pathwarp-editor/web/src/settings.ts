// The settings of a step: one control for every parameter, made from the registry's table.

import type { App } from "./app";
import { byId, h } from "./dom";
import { capital, paramName, words } from "./names";
import { base64 } from "./opening";
import { toast } from "./toast";
import type { Adjust, Param } from "./types";
import { adjustName, adjustUnit, DRAGGED, readAdjust, short, writeAdjust } from "./values";

/** The sliders of lengths, in percentages of the artwork; shifts go both ways. */
const OF_ARTWORK: [number, number] = [0, 100];
const BOTH_WAYS: [number, number] = [-100, 100];
/** Choices of up to this many words are shown side by side. */
const SIDE_BY_SIDE = 3;

export class Settings {
  private box = byId("settings");
  private shown = "";
  private refreshers: (() => void)[] = [];

  /** Asks for the id of a path that is clicked on the canvas. */
  onPick: (take: (id: string) => void) => void = () => {};

  constructor(private app: App) {
    app.listen((change) => {
      if (change === "steps" || change === "state") this.build();
      if (change === "handles") this.build();
    });
  }

  private build(): void {
    const { step } = this.app;
    const deformation = this.app.deformation(step?.deformation);
    const params = deformation?.params ?? [];
    const signature = [this.app.selected, step?.deformation, ...this.adjusts(params)].join();
    if (signature === this.shown && this.box.childElementCount > 0) return this.refresh();
    this.shown = signature;
    this.refreshers = [];
    if (!step || !deformation) return this.box.replaceChildren();
    const main = params.filter((p) => isMain(p, step.args[p.name] !== undefined) || this.app.grip(p.name)?.adjust !== undefined);
    const more = params.filter((p) => !main.includes(p));
    const focused = this.box.contains(document.activeElement) ? document.activeElement?.id : undefined;
    this.box.replaceChildren(
      h("p", { class: "about" }, sentence(deformation.title)),
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
    const label = h("label", { for: id, title }, p.kind === "angle" ? `${paramName(p)} (°)` : paramName(p));
    const adjust = this.app.grip(p.name)?.adjust;
    if (adjust) return h("div", {}, ...adjust.map((_, i) => this.adjust(p, adjust, i, title)));
    switch (p.kind) {
      case "flag": return this.flag(p, id, title);
      case "choice": return this.choice(p, id, label, title);
      case "count": return h("div", { class: "field", title }, h("div", { class: "row" }, label, this.count(p, id)));
      case "file": return h("div", { class: "field", title }, h("div", { class: "row" }, label, this.chooseFile(p)), this.text(p, id));
      case "name": return h("div", { class: "field", title }, h("div", { class: "row" }, label, this.chooseFile(p)), this.select(p, id));
      case "number": case "length": case "angle": return this.slider(p, id, label, title);
      case "path": {
        const pick = h("button", { type: "button", class: "link", title: "Click a path of the drawing; it is then a guide and no artwork" }, "Pick from drawing");
        pick.addEventListener("click", () => this.onPick((name) => this.app.set(p.name, [`#${name}`], true)));
        return h("div", { class: "field", title }, h("div", { class: "row" }, label, pick), this.text(p, id));
      }
      default: return h("div", { class: "field", title }, label, this.text(p, id));
    }
  }

  private flag(p: Param, id: string, title: string): HTMLElement {
    const box = h("input", { type: "checkbox", id, role: "switch" });
    box.addEventListener("change", () => this.app.set(p.name, box.checked ? ["true"] : [], true));
    this.refreshers.push(() => (box.checked = this.values(p)[0] === "true"));
    return h("label", { class: "field switch", for: id, title }, h("span", {}, paramName(p)), box);
  }

  private choice(p: Param, id: string, label: HTMLElement, title: string): HTMLElement {
    const all = p.words ?? [];
    if (all.length > SIDE_BY_SIDE) return h("div", { class: "field", title }, label, this.select(p, id));
    const options = all.map((word, i) => {
      const input = h("input", { type: "radio", name: id, value: word, id: `${id}-${i}` });
      input.addEventListener("change", () => this.app.set(p.name, [word], true));
      this.refreshers.push(() => (input.checked = this.current(p) === word));
      return h("label", {}, input, h("span", {}, words(word)));
    });
    return h("fieldset", { class: "field", title }, h("legend", {}, paramName(p)), h("div", { class: "segments" }, ...options));
  }

  private count(p: Param, id: string): HTMLInputElement {
    const input = h("input", { type: "number", id, class: "value", step: 1, min: p.least, max: p.most, placeholder: p.default });
    input.addEventListener("change", () => this.app.set(p.name, input.value === "" ? [] : [input.value], true));
    this.refreshers.push(() => {
      if (document.activeElement !== input) input.value = this.current(p);
    });
    return input;
  }

  /** Chooses a file. Pages do not learn where it is, so a copy goes beside the drawing. */
  private chooseFile(p: Param): HTMLElement {
    const input = h("input", { type: "file", hidden: true, "aria-label": paramName(p) });
    input.addEventListener("change", async () => {
      const file = input.files?.[0];
      input.value = "";
      if (!file) return;
      const bytes = await base64(file);
      const answer = await this.app.attempt(() => this.app.connection.ask({ do: "bring", name: file.name, bytes }));
      if (!answer?.written) return;
      if (answer.copied) toast(`${file.name} was copied beside the drawing`);
      this.app.set(p.name, [answer.written], true);
    });
    const button = h("button", { type: "button", class: "link", title: "A copy is put beside the drawing" }, "Choose file…");
    button.addEventListener("click", () => input.click());
    return h("span", {}, input, button);
  }

  private select(p: Param, id: string): HTMLSelectElement {
    const select = h("select", { id }, ...(p.words ?? []).map((word) => h("option", { value: word }, words(word))));
    select.addEventListener("change", () => this.app.set(p.name, [select.value], true));
    this.refreshers.push(() => {
      const value = this.current(p);
      // A file stands before the names.
      if (!(p.words ?? []).includes(value) && select.options[0]?.value !== value) {
        select.prepend(h("option", { value }, value || "—"));
      }
      select.value = value;
    });
    return select;
  }

  private text(p: Param, id: string): HTMLElement {
    const input = h("textarea", { id, rows: 1, spellcheck: false, placeholder: p.default ?? p.notation ?? "" });
    input.addEventListener("change", () => {
      const text = input.value.trim();
      this.app.set(p.name, text === "" ? [] : p.repeat ? text.split("\n").map((t) => t.trim()).filter(Boolean) : [text], true);
    });
    input.addEventListener("keydown", (e) => {
      if (e.key === "Enter" && !p.repeat) {
        e.preventDefault();
        input.blur();
      }
    });
    this.refreshers.push(() => {
      if (document.activeElement === input) return;
      const values = this.values(p);
      input.value = values.join("\n");
      input.rows = Math.min(Math.max(values.length, 1), 4);
    });
    return input;
  }

  /** The names of the adjust values on show. */
  private adjusts(params: Param[]): string[] {
    return params.flatMap((p) => (this.app.grip(p.name)?.adjust ?? []).map((a) => `${a.name} ${a.least} ${a.most}`));
  }

  /** The slider of an adjust value. */
  private adjust(p: Param, all: Adjust[], i: number, title: string): HTMLElement {
    const { least, most, name } = all[i]!;
    const [unit, size] = adjustUnit(all[i]!);
    const id = `set-${p.name}-${name}`;
    const range: [number, number] = [Math.ceil(least / size), Math.floor(most / size)];
    const slider = h("input", { type: "range", id: `${id}-slider`, min: range[0], max: range[1], step: step(range), "aria-label": adjustName(all, i) });
    const field = h("input", { type: "text", id, class: "value", spellcheck: false, autocomplete: "off" });
    const take = (value: number, isDone: boolean) => {
      const present = structuredClone(all);
      readAdjust(present, this.values(p));
      present[i]!.value = Math.min(Math.max(value * size, least), most);
      this.app.set(p.name, writeAdjust(present), isDone);
    };
    slider.addEventListener("input", () => take(Number(slider.value), false));
    slider.addEventListener("change", () => take(Number(slider.value), true));
    slider.addEventListener("dblclick", () => take(all[i]!.default / size, true));
    field.addEventListener("change", () => {
      const value = Number.parseFloat(field.value.replace(",", "."));
      take(Number.isFinite(value) ? value : all[i]!.default / size, true);
    });
    this.refreshers.push(() => {
      const present = structuredClone(all);
      readAdjust(present, this.values(p));
      const value = Number((present[i]!.value! / size).toFixed(2));
      if (document.activeElement !== field) field.value = `${value}${unit === "deg" ? "°" : unit}`;
      if (document.activeElement !== slider || !slider.matches(":active")) slider.value = String(value);
    });
    const label = h("label", { for: id, title }, adjustName(all, i));
    return h("div", { class: "field slider", title }, h("div", { class: "row" }, label, field), slider);
  }

  private slider(p: Param, id: string, label: HTMLElement, title: string): HTMLElement {
    const [unit, range] = scale(p);
    const slider = h("input", { type: "range", min: range[0], max: range[1], step: step(range), "aria-label": paramName(p), id: `${id}-slider` });
    const field = h("input", { type: "text", id, class: "value", inputmode: "text", spellcheck: false, autocomplete: "off", placeholder: p.default ?? "auto" });
    slider.addEventListener("input", () => {
      field.value = `${short(Number(slider.value))}${unit}`;
      this.app.set(p.name, [field.value], false);
    });
    slider.addEventListener("change", () => this.app.set(p.name, [`${short(Number(slider.value))}${unit}`], true));
    field.addEventListener("change", () => this.app.set(p.name, field.value.trim() === "" ? [] : [field.value.trim()], true));
    field.addEventListener("keydown", (e) => {
      if (e.key === "Enter") field.blur();
    });
    this.refreshers.push(() => {
      const typed = this.current(p);
      if (document.activeElement !== field) field.value = typed;
      if (document.activeElement === slider && slider.matches(":active")) return;
      const value = this.inUnit(p, unit, typed);
      // A typed value may lie beyond; the slider then reaches as far.
      slider.min = String(Math.min(range[0], value ?? range[0]));
      slider.max = String(Math.max(range[1], value ?? range[1]));
      slider.value = String(value ?? range[0]);
      slider.classList.toggle("unset", value === null);
    });
    const reset = () => this.app.set(p.name, [], true);
    slider.addEventListener("dblclick", reset);
    return h("div", { class: "field slider", title }, h("div", { class: "row" }, label, field), slider);
  }

  /** The value of a parameter in the unit of its slider. */
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

/** The settings that are looked at first: those that do something. Paths and points are dragged, and the rest has its place below. */
function isMain(p: Param, isGiven: boolean): boolean {
  switch (p.kind) {
    case "number": case "angle": case "choice": case "count": return p.default !== undefined || isGiven;
    case "length": case "flag": case "file": return isGiven || (p.kind === "length" && p.default !== undefined);
    case "name": return true;
    case "text": return p.needed || p.default !== undefined || (isGiven && !DRAGGED.has(p.notation ?? ""));
    default: return false;
  }
}

/** The unit and range of a slider. */
function scale(p: Param): [string, [number, number]] {
  const [from, to] = p.slider;
  if (p.kind === "length") return ["%", p.least === undefined && Number.parseFloat(p.default ?? "1") === 0 ? BOTH_WAYS : OF_ARTWORK];
  if (p.kind === "number" && p.default?.endsWith("%")) return ["%", [100 * from, 100 * to]];
  return ["", [from, to]];
}

/** A step of a slider: about a thousandth of its range, a round number. */
function step([from, to]: [number, number]): number {
  const raw = (to - from) / 400;
  return 10 ** Math.floor(Math.log10(Math.max(raw, 1e-9)));
}

/** A title as a sentence. */
function sentence(title: string): string {
  return `${capital(plain(title))}${/[.…]$/.test(title) ? "" : "."}`;
}

function plain(text: string): string {
  return text.replace(/--([a-z-]+)/g, (_, name: string) => `“${words(name)}”`);
}
