// Names for display.

import type { Deformation, Param, Step } from "./types";

/** Converts a name in kebab case to words: `reverse-shaper` to “Reverse shaper”. */
export function words(name: string): string {
  const text = name.replaceAll("-", " ").replace(/([a-z])([0-9])/g, "$1 $2");
  return capital(text);
}

export function capital(text: string): string {
  return text.charAt(0).toUpperCase() + text.slice(1);
}

/** Returns the name of a deformation. */
export function called({ name, label }: { name: string; label: string | null }): string {
  return label ?? words(name);
}

/** Returns the name of a parameter. */
export function paramName({ name, label }: Param): string {
  return label ?? words(name);
}

/** Returns `true` for a step that sets words on the drawing. */
export function isCaption({ deformation }: { deformation: string }): boolean {
  return deformation === "caption";
}

/** Most letters of words that name a step. */
const LONGEST = 30;

/** Returns the name of a step: the user's, or else its words, its preset, its variant, or its deformation. */
export function stepName(step: Step, deformation: Deformation | undefined): string {
  if (step.name) return step.name;
  if (!deformation) return words(step.deformation);
  if (isCaption(step)) return `“${(step.args.words ?? []).join(" ").slice(0, LONGEST)}”`;
  const preset = deformation.gallery ? step.args[deformation.gallery.presets]?.[0] : undefined;
  const variant = deformation.variants.find(({ param }) => step.args[param]);
  const isKnown = deformation.params.some((p) => p.name === deformation.gallery?.presets && p.words?.includes(preset ?? ""));
  // Names of files keep their case.
  return preset ? (isKnown ? words(preset) : preset.split(/[\\/]/).pop()!) : variant?.label ?? called(deformation);
}
