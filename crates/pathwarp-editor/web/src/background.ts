// The background: another drawing or a picture behind the artwork, as a template. Only this page shows it, and it is never saved.

import type { App } from "./app";
import { byId, s } from "./dom";
import { apart } from "./drawing";
import { Field, asked, inUnits } from "./fields";
import { base64 } from "./opening";
import type { Stage } from "./stage";
import type { XY } from "./types";
import { short } from "./values";

const MM = 96 / 25.4;
/** The usual opacity, in percent. */
const OPACITY = 50;
/** With Shift, rotations are multiples of this angle, in degrees. */
const NOTCH = 15;
/** Distance between the upper edge and the rotation handle, in px. */
const ABOVE = 26;
/** Number of points on a path whose distances are measured. */
const PLACES = 100;

/** Position and width in px of the drawing before the rotation, and the rotation about its centre in degrees. */
interface Lie {
  x: number;
  y: number;
  width: number;
  turn: number;
}

/** The typed values: their units, the sizes of these in the units of `Lie`, and the least values. */
const TYPED: Record<keyof Lie, [string, number, number?]> = { x: ["mm", MM], y: ["mm", MM], width: ["mm", MM, 0.01], turn: ["°", 1] };

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
  private chosen = byId<HTMLInputElement>("background-file");
  private outline = byId<HTMLButtonElement>("background-outline");
  private file: File | null = null;
  private isDrawing = false;
  private lie: Lie = { x: 0, y: 0, width: 1, turn: 0 };
  /** Ratio of height to width. */
  private ratio = 1;
  private fields: Field[] = [];
  private opacity = byId<HTMLInputElement>("background-opacity");
  /** `true` once the server has been asked for the background, or has stored it. */
  private isKept = false;
  /** Requests points around the object in a photograph. */
  onRound: (take: (value: string) => void) => void = () => {};

  constructor(private app: App, private stage: Stage) {
    stage.behind.append(this.layer);
    stage.overlay.append(this.frame);
    stage.around = () => (this.file ? this.corners : []);
    stage.onLayout.push(() => this.place());
    this.button.addEventListener("click", () => (this.file ? this.show(this.box.hidden !== false) : this.chosen.click()));
    this.chosen.addEventListener("change", () => {
      const file = this.chosen.files?.[0];
      this.chosen.value = "";
      if (file) {
        void this.take(file).then(() => {
          app.screen.reveal();
          return this.keep();
        });
      }
    });
    this.opacity.addEventListener("input", () => this.image.setAttribute("opacity", String(Number(this.opacity.value) / 100)));
    this.opacity.addEventListener("change", () => void this.keep());
    byId("background-other").addEventListener("click", () => this.chosen.click());
    byId("background-remove").addEventListener("click", () => {
      this.clear();
      void this.keep();
    });
    this.outline.addEventListener("click", () => void this.shape());
    for (const [name, [unit, size, least]] of Object.entries(TYPED) as [keyof Lie, [string, number, number?]][]) {
      const input = byId<HTMLInputElement>(`background-${name}`);
      const number = (text: string) => inUnits(text, unit) ?? NaN;
      const isWrong = (text: string) => (number(text) >= (least ?? -Infinity) ? null : asked(unit, least));
      const field = new Field(input, () => String(Number((this.lie[name] / size).toFixed(2))), (text) => {
        this.lay({ [name]: number(text) * size });
        void this.keep();
        return null;
      }, isWrong);
      this.box.querySelector(".messages")!.append(field.message);
      this.fields.push(field);
    }
    this.ground.addEventListener("pointerdown", (e) => this.grab(e, ([x, y]) => ([px, py]) => ({ x: this.lie.x + px - x, y: this.lie.y + py - y })));
    this.ground.addEventListener("keydown", (e) => this.key(e));
    this.knobs.forEach((knob, i) => knob.addEventListener("pointerdown", (e) => this.grab(e, (from) => (i < 4 ? this.scaled(i, from) : this.turned(from)))));
    app.listen((change) => {
      if (change === "link") this.isKept = false;
      if (change !== "state" || this.isKept) return;
      this.isKept = true;
      void (this.file ? this.keep() : this.restore());
    });
  }

  /** Stores the background in the server, until the page is loaded again. */
  private async keep(): Promise<void> {
    const { file, lie, opacity } = this;
    const background = file && { name: file.name, type: file.type, bytes: await base64(file), lie, opacity: opacity.value };
    await this.app.attempt(() => this.app.connection.ask({ do: "keep-background", background }));
  }

  private async restore(): Promise<void> {
    const kept = (await this.app.attempt(() => this.app.connection.ask({ do: "background" })))?.background;
    if (!kept) return;
    const content = Uint8Array.from(atob(kept.bytes), (c) => c.charCodeAt(0));
    if (!(await this.take(new File([content], kept.name, { type: kept.type })))) return;
    this.opacity.value = kept.opacity;
    this.image.setAttribute("opacity", String(Number(kept.opacity) / 100));
    this.lay(kept.lie);
    this.show(false);
    this.app.screen.reveal();
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
    this.image.setAttribute("opacity", String(Number(this.opacity.value) / 100));
    this.lay(this.isDrawing ? { x: 0, y: 0, width: probe.naturalWidth, turn: 0 } : { x: x0, y: y0, width: x1 - x0, turn: 0 });
    this.show(true);
    return true;
  }

  private get middle(): XY {
    const { x, y, width } = this.lie;
    return [x + width / 2, y + (width * this.ratio) / 2];
  }

  /** The corners clockwise from the upper left, in px of the drawing. */
  private get corners(): XY[] {
    const [[cx, cy], { x, y, width, turn }] = [this.middle, this.lie];
    const [cos, sin] = [Math.cos((turn * Math.PI) / 180), Math.sin((turn * Math.PI) / 180)];
    return [[x, y], [x + width, y], [x + width, y + width * this.ratio], [x, y + width * this.ratio]].map(([px, py]) => [
      cx + cos * (px! - cx) - sin * (py! - cy), cy + sin * (px! - cx) + cos * (py! - cy),
    ]);
  }

  /** Moves, scales or rotates it. */
  private lay(change: Partial<Lie>): void {
    Object.assign(this.lie, change);
    const { x, y, width, turn } = this.lie;
    for (const [name, value] of Object.entries({ x, y, width, height: width * this.ratio })) this.image.setAttribute(name, String(value));
    this.layer.setAttribute("transform", `rotate(${turn} ${this.middle.join(" ")})`);
    this.outlines.setAttribute("transform", `translate(${x} ${y}) scale(${width / Number(this.outlines.dataset.width ?? 1)})`);
    for (const field of this.fields) field.refresh();
    this.place();
  }

  /** Updates the frame around it on the screen. */
  private place(): void {
    const { scale, shift } = this.stage.camera;
    const corners = this.corners.map(([x, y]): XY => [scale * x + shift[0], scale * y + shift[1]]);
    const [a, b] = [corners[0]!, corners[1]!];
    const [top, long]: [XY, number] = [[(a[0] + b[0]) / 2, (a[1] + b[1]) / 2], Math.hypot(b[0] - a[0], b[1] - a[1]) || 1];
    const turn: XY = [top[0] + (ABOVE * (b[1] - a[1])) / long, top[1] - (ABOVE * (b[0] - a[0])) / long];
    this.ground.setAttribute("d", `M${corners.join("L")}Z`);
    this.edge.setAttribute("d", `M${corners.join("L")}ZM${top}L${turn}`);
    [...corners, turn].forEach((p, i) => this.knobs[i]!.setAttribute("transform", `translate(${p})`));
  }

  /** Returns a scaling about the opposite corner. */
  private scaled(corner: number, from: XY): (to: XY) => Partial<Lie> {
    const [[ox, oy], [cx, cy], { width }] = [this.corners[(corner + 2) % 4]!, this.middle, this.lie];
    const [ax, ay] = [from[0] - ox, from[1] - oy];
    return (to) => {
      const k = Math.max(((to[0] - ox) * ax + (to[1] - oy) * ay) / (ax * ax + ay * ay || 1), 1e-3);
      return { x: ox + k * (cx - ox) - (k * width) / 2, y: oy + k * (cy - oy) - (k * width * this.ratio) / 2, width: k * width };
    };
  }

  private turned(from: XY): (to: XY, e: PointerEvent) => Partial<Lie> {
    const [[cx, cy], { turn }] = [this.middle, this.lie];
    const angle = ([x, y]: XY) => (Math.atan2(y - cy, x - cx) * 180) / Math.PI;
    return (to, { shiftKey }) => {
      const now = turn + angle(to) - angle(from);
      return { turn: shiftKey ? NOTCH * Math.round(now / NOTCH) : ((now + 540) % 360) - 180 };
    };
  }

  /** Follows a pointer from a point in px of the drawing until it is lifted, or Escape cancels the drag. */
  private grab(e: PointerEvent, begin: (from: XY) => (to: XY, e: PointerEvent) => Partial<Lie>): void {
    if (e.button !== 0) return;
    e.stopPropagation();
    const before = { ...this.lie };
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
      Object.assign(this.lie, before);
      this.lay(change(at(event), event));
    }, stop);
    for (const lifted of ["pointerup", "pointercancel"]) window.addEventListener(lifted, end, stop);
    window.addEventListener("keydown", ({ key }) => {
      if (key !== "Escape") return;
      this.lay(before);
      end();
    }, stop);
  }

  private key(e: KeyboardEvent): void {
    const by = ({ ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] } as Record<string, XY>)[e.key];
    if (!by) return;
    e.preventDefault();
    e.stopPropagation();
    const far = (e.shiftKey ? 10 : 1) / this.stage.camera.scale;
    this.lay({ x: this.lie.x + far * by[0], y: this.lie.y + far * by[1] });
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
  private async shape(): Promise<void> {
    const { app, file, stage, outlines } = this;
    const closed = app.deformation("envelope")?.variants.find(({ param }) => param === "envelope");
    if (!file || !closed) return;
    const choose = (value: string) => void app.choose("envelope", { envelope: [value] }, closed.label);
    this.show(false);
    if (!this.isDrawing) return this.onRound(choose);
    if (outlines.childElementCount === 0) {
      const bytes = await base64(file);
      const answer = await app.attempt(() => app.connection.ask({ do: "drawn", name: file.name, bytes }));
      const root = apart(answer?.svg, "behind");
      if (!root) return;
      outlines.dataset.width = root.getAttribute("width") ?? "1";
      outlines.replaceChildren(...Array.from(root.children));
      this.lay({});
    }
    const paths = Array.from(outlines.querySelectorAll<SVGPathElement>("path")).filter((path) => !path.closest("defs"));
    if (paths.length === 0) return app.fail(`${file.name} has no paths: click points around a shape with “Draw path” among the settings of “${closed.label}”`);
    const [only] = paths;
    if (only && paths.length === 1 && !/Z.*M/i.test(only.getAttribute("d") ?? "")) return choose(ring(only, stage, this.corners[0]!));
    stage.pick((path, at) => choose(ring(path, stage, stage.camera.inPx(at))), ".outlines path", `Click a path of ${file.name}`);
  }
}

/** Returns the closed line of a path of the page that is nearest to a point in px of the drawing, as path data in the drawing's units. */
function ring(path: SVGGraphicsElement, stage: Stage, [x, y]: XY): string {
  const [box, m] = [stage.svg.getBoundingClientRect(), path.getScreenCTM()!];
  const place = (px: number, py: number) => stage.camera.toUser([m.a * px + m.c * py + m.e - box.x, m.b * px + m.d * py + m.f - box.y]);
  const rings = (path.getAttribute("d") ?? "").split(/(?=M)/).map((d) => d.replace(/Z\s*$/, "").replace(/(-?[\d.]+)[\s,]+(-?[\d.]+)/g, (_, px: string, py: string) => place(Number(px), Number(py)).map(short).join(",")));
  const far = (d: string): number => {
    const line = s("path", { d });
    const places = Array.from({ length: PLACES }, (_, i) => line.getPointAtLength((line.getTotalLength() * i) / PLACES));
    return Math.min(...places.map((p) => stage.camera.inPx([p.x, p.y])).map(([px, py]) => Math.hypot(px - x, py - y)));
  };
  const nearest = rings.reduce((best, d) => (far(d) < far(best) ? d : best));
  return `${nearest.trim()} Z`;
}
