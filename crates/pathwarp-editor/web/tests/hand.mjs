// Stands in for a user and the browser: `node hand.mjs keep|close ADDRESS` drags a corner, and keeps the result or closes the page.
import { close, drag, open } from "./harness.mjs";

const [what, address] = process.argv.slice(2);
const page = await open(address);
await drag(page, "shaper/0.0/2", 40, -30);
if (what === "keep") {
  await page.click("#save");
  await page.waitForFunction(() => document.querySelector("#gone").textContent.includes("Inkscape has the result"));
}
await close();
process.exit(0);
