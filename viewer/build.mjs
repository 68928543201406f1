// Bundles src/ with three.js into one script. Usage: node build.mjs OUTPUT
import { build } from "esbuild";

const output = process.argv[2] ?? "../build/viewer/viewer.js";
await build({
  entryPoints: [new URL("src/main.js", import.meta.url).pathname],
  bundle: true,
  minify: true,
  format: "iife",
  target: ["chrome90", "firefox113", "safari16.4"],
  loader: { ".css": "text", ".glsl": "text" },
  legalComments: "inline",
  charset: "ascii",
  outfile: output,
});
