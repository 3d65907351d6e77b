// The parts of the drawing: a list of its groups and shapes. A step applies to all of them or to those selected, here or by clicks on the
// drawing; locked parts stay unchanged.

import type { App } from "./app";
import { button, byId, h, icon } from "./dom";
import type { Modes } from "./modes";
import { capital, isCaption } from "./names";
import type { Stage } from "./stage";
import type { Part } from "./types";

/** Terms for elements. */
const ELEMENTS: Record<string, string> = { g: "group", a: "link", svg: "drawing", use: "copy", image: "picture", rect: "rectangle" };

export class Parts {
  private list = byId("parts");
  private details = byId<HTMLDetailsElement>("parts-list");
  private scope = byId("parts-scope");
  private all: Part[] = [];
  private rows: HTMLLIElement[] = [];
  /** The names of parts hidden on the page; the file contains them regardless. */
  private hidden = new Set<string>();
  /** The drawing and its captions, as JSON, whose parts are listed. */
  private listed = "";
  private file = "";

  constructor(private app: App, private stage: Stage, private modes: Modes) {
    app.listen(["state"], () => void this.load());
    app.listen(["steps"], () => this.show());
    byId("parts-all").addEventListener("click", () => void app.scope([]));
    stage.onPart = (name, adds) => this.clicked(name, adds);
  }

  private async load(): Promise<void> {
    const { drawing = "", file = "", steps = [] } = this.app.state ?? {};
    const listed = JSON.stringify([drawing, ...steps.filter(isCaption)]);
    if (listed === this.listed) return;
    this.listed = listed;
    // Other words have letters of the same names, which stay hidden.
    if (file !== this.file) this.hidden.clear();
    this.file = file;
    this.all = (await this.app.request({ do: "parts" }))?.parts ?? [];
    this.stage.parts = new Set(this.all.map(({ name }) => name));
    this.rows = this.all.map((part) => this.row(part));
    this.list.replaceChildren(...this.rows);
    this.hideOnCanvas();
    this.show();
  }

  private row(part: Part): HTMLLIElement {
    const title = part.label ?? part.name.replace(/^([a-z]+)(.*) at \d+:\d+$/i, (_, tag: string, letter: string) => capital((ELEMENTS[tag] ?? tag) + letter));
    const choose = button({ class: "part-name", title: part.name }, (e) => this.toggle(part, e.shiftKey || e.ctrlKey || e.metaKey), title);
    choose.addEventListener("pointerenter", () => this.stage.outlineParts([part, ...this.contentsOf(part)].map(({ name }) => name)));
    choose.addEventListener("pointerleave", () => this.show());
    const iconButton = (kind: "eye" | "lock", label: string, click: () => void) =>
      button({ class: `small ${kind}`, "aria-label": `${label} ${title}`, title: `${label} ${title}` }, click, icon(kind));
    const row = h(
      "li", {}, choose,
      iconButton("eye", "Hide here:", () => this.hide(part)),
      iconButton("lock", "Lock:", () => void this.lock(part)),
    );
    row.style.setProperty("--depth", String(Math.min(part.depth, 8)));
    return row;
  }

  /** Returns the contents of a group, which follow it in the list. */
  private contentsOf(part: Part): Part[] {
    const after = this.all.slice(this.all.indexOf(part) + 1);
    const end = after.findIndex(({ depth }) => depth <= part.depth);
    return end < 0 ? after : after.slice(0, end);
  }

  private clicked(name: string | null, adds: boolean): void {
    const part = this.all.find((p) => p.name === name);
    if (part) this.toggle(part, adds);
    else if (!adds) void this.app.scope([]);
  }

  /** Returns `true` if a part is locked or hidden, or belongs to a group that is. */
  private isOut(part: Part): boolean {
    const isOut = ({ name, selector }: Part) => this.hidden.has(name) || this.app.locks.includes(selector);
    return this.all.some((p) => isOut(p) && (p === part || this.contentsOf(p).includes(part)));
  }

  /** Selects a part alone, or adds it to the selection, or removes it. */
  private toggle(part: Part, adds: boolean): void {
    const { selectors: chosen } = this.app;
    const { selector } = part;
    const others = chosen.filter((s) => s !== selector);
    const isChosen = others.length < chosen.length;
    if (!isChosen && this.isOut(part)) return;
    if (!adds) void this.app.scope(isChosen && others.length === 0 ? [] : [selector]);
    else void this.app.scope(isChosen ? others : [...others, selector]);
  }

  private hide(part: Part): void {
    if (!this.hidden.delete(part.name)) this.hidden.add(part.name);
    this.show();
    this.hideOnCanvas();
  }

  /** Locks or unlocks a part. No step bends locked parts. */
  private lock({ selector }: Part): Promise<void> {
    const { locks } = this.app;
    return this.app.lock(locks.includes(selector) ? locks.filter((s) => s !== selector) : [...locks, selector]);
  }

  private show(): void {
    const { selectors: chosen, locks } = this.app;
    const hides = this.all.length < 2 || this.app.isFirst(this.app.step);
    byId("parts-box").hidden = hides;
    // End the mode if its button is hidden, since users could not.
    if (hides && this.modes.picksParts) byId("pick-parts").click();
    this.all.forEach((part, i) => {
      const pressed = [chosen.includes(part.selector), this.hidden.has(part.name), locks.includes(part.selector)];
      pressed.forEach((on, k) => this.rows[i]?.children[k]?.setAttribute("aria-pressed", String(on)));
    });
    const count = chosen.length;
    this.scope.textContent = count === 0 ? "This step bends everything." : `This step bends ${count === 1 ? "one part" : `${count} parts`}.`;
    byId("parts-all").hidden = count === 0;
    if (count > 0 || locks.length > 0) this.details.open = true;
    const selected = this.all.filter(({ selector }) => chosen.includes(selector));
    this.stage.outlineParts(this.modes.picksParts || this.details.open ? selected.flatMap((p) => [p, ...this.contentsOf(p)]).map(({ name }) => name) : []);
  }

  /** Hides the hidden parts on the canvas. */
  private hideOnCanvas(): void {
    const hidden = new Set(this.all.filter(({ name }) => this.hidden.has(name)).flatMap((p) => [p, ...this.contentsOf(p)]).map(({ name }) => name));
    this.stage.hideParts(hidden);
  }
}
