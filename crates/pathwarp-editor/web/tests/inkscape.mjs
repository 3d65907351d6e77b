// *Bend by hand…* as Inkscape calls it, without Inkscape: the program waits for the page and prints the drawing that the user keeps.
import { spawn } from "node:child_process";
import { writeFileSync } from "node:fs";
import { awaited, check, choose, drag, emptyFolder, open, paths, program, quiet, standIn } from "./harness.mjs";

const DRAWING = `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 400 200">
<path id="a" d="M20,20h160v60h-160z"/><path id="b" style="fill:#c03030" d="M220,20h160v60h-160z"/></svg>`;

/** Calls the effect. A program in the place of the browser tells the address of the page. */
async function call(svg, ...ids) {
  const dir = emptyFolder();
  writeFileSync(`${dir}/ink_ext_1.svg`, svg);
  const browser = standIn(dir);
  const args = [...ids.map((id) => `--id=${id}`), "--inkscape-action=hand", `${dir}/ink_ext_1.svg`];
  const child = spawn(program, args, { stdio: ["ignore", "pipe", "pipe"], env: { ...process.env, BROWSER: browser.path, DOCUMENT_PATH: "/home/me/poster.svg" } });
  process.once("exit", () => child.kill("SIGKILL"));
  let [out, said] = ["", ""];
  child.stdout.on("data", (text) => (out += text));
  child.stderr.on("data", (text) => (said += text));
  const ended = new Promise((resolve) => child.once("close", (code) => resolve({ code, out, said })));
  const opened = await awaited(Promise.race([browser.opened, ended]), "the page");
  check(typeof opened === "string", `no page was opened: ${said}`);
  return { page: await open(opened), ended };
}

async function kept(svg, act, ...ids) {
  const { page, ended } = await call(svg, ...ids);
  await act(page);
  await page.click("#save");
  const { code, out, said } = await awaited(ended, "the end of the program");
  check(code === 0 && said === "", `${code}: ${said}`);
  await page.waitForFunction(() => document.querySelector("#gone").textContent.includes("Inkscape has the result"));
  check(page.problems.length === 0, page.problems.join("; "));
  await page.context().close();
  return out;
}

const data = (svg, id) => new RegExp(`<path[^>]*id="${id}"[^>]* d="([^"]*)"`).exec(svg)?.[1];
const recipe = (svg) => /pathwarp:recipe="([^"]*)"/.exec(svg)?.[1];

export async function inkscape_gets_what_is_kept_and_goes_on_with_it() {
  const once = await kept(DRAWING, async (page) => {
    check((await page.textContent("#save")) === "Keep in Inkscape", await page.textContent("#save"));
    check((await page.textContent("#file")) === "poster.svg", await page.textContent("#file"));
    check((await page.isDisabled("#save")) && !(await page.isVisible("#save-as")), "nothing is there to be kept yet");
    await drag(page, "shaper/0.0/2", 30, -40);
    await page.click("#add-step");
    await choose(page, "Flag");
  }, "b");
  check(once.includes('d="M20,20h160v60h-160z"'), "what is not selected has changed");
  check(data(once, "b") !== undefined && data(once, "b") !== data(DRAWING, "b"), once);
  check(/^shaper .* \+ warp .*--style=flag/.test(recipe(once)), recipe(once));

  // Once more: the steps are there again, and the artwork starts from its source.
  const again = await kept(once, async (page) => {
    const steps = await page.locator("#steps li").allTextContents();
    check(steps.length === 2 && /Flag/.test(steps[1]), steps.join());
    await page.click("[aria-label='Remove Flag']");
    await quiet(page);
  }, "b");
  check(/^shaper /.test(recipe(again)) && !recipe(again).includes("+"), recipe(again));
  const source = (svg) => /pathwarp:source="([^"]*)"/.exec(svg)?.[1];
  check(source(again) === source(once), "the source is another one");
}

export async function inkscape_keeps_its_drawing_when_the_page_is_closed() {
  const { page, ended } = await call(DRAWING, "a", "b");
  const before = await paths(page);
  await drag(page, "shaper/0.0/2", 30, -40);
  check((await paths(page)) !== before, "the picture did not follow");
  await page.context().close();
  const { code, out, said } = await awaited(ended, "the end of the program");
  check(code === 0 && out === "" && said === "", `${code}: ${out}${said}`);
}
