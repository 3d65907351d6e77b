// Runs `pathwarp edit` and a headless browser for the tests: Chromium, or Firefox where TESTED_IN=firefox.
import { spawn } from "node:child_process";
import { existsSync, mkdtempSync, copyFileSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { createServer } from "node:net";
import { tmpdir } from "node:os";
import { join, basename } from "node:path";
import { fileURLToPath } from "node:url";
import { chromium, firefox } from "playwright-core";

export const root = fileURLToPath(new URL("../../../../", import.meta.url));
export const program = process.env.PATHWARP ?? join(root, "target/debug/pathwarp");
// Without windows to draw, the shell takes half the processor time of the whole browser.
const browserPath = ["/usr/bin/chromium-headless-shell", "/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"].find((p) => existsSync(p));
const FLAGS = [
  "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
  "--disable-component-update", "--disable-sync",
  // A page that is swapped in counts as one from elsewhere.
  ...(process.env.ASSETS ? ["--disable-features=LocalNetworkAccessChecks"] : []),
];

/** The last resort, in ms: what has not happened by then never will, however busy a machine is. */
const LAST_RESORT = 1000000;

/** Waits for a promise that a hang would never keep. */
export const awaited = (promise, what) => Promise.race([promise, new Promise((_, fail) => setTimeout(() => fail(new Error(`${what}: never`)), LAST_RESORT))]);

/** A program in a folder that stands in for the browser, and a promise of the address that it is asked to open. */
export function standIn(dir) {
  const [path, socket] = [join(dir, "browser"), join(dir, "socket")];
  writeFileSync(path, `#!${process.execPath}\nrequire("net").connect("${socket}").end(process.argv[2]);\n`, { mode: 0o755 });
  const server = createServer().listen(socket).unref();
  return { path, opened: new Promise((resolve) => server.once("connection", (c) => c.once("data", (text) => resolve(String(text))))) };
}

const temporary = [];

/** A new empty folder, which is removed when the tests have ended. */
export function emptyFolder() {
  const dir = mkdtempSync(join(tmpdir(), "pathwarp-editor-"));
  temporary.push(dir);
  return dir;
}

/** A new folder with copies of files, or with a text as a file. */
export function folder(files) {
  const dir = emptyFolder();
  for (const [name, from] of Object.entries(files)) {
    if (from.startsWith("/")) copyFileSync(from, join(dir, name));
    else writeFileSync(join(dir, name), from);
  }
  return dir;
}

/** An expression for the page: what axe-core finds wrong with it, one line each. */
export const AXE = `(async () => {
  ${readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8")};
  const { violations } = await axe.run(document);
  return violations.flatMap(({ id, nodes }) => nodes.map((n) => id + ": " + n.html.slice(0, 160) + " " + (n.any[0]?.message ?? "")));
})()`;

export const sample = (name) => join(root, "samples", name);

/** Folders for settings and state, so that the user's own stay out of the tests. */
export const OWN = { XDG_CONFIG_HOME: emptyFolder(), XDG_STATE_HOME: emptyFolder() };

// One listener for every program that is started.
process.setMaxListeners(0);
process.once("exit", () => temporary.forEach((dir) => rmSync(dir, { recursive: true, force: true, maxRetries: 5 })));

/** Starts the editor on a file. */
export const edit = (file, ...args) => editWith({}, file, ...args);

/** Starts the editor on a file with these variables, as the user `uid` if there is one. */
export async function editWith({ uid, as = program, ...variables }, file, ...args) {
  const child = spawn(as, ["edit", basename(file), "--no-open", ...args], {
    cwd: join(file, ".."), stdio: ["ignore", "pipe", "pipe"], env: { ...process.env, ...OWN, ...variables }, uid,
  });
  // A test that fails leaves no program behind.
  process.once("exit", () => child.kill("SIGKILL"));
  let errors = "";
  child.stderr.on("data", (text) => (errors += text));
  const address = await new Promise((resolve, reject) => {
    child.stdout.once("data", (text) => resolve(String(text).split("\n")[0]));
    child.once("exit", (code) => reject(new Error(`edit ended with ${code}: ${errors}`)));
  });
  const ended = new Promise((resolve) => child.once("exit", (code, signal) => resolve(code ?? signal)));
  /** Ends the program; its port is free when the promise is kept. */
  const stop = () => {
    child.kill("SIGKILL");
    return ended;
  };
  return { address, child, ended, stop };
}

let browser;
const launch = () => process.env.TESTED_IN === "firefox"
  ? firefox.launch({ channel: "moz-firefox", executablePath: fileURLToPath(new URL("firefox.mjs", import.meta.url)), headless: true })
  : chromium.launch({ executablePath: browserPath, headless: true, args: FLAGS });

/** Opens a page; anything that goes wrong in it is an error of the test. */
export async function open(address, options = {}) {
  browser ??= launch();
  const context = await (await browser).newContext({ viewport: { width: 1280, height: 800 }, ...options });
  context.setDefaultTimeout(LAST_RESORT);
  const page = await context.newPage();
  page.problems = [];
  page.requests = [];
  page.on("pageerror", (e) => page.problems.push(String(e)));
  page.on("console", (m) => {
    if (m.type() === "error" && !/WebSocket|ERR_CONNECTION/.test(m.text())) page.problems.push(m.text());
  });
  page.on("request", (r) => page.requests.push(r.url()));
  // ASSETS=FOLDER, usually ../assets, tries a page that is not built into the program yet.
  for (const name of process.env.ASSETS ? ["editor.js", "editor.css"] : []) {
    await page.route(`**/${name}`, (route) => route.fulfill({ path: join(process.env.ASSETS, name) }));
  }
  if (process.env.ASSETS) {
    await page.route((url) => url.pathname === "/", (route) => route.fulfill({ path: join(process.env.ASSETS, "index.html") }));
  }
  await page.goto(address);
  await page.waitForSelector("#stage .art *", { state: "attached" });
  return page;
}

export async function close() {
  await (await browser)?.close();
  browser = undefined;
}

/** Keeps a picture of the page in the folder SHOTS, if there is one. */
export async function keep(page, name) {
  if (!process.env.SHOTS) return;
  const { length } = page.problems;
  await page.screenshot({ path: join(process.env.SHOTS, `${name}.png`) });
  // For a picture, Playwright sets a style, and Firefox says that the page does not allow it.
  page.problems.length = length;
}

/** The middle of a handle on the screen. */
export async function middle(page, key) {
  return page.evaluate((k) => {
    const box = document.querySelector(`.knob[data-key="${k}"] .body`).getBoundingClientRect();
    return [box.x + box.width / 2, box.y + box.height / 2];
  }, key);
}

/** The handles of the page, by key. */
export const keys = (page) => page.$$eval(".knob", (all) => all.map((k) => k.dataset.key));

/** Waits until the page holds no handle and asks the server nothing in so many frames, one after the other. */
export const quiet = (page, frames = 6) => page.evaluate((frames) => new Promise((done) => {
  let still = 0;
  const look = () => {
    const isBusy = document.querySelector(".knob.held") || document.querySelector("#view").getAttribute("aria-busy") === "true";
    still = isBusy ? 0 : still + 1;
    if (still > frames) done();
    else requestAnimationFrame(look);
  };
  look();
}), frames);

/** Does something within what the page takes for a moment, however long it takes: keys that follow each other. */
export async function withoutPause(page, act) {
  await page.evaluate(() => {
    const { setTimeout, clearTimeout } = window;
    const waiting = new Map();
    let last = 1e9;
    window.setTimeout = (then) => (waiting.set(++last, then), last);
    window.clearTimeout = (id) => waiting.delete(id) || clearTimeout(id);
    window.goOn = () => {
      Object.assign(window, { setTimeout, clearTimeout });
      waiting.forEach((then) => then());
    };
  });
  await act();
  await page.evaluate(() => window.goOn());
  await quiet(page);
}

/** Waits until the picture is another than this one. */
export const changes = (page, picture) => page.waitForFunction((was) => Array.from(document.querySelectorAll("#stage .art:not([visibility=hidden]) path"), (p) => p.getAttribute("d")).join("|") !== was, picture);

/** Waits until something in the page has another text than this one. */
export const turns = (page, selector, text) => page.waitForFunction(([s, was]) => document.querySelector(s).textContent !== was, [selector, text]);

/** Drags a handle by so many px, in steps. */
export async function drag(page, key, dx, dy, steps = 12) {
  const [x, y] = await middle(page, key);
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + dx, y + dy, { steps });
  await page.mouse.up();
  await quiet(page);
}

/** All path data of the drawing. */
export const paths = (page) => page.$$eval("#stage .art:not([visibility=hidden]) path", (all) => all.map((p) => p.getAttribute("d")).join("|"));

/** Chooses a shape by its name. */
export async function choose(page, name, section = "") {
  const within = page.locator("#gallery section", { hasText: section });
  await within.locator(".card", { hasText: new RegExp(`^${name.replace(/[()]/g, "\\$&")}$`) }).first().click();
  await quiet(page);
}

/** Waits until the picture is this one. */
export const becomes = (page, picture, message) => page.waitForFunction((wanted) => Array.from(document.querySelectorAll("#stage .art:not([visibility=hidden]) path"), (p) => p.getAttribute("d")).join("|") === wanted, picture)
  .catch((e) => { throw new Error(`${message}: ${e.message}`); });

/** What the step of a card is called: a shape by name is a closed shape that any path may be. */
export const stepOf = (card) => (card.endsWith(" shape") ? "Closed shape" : card);

export function check(condition, message) {
  if (!condition) throw new Error(message);
}

/** A drawing of curves: `count` segments in paths of fifty. */
export function curves(count) {
  const out = [];
  for (let k = 0; k * 50 < count; k++) {
    const [x, y] = [(k % 20) * 40, Math.floor(k / 20) * 40];
    let d = `M${x + 38},${y + 20}`;
    for (let i = 1; i <= 50; i++) {
      const at = (j, r) => `${(x + 20 + r * Math.cos((2 * Math.PI * j) / 50)).toFixed(2)},${(y + 20 + r * Math.sin((2 * Math.PI * j) / 50)).toFixed(2)}`;
      d += ` C${at(i - 0.7, 16)} ${at(i - 0.3, 20)} ${at(i, 18)}`;
    }
    out.push(`<path d="${d}Z" fill="hsl(${(k * 37) % 360} 60% 50%)"/>`);
  }
  return `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 800 400">${out.join("")}</svg>`;
}
