// Nothing is lost: drafts of several drawings, typed values, the end of the program and its return, folders that cannot be written.
import { createServer } from "node:http";
import { chmodSync, copyFileSync, existsSync, readFileSync, readdirSync, rmSync, statSync } from "node:fs";
import { awaited, becomes, check, choose, drag, editWith, emptyFolder, folder, open, paths, program, quiet, sample } from "./harness.mjs";

/** Runs a test on a logo, with a folder for state of its own. `start` starts the program again. */
async function within(test, variables = {}, isReadOnly = false) {
  const dir = folder({ "logo.svg": sample("logo.svg") });
  const state = emptyFolder();
  if (isReadOnly) {
    chmodSync(dir, 0o555);
    chmodSync(state, 0o777);
  }
  let editor;
  const start = async () => (editor = await editWith({ XDG_STATE_HOME: state, ...variables }, `${dir}/logo.svg`));
  await start();
  const page = await open(editor.address);
  try {
    await test({ dir, state, page, start, editor });
    check(page.problems.length === 0, page.problems.join("; "));
  } finally {
    await editor.stop();
    chmodSync(dir, 0o755);
    await page.context().close();
  }
}

const typed = (dir, name = "logo-bent.svg") => /bend = "([^"]*)"/.exec(readFileSync(`${dir}/${name}`, "utf8"))?.[1];
const stepNames = (page) => page.locator("#steps li").allTextContents();
/** Opens a drawing as by *Open…*. */
async function openFile(page, name) {
  await page.setInputFiles("#open-file", { name, mimeType: "image/svg+xml", buffer: readFileSync(sample("badge.svg")) });
  await page.waitForFunction((file) => document.querySelector("#file").textContent === file, name);
  await quiet(page);
}

export const drawings_have_their_own_drafts = () => within(async ({ dir, page, start, editor }) => {
  await choose(page, "Flag");
  const flag = await paths(page);
  await openFile(page, "other.svg");
  await choose(page, "Arc");
  const arc = await paths(page);
  await editor.stop();
  await start();
  // The page finds the program again by itself.
  await page.waitForSelector("#gone", { state: "hidden" });
  await becomes(page, flag, "the drawing is not there with its flag");
  await page.waitForFunction(() => document.querySelector("#file").textContent === "logo.svg");
  await openFile(page, "other.svg");
  await becomes(page, arc, "the other drawing has lost its step");
  await page.keyboard.press("Control+s");
  await page.waitForSelector("#toast.on:has-text('Saved other-bent.svg')");
  check(readdirSync(dir).sort().join() === "logo.svg,other-bent.svg", readdirSync(dir).join());
  await page.click("#save-as");
  await page.fill("#save-name", "logo.svg");
  await page.keyboard.press("Enter");
  await page.waitForFunction(() => document.querySelector("#save-message").textContent.includes("open first"));
});

/** With real keys, while the field has the focus. */
export const typed_values_are_saved = () => within(async ({ dir, page }) => {
  await choose(page, "Flag");
  const type = async (text, keys) => {
    await page.locator("#set-bend").fill("");
    await page.locator("#set-bend").focus();
    await page.keyboard.type(text);
    await page.keyboard.press(keys);
  };
  await type("33%", "Control+s");
  await page.waitForSelector("#toast.on");
  check(typed(dir) === "33%", `saved ${typed(dir)}`);
  check(await page.$eval("#set-bend", (field) => document.activeElement === field), "the field has lost the focus");
  await type("44%", "Control+Shift+S");
  await page.fill("#save-name", "second");
  await page.keyboard.press("Control+s");
  await page.waitForFunction(() => !document.querySelector("#save-dialog").open);
  check(typed(dir, "second.svg") === "44%", `saved ${typed(dir, "second.svg")}`);
  // What is refused is said, and the old value is not saved in its stead.
  rmSync(`${dir}/second.svg`);
  await type("round", "Control+s");
  await page.waitForFunction(() => document.querySelector("#set-bend-wrong").textContent.startsWith("A number"));
  await quiet(page);
  check(!existsSync(`${dir}/second.svg`), "another value than the typed one was saved");
  check((await page.inputValue("#set-bend")) === "round", "what is wrong is no longer in the field");
  // Buttons that are pressed without a pointer, as by assistive programs.
  await type("55%", "End");
  await page.$eval("#undo", (button) => button.click());
  await quiet(page);
  await page.$eval("#redo", (button) => button.click());
  await quiet(page);
  await page.click("#save");
  await page.waitForFunction(() => document.querySelector("#saved").textContent.startsWith("Saved"));
  check(typed(dir, "second.svg") === "55%", `saved ${typed(dir, "second.svg")}`);
  await type("66%", "End");
  await page.reload();
  await page.waitForSelector("#set-bend");
  await quiet(page);
  check((await page.inputValue("#set-bend")) === "66", "leaving the page loses what is typed");
});

export const without_the_program_nothing_changes = () => within(async ({ dir, page, start, editor }) => {
  await choose(page, "Flag");
  await page.click("#save-as");
  await editor.stop();
  await page.waitForSelector("#gone:not([hidden])");
  const said = await page.textContent("#gone");
  check(said.includes(`here, run “pathwarp edit ${dir}/logo.svg”`) && said.includes("are kept"), said);
  check(!(await page.$eval("#save-dialog", (d) => d.open)), "a dialog is left open");
  const before = [await paths(page), (await stepNames(page)).join()];
  await page.mouse.click(120, 300);
  await page.keyboard.press("Tab");
  check(await page.evaluate(() => document.activeElement === document.body), "something takes the focus");
  for (const keys of ["Control+s", "Control+z", "ArrowRight", "Enter", "b"]) await page.keyboard.press(keys);
  const [x, y] = await page.$eval(".knob .body", (knob) => { const b = knob.getBoundingClientRect(); return [b.x + b.width / 2, b.y + b.height / 2]; });
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 40, y + 40, { steps: 5 });
  await page.mouse.up();
  await page.evaluate(() => {
    const data = new DataTransfer();
    data.items.add(new File(["<svg/>"], "dropped.svg"));
    document.dispatchEvent(new DragEvent("drop", { dataTransfer: data, bubbles: true, cancelable: true }));
  });
  await quiet(page, 20);
  check([await paths(page), (await stepNames(page)).join()].join() === before.join(), "the page has changed");
  const again = await start();
  check(again.address === editor.address, `${again.address} is not ${editor.address}`);
  await page.waitForSelector("#gone", { state: "hidden" });
  await quiet(page);
  check((await paths(page)) === before[0] && page.url() === again.address, page.url());
  await choose(page, "Arc");
  check((await paths(page)) !== before[0], "the page takes no changes again");
});

/** A drag that was under way when the program ended does not go on afterwards. */
export const a_drag_ends_with_the_program = () => within(async ({ page, start, editor }) => {
  const before = await paths(page);
  const [x, y] = await page.$eval('.knob[data-key="shaper/0.0/2"] .body', (knob) => { const b = knob.getBoundingClientRect(); return [b.x + b.width / 2, b.y + b.height / 2]; });
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 20, y + 20, { steps: 5 });
  await editor.stop();
  await page.waitForSelector("#gone:not([hidden])");
  await start();
  await page.waitForSelector("#gone", { state: "hidden" });
  await page.mouse.move(x + 80, y + 80, { steps: 5 });
  await quiet(page);
  check((await paths(page)) === before, "the drag goes on");
  await page.mouse.up();
  await drag(page, "shaper/0.0/2", 20, 30);
  check((await paths(page)) !== before, "nothing can be dragged any more");
});

/** Another program at the port of one that has ended learns nothing, and gets no page; the next run has another token. */
export const strangers_at_the_port_learn_no_token = () => within(async ({ page, start, editor }) => {
  const { port, searchParams } = new URL(editor.address);
  const token = searchParams.get("token");
  await editor.stop();
  await page.waitForSelector("#gone:not([hidden])");
  const asked = [];
  // Once it has looked for the program three times, it would have told its token.
  let enough;
  const looked = new Promise((resolve) => (enough = resolve));
  const stranger = createServer((request, answer) => {
    asked.push(`${request.url} ${JSON.stringify(request.headers)}`);
    if (asked.length > 2) enough();
    answer.end("0".repeat(64));
  });
  stranger.on("upgrade", (request, socket) => {
    asked.push(request.url);
    socket.destroy();
  });
  await new Promise((done) => stranger.listen(Number(port), "127.0.0.1", done));
  try {
    await awaited(looked, "the page looks for the program");
    check(asked.every((a) => !a.includes(token)), asked.join("\n"));
    check(await page.isVisible("#gone"), "the page takes a stranger for the program");
    const again = new URL((await start()).address);
    check(again.port !== port && again.searchParams.get("token") !== token, String(again));
  } finally {
    stranger.close();
    stranger.closeAllConnections();
  }
});

/** Nobody in particular, who may write nothing of root's. */
const NOBODY = 65534;

/** A program for a user who must not write everywhere: of root's, a copy that anybody may run. */
function restricted() {
  if (process.getuid?.() !== 0) return {};
  const dir = emptyFolder();
  chmodSync(dir, 0o755);
  copyFileSync(program, `${dir}/pathwarp`);
  return { uid: NOBODY, as: `${dir}/pathwarp` };
}

/** The user may not write beside the drawing. */
export const where_nothing_can_be_written_it_is_downloaded = () => within(async ({ dir, page }) => {
  await choose(page, "Flag");
  await page.keyboard.press("Control+s");
  await page.waitForSelector("#save-dialog[open]");
  const said = await page.textContent("#save-message");
  check(/logo-bent.svg: cannot be written: Permission denied.*Download/.test(said), said);
  for (const [format, start] of [["svg", "<svg"], ["pdf", "%PDF"]]) {
    if (format !== "svg") {
      await page.click("#save-as");
      await page.check(`input[value=${format}]`);
      await page.click("#save-dialog button[type=submit]");
      await page.waitForSelector("#save-dialog[open] #save-download");
    }
    const [download] = await Promise.all([page.waitForEvent("download"), page.click("#save-download")]);
    check(download.suggestedFilename() === `logo-bent.${format}`, download.suggestedFilename());
    const bytes = readFileSync(await download.path(), "latin1");
    check(bytes.startsWith(start) && (format !== "svg" || bytes.includes('style = "flag"')), bytes.slice(0, 40));
  }
  check((await page.textContent("#saved")) === "Downloaded", await page.textContent("#saved"));
}, restricted(), true);

/** Where no draft can be written, leaving asks until everything is saved. */
export const leaving_asks_where_nothing_is_kept = () => within(async ({ page }) => {
  let asked = 0;
  page.on("dialog", (dialog) => {
    asked += 1;
    void dialog.accept();
  });
  await page.reload();
  await page.waitForSelector(".knob");
  check(asked === 0, "it asks without a change");
  await choose(page, "Flag");
  check((await page.textContent("#problem")).startsWith("Nothing is kept until you save"), await page.textContent("#problem"));
  await page.reload();
  await page.waitForSelector(".knob");
  check(asked === 1, "leaving loses the steps without a word");
  await page.keyboard.press("Control+s");
  await page.waitForFunction(() => document.querySelector("#saved").textContent.startsWith("Saved"));
  await page.reload();
  await page.waitForSelector(".knob");
  check(asked === 1, "it asks though everything is saved");
}, { XDG_STATE_HOME: "/dev/null/nowhere" });

/** Of everything that is kept, other users of the computer read nothing. */
export const what_is_kept_is_private = () => within(async ({ state, page }) => {
  if (process.platform === "win32") return;
  await choose(page, "Flag");
  const all = readdirSync(state, { recursive: true }).map((name) => `${state}/${name}`);
  const wrong = all.filter((file) => (statSync(file).mode & 0o077) !== 0);
  check(all.filter((file) => statSync(file).isFile()).length === 2 && wrong.length === 0, `${all}; open: ${wrong}`);
});
