// Texts about the state: hints over the canvas, figures and problems below it, and the end of the program.

import { isCaption } from "./names";
import type { App } from "./app";
import { byId } from "./dom";
import { toast } from "./toast";
import type { State } from "./types";

/** The delay after which a line along the upper edge shows that an answer is awaited, in ms. */
const SLOW = 250;

export class Report {
  /** The drawing whose draft has been reported. */
  private announced: string | null = null;
  private slow = 0;

  constructor(private app: App) {
    app.listen(["report", "state"], () => this.figures());
    app.listen(["state"], () => this.buttons());
    app.listen(["handles", "steps"], () => this.hint());
    app.listen(["link"], () => this.link());
    app.connection.onBusy = (isBusy) => this.busy(isBusy);
    byId("warnings").addEventListener("click", () => toast(app.warnings.join(" · ")));
  }

  private busy(isBusy: boolean): void {
    clearTimeout(this.slow);
    const view = byId("view");
    view.setAttribute("aria-busy", String(isBusy));
    if (isBusy) this.slow = window.setTimeout(() => view.classList.add("busy"), SLOW);
    else view.classList.remove("busy");
  }

  private figures(): void {
    const { app } = this;
    const { state, summary, warnings } = app;
    // A proposal changes nothing, and without movement the summary counts no segments.
    const isBent = !app.isProposal && summary !== null && summary.segmentsIn > 0;
    show("counts", isBent ? `${summary.segmentsIn} → ${summary.segmentsOut} segments` : "");
    show("error", isBent && summary.error > 0 ? `largest error ${Number(summary.error.toPrecision(2))}` : "");
    const folds = summary?.folds.length ?? 0;
    show("folds", folds === 0 ? "" : folds === 1 ? "Folds over at 1 place" : `Folds over at ${folds} places`);
    show("problem", app.problem ?? (state?.problem ? `Nothing is kept until you save: ${state.problem}` : ""));
    const remarks = byId("warnings");
    remarks.hidden = warnings.length === 0;
    remarks.textContent = warnings.length === 1 ? "1 remark" : `${warnings.length} remarks`;
    remarks.title = warnings.join("\n");
  }

  private buttons(): void {
    const { state } = this.app;
    if (!state) return;
    const isEmpty = state.steps.length === 0;
    const disabled = { undo: !state.undo, redo: !state.redo, "start-over": isEmpty, "keep-preset": isEmpty };
    for (const [id, value] of Object.entries(disabled)) byId<HTMLButtonElement>(id).disabled = value;
    const restored = state.restored ? state.file : null;
    if (restored && restored !== this.announced) toast("Your last, unsaved steps are here again");
    this.announced = restored;
  }

  /** Shows a hint about the visible handles. */
  private hint(): void {
    const { app } = this;
    const { handles } = app;
    const has = (handles?.handles.length ?? 0) > 0;
    byId("smooth").hidden = !handles?.handles.some(({ key }) => /\/(in|out)$/.test(key));
    byId("mirror").hidden = !has;
    byId("snap").hidden = !has;
    byId("select").hidden = (handles?.handles.length ?? 0) < 2;
    if (app.freedPath) toast(`The line has left ${app.freedPath}, which is artwork again. Undo brings it back`);
    app.freedPath = null;
    if (app.appends) return show("note", "Choose the shape of the next step, or press Escape");
    if (app.steps.length === 0) return show("note", "Choose a shape");
    if (app.step?.hidden) return show("note", "This step is hidden: it bends nothing. The eye in the list brings it back");
    if (app.leastRadius("along") !== null) return show("note", "The artwork is longer than its circle: pull the circle larger, or see the settings");
    // The handles have not arrived yet.
    if (!handles) return;
    const pulls = handles.lines().some(({ kind }) => kind === "path") ? "Pull a blue point or line" : "Pull a blue point";
    // A net gets lines, a list gets points, and paths are divided.
    const adds = handles.net ? "Double-click a line to add another" : handles.grows ? "Double-click adds one, Delete removes it" : "Double-click the line to add a point, Delete removes it";
    const note = isCaption(app.step ?? { deformation: "" }) ? "Pull the blue point to move the words, double-click to type" : !has ? "Change the settings" : handles.net || handles.grows || handles.divides ? `${pulls}. ${adds}` : `${pulls} to bend the artwork`;
    show("note", app.isProposal && has ? `${note}, or choose a shape` : note);
  }

  /** Reacts to a moved view: the user may have meant to bend the artwork. */
  panned(): void {
    if (this.app.isProposal && this.app.handles?.handles.length) show("note", "This moves the view. Pull a blue point or line to bend the artwork");
  }

  private link(): void {
    const { isDone, isLive, state } = this.app;
    const gone = byId("gone");
    gone.hidden = isLive;
    // Disable the page while changes cannot be stored.
    for (const part of Array.from(document.querySelectorAll<HTMLElement>("header, main, footer"))) part.inert = !isLive;
    if (!isLive) for (const dialog of Array.from(document.querySelectorAll("dialog"))) dialog.close();
    gone.classList.toggle("done", isDone);
    show("gone-title", isDone ? `${state?.program} has the result.` : "pathwarp has ended.");
    show("gone-kept", isDone ? "You can close this page."
      : state?.program ? `${state.program} has stopped waiting. Choose “Bend by hand” there to begin again.`
      : `${kept(state)} To go on${state?.saved ? "" : " here"}, run “${state?.again ?? "pathwarp edit"}”.`);
  }
}

/** Reports the fate of the steps when the program has ended. */
function kept(state: State | null): string {
  if (!state || state.steps.length === 0) return "";
  if (state.saved) return "Everything is saved.";
  return state.problem ? `What was not saved is lost (${state.problem}).` : `The steps of ${state.file} are kept.`;
}

/** Shows a text, or hides its element if it is empty. */
function show(id: string, text: string): void {
  const element = byId(id);
  element.hidden = text === "";
  if (element.textContent !== text) element.textContent = text;
}
