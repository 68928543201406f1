// Quads as triangles, their scaled Jacobians, and what is said of them.
import assert from "node:assert/strict";
import { test } from "node:test";
import { describe, meshFacts } from "../../src/describe.js";
import { jacobianClasses, palette, singularColor } from "../../src/palette.js";
import { cutQuads, scaledJacobians } from "../../src/quads.js";

test("both triangles of a quad turn as it does and begin off the cut", () => {
  const corners = Uint32Array.from([7, 3, 9, 4, 1, 2, 5, 6]);
  const triangles = cutQuads(corners);
  assert.equal(triangles.length, 12);
  for (let quad = 0; quad < 2; ++quad) {
    const [a, b, c, d] = corners.subarray(4 * quad, 4 * quad + 4);
    const edges = new Set([[a, b], [b, c], [c, d], [d, a]].map(String));
    for (const first of [6 * quad, 6 * quad + 3]) {
      const [u, v, w] = triangles.subarray(first, first + 3);
      assert.ok(edges.has(String([u, v])) && edges.has(String([w, u])));
      assert.deepEqual([v, w].toSorted(), [a, c].toSorted());
      edges.delete(String([u, v]));
      edges.delete(String([w, u]));
    }
    assert.equal(edges.size, 0);
  }
});

test("the scaled Jacobian of a quad", () => {
  const angle = Math.PI / 5;
  const cases = [
    [[0, 0, 0, 2, 0, 0, 2, 1, 0, 0, 1, 0], 1],
    [[0, 0, 0, 1, 0, 0, 1 + Math.cos(angle), Math.sin(angle), 0, Math.cos(angle), Math.sin(angle), 0],
     Math.sin(angle)],
    [[0, 0, 0, 1, 0, 0, 0.5, 0.5, 0, 0, 1, 0], 0], // the third corner is straight
    [[0, 0, 0, 1, 0, 0, 0.25, 0.25, 0, 0, 1, 0], -0.8], // and turned in
    [[1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1], 0],
  ];
  for (const [points, expected] of cases)
    for (let turn = 0; turn < 4; ++turn) {
      const corners = [0, 1, 2, 3].map((k) => (k + turn) % 4);
      const [found] = scaledJacobians(Float32Array.from(points), corners);
      assert.ok(Math.abs(found - expected) < 1e-6, `${found} ${expected}`);
    }
});

test("irregular vertices are named by index, count and colour", () => {
  const level = { singularities: { valence: [3, 5, 6, 2, 8] } };
  const titles = level.singularities.valence.map((_, k) => describe("singularities", k, {}, level).title);
  ["+1/4", "−1/4", "−1/2", "+1/2", "−1"].forEach((index, k) => assert.ok(titles[k].endsWith(index)));
  assert.equal(singularColor(3), palette.fewerQuads);
  assert.equal(singularColor(5), palette.moreQuads);
});

test("facts of quads", () => {
  const quality = { mean_scaled_jacobian: 0.94, min_scaled_jacobian: 0.3, irregular: 0.02 };
  const whole = meshFacts({ faces: 1200, shown: 1200, sides: 4, quality }, false);
  for (const part of ["1,200\u00a0quads", "0.940", "0.300", "2.0"]) assert.ok(whole.includes(part), part);
  assert.ok(!whole.includes("shown"));
  const few = meshFacts({ faces: 1200, shown: 300, quality }, false);
  assert.ok(few.includes("(300\u00a0triangles\u00a0shown)"));
  assert.ok(jacobianClasses.at(-1).under > 1);
});
