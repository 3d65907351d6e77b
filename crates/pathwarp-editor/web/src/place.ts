// The position of the selected handle, to read and to type.

import type { App } from "./app";
import { byId } from "./dom";
import { describeLimits, evaluate, Field, inUnits } from "./fields";
import type { Stage } from "./stage";
import type { Handle } from "./types";
import { short } from "./values";

/** Decimals of the positions shown. */
const DECIMALS = 3;

export class Place {
  private box = byId("place");
  private inputs = [byId<HTMLInputElement>("place-x"), byId<HTMLInputElement>("place-y")] as const;
  private fields: Field[];
  private remove = byId<HTMLButtonElement>("remove-point");
  private handle: Handle | null = null;

  constructor(app: App, stage: Stage) {
    stage.onFocus = (handle) => this.show(handle);
    stage.onKeys = (handle) => this.say(handle);
    this.fields = this.inputs.map((input, i) => {
      // A percentage is a position in the box.
      const coordinate = (typed: string): number | null => {
        const q = evaluate(typed, "");
        const [x, y, w, h] = app.handles?.frame ?? [0, 0, 1, 1];
        if (!q || q.unit === "") return q?.value ?? null;
        if (q.unit === "%") return i === 0 ? x + (w * q.value) / 100 : y + (h * q.value) / 100;
        const [a, b] = app.state?.toPx ?? [1, 0];
        const px = inUnits(typed, "px");
        return px === null ? null : px / Math.hypot(a, b);
      };
      const move = (value: number) => {
        const at = this.handle!.get();
        stage.moveTo(this.handle!, i === 0 ? [value, at[1]] : [at[0], value]);
      };
      const read = () => (this.handle ? shown(this.handle)[i]! : "");
      const isWrong = (typed: string) => (coordinate(typed) === null ? `${describeLimits("")} or 50 %` : null);
      const take = (typed: string) => {
        if (this.handle && typed !== read()) move(coordinate(typed)!);
        return null;
      };
      const nudge = (typed: string, by: number) => {
        const value = coordinate(typed);
        if (value === null || !this.handle) return null;
        move(value + by);
        return read();
      };
      const field = new Field(input, read, take, isWrong, nudge);
      input.parentElement!.after(field.message);
      return field;
    });
    this.remove.addEventListener("click", () => {
      if (this.handle) stage.remove(this.handle);
    });
    app.listen(["handles"], () => this.show(stage.focusedHandle));
  }

  private show(handle: Handle | null): void {
    this.handle = handle;
    this.box.classList.toggle("off", handle === null);
    if (!handle) return;
    byId("place-name").textContent = handle.label;
    this.remove.hidden = !handle.remove;
    for (const field of this.fields) field.refresh();
  }

  /** Tells screen readers the position to which keys have moved a handle. */
  private say(handle: Handle): void {
    byId("spoken").textContent = `${handle.label}: ${shown(handle).join(", ")}`;
  }
}

function shown(handle: Handle): string[] {
  return handle.get().map((v) => short(Number(v.toFixed(DECIMALS))));
}
