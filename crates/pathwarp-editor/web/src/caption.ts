// Words on the drawing: a click places them, and they are typed while the drawing shows them.

import type { App } from "./app";
import { byId } from "./dom";
import { isCaption } from "./names";
import type { Sketching } from "./sketch";
import type { Stage } from "./stage";
import type { Step } from "./types";
import { short } from "./values";

/** Distance between the words and the field, in px. */
const BELOW = 14;

export class Caption {
  private box = byId("caption-box");
  private text = byId<HTMLTextAreaElement>("caption-text");
  private step: Step | null = null;
  /** The words when typing began; empty for new ones. */
  private before = "";

  constructor(private app: App, private stage: Stage, private sketching: Sketching) {
    this.text.addEventListener("input", () => this.typed());
    this.text.addEventListener("blur", () => this.done());
    this.text.addEventListener("keydown", (e) => {
      if (e.key === "Escape") this.text.blur();
    });
    stage.svg.addEventListener("dblclick", () => {
      if (app.step && isCaption(app.step)) this.open(app.step, (app.step.args.words ?? []).join("\n"));
    });
  }

  /** Asks for the position of words with these values. */
  begin(args: Record<string, string[]>): void {
    this.sketching.begin("point", async (value) => {
      const [x, y] = await this.app.source(value.split(",").map(Number) as [number, number]);
      const step = await this.app.caption({ ...args, at: [`${short(x)},${short(y)}`] });
      if (step) this.open(step, (args.words ?? []).join("\n"), "");
    });
  }

  private open(step: Step, text: string, before = text): void {
    [this.step, this.before, this.text.value] = [step, before, text];
    this.box.hidden = false;
    this.place();
    this.text.focus();
    this.text.select();
  }

  /** Positions the field below the words. */
  place(): void {
    const at = this.stage.handle("at")?.get();
    if (this.box.hidden || !at) return;
    const [x, y] = this.stage.camera.toScreen(at);
    const { clientWidth, clientHeight } = this.stage.svg;
    const clamp = (v: number, most: number) => Math.min(Math.max(v, 0), Math.max(most, 0));
    this.box.style.left = `${clamp(x, clientWidth - this.box.offsetWidth)}px`;
    this.box.style.top = `${clamp(y + BELOW, clientHeight - this.box.offsetHeight)}px`;
  }

  private typed(): void {
    this.text.rows = this.text.value.split("\n").length;
    if (!this.step || this.text.value.trim() === "") return;
    this.step.args.words = this.text.value.split("\n");
    this.app.draft(performance.now());
    this.app.tell("values");
  }

  /** Stores the typed words, or removes them if there are none. */
  private done(): void {
    const { app, step, text, before } = this;
    // Another picture may have replaced the steps.
    const at = step ? app.steps.indexOf(step) : -1;
    this.step = null;
    this.box.hidden = true;
    if (at < 0) return;
    if (text.value.trim() !== "") return text.value === before ? undefined : void app.commit();
    if (before === "" && app.state) void app.load(app.state);
    else void app.arrange(app.steps.toSpliced(at, 1), at);
  }
}
