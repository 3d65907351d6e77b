// Short messages over the canvas.

import { byId } from "./dom";

/** The shortest time for which a message is shown, and the time for reading a character, in ms. */
const SHORTEST = 5000;
const CHARACTER = 60;

let fading = 0;

/** Shows a message for a while. */
export function toast(text: string): void {
  const box = byId("toast");
  box.textContent = text;
  box.classList.add("on");
  clearTimeout(fading);
  fading = window.setTimeout(() => box.classList.remove("on"), Math.max(SHORTEST, CHARACTER * text.length));
}
