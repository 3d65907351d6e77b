// Saving, opening again, drafts, dropped files, two pages, the end of the server.
import { existsSync, readFileSync, readdirSync } from "node:fs";
import { execFileSync, spawn, spawnSync } from "node:child_process";
import { OWN, awaited, becomes, changes, check, choose, drag, edit, folder, middle, open, paths, program, quiet, root, sample, standIn } from "./harness.mjs";

async function within(file, test, ...args) {
  const dir = folder({ "logo.svg": file ?? sample("logo.svg") });
  const editor = await edit(`${dir}/logo.svg`, ...args);
  const page = await open(editor.address);
  try {
    await test({ dir, editor, page });
    check(page.problems.length === 0, page.problems.join("; "));
  } finally {
    editor.stop();
    await page.context().close();
  }
}

export const a_flag_is_saved_and_opened_again = () => within(null, async ({ dir, page, editor }) => {
  await choose(page, "Flag");
  await page.click("#save");
  await page.waitForSelector("#toast.on");
  const saved = `${dir}/logo-bent.svg`;
  check(existsSync(saved), "nothing was saved");
  check(readFileSync(saved, "utf8").includes("style = \"flag\""), "the recipe is not in the file");
  check(readdirSync(dir).length === 2, `beside the drawing are ${readdirSync(dir)}`);
  const before = await paths(page);
  editor.stop();
  const again = await edit(saved);
  const page2 = await open(again.address);
  try {
    await becomes(page2, before, "the file looks different when opened again");
    check((await page2.textContent("#steps")).includes("Flag"), "the step is not there again");
    await page2.locator("#settings input[type=range]").first().focus();
    await page2.keyboard.press("ArrowRight");
    await quiet(page2);
    check((await paths(page2)) !== before, "it cannot be changed");
    await page2.click("#save");
    await page2.waitForSelector("#toast.on");
    check(readdirSync(dir).filter((f) => f.endsWith(".svg")).length === 2, "a result is saved to its own file");
  } finally {
    again.stop();
    await page2.context().close();
  }
});

/** Saving right after a choice saves what was chosen, though the server has not answered yet. */
export const what_was_chosen_just_now_is_saved = () => within(null, async ({ dir, page }) => {
  await page.evaluate(() => {
    [...document.querySelectorAll(".card")].find((card) => card.textContent === "Flag").click();
    window.dispatchEvent(new KeyboardEvent("keydown", { key: "s", ctrlKey: true }));
  });
  await page.waitForSelector("#toast.on");
  check(readFileSync(`${dir}/logo-bent.svg`, "utf8").includes("style = \"flag\""), "the choice is not in the file");
});

export const every_format_is_written = () => within(null, async ({ dir, page }) => {
  await choose(page, "Arc");
  for (const [format, start] of [["pdf", "%PDF"], ["dxf", "  0"], ["png", "\x89PNG"], ["toml", "pathwarp = 1"], ["svg", "<svg"]]) {
    await page.click("#save-as");
    await page.check(`input[value=${format}]`);
    await page.click("#save-dialog button[type=submit]");
    await page.waitForFunction(() => !document.querySelector("#save-dialog").open);
    const bytes = readFileSync(`${dir}/logo-bent.${format}`, "latin1");
    check(bytes.startsWith(start), `${format} begins with ${JSON.stringify(bytes.slice(0, 8))}`);
  }
  // The logo has wide strokes, of which a cutter follows the middle.
  execFileSync(program, ["warp", "logo.svg", "--style", "arc", "-o", "by-command.dxf"], { cwd: dir, stdio: "pipe" });
  check(readFileSync(`${dir}/by-command.dxf`).equals(readFileSync(`${dir}/logo-bent.dxf`)), "the command gives another DXF");
  await page.click("#save-as");
  await page.fill("#save-name", "logo.svg");
  await page.click("#save-dialog button[type=submit]");
  await page.waitForFunction(() => document.querySelector("#save-message").textContent.includes("the drawing itself"));
});

export const a_crash_loses_nothing = () => within(null, async ({ dir, page, editor }) => {
  await drag(page, "shaper/0.0/1", 20, 60);
  const before = await paths(page);
  editor.stop();
  await page.waitForSelector("#gone:not([hidden])");
  const again = await edit(`${dir}/logo.svg`);
  const page2 = await open(again.address);
  try {
    await becomes(page2, before, "the steps are not there again");
    await page2.reload();
    await page2.waitForSelector(".knob");
    await becomes(page2, before, "a reload loses the steps");
    await page2.click("#undo");
    await changes(page2, before);
  } finally {
    again.stop();
    await page2.context().close();
  }
});

export const two_pages_show_the_same = () => within(null, async ({ page, editor }) => {
  const other = await open(editor.address);
  await drag(page, "shaper/0.0/2", 30, 50);
  await becomes(other, await paths(page), "the other page did not follow");
  await other.context().close();
});

export const the_program_ends_with_the_page = () => within(null, async ({ page, editor }) => {
  await page.reload();
  await page.waitForSelector(".knob");
  await page.goto("about:blank");
  const code = await awaited(editor.ended, "the end of the program");
  check(code === 0, `exit ${code}`);
});

export const a_port_is_chosen_and_ctrl_c_ends = async () => {
  const dir = folder({ "logo.svg": sample("logo.svg") });
  // A port that is free: another server had it a moment ago.
  const { createServer } = await import("node:net");
  const port = await new Promise((done) => {
    const server = createServer().listen(0, "127.0.0.1", () => {
      const { port } = server.address();
      server.close(() => done(port));
    });
  });
  const editor = await edit(`${dir}/logo.svg`, "--port", String(port));
  check(new URL(editor.address).port === String(port), editor.address);
  editor.child.kill("SIGINT");
  const code = await awaited(editor.ended, "the end of the program");
  check(code === 130, `exit ${code}`);
};

/** Starts the program with a stand-in for the browser, and ends it by Ctrl-C. Returns what it has said, and the addresses opened. */
async function started(display, browser, ...args) {
  const dir = folder({ "logo.svg": sample("logo.svg") });
  const { path, opened } = standIn(dir);
  const env = { ...process.env, ...OWN, DISPLAY: display, WAYLAND_DISPLAY: "", BROWSER: browser ?? path };
  const child = spawn(program, ["edit", "logo.svg", ...args], { cwd: dir, env, stdio: ["ignore", "pipe", "pipe"] });
  let [out, said, address] = ["", "", ""];
  opened.then((text) => (address = text));
  child.stderr.on("data", (text) => (said += text));
  await awaited(new Promise((resolve) => child.stdout.on("data", (text) => (out += text).includes("\n") && resolve())), "the address");
  // The program answers when it has opened what it opens.
  await awaited(fetch(out.trim()), "the page");
  if (display && !browser && args.length === 0) await awaited(opened, "the browser");
  child.kill("SIGINT");
  await awaited(new Promise((r) => child.once("close", r)), "the end of the program");
  return { out, said, address };
}

/** The address is all that is printed; a browser opens only where it can be seen, and Ctrl-C needs no words. */
export async function a_browser_is_opened_where_there_is_a_display() {
  const line = /^http:\/\/127\.0\.0\.1:\d+\/\?token=\S+\n$/;
  const shown = await started(":99");
  check(line.test(shown.out) && `${shown.address}\n` === shown.out && shown.said === "", JSON.stringify(shown));
  for (const [display, ...args] of [[""], [":99", "--no-open"]]) {
    const { out, said, address } = await started(display, undefined, ...args);
    check(line.test(out) && address === "" && said === "", `${display} ${args}: ${out}${said}${address}`);
  }
  const { out, said } = await started(":99", "/nothing/here");
  check(line.test(out) && /^warning: no browser can be started/.test(said), out + said);
}

export const a_program_that_was_stopped_goes_on = () => within(null, async ({ page, editor }) => {
  await drag(page, "shaper/0.0/2", 20, 30);
  editor.child.kill("SIGSTOP");
  // Longer than the program waits for a page to come back; any longer time will do.
  await page.waitForTimeout(6000);
  editor.child.kill("SIGCONT");
  const before = await paths(page);
  await drag(page, "shaper/0.0/2", 20, 30);
  check(!(await page.isVisible("#gone")), "the page has lost the program");
  check((await paths(page)) !== before, "the picture does not follow any more");
});

/** Two steps, one of them a plug-in's: the copied line gives the file that was saved. */
export const a_copied_command_line_gives_the_same = () => {
  if (spawnSync("python3", ["--version"]).status !== 0) return "skipped: copied command lines are not tested without Python 3";
  const plugin = `${root}examples/plug-ins/pathwarp-ripple.py`;
  return within(null, async ({ dir, page }) => {
    await choose(page, "Ripple");
    await page.click("#add-step");
    await choose(page, "Grid");
    await drag(page, "at/5", 20, 30);
    await page.click("#save");
    await page.waitForSelector("#toast.on");
    await page.evaluate(() => { navigator.clipboard.writeText = (text) => { window.copied = text; return Promise.resolve(); }; });
    await page.click("#save-as");
    await page.click("#copy-command");
    const line = await (await page.waitForFunction(() => window.copied)).jsonValue();
    const again = line.replace(/^pathwarp /, `'${program}' `).replace("-o logo-bent.svg", "-o again.svg");
    check(again !== line && line.includes(plugin), line);
    execFileSync("sh", ["-c", `${again} --quiet`], { cwd: dir });
    const drawn = (name) => readFileSync(`${dir}/${name}`, "utf8").match(/ d="[^"]*"/g).join();
    check(drawn("again.svg") === drawn("logo-bent.svg"), `another drawing from ${line}`);
  }, "--plugin", plugin);
};

export const a_dropped_file_is_opened = () => within(null, async ({ page, dir }) => {
  const text = readFileSync(sample("badge.svg"), "utf8");
  await page.evaluate((svg) => {
    const data = new DataTransfer();
    data.items.add(new File([svg], "badge.svg"));
    document.dispatchEvent(new DragEvent("drop", { dataTransfer: data, bubbles: true, cancelable: true }));
  }, text);
  await page.waitForFunction(() => document.querySelector("#file").textContent === "badge.svg");
  await quiet(page);
  await drag(page, "shaper/0.0/2", 20, 30);
  await page.click("#save");
  await page.waitForSelector("#toast.on");
  check(existsSync(`${dir}/badge-bent.svg`), "it was not saved beside the first file");
});

export const presets_fit_other_drawings = () => within(null, async ({ page }) => {
  await drag(page, "shaper/0.0/2", 0, 60);
  await page.click("#keep-preset");
  await page.fill("#preset-name", "My wave");
  await page.click("#preset-dialog button[type=submit]");
  await page.waitForSelector(".preset");
  const dir = folder({ "badge.svg": sample("badge.svg") });
  const editor = await edit(`${dir}/badge.svg`);
  const other = await open(editor.address);
  try {
    const width = () => other.$eval("#stage .line.path", (cage) => cage.getBoundingClientRect().width);
    const [before, cage] = [await paths(other), await width()];
    await other.locator(".preset", { hasText: "My wave" }).click();
    await quiet(other);
    check((await paths(other)) !== before, "the preset does nothing");
    check(Math.abs((await width()) - cage) < 0.05 * cage, `the cage is ${await width()} px wide, that of the artwork ${cage}`);
    await other.click(".presets .small");
    await other.waitForFunction(() => document.querySelectorAll(".preset").length === 0);
  } finally {
    editor.stop();
    await other.context().close();
  }
});

export const steps_are_added_moved_and_removed = () => within(null, async ({ page }) => {
  await choose(page, "Flag");
  await page.click("#add-step");
  await choose(page, "Perspective");
  check((await page.locator("#steps li").count()) === 2, "the step was not added");
  await drag(page, "target/0.0/2", -60, 30);
  const both = await paths(page);
  await page.locator("#steps li").nth(0).locator("button.step").click();
  await quiet(page);
  check((await paths(page)) !== both, "the first step alone looks like both");
  await page.locator("#steps li").nth(1).locator("button.step").click();
  await quiet(page);
  check((await paths(page)) === both, "selecting steps changed the picture");
  await page.locator("[aria-label^='Move Perspective up']").click();
  await quiet(page);
  check(/^1\. Perspective/.test(await page.locator("#steps li").nth(0).textContent()), "the step did not move");
  await page.locator("[aria-label^='Remove Perspective']").click();
  await quiet(page);
  check((await page.locator("#steps li").count()) === 1, "the step was not removed");
  void middle;
});

/** Artwork that leaves the page takes it along, on show, also during the drag, and in the file. */
export const the_page_grows = () => within(null, async ({ dir, page }) => {
  const sheet = () => page.$eval("#stage .sheet", (s) => { const b = s.getBoundingClientRect(); return [b.top, b.bottom, b.left, b.right]; });
  const [before, [x, y]] = [await sheet(), await middle(page, "shaper/0.0/2")];
  // The artwork comes a little nearer to the left or to the right side as well, and the margin stays.
  const grown = ([top, bottom, left, right]) => top < before[0] - 20 && Math.abs(bottom - before[1]) < 0.5
    && [before[2] - left, right - before[3]].every((by) => by > -0.5 && by < 12);
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x, y - 90, { steps: 12 });
  await page.waitForFunction((top) => document.querySelector("#stage .sheet").getBoundingClientRect().top < top - 20, before[0]);
  check(grown(await sheet()), `the sheet does not grow at one side: ${before} to ${await sheet()}`);
  await page.mouse.up();
  await quiet(page);
  check(grown(await sheet()), `the view has changed with the sheet: ${before} to ${await sheet()}`);
  check(Math.abs((await middle(page, "shaper/0.0/2"))[1] - y + 90) < 9, "the view has moved");
  await page.click("#save");
  await page.waitForSelector("#toast.on");
  const box = /viewBox="([^"]*)"/.exec(readFileSync(`${dir}/logo-bent.svg`, "utf8"))[1].split(/[ ,]+/).map(Number);
  check(box[1] < -20 && box[3] > 220, `the page is ${box}`);
  await page.evaluate(() => { navigator.clipboard.writeText = (text) => { window.copied = text; return Promise.resolve(); }; });
  await page.click("#save-as");
  await page.click("#copy-command");
  await page.waitForFunction(() => window.copied);
  check(!/ --fit /.test(await page.evaluate(() => window.copied)), await page.evaluate(() => window.copied));
});

/** The nodes of the result are shown with their control points, also while it is dragged. */
export const nodes_are_shown = () => within(null, async ({ page }) => {
  await page.click("#nodes");
  const shown = () => page.$$eval("#stage .nodes, #stage .arms", (all) => all.map((e) => e.getAttribute("d").split("M").length - 1));
  const [arms, nodes] = await shown();
  const expected = (await paths(page)).match(/[MLQC]/g).length;
  check(nodes === expected && arms > nodes / 2, `${nodes} nodes of ${expected}, ${arms} arms`);
  const [x, y] = await middle(page, "shaper/0.0/2");
  await page.mouse.move(x, y);
  await page.mouse.down();
  const still = await paths(page);
  for (let i = 1; i < 9; i++) await page.mouse.move(x + 3 * i, y - 4 * i);
  await changes(page, still);
  const [, dragged] = await shown();
  check(dragged >= nodes, `${dragged} nodes while it is dragged`);
  await page.mouse.up();
});
