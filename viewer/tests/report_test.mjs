// A report of the program in a real browser, as a person would use it.
//
// Usage: node report_test.mjs PROGRAM FOLDER   (exit code 77: something it needs is not installed)
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { existsSync, readFileSync, rmSync } from "node:fs";
import { createRequire } from "node:module";
import path from "node:path";
import { pathToFileURL } from "node:url";

const [program, folder] = process.argv.slice(2);
const root = path.resolve(path.dirname(new URL(import.meta.url).pathname), "../..");
const script = path.join(root, "build/viewer/viewer.js");

function skip(what) {
  console.log(`skipped: ${what}`);
  process.exit(77);
}

if (!existsSync(script) || !existsSync(path.join(root, "viewer/node_modules/playwright-core")))
  skip("the viewer is not set up (scripts/setup_viewer.sh)");
const { findChromium, launch } = await import("./browser.mjs");
const chromium = findChromium();
if (!chromium) skip("Chromium is not installed (Debian: apt-get install chromium)");

function run(...words) {
  const { status, stderr } = spawnSync(program, words, {
    cwd: folder, encoding: "utf8", env: { ...process.env, SCALEFCN_VIEWER: script },
  });
  assert.equal(status, 0, `${words.join(" ")}: ${stderr}`);
}

// Ribs closer than the scale, so that something must go; and a second mesh.
function makeReport() {
  rmSync(folder, { recursive: true, force: true });
  spawnSync("mkdir", ["-p", folder]);
  run("model", "ribs", "--resolution", "0.05", "--spacing", "0.1", "-o", "ribs.off");
  run("model", "gear", "-o", "gear.off");
  run("run", "ribs.off", "gear.off", "--method", "sharp", "--scales", "6%,12%", "--solvers", "none",
      "--baselines", "own-plain", "--threads", "1", "-o", "out");
  return pathToFileURL(path.join(folder, "out/report.html")).href;
}

// A box has eight irregular vertices where quads follow its edges, one at each corner.
function makeQuadReport() {
  run("model", "box", "--resolution", "0.1", "-o", "box.off");
  run("run", "box.off", "--method", "sharp", "--scales", "6%,12%", "--target", "quad", "--solvers", "none",
      "--threads", "1", "-o", "quads");
  return pathToFileURL(path.join(folder, "quads/report.html")).href;
}

const view = "#mesh-1-viewer";
const canvas = `${view} canvas`;

// Ends when all that was asked for has been drawn.
async function settled(page) {
  await page.evaluate(
    () => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))),
  );
}

async function picture(page) {
  await settled(page);
  return page.evaluate((which) => document.querySelector(which).toDataURL(), canvas);
}

async function open(browser, address, options = {}) {
  const context = await browser.newContext({ viewport: { width: 1000, height: 640 }, ...options });
  await context.setOffline(true);
  const page = await context.newPage();
  page.setDefaultTimeout(120000); // other programs may be busy, too
  page.complaints = [];
  page.on("console", (message) => {
    if (["error", "warning"].includes(message.type())) page.complaints.push(message.text());
  });
  page.on("pageerror", (error) => page.complaints.push(error.message));
  page.on("request", (request) => {
    if (!/^(file|data|blob):/.test(request.url())) page.complaints.push(request.url());
  });
  await page.goto(address);
  return page;
}

async function openView(browser, address, options) {
  const page = await open(browser, address, options);
  await page.waitForSelector(`${view}.v-live`);
  await page.locator(view).scrollIntoViewIfNeeded();
  return page;
}

async function setLevel(page, level) {
  await page.locator(`${view} input[type=range]`).fill(String(level));
  await page.waitForSelector(`${view}[data-level="${level}"]`);
}

const tests = {
  "the slider shows every level": async (page) => {
    const seen = new Set();
    for (const level of [0, 1, 2]) {
      await setLevel(page, level);
      seen.add(await picture(page));
      const label = await page.locator(`${view} output`).textContent();
      assert.equal(label, ["input", "6%", "12%"][level]);
    }
    assert.equal(seen.size, 3);
  },

  "every layer changes the picture, and back": async (page) => {
    await setLevel(page, 2);
    const before = await picture(page);
    const boxes = page.locator(`${view} fieldset input`);
    assert.equal(await boxes.count(), 7);
    for (let i = 0; i < 7; ++i) {
      await boxes.nth(i).click();
      assert.notEqual(await picture(page), before, await boxes.nth(i).getAttribute("name"));
      await boxes.nth(i).click();
      assert.equal(await picture(page), before, await boxes.nth(i).getAttribute("name"));
    }
  },

  "surfaces can be chosen": async (page) => {
    const select = page.locator(`${view} select`).first();
    const names = await select.locator("option").allTextContents();
    assert.equal(names.length, 4);
    assert.equal(names[3], "Plain remesh, no features");
    const seen = new Set();
    for (const name of names) {
      await select.selectOption(name);
      seen.add(await picture(page));
    }
    assert.equal(seen.size, 4);
    await select.selectOption(names[1]);
  },

  "both panes of a comparison look from the same side": async (page) => {
    const halves = () =>
      page.evaluate((which) => {
        const whole = document.querySelector(which);
        return [0, 1].map((half) => {
          const part = document.createElement("canvas");
          part.width = Math.floor(whole.width / 2) - 4;
          part.height = whole.height;
          part.getContext("2d").drawImage(whole, -half * Math.ceil(whole.width / 2) - 2, 0);
          return part.toDataURL();
        });
      }, canvas);
    await page.locator(`${view} button`, { hasText: "Compare" }).click();
    const second = page.locator(`${view} select`).nth(1);
    const different = await second.inputValue();
    await settled(page);
    let [left, right] = await halves();
    assert.notEqual(left, right);
    await page.locator(canvas).focus();
    await page.keyboard.press("ArrowLeft");
    await settled(page);
    const turned = await halves();
    assert.notEqual(turned[0], left);
    assert.notEqual(turned[1], right);
    await second.selectOption(await page.locator(`${view} select`).first().inputValue());
    await settled(page);
    [left, right] = await halves();
    assert.equal(await page.locator(`${view} .v-pane .v-facts`).nth(0).textContent(),
                 await page.locator(`${view} .v-pane .v-facts`).nth(1).textContent());
    await second.selectOption(different);
    await page.keyboard.press("c");
    await page.locator(`${view} button`, { hasText: "Home view" }).click();
  },

  "keys turn, shift, magnify, and come home": async (page) => {
    await page.locator(canvas).focus();
    await page.keyboard.press("0");
    const home = await picture(page);
    for (const key of ["ArrowUp", "Shift+ArrowLeft", "+", "."]) {
      await page.keyboard.press(key);
      assert.notEqual(await picture(page), home, key);
      await page.keyboard.press("0");
      assert.equal(await picture(page), home, key);
    }
    await page.keyboard.press("[");
    await page.waitForSelector(`${view}[data-level="1"]`);
    await page.keyboard.press("]");
    await page.waitForSelector(`${view}[data-level="2"]`);
  },

  "the mouse turns; the wheel magnifies only with the focus": async (page) => {
    const box = await page.locator(canvas).boundingBox();
    const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
    await page.locator(`${view} button`, { hasText: "Home view" }).click();
    const home = await picture(page);
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x + 60, y + 30, { steps: 3 });
    await page.mouse.up();
    const turned = await picture(page);
    assert.notEqual(turned, home);
    await page.mouse.wheel(0, -200);
    assert.notEqual(await picture(page), turned);
    await page.locator(`${view} button`, { hasText: "Home view" }).click();
    assert.equal(await picture(page), home);
  },

  "a row of the table shows its curve": async (page) => {
    const before = await picture(page);
    const row = page.locator(`${view} tbody tr`).first();
    await row.click();
    assert.notEqual(await picture(page), before);
    const text = await page.locator(`${view} .v-chosen`).textContent();
    assert.ok(text.includes(`Curve ${await row.getAttribute("data-curve")}`), text);
    assert.equal(await row.locator("button").getAttribute("aria-pressed"), "true");
    await page.locator(canvas).focus();
    await page.keyboard.press("Escape");
    assert.equal(await picture(page), before);
  },

  "pointing at a dropped piece tells the reason": async (page) => {
    await page.locator(`${view} input[name=adapted]`).uncheck();
    await page.locator(`${view} select`).first().selectOption("Input");
    const places = await orangePlaces(page);
    assert.ok(places.length > 0, "nothing orange is drawn");
    const box = await page.locator(canvas).boundingBox();
    const tip = page.locator(`${view} .v-tip`);
    let text = "";
    for (const [x, y] of places) {
      await page.mouse.move(box.x + x, box.y + y);
      await settled(page);
      if (await tip.isVisible()) text = await tip.textContent();
      if (text.includes("lost against")) break;
    }
    assert.match(text, /Dropped.*lost against.*weight/);
    await page.mouse.move(box.x + 3, box.y + 3);
    await settled(page);
    assert.ok(!(await tip.isVisible()));
    await page.locator(`${view} input[name=adapted]`).check();
  },

  "a curve behind the surface is not named": async (page) => {
    for (const name of ["adapted", "surface"])
      await page.locator(`${view} input[name=${name}]`).uncheck();
    const all = await orangePlaces(page, 1000);
    await page.locator(`${view} input[name=surface]`).check();
    const seen = await orangePlaces(page, 1e6);
    const hidden = all.filter(([x, y]) => seen.every(([u, v]) => Math.hypot(x - u, y - v) > 15));
    assert.ok(hidden.length > 0, "nothing is hidden");
    const box = await page.locator(canvas).boundingBox();
    const tip = page.locator(`${view} .v-tip`);
    for (const isShown of [true, false]) {
      await page.locator(`${view} input[name=surface]`).setChecked(isShown);
      let named = 0;
      for (const [x, y] of hidden.slice(0, 12)) {
        await page.mouse.move(box.x + x, box.y + y);
        await settled(page);
        if (await tip.isVisible()) ++named;
      }
      if (isShown) assert.equal(named, 0);
      else assert.ok(named > 0);
    }
    for (const name of ["adapted", "surface"])
      await page.locator(`${view} input[name=${name}]`).check();
    await page.mouse.move(box.x + 3, box.y + 3);
  },

  "a picture can be saved": async (page) => {
    const download = page.waitForEvent("download");
    await page.locator(`${view} button`, { hasText: "Save picture" }).click();
    const bytes = readFileSync(await (await download).path());
    assert.deepEqual([...bytes.subarray(0, 4)], [137, 80, 78, 71]);
    assert.match((await download).suggestedFilename(), /^ribs-12%\.png$/);
  },

  "links lead to what is there": async (page) => {
    const targets = await page.$$eval("a[href^='#']", (links) => links.map((a) => a.hash.slice(1)));
    assert.ok(targets.length >= 7);
    for (const id of targets) assert.equal(await page.locator(`[id="${id}"]`).count(), 1, id);
    await page.locator("nav a").last().click();
    assert.equal(await page.evaluate(() => location.hash.slice(1)), targets.at(-1));
  },

  "every mesh has a view of its own": async (page) => {
    await page.locator("#mesh-2-viewer").scrollIntoViewIfNeeded();
    await page.waitForSelector("#mesh-2-viewer.v-live[data-frames]");
    await page.locator(view).scrollIntoViewIfNeeded();
    const first = await picture(page);
    await page.locator("#mesh-2-viewer input[name=edges]").click();
    assert.equal(await picture(page), first);
  },

  "axe finds no serious fault": async (page) => {
    const axe = createRequire(import.meta.url).resolve("axe-core/axe.min.js");
    await page.evaluate(readFileSync(axe, "utf8"));
    const { violations } = await page.evaluate(() => axe.run());
    const serious = violations.filter((v) => ["serious", "critical"].includes(v.impact));
    assert.deepEqual(serious.map((v) => `${v.id}: ${v.nodes[0].html}`), []);
  },
};

const quadTests = {
  "quads are what is shown first, with their measures": async (page) => {
    await setLevel(page, 2);
    assert.equal(await page.locator(`${view} select`).first().inputValue(),
                 "Quads on the adapted network");
    assert.match(await page.locator(`${view} .v-pane .v-facts`).first().textContent(),
                 /\d+\squads · scaled\sJacobian\s[01]\.\d+/);
    assert.match(await page.locator(`${view} .v-bar`).textContent(), /Quads: Along a cross field/);
  },

  "every layer of quads changes the picture, and back": async (page) => {
    const before = await picture(page);
    const boxes = page.locator(`${view} fieldset input`);
    assert.equal(await boxes.count(), 9);
    for (const name of ["edges", "quality", "field", "singularities"]) {
      const box = page.locator(`${view} input[name=${name}]`);
      await box.click();
      assert.notEqual(await picture(page), before, name);
      await box.click();
      assert.equal(await picture(page), before, name);
    }
    await page.locator(canvas).focus();
    for (const key of ["8", "9"]) {
      await page.keyboard.press(key);
      assert.notEqual(await picture(page), before, key);
      await page.keyboard.press(key);
      assert.equal(await picture(page), before, key);
    }
  },

  "edges are those of quads, without the cuts": async (page) => {
    // On the same surface n squares have edges of 2 n^(1/2), cut ones 3.4, n pairs of triangles 3.2.
    for (const name of ["adapted", "dropped", "singularities"])
      await page.locator(`${view} input[name=${name}]`).uncheck();
    const select = page.locator(`${view} select`).first();
    await select.selectOption("Quads on the adapted network");
    const [first] = await darkShare(page);
    const perQuad = first.dark / Math.sqrt(first.faces);
    await select.selectOption("Remesh on the adapted network");
    const [other] = await darkShare(page);
    const perTriangle = other.dark / Math.sqrt(other.faces / 2);
    assert.ok(first.dark > 500 && perQuad < 0.85 * perTriangle, `${perQuad} ${perTriangle}`);
    await select.selectOption("Quads on the adapted network");
    for (const name of ["adapted", "dropped", "singularities"])
      await page.locator(`${view} input[name=${name}]`).check();
  },

  "irregular vertices are red, and say what they are": async (page) => {
    await page.locator(`${view} input[name=adapted]`).uncheck();
    const places = await placesOf(page, [200, 30, 60]);
    assert.ok(places.length > 0, "no red mark is drawn");
    const box = await page.locator(canvas).boundingBox();
    await page.mouse.move(box.x + places[0][0], box.y + places[0][1]);
    await settled(page);
    const tip = page.locator(`${view} .v-tip`);
    assert.match(await tip.textContent(), /Irregular vertex of index \+1\/4.*3 quads/);
    await page.mouse.click(box.x + places[0][0], box.y + places[0][1]);
    assert.match(await page.locator(`${view} .v-chosen`).textContent(), /index \+1\/4/);
    await page.mouse.move(box.x + 3, box.y + 3);
    await page.keyboard.press("Escape");
    await page.locator(`${view} input[name=adapted]`).check();
  },

  "each kind of face has its own legend": async (page) => {
    const legends = () =>
      page.$$eval(`${view} .v-legend`, (all) => all.filter((l) => !l.hidden).map((l) => l.textContent));
    assert.deepEqual(await legends(), []);
    await page.locator(`${view} input[name=quality]`).check();
    assert.equal((await legends()).length, 1);
    assert.match((await legends())[0], /Jacobian/);
    await page.locator(canvas).focus();
    await page.keyboard.press("c");
    assert.equal((await legends()).length, 2);
    await page.keyboard.press("c");
    await page.locator(`${view} input[name=quality]`).uncheck();
  },

  "what a level has not cannot be switched": async (page) => {
    await setLevel(page, 0);
    for (const [name, isOff] of [["field", true], ["singularities", true], ["edges", false]])
      assert.equal(await page.locator(`${view} input[name=${name}]`).isDisabled(), isOff, name);
    await setLevel(page, 1);
    assert.equal(await page.locator(`${view} input[name=field]`).isDisabled(), false);
  },
};

// What is darker than any shading of the surface, in CSS pixels, and the faces that are shown.
async function darkShare(page) {
  await settled(page);
  return page.evaluate(([which, facts]) => {
    const whole = document.querySelector(which);
    const copy = Object.assign(document.createElement("canvas"),
                               { width: whole.width, height: whole.height });
    const context = copy.getContext("2d", { willReadFrequently: true });
    context.drawImage(whole, 0, 0);
    const { data } = context.getImageData(0, 0, whole.width, whole.height);
    let dark = 0;
    for (let i = 0; i < data.length; i += 4) dark += data[i] < 110;
    const words = document.querySelector(facts).textContent.replaceAll(",", "");
    return [{ dark, faces: Number.parseInt(words, 10) }];
  }, [canvas, `${view} .v-pane .v-facts`]);
}

// Pixels in the colour of dropped pieces, about `most` of them, in CSS pixels.
function orangePlaces(page, most = 40) {
  return placesOf(page, [213, 94, 0], most);
}

async function placesOf(page, color, most = 40) {
  await settled(page);
  return page.evaluate(([which, [red, green, blue], count]) => {
    const whole = document.querySelector(which);
    const copy = Object.assign(document.createElement("canvas"),
                               { width: whole.width, height: whole.height });
    const context = copy.getContext("2d", { willReadFrequently: true });
    context.drawImage(whole, 0, 0);
    const { data, width } = context.getImageData(0, 0, whole.width, whole.height);
    const scale = whole.clientWidth / width;
    const found = [];
    for (let i = 0; i < data.length; i += 4)
      if (data[i] === red && data[i + 1] === green && data[i + 2] === blue)
        found.push([((i / 4) % width) * scale, Math.floor(i / 4 / width) * scale]);
    return found.filter((_, i) => i % Math.ceil(found.length / count) === 0);
  }, [canvas, color, most]);
}

async function testPhone(browser, address) {
  const page = await openView(browser, address, {
    viewport: { width: 390, height: 800 }, hasTouch: true, isMobile: true,
  });
  const width = await page.evaluate(() => document.documentElement.scrollWidth);
  assert.ok(width <= 390, `the page is ${width} pixels wide`);
  const touch = await page.context().newCDPSession(page);
  const box = await page.locator(canvas).boundingBox();
  const at = (dx, id) => ({ x: box.x + box.width / 2 + dx, y: box.y + box.height / 2, id });
  const gesture = async (...steps) => {
    for (const [i, touchPoints] of steps.entries())
      await touch.send("Input.dispatchTouchEvent", {
        type: i === 0 ? "touchStart" : touchPoints.length ? "touchMove" : "touchEnd", touchPoints,
      });
  };
  const before = await picture(page);
  await gesture([at(0, 1)], [at(30, 1)], [at(60, 1)], []);
  const turned = await picture(page);
  assert.notEqual(turned, before, "one finger turns");
  await gesture([at(-20, 1), at(20, 2)], [at(-30, 1), at(40, 2)], [at(-50, 1), at(60, 2)], []);
  assert.notEqual(await picture(page), turned, "two fingers magnify");
  assert.deepEqual(page.complaints, []);
}

async function expectPicturesOnly(page, words) {
  const text = await page.locator(view).textContent();
  assert.ok(text.includes(words), text);
  const images = page.locator("#mesh-1 figure img");
  assert.ok((await images.count()) >= 4);
  for (const image of await images.all())
    assert.ok(await image.evaluate((img) => img.complete && img.naturalWidth > 0));
  assert.deepEqual(page.complaints.filter((text) => !/WebGL/i.test(text)), []);
}

let failed = 0;
async function attempt(name, work) {
  try {
    await work();
    console.log(`ok      ${name}`);
  } catch (error) {
    ++failed;
    console.log(`FAILED  ${name}\n${error.stack}`);
  }
}

const address = makeReport();
const browser = await launch(chromium);
const page = await openView(browser, address);
for (const [name, test] of Object.entries(tests)) await attempt(name, () => test(page));
await attempt("nothing was complained about, nothing fetched", async () =>
  assert.deepEqual(page.complaints, []));
const quads = makeQuadReport();
const quadPage = await openView(browser, quads);
for (const [name, test] of Object.entries(quadTests)) await attempt(name, () => test(quadPage));
await attempt("axe finds no serious fault with quads", () =>
  tests["axe finds no serious fault"](quadPage));
await attempt("nothing was complained about with quads", async () =>
  assert.deepEqual(quadPage.complaints, []));
await attempt("on a phone", () => testPhone(browser, address));
await attempt("without scripts", async () =>
  expectPicturesOnly(await open(browser, address, { javaScriptEnabled: false }), "needs scripts"));
await browser.close();
const plain = await launch(chromium, { hasWebGL: false });
await attempt("without WebGL", async () =>
  expectPicturesOnly(await open(plain, address), "needs WebGL 2"));
await attempt("quads without WebGL", async () => {
  const page = await open(plain, quads);
  await expectPicturesOnly(page, "needs WebGL 2");
  const text = await page.locator("#mesh-1").textContent();
  for (const words of ["Along a cross field, edge length", "Mean scaled Jacobian",
                       "fewer than four quads around it"])
    assert.ok(text.includes(words), words);
});
await plain.close();
process.exit(failed === 0 ? 0 : 1);
