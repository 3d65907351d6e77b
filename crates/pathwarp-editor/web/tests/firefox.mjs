// Firefox: the page opens, handles are dragged, the result is saved, and words are set and undone. Everything else is tested in Chromium.
import { existsSync } from "node:fs";
import { firefox } from "./bidi.mjs";
import { AXE, check, edit, folder, sample } from "./harness.mjs";

const program = ["/usr/bin/firefox-esr", "/usr/bin/firefox"].find((p) => existsSync(p));
const PATHS = 'Array.from(document.querySelectorAll("#stage .art:not([visibility=hidden]) path"), (p) => p.getAttribute("d")).join("|")';

export async function firefox_opens_drags_and_saves() {
  if (!program) return "skipped: the editor is not tested in Firefox";
  const dir = folder({ "logo.svg": sample("logo.svg") });
  const editor = await edit(`${dir}/logo.svg`);
  const page = await firefox(program, editor.address);
  try {
    await page.until("document.querySelectorAll('.knob').length > 0", "there are no handles");
    const first = await page.evaluate(PATHS);
    check(first.length > 100, "there is no picture");
    await page.drag('.knob[data-key="shaper/0.0/2"]', 37, -41);
    await page.until(`${PATHS} !== ${JSON.stringify(first)}`, "the picture did not follow");
    await page.until("!document.querySelector('#undo').disabled", "the drag cannot be undone");
    await page.control("z");
    await page.until(`${PATHS} === ${JSON.stringify(first)}`, "Ctrl Z does nothing");
    await page.evaluate("Array.from(document.querySelectorAll('.card'), (c) => c).find((c) => c.textContent === 'Flag').click()");
    await page.until("document.querySelector('#steps').textContent.includes('Flag')", "the style was not chosen");
    await page.until("!document.querySelector('#save').disabled", "it cannot be saved");
    await page.click("#save");
    await page.until("document.querySelector('#toast').classList.contains('on')", "nothing was saved");
    check(existsSync(`${dir}/logo-bent.svg`), "there is no file");
    const words = async (text) => {
      const before = await page.evaluate(PATHS);
      await page.click("#words");
      await page.until("document.querySelector('#words-dialog').open", "there is no dialog");
      await page.evaluate(`document.querySelector('#words-text').value = ${JSON.stringify(text)}`);
      await page.click("#words-dialog button[type=submit]");
      await page.until("!document.querySelector('#words-dialog').open", "the words are not set");
      await page.until(`${PATHS} !== ${JSON.stringify(before)}`, `${text} is not on show`);
      await page.until("document.querySelectorAll('.knob').length > 0", "there are no handles");
    };
    await words("Ahoy");
    check(await page.evaluate("document.querySelector('#file').textContent") === "ahoy.svg", "the drawing has not the name of its words");
    const ahoy = await page.evaluate(PATHS);
    await words("Ahoi");
    await page.click("#undo");
    await page.until(`${PATHS} === ${JSON.stringify(ahoy)}`, "the words are not undone");
    const found = await page.evaluate(`await ${AXE}`);
    check(found.length === 0, found.join("\n"));
    check(page.problems.length === 0, page.problems.join("; "));
  } finally {
    editor.stop();
    await page.stop();
  }
  return undefined;
}
