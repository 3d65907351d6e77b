// Keyboard alone, names for screen readers, small and large screens, dark and light.
import { AXE, becomes, check, choose, edit, folder, middle, open, paths, quiet, sample, withoutPause } from "./harness.mjs";

async function within(test, options) {
  const dir = folder({ "logo.svg": sample("logo.svg") });
  const editor = await edit(`${dir}/logo.svg`);
  const page = await open(editor.address, options);
  try {
    await test(page);
    check(page.problems.length === 0, page.problems.join("; "));
  } finally {
    editor.stop();
    await page.context().close();
  }
}

export const keyboard_alone = () => within(async (page) => {
  const before = await paths(page);
  for (let i = 0; i < 40 && !(await page.evaluate(() => document.activeElement.matches(".knob"))); i++) await page.keyboard.press("Tab");
  const key = await page.evaluate(() => document.activeElement.dataset.key);
  check(key, "no handle can be reached with Tab");
  const [x, y] = await middle(page, key);
  await withoutPause(page, async () => {
    await page.keyboard.press("Shift+ArrowUp");
    await page.keyboard.press("ArrowRight");
  });
  await page.waitForFunction(() => !document.querySelector("#undo").disabled);
  const [nx, ny] = await middle(page, key);
  check(Math.abs(nx - x - 1) < 0.6 && Math.abs(ny - y + 10) < 0.6, `moved by ${nx - x},${ny - y}`);
  check((await paths(page)) !== before, "the picture did not follow");
  check((await page.evaluate(() => document.activeElement.dataset.key)) === key, "the focus was lost");
  await page.keyboard.press("Control+z");
  await becomes(page, before, "Ctrl Z does nothing");
});

export const typed_numbers = () => within(async (page) => {
  await page.locator('.knob[data-key="shaper/0.0/2"]').focus();
  await page.fill("#place-x", "600");
  await page.keyboard.press("Enter");
  await page.waitForFunction(() => !document.querySelector("#undo").disabled);
  await quiet(page);
  check((await page.inputValue("#place-x")) === "600", "the number is not kept");
});

export const everything_has_a_name = () => within(async (page) => {
  await choose(page, "Swirl");
  const nameless = await page.$$eval("button, input, select, textarea, .knob", (all) => all.filter((e) => {
    const label = e.getAttribute("aria-label") ?? e.labels?.[0]?.textContent ?? e.textContent ?? "";
    return label.trim() === "" && e.type !== "hidden";
  }).map((e) => e.outerHTML));
  check(nameless.length === 0, nameless.join("\n"));
});

export const fits_any_screen = async () => {
  for (const [width, height] of [[320, 568], [768, 1024], [1280, 800], [3840, 2160]]) {
    await within(async (page) => {
      const wide = await page.evaluate(() => document.documentElement.scrollWidth);
      check(wide <= width, `${width} px: the page is ${wide} px wide`);
      const stage = await page.locator("#stage").boundingBox();
      check(stage.width > 250 && stage.height > 200, `${width} px: the canvas is ${stage.width} × ${stage.height}`);
    }, { viewport: { width, height } });
  }
};

export const touch_drags = () => within(async (page) => {
  const before = await paths(page);
  const [x, y] = await middle(page, "shaper/0.0/2");
  const session = await page.context().newCDPSession(page);
  const touch = (type, points) => session.send("Input.dispatchTouchEvent", { type, touchPoints: points });
  await touch("touchStart", [{ x, y }]);
  for (let i = 1; i <= 8; i++) await touch("touchMove", [{ x: x - 5 * i, y: y + 6 * i }]);
  await touch("touchEnd", []);
  await quiet(page);
  check((await paths(page)) !== before, "touch does not drag");
}, { hasTouch: true });

/** A style is chosen, a step added and moved, and the file saved, all by keys. */
export const styles_and_steps_by_keyboard = () => within(async (page) => {
  await page.locator("#search").focus();
  await page.keyboard.type("flag");
  await page.keyboard.press("Tab");
  check((await page.evaluate(() => document.activeElement.textContent)) === "Flag", "the card is not reached");
  await page.keyboard.press("Enter");
  await page.waitForFunction(() => document.querySelector("#steps").textContent.includes("Flag"));
  await page.locator("#search").focus();
  await page.keyboard.press("Control+a");
  await page.keyboard.press("Delete");
  await page.locator(".card", { hasText: /^Arc$/ }).focus();
  await page.keyboard.press("ArrowRight");
  const next = await page.evaluate(() => {
    const cards = [...document.querySelectorAll(".card")].map((card) => card.textContent);
    return cards[cards.indexOf("Arc") + 1];
  });
  check((await page.evaluate(() => document.activeElement.textContent)) === next, "arrows do not go from card to card");
  await page.keyboard.press("Control+s");
  await page.waitForSelector("#toast.on");
  check((await page.textContent("#toast")).includes("logo-bent.svg"), await page.textContent("#toast"));
});

/** Keys say where they have moved a handle to. */
export const moves_are_spoken = () => within(async (page) => {
  await page.locator('.knob[data-key="shaper/0.0/2"]').focus();
  await page.keyboard.press("ArrowUp");
  check(/^Cage, point 3: [-\d.]+, [-\d.]+$/.test(await page.textContent("#spoken")), await page.textContent("#spoken"));
});

/** The rules of axe-core, in every look of the page. */
export async function axe_finds_nothing() {
  const looks = [["light", 1280, 800], ["dark", 1280, 800], ["light", 320, 568], ["dark", 390, 844], ["light", 640, 400], ["dark", 3840, 2160]];
  for (const [colorScheme, width, height] of looks) {
    await within(async (page) => {
      const judge = async (what) => {
        const found = await page.evaluate(AXE);
        check(found.length === 0, `${what}, ${colorScheme}, ${width} × ${height}: ${found.join("\n")}`);
      };
      await judge("at the start");
      const isNarrow = await page.isVisible("#open-shapes");
      if (isNarrow) await page.click("#open-shapes");
      await choose(page, "Swirl");
      await page.click("#stretch");
      await page.click("#nodes");
      if (isNarrow) await page.click("#open-settings");
      await page.click(".more summary");
      await page.click("#add-step");
      await judge("with settings and a step to come");
      await page.keyboard.press("Escape");
      await page.keyboard.press("Control+s");
      await page.waitForSelector("#toast.on");
      await page.evaluate(() => Promise.all(document.getAnimations().map((a) => a.finished)));
      await judge("with a message");
      await page.keyboard.press("Control+Shift+s");
      await judge("with the dialog for saving");
    }, { colorScheme, viewport: { width, height } });
  }
}

/** Nothing moves by itself where the user does not want it. */
export const reduced_motion = () => within(async (page) => {
  const moving = await page.evaluate(() => Array.from(document.querySelectorAll("*")).filter((e) => getComputedStyle(e).transitionDuration.split(",").some((t) => parseFloat(t) > 0)).length);
  check(moving === 0, `${moving} elements move`);
}, { reducedMotion: "reduce", viewport: { width: 400, height: 800 } });
