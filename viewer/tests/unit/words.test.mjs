// What the view says and computes without a screen.
import assert from "node:assert/strict";
import { test } from "node:test";
import { curveRows } from "../../src/curve_table.js";
import { describe, meshFacts, number, percent } from "../../src/describe.js";
import { angleClasses, rgb } from "../../src/palette.js";

const dropped = {
  reasons: ["conflict", "short arc"], conflicts: ["distance"],
  reason: [0, 1, 0], arc: [4, 5, 4], curve: [1, 0, 1], weight: [2.5, null, 1],
  margin: [0.25, null, null], length: [0.1, 0.2, 0.1], iteration: [1, 1, 2],
  blockers: [[[7, 3.25, 0, 0.0125]], [], Array(6).fill([7, 1, 0, 0.5])],
};
const levels = { model: { curve_length: [2, 3, 1] }, initial: { curve: [0, 1], pinned: [0, 1] } };

test("a dropped piece says what it lost against, by how much, and what keeping it would cost", () => {
  const { title, facts } = describe("dropped", 0, levels, { dropped });
  const text = facts.join("\n");
  assert.match(title, /conflict/);
  for (const part of ["arc 4", "curve 1", "2.5", "arc 7", "3.25", "0.0125 apart", "0.25"])
    assert.ok(text.includes(part), part);
});

test("long lists of blockers are cut and say so; missing numbers are dashes", () => {
  assert.ok(describe("dropped", 2, levels, { dropped }).facts.includes("and against 2 more"));
  assert.ok(describe("dropped", 1, levels, { dropped }).facts.join().includes("weight –"));
});

test("a conflict says which side was kept", () => {
  const conflicts = {
    names: ["angle"], kind: [0], measured: [Math.PI / 6], arcs: [[1, 2]], weights: [[5, 6]], kept: [2],
  };
  const { facts } = describe("conflicts", 0, levels, { conflicts });
  assert.ok(facts[0].includes("30.0°"));
  assert.ok(facts[1].endsWith("not kept"));
  assert.ok(facts[2].endsWith(", kept"));
});

test("the curve that lost most comes first", () => {
  const level = { curve_kept: [1, 3.01, 0.5], dropped };
  const rows = curveRows(levels, level);
  assert.deepEqual(rows.map((row) => row.curve), [0, 2, 1]);
  assert.equal(rows[2].kept, 1);
  assert.deepEqual(rows.map((row) => row.pieces), [1, 0, 2]);
  assert.deepEqual(curveRows(levels, null).map((row) => row.curve), [1, 0, 2]);
});

test("numbers", () => {
  assert.equal(number(0.0123456), "0.01235");
  assert.equal(number(null), "–");
  assert.equal(percent(0.5), "50.0\u00a0%");
  assert.ok(meshFacts({ faces: 1200, shown: 300, quality: null }, true).includes("300\u00a0shown"));
});

test("layers differ in lightness or hue for every kind of colour vision", () => {
  // Classes of angles go from dark over light to dark: neighbours differ in luminance.
  const luminance = (hex) => rgb(hex).reduce((sum, c, i) => sum + c ** 2.2 * [0.21, 0.72, 0.07][i], 0);
  const lights = angleClasses.map(({ color }) => luminance(color));
  for (let i = 1; i < lights.length; ++i)
    assert.ok(Math.abs(lights[i] - lights[i - 1]) > 0.12, `${i}: ${lights}`);
});
