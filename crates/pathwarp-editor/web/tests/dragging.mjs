// Every kind of handle is dragged, and the picture follows.
import { becomes, check, choose, curves, drag, edit, folder, keys, middle, open, paths, quiet, sample, stepOf } from "./harness.mjs";

async function started(name = "logo.svg") {
  const dir = folder({ [name]: sample(name) });
  const editor = await edit(`${dir}/${name}`);
  return { dir, editor, page: await open(editor.address) };
}

/** Drags one handle of a shape: the picture must change, undo must bring it back, redo must repeat it. */
async function follows(shape, pick, [dx, dy] = [37, -41], section) {
  const { editor, page } = await started();
  try {
    if (shape) await choose(page, shape, section);
    const before = await paths(page);
    const all = await keys(page);
    const key = pick(all);
    check(key, `${shape} has no such handle among ${all}`);
    const [x, y] = await middle(page, key);
    await drag(page, key, dx, dy);
    const [nx, ny] = await middle(page, key);
    check(Math.hypot(nx - x - dx, ny - y - dy) < 9, `the handle went to ${nx - x},${ny - y}`);
    const after = await paths(page);
    check(after !== before, "the picture did not change");
    await page.click("#undo");
    await becomes(page, before, "undo did not bring the picture back");
    await page.click("#redo");
    await becomes(page, after, "redo did not repeat the change");
    check(page.problems.length === 0, page.problems.join("; "));
  } finally {
    editor.stop();
    await page.context().close();
  }
}

export const corner_of_the_shaper = () => follows(null, (all) => all.find((k) => k === "shaper/0.0/2"));
export const handle_of_the_shaper = () => follows(null, (all) => all.find((k) => k.endsWith("/out")));
export const corner_of_a_perspective = () => follows("Perspective", (all) => all.find((k) => k === "target/0.0/2"));
export const one_of_four_corners = () => follows("Four corners", (all) => all.find((k) => k === "target/0.0/1"));
export const eye_of_an_anamorphosis = () => follows("Anamorphosis", (all) => all.find((k) => k === "eye"));
export const side_of_an_envelope = () => follows("Envelope", (all) => all.find((k) => k.startsWith("top") && k.endsWith("/in")));
export const adjust_value_of_a_text_shape = () => follows("Wave 1", (all) => all.find((k) => k === "adj/0"), [0, -20]);
export const angle_of_an_adjust_value = () => follows("Arch up pour", (all) => all.find((k) => k === "adj/0"), [0, -14]);
// Along the circle that a dial moves on.
export const dial_of_a_ring = () => follows("Ring", (all) => all.find((k) => k === "sweep"), [-26, 15]);
export const dial_of_a_transform = () => follows("Transform", (all) => all.find((k) => k === "rotate"), [0, 30]);
export const height_of_a_wave = () => follows("Wave (effect)", (all) => all.find((k) => k === "height"), [0, -25]);
export const pin = () => follows("Pins", (all) => all.find((k) => k === "pair/2/1"));

/** The sliders of a text shape follow the shape, in its units, and a choice while another is on the way wins. */
export const settings_of_text_shapes = async () => {
  const { editor, page } = await started();
  try {
    await choose(page, "Arch up pour");
    const before = await paths(page);
    await page.fill("#set-adj-adj2", "30");
    await page.keyboard.press("Enter");
    await page.locator("#settings").click({ position: { x: 5, y: 5 } });
    await page.waitForFunction((d) => Array.from(document.querySelectorAll("#stage .art path"), (p) => p.getAttribute("d")).join("|") !== d, before);
    await quiet(page);
    check((await page.inputValue("#set-adj-adj1")) === "180", await page.inputValue("#set-adj-adj1"));
    await page.selectOption("#set-preset", "wave1");
    await page.waitForFunction(() => document.querySelector("#set-adj-adj1")?.value === "12.5");
    check(!(await page.isVisible("#problem")), await page.textContent("#problem"));
    await page.click("#start-over");
    await page.locator(".card", { hasText: /^Grid$/ }).click();
    await page.waitForFunction(() => document.querySelector("#steps").textContent.includes("Grid"));
    await quiet(page, 20);
    check((await page.textContent("#steps")).includes("Grid"), "an earlier answer took the place of a later choice");
    check(page.problems.length === 0, page.problems.join("; "));
  } finally {
    editor.stop();
    await page.context().close();
  }
};

export const skeleton_of_a_bend = () => follows("Bend", (all) => all.find((k) => k.startsWith("along") && k.endsWith("/out")));
export const node_of_a_net = () => follows("Grid", (all) => all.find((k) => k === "at/5"));
export const point_of_a_mesh = () => follows("Mesh", (all) => all.find((k) => k === "net/0.1/1"));
export const pair_of_points = () => follows("Pins", (all) => all.find((k) => k === "pair/0/1"));
export const centre_of_a_swirl = () => follows("Swirl", (all) => all.find((k) => k === "center"));
export const bend_of_a_style = () => follows("Flag", (all) => all.find((k) => k === "bend"), [0, -41]);
export const radius_of_a_bulge = () => follows("Bulge (effect)", (all) => all.find((k) => k === "radius"), [37, 0]);
export const node_of_a_triangle_net = () => follows("Triangle net", (all) => all.find((k) => k === "at/3"));
export const row_of_points = () => follows("Two rows", (all) => all.find((k) => k === "top/0.0/1"));

/** A large drawing follows, too, and only its path data is sent meanwhile (`speed.mjs` measures how fast). */
export async function ten_thousand_segments_follow() {
  const dir = folder({ "art.svg": curves(10000) });
  const editor = await edit(`${dir}/art.svg`);
  const page = await open(editor.address);
  try {
    const before = await paths(page);
    await page.$eval("#stage .art path", (path) => (path.dataset.same = "yes"));
    await page.evaluate(() => {
      window.drafts = 0;
      window.addEventListener("pathwarp-drafted", () => (window.drafts += 1));
    });
    await drag(page, "shaper/0.0/2", 37, -41);
    await page.waitForFunction(() => !document.querySelector("#undo").disabled);
    check((await paths(page)) !== before, "the picture did not change");
    check((await page.evaluate(() => window.drafts)) > 0, "there was no picture before the end of the drag");
    check((await page.$eval("#stage .art path", (path) => path.dataset.same)) === "yes", "the whole drawing was sent again");
    await page.click("#undo");
    await becomes(page, before, "undo did not bring the picture back");
    check(page.problems.length === 0, page.problems.join("; "));
  } finally {
    editor.stop();
    await page.context().close();
  }
}

/** Every deformation can be chosen, and bends the drawing without a complaint. */
export async function every_shape_opens() {
  const { editor, page } = await started();
  try {
    const names = await page.$$eval("#gallery section .card[title]", (all) => all.map((c) => c.textContent));
    check(names.length > 15, `only ${names.length} shapes`);
    for (const name of names) {
      await page.locator(".card[title]", { hasText: new RegExp(`^${name.replace(/[()]/g, "\\$&")}$`) }).click();
      await page.waitForFunction((n) => document.querySelector("#steps").textContent.includes(n), stepOf(name.replace(" (effect)", "")));
      check(!(await page.isVisible("#problem")), `${name}: ${await page.textContent("#problem")}`);
    }
    check(page.problems.length === 0, page.problems.join("; "));
  } finally {
    editor.stop();
    await page.context().close();
  }
}
