// The canvas: the drawing, the handles over it, and their reactions to pointers and keys.

import type { App } from "./app";
import { Camera } from "./camera";
import { byId, s } from "./dom";
import { apart, Drawing } from "./drawing";
import { cells } from "./heat";
import { Modes } from "./modes";
import { Selection, together } from "./selection";
import { nodesOf } from "./nodes";
import { paramName } from "./names";
import { toast } from "./toast";
import type { Answer, Handle, XY } from "./types";

/** Margin around the drawing when it fits the view, in px. */
const MARGIN = 56;
const SHEET_MARGIN = 20;
/** Distance from hints and tools to handles, in px. */
const BESIDE = 28;
/** Distance within which a finger hits a handle, in px. */
export const REACH = 18;

/** Distance within which a path is picked, in px. */
const PICKED = 8;
/** The key under which the browser stores the deformations whose handles have been highlighted. */
const GREETED = "pathwarp-greeted";
/** While something is dragged: tolerance of the faint result in px of the screen, and the longest time for it, in ms. */
const DRAFT_OF_END = 1;
const MOST_OF_END = 60;

/** A box as two corners. */
type Box = [number, number, number, number];

export class Stage {
  readonly camera = new Camera();
  readonly svg = byId<SVGSVGElement>("stage");
  /** The shadow consists of lines, because a filter would be redrawn with every picture. */
  private shadows = [s("rect", { class: "shadow wide" }), s("rect", { class: "shadow" })];
  private sheet = s("rect", { class: "sheet" });
  /** The pattern of a transparent sheet: squares whose size does not depend on the magnification. */
  private checks = s("pattern", { id: "checks", width: 16, height: 16, patternUnits: "userSpaceOnUse" }, s("rect", { class: "checks-light", width: 16, height: 16 }), s("path", { class: "checks-dark", d: "M0 0h8v8H0zM8 8h8v8H8z" }));
  /** The layer behind the drawing. */
  readonly behind = s("g", {});
  private art = s("g", { class: "art" });
  private beforeArt = s("g", { class: "art", visibility: "hidden" });
  /** The result of all steps, behind the picture of fewer steps. */
  private aheadArt = s("g", { class: "ahead" });
  private heat = s("g", { class: "heat" });
  private nodes = s("path", { class: "nodes" });
  private arms = s("path", { class: "arms" });
  /** Receives pointer events, so that the browser need not search the shapes of a large drawing. */
  private shield = s("rect", { class: "shield", width: "100%", height: "100%" });
  readonly selection = new Selection();
  /** The frame that selects points. */
  readonly marquee = s("rect", { class: "marquee", visibility: "hidden" });
  private lit = s("path", { class: "lit" });
  /** Outlines of the parts that are selected, or pointed at in the list. */
  private chosen = s("g", { class: "chosen-parts" });
  private litParts: string[] = [];
  /** The names of hidden parts. */
  private away = new Set<string>();
  /** The layer for lines that are being drawn. */
  readonly overlay = s("g", {});
  private guides = s("g", { class: "guides" });
  private marks = s("g", { class: "marks" });
  private knobs = s("g", { class: "knobs" });
  /** The value of the dragged handle. */
  private value = s("text", { class: "value-of-drag" });
  private drawing = new Drawing(this.art);
  private elements = new Map<string, SVGGElement>();
  private lines: SVGPathElement[] = [];
  /** Wide, invisible lines over draggable ones, by index. */
  private reaches: (SVGPathElement | null)[] = [];
  private focused: string | null = null;
  /** `true` while the view shows the whole page, unmoved by the user. */
  private isFitted = false;
  /** `true` until the first picture of a drawing arrives. */
  private isFresh = true;
  /** The name of the drawing on show. */
  private shown = "";
  /** `true` until the handles of the first picture arrive. */
  private isToFit = false;
  /** The page of the last picture when saved; null for the drawing's page. */
  private grown: Answer["page"] = null;
  /** `true` while the page shows the drawing without steps. */
  isBefore = false;
  showsNodes = false;
  showsStretch = false;
  showsEnd = false;
  /** The deformation whose handles are highlighted. */
  private greeted = "";
  /** The time that the last faint result took, in ms. */
  private endTook = 0;
  /** If set, receives the next clicked path that a selector matches, and the clicked point; other reactions are disabled. */
  picks: ((path: SVGGraphicsElement, at: XY) => void) | null = null;
  private pickable = "";
  /** Removes the request for a path. */
  private answered: () => void = () => {};
  /** Returns further points that Fit shows, in px of the drawing. */
  around: () => XY[] = () => [];
  /** The names of the drawing's parts. */
  parts = new Set<string>();
  /** Called when a part is clicked; the name is null elsewhere. */
  onPart: (name: string | null, adds: boolean) => void = () => {};
  onFocus: (handle: Handle | null) => void = () => {};
  /** Called when keys have moved a handle. */
  onKeys: (handle: Handle) => void = () => {};
  readonly onLayout: (() => void)[] = [];

  constructor(private app: App, private modes: Modes) {
    this.svg.append(s("defs", {}, this.checks), ...this.shadows, this.sheet, this.behind, this.aheadArt, this.beforeArt, this.art, this.heat, this.arms, this.nodes, this.shield, this.lit, this.chosen, this.overlay, this.guides, this.marks, this.selection.layer, this.knobs, this.value, this.marquee);
    const stage = this;
    app.screen = {
      show: (answer) => this.show(answer),
      reveal: () => this.reveal(),
      get pixel() { return stage.camera.pixel; },
    };
    app.listen((change) => {
      if (change === "state") this.place();
      if (change === "handles") this.rebuild();
      if (change === "report" && this.showsStretch) void this.drawStretch();
      if (change === "report" || change === "steps") void this.drawEnd();
    });
    this.svg.addEventListener("dblclick", (e) => this.doubleClick(e));
    this.svg.addEventListener("keydown", (e) => this.key(e));
    this.svg.addEventListener("keyup", (e) => {
      if (e.key === "Tab" && this.focusedHandle) this.panTo(this.focusedHandle);
    });
    this.svg.addEventListener("pointermove", (e) => {
      if (this.picks) this.light(this.named(e, this.pickable));
      else if (this.modes.picksParts) this.light(this.named(e, ".art *"));
    });
    new ResizeObserver(() => this.resized()).observe(this.svg);
  }

  private get size(): XY {
    return [this.svg.clientWidth, this.svg.clientHeight];
  }

  private resized(): void {
    if (this.isFitted || this.isFresh) this.fit();
    else this.layout();
  }

  /** The part of the canvas that neither panels of a narrow window nor hints and tools cover, as two corners. */
  private get view(): Box {
    const [width, height] = this.size;
    const panel = document.querySelector("body.shapes-open nav, body.settings-open aside");
    if (!panel || getComputedStyle(panel).position === "static") {
      const [side, up, down] = [Math.min(MARGIN, width / 10), byId("note").offsetHeight, byId("tools").offsetHeight];
      return [side, Math.max(MARGIN, up + BESIDE), width - side, Math.max(height - Math.max(MARGIN, down + BESIDE), height / 2)];
    }
    // Hints and tools are hidden then.
    const { left, width: over } = panel.getBoundingClientRect();
    if (over >= width) return [SHEET_MARGIN, SHEET_MARGIN, width - SHEET_MARGIN, Math.max(height - panel.clientHeight, height / 4) - SHEET_MARGIN];
    return [(left > 0 ? 0 : over) + SHEET_MARGIN, SHEET_MARGIN, (left > 0 ? width - over : width) - SHEET_MARGIN, height - SHEET_MARGIN];
  }

  /** Shows the whole page and all handles. */
  fit(): void {
    const [x0, y0, x1, y1] = this.view;
    if (!this.app.state || x1 <= x0 || y1 <= y0) return;
    const handles = (this.app.handles?.handles ?? []).map((h) => this.camera.inPx(h.get())).filter((p) => p.every(Number.isFinite));
    const [a, b, c, d] = this.pageBox;
    const all: XY[] = [[a, b], [c, d], ...handles, ...this.around()];
    const [xs, ys] = [all.map((p) => p[0]), all.map((p) => p[1])];
    this.camera.fit([Math.min(...xs), Math.min(...ys), Math.max(...xs), Math.max(...ys)], [x1 - x0, y1 - y0]);
    const [x, y] = this.camera.shift;
    this.camera.shift = [x + x0, y + y0];
    this.isFitted = true;
    this.layout();
  }

  /** Moves the view as little as necessary to show a handle. */
  private panTo(handle: Handle): void {
    const [x0, y0, x1, y1] = this.view;
    const [x, y] = this.camera.toScreen(handle.get());
    const by: XY = [Math.max(x0 - x, 0) + Math.min(x1 - x, 0), Math.max(y0 - y, 0) + Math.min(y1 - y, 0)];
    if (by[0] !== 0 || by[1] !== 0) this.shift(by);
  }

  /** Moves the view by px of the screen. */
  shift([dx, dy]: XY): void {
    const [x, y] = this.camera.shift;
    this.camera.shift = [x + dx, y + dy];
    this.isFitted = false;
    this.layout();
  }

  /** Shows the whole page and all handles, unless the user has moved the view. */
  private reveal(): void {
    if (this.isFitted) this.fit();
  }

  /** Magnifies about a point of the screen, or about the centre of the view. */
  zoom(factor: number, at?: XY): void {
    const [x0, y0, x1, y1] = this.view;
    this.camera.zoom(factor, at ?? [(x0 + x1) / 2, (y0 + y1) / 2]);
    this.isFitted = false;
    this.layout();
  }

  private place(): void {
    const { state } = this.app;
    if (!state) return;
    if (state.drawing !== this.shown) this.forget();
    this.shown = state.drawing;
    const isNew = this.camera.toPx.some((v, i) => v !== state.toPx[i]);
    this.camera.toPx = state.toPx;
    if (isNew || this.isFresh) {
      // The present picture may belong to another drawing.
      this.isFresh = true;
      this.fit();
    }
    this.grow();
  }

  private show(answer: Answer): void {
    if (answer.picture) {
      this.drawing.show(answer.picture);
      if ("whole" in answer.picture && this.away.size > 0) this.hideParts(this.away);
      // While something is dragged, the sheet grows, but the view stays.
      this.grown = answer.page;
      this.grow();
    }
    if (answer.summary && this.isFresh) {
      this.isFresh = false;
      this.isToFit = this.isFitted;
    }
    if (this.showsNodes) this.drawNodes();
    if (this.litParts.length > 0) this.lightParts(this.litParts);
    this.marks.replaceChildren(...(answer.summary?.folds ?? []).map(([, at]) => this.fold(at)));
  }

  /** The page when saved, as two corners in px of the drawing. */
  get pageBox(): Box {
    const { state } = this.app;
    if (!state) return [0, 0, 0, 0];
    const [x, y, w, h] = this.grown ?? state.page;
    const [[ax, ay], [bx, by]] = [this.camera.inPx([x, y]), this.camera.inPx([x + w, y + h])];
    return [Math.min(ax, bx), Math.min(ay, by), Math.max(ax, bx), Math.max(ay, by)];
  }

  /** Resizes the sheet to the page. */
  private grow(): void {
    const [x0, y0, x1, y1] = this.pageBox;
    for (const sheet of [...this.shadows, this.sheet]) {
      sheet.setAttribute("x", String(x0));
      sheet.setAttribute("y", String(y0));
      sheet.setAttribute("width", String(x1 - x0));
      sheet.setAttribute("height", String(y1 - y0));
    }
  }

  private fold(at: XY): SVGGElement {
    const [x, y] = this.camera.toScreen(at);
    const mark = s("g", { class: "fold", transform: `translate(${x} ${y})` }, s("circle", { r: 9 }), s("circle", { r: 2.5 }));
    mark.dataset.at = JSON.stringify(at);
    return mark;
  }

  /** Shows the drawing without steps, or with them. */
  async before(on: boolean): Promise<void> {
    if (on === this.isBefore) return;
    this.isBefore = on;
    if (on && this.beforeArt.childElementCount === 0) {
      const answer = await this.app.attempt(() => this.app.connection.ask({ do: "before" }));
      this.beforeArt.replaceChildren(...Array.from(apart(answer?.svg, "before")?.children ?? []));
    }
    this.svg.classList.toggle("before", this.isBefore);
    this.art.setAttribute("visibility", this.isBefore ? "hidden" : "visible");
    this.beforeArt.setAttribute("visibility", this.isBefore ? "visible" : "hidden");
  }

  /** Prepares for another drawing. */
  private forget(): void {
    this.beforeArt.replaceChildren();
    this.isFresh = true;
    this.grown = null;
  }

  drawNodes(): void {
    const { nodes, arms } = this.showsNodes ? nodesOf(this.drawing.paths()) : { nodes: "", arms: "" };
    this.nodes.setAttribute("d", nodes);
    this.arms.setAttribute("d", arms);
  }

  /** Shows or hides the stretch of the visible steps. */
  readonly drawStretch = latest(async () => {
    const { app } = this;
    const answer = this.showsStretch ? await app.attempt(() => app.connection.ask({ do: "stretch", steps: app.visible })) : null;
    const stretch = this.showsStretch ? answer?.stretch : null;
    this.heat.replaceChildren(...(stretch ? cells(stretch, (p) => this.camera.inPx(p)) : []));
  });

  /** Shows or hides the result of all steps behind the picture of fewer steps. */
  readonly drawEnd = latest(async () => {
    const { app } = this;
    const isEarlier = () => this.showsEnd && app.selected < app.steps.length - 1;
    // In a large drawing, skip this so that dragging stays fast.
    const draft = app.isDragging ? DRAFT_OF_END * this.camera.pixel : null;
    if (draft !== null && this.endTook > MOST_OF_END) return;
    const start = performance.now();
    const answer = isEarlier() ? await app.connection.ask({ do: "ahead", steps: app.steps, draft }).catch(() => null) : null;
    if (answer) this.endTook = performance.now() - start;
    this.aheadArt.replaceChildren(...Array.from(apart(isEarlier() ? answer?.svg : undefined, "ahead")?.children ?? []));
  });

  /** Positions everything on the screen. */
  layout(): void {
    const { camera } = this;
    const layers = [...this.shadows, this.sheet, this.behind, this.aheadArt, this.art, this.beforeArt, this.nodes, this.arms, this.heat];
    for (const layer of layers) layer.setAttribute("transform", camera.transform);
    this.checks.setAttribute("patternTransform", `scale(${1 / camera.scale})`);
    for (const mark of Array.from(this.marks.children) as SVGGElement[]) {
      const [x, y] = camera.toScreen(JSON.parse(mark.dataset.at!) as XY);
      mark.setAttribute("transform", `translate(${x} ${y})`);
    }
    this.placeHandles();
    if (this.litParts.length > 0) this.lightParts(this.litParts);
    for (const follow of this.onLayout) follow();
  }

  /** Positions handles and their lines. */
  placeHandles(): void {
    const { handles } = this.app;
    if (!handles) return;
    const at = (p: XY) => this.camera.toScreen(p).map((v) => v.toFixed(2)).join(",");
    handles.lines().forEach((line, i) => {
      const element = this.lines[i];
      if (!element) return;
      const [first, ...rest] = line.points.map(at);
      const close = line.closed ? "Z" : "";
      const d = line.cubic ? `M${first}C${rest.join(" ")}${close}` : `M${first}L${rest.join(" ")}${close}`;
      element.setAttribute("d", d);
      this.reaches[i]?.setAttribute("d", d);
    });
    for (const handle of handles.handles) {
      const [x, y] = this.camera.toScreen(handle.get());
      this.elements.get(handle.key)?.setAttribute("transform", `translate(${x.toFixed(2)} ${y.toFixed(2)})`);
    }
    this.selection.place(this.app.isDragging && this.app.hold ? null : handles, (p) => this.camera.toScreen(p));
  }

  /** `true` if dragging the background selects points. */
  get selects(): boolean {
    return this.modes.selects && (this.app.handles?.handles.length ?? 0) > 1;
  }

  private rebuild(): void {
    const { handles } = this.app;
    this.svg.classList.toggle("selecting", this.selects);
    this.elements.clear();
    const lines = handles?.lines() ?? [];
    this.lines = lines.map((line) => s("path", { class: `line ${line.kind}` }));
    this.reaches = lines.map((line) => (line.kind === "arm" ? null : s("path", { class: "pull" })));
    const knobs = (handles?.handles ?? []).map((handle) => {
      const body = handle.shape === "control" ? s("rect", { x: -4, y: -4, width: 8, height: 8, rx: 1.5, class: "body" })
        : s("circle", { r: handle.shape === "source" ? 5 : 6.5, class: "body" });
      const knob = s(
        "g",
        { class: `knob ${handle.shape}`, tabindex: 0, role: "button", "aria-label": handle.label, "data-key": handle.key },
        s("circle", { r: handle.shape === "node" ? REACH : REACH - 5, class: "reach" }), body,
      );
      knob.addEventListener("focus", () => {
        if (!this.selection.keys.has(handle.key)) this.selection.take([handle.key]);
        this.focus(handle.key);
      });
      this.elements.set(handle.key, knob);
      return knob;
    });
    this.guides.replaceChildren(...this.lines, ...this.reaches.filter((r) => r !== null));
    const had = document.activeElement?.closest(".knob") !== null && document.activeElement !== null;
    this.greet();
    this.knobs.replaceChildren(...knobs.sort((a, b) => Number(a.classList.contains("node")) - Number(b.classList.contains("node"))));
    this.placeHandles();
    if (this.isToFit && handles) {
      this.isToFit = false;
      // The hint changes with the handles.
      queueMicrotask(() => this.reveal());
    }
    if (this.focused) {
      const again = this.elements.get(this.focused);
      if (!again) this.focus(null);
      else if (had) again.focus({ preventScroll: true });
      else this.focus(this.focused);
    }
  }

  /** Highlights handles the first time that a deformation has some here. */
  private greet(): void {
    const [name, known] = [this.app.step?.deformation, new Set((localStorage.getItem(GREETED) ?? "").split(" "))];
    this.knobs.classList.toggle("greeting", name !== undefined && (name === this.greeted || !known.has(name)));
    if (!name || !this.app.handles || known.has(name)) return;
    this.greeted = name;
    localStorage.setItem(GREETED, [...known, name].join(" ").trim());
  }

  /** Selects a handle. */
  focus(key: string | null): void {
    this.focused = key;
    if (key === null) this.selection.take([]);
    for (const [k, element] of this.elements) element.classList.toggle("selected", k === key || this.selection.keys.has(k));
    this.selection.place(this.app.handles, (p) => this.camera.toScreen(p));
    this.onFocus(this.handle(key));
  }

  /** Selects several points. */
  select(keys: string[]): void {
    this.selection.take(keys);
    const last = keys[keys.length - 1] ?? null;
    this.focus(last);
    if (last) this.elements.get(last)?.focus({ preventScroll: true });
  }

  /** Returns the selected points if a handle is one of several. */
  several(handle: Handle): Handle[] | null {
    const { handles } = this.app;
    return handles && this.selection.isMany && this.selection.keys.has(handle.key) ? this.selection.of(handles) : null;
  }

  /** Returns the points in a frame between two points of the screen: nodes, or else control points. */
  within([ax, ay]: XY, [bx, by]: XY): string[] {
    const inside = (this.app.handles?.handles ?? []).filter((h) => {
      const [x, y] = this.camera.toScreen(h.get());
      return (x - ax) * (x - bx) <= 0 && (y - ay) * (y - by) <= 0;
    });
    const nodes = inside.filter(({ shape }) => shape === "node");
    return (nodes.length > 0 ? nodes : inside).map(({ key }) => key);
  }

  get focusedHandle(): Handle | null {
    return this.handle(this.focused);
  }

  handle(key: string | null): Handle | null {
    return this.app.handles?.handles.find((h) => h.key === key) ?? null;
  }

  /** Returns the position of a pointer on the canvas. */
  point(e: MouseEvent): XY {
    const box = this.svg.getBoundingClientRect();
    return [e.clientX - box.left, e.clientY - box.top];
  }

  /** Lets the next click pick a path among those that a selector matches; the request is shown until then. */
  pick(take: typeof this.picks, among = ".art [id]", wish = ""): void {
    [this.picks, this.pickable] = [take, among];
    this.svg.classList.toggle("picking", take !== null || this.modes.picksParts);
    this.svg.classList.toggle("outlining", take !== null && among !== ".art [id]");
    this.light(null);
    this.answered();
    this.answered = take && wish ? toast(wish, true) : () => {};
  }

  /** Picks the clicked path; elsewhere, the request stays. */
  picked(e: PointerEvent): void {
    const named = this.named(e, this.pickable);
    if (!named) return void toast("No path is there. Click one, or press Escape");
    const take = this.picks;
    this.pick(null);
    take?.(named, this.camera.toUser(this.point(e)));
  }

  /** Reports the clicked part. */
  pickedPart(e: PointerEvent): void {
    let name: string | null = null;
    for (let at: Element | null = this.named(e, ".art *"); at && !at.matches(".art"); at = at.parentElement) {
      const own = partOf(at.id);
      // A copy is one part, whatever its content.
      if (this.parts.has(own) && (name === null || own.startsWith("use at") || at.localName === "use")) name = own;
    }
    this.light(null);
    if (name !== null || !this.isHiddenAt(e)) this.onPart(name, e.shiftKey);
  }

  /** Returns `true` if a hidden part is at the pointer. */
  private isHiddenAt(e: PointerEvent): boolean {
    const { away } = this;
    this.hideParts(new Set());
    const isThere = this.named(e, ".art *") !== null;
    this.hideParts(away);
    return isThere;
  }

  /** Returns the elements of parts in the picture. */
  private ofParts(names: Set<string>): SVGGraphicsElement[] {
    const all = names.size > 0 ? Array.from(this.art.querySelectorAll<SVGGraphicsElement>("[id]")) : [];
    return all.filter(({ id }) => names.has(partOf(id)));
  }

  /** Draws the outlines of parts. */
  lightParts(names: string[]): void {
    this.litParts = names;
    const outlines = this.ofParts(new Set(names)).flatMap((e) => (e instanceof SVGPathElement ? [e] : Array.from(e.querySelectorAll("path"))));
    this.chosen.replaceChildren(...outlines.map((path) => outlineOf(path, this.svg, s("path", { class: "lit" }))));
  }

  /** Hides parts in the picture. */
  hideParts(names: Set<string>): void {
    this.away = names;
    for (const e of Array.from(this.art.querySelectorAll(".away"))) e.classList.remove("away");
    for (const e of this.ofParts(names)) e.classList.add("away");
  }

  /** Returns the path nearest to the pointer among those that the selector matches. */
  private named(e: PointerEvent, which: string): SVGGraphicsElement | null {
    for (let r = 0; r <= PICKED; r += 2) {
      for (let k = 0; k < (r === 0 ? 1 : 4 * r); k++) {
        const a = (2 * Math.PI * k) / (4 * r || 1);
        const there = document.elementFromPoint(e.clientX + r * Math.cos(a), e.clientY + r * Math.sin(a));
        if (there instanceof SVGGraphicsElement && there.closest(which)) return there;
      }
    }
    return null;
  }

  /** Highlights a path. */
  private light(path: SVGGraphicsElement | null): void {
    if (path) outlineOf(path, this.svg, this.lit);
    else this.lit.setAttribute("d", "");
  }

  /** Shows the value of the dragged handle beside it; null hides it. */
  tell(handle: Handle | null): void {
    const { step } = this.app;
    const param = this.app.deformation(step?.deformation)?.params.find(({ name }) => name === handle?.param);
    const isNumber = param && ["number", "length", "angle", "count"].includes(param.kind);
    const [x, y] = handle?.get() ?? [0, 0];
    const digits = Math.max(0, Math.ceil(-Math.log10(this.camera.pixel)));
    const place = [x, y].map((v) => v.toFixed(digits)).join(", ");
    this.value.textContent = !handle ? "" : isNumber ? `${paramName(param)} ${step?.args[param.name]?.[0] ?? ""}${param.kind === "angle" ? "°" : ""}` : place;
    const [sx, sy] = this.camera.toScreen([x, y]);
    this.value.setAttribute("x", String(sx + REACH));
    this.value.setAttribute("y", String(sy - REACH));
  }

  /** Writes the values of a moved handle, and requests a draft. */
  changed(handle: Handle, since: number): void {
    this.app.handles!.write(handle.param);
    this.placeHandles();
    if (this.app.hold) this.tell(handle);
    this.onFocus(handle);
    this.app.tell("values");
    this.app.draft(since);
  }

  private doubleClick(e: MouseEvent): void {
    if (!(e.target as Element).closest(".knob")) void this.add(this.camera.toUser(this.point(e)));
  }

  /** Adds a point, with its reflection if symmetry is on, and selects it. */
  private async add(at: XY): Promise<void> {
    const { handles } = this.app;
    if (!handles) return;
    const reach = REACH * this.camera.pixel;
    const key = await this.app.addPoint(at, this.modes.reflections(handles, at, reach), reach);
    // The clicks may have selected the ends of the line.
    if (key) this.select([key]);
  }

  /** Arrow keys move a handle by a px of the screen; with Shift, by ten. */
  private key(e: KeyboardEvent): void {
    const handle = this.handle((e.target as Element).closest<SVGGElement>(".knob")?.dataset.key ?? null);
    if (!handle || !this.app.handles) return;
    const by = ({ ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] } as Record<string, XY>)[e.key];
    if (by) {
      e.preventDefault();
      const far = e.shiftKey ? 10 : 1;
      const [x, y] = this.camera.toScreen(handle.get());
      const several = this.several(handle);
      if (several) {
        this.app.commitSoon();
        const shift = ([px, py]: XY): XY => [px + far * by[0], py + far * by[1]];
        this.changedAll(together(this.app.handles, several, this.modes)((p) => this.camera.toUser(shift(this.camera.toScreen(p)))), performance.now());
      } else {
        this.moveTo(handle, this.camera.toUser([x + far * by[0], y + far * by[1]]));
      }
      this.onKeys(handle);
    } else if (e.key === "Insert") {
      e.preventDefault();
      const [x, y] = handle.get();
      // Without a line to divide, add a point beside the handle.
      const at = this.app.handles.after(handle) ?? [x + 2 * REACH * this.camera.pixel, y] as XY;
      void this.add(at);
    } else if ((e.key === "Delete" || e.key === "Backspace") && handle.remove) {
      e.preventDefault();
      const several = this.several(handle);
      if (several) this.removeAll(several);
      else this.remove(handle);
    }
  }

  /** Removes several points, as long as enough remain. */
  private removeAll(several: Handle[]): void {
    const { handles } = this.app;
    if (!handles) return;
    const places = several.map(({ param, shape, get }) => ({ param, shape, at: [...get()] }));
    // Removing one renumbers the others.
    for (const { param, shape, at } of places) {
      handles.handles.find((h) => h.param === param && h.shape === shape && h.get()[0] === at[0] && h.get()[1] === at[1])?.remove?.();
      handles.write(param);
    }
    this.focused = handles.nearest(places[0]!.at as XY)?.key ?? null;
    this.selection.take(this.focused ? [this.focused] : []);
    this.app.tell("handles");
    void this.app.commit();
  }

  /** Writes the values of parameters whose handles have moved together, and requests a draft. */
  changedAll(params: Set<string>, since: number): void {
    for (const param of params) this.app.handles!.write(param);
    this.placeHandles();
    this.onFocus(this.focusedHandle);
    this.app.tell("values");
    this.app.draft(since);
  }

  /** Removes a point. */
  remove(handle: Handle): void {
    const { handles } = this.app;
    if (!handle.remove || !handles) return;
    const [at, param] = [handle.get(), handle.param];
    const partner = this.modes.mirrors && !handles.isRows(param) ? handles.partner(handle) : null;
    const mirrored = partner?.param === param ? partner.get() : null;
    handle.remove();
    // Removing one renumbers the others.
    if (mirrored) handles.handles.find((h) => h.param === param && h.shape === handle.shape && h.get()[0] === mirrored[0] && h.get()[1] === mirrored[1])?.remove?.();
    handles.write(param);
    this.focused = handles.nearest(at)?.key ?? null;
    this.app.tell("handles");
    void this.app.commit();
  }

  /** Moves a handle by keys or typed numbers. */
  moveTo(handle: Handle, to: XY): void {
    const { handles } = this.app;
    if (!handles) return;
    this.app.commitSoon();
    this.modes.mover(handles, handle)(to, null);
    this.changed(handle, performance.now());
  }
}

/** Serializes repeated work: requests during a run lead to one more run. */
function latest(work: () => Promise<void>): () => Promise<void> {
  let [isAsked, isWanted] = [false, false];
  return async () => {
    isWanted = true;
    if (isAsked) return;
    isAsked = true;
    while (isWanted) {
      isWanted = false;
      await work();
    }
    isAsked = false;
  };
}

/** Returns the id in the drawing of an element of the picture, without its prefix. */
export function partOf(id: string): string {
  return id.replace(/^art-/, "");
}

/** The largest path whose outline is highlighted, in px. */
const FARTHEST = 1e6;

/** Gives a path the outline of another path in the picture. */
function outlineOf(path: SVGGraphicsElement, svg: SVGSVGElement, to: SVGPathElement): SVGPathElement {
  const [from, m] = [svg.getBoundingClientRect(), path.getScreenCTM()];
  const { width, height } = path.getBBox();
  // Browsers take extremely long to draw the stroke of a very large path.
  const isFar = m !== null && Math.hypot(width, height) * Math.hypot(m.a, m.b) > FARTHEST;
  to.setAttribute("d", isFar ? "" : path.getAttribute("d") ?? "");
  if (m) to.setAttribute("transform", `matrix(${m.a} ${m.b} ${m.c} ${m.d} ${m.e - from.x} ${m.f - from.y})`);
  return to;
}
