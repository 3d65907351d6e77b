// Whole jobs, by visible labels and places alone. SHOTS=FOLDER keeps a picture of each.
import { existsSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { becomes, check, edit, folder, open, paths, quiet, sample } from "./harness.mjs";

async function job(name, drawing, work) {
  const dir = folder({ [drawing]: sample(drawing) });
  const editor = await edit(`${dir}/${drawing}`);
  const page = await open(editor.address, { viewport: { width: 1440, height: 900 } });
  try {
    await work(page, dir, editor);
    if (process.env.SHOTS) await page.screenshot({ path: join(process.env.SHOTS, `${name}.png`) });
    check(page.problems.length === 0, page.problems.join("; "));
    check(!(await page.isVisible("#folds")), await page.textContent("#folds"));
  } finally {
    editor.stop();
    await page.context().close();
  }
}

const press = async (page, name) => {
  await page.getByRole("button", { name, exact: true }).click();
  await quiet(page);
};
const field = async (page, label, text) => {
  await page.getByRole("textbox", { name: label, exact: true }).click({ clickCount: 3 });
  await page.keyboard.type(text);
  await page.keyboard.press("Enter");
  await quiet(page);
};
const at = async (page, label) => {
  const { x, y, width, height } = await page.getByRole("button", { name: label, exact: true }).locator(".body").boundingBox();
  return [x + width / 2, y + height / 2];
};
const pull = async (page, [x, y], [dx, dy]) => {
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + dx, y + dy, { steps: 12 });
  await page.mouse.up();
  await quiet(page);
};
const saved = async (page, format, name) => {
  await page.getByRole("button", { name: "Save as…" }).click();
  await page.getByRole("radio", { name: new RegExp(`^${format}`) }).check();
  await page.getByRole("textbox", { name: "Name", exact: true }).fill(name);
  await page.getByRole("dialog").getByRole("button", { name: "Save", exact: true }).click();
  await page.getByText(`Saved ${name}`).waitFor();
};
/** Undoes and redoes everything, with the page loaded anew in between. */
const backAndForth = async (page, times) => {
  const picture = await paths(page);
  for (let i = 0; i < times; i++) await press(page, "Undo");
  await page.reload();
  await page.waitForSelector("#stage .art *", { state: "attached" });
  await quiet(page);
  for (let i = 0; i < times; i++) await press(page, "Redo");
  await becomes(page, picture, "undo and redo do not lead back");
};

/** A word arched by exactly 30 %, as a picture of 2,000 px and for print. */
export const job_arch = () => job("arch", "lettering.svg", async (page, dir) => {
  await press(page, "Arch");
  await field(page, "Bend", "30");
  check((await page.getByRole("textbox", { name: "Bend", exact: true }).inputValue()) === "30", "it is not 30");
  await backAndForth(page, 2);
  await saved(page, "PNG", "word.png");
  await saved(page, "PDF", "word.pdf");
  check(readFileSync(`${dir}/word.png`).readUInt32BE(16) === 2000 && existsSync(`${dir}/word.pdf`), "the picture has another width");
});

/** A flag and then perspective; the flag is changed afterwards. */
export const job_flag_in_perspective = () => job("flag", "logo.svg", async (page, dir, editor) => {
  await press(page, "Flag");
  await press(page, "Add step");
  await press(page, "Perspective");
  const corners = await page.locator(".knob.node").evaluateAll((all) => all.map((k) => k.getAttribute("aria-label")));
  await pull(page, await at(page, corners[1]), [-60, -50]);
  const before = await paths(page);
  await page.getByRole("button", { name: /^1\. Flag/ }).click();
  await quiet(page);
  await field(page, "Bend", "20+5");
  await page.getByRole("button", { name: /^2\. / }).click();
  await quiet(page);
  check((await paths(page)) !== before, "the flag has not changed");
  await backAndForth(page, 4);
  const picture = await paths(page);
  await press(page, "Save");
  await page.getByText("Saved logo-bent.svg in").waitFor();
  await editor.stop();
  const again = await edit(join(dir, "logo-bent.svg"));
  const page2 = await open(again.address);
  try {
    await becomes(page2, picture, "opened again, it is another drawing");
  } finally {
    await again.stop();
    await page2.context().close();
  }
});

/** A bottle's label: the neck by both upper corners, the belly by the lower side. */
export const job_bottle = () => job("bottle", "badge.svg", async (page) => {
  await press(page, "Cage");
  await press(page, "Symmetric");
  const corner = await at(page, "Cage, point 3");
  await pull(page, corner, [-70, 0]);
  const [[ax, ay], [bx, by]] = [await at(page, "Cage, point 1"), await at(page, "Cage, point 2")];
  await pull(page, [ax + 0.5 * (bx - ax), ay + 0.5 * (by - ay)], [0, 40]);
  await backAndForth(page, 2);
});

/** An arm by pins, one of which is added to the bent artwork, and one removed. */
export const job_pins = () => job("pins", "badge.svg", async (page) => {
  await press(page, "Pins");
  const [x, y] = await at(page, "Pair 5, where it goes");
  await pull(page, [x, y], [30, 40]);
  await page.mouse.dblclick(x + 110, y);
  await quiet(page);
  await pull(page, [x + 110, y], [25, -20]);
  const pins = () => page.locator(".knob.node").count();
  const count = await pins();
  await page.mouse.click(...(await at(page, "Pair 1, where it goes")));
  await press(page, "Remove point");
  check((await pins()) === count - 1, "no pin was removed");
  await backAndForth(page, 5);
});

/** A row of a grid is moved, and a column added. */
export const job_grid = () => job("grid", "logo.svg", async (page) => {
  await press(page, "Grid");
  const [[ax, ay], [bx]] = [await at(page, "Control point 1,1"), await at(page, "Control point 2,1")];
  await pull(page, [(ax + bx) / 2, ay], [0, -40]);
  const [[cx, cy], [dx]] = [await at(page, "Control point 0,0"), await at(page, "Control point 1,0")];
  await page.mouse.dblclick((cx + dx) / 2, cy);
  await quiet(page);
  check((await page.locator(".knob.node").count()) === 20, "no column was added");
  await pull(page, await at(page, "Control point 4,3"), [30, 20]);
  await backAndForth(page, 4);
});

/** One letter of a word is warped alone, larger than its neighbours. */
export const job_letter = () => job("letter", "lettering.svg", async (page) => {
  await press(page, "Pick parts");
  await press(page, "Bulge");
  const whole = await paths(page);
  // The middle of the d.
  const box = await page.locator("#stage .art path").nth(3).boundingBox();
  await page.mouse.click(box.x + 0.3 * box.width, box.y + 0.6 * box.height);
  await quiet(page);
  check((await page.getByText("This step bends one part.").count()) === 1, "no letter was chosen");
  const [now, then] = [await paths(page), whole].map((all) => all.split("|"));
  check(now.filter((d, i) => d === then[i]).length === 0, "the others are still bent");
  await field(page, "Bend", "60");
  await backAndForth(page, 3);
});

/** A word is typed, set in another font, put on a drawn circle, saved, opened again, and is still a word. */
export const job_words = () => job("words", "logo.svg", async (page, dir, editor) => {
  await press(page, "Words…");
  await page.getByRole("textbox", { name: "Text" }).fill("Harbour");
  await page.getByRole("button", { name: "Set words" }).click();
  await page.getByRole("heading", { name: "harbour.svg" }).waitFor();
  await quiet(page);
  const bundled = await paths(page);
  await press(page, "Bend");
  const box = await page.locator("#stage .sheet").boundingBox();
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  await page.getByRole("button", { name: "Draw circle" }).first().click();
  await pull(page, [x, y + 30], [box.width / 3, 0]);
  const bent = await paths(page);
  check(bent !== bundled, "the word is not bent");
  await press(page, "Edit words…");
  check((await page.getByRole("textbox", { name: "Text" }).inputValue()) === "Harbour", "the words are forgotten");
  await page.getByRole("textbox", { name: "Spacing" }).fill("10");
  const fonts = await page.getByRole("listbox", { name: "Font" }).locator("option").allTextContents();
  if (fonts.length > 1) await page.getByRole("listbox", { name: "Font" }).selectOption({ index: fonts.length - 1 });
  await page.getByRole("button", { name: "Set words" }).click();
  await quiet(page);
  check((await paths(page)) !== bent && (await page.locator("#steps").textContent()).includes("Bend"), "the bend is gone, or the words are as before");
  await saved(page, "SVG Can", "sign.svg");
  const picture = await paths(page);
  await editor.stop();
  const again = await edit(join(dir, "sign.svg"));
  const page2 = await open(again.address);
  try {
    await becomes(page2, picture, "opened again, it is another drawing");
    await page2.getByRole("button", { name: "Edit words…" }).click();
    check((await page2.getByRole("textbox", { name: "Text" }).inputValue()) === "Harbour", "opened again, it is no word");
    await page2.getByRole("textbox", { name: "Text" }).fill("Harbour Coffee");
    await page2.getByRole("button", { name: "Set words" }).click();
    await quiet(page2);
    check((await paths(page2)) !== picture, "the words cannot be changed");
  } finally {
    await again.stop();
    await page2.context().close();
  }
});
