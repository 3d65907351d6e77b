// The target: another drawing or a picture behind the artwork, to fit to. It is seen here alone, and never saved.

import type { App } from "./app";
import { byId, s } from "./dom";
import { Field, asked, inUnits } from "./fields";
import { base64, bring } from "./opening";
import type { Stage } from "./stage";

const MM = 96 / 25.4;
/** The usual opacity, in per cent. */
const OPACITY = 50;

export class Target {
  private image = s("image", { class: "target", visibility: "hidden" });
  private button = byId<HTMLButtonElement>("target");
  private box = byId("target-box");
  private chosen = byId<HTMLInputElement>("target-file");
  private outline = byId<HTMLButtonElement>("target-outline");
  private file: File | null = null;
  /** Left, top and width in px of the drawing, and height over width. */
  private place = { x: 0, y: 0, width: 1 };
  private ratio = 1;
  /** The width of a drawing at its own size. */
  private natural = 1;
  private fields: Field[] = [];
  private opacity = byId<HTMLInputElement>("target-opacity");
  /** The program has been asked for the target, or told of it. */
  private isKept = false;

  constructor(private app: App, private stage: Stage) {
    stage.behind.append(this.image);
    this.button.addEventListener("click", () => (this.file ? this.show(this.box.hidden !== false) : this.chosen.click()));
    this.chosen.addEventListener("change", () => {
      const file = this.chosen.files?.[0];
      this.chosen.value = "";
      if (file) void this.take(file).then(() => this.keep());
    });
    this.opacity.addEventListener("input", () => this.image.setAttribute("opacity", String(Number(this.opacity.value) / 100)));
    this.opacity.addEventListener("change", () => void this.keep());
    byId("target-other").addEventListener("click", () => this.chosen.click());
    byId("target-remove").addEventListener("click", () => {
      this.clear();
      void this.keep();
    });
    this.outline.addEventListener("click", () => void this.shape());
    for (const name of ["x", "y", "width"] as const) {
      const input = byId<HTMLInputElement>(`target-${name}`);
      const least = name === "width" ? 0.01 : undefined;
      const inMm = (text: string) => inUnits(text, "mm") ?? NaN;
      const isWrong = (text: string) => (inMm(text) >= (least ?? -Infinity) ? null : asked("mm", least));
      const field = new Field(input, () => String(Number((this.place[name] / MM).toFixed(2))), (text) => {
        this.place[name] = inMm(text) * MM;
        this.lay();
        void this.keep();
        return null;
      }, isWrong);
      this.box.querySelector(".messages")!.append(field.message);
      this.fields.push(field);
    }
    app.listen((change) => {
      if (change === "link") this.isKept = false;
      if (change !== "state" || this.isKept) return;
      this.isKept = true;
      void (this.file ? this.keep() : this.restore());
    });
  }

  /** Lets the program keep the target for the next time the page is loaded. */
  private async keep(): Promise<void> {
    const { file, place, opacity } = this;
    const target = file && { name: file.name, type: file.type, bytes: await base64(file), place, opacity: opacity.value };
    await this.app.attempt(() => this.app.connection.ask({ do: "keep-target", target }));
  }

  private async restore(): Promise<void> {
    const kept = (await this.app.attempt(() => this.app.connection.ask({ do: "target" })))?.target;
    if (!kept) return;
    const content = Uint8Array.from(atob(kept.bytes), (c) => c.charCodeAt(0));
    if (!(await this.take(new File([content], kept.name, { type: kept.type })))) return;
    this.place = kept.place;
    this.opacity.value = kept.opacity;
    this.image.setAttribute("opacity", String(Number(kept.opacity) / 100));
    this.lay();
    this.show(false);
  }

  /** Shows a file behind the drawing: a drawing at its own size and place, a picture as wide as the page. */
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
    const isDrawing = /\.svgz?$/i.test(file.name);
    const [x0, y0, x1] = this.stage.pageBox;
    this.ratio = probe.naturalHeight / Math.max(probe.naturalWidth, 1);
    this.natural = probe.naturalWidth;
    this.place = isDrawing ? { x: 0, y: 0, width: probe.naturalWidth } : { x: x0, y: y0, width: x1 - x0 };
    this.outline.hidden = !isDrawing || this.app.state?.program !== null;
    this.image.setAttribute("href", url);
    this.image.setAttribute("opacity", String(Number(this.opacity.value) / 100));
    this.image.setAttribute("visibility", "visible");
    this.lay();
    this.show(true);
    return true;
  }

  private lay(): void {
    const { x, y, width } = this.place;
    for (const [name, value] of Object.entries({ x, y, width, height: width * this.ratio })) this.image.setAttribute(name, String(value));
    for (const field of this.fields) field.refresh();
  }

  private show(on: boolean): void {
    this.box.hidden = !on;
    this.button.setAttribute("aria-pressed", String(this.file !== null));
    this.button.setAttribute("aria-expanded", String(on));
    byId("target-name").textContent = this.file?.name ?? "";
  }

  private clear(): void {
    const href = this.image.getAttribute("href");
    if (href) URL.revokeObjectURL(href);
    this.image.removeAttribute("href");
    this.image.setAttribute("visibility", "hidden");
    this.opacity.value = String(OPACITY);
    this.file = null;
    this.show(false);
  }

  /** Puts the artwork into the outline of the target: its file is copied beside the drawing, and counts at its own size and place. */
  private async shape(): Promise<void> {
    const { app, file } = this;
    if (!file) return;
    const written = await bring(app, file);
    const closed = app.deformation("envelope")?.variants.find(({ param }) => param === "envelope");
    if (!written || !closed) return;
    this.place = { x: 0, y: 0, width: this.natural };
    this.lay();
    await app.choose("envelope", { envelope: [written] }, closed.label);
  }
}
