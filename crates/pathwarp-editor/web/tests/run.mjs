// Runs all tests of the page, or those whose names contain one of the words given.
import { close } from "./harness.mjs";
import * as dragging from "./dragging.mjs";
import * as files from "./files.mjs";
import * as keeping from "./keeping.mjs";
import * as safety from "./safety.mjs";
import * as access from "./access.mjs";
import * as inkscape from "./inkscape.mjs";
import * as points from "./points.mjs";
import * as modes from "./modes.mjs";
import * as choosing from "./choosing.mjs";
import * as working from "./working.mjs";
import * as several from "./several.mjs";
import * as jobs from "./jobs.mjs";
import * as parts from "./parts.mjs";
import * as drawn from "./drawn.mjs";
import * as first from "./first.mjs";
import * as details from "./details.mjs";

const wanted = process.argv.slice(2);
const tests = Object.entries({ ...dragging, ...files, ...keeping, ...points, ...modes, ...choosing, ...working, ...several, ...jobs, ...parts, ...drawn, ...first, ...details, ...safety, ...access, ...inkscape })
  .filter(([name]) => wanted.length === 0 || wanted.some((word) => name.includes(word)));
let failed = 0;

/** Takes tests, one after the other, until none is left. */
async function lane() {
  for (let next = tests.shift(); next; next = tests.shift()) {
    const [name, test] = next;
    const start = performance.now();
    try {
      const remark = await test();
      console.log(remark ? `      ${remark}` : `ok    ${name} (${Math.round(performance.now() - start)} ms)`);
    } catch (e) {
      failed += 1;
      console.log(`FAILED ${name}: ${e.stack}`);
    }
  }
}

// A page mostly waits; two keep a processor busy. In Firefox, one at a time has the focus.
await Promise.all(process.env.TESTED_IN === "firefox" ? [lane()] : [lane(), lane()]);
await close();
process.exit(failed === 0 ? 0 : 1);
