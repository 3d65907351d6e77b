// Fields for numbers: arithmetic with units, arrow keys, and messages about errors.

import { byId, h } from "./dom";
import { toast } from "./toast";

/** A number with its typed unit. */
export interface Quantity {
  value: number;
  unit: string;
}

/** The length of a mm, in px. */
export const MM = 96 / 25.4;
/** The units of length, in px. */
const LENGTHS: Record<string, number> = { px: 1, in: 96, mm: MM, cm: 96 / 2.54, m: 96 / 0.0254, pt: 96 / 72, pc: 16, q: 96 / 101.6 };
const TOKEN = /\s*(?:(\d+[.,]?\d*|[.,]\d+)\s*(%|°|[a-z]+)?|([-+*/()]))\s*/iy;

/** Significant figures of a sum that are not affected by rounding. */
const EXACT = 12;

/** Evaluates a sum, difference, product or quotient; numbers without a unit get the field's. `null` if the text is not an expression. */
export function evaluate(text: string, unit: string): Quantity | null {
  const tokens: (Quantity | string)[] = [];
  const normal = text.replaceAll("−", "-").replaceAll("×", "*");
  for (TOKEN.lastIndex = 0; TOKEN.lastIndex < normal.length; ) {
    const found = TOKEN.exec(normal);
    if (!found) return null;
    tokens.push(found[3] ?? { value: Number(found[1]!.replace(",", ".")), unit: (found[2] ?? "").toLowerCase().replace(/^deg$/, "°") });
  }
  try {
    const result = sum(tokens);
    return tokens.length === 0 && Number.isFinite(result.value) ? { value: Number(result.value.toPrecision(EXACT)), unit: result.unit || unit } : null;
  } catch {
    return null;
  }

  function sum(rest: (Quantity | string)[]): Quantity {
    let left = product(rest);
    while (rest[0] === "+" || rest[0] === "-") {
      const sign = rest.shift() === "+" ? 1 : -1;
      const right = product(rest);
      // A number without a unit beside one with a unit gets the field's.
      const [a, b] = [left.unit || unit, right.unit || unit];
      left = { value: left.value + sign * right.value * factor(b, a), unit: a };
    }
    return left;
  }

  function product(rest: (Quantity | string)[]): Quantity {
    let left = single(rest);
    while (rest[0] === "*" || rest[0] === "/") {
      const isTimes = rest.shift() === "*";
      const right = single(rest);
      if (right.unit && (left.unit || !isTimes)) throw new Error("a product of units");
      left = { value: isTimes ? left.value * right.value : left.value / right.value, unit: left.unit || right.unit };
    }
    return left;
  }

  function single(rest: (Quantity | string)[]): Quantity {
    const next = rest.shift();
    if (next === "-" || next === "+") {
      const { value, unit } = single(rest);
      return { value: next === "-" ? -value : value, unit };
    }
    if (next === "(") {
      const inner = sum(rest);
      if (rest.shift() !== ")") throw new Error("no closing bracket");
      return inner;
    }
    if (typeof next !== "object") throw new Error("no number");
    return next;
  }
}

/** Evaluates a text in this unit, whatever units are typed. `null` if it is not an expression. */
export function inUnits(text: string, unit: string): number | null {
  // A sum gets the unit of its first number.
  return evaluate(`0${unit}+(${text})`, unit)?.value ?? null;
}

/** Returns the number of units `to` in a unit `from`. */
function factor(from: string, to: string): number {
  if (from === to) return 1;
  const [a, b] = [LENGTHS[from], LENGTHS[to]];
  if (a === undefined || b === undefined) throw new Error("units of different kinds");
  return a / b;
}

/** Limits beyond this are numerical, and not shown. */
const BOUNDLESS = 1e6;

/** Returns a description of the permitted values, as the message for a wrong one. */
export function describeLimits(unit: string, from = -Infinity, to = Infinity, isWhole = false): string {
  const [least, most] = [Number(from.toPrecision(6)), to < BOUNDLESS ? to : Infinity];
  const [what, end] = [isWhole ? "A whole number" : "A number", unit && ` ${unit}`];
  if (least > -Infinity && most < Infinity) return `${what} from ${least} to ${most}${end}`;
  if (least > -Infinity) return `${what} from ${least}${end} up`;
  return `${what}, such as ${isWhole ? 3 : 30}${end}`;
}

/** Returns the message of anything thrown. */
export function reason(e: unknown): string {
  return e instanceof Error ? e.message : String(e);
}

/** Turns the program's message into a sentence with typographic quotes. Beside a field, the field's name is omitted. */
export function inWords(problem: string, isBeside = false): string {
  const text = problem.replace(/^error: /, "").replace(isBeside ? /^“[^”]*”: / : "", "").replace(/`([^`]*)`/g, "“$1”");
  // Names of files keep their case.
  return /^(\S+|[^:;]*\.\w{1,5}): /.test(text) ? text : text.replace(/^./, (c) => c.toUpperCase());
}

type Editable = HTMLInputElement | HTMLTextAreaElement;

/** A field that keeps a wrong text, with a message, until it is corrected or abandoned. */
export class Field {
  readonly message = h("p", { class: "wrong", role: "alert", hidden: true });
  /** The value for which the text is wrong. */
  private wrongFor: string | null = null;
  private shown = "";

  /** `take` accepts a text and returns its problem; `isWrong` checks typed texts; `nudge` moves the value by steps and returns its text. */
  constructor(
    readonly input: Editable, private read: () => string, private take: (text: string) => string | null | Promise<string | null>,
    private isWrong: (text: string) => string | null = () => null, nudge?: (text: string, by: number) => string | null,
  ) {
    this.message.id = `${input.id}-wrong`;
    input.addEventListener("change", () => void this.done());
    input.addEventListener("input", () => {
      if (!this.message.hidden) this.say(this.isWrong(input.value));
    });
    input.addEventListener("keydown", ((e: KeyboardEvent) => {
      if (e.key === "Escape") this.reset();
      else if (e.key === "Enter" && (input.tagName === "INPUT" || "single" in input.dataset)) {
        e.preventDefault();
        input.blur();
        input.focus();
      } else if (nudge && (e.key === "ArrowUp" || e.key === "ArrowDown")) {
        const next = nudge(input.value, (e.key === "ArrowUp" ? 1 : -1) * (e.shiftKey ? 10 : 1));
        e.preventDefault();
        if (next !== null) input.value = this.shown = next;
        this.say(null);
      }
    }) as EventListener);
  }

  private async done(): Promise<void> {
    const text = this.input.value;
    const problem = this.isWrong(text) ?? (await this.take(text));
    if (problem !== null) this.input.value = text;
    this.say(problem);
    if (problem === null) this.refresh();
  }

  private say(problem: string | null): void {
    this.wrongFor = problem === null ? null : this.read();
    this.message.textContent = problem;
    this.message.hidden = problem === null;
    for (const [name, value] of [["aria-invalid", "true"], ["aria-describedby", this.message.id]] as const) {
      if (problem === null) this.input.removeAttribute(name);
      else this.input.setAttribute(name, value);
    }
  }

  /** Shows the valid value again. */
  private reset(): void {
    this.say(null);
    this.input.value = this.shown = this.read();
    this.input.select();
  }

  refresh(): void {
    const value = this.read();
    if (this.wrongFor === value) return;
    if (this.wrongFor !== null) this.say(null);
    // Keep the text being typed, unless the value is dragged meanwhile.
    if (document.activeElement === this.input && this.input.value !== this.shown && value === this.shown) return;
    this.input.value = this.shown = value;
  }
}

/** Focuses the first field with a wrong text. Returns `false` if there is none. */
export function showWrong(): boolean {
  const field = document.querySelector<Editable>("#settings [aria-invalid=true], #place [aria-invalid=true]");
  if (!field) return false;
  field.focus();
  toast(`${field.labels?.[0]?.textContent?.trim()}: ${byId(`${field.id}-wrong`).textContent}`);
  return true;
}
