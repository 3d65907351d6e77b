// Writes the pictures of docs/editor.md.
import { choose, close, drag, edit, folder, open, quiet, root, sample } from "./harness.mjs";

async function shot(name, act) {
  const dir = folder({ "logo.svg": sample("logo.svg") });
  const editor = await edit(`${dir}/logo.svg`);
  const page = await open(editor.address);
  await act(page);
  // The small pictures of the gallery are drawn one by one.
  await page.waitForTimeout(4000);
  await page.mouse.move(5, 400);
  await page.screenshot({ path: `${process.argv[2] ?? `${root}/docs/images`}/${name}.png` });
  editor.stop();
  await page.context().close();
}

await shot("editor", async (page) => {
  await drag(page, "shaper/0.0/0/out", 10, 70);
  await drag(page, "shaper/0.0/1/in", -10, -80);
  await drag(page, "shaper/0.0/3/in", 10, 70);
  await drag(page, "shaper/0.0/2/out", -10, -80);
  await page.locator("#stage").focus().catch(() => {});
});
await shot("editor-grid", async (page) => {
  await choose(page, "Grid");
  await drag(page, "at/5", 40, -60);
  await drag(page, "at/10", -30, 60);
  await page.click("#stretch");
  await quiet(page);
});
await close();
