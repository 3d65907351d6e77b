// The canvas: the drawing, the handles over it, and everything done with pointer and keys there.

import type { App } from "./app";
import { Camera } from "./camera";
import { byId, s } from "./dom";
import { Drawing, parse } from "./drawing";
import { cells } from "./heat";
import { Modes } from "./modes";
import { nodesOf } from "./nodes";
import type { Answer, Handle, XY } from "./types";

/** Space around the drawing when it fits the view, in px. */
const MARGIN = 56;
/** The radius in which a finger finds a handle, in px. */
const REACH = 18;
/** Moves of a pointer, at once where the browser can. `pointermove` waits for the next picture, so the answer would miss it. */
const MOVES = "onpointerrawupdate" in window ? "pointerrawupdate" : "pointermove";
/** The pause after which keys count as one change, in ms. */
const KEYS = 500;

export class Stage {
  readonly camera = new Camera();
  private svg = byId<SVGSVGElement>("stage");
  private sheet = s("rect", { class: "sheet" });
  private art = s("g", { class: "art" });
  private beforeArt = s("g", { class: "art", visibility: "hidden" });
  private heat = s("g", { class: "heat" });
  private nodes = s("path", { class: "nodes" });
  private arms = s("path", { class: "arms" });
  private guides = s("g", { class: "guides" });
  private marks = s("g", { class: "marks" });
  private knobs = s("g", { class: "knobs" });
  private drawing = new Drawing(this.art);
  private elements = new Map<string, SVGGElement>();
  private lines: SVGPathElement[] = [];
  /** Wide, invisible lines over those that can be pulled, by their index. */
  private reaches: (SVGPathElement | null)[] = [];
  private focused: string | null = null;
  private touches = new Map<number, XY>();
  private keysTimer = 0;
  private isFitted = false;
  /** Set while the page shows the drawing as it was. */
  isBefore = false;
  showsNodes = false;
  showsStretch = false;
  /** Takes the id of the path that is clicked next, instead of anything else. */
  picks: ((id: string) => void) | null = null;
  onFocus: (handle: Handle | null) => void = () => {};
  onZoom: () => void = () => {};
  /** The view was moved by somebody who took hold of the artwork. */
  onPan: () => void = () => {};

  constructor(private app: App, private modes: Modes) {
    this.svg.append(this.sheet, this.beforeArt, this.art, this.heat, this.arms, this.nodes, this.guides, this.marks, this.knobs);
    const stage = this;
    app.screen = { show: (answer) => this.show(answer), get pixel() { return stage.camera.pixel; } };
    app.listen((change) => {
      if (change === "state") this.place();
      if (change === "handles") this.rebuild();
      if (change === "report" && this.showsStretch && !app.isDragging) void this.drawStretch();
    });
    this.svg.addEventListener("wheel", (e) => this.wheel(e), { passive: false });
    this.svg.addEventListener("pointerdown", (e) => this.press(e));
    this.svg.addEventListener("dblclick", (e) => this.doubleClick(e));
    this.svg.addEventListener("keydown", (e) => this.key(e));
    new ResizeObserver(() => this.resized()).observe(this.svg);
  }

  private get size(): XY {
    return [this.svg.clientWidth, this.svg.clientHeight];
  }

  private resized(): void {
    if (!this.isFitted) this.fit();
    else this.layout();
  }

  /** Shows the whole page. */
  fit(): void {
    const { state } = this.app;
    const [width, whole] = this.size;
    // In a narrow window, a panel covers the lower part.
    const panel = document.querySelector("body.shapes-open nav, body.settings-open aside");
    const covered = panel && getComputedStyle(panel).position === "fixed" ? panel.clientHeight : 0;
    const height = Math.max(whole - covered, whole / 4);
    if (!state || width === 0 || height === 0) return;
    this.camera.fit(state.page, [width, height], Math.min(MARGIN, width / 10));
    this.isFitted = true;
    this.layout();
  }

  zoom(factor: number, at: XY = [this.size[0] / 2, this.size[1] / 2]): void {
    this.camera.zoom(factor, at);
    this.layout();
  }

  private place(): void {
    const { state } = this.app;
    if (!state) return;
    const isNew = this.camera.toPx.some((v, i) => v !== state.toPx[i]);
    this.camera.toPx = state.toPx;
    this.grow();
    if (isNew || !this.isFitted) this.fit();
  }

  private show(answer: Answer): void {
    if (answer.picture) this.drawing.show(answer.picture);
    if (answer.summary) this.grow();
    if (this.showsNodes) this.drawNodes();
    this.marks.replaceChildren(...(answer.summary?.folds ?? []).map(([, at]) => this.fold(at)));
  }

  /** The page, as far as it holds the artwork: saving makes it larger where needed. */
  private grow(): void {
    const { state } = this.app;
    if (!state) return;
    const [x, y, w, h] = state.page;
    const [[x0, y0], [x1, y1]] = [this.camera.inPx([x, y]), this.camera.inPx([x + w, y + h])];
    let box = [Math.min(x0, x1), Math.min(y0, y1), Math.max(x0, x1), Math.max(y0, y1)] as const;
    const art = this.art.getBBox();
    if (!state.program && art.width > 0) {
      box = [Math.min(box[0], art.x), Math.min(box[1], art.y), Math.max(box[2], art.x + art.width), Math.max(box[3], art.y + art.height)];
    }
    this.sheet.setAttribute("x", String(box[0]));
    this.sheet.setAttribute("y", String(box[1]));
    this.sheet.setAttribute("width", String(box[2] - box[0]));
    this.sheet.setAttribute("height", String(box[3] - box[1]));
  }

  private fold(at: XY): SVGGElement {
    const [x, y] = this.camera.toScreen(at);
    const mark = s("g", { class: "fold", transform: `translate(${x} ${y})` }, s("circle", { r: 9 }), s("circle", { r: 2.5 }));
    mark.dataset.at = JSON.stringify(at);
    return mark;
  }

  /** Shows the drawing as it was, or as it is. */
  async before(on: boolean): Promise<void> {
    if (on === this.isBefore) return;
    this.isBefore = on;
    if (on && this.beforeArt.childElementCount === 0) {
      const answer = await this.app.attempt(() => this.app.connection.ask({ do: "before" }));
      const root = answer?.svg ? parse(answer.svg) : null;
      // Ids must not be those of the picture itself.
      if (root) this.beforeArt.replaceChildren(...Array.from(renamed(root).children));
    }
    this.svg.classList.toggle("before", this.isBefore);
    this.art.setAttribute("visibility", this.isBefore ? "hidden" : "visible");
    this.beforeArt.setAttribute("visibility", this.isBefore ? "visible" : "hidden");
  }

  /** Another drawing has been opened. */
  forget(): void {
    this.beforeArt.replaceChildren();
    this.isFitted = false;
  }

  drawNodes(): void {
    const { nodes, arms } = this.showsNodes ? nodesOf(this.drawing.paths()) : { nodes: "", arms: "" };
    this.nodes.setAttribute("d", nodes);
    this.arms.setAttribute("d", arms);
  }

  /** Shows the stretch of the visible steps, or hides it. */
  async drawStretch(): Promise<void> {
    const { app } = this;
    const answer = this.showsStretch
      ? await app.attempt(() => app.connection.ask({ do: "stretch", steps: app.visible })) : null;
    const stretch = this.showsStretch ? answer?.stretch : null;
    this.heat.replaceChildren(...(stretch ? cells(stretch, (p) => this.camera.inPx(p)) : []));
  }

  /** The next click on the drawing names a path. */
  pick(take: ((id: string) => void) | null): void {
    this.picks = take;
    this.svg.classList.toggle("picking", take !== null);
  }

  /** Puts everything in its place on the screen. */
  layout(): void {
    const { camera } = this;
    const layers = [this.sheet, this.art, this.beforeArt, this.nodes, this.arms, this.heat];
    for (const layer of layers) layer.setAttribute("transform", camera.transform);
    for (const mark of Array.from(this.marks.children) as SVGGElement[]) {
      const [x, y] = camera.toScreen(JSON.parse(mark.dataset.at!) as XY);
      mark.setAttribute("transform", `translate(${x} ${y})`);
    }
    this.placeHandles();
    this.onZoom();
  }

  private placeHandles(): void {
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
  }

  private rebuild(): void {
    const { handles } = this.app;
    this.elements.clear();
    const lines = handles?.lines() ?? [];
    this.lines = lines.map((line) => s("path", { class: `line ${line.kind}` }));
    this.reaches = lines.map((line) => (line.kind === "path" ? s("path", { class: "pull" }) : null));
    const knobs = (handles?.handles ?? []).map((handle) => {
      const body = handle.shape === "control" ? s("rect", { x: -4, y: -4, width: 8, height: 8, rx: 1.5, class: "body" })
        : s("circle", { r: handle.shape === "source" ? 5 : 6.5, class: "body" });
      const knob = s(
        "g",
        { class: `knob ${handle.shape}`, tabindex: 0, role: "button", "aria-label": handle.label, "data-key": handle.key },
        s("circle", { r: handle.shape === "node" ? REACH : REACH - 5, class: "reach" }), body,
      );
      knob.addEventListener("focus", () => this.focus(handle.key));
      this.elements.set(handle.key, knob);
      return knob;
    });
    this.guides.replaceChildren(...this.lines, ...this.reaches.filter((r) => r !== null));
    const had = document.activeElement?.closest(".knob") !== null && document.activeElement !== null;
    this.knobs.replaceChildren(...knobs.sort((a, b) => Number(a.classList.contains("node")) - Number(b.classList.contains("node"))));
    this.placeHandles();
    if (this.focused) {
      const again = this.elements.get(this.focused);
      if (!again) this.focus(null);
      else if (had) again.focus({ preventScroll: true });
      else this.focus(this.focused);
    }
  }

  /** Selects a handle. */
  focus(key: string | null): void {
    this.focused = key;
    for (const [k, element] of this.elements) element.classList.toggle("selected", k === key);
    this.onFocus(this.handle(key));
  }

  private handle(key: string | null): Handle | null {
    return this.app.handles?.handles.find((h) => h.key === key) ?? null;
  }

  private point(e: MouseEvent): XY {
    const box = this.svg.getBoundingClientRect();
    return [e.clientX - box.left, e.clientY - box.top];
  }

  private wheel(e: WheelEvent): void {
    e.preventDefault();
    // A trackpad's pinch arrives with Ctrl; a wheel turns in whole notches.
    if (e.ctrlKey || e.metaKey || (e.deltaX === 0 && Math.abs(e.deltaY) >= 50)) {
      return this.zoom(Math.exp(-e.deltaY * (e.ctrlKey && Math.abs(e.deltaY) < 50 ? 0.01 : 0.002)), this.point(e));
    }
    this.camera.shift = [this.camera.shift[0] - e.deltaX, this.camera.shift[1] - e.deltaY];
    this.layout();
  }

  private press(e: PointerEvent): void {
    if (this.picks) return this.picked(e);
    const knob = (e.target as Element).closest<SVGGElement>(".knob");
    this.touches.set(e.pointerId, this.point(e));
    if (this.touches.size === 2) return this.pinch();
    if (this.touches.size > 2) return;
    const isPull = (e.target as Element).matches(".pull");
    if (knob && e.button === 0 && !this.isBefore) this.drag(e, knob);
    else if (!(isPull && e.button === 0 && !this.isBefore && this.pull(e))) this.pan(e);
  }

  /** Follows a line that is pulled. Returns `false` if there is none. */
  private pull(e: PointerEvent): boolean {
    const { handles } = this.app;
    const pull = handles?.pull(this.camera.toUser(this.point(e)), REACH * this.camera.pixel);
    if (!handles || !pull) return false;
    let hasMoved = false;
    this.app.isDragging = true;
    this.follow(e, (to, event) => {
      if (this.touches.size > 1) return;
      hasMoved = true;
      pull.move(this.camera.toUser(to), this.modes.smooths);
      handles.write(pull.param);
      this.placeHandles();
      this.app.draft(event.timeStamp);
    }, () => {
      this.app.isDragging = false;
      if (hasMoved) void this.app.commit();
    });
    return true;
  }

  private picked(e: PointerEvent): void {
    const named = (e.target as Element).closest(".art [id]");
    const take = this.picks;
    this.pick(null);
    // The ids of the drawing stand behind a prefix.
    if (named) take?.(named.id.replace(/^art-/, ""));
  }

  /** Follows a pointer until it is lifted. */
  private follow(e: PointerEvent, move: (to: XY, e: PointerEvent) => void, end: () => void): void {
    const id = e.pointerId;
    const stop = new AbortController();
    const { signal } = stop;
    const done = (event: PointerEvent) => {
      if (event.pointerId !== id) return;
      this.touches.delete(id);
      stop.abort();
      end();
    };
    window.addEventListener(MOVES, (e) => {
      const event = e as PointerEvent;
      if (event.pointerId !== id) return;
      this.touches.set(id, this.point(event));
      move(this.point(event), event);
    }, { signal });
    window.addEventListener("pointerup", done, { signal });
    window.addEventListener("pointercancel", done, { signal });
  }

  private drag(e: PointerEvent, knob: SVGGElement): void {
    const handle = this.handle(knob.dataset.key!);
    if (!handle) return;
    e.preventDefault();
    knob.focus({ preventScroll: true });
    const grabbed = this.camera.toScreen(handle.get());
    const [x, y] = this.point(e);
    const mover = this.modes.mover(this.app.handles!, handle);
    let hasMoved = false;
    this.app.isDragging = true;
    knob.classList.add("held");
    this.follow(e, (to, event) => {
      if (this.touches.size > 1) return;
      hasMoved = true;
      const target = this.camera.toUser([grabbed[0] + to[0] - x, grabbed[1] + to[1] - y]);
      mover(this.modes.snapped(target, handle, this.app.handles!, 7 * this.camera.pixel, event), event);
      this.changed(handle, event.timeStamp);
    }, () => {
      knob.classList.remove("held");
      this.app.isDragging = false;
      this.modes.clear();
      if (hasMoved) void this.app.commit();
    });
  }

  private changed(handle: Handle, since: number): void {
    this.app.handles!.write(handle.param);
    this.placeHandles();
    this.onFocus(handle);
    this.app.draft(since);
  }

  private pan(e: PointerEvent): void {
    const first = this.point(e);
    let last = first;
    const start = this.camera.toUser(first);
    this.svg.classList.add("panning");
    this.follow(e, (to) => {
      if (this.touches.size > 1) return;
      this.camera.shift = [this.camera.shift[0] + to[0] - last[0], this.camera.shift[1] + to[1] - last[1]];
      last = to;
      this.layout();
    }, () => {
      this.svg.classList.remove("panning");
      const [x, y, w, h] = this.app.handles?.frame ?? [0, 0, 0, 0];
      const isInside = start[0] > x && start[0] < x + w && start[1] > y && start[1] < y + h;
      if (isInside && Math.hypot(last[0] - first[0], last[1] - first[1]) > REACH / 4) this.onPan();
    });
  }

  /** Two fingers move and magnify the view. */
  private pinch(): void {
    const [one, two] = Array.from(this.touches.keys());
    const stop = new AbortController();
    const { signal } = stop;
    const middle = (): [XY, number] => {
      const [a, b] = [this.touches.get(one!)!, this.touches.get(two!)!];
      return [[(a[0] + b[0]) / 2, (a[1] + b[1]) / 2], Math.hypot(a[0] - b[0], a[1] - b[1])];
    };
    let [at, apart] = middle();
    window.addEventListener("pointermove", (e) => {
      if (!this.touches.has(e.pointerId)) return;
      this.touches.set(e.pointerId, this.point(e));
      const [to, wide] = middle();
      this.camera.shift = [this.camera.shift[0] + to[0] - at[0], this.camera.shift[1] + to[1] - at[1]];
      if (apart > 0) this.camera.zoom(wide / apart, to);
      [at, apart] = [to, wide];
      this.layout();
    }, { signal });
    const end = (e: PointerEvent) => {
      this.touches.delete(e.pointerId);
      stop.abort();
    };
    window.addEventListener("pointerup", end, { signal });
    window.addEventListener("pointercancel", end, { signal });
  }

  private doubleClick(e: MouseEvent): void {
    if ((e.target as Element).closest(".knob")) return;
    const key = this.app.addPoint(this.camera.toUser(this.point(e)), REACH * this.camera.pixel);
    if (key) this.focused = key;
  }

  /** Arrow keys move a handle by a px of the screen, with Shift by ten. */
  private key(e: KeyboardEvent): void {
    const handle = this.handle((e.target as Element).closest<SVGGElement>(".knob")?.dataset.key ?? null);
    if (!handle || !this.app.handles) return;
    const by = ({ ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] } as Record<string, XY>)[e.key];
    if (by) {
      e.preventDefault();
      const far = e.shiftKey ? 10 : 1;
      const [x, y] = this.camera.toScreen(handle.get());
      this.moveTo(handle, this.camera.toUser([x + far * by[0], y + far * by[1]]));
    } else if (e.key === "Insert") {
      e.preventDefault();
      const [x, y] = handle.get();
      // Beside the point, where there is no line to divide.
      const at = this.app.handles.after(handle) ?? [x + 2 * REACH * this.camera.pixel, y] as XY;
      this.focused = this.app.addPoint(at, REACH * this.camera.pixel) ?? this.focused;
    } else if ((e.key === "Delete" || e.key === "Backspace") && handle.remove) {
      e.preventDefault();
      this.remove(handle);
    }
  }

  /** Takes a point away. */
  remove(handle: Handle): void {
    if (!handle.remove || !this.app.handles) return;
    handle.remove();
    this.app.handles.write(handle.param);
    this.focus(null);
    void this.app.commit();
  }

  /** Moves a handle by keys or by typed numbers. */
  moveTo(handle: Handle, to: XY): void {
    const { handles } = this.app;
    if (!handles) return;
    this.app.isDragging = true;
    this.modes.mover(handles, handle)(to, null);
    this.changed(handle, performance.now());
    clearTimeout(this.keysTimer);
    this.keysTimer = window.setTimeout(() => {
      this.app.isDragging = false;
      void this.app.commit();
    }, KEYS);
  }
}

/** Gives the ids of a drawing other names, and its references with them. */
function renamed(root: Element): Element {
  for (const element of Array.from(root.querySelectorAll("*"))) {
    for (const { name, value } of Array.from(element.attributes)) {
      if (name === "id") element.setAttribute(name, `before-${value}`);
      else if (value.includes("url(#")) element.setAttribute(name, value.replaceAll("url(#", "url(#before-"));
      else if (name.endsWith("href") && value.startsWith("#")) element.setAttribute(name, `#before-${value.slice(1)}`);
    }
  }
  return root;
}
