// The list of steps: which is being changed, their order, and adding and removing them.

import type { App } from "./app";
import { byId, h, icon } from "./dom";
import { stepName } from "./names";
import type { Step } from "./types";

export class Steps {
  private list = byId("steps");
  /** Where a row has been moved to. */
  private moved: number | null = null;
  /** The steps on show whose letters are gone. */
  private gone = "";
  private note = byId("steps-note");
  private add = byId<HTMLButtonElement>("add-step");

  constructor(private app: App) {
    app.listen((change) => {
      if (change === "steps" || change === "state") this.build();
      // Which steps wait for their letters is known with the picture.
      if (change === "report" && app.gone.join() !== this.gone) this.build();
    });
    this.add.addEventListener("click", () => this.append());
  }

  /** Asks for the shape of a further step, or no longer does. */
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
    // The focus stays near.
    const near = focused ? this.list.children[Math.min(this.moved ?? row, steps.length - 1)] : null;
    (near?.querySelector<HTMLElement>(`[data-kind="${kind}"]:enabled`) ?? near?.querySelector<HTMLElement>(".step"))?.focus();
    this.moved = null;
    if (appends) this.list.append(h("li", { class: "wanted" }, `${steps.length + 1}. Choose a shape`));
    this.add.setAttribute("aria-pressed", String(appends));
    this.note.hidden = selected >= steps.length - 1;
    this.note.textContent = `The picture stops at step ${selected + 1}, so that you see what you drag. Saving uses all steps.`;
  }

  private row(step: Step, i: number): HTMLLIElement {
    const { app } = this;
    const { steps, selected } = app;
    const first = steps.filter((s) => app.isFirst(s)).length;
    const title = stepName(step, app.deformation(step.deformation));
    const count = step.select?.length ?? 0;
    const scope = count > 0 && h("small", { class: "muted" }, count === 1 ? " one part" : ` ${count} parts`);
    const gone = app.gone.includes(i) && h("small", { class: "muted" }, count === 1 ? " (its letter is gone)" : " (its letters are gone)");
    const choose = h("button", { type: "button", class: "step", "data-kind": "step", "aria-current": i === selected ? "step" : undefined }, `${i + 1}. ${title}`, scope, gone);
    choose.addEventListener("click", () => void app.select(i));
    const moved = (to: number) => {
      const others = steps.filter((_, k) => k !== i);
      others.splice(to, 0, step);
      this.moved = to;
      void app.arrange(others, to);
    };
    const button = (name: "up" | "down" | "close", label: string, action: () => void, disabled = false) => {
      const b = h("button", { type: "button", class: "small", "data-kind": name, "aria-label": label, title: label, disabled }, icon(name));
      b.addEventListener("click", action);
      return b;
    };
    const remove = () => void app.arrange(steps.filter((_, k) => k !== i), steps.length - 2);
    return h(
      "li", { class: i === selected ? "chosen" : "" }, choose,
      steps.length > 1 && button("up", `Move ${title} up`, () => moved(i - 1), i <= first),
      steps.length > 1 && button("down", `Move ${title} down`, () => moved(i + 1), i < first || i === steps.length - 1),
      !app.isProposal && button("close", `Remove ${title}`, remove),
    );
  }
}
