// Triangles with what shading needs: every triangle has corners of its own, so that a normal may
// break at a crease, edges can be drawn in the shader and each triangle has one quality.
import { BufferAttribute, BufferGeometry, Sphere, Vector3 } from "three";

const creaseCosine = Math.cos((35 * Math.PI) / 180);

// `qualityOf` gives, from the corners' positions, one number a corner.
export function surfaceGeometry(points, corners, qualityOf) {
  const geometry = new BufferGeometry();
  const positions = new Float32Array(3 * corners.length);
  for (let i = 0; i < corners.length; ++i)
    for (let axis = 0; axis < 3; ++axis) positions[3 * i + axis] = points[3 * corners[i] + axis];
  const normals = faceNormals(positions);
  geometry.setAttribute("position", new BufferAttribute(positions, 3));
  geometry.setAttribute(
    "normal",
    new BufferAttribute(cornerNormals(normals, corners, points.length / 3), 3, true),
  );
  geometry.setAttribute("quality", new BufferAttribute(qualityOf(positions), 1));
  geometry.boundingSphere = new Sphere(new Vector3(), Infinity);
  return geometry;
}

// Of each triangle, as long as its area.
function faceNormals(p) {
  const normals = new Float32Array(p.length / 3);
  for (let f = 0; f < p.length / 9; ++f) {
    const a = 9 * f;
    const ux = p[a + 3] - p[a];
    const uy = p[a + 4] - p[a + 1];
    const uz = p[a + 5] - p[a + 2];
    const vx = p[a + 6] - p[a];
    const vy = p[a + 7] - p[a + 1];
    const vz = p[a + 8] - p[a + 2];
    normals[3 * f] = uy * vz - uz * vy;
    normals[3 * f + 1] = uz * vx - ux * vz;
    normals[3 * f + 2] = ux * vy - uy * vx;
  }
  return normals;
}

// The faces around each vertex: those of vertex v are list[start[v]] to list[start[v + 1] - 1].
function facesOfVertices(corners, vertexCount) {
  const start = new Uint32Array(vertexCount + 1);
  for (const v of corners) ++start[v + 1];
  for (let v = 0; v < vertexCount; ++v) start[v + 1] += start[v];
  const list = new Uint32Array(corners.length);
  const next = start.slice();
  corners.forEach((v, corner) => (list[next[v]++] = Math.floor(corner / 3)));
  return { start, list };
}

// Means over the faces around a vertex that are turned less than a crease from the corner's own.
function cornerNormals(normals, corners, vertexCount) {
  const { start, list } = facesOfVertices(corners, vertexCount);
  const area = new Float32Array(normals.length / 3);
  for (let f = 0; f < area.length; ++f)
    area[f] = Math.hypot(normals[3 * f], normals[3 * f + 1], normals[3 * f + 2]);
  const result = new Int8Array(3 * corners.length);
  for (let corner = 0; corner < corners.length; ++corner) {
    const own = Math.floor(corner / 3);
    const nx = normals[3 * own];
    const ny = normals[3 * own + 1];
    const nz = normals[3 * own + 2];
    let x = 0;
    let y = 0;
    let z = 0;
    for (let k = start[corners[corner]]; k < start[corners[corner] + 1]; ++k) {
      const f = list[k];
      const dot = nx * normals[3 * f] + ny * normals[3 * f + 1] + nz * normals[3 * f + 2];
      if (f !== own && dot < creaseCosine * area[own] * area[f]) continue;
      x += normals[3 * f];
      y += normals[3 * f + 1];
      z += normals[3 * f + 2];
    }
    const length = Math.hypot(x, y, z) || 1;
    result[3 * corner] = Math.round((127 * x) / length);
    result[3 * corner + 1] = Math.round((127 * y) / length);
    result[3 * corner + 2] = Math.round((127 * z) / length);
  }
  return result;
}
