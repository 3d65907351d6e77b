// What is typed into fields of numbers: arithmetic with units, arrow keys, and words for what is wrong.

import { byId, h } from "./dom";
import { toast } from "./toast";

/** A number with the unit it was typed in. */
export interface Quantity {
  value: number;
  unit: string;
}

/** Lengths, in px. */
const LENGTHS: Record<string, number> = { px: 1, in: 96, mm: 96 / 25.4, cm: 96 / 2.54, m: 96 / 0.0254, pt: 96 / 72, pc: 16, q: 96 / 101.6 };
const TOKEN = /\s*(?:(\d+[.,]?\d*|[.,]\d+)\s*(%|°|[a-z]+)?|([-+*/()]))\s*/iy;

/** The figures of a sum that computing leaves right. */
const EXACT = 12;

/** The value of a sum, difference, product or quotient; numbers without a unit have the field's. `null` if the text is none. */
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
      // A plain number beside one with a unit has the field's.
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

/** A value in this unit, whatever others are typed. `null` if the text is none. */
export function inUnits(text: string, unit: string): number | null {
  // A sum has the unit of its first number.
  return evaluate(`0${unit}+(${text})`, unit)?.value ?? null;
}

/** The number of units `to` in a unit. */
function factor(from: string, to: string): number {
  if (from === to) return 1;
  const [a, b] = [LENGTHS[from], LENGTHS[to]];
  if (a === undefined || b === undefined) throw new Error("units of different kinds");
  return a / b;
}

/** Limits from here on are those of computing, not of the value. */
const BOUNDLESS = 1e6;

/** What may be typed. */
export function asked(unit: string, from = -Infinity, to = Infinity, isWhole = false): string {
  const [least, most] = [Number(from.toPrecision(6)), to < BOUNDLESS ? to : Infinity];
  const [what, end] = [isWhole ? "A whole number" : "A number", unit && ` ${unit}`];
  if (least > -Infinity && most < Infinity) return `${what} from ${least} to ${most}${end}`;
  if (least > -Infinity) return `${what} from ${least}${end} up`;
  return `${what}, such as ${isWhole ? 3 : 30}${end}`;
}

/** What is wrong, of whatever was thrown. */
export function reason(e: unknown): string {
  return e instanceof Error ? e.message : String(e);
}

/** What the program says: a sentence with its quotes. Beside a field, its name in front is left out. */
export function inWords(problem: string, isBeside = false): string {
  const text = problem.replace(/^error: /, "").replace(isBeside ? /^“[^”]*”: / : "", "").replace(/`([^`]*)`/g, "“$1”");
  // Names of files stay as they are.
  return /^(\S+|[^:;]*\.\w{1,5}): /.test(text) ? text : text.replace(/^./, (c) => c.toUpperCase());
}

type Editable = HTMLInputElement | HTMLTextAreaElement;

/** A field that keeps what is wrong in it, with a word about it, until it is right or given up. */
export class Field {
  readonly message = h("p", { class: "wrong", role: "alert", hidden: true });
  /** The value for which the text is wrong. */
  private wrongFor: string | null = null;
  private shown = "";

  /** `take` returns what is wrong with a text; `isWrong` knows it while it is typed. */
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
    if (problem === null) this.input.removeAttribute("aria-invalid");
    else this.input.setAttribute("aria-invalid", "true");
    if (problem === null) this.input.removeAttribute("aria-describedby");
    else this.input.setAttribute("aria-describedby", this.message.id);
  }

  /** The value that holds is on show again. */
  private reset(): void {
    this.say(null);
    this.input.value = this.shown = this.read();
    this.input.select();
  }

  refresh(): void {
    const value = this.read();
    if (this.wrongFor === value) return;
    if (this.wrongFor !== null) this.say(null);
    // What is being typed stays; a value that is dragged meanwhile is shown.
    if (document.activeElement === this.input && this.input.value !== this.shown && value === this.shown) return;
    this.input.value = this.shown = value;
  }
}

/** Shows the first value that has been typed wrong. Returns `false` if there is none. */
export function showWrong(): boolean {
  const field = document.querySelector<Editable>("#settings [aria-invalid=true], #place [aria-invalid=true]");
  if (!field) return false;
  field.focus();
  toast(`${field.labels?.[0]?.textContent?.trim()}: ${byId(`${field.id}-wrong`).textContent}`);
  return true;
}
