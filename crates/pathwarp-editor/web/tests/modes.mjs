// Ways of moving handles and the view: snapping, symmetry, smooth nodes, keys, Escape, zoom.
import { becomes, changes, check, choose, drag, edit, folder, middle, open, paths, quiet, sample, turns } from "./harness.mjs";

async function within(test, options) {
  const dir = folder({ "logo.svg": sample("logo.svg") });
  const editor = await edit(`${dir}/logo.svg`);
  const page = await open(editor.address, options);
  try {
    await test(page, editor);
    check(page.problems.length === 0, page.problems.join("; "));
  } finally {
    editor.stop();
    await page.context().close();
  }
}

/** The place of a handle in units of the drawing, as the page shows it. */
async function place(page, key) {
  await page.locator(`.knob[data-key="${key}"]`).focus();
  return [Number(await page.inputValue("#place-x")), Number(await page.inputValue("#place-y"))];
}

const [CORNER, OPPOSITE] = ["shaper/0.0/2", "shaper/0.0/3"];

export const handles_snap_unless_alt_is_held = () => within(async (page) => {
  const [, top] = await place(page, CORNER);
  await drag(page, CORNER, 60, 5);
  check((await place(page, CORNER))[1] === top, "5 px beside the upper edge, it does not snap");
  await page.keyboard.down("Alt");
  await drag(page, CORNER, 0, 5);
  await page.keyboard.up("Alt");
  check((await place(page, CORNER))[1] !== top, "it snaps although Alt is held");
  await page.click("#snap");
  const [, before] = await place(page, CORNER);
  await drag(page, CORNER, 0, -3);
  check((await place(page, CORNER))[1] !== before && (await place(page, CORNER))[1] !== top, "it snaps although snapping is off");
});

export const shift_keeps_the_direction = () => within(async (page) => {
  const [x] = await place(page, CORNER);
  await page.keyboard.down("Shift");
  await drag(page, CORNER, 12, -60);
  await page.keyboard.up("Shift");
  check((await place(page, CORNER))[0] === x, "it left the vertical");
});

export const both_sides_move_alike = () => within(async (page) => {
  const [[rx], [lx]] = [await place(page, CORNER), await place(page, OPPOSITE)];
  await page.click("#mirror");
  await drag(page, CORNER, 40, -50);
  const [[rx2, ry], [lx2, ly]] = [await place(page, CORNER), await place(page, OPPOSITE)];
  check(rx2 !== rx && Math.abs(rx2 - rx + (lx2 - lx)) < 0.01 && Math.abs(ry - ly) < 0.01, `${rx2},${ry} and ${lx2},${ly}`);
});

/** Lines, too: the upper one is its own reflection, the left side is that of the right one. */
export const lines_are_pulled_alike = () => within(async (page) => {
  await page.click("#mirror");
  const pull = async (from, to, share, dx, dy) => {
    const [[ax, ay], [bx, by]] = [await middle(page, from), await middle(page, to)];
    await page.mouse.move(ax + share * (bx - ax), ay + share * (by - ay));
    await page.mouse.down();
    await page.mouse.move(ax + share * (bx - ax) + dx, ay + share * (by - ay) + dy, { steps: 8 });
    await page.mouse.up();
    await quiet(page);
  };
  const reflected = async (a, b, what) => {
    const [[ax, ay], [bx, by], [lx], [rx]] = [await place(page, a), await place(page, b), await place(page, OPPOSITE), await place(page, CORNER)];
    check(Math.abs(ax - lx - (rx - bx)) < 0.01 && Math.abs(ay - by) < 0.01, `${what}: ${ax},${ay} and ${bx},${by}`);
    return [ax, ay];
  };
  const [, top] = await place(page, CORNER);
  await pull(OPPOSITE, CORNER, 0.4, 0, -40);
  const [, y] = await reflected("shaper/0.0/3/in", "shaper/0.0/2/out", "the upper line");
  check(y < top - 10, "the upper line was not pulled");
  const [left] = await place(page, OPPOSITE);
  await pull(OPPOSITE, "shaper/0.0/0", 0.5, -40, 0);
  const [x] = await reflected("shaper/0.0/3/out", "shaper/0.0/2/in", "the sides");
  check(x < left - 10, "the side was not pulled");
});

/** In a skeleton, the handles on both sides of a node stay in line; without *Smooth* they do not. */
export const nodes_stay_smooth = () => within(async (page) => {
  await choose(page, "Bend");
  const [[ax, ay], [bx, by]] = [await middle(page, "along/0.0/0"), await middle(page, "along/0.0/1")];
  await page.mouse.dblclick((ax + bx) / 2, (ay + by) / 2);
  await quiet(page);
  const turn = async () => {
    const [[x, y], [ix, iy], [ox, oy]] = [await middle(page, "along/0.0/1"), await middle(page, "along/0.0/1/in"), await middle(page, "along/0.0/1/out")];
    return Math.abs(Math.atan2((ix - x) * (oy - y) - (iy - y) * (ox - x), -((ix - x) * (ox - x) + (iy - y) * (oy - y))));
  };
  await drag(page, "along/0.0/1/out", 5, -50);
  check((await turn()) < 0.02, `the handles meet at an angle of ${await turn()}`);
  await page.click("#smooth");
  await drag(page, "along/0.0/1/out", 5, 70);
  check((await turn()) > 0.3, "the handles still turn together");
});

/** Escape while a handle is held puts everything back, and nothing is there to be undone. */
export const escape_takes_a_drag_back = () => within(async (page) => {
  const before = await paths(page);
  const [x, y] = await middle(page, CORNER);
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 40, y - 40, { steps: 6 });
  await changes(page, before);
  await page.keyboard.press("Escape");
  await becomes(page, before, "the picture is not as it was");
  await page.mouse.up();
  const [nx, ny] = await middle(page, CORNER);
  check(Math.hypot(nx - x, ny - y) < 1 && (await page.isDisabled("#undo")), "the handle is not as it was");
});

/** Undo right after a key takes back what the key did, and saving right after a key saves it. */
export const keys_count_at_once = () => within(async (page) => {
  await drag(page, CORNER, 30, -40);
  const dragged = await paths(page);
  await page.locator(`.knob[data-key="${CORNER}"]`).focus();
  await page.keyboard.press("Shift+ArrowUp");
  await page.keyboard.press("Control+z");
  await becomes(page, dragged, "undo went too far back");
  await page.locator(`.knob[data-key="${CORNER}"]`).focus();
  await page.keyboard.press("Shift+ArrowUp");
  await page.keyboard.press("Control+s");
  await page.waitForSelector("#toast.on");
  check((await page.textContent("#saved")).startsWith("Saved"), "the last key was not saved");
});

export const the_view_moves_and_fits = () => within(async (page) => {
  const [before, zoom] = [await middle(page, CORNER), () => page.textContent("#zoom")];
  const fitted = await zoom();
  await page.mouse.move(...before);
  await page.mouse.wheel(0, -300);
  await turns(page, "#zoom", fitted);
  const [x, y] = await middle(page, CORNER);
  check((await zoom()) !== fitted && Math.hypot(x - before[0], y - before[1]) < 1, "the wheel does not zoom about the pointer");
  await page.mouse.move(640, 680);
  await page.mouse.down();
  await page.mouse.move(600, 640, { steps: 4 });
  await page.mouse.up();
  const [px, py] = await middle(page, CORNER);
  check(Math.abs(px - x + 40) < 1 && Math.abs(py - y + 40) < 1, "dragging the ground does not move the view");
  await page.keyboard.press("0");
  const [fx, fy] = await middle(page, CORNER);
  check((await zoom()) === fitted && Math.hypot(fx - before[0], fy - before[1]) < 1, "0 does not fit");
  for (const [key, id] of [["+", "zoom-in"], ["-", "zoom-out"]]) {
    await page.keyboard.press(key);
    const typed = await zoom();
    await page.click("#fit");
    await page.click(`#${id}`);
    check((await zoom()) === typed && typed !== fitted, `${key} gives ${typed}, its button ${await zoom()}`);
    await page.click("#fit");
  }
  // The window changes, and the view with it, until somebody moves it.
  const wide = await zoom();
  await page.setViewportSize({ width: 1000, height: 600 });
  await turns(page, "#zoom", wide);
  const stage = await page.locator("#stage").boundingBox();
  check((await middle(page, CORNER))[0] < stage.x + stage.width, "the drawing is cut off in a smaller window");
});

/** Two fingers magnify about the point between them; the handle under the first one is left alone. */
export const two_fingers_zoom = () => within(async (page) => {
  const [before, picture, zoom] = [await middle(page, CORNER), await paths(page), await page.textContent("#zoom")];
  const session = await page.context().newCDPSession(page);
  const touch = (type, ...points) => session.send("Input.dispatchTouchEvent", { type, touchPoints: points.map(([x, y], id) => ({ x, y, id })) });
  const second = [before[0] - 100, before[1]];
  await touch("touchStart", before);
  await touch("touchStart", before, second);
  for (let i = 1; i <= 5; i++) await touch("touchMove", [before[0] + 10 * i, before[1]], [second[0] - 10 * i, second[1]]);
  await touch("touchEnd");
  await turns(page, "#zoom", zoom);
  await quiet(page);
  const ratio = parseInt(await page.textContent("#zoom"), 10) / parseInt(zoom, 10);
  check(Math.abs(ratio - 2) < 0.1, `fingers twice as far apart zoom by ${ratio}`);
  check((await paths(page)) === picture && (await page.isDisabled("#undo")), "the handle was moved");
}, { hasTouch: true });

export const the_original_is_shown_while_b_is_held = () => within(async (page) => {
  const box = () => page.$eval("#stage .art:not([visibility=hidden])", (art) => {
    const { x, y, width, height } = art.getBBox();
    return [x, y, width, height];
  });
  const same = (a, b) => a.every((v, i) => Math.abs(v - b[i]) < 0.5);
  const original = await box();
  await drag(page, CORNER, 40, -60);
  const bent = await box();
  await page.keyboard.down("b");
  await page.waitForSelector("#stage.before");
  const shown = await box();
  check(same(shown, original) && !same(shown, bent), `B shows ${shown}, the original is ${original}`);
  await page.keyboard.up("b");
  await page.waitForSelector("#stage:not(.before)");
  check(same(await box(), bent), "the original stays");
});

/** A wave and a swirl keep areas, but not lengths. */
export const stretch_is_shown = () => within(async (page) => {
  check(!(await page.isVisible("#legend")), "the legend is there too early");
  await choose(page, "Swirl");
  await page.click("#stretch");
  await page.waitForSelector("#stage .heat path", { state: "attached" });
  const strong = await page.$$eval("#stage .heat path", (all) => all.filter((p) => Number(p.getAttribute("fill-opacity")) > 0.2).length);
  check(strong > 1 && (await page.isVisible("#legend")), "nothing is to be seen of a swirl");
});

/** A shape folded over is marked, and counted. */
export const folds_are_marked = () => within(async (page) => {
  const [[x], [ox]] = [await middle(page, CORNER), await middle(page, OPPOSITE)];
  await drag(page, CORNER, 1.2 * (ox - x), 0);
  await page.waitForSelector("#folds:not([hidden])");
  check(/^Folds over at \d+ place/.test(await page.textContent("#folds")), await page.textContent("#folds"));
  check((await page.locator("#stage .fold").count()) > 0, "no fold is marked");
});

/** Modes whose buttons a shape or drawing does not have keep nobody from moving the view. */
export const modes_end_with_their_buttons = () => within(async (page) => {
  const pans = async (what) => {
    const sheet = () => page.locator("#stage .sheet").boundingBox();
    const { x, y } = await sheet();
    await page.mouse.move(x + 5, y + 5);
    await page.mouse.down();
    await page.mouse.move(x + 45, y + 35, { steps: 4 });
    await page.mouse.up();
    check(Math.abs((await sheet()).x - x - 40) < 1, what);
  };
  await page.click("#select");
  await choose(page, "Arc");
  await page.locator("#select").waitFor({ state: "hidden" });
  await pans("with one point, a frame is drawn");
  await page.click("#pick-parts");
  const one = `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 40 30"><path id="one" d="M10,10h20v10H10z"/></svg>`;
  await page.setInputFiles("#open-file", { name: "one.svg", mimeType: "image/svg+xml", buffer: Buffer.from(one) });
  await page.getByRole("heading", { name: "one.svg" }).waitFor();
  await page.locator("#pick-parts").waitFor({ state: "hidden" });
  await choose(page, "Arc");
  await pans("with one part, parts are picked");
});

/** Selected points move when the ground in their box is dragged, or its edge; a click there lets them go. */
export const a_selection_is_moved_by_its_box = () => within(async (page) => {
  const all = [CORNER, OPPOSITE];
  const selected = async () => {
    await page.mouse.click(...(await middle(page, CORNER)));
    await page.keyboard.down("Shift");
    await page.mouse.click(...(await middle(page, OPPOSITE)));
    await page.keyboard.up("Shift");
    await quiet(page);
  };
  const dragged = async ([x, y], dx, dy) => {
    const before = await Promise.all(all.map((k) => middle(page, k)));
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x + dx, y + dy, { steps: 8 });
    await page.mouse.up();
    await quiet(page);
    const after = await Promise.all(all.map((k) => middle(page, k)));
    const off = after.flatMap((p, i) => [p[0] - before[i][0] - dx, p[1] - before[i][1] - dy]);
    check(Math.max(...off.map(Math.abs)) < 1.5, `the points are ${off} px off`);
  };
  await selected();
  const box = async () => {
    const { x, y, width, height } = await page.locator("#stage .selection > path.line").last().boundingBox();
    // The handle that turns stands above.
    return { x, y: y + 26, width, height: height - 26 };
  };
  const inside = await box();
  await dragged([inside.x + inside.width * 0.4, inside.y + inside.height * 0.75], 25, 40);
  const edge = await box();
  await dragged([edge.x + edge.width * 0.3, edge.y + edge.height + 2], -15, 20);
  check((await page.locator("#stage .selection").last().getAttribute("visibility")) === "visible", "the selection is lost");
  const again = await box();
  await page.mouse.click(again.x + again.width * 0.4, again.y + again.height * 0.75);
  await quiet(page);
  check((await page.locator("#stage .selection").last().getAttribute("visibility")) === "hidden", "a click does not let go");
});
