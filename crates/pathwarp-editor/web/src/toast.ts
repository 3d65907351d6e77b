// Short messages over the canvas.

import { byId } from "./dom";

/** The shortest time for which a message is shown, and the time for each character, in ms. */
const SHORTEST = 5000;
const CHARACTER = 60;
/** Distance between the tools and a message, in px. */
const ABOVE = 10;

let fading = 0;
let shown = 0;

/** Shows a message for a while. Returns a function that removes it. */
export function toast(text: string, stays = false): () => void {
  const box = byId("toast");
  const [view, tools] = [byId("view").getBoundingClientRect(), byId("tools").getBoundingClientRect()];
  if (tools.height > 0) box.style.setProperty("bottom", `${view.bottom - tools.top + ABOVE}px`);
  else box.style.removeProperty("bottom");
  box.textContent = text;
  box.classList.add("on");
  clearTimeout(fading);
  const own = ++shown;
  if (!stays) fading = window.setTimeout(hush, Math.max(SHORTEST, CHARACTER * text.length));
  return () => {
    if (own === shown) hush();
  };
}

/** Removes the message when the user continues with something else. */
export function hush(): void {
  byId("toast").classList.remove("on");
}
