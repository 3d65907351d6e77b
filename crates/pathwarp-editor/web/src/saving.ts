// Saves the result beside the drawing, in other formats, as a recipe, or as a command line.

import type { App } from "./app";
import { byId, h } from "./dom";
import { inUnits, inWords, reason } from "./fields";
import { toast } from "./toast";

/** Extensions, names and uses of the formats. */
const FORMATS: [string, string, string][] = [
  ["svg", "SVG", "Can be opened here again"],
  ["svgz", "SVGZ", "The same, packed"],
  ["pdf", "PDF", "For print"],
  ["dxf", "DXF", "For cutters and CAD"],
  ["png", "PNG", "A picture"],
  ["jpg", "JPEG", "A picture, smaller"],
  ["webp", "WebP", "A picture for the web"],
  ["toml", "Recipe", "For other drawings"],
];

const PICTURE_EXTENSIONS = ["png", "jpg", "webp"];
/** Usual and largest width of a picture, in px; the latter limits percentages, too. */
const USUAL_WIDTH = 2000;
const LARGEST_WIDTH = 20_000;
/** The key under which the browser stores the choices for pictures. */
const CHOICES_KEY = "pathwarp-export";

/** The choices made last for pictures; the background is `none` or a colour. */
interface Choices {
  unit: "px" | "%";
  size: number;
  background: string;
}

const NOTHING = "There is nothing to save yet: pull a blue point or choose a shape first";

/** The time within which the browser starts a download, in ms. */
const DOWNLOAD_START = 60_000;

export class Saving {
  private dialog = byId<HTMLDialogElement>("save-dialog");
  private name = byId<HTMLInputElement>("save-name");
  private extension = "svg";
  private message = byId("save-message");
  private replace = byId<HTMLButtonElement>("save-replace");
  private download = byId<HTMLButtonElement>("save-download");
  private folder = byId<HTMLInputElement>("save-folder");
  private size = byId<HTMLInputElement>("save-size");
  private unit = byId<HTMLSelectElement>("save-unit");
  private background = byId<HTMLSelectElement>("save-background");
  private colour = byId<HTMLInputElement>("save-colour");
  /** The photograph for which the dialog last offered the full size, 100 %; empty for other drawings. */
  private photographOffered = "";
  /** The steps downloaded last, as JSON. */
  private downloaded = "";

  constructor(private app: App) {
    const formats = byId("save-formats");
    for (const [extension, title, use] of FORMATS) {
      const input = h("input", { type: "radio", name: "format", value: extension });
      input.addEventListener("change", () => this.choose(extension));
      formats.append(h("label", { class: "format" }, input, h("span", {}, h("b", {}, title), h("small", {}, use))));
    }
    byId("save").addEventListener("click", () => void this.save());
    byId("save-as").addEventListener("click", () => void this.open());
    byId("save-cancel").addEventListener("click", () => this.dialog.close());
    this.dialog.querySelector("form")!.addEventListener("submit", (e) => {
      e.preventDefault();
      void this.write(false);
    });
    this.replace.addEventListener("click", () => void this.write(true));
    this.download.addEventListener("click", () => void this.downloadFile());
    for (const field of [this.name, this.folder, this.size]) field.addEventListener("input", () => this.say(""));
    this.background.addEventListener("change", () => (this.colour.hidden = this.background.value !== "colour"));
    this.unit.addEventListener("change", () => (this.size.value = this.unit.value === "%" ? "100" : String(USUAL_WIDTH)));
    this.recall();
    byId("copy-command").addEventListener("click", () => void this.copyCommand());
    app.listen(["state"], () => this.show());
  }

  private show(): void {
    const { state } = this.app;
    if (!state) return;
    byId("file").textContent = state.file;
    const isEmpty = state.steps.length === 0;
    byId("saved").textContent = state.program ? `From ${state.program}` : state.saved ? (state.savedTo === state.file ? "Saved" : `Saved as ${state.savedTo}`) : isEmpty ? "No changes yet" : this.isDownloaded ? "Downloaded" : "Not saved yet";
    const save = byId<HTMLButtonElement>("save");
    // For a program that waits for the result, removing all steps is one, too.
    save.disabled = state.program ? isEmpty && !state.undo : isEmpty || state.saved;
    if (state.program) {
      save.textContent = `Keep in ${state.program}`;
      save.title = `Give the result to ${state.program} (Ctrl S)`;
      for (const id of ["save-as", "open"]) byId(id).hidden = true;
    }
    document.title = `${this.isUnsaved ? "• " : ""}${state.file} — pathwarp`;
  }

  private get isDownloaded(): boolean {
    return this.downloaded === JSON.stringify(this.app.state?.steps);
  }

  /** `true` if leaving the page would lose changes. */
  get isUnsaved(): boolean {
    const { state } = this.app;
    if (!state) return false;
    return state.program ? state.undo && !this.app.isDone : state.steps.length > 0 && !state.saved && !this.isDownloaded;
  }

  /** Hands the steps to the program that waits for them. */
  private async handOver(): Promise<void> {
    const answer = await this.app.request({ do: "hand-over" });
    if (!answer?.done) return;
    this.app.finish();
    // Browsers only close pages that a script has opened.
    window.close();
  }

  /** Saves to the file saved last or, the first time, to the usual one. */
  async save(): Promise<void> {
    if (this.dialog.open) return this.write(false);
    if (!(await this.app.settle())) return;
    const { state } = this.app;
    if (state?.program) return byId<HTMLButtonElement>("save").disabled ? undefined : this.handOver();
    if (!state) return;
    if (state.steps.length === 0) return this.open();
    const answer = await this.app.request({ do: "save", name: null, replace: false });
    if (answer?.exists || answer?.unwritable) return this.open(answer.unwritable);
    if (answer?.written) this.reportSaved(answer.written, answer.state, answer.warnings ?? []);
  }

  /** Opens the dialog for a name, with the reason if nothing could be written. */
  async open(unwritable = ""): Promise<void> {
    if (!(await this.app.settle())) return;
    const { state } = this.app;
    if (!state || state.program || this.dialog.open) return;
    // A drawing set from words can be saved without steps.
    if (state.steps.length === 0 && !state.words) return void toast(NOTHING);
    this.name.value = state.target;
    this.choose("svg");
    if (!state.photograph) this.recall();
    else if (this.photographOffered !== state.drawing) [this.unit.value, this.size.value] = ["%", "100"];
    this.photographOffered = state.photograph ? state.drawing : "";
    this.folder.value = state.savedIn ?? state.folder;
    if (unwritable) this.refuse(unwritable);
    this.dialog.showModal();
    this.name.select();
  }

  /** Restores the choices made last. */
  private recall(): void {
    const { unit = "px", size = USUAL_WIDTH, background = "none" } = JSON.parse(localStorage.getItem(CHOICES_KEY) ?? "{}") as Partial<Choices>;
    const isColour = background.startsWith("#");
    [this.unit.value, this.size.value, this.background.value] = [unit, String(size), isColour ? "colour" : background];
    if (isColour) this.colour.value = background;
    this.colour.hidden = !isColour;
  }

  /** Returns the file in the dialog; `null` for a picture without a size. */
  private target(): Record<string, unknown> | null {
    const [name, folder] = [this.name.value, this.folder.value];
    if (!PICTURE_EXTENSIONS.includes(this.extension)) return { name, folder };
    const unit = this.unit.value === "%" ? "%" : "px";
    const size = inUnits(this.size.value, unit) ?? NaN;
    if (!(size > 0 && size <= LARGEST_WIDTH) || (unit === "px" && !Number.isInteger(size))) {
      this.say(unit === "%" ? "The size is a number of per cent, such as 200" : `The width is a whole number of pixels up to ${LARGEST_WIDTH}`);
      return null;
    }
    const background = this.background.value === "colour" ? this.colour.value : this.background.value;
    // The offered size of a photograph is not stored.
    if (!this.photographOffered) localStorage.setItem(CHOICES_KEY, JSON.stringify({ unit, size, background } satisfies Choices));
    const picture = { ...(unit === "%" ? { scale: size / 100 } : { width: size }), background: background === "none" ? null : background };
    return { name, folder, picture };
  }

  private choose(extension: string): void {
    this.extension = extension;
    this.name.value = `${this.name.value.replace(/\.(svgz?|pdf|dxf|png|jpe?g|webp|toml)$/i, "")}.${extension}`;
    for (const input of Array.from(this.dialog.querySelectorAll<HTMLInputElement>("input[type=radio]"))) {
      input.checked = input.value === this.extension;
    }
    byId("save-picture").hidden = !PICTURE_EXTENSIONS.includes(extension);
    this.say("");
  }

  /** Shows a message, with the button that replaces a file if it `asks` for that. */
  private say(text: string, asks = false): void {
    this.message.textContent = text;
    this.replace.hidden = !asks;
  }

  private refuse(unwritable: string): void {
    this.say(`${unwritable}. Download it instead: the browser has a folder of its own.`);
  }

  private async write(replace: boolean): Promise<void> {
    const target = this.target();
    if (!target) return;
    try {
      const answer = await this.app.connection.ask({ do: "save", ...target, replace });
      if (answer.exists) return this.say(`${answer.exists} exists already.`, true);
      if (answer.unwritable) return this.refuse(answer.unwritable);
      this.dialog.close();
      this.reportSaved(answer.written ?? this.name.value, answer.state, answer.warnings ?? []);
    } catch (e) {
      this.say(inWords(reason(e)));
    }
  }

  /** Downloads the file, since the browser knows a writable folder. */
  private async downloadFile(): Promise<void> {
    const target = this.target();
    if (!target) return;
    try {
      const { written = this.name.value, bytes = "", warnings = [] } = await this.app.connection.ask({ do: "download", ...target });
      const href = URL.createObjectURL(new Blob([Uint8Array.from(atob(bytes), (c) => c.charCodeAt(0))]));
      h("a", { href, download: written }).click();
      setTimeout(() => URL.revokeObjectURL(href), DOWNLOAD_START);
      this.dialog.close();
      if (/\.svgz?$/i.test(written)) this.downloaded = JSON.stringify(this.app.state?.steps);
      this.app.tell("state");
      toast([`Downloaded ${written}`, ...warnings].join(". "));
    } catch (e) {
      this.say(inWords(reason(e)));
    }
  }

  private reportSaved(written: string, state: typeof this.app.state | undefined, warnings: string[]): void {
    if (state) {
      this.app.state = state;
      this.app.tell("state");
    }
    const name = written.split(/[\\/]/).pop() ?? written;
    toast([`Saved ${name} in ${written.slice(0, -name.length - 1) || (this.app.state?.folder ?? "")}`, ...warnings].join(". "));
  }

  private async copyCommand(): Promise<void> {
    await this.app.settle();
    const target = this.target();
    if (!target) return;
    try {
      const { text = "", written } = await this.app.connection.ask({ do: "command-line", ...target });
      try {
        await navigator.clipboard.writeText(text);
        toast(`The command line is on the clipboard${written ? `; ${written}, which it reads, is beside the drawing now` : ""}`);
      } catch {
        toast(text);
      }
      this.dialog.close();
    } catch (e) {
      this.say(inWords(reason(e)));
    }
  }
}
