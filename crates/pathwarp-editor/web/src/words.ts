// Words as the drawing: typed, set in an installed font, and edited later under the same steps.

import type { App } from "./app";
import { byId, h } from "./dom";
import { inUnits, inWords, reason } from "./fields";
import { toast } from "./toast";

export const BUNDLED = "Noto Sans (bundled)";
/** The largest size of words in mm, and the largest absolute spacing in percent. */
const MAX_SIZE = 2000;
const MAX_SPACING = 500;

export class WordsDialog {
  private dialog = byId<HTMLDialogElement>("words-dialog");
  private text = byId<HTMLTextAreaElement>("words-text");
  private search = byId<HTMLInputElement>("words-search");
  private fonts = byId<HTMLSelectElement>("words-font");
  private size = byId<HTMLInputElement>("words-size");
  private spacing = byId<HTMLInputElement>("words-spacing");
  private message = byId("words-message");
  private families: string[] | null = null;
  private font: string | null = null;
  /** Called to place words on the drawing, with these values. */
  onPlace: (args: Record<string, string[]>) => void = () => {};

  constructor(private app: App) {
    byId("words").addEventListener("click", () => void this.open());
    byId("words-place").addEventListener("click", () => {
      this.dialog.close();
      const { value } = this.text;
      this.onPlace({ ...(value.trim() && !this.app.state?.words && { words: value.split("\n") }), ...(this.font && { font: [this.font] }) });
    });
    byId("words-cancel").addEventListener("click", () => this.dialog.close());
    this.search.addEventListener("input", () => this.list());
    this.fonts.addEventListener("change", () => (this.font = this.fonts.value === BUNDLED ? null : this.fonts.value));
    this.dialog.querySelector("form")!.addEventListener("submit", (e) => {
      e.preventDefault();
      void this.set();
    });
    app.listen(["state"], () => this.show());
  }

  private show(): void {
    const { state } = this.app;
    byId("words").textContent = state?.words ? "Edit words…" : "Words…";
    byId("words-set").textContent = state?.words ? "Set words" : "New drawing";
    byId("words-place").classList.toggle("primary", !state?.words);
    byId("words-set").classList.toggle("primary", !!state?.words);
    if (state?.program) byId("words").hidden = true;
  }

  private async open(): Promise<void> {
    if (!(await this.app.settle())) return;
    const answer = this.families ? null : await this.app.request({ do: "families" });
    this.families ??= answer?.families ?? [];
    const { text, font, size, spacing } = this.app.state?.words ?? { text: "", font: null, size: 20, spacing: 0 };
    [this.text.value, this.size.value, this.spacing.value, this.search.value] = [text, String(size), String(spacing), ""];
    this.font = font;
    this.list();
    const isMissing = font !== null && !this.families.includes(font);
    this.message.textContent = isMissing ? `${font} is not installed here. The letters stay as they are until you choose another font` : "";
    this.dialog.showModal();
    this.text.focus();
  }

  /** Lists the families that match the typed text, each in its letters. */
  private list(): void {
    const wanted = this.search.value.trim().toLowerCase();
    const all = [BUNDLED, ...(this.families ?? [])].filter((name) => name.toLowerCase().includes(wanted));
    this.fonts.replaceChildren(...all.map((name) => {
      const option = h("option", { value: name }, name);
      if (name !== BUNDLED) option.style.setProperty("font-family", `"${name.replaceAll('"', "")}", system-ui`);
      return option;
    }));
    this.fonts.value = this.font ?? BUNDLED;
    this.fonts.selectedOptions[0]?.scrollIntoView({ block: "nearest" });
  }

  private async set(): Promise<void> {
    const { app } = this;
    const [size, spacing] = [inUnits(this.size.value, "mm") ?? NaN, inUnits(this.spacing.value, "%") ?? NaN];
    if (this.text.value.trim() === "") return this.say("Type some words first");
    if (!(size > 0 && size <= MAX_SIZE)) return this.say(`The size is a number of mm up to ${MAX_SIZE}, such as 20`);
    if (!(Math.abs(spacing) <= MAX_SPACING)) return this.say("The spacing is a number of per cent, such as 5");
    try {
      const words = { text: this.text.value, font: this.font, size, spacing };
      await app.enter(async () => {
        const answer = await app.connection.ask({ do: "set-words", words });
        this.dialog.close();
        if (answer.lacking?.length) toast(`The font lacks ${answer.lacking.join(" ")}. Choose one that has them.`);
        return answer;
      });
    } catch (e) {
      this.say(inWords(reason(e)));
    }
  }

  private say(text: string): void {
    this.message.textContent = text;
  }
}
