// Settings and steps: controls of every kind, files, the choice of further steps, and other drawings.
import { existsSync, readFileSync } from "node:fs";
import { becomes, check, choose, drag, edit, folder, open, paths, quiet, sample } from "./harness.mjs";

async function within(test, { drawing = sample("logo.svg") } = {}) {
  const dir = folder({ "logo.svg": drawing, "badge.svg": sample("badge.svg") });
  const editor = await edit(`${dir}/logo.svg`);
  const page = await open(editor.address);
  try {
    await test(page, dir, editor);
    check(page.problems.length === 0, page.problems.join("; "));
    check(!(await page.isVisible("#problem")), await page.textContent("#problem"));
  } finally {
    editor.stop();
    await page.context().close();
  }
}

/** Keys go on changing a setting: the focus stays. */
export const settings_by_keyboard = () => within(async (page) => {
  await choose(page, "Flag");
  const [before, slider] = [await paths(page), page.locator("#set-bend-slider")];
  await slider.focus();
  const value = Number(await slider.inputValue());
  for (let i = 0; i < 3; i++) {
    await page.keyboard.press("ArrowRight");
    await quiet(page);
  }
  check((await page.evaluate(() => document.activeElement.id)) === "set-bend-slider", "the focus is lost");
  check(Number(await slider.inputValue()) > value && (await paths(page)) !== before, "keys do not move the slider");
  const flat = await paths(page);
  await page.locator("#set-axis-0").focus();
  await page.keyboard.press("ArrowRight");
  await quiet(page);
  check(await page.isChecked("#set-axis-1"), "arrows do not go from choice to choice");
  check((await paths(page)) !== flat && (await page.evaluate(() => document.activeElement.id)) === "set-axis-1", "the choice does nothing");
});

/** A file is copied beside the drawing, read, and named in the result, which is opened again. Another file is not replaced. */
export const files_are_chosen = () => within(async (page, dir, editor) => {
  await choose(page, "Mesh");
  const before = await paths(page);
  await page.click(".more summary");
  await page.setInputFiles("#settings [aria-label='File of points']", sample("pinch.json"));
  await page.waitForFunction(() => document.querySelector("#set-mesh").value === "pinch.json");
  await quiet(page);
  check(readFileSync(`${dir}/pinch.json`, "utf8") === readFileSync(sample("pinch.json"), "utf8"), "the file is not beside the drawing");
  const bent = await paths(page);
  check(bent !== before, "the file does nothing");
  await page.click("#save");
  await page.waitForFunction(() => document.querySelector("#toast").textContent.startsWith("Saved"));
  editor.stop();
  const again = await edit(`${dir}/logo-bent.svg`);
  const page2 = await open(again.address);
  try {
    await becomes(page2, bent, "the result looks different when opened again");
    await choose(page2, "Arc");
    await page2.setInputFiles("#settings [aria-label=Style]", sample("roof.toml"));
    await page2.waitForFunction(() => document.querySelector("#set-style").value === "roof.toml");
    await quiet(page2);
    check(!(await page2.isVisible("#problem")), await page2.textContent("#problem"));
    await page2.setInputFiles("#settings [aria-label=Style]", { name: "pinch.json", mimeType: "", buffer: Buffer.from("{}") });
    await page2.waitForSelector("#problem:not([hidden])");
    check((await page2.textContent("#problem")).includes("pinch.json is beside the drawing"), await page2.textContent("#problem"));
  } finally {
    again.stop();
    await page2.context().close();
  }
});

/** The choice of a further step can be called off, and a shape that replaces work by hand says so. */
export const steps_are_called_off_and_replaced = () => within(async (page) => {
  await drag(page, "shaper/0.0/2", 30, -40);
  await page.click("#add-step");
  check((await page.textContent("#steps")).includes("2. Choose a shape"), await page.textContent("#steps"));
  await page.keyboard.press("Escape");
  check((await page.locator("#steps li").count()) === 1, "Escape does not call it off");
  await choose(page, "Flag");
  check((await page.locator("#steps li").count()) === 1, "a step was added all the same");
  check((await page.textContent("#toast")).startsWith("Flag replaces Cage"), await page.textContent("#toast"));
  await page.click("#undo");
  await page.waitForFunction(() => document.querySelector("#steps").textContent.includes("Cage"));
});

/** A shape that needs more room than the view has is shown as a whole. */
export const large_results_are_shown_as_a_whole = () => within(async (page) => {
  await choose(page, "Anamorphosis");
  const [stage, sheet] = [await page.locator("#stage").boundingBox(), await page.locator(".sheet").boundingBox()];
  check(sheet.x >= stage.x && sheet.x + sheet.width <= stage.x + stage.width, `the sheet is ${sheet.width} px wide, the view ${stage.width}`);
});

export const a_drawing_is_pasted = () => within(async (page, dir) => {
  const paste = (text) => page.evaluate((svg) => {
    const data = new DataTransfer();
    data.setData("text/plain", svg);
    document.body.dispatchEvent(new ClipboardEvent("paste", { clipboardData: data, bubbles: true }));
  }, text);
  await paste("no drawing");
  check((await page.textContent("#toast")).includes("not a drawing"), await page.textContent("#toast"));
  await paste(readFileSync(`${dir}/badge.svg`, "utf8"));
  await page.waitForFunction(() => document.querySelector("#file").textContent === "pasted.svg");
  await quiet(page);
  await drag(page, "shaper/0.0/2", 20, 30);
  await page.click("#save");
  await page.waitForFunction(() => document.querySelector("#toast").textContent.startsWith("Saved"));
  check(existsSync(`${dir}/pasted-bent.svg`), "it was not saved");
});

const LINE = `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 400 200"><rect x="100" y="80" width="200" height="40"/>
<path id="way" d="M40,180 Q200,120 360,180" fill="none" stroke="teal" stroke-width="6"/></svg>`;

/** A path of the drawing becomes the skeleton: it is clicked on the canvas, and is not bent any more. */
export const a_path_is_picked = () => within(async (page) => {
  await choose(page, "Bend");
  await page.click(".more summary");
  const pick = page.locator("#settings .field", { has: page.locator("#set-along") }).getByRole("button", { name: "Pick from drawing" });
  const way = () => page.$eval("#stage .art #art-way", (path) => path.getAttribute("d"));
  await pick.click();
  await page.keyboard.press("Escape");
  const [x, y] = await page.$eval("#stage .art #art-way", (way) => {
    const { x, y, width } = way.getBoundingClientRect();
    return [x + width / 2, y];
  });
  await page.mouse.click(x, y);
  check((await page.inputValue("#set-along")) !== "#way", "Escape does not end the choice");
  await pick.click();
  await page.mouse.click(x, y);
  await page.waitForFunction(() => document.querySelector("#set-along").value === "#way");
  await quiet(page);
  const [skeleton, picture] = [await way(), await paths(page)];
  await page.locator("#set-offset-slider").focus();
  await page.keyboard.press("PageUp");
  await quiet(page);
  check((await way()) === skeleton && (await paths(page)) !== picture, "the skeleton is bent, too");
  await drag(page, "along/0.0/0/out", 0, -60);
  check((await page.textContent("#toast")).includes("has left #way"), await page.textContent("#toast"));
  await page.click("#undo");
  await page.waitForFunction(() => document.querySelector("#set-along").value === "#way");
}, { drawing: LINE });
