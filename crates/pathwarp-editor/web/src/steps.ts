// The list of steps: the selection of the edited one, their order, and adding and removing them.

import type { App } from "./app";
import { button, byId, h, icon } from "./dom";
import { stepName } from "./names";
import type { Step } from "./types";

/** Distance within which a press counts as a click, in px. */
const CLICK_DISTANCE = 5;

export class Steps {
  private list = byId("steps");
  /** The index to which a row has been moved, whose focus follows. */
  private movedTo: number | null = null;
  /** The indices of the steps shown as lacking their letters. */
  private gone = "";
  /** `true` while a row is dragged, which is not a click on its button. */
  private isDragged = false;
  private note = byId("steps-note");
  private add = byId<HTMLButtonElement>("add-step");

  constructor(private app: App) {
    app.listen(["steps", "state"], () => this.build());
    // The picture tells which steps wait for their letters.
    app.listen(["report"], () => app.gone.join() !== this.gone && this.build());
    this.add.addEventListener("click", () => this.append());
    // The first click may have replaced the row.
    this.list.addEventListener("dblclick", (e) => {
      const button = (e.target as Element).closest("button.step");
      if (button) this.rename(Array.from(this.list.children).indexOf(button.parentElement!));
    });
  }

  /** Starts or ends the choice of a shape for another step. */
  private append(): void {
    this.app.append(!this.app.appends);
    document.body.classList.toggle("shapes-open", this.app.appends);
    if (!this.app.appends) return;
    byId("gallery").scrollTop = 0;
    byId<HTMLInputElement>("search").focus();
  }

  private build(): void {
    const { app } = this;
    const { steps, selected, appends } = app;
    this.gone = app.gone.join();
    const focused = this.list.contains(document.activeElement) ? (document.activeElement as HTMLElement) : null;
    const kind = focused?.dataset.kind ?? "";
    const row = Array.from(this.list.children).indexOf(focused?.closest("li") as Element);
    this.list.replaceChildren(...steps.map((step, i) => this.row(step, i)));
    // Keep the focus nearby.
    const near = focused ? this.list.children[Math.min(this.movedTo ?? row, steps.length - 1)] : null;
    (near?.querySelector<HTMLElement>(`[data-kind="${kind}"]:enabled`) ?? near?.querySelector<HTMLElement>(".step"))?.focus();
    this.movedTo = null;
    if (appends) this.list.append(h("li", { class: "wanted" }, `${steps.length + 1}. Choose a shape`));
    this.add.setAttribute("aria-pressed", String(appends));
    this.note.hidden = selected >= steps.length - 1;
    byId("end").hidden = this.note.hidden;
    this.note.textContent = `The picture stops at step ${selected + 1}, so that you see what you drag. “End” (E) shows what all of them make. Saving uses all steps.`;
  }

  private row(step: Step, i: number): HTMLLIElement {
    const { app } = this;
    const { steps, selected } = app;
    // Edits come before deformations.
    const edits = steps.filter((s) => app.isFirst(s)).length;
    const title = stepName(step, app.deformation(step.deformation));
    const count = step.select?.length ?? 0;
    const scope = count > 0 && h("small", { class: "muted" }, count === 1 ? " one part" : ` ${count} parts`);
    const gone = app.gone.includes(i) && h("small", { class: "muted" }, count === 1 ? " (its letter is gone)" : " (its letters are gone)");
    const attributes = { class: "step", "data-kind": "step", title: "Drag it to move it, double-click to rename it", "aria-current": i === selected ? "step" : undefined };
    const choose = button(attributes, () => this.isDragged || void app.select(i), `${i + 1}. ${title}`, scope, gone);
    choose.addEventListener("pointerdown", (e) => this.drag(e, i, edits, moveTo));
    const moveTo = (to: number) => {
      this.movedTo = to;
      void app.arrange(steps.toSpliced(i, 1).toSpliced(to, 0, step), to);
    };
    const hide = () => void app.arrange(steps.map((s, k) => (k === i ? { ...s, hidden: !step.hidden || undefined } : s)), selected);
    const iconButton = (name: "up" | "down" | "close" | "eye" | "copy" | "pen", label: string, click: () => void, disabled = false) =>
      button({ class: "small", "data-kind": name, "aria-label": label, title: label, disabled }, click, icon(name));
    const remove = () => void app.arrange(steps.filter((_, k) => k !== i), steps.length - 2);
    return h(
      "li", { class: `${i === selected ? "chosen" : ""} ${step.hidden ? "hidden" : ""}` }, choose,
      !app.isProposal && iconButton("eye", `${step.hidden ? "Show" : "Hide"} ${title}`, hide),
      steps.length > 1 && iconButton("up", `Move ${title} up`, () => moveTo(i - 1), i <= edits),
      steps.length > 1 && iconButton("down", `Move ${title} down`, () => moveTo(i + 1), i < edits || i === steps.length - 1),
      !app.isProposal && iconButton("close", `Remove ${title}`, remove),
      !app.isProposal && i === selected && h("span", { class: "acts" },
        iconButton("pen", `Rename ${title}`, () => this.rename(i)),
        i >= edits && iconButton("copy", `Duplicate ${title}`, () => void app.arrange(steps.toSpliced(i + 1, 0, structuredClone(step)), i + 1))),
    );
  }

  /** Replaces a step's name by a field for another one. */
  private rename(i: number): void {
    const { app } = this;
    const [row, step] = [this.list.children[i], app.steps[i]];
    if (app.isProposal || !row || !step) return;
    const title = stepName(step, app.deformation(step.deformation));
    const input = h("input", { type: "text", class: "step", "aria-label": `Name of ${title}`, maxlength: 60, value: title });
    const done = (name: string) => {
      const wanted = name.trim() === "" ? undefined : name.trim();
      if (!input.isConnected) return;
      if (name === title) return this.build();
      void app.arrange(app.steps.map((s) => (s === step ? { ...s, name: wanted } : s)), app.selected);
    };
    input.addEventListener("blur", () => done(input.value));
    input.addEventListener("keydown", (e) => {
      if (e.key !== "Enter" && e.key !== "Escape") return;
      e.stopPropagation();
      if (e.key === "Escape") input.value = title;
      input.blur();
    });
    row.firstElementChild?.replaceWith(input);
    input.select();
  }

  /** Follows a pointer that moves a row among the edits, which come first, or among the deformations. */
  private drag(e: PointerEvent, i: number, edits: number, moveTo: (to: number) => void): void {
    // Fingers scroll the list.
    if (e.pointerType === "touch" || e.button !== 0 || this.app.isProposal) return;
    const rows = Array.from(this.list.children);
    const isAllowed = (k: number) => (k < edits) === (i < edits) && k < this.app.steps.length;
    this.isDragged = false;
    let to = i;
    const stop = new AbortController();
    window.addEventListener("pointermove", (event) => {
      if (event.pointerId !== e.pointerId) return;
      this.isDragged ||= Math.abs(event.clientY - e.clientY) > CLICK_DISTANCE;
      if (!this.isDragged) return;
      const under = rows.findIndex((r, k) => isAllowed(k) && event.clientY < r.getBoundingClientRect().bottom);
      to = under >= 0 ? under : rows.findLastIndex((_, k) => isAllowed(k));
      rows.forEach((r, k) => {
        r.classList.toggle("above", k === to && to < i);
        r.classList.toggle("below", k === to && to > i);
      });
    }, stop);
    for (const end of ["pointerup", "pointercancel"]) {
      window.addEventListener(end, () => {
        stop.abort();
        if (to !== i && end === "pointerup") moveTo(to);
      }, stop);
    }
  }
}
