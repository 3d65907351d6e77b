// Whole jobs, by visible labels and places alone. SHOTS=FOLDER keeps a picture of each.
import { execFileSync } from "node:child_process";
import { existsSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { becomes, check, edit, folder, keep, open, paths, program, quiet, sample } from "./harness.mjs";

async function job(name, drawing, work, content = sample(drawing)) {
  const dir = folder({ [drawing]: content });
  const editor = await edit(`${dir}/${drawing}`);
  const page = await open(editor.address, { viewport: { width: 1440, height: 900 } });
  try {
    await work(page, dir, editor);
    await keep(page, name);
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
  await page.getByRole("textbox", { name: label, exact: typeof label === "string" }).click({ clickCount: 3 });
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
const reload = async (page) => {
  await quiet(page);
  await page.reload();
  await page.waitForSelector("#stage .art *", { state: "attached" });
  await quiet(page);
};
/** Undoes and redoes everything, with the page loaded anew in between. */
const backAndForth = async (page, times) => {
  const picture = await paths(page);
  for (let i = 0; i < times; i++) await press(page, "Undo");
  await reload(page);
  for (let i = 0; i < times; i++) await press(page, "Redo");
  await becomes(page, picture, "undo and redo do not lead back");
};

/** Presses a button that asks for a file. */
const given = async (page, name, file) => {
  const [chooser] = await Promise.all([page.waitForEvent("filechooser"), page.getByRole("button", { name, exact: true }).click()]);
  await chooser.setFiles(file);
};
/** Closes the program, and goes on with a file that was saved. */
const openedAgain = async (editor, file, work) => {
  await editor.stop();
  const again = await edit(file);
  const page = await open(again.address);
  try {
    await work(page);
  } finally {
    await again.stop();
    await page.context().close();
  }
};
const setWords = async (page, button, fields) => {
  await page.getByRole("button", { name: button }).click();
  for (const [name, text] of Object.entries(fields)) await page.getByRole("textbox", { name }).fill(text);
  await page.getByRole("button", { name: button === "Words…" ? "New drawing" : "Set words" }).click();
  await page.getByRole("dialog").waitFor({ state: "hidden" });
  await quiet(page);
};

/** A word arched onto a badge by exactly 30 %, as a picture of 2,000 px and for print. */
export const job_arch = () => job("arch", "lettering.svg", async (page, dir) => {
  await press(page, "Arch");
  await field(page, "Bend", "30");
  check((await page.getByRole("textbox", { name: "Bend", exact: true }).inputValue()) === "30", "it is not 30");
  await backAndForth(page, 2);
  await given(page, "Background", sample("badge.svg"));
  for (const [name, mm] of [["Width", "185"], ["X", "-2"], ["Y", "-32"]]) await field(page, new RegExp(`^${name} +mm`), mm);
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
  await openedAgain(editor, join(dir, "logo-bent.svg"), (page2) => becomes(page2, picture, "opened again, it is another drawing"));
});

/** The command line that the dialog copies writes the file that *Save* has written, to the byte. */
const sameByCommand = async (page, dir, file) => {
  await page.evaluate(() => { navigator.clipboard.writeText = (text) => { window.copied = text; return Promise.resolve(); }; });
  await page.getByRole("button", { name: "Save as…" }).click();
  await page.getByRole("textbox", { name: "Name", exact: true }).fill(`copied-${file}`);
  await page.getByRole("button", { name: "Copy command line" }).click();
  const line = await (await page.waitForFunction(() => window.copied)).jsonValue();
  execFileSync("sh", ["-c", line.replace(/^pathwarp/, program)], { cwd: dir, stdio: "pipe" });
  check(readFileSync(join(dir, `copied-${file}`)).equals(readFileSync(join(dir, file))), `${line} gives other bytes`);
};

/** A flag and then perspective; the flag is changed while the end lies faint behind it, and what lay there is what all steps make. */
export const job_flag_with_the_end_in_view = () => job("flag-and-end", "logo.svg", async (page, dir) => {
  await press(page, "Flag");
  await press(page, "Add step");
  await press(page, "Perspective");
  const corners = await page.locator(".knob.node").evaluateAll((all) => all.map((k) => k.getAttribute("aria-label")));
  await pull(page, await at(page, corners[1]), [-60, -50]);
  check(!(await page.getByRole("button", { name: "End", exact: true }).isVisible()), "there is no later step to show");
  const whole = await paths(page);
  const ahead = () => page.$$eval("#stage .ahead path", (all) => all.map((p) => p.getAttribute("d")).join("|"));
  await page.getByRole("button", { name: /^1\. Flag/ }).click();
  await press(page, "End");
  check((await ahead()) === whole && (await paths(page)) !== whole, "what lies behind is not the end");
  await pull(page, await at(page, "Bend"), [0, -30]);
  await keep(page, "flag-and-end-changed");
  const end = await ahead();
  check(end !== whole, "the end stays as it was");
  await page.getByRole("button", { name: /^2\. / }).click();
  await quiet(page);
  check((await paths(page)) === end && (await ahead()) === "", "the end was another");
  await page.getByRole("button", { name: /^1\. Flag/ }).click();
  await quiet(page);
  await page.keyboard.press("e");
  check((await ahead()) === "", "the key does not hide the end");
  await page.getByRole("button", { name: /^2\. / }).click();
  await quiet(page);
  await backAndForth(page, 4);
  await press(page, "Save");
  await page.getByText("Saved logo-bent.svg in").waitFor();
  await sameByCommand(page, dir, "logo-bent.svg");
});

/** The distances of the round handles from the picture of a path of the background, in px. */
const offTheRim = (page, index) => page.evaluate((index) => {
  const rim = document.querySelectorAll(".outlines path")[index];
  const [m, length] = [rim.getScreenCTM(), rim.getTotalLength()];
  const places = Array.from({ length: 2000 }, (_, i) => rim.getPointAtLength((length * i) / 2000)).map((p) => [m.a * p.x + m.c * p.y + m.e, m.b * p.x + m.d * p.y + m.f]);
  return Array.from(document.querySelectorAll(".knob.node .body"), (body) => {
    const { x, y, width, height } = body.getBoundingClientRect();
    return Math.min(...places.map(([px, py]) => Math.hypot(px - x - width / 2, py - y - height / 2)));
  });
}, index);

/** A badge with a cup over a photographed sign: the sign is moved, scaled and turned, its rim lights up and is clicked, and the badge fills it; then
 * by clicks around a photograph alone. */
export const job_badge_over_a_sign = () => {
  const photograph = execFileSync(program, ["render", sample("badge.svg"), "--width", "240", "--background", "#8ac", "--format", "png", "-o", "-"]);
  const bolts = Array.from({ length: 34 }, (_, i) => `<circle cx="${20 + 8 * i}" cy="8" r="2" fill="#555"/>`).join("");
  const sign = `<svg xmlns="http://www.w3.org/2000/svg" width="320" height="260" viewBox="0 0 320 260"><image x="0" y="0" width="320" height="260" preserveAspectRatio="none" href="data:image/png;base64,${photograph.toString("base64")}"/>
    ${bolts}<path d="M40 130A120 100 0 0 1 280 130A120 100 0 0 1 40 130Z" fill="none" stroke="#c33" stroke-width="6"/></svg>`;
  const badge = execFileSync(program, ["badge", "CUP", "OF 1962", "--center", sample("icons/cup.svg"), "-o", "-"], { encoding: "utf8" });
  return job("badge-over-a-sign", "badge.svg", async (page, dir) => {
    await given(page, "Background", { name: "Sign at Noon.svg", mimeType: "image/svg+xml", buffer: Buffer.from(sign) });
    await page.getByText("Sign at Noon.svg").waitFor();
    await press(page, "Fit");
    const shown = async () => {
      const { x, y, width, height } = await page.locator(".background").boundingBox();
      const view = await page.locator("#view").boundingBox();
      return [x >= view.x && y >= view.y && x + width <= view.x + view.width && y + height <= view.y + view.height, x, y, width];
    };
    const before = await shown();
    check(before[0], "Fit does not show all of the background");
    const knob = async (name) => {
      const { x, y, width, height } = await page.locator(`.lie .part.${name} .body`).boundingBox();
      return [x + width / 2, y + height / 2];
    };
    await pull(page, [before[1] + before[3] / 2, before[2] + before[3] / 3], [30, -20]);
    const moved = await shown();
    check(Math.abs(moved[1] - before[1] - 30) < 1 && Math.abs(moved[2] - before[2] + 20) < 1, `it was moved by ${moved[1] - before[1]}, ${moved[2] - before[2]}`);
    const [corner, other] = [await knob("se"), await knob("nw")];
    await pull(page, corner, [(corner[0] - other[0]) / 4, (corner[1] - other[1]) / 4]);
    const scaled = await shown();
    check(Math.abs(scaled[3] / moved[3] - 1.25) < 0.01 && Math.abs(scaled[1] - moved[1]) < 1, `it is ${scaled[3] / moved[3]} times as wide`);
    await field(page, /^Turn/, "15");
    await press(page, "Use its outline as the shape");
    const rim = page.locator(".outlines path").last();
    // The left end of the rim, in the middle of its stroke.
    const [x, y] = await rim.evaluate((path) => {
      const [p, m] = [path.getPointAtLength(0), path.getScreenCTM()];
      return [m.a * p.x + m.c * p.y + m.e, m.b * p.x + m.d * p.y + m.f];
    });
    await page.mouse.move(x + 60, y + 60);
    check((await page.locator("#stage > .lit").getAttribute("d")) === "", "something is lit off the rim");
    await page.mouse.move(x, y);
    await page.waitForFunction(() => document.querySelector("#stage > .lit").getAttribute("d") !== "");
    await keep(page, "badge-over-a-sign-lit");
    await page.mouse.click(x, y);
    await quiet(page);
    check((await page.locator("#steps").textContent()).includes("Closed shape") && !(await page.isVisible("#problem")), await page.textContent("#problem"));
    const off = await offTheRim(page, 34);
    check(off.length > 3 && Math.max(...off) < 1, `handles are off the rim by ${off.map((d) => d.toFixed(1))} px`);
    check((await page.locator("#toast.on").count()) === 0, "the question is still on show");
    await press(page, "Save");
    await page.getByText("Saved badge-bent.svg in").waitFor();
    check(!readFileSync(join(dir, "badge-bent.svg"), "utf8").includes("#c33"), "the sign is in the result");
    await sameByCommand(page, dir, "badge-bent.svg");
    await backAndForth(page, 1);
    // A photograph alone: points around what it shows.
    await press(page, "Background");
    await given(page, "Another…", { name: "Sign.png", mimeType: "image/png", buffer: photograph });
    await page.getByText("Sign.png").waitFor();
    await quiet(page);
    await press(page, "Use its outline as the shape");
    const { x: bx, y: by, width, height } = await page.locator(".background").boundingBox();
    const clicks = Array.from({ length: 12 }, (_, i) => [bx + width / 2 + 0.3 * width * Math.cos((Math.PI * i) / 6), by + height / 2 + 0.3 * height * Math.sin((Math.PI * i) / 6)]);
    for (const [px, py] of clicks) await page.mouse.click(px, py);
    await page.mouse.click(...clicks[0]);
    await quiet(page);
    const nodes = await page.locator(".knob.node").count();
    check(nodes === 12 && (await page.locator(".knob.control").count()) === 24, `${nodes} points instead of a smooth line through 12`);
  }, badge);
};

/** A sticker: a flag with its cut line 3 mm outside and the bleed beyond that, as SVG and PDF. */
export const job_sticker = () => job("sticker", "badge.svg", async (page, dir) => {
  await press(page, "Flag");
  await press(page, "Add step");
  await press(page, "Contour");
  await field(page, "Distance", "3mm");
  await page.getByText("More settings").click();
  await field(page, "Bleed", "2mm");
  await page.getByRole("button", { name: /^2\. Flag/ }).click();
  await quiet(page);
  check(!(await page.isVisible("#problem")), await page.textContent("#problem"));
  await saved(page, "SVG Can", "sticker.svg");
  await saved(page, "PDF", "sticker.pdf");
  await sameByCommand(page, dir, "sticker.svg");
  check(readFileSync(join(dir, "sticker.pdf")).subarray(0, 5).toString() === "%PDF-", "there is no PDF");
  // Hidden, the contour is in no picture; renamed and duplicated, steps are the same.
  const picture = await paths(page);
  await press(page, "Hide Contour");
  check((await paths(page)) !== picture, "the hidden step is still seen");
  await press(page, "Show Contour");
  await becomes(page, picture, "shown again, it is another");
  await page.getByRole("button", { name: /^2\. Flag/ }).dblclick();
  await page.getByRole("textbox", { name: "Name of Flag" }).fill("Pennant");
  await page.keyboard.press("Enter");
  await page.getByRole("button", { name: /^2\. Pennant/ }).waitFor();
  await quiet(page);
  await press(page, "Duplicate Pennant");
  check((await page.getByRole("list").getByRole("button", { name: /^[0-9]\. / }).allTextContents()).join() === "1. Contour,2. Pennant,3. Pennant", "there is no second one");
  await press(page, "Undo");
  await becomes(page, picture, "the second one cannot be undone");
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
  await setWords(page, "Words…", { Text: "Harbour" });
  await page.getByRole("heading", { name: "harbour.svg" }).waitFor();
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
  await page.getByRole("button", { name: /^(Set words|New drawing)$/ }).click();
  await quiet(page);
  check((await paths(page)) !== bent && (await page.locator("#steps").textContent()).includes("Bend"), "the bend is gone, or the words are as before");
  await backAndForth(page, 3);
  await saved(page, "SVG Can", "sign.svg");
  const picture = await paths(page);
  await openedAgain(editor, join(dir, "sign.svg"), async (page2) => {
    await becomes(page2, picture, "opened again, it is another drawing");
    await setWords(page2, "Edit words…", { Text: "Harbour Coffee" });
    check((await paths(page2)) !== picture, "the words cannot be changed");
    await press(page2, "Undo");
    await becomes(page2, picture, "the words cannot be undone");
    await page2.getByText("Saved as sign.svg").waitFor();
  });
});

/** Puts words on the drawing at a share of the sheet, and types them. */
const typed = async (page, button, [x, y], words) => {
  await page.getByRole("button", { name: button }).click();
  await page.getByRole("button", { name: "Place on the drawing" }).click();
  const sheet = await page.locator("#stage .sheet").boundingBox();
  await page.mouse.click(sheet.x + x * sheet.width, sheet.y + y * sheet.height);
  await page.getByRole("textbox", { name: "Words on the drawing" }).waitFor();
  await page.keyboard.type(words);
  await page.keyboard.press("Escape");
  await quiet(page);
};
/** The pixels of a picture that have a colour, as their number and the box around them in shares of the picture. */
const coloured = (page, file, [r, g, b]) => page.evaluate(async ([data, wanted]) => {
  const image = new Image();
  image.src = `data:image/jpeg;base64,${data}`;
  await image.decode();
  const canvas = Object.assign(document.createElement("canvas"), { width: image.width, height: image.height });
  const context = canvas.getContext("2d");
  context.drawImage(image, 0, 0);
  const { data: pixels } = context.getImageData(0, 0, image.width, image.height);
  const found = [];
  for (let i = 0; i < pixels.length; i += 4) if (wanted.every((v, k) => Math.abs(pixels[i + k] - v) < 60)) found.push(i / 4);
  const [xs, ys] = [found.map((i) => (i % image.width) / image.width), found.map((i) => Math.floor(i / image.width) / image.height)];
  const ends = (all) => [all.reduce((a, v) => Math.min(a, v), 1), all.reduce((a, v) => Math.max(a, v), 0)];
  return { count: found.length, x: ends(xs), y: ends(ys), width: image.width, height: image.height };
}, [readFileSync(file).toString("base64"), [r, g, b]]);

/** A caption is typed on a photograph, both are bent, and go out as JPEG and PDF; the saved file has the caption as words. */
export const job_captioned_photograph = () => {
  const photograph = execFileSync(program, ["render", sample("badge.svg"), "--width", "300", "--background", "#8ac", "--format", "jpg", "-o", "-"]);
  return job("captioned", "badge.svg", async (page, dir, editor) => {
    writeFileSync(join(dir, "seaside.jpg"), photograph);
    await given(page, "Open…", join(dir, "seaside.jpg"));
    await page.getByRole("heading", { name: "seaside.jpg" }).waitFor();
    await quiet(page);
    await typed(page, "Words…", [0.5, 0.95], "Seaside");
    await field(page, "Colour", "#ff00ff");
    await page.getByRole("radio", { name: "Center" }).locator("..").click();
    await page.getByRole("combobox", { name: "Weight" }).selectOption({ label: "Bold" });
    await quiet(page);
    await saved(page, "JPEG", "level.jpg");
    const level = await coloured(page, join(dir, "level.jpg"), [255, 0, 255]);
    check(level.width === 300 && level.count > 500, `${level.count} pixels are of the caption's colour`);
    check(Math.abs(level.x[0] + level.x[1] - 1) < 0.04, `it is centred at ${(level.x[0] + level.x[1]) / 2}`);
    check(level.y[1] > 0.92 && level.y[1] < 0.98 && level.y[0] > 0.84, `it stands from ${level.y[0]} to ${level.y[1]}`);
    await press(page, "Flag");
    await field(page, "Bend", "20");
    await saved(page, "JPEG", "bent.jpg");
    const bent = await coloured(page, join(dir, "bent.jpg"), [255, 0, 255]);
    const rise = (of) => (of.y[1] - of.y[0]) * of.height;
    check(bent.count > 500 && rise(bent) > 1.3 * rise(level), `the caption rises over ${rise(bent)} px, level over ${rise(level)}`);
    await saved(page, "PDF", "bent.pdf");
    const pdf = readFileSync(join(dir, "bent.pdf"), "latin1");
    check(pdf.startsWith("%PDF") && pdf.includes("/Image"), "the PDF has no photograph");
    await backAndForth(page, 6);
    await saved(page, "SVG Can", "seaside.svg");
    const picture = await paths(page);
    await openedAgain(editor, join(dir, "seaside.svg"), async (page2) => {
      await becomes(page2, picture, "opened again, it is another drawing");
      await press(page2, "1. “Seaside”");
      await page2.getByRole("textbox", { name: "Words", exact: true }).click({ clickCount: 3 });
      await page2.keyboard.type("Seaside 1962");
      await page2.keyboard.press("Tab");
      await quiet(page2);
      await press(page2, "2. Flag");
      check((await paths(page2)).length > picture.length, "the words cannot be changed");
      await press(page2, "Undo");
      await becomes(page2, picture, "the words cannot be undone");
    });
  });
};

/** Three lines in a heart: no letter leaves it, and each line fills it. */
export const job_heart = () => job("heart", "logo.svg", async (page) => {
  await setWords(page, "Words…", { Text: "LOVE\nMUSIC\nALWAYS" });
  await press(page, "Heart shape");
  const { count, off, rows } = await page.evaluate(() => {
    const heart = document.createElementNS("http://www.w3.org/2000/svg", "path");
    heart.setAttribute("d", Array.from(document.querySelectorAll("#stage .guides .line.path"), (l, i) => l.getAttribute("d").replace(/^M/, i === 0 ? "M" : "L")).join(" "));
    document.querySelector("#stage").append(heart);
    heart.style.strokeWidth = "6px";
    heart.style.stroke = "#000";
    const { x, y } = document.querySelector("#stage").getBoundingClientRect();
    const letters = Array.from(document.querySelectorAll("#stage .art:not([visibility=hidden]) path"));
    const points = letters.map((letter) => {
      const [length, to] = [letter.getTotalLength(), letter.getScreenCTM()];
      return Array.from({ length: 60 }, (_, i) => letter.getPointAtLength((i / 60) * length).matrixTransform(to)).map((p) => new DOMPoint(p.x - x, p.y - y));
    });
    const out = points.flat().filter((p) => !heart.isPointInFill(p) && !heart.isPointInStroke(p));
    heart.remove();
    return { count: letters.length, off: out.length, rows: new Set(letters.map((l) => l.parentElement)).size };
  });
  check(count === 15 && rows === 3, `${count} letters in ${rows} lines`);
  check(off === 0, `${off} places of letters are outside of the heart`);
  await backAndForth(page, 1);
});

/** A photograph with a caption: both follow the flag, are saved, and are there again. */
export const job_photograph = () => {
  const photograph = execFileSync(program, ["render", sample("badge.svg"), "--width", "300", "--background", "#8ac", "--format", "png", "-o", "-"]).toString("base64");
  const card = `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 360 380"><image id="photo" x="30" y="20" width="300" height="300" href="data:image/png;base64,${photograph}"/>
    <text id="caption" x="180" y="352" font-family="Noto Sans" font-size="26" text-anchor="middle" fill="#333">Seaside, 1962</text></svg>`;
  return job("photograph", "card.svg", async (page, dir, editor) => {
    const looks = () => page.evaluate(() => {
      const art = document.querySelector("#stage .art:not([visibility=hidden])");
      return [art.querySelector("image").outerHTML, Array.from(art.querySelectorAll("path"), (p) => p.getAttribute("d")).join()];
    });
    const before = await looks();
    await press(page, "Flag");
    await field(page, "Bend", "40");
    const bent = await looks();
    check(bent[0] !== before[0], "the photograph does not follow");
    check(bent[1] !== before[1], "the caption does not follow");
    await backAndForth(page, 2);
    check((await looks()).join() === bent.join(), "redone, it looks different");
    await press(page, "Save");
    await page.getByText("Saved card-bent.svg in").waitFor();
    const picture = await paths(page);
    await openedAgain(editor, join(dir, "card-bent.svg"), async (page2) => {
      await becomes(page2, picture, "opened again, it is another drawing");
      // The photograph alone.
      await given(page2, "Open…", { name: "badge.png", mimeType: "image/png", buffer: Buffer.from(photograph, "base64") });
      await page2.getByRole("heading", { name: "badge.png" }).waitFor();
      await quiet(page2);
      await press(page2, "Arch");
      await keep(page2, "photograph-alone");
      await press(page2, "Save");
      await page2.getByText("Saved badge-bent.svg in").waitFor();
      check(page2.problems.length === 0, page2.problems.join("; "));
    });
  }, card);
};

/** A photograph beside the drawing, whose caption alone follows the flag: it is on the canvas, in the original, in small pictures and in the
 * PNG, as the browser shows the drawing; a photograph alone is offered as a picture of its own size. */
export const job_linked_photograph = () => {
  const photograph = execFileSync(program, ["render", sample("badge.svg"), "--width", "300", "--background", "#8ac", "--format", "png", "-o", "-"]);
  const card = `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 360 380" width="360" height="380"><image id="photo" x="30" y="20" width="300" height="300" href="a%20photo.png"/>
    <text id="caption" x="180" y="352" font-family="Noto Sans" font-size="26" text-anchor="middle" fill="#333">Seaside, 1962</text></svg>`;
  return job("linked-photograph", "card.svg", async (page, dir, editor) => {
    writeFileSync(join(dir, "a photo.png"), photograph);
    await page.reload();
    await page.waitForSelector("#stage .art image", { state: "attached" });
    // The mean colours of a picture of the card at places of its photograph.
    const colours = (url) => page.evaluate(async (src) => {
      const image = Object.assign(new Image(), { src });
      await image.decode();
      const canvas = Object.assign(document.createElement("canvas"), { width: 360, height: 380 });
      canvas.getContext("2d").drawImage(image, 0, 0, 360, 380);
      const at = (x, y) => {
        const { data } = canvas.getContext("2d").getImageData(x - 6, y - 6, 13, 13);
        return [0, 1, 2, 3].map((k) => data.reduce((sum, v, i) => sum + (i % 4 === k ? v : 0), 0) / 169);
      };
      return [[40, 40], [180, 170], [180, 60], [90, 170]].map(([x, y]) => at(x, y));
    }, url);
    const data = (type, bytes) => `data:${type};base64,${Buffer.from(bytes).toString("base64")}`;
    const truth = await colours(data("image/svg+xml", card.replace("a%20photo.png", data("image/png", photograph))));
    const isPhotograph = (found, what) => {
      const far = Math.max(...found.flatMap((c, i) => c.map((v, k) => Math.abs(v - truth[i][k]))));
      check(far < 24 && truth[0][2] > 190, `${what}: ${JSON.stringify(found)}, not ${JSON.stringify(truth)}`);
    };
    const shown = async () => (await page.locator("#stage .art:not([visibility=hidden]) image").first().getAttribute("xlink:href")) ?? "";
    check((await shown()).startsWith("data:image/png"), "the canvas lacks the photograph");
    await press(page, "Flag");
    const small = page.locator(".card:not(.bare) img[src^=blob]").first();
    await small.waitFor({ state: "attached" });
    const blue = await small.evaluate(async (image) => {
      await image.decode();
      const canvas = Object.assign(document.createElement("canvas"), { width: 100, height: 100 });
      canvas.getContext("2d").drawImage(image, 0, 0, 100, 100);
      const { data } = canvas.getContext("2d").getImageData(0, 0, 100, 100);
      return data.filter((v, i) => i % 4 === 2 && v > 190 && data[i - 2] < 150).length;
    });
    check(blue > 500, `small pictures lack the photograph: ${blue} of its pixels`);
    await page.getByRole("button", { name: "Undo", exact: true }).click();
    await quiet(page);
    // Small pictures of the shapes above it take long.
    await page.getByPlaceholder("Find a shape").fill("Turn and scale");
    await press(page, "Turn and scale");
    check((await shown()).startsWith("data:image/png"), "the turned drawing lacks the photograph");
    await saved(page, "PNG", "card.png");
    isPhotograph(await colours(data("image/png", readFileSync(join(dir, "card.png")))), "the PNG");
    await saved(page, "SVG ", "card-bent.svg");
    check(readFileSync(join(dir, "card-bent.svg"), "utf8").includes('href="a%20photo.png"'), "the link is another");
    await given(page, "Open…", { name: "badge.png", mimeType: "image/png", buffer: photograph });
    await page.getByRole("heading", { name: "badge.png" }).waitFor();
    await quiet(page);
    await press(page, "Turn and scale");
    await saved(page, "PNG", "badge-turned.png");
    check(readFileSync(join(dir, "badge-turned.png")).readUInt32BE(16) === 300, "the picture has not its own size");
  }, card);
};

/** Thirty steps of every kind are undone and redone, each with the picture that it had, with the page loaded anew on the way there and back. */
export const job_undone_and_redone = () => job("twenty", "logo.svg", async (page, dir, editor) => {
  await setWords(page, "Words…", { Text: "Harbour" });
  const corner = async () => at(page, (await page.locator(".knob.node").last().getAttribute("aria-label")));
  const add = async (name) => {
    await press(page, "Add step");
    await press(page, name);
  };
  const between = async (a, b) => {
    const [[ax, ay], [bx, by]] = [await at(page, a), await at(page, b)];
    return [(ax + bx) / 2, (ay + by) / 2];
  };
  const caption = async (name, change) => {
    await page.getByRole("list").getByRole("button", { name: new RegExp(`^[0-9]+\\. ${name}$`) }).click();
    await quiet(page);
    await change();
    await quiet(page);
  };
  const steps = [
    () => press(page, "Bend"),
    async () => {
      await page.getByRole("button", { name: "Draw circle" }).first().click();
      const { x, y, width, height } = await page.locator("#stage .sheet").boundingBox();
      await pull(page, [x + width / 2, y + height / 2 + 40], [width / 3, 0]);
    },
    () => setWords(page, "Edit words…", { Text: "Haven", Spacing: "10" }),
    () => add("Flag"),
    () => field(page, "Bend", "20+5"),
    () => setWords(page, "Edit words…", { Size: "25" }),
    () => add("Perspective"),
    async () => pull(page, await corner(), [-40, -30]),
    () => add("Cage"),
    async () => pull(page, await at(page, "Cage, point 3"), [-50, 0]),
    () => add("Pins"),
    async () => pull(page, await at(page, "Pair 5, where it goes"), [10, 15]),
    async () => {
      const [x, y] = await at(page, "Pair 5, where it goes");
      await page.mouse.dblclick(x + 60, y);
      await quiet(page);
    },
    async () => {
      await page.mouse.click(...(await at(page, "Pair 1, where it goes")));
      await press(page, "Remove point");
    },
    () => press(page, "Grid"),
    async () => pull(page, await between("Control point 1,1", "Control point 2,1"), [0, -30]),
    async () => {
      await page.mouse.dblclick(...(await between("Control point 0,0", "Control point 1,0")));
      await quiet(page);
    },
    () => press(page, "Move Grid up"),
    () => add("Bulge"),
    async () => {
      await page.getByText("This step bends everything.").click();
      await page.getByRole("button", { name: "Path “v”", exact: true }).click();
      await quiet(page);
    },
    () => press(page, "Remove Perspective"),
    () => typed(page, "Edit words…", [0.1, 0.9], "Since"),
    () => caption("“Since”", () => field(page, "Colour", "#c30")),
    () => caption("“Since”", () => page.getByRole("combobox", { name: "Weight" }).selectOption({ label: "Bold" })),
    () => caption("“Since”", () => page.getByRole("switch", { name: "Italic" }).locator("..").click()),
    () => typed(page, "Edit words…", [0.6, 0.1], "1887"),
    () => caption("“1887”", async () => pull(page, await at(page, "At"), [-20, 10])),
    () => caption("“1887”", () => field(page, "Size", "20")),
    () => caption("“1887”", async () => {
      await page.mouse.dblclick(...(await at(page, "At")));
      await page.keyboard.type("1887\nand on");
      await page.keyboard.press("Escape");
    }),
    () => caption("“1887 and on”", () => page.getByRole("radio", { name: "Right" }).locator("..").click()),
    () => caption("“1887 and on”", () => field(page, "Line spacing", "90")),
  ];
  // All steps are seen while the last one is being changed.
  const last = async () => {
    if (!(await page.getByText("so that you see what you drag").isVisible())) return;
    await page.getByRole("list").getByRole("button", { name: /^[0-9]+\. / }).last().click();
    await quiet(page);
  };
  const seen = [await paths(page)];
  for (const [i, step] of steps.entries()) {
    await step();
    await last();
    seen.push(await paths(page));
    check(!(await page.isVisible("#problem")), `step ${i + 1}: ${await page.textContent("#problem")}`);
  }
  await saved(page, "SVG Can", "before.svg");
  check(new Set(seen).size > 15, "too little is seen of the steps");
  for (let i = steps.length - 1; i >= 0; i--) {
    await page.getByRole("button", { name: "Undo", exact: true }).click();
    if (i === 9) await reload(page);
    await becomes(page, seen[i], `undone, step ${i + 1} leaves something behind`);
  }
  check(await page.getByRole("button", { name: "Undo", exact: true }).isDisabled(), "there is more to undo");
  for (let i = 1; i <= steps.length; i++) {
    await page.getByRole("button", { name: "Redo", exact: true }).click();
    if (i === 11) await reload(page);
    await becomes(page, seen[i], `redone, step ${i} is another`);
  }
  await saved(page, "SVG Can", "after.svg");
  const bytes = (name) => readFileSync(join(dir, name), "utf8");
  check(bytes("after.svg") === bytes("before.svg"), "what was undone and redone is saved as something else");
  await openedAgain(editor, join(dir, "after.svg"), async (page2) => {
    await becomes(page2, seen[steps.length], "opened again, it is another drawing");
    await saved(page2, "SVG Can", "again.svg");
    check(bytes("again.svg") === bytes("before.svg"), "opened again, it is saved as something else");
  });
});
