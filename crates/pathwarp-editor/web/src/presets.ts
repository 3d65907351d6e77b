// The dialog that keeps the present steps as a preset.

import type { App } from "./app";
import { byId } from "./dom";
import type { Gallery } from "./gallery";
import { toast } from "./toast";

export class Presets {
  private dialog = byId<HTMLDialogElement>("preset-dialog");
  private name = byId<HTMLInputElement>("preset-name");
  private message = byId("preset-message");

  constructor(private app: App, private gallery: Gallery) {
    byId("keep-preset").addEventListener("click", () => this.open());
    byId("preset-cancel").addEventListener("click", () => this.dialog.close());
    this.name.addEventListener("input", () => (this.message.textContent = ""));
    this.dialog.querySelector("form")!.addEventListener("submit", (e) => {
      e.preventDefault();
      void this.keep(this.name.value.trim());
    });
  }

  private open(): void {
    this.name.value = "";
    this.message.textContent = "";
    this.dialog.showModal();
  }

  private async keep(name: string): Promise<void> {
    try {
      if (!(await this.app.settle())) throw new Error(this.app.problem ?? "");
      const { presets } = await this.app.connection.ask({ do: "keep-preset", name });
      this.gallery.showPresets(presets ?? []);
      this.dialog.close();
      toast(`${name} is kept among the shapes`);
    } catch (e) {
      // The dialog covers the line of problems.
      this.message.textContent = e instanceof Error ? e.message : String(e);
    }
  }
}
