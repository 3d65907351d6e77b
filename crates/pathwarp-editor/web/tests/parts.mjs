// Parts of the drawing: chosen by clicks and in the list, hidden, locked; and results in other folders and formats.
import { execFileSync } from "node:child_process";
import { existsSync, mkdirSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { check, choose, drag, edit, folder, keep, keys, open, paths, program, quiet, sample } from "./harness.mjs";

async function within(drawing, test, options = {}) {
  const dir = folder(drawing.includes("<") ? { "art.svg": drawing } : { "art.svg": sample(drawing) });
  const editor = await edit(`${dir}/art.svg`);
  const page = await open(editor.address, { viewport: { width: 1440, height: 900 }, ...options });
  try {
    await page.evaluate(() => { navigator.clipboard.writeText = (text) => { window.copied = text; return Promise.resolve(); }; });
    await test(page, dir);
    check(page.problems.length === 0, page.problems.join("; "));
  } finally {
    editor.stop();
    await page.context().close();
  }
}

/** The outlines of the paths of the picture, in the order of the file. */
const each = (page) => page.$$eval("#stage .art:not([visibility=hidden]) path", (all) => all.map((p) => p.getAttribute("d")));
const clicked = async (page, n, modifiers = []) => {
  const { x, y, width, height } = await page.locator("#stage .art:not([visibility=hidden]) path").nth(n).boundingBox();
  for (const key of modifiers) await page.keyboard.down(key);
  await page.mouse.click(x + width / 2, y + height / 2);
  for (const key of modifiers) await page.keyboard.up(key);
  await quiet(page);
};
/** Saves the result, runs the command line that the page copies, and checks that both give the same bytes. */
const savedAsCopied = async (page, dir) => {
  await page.click("#save-as");
  await page.fill("#save-name", "own.svg");
  await page.locator("#save-dialog").getByRole("button", { name: "Save", exact: true }).click();
  await page.waitForSelector("#toast.on");
  await page.click("#save-as");
  await page.fill("#save-name", "copied.svg");
  await page.click("#copy-command");
  const line = await (await page.waitForFunction(() => window.copied)).jsonValue();
  execFileSync("sh", ["-c", line.replace(/^pathwarp/, program)], { cwd: dir, stdio: "pipe" });
  check(readFileSync(join(dir, "copied.svg"), "utf8") === readFileSync(join(dir, "own.svg"), "utf8"), `${line} gives other bytes`);
};
const press = async (page, name) => {
  await page.getByRole("button", { name, exact: true }).click();
  await quiet(page);
};
/** Squares without ids, of which the last two are a group. */
const SQUARES = `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 40"><rect x="2" y="2" width="20" height="20"/>
  <path d="M30 2h20v20H30z"/><g><path d="M60 2h15v20H60z"/><path d="M80 2h15v20H80z"/></g></svg>`;
const moved = (before, after) => before.flatMap((d, i) => (d === after[i] ? [] : [i])).join();

/** Two steps for two parts, a copied command line with the same bytes, and the file opened again. */
export const steps_hold_for_parts = () => within(SQUARES, async (page, dir) => {
  const before = await each(page);
  await press(page, "Pick parts");
  await choose(page, "Flag");
  check(moved(before, await each(page)) === "0,1,2,3", "at first, everything is bent");
  await clicked(page, 1);
  check(moved(before, await each(page)) === "1", `${moved(before, await each(page))} are bent instead of the second`);
  check((await page.textContent("#parts-scope")) === "This step bends one part.", "the list does not say so");
  await clicked(page, 0, ["Shift"]);
  check(moved(before, await each(page)) === "0,1", "Shift does not add a part");
  await page.getByRole("button", { name: "Add step", exact: true }).click();
  await choose(page, "Arch");
  await page.locator("#parts .part-name", { hasText: "Group" }).click();
  await quiet(page);
  check(moved(before, await each(page)) === "0,1,2,3", "the second step does not bend the group");
  await savedAsCopied(page, dir);
  const picture = await paths(page);
  const again = await edit(join(dir, "own.svg"));
  const page2 = await open(again.address);
  await quiet(page2);
  check((await paths(page2)) === picture, "opened again, it is another drawing");
  await again.stop();
  await page2.context().close();
});

/** What is locked stays as it is under every step, and is not clicked; what is hidden is not seen. */
export const parts_are_locked_and_hidden = () => within(SQUARES, async (page) => {
  const before = await each(page);
  await press(page, "Pick parts");
  await choose(page, "Flag");
  await press(page, "Lock: Rectangle");
  check(moved(before, await each(page)) === "1,2,3", "a locked part is bent");
  await page.getByRole("button", { name: "Add step", exact: true }).click();
  await choose(page, "Arch");
  check(moved(before, await each(page)) === "1,2,3", "a locked part is bent by the next step");
  await clicked(page, 0);
  check((await page.textContent("#parts-scope")) === "This step bends everything.", "a locked part is chosen by a click");
  await press(page, "Undo");
  await press(page, "Undo");
  check(moved(before, await each(page)) === "0,1,2,3", "the lock cannot be undone");
  const seen = () => page.locator("#stage .art:not([visibility=hidden]) path:visible").count();
  await press(page, "Hide here: Group");
  check((await seen()) === 2, "the group is still seen");
  await choose(page, "Rise");
  check((await seen()) === 2, "the next picture shows it");
  await press(page, "Hide here: Group");
  check((await seen()) === 4, "it does not come back");
});

/** A result with a locked part is what the copied command line writes, and opened again the part is still locked. */
export const locks_are_kept = () => within(SQUARES, async (page, dir) => {
  await choose(page, "Flag");
  await page.click("#parts-list summary");
  await press(page, "Lock: Group");
  await savedAsCopied(page, dir);
  const again = await edit(join(dir, "own.svg"));
  const page2 = await open(again.address);
  await page2.locator("[aria-label='Lock: Group'][aria-pressed=true]").waitFor();
  const picture = await paths(page2);
  await press(page2, "Lock: Group");
  check((await paths(page2)) !== picture, "the lock does not open");
  await press(page2, "Undo");
  check((await paths(page2)) === picture, "the lock does not come back");
  // Another drawing has no such part.
  await page2.setInputFiles("#open-file", { name: "word.svg", mimeType: "image/svg+xml", buffer: readFileSync(sample("lettering.svg")) });
  await page2.getByRole("heading", { name: "word.svg" }).waitFor();
  await choose(page2, "Arch");
  check(!(await page2.isVisible("#problem")), await page2.textContent("#problem"));
  await again.stop();
  await page2.context().close();
});

/** A picture of 150 % on a colour, in a folder of its own, as the copied command line makes it; the choices are remembered. */
export const results_go_where_they_are_wanted = () => within("lettering.svg", async (page, dir) => {
  await choose(page, "Flag");
  mkdirSync(join(dir, "out"));
  await page.click("#save-as");
  await page.getByRole("radio", { name: /^WebP/ }).check();
  await page.getByRole("textbox", { name: "Folder" }).fill("nowhere");
  await page.getByRole("combobox", { name: "Unit of the size" }).selectOption("%");
  await page.getByRole("textbox", { name: "Size" }).fill("150");
  await page.getByRole("combobox", { name: "Background" }).selectOption("black");
  const save = page.locator("#save-dialog").getByRole("button", { name: "Save", exact: true });
  await save.click();
  await page.locator("#save-message", { hasText: "there is no folder nowhere" }).waitFor();
  await page.getByRole("textbox", { name: "Folder" }).fill("out");
  await save.click();
  await page.waitForSelector("#toast.on");
  check(existsSync(join(dir, "out/art-bent.webp")), "the picture is not in the folder");
  await page.click("#save-as");
  await page.getByRole("radio", { name: /^WebP/ }).check();
  check((await page.inputValue("#save-size")) === "150" && (await page.inputValue("#save-background")) === "black", "the choices are forgotten");
  await page.fill("#save-name", "copied.webp");
  await page.click("#copy-command");
  const line = await (await page.waitForFunction(() => window.copied)).jsonValue();
  execFileSync("sh", ["-c", line.replaceAll(/(^|\| )pathwarp/g, `$1${program}`)], { cwd: dir, stdio: "pipe" });
  check(readFileSync(join(dir, "copied.webp")).equals(readFileSync(join(dir, "out/art-bent.webp"))), `${line} gives another picture`);
  await page.click("#save-as");
  await page.getByRole("radio", { name: /^JPEG/ }).check();
  const [download] = await Promise.all([page.waitForEvent("download"), page.locator("#save-dialog").getByRole("button", { name: "Download" }).click()]);
  check(readFileSync(await download.path()).readUInt16BE(0) === 0xffd8, "the download is no JPEG");
});

/** White artwork is seen on black by itself; the user's choice stays. */
export const the_sheet_changes = () => within(`<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 60 40"><path fill="#fff" d="M5 5h50v30H5z"/></svg>`, async (page) => {
  const fill = () => page.$eval("#stage .sheet", (e) => getComputedStyle(e).fill);
  await page.getByRole("button", { name: "Sheet: black", exact: true }).waitFor();
  check((await fill()) === "rgb(0, 0, 0)", await fill());
  await press(page, "Sheet: black");
  check((await fill()).includes("#checks"), "the sheet has no pattern");
  await page.reload();
  await page.getByRole("button", { name: "Sheet: transparent", exact: true }).waitFor();
  await press(page, "Sheet: transparent");
  check((await fill()) === "rgb(255, 255, 255)", await fill());
  await choose(page, "Flag");
  await page.getByRole("button", { name: "Sheet: white", exact: true }).waitFor();
  await page.setInputFiles("#open-file", { name: "word.svg", mimeType: "image/svg+xml", buffer: readFileSync(sample("lettering.svg")) });
  await page.getByRole("heading", { name: "word.svg" }).waitFor();
  await quiet(page);
  check((await fill()) === "rgb(255, 255, 255)", "dark artwork is on another sheet");
});

/** A drawing behind the artwork, at its own place; its outline becomes the shape, and it is in no result. */
export const a_background_is_fitted_to = () => within("lettering.svg", async (page, dir) => {
  const leaf = `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 400 200" width="400" height="200"><path id="leaf" fill="#8b8" d="M10 100Q200-60 390 100Q200 260 10 100Z"/></svg>`;
  await page.setInputFiles("#background-file", { name: "leaf.svg", mimeType: "image/svg+xml", buffer: Buffer.from(leaf) });
  const width = page.getByRole("textbox", { name: "Width" });
  await width.waitFor();
  check((await width.inputValue()) === "105.83", `400 px are ${await width.inputValue()} mm`);
  const image = page.locator("#stage image.background");
  const before = await image.boundingBox();
  await width.fill("50+2.915");
  await page.keyboard.press("Enter");
  const after = await image.boundingBox();
  check(Math.abs(before.width / after.width - 2) < 0.01 && Math.abs(before.height / after.height - 2) < 0.01, "it is not half as large");
  await page.getByRole("slider", { name: "Opacity" }).fill("80");
  check((await image.getAttribute("opacity")) === "0.8", "its opacity is another");
  const lie = () => image.evaluate((e) => ["x", "y", "width", "height"].map((side) => e.getAttribute(side)).join(" "));
  const there = await lie();
  await page.getByRole("slider", { name: "Opacity" }).press("ArrowRight");
  await quiet(page);
  await page.reload();
  await image.waitFor();
  await quiet(page);
  const [again, faint] = [await lie(), await image.getAttribute("opacity")];
  check(faint === "0.81" && again === there, `loaded anew, the background is at ${again}, ${faint}`);
  await press(page, "Background");
  const was = await paths(page);
  await press(page, "Use its outline as the shape");
  check((await paths(page)) !== was && !(await page.isVisible("#problem")), await page.textContent("#problem"));
  await keep(page, "background");
  await page.click("#save");
  await page.locator("#toast.on", { hasText: "Saved art-bent.svg" }).waitFor();
  check(!readFileSync(join(dir, "art-bent.svg"), "utf8").includes("#8b8"), "the background is in the result");
  await press(page, "Background");
  await press(page, "Remove background");
  check(!(await image.isVisible()), "it is still there");
});

/** A word on a circle that is drawn: one centre, one radius, one start; and on a line drawn by clicks. */
export const lines_are_drawn = () => within("lettering.svg", async (page) => {
  await choose(page, "Bend");
  const box = await page.locator("#stage .sheet").boundingBox();
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  await page.getByRole("button", { name: "Draw circle" }).first().click();
  await page.mouse.move(x, y + 60);
  await page.mouse.down();
  await page.mouse.move(x + 150, y + 60, { steps: 6 });
  await page.mouse.up();
  await quiet(page);
  check(!(await page.isVisible("#problem")), await page.textContent("#problem"));
  const knobs = () => page.$$eval(".knob", (all) => all.map((k) => k.getAttribute("aria-label")));
  check((await knobs()).join() === ["Along, centre", "Along, start", "Along, radius"].sort().join() || (await knobs()).length === 3, `${await knobs()}`);
  const centre = async () => {
    const b = await page.getByRole("button", { name: "Along, centre" }).locator(".body").boundingBox();
    return [b.x + b.width / 2, b.y + b.height / 2];
  };
  const [cx, cy] = await centre();
  check(Math.hypot(cx - x, cy - y - 60) < 2, `the centre is at ${[cx, cy]}`);
  const picture = await paths(page);
  await page.mouse.move(cx, cy);
  await page.mouse.down();
  await page.mouse.move(cx + 40, cy + 20, { steps: 6 });
  await page.mouse.up();
  await quiet(page);
  const [mx, my] = await centre();
  check(Math.hypot(mx - cx - 40, my - cy - 20) < 2 && (await paths(page)) !== picture, "the circle does not move as a whole");
  await keep(page, "circle");
  await page.getByRole("button", { name: "Draw path" }).first().click();
  for (const [dx, dy] of [[-200, 0], [0, -60], [200, 0]]) await page.mouse.click(x + dx, y + dy);
  await page.keyboard.press("Enter");
  await quiet(page);
  check(!(await page.isVisible("#problem")) && (await page.locator(".knob.node").count()) === 3, "the path has not three points");
  await page.getByRole("button", { name: "Draw line" }).first().click();
  await page.keyboard.press("Escape");
  check((await page.locator(".knob.node").count()) === 3, "Escape does not give up");
});

/** Artwork without a height fits into no cage; it is seen all the same, and bent along a path. */
export const flat_artwork_is_seen = () => within(`<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 400 300"><path d="M10,10h300" stroke="#000"/></svg>`, async (page) => {
  await page.locator("#note", { hasText: "Choose a shape" }).waitFor();
  const line = await paths(page);
  check(line.includes("10") && !(await page.isVisible("#problem")) && (await page.locator(".knob").count()) === 0, await page.textContent("#problem"));
  await choose(page, "Bend");
  await page.locator(".knob.node").first().waitFor();
  check(!(await page.isVisible("#problem")), await page.textContent("#problem"));
  await press(page, "Undo");
  check((await paths(page)) === line, "undone, it is another drawing");
});

/** Steps for letters that other words do not have wait until they are back, eyes and locks stay; a preset is for no part of another drawing. */
export const parts_go_with_their_words = () => within("lettering.svg", async (page, dir) => {
  const setWords = async (text) => {
    await page.getByRole("button", { name: /words…$/i }).click();
    await page.getByRole("textbox", { name: "Text" }).fill(text);
    await page.getByRole("button", { name: /^(Set words|New drawing)$/ }).click();
    await page.getByRole("dialog").waitFor({ state: "hidden" });
    await quiet(page);
  };
  await setWords("Harbour");
  await choose(page, "Flag");
  await page.click("#parts-list summary");
  await press(page, "Lock: Path “u”");
  await press(page, "Hide here: Path “a”");
  await page.getByRole("button", { name: "Add step", exact: true }).click();
  await choose(page, "Arch");
  await press(page, "Path “b”");
  const bent = await paths(page);
  await setWords("Ho");
  await page.locator("#steps li", { hasText: "2. Arch one part (its letter is gone)" }).waitFor();
  check((await page.locator("#steps li").count()) === 2 && !(await page.isVisible("#problem")), await page.textContent("#steps"));
  await savedAsCopied(page, dir);
  await setWords("Harbour");
  check((await paths(page)) === bent, "the step does not work again");
  check((await page.getAttribute('[aria-label="Lock: Path “u”"]', "aria-pressed")) === "true", "the lock is open");
  check((await page.getAttribute('[aria-label="Hide here: Path “a”"]', "aria-pressed")) === "true", "what was hidden is not");
  await press(page, "Undo");
  await page.locator("#steps li", { hasText: "gone" }).waitFor();
  await press(page, "Undo");
  await page.locator("#steps li", { hasText: "gone" }).waitFor({ state: "hidden" });
  check((await paths(page)) === bent, "the letters do not come back");
  await page.click("#keep-preset");
  await page.fill("#preset-name", "Two letters");
  await page.keyboard.press("Enter");
  await page.locator(".preset").waitFor();
  await page.setInputFiles("#open-file", { name: "squares.svg", mimeType: "image/svg+xml", buffer: Buffer.from(SQUARES) });
  await page.getByRole("heading", { name: "squares.svg" }).waitFor();
  await quiet(page);
  const before = await each(page);
  await press(page, "Two letters");
  check(moved(before, await each(page)) === "0,1,2,3" && !(await page.isVisible("#problem")), await page.textContent("#problem"));
  await press(page, "Forget Two letters");
});

/** A line that was to be drawn for one shape is none of the next. */
export const drawing_ends_with_its_shape = () => within("lettering.svg", async (page) => {
  await choose(page, "Bend");
  await page.getByRole("button", { name: "Draw circle" }).first().click();
  await choose(page, "Flag");
  const flag = await paths(page);
  const { x, y, width, height } = await page.locator("#stage .sheet").boundingBox();
  await page.mouse.move(x + 10, y + height - 10);
  await page.mouse.down();
  await page.mouse.move(x + width / 3, y + height - 10, { steps: 4 });
  await page.mouse.up();
  await quiet(page);
  check((await paths(page)) === flag && !(await page.isVisible("#problem")), `${await page.textContent("#problem")} after a drag on the sheet`);
});

/** While parts are picked, a drag moves the view and two fingers magnify it, and neither picks. */
export const the_view_moves_while_parts_are_picked = () => within(SQUARES, async (page) => {
  await choose(page, "Flag");
  await press(page, "Pick parts");
  await clicked(page, 1);
  const [picture, box] = [await paths(page), () => page.locator("#stage .sheet").boundingBox()];
  const { x, y, width } = await box();
  await page.mouse.move(x + 8, y + 8);
  await page.mouse.down();
  await page.mouse.move(x + 48, y + 28, { steps: 4 });
  await page.mouse.up();
  const off = (await box()).x - x;
  check(Math.abs(off - 40) < 1, `the view moves by ${off}`);
  const session = await page.context().newCDPSession(page);
  const touch = (type, ...points) => session.send("Input.dispatchTouchEvent", { type, touchPoints: points.map(([px, py], id) => ({ x: px, y: py, id })) });
  const [one, two] = [[x + 60, y + 40], [x + 160, y + 40]];
  await touch("touchStart", one);
  await touch("touchStart", one, two);
  for (let i = 1; i <= 5; i++) await touch("touchMove", [one[0] - 10 * i, one[1]], [two[0] + 10 * i, two[1]]);
  await touch("touchEnd");
  await page.waitForFunction((was) => document.querySelector("#stage .sheet").getBoundingClientRect().width > 1.5 * was, width);
  await quiet(page);
  check((await page.textContent("#parts-scope")) === "This step bends one part." && (await paths(page)) === picture, "other parts are picked");
  await clicked(page, 2);
  check((await paths(page)) !== picture, "a click does not pick");
}, { hasTouch: true });

/** A click on what is locked or hidden does nothing: neither is that bent, nor everything. */
export const what_is_locked_or_hidden_is_not_picked = () => within(SQUARES, async (page) => {
  const before = await each(page);
  await press(page, "Pick parts");
  await choose(page, "Flag");
  await clicked(page, 1);
  await press(page, "Lock: Rectangle");
  const [first] = await page.locator("#parts .lock").evaluateAll((all) => all.map((b) => b.ariaPressed));
  check(first === "true", "it is not locked");
  const hidden = await page.locator("#stage .art:not([visibility=hidden]) path").nth(2).boundingBox();
  await page.locator("#parts .eye").nth(3).click();
  await quiet(page);
  const bent = await paths(page);
  const undone = await page.evaluate(() => document.querySelector("#steps").textContent);
  await clicked(page, 0);
  await page.mouse.click(hidden.x + 5, hidden.y + hidden.height / 2);
  await quiet(page);
  check((await paths(page)) === bent && (await page.textContent("#steps")) === undone, "the step bends something else");
  check(moved(before, await each(page)) === "1", `${moved(before, await each(page))} are bent instead of the second`);
  // A place that nothing covers still means everything.
  await page.mouse.click(hidden.x + 5, hidden.y + hidden.height + 60);
  await quiet(page);
  check((await page.textContent("#parts-scope")) === "This step bends everything.", "it does not bend everything");
});

/** Words on a bent drawing stand where they are put; a step holds for one of their letters, waits while that is gone, and the copied command
 * line gives the same bytes; with nothing typed, nothing is there. */
export const captions_have_letters_as_parts = () => within(SQUARES, async (page, dir) => {
  const place = async (x, y) => {
    await page.click("#words");
    await press(page, "Place on the drawing");
    await page.mouse.click(x, y);
    await page.locator("#caption-text").waitFor();
  };
  await choose(page, "Turn and scale");
  const { x, y, width, height } = await page.locator("#stage .sheet").boundingBox();
  await place(x + 10, y + 10);
  await page.keyboard.press("Escape");
  await page.locator("#caption-text").waitFor({ state: "hidden" });
  await quiet(page);
  check((await page.locator("#steps li").count()) === 1, "words that were not typed are there");
  await drag(page, (await keys(page)).at(-1), -60, 40);
  await place(x + 0.3 * width, y + 0.7 * height);
  await page.keyboard.type("HHH");
  await page.keyboard.press("Escape");
  await quiet(page);
  await press(page, "2. Turn and scale");
  const off = await page.$$eval("#stage .art:not([visibility=hidden]) path", (all, [x, y]) => {
    const letter = all.at(-3);
    const [length, to] = [letter.getTotalLength(), letter.getScreenCTM()];
    const points = Array.from({ length: 400 }, (_, i) => letter.getPointAtLength((i / 400) * length).matrixTransform(to));
    return Math.min(...points.map((p) => Math.hypot(p.x - x, p.y - y)));
  }, [x + 0.3 * width, y + 0.7 * height]);
  check(off < 8, `the first letter stands ${off} px beside the place that was clicked`);
  const before = await each(page);
  await press(page, "Add step");
  await choose(page, "Flag");
  await press(page, "Pick parts");
  await clicked(page, 5);
  const bent = await each(page);
  check(moved(before, bent) === "5", `${moved(before, bent)} are bent instead of the second letter`);
  await savedAsCopied(page, dir);
  const words = async (text) => {
    await press(page, "1. “HHH”".replace("HHH", await page.locator("#steps li").first().textContent().then((t) => /“(.*)”/.exec(t)[1])));
    await page.locator("#set-words").click({ clickCount: 3 });
    await page.keyboard.type(text);
    await page.keyboard.press("Tab");
    await quiet(page);
    await page.locator("#steps .step").last().click();
    await quiet(page);
  };
  await words("H");
  await page.locator("#steps li", { hasText: "(its letter is gone)" }).waitFor();
  check(!(await page.isVisible("#problem")), await page.textContent("#problem"));
  await words("HHH");
  check((await each(page)).join() === bent.join(), "the step does not work again");
});

/** Words without a step are saved in any format, with the bytes of the copied command line, and are words without a step when they are opened again. */
export const words_alone_are_saved = () => within("lettering.svg", async (page, dir) => {
  await page.click("#words");
  await page.fill("#words-text", "Word");
  await press(page, "New drawing");
  await page.getByRole("heading", { name: "word.svg" }).waitFor();
  await quiet(page);
  const level = await each(page);
  await savedAsCopied(page, dir);
  await page.click("#save-as");
  await page.getByRole("radio", { name: /^PDF/ }).check();
  await page.fill("#save-name", "word.pdf");
  await page.locator("#save-dialog").getByRole("button", { name: "Save", exact: true }).click();
  await page.getByText("Saved word.pdf").waitFor();
  check(readFileSync(join(dir, "word.pdf"), "latin1").startsWith("%PDF"), "it is no PDF");
  await page.setInputFiles("#open-file", join(dir, "own.svg"));
  await page.getByRole("heading", { name: "own.svg" }).waitFor();
  await quiet(page);
  check((await page.textContent("#words")) === "Edit words…" && (await page.isDisabled("#undo")), "they are no words any more");
  const off = (await each(page)).filter((d, i) => d !== level[i]);
  check(off.length === 0, `opened again, ${off.length} letters are others`);
});
