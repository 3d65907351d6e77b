// The dialog that stores the present steps as a preset.

import type { App } from "./app";
import { byId } from "./dom";
import { reason } from "./fields";
import type { Gallery } from "./gallery";
import { toast } from "./toast";

export class Presets {
  private dialog = byId<HTMLDialogElement>("preset-dialog");
  private name = byId<HTMLInputElement>("preset-name");
  private message = byId("preset-message");
  private replace = byId<HTMLButtonElement>("preset-replace");

  constructor(private app: App, private gallery: Gallery) {
    byId("keep-preset").addEventListener("click", () => this.open());
    byId("preset-cancel").addEventListener("click", () => this.dialog.close());
    this.name.addEventListener("input", () => this.say(""));
    this.replace.addEventListener("click", () => void this.keep(this.name.value.trim(), true));
    this.dialog.querySelector("form")!.addEventListener("submit", (e) => {
      e.preventDefault();
      void this.keep(this.name.value.trim(), false);
    });
  }

  private open(): void {
    this.name.value = "";
    this.say("");
    this.dialog.showModal();
  }

  private say(text: string, canReplace = false): void {
    this.message.textContent = text;
    this.replace.hidden = !canReplace;
  }

  private async keep(name: string, replaces: boolean): Promise<void> {
    if (!replaces && this.gallery.names.includes(name)) return this.say(`${name} exists already.`, true);
    try {
      if (!(await this.app.settle())) throw new Error(this.app.problem ?? "");
      const { presets } = await this.app.connection.ask({ do: "keep-preset", name });
      this.gallery.showPresets(presets ?? []);
      this.dialog.close();
      toast(`${name} is kept among the shapes`);
    } catch (e) {
      // The dialog covers the line for problems.
      this.say(reason(e));
    }
  }
}
