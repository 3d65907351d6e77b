// The page: combines its parts, and handles the remaining buttons and keys.

import { App } from "./app";
import { Background } from "./background";
import { Caption } from "./caption";
import { byId, isTyping } from "./dom";
import { Gallery } from "./gallery";
import { showKeys } from "./keys";
import { Ground } from "./ground";
import { Modes, snapLines } from "./modes";
import { Opening } from "./opening";
import { Parts } from "./parts";
import { Place } from "./place";
import { Pointing } from "./pointing";
import { Presets } from "./presets";
import { Report } from "./report";
import { Saving } from "./saving";
import { Settings } from "./settings";
import { Sketching } from "./sketch";
import { partOf, Stage } from "./stage";
import { Steps } from "./steps";
import { WordsDialog } from "./words";

/** The factor for one step of magnification. */
const ZOOM = 1.25;

const app = new App();
const modes = new Modes();
const stage = new Stage(app, modes);
const report = new Report(app);
const saving = new Saving(app);
const settings = new Settings(app);
new Presets(app, new Gallery(app));
// The ground is the sheet under the drawing; the background is a template, which is not saved.
new Ground(app);
new Steps(app);
new Parts(app, stage, modes);
new Place(app, stage);
new Opening(app);
const background = new Background(app, stage);
new Pointing(app, stage, modes).onPan = () => report.panned();
modes.onSnap = snapLines((p) => stage.camera.toScreen(p));
stage.onLayout.push(() => {
  byId("zoom").textContent = `${Math.round(100 * stage.camera.scale)}%`;
});
stage.onLayout.push(() => caption.place());
const sketching = new Sketching(app, stage);
const caption = new Caption(app, stage, sketching);
new WordsDialog(app).onPlace = (args) => caption.begin(args);
settings.onDraw = (kind, take) => {
  closeSheets();
  sketching.begin(kind, take);
};
background.onOutline = (take) => sketching.begin("round", take);
settings.onStepChange = () => sketching.end();
settings.onPick = (take) => {
  closeSheets();
  sketching.end();
  stage.pick((path) => take(partOf(path.closest("[id]")!.id)), "Click a path of the drawing");
};

function on(id: string, action: () => void): void {
  byId(id).addEventListener("click", action);
}

on("undo", () => void app.turn("undo"));
on("redo", () => void app.turn("redo"));
on("zoom-in", () => stage.zoom(ZOOM));
on("zoom-out", () => stage.zoom(1 / ZOOM));
on("fit", () => stage.fit());
on("keys", showKeys);
// A phone's header has no room for this button, which moves below the steps.
const phone = matchMedia("(max-width: 520px)");
const arrange = () => byId(phone.matches ? "keep-preset" : "history").after(byId("start-over"));
phone.addEventListener("change", arrange);
arrange();
on("start-over", async () => {
  await app.arrange([], 0);
  byId("undo").focus();
});

/** Makes a button that stays pressed. */
function toggle(id: string, get: () => boolean, set: (value: boolean) => void): () => void {
  const button = byId(id);
  const show = () => button.setAttribute("aria-pressed", String(get()));
  const turn = () => {
    set(!get());
    show();
  };
  button.addEventListener("click", turn);
  show();
  return turn;
}

toggle("select", () => modes.selects, (v) => {
  modes.selects = v;
  stage.svg.classList.toggle("selecting", stage.isSelecting);
});
toggle("pick-parts", () => modes.picksParts, (v) => {
  modes.picksParts = v;
  if (v) byId<HTMLDetailsElement>("parts-list").open = true;
  for (const name of ["picking", "parts"]) stage.svg.classList.toggle(name, v);
});
toggle("snap", () => modes.snaps, (v) => (modes.snaps = v));
toggle("mirror", () => modes.mirrors, (v) => (modes.mirrors = v));
toggle("smooth", () => modes.smooths, (v) => (modes.smooths = v));
toggle("nodes", () => stage.showsNodes, (v) => {
  stage.showsNodes = v;
  stage.drawNodes();
});
const showFinalResult = toggle("end", () => stage.showsFinalResult, (v) => {
  stage.showsFinalResult = v;
  void stage.drawFinalResult();
});
toggle("stretch", () => stage.showsStretch, (v) => {
  stage.showsStretch = v;
  byId("legend").hidden = !v;
  void stage.drawStretch();
});

// In a narrow window, the panels are sheets, of which at most one is open.
const SHEETS = { "shapes-open": "open-shapes", "settings-open": "open-settings" } as const;
const { classList } = document.body;
const closeSheets = () => classList.remove(...Object.keys(SHEETS));
for (const [sheet, button] of Object.entries(SHEETS)) {
  on(button, () => {
    const opens = !classList.contains(sheet);
    closeSheets();
    classList.toggle(sheet, opens);
  });
}
byId("stage").addEventListener("pointerdown", (e) => {
  if (!(e.target as Element).closest(".knob")) closeSheets();
});
// Other parts open and close sheets, too; the drawing moves into the remaining space.
let opened = "";
new MutationObserver(() => {
  const now = Object.keys(SHEETS).find((sheet) => classList.contains(sheet)) ?? "";
  if (now === opened) return;
  opened = now;
  for (const [sheet, button] of Object.entries(SHEETS)) byId(button).setAttribute("aria-expanded", String(sheet === now));
  stage.fit();
}).observe(document.body, { attributeFilter: ["class"] });

// The key and the button show the original while they are held.
const before = byId("before");
const hide = () => void stage.showBefore(false);
before.addEventListener("pointerdown", () => void stage.showBefore(true));
for (const end of ["pointerup", "pointerleave", "pointercancel", "blur", "keyup"]) before.addEventListener(end, hide);
before.addEventListener("keydown", (e) => {
  if (e.key === " " || e.key === "Enter") void stage.showBefore(true);
});

/** Cancels the drag in progress, and any request for a click. */
function escape(): void {
  app.cancelGesture?.();
  stage.pick(null);
  if (app.appends) app.append(false);
}

/** Keys for the whole page, without Ctrl. */
const KEYS: Record<string, () => void> = {
  "+": () => stage.zoom(ZOOM),
  "=": () => stage.zoom(ZOOM),
  "-": () => stage.zoom(1 / ZOOM),
  "0": () => stage.fit(),
  b: () => void stage.showBefore(true),
  e: showFinalResult,
  "?": () => showKeys(),
};
const COMMANDS: Record<string, (shift: boolean) => void> = {
  s: (shift) => void (shift ? saving.open() : saving.save()),
  z: (shift) => void app.turn(shift ? "redo" : "undo"),
  y: () => void app.turn("redo"),
};

window.addEventListener("keydown", (e) => {
  const key = e.key.toLowerCase();
  if (key === "escape") return escape();
  // Text fields have their undo.
  if (e.altKey || (isTyping(e.target) && key !== "s")) return;
  const isCommand = e.ctrlKey || e.metaKey;
  const action = isCommand ? COMMANDS[key] : isTyping(e.target) ? undefined : KEYS[key];
  if (!action) return;
  if (isCommand) e.preventDefault();
  if (app.isLive && (!e.repeat || !"be".includes(key))) action(e.shiftKey);
});
window.addEventListener("keyup", (e) => {
  if (e.key.toLowerCase() === "b") hide();
});
window.addEventListener("blur", hide);

// Ask before the page closes if something would be lost: no draft can be written, or a program waits for the result.
window.addEventListener("beforeunload", (e) => {
  if (!app.isLive) return;
  void app.settle();
  if (saving.isUnsaved && (app.state?.program || app.state?.problem)) e.preventDefault();
});
