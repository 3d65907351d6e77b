// The list of steps: which is being changed, their order, and adding and removing them.

import type { App } from "./app";
import { byId, called, h, icon, words } from "./dom";
import type { Gallery } from "./gallery";
import type { Step } from "./types";

export class Steps {
  private list = byId("steps");
  private note = byId("steps-note");

  constructor(private app: App, gallery: Gallery) {
    app.listen((change) => {
      if (change === "steps" || change === "state") this.build();
    });
    const add = byId<HTMLButtonElement>("add-step");
    add.addEventListener("click", () => {
      gallery.appends = true;
      document.body.classList.add("shapes-open");
      byId("note").textContent = "Choose the shape of the next step";
      byId("gallery").scrollTop = 0;
      byId<HTMLInputElement>("search").focus();
    });
  }

  private build(): void {
    const { app } = this;
    const { steps, selected } = app;
    const name = (step: Step) => {
      const deformation = app.deformation(step.deformation);
      const preset = deformation?.gallery ? step.args[deformation.gallery.presets]?.[0] : undefined;
      const variant = deformation?.variants.find(({ param }) => step.args[param]);
      return preset ? words(preset) : variant?.label ?? (deformation ? called(deformation) : words(step.deformation));
    };
    const button = (name: string, label: string, action: () => void, disabled = false) => {
      const b = h("button", { type: "button", class: "small", "aria-label": label, title: label, disabled }, icon(name));
      b.addEventListener("click", action);
      return b;
    };
    this.list.replaceChildren(...steps.map((step, i) => {
      const title = name(step);
      const choose = h("button", { type: "button", class: "step", "aria-current": i === selected ? "step" : undefined }, `${i + 1}. ${title}`);
      choose.addEventListener("click", () => void app.select(i));
      const moved = (to: number) => {
        const others = steps.filter((_, k) => k !== i);
        others.splice(to, 0, step);
        void app.arrange(others, to);
      };
      const remove = () => void app.arrange(steps.filter((_, k) => k !== i), Math.max(0, i - 1));
      return h(
        "li", { class: i === selected ? "chosen" : "" }, choose,
        steps.length > 1 && button("up", `Move ${title} up`, () => moved(i - 1), i === 0),
        steps.length > 1 && button("down", `Move ${title} down`, () => moved(i + 1), i === steps.length - 1),
        !app.isProposal && button("close", `Remove ${title}`, remove),
      );
    }));
    this.note.hidden = selected >= steps.length - 1;
    this.note.textContent = `The picture stops at step ${selected + 1}, so that you see what you drag. Saving uses all steps.`;
  }
}
