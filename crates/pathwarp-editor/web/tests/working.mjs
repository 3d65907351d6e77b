// An hour of real work: corners of cages, undo, fields. Real mouse moves and real keys.
import { execFileSync } from "node:child_process";
import { readFileSync, rmSync } from "node:fs";
import { becomes, changes, check, choose, drag, edit, folder, keys, middle, open, paths, program, quiet, sample, stepOf, withoutPause } from "./harness.mjs";

async function within(shape, test, options = {}) {
  const dir = folder({ "logo.svg": sample("logo.svg") });
  const editor = await edit(`${dir}/logo.svg`);
  const page = await open(editor.address, options);
  try {
    if (shape) await choose(page, shape);
    await test(page, dir, editor);
    check(page.problems.length === 0, page.problems.join("; "));
  } finally {
    editor.stop();
    await page.context().close();
  }
}

const places = async (page, all) => Object.fromEntries(await Promise.all(all.map(async (k) => [k, await middle(page, k)])));
const steps = (page) => page.$$eval("#steps .step", (all) => all.map((b) => b.textContent.replace(/^\d+\. /, "")));
const value = (page, id) => page.inputValue(`#${id}`);
const focused = (page) => page.evaluate(() => document.activeElement.getAttribute("aria-label") ?? document.activeElement.textContent);

/** A bottle's neck: both upper corners are pulled in. Straight sides stay straight with their handles at the thirds, and nothing folds. */
export const corners_take_their_handles_along = () => within(null, async (page) => {
  await page.click("#mirror");
  const all = await keys(page);
  const corners = all.filter((k) => !/(in|out)$/.test(k));
  const before = await places(page, corners);
  const top = corners.filter((k) => before[k][1] < before[corners[0]][1] - 20).sort((a, b) => before[a][0] - before[b][0]);
  check(corners.length === 4 && top.length === 2, `${all}`);
  const wide = before[top[1]][0] - before[top[0]][0];
  await drag(page, top[0], 0.35 * wide, 0);
  check(!(await page.isVisible("#folds")), await page.textContent("#folds"));
  const after = await places(page, all);
  corners.forEach((k, n) => {
    const next = corners[(n + 1) % 4];
    const [a, b] = [after[k], after[next]];
    for (const [handle, t] of [[`${k}/out`, 1 / 3], [`${next}/in`, 2 / 3]]) {
      const [x, y] = [a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])];
      const off = Math.hypot(after[handle][0] - x, after[handle][1] - y);
      check(off < 1, `${handle} is ${off} px from its third`);
    }
  });
  check(Math.abs(after[top[1]][0] - after[top[0]][0] - 0.3 * wide) < 12, "the other corner did not follow");
  // A node that is smooth carries its handles as they are.
  await page.click("#mirror");
});

/** A point that is added with symmetry on has its reflection, which moves and goes with it. */
export const symmetry_holds_for_added_points = () => within("Envelope", async (page) => {
  await page.click("#mirror");
  const all = await keys(page);
  const [[ax, ay], [bx]] = [await middle(page, "top/0.0/0"), await middle(page, "top/0.0/1")];
  await page.mouse.dblclick(ax + 0.25 * (bx - ax), ay);
  await quiet(page);
  const nodes = (list) => list.filter((k) => /^top\/0\.0\/\d+$/.test(k));
  check(nodes(await keys(page)).length === 4, `${await keys(page)}`);
  await drag(page, "top/0.0/1", 20, -40);
  const { "top/0.0/1": [lx, ly], "top/0.0/2": [rx, ry] } = await places(page, ["top/0.0/1", "top/0.0/2"]);
  check(Math.abs(ly - ry) < 1 && Math.abs(lx + rx - ax - bx) < 2, `${[lx, ly, rx, ry]}`);
  await page.locator('.knob[data-key="top/0.0/1"]').focus();
  await page.keyboard.press("Delete");
  await quiet(page);
  check((await keys(page)).length === all.length, `${await keys(page)}`);
  check((await page.evaluate(() => document.activeElement.dataset.key ?? "")).startsWith("top/"), "the focus has not stayed near");
});

/** Everything can be undone, and redone, over and over. */
export const undo_is_whole = () => within("Arc", async (page) => {
  const pictures = [await paths(page)];
  await drag(page, "bend", 0, -40);
  pictures.push(await paths(page));
  await page.click("#start-over");
  await quiet(page);
  check((await focused(page)) === "Undo", `the focus is on ${await focused(page)}`);
  await page.keyboard.press("Control+z");
  await becomes(page, pictures[1], "Start over is not undone");
  check((await steps(page)).join() === "Arc", `${await steps(page)}`);
  await page.click('#steps [aria-label="Remove Arc"]');
  await quiet(page);
  for (let i = 0; i < 3; i++) {
    await page.click("#undo");
    await becomes(page, pictures[1], "removing the only step is not undone");
    await page.click("#undo");
    await becomes(page, pictures[0], "the chain sticks");
    await page.click("#undo");
    await quiet(page);
    check(await page.isDisabled("#undo"), "there is more to undo than was done");
    for (let k = 0; k < 3; k++) {
      await page.click("#redo");
      await quiet(page);
    }
  }
});

/** Ctrl Z during a drag takes that drag back and nothing else, of a handle and of a slider; Escape does, too. */
export const undo_during_a_drag = () => within("Arc", async (page) => {
  await drag(page, "bend", 0, -30);
  const before = await paths(page);
  const [x, y] = await middle(page, "bend");
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x, y + 70, { steps: 6 });
  await page.keyboard.press("Control+z");
  await page.mouse.move(x, y + 90, { steps: 4 });
  await page.mouse.up();
  await quiet(page);
  await becomes(page, before, "the drag alone was to be taken back");
  const shown = await value(page, "set-bend");
  for (const key of ["Control+z", "Escape"]) {
    const box = await page.locator("#set-bend-slider").boundingBox();
    const at = await page.$eval("#set-bend-slider", (s) => (s.value - s.min) / (s.max - s.min));
    await page.mouse.move(box.x + 8 + at * (box.width - 16), box.y + box.height / 2);
    await page.mouse.down();
    await page.mouse.move(box.x + box.width * 0.2, box.y + box.height / 2, { steps: 6 });
    await page.waitForFunction((was) => document.querySelector("#set-bend").value !== was, shown);
    await page.keyboard.press(key);
    await page.mouse.move(box.x + box.width * 0.3, box.y + box.height / 2, { steps: 3 });
    await page.mouse.up();
    await quiet(page);
    await becomes(page, before, `${key}: the slider was to be taken back`);
    check((await value(page, "set-bend")) === shown, `${key}: ${await value(page, "set-bend")} instead of ${shown}`);
  }
});

/** Keys on a slider and in a field are one change. */
export const slider_keys_are_one_change = () => within("Arc", async (page) => {
  const before = await paths(page);
  for (const id of ["set-bend-slider", "set-bend"]) {
    await page.focus(`#${id}`);
    await withoutPause(page, async () => {
      for (let i = 0; i < 6; i++) await page.keyboard.press(id === "set-bend" ? "Shift+ArrowUp" : "ArrowRight");
      await changes(page, before);
    });
    await page.click("#undo");
    await becomes(page, before, `keys in ${id} are more than one change`);
  }
});

/** After a step is removed, the last is selected, and the focus is in the list. */
export const removing_a_step = () => within("Arc", async (page) => {
  for (const name of ["Flag", "Rise"]) {
    await page.click("#add-step");
    await choose(page, name);
  }
  await page.click('#steps [aria-label="Remove Arc"]');
  await quiet(page);
  check((await steps(page)).join() === "Flag,Rise", `${await steps(page)}`);
  check((await page.textContent("#steps [aria-current]")).includes("Rise"), "the last step is not selected");
  check((await focused(page)) === "Remove Flag", `the focus is on ${await focused(page)}`);
  await page.keyboard.press("Enter");
  await quiet(page);
  check((await steps(page)).join() === "Rise" && (await focused(page)) === "Remove Rise", `the focus is on ${await focused(page)}`);
});

/** Plain numbers in the unit shown, sums, keys, and a word beside what is wrong. */
export const fields_of_numbers = () => within("Arc", async (page) => {
  const unit = () => page.$eval("#set-bend", (f) => f.nextElementSibling.textContent);
  const type = async (text, key = "Enter") => {
    await page.click("#set-bend", { clickCount: 3 });
    await page.keyboard.type(text);
    await page.keyboard.press(key);
    await quiet(page);
  };
  check((await value(page, "set-bend")) === "50" && (await unit()) === "%", `${await value(page, "set-bend")} ${await unit()}`);
  await type("30");
  const thirty = await paths(page);
  await type("20");
  check((await paths(page)) !== thirty, "a plain number does nothing");
  await type("20+2*5");
  check((await value(page, "set-bend")) === "30", await value(page, "set-bend"));
  await becomes(page, thirty, "the sum is another value");
  await page.keyboard.press("Shift+ArrowDown");
  await page.keyboard.press("ArrowUp");
  check((await value(page, "set-bend")) === "21", await value(page, "set-bend"));
  await type("77", "Escape");
  check((await value(page, "set-bend")) === "21", "Escape does not cancel");
  const wrong = () => page.textContent("#set-bend-wrong");
  for (const text of ["abc", "3 mm", "1/0", "30%%"]) {
    await type(text);
    check((await value(page, "set-bend")) === text && /^A number.* %/.test(await wrong()), `${text}: ${await wrong()}`);
    check(!(await page.isVisible("#problem")), await page.textContent("#problem"));
  }
  await page.click("#set-bend", { clickCount: 3 });
  await page.keyboard.type("3");
  check(!(await page.isVisible("#set-bend-wrong")), "the word stays when the value is right");
  // The field follows the handle.
  await page.keyboard.press("Escape");
  const [x, y] = await middle(page, "bend");
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x, y - 30, { steps: 5 });
  await page.waitForFunction(() => document.querySelector("#set-bend").value !== "21");
  const during = [await value(page, "set-bend"), await page.inputValue("#set-bend-slider")].map(Number);
  await page.mouse.up();
  check(during[0] !== 21 && Math.abs(during[0] - during[1]) < 1, `${during} during the drag`);
});

/** Lengths have the unit that is typed; places may be shares of the box; what the program refuses is said in the words of the page. */
export const fields_of_lengths_and_places = () => within(null, async (page) => {
  await choose(page, "Wave (effect)");
  const type = async (id, text) => {
    await page.click(`#${id}`, { clickCount: 3 });
    await page.keyboard.type(text);
    await page.keyboard.press("Enter");
    await quiet(page);
  };
  await type("set-height", "2 mm + 1cm");
  const unit = await page.$eval("#set-height", (f) => f.nextElementSibling.textContent);
  check((await value(page, "set-height")) === "12" && unit === "mm", `${await value(page, "set-height")} ${unit}`);
  await choose(page, "Grid");
  await page.locator('.knob[data-key="at/5"]').focus();
  await type("place-x", "50%");
  check((await value(page, "place-x")) !== "50%" && !(await page.isVisible("#place-x-wrong")), await value(page, "place-x"));
  await type("place-x", "high");
  check(/^A number/.test(await page.textContent("#place-x-wrong")), "no word about a wrong place");
  await page.keyboard.press("Escape");
  await page.click("#settings summary").catch(() => {});
  await type("set-degree", "3xx");
  const said = await page.textContent("#set-degree-wrong");
  check(/such as 3x2/.test(said) && !/--|`/.test(said) && (await value(page, "set-degree")) === "3xx", said);
});

/** Places along the paths of the picture, in px of the screen. */
const outline = (page) => page.$$eval("#stage .art:not([visibility=hidden]) path", (all) => all.flatMap((p) => {
  const [length, m] = [p.getTotalLength(), p.getScreenCTM()];
  return Array.from({ length: 200 }, (_, i) => p.getPointAtLength((i / 200) * length).matrixTransform(m)).map(({ x, y }) => [x, y]);
}));

/** A pin that is added to bent artwork takes hold of what lies under the pointer: that stays, and then follows the pin. */
export const pins_take_hold = () => within("Pins", async (page) => {
  await drag(page, "pair/4/1", 60, 70);
  const before = await outline(page);
  const away = ([x, y], ps) => Math.min(...ps.map((p) => Math.hypot(p[0] - x, p[1] - y)));
  const knobs = await Promise.all((await keys(page)).map((k) => middle(page, k)));
  const pinned = await middle(page, "pair/4/1");
  // A place of the outline that the first pin has moved, clear of all handles.
  const at = before.filter((p) => away(p, knobs) > 40).sort((p, q) => away(p, [pinned]) - away(q, [pinned]))[0].map(Math.round);
  await page.mouse.dblclick(...at);
  await quiet(page);
  const { "pair/5/0": source, "pair/5/1": target } = await places(page, ["pair/5/0", "pair/5/1"]);
  check(away(target, [at]) < 1, `the pin is at ${target}, not ${at}`);
  check(away(source, [at]) > 15, "the pin's source is the place of the click");
  const after = await outline(page);
  check(away(at, after) < 2, `what the pin holds has moved by ${away(at, after)} px`);
  check(!(await page.isVisible("#folds")), "the picture folds");
  const off = Math.max(...after.map((p) => away(p, before)));
  check(off < 20, `the picture moves by ${off} px`);
  await drag(page, "pair/5/1", 40, -25);
  const place = await middle(page, "pair/5/1");
  check(away(place, await outline(page)) < 2, "the artwork does not follow the pin");
  await page.click("#undo");
  await page.click("#undo");
  await quiet(page);
  check(!(await keys(page)).includes("pair/5/0"), "undo does not take the pin away");
});

/** A grid keeps its shape when its degree grows, and when a row or a column is added by a double click on a line of it. */
export const grids_keep_their_shape = () => within("Grid", async (page) => {
  await drag(page, "at/5", 30, 60);
  await drag(page, "at/10", -50, 20);
  const [before, count] = [await outline(page), (await keys(page)).length];
  const same = async (what) => {
    const now = await outline(page);
    const off = Math.max(...now.map((p) => Math.min(...before.map((q) => Math.hypot(p[0] - q[0], p[1] - q[1])))));
    check(off < 3, `${what} moves the picture by ${off} px`);
  };
  const [[ax, ay], [bx, by]] = [await middle(page, "at/0"), await middle(page, "at/1")];
  await page.mouse.dblclick((ax + bx) / 2, (ay + by) / 2);
  await quiet(page);
  check((await keys(page)).length === count + 4, `${(await keys(page)).length} points after a column was added`);
  await same("a column");
  const [[cx, cy], [dx, dy]] = [await middle(page, "at/0"), await middle(page, "at/5")];
  await page.mouse.dblclick((cx + dx) / 2, (cy + dy) / 2);
  await quiet(page);
  check((await keys(page)).length === 25, `${(await keys(page)).length} points after a row was added`);
  await same("a row");
  await page.locator("#settings summary").click();
  await page.click("#set-degree", { clickCount: 3 });
  await page.keyboard.type("5x6");
  await page.keyboard.press("Enter");
  await quiet(page);
  check((await keys(page)).length === 42, `${(await keys(page)).length} points`);
  await same("a degree");
  await page.click("#set-degree", { clickCount: 3 });
  await page.keyboard.type("3x3");
  await page.keyboard.press("Enter");
  await quiet(page);
  check((await keys(page)).length === 16, "the grid does not shrink");
  await same("the nearest smaller net, which is the first one,");
  for (let i = 0; i < 4; i++) await page.keyboard.press("Control+z");
});

/** A grid of a lower degree is the nearest there is, and a line says how far it has moved: an arch 2h·t(1 − t) high, of which a level line at h/3 is
 * nearest, is off by h/3 at its ends. */
export const a_lower_degree_says_how_far_it_moves = () => within("Grid", async (page) => {
  const degree = async (text) => {
    await page.click("#set-degree", { clickCount: 3 });
    await page.keyboard.type(text);
    await page.keyboard.press("Enter");
    await quiet(page);
  };
  await page.locator("#settings summary").click();
  await degree("2x1");
  const before = await middle(page, "at/4");
  await drag(page, "at/1", 0, -60);
  await drag(page, "at/4", 0, -60);
  const [after, zoom] = [await middle(page, "at/4"), Number.parseFloat(await page.textContent("#zoom")) / 100];
  await degree("1x1");
  const said = await page.locator("#toast.on", { hasText: "so few points cannot hold it" }).textContent();
  const [mm, wanted] = [Number(/by up to ([\d.]+) mm/.exec(said)[1]), ((before[1] - after[1]) / zoom / 3) * (25.4 / 96)];
  // The nearest one is found over some dozen places.
  check(Math.abs(mm - wanted) < 0.08 * wanted, `${said}, and ${wanted} mm are right`);
});

/** Letters move together until they lie upon each other, and in no other order. */
export const spacing_ends_where_letters_would_pass_each_other = () => within(null, async (page) => {
  const lefts = async (spacing) => {
    await page.click("#words");
    await page.fill("#words-text", "nnnn");
    await page.fill("#words-spacing", spacing);
    await page.getByRole("button", { name: /^(Set words|New drawing)$/ }).click();
    await page.getByRole("dialog").waitFor({ state: "hidden" });
    await quiet(page);
    return page.$$eval("#stage .art:not([visibility=hidden]) path", (all) => all.map((p) => p.getBoundingClientRect().left));
  };
  const [near, ended] = [await lefts("-40"), await lefts("-150")];
  check(near.every((x, i) => i === 0 || x > near[i - 1]), `at -40 %: ${near}`);
  check(ended.length === 4 && ended.every((x) => Math.abs(x - ended[0]) < 0.5), `at -150 %: ${ended}`);
});

/** The same for a triangular net. */
export const triangles_keep_their_shape = () => within("Triangle net", async (page) => {
  await drag(page, "at/3", 40, 20);
  const [before, count] = [await outline(page), (await keys(page)).length];
  await page.click("#set-degree", { clickCount: 3 });
  await page.keyboard.type("4");
  await page.keyboard.press("Enter");
  await quiet(page);
  await page.keyboard.press("ArrowUp");
  await quiet(page);
  check((await keys(page)).length === 21, `degree 5 has ${(await keys(page)).length} points`);
  const off = Math.max(...(await outline(page)).map((p) => Math.min(...before.map((q) => Math.hypot(p[0] - q[0], p[1] - q[1])))));
  check((await keys(page)).length > count && off < 3, `${off} px off, ${count} points before`);
});

/** After Fit, every handle is in view and under nothing; Tab brings one that is out of sight there. */
const allInView = (page) => page.evaluate(() => Array.from(document.querySelectorAll(".knob")).filter((knob) => {
  const { x, y, width, height } = knob.querySelector(".body").getBoundingClientRect();
  const corners = [[x, y], [x + width, y], [x, y + height], [x + width, y + height]];
  return !corners.every(([cx, cy]) => document.elementFromPoint(cx, cy)?.closest("#stage"));
}).map((k) => k.dataset.key));
const fits = (width, height) => within(null, async (page) => {
  for (const [shape, section] of [["Möbius", ""], ["Triangle net", ""], ["Swirl", ""], ["Grid", ""], ["Ring", ""], ["Bulge (effect)", ""]]) {
    if (width <= 900) await page.click("#open-shapes");
    await choose(page, shape, section);
    await page.click("#fit");
    await quiet(page);
    const out = await allInView(page);
    check(out.length === 0, `${shape}: ${out} cannot be seen`);
  }
  for (let i = 0; i < 8; i++) await page.click("#zoom-in");
  await page.locator(".knob").first().focus();
  await page.keyboard.press("Tab");
  await page.keyboard.press("Shift+Tab");
  const key = await page.evaluate(() => document.activeElement.dataset.key);
  check(key && !(await allInView(page)).includes(key), `${key} is out of sight`);
  const parts = await page.$$eval("#saved, #tools, #tools button, header button", (all) => all.filter((e) => e.offsetParent).map((e) => [e.id || e.title, e.scrollWidth - e.clientWidth, e.getBoundingClientRect().right]));
  check(parts.every(([, over, right]) => over <= 0 && right <= width), JSON.stringify(parts));
  if (width > 900) return check((await page.locator("#tools").boundingBox()).height < 60, "the toolbar has more than one row");
  for (const button of ["#open-settings", "#save-as"]) {
    await page.click(button);
    const small = await page.$$eval("button, textarea, select, input:not([type=radio], [type=checkbox], [type=file])", (all) => all.filter((e) => e.offsetParent).map((e) => [e.id || e.textContent, e.getBoundingClientRect()]).filter(([, b]) => b.width > 0 && (b.width < 43.5 || b.height < 43.5)).map(([name]) => name));
    check(small.length === 0, `too small for a finger: ${small}`);
    const cut = await page.$$eval("dialog[open] button", (all) => all.filter((b) => b.offsetParent && (b.scrollWidth > b.clientWidth || b.getBoundingClientRect().right > innerWidth)).map((b) => b.id));
    check(cut.length === 0, `cut off: ${cut}`);
  }
}, { viewport: { width, height } });
export const everything_fits_a_desk = () => fits(1440, 900);
export const everything_fits_a_laptop = () => fits(1024, 700);
export const everything_fits_a_phone = () => fits(390, 844);

/** Copies the command line that the dialog gives for a format and a name. */
async function copied(page, format, name) {
  await page.evaluate(() => { window.copied = null; navigator.clipboard.writeText = (text) => { window.copied = text; return Promise.resolve(); }; });
  await page.click("#save-as");
  await page.locator(`#save-formats input[value=${format}]`).check();
  if (name) await page.fill("#save-name", name);
  await page.click("#copy-command");
  return (await page.waitForFunction(() => window.copied)).jsonValue();
}
const run = (dir, line) => execFileSync("sh", ["-c", line.replaceAll(/(^|&& |\| )pathwarp /g, `$1'${program}' `)], { cwd: dir, stdio: "ignore" });

/** The copied command line writes the chosen format under the typed name, with the bytes that Save writes. */
export const commands_have_format_and_name = () => within("Flag", async (page, dir) => {
  for (const [format, name] of [["png", "poster.png"], ["pdf", "poster.pdf"], ["toml", "waves.toml"]]) {
    const line = await copied(page, format, name);
    check(line.includes(name), line);
    run(dir, line);
    const own = readFileSync(`${dir}/${name}`);
    rmSync(`${dir}/${name}`);
    await page.click("#save-as");
    await page.locator(`#save-formats input[value=${format}]`).check();
    await page.fill("#save-name", name);
    await page.click("#save-dialog button[type=submit]");
    await page.waitForFunction(() => !document.querySelector("#save-dialog").open);
    check(readFileSync(`${dir}/${name}`).equals(own), `${name} is another file by ${line}`);
  }
});

/** From a reopened result, the command bends the source, also where that is in the result alone. */
export const commands_of_results_bend_the_source = () => within("Flag", async (page, dir, editor) => {
  await page.click("#save");
  await page.waitForSelector("#toast.on");
  await editor.stop();
  for (const source of ["logo.svg", "logo-source.svg"]) {
    if (source !== "logo.svg") rmSync(`${dir}/logo.svg`);
    const again = await edit(`${dir}/logo-bent.svg`);
    const page2 = await open(again.address);
    await drag(page2, "bend", 0, -20);
    await page2.click("#save");
    await page2.waitForSelector("#toast.on");
    const line = await copied(page2, "svg", "copy.svg");
    check(line.includes(` ${source} `), line);
    run(dir, line);
    check(readFileSync(`${dir}/copy.svg`).equals(readFileSync(`${dir}/logo-bent.svg`)), `another drawing from ${line}`);
    rmSync(`${dir}/copy.svg`);
    await page2.context().close();
    await again.stop();
  }
});

/** Save as… says why there is nothing to save. */
export const nothing_to_save_is_said = () => within(null, async (page) => {
  await page.click("#save-as");
  await page.waitForSelector("#toast.on:has-text('nothing to save')");
  check(!(await page.isVisible("#save-dialog")), "there is a dialog for nothing");
});

/** A drawing that is opened in one tab is announced in the other, with its own original. */
export const another_tab_opens_a_drawing = () => within("Arc", async (page, dir, editor) => {
  await page.keyboard.down("b");
  await page.waitForSelector("#stage.before");
  await page.keyboard.up("b");
  const other = await open(editor.address);
  await other.setInputFiles("#open-file", sample("badge.svg"));
  await page.waitForSelector("#toast.on:has-text('badge.svg has been opened in another tab')");
  await page.waitForFunction(() => document.querySelector("#file").textContent === "badge.svg");
  await quiet(page);
  await quiet(other);
  const shown = (p) => p.$$eval("#stage .art:not([visibility=hidden]) path", (all) => all.length);
  await page.keyboard.down("b");
  await page.waitForSelector("#stage.before");
  await quiet(page);
  const [mine, theirs] = [await shown(page), await shown(other)];
  await page.keyboard.up("b");
  check(mine === theirs, `the original has ${mine} paths instead of ${theirs}`);
  await other.context().close();
});

/** A path is picked within 8 px; what would be picked lights up, and a miss leaves the question open. */
export const paths_are_picked_nearby = async () => {
  const dir = folder({ "way.svg": '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 400 200"><path id="way" d="M40,60 H360" fill="none" stroke="#000" stroke-width=".5"/><path d="M60,120 h200 v40 h-200 z"/></svg>' });
  const editor = await edit(`${dir}/way.svg`);
  const page = await open(editor.address);
  try {
    await choose(page, "Bend");
    await page.click("#settings summary");
    await page.locator("#settings .field", { has: page.locator("#set-along") }).getByRole("button", { name: "Pick from drawing" }).click();
    const at = await page.$eval("#stage .art [id$=way]", (p) => { const q = p.getPointAtLength(100).matrixTransform(p.getScreenCTM()); return [q.x, q.y]; });
    await page.mouse.click(at[0], at[1] - 30);
    check(await page.$eval("#stage", (s) => s.classList.contains("picking")), "a miss ends the choice");
    await page.mouse.move(at[0], at[1] - 6);
    check((await page.getAttribute(".lit", "d")) !== "", "the path under the pointer does not light up");
    const gap = await page.$eval(".lit", (p, [x, y]) => { const b = p.getBoundingClientRect(); return Math.abs(b.y + b.height / 2 - y) + Math.max(b.x - x, 0); }, at);
    check(gap < 2, `the light is ${gap} px off`);
    await page.mouse.click(at[0], at[1] - 6);
    await page.waitForFunction(() => document.querySelector("#set-along").value === "#way");
    check((await page.getAttribute(".lit", "d")) === "", "the light stays");
  } finally {
    editor.stop();
    await page.context().close();
  }
};

/** People's words find shapes, Enter takes the first, and nothing found is said. */
export const words_find_shapes = () => within(null, async (page) => {
  const found = async (text) => {
    await page.fill("#search", "");
    await page.click("#search");
    await page.keyboard.type(text);
    return page.$$eval("#gallery .card", (all) => all.filter((c) => c.offsetParent).map((c) => c.textContent));
  };
  for (const [text, name] of [["circle", "Bend"], ["text on path", "Bend"], ["bottle", "Cage"], ["puppet warp", "Pins"], ["keystone", "Perspective"], ["twist", "Swirl"], ["lattice", "Grid"]]) {
    const names = await found(text);
    check(names.includes(name), `${text} finds ${names}`);
  }
  check((await found("zzz")).length === 0 && (await page.isVisible("#gallery .none")) && (await page.textContent("#gallery .none")).includes("zzz"), "nothing found is not said");
  const [first] = await found("bottle");
  await page.keyboard.press("Enter");
  await quiet(page);
  check((await steps(page)).join() === stepOf(first), `Enter took ${await steps(page)}, not ${first}`);
});

/** A preset of the same name is replaced only when that is wanted. */
export const presets_ask_before_they_replace = () => within("Flag", async (page) => {
  const keep = async (name) => {
    await page.click("#keep-preset");
    await page.fill("#preset-name", name);
    await page.keyboard.press("Enter");
  };
  await keep("Twice");
  await page.waitForFunction(() => !document.querySelector("#preset-dialog").open);
  await keep("Twice");
  await page.waitForFunction(() => document.querySelector("#preset-message").textContent !== "");
  check((await page.textContent("#preset-message")).includes("exists") && (await page.isVisible("#preset-replace")), "it was replaced without a word");
  await page.click("#preset-replace");
  await page.waitForFunction(() => !document.querySelector("#preset-dialog").open);
  await page.click('[aria-label="Forget Twice"]');
  await quiet(page);
  check((await focused(page)) !== "" && !(await page.isVisible('[aria-label="Forget Twice"]')), "it is not forgotten");
});

/** What is selected is seen where colours are the user's. */
export const forced_colours_show_the_selection = () => within("Flag", async (page) => {
  const framed = (selector) => page.$eval(selector, (e) => getComputedStyle(e).outlineStyle);
  for (const selector of ['.card[aria-pressed="true"]', "#steps li.chosen", "#snap", ".segments :checked + span"]) {
    check((await framed(selector)) === "solid", `${selector} looks like the others`);
  }
  check((await framed('.card[aria-pressed="false"]')) !== "solid", "every card has a frame");
}, { forcedColors: "active" });

/** The view is magnified from 1 to 6,400 %. */
export const zoom_has_its_range = () => within(null, async (page) => {
  for (const [key, end] of [["-", "1%"], ["+", "6400%"]]) {
    for (let i = 0; i < 50; i++) await page.keyboard.press(key);
    check((await page.textContent("#zoom")) === end, `${key} ends at ${await page.textContent("#zoom")}`);
  }
});

/** Keys that go through long settings scroll the panel alone. */
export const keys_go_through_long_settings = () => within("Bend", async (page) => {
  await page.locator("#settings").getByRole("button").first().focus();
  for (let inside = true; inside; ) {
    await page.keyboard.press("Tab");
    const { top, field, isInside } = await page.evaluate(() => ({
      top: document.querySelector("header").getBoundingClientRect().top, field: document.activeElement.id, isInside: document.querySelector("#settings").contains(document.activeElement),
    }));
    check(top === 0, `at ${field}, the header is at ${top}`);
    inside = isInside;
  }
}, { viewport: { width: 1440, height: 900 } });

/** What keeps from saving is said, and has the focus. */
export const a_wrong_value_is_named_when_saving = () => within("Arc", async (page) => {
  const type = async (text) => {
    await page.click("#set-bend", { clickCount: 3 });
    await page.keyboard.type(text);
    await page.keyboard.press("Enter");
  };
  await type("high");
  await page.click("#save-as");
  await page.locator("#toast.on", { hasText: /^Bend: A number.* %$/ }).waitFor();
  check((await page.evaluate(() => document.activeElement.id)) === "set-bend", "the field has no focus");
  check(!(await page.isVisible("#save-dialog")), "the dialog is open");
  await type("30");
  await page.locator("#set-bend-wrong").waitFor({ state: "hidden" });
  await page.click("#save-as");
  await page.fill("#save-name", "../a.svg");
  await page.keyboard.press("Enter");
  await page.locator("#save-message", { hasText: "a plain file name" }).waitFor();
  check(!(await page.textContent("#save-message")).includes("`"), await page.textContent("#save-message"));
});

/** Sums of sizes are shown in the figures that were meant. */
export const sizes_of_words_are_added = () => within(null, async (page) => {
  await page.click("#words");
  await page.fill("#words-text", "Word");
  await page.fill("#words-size", "1 cm + 2.5");
  await page.getByRole("button", { name: /^(Set words|New drawing)$/ }).click();
  await page.getByRole("dialog").waitFor({ state: "hidden" });
  await page.click("#words");
  await page.getByRole("dialog").waitFor();
  check((await value(page, "words-size")) === "12.5", await value(page, "words-size"));
});

/** A result that is opened from its folder is a saved file, and is saved there again; a file of its name from elsewhere is not. */
export const results_are_opened_as_saved = () => within("Arc", async (page, dir) => {
  await page.click("#save");
  await page.getByText("Saved as logo-bent.svg").waitFor();
  await page.setInputFiles("#open-file", sample("badge.svg"));
  await page.getByRole("heading", { name: "badge.svg" }).waitFor();
  await page.setInputFiles("#open-file", `${dir}/logo-bent.svg`);
  await page.getByRole("heading", { name: "logo-bent.svg" }).waitFor();
  await page.waitForFunction(() => document.querySelector("#saved").textContent === "Saved");
  const before = readFileSync(`${dir}/logo-bent.svg`, "utf8");
  await choose(page, "Flag");
  await page.waitForFunction(() => document.querySelector("#saved").textContent === "Not saved yet");
  await page.click("#save");
  await page.waitForFunction(() => document.querySelector("#saved").textContent !== "Not saved yet");
  check(readFileSync(`${dir}/logo-bent.svg`, "utf8") !== before, "it was saved elsewhere");
  const other = before.replace("<svg", "<!-- from elsewhere --><svg");
  await page.setInputFiles("#open-file", { name: "logo-bent.svg", mimeType: "image/svg+xml", buffer: Buffer.from(other) });
  await page.locator("#steps", { hasText: "Arc" }).waitFor();
  await page.waitForFunction(() => document.querySelector("#saved").textContent === "Not saved yet");
});

/** What the font lacks is said. */
export const letters_that_are_missing_are_named = () => within(null, async (page) => {
  await page.click("#words");
  await page.fill("#words-text", "Tea 茶");
  await page.getByRole("button", { name: /^(Set words|New drawing)$/ }).click();
  await page.locator("#toast.on", { hasText: "The font lacks 茶." }).waitFor();
});
