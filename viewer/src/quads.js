// Quads as triangles and what is known of them. Each quad is cut from its first to its third corner;
// both triangles begin with the corner that the cut does not touch, so that a shader can tell the cut
// from the quad's edges: it lies opposite the first corner.
const cut = [1, 2, 0, 3, 0, 2];

export function cutQuads(corners) {
  const triangles = new Uint32Array((corners.length / 4) * 6);
  for (let quad = 0; quad < corners.length / 4; ++quad)
    cut.forEach((corner, i) => (triangles[6 * quad + i] = corners[4 * quad + corner]));
  return triangles;
}

// Of each quad the least of its corners', of a corner the sine of its angle about the direction of the
// quad's area vector.
export function scaledJacobians(p, corners) {
  const result = new Float32Array(corners.length / 4);
  for (let quad = 0; quad < result.length; ++quad) {
    const at = [0, 1, 2, 3].map((k) => 3 * corners[4 * quad + k]);
    const side = (i, j) => [0, 1, 2].map((axis) => p[at[j] + axis] - p[at[i] + axis]);
    const area = cross(side(0, 2), side(1, 3));
    const size = Math.hypot(...area);
    if (!(size > 0)) continue;
    let least = 1;
    for (let k = 0; k < 4; ++k) {
      const [next, last] = [side(k, (k + 1) % 4), side(k, (k + 3) % 4)];
      const lengths = Math.hypot(...next) * Math.hypot(...last);
      const normal = cross(next, last);
      const volume = normal[0] * area[0] + normal[1] * area[1] + normal[2] * area[2];
      least = Math.min(least, lengths > 0 ? volume / (lengths * size) : 0);
    }
    result[quad] = least;
  }
  return result;
}

function cross(u, v) {
  return [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
}
