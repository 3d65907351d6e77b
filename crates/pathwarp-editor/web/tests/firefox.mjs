#!/usr/bin/env node
// Firefox as Playwright starts it. Playwright asks for commands of WebDriver BiDi that Debian's Firefox does not have yet: this program
// runs Firefox with its own arguments, stands between both, and answers those itself.
import { spawn } from "node:child_process";
import { existsSync } from "node:fs";
import { WebSocket, WebSocketServer } from "ws";

/** None of the tests that run in Firefox depends on what these set. */
const LACKING = ["emulation.setMediaFeaturesOverride"];

/** Milliseconds. A second click within that time makes a double click. */
const HELD = 1000;

const program = ["/usr/bin/firefox-esr", "/usr/bin/firefox"].find((p) => existsSync(p));
const firefox = spawn(program, process.argv.slice(2), { stdio: ["ignore", "ignore", "pipe"] });
process.once("SIGTERM", () => process.exit());
process.once("exit", () => firefox.kill("SIGKILL"));
firefox.once("exit", (code) => process.exit(code ?? 1));

let said = "";
firefox.stderr.on("data", function hear(text) {
  said += text;
  const [, address] = /BiDi listening on (ws:\S+)/.exec(said) ?? [];
  if (!address) return;
  firefox.stderr.off("data", hear).resume();
  stand(address);
});

/**
 * Passes messages between Playwright and Firefox, which listens at this address. Firefox counts clicks only within one message, while
 * Playwright presses and releases a button in two: these are held for a moment, and sent as one.
 */
function stand(address) {
  const server = new WebSocketServer({ host: "127.0.0.1", port: 0 });
  server.once("listening", () => console.error(`WebDriver BiDi listening on ws://127.0.0.1:${server.address().port}`));
  server.on("connection", (playwright, { url }) => {
    const to = new WebSocket(address + url);
    let turn = new Promise((resolve) => to.once("open", resolve));
    let held, timer, answered;
    const take = async (text) => {
      const { id, method, params } = JSON.parse(text);
      const answer = () => playwright.send(JSON.stringify({ type: "success", id, result: {} }));
      if (LACKING.includes(method)) return answer();
      const [action] = method === "input.performActions" ? params.actions[0].actions : [];
      if (action?.type !== "pointerDown" && action?.type !== "pointerUp") {
        await release();
        return to.send(text);
      }
      if (held) held.params.actions[0].actions.push(action);
      else held = { id, method, params };
      clearTimeout(timer);
      // A button that is held goes on with the next message, whatever that is.
      if (action.type === "pointerUp") timer = setTimeout(() => (turn = turn.then(release)), HELD);
      answer();
    };
    /** Lets Firefox do what is held. */
    const release = async () => {
      clearTimeout(timer);
      if (!held) return;
      to.send(JSON.stringify(held));
      await new Promise((resolve) => (answered = resolve));
      held = undefined;
    };
    playwright.on("message", (text) => (turn = turn.then(() => take(String(text)))));
    to.on("message", (text) => {
      // Playwright has that answer already.
      if (answered && JSON.parse(text).id === held.id) answered = void answered();
      else playwright.send(String(text));
    });
    to.once("close", () => playwright.close());
    playwright.once("close", () => to.close());
  });
}
