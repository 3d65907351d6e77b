// Mouse, pen and touch on the canvas: they drag handles and lines, move the view, and magnify it.

import type { App } from "./app";
import type { Modes } from "./modes";
import { REACH, type Stage } from "./stage";
import { groupMover, type Part } from "./selection";
import { hush } from "./toast";
import type { XY } from "./types";

/** The event for moves of a pointer, immediate if possible: `pointermove` comes with the next frame, and its answer a frame later. */
const MOVES = "onpointerrawupdate" in window ? "pointerrawupdate" : "pointermove";
/** The distance within which a handle snaps to a line, in px. */
const SNAP = 7;
/** The distance within which a press counts as a click, in px. */
const CLICK_DISTANCE = 3;
/** The least distance of a wheel's notch, in px; a trackpad reports less at a time. */
const NOTCH = 50;
/** Exponents of the magnification per px, for a trackpad's pinch and for a wheel. */
const PINCH_RATE = 0.01;
const WHEEL_RATE = 0.002;

/** Reactions to a pointer that is down. */
interface Reactions {
  move: (to: XY, e: PointerEvent) => void;
  end: () => void;
  /** Reacts to Escape, or to an undo. */
  cancel?: () => void;
}

export class Pointing {
  /** The pointers that are down, with their positions. */
  private down = new Map<number, XY>();
  /** Ends the action of the first pointer. */
  private finish: (() => void) | null = null;
  /** Called if the view was moved by a drag that began on the artwork. */
  onPan: () => void = () => {};

  constructor(private app: App, private stage: Stage, private modes: Modes) {
    stage.svg.addEventListener("wheel", (e) => this.wheel(e), { passive: false });
    stage.svg.addEventListener("pointerdown", (e) => this.press(e));
    // Browsers may delay a finger's last raw move until it is lifted.
    for (const moves of new Set([MOVES, "pointermove"])) {
      window.addEventListener(moves, (e) => {
        const { pointerId } = e as PointerEvent;
        if (this.down.has(pointerId)) this.down.set(pointerId, stage.point(e as PointerEvent));
      });
    }
    app.listen(["link"], () => {
      if (!app.isLive) this.finish?.();
    });
    for (const end of ["pointerup", "pointercancel"] as const) window.addEventListener(end, (e) => this.down.delete(e.pointerId));
  }

  private wheel(e: WheelEvent): void {
    e.preventDefault();
    const { stage } = this;
    // A trackpad reports a pinch as a wheel with Ctrl.
    const isPinch = e.ctrlKey && Math.abs(e.deltaY) < NOTCH;
    if (e.ctrlKey || e.metaKey || (e.deltaX === 0 && Math.abs(e.deltaY) >= NOTCH)) {
      return stage.zoom(Math.exp(-e.deltaY * (isPinch ? PINCH_RATE : WHEEL_RATE)), stage.point(e));
    }
    stage.shift([-e.deltaX, -e.deltaY]);
  }

  private press(e: PointerEvent): void {
    const { stage } = this;
    const target = e.target as Element;
    // `onPick` is set while a path is asked for, `isBefore` while no steps are shown.
    if (stage.onPick) return stage.pickAt(e);
    this.down.set(e.pointerId, stage.point(e));
    if (this.down.size > 2) return;
    if (this.down.size === 2) {
      this.finish?.();
      return this.pinch();
    }
    const bends = e.button === 0 && !stage.isBefore;
    const knob = target.closest<SVGGElement>(".knob");
    const part = target.closest<SVGGElement>(".part")?.dataset.part as Part | undefined;
    if (knob && bends) this.drag(e, knob);
    else if (this.modes.picksParts && bends) this.pan(e, () => stage.pickPartAt(e));
    else if (part && bends) this.transform(e, stage.selection.transform(part, stage.point(e)));
    else if (bends && !e.shiftKey && stage.selection.holds(stage.point(e))) this.transform(e, translation(stage.point(e)), () => stage.select([]));
    else if (bends && (e.shiftKey || stage.isSelecting)) this.frame(e);
    else if (!(bends && target.matches(".pull") && this.pull(e))) this.pan(e, () => stage.select([]));
  }

  /** Follows a pointer until it is lifted, Escape is pressed, or a second finger touches. Returns a function that cancels the action. */
  private follow(e: PointerEvent, { move, end, cancel = end }: Reactions): () => void {
    const stop = new AbortController();
    const finish = (react: () => void) => {
      stop.abort();
      this.finish = null;
      react();
    };
    this.finish = () => finish(end);
    const onThisPointer = (action: (event: PointerEvent) => void) => (event: Event) => {
      if ((event as PointerEvent).pointerId === e.pointerId) action(event as PointerEvent);
    };
    window.addEventListener(MOVES, onThisPointer((event) => move(this.stage.point(event), event)), stop);
    for (const lifted of ["pointerup", "pointercancel"]) window.addEventListener(lifted, onThisPointer(() => finish(end)), stop);
    window.addEventListener("keydown", (event) => {
      if (event.key === "Escape") finish(cancel);
    }, stop);
    return () => finish(cancel);
  }

  /** Follows a pointer that changes the step by `move`; `done` cleans up, and `clicked` reacts to a press without a move. */
  private bend(e: PointerEvent, move: (to: XY, e: PointerEvent) => void, done: () => void, clicked: () => void = () => {}): void {
    const { app } = this;
    const start = this.stage.point(e);
    hush();
    // Commit changes by keys first. An undo during the drag calls `cancelGesture`.
    void app.flush();
    const step = app.step!;
    const before = structuredClone(step);
    let hasMoved = false;
    app.isDragging = true;
    const stop = () => {
      app.isDragging = false;
      app.cancelGesture = null;
      this.stage.showValue(null);
      done();
    };
    app.cancelGesture = this.follow(e, {
      move: (to, event) => {
        // Small moves still count as a click.
        hasMoved ||= Math.hypot(to[0] - start[0], to[1] - start[1]) >= CLICK_DISTANCE;
        if (hasMoved) move(to, event);
      },
      end: () => {
        stop();
        if (hasMoved) void app.commit();
        else clicked();
      },
      cancel: () => {
        stop();
        if (hasMoved) app.cancel(step, before);
      },
    });
  }

  private drag(e: PointerEvent, knob: SVGGElement): void {
    const { stage, modes } = this;
    const { handles } = this.app;
    const handle = stage.handle(knob.dataset.key ?? null);
    if (!handle || !handles) return;
    e.preventDefault();
    // Focus selects this handle alone, unless it is selected already.
    const before = new Set(stage.selection.keys);
    knob.focus({ preventScroll: true });
    if (e.shiftKey) stage.selection.keys = before;
    const [x, y] = stage.point(e);
    const several = stage.selectedWith(handle);
    const adds = e.shiftKey;
    const clicked = () => {
      if (adds) stage.selection.toggle(handle.key);
      stage.select(adds ? Array.from(stage.selection.keys) : [handle.key]);
    };
    if (several && !adds) return this.transform(e, translation([x, y]), clicked);
    const grabbed = stage.camera.toScreen(handle.get());
    const mover = modes.mover(handles, handle);
    knob.classList.add("held");
    this.bend(e, (to, event) => {
      const target = stage.camera.toUser([grabbed[0] + to[0] - x, grabbed[1] + to[1] - y]);
      mover(modes.snapped(target, handle, handles, SNAP * stage.camera.pixel, event), event);
      stage.writeHandle(handle, event.timeStamp);
    }, () => {
      knob.classList.remove("held");
      modes.clear();
      stage.placeHandles();
    }, clicked);
  }

  /** Moves, rotates or scales the selected points with the pointer. */
  private transform(e: PointerEvent, image: (to: XY) => (p: XY) => XY, clicked: () => void = () => {}): void {
    const { stage, modes } = this;
    const { handles } = this.app;
    if (!handles) return;
    const { camera } = stage;
    const mover = groupMover(handles, stage.selection.selectedOf(handles), modes);
    e.preventDefault();
    this.bend(e, (to, event) => {
      const map = image(to);
      stage.writeParams(mover((p) => camera.toUser(map(camera.toScreen(p)))), event.timeStamp);
    }, () => stage.placeHandles(), clicked);
  }

  /** Draws a frame, and selects the points within. */
  private frame(e: PointerEvent): void {
    const { stage } = this;
    const start = stage.point(e);
    const before = e.shiftKey ? Array.from(stage.selection.keys) : [];
    let last = start;
    const hide = () => stage.marquee.setAttribute("visibility", "hidden");
    e.preventDefault();
    this.follow(e, {
      move: (to) => {
        last = to;
        const sides = { x: Math.min(start[0], to[0]), y: Math.min(start[1], to[1]), width: Math.abs(to[0] - start[0]), height: Math.abs(to[1] - start[1]), visibility: "visible" };
        for (const [name, value] of Object.entries(sides)) stage.marquee.setAttribute(name, String(value));
      },
      end: () => {
        hide();
        stage.select(Array.from(new Set([...before, ...stage.keysInFrame(start, last)])));
      },
      cancel: hide,
    });
  }

  /** Follows a line that is dragged. Returns `false` if there is none. */
  private pull(e: PointerEvent): boolean {
    const { stage, modes } = this;
    const { handles } = this.app;
    const pull = handles?.pull(stage.camera.toUser(stage.point(e)), REACH * stage.camera.pixel);
    if (!handles || !pull) return false;
    const [x, y] = stage.point(e);
    // A line whose points are selected moves with the selection.
    if (pull.ends.length > 1 && pull.ends.every((key) => stage.selection.keys.has(key))) {
      this.transform(e, translation([x, y]));
      return true;
    }
    const puller = modes.puller(handles, pull);
    this.bend(e, (to, event) => {
      puller(stage.camera.toUser(to));
      handles.write(pull.param);
      stage.placeHandles();
      this.app.tell("values");
      this.app.draft(event.timeStamp);
    }, () => {}, () => stage.select(pull.ends));
    return true;
  }

  /** Moves the view; a press without a move calls `clicked` instead. */
  private pan(e: PointerEvent, clicked: () => void): void {
    const { stage } = this;
    const first = stage.point(e);
    let last = first;
    const start = stage.camera.toUser(first);
    stage.svg.classList.add("panning");
    this.follow(e, {
      move: (to) => {
        stage.shift([to[0] - last[0], to[1] - last[1]]);
        last = to;
      },
      end: () => {
        stage.svg.classList.remove("panning");
        const [x, y, w, h] = this.app.handles?.frame ?? [0, 0, 0, 0];
        const distance = Math.hypot(last[0] - first[0], last[1] - first[1]);
        // The first of two fingers does not click.
        if (distance < CLICK_DISTANCE && this.down.size < 2) clicked();
        // Clear moves that began on the artwork call for a hint.
        const isOnArtwork = start[0] > x && start[0] < x + w && start[1] > y && start[1] < y + h;
        if (isOnArtwork && distance > REACH / 4) this.onPan();
      },
    });
  }

  /** Moves and magnifies the view by two fingers. */
  private pinch(): void {
    const [one, two] = Array.from(this.down.keys());
    const stop = new AbortController();
    const middleAndDistance = (): [XY, number] => {
      const [a, b] = [this.down.get(one!)!, this.down.get(two!)!];
      return [[(a[0] + b[0]) / 2, (a[1] + b[1]) / 2], Math.hypot(a[0] - b[0], a[1] - b[1])];
    };
    let [from, distance] = middleAndDistance();
    window.addEventListener("pointermove", () => {
      const [to, newDistance] = middleAndDistance();
      if (distance > 0) this.stage.zoom(newDistance / distance, from);
      this.stage.shift([to[0] - from[0], to[1] - from[1]]);
      [from, distance] = [to, newDistance];
    }, stop);
    for (const lifted of ["pointerup", "pointercancel"]) window.addEventListener(lifted, () => stop.abort(), stop);
  }
}

/** Returns the translations of points along with a pointer that pressed at a point. */
const translation = ([x, y]: XY) => (to: XY) => ([px, py]: XY): XY => [px + to[0] - x, py + to[1] - y];
