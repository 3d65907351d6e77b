// The page: puts the parts together, and everything that belongs to none of them.

import { App } from "./app";
import { byId } from "./dom";
import { Gallery } from "./gallery";
import { Modes, snapLines } from "./modes";
import { Saving, toast } from "./saving";
import { Settings } from "./settings";
import { Stage } from "./stage";
import { Steps } from "./steps";
import type { Handle } from "./types";
import { short } from "./values";

/** The factor of one step of magnification. */
const ZOOM = 1.25;

const app = new App();
const modes = new Modes();
const stage = new Stage(app, modes);
const gallery = new Gallery(app);
const settings = new Settings(app);
new Steps(app, gallery);
const saving = new Saving(app);
modes.onSnap = snapLines((p) => stage.camera.toScreen(p));

// A line runs along the upper edge while an answer takes longer than that.
const SLOW = 250;
let slow = 0;
app.connection.onBusy = (isBusy) => {
  clearTimeout(slow);
  const view = byId("view");
  view.setAttribute("aria-busy", String(isBusy));
  if (isBusy) slow = window.setTimeout(() => view.classList.add("busy"), SLOW);
  else view.classList.remove("busy");
};

function on(id: string, action: () => void): void {
  byId(id).addEventListener("click", action);
}

on("undo", () => void app.turn("undo"));
on("redo", () => void app.turn("redo"));
on("zoom-in", () => stage.zoom(ZOOM));
on("zoom-out", () => stage.zoom(1 / ZOOM));
on("fit", () => stage.fit());
on("start-over", () => void app.arrange([], 0));
/** Opens or closes one of the sheets of a narrow window; the drawing moves into the room that is left. */
function sheet(name: "shapes-open" | "settings-open" | null): void {
  const { classList } = document.body;
  const opens = name !== null && !classList.contains(name);
  if (!opens && !classList.contains("shapes-open") && !classList.contains("settings-open")) return;
  classList.remove("shapes-open", "settings-open");
  if (opens) classList.add(name);
  stage.fit();
}
on("open-shapes", () => sheet("shapes-open"));
on("open-settings", () => sheet("settings-open"));

stage.onPan = () => {
  if (app.isProposal && app.handles?.handles.length) byId("note").textContent = "This moves the view. Pull a blue point or line to bend the artwork";
};
stage.onZoom = () => {
  byId("zoom").textContent = `${Math.round(100 * stage.camera.scale)}%`;
};

/** A button that stays pressed. */
function toggle(id: string, get: () => boolean, set: (value: boolean) => void): void {
  const button = byId(id);
  const show = () => button.setAttribute("aria-pressed", String(get()));
  button.addEventListener("click", () => {
    set(!get());
    show();
  });
  show();
}

toggle("snap", () => modes.snaps, (v) => (modes.snaps = v));
toggle("mirror", () => modes.mirrors, (v) => (modes.mirrors = v));
toggle("smooth", () => modes.smooths, (v) => (modes.smooths = v));
toggle("stretch", () => stage.showsStretch, (v) => {
  stage.showsStretch = v;
  void stage.drawStretch();
});
settings.onPick = (take) => {
  toast("Click a path of the drawing");
  stage.pick(take);
};
toggle("nodes", () => stage.showsNodes, (v) => {
  stage.showsNodes = v;
  stage.drawNodes();
});

// Before and after: the key and the button show the original while they are held.
const before = byId("before");
before.addEventListener("pointerdown", () => void stage.before(true));
for (const end of ["pointerup", "pointerleave", "pointercancel", "blur"]) before.addEventListener(end, () => void stage.before(false));

before.addEventListener("keydown", (e) => {
  if (e.key === " " || e.key === "Enter") void stage.before(true);
});
before.addEventListener("keyup", () => void stage.before(false));

/** Typing goes into this element. */
function isTyping(target: EventTarget | null): boolean {
  return target instanceof HTMLElement && target.matches("input:not([type=range]):not([type=checkbox]), textarea, select");
}

window.addEventListener("keydown", (e) => {
  const command = e.ctrlKey || e.metaKey;
  const key = e.key.toLowerCase();
  if (command && key === "s") {
    e.preventDefault();
    if (e.shiftKey) saving.open();
    else void saving.quick();
  } else if (command && key === "z" && !isTyping(e.target)) {
    e.preventDefault();
    void app.turn(e.shiftKey ? "redo" : "undo");
  } else if (command && key === "y" && !isTyping(e.target)) {
    e.preventDefault();
    void app.turn("redo");
  } else if (!command && !e.altKey && !isTyping(e.target)) {
    const action = ({ "+": () => stage.zoom(ZOOM), "=": () => stage.zoom(ZOOM), "-": () => stage.zoom(1 / ZOOM), "0": () => stage.fit(), b: () => void stage.before(true) } as Record<string, () => void>)[key];
    if (action && !e.repeat) action();
    if (key === "escape") stage.pick(null);
  }
});
byId("stage").addEventListener("pointerdown", (e) => {
  if (!(e.target as Element).closest(".knob")) sheet(null);
});
window.addEventListener("keyup", (e) => {
  if (e.key.toLowerCase() === "b") void stage.before(false);
});

// The place of the selected handle, to read and to type.
const place = byId("place");
const fields = [byId<HTMLInputElement>("place-x"), byId<HTMLInputElement>("place-y")] as const;
let focused: Handle | null = null;
stage.onFocus = (handle) => {
  focused = handle;
  place.classList.toggle("off", handle === null);
  if (!handle) return;
  byId("place-name").textContent = handle.label;
  byId("remove-point").hidden = !handle.remove;
  const at = handle.get();
  fields.forEach((field, i) => {
    if (document.activeElement !== field) field.value = short(Number(at[i]!.toFixed(3)));
  });
};
fields.forEach((field, i) => field.addEventListener("change", () => {
  const value = Number(field.value.replace(",", "."));
  if (!focused || !Number.isFinite(value)) return;
  const at = focused.get();
  stage.moveTo(focused, i === 0 ? [value, at[1]] : [at[0], value]);
}));

on("remove-point", () => {
  if (focused) stage.remove(focused);
});

// What was done, and what went wrong.
app.listen((change) => {
  const { state, summary } = app;
  if (change === "report" || change === "state") {
    const folds = summary?.folds.length ?? 0;
    // Before anything is done, and where nothing moves, there is nothing to count.
    const isBent = !app.isProposal && summary !== null && summary.segmentsIn > 0;
    byId("counts").textContent = isBent ? `${summary.segmentsIn} → ${summary.segmentsOut} segments` : "";
    byId("error").title = "The largest distance to the exact image, in units of the drawing";
    byId("error").textContent = isBent && summary.error > 0 ? `largest error ${Number(summary.error.toPrecision(2))}` : "";
    const fold = byId("folds");
    fold.hidden = folds === 0;
    fold.textContent = folds === 1 ? "Folds over at 1 place" : `Folds over at ${folds} places`;
    const problem = byId("problem");
    const text = app.problem ?? (state?.problem ? `Nothing is kept until you save: ${state.problem}` : "");
    problem.hidden = text === "";
    problem.textContent = text;
    const warnings = byId("warnings");
    warnings.hidden = app.warnings.length === 0;
    warnings.title = app.warnings.join("\n");
    warnings.textContent = app.warnings.length === 1 ? "1 remark" : `${app.warnings.length} remarks`;
  }
  if (change === "state" && state) {
    byId<HTMLButtonElement>("undo").disabled = !state.undo;
    byId<HTMLButtonElement>("redo").disabled = !state.redo;
    byId<HTMLButtonElement>("start-over").disabled = state.steps.length === 0;
    byId<HTMLButtonElement>("keep-preset").disabled = state.steps.length === 0;
  }
  if (change === "handles" && app.grips.length > 0) {
    const grows = app.handles?.grows ?? false;
    const has = (app.handles?.handles.length ?? 0) > 0;
    const isCurve = app.handles?.handles.some((h) => /\/(in|out)$/.test(h.key)) ?? false;
    byId("smooth").hidden = !isCurve;
    byId("mirror").hidden = !has;
    byId("snap").hidden = !has;
    const pulls = app.handles?.lines().some((line) => line.kind === "path") ? "Pull a blue point or line" : "Pull a blue point";
    const adds = grows ? "Double-click adds one, Delete removes it" : "Double-click the line to add a point, Delete removes it";
    const note = !has ? "Change the settings" : grows || app.handles?.divides ? `${pulls}. ${adds}` : `${pulls} to bend the artwork`;
    byId("note").textContent = app.isProposal && has ? `${note}, or choose a shape` : note;
  }
  if (change === "link") {
    byId("gone").hidden = app.isConnected && !app.isDone;
    byId("gone").classList.toggle("done", app.isDone);
    byId("gone-title").textContent = app.isDone ? `${state?.program} has the result.` : "pathwarp has ended.";
    byId("gone-kept").textContent = app.isDone ? "You can close this page."
      : state?.program ? `${state.program} has stopped waiting. Choose “Bend by hand” there to begin again.`
      : `${state?.saved ? "Everything is saved." : "Your steps are kept beside the drawing."} Run “pathwarp edit” again to go on.`;
  }
  if (change === "state" && state?.restored && !announced) {
    announced = true;
    toast("Your last, unsaved steps are here again");
  }
});
let announced = false;

byId("warnings").addEventListener("click", () => toast(app.warnings.join(" · ")));

// The present steps as a preset.
const presetDialog = byId<HTMLDialogElement>("preset-dialog");
const presetName = byId<HTMLInputElement>("preset-name");
on("keep-preset", () => {
  presetName.value = "";
  presetDialog.showModal();
});
on("preset-cancel", () => presetDialog.close());
presetDialog.querySelector("form")!.addEventListener("submit", (e) => {
  e.preventDefault();
  void app.attempt(async () => {
    const { presets } = await app.connection.ask({ do: "keep-preset", name: presetName.value });
    gallery.showPresets(presets ?? []);
    presetDialog.close();
    toast(`${presetName.value} is kept among the shapes`);
  });
});

// A file dropped anywhere is opened.
window.addEventListener("dragover", (e) => {
  e.preventDefault();
  document.body.classList.add("dropping");
});
window.addEventListener("dragleave", (e) => {
  if (!e.relatedTarget) document.body.classList.remove("dropping");
});
window.addEventListener("drop", (e) => {
  e.preventDefault();
  document.body.classList.remove("dropping");
  const file = e.dataTransfer?.files[0];
  if (file && !app.state?.program) void openFile(file);
});

// Beside a drawing, everything is kept; a program that waits gets nothing from a page that is closed.
window.addEventListener("beforeunload", (e) => {
  if (app.state?.program && saving.isUnsaved && app.isConnected) e.preventDefault();
});

const chosen = byId<HTMLInputElement>("open-file");
on("open", () => chosen.click());
chosen.addEventListener("change", () => {
  const file = chosen.files?.[0];
  chosen.value = "";
  if (file) void openFile(file);
});

async function openFile(file: File): Promise<void> {
  const { state } = app;
  const isUnsaved = state !== null && state.steps.length > 0 && !state.saved;
  if (isUnsaved && !confirm(`The steps of ${state.file} are not saved. Open ${file.name} all the same?`)) return;
  const bytes = new Uint8Array(await file.arrayBuffer());
  let binary = "";
  for (let i = 0; i < bytes.length; i += 0x8000) binary += String.fromCharCode(...bytes.subarray(i, i + 0x8000));
  const answer = await app.attempt(() => app.connection.ask({ do: "open", name: file.name, bytes: btoa(binary) }));
  if (!answer?.state) return;
  stage.forget();
  await app.load(answer.state);
}
