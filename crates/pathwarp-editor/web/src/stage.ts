// The canvas: the drawing, the handles over it, and their reactions to pointers and keys.

import type { App } from "./app";
import { Camera } from "./camera";
import { ARROWS, byId, s } from "./dom";
import { Drawing, parseWithPrefix } from "./drawing";
import { cells } from "./heat";
import { Modes } from "./modes";
import { Selection, groupMover } from "./selection";
import { nodesOf } from "./nodes";
import { paramName } from "./names";
import { toast } from "./toast";
import type { Answer, Handle, XY } from "./types";

/** Margins around the drawing when it fits the view, in px; the second one is for narrow windows with an open panel. */
const MARGIN = 56;
const NARROW_MARGIN = 20;
/** Distance from hints and tools to handles, in px. */
const TOOLS_GAP = 28;
/** Distance within which a finger hits a handle, in px. */
export const REACH = 18;
/** Distance within which a path is picked, in px. */
const PICK_REACH = 8;
/** The key under which the browser stores the deformations whose handles have been highlighted. */
const GREETED_KEY = "pathwarp-greeted";
/** While something is dragged: tolerance of the faint result of all steps, in screen px, and the time in ms beyond which it is left out. */
const END_TOLERANCE = 1;
const END_TIME_LIMIT = 60;

/** A box as its least and greatest x and y: x0, y0, x1, y1. */
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
  /** Nodes of the picture's paths, and the lines to their control points. */
  private nodes = s("path", { class: "nodes" });
  private arms = s("path", { class: "arms" });
  /** Receives pointer events, so that the browser need not search the shapes of a large drawing. */
  private shield = s("rect", { class: "shield", width: "100%", height: "100%" });
  readonly selection = new Selection();
  /** The frame that selects points. */
  readonly marquee = s("rect", { class: "marquee", visibility: "hidden" });
  /** Outline of the path under the pointer. */
  private highlight = s("path", { class: "lit" });
  /** Outlines of the parts that are selected, or pointed at in the list. */
  private partOutlines = s("g", { class: "chosen-parts" });
  private outlinedParts: string[] = [];
  private hiddenParts = new Set<string>();
  /** The layer for lines that are being drawn. */
  readonly overlay = s("g", {});
  private guides = s("g", { class: "guides" });
  private foldMarks = s("g", { class: "marks" });
  private knobs = s("g", { class: "knobs" });
  /** The value of the dragged handle. */
  private value = s("text", { class: "value-of-drag" });
  private drawing = new Drawing(this.art);
  /** The knobs of handles, by their keys. */
  private knobOf = new Map<string, SVGGElement>();
  private lines: SVGPathElement[] = [];
  /** Wide, invisible lines over draggable ones, by index. */
  private hitLines: (SVGPathElement | null)[] = [];
  private focusedKey: string | null = null;
  /** `true` while the view shows the whole page, unmoved by the user. */
  private isFitted = false;
  /** `true` until the first picture of a drawing arrives; drafts, whose answers have no summary, do not count. */
  private awaitsPicture = true;
  private drawingName = "";
  /** `true` from the first picture of a drawing until its handles arrive. */
  private awaitsHandles = false;
  /** The page of the last picture when saved; null for the drawing's page. */
  private savedPage: Answer["page"] = null;
  /** `true` while the page shows the drawing without steps. */
  isBefore = false;
  showsNodes = false;
  showsStretch = false;
  showsFinalResult = false;
  /** The deformation whose handles are highlighted. */
  private greeted = "";
  /** The time that the last faint result took, in ms. */
  private endTime = 0;
  /** If set, receives the next clicked path that `pickSelector` matches, and the clicked point; other reactions are disabled. */
  onPick: ((path: SVGGraphicsElement, at: XY) => void) | null = null;
  private pickSelector = "";
  /** Removes the message that asks for a path. */
  private hideRequest: () => void = () => {};
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
    this.svg.append(
      s("defs", {}, this.checks), ...this.shadows, this.sheet, this.behind, this.aheadArt, this.beforeArt, this.art, this.heat, this.arms, this.nodes, this.shield,
      this.highlight, this.partOutlines, this.overlay, this.guides, this.foldMarks, this.selection.layer, this.knobs, this.value, this.marquee,
    );
    const stage = this;
    app.screen = {
      show: (answer) => this.showAnswer(answer),
      reveal: () => this.reveal(),
      get pixel() { return stage.camera.pixel; },
    };
    app.listen(["state"], () => this.takeState());
    app.listen(["handles"], () => this.rebuild());
    app.listen(["report"], () => this.showsStretch && void this.drawStretch());
    app.listen(["report", "steps"], () => void this.drawFinalResult());
    this.svg.addEventListener("dblclick", (e) => this.doubleClick(e));
    this.svg.addEventListener("keydown", (e) => this.key(e));
    this.svg.addEventListener("keyup", (e) => {
      if (e.key === "Tab" && this.focusedHandle) this.panTo(this.focusedHandle);
    });
    this.svg.addEventListener("pointermove", (e) => {
      if (this.onPick) this.outlinePath(this.pathAt(e, this.pickSelector));
      else if (this.modes.picksParts) this.outlinePath(this.pathAt(e, ".art *"));
    });
    new ResizeObserver(() => (this.isFitted || this.awaitsPicture ? this.fit() : this.layout())).observe(this.svg);
  }

  /** The part of the canvas that neither panels of a narrow window nor hints and tools cover. */
  private get view(): Box {
    const { clientWidth: width, clientHeight: height } = this.svg;
    const panel = document.querySelector("body.shapes-open nav, body.settings-open aside");
    if (!panel || getComputedStyle(panel).position === "static") {
      const [side, hint, tools] = [Math.min(MARGIN, width / 10), byId("note").offsetHeight, byId("tools").offsetHeight];
      return [side, Math.max(MARGIN, hint + TOOLS_GAP), width - side, Math.max(height - Math.max(MARGIN, tools + TOOLS_GAP), height / 2)];
    }
    // An open panel hides hints and tools. It lies at the bottom, or else at the left or right side.
    const { left, width: covered } = panel.getBoundingClientRect();
    if (covered >= width) return [NARROW_MARGIN, NARROW_MARGIN, width - NARROW_MARGIN, Math.max(height - panel.clientHeight, height / 4) - NARROW_MARGIN];
    return [(left > 0 ? 0 : covered) + NARROW_MARGIN, NARROW_MARGIN, (left > 0 ? width - covered : width) - NARROW_MARGIN, height - NARROW_MARGIN];
  }

  /** Shows the whole page and all handles. */
  fit(): void {
    const [x0, y0, x1, y1] = this.view;
    if (!this.app.state || x1 <= x0 || y1 <= y0) return;
    const handles = (this.app.handles?.handles ?? []).map((h) => this.camera.inPx(h.get())).filter((p) => p.every(Number.isFinite));
    const [left, top, right, bottom] = this.pageBox;
    const points: XY[] = [[left, top], [right, bottom], ...handles, ...this.around()];
    const [xs, ys] = [points.map((p) => p[0]), points.map((p) => p[1])];
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

  private takeState(): void {
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
      // The present picture may belong to another drawing.
      this.awaitsPicture = true;
      this.fit();
    }
    this.resizeSheet();
  }

  private showAnswer(answer: Answer): void {
    if (answer.picture) {
      this.drawing.show(answer.picture);
      if ("whole" in answer.picture && this.hiddenParts.size > 0) this.hideParts(this.hiddenParts);
      // While something is dragged, the sheet grows, but the view stays.
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
  get pageBox(): Box {
    const { state } = this.app;
    if (!state) return [0, 0, 0, 0];
    const [x, y, w, h] = this.savedPage ?? state.page;
    const [[ax, ay], [bx, by]] = [this.camera.inPx([x, y]), this.camera.inPx([x + w, y + h])];
    return [Math.min(ax, bx), Math.min(ay, by), Math.max(ax, bx), Math.max(ay, by)];
  }

  /** Resizes the sheet to the page. */
  private resizeSheet(): void {
    const [x0, y0, x1, y1] = this.pageBox;
    for (const sheet of [...this.shadows, this.sheet]) {
      sheet.setAttribute("x", String(x0));
      sheet.setAttribute("y", String(y0));
      sheet.setAttribute("width", String(x1 - x0));
      sheet.setAttribute("height", String(y1 - y0));
    }
  }

  private foldMark(at: XY): SVGGElement {
    const [x, y] = this.camera.toScreen(at);
    const mark = s("g", { class: "fold", transform: `translate(${x} ${y})` }, s("circle", { r: 9 }), s("circle", { r: 2.5 }));
    mark.dataset.at = JSON.stringify(at);
    return mark;
  }

  /** Shows the drawing without steps, or with them. */
  async showBefore(on: boolean): Promise<void> {
    if (on === this.isBefore) return;
    this.isBefore = on;
    if (on && this.beforeArt.childElementCount === 0) {
      const answer = await this.app.request({ do: "before" });
      this.beforeArt.replaceChildren(...Array.from(parseWithPrefix(answer?.svg, "before")?.children ?? []));
    }
    this.svg.classList.toggle("before", this.isBefore);
    this.art.setAttribute("visibility", this.isBefore ? "hidden" : "visible");
    this.beforeArt.setAttribute("visibility", this.isBefore ? "visible" : "hidden");
  }

  drawNodes(): void {
    const { nodes, arms } = this.showsNodes ? nodesOf(this.drawing.paths()) : { nodes: "", arms: "" };
    this.nodes.setAttribute("d", nodes);
    this.arms.setAttribute("d", arms);
  }

  /** Shows or hides the stretch of the visible steps. */
  readonly drawStretch = latest(async () => {
    const answer = this.showsStretch ? await this.app.request({ do: "stretch", steps: this.app.visible }) : null;
    const stretch = this.showsStretch ? answer?.stretch : null;
    this.heat.replaceChildren(...(stretch ? cells(stretch, (p) => this.camera.inPx(p)) : []));
  });

  /** Shows or hides the result of all steps behind the picture of fewer steps. */
  readonly drawFinalResult = latest(async () => {
    const { app } = this;
    const isEarlier = () => this.showsFinalResult && app.selected < app.steps.length - 1;
    const draft = app.isDragging ? END_TOLERANCE * this.camera.pixel : null;
    // During a drag, skip this in a large drawing.
    if (draft !== null && this.endTime > END_TIME_LIMIT) return;
    const start = performance.now();
    const answer = isEarlier() ? await app.connection.ask({ do: "ahead", steps: app.steps, draft }).catch(() => null) : null;
    if (answer) this.endTime = performance.now() - start;
    this.aheadArt.replaceChildren(...Array.from(parseWithPrefix(isEarlier() ? answer?.svg : undefined, "ahead")?.children ?? []));
  });

  /** Positions everything on the screen. */
  layout(): void {
    const { camera } = this;
    const layers = [...this.shadows, this.sheet, this.behind, this.aheadArt, this.art, this.beforeArt, this.nodes, this.arms, this.heat];
    for (const layer of layers) layer.setAttribute("transform", camera.transform);
    this.checks.setAttribute("patternTransform", `scale(${1 / camera.scale})`);
    for (const mark of Array.from(this.foldMarks.children) as SVGGElement[]) {
      const [x, y] = camera.toScreen(JSON.parse(mark.dataset.at!) as XY);
      mark.setAttribute("transform", `translate(${x} ${y})`);
    }
    this.placeHandles();
    if (this.outlinedParts.length > 0) this.outlineParts(this.outlinedParts);
    for (const follow of this.onLayout) follow();
  }

  /** Positions handles and their lines. */
  placeHandles(): void {
    const { handles } = this.app;
    if (!handles) return;
    const screenPoint = (p: XY) => this.camera.toScreen(p).map((v) => v.toFixed(2)).join(",");
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
  get isSelecting(): boolean {
    return this.modes.selects && (this.app.handles?.handles.length ?? 0) > 1;
  }

  private rebuild(): void {
    const { handles } = this.app;
    this.svg.classList.toggle("selecting", this.isSelecting);
    this.knobOf.clear();
    const lines = handles?.lines() ?? [];
    this.lines = lines.map((line) => s("path", { class: `line ${line.kind}` }));
    this.hitLines = lines.map((line) => (line.kind === "arm" ? null : s("path", { class: "pull" })));
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
      this.knobOf.set(handle.key, knob);
      return knob;
    });
    this.guides.replaceChildren(...this.lines, ...this.hitLines.filter((r) => r !== null));
    const hadFocus = document.activeElement?.closest(".knob") !== null && document.activeElement !== null;
    this.greet();
    // Nodes come last, above the handles that cover them.
    this.knobs.replaceChildren(...knobs.sort((a, b) => Number(a.classList.contains("node")) - Number(b.classList.contains("node"))));
    this.placeHandles();
    if (this.awaitsHandles && handles) {
      this.awaitsHandles = false;
      // The hint changes with the handles.
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
  private greet(): void {
    const [name, known] = [this.app.step?.deformation, new Set((localStorage.getItem(GREETED_KEY) ?? "").split(" "))];
    this.knobs.classList.toggle("greeting", name !== undefined && (name === this.greeted || !known.has(name)));
    if (!name || !this.app.handles || known.has(name)) return;
    this.greeted = name;
    localStorage.setItem(GREETED_KEY, [...known, name].join(" ").trim());
  }

  /** Makes a handle the one whose position is shown; null also clears the selection. */
  focus(key: string | null): void {
    this.focusedKey = key;
    if (key === null) this.selection.take([]);
    for (const [k, knob] of this.knobOf) knob.classList.toggle("selected", k === key || this.selection.keys.has(k));
    this.selection.place(this.app.handles, (p) => this.camera.toScreen(p));
    this.onFocus(this.handle(key));
  }

  /** Selects several points. */
  select(keys: string[]): void {
    this.selection.take(keys);
    const last = keys[keys.length - 1] ?? null;
    this.focus(last);
    if (last) this.knobOf.get(last)?.focus({ preventScroll: true });
  }

  /** Returns the selected points if a handle is one of several. */
  selectedWith(handle: Handle): Handle[] | null {
    const { handles } = this.app;
    return handles && this.selection.isMany && this.selection.keys.has(handle.key) ? this.selection.selectedOf(handles) : null;
  }

  /** Returns the keys of the points in a frame between two points of the screen: nodes, or else control points. */
  keysInFrame([ax, ay]: XY, [bx, by]: XY): string[] {
    const inside = (this.app.handles?.handles ?? []).filter((h) => {
      const [x, y] = this.camera.toScreen(h.get());
      return (x - ax) * (x - bx) <= 0 && (y - ay) * (y - by) <= 0;
    });
    const nodes = inside.filter(({ shape }) => shape === "node");
    return (nodes.length > 0 ? nodes : inside).map(({ key }) => key);
  }

  get focusedHandle(): Handle | null {
    return this.handle(this.focusedKey);
  }

  handle(key: string | null): Handle | null {
    return this.app.handles?.handles.find((h) => h.key === key) ?? null;
  }

  /** Returns the position of a pointer on the canvas. */
  point(e: MouseEvent): XY {
    const box = this.svg.getBoundingClientRect();
    return [e.clientX - box.left, e.clientY - box.top];
  }

  /** Lets the next click pick a path among those that `selector` matches; `request`, if any, is shown until then. */
  pick(take: typeof this.onPick, request = "", selector = ".art [id]"): void {
    [this.onPick, this.pickSelector] = [take, selector];
    this.svg.classList.toggle("picking", take !== null || this.modes.picksParts);
    this.svg.classList.toggle("outlining", take !== null && selector !== ".art [id]");
    this.outlinePath(null);
    this.hideRequest();
    this.hideRequest = take && request ? toast(request, true) : () => {};
  }

  /** Picks the clicked path; elsewhere, the request stays. */
  pickAt(e: PointerEvent): void {
    const path = this.pathAt(e, this.pickSelector);
    if (!path) return void toast("No path is there. Click one, or press Escape");
    const take = this.onPick;
    this.pick(null);
    take?.(path, this.camera.toUser(this.point(e)));
  }

  /** Reports the innermost part at the pointer, or the outermost copy around it: one part, named like `use at 12:5` without an id. */
  pickPartAt(e: PointerEvent): void {
    let name: string | null = null;
    for (let element: Element | null = this.pathAt(e, ".art *"); element && !element.matches(".art"); element = element.parentElement) {
      const part = partOf(element.id);
      if (this.parts.has(part) && (name === null || part.startsWith("use at") || element.localName === "use")) name = part;
    }
    this.outlinePath(null);
    if (name !== null || !this.isHiddenAt(e)) this.onPart(name, e.shiftKey);
  }

  /** Returns `true` if a hidden part is at the pointer. */
  private isHiddenAt(e: PointerEvent): boolean {
    const { hiddenParts } = this;
    this.hideParts(new Set());
    const isThere = this.pathAt(e, ".art *") !== null;
    this.hideParts(hiddenParts);
    return isThere;
  }

  /** Returns the elements of parts in the picture. */
  private elementsOf(parts: Set<string>): SVGGraphicsElement[] {
    const all = parts.size > 0 ? Array.from(this.art.querySelectorAll<SVGGraphicsElement>("[id]")) : [];
    return all.filter(({ id }) => parts.has(partOf(id)));
  }

  /** Draws the outlines of parts. */
  outlineParts(names: string[]): void {
    this.outlinedParts = names;
    const paths = this.elementsOf(new Set(names)).flatMap((e) => (e instanceof SVGPathElement ? [e] : Array.from(e.querySelectorAll("path"))));
    this.partOutlines.replaceChildren(...paths.map((path) => outlineOf(path, this.svg, s("path", { class: "lit" }))));
  }

  /** Hides parts in the picture. */
  hideParts(names: Set<string>): void {
    this.hiddenParts = names;
    for (const e of Array.from(this.art.querySelectorAll(".away"))) e.classList.remove("away");
    for (const e of this.elementsOf(names)) e.classList.add("away");
  }

  /** Returns the path nearest to the pointer among those that a selector matches, tried on circles around it. */
  private pathAt(e: PointerEvent, selector: string): SVGGraphicsElement | null {
    for (let r = 0; r <= PICK_REACH; r += 2) {
      for (let k = 0; k < (r === 0 ? 1 : 4 * r); k++) {
        const angle = (2 * Math.PI * k) / (4 * r || 1);
        const path = document.elementFromPoint(e.clientX + r * Math.cos(angle), e.clientY + r * Math.sin(angle));
        if (path instanceof SVGGraphicsElement && path.closest(selector)) return path;
      }
    }
    return null;
  }

  /** Draws the outline of a path under the pointer; null removes it. */
  private outlinePath(path: SVGGraphicsElement | null): void {
    if (path) outlineOf(path, this.svg, this.highlight);
    else this.highlight.setAttribute("d", "");
  }

  /** Shows the value of the dragged handle beside it; null hides it. */
  showValue(handle: Handle | null): void {
    const { step } = this.app;
    const param = this.app.deformation(step?.deformation)?.params.find(({ name }) => name === handle?.param);
    const isNumber = param && ["number", "length", "angle", "count"].includes(param.kind);
    const [x, y] = handle?.get() ?? [0, 0];
    const digits = Math.max(0, Math.ceil(-Math.log10(this.camera.pixel)));
    const position = [x, y].map((v) => v.toFixed(digits)).join(", ");
    this.value.textContent = !handle ? "" : isNumber ? `${paramName(param)} ${step?.args[param.name]?.[0] ?? ""}${param.kind === "angle" ? "°" : ""}` : position;
    const [sx, sy] = this.camera.toScreen([x, y]);
    this.value.setAttribute("x", String(sx + REACH));
    this.value.setAttribute("y", String(sy - REACH));
  }

  /** Writes the values of a moved handle, and requests a draft. */
  writeHandle(handle: Handle, since: number): void {
    this.app.handles!.write(handle.param);
    this.placeHandles();
    if (this.app.cancelGesture) this.showValue(handle);
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
    const direction = ARROWS[e.key];
    const several = this.selectedWith(handle);
    if (direction) {
      e.preventDefault();
      const px = e.shiftKey ? 10 : 1;
      const shifted = (p: XY): XY => {
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
      // Without a line to divide, add a point beside the handle.
      const at = this.app.handles.after(handle) ?? [x + 2 * REACH * this.camera.pixel, y] as XY;
      void this.add(at);
    } else if ((e.key === "Delete" || e.key === "Backspace") && handle.remove) {
      e.preventDefault();
      if (several) this.removeAll(several);
      else this.remove(handle);
    }
  }

  /** Removes several points, as long as enough remain. */
  private removeAll(several: Handle[]): void {
    const { handles } = this.app;
    if (!handles) return;
    const points = several.map((handle) => ({ handle, at: [...handle.get()] as XY }));
    for (const { handle, at: [x, y] } of points) {
      const { param, shape } = handle;
      // Removing one renumbers the others, which are then found by their positions.
      const present = handles.handles.includes(handle) ? handle : handles.handles.find((h) => h.param === param && h.shape === shape && h.get()[0] === x && h.get()[1] === y);
      present?.remove?.();
      handles.write(param);
    }
    this.focusedKey = handles.nearest(points[0]!.at)?.key ?? null;
    this.selection.take(this.focusedKey ? [this.focusedKey] : []);
    this.app.tell("handles");
    void this.app.commit();
  }

  /** Writes the values of parameters whose handles have moved together, and requests a draft. */
  writeParams(params: Set<string>, since: number): void {
    for (const param of params) this.app.handles!.write(param);
    this.placeHandles();
    this.onFocus(this.focusedHandle);
    this.app.tell("values");
    this.app.draft(since);
  }

  /** Removes a point, and its reflection if symmetry is on. */
  remove(handle: Handle): void {
    const { handles } = this.app;
    if (!handle.remove || !handles) return;
    const partner = this.modes.mirrors && !handles.editsAllRows(handle.param) ? handles.partner(handle) : null;
    this.removeAll(partner ? [handle, partner] : [handle]);
  }

  /** Moves a handle by keys or typed numbers. */
  moveTo(handle: Handle, to: XY): void {
    const { handles } = this.app;
    if (!handles) return;
    this.app.commitSoon();
    this.modes.mover(handles, handle)(to);
    this.writeHandle(handle, performance.now());
  }
}

/** Serializes repeated work: requests during a run lead to one more run. */
function latest(work: () => Promise<void>): () => Promise<void> {
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

/** Returns the id in the drawing of an element of the picture, without its prefix. */
export function partOf(id: string): string {
  return id.replace(/^art-/, "");
}

/** The largest path whose outline is drawn, in px: browsers take extremely long to draw the stroke of a larger one. */
const LARGEST_OUTLINE = 1e6;

/** Makes `outline` the outline of a path in the picture, and returns it. */
function outlineOf(path: SVGGraphicsElement, svg: SVGSVGElement, outline: SVGPathElement): SVGPathElement {
  const [canvas, m] = [svg.getBoundingClientRect(), path.getScreenCTM()];
  const { width, height } = path.getBBox();
  const isTooLarge = m !== null && Math.hypot(width, height) * Math.hypot(m.a, m.b) > LARGEST_OUTLINE;
  outline.setAttribute("d", isTooLarge ? "" : path.getAttribute("d") ?? "");
  if (m) outline.setAttribute("transform", `matrix(${m.a} ${m.b} ${m.c} ${m.d} ${m.e - canvas.x} ${m.f - canvas.y})`);
  return outline;
}
