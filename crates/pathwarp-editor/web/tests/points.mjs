// Points of paths are added and taken away, and the rest of the path stays.
import { becomes, check, choose, drag, edit, folder, keys, middle, open, paths, quiet, sample } from "./harness.mjs";

async function within(shape, test) {
  const dir = folder({ "logo.svg": sample("logo.svg") });
  const editor = await edit(`${dir}/logo.svg`);
  const page = await open(editor.address);
  try {
    if (shape) await choose(page, shape);
    await test(page);
    check(page.problems.length === 0, page.problems.join("; "));
    check(!(await page.isVisible("#problem")), await page.textContent("#problem"));
  } finally {
    editor.stop();
    await page.context().close();
  }
}

/** The boxes of all paths, and the largest distance between those of two pictures. */
const boxes = (page) => page.$$eval("#stage .art:not([visibility=hidden]) path", (all) => all.map((p) => {
  const { x, y, width, height } = p.getBBox();
  return [x, y, x + width, y + height];
}));
const apart = (a, b) => Math.max(...a.flat().map((v, i) => Math.abs(v - b.flat()[i])));

/** Double-clicks between two handles, which adds a node there, drags it, and takes it away again. */
const added = (shape, from, to) => within(shape, async (page) => {
  const [before, all, wide] = [await paths(page), await keys(page), await boxes(page)];
  const nodes = (list) => list.filter((k) => k.startsWith(from.replace(/\/\d+$/, "")) && !/(in|out)$/.test(k)).length;
  const [[ax, ay], [bx, by]] = [await middle(page, from), await middle(page, to)];
  await page.mouse.dblclick((ax + bx) / 2, (ay + by) / 2);
  await quiet(page);
  check(nodes(await keys(page)) === nodes(all) + 1, `no point was added to ${all}, now ${await keys(page)}`);
  check(apart(await boxes(page), wide) < 0.5, "adding a point changed the picture");
  const key = await page.$eval(".knob.selected", (k) => k.dataset.key);
  await drag(page, key, 25, -45);
  check((await paths(page)) !== before, "the new point does not bend the picture");
  await page.locator(`.knob[data-key="${key}"]`).focus();
  await page.keyboard.press("Delete");
  await quiet(page);
  check((await keys(page)).length === all.length, `the point was not taken away: ${await keys(page)}`);
  for (let i = 0; i < 3; i++) await page.click("#undo");
  await becomes(page, before, "undo did not bring the picture back");
});

export const points_of_a_skeleton = () => added("Bend", "along/0.0/0", "along/0.0/1");
export const points_of_an_envelope_side = () => added("Envelope", "top/0.0/0", "top/0.0/1");
export const points_of_two_rows = () => within("Two rows", async (page) => {
  const [wide, all] = [await boxes(page), await keys(page)];
  const [[ax, ay], [bx, by]] = [await middle(page, "top/0.0/1"), await middle(page, "top/0.0/2")];
  await page.mouse.dblclick((ax + bx) / 2, (ay + by) / 2);
  await quiet(page);
  check((await keys(page)).length === all.length + 2, "each row gets a point");
  check(apart(await boxes(page), wide) < 0.5, "adding a point changed the picture");
  await drag(page, "top/0.0/3", 0, -50);
  await page.locator('.knob[data-key="bottom/0.0/2"]').focus();
  await page.click("#remove-point");
  await quiet(page);
  check((await keys(page)).length === all.length, "each row loses a point");
});

export const points_of_a_closed_shape = () => added("Closed shape", "envelope/0.0/0", "envelope/0.0/1");
/** The side between the last point and the first is one like the others. */
export const points_of_the_closing_side = () => added("Closed shape", "envelope/0.0/7", "envelope/0.0/0");
export const all_sixteen_points_of_a_cage = () => within("Cage, 16 points", async (page) => {
  check((await keys(page)).length === 16, `${await keys(page)}`);
  const before = await paths(page);
  await drag(page, "net/0.1/0/out", 30, 30);
  check((await paths(page)) !== before, "an inner point does nothing");
});

/** The line itself is pulled: a curve passes under the pointer, its ends stay. */
export const lines_are_pulled = () => within(null, async (page) => {
  const [before, [ax, ay], [bx, by]] = [await paths(page), await middle(page, "shaper/0.0/3"), await middle(page, "shaper/0.0/2")];
  const at = ax + 0.4 * (bx - ax);
  await page.mouse.move(at, ay);
  await page.mouse.down();
  await page.mouse.move(at, ay - 50, { steps: 10 });
  await page.mouse.up();
  await quiet(page);
  check((await paths(page)) !== before, "pulling the line does nothing");
  const gap = await page.$eval("#stage .line.path", (line, [x, y]) => {
    const box = line.ownerSVGElement.getBoundingClientRect();
    const length = line.getTotalLength();
    const away = (i) => { const p = line.getPointAtLength((i / 2000) * length); return Math.hypot(p.x + box.x - x, p.y + box.y - y); };
    return Math.min(...Array.from({ length: 2001 }, (_, i) => away(i)));
  }, [at, ay - 50]);
  check(gap < 3, `the line passes ${gap} px from the pointer`);
  const [ex, ey] = await middle(page, "shaper/0.0/3");
  check(Math.hypot(ex - ax, ey - ay) < 1, "the end of the line has moved");
  await page.click("#undo");
  await becomes(page, before, "undo did not bring the picture back");
});

/** The keys Insert and Delete do the same as the mouse. */
export const points_by_keyboard = () => within("Bend", async (page) => {
  const all = await keys(page);
  await page.locator('.knob[data-key="along/0.0/0"]').focus();
  await page.keyboard.press("Insert");
  await quiet(page);
  check((await keys(page)).length === all.length + 3, "no point was added");
  check((await page.evaluate(() => document.activeElement.dataset.key)) === "along/0.0/1", "the new point is not selected");
  await page.keyboard.press("Delete");
  await quiet(page);
  check((await keys(page)).length === all.length, "the point was not taken away");
});
