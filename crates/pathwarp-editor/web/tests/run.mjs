// Runs all tests of the page, or those whose names contain a word given.
import { close } from "./harness.mjs";
import * as dragging from "./dragging.mjs";
import * as files from "./files.mjs";
import * as safety from "./safety.mjs";
import * as access from "./access.mjs";
import * as firefox from "./firefox.mjs";
import * as inkscape from "./inkscape.mjs";
import * as points from "./points.mjs";

const wanted = process.argv[2] ?? "";
let failed = 0;
for (const [name, test] of Object.entries({ ...dragging, ...files, ...points, ...safety, ...access, ...inkscape, ...firefox })) {
  if (!name.includes(wanted)) continue;
  const start = performance.now();
  try {
    const remark = await test();
    console.log(remark ? `      ${remark}` : `ok    ${name} (${Math.round(performance.now() - start)} ms)`);
  } catch (e) {
    failed += 1;
    console.log(`FAILED ${name}: ${e.stack}`);
  }
}
await close();
process.exit(failed === 0 ? 0 : 1);
