// The place of the selected handle, to read and to type.

import type { App } from "./app";
import { byId } from "./dom";
import type { Stage } from "./stage";
import type { Handle } from "./types";
import { short } from "./values";

/** Decimals of the places on show. */
const DECIMALS = 3;

export class Place {
  private box = byId("place");
  private fields = [byId<HTMLInputElement>("place-x"), byId<HTMLInputElement>("place-y")] as const;
  private remove = byId<HTMLButtonElement>("remove-point");
  private handle: Handle | null = null;

  constructor(app: App, stage: Stage) {
    stage.onFocus = (handle) => this.show(handle);
    stage.onKeys = (handle) => this.say(handle);
    this.fields.forEach((field, i) => field.addEventListener("change", () => {
      const value = Number(field.value.replace(",", "."));
      if (!this.handle || field.value.trim() === "" || !Number.isFinite(value)) return this.show(this.handle);
      const at = this.handle.get();
      stage.moveTo(this.handle, i === 0 ? [value, at[1]] : [at[0], value]);
    }));
    this.remove.addEventListener("click", () => {
      if (this.handle) stage.remove(this.handle);
    });
    app.listen((change) => {
      if (change === "handles") this.show(stage.focusedHandle);
    });
  }

  private show(handle: Handle | null): void {
    this.handle = handle;
    this.box.classList.toggle("off", handle === null);
    if (!handle) return;
    byId("place-name").textContent = handle.label;
    this.remove.hidden = !handle.remove;
    const places = shown(handle);
    this.fields.forEach((field, i) => {
      if (document.activeElement !== field) field.value = places[i]!;
    });
  }

  /** Tells screen readers where keys have moved a handle. */
  private say(handle: Handle): void {
    byId("spoken").textContent = `${handle.label}: ${shown(handle).join(", ")}`;
  }
}

function shown(handle: Handle): string[] {
  return handle.get().map((v) => short(Number(v.toFixed(DECIMALS))));
}
