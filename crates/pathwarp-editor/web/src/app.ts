// The state of the page: the steps, the one that is being edited, and the pictures that the server makes of them.

import { Connection, Gone } from "./connection";
import { isTyping } from "./dom";
import { hush, toast } from "./toast";
import { inWords, reason, showWrong } from "./fields";
import { Handles } from "./handles";
import { isCaption } from "./names";
import type { Answer, Deformation, Grip, State, Step, StepGrips, Summary, XY } from "./types";

/** Tolerance of curves while something is dragged, in px of the screen. */
const DRAFT_TOLERANCE = 0.35;
/** The event with the times at which a draft was requested, answered and shown; tests measure speed by it. */
const DRAFT_EVENT = "pathwarp-drafted";
/** The pause after which keys become one change, in ms. */
const KEY_PAUSE = 500;
/** The least visible distance, in mm. */
const VISIBLE_MM = 0.05;
/** Parameters that determine the number of control points of a net. */
const NET_PARAMS = new Set(["degree", "cells", "spline"]);

/** Changes that are told to listeners: `values` are those of the edited step, `link` is the connection, `report` the messages. */
export type Change = "state" | "steps" | "handles" | "values" | "report" | "link";

/** The view that shows pictures. */
export interface Screen {
  show(answer: Answer): void;
  /** The length of a px, in user units. */
  readonly pixel: number;
  /** Shows the whole page, unless the user views a detail. */
  reveal(): void;
}

export class App {
  catalogue: Deformation[] = [];
  state: State | null = null;
  steps: Step[] = [];
  /** The step whose handles and settings are shown. */
  selected = 0;
  /** `true` while the steps are a proposal that has not been used. */
  isProposal = false;
  /** `true` once the edited step has been changed since its shape was chosen. */
  isWorkedOn = false;
  /** `true` if the next chosen shape is appended as a step. */
  appends = false;
  /** Selectors of the parts that no step bends. */
  locks: string[] = [];
  /** The geometry of each step's parameters, from which handles are made. */
  grips: StepGrips[] = [];
  /** The indices of steps for parts that the drawing lacks. */
  gone: number[] = [];
  handles: Handles | null = null;
  /** A path of the drawing that was a guide until its line was dragged. */
  freedPath: string | null = null;
  summary: Summary | null = null;
  warnings: string[] = [];
  problem: string | null = null;
  isConnected = false;
  /** `true` once the steps have been handed to the program that waited for them. */
  isDone = false;
  /** `true` while a handle is dragged; the handles then stay as they are. */
  isDragging = false;
  /** Cancels the drag or the drawing of a line in progress. */
  cancelGesture: (() => void) | null = null;
  screen: Screen = { show: () => {}, pixel: 1, reveal: () => {} };

  private listeners: { changes: Change[]; listener: () => void }[] = [];
  /** `true` while a draft is being made, and if another one is to follow. */
  private isDrafting = false;
  private isDraftWanted = false;
  /** The time of the event that the next draft shows, in ms. */
  private draftedEventTime = 0;
  /** The queue of changes to the steps. */
  private turns: Promise<unknown> = Promise.resolve();
  /** The last commit; the server answers commits in order. */
  private lastCommit: Promise<void> = Promise.resolve();
  /** The number of commits that the server has refused. */
  private refusals = 0;
  /** The timer that commits the steps after keys have moved a handle; 0 if none runs. */
  private commitTimer = 0;
  readonly connection: Connection;

  constructor() {
    this.connection = new Connection(
      () => void this.begin(),
      () => {
        this.isConnected = false;
        this.stopCommitTimer();
        this.tell("link");
      },
      (news) => void this.takeNews(news),
    );
  }

  /** `true` if changes are stored. */
  get isLive(): boolean {
    return this.isConnected && !this.isDone;
  }

  /** Calls a listener after these changes. */
  listen(changes: Change[], listener: () => void): void {
    this.listeners.push({ changes, listener });
  }

  tell(change: Change): void {
    for (const { changes, listener } of this.listeners) if (changes.includes(change)) listener();
  }

  get step(): Step | undefined {
    return this.steps[this.selected];
  }

  deformation(name: string | undefined): Deformation | undefined {
    return this.catalogue.find((d) => d.name === name);
  }

  /** Returns `true` for an edit, which changes the drawing before it is bent. */
  isFirst(step: Step | undefined): boolean {
    return this.deformation(step?.deformation)?.first ?? false;
  }

  /** The steps up to the edited one. */
  get visible(): Step[] {
    return this.steps.slice(0, this.selected + 1);
  }

  private async begin(): Promise<void> {
    const answer = await this.connection.ask({ do: "hello" });
    this.catalogue = answer.catalogue ?? [];
    this.isConnected = true;
    this.tell("link");
    await this.load(answer.state!);
  }

  /** Ends the page after the steps have been handed over. */
  finish(): void {
    this.isDone = true;
    this.connection.stop();
    this.tell("link");
  }

  /** Adopts a state of the server, with a proposal if nothing has been done yet. */
  async load(state: State): Promise<void> {
    this.state = state;
    this.steps = structuredClone(state.steps);
    this.selected = Math.max(0, Math.min(this.steps.length - 1, Math.max(this.selected, this.steps.length - 1)));
    this.locks = this.steps[0]?.exclude ?? [];
    this.isProposal = false;
    this.isWorkedOn = this.steps.length > 0;
    this.appends = false;
    this.tell("state");
    const first = this.catalogue[0];
    if (this.steps.length === 0 && first) {
      const step = await this.opening(first.name, []);
      if (step) {
        this.steps = [step];
        this.selected = 0;
        this.isProposal = true;
      }
    }
    this.tell("steps");
    if (await this.refresh()) return;
    // Show the drawing regardless: flat artwork fits into no cage, and steps may name a file that is gone.
    const { problem } = this;
    this.dropHandles();
    if (this.isProposal) this.steps = [];
    await this.attempt(async () => this.take(await this.connection.ask({ do: "bend", steps: [], draft: null })));
    this.tell("steps");
    if (this.isProposal) this.isProposal = false;
    else this.fail(problem);
  }

  /** Replaces the drawing after all pending changes; later changes, such as an undo, wait for it. */
  enter(answer: () => Promise<{ state?: State | null } | null>): Promise<void> {
    return this.inTurn(async () => {
      const state = (await answer())?.state;
      if (state) await this.load(state);
    });
  }

  /** Requests the first values of a deformation that follows these steps. */
  async opening(deformation: string, steps: Step[], variant: string | null = null, select: string[] = []): Promise<Step | null> {
    return this.attempt(async () => {
      const { step } = await this.connection.ask({ do: "opening", deformation, variant, steps, select });
      return step ? { ...step, exclude: this.locks } : null;
    });
  }

  /** The selectors of the edited step's parts; empty for the whole drawing. */
  get selectors(): string[] {
    return this.step?.select ?? [];
  }

  /** Applies the edited step only to these parts, with its paths mapped onto their box. */
  scope(select: string[]): Promise<void> {
    return this.inTurn(async () => {
      const { step, selected } = this;
      if (!step || this.isFirst(step) || (select.length === 0 && this.selectors.length === 0)) return;
      const answer = await this.request({ do: "scope", steps: this.visible, select });
      if (!answer?.step) return;
      this.steps = this.steps.map((s, i) => (i === selected ? answer.step! : s));
      this.tell("steps");
      this.dropHandles();
      await this.commit();
    });
  }

  /** Excludes these parts from all steps. */
  lock(locks: string[]): Promise<void> {
    this.locks = locks;
    return this.arrange(this.steps.map((step) => ({ ...step, exclude: locks })), this.selected);
  }

  /** Shows the exact picture of the present steps. Returns `false` if there is none. */
  async refresh(): Promise<boolean> {
    const shown = await this.attempt(async () => {
      this.take(await this.connection.ask({ do: "bend", steps: this.visible, draft: null }));
      return true;
    });
    return shown ?? !this.isConnected;
  }

  /** Shows a draft of the present steps. While one is being made, only the newest request is kept. */
  async draft(eventTime: number): Promise<void> {
    this.draftedEventTime = eventTime;
    this.isDraftWanted = true;
    if (this.isDrafting) return;
    this.isDrafting = true;
    do {
      this.isDraftWanted = false;
      const start = this.draftedEventTime;
      await this.attempt(async () => {
        const asked = performance.now();
        const answer = await this.connection.ask({ do: "bend", steps: this.visible, draft: DRAFT_TOLERANCE * this.screen.pixel });
        const answered = performance.now();
        this.take(answer);
        const detail = { start, asked, answered, shown: performance.now(), size: this.connection.size };
        window.dispatchEvent(new CustomEvent(DRAFT_EVENT, { detail }));
      });
    } while (this.isDraftWanted);
    this.isDrafting = false;
  }

  /** Stores the present steps, with a state to undo. */
  commit(): Promise<void> {
    this.lastCommit = this.sendCommit();
    return this.lastCommit;
  }

  private async sendCommit(): Promise<void> {
    this.isDraftWanted = false;
    this.stopCommitTimer();
    const done = await this.attempt(async () => {
      const answer = await this.connection.ask({ do: "commit", steps: this.steps, shown: this.selected + 1 });
      this.isProposal = false;
      this.isWorkedOn = true;
      this.take(answer);
      return true;
    });
    if (done || !this.state || !this.isConnected) return;
    this.refusals += 1;
    // Return to the steps that work, and show the reason.
    const { problem } = this;
    await this.load(this.state);
    this.fail(problem);
  }

  /** Commits if no other key follows for a while. */
  commitSoon(): void {
    this.isDragging = true;
    clearTimeout(this.commitTimer);
    this.commitTimer = window.setTimeout(() => void this.flush(), KEY_PAUSE);
  }

  /** Commits changes made by keys so far, if any. */
  async flush(): Promise<void> {
    if (this.stopCommitTimer()) await this.commit();
  }

  /** Waits until the server has stored all changes. Returns `false` if it refuses some. */
  async settle(): Promise<boolean> {
    const { refusals } = this;
    this.takeTyped();
    await this.turns;
    await this.flush();
    await this.lastCommit;
    return !showWrong() && this.refusals === refusals;
  }

  /** Accepts the value that is being typed, as if its field had lost the focus. */
  private takeTyped(): void {
    const field = document.activeElement;
    if (!isTyping(field)) return;
    field.blur();
    field.focus({ preventScroll: true });
  }

  /** Returns `true` if a timer ran. */
  private stopCommitTimer(): boolean {
    if (this.commitTimer === 0) return false;
    clearTimeout(this.commitTimer);
    this.commitTimer = 0;
    this.isDragging = false;
    return true;
  }

  /** Cancels a drag: restores the step as it was before. */
  cancel(step: Step, before: Step): void {
    this.cancelGesture = null;
    this.isDragging = false;
    this.isDraftWanted = false;
    this.steps = this.steps.map((s) => (s === step ? before : s));
    void this.refresh();
    this.tell("values");
  }

  /** Changes the steps after all pending changes, so that a late answer does not replace a newer choice. */
  private inTurn<T>(work: () => Promise<T>): Promise<T> {
    hush();
    const done = this.turns.then(() => this.flush()).then(work);
    this.turns = done.catch(() => undefined);
    return done;
  }

  /** Undoes or redoes; during a drag, undoing only cancels the drag. */
  async turn(direction: "undo" | "redo"): Promise<void> {
    if (this.cancelGesture) return direction === "undo" ? this.cancelGesture() : undefined;
    this.takeTyped();
    return this.inTurn(async () => {
      if (!this.state?.[direction]) return;
      await this.attempt(async () => {
        const answer = await this.connection.ask({ do: direction, shown: null });
        // Later pictures are sent as changes to this one.
        this.screen.show(answer);
        await this.load(answer.state!);
        this.screen.reveal();
      });
    });
  }

  /** Starts or ends the choice of a shape for another step. */
  append(appends: boolean): void {
    this.appends = appends;
    this.tell("steps");
  }

  /** Replaces the edited step, or appends one if requested. */
  choose(deformation: string, args: Record<string, string[]>, variant: string | null = null): Promise<void> {
    let { appends } = this;
    this.appends = false;
    return this.inTurn(async () => {
      if (this.deformation(deformation)?.first) return this.insertEdit(deformation);
      // An edit is not replaced by a deformation.
      appends ||= this.isFirst(this.step);
      const at = appends ? this.steps.length : this.selected;
      const step = await this.opening(deformation, this.steps.slice(0, at), variant, this.selectors);
      if (!step) return;
      Object.assign(step.args, args);
      await this.commitNew(this.steps.toSpliced(at, 1, step), at);
    });
  }

  /** Stores steps with a new one, and shows all of it, since it may need more room. */
  private async commitNew(steps: Step[], selected: number): Promise<void> {
    this.steps = steps;
    this.selected = Math.min(selected, steps.length - 1);
    this.tell("steps");
    this.dropHandles();
    await this.commit();
    this.isWorkedOn = false;
    this.tell("steps");
    this.screen.reveal();
  }

  /** Inserts an edit before all deformations, in the order of the catalogue; there is one of each kind. */
  private async insertEdit(deformation: string): Promise<void> {
    const others = this.isProposal ? [] : this.steps;
    const known = others.findIndex((s) => s.deformation === deformation && !isCaption(s));
    if (known >= 0) return this.showStep(known);
    const step = await this.opening(deformation, []);
    if (!step) return;
    const rank = (s: Step) => this.catalogue.findIndex((d) => d.name === s.deformation);
    const at = others.filter((s) => this.isFirst(s) && rank(s) < rank(step)).length;
    await this.commitNew(others.toSpliced(at, 0, step), at);
  }

  /** Inserts words after existing ones, before all other steps. Returns their step, which is stored when it is committed. */
  caption(args: Record<string, string[]>): Promise<Step | null> {
    return this.inTurn(async () => {
      const step = await this.opening("caption", []);
      if (!step) return null;
      Object.assign(step.args, args);
      const others = this.isProposal ? [] : this.steps;
      this.isProposal = false;
      this.selected = others.filter(isCaption).length;
      this.steps = others.toSpliced(this.selected, 0, step);
      this.tell("steps");
      this.dropHandles();
      await this.refresh();
      return step;
    });
  }

  /** Replaces the list of steps. */
  arrange(steps: Step[], selected: number): Promise<void> {
    return this.inTurn(async () => {
      this.steps = steps;
      this.appends = false;
      this.selected = Math.max(0, Math.min(selected, steps.length - 1));
      this.tell("steps");
      this.dropHandles();
      await this.commit();
      if (this.steps.length === 0 && this.state) await this.load(this.state);
      this.tell("steps");
    });
  }

  select(step: number): Promise<void> {
    return this.inTurn(() => this.showStep(step));
  }

  private async showStep(step: number): Promise<void> {
    this.selected = step;
    this.tell("steps");
    await this.refresh();
  }

  /** Sets a parameter of the edited step: `isDone` stores it, otherwise a draft is shown. */
  set(name: string, values: string[], isDone: boolean): void {
    const { step } = this;
    if (!step) return;
    if (isDone && NET_PARAMS.has(name) && this.handles?.net) return void this.inTurn(() => this.renet({ [name]: values }));
    // Each shape has different adjust values.
    const { presets } = this.deformation(step.deformation)?.gallery ?? {};
    if (name === presets) for (const [other, { adjust }] of Object.entries(this.grips[this.selected]?.params ?? {})) if (adjust) delete step.args[other];
    if (values.length === 0) delete step.args[name];
    else step.args[name] = values;
    const instead = this.deformation(step.deformation)?.params.find((p) => p.name === name)?.instead;
    if (instead && values.length > 0) {
      for (const other of instead.others) delete step.args[other];
      if (instead.with) step.args[instead.with[0]] ??= [instead.with[1]];
    }
    void (isDone ? this.commit() : this.draft(performance.now()));
  }

  /** Sets a parameter by a key; keys that follow belong to the same change. */
  setSoon(name: string, values: string[]): void {
    // A net's points are recomputed at once.
    if (NET_PARAMS.has(name) && this.handles?.net) return this.set(name, values, true);
    this.set(name, values, false);
    this.commitSoon();
    this.tell("values");
  }

  /** Sets a parameter to a typed value. Returns the problem, if any. */
  async setTyped(name: string, values: string[]): Promise<string | null> {
    const { refusals } = this;
    this.set(name, values, true);
    await this.turns;
    await this.lastCommit;
    const { problem } = this;
    if (this.refusals === refusals || problem === null) {
      this.screen.reveal();
      return null;
    }
    this.fail(null);
    return inWords(problem, true);
  }

  /** Changes the number of control points of the step's net, which bends as before. */
  private async renet(values: Record<string, string[]>): Promise<void> {
    const answer = await this.request({ do: "renet", steps: this.visible, values });
    if (!answer?.step) return this.tell("steps");
    const [a, b] = this.state?.toPx ?? [1, 0];
    const mm = ((answer.moved ?? 0) * Math.hypot(a, b) * 25.4) / 96; // A px is 1/96 in.
    if (mm >= VISIBLE_MM) toast(`The shape has moved by up to ${mm.toFixed(mm < 10 ? 2 : 0)} mm: so few points cannot hold it`);
    this.steps = this.steps.map((s, i) => (i === this.selected ? answer.step! : s));
    this.tell("steps");
    this.dropHandles();
    await this.commit();
  }

  grip(name: string): Grip | undefined {
    return this.grips[this.selected]?.params[name];
  }

  /** Returns the least radius around which the artwork fits, if it is longer than its full circle and is not stretched; else `null`. */
  leastRadius(name: string): number | null {
    const [circle, frame, step] = [this.grip(name)?.circle, this.grips[this.selected]?.frame, this.step];
    if (!circle || !frame || name !== "along" || ["stretch", "copies", "width"].some((other) => step?.args[other])) return null;
    const [, , radius, start, end] = circle;
    const least = frame[2] / (Math.abs(end - start) * (Math.PI / 180));
    return radius < least && Math.abs(Math.abs(end - start) - 360) < 1e-6 ? least : null;
  }

  private take(answer: Answer): void {
    this.problem = null;
    if (answer.state) {
      this.state = answer.state;
      this.tell("state");
    }
    this.warnings = answer.warnings ?? [];
    this.summary = answer.summary ?? null;
    if (answer.grips) this.grips = answer.grips;
    if (answer.gone) this.gone = answer.gone;
    this.screen.show(answer);
    if (!this.isDragging) this.takeHandles();
    this.tell("report");
  }

  /** Removes the handles of a step that is being replaced, so that they cannot be dragged meanwhile. */
  private dropHandles(): void {
    this.cancelGesture?.();
    this.handles = null;
    this.grips = [];
    this.tell("handles");
  }

  private takeHandles(): void {
    this.freedPath = this.handles?.freedPath ?? null;
    const deformation = this.deformation(this.step?.deformation);
    const grips = this.grips[this.selected];
    this.handles = this.step && deformation && grips ? new Handles(deformation, this.step, grips) : null;
    this.tell("handles");
  }

  /** Adopts changes of the steps by another page. */
  private async takeNews(news: Answer): Promise<void> {
    if (news.event !== "changed" || !news.state) return;
    if (this.isDragging) {
      // A drag in the same drawing takes precedence.
      if (news.state.drawing === this.state?.drawing) return;
      this.cancelGesture?.();
      this.stopCommitTimer();
    }
    const { file } = this.state ?? news.state;
    await this.load(news.state);
    if (news.state.file !== file) toast(`${news.state.file} has been opened in another tab. The steps of ${file} are kept with it`);
  }

  /** Does something that the server may refuse, and shows the message then. */
  async attempt<T>(work: () => Promise<T>): Promise<T | null> {
    try {
      return await work();
    } catch (e) {
      if (!(e instanceof Gone)) this.fail(inWords(reason(e)));
      return null;
    }
  }

  /** Asks the server, and shows its message if it refuses. */
  request(question: Parameters<Connection["ask"]>[0]): Promise<Answer | null> {
    return this.attempt(() => this.connection.ask(question));
  }

  fail(problem: string | null): void {
    this.problem = problem;
    this.tell("report");
  }

  /** Adds a point where the step takes any number of them, and at the mirrored points. Returns the key of its handle. */
  addPoint(at: XY, others: XY[], reach: number): Promise<string | null> {
    return this.inTurn(async () => {
      const { handles } = this;
      if (!handles) return null;
      const denser = handles.denser(at, reach);
      if (denser) await this.renet(denser);
      else if (!(await this.addPoints(handles, at, others, reach))) return null;
      return this.handles?.nearest(at)?.key ?? null;
    });
  }

  /** Returns `false` if no point can be added at `at`. */
  private async addPoints(handles: Handles, at: XY, others: XY[], reach: number): Promise<boolean> {
    const points = handles.isFree(at, reach) ? [at, ...others] : [at];
    // A pin holds the artwork under the pointer.
    const sources = handles.addsPins ? await Promise.all(points.map((p) => this.preimage(p))) : points;
    if (this.handles !== handles || !sources[0]) return false;
    const isAdded = points.map((p, i) => sources[i] != null && handles.add(p, sources[i]!, reach));
    if (!isAdded[0]) return false;
    this.tell("handles");
    await this.commit();
    return true;
  }

  /** Returns the point of the drawing that the visible steps map to `at`, or `at` if there is none. */
  async source(at: XY): Promise<XY> {
    for (let k = this.visible.length; k > 0; k--) {
      const steps = this.visible.slice(0, k);
      if (this.isFirst(steps[k - 1]) || steps[k - 1]?.hidden || this.gone.includes(k - 1)) continue;
      at = (await this.request({ do: "preimage", steps, at }))?.at ?? at;
    }
    return at;
  }

  /** Returns the point of the artwork that the step maps to `at`. */
  private async preimage(at: XY): Promise<XY | null> {
    const source = (await this.request({ do: "preimage", steps: this.visible, at }))?.at;
    if (source === null) this.fail("No place of the artwork comes to lie there");
    return source ?? null;
  }
}
