// What shading is told about triangles.
import assert from "node:assert/strict";
import { test } from "node:test";
import { smallestAngles } from "../../src/surface_angles.js";

test("the smallest angle of a triangle, at each of its corners", () => {
  const height = Math.sqrt(3) / 2;
  const cases = [
    [[0, 0, 0, 1, 0, 0, 0.5, height, 0], 60],
    [[0, 0, 0, 1, 0, 0, 1, 0, 1], 45],
    [[0, 0, 0, 2, 0, 0, 2, 2 * Math.tan(Math.PI / 18), 0], 10],
    [[0, 0, 0, 1, 0, 0, 0.5, 0, 0], 0],
    [[3, 3, 3, 3, 3, 3, 4, 4, 4], 0],
  ];
  for (const [points, expected] of cases)
    for (let turn = 0; turn < 3; ++turn) {
      const turned = [...points.slice(3 * turn), ...points.slice(0, 3 * turn)];
      const angles = smallestAngles(Float32Array.from(turned));
      assert.equal(angles.length, 3);
      for (const angle of angles) assert.ok(Math.abs(angle - expected) < 1e-3, `${angle} ${expected}`);
    }
});
