// Bundles the page's scripts into ../assets, where its other files are, or into the folder given.
import { build } from "esbuild";
import { mkdir } from "node:fs/promises";
import { fileURLToPath } from "node:url";

const here = (path) => fileURLToPath(new URL(path, import.meta.url));
const to = process.argv[2] ?? here("../assets");
await mkdir(to, { recursive: true });
await build({
  entryPoints: [here("src/main.ts")],
  outfile: `${to}/editor.js`,
  bundle: true,
  format: "iife",
  target: ["chrome110", "firefox115", "safari16"],
  charset: "utf8",
  legalComments: "none",
  logLevel: "warning",
});
