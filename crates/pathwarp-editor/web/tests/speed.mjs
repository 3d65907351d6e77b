// Measures the time from a drag to its picture, with real drags in headless Chromium, and prints where it goes. Not a test: other
// programs may have the processor meanwhile. Run it on a quiet machine with `node tests/speed.mjs [DRAWING.svg…]`.
import { readFileSync } from "node:fs";
import { basename } from "node:path";
import { close, curves, edit, folder, middle, open, quiet } from "./harness.mjs";

/** Drags and the pause between two of them, in ms: a mouse reports at least this often. */
const DRAGS = 300;
const PAUSE = 8;
/** Clock ticks of the kernel per second. */
const TICKS = 100;

const drawings = process.argv.slice(2).map((file) => [basename(file), readFileSync(file, "utf8")]);
if (drawings.length === 0) drawings.push(["500 curves", curves(500)], ["10,000 curves", curves(10000)]);

/** Processor time of a program so far, in ms. */
function processor(pid) {
  const fields = readFileSync(`/proc/${pid}/stat`, "utf8").split(") ")[1].split(" ");
  return ((Number(fields[11]) + Number(fields[12])) * 1000) / TICKS;
}

const share = (sorted, part) => sorted[Math.min(sorted.length - 1, Math.floor(part * sorted.length))] ?? NaN;

/** Half of the values and 95 of 100 are within these. */
function spread(values) {
  const sorted = [...values].sort((a, b) => a - b);
  return `${share(sorted, 0.5).toFixed(1)} / ${share(sorted, 0.95).toFixed(1)} ms`;
}

/** When pictures were drawn on the screen: for each mark, the first frame drawn after the commit that follows it. */
function drawn(events) {
  const time = (names, after) => events.filter((e) => names.includes(e.name) && e.ts >= after).sort((a, b) => a.ts - b.ts);
  const marks = time(["pathwarp picture"], 0);
  const commits = time(["Commit"], 0).map((e) => e.ts + (e.dur ?? 0));
  const frames = time(["DrawFrame"], 0).map((e) => e.ts);
  const activations = time(["ActivateLayerTree"], 0).map((e) => e.ts);
  return marks.map((mark) => {
    const commit = commits.find((ts) => ts >= mark.ts);
    const active = activations.find((ts) => ts >= commit);
    const frame = frames.find((ts) => ts >= active);
    return frame === undefined ? null : (frame - mark.ts) / 1000;
  });
}

async function measure(name, svg) {
  const dir = folder({ "art.svg": svg });
  const editor = await edit(`${dir}/art.svg`);
  const page = await open(editor.address);
  const session = await page.context().newCDPSession(page);
  await session.send("Performance.enable");
  const metrics = async () => Object.fromEntries((await session.send("Performance.getMetrics")).metrics.map((m) => [m.name, m.value]));
  const key = "shaper/0.0/2";
  const [x, y] = await middle(page, key);
  // The gallery draws its small pictures first.
  await page.waitForTimeout(5000);
  await page.mouse.move(x, y);
  await page.mouse.down();
  for (let i = 0; i < 20; i++) await page.mouse.move(x + i / 3, y - i / 3);
  const events = [];
  session.on("Tracing.dataCollected", ({ value }) => events.push(...value));
  const categories = ["blink.user_timing", "devtools.timeline", "disabled-by-default-devtools.timeline", "disabled-by-default-devtools.timeline.frame", "devtools.timeline.frame", "cc"];
  await session.send("Tracing.start", { traceConfig: { includedCategories: categories }, transferMode: "ReportEvents" });
  await page.evaluate(() => {
    window.drafts = [];
    window.addEventListener("pathwarp-drafted", ({ detail }) => {
      window.drafts.push(detail);
      // Marks the picture in the trace.
      performance.mark("pathwarp picture");
    });
  });
  const [before, program] = [await metrics(), processor(editor.child.pid)];
  for (let i = 0; i < DRAGS; i++) {
    await page.mouse.move(x + 60 * Math.sin(i / 9), y - 40 * Math.sin(i / 7));
    await page.waitForTimeout(PAUSE);
  }
  const [after, programAfter] = [await metrics(), processor(editor.child.pid)];
  const done = new Promise((resolve) => session.once("Tracing.tracingComplete", resolve));
  await session.send("Tracing.end");
  await done;
  const entries = await page.evaluate(() => window.drafts);
  await page.mouse.up();
  await quiet(page);
  const n = entries.length;
  const toScreen = drawn(events);
  const whole = entries.map((e, i) => (toScreen[i] == null ? null : e.shown - e.start + toScreen[i])).filter((v) => v !== null);
  const each = (key) => `${((1000 * (after[key] - before[key])) / n).toFixed(2)} ms`;
  console.log(`${name}: ${n} pictures`);
  console.log(`  drag to picture (half within / 95 of 100 within): ${spread(entries.map((e) => e.shown - e.start))}`);
  console.log(`  of that, program and socket: ${spread(entries.map((e) => e.answered - e.asked))}; waiting before: ${spread(entries.map((e) => e.asked - e.start))}`);
  console.log(`  drag to screen: ${spread(whole)} (${whole.length} pictures)`);
  console.log(`  processor time for each: program ${((programAfter - program) / n).toFixed(2)} ms, page ${each("TaskDuration")} (script ${each("ScriptDuration")}, styles ${each("RecalcStyleDuration")}, layout ${each("LayoutDuration")})`);
  const sum = (names) => events.filter((e) => names.includes(e.name)).reduce((t, e) => t + (e.dur ?? 0), 0) / 1000 / n;
  console.log(`  painting for each: ${sum(["Paint"]).toFixed(2)} ms recorded, ${sum(["RasterTask"]).toFixed(2)} ms drawn; sent ${Math.round((entries.reduce((t, e) => t + e.size, 0)) / n / 1000)} KB`);
  editor.stop();
  await page.context().close();
}

for (const [name, svg] of drawings) await measure(name, svg);
await close();
process.exit(0);
