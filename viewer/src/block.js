// Reads the data blocks that src/report/viewer_block.cpp writes: gzip, "FCNV", the length of a JSON
// header, the header, and arrays of whole numbers, seven bits a byte.

export async function readBlock(base64) {
  const packed = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
  return parseBlock(new Uint8Array(await new Response(stream).arrayBuffer()));
}

export function parseBlock(bytes) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  if (String.fromCharCode(...bytes.subarray(0, 4)) !== "FCNV") throw new Error("not a data block");
  const start = 8 + view.getUint32(4, true);
  const header = JSON.parse(new TextDecoder().decode(bytes.subarray(8, start)));
  return { header, arrays: bytes.subarray(start) };
}

export function readNumbers(arrays, [offset, count]) {
  const numbers = new Uint32Array(count);
  let at = offset;
  for (let i = 0; i < count; ++i) {
    let number = 0;
    let shift = 0;
    let byte;
    do {
      byte = arrays[at++];
      number |= (byte & 127) << shift;
      shift += 7;
    } while (byte > 127);
    numbers[i] = number >>> 0;
  }
  return numbers;
}

// Points relative to the middle of the grid's box, in mesh units: x, y, z of one after the other.
export function readPoints(arrays, [offset, count], grid) {
  const steps = readNumbers(arrays, [offset, 3 * count]);
  const points = new Float32Array(3 * count);
  for (let axis = 0; axis < 3; ++axis) {
    let step = 0;
    for (let i = 0; i < count; ++i) {
      const difference = steps[axis * count + i];
      step += difference & 1 ? -((difference + 1) / 2) : difference / 2;
      points[3 * i + axis] = step * grid.step + grid.min[axis] - grid.center[axis];
    }
  }
  return points;
}

// Corners are written as the distance to the next new vertex; 0 is that vertex.
export function readCorners(arrays, place) {
  const corners = readNumbers(arrays, place);
  let next = 0;
  for (let i = 0; i < corners.length; ++i) {
    if (corners[i] === 0) corners[i] = next++;
    else corners[i] = next - corners[i];
  }
  return corners;
}

// Polylines as pairs of points, and for each pair the polyline it belongs to.
export function readLines(arrays, lines, grid) {
  const sizes = readNumbers(arrays, lines.sizes);
  const points = readPoints(arrays, lines.points, grid);
  const pairCount = sizes.reduce((sum, size) => sum + Math.max(0, size - 1), 0);
  const pairs = new Float32Array(6 * pairCount);
  const owner = new Uint32Array(pairCount);
  let pair = 0;
  let first = 0;
  sizes.forEach((size, line) => {
    for (let i = first; i + 1 < first + size; ++i) {
      pairs.set(points.subarray(3 * i, 3 * i + 6), 6 * pair);
      owner[pair++] = line;
    }
    first += size;
  });
  return { pairs, owner, count: sizes.length };
}
