// The choice of shapes: every deformation and preset, each with a small picture of the present artwork.

import type { App } from "./app";
import { button, byId, h, icon } from "./dom";
import { called, capital, stepName, words } from "./names";
import { toast } from "./toast";
import { DRAGGED } from "./values";
import type { Deformation, Step } from "./types";

/** Further search terms of shapes and presets: tasks for which users may look elsewhere. */
const SEARCH_TERMS: Record<string, string> = {
  shaper: "bottle label neck",
  envelope: "lines in a shape text in a shape badge",
  bend: "text on path words on a line badge seal",
  arc: "text on a circle badge",
  simplify: "smooth clean up fewer nodes traced",
  offset: "outset outline grow bolder thicker inset shrink thinner",
};

/** Common tasks, in the order of docs/which.md, with the presets and deformations for them. */
const TASKS: [string, string][] = [
  ["Arch", "warp/arc warp/arch warp/arc-upper warp/arc-lower wordart/arch-up wordart/arch-down wordart/arch-up-pour wordart/arch-down-pour wordart/can-up wordart/can-down wordart/curve-up wordart/curve-down"],
  ["Wave", "warp/flag warp/wave wave wordart/wave1 wordart/wave2 wordart/double-wave1 wordart/wave4 warp/rise"],
  ["Bulge", "warp/bulge warp/inflate warp/fisheye warp/squeeze bulge lens wordart/inflate wordart/deflate wordart/inflate-top wordart/inflate-bottom wordart/deflate-top wordart/deflate-bottom wordart/deflate-inflate wordart/deflate-inflate-deflate"],
  ["Into a shape", "envelope shaper warp/fish warp/shell-lower warp/shell-upper wordart/triangle wordart/triangle-inverted wordart/chevron wordart/chevron-inverted wordart/stop"],
  ["Around", "polar anamorph wordart/circle wordart/circle-pour wordart/button wordart/button-pour wordart/ring-inside wordart/ring-outside"],
  ["Perspective", "projective bilinear affine similitude wordart/fade-up wordart/fade-down wordart/fade-right wordart/fade-left wordart/slant-up wordart/slant-down wordart/cascade-up wordart/cascade-down"],
  ["Along a path", "bend"],
];

interface Card {
  button: HTMLButtonElement;
  image: HTMLImageElement;
  /** The steps of the picture; `null` for the example of the deformation. */
  steps: Step[] | null;
  deformation: string;
  args: Record<string, string[]>;
  variant: { label: string; param: string } | null;
  searchText: string;
}

export class Gallery {
  private box = byId("gallery");
  private search = byId<HTMLInputElement>("search");
  private cards: Card[] = [];
  private queue: Card[] = [];
  private isDrawing = false;
  private userPresets = h("section", { hidden: true });
  /** The message that nothing was found. */
  private none = h("p", { class: "none", role: "status", hidden: true });
  /** The names of the user's presets. */
  names: string[] = [];
  /** The drawing in the pictures. */
  private drawing = "";
  /** Queues cards that scroll into view. */
  private observer = new IntersectionObserver((entries) => {
    for (const entry of entries) {
      const card = this.cards.find((c) => c.button === entry.target);
      if (!entry.isIntersecting || !card) continue;
      this.observer.unobserve(entry.target);
      this.queue.push(card);
      void this.drawQueued();
    }
  }, { rootMargin: "150px" });

  constructor(private app: App) {
    app.listen(["state"], () => this.build());
    app.listen(["steps"], () => this.mark());
    this.search.addEventListener("input", () => this.filter());
    this.search.addEventListener("keydown", (e) => {
      if (e.key === "Enter" && this.search.value.trim() !== "") this.box.querySelector<HTMLElement>("section:not([hidden]) :is(.card, .preset):not([hidden])")?.click();
    });
  }

  private build(): void {
    if (this.drawing === "") void this.app.request({ do: "presets" }).then((answer) => answer?.presets && this.showPresets(answer.presets));
    const { drawing = "" } = this.app.state ?? {};
    if (drawing === this.drawing || this.app.catalogue.length === 0) return;
    this.drawing = drawing;
    for (const { image } of this.cards) URL.revokeObjectURL(image.src);
    this.cards = [];
    this.queue = [];
    const all = this.app.catalogue.filter((d) => !d.first);
    const edits = this.app.catalogue.filter((d) => d.first);
    const byHand = all.filter((d) => isDragged(d) && !d.gallery).flatMap((d) => [this.shapeCard(d), ...d.variants.map((v) => this.shapeCard(d, v))]);
    const presets = all.filter((d) => d.gallery).flatMap((d) => this.presetCards(d));
    const effects = all.filter((d) => !isDragged(d) && !d.gallery).map((d) => this.shapeCard(d));
    const rest = new Set([...byHand, ...presets, ...effects]);
    const tasks = TASKS.map(([title, names]) => {
      const cards = names.split(" ").flatMap((name) => [...rest].filter((c) => [c.deformation, ...Object.values(c.args).flat()].join("/") === name));
      cards.forEach((c) => rest.delete(c));
      return this.section(title, cards);
    });
    const others = (title: string, cards: Card[]) => this.section(title, cards.filter((c) => rest.has(c)));
    this.box.replaceChildren(
      this.none, this.userPresets, ...tasks,
      others("By hand", byHand), others("More styles", presets), others("Effects", effects),
      this.section("Before bending", edits.map((d) => this.shapeCard(d))),
    );
    this.mark();
    this.filter();
  }

  /** Shows the user's presets. */
  showPresets(names: string[]): void {
    this.names = names;
    const entry = (name: string) => {
      const use = button({ class: "preset" }, async () => {
        const answer = await this.app.request({ do: "preset", name });
        if (answer?.steps) await this.app.arrange(answer.steps.map((step) => ({ ...step, exclude: this.app.locks })), answer.steps.length - 1);
        document.body.classList.remove("shapes-open");
      }, name);
      const forget = button({ class: "small", "aria-label": `Forget ${name}`, title: `Forget ${name}` }, async () => {
        const answer = await this.app.request({ do: "forget-preset", name });
        if (!answer?.presets) return;
        this.showPresets(answer.presets);
        // Keep the focus nearby.
        const others = this.userPresets.querySelectorAll<HTMLElement>(".small");
        (others[Math.min(names.indexOf(name), others.length - 1)] ?? this.search).focus();
      }, icon("close"));
      return h("li", {}, use, forget);
    };
    this.userPresets.replaceChildren(h("h2", {}, "Your presets"), h("ul", { class: "presets" }, ...names.map(entry)));
    this.filter();
  }

  private section(title: string, cards: Card[]): HTMLElement {
    const items = h("div", { class: "grid", role: "group", "aria-label": title }, ...cards.map((c) => c.button));
    cards.forEach(({ button }, i) => (button.tabIndex = i === 0 ? 0 : -1));
    items.addEventListener("keydown", (e) => walk(e, items));
    return h("section", {}, h("h2", {}, title), items);
  }

  private card(deformation: string, args: Record<string, string[]>, steps: Step[] | null, text: Node, variant: Card["variant"] = null): Card {
    const image = h("img", { alt: "", draggable: "false" });
    const cardButton = button({ class: "card" }, () => void this.choose(card), h("span", { class: "thumb" }, image), text);
    const terms = [...(this.app.deformation(deformation)?.knownAs ?? []), variant && deformation !== "envelope" ? "" : SEARCH_TERMS[Object.values(args)[0]?.[0] ?? deformation] ?? ""];
    const card: Card = { button: cardButton, image, steps, deformation, args, variant, searchText: [cardButton.textContent, ...terms].join(" ") };
    this.cards.push(card);
    this.observer.observe(cardButton);
    return card;
  }

  private async choose({ deformation, args, variant }: Card): Promise<void> {
    const { app } = this;
    const { step } = app;
    // Styles are tried in turn, but replacing manual work needs a message.
    const isReplaced = app.isWorkedOn && !app.appends && step?.deformation !== deformation && !app.isFirst(step) && !app.deformation(deformation)?.first;
    const name = (step: Step | undefined) => (step ? stepName(step, app.deformation(step.deformation)) : "");
    const old = name(step);
    document.body.classList.remove("shapes-open");
    await app.choose(deformation, args, variant?.label ?? null);
    if (isReplaced) toast(`${name(app.step)} replaces ${old}. Undo brings it back, “Add step” keeps both`);
  }

  /** Returns the card of a deformation, or of one of its variants. */
  private shapeCard(d: Deformation, variant: Card["variant"] = null): Card {
    const card = this.card(d.name, {}, null, h("span", { class: "name" }, variant?.label ?? (this.isTaken(called(d)) ? `${called(d)} (effect)` : called(d))), variant);
    card.button.title = capital(d.title);
    // The search covers the description, too.
    card.searchText += ` ${called(d)} ${d.name} ${d.title}`;
    return card;
  }

  /** Returns `true` if an earlier shape has this name; the later one then needs a description. */
  private isTaken(name: string): boolean {
    return this.cards.some(({ button }) => button.textContent === name);
  }

  private presetCards(d: Deformation): Card[] {
    const { presets } = d.gallery!;
    const names = d.params.find((p) => p.name === presets)?.words ?? [];
    return names.map((name) => {
      const args = { [presets]: [name] };
      return this.card(d.name, args, [{ deformation: d.name, inverse: false, args }], h("span", { class: "name" }, this.isTaken(words(name)) ? `${words(name)} (${d.gallery!.title})` : words(name)));
    });
  }

  /** Draws the visible cards one by one, so that neither dragging nor the picture of the drawing is delayed. */
  private async drawQueued(): Promise<void> {
    if (this.isDrawing) return;
    this.isDrawing = true;
    for (let card = this.queue.shift(); card; card = this.queue.shift()) {
      while (this.app.isDragging || this.app.connection.isBusy) await new Promise((done) => setTimeout(done, 100));
      const request = { do: "thumbnail", steps: card.steps, example: card.steps ? null : card.deformation, variant: card.variant?.label ?? null };
      try {
        const { svg } = await this.app.connection.ask(request);
        card.image.src = URL.createObjectURL(new Blob([svg ?? ""], { type: "image/svg+xml" }));
      } catch {
        // Without a picture, only the name remains.
        card.button.classList.add("bare");
      }
    }
    this.isDrawing = false;
  }

  /** Marks the shape of the edited step. */
  private mark(): void {
    const { step } = this.app;
    for (const { button, deformation, args, variant } of this.cards) {
      const variants = this.app.deformation(deformation)?.variants ?? [];
      // Of the variants that set the same parameter, only the first one is marked: the others are mere starts.
      const isVariant = variant ? step?.args[variant.param] !== undefined && variants.find((v) => v.param === variant.param) === variant : !variants.some((v) => step?.args[v.param]);
      const isChosen = step?.deformation === deformation && isVariant && Object.entries(args).every(([k, v]) => step.args[k]?.[0] === v[0]);
      button.setAttribute("aria-pressed", String(isChosen));
    }
  }

  private filter(): void {
    // Names may be typed without their menus, and with other characters between the words.
    const plain = (text: string) => text.toLowerCase().replace(/[^\p{L}\p{N}]+/gu, " ").trim();
    const typedWords = plain(this.search.value).split(" ");
    const fits = (text: string) => typedWords.every((word) => plain(text).includes(word));
    for (const { button, searchText } of this.cards) button.hidden = !fits(searchText);
    const presets = Array.from(this.userPresets.querySelectorAll("li"));
    for (const preset of presets) preset.hidden = !fits(preset.textContent ?? "");
    this.userPresets.hidden = presets.every((preset) => preset.hidden);
    this.none.textContent = `No shape is called “${this.search.value.trim()}”`;
    this.none.hidden = !this.userPresets.hidden || this.cards.some(({ button }) => !button.hidden);
    for (const section of Array.from(this.box.children) as HTMLElement[]) {
      if (section === this.userPresets || section === this.none) continue;
      // Tab reaches one visible card of the section.
      const shown = Array.from(section.querySelectorAll<HTMLElement>(".card")).filter((card) => !card.hidden);
      if (shown.length > 0 && !shown.some((card) => card.tabIndex === 0)) shown[0]!.tabIndex = 0;
      section.hidden = shown.length === 0;
    }
  }
}

/** Arrow keys move between cards, so that Tab skips a section in one step. */
function walk(e: KeyboardEvent, items: HTMLElement): void {
  const all = (Array.from(items.children) as HTMLElement[]).filter((card) => !card.hidden);
  const at = all.indexOf(document.activeElement as HTMLElement);
  const row = all.filter((card) => card.offsetTop === all[0]?.offsetTop).length;
  const by = ({ ArrowRight: 1, ArrowLeft: -1, ArrowDown: row, ArrowUp: -row } as Record<string, number>)[e.key];
  const to = e.key === "Home" ? 0 : e.key === "End" ? all.length - 1 : by === undefined ? -1 : at + by;
  if (at < 0 || !all[to]) return;
  e.preventDefault();
  all[at]!.tabIndex = -1;
  all[to].tabIndex = 0;
  all[to].focus();
}

function isDragged(d: Deformation): boolean {
  return d.params.some((p) => (p.kind === "path" && p.name !== "base") || DRAGGED.has(p.notation ?? ""));
}
