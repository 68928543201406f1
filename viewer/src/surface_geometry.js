// Triangles with what shading needs: every triangle has corners of its own, so that a normal may
// break at a crease, edges can be drawn in the shader and each triangle has one quality.
import { BufferAttribute, BufferGeometry, Sphere, Vector3 } from "three";

const creaseCosine = Math.cos((35 * Math.PI) / 180);

export function surfaceGeometry(points, corners) {
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
  geometry.setAttribute("angle", new BufferAttribute(smallestAngles(positions), 1));
  geometry.boundingSphere = new Sphere(new Vector3(), Infinity);
  return geometry;
}

// Of each triangle, as long as its area.
function faceNormals(p) {
  const normals = new Float32Array(p.length / 3);
  for (let f = 0; f < p.length / 9; ++f) {
    const [a, b, c] = [9 * f, 9 * f + 3, 9 * f + 6];
    const [ux, uy, uz] = [p[b] - p[a], p[b + 1] - p[a + 1], p[b + 2] - p[a + 2]];
    const [vx, vy, vz] = [p[c] - p[a], p[c + 1] - p[a + 1], p[c + 2] - p[a + 2]];
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
    const [nx, ny, nz] = normals.subarray(3 * own, 3 * own + 3);
    let [x, y, z] = [0, 0, 0];
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

// Degrees, the same at the three corners of a triangle.
function smallestAngles(p) {
  const angles = new Float32Array(p.length / 3);
  for (let f = 0; f < p.length / 9; ++f) {
    const at = (k) => [p[9 * f + 3 * k], p[9 * f + 3 * k + 1], p[9 * f + 3 * k + 2]];
    let smallest = 180;
    for (let k = 0; k < 3; ++k)
      smallest = Math.min(smallest, angleAt(at(k), at((k + 1) % 3), at((k + 2) % 3)));
    angles.fill(smallest, 3 * f, 3 * f + 3);
  }
  return angles;
}

export function angleAt(a, b, c) {
  const u = b.map((x, i) => x - a[i]);
  const v = c.map((x, i) => x - a[i]);
  const cross = Math.hypot(
    u[1] * v[2] - u[2] * v[1],
    u[2] * v[0] - u[0] * v[2],
    u[0] * v[1] - u[1] * v[0],
  );
  const dot = u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
  return (Math.atan2(cross, dot) * 180) / Math.PI;
}
