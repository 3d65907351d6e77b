// Several points at once: selected by a frame, clicks or a line, and moved, turned and scaled together.
import { becomes, changes, check, choose, drag, edit, folder, keys, middle, open, paths, quiet, sample, withoutPause } from "./harness.mjs";

async function within(shape, test) {
  const dir = folder({ "logo.svg": sample("logo.svg") });
  const editor = await edit(`${dir}/logo.svg`);
  const page = await open(editor.address);
  try {
    if (shape) await choose(page, shape);
    await test(page);
    check(page.problems.length === 0, page.problems.join("; "));
  } finally {
    editor.stop();
    await page.context().close();
  }
}

const places = async (page) => Object.fromEntries(await Promise.all((await keys(page)).map(async (k) => [k, await middle(page, k)])));
const selected = async (page) => (await page.$$eval(".knob.selected", (all) => all.map((k) => k.dataset.key))).sort().join();
const pull = async (page, [x, y], [dx, dy]) => {
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + dx, y + dy, { steps: 10 });
  await page.mouse.up();
  await quiet(page);
};
/** Checks which handles have moved by how much: `wanted` gives the image of a handle that was to move. */
function moved(before, after, wanted) {
  for (const [key, [x, y]] of Object.entries(before)) {
    const [wx, wy] = wanted(key, [x, y]) ?? [x, y];
    const off = Math.hypot(after[key][0] - wx, after[key][1] - wy);
    check(off < 1.5, `${key} is ${off} px from ${[wx, wy]}`);
  }
}
const corner = (box, name) => box.locator(`.part.${name} .body`).boundingBox().then(({ x, y, width, height }) => [x + width / 2, y + height / 2]);

/** A frame around two columns of a grid selects them; a drag, a turn, a scaling and keys move them, each as one change. */
export const points_in_a_frame = () => within("Grid", async (page) => {
  const start = await places(page);
  const mine = ["at/1", "at/2", "at/5", "at/6"];
  await page.click("#snap");
  await page.click("#select");
  await pull(page, [start["at/1"][0] - 40, start["at/1"][1] - 40], [start["at/6"][0] - start["at/1"][0] + 80, start["at/6"][1] - start["at/1"][1] + 60]);
  check((await selected(page)) === mine.join(), `${await selected(page)} are selected`);
  await page.click("#select");
  const picture = await paths(page);
  const box = page.locator("#stage .selection");

  await pull(page, start["at/5"], [25, 30]);
  const dragged = await places(page);
  moved(start, dragged, (k, [x, y]) => (mine.includes(k) ? [x + 25, y + 30] : null));

  // A quarter turn about the middle of the box.
  const [tx, ty] = await corner(box, "turn");
  const [nw, se] = [await corner(box, "nw"), await corner(box, "se")];
  const [cx, cy] = [(nw[0] + se[0]) / 2, (nw[1] + se[1]) / 2];
  await pull(page, [tx, ty], [cx + (cy - ty) - tx, cy - ty]);
  const turned = await places(page);
  const angle = Math.PI / 2;
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  moved(dragged, turned, (k, [x, y]) => (mine.includes(k) ? [cx + c * (x - cx) - s * (y - cy), cy + s * (x - cx) + c * (y - cy)] : null));
  await page.click("#undo");
  await quiet(page);
  moved(dragged, await places(page), () => null);

  // Half the size about the corner opposite.
  const [a, b] = [await corner(box, "nw"), await corner(box, "se")];
  await pull(page, b, [(a[0] - b[0]) / 2, (a[1] - b[1]) / 2]);
  const scaled = await places(page);
  moved(dragged, scaled, (k, [x, y]) => (mine.includes(k) ? [(x + a[0]) / 2, (y + a[1]) / 2] : null));

  await page.locator('.knob[data-key="at/5"]').focus();
  const unmoved = await paths(page);
  // Keys that follow each other are one change after a pause.
  await withoutPause(page, async () => {
    for (let i = 0; i < 3; i++) await page.keyboard.press("Shift+ArrowLeft");
    await changes(page, unmoved);
  });
  moved(scaled, await places(page), (k, [x, y]) => (mine.includes(k) ? [x - 30, y] : null));
  for (let i = 0; i < 3; i++) await page.click("#undo");
  await becomes(page, picture, "each was to be one change");
});

/** Shift-clicks add and take out; a plain click selects one again. */
export const points_by_shift_click = () => within("Pins", async (page) => {
  const start = await places(page);
  await page.mouse.click(...start["pair/0/1"]);
  await page.keyboard.down("Shift");
  for (const key of ["pair/1/1", "pair/2/1", "pair/1/1"]) await page.mouse.click(...start[key]);
  await page.keyboard.up("Shift");
  check((await selected(page)) === "pair/0/1,pair/2/1", await selected(page));
  await page.click("#snap");
  await drag(page, "pair/2/1", 20, -15);
  const after = await places(page);
  moved(start, after, (k, [x, y]) => (["pair/0/1", "pair/2/1"].includes(k) ? [x + 20, y - 15] : null));
  const all = (await keys(page)).length;
  await page.keyboard.press("Delete");
  await quiet(page);
  check((await keys(page)).length === all - 4, `${await keys(page)}`);
  await page.click("#undo");
  await quiet(page);
  check((await keys(page)).length === all, "both were to come back at once");
  await page.mouse.click(...after["pair/4/1"]);
  check((await selected(page)) === "pair/4/1", await selected(page));
});

/** A line of a grid takes its whole row along. */
export const a_row_of_a_grid = () => within("Grid", async (page) => {
  const start = await places(page);
  const row = ["at/4", "at/5", "at/6", "at/7"];
  const [[ax, ay], [bx]] = [start["at/5"], start["at/6"]];
  await pull(page, [(ax + bx) / 2, ay], [0, -45]);
  moved(start, await places(page), (k, [x, y]) => (row.includes(k) ? [x, y - 45] : null));
});

/** A side of a cage is selected by a click and moves as a whole: its ends with their handles. */
export const a_side_of_a_cage = () => within(null, async (page) => {
  const start = await places(page);
  const ends = ["shaper/0.0/2", "shaper/0.0/3"];
  const [[ax, ay], [bx, by]] = ends.map((k) => start[k]);
  const at = [ax + 0.5 * (bx - ax), ay + 0.5 * (by - ay)];
  await page.mouse.click(...at);
  check((await selected(page)) === ends.join(), await selected(page));
  await pull(page, at, [30, -40]);
  const after = await places(page);
  for (const key of ends) check(Math.hypot(after[key][0] - start[key][0] - 30, after[key][1] - start[key][1] + 40) < 1.5, `${key}: ${after[key]}`);
  const out = after["shaper/0.0/2/out"];
  check(Math.hypot(out[0] - start["shaper/0.0/2/out"][0] - 30, out[1] - start["shaper/0.0/2/out"][1] + 40) < 1.5, "the side has bent");
  check(!(await page.isVisible("#folds")), "the cage folds");
});
