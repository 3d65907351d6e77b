// The list of keys, shown by `?`.

import { byId, h } from "./dom";

const KEYS: [string, string][] = [
  ["Ctrl Z", "Undo; while something is dragged, put it back"],
  ["Ctrl Shift Z", "Redo"],
  ["Ctrl S", "Save"],
  ["Ctrl Shift S", "Save under a name or in another format"],
  ["B, held", "Show the original"],
  ["E", "Show the result of all steps behind that of an earlier one"],
  ["+  −  0", "Zoom in, zoom out, fit everything"],
  ["Arrow keys", "Move the selected point by a pixel, with Shift by ten"],
  ["Insert, Delete", "Add a point after the selected one, take it away"],
  ["Shift, dragging", "Keep to the horizontal or vertical; on the ground, select points"],
  ["Alt, dragging", "Do not snap"],
  ["Tab", "Go on to the next point, button or group of shapes"],
  ["Escape", "Give up what was begun"],
  ["?", "Show this list"],
];

export function showKeys(): void {
  const dialog = byId<HTMLDialogElement>("keys-dialog");
  if (dialog.open) return dialog.close();
  byId("keys-list").replaceChildren(...KEYS.flatMap(([keys, what]) => [h("dt", {}, keys), h("dd", {}, what)]));
  dialog.showModal();
}
