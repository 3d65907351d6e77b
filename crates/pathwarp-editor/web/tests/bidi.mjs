// Firefox by WebDriver BiDi, as far as the test needs it. Playwright asks for commands that Debian's Firefox does not have yet.
import { spawn } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import WebSocket from "ws";

/** Starts Firefox without a window and opens an address. */
export async function firefox(program, address) {
  const profile = mkdtempSync(join(tmpdir(), "pathwarp-firefox-"));
  const child = spawn(program, ["--headless", "--no-remote", "--profile", profile, "--remote-debugging-port=0", "about:blank"], { stdio: ["ignore", "ignore", "pipe"] });
  process.once("exit", () => child.kill("SIGKILL"));
  const endpoint = await new Promise((resolve, reject) => {
    let said = "";
    child.stderr.on("data", (text) => {
      said += text;
      const found = /WebDriver BiDi listening on (ws:\S+)/.exec(said);
      if (found) resolve(found[1]);
    });
    child.once("exit", (code) => reject(new Error(`Firefox ended with ${code}: ${said}`)));
  });
  const socket = new WebSocket(`${endpoint}/session`);
  await new Promise((resolve, reject) => socket.once("open", resolve).once("error", reject));
  const waiting = new Map();
  const problems = [];
  socket.on("message", (text) => {
    const message = JSON.parse(text);
    if (message.method === "log.entryAdded" && message.params.level === "error") problems.push(message.params.text);
    const { resolve, reject } = waiting.get(message.id) ?? {};
    if (message.type === "success") resolve?.(message.result);
    else if (message.type === "error") reject?.(new Error(`${message.error}: ${message.message}`));
  });
  let next = 1;
  const send = (method, params = {}) => new Promise((resolve, reject) => {
    const id = next++;
    waiting.set(id, { resolve, reject });
    socket.send(JSON.stringify({ id, method, params }));
  });
  await send("session.new", { capabilities: {} });
  await send("session.subscribe", { events: ["log.entryAdded"] });
  const { contexts } = await send("browsingContext.getTree");
  const { context } = contexts[0];
  await send("browsingContext.setViewport", { context, viewport: { width: 1280, height: 800 } });
  await send("browsingContext.navigate", { context, url: address, wait: "complete" });

  /** The value of an expression in the page: text, a number or an array of them. */
  async function evaluate(expression) {
    const { result, exceptionDetails } = await send("script.evaluate", { expression: `(async () => JSON.stringify(${expression}))()`, target: { context }, awaitPromise: true });
    if (exceptionDetails) throw new Error(exceptionDetails.text);
    return JSON.parse(result.value ?? "null");
  }
  /** Waits until an expression is true. */
  async function until(expression, what) {
    for (let i = 0; i < 100; i++) {
      if (await evaluate(expression)) return;
      await new Promise((done) => setTimeout(done, 100));
    }
    throw new Error(what);
  }
  const middle = (selector) => evaluate(`(() => { const b = document.querySelector(${JSON.stringify(selector)}).getBoundingClientRect(); return [Math.round(b.x + b.width / 2), Math.round(b.y + b.height / 2)]; })()`);
  const perform = (type, id, actions) => send("input.performActions", { context, actions: [{ type, id, actions }] });
  /** Drags an element with a mouse. */
  async function drag(selector, dx, dy) {
    const [x, y] = await middle(selector);
    const move = (to) => ({ type: "pointerMove", x: Math.round(x + dx * to), y: Math.round(y + dy * to), duration: 20 });
    const way = Array.from({ length: 9 }, (_, i) => move(i / 8));
    await perform("pointer", "mouse", [way[0], { type: "pointerDown", button: 0 }, ...way, { type: "pointerUp", button: 0 }]);
  }
  const click = (selector) => drag(selector, 0, 0);
  /** Presses a key with Ctrl. */
  const control = (key) => perform("key", "keyboard", [
    { type: "keyDown", value: "\uE009" }, { type: "keyDown", value: key }, { type: "keyUp", value: key }, { type: "keyUp", value: "\uE009" },
  ]);
  const stop = async () => {
    socket.close();
    child.kill("SIGKILL");
    await new Promise((done) => child.once("close", done));
    rmSync(profile, { recursive: true, force: true, maxRetries: 5 });
  };
  return { evaluate, until, drag, click, control, problems, stop };
}
