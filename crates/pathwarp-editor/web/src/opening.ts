// Opens other drawings: chosen, dropped anywhere on the page, or pasted.

import type { App } from "./app";
import { byId, isTyping, onFile } from "./dom";
import { toast } from "./toast";

/** The name of a drawing that is pasted as text. */
const PASTED = "pasted.svg";

export class Opening {
  constructor(private app: App) {
    const fileInput = byId<HTMLInputElement>("open-file");
    byId("open").addEventListener("click", () => fileInput.click());
    onFile(fileInput, (file) => void this.open(file));
    window.addEventListener("dragover", (e) => {
      e.preventDefault();
      if (e.dataTransfer) e.dataTransfer.dropEffect = "copy";
      document.body.classList.add("dropping");
    });
    window.addEventListener("dragleave", (e) => {
      if (!e.relatedTarget) document.body.classList.remove("dropping");
    });
    window.addEventListener("drop", (e) => {
      e.preventDefault();
      document.body.classList.remove("dropping");
      this.take(e.dataTransfer);
    });
    window.addEventListener("paste", (e) => {
      if (!isTyping(e.target)) this.take(e.clipboardData);
    });
  }

  /** Opens a dropped or pasted file, or the text of a drawing. */
  private take(data: DataTransfer | null): void {
    const file = data?.files[0];
    const text = data?.getData("text/plain") ?? "";
    if (file) void this.open(file);
    else if (/<svg[\s>]/i.test(text)) void this.open(new File([text], PASTED));
    else if (data) toast("This is not a drawing: drop or paste an SVG or a photograph");
  }

  private async open(file: File): Promise<void> {
    const { app } = this;
    await app.settle();
    const { state } = app;
    if (!state || !app.isLive) return;
    if (state.program) return void toast(`${state.program} waits for this drawing; another one cannot be opened`);
    const isLost = state.problem !== null && state.steps.length > 0 && !state.saved;
    if (isLost && !confirm(`The steps of ${state.file} are not saved, and nothing keeps them. Open ${file.name} all the same?`)) return;
    await app.enter(() => app.attempt(async () => app.connection.ask({ do: "open", name: file.name, bytes: await base64(file) })));
  }
}

/** Copies a file to the drawing's folder, where steps can read it. Returns the text that names it in a step. */
export async function bring(app: App, file: File): Promise<string | null> {
  const bytes = await base64(file);
  const answer = await app.request({ do: "bring", name: file.name, bytes });
  if (!answer?.written) return null;
  if (answer.copied) toast(`${file.name} was copied beside the drawing`);
  return answer.written;
}

/** Number of bytes converted to characters at a time; more would be too many arguments. */
const PIECE = 0x8000;

/** Returns the content of a file in base64. */
export async function base64(file: File): Promise<string> {
  const bytes = new Uint8Array(await file.arrayBuffer());
  let binary = "";
  for (let i = 0; i < bytes.length; i += PIECE) binary += String.fromCharCode(...bytes.subarray(i, i + PIECE));
  return btoa(binary);
}
