// Lines that are drawn on the canvas, while the view moves, with fingers, and given up.
import { check, choose, edit, folder, open, paths, quiet, sample } from "./harness.mjs";

async function within(test, options = {}) {
  const dir = folder({ "icon.svg": sample("icons/sun.svg") });
  const editor = await edit(`${dir}/icon.svg`);
  const page = await open(editor.address, options);
  try {
    await test(page);
    check(page.problems.length === 0, page.problems.join("; "));
  } finally {
    await editor.stop();
    await page.context().close();
  }
}

const sheet = (page) => page.locator("#stage .sheet").boundingBox();
/** Where a place stands, as shares of the sheet, and the other way round. */
const share = async (page, [x, y]) => {
  const box = await sheet(page);
  return [(x - box.x) / box.width, (y - box.y) / box.height];
};
const place = async (page, [u, v]) => {
  const box = await sheet(page);
  return [box.x + u * box.width, box.y + v * box.height];
};
const points = async (page) => {
  const boxes = await page.locator(".knob.node .body").evaluateAll((all) => all.map((b) => b.getBoundingClientRect().toJSON()));
  return Promise.all(boxes.map(({ x, y, width, height }) => share(page, [x + width / 2, y + height / 2])));
};
const draw = (page, kind) => page.getByRole("button", { name: `Draw ${kind}` }).first().click();

/** Points stay where they were put while the view is magnified between them; Enter ends the path, whose handles are there then. */
export const the_view_moves_while_a_path_is_drawn = () => within(async (page) => {
  await choose(page, "Bend");
  await draw(page, "path");
  const wanted = [[0.2, 0.5], [0.5, 0.4], [0.7, 0.6]];
  for (const [i, p] of wanted.entries()) {
    await page.mouse.click(...(await place(page, p)));
    const { width } = await sheet(page);
    await page.mouse.move(...(await place(page, [0.6, 0.5])));
    await page.mouse.wheel(0, i === 0 ? -240 : 120);
    await page.waitForFunction((was) => document.querySelector("#stage .sheet").getBoundingClientRect().width !== was, width);
  }
  await page.keyboard.press("Enter");
  await page.waitForFunction(() => document.querySelectorAll(".knob.node").length === 3);
  await page.locator(".knob.node").first().waitFor();
  await quiet(page);
  const got = await points(page);
  const off = Math.max(...wanted.map(([u, v]) => Math.min(...got.map(([x, y]) => Math.hypot(x - u, y - v)))));
  check(off < 0.01, `a point is ${Math.round(100 * off)} % of the sheet beside its place`);
});

/** Undo gives up what is being drawn, and nothing else. */
export const undo_gives_up_a_drawing = () => within(async (page) => {
  await choose(page, "Bend");
  const bent = await paths(page);
  await draw(page, "path");
  for (const p of [[0.2, 0.5], [0.5, 0.3]]) await page.mouse.click(...(await place(page, p)));
  await page.keyboard.press("Control+z");
  await quiet(page);
  check((await page.textContent("#steps")).includes("Bend"), "the step is undone, not the line");
  check(!(await page.locator("#stage .lit[d^=M]").count()), "the line is still being drawn");
  await page.getByRole("button", { name: "Undo", exact: true }).click();
  await page.waitForFunction(() => document.querySelector("#undo").disabled);
  await page.getByRole("button", { name: "Redo", exact: true }).click();
  await page.waitForFunction(() => document.querySelector("#steps").textContent.includes("Bend"));
  await quiet(page);
  check((await paths(page)) === bent, "the line was drawn all the same");
});

/** On a phone, the canvas is free to draw on, what to do is said, and each point is seen once the finger is lifted. */
export const a_path_is_drawn_with_fingers = () => within(async (page) => {
  await page.getByRole("button", { name: "Shapes", exact: true }).tap();
  await choose(page, "Bend");
  await page.getByRole("button", { name: "Settings", exact: true }).tap();
  await page.getByRole("button", { name: "Draw path" }).first().tap();
  await page.getByText("Click the points of the path").waitFor();
  await page.waitForFunction(() => !document.body.classList.contains("settings-open"));
  for (const [i, p] of [[0.2, 0.5], [0.5, 0.3], [0.8, 0.5]].entries()) {
    await page.touchscreen.tap(...(await place(page, p)));
    await page.waitForFunction((count) => document.querySelector("#stage .lit[d^=M]")?.getAttribute("d").split("L").length > count, i);
  }
  await page.keyboard.press("Enter");
  await page.waitForFunction(() => document.querySelectorAll(".knob.node").length === 3);
}, { viewport: { width: 390, height: 844 }, hasTouch: true });
