// What is done before bending: fewer nodes, and areas that grow.
import { execFileSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { becomes, check, edit, folder, keep, open, paths, program, quiet, sample } from "./harness.mjs";

const press = async (page, name) => {
  await page.getByRole("button", { name, exact: true }).click();
  await quiet(page);
};
const typed = async (page, label, text) => {
  await page.getByRole("textbox", { name: label, exact: true }).fill(text);
  await page.keyboard.press("Enter");
  await quiet(page);
};
const nodes = async (page) => (await paths(page)).match(/[CQLcql]/g).length;

/** Simplify and Offset come before a flag, wherever they are added; the copied line, the recipe and the file opened again give the same. */
export const simplified_and_grown_before_bending = async () => {
  const dir = folder({ "word.svg": sample("traced/word.svg") });
  const editor = await edit(`${dir}/word.svg`);
  const page = await open(editor.address, { viewport: { width: 1440, height: 900 } });
  try {
    await page.evaluate(() => { navigator.clipboard.writeText = (text) => { window.copied = text; return Promise.resolve(); }; });
    await press(page, "Flag");
    const before = await nodes(page);
    await press(page, "Add step");
    await page.getByRole("searchbox", { name: "Find a shape" }).fill("fewer nodes");
    await press(page, "Simplify");
    await typed(page, "Within", "0.5 px");
    await page.getByRole("button", { name: "2. Flag" }).click();
    await quiet(page);
    const simple = await nodes(page);
    check(simple < 0.6 * before, `${before} nodes became ${simple}`);
    for (const label of ["Move Flag up", "Move Simplify down"]) check(await page.getByRole("button", { name: label }).isDisabled(), `${label} can be pressed`);
    await page.getByRole("searchbox", { name: "Find a shape" }).fill("outline");
    await press(page, "Offset");
    check((await page.getByRole("list").getByRole("button", { name: /^[0-9]\. / }).allTextContents()).join() === "1. Simplify,2. Offset,3. Flag", "the order is another");
    check(!(await page.getByRole("button", { name: "Pick parts" }).isVisible()), "it asks for parts");
    await typed(page, "Distance", "2px");
    await keep(page, "first");
    await page.getByRole("button", { name: "3. Flag" }).click();
    await quiet(page);
    const picture = await paths(page);
    const copied = async (name, format) => {
      await page.getByRole("button", { name: "Save as…" }).click();
      if (format) await page.getByRole("radio", { name: format }).check();
      await page.getByRole("textbox", { name: "Name", exact: true }).fill(name);
      await page.getByRole("button", { name: "Copy command line" }).click();
      return (await page.waitForFunction(() => window.copied)).jsonValue();
    };
    await page.getByRole("button", { name: "Save", exact: true }).first().click();
    await page.getByText("Saved word-bent.svg in").waitFor();
    const line = await copied("copied.svg");
    execFileSync("sh", ["-c", line.replace(/^pathwarp/, program)], { cwd: dir, stdio: "pipe" });
    check(readFileSync(join(dir, "copied.svg"), "utf8") === readFileSync(join(dir, "word-bent.svg"), "utf8"), `${line} gives other bytes`);
    // By two commands before, as a terminal has them.
    const run = (...args) => execFileSync(program, args, { cwd: dir, stdio: "pipe" });
    run("simplify", "word.svg", "--tolerance", "0.5", "-o", "1.svg");
    run("offset", "1.svg", "--by", "2", "-o", "2.svg");
    run("warp", "2.svg", "--style", "flag", "-o", "3.svg");
    run("warp", "word.svg", "--style", "flag", "--simplify", "0.5", "--outset", "2", "-o", "4.svg");
    check(readFileSync(join(dir, "3.svg"), "utf8") === readFileSync(join(dir, "4.svg"), "utf8"), "the commands one by one give another drawing");
    await editor.stop();
    const again = await edit(join(dir, "word-bent.svg"));
    const page2 = await open(again.address);
    await becomes(page2, picture, "opened again, it is another drawing");
    await press(page2, "Remove Flag");
    await press(page2, "Undo");
    await becomes(page2, picture, "removing the flag cannot be undone");
    await again.stop();
    await page2.context().close();
    check(page.problems.length === 0, page.problems.join("; "));
  } finally {
    editor.stop();
    await page.context().close();
  }
};
