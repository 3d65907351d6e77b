// The background: another drawing or a picture behind the artwork, as a template. Only this page shows it, and it is never saved.

import type { App } from "./app";
import { ARROWS, byId, onFile, s } from "./dom";
import { parseWithPrefix } from "./drawing";
import { Field, describeLimits, inUnits, MM } from "./fields";
import { base64 } from "./opening";
import type { Stage } from "./stage";
import type { XY } from "./types";
import { short } from "./values";

/** The usual opacity, in percent. */
const OPACITY = 50;
/** With Shift, rotations are multiples of this angle, in degrees. */
const NOTCH = 15;
/** Distance between the upper edge and the rotation handle, in px. */
const ABOVE = 26;
/** Number of points on a path whose distances are measured. */
const SAMPLES = 100;

/** Position and width in px of the drawing before the rotation, and the rotation about its centre in degrees. */
interface Placement {
  x: number;
  y: number;
  width: number;
  turn: number;
}

/** The typed values: their units, the sizes of these in the units of `Placement`, and the least values. */
const TYPED: Record<keyof Placement, [string, number, number?]> = { x: ["mm", MM], y: ["mm", MM], width: ["mm", MM, 0.01], turn: ["°", 1] };

export class Background {
  private image = s("image", { class: "background" });
  /** The paths of the drawing, invisible but clickable. */
  private outlines = s("g", { class: "outlines", opacity: 0 });
  private layer = s("g", { visibility: "hidden" }, this.image, this.outlines);
  private edge = s("path", { class: "line arm" });
  private ground = s("path", { class: "ground", tabindex: 0, role: "button", "aria-label": "Background; arrow keys move it" });
  /** The corners, clockwise from the upper left, and the rotation handle. */
  private knobs = ["nw", "ne", "se", "sw", "turn"].map((part) => s("g", { class: `part ${part}` },
    s("title", {}, part === "turn" ? "Turn the background" : "Scale the background"), s("circle", { r: 16, class: "reach" }),
    part === "turn" ? s("circle", { r: 6, class: "body" }) : s("rect", { x: -5, y: -5, width: 10, height: 10, class: "body" })));
  private frame = s("g", { class: "lie", visibility: "hidden" }, this.ground, this.edge, ...this.knobs);
  private button = byId<HTMLButtonElement>("background");
  private box = byId("background-box");
  private fileInput = byId<HTMLInputElement>("background-file");
  private outline = byId<HTMLButtonElement>("background-outline");
  private file: File | null = null;
  private isDrawing = false;
  private placement: Placement = { x: 0, y: 0, width: 1, turn: 0 };
  /** Ratio of height to width. */
  private ratio = 1;
  private fields: Field[] = [];
  private opacity = byId<HTMLInputElement>("background-opacity");
  /** `true` once the server has been asked for the background, or has stored it. */
  private isKept = false;
  /** Requests points around the object in a photograph. */
  onOutline: (take: (value: string) => void) => void = () => {};

  constructor(private app: App, private stage: Stage) {
    stage.behind.append(this.layer);
    stage.overlay.append(this.frame);
    stage.around = () => (this.file ? this.corners : []);
    stage.onLayout.push(() => this.placeFrame());
    this.button.addEventListener("click", () => (this.file ? this.show(this.box.hidden !== false) : this.fileInput.click()));
    onFile(this.fileInput, async (file) => {
      await this.take(file);
      app.screen.reveal();
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
    for (const [name, [unit, size, least]] of Object.entries(TYPED) as [keyof Placement, [string, number, number?]][]) {
      const input = byId<HTMLInputElement>(`background-${name}`);
      const number = (text: string) => inUnits(text, unit) ?? NaN;
      const isWrong = (text: string) => (number(text) >= (least ?? -Infinity) ? null : describeLimits(unit, least));
      const field = new Field(input, () => String(Number((this.placement[name] / size).toFixed(2))), (text) => {
        this.move({ [name]: number(text) * size });
        void this.keep();
        return null;
      }, isWrong);
      this.box.querySelector(".messages")!.append(field.message);
      this.fields.push(field);
    }
    this.ground.addEventListener("pointerdown", (e) => this.drag(e, ([x, y]) => ([px, py]) => ({ x: this.placement.x + px - x, y: this.placement.y + py - y })));
    this.ground.addEventListener("keydown", (e) => this.key(e));
    this.knobs.forEach((knob, i) => knob.addEventListener("pointerdown", (e) => this.drag(e, (from) => (i < 4 ? this.scaling(i, from) : this.rotation(from)))));
    app.listen(["link"], () => (this.isKept = false));
    app.listen(["state"], () => {
      if (this.isKept) return;
      this.isKept = true;
      void (this.file ? this.keep() : this.restore());
    });
  }

  /** Stores the background in the server, until the page is loaded again. */
  private async keep(): Promise<void> {
    const { file, placement, opacity } = this;
    const background = file && { name: file.name, type: file.type, bytes: await base64(file), lie: placement, opacity: opacity.value };
    await this.app.request({ do: "keep-background", background });
  }

  private async restore(): Promise<void> {
    const kept = (await this.app.request({ do: "background" }))?.background;
    if (!kept) return;
    const content = Uint8Array.from(atob(kept.bytes), (c) => c.charCodeAt(0));
    if (!(await this.take(new File([content], kept.name, { type: kept.type })))) return;
    this.opacity.value = kept.opacity;
    this.showOpacity();
    this.move(kept.lie);
    this.show(false);
    this.app.screen.reveal();
  }

  private showOpacity(): void {
    this.image.setAttribute("opacity", String(Number(this.opacity.value) / 100));
  }

  /** Shows a file behind the drawing: a drawing at its original size and position, a picture as wide as the page. */
  private async take(file: File): Promise<boolean> {
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

  private get middle(): XY {
    const { x, y, width } = this.placement;
    return [x + width / 2, y + (width * this.ratio) / 2];
  }

  /** The corners clockwise from the upper left, in px of the drawing. */
  private get corners(): XY[] {
    const [[cx, cy], { x, y, width, turn }] = [this.middle, this.placement];
    const [cos, sin] = [Math.cos((turn * Math.PI) / 180), Math.sin((turn * Math.PI) / 180)];
    return [[x, y], [x + width, y], [x + width, y + width * this.ratio], [x, y + width * this.ratio]].map(([px, py]) => [
      cx + cos * (px! - cx) - sin * (py! - cy), cy + sin * (px! - cx) + cos * (py! - cy),
    ]);
  }

  /** Moves, scales or rotates it. */
  private move(change: Partial<Placement>): void {
    Object.assign(this.placement, change);
    const { x, y, width, turn } = this.placement;
    for (const [name, value] of Object.entries({ x, y, width, height: width * this.ratio })) this.image.setAttribute(name, String(value));
    this.layer.setAttribute("transform", `rotate(${turn} ${this.middle.join(" ")})`);
    this.outlines.setAttribute("transform", `translate(${x} ${y}) scale(${width / Number(this.outlines.dataset.width ?? 1)})`);
    for (const field of this.fields) field.refresh();
    this.placeFrame();
  }

  /** Updates the frame around it on the screen. */
  private placeFrame(): void {
    const { scale, shift } = this.stage.camera;
    const corners = this.corners.map(([x, y]): XY => [scale * x + shift[0], scale * y + shift[1]]);
    const [a, b] = [corners[0]!, corners[1]!];
    const [top, length]: [XY, number] = [[(a[0] + b[0]) / 2, (a[1] + b[1]) / 2], Math.hypot(b[0] - a[0], b[1] - a[1]) || 1];
    const turn: XY = [top[0] + (ABOVE * (b[1] - a[1])) / length, top[1] - (ABOVE * (b[0] - a[0])) / length];
    this.ground.setAttribute("d", `M${corners.join("L")}Z`);
    this.edge.setAttribute("d", `M${corners.join("L")}ZM${top}L${turn}`);
    [...corners, turn].forEach((p, i) => this.knobs[i]!.setAttribute("transform", `translate(${p})`));
  }

  /** Returns the scalings about the opposite corner by a pointer that pressed at `from`. */
  private scaling(corner: number, from: XY): (to: XY) => Partial<Placement> {
    const [[ox, oy], [cx, cy], { width }] = [this.corners[(corner + 2) % 4]!, this.middle, this.placement];
    const [ax, ay] = [from[0] - ox, from[1] - oy];
    return (to) => {
      const factor = Math.max(((to[0] - ox) * ax + (to[1] - oy) * ay) / (ax * ax + ay * ay || 1), 1e-3);
      return { x: ox + factor * (cx - ox) - (factor * width) / 2, y: oy + factor * (cy - oy) - (factor * width * this.ratio) / 2, width: factor * width };
    };
  }

  private rotation(from: XY): (to: XY, e: PointerEvent) => Partial<Placement> {
    const [[cx, cy], { turn }] = [this.middle, this.placement];
    const angle = ([x, y]: XY) => (Math.atan2(y - cy, x - cx) * 180) / Math.PI;
    return (to, { shiftKey }) => {
      const now = turn + angle(to) - angle(from);
      return { turn: shiftKey ? NOTCH * Math.round(now / NOTCH) : ((now + 540) % 360) - 180 };
    };
  }

  /** Follows a pointer from a point in px of the drawing until it is lifted, or Escape cancels the drag. */
  private drag(e: PointerEvent, begin: (from: XY) => (to: XY, e: PointerEvent) => Partial<Placement>): void {
    if (e.button !== 0) return;
    e.stopPropagation();
    const before = { ...this.placement };
    const at = (event: PointerEvent): XY => {
      const { scale, shift } = this.stage.camera;
      const [x, y] = this.stage.point(event);
      return [(x - shift[0]) / scale, (y - shift[1]) / scale];
    };
    const change = begin(at(e));
    const stop = new AbortController();
    const end = () => {
      stop.abort();
      void this.keep();
    };
    window.addEventListener("pointermove", (event) => {
      if (event.pointerId !== e.pointerId) return;
      Object.assign(this.placement, before);
      this.move(change(at(event), event));
    }, stop);
    for (const lifted of ["pointerup", "pointercancel"]) window.addEventListener(lifted, end, stop);
    window.addEventListener("keydown", ({ key }) => {
      if (key !== "Escape") return;
      this.move(before);
      end();
    }, stop);
  }

  private key(e: KeyboardEvent): void {
    const direction = ARROWS[e.key];
    if (!direction) return;
    e.preventDefault();
    e.stopPropagation();
    const px = (e.shiftKey ? 10 : 1) / this.stage.camera.scale;
    this.move({ x: this.placement.x + px * direction[0], y: this.placement.y + px * direction[1] });
    void this.keep();
  }

  private show(on: boolean): void {
    this.box.hidden = !on;
    this.layer.setAttribute("visibility", this.file ? "visible" : "hidden");
    this.frame.setAttribute("visibility", on ? "visible" : "hidden");
    this.button.setAttribute("aria-pressed", String(this.file !== null));
    this.button.setAttribute("aria-expanded", String(on));
    byId("background-name").textContent = this.file?.name ?? "";
  }

  private clear(): void {
    const href = this.image.getAttribute("href");
    if (href) URL.revokeObjectURL(href);
    this.image.removeAttribute("href");
    this.outlines.replaceChildren();
    this.opacity.value = String(OPACITY);
    this.file = null;
    this.show(false);
  }

  /** Bends the artwork into an outline of the background: a clicked path, or points around the object in a photograph. */
  private async bendInto(): Promise<void> {
    const { app, file, stage, outlines } = this;
    // The variant of one closed path.
    const variant = app.deformation("envelope")?.variants.find(({ param }) => param === "envelope");
    if (!file || !variant) return;
    const choose = (value: string) => void app.choose("envelope", { envelope: [value] }, variant.label);
    this.show(false);
    if (!this.isDrawing) return this.onOutline(choose);
    if (outlines.childElementCount === 0) {
      const bytes = await base64(file);
      const answer = await app.request({ do: "drawn", name: file.name, bytes });
      const root = parseWithPrefix(answer?.svg, "behind");
      if (!root) return;
      outlines.dataset.width = root.getAttribute("width") ?? "1";
      outlines.replaceChildren(...Array.from(root.children));
      this.move({});
    }
    const paths = Array.from(outlines.querySelectorAll<SVGPathElement>("path")).filter((path) => !path.closest("defs"));
    if (paths.length === 0) return app.fail(`${file.name} has no paths: click points around a shape with “Draw path” among the settings of “${variant.label}”`);
    const [only] = paths;
    if (only && paths.length === 1 && !/Z.*M/i.test(only.getAttribute("d") ?? "")) return choose(ring(only, stage, this.corners[0]!));
    stage.pick((path, at) => choose(ring(path, stage, stage.camera.inPx(at))), `Click a path of ${file.name}`, ".outlines path");
  }
}

/** Returns the closed line of a path of the page that is nearest to a point in px of the drawing, as path data in the drawing's units. */
function ring(path: SVGGraphicsElement, stage: Stage, [x, y]: XY): string {
  const [box, m] = [stage.svg.getBoundingClientRect(), path.getScreenCTM()!];
  const toUser = (px: number, py: number) => stage.camera.toUser([m.a * px + m.c * py + m.e - box.x, m.b * px + m.d * py + m.f - box.y]);
  const rings = (path.getAttribute("d") ?? "").split(/(?=M)/).map((d) => d.replace(/Z\s*$/, "").replace(/(-?[\d.]+)[\s,]+(-?[\d.]+)/g, (_, px: string, py: string) => toUser(Number(px), Number(py)).map(short).join(",")));
  const distance = (d: string): number => {
    const line = s("path", { d });
    const samples = Array.from({ length: SAMPLES }, (_, i) => line.getPointAtLength((line.getTotalLength() * i) / SAMPLES));
    return Math.min(...samples.map((p) => stage.camera.inPx([p.x, p.y])).map(([px, py]) => Math.hypot(px - x, py - y)));
  };
  const nearest = rings.reduce((best, d) => (distance(d) < distance(best) ? d : best));
  return `${nearest.trim()} Z`;
}
