// Degrees, the same at the three corners of a triangle. It lies opposite the shortest side.
export function smallestAngles(p) {
  const angles = new Float32Array(p.length / 3);
  for (let f = 0; f < angles.length / 3; ++f) {
    const a = squaredDistance(p, 9 * f + 3, 9 * f + 6);
    const b = squaredDistance(p, 9 * f + 6, 9 * f);
    const c = squaredDistance(p, 9 * f, 9 * f + 3);
    const least = Math.min(a, b, c);
    const [u, v] = least === a ? [b, c] : least === b ? [c, a] : [a, b];
    const cosine = (u + v - least) / (2 * Math.sqrt(u * v));
    const angle = u * v > 0 ? (Math.acos(Math.min(1, cosine)) * 180) / Math.PI : 0;
    angles.fill(angle, 3 * f, 3 * f + 3);
  }
  return angles;
}

function squaredDistance(p, i, j) {
  return (p[i] - p[j]) ** 2 + (p[i + 1] - p[j + 1]) ** 2 + (p[i + 2] - p[j + 2]) ** 2;
}
