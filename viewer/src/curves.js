// Layers of curves as wide lines. Each pair of points is one instance; for picking, the same lines
// are drawn once more in colours that are numbers.
import { Color } from "three";
import { LineMaterial } from "three/examples/jsm/lines/LineMaterial.js";
import { LineSegments2 } from "three/examples/jsm/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/examples/jsm/lines/LineSegmentsGeometry.js";

const pickingMargin = 6; // pixels

function wideLines(pairs, colors, material) {
  const geometry = new LineSegmentsGeometry();
  geometry.setPositions(pairs);
  if (colors) geometry.setColors(colors);
  const lines = new LineSegments2(geometry, material);
  lines.frustumCulled = false;
  return lines;
}

// `colorOf` gives the colour of a polyline.
export function makeCurves({ pairs, owner }, width, colorOf) {
  const colors = new Float32Array(pairs.length);
  const cache = new Map();
  for (let i = 0; i < owner.length; ++i) {
    const name = colorOf(owner[i]);
    if (!cache.has(name)) cache.set(name, new Color(name));
    const color = cache.get(name);
    color.toArray(colors, 6 * i);
    color.toArray(colors, 6 * i + 3);
  }
  return wideLines(pairs, colors, new LineMaterial({ linewidth: width, vertexColors: true }));
}

// Polyline k in the colour of the number `first` + k.
export function makePickableCurves({ pairs, owner }, width, first) {
  const colors = new Float32Array(pairs.length);
  for (let i = 0; i < owner.length; ++i) {
    const number = first + owner[i];
    const color = [number & 255, (number >> 8) & 255, (number >> 16) & 255].map((c) => c / 255);
    colors.set(color, 6 * i);
    colors.set(color, 6 * i + 3);
  }
  const material = new LineMaterial({ linewidth: width + pickingMargin, vertexColors: true });
  return wideLines(pairs, colors, material);
}

// The chosen polylines, wide and bright, seen through the surface.
export function makeHighlight(parts, color) {
  const chosen = [];
  for (const { lines, isChosen } of parts)
    lines.owner.forEach((line, pair) => {
      if (isChosen(line)) chosen.push(...lines.pairs.subarray(6 * pair, 6 * pair + 6));
    });
  if (chosen.length === 0) return null;
  const material = new LineMaterial({
    linewidth: 9,
    color,
    transparent: true,
    opacity: 0.75,
    depthTest: false,
    depthWrite: false,
  });
  const lines = wideLines(new Float32Array(chosen), null, material);
  lines.renderOrder = 1;
  return lines;
}
