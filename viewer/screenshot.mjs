// A picture of a report's first 3D view, as the documentation shows it.
//
// Usage: node screenshot.mjs REPORT OUTPUT.png [LEVEL [LAYERS]]   (layers that are switched, by name with commas)
import path from "node:path";
import { pathToFileURL } from "node:url";
import { findChromium, launch } from "./tests/browser.mjs";

const [report, output, level = "1", layers = "quality,dropped"] = process.argv.slice(2);
const browser = await launch(findChromium());
const page = await browser.newPage({ viewport: { width: 1240, height: 700 } });
await page.goto(pathToFileURL(path.resolve(report)).href);
const view = page.locator(".viewer.v-live").first();
await view.locator("input[type=range]").fill(level);
await page.waitForSelector(`.viewer[data-level="${level}"]`);
await view.getByRole("button", { name: "Compare" }).click();
for (const name of layers.split(",").filter(Boolean))
  await view.locator(`input[name=${name}]`).click();
await view.scrollIntoViewIfNeeded();
await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
await view.screenshot({ path: output });
await browser.close();
