// Details: messages and their causes, names of controls, values during a drag, steps in their list, circles, surfaces.
import { execFileSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { becomes, check, choose, edit, emptyFolder, folder, keep, middle, open, paths, program, quiet, sample } from "./harness.mjs";

async function within(drawing, work, options = {}, content = () => sample(drawing)) {
  const dir = folder({ [drawing]: content() });
  const editor = await edit(`${dir}/${drawing}`);
  const page = await open(editor.address, options);
  try {
    await work(page, dir, editor);
    check(page.problems.length === 0, page.problems.join("; "));
  } finally {
    editor.stop();
    await page.context().close();
  }
}
const press = async (page, name) => {
  await page.getByRole("button", { name, exact: true }).click();
  await quiet(page);
};
const rows = (page) => page.locator("#steps .step").allTextContents();
const note = (page) => page.textContent("#note");

/** A message goes when somebody goes on, and is not over the tools of a phone. */
export const messages_go_with_their_cause = () => within("logo.svg", async (page) => {
  await press(page, "Save as…");
  const toast = page.locator("#toast.on");
  await toast.waitFor();
  const [message, tools] = [await toast.boundingBox(), await page.locator("#tools").boundingBox()];
  check(message.y + message.height <= tools.y, `the message ends at ${message.y + message.height}, the tools begin at ${tools.y}`);
  await keep(page, "message-on-a-phone");
  const [x, y] = await middle(page, "shaper/0.0/2");
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x - 30, y, { steps: 5 });
  check((await toast.count()) === 0, "the message is still there");
  await page.mouse.up();
  await quiet(page);
}, { viewport: { width: 390, height: 780 } });

/** While a handle is dragged, its value stands beside it. */
export const the_value_is_at_the_pointer = () => within("logo.svg", async (page) => {
  await choose(page, "Arch");
  const [x, y] = await middle(page, "bend");
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x, y + 20, { steps: 5 });
  const told = await page.textContent(".value-of-drag");
  await keep(page, "value-at-the-pointer");
  await page.mouse.up();
  await quiet(page);
  check(told === `Bend ${await page.inputValue("#set-bend")}%`, `${told} is shown for ${await page.inputValue("#set-bend")}`);
  check((await page.textContent(".value-of-drag")) === "", "the value stays");
});

/** What the engine refuses is told by the names of the page, and no option is named. */
export const errors_name_controls = () => within("logo.svg", async (page) => {
  await choose(page, "Swirl");
  await page.getByText("More settings").click();
  const field = page.getByRole("textbox", { name: "Center" });
  await field.fill("nowhere");
  await field.press("Enter");
  const said = page.locator(".wrong:visible");
  await said.first().waitFor();
  const text = (await said.allTextContents()).join();
  check(!text.includes("--") && text.includes("“nowhere”"), text);
  await field.press("Escape");
  // Of a whole recipe: a second step that needs a path that is not there.
  await choose(page, "Bend");
  const along = page.getByRole("textbox", { name: "Along" });
  await along.fill("#no such path");
  await along.press("Enter");
  await page.locator(".wrong:visible").first().waitFor();
  const other = (await page.locator(".wrong:visible").allTextContents()).join();
  check(!other.includes("--"), other);
});

/** Rows of the list are dragged, and what is hidden is in no file; keys are listed. */
export const steps_are_dragged_and_keys_listed = () => within("logo.svg", async (page, dir) => {
  await choose(page, "Flag");
  for (const name of ["Perspective", "Bulge"]) {
    await press(page, "Add step");
    await choose(page, name);
  }
  const places = await Promise.all([0, 2].map((i) => page.locator("#steps .step").nth(i).boundingBox()));
  await page.mouse.move(places[0].x + 30, places[0].y + 10);
  await page.mouse.down();
  await page.mouse.move(places[1].x + 30, places[1].y + 20, { steps: 6 });
  await page.mouse.up();
  await quiet(page);
  check((await rows(page)).join() === "1. Perspective,2. Bulge,3. Flag", (await rows(page)).join());
  await press(page, "Undo");
  check((await rows(page)).join() === "1. Flag,2. Perspective,3. Bulge", (await rows(page)).join());
  await press(page, "Hide Flag");
  await press(page, "Save");
  await page.locator("#toast.on", { hasText: "hidden steps are not in the file" }).waitFor();
  check(!readFileSync(join(dir, "logo-bent.svg"), "utf8").includes("flag"), "the hidden step is in the file");
  await page.locator("#stage").focus();
  await page.keyboard.press("?");
  await page.getByRole("heading", { name: "Keys" }).waitFor();
  await keep(page, "keys");
  await page.keyboard.press("Escape");
  check(!(await page.isVisible("#keys-dialog")), "the list stays");
});

/** Words that are longer than their circle: a line says so, and the circle grows; the ways of setting letters have pictures. */
export const a_circle_grows_with_its_words = () => within("lettering.svg", async (page, dir) => {
  await choose(page, "Bend");
  const along = page.getByRole("textbox", { name: "Along" });
  await along.fill("arc:r=20,from=90,to=450,cx=100,cy=60");
  await along.press("Enter");
  await quiet(page);
  check((await note(page)).includes("longer than its circle"), await note(page));
  const radius = page.getByRole("textbox", { name: "Radius" });
  check(Math.abs(Number(await radius.inputValue()) - (20 * 25.4) / 96) < 0.01, `a radius of 20 is ${await radius.inputValue()} mm`);
  await page.getByRole("button", { name: /Let the circle grow/ }).click();
  await quiet(page);
  check(!(await note(page)).includes("longer"), await note(page));
  // The box of the word, as the browser has it in the original, is as long as the circle or shorter.
  const width = await page.evaluate(async (svg) => {
    const box = Object.assign(document.createElement("div"), { innerHTML: svg });
    document.body.append(box);
    const all = Array.from(box.querySelectorAll("path"), (p) => p.getBBox());
    box.remove();
    return Math.max(...all.map((b) => b.x + b.width)) - Math.min(...all.map((b) => b.x));
  }, readFileSync(join(dir, "lettering.svg"), "utf8"));
  const grown = (Number(await radius.inputValue()) * 96) / 25.4;
  check(2 * Math.PI * grown > width - 1 && 2 * Math.PI * grown < 1.1 * width, `${grown} is the radius for ${width}`);
  check((await page.locator("#settings .glyphs").count()) === 5, "the ways of setting letters have no pictures");
  await keep(page, "circle-grown");
});

/** The eye's place and the radius of a mug are pulled on the canvas, and stand in the settings. */
export const a_surface_is_pulled = () => within("badge.svg", async (page) => {
  await choose(page, "Anamorphosis");
  const before = await paths(page);
  const [x, y] = await middle(page, "onto/radius");
  const [ex, ey] = await middle(page, "eye");
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(ex + 1.5 * (x - ex), y, { steps: 6 });
  await page.mouse.up();
  await quiet(page);
  await page.getByText("More settings").click();
  const typed = await page.locator("#set-onto").inputValue();
  const box = await page.evaluate(() => document.querySelector("#stage .sheet").getBBox().width);
  check(/^cylinder:radius=[\d.]+$/.test(typed), typed);
  check((await paths(page)) !== before && Number(typed.split("=")[1]) > box, `${typed} on a page of ${box}`);
  await page.mouse.move(ex, ey);
  await page.mouse.down();
  await page.mouse.move(ex + 60, ey - 40, { steps: 6 });
  await page.mouse.up();
  await quiet(page);
  await keep(page, "mug-by-hand");
  const after = await paths(page);
  for (const _ of [1, 2]) await press(page, "Undo");
  await becomes(page, before, "undo does not lead back");
  for (const _ of [1, 2]) await press(page, "Redo");
  await becomes(page, after, "redo does not lead back");
});

/** A photograph follows the pointer in few pixels, and is sharp when it is lifted. */
export const a_photograph_is_dragged_in_few_pixels = () => within("photograph.png", async (page) => {
  const pixels = () => page.evaluate(async () => {
    const image = document.querySelector("#stage .art:not([visibility=hidden]) image");
    const shown = Object.assign(new Image(), { src: image.getAttribute("href") ?? image.getAttribute("xlink:href") });
    await shown.decode();
    return shown.naturalWidth;
  });
  await choose(page, "Flag");
  const sharp = await pixels();
  const [x, y] = await middle(page, "bend");
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x, y + 30, { steps: 4 });
  await page.waitForFunction(() => document.querySelector("#view").getAttribute("aria-busy") === "false");
  const dragged = await pixels();
  await page.mouse.up();
  await quiet(page);
  check(sharp >= 1000 && dragged <= 600 && (await pixels()) >= 1000, `${sharp} pixels, ${dragged} while it was dragged, then ${await pixels()}`);
}, {}, photograph);

/** The file of a photograph of 1,200 pixels. */
function photograph() {
  const file = join(emptyFolder(), "photograph.png");
  execFileSync(program, ["render", sample("badge.svg"), "--width", "1200", "--background", "#8ac", "-o", file]);
  return file;
}
