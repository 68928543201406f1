// The data of one mesh: the model (its surface and initial network) and one level a scale. Blocks
// are read when they are needed first.
import { readBlock, readCorners, readLines, readPoints } from "./block.js";

export class Levels {
  static async open(blocks) {
    const { header, arrays } = await readBlock(blocks[0]);
    return new Levels(header, arrays, blocks.slice(1));
  }

  constructor(header, arrays, blocks) {
    this.model = header;
    this.blocks = blocks;
    this.levels = blocks.map(() => null);
    this.grid = { ...header.grid };
    const size = readPoints(arrays, header.meshes[0].points, { ...this.grid, center: [0, 0, 0] });
    this.grid.center = middleOf(size);
    this.input = readMesh(header.meshes[0], arrays, this.grid);
    this.initial = { ...header.initial, lines: readLines(arrays, header.initial.lines, this.grid) };
  }

  get count() {
    return this.blocks.length;
  }

  // Level 0 is the input with all that was detected; the others are scales.
  async level(number) {
    if (number === 0) return null;
    this.levels[number - 1] ??= this.read(this.blocks[number - 1]);
    return this.levels[number - 1];
  }

  async read(block) {
    const { header, arrays } = await readBlock(block);
    const level = { ...header };
    for (const layer of ["adapted", "dropped", "conflicts"])
      level[layer] = { ...header[layer], lines: readLines(arrays, header[layer].lines, this.grid) };
    if (header.field)
      level.field = { lines: readLines(arrays, header.field.lines, this.grid) };
    if (header.singularities)
      level.singularities = {
        ...header.singularities,
        points: readPoints(arrays, header.singularities.points, this.grid),
      };
    level.meshes = header.meshes.map((mesh) => readMesh(mesh, arrays, this.grid));
    return level;
  }
}

function readMesh(mesh, arrays, grid) {
  return {
    ...mesh,
    points: readPoints(arrays, mesh.points, grid),
    corners: readCorners(arrays, mesh.corners),
  };
}

function middleOf(points) {
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  points.forEach((x, i) => {
    low[i % 3] = Math.min(low[i % 3], x);
    high[i % 3] = Math.max(high[i % 3], x);
  });
  return points.length ? low.map((x, axis) => (x + high[axis]) / 2) : [0, 0, 0];
}
