// Shows drawings in headless Chromium. Each line of standard input is a request as JSON: {file, size: [width, height], scale}; without a
// size, the drawing is only asked how large it is. Each is answered by a line: {broken, right, bottom, matrix, png} or {error}.
import { createRequire } from "node:module";
import { createInterface } from "node:readline";
import { existsSync } from "node:fs";
import { pathToFileURL } from "node:url";

const { chromium } = createRequire(new URL("../../../pathwarp-editor/web/package.json", import.meta.url))("playwright-core");
const executablePath = ["/usr/bin/chromium-headless-shell", "/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"].find((p) => existsSync(p));
// Letters have their exact places and no coloured edges, and linked files are read.
const args = ["--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--allow-file-access-from-files", "--font-render-hinting=none", "--disable-lcd-text"];
// The last resort in ms: a browser that does nothing for so long hangs, on any machine.
const TIMEOUT = 1000000;
// On a busy machine a browser now and then takes no picture ("Unable to capture screenshot"); a new one does.
const ATTEMPTS = 10;

/** The page's extent in px, and the matrix from user units to px. */
const asked = () => {
  const root = document.documentElement;
  const box = root.getBoundingClientRect();
  const m = root.getScreenCTM?.();
  return {
    broken: document.getElementsByTagName("parsererror").length > 0 || document.contentType.includes("svg") && root.namespaceURI != "http://www.w3.org/2000/svg",
    right: box.right, bottom: box.bottom, matrix: m ? [m.a, m.b, m.c, m.d, m.e, m.f] : null,
  };
};

const launch = () => chromium.launch({ executablePath, headless: true, args });
let browser = await launch();

async function show({ file, size, scale, zoom }) {
  const [width, height] = size ?? [600, 600];
  const page = await browser.newPage({ viewport: { width, height }, deviceScaleFactor: scale ?? 1, locale: "en-US" });
  await page.goto(pathToFileURL(file).href, { waitUntil: "load", timeout: TIMEOUT });
  const answer = await page.evaluate(asked);
  // Chromium stretches a page with a fraction of a px to whole ones; magnified by its style, it keeps its proportions.
  if (size && !zoom && scale !== 1 && (answer.right % 1 || answer.bottom % 1)) {
    await page.close();
    return show({ file, size: size.map((side) => Math.round(side * scale)), scale: 1, zoom: scale });
  }
  if (size) {
    await page.evaluate((zoom) => { if (zoom) document.documentElement.style.zoom = zoom; }, zoom);
    // What moves is shown as it begins.
    await page.evaluate(() => { document.documentElement.pauseAnimations?.(); document.documentElement.setCurrentTime?.(0); });
    const png = await page.screenshot({ animations: "disabled", omitBackground: true, timeout: TIMEOUT });
    answer.png = png.toString("base64");
  }
  await page.close();
  return answer;
}

for await (const line of createInterface({ input: process.stdin })) {
  let answer;
  for (let left = ATTEMPTS; left > 0; left--) {
    try {
      answer = await show(JSON.parse(line));
      break;
    } catch (e) {
      answer = { error: String(e.message).split("\n")[0] };
      await browser.close().catch(() => {});
      browser = await launch();
    }
  }
  console.log(JSON.stringify(answer));
}
await browser.close();
