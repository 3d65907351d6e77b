// The sheet under the drawing: white, black, or a checked pattern where the drawing is transparent.

import type { App } from "./app";
import { byId } from "./dom";

const GROUNDS = ["white", "black", "checks"] as const;
type Name = (typeof GROUNDS)[number];
/** The key under which the browser stores the choice. */
const CHOICE_KEY = "pathwarp-ground";
/** Colours whose components all reach this value are invisible on white. */
const PALE = 235;

export class Ground {
  private shown: Name = "white";
  /** The drawing for which the sheet was last chosen. */
  private drawing = "";

  constructor(app: App) {
    this.show(this.chosen);
    app.listen(["report"], () => this.adapt(app.state?.drawing ?? ""));
    byId("ground").addEventListener("click", () => {
      this.show(GROUNDS[(GROUNDS.indexOf(this.shown) + 1) % GROUNDS.length]!);
      localStorage.setItem(CHOICE_KEY, this.shown);
    });
  }

  private get chosen(): Name {
    return GROUNDS.find((name) => name === localStorage.getItem(CHOICE_KEY)) ?? "white";
  }

  private show(name: Name): void {
    this.shown = name;
    for (const other of GROUNDS) document.body.classList.toggle(`on-${other}`, other === name);
    byId("ground-name").textContent = name === "checks" ? "transparent" : name;
  }

  /** Shows an all-white drawing on black if the user has chosen white. */
  private adapt(drawing: string): void {
    const art = Array.from(document.querySelectorAll("#stage .art:not([visibility=hidden]) :is(path, image)"));
    if (drawing === this.drawing || art.length === 0) return;
    this.drawing = drawing;
    this.show(this.chosen === "white" && art.every(isPale) ? "black" : this.chosen);
  }
}

function isPale(element: Element): boolean {
  const { fill, stroke } = getComputedStyle(element);
  const colours = [fill, stroke].filter((paint) => paint !== "none");
  return element.tagName === "path" && colours.every((paint) => paint.startsWith("rgb(") && paint.match(/\d+/g)!.every((part) => Number(part) >= PALE));
}
