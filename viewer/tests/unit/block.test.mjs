// Data blocks, from bytes that are written down here.
import assert from "node:assert/strict";
import { gzipSync } from "node:zlib";
import { test } from "node:test";
import {
  parseBlock, readBlock, readCorners, readLines, readNumbers, readPoints,
} from "../../src/block.js";

const grid = { min: [1, 2, 3], center: [0, 0, 0], step: 0.5 };

function block(header, bytes) {
  const text = new TextEncoder().encode(JSON.stringify(header));
  const size = [text.length & 255, text.length >> 8, 0, 0];
  return Uint8Array.from([..."FCNV"].map((c) => c.charCodeAt(0)).concat(size, [...text], bytes));
}

test("a block is read through gzip and base64", async () => {
  const packed = Buffer.from(gzipSync(block({ a: 1 }, [5]))).toString("base64");
  const { header, arrays } = await readBlock(packed);
  assert.deepEqual(header, { a: 1 });
  assert.deepEqual([...arrays], [5]);
});

test("something else is refused", () => {
  assert.throws(() => parseBlock(Uint8Array.from([1, 2, 3, 4, 0, 0, 0, 0])), /not a data block/);
});

test("numbers of one to five bytes", () => {
  const bytes = Uint8Array.from([99, 0, 127, 128, 1, 255, 255, 255, 255, 15]);
  assert.deepEqual([...readNumbers(bytes, [1, 4])], [0, 127, 128, 4294967295]);
});

test("points are sums of differences on the grid", () => {
  // x: 0, 3, 1; y: 0, 0, 0; z: 2, 1, 1. Differences 0, 1, -1, 2, ... are 0, 2, 1, 4, ...
  const bytes = Uint8Array.from([0, 6, 3, 0, 0, 0, 4, 1, 0]);
  assert.deepEqual([...readPoints(bytes, [0, 3], grid)], [1, 2, 4, 2.5, 2, 3.5, 1.5, 2, 3.5]);
});

test("corners are distances to the next new vertex", () => {
  const bytes = Uint8Array.from([0, 0, 0, 2, 1, 0]);
  assert.deepEqual([...readCorners(bytes, [0, 6])], [0, 1, 2, 1, 2, 3]);
});

test("polylines become pairs of points with their owner", () => {
  // Two polylines of 3 and 2 points on the x axis: 0, 1, 2 and 0, 5.
  const bytes = Uint8Array.from([3, 2, 0, 2, 2, 3, 10, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]);
  const lines = readLines(bytes, { sizes: [0, 2], points: [2, 5] }, { ...grid, min: [0, 0, 0], step: 1 });
  assert.equal(lines.count, 2);
  assert.deepEqual([...lines.owner], [0, 0, 1]);
  assert.deepEqual(
    [...lines.pairs].filter((_, i) => i % 3 === 0),
    [0, 1, 1, 2, 0, 5],
  );
});
